"""ex10-robot-arm: the parallelogram stays one, the tool reaches its place."""
import unittest

import h5py
import numpy as np

from support import ProgramTest


class RobotArm(ProgramTest):
    def test_tool_and_loop(self):
        self.copy_example("ex10-robot-arm")
        self.bough("reduce", "arm.toml")
        self.bough("run", "robot.toml", "-o", "robot.h5")
        with h5py.File(self.path("robot.h5")) as f:
            time = f["time"][:].ravel()
            shoulder, elbow = f["hinges/shoulder/q"][:].ravel(), f["hinges/elbow/q"][:].ravel()
            crank = f["hinges/drive/q"][:].ravel()
            tool = f["sensors/tool"][:]
            kinetic = f["energy/kinetic"][:].ravel()
            total = (kinetic + f["energy/strain"][:].ravel() + f["energy/potential"][:].ravel()
                     - f["energy/work"][:].ravel())
        # A parallelogram but for the arm's bending: the forearm stands as the crank does.
        self.assertLess(np.abs(shoulder + elbow - crank).max(), 0.01)
        self.assertLess(np.abs(total - total[0]).max(), 1e-7 * np.abs(total).max())
        # The integral terms leave nothing of the angles' errors; the tool is where the links say, less the bending.
        np.testing.assert_allclose([shoulder[-1], crank[-1]], np.radians([30, 40]), atol=2e-3)
        links = [0.8 * np.cos(shoulder[-1]) + 0.6 * np.cos(crank[-1]), 0.8 * np.sin(shoulder[-1]) + 0.6 * np.sin(crank[-1])]
        self.assertLess(np.hypot(*(tool[-1, :2] - links)), 5e-3)
        self.assertLess(np.abs(tool[time > 5.5, :2] - tool[-1, :2]).max(), 2e-3)


if __name__ == "__main__":
    unittest.main()
