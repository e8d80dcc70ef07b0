"""Stresses of static solutions, forces on grids, energies of elements in modes, each against a closed form."""
import json
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest
from decks import mesh

HEAD = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\n"


def make_beam(elements, property_cards, load, card="CBAR"):
    """A cantilever of length 2 along x, grid 1 held."""
    text = HEAD
    for i in range(elements + 1):
        text += f"GRID,{i + 1},,{2 * i / elements:.12g},0.,0.\n"
    for i in range(elements):
        text += f"{card},{i + 1},1,{i + 1},{i + 2},0.,1.,0.\n"
    return text + property_cards + load + "SPC1,1,123456,1\nENDDATA\n"


def make_plate(cards, loads, n=1):
    """A square of side 1 in n x n CQUAD4, its first grid held, rigid motions alone taken away."""
    return HEAD + mesh(n, n, lambda i, j: f"{i / n:.12g},{j / n:.12g},0.") + cards + loads + f"SPC1,1,123,1\nSPC1,1,23,{n + 1}\nSPC1,1,3,{n * (n + 1) + 1}\nENDDATA\n"


class Case:
    """One subcase of a static file: stress(card, component) by element id."""

    def __init__(self, path):
        self.blocks = {}
        with h5py.File(path) as f:
            case = f["subcases"][list(f["subcases"])[0]]
            for kind, values in [("elements", "force"), ("stresses", "stress")]:
                for card, group in case.get(kind, {}).items():
                    names = [n.decode() if isinstance(n, bytes) else n for n in group.attrs["components"]]
                    self.blocks[kind, card] = (list(group["id"][:]), names, group[values][:])
            self.grid_forces = None
            if "grid_forces" in case:
                g = case["grid_forces"]
                self.grid_forces = list(zip(g["grid"][:], g["source"].asstr()[:], g["element"][:], g["force"][:]))

    def get(self, card, component, kind="stresses"):
        ids, names, values = self.blocks[kind, card]
        return dict(zip(ids, values[:, names.index(component)]))


