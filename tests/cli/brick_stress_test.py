"""Stresses of CHEXA, CQUAD4 and CTRIA3 against a vendor's; a cube under warping tractions against fine meshes."""
import os
import struct
import unittest

import h5py
import numpy as np

from op2_reader import Op2
from stress_listing_test import read_stresses
from support import ProgramTest

SHARED = os.path.join(os.environ.get("BOUGH_SHARED_DIR", ""), "models", "complex", "modes_complex_elements.op2")
CORNERS = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)], float)
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]
POLYNOMIAL = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1), (1, 1, 1)]


def fit(values):
    """Coefficients of 1 x y z xy yz zx xyz of values at the corners."""
    return np.linalg.solve([[np.prod(c**np.array(p)) for p in POLYNOMIAL] for c in CORNERS], values)


def read_vendor(path):
    """Records of tables: (name, words of the ident, data); the file has tables of geometry, which Op2 does not read."""
    with open(path, "rb") as f:
        data = f.read()
    records, at = [], 0
    while at < len(data):
        (n,) = struct.unpack_from("<i", data, at)
        records.append(data[at + 4:at + 4 + n])
        at += n + 8
    name, found, ident = None, [], None
    for record in records:
        if len(record) == 8 and record.strip().isalnum() and not record.isdigit():
            name, ident = record.decode().strip(), None
        elif len(record) == 584:
            ident = struct.unpack_from("<50i", record)
        elif ident and len(record) > 8:
            found.append((name, ident, record))
            ident = None
    return found


