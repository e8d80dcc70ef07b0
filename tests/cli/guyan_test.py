"""ASET and OMIT: statics do not change, modes are those of NumPy's Guyan reduction, wrong sets are named."""
import json
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from support import ProgramTest, launch_ranks
from decks import begin, bent_cantilever

N = 9  # grids of a bent cantilever with a rotated displacement system and an MPC


def make_deck(cards="", spc="SPC1,1,123456,1\n"):
    """A bent cantilever with a rotated displacement system and an MPC."""
    line = bent_cantilever(N, lambda k: ",7" if k == 3 else ",")
    return begin(103, "SPC = 1", "MPC = 5", "METHOD = 1", "SUBCASE 1", "LOAD = 3") + (
            f"PARAM,COUPMASS,1\nEIGRL,1,,,4\nCORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.6,0.8,0.\nPBAR,1,1,1.-3,1.-6,2.-6,3.-6\n"
            f"MAT1,1,7.+10,,.3,2700.\n{line}MPC,5,9,3,1.,7,3,-0.5\nCONM2,90,9,,0.5\nFORCE,3,6,0,10.,1.,2.,3.\nMOMENT,3,4,0,5.,0.,1.,1.\n"
            f"FORCE,3,9,0,-4.,0.,1.,1.\n"
            f"GRAV,4,0,9.81,0.,0.,-1.\n{spc}{cards}ENDDATA\n")


ASET = "ASET1,123,3,5,7\nASET,4,1,9,12\n"


def calc_oracle(matrices, kept):
    """Frequencies of the Guyan reduction to the (grid, component) of `kept`, from K and M of the g-set."""
    with h5py.File(matrices) as f:
        K, M = [csr_matrix((f[f"/{m}/data"], f[f"/{m}/indices"], f[f"/{m}/indptr"]), shape=f[f"/{m}/shape"]).toarray()
                for m in "KM"]
    R = np.eye(6 * N)
    z, x = np.array([0.0, 0, 1]), np.array([0.6, 0.8, 0])
    axes = np.array([x, np.cross(z, x), z]).T
    R[18:21, 18:21] = R[21:24, 21:24] = axes
    T = R.copy()
    dependent, source = 6 * 8 + 2, 6 * 6 + 2
    T[:, source] += 0.5 * T[:, dependent]
    a = [6 * (g - 1) + c - 1 for g, c in kept]
    o = [i for i in range(6, 6 * N) if i not in a and i != dependent]
    K, M = T.T @ K @ T, T.T @ M @ T
    G = -np.linalg.solve(K[np.ix_(o, o)], K[np.ix_(o, a)])
    order = a + o
    K, M = K[np.ix_(order, order)], M[np.ix_(order, order)]
    W = np.vstack([np.eye(len(a)), G])
    return eigh(W.T @ K @ W, W.T @ M @ W, eigvals_only=True)


