"""Control of a system in the studio: poles with other parameters, their shapes in motion, block diagram,
functions; by requests, against NumPy and the command line."""
import json
import re
import unittest

import h5py
import numpy as np

from report_test import unpack
from studio_support import StudioTest
from toml_text import section, table, toml

# Two sliders on springs, one on the other; a controller with a gain pushes the first.
SYSTEM = toml(
    section("parameters", gain=5.0),
    table("body", "a", mass=2.0, inertia=[1.0, 1.0, 1.0]),
    table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "first", "prismatic", child="a", axis=[1.0, 0.0, 0.0], stiffness=[300.0]),
    table("hinge", "second", "prismatic", parent="a", child="b", axis=[1.0, 0.0, 0.0], stiffness=[100.0]),
    table("function", "wave", "sine", amplitude=2.0, frequency_hz=0.5),
    table("function", "jump", "step", value=3.0, at=0.7),
    table("function", "curve", "table", x=[0.0, 1.0, 3.0], y=[0.0, 2.0, -1.0]),
    table("sensor", "place", "hinge_angle", hinge="first"),
    table("controller", "pid", "pid", inputs=["place"], reference="wave", kp="$gain", ki=0.0, kd=0.0),
    table("actuator", "motor", "hinge", hinge="first", input="pid"),
    section("simulation", duration=2.0, output_step=0.01),
    name="sliders")


class Control(StudioTest):
    def setUp(self):
        super().setUp()
        self.write("sliders.toml", SYSTEM)
        self.start_studio("sliders.toml")

    def ask_text(self, what, **more):
        return self.ask(what, file="sliders.toml", text=SYSTEM, **more)

    def test_poles(self):
        """Poles with another gain are those of `linearize --set`, and of M and K."""
        poles = json.loads(self.ask_text("poles", set=["gain=50"])["chapter"]["data"])["poles"]
        self.bough("linearize", "sliders.toml", "--set", "gain=50", "-o", "linear.h5")
        with h5py.File(self.path("linear.h5")) as f:
            np.testing.assert_allclose(poles["imag"], f["/poles/imag"][:], rtol=1e-12)
        # u: rates of a against the ground, of b against a
        M, K = np.array([[3.0, 1.0], [1.0, 1.0]]), np.diag([300.0 + 50.0, 100.0])
        omega = np.sqrt(np.linalg.eigvals(np.linalg.solve(M, K)).real)
        np.testing.assert_allclose(sorted(set(np.abs(np.round(poles["imag"], 9)))), sorted(np.round(omega, 9)), rtol=1e-9)
        self.assertEqual(poles["index"], list(range(4)))
        self.refuses("toml.unknown-parameter", "poles", file="sliders.toml", text=SYSTEM, set=["other=1"])

    def test_shape_of_a_pole(self):
        """Both bodies move in the eigenvector, over one period."""
        poles = json.loads(self.ask_text("poles")["chapter"]["data"])["poles"]
        M, K = np.array([[3.0, 1.0], [1.0, 1.0]]), np.diag([305.0, 100.0])
        values, vectors = np.linalg.eig(np.linalg.solve(M, K))
        for k in range(4):
            run = json.loads(self.ask_text("pole-motion", pole=k)["chapter"]["data"])
            count = 65
            x = {c["path"]: unpack(c["columns"][0], count) for c in run["channels"] if c["path"].endswith("/position")}
            a, b = x["/bodies/a/position"], x["/bodies/b/position"]
            omega = abs(poles["imag"][k])
            own = vectors[:, np.argmin(np.abs(values - omega**2))]
            # Position of b is the sum of both travels.
            expected = (own[0] + own[1]) / own[0]
            largest = np.argmax(np.abs(a))
            self.assertAlmostEqual(b[largest] / a[largest], expected, delta=1e-5 * abs(expected))
            self.assertGreater(np.ptp(a), 1e-3)
            # A harmonic of one period: the samples of a circle.
            phase = 2 * np.pi * np.arange(count) / 64
            fit = np.column_stack([np.cos(phase), np.sin(phase)])
            rest = a - fit @ np.linalg.lstsq(fit, a, rcond=None)[0]
            self.assertLess(np.abs(rest).max(), 1e-6 * np.abs(a).max())
            time = run["time"]
            self.assertAlmostEqual((count - 1) * time["step"], 2 * np.pi / omega, delta=1e-6 * 2 * np.pi / omega)
        self.refuses("linear.no-pole", "pole-motion", file="sliders.toml", text=SYSTEM, pole=9)

    def test_diagram(self):
        """Blocks with their lines, and the edges of `check --diagram`."""
        answer = self.ask_text("diagram")
        lines = SYSTEM.split("\n")
        for node in answer["nodes"]:
            if node["name"] == "ground":
                continue
            self.assertEqual(lines[node["line"] - 1], f"[[{node['kind']}]]")
            self.assertEqual(lines[node["line"]], f'name = "{node["name"]}"')
        self.bough("check", "sliders.toml", "--diagram", "sliders.dot")
        edges = re.findall(r'^  "(.*)" -> "(.*?)"', self.read("sliders.dot"), re.MULTILINE)
        self.assertEqual(sorted((e["from"], e["to"]) for e in answer["edges"]), sorted(edges))
        self.assertIn(("sensor place", "controller pid"), edges)
        self.assertIn(("controller pid", "actuator motor"), edges)
        self.assertIn(("body ground", "body a"), edges)

    def test_functions(self):
        curves = {f["name"]: f for f in self.ask_text("diagram")["functions"]}
        wave = curves["wave"]
        np.testing.assert_allclose(wave["y"], 2 * np.sin(np.pi * np.array(wave["x"])), atol=1e-12)
        self.assertEqual((wave["x"][0], wave["x"][-1], wave["of_time"]), (0, 2, True))
        # At the jump a point on each side.
        x, y = np.array(curves["jump"]["x"]), np.array(curves["jump"]["y"])
        at = int(np.flatnonzero(x == 0.7)[0])
        self.assertEqual((y[at - 1], y[at]), (0, 3))
        self.assertLess(x[at] - x[at - 1], 1e-12)
        table = curves["curve"]
        self.assertFalse(table["of_time"])
        np.testing.assert_allclose(table["y"], np.interp(table["x"], [0, 1, 3], [0, 2, -1]), atol=1e-12)
        self.assertIn(3.0, table["x"])


if __name__ == "__main__":
    unittest.main()
