"""PELAST, PDAMPT, PBUSHT: closed forms of two masses, rotors on bearings over speed against decks of constant bearings."""
import json
import math
import unittest

import numpy as np
from scipy.optimize import brentq

from deck_response_case import DeckResponse

M1, M2, G = 4.0, 2.5, 0.03
# Masses at 1 and 2 along x: spring and damper between them, a bush to the fixed grid 3, a spring from 1 to ground.
PAIR = """SOL {sol}
CEND
SPC = 1
METHOD = 1
DLOAD = 9
FREQUENCY = 5
DISPLACEMENT = ALL
SPCFORCES = ALL
FORCE = ALL
{case}
BEGIN BULK
EIGRL,1,,,2
PARAM,G,.03
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
CONM2,11,1,,4.0
CONM2,12,2,,2.5
PELAS,10,100.,.02
CELAS1,21,10,1,1,2,1
PDAMP,20,1.5
CDAMP1,22,20,1,1,2,1
PBUSH,30,K,200.,5.
,,B,.5
,,GE,.01
CBUSH,23,30,2,3,,,,0
CELAS2,24,60.,1,1
SPC1,1,23456,1,2
SPC1,1,123456,3
RLOAD1,9,10,,,1.0
DAREA,10,1,1,2.5
FREQ1,5,.3,.25,12
{tables}
ENDDATA
"""
TABLES = """PELAST,10,101,102
PDAMPT,20,103
PBUSHT,30,K,104
,,B,105
,,GE,106
TABLED1,101
,0.,80.,2.,160.,4.,120.,ENDT
TABLED2,102,.5
,0.,.02,3.,.2,ENDT
TABLED1,103
,0.,2.,4.,.5,ENDT
TABLED4,104,0.,1.,0.,10.
,150.,20.,ENDT
TABLED1,105
,0.,.5,4.,1.5,ENDT
TABLED1,106
,0.,.0,4.,.08,ENDT
"""


def evaluate(f, tables=True):
    """Displacements of both masses, and force of the bush by the closed form."""
    w = 2 * math.pi * f
    k, ge, b, kb, bb, gb = 100, .02, 1.5, 200, .5, .01
    if tables:
        k, ge = np.interp(f, [0, 2, 4], [80, 160, 120]), .02 + .06 * (f - .5)
        b, kb = 2 - 1.5 * f / 4, 150 + 20 * f
        bb, gb = .5 + f / 4, .02 * f
    z = k * (1 + 1j * (G + ge)) + 1j * w * b
    to_ground = kb * (1 + 1j * (G + gb)) + 1j * w * bb
    Z = np.array([[z + 60 * (1 + 1j * G) - w * w * M1, -z], [-z, z + to_ground - w * w * M2]])
    u = np.linalg.solve(Z, [2.5, 0])
    return [*u, -to_ground * u[1], k * (u[0] - u[1]), -kb * u[1]]


