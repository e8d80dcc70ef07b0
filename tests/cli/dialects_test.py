"""One beam in the deck of COSMIC Nastran and in that of MSC: the same modes; what only COSMIC has is named."""
import json
import unittest

from support import ProgramTest

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
ONLY_COSMIC = ["CQUAD1", "CQUAD2", "CTRIA1", "CTRIA2", "CTRMEM", "CTRPLT", "CTRBSC", "CQDMEM", "CQDMEM1", "CQDMEM2",
               "CQDPLT", "CHEXA1", "CIHEX1", "CWEDGE", "CTWIST", "CTORDRG", "CTRIM6", "CTRSHL"]


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
            self.assertIn("SEQGP is not used", said)

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
        self.write("old.dat", MSC.replace("ENDDATA", "CRIGD3  50      1       2       3\nENDDATA"))
        self.fails(1, "modes", "old.dat", says=["CRIGD3 is not supported and carries a constraint"])

    def test_matrices_by_column_are_not_dmig(self):
        self.write("dmi.dat", MSC.replace("ENDDATA", "DMI,K,0,6,2,2,,4,4\nENDDATA"))
        self.assertIn("DMI is not used", self.bough("modes", "dmi.dat").stderr)


if __name__ == "__main__":
    unittest.main()
