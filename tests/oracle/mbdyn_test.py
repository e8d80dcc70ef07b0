"""export --to mbdyn, read by the oracle's own reader: groups of three point masses by sums, K0 of a column with a tip
mass by hand; the same signs in a file of others."""
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../cli"))
import mbdyn_reader  # noqa: E402
from point_frame import DECK, MASSES, PointFrame  # noqa: E402
from sid_oracle import skew  # noqa: E402
from support import ProgramTest  # noqa: E402

# The column of a straight beam along x with its mass at the tip: K_G of an axial force is known.
COLUMN = DECK.split("GRID,1")[0] + """GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
CONM2,13,3,,2.
ENDDATA
"""


class FemFile(ProgramTest):
    def export(self, deck, modes, interface):
        self.write("frame.bdf", deck)
        self.bough("reduce", "frame.bdf", "--modes", modes, "--interface", interface, "--load", "2:3", "--damping",
                   0.01, "-o", "frame.h5", "-q")
        result = self.bough("export", "frame.h5", "--to", "mbdyn", "-o", "frame.fem")
        self.assertIn("export.dropped-loads", result.stderr)
        return mbdyn_reader.read(self.path("frame.fem")), PointFrame(self.path("frame.h5")) if deck is DECK else None

    def same(self, a, b, tolerance=1e-12):
        self.assertEqual(np.shape(a), np.shape(b))
        self.assertLess(np.abs(np.asarray(a) - b).max(), tolerance * max(1.0, np.abs(b).max()))

    def test_three_masses(self):
        g, f = self.export(DECK, 5, "4,3")
        n = f.n
        self.assertEqual(g[1], (4, 5))
        self.assertEqual(g[2], [4, 3, 1, 2])
        rows = [f.ids.index(i) for i in g[2]]
        self.same(np.hstack([g[5], g[6], g[7]]), f.xyz[rows])
        self.same(g[8], f.all_phi[rows].transpose(2, 0, 1))
        self.assertFalse(g[3].any() or g[4].any())
        self.same(g[9], np.eye(n))
        self.same(g[10], np.diag(f.eigenvalue))
        self.same(g[13], np.diag(0.02 * np.sqrt(f.eigenvalue)))
        mass, cg, J = g[12]
        self.same(mass, sum(MASSES.values()))
        self.same(cg, f.sum(lambda p, phi: p) / f.m.sum())
        self.same(J, f.sum(lambda p, phi: -skew(p - cg) @ skew(p - cg)))
        self.same(g[14], f.sum(lambda p, phi: phi))
        self.same(g[15], f.sum(lambda p, phi: np.cross(p, phi.T).T))
        for j in range(n):
            self.same(g[16][:, j], f.sum(lambda p, phi: -skew(p) @ skew(phi[:, j])))
            for k in range(n):
                self.same(g[17][:, j, k], f.sum(lambda p, phi: np.cross(phi[:, j], phi[:, k])))
                self.same(g[18][:, j, k], f.sum(lambda p, phi: skew(phi[:, j]) @ skew(phi[:, k])))

    def test_stiffening_matrices(self):
        g, f = self.export(DECK, 5, "4,3")
        self.assertEqual(sorted(g[19]), list(range(1, 25)))  # 12 + 6 i: forces and moments
        for index, place in enumerate([6, 7, 8, 9, 11, 10, 3, 4, 5, 0, 1, 2]):
            self.same(g[19][index + 1], f.kg[place])
        for (node, direction), K in zip(f.locators, f.kg_external):
            if node == 2:  # no interface node
                continue
            self.same(g[19][12 + 6 * [4, 3].index(node) + direction], 0.5 * (K + K.T))

    def test_signs_on_a_column(self):
        g, _ = self.export(COLUMN, 3, 3)
        mass, length = 2.0, 2.0
        bending = [j for j in range(3) if abs(g[8][j, 0, 0]) < 1e-9]
        self.assertTrue(bending)
        for j in bending:
            # Tip force P, tip mass: the shape of a tip load; pulled by P, int P phi'^2 = 6/5 P phi^2 / L.
            tip = np.sum(g[8][j, 0, 1:3] ** 2)
            self.assertAlmostEqual(g[19][13][j, j], 1.2 * tip / length, delta=0.02 * tip)
            self.assertLess(g[19][10][j, j], 0)
            self.assertAlmostEqual(g[19][10][j, j], -mass * g[19][13][j, j], delta=1e-9)
            for spin in [2, 3]:
                self.assertAlmostEqual(g[19][spin][j, j], mass * length * g[19][13][j, j], delta=1e-9)

    def test_files_of_others(self):
        folder = os.path.join(os.environ.get("BOUGH_SHARED_DIR", ""), "reference/spinup")
        if not os.path.isdir(folder):
            self.skipTest("no files of others at " + folder)
        g = mbdyn_reader.read(os.path.join(folder, "spinup_beam_6y4z_own_exporter.fem"))
        # A straight beam along x: what an acceleration, a spin give has these signs; shapes in groups 14 to 18 agree.
        self.assertLess(g[19][10][0, 0], 0)
        self.assertGreater(g[19][3][0, 0], 0)
        x = g[15][2, 0] / g[14][1, 0]
        self.assertGreater(x, 0)
        self.assertAlmostEqual(g[16][1, 0, 0], -g[15][2, 0], delta=1e-9)  # -phi_y x
        self.assertAlmostEqual(g[17][0, 0, 6], 1, delta=1e-9)             # phi_y x phi_z
        self.assertAlmostEqual(g[18][0, 0, 0, 0], -1, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
