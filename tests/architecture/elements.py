"""Every element header says where its formulas are from: an author with a year, or a report with its equation."""
import re

from common import finish, list_files, read

SOURCE = re.compile(r"\b(1[89]|20)\d\d\b|@cite|Quick Reference|Theoretical Manual|\bNASA-CR-\d+")
findings = []
for header in list_files(["fe/elements"], (".hpp",)):
    if ": public Element" not in read(header):
        continue
    comments = "\n".join(re.findall(r"//[^\n]*", read(header)))
    if not SOURCE.search(comments):
        findings.append(f"{header}: no source cited; name the book or paper with its year")
finish(findings, "elements")