class FrequencyTables(DeckResponse):
    def check(self, sol, relative, *options, case="", tables=TABLES):
        one = self.solve("frequency", PAIR.format(sol=sol, case=case, tables=tables), *options)
        r = one[min(one)]
        expected = np.array([evaluate(f) for f in r["x"]])
        for i, grid in enumerate((1, 2)):
            self.near(r["displacement"][grid, 1], expected[:, i], relative)
        self.near(r["spc_force"][3, 1], expected[:, 2], relative)
        self.near(r["elements"]["CELAS1"][1][:, 0, 0], expected[:, 3], relative)
        self.near(r["elements"]["CBUSH"][1][:, 0, 0], expected[:, 4], relative)
        return r

    def test_direct_and_modal(self):
        """SOL 108 and 111 with all modes: displacements, SPC forces and forces of the elements of the closed form."""
        self.check(108, 1e-10)
        self.check(111, 1e-10)

    def test_one_mode_with_residual_vectors(self):
        """One mode and residual vectors of the springs with tables have the answer of all."""
        self.check(111, 1e-8, "--modes", "1")

    def test_base_motion(self):
        """The support of a bush with a table moves: u = -Z^-1 Z_s d."""
        case = PAIR.format(sol=108, case="", tables=TABLES + "SPCD,10,3,1,.7\nSPC,1,3,1,0.\n").replace(
            "RLOAD1,9,10,,,1.0\nDAREA,10,1,1,2.5", "RLOAD1,9,10,,,1.0,,DISP")
        for sol in ("SOL 108", "SOL 111"):
            one = self.solve("frequency", case.replace("SOL 108", sol))
            r = one[min(one)]
            for i, f in enumerate(r["x"]):
                w = 2 * math.pi * f
                k, ge, b = np.interp(f, [0, 2, 4], [80, 160, 120]), .02 + .06 * (f - .5), 2 - 1.5 * f / 4
                z = k * (1 + 1j * (G + ge)) + 1j * w * b
                s = (150 + 20 * f) * (1 + 1j * (G + .02 * f)) + 1j * w * (.5 + f / 4)
                Z = np.array([[z + 60 * (1 + 1j * G) - w * w * M1, -z], [-z, z + s - w * w * M2]])
                u = np.linalg.solve(Z, [0, .7 * s])
                self.near(r["displacement"][1, 1][i], u[0], 1e-9)
                self.near(r["displacement"][2, 1][i], u[1], 1e-9)

    def test_values_of_the_properties_elsewhere(self):
        """Modes and transient responses have the values of the properties, and say so."""
        deck = PAIR.format(sol=103, case="", tables=TABLES)
        self.write("d.bdf", deck)
        with_tables = self.bough("modes", "d.bdf", "--json")
        self.assertIn("PBUSHT is not read", with_tables.stderr)
        self.write("e.bdf", PAIR.format(sol=103, case="", tables=""))
        self.assertEqual(json.loads(with_tables.stdout)["modes"], json.loads(self.bough("modes", "e.bdf", "--json").stdout)["modes"])
        over_time = PAIR.format(sol=112, case="TSTEP = 6", tables=TABLES + "TSTEP,6,20,.01\nTLOAD2,8,10,,,0.,1.,2.").replace(
            "DLOAD = 9", "DLOAD = 8").replace("PARAM,G,.03\n", "")
        self.write("t.bdf", over_time)
        self.assertIn("modal.nominal-tables", self.bough("transient", "t.bdf").stderr)
        self.write("f.bdf", PAIR.format(sol=111, case="", tables=TABLES))
        self.assertIn("modal.nominal-tables", self.bough("frequency", "f.bdf").stderr)

    def test_other_units(self):
        """convert to mm, t, s: displacements a thousand times as large for the same force in N."""
        self.check(108, 1e-10)
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.bdf")
        one = self.solve("frequency", self.read("mm.bdf"))
        r = one[min(one)]
        expected = np.array([evaluate(f) for f in r["x"]])
        self.near(r["displacement"][1, 1], 1e3 * expected[:, 0], 1e-9)

    def test_rejected_input(self):
        for tables, error, says in [("PELAST,10,77\n", "modal.missing-table", ["PELAST 10", "77"]),
                                    ("PBUSHT,30,Q,77\n", "deck.bad-word", ["flag"]),
                                    ("PBUSHT,30,,77\n", "deck.missing-field", ["without a flag"]),
                                    ("PDAMPT,20,103\nPDAMPT,20,103\n", "deck.duplicate-id", ["20"])]:
            self.write("d.bdf", PAIR.format(sol=108, case="", tables=tables))
            self.fails(1, "frequency", "d.bdf", error=error, says=says)
        for cards, says in (("PELAST,11,101\n", "PELAST 11 gives tables for PELAS 11"), ("PDAMPT,30,103\n", "PDAMPT 30 gives tables for PDAMP 30"),
                            ("PBUSHT,20,K,101\n", "PBUSHT 20 gives tables for PBUSH 20")):
            self.write("d.bdf", PAIR.format(sol=108, case="", tables=cards + TABLES))
            found = self.bough("frequency", "d.bdf").stderr
            self.assertRegex(found, rf"d\.bdf:\d+: warning: {says}.*modal.table-without-property")

    def test_one_table_for_a_load_and_a_property(self):
        """Values of different dimensions in one table are an error of `convert`, unless their factors are equal."""
        load, shared = "RLOAD1,9,10,,,1.0", "RLOAD1,9,10,,,101"
        deck = PAIR.format(sol=108, case="", tables=TABLES)
        for old, new in ((load, shared), (load, shared.replace("101", "103")), ("TABLED1,101", "TLOAD1,7,10,,,101\nTABLED1,101")):
            self.write("d.bdf", deck.replace(old, new))
            self.fails(1, "convert", "d.bdf", "--units", "m-kg-s:mm-tonne-s", "-o", "no.bdf", error="deck.unit-field",
                       says=["d.bdf:", "TABLED1", "different dimensions"])
        # K = M/T² does not change with the unit of length; GE has no dimension.
        self.write("d.bdf", deck.replace(load, shared))
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-kg-s", "-o", "fine.bdf")
        self.assertIn("80.", self.read("fine.bdf"))
        self.write("d.bdf", deck.replace(load, shared.replace("101", "102")))
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-tonne-s", "-o", "fine.bdf")

    def test_selection_of_modes_without_modes(self):
        """MODSEL in direct solutions is left out with a warning."""
        for sol, command in ((108, "frequency"), (109, "transient")):
            self.write("d.bdf", PAIR.format(sol=sol, case="SET 4 = 1\nMODSEL = 4\nTSTEP = 6", tables="TSTEP,6,20,.01\nTLOAD2,7,10,,,0.,9.,1.")
                       .replace("DLOAD = 9", "DLOAD = 9" if sol == 108 else "DLOAD = 7"))
            result = self.bough(command, "d.bdf", "-o", "d.h5")
            self.assertIn("warning: MODSEL", result.stderr)
            self.assertIn("[modal.no-modes]", result.stderr)


