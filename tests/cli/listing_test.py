"""Listings (--f06) and OUTPUT2 files (--op2): read back by readers of their own, against closed forms and HDF5."""
import json
import math
import re
import unittest

import h5py
import numpy as np

from op2_reader import Op2
from support import ProgramTest

# A cantilever of two bars along x with a tip load of 10 in y, 20 in z, 5 along x, and a torque of 3; beside it a CBEAM,
# a rod, springs and a bush, each alone on its grids, and a plate in pure bending.
ELEMENTS = """MAT1,1,7.+10,,.3,2700.
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.,9
CORD2R,9,,0.,0.,0.,0.,0.,1.
,0.,1.,0.
PBAR,1,1,1.-3,1.-6,2.-6,3.-6
CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
FORCE,2,3,,1.,5.,10.,20.
MOMENT,2,3,,3.,1.,0.,0.
GRID,11,,0.,0.,0.
GRID,12,,2.,0.,0.
PBEAM,2,1,1.-3,1.-6,2.-6,,3.-6
CBEAM,11,2,11,12,0.,1.,0.
FORCE,2,12,,1.,0.,10.,20.
GRID,21,,0.,5.,0.
GRID,22,,1.,5.,0.
PROD,3,1,2.-3,1.-6
CROD,21,3,21,22
FORCE,2,22,,7.,1.,0.,0.
GRID,31,,0.,6.,0.
GRID,32,,1.,6.,0.
CELAS2,31,1000.,31,1,32,1
FORCE,2,32,,4.,1.,0.,0.
PBUSH,4,K,100.,200.,300.,400.,500.,600.
CBUSH,32,4,31,32,,,,0
FORCE,2,32,,1.,0.,2.,3.
SPOINT,41
CELAS2,41,50.,41
SLOAD,2,41,5.
"""
HOLD = """SPC1,1,123456,1,11,31
SPC1,1,123456,21
SPC1,1,23456,22
ENDDATA
"""


def read_pages(text):
    """Lines of the tables by heading without blanks, "FORCESINBARELEMENTS(CBAR)": [[numbers and words of a row]]."""
    tables, current = {}, None
    for line in text.splitlines():
        squeezed = line.replace(" ", "")
        if "PAGE" in line:
            current = None
        if re.search(r"[A-Z] [A-Z] [A-Z] ", line):
            current = tables.setdefault(re.sub(r"^CYCLES=[-+0-9.E]*", "", squeezed), [])
        elif current is not None and re.match(r"^0?\s+\d+\s", line) and "PAGE" not in line:
            current.append(line.lstrip("0").split())
    return tables


