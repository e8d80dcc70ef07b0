"""Is the answer of `static` that of the dense equations, with reactions and balance, or a refusal with a cause?"""
import os

import h5py
import numpy as np

import pencil
from generate import calc_load

REFUSALS = {"fe.mechanism", "fe.no-free-dofs"}


def find_live(truth):
    return truth.K.diagonal() > 1e-13 * truth.K_size.diagonal()


def calc_softness(truth):
    """Lowest eigenvalue of K with a unit diagonal, what round-off may do to it, the dofs that have stiffness and the
    scale of each."""
    K = 0.5 * (truth.K + truth.K.T)
    live = find_live(truth)          # with AUTOSPC NO what nothing touches is held all the same
    if not live.any():
        return 0.0, 1.0, live, None
    s = 1 / np.sqrt(K.diagonal()[live])
    values, vectors = np.linalg.eigh(K[np.ix_(live, live)] * np.outer(s, s))
    softest = np.abs(vectors[:, 0])
    return values[0], pencil.EPS * softest @ (truth.K_size[np.ix_(live, live)] * np.outer(s, s)) @ softest, live, s


def solve_dense(model, truth):
    """u on the g-set, the energy error that round-off allows, or None for a singular or unclear stiffness."""
    K = 0.5 * (truth.K + truth.K.T)
    f = truth.T.T @ calc_load(model, truth.M_g, truth.index)
    lowest, noise, live, s = calc_softness(truth)
    if lowest < 1e-10:
        return None, "singular" if abs(lowest) < 10 * noise else "unclear"
    scaled = K[np.ix_(live, live)] * np.outer(s, s)
    L = pencil.cholesky(scaled)
    x = pencil.solve_upper(L, pencil.solve_lower(L, (s * f[live])[:, None]))[:, 0].astype(float)
    u = np.zeros(len(K))
    u[live] = s * x
    half = np.abs(np.linalg.inv(L.astype(float)))
    spread = np.linalg.norm(half @ (s * (pencil.EPS * truth.K_size @ np.abs(u))[live]))
    energy = np.sqrt(max(u @ K @ u, 0))
    return (u, energy, 1e-6 * energy + 100 * spread), "regular"


def judge(ran, path, model, truth):
    broken = ran.broken_rule()
    if broken or truth is None:
        return broken
    solved, kind = solve_dense(model, truth)
    if ran.code != 0:
        if kind == "unclear" or (kind == "singular" and set(ran.ids()) & REFUSALS):
            return None
        return f"static refuses a {kind} structure (exit {ran.code}): {ran.first_error()}"
    with h5py.File(os.path.join(path, "static.h5")) as f:
        case = f["subcases"][list(f["subcases"])[0]]
        u, load, reaction, mpc = (case[k][:] for k in ("displacement", "load", "reaction", "mpc_force"))
    if not all(np.all(np.isfinite(v)) for v in (u, load, reaction, mpc)):
        return "static writes values that are not finite, exit 0"
    expected = calc_load(model, truth.M_g, truth.index)
    size = np.abs(expected).max()
    if np.abs(load - expected).max() > 1e-9 * size:
        return f"static: load differs by {np.abs(load - expected).max() / size:.1e}"
    if kind != "regular":     # held somewhere, or a load that does not move what is loose: then in balance
        return judge_balance(truth, u, load, reaction)
    own, energy, allowed = solved
    free = (truth.R.T @ u)[truth.free]
    off = np.sqrt(max((free - own) @ truth.K @ (free - own), 0))
    if off > allowed:
        return f"static: displacements off by {off / energy:.1e} in energy, allowed {allowed / energy:.1e}"
    if np.abs(u - truth.T @ free).max() > 1e-8 * np.abs(u).max():
        return "static: displacements break the constraints"
    return judge_balance(truth, u, load, reaction) or judge_forces(truth, u, load, reaction, mpc)


def judge_balance(truth, u, load, reaction):
    r = np.abs(truth.T.T @ (truth.K_g @ u - load - reaction)).max(initial=0)
    size = np.abs(truth.T.T @ load).max(initial=0)
    noise = 100 * pencil.EPS * (truth.K_size @ np.abs((truth.R.T @ u)[truth.free])).max(initial=0)
    if r > 1e-6 * size + min(noise, 1e-3 * size):
        return f"static: {r / max(size, 1e-300):.1e} of the load is not balanced, exit 0"
    return None


def judge_forces(truth, u, load, reaction, mpc):
    """K u = load + reaction + mpc; reactions act on held dofs only, forces of constraints do no work."""
    Ku = truth.K_g @ u
    noise = 1e-13 * (np.abs(truth.K_g) @ np.abs(u)).max() + 1e-9 * np.abs(load).max()
    if np.abs(Ku - load - reaction - mpc).max() > noise:
        return f"static: forces are out of balance by {np.abs(Ku - load - reaction - mpc).max():.1e}"
    own = truth.R.T @ reaction
    loose = own.copy()
    loose[sorted(truth.held_rows)] = 0
    for row, follows in truth.oblique:
        for other, factor in follows:
            loose[other] += factor * own[row]
    loose[[row for row, is_live in zip(truth.free, find_live(truth)) if not is_live]] = 0
    if np.abs(loose).max() > noise:
        return f"static: a reaction of {np.abs(loose).max():.1e} at a dof that nothing holds"
    work = truth.T_all.T @ mpc
    arm = np.abs(truth.T_all).sum(0).max()
    if np.abs(work).max() > noise * arm:
        return f"static: forces of the constraints do work, {np.abs(work).max():.1e}"
    return None
