"""bough convert: a deck in other units gives the same structure."""
import json
import os
import unittest

import h5py
import numpy as np

from support import SOURCE, ProgramTest

# Decimal numbers are rounded once more in the new units: up to 3e-12 of the low frequencies of the examples.
ROUNDING = 1e-11
# mm, N, tonne, s: a portal of bars and rods with a shell, springs, dampers, masses, a rigid element, an MPC.
DECK = """$ Units: mm, N, tonne.
SOL 103
CEND
SPC = 1
MPC = 7
METHOD = 1
SUBCASE 1
  LOAD = 10
SUBCASE 2
  LOAD = 11
BEGIN BULK
PARAM,COUPMASS,1
EIGRL,1,,,6
$ Aluminium   (a comment)
MAT1,1,7.+4,,.3,2.7-9
MAT8           2    7.+4   1.2+4      .3    5.+3    4.+3    3.+3   1.6-9
CORD2C,5,,0.,0.,0.,0.,0.,1.
,1.,0.,0.
GRID,1,,0.,0.,0.
GRID,2,,0.,0.,1000.
GRID,3,,800.,0.,1000.
GRID,4,,800.,0.,0.
GRID           5       5   1000.     90.    500.               $ cylindrical
GRID,6,,0.,500.,1000.
GRID,7,,800.,500.,1000.
GRID,8,,400.,0.,1400.
GRID,9,,850.,550.,1000.
PBAR,1,1,400.,2.+4,1.+4,2.5+4,1.-6
,10.,10.,-10.,10.
PBARL,2,1,,TUBE
,15.,12.,2.-6
PROD,3,1,50.,100.,,1.-7
PSHELL,4,1,3.,1,,1,,2.-9
PCOMP,5,-1.,1.-10
,2,1.,45.,,2,1.,-45.
CBAR*                  1               1               1               2*
*                     1.              0.              0.
,,,5.,0.,0.,5.,0.,0.
CBAR,2,2,2,3,0.,1.,0.
CBAR,3,1,3,4,1.,0.,0.
CBAR,9,2,2,8,0.,1.,0.
CBAR,10,2,3,8,0.,1.,0.
CROD,4,3,5,6
CROD,8,3,5,2
CQUAD4,5,4,2,3,7,6
CQUAD4,6,5,2,3,7,6,,2.
CELAS2,11,1.5+2,6,1
CELAS2,12,3.+5,8,4
CELAS1,13,6,7,3,8,3
PELAS,6,40.
CBUSH,14,7,6,8,,,,0
PBUSH,7,K,10.,20.,30.,4.+4,5.+4,6.+4
CMASS2,15,2.-3,8,2
CONM2,16,8,,5.-3,10.,0.,20.
,1.+1,,2.+1,,,3.+1
RBE2,17,7,123456,9
MPC,7,5,3,1.,6,4,-20.
SPC1,1,123456,1,4
SPC1,1,456,5
FORCE,10,8,,100.,1.,0.,.5
MOMENT,10,9,,2.+4,0.,1.,0.
PLOAD4,10,5,.01
GRAV,11,,9810.,0.,0.,-1.
FORCE,11,3,,1.,0.,1.,0.
ENDDATA
"""