class Listing(ProgramTest):
    def solve(self, control="", bulk=ELEMENTS + HOLD, verb="static", sol="101", extra=()):
        self.write("d.bdf", f"SOL {sol}\nCEND\nTITLE = A frame\nSUBTITLE = of several\nSPC = 1\nLOAD = 2\nMETHOD = 3\n"
                            f"{control}BEGIN BULK\n{bulk}")
        return self.bough(verb, "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06", *extra)

    def read_f06(self):
        with open(self.path("d.f06")) as f:
            return f.read()

    def test_static_vectors(self):
        self.solve()
        op2 = Op2(self.path("d.op2"))
        self.assertEqual(op2.order, ["OGPWG", "OUGV1", "OPG1", "OQG1", "OQMG1", "OEF1", "OES1"])
        with h5py.File(self.path("d.h5")) as f:
            dofs = f["dof_map"][:]
            case = f["subcases/0"]
            for name, code, values in [("OUGV1", 1, case["displacement"][:]), ("OPG1", 2, case["load"][:]),
                                       ("OQG1", 3, case["reaction"][:])]:
                ((approach, table, subcase, word, _, _, rows),) = op2.vectors(name)
                self.assertEqual((approach, table, subcase, word), (1, code, 1, 2))
                self.assertEqual(list(rows), sorted(set(dofs[:, 0])))
                scale = np.abs(values).max()
                for (point, component), value in zip(dofs, values):
                    kind, row = rows[point]
                    self.assertEqual(kind, 2 if component == 0 else 1)
                    if point == 3:
                        continue
                    self.assertAlmostEqual(row[max(component - 1, 0)] / scale, value / scale, delta=1e-6)
                # Grid 3 has axes of displacement turned about z: x' = y, y' = -x.
                b = values[dofs[:, 0] == 3]
                np.testing.assert_allclose(rows[3][1], [b[1], -b[0], b[2], b[4], -b[3], b[5]], rtol=1e-6, atol=1e-6 * scale)
        self.assertEqual(op2.tables["OUGV1"][0].ident[1][:2], ["A frame", "of several"])

    def test_static_forces(self):
        self.solve()
        forces = {(kind, element): values for _, kind, _, _, rows in Op2(self.path("d.op2")).elements("OEF1", 4)
                  for element, values in rows.items()}
        # Plane 1 is x-y: M1 = E I v''. The load in +y bends so that M1 = P (L - x) > 0, V1 = P; plane 2 the same in z.
        np.testing.assert_allclose(forces[34, 1], [20, 40, 10, 20, 10, 20, 5, 3], rtol=1e-6)
        np.testing.assert_allclose(forces[34, 2], [10, 20, 0, 0, 10, 20, 5, 3], rtol=1e-6, atol=1e-5)
        beam = np.reshape(forces[2, 11], (11, 9))
        np.testing.assert_allclose(beam[0], [11, 0, 20, 40, 10, 20, 0, 0, 0], rtol=1e-6, atol=1e-5)
        np.testing.assert_allclose(beam[10], [12, 1, 0, 0, 10, 20, 0, 0, 0], rtol=1e-6, atol=1e-5)
        self.assertFalse(beam[1:10].any())
        np.testing.assert_allclose(forces[1, 21], [7, 0], rtol=1e-6, atol=1e-6)
        # Spring k (u1 - u2) and bush k (uB - uA) share 4: 1000 and 100.
        np.testing.assert_allclose(forces[12, 31], [-4000 / 1100], rtol=1e-6)
        np.testing.assert_allclose(forces[102, 32][:3], [400 / 1100, 2, 3], rtol=1e-6)
        np.testing.assert_allclose(forces[12, 41], [5], rtol=1e-6)

    def test_same_in_f06(self):
        self.solve()
        op2, text = Op2(self.path("d.op2")), self.read_f06()
        tables = read_pages(text)
        rows = {int(r[0]): r for r in tables["DISPLACEMENTVECTOR"]}
        for point, (kind, values) in op2.vectors("OUGV1")[0][6].items():
            self.assertEqual(rows[point][1], "S" if kind == 2 else "G")
            numbers = [float(v) for v in rows[point][2:]]
            np.testing.assert_allclose(numbers, values[:len(numbers)], rtol=1e-6)
        bars = {int(r[0]): [float(v) for v in r[1:]] for r in tables["FORCESINBARELEMENTS(CBAR)"]}
        np.testing.assert_allclose(bars[1], [20, 40, 10, 20, 10, 20, 5, 3], rtol=1e-6)
        self.assertEqual({int(r[0]) for r in tables["FORCESOFSINGLE-POINTCONSTRAINT"]}, {1, 11, 21, 31})
        for heading in ["L O A D   V E C T O R", "F O R C E S   I N   B E A M   E L E M E N T S        ( C B E A M )",
                        "F O R C E S   I N   R O D   E L E M E N T S     ( C R O D )",
                        "F O R C E S   I N   S C A L A R   S P R I N G S        ( C E L A S 2 )",
                        "F O R C E S   I N   B U S H   E L E M E N T S        ( C B U S H )"]:
            self.assertIn(heading, text)
        for line in text.splitlines():
            self.assertLessEqual(len(line), 132, line)

    def test_requests(self):
        result = self.solve("SET 5 = 1, 3\nDISP(PLOT) = 5\nSPCF = ALL\nSET 6 = 2 THRU 12\nFORCE = 6\n")
        self.assertNotIn("cli.listing-default", result.stderr)
        op2 = Op2(self.path("d.op2"))
        self.assertEqual(op2.order, ["OGPWG", "OUGV1", "OQG1", "OEF1"])
        self.assertEqual(list(op2.vectors("OUGV1")[0][6]), [1, 3])
        self.assertEqual({e for *_, rows in op2.elements("OEF1", 4) for e in rows}, {2, 11})
        text = self.read_f06()
        self.assertNotIn("D I S P L A C E M E N T", text)  # PLOT is not PRINT
        self.assertIn("F O R C E S   O F   S I N G L E - P O I N T", text)
        self.assertIn("cli.listing-default", self.solve().stderr)
        self.fails_with_missing_set()

    def test_other_elements_are_named(self):
        result = self.solve(bulk=ELEMENTS + "GRID,33,,1.,7.,0.\nGRID,34,,0.,7.,0.\nPSHEAR,9,1,.01\nCSHEAR,99,9,31,32,33,34\n"
                            "SPC1,1,123456,33,34\n" + HOLD)
        self.assertEqual(result.stderr.count("cli.unlisted-elements"), 2)  # forces, stresses
        self.assertIn("CSHEAR", result.stderr)

    def test_plates(self):
        # Two pieces of a strip of unit width under tension 6 and a moment that bends it: 2 N m/m about +y at its end
        # is the section's moment My = int sigma z dz = 2, Nastran's MX = -2. The first one's axes are turned by its
        # skew sides: x bisects the diagonals.
        grids = [(0, 0), (1, 0), (2, 0), (0, 1), (1.5, 1), (2, 1)]
        bulk = "MAT1,1,7.+10,,0.,2700.\nPSHELL,1,1,.01,1,,1\n"
        bulk += "".join(f"GRID,{k + 1},,{x}.,{y}.,0.\n".replace("1.5.", "1.5") for k, (x, y) in enumerate(grids))
        bulk += "CQUAD4,1,1,1,2,5,4\nCQUAD4,2,1,2,3,6,5\nSPC1,1,12345,1,4\nSPC1,1,6,1,2,3,4,5,6\n"
        bulk += "".join(f"FORCE,2,{g},,3.,1.,0.,0.\nMOMENT,2,{g},,1.,0.,1.,0.\n" for g in (3, 6)) + "ENDDATA\n"
        self.solve(bulk=bulk)
        ((_, kind, _, _, rows),) = Op2(self.path("d.op2")).elements("OEF1", 4)
        self.assertEqual(kind, 33)
        for element, corners in [(1, (0, 1, 4, 3)), (2, (1, 2, 5, 4))]:
            a, b, c, d = (np.array(grids[k], float) for k in corners)
            axis = (c - a) / np.linalg.norm(c - a) + (b - d) / np.linalg.norm(b - d)
            angle = math.atan2(axis[1], axis[0])
            c, s = math.cos(angle), math.sin(angle)
            shape = np.array([c * c, s * s, -c * s])
            np.testing.assert_allclose(rows[element], [*(6 * shape), *(-2 * shape), 0, 0], rtol=1e-5, atol=1e-5)

    def fails_with_missing_set(self):
        with open(self.path("d.bdf")) as f:
            text = f.read()
        self.write("e.bdf", text.replace("METHOD = 3\n", "METHOD = 3\nDISP = 77\n"))
        self.fails(1, "static", "e.bdf", "--f06", "e.f06", says=["e.bdf:8", "DISPLACEMENT = 77"], error="cli.missing-set")

    def test_modes(self):
        self.solve(sol="103", verb="modes", bulk="EIGRL,3,,,4\n" + ELEMENTS + HOLD, extra=["--json"])
        op2 = Op2(self.path("d.op2"))
        self.assertEqual(op2.order, ["OGPWG", "LAMA", "OUGV1", "OQG1", "OEF1", "OES1"])
        ((subcase, roots),) = op2.roots()
        vectors = op2.vectors("OUGV1")
        with h5py.File(self.path("d.h5")) as f:
            eigenvalue, phi, ids = f["modes/eigenvalue"][:], f["modes/phi"][:], list(f["nodes/id"][:])
            mass = f["rigid/mass"][()]
        self.assertEqual([r[0] for r in roots], list(range(1, len(eigenvalue) + 1)))
        omega = np.sqrt(eigenvalue)
        np.testing.assert_allclose([r[2:] for r in roots],
                                   np.transpose([eigenvalue, omega, omega / 2 / math.pi, np.ones_like(omega), eigenvalue]),
                                   rtol=1e-6)
        for j, (approach, table, _, mode, value, cycles, rows) in enumerate(vectors):
            self.assertEqual((approach, table, mode), (2, 7, j + 1))
            np.testing.assert_allclose([value, cycles], [eigenvalue[j], omega[j] / 2 / math.pi], rtol=1e-6)
            scale = np.abs(phi[:, :, j]).max()
            for k, point in enumerate(ids):
                if point != 3:
                    np.testing.assert_allclose(rows[point][1], phi[k, :, j], rtol=1e-6, atol=1e-6 * scale)
        grid, weight = op2.weight()
        np.testing.assert_allclose(weight[45], np.ravel(mass)[0], rtol=1e-6)
        tables = read_pages(self.read_f06())
        rows = tables["REALEIGENVALUES"]
        np.testing.assert_allclose([[float(v) for v in r[2:]] for r in rows], [r[2:] for r in roots], rtol=1e-6)
        self.assertIn("REALEIGENVECTORNO.1", tables)
        # Forces of the supports of a mode: those of all of them and of the springs to ground balance ω² M φ.
        reaction = op2.vectors("OQG1")[0][6]
        self.assertTrue(any(any(values) for _, values in reaction.values()))


