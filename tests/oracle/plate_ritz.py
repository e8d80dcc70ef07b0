"""Rayleigh-Ritz with Legendre polynomials for plates, membranes and thick blocks: an oracle apart from Bough.

The domain is the image of -1 <= xi, eta <= 1 under a bilinear map; the displacement is a sum of products of Legendre
polynomials, times a factor that makes it vanish on held edges. Every stiffness and mass is integrated by Gauss points,
so the frequencies are upper bounds that fall with the number of polynomials.

    /usr/bin/python3 tests/oracle/plate_ritz.py      prints what the tests of plates are held to, by number of terms
"""
import math

import numpy as np
from numpy.polynomial import legendre


def calc_basis(num, points, factor, derivatives):
    """factor(x) P_i(x), i < num, scaled, and derivatives: [derivative] of num x points; factor a Legendre series."""
    series = [legendre.legmul(factor, [0] * i + [1]) for i in range(num)]
    rows = []
    for k in range(derivatives + 1):
        rows.append(np.array([legendre.legval(points, legendre.legder(s, k) if k else s) for s in series]))
    scale = np.sqrt(legendre.leggauss(num + len(factor))[1] @ np.array(
        [legendre.legval(legendre.leggauss(num + len(factor))[0], s)**2 for s in series]).T)
    return [row / scale[:, None] for row in rows]


def calc_factor(held, order):
    """(1 + x)^order on the side "-", (1 - x)^order on the side "+", as a Legendre series."""
    factor = [1.0]
    for side in held:
        for _ in range(order):
            factor = legendre.legmul(factor, [1.0, 1.0 if side == "-" else -1.0])
    return factor


def calc_eigenvalues(K, M, num):
    """The lowest eigenvalues of K - lambda M, by the Cholesky factor of M."""
    L = np.linalg.inv(np.linalg.cholesky((M + M.T) / 2))
    return np.linalg.eigvalsh(L @ ((K + K.T) / 2) @ L.T)[:num]


class Patch:
    """Gauss points of the bilinear quadrilateral with `corners` (4 x 2, in order), and Ritz functions on it."""

    def __init__(self, corners, num):
        gauss, weight = legendre.leggauss(num + 4)
        self.gauss, self.num = gauss, num
        a, b = [g.ravel() for g in np.meshgrid(gauss, gauss, indexing="ij")]
        sign = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        corners = np.asarray(corners, float)
        d_a = 0.25 * (sign[:, 0, None] * (1 + sign[:, 1, None] * b)).T @ corners
        d_b = 0.25 * (sign[:, 1, None] * (1 + sign[:, 0, None] * a)).T @ corners
        self.jacobian = np.stack([d_a, d_b], axis=2)  # point, x or y, xi or eta
        self.inverse = np.linalg.inv(self.jacobian)  # point, xi or eta, x or y
        self.weight = np.kron(weight, weight) * np.linalg.det(self.jacobian)

    def calc_values(self, held, order, derivatives):
        """{(i, j): functions x points} of d^i/dxi^i d^j/deta^j; held = sides of xi and of eta, each some of "-+"."""
        along = [calc_basis(self.num, self.gauss, calc_factor(side, order), derivatives) for side in held]
        return {(i, j): np.einsum("ap,bq->abpq", along[0][i], along[1][j]).reshape(self.num**2, -1)
                for i in range(derivatives + 1) for j in range(derivatives + 1 - i)}

    def calc_gradient(self, values):
        """d/dx and d/dy of the functions."""
        return [values[1, 0] * self.inverse[:, 0, k] + values[0, 1] * self.inverse[:, 1, k] for k in range(2)]

    def integrate(self, left, right):
        return (left * self.weight) @ right.T


