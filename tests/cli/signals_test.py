"""Functions out of files, wires, the block diagram, events on controllers, as a user meets them."""
import json
import os
import re
import shutil
import unittest
import xml.etree.ElementTree

import h5py
import numpy as np
import scipy.io
from scipy.interpolate import CubicSpline

from support import ProgramTest

CART = """
[[body]]
name = "cart"
mass = 2.0

[[hinge]]
name = "rail"
type = "prismatic"
child = "cart"
axis = [1.0, 0.0, 0.0]

[[function]]
name = "push"
type = "table"
file = "FILE"
COLUMNS
interpolation = "INTERPOLATION"

[[force]]
name = "hand"
body = "cart"
force = [1.0, 0.0, 0.0]
function = "push"

[simulation]
duration = 2.0
output_step = 0.1
integrator = "rk"
relative_tolerance = 1e-11
absolute_tolerance = 1e-13
"""

LOOP = """
name = 'the "loop" \\ of A'

[[body]]
name = "rotor <1>"
mass = 1.0
inertia = [1.0, 1.0, 2.0]

[[hinge]]
name = "axis"
type = "revolute"
child = "rotor <1>"

[[function]]
name = "target"
type = "doublet"
value = 0.5
at = 0.5
width = 1.0

[[sensor]]
name = "angle"
type = "hinge_angle"
hinge = "axis"

[[sensor]]
name = "rate"
type = "hinge_rate"
hinge = "axis"
sample_time = 0.01

[[controller]]
name = 'law "a\\b"'
type = "pid"
inputs = ["angle"]
reference = "target"
kp = 6.0

[[controller]]
name = "damper"
type = "gain"
gain = 1.0

[[controller]]
name = "command"
type = "sum"

[[actuator]]
name = "drive"
type = "hinge"
hinge = "axis"

[[connect]]
from = "rate"
to = "damper"
gain = -4.0

[[connect]]
from = 'law "a\\b"'
to = "command:1"

[[connect]]
from = "damper"
to = "command:2"

[[connect]]
from = "command"
to = "drive"

[[event]]
name = "let_go"
time = 1.0
action = "disable"
controller = 'law "a\\b"'

[simulation]
duration = 2.0
"""


