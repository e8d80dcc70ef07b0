"""Builds the manual as web pages with search: every .md of the repository by Sphinx, the C++ headers by Doxygen, the
Python module from its types; then follows every link inside it.

    /usr/bin/python3 tools/build_docs.py build/html [--no-cpp]

Exit 1 when a page has a warning or a link that leads nowhere.
"""
import ast
import html.parser
import os
import re
import shutil
import subprocess
import sys
import urllib.parse

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
OUTPUT = os.path.abspath(sys.argv[1])
STAGE = OUTPUT + "-source"
CONF = """project = "Bough"
author = copyright = "The Bough authors"
release = version = "{version}"
extensions = ["myst_parser"]
myst_heading_anchors = 4
master_doc = "README"
html_theme = "classic"
html_theme_options = {{"body_max_width": "60em", "collapsiblesidebar": "true"}}
html_copy_source = html_show_sourcelink = False
html_title = "Bough {version}"
html_static_path = ["_static"]
html_css_files = ["tables.css"]
# Python, TOML and C++ blocks are coloured where they parse; shell sessions and output stay as they are.
highlight_language = "none"
suppress_warnings = ["myst.header", "toc.not_readable", "misc.highlighting_failure"]
"""


# Narrow cells are not stretched to both sides, pictures not wider than their page.
CSS = "div.body td, div.body td p, div.body th p { text-align: left; }\ndiv.body img { max-width: 100%; }\n"


def list_files():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"], check=True, text=True,
                            capture_output=True).stdout.split("\n")
    # Forms of a forge (.github) are no pages.
    return [path for path in listed if path and path[0] != "." and os.path.isfile(os.path.join(ROOT, path))]


def find_title(text, path):
    found = re.search(r"(?m)^# (.+)$", text)
    return found.group(1) if found else path


def describe_python():
    """A page of the module's types: each class and function with its signature and docstring."""
    out = ["# Python reference", "", "Out of the types of the module (`*.pyi`); how it is used: [Python](python.md).", ""]
    folder = os.path.join(ROOT, "python/bough")
    for name in sorted(os.listdir(folder)):
        if not name.endswith(".pyi"):
            continue
        with open(os.path.join(folder, name), encoding="utf-8") as f:
            tree = ast.parse(f.read())
        module = "bough" if name == "__init__.pyi" else "bough." + name[:-4]
        out += [f"## {module}", ""]
        for node in tree.body:
            out += describe_node(node, 3)
    return "\n".join(out) + "\n"


def describe_node(node, level):
    if isinstance(node, ast.ClassDef):
        out = ["#" * level + f" class {node.name}", "", ast.get_docstring(node) or "", ""]
        for child in node.body:
            out += describe_node(child, level + 1)
        return out
    if isinstance(node, ast.FunctionDef):
        returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
        lines = ["```", f"{node.name}({ast.unparse(node.args)}){returns}", "```", ""]
        return lines + [ast.get_docstring(node) or "", ""]
    if isinstance(node, ast.AnnAssign):
        return ["```", ast.unparse(node), "```", ""]
    return []


def stage(files):
    """The pages in a folder of their own, with an index of each folder that a page links as a whole."""
    shutil.rmtree(STAGE, ignore_errors=True)
    texts = {path: open(os.path.join(ROOT, path), encoding="utf-8").read() for path in files if path.endswith(".md")}
    texts["docs/python-reference.md"] = describe_python()
    folders = {}
    for path, text in texts.items():
        if path.startswith("tests/"):
            continue
        folders.setdefault(os.path.dirname(path), []).append((path, find_title(text, path)))
    for folder, pages in list(folders.items()):
        if folder.startswith("docs/") and folder + "/README.md" not in texts:
            lines = [f"* [{title}]({os.path.basename(path)})" for path, title in sorted(pages)]
            texts[folder + "/index.md"] = f"# {os.path.basename(folder).capitalize()}\n\n" + "\n".join(lines) + "\n"
    known = set(files) | set(texts)

    def mend(path, text):
        def replace(match):
            target, hash_sign, anchor = match.group(2).partition("#")
            if "://" in target or target.startswith("mailto:") or not target:
                return match.group(0)
            where = os.path.normpath(os.path.join(os.path.dirname(path), target))
            for page in (where + "/README.md", where + "/index.md"):
                if page in known:
                    return f"{match.group(1)}{os.path.relpath(page, os.path.dirname(path) or '.')}{hash_sign}{anchor})"
            return match.group(0)
        return re.sub(r"(\]\()([^)\s]+)\)", replace, text)

    named = set()
    for path, text in texts.items():
        if path.startswith("tests/"):
            continue
        text = mend(path, text)
        if path == "README.md":
            others = sorted(p[:-3] for p in texts if p != path and not p.startswith("tests/"))
            text += "\n```{toctree}\n:hidden:\n\n" + "\n".join("/" + p for p in others) + "\n```\n"
        os.makedirs(os.path.dirname(os.path.join(STAGE, path)), exist_ok=True)
        with open(os.path.join(STAGE, path), "w", encoding="utf-8") as f:
            f.write(text)
        for target in re.findall(r"\]\(([^)\s#]+)", text):
            named.add(os.path.normpath(os.path.join(os.path.dirname(path), target)))
    for path in sorted(named - set(texts)):
        if path in known:
            os.makedirs(os.path.dirname(os.path.join(STAGE, path)), exist_ok=True)
            shutil.copy(os.path.join(ROOT, path), os.path.join(STAGE, path))
    version = re.search(r"project\(Bough VERSION ([\d.]+)", open(os.path.join(ROOT, "CMakeLists.txt")).read()).group(1)
    os.makedirs(os.path.join(STAGE, "_static"), exist_ok=True)
    with open(os.path.join(STAGE, "_static/tables.css"), "w") as f:
        f.write(CSS)
    with open(os.path.join(STAGE, "conf.py"), "w") as f:
        f.write(CONF.format(version=version))
    return version


