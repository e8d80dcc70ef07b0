"""Rigid elements, MPC and SPC: the card, and the equations that it means, derived here on their own."""
import numpy as np

from writer import round_to


def digits(components):
    return "".join(str(c) for c in sorted(components))


def tie_body(model, independent, dependent):
    """A rigid body: independent and dependent are lists of (grid, components). False when it cannot be."""
    dofs = [(g, c) for g, cs in independent for c in cs]
    ends = [(g, c) for g, cs in dependent for c in cs]
    if len(dofs) != 6 or not model.may_depend(ends, dofs):
        return False
    about = model.grids[independent[0][0]].x
    P = np.array([model.rigid_map(g, about)[c - 1] for g, c in dofs])
    # Lengths in units of the body: no arm, no judgement.
    arm = max([np.linalg.norm(model.grids[g].x - about) for g, _ in independent + dependent] + [1e-9 * model.length])
    scaled = P.copy()
    scaled[:, 3:] /= arm
    if np.linalg.svd(scaled, compute_uv=False)[-1] < 0.02:
        return False
    inverse, rows = np.linalg.inv(P), []
    for g, c in ends:
        row = model.rigid_map(g, about)[c - 1] @ inverse
        rows.append({(g, c): 1.0, **{d: -v for d, v in zip(dofs, row)}})
    model.tie(rows, ends)
    return True


def add_rbe2(model, gn, grids, components=(1, 2, 3, 4, 5, 6)):
    grids = [g for g in grids if g != gn and model.may_depend([(g, c) for c in components],
                                                              [(gn, c) for c in range(1, 7)])]
    grids = [g for g in grids if tie_body(model, [(gn, range(1, 7))], [(g, components)])]
    if grids:
        model.add("RBE2", model.number("element"), gn, digits(components), *grids)
    return bool(grids)


def add_rbar(model, ga, gb):
    rng = model.rng
    every = set(range(1, 7))
    for _ in range(5):
        kind = rng.randrange(4)
        if kind == 0:
            cna, cnb = every, set()
        elif kind == 1:
            cna, cnb = set(), every
        else:
            cna = set(rng.sample(sorted(every), rng.choice([3, 4, 5])))
            cnb = set(rng.sample(sorted(every), 6 - len(cna)))
        cma, cmb = every - cna, every - cnb
        if kind == 0 and rng.random() < 0.3:
            cmb = {1, 2, 3}
        independent = [(g, sorted(cs)) for g, cs in ((ga, cna), (gb, cnb)) if cs]
        dependent = [(g, sorted(cs)) for g, cs in ((ga, cma), (gb, cmb)) if cs]
        if tie_body(model, independent, dependent):
            all_others = cma == every - cna and cmb == every - cnb
            blank = all_others and rng.random() < 0.5
            model.add("RBAR", model.number("element"), ga, gb, digits(cna) or None, digits(cnb) or None,
                      None if blank else digits(cma) or None, None if blank else digits(cmb) or None)
            return True
    return False


def add_rbe1(model, holders, follower):
    """Six components shared by two or three grids hold the body."""
    rng = model.rng
    for _ in range(10):
        chosen = rng.sample(holders, min(len(holders), rng.choice([1, 2, 3])))
        left, independent = 6, []
        for k, g in enumerate(chosen):
            count = left if k + 1 == len(chosen) else rng.randint(1, left - (len(chosen) - k - 1))
            if count > 6:
                break
            independent.append((g, sorted(rng.sample(range(1, 7), count))))
            left -= count
        dependent = [(follower, sorted(rng.sample(range(1, 7), rng.choice([3, 6, 6]))))]
        if left == 0 and tie_body(model, independent, dependent):
            fields = [model.number("element")]
            line = [v for g, cs in independent for v in (g, digits(cs))]
            fields += (line + [None] * 6)[:6] + [None]
            fields += ["UM"] + [v for g, cs in dependent for v in (g, digits(cs))]
            model.add("RBE1", *fields)
            return True
    return False


def add_rrod(model, ga, gb):
    along = model.grids[gb].x - model.grids[ga].x
    length = np.linalg.norm(along)
    if length < 1e-3 * model.length:
        return False
    along = along / length
    a, b = model.grids[ga].axes().T @ along, model.grids[gb].axes().T @ along
    row = {**{(ga, c + 1): -a[c] for c in range(3)}, **{(gb, c + 1): b[c] for c in range(3)}}
    dof = max(sorted(row), key=lambda d: abs(row[d]) + model.rng.uniform(0, 0.2))
    if abs(row[dof]) < 0.3 or not model.may_depend([dof], set(row) - {dof}):
        return False
    model.tie([row], [dof])
    ends = (dof[1], None) if dof[0] == ga else (None, dof[1])
    model.add("RROD", model.number("element"), ga, gb, *ends)
    return True


