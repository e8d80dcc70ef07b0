"""Responses of beams and large masses: SciPy on the matrices that `bough matrices` writes, `static` at 0 Hz."""
import json
import unittest

import h5py
import numpy as np
from scipy.sparse import csr_matrix

from deck_response_case import FRAME, DeckResponse


class Structures(DeckResponse):
    def direct(self, deck, hz, load, g):
        """SciPy on K, M, B of the deck, all in basic; structural damping from a second deck without GE."""
        def matrices(text):
            self.write("m.bdf", text)
            self.bough("matrices", "m.bdf", "-o", "m.h5")
            with h5py.File(self.path("m.h5")) as f:
                get = lambda name: csr_matrix((f[name]["data"][()], f[name]["indices"][()], f[name]["indptr"][()]),
                                              shape=f[name]["shape"][()]).toarray()
                return get("K"), get("M"), get("B"), f["dof_map"][()]
        K, M, B, dofs = matrices(deck)
        # MAT1 1 alone has GE: its bars' share of K by a deck in which they are twice as stiff.
        K_ge = matrices(deck.replace("MAT1,1,7.+10", "MAT1,1,14.+10"))[0] - K
        free = dofs[:, 0] != 1
        u = []
        for f in hz:
            w = 2 * np.pi * f
            Z = K * (1 + 1j * g) + .05j * K_ge + 1j * w * B - w * w * M
            x = np.zeros(len(dofs), complex)
            x[free] = np.linalg.solve(Z[np.ix_(free, free)], load(f, w)[free])
            u.append((x, Z @ x - load(f, w)))
        return dofs, u

    def load(self, dofs):
        F = np.zeros(len(dofs), complex)
        def put(g, c, f):
            F[(dofs[:, 0] == g) & (dofs[:, 1] == c)] += f
        put(4, 3, 2.5)
        put(2, 2, -1.0)
        put(5, 1, 3.0)
        put(5, 3, 3.0)
        return F

    def test_frame(self):
        """All modes against SciPy; then few modes with residual vectors; a grid in axes of its own."""
        r = self.solve("frequency", FRAME.format(modes=30, cd="", v="0.,0.,1."))[1]
        with_cd = self.solve("frequency", FRAME.format(modes=30, cd="7", v="2.,2.,1."))[1]
        self.write("m.bdf", FRAME.format(modes=30, cd="", v="0.,0.,1."))
        self.bough("matrices", "m.bdf", "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            dofs = f["dof_map"][()]
        F = self.load(dofs)
        def load(f, w):
            amplitude = 1 + f / 100 if f < 100 else 2.0
            return F * amplitude * np.exp(1j * (np.radians(10 + 20 * min(f, 200) / 100 + 30) - w * .01))
        dofs, exact = self.direct(FRAME.format(modes=30, cd="", v="0.,0.,1."), r["x"], load, .02)
        for i, (u, reaction) in enumerate(exact):
            found = np.array([r["displacement"][tuple(dof)][i] for dof in dofs])
            self.near(found, u, 1e-8)
            held = [row for row, dof in enumerate(dofs) if dof[0] == 1]
            self.near([r["spc_force"][tuple(dofs[row])][i] for row in held], reaction[held], 1e-8)
        R = np.column_stack([np.array([1, 2, 2]) / 3, np.cross([2, -2, 1], [1, 2, 2]) / 9 * -1, np.array([2, -2, 1]) / 3])
        R[:, 1] = np.cross(R[:, 2], R[:, 0])
        for half in (1, 4):
            cd = np.array([with_cd["displacement"][3, half + c] for c in range(3)])
            basic = np.array([r["displacement"][3, half + c] for c in range(3)])
            self.near(R @ cd, basic, 1e-8)
        few = self.solve("frequency", FRAME.format(modes=6, cd="", v="0.,0.,1."))[1]
        low = r["x"] < few["modes"]["frequency_hz"][4] / 2
        self.near(few["displacement"][5, 1][low], r["displacement"][5, 1][low], 1e-3)

    def test_cantilever(self):
        """Euler-Bernoulli: w(L) = F (sin b cosh b - cos b sinh b) / (EI β³ (1 + cos b cosh b)), b = βL."""
        n, L, E, A, inertia, rho = 40, 2.0, 7e10, 1e-4, 1e-8, 2700.0
        grids = "".join(f"GRID,{i + 1},,{L * i / n},0.,0.\n" for i in range(n + 1))
        bars = "".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0.\n" for i in range(n))
        deck = ("SOL 111\nCEND\nSPC = 1\nMETHOD = 1\nDLOAD = 9\nFREQUENCY = 5\nSET 3 = 41\nDISPLACEMENT = 3\nBEGIN BULK\n"
                "PARAM,COUPMASS,1\nEIGRL,1,,,5\nFREQ,5,1.,5.,20.,60.,90.\nRLOAD1,9,10,,,1.\nDAREA,10,41,2,3.\n"
                f"MAT1,1,{E},,.3,{rho}\nPBAR,1,1,{A},{inertia},{inertia},{inertia}\n"
                f"SPC1,1,123456,1\nSPC1,1,1345,2,THRU,41\n{grids}{bars}ENDDATA\n").replace("1e-08", "1.-8").replace(
                    "0.0001", "1.-4").replace("70000000000.0", "7.+10")
        r = self.solve("frequency", deck)[1]
        w = 2 * np.pi * r["x"]
        beta = (rho * A * w**2 / (E * inertia))**.25
        b = beta * L
        exact = 3 * (np.sin(b) * np.cosh(b) - np.cos(b) * np.sinh(b)) / (E * inertia * beta**3 * (1 + np.cos(b) * np.cosh(b)))
        for found, one in zip(r["displacement"][41, 2], exact):
            self.assertLess(abs(found / one - 1), 2e-5)

    def test_free_body(self):
        """A free beam moves as a rigid body at low frequency, and its inertia and strain agree with all modes."""
        deck = ("SOL 111\nCEND\nMETHOD = 1\nDLOAD = 9\nFREQUENCY = 5\nDISPLACEMENT = ALL\nACCELERATION = ALL\nBEGIN BULK\n"
                "EIGRL,1,,,{modes}\nPARAM,G,.02\nFREQ,5,.01,2.,9.\nRLOAD1,9,10,,,1.\nDAREA,10,3,2,3.\nMAT1,1,7.+10,,.3,2700.\n"
                "PARAM,COUPMASS,1\nPBAR,1,1,1.-4,1.-8,2.-8,1.-8\n"
                + "".join(f"GRID,{i + 1},,{.5 * i},0.,{.1 * i}\n" for i in range(5))
                + "".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0.\n" for i in range(4)) + "ENDDATA\n")
        few = self.solve("frequency", deck.format(modes=8))[1]
        everything = self.solve("frequency", deck.format(modes=30))[1]
        self.near(few["displacement"][5, 2], everything["displacement"][5, 2], 1e-6)
        mass = 2700e-4 * 4 * np.hypot(.5, .1)
        self.near(few["acceleration"][3, 2][:1], 3 / mass, 1e-4)
        cut = self.solve("frequency", deck.format(modes=8).replace("EIGRL,1,,,8", "EIGRL,1,.5,,2"))[1]
        self.assertGreater(cut["modes"]["frequency_hz"].min(), .5)

    def test_static_limit(self):
        """At 0 Hz the response with one mode is that of SOL 101."""
        deck = FRAME.format(modes=1, cd="7", v="2.,2.,1.").replace("FREQ1,5,3.,17.3,9", "FREQ,5,0.").replace("PARAM,G,.02\n", "").replace(
            "2700.,,,.05", "2700.").replace("RLOAD2,9,10,.01,30.,3,4", "RLOAD1,9,11,,,1.").replace("DAREA,10", "DAREA,11").replace(
            "FORCE,10", "FORCE,11")
        r = self.solve("frequency", deck)[1]
        with open(self.path("s.bdf"), "w") as f:
            f.write(deck.replace("SOL 111", "SOL 101").replace("DLOAD = 9", "LOAD = 11").replace(
                "DAREA,11,4,3,2.5", "FORCE,11,4,0,2.5,0.,0.,1.").replace("DAREA,11,2,2,-1.", "FORCE,11,2,0,-1.,0.,1.,0."))
        static = json.loads(self.bough("static", "s.bdf", "--cd", "--json", "--full").stdout)["subcases"][0]
        u = np.array(static["displacement"])
        found = np.array([r["displacement"][tuple(dof)][0] for dof in static["dof_map"]])
        self.near(found, u, 1e-10)


# A chain of eight masses of 0.01 on a large one, which a force drives: the classical way to give a base its motion.
LARGE_MASS = """SOL 111
CEND
SPC = 9
METHOD = 3
DLOAD = 1
FREQUENCY = 1
ACCELERATION = ALL
BEGIN BULK
SPOINT,1,THRU,9
{chain}CMASS2,60,{mass},1,0
DAREA,5,1,0,{force}
RLOAD1,1,5,,,7
TABLED1,7
,0.,1.,1000.,1.,ENDT
EIGRL,3,,,{modes}
FREQ1,1,5.,1.,25
GRID,99,,0.,0.,0.
SPC1,9,123456,99
ENDDATA
"""


class LargeMass(DeckResponse):
    def test_base_by_a_large_mass(self):
        """Against the dense equations: K, C, M of nine dofs, with and without residual vectors."""
        n, k, c, m = 9, 1000.0, .01, .01
        chain = "".join(f"CELAS2,{i},{k},{i},0,{i + 1},0\nCDAMP2,{i + 40},{c},{i},0,{i + 1},0\nCMASS2,{i + 20},{m},{i + 1},0\n"
                        for i in range(1, n))
        for mass in [1e4, 1e6, 1e8, 1e10]:
            K = np.zeros((n, n))
            for i in range(n - 1):
                K[i:i + 2, i:i + 2] += k * np.array([[1, -1], [-1, 1]])
            M = np.diag([mass] + [m] * (n - 1))
            for modes, tolerance in [(4, 2e-3), (9, 1e-6)]:
                with self.subTest(mass=mass, modes=modes):
                    deck = LARGE_MASS.format(chain=chain, mass=mass, force=3 * mass, modes=modes)
                    r = self.solve("frequency", deck)[1]
                    for i, hz in enumerate(r["x"]):
                        w = 2 * np.pi * hz
                        u = np.linalg.solve(K + 1j * w * K * c / k - w * w * M, np.eye(n)[0] * 3 * mass)
                        found = np.array([r["acceleration"][p, 0][i] for p in range(1, n + 1)])
                        self.near(found, -w * w * u, tolerance)


if __name__ == "__main__":
    unittest.main()
