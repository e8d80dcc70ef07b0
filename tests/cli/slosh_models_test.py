"""Slosh as a mass on springs and its damping by wall and baffles, against formulas and the pendulum."""
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

XI = 1.8411837813406593
G = 9.81


def make_system(hinge=None, gravity=(0.0, 0.0, -G), depth=1.2, axis=(0.0, 0.0, 1.0), duration=3.0, **tank):
    mass = 1000 * math.pi * depth
    return toml(
        table("body", "vehicle", mass=3000.0, inertia=[900.0, 900.0, 500.0]),
        table("tank", "lox", "cylinder", body="vehicle", mass=mass, radius=1.0, height=3.0, density=1000.0, slosh=True,
              axis=list(axis), position=[-1.0 * a for a in axis], **tank),
        table("hinge", "lateral", child="vehicle", **(hinge or {"kind": "fixed"})),
        section("simulation", duration=duration, gravity=list(gravity), integrator="rk", relative_tolerance=1e-11))


class SloshModels(ProgramTest):
    def find_poles(self, text):
        self.write("slosh.toml", text)
        self.bough("linearize", "slosh.toml", "-o", "l.h5", "-q")
        with h5py.File(self.path("l.h5")) as f:
            poles = np.linalg.eigvals(f["/A"][()])
        return poles[np.argsort(-poles.imag)][:2]

    def test_springs_have_the_frequency_and_the_mass(self):
        for depth in (0.5, 2.0):
            omega = math.sqrt(G * XI * math.tanh(XI * depth))
            poles = self.find_poles(make_system(slosh_model="spring", slosh_damping=0.02, depth=depth))
            np.testing.assert_allclose(np.abs(poles), omega, rtol=1e-9)  # both directions
            np.testing.assert_allclose(-poles.real / np.abs(poles), 0.02, rtol=1e-6)

    def test_springs_and_pendulum_are_one_model_for_small_motions(self):
        """A vehicle that turns about an axis across the tank and floats sideways: equal poles, whatever the tank's axis.

        The weight of the mass off its rest position turns the vehicle as the hinge of the pendulum does."""
        for axis, tilt in (((0.0, 0.0, 1.0), 0.0), ((0.6, 0.0, 0.8), math.atan2(0.6, 0.8))):
            hinge = {"kind": "general", "rotations": "xy", "translations": "xy", "stiffness": [9e4, 9e4, 0.0, 0.0],
                     "parent_rotation": [0.0, tilt, 0.0], "child_rotation": [0.0, tilt, 0.0]}
            gravity = [-G * a for a in axis]
            found = [self.find_poles(make_system(hinge, gravity, slosh_damping=0.01, slosh_model=model, axis=axis))
                     for model in ("pendulum", "spring")]
            np.testing.assert_allclose(found[1], found[0], rtol=1e-7)

    def test_springs_do_not_follow_the_acceleration(self):
        poles = self.find_poles(make_system(gravity=(0.0, 0.0, -2.0), slosh_model="spring", slosh_acceleration=G))
        np.testing.assert_allclose(np.abs(poles), math.sqrt(G * XI * math.tanh(XI * 1.2)), rtol=1e-9)

    def test_wall_and_baffles_damp_as_the_formulas_say(self):
        """Smooth wall: 0.79 √ν R^-3/4 g^-1/4 (...) (SP-106); rings: 2.83 exp(-4.6 d/R) α^1.5 √(η/R) each (Miles 1958)."""
        depth, nu, width, eta = 1.2, 2e-5, 0.08, 0.1
        x = 1.84 * depth
        wall = 0.79 * math.sqrt(nu) * G**-0.25 * (1 + 0.318 / math.sinh(x) * (1 + (1 - depth) / math.cosh(x)))
        alpha = 1 - (1 - width)**2  # the share of the cross-section that a ring covers
        rings = sum(2.83 * math.exp(-4.6 * d) * alpha**1.5 * math.sqrt(eta) for d in (0.1, 0.45))
        baffles = {"baffle_width": width, "baffle_depths": [0.1, 0.45], "baffle_amplitude": eta}
        for model in ("pendulum", "spring"):
            for keys, ratio in (({"slosh_viscosity": nu}, wall), (baffles, rings),
                                ({"slosh_viscosity": nu, "slosh_damping": 0.003, **baffles}, wall + rings + 0.003)):
                poles = self.find_poles(make_system(slosh_model=model, **keys))
                np.testing.assert_allclose(-poles.real / np.abs(poles), ratio, rtol=1e-6)

    def test_units_are_converted_and_the_motion_stays(self):
        poles = self.find_poles(make_system(slosh_viscosity=2e-5, baffle_width=0.08, baffle_depths=[0.1],
                                            baffle_amplitude=0.1, slosh_model="spring"))
        self.bough("convert", "slosh.toml", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.toml")
        np.testing.assert_allclose(self.find_poles(self.read("mm.toml")), poles, rtol=1e-8)

    def test_what_cannot_be_is_named(self):
        rings = {"baffle_width": 0.1, "baffle_depths": [0.2], "baffle_amplitude": 0.1}
        for keys, error in (({"slosh_model": "spring", "gravity": (0.0, 0.0, 0.0)}, "sloshes on springs and has no acceleration"),
                            ({**rings, "baffle_depths": [1.5]}, "has a baffle that is above the surface"),
                            ({**rings, "baffle_width": 1.0}, "wider than the radius"),
                            ({"baffle_width": 0.1}, "'baffle_depths' is missing")):
            self.write("bad.toml", make_system(**keys))
            self.assertIn(error, self.bough("check", "bad.toml", code=1).stderr)
        sphere = make_system(slosh_viscosity=1e-6).replace('"cylinder"', '"sphere"').replace("height = 3.0\n", "")
        self.write("bad.toml", sphere)
        self.assertIn("is no cylinder", self.bough("check", "bad.toml", code=1).stderr)
        self.write("bad.toml", make_system().replace("slosh = true", "slosh = false\nslosh_viscosity = 1e-6"))
        self.assertIn("toml.conflicting-keys", self.bough("check", "bad.toml", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
