"""Notching of `frequency`: manual and response-limited, sine and random, against closed forms of an oscillator on a base."""
import csv
import json
import unittest

import numpy as np

from support import ProgramTest

G, LEVEL = 9.81, .5
DECK = """SOL 108
CEND
SPC = 1
FREQUENCY = 5
{random}DLOAD = 9
ACCELERATION = ALL
FORCE = ALL
BEGIN BULK
GRID,1,,0.,0.,0.,,23456
GRID,2,,1.,0.,0.,,23456
CONM2,11,2,,4.
CELAS2,21,16000.,1,1,2,1
CDAMP2,22,25.,1,1,2,1
SPC1,1,1,1
RLOAD1,9,10,,,1.,,ACCE
SPCD,10,1,1,4.905
FREQ1,5,2.,.25,100
TABRND1,1
,1.,.04,30.,.04,ENDT
{bulk}ENDDATA
"""
HZ = 2 + .25 * np.arange(101)


def calc_transmissibility():
    omega = 2 * np.pi * HZ
    return (16000 + 25j * omega) / (16000 + 25j * omega - 4 * omega**2)


class Notching(ProgramTest):
    def solve(self, *options, random="", bulk=""):
        self.write("d.bdf", DECK.format(random=random, bulk=bulk))
        return json.loads(self.bough("frequency", "d.bdf", "--json", "--full", *options).stdout)

    def find_curve(self, data, name):
        curve = next(c for c in data["subcases"][0]["curves"] if c["name"] == name)
        return np.array(curve["real"]) + 1j * np.array(curve["imag"])

    def test_sine_with_limits_and_a_manual_notch(self):
        full = LEVEL * G * calc_transmissibility()
        manual = np.where((HZ >= 15) & (HZ <= 18), .25, 1)
        # The limit of the spring acts from 9 Hz on.
        relative = np.abs(full - LEVEL * G) / (2 * np.pi * HZ)**2 * 16000
        spring = np.where(HZ >= 9, np.minimum(1, 30 / relative), 1)
        exact = np.minimum(np.minimum(np.minimum(1, 12 / np.abs(full)), manual), spring)
        self.assertTrue(np.any((spring < 12 / np.abs(full)) & (spring < manual)))
        data = self.solve("--limit", "acceleration:2:1=12", "--notch", "15:18=0.25", "--limit", "CELAS2:21:force=30@9:60",
                          "--notch-csv", self.path("n.csv"))
        notch = data["notches"][0]
        np.testing.assert_allclose(notch["factor"], exact, rtol=1e-10)
        np.testing.assert_allclose(self.find_curve(data, "acceleration:2:1"), exact * full, rtol=1e-9)
        np.testing.assert_allclose(self.find_curve(data, "acceleration:1:1"), exact * LEVEL * G, rtol=1e-9)
        for hz, factor, by in zip(HZ, exact, notch["by"]):
            expected = ("" if factor == 1 else "band" if factor == .25 and 15 <= hz <= 18
                        else "acceleration:2:1" if abs(factor - 12 / np.abs(full[HZ == hz][0])) < 1e-9 else "CELAS2:21:force")
            self.assertEqual(by, expected, hz)
        with open(self.path("n.csv")) as f:
            rows = list(csv.DictReader(f))
        np.testing.assert_allclose([float(row["decibel"]) for row in rows], 20 * np.log10(exact), atol=1e-9)
        text = self.bough("frequency", "d.bdf", "--limit", "acceleration:2:1=12").stdout
        self.assertIn("notches of the input of subcase 1", text)
        self.assertIn("acceleration:2:1", text)
        self.assertIn("none: the full input", self.bough("frequency", "d.bdf", "--limit", "acceleration:2:1=1e9").stdout)

    def test_random(self):
        """The clipped spectral density, its RMS by straight lines, and the manual notch in amplitude."""
        density = .04 * np.abs(LEVEL * G * calc_transmissibility())**2
        exact = np.minimum(density, 3.)
        random = {"random": "RANDOM = 3\n", "bulk": "RANDPS,3,1,1,1.,,1\n"}
        data = self.solve("--psd-limit", "acceleration:2:1=3", **random)
        output = next(o for o in data["random"][0]["outputs"] if o["name"] == "acceleration:2:1")
        np.testing.assert_allclose(output["psd"], exact, rtol=1e-9)
        self.assertAlmostEqual(output["rms"], np.sqrt(np.trapz(exact, HZ)), delta=1e-9 * output["rms"])
        np.testing.assert_allclose(data["notches"][0]["factor"], np.sqrt(exact / density), rtol=1e-9)
        data = self.solve("--notch", "8:12=0.5", "--psd-limit", "acceleration:2:1=3@2:40", **random)
        exact = np.minimum(density * np.where((HZ >= 8) & (HZ <= 12), .25, 1), 3.)
        output = next(o for o in data["random"][0]["outputs"] if o["name"] == "acceleration:2:1")
        np.testing.assert_allclose(output["psd"], exact, rtol=1e-9)

    def test_bad_input(self):
        self.solve()
        for options, says in ((("--limit", "acceleration:2=5"), "acceleration:1:1"), (("--limit", "x"), "NAME=VALUE"),
                              (("--limit", "acceleration:2:1=-5"), "positive"), (("--notch", "8:5=.5"), "empty"),
                              (("--notch", "5:8=2"), "between 0 and 1"), (("--notch", "5=2"), "MIN:MAX"),
                              (("--psd-limit", "acceleration:2:1=5"), "random"), (("--limit", "acceleration:2:1=5@x:7"), "x")):
            self.fails(1, "frequency", "d.bdf", *options, error="cli.bad-notch", says=[says])


if __name__ == "__main__":
    unittest.main()
