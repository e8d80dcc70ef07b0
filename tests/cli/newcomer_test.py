"""What a new user meets first: names of components, angles in degrees by mistake, files under other names."""
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
LAW = """[[controller]]
name = "law"
type = "pid"
inputs = ["%s"]
kp = 1.0
[[actuator]]
name = "motor"
type = "hinge"
hinge = "z"
input = "law"
"""
EVENT = '[[event]]\nname = "turned"\nsignal = "%s"\nvalue = 0.05\n'

class Components(ProgramTest):
    def test_euler_angles_are_named_by_their_order(self):
        self.write("yaw.toml", TURNING)
        self.bough("run", "yaw.toml", "-o", "yaw.h5")
        for name in ("attitude:angle1", "attitude:1"):
            self.bough("export", "yaw.h5", "--to", "csv", "--channel", name, "-o", "a.csv")
            with open(self.path("a.csv")) as f:
                lines = [line for line in f.read().splitlines() if not line.startswith("#")]
            self.assertIn("attitude:angle1", lines[0])
            self.assertAlmostEqual(float(lines[-1].split(",")[1]), 0.1, places=9)   # of sequence 321 the first is about z
        for name in ("attitude:x", "attitude:z"):
            for call in (("plot", "yaw.h5", "--sensor", name, "--csv", "p.csv"),
                         ("export", "yaw.h5", "--to", "csv", "--channel", name, "-o", "b.csv"),
                         ("report", "yaw.h5", "--channel", name, "-o", "r.html")):
                self.fails(1, *call, says=["angle1", "angle2", "angle3"], error="cli.unknown-channel")
        self.bough("report", "yaw.h5", "-o", "r.html")
        with open(self.path("r.html")) as f:
            page = f.read()
        self.assertIn("attitude:angle3", page)
        self.assertNotIn("attitude:x", page)
        self.bough("plot", "yaw.h5", "--sensor", "attitude", "-o", "p.svg")
        with open(self.path("p.svg")) as f:
            self.assertIn("angle2", f.read())

    def test_inputs_and_events_by_a_name_that_is_none_are_errors(self):
        for name, code in (("attitude:z", 1), ("attitude:x", 1), ("attitude:angle1", 0), ("attitude:1", 0)):
            self.write("law.toml", TURNING + LAW % name)
            self.write("event.toml", TURNING + EVENT % name)
            for file, error in (("law.toml", "control.unknown-signal"), ("event.toml", "run.unknown-signal")):
                result = self.bough("check", file, code=code)
                if code:
                    self.assertIn(f"[{error}]", result.stderr)
                    self.assertIn("angle1, angle2, angle3", result.stderr)

    def test_linear_models(self):
        self.write("law.toml", TURNING + LAW % "attitude:angle1")
        for name in ("attitude:angle1", "attitude:1"):
            self.bough("linearize", "law.toml", "--outputs", name, "-o", "l.h5")
            with h5py.File(self.path("l.h5")) as f:
                self.assertEqual([n.decode() for n in f["outputs/name"][:]], ["attitude:angle1"])
                self.assertAlmostEqual(f["C"][0, 0], 1, places=9)   # the hinge turns about z
        self.fails(1, "linearize", "law.toml", "--outputs", "attitude:z", error="linear.unknown-output")
        self.bough("linearize", "law.toml", "--break", "attitude:1")
        self.fails(1, "linearize", "law.toml", "--break", "attitude:z", error="linear.unknown-signal")

    def test_three_coordinates_are_no_axes(self):
        """A planar hinge has two travels and an angle, in this order: x, y, z would be the wrong names of them."""
        self.write("planar.toml", YAW % ("planar", "rate = [0.1, 0.2, 0.3]")
                   + '[[sensor]]\nname = "q"\ntype = "hinge_angle"\nhinge = "z"\n')
        self.bough("run", "planar.toml", "-o", "p.h5")
        self.bough("export", "p.h5", "--to", "csv", "--channel", "q:3", "-o", "q.csv")
        self.fails(1, "export", "p.h5", "--to", "csv", "--channel", "q:z", error="cli.unknown-channel")


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
