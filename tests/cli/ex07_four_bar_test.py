"""ex07-four-bar: the loop closes at the start and stays closed, the energy stays."""
import unittest

import h5py
import numpy as np

from support import ProgramTest


class FourBar(ProgramTest):
    def test_loop_and_energy(self):
        self.copy_example("ex07-four-bar")
        self.bough("reduce", "coupler.toml")
        done = self.bough("run", "four-bar.toml", "-o", "four-bar.h5")
        self.assertIn("3 of its 5 directions twice", done.stdout + done.stderr)
        with h5py.File(self.path("four-bar.h5")) as f:
            kinetic = f["/energy/kinetic"][:].ravel()
            total = kinetic + f["/energy/strain"][:].ravel() + f["/energy/potential"][:].ravel()
            rocker, crank = np.ravel(f["/hinges/pivot/q"]), np.ravel(f["/hinges/shaft/q"])
            bending = f["/sensors/bending"][:]
        self.assertLess(np.abs(total - total[0]).max() / kinetic.max(), 1e-9)
        # At the start the coupler is straight.
        self.assertAlmostEqual(abs(1 + 0.8 * np.exp(1j * rocker[0]) - 0.3 * np.exp(1j * crank[0])), 1, places=11)
        self.assertAlmostEqual(crank[0], np.pi / 3, places=14)
        self.assertGreater(np.abs(bending[:, 1]).max(), 1e-4)


if __name__ == "__main__":
    unittest.main()
