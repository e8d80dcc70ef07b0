"""Parts made of lines and points: frames, trusses, springs, scalar chains, point masses."""
import numpy as np

from model import unit_vector
from sections import add_bar_property, add_beam_property, add_material, add_rod_property, constants
from writer import round_to


def add_line(model, ga, gb, pids):
    """One CBAR or CBEAM with an orientation across it, now and then with offsets and pins."""
    rng = model.rng
    name = rng.choice(sorted(pids))
    axis = model.grids[gb].x - model.grids[ga].x
    span = np.linalg.norm(axis)
    while True:
        v = unit_vector(rng)
        if np.linalg.norm(np.cross(v, axis / span)) > 0.4:
            break
    offt, offsets = None, [None] * 6
    if rng.random() < 0.3:
        offt = rng.choice(["GGG", "GGG", "BGG", "GGO", "GOG", "GOO"])
        offsets = [round_to(0.05 * span * rng.uniform(-1, 1)) if rng.random() < 0.6 else None for _ in range(6)]
    local = v if offt and offt[0] == "B" else model.grids[ga].axes().T @ v
    pins = [None, None]
    if rng.random() < 0.2:
        pins[rng.randrange(2)] = rng.choice(["5", "6", "56", "456", "45", "1"])
    model.add(name, model.number("element"), pids[name], ga, gb, *[round_to(x) for x in local], offt, *pins, *offsets)


def add_frame(model, at, massless):
    rng, L = model.rng, model.length
    mid = add_material(model, massless)
    pids = {"CBAR": add_bar_property(model, mid, massless), "CBEAM": add_beam_property(model, mid, massless)}
    if rng.random() < 0.5:
        del pids[rng.choice(sorted(pids))]
    count = rng.randint(2, 7)
    shape = rng.choice(["line", "line", "star", "ring", "walk"])
    across = [unit_vector(rng) for _ in range(2)]
    across[1] = np.cross(*across)
    grids = []
    for k in range(count):
        turn = 2 * np.pi * k / count
        x = {"line": L * 0.4 * k * across[0],
             "star": L * (0.1 + rng.random()) * unit_vector(rng),
             "ring": L * (np.cos(turn) * across[0] + np.sin(turn) * across[1]),
             "walk": None}[shape]
        if x is None:
            x = model.grids[grids[-1]].x - at + 0.5 * L * unit_vector(rng) if grids else np.zeros(3)
        grids.append(model.add_grid(at + x))
    pairs = [(grids[0], g) for g in grids[1:]] if shape == "star" else list(zip(grids, grids[1:]))
    if shape == "ring" and count > 2:
        pairs.append((grids[-1], grids[0]))
    for ga, gb in pairs:
        if np.linalg.norm(model.grids[ga].x - model.grids[gb].x) > 0.02 * L:
            add_line(model, ga, gb, pids)
    return grids


