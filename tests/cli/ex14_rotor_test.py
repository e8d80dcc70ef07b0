"""ex14-rotor: critical speeds, onset of instability and response to unbalance are those of dense matrices of Nelson's beam."""
import json
import unittest

import h5py
import numpy as np
from scipy.optimize import brentq

from support import ProgramTest
from rotors import RPM, make_friswell, solve, springs

BEARINGS = [(place, *springs(1e6, 0.8e6, c=400.0)) for place in (0, 1.5)]


class RotorExample(ProgramTest):
    def test_numbers(self):
        self.copy_example("ex14-rotor")
        rotor = make_friswell(12, BEARINGS, ((0.5, 0.28), (1.0, 0.35)))

        def poles(speed):  # without overdamped motions, which creep around with the shaft
            found = solve(*rotor.matrices(speed, 1e-4 * rotor.K_shaft))
            return found[np.abs(found) < 3000]

        result = json.loads(self.bough("modes", "speeds.bdf", "--json").stdout)["rotors"]
        campbell = result["campbell"]
        for k, speed in enumerate(campbell["speed"]):
            np.testing.assert_allclose(np.sort(campbell["imag"][k])[:6], poles(speed).imag[:6], rtol=2e-5)
        critical = [brentq(lambda s, k=k: poles(s).imag[k] - s, 1, 8000 * RPM) for k in range(5)]
        found = [p["speed"] for p in result["critical_speeds"]]
        np.testing.assert_allclose(found, critical, rtol=2e-5)
        threshold = brentq(lambda s: poles(s).real.max(), 5000 * RPM, 6500 * RPM)
        self.assertAlmostEqual(result["thresholds"][0]["speed"], threshold, delta=2e-4 * threshold)
        self.assertGreater(result["thresholds"][0]["whirl"], 0.5)
        self.bough("frequency", "unbalance.bdf", "-o", "unbalance.h5")
        with h5py.File(self.path("unbalance.h5")) as f:
            hz, group = f["subcases/1/frequency_hz"][:], f["subcases/1/displacement"]
            i = group["dofs"][:].tolist().index([9, 2])
            y = group["real"][:, i] + 1j * group["imag"][:, i]
        at = 4 * rotor.find(1.0)
        for k in range(0, len(hz), 20):
            omega = 2 * np.pi * hz[k]
            M, B, K = rotor.matrices(omega, 1e-4 * rotor.K_shaft)
            force = np.zeros(len(M), complex)
            force[at:at + 2] = 2e-4 * omega**2 * np.array([1, -1j]) * np.exp(1j * np.pi / 6)
            u = np.linalg.solve(K + 1j * omega * B - omega**2 * M, force)
            self.assertLess(abs(y[k] - u[at]), 1e-3 * abs(u[at]))


if __name__ == "__main__":
    unittest.main()
