"""Files, tables and plots of responses of decks, and the choice of their output."""
import csv
import json
import os
import sys
import unittest

import numpy as np

from deck_response_case import ONE, DeckResponse, read
from support import SOURCE

sys.path.insert(0, os.path.join(SOURCE, "tests", "oracle"))
import uff_reader  # noqa: E402


class Files(DeckResponse):
    DECK = ONE.format(sol=111, case="DLOAD = 9\nFREQUENCY = 5\nTITLE = A TITLE", bulk="RLOAD1,9,10,,,1.0\nDAREA,10,1,1,2.5\nFREQ1,5,.05,.03,30\n"
                      "CDAMP2,3,2.4,1,1,2,1").replace("DISPLACEMENT = 1", "DISPLACEMENT(PHASE,PUNCH) = 1")

    def test_csv_and_punch(self):
        self.write("d.bdf", self.DECK)
        text = self.bough("frequency", "d.bdf", "-o", "d.h5", "--csv", "d.csv", "--punch", "d.pch").stdout
        self.assertIn("written: d.pch", text)
        r = read(self.path("d.h5"))[1]
        with open(self.path("d.csv")) as f:
            rows = list(csv.DictReader(f))
        self.assertEqual(len(rows), 31)
        u = r["displacement"][1, 1]
        for row, one, hz in zip(rows, u, r["x"]):
            self.assertAlmostEqual(float(row["frequency_hz"]), hz, delta=1e-14)
            self.assertAlmostEqual(float(row["displacement:1:1:magnitude"]), abs(one), delta=1e-14)
            self.assertAlmostEqual(float(row["displacement:1:1:phase_deg"]), np.degrees(np.angle(one)), delta=1e-9)
            self.assertAlmostEqual(float(row["velocity:1:1:imag"]), r["velocity"][1, 1][rows.index(row)].imag, delta=1e-14)
        with open(self.path("d.pch")) as f:
            lines = f.read().splitlines()
        self.assertTrue(all(len(line) == 80 for line in lines))
        self.assertEqual(lines[0][:72].rstrip(), "$TITLE   = A TITLE")
        self.assertEqual([line[:72].rstrip() for line in lines[3:5]], ["$DISPLACEMENTS", "$MAGNITUDE-PHASE OUTPUT"])
        self.assertEqual(lines[6][:72].rstrip(), "$POINT ID =           1  IDENTIFIED BY FREQUENCY")
        self.assertNotIn("VELOCITY", "".join(lines))
        self.assertEqual(lines[7][17], "G")
        self.assertAlmostEqual(float(lines[7][:17]), .05)
        self.assertAlmostEqual(float(lines[7][18:36]), abs(u[0]), delta=1e-6 * abs(u[0]))
        self.assertEqual(lines[8][:6], "-CONT-")
        self.assertAlmostEqual(float(lines[9][18:36]), np.degrees(np.angle(u[0])) % 360, delta=1e-3)
        self.assertEqual(int(lines[-1][72:]), len(lines))

    def test_universal_file(self):
        """Programs of modal tests go by grid, direction and quantity, not by the title."""
        self.write("d.bdf", self.DECK)
        self.bough("frequency", "d.bdf", "-o", "d.h5")
        self.bough("export", "d.h5", "--to", "uff", "-o", "d.uff")
        r = read(self.path("d.h5"))[1]
        found = {(f["quantity"], f["node"], f["direction"]): f["values"] for f in uff_reader.read(self.path("d.uff")) if "quantity" in f}
        for code, quantity in ((8, "displacement"), (11, "velocity"), (12, "acceleration"), (9, "spc_force")):
            for dof, values in r[quantity].items():
                np.testing.assert_allclose(found[code, *dof], values, rtol=1e-11, atol=1e-300)

    def test_table_and_json(self):
        self.write("d.bdf", self.DECK)
        text = self.bough("frequency", "d.bdf").stdout
        self.assertIn("31 frequencies from 0.05 to 0.95 Hz; 1 mode and 0 residual vectors", text)
        one = json.loads(self.bough("frequency", "d.bdf", "--json", "--full").stdout)["subcases"][0]
        curve = next(c for c in one["curves"] if c["name"] == "displacement:1:1")
        u = np.array(curve["real"]) + 1j * np.array(curve["imag"])
        self.assertAlmostEqual(curve["largest"], np.abs(u).max())
        self.assertAlmostEqual(curve["at"], one["frequency_hz"][np.abs(u).argmax()])
        self.assertNotIn("real", json.loads(self.bough("frequency", "d.bdf", "--json").stdout)["subcases"][0]["curves"][0])

    def test_plot(self):
        self.write("d.bdf", self.DECK)
        self.bough("frequency", "d.bdf", "-o", "d.h5")
        self.bough("plot", "d.h5", "--sensor", "displacement:1:1", "-o", "d.svg")
        with open(self.path("d.svg")) as f:
            text = f.read()
        for words in ["displacement:1:1", "magnitude [dB]", "phase [degrees]"]:
            self.assertIn(words, text)
        self.fails(1, "plot", "d.h5", "--sensor", "displacement:1:7", "-o", "e.svg", error="cli.unknown-channel")
        self.write("t.bdf", ONE.format(sol=112, case="DLOAD = 9\nTSTEP = 5", bulk="TLOAD2,9,10,,,0.,9.\nDAREA,10,1,1,2.5\nTSTEP,5,40,.1"))
        self.bough("transient", "t.bdf", "-o", "t.h5")
        self.bough("plot", "t.h5", "--sensor", "velocity:1", "-o", "t.svg")
        self.assertIn("/subcases/1/displacement/value", self.bough("info", "t.h5").stdout)

    def test_choice_of_output(self):
        """--grid adds; no request at all gives the loaded grids; OFREQ and EXCEPT; SET that is missing."""
        plain = self.DECK.replace("DISPLACEMENT(PHASE,PUNCH) = 1\nVELOCITY = 1\nACCELERATION = 1\nSPCFORCES = 1\nFORCE = ALL\n", "")
        self.write("d.bdf", plain)
        self.assertIn("[modal.default-output]", self.bough("frequency", "d.bdf", "-o", "d.h5").stderr)
        self.assertEqual({g for g, _ in read(self.path("d.h5"))[1]["displacement"]}, {1})
        self.bough("frequency", "d.bdf", "--grid", "2", "-o", "d.h5")
        self.assertEqual({g for g, _ in read(self.path("d.h5"))[1]["acceleration"]}, {2})
        self.fails(1, "frequency", "d.bdf", "--grid", "77", error="fe.missing-grid")
        self.write("d.bdf", plain.replace("SET 1 = 1, 2", "SET 1 = 1 THRU 5 EXCEPT 2\nDISP = 1\nSET 2 = .2,.5\nOFREQ = 2"))
        self.bough("frequency", "d.bdf", "-o", "d.h5")
        r = read(self.path("d.h5"))[1]
        self.assertEqual({g for g, _ in r["displacement"]}, {1})
        np.testing.assert_allclose(r["x"], [.2, .5], atol=1e-12)
        self.write("d.bdf", plain.replace("SET 1 = 1, 2", "DISP = 7"))
        self.fails(1, "frequency", "d.bdf", error="modal.missing-set")

    def test_two_subcases(self):
        deck = self.DECK.replace("DLOAD = 9\n", "").replace(
            "BEGIN BULK", "SUBCASE 1\nDLOAD = 9\nSUBCASE 2\nDLOAD = 19\nSUBCASE 3\nDLOAD = 29\nBEGIN BULK\nRLOAD1,19,10,,,2.")
        self.write("d.bdf", deck)
        text = self.bough("frequency", "d.bdf", "-o", "d.h5", "--csv", "d.csv", code=1).stderr
        self.assertIn("[modal.no-dynamic-load]", text)
        r = read(self.path("d.h5"))
        self.assertEqual(sorted(r), [1, 2])
        self.near(r[2]["displacement"][1, 1], 2 * r[1]["displacement"][1, 1])


if __name__ == "__main__":
    unittest.main()
