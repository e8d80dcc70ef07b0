"""ex11-rotor-blade: frequencies over the speed are those of a rotating beam, and so is the bending under lift."""
import unittest

import h5py
import numpy as np
from scipy.integrate import solve_bvp

from support import ProgramTest

LENGTH, LINE_MASS, EI, RATE, LIFT = 6.0, 8.0, 93312.0, 36.0, 300.0


def calc_beam():
    """Tip deflection and root moment of EI w'''' - (T w')' = p with T = m Ω² (L² - x²) / 2."""
    tension = lambda x: LINE_MASS * RATE**2 / 2 * (LENGTH**2 - x**2)
    # w, w', M = EI w'', Q = EI w''' - T w'
    slopes = lambda x, y: np.array([y[1], y[2] / EI, y[3] + tension(x) * y[1], LIFT + 0 * x])
    ends = lambda a, b: np.array([a[0], a[1], b[2], b[3]])
    x = np.linspace(0, LENGTH, 400)
    found = solve_bvp(slopes, ends, x, np.zeros((4, x.size)), tol=1e-8, max_nodes=100000)
    assert found.status == 0
    return found.y[0, -1], found.y[2, 0]


class RotorBlade(ProgramTest):
    def test_frequencies_and_bending(self):
        self.copy_example("ex11-rotor-blade")
        self.bough("static", "blade.bdf", "-o", "static.h5")
        self.bough("reduce", "blade.toml")
        said = self.bough("linearize", "rotor.toml", "--at", 4, "--sweep", "rate=0:36:19", "-o", "campbell.h5").stderr
        self.assertNotIn("sweep-jump", said)
        with h5py.File(self.path("campbell.h5")) as f:
            rates, omega = f["parameter/value"][:], 2 * np.pi * f["poles/frequency_hz"][:]
        # Wright, Smith, Thresher & Wang, J. Appl. Mech. 49 (1982) 197: Ω L² √(m/EI) is 12 in flap and 2 in lag.
        flap, lag = np.sqrt(EI / LINE_MASS) / LENGTH**2, 6 * np.sqrt(EI / LINE_MASS) / LENGTH**2
        for exact in (13.17015 * flap, 37.60311 * flap, 3.62180 * lag):
            self.assertLess(np.abs(omega[-1] / exact - 1).min(), 5e-4, exact)
        for row, eta, exact in ((3, 2, 4.13732), (6, 4, 5.58500), (9, 6, 7.36037)):
            self.assertAlmostEqual(rates[row] / flap, eta)
            self.assertLess(np.abs(omega[row] / (exact * flap) - 1).min(), 5e-4, eta)

        self.bough("run", "rotor.toml", "-o", "rotor.h5")
        with h5py.File(self.path("rotor.h5")) as f:
            time, tip, root = f["time"][:].ravel(), f["sensors/tip"][:, 2], f["sensors/root"][:]
        way, moment = calc_beam()
        late = time > 7
        self.assertLess(abs(tip[late].mean() / way - 1), 0.01)
        self.assertLess(abs(np.hypot(root[late, 0], root[late, 1]).mean() / moment - 1), 0.01)
        at_rest = LIFT * LENGTH**4 / (8 * EI)
        self.assertGreater(at_rest / tip[late].max(), 14)  # without tension the blade would bend so much more


if __name__ == "__main__":
    unittest.main()
