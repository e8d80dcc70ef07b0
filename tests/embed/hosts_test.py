"""Example hosts: each compiles, runs and prints what the others print; the manual quotes them."""
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, LIBRARY = os.environ["BOUGH_SOURCE_DIR"], os.environ["BOUGH_LIBRARY"]
HOSTS = os.path.join(SOURCE, "data", "examples", "hosts")
SYSTEM = os.path.join(HOSTS, "system.toml")
SIMULINK = os.path.join(SOURCE, "tests", "embed", "simulink")
CC = os.environ.get("BOUGH_CC") or "cc"
CXX = os.environ.get("BOUGH_CXX") or "c++"
FORTRAN = os.environ.get("BOUGH_FORTRAN") or shutil.which("gfortran")


class Hosts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.expected = cls.run_host([sys.executable, "-B", os.path.join(HOSTS, "host.py"), SYSTEM])

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    @staticmethod
    def run_host(words):
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(f"{words}: {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def compile_host(self, compiler, name, *flags):
        program = os.path.join(self.folder, "host")
        self.run_host([compiler, *flags, os.path.join(HOSTS, name), "-o", program, "-I", os.path.join(SOURCE, "embed"),
                       LIBRARY, "-Wl,-rpath," + os.path.dirname(LIBRARY)])
        return program

    def test_python(self):
        rows = [[float(word) for word in line.split()] for line in self.expected.splitlines()]
        self.assertEqual([row[0] for row in rows], [0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
        self.assertEqual(rows[0][1:], [0.0, 0.0])
        # At rest 60 (0.5 - angle) = m g c cos(angle).
        at_rest = 0.5
        for _ in range(50):
            at_rest = 0.5 - 2 * 9.81 * 0.5 * math.cos(at_rest) / 60
        self.assertAlmostEqual(rows[-1][1], at_rest, delta=5e-4)

    def test_c(self):
        program = self.compile_host(CC, "host.c", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
        self.assertEqual(self.run_host([program, SYSTEM]), self.expected)
        failed = subprocess.run([program, "nowhere.toml"], capture_output=True, text=True, check=False)
        self.assertEqual(failed.returncode, 1)
        self.assertIn("nowhere.toml", failed.stderr)

    def test_cpp(self):
        program = self.compile_host(CXX, "host.cpp", "-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
        self.assertEqual(self.run_host([program, SYSTEM]), self.expected)

    @unittest.skipUnless(FORTRAN, "no Fortran compiler")
    def test_fortran(self):
        program = self.compile_host(FORTRAN, "host.f90", "-std=f2018", "-Wall", "-J", self.folder)
        self.assertEqual(self.run_host([program, SYSTEM]), self.expected)
        failed = subprocess.run([program, "nowhere.toml"], capture_output=True, text=True, check=False)
        self.assertNotEqual(failed.returncode, 0)
        self.assertIn("nowhere.toml", failed.stdout + failed.stderr)

    def test_simulink(self):
        flags = ["-DMATLAB_MEX_FILE", "-I", SIMULINK, "-std=c99", "-Wall", "-Wextra", "-Werror"]
        program = self.compile_host(CC, "sfun_bough.c", *flags)
        self.assertEqual(self.run_host([program, SYSTEM]), self.expected)
        for arguments, text in (([SYSTEM, "angle speed"], "speed"), (["nowhere.toml"], "nowhere.toml")):
            failed = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
            self.assertEqual(failed.returncode, 1)
            self.assertIn(text, failed.stderr)

    def test_pages_quote_the_files(self):
        with open(os.path.join(SOURCE, "docs", "embedding.md"), encoding="utf-8") as f:
            page = f.read()
        for name in ("host.c", "host.cpp", "host.f90", "host.py", "system.toml", "CMakeLists.txt"):
            with self.subTest(name), open(os.path.join(HOSTS, name), encoding="utf-8") as f:
                self.assertTrue(f"```\n{f.read()}```\n" in re.sub(r"```\w+\n", "```\n", page), f"not in embedding.md: {name}")
        self.assertTrue(f"```\n{self.expected}```\n" in page, "the numbers printed are not in embedding.md")

    def test_the_library_links_the_system_only(self):
        linked = self.run_host(["ldd", LIBRARY])
        for name in ("hdf5", "petsc", "slepc", "mpi", "blas", "lapack", "mumps"):
            self.assertNotIn(name, linked)

    def test_every_constant_is_that_of_the_header(self):
        with open(os.path.join(SOURCE, "embed", "bough.h"), encoding="utf-8") as f:
            header = f.read()
        version = re.search(r"#define BOUGH_ABI_VERSION (\d+)", header).group(1)
        for name, text in (("host.py", f"bough_abi_version() != {version}"), ("host.f90", f"bough_abi_version() /= {version}")):
            with open(os.path.join(HOSTS, name), encoding="utf-8") as f:
                self.assertIn(text, f.read(), name)
        self.assertRegex(header, r"BOUGH_INPUTS = 0,[^,]*BOUGH_OUTPUTS = 1,")


if __name__ == "__main__":
    unittest.main()