class Stress(ProgramTest):
    def solve(self, text, *arguments):
        self.write("d.bdf", text)
        self.bough("static", "d.bdf", "-o", "s.h5", *arguments)
        return Case(self.path("s.h5"))

    def test_beam_is_n_over_a_and_m_c_over_i(self):
        # PBAR with its own points: C at (.02, .03), D at (-.02, .01). Tip loads P along x, F along y, G along z.
        A, I1, I2, L = 1e-3, 4e-8, 9e-8, 2.0
        P, F, G = 500.0, 10.0, -7.0
        pbar = "PBAR,1,1,1.-3,4.-8,9.-8,1.-8\n,.02,.03,-.02,.01\n"
        case = self.solve(make_beam(4, pbar, f"FORCE,2,5,,1.,{P},{F},{G}\n"))
        # At x the moment about z is F (L - x), about y is -G (L - x); u = u0 - y θz + z θy.
        for element, x in [(1, 0.0), (3, 1.0)]:
            for name, y, z in [("C", .02, .03), ("D", -.02, .01), ("E", 0, 0)]:
                expected = P / A - y * F * (L - x) / I1 - z * G * (L - x) / I2
                self.assertAlmostEqual(case.get("CBAR", f"xx@{name}_a")[element] / expected, 1, delta=1e-9)
        points = [case.get("CBAR", f"xx@{n}_{e}")[1] for n in "CDEF" for e in "ab"]
        self.assertEqual(case.get("CBAR", "max")[1], max(points))
        self.assertEqual(case.get("CBAR", "min")[1], min(points))

    def test_unsymmetric_section_equals_the_integral_over_its_rectangles(self):
        # Z: the stresses at the corners of the hull are a plane over the section whose resultants are N, My, Mz.
        dims = [.03, .004, .04, .05]  # flange, web, clear height, height
        tf = (dims[3] - dims[2]) / 2
        # Figure axes: x to the right, y up; element axes are y = up, z = -right.
        rectangles = [(-.002, .002, 0, .05), (-.032, -.002, .05 - tf, .05), (.002, .032, 0, tf)]
        case = self.solve(make_beam(2, f"PBARL,1,1,,Z\n,{dims[0]},{dims[1]},{dims[2]},{dims[3]}\n",
                                    "FORCE,2,3,,1.,300.,8.,5.\n"))
        ids, names, values = case.blocks["stresses", "CBAR"]
        row = values[ids.index(1)]
        hull = [(.002, .05), (-.032, .05), (-.032, .05 - tf), (-.002, 0), (.032, 0), (.032, tf)]
        area = sum((b - a) * (d - c) for a, b, c, d in rectangles)
        cx = sum((b - a) * (d - c) * (a + b) / 2 for a, b, c, d in rectangles) / area
        cy = sum((b - a) * (d - c) * (c + d) / 2 for a, b, c, d in rectangles) / area
        points = np.array([[1, y - cy, -(x - cx)] for x, y in hull])
        stress = np.array([row[i] for i, n in enumerate(names) if n.startswith("xx@") and n.endswith("_a")])
        self.assertEqual(len(stress), 6)
        plane = np.linalg.lstsq(points, stress, rcond=None)[0]
        self.assertLess(np.abs(points @ plane - stress).max(), 1e-9 * np.abs(stress).max())
        s0, sy, sz = plane
        moment = np.zeros(3)
        for a, b, c, d in rectangles:
            for u, wu in zip(*np.polynomial.legendre.leggauss(2)):
                for v, wv in zip(*np.polynomial.legendre.leggauss(2)):
                    y = (c + d) / 2 + v * (d - c) / 2 - cy
                    z = -((a + b) / 2 + u * (b - a) / 2 - cx)
                    dA = wu * wv * (b - a) * (d - c) / 4
                    moment += (s0 + sy * y + sz * z) * dA * np.array([1, z, -y])
        np.testing.assert_allclose(moment, [300, -5 * 2, 8 * 2], rtol=1e-8)

    def test_rod_and_tube(self):
        text = HEAD + ("GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCROD,1,1,1,2\nPROD,1,1,2.-4,4.-9,.01\n"
                       "CTUBE,2,2,1,2\nPTUBE,2,1,.04,.01\nSPC1,1,123456,1\nSPC1,1,2356,2\n"
                       "FORCE,2,2,,1.,900.,0.,0.\nMOMENT,2,2,,1.,6.,0.,0.\nENDDATA\n")
        case = self.solve(text)
        for card, A, c_over_J in [("CROD", 2e-4, .01 / 4e-9),
                                  ("CTUBE", math.pi / 4 * (.04**2 - .02**2), .02 / (math.pi / 32 * (.04**4 - .02**4)))]:
            e = 1 if card == "CROD" else 2
            N, T = case.get(card, "axial", "elements")[e], case.get(card, "torque", "elements")[e]
            self.assertAlmostEqual(case.get(card, "xx")[e] / (N / A), 1, delta=1e-12)
            self.assertAlmostEqual(case.get(card, "torsion")[e] / (T * c_over_J), 1, delta=1e-12)
            self.assertAlmostEqual(case.get(card, "von_mises")[e] / math.sqrt((N / A)**2 + 3 * (T * c_over_J)**2), 1,
                                   delta=1e-12)

    def test_plate_in_tension_and_in_bending(self):
        t = .01
        pshell = f"PSHELL,1,1,{t},1,,1\n"
        pull = "FORCE,2,2,,500.,1.,0.,0.\nFORCE,2,4,,500.,1.,0.,0.\nFORCE,2,1,,500.,-1.,0.,0.\nFORCE,2,3,,500.,-1.,0.,0.\n"
        case = self.solve(make_plate(pshell, pull))
        for side in ("top", "bottom"):
            self.assertAlmostEqual(case.get("CQUAD4", f"xx@{side}")[1] / (1000 / t), 1, delta=1e-9)
            self.assertAlmostEqual(case.get("CQUAD4", f"von_mises@{side}")[1] / (1000 / t), 1, delta=1e-9)
        # Moments about y at x = 1 and against them at x = 0: Mx = ∫σ z dz = 20 per length, σ = 6 M / t².
        bend = ("MOMENT,2,2,,10.,0.,1.,0.\nMOMENT,2,4,,10.,0.,1.,0.\n"
                "MOMENT,2,1,,10.,0.,-1.,0.\nMOMENT,2,3,,10.,0.,-1.,0.\n")
        case = self.solve(make_plate(pshell, bend))
        self.assertAlmostEqual(case.get("CQUAD4", "xx@top")[1] / (6 * 20 / t**2), 1, delta=1e-9)
        self.assertAlmostEqual(case.get("CQUAD4", "xx@bottom")[1] / (-6 * 20 / t**2), 1, delta=1e-9)
        case = self.solve(make_plate(pshell.rstrip("\n") + "\n,.002,-.001\n", bend))
        self.assertAlmostEqual(case.get("CQUAD4", "xx@top")[1] / (12 * 20 * -.001 / t**3), 1, delta=1e-9)

    LAMINATE = ("MAT8,2,1.4+11,1.+10,.3,5.+9,5.+9,5.+9,1600.\n,-1.-6,3.-5,20.,1.5+9,1.2+9,5.+7,2.+8,7.+7\n"
                "PCOMP,1,,,,{theory},20.\n,2,1.-3,0.,YES,2,2.-3,60.,YES\n,2,1.-3,-30.,YES\n")

    def make_laminate(self):
        """A, B, D and plies (z0, z1, angle, Q in ply axes) of LAMINATE, by Jones's formulas."""
        E1, E2, nu, G = 1.4e11, 1e10, .3, 5e9
        c = 1 - nu * nu * E2 / E1
        Q = np.array([[E1 / c, nu * E2 / c, 0], [nu * E2 / c, E2 / c, 0], [0, 0, G]])
        z, plies, law = -2e-3, [], np.zeros((6, 6))
        for t, degrees in [(1e-3, 0), (2e-3, 60), (1e-3, -30)]:
            a = math.radians(degrees)
            co, si = math.cos(a), math.sin(a)
            T = np.array([[co * co, si * si, co * si], [si * si, co * co, -co * si],
                          [-2 * co * si, 2 * co * si, co * co - si * si]])  # strains of the ply
            Qb = T.T @ Q @ T
            for i, j, power in [(0, 0, 1), (0, 3, 2), (3, 0, 2), (3, 3, 3)]:
                law[i:i + 3, j:j + 3] += Qb * ((z + t)**power - z**power) / power
            plies.append((z, z + t, T, Q))
            z += t
        return law, plies

    def test_plies_of_a_laminate(self):
        law, plies = self.make_laminate()
        loads = ("FORCE,2,2,,500.,1.,0.,0.\nFORCE,2,4,,500.,1.,0.,0.\n"
                 "FORCE,2,1,,500.,-1.,0.,0.\nFORCE,2,3,,500.,-1.,0.,0.\n"
                 "FORCE,2,3,,150.,0.,1.,0.\nFORCE,2,4,,150.,0.,1.,0.\n"
                 "FORCE,2,1,,150.,0.,-1.,0.\nFORCE,2,2,,150.,0.,-1.,0.\n")
        indices = {}
        for theory in ("HILL", "HOFF", "TSAI", "STRN"):
            case = self.solve(make_plate(self.LAMINATE.format(theory=theory), loads))
            # One element under uniform N: its mean resultants are N, no moment.
            strain = np.linalg.solve(law, [1000, 300, 0, 0, 0, 0])
            for k, (z0, z1, T, Q) in enumerate(plies):
                expected = Q @ T @ (strain[:3] + (z0 + z1) / 2 * strain[3:])
                found = [case.get("CQUAD4", f"{c}@ply{k + 1}")[1] for c in ("11", "22", "12")]
                np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-7 * np.abs(expected).max())
            indices[theory] = [case.get("CQUAD4", f"failure@ply{k + 1}")[1] for k in range(3)]
            self.assertEqual(case.get("CQUAD4", "failure")[1], max(indices[theory]))
            stresses = [[case.get("CQUAD4", f"{c}@ply{k + 1}")[1] for c in ("11", "22", "12")] for k in range(3)]
        Xt, Xc, Yt, Yc, S, E1, E2, nu, G = 1.5e9, 1.2e9, 5e7, 2e8, 7e7, 1.4e11, 1e10, .3, 5e9
        for k, (s1, s2, t) in enumerate(stresses):
            X, Y = (Xt if s1 >= 0 else Xc), (Yt if s2 >= 0 else Yc)
            X12 = Xt if s1 * s2 >= 0 else Xc
            hill = (s1 / X)**2 - s1 * s2 / X12**2 + (s2 / Y)**2 + (t / S)**2
            linear = (1 / Xt - 1 / Xc) * s1 + (1 / Yt - 1 / Yc) * s2
            squares = s1**2 / (Xt * Xc) + s2**2 / (Yt * Yc) + (t / S)**2
            e1, e2, g = s1 / E1 - nu * s2 / E1, s2 / E2 - nu * s1 / E1, t / G
            strain = max(abs(e1) * E1 / (Xt if e1 >= 0 else Xc), abs(e2) * E2 / (Yt if e2 >= 0 else Yc), abs(g) * G / S)
            np.testing.assert_allclose([indices[name][k] for name in ("HILL", "HOFF", "TSAI", "STRN")],
                                       [hill, linear + squares - s1 * s2 / (Xt * Xc), linear + squares, strain], rtol=1e-9)

    def test_unknown_failure_theory_is_named(self):
        self.write("d.bdf", make_plate(self.LAMINATE.format(theory="PFA"), "FORCE,2,2,,500.,1.,0.,0.\n"))
        self.assertIn("[deck.failure-theory]", self.bough("static", "d.bdf").stderr)

    def test_cooled_cross_ply_keeps_stresses_between_its_plies(self):
        # Free at 120 below TREF: no resultant, but stresses in the plies, in equilibrium with each other.
        text = make_plate("MAT8,2,1.4+11,1.+10,.3,5.+9,5.+9,5.+9,1600.\n,-1.-6,3.-5,20.\n"
                          "PCOMP,1,,,,,20.,,SYM\n,2,1.-3,0.,,2,1.-3,90.\n", "TEMPD,2,-100.\n")
        case = self.solve(text.replace("LOAD = 2", "TEMPERATURE(LOAD) = 2"))
        E1, E2, nu = 1.4e11, 1e10, .3
        c = 1 - nu * nu * E2 / E1
        Q = np.array([[E1 / c, nu * E2 / c], [nu * E2 / c, E2 / c]])
        swap = Q[::-1, ::-1]
        free = -120 * np.array([-1e-6, 3e-5])
        strain = np.linalg.solve(Q + swap, Q @ free + swap @ free[::-1])
        for ply, expected in [(1, Q @ (strain - free)), (2, Q @ (strain[::-1] - free))]:
            found = [case.get("CQUAD4", f"{n}@ply{ply}")[1] for n in ("11", "22")]
            np.testing.assert_allclose(found, expected, rtol=1e-8)
        self.assertLess(abs(case.get("CQUAD4", "11@ply1")[1] + case.get("CQUAD4", "22@ply2")[1]), 1e-6 * abs(expected).max())

    def test_solid_in_shear_and_tension(self):
        text = HEAD
        for k, (x, y, z) in enumerate([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]):
            text += f"GRID,{k + 1},,{x}.,{y}.,{z}.\n"
        text += "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nSPC1,1,123,1\nSPC1,1,23,2\nSPC1,1,3,4\n"
        for g in range(1, 9):
            x, y, z = g in (2, 3, 6, 7), g in (3, 4, 7, 8), g > 4
            # σxx = 400, τxy = 120
            fx = 100 * (1 if x else -1) + 30 * (1 if y else -1)
            fy = 30 * (1 if x else -1)
            text += f"FORCE,2,{g},,1.,{fx}.,{fy}.,0.\n"
        case = self.solve(text + "ENDDATA\n")
        for name, value in [("xx", 400), ("yy", 0), ("zz", 0), ("xy", 120), ("yz", 0), ("zx", 0),
                            ("von_mises", math.sqrt(400**2 + 3 * 120**2)), ("major", 200 + math.hypot(200, 120)),
                            ("minor", 200 - math.hypot(200, 120))]:
            self.assertAlmostEqual(case.get("CHEXA", name)[1], value, delta=1e-7)

    def test_json_and_vtu_have_the_stresses(self):
        self.write("d.bdf", make_beam(2, "PBARL,1,1,,BAR\n,.01,.02\n", "FORCE,2,3,,1.,0.,8.,0.\n"))
        data = json.loads(self.bough("static", "d.bdf", "--json", "--full", "--vtu", "s.vtu").stdout)
        block = data["subcases"][0]["stresses"]["CBAR"]
        top = 8 * 2 * .01 / (.01 * .02**3 / 12)
        row = dict(zip(block["components"], block["stress"][block["id"].index(1)]))
        self.assertAlmostEqual(row["max"] / top, 1, delta=1e-9)
        most = {m["component"]: m for m in data["subcases"][0]["max_stress"]["CBAR"]}
        self.assertAlmostEqual(most["max"]["value"] / top, 1, delta=1e-9)
        self.assertEqual(most["max"]["element"], 1)
        with open(self.path("s.vtu")) as f:
            text = f.read()
        number = data["subcases"][0]["id"]
        for name in ("max", "strain_energy"):
            self.assertIn(f'Name="subcase_{number:03d}_{name}"', text)
        self.assertIn("CBAR stress", self.bough("static", "d.bdf").stdout)

    def test_forces_on_grids_balance(self):
        text = make_beam(2, "PBAR,1,1,1.-3,1.-8,1.-8,1.-8\n", "FORCE,2,3,,1.,0.,10.,0.\nFORCE,2,2,,1.,3.,0.,0.\n")
        text = text.replace("SPC1,1,123456,1\n", "SPC1,1,123456,1\nGRID,9,,2.,.5,0.\nRBE2,7,3,123456,9\nCONM2,8,9,,1.\n")
        case = self.solve(text, "--grid-forces", "1,2,3")
        sums = {}
        for grid, source, element, force in case.grid_forces:
            sums[grid] = sums.get(grid, 0) + force
            if (grid, source, element) == (2, "CBAR", 1):
                np.testing.assert_allclose(force, [-3, -10, 0, 0, 0, -10], atol=1e-8)
            if (grid, source) == (1, "SPC"):
                np.testing.assert_allclose(force, [-3, -10, 0, 0, 0, -20], atol=1e-8)
        self.assertEqual(sorted(sums), [1, 2, 3])
        for total in sums.values():
            self.assertLess(np.abs(total).max(), 1e-8)
        listing = self.bough("static", "d.bdf", "--grid-forces", "all").stdout
        self.assertIn("forces on grids", listing)
        self.fails(1, "static", "d.bdf", "--grid-forces", "1,x", error="cli.bad-grids")
        self.fails(1, "static", "d.bdf", "--grid-forces", "1,77", error="fe.missing-grid", says=["--grid-forces names 77"])


