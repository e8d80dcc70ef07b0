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
        with h5py.File(self.path("k.h5")) as f:
            K, M = (csr_matrix((f[f"/{m}/data"], f[f"/{m}/indices"], f[f"/{m}/indptr"]), shape=f[f"/{m}/shape"]).toarray()
                    for m in "KM")
        inside = [6 * (k - 1) + c for k in (2, 3, 4, 6, 7, 8) for c in range(6)]
        kept = [i for i in range(6, 78) if i not in inside]
        T = np.zeros((78, len(kept)))
        T[kept] = np.eye(len(kept))
        T[inside] = -np.linalg.solve(K[np.ix_(inside, inside)], K[np.ix_(inside, kept)])
        exact = 1 / eigh(T.T @ M @ T, T.T @ K @ T, eigvals_only=True)[::-1][:6]  # torsion has no mass
        np.testing.assert_allclose(found, exact, rtol=1e-8)

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
        self.write("d.bdf", make_parts().replace("BEGIN SUPER=2", "BEGIN SUPER=2\nFORCE,3,2,0,1.,1.,0.,0."))
        self.fails(1, "static", "d.bdf", error="fe.part-load", says=["superelement 2"])
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
