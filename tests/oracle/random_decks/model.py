"""A structure as the generator knows it: its cards, and beside them what the oracle needs of constraints and loads."""
import copy
import random

import numpy as np

from systems import System
from writer import Writer, round_to


def unit_vector(rng):
    while True:
        v = np.array([rng.uniform(-1, 1) for _ in range(3)])
        if 0.1 < np.linalg.norm(v) < 1:
            return v / np.linalg.norm(v)


def skew(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


class Grid:
    def __init__(self, cp, fields, x, cd, system):
        self.cp, self.fields, self.x, self.cd, self.system, self.ps = cp, fields, x, cd, system, ""

    def axes(self):
        return self.system.axes_at(self.x)


class Model:
    """Cards and truth. Dofs are (grid, 1..6) in displacement axes, (point, 0) for scalar points."""

    def __init__(self, rng):
        self.rng = rng
        # metres and pascals, millimetres and tonnes, inches with weight densities
        self.length, self.modulus, self.density, self.wtmass = rng.choice(
            [(1.0, 7e10, 2700.0, 1.0), (1000.0, 7e4, 2.7e-9, 1.0), (40.0, 1e7, 0.1, 0.00259), (1.0, 2e11, 7850.0, 1.0)])
        self.cards = []          # (name, fields), without GRID
        self.grids, self.points, self.systems = {}, set(), {0: System()}
        # Of each equation, dependent and held dof the position of its card (-1: GRID, or none).
        self.rows, self.row_card, self.dependent, self.reaches = [], [], {}, {}
        self.fixed = {}
        self.loads = []          # ("force", dof, value) or ("gravity", vector in basic)
        self.params = {}
        self.massless = False
        self.last = {}
        self.base = rng.choice([0, 0, 100, 70000])
        if self.wtmass != 1.0:
            self.params["WTMASS"] = self.wtmass

    def number(self, kind):
        """A new id."""
        self.last[kind] = self.last.get(kind, self.base) + self.rng.choice([1, 1, 1, 2, 7])
        return self.last[kind]

    def add(self, name, *fields):
        self.cards.append((name, list(fields)))

    def mass_unit(self):
        return self.density * self.length ** 3 * 1e-3

    # -- places ------------------------------------------------------------------------------------------------------
    def add_system(self, near):
        """CORD2R, CORD2C or CORD2S, in basic or in an earlier system, well away from `near`."""
        rng, kind = self.rng, self.rng.choice("RRCS")
        rid = rng.choice(list(self.systems))
        outer = self.systems[rid]
        direction = unit_vector(rng)
        side = np.cross(direction, unit_vector(rng))
        side /= np.linalg.norm(side)
        a = near + self.length * (rng.uniform(-2, 2) * direction + rng.choice([-3.0, 2.0]) * side)
        points, fields = [], []
        for target in (a, a + self.length * direction, a + self.length * (side + 0.2 * direction)):
            local = [round_to(v, 6) for v in outer.from_basic(target)]
            fields += local
            points.append(outer.to_basic(local))
        cid = self.number("system")
        self.systems[cid] = System.from_points(kind, *points)
        self.add(f"CORD2{kind}", cid, rid, *fields)
        return cid

    def add_system_of_grids(self, grids):
        a, b, c = (self.grids[g].x for g in grids)
        if np.linalg.norm(np.cross(b - a, c - a)) < 1e-2 * np.linalg.norm(b - a) * np.linalg.norm(c - a):
            return 0
        cid = self.number("system")
        self.systems[cid] = System.from_points("R", a, b, c)
        self.add("CORD1R", cid, *grids)
        return cid

    def pick_system(self, x, needs_axes):
        cid = self.rng.choice(list(self.systems)) if self.rng.random() < 0.4 else 0
        if needs_axes and self.systems[cid].distance_to_axis(x) < 0.05 * self.length:
            return 0
        return cid

    def add_grid(self, x, twin=None, cd=None):
        """A grid at x, or just where the grid `twin` is; its place is that of the rounded fields."""
        if twin is not None:
            cp, fields = self.grids[twin].cp, list(self.grids[twin].fields)
        else:
            cp = self.pick_system(x, True)
            fields = [round_to(v, 5) for v in self.systems[cp].from_basic(x)]
        place = self.systems[cp].to_basic(fields)
        if cd is None:
            cd = self.pick_system(place, True)
        g = self.number("grid")
        self.grids[g] = Grid(cp, fields, place, cd, self.systems[cd])
        return g

    def add_point(self, explicit=True):
        s = self.number("grid")
        self.points.add(s)
        if explicit:
            self.add("SPOINT", s)
        return s

    # -- dofs --------------------------------------------------------------------------------------------------------
    def rigid_map(self, g, about):
        """6 × 6: displacement components of g (its CD) from a rigid motion [v, w] about a place, basic."""
        grid = self.grids[g]
        R = grid.axes().T
        D = np.zeros((6, 6))
        D[:3, :3] = D[3:, 3:] = R
        D[:3, 3:] = -R @ skew(grid.x - about)
        return D

    def is_open(self, dof):
        return dof not in self.dependent and dof not in self.fixed

    def may_depend(self, dependents, others):
        """True when the dependents are open and no chain leads from the others back to them."""
        wanted = set(dependents)
        if len(wanted) < len(list(dependents)) or not all(self.is_open(d) for d in wanted):
            return False
        seen, todo = set(), [d for d in others if d not in wanted]
        while todo:
            dof = todo.pop()
            for far in self.reaches.get(dof, ()):
                if far in wanted:
                    return False
                if far not in seen:
                    seen.add(far)
                    todo.append(far)
        return True

    def tie(self, rows, dependents):
        """Equations rows · u = 0 (dicts dof -> coefficient) that are solved for the dependents."""
        self.rows += rows
        self.row_card += [len(self.cards)] * len(rows)
        others = {d for row in rows for d in row} - set(dependents)
        for d in dependents:
            self.dependent[d] = len(self.cards)
            self.reaches[d] = others

    def restrict(self, cards):
        """What is left of the structure when only these of its cards are kept."""
        left, present = copy.copy(self), {id(c[1]) for c in cards}
        has = [id(fields) in present for _, fields in self.cards] + [True]     # the last for -1
        names = {c[1][0] for c in cards if c[0] == "GRID"}
        left.grids = {g: grid for g, grid in self.grids.items() if g in names}
        left.rows = [row for row, k in zip(self.rows, self.row_card) if has[k]]
        left.dependent = {d: k for d, k in self.dependent.items() if has[k]}
        left.fixed = {d: k for d, k in self.fixed.items() if has[k] and (d[1] == 0 or d[0] in names)}
        left.loads = self.loads if any(c[0] == "LOAD" for c in cards) else []
        return left

    # -- text --------------------------------------------------------------------------------------------------------
    def grid_cards(self):
        cards = []
        for g, grid in self.grids.items():
            # A blank CP is GRDSET's, which no deck here has: blank and 0 are the same.
            cp = grid.cp or self.rng.choice([None, 0])
            cd = grid.cd or self.rng.choice([None, 0])
            cards.append(("GRID", [g, cp, *grid.fields, cd, grid.ps or None]))
        return cards

    def list_cards(self):
        cards = self.grid_cards() + self.cards
        cards += [("PARAM", [name, value]) for name, value in self.params.items()]
        return cards

    def case_control(self, cards):
        lines = ["SOL 103", "CEND", "METHOD = 5"]
        if any(name in ("SPC", "SPC1") for name, _ in cards):
            lines.append("SPC = 3")
        if any(name == "MPC" for name, _ in cards):
            lines.append("MPC = 4")
        if any(name == "LOAD" for name, _ in cards):
            lines.append("LOAD = 8")
        return lines

    def text(self, cards, eigrl, seed, formats):
        writer = Writer(random.Random(seed), formats)
        bulk = [writer.write("EIGRL", eigrl)] + [writer.write(*card) for card in cards]
        return "\n".join([*self.case_control(cards), "BEGIN BULK", *bulk, "ENDDATA", ""])
