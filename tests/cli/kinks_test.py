"""Linear models of systems with limits, tables, contacts, friction and stops, against hand derivatives."""
import json
import unittest

import h5py
import numpy as np
import scipy.interpolate
import scipy.optimize

from support import ProgramTest
from toml_text import Bare, section, table, toml

TABLE = table("function", "t", "table", x=Bare("{x}"), y=Bare("{y}"), interpolation="{kind}")

HUB = toml(
    table("body", "hub", mass=1.0, inertia=[500, 600, 1000]),
    table("hinge", "h", "revolute", child="hub"),
    table("sensor", "a", "hinge_angle", hinge="h"),
    "SENSOR\n",
    table("sensor", "w", "hinge_rate", hinge="h"),
    "SENSOR\n",
    table("controller", "law", "pid", inputs=["a"], rate="w", kp=160, kd=800),
    "LAW\n",
    table("actuator", "m", "wheel", input="law", body="hub", axis=[0, 0, 1], inertia=0.01, scale=-1.0, momentum=12.0),
    "ACTUATOR\n",
    section("simulation", duration=10))
SAMPLED = {"SENSOR": "sample_time = 0.1", "LAW": "sample_time = 0.1\ndelay = 0.05"}


class KinksTest(ProgramTest):
    def linearize(self, text, *arguments):
        self.write("case.toml", text)
        result = self.bough("linearize", "case.toml", *arguments, "-o", "case.h5")
        with h5py.File(self.path("case.h5")) as f:
            return {name: f[name][()] for name in ("A", "B", "C", "D", "accuracy/error")}, result.stderr

    def rail(self, mass=1.0, q=0.0, u=0.0, hinge="", more=""):
        model, said = self.linearize(toml(
            table("body", "b", mass=mass, inertia=[1.0, 1.0, 1.0], nodes=[{"id": 1, "position": [0.0, 0.0, 0.0]}]),
            table("hinge", "h", "prismatic", child="b", axis=[0.0, 0.0, 1.0], position=q, rate=u), hinge + "\n", more + "\n",
            section("simulation", duration=1.0)))
        return -mass * model["A"][1, 0], -mass * model["A"][1, 1], said, model

    def expect(self, found, stiffness, damping, quiet=True):
        k, c, said, model = found
        for value, exact in ((k, stiffness), (c, damping)):
            self.assertLessEqual(abs(value - exact), 1e-9 * abs(exact) + 1e-13 * abs(stiffness), (value, exact))
        self.assertEqual("[linear.inaccurate]" in said, not quiet, said)
        self.assertLess(model["accuracy/error"], 1e-6)


