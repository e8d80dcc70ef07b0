"""CBUSH stresses and strains, CWELD and CFAST forces in listings and OUTPUT2 files: equilibrium, RBE3 with CBAR."""
import math
import unittest

import numpy as np

from connectors_test import CENTRE, CLAMP, DIAMETER, GAP, LOADS, PFAST, PLATES, real
from op2_reader import Op2
from stress_listing_test import read_stresses
from support import ProgramTest

# Sum of LOADS on the upper plate, which the connector alone supports: 70 (1, .3, .2) and 50 (.4, -.2, 1).
FORCE = np.array([90., 11., 64.])
PLACE = f"GRID,900,,{real(CENTRE[0])},{real(CENTRE[1])},.5\n"


class Listed(ProgramTest):
    def solve(self, deck, verb="static"):
        self.write("d.bdf", deck)
        self.messages = self.bough(verb, "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06").stderr
        self.f06 = self.read("d.f06")
        for line in self.f06.splitlines():
            self.assertLessEqual(len(line), 132, line)
        self.op2 = Op2(self.path("d.op2"))
        return self.op2

    def rows(self, title):
        """Numbers after the id of each line of a table."""
        found, inside = {}, False
        for line in self.f06.splitlines():
            if "PAGE" in line:
                inside = False
            elif title in line:
                inside = True
            elif inside and line.split() and line.split()[0].lstrip("0").isdigit():
                found[int(line.split()[0])] = [float(word) for word in line.split()[1:]]
        return found


class Bushes(Listed):
    DECK = ("SOL 101\nCEND\nSPC = 1\nLOAD = 2\nFORCE = ALL\nSTRESS = ALL\nSTRAIN = ALL\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,0.,0.,0.\n"
            "GRID,3,,0.,0.,0.\nCORD2R,7,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n{bushes}SPC1,1,123456,1\n"
            "FORCE,2,2,,1.,3.,5.,-7.\nMOMENT,2,2,,1.,11.,13.,17.\nFORCE,2,3,,1.,2.,0.,0.\nSPC1,1,23456,3\nENDDATA\n")
    BUSHES = ("CBUSH,12,8,1,2,,,,7\nPBUSH,8,K,10.,20.,30.,40.,50.,60.\n,,RCV,2.,3.,.5,.25\n"
              "CBUSH,5,9,1,3,,,,0\nPBUSH,9,K,4.\n")

    def test_stress_and_strain(self):
        """SA F, ST M, EA u, ET θ in the system of the element, z = x of basic and x = y; without RCV all four are 1."""
        self.solve(self.DECK.format(bushes=self.BUSHES))
        R = np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]], float)  # rows: axes of system 7 in basic
        force, moment = R @ [3, 5, -7], R @ [11, 13, 17]
        (forces,) = self.op2.elements("OEF1", 4)
        np.testing.assert_allclose(forces[4][12], [*force, *moment], rtol=1e-6)
        (stresses,), (strains,) = self.op2.elements("OES1", 5), self.op2.elements("OSTR1", 5)
        self.assertEqual((stresses[1], list(stresses[4]), strains[1], list(strains[4])), (102, [5, 12], 102, [5, 12]))
        np.testing.assert_allclose(stresses[4][12], [*(2 * force), *(3 * moment)], rtol=1e-6)
        np.testing.assert_allclose(stresses[4][5], [2, 0, 0, 0, 0, 0], atol=1e-6)
        np.testing.assert_allclose(strains[4][12], [*(.5 * force / [10, 20, 30]), *(.25 * moment / [40, 50, 60])], rtol=1e-6)
        np.testing.assert_allclose(strains[4][5], [.5, 0, 0, 0, 0, 0], atol=1e-6)
        np.testing.assert_allclose(self.rows("S T R E S S E S   I N   B U S H   E L E M E N T S        ( C B U S H )")[12],
                                   stresses[4][12], rtol=1e-5)
        np.testing.assert_allclose(self.rows("S T R A I N S   I N   B U S H   E L E M E N T S        ( C B U S H )")[12],
                                   strains[4][12], rtol=1e-5)
        self.assertIn("STRESS-TX     STRESS-TY", self.f06)
        self.assertIn("STRAIN-TX     STRAIN-TY", self.f06)
        self.assertNotIn("cli.unlisted-elements", self.messages)

    def test_written_cards_keep_the_coefficients(self):
        self.write("d.bdf", self.DECK.format(bushes=self.BUSHES))
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "w.bdf")
        self.bough("static", "d.bdf", "--op2", "d.op2")
        self.bough("static", "w.bdf", "--op2", "w.op2")
        first, second = (Op2(self.path(name)).elements("OES1", 5)[0][4] for name in ("d.op2", "w.op2"))
        self.assertEqual(first, second)

    def test_bad_coefficient(self):
        self.write("d.bdf", self.DECK.format(bushes=self.BUSHES.replace("RCV,2.", "RCV,TWO")))
        self.assertRegex(self.bough("static", "d.bdf", code=1).stderr, r"d.bdf:\d+: error: .*SA.*TWO")


