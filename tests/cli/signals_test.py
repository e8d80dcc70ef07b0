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
from toml_text import section, table, toml

CART = toml(
    table("body", "cart", mass=2.0),
    table("hinge", "rail", "prismatic", child="cart", axis=[1.0, 0.0, 0.0]),
    table("function", "push", "table", file="FILE", interpolation="INTERPOLATION"),
    "COLUMNS\n",
    table("force", "hand", body="cart", force=[1.0, 0.0, 0.0], function="push"),
    section("simulation", duration=2.0, output_step=0.1, integrator="rk", relative_tolerance=1e-11,
            absolute_tolerance=1e-13))

LOOP = toml(
    table("body", "rotor <1>", mass=1.0, inertia=[1.0, 1.0, 2.0]),
    table("hinge", "axis", "revolute", child="rotor <1>"),
    table("function", "target", "doublet", value=0.5, at=0.5, width=1.0),
    table("sensor", "angle", "hinge_angle", hinge="axis"),
    table("sensor", "rate", "hinge_rate", hinge="axis", sample_time=0.01),
    table("controller", 'law "a\\b"', "pid", inputs=["angle"], reference="target", kp=6.0),
    table("controller", "damper", "gain", gain=1.0),
    table("controller", "command", "sum"),
    table("actuator", "drive", "hinge", hinge="axis"),
    table("connect", from_="rate", to="damper", gain=-4.0),
    table("connect", from_='law "a\\b"', to="command:1"),
    table("connect", from_="damper", to="command:2"),
    table("connect", from_="command", to="drive"),
    table("event", "let_go", time=1.0, action="disable", controller='law "a\\b"'),
    section("simulation", duration=2.0),
    name='the "loop" \\ of A')


AXIS = toml(
    table("body", "cart", mass=1.5),
    table("hinge", "rail", "prismatic", child="cart", axis=[1.0, 0.0, 0.0], damping=2.0),
    table("sensor", "x", "hinge_angle", hinge="rail"),
    table("controller", "law", "pid", inputs="x"),
    "LAW\n",
    table("actuator", "drive", "hinge", hinge="rail", input="law"),
    section("simulation", duration=3.0, gravity=[-4.0, 0.0, 0.0]))


class BadFunctions(ProgramTest):
    """A function that failed is said once, whatever names it."""
    bad = {"sine": 'type = "sine"\namplitude = 1.0', "pulse": 'type = "pulse"\nvalue = 1.0\nat = 0.0\nwidth = -1.0',
           "expression": 'type = "expression"\nexpression = "t+*2"', "self": 'type = "sum"\nof = ["f"]'}
    users = {"controller": '[[controller]]\nname = "c"\ntype = "gain"\ngain = 1.0\ninputs = "f"',
             "actuator": '[[actuator]]\nname = "d"\ntype = "hinge"\nhinge = "rail"\ninput = "f"',
             "force": '[[force]]\nname = "p"\nbody = "cart"\nforce = [1.0, 0.0, 0.0]\nsignal = "f"',
             "connect": '[[actuator]]\nname = "d"\ntype = "hinge"\nhinge = "rail"\n[[connect]]\nfrom = "f"\nto = "d"'}

    def test_messages(self):
        text = AXIS.replace("LAW", "kp = 25.0")
        for function in self.bad.values():
            for user in self.users.values():
                self.write("bad.toml", text.replace("[simulation]", f'[[function]]\nname = "f"\n{function}\n\n{user}\n\n'
                                                    "[simulation]"))
                self.fails(1, "check", "bad.toml", says=["bad.toml:"])

    def test_a_missing_input_is_said_once(self):
        self.write("bad.toml", AXIS.replace("LAW", "kp = 25.0").replace("[simulation]", toml(
            table("controller", "c", "sum"), table("connect", from_="x", to="c:3"), "[simulation]")))
        said = self.fails(1, "check", "bad.toml", error="control.bad-connect", says=["has no input 1, and one after it"])
        self.assertNotIn("''", said.stderr)


