"""BEGIN SUPER with elements: parts condensed to their boundary give the answers of the whole deck."""
import json
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from support import ProgramTest

# A cantilever with a bend, grid 1 to 13; the masses that count are at 5, 9 and 13.
PLACES = {k: (0.5 * min(k - 1, 6), 0.4 * max(k - 7, 0), 0.1 * k) for k in range(1, 14)}
SHARED = "PBAR,1,1,1.-3,1.-6,2.-6,3.-6\nMAT1,1,7.+10,,.3{density}\n"
MASSES = "CONM2,91,5,,3.\n,1.,,2.,,,3.\nCONM2,92,9,,2.\n,.5,,.6,,,.7\nCONM2,93,13,,1.\n,.1,,.2,,,.3\n"
HEAD = ("SOL {sol}\nCEND\nSPC = 1\nMETHOD = 1\nDISPLACEMENT = ALL\nSUBCASE 1\nLOAD = 3\nBEGIN BULK\nPARAM,COUPMASS,1\nEIGRL,1,,,6\n"
        "SPC1,1,123456,1\nFORCE,3,13,0,10.,1.,2.,3.\nMOMENT,3,5,0,5.,0.,1.,1.\n" + MASSES)


def list_grids(ids, shift=0, cd=""):
    return "".join(f"GRID,{k + shift},,{x},{y},{z},{cd}\n" for k in ids for x, y, z in [PLACES[k]])


def list_bars(first, last, shift=0, v="0.,.3,1."):
    return "".join(f"CBAR,{k},1,{k + shift},{k + 1 + shift},{v}\n" for k in range(first, last))


def make_whole(sol=101, density=""):
    return (HEAD.format(sol=sol) + SHARED.format(density=density) + list_grids(range(1, 14)) + list_bars(1, 13) + "ENDDATA\n")


def make_parts(sol=101, density="", more="", first_part="", cd=""):
    """Part 1 has grids 1 to 5 with the ids of the whole, part 2 has grids 5 to 9 as 1 to 5."""
    cord = "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.6,0.8,0.\n" if cd else ""
    shared = SHARED.format(density=density)
    return (HEAD.format(sol=sol) + shared + more + list_grids([1, 5, 9, 10, 11, 12, 13]) + list_bars(9, 13)
            + "BEGIN SUPER=1\nPARAM,COUPMASS,1\n" + shared + list_grids(range(1, 6)) + list_bars(1, 5) + first_part
            + "BEGIN SUPER=2\nPARAM,COUPMASS,1\n" + shared + cord + list_grids(range(5, 10), -4, cd)
            + list_bars(5, 9, -4, *([".24,.18,1."] if cd else [])) + "ENDDATA\n")


