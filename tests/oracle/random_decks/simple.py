"""K of rods and springs, M of point and scalar masses from the cards alone, for structures that have nothing else."""
import math

import numpy as np

SPRINGS = {"CELAS1", "CELAS2", "CELAS3", "CELAS4"}
MASSES = {"CMASS1", "CMASS2", "CMASS3", "CMASS4", "CONM1", "CONM2"}
RODS = {"CROD", "CTUBE", "CONROD"}


def pad(fields, count):
    return [v if v is not None else 0 for v in fields] + [0] * (count - len(fields))


class Simple:
    def __init__(self, model, index):
        self.model, self.index, n = model, index, len(index)
        self.K, self.M = np.zeros((n, n)), np.zeros((n, n))
        self.cards = {}
        for name, fields in model.cards:
            self.cards.setdefault(name, []).append(fields)
        self.materials = {f[0]: pad(f, 5) for f in self.cards.get("MAT1", [])}
        names = {name for name in self.cards if name[0] == "C" and not name.startswith("CORD")}
        self.has_K = names <= SPRINGS | MASSES | RODS
        is_massless = all(not m[4] for m in self.materials.values()) and "MAT8" not in self.cards
        self.has_M = is_massless or names <= SPRINGS | MASSES
        if self.has_K:
            self.add_springs()
            self.add_rods()
        if self.has_M:
            self.add_scalar_masses()
            self.add_point_masses()
            self.M *= model.wtmass

    def direction(self, point, component):
        """Row of the g-set that picks a component (displacement axes); none for ground."""
        row = np.zeros(len(self.index))
        if not point:
            return row
        if point in self.model.points:
            row[self.index[point, 0]] = 1
            return row
        at = self.index[point, 1 if component < 4 else 4]
        row[at:at + 3] = self.model.grids[point].axes()[:, (component - 1) % 3]
        return row

    def list_scalars(self, kind, property_name):
        values = {f[0]: f[1] for f in self.cards.get(property_name, [])}
        for k in "1234":
            for f in self.cards.get(f"C{kind}{k}", []):
                value = values[f[1]] if k in "13" else f[1]
                g1, c1, g2, c2 = pad(f[2:], 4) if k in "12" else [pad(f[2:], 2)[0], 0, pad(f[2:], 2)[1], 0]
                row = self.direction(g1, c1) - self.direction(g2, c2)
                yield value * np.outer(row, row)

    def add_springs(self):
        for part in self.list_scalars("ELAS", "PELAS"):
            self.K += part

    def add_scalar_masses(self):
        for part in self.list_scalars("MASS", "PMASS"):
            self.M += part

    def add_rods(self):
        rods = {f[0]: pad(f, 4)[1:4] for f in self.cards.get("PROD", [])}
        tubes = {f[0]: pad(f, 4)[1:4] for f in self.cards.get("PTUBE", [])}
        for name in RODS:
            for f in self.cards.get(name, []):
                if name == "CONROD":
                    ends, (mid, area, J) = f[1:3], pad(f[3:], 3)
                else:
                    ends = f[2:4]
                    mid, area, J = rods[f[1]] if name == "CROD" else tubes[f[1]]
                if name == "CTUBE":
                    outer, inner = area / 2, area / 2 - J if J else 0
                    area, J = math.pi * (outer ** 2 - inner ** 2), math.pi / 2 * (outer ** 4 - inner ** 4)
                E, _, nu = self.materials[mid][1:4]
                a, b = (self.model.grids[g].x for g in ends)
                length = np.linalg.norm(b - a)
                for first, stiffness in ((1, E * area / length), (4, E / (2 + 2 * nu) * J / length)):
                    row = np.zeros(len(self.index))
                    for sign, g in ((-1, ends[0]), (1, ends[1])):
                        at = self.index[g, first]
                        row[at:at + 3] += sign * (b - a) / length
                    self.K += stiffness * np.outer(row, row)

    def add_point_masses(self):
        for f in self.cards.get("CONM1", []):
            lower, at = pad(f[3:], 21), self.index[f[1], 1]
            block = np.zeros((6, 6))
            block[np.tril_indices(6)] = lower
            self.M[at:at + 6, at:at + 6] += block + np.tril(block, -1).T
        for f in self.cards.get("CONM2", []):
            _, g, cid, m, x, y, z, _, i11, i21, i22, i31, i32, i33 = pad(f, 14)
            R = self.model.systems[cid or 0].axes
            r = R @ np.array([x, y, z], float)
            arm = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
            J = R @ np.array([[i11, -i21, -i31], [-i21, i22, -i32], [-i31, -i32, i33]], float) @ R.T
            at = self.index[g, 1]
            self.M[at:at + 6, at:at + 6] += np.block([[m * np.eye(3), -m * arm], [m * arm, J - m * arm @ arm]])


def judge(model, truth):
    """None, or which exported matrix is not that of the cards."""
    own = Simple(model, truth.index)
    for name, has, mine, its in (("K", own.has_K, own.K, truth.K_g), ("M", own.has_M, own.M, truth.M_g)):
        if has:
            # rows of translations and of rotations have units of their own
            scale = np.sqrt(np.maximum(mine.diagonal(), 0))
            limit = 1e-9 * np.maximum(np.outer(scale, scale), 1e-6 * np.abs(mine).max(initial=0))
            if np.any(np.abs(mine - its) > limit):
                row, column = np.unravel_index(np.argmax(np.abs(mine - its) / np.maximum(limit, 1e-300)), mine.shape)
                return f"{name}[{row}, {column}] is {its[row, column]:.9g}, the cards give {mine[row, column]:.9g}"
    return None
