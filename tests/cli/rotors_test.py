"""Rotors of decks (ROTORG, RSPINR, RGYRO, ROTORD, UNBALNC): book, closed forms, dense NumPy matrices of another formulation."""
import json
import math
import re
import unittest

import h5py
import numpy as np
from scipy.optimize import brentq

from support import ProgramTest
from rotors import (DENSITY, DIAMETER, KAPPA, LENGTH, RPM, Rotor, make_disc, make_friswell, make_friswell_deck, number, solve,
                    springs)

DISCS = ((0.5, 0.28), (1.0, 0.35))
EQUAL = [(0, *springs(1e6)), (1.5, *springs(1e6))]
CROSSED = [(place, [[1e6, 5e5], [-5e5, 1e6]], [[1e3, 0], [0, 1e3]]) for place in (0, 1.5)]
# Bearings, discs and printed frequencies at 0 and 4000 rpm [rad/s] of Friswell et al. 2010, 5.9, from six elements.
BOOK = {
    "5.9.1": (EQUAL, DISCS, [86.66, 86.66, 274.31, 274.31, 716.78], [85.39, 87.80, 251.78, 294.71, 600.18, 827.08]),
    "5.9.2": ([(0, *springs(1e6, 0.8e6)), (1.5, *springs(1e6, 0.8e6))], DISCS, [82.65, 86.66, 254.52, 274.31, 679.49],
              [82.33, 86.86, 239.64, 287.25, 583.49]),
    "5.9.9": ([(0, *springs(1e7)), (1.0, *springs(1e7))], ((1.5, 0.35),), [90.14, 90.14, 630.73, 630.73, 830.43],
              [76.19, 103.91, 565.99, None, 647.75, 1174.2]),
    "5.9.5": ([(0, *springs(1e6, c=3e3)), (1.5, *springs(1e6, c=3e3))], DISCS,
              [2 * math.pi * f for f in (13.89, 13.89, 46.54, 46.54, 103.22)],
              [2 * math.pi * f for f in (13.68, 14.07, 41.98, 50.65, 104.25)]),
}


def pair(p):
    return complex(p["real"], p["imag"])


# A disc of mass 3 on a massless shaft between rigid bearings: k = 48 EI / L^3.
EI, SPAN, MASS = 2e3, 1.2, 3.0
STIFF = 48 * EI / SPAN**3


def make_jeffcott(sol, case, bulk, external=0.0, ge=0.0, polar=0.02):
    return "\n".join([f"SOL {sol}", "CEND", "SPC = 1", "METHOD = 1", "CMETHOD = 2", *case, "BEGIN BULK", "EIGRL,1,,,20",
                      "EIGC,2,LAN,,,,,2", "PBAR,1,1,1.-3,2.-8,2.-8,4.-8", f"MAT1,1,1.+11,,.3,,,,{ge}",
                      *[f"GRID,{i + 1},,{i * SPAN / 4},0.,0." for i in range(5)],
                      *[f"CBAR,{i},1,{i},{i + 1},0.,1.,0." for i in range(1, 5)],
                      f"CONM2,9,3,,{MASS}", f",{polar},,{polar / 2},,,{polar / 2}",
                      *([f"CDAMP2,{20 + c},{external},3,{c}" for c in (2, 3)] if external else []),
                      "SPC1,1,123,1,5", "SPC1,1,14,1,THRU,5", "ROTORG,7,1,THRU,5", *bulk, "ENDDATA", ""])


