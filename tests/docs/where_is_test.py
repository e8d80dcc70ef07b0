"""docs/developer/where-is.md: every function it names is defined in a file of its row, and every file exists.

where_is_test.py SOURCE
"""
import os
import re
import sys

SOURCE = sys.argv[1]
PAGE = os.path.join(SOURCE, "docs/developer/where-is.md")


def list_files(cell):
    """Paths of a cell; a bare name is in the folder of the path before it."""
    paths, folder = [], ""
    for path in re.findall(r"`([\w/]+\.[ch]pp)`", cell):
        if "/" not in path:
            path = os.path.join(folder, path)
        folder = os.path.dirname(path)
        paths.append(path)
    return paths


def main():
    wrong, num_rows = [], 0
    for number, line in enumerate(open(PAGE), 1):
        cells = line.split(" | ")
        if not line.startswith("|") or len(cells) < 3 or ".cpp`" not in cells[-1] and ".hpp`" not in cells[-1]:
            continue
        num_rows += 1
        paths = list_files(cells[-1])
        missing = [path for path in paths if not os.path.exists(os.path.join(SOURCE, path))]
        wrong += [f"{PAGE}:{number}: error: {path} is not there" for path in missing]
        text = "".join(open(os.path.join(SOURCE, path)).read() for path in paths if path not in missing)
        names = [name.split("::")[-1] for name in re.findall(r"`([\w:]+)`", cells[1])]
        wrong += [f"{PAGE}:{number}: error: {name} is in none of {', '.join(paths)}" for name in names
                  if not re.search(rf"\b{name}\(", text)]
    if num_rows < 20:
        wrong.append(f"{PAGE}: error: the table has {num_rows} rows, expected 20 and more")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
