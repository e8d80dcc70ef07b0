"""K x = λ M x for symmetric K, M that may both be singular, dense, with an own estimate of what round-off can do.

Cholesky and the triangular solves run in long double, so that the factor loses nothing that the matrices had.
"""
import numpy as np

LONG = np.longdouble
EPS = 2.2e-16


def cholesky(A):
    """Lower factor in long double; None when A is not positive definite."""
    A = A.astype(LONG).copy()
    n = len(A)
    for k in range(n):
        if not A[k, k] > 0:
            return None
        A[k, k] = np.sqrt(A[k, k])
        A[k + 1:, k] /= A[k, k]
        A[k + 1:, k + 1:] -= np.outer(A[k + 1:, k], A[k + 1:, k])
    return np.tril(A)


def solve_lower(L, B):
    X = B.astype(LONG).copy()
    for k in range(len(L)):
        X[k] /= L[k, k]
        X[k + 1:] -= np.outer(L[k + 1:, k], X[k])
    return X


def solve_upper(L, B):
    """Lᵀ X = B."""
    X = B.astype(LONG).copy()
    for k in range(len(L) - 1, -1, -1):
        X[k] /= L[k, k]
        X[:k] -= np.outer(L[k, :k], X[k])
    return X


class Spectrum:
    """lam, X: all finite eigenvalues, ascending, with M-normal vectors; noise: what round-off may do to each.

    num_null: motions with neither strain nor mass (left out of X). grey: why ranks are not certain, or None.
    is_cut: masses near round-off leave in doubt how many there are above these.
    """

    def __init__(self):
        self.lam, self.noise, self.X, self.num_null, self.grey = np.zeros(0), np.zeros(0), None, 0, None
        self.is_cut = False

    def is_zero(self):
        return np.abs(self.lam) <= 10 * self.noise


def split_null(A, size):
    """Orthonormal bases of range and null space of a scaled, semi-definite A; and whether a gap lacks between what
    round-off of the terms (`size`) may leave of each vector's energy and what is more."""
    values, vectors = np.linalg.eigh(A)
    noise = EPS * (np.abs(vectors) * (size @ np.abs(vectors))).sum(0)
    null = np.abs(values) < 30 * noise
    is_grey = bool(np.any((np.abs(values) >= 10 * noise) & (np.abs(values) < 1000 * noise)))
    return vectors[:, ~null], vectors[:, null], is_grey, bool(np.any(values < -1e-11))


def count_rank(M, M_size, with_mass, found):
    """Finite eigenvalues are as many as M has rank, K and M being semi-definite; those that are certain."""
    B = M[np.ix_(with_mass, with_mass)]
    s = 1 / np.sqrt(B.diagonal())
    values = np.linalg.eigvalsh(B * np.outer(s, s))
    noise = EPS * len(s) * (M_size.diagonal()[with_mass] * s * s).max()
    certain = max(1e-9, 1e4 * noise)
    found.is_cut = bool(np.any((values > 10 * noise) & (values < certain)))
    return int((values > (certain if found.is_cut else max(1e-11, 100 * noise))).sum())


def invert(K, M, shift):
    """θ ascending and vectors (A-normal) of M x = θ (K + shift M) x; None when that is not definite."""
    A = K + shift * M
    if not np.all(A.diagonal() > 0):
        return None
    s = 1 / np.sqrt(A.diagonal())
    L = cholesky(A * np.outer(s, s))
    if L is None:
        return None
    half = solve_lower(L, (M * np.outer(s, s)))
    C = solve_lower(L, half.T)
    theta, Y = np.linalg.eigh((0.5 * (C + C.T)).astype(float))
    return theta, (s[:, None] * solve_upper(L, Y)).astype(float), (s, L)