class Energies(ProgramTest):
    def make_frame(self):
        """Two properties, a lumped mass, shells: everything with energy."""
        text = "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,5\nMAT1,1,7.+10,,.3,2700.\nPARAM,WTMASS,.5\n"
        for i in range(7):
            text += f"GRID,{i + 1},,{i * .3:.3f},0.,0.\nGRID,{i + 11},,{i * .3:.3f},.4,.1\n"
        for i in range(6):
            text += f"CQUAD4,{i + 1},1,{i + 1},{i + 2},{i + 12},{i + 11}\nCBAR,{i + 21},2,{i + 1},{i + 2},0.,0.,1.\n"
        return text + ("PSHELL,1,1,.004,1,,1\nPBAR,2,1,2.-4,1.-8,3.-8,2.-8\nCONM2,40,17,,3.,.02,.01,.03\n,.01,,.02,,,.03\n"
                       "CELAS2,50,2.+4,7,3\nSPC1,1,123456,1,11\nENDDATA\n")

    def test_energies_sum_to_those_of_the_mode(self):
        self.write("d.bdf", self.make_frame())
        run = self.bough("modes", "d.bdf", "--ese", "-o", "m.h5", "--vtu", "m.vtu")
        with h5py.File(self.path("m.h5")) as f:
            e, lam, mass = f["energies"], f["modes/eigenvalue"][:], f["modes/mass"][:]
            np.testing.assert_allclose(e["strain"][:].sum(axis=0), .5 * lam * mass, rtol=1e-10)
            np.testing.assert_allclose(e["kinetic"][:].sum(axis=0), .5 * mass, rtol=1e-10)
            np.testing.assert_allclose(e["total_strain"][:], .5 * lam * mass, rtol=1e-10)
            cards = dict(zip(e["id"][:], e["card"].asstr()[:]))
            properties = dict(zip(e["id"][:], e["property"][:]))
            spring, third = list(e["id"][:]).index(50), list(f["nodes/id"][:]).index(7)
            # The spring's energy is its own: half k u².
            np.testing.assert_allclose(e["strain"][spring], .5 * 2e4 * f["modes/phi"][third, 2]**2, rtol=1e-10)
        self.assertEqual((cards[40], properties[40], properties[1], properties[21]), ("CONM2", 0, 1, 2))
        self.assertIn("energies of properties", run.stdout)
        with open(self.path("m.vtu")) as f:
            text = f.read()
        self.assertIn('_strain_energy"', text)
        self.assertIn('_kinetic_energy"', text)

    def test_effective_mass_about_a_grid_and_comparison_in_one_step(self):
        self.write("d.bdf", self.make_frame())
        self.bough("modes", "d.bdf", "-o", "other.h5")
        data = json.loads(self.bough("modes", "d.bdf", "--json", "--meffmass", "17", "--compare", "other.h5").stdout)
        about = data["effective_mass_about"]
        np.testing.assert_allclose(np.array(about["mass"])[:, :3], np.array(data["effective_mass"])[:, :3], rtol=1e-9)
        # The rotations are those of the participation L = φᵀMΦ_R about that grid.
        self.bough("matrices", "d.bdf", "-o", "k.h5")
        import scipy.sparse
        with h5py.File(self.path("k.h5")) as f, h5py.File(self.path("other.h5")) as modes:
            M = scipy.sparse.csr_matrix((f["M/data"][:], f["M/indices"][:], f["M/indptr"][:]), shape=tuple(f["M/shape"][:]))
            rows = {int(n): 6 * k for k, n in enumerate(f["grids/id"][:])}
            xyz = f["grids/xyz"][:] - f["grids/xyz"][:][list(f["grids/id"][:]).index(17)]
            Phi_R = np.zeros((M.shape[0], 6))
            for k, (x, y, z) in enumerate(xyz):
                Phi_R[6 * k:6 * k + 3] = np.hstack([np.eye(3), [[0, z, -y], [-z, 0, x], [y, -x, 0]]])
                Phi_R[6 * k + 3:6 * k + 6, 3:] = np.eye(3)
            phi = np.zeros((M.shape[0], 5))
            for node, shape in zip(modes["nodes/id"][:], modes["modes/phi"][:]):
                phi[rows[int(node)]:rows[int(node)] + 6] = shape
            L = phi.T @ (M @ Phi_R)
        np.testing.assert_allclose(about["mass"], L**2, rtol=1e-7, atol=1e-9 * (L**2).max())
        np.testing.assert_allclose(about["rigid"], np.diag(Phi_R.T @ (M @ Phi_R)), rtol=1e-9)
        pairs = data["comparison"]["pairs"]
        self.assertEqual(len(pairs), 5)
        for pair in pairs:
            self.assertAlmostEqual(pair["mac"], 1, delta=1e-9)
        self.fails(1, "modes", "d.bdf", "--meffmass", "99", error="modal.unknown-grid")


