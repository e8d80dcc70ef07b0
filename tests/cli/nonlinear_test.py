"""`static --nonlinear`: SOL 106 decks with large displacements, from the command line to the results file."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest, launch_ranks

BULK = ("BEGIN BULK\nMAT1,1,1.2+9,,0.\nPBAR,1,1,1.,1.-5,1.-5,2.-5\n" +
        "".join(f"GRID,{k + 1},,{k / 20:.3f},0.,0.\n" for k in range(21)) +
        "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 21)) + "SPC1,1,123456,1\nFORCE,1,21,,24000.,0.,0.,1.\n")
DECK = "SOL 106\nCEND\nSPC = 1\nLOAD = 1\n" + BULK + "PARAM,LGDISP,1\nENDDATA\n"


class Nonlinear(ProgramTest):
    def test_sol_106(self):
        self.write("a.bdf", DECK)
        result = self.bough("static", "a.bdf", "-o", "a.h5")
        self.assertIn("written: a.h5", result.stdout)
        with h5py.File(self.path("a.h5")) as f:
            tip = f["/subcases/0/displacement"][-6:]
        # P L^2 / EI = 2: Mattiasson, IJNME 17 (1981) 145.
        np.testing.assert_allclose(tip[[0, 2]], [-0.16064, 0.49346], atol=3e-4)
        self.assertAlmostEqual(-tip[4], 0.78175, delta=1e-3)

    def test_on_request(self):
        self.write("a.bdf", DECK.replace("SOL 106", "SOL 101").replace("PARAM,LGDISP,1\n", ""))
        self.write("b.bdf", DECK)
        tip = {}
        for name, options in [("a", ["--nonlinear", "--increments", "4"]), ("b", []), ("c", ["--linear"])]:
            deck = "b.bdf" if name == "c" else name + ".bdf"
            found = json.loads(self.bough("static", deck, "--json", "--full", *options).stdout)
            tip[name] = np.array(found["subcases"][0]["displacement"][-6:])
        np.testing.assert_allclose(tip["a"], tip["b"], atol=1e-9)
        self.assertAlmostEqual(tip["c"][2], 2 / 3, places=6)

    def test_listing(self):
        self.write("a.bdf", DECK.replace("LOAD = 1\n", "LOAD = 1\nDISP = ALL\nFORCE = ALL\nSPCFORCES = ALL\n"))
        self.bough("static", "a.bdf", "--f06", "a.f06")
        self.assertIn("F O R C E S", self.read("a.f06"))

    def test_buckles_by_name(self):
        # Euler's load of the cantilever: pi^2 EI / 4 = 29609.
        self.write("a.bdf", DECK.replace("24000.,0.,0.,1.", "40000.,-1.,0.,0."))
        text = self.fails(3, "static", "a.bdf", error="fe.no-equilibrium").stderr
        reached = float(text.split("beyond ")[1].split()[0])
        self.assertLess(abs(reached - 100 * 29609 / 40000), 0.5)

    def test_arc_length(self):
        """A roof of two rods under twice its limit load snaps through; a column stays on its straight path."""
        roof = ("SOL 106\nCEND\nSPC = 1\nLOAD = 1\nBEGIN BULK\nMAT1,1,1.+6,,0.\nPROD,1,1,1.\nGRID,1,,-1.,0.,0.\nGRID,2,,1.,0.,0.\n"
                "GRID,3,,0.,0.,.1\nCROD,1,1,1,3\nCROD,2,1,2,3\nSPC1,1,123456,1,2\nSPC1,1,2456,3\nFORCE,1,3,,1500.,0.,0.,-1.\n"
                "PARAM,LGDISP,1\nENDDATA\n")
        self.write("a.bdf", roof)
        self.fails(3, "static", "a.bdf", says=["--arc-length"], error="fe.no-equilibrium")
        result = self.bough("static", "a.bdf", "--arc-length", "-o", "a.h5")
        self.assertIn("[fe.limit-point]", result.stderr)
        with h5py.File(self.path("a.h5")) as f:
            y = .1 + f["/subcases/0/displacement"][14]
        length, now = np.hypot(1, .1), np.hypot(1, y)
        self.assertLess(y, -.1)
        np.testing.assert_allclose(2e6 * (length - now) / length * y / now, 1500, rtol=1e-6)
        self.write("b.bdf", DECK.replace("24000.,0.,0.,1.", "40000.,-1.,0.,0."))
        self.assertIn("[fe.unstable-equilibrium]", self.bough("static", "b.bdf", "--arc-length").stderr)

    def test_arc_length_without_a_change_of_load(self):
        """A load of zero, and a second subcase of an equal load: the state stays, as without the option."""
        two = DECK.replace("LOAD = 1\n", "SUBCASE 1\nLOAD = 1\nSUBCASE 2\nLOAD = 1\n")
        for name, deck, options in (("same", two, []),
                                    ("zero", DECK.replace("24000.,0.,0.,1.", "0.,0.,0.,1."), []),
                                    ("linear", DECK.replace("24000.,0.,0.,1.", "0.,0.,0.,1.").replace("SOL 106", "SOL 101"), ["--nonlinear"])):
            self.assertNotEqual(deck, DECK)
            self.write("a.bdf", deck)
            found = []
            for arc in ([], ["--arc-length"]):
                self.bough("static", "a.bdf", *options, *arc, "-o", "a.h5")
                with h5py.File(self.path("a.h5")) as f:
                    found.append([f[f"/subcases/{i}/displacement"][:] for i in f["/subcases"]])
            with self.subTest(name):
                np.testing.assert_allclose(found[1], found[0], rtol=1e-9, atol=1e-12)
                if name == "same":
                    np.testing.assert_allclose(found[1][1], found[1][0], rtol=1e-12, atol=1e-15)

    def test_options_of_nonlinear_solutions(self):
        """A linear solution has no increments and no path: options that change nothing are a warning."""
        self.write("a.bdf", DECK)
        for options, name in ((["--arc-length"], "--arc-length"), (["--increments", "10"], "--increments"),
                              (["--arc-length", "--increments", "4"], "--arc-length and --increments")):
            self.assertIn(f"found {name}, without effect", self.bough("static", "a.bdf", "--linear", *options).stderr)
            self.assertNotIn("cli.nonlinear-option", self.bough("static", "a.bdf", "--nonlinear", *options).stderr)
        self.write("b.bdf", DECK.replace("SOL 106", "SOL 101"))
        self.assertIn("[cli.nonlinear-option]", self.bough("static", "b.bdf", "--arc-length").stderr)

    def test_refusals(self):
        self.write("a.bdf", DECK.replace("PARAM,LGDISP,1\n", ""))
        self.fails(1, "static", "a.bdf", says=["--nonlinear", "--linear"], error="cli.nonlinear-static")
        self.write("m.bdf", DECK.replace("ENDDATA", "MATS1,1,,PLASTIC,1.+7,1,1,1.+6\nENDDATA"))
        self.fails(1, "static", "m.bdf", says=["MATS1"])
        self.write("b.bdf", DECK)
        self.fails(1, "static", "b.bdf", "--linear", "--nonlinear", error="cli.nonlinear-static")
        self.fails(1, "static", "b.bdf", "--grid-forces", "all", error="cli.nonlinear-output")
        self.write("s.bdf", DECK.replace("LOAD = 1\n", "SUBCASE 1\nLOAD = 1\nSUBCASE 2\nLOAD = 1\nSUBCOM 3\nSUBSEQ = 1.,1.\n"))
        self.fails(1, "static", "s.bdf", error="cli.nonlinear-combination")
        ranks = self.bough("static", "b.bdf", launcher=launch_ranks("-n", 2), code=1)
        self.assertIn("[cli.nonlinear-ranks]", ranks.stderr)
        self.write("r.bdf", DECK.replace("FORCE,1,21,,24000.,0.,0.,1.", "RFORCE,1,1,,1.,0.,0.,1.\nCONM2,9,21,,1."))
        self.fails(1, "static", "r.bdf", error="fe.nonlinear-load")
        self.write("o.bdf", DECK.replace("ENDDATA", "ASET1,123456,21\nENDDATA"))
        self.fails(1, "static", "o.bdf", error="fe.nonlinear-model")
        self.write("p.bdf", DECK.replace("ENDDATA", "PARAM,FOLLOWK,YES\nGRID,31,,1.,.1,0.\nGRID,32,,1.1,.1,0.\nGRID,33,,1.1,0.,0.\n"
                                         "CQUAD4,99,9,21,33,32,31\nPSHELL,9,1,.01,1,,1\nPLOAD2,1,10.,99\nENDDATA"))
        self.assertNotIn("dead-load", self.bough("static", "p.bdf").stderr)  # it follows its face

    def test_ties_that_turn(self):
        """Whole grids follow the mean of others exactly; single components are linear equations."""
        for rbe3, is_linear in (("31,123,1.,123456,20,21", False), ("31,123456,1.,123456,20,21", False),
                                ("31,1234,1.,123456,20,21", True), ("31,123,1.,12345,20,21", True)):
            self.write("a.bdf", DECK.replace("ENDDATA", f"GRID,31,,1.,0.,.1\nRBE3,9,,{rbe3}\nENDDATA"))
            self.assertEqual("[fe.nonlinear-link]" in self.bough("static", "a.bdf").stderr, is_linear, rbe3)


if __name__ == "__main__":
    unittest.main()