def solve(K, M, K_size, M_size):
    """All finite eigenvalues."""
    found = Spectrum()
    n = len(K)
    found.X = np.zeros((n, 0))
    K, M = 0.5 * (K + K.T), 0.5 * (M + M.T)
    kd, md = K.diagonal(), M.diagonal()
    # an exact zero row says more than any threshold
    M_zero = 1e-13 * M_size.diagonal().max() if n else 0
    with_mass = md > M_zero
    if n == 0 or not with_mass.any():
        return found
    big = max((kd[with_mass] / md[with_mass]).max(), 1e-30)
    if not (kd > 0).any():
        big = 1.0
    A = K + big * M
    ad = A.diagonal()
    alive = ad > 1e-14 * (K_size.diagonal() + big * M_size.diagonal())
    dead = n - int(alive.sum())
    if np.any(ad[alive] < 1e-11 * (K_size.diagonal() + big * M_size.diagonal())[alive]):
        found.grey = "a diagonal near round-off"
    s = np.where(alive, 1 / np.sqrt(np.where(alive, ad, 1)), 0)
    scaled, size = (B[np.ix_(alive, alive)] * np.outer(s, s)[np.ix_(alive, alive)]
                    for B in (A, K_size + big * M_size))
    Q, N, is_grey, is_indefinite = split_null(scaled, size)
    found.num_null = dead + N.shape[1]
    if is_grey:
        found.grey = "the rank of the pencil"
    if is_indefinite:
        found.grey = "the stiffness is not positive semi-definite"
    Z = np.zeros((n, Q.shape[1]))
    Z[alive] = s[alive][:, None] * Q
    if N.shape[1] == 0:      # keep the dofs themselves: products with Q cost digits
        Z = np.zeros((n, len(s[alive])))
        Z[np.flatnonzero(alive), np.arange(Z.shape[1])] = s[alive]
    Kz, Mz = (Z.T.astype(LONG) @ B.astype(LONG) @ Z.astype(LONG) for B in (K, M))
    Kz, Mz = 0.5 * (Kz + Kz.T), 0.5 * (Mz + Mz.T)
    shift, rank = big, count_rank(M, M_size, with_mass, found)
    for attempt in range(8):
        solved = invert(Kz, Mz, LONG(shift))
        if solved is None:
            found.grey = found.grey or "the shifted stiffness is not definite"
            return found
        theta, Y, _ = solved
        order = np.argsort(-theta)[:rank]
        X = Z @ Y[:, order]
        if not np.all((X * (M @ X)).sum(0) > 0):
            found.grey = found.grey or "a mode without mass"
            return found
        lam, noise, X = measure(K, M, K_size, M_size, X)
        noise = noise + 1e-26 * big      # what of the stiffest modes is left in a vector, squared
        strained = lam[lam > 100 * noise]
        target = strained.min() if len(strained) else big
        if shift <= 3 * target or not len(strained):
            break
        shift = max(target, shift * 1e-6)
    found.lam, found.noise, found.X = refine_high(K, M, K_size, M_size, lam, noise, X, shift, big)
    return found


def refine_high(K, M, K_size, M_size, lam, noise, X, shift, big):
    """Values far above the shift are roundoff beside those near it: the lower vectors taken out of theirs, which span
    all the rest, they are solved among themselves."""
    first = 0
    while first < len(lam):
        reach = 1e5 * max(shift, abs(lam[first]))
        first += int((lam[first:] <= reach).sum())
        if first == len(lam):
            break
        low, high = (V.astype(LONG) for V in (X[:, :first], X[:, first:]))
        for _ in range(2):
            high = high - low @ (low.T @ (M.astype(LONG) @ high))
        solved = invert(*(0.5 * (P + P.T) for P in (high.T @ B.astype(LONG) @ high for B in (K, M))), LONG(0))
        if solved is None:
            break
        high = high @ solved[1][:, np.argsort(-solved[0])]
        if not np.all((high * (M.astype(LONG) @ high)).sum(0) > 0):      # roundoff: what was measured before stands
            break
        high_lam, high_noise, high = measure(K, M, K_size, M_size, high)
        if high_lam[0] < lam[first - 1]:
            break
        lam, noise = np.r_[lam[:first], high_lam], np.r_[noise[:first], high_noise + 1e-26 * big]
        X, shift = np.hstack([X[:, :first], high]), high_lam[0]
    return lam, noise, X


def measure(K, M, K_size, M_size, X):
    """Rayleigh quotients in long double, what round-off may do to them, and the vectors with unit mass; ascending."""
    X, K, M = X.astype(LONG), K.astype(LONG), M.astype(LONG)
    X = X / np.sqrt((X * (M @ X)).sum(0))
    lam, size = (X * (K @ X)).sum(0), np.abs(X).astype(float)
    noise = EPS * ((size * (K_size @ size)).sum(0) + np.abs(lam).astype(float) * (size * (M_size @ size)).sum(0))
    order = np.argsort(lam.astype(float))
    return lam.astype(float)[order], noise[order], X.astype(float)[:, order]
