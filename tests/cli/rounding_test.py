"""Linear models with entries that are round-off, kinks of inputs, and paths that vary."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

SPIN = toml(
    section("parameters", kp=40.0, m=5.0),
    table("body", "hub", mass=40.0, inertia=[30.0, 30.0, 60.0]),
    table("body", "tip", mass="$m", cg=[0.1, 0.0, 0.05], inertia=[0.1, 0.2, 0.3]),
    table("hinge", "sh", "revolute", child="hub"),
    table("hinge", "wrist", "revolute", parent="hub", parent_position=[10.0, 0.3, 0.2], child="tip", stiffness=30.0,
          damping=0.3),
    table("sensor", "a", "hinge_angle", hinge="sh"),
    table("sensor", "acc", "accelerometer", body="tip"),
    table("controller", "hold", "pid", inputs=["a"], kp="$kp", kd=10.0, filter=0.1),
    table("actuator", "mot", "hinge", hinge="sh", input="hold"),
    table("actuator", "w", "hinge", hinge="wrist"))
TANK = toml(
    table("tank", "tk", body="tip", type="cylinder", mass=2.0, radius=0.2, height=1.0, density=100.0, position=[0.1, 0.0, 0.0]),
    table("actuator", "jet", "engine", body="tip", axis=[0.0, 1.0, 0.0], exhaust_velocity=1000.0, tank="tk"))
RUN = section("simulation", duration=1.0)


class RoundingTest(ProgramTest):
    def linearize(self, text, *options):
        self.write("case.toml", text)
        result = self.bough("linearize", "case.toml", *options, "-o", "case.h5")
        with h5py.File(self.path("case.h5")) as f:
            found = {name: f[name][()] for name in "ABCD"}
            found["error"] = float(f["accuracy/error"][()].ravel()[0])
            found["outputs"] = [name.decode() for name in f["outputs/name"][()]]
        return found, result.stderr

    def test_an_accelerometer_on_the_axis_of_a_moment(self):
        """A moment about x turns a free body whose centre of mass is on x: no acceleration at its origin."""
        found, messages = self.linearize(toml(
            table("body", "a", mass=1.0, cg=[0.3, 0.0, 0.0], inertia=[0.1, 0.1, 0.1]), table("hinge", "h", "free", child="a"),
            table("actuator", "w", "moment", body="a", axis=[1.0, 0.0, 0.0]), table("sensor", "acc", "accelerometer", body="a"),
            section("simulation", duration=1.0, gravity=[0.0, 0.0, -9.81])))
        self.assertNotIn("linear.inaccurate", messages)
        self.assertLess(found["error"], 1e-9)
        np.testing.assert_array_equal(found["D"], np.zeros((3, 1)))
        self.assertAlmostEqual(np.abs(found["B"]).max(), 10.0, delta=1e-9)

    def test_the_bicycle(self):
        """Steering does not accelerate the rear contact; at rest the rates of the path are round-off."""
        self.copy_example("ex15-bicycle")
        bicycle = self.read("bicycle.toml")
        for speed in (0, 4.6):
            messages = self.bough("linearize", "bicycle.toml", "--set", f"speed={speed}", "-o", "m.h5").stderr
            self.assertNotIn("linear.inaccurate", messages)
        found, messages = self.linearize(bicycle + table("actuator", "st", "hinge", hinge="steer") +
                                     table("sensor", "acc", "accelerometer", body="frame"))
        self.assertNotIn("linear.inaccurate", messages)
        self.assertLess(found["error"], 1e-9)

    def test_a_kink_of_an_input_leaves_parameters_their_effect(self):
        """An engine at rest pushes one way only: its column has a kink, and the effect of kp is found all the same."""
        found, messages = self.linearize(SPIN + TANK + RUN, "--uncertain", "kp=30:60")
        self.assertIn("input 'jet' has a kink at 0", messages)
        for kp in (30, 60):
            direct, _ = self.linearize(SPIN + TANK + RUN, "--set", f"kp={kp}")
            delta = (kp - 45) / 15
            num_w = found["B"].shape[1] - direct["B"].shape[1]
            self.assertEqual(num_w, 1)
            loop = np.eye(num_w) - found["D"][:num_w, :num_w] * delta
            A = found["A"] + found["B"][:, :num_w] @ (delta * np.linalg.solve(loop, found["C"][:num_w]))
            np.testing.assert_allclose(A, direct["A"], atol=1e-9 * np.abs(direct["A"]).max())

    def test_a_mass_with_an_accelerometer(self):
        """Components of an acceleration that are round-off of the others are 0, and do not decide what is affine."""
        self.copy_example("ex02-hub")
        self.bough("reduce", "boom.toml", "-o", "boom.h5", "-q")
        text = SPIN.replace('parent = "hub"\nparent_position = [10.0, 0.3, 0.2]', 'parent = "boom"\nparent_node = 41')
        text += toml(table("body", "boom", file="boom.h5", damping=0.005),
                     table("hinge", "root", "fixed", parent="hub", child="boom"))
        found, _ = self.linearize(text + RUN, "--inputs", "mot,w", "--outputs", "acc:x", "--uncertain", "m=3:8")
        np.testing.assert_array_equal(found["C"][-1], np.zeros(found["C"].shape[1]))
        np.testing.assert_array_equal(found["D"][-1], np.zeros(found["D"].shape[1]))

    def test_the_path_of_a_steady_turn(self):
        """A disc rolls in a circle: A of its lean is constant, the rates of its place turn with the heading."""
        disc = toml(
            table("body", "w", mass=2.0, inertia=[0.05, 0.08, 0.05]),
            table("hinge", "h", "general", child="w", rotations="zxy", translations="xyz",
                  position=[0.0, -0.2, 0.0, 0.0, 0.05960079923851838, 0.34401997335237244],
                  rate=[1.0, 0.0, 3.818174431659115, 1.27295478770107, 0.0, 0.0]),
            table("constraint", "c", "rolling", child="w", axis=[0.0, 0.0, 1.0], axis2=[0.0, 1.0, 0.0], radius=0.3, crown=0.05))
        end = section("simulation", duration=2.0, gravity=[0.0, 0.0, -9.81])
        _, messages = self.linearize(disc + table("sensor", "pos", "position", body="w") + end)
        self.assertIn("[linear.time-varying]", messages)
        self.assertIn("the row of path coordinate h:4 in A, on which pos:x depends, changes along the motion", messages)
        _, messages = self.linearize(disc + table("sensor", "lean", "hinge_angle", hinge="h", coordinate=2) + end)
        self.assertNotIn("linear.time-varying", messages)

    def test_a_value_and_a_range_of_one_parameter(self):
        self.write("case.toml", SPIN + RUN)
        for option in (["--sweep", "m=1:2:2"], ["--uncertain", "m=1:2"]):
            self.fails(2, "linearize", "case.toml", *option, "--set", "m=3", error="cli.set-and-range",
                       says=[f"--set m=3 and {option[0]} m give one parameter"])
            self.bough("linearize", "case.toml", *option, "--set", "kp=3", "-o", "m.h5")


if __name__ == "__main__":
    unittest.main()