def describe_cpp(version):
    rooms = " ".join(os.path.join(ROOT, room) for room in "base formats fe modal stiffening solver".split())
    settings = f"""PROJECT_NAME = "Bough, C++"
PROJECT_NUMBER = {version}
INPUT = {rooms}
RECURSIVE = YES
FILE_PATTERNS = *.hpp *.h
EXCLUDE_PATTERNS = */detail/*
STRIP_FROM_PATH = {ROOT}
EXTRACT_ALL = YES
JAVADOC_AUTOBRIEF = YES
MARKDOWN_SUPPORT = NO
GENERATE_LATEX = NO
HTML_OUTPUT = cpp
OUTPUT_DIRECTORY = {OUTPUT}
QUIET = YES
WARNINGS = NO
SEARCHENGINE = YES
HAVE_DOT = NO
HTML_TIMESTAMP = NO
"""
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, stderr=subprocess.DEVNULL)


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.names, self.links = set(), []
        with open(path, encoding="utf-8", errors="replace") as f:
            self.feed(f.read())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.names.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def check_links():
    """Links of the pages that lead nowhere: to files that are missing, to headings that are not there."""
    pages = {}
    for folder, _, names in os.walk(OUTPUT):
        if os.path.relpath(folder, OUTPUT).split(os.sep)[0] not in ("cpp", "_static"):
            for name in names:
                if name.endswith(".html"):
                    pages[os.path.join(folder, name)] = Page(os.path.join(folder, name))
    found, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            target, _, anchor = link.partition("#")
            target = urllib.parse.unquote(target.partition("?")[0])
            where = os.path.normpath(os.path.join(os.path.dirname(path), target)) if target else path
            count += 1
            if not os.path.exists(where):
                found.append(f"{os.path.relpath(path, OUTPUT)}: no {link}")
            elif anchor and where in pages and urllib.parse.unquote(anchor) not in pages[where].names:
                found.append(f"{os.path.relpath(path, OUTPUT)}: no heading {link}")
    return found, count


def main():
    shutil.rmtree(OUTPUT, ignore_errors=True)
    version = stage(list_files())
    built = subprocess.run(["/usr/bin/sphinx-build", "-q", "-b", "html", "-d", OUTPUT + "-doctrees", STAGE, OUTPUT],
                           text=True, stderr=subprocess.PIPE)
    warnings = [line for line in built.stderr.split("\n") if "WARNING" in line or "ERROR" in line]
    for name in (".buildinfo", "objects.inv"):
        if os.path.exists(os.path.join(OUTPUT, name)):
            os.remove(os.path.join(OUTPUT, name))
    index = os.path.join(OUTPUT, "index.html")
    if not os.path.exists(index):
        with open(index, "w") as f:
            f.write('<!DOCTYPE html>\n<meta charset="utf-8"><title>Bough</title>\n'
                    '<meta http-equiv="refresh" content="0; url=README.html">\n<a href="README.html">Bough</a>\n')
    if "--no-cpp" not in sys.argv:
        describe_cpp(version)
    found, count = check_links()
    for line in [*warnings, *found]:
        print(line.replace(STAGE + os.sep, ""))
    print(f"manual: {OUTPUT}/index.html; {count} links, {len(found)} lead nowhere, {len(warnings)} warnings")
    return 1 if built.returncode or warnings or found else 0


if __name__ == "__main__":
    sys.exit(main())
