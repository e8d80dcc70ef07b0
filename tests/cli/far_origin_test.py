"""A satellite in its orbit does not depend on where its hinge is written, on the inertial origin or on the units."""
import math
import unittest

import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

MU, RADIUS = 3.986e14, 7.0e6
RATE = math.sqrt(MU / RADIUS**3)


def make_satellite(hinge_at="parent", origin=(0.0, 0.0, 0.0), length=1.0, time=1.0, translations="xyz"):
    """A bus with a wing on a soft hinge in the frame of a circular orbit (x up, z along the normal); length, time: units
    in metres and seconds."""
    turn = length**2
    out, of_orbit = RADIUS / length, [x / length for x in origin]
    place = {"parent_position": [out, 0.0, 0.0]} if hinge_at == "parent" else {}
    arm = {"child_position": [-out, 0.0, 0.0]} if hinge_at == "child" else {}
    start = [0.02, 0.01, -0.02] + [0.0] * len(translations)
    if hinge_at == "coordinate":
        start[3] = out
    return toml(
        table("body", "orbit", mass=1.0, inertia=[1.0 / turn] * 3),
        table("body", "bus", mass=1000.0, inertia=[i / turn for i in (500.0, 1200.0, 1400.0, 20.0, 10.0, 5.0)]),
        table("body", "wing", mass=50.0, inertia=[i / turn for i in (10.0, 30.0, 20.0)], cg=[1.0 / length, 0.0, 0.0]),
        table("function", "turn", "ramp", value=1e4 * RATE * time, **{"from": 0.0, "to": 1e4}),
        table("hinge", "arm", "revolute", child="orbit", parent_position=of_orbit, motion="turn", **arm),
        table("hinge", "flight", "general", parent="orbit", child="bus", translations=translations, rotations="zyx",
              position=start, **place),
        table("hinge", "root", "revolute", parent="bus", child="wing", parent_position=[0.5 / length, 0.0, 0.0],
              axis=[0.0, 1.0, 0.0], stiffness=0.01 * time**2 / turn, position=0.3),
        table("force", "earth", "gravity_central", mu=MU * time**2 / length**3, centre=of_orbit, bodies=["bus", "wing"]),
        section("simulation", start=10.0, duration=1.0))


CASES = {"written at the parent": {"hinge_at": "parent"}, "at the child": {"hinge_at": "child"},
         "as a coordinate": {"hinge_at": "coordinate"}, "in kilometres": {"length": 1e3},
         "in millimetres": {"length": 1e-3}, "in millimetres and minutes": {"length": 1e-3, "time": 60.0},
         "about another origin": {"origin": (1.1e6, -2.3e6, 0.7e6)},
         "about another origin, at the child": {"origin": (1.1e6, -2.3e6, 0.7e6), "hinge_at": "child"}}


class Satellite(ProgramTest):
    def find(self, translations, length=1.0, time=1.0, **case):
        """Attitude and wing angle of the equilibrium, place in metres, frequencies in the orbital rate."""
        self.write("s.toml", make_satellite(length=length, time=time, translations=translations, **case))
        self.bough("equilibrium", "s.toml", "-o", "e.h5")
        self.bough("linearize", "s.toml", "--equilibrium", "-o", "m.h5")
        q, imag, real, names = self.read_arrays("m.h5", "operating_point/q", "poles/imag", "poles/real",
                                                 "operating_point/positions/name")
        names = [n.decode() for n in np.ravel(names)]
        q = dict(zip(names, np.ravel(q)))
        place = np.array([q[f"flight:{4 + i}"] for i in range(len(translations))]) * length
        if case.get("hinge_at") == "coordinate":
            place[0] -= RADIUS
        angles = np.array([q["flight:1"], q["flight:2"], q["flight:3"], q["root:1"]])
        poles = (np.ravel(real) + 1j * np.ravel(imag)) / (RATE * time)
        return angles, place, np.sort(poles.imag[poles.imag > 0.1])

    def test_attitude_alone(self):
        reference = self.find("")
        self.assertEqual(len(reference[2]), 4)
        for name, case in CASES.items():
            if case.get("hinge_at") == "coordinate":
                continue
            with self.subTest(name):
                angles, _, frequencies = self.find("", **case)
                np.testing.assert_allclose(angles, reference[0], rtol=0, atol=1e-8)
                np.testing.assert_allclose(frequencies, reference[2], rtol=1e-8)

    def test_attitude_and_place(self):
        angles, place, frequencies = self.find("xyz")
        self.assertLess(abs(place).max(), 2.0)
        own = abs(frequencies - 1) > 0.01  # the other two are those of the orbit, a double pole with a drift next to it
        self.assertEqual((len(own), np.sum(own)), (6, 4))
        for name, case in CASES.items():
            with self.subTest(name):
                other = self.find("xyz", **case)
                np.testing.assert_allclose(other[0], angles, rtol=0, atol=1e-8)
                np.testing.assert_allclose(other[1], place, rtol=0, atol=1e-8 * RADIUS)
                np.testing.assert_allclose(other[2][own], frequencies[own], rtol=1e-8)
                np.testing.assert_allclose(other[2][~own], 1.0, rtol=1e-5)

    def test_loops_close_in_the_same_place(self):
        """A four-bar on a satellite: its hinges move to close it, the satellite stays."""
        def make(**place):
            bodies = [table("body", "bus", mass=1000.0, inertia=[500.0, 1200.0, 1000.0],
                            nodes=[{"id": 1, "position": [1.0, 0.0, 0.0]}])]
            for name, l in (("crank", 0.3), ("coupler", 0.9), ("rocker", 0.6)):
                bodies.append(table("body", name, mass=2.0, cg=[l / 2, 0.0, 0.0], inertia=[0.001, l * l / 6, l * l / 6],
                                    nodes=[{"id": 1, "position": [l, 0.0, 0.0]}]))
            return toml(
                *bodies, table("hinge", "flight", "free", child="bus", **place),
                table("hinge", "a", "revolute", parent="bus", child="crank", rate=0.5, position=1.0),
                table("hinge", "b", "revolute", parent="crank", parent_node=1, child="coupler", guess=True, position=-0.5),
                table("hinge", "c", "revolute", parent="bus", parent_node=1, child="rocker", guess=True, position=1.2),
                table("constraint", "pin", "spherical", parent="coupler", parent_node=1, child="rocker", child_node=1),
                section("simulation", duration=0.1, integrator="rk"))
        starts = []
        for k, place in enumerate(({}, {"parent_position": [RADIUS, 0.0, 0.0]},
                                   {"position": [1.0, 0.0, 0.0, 0.0, RADIUS, 0.0, 0.0]})):
            self.write("four.toml", make(**place))
            self.bough("run", "four.toml", "-o", f"four{k}.h5", "-q")
            flight, b, c = self.read_arrays(f"four{k}.h5", "hinges/flight/q", "hinges/b/q", "hinges/c/q")
            at = np.array(flight[0][4:])
            if k == 2:
                at[0] -= RADIUS
            starts.append(np.concatenate([at, np.ravel(b)[:1], np.ravel(c)[:1]]))
        np.testing.assert_allclose(starts[1], starts[0], rtol=0, atol=2e-9)
        np.testing.assert_allclose(starts[2], starts[0], rtol=0, atol=2e-9)


if __name__ == "__main__":
    unittest.main()
