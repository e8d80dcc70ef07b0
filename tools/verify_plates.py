"""The plates of verify.py: decks written here, run by the program, next to exact thin-plate theory and the Ritz oracle.

Every case has a ladder of meshes; the row shows the finest, and the source column how far the mesh before it was off.
"""
import json
import math
import os

import served  # verify.py says where it is

STEEL = (200e9, 0.3, 8000.0)
UNIT = (1e7, 0.3, 1e-3)
RITZ = "Ritz, tests/oracle"


class Mesh:
    """(nx + 1) x (ny + 1) grids, numbered row by row from 1, placed by `place` from the unit square."""

    def __init__(self, nx, ny, place):
        self.nx, self.ny = nx, ny
        self.cards = [f"GRID,{self.get_id(i, j)},,{x:.15E},{y:.15E},0." for j in range(ny + 1) for i in range(nx + 1)
                      for x, y in [place(i / nx, j / ny)]]
        round_ = ((0, 0), (1, 0), (1, 1), (0, 1))
        self.cards += [f"CQUAD4,{j * nx + i + 1},1," + ",".join(str(self.get_id(i + a, j + b)) for a, b in round_)
                       for j in range(ny) for i in range(nx)]

    def get_id(self, i, j):
        return j * (self.nx + 1) + i + 1

    def get_edge(self, edge):
        if edge in "WE":
            return [self.get_id(0 if edge == "W" else self.nx, j) for j in range(self.ny + 1)]
        return [self.get_id(i, 0 if edge == "S" else self.ny) for i in range(self.nx + 1)]

    def add_plate(self, material, t, everywhere):
        E, nu, rho = material
        last = (self.nx + 1) * (self.ny + 1)
        self.cards += [f"MAT1,1,{E:.9E},,{nu:.9E},{rho:.9E}", f"PSHELL,1,1,{t:.9E},1,,1",
                       f"SPC1,1,{everywhere},1,THRU,{last}"]

    def hold(self, edges, components):
        self.cards += [f"SPC1,1,{components},{grid}" for edge in edges for grid in self.get_edge(edge)]

    def support(self, edges):
        """w, and the rotation whose axis is across the edge."""
        for edge in edges:
            self.hold(edge, "34" if edge in "WE" else "35")

    def push(self, edge, fx, fy):
        """A uniform load of that total."""
        grids = self.get_edge(edge)
        for k, grid in enumerate(grids):
            share = (0.5 if k in (0, len(grids) - 1) else 1.0) / (len(grids) - 1)
            self.cards.append(f"FORCE,10,{grid},0,1.,{share * fx:.15E},{share * fy:.15E},0.")


