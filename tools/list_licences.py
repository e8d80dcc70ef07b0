"""Writes packaging/licences.spdx: every library that the program loads, as Debian's packages tell their licences.

    /usr/bin/python3 tools/list_licences.py build/bin/bough > packaging/licences.spdx

The list is of the machine that it runs on: run it again where other versions are installed. packaging/release.py writes
the same list as SPDX JSON, for each file of a release.
"""
import functools
import os
import re
import subprocess
import sys

# What binds the whole, where a package's copyright file lists many for its many parts: as its library is built.
PARTS = {package: "BSD-3-Clause" for package in ("libamd2", "libcamd2", "libccolamd2", "libcolamd2", "libsuitesparseconfig5")}
PARTS |= {"libbtf1": "LGPL-2.1-or-later", "libklu1": "LGPL-2.1-or-later"}   # of SuiteSparse
PARTS |= {"libquadmath0": "LGPL-2.1-or-later", "libcom-err2": "MIT", "libmunge2": "LGPL-3.0-or-later"}
BINDING = {
    "suitesparse": "GPL-2.0-or-later", "fftw3": "GPL-2.0-or-later", "mumps": "CECILL-C", "scotch": "CECILL-C",
    "slepc": "BSD-2-Clause", "petsc": "BSD-2-Clause", "hypre": "Apache-2.0 OR MIT", "hdf5": "LicenseRef-BSD-style-HDF5",
    "sundials": "BSD-3-Clause", "openblas": "BSD-3-Clause", "metis": "Apache-2.0", "muparser": "BSD-2-Clause",
    "openmpi": "BSD-3-Clause", "fmtlib": "MIT", "tomlplusplus": "MIT", "matio": "BSD-2-Clause", "libmatio": "BSD-2-Clause",
    "libedit": "BSD-3-Clause", "libzip": "BSD-3-Clause", "pugixml": "MIT", "cpp-httplib": "MIT", "ncurses": "X11-distribute-modifications-variant",
    "superlu": "BSD-3-Clause", "superlu-dist": "BSD-3-Clause", "scalapack": "BSD-3-Clause", "arpack": "BSD-3-Clause",
    "trilinos": "BSD-3-Clause", "combblas": "BSD-3-Clause", "pmix": "BSD-3-Clause", "hwloc": "BSD-3-Clause",
    "libevent": "BSD-3-Clause", "glibc": "LGPL-2.1-or-later", "libaec": "BSD-2-Clause", "brotli": "MIT",
    "libbsd": "BSD-3-Clause AND BSD-2-Clause AND ISC", "libmd": "BSD-3-Clause AND BSD-2-Clause", "bzip2": "bzip2-1.0.6",
    "curl": "curl", "libffi": "MIT", "gmp": "LGPL-3.0-or-later OR GPL-2.0-or-later", "gnutls28": "LGPL-2.1-or-later",
    "krb5": "MIT", "nettle": "LGPL-3.0-or-later OR GPL-2.0-or-later", "libidn2": "LGPL-3.0-or-later OR GPL-2.0-or-later",
    "keyutils": "LGPL-2.0-or-later", "openldap": "OLDAP-2.8", "xz-utils": "LicenseRef-public-domain", "nghttp2": "MIT",
    "p11-kit": "BSD-3-Clause", "libpsl": "MIT", "rtmpdump": "LGPL-2.1-or-later", "libssh2": "BSD-3-Clause",
    "cyrus-sasl2": "BSD-Attribution-HPND-disclaimer", "openssl": "Apache-2.0", "libtasn1-6": "LGPL-2.1-or-later",
    "systemd": "LGPL-2.1-or-later", "libunistring": "LGPL-3.0-or-later OR GPL-2.0-or-later", "libx11": "MIT",
    "libxau": "MIT", "libxcb": "MIT", "libxdmcp": "MIT", "libyaml": "MIT", "libzstd": "BSD-3-Clause OR GPL-2.0-only",
    "ocl-icd": "BSD-2-Clause", "zlib": "Zlib",
    "gcc": "GPL-3.0-or-later WITH GCC-exception-3.1",
}
HEADERS = [("libeigen3-dev", "MPL-2.0"), ("libcli11-dev", "BSD-3-Clause"), ("nlohmann-json3-dev", "MIT"),
           ("pybind11-dev", "BSD-3-Clause")]


def run(*command):
    return subprocess.run(command, text=True, capture_output=True).stdout


OWNERS = {}    # of the paths asked for before: dpkg reads the lists of all packages each time


def find_owners(paths):
    """The Debian package of each file: {path: package}; files of no package are left out."""
    places = {path: (path, path.removeprefix("/usr"), "/usr" + path, os.path.realpath(path)) for path in paths
              if path not in OWNERS}
    owners = {}
    for line in run("dpkg-query", "-S", *{where for own in places.values() for where in own}).split("\n") if places else []:
        owner, _, where = line.partition(": ")
        if owner and "diversion" not in owner:
            owners.setdefault(where, owner.split(",")[0].split(":")[0])
    for path, own in places.items():
        OWNERS[path] = next((owners[where] for where in own if where in owners), None)
    return {path: OWNERS[path] for path in paths if OWNERS[path]}


def find_packages(program):
    return sorted(set(find_owners(re.findall(r"=> (/\S+)", run("ldd", program))).values()))


