"""Critical speeds, thresholds and whirl of rotors whose speeds rise, fall or are negative: closed forms, and the mirrored rotor."""
import json
import math
import unittest

import numpy as np
from scipy.optimize import brentq

from support import ProgramTest
from rotors import RPM, make_friswell_deck, springs
from rotors_test import DISCS, EQUAL, MASS, STIFF, make_jeffcott
from toml_text import section, table, toml

OMEGA = math.sqrt(STIFF / MASS)
# A top on springs against tilt: inertia across and polar, stiffness [kg m², N m].
ACROSS, POLAR, TILT = 0.01, 0.02, 0.01 * (2 * math.pi * 5)**2


def make_top(spin, relation=()):
    """Grids 16 and 17 along x; the disc at 16 tilts alone."""
    return [spin, *relation, "ROTORG,8,16,17", "GRID,16,,0.,1.,0.", "GRID,17,,1.,1.,0.", "CONM2,60,16,,1.",
            f",{POLAR},,{ACROSS},,,{ACROSS}", f"CELAS2,61,{TILT},16,5", f"CELAS2,62,{TILT},16,6", "SPC1,1,1234,16",
            "SPC1,1,123456,17"]


def calc_precession(spin, sign):
    """[rad/s] of the top, forward (1) or backward (-1), at a rate [rad/s]."""
    return (sign * POLAR * spin + math.sqrt((POLAR * spin)**2 + 4 * ACROSS * TILT)) / (2 * ACROSS)


