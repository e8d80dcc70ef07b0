"""Two flexible links under PD laws of their hinges: poles of linearize against decay and frequency of the history."""
import unittest

import h5py
import numpy as np

from ex08_satellite_test import fit_poles
from support import ProgramTest
from toml_text import Bare, section, table, toml

LINKS = """
[[body]]
name = "upper"
file = "link.h5"
damping = 0.01
modes = 2

[[body]]
name = "lower"
file = "link.h5"
damping = 0.01
modes = 2                # more, clamped at a free hinge, are fast and say nothing of the slow poles
"""

JOINT = toml(
    table("hinge", "NAME", "revolute", child="CHILD", axis=[0.0, 0.0, 1.0], position=Bare("POSITION")),
    "PARENT\n",
    table("function", "NAME_angle", "constant", value=Bare("TARGET")),
    table("sensor", "NAME_angle", "hinge_angle", hinge="NAME"),
    table("sensor", "NAME_rate", "hinge_rate", hinge="NAME"),
    table("controller", "NAME_law", "pid", inputs=["/sensors/NAME_angle"], rate="NAME_rate",
          reference="/signals/NAME_angle", kp=Bare("KP"), kd=Bare("KD")),
    table("actuator", "NAME_motor", "hinge", hinge="NAME", input="NAME_law"))

SIMULATION = section("simulation", duration=8.0, output_step=0.02, integrator="rk", relative_tolerance=1e-9,
                     absolute_tolerance=1e-14)


class TwoLinkArm(ProgramTest):
    def write_arm(self, name, departure):
        text = LINKS
        for joint, parent, child, target, kp, kd in (
                ("shoulder", "", "upper", 0.4, 8.0, 0.5),
                ("elbow", 'parent = "upper"\nparent_node = 11', "lower", 0.7, 2.0, 0.08)):
            one = JOINT
            for word, value in (("NAME", joint), ("PARENT", parent), ("CHILD", child), ("TARGET", target), ("KP", kp),
                                ("KD", kd), ("POSITION", target + departure)):
                one = one.replace(word, str(value))
            text += one
        self.write(name, text + SIMULATION)

    def test_poles_are_decay_and_frequency_of_the_history(self):
        self.copy_example("ex03-two-link")
        self.bough("reduce", "link.toml")
        self.write_arm("rest.toml", 0.0)
        self.bough("linearize", "rest.toml", "-o", "poles.h5")
        with h5py.File(self.path("poles.h5")) as f:
            poles = f["poles/real"][:].ravel() + 1j * f["poles/imag"][:].ravel()
            self.assertLess(float(np.squeeze(f["operating_point/residual"][()])), 1e-9)
        self.assertLess(poles.real.max(), 1e-9)
        self.write_arm("arm.toml", 1e-5)
        self.bough("run", "arm.toml", "-o", "arm.h5")
        with h5py.File(self.path("arm.h5")) as f:
            angles = [f[f"hinges/{name}/q"][:].ravel() - at for name, at in (("shoulder", 0.4), ("elbow", 0.7))]
        slow = sorted((p for p in poles if p.imag > 0), key=abs)[:2]
        for angle in angles:
            found = fit_poles(angle[20:], 0.02, 12)
            for pole in slow:
                nearest = found[np.argmin(np.abs(found - pole))]
                self.assertLess(abs(nearest.real / pole.real - 1), 1e-3, (nearest, pole))
                self.assertLess(abs(nearest.imag / pole.imag - 1), 1e-3, (nearest, pole))


if __name__ == "__main__":
    unittest.main()
