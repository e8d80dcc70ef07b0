"""Pages for developers are true: every file that a page of docs/developer names exists, and every function or name in a
row of a table is in a file of its row. Pages that trace something through its files name every product file it is in.
The picture of the architecture has the arrows of the include lines, CITATION.cff the version of the sources; the index
of the pages has each of them.

where_is_test.py SOURCE
"""
import glob
import os
import re
import subprocess
import sys

SOURCE = os.path.abspath(sys.argv[1])
FOLDER = os.path.join(SOURCE, "docs/developer")
ENDINGS = "cpp|hpp|h|py|json|md|txt|toml|yml|cff|svg|in|cmake|spdx"
ROOMS = ["base", "formats", "fe", "modal", "stiffening", "solver", "embed", "cosim", "report", "analysis", "cli", "python",
         "data/schema"]
# Page: the expression that finds the files of what it traces, and files that match for another reason.
TRACED = {
    "add-a-card.md": (r"\b[CP]VISC\b|\b[CcPp]visc\b|\bclass Viscous\b|\bViscous::", []),
    "add-a-key.md": (r"\boutput_every\b", []),
    "add-a-sensor.md": (r"\bSensorType::StrainEnergy\b", []),
    "add-a-command.md": (r"\badd_integrals\b|\"bough integrals", ["analysis/report/report_bodies.cpp"]),
    "add-a-hinge.md": (r'"screw"|\bHingeType::Screw\b|\bScrewHinge\b', []),
    "add-a-format.md": (r'"gltf"|\bmake_glb\b|\bGltfScene\b', ["python/bough/__init__.py"]),
}


def list_files(text):
    """Returns the paths in back quotes; a bare name is in the folder of the path before it, or at the top."""
    paths, folder = [], ""
    for path in re.findall(rf"`([\w./-]+\.(?:{ENDINGS}))`", text):
        if "/" not in path and not os.path.exists(os.path.join(SOURCE, path)):
            path = os.path.join(folder, path)
        folder = os.path.dirname(path)
        paths.append(path)
    return paths


def check_row(cells, is_call, where):
    """Faults of a row whose last cell has files: names of the other cells that are in none of them."""
    paths = [path for path in list_files(cells[-1]) if os.path.exists(os.path.join(SOURCE, path))]
    text = "".join(open(os.path.join(SOURCE, path), encoding="utf-8").read() for path in paths)
    names = re.findall(r"`([^`]+)`", cells[1])
    if is_call:
        names = [name.split("::")[-1] for name in names if re.fullmatch(r"[\w:]+", name)]
    return [f"{where}: error: {name} is in none of {', '.join(paths)}" for name in names
            if not (re.search(rf"\b{name}\(", text) if is_call else name in text)]


def check_page(path):
    """Returns the faults of a page and the number of its rows with files."""
    wrong, num_rows, name = [], 0, os.path.basename(path)
    with open(path, encoding="utf-8") as page:
        lines = page.read().split("\n")
    for number, line in enumerate(lines, 1):
        where = f"docs/developer/{name}:{number}"
        wrong += [f"{where}: error: {file} is not there" for file in list_files(line)
                  if not os.path.exists(os.path.join(SOURCE, file))]
        cells = line.strip().strip("|").split(" | ")
        if line.startswith("|") and len(cells) >= 3 and list_files(cells[-1]):
            num_rows += 1
            if name.startswith(("where-is", "add-a-")):
                wrong += check_row(cells, name == "where-is.md", where)
            elif name == "tour.md":
                wrong += check_row(["", cells[2], cells[3]], True, where)
    return wrong, num_rows


def check_trace(name, word, others):
    """Faults of a page that traces `word`: product files that have the word and are not on the page."""
    with open(os.path.join(FOLDER, name), encoding="utf-8") as page:
        named = {path for line in page for path in list_files(line)}
    pattern, found = re.compile(word), set()
    for room in ROOMS:
        for path in glob.glob(os.path.join(SOURCE, room, "**/*.*"), recursive=True):
            if path.endswith((".cpp", ".hpp", ".h", ".json", ".py")):
                with open(path, encoding="utf-8") as f:
                    if pattern.search(f.read()):
                        found.add(os.path.relpath(path, SOURCE))
    return [f"docs/developer/{name}: error: {path} has {word} and is not on the page"
            for path in sorted(found - named - set(others))]


def check_version():
    """Faults of CITATION.cff: another version than that of the sources."""
    with open(os.path.join(SOURCE, "CMakeLists.txt"), encoding="utf-8") as f:
        version = re.search(r"project\(Bough VERSION ([\d.]+)", f.read()).group(1)
    with open(os.path.join(SOURCE, "CITATION.cff"), encoding="utf-8") as f:
        cited = re.search(r"(?m)^version: (.+)$", f.read()).group(1)
    return [] if cited == version else [f"CITATION.cff: error: expected version {version}, found {cited}"]


def check_index():
    """Faults of docs/README.md: pages below docs that it does not link (decisions and errors have their own index)."""
    with open(os.path.join(SOURCE, "docs/README.md"), encoding="utf-8") as f:
        linked = set(re.findall(r"\]\(([\w./-]+)", f.read()))
    pages = {os.path.relpath(path, os.path.join(SOURCE, "docs"))
             for path in glob.glob(os.path.join(SOURCE, "docs/**/*.md"), recursive=True)}
    missing = {page for page in pages - linked if not page.startswith(("adr/", "errors/", "developer/")) and page != "README.md"}
    return [f"docs/README.md: error: {page} is not in the index" for page in sorted(missing)]


def main():
    wrong, rows = [], {}
    for path in sorted(glob.glob(os.path.join(FOLDER, "*.md"))):
        faults, rows[os.path.basename(path)] = check_page(path)
        wrong += faults
    for name, (word, others) in TRACED.items():
        wrong += check_trace(name, word, others)
    for name, min_rows in {"where-is.md": 20, "tour.md": 12, "add-a-card.md": 15, "add-a-hinge.md": 10}.items():
        if rows.get(name, 0) < min_rows:
            wrong.append(f"docs/developer/{name}: error: the tables have {rows.get(name, 0)} rows, expected {min_rows} and more")
    wrong += check_version() + check_index()
    print("\n".join(wrong))
    picture = subprocess.run([sys.executable, "-B", os.path.join(SOURCE, "tools/architecture_picture.py"), "--check"])
    return 1 if wrong or picture.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