class Vendor(ProgramTest):
    @unittest.skipUnless(os.path.isfile(SHARED), f"no file {SHARED}")
    def test_corner_stresses_of_one_motion(self):
        """A unit cube, the displacements of a mode of NX Nastran 10.1: constant and linear terms of all stresses are equal.
        Of the bilinear ones NX has E ε of the direct strains alone, this element C11 ε, their Poisson terms and shears."""
        nodes = [2, 3, 4, 1, 8, 5, 6, 7]
        X = {1: (0, 0, 0), 2: (1, 0, 0), 3: (1, 1, 0), 4: (0, 1, 0), 5: (1, 1, 1), 6: (0, 1, 1), 7: (0, 0, 1), 8: (1, 0, 1)}
        records = read_vendor(SHARED)
        data = next(data for name, _, data in records if name == "OUG1" or name == "OUGV1")
        rows = {row[0] // 10: row[2:5] for row in struct.iter_unpack("<2i12f", data)}
        data = next(data for name, ident, data in records if ident[2] == 67 and ident[1] == 1005 and name.startswith("OES"))
        stress = {row[0]: row[1:7] for row in struct.iter_unpack("<i12f", data[16:])}
        scale = 1e10
        bulk = "MAT1,1,2.9+7,1.1+7,.32\nPSOLID,1,1\nCHEXA,1,1," + ",".join(map(str, nodes[:6])) + "\n," + ",".join(map(str, nodes[6:])) + "\n"
        for g, x in X.items():
            bulk += "GRID,%d,,%d.,%d.,%d.\n" % (g, *x)
            bulk += "".join(f"SPC*,1,{g},{c + 1},{scale * rows[g][c]:.9e}\n*,\n" for c in range(3))
        self.write("d.bdf", "SOL 101\nCEND\nSPC = 1\nSTRESS = ALL\nBEGIN BULK\n" + bulk + "ENDDATA\n")
        self.bough("static", "d.bdf", "--op2", "d.op2")
        own = read_stresses(Op2(self.path("d.op2")))[67, 1]
        order = [nodes[i] for i in (3, 0, 1, 2, 7, 4, 5, 6)]  # by the corners of the cube
        # Natural coordinates of CORNERS are x y z of the cube: grid 1 first.
        ours = fit([[own[g][k] for k in (0, 8, 14, 1, 9, 15)] for g in order])
        theirs = fit([[scale * s for s in stress[g]] for g in order])
        size = np.abs(theirs).max()
        np.testing.assert_allclose(ours[:4], theirs[:4], atol=5e-5 * size)
        np.testing.assert_allclose(ours[0, :3], [scale * s for s in stress[0][:3]], atol=5e-5 * size)
        c = 29e6 / 1.32 / .36
        law = c * np.array([[.68, .32, .32], [.32, .68, .32], [.32, .32, .68]])
        strain = np.linalg.solve(law, ours[4:7, :3].T).T  # rows xy yz zx
        expected = np.zeros((3, 3))
        expected[1, 0], expected[2, 1], expected[0, 2] = 29e6 * strain[1, 0], 29e6 * strain[2, 1], 29e6 * strain[0, 2]
        np.testing.assert_allclose(theirs[4:7, :3], expected, atol=5e-5 * size)
        np.testing.assert_allclose(theirs[4:, 3:], 0, atol=5e-5 * size)


class InPlaneShear(ProgramTest):
    @unittest.skipUnless(os.path.isfile(SHARED), f"no file {SHARED}")
    def test_vendor(self):
        """CTRIA3 of NX Nastran 10.1 with MAT1 2.9+7, 1.1+7, .32: τ of the reference surface is E / 2(1 + NU) γ, not G γ."""
        tables = {}
        for name, ident, data in read_vendor(SHARED):
            if ident[2] == 74 and ident[1] == 1005:
                tables.setdefault(name[:4], [row for row in struct.iter_unpack("<i14f", data)])
        ratios = [(s[6] + s[13]) / 2 / e[6] for s, e in zip(tables["OES1"], tables["OSTR"], strict=True)]
        np.testing.assert_allclose(ratios, 2.9e7 / 2.64, rtol=1e-5)

    def test_shells(self):
        """CQUAD4 and CTRIA3 of Bough sheared by γ have τ = E / 2(1 + NU) γ."""
        gamma, modulus = 2e-4, 2.9e7 / 2.64
        grids = {1: (0, 0), 2: (1, 0), 3: (1, 1), 4: (0, 1)}
        bulk = "MAT1,1,2.9+7,1.1+7,.32\nPSHELL,1,1,.1,1,,1\nSPC1,1,3456,1,THRU,4\n" + "".join(
            f"GRID,{g},,{x}.,{y}.,0.\nSPC,1,{g},1,{gamma * y!r}\nSPC,1,{g},2,0.\n" for g, (x, y) in grids.items())
        for cards, kinds in (("CQUAD4,1,1,1,2,3,4\n", (33,)), ("CTRIA3,1,1,1,2,3\nCTRIA3,2,1,1,3,4\n", (74, 74))):
            self.write("d.bdf", "SOL 101\nCEND\nSPC = 1\nSTRESS = ALL\nBEGIN BULK\n" + bulk + cards + "ENDDATA\n")
            self.bough("static", "d.bdf", "--op2", "d.op2")
            found = read_stresses(Op2(self.path("d.op2")))
            self.assertEqual([kind for kind, _ in found], list(kinds))
            for row in found.values():
                np.testing.assert_allclose(row[5], modulus * gamma, rtol=1e-5)  # major principal stress


class Warping(ProgramTest):
    def flexibility(self, n, is_quadratic=False):
        """F·u of the cube |x| ≤ 1, E = 1, ν = 0.3, under tractions σxx = ±y z on x = ±1, in n³ elements."""
        ids, loads, elements = {}, {}, []
        def node(x):
            return ids.setdefault(tuple(np.round(x, 9)), len(ids) + 1)
        g = np.sqrt(.6)
        gauss = [(-g, 5 / 9), (0, 8 / 9), (g, 5 / 9)]
        for k in range(n):
            for j in range(n):
                for i in range(n):
                    centre = -1 + (2 * np.array([i, j, k]) + 1) / n
                    x = [centre + c / n for c in CORNERS]
                    natural = list(CORNERS)
                    if is_quadratic:
                        natural += [(CORNERS[a] + CORNERS[b]) / 2 for a, b in EDGES]
                        x = [centre + c / n for c in natural]
                    elements.append([node(p) for p in x])
                    for end in (-1, 1):
                        if abs(centre[0] + end / n - end) > 1e-9:
                            continue
                        for r, wr in gauss:
                            for s, ws in gauss:
                                y, z = centre[1] + r / n, centre[2] + s / n
                                for at, (p, q, t) in zip(x, natural):
                                    if p != end:
                                        continue
                                    if not is_quadratic:
                                        N = (1 + q * r) * (1 + t * s) / 4
                                    elif q == 0:
                                        N = (1 - r * r) * (1 + t * s) / 2
                                    elif t == 0:
                                        N = (1 + q * r) * (1 - s * s) / 2
                                    else:
                                        N = (1 + q * r) * (1 + t * s) * (q * r + t * s - 1) / 4
                                    g_id = node(at)
                                    loads[g_id] = loads.get(g_id, 0) + end * wr * ws / n**2 * N * y * z
        bulk = "MAT1,1,1.,,.3\nPSOLID,1,1\n" + "".join("GRID,%d,,%.9f,%.9f,%.9f\n" % (i, *x) for x, i in ids.items())
        for e, nodes in enumerate(elements):
            lines = [nodes[:6]] + [nodes[a:a + 8] for a in range(6, len(nodes), 8)]
            bulk += f"CHEXA,{e + 1},1," + "\n,".join(",".join(map(str, line)) for line in lines) + "\n"
        bulk += "".join(f"FORCE*,2,{i},0,{f:.12e}\n*,1.,0.,0.\n" for i, f in loads.items())
        corner = [node(c) for c in CORNERS]
        bulk += f"SPC1,1,123,{corner[0]}\nSPC1,1,23,{corner[1]}\nSPC1,1,3,{corner[3]}\n"
        self.write("d.bdf", "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nDISP = ALL\nBEGIN BULK\n" + bulk + "ENDDATA\n")
        self.bough("static", "d.bdf", "-o", "d.h5")
        with h5py.File(self.path("d.h5")) as f:
            u = f["subcases"][list(f["subcases"])[0]]["displacement"][()].reshape(-1)
            rows = {(int(g), int(c)): r for r, (g, c) in enumerate(f["dof_map"][()])}
        return sum(f * u[rows[i, 1]] for i, f in loads.items())

    def test_one_brick_is_stiff_in_warping(self):
        """Quadratic bricks converge to 0.776; one brick has 54 % of it, 2³ and 4³ 91 and 98 % (docs/elements/solid.md)."""
        exact = self.flexibility(4, True)
        self.assertAlmostEqual(exact, .776, delta=.001)
        for n, part in ((1, .541), (2, .907), (4, .975)):
            self.assertAlmostEqual(self.flexibility(n) / exact, part, delta=.004)


if __name__ == "__main__":
    unittest.main()
