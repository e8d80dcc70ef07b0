"""packaging/release.py without making a release: its check of this build, and its parts on a small program."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE, BUILD, PROGRAM = (os.environ[name] for name in ("BOUGH_SOURCE_DIR", "BOUGH_BUILD_DIR", "BOUGH_PROGRAM"))
sys.path[:0] = [os.path.join(SOURCE, "packaging"), os.path.join(SOURCE, "tools")]
import bundle  # noqa: E402
import list_licences  # noqa: E402
import release  # noqa: E402
import try_recipes  # noqa: E402

needs_patchelf = unittest.skipUnless(shutil.which("patchelf"), "no patchelf: apt install patchelf")


def run(*command, **options):
    return subprocess.run(command, check=True, text=True, capture_output=True, **options).stdout


class Parts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def build_toy(self, number, name="libtoy.so.1"):
        """A program that prints what its library returns; (program, library)."""
        os.makedirs(self.path("made", str(number)), exist_ok=True)
        library, program = self.path("made", str(number), name), self.path("made", str(number), "toy")
        with open(self.path("toy.c"), "w") as f:
            f.write(f"int get(void) {{ return {number}; }}\n")
        run("cc", "-shared", "-fPIC", f"-Wl,-soname,{name}", self.path("toy.c"), "-o", library)
        with open(self.path("main.c"), "w") as f:
            f.write('#include <stdio.h>\nint get(void);\nint main(void) { printf("%d\\n", get()); }\n')
        run("cc", self.path("main.c"), library, f"-Wl,-rpath,{os.path.dirname(library)}", "-o", program)
        return program, library

    def bundle_toy(self, top):
        program, library = self.build_toy(7)
        libraries = bundle.list_libraries([program], release.is_system)
        self.assertEqual(libraries, {"libtoy.so.1": os.path.realpath(library)})   # glibc is the system's
        bundle.copy(program, os.path.join(top, "bin/toy"))
        bundle.add_libraries(libraries, os.path.join(top, "lib"))
        bundle.set_path(os.path.join(top, "bin/toy"), "../lib")

    @needs_patchelf
    def test_bundle_runs_where_it_is_moved_and_prefers_its_libraries(self):
        self.bundle_toy(self.path("toy-1"))
        bundle.write_tar(self.path("toy-1"), self.path("toy.tar.gz"), 1700000000)
        shutil.rmtree(self.path("made"))
        os.makedirs(self.path("else where"))
        run("tar", "-xzf", self.path("toy.tar.gz"), "-C", self.path("else where"))
        _, other = self.build_toy(8)
        program = self.path("else where/toy-1/bin/toy")
        self.assertEqual(run(program, env={**os.environ, "LD_LIBRARY_PATH": os.path.dirname(other)}), "7\n")
        os.symlink(program, self.path("link"))
        self.assertEqual(run(self.path("link")), "7\n")

    @needs_patchelf
    def test_archives_are_the_same_bytes_again(self):
        for time, name in ((0, "a"), (10**9, "b")):
            top = self.path(name, "toy-1")
            self.bundle_toy(top)
            info = os.path.join(top, "toy-1.dist-info")
            os.makedirs(info)
            with open(os.path.join(info, "WHEEL"), "w") as f:
                f.write("Wheel-Version: 1.0\n")
            for path in bundle.list_files(top):
                os.utime(os.path.join(top, path), (time, time))
            bundle.write_tar(top, self.path(name + ".tar.gz"), 1700000000)
            bundle.write_wheel(top, self.path(name + ".whl"), 1700000000)
        for kind in (".tar.gz", ".whl"):
            self.assertEqual(bundle.hash_file(self.path("a" + kind)), bundle.hash_file(self.path("b" + kind)))
        listed = run("tar", "-tvzf", self.path("a.tar.gz"))
        self.assertIn("0/0", listed.split("\n")[0])
        with zipfile.ZipFile(self.path("a.whl")) as archive:
            record = archive.read("toy-1.dist-info/RECORD").decode().split("\n")
            self.assertEqual(len(record), len(archive.namelist()) + 1)
            self.assertEqual(archive.getinfo("bin/toy").external_attr >> 16 & 0o777, 0o755)

    def test_a_missing_library_is_named(self):
        program, library = self.build_toy(7)
        os.remove(library)
        with self.assertRaisesRegex(bundle.ReleaseError, "libtoy.so.1 is not found"):
            bundle.list_libraries([program], release.is_system)

    def test_objects_of_other_sources_are_named(self):
        with open(self.path("a.cpp"), "w") as f:
            f.write("namespace bough { int get(int); } int main() { return bough::get(1); }\n")
        run("c++", "-shared", "-fPIC", self.path("a.cpp"), "-o", self.path("a.so"))
        self.assertEqual(release.find_undefined(self.path("a.so")), ["bough::get(int)"])
        self.assertEqual(release.find_undefined(os.path.realpath(PROGRAM)), [])

    def test_files_of_no_package_and_unread_licences_end_it(self):
        one = release.Release(BUILD, self.folder)
        with self.assertRaisesRegex(bundle.ReleaseError, "licence is not known: /opt/none.so"):
            one.find_owners({"none.so": "/opt/none.so"})
        with self.assertRaisesRegex(bundle.ReleaseError, "licences of coreutils"):
            one.describe({"/usr/bin/true": "coreutils"}, [])
        with self.assertRaisesRegex(bundle.ReleaseError, "library: what is linked asks for GPL-3.0-or-later"):
            one.demand_licence("library", [{"package": "libcholmod3", "licence": "GPL-2.0-or-later"}])

    def test_an_exception_or_a_choice_does_not_bind(self):
        parts = [{"package": "a", "licence": licence} for licence in (
            "GPL-3.0-or-later WITH GCC-exception-3.1", "LGPL-3.0-or-later OR GPL-2.0-or-later", "CECILL-C")]
        self.assertEqual(list_licences.conclude(parts), "BSD-3-Clause")
        self.assertEqual(list_licences.conclude([*parts, {"package": "b", "licence": "GPL-2.0-or-later"}]), "GPL-3.0-or-later")

    def test_bill_of_materials(self):
        with open(self.path("a.so"), "w") as f:
            f.write("abc")
        parts = [list_licences.describe("libc6"), list_licences.describe("libeigen3-dev", "MPL-2.0")]
        table = list_licences.make_json("bough-1-x", "1", "2026-01-01T00:00:00Z", parts, [
            ("lib/a.so", bundle.hash_file(self.path("a.so")), bundle.hash_file(self.path("a.so"), "sha1"), "libc6")])
        keys = {"SPDXRef-DOCUMENT", *(entry["SPDXID"] for entry in table["packages"] + table["files"])}
        for relation in table["relationships"]:
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, keys)
        self.assertIn(("SPDXRef-libc6", "CONTAINS", "SPDXRef-File-0"), {tuple(r.values()) for r in table["relationships"]})
        # SHA-256 and SHA-1 of "abc" (FIPS 180-4, appendix).
        self.assertEqual([c["checksumValue"] for c in table["files"][0]["checksums"]],
                         ["a9993e364706816aba3e25717850c26c9cd0d89d",
                          "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"])
        json.dumps(table)

    def test_scripts_and_recipes_parse(self):
        for name in ("try", "try_inside", "try_release", "try_release_inside", "get_python", "bare_root", "package_in",
                     "make_container"):
            run("bash", "-n", os.path.join(SOURCE, "packaging", name))
        run("bash", "-n", os.path.join(SOURCE, "dev"))
        run("sh", "-n", os.path.join(SOURCE, "packaging/bough-mpirun"))

    def test_recipes_name_what_cmake_looks_for(self):
        cmake = try_recipes.list_cmake()
        for name, (read, _, _) in try_recipes.READERS.items():
            recipe = read()
            if recipe is None:   # Homebrew's is Ruby
                continue
            self.assertEqual(try_recipes.check(name, recipe, cmake), [], name)
            package = "fmt"
            problems = try_recipes.check(name, {**recipe, "packages": recipe["packages"] - {package}}, cmake)
            self.assertEqual(problems, [f"no package for {package} ({package})"], name)
            problems = try_recipes.check(name, {**recipe, "packages": recipe["packages"] | {"scalapack"}}, cmake)
            self.assertEqual(problems, ["scalapack is asked for and not looked for by CMake"], name)
            problems = try_recipes.check(name, {**recipe, "steps": ["cmake -DBOUGH_NONE=ON"]}, cmake)
            self.assertEqual(problems, ["CMake has no option BOUGH_NONE"], name)
        problems = try_recipes.check("spack", try_recipes.read_spack(False), cmake + "find_package(Zstd REQUIRED)")
        self.assertEqual(len(problems), 1)
        self.assertIn("Zstd", problems[0])

    def test_components_of_mpi_come_from_next_to_its_library(self):
        library = bundle.list_libraries([PROGRAM], release.is_system).get("libmpi.so.40", "")
        components = os.path.join("/usr", release.COMPONENTS)
        if not library or not os.path.isdir(components):
            self.skipTest("not Debian's Open MPI")
        shutil.copy(library, self.path("libmpi.so.40"))
        top = self.path(release.MPI)
        os.makedirs(os.path.join(top, os.path.dirname(release.COMPONENTS)))
        deck = os.path.join(SOURCE, "data/decks/free-free.bdf")

        def compute():
            return subprocess.run([PROGRAM, "modes", deck, "-n", "2", "-o", self.path("a.h5")], capture_output=True, text=True,
                                  env={**os.environ, "LD_LIBRARY_PATH": self.folder})
        self.assertNotEqual(compute().returncode, 0)   # the folder has no components: those of the system do not count
        os.symlink(components, os.path.join(top, release.COMPONENTS))
        shutil.copytree("/usr/share/openmpi", os.path.join(top, "share/openmpi"))
        done = compute()
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_programs_do_not_contain_the_folder_of_the_sources(self):
        """Else builds in different folders differ (docs/developer/release.md)."""
        made = [PROGRAM, *(os.path.join(BUILD, "lib", name) for name in ("libbough.so", "bough_fmu.so"))]
        module = os.path.join(BUILD, "python/bough")
        made += [os.path.join(module, name) for name in os.listdir(module) if name.endswith(".so")]
        for path in filter(os.path.exists, made):
            run("objcopy", "-O", "binary", "--only-section=.rodata", path, self.path("constants"))
            with open(self.path("constants"), "rb") as f:
                self.assertNotIn(SOURCE.encode() + b"/", f.read(), path)

    @unittest.skipUnless('VERSION_ID="12"' in open("/etc/os-release").read(), "releases are made on Debian 12")
    @needs_patchelf
    def test_check_of_this_build(self):
        done = subprocess.run([sys.executable, "-B", os.path.join(SOURCE, "packaging/release.py"), BUILD, "--check"], text=True,
                              capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = dict(re.findall(r"(?m)^(\w+): .*, (\S+), glibc", done.stdout))
        self.assertEqual(found, release.LICENCES)


if __name__ == "__main__":
    unittest.main()
