#!/usr/bin/python3
"""Clamped beams as points at r = p + phi eta + u2 (+ u4), their kinetic energy summed point by point:

    python3 point_links.py links MODES ...    tip of the two links of tests/cases/two_link_modes_test.cpp at 1 s
    python3 point_links.py spin               the spin-ups of tests/cases/spinup_test.cpp

u2 = -1/2 int y'^2 is taken whole, or as the affine field in x with the same first two moments of mass ("affine"), or as
that with the fourth order that keeps the second moment ("square", what the solver has). `spin` adds u4 = -1/8 int y'^4
and the strain energy EI/2 int y''^2 y'^2 that goes with it: with both the beam is exact to fourth order.
Nothing of it comes from the program: Euler-Bernoulli bars, lumped masses, Lagrange's equations of the points.
"""
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

THIN = 0.01  # as in solver/bodies/affine_field.cpp


class Beam:
    """n clamped modes of `bars` bars in bending: x, m, phi (K x n), g (K x n x n), eigenvalues w."""

    def __init__(self, n, bars, L, EI, rhoA):
        h, N = L / bars, 2 * (bars + 1)
        k = EI / h**3 * np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                                  [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]])
        K = np.zeros((N, N))
        for e in range(bars):
            K[2 * e:2 * e + 4, 2 * e:2 * e + 4] += k
        self.EI, self.n, self.x = EI, n, np.arange(bars + 1) * h
        self.m = np.full(bars + 1, rhoA * h)
        self.m[[0, -1]] /= 2
        t = np.arange(2, N, 2)
        S = -np.linalg.solve(K[np.ix_(t + 1, t + 1)], K[np.ix_(t + 1, t)])
        w, V = eigh(K[np.ix_(t, t)] + K[np.ix_(t, t + 1)] @ S, np.diag(self.m[1:]))
        full = np.zeros((N, n))
        full[t], full[t + 1] = V[:, :n], S @ V[:, :n]
        self.w, self.phi = w[:n], full[::2]
        s, weight = np.polynomial.legendre.leggauss(4)
        s, self.ds = (s + 1) / 2, weight / 2 * h
        slope = np.array([(6 * s * s - 6 * s) / h, 1 - 4 * s + 3 * s * s, (6 * s - 6 * s * s) / h, 3 * s * s - 2 * s]).T
        curvature = np.array([(12 * s - 6) / h**2, (6 * s - 4) / h, (6 - 12 * s) / h**2, (6 * s - 2) / h]).T
        self.slope = np.array([slope @ full[2 * e:2 * e + 4] for e in range(bars)])  # bars x 4 x n
        self.curvature = np.array([curvature @ full[2 * e:2 * e + 4] for e in range(bars)])
        self.g = self.add_up(-np.einsum("q,eqi,eqj->eij", self.ds, self.slope, self.slope))
        c = self.m @ self.x / self.m.sum()
        e = self.m @ (self.x - c) ** 2
        self.f = np.array([np.full(bars + 1, self.m.sum() ** -0.5), (self.x - c) / np.sqrt(e)])
        self.c = np.einsum("ak,k,kij->aij", self.f, self.m, self.g)
        self.QW = (1 - 0.5 / (1 + THIN)) / ((1 + THIN) * np.sqrt(e))

    @staticmethod
    def add_up(per_bar):
        return np.concatenate([np.zeros_like(per_bar[:1]), np.cumsum(per_bar, axis=0)])

    def shorten(self, kind, eta, rate):
        """u_x, its derivatives by eta (K x n), its second time derivative at constant rates."""
        if kind == "whole":
            G = self.g @ eta
            return 0.5 * G @ eta, G, (self.g @ rate) @ rate
        if kind == "exact":  # u2 + u4
            s, r = self.slope @ eta, self.slope @ rate
            return (self.add_up(-(0.5 * s**2 + 0.125 * s**4) @ self.ds),
                    self.add_up(-np.einsum("q,eq,eqn->en", self.ds, s + 0.5 * s**3, self.slope)),
                    self.add_up(-(r**2 * (1 + 1.5 * s**2)) @ self.ds))
        G = self.c @ eta
        a, b, d = 0.5 * G @ eta, G @ rate, (self.c @ rate) @ rate
        QW = self.QW if kind == "square" else 0.0
        A, Y, D = a.copy(), G.copy(), d.copy()
        A[1] -= QW * (a @ a)
        Y[1] -= 2 * QW * (a @ G)
        D[1] -= 2 * QW * (a @ d + b @ b)
        return A @ self.f, self.f.T @ Y, D @ self.f

    def tip(self, eta, rate):
        """The node itself: the second order of its locator, whatever the kinetic energy has."""
        G = self.g[-1] @ eta
        return 0.5 * G @ eta, G, (self.g[-1] @ rate) @ rate


