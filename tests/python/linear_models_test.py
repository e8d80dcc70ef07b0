"""Linear models in Python: into SciPy, and with uncertain parameters."""
import unittest
import warnings

import numpy as np

import bough
from module_test import EXPRESSION, PENDULUM, InFolder
from toml_text import section, table, toml


class LinearModels(InFolder):
    def test_into_scipy(self):
        from scipy import signal
        system = bough.System.from_text(PENDULUM.format(law=EXPRESSION).replace("gravity = [0.0, 0.0, -9.81]", ""))
        model = system.linearize(open=True)
        inertia = 0.17 + 2 * 0.25
        w = np.array([0.1, 1.0, 10.0])
        plant = signal.StateSpace(model.A, model.B, model.C[:1], model.D[:1])
        _, response = signal.freqresp(plant, w)
        np.testing.assert_allclose(response, -1 / (inertia * w**2), rtol=1e-9)
        closed = system.linearize()
        expected = np.roots([inertia, 3, 40])
        for pole in expected:
            self.assertLess(np.abs(closed.poles - pole).min(), 1e-6)
        M, D, K, F, Z = model.second_order
        np.testing.assert_allclose(M, [[inertia]], rtol=1e-12)
        np.testing.assert_allclose(F, M @ model.B[1:2], rtol=1e-12)
        self.assertEqual(Z.shape[0], 1)
        closed.save("closed.h5")
        np.testing.assert_array_equal(bough.read_linear_model("closed.h5").A, closed.A)
        self.assertEqual(model.outputs[0].split(":")[0], "angle")

    def test_uncertain_parameters(self):
        """An oscillator: the model closed at each value has its poles."""
        text = toml(
            section("parameters", k=50.0, c=1.0),
            table("body", "bob", mass=2.0),
            table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0], stiffness=["$k"], damping=["$c"]),
            section("simulation", duration=1.0, output_step=0.1))
        system = bough.System.from_text(text)
        model = system.linearize(inputs=["slide"], uncertain={"k": (30, 90), "c": (0, 4)})
        self.assertEqual(model.uncertainty, [("k", 30, 90, 1), ("c", 0, 4, 1)])
        self.assertEqual(model.inputs, ["k:w1", "c:w1", "slide:1"])
        for delta in ([0, 0], [-0.5, 1], np.array([1, -0.2])):
            expected = np.roots([2.0, 2 + 2 * delta[1], 60 + 30 * delta[0]])
            for pole in expected:
                self.assertLess(np.abs(model.close(delta).poles - pole).min(), 1e-9)
        with self.assertRaisesRegex(ValueError, "expected 2 values, found 1"):
            model.close([0.5])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            model.close([1.0, -1.0])
            self.assertEqual(caught, [])
            model.close([0.0, 3.0])
        self.assertIn("delta of c is 3, outside [-1, 1]", str(caught[0].message))
        self.assertIn("beyond the range 0 to 4", str(caught[0].message))
        with self.assertRaises(bough.InputError):
            system.linearize(uncertain={"other": (1, 2)})


if __name__ == "__main__":
    unittest.main()
