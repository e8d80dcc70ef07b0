"""Statics of a clamped chain of straight or arched rods with exact rotations, by shooting: bending, torsion and stretch,
no shear. Dead forces at the ends of the pieces."""
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve


def to_matrix(q):
    w, v = q[0], q[1:]
    S = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) * (w * w - v @ v) + 2 * np.outer(v, v) + 2 * w * S


class Chain:
    """pieces: (length, axes): axes (3, 3) undeformed, columns x y z. EA, and bending stiffness C = (GJ, EIy, EIz)."""

    def __init__(self, pieces, EA, C):
        self.pieces, self.EA, self.C = pieces, EA, np.asarray(C)

    def run(self, root, forces, ends=None):
        """root: n, m there. forces[i]: at the end of piece i. Places of the ends, quaternions, n and m past the tip."""
        x, q, n, m = np.zeros(3), np.array([1., 0, 0, 0]), root[:3], root[3:]
        places, turns = [], []
        for (length, axes), f in zip(self.pieces, forces):
            def slope(_, y):
                R = to_matrix(y[3:7] / np.linalg.norm(y[3:7])) @ axes
                local = R.T @ y[7:]
                kappa = R @ (local / self.C)
                tangent = R[:, 0] * (1 + R[:, 0] @ n / self.EA)
                w, v = y[3], y[4:7]
                return np.r_[tangent, -0.5 * kappa @ v, 0.5 * (w * kappa + np.cross(kappa, v)), -np.cross(tangent, n)]
            y = solve_ivp(slope, (0, length), np.r_[x, q, m], method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
            x, q, m = y[:3], y[3:7] / np.linalg.norm(y[3:7]), y[7:]
            n = n - f
            places.append(x)
            turns.append(q)
        return np.array(places), np.array(turns), n, m

    def solve(self, forces, guess=None):
        """Tip free: n is known."""
        n = np.sum(forces, 0)
        m = fsolve(lambda m: self.run(np.r_[n, m], forces)[3], np.zeros(3) if guess is None else guess, xtol=1e-12)
        return self.run(np.r_[n, m], forces)[0], m

    def solve_clamped(self, forces, tip, guess):
        """Both ends clamped: the tip at `tip`, not turned."""
        def miss(root):
            x, q, _, _ = self.run(root, forces)
            return np.r_[x[-1] - tip, q[-1][1:]]
        root = fsolve(miss, guess, xtol=1e-12)
        return self.run(root, forces)[0], root