class Slopes(KinksTest):
    """Laws in other units of length and force: the slope of the law is exact in all."""
    def test_tables(self):
        for length in (1e-6, 1e-3, 1.0, 1e3):
            for force in (1e-6, 1.0, 1e6):
                x = np.array([-1, -0.1, 0, 0.1, 1]) * length
                y = np.array([-1, -0.01, 0, 0.01, 1]) * force
                spline = scipy.interpolate.CubicSpline(x, y, bc_type="not-a-knot")
                for at in (0.1, 0.03, -0.999, 0.0999999):
                    q = float(at * length)
                    lines = (0.1 if abs(at) < 0.1 else 1.1) * force / length
                    for kind, slope in (("cubic", float(spline(q, 1))), ("linear", lines)):
                        if kind == "linear" and at == 0.1:
                            continue  # a kink
                        table = TABLE.format(x=x.tolist(), y=y.tolist(), kind=kind)
                        self.expect(self.rail(mass=1e-3, q=q, hinge=f'stiffness = {3.0 * force / length}\n'
                                              'spring_table = "t"', more=table), slope + 3 * force / length, 0)

    def test_past_the_end_of_a_table_the_force_is_constant(self):
        table = TABLE.format(x=[-1e-3, 1e-3], y=[-5.0, 5.0], kind="linear")
        self.expect(self.rail(q=1.0001e-3, hinge='spring_table = "t"\nstiffness = 7.0', more=table), 7.0, 0)

    def test_contact(self):
        for stiffness, depth, damping in ((1e8, 1e-4, 0.1), (1e8, 1e-7, 3.0), (1e3, 0.05, 0.0), (1e14, 1e-9, 0.5)):
            law = (f'[[force]]\nname = "c"\ntype = "contact"\nshape = "plane"\nnormal = [0, 0, 1]\nbody = "b"\n'
                   f'node = 1\nradius = 0.1\nstiffness = {stiffness}\ndamping = {damping}\n')
            real = 0.1 - (0.1 - depth)  # of the position as rounded
            self.expect(self.rail(mass=2.0, q=0.1 - depth, more=law), 1.5 * stiffness * real**0.5,
                        damping * stiffness * real**1.5)
            self.expect(self.rail(mass=2.0, q=0.1 + depth, hinge="stiffness = 5.0", more=law), 5.0, 0)

    def test_friction(self):
        for smoothing in (1e-9, 1e-4, 0.1, 1e5):
            for ratio in (0.0, 0.5, 3.0):
                hinge = f"stiffness = 4.0\nfriction = {{ coulomb = 0.05, smoothing = {smoothing} }}"
                self.expect(self.rail(u=ratio * smoothing, hinge=hinge), 4.0, 0.05 / smoothing / np.cosh(ratio)**2)

    def test_stops(self):
        for reach in (1e-8, 1e-3, 1.0):
            hinge = (f"stiffness = 2.0\nstops = {{ lower = {-reach}, upper = {reach}, stiffness = 1e6, damping = 0.2 }}")
            self.expect(self.rail(q=0.999999 * reach, hinge=hinge), 2.0, 0)
            past = 1.1 * reach - reach
            self.expect(self.rail(q=1.1 * reach, hinge=hinge), 2.0 + 1e6, 0.2e6 * past)

    def test_cable(self):
        for length in (1e-3, 1.0):
            for share, taut in ((0.99999, False), (1.00001, True)):
                law = ('[[force]]\nname = "cable"\ntype = "spring"\nbody = "b"\nnode = 1\nstiffness = 1e5\n'
                       f'free_length = {length}\ntension_only = true\ndamping = 2.0\n')
                self.expect(self.rail(q=share * length, hinge="stiffness = 3.0", more=law),
                            3.0 + (1e5 if taut else 0), 2.0 if taut else 0)


class Kinks(KinksTest):
    def test_are_named_with_both_slopes(self):
        spring = TABLE.format(x=[-1.0, 0.2, 1.0], y=[0.0, 0.0, 40.0], kind="linear")
        stop = "stiffness = 2.0\nstops = { upper = 0.2, stiffness = 100.0 }"
        cable = table("force", "cable", "spring", body="b", node=1, stiffness=10.0, free_length=0.3, tension_only=True)
        law = toml(
            table("sensor", "s", "hinge_angle", hinge="h"),
            table("controller", "law", inputs=["s"]),
            "{0}\n",
            table("actuator", "m", "hinge", hinge="h", input="law", scale=-1.0))
        for hinge, more, q, name, at, below, above in (
                ('spring_table = "t"', spring, 0.2, "hinge coordinate 'h:1'", 0.2, "-?0", "-50"),
                (stop, "", 0.2, "hinge coordinate 'h:1'", 0.2, "-?0", "-100"),
                ("", cable, 0.3, "force 'cable'", 0.3, "0", "10"),
                ("", law.format('type = "limit"\nupper = 0.5'), 0.5, "controller 'law'", 0.5, "1", "0"),
                ("", law.format('type = "limit"\ndeadband = 0.5'), 0.5, "controller 'law'", 0.5, "0", "1"),
                ("", law.format('type = "expression"\nexpression = "3 * min(u, 0.25)"'), 0.25, "controller 'law'", 0.25,
                 "3", "0"),
                ("", law.format('type = "table"\nx = [0.0, 1.0, 2.0]\ny = [0.0, 1.0, 4.0]'), 1.0, "controller 'law'", 1,
                 "1", "3")):
            k, _, said, model = self.rail(q=q, hinge=hinge, more=more)
            self.assertRegex(said, rf"{name} has a kink at {at}, with slope {below} below and {above} above")
            plain = 2.0 if "stops" in hinge else 0.0
            mean = plain + abs(float(below.replace("?", "")) + float(above)) / 2
            self.assertAlmostEqual(k, mean, delta=1e-6 * mean)
            self.assertGreater(model["accuracy/error"], 0.1)

    def test_that_no_output_sees_are_none(self):
        more = toml(
            table("sensor", "s", "hinge_angle", hinge="h"),
            table("controller", "law", "limit", upper=0.5, inputs=["s"]))
        _, _, said, _ = self.rail(q=0.5, more=more)
        self.assertNotIn("linear.inaccurate", said)

    def test_every_way_to_a_linear_model_tells(self):
        """A command at its limit: continuous and sampled, cut and closed, along a run, by response."""
        for more, options in (({}, ()), ({}, ("--break", "m")), ({}, ("--sweep", "kp=160:170:2")),
                              (SAMPLED, ()), (SAMPLED, ("--break", "law")), (SAMPLED, ("--break", "m"))):
            text = HUB
            for key in ("SENSOR", "LAW", "ACTUATOR"):
                text = text.replace(key, {**{"ACTUATOR": "upper = 80.0"}, **more}.get(key, ""))
            text = text.replace('child = "hub"', 'child = "hub"\nposition = 0.5')
            if "--sweep" in options:
                text = "[parameters]\nkp = 160.0\n" + text.replace("kp = 160", 'kp = "$kp"')
            self.write("at.toml", text)
            result = self.bough("linearize", "at.toml", *options, "-o", "at.h5")
            self.assertIn("[linear.inaccurate]", result.stderr, options)
            self.assertIn("actuator 'm' has a kink at 80", result.stderr, options)
            if "--break" in options:
                self.assertIn("[linear.inaccurate]", self.bough("response", "at.h5").stderr)


