"""Strain energy of linear elements in frames that follow their nodes, along a power series of displacements.

    V = ½ (d + q)ᵀ K (d + q),    q = ½ Σ_m Q_m dᵀ P_m d

d: displacements and rotation vectors of the nodes seen from the frame; P_m: geometric stiffness of a unit of internal
force m; Q_m: the displacements K⁺ F_mᵀ that do its work, F the forces per displacement. q: the second-order strains
inside the element. The frame turns with R, the rotation nearest to the nodes and to their rotations,

    R = argmax tr(Rᵀ B),    B = Σ (x_i - x̄) X_iᵀ + c Σ R_i
"""
import numpy as np

from series import (cross, dot, inverse_spin_map, multiply, polar_rotation, rotate, rotation_vector, skew, spin_map)

ROTATION_WEIGHT = 1e-3     # of the mean square distance of the nodes from their centre


class Elements:
    """Elements of one kind: X (e, n, 3) places of the nodes, K (e, 6n, 6n), forces F (e, s, 6n) and geometric stiffness
    P (e, s, 6n, 6n) of unit forces; nodes (e, n). `local`: with q."""

    def __init__(self, nodes, X, K, F=None, P=None, local=True, weight=ROTATION_WEIGHT):
        self.nodes, self.K = np.asarray(nodes), K
        self.e, self.n = self.nodes.shape
        self.arms = X - X.mean(1, keepdims=True)
        self.c = weight * (self.arms ** 2).sum((1, 2)) / self.n
        self.c[self.c == 0] = 1
        H = np.einsum("eni,enj->eij", self.arms, self.arms) + self.n * self.c[:, None, None] * np.eye(3)
        self.J = np.linalg.inv(np.trace(H, axis1=1, axis2=2)[:, None, None] * np.eye(3) - H)
        self.F, self.P, self.Q = F, P, None
        if local and F is not None:
            self.Q = np.einsum("eij,esj->eis", np.linalg.pinv(K, rcond=1e-12, hermitian=True), F)

    def gdofs(self):
        return (6 * self.nodes[:, :, None] + np.arange(6)).reshape(self.e, -1)

    def find_frame(self, x, R_nodes):
        B = multiply("...ni,...nj->...ij", x, np.stack([np.broadcast_to(self.arms, x[0].shape)] + [0 * x[0]] * (len(x) - 1)))
        B += self.c[:, None, None] * R_nodes.sum(-3)
        return polar_rotation(B, lambda axis: np.einsum("eij,...ej->...ei", self.J, axis))

    def deform(self, u):
        """u: (order, ..., e, n, 6). Frame R, H = Rᵀ B, places x from the centre, deformations d (..., e, 6n)."""
        x = u[..., :3] - u[..., :3].mean(-2, keepdims=True)
        x[0] += self.arms
        R_nodes = rotate(u[..., 3:])
        R, H = self.find_frame(x, R_nodes)
        moved = multiply("...ji,...nj->...ni", R, x)
        moved[0] -= self.arms
        turned = rotation_vector(multiply("...ji,...njk->...nik", R, R_nodes))
        return R, H, x, np.concatenate([moved, turned], -1)

    def strain(self, d):
        """d + q and what it takes to vary it."""
        flat = d.reshape(d.shape[:-2] + (-1,))
        if self.Q is None:
            return flat, None
        Pd = np.einsum("esij,...ej->...esi", self.P, flat)
        w = 0.5 * multiply("...esi,...ei->...es", Pd, flat)
        return flat + np.einsum("eis,...es->...ei", self.Q, w), Pd

    def energy(self, u):
        """Series of V, (order, ...)."""
        e, _ = self.strain(self.deform(u)[3])
        Ke = np.einsum("eij,...ej->...ei", self.K, e)
        return 0.5 * multiply("...ei,...ei->...", Ke, e)

    def forces(self, u):
        """∂V/∂u, (order, ..., e, 6n): work on translations and rotation vectors."""
        R, H, x, d = self.deform(u)
        e, Pd = self.strain(d)
        g = np.einsum("eij,...ej->...ei", self.K, e)
        if Pd is not None:
            g = g + multiply("...es,...esi->...ei", np.einsum("eis,...ei->...es", self.Q, g), Pd)
        g = g.reshape(d.shape)
        n = g[..., :3]
        m = multiply("...nji,...nj->...ni", inverse_spin_map(d[..., 3:]), g[..., 3:])
        # Moment on the frame, in its axes; it turns by δω = (tr H - H)⁻¹ ax(Rᵀ δB - ...).
        y = multiply("...ji,...nj->...ni", R, x)
        tau = (cross(y, n) + m).sum(-2)
        A = -H
        A[..., range(3), range(3)] += np.trace(H, axis1=-2, axis2=-1)[..., None]
        mu = self.solve(A, tau)
        arms = np.stack([np.broadcast_to(self.arms, y[0].shape)] + [0 * y[0]] * (len(y) - 1))
        wide = np.broadcast_to(mu[..., None, :], y.shape)
        n = n - cross(wide, arms)
        f = multiply("...ij,...nj->...ni", R, n)
        f = f - f.mean(-2, keepdims=True)
        # a node that turns by δφ turns the frame by c (tr R_rel - R_rel)ᵀ δφ
        rel = rotate(d[..., 3:])
        C = -rel
        C[..., range(3), range(3)] += np.trace(rel, axis1=-2, axis2=-1)[..., None]
        m = m - self.c[:, None, None] * multiply("...nji,...nj->...ni", C, wide)
        m = multiply("...ij,...nj->...ni", R, m)
        m = multiply("...nji,...nj->...ni", spin_map(u[..., 3:]), m)
        return np.concatenate([f, m], -1).reshape(g.shape[:-2] + (-1,))

    @staticmethod
    def solve(A, b):
        inverse = np.linalg.inv(A[0])
        x = np.zeros_like(b)
        for k in range(len(b)):
            right = b[k] - sum((np.einsum("...ij,...j->...i", A[i], x[k - i]) for i in range(1, k + 1)), 0 * b[k])
            x[k] = np.einsum("...ij,...j->...i", inverse, right)
        return x
