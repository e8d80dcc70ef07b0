"""ASET in frequency and transient responses: against Guyan's reduction by NumPy, directly and by modes."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest

HEAD = "SOL {sol}\nCEND\nSPC = 1\nMETHOD = 1\n{case}DLOAD = 9\nDISPLACEMENT = ALL\nSPCFORCES = ALL\nBEGIN BULK\n"
# Three points in a row; 2, with mass, damper and load, follows 1 (which moves) and 3.
CHAIN = ("EIGRL,1,,,1\nSPOINT,1,2,3\nCELAS4,1,1000.,1,2\nCELAS4,2,3000.,2,3\nCMASS4,4,.1,2\nCMASS4,5,2.,3\n"
         "CDAMP4,6,3.,2,3\nSPC1,1,0,1\nASET1,0,3\nFREQ,5,1.,3.,8.\nTSTEP,6,400,.001,1\n")
MOVED = "SPCD,10,1,0,1.\n"
LOADED = "DAREA,10,2,0,1.\n"
K = np.array([[1000., -1000, 0], [-1000, 4000, -3000], [0, -3000, 3000]])
M = np.diag([0, .1, 2.])
B = np.array([[0, 0, 0], [0, 3., -3], [0, -3, 3]])


class AsetResponse(ProgramTest):
    def respond(self, verb, sol, case, bulk, *options):
        self.write("d.bdf", HEAD.format(sol=sol, case=case) + CHAIN + bulk + "ENDDATA\n")
        self.bough(verb, "d.bdf", "-o", "d.h5", *options)
        with h5py.File(self.path("d.h5")) as f:
            group = f["subcases/1"]
            return {name: np.array(group[name]["value"] if "value" in group[name]
                                   else group[name]["real"][:] + 1j * group[name]["imag"][:])
                    for name in ("displacement", "spc_force")}

    def calc_guyan(self, hz, motion, load):
        """u of the three points and the force of elements on 1: u_2 = (1000 u_1 + 3000 u_3) / 4000."""
        to_support, to_free = np.array([1, .25, 0]), np.array([0, .75, 1])
        rows = []
        for f in hz:
            Z = K + 2j * np.pi * f * B - (2 * np.pi * f)**2 * M
            F = np.array([0, load, 0])
            q = to_free @ (F - Z @ to_support * motion) / (to_free @ Z @ to_free)
            u = to_support * motion + to_free * q
            rows.append([*u, (Z @ u - F)[0]])
        return np.array(rows)

    def test_frequency(self):
        for bulk, curve, motion, load in ((MOVED, ",,DISP", 1, 0), (LOADED, "", 0, 1)):
            exact = self.calc_guyan([1., 3., 8.], motion, load)
            for sol in (108, 111):
                with self.subTest((bulk, sol)):
                    found = self.respond("frequency", sol, "FREQUENCY = 5\n", bulk + f"RLOAD1,9,10,,,1.{',' + curve[1:] if curve else ''}\n")
                    np.testing.assert_allclose(found["displacement"], exact[:, :3], rtol=1e-9)
                    np.testing.assert_allclose(found["spc_force"][:, 0], exact[:, 3], rtol=1e-9)

    def test_transient(self):
        """A support that moves as sin: directly and by modes, and in the end the frequency response."""
        bulk = MOVED + "TLOAD2,9,10,,DISP,0.,100.,3.,-90.\n"
        direct = self.respond("transient", 109, "TSTEP = 6\n", bulk)["displacement"]
        modal = self.respond("transient", 112, "TSTEP = 6\n", bulk)["displacement"]
        np.testing.assert_allclose(direct, modal, atol=2e-4 * np.abs(modal).max())
        t = np.arange(401) * .001
        np.testing.assert_allclose(direct[:, 0], np.sin(2 * np.pi * 3 * t), atol=1e-9)
        np.testing.assert_allclose(direct[:, 1], .25 * direct[:, 0] + .75 * direct[:, 2], atol=1e-9)

    def test_complex_modes(self):
        """Residual vectors of a damper at a point that follows stay within the a-set."""
        text = HEAD.format(sol=110, case="CMETHOD = 2\n").replace("DLOAD = 9\n", "") + CHAIN + "EIGC,2,CLAN,MAX,,,,1\nENDDATA\n"
        self.write("d.bdf", text)
        modes = json.loads(self.bough("modes", "d.bdf", "--json").stdout)
        to_free = np.array([0, .75, 1])
        m, b, k = (to_free @ A @ to_free for A in (M, B, K))
        pole = -b / m / 2 + 1j * np.sqrt(k / m - (b / m / 2)**2)
        found = modes["modes"][0]["eigenvalue"]
        self.assertAlmostEqual(complex(found["real"], abs(found["imag"])) / pole, 1, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
