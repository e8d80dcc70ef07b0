"""Forbidden words: hinge types in the tree, mutable, switched-off tests, silent skips; and the phrases of phrases.py."""
import re

import phrases
from common import finish, line_of, list_files, list_sources, read, strip_comments

findings = []


def forbid(paths, pattern, why, keep_comments=False):
    for path in paths:
        text = read(path) if keep_comments else strip_comments(read(path))
        for match in re.finditer(pattern, text):
            findings.append(f"{path}:{line_of(text, match.start())}: {why}: {match.group(0)}")


tests = [t for t in list_files(["tests"], (".cpp", ".hpp", ".py", ".txt")) if not t.startswith("tests/architecture/")]
forbid(list_files(["solver/tree"], (".hpp", ".cpp")),
       r"(?i)\b\w*(revolute|prismatic|universal|cylindrical|planar|spherical|hingetype)\w*",
       "the tree must not name a hinge type", keep_comments=True)
forbid(list_sources(), r"\bmutable\b", "const means const")
forbid(list_sources(), r"\b(TODO|FIXME|XXX|HACK)\b", "finish it or write an issue", keep_comments=True)
forbid(tests, r"\bDISABLED_\w*", "no switched-off tests", keep_comments=True)
forbid(tests, r"GTEST_SKIP\(\)\s*;", "say why it is skipped")
# Guards against hangs.
CLOCKS = {"tests/cli/browser.py", "tests/cli/edit_terminal_test.py", "tests/cli/ranks_test.py"}
forbid([t for t in tests if t not in CLOCKS], r"\btime\.sleep\(|\bsleep_for\(|(?<!\w)::u?sleep\(|\b(?:monotonic|perf_counter)\(",
       "no test depends on the time it takes: start_held of tests/cli/support.py stops a process at a point")
forbid(list_files(["solver"], (".hpp", ".cpp")), r"(?m)^(?:static|thread_local)\s+(?!const\b|constexpr\b)[\w:<>]+\s+\w+\s*(?:=|;|\{)",
       "no globals")
new_phrases, num_fallen = phrases.check()
findings += new_phrases
if num_fallen:
    print(f"counts of {num_fallen} files have fallen; lower them: python3 tests/architecture/phrases.py . --lower")
finish(findings, "words")
