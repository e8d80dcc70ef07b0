"""Habits of files: headers say what they are, lines end in time, a file is one idea."""
import os
import re
import subprocess
import sys

ROOT = sys.argv[1]
files = subprocess.run(["git", "-C", ROOT, "ls-files", "*.hpp", "*.cpp", "*.py", "*.md"], capture_output=True, text=True,
                       check=True).stdout.split()
GENERATED = {"docs/commands.md"}
findings = []
for path in files:
    with open(os.path.join(ROOT, path), encoding="utf-8") as f:
        lines = f.read().split("\n")
    is_diff = False
    for number, line in enumerate(lines, 1):
        # Rows of tables, lines of equations and output, and diffs stay whole.
        is_diff = line == "```diff" or is_diff and line != "```"
        is_text = path.endswith(".md") and not line.startswith(("|", "    ")) and not is_diff
        if len(line) > 120 and (path.endswith((".hpp", ".cpp")) or is_text):
            findings.append(f"{path}:{number}: {len(line)} columns, 120 is the limit")
        if re.search(r"[ \t]+$", line):
            findings.append(f"{path}:{number}: trailing blanks")
    if len(lines) > 700 and path not in GENERATED:
        findings.append(f"{path}: {len(lines)} lines; is it one idea?")
    if path.endswith(".hpp") and not path.startswith("tests/") and "///" not in "\n".join(lines[:40]):
        findings.append(f"{path}: no description at the top")
for finding in findings:
    print(finding)
print(f"docs: {len(findings)} findings")
sys.exit(1 if findings else 0)
