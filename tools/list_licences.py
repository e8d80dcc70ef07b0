"""Writes packaging/licences.spdx: every library that the program loads, as Debian's packages tell their licences.

    /usr/bin/python3 tools/list_licences.py build/bin/bough > packaging/licences.spdx

The list is of the machine that it runs on: run it again where other versions are installed.
"""
import os
import re
import subprocess
import sys

# What binds the whole, where a package's copyright file lists many for its many parts: as its library is built.
PARTS = {package: "BSD-3-Clause" for package in ("libamd2", "libcamd2", "libccolamd2", "libcolamd2", "libsuitesparseconfig5")}
PARTS |= {"libbtf1": "LGPL-2.1-or-later", "libklu1": "LGPL-2.1-or-later"}   # of SuiteSparse
BINDING = {
    "suitesparse": "GPL-2.0-or-later", "fftw3": "GPL-2.0-or-later", "mumps": "CECILL-C", "scotch": "CECILL-C",
    "slepc": "BSD-2-Clause", "petsc": "BSD-2-Clause", "hypre": "Apache-2.0 OR MIT", "hdf5": "LicenseRef-BSD-style-HDF5",
    "sundials": "BSD-3-Clause", "openblas": "BSD-3-Clause", "metis": "Apache-2.0", "muparser": "BSD-2-Clause",
    "openmpi": "BSD-3-Clause", "fmtlib": "MIT", "tomlplusplus": "MIT", "matio": "BSD-2-Clause",
    "libedit": "BSD-3-Clause", "libzip": "BSD-3-Clause", "pugixml": "MIT", "ncurses": "X11-distribute-modifications-variant", "superlu": "BSD-3-Clause", "superlu-dist": "BSD-3-Clause", "scalapack": "BSD-3-Clause", "arpack": "BSD-3-Clause",
}
HEADERS = [("libeigen3-dev", "MPL-2.0"), ("libcli11-dev", "BSD-3-Clause"), ("nlohmann-json3-dev", "MIT"),
           ("pybind11-dev", "BSD-3-Clause")]


def run(*command):
    return subprocess.run(command, text=True, capture_output=True).stdout


def find_packages(program):
    places = [(path, path.removeprefix("/usr"), "/usr" + path, os.path.realpath(path))
              for path in re.findall(r"=> (/\S+)", run("ldd", program))]
    owners = {}
    for line in run("dpkg-query", "-S", *{where for own in places for where in own}).split("\n"):
        owner, _, where = line.partition(": ")
        if owner and "diversion" not in owner:
            owners.setdefault(where, owner.split(",")[0].split(":")[0])
    return sorted({next(owners[where] for where in own if where in owners)
                   for own in places if any(where in owners for where in own)})


def describe(package, declared):
    version, source, page = run("dpkg-query", "-W", "-f", "${Version}\t${source:Package}\t${Homepage}", package).split("\t")
    key = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", package)
    licence = declared or PARTS.get(package) or BINDING.get(source, "NOASSERTION")
    return [f"PackageName: {package}", f"SPDXID: {key}", f"PackageVersion: {version}",
            f"PackageDownloadLocation: {page or 'NOASSERTION'}", "FilesAnalyzed: false",
            f"PackageLicenseConcluded: {licence}", f"PackageLicenseDeclared: {licence}", "PackageCopyrightText: NOASSERTION",
            f"PackageComment: <text>/usr/share/doc/{package}/copyright of Debian's source {source}</text>",
            f"Relationship: SPDXRef-bough {'DYNAMIC_LINK' if not declared else 'STATIC_LINK'} {key}", ""]


def main():
    version = run(sys.argv[1], "--version").split("\n")[0].split()[1]
    out = ["SPDXVersion: SPDX-2.3", "DataLicense: CC0-1.0", "SPDXID: SPDXRef-DOCUMENT", f"DocumentName: bough-{version}",
           f"DocumentNamespace: https://spdx.org/spdxdocs/bough-{version}", "Creator: Tool: tools/list_licences.py",
           "Created: 2026-11-23T00:00:00Z", "Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-bough", "",
           "PackageName: bough", "SPDXID: SPDXRef-bough", f"PackageVersion: {version}",
           "PackageDownloadLocation: NOASSERTION", "FilesAnalyzed: false",
           "PackageLicenseConcluded: GPL-3.0-or-later", "PackageLicenseDeclared: BSD-3-Clause",
           "PackageCopyrightText: 2026, The Bough authors",
           "PackageComment: <text>The text is BSD-3-Clause; the program linked to Debian's PETSc, and so to SuiteSparse and "
           "FFTW, is passed on under the GPL. See docs/licences.md.</text>", ""]
    for package in find_packages(sys.argv[1]):
        out += describe(package, None)
    for package, licence in HEADERS:
        out += describe(package, licence)
    out += ["LicenseID: LicenseRef-BSD-style-HDF5", "ExtractedText: <text>The HDF5 licence, in the style of BSD: "
            "/usr/share/doc/libhdf5-openmpi-103-1/copyright</text>", "LicenseName: HDF5"]
    print("\n".join(out))


if __name__ == "__main__":
    main()
