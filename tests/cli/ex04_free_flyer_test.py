"""ex04-free-flyer: nothing acts from outside, so momenta and energy stay to 1e-9 while it tumbles and swings."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest


class FreeFlyer(ProgramTest):
    def test_momenta_and_energy_stay(self):
        self.copy_example("ex04-free-flyer")
        modes = json.loads(self.bough("modes", "flyer.bdf", "--json").stdout)
        self.assertEqual(modes["num_rigid_modes"], 6)
        self.bough("reduce", "flyer.toml")
        self.bough("run", "free-flyer.toml", "-o", "free-flyer.h5")
        with h5py.File(self.path("free-flyer.h5")) as f:
            t = f["/time"][:]
            energy = f["/energy/kinetic"][:].ravel() + f["/energy/strain"][:].ravel()
            linear, angular = f["/momentum/linear"][:], f["/momentum/angular"][:]
            eta, rate = f["/bodies/flyer/eta"][:], f["/sensors/rate"][:]
        self.assertAlmostEqual(t[-1], 5.0, places=9)
        self.assertLess(np.abs(energy / energy[0] - 1).max(), 1e-9)
        for momentum in (linear, angular):
            drift = np.linalg.norm(momentum - momentum[0], axis=1).max() / np.linalg.norm(momentum[0])
            self.assertLess(drift, 1e-9)
        # It does move: the modes swing and the rate of the frame changes with them.
        self.assertGreater(np.ptp(eta[:, 0]), 0.05)
        self.assertGreater(np.ptp(rate, axis=0).max(), 1e-3)


if __name__ == "__main__":
    unittest.main()
