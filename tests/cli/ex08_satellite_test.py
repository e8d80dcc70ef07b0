"""ex08-satellite: momentum, pointing, the poles of the law in continuous and in sampled time against the histories."""
import json
import unittest

import h5py
import numpy as np
from scipy.linalg import expm

from support import ProgramTest


def fit_poles(values, period, order):
    """Poles of a sampled sum of exponentials, by the matrix pencil of its Hankel matrix."""
    y = values
    rows = len(y) // 2
    hankel = np.array([y[i:i + len(y) - rows] for i in range(rows)])
    u, s, vh = np.linalg.svd(hankel, full_matrices=False)
    u = u[:, :order]
    shift = np.linalg.lstsq(u[:-1], u[1:], rcond=None)[0]
    return np.log(np.linalg.eigvals(shift).astype(complex)) / period


class Satellite(ProgramTest):
    EXAMPLE = "ex08-satellite", "wing.toml"

    def test_poles_are_those_of_the_history(self):
        self.bough("linearize", "pointing.toml", "-o", "poles.h5")
        with h5py.File(self.path("poles.h5")) as f:
            poles = f["poles/real"][:].ravel() + 1j * f["poles/imag"][:].ravel()
        self.bough("run", "pointing.toml", "-o", "pointing.h5")
        with h5py.File(self.path("pointing.h5")) as f:
            angle = f["sensors/tracker"][:, 0]
        self.assertLess(poles.real.max(), 1e-9)
        # About z: the rigid pair, and the wings bending in their plane against each other's sense.
        found = fit_poles(angle[:800:4], 0.2, 4)
        for near in (-0.1738 + 0.2107j, -0.5101 + 10.1407j):
            pole = poles[np.argmin(np.abs(poles - near))]
            self.assertLess(np.abs(found - pole).min(), 1e-5 * abs(pole))

    def test_sampled_loop_against_its_matrices(self):
        """A B C D of the plant by linearize --open, held and closed by the sampled law in numpy, against the run."""
        text = open(self.path("satellite.toml")).read()
        text = text.replace("duration = 120.0", "duration = 20.0").replace("output_step = 0.05", "output_step = 0.1")
        for line in ("noise_density = 2e-6     # rad/s/sqrt(Hz)", "noise_density = 3e-6"):
            self.assertIn(line, text)
            text = text.replace(line, "")
        text = text.replace('seed = "$seed"', "").replace("[parameters]\nseed = 1                 # of all noise\n", "")
        text = text.replace("momentum = 12.0          # gathered before", "momentum = 0.0")
        start = '[[hinge]]\nname = "flight"\ntype = "free"\nchild = "hub"\n'
        self.assertIn(start, text)
        text = text.replace(start, start + "position = [1.0, 0.0, 0.0, 1e-4, 0.0, 0.0, 0.0]\n")
        text = text.replace('reference = "slew"\n', "")
        self.write("quiet.toml", text)
        self.bough("run", "quiet.toml", "-o", "quiet.h5")
        self.bough("linearize", "quiet.toml", "--open", "-o", "plant.h5")
        with h5py.File(self.path("quiet.h5")) as f:
            measured = f["sensors/attitude"][:, 0]
        with h5py.File(self.path("plant.h5")) as f:
            A, B, C = (f[name][:] for name in "ABC")
            names = {kind: [n.decode() for n in f[kind + "/name"][:]] for kind in ("states", "inputs", "outputs")}
        column = names["inputs"].index("wheel_z")
        angle, rate = (C[names["outputs"].index(name)] for name in ("attitude:angle1", "gyro:z"))  # euler: z, y, x
        n = A.shape[0]
        block = np.zeros((n + 1, n + 1))
        block[:n, :n], block[:n, n] = A, B[:, column]
        step = expm(block * 0.05)  # half a sample: the law takes so long
        F, G = step[:n, :n], step[:n, n]
        x = np.zeros(n)
        x[names["states"].index("flight:rz")] = 2e-4
        expected, torque = [], 0.0
        for _ in measured:
            expected.append(angle @ x)
            new = 132.0 * (0 - angle @ x) - 616.0 * (rate @ x)
            x = F @ x + G * torque
            torque = new
            x = F @ x + G * torque
        self.assertLess(np.abs(measured - expected).max(), 1e-3 * 2e-4)

    def test_slew_and_dump(self):
        self.bough("run", "satellite.toml", "-o", "satellite.h5")
        with h5py.File(self.path("satellite.h5")) as f:
            time = f["time"][:].ravel()
            attitude = np.degrees(f["sensors/attitude"][:])
            momentum = f["momentum/angular"][:]
            wheel = f["actuators/wheel_z"][:, 1]
            jets = [f["actuators/jet_1"][:], f["actuators/jet_2"][:]]
            events = [e.decode() for e in np.ravel(f["events/what"][:])]
        before = time < 60 - 1e-9
        self.assertLess(np.abs(momentum[before] - momentum[0]).max(), 1e-9 * np.abs(momentum[0]).max())
        self.assertLess(np.abs(attitude[(time > 55) & before] - [5, 0, 0]).max(), 0.05)
        self.assertLess(np.abs(attitude[time > 110] - [5, 0, 0]).max(), 0.05)
        # At rest what is left is the wheel's: 1 N m s at the event, and what hub and wings still turned with.
        self.assertLess(abs(wheel[-1]), 3.0)
        self.assertLess(abs(wheel[-1] - momentum[-1, 2]), 0.02 * wheel[0])
        self.assertLess(np.abs(attitude[time > 60] - [5, 0, 0]).max(), 0.6)
        # Impulse of the jets: propellant times exhaust velocity, arm 1 m each, about -z.
        impulse = sum(j[-1, 1] for j in jets) * 2200.0
        change = momentum[-1] - momentum[0]
        self.assertLess(abs(change[2] + impulse), 0.01 * impulse)
        self.assertLess(np.abs(change[:2]).max(), 0.02 * impulse)
        self.assertLess(abs(impulse - (wheel[0] - wheel[-1])), 0.02 * wheel[0])
        for what in ("enabled", "disabled"):
            self.assertIn(f"controller 'dump' is {what}", events)

    def test_select_keeps_what_the_loop_sees(self):
        result = self.bough("select", "wing.h5", "pointing.toml", "--outputs", "tip", "--number", 3, "-o", "small.h5")
        rows = [line.split() for line in result.stdout.splitlines() if " yes " in line or " no " in line]
        self.assertEqual([row[0] for row in rows if "yes" in row], ["1", "2", "3"])
        np.testing.assert_allclose([float(row[3]) for row in rows[:3]], [75.7, 22.8, 1.54], rtol=5e-3)  # README
        self.assertNotIn("select.unseen", result.stderr)
        # The hub's instruments see no mode of a wing at once.
        said = self.bough("select", "wing.h5", "pointing.toml", "--outputs", "gyro", "--number", 3).stderr
        self.assertIn("[select.unseen]", said)

    def test_margins_of_the_sampled_law(self):
        self.bough("linearize", "satellite.toml", "--break", "wheel_z", "-o", "loop.h5")
        margins = json.loads(self.bough("response", "loop.h5", "--json").stdout)["margins"]
        self.assertTrue(margins["stable"])
        found = [(c["frequency_hz"], c["degrees"]) for c in margins["phase"]]
        np.testing.assert_allclose(found, [(0.0628, 59.2), (1.558, -161.6), (1.681, 41.2)], rtol=2e-3)  # README
        # The system in numpy: the plant of `linearize --open`, controllers of x and y, torques new 0.05 s after a sample.
        self.bough("linearize", "satellite.toml", "--open", "-o", "plant.h5")
        self.bough("response", "loop.h5", "-o", "response.h5")
        with h5py.File(self.path("plant.h5")) as f:
            A, B, C = (f[name][:] for name in "ABC")
            names = {kind: [n.decode() for n in f[kind + "/name"][:]] for kind in ("inputs", "outputs")}
        n = len(A)
        block = np.zeros((n + 3, n + 3))
        block[:n, :n], block[:n, n:] = A, B[:, [names["inputs"].index(f"wheel_{x}") for x in "xyz"]]
        half = expm(0.05 * block)
        F, G = half[:n, :n], half[:n, n:]
        outputs = names["outputs"]
        K = np.array([kp * C[outputs.index("attitude:angle" + angle)] + kd * C[outputs.index("gyro:" + axis)]
                      for kp, kd, angle, axis in ((113, 528, "3", "x"), (33, 154, "2", "y"), (132, 616, "1", "z"))])
        K[2:] = 0
        step = np.block([[F @ F - G @ K, F @ G], [-K, np.zeros((3, 3))]])
        push = np.concatenate([G[:, 2], [0, 0, 1]])
        K_z = np.concatenate([132 * C[outputs.index("attitude:angle1")] + 616 * C[outputs.index("gyro:z")], np.zeros(3)])
        with h5py.File(self.path("response.h5")) as f:
            omega, L = 2 * np.pi * f["frequency_hz"][:], (f["real"][:] + 1j * f["imag"][:]).ravel()
        exact = np.array([K_z @ np.linalg.solve(np.exp(0.1j * w) * np.eye(n + 3) - step, push) for w in omega])
        self.assertLess(np.abs(L / exact - 1).max(), 1e-8)


if __name__ == "__main__":
    unittest.main()
