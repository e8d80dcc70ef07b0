"""modes --sensitivities: closed forms of beams, repeated eigenvalues, differences of whole solutions."""
import json
import unittest

import numpy as np

from support import ProgramTest
from decks import begin

BEAM = begin(200, "SPC = 1", "METHOD = 1", "{case}") + """EIGRL,1,,,{modes}
{grids}SPC1,1,123456,1
SPC1,1,14,2,THRU,11
PBAR,1,1,1.-3,{i1},{i2},3.-6
MAT1,1,7.+10,,.3,2700.
{design}
ENDDATA
"""


def make_beam(i1="1.-6", i2="4.-6", design="", modes=4, case=""):
    grids = "".join(f"GRID,{k},,{0.2 * (k - 1):.1f},0.,0.\n" for k in range(1, 12))
    grids += "".join(f"CBAR,{k},1,{k},{k + 1},0.,0.,1.\n" for k in range(1, 11))
    return BEAM.format(i1=i1, i2=i2, grids=grids, design=design, modes=modes, case=case)


def make_plate(thickness, density):
    grids = "".join(f"GRID,{10 * i + j},,{0.25 * i},{0.2 * j},0.\n" for i in range(5) for j in range(5))
    grids += "".join(f"CQUAD4,{10 * i + j},1,{10 * i + j},{10 * i + j + 10},{10 * i + j + 11},{10 * i + j + 1}\n"
                     for i in range(4) for j in range(4))
    return (f"SOL 200\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,5\n{grids.replace('GRID,0,', 'GRID,90,').replace(',0,10,11,1', ',90,10,11,1').replace('CQUAD4,0,', 'CQUAD4,91,')}"
            f"SPC1,1,123456,90,1,2,3,4\nPSHELL,1,1,.5,1,,1\nMAT1,1,7.+10,,.3,1.\nCONM2,99,44,,0.4\n"
            f"DESVAR,1,THICK,{thickness!r}\nDVPREL1,1,PSHELL,1,T\n+,1,2.\n"
            f"DESVAR,2,RHO,{density!r}\nDVMREL1,2,MAT1,1,RHO,,,100.\n+,2,1.\nENDDATA\n")


class Sensitivities(ProgramTest):
    def solve(self, deck):
        self.write("d.bdf", deck)
        return json.loads(self.bough("modes", "d.bdf", "--sensitivities", "--json").stdout)

    def test_beams_have_closed_forms(self):
        """In-plane bending is proportional to I1, the other to I2; all to 1/rho."""
        found = self.solve(make_beam(design="DESVAR,1,I1,2.-6\nDVPREL1,1,PBAR,1,I1\n+,1,.5\nDESVAR,5,RHO,2.7\n"
                                            "DVMREL1,2,MAT1,1,RHO\n+,5,1000.\nDESVAR,9,NONE,3."))
        values = np.array(found["eigenvalue"])
        (a, b), hz = found["sensitivities"], np.array(found["frequency_hz"])
        self.assertEqual([(s["id"], s["label"]) for s in found["sensitivities"]], [(1, "I1"), (5, "RHO")])
        # x = 2e-6 is I1 = 1e-6: of the two planes one does not feel it.
        self.assertTrue(np.any(np.abs(a["eigenvalue"]) < 1e-8 * values / 2e-6))
        for slope, value in zip(a["eigenvalue"], values):
            self.assertLess(min(abs(slope * 2e-6 / value - share) for share in (0, 1)), 1e-8)
        np.testing.assert_allclose(np.array(b["eigenvalue"]) * 2.7 / values, -1, rtol=1e-8)
        np.testing.assert_allclose(b["frequency_hz"], -hz / 2 / 2.7, rtol=1e-8)
        text = self.bough("modes", "d.bdf", "--sensitivities").stdout
        self.assertRegex(text, r"mode +Hz +DESVAR +label +value +dHz/dx")

    def test_a_repeated_eigenvalue_splits(self):
        found = self.solve(make_beam("4.-6", "4.-6", "DESVAR,1,I1,4.-6\nDVPREL1,1,PBAR,1,I1\n+,1,1."))
        values, slopes = np.array(found["eigenvalue"]), np.array(found["sensitivities"][0]["eigenvalue"])
        self.assertAlmostEqual(values[1] / values[0], 1, delta=1e-9)
        for first in (0, 2):
            np.testing.assert_allclose(slopes[first:first + 2] * 4e-6 / values[first], [0, 1], atol=1e-7)

    def test_links_and_factors_of_the_property(self):
        """DLINK: x2 = 3 x1; PVAL: the field is x times the value of its card."""
        found = self.solve(make_beam(design="DESVAR,1,A,1.\nDESVAR,2,B,1.\nDLINK,1,2,0.,3.,1,1.\n"
                                            "DVMREL1,2,MAT1,1,E\n+,2,PVAL"))
        values = np.array(found["eigenvalue"])
        by_id = {s["id"]: np.array(s["eigenvalue"]) for s in found["sensitivities"]}
        self.assertEqual(list(by_id), [1])  # B follows A
        np.testing.assert_allclose(by_id[1] / values, 1, rtol=1e-8)

    def test_a_plate_by_differences_of_solutions(self):
        t, rho = 0.005, 2600.0
        found = self.solve(make_plate(t, rho))
        slopes = [np.array(s["eigenvalue"]) for s in found["sensitivities"]]

        def solve(a, b):
            return np.array(self.solve(make_plate(a, b))["eigenvalue"])
        for slope, x, solve_at in ((slopes[0], t, lambda v: solve(v, rho)), (slopes[1], rho, lambda v: solve(t, v))):
            wide, narrow = ((solve_at(x + h) - solve_at(x - h)) / 2 / h for h in (4e-3 * x, 2e-3 * x))
            np.testing.assert_allclose(slope, (4 * narrow - wide) / 3, rtol=1e-6)
        self.assertTrue(np.all(slopes[0] > 0) and np.all(slopes[1] < 0))

    def test_decks_without_variables_are_named(self):
        design = "DESVAR,1,I1,1.-6\nDVPREL1,1,PBAR,1,I1\n+,1,1."
        self.write("d.bdf", make_beam(design=design).replace("SOL 200", "SOL 103"))
        self.fails(1, "modes", "d.bdf", "--sensitivities", error="modal.no-variables", says=["SOL 103"])
        self.write("d.bdf", make_beam())
        self.fails(1, "modes", "d.bdf", "--sensitivities", error="modal.no-variables")


if __name__ == "__main__":
    unittest.main()
