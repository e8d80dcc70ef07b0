"""Dampers from the deck to the body: closed form of one mass, a chain with NumPy, what modes and matrices say."""
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from support import ProgramTest

ONE = """SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
EIGRL,1,,,1
GRID,1,,0.,0.,0.
CONM2,1,1,,4.0
CELAS2,2,36.0,1,1
CDAMP2,3,2.4,1,1
SPC1,1,23456,1
ENDDATA
"""

# Three masses along (1, 2, 2)/3, which move along that line only: springs and dampers of every kind between them.
CHAIN = """SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
EIGRL,1,,,3
CORD2R,7,,0.,0.,0.,2.,-2.,1.
,1.,2.,2.
GRID,1,,0.,0.,0.,7
GRID,2,,1.,2.,2.,7
GRID,3,,2.,4.,4.,7
CONM2,11,1,,1.0
CONM2,12,2,,2.0
CONM2,13,3,,3.0
CELAS2,21,100.0,1,1
CELAS2,22,200.0,1,1,2,1
PBUSH1D,5,300.0,0.7
CBUSH1D,23,5,2,3
PVISC,6,1.5,9.0
CVISC,24,6,1,2
PDAMP,7,0.4
CDAMP1,25,7,1,1
PBUSH,8,B,0.9
CBUSH,26,8,1,3,,,,7
SPC1,1,23456,1,2,3
ENDDATA
"""


class Dampers(ProgramTest):
    def reduce(self, deck, number, ratio=0.0):
        self.write("m.bdf", deck)
        self.write("m.toml", f'[body]\nname = "m"\ndeck = "m.bdf"\n[body.modes]\nnumber = {number}\n[body.damping]\n'
                             f'ratio = {ratio}\n[body.output]\nfull = true\n')
        self.bough("reduce", "m.toml", "-o", "m.h5")

    def test_one_mass_decays_as_the_closed_form(self):
        self.reduce(ONE, 1, 0.01)
        with h5py.File(self.path("m.h5")) as f:
            self.assertAlmostEqual(f["/modal/damping"][0, 0], 2 * 0.01 * 3 + 2.4 / 4, places=12)  # 2 zeta omega + c/m
        self.reduce(ONE, 1)
        self.write("s.toml", '[[body]]\nname = "m"\nfile = "m.h5"\neta = [1.0]\n[[hinge]]\nname = "root"\ntype = "fixed"\n'
                             'child = "m"\n[[sensor]]\nname = "x"\ntype = "deflection"\nbody = "m"\nnode = 1\n'
                             '[simulation]\nduration = 5.0\noutput_step = 0.05\n')
        self.bough("run", "s.toml", "-o", "s.h5")
        with h5py.File(self.path("s.h5")) as f:
            t, x = f["/time"][:], f["/sensors/x"][:, 0]
        delta, omega = 0.3, np.sqrt(9 - 0.09)  # c/(2m) and the damped frequency
        exact = np.exp(-delta * t) * (np.cos(omega * t) + delta / omega * np.sin(omega * t))
        self.assertLess(np.abs(x / x[0] - exact).max(), 1e-6)

    def test_chain_of_dampers_projects_as_numpy_does(self):
        self.reduce(CHAIN, 3)
        B = np.array([[1.5 + 0.4 + 0.9, -1.5, -0.9], [-1.5, 1.5 + 0.7, -0.7], [-0.9, -0.7, 0.7 + 0.9]])
        K = np.array([[300.0, -200, 0], [-200, 500, -300], [0, -300, 300]])
        lam, V = eigh(K, np.diag([1.0, 2.0, 3.0]))
        with h5py.File(self.path("m.h5")) as f:
            D, eigenvalue, phi = f["/modal/damping"][:], f["/modes/eigenvalue"][:], f["/full/phi"][:]
        self.assertLess(np.abs(eigenvalue / lam - 1).max(), 1e-10)
        line = np.array([1, 2, 2]) / 3
        signs = np.sign([line @ phi[12:15, j] * V[2, j] for j in range(3)])
        expected = signs[:, None] * (V.T @ B @ V) * signs
        self.assertGreater(np.abs(expected[0, 1]), 0.05)   # it couples modes
        self.assertLess(np.abs(D - expected).max(), 1e-10)

        # Damping from the matrices before constraints.
        self.bough("matrices", "m.bdf", "-o", "k.h5")
        with h5py.File(self.path("k.h5")) as f:
            B_g = csr_matrix((f["/B/data"], f["/B/indices"], f["/B/indptr"]), shape=f["/B/shape"]).toarray()
        self.assertLess(np.abs(B_g - B_g.T).max(), 1e-15)
        self.assertLess(np.abs(phi.T @ B_g @ phi - D).max(), 1e-12)
        self.assertGreater(np.abs(B_g[3:6, 3:6]).max(), 1)   # the torsional part of CVISC
        self.assertIn("/B", self.bough("info", "k.h5").stdout)
        self.assertIn("matrices K M B on 18 dofs", self.bough("check", "k.h5").stdout)

    def test_modes_say_that_dampers_do_not_act(self):
        self.write("m.bdf", ONE)
        self.assertIn("[fe.damping-unused]", self.bough("modes", "m.bdf", "-v").stderr)
        self.write("n.bdf", ONE.replace("CDAMP2,3,2.4,1,1\n", ""))
        self.assertNotIn("[fe.damping-unused]", self.bough("modes", "n.bdf", "-v").stderr)
        self.bough("matrices", "n.bdf", "-o", "n.h5")
        with h5py.File(self.path("n.h5")) as f:
            self.assertNotIn("B", f)


class Plotel(ProgramTest):
    def test_lines_are_drawn_and_carry_nothing(self):
        self.write("m.bdf", CHAIN)
        self.write("p.bdf", CHAIN.replace("ENDDATA", "PLOTEL,31,1,3\nENDDATA"))
        found = []
        for name in ["m", "p"]:
            self.bough("matrices", f"{name}.bdf", "-o", f"{name}.h5")
            with h5py.File(self.path(f"{name}.h5")) as f:
                lines = f["/mesh/elements/line2"]
                found.append((f["/K/data"][:], lines["connectivity"][:], list(lines["id"])))
        self.assertTrue(np.array_equal(found[0][0], found[1][0]))
        self.assertEqual(len(found[1][1]), len(found[0][1]) + 1)
        self.assertEqual(list(found[1][1][found[1][2].index(31)]), [0, 2])
        self.bough("modes", "p.bdf", "--vtu", "p.vtu")
        self.write("q.bdf", CHAIN.replace("ENDDATA", "PLOTEL,31,1,9\nENDDATA"))
        self.fails(1, "modes", "q.bdf", says=["PLOTEL 31 refers to grid 9"], error="fe.missing-grid")


if __name__ == "__main__":
    unittest.main()