class Summary(ProgramTest):
    """Margins of safety and extremes over subcases; two rods in line, one of which has no limits."""
    DECK = ("SOL 101\nCEND\nSPC = 1\nMAXMIN = ALL\nSTRAIN = ALL\nSUBCASE 1\nLOAD = 1\nSUBCASE 2\nLOAD = 2\nSUBCASE 7\nLOAD = 3\n"
            "BEGIN BULK\nMAT1,1,100.,,.25,1.,,,\n,20.,8.,4.\nMAT1,2,100.,,.25,1.\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n"
            "GRID,3,,2.,0.,0.\nPROD,1,1,2.,1.5,.5\nPROD,2,2,2.,1.5,.5\nCROD,11,1,1,2\nCROD,12,2,2,3\nSPC1,1,2356,2,3\n"
            "SPC1,1,123456,1\nFORCE,1,3,,10.,1.,0.,0.\nFORCE,2,3,,-10.,1.,0.,0.\nMOMENT,2,3,,3.,1.,0.,0.\n"
            "FORCE,3,3,,4.,1.,0.,0.\nENDDATA\n")

    def test_margins_and_extremes(self):
        self.write("d.bdf", self.DECK)
        data = json.loads(self.bough("static", "d.bdf", "--json", "--extremes", "-o", "d.h5").stdout)
        with h5py.File(self.path("d.h5")) as f:
            # Stress 10/2 against ST 20; -5 against SC 8, torsion 3 . 0.5/1.5 against SS 4.
            for case, expected in [("1", [3, np.nan, np.nan]), ("2", [np.nan, .6, 3]), ("7", [9, np.nan, np.nan])]:
                group = f[f"subcases/{case}/margins/CROD"]
                self.assertEqual(group["id"][:].tolist(), [11])    # 12 has no limits
                np.testing.assert_allclose(group["margin"][0], expected, rtol=1e-12)
            # x of grid 3: 10/2 . 2/100; the subcases of the extremes.
            group = f["extremes/displacement"]
            row = group["id"][:].tolist().index(3)
            np.testing.assert_allclose([group["min"][row, 0], group["max"][row, 0]], [-.1, .1], rtol=1e-12)
            self.assertEqual((group["min_subcase"][row, 0], group["max_subcase"][row, 0]), (2, 1))
            group = f["extremes/stresses/CROD"]
            column = list(group.attrs["components"]).index("xx")
            np.testing.assert_allclose([group["min"][:, column], group["max"][:, column]], [[-5, -5], [5, 5]], rtol=1e-12)
            force = [f[f"subcases/{case}/elements/CROD/force"][:] for case in ("1", "2", "7")]
            np.testing.assert_array_equal(f["extremes/elements/CROD/min"][:], np.min(force, axis=0))
            np.testing.assert_array_equal(f["extremes/elements/CROD/max"][:], np.max(force, axis=0))
        low = data["extremes"]["reaction"]["x"]["min"]
        self.assertEqual((round(low["value"], 9), low["id"], low["subcase"]), (-10, 1, 1))
        shear = next(m for m in data["subcases"][1]["margins"] if m["of"] == "shear")
        self.assertAlmostEqual(shear["margin"], 3)
        said = self.bough("static", "d.bdf", "--extremes")
        self.assertRegex(said.stdout, r"margin of safety +of +smallest +element\n +CROD +tension +3.0+e\+00 +11")
        self.assertRegex(said.stdout, r"over subcases: displacement")
        self.assertNotIn("over subcases", self.bough("static", "d.bdf").stdout)
        # Requests of the deck that an option, or nothing, provides.
        self.assertIn("'static --extremes'", said.stderr)
        self.assertRegex(said.stderr, r"not used: MAXMIN \(line 4\)")

    def test_margins_of_bars(self):
        """Bending of a cantilever: σ = F L c/I on both sides."""
        self.write("d.bdf", make_beam(2, "PBARL,1,1,,BAR\n,.1,.2\n", "FORCE,2,3,,600.,0.,1.,0.\n").replace(
            "MAT1,1,7.+10,,.3,2700.\n", "MAT1,1,7.+10,,.3,2700.,,,\n,8.+6,6.+6\n"))
        self.bough("static", "d.bdf", "-o", "d.h5")
        stress = 600 * 2 * .05 / (.2 * .1 ** 3 / 12)
        with h5py.File(self.path("d.h5")) as f:
            found = f["subcases/0/margins/CBAR/margin"][0]
        other = 600 * 2 * .1 / (.1 * .2 ** 3 / 12)
        self.assertTrue(any(np.allclose(found[:2], [8e6 / s - 1, 6e6 / s - 1], rtol=1e-9) for s in (stress, other)), found)
        self.assertTrue(np.isnan(found[2]))


    def test_a_missing_strength_is_told(self):
        """An index of 0 is no safety: the plies whose material lacks a strength are named, once a material."""
        deck = ("SOL 101\nCEND\nSPC=1\nLOAD=2\nSTRESS=ALL\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\n"
                "GRID,4,,0.,1.,0.\nCQUAD4,1,1,1,2,3,4\nPCOMP,1,,,5.+7,HILL\n,1,.1,0.,,1,.1,90.\n"
                "MAT8,1,1.+11,1.+10,.3,5.+9,,,1500.\n,,,,1.+9,1.+9,5.+7,2.+8,{}\nSPC1,1,123456,1,4\n"
                "FORCE,2,2,,1.,1.,0.,0.\nENDDATA\n")
        self.write("weak.bdf", deck.format(""))
        said = self.bough("static", "weak.bdf").stderr
        self.assertEqual(said.count("[fe.no-strength]"), 1)
        self.assertIn("weak.bdf:12: note: PCOMP 1 asks for HILL, and material 1 lacks a strength", said)
        self.write("strong.bdf", deck.format("1.+7"))
        self.assertNotIn("[fe.no-strength]", self.bough("static", "strong.bdf").stderr)


if __name__ == "__main__":
    unittest.main()