class Rotors(ProgramTest):
    def modes(self, deck, *options):
        self.write("d.bdf", deck)
        result = self.bough("modes", "d.bdf", "--json", *options)
        self.messages = result.stderr
        return json.loads(result.stdout)

    def poles(self, deck, *options):
        self.result = self.modes(deck, *options)
        return np.array([pair(m["eigenvalue"]) for m in self.result["modes"] if m["eigenvalue"]["imag"] > 0])

    def near(self, found, expected, relative=1e-7):
        n = min(len(found), len(expected))
        self.assertGreaterEqual(n, 1)
        np.testing.assert_allclose(found[:n], expected[:n], rtol=relative, atol=relative * abs(expected[n - 1]))

    def test_book(self):
        """Six elements: printed digits of the book, and dense matrices of Nelson's beam to round-off; SOL 107 and 110."""
        for name, (bearings, discs, *printed) in BOOK.items():
            rotor = make_friswell(6, bearings, discs)
            for rpm, targets in zip((0.0, 4000.0), printed):
                expected = solve(*rotor.matrices(rpm * RPM))
                with self.subTest(name, rpm=rpm):
                    for sol in (107, 110):
                        found = self.poles(make_friswell_deck(6, bearings, discs, ["RGYRO = 5"], [f"RGYRO,5,ASYNC,1,RPM,,,{rpm}"], sol))
                        self.near(found[:6], expected, 1e-7)
                    for value, target in zip(found.imag, targets):
                        target = target or value  # one is not printed
                        self.assertLess(abs(value - target), (2e-3 if name == "5.9.5" else 3e-4) * target, (name, rpm, found))
        listed = self.result["rotors"]["rotors"][0]
        discs = [make_disc(outer, place) for place, outer in DISCS]
        shaft = DENSITY * math.pi * DIAMETER**2 / 4 * LENGTH
        self.assertEqual((listed["id"], listed["grids"], listed["elements"]), (1, 7, 8))
        self.assertAlmostEqual(listed["mass"], shaft + sum(d[1] for d in discs), delta=1e-6)
        self.assertAlmostEqual(listed["polar_inertia"], shaft * DIAMETER**2 / 8 + sum(d[2] for d in discs), delta=1e-6)

    def test_whirl(self):
        """Backward below forward of each pair at 4000 rpm: orbits of the shapes; of unequal bearings ellipses."""
        deck = make_friswell_deck(6, EQUAL, DISCS, ["RGYRO = 5"], ["RGYRO,5,ASYNC,1,RPM,,,4000."])
        self.poles(deck)
        self.assertEqual([round(m["whirl"], 6) for m in self.result["modes"]], [-1, 1] * 4)
        text = self.bough("modes", "d.bdf").stdout
        self.assertEqual([line.split()[-1] for line in text.split("not below 0\n")[1].splitlines()[:5]],
                         ["whirl", "backward", "forward", "backward", "forward"])
        # The rotor turns the other way: so do the modes, seen along the same axis of basic; relative to the spin not.
        turned = deck.replace("RSPINR,1,1,7", "RSPINR,1,7,1")
        self.near(self.poles(turned), solve(*make_friswell(6, EQUAL, DISCS).matrices(4000 * RPM)))
        self.assertEqual([round(m["whirl"], 6) for m in self.result["modes"]], [-1, 1] * 4)
        bearings = BOOK["5.9.2"][0]
        self.poles(make_friswell_deck(6, bearings, DISCS, ["RGYRO = 5"], ["RGYRO,5,ASYNC,1,RPM,,,4000."]))
        _, shapes = solve(*make_friswell(6, bearings, DISCS).matrices(4000 * RPM), vectors=True)
        for j, mode in enumerate(self.result["modes"][:6]):
            y, z = shapes[0::4, j], shapes[1::4, j]
            i = np.argmax(np.abs(y)**2 + np.abs(z)**2)
            self.assertAlmostEqual(mode["whirl"], -2 * (np.conj(y[i]) * z[i]).imag / (abs(y[i])**2 + abs(z[i])**2), places=6)

    def test_skew_axes(self):
        """A rotor along a skew axis, everything in coordinate systems: poles, whirl and response of the one along x."""
        bearings, turned = BOOK["5.9.2"][0], lambda deck: re.sub(r"(?m)^(GRID,\d+),,(.*)$", r"\1,9,\2,9", re.sub(
            r"(?m)^(CONM2,\d+,\d+),,", r"\1,9,", deck)).replace("BEGIN BULK", "BEGIN BULK\nCORD2R,9,,.1,.2,.3,.5,-.7,1.1\n,.9,.4,.2")
        deck = make_friswell_deck(6, bearings, DISCS, ["RGYRO = 5"], ["RGYRO,5,ASYNC,1,RPM,,,4000."])
        self.near(self.poles(turned(deck)), solve(*make_friswell(6, bearings, DISCS).matrices(4000 * RPM)))
        whirl = [m["whirl"] for m in self.result["modes"]]
        self.poles(deck)
        np.testing.assert_allclose(whirl, [m["whirl"] for m in self.result["modes"]], atol=1e-6)
        driven = make_friswell_deck(6, BOOK["5.9.5"][0], DISCS, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4", "DISPLACEMENT = ALL"],
                                    ["RGYRO,5,SYNC,1,RPM", "UNBALNC,3,3.-3,5,0.,1.,0.", ",.2,,.04", "FREQ,4,20.,45."], 108)
        found = []
        for one in (driven, turned(driven)):
            self.write("d.bdf", one)
            self.bough("frequency", "d.bdf", "-o", "d.h5")
            found.append(self.curves("d.h5", 3))
        np.testing.assert_allclose(found[1], found[0], rtol=1e-7)

    def test_crossed_bearings(self):
        """Bearings that couple y and z by K2PP: 5.9.4 as printed, in Hz at rest; skew coupling makes forward whirl unstable."""
        coupled = [(place, [[1e6, 5e5], [5e5, 1e6]], [[0, 0], [0, 0]]) for place in (0, 1.5)]
        for rpm in (0.0, 4000.0):
            found = self.poles(make_friswell_deck(6, coupled, DISCS, ["RGYRO = 5", "K2PP = KBRG"],
                                                  [f"RGYRO,5,ASYNC,1,RPM,,,{rpm}"]))
            self.near(found[:6], solve(*make_friswell(6, coupled, DISCS).matrices(rpm * RPM)))
            if rpm == 0:
                np.testing.assert_allclose(found[:6].imag / 2 / math.pi, [11.66, 14.80, 33.97, 49.19, 97.97, 126.61], atol=6e-3)
        rotor = make_friswell(6, CROSSED, DISCS)
        for rpm in (0.0, 4000.0):
            expected = solve(*rotor.matrices(rpm * RPM))
            found = self.poles(make_friswell_deck(6, CROSSED, DISCS, ["RGYRO = 5", "K2PP = KBRG"],
                                                  [f"RGYRO,5,ASYNC,1,RPM,,,{rpm}"]))
            self.near(found[:6], expected)
            self.assertGreater(found.real.max(), 0.1)

    def test_campbell(self):
        """RSPEED and ROTORD: the same branches, critical speeds by a root of the dense matrices and by SYNC, plot."""
        rotor = make_friswell(6, EQUAL, DISCS)
        deck = make_friswell_deck(6, EQUAL, DISCS, ["RGYRO = 5"], ["RGYRO,5,ASYNC,1,RPM,,,8", "RSPEED,8,0.,500.,20"])
        result = self.modes(deck, "-o", "d.h5")["rotors"]
        campbell = result["campbell"]
        speeds = np.array(campbell["speed"])
        np.testing.assert_allclose(speeds, np.arange(21) * 500 * RPM, rtol=1e-14)
        whirl = np.array(campbell["whirl"])
        for k in (1, 8, 20):
            order = np.argsort(campbell["imag"][k])
            self.near(np.array(campbell["imag"][k])[order][:6], solve(*rotor.matrices(speeds[k])).imag)
        self.assertGreater(np.array(campbell["correlation"])[2:].min(), 0.9)
        self.assertTrue(np.all(np.abs(np.abs(whirl[1:, :6]) - 1) < 1e-6))
        self.assertTrue(np.all(np.sign(whirl[1:]) == np.sign(whirl[1])))
        branch = lambda k: lambda speed: solve(*rotor.matrices(speed)).imag[k] - speed
        critical = [brentq(branch(k), 1, 10000 * RPM, xtol=1e-9) for k in range(5)]
        found = [p["speed"] for p in result["critical_speeds"]]
        np.testing.assert_allclose(found[:5], critical, rtol=1e-8)
        synchronous = self.modes(deck.replace("RGYRO,5,ASYNC,1,RPM,,,8", "RGYRO,5,SYNC,1,RPM,0.,10000."))["rotors"]
        np.testing.assert_allclose([p["speed"] for p in synchronous["critical_speeds"]][:5], critical, rtol=1e-7)
        self.assertEqual([round(p["whirl"]) for p in synchronous["critical_speeds"]][:4], [-1, 1, -1, 1])
        limited = self.modes(deck.replace("RGYRO,5,ASYNC,1,RPM,,,8", "RGYRO,5,SYNC,1,RPM,1000.,2600."))["rotors"]
        np.testing.assert_allclose([p["speed"] for p in limited["critical_speeds"]], critical[2:3], rtol=1e-7)
        # Simcenter's card, speeds in Hz.
        nx = deck.replace("RGYRO = 5", "RMETHOD = 9").replace("RSPEED,8,0.,500.,20", "CORD2R,4,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n"
            "ROTORD,9,0.,8.33333333333,21,FIX,-1.,CPS,CPS\n,NO\n,1,1,1.,4")
        np.testing.assert_allclose(self.modes(nx)["rotors"]["campbell"]["imag"], campbell["imag"], rtol=1e-6)
        self.bough("plot", "d.h5", "--kind", "campbell", "-o", "d.svg", "--csv", "d.csv")
        svg = self.read("d.svg")
        self.assertIn("1/rev", svg)
        self.assertIn("forward", svg)
        self.assertIn("backward", svg)
        rows = [line.split(",") for line in self.read("d.csv").splitlines()[1:]]
        self.assertEqual(len({r[0] for r in rows}), np.array(campbell["imag"]).shape[1])
        with h5py.File(self.path("d.h5")) as f:
            np.testing.assert_array_equal(f["campbell/imag"][:], campbell["imag"])
            np.testing.assert_array_equal(f["critical/speed"][:], found)
        self.near(self.poles(deck)[:4], solve(*rotor.matrices(speeds[-1])))  # shapes of the last speed

    def test_internal_damping(self):
        """Jeffcott rotor: unstable above ω (1 + c_e/c_i), whether c_i is of ALPHAR2, GR, GE or PARAM,G."""
        omega, external, internal = math.sqrt(STIFF / MASS), 20.0, 25.0
        threshold = omega * (1 + external / internal)
        rate = internal / STIFF
        ways = {"ALPHAR2": (f",0.,0.,{rate:.12e}", 0.0, "", []),
                "GR": (f",.02,0.,0.,{.02 / rate:.12e}", 0.0, "", []),
                "GE": (f",0.,0.,0.,0.,{.03 / rate:.12e}", 0.03, "", []),
                "WR3": (",.04", 0.0, f"PARAM,WR3,{.04 / rate:.12e}", [])}
        for name, (damping, ge, param, _) in ways.items():
            with self.subTest(name):
                bulk = ["RSPINR,7,1,5,FREQ,1.", damping, "RGYRO,5,ASYNC,7,FREQ,,,8", "RSPEED,8,0.,5.,20", param]
                result = self.modes(make_jeffcott(107, ["RGYRO = 5"], bulk, external, ge))["rotors"]
                self.assertEqual(len(result["thresholds"]), 1, result["thresholds"])
                self.assertAlmostEqual(result["thresholds"][0]["speed"], threshold, delta=1e-7 * threshold)
                self.assertAlmostEqual(result["thresholds"][0]["whirl"], 1, places=6)
                # Poles at each speed: M λ² + (c_e + c_i) λ + k ∓ i Ω c_i, forward and backward.
                campbell = result["campbell"]
                for k in (0, 7, 20):
                    speed = campbell["speed"][k]
                    for sign in (1, -1):
                        roots = np.roots([MASS, external + internal, STIFF - sign * 1j * speed * internal])
                        root = roots[np.argmax(roots.imag)]
                        gaps = [abs(complex(*p) - root) for p in zip(campbell["real"][k], campbell["imag"][k])]
                        self.assertLess(min(gaps), 1e-7 * abs(root), (name, speed, root))
        bulk = ["RSPINR,7,1,5,FREQ,1.", ",.02", "RGYRO,5,ASYNC,7,FREQ,,,20."]
        plain = self.poles(make_jeffcott(107, ["RGYRO = 5"], bulk))
        self.assertIn("modal.rotor-damping", self.messages)
        self.near(np.abs(plain), np.full(2, omega))
        # Structural damping of the rotor is no fixed damping.
        self.poles(make_jeffcott(107, ["RGYRO = 5"], [*bulk, "PARAM,G,.1"], ge=0.05))
        self.assertLess(abs(self.result["modes"][0]["damping"]), 1e-9)

    def test_unbalance(self):
        """m e ω² / (k - M ω² + iω c_e + i (ω - Ω) c_i): direct and modal, synchronous and at a speed, tables, ranges."""
        external, internal = 20.0, 25.0
        rate = internal / STIFF
        hz = np.array([2., 6., 10., 14.])
        omega = 2 * math.pi * hz
        for sync, sol in ((True, 108), (True, 111), (False, 108), (False, 111)):
            speed = omega if sync else 2 * math.pi * 5.0
            expected = 2e-3 * omega**2 / (STIFF - MASS * omega**2 + 1j * omega * external + 1j * (omega - speed) * internal)
            expected = expected * np.exp(1j * math.radians(30))
            bulk = ["RSPINR,7,1,5,FREQ,1.", f",0.,0.,{rate:.12e}",
                    "RGYRO,5,SYNC,7,FREQ" if sync else "RGYRO,5,ASYNC,7,FREQ,,,5.", "FREQ,4,2.,6.,10.,14.",
                    "UNBALNC,3,.02,3,0.,2.,0.", ",.1,30."]
            deck = make_jeffcott(sol, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4", "DISPLACEMENT = ALL"], bulk, external)
            if sol == 108:  # weights in place of masses
                deck = deck.replace("UNBALNC,3,.02,", "PARAM,WTMASS,.5\nUNBALNC,3,.04,").replace(f",,{MASS}\n,0.02,,0.01,,,0.01", f",,{2 * MASS}\n,0.04,,0.02,,,0.02")
                self.assertIn(f",,{2 * MASS}\n", deck)
            self.write("d.bdf", deck)
            self.bough("frequency", "d.bdf", "-o", "d.h5")
            with self.subTest(sync=sync, sol=sol):
                y, z = self.curves("d.h5", 3)
                np.testing.assert_allclose(y, expected, rtol=2e-8)
                np.testing.assert_allclose(z, -1j * expected, rtol=2e-8)
        # A DLOAD card scales, a table gives the mass, FON and FOFF limit; GR acts as i g (1 - Ω/ω).
        bulk = ["RSPINR,7,1,5,FREQ,1.", ",.05", "RGYRO,5,ASYNC,7,FREQ,,,5.", "FREQ,4,2.,6.,10.,14.", "DLOAD,30,2.,1.5,3",
                "UNBALNC,3,8,3,0.,2.,0.", ",.1,30.,,3.,12.", "TABLED1,8", ",0.,.01,20.,.05,ENDT"]
        for sol in (108, 111):
            self.write("d.bdf", make_jeffcott(sol, ["RGYRO = 5", "DLOAD = 30", "FREQUENCY = 4", "DISPLACEMENT = ALL"], bulk, external))
            self.bough("frequency", "d.bdf", "-o", "d.h5")
            mass = np.where((hz > 3) & (hz < 12), 3 * (.01 + .04 * hz / 20), 0)
            g = .05 * (1 - 2 * math.pi * 5 / omega)
            expected = .1 * mass * omega**2 / (STIFF * (1 + 1j * g) - MASS * omega**2 + 1j * omega * external) * np.exp(1j * math.radians(30))
            np.testing.assert_allclose(self.curves("d.h5", 3)[0], expected, rtol=2e-8, atol=1e-18)

    def test_unbalance_against_the_axis(self):
        """An unbalance turns with its rotor: a negative rate, by SPEED or by the ratio to the reference, turns it back."""
        external, internal = 20.0, 25.0
        hz = np.array([2., 6., 10., 14.])
        omega = 2 * math.pi * hz
        other = ["ROTORG,8,16,17", "GRID,16,,0.,1.,0.", "GRID,17,,1.,1.,0.", "CONM2,60,16,,1.", ",.02,,.01,,,.01", "CELAS2,61,5.,16,5",
                 "CELAS2,62,5.,16,6", "SPC1,1,1234,16", "SPC1,1,123456,17", "RSPINR,8,16,17,FREQ,1."]
        ways = {"ASYNC": ["RSPINR,7,1,5,FREQ,1.", "RGYRO,5,ASYNC,7,FREQ,,,-5."], "SYNC": ["RSPINR,7,1,5,FREQ,-1.", "RGYRO,5,SYNC,8,FREQ"],
                "reversed": ["RSPINR,7,5,1,FREQ,1.", "RGYRO,5,SYNC,8,FREQ"], "DDVAL": ["RSPINR,7,1,5,FREQ,61", "DDVAL,61,3.,-17.",
                "RGYRO,5,SYNC,8,FREQ"]}
        for way, cards in ways.items():
            for sol in (108, 111):
                rotor = [cards[0], f",0.,0.,{internal / STIFF:.12e}", *cards[1:], *other]
                if way == "DDVAL":  # 3 - ω/2π: forward below 3 Hz, backward above
                    rotor = [card.replace("FREQ,1.", "FREQ,62") for card in rotor] + ["DDVAL,62,0.,20."]
                self.write("d.bdf", make_jeffcott(sol, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4", "DISPLACEMENT = ALL"],
                                                  [*rotor, "FREQ,4,2.,6.,10.,14.", "UNBALNC,3,.02,3,0.,2.,0.", ",.1,30."], external))
                stderr = self.bough("frequency", "d.bdf", "-o", "d.h5").stderr
                self.assertEqual("modal.unbalance-rate" in stderr, way == "DDVAL", stderr)
                speed = {"ASYNC": 2 * math.pi * 5, "DDVAL": abs(2 * math.pi * 3 - omega)}.get(way, omega)
                expected = 2e-3 * omega**2 / (STIFF - MASS * omega**2 + 1j * omega * external + 1j * (omega - speed) * internal)
                expected = expected * np.exp(1j * math.radians(30))
                with self.subTest(way, sol=sol):
                    y, z = self.curves("d.h5", 3)
                    np.testing.assert_allclose(y, expected, rtol=2e-8)
                    forward = np.where(hz < 3, 1, -1) if way == "DDVAL" else -1
                    np.testing.assert_allclose(z, -1j * forward * expected, rtol=2e-8)

    def curves(self, file, grid):
        """Displacement y and z of a grid over frequency."""
        with h5py.File(self.path(file)) as f:
            group = f["subcases/1/displacement"]
            dofs, values = group["dofs"][:].tolist(), group["real"][:] + 1j * group["imag"][:]
        return [values[:, dofs.index([grid, component])] for component in (2, 3)]

    def test_unbalanced_couple(self):
        """ZOFFSET: a couple at a disc tilts the shaft; dense matrices with gyroscopic moments."""
        rotor = make_friswell(6, BOOK["5.9.5"][0], DISCS)
        hz, speed = 20.0, 3000 * RPM
        omega = 2 * math.pi * hz
        M, B, K = rotor.matrices(speed)
        i = 4 * rotor.find(1.0)
        f = np.zeros(len(M), complex)
        force = 3e-3 * .2 * omega**2
        f[i:i + 2] = force * np.array([1, -1j])
        f[i + 2:i + 4] = .04 * force * np.array([1, 1j])     # x̂ × (ŷ - i ẑ) = ẑ + i ŷ
        expected = np.linalg.solve(K + 1j * omega * B - omega**2 * M, f)
        for sol in (108, 111):
            self.write("d.bdf", make_friswell_deck(6, BOOK["5.9.5"][0], DISCS, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4",
                "DISPLACEMENT = ALL"], ["RGYRO,5,ASYNC,1,RPM,,,3000.", "UNBALNC,3,3.-3,5,0.,1.,0.", ",.2,,.04", f"FREQ,4,{hz}"], sol))
            self.bough("frequency", "d.bdf", "-o", "d.h5")
            for grid in (1, 3, 5):
                y, z = self.curves("d.h5", grid)
                np.testing.assert_allclose([y[0], z[0]], expected[4 * (grid - 1):4 * (grid - 1) + 2], rtol=1e-7)

    def test_two_rotors(self):
        """Coaxial rotors on an intershaft bearing: speeds by DDVAL of both, in ratio by numbers, against block matrices."""
        I, area, rho = 3e-8, 6e-4, 7800.0
        make = lambda places, disc: Rotor(places, 2e11 * I, KAPPA * 7.7e10 * area, rho * area, rho * I, [disc])
        inner, outer = make(np.linspace(0, 1, 5), (0.5, 8.0, .05, .03)), make(np.linspace(.25, .75, 3), (0.5, 5.0, .06, .04))
        inner.add_bearing(0, 1e6 * np.eye(2))
        inner.add_bearing(1, 1e6 * np.eye(2))
        outer.add_bearing(.25, 2e6 * np.eye(2))
        joint, k = (inner.find(.75), outer.find(.75)), 1.5e6
        def matrices(first, second):
            (M1, B1, K1), (M2, B2, K2) = inner.matrices(first), outer.matrices(second)
            M, B, K = (np.block([[a, np.zeros((len(a), len(b)))], [np.zeros((len(b), len(a))), b]])
                       for a, b in ((M1, M2), (B1, B2), (K1, K2)))
            for c in (0, 1):
                i, j = 4 * joint[0] + c, len(M1) + 4 * joint[1] + c
                K[[i, j], [i, j]] += k
                K[i, j] -= k
                K[j, i] -= k
            return M, B, K
        f = number
        grids = [f"GRID,{i + 1},,{x},0.,0." for i, x in enumerate(np.linspace(0, 1, 5))]
        grids += [f"GRID,{i + 11},,{x},0.,0." for i, x in enumerate(np.linspace(.25, .75, 3))]
        beams = [f"CBEAM,{i},1,{i},{i + 1},0.,1.,0." for i in (1, 2, 3, 4, 11, 12)]
        bearings = [f"CELAS2,{100 + 10 * g + c},{f(k)},{g},{c}" for g, k in ((1, 1e6), (5, 1e6), (11, 2e6)) for c in (2, 3)]
        bearings += [f"CELAS2,{300 + c},{f(1.5e6)},4,{c},13,{c}" for c in (2, 3)]
        deck = "\n".join(["SOL 107", "CEND", "SPC = 1", "METHOD = 1", "CMETHOD = 2", "RGYRO = 5", "BEGIN BULK", "PARAM,COUPMASS,1",
            "EIGRL,1,,,20", "EIGC,2,LAN,,,,,6", f"PBEAM,1,1,{f(area)},{f(I)},{f(I)},,{f(2 * I)}", ",", ",YES,1.", ",",
            f",{f(KAPPA)},{f(KAPPA)}", f"MAT1,1,2.+11,7.7+10,,{rho}", *grids, *beams, *bearings, "SPC1,1,14,1,THRU,5",
            "SPC1,1,14,11,THRU,13", "CONM2,50,3,,8.", ",.05,,.03,,,.03", "CONM2,51,12,,5.", ",.06,,.04,,,.04",
            "ROTORG,1,1,THRU,5", "ROTORG,2,11,12", "ROTORG,2,13", "{bulk}", "ENDDATA", ""])
        ratio = ["RSPINR,1,1,5,RPM,1000.", "RSPINR,2,11,13,FREQ,-25.", "RGYRO,5,ASYNC,1,RPM,,,6000."]
        table = ["RSPINR,1,1,5,RPM,61", "RSPINR,2,11,13,RPM,62", "RGYRO,5,ASYNC,1,RPM,,,6000.", "DDVAL,61,0.,3000.,9000.",
                 "DDVAL,62,500.,2000.,11000."]
        for bulk, second in ((ratio, -9000), (table, 6500)):
            found = self.poles(deck.replace("{bulk}", "\n".join(bulk)))
            self.near(found, solve(*matrices(6000 * RPM, second * RPM)))
        # Synchronous with an offset of the second rotor: Ω2 = 500 rpm + 0.5 Ω1.
        line = [*table[:2], "RGYRO,5,SYNC,1,RPM", "DDVAL,61,0.,3000.", "DDVAL,62,500.,2000."]
        points = self.modes(deck.replace("{bulk}", "\n".join(line)))["rotors"]["critical_speeds"]
        for j, point in enumerate(points[:4]):
            speed = point["speed"]
            values = solve(*matrices(speed, 500 * RPM + .5 * speed)).imag
            self.assertLess(np.abs(values - speed).min(), 1e-7 * speed)
        self.fails_with(deck.replace("{bulk}", "\n".join([*table[:2], "RGYRO,5,SYNC,1,RPM", *table[3:]])), "modal.rotor-speeds", "line")
        self.fails_with(deck.replace("{bulk}", "\n".join([*table[:4], "DDVAL,62,1."])), "modal.rotor-speeds", "3")
        shared = deck.replace("{bulk}", "\n".join(ratio)).replace("ROTORG,2,13", "ROTORG,2,13,3")
        self.fails_with(shared, "modal.rotor-shared", "grid 3")

    def fails_with(self, deck, error, *says):
        """The error with the file and a line."""
        self.write("d.bdf", deck)
        command = "frequency" if "SOL 108" in deck or "SOL 111" in deck else "modes"
        result = self.fails(1, command, "d.bdf", error=error, says=list(says))
        self.assertRegex(result.stderr, r"d\.bdf:\d+: error: ")

    def test_bad_input(self):
        ok = ["RSPINR,7,1,5,FREQ,1.", "RGYRO,5,ASYNC,7,FREQ,,,5."]
        make = lambda bulk, case="RGYRO = 5", **more: make_jeffcott(107, [case], bulk, **more)
        self.poles(make(ok))
        for bulk, error, *says in (
                (ok[:1], "modal.missing-rotor", "RGYRO = 5"),
                (ok[1:], "modal.missing-rotor", "no RSPINR", "GRIDA"),
                ([ok[0], "RGYRO,5,ASYNC,8,FREQ,,,5."], "modal.missing-rotor", "REFROTR 8"),
                ([ok[0], "RGYRO,5,ASYNC,7,FREQ,,,9"], "modal.missing-rotor", "RSPEED"),
                (["RSPINR,7,1,5,FREQ,9", ok[1]], "modal.missing-rotor", "SPTID 9"),
                (["RSPINR,7,1,6,FREQ,1.", ok[1]], "modal.rotor-line", "ROTORG does not list"),
                ([*ok, "RSPINR,8,1,5,FREQ,1."], "modal.missing-rotor", "rotor 8"),
                ([*ok, "ROTORG,8,99", "RSPINR,8,1,5,FREQ,1."], "modal.rotor-line", "99"),
                ([*ok, "ROTORG,7,6", "GRID,6,,.3,.01,0.", "SPC1,1,123456,6"], "modal.rotor-line", "grid 6", "0.01"),
                (["RSPINR,7,1,5,HERTZ,1.", ok[1]], "deck.bad-word", "SPDUNIT"),
                (["RSPINR,7,1,5,FREQ,1.", ",,,,,,,3", ok[1]], "deck.field-range", "HYBRID"),
                ([ok[0], "RGYRO,5,SYNCH,7,FREQ"], "deck.bad-word", "SYNC"),
                ([*ok, "CBAR,77,2,3,6,1.,0.,0.", "GRID,6,,.6,.1,0.", "SPC1,1,123456,6", "PBAR,2,2,1.-4,1.-9,1.-9,1.-9",
                  "MAT1,2,1.+9,,.3,5."], "modal.rotor-element", "CBAR 77"),
                ([*ok, "ROTORG,7,6", "GRID,6,,.45,0.,0.", "SPC1,1,123456,6"], "", "")):
            with self.subTest(bulk):
                deck = make(bulk)
                if error:
                    self.fails_with(deck, error, *says)
                else:
                    self.poles(deck)
        for bulk, error, *says in (
                ("ROTORD,9,0.,1.,2", "deck.missing-field", "RSET"),
                ("ROTORD,9,0.,1.,2,ROT\n,\n,1,7\n,2,7", "deck.field-range", "several rotors"),
                ("ROTORD,9,0.,1.,2,FIX", "deck.missing-field", "RSET"),
                ("ROTORD,9,0.,1.,2,FIX\n,\n,1,8,,4", "modal.missing-rotor", "RSET 8"),
                ("ROTORD,9,0.,1.,2,FIX\n,\n,1,7", "modal.rotor-line", "from the axis"),
                ("ROTORD,8,0.,1.,2,FIX\n,\n,1,7", "modal.missing-rotor", "RMETHOD = 9")):
            self.fails_with(make([bulk], "RMETHOD = 9"), error, *says)
        for bulk, error, *says in (
                ("UNBALNC,3,.02,9,0.,2.,0.", "modal.unbalance-grid", "grid 9"),
                ("UNBALNC,3,.02,3,2.,0.,0.", "modal.unbalance-grid", "along the axis"),
                ("UNBALNC,3,8,3,0.,2.,0.", "modal.missing-table", "table 8"),
                ("UNBALNC,3,,3,0.,2.,0.", "deck.missing-field", "MASS")):
            self.fails_with(make_jeffcott(108, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4"], [*ok, "FREQ,4,2.", bulk]), error, *says)
        driven = ["DLOAD = 3", "RGYRO = 5", "TSTEP = 4"]
        over_time = make_jeffcott(112, driven, [*ok, "TSTEP,4,10,.01", "TLOAD1,3,4,,,1.", "DAREA,4,3,2,1."])
        self.write("d.bdf", over_time)
        self.fails(1, "transient", "d.bdf", error="modal.rotor-unsupported", says=["over time"])
        self.write("d.bdf", make_jeffcott(111, ["DLOAD = 3", "RGYRO = 5", "FREQUENCY = 4", "RANDOM = 6"],
                                          [*ok, "FREQ,4,2.,3.", "RLOAD1,3,4,,,1.", "DAREA,4,3,2,1.", "RANDPS,6,1,1,1."]))
        self.fails(1, "frequency", "d.bdf", error="modal.rotor-unsupported", says=["RANDOM"])
        self.bough("frequency", "d.bdf", "--direct")
        # Other analyses name what they do not read; --ignore computes without the rotor.
        self.write("d.bdf", make(ok))
        self.bough("modes", "d.bdf", "--ignore", "RGYRO", "--json")
        self.write("d.bdf", make(ok).replace("PBAR,1,1,1.-3,2.-8,2.-8", "PBAR,1,1,1.-3,2.-8,3.-8"))
        self.assertIn("modal.rotor-asymmetric", self.bough("modes", "d.bdf").stderr)
        fixed = make_jeffcott(108, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4", "SPCFORCES = ALL"],
                              [*ok, "FREQ,4,2.", "UNBALNC,3,.02,3,0.,2.,0."])
        self.write("d.bdf", fixed)
        self.assertIn("modal.rotor-reaction", self.bough("frequency", "d.bdf").stderr)

    def test_lost_modes(self):
        """A top on negative springs that spins down, as the reference rotor spins up, no longer precesses: named."""
        bulk = ["RSPINR,7,1,5,FREQ,61", "RSPINR,8,16,17,FREQ,62", "DDVAL,61,0.,10.", "DDVAL,62,100.,0.", "RGYRO,5,ASYNC,7,FREQ,,,9",
                "RSPEED,9,0.,10.,1", "ROTORG,8,16,17", "GRID,16,,0.,1.,0.", "GRID,17,,1.,1.,0.", "CONM2,60,16,,1.",
                ",.02,,.01,,,.01", "CELAS2,61,-5.,16,5", "CELAS2,62,-5.,16,6", "SPC1,1,1234,16", "SPC1,1,123456,17"]
        deck = make_jeffcott(107, ["RGYRO = 5"], bulk).replace("EIGC,2,LAN,,,,,2", "EIGC,2,LAN,,,,,4")
        campbell = self.modes(deck)["rotors"]["campbell"]
        self.assertIn("modal.rotor-lost", self.messages)
        np.testing.assert_allclose(campbell["imag"], np.full((2, 2), math.sqrt(STIFF / MASS)), rtol=1e-6)
        spin = 200 * math.pi * .02
        top = [(spin + sign * math.sqrt(spin**2 - 4 * .01 * 5)) / .02 for sign in (-1, 1)]
        still = self.poles(deck.replace("FREQ,,,9", "FREQ,,,0."))
        np.testing.assert_allclose(sorted(still.imag), sorted([*top, *[math.sqrt(STIFF / MASS)] * 2]), rtol=1e-6)

    def test_system(self):
        """The discs as bodies that turn on a still flexible shaft give the same poles."""
        # Without the gyroscopic moments of the shaft, and its rotary inertia.
        expected = self.poles(make_friswell_deck(6, EQUAL, DISCS, ["RGYRO = 5"], ["RGYRO,5,ASYNC,1,RPM,,,4000."], bars=True))
        still = make_friswell_deck(6, EQUAL, (), [], [], 103, rotor=False, bars=True)
        self.write("shaft.bdf", still)
        self.write("shaft.toml", '[body]\nname = "shaft"\ndeck = "shaft.bdf"\nframe = "fixed"\ninterface = [1, 3, 5, 7]\n'
                   '[body.modes]\nbasis = "craig-bampton"\nnumber = 12\n[body.output]\nfile = "shaft.h5"\n')
        self.bough("reduce", "shaft.toml")
        text = ('[[body]]\nname = "shaft"\nfile = "shaft.h5"\n[[hinge]]\nname = "frame"\ntype = "fixed"\nchild = "shaft"\n'
                '[parameters]\nrate = 400.0\n[[function]]\nname = "angle"\ntype = "ramp"\nvalue = "$rate"\nfrom = 0\nto = 1\n'
                '[simulation]\nduration = 0.5\noutput_step = 0.001\n'
                '[[sensor]]\nname = "station"\ntype = "position"\nbody = "shaft"\nnode = 3\n')
        for place, outer in DISCS:
            _, m, polar, across = make_disc(outer, place)
            grid = 1 + round(place / LENGTH * 6)
            text += (f'[[body]]\nname = "disc{grid}"\nmass = {m!r}\ncg = [0, 0, 0]\ninertia = [{polar!r}, {across!r}, {across!r}]\n'
                     f'[[hinge]]\nname = "spin{grid}"\ntype = "revolute"\nparent = "shaft"\nparent_node = {grid}\n'
                     f'child = "disc{grid}"\naxis = [1, 0, 0]\nmotion = "angle"\n')
        self.write("rotor.toml", text)
        result = json.loads(self.bough("linearize", "rotor.toml", "--at", 0.1, "--sweep", f"rate=100:{4000 * RPM!r}:3", "--spin-axis", 1, 0, 0,
                                       "-o", "sweep.h5", "--json").stdout)
        poles = result["poles"]
        upper = sorted((y, w) for y, w in zip(poles["imag"][-1], poles["whirl"][-1]) if y > 1)
        np.testing.assert_allclose([y for y, _ in upper[:6]], expected.imag[:6], rtol=2e-5)
        np.testing.assert_allclose([w for _, w in upper[:6]], [m["whirl"] for m in self.result["modes"]][:6], atol=1e-5)
        self.assertIn("backward", self.bough("linearize", "rotor.toml", "--at", 0.1, "--sweep", "rate=100:400:2", "--spin-axis", 1, 0, 0).stdout)
        self.bough("plot", "sweep.h5", "--kind", "campbell", "-o", "d.svg")
        self.assertIn("backward", self.read("d.svg"))
        self.fails(2, "linearize", "rotor.toml", "--at", 0.1, "--spin-axis", 1, 0, 0, error="cli.bad-axis", says=["--sweep"])
        self.fails(2, "linearize", "rotor.toml", "--sweep", "rate=1:2:2", "--spin-axis", 0, 0, 0, error="cli.bad-axis", says=["zero"])
        self.write("blind.toml", text.split("[[sensor]]")[0] + text[text.index('[[body]]\nname = "disc'):])
        self.fails(1, "linearize", "blind.toml", "--at", 0.1, "--sweep", "rate=1:2:2", "--spin-axis", 1, 0, 0, error="linear.no-orbit", says=["sensor"])

    def test_units(self):
        """Millimetres and milliseconds: frequencies a thousandth, displacements a thousandfold; rpm are known by the minute alone."""
        bulk = ["RSPINR,7,1,5,FREQ,1.", ",.02,0.,1.-3,40.,50.", "RGYRO,5,ASYNC,7,FREQ,,,5.", "FREQ,4,2.,6.", "DLOAD,30,2.,1.5,3",
                "UNBALNC,3,8,3,0.,2.,0.", ",.1,30.,,1.,12.", "TABLED1,8", ",0.,.01,20.,.05,ENDT"]
        deck = make_jeffcott(108, ["RGYRO = 5", "DLOAD = 30", "FREQUENCY = 4", "DISPLACEMENT = ALL"], bulk, 20.0, 0.01)
        self.write("d.bdf", deck)
        self.bough("frequency", "d.bdf", "-o", "d.h5")
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-kg-ms", "-o", "n.bdf")
        converted = self.read("n.bdf")
        self.assertNotIn("UNBALNC,3,8,3,0.,2.,0.\n,.1,30.,,1.,12.", converted)
        # The masses of a table have no dimension: kg remain kg here.
        self.bough("frequency", "n.bdf", "-o", "n.h5")
        np.testing.assert_allclose(self.curves("n.h5", 3)[0], 1e3 * self.curves("d.h5", 3)[0], rtol=1e-6)
        self.write("d.bdf", make_jeffcott(107, ["RGYRO = 5"], ["RSPINR,7,1,5,RPM,1.", "RGYRO,5,ASYNC,7,RPM,,,8", "RSPEED,8,0.,100.,2",
                                                              "DDVAL,99,1.,2."]))
        before = self.modes(self.read("d.bdf"))["rotors"]["campbell"]["imag"]
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-N-tonne", "-o", "n.bdf")
        np.testing.assert_allclose(self.modes(self.read("n.bdf"))["rotors"]["campbell"]["imag"], before, rtol=1e-6)
        self.write("d.bdf", make_jeffcott(107, ["RGYRO = 5"], ["RSPINR,7,1,5,RPM,1.", "RGYRO,5,ASYNC,7,RPM,,,300."]))
        self.fails(1, "convert", "d.bdf", "--units", "m-kg-s:mm-kg-ms", "-o", "n.bdf", error="deck.unit-field", says=["RGYRO"])
        nx = make_jeffcott(107, ["RMETHOD = 9"], ["CORD2R,4,,0.,0.,0.,1.,0.,0.", ",0.,1.,0.", "ROTORD,9,0.,5.,3,FIX,5.,CPS", ",NO",
                                                  ",1,7,2.,4,30.,40."], ge=0.02)
        before = np.array(self.modes(nx)["rotors"]["campbell"]["imag"])
        self.assertAlmostEqual(self.result_speed(), 10 * math.pi)
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-kg-ms", "-o", "n.bdf")
        np.testing.assert_allclose(self.modes(self.read("n.bdf"))["rotors"]["campbell"]["imag"], 1e-3 * before, rtol=1e-6)

    def result_speed(self):
        return json.loads(self.bough("modes", "d.bdf", "--json").stdout)["speed"]


if __name__ == "__main__":
    unittest.main()
