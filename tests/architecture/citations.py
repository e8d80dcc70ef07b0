"""Every decision record, example and document that a file points to exists."""
import os
import re

from common import ROOT, finish, line_of, list_files, list_sources, read

findings = []
pages = list_files(["docs", "data", "tests", "cli"], (".md",)) + ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"]
decisions = {name[:4] for name in os.listdir(os.path.join(ROOT, "docs/adr")) if re.match(r"\d{4}-.*\.md$", name)}
for path in list_sources() + pages + list_files(["tests"], (".cpp", ".py")):
    if path.startswith("tests/architecture/"):
        continue
    text = read(path)
    for match in re.finditer(r"\badr/(\d{4})|\bADR[ -](\d{4})", text):
        number = match.group(1) or match.group(2)
        if number not in decisions:
            findings.append(f"{path}:{line_of(text, match.start())}: decision record {number} does not exist")
for page in pages:
    # Lambdas in diffs of C++ look like links.
    text = re.sub(r"(?ms)^```diff$.*?^```$", lambda diff: "\n" * diff.group().count("\n"), read(page))
    for match in re.finditer(r"\]\(([^)#:]+?)(?:#[^)]*)?\)", text):
        target = os.path.normpath(os.path.join(ROOT, os.path.dirname(page), match.group(1)))
        if not os.path.exists(target):
            findings.append(f"{page}:{line_of(text, match.start())}: link to {match.group(1)}, which does not exist")
finish(findings, "citations")