class Combinations(ProgramTest):
    CASES = ("SOL 101\nCEND\nSPC = 1\nDISP = ALL\nFORCE = ALL\nSUBCASE 1\nLOAD = 2\nSUBCASE 2\nLOAD = 3\nSUBCOM 10\n"
             "LABEL = difference\nSUBSEQ = 2.0, -1.0\nREPCASE 11\nDISP = NONE\nSPCF = ALL\n"
             "BEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nPBAR,1,1,1.-3,1.-6,2.-6,3.-6\n"
             ",.1,.2,-.1,-.2\nCBAR,1,1,1,2,0.,1.,0.\nFORCE,2,2,,1.,5.,10.,0.\nFORCE,3,2,,1.,1.,0.,4.\n"
             "SPC1,1,123456,1\nENDDATA\n")

    def test_subcom_is_linear(self):
        self.write("d.bdf", self.CASES)
        result = self.bough("static", "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06")
        self.assertNotIn("SUBCOM", result.stderr)
        with h5py.File(self.path("d.h5")) as f:
            one, two, sum_, again = (f["subcases"][n] for n in ("1", "2", "10", "11"))
            for name in ("displacement", "load", "reaction", "elements/CBAR/force"):
                np.testing.assert_allclose(sum_[name][:], 2 * one[name][:] - two[name][:], rtol=1e-12, atol=1e-12)
                np.testing.assert_array_equal(again[name][:], two[name][:])
            # Energy and extremes are no sums: 1/2 F u, and of the stresses at the points.
            self.assertAlmostEqual(np.ravel(sum_["strain_energy"][()])[0], 0.5 * sum_["load"][:] @ sum_["displacement"][:],
                                   delta=1e-9)
            stress = sum_["stresses/CBAR"]
            names = [n.decode() if isinstance(n, bytes) else n for n in stress.attrs["components"]]
            values = stress["stress"][0]
            points = [v for n, v in zip(names, values) if n.startswith("xx")]
            self.assertEqual((values[names.index("max")], values[names.index("min")]), (max(points), min(points)))
        op2 = Op2(self.path("d.op2"))
        self.assertEqual([r[2] for r in op2.vectors("OUGV1")], [1, 2, 10])
        self.assertEqual([r[2] for r in op2.vectors("OQG1")], [11])
        self.assertEqual(op2.tables["OUGV1"][2].ident[1][2], "difference")

    def test_symcom(self):
        text = self.CASES.replace("SUBCASE 1", "SYM 1").replace("SUBCASE 2", "SYM 2")
        text = text.replace("SUBCOM 10", "SYMCOM 10").replace("SUBSEQ = 2.0, -1.0\n", "")
        self.write("d.bdf", text)
        self.bough("static", "d.bdf", "-o", "d.h5")
        with h5py.File(self.path("d.h5")) as f:
            u = [f["subcases"][n]["displacement"][:] for n in ("1", "2", "10")]
            np.testing.assert_allclose(u[2], u[0] + u[1], rtol=1e-12, atol=1e-15)

    def test_what_is_wrong(self):
        self.write("d.bdf", self.CASES.replace("SUBSEQ = 2.0, -1.0", "SUBSEQ = 1., 2., 3."))
        self.fails(1, "static", "d.bdf", says=["d.bdf:12", "3 factors", "2 subcases"], error="deck.combination")
        self.write("d.bdf", self.CASES.replace("SUBSEQ = 2.0, -1.0\n", ""))
        self.fails(1, "static", "d.bdf", says=["d.bdf:10", "SUBCOM has no factors"], error="deck.combination")
        # A subcase that cannot be solved: the others are given, the sum is not.
        self.write("d.bdf", self.CASES.replace("LOAD = 3", "LOAD = 77"))
        result = self.bough("static", "d.bdf", code=1)
        self.assertIn("[cli.combination-missing]", result.stderr)
        self.assertIn("subcase 1", result.stdout)
        # One subcase alone: the combination is named as not used.
        self.write("d.bdf", self.CASES)
        self.assertIn("SUBCOM (line 10)", self.bough("static", "d.bdf", "--subcase", "1").stderr)


