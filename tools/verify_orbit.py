"""Tethers and booms in the gravity gradient: librations and vibrations in the rotating frame of a circular orbit."""
import math

import numpy as np
import scipy.integrate
from scipy.optimize import brentq

from toml_text import section, table, toml
from verify_flight import Bench, reduce_beam

MU, RADIUS = 3.986004418e14, 6.878e6
RATE = math.sqrt(MU / RADIUS**3)


def make_orbit(*tables):
    """Bodies in the frame lvlh: x up, z along the orbit's normal."""
    return toml(table("body", "lvlh", mass=1.0, inertia=[1.0, 1.0, 1.0]),
                table("function", "orbit", "ramp", value=1e4 * RATE, **{"from": 0.0, "to": 1e4}),
                table("hinge", "turn", "revolute", child="lvlh", motion="orbit"), *tables,
                section("simulation", duration=1000.0, start=10.0))


def verify_tether(b):
    """Equal masses on massless rods, h apart, hung from a satellite at the origin of the frame.

    The tension between masses j and j + 1 of N is 3/2 n² m h (N(N + 1) - j(j + 1)), for which the deflections are
    discrete Legendre polynomials of odd degree k: ω² = 3/2 k(k + 1) n² in the plane and n² more across, for any number
    of masses and for a uniform tether (Beletsky & Levin, Dynamics of Space Tether Systems, 1993). The lengths are
    2e-6 of the radius.
    """
    for count, degrees in ((1, (1,)), (6, (1, 3, 5, 7))):
        h = 15.0 / count
        names = ["lvlh", *(f"mass{j}" for j in range(1, count + 1))]
        poles = b.linearize(make_orbit(
            *(table("body", name, mass=4.0, cg=[h, 0.0, 0.0]) for name in names[1:]),
            *(table("hinge", f"link{j}", "universal", parent=names[j - 1], child=names[j], axis=[0.0, 0.0, 1.0],
                    axis2=[0.0, 1.0, 0.0], parent_position=[RADIUS if j == 1 else h, 0.0, 0.0])
              for j in range(1, count + 1)),
            table("force", "earth", "gravity_central", mu=MU, bodies=names[1:])))
        case = "dumbbell in orbit" if count == 1 else f"tether of {count} masses in orbit"
        for k in degrees:
            for what, more in (("in the plane", 0), ("across", 1)):
                exact = math.sqrt(1.5 * k * (k + 1) + more)
                b.add(case, f"libration {what} / orbital rate" if k == 1 else f"mode {(k + 1) // 2} {what} / orbital rate",
                      b.nearest(poles, 1j * exact * RATE).imag / RATE, exact, 1e-5,
                      "closed form: sqrt(3), 2" if k == 1 else "closed form, Legendre polynomials")


LENGTH, DENSITY, TIP, HUB, BENDING = 20.0, 0.05, 3.0, 400.0, 0.5


def calc_boom(is_across):
    """ω / n of the lowest two motions: beam under the tension of the tide, on a hub that turns, a mass at its tip."""
    def shoot(ratio):
        square, hub_square = (ratio**2 - is_across) * RATE**2, (ratio * RATE)**2

        def slope(x, s):  # w, w', M = EI w'', V = M' - T w'
            tension = 3 * RATE**2 * (DENSITY * (LENGTH**2 - x**2) / 2 + TIP * LENGTH)
            return [s[1], s[2] / BENDING, s[3] + tension * s[1], DENSITY * square * s[0]]

        def miss(start):
            end = scipy.integrate.solve_ivp(slope, (0, LENGTH), start, rtol=1e-10, atol=1e-13, method="DOP853").y[:, -1]
            return end[2], end[3] + TIP * square * end[0]
        (a, c), (d, e) = miss([0, 1, -HUB * hub_square, 0]), miss([0, 0, 0, 1])
        return a * e - c * d
    grid = np.linspace(0.5, 20, 80)
    values = [shoot(x) for x in grid]
    return [brentq(shoot, x, y, xtol=1e-11) for x, y, v, w in zip(grid, grid[1:], values, values[1:]) if v * w < 0][:2]


def verify_boom(b):
    """Gravity-gradient boom of a deck: its bending lowers the libration, the tension of the tide stiffens it."""
    reduce_beam(b, "boom", LENGTH, 345, [f"MAT1,1,1.+4,1.+4,,{DENSITY!r}", f"CONM2,101,41,,{TIP!r}",
                                         f"PBAR,1,1,1.,{BENDING * 1e-4!r},{BENDING * 1e-4!r},1."])
    for is_across, what, axis in ((0, "in the plane", [0.0, 0.0, 1.0]), (1, "across", [0.0, 1.0, 0.0])):
        poles = b.linearize(make_orbit(
            table("body", "hub", mass=1.0, inertia=[HUB] * 3), table("body", "boom", file="boom.h5"),
            table("hinge", "axis", "revolute", parent="lvlh", child="hub", axis=axis, parent_position=[RADIUS, 0.0, 0.0]),
            table("hinge", "root", "fixed", parent="hub", child="boom", child_node=1,
                  parent_rotation_deg=[90.0 * is_across, 0.0, 0.0]),
            table("force", "earth", "gravity_central", mu=MU)))
        for name, exact in zip(("libration", "bending"), calc_boom(is_across)):
            b.add("gravity-gradient boom with a tip mass", f"{name} {what} / orbital rate",
                  b.nearest(poles, 1j * exact * RATE).imag / RATE, exact, 1e-5, "beam under tension, by scipy")


def verify(bough, folder, add):
    bench = Bench(bough, folder, add)
    verify_tether(bench)
    verify_boom(bench)
