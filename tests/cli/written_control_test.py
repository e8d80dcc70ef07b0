"""export --to bdf: each command of the case control that is read is written, or named as not used."""
import os
import re
import unittest

from support import SOURCE, ProgramTest

BULK = """BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CELAS2,2,36.,1,1,2,1
CONM2,1,2,,4.
SPC1,1,123456,1
DMIG,KX,0,6,1,0
DMIG,KX,2,1,,2,1,5.
DMIG,PX,0,9,1,0,,,1
DMIG,PX,1,,,2,1,5.
MAT1,1,7.+10,,.3
MATT1,1,33
TABLEM1,33
,0.,7.+10,100.,6.+10,ENDT
ENDDATA
"""
# TEMPERATURE(MATERIAL) has an effect with MATT1 only. Commands by word: lines of the case control, and what they are when written.
SAMPLES = {
    "TITLE": ("TITLE = one", "TITLE = one"), "SUBTITLE": ("SUBTITLE = two", "SUBTITLE = two"),
    "LABEL": ("LABEL = three", "LABEL = three"),
    "TEMPERATURE": ("TEMPERATURE(INITIAL) = 3\nTEMPERATURE(MATERIAL) = 4\nTEMPERATURE(LOAD) = 5",
                    r"TEMPERATURE\(LOAD\) = 5\nTEMPERATURE\(INITIAL\) = 3\nTEMPERATURE\(MATERIAL\) = 4"),
    "STATSUB": ("SUBCASE 1\nLOAD = 1\nSUBCASE 2\nSTATSUB(PRELOAD) = 1\nMETHOD = 3", r"STATSUB\(PRELOAD\) = 1"),
    "TSTEPNL": ("TSTEPNL = 3", "TSTEPNL = 3"), "IC": ("IC(PHYSICAL) = 3", "IC = 3"),
    "RESV": ("RESVEC = NO", "RESVEC = NO"), "MEFF": ("MEFFMASS(GRID=2) = YES", r"MEFFMASS\(GRID=2\) = YES"),
    "AUTOSPC": ("AUTOSPC = NO", "AUTOSPC = NO"), "PARAM": ("PARAM,G,.04", r"PARAM +G +\.04"),
    "EXTSEOUT": ("EXTSEOUT(ASMBULK,EXTBULK,EXTID=50,MATOP4=51)", r"EXTSEOUT\(ASMBULK,EXTBULK,EXTID=50,MATOP4=51\)"),
    "SET": ("SET 8 = 1, 2\nDISPLACEMENT = 8", r"SET 8 = 1, 2\nDISPLACEMENT = 8"),
    "MODSEL": ("SET 8 = 1, 2\nMODSEL = 8", r"SET 8 = 1, 2\nMODSEL = 8"),
    "OFREQ": ("SET 8 = 1., 2.5\nOFREQ = 8", r"SET 8 = 1, 2\.5\nOFREQ = 8"),
    "K2GG": ("K2GG = KX", r"K2GG = 1\.\*KX"), "M2GG": ("M2GG = KX", r"M2GG = 1\.\*KX"),
    "B2GG": ("B2GG = 2.*KX", r"B2GG = 2\.\*KX"), "K2PP": ("K2PP = KX", r"K2PP = 1\.\*KX"),
    "M2PP": ("M2PP = KX", r"M2PP = 1\.\*KX"), "B2PP": ("B2PP = KX", r"B2PP = 1\.\*KX"),
    "P2G": ("P2G = PX", r"P2G = |SLOAD|FORCE"),
    "SUBCASE": ("SUBCASE 7\nLOAD = 1", "SUBCASE 7\nLOAD = 1"), "SYM": ("SYM 7\nSYMCOM 8", "SYM 7\nSYMCOM 8"),
    "SUBCOM": ("SUBCASE 1\nSUBCOM 8\nSUBSEQ = 2.", r"SUBCOM 8\nSUBSEQ = 2\."),
    "SYMCOM": ("SYM 7\nSYMCOM 8\nSYMSEQ = 2.", r"SYMCOM 8\nSYMSEQ = 2\."), "REPCASE": ("SUBCASE 1\nREPCASE 8\nDISP = 2", r"REPCASE 8\nDISPLACEMENT = 2"),
    "SUBSEQ": ("SUBCASE 1\nSUBCASE 2\nSUBCOM 8\nSUBSEQ = 2., 3.", r"SUBSEQ = 2\., 3\."),
    "SYMSEQ": ("SYM 1\nSYM 2\nSYMCOM 8\nSYMSEQ = 2., 3.", r"SYMSEQ = 2\., 3\."),
}
for word in ("SPC", "MPC", "LOAD", "NSM", "METHOD", "SUPORT1", "CMETHOD", "TFL", "RGYRO", "RMETHOD", "DLOAD", "FREQUENCY", "TSTEP",
             "SDAMPING", "RANDOM", "RCROSS", "LOADSET"):
    SAMPLES[word] = (f"{word} = 3", f"{word} = 3")
