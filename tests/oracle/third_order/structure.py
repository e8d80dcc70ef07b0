"""Structures of elements and rigid links, and their static manifold u(η) = Φη + u₂ + u₃ + u₄ in tables of monomials."""
import itertools

import numpy as np

from series import cross, inverse_spin_map, multiply, polar_rotation, rotate, rotation_vector, spin_map


class Mean:
    """A dependent node at the weighted mean of others: place x̄ + R (X_d - X̄), rotation R of best fit, RᵀB symmetric with
    B = Σ w x_i X_iᵀ + ½ Σ w_r R_i. members: (node, w, w_r)."""

    def __init__(self, X, node, members):
        self.node, self.nodes = node, [m[0] for m in members]
        self.w, self.w_r = (np.array([m[k] for m in members]) for k in (1, 2))
        self.share = self.w / self.w.sum()
        centre = self.share @ X[self.nodes]
        self.arms, self.arm = X[self.nodes] - centre, X[node] - centre
        H = np.einsum("n,ni,nj->ij", self.w, self.arms, self.arms) + 0.5 * self.w_r.sum() * np.eye(3)
        self.J = np.linalg.inv(np.trace(H) * np.eye(3) - H)

    def find_rotation(self, w):
        """R and RᵀB along the series."""
        u = w[..., self.nodes, :3].copy()
        u[0] += self.arms
        B = np.einsum("...ni,nj,n->...ij", u, self.arms, self.w)
        B += 0.5 * np.einsum("...nij,n->...ij", rotate(w[..., self.nodes, 3:]), self.w_r)
        return polar_rotation(B, lambda axis: np.einsum("ij,...j->...i", self.J, axis))

    def move(self, w):
        R, _ = self.find_rotation(w)
        w[..., self.node, 3:] = rotation_vector(R)
        R[0] -= np.eye(3)
        w[..., self.node, :3] = np.einsum("n,...ni->...i", self.share, w[..., self.nodes, :3]) + R @ self.arm

    def pull_back(self, w, f):
        R, H = self.find_rotation(w)
        force, theta = f[..., self.node, :3], w[..., self.node, 3:]
        arm = R @ self.arm
        tau = cross(arm, force) + multiply("...ji,...j->...i", inverse_spin_map(theta), f[..., self.node, 3:])
        A = -H
        A[..., range(3), range(3)] += np.trace(H, axis1=-2, axis2=-1)[..., None]
        tau, mu = multiply("...ji,...j->...i", R, tau), np.zeros_like(tau)
        for k in range(len(w)):
            right = tau[k] - sum((np.einsum("...ij,...j->...i", A[i], mu[k - i]) for i in range(1, k + 1)), 0 * tau[k])
            mu[k] = right @ self.J
        for i, node in enumerate(self.nodes):
            f[..., node, :3] += self.share[i] * force + self.w[i] * multiply("...ij,...j->...i", R, np.cross(mu, self.arms[i]))
            if self.w_r[i] == 0:
                continue
            Q = multiply("...ji,...jk->...ik", R, rotate(w[..., node, 3:]))
            C = -Q
            C[..., range(3), range(3)] += np.trace(Q, axis1=-2, axis2=-1)[..., None]
            m = multiply("...ij,...j->...i", R, multiply("...ji,...j->...i", C, 0.5 * self.w_r[i] * mu))
            f[..., node, 3:] += multiply("...ji,...j->...i", spin_map(w[..., node, 3:]), m)
        f[..., self.node, :] = 0


