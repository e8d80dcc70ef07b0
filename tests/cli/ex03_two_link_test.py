"""ex03-two-link: energy stays, and the path is that of a chain of rigid pieces on springs, an independent model."""
import json
import math
import unittest

import chain
import h5py
import numpy as np

from support import ProgramTest


class TwoLink(ProgramTest):
    def test_energy_and_path(self):
        self.copy_example("ex03-two-link")
        modes = json.loads(self.bough("modes", "link.bdf", "--json").stdout)
        EI, m = 7.0e10 * 1.06667e-10, 8.0e-5 * 2700
        self.assertAlmostEqual(2 * math.pi * modes["frequency_hz"][0], 3.5160153 * math.sqrt(EI / m), delta=2e-3)
        self.bough("reduce", "link.toml")
        self.bough("run", "two-link.toml", "-o", "two-link.h5")
        with h5py.File(self.path("two-link.h5")) as f:
            t = f["/time"][:]
            kinetic = f["/energy/kinetic"][:].ravel()
            total = kinetic + f["/energy/strain"][:].ravel() + f["/energy/potential"][:].ravel()
            elbow, tip = f["/sensors/elbow_position"][:], f["/sensors/tip_position"][:]
        self.assertAlmostEqual(t[-1], 3.0, places=9)
        self.assertLess(np.abs(total - total[0]).max() / kinetic.max(), 1e-9)
        first = t <= 1.0
        path = chain.simulate(16, 1.0, m, EI, 9.81, t[first])
        self.assertLess(np.linalg.norm(elbow[first, :2] - path[:, 0], axis=1).max(), 1e-3)
        self.assertLess(np.linalg.norm(tip[first, :2] - path[:, 1], axis=1).max(), 1e-3)
        self.assertLess(np.abs(tip[:, 2]).max(), 1e-12)


if __name__ == "__main__":
    unittest.main()
