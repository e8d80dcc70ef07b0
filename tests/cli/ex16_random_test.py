"""ex16-random: RMS, crossings of zero and forces of a box on isolators are those of one damped mass on a shaken base."""
import math
import unittest

import h5py
import numpy as np
from scipy.integrate import quad

from support import ProgramTest

G = 9.80665


def level(hz):
    """g²/Hz of GSFC-STD-7000, straight in logarithms."""
    return math.exp(np.interp(math.log(hz), np.log([20, 50, 800, 2000]), np.log([.026, .16, .16, .026])))


def integral(density):
    ends = [20, 50, 100, 115, 120, 125, 140, 200, 800, 2000]
    return sum(quad(density, a, b, epsrel=1e-10)[0] for a, b in zip(ends, ends[1:]))


class RandomExample(ProgramTest):
    def test_numbers(self):
        self.copy_example("ex16-random")
        self.bough("frequency", "box.bdf", "-o", "box.h5")
        m, k, c = 8.0, 4 * 1136979.0, 4 * 150.7964
        omega = lambda hz: 2 * math.pi * hz
        dynamic = lambda hz: k - m * omega(hz)**2 + 1j * omega(hz) * c
        box = lambda hz: level(hz) * abs((k + 1j * omega(hz) * c) / dynamic(hz))**2 * G**2
        force = lambda hz: level(hz) * abs(m * k / 4 / dynamic(hz))**2 * G**2
        with h5py.File(self.path("box.h5")) as f:
            group = f["random/30"]
            part = group["acceleration"]
            dofs = part["dofs"][:].tolist()
            rms = lambda grid: part["modal_rms"][dofs.index([grid, 3])]
            self.assertAlmostEqual(rms(1) / (G * math.sqrt(integral(level))), 1, delta=1e-6)
            expected = math.sqrt(integral(box))
            self.assertAlmostEqual(rms(2) / expected, 1, delta=1e-6)
            self.assertAlmostEqual(expected, 169.48, delta=.005)
            crossings = math.sqrt(integral(lambda hz: hz**2 * box(hz))) / expected
            self.assertAlmostEqual(part["modal_zero_crossings_hz"][dofs.index([2, 3])] / crossings, 1, delta=1e-6)
            self.assertAlmostEqual(crossings, 121.1, delta=.05)
            # Straight lines between the frequencies of the deck.
            self.assertAlmostEqual(part["rms"][dofs.index([2, 3])] / expected, 1, delta=2e-4)
            expected = math.sqrt(integral(force))
            self.assertAlmostEqual(group["elements/CBUSH/modal_rms"][:].max() / expected, 1, delta=1e-6)
            self.assertAlmostEqual(expected, 337.25, delta=.005)
        miles = math.sqrt(math.pi / 2 * 120 * 10 * .16)
        self.assertAlmostEqual(miles, 17.37, delta=.005)


if __name__ == "__main__":
    unittest.main()