# A rigid shaft with its mass in the middle on two bearings across x; two flexible beams.
ROTOR = """SOL {sol}
CEND
SPC = 1
METHOD = 1
CMETHOD = 2
RGYRO = 5
BEGIN BULK
EIGRL,1,,,20
EIGC,2,LAN,,,,,4
GRID,1,,0.,0.,0.
GRID,2,,.5,0.,0.
GRID,3,,1.,0.,0.
GRID,11,,0.,0.,0.
GRID,13,,1.,0.,0.
MAT1,1,2.+11,,.3
PBAR,1,1,1.-3,4.-8,4.-8,8.-8
CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
CONM2,9,2,,30.
,.5,,.25,,,.25
CBUSH,21,7,1,11,,,,0
CBUSH,23,7,3,13,,,,0
SPC1,1,123456,11,13
SPC1,1,14,1,THRU,3
ROTORG,7,1,THRU,3
RSPINR,7,1,3,FREQ,1.
{bulk}
ENDDATA
"""


class Bearings(DeckResponse):
    def poles(self, sol, bulk):
        self.write("d.bdf", ROTOR.format(sol=sol, bulk=bulk))
        result = self.bough("modes", "d.bdf", "--json")
        self.messages = result.stderr
        return json.loads(result.stdout)

    def test_stiffness_and_damping_over_speed(self):
        """Poles at each speed are those of a deck with the values of that speed; SOL 107 and 110."""
        nominal = "PBUSH,7,K,,1.+6,1.+6\n,,B,,1.+3,1.+3\n"
        tables = "PBUSHT,7,K,,71,72\n,,B,,73,73\nTABLED1,71\n,0.,1.+6,50.,3.+6,ENDT\n" \
                 "TABLED1,72\n,0.,1.+6,50.,2.+6,ENDT\nTABLED1,73\n,0.,1.+3,50.,2.+2,ENDT\n"
        for sol in (107, 110):
            for speed in (0.0, 20.0, 45.0):
                gyro = f"RGYRO,5,ASYNC,7,FREQ,,,{speed}\n"
                found = self.poles(sol, nominal + tables + gyro)["modes"]
                self.assertIn("modal.nominal-tables", self.messages)
                k2, k3, b = 1e6 + 4e4 * speed, 1e6 + 2e4 * speed, 1e3 - 16 * speed
                constant = self.poles(sol, f"PBUSH,7,K,,{k2},{k3}\n,,B,,{b},{b}\n" + gyro)["modes"]
                pick = lambda modes: [complex(m["eigenvalue"]["real"], m["eigenvalue"]["imag"]) for m in modes]
                np.testing.assert_allclose(pick(found), pick(constant), rtol=1e-8)

    def test_campbell_diagram(self):
        """The critical speed of a stiff rotor whose bearings stiffen with speed: 4 π² f² m = 2 k(f)."""
        bulk = "PBUSH,7,K,,1.+6,1.+6\nPBUSHT,7,K,,71,71\nTABLED1,71\n,0.,1.+5,100.,2.+5,ENDT\n" \
               "RGYRO,5,ASYNC,7,FREQ,,,9\nRSPEED,9,0.,2.,20\n"
        stiff = ROTOR.replace("PBAR,1,1,1.-3,4.-8,4.-8,8.-8", "PBAR,1,1,1.-1,4.-1,4.-1,8.-1")
        self.write("d.bdf", stiff.format(sol=107, bulk=bulk))
        result = json.loads(self.bough("modes", "d.bdf", "--json").stdout)
        expected = brentq(lambda f: 4 * math.pi**2 * f * f * 30 - 2 * (1e5 + 1e3 * f), 5, 40)
        critical = [c["speed"] for c in result["rotors"]["critical_speeds"]]
        self.assertLess(min(abs(c / (2 * math.pi) - expected) for c in critical), 1e-3 * expected, (critical, expected))

    def test_rejected_input(self):
        bulk = "PBUSH,7,K,,1.+6,1.+6\nPBUSHT,7,K,,71,71\nTABLED1,71\n,0.,1.+5,100.,2.+5,ENDT\nRGYRO,5,SYNC,7,FREQ\n"
        self.write("d.bdf", ROTOR.format(sol=107, bulk=bulk))
        self.fails(1, "modes", "d.bdf", error="modal.rotor-unsupported", says=["synchronous"])
        self.write("d.bdf", ROTOR.format(sol=107, bulk=bulk.replace("SYNC,7,FREQ", "ASYNC,7,FREQ,,,3.")).replace("RGYRO = 5\n", ""))
        self.assertIn("modal.nominal-tables", self.bough("modes", "d.bdf").stderr)


if __name__ == "__main__":
    unittest.main()
