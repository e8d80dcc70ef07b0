"""Structures written by other cards, in other places or in parts have equal answers."""
import json
import unittest

import numpy as np

from support import ProgramTest

HEAD = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\n{case}BEGIN BULK\n"


class Twins(ProgramTest):
    def solve(self, bulk, case="", head=HEAD):
        self.write("d.bdf", head.format(case=case) + bulk + "ENDDATA\n")
        return json.loads(self.bough("static", "d.bdf", "--json", "--full").stdout)["subcases"][-1]

    def spin(self, bulk, at=(0., 0., 0.), skew=False):
        """Loads of a spin about an axis through `at` on grids 1 and 2."""
        cd = 7 if skew else 0
        x1, x2 = np.add(at, (1., .2, .3)), np.add(at, (2., .5, -.3))
        place = lambda x: ",".join(f"{v:.12g}" for v in x)
        text = (f"CORD2R,7,,0.,0.,0.,1.,-1.,0.\n,1.,1.,1.\nGRID,1,,{place(x1)},{cd}\nGRID,2,,{place(x2)},{cd}\n"
                f"GRID,9,,{place(at)}\nSPC1,1,123456,1,2,9\nRFORCE,2,9,,.4,.3,.2,1.\n{bulk}")
        return np.array(self.solve(text)["load"]).reshape(3, 6)[:2]

    def test_mass_by_direction_under_a_spin(self):
        """-M (ω × (ω × r)) at the grid, wherever the model is; mass written by CONM1 or CMASS2."""
        by_conm1, by_cmass = "CONM1,5,2,,3.\n", "CMASS2,5,3.,2,1\n"
        omega = 2 * np.pi * .4 * np.array([.3, .2, 1.])
        want = np.zeros((2, 6))
        want[1, 0] = -3 * np.cross(omega, np.cross(omega, (2., .5, -.3)))[0]
        for at in ((0., 0., 0.), (100., 20., 50.)):
            for card in (by_conm1, by_cmass):
                np.testing.assert_allclose(self.spin(card, at), want, rtol=1e-10, atol=1e-10)

    def test_spin_about_a_grid_of_a_body_by_conm1(self):
        """A rigid body by CONM1 is that of CONM2: mass 2 at (.1, .2, -.3) from the grid, inertia 5, 6, 7."""
        s = np.array([.1, .2, -.3])
        cross = np.array([[0, -s[2], s[1]], [s[2], 0, -s[0]], [-s[1], s[0], 0]])
        I = np.diag([5., 6., 7.])
        M = np.block([[2 * np.eye(3), -2 * cross], [2 * cross, I - 2 * cross @ cross]])
        terms = [f"{M[i, j]:.15g}" for i in range(6) for j in range(i + 1)]
        rows = ["CONM1,5,2,," + ",".join(terms[:5])] + ["," + ",".join(terms[k:k + 8]) for k in (5, 13)]
        conm2 = "CONM2,5,2,,2.,.1,.2,-.3\n,5.,,6.,,,7.\n"
        for at in ((0., 0., 0.), (100., 20., 50.)):
            np.testing.assert_allclose(self.spin("\n".join(rows) + "\n", at), self.spin(conm2), rtol=1e-9, atol=1e-9)

    def test_rotary_inertia_by_scalar_masses(self):
        """CMASS2 at three rotations turn as a body with that inertia does: -ω × J ω."""
        scalar = "".join(f"CMASS2,{10 + k},{j},2,{4 + k}\n" for k, j in enumerate((3., 4., 6.)))
        for skew in (False, True):
            conm2 = f"CONM2,5,2,{7 if skew else 0},0.\n,3.,,4.,,,6.\n"
            loads = self.spin(scalar, skew=skew)
            np.testing.assert_allclose(loads, self.spin(conm2, skew=skew), rtol=1e-10, atol=1e-10)
            self.assertGreater(np.abs(loads[1, 3:]).max(), 1)

    def test_scalar_mass_between_two_grids_in_skew_axes(self):
        """F = -m b bᵀ (a₁, a₂) with b along the displacement axes."""
        loads = self.spin("CMASS2,5,5.,1,1,2,1\n", skew=True)
        omega = 2 * np.pi * .4 * np.array([.3, .2, 1.])
        a1, a2 = (np.cross(omega, np.cross(omega, x)) for x in ((1., .2, .3), (2., .5, -.3)))
        z = np.array([1., -1., 0.]) / np.sqrt(2)
        x = np.ones(3) - z * (z @ np.ones(3))
        x /= np.linalg.norm(x)
        along = np.concatenate((x, -x))
        force = -5 * along * (along @ np.concatenate((a1, a2)))
        R = np.stack((x, np.cross(z, x), z))  # rows: displacement axes
        for k in range(2):
            found = loads[k, :3]
            basic = force[3 * k:3 * k + 3]
            self.assertTrue(np.allclose(found, basic, atol=1e-9) or np.allclose(found, R @ basic, atol=1e-9), (found, basic))
        np.testing.assert_allclose(loads[:, 3:], 0, atol=1e-12)

    def test_exported_load_factors(self):
        """PARAM,CP1 and CP2 act once in a deck that is exported and read again."""
        bulk = ("PARAM,CP1,.5\nPARAM,CP2,2.\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCROD,1,1,1,2\nPROD,1,1,.1\n"
                "MAT1,1,1.+3,,.3\nSPC1,1,123456,1\nSPC1,1,23456,2\nFORCE,2,2,,1.,1.\n"
                "DMIG,PP,0,9,1,0,,,1\nDMIG,PP,1,0,,2,1,4.\n")
        first = self.solve(bulk, "P2G = PP\n")["displacement"][6]
        self.assertAlmostEqual(first, 8.5 / 100, delta=1e-15)
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "e.bdf")
        again = json.loads(self.bough("static", "e.bdf", "--json", "--full").stdout)["subcases"][0]["displacement"][6]
        self.assertAlmostEqual(again, first, delta=1e-12)

    def test_absent_midside_under_an_offset(self):
        """An eight-node shell without one midside grid, off its grids: six rigid-body modes."""
        self.write("m.bdf", "SOL 103\nCEND\nMETHOD = 3\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,.1,0.\n"
                            "GRID,3,,1.1,.9,.02\nGRID,4,,.1,1.,0.\nGRID,6,,1.05,.5,.06\nGRID,7,,.6,.95,.06\n"
                            "GRID,8,,.05,.5,.05\nCQUAD8,1,1,1,2,3,4,,6\n,7,8,,,,,,.02\nPSHELL,1,1,.1,1,,1\n"
                            "MAT1,1,7.+6,,.3,270.\nEIGRL,3,,,8\nENDDATA\n")
        messages = self.bough("modes", "m.bdf").stdout
        self.assertRegex(messages, r"rigid-body modes: 6\b")

    def test_axes_of_a_gap(self):
        """CGAP has the axes of a CBUSH: forces across come in them."""
        grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,.3,1.\nSPC1,1,123456,1,3\nSPC1,1,456,2\nFORCE,2,2,,10.,.3,1.,0.\n"
        for axes in ("0.,0.,1.", "0.,.3,1.", "3"):
            gap = self.solve(grids + f"CGAP,12,12,1,2,{axes}\nPGAP,12,-.1,,1.+5,1.+2,2.+4\n", "FORCE = ALL\n")
            bush = self.solve(grids + f"CBUSH,12,12,1,2,{axes}\nPBUSH,12,K,1.+5,2.+4,2.+4\n", "FORCE = ALL\n")
            np.testing.assert_allclose(gap["elements"]["CGAP"]["force"], bush["elements"]["CBUSH"]["force"], rtol=1e-10)
            np.testing.assert_allclose(gap["displacement"], bush["displacement"], rtol=1e-10, atol=1e-18)

    STATIONS = [(0., .0001), (.49, .0001), (.51, 1e-6), (1., 1e-6)]

    def make_beams(self, cuts, load):
        """A beam of length 2 with stations, whole or cut at x / 2 = cuts; load(eid, from, to) gives its cards."""
        text = ("GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,4.,0.,0.\nMAT1,1,7.+6,,.3,270.,1.-5\nSPC1,1,123456,1,3\n"
                "PBEAM,99,1,.02,1.-4,1.-4,,2.-4\nCBEAM,99,99,2,3,0.,1.,0.\n")
        def inertia(x):
            return np.interp(x, *zip(*self.STATIONS))
        ends = [0., *cuts, 1.]
        for k, (a, b) in enumerate(zip(ends, ends[1:])):
            pid, eid = 20 + k, 40 + k
            ga, gb = 1 if k == 0 else 10 + k, 2 if b == 1. else 11 + k
            if gb != 2:
                text += f"GRID,{gb},,{2 * b:.15g},0.,0.\n"
            inner = [s for s, _ in self.STATIONS if a < s < b]
            stations = [a, *inner, b]
            offsets = self.offset(a), self.offset(b)
            i = [inertia(s) for s in stations]
            text += f"PBEAM,{pid},1,.02,{i[0]:.12g},{i[0]:.12g},,{2 * i[0]:.12g},,\n,,,,,,,,,\n"
            for s, value in zip(stations[1:], i[1:]):
                text += f",YESA,{(s - a) / (b - a):.15g},.02,{value:.12g},{value:.12g},,{2 * value:.12g},,\n"
            text += f",0.,0.,,,,,,,\n,,,,,{offsets[0]:.12g},0.,{offsets[1]:.12g},0.\n"
            text += f"CBEAM,{eid},{pid},{ga},{gb},0.,1.,0.\n" + load(eid, a, b)
        return text

    def offset(self, x):
        return 0.

    def test_line_load_across_stations(self):
        """A load over a beam with a step between stations is that of three beams."""
        def load(eid, a, b):
            return f"PLOAD1,2,{eid},FY,FR,0.,{10 + 10 * a:.12g},1.,{10 + 10 * b:.12g}\n"
        whole, parts = (self.solve(self.make_beams(cuts, load)) for cuts in ([], [.49, .51]))
        np.testing.assert_allclose(whole["displacement"][6:12], parts["displacement"][6:12], rtol=2e-6, atol=1e-12)

    def test_gradients_off_the_axis(self):
        """The neutral axis leaves the shear centre along the beam while the gradient grows: that of four beams."""
        self.offset = lambda x: .01 + .03 * x
        def load(eid, a, b):
            T = [10 + 20 * x for x in (a, b)]
            g = [4 + 50 * x for x in (a, b)]
            return f"TEMPRB,9,{eid},{T[0]:.12g},{T[1]:.12g},{g[0]:.12g},{g[1]:.12g}\n"
        heat = "TEMPD,9,0.\n"
        cut = [.49, .51]
        whole, parts = (self.solve(self.make_beams(cuts, load) + heat + "FORCE,2,2,,0.,1.\n", "TEMPERATURE(LOAD) = 9\n")
                        for cuts in ([], [.25, *cut, .8]))
        np.testing.assert_allclose(whole["displacement"][6:12], parts["displacement"][6:12], rtol=1e-9, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