@functools.lru_cache(maxsize=None)
def describe(package, declared=None):
    """What Debian says of a package; declared: the licence, for headers that are compiled in."""
    version, source, source_version, page = run(
        "dpkg-query", "-W", "-f", "${Version}\t${source:Package}\t${source:Version}\t${Homepage}", package).split("\t")
    return {"package": package, "key": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", package), "version": version,
            "source": source, "source_version": source_version, "page": page or "NOASSERTION",
            "licence": declared or PARTS.get(package) or BINDING.get(re.sub(r"^gcc-\d+$", "gcc", source), "NOASSERTION"),
            "relation": "STATIC_LINK" if declared else "DYNAMIC_LINK",
            "comment": f"/usr/share/doc/{package}/copyright of Debian's source {source}"}


def conclude(descriptions):
    """The licence of a work with these parts: the GPL binds the whole, version 3 since other parts are Apache-2.0."""
    binding = [d["package"] for d in descriptions if re.fullmatch(r"GPL-[23]\.0-(only|or-later)", d["licence"])]
    return "GPL-3.0-or-later" if binding else "BSD-3-Clause"


EXTRACTED = [("LicenseRef-BSD-style-HDF5", "HDF5", "The HDF5 licence, in the style of BSD: "
              "/usr/share/doc/libhdf5-openmpi-103-1/copyright"),
             ("LicenseRef-public-domain", "public domain", "/usr/share/doc/liblzma5/copyright")]
COMMENT = ("The text is BSD-3-Clause; the program linked to Debian's PETSc, and so to SuiteSparse and FFTW, is passed on "
           "under the GPL. See docs/licences.md.")


def write_tags(version, descriptions):
    out = ["SPDXVersion: SPDX-2.3", "DataLicense: CC0-1.0", "SPDXID: SPDXRef-DOCUMENT", f"DocumentName: bough-{version}",
           f"DocumentNamespace: https://spdx.org/spdxdocs/bough-{version}", "Creator: Tool: tools/list_licences.py",
           "Created: 2026-11-23T00:00:00Z", "Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-bough", "",
           "PackageName: bough", "SPDXID: SPDXRef-bough", f"PackageVersion: {version}",
           "PackageDownloadLocation: NOASSERTION", "FilesAnalyzed: false",
           f"PackageLicenseConcluded: {conclude(descriptions)}", "PackageLicenseDeclared: BSD-3-Clause",
           "PackageCopyrightText: 2026, The Bough authors", f"PackageComment: <text>{COMMENT}</text>", ""]
    for d in descriptions:
        out += [f"PackageName: {d['package']}", f"SPDXID: {d['key']}", f"PackageVersion: {d['version']}",
                f"PackageDownloadLocation: {d['page']}", "FilesAnalyzed: false",
                f"PackageLicenseConcluded: {d['licence']}", f"PackageLicenseDeclared: {d['licence']}",
                "PackageCopyrightText: NOASSERTION", f"PackageComment: <text>{d['comment']}</text>",
                f"Relationship: SPDXRef-bough {d['relation']} {d['key']}", ""]
    for key, name, text in EXTRACTED:
        out += [f"LicenseID: {key}", f"ExtractedText: <text>{text}</text>", f"LicenseName: {name}", ""]
    return "\n".join(out)


def make_json(name, version, created, descriptions, files):
    """SPDX 2.3 as a dict. files: (path in the artefact, SHA-256, SHA-1, package or None for Bough's)."""
    def package(key, title, number, page, licence, declared, text):
        return {"SPDXID": key, "name": title, "versionInfo": number, "downloadLocation": page, "filesAnalyzed": False,
                "licenseConcluded": licence, "licenseDeclared": declared, "copyrightText": text}
    keys = {d["package"]: d["key"] for d in descriptions}
    packages = [package("SPDXRef-bough", "bough", version, "NOASSERTION", conclude(descriptions), "BSD-3-Clause",
                        "2026, The Bough authors")]
    packages += [{**package(d["key"], d["package"], d["version"], d["page"], d["licence"], d["licence"], "NOASSERTION"),
                  "sourceInfo": f"Debian source {d['source']} {d['source_version']}", "comment": d["comment"]}
                 for d in descriptions]
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-bough")]
    relations += [("SPDXRef-bough", d["relation"], d["key"]) for d in descriptions]
    listed = []
    for number, (path, sha256, sha1, owner) in enumerate(files):
        key = f"SPDXRef-File-{number}"
        listed.append({"SPDXID": key, "fileName": "./" + path, "copyrightText": "NOASSERTION",
                       "licenseConcluded": "NOASSERTION", "checksums": [
                           {"algorithm": "SHA1", "checksumValue": sha1}, {"algorithm": "SHA256", "checksumValue": sha256}]})
        relations.append((keys.get(owner, "SPDXRef-bough"), "CONTAINS", key))
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": name,
            "documentNamespace": f"https://spdx.org/spdxdocs/{name}",
            "creationInfo": {"created": created, "creators": ["Tool: packaging/release.py"]},
            "packages": packages, "files": listed,
            "hasExtractedLicensingInfos": [{"licenseId": key, "name": title, "extractedText": text}
                                           for key, title, text in EXTRACTED],
            "relationships": [{"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}
                              for one, kind, other in relations]}


def main():
    version = run(sys.argv[1], "--version").split("\n")[0].split()[1]
    descriptions = [describe(package) for package in find_packages(sys.argv[1])]
    descriptions += [describe(package, licence) for package, licence in HEADERS]
    print(write_tags(version, descriptions))


if __name__ == "__main__":
    main()
