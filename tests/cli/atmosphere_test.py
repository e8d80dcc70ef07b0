"""Atmosphere by a table of altitudes: closed form, the exponential one as a table, files, the ends of the table, units."""
import math
import unittest

import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

MU, EARTH = 3.986004418e14, 6.378137e6
ALTITUDES = [100e3, 200e3, 300e3, 450e3, 600e3]
DENSITIES = [5.6e-7, 2.5e-10, 1.9e-11, 1.6e-12, 1.1e-13]


def make_system(height, speed, drag, functions="", duration=600.0, rate=0.0):
    return toml(
        table("body", "sat", mass=100.0, inertia=[10.0, 10.0, 10.0]),
        table("hinge", "orbit", "free", child="sat", position=[1.0, 0.0, 0.0, 0.0, EARTH + height, 0.0, 0.0],
              rate=[0.0, 0.0, 0.0, rate, speed, 0.0]),
        table("force", "earth", "gravity_central", mu=MU, radius=EARTH),
        functions,
        table("force", "air", "drag", body="sat", area=4.0, coefficient=2.2, planet="earth", **drag),
        section("simulation", duration=duration, output_step=duration / 50, integrator="rk", relative_tolerance=1e-12,
                absolute_tolerance=1e-10))


def make_table(x=ALTITUDES, y=DENSITIES, **more):
    return table("function", "density", "table", x=x, y=y, **more)


TABLE = {"density_table": "density"}


class Atmosphere(ProgramTest):
    def run_system(self, name, *arguments, **keys):
        self.write(f"{name}.toml", make_system(*arguments, **keys))
        done = self.bough("run", f"{name}.toml", "-o", f"{name}.h5")
        return self.read_arrays(f"{name}.h5", "/forces/air/force", "/bodies/sat/position", "/bodies/sat/velocity"), done.stderr

    def test_the_logarithm_of_the_density_is_linear(self):
        for height in (100e3, 163e3, 300e3, 517e3):
            (force, _, _), messages = self.run_system("s", height, 7000.0, TABLE, make_table(), duration=1e-3)
            i = min(np.searchsorted(ALTITUDES, height, side="right"), len(ALTITUDES) - 1) - 1
            share = (height - ALTITUDES[i]) / (ALTITUDES[i + 1] - ALTITUDES[i])
            density = DENSITIES[i]**(1 - share) * DENSITIES[i + 1]**share
            self.assertAlmostEqual(force[0, 1] / (-0.5 * density * 2.2 * 4.0 * 7000.0**2), 1, delta=1e-12)
            self.assertEqual("outside-atmosphere" in messages, height == 100e3)  # it falls below the first altitude

    def test_an_exponential_atmosphere_is_a_table(self):
        """Two points or two hundred: the same exponential, hence the same decay."""
        speed = math.sqrt(MU / (EARTH + 250e3))
        exponential = {"density": 5e-9, "scale_height": 60e3, "altitude": 200e3}
        (_, expected, velocity), _ = self.run_system("e", 250e3, speed, exponential, duration=6000.0)
        (_, free, _), _ = self.run_system("f", 250e3, speed, {**exponential, "density": 0.0}, duration=6000.0)
        self.assertGreater(np.abs(free - expected).max(), 1e4)
        for count in (2, 200):
            x = np.linspace(100e3, 300e3, count)
            y = 5e-9 * np.exp(-(x - 200e3) / 60e3)
            (_, p, v), messages = self.run_system("t", 250e3, speed, TABLE, make_table(x.tolist(), y.tolist()),
                                                  duration=6000.0)
            np.testing.assert_allclose(p, expected, rtol=0, atol=1e-3)
            np.testing.assert_allclose(v, velocity, rtol=0, atol=1e-6)
            self.assertNotIn("outside-atmosphere", messages)

    def test_a_file_is_the_same_table(self):
        self.write("air.csv", "altitude,density\n" + "".join(f"{h},{rho}\n" for h, rho in zip(ALTITUDES, DENSITIES)))
        inline, _ = self.run_system("i", 400e3, 7600.0, TABLE, make_table())
        of_file, _ = self.run_system("c", 400e3, 7600.0, TABLE, table("function", "density", "table", file="air.csv"))
        for a, b in zip(inline, of_file):
            np.testing.assert_array_equal(a, b)

    def test_outside_the_table_its_ends_go_on_and_the_range_is_named(self):
        (force, p, v), messages = self.run_system("u", 590e3, 7600.0, TABLE, make_table(), rate=1000.0, duration=30.0)
        self.assertEqual(messages.count("[run.outside-atmosphere]"), 1)
        self.assertRegex(messages, r"force 'air' is at an altitude of 6\d+, and its density_table is from 100000 to 600000")
        height = np.linalg.norm(p[-1]) - EARTH
        self.assertGreater(height, 610e3)
        density = 1.6e-12 * (1.1e-13 / 1.6e-12)**((height - 450e3) / 150e3)
        expected = -0.5 * density * 2.2 * 4.0 * np.linalg.norm(v[-1]) * v[-1]
        np.testing.assert_allclose(force[-1], expected, rtol=1e-9)

    def test_units_are_converted_and_the_motion_stays(self):
        self.run_system("m", 180e3, 7600.0, TABLE, make_table())
        self.bough("convert", "m.toml", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.toml")
        self.bough("run", "mm.toml", "-o", "mm.h5", "-q")
        (a,), (b,) = self.read_arrays("m.h5", "/forces/air/force"), self.read_arrays("mm.h5", "/forces/air/force")
        np.testing.assert_allclose(b, a, rtol=1e-6, atol=1e-9)

    def test_what_is_no_atmosphere_is_named(self):
        exponential = {"density": 1e-12, "scale_height": 6e4}
        for drag, function, error in (
                ({"density_table": "densty"}, make_table(), "did you mean 'density'"),
                ({**TABLE, **exponential}, make_table(), "toml.conflicting-keys"),
                ({"scale_height": 6e4}, "", "missing key 'density'"),
                ({**TABLE, "planet": ""}, make_table(), "density_table or spin and no planet"),
                (TABLE, make_table(y=[*DENSITIES[:-1], 0.0]), "a density that is not above zero"),
                (TABLE, make_table(interpolation="cubic"), "which is cubic"),
                (TABLE, table("function", "density", "constant", value=1.0), "system.not-a-table")):
            text = make_system(300e3, 7600.0, {key: value for key, value in drag.items() if key != "planet"}, function)
            self.write("bad.toml", text.replace('planet = "earth"\n', "") if "planet" in drag else text)
            self.assertIn(error, self.bough("check", "bad.toml", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
