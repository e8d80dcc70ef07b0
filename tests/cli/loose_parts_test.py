"""A deck in parts that nothing joins: `check`, `reduce` and `init` name the parts instead of the supports."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest
from decks import begin, grids

# Bars 1-2-3 and 4-5-6 along x; grid 4 is on grid 3 and was never merged with it.
BARS = begin(103, "SPC = 1", "METHOD = 1") + """EIGRL,1,,,8
SPC1,1,123456,1
PBAR,1,1,1.-4,1.-8,1.-8,2.-8
MAT1,1,7.+10,,.3,2700.
""" + grids(*((x, 0, 0) for x in (0, 1, 2, 2, 3, 4))) + """CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
CBAR,3,1,4,5,0.,1.,0.
CBAR,4,1,5,6,0.,1.,0.
ENDDATA
"""
PARTS = ("2 parts; part 2: 3 grids, 2 elements, grids 4 to 6, touches nothing; its grid 4 lies on grid 3 of part 1; "
         "merge them")


class LooseParts(ProgramTest):
    def test_check_counts_the_parts(self):
        self.write("bars.bdf", BARS)
        run = self.bough("check", "bars.bdf")
        self.assertIn(PARTS, run.stderr)
        self.assertIn("[fe.loose-parts]", run.stderr)
        self.assertIn("connected parts, by grids and scalar points: 2 (3, 3)", run.stdout)
        parts = json.loads(self.bough("check", "bars.bdf", "--json").stdout)["geometry"]["parts"]
        self.assertEqual([(p["points"], p["first"], p["last"], p["elements"], p["held"]) for p in parts],
                         [(3, 1, 3, 2, True), (3, 4, 6, 2, False)])

    def test_coincident_grids_that_are_joined_are_no_finding(self):
        self.write("bars.bdf", BARS.replace("ENDDATA", "RBE2,9,3,123456,4\nENDDATA"))
        run = self.bough("check", "bars.bdf")
        self.assertNotIn("fe.loose-parts", run.stderr)
        self.assertIn("coincident grids: 1 (3 and 4)", run.stdout)
        self.assertIn("scalar points: 1 (6)", run.stdout)

    def test_reduce_names_the_parts_first(self):
        self.write("bars.bdf", BARS)
        for free in ([], ["--free"]):
            run = self.fails(1, "reduce", "bars.bdf", "--modes", "3", *free, error="reduce.mechanism")
            first = next(line for line in run.stderr.splitlines() if "error:" in line)
            self.assertIn(PARTS, first)
            self.assertNotIn("SPC set", run.stderr)

    def test_init_writes_a_free_frame_where_nothing_holds_the_deck(self):
        for name, deck, frame in [("clamped", BARS, "fixed"),
                                  ("bare", BARS.replace("SPC = 1\n", ""), "free"),
                                  ("rotations", BARS.replace("SPC1,1,123456,1", "SPC1,1,456,1,THRU,6"), "free"),
                                  ("permanent", BARS.replace("SPC = 1\n", "").replace("GRID,6,,4.,0.,0.",
                                                                                       "GRID,6,,4.,0.,0.,,4"), "free")]:
            with self.subTest(name):
                self.write(f"{name}.bdf", deck)
                self.bough("init", f"{name}.bdf")
                with open(self.path(f"{name}.toml")) as f:
                    self.assertIn(f'frame = "{frame}"', f.read())


class ShellAtHinges(ProgramTest):
    def test_a_turn_about_the_normal_has_no_residual_vector(self):
        """A free plate of shells with two interface grids, from the files of `init`: the turn of a grid about the normal
        moves no mass, its residual vectors would leave the solver a mass of 1e-13 of the body's."""
        grids = "".join(f"GRID,{1 + i + 9 * j},,{.15 * i},{.2 * j},0.\n" for j in range(3) for i in range(9))
        shells = "".join(f"CQUAD4,{1 + i + 8 * j},1,{1 + i + 9 * j},{2 + i + 9 * j},{11 + i + 9 * j},{10 + i + 9 * j}\n"
                         for j in range(2) for i in range(8))
        self.write("plate.bdf", "SOL 103\nCEND\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,12\nPSHELL,1,1,.004,1,,1\n"
                   "MAT1,1,7.+10,,.3,2700.\n" + grids + shells + "ENDDATA\n")
        self.bough("init", "plate.bdf", "--hinge", 10)
        text = self.read("plate.toml")
        self.assertIn("interface = [10]", text)
        self.write("plate.toml", text.replace("interface = [10]", "interface = [10, 18]"))
        printed = self.bough("reduce", "plate.toml").stderr
        self.assertIn("[reduce.residual-massless]", printed)
        self.assertIn("node10 6 (100 %), node18 6 (100 %)", printed)
        self.write("plate-run.toml", self.read("plate-run.toml").replace("duration = 1.0", "duration = 0.05"))
        self.bough("run", "plate-run.toml")

    def test_a_free_body_with_a_pinned_mass(self):
        """AUTOSPC holds rotations of the pinned end: Craig-Bampton finds the six motions as normal modes do."""
        line = grids(*((.15 * i, 0, 0) for i in range(7))) + "".join(f"CBAR,{i},1,{i},{i + 1},.1,.2,1.\n" for i in range(1, 7))
        self.write("d.bdf", begin(103) + "PARAM,COUPMASS,1\nMAT1,1,7.+10,,.3,2700.\nPBAR,1,1,2.-4,3.-9,5.-9,4.-9\n" + line
                   + "GRID,80,,.45,0.,.2\nCBAR,800,1,4,80,1.,.1,0.\n,,45\nCONM2,801,80,,.2\n,1.-4,,1.-4,,,1.-4\n"
                   "CONM2,900,7,,.5\n,1.-4,,2.-4,,,3.-4\nENDDATA\n")
        found = []
        for modes in ('basis = "normal"\nnumber = 5', 'basis = "craig-bampton"\nnumber = 25'):
            self.write("b.toml", f'[body]\nname = "b"\ndeck = "d.bdf"\nframe = "free"\ninterface = [1]\n[body.modes]\n{modes}\n')
            self.bough("reduce", "b.toml", "-o", "b.h5")
            with h5py.File(self.path("b.h5")) as f:
                found.append(f["modes/frequency_hz"][:5])
        np.testing.assert_allclose(found[1], found[0], rtol=2e-4)


if __name__ == "__main__":
    unittest.main()
