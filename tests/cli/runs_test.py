"""Runs from outside: what check foresees, what a resume accepts, how energy, events and samples are told."""
import csv
import io
import json
import os
import unittest

import h5py
import numpy as np
import scipy.io

from support import ProgramTest
from toml_text import section, table, toml

SATELLITE = toml(
    table("body", "sat", mass=1.0, inertia=[5.0, 2.0, 9.0, 0.0, 0.0, 0.0]),
    table("hinge", "f", "free", child="sat", rate=[0.1, 0.0, 1.0, 0.0, 0.0, 0.0]),
    table("function", "thrust", "table", file="thrust.csv"),
    table("force", "push", body="sat", force=[0.0, 0.0, 1.0], function="thrust"),
    section("simulation", duration=4.0, output_step=0.1))

PENDULUM = toml(
    table("body", "bob", mass=1.0, cg=[0.0, -1.0, 0.0], inertia=[0.001, 0.001, 0.001, 0.0, 0.0, 0.0]),
    table("hinge", "pin", "revolute", child="bob", position=1.0),
    table("sensor", "angle", "hinge_angle", hinge="pin"),
    section("simulation", duration=2.0, output_step=0.1, gravity=[0.0, -9.81, 0.0]))


def read_text(attribute):
    return attribute.decode() if isinstance(attribute, bytes) else attribute


class Check(ProgramTest):
    def test_check_refuses_what_run_refuses(self):
        for old, new, error in [('hinge = "pin"', 'hinge = "pin"\ncoordinate = 3', "sensor.bad-coordinate"),
                                ("duration = 2.0", "duration = 2.0\nstart = 1e18", "run.bad-simulation"),
                                ("duration = 2.0", 'duration = 2.0\nrecord = ["hinge"]', "run.unknown-group"),
                                ("[simulation]", '[[event]]\nname = "e"\nsignal = "angel"\n[simulation]', "run.unknown-signal"),
                                ("[simulation]", '[[sensor]]\nname = "s"\ntype = "position"\nbody = "bob"\nnode = 5\n[simulation]',
                                 "sensor.unknown-node")]:
            with self.subTest(error):
                self.write("p.toml", PENDULUM.replace(old, new))
                checked = self.fails(1, "check", "p.toml", error=error)
                run = self.fails(1, "run", "p.toml", error=error)
                self.assertFalse(os.path.exists(self.path("p.h5")))
                lines = [line for line in checked.stderr.splitlines() if "error:" in line]
                self.assertEqual(lines, [line for line in run.stderr.splitlines() if "error:" in line])

    def test_a_ball_joint_is_not_asked_for_three_functions(self):
        self.write("p.toml", PENDULUM.replace('type = "revolute"', 'type = "spherical"\nmotion = "f"').replace(
            "position = 1.0", "").replace("[simulation]", '[[function]]\nname = "f"\ntype = "constant"\nvalue = 0.0\n[simulation]'))
        result = self.fails(1, "check", "p.toml", error="system.prescribed-rotation")
        self.assertNotIn("expected 3", result.stderr)

    def test_all_errors_in_one_round(self):
        self.write("four.toml", toml(
            table("body", "a", mass=1.0, inertia=[1.0, 1.0, -1.0, 0.0, 0.0, 0.0]),
            table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]),
            table("body", "c", file="none.h5"),
            table("hinge", "h", "revolute", parent="b", parent_node=7, child="a"),
            table("force", "f", body="b", node=9, force=[1.0, 0.0, 0.0]),
            table("sensor", "s", "position", body="b", node=5),
            table("sensor", "on_a", "position", body="a", node=8),
            table("sensor", "on_c", "position", body="c", node=8),
            table("event", "e", signal="on_d:x"),
            section("simulation", duration=1.0, start=1e18)))
        result = self.fails(1, "check", "four.toml")
        for error, line in [("system.bad-inertia", 1), ("cli.no-body-file", 9), ("system.unknown-node", 12),
                            ("system.unknown-node", 18), ("sensor.unknown-node", 23), ("run.bad-simulation", 41)]:
            self.assertRegex(result.stderr, rf"four.toml:{line}[:\d]*: error: .*\[{error}\]")
        # Consequences of these errors are not reported.
        self.assertEqual(result.stderr.count("error:"), 6, result.stderr)