class Functions(ProgramTest):
    t = np.linspace(0, 2, 21)
    f = np.sin(3 * t) + 0.2 * t

    def run_cart(self, file, columns, interpolation="cubic"):
        text = CART.replace("FILE", file).replace("COLUMNS", columns).replace("INTERPOLATION", interpolation)
        self.write("cart.toml", text)
        self.bough("run", "cart.toml", "-o", "cart.h5")
        with h5py.File(self.path("cart.h5")) as results:
            return results["hinges/rail/q"][:].ravel()

    def expected(self):
        # q(t) of q̈ = f / 2: the spline's own second integral.
        return CubicSpline(self.t, self.f).antiderivative(2)(np.linspace(0, 2, 21)) / 2

    def test_columns_of_csv_by_name_and_number(self):
        rows = [f"{a!r}; {b!r}; {c!r}" for a, b, c in zip(-self.t, self.f.tolist(), self.t.tolist())]
        self.write("wind.csv", '# measured\nminus; "push x"; time\n' + "\n".join(rows) + "\n")
        for columns in ('time_column = "time"\ncolumn = "push x"', 'time_column = "3"\ncolumn = "2"'):
            np.testing.assert_allclose(self.run_cart("wind.csv", columns), self.expected(), atol=1e-9)
        text = CART.replace("FILE", "wind.csv").replace("INTERPOLATION", "linear")
        self.write("bad.toml", text.replace("COLUMNS", 'time_column = "tme"\ncolumn = "2"'))
        self.fails(1, "check", "bad.toml", error="toml.table-file", says=["wind.csv:2: error", "did you mean 'time'?"])
        self.write("bad.toml", text.replace("COLUMNS", 'time_column = "3"\ncolumn = "4"'))
        self.fails(1, "check", "bad.toml", error="toml.table-file", says=["there is no column '4'"])
        self.write("bad.toml", text.replace("COLUMNS", ""))
        self.fails(1, "check", "bad.toml", error="toml.table-file", says=["the line has 3 numbers, expected 2"])

    def test_columns_of_matlab_and_hdf5_files(self):
        both = np.column_stack([self.f * 0, self.f])
        scipy.io.savemat(self.path("wind.mat"), {"time": self.t, "wind": both})
        with h5py.File(self.path("wind.h5"), "w") as file:
            file["time"], file["gusts/wind"] = self.t, both
        np.testing.assert_allclose(self.run_cart("wind.mat", 'time_column = "time"\ncolumn = "wind:2"'),
                                   self.expected(), atol=1e-9)
        np.testing.assert_allclose(self.run_cart("wind.h5", 'time_column = "/time"\ncolumn = "/gusts/wind:2"'),
                                   self.expected(), atol=1e-9)
        # The results of one run are the input of another.
        os.rename(self.path("cart.h5"), self.path("before.h5"))
        q = self.run_cart("before.h5", 'time_column = "/time"\ncolumn = "/hinges/rail/q:1"')
        spline = CubicSpline(np.linspace(0, 2, 21), self.expected())
        np.testing.assert_allclose(q, spline.antiderivative(2)(np.linspace(0, 2, 21)) / 2, atol=1e-9)
        text = CART.replace("INTERPOLATION", "linear")
        for columns, error, says in (('time_column = "time"\ncolumn = "wnd"', "function.bad-column", "did you mean 'wind'?"),
                                     ('time_column = "time"\ncolumn = "wind"', "function.bad-column", "has 2 columns"),
                                     ('column = "wind:2"', "toml.missing-key", "'time_column'")):
            self.write("bad.toml", text.replace("FILE", "wind.mat").replace("COLUMNS", columns))
            self.fails(1, "check", "bad.toml", error=error, says=[says])

    def test_a_changed_table_is_noticed_at_a_resume(self):
        self.write("wind.csv", "0 1\n2 1\n")
        self.run_cart("wind.csv", "", "linear")
        self.write("wind.csv", "0 1\n2 2\n")
        self.write("cart.toml", open(self.path("cart.toml")).read().replace("duration = 2.0", "duration = 3.0"))
        self.fails(1, "run", "cart.toml", "-o", "cart.h5", "--resume", error="cli.changed-input")

    def test_functions_of_functions(self):
        text = CART[:CART.index("[[function]]")] + """
[[function]]
name = "sway"
type = "expression"
expression = "0.1*t^3*exp(-t)"
rate = "0.1*(3*t^2 - t^3)*exp(-t)"
acceleration = "0.1*(6*t - 6*t^2 + t^3)*exp(-t)"

[simulation]
duration = 2.0
"""
        moved = text.replace('axis = [1.0', 'motion = ["sway"]\naxis = [1.0')
        self.write("sway.toml", moved)
        self.bough("run", "sway.toml", "-o", "sway.h5")
        with h5py.File(self.path("sway.h5")) as results:
            t = results["time"][:].ravel()
            np.testing.assert_allclose(results["hinges/rail/q"][:].ravel(), 0.1 * t**3 * np.exp(-t), atol=1e-12)
            force = results["hinges/rail/force"][:].ravel()
            np.testing.assert_allclose(force, 0.2 * (6 * t - 6 * t**2 + t**3) * np.exp(-t), atol=1e-9)
        self.write("bad.toml", re.sub(r"rate = .*\nacceleration = .*\n", "", moved))
        self.fails(1, "check", "bad.toml", error="system.motion-without-rate")
        loop = '[[function]]\nname = "a"\ntype = "sum"\nof = ["b"]\n[[function]]\nname = "b"\ntype = "product"\nof = ["a"]\n'
        self.write("bad.toml", text.replace("[simulation]", loop + "[simulation]"))
        self.fails(1, "check", "bad.toml", error="function.loop", says=["a of b of a"])


class Diagram(ProgramTest):
    def test_source_of_the_diagram(self):
        self.write("loop.toml", LOOP)
        self.bough("check", "loop.toml", "--diagram", "loop.dot")
        text = open(self.path("loop.dot"), encoding="utf-8").read()
        word = r'"((?:[^"\\]|\\.)*)"'
        nodes = set(re.findall(rf"^  {word} \[label=", text, re.M))
        edges = re.findall(rf"^  {word} -> {word}(?: \[(.*)\])?;$", text, re.M)
        plain = [(a.replace('\\"', '"').replace("\\\\", "\\"), b.replace('\\"', '"').replace("\\\\", "\\")) for a, b, _ in edges]
        law = 'controller law "a\\b"'
        for pair in ((("function target"), law), ("sensor angle", law), ("sensor rate", "controller damper"),
                     (law, "controller command"), ("controller damper", "controller command"),
                     ("controller command", "actuator drive"), ("actuator drive", "body rotor <1>"),
                     ("body rotor <1>", "sensor angle"), ("body ground", "body rotor <1>"), ("event let_go", law)):
            self.assertIn(pair, plain)
        # Every end of an edge is a node that is drawn.
        for a, b, _ in edges:
            self.assertIn(a, nodes)
            self.assertIn(b, nodes)
        self.assertEqual(len(plain), 11)
        self.assertIn("× -4", text)
        self.assertTrue(text.startswith('digraph "the \\"loop\\" \\\\ of A" {'), text[:60])
        self.assertIn("graphviz", self.fails(1, "check", "loop.toml", "--diagram", "loop.gif",
                                             error="cli.bad-diagram").stderr + "graphviz")
        self.fails(1, "check", self.write("deck.bdf", "ENDDATA\n"), "--diagram", "deck.dot", error="cli.bad-diagram")

    def test_picture_of_the_diagram(self):
        self.write("loop.toml", LOOP)
        if shutil.which("dot") is None:
            self.skipTest("dot (graphviz) is not installed")
        self.bough("check", "loop.toml", "--diagram", "loop.svg")
        root = xml.etree.ElementTree.parse(self.path("loop.svg")).getroot()
        texts = [t.text for t in root.iter("{http://www.w3.org/2000/svg}text")]
        for label in ("rotor <1>", 'law "a\\b"', "damper", "target", "let_go"):
            self.assertIn(label, texts)
        self.assertFalse([f for f in os.listdir(self.path(".")) if "part" in f])

    def test_without_graphviz(self):
        self.write("loop.toml", LOOP)
        result = self.bough("check", "loop.toml", "--diagram", "loop.svg", code=3, env={**os.environ, "PATH": "/nowhere"})
        self.assertIn("[cli.no-converter]", result.stderr)
        self.assertIn("install graphviz, or write .dot", result.stderr)