class Rest(ProgramTest):
    def test_a_run_from_an_equilibrium_stays_there(self):
        """Integral states and what samples hold go with the state."""
        for law in ("kp = 25.0\nki = 10.0\nsetpoint = 0.3",
                    "kp = 25.0\nki = 10.0\nsetpoint = 0.3\nsample_time = 0.02\ndelay = 0.03"):
            self.write("axis.toml", AXIS.replace("LAW", law))
            found = json.loads(self.bough("equilibrium", "axis.toml", "--json").stdout)
            self.assertAlmostEqual(found["q"][0], 0.3, places=9)
            self.bough("equilibrium", "axis.toml", "-o", "rest.h5")
            run = self.bough("run", "axis.toml", "--start-from", "rest.h5", "-o", "still.h5")
            self.assertIn("start from the states in which they rest there", run.stderr)
            with h5py.File(self.path("still.h5")) as f:
                self.assertLess(np.abs(f["/hinges/rail/q"][:] - 0.3).max(), 1e-7)
                np.testing.assert_allclose(f["/controllers/law"][:].ravel(), 6.0, atol=1e-6)
                self.assertEqual(f["time"][0], 0)
            self.assertNotIn("linear.not-steady", self.bough("linearize", "axis.toml", "--start-from", "rest.h5").stderr)
        # Another law than the one of the file.
        self.write("other.toml", AXIS.replace("LAW", "kp = 25.0"))
        run = self.bough("run", "other.toml", "--start-from", "rest.h5", "-o", "moves.h5")
        self.assertIn("it has other controllers or actuators than this system", run.stderr)

    def test_a_cut_that_opens_nothing_is_said(self):
        text = AXIS.replace("LAW", "kp = 25.0").replace(
            "[[controller]]", table("sensor", "spare", "hinge_rate", hinge="rail") + "[[controller]]", 1)
        self.write("axis.toml", text)
        self.assertIn("[linear.nothing-cut]", self.bough("linearize", "axis.toml", "--break", "spare").stderr)
        self.assertNotIn("linear.nothing-cut", self.bough("linearize", "axis.toml", "--break", "x", "-o", "l.h5").stderr)

    def test_no_way_from_an_input_to_an_output_is_said(self):
        self.write("two.toml", AXIS.replace("LAW", "kp = 25.0").replace("[[sensor]]", toml(
            table("body", "other", mass=1.0),
            table("hinge", "aside", "prismatic", child="other", axis=[0.0, 1.0, 0.0], stiffness=5.0, damping=1.0),
            table("sensor", "y", "hinge_angle", hinge="aside"), "[[sensor]]"), 1))
        self.bough("linearize", "two.toml", "--outputs", "y", "-o", "l.h5")
        self.assertIn("no way leads from", self.bough("response", "l.h5").stdout)


class Slips(ProgramTest):
    """Slips in tables of signals that would pass silently: each is named."""
    def write_slip(self, old="", new="", more=""):
        text = toml(
            table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "h", "revolute", child="b", position=0.1),
            table("sensor", "a", "hinge_angle", hinge="h"),
            table("sensor", "v", "velocity", body="b"), more,
            table("controller", "pd", "pid", inputs=["a"], kp=3.0),
            table("actuator", "m", "hinge", hinge="h", input="pd"),
            section("simulation", duration=1.0))
        self.assertIn(old, text)
        self.write("slip.toml", text.replace(old, new) if old else text)

    def test_a_pid_without_gains(self):
        self.write_slip("kp = 3.0\n")
        self.fails(1, "run", "slip.toml", "-o", "s.h5", error="control.bad-value", says=["neither kp nor ki nor kd"])

    def test_a_name_that_is_a_component_of_another_signal(self):
        for name in ("v:z", "v:2"):
            self.write_slip(more=table("sensor", name, "hinge_rate", hinge="h"))
            self.fails(1, "run", "slip.toml", "-o", "s.h5", error="control.ambiguous-name", says=[f"/sensors/{name}"])
        self.write_slip(more=table("sensor", "v:speed", "hinge_rate", hinge="h"))
        self.bough("run", "slip.toml", "-o", "s.h5")

    def test_samples_without_number(self):
        self.write_slip("kp = 3.0\n", "kp = 3.0\nsample_time = 1e-9\n")
        self.fails(1, "run", "slip.toml", "-o", "s.h5", error="run.many-samples", says=["controller 'pd'", "1e+09 samples"])
        self.write_slip("kp = 3.0\n", "kp = 3.0\nsample_time = 5e-8\n")
        self.assertIn("[run.many-samples]", self.bough("check", "slip.toml").stderr)


class Kinks(ProgramTest):
    def test_the_balance_of_a_small_energy_under_a_force_with_corners(self):
        """A free mass under a triangle wave, all defaults: the motion is right, and so is its balance."""
        self.write("wave.toml", toml(
            table("body", "cart", mass=1.0),
            table("hinge", "rail", "prismatic", child="cart", axis=[1.0, 0.0, 0.0]),
            table("function", "f", "sawtooth", amplitude=0.4, frequency_hz=1.6, rise=0.5),
            table("force", "push", body="cart", force=[1.0, 0.0, 0.0], function="f"),
            section("simulation", duration=4.0)))
        with open(self.path("wave.toml")) as file:
            text = file.read()
        # The backward differences leave the rate itself 1e-3 of its energy.
        for integrator, share in (("adams", 1e-4), ("bdf", 1e-2)):
            self.write("w.toml", text + f'integrator = "{integrator}"\n')
            run = self.bough("run", "w.toml", "-o", "w.h5")
            if integrator == "adams":
                self.assertNotIn("run.energy", run.stderr)
            with h5py.File(self.path("w.h5")) as f:
                v, work = f["/hinges/rail/qdot"][:].ravel(), f["/energy/work"][:].ravel()
                self.assertLess(np.abs(work - v**2 / 2).max(), share * (v**2 / 2).max())


