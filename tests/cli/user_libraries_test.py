"""Controllers of the user that crash, end the process, never return or ask for too much: named, exit code 3."""
import os
import signal
import subprocess
import unittest

import h5py
import numpy as np

from support import (ABORT, DIVIDE, EXIT, EXIT_AT_ONCE, FORK, HANG, HOLD, IN_CLOSE, IN_OPEN, IN_OUTPUTS, IN_SIZES, IN_START,
                     LOOP, OVERFLOW, PROGRAM, QUICK_EXIT, WRITE_NOWHERE, ProgramTest, get_astray)
from toml_text import section, table, toml

SPRING = toml(
    table("body", "bob", mass=2.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0], stiffness=[8.0], position=[0.5]),
    table("sensor", "x", "position", body="bob"),
    section("simulation", duration=4.0, output_step=0.01, integrator="rk4", step=0.01))
CRASHES = {ABORT: "SIGABRT", WRITE_NOWHERE: "SIGSEGV", DIVIDE: "SIGFPE", OVERFLOW: "SIGSEGV"}
EXITS = {EXIT: "exit()", EXIT_AT_ONCE: "_exit()", QUICK_EXIT: "quick_exit()"}
EVERY = {**{act: ("control.library-crashed", word) for act, word in CRASHES.items()},
         **{act: ("control.library-exited", word) for act, word in EXITS.items()}}


class UserLibraries(ProgramTest):
    def make(self, place, act, since=0.0):
        return self.write("s.toml", get_astray(place, act, since, "x:x") + SPRING)

    def check_samples(self, least):
        """Checks the file: x = 0.5 cos 2t."""
        with h5py.File(self.path("s.h5")) as f:
            t, x = f["time"][:], f["sensors/x"][:, 0]
            self.assertFalse(f.attrs["completed"])
        self.assertGreaterEqual(len(t), least)
        np.testing.assert_allclose(x, 0.5 * np.cos(2 * t), atol=1e-6)

    def test_whatever_it_does_it_is_named(self):
        for act, (error, word) in EVERY.items():
            with self.subTest(act=word):
                self.make(IN_OUTPUTS, act, 2.5)
                self.fails(3, "run", "s.toml", error=error,
                           says=["s.toml:1: error: controller 'law': bough_controller_outputs at t = 2.5", word])
                self.check_samples(0)  # what is written is committed once a second at most
                os.remove(self.path("s.h5"))

    def test_python_does_not_end_without_a_word(self):
        package = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "python")
        if not os.path.isdir(package):
            self.skipTest("the Python module is not built")
        def run(code):
            return subprocess.run(["/usr/bin/python3", "-c", code], cwd=self.folder, capture_output=True, text=True,
                                  env={**os.environ, "PYTHONPATH": package}, timeout=HANG)

        for act in (EXIT, *CRASHES):
            with self.subTest(act=EVERY[act][1]):
                self.make(IN_OUTPUTS, act, 2.5)
                done = run("import bough; bough.System('s.toml').run(); print('still here')")
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertIn("controller 'law': bough_controller_outputs at t = 2.5", done.stderr)
                self.assertIn(EVERY[act][0], done.stderr)
                self.assertNotIn("still here", done.stdout)
        # A crash of Python itself keeps its own handlers: two calls of a library before it do not hide it.
        self.make(IN_OUTPUTS, 0)
        done = run("import bough, ctypes, faulthandler\nfaulthandler.enable()\n"
                   "bough.System('s.toml').run()\nctypes.string_at(0)")
        self.assertEqual(done.returncode, -signal.SIGSEGV, done.stderr)
        self.assertIn("Segmentation fault", done.stderr)

    def test_from_its_loading_to_its_end(self):
        for place, function in ((IN_OPEN, "bough_controller_open"), (IN_START, "bough_controller_start")):
            for act in (EXIT, EXIT_AT_ONCE, WRITE_NOWHERE):
                self.make(place, act)
                self.fails(3, "run", "s.toml", error=EVERY[act][0], says=["controller 'law'", function])
                self.fails(3, "check", "s.toml", error=EVERY[act][0]) if place == IN_OPEN else None
        self.make(0, 0)
        said = self.bough("run", "s.toml", code=3, env={"ASTRAY_LOADING": str(EXIT)}).stderr
        self.assertIn("loading of its library ended the program by exit()", said)
        self.assertIn("[control.library-exited]", said)

    def test_a_failure_at_the_end_leaves_nothing_completed(self):
        for act, (error, _) in EVERY.items():
            self.make(IN_CLOSE, act)
            self.fails(3, "run", "s.toml", error=error, says=["controller 'law': bough_controller_close"])
            self.check_samples(300)
            self.bough("run", "s.toml", "--resume", env={"ASTRAY": "0"})
            with h5py.File(self.path("s.h5")) as f:
                self.assertTrue(f.attrs["completed"])
                self.assertEqual(len(f["time"]), 401)
            os.remove(self.path("s.h5"))

    def test_a_second_interrupt_ends_what_does_not_return(self):
        """On a machine that stands still for 5 s between both, the first one has ended it."""
        self.make(IN_OUTPUTS, LOOP, 1.5)
        process, _ = self.start_held("run", "s.toml")
        self.interrupt_twice(process, r"(interrupted a second time|told to end 5 s ago and still) in controller 'law': "
                                      r"bough_controller_outputs at t = 1\.5.*\[cli\.interrupted\]")

    def test_one_request_to_end_does(self):
        self.make(IN_OUTPUTS, LOOP, 1.5)
        for number in (signal.SIGTERM, signal.SIGHUP):
            process, _ = self.start_held("run", "s.toml", "-o", "t.h5")
            process.send_signal(number)
            self.wait_held(process)
            _, text = process.communicate(timeout=HANG)
            self.assertEqual(process.returncode, 3)
            self.assertRegex(text, "told to end 5 s ago and still in controller '.*': bough_controller_outputs at t = 1.5")

    def test_one_interrupt_ends_a_run_in_good_order(self):
        self.make(IN_OUTPUTS, HOLD, 1.5)
        process, _ = self.start_held("run", "s.toml")
        process.send_signal(signal.SIGINT)
        self.assertIn("--resume", process.communicate(timeout=HANG)[1])
        self.assertEqual(process.returncode, 3)
        self.check_samples(150)

    def test_a_child_of_the_library_may_end(self):
        self.make(IN_OUTPUTS, FORK, 3.98)
        self.bough("run", "s.toml")

    def test_sizes_without_bound(self):
        for act, noun in ((1, "outputs"), (2, "states"), (3, "memory")):
            self.write("s.toml", get_astray(IN_SIZES, act, 0, "x:x", "sample_time = 0.1\n" if act == 3 else "") + SPRING)
            self.fails(1, "run", "s.toml", error="control.bad-library", says=[f"{noun} to 2000000000", "the limit is"])

    def test_a_case_of_a_campaign_names_it(self):
        self.make(IN_OUTPUTS, WRITE_NOWHERE, 2.0)
        self.write("study.toml", toml(
            section("campaign", steps=["run s.toml -o s.h5"]),
            table("parameter", "end", file="s.toml", key="simulation.duration", values=[1.0, 3.0, 1.5])))
        self.bough("batch", "study.toml", "-j", "1", code=3)
        with open(self.path("study/outcomes.csv")) as f:
            rows = f.read().splitlines()[1:]
        self.assertEqual(len(rows), 3)
        self.assertIn("controller 'law'", rows[1])
        self.assertIn("[control.library-crashed]", rows[1])


if __name__ == "__main__":
    unittest.main()