class Guyan(ProgramTest):
    def calc_modes(self, name, *arguments):
        return np.array(json.loads(self.bough("modes", name, "--json", *arguments).stdout)["eigenvalue"])

    def test_modes_are_those_of_numpy(self):
        self.write("f.bdf", make_deck())
        self.write("a.bdf", make_deck(ASET))
        self.bough("matrices", "f.bdf", "-o", "k.h5")
        kept = [(g, c) for g in (3, 5, 7) for c in (1, 2, 3)] + [(4, 1), (9, 1), (9, 2)]
        expected = calc_oracle(self.path("k.h5"), kept)
        found = self.calc_modes("a.bdf", "-n", 6)
        self.assertLess(np.abs(found / expected[:6] - 1).max(), 1e-8)
        full = self.calc_modes("f.bdf", "-n", 6)
        self.assertTrue(np.all(found > full))   # a constraint raises frequencies, more so the higher ones
        self.assertGreater(found[5] / full[5], 1.001)
        # The shapes are those of all grids: the omitted follow.
        self.bough("modes", "a.bdf", "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            self.assertGreater(np.abs(f["/modes/phi"][1]).max(), 1e-3)

    def test_omit_is_what_aset_leaves(self):
        self.write("a.bdf", make_deck("ASET1,123456,2,THRU,6\nASET1,123456,8\n"))
        self.write("o.bdf", make_deck("OMIT1,123456,7\nOMIT1,12456,9\n"))
        both = self.calc_modes("a.bdf"), self.calc_modes("o.bdf")
        self.assertLess(np.abs(both[0] / both[1] - 1).max(), 1e-9)

    def test_statics_do_not_change(self):
        spc = "SPC1,1,123456,1\nSPC,1,5,2,1.-3\n"   # an enforced displacement as well
        self.write("f.bdf", make_deck(spc=spc))
        self.write("a.bdf", make_deck("ASET1,13,3,5,7\nASET,4,1,9,12\n", spc))
        results = []
        for name in ["f", "a"]:
            self.bough("static", f"{name}.bdf", "-o", f"{name}.h5")
            with h5py.File(self.path(f"{name}.h5")) as f:
                group = f["/subcases/1"]
                results.append([group[key][:] for key in ("displacement", "reaction", "mpc_force")])
        for full, reduced in zip(*results):
            self.assertGreater(np.abs(full).max(), 0)
            self.assertLess(np.abs(full - reduced).max(), 1e-9 * np.abs(full).max())

    def test_body_has_the_exact_stresses_of_its_loads(self):
        # Only the modes are reduced: their K_G2 is that of the static solution of the whole deck.
        self.write("f.bdf", make_deck())
        self.write("a.bdf", make_deck(ASET))
        self.bough("matrices", "f.bdf", "--load", 3, "--load", 4, "-o", "k.h5")
        self.write("a.toml", '[body]\nname = "a"\ndeck = "a.bdf"\n[body.modes]\nnumber = 6\n[body.output]\nfull = true\n'
                             '[[body.load]]\nname = "p"\nload_set = 3\n[[body.load]]\nname = "g"\nload_set = 4\n')
        self.bough("reduce", "a.toml", "-o", "a.h5")
        with h5py.File(self.path("k.h5")) as f, h5py.File(self.path("a.h5")) as a:
            phi = a["/full/phi"][:]
            for i, load in enumerate(["LOAD_3", "LOAD_4"]):
                group = f["/KG"][load]
                K_G = csr_matrix((group["data"], group["indices"], group["indptr"]), shape=group["shape"]).toarray()
                expected = phi.T @ K_G @ phi
                self.assertLess(np.abs(a["/stiffening/kg_external"][i] - expected).max(), 1e-9 * np.abs(expected).max())
            # Gravity along -z is the inertial load of an acceleration along z.
            self.assertLess(np.abs(9.81 * a["/stiffening/kg_inertial"][2] - expected).max(), 1e-9 * np.abs(expected).max())

    def test_the_same_on_two_and_three_processes(self):
        self.write("a.bdf", make_deck(ASET))
        one, tip = self.calc_modes("a.bdf"), None
        for ranks in (1, 2, 3):
            launcher = launch_ranks("-n", ranks)
            found = json.loads(self.bough("modes", "a.bdf", "--json", launcher=launcher).stdout)["eigenvalue"]
            self.assertLess(np.abs(np.array(found) / one - 1).max(), 1e-9)
            self.bough("static", "a.bdf", "-o", "a.h5", launcher=launcher)
            with h5py.File(self.path("a.h5")) as f:
                u = f["/subcases/1/displacement"][:]
            tip = u if tip is None else tip
            self.assertLess(np.abs(u - tip).max(), 1e-10 * np.abs(tip).max())

    def test_supports_stay_in_the_analysis(self):
        self.write("s.bdf", make_deck(ASET + "SUPORT,6,12\n"))
        self.write("b.bdf", make_deck(ASET + "ASET1,12,6\n"))
        self.assertIn("leave 14 dofs", self.bough("modes", "s.bdf", "-v").stderr)
        same = self.calc_modes("b.bdf") / self.calc_modes("s.bdf")
        self.assertLess(np.abs(same - 1).max(), 1e-9)

    def test_wrong_sets_are_named(self):
        for cards, words in [("ASET1,123456,1\n", "grid 1 component 1, which is fixed at line"),
                             ("ASET1,3,9\n", "grid 9 component 3, which MPC set 5 makes dependent"),
                             ("OMIT1,3,9\n", "grid 9 component 3, which MPC set 5 makes dependent"),
                             ("ASET1,3,5\nOMIT1,3,5\n", "grid 5 component 3 is in the ASET and in the OMIT")]:
            self.write("w.bdf", make_deck(cards))
            self.fails(1, "modes", "w.bdf", says=[words], error="fe.analysis-set")
        self.write("w.bdf", make_deck("ASET1,3,77\n"))
        self.fails(1, "modes", "w.bdf", says=["77"])
        self.write("w.bdf", make_deck("ASET1,3,5\n", "SPC1,1,123,1\n"))   # it turns about x and y at grid 1
        self.fails(1, "modes", "w.bdf", says=["the dofs left out still move freely", "grid"], error="fe.omitted-singular")

    def test_the_user_is_told(self):
        self.write("a.bdf", make_deck(ASET))
        told = self.bough("modes", "a.bdf", "-v").stderr
        self.assertIn("leave 12 dofs to the analysis, 35 follow", told)
        self.assertIn("[fe.static-reduction]", told)


if __name__ == "__main__":
    unittest.main()
