"""One beam in the deck of COSMIC Nastran and in that of MSC: the same modes; what only COSMIC has is named."""
import json
import unittest

from support import ProgramTest
from decks import begin, grids

COSMIC = """NASTRAN BUFFSIZE=1000, CONFIG=4
ID BEAM, MODES
APP DISP
SOL 3,0
TIME 5
DIAG 14
CEND
TITLE = BEAM
SPC = 1
METHOD = 1
OUTPUT
DISP = ALL
BEGIN BULK
$ FIELD 9 OF CBAR: 1, THE VECTOR IN FIELDS 6 TO 8; 2, THE GRID IN FIELD 6. BAROR FOR THE FIRST BAR.
BAROR   X       1                       0.      1.      0.      1
EIGR    1       {method:<8}.1      100.    6       3                       +E
+E      MASS
GRDSET  X                                               345
PARAM   COUPMASS1
PBAR    1       1       1.-3    2.-7    2.-7    4.-7
MAT1    1       7.+10           .3      2700.
CBAR    1               1       2
CBAR    2       1       2       3       0.      1.      0.      1
CBAR    3       1       3       4       99                      2
GRID    1               0.      0.      0.
GRID    2               1.      0.      0.
GRID    3               2.      0.      0.
GRID    4               3.      0.      0.
GRID    99              1.      5.      0.              123456
SEQGP   1       4       4       1
SPC1    1       123456  1
ENDDATA
"""
MSC = """SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
PARAM,COUPMASS,1
EIGRL,1,.1,100.,3
GRDSET,,,,,,,345
PBAR,1,1,1.-3,2.-7,2.-7,4.-7
MAT1,1,7.+10,,.3,2700.
CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
CBAR,3,1,3,4,99
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
GRID,4,,3.,0.,0.
GRID,99,,1.,5.,0.,,123456
SPC1,1,123456,1
ENDDATA
"""
ONLY_COSMIC = ["CTWIST", "CTORDRG", "CTRAPRG"]
# A plate of one quadrilateral and two triangles, and a block on it, in the cards of both programs.
PLATE = begin(103, "SPC = 1", "METHOD = 1") + """EIGRL,1,,,6
MAT1,1,7.+10,,.3,2700.
""" + grids((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)) + grids(
    (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1), first=11) + "SPC1,1,123456,1,4\n"
OLD_ELEMENTS = """CQUAD2,1,7,1,2,3,4
PQUAD2,7,1,.05,3.
CTRIA1,2,7,2,5,6
PTRIA1,7,1,.05,1,1.0416666666667-5,1,.05,3.
CTRIA2,3,7,2,6,3
PTRIA2,7,1,.05,3.
CHEXA1,4,1,1,2,3,4,11,12,+
+,13,14
"""
NEW_ELEMENTS = """CQUAD4,1,7,1,2,3,4
PSHELL,7,1,.05,1,,1,1.,3.
CTRIA3,2,7,2,5,6
CTRIA3,3,7,2,6,3
CHEXA,4,1,1,2,3,4,11,12,+
+,13,14
PSOLID,1,1
"""


class Dialects(ProgramTest):
    def find_modes(self, name, text):
        self.write(name, text)
        result = self.bough("modes", name, "--json")
        return json.loads(result.stdout)["eigenvalue"], result.stderr

    def test_same_modes(self):
        expected, _ = self.find_modes("msc.bdf", MSC)
        self.assertEqual(len(expected), 3)
        for method in ("FEER", "INV", "GIV"):
            found, said = self.find_modes("cosmic.dat", COSMIC.format(method=method))
            for a, b in zip(found, expected, strict=True):
                self.assertAlmostEqual(a / b, 1, delta=1e-12)
            self.assertIn("SEQGP is not read", said)

    def test_subcases_of_solution_3(self):
        """Each with its METHOD, as in SOL 103."""
        cases = "SUBCASE 1\nMETHOD = 1\nSUBCASE 2\nMETHOD = 2\nBEGIN BULK\nEIGRL,2,,,1"
        text = MSC.replace("METHOD = 1\nBEGIN BULK", cases)
        for solution in ("103", "3,0"):
            self.write("two.bdf", text.replace("SOL 103", f"SOL {solution}"))
            self.assertEqual(self.bough("modes", "two.bdf").stdout.count("Sturm count"), 2, solution)

    def test_elements_of_cosmic_alone_are_errors(self):
        for card in ONLY_COSMIC:
            self.write("old.dat", MSC.replace("ENDDATA", f"{card:<8}50      1       1       2       3       4\nENDDATA"))
            self.fails(1, "modes", "old.dat", says=[f"{card} is not supported and carries stiffness"],
                       error="deck.unsupported-card")
        self.write("old.dat", MSC.replace("ENDDATA", "MPCAX   50      1       2       3\nENDDATA"))
        self.fails(1, "modes", "old.dat", says=["MPCAX is not supported and carries a constraint"])

    def test_plates_and_solids_of_cosmic_are_those_of_today(self):
        expected, _ = self.find_modes("new.bdf", PLATE + NEW_ELEMENTS + "ENDDATA\n")
        found, said = self.find_modes("old.bdf", PLATE + OLD_ELEMENTS + "ENDDATA\n")
        self.assertEqual(len(found), 6)
        for a, b in zip(found, expected, strict=True):
            self.assertAlmostEqual(a / b, 1, delta=1e-9)
        self.assertIn("1 CHEXA1 as CHEXA, 1 CQUAD2 as CQUAD4, 1 CTRIA1 as CTRIA3, 1 CTRIA2 as CTRIA3", said)
        self.assertIn("[deck.old-element]", said)

    def test_design_variables_of_solution_200(self):
        """The deck with the values of the variables written into its cards."""
        design = "DESVAR,1,A,2.\nDVPREL1,1,PBAR,1,I1\n+,1,2.-7\nDVMREL1,2,MAT1,1,RHO,,,700.\n+,1,1000.\nENDDATA"
        bar = "PBAR,1,1,1.-3,2.-7,2.-7"
        expected, _ = self.find_modes("written.bdf", MSC.replace(bar, "PBAR,1,1,1.-3,4.-7,2.-7"))
        text = MSC.replace(bar, "PBAR,1,1,1.-3,9.-7,2.-7").replace(",2700.", ",1.")
        found, said = self.find_modes("design.bdf", text.replace("SOL 103", "SOL 200").replace("ENDDATA", design))
        for a, b in zip(found, expected, strict=True):
            self.assertAlmostEqual(a / b, 1, delta=1e-12)
        self.assertIn("PBAR 1 I1 = 4.-7 (was 9.-7)", said)

    def test_export_keeps_the_sets_of_component_modes(self):
        self.write("q.bdf", MSC.replace("ENDDATA", "SPOINT,901,902\nASET1,123,2,3\nQSET1,0,901,902\nENDDATA"))
        self.bough("export", "q.bdf", "--to", "bdf", "-o", "out.bdf")
        with open(self.path("out.bdf")) as f:
            self.assertIn("QSET1", f.read())

    def test_matrices_by_column_are_not_dmig(self):
        self.write("dmi.dat", MSC.replace("ENDDATA", "DMI,K,0,6,2,2,,4,4\nENDDATA"))
        self.assertIn("DMI is not read", self.bough("modes", "dmi.dat").stderr)


if __name__ == "__main__":
    unittest.main()
