"""Directional derivatives of exported FMUs: those of differences and of the linear model."""
import unittest

import h5py
import numpy as np

from embed_test import ARM
from fmu_case import CHAIN, DRIVEN, SLIDE, FmuCase
from fmu_importer import Failed


class FmuDerivativesTest(FmuCase):
    def test_directional_derivatives_are_those_of_differences(self):
        self.write("arm.toml", ARM)
        self.write("chain.toml", CHAIN)
        self.write("driven.toml", DRIVEN)
        for system in ["arm.toml", "chain.toml", "driven.toml", *self.prepare_examples("ex04", "ex07", "ex08", "ex10")]:
            with self.subTest(system=system):
                fmu = self.export(system, 3 if system.startswith("ex") else 2)
                instance, x, random = self.start_me(fmu)
                unknowns = fmu.list("output") + fmu.derivatives
                names = fmu.list("input")
                inputs = dict(zip(names, random.standard_normal(len(names))))
                t = float(fmu.root.find("DefaultExperiment").get("startTime"))
                instance.put(t, x)
                instance.set(names, list(inputs.values()))
                before = instance.get(unknowns)
                for _ in range(4):
                    dx, du = random.standard_normal(len(x)), random.standard_normal(len(names))
                    # Two steps, extrapolated: the error is of order 4.
                    first, _ = self.difference(instance, t, x, unknowns, dx, inputs, du, 2e-4)
                    second, _ = self.difference(instance, t, x, unknowns, dx, inputs, du, 1e-4)
                    expected = (4 * second - first) / 3
                    found = instance.directional(unknowns, fmu.states + names, [*dx, *du])
                    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
                # Nothing has moved; constraint forces are refined from those before, to rounding.
                np.testing.assert_allclose(instance.get(unknowns), before, rtol=1e-13, atol=1e-13 * np.abs(before).max())
                np.testing.assert_array_equal(instance.states(), x)

    def test_directional_derivatives_are_those_of_the_linear_model(self):
        self.write("chain.toml", CHAIN)
        self.bough("linearize", "chain.toml", "--inputs", "torque,target", "--outputs", "upper,rate,slow,shake,tip", "-o", "linear.h5")
        with h5py.File(self.path("linear.h5")) as f:
            linear = {name: f[name][:] for name in "ABCD"}
        outputs = ["upper", "rate", "slow", "shake:x", "shake:y", "shake:z", "tip:x", "tip:y", "tip:z"]
        for version in (2, 3):
            fmu = self.export("chain.toml", version)
            n = len(fmu.states) - 2  # without work and dissipated energy
            instance = self.make(fmu, "me")
            instance.initialize()
            instance.update_discrete()
            instance.call("EnterContinuousTimeMode")
            inputs = ["torque", "target"]
            for name, unknowns, knowns in (("A", fmu.derivatives[:n], fmu.states[:n]), ("B", fmu.derivatives[:n], inputs),
                                           ("C", outputs, fmu.states[:n]), ("D", outputs, inputs)):
                found = instance.jacobian(unknowns, knowns)
                np.testing.assert_allclose(found, linear[name], rtol=1e-8, atol=1e-8 * np.abs(linear[name]).max(), err_msg=name)
            one = self.make(fmu, "cs")
            one.initialize()
            np.testing.assert_allclose(one.jacobian(outputs, inputs), linear["D"], rtol=1e-8, atol=1e-8 * np.abs(linear["D"]).max())

    def test_directional_derivatives_of_a_linear_system_are_exact(self):
        self.write("slide.toml", SLIDE.replace('axis = [1.0, 0.0, 0.0]', 'axis = [1.0, 0.0, 0.0]\nstiffness = [8.0]\ndamping = [0.5]'))
        for version in (2, 3):
            fmu = self.export("slide.toml", version)
            q, u = fmu.states[:2]
            der = ["der(" + q + ")", "der(" + u + ")"]
            instance, x, _ = self.start_me(fmu)
            instance.put(0.0, x)
            np.testing.assert_allclose(instance.jacobian([*der, "x:x"], [q, u, "push"]), [[0, 1, 0], [-4, -0.25, 0.5], [1, 0, 0]],
                                       rtol=1e-9, atol=1e-12)
            np.testing.assert_allclose(instance.directional([der[1]], [q, u, "push", q], [1, 2, 4, 1]), [-8 - 0.5 + 2], rtol=1e-9)
            with self.assertRaisesRegex(Failed, "expected inputs and states"):
                instance.directional([der[1]], ["mass"], [1])
            with self.assertRaisesRegex(Failed, "expected outputs and derivatives"):
                instance.directional([q], [u], [1])
            with self.assertRaisesRegex(Failed, "finite"):
                instance.directional([der[1]], [u], [np.nan])
            # In the initialization parameters are known, and states are not.
            early = self.make(fmu, "cs")
            with self.assertRaises(Failed):
                early.directional([der[1]], ["push"], [1.0])
            early.enter_initialization()
            early.set(["push"], [3.0])
            found = early.jacobian([der[1], q, "x:x"], ["push", "mass"])
            np.testing.assert_allclose(found, [[0.5, -3 / 4], [0, 0], [0, 0]], rtol=1e-9, atol=1e-12)
            early.call("ExitInitializationMode")
            np.testing.assert_allclose(early.get([der[1], "push", "mass"]), [1.5, 3, 2], rtol=1e-12)
            np.testing.assert_allclose(early.directional(["x:x"], ["push"], [1.0]), [0], atol=1e-12)

    def test_directional_derivatives_hold_modes(self):
        """A joint that sticks keeps its place; one that slips does not."""
        stuck = SLIDE.replace('axis = [1.0, 0.0, 0.0]', 'axis = [1.0, 0.0, 0.0]\nfriction = {coulomb = 3.0}')
        for push, expected in ((1.0, 0), (5.0, 0.5)):
            self.write("slide.toml", stuck.replace("start = 1.0", f"start = {push}"))
            fmu = self.export("slide.toml", 3)
            instance = self.make(fmu, "me")
            instance.initialize()
            instance.update_discrete()
            instance.call("EnterContinuousTimeMode")
            np.testing.assert_allclose(instance.directional([fmu.derivatives[1]], ["push"], [1.0]), [expected], atol=1e-12)


if __name__ == "__main__":
    unittest.main()
