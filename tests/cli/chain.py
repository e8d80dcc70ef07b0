"""A flexible double pendulum in the plane as a chain of rigid pieces on torsion springs: geometrically exact in the limit.

Absolute angles theta_i; piece k of mass m h has its centre at sum_{i<k} h e_i + h/2 e_k. With a_ki = h, h/2 or 0 and
c_ij = sum_k m h a_ki a_kj (+ m h^3/12 on the diagonal):

    sum_j c_ij [cos(th_i - th_j) th_j'' + sin(th_i - th_j) th_j'^2] = -g sum_k m h a_ki cos(th_i) - spring_i

Springs EI/h act between the pieces of one link and none at the hinges.
"""
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from planar_chain import swing  # noqa: E402


def simulate(pieces, length, mass_per_length, EI, g, times):
    """Positions of the end of each link, (nt, 2 links, 2); both links start straight, level and at rest."""
    n, h = 2 * pieces, length / pieces
    a = h * np.tril(np.ones((n, n)), -1) + 0.5 * h * np.eye(n)
    c = mass_per_length * h * (a.T @ a) + mass_per_length * h**3 / 12 * np.eye(n)
    weight = g * mass_per_length * h * a.sum(axis=0)
    spring = np.zeros((n, n))
    for i in range(n - 1):
        if i + 1 != pieces:
            spring[i:i + 2, i:i + 2] += EI / h * np.array([[1.0, -1.0], [-1.0, 1.0]])

    theta = swing(c, weight, spring, times, rtol=1e-8, atol=1e-10)
    x, y = h * np.cumsum(np.cos(theta), axis=0), h * np.cumsum(np.sin(theta), axis=0)
    return np.stack([np.stack([x[k], y[k]], axis=1) for k in (pieces - 1, n - 1)], axis=1)
