"""Orbit from outside: LVLH, atmosphere, sunlight and shadow, magnetic dipole and torque rods, against closed forms."""
import math
import re
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import Bare, section, table, toml

MU, EARTH = 3.986004418e14, 6.378137e6

SYSTEM = toml(
    table("body", "sat", mass=1000.0, inertia=Bare("{inertia}")),
    table("hinge", "orbit", "free", child="sat", position=[Bare("{attitude}"), Bare("{x}"), 0.0, 0.0],
          rate=[Bare("{spin}"), 0.0, Bare("{speed}"), 0.0]),
    table("force", "earth", "gravity_central", mu=3.986004418e14, radius=6378137.0, dipole=[Bare("{dipole}")]),
    "{more}\n",
    section("simulation", duration=Bare("{duration}"), output_step=Bare("{step}"), integrator="rk",
            relative_tolerance=1e-12, absolute_tolerance=1e-10))


class SpaceEnvironment(ProgramTest):
    def run_system(self, height=400e3, turns=1.0, samples=400, **more):
        r = EARTH + height
        n = math.sqrt(MU / r**3)
        duration = more.pop("duration", turns * 2 * math.pi / n)
        keys = {"inertia": "[500.0, 500.0, 500.0]", "attitude": "1.0, 0.0, 0.0, 0.0", "spin": "0.0, 0.0, 0.0", "x": repr(r),
                "speed": repr(n * r), "dipole": "0.0, 0.0, 0.0", "more": "", "duration": repr(duration),
                "step": repr(duration / samples), **more}
        self.write("orbit.toml", SYSTEM.format(**keys))
        self.bough("run", "orbit.toml", "-o", "orbit.h5", "-q")
        with h5py.File(self.path("orbit.h5")) as f:
            found = {}
            f.visititems(lambda name, o: found.__setitem__(name, o[()]) if isinstance(o, h5py.Dataset) else None)
        return found, r, n

    def test_a_hundred_orbits_close(self):
        found, r, n = self.run_system(turns=100, samples=100)
        p = found["bodies/sat/position"][-1]
        self.assertLess(np.linalg.norm(p - [r, 0, 0]), 1.0)  # of 4.3e9 travelled

    def test_an_orbit_next_to_fast_modes_costs_what_the_orbit_costs(self):
        """Two panels on springs, 15 rad/s, damped by half a per cent: auto takes radau, which agrees with rk at a tenth of
        the evaluations, most of them while the panels still swing. bdf would take as many as rk."""
        k, c = 15.0**2 * 12.0, 2 * 0.005 * 15.0 * 12.0
        panels = "".join(
            table("body", name, mass=10.0, cg=[0.0, side, 0.0], inertia=[2.0, 0.1, 2.1])
            + table("hinge", "root " + name, "revolute", parent="sat", child=name, parent_position=[0.0, side, 0.0],
                    axis=[1.0, 0.0, 0.0], stiffness=k, damping=c, position=1e-3)
            for name, side in (("left", 1.0), ("right", -1.0)))
        places, evaluations = {}, {}
        for integrator, tolerance in (("rk", 1e-12), ("auto", 1e-9)):
            text = SYSTEM.replace('"rk"', f'"{integrator}"').replace("1e-12", repr(tolerance))
            r = EARTH + 600e3
            n = math.sqrt(MU / r**3)
            duration = 2 * math.pi / n
            self.write("wings.toml", text.format(
                inertia="[60.0, 80.0, 70.0]", attitude="1.0, 0.0, 0.0, 0.0", spin=f"0.0, 0.0, {1.001 * n!r}", x=repr(r),
                speed=repr(n * r), dipole="0.0, 0.0, 0.0", more=panels, duration=repr(duration), step=repr(duration / 100)))
            done = self.bough("run", "wings.toml", "-o", "wings.h5")
            if integrator == "auto":
                self.assertIn("integrator radau is taken", done.stderr)
            evaluations[integrator] = int(re.search(r"(\d+) evaluations", done.stdout).group(1))
            places[integrator], = self.read_arrays("wings.h5", "/bodies/sat/position")
        self.assertLess(np.abs(places["auto"] - places["rk"]).max(), 0.01)
        self.assertLess(evaluations["auto"], evaluations["rk"] / 10)

    def test_lvlh_is_the_reference_of_attitude_rate_and_place(self):
        """Kept to LVLH by its spin: x along the path, z to the centre, y against the orbit's normal (here +z)."""
        # R_WL at x = r: columns x = +y, y = -z, z = -x.
        more = toml(
            table("body", "free", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "away", "free", child="free", position=[1.0, 0.0, 0.0, 0.0, 7e6, 0.0, 0.0],
                  rate=[0.0, 0.0, 0.0, 0.0, 7500.0, 50.0]),
            table("sensor", "error", "euler", body="sat", relative_to="lvlh:sat"),
            table("sensor", "rate", "angular_velocity", body="sat", relative_to="lvlh:sat"),
            table("sensor", "place", "position", body="free", relative_to="lvlh:sat"))
        found, r, n = self.run_system(attitude="0.5, -0.5, -0.5, 0.5", spin=f"0.0, {-math.sqrt(MU / (EARTH + 400e3)**3)!r}, 0.0",
                                      turns=0.7, more=more)
        self.assertLess(np.abs(found["sensors/error"]).max(), 1e-9)
        self.assertLess(np.abs(found["sensors/rate"]).max(), 1e-12)
        position, velocity = found["bodies/sat/position"], found["bodies/sat/velocity"]
        z = -position / np.linalg.norm(position, axis=1)[:, None]
        y = -np.cross(position, velocity)
        y /= np.linalg.norm(y, axis=1)[:, None]
        x = np.cross(y, z)
        gap = found["bodies/free/position"] - position
        expected = np.stack([np.sum(gap * e, axis=1) for e in (x, y, z)], axis=1)
        np.testing.assert_allclose(found["sensors/place"], expected, rtol=1e-9, atol=1e-3)

    def test_drag_lowers_a_circular_orbit_at_its_rate(self):
        """da/dt = -ρ C_d A/m √(μ a) in air at rest whose density is exponential in altitude."""
        drag = table("force", "air", "drag", body="sat", area=4.0, coefficient=2.2, density=5e-11, planet="earth",
                     scale_height=60e3, altitude=300e3)
        found, r, n = self.run_system(height=330e3, more=drag, turns=10, samples=100)
        p, v = found["bodies/sat/position"], found["bodies/sat/velocity"]
        a = 1 / (2 / np.linalg.norm(p, axis=1) - np.sum(v * v, axis=1) / MU)
        density = 5e-11 * math.exp(-30e3 / 60e3)
        rate = -density * 4.0 * 2.2 / 1000 * math.sqrt(MU * r)
        # Loss integrated with the density at each a: a' = rate exp(-(a - r)/H).
        t = found["time"][-1]
        expected = 60e3 * math.log(1 + rate * t / 60e3)
        self.assertAlmostEqual((a[-1] - r) / expected, 1, delta=2e-3)
        self.assertLess(abs(found["forces/air/force"][0, 1] + 0.5 * density * 4 * 2.2 * (n * r)**2), 1e-12)

    def test_the_air_turns_with_the_planet(self):
        spin = 7.2921159e-5
        drag = '[[force]]\nname = "air"\ntype = "drag"\nbody = "sat"\narea = 4.0\ncoefficient = 2.2\ndensity = 5e-11\n' \
               f'planet = "earth"\nscale_height = 60e3\naltitude = 400e3\nspin = [0.0, 0.0, {spin}]\n'
        found, r, n = self.run_system(more=drag, turns=0.01)
        self.assertAlmostEqual(found["forces/air/force"][0, 1] / (-0.5 * 5e-11 * 8.8 * (n * r - spin * r)**2), 1, delta=1e-12)

    def test_sunlight_presses_and_the_earth_takes_it_away(self):
        panel = table("force", "panel", "solar_pressure", body="sat", normal=[1.0, 1.0, 0.0], area=10.0,
                      pressure=4.56e-6, sun=[1.0, 0.0, 0.0], specular=0.3, diffuse=0.2, planet="earth")
        found, r, n = self.run_system(height=700e3, more=panel, samples=3000)
        force, light = found["forces/panel/force"], found["forces/panel/sunlight"].ravel()
        c = math.sqrt(0.5)
        normal, sun = np.array([c, c, 0]), np.array([1.0, 0, 0])
        expected = -4.56e-6 * 10 * c * (0.7 * sun + 2 * (0.3 * c + 0.2 / 3) * normal)
        np.testing.assert_allclose(force[0], expected, rtol=1e-9)
        np.testing.assert_allclose(force, light[:, None] * force[0], rtol=0, atol=1e-14)
        # Half of the penumbra is where the earth's limb passes the centre of the sun: 2 asin(R/r) of the turn is dark.
        dark = np.sum(1 - light[:-1]) / (len(light) - 1)
        self.assertAlmostEqual(dark, math.asin(EARTH / r) / math.pi, delta=5e-5)
        self.assertEqual(light.min(), 0.0)
        partial = np.sum((light > 0) & (light < 1)) / (len(light) - 1)
        # Penumbra lasts while the angle between limb and sun's centre changes by twice the sun's angular radius.
        self.assertAlmostEqual(partial, 2 * 2 * 0.004652 / (2 * math.pi), delta=8e-4)

    def test_the_dipole_and_the_rods_torque(self):
        more = toml(
            table("sensor", "field", "magnetometer", body="sat"),
            table("function", "m", "constant", value=30.0),
            table("actuator", "rod", "torque_rod", body="sat", axis=[1.0, 0.0, 0.0], input="m"))
        found, r, n = self.run_system(dipole="1e15, 2e15, -7.8e15", more=more, turns=0.05, samples=50)
        d = np.array([1e15, 2e15, -7.8e15])
        p, q = found["bodies/sat/position"], found["bodies/sat/quaternion"]
        radius = np.linalg.norm(p, axis=1)[:, None]
        B = (3 * (p @ d)[:, None] * p / radius**2 - d) / radius**3
        # Components in the body: R(q)ᵀ B.
        w, v = q[:, :1], -q[:, 1:]
        B_body = B + 2 * np.cross(v, np.cross(v, B) + w * B)
        np.testing.assert_allclose(found["sensors/field"], B_body, atol=1e-12 * np.abs(B).max())
        np.testing.assert_allclose(found["actuators/rod"][:, 1:], 30 * np.cross([1.0, 0, 0], B_body), rtol=1e-9, atol=1e-12)
        self.assertAlmostEqual(np.abs(found["bodies/sat/angular_velocity"][1]).max() /
                               (np.abs(30 * np.cross([1, 0, 0], B[0])).max() / 500 * found["time"][1]), 1, delta=2e-2)

    def test_librations_of_the_check_case(self):
        """NESC check-case cylinder, 500 / 12250 / 12250: 1.69634 n in the plane, 1.96914 n across (NASA/TM-2015-218675)."""
        n = math.sqrt(MU / (EARTH + 400e3)**3)
        # Long axis (x) up: R = 1 at the start, the body turns with the orbit.
        for axis, factor, start in ((2, 1.69634, "0.9999998, 0.0, 0.0, 0.00063246"),
                                    (1, 1.96914, "0.9999998, 0.0, 0.00063246, 0.0")):
            found, r, n = self.run_system(inertia="[500.0, 12250.0, 12250.0]", attitude=start, spin=f"0.0, 0.0, {n!r}",
                                          turns=3.0 / factor, samples=3000)
            p, q = found["bodies/sat/position"], found["bodies/sat/quaternion"]
            x = np.stack([1 - 2 * (q[:, 2]**2 + q[:, 3]**2), 2 * (q[:, 1] * q[:, 2] + q[:, 0] * q[:, 3]),
                          2 * (q[:, 1] * q[:, 3] - q[:, 0] * q[:, 2])], axis=1)
            up = p / np.linalg.norm(p, axis=1)[:, None]
            along = np.cross([0, 0, 1.0], up)
            angle = np.sum(x * (along if axis == 2 else np.array([0, 0, 1.0])), axis=1)
            t = found["time"].ravel()
            zeros = [t[i] - angle[i] * (t[i + 1] - t[i]) / (angle[i + 1] - angle[i])
                     for i in range(len(t) - 1) if angle[i] * angle[i + 1] < 0]
            period = 2 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
            self.assertAlmostEqual(2 * math.pi / period / n / factor, 1, delta=1e-4)

    def test_what_cannot_be_is_named(self):
        base = {"inertia": "[1.0, 1.0, 1.0]", "attitude": "1.0, 0.0, 0.0, 0.0", "spin": "0.0, 0.0, 0.0", "x": "7e6",
                "speed": "7.5e3", "dipole": "0.0, 0.0, 0.0", "duration": "10.0", "step": "1.0"}
        panel = table("force", "p", "solar_pressure", body="sat", normal=[1.0, 0.0, 0.0], area=1.0, pressure=4.56e-6,
                      sun=[1.0, 0.0, 0.0])
        for more, error in ((panel + 'planet = "erth"\n', "did you mean 'earth'"),
                            (panel + "specular = 0.8\ndiffuse = 0.4\n", "sum above one"),
                            (table("force", "d", "drag", body="sat", area=1.0, coefficient=2.0, density=1.0,
                                   scale_height=1.0), "no planet"),
                            (panel + "sun_size = 0.1\n", "missing key 'planet'"),
                            (table("force", "moon", "gravity_central", mu=4.9e12, bodies=[]), "'bodies' is empty"),
                            (table("sensor", "s", "euler", body="sat", relative_to="lvlh:sot"), "lvlh:sot")):
            self.write("bad.toml", SYSTEM.format(**base, more=more))
            self.assertIn(error, self.bough("check", "bad.toml", code=1).stderr)
        self.write("inside.toml", SYSTEM.format(**{**base, "x": "1e6"}, more=panel + 'planet = "earth"\n'))
        self.assertIn("run.inside-planet", self.bough("run", "inside.toml", "-o", "i.h5", code=3).stderr)
        attitude = table("sensor", "s", "euler", body="sat", relative_to="lvlh:sat")
        self.write("radial.toml", SYSTEM.format(**{**base, "speed": "0.0"}, more=attitude))
        self.fails(3, "run", "radial.toml", "-o", "r.h5", says=["along the radius"], error="run.no-orbit")
        # Without a dipole there is no field.
        magnetic = toml(table("sensor", "field", "magnetometer", body="sat"), table("function", "m", "constant", value=1.0),
                        table("actuator", "rod", "torque_rod", body="sat", axis=[1.0, 0.0, 0.0], input="m"))
        for dipole, count in (("0.0, 0.0, 0.0", 2), ("0.0, 0.0, 1.0", 0)):
            self.write("field.toml", SYSTEM.format(**{**base, "dipole": dipole}, more=magnetic))
            self.assertEqual(self.bough("check", "field.toml").stderr.count("system.no-magnetic-field"), count)
        moon = table("force", "moon", "gravity_central", mu=4.9e12, centre=[0.0, 4e8, 0.0])
        self.write("two.toml", SYSTEM.format(**base, more=moon + attitude))
        self.fails(1, "run", "two.toml", "-o", "t.h5", says=["2 [[force]]s of type gravity_central"], error="sensor.no-orbit")


if __name__ == "__main__":
    unittest.main()
