"""A straight bar along x as a chain of pieces with exact rotations: strains γ = Rᵀ x' - e_x and κ = T(θ) θ' of finite
rotation vectors θ at the nodes (Reissner, Simo), one point a piece; derivatives by differences in long double."""
import numpy as np

REAL = np.longdouble


def skew(v):
    zero = np.zeros_like(v[..., 0])
    return np.stack([np.stack([zero, -v[..., 2], v[..., 1]], -1), np.stack([v[..., 2], zero, -v[..., 0]], -1),
                     np.stack([-v[..., 1], v[..., 0], zero], -1)], -2)


def calc_strains(x_a, q_a, x_b, q_b, length):
    """6 strains of each piece: stretch, shears, twist, curvatures about y and z. Angles well below 1."""
    middle, slope = (q_a[:, 3:] + q_b[:, 3:]) / 2, (q_b[:, 3:] - q_a[:, 3:]) / length
    S, t2 = skew(middle), (middle ** 2).sum(-1)
    S2 = S @ S
    a, b, c = (REAL(1), REAL(1) / 2, REAL(1) / 6)      # sin t/t, (1 - cos t)/t², (t - sin t)/t³ as series
    sums, term = [np.zeros_like(t2) for _ in range(3)], [a + 0 * t2, b + 0 * t2, c + 0 * t2]
    for k in range(1, 12):
        for i in range(3):
            sums[i] = sums[i] + term[i]
            term[i] = -term[i] * t2 / ((2 * k + i) * (2 * k + i + 1))
    s, v, w = (x[:, None, None] for x in sums)
    one = np.eye(3, dtype=REAL)
    stretch = np.einsum("eji,ej->ei", one + s * S + v * S2, (x_b + q_b[:, :3] - x_a - q_a[:, :3]) / length)
    stretch[:, 0] -= 1
    return np.concatenate([stretch, np.einsum("eij,ej->ei", one - v * S + w * S2, slope)], 1)


def differ1(f, q, a, h):
    return (8 * (f(q + h * a) - f(q - h * a)) - (f(q + 2 * h * a) - f(q - 2 * h * a))) / (12 * h)


def differ2(f, q, a, b, h):
    def along(d):
        return (16 * (f(q + h * d) + f(q - h * d)) - (f(q + 2 * h * d) + f(q - 2 * h * d)) - 30 * f(q)) / (12 * h * h)
    return (along(a + b) - along(a - b)) / 4


def differ3(f, q, a, b, c, h):
    def along(d):
        step = [f(q + k * h * d) - f(q - k * h * d) for k in (1, 2, 3)]
        return (-step[2] + 8 * step[1] - 13 * step[0]) / (8 * h ** 3)
    return (along(a + b + c) - along(a + b - c) - along(a - b + c) + along(a - b - c)) / 24


class Bar:
    """stiffness: EA, kGA, kGA, GJ, EI about y, EI about z. Clamped at its first node."""

    def __init__(self, length, num_pieces, stiffness):
        self.num, self.piece, self.D = num_pieces, REAL(length) / num_pieces, np.array(stiffness, REAL)
        self.x = np.zeros((num_pieces + 1, 3), REAL)
        self.x[:, 0] = np.linspace(0, length, num_pieces + 1)
        self.free = np.arange(6, 6 * num_pieces + 6)

    def calc_strains(self, q):
        return calc_strains(self.x[:-1], q[:-1], self.x[1:], q[1:], self.piece)

    def calc_tangent(self, q, stress=None):
        """Second derivative of the energy and the first, of all dofs; `stress`: instead of what the strains give."""
        ends = np.concatenate([q[:-1], q[1:]], 1)
        f = lambda z: calc_strains(self.x[:-1], z[:, :6], self.x[1:], z[:, 6:], self.piece)   # noqa: E731
        unit = np.eye(12, dtype=REAL)
        stress = f(ends) * self.D if stress is None else stress
        B = np.stack([differ1(f, ends, unit[i], REAL(1e-4)) for i in range(12)], -1)
        H = np.einsum("eki,k,ekj->eij", B, self.D, B)
        for i in range(12):
            for j in range(i + 1):
                part = (differ2(f, ends, unit[i], unit[j], REAL(1e-3)) * stress).sum(1)
                H[:, i, j] += part
                if i != j:
                    H[:, j, i] += part
        K, g = np.zeros((6 * self.num + 6,) * 2), np.zeros(6 * self.num + 6)
        for e in range(self.num):
            rows = slice(6 * e, 6 * e + 12)
            K[rows, rows] += (self.piece * H[e]).astype(float)
            g[rows] += (self.piece * (stress[e] @ B[e])).astype(float)
        return K, g

    def solve(self, K, f):
        u = np.zeros(len(f))
        u[self.free] = np.linalg.solve(K[np.ix_(self.free, self.free)], f[self.free])
        return u

    def find_equilibrium(self, load):
        """Under nodal forces and moments that work on rotation vectors; q, num + 1 x 6."""
        q = np.zeros((self.num + 1, 6), REAL)
        for _ in range(30):
            K, g = self.calc_tangent(q)
            step = self.solve(K, load - g)
            q = q + step.reshape(-1, 6)
            if np.abs(step).max() < 1e-13:
                return q
        raise AssertionError("no equilibrium")

    def calc_third(self, q, stress, U, shapes):
        """The third derivative of the energy at q along U and each two shapes, in its parts: of the stress of U with
        second strains of the shapes (K_G), of the stresses of the shapes with second strains of U and a shape, and of
        `stress` with third strains."""
        def unit(v):
            scale = np.abs(v).max() / 0.1
            return (v / scale).reshape(-1, 6).astype(REAL), scale
        u, size = unit(U)
        vectors = [unit(shapes[:, j]) for j in range(shapes.shape[1])]
        f, n = self.calc_strains, len(vectors)
        of_u, first = differ1(f, q, u, REAL(1e-4)), [differ1(f, q, v, REAL(1e-4)) for v, _ in vectors]
        mixed = [differ2(f, q, u, v, REAL(1e-3)) for v, _ in vectors]
        parts = np.zeros((3, n, n))
        for i in range(n):
            for j in range(i + 1):
                (a, by_a), (b, by_b) = vectors[i], vectors[j]
                values = [(of_u * self.D * differ2(f, q, a, b, REAL(1e-3))).sum(),
                          (self.D * (first[i] * mixed[j] + first[j] * mixed[i])).sum(),
                          (stress * differ3(f, q, u, a, b, REAL(4e-3))).sum()]
                parts[:, i, j] = parts[:, j, i] = np.array(values, float) * float(self.piece) * size * by_a * by_b
        return parts