class Connectors(Listed):
    def solve_plates(self, bulk):
        return self.solve("\n".join(["SOL 101", "CEND", "SPC = 1", "LOAD = 5", "FORCE = ALL", "BEGIN BULK",
                                     PLATES + CLAMP + LOADS + bulk, "ENDDATA", ""]))

    def find(self, kind):
        return next(rows for _, found, _, _, rows in self.op2.elements("OEF1", 4) if found == kind)

    def moment(self):
        """Moment of LOADS about the middle of the connector."""
        loads = [((.4, 0, GAP), 70 * np.array([1, .3, .2])), ((.4, .4, GAP), 50 * np.array([.4, -.2, 1]))]
        return sum(np.cross(np.array(x) - [*CENTRE, GAP / 2], f) for x, f in loads)

    def test_fastener(self):
        """Forces in its axes, x along the gap, balance the loads of the plate that it supports."""
        self.solve_plates(PLACE + "CFAST,50,50,PROP,1,2,900\n" + PFAST.format(d=real(DIAMETER), mass=""))
        row = self.find(126)[50]
        self.assertAlmostEqual(row[0], FORCE[2], delta=1e-4)
        self.assertAlmostEqual(math.hypot(row[1], row[2]), np.hypot(*FORCE[:2]), delta=1e-4)
        self.assertAlmostEqual(row[3], self.moment()[2], delta=1e-4)
        self.assertAlmostEqual(math.hypot(row[4], row[5]), np.hypot(*self.moment()[:2]), delta=1e-4)
        np.testing.assert_allclose(self.rows("( C F A S T )")[50], row, rtol=1e-5, atol=1e-9)

    def test_weld(self):
        """M1 M2 of both ends, V1 V2, axial, torque: equilibrium with the loads, M' = -V over its length, and the forces of
        a CBAR between the RBE3 of its patches."""
        d = DIAMETER
        self.solve_plates(PLACE + f"CWELD,50,50,900,PARTPAT\n,1,2\nPWELD,50,9,{real(d)}\n,.1,5.\nMAT1,9,2.+9,,.3\n")
        m1a, m2a, m1b, m2b, v1, v2, axial, torque = row = self.find(117)[50]
        moment = self.moment()
        scale = np.abs(moment).max()
        self.assertAlmostEqual(axial, FORCE[2], delta=1e-4)
        self.assertAlmostEqual(math.hypot(v1, v2), np.hypot(*FORCE[:2]), delta=1e-4)
        self.assertAlmostEqual(torque, moment[2], delta=1e-5 * scale)
        self.assertAlmostEqual(math.hypot((m1a + m1b) / 2, (m2a + m2b) / 2), np.hypot(*moment[:2]), delta=1e-5 * scale)
        np.testing.assert_allclose([m1b - m1a, m2b - m2a], [-v1 * GAP, -v2 * GAP], atol=1e-5 * scale)
        np.testing.assert_allclose(self.rows("F O R C E S   I N   W E L D   E L E M E N T S")[50], row, rtol=1e-5, atol=1e-9)
        self.assertNotIn("cli.unlisted-elements", self.messages)

    def test_weld_without_length(self):
        """Ends at one place: the springs of its middle in the same columns, moments of both ends equal."""
        plates = PLATES.replace(f",{real(GAP)}\n", ",0.\n")
        self.solve("\n".join(["SOL 101", "CEND", "SPC = 1", "LOAD = 5", "FORCE = ALL", "BEGIN BULK", plates + CLAMP + LOADS + PLACE +
                              f"CWELD,50,50,900,PARTPAT\n,1,2\nPWELD,50,9,{real(DIAMETER)}\n,.1,5.\nMAT1,9,2.+9,,.3\n", "ENDDATA", ""]))
        m1a, m2a, m1b, m2b, v1, v2, axial, _ = self.find(117)[50]
        self.assertEqual((m1a, m2a), (m1b, m2b))
        self.assertAlmostEqual(axial**2 + v1**2 + v2**2, FORCE @ FORCE, delta=1e-4 * FORCE @ FORCE)
        self.assertAlmostEqual(abs(axial), FORCE[2], delta=1e-3)


if __name__ == "__main__":
    unittest.main()
