"""Two functions of NASA-CR-202063's preprocessor from plain matrices, in NumPy: the twelve inertial loads and the mass
integrals. What `bough integrals` calculates too, for scripts that have their matrices at hand.

    from treeflx import fimake5, modall
    F_I = fimake5(M, dof_map, xyz)
    integrals = modall(M, K, Phi, dof_map, xyz, mass)

dof_map: ndof x 2, node (from 1) and code: 1 2 3 translations x y z, 4 5 6 rotations, else a generalized dof. xyz:
nodes x 3. R: the point that arms are measured from. M may be sparse.
"""
import numpy as np

PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]


def _split(dof_map, num_nodes, X):
    """Nodes x 6 x columns of X, zero where the map has no such dof."""
    blocks = np.zeros((num_nodes, 6, X.shape[1]))
    at = (dof_map[:, 1] >= 1) & (dof_map[:, 1] <= 6)
    blocks[dof_map[at, 0] - 1, dof_map[at, 1] - 1] = X[at]
    return blocks


def rigid_modes(dof_map, xyz, R=(0, 0, 0)):
    """ndof x 6: unit translations x y z, unit rotations about R."""
    dof_map, p = np.asarray(dof_map, int), np.asarray(xyz, float) - np.asarray(R, float)
    Phi_R = np.zeros((len(dof_map), 6))
    codes = dof_map[:, 1] - 1
    for code in range(6):
        Phi_R[codes == code, code] = 1
    for s in range(3):
        turned = np.cross(np.eye(3)[s], p)
        for code in range(3):
            at = codes == code
            Phi_R[at, 3 + s] = turned[dof_map[at, 0] - 1, code]
    return Phi_R


def fimake5(M, dof_map, xyz, R=(0, 0, 0)):
    """ndof x 12: loads per unit of ax ay az, alx aly alz, wx2 wy2 wz2, wxwy wxwz wywz (eqs. 3-12). Columns 7 to 12 are
    zero at generalized dofs."""
    dof_map, xyz = np.asarray(dof_map, int), np.asarray(xyz, float)
    P = M @ rigid_modes(dof_map, xyz, R)
    at_nodes = _split(dof_map, len(xyz), P)
    F = np.zeros((len(dof_map), 12))
    F[:, :6] = -P
    is_nodal = (dof_map[:, 1] >= 1) & (dof_map[:, 1] <= 6)
    node, code = dof_map[is_nodal, 0] - 1, dof_map[is_nodal, 1] - 1
    for column, (r, s) in enumerate(PAIRS):
        # ω × the momentum that rotation ω gives: of translations and of rotations alike.
        halves = []
        for half in (at_nodes[:, :3], at_nodes[:, 3:]):
            turned = np.cross(np.eye(3)[r], half[:, :, 3 + s])
            if r != s:
                turned = turned + np.cross(np.eye(3)[s], half[:, :, 3 + r])
            halves.append(turned)
        F[is_nodal, 6 + column] = -np.concatenate(halves, axis=1)[node, code]
    return F


def modall(M, K, Phi, dof_map, xyz, mass, R=(0, 0, 0), D=None, zeta=None):
    """The generalized matrices and the five mass integrals of modes Phi (ndof x n), by the report's nodal formulas
    (4.2.2): a dict of mass, stiffness, damping (n x n), alpha (n x 3, gamma0 over `mass`), gamma0, gamma1 (n x 3),
    gamma2 (n x n x 3), gamma3 (n x 3 x 3), gamma4 (n x n x 3 x 3). Damping: of D, or of the ratio zeta as
    2 zeta sqrt(K_jj / M_jj)."""
    dof_map, Phi = np.asarray(dof_map, int), np.asarray(Phi, float)
    p = np.asarray(xyz, float) - np.asarray(R, float)
    M_Phi = M @ Phi
    A, phi = _split(dof_map, len(p), M_Phi), _split(dof_map, len(p), Phi)
    out = {"mass": Phi.T @ M_Phi, "stiffness": Phi.T @ (K @ Phi)}
    if D is not None:
        out["damping"] = Phi.T @ (D @ Phi)
    elif zeta is not None:
        out["damping"] = np.diag(2 * zeta * np.sqrt(np.diag(out["stiffness"]) / np.diag(out["mass"])))
    a, f, one = A[:, :3], phi[:, :3], np.eye(3)
    out["gamma0"] = a.sum(axis=0).T
    out["alpha"] = out["gamma0"] / mass
    out["gamma1"] = (A[:, 3:].transpose(0, 2, 1) + np.cross(p[:, None, :], a.transpose(0, 2, 1))).sum(axis=0)
    out["gamma2"] = np.cross(a.transpose(0, 2, 1)[:, :, None, :], f.transpose(0, 2, 1)[:, None, :, :]).sum(axis=0)
    out["gamma3"] = (np.einsum("kaj,ka->j", a, p)[:, None, None] * one - np.einsum("kaj,kb->jab", a, p))
    out["gamma4"] = (np.einsum("kaj,kal->jl", a, f)[:, :, None, None] * one - np.einsum("kaj,kbl->jlab", a, f))
    return out
