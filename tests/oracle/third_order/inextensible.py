"""A planar cantilever without stretch, exact: deflection v(s) = Σ φ_j q_j along the arc s, x' = √(1 - v'²),
V = ½ EI ∫ v''²/(1 - v'²) ds. Own quadrature; third-order tables play no part."""
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

ROOTS = np.array([1.8751040687, 4.6940911330, 7.8547574382, 10.9955407349, 14.1371683910])


class Cantilever:
    def __init__(self, length, EI, mass, n, cells=200):
        nodes, weights = np.polynomial.legendre.leggauss(3)
        h = length / cells
        self.s = (np.arange(cells)[:, None] + (1 + nodes) / 2) * h
        w = np.broadcast_to(weights * h / 2, self.s.shape)
        # integral from 0 to each point: whole cells before, and inside the cell by its own interpolant
        inner = np.zeros((3, 3))
        for i in range(3):
            basis = np.polynomial.polynomial.polyfromroots(np.delete(nodes, i))
            basis = basis / np.polynomial.polynomial.polyval(nodes[i], basis)
            integral = np.polynomial.polynomial.polyint(basis)
            inner[:, i] = [np.polynomial.polynomial.polyval(x, integral) - np.polynomial.polynomial.polyval(-1., integral)
                           for x in nodes]
        self.inner, self.h = inner * h / 2, h
        self.w, self.n, self.EI, self.rho = w.ravel(), n, EI, mass / length
        s = self.s.ravel()
        P, D, C = [], [], []
        for b in ROOTS[:n]:
            k, a = b / length, (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))
            P.append((np.cosh(k * s) - np.cos(k * s) - a * (np.sinh(k * s) - np.sin(k * s))) / 2)
            D.append(k * (np.sinh(k * s) + np.sin(k * s) - a * (np.cosh(k * s) - np.cos(k * s))) / 2)
            C.append(k * k * (np.cosh(k * s) + np.cos(k * s) - a * (np.sinh(k * s) + np.sin(k * s))) / 2)
        self.P, self.D, self.C = np.array(P).T, np.array(D).T, np.array(C).T
        self.tip = np.array([(-1.)**j for j in range(n)])         # Φ normal to 1 at the tip, up to sign
        self.omega = ROOTS[0]**2 * np.sqrt(EI / self.rho) / length**2

    def sum_up(self, f):
        """∫_0^s f of fields (points, ...)."""
        g = f.reshape((-1, 3) + f.shape[1:])
        cells = np.einsum("cq...,q->c...", g, self.w[:3])
        before = np.cumsum(cells, 0) - cells
        return (before[:, None] + np.einsum("pq,cq...->cp...", self.inner, g)).reshape(f.shape)

    def accelerate(self, q, qd, spin=0., spin_rate=0.):
        v, slope, rate = self.P @ q, self.D @ q, self.D @ qd
        r = np.sqrt(1 - slope**2)
        x = self.sum_up(r)
        J = self.sum_up((-slope / r)[:, None] * self.D)
        vd, xd = self.P @ qd, J @ qd
        ax = self.sum_up(-(1 / r + slope**2 / r**3) * rate**2) - 2 * spin * vd - spin_rate * v - spin**2 * x
        ay = 2 * spin * xd + spin_rate * x - spin**2 * v
        m = self.rho * self.w
        M = self.P.T @ (m[:, None] * self.P) + J.T @ (m[:, None] * J)
        g, bend = 1 / (1 - slope**2), self.C @ q
        Q = -J.T @ (m * ax) - self.P.T @ (m * ay)
        Q -= self.EI * (self.C.T @ (self.w * bend * g) + self.D.T @ (self.w * bend**2 * slope * g**2))
        return np.linalg.solve(M, Q)

    def integrate(self, t, spin=None, start=None, rtol=1e-8):
        def f(t, y):
            return np.r_[y[self.n:], self.accelerate(y[:self.n], y[self.n:], *(spin(t) if spin else ()))]
        start = np.zeros(2 * self.n) if start is None else start
        return solve_ivp(f, (0, t), start, method="DOP853", rtol=rtol, atol=rtol * 1e-3, dense_output=True)

    def find_backbone(self, amplitudes):
        guess, out = np.zeros(self.n), []
        guess[0] = np.pi / 2 / self.omega
        for a in amplitudes:
            def close(z):
                q = np.r_[0, z[1:] * a]
                q[0] = (a - self.tip[1:] @ q[1:]) / self.tip[0]
                return self.integrate(z[0], start=np.r_[q, np.zeros(self.n)], rtol=1e-7).y[:self.n, -1] / a
            guess = fsolve(close, guess, xtol=1e-7)
            out.append(np.pi / 2 / guess[0])
        return np.array(out)


def spin_up(rate, duration=15.):
    def spin(t):
        if t >= duration:
            return rate, 0.
        return (rate / duration * (t - duration / (2 * np.pi) * np.sin(2 * np.pi * t / duration)),
                rate / duration * (1 - np.cos(2 * np.pi * t / duration)))
    return spin
