"""Chains of rigid pieces in a vertical plane, in absolute angles; and one as a system of Bough."""
import numpy as np
from scipy.integrate import solve_ivp

from toml_text import table


def swing(c, weight, stiffness, times, rtol, atol):
    """Angles (n, nt) from rest at zero of

        sum_j c_ij [cos(th_i - th_j) th_j'' + sin(th_i - th_j) th_j'^2] = -weight_i cos(th_i) - (stiffness th)_i
    """
    n = len(c)

    def rate(_, state):
        theta, omega = state[:n], state[n:]
        difference = theta[:, None] - theta[None, :]
        force = -weight * np.cos(theta) - stiffness @ theta - (c * np.sin(difference)) @ omega**2
        return np.concatenate([omega, np.linalg.solve(c * np.cos(difference), force)])

    return solve_ivp(rate, (0, times[-1]), np.zeros(2 * n), method="DOP853", t_eval=times, rtol=rtol, atol=atol).y[:n]


def write_segments(number, h, mass, spin_inertia, EI, beta, parent=None):
    """Bodies s0, s1, ... of length h on hinges j0, j1, ...: springs EI/h with damping beta EI/h, none at the first.

    The first is attached to ground, or to node 1 of `parent`.
    """
    text = ""
    for i in range(number):
        inertia = [spin_inertia, mass * h * h / 12, mass * h * h / 12]
        before = {"parent": f"s{i - 1}" if i else parent, "parent_node": 1} if i or parent else {}
        spring = {"stiffness": EI / h, "damping": beta * EI / h} if i else {}
        text += table("body", f"s{i}", mass=mass, cg=[h / 2, 0.0, 0.0], inertia=inertia,
                      nodes=[{"id": 1, "position": [h, 0.0, 0.0]}])
        text += table("hinge", f"j{i}", "revolute", **before, child=f"s{i}", **spring)
    return text


def name_sensor(name, body, node):
    """A sensor of the place of a node."""
    return table("sensor", name, "position", body=body, node=node)
