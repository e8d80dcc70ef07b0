"""ex10-robot-arm: the parallelogram stays one, the tool reaches its place, torques are those of statics, poles those of
the history."""
import json
import unittest

import h5py
import numpy as np

from ex08_satellite_test import fit_poles
from support import ProgramTest


class RobotArm(ProgramTest):
    def test_tool_loop_torques_and_poles(self):
        self.copy_example("ex10-robot-arm")
        self.bough("reduce", "arm.toml")
        self.bough("run", "robot.toml", "-o", "robot.h5")
        with h5py.File(self.path("robot.h5")) as f:
            time = f["time"][:].ravel()
            shoulder, elbow = f["hinges/shoulder/q"][:].ravel(), f["hinges/elbow/q"][:].ravel()
            crank = f["hinges/drive/q"][:].ravel()
            tool = f["sensors/tool"][:]
            torques = [f["actuators/" + name][-1].item() for name in ("shoulder_motor", "drive_motor")]
            total = (f["energy/kinetic"][:].ravel() + f["energy/strain"][:].ravel()
                     + f["energy/potential"][:].ravel() - f["energy/work"][:].ravel())
        # A parallelogram but for the arm's bending: the forearm stands as the crank does.
        self.assertLess(np.abs(shoulder + elbow - crank).max(), 1e-3)
        self.assertLess(np.abs(total - total[0]).max(), 1e-7 * np.abs(total).max())
        # The integral terms leave nothing of the angles' errors; the tool is where the links say, less the bending.
        np.testing.assert_allclose([shoulder[-1], crank[-1]], np.radians([30, -40]), atol=5e-4)
        links = [0.8 * np.cos(shoulder[-1]) + 0.6 * np.cos(crank[-1]),
                 0.8 * np.sin(shoulder[-1]) + 0.6 * np.sin(crank[-1])]
        self.assertLess(np.hypot(*(tool[-1, :2] - links)), 5e-4)
        # Virtual work: arm 1.00224 kg at 0.4 m, forearm 2 kg at 0.25 m beyond the elbow, crank 0.4 kg, rod 0.3 kg.
        statics = [9.81 * np.cos(shoulder[-1]) * (1.00224 * 0.4 + 2.0 * 0.8 + 0.3 * 0.4),
                   9.81 * np.cos(crank[-1]) * (2.0 * 0.25 - 0.4 * 0.1 - 0.3 * 0.2)]
        np.testing.assert_allclose(torques, statics, rtol=2e-3)

        self.bough("linearize", "robot.toml", "--at", 6, "-o", "poles.h5")
        with h5py.File(self.path("poles.h5")) as f:
            poles = f["poles/real"][:].ravel() + 1j * f["poles/imag"][:].ravel()
        self.assertLess(poles.real.max(), 0)
        slow = sorted(poles, key=abs)[:2]
        self.assertEqual([p.imag for p in slow], [0, 0])
        for history, near in ((shoulder, 1.14), (crank, 1.116)):
            pole = min(slow, key=lambda p: abs(p + near)).real
            found = fit_poles(np.diff(history[time > 2.5][::4]), 0.04, 3)
            self.assertLess(np.abs(found / pole - 1).min(), 1e-3, (found, slow))

        self.bough("linearize", "robot.toml", "--at", 6, "--break", "shoulder_motor", "-o", "loop.h5")
        margins = json.loads(self.bough("response", "loop.h5", "--json").stdout)["margins"]
        self.assertTrue(margins["stable"])
        self.assertGreater(margins["phase"][0]["degrees"], 30)


if __name__ == "__main__":
    unittest.main()
