"""Each error id of the sources has one row in docs/errors/*.md and a test that names it, and the other way round."""
import re

from common import finish, line_of, list_files, list_sources, read, strip_comments

ROOMS = "base deck nastran hdf5 toml matrices embed export flat fmu flx report vtu spec file fe model modal stiffening reduce system solver function sensor control run linear equilibrium select split cli batch studio".split()
# "room.kebab-words" as a whole string literal; names of files have other endings.
LITERAL = re.compile(r'"((?:%s)\.[a-z][a-z0-9]*(?:-[a-z0-9]+)*)"' % "|".join(ROOMS))
FILE_ENDINGS = {"h5", "toml", "html", "bdf", "csv", "svg", "md", "json", "dat", "tmp", "part"}

used, rows, tested = {}, {}, {}
for source in list_sources():
    text = strip_comments(read(source))
    for match in LITERAL.finditer(text):
        if match.group(1).split(".")[1] not in FILE_ENDINGS:
            used.setdefault(match.group(1), f"{source}:{line_of(text, match.start())}")
findings = []
for page in list_files(["docs/errors"], (".md",)):
    text = read(page)
    for match in re.finditer(r"^\|\s*`?([a-z0-9]+\.[a-z0-9-]+)`?\s*\|", text, re.M):
        where = f"{page}:{line_of(text, match.start())}"
        if match.group(1) in rows:
            findings.append(f"{where}: second row for {match.group(1)}, first at {rows[match.group(1)]}")
        rows.setdefault(match.group(1), where)
for test in list_files(["tests"], (".cpp", ".hpp", ".py")):
    if test.startswith("tests/architecture/"):
        continue
    for match in re.finditer(r"[a-z0-9]+\.[a-z][a-z0-9]*(?:-[a-z0-9]+)*", read(test)):
        tested.setdefault(match.group(0), test)

for error, where in sorted(used.items()):
    if error not in rows:
        findings.append(f"{where}: {error} has no row in docs/errors/")
    if error not in tested:
        findings.append(f"{where}: {error} is named by no test")
findings += [f"{where}: {error} is not in the sources; retire it by a table of retired ids"
             for error, where in sorted(rows.items()) if error not in used]
print(f"{len(used)} ids used, {len(rows)} documented")
finish(findings, "errors")
