"""Draws the rooms and who includes whom, from the include lines, into docs/developer/architecture.svg.

    python3 tools/architecture_picture.py            draws it; needs graphviz
    python3 tools/architecture_picture.py --check    compares the rooms and arrows of the picture with the sources
"""
import glob
import html
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PICTURE = os.path.join(ROOT, "docs/developer/architecture.svg")
# Room: what it does, then the outside libraries that it alone, or with the rooms above, may see.
ROOMS = {
    "base": ("diagnostics, errors, rotations", "Eigen"),
    "formats/records": ("Deck, BodySpec, SystemSpec,\nFlexBody, results: plain structs", ""),
    "formats": ("bytes <-> records", "HDF5, toml++, matio, libzip, pugixml"),
    "fe": ("deck -> model, K, M, K_G, statics", "PETSc, METIS, CHOLMOD, MPI"),
    "modal": ("modes, bases, mass integrals, response", "SLEPc"),
    "stiffening": ("deck + body file -> flexible body", ""),
    "solver": ("bodies + system -> motion,\nlinear models", "SUNDIALS, muParser"),
    "cosim": ("FMUs as controllers", ""),
    "embed": ("libbough.so, bough.h, FMUs", ""),
    "report": ("records -> pictures, pages", ""),
    "analysis": ("commands as functions:\nrequest -> records", ""),
    "cli": ("options -> request,\nrecords -> tables, files", "CLI11"),
    "python": ("import bough", "pybind11"),
}


def find_room(path):
    """Returns the room of a repository path: the longest name that it begins with, or None."""
    return max((room for room in ROOMS if path.startswith(room + "/")), key=len, default=None)


def find_includes():
    """Returns the set of (room, included room), from the include lines of the product sources."""
    edges = set()
    for top in sorted({room.split("/")[0] for room in ROOMS}):
        for path in glob.glob(os.path.join(ROOT, top, "**/*.[ch]pp"), recursive=True):
            room = find_room(os.path.relpath(path, ROOT))
            with open(path, encoding="utf-8") as f:
                targets = re.findall(r'(?m)^\s*#\s*include\s+"([^"]+)"', f.read())
            edges |= {(room, find_room(target)) for target in targets if find_room(target) not in (None, room)}
    return edges


def reduce_edges(edges):
    """Removes each arrow that follows from a chain of others."""
    def reaches(start, end, without):
        seen, stack = {start}, [start]
        while stack:
            room = stack.pop()
            if room == end:
                return True
            further = {b for a, b in edges - {without} if a == room} - seen
            seen |= further
            stack += further
        return False
    return {edge for edge in edges if not reaches(*edge, edge)}


def make_graph(edges):
    lines = ["digraph bough {", '  rankdir=BT; nodesep=0.25; ranksep=0.4; bgcolor="transparent";',
             '  node [shape=box, style="rounded,filled", fillcolor="#f4f6f8", color="#5a6b7a", fontname="Helvetica,Arial,sans-serif"];',
             '  edge [color="#5a6b7a", arrowsize=0.7];']
    for room, (work, libraries) in ROOMS.items():
        label = f'<b>{room}</b><br/><font point-size="11">{html.escape(work).replace(chr(10), "<br/>")}</font>'
        if libraries:
            label += f'<br/><font point-size="10" color="#8a4b08">{html.escape(libraries)}</font>'
        lines.append(f'  "{room}" [label=<{label}>];')
    lines += [f'  "{a}" -> "{b}";' for a, b in sorted(edges)]
    return "\n".join(lines + ["}"]) + "\n"


def read_picture():
    """Returns the rooms and the arrows of the picture, by the titles that graphviz writes."""
    with open(PICTURE, encoding="utf-8") as f:
        titles = [html.unescape(title) for title in re.findall(r"<title>([^<]*)</title>", f.read())]
    arrows = {tuple(title.split("->")) for title in titles if "->" in title}
    return {title for title in titles if "->" not in title} - {"bough"}, arrows


def main():
    edges = reduce_edges(find_includes())
    if "--check" in sys.argv:
        rooms, arrows = read_picture()
        if rooms == set(ROOMS) and arrows == edges:
            return 0
        print(f"{PICTURE}: error: the picture differs from the sources: {sorted(rooms ^ set(ROOMS))}"
              f" {sorted(arrows ^ edges)}; run python3 tools/architecture_picture.py")
        return 1
    drawn = subprocess.run(["dot", "-Tsvg"], input=make_graph(edges), capture_output=True, text=True, check=True).stdout
    drawn = re.sub(r"<!--.*?-->\n?", "", drawn, flags=re.S)
    with open(PICTURE, "w", encoding="utf-8") as f:
        f.write(drawn)
    print(f"written: {PICTURE}, {len(edges)} arrows")
    return 0


if __name__ == "__main__":
    sys.exit(main())