class LimitsThatAreNotReached(KinksTest):
    def hub(self, sampled, law="", actuator=""):
        text = HUB
        for key in ("SENSOR", "LAW", "ACTUATOR"):
            text = text.replace(key, SAMPLED.get(key, "") if sampled else "", )
        return text.replace("kd = 800\n", "kd = 800\n" + law + "\n").replace('input = "law"\n', 'input = "law"\n' + actuator + "\n")

    def test_change_nothing(self):
        for sampled in (False, True):
            for options in ((), ("--break", "law"), ("--break", "m")):
                plain, _ = self.linearize(self.hub(sampled), *options)
                for limits in ({"law": "lower = -0.2\nupper = 0.2"}, {"law": "lower = -1e-6\nupper = 1e-7"},
                               {"actuator": "upper = 20.0"}, {"actuator": "upper = 1e-5"}):
                    model, said = self.linearize(self.hub(sampled, **limits), *options)
                    self.assertNotIn("linear.inaccurate", said)
                    for name in "ABCD":
                        size = np.abs(plain[name]).max(initial=0)
                        np.testing.assert_allclose(model[name], plain[name], atol=1e-9 * size, err_msg=str((options, limits)))

    def test_margins_are_those_of_a_discretization_by_hand(self):
        """The command of the sample at kT acts from kT + delay to (k + 1) T + delay, on 1/(J s^2)."""
        T, delay, J, kp, kd = 0.1, 0.05, 1000.0, 160.0, 800.0

        def loop(omega):
            z = np.exp(1j * omega * T)
            flow = lambda h: np.array([[1, h], [0, 1]])
            push = lambda h: np.array([h * h / 2, h]) / J
            early = flow(T - delay) @ push(delay)  # of the command before
            late = push(T - delay)
            x = np.linalg.solve(z * np.eye(2) - flow(T), late + early / z)
            return kp * x[0] + kd * x[1]
        cross = scipy.optimize.brentq(lambda w: abs(loop(w)) - 1, 0.1, 5)
        phase = np.degrees(np.angle(loop(cross))) + 180
        turn = scipy.optimize.brentq(lambda w: loop(w).imag, 10, 25)
        for limits in ({}, {"law": "lower = -0.2\nupper = 0.2"}, {"actuator": "upper = 20.0"}):
            for cut in ("law", "m"):
                self.write("cut.toml", self.hub(True, **limits))
                self.bough("linearize", "cut.toml", "--break", cut, "-o", "cut.h5")
                margins = json.loads(self.bough("response", "cut.h5", "--json").stdout)["margins"]
                self.assertTrue(margins["stable"])
                self.assertEqual(len(margins["phase"]), 1)
                self.assertAlmostEqual(margins["phase"][0]["degrees"], phase, places=6)
                self.assertAlmostEqual(min(g["factor"] for g in margins["gain"]), -1 / loop(turn).real, places=6)


if __name__ == "__main__":
    unittest.main()