def add_truss(model, at, massless):
    """Bays of triangles, every two grids of neighbouring triangles joined: the rotations have no stiffness."""
    rng, L = model.rng, model.length
    mid = add_material(model, massless)
    axis, grids, elements = unit_vector(rng), [], []
    side = np.cross(axis, unit_vector(rng))
    side /= np.linalg.norm(side)
    for bay in range(rng.randint(1, 4)):
        for k in range(3):
            turn = 2 * np.pi * k / 3 + 0.1 * bay
            offset = 0.5 * (np.cos(turn) * side + np.sin(turn) * np.cross(axis, side))
            grids.append(model.add_grid(at + L * (0.7 * bay * axis + offset)))
    for i, ga in enumerate(grids):
        elements += [(ga, gb) for j, gb in enumerate(grids) if j > i and j // 3 - i // 3 <= 1]
    add_rods(model, elements, mid, massless)
    if rng.random() < 0.3:
        for g in grids:
            model.grids[g].ps = "456"
            model.fixed.update({(g, c): -1 for c in (4, 5, 6)})
    return grids


def add_rods(model, pairs, mid, massless):
    rng, pids = model.rng, {}
    for ga, gb in pairs:
        name = rng.choice(["CROD", "CROD", "CTUBE", "CONROD"])
        if name == "CONROD":
            a, _, _, j = constants(model)
            model.add(name, model.number("element"), ga, gb, mid, a, rng.choice([None, j]))
            continue
        if name not in pids:
            pids[name] = add_rod_property(model, mid, massless, name == "CTUBE")
        model.add(name, model.number("element"), pids[name], ga, gb)


def pick_stiffness(model):
    """Of the size of a line's axial stiffness, a tenth to a hundredth of it."""
    return round_to(model.modulus * model.length * 10 ** model.rng.uniform(-6, -4))


def add_bush(model, ga, gb=None):
    """gb None: to ground."""
    rng, pid = model.rng, model.number("property")
    k, r = [pick_stiffness(model) for _ in range(3)], [pick_stiffness(model) for _ in range(3)]
    k += [round_to(v * model.length ** 2 * 0.1) for v in r]
    if rng.random() < 0.3:
        k[rng.randrange(6)] = None
    model.add("PBUSH", pid, "K", *k)
    fields = [model.number("element"), pid, ga, gb]
    apart = gb is not None and np.linalg.norm(model.grids[ga].x - model.grids[gb].x) > 0.01 * model.length
    if apart and rng.random() < 0.5:
        axis = model.grids[gb].x - model.grids[ga].x
        v = np.cross(axis, unit_vector(rng))
        v /= np.linalg.norm(v)
        fields += [round_to(x) for x in model.grids[ga].axes().T @ v]
    else:
        fields += [None] * 3 + [0]
    model.add("CBUSH", *fields)


def add_springs(model, ga, gb=None):
    """CELAS1 or CELAS2 in some components, or to ground when gb is None."""
    rng = model.rng
    for c in rng.sample(range(1, 7), rng.randint(1, 6)):
        k = pick_stiffness(model)
        k = round_to(k * model.length ** 2 * 0.1) if c > 3 else k
        far = [gb, c] if gb is not None else rng.choice([[None, None], [0, 0]])
        if rng.random() < 0.5:
            pid = model.number("property")
            model.add("PELAS", pid, k)
            model.add("CELAS1", model.number("spring"), pid, ga, c, *far)
        else:
            model.add("CELAS2", model.number("spring"), k, ga, c, *far)


def add_scalar_chain(model, hook):
    """Scalar points in a row with springs and masses, hung on a grid's component, on ground or on nothing."""
    rng = model.rng
    points = [model.add_point() for _ in range(rng.randint(1, 5))]
    for a, b in zip(points, points[1:]):
        if rng.random() < 0.5:
            pid = model.number("property")
            model.add("PELAS", pid, pick_stiffness(model))
            model.add("CELAS3", model.number("spring"), pid, a, b)
        else:
            model.add("CELAS4", model.number("spring"), pick_stiffness(model), a, b)
    for s in points:
        if rng.random() < 0.7:
            add_scalar_mass(model, s)
    if hook is not None:
        model.add("CELAS2", model.number("spring"), pick_stiffness(model), *hook, points[0], rng.choice([None, 0]))
    elif rng.random() < 0.7:
        model.add("CELAS4", model.number("spring"), pick_stiffness(model), points[-1], None)
    return points


def add_scalar_mass(model, s, other=None):
    rng = model.rng
    m = round_to(model.mass_unit() * rng.uniform(0.2, 3))
    kind = rng.randrange(4)
    if kind in (0, 1):
        pid = model.number("property")
        model.add("PMASS", pid, m)
        fields = [pid, s, other] if kind else [pid, s, None, other, None]
        model.add("CMASS3" if kind else "CMASS1", model.number("mass"), *fields)
    else:
        fields = [m, s, other] if kind == 2 else [m, s, None, other, None]
        model.add("CMASS4" if kind == 2 else "CMASS2", model.number("mass"), *fields)


def add_point_mass(model, g, offset=True):
    rng = model.rng
    m = round_to(model.mass_unit() * 10 ** rng.uniform(-1, 1.5))
    r = model.length * 0.1
    if rng.random() < 0.15:
        lower = []
        for row in range(6):
            size = m if row < 3 else m * r * r
            lower += [round_to(size * rng.uniform(0.5, 1)) if column == row else None for column in range(row + 1)]
        model.add("CONM1", model.number("point mass"), g, 0, *lower)
        return
    arm = [round_to(r * rng.uniform(-3, 3)) for _ in range(3)] if offset and rng.random() < 0.4 else [None] * 3
    inertia = [None] * 6
    if rng.random() < 0.5:
        a, b, c = (m * r * r * rng.uniform(0.2, 1) for _ in range(3))
        inertia = [round_to(b + c), None, round_to(a + c), None, None, round_to(a + b)]
        if rng.random() < 0.4:
            inertia[1] = round_to(0.3 * m * r * r * rng.uniform(-0.2, 0.2))
    # the axes of CID are those of a rectangular system; a round one's turn with the grid
    cid = rng.choice([c for c, s in model.systems.items() if s.kind == "R"])
    model.add("CONM2", model.number("point mass"), g, cid or rng.choice([None, 0]), m, *arm, None, *inertia)
