"""Strains of static solutions: σ = C (ε - α ΔT), constant strain, bending, free expansion, laminates, derived values."""
import json
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest

E, NU, ALPHA, TREF = 7e10, .3, 2e-5, 20.
G = E / (2 * (1 + NU))
HEAD = f"SOL 101\nCEND\nSPC = 1\n{{case}}BEGIN BULK\nMAT1,1,7.+10,,.3,2700.,2.-5,20.\n"
# A distorted patch: the square 2 x 2 in four quadrilaterals about (1.1, .9).
PATCH = {1: (0, 0), 2: (.9, 0), 3: (2, 0), 4: (0, 1.2), 5: (1.1, .9), 6: (2, 1.1), 7: (0, 2), 8: (.8, 2), 9: (2, 2)}
QUADS = [(1, 2, 5, 4), (2, 3, 6, 5), (4, 5, 8, 7), (5, 6, 9, 8)]
OUTER = [g for g in PATCH if g != 5]


def turn(strain, angle):
    """Strains with γ (Jones, eq. 2.75), or curvatures, in axes at `angle`."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]]) @ strain


def calc_plane_law(E1, E2, nu12, G12):
    d = 1 - nu12**2 * E2 / E1
    return np.array([[E1 / d, nu12 * E2 / d, 0], [nu12 * E2 / d, E2 / d, 0], [0, 0, G12]])


def calc_solid_law():
    law = np.diag([2 * G] * 3 + [G] * 3)
    law[:3, :3] += E * NU / (1 + NU) / (1 - 2 * NU)
    return law


class Case:
    """One subcase of a static file."""

    def __init__(self, path, subcase=None):
        self.blocks = {}
        with h5py.File(path) as f:
            case = f["subcases"][subcase or list(f["subcases"])[0]]
            for kind, values in [("stresses", "stress"), ("strains", "strain")]:
                for card, group in case.get(kind, {}).items():
                    names = [n.decode() if isinstance(n, bytes) else n for n in group.attrs["components"]]
                    self.blocks[kind, card] = (list(group["id"][:]), names, group[values][:])
                    if "corner" in group:
                        self.blocks["corner", card] = dict(zip(group["id"][:], group["corner"][:].reshape(len(group["id"]), -1, 6)))

    def get(self, kind, card, names, element):
        ids, all_names, values = self.blocks[kind, card]
        return np.array([values[ids.index(element), all_names.index(n)] for n in names])


def name(components, point):
    return [f"{c}@{point}" if point else c for c in components.split()]


class StrainTest(ProgramTest):
    def solve(self, bulk, case="STRAIN = ALL\n", *arguments):
        self.write("d.bdf", HEAD.format(case=case) + bulk + "ENDDATA\n")
        self.said = self.bough("static", "d.bdf", "-o", "d.h5", *arguments).stderr
        return Case(self.path("d.h5"))


def make_forced(grids, field, dofs):
    """SPC of these dofs of the grids: a field of displacements."""
    text = ""
    for g in grids:
        text += "".join(f"SPC*,1,{g},{d},{v:.9e}\n*,\n" for d, v in zip(dofs, field(g)))
    return text


class Strains(StrainTest):
    def test_patch_of_constant_strain(self):
        """u = ε x on the rim gives ε in every element, in its own axes, and curvature from w and rotations."""
        e = np.array([3e-4, -1e-4, 2e-4])
        k = np.array([2e-3, 5e-4, -8e-4])  # curvatures of ε + z κ: u = z θy, v = -z θx

        def field(g):
            x, y = PATCH[g]
            # w = -½ (κx x² + κy y² + κxy x y); θx = w,y, θy = -w,x.
            return [e[0] * x + e[2] / 2 * y, e[1] * y + e[2] / 2 * x, -(k[0] * x * x + k[1] * y * y + k[2] * x * y) / 2,
                    -(2 * k[1] * y + k[2] * x) / 2, (2 * k[0] * x + k[2] * y) / 2]
        bulk = "PSHELL,1,1,.01,1,,1\n,-.004,.005\n" + "".join(f"GRID,{g},,{x},{y},0.\n" for g, (x, y) in PATCH.items())
        bulk += "".join(f"CQUAD4,{i + 1},1,{','.join(map(str, q))}\n" for i, q in enumerate(QUADS))
        bulk += make_forced(OUTER, field, [1, 2, 3, 4, 5])
        case = self.solve(bulk)
        law = calc_plane_law(E, E, NU, G)
        for i, q in enumerate(QUADS):
            a, b = (np.array(PATCH[g]) for g in q[:2])
            angle = math.atan2(*(b - a)[::-1])
            own, bent = turn(e, angle), turn(k, angle)
            np.testing.assert_allclose(case.get("strains", "CQUAD4", name("xx yy xy", "mid"), i + 1), own, atol=1e-11)
            np.testing.assert_allclose(case.get("strains", "CQUAD4", name("kappa_xx kappa_yy kappa_xy", "mid"), i + 1),
                                       bent, atol=2e-9)
            for side, z in (("bottom", -.004), ("top", .005)):
                found = case.get("strains", "CQUAD4", name("xx yy xy", side), i + 1)
                np.testing.assert_allclose(found, own + z * bent, atol=2e-11)
                np.testing.assert_allclose(case.get("stresses", "CQUAD4", name("xx yy xy", side), i + 1), law @ found,
                                           rtol=1e-9)
                tensor = np.array([[found[0], found[2] / 2, 0], [found[2] / 2, found[1], 0], [0, 0, 0]])
                low, high = np.linalg.eigvalsh(tensor[:2, :2])
                deviator = tensor - np.trace(tensor) / 3 * np.eye(3)
                np.testing.assert_allclose(
                    case.get("strains", "CQUAD4", name("von_mises major minor", side), i + 1),
                    [math.sqrt(2 / 3 * np.sum(deviator**2)), high, low], rtol=1e-9)

    def test_solid_patch(self):
        """Constant strain in a distorted brick, a wedge and a tetrahedron, heated: σ = C (ε - α ΔT) at centre and corners."""
        e = np.array([3e-4, -1e-4, 2e-4, 4e-4, -5e-4, 6e-4])
        cube = {1: (0, 0, 0), 2: (1, 0, .1), 3: (1.2, 1, 0), 4: (0, .9, -.1), 5: (.1, 0, 1), 6: (1, .1, 1.1), 7: (1, 1, .8), 8: (0, 1, 1)}

        def field(g):
            x, y, z = cube[g]
            return [e[0] * x + (e[3] * y + e[5] * z) / 2, e[1] * y + (e[3] * x + e[4] * z) / 2,
                    e[2] * z + (e[4] * y + e[5] * x) / 2]
        bulk = "PSOLID,1,1\n" + "".join(f"GRID,{g},,{x},{y},{z}\n" for g, (x, y, z) in cube.items())
        bulk += "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nCPENTA,2,1,1,2,3,5,6,7\nCTETRA,3,1,1,2,3,7\n"
        bulk += make_forced(cube, field, [1, 2, 3]) + "TEMPD,5,70.\n"
        case = self.solve(bulk, "STRAIN = ALL\nTEMPERATURE(LOAD) = 5\n")
        free = ALPHA * 50 * np.array([1, 1, 1, 0, 0, 0])
        tensor = np.array([[e[0], e[3] / 2, e[5] / 2], [e[3] / 2, e[1], e[4] / 2], [e[5] / 2, e[4] / 2, e[2]]])
        deviator = tensor - np.trace(tensor) / 3 * np.eye(3)
        principal = np.linalg.eigvalsh(tensor)
        for element, card, corners in [(1, "CHEXA", 8), (2, "CPENTA", 6), (3, "CTETRA", 4)]:
            found = case.get("strains", card, "xx yy zz xy yz zx".split(), element)
            np.testing.assert_allclose(found, e, atol=1e-12)
            np.testing.assert_allclose(case.get("stresses", card, "xx yy zz xy yz zx".split(), element),
                                       calc_solid_law() @ (e - free), rtol=1e-7)
            np.testing.assert_allclose(case.get("strains", card, ["von_mises", "major", "minor"], element),
                                       [math.sqrt(2 / 3 * np.sum(deviator**2)), principal[2], principal[0]], rtol=1e-7)
            np.testing.assert_allclose(case.blocks["corner", card][element], np.tile(e, (corners, 1)), atol=1e-12)

    def test_bent_bar(self):
        """ε = P/EA - y κ: what the points of a CBAR and a CBEAM have, and N/EA, T c/(G J) of rods."""
        P, F, L, A, I1 = 5000., 100., 2., 1e-3, 4e-8
        for card, prop in [("CBAR", "PBAR,1,1,1.-3,4.-8,9.-8,1.-8\n,.02,.0,-.02,.0\n"),
                           ("CBEAM", "PBEAM,1,1,1.-3,4.-8,9.-8,,1.-8\n,.02,0.,-.02,0.\n")]:
            case = self.solve(f"GRID,1,,0.,0.,0.\nGRID,2,,{L},0.,0.\n{card},1,1,1,2,0.,1.,0.\n{prop}SPC1,1,123456,1\n"
                              f"FORCE,2,2,,1.,{P},{F},0.\n", "STRAIN = ALL\nLOAD = 2\n")
            kappa = F * L / (E * I1)
            found = case.get("strains", card, ["xx@C_a", "xx@D_a", "xx@C_b", "max", "min"], 1)
            expected = np.array([-.02 * kappa, .02 * kappa, 0, .02 * kappa, -.02 * kappa]) + P / (E * A)
            np.testing.assert_allclose(found, expected, rtol=1e-9)
        case = self.solve("GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCROD,1,1,1,2\nPROD,1,1,2.-4,4.-9,.01\nSPC1,1,123456,1\nSPC1,1,2356,2\n"
                          "FORCE,2,2,,1.,900.,0.,0.\nMOMENT,2,2,,1.,6.,0.,0.\n", "STRAIN = ALL\nLOAD = 2\n")
        np.testing.assert_allclose(case.get("strains", "CROD", ["xx", "torsion"], 1),
                                   [900 / 2e-4 / E, 6 * .01 / 4e-9 / G], rtol=1e-12)
        self.assertEqual(case.blocks["strains", "CROD"][1], ["xx", "torsion"])

    def test_free_expansion(self):
        """Everything warmed by 50 and held nowhere: ε = α ΔT, no stress."""
        xyz = [(i, j, k) for k in range(2) for j in range(2) for i in range(2)]
        bulk = "".join(f"GRID,{n + 1},,{x}.,{y}.,{z}.\n" for n, (x, y, z) in enumerate(xyz))
        bulk += ("PSOLID,1,1\nCHEXA,1,1,1,2,4,3,5,6\n,8,7\nPSHELL,2,1,.01,1,,1\nCQUAD4,2,2,1,2,4,3\nCTRIA3,3,2,1,2,4\n"
                 "CQUADR,4,2,1,2,4,3\nPCOMP,5,,,,,20.\n,1,.002,0.,YES,1,.002,90.,YES\nCQUAD4,5,5,1,2,4,3\n"
                 "PBAR,6,1,1.-3,4.-8,9.-8,1.-8\n,.02,.01,-.02,.03\nCBAR,6,6,1,2,0.,1.,0.\nPBEAM,7,1,1.-3,4.-8,9.-8,,1.-8\n,.02,0.,-.02,0.\n"
                 "CBEAM,7,7,1,2,0.,1.,0.\nPROD,8,1,2.-4,4.-9,.01\nCROD,8,8,1,2\nCONROD,9,1,2,1,1.-4\n"
                 "SPC1,1,123,1\nSPC1,1,23,2\nSPC1,1,3,3\nTEMPD,5,70.\n")
        case = self.solve(bulk, "STRAIN = ALL\nTEMPERATURE(LOAD) = 5\n")
        free = ALPHA * 50
        corners = case.blocks.pop(("corner", "CHEXA"))
        for (kind, card), (_, names, values) in case.blocks.items():
            for component, column in zip(names, values.T):
                base = component.split("@")[0]
                if kind == "stresses":
                    np.testing.assert_allclose(column, 0, atol=1e-5 * E * free, err_msg=f"{card} {component}")
                    continue
                expected = (free if base in ("xx", "yy", "zz", "11", "22", "major", "minor", "max", "min") else 0)
                if base == "von_mises":
                    expected = 0 if card == "CHEXA" else free * 2 / 3
                np.testing.assert_allclose(column, expected, atol=1e-9 * free, err_msg=f"{card} {component}")
        np.testing.assert_allclose(corners[1], free * np.tile([1, 1, 1, 0, 0, 0], (8, 1)), atol=1e-9 * free)

    def test_gradients(self):
        """A bar and a plate with a gradient of temperature, free: κ = α g; held at both ends: none, σ = -E α z g."""
        g = 400.
        plate = "".join(f"GRID,{1 + i + 2 * j},,{i}.,{j}.,0.\n" for j in range(2) for i in range(2))
        plate += ("PSHELL,1,1,.01,1,,1\nCQUAD4,1,1,1,2,4,3\nGRID,11,,0.,0.,5.\nGRID,12,,1.,0.,5.\nPBAR,6,1,1.-3,4.-8,9.-8,1.-8\n,.02,.03\n"
                  f"CBAR,6,6,11,12,0.,1.,0.\nTEMPRB,5,6,70.,70.,{g},{g},{-g / 2},{-g / 2}\nTEMPP1,5,1,70.,{g}\nTEMPD,5,70.\n")
        free = self.solve(plate + "SPC1,1,123456,1,11\n", "STRAIN = ALL\nTEMPERATURE(LOAD) = 5\n")
        held = self.solve(plate + "SPC1,1,123456,1,THRU,4\nSPC1,1,123456,11,12\n", "STRAIN = ALL\nTEMPERATURE(LOAD) = 5\n")
        np.testing.assert_allclose(free.get("strains", "CQUAD4", name("xx yy xy kappa_xx kappa_yy kappa_xy", "mid"), 1),
                                   ALPHA * np.array([50, 50, 0, g, g, 0]), atol=1e-9 * ALPHA * g)
        for i, z in (("bottom", -.005), ("top", .005)):
            np.testing.assert_allclose(free.get("strains", "CQUAD4", name("xx yy xy", i), 1),
                                       ALPHA * (50 + z * g) * np.array([1, 1, 0]), atol=1e-12)
            np.testing.assert_allclose(held.get("strains", "CQUAD4", name("xx yy xy", i), 1), 0, atol=1e-14)
            np.testing.assert_allclose(held.get("stresses", "CQUAD4", name("xx yy", i), 1),
                                       -E / (1 - NU) * ALPHA * (50 + z * g), rtol=1e-9)
        points = ["xx@C_a", "xx@E_a", "xx@C_b", "xx@E_b"]
        warm = ALPHA * np.array([50 + .02 * g - .03 * g / 2, 50] * 2)
        np.testing.assert_allclose(free.get("strains", "CBAR", points, 6), warm, rtol=1e-9)
        np.testing.assert_allclose(held.get("strains", "CBAR", points, 6), 0, atol=1e-14)
        np.testing.assert_allclose(held.get("stresses", "CBAR", points, 6), -E * warm, rtol=1e-9)


class Laminates(StrainTest):
    MAT = "MAT8,8,1.4+11,1.+10,.3,5.+9,5.+9,5.+9,1600.\n,-1.-6,3.-5,20.\n"
    PLIES = [(.001, 0.), (.0015, 45.), (.001, -30.), (.002, 90.)]

    def test_classical_laminate(self):
        """An unsymmetric laminate under N, M and temperature: plies in their own axes, by Jones, 4.2, in numpy."""
        N, M, heat = np.array([2e4, 0, 0]), np.array([30., 0, 0]), 60.
        bulk = self.MAT + "PCOMP,1,,,,,20.\n" + "".join(f",8,{t},{a},YES\n" for t, a in self.PLIES)
        bulk += "".join(f"GRID,{1 + i + 2 * j},,{i}.,{j}.,0.\n" for j in range(2) for i in range(2)) + "CQUAD4,1,1,1,2,4,3\n"
        bulk += "SPC1,1,123,1\nSPC1,1,13,3\nSPC1,1,3,2\n" + f"TEMPD,5,{20 + heat}\n"
        for sign, grids in ((1, (2, 4)), (-1, (1, 3))):
            bulk += "".join(f"FORCE,2,{g},,{sign * N[0] / 2},1.,0.,0.\nMOMENT,2,{g},,{sign * M[0] / 2},0.,1.,0.\n" for g in grids)
        case = self.solve(bulk, "STRAIN = ALL\nLOAD = 2\nTEMPERATURE(LOAD) = 5\n")
        law, alpha = calc_plane_law(1.4e11, 1e10, .3, 5e9), np.array([-1e-6, 3e-5, 0])
        z, ABD, held, layers = -sum(t for t, _ in self.PLIES) / 2, np.zeros((6, 6)), np.r_[N, M], []
        for t, degrees in self.PLIES:
            T = turn(np.eye(3), math.radians(degrees))
            Q, q = T.T @ law @ T, T.T @ law @ alpha * heat
            d1, d2, d3 = t, ((z + t)**2 - z**2) / 2, ((z + t)**3 - z**3) / 3
            ABD += np.block([[Q * d1, Q * d2], [Q * d2, Q * d3]])
            held = held + np.r_[q * d1, q * d2]
            layers.append((z + t / 2, T))
            z += t
        e = np.linalg.solve(ABD, held)
        np.testing.assert_allclose(case.get("strains", "CQUAD4", name("xx yy xy kappa_xx kappa_yy kappa_xy", "mid"), 1), e,
                                   rtol=1e-6, atol=1e-9)
        for k, (z, T) in enumerate(layers):
            own = T @ (e[:3] + z * e[3:])
            found = case.get("strains", "CQUAD4", name("11 22 12", f"ply{k + 1}"), 1)
            np.testing.assert_allclose(found, own, rtol=1e-6, atol=1e-9)
            np.testing.assert_allclose(case.get("stresses", "CQUAD4", name("11 22 12", f"ply{k + 1}"), 1),
                                       law @ (found - alpha * heat), rtol=1e-6, atol=10)


class Outputs(StrainTest):
    RODS = ("MAT1,2,100.,40.,,1.\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nPROD,1,2,2.,1.5,.5\nCROD,11,1,1,2\nSPC1,1,23456,2\n"
            "SPC1,1,123456,1\nFORCE,1,2,,10.,1.,0.,0.\nFORCE,2,2,,-20.,1.,0.,0.\n")

    def test_where_they_stand(self):
        cases = "SUBCASE 1\nLOAD = 1\nSUBCASE 2\nLOAD = 2\nSUBCOM 3\nSUBSEQ = 2., 1.\n"
        self.solve(self.RODS, cases)
        with h5py.File(self.path("d.h5")) as f:
            self.assertNotIn("strains", f["subcases/1"])
        self.solve(self.RODS, cases, "--strains", "--extremes")
        for number, strain in (("1", .05), ("2", -.1), ("3", 0.)):
            self.assertAlmostEqual(Case(self.path("d.h5"), number).get("strains", "CROD", ["xx"], 11)[0], strain, delta=1e-14)
        with h5py.File(self.path("d.h5")) as f:
            group = f["extremes/strains/CROD"]
            self.assertEqual((group["min_subcase"][0, 0], group["max_subcase"][0, 0]), (2, 1))
        data = json.loads(self.bough("static", "d.bdf", "--strains", "--json", "--full").stdout)
        self.assertAlmostEqual(data["subcases"][0]["strains"]["CROD"]["strain"][0][0], .05)
        self.assertIn("CROD strain", self.bough("static", "d.bdf", "--strains").stdout)
        self.assertNotIn("CROD strain", self.bough("static", "d.bdf").stdout)
        # STRAIN = ALL of one subcase alone is enough; NONE is not.
        self.solve(self.RODS, cases.replace("SUBCASE 2\n", "SUBCASE 2\nSTRAIN(FIBER) = ALL\n"))
        self.assertNotIn("not used", self.said)
        self.assertAlmostEqual(Case(self.path("d.h5"), "1").get("strains", "CROD", ["xx"], 11)[0], .05, delta=1e-14)
        self.solve(self.RODS, "STRAIN = NONE\n" + cases)
        with h5py.File(self.path("d.h5")) as f:
            self.assertNotIn("strains", f["subcases/1"])


if __name__ == "__main__":
    unittest.main()
