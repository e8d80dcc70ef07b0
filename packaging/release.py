"""./dev release: the files of a release out of a build folder, for Linux of the glibc that they were built with.

    /usr/bin/python3 packaging/release.py BUILD [PART ...] [--output FOLDER] [--check]

Parts (default: all)
    program   bough-V-linux-x86_64.tar.gz, program and libraries in one folder that may be moved
    library   libbough-V-linux-x86_64.tar.gz, libbough.so, bough.h and bough.hpp alone: no part under the GPL
    wheel     bough-V-cp3N-cp3N-manylinux_2_M_x86_64.whl, the module and the program for pip
    source    bough-V.tar.gz, of the last commit
Next to them: for each archive of binaries NAME.spdx.json (SPDX 2.3), and SHA256SUMS.

--check: looks whether a release could be made here and is consistent, and makes nothing
SOURCE_DATE_EPOCH is the time of all files in the archives; default: that of the last commit.
"""
import argparse
import datetime
import json
import os
import re
import shutil
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [os.path.join(ROOT, "packaging"), os.path.join(ROOT, "tools")]
import bundle  # noqa: E402
import list_licences  # noqa: E402
from bundle import COMPILER, GLIBC, ReleaseError, run  # noqa: E402

MPI = "bough-openmpi"   # next to libmpi; fe/linear/petsc.cpp looks for it there
COMPONENTS = "lib/x86_64-linux-gnu/openmpi/lib/openmpi3"   # where Debian's Open MPI has its parts, below its prefix
PMIX = "/usr/lib/x86_64-linux-gnu/pmix2"
PARTS = ("program", "library", "wheel", "source")
# As docs/licences.md states them.
LICENCES = {"program": "GPL-3.0-or-later", "library": "BSD-3-Clause", "wheel": "GPL-3.0-or-later"}
LIBRARY_HEADERS = ("libeigen3-dev", "nlohmann-json3-dev")
RECIPES = [f"packaging/recipes/{name}" for name in ("conda/recipe.yaml", "spack/package.py", "homebrew/bough.rb")]


def is_system(name):
    return GLIBC.fullmatch(name) is not None


def is_system_of_wheel(name):
    return is_system(name) or COMPILER.fullmatch(name) is not None


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as f:
        return f.read()


def write(path, text, mode=0o644):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)
    os.chmod(path, mode)


def get_version():
    return re.search(r"project\(Bough VERSION ([\d.]+)", read("CMakeLists.txt")).group(1)


def get_epoch():
    given = os.environ.get("SOURCE_DATE_EPOCH")
    return int(given or run("git", "-C", ROOT, "log", "-1", "--format=%ct"))


def install(build, component, prefix):
    run("cmake", "--install", build, "--component", component, "--prefix", prefix, "--strip")


def find(folder, name):
    found = [path for path in bundle.list_files(folder) if os.path.basename(path) == name]
    if not found:
        raise ReleaseError(f"{folder} has no {name}; build it first: ./dev build")
    return os.path.join(folder, found[0])