class ResidualVectors(ProgramTest):
    DECK = ("SOL 103\nCEND\nSPC = 1\nMETHOD = 3\nLOAD = 2\nRESVEC = YES\nBEGIN BULK\nEIGRL,3,,,2\nMAT1,1,7.+10,,.3,2700.\n"
            "PBAR,1,1,1.-3,1.-6,2.-6,3.-6\n" +
            "".join(f"GRID,{i},,{i - 1}.,0.,0.\n" for i in range(1, 7)) +
            "".join(f"CBAR,{i},1,{i},{i + 1},0.,1.,0.\n" for i in range(1, 6)) +
            "FORCE,2,4,,1.,0.,0.,1.\nSPC1,1,123456,1\nUSET,U6,6,2\nRVDOF1,3,5,THRU,6\nENDDATA\n")

    def solve(self, text, *extra):
        self.write("d.bdf", text)
        result = self.bough("modes", "d.bdf", "-o", "d.h5", "--json", *extra)
        with h5py.File(self.path("d.h5")) as f:
            return result, json.loads(result.stdout), f["modes/eigenvalue"][:], f["modes/phi"][:], list(f["modes/kind"][:])

    def test_static_answers_are_held(self):
        result, data, eigenvalue, phi, _ = self.solve(self.DECK)
        self.assertNotIn("deck.unused", result.stderr)
        loads = ["LOAD 2", "grid 6 component 2", "grid 5 component 3", "grid 6 component 3"]
        self.assertEqual(data["residual_vectors"], {"loads": loads, "unused": []})
        kinds = [m.get("kind", "normal") for m in data["modes"]]
        self.assertEqual(kinds, ["normal"] * 2 + ["residual"] * 4)
        np.testing.assert_allclose([m["modal_mass"] for m in data["modes"]], 1, rtol=1e-9)
        # Σ φ (φᵀF) / λ is the static answer of each load: that of a cantilever, P a² (3x - a) / 6EI beyond its place a.
        for point, component, inertia in [(4, 2, 2e-6), (6, 1, 1e-6), (5, 2, 2e-6), (6, 2, 2e-6)]:
            a = point - 1.0
            f = phi[point - 1, component, :]
            u = (phi[:, component, :] * (f / eigenvalue)).sum(axis=1)
            x = np.arange(6.0)
            low, high = np.minimum(x, a), np.maximum(x, a)
            np.testing.assert_allclose(u, low ** 2 * (3 * high - low) / (6 * 7e10 * inertia), rtol=1e-8, atol=1e-16)

    def test_not_asked_for(self):
        for text in (self.DECK.replace("RESVEC = YES\n", ""), self.DECK.replace("RESVEC = YES", "RESVEC = NO")):
            result, data, eigenvalue, _, _ = self.solve(text)
            self.assertEqual(len(eigenvalue), 2)
            self.assertIn("RVDOF1", result.stderr)
        text = self.DECK.replace("RESVEC = YES\n", "").replace("BEGIN BULK\n", "BEGIN BULK\nPARAM,RESVEC,YES\n")
        self.assertEqual(len(self.solve(text)[2]), 6)

    def test_reduce(self):
        """Residual vectors in a body; none for RESVEC = NO, without RESVEC in the deck, or with a body file."""
        _, _, eigenvalue, phi, _ = self.solve(self.DECK)
        def reduce(text, *arguments):
            self.write("r.bdf", text)
            self.bough("reduce", *(arguments or ["r.bdf", "--modes", "2"]), "-o", "r.h5")
            with h5py.File(self.path("r.h5")) as f:
                return f["modes/eigenvalue"][:], f["modes/phi"][:], list(f["modes/kind"][:])
        found, shapes, kinds = reduce(self.DECK)
        np.testing.assert_allclose(found, eigenvalue, rtol=1e-8)
        self.assertEqual(kinds[2:], [kinds[2]] * 4)
        self.assertNotEqual(kinds[0], kinds[2])
        # The flexibility of the tip in y: L³ / 3EI.
        tip = (shapes[5, 1, :] ** 2 / found).sum()
        np.testing.assert_allclose(tip, 125 / (3 * 7e10 * 1e-6), rtol=1e-8)
        self.assertEqual(len(reduce(self.DECK.replace("RESVEC = YES", "RESVEC = NO"))[0]), 2)
        self.assertEqual(len(reduce(self.DECK.replace("RESVEC = YES\n", ""))[0]), 2)
        self.write("b.toml", "[body]\ndeck = \"r.bdf\"\n[body.modes]\nnumber = 2\n")
        self.assertEqual(len(reduce(self.DECK, "b.toml")[0]), 2)

    def test_lists(self):
        """BY and EXCEPT of THRU."""
        for text, grids in [("RVDOF1,3,2,THRU,6,BY,2", [2, 4, 6]), ("RVDOF1,3,2,THRU,6,EXCEPT,4", [2, 3, 5, 6]),
                            ("USET1,U6,3,2,THRU,5,EXCEPT,2,3", [4, 5]), ("RVDOF1,3,2,THRU,9", [2, 3, 4, 5, 6])]:
            data = self.solve(self.DECK.replace("RVDOF1,3,5,THRU,6", text))[1]["residual_vectors"]
            self.assertEqual(data["loads"][2:], [f"grid {g} component 3" for g in grids])

    def test_wrong_dofs(self):
        result, data, *_ = self.solve(self.DECK.replace("USET,U6,6,2", "USET,U6,1,2,6,2\nUSET,U3,2,2"))
        for error in ("modal.residual-dof", "deck.user-set"):
            self.assertIn(f"[{error}]", result.stderr)
        self.assertEqual(len(data["modes"]), 6)
        self.write("d.bdf", self.DECK.replace("USET,U6,6,2", "USET,U6,66,2"))
        self.fails(1, "modes", "d.bdf", says=["66"], error="fe.missing-grid")

    def test_told_which(self):
        self.write("d.bdf", self.DECK)
        text = self.bough("modes", "d.bdf", "--f06", "d.f06").stdout
        self.assertIn("residual vectors: 4, the last in the table, of LOAD 2, grid 6", text)
        self.assertIn("none missed", text)
        with open(self.path("d.f06")) as f:
            self.assertIn("THE LAST 4 ARE RESIDUAL VECTORS", f.read())

    def test_meffmass_of_the_case_control(self):
        self.write("d.bdf", self.DECK.replace("RESVEC = YES", "MEFFMASS(GRID=4,SUMMARY) = YES"))
        data = json.loads(self.bough("modes", "d.bdf", "--json").stdout)
        self.assertEqual(data["effective_mass_about"]["grid"], 4)
        other = json.loads(self.bough("modes", "d.bdf", "--json", "--meffmass", "4").stdout)
        self.assertEqual(data["effective_mass_about"], other["effective_mass_about"])