def calc_kirchhoff(corners, held, order, num, modes, nu=0.3):
    """rho t omega^2 / D of the lowest modes of a thin parallelogram.

    held: which sides "-+" of xi and of eta; order: 1 holds w there, 2 the slope too."""
    patch = Patch(corners, num)
    v = patch.calc_values(held, order, 2)
    G = patch.inverse[0]
    hessian = {}
    for k, l in ((0, 0), (0, 1), (1, 1)):
        hessian[k, l] = (G[0, k] * G[0, l] * v[2, 0] + (G[0, k] * G[1, l] + G[1, k] * G[0, l]) * v[1, 1]
                         + G[1, k] * G[1, l] * v[0, 2])
    xx, xy, yy = hessian[0, 0], hessian[0, 1], hessian[1, 1]
    K = patch.integrate(xx, xx + nu * yy) + patch.integrate(yy, yy + nu * xx) + 2 * (1 - nu) * patch.integrate(xy, xy)
    return calc_eigenvalues(K, patch.integrate(v[0, 0], v[0, 0]), modes)


def calc_mindlin(corners, held, num, modes, E, nu, rho, t, kappa=5 / 6, tangential_held=False):
    """omega^2 of a plate with transverse shear and rotary inertia. On the held sides w and both rotations vanish; with
    `tangential_held` (sides along x and y) only w and the rotation that would shear the side: simply supported."""
    patch = Patch(corners, num)
    w = patch.calc_values(held, 1, 1)
    along_x = patch.calc_values(("", held[1]) if tangential_held else held, 1, 1)
    along_y = patch.calc_values((held[0], "") if tangential_held else held, 1, 1)
    (wx, wy), (xx, xy), (yx, yy) = [patch.calc_gradient(v) for v in (w, along_x, along_y)]
    x, y = along_x[0, 0], along_y[0, 0]
    D, S, n = E * t**3 / 12 / (1 - nu**2), kappa * t * E / 2 / (1 + nu), num**2
    K, M, I = np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 3 * n)), patch.integrate
    W, X, Y = slice(0, n), slice(n, 2 * n), slice(2 * n, 3 * n)  # w, and the rotations: gamma = grad w + (X, Y)
    K[W, W] = S * (I(wx, wx) + I(wy, wy))
    K[W, X], K[W, Y] = S * I(wx, x), S * I(wy, y)
    K[X, W], K[Y, W] = K[W, X].T, K[W, Y].T
    twist = D * (1 - nu) / 2
    K[X, X] = D * I(xx, xx) + twist * I(xy, xy) + S * I(x, x)
    K[Y, Y] = D * I(yy, yy) + twist * I(yx, yx) + S * I(y, y)
    K[X, Y] = nu * D * I(xx, yy) + twist * I(xy, yx)
    K[Y, X] = K[X, Y].T
    M[W, W] = rho * t * I(w[0, 0], w[0, 0])
    M[X, X], M[Y, Y] = rho * t**3 / 12 * I(x, x), rho * t**3 / 12 * I(y, y)
    return calc_eigenvalues(K, M, modes)


def calc_membrane(corners, held, num, modes, E, nu, rho):
    """omega^2 of plane stress, both displacements zero on the held sides."""
    patch = Patch(corners, num)
    u = patch.calc_values(held, 1, 1)
    ux, uy = patch.calc_gradient(u)
    I, c = patch.integrate, E / (1 - nu**2)
    shear = c * (1 - nu) / 2
    K = np.block([[c * I(ux, ux) + shear * I(uy, uy), c * nu * I(ux, uy) + shear * I(uy, ux)],
                  [c * nu * I(uy, ux) + shear * I(ux, uy), c * I(uy, uy) + shear * I(ux, ux)]])
    return calc_eigenvalues(K, np.kron(np.eye(2), rho * I(u[0, 0], u[0, 0])), modes)


