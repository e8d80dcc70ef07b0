"""K_G2 of moments and forces at the tip of a bar, plain and preloaded by an end moment, against exact rotations.

K_G2 is the stress of the load on the second strains of the modes, of the straight bar. What the third derivative of the
energy has beside it comes of the bend that a moment makes before anything else moves, and is as small as EI2/EI1 and
GJ/EI1 (docs/theory/preload.md)."""
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../cli"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from exact_bar import Bar, REAL  # noqa: E402
from support import ProgramTest  # noqa: E402

NUM, LENGTH, E, G = 40, 1.0, 7e10, 2.7e10
A, I2, J = 4e-5, 1.33e-11, 5e-11      # upright in xy: I1 is that of the stiff plane
CRITICAL = np.pi / 2 * np.sqrt(E * I2 * G * J) / LENGTH


class TestBarMoment(ProgramTest):
    def reduce(self, I1, preload, number):
        """Shapes (all dofs of the chain), M, K and K_G2 of what bends out of the plane of the moment and twists."""
        lines = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "SPC1,1,123456,1", f"MAT1,1,{E!r},{G!r},,2700.",
                 f"PBEAM,1,1,{A!r},{I1!r},{I2!r},,{J!r}", f"MOMENT,10,{NUM + 1},,{preload!r},0.,0.,1."]
        lines += [f"GRID,{i + 1},,{LENGTH * i / NUM!r},0.,0." for i in range(NUM + 1)]
        lines += [f"CBEAM,{i},1,{i},{i + 1},0.,1.,0." for i in range(1, NUM + 1)]
        self.write("bar.bdf", "\n".join(lines) + "\nENDDATA\n")
        self.write("bar.toml", f'[body]\nname = "bar"\ndeck = "bar.bdf"\ninterface = [{NUM + 1}]\n'
                   f'[body.modes]\nnumber = {number}\nresidual = ["interface"]\n'
                   + ("[body.preload]\nload_set = 10\n" if preload else ""))
        self.bough("reduce", "bar.toml", "-o", "bar.h5")
        with h5py.File(self.path("bar.h5")) as f:
            phi = f["modes/phi"][:][np.argsort(f["nodes/id"][:])]
            M, K, K_G = f["modal/mass"][:], f["modal/stiffness"][:], f["stiffening/kg_external"][:]
        in_plane = np.abs(phi[:, [0, 1, 5]]).max((0, 1))
        out = in_plane < 1e-6 * np.abs(phi).max((0, 1))
        return phi[:, :, out].reshape(6 * NUM + 6, -1), M[out][:, out], K[out][:, out], K_G[:, out][:, :, out]

    def bar(self, I1):
        return Bar(LENGTH, NUM, [E * A, G * A, G * A, G * J, E * I2, E * I1])      # K1 and K2 are 1

    @staticmethod
    def load(component, value):
        f = np.zeros(6 * NUM + 6)
        f[6 * NUM + component] = value
        return f

    def calc_lowest(self, bar, I1, moment):
        """ω² of the lowest motion out of the plane, at the equilibrium under the moment."""
        q = bar.find_equilibrium(self.load(5, moment)) if moment else np.zeros((NUM + 1, 6), REAL)
        K = bar.calc_tangent(q)[0][np.ix_(bar.free, bar.free)]
        mass = np.tile(2700 * LENGTH / NUM * np.array([A, A, A, I1 + I2, 0, 0]), NUM)
        mass[-6:] /= 2
        s = np.sqrt(mass)
        values, vectors = np.linalg.eigh(s[:, None] * np.linalg.inv(K) * s)
        shapes = (s[:, None] * vectors).reshape(NUM, 6, -1)
        lateral = [j for j in range(len(s)) if np.abs(shapes[:, 2, j]).max() > np.abs(shapes[:, 1, j]).max()]
        return 1 / values[lateral].max()

    def test_stress_on_second_strains(self):
        I1, rest, none = 1.33e-9, np.zeros((NUM + 1, 6), REAL), np.zeros((NUM, 6), REAL)
        bar = self.bar(I1)
        U = bar.solve(bar.calc_tangent(rest)[0], self.load(5, 1.0))
        for preload in (0.0, 0.3 * CRITICAL):
            shapes, _, _, found = self.reduce(I1, preload, 6)
            expected = bar.calc_third(rest, none, U, shapes)[0]
            off = np.abs(found[5] - expected).max() / np.abs(expected).max()
            self.assertLess(off, 5e-3, preload)      # of pieces in the chain

    def test_frequency_under_moments(self):
        """With a stiff plane K_G is all there is; else the bend under the moments takes some of it back, the share of
        (1 - EI2/EI1) (1 - GJ/EI1) in the moment of lateral buckling."""
        preload, more = 0.3 * CRITICAL, 0.2 * CRITICAL
        for I1, least, most in ((1.33e-9, 0.005, (E * I2 + G * J) / (E * 1.33e-9)), (1.33e-7, -5e-4, 5e-4)):
            _, M, K, K_G = self.reduce(I1, 0.0, 60)
            calc = lambda K: np.linalg.eigvals(np.linalg.solve(M, K)).real.min()      # noqa: E731
            plain, at_once = calc(K), calc(K + (preload + more) * K_G[5])
            _, M, K, K_G = self.reduce(I1, preload, 60)
            found, bar = [calc(K), calc(K + more * K_G[5])], self.bar(I1)
            self.assertLess(abs(found[1] - at_once), 1e-4 * (plain - at_once))
            rest = self.calc_lowest(bar, I1, 0)
            for value, moment in zip(found, (preload, preload + more)):
                off = (plain - value) / (rest - self.calc_lowest(bar, I1, moment)) - 1
                with self.subTest(I1=I1, moment=moment, off=off):
                    self.assertLess(off, most)
                    self.assertGreater(off, least)


if __name__ == "__main__":
    unittest.main()