class Structure:
    """X (nodes, 3). Links (dependent, independent): rigid, the dependent node with all six of its dofs; means (dependent,
    [(node, weight, weight of rotations), ...]), of nodes that depend on no others."""

    def __init__(self, X, groups, links=(), held=(), means=()):
        self.X, self.groups, self.links = np.asarray(X, float), groups, list(links)
        self.means = [Mean(self.X, *m) for m in means]
        self.num_dofs = 6 * len(X)
        dependent = [6 * d + k for d in [d for d, _ in self.links] + [m.node for m in self.means] for k in range(6)]
        self.independent = np.setdiff1d(np.arange(self.num_dofs), dependent)
        self.held = np.asarray(sorted(held), int)
        self.free = np.setdiff1d(self.independent, self.held)
        self.T = np.eye(self.num_dofs)
        for d, i in self.links:
            s = self.X[d] - self.X[i]
            self.T[6 * d:6 * d + 6] = self.T[6 * i:6 * i + 6]
            self.T[6 * d:6 * d + 3] += np.cross(self.T[6 * i + 3:6 * i + 6].T, s).T
        for mean in self.means:
            w = np.zeros((2, self.num_dofs, len(X), 6))
            w[1] = self.T.reshape(len(X), 6, -1).transpose(2, 0, 1)
            mean.move(w)
            self.T[6 * mean.node:6 * mean.node + 6] = w[1, :, mean.node].T
        self.T = self.T[:, self.independent]
        K = np.zeros((self.num_dofs,) * 2)
        for g in groups:
            for rows, k in zip(g.gdofs(), g.K):
                K[np.ix_(rows, rows)] += k
        self.K = np.zeros_like(K)
        self.K[np.ix_(self.independent, self.independent)] = self.T.T @ K @ self.T

    def complete(self, u):
        """u (order, ..., dofs) with the dependent nodes where exact rotations bring them."""
        w = u.reshape(u.shape[:-1] + (-1, 6)).copy()
        for d, i in self.links:
            R = rotate(w[..., i, 3:])
            R[0] -= np.eye(3)
            w[..., d, :] = w[..., i, :]
            w[..., d, :3] += np.einsum("...ij,j->...i", R, self.X[d] - self.X[i])
        for mean in self.means:
            mean.move(w)
        return w

    def pull_back(self, w, f):
        """Forces on independent dofs (and zero on the others) of forces f on all dofs at w."""
        f = f.reshape(w.shape).copy()
        for mean in self.means:
            mean.pull_back(w, f)
        for d, i in reversed(self.links):
            theta = w[..., i, 3:]
            arm = np.einsum("...ij,j->...i", rotate(theta), self.X[d] - self.X[i])
            f[..., i, :] += f[..., d, :]
            f[..., i, 3:] += multiply("...ji,...j->...i", spin_map(theta), cross(arm, f[..., d, :3]))
            f[..., d, :] = 0
        return f.reshape(f.shape[:-2] + (-1,))

    def forces(self, u):
        """V' along the series, on the independent dofs."""
        w = self.complete(u)
        total = np.zeros_like(w).reshape(u.shape)
        for g in self.groups:
            f = g.forces(w[..., g.nodes, :])
            for e, rows in enumerate(g.gdofs()):
                total[..., rows] += f[..., e, :]
        return self.pull_back(w, total)

    def energy(self, u):
        w = self.complete(u)
        return sum(g.energy(w[..., g.nodes, :]) for g in self.groups)

    def third(self, a, b, c):
        """V‴(a, b, c) at the undeformed state."""
        def cube(x):
            u = np.zeros((4, self.num_dofs))
            u[1] = x
            return 6 * self.energy(u)[3]
        return (cube(a + b + c) - cube(a + b) - cube(b + c) - cube(a + c) + cube(a) + cube(b) + cube(c)) / 6


def exponents(n, degree):
    return np.array([e for e in itertools.product(range(degree + 1), repeat=n) if sum(e) == degree])


class Table:
    """Homogeneous polynomial of one degree in n amplitudes: coefficients (monomials, ...)."""

    def __init__(self, n, degree, values=None, coefficients=None):
        self.e = exponents(n, degree)
        self.degree = degree
        if coefficients is None:
            points = self.points(n, degree)
            flat = np.asarray(values).reshape(len(points), -1)
            coefficients = np.linalg.solve(self.monomials(points), flat).reshape(np.asarray(values).shape)
        self.c = coefficients

    @staticmethod
    def points(n, degree):
        """Directions, one for each monomial: the principal lattice of a simplex."""
        return exponents(n, degree) / degree

    def monomials(self, eta):
        return np.prod(np.asarray(eta)[..., None, :] ** self.e, -1)

    def __call__(self, eta):
        return np.tensordot(self.monomials(eta), self.c, 1)


