"""Slips in decks that change the answer are named: components left out, ids of two cards, temperatures of nothing."""
import json
import unittest

from support import ProgramTest

ROD = """SOL 101
CEND
SPC = 1
LOAD = 5
{case}BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CROD,1,1,1,2
PROD,1,1,1.-4
MAT1,1,2.+11,,.3,,1.-5
SPC1,1,123456,1
SPC1,1,23456,2
FORCE,5,2,0,100.,1.,0.,0.
{bulk}ENDDATA
"""
PER_NEWTON = 1 / (2e11 * 1e-4)  # L / EA

PLATE = """SOL 101
CEND
SPC = 1
LOAD = 2
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
{elements}MAT1,1,1.+6,,.3
FORCE,2,2,,1.,1.
FORCE,2,3,,1.,1.
SPC1,1,123456,1,4
{bulk}ENDDATA
"""


class Slips(ProgramTest):
    def solve(self, case="", bulk="", deck=ROD, code=0):
        self.write("d.bdf", deck.format(case=case, bulk=bulk))
        done = self.bough("static", "d.bdf", "--json", "--full", code=code)
        if code:
            return None, done.stderr
        return json.loads(done.stdout)["subcases"][-1]["displacement"][6], done.stderr

    def test_no_component(self):
        for bulk in ("SPC,1,2,,0.\n", "SPC1,1,0,2\n", "SPC1,1,,2\n", "SPC,1,2,1,0.\nSPCD,5,2,0,.1\n"):
            messages = self.solve(bulk=bulk, code=1)[1]
            self.assertRegex(messages, r"d.bdf:\d+: error: SPC.*names no component of grid 2.*\[fe.bad-component\]", bulk)

    def test_spc_beside_spcadd(self):
        """The SPCADD card alone is the set."""
        stray = "SPC1,7,1,2\n"
        u, messages = self.solve("SPC = 7\n", "SPCADD,7,1\n" + stray)
        self.assertAlmostEqual(u, 100 * PER_NEWTON, delta=1e-17)
        self.assertRegex(messages, r"d.bdf:\d+: warning: SPCADD 7 has the id of SPC cards.*\[fe.duplicate-set\]")
        mpc = "MPC,7,2,1,1.\n"
        u, messages = self.solve("MPC = 7\n", "MPCADD,7,8\nSPOINT,9\nMPC,8,9,0,1.,2,1,-1.\n" + mpc)
        self.assertAlmostEqual(u, 100 * PER_NEWTON, delta=1e-17)
        self.assertIn("warning: MPCADD 7 has the id of MPC cards", messages)

    def test_load_of_the_id_of_a_load(self):
        messages = self.solve(bulk="LOAD,5,1.,2.,6\nFORCE,6,2,0,1.,1.,0.,0.\n", code=1)[1]
        self.assertRegex(messages, r"d.bdf:\d+: error: LOAD 5 has the id of load cards.*\[fe.duplicate-set\]")

    def test_displacement_enforced_twice(self):
        u, messages = self.solve(bulk="SPC,1,2,1,.1\nSPC,1,2,1,.3\n")
        self.assertAlmostEqual(u, .3, delta=1e-15)
        self.assertRegex(messages, r"d.bdf:\d+: warning: SPC set 1 moves grid 2 component 1 by 0.3, and another card by 0.1"
                               r".*\[fe.enforced-twice\]")
        self.assertNotIn("fe.enforced-twice", self.solve(bulk="SPC,1,2,1,.3\nSPC,1,2,1,.3\n")[1])

    def test_temperatures(self):
        case, heat = "TEMPERATURE(LOAD) = 9\n", "TEMPD,9,10.\n"
        u, messages = self.solve(case, heat + "TEMP,9,1,10.\n")
        self.assertAlmostEqual(u, 100 * PER_NEWTON + 1e-4, delta=1e-16)
        self.assertEqual(messages, "")
        for card, what in [("TEMP,9,77,5.", "TEMP of temperature set 9 names grid 77"),
                           ("TEMPRB,9,77,5.,5.", "TEMPRB of temperature set 9 names element 77"),
                           ("TEMPP1,9,1,5.,5.", "TEMPP1 of temperature set 9 names element 1")]:
            u, messages = self.solve(case, heat + card + "\n")
            self.assertAlmostEqual(u, 100 * PER_NEWTON + 1e-4, delta=1e-16)
            self.assertRegex(messages, rf"d.bdf:\d+: warning: {what}, which is not there.*\[fe.unused-temperature\]")
        for first, second in [("TEMP,9,1,5.", "TEMP,9,1,6."), ("TEMPRB,9,1,5.,5.", "TEMPRB,9,1,5.,6.")]:
            messages = self.solve(case, heat + first + "\n" + second + "\n", code=1)[1]
            self.assertRegex(messages, r"d.bdf:\d+: error: TEMP.*another temperature.*\[fe.duplicate-temperature\]")
            self.assertEqual(self.solve(case, heat + first + "\n" + first + "\n")[1], "")

    def test_thickness_of_some_corners(self):
        shell = "CQUAD4,1,1,1,2,3,4\n,,,.1\nPSHELL,1,1,{t},1\n"
        messages = self.solve(deck=PLATE.replace("{elements}", shell.format(t="")), code=1)[1]
        self.assertRegex(messages, r"d.bdf:\d+: error: CQUAD4 1 gives a thickness at some corners only.*\[fe.bad-property\]")
        self.solve(deck=PLATE.replace("{elements}", shell.format(t=".1")))

    def test_pressure_on_two_elements(self):
        both = ("GRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\n"
                "PSOLID,1,1\nCQUAD4,1,2,1,2,6,5\nPSHELL,2,1,.01,1\n")
        messages = self.solve(deck=PLATE.replace("{elements}", both), bulk="PLOAD4,2,1,1.,,,,5,7\n", code=1)[1]
        self.assertRegex(messages, r"d.bdf:\d+: error: pressure on element 1: a shell and a CHEXA have this id"
                               r".*\[fe.ambiguous-element\]")

    def test_complex_modes_of_nothing_free(self):
        self.write("c.bdf", "SOL 107\nCEND\nSPC = 1\nCMETHOD = 5\nBEGIN BULK\nGRID,1\nCONM2,99,1,,10.\n"
                            "SPC1,1,123456,1\nEIGC,5,HESS,,,,,2\nENDDATA\n")
        self.fails(3, "modes", "c.bdf", error="modal.no-dofs")

    def test_units_of_a_mixed_spring(self):
        """No factor fits a spring between a translation and a rotation, unless lengths stay."""
        for cards in ("CELAS2,9,1000.,2,1,2,5\n", "CELAS1,9,9,2,1,2,5\nPELAS,9,1000.\n", "CMASS2,9,1000.,2,1,2,5\n"):
            self.write("d.bdf", ROD.format(case="", bulk=cards))
            self.fails(1, "convert", "d.bdf", "--units", "m-kg-s:mm-kg-s", "-o", "e.bdf", error="deck.unit-field")
            self.bough("convert", "d.bdf", "--units", "m-kg-s:m-kg-ms", "-o", "e.bdf")


if __name__ == "__main__":
    unittest.main()
