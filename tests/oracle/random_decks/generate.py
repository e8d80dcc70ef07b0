"""A structure from a seed: parts somewhere in space, tied to each other, with point masses, supports and loads."""
import random

import numpy as np

import rigid
from bodies import add_panel, add_shell, add_solid
from lines import add_bush, add_frame, add_point_mass, add_scalar_chain, add_scalar_mass, add_springs, add_truss
from model import Model, unit_vector
from writer import round_to

PARTS = {add_frame: 6, add_truss: 2, add_shell: 3, add_solid: 2, add_panel: 1}


def pick_near(model, part, place):
    return min(part, key=lambda g: np.linalg.norm(model.grids[g].x - place) + model.rng.random() * model.length)


def add_hub(model, grids):
    """A grid held to some grids of a part by one rigid element, with a mass on it."""
    rng = model.rng
    chosen = rng.sample(grids, min(len(grids), rng.randint(1, 5)))
    middle = np.mean([model.grids[g].x for g in chosen], axis=0)
    hub = model.add_grid(middle + rng.choice([0.0, 0.3, 0.3]) * model.length * unit_vector(rng))
    kind = rng.choice(["rbe2", "rbe2", "rbe3", "rbe3", "rbar", "rbe1", "follow"])
    done = False
    if kind == "rbe2":
        done = rigid.add_rbe2(model, hub, chosen, rng.choice([(1, 2, 3, 4, 5, 6), (1, 2, 3, 4, 5, 6), (1, 2, 3)]))
    elif kind == "rbe3" and len(chosen) > 1:
        done = rigid.add_rbe3(model, hub, chosen)
    elif kind == "rbar":
        done = rigid.add_rbar(model, chosen[0], hub)
    elif kind == "rbe1":
        done = rigid.add_rbe1(model, chosen, hub)
    elif kind == "follow":
        done = rigid.add_rbe2(model, chosen[0], [hub])
    if not done:
        add_bush(model, hub, chosen[0])
    add_point_mass(model, hub)
    return hub


def join(model, part, other):
    """Ties two parts where they are near each other."""
    rng = model.rng
    a = pick_near(model, part, model.grids[other[0]].x)
    b = pick_near(model, other, model.grids[a].x)
    kind = rng.choice(["bush", "rbe2", "rbe2", "rbar", "rbar", "rrod", "mpc", "springs", "rbe3"])
    if kind == "rbe2" and rigid.add_rbe2(model, a, [b]):
        return
    if kind == "rbar" and rigid.add_rbar(model, a, b):
        return
    if kind == "rbe3" and rigid.add_rbe3(model, a, rng.sample(other, min(4, len(other)))):
        return
    if kind == "rrod":
        rigid.add_rrod(model, a, b)
    if kind == "mpc":
        for c in rng.sample(range(1, 7), 3):
            far = [(b, k) for k in rng.sample(range(1, 7), rng.randint(1, 3))]
            rigid.add_mpc(model, [(a, c), *far])
    if kind == "springs":
        add_springs(model, model.add_grid(None, twin=a, cd=model.grids[a].cd), a)
    add_bush(model, a, b)


def add_supports(model, parts):
    rng = model.rng
    if rng.random() < 0.25:
        return
    for part in parts:
        if rng.random() < 0.75:
            for g in rng.sample(part, min(len(part), rng.choice([1, 1, 2, 3]))):
                rigid.add_spc(model, g, rng.choice([(1, 2, 3, 4, 5, 6), (1, 2, 3, 4, 5, 6), (1, 2, 3), (3,), (2, 4)]))


def add_loads(model):
    rng = model.rng
    for g in rng.sample(sorted(model.grids), min(len(model.grids), rng.randint(1, 3))):
        size = round_to(model.modulus * model.length ** 2 * 1e-6)
        cid = rng.choice([c for c, s in model.systems.items()
                          if s.distance_to_axis(model.grids[g].x) > 0.05 * model.length])
        n = [round_to(v, 3) for v in unit_vector(rng)]
        is_moment = rng.random() < 0.4
        if is_moment:
            size = round_to(size * model.length * 0.1)
        model.add("MOMENT" if is_moment else "FORCE", 6, g, cid or rng.choice([None, 0]), size, *n)
        model.loads.append(("moment" if is_moment else "force", g,
                            model.systems[cid].axes_at(model.grids[g].x) @ np.array(n) * size))
    if rng.random() < 0.3:
        a, n = round_to(model.length * 9.81), [round_to(v, 3) for v in unit_vector(rng)]
        cid = rng.choice([c for c, s in model.systems.items() if s.kind == "R"])
        model.add("GRAV", 7, cid or None, a, *n)
        model.loads.append(("gravity", None, model.systems[cid].axes @ np.array(n) * a))
        model.add("LOAD", 8, 1.0, 2.0, 6, 1.0, 7)
    else:
        model.add("LOAD", 8, 2.0, 1.0, 6)


