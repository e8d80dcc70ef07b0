"""ex13-observatory: the line of sight of rigid-body rotations, the budget against NumPy, a run against the budget."""
import json
import math
import unittest

import numpy as np

from support import ProgramTest

FORCE, SECOND, COUPLE = 7.2e-6, 1.1e-6, 2.9e-7
INPUTS = "fx,fy,mx,my,cooler,noise_x,noise_y"


class Observatory(ProgramTest):
    EXAMPLE = "ex13-observatory", "telescope.toml"

    def setUp(self):
        super().setUp()
        self.bough("linearize", "observatory.toml", "--inputs", INPUTS, "--outputs", "sight", "-o", "linear.h5")
        self.A, self.B, self.C, self.D, states, inputs, imag = self.read_arrays(
            "linear.h5", "A", "B", "C", "D", "states/name", "inputs/name", "poles/imag")
        self.states, self.inputs = ([name.decode() for name in names] for names in (states, inputs))
        self.poles = imag

    def gain(self, omega, name):
        b = self.inputs.index(name)
        return self.C @ np.linalg.solve(1j * omega * np.eye(len(self.A)) - self.A, self.B[:, b]) + self.D[:, b]

    def calc_wheel(self, speed):
        """RMS at one speed [rad/s]: both harmonics turn with the wheel."""
        total = np.zeros(2)
        for number, force, couple in ((1, FORCE, COUPLE), (2, SECOND, 0)):
            y = speed**2 * (force * (self.gain(number * speed, "fx") - 1j * self.gain(number * speed, "fy"))
                            + couple * (self.gain(number * speed, "mx") - 1j * self.gain(number * speed, "my")))
            total += abs(y)**2 / 2
        return np.sqrt(total)

    def test_the_image_turns_with_the_whole(self):
        columns = [self.states.index(f"flight:{name}") for name in ("rx", "ry", "rz", "x", "y", "z")]
        np.testing.assert_allclose(self.C[:, columns], np.eye(2, 6), atol=1e-8)

    def test_budget(self):
        found = json.loads(self.bough("response", "linear.h5", "--budget", "jitter.toml", "--json").stdout)
        total = found["tables"][0]
        wheel, cooler = total["rows"][0], total["rows"][1]
        rpm = np.linspace(300, 3600, 331)
        rms = np.array([self.calc_wheel(x * math.pi / 30) for x in rpm])
        np.testing.assert_allclose(np.transpose(wheel["over_speed"]), rms, rtol=1e-8)
        # The worst speeds meet a bending mode, with the wheel or its second harmonic.
        bending = self.poles[self.poles > 2 * math.pi]
        for worst in wheel["worst_rpm"]:
            tones = np.array([1, 2]) * worst * math.pi / 30
            self.assertLess(abs(bending[:, None] / tones - 1).min(), 0.02)
        square = sum(abs(amplitude * self.gain(2 * math.pi * f, "cooler"))**2 / 2 for f, amplitude in ((45, 0.2), (90, 0.05)))
        np.testing.assert_allclose(cooler["rms"], np.sqrt(square), rtol=1e-8, atol=1e-20)
        jitter = next(t for t in found["tables"] if t["weighting"] == "jitter" and t["exposure"] == 0.5)
        drift = next(t for t in found["tables"] if t["weighting"] == "drift" and t["exposure"] == 30)
        # The star tracker moves the mean of exposures, the machines move the image within them.
        self.assertGreater(jitter["rows"][0]["rms"][0], jitter["rows"][2]["rms"][0])
        self.assertGreater(drift["rows"][2]["rms"][0], drift["rows"][0]["rms"][0])

    def test_a_run_has_the_rms_of_the_budget(self):
        self.bough("run", "observatory.toml", "-o", "run.h5")
        t, sight = self.read_arrays("run.h5", "time", "sensors/sight")
        # Harmonics by least squares, next to the rest of the start, a slow motion of the attitude loop.
        t = t.ravel() - t.mean()
        psi = 150.0 * t
        columns = np.column_stack([np.cos(psi), np.sin(psi), np.cos(2 * psi), np.sin(2 * psi), np.ones_like(t), t, t**2, t**3])
        found = np.linalg.lstsq(columns, sight, rcond=None)[0][:4]
        np.testing.assert_allclose(np.sqrt((found**2).sum(axis=0) / 2), self.calc_wheel(150.0), rtol=0.01)


if __name__ == "__main__":
    unittest.main()
