#!/usr/bin/python3
"""Beams as chains of inextensible pieces that turn without limit: python3 hermite_chain.py [spin] PIECES ...

Two links under gravity, those of tests/cases/two_link_modes_test.cpp; with `spin`, the second beam of
tests/cases/spinup_test.cpp on its turning hub. Chord angles psi are the coordinates; each piece bends as a cubic beam,
(2 EI/h)(a^2 + a b + b^2) with a, b the slopes of its ends less psi, and the slopes, which have no mass, are eliminated.
Masses at the nodes: rho A h, half at the tip, and the tip mass.
"""
import os
import sys

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support"))
from planar_chain import swing  # noqa: E402


def make_bending(n, h, EI, clamped=False):
    K = np.zeros((2 * n + 1, 2 * n + 1))  # psi (n), slopes (n + 1)
    k = 2 * EI / h * np.array([[2.0, 1.0], [1.0, 2.0]])
    for e in range(n):
        B = np.zeros((2, 2 * n + 1))
        B[:, e] = -1
        B[0, n + e] = B[1, n + e + 1] = 1
        K += B.T @ k @ B
    if clamped:  # the first slope is zero
        K = np.delete(np.delete(K, n, axis=0), n, axis=1)
    return K[:n, :n] - K[:n, n:] @ np.linalg.solve(K[n:, n:], K[n:, :n])


def simulate(pieces, times, length=1.0, rhoA=0.27, EI=2.4, tip=0.05, g=9.81):
    n, h = 2 * pieces, length / pieces
    node = np.full(n, rhoA * h)
    node[-1] = rhoA * h / 2 + tip
    a = h * np.tril(np.ones((n, n)))
    c = a.T @ np.diag(node) @ a
    weight = g * (node @ a)
    K = np.zeros((n, n))
    K[:pieces, :pieces] = K[pieces:, pieces:] = make_bending(pieces, h, EI)

    psi = swing(c, weight, K, times, rtol=1e-9, atol=1e-11)
    return h * np.cos(psi).sum(axis=0), h * np.sin(psi).sum(axis=0)


def spin(n, length=10.0, rhoA=1.2, EI=1.4e4, rate=6.0, duration=15.0):
    """Smallest deflection in the hub's frame and half the span of what swings on from `duration` to 20 s."""
    h = length / n
    node = np.full(n, rhoA * h)
    node[-1] /= 2
    a = h * np.tril(np.ones((n, n)))
    c = a.T @ np.diag(node) @ a
    K = make_bending(n, h, EI, clamped=True)

    def angle(t):
        s = 2 * np.pi / duration
        return np.where(t < duration, rate / duration * (t**2 / 2 + (np.cos(s * t) - 1) / s**2), rate * (t - duration / 2))

    def derivative(t, state):
        psi, omega = state[:n], state[n:]
        d = psi[:, None] - psi[None, :]
        force = -K @ (psi - angle(t)) - (c * np.sin(d)) @ omega**2
        return np.concatenate([omega, np.linalg.solve(c * np.cos(d), force)])

    times = np.arange(0, 20.0001, 0.01)
    solution = solve_ivp(derivative, (0, 20), np.zeros(2 * n), method="DOP853", t_eval=times, rtol=1e-8, atol=1e-10)
    v = h * np.sin(solution.y[:n] - angle(times)).sum(axis=0)
    late = v[times >= duration - 1e-9]
    return v.min(), (late.max() - late.min()) / 2


if __name__ == "__main__":
    if sys.argv[1] == "spin":
        for pieces in [int(word) for word in sys.argv[2:]]:
            print("%d pieces: smallest deflection %.6f, residual %.6f" % (pieces, *spin(pieces)))
        sys.exit()
    for pieces in [int(word) for word in sys.argv[1:]]:
        x, y = simulate(pieces, np.array([1.0]))
        print(f"{pieces} pieces a link: tip at 1 s ({x[-1]:.8f}, {y[-1]:.8f})")
