"""Looks at the recipes of packaging/recipes without the systems that they are for, and runs their build steps here.

    /usr/bin/python3 packaging/try_recipes.py [NAME ...] [--configure FOLDER | --build FOLDER]

NAME: conda, spack, spack-solver, homebrew (default: all). Each is read by its own language: YAML; Python, with a module
spack.package that records; Ruby (left out if ruby is not installed), with a class Formula that records. Then

* each library that the CMake files look for has a package in the recipe, and each package of the recipe is known,
* each CMake option exists,
* --configure: CMake accepts the arguments of the recipe on this system, with the libraries of this system,
* --build: the steps of the recipe build and install into FOLDER/NAME/prefix, and its test runs.

Names of packages and versions of those systems are not looked up: that takes their channels.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import types

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# Packages that the CMake files look for: the name in (conda-forge, Spack, Homebrew); None: no package of its own.
SOLVER = {
    "Eigen3": ("eigen", "eigen", "eigen"), "Threads": None, "muparser": ("muparser",) * 3,
    "nlohmann_json": ("nlohmann_json", "nlohmann-json", "nlohmann-json"), "fmt": ("fmt",) * 3,
    "tomlplusplus": ("tomlplusplus",) * 3, "cvode/cvode.h": ("sundials",) * 3, "sundials": ("sundials",) * 3}
PROGRAM = {
    "PkgConfig": ("pkg-config", "pkgconfig"), "PETSc": ("petsc", "petsc"), "SLEPc": ("slepc", "slepc"),
    "ompi-c": ("openmpi", "mpi"), "hdf5-openmpi": ("hdf5", "hdf5"), "matio": ("libmatio", "matio"),
    "matio.h": ("libmatio", "matio"), "blas": ("libblas", "blas"), "lapack": ("liblapack", "lapack"),
    "metis.h": ("metis", "metis"), "metis": ("metis", "metis"), "cholmod.h": ("suitesparse", "suite-sparse"),
    "cholmod": ("suitesparse", "suite-sparse"), "zmumps_c.h": ("mumps-mpi", "mumps"), "zmumps": ("mumps-mpi", "mumps"),
    "CLI11": ("cli11", "cli11"), "zip.h": ("libzip", "libzip"), "zip": ("libzip", "libzip"),
    "pugixml.hpp": ("pugixml", "pugixml"), "pugixml": ("pugixml", "pugixml"),
    "cpp-httplib": ("cpp-httplib", "cpp-httplib"), "httplib.h": ("cpp-httplib", "cpp-httplib"),
    "editline/readline.h": ("libedit", "libedit"), "edit": ("libedit", "libedit"),
    "Python3": ("python", "python"), "pybind11": ("pybind11", "py-pybind11")}
TESTS = {"GTest", "benchmark"}
# Tools, and what runs the module.
TOOLS = {"cmake", "ninja", "pkg-config", "pkgconfig", "c", "cxx", "numpy", "h5py", "py-numpy", "py-h5py", "python"}


class Error(Exception):
    pass


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as f:
        return f.read()


def list_cmake():
    """Text of the CMake files of what is installed."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "*CMakeLists.txt", "cmake/*.cmake"], check=True, text=True,
                            capture_output=True).stdout.split()
    return "\n".join(read(path) for path in listed if not path.startswith(("tests/", "bench/", "data/")))


def find_sought(text):
    """Names of packages, headers and libraries that the CMake files look for."""
    sought = set(re.findall(r"find_package\((\w+)", text))
    sought |= set(re.findall(r"find_(?:path|library)\(\w+ ([\w./+-]+)", text))
    sought |= {words.split()[0] for words in re.findall(
        r"pkg_(?:check_modules|search_module)\(\w+ (?:REQUIRED )?IMPORTED_TARGET (?:GLOBAL )?([^)]*)\)", text)}
    return {"sundials" if name.startswith("sundials_") else name for name in sought}


def find_options(text):
    return set(re.findall(r"option\((BOUGH_\w+)", text)) | set(re.findall(r"set\((BOUGH_\w+) [^\n]*CACHE", text))


def read_conda():
    table = yaml.safe_load(read("packaging/recipes/conda/recipe.yaml"))
    for key in ("context", "package", "source", "build", "requirements", "tests", "about"):
        if key not in table:
            raise Error(f"no {key}")
    context = table["context"]

    def fill(value):
        return re.sub(r"\$\{\{ (\w+) \}\}", lambda match: context[match.group(1)], value)
    packages = [name for kind in ("build", "host") for name in table["requirements"][kind]]
    packages = {re.split(r"[ <>=]", name)[0] for name in packages if not name.startswith("${{")}
    test = [line for entry in table["tests"] for line in entry.get("script", [])]
    test += [f"$PYTHON -c 'import {name}'" for entry in table["tests"] for name in entry.get("python", {}).get("imports", [])]
    return {"version": fill(table["package"]["version"]), "packages": packages,
            "steps": [fill(step) for step in table["build"]["script"]], "test": test}


def read_spack(solver_only):
    """Runs package.py with a module that records what it says for one choice of its variants."""
    chosen = {"solver_only": solver_only, "python": not solver_only}
    found = {"versions": [], "packages": set(), "variants": set(), "when": []}

    def holds(condition):
        name = condition[1:]
        if name not in found["variants"]:
            raise Error(f"condition {condition} names no variant")
        return chosen[name] == (condition[0] == "+")

    class When:
        def __init__(self, condition):
            self.condition = condition

        def __enter__(self):
            found["when"].append(self.condition)

        def __exit__(self, *_):
            found["when"].pop()

    def depends_on(spec, type=("build", "link"), when=None):
        if all(holds(condition) for condition in [*found["when"], *([when] if when else [])]):
            found["packages"].add(re.split(r"[@+~]", spec)[0])

    class CMakePackage:
        prefix = types.SimpleNamespace(bin=types.SimpleNamespace(bough=""))

        class spec:
            @staticmethod
            def satisfies(condition):
                return holds(condition)

        @staticmethod
        def define(name, value):
            return f"-D{name}={('ON' if value else 'OFF') if isinstance(value, bool) else value}"

        def define_from_variant(self, name, variant):
            if variant not in found["variants"]:
                raise Error(f"no variant {variant}")
            return self.define(name, chosen[variant])
    module = types.ModuleType("spack.package")
    module.__dict__.update(
        CMakePackage=CMakePackage, license=lambda *_, **__: None, version=lambda name, **_: found["versions"].append(name),
        variant=lambda name, **_: found["variants"].add(name), depends_on=depends_on, when=When, Executable=None,
        extends=lambda name, **_: depends_on(name), generator=lambda name: found.__setitem__("generator", name),
        run_after=lambda _: lambda f: f, on_package_attributes=lambda **_: lambda f: f,
        join_path=os.path.join, python_platlib="$SP_DIR")
    names = {"spack": types.ModuleType("spack"), "spack.package": module}
    sys.modules.update(names)
    try:
        space = {}
        exec(compile(read("packaging/recipes/spack/package.py"), "package.py", "exec"), space)
        arguments = " ".join(space["Bough"]().cmake_args())
    finally:
        for name in names:
            del sys.modules[name]
    steps = [f"cmake $CMAKE_ARGS -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release {arguments}",
             "cmake --build build -j $CPU_COUNT", "cmake --install build"]
    return {"version": found["versions"][0], "packages": found["packages"], "steps": steps,
            "test": [] if solver_only else ["bough --version"]}


def read_homebrew():
    """Runs the formula with a class Formula that records; None if there is no ruby."""
    if not shutil.which("ruby"):
        return None
    script = r"""
require "json"
$found = {packages: [], steps: [], test: []}
class Pathname2 < String
  def /(other) = Pathname2.new(self + "/" + other)
end
class Formula
  def self.desc(_) = nil
  def self.url(_) = nil
  def self.license(_) = nil
  def self.version(text) = $found[:version] = text
  def self.depends_on(name) = $found[:packages] << (name.is_a?(Hash) ? name.keys[0] : name)
  def self.test(&block) = @@test = block
  def std_cmake_args = ["$CMAKE_ARGS", "-DCMAKE_BUILD_TYPE=Release"]
  def system(*words) = $list << words.map(&:to_s)
  def cp(from, to) = $list << ["cp", from, to]
  def testpath = "."
  def pkgshare = Pathname2.new("$PREFIX/share/bough")
  def include = "$PREFIX/include"
  def lib = "$PREFIX/lib"
  def self.run
    formula = new
    $list = $found[:steps]
    formula.install
    $list = $found[:test]
    formula.instance_eval(&@@test)
  end
end
module ENVCompiler
  def cc = "cc"
end
ENV.extend(ENVCompiler)
load ARGV[0]
Bough.run
puts JSON.generate($found)
"""
    done = subprocess.run(["ruby", "-e", script, os.path.join(ROOT, "packaging/recipes/homebrew/bough.rb")], text=True, capture_output=True)
    if done.returncode:
        raise Error(done.stderr)
    found = json.loads(done.stdout)
    return {"version": found["version"], "packages": set(found["packages"]),
            "steps": [" ".join(words) for words in found["steps"]], "test": [" ".join(words) for words in found["test"]]}


# name: (reader, position of its names of packages, is the program in it)
READERS = {"conda": (read_conda, 0, True), "spack": (lambda: read_spack(False), 1, True),
           "spack-solver": (lambda: read_spack(True), 1, False), "homebrew": (read_homebrew, 2, False)}


def check(name, recipe, cmake):
    """Problems of a recipe, a line each."""
    _, column, has_program = READERS[name]
    table = {**SOLVER, **(PROGRAM if has_program else {})}
    problems = [f"CMake looks for {what}, which packaging/try_recipes.py does not know"
                for what in sorted(find_sought(cmake) - SOLVER.keys() - PROGRAM.keys() - TESTS)]
    known = {row[column]: what for what, row in table.items() if row}
    problems += [f"no package for {what} ({package})" for package, what in sorted(known.items())
                 if package not in recipe["packages"]]
    problems += [f"{package} is asked for and not looked for by CMake"
                 for package in sorted(recipe["packages"] - known.keys() - TOOLS)]
    options = {option for step in recipe["steps"] for option in re.findall(r"-D(BOUGH_\w+)", step)}
    problems += [f"CMake has no option {option}" for option in sorted(options - find_options(cmake))]
    version = re.search(r"project\(Bough VERSION ([\d.]+)", read("CMakeLists.txt")).group(1)
    if recipe["version"] != version:
        problems.append(f"version {recipe['version']}, CMakeLists.txt has {version}")
    return problems


def run_steps(name, recipe, folder, only_configure):
    """The steps of the recipe as a shell would run them in a copy of the sources; log in FOLDER/NAME/log."""
    top = os.path.abspath(os.path.join(folder, name))
    shutil.rmtree(top, ignore_errors=True)
    os.makedirs(top)
    prefix = os.path.join(top, "prefix")
    with open(os.path.join(top, "source.tar"), "wb") as f:
        subprocess.run(["git", "-C", ROOT, "archive", "--prefix=source/", "HEAD"], check=True, stdout=f)
    subprocess.run(["tar", "-xf", "source.tar"], check=True, cwd=top)
    environment = {**os.environ, "CMAKE_ARGS": f"-DCMAKE_INSTALL_PREFIX={prefix} -DCMAKE_INSTALL_LIBDIR=lib", "PREFIX": prefix,
                   "SP_DIR": os.path.join(prefix, "lib/python"), "PYTHON": "/usr/bin/python3",
                   "CPU_COUNT": os.environ.get("BOUGH_JOBS", "1"), "PATH": f"{prefix}/bin:/usr/bin:/bin",
                   "PYTHONPATH": os.path.join(prefix, "lib/python"), "LD_LIBRARY_PATH": os.path.join(prefix, "lib")}
    steps = recipe["steps"][:1] if only_configure else recipe["steps"]
    with open(os.path.join(top, "log"), "w", encoding="utf-8") as log:
        for lines, where in ((steps, "source"), ([] if only_configure else recipe["test"], ".")):
            script = "set -eux\n" + "\n".join(lines)
            done = subprocess.run(["/usr/bin/bash", "-c", script], cwd=os.path.join(top, where), env=environment,
                                  stdout=log, stderr=subprocess.STDOUT)
            if done.returncode:
                return [f"its steps end with {done.returncode}; log: {top}/log"]
    return []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*READERS, []])
    parser.add_argument("--configure", metavar="FOLDER")
    parser.add_argument("--build", metavar="FOLDER")
    arguments = parser.parse_args()
    cmake, failed = list_cmake(), False
    for name in arguments.names or READERS:
        try:
            recipe = READERS[name][0]()
            if recipe is None:
                print(f"{name}: left out, no ruby")
                continue
            problems = check(name, recipe, cmake)
            if not problems and (arguments.configure or arguments.build):
                problems = run_steps(name, recipe, arguments.build or arguments.configure, not arguments.build)
        except Error as error:
            problems = [str(error)]
        for problem in problems:
            print(f"error: {name}: {problem}", file=sys.stderr)
        failed = failed or bool(problems)
        if not problems:
            done = "built and tried" if arguments.build else "configured" if arguments.configure else "looked at"
            print(f"{name}: {len(recipe['packages'])} packages, {done}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
