"""Grid point stresses (GPSTRESS, STRFIELD, SURFACE, VOLUME): constant and linear fields, means of corner stresses by hand."""
import math
import re
import unittest

import h5py
import numpy as np

from op2_reader import Op2
from strain_test import OUTER, PATCH, QUADS, make_forced
from support import ProgramTest

E, NU, T = 7e10, .3, .01
MAT = "MAT1,1,7.+10,,.3,2700.\n"
LAW = E / (1 - NU**2) * np.array([[1, NU, 0], [NU, 1, 0], [0, 0, (1 - NU) / 2]])
SHELLS = MAT + f"PSHELL,1,1,{T},1,,1\n" + "".join(f"GRID,{g},,{x},{y},0.\n" for g, (x, y) in PATCH.items()) + "".join(
    f"CQUAD4,{k + 11},1," + ",".join(map(str, q)) + "\n" for k, q in enumerate(QUADS))
E0, K0 = np.array([3e-4, -1e-4, 2e-4]), np.array([2e-3, 5e-4, -8e-4])


def patch_motion(g):
    """Constant strain E0 and curvature K0, ε = E0 + z K0."""
    (x, y), (ex, ey, g0), (kx, ky, kxy) = PATCH[g], E0, K0
    w = -(kx * x * x + ky * y * y + kxy * x * y) / 2
    return [ex * x + g0 * y / 2, ey * y + g0 * x / 2, w, -(ky * y + kxy * x / 2), kx * x + kxy * y / 2]


def turn(s, angle):
    c, n = math.cos(angle), math.sin(angle)
    R = np.array([[c, n], [-n, c]])
    t = R @ np.array([[s[0], s[2]], [s[2], s[1]]]) @ R.T
    return np.array([t[0, 0], t[1, 1], t[0, 1]])


class GridStressTest(ProgramTest):
    def solve(self, bulk, post, case="GPSTRESS = ALL\n", verb="static"):
        self.write("d.bdf", f"SOL 101\nCEND\nSPC = 1\n{case}OUTPUT(POST)\n{post}BEGIN BULK\n{bulk}ENDDATA\n")
        self.messages = self.bough(verb, "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06").stderr
        self.f06 = self.read("d.f06")
        for line in self.f06.splitlines():
            self.assertLessEqual(len(line), 132, line)
        return Op2(self.path("d.op2")).grid_stresses()

    def fails(self, post, pattern, case="GPSTRESS = ALL\n", bulk=None):
        self.write("d.bdf", f"SOL 101\nCEND\nSPC = 1\n{case}{post}BEGIN BULK\n{bulk or self.patch()}ENDDATA\n")
        self.assertRegex(self.bough("static", "d.bdf", "--op2", "d.op2", code=1).stderr, pattern)

    def patch(self):
        return SHELLS + make_forced(OUTER, patch_motion, (1, 2, 3, 4, 5)) + "SPC1,1,6,1,THRU,9\n"


