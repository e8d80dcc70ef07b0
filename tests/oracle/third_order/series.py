"""Truncated power series in one variable ε: arrays whose first axis is the order 0..N. Rotations of series that vanish
at ε = 0: exact to the last order kept."""
import numpy as np


def multiply(spec, a, b):
    """np.einsum(spec, a, b) of two series."""
    out = [None] * len(a)
    for k in range(len(a)):
        for i in range(k + 1):
            if not (a[i].any() and b[k - i].any()):
                continue
            term = np.einsum(spec, a[i], b[k - i])
            out[k] = term if out[k] is None else out[k] + term
    zero = np.zeros_like(next((o for o in out if o is not None), np.einsum(spec, a[0], b[0])))
    return np.array([zero if o is None else o for o in out])


def dot(a, b):
    return multiply("...i,...i->...", a, b)


def cross(a, b):
    c = np.zeros_like(a + b)
    for k in range(len(a)):
        for i in range(k + 1):
            c[k] += np.cross(a[i], b[k - i])
    return c


def skew(v):
    zero = np.zeros_like(v[..., 0])
    return np.stack([np.stack([zero, -v[..., 2], v[..., 1]], -1), np.stack([v[..., 2], zero, -v[..., 0]], -1),
                     np.stack([-v[..., 1], v[..., 0], zero], -1)], -2)


def polynomial(coefficients, z):
    """Σ c_i z^i of a scalar series z."""
    out = np.zeros_like(z)
    out[0] = coefficients[-1]
    for c in coefficients[-2::-1]:
        out = multiply("...,...->...", out, z)
        out[0] += c
    return out


# sin t/t, (1 - cos t)/t², (t - sin t)/t³ and 1/t² - cot(t/2)/(2t) in powers of t². The last is of T⁻¹.
SINC = (1, -1 / 6, 1 / 120, -1 / 5040)
VERSINE = (1 / 2, -1 / 24, 1 / 720, -1 / 40320)
THIRD = (1 / 6, -1 / 120, 1 / 5040, -1 / 362880)
INVERSE = (1 / 12, 1 / 720, 1 / 30240, 1 / 1209600)
# asin(s)/s in powers of s²
ARCSINE = (1, 1 / 6, 3 / 40, 5 / 112)


def combine(first, second, theta):
    """I + first(|θ|²) θ~ + second(|θ|²) θ~²."""
    t2, S = dot(theta, theta), skew(theta)
    sum_of = multiply("...,...ij->...ij", polynomial(first, t2), S)
    sum_of += multiply("...,...ij->...ij", polynomial(second, t2), multiply("...ij,...jk->...ik", S, S))
    sum_of[0] += np.eye(3)
    return sum_of


def rotate(theta):
    """R = exp(θ~)."""
    return combine(SINC, VERSINE, theta)


def rotation_vector(R):
    """θ of R = exp(θ~): R - Rᵀ = 2 (sin t/t) θ~."""
    axis = 0.5 * np.stack([R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]], -1)
    s2 = dot(axis, axis)
    return multiply("...,...i->...i", polynomial(ARCSINE, s2), axis)


def spin_map(theta):
    """T of the spatial spin δφ = T(θ) δθ, R = exp(θ~)."""
    return combine(VERSINE, THIRD, theta)


def inverse_spin_map(theta):
    t2, S = dot(theta, theta), skew(theta)
    T = -0.5 * S + multiply("...,...ij->...ij", polynomial(INVERSE, t2), multiply("...ij,...jk->...ik", S, S))
    T[0] += np.eye(3)
    return T


def polar_rotation(B, solve):
    """R of the polar decomposition of a series B whose first term is symmetric, and H = Rᵀ B, which is symmetric.
    solve: the rotation vector of an axial part of H, by the first term of B."""
    R = np.zeros_like(B)
    R[0] = np.eye(3)
    for _ in range(len(B) - 1):                      # one order more each time
        H = multiply("...ji,...jk->...ik", R, B)
        axis = np.stack([H[..., 2, 1] - H[..., 1, 2], H[..., 0, 2] - H[..., 2, 0], H[..., 1, 0] - H[..., 0, 1]], -1)
        axis[0] = 0
        R = multiply("...ij,...jk->...ik", R, rotate(solve(axis)))
    return R, multiply("...ji,...jk->...ik", R, B)
