"""Bodies in a central field: what falls freely reads nothing, booms bend in the tide, and the origin of a body is
nobody's business."""
import json
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import Bare, section, toml

N, L, E, I, AREA, RHO = 40, 1.0, 1e3, 2.022267351e-10, 1e-3, 1.0
MU, RADIUS = 8e8, 2e4
RATE = math.sqrt(MU / RADIUS**3)

DECK = f"""SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
PARAM,COUPMASS,1
EIGRL,1,,,10
MAT1,1,{E},,0.,{RHO}
PBAR,1,1,{AREA},{I},{I},1.-6
SPC1,1,123456,1
SPC1,1,4,1,THRU,{N + 1}
""" + "".join(f"GRID,{k + 1},,{k * L / N},0.,0.\n" for k in range(N + 1)) + "".join(
    f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,1.,0.\n" for k in range(N)) + "ENDDATA\n"

BODY = toml(
    section("body", name="boom", deck="boom.bdf", origin=[Bare("{origin}"), 0.0, 0.0]),
    section("body.modes", number=6),
    section("body.output", nodes=[1, Bare("{tip}")], recover="all", file="{file}"))

SYSTEM = """[[body]]
name = "hub"
mass = 1e6
inertia = [1e6, 1e6, 1e6]
nodes = [{{ id = 1, position = [1.0, 0.0, 0.0] }}]
[[body]]
name = "boom"
file = "{file}"
recover = true
{body}
[[hinge]]
name = "orbit"
type = "free"
child = "hub"
position = [1.0, 0.0, 0.0, 0.0, {radius}, 0.0, 0.0]
rate = [0.0, 0.0, {rate}, 0.0, {speed}, 0.0]
[[hinge]]
name = "root"
type = "fixed"
parent = "hub"
child = "boom"
child_node = 1
{force}
[[sensor]]
name = "centre"
type = "accelerometer"
body = "hub"
[[sensor]]
name = "out"
type = "accelerometer"
body = "hub"
node = 1
[[sensor]]
name = "tip"
type = "accelerometer"
body = "boom"
node = {tip}
[simulation]
duration = 10.0
output_step = 1.0
integrator = "rk"
relative_tolerance = 1e-11
absolute_tolerance = 1e-14
"""
FIELD = f'[[force]]\nname = "earth"\ntype = "gravity_central"\nmu = {MU}\n'


def find_bending():
    """First frequencies in and across the plane of the orbit of a cantilever that points outward and turns with it: by
    polynomials, with the tension 3n² ρA (L² - x²)/2 of the tide and the centrifugal field together. In the plane the
    field across is -n² and the turning frame's +n², across it -n² alone."""
    x, weights = np.polynomial.legendre.leggauss(40)
    x, weights = 0.5 * L * (x + 1), 0.5 * L * weights
    powers = range(2, 12)
    w = np.array([(x / L)**p for p in powers])
    slope = np.array([p * (x / L)**(p - 1) / L for p in powers])
    bend = np.array([p * (p - 1) * (x / L)**(p - 2) / L**2 for p in powers])
    mass = (w * (RHO * AREA * weights)) @ w.T
    tension = 1.5 * RATE**2 * RHO * AREA * (L**2 - x**2)
    stiffness = (bend * (E * I * weights)) @ bend.T + (slope * (tension * weights)) @ slope.T
    least = min(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
    return math.sqrt(least), math.sqrt(least + RATE**2)


class Orbit(ProgramTest):
    def make_system(self, origin=0.0, body="", force=FIELD, **more):
        file = f"boom-{origin}.h5"
        self.write("boom.bdf", DECK)
        self.write("boom.toml", BODY.format(origin=origin, file=file, tip=N + 1))
        self.bough("reduce", "boom.toml", "-q")
        text = SYSTEM.format(**{"file": file, "body": body, "force": force, "tip": N + 1, "radius": RADIUS,
                                "rate": RATE, "speed": RATE * RADIUS, **more})
        return self.write(f"orbit-{origin}.toml", text)

    def test_the_tide_on_a_boom_does_not_depend_on_its_origin(self):
        expected = find_bending()
        for origin in (0.0, 0.5, 1.0, -3.0):
            said = json.loads(self.bough("linearize", self.make_system(origin), "-o", "l.h5", "--json").stdout)
            with h5py.File(self.path("l.h5")) as f:
                poles = np.hypot(f["poles/real"][:].ravel(), f["poles/imag"][:].ravel())
            for value in expected:
                self.assertLess(np.abs(poles - value).min(), 3e-5 * value, (origin, value, poles[:20], said.keys()))

    def test_what_falls_reads_the_tide_alone(self):
        self.bough("run", self.make_system(), "-o", "run.h5", "-q")
        pull = 1.5 * RATE**2 * RHO * AREA * L**2
        with h5py.File(self.path("run.h5")) as f:
            # The mass centre is 5e-10 beside the origin of the hub.
            self.assertLess(np.abs(f["sensors/centre"][:]).max(), 1e-12)
            # Bodies that turn with the orbit: 3n² outward, n² less than that of the turning frame.
            out = f["sensors/out"][0]
            np.testing.assert_allclose(out, [-3 * RATE**2 * (1 - 1 / RADIUS), 0, 0], atol=2e-3 * 3 * RATE**2)
            # Forces in elements are those that the hinge passes on, which needs what hangs on it.
            reaction = f["hinges/root/reaction_force"][:, 0]
            np.testing.assert_allclose(reaction, -pull, rtol=2e-3)
            first = f["bodies/boom/recovery/CBAR/1"][:]
            self.assertIn("axial", str(f["bodies/boom/recovery/CBAR/1"].attrs["description"]).split(",")[0])
            np.testing.assert_allclose(first[:, 0], -reaction, rtol=2e-3)
            for e in (1, N // 2, N):
                x = (e - 0.5) / N
                axial = f[f"bodies/boom/recovery/CBAR/{e}"][:, 0]
                np.testing.assert_allclose(axial, pull * (1 - x * x), atol=2e-3 * pull)

    def test_recovery_is_that_of_the_same_acceleration(self):
        """Far out a central field is uniform: rows and modes as with `gravity`."""
        rows = []
        for force, more in ((f'[[force]]\nname = "earth"\ntype = "gravity_central"\nmu = 1e20\n', ""),
                            ("", "gravity = [-1e-4, 0.0, 0.0]\n")):
            system = self.make_system(force=force, radius=1e12, rate=0.0, speed=0.0)
            with open(self.path(system)) as f:
                text = f.read()
            text = text.replace('name = "orbit"\ntype = "free"',
                                'name = "orbit"\ntype = "revolute"\naxis = [0.0, 0.0, 1.0]\nlocked = true')
            text = "\n".join(line for line in text.split("\n") if not line.startswith(("position = [1.0", "rate = [0.0")))
            text = text.replace('child = "hub"', 'child = "hub"\nparent_position = [1e12, 0.0, 0.0]') + more
            self.write("held.toml", text)
            self.bough("run", "held.toml", "-o", "held.h5", "-q")
            with h5py.File(self.path("held.h5")) as f:
                rows.append(f["bodies/boom/recovery/CBAR/1"][:])
                acceleration = f["sensors/centre"][:]
            np.testing.assert_allclose(acceleration, np.tile([1e-4, 0, 0], (11, 1)), rtol=1e-6, atol=1e-12)
        self.assertGreater(np.abs(rows[1]).max(), 1e-8)
        np.testing.assert_allclose(rows[0], rows[1], rtol=1e-6, atol=1e-9 * np.abs(rows[1]).max())


if __name__ == "__main__":
    unittest.main()