class Resume(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("thrust.csv", "0 0\n1 1\n4 0\n")
        self.write("sat.toml", SATELLITE)
        self.bough("run", "sat.toml")

    def resume(self, text, **kwargs):
        self.write("sat.toml", text)
        return self.bough("run", "sat.toml", "--resume", **kwargs)

    def test_goes_on_with_a_longer_duration(self):
        self.resume(SATELLITE.replace("duration = 4.0", "duration = 6.0 # longer"))
        self.write("whole.toml", SATELLITE.replace("duration = 4.0", "duration = 6.0"))
        self.bough("run", "whole.toml")
        with h5py.File(self.path("sat.h5")) as f, h5py.File(self.path("whole.h5")) as g:
            self.assertEqual(f["time"].shape, (61,))
            self.assertTrue(np.all(np.diff(f["time"][:]) > 0))
            for path in ["bodies/sat/quaternion", "momentum/angular", "energy/work"]:
                self.assertLess(np.abs(f[path][:] - g[path][:]).max(), 1e-6, path)
            self.assertEqual(f.attrs["completed"], 1)
            # The system at the start, and that of the continuation.
            self.assertEqual(f["system"].asstr()[()], SATELLITE)
            self.assertEqual(list(f["resumed/time"][:]), [4.0])
            self.assertIn("# longer", f["resumed/system"].asstr()[0])
            self.assertEqual([row[0] for row in f.attrs["source"]], ["sat.toml", "thrust.csv"])

    def test_refuses_another_system(self):
        before = open(self.path("sat.h5"), "rb").read()
        for old, new, line, words in [
                ("9.0, 0.0", "8.0, 0.0", 4, "body 'sat': inertia is [5, 2, 8, 0, 0, 0], was [5, 2, 9, 0, 0, 0] when the run was started"),
                ("rate = [0.1", "rate = [0.2", 9, "hinge 'f': rate is"),
                ("duration = 4.0", "duration = 6.0\nintegrator = \"rk\"", 21, "simulation: integrator was not there"),
                ("child = \"sat\"\n", "", 6, "missing")]:
            with self.subTest(words):
                self.write("sat.toml", SATELLITE.replace(old, new))
                result = self.bough("run", "sat.toml", "--resume", code=1)
                self.assertIn(words, result.stderr)
                if words != "missing":
                    self.assertIn("[toml.changed]", result.stderr)
                    self.assertIn(f"sat.toml:{line}", result.stderr)
        self.assertEqual(open(self.path("sat.h5"), "rb").read(), before)

    def test_refuses_another_table(self):
        self.write("thrust.csv", "0 0\n1 2\n4 0\n")
        result = self.resume(SATELLITE.replace("duration = 4.0", "duration = 6.0"), code=1)
        self.assertIn("thrust.csv: error: the file is not the one that the run was started with", result.stderr)
        self.assertIn("[cli.changed-input]", result.stderr)

    def test_a_window_that_begins_later(self):
        # The kill comes before the first sample that is written.
        text = SATELLITE.replace("output_step = 0.1", "output_step = 0.1\noutput_from = 3.05\noutput_every = 2")
        self.write("late.toml", text.replace("duration = 4.0", "duration = 3.1"))
        self.bough("run", "late.toml")
        with h5py.File(self.path("late.h5")) as f:
            self.assertEqual(list(f["time"][:]), [3.1])
        self.write("late.toml", text.replace("output_from", "divergence_limit = 1e5\noutput_from"))
        self.bough("run", "late.toml", "--resume")
        with h5py.File(self.path("late.h5")) as f:
            self.assertTrue(np.allclose(f["time"][:], [3.1, 3.2, 3.4, 3.6, 3.8, 4.0]))


class Told(ProgramTest):
    def test_energy_from_nowhere_is_a_failure_with_results(self):
        self.write("p.toml", PENDULUM.replace("[simulation]", "[simulation]\nenergy_error_limit = 1e-12\n"
                                              "relative_tolerance = 1e-5\nabsolute_tolerance = 1e-7"))
        result = self.bough("run", "p.toml", code=3)
        self.assertIn("completed at t = 2", result.stdout)
        self.assertIn("worst energy error ", result.stdout)
        self.assertIn("[run.energy-error]", result.stderr)
        with h5py.File(self.path("p.h5")) as f:
            worst = f["energy"].attrs["energy_error"]
            self.assertGreater(worst, 1e-9)
            self.assertEqual(f.attrs["completed"], 1)
            self.assertEqual(f["time"].shape, (21,))
        report = self.bough("run", "p.toml", "--json", code=3)
        self.assertAlmostEqual(json.loads(report.stdout)["energy_error"] / worst, 1, delta=1e-12)

    def test_an_event_stops_the_run(self):
        self.write("p.toml", PENDULUM.replace("[simulation]", """[[event]]
name = "lowest"
signal = "angle"
value = 0.0
action = "stop"
[[event]]
name = "half"
signal = "/hinges/pin/q"
value = 0.5
direction = "falling"
[simulation]"""))
        result = self.bough("run", "p.toml")
        self.assertIn("stopped by event 'lowest': angle falls through 0 at t = 0.5", result.stdout)
        with h5py.File(self.path("p.h5")) as f:
            self.assertEqual(f.attrs["completed"], 1)
            self.assertIn("stopped by event 'lowest'", f.attrs["reason"])
            self.assertLess(abs(f["sensors/angle"][-1]), 1e-9)
            what = [x.decode() for x in f["events/what"][:]]
            self.assertEqual(what, ["event 'half': /hinges/pin/q falls through 0.5", "event 'lowest': angle falls through 0"])
        self.assertIn("complete already: stopped by event", self.bough("run", "p.toml", "--resume").stdout)

    def test_events_are_printed_listed_and_exported(self):
        """The time of the first crossing of zero is known: a quarter of the period in samples of the run itself."""
        self.write("p.toml", PENDULUM.replace("[simulation]", """[[event]]
name = "low, \\"first\\""
signal = "angle"
value = 0.0
direction = "falling"
[simulation]"""))
        line = "event 'low, \"first\"': angle falls through 0"
        said = self.bough("run", "p.toml").stdout
        with h5py.File(self.path("p.h5")) as f:
            times, what, source = (f["events/" + name][:] for name in ("time", "what", "source"))
            angle, t = f["sensors/angle"][:], f["time"][:]
        at = next(i for i in range(1, len(t)) if angle[i - 1] > 0 >= angle[i])
        self.assertTrue(t[at - 1] <= times[0] <= t[at])
        self.assertEqual([x.decode() for x in what], [line] * len(times))
        self.assertEqual([x.decode() for x in source], ['event low, "first"'] * len(times))
        self.assertEqual(said.count(line), len(times))
        self.assertIn(f"t = {times[0]:<12.9g} {line}", said)
        self.assertIn(f"t = {times[0]:<12.9g} {line}", self.bough("info", "p.h5").stdout)
        listed = json.loads(self.bough("info", "p.h5", "--json").stdout)["events"]
        self.assertEqual([e["time"] for e in listed], list(times))
        self.assertEqual(json.loads(self.bough("run", "p.toml", "--json").stdout)["events"], listed)
        for channel in ("events", "/events"):
            rows = list(csv.DictReader(io.StringIO(
                self.bough("export", "p.h5", "--to", "csv", "--channel", channel).stdout)))
            self.assertEqual([(float(r["time"]), r["what"], r["source"]) for r in rows],
                             [(x, line, 'event low, "first"') for x in times])
        self.bough("export", "p.h5", "--to", "mat", "-o", "p.mat")
        events = scipy.io.loadmat(self.path("p.mat"), simplify_cells=True)["events"]
        np.testing.assert_array_equal(np.atleast_1d(events["time"]), times)
        self.assertEqual(list(np.atleast_1d(events["what"])), [line] * len(times))

    def test_a_run_that_was_killed_at_once_starts_again(self):
        self.write("p.toml", PENDULUM)
        self.bough("run", "p.toml")
        whole = self.read("p.h5")
        with h5py.File(self.path("p.h5"), "a") as f:    # as before the first commit
            f.attrs["completed"], f.attrs["reason"], f.attrs["num_samples"] = 0, "running", 0
            for name in list(f["checkpoint"]):
                del f["checkpoint"][name]
        self.bough("run", "p.toml", "--resume")
        np.testing.assert_array_equal(self.read("p.h5"), whole)

    def read(self, name):
        with h5py.File(self.path(name)) as f:
            return f["sensors/angle"][:]

    def test_only_what_is_asked_for_is_written(self):
        self.write("p.toml", PENDULUM.replace("duration = 2.0", 'duration = 2.0\nrecord = ["sensors"]\noutput_every = 5'))
        self.bough("run", "p.toml")
        with h5py.File(self.path("p.h5")) as f:
            self.assertEqual(sorted(f["sensors"]), ["angle"])
            self.assertNotIn("bodies", f)
            self.assertEqual(f["time"].shape, (5,))
            self.assertIn("energy_error", f["energy"].attrs)

    def test_dims_are_those_of_the_coordinates(self):
        types = {"turn": ("revolute", "1", "1/T", "F L"), "slide": ("prismatic", "L", "L/T", "F"),
                 "both": ("cylindrical", "1, L", "1/T, L/T", "F L, F"), "plane": ("planar", "L, L, 1", "L/T, L/T, 1/T", "F, F, F L"),
                 "screw": ("screw", "1", "1/T", "F L"), "ball": ("spherical", "1", "1/T", "F L"),
                 "fly": ("free", "1, 1, 1, 1, L, L, L", "1/T, 1/T, 1/T, L/T, L/T, L/T", "F L, F L, F L, F, F, F")}
        text = ""
        for name, (kind, *_) in types.items():
            text += f'[[body]]\nname = "b_{name}"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n'
            text += f'[[hinge]]\nname = "{name}"\ntype = "{kind}"\nchild = "b_{name}"\n' + "pitch = 0.1\n" * (kind == "screw")
            text += f'[[sensor]]\nname = "s_{name}"\ntype = "hinge_angle"\nhinge = "{name}"\n'
        self.write("h.toml", text + "[simulation]\nduration = 0.1\n")
        self.bough("run", "h.toml", "-q")
        with h5py.File(self.path("h.h5")) as f:
            for name, (_, *expected) in types.items():
                for channel, dims in zip(("q", "qdot", "force"), expected):
                    self.assertEqual(read_text(f[f"hinges/{name}/{channel}"].attrs["dims"]), dims, (name, channel))
                self.assertEqual(read_text(f[f"sensors/s_{name}"].attrs["dims"]), expected[0], name)

    def test_relative_accelerations(self):
        # Relative to a body that turns with it, a point of that body rests, as its riders see it.
        text = PENDULUM.replace("inertia =", 'nodes = [{id = 1, position = [0.0, -2.0, 0.0]}]\ninertia =')
        for kind in ["velocity", "acceleration", "angular_velocity", "angular_acceleration"]:
            for observer in ["turning", "fixed"]:
                text = text.replace("[simulation]", f'[[sensor]]\nname = "{kind}_{observer}"\ntype = "{kind}"\nbody = "bob"\n'
                                    f'node = 1\nrelative_to = "bob"\nobserver = "{observer}"\n[simulation]')
        self.write("p.toml", text)
        self.bough("run", "p.toml")
        with h5py.File(self.path("p.h5")) as f:
            for kind in ["velocity", "acceleration", "angular_velocity", "angular_acceleration"]:
                self.assertLess(np.abs(f[f"sensors/{kind}_turning"][:]).max(), 1e-12, kind)
            rate, q = f["hinges/pin/qdot"][:], f["hinges/pin/q"][:]
            expected = 2 * rate[:, None] * np.stack([np.cos(q), np.sin(q), 0 * q], axis=1)
            self.assertLess(np.abs(f["sensors/velocity_fixed"][:] - expected).max(), 1e-12)
        self.write("bad.toml", PENDULUM.replace('hinge = "pin"', 'hinge = "pin"\nobserver = "fixed"'))
        self.fails(1, "check", "bad.toml", error="toml.conflicting-keys")

    def test_a_tiny_largest_step(self):
        self.write("p.toml", PENDULUM.replace("duration = 2.0", "duration = 20.0\nstep = 1e-12"))
        self.fails(1, "run", "p.toml", error="run.bad-simulation", says=["step asks for more than 1e11 steps"])

    def test_a_small_largest_step_keeps_the_accuracy(self):
        errors = []
        for step in ["", "step = 1e-4\n"]:
            self.write("p.toml", PENDULUM.replace("duration = 2.0", step + "duration = 1.0"))
            errors.append(json.loads(self.bough("run", "p.toml", "--json").stdout)["energy_error"])
        self.assertLess(errors[1], max(10 * errors[0], 1e-8), errors)


if __name__ == "__main__":
    unittest.main()
