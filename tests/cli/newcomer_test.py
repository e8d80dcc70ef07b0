"""What a new user meets first: angles in degrees by mistake, files under other names."""
import os
import re
import unittest

import h5py
import numpy as np

from support import ProgramTest

# A rigid body turns about z at 0.1 rad/s for 1 s.
YAW = """[[body]]
name = "hub"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[hinge]]
name = "z"
type = "%s"
child = "hub"
%s
[[sensor]]
name = "attitude"
type = "euler"
body = "hub"
[simulation]
duration = 1.0
output_step = 0.5
"""
TURNING = YAW % ("revolute", "axis = [0.0, 0.0, 1.0]\nrate = 0.1")


class Slips(ProgramTest):
    def test_degrees_where_radians_are_meant(self):
        for keys, warns in (("position = 90.0", True), ("position_deg = 90.0", False), ("position = 6.28", False),
                            ("position = -7.0", True), ("null_position = 45.0", True),
                            ("parent_rotation = [0.0, 0.0, 90.0]", True), ("stops = {upper = 90.0, stiffness = 1.0}", True),
                            ("rate = 90.0", False)):
            with self.subTest(keys):
                self.write("yaw.toml", YAW % ("revolute", "axis = [0.0, 0.0, 1.0]\n" + keys))
                said = self.bough("check", "yaw.toml").stderr
                self.assertEqual("[toml.large-angle]" in said, warns, said)
                if warns:
                    self.assertIn(f"write {re.search('(position|null_position|parent_rotation|upper)', keys).group(1)}_deg", said)
        self.write("slide.toml", YAW % ("prismatic", "axis = [0.0, 0.0, 1.0]\nposition = 90.0"))
        self.assertNotIn("toml.large-angle", self.bough("check", "slide.toml").stderr)
        self.write("tilted.toml", TURNING.replace('type = "euler"', 'type = "euler"\nrotation = [90.0, 0.0, 0.0]'))
        self.assertIn("[toml.large-angle]", self.bough("check", "tilted.toml").stderr)


class Files(ProgramTest):
    def test_a_flx_is_told_by_its_content(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        self.bough("flx", "boom.h5", "--stiffening", "--digits", 17, "-o", "boom.FLX")
        os.rename(self.path("boom.FLX"), self.path("problem.FLN"))
        os.rename(self.path("boom.h5"), self.path("body.FLX"))     # HDF5 under the other name
        with open(self.path("spinup.toml")) as f:
            text = f.read().replace("duration = 20.0", "duration = 1.0")
        self.bough("check", "problem.FLN")
        histories = []
        for name in ("problem.FLN", "body.FLX"):
            self.bough("info", name)
            self.write("short.toml", text.replace('"boom.h5"', f'"{name}"'))
            self.bough("run", "short.toml", "-o", "short.h5")
            with h5py.File(self.path("short.h5")) as f:
                histories.append(f["/sensors/tip_deflection"][:])
        np.testing.assert_allclose(histories[0], histories[1], atol=1e-9 * np.abs(histories[1]).max())


if __name__ == "__main__":
    unittest.main()