def calc_block(corners, held, num, through, modes, E, nu, rho, t, bending=True, in_plane_held=True):
    """omega^2 of a solid of thickness t, its modes antisymmetric (bending) or symmetric to the middle plane.

    The side faces held have w = 0 and, if asked, u = v = 0. `through`: terms of u, v and of w across the thickness."""
    patch = Patch(corners, num)
    w = patch.calc_values(held, 1, 1)
    u = patch.calc_values(held if in_plane_held else ("", ""), 1, 1)
    gauss, weight = legendre.leggauss(2 * through + 4)
    across = calc_basis(2 * through + 1, gauss, [1.0], 1)
    odd, even = [[a[first:2 * through:2] for a in across] for first in (1, 0)]
    zu, zw = (odd, even) if bending else (even, odd)
    lame, G = E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu)
    fields = [(u, zu), (u, zu), (w, zw)]

    def differentiate(field, k):
        plane, z = fields[field]
        return (patch.calc_gradient(plane)[k], z[0]) if k < 2 else (plane[0, 0], z[1] * 2 / t)

    def integrate(left, right):
        return np.kron((left[1] * weight * t / 2) @ right[1].T, patch.integrate(left[0], right[0]))

    d = [[differentiate(i, k) for k in range(3)] for i in range(3)]
    K = [[None] * 3 for _ in range(3)]
    for i in range(3):
        for j in range(3):
            K[i][j] = lame * integrate(d[i][i], d[j][j]) + G * integrate(d[i][j], d[j][i])
            if i == j:
                K[i][j] = K[i][j] + G * sum(integrate(d[i][k], d[i][k]) for k in range(3))
    M = [[rho * integrate((fields[i][0][0, 0], fields[i][1][0]), (fields[j][0][0, 0], fields[j][1][0])) if i == j
          else np.zeros_like(K[i][j]) for j in range(3)] for i in range(3)]
    return calc_eigenvalues(np.block(K), np.block(M), modes)


SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
STEEL = {"E": 200e9, "nu": 0.3, "rho": 8000.0}
RHOMB = [(0, 0), (10, 0), (10 + 5 * math.sqrt(2), 5 * math.sqrt(2)), (5 * math.sqrt(2), 5 * math.sqrt(2))]
TAPERED = [(0, -2.5), (10, -0.5), (10, 0.5), (0, 2.5)]
TEN = [(0, 0), (10, 0), (10, 10), (0, 10)]
BOTH = ("-+", "-+")


def calc_hz(eigenvalues):
    return np.sqrt(np.maximum(eigenvalues, 0)) / (2 * math.pi)


def calc_thin_hz(corners, held, order, num, modes, t=0.05):
    rigidity = STEEL["E"] * t**3 / 12 / (1 - STEEL["nu"]**2)
    return calc_hz(calc_kirchhoff(corners, held, order, num, modes) * rigidity / (STEEL["rho"] * t))


CASES = {
    "FV12": lambda n: calc_thin_hz(TEN, ("", ""), 1, n, 11)[3:],
    "FV15": lambda n: calc_thin_hz(RHOMB, BOTH, 2, n, 6),
    "FV16": lambda n: calc_thin_hz(TEN, ("-", ""), 2, n, 6),
    "FV22 Mindlin": lambda n: calc_hz(calc_mindlin(RHOMB, BOTH, n, 6, t=1.0, **STEEL)),
    "FV22 solid": lambda n: calc_hz(calc_block(RHOMB, BOTH, n - 2, 3, 6, t=1.0, **STEEL)),
    "FV32": lambda n: calc_hz(calc_membrane(TAPERED, ("-", ""), n, 6, **STEEL)),
    "FV52 bending, w = 0 on the sides": lambda n: calc_hz(
        calc_block(TEN, BOTH, n - 2, 3, 6, t=1.0, in_plane_held=False, **STEEL)),
    "FV52 in plane": lambda n: calc_hz(calc_block(TEN, ("", ""), n - 4, 2, 8, t=1.0, bending=False, **STEEL))[3:],
}

if __name__ == "__main__":
    for name, calc in CASES.items():
        for num in (12, 16, 20):
            print(f"{name:34s} {num:3d} terms " + " ".join(f"{hz:10.5f}" for hz in calc(num)), flush=True)
