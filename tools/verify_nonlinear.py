"""Statics with large displacements: the elastica, a cantilever that rolls to a circle, and the bend of 45 degrees.

Bathe & Bolourchi, IJNME 14 (1979) 961: radius 100, square section of 1, E = 1e7, nu = 0, end force 600 across the plane.
Its reference here is the rod with exact rotations and axial strain (no shear, as the elements); they print 47.2, 15.9,
53.4 for straight elements.
"""
import math
import os

import h5py
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

HEAD = "SOL 106\nCEND\nSPC = 1\nLOAD = 1\nBEGIN BULK\nPARAM,LGDISP,1\nSPC1,1,123456,1\n"


def solve(bough, folder, points, section, load):
    """Displacements of the last of CBARs along `points`; section: E, G, A, I, J."""
    E, G, area, inertia, polar = section
    text = HEAD + f"MAT1,1,{E:.6e},{G:.6e}\nPBAR,1,1,{area},{inertia:.8e},{inertia:.8e},{polar:.8e}\n"
    for k, x in enumerate(points):
        text += f"GRID*   {k + 1:<16d}{'':16s}{x[0]:<16.9e}{x[1]:<16.9e}\n*       {x[2]:<16.9e}\n"
    for k in range(1, len(points)):
        text += f"CBAR,{k},1,{k},{k + 1},0.,0.,1.\n"
    with open(os.path.join(folder, "bars.bdf"), "w") as f:
        f.write(text + load + "ENDDATA\n")
    bough(folder, "static", "bars.bdf", "-o", "bars.h5")
    with h5py.File(os.path.join(folder, "bars.h5")) as f:
        return f["/subcases/0/displacement"][-6:]


def calc_elastica(alpha):
    """w/L and u/L of the end under P = alpha EI/L² (Bisshopp & Drucker 1945)."""
    phi = lambda m: math.asin(1 / math.sqrt(2 * m))
    m = brentq(lambda m: ellipk(m) - ellipkinc(phi(m), m) - math.sqrt(alpha), 0.5 + 1e-14, 1 - 1e-14)
    return 1 - 2 * (ellipe(m) - ellipeinc(phi(m), m)) / math.sqrt(alpha), 1 - math.sqrt(2 / alpha * (2 * m - 1))


def calc_bend(radius, angle, section, force):
    """Place of the end of an arc in the x-y plane that starts along x, held there, under a force along z."""
    E, G, area, inertia, polar = section
    n = np.array([0, 0, force])
    compliance = np.array([1 / (G * polar), 1 / (E * inertia), 1 / (E * inertia)])

    def slope(s, state, end):
        r, R = state[:3], state[3:].reshape(3, 3)          # columns: tangent, two normals
        curvature = R @ (compliance * (R.T @ np.cross(end - r, n)) + [0, 0, 1 / radius])
        return np.concatenate([R[:, 0] * (1 + R[:, 0] @ n / (E * area)), np.cross(curvature, R.T).T.ravel()])

    def miss(end):
        start = np.concatenate([np.zeros(3), np.eye(3).ravel()])
        return solve_ivp(slope, [0, radius * angle], start, args=(end,), method="DOP853", rtol=1e-11, atol=1e-11).y[:3, -1] - end

    end = radius * np.array([math.sin(angle), 1 - math.cos(angle), 0])
    for share in np.linspace(0.2, 1, 5):
        n = np.array([0, 0, share * force])
        end = fsolve(miss, end, xtol=1e-12)
    return end


def verify(bough, folder, add):
    line = lambda number, length: np.outer(np.linspace(0, length, number + 1), [1, 0, 0])
    stiff = (1e9, 5e8, 1e3, 1e-5, 2e-5)     # EA = 1e12, EI = 1e4
    u = solve(bough, folder, line(10, 10), (1e9, 5e8, 1, 1e-5, 2e-5),
              f"SPC1,1,345,2,THRU,11\nMOMENT,1,11,,{2e3 * math.pi:.14e},0.,0.,1.\n")
    add("cantilever rolled to a circle, 10 CBAR", "end from clamp / L", np.hypot(u[0] + 10, u[1]) / 10, 1e-8, None, "closed form")
    for alpha in (1, 4, 10):
        u = solve(bough, folder, line(20, 1), stiff, f"FORCE,1,21,,{alpha * 1e4},0.,0.,1.\n")
        w, shortening = calc_elastica(alpha)
        for what, value, exact in (("w / L", u[2], w), ("u / L", -u[0], shortening)):
            add(f"cantilever, P L² / EI = {alpha}, 20 CBAR", what, value, exact, 1e-5, "elliptic integrals")
    section = (1e7, 5e6, 1, 1 / 12, 0.1408333)
    exact = calc_bend(100, math.pi / 4, section, 600)
    for number, tolerance in ((8, 1.5e-2), (64, 2e-4)):
        turn = np.linspace(0, math.pi / 4, number + 1)
        points = 100 * np.array([np.sin(turn), 1 - np.cos(turn), 0 * turn]).T
        u = solve(bough, folder, points, section, f"FORCE,1,{number + 1},,600.,0.,0.,1.\n")
        for axis in range(3):
            add(f"bend of 45°, {number} CBAR", f"end {'xyz'[axis]}", points[-1][axis] + u[axis], exact[axis], tolerance,
                "rod with exact rotations")
