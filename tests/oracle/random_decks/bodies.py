"""Parts made of surfaces and solids."""
import numpy as np

from lines import add_rods
from model import unit_vector
from sections import add_material
from writer import round_to


def frame_of(rng):
    x = unit_vector(rng)
    y = np.cross(x, unit_vector(rng))
    y /= np.linalg.norm(y)
    return x, y, np.cross(x, y)


def add_shell_property(model, massless):
    rng, pid = model.rng, None
    mid = add_material(model, massless)
    t = round_to(model.length * rng.uniform(0.005, 0.04))
    nsm = None if massless or rng.random() < 0.7 else round_to(0.2 * model.density * t)
    pid = model.number("property")
    if rng.random() < 0.25:
        plies = [v for _ in range(rng.randint(1, 3))
                 for v in (mid, round_to(t / 3), rng.choice([0.0, 45.0, 90.0]), None)]
        if rng.random() < 0.5:
            mid = model.number("material")
            rho = None if massless else round_to(model.density)
            model.add("MAT8", mid, round_to(model.modulus), round_to(model.modulus / 8), 0.3,
                      round_to(model.modulus / 12), None, None, rho)
            plies[::4] = [mid] * len(plies[::4])
        model.add("PCOMP", pid, None, nsm, None, None, None, None, rng.choice([None, "SYM"]), *plies)
    else:
        bending = rng.choice([mid, mid, None]) if rng.random() < 0.3 else mid
        shear = rng.choice([mid, None]) if bending else None
        model.add("PSHELL", pid, mid, t, bending, None, shear, None, nsm)
    return pid


def add_shell(model, at, massless):
    """A patch, flat, bent or twisted, of one kind of element."""
    rng, L = model.rng, model.length
    kind = rng.choice(["CQUAD4", "CQUAD4", "CTRIA3", "CQUADR", "CTRIAR", "CQUAD8", "CTRIA6"])
    pid = add_shell_property(model, massless)
    x, y, z = frame_of(rng)
    nx, ny = rng.randint(1, 3), rng.randint(1, 2)
    step = 2 if kind in ("CQUAD8", "CTRIA6") else 1
    bend, twist = rng.choice([(0, 0), (0, 0), (0.3, 0), (0, 0.1), (0.2, 0.05)])
    table, size = {}, rng.uniform(0.2, 0.5) * L

    def node(i, j):
        if (i, j) not in table:
            u, v = i / step, j / step
            table[i, j] = model.add_grid(at + size * (u * x + v * y + (bend * u * u + twist * u * v) * z))
        return table[i, j]

    for i in range(0, nx * step, step):
        for j in range(0, ny * step, step):
            quad = [(i, j), (i + step, j), (i + step, j + step), (i, j + step)]
            faces = [quad] if "QUAD" in kind else [quad[:3], [quad[0], *quad[2:]]]
            for face in faces:
                corners = [node(*c) for c in face]
                if step == 2:
                    around = zip(face, face[1:] + face[:1])
                    corners += [node((a[0] + b[0]) // 2, (a[1] + b[1]) // 2) for a, b in around]
                offset = round_to(0.02 * L) if rng.random() < 0.1 and step == 1 else None
                fields = [model.number("element"), pid, *corners]
                if kind == "CTRIA6":
                    fields += [rng.choice([None, 30.0])]
                elif kind == "CQUAD8":
                    fields += [None] * 4 + [rng.choice([None, 30.0])]
                else:
                    fields += [rng.choice([None, 30.0]), offset]
                model.add(kind, *fields)
    return list(table.values())


def add_solid(model, at, massless):
    """A bar of bricks, each whole or cut into wedges or tetrahedra, with or without midside grids."""
    rng, L = model.rng, model.length
    kind = rng.choice(["CHEXA8", "CHEXA8", "CHEXA20", "CPENTA6", "CPENTA15", "CTETRA4", "CTETRA10"])
    is_second = kind in ("CHEXA20", "CPENTA15", "CTETRA10")
    mid, pid = add_material(model, massless), model.number("property")
    model.add("PSOLID", pid, mid)
    x, y, z = frame_of(rng)
    h, table = rng.uniform(0.2, 0.4) * L, {}

    def node(p):
        if p not in table:
            table[p] = model.add_grid(at + h / 2 * (p[0] * x + p[1] * y + 0.8 * p[2] * z))
        return table[p]

    shapes = {"CHEXA": [(0, 1, 2, 3, 4, 5, 6, 7)], "CPENTA": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
              "CTETRA": [(0, 1, 3, 4), (1, 2, 3, 6), (4, 7, 6, 3), (4, 6, 5, 1), (1, 3, 4, 6)]}
    edges = {"CHEXA": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)],
             "CPENTA": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)],
             "CTETRA": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]}
    name = kind.rstrip("0123456789")
    for brick in range(rng.randint(1, 2 if is_second else 4)):
        # every other brick is the mirror image, so that the cuts of tetrahedra meet
        flip = brick % 2 and name == "CTETRA"
        xs = (2 * brick + 2, 2 * brick) if flip else (2 * brick, 2 * brick + 2)
        corners = [(xs[0], 0, 0), (xs[1], 0, 0), (xs[1], 2, 0), (xs[0], 2, 0)]
        corners += [(a, b, 2) for a, b, _ in corners]
        for cell in shapes[name]:
            points = [corners[k] for k in cell]
            if flip:
                points[1], points[2] = points[2], points[1]
            ids = [node(p) for p in points]
            if is_second:
                ids += [node(tuple((a + b) // 2 for a, b in zip(points[i], points[j]))) for i, j in edges[name]]
            model.add(name, model.number("element"), pid, *ids)
    return list(table.values())


def add_panel(model, at, massless):
    """Shear panels between rods."""
    rng, L = model.rng, model.length
    mid, pid = add_material(model, massless), model.number("property")
    model.add("PSHEAR", pid, mid, round_to(0.01 * L), None if massless else rng.choice([None, 0.0]))
    x, y, _ = frame_of(rng)
    rows = [[model.add_grid(at + L * 0.5 * (i * x + j * y)) for j in range(2)] for i in range(rng.randint(2, 4))]
    pairs = [tuple(r) for r in rows]
    for a, b in zip(rows, rows[1:]):
        model.add("CSHEAR", model.number("element"), pid, a[0], b[0], b[1], a[1])
        pairs += [(a[0], b[0]), (a[1], b[1])]
    add_rods(model, pairs, mid, massless)
    return [g for r in rows for g in r]
