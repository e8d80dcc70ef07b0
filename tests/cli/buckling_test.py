"""modes --buckling: the pairs of subcases of SOL 105, the range of EIGRL, temperatures, torsion that is not there."""
import json
import math
import unittest

from support import ProgramTest


COLUMN = """SOL 105
CEND
%s
BEGIN BULK
MAT1,1,7.+10,,.3,2700.,1.2-5,20.
PBAR,1,1,1.-4,1.-8,5.-9,%s
%s
SPC1,1,246,1,THRU,17
SPC1,1,13,1
SPC1,1,3,17
FORCE,10,17,,-1.,1.,0.,0.
LOAD,30,1.,3.,10
TEMPD,5,21.
"""
EULER = math.pi ** 2 * 7e10 * 5e-9 / 4


def write_column(control, bulk="", J="1.-8"):
    lines = ["GRID,%d,,%.6f,0.,0." % (i + 1, 0.125 * i) for i in range(17)]
    lines += ["CBAR,%d,1,%d,%d,0.,1.,0." % (i + 1, i + 1, i + 2) for i in range(16)]
    return COLUMN % (control, J, bulk) + "\n".join(lines) + "\nENDDATA\n"


class BucklingCases(ProgramTest):
    def factors(self, deck, *options):
        self.write("column.bdf", deck)
        return json.loads(self.bough("modes", "column.bdf", "--buckling", "--json", *options).stdout)

    def test_two_pairs(self):
        deck = write_column("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nLOAD = 30\n"
                            "SUBCASE 3\nSTATSUB = 1\nMETHOD = 7\nSUBCASE 4\nSTATSUB = 2\nMETHOD = 8\n",
                            "EIGRL,7,,,2\nEIGRL,8,,,1")
        result = self.factors(deck)
        self.assertEqual([s["subcase"] for s in result["subcases"]], [3, 4])
        first, second = (s["load_factor"] for s in result["subcases"])
        self.assertEqual((len(first), len(second)), (2, 1))
        self.assertAlmostEqual(first[0] / EULER, 1, delta=1e-4)
        self.assertAlmostEqual(second[0] / EULER, 1 / 3, delta=1e-4)
        self.assertAlmostEqual(self.factors(deck, "--subcase", "4")["load_factor"][0] / EULER, 1 / 3, delta=1e-4)
        text = self.bough("modes", "column.bdf", "--buckling").stdout
        self.assertIn("load factors of LOAD 30 (subcase 2)", text)

    def test_constraints_of_the_buckling_subcase(self):
        # Antisymmetric about the middle: held there, the column buckles in two half waves.
        deck = write_column("SUBCASE 1\nSPC = 1\nLOAD = 10\nSUBCASE 2\nSPC = 2\nMETHOD = 7\n",
                            "EIGRL,7,,,1\nSPCADD,2,1,3\nSPC1,3,3,9")
        self.assertAlmostEqual(self.factors(deck)["load_factor"][0] / EULER, 4, delta=1e-3)

    def test_range(self):
        deck = write_column("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nMETHOD = 7\n", "EIGRL,7,%f,,2" % (2 * EULER))
        found = self.factors(deck)["load_factor"]
        self.assertEqual(len(found), 2)
        self.assertAlmostEqual(found[0] / EULER, 4, delta=1e-3)
        deck = write_column("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nMETHOD = 7\n",
                            "EIGB,7,INV,0.,%f,4,9" % (5 * EULER))
        self.assertEqual(len(self.factors(deck)["load_factor"]), 2)

    def test_temperature(self):
        deck = write_column("SPC = 4\nSUBCASE 1\nTEMP(LOAD) = 5\nSUBCASE 2\nMETHOD = 7\n",
                            "EIGRL,7,,,1\nSPCADD,4,1,3\nSPC1,3,1,17")
        expected = math.pi ** 2 * 5e-9 / (1e-4 * 4 * 1.2e-5)
        self.assertAlmostEqual(self.factors(deck)["load_factor"][0] / expected, 1, delta=1e-4)
        self.assertIn("load factors of TEMPERATURE 5 (subcase 1)", self.bough("modes", "column.bdf", "--buckling").stdout)

    def test_no_torsion_in_skew_axes(self):
        # J = 0: AUTOSPC holds a component that is not the axis; the twist that comes with bending does no work.
        lines = ["GRID,%d,,%.9f,%.9f,%.9f" % (i + 1, 0.1 * i, 0.2 * i, 0.2 * i) for i in range(11)]
        lines += ["CBAR,%d,1,%d,%d,0.,1.,-1." % (i + 1, i + 1, i + 2) for i in range(10)]
        deck = ("SOL 5\nCEND\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nMETHOD = 7\nBEGIN BULK\nEIGRL,7,,,1\nMAT1,1,1.+7,,.3\n"
                "PBAR,1,1,.5,104.,.04\nSPC1,1,123456,1\nFORCE,10,11,,-1.,.333333333,.666666667,.666666667\n"
                "GRDSET,,,,,,,\n" + "\n".join(lines) + "\nENDDATA\n").replace("SUBCASE 1", "SPC = 1\nSUBCASE 1")
        found = self.factors(deck)["load_factor"][0]
        self.assertAlmostEqual(found / (math.pi ** 2 * 1e7 * .04 / (4 * 9)), 1, delta=2e-3)

    def test_note_without_the_flag(self):
        self.write("column.bdf", write_column("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nMETHOD = 7\n", "EIGRL,7,,,1"))
        run = self.bough("modes", "column.bdf", "--max-hz", "1")
        self.assertIn("cli.buckling-deck", run.stderr)


if __name__ == "__main__":
    unittest.main()