class Polynomial:
    """Sum of tables with m values: value, gradient and second derivatives at one point, all by one product."""

    def __init__(self, tables):
        tables = list(tables)
        self.n, top = tables[0].e.shape[1], max(t.degree for t in tables)
        self.e = np.concatenate([exponents(self.n, k) for k in range(top + 1)])
        place = {tuple(e): i for i, e in enumerate(self.e)}
        c = np.concatenate([t.c.reshape(len(t.e), -1) for t in tables])
        value = np.zeros((len(self.e), c.shape[1]))
        value[[place[tuple(e)] for t in tables for e in t.e]] = c

        def differ(c, j):
            d = np.zeros_like(c)
            for e, row in zip(self.e, c):
                if e[j]:
                    d[place[tuple(e - np.eye(self.n, dtype=int)[j])]] = e[j] * row
            return d
        first = [differ(value, j) for j in range(self.n)]
        second = [differ(f, k) for f in first for k in range(self.n)]
        self.m, self.c = c.shape[1], value
        self.stack = np.concatenate([value] + first + second, 1)

    def monomials(self, eta):
        powers = np.asarray(eta)[:, None] ** np.arange(self.e.max() + 1)
        return np.prod(powers[np.arange(self.n), self.e], -1)

    def value(self, eta):
        return self.monomials(eta) @ self.c

    def all(self, eta):
        """value (m), gradient (n, m), second derivatives (n, n, m)."""
        out = self.monomials(eta) @ self.stack
        n, m = self.n, self.m
        return out[:m], out[m:m + n * m].reshape(n, m), out[m + n * m:].reshape(n, n, m)


class Manifold:
    """u(η): minimum of V for Wᵀu = WᵀΦη, W = KΦ unless it is given, and for frame conditions Cᵀu = 0."""

    def __init__(self, structure, Phi, order=3, W=None, C=None):
        self.s, self.Phi, self.n = structure, Phi, Phi.shape[1]
        free = structure.free
        W = structure.K @ Phi if W is None else W
        border = W[free] if C is None else np.concatenate([W[free], C[free]], 1)
        m, b = len(free), border.shape[1]
        scale = np.abs(structure.K).max() / np.abs(border).max(0)
        A = np.zeros((m + b, m + b))
        A[:m, :m] = structure.K[np.ix_(free, free)]
        A[:m, m:] = border * scale
        A[m:, :m] = A[:m, m:].T
        self.inverse = np.linalg.inv(A)[:m, :m]
        self.u = {1: Table(self.n, 1, Phi.T[[np.argmax(e) for e in exponents(self.n, 1)]])}
        self.residual = {}
        for k in range(2, max(order, 4) + 1):
            eta = Table.points(self.n, k)
            r = structure.forces(self.curve(eta, min(k, order + 1)))[k]
            self.residual[k] = Table(self.n, k, r)
            if k <= order:
                self.u[k] = Table(self.n, k, -self.solve(r.T).T)

    def curve(self, eta, orders):
        """Series with u_1 .. u_(orders - 1), room for 4."""
        c = np.zeros((5, len(eta), self.s.num_dofs))
        for k, table in self.u.items():
            if k < orders:
                c[k] = table(eta)
        return c

    def solve(self, f):
        """Projected flexibility."""
        x = np.zeros(f.shape)
        x[self.s.free] = self.inverse @ f[self.s.free]
        return x

    def energy(self, orders=(2, 3, 4)):
        """Tables of V: degree k from the fields below it."""
        out = []
        for k in orders:
            eta = Table.points(self.n, k)
            c = self.curve(eta, 4)
            if k > 4:
                c = np.concatenate([c, np.zeros((k - 4,) + c.shape[1:])])
            out.append(Table(self.n, k, self.s.energy(c)[k]))
        return out

    def load(self, f, orders=(1, 2, 3, 4)):
        """Tables of the work of forces f on translations of all nodes (dependent ones move exactly): by reciprocity."""
        F = np.zeros(self.s.num_dofs)
        F[self.s.independent] = self.s.T.T @ f
        u_f = self.solve(F)
        out = []
        for k in orders:
            eta = Table.points(self.n, k)
            own = self.s.complete(self.curve(eta, k if k > 1 else 2))[k].reshape(len(eta), -1) @ f
            out.append(Table(self.n, k, own - (self.residual[k](eta) @ u_f if k > 1 else 0)))
        return out
