"""Control in the loop from outside: files, parameters, matrices, linear models, against scipy."""
import json
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.signal

from support import ProgramTest
from toml_text import section, table, toml

AXIS = toml(
    section("parameters", kp=6.0),
    table("body", "rotor", mass=1.0, inertia=[1.0, 1.0, 2.0]),
    table("hinge", "axis", "revolute", child="rotor"),
    table("function", "target", "constant", value=0.5),
    table("sensor", "angle", "hinge_angle", hinge="axis"),
    table("controller", "law", "pid", inputs=["angle"], reference="target", kp="$kp", ki=3.0, kd=4.0, filter=0.1),
    table("controller", "filter", "transfer_function", inputs=["angle"], numerator=[2.0, 1.0],
          denominator=[0.3, 1.0, 4.0]),
    table("actuator", "drive", "hinge", hinge="axis", input="law"),
    section("simulation", duration=5.0, output_step=0.01, integrator="rk", relative_tolerance=1e-11,
            absolute_tolerance=1e-13))


class Control(ProgramTest):
    def run_axis(self, text, *options, output="axis.h5"):
        self.write("axis.toml", text)
        result = self.bough("run", "axis.toml", "-o", output, *options)
        return h5py.File(self.path(output)), result

    def check_step(self, results, kp):
        law = ([kp * 0.1 + 4.0, kp + 0.3, 3.0], [0.1, 1.0, 0.0])  # kp + ki/s + kd s / (1 + 0.1 s)
        num = np.array(law[0])
        den = np.polymul(law[1], [2.0, 0.0, 0.0])
        closed = scipy.signal.TransferFunction(num, np.polyadd(den, num))
        t = results["time"][:].ravel()
        _, expected = scipy.signal.step(closed, T=t)
        angle = results["sensors/angle"][:].ravel()
        np.testing.assert_allclose(angle, 0.5 * expected, atol=1e-8)
        return t, angle

    def test_pid_and_filter_against_scipy(self):
        results, _ = self.run_axis(AXIS)
        t, angle = self.check_step(results, 6.0)
        # First-order hold of the angle: error h² / 12 of its curvature.
        _, filtered, _ = scipy.signal.lsim(([2.0, 1.0], [0.3, 1.0, 4.0]), angle, t)
        np.testing.assert_allclose(results["controllers/filter"][:].ravel(), filtered, atol=2e-4)
        np.testing.assert_array_equal(results["controllers/law"][:], results["actuators/drive"][:])

    def test_parameters_are_set(self):
        results, said = self.run_axis(AXIS, "--set", "kp=9.5")
        self.check_step(results, 9.5)
        self.assertIn("kp = 9.5", results["system"][()].decode())
        self.fails(1, "run", "axis.toml", "--set", "kq=1", error="toml.unknown-parameter", says=["'kp'"])
        self.fails(1, "run", "axis.toml", "--set", "kp:1", error="cli.bad-setting")
        self.write("unused.toml", AXIS.replace('kp = "$kp"', "kp = 6.0"))
        self.assertIn("[toml.unused-parameter]", self.bough("check", "unused.toml").stderr)

    def test_matrices_of_a_file(self):
        a, b, c, d = scipy.signal.tf2ss([6 * 0.1 + 4.0, 6.3, 3.0], [0.1, 1.0, 0.0])
        scipy.io.savemat(self.path("law.mat"), {"A": a, "B": b, "C": c, "D": d})
        with h5py.File(self.path("law.h5"), "w") as f:
            f["A"], f["B"], f["C"], f["D"] = a, b, c, d
        start = AXIS.index('type = "pid"')
        end = AXIS.index("[[controller]]", start)
        for name in ("law.mat", "law.h5"):
            text = (AXIS[:start] + f'type = "state_space"\ninputs = ["error"]\nfile = "{name}"\n\n'
                    '[[controller]]\nname = "error"\ntype = "sum"\ninputs = ["target", "angle"]\nweights = [1, -1]\n\n'
                    + AXIS[end:]).replace("[parameters]\nkp = 6.0\n", "")
            results, _ = self.run_axis(text, output=name + ".out.h5")
            self.check_step(results, 6.0)
        scipy.io.savemat(self.path("law.mat"), {"A": a, "B": b})
        self.fails(1, "check", self.write("short.toml", text.replace("law.h5", "law.mat")),
                   error="control.missing-matrix")

    def test_linear_models(self):
        self.write("axis.toml", AXIS)
        closed = json.loads(self.bough("linearize", "axis.toml", "--json", "-o", "closed.h5").stdout)
        self.assertTrue(closed)
        with h5py.File(self.path("closed.h5")) as f:
            poles = f["poles/real"][:] + 1j * f["poles/imag"][:]
        num = [4.6, 6.3, 3.0]
        exact = np.concatenate([np.roots(np.polyadd([0.2, 2.0, 0, 0, 0], num)), np.roots([0.3, 1.0, 4.0])])
        for pole in exact:
            self.assertLess(np.abs(poles - pole).min(), 1e-7)
        self.bough("linearize", "axis.toml", "--open", "-o", "open.h5")
        with h5py.File(self.path("open.h5")) as f:
            np.testing.assert_allclose(f["A"][:], [[0, 1], [0, 0]], atol=1e-9)
            np.testing.assert_allclose(f["B"][:], [[0], [0.5]], atol=1e-9)
        sampled = AXIS.replace("filter = 0.1", "sample_time = 0.1")
        said = self.bough("linearize", self.write("sampled.toml", sampled))
        self.assertIn("[linear.sampled]", said.stdout + said.stderr)

    def test_a_run_is_resumed_bit_for_bit(self):
        text = AXIS.replace('"rk"', '"rk4"\nstep = 0.01').replace("filter = 0.1", "sample_time = 0.04\ndelay = 0.02")
        text = text.replace('hinge = "axis"\n[[controller]]',
                            'hinge = "axis"\nsample_time = 0.02\nnoise_density = 1e-3\nseed = 7\n[[controller]]', 1)
        whole, _ = self.run_axis(text, output="whole.h5")
        self.write("axis.toml", text.replace("duration = 5.0", "duration = 2.0"))
        self.bough("run", "axis.toml", "-o", "part.h5")
        self.write("axis.toml", text)
        self.bough("run", "axis.toml", "-o", "part.h5", "--resume")
        with h5py.File(self.path("part.h5")) as part:
            for name in ("sensors/angle", "controllers/law", "bodies/rotor/quaternion"):
                np.testing.assert_array_equal(part[name][:], whole[name][:])


if __name__ == "__main__":
    unittest.main()