class RotorSpeeds(ProgramTest):
    def modes(self, deck, modes=2, *options):
        self.write("d.bdf", deck.replace("EIGC,2,LAN,,,,,2", f"EIGC,2,LAN,,,,,{modes}"))
        result = self.bough("modes", "d.bdf", "--json", *options)
        self.messages = result.stderr
        return json.loads(result.stdout)

    def test_crossing_from_below(self):
        """A top that spins up faster than the reference rotor: its frequency crosses the speed from above, then from below."""
        hz = 2 * math.pi
        bulk = ["RSPINR,7,1,5,FREQ,71", "DDVAL,71,0.,10.,12.,14.", "RGYRO,5,ASYNC,7,FREQ,,,9", "RSPEED,9,0.,.7,20",
                *make_top("RSPINR,8,16,17,FREQ,72", ["DDVAL,72,0.,0.,40.,40."])]
        result = self.modes(make_jeffcott(107, ["RGYRO = 5"], bulk), 4)["rotors"]
        spin = lambda speed: np.interp(speed, [0, 10 * hz, 12 * hz, 14 * hz], [0, 0, 40 * hz, 40 * hz])
        upward = brentq(lambda s: calc_precession(spin(s), 1) - s, 10 * hz, 12 * hz, xtol=1e-12)
        points = result["critical_speeds"]
        np.testing.assert_allclose([p["speed"] for p in points], [5 * hz, 5 * hz, upward], rtol=1e-7)
        self.assertAlmostEqual(points[2]["whirl"], 1, places=6)

    def test_end_of_instability(self):
        """A rotor with internal damping that spins up beyond its threshold and down again: both speeds, each by its name."""
        external, internal = 20.0, 25.0
        threshold = OMEGA * (1 + external / internal) / 2 / math.pi   # [Hz]
        bulk = [*make_top("RSPINR,8,16,17,FREQ,72", ["DDVAL,72,0.,50.,100."]), "RSPINR,7,1,5,FREQ,71",
                f",0.,0.,{internal / STIFF:.12e}", "DDVAL,71,0.,60.,0.", "RGYRO,5,ASYNC,8,FREQ,,,9", "RSPEED,9,0.,7.,14"]
        deck = make_jeffcott(107, ["RGYRO = 5"], bulk, external)
        result = self.modes(deck, 4, "-o", "d.h5")["rotors"]
        expected = [50 * threshold / 60, 100 - 50 * threshold / 60]
        np.testing.assert_allclose([p["speed"] / 2 / math.pi for p in result["thresholds"]], expected, rtol=1e-6)
        self.assertEqual([p["onset"] for p in result["thresholds"]], [True, False])
        np.testing.assert_array_equal(self.read_arrays("d.h5", "thresholds/onset")[0], [1, 0])
        for text, *phrases in [(self.bough("modes", "d.bdf").stdout, "unstable above this speed", "stable again above this speed"),
                               (self.read_page("d.h5"), "Thresholds of instability", "above this speed")]:
            for phrase in phrases:
                self.assertIn(phrase, text)

    def test_stiff_shapes(self):
        """A disc amid a stiff massless shaft on soft bearings, by modes and by the full matrices: its tilt and translations
        have closed forms. Infinite eigenvalues and round-off in stiff shapes stopped the solution at some speeds."""
        k, mass, across, polar, arm = 1974.0, 0.15, 2500.0, 1250.0, 500.0
        ground = [line for g, x in ((201, -arm), (211, arm)) for line in (
            f"GRID,{g},,0.,0.,{x}", *(f"CELAS2,{g + 20 * c},{k},{g},{c}" for c in (1, 2)),
            *(f"CDAMP2,{g + 20 * c + 50},1.-6,{g},{c}" for c in (1, 2)), f"SPC1,1,36,{g - 200}",
            f"RBE2,{g + 50},{g - 200},12,{g}")]
        bulk = ["ROTORG,11,1,6,11", "ROTORD,99,0.,200.,118,FIX,-1.,,CPS", ",NO,1.-5,2", ",,11,,1,0.,0.",
                "CORD2R,1,,0.,0.,0.,0.,0.,1.", ",1.,0.,0.", "EIGRL,1,,,2", "EIGC,2,LAN,,,,,4",
                "PBAR,9,9,7853.98,4.909+6,4.909+6,9.817+6", "MAT1,9,2.+9,,.3", "GRID,1,,0.,0.,-500.", "GRID,6,,0.,0.,0.",
                "GRID,11,,0.,0.,500.", "CBAR,1,9,1,6,1.,0.,0.", "CBAR,2,9,6,11,1.,0.,0.", f"CONM2,60,6,,{mass}",
                f",{across},,{across},,,{polar}", *ground]
        rigid, tilt = math.sqrt(2 * k / mass), 2 * k * arm**2
        forward = math.sqrt(tilt / (across - polar))
        backward = math.sqrt(tilt / (across + polar))
        for sol in (110, 107):
            self.write("d.bdf", "\n".join([f"SOL {sol}", "CEND", "SPC=1", "METHOD=1", "CMETHOD=2", "RMETHOD=99",
                                           "BEGIN BULK", *bulk, "ENDDATA"]))
            result = json.loads(self.bough("modes", "d.bdf", "--json").stdout)["rotors"]
            speeds = sorted(p["speed"] for p in result["critical_speeds"])
            np.testing.assert_allclose(speeds, sorted([rigid, rigid, backward, forward]), rtol=2e-5, err_msg=str(sol))

    def test_overdamped(self):
        """Synchronous, M λ² + (c_e + 2 c_i) λ + k = 0 backward: a critical speed below ζ = 1/√2 alone; no count of instability."""
        for ratio, number in ((0.6, 2), (0.8, 1)):
            internal = ratio * math.sqrt(STIFF * MASS)
            bulk = ["RSPINR,7,1,5,FREQ,1.", f",0.,0.,{internal / STIFF:.12e}", "RGYRO,5,SYNC,7,FREQ"]
            with self.subTest(ratio):
                result = self.modes(make_jeffcott(107, ["RGYRO = 5"], bulk), 6)
                backward = OMEGA * complex(-ratio, math.sqrt(1 - ratio**2))
                poles = [complex(m["eigenvalue"]["real"], m["eigenvalue"]["imag"]) for m in result["modes"]]
                self.assertLess(min(abs(p - backward) for p in poles), 1e-7 * OMEGA)
                # The disc with more polar inertia than across has no forward tilt: λ real, above 0 too.
                self.assertTrue(any(p.imag == 0 and p.real > 1 for p in poles), poles)
                speeds = [p["speed"] for p in result["rotors"]["critical_speeds"] if p["speed"] < 1.01 * OMEGA]
                np.testing.assert_allclose(speeds, ([backward.imag] if number == 2 else []) + [OMEGA], rtol=1e-7)
                self.assertNotIn("unstable", self.bough("modes", "d.bdf").stdout)

    def test_negative_rate(self):
        """Forward is along the spin: the slower precession of a top is backward, whichever way the rate is given."""
        for spin in ("RSPINR,8,16,17,FREQ,-8.", "RSPINR,8,17,16,FREQ,8.", "RSPINR,8,16,17,FREQ,8."):
            with self.subTest(spin):
                bulk = ["RSPINR,7,1,5,FREQ,1.", "RGYRO,5,ASYNC,7,FREQ,,,1.", *make_top(spin)]
                result = self.modes(make_jeffcott(107, ["RGYRO = 5"], bulk), 4)
                found = {}
                for sign in (-1, 1):
                    hz = calc_precession(16 * math.pi, sign) / 2 / math.pi
                    found[sign] = min(result["modes"], key=lambda m: abs(m["frequency_hz"] - hz))
                    self.assertAlmostEqual(found[sign]["frequency_hz"], hz, delta=1e-7 * hz)
                self.assertEqual([round(found[sign]["whirl"], 6) for sign in (-1, 1)], [-1, 1])
        make = lambda bulk: make_friswell_deck(6, EQUAL, DISCS, ["RGYRO = 5"], bulk)
        still = self.modes(make(["RGYRO,5,ASYNC,1,RPM,,,-4000."]))
        self.assertEqual([round(m["whirl"], 6) for m in still["modes"]], [-1, 1] * 4)
        self.assertAlmostEqual(still["speed"], -4000 * RPM, places=9)

    def test_tied_disc(self):
        """A disc at a grid that RBE2 or RBE3 ties to the rotor, either end dependent: named, and the speeds of one at rest."""
        disc, tied = "CONM2,9,3,,", ["GRID,30,,.6,.1,0.", "CONM2,90,30,,.1", ",.5,,.3,,,.3"]
        for tie in ("RBE2,31,3,123456,30", "RBE3,31,,30,123456,1.,123456,3", "RBAR,31,3,30,123456,,,123456"):
            bulk = ["RSPINR,7,1,5,FREQ,1.", "RGYRO,5,ASYNC,7,FREQ,,,10.", *tied, tie]
            with self.subTest(tie):
                self.modes(make_jeffcott(107, ["RGYRO = 5"], bulk))
                self.assertIn("modal.rotor-tied", self.messages)
                self.assertIn(f"CONM2 90 at grid 30, which {tie.split(',')[0]} 31 ties to rotor 7, is not on the rotor", self.messages)
        # A pin that passes no moments ties no rotation, nor does a bearing.
        for tie in ("RBE2,31,3,123,30", "CELAS2,31,1.+6,3,2,30,2"):
            self.modes(make_jeffcott(107, ["RGYRO = 5"], ["RSPINR,7,1,5,FREQ,1.", "RGYRO,5,ASYNC,7,FREQ,,,10.", *tied, tie,
                                                          "CELAS2,32,1.+3,30,4", "CELAS2,33,1.+3,30,5", "CELAS2,34,1.+3,30,6",
                                                          "CELAS2,35,1.+3,30,1", "CELAS2,36,1.+3,30,3"]))
            self.assertNotIn("modal.rotor-tied", self.messages)
        self.assertIn(disc, make_jeffcott(107, [], []))

    def test_other_analyses(self):
        """Real modes leave rotors out: the cards are named with the analyses that take them. A written deck has them."""
        bulk = ["RSPINR,7,1,5,FREQ,1.", "RGYRO,5,ASYNC,7,FREQ,,,10."]
        self.write("d.bdf", make_jeffcott(103, ["RGYRO = 5"], bulk))
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "e.bdf")
        for deck in ("d.bdf", "e.bdf"):
            messages = self.bough("modes", deck).stderr
            for card in ("ROTORG", "RSPINR", "RGYRO"):
                self.assertRegex(messages, card + r" is not read .*; rotors spin in SOL 107, 108, 110 and 111 alone")
        self.assertIn("RGYRO spins rotors in SOL 107, 108, 110 and 111", self.bough("modes", "d.bdf").stderr)

    def test_random_of_one_subcase(self):
        """RANDOM by modes of two subcases, one with a rotor: the warning names the subcase without a response."""
        bulk = ["RSPINR,7,1,5,FREQ,1.", "RGYRO,5,ASYNC,7,FREQ,,,10.", "FREQ,4,2.,3.", "RLOAD1,3,4,,,1.", "DAREA,4,3,2,1.",
                "RANDPS,6,1,1,1.", "RANDPS,6,2,2,1."]
        self.write("d.bdf", make_jeffcott(111, ["DLOAD = 3", "FREQUENCY = 4", "RANDOM = 6", "SUBCASE 1", "SUBCASE 2", "RGYRO = 5"], bulk))
        messages = self.bough("frequency", "d.bdf", code=1).stderr
        self.assertIn("RANDPS relates subcases without a response: 2", messages)
        self.assertIn("correct what fails", messages)

    def test_phases_of_a_listing(self):
        """Phases of gyroscopic modes are 0, 90, 180 and 270 degrees but for round-off: none is printed as 360 or -0."""
        self.write("d.bdf", make_friswell_deck(6, EQUAL, DISCS, ["RGYRO = 5", "DISPLACEMENT(PHASE) = ALL"], ["RGYRO,5,ASYNC,1,RPM,,,4000."]))
        self.bough("modes", "d.bdf", "--f06", "d.f06")
        text = self.read("d.f06")
        self.assertIn("9.000000E+01", text)
        self.assertNotIn("3.600000E+02", text)
        self.assertNotRegex(text, r"-0\.0+(E[+]00)?\s")

    def test_whirl_of_a_system(self):
        """A wheel on a bushing along a skew axis: motion along and about the axis has no whirl, the rest has."""
        e, alpha, k = np.array([0.6, 0.0, 0.8]), math.atan2(-0.8, 0.6), [9e4, 2e4, 2e4, 70.0, 40.0, 40.0]
        turned = [0.0, alpha, 0.0]
        self.write("wheel.toml", toml(
            section("parameters", rate=50.0),
            table("body", "frame", mass=2.0, cg=[0.0, 0.0, 0.0], inertia=[0.03, 0.03, 0.03],
                  nodes=[{"id": 1, "position": [0.1 * c for c in e]}]),
            table("hinge", "float", "free", child="frame"),
            table("body", "wheel", mass=1.0, inertia=[0.04, 0.02, 0.02]),
            table("hinge", "spin", "revolute", parent="frame", child="wheel", parent_rotation=turned, axis=[1.0, 0.0, 0.0],
                  rate="$rate"),
            table("force", "bush", "bushing", body="frame", stiffness=k, rotation=turned, to_rotation=turned),
            table("sensor", "tip", "position", body="frame", node=1),
            section("simulation", duration=1.0)))
        self.bough("linearize", "wheel.toml", "--sweep", "rate=50:100:2", "--spin-axis", *e, "-o", "w.h5")
        imag, whirl = self.read_arrays("w.h5", "poles/imag", "poles/whirl")
        axial, twist, across = math.sqrt(k[0] / 3), math.sqrt(k[3] / 0.03), math.sqrt(k[1] / 3)
        for row, speed in ((0, 50.0), (1, 100.0)):
            with self.subTest(speed):
                find = lambda omega: np.where(np.abs(imag[row] - omega) < 1e-5 * omega)[0]
                for omega in (axial, twist):
                    self.assertEqual(whirl[row, find(omega)].tolist(), [0.0], (omega, imag[row]))
                self.assertEqual(len(find(across)), 2)
                tilt = [(sign * 0.04 * speed + math.sqrt((0.04 * speed)**2 + 4 * 0.05 * k[4])) / 0.1 for sign in (-1, 1)]
                self.assertEqual([[round(w, 4) for w in whirl[row, find(omega)]] for omega in tilt], [[-1], [1]])


if __name__ == "__main__":
    unittest.main()