class DoubleGimbal(ProgramTest):
    def test_keeps_the_momentum(self):
        self.write("flyer.toml", toml(
            table("body", "craft", mass=5.0, inertia=[2.0, 3.0, 4.0]),
            table("function", "f", "sine", amplitude=0.4, frequency_hz=0.3),
            table("controller", "rates", "expression", inputs=["f"], expression=["u1", "0.2 - u1"]),
            table("actuator", "gimbals", "double_gimbal_cmg", body="craft", momentum=1.5, gimbal_axis=[0.0, 0.0, 1.0],
                  inner_axis=[1.0, 0.0, 0.0], spin_axis=[0.0, 1.0, 0.0], angle_deg=[10.0, -20.0], input="rates"),
            section("simulation", duration=3.0, integrator="rk")))
        self.bough("run", "flyer.toml", "-o", "flyer.h5")
        with h5py.File(self.path("flyer.h5")) as f:
            momentum = f["/momentum/angular"][:]
            self.assertLess(np.abs(momentum - momentum[0]).max(), 1e-7)
            np.testing.assert_allclose(f["/actuators/gimbals"][0, 2:4], np.radians([10.0, -20.0]), atol=1e-12)


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

    def test_headings_as_other_programs_write_them(self):
        t, f = self.t, self.f
        for separator in (",", ";", "\t"):
            head = separator.join(("time (s)", "rest", "thrust (N)"))
            rows = [separator.join(map(repr, (a, 0.0, b))) for a, b in zip(t.tolist(), f.tolist())]
            with open(self.path("wind.csv"), "w", encoding="utf-8-sig", newline="\r\n") as file:
                file.write(head + "\n" + "\n".join(rows) + "\n")
            found = self.run_cart("wind.csv", 'time_column = "time (s)"\ncolumn = "thrust (N)"')
            np.testing.assert_allclose(found, self.expected(), atol=1e-9)
        # Blanks that separate, and a comma beside them.
        self.write("wind.csv", "time, push rest\n" + "\n".join(f"{a!r} {b!r} 0" for a, b in zip(t.tolist(), f.tolist())))
        np.testing.assert_allclose(self.run_cart("wind.csv", 'time_column = "time"\ncolumn = "push"'),
                                   self.expected(), atol=1e-9)

    def test_decimal_commas_are_named(self):
        self.write("wind.csv", "t;a;b\n0,0;1,5;2,5\n2,0;1,0;2,0\n")
        self.write("bad.toml", CART.replace("FILE", "wind.csv").replace("INTERPOLATION", "linear")
                   .replace("COLUMNS", 'time_column = "t"\ncolumn = "b"'))
        said = self.fails(1, "check", "bad.toml", error="toml.table-file", says=["wind.csv:2: error", "decimal comma, '0,0'"])
        self.assertNotIn("no pair", said.stderr)

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
        text = CART[:CART.index("[[function]]")] + toml(
            table("function", "sway", "expression", expression="0.1*t^3*exp(-t)", rate="0.1*(3*t^2 - t^3)*exp(-t)",
                  acceleration="0.1*(6*t - 6*t^2 + t^3)*exp(-t)"),
            section("simulation", duration=2.0))
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
        loop = toml(table("function", "a", "sum", of=["b"]), table("function", "b", "product", of=["a"]))
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


RELAY = toml(
    table("body", "rotor", mass=1.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "axis", "revolute", child="rotor", position=1.0),
    table("sensor", "angle", "hinge_angle", hinge="axis"),
    table("sensor", "rate", "hinge_rate", hinge="axis"),
    table("controller", "line", "gain", inputs=["angle", "rate"], gain=[[1.0, 2.0]]),
    table("controller", "bang", "relay", inputs=["line"], on=1e-5, off=-1e-5, value=-1.0, low=1.0),
    table("actuator", "drive", "hinge", hinge="axis", input="bang"),
    section("simulation", duration=5.0))


class Runs(ProgramTest):
    def test_a_sliding_relay_is_told(self):
        self.write("slide.toml", RELAY)
        said = self.bough("run", "slide.toml", "-o", "slide.h5")
        self.assertEqual(said.stderr.count("[control.sliding]"), 1)
        self.assertIn("controller 'bang' has switched 500 times", said.stderr)
        self.assertIn("slide.toml:23: warning", said.stderr)
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
