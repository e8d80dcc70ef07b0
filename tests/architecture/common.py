"""Shared by the architecture tests: the sources by room, and the report of findings."""
import os
import re
import sys

ROOMS = ["base", "formats", "fe", "modal", "stiffening", "solver", "embed", "cosim", "report", "analysis", "cli",
         "python"]
ROOT = sys.argv[1] if len(sys.argv) > 1 else "."


def list_files(folders, suffixes):
    """Paths relative to the root, sorted, of the files below the folders."""
    found = []
    for folder in folders:
        for base, _, names in os.walk(os.path.join(ROOT, folder)):
            found += [os.path.relpath(os.path.join(base, n), ROOT) for n in names if n.endswith(suffixes)]
    return sorted(found)


def list_sources():
    return list_files(ROOMS, (".hpp", ".cpp"))


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as f:
        return f.read()


def strip_comments(text):
    """Code with its comments blanked, line numbers kept; string literals stay."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
    return pattern.sub(lambda m: m.group(0) if m.group(0)[0] in "\"'" else re.sub(r"[^\n]", " ", m.group(0)), text)


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def finish(findings, rule):
    for finding in findings:
        print(finding)
    print(f"{rule}: {len(findings)} findings")
    sys.exit(1 if findings else 0)
