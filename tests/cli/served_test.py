"""Calls that are forks of a loaded program (tests/support/served.py) end, print and obey as starts do."""
import os
import resource
import subprocess
import unittest

from support import ABORT, BEAM, IN_OUTPUTS, LOOP, PROGRAM, ProgramTest, get_astray, served
from toml_text import section, table, toml

TOP = toml(
    table("body", "top", mass=1.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "pin", "revolute", child="top"),
    table("sensor", "angle", "hinge_angle", hinge="pin"),
    section("simulation", duration=1.0))


@unittest.skipUnless(served.LIBRARY, "each call is a start here: the sanitizers want to be loaded first")
class Served(ProgramTest):
    def get_both(self, *words, **more):
        """A fork and a start: exit code, output, messages."""
        return [(ran.returncode, ran.stdout, ran.stderr) for ran in (
            call([PROGRAM, *words], cwd=self.folder, **more) for call in (served.run, served.start))]

    def test_ends_and_prints(self):
        self.write("beam.bdf", BEAM)
        self.write("ends.toml", get_astray(IN_OUTPUTS, ABORT, 0.5, "angle") + TOP)
        for words, code in ((["--version"], 0), (["modes", "beam.bdf", "--json"], 0), (["check", "no.bdf"], 1), ([], 2),
                            (["modes", "beam.bdf", "-o", "none/m.h5"], 3), (["run", "ends.toml"], 3),
                            (["modes", "beam.bdf", "--json"], 0)):  # MPI after it was loaded by the first
            with self.subTest(words):
                fork, start = self.get_both(*words)
                self.assertEqual(fork, start)
                self.assertEqual(fork[0], code, fork)

    def test_folder_environment_input_and_limit(self):
        self.write("top.toml", TOP)
        fork, start = self.get_both("edit", "top.toml", input="set simulation.duration=2\nquit\n")
        self.assertEqual(fork, start)
        self.write("beam.bdf", BEAM)
        no_mpi = {**os.environ, "OMPI_MCA_pml": "none-such", "OMPI_MCA_btl": "none-such"}
        for more in ({"env": no_mpi}, {"limit": (resource.RLIMIT_FSIZE, 100)}):
            fork, start = self.get_both("modes", "beam.bdf", "-o", "m.h5", **more)
            self.assertEqual(fork[0], start[0])
            self.assertNotEqual(fork[0], 0)

    def test_one_without_end_is_killed_and_the_next_is_served(self):
        self.write("loops.toml", get_astray(IN_OUTPUTS, LOOP, 0.5, "angle") + TOP)
        os.mkfifo(self.path("pipe"))
        with self.assertRaises(subprocess.TimeoutExpired):
            served.run([PROGRAM, "run", "loops.toml"], cwd=self.folder, timeout=0.5, env={**os.environ, "ASTRAY_PIPE": self.path("pipe")})
        self.bough("--version")


if __name__ == "__main__":
    unittest.main()
