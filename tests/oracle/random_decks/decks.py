"""Decks of others, whose right answer nobody here knows: the rules that every answer keeps, and Rayleigh's quotient."""
import glob
import json
import os

import h5py
import numpy as np
import scipy.sparse

from judge_modes import RESIDUAL

ENDINGS = (".bdf", ".dat", ".nas")


def list_decks(places):
    found = []
    for place in places:
        inside = glob.glob(os.path.join(place, "**", "*"), recursive=True) if os.path.isdir(place) else [place]
        found += [os.path.abspath(p) for p in inside if p.lower().endswith(ENDINGS) and os.path.isfile(p)]
    return sorted(found)


def read_sparse(group):
    return scipy.sparse.csr_matrix((group["data"][:], group["indices"][:], group["indptr"][:]), shape=group["shape"][:])


def judge_quotients(program, deck, found):
    """φᵀKφ = λ φᵀMφ with the exported matrices, whatever the constraints; grids must be all that there is."""
    ran = program.run("matrices", deck, "--no-kg", "-o", "matrices.h5")
    if ran.code != 0:
        return ran.broken_rule() or "matrices refuses what modes solves"
    with h5py.File(os.path.join(program.folder, "matrices.h5")) as f, \
            h5py.File(os.path.join(program.folder, "modes.h5")) as g:
        K, M, dofs = read_sparse(f["K"]), read_sparse(f["M"]), f["dof_map"][:]
        ids, phi = g["nodes/id"][:], g["modes/phi"][:]
    if len(ids) * 6 != len(dofs) or phi.shape[2] == 0:
        return None
    index = {(int(n), int(c)): row for row, (n, c) in enumerate(dofs)}
    X = np.zeros((len(dofs), phi.shape[2]))
    X[[index[int(n), c] for n in ids for c in range(1, 7)]] = phi.reshape(-1, phi.shape[2])
    lam, size = np.array(found["eigenvalue"]), np.abs(X)
    strain, mass = (X * (K @ X)).sum(0), (X * (M @ X)).sum(0)
    noise = 2.2e-16 * (size * (abs(K) @ size)).sum(0)
    off = np.abs(strain - lam * mass) - 2 * RESIDUAL * np.abs(lam) * mass - 100 * noise
    if off.max() > 0:
        j = int(off.argmax())
        return f"mode {j + 1}: eigenvalue {lam[j]:.9g}, but its shape has {strain[j] / mass[j]:.9g}"
    return None


def examine_deck(program, deck, verbs):
    """What is wrong by verb."""
    wrong = {}
    for verb in verbs:
        more = {"modes": ["--json", "-o", "modes.h5"], "static": ["-o", "static.h5"],
                "reduce": ["--modes", 5, "-o", "body.h5"]}.get(verb, [])
        ran = program.run(verb, deck, *more)
        broken = ran.broken_rule()
        if not broken and ran.code == 0 and verb == "modes":
            found = json.loads(ran.out)
            for case in [found, *found.get("subcases", [])]:
                worst = max(case["residual"], default=0)
                if not worst <= RESIDUAL:
                    broken = f"residual {worst:.1e} with exit 0"
            broken = broken or judge_quotients(program, deck, found)
        if not broken and ran.code == 0 and verb == "static":
            broken = judge_epsilon(os.path.join(program.folder, "static.h5"))
        if broken:
            wrong[verb] = broken
    return wrong


def judge_epsilon(path):
    with h5py.File(path) as f:
        for name, case in f["subcases"].items():
            if "epsilon" in case and not abs(float(np.ravel(case["epsilon"][()])[0])) <= RESIDUAL:
                return f"subcase {name}: epsilon {float(np.ravel(case['epsilon'][()])[0]):.1e} with exit 0"
            if not np.all(np.isfinite(case["displacement"][:])):
                return f"subcase {name}: displacements that are not finite"
    return None