for word in ("DISPLACEMENT", "VELOCITY", "ACCELERATION", "SPCFORCES", "FORCE", "OLOAD", "MPCFORCES", "STRESS", "STRAIN", "ESE", "GPFORCE"):
    SAMPLES[word] = (f"{word}(PHASE,PUNCH) = ALL", rf"{word}\(PHASE,PUNCH\) = ALL")
# Sections, switches and words that are an error; decks with SUPER are in superelements_test.
SAMPLES["GPSTRESS"] = (
    "GPSTRESS = ALL\nOUTPUT(POST)\nSET 9 = 1 THRU 4, 7\nSURFACE 10 SET 9 FIBRE Z1 MID SYSTEM CORD 5 AXIS X2 NORMAL MX3\nVOLUME 21 SET 9 DIRECT",
    r"GPSTRESS = ALL\nOUTPUT\(POST\)\nSET 9 = 1 THRU 4, 7\nSURFACE 10 SET 9, SYSTEM CORD 5, FIBRE MID Z1, AXIS X2, NORMAL MX3,"
    r"\n  TOPOLOGICAL, TOLERANCE 0\., BRANCH NOBREAK\nVOLUME 21 SET 9, DIRECT\n")
SAMPLES["STRFIELD"] = (
    "STRFIELD = ALL\nOUTPUT(POST)\nSET 9 = ALL\nSURFACE 10 SET 9 GEOMETRIC TOLERANCE 5.5\nVOLUME 21 SET 9 SYSTEM ELEMENT",
    r"STRFIELD = ALL\nOUTPUT\(POST\)\nSET 9 = ALL\nSURFACE 10 SET 9, FIBRE MID Z1 Z2, AXIS X1, NORMAL R, GEOMETRIC,"
    r"\n  TOLERANCE 5\.5, BRANCH BREAK\nVOLUME 21 SET 9, SYSTEM ELEMENT\n")
OTHERS = {"OUTPUT", "SKIP", "SKIPON", "SKIPOFF", "SOL", "ANALYSIS", "SUPER"}


def list_read_words():
    """Words of commands in the sources of the reader."""
    text = ""
    for name in ("control.cpp", "dynamic_control.cpp", "matrix_selection.hpp"):
        with open(os.path.join(SOURCE, "formats/nastran/detail", name)) as f:
            text += f.read()
    patterns = (r'is_command\(c\.word, "(\w+)"', r'c\.word == "(\w+)"', r'(?:Selection|Request)\{"\w+",\s*"(\w+)"',
                r'DirectInput\{"(\w+)"', r'letters == "(\w+)"', r'\{"(\w+)", &Subcase::')
    return {word for pattern in patterns for word in re.findall(pattern, text)} - OTHERS


class WrittenControl(ProgramTest):
    def test_every_command_has_a_sample(self):
        words = list_read_words()
        self.assertGreater(len(words), 50)
        self.assertEqual(words - set(SAMPLES), set())

    def test_every_command_is_written(self):
        for word, (lines, expected) in SAMPLES.items():
            with self.subTest(word):
                sol = "101" if word in ("P2G", "SYM", "SUBCOM", "SYMCOM", "REPCASE", "SUBSEQ", "SYMSEQ") else "111"
                self.write("d.bdf", f"SOL {sol}\nCEND\n{lines}\n{BULK}")
                result = self.bough("export", "d.bdf", "--to", "bdf", "-o", "written.bdf")
                if not re.search(expected, self.read("written.bdf")):
                    self.assertRegex(result.stderr, rf"not used: .*{word}|left.out.*{word}")


if __name__ == "__main__":
    unittest.main()