RELAY = """
[[body]]
name = "rotor"
mass = 1.0
inertia = [1.0, 1.0, 1.0]

[[hinge]]
name = "axis"
type = "revolute"
child = "rotor"
position = 1.0

[[sensor]]
name = "angle"
type = "hinge_angle"
hinge = "axis"

[[sensor]]
name = "rate"
type = "hinge_rate"
hinge = "axis"

[[controller]]
name = "line"
type = "gain"
inputs = ["angle", "rate"]
gain = [[1.0, 2.0]]

[[controller]]
name = "bang"
type = "relay"
inputs = ["line"]
on = 1e-5
off = -1e-5
value = -1.0
low = 1.0

[[actuator]]
name = "drive"
type = "hinge"
hinge = "axis"
input = "bang"

[simulation]
duration = 5.0
"""


class Runs(ProgramTest):
    def test_a_sliding_relay_is_told(self):
        self.write("slide.toml", RELAY)
        said = self.bough("run", "slide.toml", "-o", "slide.h5")
        self.assertEqual(said.stderr.count("[control.sliding]"), 1)
        self.assertIn("controller 'bang' has switched 500 times", said.stderr)
        self.assertIn("slide.toml:29: warning", said.stderr)
        self.write("calm.toml", RELAY.replace("1e-5", "1e-2"))
        self.assertNotIn("control.sliding", self.bough("run", "calm.toml", "-o", "calm.h5").stderr)

    def test_units_are_told(self):
        self.write("units.toml", RELAY.replace('type = "gain"', 'type = "sum"').replace("gain = [[1.0, 2.0]]\n", ""))
        said = self.bough("check", "units.toml")
        self.assertIn("[control.units]", said.stderr)
        self.assertIn("angle (1) and rate (1/T)", said.stderr)

    def test_a_resumed_run_says_so(self):
        self.write("calm.toml", RELAY.replace("1e-5", "1e-2"))
        self.bough("run", "calm.toml", "-o", "calm.h5")
        self.write("calm.toml", RELAY.replace("1e-5", "1e-2").replace("duration = 5.0", "duration = 6.0"))
        said = self.bough("run", "calm.toml", "-o", "calm.h5", "--resume")
        self.assertIn("resumed at t = 5, completed at t = 6", said.stdout)
        self.write("calm.toml", RELAY.replace("1e-5", "1e-2").replace("duration = 5.0", "duration = 7.0"))
        again = json.loads(self.bough("run", "calm.toml", "-o", "calm.h5", "--resume", "--json").stdout)
        self.assertEqual(again["resumed_from"], 6.0)
        self.assertIsNone(json.loads(self.bough("run", "calm.toml", "-o", "new.h5", "--json").stdout)["resumed_from"])

    def test_the_time_is_said_once(self):
        text = RELAY.replace('type = "relay"\ninputs = ["line"]\non = 1e-5\noff = -1e-5\nvalue = -1.0\nlow = 1.0\n',
                             'type = "expression"\ninputs = ["line"]\nexpression = "sqrt(2 - t) - u1"\n')
        self.write("root.toml", text)
        failed = self.bough("run", "root.toml", "-o", "root.h5", code=3)
        self.assertIn("[control.not-finite]", failed.stderr)
        self.assertEqual(failed.stderr.count(" at t = "), 1, failed.stderr)

    def test_an_event_resumes_bit_for_bit(self):
        text = LOOP.replace("duration = 2.0", 'duration = 2.0\nintegrator = "rk4"\nstep = 0.01\noutput_step = 0.05')
        self.write("loop.toml", text)
        self.bough("run", "loop.toml", "-o", "whole.h5")
        self.write("loop.toml", text.replace("duration = 2.0", "duration = 1.3"))
        self.bough("run", "loop.toml", "-o", "part.h5")
        self.write("loop.toml", text)
        self.bough("run", "loop.toml", "-o", "part.h5", "--resume")
        with h5py.File(self.path("part.h5")) as part, h5py.File(self.path("whole.h5")) as whole:
            for name in ("sensors/angle", "controllers/command"):
                np.testing.assert_array_equal(part[name][:], whole[name][:])


if __name__ == "__main__":
    unittest.main()