def swing(modes, kind, tip_mass=0.05, gravity=9.81, tolerance=1e-10):
    beam = Beam(modes, 16, 1.0, 2.4, 0.27)
    n, K = beam.n, len(beam.x)
    masses = np.concatenate([beam.m, [0.0], beam.m, [tip_mass]])

    def place(angle, rate, eta, eta_rate):
        u, U, v = (np.concatenate([a, [b]]) for a, b in zip(beam.shorten(kind, eta, eta_rate), beam.tip(eta, eta_rate)))
        y = np.vstack([beam.phi, beam.phi[-1]])
        X, Y, X_rate, Y_rate = np.append(beam.x, beam.x[-1]) + u, y @ eta, U @ eta_rate, y @ eta_rate
        c, s = np.cos(angle), np.sin(angle)
        R = np.array([[c, -s], [s, c]])
        J = np.concatenate([(R @ [-Y, X])[:, :, None], np.einsum("ab,bkn->akn", R, [U, y])], axis=2)
        rest = R @ (np.array([v, 0 * v]) - rate**2 * np.array([X, Y]) + 2 * rate * np.array([-Y_rate, X_rate]))
        return R @ [X, Y], J, rest

    def calc_rate(_, state):
        q, u = state.reshape(2, 2, n + 1)
        J = np.zeros((2, 2 * K + 2, 2 * n + 2))
        rest = np.zeros((2, 2 * K + 2))
        for i in range(2):
            _, J_i, rest_i = place(q[i, 0], u[i, 0], q[i, 1:], u[i, 1:])
            J[:, i * (K + 1):(i + 1) * (K + 1), i * (n + 1):(i + 1) * (n + 1)] = J_i
            rest[:, i * (K + 1):(i + 1) * (K + 1)] = rest_i
        J[:, K + 1:] += J[:, K:K + 1]  # the second link hangs on the first one's end
        rest[:, K + 1:] += rest[:, K:K + 1]
        rest[1] += gravity
        J = J.reshape(-1, 2 * n + 2)
        MJ = J.T * np.tile(masses, 2)
        force = -(MJ @ rest.ravel())
        for i in range(2):
            force[i * (n + 1) + 1:(i + 1) * (n + 1)] -= beam.w * q[i, 1:]
        return np.concatenate([u.ravel(), np.linalg.solve(MJ @ J, force)])

    end = solve_ivp(calc_rate, (0, 1), np.zeros(4 * n + 4), method="DOP853", rtol=tolerance, atol=1e-2 * tolerance).y[:, -1]
    q = end[:2 * n + 2].reshape(2, n + 1)
    return sum(place(a[0], 0.0, a[1:], 0 * a[1:])[0][:, -1] for a in q)


def spin(modes, kind, length, EI, rhoA, rate, duration=15.0):
    """Smallest tip deflection, its time, half the span of what swings on after `duration`."""
    beam = Beam(modes, 40, length, EI, rhoA)
    n, m = beam.n, beam.m

    def calc_rate(t, state):
        eta, eta_rate = state[:n], state[n:]
        s = 2 * np.pi / duration
        omega, alpha = (rate / duration * (t - np.sin(s * t) / s), rate / duration * (1 - np.cos(s * t))) \
            if t < duration else (rate, 0.0)
        u, U, v = beam.shorten("exact" if kind == "fourth" else kind, eta, eta_rate)
        X, Y, X_rate, Y_rate = beam.x + u, beam.phi @ eta, U @ eta_rate, beam.phi @ eta_rate
        ax = -omega**2 * X - 2 * omega * Y_rate - alpha * Y + v
        ay = -omega**2 * Y + 2 * omega * X_rate + alpha * X
        force = -U.T @ (m * ax) - beam.phi.T @ (m * ay) - beam.w * eta
        if kind == "fourth":
            s, c = beam.slope @ eta, beam.curvature @ eta
            force -= beam.EI * np.einsum("q,eqn->n", beam.ds, (c * s**2)[:, :, None] * beam.curvature +
                                         (c**2 * s)[:, :, None] * beam.slope)
        mass = U.T @ (m[:, None] * U) + beam.phi.T @ (m[:, None] * beam.phi)
        return np.concatenate([eta_rate, np.linalg.solve(mass, force)])

    t = np.arange(0, 20.005, 0.01)
    y = solve_ivp(calc_rate, (0, 20), np.zeros(2 * n), method="DOP853", rtol=1e-8, atol=1e-11, t_eval=t).y
    tip = beam.phi[-1] @ y[:n]
    late = tip[t >= duration - 1e-9]
    return tip.min(), t[tip.argmin()], (late.max() - late.min()) / 2


if __name__ == "__main__":
    if sys.argv[1] == "links":
        for modes in map(int, sys.argv[2:]):
            for kind in ("whole", "affine", "square"):
                print(f"{modes} modes, {kind}: tip at 1 s (%.7f, %.7f)" % tuple(swing(modes, kind)), flush=True)
    else:
        for name, beam in {"ex01": (8, 6.895e10 * 8.2181e-9, 1.6154 / 8, 4.0), "second": (10, 1.4e4, 1.2, 6.0)}.items():
            for kind in ("whole", "affine", "square", "exact", "fourth"):
                print(f"{name}, 3 modes, {kind}: smallest %.6f at %.2f s, residual %.4e" % spin(3, kind, *beam), flush=True)