def add_rbe3(model, hub, grids):
    """The hub's motion is the least-squares rigid motion of the grids; with UM some of theirs follow instead."""
    rng = model.rng
    grids = [g for g in grids if g != hub]
    components = rng.choice([(1, 2, 3), (1, 2, 3), tuple(range(1, 7))])
    refc = rng.choice([tuple(range(1, 7)), tuple(range(1, 7)), (1, 2, 3)])
    about = model.grids[hub].x
    arm = np.mean([np.linalg.norm(model.grids[g].x - about) for g in grids])
    cut = rng.randint(1, len(grids)) if rng.random() < 0.4 else len(grids)
    groups = [(rng.choice([1.0, 2.0, 0.25]), part) for part in (grids[:cut], grids[cut:]) if part]
    dofs, A, root = [], [], []
    for weight, part in groups:
        for g in part:
            D = model.rigid_map(g, about)
            for c in components:
                dofs.append((g, c))
                A.append(D[c - 1])
                root.append(np.sqrt(weight) * (arm if c > 3 else 1.0))
    A, root = np.array(A), np.array(root)
    scale = np.array([1, 1, 1] + [1 / max(arm, 1e-12)] * 3)
    design = root[:, None] * A * scale
    if np.linalg.matrix_rank(design, tol=0.03 * np.linalg.norm(design, 2)) < 6:
        return False
    fit = scale[:, None] * (np.linalg.pinv(design) * root)     # six motions from the joined components
    own = model.rigid_map(hub, about)
    rows = []
    for c in refc:
        row = {(hub, c): 1.0}
        for d, v in zip(dofs, own[c - 1] @ fit):
            row[d] = row.get(d, 0.0) - v
        rows.append(row)
    dependents, um = [(hub, c) for c in refc], None
    if rng.random() < 0.3:
        um = pick_um(model, rows, dofs, dependents, rng)
        dependents = um or dependents
    if not model.may_depend(dependents, {d for row in rows for d in row}):
        return False
    model.tie(rows, dependents)
    fields = [model.number("element"), None, hub, digits(refc)]
    for weight, part in groups:
        fields += [weight, digits(components), *part]
    if um:
        fields += [None] * (-len(fields) % 8) + ["UM"]
        used = {}
        for g, c in um:
            used.setdefault(g, []).append(c)
        pairs = [v for g, cs in used.items() for v in (g, digits(cs))]
        for k, pair in enumerate(zip(pairs[::2], pairs[1::2])):
            if k and k % 3 == 0:
                fields += [None, None]
            fields += pair
    model.add("RBE3", *fields)
    return True


def pick_um(model, rows, dofs, plain, rng):
    """Other components for which the equations can be solved, well enough."""
    every = list(dict.fromkeys(plain + dofs))
    E = np.array([[row.get(d, 0.0) for d in every] for row in rows])
    unit = np.array([1.0 if d[1] < 4 else 1 / model.length for d in every])
    for _ in range(20):
        chosen = rng.sample(range(len(every)), len(rows))
        square = (E * unit)[:, chosen]
        square = square / np.maximum(np.abs(square).max(axis=1), 1e-12)[:, None]
        if np.linalg.svd(square, compute_uv=False)[-1] > 0.05:
            um = sorted(every[k] for k in chosen)
            if model.may_depend(um, {d for row in rows for d in row}):
                return um
    return None


def add_mpc(model, dofs):
    """The first of the dofs follows the others."""
    rng = model.rng
    if not model.may_depend(dofs[:1], dofs[1:]) or len(set(dofs)) < len(dofs):
        return False
    row = {d: round_to(rng.choice([-1, 1]) * rng.uniform(0.5, 2), 3) for d in dofs}
    fields = [4]
    for k, (g, c) in enumerate(dofs):
        if k and k % 2 == 0:
            fields += [None, None]
        fields += [g, c or rng.choice([None, 0]), row[(g, c)]]
    model.tie([row], [dofs[0]])
    model.add("MPC", *fields)
    return True


def add_spc(model, g, components):
    """Holds those components of a grid that nothing makes dependent."""
    rng = model.rng
    free = [c for c in components if (g, c) not in model.dependent]
    if not free:
        return False
    kind = rng.randrange(3)
    is_ps = kind == 1 and g in model.grids and not model.grids[g].ps
    for c in free:
        model.fixed.setdefault((g, c), -1 if is_ps else len(model.cards))
    if free == [0]:
        model.add("SPC", 3, g, rng.choice([None, 0]), 0.0) if kind else model.add("SPC1", 3, None, g)
    elif kind == 0:
        model.add("SPC", 3, g, digits(free), 0.0)
    elif is_ps:
        model.grids[g].ps = digits(free)
    else:
        model.add("SPC1", 3, digits(free), g)
    return True