class Parts(ProgramTest):
    def solve_static(self, deck):
        self.write("d.bdf", deck)
        self.bough("static", "d.bdf", "-o", "d.h5")
        with h5py.File(self.path("d.h5")) as f:
            u = f["subcases/1/displacement"][:].reshape(-1, 6)
            found = {int(i): u[k] for k, i in enumerate(f["dof_map"][::6, 0])}
            group = f["subcases/1/elements"]
            parts = {name: {int(i): group[name]["force"][k] for k, i in enumerate(group[name]["id"][:])}
                     for name in group if name.startswith("MUG1")}
        return found, parts

    def compare_statics(self, deck, cd=False):
        whole, _ = self.solve_static(make_whole())
        found, parts = self.solve_static(deck)
        self.assertEqual(sorted(found), [1, 5, 9, 10, 11, 12, 13])
        scale = max(np.abs(u).max() for u in whole.values())
        for grid, u in found.items():
            self.assertLess(np.abs(u - whole[grid]).max(), 1e-8 * scale, grid)
        R = np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]) if cd else np.eye(3)
        for name, shift, axes in (("MUG1_1", 0, np.eye(3)), ("MUG1_2", 4, R)):
            self.assertEqual(sorted(parts[name]), [1, 2, 3, 4, 5])
            for grid, u in parts[name].items():
                exact = np.concatenate([axes @ whole[grid + shift][:3], axes @ whole[grid + shift][3:]])
                self.assertLess(np.abs(u - exact).max(), 1e-8 * scale, (name, grid))

    def test_statics_are_those_of_the_whole_deck(self):
        self.compare_statics(make_parts())

    def test_connections_by_cards_and_displacement_systems(self):
        self.compare_statics(make_parts(more="SEBULK,1,PRIMARY,,MANUAL\nSECONCT,1,0\n,1,1,5,5\nSECONCT,2,0\n,1,5,5,9\n"
                                             "SEBULK,2,PRIMARY,,MANUAL\n", cd="7"), cd=True)

    def test_modes_with_mass_at_the_boundary_are_those_of_the_whole_deck(self):
        found = []
        for deck in (make_whole(103), make_parts(103)):
            self.write("d.bdf", deck)
            found.append(json.loads(self.bough("modes", "d.bdf", "--json").stdout)["eigenvalue"])
        np.testing.assert_allclose(found[1], found[0], rtol=1e-8)

    def test_modes_with_distributed_mass_are_guyans(self):
        self.write("d.bdf", make_parts(103, ",2700."))
        found = json.loads(self.bough("modes", "d.bdf", "--json").stdout)["eigenvalue"]
        self.write("w.bdf", make_whole(103, ",2700."))
        self.bough("matrices", "w.bdf", "-o", "k.h5")
        T, K, M = self.condense("K", "M")
        exact = 1 / eigh(T.T @ M @ T, T.T @ K @ T, eigvals_only=True)[::-1][:6]  # torsion has no mass
        np.testing.assert_allclose(found, exact, rtol=1e-8)

    def condense(self, *names):
        """Guyan's T of the whole deck, whose matrices are in k.h5, and these."""
        with h5py.File(self.path("k.h5")) as f:
            K, A = (csr_matrix((f[f"/{m}/data"], f[f"/{m}/indices"], f[f"/{m}/indptr"]), shape=f[f"/{m}/shape"]).toarray()
                    for m in names)
        inside = [6 * (k - 1) + c for k in (2, 3, 4, 6, 7, 8) for c in range(6)]
        kept = [i for i in range(6, 78) if i not in inside]
        T = np.zeros((78, len(kept)))
        T[kept] = np.eye(len(kept))
        T[inside] = -np.linalg.solve(K[np.ix_(inside, inside)], K[np.ix_(inside, kept)])
        return T, K, A

    def condense_whole(self, deck):
        """Parts are what OMIT makes of the whole deck: the interior of both follows statically."""
        return deck.replace("BEGIN BULK\n", "BEGIN BULK\nOMIT1,123456,2,3,4,6,7,8\n")

    def test_damping(self):
        """Dampers and GE of a part: complex modes of the whole deck with OMIT."""
        control = "CMETHOD = 8\nBEGIN BULK\nEIGC,8,CLAN,MAX,,,,4\n"
        dampers = "CDAMP2,81,40.,3,3,4,3\nCDAMP2,82,25.,{},2,{},2\nCELAS2,83,1.+4,2,2,4,2,.3\n"
        found = []
        for text in (self.condense_whole(make_whole(107) + dampers.format(7, 8)), make_parts(107)):
            text = text.replace("BEGIN BULK\n", control).replace(",,.3\n", ",,.3,,,,.02\n").replace("METHOD = 1\n", "")
            text = text.replace("LOAD = 3\n", "")
            if "BEGIN SUPER" in text:
                one, two, three = dampers.format(3, 4).splitlines(keepends=True)
                text = text.replace("BEGIN SUPER=2", one + three + "BEGIN SUPER=2").replace("ENDDATA", two + "ENDDATA")
            else:
                text = text.replace("ENDDATA\n", "") + "ENDDATA\n"
            self.write("d.bdf", text)
            modes = json.loads(self.bough("modes", "d.bdf", "--json").stdout)["modes"]
            found.append(np.array([complex(*(mode["eigenvalue"][part] for part in ("real", "imag"))) for mode in modes]))
        self.assertGreater(np.abs(found[0].real).min(), 1e-3)
        np.testing.assert_allclose(found[1], found[0], rtol=1e-7)

    def test_stiffness_of_stress(self):
        """Buckling and preloaded modes: K_G of a part is that of the whole deck with OMIT."""
        control = ("SOL {sol}\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 3\nSUBCASE 2\nMETHOD = 1\n{more}BEGIN BULK\nPARAM,COUPMASS,1\n"
                   "EIGRL,1,,,3\nSPC1,1,123456,1\nFORCE,3,13,0,-90.,1.,2.,1.\nMOMENT,3,5,0,5.,0.,1.,1.\n" + MASSES)
        def solve(text, *options):
            self.write("d.bdf", text)
            modes = json.loads(self.bough("modes", "d.bdf", "--json", *options).stdout)
            return modes.get("subcases", [modes])[-1]

        whole, parts = (deck.split(MASSES, 1)[1] for deck in (self.condense_whole(make_whole()), make_parts()))
        found = solve(control.format(sol=105, more="") + parts, "--buckling")["load_factor"]
        self.write("w.bdf", control.format(sol=105, more="") + whole.replace("OMIT1", "$"))
        self.bough("matrices", "w.bdf", "--load", 3, "-o", "k.h5")
        T, K, K_G = self.condense("K", "KG/LOAD_3")
        exact = -1 / eigh(T.T @ K_G @ T, T.T @ K @ T, eigvals_only=True)
        np.testing.assert_allclose(found, sorted(exact[exact > 0])[:3], rtol=1e-8)
        # The stress changes what the interior of the whole deck follows by too: to second order in it.
        control = control.format(sol=103, more="STATSUB = 1\n")
        np.testing.assert_allclose(solve(control + parts)["eigenvalue"], solve(control + whole)["eigenvalue"], rtol=2e-6)

    def test_a_column_buckles_at_eulers_load(self):
        bars = "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 11))
        grids = [f"GRID,{k},,{.1 * (k - 1)},0.,0.\n" for k in range(1, 12)]
        shared = "PBAR,1,1,1.-4,1.-9,2.-9,3.-9\nMAT1,1,2.+11,,.3,7800.\n"
        lines = bars.splitlines(keepends=True)
        self.write("d.bdf", "SOL 105\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 2\nSUBCASE 2\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,1\n"
                   "SPC1,1,123456,1\nFORCE,2,11,,-1.,1.,0.,0.\n" + shared + "".join(grids[:6]) + grids[10] + "".join(lines[:5])
                   + "BEGIN SUPER=7\n" + shared + "".join(grids[5:]) + "".join(lines[5:]) + "ENDDATA\n")
        factor = json.loads(self.bough("modes", "d.bdf", "--buckling", "--json").stdout)["load_factor"][0]
        self.assertAlmostEqual(factor / (np.pi**2 * 2e11 * 1e-9 / 4), 1, delta=2e-3)

    def test_section_on_one_grid(self):
        """An appendage without load hangs at one grid: its condensed stiffness is round-off, and so no stress is in it."""
        bars = "".join(f"GRID,{k},,{1. + .3 * (k - 3)},{.4 * (k - 3)},.1\nCBAR,{k},1,{k - 1},{k},0.,0.,1.\n" for k in (4, 5))
        shared = "PBAR,1,1,1.-4,2.-9,1.-9,3.-9\nMAT1,1,7.+10,,.3,2700.\n"
        main = ("SOL 105\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 2\nSUBCASE 2\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,3\n"
                "SPC1,1,123456,1\nFORCE,2,3,,50.,-1.,.2,.3\n" + shared + "GRID,1,,-1.,0.,0.\nGRID,2,,0.,0.,0.\n"
                "GRID,3,,1.,0.,0.\nCBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\n")
        factors = []
        for text in (main, main + bars, main + "BEGIN SUPER=3\n" + shared + "GRID,3,,1.,0.,0.\n" + bars):
            self.write("d.bdf", text + "ENDDATA\n")
            factors.append(json.loads(self.bough("modes", "d.bdf", "--buckling", "--json").stdout)["load_factor"])
        np.testing.assert_allclose(factors[1], factors[0], rtol=1e-8)
        np.testing.assert_allclose(factors[2], factors[0], rtol=1e-8)

    def test_what_is_not_condensed_is_named(self):
        self.write("d.bdf", make_parts().replace("LOAD = 3\n", "LOAD = 3\nTEMPERATURE(LOAD) = 5\n")
                   .replace("BEGIN SUPER=2", "TEMPD,5,100.\nBEGIN SUPER=2\nTEMPD,5,100."))
        result = self.fails(1, "static", "d.bdf", error="fe.part-load", says=["superelement 1", "temperatures"])
        self.assertNotIn("matrices.superelement-type", result.stderr)
        self.write("d.bdf", make_parts().replace("BEGIN SUPER=2", "BEGIN SUPER=2\nDAREA,9,2,1,1."))
        self.fails(1, "static", "d.bdf", error="fe.part-load", says=["superelement 2", "DAREA"])
        self.write("d.bdf", make_parts(more="GRID,105,,2.,0.,.5\nCBUSH,105,105,5,105,,,,0\nPBUSH,105,K,1.+6,1.+6,1.+6,1.+6,1.+6,1.+6\n"))
        self.fails(1, "static", "d.bdf", error="fe.part-boundary", says=["grids 5 and 105", "grid 5 of superelement 1"])
        self.write("d.bdf", make_parts())
        self.fails(1, "split", "d.bdf", "--parts", "2", error="split.superelements")

    def test_written_deck_has_the_sections(self):
        """export --to bdf writes each section: modes of the deck and of the written one are those of one model."""
        self.write("d.bdf", make_parts())
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "e.bdf")
        hz = [json.loads(self.bough("modes", deck, "--json").stdout)["frequency_hz"] for deck in ("d.bdf", "e.bdf")]
        np.testing.assert_allclose(hz[1], hz[0], rtol=1e-9)

    def test_sets_of_sections_alone(self):
        """MPC and SPC sets that only a section has are no empty selections; no message of PRIMARY follows another error."""
        deck = make_parts(first_part="MPC,6,3,3,1.,4,3,-1.\n", more="SEBULK,1,PRIMARY\n").replace(
            "SPC = 1\n", "SPC = 1\nMPC = 6\n")
        self.write("d.bdf", deck)
        self.assertNotIn("fe.empty-mpc-set", self.bough("static", "d.bdf").stderr)
        self.write("d.bdf", deck.replace("MPC = 6", "MPC = 7"))
        self.assertIn("fe.empty-mpc-set", self.bough("static", "d.bdf").stderr)
        held = deck.replace("SPC1,1,123456,1\n", "").replace("BEGIN SUPER=1", "BEGIN SUPER=1\nSPC1,1,123456,2\n")
        self.write("d.bdf", held)
        self.assertNotIn("fe.missing-set", self.bough("static", "d.bdf").stderr)
        self.write("d.bdf", deck.replace("EIGRL,1,,,6", "EIGRL,1,,,x"))
        result = self.fails(1, "static", "d.bdf", error="deck.bad-integer")
        self.assertNotIn("PRIMARY", result.stderr)
        self.assertNotIn("superelement", result.stderr)

    def test_normals_at_a_cut(self):
        """A vault of CQUAD4 in three sections: shells of all of them make the normals (PARAM,SNORM) at the cut."""
        grid = lambda i, j: 100 * i + j
        places = {grid(i, j): (np.sin(.2 * i), .3 * j, np.cos(.2 * i)) for i in range(1, 8) for j in range(1, 4)}
        shared = "PSHELL,1,1,.02,1,,1\nMAT1,1,7.+10,,.3,2700.\n"

        def write_grids(columns):
            return "".join(f"GRID,{grid(i, j)},,{x:.12f},{y:.12f},{z:.12f}\n".replace("0.000000000000", "0.")
                           for i in columns for j in range(1, 4) for x, y, z in [places[grid(i, j)]])

        def write_shells(columns):
            return "".join(f"CQUAD4,{grid(i, j)},1,{grid(i, j)},{grid(i + 1, j)},{grid(i + 1, j + 1)},{grid(i, j + 1)}\n"
                           for i in columns for j in (1, 2))

        head = ("SOL 101\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 3\nBEGIN BULK\nSPC1,1,123456,101,102,103\n"
                "FORCE,3,702,0,10.,1.,2.,3.\nMOMENT,3,702,0,1.,1.,2.,0.\n" + shared)
        whole = head + write_grids(range(1, 8)) + write_shells(range(1, 7)) + "ENDDATA\n"
        parts = (head + write_grids([1, 2, 3, 5, 7]) + write_shells([1, 2]) + "BEGIN SUPER=1\n" + shared
                 + write_grids([3, 4, 5]) + write_shells([3, 4]) + "BEGIN SUPER=2\n" + shared + write_grids([5, 6, 7])
                 + write_shells([5, 6]) + "ENDDATA\n")
        exact, _ = self.solve_static(whole)
        found, tables = self.solve_static(parts)
        u = np.array([exact[g] for g in found])
        for columns in (slice(0, 3), slice(3, 6)):
            scale = np.abs(u[:, columns]).max()
            for g, values in found.items():
                self.assertLess(np.abs(values[columns] - exact[g][columns]).max(), 1e-8 * scale, g)
            for g, values in tables["MUG1_1"].items():
                self.assertLess(np.abs(values[columns] - exact[g][columns]).max(), 1e-8 * scale, g)

    def test_a_part_with_supports(self):
        """A support inside of a part, by the set of the subcase."""
        whole = make_whole().replace("SPC1,1,123456,1\n", "SPC1,1,123456,1\nSPC1,1,13,3\n")
        self.write("d.bdf", whole)
        expected, _ = self.solve_static(whole)
        found, _ = self.solve_static(make_parts(first_part="SPC1,1,13,3\n"))
        scale = max(np.abs(u).max() for u in expected.values())
        for grid, u in found.items():
            self.assertLess(np.abs(u - expected[grid]).max(), 1e-8 * scale)

    def test_parts_that_do_not_fit_are_named(self):
        self.write("d.bdf", make_parts().replace("BEGIN SUPER=2", "BEGIN SUPER=2\nSPCD,3,2,1,.1"))
        self.fails(1, "static", "d.bdf", error="fe.part-load", says=["superelement 2", "SPCD"])
        # Without grid 5 of the main bulk data the parts meet outside of it.
        text = make_parts()
        main, rest = text.split("BEGIN SUPER=1")
        main = "\n".join(line for line in main.split("\n") if not line.startswith(("GRID,5,", "MOMENT,3,5", "CONM2,91", ",1.,,2.")))
        self.write("d.bdf", main + "BEGIN SUPER=1" + rest)
        self.fails(1, "static", "d.bdf", error="fe.part-boundary", says=["grid 5 of superelement 1"])
        self.write("d.bdf", make_parts(more="SEBULK,1,PRIMARY,,MANUAL\n"))
        self.fails(1, "static", "d.bdf", error="fe.part-boundary", says=["superelement 1 joins no grid"])
        self.write("d.bdf", make_parts(more="SECONCT,1,2\n,5,1\n"))
        self.fails(1, "static", "d.bdf", error="fe.part-boundary", says=["each other"])


if __name__ == "__main__":
    unittest.main()
