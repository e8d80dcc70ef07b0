"""Runs the built program in a folder of its own."""
import os
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["BOUGH_PROGRAM"]
SOURCE = os.environ["BOUGH_SOURCE_DIR"]
# How many times as long as the program itself one under the sanitizers takes; these need address space without end.
SLOWER = int(os.environ.get("BOUGH_SLOWER", "1"))
VERBS = ["check", "modes", "static", "frequency", "transient", "matrices", "reduce", "integrals", "flx", "compare", "run",
         "equilibrium", "linearize", "response", "select", "export", "plot", "report", "info", "init", "batch", "edit", "convert"]


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="bough-test-")
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as f:
            f.write(text)
        return name

    def copy_example(self, example):
        source = os.path.join(SOURCE, "data/examples", example)
        for name in os.listdir(source):
            shutil.copy(os.path.join(source, name), self.folder)

    def bough(self, *arguments, code=0, launcher=(), env=None, timeout=250):
        """Runs and checks the exit code; returns the finished process with stdout and stderr as text."""
        result = subprocess.run([*launcher, PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                                timeout=timeout * SLOWER, capture_output=True, env={**os.environ, **(env or {})})
        self.assertEqual(result.returncode, code,
                         f"bough {' '.join(map(str, arguments))}\n--- stdout\n{result.stdout}\n--- stderr\n{result.stderr}")
        return result

    def fails(self, code, *arguments, says=(), error=None):
        """The call must fail with the code, say every word of `says` and name the error id; nothing on stdout."""
        result = self.bough(*arguments, code=code)
        for words in says:
            self.assertIn(words, result.stderr)
        if error:
            self.assertIn(f"[{error}]", result.stderr)
        self.assertIn("error:", result.stderr)
        return result


BEAM = """SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
EIGRL,1,,,3
SPC1,1,123456,1
PBAR,1,1,1.-4,1.-8,1.-8,1.-8
MAT1,1,7.+10,,.3,2700.
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
ENDDATA
"""
