"""Strain tables of listings (--f06) and OUTPUT2 files (--op2): strain = S stress by hand, closed forms, curvatures."""
import unittest

import numpy as np

from op2_reader import Op2
from stress_listing_test import read_stresses
from support import ProgramTest

E, NU = 7e10, .3
HEAD = "SOL 101\nCEND\nSPC = 1\n{case}BEGIN BULK\nMAT1,1,7.+10,,.3,2700.,2.-5\n"


def read_strains(op2):
    return read_stresses(op2, ("OSTR1", "OSTR1C"))


def calc_plane_strain_state(exx, eyy, gamma):
    """Angle, major, minor, von Mises of a plane strain state by the eigenvalues of its tensor."""
    tensor = np.array([[exx, gamma / 2], [gamma / 2, eyy]])
    minor, major = np.linalg.eigvalsh(tensor)
    deviator = np.diag([exx, eyy, 0]) + np.array([[0, gamma / 2, 0], [gamma / 2, 0, 0], [0, 0, 0]])
    deviator -= np.eye(3) * np.trace(deviator) / 3
    return major, minor, np.sqrt(2 / 3 * np.sum(deviator**2))


class Strains(ProgramTest):
    def solve(self, bulk, case="STRAIN = ALL\nSTRESS = ALL\nLOAD = 2\n", verb="static"):
        self.write("d.bdf", HEAD.format(case=case) + bulk + "ENDDATA\n")
        self.messages = self.bough(verb, "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06").stderr
        self.f06 = self.read("d.f06")
        for line in self.f06.splitlines():
            self.assertLessEqual(len(line), 132, line)
        op2 = Op2(self.path("d.op2"))
        return read_stresses(op2), read_strains(op2)

    BAR = ("GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,4.-8,9.-8,1.-8\n,.002,.003,-.002,.001\n"
           "SPC1,1,123456,1\n")

    def test_lines(self):
        """Bars, beams and rods: σ / E and τ / G; no margins."""
        bulk = self.BAR.replace("MAT1", "MAT1") + ("GRID,3,,0.,1.,0.\nGRID,4,,2.,1.,0.\nCBEAM,2,2,3,4,0.,1.,0.\n"
                "PBEAM,2,1,1.-3,4.-8,9.-8,,1.-8\n,.002,0.,-.002,0.,.001,.001\nSPC1,1,123456,3\n"
                "GRID,5,,0.,2.,0.\nGRID,6,,2.,2.,0.\nCROD,3,3,5,6\nPROD,3,1,1.-3,2.-8,.01\nSPC1,1,123456,5\nSPC1,1,2356,6\n"
                "FORCE,2,2,,1.,50000.,1000.,-700.\nFORCE,2,4,,1.,5000.,100.,0.\nFORCE,2,6,,900.,1.,0.,0.\nMOMENT,2,6,,30.,1.,0.,0.\n")
        stress, strain = self.solve(bulk)
        self.assertEqual(set(strain), {(34, 1), (2, 2), (1, 3)})
        bar = np.array(strain[34, 1])
        keep = [0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13]
        np.testing.assert_allclose(bar[keep], np.array(stress[34, 1])[keep] / E, rtol=1e-5, atol=1e-12)
        self.assertLess(abs(bar[7]) + abs(bar[14]), 1e-30)  # blank
        for end in (0, 1):
            np.testing.assert_allclose(strain[2, 2][end][2:8], np.array(stress[2, 2][end][2:8]) / E, rtol=1e-5, atol=1e-12)
        np.testing.assert_allclose(np.array(strain[1, 3])[[0, 2]], [900 / 1e-3 / E, 30 * .01 / 2e-8 / (E / 2.6)], rtol=1e-5)
        for heading in ("S T R A I N S    I N   B A R   E L E M E N T S          ( C B A R )", "AXIAL          SA-MAX",
                        "STRAIN         SB-MAX", "S T R A I N S   I N   B E A M   E L E M E N T S        ( C B E A M )",
                        "S T R A I N S   I N   R O D   E L E M E N T S      ( C R O D )", "ID.        STRAIN       MARGIN"):
            self.assertIn(heading, self.f06)
        self.assertNotIn("[cli.unlisted-elements]", self.messages)

    def test_free_expansion(self):
        """A heated bar: the axial strain is α ΔT, no bending; no stress."""
        stress, strain = self.solve(self.BAR + "TEMPD,5,40.\n", "STRAIN = ALL\nSTRESS = ALL\nTEMPERATURE(LOAD) = 5\n")
        np.testing.assert_allclose(np.array(strain[34, 1])[:7], [0, 0, 0, 0, 8e-4, 8e-4, 8e-4], rtol=1e-6, atol=1e-12)
        np.testing.assert_allclose(np.array(stress[34, 1])[:7], 0, atol=1e-3)

    def make_plate(self, nu=".3"):
        """Two CQUAD4, skewed, under N = 6 and a bending moment M = 2 per width, with given Z1 and Z2."""
        grids = [(0, 0), (1, 0), (2, 0), (0, 1), (1.5, 1), (2, 1)]
        bulk = f"MAT1,2,7.+10,,{nu},2700.\nPSHELL,1,2,.01,2,,2\n,-.004,.005\n"
        bulk += "".join(f"GRID,{k + 1},,{x:.1f},{y:.1f},0.\n" for k, (x, y) in enumerate(grids))
        bulk += "CQUAD4,1,1,1,2,5,4\nCQUAD4,2,1,2,3,6,5\nSPC1,1,1345,1,4\nSPC1,1,2,1\nSPC1,1,6,1,2,3,4,5,6\n"
        return bulk + "".join(f"FORCE,2,{g},,3.,1.,0.,0.\nMOMENT,2,{g},,1.,0.,1.,0.\n" for g in (3, 6)), grids

    def test_plates(self):
        """Fibres: ε = S σ of each surface, in Nastran's element axes; von Mises and principal values of the tensor."""
        bulk, _ = self.make_plate("0.")
        stress, strain = self.solve(bulk, "STRAIN(FIBER) = ALL\nSTRESS = ALL\nLOAD = 2\n")
        (record,) = Op2(self.path("d.op2")).tables["OSTR1"]
        self.assertEqual(record.ident[0][10], 15)
        for element in (1, 2):
            s, e = (np.array(of[33, element]).reshape(2, 8) for of in (stress, strain))
            for side in (0, 1):
                np.testing.assert_allclose(e[side][0], s[side][0], rtol=1e-6)
                scale = abs(s[side][1:4]).max() / E
                np.testing.assert_allclose(e[side][1:4], s[side][1:4] / E * [1, 1, 2], atol=1e-5 * scale)
                np.testing.assert_allclose(e[side][5:], calc_plane_strain_state(*e[side][1:4]), atol=1e-5 * scale)
                np.testing.assert_allclose((e[side][4] - s[side][4] + 90) % 180, 90, atol=1e-2)
        self.assertIn("ELEMENT      FIBER                STRAINS IN ELEMENT COORD SYSTEM             PRINCIPAL  STRAINS (ZERO", self.f06)

    def test_curvatures(self):
        """The default, STRCUR: strains of the reference surface and curvatures, the strains of bending at z = -1."""
        bulk, _ = self.make_plate("0.")
        _, fibre = self.solve(bulk, "STRAIN(FIBER) = ALL\nLOAD = 2\n")
        _, strain = self.solve(bulk)
        (record,) = Op2(self.path("d.op2")).tables["OSTR1"]
        self.assertEqual(record.ident[0][10], 11)
        for element in (1, 2):
            low, high = np.array(fibre[33, element]).reshape(2, 8)
            mid, curvature = np.array(strain[33, element]).reshape(2, 8)
            slope = (high[1:4] - low[1:4]) / (high[0] - low[0])
            self.assertEqual((mid[0], curvature[0]), (0, -1))
            np.testing.assert_allclose(curvature[1:4], -slope, rtol=1e-4, atol=1e-5 * abs(slope).max())
            np.testing.assert_allclose(mid[1:4], low[1:4] - slope * low[0], rtol=1e-4, atol=1e-5 * abs(low[1:4]).max())
            np.testing.assert_allclose(curvature[5:], calc_plane_strain_state(*curvature[1:4]), rtol=1e-4, atol=1e-5 * abs(slope).max())
        # M / (E t³ / 12) along the strip: the trace does not depend on the axes.
        np.testing.assert_allclose(curvature[1] + curvature[2], -2 / (E * .01**3 / 12), rtol=1e-4)
        self.assertIn("ELEMENT      STRAIN               STRAINS IN ELEMENT COORD SYSTEM", self.f06)
        self.assertIn("ID.       CURVATURE          NORMAL-X", self.f06)

    def test_plies(self):
        """Two plies of one material under tension: ε = S σ in the axes of each; γ between 11 and 22 is no stress here."""
        bulk = ("PCOMP,1\n,1,.002,0.,YES,1,.002,90.,YES\n" + "".join(
            f"GRID,{1 + i + 2 * j},,{i}.,{j}.,0.\n" for j in range(2) for i in range(2)) +
            "CQUAD4,1,1,1,2,4,3\nSPC1,1,1345,1,3\nSPC1,1,2,1\nSPC1,1,6,1,2,3,4\nFORCE,2,2,,4.,1.,0.,0.\nFORCE,2,4,,4.,1.,0.,0.\n")
        _, strain = self.solve(bulk)
        (record,) = Op2(self.path("d.op2")).tables["OSTR1C"]
        self.assertEqual(record.ident[0][10], 14)
        e = 2000 / E
        first, second = strain[95, 1]
        np.testing.assert_allclose(first[1:], [e, -NU * e, 0, 0, 0, first[6], e, -NU * e, (1 + NU) * e], atol=1e-4 * e)
        np.testing.assert_allclose(second[1:4], [-NU * e, e, 0], atol=1e-4 * e)
        self.assertIn("S T R A I N S   I N   L A Y E R E D   C O M P O S I T E   E L E M E N T S   ( Q U A D 4 )", self.f06)

    def test_solids(self):
        """A brick in tension and bending, and one in pure shear: strains, principal values and von Mises at the corners."""
        corners = [(0, 0, 0), (1, 0, 0), (1, .2, 0), (0, .2, 0), (0, 0, .1), (1, 0, .1), (1, .2, .1), (0, .2, .1)]
        bulk = "PSOLID,1,1\n" + "".join(f"GRID,{k + 1},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(corners))
        bulk += "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nSPC1,1,1,1,4,5,8\nSPC1,1,2,1\nSPC1,1,3,1,4\n"
        N, M = 5000., 80.
        bulk += "".join(f"FORCE,2,{g},,{N / 4 + sign * M / .1 / 2},1.,0.,0.\n" for g, sign in ((2, -1), (3, -1), (6, 1), (7, 1)))
        found = self.solve(bulk)[1][67, 1]
        self.assertEqual(list(found), [0, 1, 2, 3, 4, 5, 6, 7, 8])
        for grid, row in found.items():
            z = 0 if grid == 0 else corners[grid - 1][2] - .05
            e = (N / .02 + M * z / (.2 * .1**3 / 12)) / E
            np.testing.assert_allclose(row[[0, 8, 14, 1, 9, 15]], [e, -NU * e, -NU * e, 0, 0, 0], atol=abs(e) * 1e-4)
            np.testing.assert_allclose(row[[2, 6, 7]], [max(e, -NU * e), -(1 - 2 * NU) * e / 3, 2 * (1 + NU) / 3 * abs(e)], rtol=1e-4)
        gamma = 3e-4
        shear = "PSOLID,1,1\n" + "".join(f"GRID,{k + 1},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(corners))
        shear += "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nSPC1,1,23,1,THRU,8\n"
        shear += "".join(f"SPC,1,{k + 1},1,{gamma * y!r}\n" for k, (x, y, z) in enumerate(corners))
        for row in self.solve(shear, "STRAIN = ALL\n")[1][67, 1].values():
            np.testing.assert_allclose(row[[1, 2, 7]], [gamma, gamma / 2, gamma / np.sqrt(3)], rtol=1e-5)
        self.assertIn("S T R A I N S   I N   H E X A H E D R O N   S O L I D   E L E M E N T S   ( H E X A )", self.f06)
        self.assertIn("------CENTER AND CORNER POINT  STRAINS---------", self.f06)

    def test_modes(self):
        """Strains of mode shapes are the stresses over E."""
        bulk = self.BAR + "EIGRL,3,,,1\nCONM2,5,2,,3.\n"
        stress, strain = self.solve(bulk, "METHOD = 3\nSTRESS = ALL\nSTRAIN = ALL\n", "modes")
        np.testing.assert_allclose(np.array(strain[34, 1])[:7], np.array(stress[34, 1])[:7] / E, rtol=1e-5, atol=1e-12)

    def test_requests(self):
        """Sets, PLOT, and decks that request no strain or nothing."""
        bulk = self.BAR + "CBAR,2,1,1,2,0.,1.,0.\nFORCE,2,2,,1.,1.,0.,0.\n"
        self.assertEqual(list(self.solve(bulk, "SET 4 = 2\nSTRAIN(PLOT) = 4\nLOAD = 2\n")[1]), [(34, 2)])
        self.assertNotIn("S T R A I N S", self.f06)
        for case in ("DISP = ALL\nLOAD = 2\n", "LOAD = 2\n", "STRAIN = NONE\nDISP = ALL\nLOAD = 2\n"):
            self.assertEqual(self.solve(bulk, case)[1], {})

    def test_responses_note_that_they_have_none(self):
        self.write("f.bdf", "SOL 108\nCEND\nSPC = 1\nDLOAD = 2\nFREQUENCY = 3\nDISP = ALL\nSTRAIN = ALL\nBEGIN BULK\n"
                            "MAT1,1,7.+10,,.3,2700.\n" + self.BAR + "RLOAD1,2,4,,,5\nDAREA,4,2,1,1.\nTABLED1,5\n,0.,1.,9.,1.,ENDT\n"
                            "FREQ,3,1.\nENDDATA\n")
        self.assertRegex(self.bough("frequency", "f.bdf", "-o", "f.h5").stderr, r"STRAIN.*\[cli.request-by-option\]")


if __name__ == "__main__":
    unittest.main()
