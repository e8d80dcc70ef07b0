"""Runs that nobody watches: short events after long rests, changes without progress, signals, limits of file sizes."""
import math
import resource
import shutil
import signal
import subprocess
import unittest

import h5py
import numpy as np

from support import HANG, HOLD, IN_OUTPUTS, PROGRAM, ProgramTest, get_astray
from toml_text import Bare, section, table, toml

SLIDER = toml(
    table("body", "a", mass=2.0, inertia=[1, 1, 1, 0, 0, 0]),
    table("hinge", "h", "prismatic", child="a", axis=[1, 0, 0]),
    "{hinge}\n",
    table("sensor", "x", "position", body="a"),
    table("sensor", "v", "velocity", body="a"),
    "{more}\n",
    section("simulation", duration=Bare("{duration}"), output_step=Bare("{output_step}")),
    "{simulation}\n")
PULSE = "400*exp(-((t-7.3)/0.06)^2)"
DRIVE = table("actuator", "j", "hinge", hinge="h", input="c")
STOPS = "position = 5e-7\nrate = {rate}\nstops = {{lower = 0.0, upper = 1e-6, restitution = 1.0}}"


class Overnight(ProgramTest):
    def make(self, more="", hinge="", simulation="", duration=11.0, output_step=.011):
        self.write("s.toml", SLIDER.format(more=more, hinge=hinge, simulation=simulation, duration=duration,
                                           output_step=output_step))

    def read_last_speed(self):
        with h5py.File(self.path("s.h5")) as f:
            return f["sensors/v"][-1, 0]

    def test_a_short_pulse_after_a_long_rest(self):
        expected = 400 * .06 * math.sqrt(math.pi) / 2
        force = f'[[function]]\nname = "f"\ntype = "expression"\nexpression = "{PULSE}"\n' \
                '[[force]]\nname = "p"\nbody = "a"\nforce = [1, 0, 0]\nfunction = "f"\n'
        control = f'[[controller]]\nname = "c"\ntype = "expression"\ninputs = ["x:x"]\nexpression = "{PULSE}+0*u"\n{DRIVE}'
        for more in (force, control):
            for integrator in ("adams", "bdf", "auto", "rk"):
                self.make(more, simulation=f'integrator = "{integrator}"\nrelative_tolerance = 1e-9\n'
                                           'absolute_tolerance = 1e-10')
                self.bough("run", "s.toml", "-o", "s.h5")
                np.testing.assert_allclose(self.read_last_speed(), expected, rtol=1e-6, err_msg=integrator)
        # Narrower than the samples, as one over a run is that has few.
        self.make(force, output_step=1.1)
        self.bough("run", "s.toml", "-o", "s.h5")
        np.testing.assert_allclose(self.read_last_speed(), expected, rtol=1e-5)

    def test_a_motion_that_begins_late(self):
        """Its rate is 0 to rounding for most of the run, and its formula cancels there; no step passes over it."""
        for rate, acceleration in (("0.25*(1-tanh((t-8)/0.2)^2)", "-2.5*tanh((t-8)/0.2)*(1-tanh((t-8)/0.2)^2)"),
                                   ("0.25/cosh((t-8)/0.2)^2", "-2.5*tanh((t-8)/0.2)/cosh((t-8)/0.2)^2")):
            self.make(f'[[function]]\nname = "m"\ntype = "expression"\nexpression = "0.05*(1+tanh((t-8)/0.2))"\n'
                      f'rate = "{rate}"\nacceleration = "{acceleration}"\n', hinge='motion = "m"')
            said = self.bough("run", "s.toml", "-o", "s.h5").stderr
            self.assertNotIn("energy", said)
            with h5py.File(self.path("s.h5")) as f:
                t, x, work = f["time"][:], f["sensors/x"][:, 0], f["energy/work"][:]
                kinetic = f["energy/kinetic"][:]
            np.testing.assert_allclose(x, .05 * (1 + np.tanh((t - 8) / .2)), atol=1e-12)
            np.testing.assert_allclose(kinetic.max(), .25**2, rtol=1e-3)
            np.testing.assert_allclose(work, kinetic, atol=1e-7)
        self.make(table("function", "m", "expression", expression="0.05*(1+tanh((t-8)/0.2))",
                        rate="0.3/cosh((t-8)/0.2)^2", acceleration="-2.5*tanh((t-8)/0.2)/cosh((t-8)/0.2)^2"),
                  hinge='motion = "m"')
        self.fails(1, "run", "s.toml", "-o", "s.h5", says=["rate"], error="function.bad-value")

    def test_changes_without_progress(self):
        switch = '[[controller]]\nname = "c"\ntype = "relay"\ninputs = ["v:x"]\non = 1e-9\noff = -1e-9\nvalue = -10.0\n' \
                 f"low = 10.0\n{DRIVE}"
        for more, hinge in (("", STOPS.format(rate=100.0)), (switch, "position = 1.0\nrate = 1.0")):
            self.make(more, hinge, duration=10.0, output_step=.1)
            self.fails(3, "run", "s.toml", "-o", "s.h5", says=["no progress", "within 3e-07 of each other"], error="run.stalled")

    def test_told_to_end_between_impacts(self):
        """A million impacts a second: the run ends at one of the next, long before the next sample."""
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            self.make(get_astray(IN_OUTPUTS, HOLD, 1e-3, "x:x") + DRIVE.replace('"c"', '"law"'),
                      hinge=STOPS.format(rate=1.0), duration=10.0, output_step=1.0)
            process, _ = self.start_held("run", "s.toml", "-o", "s.h5")
            process.send_signal(number)
            said = process.communicate(timeout=HANG)[1]
            self.assertEqual(process.returncode, 3, said)
            with h5py.File(self.path("s.h5")) as f:
                self.assertGreater(f["checkpoint/time"][()], 5e-4)
                self.assertLess(f["checkpoint/time"][()], 2e-3)

    def test_a_hangup_ends_a_run_in_good_order(self):
        self.make(get_astray(IN_OUTPUTS, HOLD, 1.5, "x:x"), simulation='integrator = "rk4"\nstep = 1e-3', duration=4.0,
                  output_step=1.0)
        process, _ = self.start_held("run", "s.toml", "-o", "s.h5", stdout=subprocess.PIPE)
        process.send_signal(signal.SIGHUP)
        said = "".join(process.communicate(timeout=HANG))
        self.assertEqual(process.returncode, 3, said)
        self.assertIn("--resume", said)
        self.assertNotIn("nothing was written", said)

    def test_a_limit_of_file_sizes(self):
        """Not the end of the program without a word, but an error of the file; what had its name stays readable."""
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        shutil.copy(self.path("boom.h5"), self.path("good.h5"))
        limit = (lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (8_000, 8_000)))
        for words in (["reduce", "boom.toml", "-o", "good.h5"], ["run", "spinup.toml", "-o", "r.h5"],
                      ["modes", "boom.bdf", "-o", "m.h5"], ["report", "boom.h5", "-o", "r.html"]):
            done = subprocess.run([PROGRAM, *words], cwd=self.folder, text=True, capture_output=True, preexec_fn=limit,
                                  check=False)
            self.assertEqual(done.returncode, 3, (words, done.stderr))
            self.assertIn(words[-1].split(".")[0], done.stderr, words)
        self.bough("info", "good.h5")

    def test_a_body_that_check_refuses_does_not_run(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        for path, change in (("/stiffening/kg_inertial", lambda v: v + np.triu(np.full(v.shape[-2:], np.abs(v).max()), 1)),
                             ("/rigid/inertia", lambda v: .5 * v)):
            shutil.copy(self.path("boom.h5"), self.path("old.h5"))
            with h5py.File(self.path("boom.h5"), "a") as f:
                f[path][...] = change(f[path][:])
            self.fails(1, "check", "boom.h5", says=[path], error="hdf5.value")
            self.fails(1, "run", "spinup.toml", says=[path], error="hdf5.value")
            shutil.move(self.path("old.h5"), self.path("boom.h5"))

    def test_decks_that_end_early(self):
        deck = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCBAR,1,1,1,2,0.,0.,1.\nPBAR,1,1,1.-4,1.-8,1.-8,1.-8\n" \
               "MAT1,1,7.+10,,.3,2700.\nCONM2,9,2,,1.75-2"
        self.write("d.bdf", deck[:-2])
        self.assertIn("d.bdf:6: warning", self.bough("modes", "d.bdf").stderr)
        for end in ("\n", "\nENDDATA"):
            self.write("d.bdf", deck + end)
            self.assertNotIn("deck.cut-off", self.bough("modes", "d.bdf").stderr)
        self.write("empty.bdf", "")
        self.fails(1, "init", "empty.bdf", error="fe.no-grids")


if __name__ == "__main__":
    unittest.main()