class Responses(ProgramTest):
    """m = 4 on a spring k = 36 to ground, driven by 2: closed forms."""

    def deck(self, sol, case, bulk):
        self.write("d.bdf", f"SOL {sol}\nCEND\nSPC = 1\nMETHOD = 1\nDLOAD = 5\n{case}BEGIN BULK\nEIGRL,1,,,1\n"
                            "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCONM2,1,1,,4.0\nCELAS2,2,36.0,1,1,2,1,0.1\nSPC1,1,23456,1\n"
                            f"SPC1,1,123456,2\nDAREA,6,1,1,2.\nTABLED1,7\n,0.,1.,100.,1.,ENDT\n{bulk}ENDDATA\n")

    def test_frequency(self):
        bulk = "RLOAD1,5,6,,,7\nFREQ1,8,.1,.2,4\n"
        request = "FREQ = 8\nDISP{0} = ALL\nACCE{0} = ALL\nSPCF{0} = ALL\n"
        for form, option in [(2, ""), (3, "(PHASE)")]:
            self.deck(111, request.format(option), bulk)
            self.bough("frequency", "d.bdf", "--op2", "d.op2", "--f06", "d.f06")
            op2 = Op2(self.path("d.op2"))
            self.assertEqual(op2.order, ["OUGV1", "OQG1"])
            self.assertEqual(len(op2.tables["OUGV1"]), 10)  # five frequencies, two quantities
            for name in op2.order:
                for (ident, _), (approach, code, subcase, *_, rows) in zip(op2.tables[name], op2.vectors(name)):
                    hz = op2.real(ident, 5)
                    omega = 2 * math.pi * hz
                    stiffness = 36 * (1 + 0.1j)
                    u = 2 / (stiffness - 4 * omega ** 2)
                    expected = {1: u, 11: -omega ** 2 * u, 3: -stiffness * u}[code]
                    self.assertEqual((approach, subcase, ident[0][8]), (5, 1, form))
                    kind, values = rows[2 if code == 3 else 1]
                    found = complex(values[0], values[6])
                    if form == 3:
                        self.assertTrue(0 <= values[6] < 360)
                        found = values[0] * np.exp(1j * math.radians(values[6]))
                    self.assertLess(abs(found - expected), 1e-5 * abs(expected))
            with open(self.path("d.f06")) as f:
                text = f.read()
            self.assertIn("C O M P L E X   D I S P L A C E M E N T   V E C T O R", text)
            self.assertIn("(MAGNITUDE/PHASE)" if option else "(REAL/IMAGINARY)", text)
            self.assertEqual(text.count("FREQUENCY = "), 15)

    def test_transient(self):
        self.deck(112, "TSTEP = 8\nDISP = ALL\n", "TLOAD1,5,6,,,7\nTSTEP,8,20,.05\n")
        self.bough("transient", "d.bdf", "--op2", "d.op2", "--f06", "d.f06")
        op2 = Op2(self.path("d.op2"))
        self.assertEqual(len(op2.tables["OUGV1"]), 21)
        for (ident, _), (approach, code, _, _, _, _, rows) in zip(op2.tables["OUGV1"], op2.vectors("OUGV1")):
            t = op2.real(ident, 5)
            self.assertEqual((approach, code), (6, 1))
            self.assertAlmostEqual(rows[1][1][0], 2 / 36 * (1 - math.cos(3 * t)), delta=1e-7)



if __name__ == "__main__":
    unittest.main()
