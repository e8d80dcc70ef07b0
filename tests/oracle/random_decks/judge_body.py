"""Is the body of `reduce` the structure: its modes modes, its integrals those of the exported mass?"""
import os

import h5py
import numpy as np

from judge_modes import is_vague, show
from judge_static import calc_softness

# A structure that its supports do not hold, one without mass or without modes.
REFUSALS = {"reduce.mechanism", "modal.singular-shift", "fe.mechanism", "modal.no-mass", "modal.no-dofs",
            "fe.no-support", "modal.missed-modes", "fe.no-free-dofs", "reduce.no-modes"}


def rigid_motions(model, truth, origin):
    Phi = np.zeros((len(truth.index), 6))
    for g, grid in model.grids.items():
        at = truth.index[g, 1]
        x, y, z = grid.x - origin
        Phi[at:at + 6] = np.eye(6)
        Phi[at:at + 3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return Phi


def weigh(model, truth):
    """The mass of translations."""
    R = rigid_motions(model, truth, np.zeros(3))[:, :3]
    return float(np.trace(R.T @ truth.M_g @ R)) / 3


def judge(ran, path, model, truth, spectrum, is_free):
    broken = ran.broken_rule()
    if broken or truth is None or spectrum is None or spectrum.grey:
        return broken
    if ran.code != 0:
        if set(ran.ids()) == {"reduce.no-mass"} and weigh(model, truth) <= 0:
            return None
        if set(ran.ids()) == {"fe.residual"} and (
                calc_softness(truth)[0] < 1e-10 or is_vague(spectrum, [5, None, None, 5])):
            return None      # very soft and very stiff parts side by side
        loose = spectrum.num_null > 0 or spectrum.is_zero().any() or len(spectrum.lam) == 0
        if is_free or loose:
            return None      # which motions a free body may have is decided by rules of its own
        return f"reduce refuses a sound structure (exit {ran.code}): {ran.first_error()}"
    if weigh(model, truth) <= 0:
        return "reduce: a body without mass, exit 0"
    with h5py.File(os.path.join(path, "body.h5")) as f:
        if "full/phi" not in f:
            return "reduce: a body without modes and with shapes" if len(f["modes/eigenvalue"]) else None
        Phi, mass, stiffness = f["full/phi"][:], f["modal/mass"][:], f["modal/stiffness"][:]
        lam, rigid = f["modes/eigenvalue"][:], f["rigid/mass"][()]
        cg, inertia = f["rigid/cg"][:], f["rigid/inertia"][:]
        dofs = f["dof_map"][:]
        ids, xyz = (f["grids/id"][:], f["grids/xyz"][:]) if "grids/id" in f else ([], [])
    if not all(np.all(np.isfinite(v)) for v in (Phi, mass, stiffness, lam, rigid, cg, inertia)):
        return "reduce writes values that are not finite, exit 0"
    Phi = Phi[np.argsort([truth.index[int(g), int(c)] for g, c in dofs])]
    worst = lambda A, B, scale: np.abs(A - B).max(initial=0) / max(np.abs(scale).max(initial=0), 1e-300)
    if worst(Phi.T @ truth.M_g @ Phi, mass, mass) > 1e-8:
        return "reduce: modal mass is not that of the modes"
    if worst(Phi.T @ truth.K_g @ Phi, stiffness, stiffness) > 1e-6:
        return "reduce: modal stiffness is not that of the modes"
    if len(ids):
        origin = model.grids[int(ids[0])].x - xyz[0]
        R = rigid_motions(model, truth, origin)
        G = R.T @ truth.M_g @ R
        # the mass of translations along x, y, z is the same where no scalar mass acts along one axis
        if np.ptp(np.diag(G)[:3]) < 1e-9 * G[0, 0] and abs(G[0, 0] - float(np.ravel(rigid)[0])) > 1e-9 * G[0, 0]:
            return f"reduce: mass {float(np.ravel(rigid)[0])}, expected {G[0, 0]}"
        if np.ptp(np.diag(G)[:3]) < 1e-9 * G[0, 0] and worst(inertia, G[3:, 3:], G[3:, 3:]) > 1e-8:
            return "reduce: inertia is not that of the exported mass"
    # each is an eigenvalue of the dense pencil
    for k, value in enumerate(lam):
        if spectrum.is_cut and value > spectrum.lam.max(initial=0):
            break
        near = int(np.abs(spectrum.lam - value).argmin())
        if abs(spectrum.lam[near] - value) > 2e-6 * abs(value) + 40 * spectrum.noise[near]:
            if not is_free:
                return f"reduce: eigenvalue {value:.9g} of mode {k + 1} is none of {show(spectrum.lam)}"
    return None