def add_scalar_model(model):
    rng = model.rng
    points = add_scalar_chain(model, None)
    if rng.random() < 0.5:
        more = add_scalar_chain(model, None)
        if rng.random() < 0.5:
            rigid.add_mpc(model, [(more[-1], 0), (points[0], 0)])
        else:
            add_scalar_mass(model, more[0], points[0])
    if not any(name.startswith("CMASS") for name, _ in model.cards):
        add_scalar_mass(model, points[0])
    if rng.random() < 0.3:
        rigid.add_spc(model, points[0], [0])
    if rng.random() < 0.3:
        model.params["AUTOSPC"] = "NO"


def generate(seed):
    """The same structure for the same seed."""
    rng = random.Random(f"structure {seed}")
    model = Model(rng)
    if rng.random() < 0.05:
        add_scalar_model(model)
        return model
    L = model.length
    for _ in range(rng.choice([0, 0, 1, 2])):
        model.add_system(np.zeros(3))
    all_massless = rng.random() < 0.3
    parts, place = [], L * np.array([rng.uniform(-1, 1) for _ in range(3)])
    for _ in range(rng.choice([1, 1, 2, 2, 3])):
        kind = rng.choices(list(PARTS), list(PARTS.values()))[0]
        parts.append(kind(model, place, all_massless or rng.random() < 0.25))
        place = place + L * rng.uniform(0.5, 1.5) * unit_vector(rng)
    if rng.random() < 0.15 and len(parts[0]) > 2:
        model.add_system_of_grids(rng.sample(parts[0], 3))
    supports_first = rng.random() < 0.5
    if supports_first:
        add_supports(model, parts)
    for part, other in zip(parts[1:], parts):
        if rng.random() < 0.95:
            join(model, part, other)
    for part in parts:
        for _ in range(rng.choice([0, 0, 1, 1, 2]) + all_massless):
            add_hub(model, part)
        if rng.random() < (0.6 if all_massless else 0.3):
            add_point_mass(model, rng.choice(part))
        if rng.random() < 0.15:
            add_bush(model, rng.choice(part))
        if rng.random() < 0.15:
            add_springs(model, rng.choice(part))
        if rng.random() < 0.15:
            add_scalar_chain(model, rng.choice([None, (rng.choice(part), rng.randint(1, 6))]))
        if rng.random() < 0.1:
            model.add("CMASS2", model.number("mass"), round_to(model.mass_unit()), rng.choice(part), rng.randint(1, 3))
        if rng.random() < 0.15 and len(part) > 1:
            ends = rng.sample(part, 2)
            rigid.add_mpc(model, [(g, rng.randint(1, 6)) for g in ends])
    if not supports_first:
        add_supports(model, parts)
    if rng.random() < 0.4:
        model.params["COUPMASS"] = 1
    if rng.random() < 0.3:
        model.params["AUTOSPC"] = rng.choice(["YES", "NO", "NO"])
    if rng.random() < 0.15:
        model.params["K6ROT"] = rng.choice([0.0, 1.0, 100.0])
    add_loads(model)
    return model


def calc_load(model, M, index):
    """The load of LOAD set 8 on the g-set in basic axes; M with WTMASS on the g-set."""
    f = np.zeros(M.shape[0])
    factors = {"force": 2.0, "moment": 2.0, "gravity": 1.0}
    for kind, g, value in model.loads:
        if kind == "gravity":
            rigid_motion = np.zeros(M.shape[0])
            for other in model.grids:
                rigid_motion[index[other, 1]:index[other, 1] + 3] = value
            f += factors[kind] * (M @ rigid_motion)
        else:
            at = index[g, 1 if kind == "force" else 4]
            f[at:at + 3] += factors[kind] * value
    return f