class Release:
    """What the parts share: the build folder, the time, the owners of copied files."""

    def __init__(self, build, output):
        self.build, self.output = os.path.abspath(build), os.path.abspath(output)
        self.version, self.epoch = get_version(), get_epoch()
        self.written = []

    def list_mpi(self, is_outside):
        """Open MPI that is opened at run time: {file: its libraries}, components and orterun."""
        folder = os.path.join("/usr", COMPONENTS)
        if not os.path.isdir(folder) or "libmpi.so.40" not in bundle.list_libraries([self.get_program()], is_outside):
            raise ReleaseError(f"no Open MPI 4 as Debian has it ({folder}): its components go into the release")
        files = {**bundle.list_components(folder, is_outside), **bundle.list_components(PMIX + "/lib/pmix", is_outside)}
        for name in ("orterun", "orted"):
            files["/usr/bin/" + name] = bundle.list_libraries(["/usr/bin/" + name], is_outside)
        return files

    def get_program(self):
        return os.path.join(self.build, "bin/bough")

    def add_mpi(self, folder, files):
        """Components, mpirun and its messages below folder/bough-openmpi."""
        top = os.path.join(folder, MPI)
        for path in files:
            name = os.path.basename(path)
            place = "pmix" if name.startswith("pmix_") else COMPONENTS if name.endswith(".so") else "bin"
            target = os.path.join(top, place, name)
            bundle.copy(path, target)
            bundle.set_path(target, os.path.relpath(folder, os.path.dirname(target)))
        for source, place in (("/usr/share/openmpi", "share/openmpi"), (PMIX + "/share/pmix", "share/pmix")):
            for name in sorted(os.listdir(source)):
                if re.fullmatch(r"help-.*\.txt", name):
                    bundle.copy(os.path.join(source, name), os.path.join(top, place, name))

    def find_owners(self, libraries, files=()):
        """{package: description} of what is copied, and those of headers that are compiled in."""
        owners = list_licences.find_owners([*libraries.values(), *files])
        lost = [path for path in [*libraries.values(), *files] if path not in owners]
        if lost:
            raise ReleaseError(f"of no Debian package, so that their licence is not known: {' '.join(lost)}")
        return owners

    def describe(self, owners, headers):
        descriptions = [list_licences.describe(package) for package in sorted(set(owners.values()))]
        descriptions += [list_licences.describe(package, licence) for package, licence in list_licences.HEADERS
                         if package in headers]
        unread = [d["package"] for d in descriptions if d["licence"] == "NOASSERTION"]
        if unread:
            raise ReleaseError(f"nobody has read the licences of {' '.join(unread)}: add them to tools/list_licences.py")
        return descriptions

    def add_documents(self, folder, descriptions):
        """Licence of the whole and of each part, and which sources belong to them."""
        licence = list_licences.conclude(descriptions)
        bundle.copy(os.path.join(ROOT, "LICENSE"), os.path.join(folder, "LICENSE"))
        for d in descriptions:
            bundle.copy(f"/usr/share/doc/{d['package']}/copyright", os.path.join(folder, "licences", d["package"]))
        if licence.startswith("GPL"):
            bundle.copy("/usr/share/common-licenses/GPL-3", os.path.join(folder, "licences/GPL-3"))
        lines = [f"Bough {self.version}: its text is BSD-3-Clause (LICENSE). This archive as a whole: {licence}.",
                 "Its parts, with the version of Debian's source package that each was built from (apt-get source",
                 "SOURCE=VERSION); their licences are in the folder licences.", ""]
        lines += [f"{d['package']:28} {d['source']}={d['source_version']:24} {d['licence']}" for d in descriptions]
        write(os.path.join(folder, "PARTS.txt"), "\n".join(lines) + "\n")
        return licence

    def write_sbom(self, path, folder, descriptions, owners):
        """SPDX JSON: each file with checksums and the package that it is of, by the name of the file."""
        by_name = {os.path.basename(where): package for where, package in owners.items()}
        files = []
        for name in bundle.list_files(folder):
            where = os.path.join(folder, name)
            if not os.path.islink(where):
                files.append((name, bundle.hash_file(where), bundle.hash_file(where, "sha1"),
                              by_name.get(os.path.basename(name))))
        created = datetime.datetime.fromtimestamp(self.epoch, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
        name = os.path.basename(path).removesuffix(".spdx.json")
        table = list_licences.make_json(name, self.version, created, descriptions, files)
        self.keep(path, json.dumps(table, indent=1) + "\n")

    def keep(self, path, text=None):
        if text is not None:
            write(path, text)
        self.written.append(path)
        print(f"{os.path.getsize(path) / 1e6:8.1f} MB  {os.path.relpath(path)}", flush=True)

    def name(self, what):
        return f"{what}-{self.version}-linux-x86_64"

    def collect(self, roots, outside, with_mpi):
        """Libraries by soname, files of Open MPI, owners of all."""
        libraries = bundle.list_libraries(roots, outside)
        files = self.list_mpi(outside) if with_mpi else {}
        for needed in files.values():
            for soname, path in needed.items():
                if libraries.setdefault(soname, path) != path:
                    raise ReleaseError(f"two files of {soname}: {libraries[soname]} and {path}")
        libraries = {name: path for name, path in libraries.items() if not path.startswith(self.build + os.sep)}
        owners = self.find_owners(libraries, files)
        # By soname too: that is what the file is called here.
        owners |= {name: owners[path] for name, path in libraries.items()}
        return libraries, files, owners

    def make_program(self, work):
        folder = os.path.join(work, self.name("bough"))
        install(self.build, "bough", folder)
        program, binary = os.path.join(folder, "bin/bough"), find(folder, "bough_fmu.so")
        libraries, files, owners = self.collect([self.get_program(), binary], is_system, True)
        bundle.add_libraries(libraries, os.path.join(folder, "lib"))
        self.add_mpi(os.path.join(folder, "lib"), files)
        bundle.set_path(program, "../lib")
        bundle.copy(os.path.join(ROOT, "packaging/bough-mpirun"), os.path.join(folder, "bin/bough-mpirun"))
        descriptions = self.describe(owners, [name for name, _ in list_licences.HEADERS if name != "pybind11-dev"])
        documents = os.path.join(folder, "share/doc/bough")
        self.demand_licence("program", descriptions)
        self.add_documents(documents, descriptions)
        for name in ("README.md", "CHANGELOG.md"):
            bundle.copy(os.path.join(ROOT, name), os.path.join(documents, name))
        self.finish(folder, descriptions, owners)

    def make_library(self, work):
        folder = os.path.join(work, self.name("libbough"))
        everything = os.path.join(work, "libbough")
        for component in ("libbough1", "libbough-dev"):
            install(self.build, component, everything)
        for name in ("bough.h", "bough.hpp"):
            bundle.copy(os.path.join(everything, "include", name), os.path.join(folder, "include", name))
        real = os.path.realpath(find(everything, "libbough.so"))
        soname = re.search(r"\[(libbough\.so\.\d+)\]", run("readelf", "-d", real)).group(1)
        bundle.copy(real, os.path.join(folder, "lib", soname))
        os.symlink(soname, os.path.join(folder, "lib/libbough.so"))
        text = re.sub(r"(?m)^prefix=.*$", "prefix=${pcfiledir}/../..", self.read(find(everything, "bough.pc")))
        text = re.sub(r"/lib/x86_64-linux-gnu\b", "/lib", text)
        write(os.path.join(folder, "lib/pkgconfig/bough.pc"), text)
        libraries, _, owners = self.collect([real], is_system_of_wheel, False)
        bundle.add_libraries(libraries, os.path.join(folder, "lib"))
        bundle.set_path(os.path.join(folder, "lib", soname), ".")
        shutil.copytree(os.path.join(ROOT, "data/examples/hosts"), os.path.join(folder, "share/bough/examples/hosts"))
        descriptions = self.describe(owners, LIBRARY_HEADERS)
        self.demand_licence("library", descriptions)
        self.add_documents(os.path.join(folder, "share/doc/bough"), descriptions)
        self.finish(folder, descriptions, owners)

    @staticmethod
    def read(path):
        with open(path, encoding="utf-8") as f:
            return f.read()

    @staticmethod
    def demand_licence(part, descriptions):
        found = list_licences.conclude(descriptions)
        if found != LICENCES[part]:
            raise ReleaseError(f"{part}: what is linked asks for {found}, docs/licences.md says {LICENCES[part]}")

    def finish(self, folder, descriptions, owners):
        archive = os.path.join(self.output, os.path.basename(folder) + ".tar.gz")
        bundle.write_tar(folder, archive, self.epoch)
        self.keep(archive)
        self.write_sbom(archive.removesuffix(".tar.gz") + ".spdx.json", folder, descriptions, owners)

    def make_wheel(self, work, module):
        """module: the compiled _bough of one CPython."""
        tag = re.search(r"cpython-3(\d+)", os.path.basename(module)).group(1)
        folder = os.path.join(work, "wheel-3" + tag)
        data = f"bough-{self.version}.data"
        staged = os.path.join(work, "staged-3" + tag)
        install(self.build, "bough", staged)
        libraries, files, owners = self.collect([module, self.get_program()], is_system_of_wheel, True)
        libs = os.path.join(folder, "bough.libs")
        bundle.add_libraries(libraries, libs)
        self.add_mpi(libs, files)
        for name in sorted(os.listdir(os.path.join(ROOT, "python/bough"))):
            if name.endswith((".py", ".pyi", ".typed")):
                bundle.copy(os.path.join(ROOT, "python/bough", name), os.path.join(folder, "bough", name))
        compiled = os.path.join(folder, "bough", os.path.basename(module))
        bundle.copy(module, compiled)
        run("strip", "--strip-unneeded", compiled)
        bundle.set_path(compiled, "../bough.libs")
        # The program, with what it looks for next to itself, below the prefix of the environment.
        program = os.path.join(folder, data, "scripts/bough")
        bundle.copy(os.path.join(staged, "bin/bough"), program)
        bundle.set_path(program, *(f"../lib/python3.{tag}/{name}/bough.libs" for name in ("site-packages", "dist-packages")))
        bundle.copy(os.path.join(ROOT, "packaging/bough-mpirun"), os.path.join(folder, data, "scripts/bough-mpirun"))
        for path in bundle.list_files(staged):
            if not path.startswith("bin/"):
                bundle.copy(os.path.join(staged, path), os.path.join(folder, data, "data", path))
        binary = find(os.path.join(folder, data, "data"), "bough_fmu.so")
        descriptions = self.describe(owners, [name for name, _ in list_licences.HEADERS])
        info = os.path.join(folder, f"bough-{self.version}.dist-info")
        self.demand_licence("wheel", descriptions)
        licence = self.add_documents(os.path.join(info, "licenses"), descriptions)
        major, minor = bundle.find_glibc([compiled, program, binary, *(os.path.join(libs, name) for name in libraries)])
        label = f"cp3{tag}-cp3{tag}-manylinux_{major}_{minor}_x86_64"
        write(os.path.join(info, "METADATA"), "\n".join([
            "Metadata-Version: 2.1", "Name: bough", f"Version: {self.version}",
            "Summary: From a finite-element model to a flexible multibody simulation", f"License: {licence}",
            f"Requires-Python: ==3.{tag}.*", "Requires-Dist: numpy", "Requires-Dist: h5py",
            "Description-Content-Type: text/markdown", "", read("docs/python.md")]))
        write(os.path.join(info, "WHEEL"), "\n".join([
            "Wheel-Version: 1.0", "Generator: packaging/release.py", "Root-Is-Purelib: false", f"Tag: {label}", ""]))
        wheel = os.path.join(self.output, f"bough-{self.version}-{label}.whl")
        bundle.write_wheel(folder, wheel, self.epoch)
        self.keep(wheel)
        self.write_sbom(wheel.removesuffix(".whl") + ".spdx.json", folder, descriptions, owners)

    def make_source(self):
        archive = os.path.join(self.output, f"bough-{self.version}.tar.gz")
        with tempfile.TemporaryDirectory() as work:
            folder = os.path.join(work, f"bough-{self.version}")
            run("git", "-C", ROOT, "archive", f"--prefix=bough-{self.version}/", "-o", os.path.join(work, "all.tar"), "HEAD")
            run("tar", "-xf", os.path.join(work, "all.tar"), "-C", work)
            bundle.write_tar(folder, archive, self.epoch)
        self.keep(archive)

    def write_sums(self):
        lines = [f"{bundle.hash_file(path)}  {os.path.basename(path)}\n" for path in sorted(self.written)]
        self.keep(os.path.join(self.output, "SHA256SUMS"), "".join(lines))

    def find_modules(self):
        """The compiled modules of the build: one, and those of other CPythons (BOUGH_OTHER_PYTHONS)."""
        folder = os.path.join(self.build, "python/bough")
        names = [name for name in sorted(os.listdir(folder)) if re.fullmatch(r"_bough\.cpython-3\d+-.*\.so", name)]
        if not names:
            raise ReleaseError(f"{folder} has no module: Debian's pybind11-dev and python3-dev, then ./dev build")
        return [os.path.join(folder, name) for name in names]


def find_undefined(path):
    """Names of Bough that a file uses and contains not: compiled of other sources than the rest."""
    names = set(re.findall(r"(?m) U (_ZNK?5bough\w+)", run("nm", "-D", "--undefined-only", path)))
    return sorted(run("c++filt", *names).split("\n")[:-1]) if names else []


def check(release, parts):
    """What would make these parts wrong, a line each; makes nothing."""
    problems = []
    for tool in ("c++filt", "cmake", "git", "ldd", "nm", "patchelf", "readelf", "strip"):
        if not shutil.which(tool):
            problems.append(f"no {tool}: apt install it")
    for path in ("CITATION.cff", "packaging/changelog", "packaging/licences.spdx", *RECIPES):
        if not re.search(rf"(?<![\d.]){re.escape(release.version)}(?![\d.])", read(path)):
            problems.append(f"{path} does not name version {release.version} of CMakeLists.txt")
    for part in parts:
        try:
            if part != "source":
                problems += check_links(release, part)
        except ReleaseError as error:
            problems.append(f"{part}: {error}")
    return problems


def check_links(release, part):
    outside = is_system if part == "program" else is_system_of_wheel
    if part == "library":
        paths, headers = [os.path.join(release.build, "lib/libbough.so")], LIBRARY_HEADERS
    else:
        paths, headers = [release.get_program()], [name for name, _ in list_licences.HEADERS]
        paths += release.find_modules() if part == "wheel" else []
    for path in paths:
        missing = find_undefined(path)
        if missing:
            raise ReleaseError(f"{path} lacks {missing[0]}; build it again: ./dev release")
    libraries, _, owners = release.collect(paths, outside, part != "library")
    descriptions = release.describe(owners, headers)
    release.demand_licence(part, descriptions)
    major, minor = bundle.find_glibc([*paths, *libraries.values()])
    print(f"{part}: {len(libraries)} libraries of {len(set(owners.values()))} packages, "
          f"{list_licences.conclude(descriptions)}, glibc {major}.{minor}")
    blas = libraries.get("libblas.so.3", "openblas")
    return [] if "openblas" in blas else [
        f"BLAS is {blas}, several times slower than OpenBLAS: apt install libopenblas0-pthread"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("parts", nargs="*", metavar="PART", choices=[*PARTS, []])
    parser.add_argument("--output")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    parts = arguments.parts or PARTS
    try:
        release = Release(arguments.build, arguments.output or os.path.join(arguments.build, "release"))
        problems = check(release, parts)
        if arguments.check or problems:
            for line in problems:
                print("error: " + line, file=sys.stderr)
            return 1 if problems else 0
        if run("git", "-C", ROOT, "status", "--porcelain"):
            print("warning: the checkout has changes; the source archive is of the last commit", file=sys.stderr)
        shutil.rmtree(release.output, ignore_errors=True)
        os.makedirs(release.output)
        os.umask(0o022)
        with tempfile.TemporaryDirectory() as work:
            if "program" in parts:
                release.make_program(work)
            if "library" in parts:
                release.make_library(work)
            if "wheel" in parts:
                for module in release.find_modules():
                    release.make_wheel(work, module)
        if "source" in parts:
            release.make_source()
        release.write_sums()
    except ReleaseError as error:
        print(f"error: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main())