class Surfaces(GridStressTest):
    def test_constant_field(self):
        """All grids have σ = D (ε + z κ) at Z1, Z2 and MID, whatever the method."""
        for method in ("", " TOPOLOGICAL", " GEOMETRIC"):
            rows = self.solve(self.patch(), f"SET 9 = 11 THRU 14\nSURFACE 10 SET 9 NORMAL X3{method}\n")[26, 1, 10]
            self.assertEqual([row[:3] for row in rows], [(g, 0, f) for g in sorted(PATCH) for f in (b"Z1  ", b"Z2  ", b"MID ")])
            for row in rows:
                z = {b"Z1  ": -T / 2, b"Z2  ": T / 2, b"MID ": 0}[row[2]]
                s = LAW @ (E0 + z * K0)
                scale = abs(s).max()
                np.testing.assert_allclose(row[3:6], s, atol=1e-5 * scale)
                minor, major = np.linalg.eigvalsh([[s[0], s[2]], [s[2], s[1]]])
                mises = math.sqrt(s[0]**2 - s[0] * s[1] + s[1]**2 + 3 * s[2]**2)
                np.testing.assert_allclose(row[7:], [major, minor, (major - minor) / 2, mises], atol=1e-5 * scale)
                np.testing.assert_allclose(turn(s, math.radians(row[6])), [major, minor, 0], atol=1e-5 * scale)

    def test_axes(self):
        """CORD turns the components, AXIS X2 by 90 degrees; MX3 looks from below: Z1 and Z2 change places, so does y."""
        z = T / 2
        low, high = LAW @ (E0 - z * K0), LAW @ (E0 + z * K0)
        a = math.radians(30)
        cord = f"CORD2R,5,,0.,0.,0.,0.,0.,1.\n,{math.cos(a)!r},{math.sin(a)!r},0.\n"
        for words, z1, z2 in ((" NORMAL Z", low, high), (" AXIS Y NORMAL X3", turn(low, math.pi / 2), turn(high, math.pi / 2)),
                              (" SYSTEM CORD 5 NORMAL X3", turn(low, a), turn(high, a)),
                              (" NORMAL MX3", high * [1, 1, -1], low * [1, 1, -1])):
            rows = self.solve(self.patch() + cord, f"SET 9 = ALL\nSURFACE 10 SET 9 FIBRE Z1, Z2{words}\n")[26, 1, 10]
            with self.subTest(words):
                self.assertEqual(len(rows), 18)
                for row in rows:
                    np.testing.assert_allclose(row[3:6], z1 if row[2] == b"Z1  " else z2, atol=1e-5 * abs(high).max())

    def test_cylinder(self):
        """SYSTEM CORD of a cylinder, NORMAL R: hoop stress p R / t is the first component of AXIS X2 at each grid."""
        R, n = 2.0, 12
        grids = "".join(f"GRID,{1 + j * n + i},7,{R},{360 * i / n},{float(j)},7\n" for j in (0, 1) for i in range(n))
        shells = "".join(f"CQUAD4,{i + 1},1,{1 + i},{1 + (i + 1) % n},{1 + n + (i + 1) % n},{1 + n + i}\n" for i in range(n))
        bulk = (MAT + f"PSHELL,1,1,{T},1,,1\nCORD2C,7,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n" + grids + shells +
                "SPC1,1,23456,1,THRU,12\nSPC1,1,2456,13,THRU,24\n" +
                "".join(f"FORCE,2,{g},7,1.,1000.,0.,0.\n" for g in range(1, 25)))
        for words, hoop in (("AXIS X2", 0), ("AXIS X3", 1)):
            rows = self.solve(bulk, f"SET 9 ALL\nSURFACE 10 SET 9 FIBRE MID SYSTEM CORD 7 {words} NORMAL R\n",
                              "GPSTRESS = ALL\nLOAD = 2\n")[26, 1, 10]
            expected = 1000. / math.sin(math.pi / n) / T  # F = 2 N sin(α/2) of each ring, α = 2π/n
            for row in rows:
                self.assertAlmostEqual(row[3 + hoop] / expected, 1, delta=2e-3)
                self.assertAlmostEqual(row[4 - hoop] / expected, 0, delta=2e-3)

    def test_linear_field(self):
        """A cantilever strip under an edge load: σ = z M(x) / I of the tip load, linear along x, at every grid."""
        n, P, b = 4, 8., .5
        bulk = MAT.replace(",.3", ",0.") + f"PSHELL,1,1,{T},1,,1\n" + "".join(
            f"GRID,{1 + i + j * (n + 1)},,{i / n * 2:.4f},{j * b:.4f},0.\n" for j in (0, 1) for i in range(n + 1))
        bulk += "".join(f"CQUAD4,{i + 1},1,{1 + i},{2 + i},{n + 3 + i},{n + 2 + i}\n" for i in range(n))
        bulk += f"SPC1,1,123456,1,{n + 2}\nFORCE,2,{n + 1},,{P / 2},0.,0.,1.\nFORCE,2,{2 * n + 2},,{P / 2},0.,0.,1.\n"
        for method in ("TOPOLOGICAL", "GEOMETRIC"):
            rows = self.solve(bulk, f"SET 9 = ALL\nSURFACE 10 SET 9 FIBRE Z2 NORMAL X3 {method}\n", "GPSTRESS = ALL\nLOAD = 2\n")[26, 1, 10]
            for row in rows:
                x = ((row[0] - 1) % (n + 1)) / n * 2
                # w'' = P (L - x) / EI > 0: the upper side is pressed.
                self.assertAlmostEqual(row[3], -P * (2 - x) * (T / 2) / (b * T**3 / 12), delta=1e-4 * P * 2 * 6 / b / T**2)

    def corner_stresses(self, block, element, grids, side):
        """x y xy in the element's axes at its corners: bilinear through the four quadrature points."""
        ids, names, force = block
        values = dict(zip(names, force[ids.index(element)]))
        s3 = math.sqrt(3)
        def at(name, r, s):
            return sum((1 + p * r * s3) * (1 + q * s * s3) / 4 * values[f"{name}@{k + 1}"]
                       for k, (p, q) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1))))
        return [np.array([at(f"N{c}", r, s) / T + side * 6 * at(f"M{c}", r, s) / T**2 for c in ("x", "y", "xy")])
                for r, s in ((-1, -1), (1, -1), (1, 1), (-1, 1))]

    def test_means_by_hand(self):
        """A distorted plate under loads: the mean, and the plane through all corner values, of the connected elements."""
        bulk = SHELLS + "SPC1,1,123456,1,4,7\nFORCE,2,9,,500.,1.,.4,.1\nFORCE,2,3,,300.,.3,-1.,-.2\nFORCE,2,5,,90.,0.,0.,1.\n"
        for method in ("TOPOLOGICAL", "GEOMETRIC"):
            rows = self.solve(bulk, f"SET 9 = 11,12,14\nSURFACE 10 SET 9 FIBRE Z2 NORMAL X3 {method}\n", "GPSTRESS = ALL\nLOAD = 2\n")[26, 1, 10]
            with h5py.File(self.path("d.h5")) as f:
                group = f["subcases"][list(f["subcases"])[0]]["elements/CQUAD4"]
                block = list(group["id"][:]), [n.decode() if isinstance(n, bytes) else n for n in group.attrs["components"]], group["force"][()]
            members = {}
            for element in (11, 12, 14):
                quad = QUADS[element - 11]
                x = np.array([PATCH[g] for g in quad])
                angle = math.atan2(*(x[1] - x[0])[::-1])
                members[element] = quad, x, [turn(s, -angle) for s in self.corner_stresses(block, element, quad, 1)]
            scale = max(abs(s).max() for _, _, corners in members.values() for s in corners)
            self.assertEqual([row[0] for row in rows], [g for g in sorted(PATCH) if g != 7])
            for row in rows:
                connected = [(quad, x, s) for quad, x, s in members.values() if row[0] in quad]
                if method == "TOPOLOGICAL":
                    expected = np.mean([s[quad.index(row[0])] for quad, _, s in connected], axis=0)
                else:
                    A = np.array([[1, *(p - PATCH[row[0]])] for _, x, _ in connected for p in x])
                    expected = np.linalg.lstsq(A, np.array([v for _, _, s in connected for v in s]), rcond=None)[0][0]
                np.testing.assert_allclose(row[3:6], expected, atol=2e-6 * scale)

    def test_folds_and_branches(self):
        """A T of plates: TOLERANCE -30 and BRANCH BREAK give the edge one row per element; otherwise one mean."""
        grids = {1: (0, 0, 0), 2: (1, 0, 0), 3: (0, 1, 0), 4: (1, 1, 0), 5: (0, 2, 0), 6: (1, 2, 0), 7: (0, 1, 1), 8: (1, 1, 1)}
        bulk = MAT + f"PSHELL,1,1,{T},1,,1\n" + "".join(f"GRID,{g},,{x}.,{y}.,{z}.\n" for g, (x, y, z) in grids.items())
        bulk += "CQUAD4,11,1,1,2,4,3\nCQUAD4,12,1,3,4,6,5\nCQUAD4,13,1,3,4,8,7\nSPC1,1,123456,1,2\nFORCE,2,6,,9.,1.,0.,1.\n"
        for words, count in ((" TOLERANCE -30.", 3), (" BRANCH BREAK", 3), (" BRANCH NOBREAK", 1), (" TOLERANCE 30. BRANCH NOBREAK", 1), ("", 1)):
            rows = self.solve(bulk, f"SET 9 = ALL\nSURFACE 10 SET 9 FIBRE MID NORMAL R{words}\n", "GPSTRESS = ALL\nLOAD = 2\n")[26, 1, 10]
            with self.subTest(words):
                self.assertEqual([row[1] for row in rows if row[0] == 3], [11, 12, 13] if count == 3 else [0])
                self.assertEqual([row[1] for row in rows if row[0] == 7], [0])

    def test_listing_and_selection(self):
        """STRFIELD writes no page, a SET of surfaces selects, the page has the numbers of the file; modes have them too."""
        post = "SET 9 = 11,12\nSET 8 = 13,14\nSET 1 = 20\nSURFACE 10 SET 9 NORMAL X3\nSURFACE 20 SET 8 FIBRE MID NORMAL X3\n"
        found = self.solve(self.patch(), post, "GPSTRESS = 1\nSTRFIELD = ALL\n")
        self.assertEqual(list(found), [(26, 1, 10), (26, 1, 20)])
        self.assertNotRegex(self.f06, r"S U R F A C E +10")
        self.assertRegex(self.f06, r"S T R E S S E S   A T   G R I D   P O I N T S   - -     S U R F A C E +20")
        lines = [line for line in self.f06.splitlines() if re.match(r"0 +\d+ +0 +MID", line)]
        for line, row in zip(lines, found[26, 1, 20], strict=True):
            words = line[1:].split()
            self.assertEqual(int(words[0]), row[0])
            np.testing.assert_allclose([float(w) for w in words[3:]], row[3:], rtol=1e-3, atol=1e3)
        self.assertNotIn("unlisted", self.messages)
        modes = self.patch().split("SPC*")[0] + "SPC1,1,123456,1,2,3\nEIGRL,3,,,2\n"
        self.assertEqual(len(self.solve(modes, post, "METHOD = 3\nGPSTRESS = ALL\n", "modes")[26, 1, 10]), 18)

    def test_wrong_input(self):
        surface = "OUTPUT(POST)\nSET 9 = ALL\nSURFACE 10 SET 9 "
        self.fails("OUTPUT(POST)\nSURFACE 10 SET 9 NORMAL X3\n", r"d.bdf:\d+: error: SURFACE 10 names SET 9.*\[cli.missing-set\]")
        self.fails(surface + "NORMAL X3\n", r"error: GPSTRESS = 4 names a SET.*\[cli.missing-set\]", "GPSTRESS = 4\n")
        self.fails(surface + "AXIS X3 NORMAL X3\n", r"d.bdf:\d+: error: SURFACE 10: its AXIS is along the normal of element 11.*\[cli.surface-axis\]")
        for words in ("NORMAL Q", "FIBRE TOP", "AXIS 7", "SYSTEM CORD X", "TOLERANCE", "NORMALE X3"):
            self.fails(surface + words + "\n", r"d.bdf:\d+: error: SURFACE 10 SET 9 .*expected .*\[deck.case-control-value\]")
        self.fails("OUTPUT(POST)\nSURFACE X SET 9\n", r"SURFACE X SET 9: expected an id.*\[deck.case-control-value\]")
        self.fails("OUTPUT(POST)\nSURFACE 3 NORMAL X3\n", r"expected SET.*\[deck.case-control-value\]")
        self.fails(surface + "SYSTEM CORD 44 NORMAL X3\n", r"\[fe.missing-coordinates\]")
        self.write("d.bdf", f"SOL 101\nCEND\nSPC = 1\nGPSTRESS = ALL\nBEGIN BULK\n{self.patch()}ENDDATA\n")
        self.assertRegex(self.bough("static", "d.bdf", "--op2", "d.op2").stderr, r"warning: GPSTRESS lists surfaces.*\[cli.missing-set\]")
        self.write("d.bdf", f"SOL 101\nCEND\nSPC = 1\nGPSTRESS = ALL\n{surface}NORMAL X3\nBEGIN BULK\n{self.patch()}ENDDATA\n")
        self.assertRegex(self.bough("static", "d.bdf").stderr, r"the deck requests GPSTRESS.*\[cli.request-by-option\]")
        laminate = self.patch().replace(f"PSHELL,1,1,{T},1,,1\n", f"PCOMP,1\n,1,{T},0.,YES\n")
        self.assertEqual(self.solve(laminate, "SET 9 = ALL\nSURFACE 10 SET 9 NORMAL X3\n"), {})
        self.assertRegex(self.messages, r"no grid point stresses of CQUAD4.*\[cli.unlisted-elements\]")


