"""The diffs that the pages docs/developer/add-a-*.md keep apply to the sources as they are, and each is in at most three
product files and one test.

trial_diffs_test.py SOURCE
trial_diffs_test.py SOURCE --print add-a-card.md     the diff of one page, for git apply
"""
import os
import re
import subprocess
import sys

PAGES = ["add-a-card.md", "add-a-key.md", "add-a-sensor.md", "add-a-format.md", "add-a-command.md"]
MAX_PRODUCT_FILES, MAX_TESTS = 3, 1


def read_diff(source, page):
    with open(os.path.join(source, "docs/developer", page), encoding="utf-8") as f:
        found = re.findall(r"^```diff\n(.*?)^```$", f.read(), re.MULTILINE | re.DOTALL)
    return "".join(found)


def check(source, page):
    """Returns the faults of a page."""
    diff = read_diff(source, page)
    files = re.findall(r"^\+\+\+ b/(.+)$", diff, re.MULTILINE)
    tests = [name for name in files if name.startswith("tests/")]
    product = [name for name in files if not name.startswith(("tests/", "docs/"))]
    wrong = []
    if not product or not tests:
        wrong.append("keeps no diff of product files and a test")
    if len(product) > MAX_PRODUCT_FILES:
        wrong.append(f"{len(product)} product files, expected {MAX_PRODUCT_FILES} at most: {', '.join(product)}")
    if len(tests) > MAX_TESTS:
        wrong.append(f"{len(tests)} tests, expected {MAX_TESTS}: {', '.join(tests)}")
    applied = subprocess.run(["git", "apply", "--check", "-"], cwd=source, input=diff, text=True, capture_output=True)
    if applied.returncode != 0:
        wrong.append("does not apply; correct it (--print, git apply --3way, git diff):\n" + applied.stderr.strip())
    return [f"docs/developer/{page}: error: {what}" for what in wrong]


def main():
    source = os.path.abspath(sys.argv[1])
    if "--print" in sys.argv:
        print(read_diff(source, sys.argv[sys.argv.index("--print") + 1]), end="")
        return 0
    faults = [fault for page in PAGES for fault in check(source, page)]
    print("\n".join(faults) or f"{len(PAGES)} diffs apply")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
