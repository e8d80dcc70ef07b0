"""`static --nonlinear` with RBE3: a soft truss that a force on the mean of its top grids deforms, against the minimum of its
energy with exact places and rotations."""
import unittest

import h5py
import numpy as np
from support import ProgramTest

EA, LEVELS = 4000., 3
WEIGHTS = np.array([1., 2., .7])


class NonlinearMeans(ProgramTest):
    def setUp(self):
        """A tower of octahedra, 0.9 wide and 1 a bay, twisted so that it has no symmetry."""
        super().setUp()
        angles = np.array([0., 2.2, 4.1])
        self.X = np.array([(.5 * np.cos(a + .4 * k), .45 * np.sin(a + .4 * k), k) for k in range(LEVELS) for a in angles])
        self.bars = [(3 * k + i, 3 * k + (i + 1) % 3) for k in range(1, LEVELS) for i in range(3)]
        self.bars += [(3 * k + i, 3 * k + 3 + (i + d) % 3) for k in range(LEVELS - 1) for i in range(3) for d in (0, 1)]
        self.top = np.arange(3 * LEVELS - 3, 3 * LEVELS)
        self.reference = np.array([.35, -.2, LEVELS - .6])

    def solve(self, force, options=()):
        text = f"SOL 106\nCEND\nSPC = 1\nLOAD = 1\nBEGIN BULK\nPARAM,LGDISP,1\nMAT1,1,{EA},,0.\nPROD,1,1,1.\nSPC1,1,123,1,2,3\n"
        for i, x in enumerate(self.X):
            text += f"GRID,{i + 1},,{x[0]:.12g},{x[1]:.12g},{x[2]:.12g}\n"
        text += "".join(f"CROD,{e + 1},1,{a + 1},{b + 1}\n" for e, (a, b) in enumerate(self.bars))
        text += "GRID,90,," + ",".join(f"{x:.12g}" for x in self.reference) + "\n"
        a, b, c = (int(i) + 1 for i in self.top)
        text += f"RBE3,91,,90,123456,{WEIGHTS[0]},123,{a},{WEIGHTS[1]}\n,123,{b},{WEIGHTS[2]},123,{c}\n"
        text += "FORCE,1,90,,1.," + ",".join(f"{f:.12g}" for f in force) + "\nENDDATA\n"
        self.write("truss.bdf", text)
        result = self.bough("static", "truss.bdf", *options, "-o", "truss.h5")
        with h5py.File(self.path("truss.h5")) as f:
            u = f["subcases/0/displacement"][:]
            ids = f["dof_map"][:]
        at = {node: u[ids[:, 0] == node] for node in (*range(1, len(self.X) + 1), 90)}
        return np.array([at[i + 1][:3] for i in range(len(self.X))]), at[90], result.stderr

    def fit(self, x):
        """Mean place, rotation of best fit and place of the reference grid."""
        weight, before, now = WEIGHTS[:, None], self.X[self.top], x[self.top]
        mean, centre = (weight * now).sum(0) / WEIGHTS.sum(), (weight * before).sum(0) / WEIGHTS.sum()
        U, _, Vt = np.linalg.svd((weight * (now - mean)).T @ (before - centre))
        R = U @ np.diag([1, 1, np.linalg.det(U @ Vt)]) @ Vt
        return R, mean + R @ (self.reference - centre)

    def find_minimum(self, force):
        """Places where the energy of the bars minus the work of the force is stationary, along the load."""
        free = slice(9, None)

        def calc_gradient(q, share):
            x = self.X.copy()
            x[3:] = q.reshape(-1, 3)
            g = np.zeros_like(x)
            for a, b in self.bars:
                before = np.linalg.norm(self.X[b] - self.X[a])
                along = x[b] - x[a]
                now = np.linalg.norm(along)
                pull = EA / before * (now - before) * along / now
                g[a] -= pull
                g[b] += pull
            for i in self.top:  # of the place of the reference grid, by differences
                for c in range(3):
                    ends = []
                    for sign in (1, -1, 2, -2):
                        moved = x.copy()
                        moved[i, c] += sign * 1e-3
                        ends.append(share * force @ self.fit(moved)[1])
                    g[i, c] -= (8 * (ends[0] - ends[1]) - (ends[2] - ends[3])) / 12e-3
            return g.ravel()[free]

        q = self.X[3:].ravel()
        step = 1e-5 * np.eye(len(q))
        for share in np.linspace(0, 1, 21)[1:]:
            for _ in range(8):
                slope = np.array([calc_gradient(q + d, share) - calc_gradient(q - d, share) for d in step]).T / 2e-5
                change = np.linalg.solve(slope, -calc_gradient(q, share))
                q = q + change
                if np.abs(change).max() < 1e-10:
                    break
        self.assertLess(np.abs(calc_gradient(q, 1)).max(), 1e-8 * np.abs(force).max())
        x = self.X.copy()
        x[3:] = q.reshape(-1, 3)
        return x

    def test_force_on_the_mean_of_a_soft_truss(self):
        force = np.array([250., -350., 500.])
        u, of_reference, stderr = self.solve(force)
        x = self.find_minimum(force)
        R, place = self.fit(x)
        before = np.linalg.norm(self.X[self.top] - np.roll(self.X[self.top], 1, 0), axis=1)
        now = np.linalg.norm(x[self.top] - np.roll(x[self.top], 1, 0), axis=1)
        angle = np.arccos((np.trace(R) - 1) / 2)
        off = np.abs(self.X + u - x).max()
        print(f"rotation {angle:.2f} rad, sides of the top {np.round(now / before, 3)}, off by {off:.1e}, reference "
              f"{np.abs(self.reference + of_reference[:3] - place).max():.1e}")
        self.assertGreater(angle, .5)
        self.assertGreater(np.abs(now / before - 1).max(), .02)
        self.assertLess(off, 1e-6)
        self.assertLess(np.abs(self.reference + of_reference[:3] - place).max(), 1e-6)
        theta = of_reference[3:]
        K = np.cross(np.eye(3), theta / np.linalg.norm(theta))
        exact = np.eye(3) + np.sin(np.linalg.norm(theta)) * K + (1 - np.cos(np.linalg.norm(theta))) * K @ K
        self.assertLess(np.abs(exact - R).max(), 1e-6)
        self.assertNotIn("nonlinear-link", stderr)


if __name__ == "__main__":
    unittest.main()