class Volumes(GridStressTest):
    N, M = 5000., 80.

    def bricks(self):
        """Two bricks in tension and bending: σ = N/A + M z/I at each grid."""
        grids = {1 + i + 3 * j + 6 * k: (i * .5, j * .2, k * .1) for k in (0, 1) for j in (0, 1) for i in (0, 1, 2)}
        bulk = MAT + "PSOLID,1,1\n" + "".join(f"GRID,{g},,{x:.3f},{y:.3f},{z:.3f}\n" for g, (x, y, z) in grids.items())
        bulk += "".join(f"CHEXA,{1 + i},1,{1 + i},{2 + i},{5 + i},{4 + i},{7 + i},{8 + i}\n,{11 + i},{10 + i}\n" for i in (0, 1))
        bulk += "SPC1,1,1,1,4,7,10\nSPC1,1,2,1\nSPC1,1,3,1,4\n"
        for g in (3, 6, 9, 12):
            bulk += f"FORCE,2,{g},,{self.N / 4 + (1 if grids[g][2] > 0 else -1) * self.M / .1 / 2},1.,0.,0.\n"
        return grids, bulk

    def test_linear_field(self):
        grids, bulk = self.bricks()
        found = self.solve(bulk, "VOLUME 21\n", "GPSTRESS = ALL\nLOAD = 2\n")
        self.assertEqual(list(found), [(27, 1, 21), (28, 1, 21)])
        for direct, main in zip(found[27, 1, 21], found[28, 1, 21], strict=True):
            s = self.N / .02 + self.M * (grids[direct[0]][2] - .05) / (.2 * .1**3 / 12)
            np.testing.assert_allclose(direct[1:], [s, 0, 0, 0, 0, 0, -s / 3, abs(s)], atol=1e-4 * abs(s))
            self.assertEqual(main[0], direct[0])
            np.testing.assert_allclose(main[10:], [max(s, 0), 0, min(s, 0), -s / 3, abs(s)], atol=1e-4 * abs(s))
            L = np.reshape(main[1:10], (3, 3))  # rows x y z, columns a b c
            np.testing.assert_allclose(L @ np.diag(main[10:13]) @ L.T, np.diag([s, 0, 0]), atol=1e-4 * abs(s))
            np.testing.assert_allclose(L.T @ L, np.eye(3), atol=1e-5)
        for title in ("D I R E C T", "P R I N C I P A L"):
            self.assertRegex(self.f06, title + r"   S T R E S S E S   A T   G R I D   P O I N T S   - -       V O L U M E +21")
        self.assertRegex(self.f06, r"OUTPUT COORDINATE SYSTEM = +0  BASIC")

    def test_axes_and_choices(self):
        """A system whose y is the x of basic; DIRECT alone; a SET of one element."""
        grids, bulk = self.bricks()
        found = self.solve(bulk + "CORD2R,5,,0.,0.,0.,0.,0.,1.\n,0.,-1.,0.\n", "SET 2 = 1\nVOLUME 21 SET 2 DIRECT SYSTEM CORD 5\n",
                           "GPSTRESS = ALL\nLOAD = 2\n")
        self.assertEqual(list(found), [(27, 1, 21)])
        rows = found[27, 1, 21]
        self.assertEqual([row[0] for row in rows], [1, 2, 4, 5, 7, 8, 10, 11])
        for row in rows:
            s = self.N / .02 + self.M * (grids[row[0]][2] - .05) / (.2 * .1**3 / 12)
            np.testing.assert_allclose(row[1:4], [0, s, 0], atol=1e-4 * abs(s))


if __name__ == "__main__":
    unittest.main()
