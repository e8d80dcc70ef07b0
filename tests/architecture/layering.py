"""Who may include whom (docs/adr/0007): rooms, sub-rooms and outside libraries, by the include lines."""
import os
import re

from common import ROOMS, ROOT, finish, line_of, list_sources, read, strip_comments

RECORDS = ["base", "formats/records"]
# fe by question, from the ground up; each may use those before it.
FE = ["linear", "shape", "sections", "elements", "corotational", "cards", "model", "matrices", "loads", "statics"]
# solver likewise; integrate and statespace need none of it.
SOLVER = ["state", "text", "bodies", "functions", "hinges", "tree", "forces", "loops", "motion", "signals", "control",
          "sensors", "actuators", "system", "builder", "integrate", "simulate", "statespace", "linear"]
# First match wins; a folder may always include itself and what lies below it.
MAY_INCLUDE = [
    ("base", []),
    ("formats/records", ["base"]),
    ("formats/nastran", RECORDS),
    ("formats/hdf5", RECORDS),
    ("formats/toml", RECORDS),
    ("formats/export", RECORDS),
    ("formats/listing", RECORDS),
    ("formats/matrices", RECORDS + ["formats/nastran/reader.hpp", "formats/hdf5/sparse_file.hpp",
                                    "formats/hdf5/inspect.hpp"]),
    ("formats/flat", RECORDS),
    ("formats/fmu", RECORDS),
    ("formats/flx", RECORDS),
    ("formats/sid", RECORDS),
    ("formats/mbdyn", RECORDS),
    ("fe/shape", RECORDS + ["fe/sections/beam_property.hpp"]),
    *[("fe/" + room, RECORDS + ["fe/" + below for below in FE[:i]]) for i, room in enumerate(FE)],
    ("modal", RECORDS + ["fe"]),
    ("stiffening", RECORDS + ["fe", "modal"]),
    ("solver/integrate", RECORDS),
    ("solver/statespace", RECORDS),
    *[("solver/" + room, RECORDS + ["solver/" + below for below in SOLVER[:i]]) for i, room in enumerate(SOLVER)],
    ("embed", RECORDS + ["formats/toml", "formats/flx", "formats/flat", "solver"]),
    ("report", RECORDS),
    ("analysis", ["base", "formats", "report", "fe", "modal", "stiffening", "solver", "embed", "cosim"]),
    ("cosim", RECORDS + ["formats/fmu", "solver/control", "embed/fmi2_types.h", "embed/fmi3_types.h"]),
]
# Outside headers and the only folders that may see them.
OUTSIDE = [
    (r"^petsc", ["fe", "modal", "stiffening", "cli/common/versions.cpp"]),
    (r"^slepc", ["fe/linear/petsc.cpp", "modal", "cli/common/versions.cpp"]),
    (r"^mpi\.h", ["fe"]),
    (r"^metis", ["fe"]),
    (r"^zmumps", ["fe/linear"]),
    (r"^(hdf5|H5)", ["formats/hdf5", "cli/common/versions.cpp"]),
    (r"^toml\+\+", ["formats/toml"]),
    (r"^matio", ["formats/matrices"]),
    (r"^zip\.h", ["formats/fmu"]),
    (r"^pugixml", ["formats/fmu"]),
    (r"^nlohmann", ["formats/toml", "report", "analysis", "cli"]),
    (r"^muParser", ["solver/text/formulas.cpp"]),
    (r"^dlfcn", ["solver/control/library.cpp", "cosim/slave.cpp", "fe/linear/petsc.cpp", "cli/common/memory_limit.cpp"]),
    (r"^CLI/", ["cli"]),
    (r"^httplib", ["cli/studio/server.cpp"]),
    (r"^fmt/", ["analysis", "cli", "formats", "report"]),
    (r"^(sundials|cvode|nvector|sunlinsol|sunmatrix|sunnonlinsol)", ["solver/integrate", "cli/common/versions.cpp"]),
]


def lies_in(path, folders):
    return any(path == f or path.startswith(f + "/") for f in folders)


# Seen by nobody outside: the integrators and the linear models stand above the rest of the solver.
TOP = ["report", "solver/simulate", "solver/linear", "analysis", "cli"]
ABOVE = ["embed", "analysis"]  # stand above them

findings = []
for source in list_sources():
    text = strip_comments(read(source))
    rule = next((r for r in MAY_INCLUDE if source.startswith(r[0] + "/")), None)
    for match in re.finditer(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', text, re.M):
        kind, target = match.groups()
        where = f"{source}:{line_of(text, match.start())}"
        header = target
        if kind == '"' and header.split("/")[0] in ROOMS and "/" in header:
            if not os.path.exists(os.path.join(ROOT, header)):
                if header != "base/version.hpp":
                    findings.append(f"{where}: includes {target}, which does not exist")
            elif rule and not lies_in(header, [rule[0]] + rule[1]):
                findings.append(f"{where}: {rule[0]} may include {', '.join(rule[1]) or 'nothing'}, found {target}")
            elif rule and any(lies_in(header, [top]) and not lies_in(source, [top] + ABOVE) for top in TOP):
                findings.append(f"{where}: no library room below includes {target}")
            continue
        # Both lie in one folder where they are installed.
        if (source, target) == ("embed/bough.hpp", "bough.h"):
            continue
        if kind == '"' and rule:
            findings.append(f'{where}: spell it by its path in the repository, found "{target}"')
        for pattern, folders in OUTSIDE:
            if re.match(pattern, target) and not lies_in(source, folders):
                findings.append(f"{where}: only {', '.join(folders)} may see <{target}>")

# A class is implemented in the folder of its header: a room below gets no member function from a room above.
def get_folder(source):
    return os.path.dirname(source).removesuffix("/detail")


declared, sources = {}, {source: strip_comments(read(source)) for source in list_sources()}
for source, text in sources.items():
    if source.endswith(".hpp"):
        for match in re.finditer(r"^(?:class|struct) (\w+)(?: final)?\s*[:{]", text, re.M):
            declared.setdefault(match.group(1), set()).add(get_folder(source))
for source, text in sources.items():
    for match in re.finditer(r"^\w[^(\n]*?\b(\w+)::~?\w+\(", text, re.M):
        name, folders = match.group(1), declared.get(match.group(1), set())
        if not folders or get_folder(source) in folders or re.search(rf"\b(class|struct) {name}\b", text):
            continue
        findings.append(f"{source}:{line_of(text, match.start())}: {name} is implemented in {', '.join(folders)}")
finish(findings, "layering")
