"""Checks the subject of a commit message: `area: imperative verb and object`, at most 72 characters, no full stop.

    python3 tools/lint_subject.py MESSAGE_FILE
"""
import re
import sys


def find_faults(subject):
    """Returns what is wrong with a subject, one line per fault."""
    if re.match(r"(Merge|Revert|fixup!|squash!) ?", subject):
        return []
    faults = []
    if len(subject) > 72:
        faults.append(f"{len(subject)} characters, expected at most 72")
    if not re.match(r"[\w, /.-]+: \w", subject):
        faults.append("no area, expected `area: imperative verb and object`")
    if subject.endswith("."):
        faults.append("a full stop at the end")
    return faults


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as message:
        found = find_faults(message.readline().rstrip("\n"))
    for fault in found:
        print(f"error: subject of the commit: {fault}", file=sys.stderr)
    sys.exit(1 if found else 0)
