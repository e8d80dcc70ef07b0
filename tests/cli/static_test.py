"""static, matrices, and the modes of several subcases, on small models with known answers."""
import json
import math
import os
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.sparse

from support import ProgramTest, launch_ranks
from decks import row
from verbs_test import make_column

FRAME = """SOL 101
CEND
SPC = 1
SUBCASE 1
LABEL = TIP FORCE
LOAD = 4
SUBCASE 2
LOAD = 5
SUBCASE 3
SPC = 2
LOAD = 6
BEGIN BULK
""" + row(3) + """CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
PBAR,1,1,1.-3,1.-8,1.-8,1.-8
MAT1,1,7.+10,,.3,2700.
SPC1,1,123456,1
SPC1,2,123456,1
SPC,2,3,2,.01
FORCE,4,3,,10.,0.,1.,0.
PLOAD1,5,1,FY,FR,0.,3.,1.,3.
PLOAD1,5,2,FY,FR,0.,3.,1.,3.
SPCD,6,3,2,.02
ENDDATA
"""
EI = 700.0


def read_csr(group):
    return scipy.sparse.csr_matrix((group["data"][:], group["indices"][:], group["indptr"][:]), shape=tuple(group["shape"][:]))


class Static(ProgramTest):
    def test_oblique_directions_of_autospc_react(self):
        # A mass at the end of an oblique rod: the direction across the rod is held, as a whole.
        self.write("r.bdf", "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,1.,0.\n"
                   "CROD,1,1,1,2\nPROD,1,1,1.-4\nMAT1,1,7.+10,,.3\nCONM2,9,2,,3.\nSPC1,1,123456,1\n"
                   "FORCE,2,2,,10.,0.,1.,0.\nENDDATA\n")
        result = self.bough("static", "r.bdf", "-o", "r.h5")
        self.assertIn("[fe.load-autospc]", result.stderr)
        with h5py.File(self.path("r.h5")) as f:
            case = f["subcases"][list(f["subcases"])[0]]
            np.testing.assert_allclose(case["reaction"][:].reshape(2, 6)[:, :3], [[-5, -5, 0], [5, -5, 0]], atol=1e-9)
            self.assertLess(np.abs(case["mpc_force"][:]).max(), 1e-9)

    def test_vectors_of_zeros_take_no_space(self):
        n = 40
        grids = "".join(f"GRID,{i + 1},,{i % n:d}.,{i // n:d}.,0.\n" for i in range(n * n))
        plates = "".join(f"CQUAD4,{a},1,{a},{a + 1},{a + n + 1},{a + n}\n" for a in range(1, n * n - n) if a % n)
        ties = "RBE2,99999,1600,123456,9999\nGRID,9999,,40.,40.,0.\n"
        for tie, loaded in [("", 1600), (ties, 9999)]:
            self.write("plate.bdf", "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n" + grids + plates + tie +
                       "PSHELL,1,1,.1,1,,1\nMAT1,1,7.+10,,.3\nSPC1,1,123456,1,THRU,40\n"
                       f"FORCE,2,{loaded},,1.,3.,0.,5.\nPARAM,K6ROT,1.\nENDDATA\n")
            self.bough("static", "plate.bdf", "-o", "plate.h5", "-q")
            with h5py.File(self.path("plate.h5")) as f:
                dofs = f["dof_map"][:]
                self.assertGreater(len(dofs), 8192)
                (case,) = f["subcases"].values()
                load, reaction, mpc = (case[name][:] for name in ("load", "reaction", "mpc_force"))
            at = np.flatnonzero(load)
            self.assertEqual([(*dofs[i], load[i]) for i in at], [(loaded, 1, 3), (loaded, 3, 5)])
            self.assertTrue((dofs[np.flatnonzero(reaction), 0] <= n).all())
            sums = [sum(reaction[i] for i in np.flatnonzero(dofs[:, 1] == c)) for c in (1, 2, 3)]
            np.testing.assert_allclose(sums, [-3, 0, -5], atol=1e-7)
            # Forces of constraints only where there are some.
            self.assertEqual(set(dofs[np.flatnonzero(mpc), 0]), {1600, 9999} if tie else set())

    def test_cantilever_against_theory(self):
        self.write("frame.bdf", FRAME)
        cases = json.loads(self.bough("static", "frame.bdf", "--json", "--full", "-o", "s.h5").stdout)["subcases"]
        self.assertEqual([c["id"] for c in cases], [1, 2, 3])
        dofs = {(n, c): i for i, (n, c) in enumerate(cases[0]["dof_map"])}
        tip = dofs[3, 2]
        self.assertAlmostEqual(cases[0]["displacement"][tip], 10 * 8 / (3 * EI), places=12)
        self.assertAlmostEqual(cases[1]["displacement"][tip], 3 * 16 / (8 * EI), places=12)
        self.assertAlmostEqual(cases[2]["displacement"][tip], 0.02, places=14)
        self.assertAlmostEqual(cases[2]["reaction"][tip], 3 * EI * 0.02 / 8, places=9)
        bars = cases[1]["elements"]["CBAR"]
        moment = bars["components"].index("moment_z_a")
        self.assertAlmostEqual(abs(bars["force"][0][moment]), 3 * 4 / 2, places=9)
        self.assertAlmostEqual(abs(bars["force"][1][moment]), 3 * 1 / 2, places=9)
        for case in cases:
            sums = np.array(case["resultants"]["load"]) + case["resultants"]["reaction"]
            self.assertLess(np.abs(sums).max(), 1e-9)
            self.assertLess(case["epsilon"], 1e-10)
        with h5py.File(self.path("s.h5")) as f:
            self.assertEqual(f.attrs["format"], "bough-static")
            np.testing.assert_allclose(f["/subcases/1/displacement"][:], cases[0]["displacement"], rtol=0, atol=0)
            np.testing.assert_allclose(f["/subcases/3/reaction"][:], cases[2]["reaction"], rtol=0, atol=0)
            self.assertEqual(f["/subcases/2/elements/CBAR/force"].shape, (2, 8))
            self.assertEqual(list(f["/subcases/2/elements/CBAR"].attrs["components"]), bars["components"])
            self.assertEqual(f["/dof_map"].shape, (18, 2))
            self.assertEqual(f["/subcases/1"].attrs["label"], "TIP FORCE")

    def test_inertia_relief_of_a_pushed_bar(self):
        # Lumped: half of the mass at the ends, so a = F/m along the bar, and the middle pushes the far half.
        free = FRAME.replace("SPC = 1\nSUBCASE 1", "SUBCASE 1")
        text = free.split("SUBCASE 2")[0] + "BEGIN BULK" + free.split("BEGIN BULK")[1]
        text = text.replace("FORCE,4,3,,10.,0.,1.,0.", "FORCE,4,3,,10.,1.,0.,0.\nSUPORT,1,123456\nPARAM,INREL,-1")
        self.write("free.bdf", text.replace("ENDDATA", "CONM2,9,2,,0.,,,,,+\n+,1.,,1.,,,1.\nENDDATA"))
        run = self.bough("static", "free.bdf", "--json", "--full", "-o", "free.h5")
        case = json.loads(run.stdout)["subcases"][0]
        mass, stiffness = 2 * 1e-3 * 2700, 7e10 * 1e-3
        self.assertAlmostEqual(case["support"][0]["acceleration"], 10 / mass, places=9)
        dofs = {(n, c): i for i, (n, c) in enumerate(case["dof_map"])}
        self.assertAlmostEqual(case["displacement"][dofs[3, 1]] * stiffness, 10 * (0.25 + 0.75), places=9)
        self.assertLess(np.abs(np.add(case["resultants"]["load"], case["resultants"]["inertia"])).max(), 1e-9)
        self.assertLess(case["support_epsilon"], 1e-12)
        with h5py.File(self.path("free.h5")) as f:
            self.assertAlmostEqual(f["subcases/1/support/acceleration"][0], 10 / mass, places=9)
            self.assertEqual(f["subcases/1/support/dofs"][:].tolist(), [[1, c] for c in range(1, 7)])
        self.assertIn("INERTIA", self.bough("static", "free.bdf").stdout)

    def test_plate_under_pressure(self):
        # Simply supported square plate: w = 0.00406235 q a^4 / D (Timoshenko & Woinowsky-Krieger, table 8).
        n, a, E, nu, t, q = 16, 2.0, 7e10, 0.3, 0.01, 100.0
        node = lambda i, j: 1 + i + j * (n + 1)
        lines = ["SOL 101", "CEND", "SPC = 1", "LOAD = 4", "BEGIN BULK", f"MAT1,1,{E},,{nu}", f"PSHELL,1,1,{t},1,,1",
                 f"PLOAD2,4,{q},1,THRU,{n * n}", "SPC1,1,126,1,THRU,9999"]
        lines += [f"GRID,{node(i, j)},,{a * i / n:.9f},{a * j / n:.9f},0." for j in range(n + 1) for i in range(n + 1)]
        lines += [f"CQUAD4,{1 + i + j * n},1,{node(i, j)},{node(i + 1, j)},{node(i + 1, j + 1)},{node(i, j + 1)}"
                  for j in range(n) for i in range(n)]
        lines += [f"SPC1,1,3,{node(i, j)}" for j in range(n + 1) for i in range(n + 1) if i in (0, n) or j in (0, n)]
        self.write("plate.bdf", "\n".join(lines + ["ENDDATA", ""]))
        case = json.loads(self.bough("static", "plate.bdf", "--json").stdout)["subcases"][0]
        most = case["max_displacement"][2]
        D = E * t ** 3 / 12 / (1 - nu ** 2)
        self.assertEqual(most["grid"], node(n // 2, n // 2))
        self.assertAlmostEqual(most["value"] / (0.00406235 * q * a ** 4 / D), 1, delta=0.005)
        self.assertAlmostEqual(case["resultants"]["load"][2], q * a * a, places=9)
        self.assertAlmostEqual(case["resultants"]["reaction"][2], -q * a * a, places=6)

    def test_tables(self):
        self.write("frame.bdf", FRAME)
        text = self.bough("static", "frame.bdf").stdout
        for words in ["subcase 1 (TIP FORCE)", "OLOAD", "SPCFORCE", "epsilon", "CBAR", "moment_z_a"]:
            self.assertIn(words, text)
        full = self.bough("static", "frame.bdf", "--subcase", "1", "--full").stdout
        self.assertNotIn("subcase 2", full)
        self.assertIn("displacement", full)

    def test_wrong_input(self):
        self.write("none.bdf", FRAME.replace("LOAD = ", "$").replace("SPC,2,3,2,.01\n", ""))
        self.fails(1, "static", "none.bdf", error="cli.no-static-load")
        self.write("unknown.bdf", FRAME.replace("LOAD = 4", "LOAD = 44"))
        self.fails(1, "static", "unknown.bdf", says=["44"], error="fe.missing-load")
        self.write("loose.bdf", FRAME.replace("SPC1,1,123456,1", "SPC1,1,123,1"))
        self.fails(1, "static", "loose.bdf", says=["grid"], error="fe.mechanism")
        self.write("frame.bdf", FRAME)
        self.fails(1, "static", "frame.bdf", "--subcase", "9", error="fe.unknown-subcase")

    def test_temperatures(self):
        # The first bar may expand, the second is heated too; a force in subcase 8 alone.
        deck = FRAME.replace("ENDDATA", "TEMPD,9,100.\nENDDATA").replace(
            "MAT1,1,7.+10,,.3,2700.", "MAT1,1,7.+10,,.3,2700.,1.-5,20.").replace(
            "SUBCASE 2\n", "SUBCASE 2\nTEMP(LOAD) = 9\n").replace("SUBCASE 3", "SUBCASE 7\nTEMP = 9\nLOAD = 0\nSUBCASE 3")
        self.write("frame.bdf", deck)
        data = json.loads(self.bough("static", "frame.bdf", "--json", "--full", "-o", "frame.h5").stdout)["subcases"]
        by_id = {s["id"]: s for s in data}
        self.assertEqual([by_id[i]["temperature_set"] for i in (1, 2, 7)], [0, 9, 9])
        for i in (2, 7):
            self.assertAlmostEqual(by_id[i]["displacement"][12], 2 * 80e-5, delta=1e-12)
            self.assertLess(abs(by_id[i]["elements"]["CBAR"]["force"][1][0]), 1e-6)
        self.assertIn("TEMPERATURE 9", self.bough("static", "frame.bdf", "--subcase", "7").stdout)
        with h5py.File(self.path("frame.h5")) as f:
            self.assertEqual(f["subcases/7"].attrs["temperature_set"], 9)
        self.bough("matrices", "frame.bdf", "-o", "frame-matrices.h5")
        with h5py.File(self.path("frame-matrices.h5")) as f:
            self.assertIn("TEMP_9", f["KG"])

    def test_displacement_axes(self):
        deck = FRAME.replace("GRID,3,,2.,0.,0.", "CORD2R,5,,0.,0.,0.,0.,0.,1.,+\n+,0.,1.,0.\nGRID,3,,2.,0.,0.,5")
        self.write("frame.bdf", deck)
        basic, cd = (json.loads(self.bough("static", "frame.bdf", "--json", "--full", "--subcase", "1",
                                           *options).stdout)["subcases"][0] for options in ([], ["--cd"]))
        # x of the system is y of basic.
        self.assertAlmostEqual(cd["displacement"][12], basic["displacement"][13], delta=1e-15)
        self.assertAlmostEqual(cd["displacement"][13], -basic["displacement"][12], delta=1e-15)
        self.assertEqual(cd["displacement"][:12], basic["displacement"][:12])
        self.assertEqual(cd["load"][12], 10)

    def test_two_ranks(self):
        self.write("frame.bdf", FRAME)
        one = json.loads(self.bough("static", "frame.bdf", "--json", "--full").stdout)["subcases"]
        launcher = launch_ranks("-n", 2)
        two = json.loads(self.bough("static", "frame.bdf", "--json", "--full", launcher=launcher).stdout)["subcases"]
        for a, b in zip(one, two):
            np.testing.assert_allclose(b["displacement"], a["displacement"], rtol=1e-9, atol=1e-14)
            np.testing.assert_allclose(b["elements"]["CBAR"]["force"], a["elements"]["CBAR"]["force"], rtol=1e-9, atol=1e-8)
        self.bough("matrices", "frame.bdf", "-o", "one.h5")
        self.bough("matrices", "frame.bdf", "-o", "two.h5", launcher=launcher)
        with h5py.File(self.path("one.h5")) as f, h5py.File(self.path("two.h5")) as g:
            for name in ["K", "M", "KG/LOAD_4"]:
                difference = read_csr(f[name]) - read_csr(g[name])
                self.assertLess(abs(difference).max(), 1e-9 * abs(read_csr(f[name])).max())


class Matrices(ProgramTest):
    def test_hdf5_matrices(self):
        self.write("column.bdf", make_column())
        self.bough("matrices", "column.bdf", "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            self.assertEqual(f.attrs["format"], "bough-matrices")
            K, M, KG = (read_csr(f[name]) for name in ["K", "M", "KG/LOAD_4"])
            dof_map, xyz = f["/dof_map"][:], f["/grids/xyz"][:]
        self.assertEqual(K.shape, (41 * 6, 41 * 6))
        scale = abs(K).max()
        for A in (K, M, KG):
            self.assertLess(abs(A - A.T).max(), 1e-9 * abs(A).max())
        # Rigid motions do not strain; the mass of a translation is the mass.
        rigid = np.zeros((K.shape[0], 6))
        for g in range(41):
            rigid[6 * g:6 * g + 6] = np.eye(6)
            x, y, z = xyz[g]
            rigid[6 * g:6 * g + 3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        self.assertLess(np.abs(K @ rigid).max(), 1e-9 * scale)
        self.assertAlmostEqual(rigid[:, 1] @ (M @ rigid[:, 1]), 2700 * 1e-3 * 10, places=9)
        # Euler's load from these matrices alone: the plane problem with both ends pinned.
        free = [i for i, (node, c) in enumerate(dof_map) if c in (2, 6) and not (c == 2 and node in (1, 41))]
        Kf, Gf = K[free][:, free].toarray(), KG[free][:, free].toarray()
        theta = np.linalg.eigvals(np.linalg.solve(Kf, -Gf)).real.max()
        self.assertAlmostEqual(1 / theta / (math.pi ** 2 * 700 / 100), 1, places=4)

    def test_text_formats(self):
        self.write("column.bdf", make_column())
        self.bough("matrices", "column.bdf", "-o", "m.h5")
        files = json.loads(self.bough("matrices", "column.bdf", "--to", "mtx", "-o", "m.mtx", "--json").stdout)["files"]
        self.assertEqual(files, ["m.K.mtx", "m.M.mtx", "m.KG4.mtx", "m.dofs.csv"])
        self.bough("matrices", "column.bdf", "--to", "op4", "-o", "m.op4")
        op4 = self.read_op4("m.op4")
        with h5py.File(self.path("m.h5")) as f:
            for path, name in [("K", "K"), ("M", "M"), ("KG/LOAD_4", "KG4")]:
                A = read_csr(f[path]).toarray()
                bound = 1e-15 * np.abs(A).max()
                B = scipy.io.mmread(self.path(f"m.{name}.mtx")).toarray()
                self.assertLess(np.abs(A - B).max(), 1e-9 * np.abs(A).max())
                self.assertLess(np.abs(op4[name] - A).max(), bound)

    def read_op4(self, name):
        matrices = {}
        with open(self.path(name)) as f:
            while header := f.readline():
                columns, rows, form, kind = (int(header[8 * k:8 * k + 8]) for k in range(4))
                self.assertEqual((form, kind, header[40:56].strip()), (6, 2, "1P,3E23.16"))
                A = np.zeros((rows, columns))
                while True:
                    column, first, count = (int(word) for word in f.readline().split())
                    values = []
                    while len(values) < count:
                        line = f.readline().rstrip("\n")
                        values += [float(line[23 * k:23 * k + 23]) for k in range(len(line) // 23)]
                    if column > columns:
                        break
                    A[first - 1:first - 1 + count, column - 1] = values
                matrices[header[32:40].strip()] = A
        return matrices


class Modes(ProgramTest):
    def test_every_subcase_with_its_constraints(self):
        deck = FRAME.replace("SOL 101", "SOL 103").replace("SPC,2,3,2,.01", "SPC1,2,123456,3")
        deck = deck.replace("SUBCASE 1\n", "METHOD = 7\nSUBCASE 1\n").replace("BEGIN BULK\n", "BEGIN BULK\nEIGRL,7,,,2\n")
        self.write("frame.bdf", deck)
        data = json.loads(self.bough("modes", "frame.bdf", "--json", "-o", "m.h5").stdout)
        self.assertEqual([s["subcase"] for s in data["subcases"]], [1, 3])  # 2 is 1 again
        self.assertEqual(data["frequency_hz"], data["subcases"][0]["frequency_hz"])
        self.assertGreater(data["subcases"][1]["frequency_hz"][0], 2 * data["frequency_hz"][0])
        self.assertTrue(os.path.exists(self.path("m-subcase-3.h5")))
        one = json.loads(self.bough("modes", "frame.bdf", "--json", "--subcase", "3").stdout)
        np.testing.assert_allclose(one["frequency_hz"], data["subcases"][1]["frequency_hz"], rtol=1e-9)

    def test_givens_gives_the_number_asked_for(self):
        deck = FRAME.replace("SOL 101", "SOL 103").replace("SPC = 1\n", "SPC = 1\nMETHOD = 7\n", 1)
        self.write("frame.bdf", deck.replace("BEGIN BULK\n", "BEGIN BULK\nEIGR,7,GIV,0.,.1,,4\n"))
        data = json.loads(self.bough("modes", "frame.bdf", "--json", "--subcase", "1").stdout)
        self.assertEqual(len(data["frequency_hz"]), 4)

    def test_buckling_writes_its_shapes(self):
        self.write("column.bdf", make_column())
        self.bough("modes", "column.bdf", "--buckling", "-o", "b.h5")
        with h5py.File(self.path("b.h5")) as f:
            n = len(f["/buckling/load_factor"])
            self.assertEqual(f["/modes/phi"].shape, (41, 6, n))
            shape = f["/modes/phi"][:, 1, 0]
            sine = np.sin(np.pi * np.arange(41) / 40)
            self.assertLess(np.abs(shape / shape[20] - sine).max(), 1e-4)


class Mechanisms(ProgramTest):
    def test_more_than_are_listed_are_told_to_be_more(self):
        pairs = "".join(f"CELAS2,{k},9.,{2 * k},,{2 * k + 1}\n" for k in range(1, 31))
        self.write("p.bdf", "SOL 101\nCEND\nLOAD = 1\nBEGIN BULK\nSPOINT,2,THRU,61\nSLOAD,1,2,1.\n" + pairs + "ENDDATA\n")
        self.fails(1, "static", "p.bdf", says=["mechanism 1 of 24 or more"], error="fe.mechanism")


class CheckGeometry(ProgramTest):
    def test_coincident_and_unused_grids(self):
        self.write("frame.bdf", FRAME.replace("ENDDATA", "GRID,8,,1.,0.,0.\nENDDATA"))
        text = self.bough("check", "frame.bdf").stdout
        self.assertIn("coincident grids: 1 (2 and 8)", text)
        self.assertIn("grids not used: 1 (8)", text)
        data = json.loads(self.bough("check", "frame.bdf", "--json").stdout)
        self.assertEqual(data["geometry"]["coincident_grids"], [[2, 8]])
        self.assertLess(max(data["ground_check_n"]), 1e-12)
        self.assertGreater(max(data["ground_check_f"]), 1e-3)  # clamped: its supports do not follow


if __name__ == "__main__":
    unittest.main()
