"""Materials and the properties of lines: numbers of one size, drawn anew for each part."""
from writer import round_to


def add_material(model, massless):
    rng = model.rng
    e = round_to(model.modulus * rng.uniform(0.3, 2))
    rho = None if massless else round_to(model.density * rng.uniform(0.5, 2))
    if massless and rng.random() < 0.3:
        rho = 0.0
    mid = model.number("material")
    model.add("MAT1", mid, e, None, rng.choice([0.3, 0.25, 0.33]), rho)
    return mid


def pick_size(model):
    """A thickness or radius."""
    return model.length * model.rng.uniform(0.01, 0.05)


SHAPES = {  # dimensions as shares of one size
    "ROD": (1,), "TUBE": (1, 0.6), "BAR": (1, 1.7), "BOX": (1, 1.5, 0.1, 0.15), "I": (2, 1, 1.2, 0.1, 0.15, 0.15),
    "CHAN": (1, 2, 0.1, 0.15), "T": (1, 1.2, 0.15, 0.1), "L": (1, 1.3, 0.15, 0.1), "Z": (0.5, 0.2, 1.5, 1.8),
    "TUBE2": (1, 0.2), "H": (1, 0.4, 1.5, 0.3), "CROSS": (1, 0.3, 1.2, 0.3), "HAT": (1, 0.1, 0.8, 0.4)}


def dims(model, shape):
    size = pick_size(model)
    return [round_to(size * share) for share in SHAPES[shape]]


def constants(model):
    """A, I1, I2, J of a section of some size."""
    s, rng = pick_size(model), model.rng
    area = s * s * rng.uniform(1, 3)
    return [round_to(v) for v in (area, area * s * s * rng.uniform(.1, .4), area * s * s * rng.uniform(.1, .4),
                                  area * s * s * rng.uniform(.1, .5))]


def add_bar_property(model, mid, massless):
    rng, pid = model.rng, model.number("property")
    nsm = None if massless or rng.random() < 0.7 else round_to(0.3 * model.density * pick_size(model) ** 2)
    if rng.random() < 0.5:
        shape = rng.choice(sorted(SHAPES))
        model.add("PBARL", pid, mid, None, shape, *[None] * 4, *dims(model, shape), nsm)
    else:
        a, i1, i2, j = constants(model)
        fields = [pid, mid, a, i1, i2, j, nsm]
        if rng.random() < 0.4:
            fields += [None] * 9 + rng.choice([[0.5, 0.4, None], [0.8, None, None],
                                               [None, None, round_to(0.2 * min(i1, i2))]])
        model.add("PBAR", *fields)
    return pid


def add_beam_property(model, mid, massless):
    rng, pid = model.rng, model.number("property")
    nsm = None if massless or rng.random() < 0.7 else round_to(0.3 * model.density * pick_size(model) ** 2)
    kind = rng.randrange(3)
    if kind == 0:
        shape = rng.choice(sorted(SHAPES))
        fields = [pid, mid, None, shape, *[None] * 4, *dims(model, shape), nsm]
        if rng.random() < 0.4:
            fields += ["YES", 1.0, *dims(model, shape), nsm]
        model.add("PBEAML", *fields)
    elif kind == 1:
        a, i1, i2, j = constants(model)
        model.add("PBCOMP", pid, mid, a, i1, i2, None, j, nsm)
    else:
        a, i1, i2, j = constants(model)
        is_tapered = rng.random() < 0.5
        skewed = None if is_tapered else rng.choice([None, round_to(0.1 * min(i1, i2))])
        fields = [pid, mid, a, i1, i2, skewed, j, nsm] + [None] * 8
        if is_tapered:
            b, k1, k2, jb = constants(model)
            fields += ["YES", 1.0, b, k1, k2, None, jb, nsm] + [None] * 8
        if rng.random() < 0.5:
            fields += rng.choice([[0.5, 0.5], [0.0, 0.0], [1.0, 0.7]])
            if rng.random() < 0.5:
                fields += [None] * 6 + [None] * 4 + [round_to(0.2 * pick_size(model)), None,
                                                     round_to(0.2 * pick_size(model)), None]
        model.add("PBEAM", *fields)
    return pid


def add_rod_property(model, mid, massless, is_tube):
    rng, pid = model.rng, model.number("property")
    nsm = None if massless or rng.random() < 0.7 else round_to(0.3 * model.density * pick_size(model) ** 2)
    if is_tube:
        od = round_to(2 * pick_size(model))
        model.add("PTUBE", pid, mid, od, rng.choice([None, round_to(0.2 * od)]), nsm)
    else:
        a, _, _, j = constants(model)
        model.add("PROD", pid, mid, a, rng.choice([None, j]), None, nsm)
    return pid
