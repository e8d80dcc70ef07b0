"""Coordinates that an event or friction locks stand still to the last bit, whatever the integrator."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

FREE = [0.3, 0.1, 2.0, 0.1, 0.0, 0.0]


def make_two_bodies(integrator, duration, a=(), b=(), more=()):
    """A free body and one on a hinge with friction, both turning."""
    step = {"step": 5e-3} if integrator in ("rk4", "implicit") else {}
    return toml(table("body", "a", mass=2.0, nodes=[{"id": 1, "position": [1, 0, 0]}], **dict(a)),
                table("body", "b", mass=1.0, inertia=[0.1, 0.2, 0.3], cg=[0, 0, 0]),
                table("hinge", "fa", "free", child="a", rate=FREE),
                table("hinge", "hb", "revolute", child="b", parent="a", parent_node=1, rate=1.0,
                      friction={"coulomb": 0.02, "static": 0.03}, **dict(b)),
                *more, section("simulation", integrator=integrator, duration=duration, output_step=0.05, **step))


class LockedTest(ProgramTest):
    def run_case(self, text):
        self.write("case.toml", text)
        self.bough("run", "case.toml", "-o", "case.h5", "-q")
        with h5py.File(self.path("case.h5")) as f:
            lines = [line.decode() for line in f["events/what"][:]] if "events/what" in f else []
            return f["time"][:], f["hinges/hb/q"][:].ravel(), f["hinges/hb/qdot"][:].ravel(), lines

    def test_a_joint_that_sticks(self):
        """It neither moves nor slips at the times at which the integrator stops, the end of the run among them."""
        rod = table("sensor", "w", "gyro", body="a", sample_time=0.37)
        for integrator in ("rk", "radau", "bdf", "rk4", "implicit"):
            for more in ([], [rod]):
                time, q, rate, lines = self.run_case(make_two_bodies(integrator, 14.0, more=more))
                with self.subTest(integrator, sensors=len(more)):
                    self.assertEqual(["sticks" in line for line in lines], [True], lines)
                    held = np.flatnonzero(rate == 0)
                    self.assertGreater(len(held), 10)
                    np.testing.assert_array_equal(q[held], q[held[0]])
                    np.testing.assert_array_equal(rate[held[0]:], 0)

    def test_a_joint_that_an_event_locks(self):
        """The angle of the lock is that of a signal event: round-off would fire it again."""
        inertia = {"inertia": [0.1, 0.2, 0.3], "cg": [0, 0, 0]}
        hinge = {"axis": [0, 1, 0], "stiffness": 3.0, "child_position": [0.2, 0, 0]}
        events = [table("event", "lock", signal="/hinges/hb/q:1", value=-0.2, direction="falling", action="lock", hinge="hb"),
                  table("event", "again", signal="/hinges/hb/q:1", value=-0.2, direction="rising", action="stop")]
        for integrator in ("rk", "radau", "bdf"):
            time, q, rate, lines = self.run_case(make_two_bodies(integrator, 8.0, inertia, hinge, events))
            with self.subTest(integrator):
                self.assertAlmostEqual(time[-1], 8.0)
                self.assertEqual(sum("again" in line or "already" in line for line in lines), 0, lines)
                held = np.flatnonzero(rate == 0)
                self.assertGreater(len(held), 100)
                np.testing.assert_array_equal(q[held], q[held[0]])


if __name__ == "__main__":
    unittest.main()