class Plates:
    def __init__(self, program, folder, add, quick):
        self.program, self.path, self.add, self.quick = program, os.path.join(folder, "plate.bdf"), add, quick

    def run(self, cards, num, buckling=False):
        case = "SUBCASE 1\nLOAD = 10\nSUBCASE 2\n" if buckling else ""
        with open(self.path, "w", encoding="utf-8") as f:
            f.write(f"SOL {105 if buckling else 103}\nCEND\nSPC = 1\n{case}METHOD = 1\nBEGIN BULK\nEIGRL,1,,,{num}\n")
            f.write("\n".join(cards) + "\nENDDATA\n")
        found = served.run([self.program, "modes", self.path, "--json", "-n", str(num), "-o", self.path + ".h5",
                            *(["--buckling"] if buckling else [])], check=True)
        return json.loads(found.stdout)["load_factor" if buckling else "frequency_hz"]

    def climb(self, case, meshes, calc, names, exact, tolerance, source):
        """calc(mesh) for every mesh; rows for the last."""
        ladder = [calc(n) for n in (meshes[-1:] if self.quick else meshes)]
        for k, (name, value) in enumerate(zip(names, exact)):
            before = f"; coarser meshes {', '.join(f'{100 * (step[k] / value - 1):+.2f} %' for step in ladder[:-1])}"
            self.add(case, name, ladder[-1][k], value, tolerance, source + (before if ladder[:-1] else ""))

    def verify_square(self):
        factor = 2 * math.pi * math.sqrt(UNIT[2] * 0.002 / (UNIT[0] * 0.002**3 / 12 / (1 - 0.3**2)))
        cases = {"SSSS": ([19.7392, 49.3480, 49.3480, 78.9568], 0), "CCCC": ([35.9852, 73.3938, 73.3938, 108.2165], 0),
                 "FFFF": ([13.4682, 19.5961, 24.2702, 34.8009], 3), "CFFF": ([3.4711, 8.5067, 21.2850, 27.1989], 0)}
        for name, (exact, rigid) in cases.items():
            def calc(n, name=name, rigid=rigid, num=len(exact)):
                mesh = Mesh(n, n, lambda a, b: (a, b))
                mesh.add_plate(UNIT, 0.002, "126")
                if name == "SSSS":
                    mesh.support("WESN")
                elif name != "FFFF":
                    mesh.hold("WESN" if name == "CCCC" else "W", "345")
                return [factor * hz for hz in self.run(mesh.cards, num + rigid)[rigid:]]
            self.climb(f"square plate {name}, 40 x 40", [10, 20, 40], calc, [f"lambda^2 {k + 1}" for k in range(4)],
                       exact, 5e-3, "Kirchhoff")

    def calc_nafems(self, name, n):
        s, square = 5 * math.sqrt(2), lambda a, b: (10 * a, 10 * b)
        rhombic = lambda a, b: (10 * a + s * b, s * b)
        if name == "FV32":
            mesh = Mesh(2 * n, n, lambda a, b: (10 * a, (5 - 4 * a) * (b - 0.5)))
            mesh.add_plate(STEEL, 0.05, "345")
            mesh.hold("W", "126")
            return self.run(mesh.cards, 6)
        mesh = Mesh(n, n, rhombic if name in ("FV15", "FV22") else square)
        mesh.add_plate(STEEL, 1.0 if name == "FV22" else 0.05, "126")
        if name == "FV13":
            mesh.support("WESN")
        if name in ("FV15", "FV22"):
            mesh.hold("WESN", "345")
            mesh.cards.append("PARAM,COUPMASS,1")
        if name == "FV16":
            mesh.hold("W", "345")
        return self.run(mesh.cards, 11)[3:] if name == "FV12" else self.run(mesh.cards, 6)

    def verify_nafems(self):
        exact = {"FV12": [1.62165, 2.35950, 2.92228, 4.19024, 4.19024, 7.35600],
                 "FV13": [2.37672, 5.94181, 5.94181, 9.50689, 11.88361, 11.88361],
                 "FV15": [7.9038, 12.8227, 17.8577, 18.9320, 23.6927, 27.6322],
                 "FV16": [0.41793, 1.02422, 2.56276, 3.27490, 3.72718, 6.52422],
                 "FV22": [133.403, 201.912, 266.919, 280.794, 336.118, 378.328],
                 "FV32": [44.617, 130.011, 162.689, 245.988, 379.719, 391.406]}
        meshes = {"FV15": [16, 32, 64], "FV22": [10, 20, 40], "FV32": [8, 16, 32]}
        for name, hz in exact.items():
            ladder = meshes.get(name, [8, 16, 32] if name != "FV12" else [10, 20, 40])
            self.climb(f"NAFEMS {name}, {ladder[-1]} elements a side", ladder,
                       lambda n, name=name: self.calc_nafems(name, n), [f"mode {k + 1} [Hz]" for k in range(6)], hz,
                       1e-2 if name == "FV22" else 5e-3,
                       "Navier" if name == "FV13" else RITZ + (", Mindlin" if name == "FV22" else ""))

    def verify_solid(self):
        def calc(m):
            n, cards = 4, ["PSOLID,1,1", "PARAM,COUPMASS,1", "MAT1,1,2.E11,,.3,8000."]
            get_id = lambda i, j, k: (k * (2 * n + 1) + j) * (2 * n + 1) + i + 1
            for k in range(2 * m + 1):
                for j in range(2 * n + 1):
                    for i in range(2 * n + 1):
                        if i % 2 + j % 2 + k % 2 <= 1:
                            x, y, z = 5 * i / n, 5 * j / n, 0.5 * k / m
                            cards.append(f"GRID,{get_id(i, j, k)},,{x:.9E},{y:.9E},{z:.9E},,456")
                            if k == 0 and (i in (0, 2 * n) or j in (0, 2 * n)):
                                cards.append(f"SPC1,1,3,{get_id(i, j, k)}")
            order = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0),
                     (2, 1, 0), (1, 2, 0), (0, 1, 0), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1), (1, 0, 2), (2, 1, 2),
                     (1, 2, 2), (0, 1, 2)]
            for element, (i, j, k) in enumerate((i, j, k) for k in range(m) for j in range(n) for i in range(n)):
                ids = [str(get_id(2 * i + a, 2 * j + b, 2 * k + c)) for a, b, c in order]
                lines = [",".join(ids[a:b]) for a, b in ((0, 6), (6, 14), (14, 20))]
                cards.append(f"CHEXA,{element + 1},1," + "\n,".join(lines))
            return self.run(cards, 10)[3:]
        self.climb("NAFEMS FV52, 4 x 4 x 1 CHEXA20", [1], calc, [f"mode {k + 4} [Hz]" for k in range(6)],
                   [44.762, 110.52, 110.52, 169.08, 193.93, 206.64], 1e-3, "the same mesh in Code_Aster (SDLV109)")

    def calc_buckling(self, a, shear, clamped, supported, n):
        nx, rigidity = round(n * a), UNIT[0] * 0.002**3 / 12 / (1 - 0.3**2)
        mesh = Mesh(nx, n, lambda x, y: (a * x, y))
        mesh.add_plate(UNIT, 0.002, "6")
        mesh.cards += ["SPC1,1,12,1", f"SPC1,1,2,{mesh.get_id(nx, 0)}"]
        mesh.hold(clamped, "345")
        mesh.support(supported)
        pushed, sheared = [("E", -1, 0), ("W", 1, 0)], [("E", 0, 1), ("W", 0, -1), ("N", a, 0), ("S", -a, 0)]
        for edge, fx, fy in sheared if shear else pushed:
            mesh.push(edge, fx, fy)
        return [abs(self.run(mesh.cards, 1, True)[0]) / (math.pi**2 * rigidity)]

    def verify_buckling(self):
        cases = [("uniaxial SSSS, a/b = 1", 1, False, "", "WESN", 4.0, 24),
                 ("uniaxial SSSS, a/b = 2", 2, False, "", "WESN", 4.0, 16),
                 ("uniaxial, sides clamped, a/b = 0.662", 0.662, False, "SN", "WE", 6.971, 32),
                 ("uniaxial, one side free, a/b = 5", 5, False, "", "WES", 0.4642, 12),
                 ("uniaxial CCCC", 1, False, "WESN", "", 10.074, 32),
                 ("shear SSSS, a/b = 1", 1, True, "", "WESN", 9.3245, 32),
                 ("shear SSSS, a/b = 2", 2, True, "", "WESN", 6.546, 24),
                 ("shear CCCC", 1, True, "WESN", "", 14.642, 32)]
        for name, a, shear, clamped, supported, k, n in cases:
            self.climb(f"plate buckling, {n} elements along b", [n // 2, n],
                       lambda n, c=(a, shear, clamped, supported): self.calc_buckling(*c, n), [f"k, {name}"], [k], 5e-3,
                       "Ritz, Kirchhoff")

    def verify_report_plate(self):
        def calc(n):
            mesh = Mesh(n, n * 2 // 3, lambda x, y: (72 * x, 48 * y))
            mesh.add_plate((9.84e4, 0.3, 2.11e-4), 0.1, "6")
            mesh.cards += ["SPC1,1,12,1", f"SPC1,1,2,{mesh.get_id(n, 0)}"]
            mesh.support("WESN")
            mesh.push("E", -48, 0)
            mesh.push("W", 48, 0)
            return self.run(mesh.cards, 1, True)

        for n, tolerance in [(24, 1e-2), (48, 3e-3)]:
            self.climb(f"plate of the report, {n} x {n * 2 // 3}", [n], calc, ["buckling load [lb/in]"], [0.1675],
                       tolerance, "k pi^2 D / b^2; NASTRAN in NASA-CR-202063: 0.167")


def verify(program, folder, add, quick=False):
    """All rows of plates; quick: only the finest mesh of each ladder."""
    plates = Plates(program, folder, add, quick)
    plates.verify_square()
    plates.verify_nafems()
    plates.verify_solid()
    plates.verify_buckling()
    plates.verify_report_plate()