class Convert(ProgramTest):
    def calc_rounding(self):
        """[6] What changes of E by its last digits do to the frequencies; as many numbers are rounded once more: tenfold."""
        frequencies = []
        for ulps in (0, 1, 2, 3, -1, -2, -3):
            E = 7e4 + ulps * np.spacing(7e4)
            self.write("ulps.bdf", DECK.replace("MAT1,1,7.+4,,.3,2.7-9", f"MAT1*,1,{E!r},,.3\n*,2.7-9"))
            frequencies.append(self.calc_frequencies("ulps.bdf"))
        spread = np.ptp(frequencies, axis=0) / frequencies[0]
        self.assertLess(spread.max(), 2e-11)  # 2.8 Hz beside bars of 9e5 rad/s
        return np.maximum(10 * spread, 1e-12)

    def check_frequencies(self, new, old):
        error = np.abs(new / old - 1)
        self.assertTrue(np.all(error < self.calc_rounding()), error)

    def calc_frequencies(self, deck):
        return np.array(json.loads(self.bough("modes", deck, "--json").stdout)["frequency_hz"])

    def read_displacements(self, deck):
        self.bough("static", deck, "-o", "s.h5")
        with h5py.File(self.path("s.h5")) as f:
            translates = f["dof_map"][:, 1] <= 3
            return translates, [f[f"subcases/{i}/displacement"][:] for i in (1, 2)]

    def read(self, name):
        with open(self.path(name), newline="") as f:
            return f.read()

    def test_frequencies_stay_and_displacements_scale(self):
        self.write("mm.bdf", DECK)
        self.bough("convert", "mm.bdf", "--units", "mm-N-tonne:m-kg-s", "-o", "m.bdf")
        old, new = self.calc_frequencies("mm.bdf"), self.calc_frequencies("m.bdf")
        self.check_frequencies(new, old)
        translates, old = self.read_displacements("mm.bdf")
        _, new = self.read_displacements("m.bdf")
        for a, b in zip(old, new):
            scaled = np.where(translates, 1e-3, 1.0) * a
            for rows in (translates, ~translates):
                np.testing.assert_allclose(b[rows], scaled[rows], atol=1e-10 * np.abs(scaled[rows]).max(), rtol=0)

    def test_inches_and_another_unit_of_time(self):
        self.write("mm.bdf", DECK)
        self.bough("convert", "mm.bdf", "--from", "mm-N-tonne", "--to", "in-lbf-s", "-o", "in.bdf")
        self.check_frequencies(self.calc_frequencies("in.bdf"), self.calc_frequencies("mm.bdf"))
        self.bough("convert", "mm.bdf", "--units", "mm-N-tonne:mm-kg-ms", "-o", "ms.bdf")  # kN
        self.check_frequencies(self.calc_frequencies("ms.bdf"), 1e-3 * self.calc_frequencies("mm.bdf"))

    def test_what_has_no_dimension_keeps_every_byte(self):
        self.write("mm.bdf", DECK)
        self.bough("convert", "mm.bdf", "--units", "mm-N-tonne:mm-N-tonne-s", "-o", "same.bdf")
        self.assertEqual(self.read("same.bdf"), DECK)
        self.bough("convert", "mm.bdf", "--units", "mm-N-tonne:m-N-s", "-o", "m.bdf")
        old, new = DECK.split("\n"), self.read("m.bdf").split("\n")
        self.assertEqual(len(old), len(new))
        for a, b in zip(old, new):
            if a.startswith(("$", "CROD", "CBAR,", "RBE2", "SPC1", "EIGRL", "PARAM", "SOL", "CQUAD4,5", "ENDDATA")):
                self.assertEqual(a, b)
        self.assertIn("$ cylindrical", self.read("m.bdf"))
        # There and back again.
        self.bough("convert", "m.bdf", "--units", "m-N-s:mm-N-s", "-o", "back.bdf")
        self.check_frequencies(self.calc_frequencies("back.bdf"), self.calc_frequencies("mm.bdf"))

    def test_includes_are_converted_too(self):
        begin, bulk = DECK.split("BEGIN BULK\n")
        self.write("main.bdf", begin + "BEGIN BULK\nINCLUDE 'parts.bdf'\nENDDATA\n")
        self.write("parts.bdf", bulk.replace("ENDDATA\n", ""))
        self.write("mm.bdf", DECK)
        os.mkdir(self.path("si"))
        self.bough("convert", "main.bdf", "--units", "mm-N-tonne:m-kg-s", "-o", "si/main.bdf")
        self.check_frequencies(self.calc_frequencies("si/main.bdf"), self.calc_frequencies("mm.bdf"))
        self.assertEqual(self.read("parts.bdf"), bulk.replace("ENDDATA\n", ""))

    def test_examples(self):
        for example, deck in [("ex01-spinup", "boom.bdf"), ("ex05-plate", "plate.bdf"), ("ex10-robot-arm", "arm.bdf")]:
            with self.subTest(deck):
                self.copy_example(example)
                self.bough("convert", deck, "--units", "m-kg-s:mm-N-tonne", "-o", "new.bdf")
                np.testing.assert_allclose(self.calc_frequencies("new.bdf"), self.calc_frequencies(deck), rtol=ROUNDING)

    def test_what_cannot_be_converted_is_named_and_nothing_is_written(self):
        for card, error in [("TABLES1,3\n,0.,1.,2.,3.,ENDT", "deck.unit-card"), ("PELAS,77,5.", "deck.unit-field"),
                            ("CELAS2,78,5.,6,1,,,,2.", "deck.unit-field"), ("GRID,90,,1.,1.,1.\n=,*1,=,*1.,==",
                                                                              "deck.unit-replication")]:
            with self.subTest(card):
                self.write("mm.bdf", DECK.replace("ENDDATA", card + "\nENDDATA"))
                self.fails(1, "convert", "mm.bdf", "--units", "mm-N-tonne:m-kg-s", "-o", "no.bdf", says=["mm.bdf:"],
                           error=error)
                self.assertFalse(os.path.exists(self.path("no.bdf")))

    def test_units_are_checked(self):
        self.write("mm.bdf", DECK)
        for units in ["mm-N-tonne", "mm-N:yard-kg", "N-kg:m-kg", "m:mm", "m-kg-g:m-kg", "m-N-kg-ms:m-kg-s", "m-kg:m-kg:m-kg"]:
            self.fails(1, "convert", "mm.bdf", "--units", units, "-o", "no.bdf", error="cli.bad-units")
        self.fails(1, "convert", "mm.bdf", "-o", "no.bdf", error="cli.bad-units")
        self.fails(1, "convert", "mm.bdf", "--units", "m-kg:mm-kg", "-o", "mm.bdf", error="cli.output-is-input")
        self.write("body.FLX", "")
        self.fails(1, "convert", "body.FLX", "--units", "m-kg:mm-kg", "-o", "no.FLX", says=[".FLX"], error="cli.wrong-file")
        self.write("si.toml", '[units]\nlength = "m"\nmass = "kg"\n[[body]]\nname = "b"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n'
                   '[[hinge]]\nname = "h"\ntype = "free"\nchild = "b"\n[simulation]\nduration = 1.0\n')
        self.bough("convert", "si.toml", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.toml")
        self.fails(1, "convert", "si.toml", "--units", "mm-N-tonne:m-kg-s", "-o", "no.toml", says=["si.toml", 'length = "m"'],
                   error="cli.bad-units")
        self.write("s.toml", "x = 1")
        self.fails(1, "convert", "s.toml", "--units", "m-kg:mm-kg", "-o", "no.toml", error="toml.unknown-key")


if __name__ == "__main__":
    unittest.main()
