"""Frequency and transient response of decks: closed forms, and SciPy on the matrices that `bough matrices` writes."""
import csv
import json
import os
import sys
import unittest

import h5py
import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import csr_matrix

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "python"))
sys.path.insert(0, os.path.join(SOURCE, "tests", "oracle"))
import uff_reader  # noqa: E402

# m = 4, k = 36 to a fixed grid, c = 2.4: moves along x.
ONE = """SOL {sol}
CEND
SPC = 1
METHOD = 1
{case}
SET 1 = 1, 2
DISPLACEMENT = 1
VELOCITY = 1
ACCELERATION = 1
SPCFORCES = 1
FORCE = ALL
BEGIN BULK
EIGRL,1,,,1
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CONM2,1,1,,4.0
CELAS2,2,36.0,1,1,2,1
SPC1,1,23456,1
SPC1,1,123456,2
{bulk}
ENDDATA
"""
M, K, C = 4.0, 36.0, 2.4

# Three masses that move along x: 1 - 2 - 3 to ground, dampers that no mode shape makes diagonal.
CHAIN = """SOL {sol}
CEND
SPC = 1
METHOD = 1
{case}
DISPLACEMENT = ALL
ACCELERATION = ALL
SPCFORCES = ALL
BEGIN BULK
EIGRL,1,,,{modes}
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
GRID,4,,3.,0.,0.
CONM2,11,1,,1.0
CONM2,12,2,,2.0
CONM2,13,3,,3.0
CELAS2,21,100.0,1,1,2,1,0.05
CELAS2,22,200.0,2,1,3,1
CELAS2,23,300.0,3,1,4,1
CDAMP2,24,1.5,1,1,2,1
CDAMP2,25,0.4,3,1,4,1
SPC1,1,23456,1,2,3
SPC1,1,123456,4
{bulk}
ENDDATA
"""

# A bent frame of consistent mass, one grid in axes of its own (in which v of CBAR 3 is (0, 0, 1)), a bush that damps.
FRAME = """SOL 111
CEND
SPC = 1
METHOD = 1
FREQUENCY = 5
DLOAD = 9
DISPLACEMENT = ALL
SPCFORCES = ALL
BEGIN BULK
PARAM,COUPMASS,1
PARAM,G,.02
EIGRL,1,,,{modes}
FREQ1,5,3.,17.3,9
CORD2R,7,,0.,0.,0.,2.,-2.,1.
,1.,2.,2.
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.,{cd}
GRID,4,,2.,1.,0.
GRID,5,,2.,2.,.5
MAT1,1,7.+10,,.3,2700.,,,.05
MAT1,2,7.+10,,.3,2700.
PBAR,1,1,1.-4,2.-8,1.-8,1.5-8
PBAR,2,2,1.-4,1.-8,3.-8,1.5-8
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
CBAR,3,2,3,4,{v}
CBAR,4,2,4,5,0.,0.,1.
CONM2,9,5,,.3
PBUSH,8,K,2.+3,,,,,
,,B,40.,20.
CBUSH,26,8,5,,,,,0
SPC1,1,123456,1
RLOAD2,9,10,.01,30.,3,4
DAREA,10,4,3,2.5
DAREA,10,2,2,-1.
FORCE,10,5,0,3.,1.,0.,1.
TABLED1,3
,0.,1.,100.,2.,300.,2.,ENDT
TABLED4,4,0.,100.,0.,200.
,10.,20.,ENDT
ENDDATA
"""


def read(path):
    """Subcase (1 where the deck numbers none) -> quantity -> (grid, component) -> samples, complex over frequency; x under "x"."""
    found = {}
    with h5py.File(path) as f:
        for name, group in f["subcases"].items():
            one = found[int(name) or 1] = {"x": (group["frequency_hz"] if "frequency_hz" in group else group["time"])[()]}
            for quantity in ["displacement", "velocity", "acceleration", "spc_force"]:
                if quantity not in group:
                    continue
                part = group[quantity]
                values = part["value"][()] if "value" in part else part["real"][()] + 1j * part["imag"][()]
                one[quantity] = {tuple(dof): values[:, i] for i, dof in enumerate(part["dofs"][()])}
            if "elements" in group:
                one["elements"] = {}
                for card, part in group["elements"].items():
                    values = part["value"][()] if "value" in part else part["real"][()] + 1j * part["imag"][()]
                    one["elements"][card] = (list(part["id"][()]), values)
            one["modes"] = {key: value[()] for key, value in group.get("modes", {}).items()}
    return found


class DeckResponse(ProgramTest):
    def solve(self, verb, deck, *options):
        self.write("d.bdf", deck)
        self.bough(verb, "d.bdf", "-o", "d.h5", *options)
        return read(self.path("d.h5"))

    def near(self, found, expected, relative=1e-10):
        expected = np.asarray(expected) * np.ones(np.shape(found))
        self.assertLess(np.abs(found - expected).max(), relative * np.abs(expected).max())


class OneMass(DeckResponse):
    def frequency(self, bulk, case="", load="RLOAD1,9,10,,,1.0\nDAREA,10,1,1,2.5", lists="FREQ1,5,.05,.03,30"):
        deck = ONE.format(sol=111, case="DLOAD = 9\nFREQUENCY = 5\n" + case, bulk=f"{load}\n{lists}\n{bulk}")
        r = self.solve("frequency", deck)[1]
        return r, 2 * np.pi * r["x"]

    def test_viscous(self):
        r, w = self.frequency("CDAMP2,3,2.4,1,1,2,1")
        u = 2.5 / (K - M * w**2 + 1j * C * w)
        self.near(r["displacement"][1, 1], u)
        self.near(r["velocity"][1, 1], 1j * w * u)
        self.near(r["acceleration"][1, 1], -w**2 * u)
        self.near(r["spc_force"][2, 1], -(K + 1j * C * w) * u)
        ids, force = r["elements"]["CELAS2"]
        self.assertEqual(ids, [2])
        self.near(np.abs(force[:, 0, 0]), np.abs(K * u))
        self.assertEqual(r["displacement"][2, 1].max(), 0)
        self.near(r["modes"]["damping_ratio"], C / 2 / np.sqrt(K * M))

    def test_structural(self):
        u = lambda w, g: 2.5 / (K * (1 + 1j * g) - M * w**2)
        r, w = self.frequency("PARAM,G,.07")
        self.near(r["displacement"][1, 1], u(w, .07))
        self.near(r["spc_force"][2, 1], -K * (1 + .07j) * u(w, .07))
        self.write("d.bdf", "")
        deck = ONE.replace("36.0,1,1,2,1", "36.0,1,1,2,1,.03").format(
            sol=111, case="DLOAD = 9\nFREQUENCY = 5", bulk="PARAM,G,.07\nRLOAD1,9,10,,,1.0\nDAREA,10,1,1,2.5\nFREQ,5,.4,.5")
        r = self.solve("frequency", deck)[1]
        self.near(r["displacement"][1, 1], u(2 * np.pi * r["x"], .1))

    def test_damping_table(self):
        """G, CRIT and Q at the natural frequency, between and beyond the points."""
        hz = 3 / 2 / np.pi
        for kind, value, zeta in [("G", .06, .03), ("CRIT", .03, .03), ("Q", 20., .025)]:
            table = f"TABDMP1,6,{kind}\n,{hz - .1},{value - .01},{hz + .1},{value + .01},ENDT"
            r, w = self.frequency(table, "SDAMPING = 6")
            u = 2.5 / (K - M * w**2 + 2j * zeta * np.sqrt(K * M) * w)
            self.near(r["displacement"][1, 1], u)
            r, w = self.frequency(table + "\nPARAM,KDAMP,-1", "SDAMPING = 6")
            self.near(r["displacement"][1, 1], 2.5 / (K * (1 + 2j * zeta) - M * w**2))
        r, w = self.frequency("TABDMP1,6,CRIT\n,1.,.02,2.,.03,ENDT", "SDAMPING = 6")
        self.near(r["modes"]["damping_ratio"], .02 + .01 * (hz - 1))

    def test_loads(self):
        """RLOAD1 with both tables, RLOAD2, delay and phase as numbers and as sets, DLOAD, static loads, LSEQ."""
        damper = "CDAMP2,3,2.4,1,1,2,1\n"
        H = lambda w: 1 / (K - M * w**2 + 1j * C * w)
        tables = "TABLED1,3\n,0.,1.,1.,3.,ENDT\nTABLED2,4,.5\n,0.,1.,1.,-1.,ENDT\n"
        c, d = (lambda f: 1 + 2 * f), (lambda f: 1 - 2 * (f - .5))
        r, w = self.frequency(damper + tables, load="RLOAD1,9,10,.2,25.,3,4\nDAREA,10,1,1,2.5")
        f = r["x"]
        turn = np.exp(1j * (np.radians(25) - w * .2))
        self.near(r["displacement"][1, 1], 2.5 * (c(f) + 1j * d(f)) * turn * H(w))
        sets = "DELAY,21,1,1,.2\nDPHASE,22,1,1,25.\n"
        r, w = self.frequency(damper + tables + sets, load="RLOAD1,9,10,21,22,3,4\nDAREA,10,1,1,2.5")
        self.near(r["displacement"][1, 1], 2.5 * (c(f) + 1j * d(f)) * turn * H(w))
        r, w = self.frequency(damper + tables, load="RLOAD2,9,10,,,3,4\nFORCE,10,1,0,2.5,1.,0.,0.")
        self.near(r["displacement"][1, 1], 2.5 * c(f) * np.exp(1j * np.radians(d(f))) * H(w))
        r, w = self.frequency(damper + tables, load="DLOAD,9,2.,3.,11,-1.,12\nRLOAD1,11,10,,,1.\nRLOAD1,12,13,,,3\n"
                                                    "DAREA,10,1,1,2.5\nSLOAD,13,1,.5")
        self.near(r["displacement"][1, 1], 2 * (3 * 2.5 - .5 * c(f)) * H(w))
        r, w = self.frequency(damper + "LSEQ,40,10,77\nFORCE,77,1,0,1.5,1.,0.,0.", "LOADSET = 40",
                              "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.5")
        self.near(r["displacement"][1, 1], 4.0 * H(w))

    def test_tables(self):
        """LOG axes, TABLED3, a jump (its mean), what goes on beyond the ends."""
        H = lambda w: 2.5 / (K - M * w**2 + 1j * C * w)
        load = "CDAMP2,3,2.4,1,1,2,1\nRLOAD2,9,10,,,3\nDAREA,10,1,1,2.5\n"
        for table, exact in [("TABLED1,3,LOG,LOG\n,.1,2.,1.,20.,ENDT", lambda f: 20 * f),
                             ("TABLED1,3,LOG\n,.1,2.,1.,3.,ENDT", lambda f: 3 + np.log10(f)),
                             ("TABLED3,3,.1,2.\n,0.,1.,.1,2.,ENDT", lambda f: 1 + 5 * (f - .1)),
                             ("TABLED1,3\n,0.,1.,.2,1.,.2,3.,.4,3.\n,ENDT", lambda f: np.select([f < .19, f < .21], [1, 2], 3)),
                             ("TABLED1,3\n,1.,1.,.5,2.,SKIP,SKIP,0.,4.\n,ENDT", lambda f: np.where(f < .5, 4 - 4 * f, 3 - 2 * f))]:
            r, w = self.frequency(table, load=load, lists="FREQ,5,.05,.1,.2,.3,.7,1.4")
            self.near(r["displacement"][1, 1], exact(r["x"]) * H(w))

    def test_frequency_lists(self):
        hz = 3 / 2 / np.pi
        x = lambda lists: self.frequency("CDAMP2,3,2.4,1,1,2,1", lists=lists)[0]["x"]
        np.testing.assert_allclose(x("FREQ,5,.7,.1,.4"), [.1, .4, .7], rtol=1e-14)
        np.testing.assert_allclose(x("FREQ1,5,.1,.2,3"), [.1, .3, .5, .7], rtol=1e-14)
        np.testing.assert_allclose(x("FREQ2,5,.1,1.6,4"), [.1, .2, .4, .8, 1.6], rtol=1e-14)
        np.testing.assert_allclose(x("FREQ3,5,.1,1.,,3,2."), [.1, (.1 + hz) / 2, hz, (hz + 1) / 2, 1.], rtol=1e-12)
        found = x("FREQ3,5,.1,1.,LOG,5,2.")
        xi = np.sign([-1, -.5, 0, .5, 1]) * np.sqrt(np.abs([-1, -.5, 0, .5, 1]))
        np.testing.assert_allclose(found[:5], np.exp((np.log(.1) + np.log(hz)) / 2 + np.log(hz / .1) / 2 * xi),
                                   rtol=1e-12)
        np.testing.assert_allclose(x("FREQ4,5,.1,1.,.2,5"), hz * np.array([.8, .9, 1, 1.1, 1.2]), rtol=1e-12)
        np.testing.assert_allclose(x("FREQ5,5,.1,1.,.5,1.,1.5"), hz * np.array([.5, 1, 1.5]), rtol=1e-12)
        # Between F1 and F2 counts what comes out, not the mode it comes from (MSC Quick Reference Guide).
        np.testing.assert_allclose(x(f"FREQ5,5,.01,{1.2 * hz:.6f},.5,1.,1.5"), hz * np.array([.5, 1]), rtol=1e-12)
        np.testing.assert_allclose(x(f"FREQ5,5,.01,{.8 * hz:.6f},.5,1."), [.5 * hz], rtol=1e-12)
        np.testing.assert_allclose(x(f"FREQ4,5,{1.05 * hz:.6f},1.,.2,5"), hz * np.array([1.1, 1.2]), rtol=1e-12)
        np.testing.assert_allclose(x("FREQ,5,.1,.4\nFREQ1,5,.4,.1,1"), [.1, .4, .5], rtol=1e-12)

    def test_transmissibility(self):
        """The base moves: as a displacement, a velocity, an acceleration."""
        for kind, factor in [("DISP", lambda w: 1), ("VELO", lambda w: 1 / (1j * w)), ("A", lambda w: -1 / w**2), (1, lambda w: 1)]:
            r, w = self.frequency("CDAMP2,3,2.4,1,1,2,1", load=f"RLOAD1,9,10,,,1.0,,{kind}\nSPCD,10,2,1,.3")
            base = .3 * factor(w)
            self.near(r["displacement"][2, 1], base)
            u = base * (K + 1j * C * w) / (K - M * w**2 + 1j * C * w)
            self.near(r["displacement"][1, 1], u)
            self.near(r["acceleration"][1, 1], -w**2 * u)
            self.near(r["spc_force"][2, 1], -M * w**2 * u)

    def transient(self, bulk, case="", load="", steps="TSTEP,5,400,.01"):
        deck = ONE.format(sol=112, case="DLOAD = 9\nTSTEP = 5\n" + case, bulk=f"{load}\n{steps}\n{bulk}")
        r = self.solve("transient", deck)[1]
        return r, r["x"]

    def test_step_and_ramp(self):
        """A step at the start and at a later step, exact without damping and with."""
        w = 3.0
        r, t = self.transient("", load="TLOAD2,9,10,,,0.,9.\nDAREA,10,1,1,2.5")
        self.near(r["displacement"][1, 1], 2.5 / K * (1 - np.cos(w * t)), 1e-11)
        self.near(r["acceleration"][1, 1], 2.5 / M * np.cos(w * t), 1e-11)
        r, t = self.transient("CDAMP2,3,2.4,1,1,2,1", load="TLOAD2,9,10,.5,,.5,9.\nDAREA,10,1,1,2.5")
        z = C / 2 / np.sqrt(K * M)
        wd, s = w * np.sqrt(1 - z * z), np.maximum(t - 1, 0)
        u = 2.5 / K * (1 - np.exp(-z * w * s) * (np.cos(wd * s) + z / np.sqrt(1 - z * z) * np.sin(wd * s)))
        self.near(r["displacement"][1, 1], u, 1e-11)
        v = 2.5 / M * np.exp(-z * w * s) * np.sin(wd * s) / wd
        self.near(r["velocity"][1, 1], v, 1e-11)
        self.near(r["spc_force"][2, 1], -K * u - C * v, 1e-11)
        r, t = self.transient("", load="TLOAD1,9,10,,,3\nDAREA,10,1,1,2.5\nTABLED1,3\n,0.,0.,1.,1.,2.,1.,ENDT")
        ramp = lambda t: np.where(t > 0, t - np.sin(w * t) / w, 0)
        self.near(r["displacement"][1, 1], 2.5 / K * (ramp(t) - ramp(t - 1)), 1e-11)

    def test_sine(self):
        """The error of parabolas over the steps falls as h⁴."""
        errors = []
        for n in [100, 200]:
            r, t = self.transient("", load="TLOAD2,9,10,,,0.,9.,1.,-90.\nDAREA,10,1,1,2.5",
                                  steps=f"TSTEP,5,{n},{4 / n},{n // 100}")
            p, w = 2 * np.pi, 3.0
            exact = 2.5 / (K - M * p**2) * (np.sin(p * t) - p / w * np.sin(w * t))
            self.assertEqual(len(t), 101)
            errors.append(np.abs(r["displacement"][1, 1] - exact).max() / np.abs(exact).max())
        self.assertLess(errors[1], 1e-5)
        self.assertAlmostEqual(errors[0] / errors[1], 16, delta=.5)

    def test_growth(self):
        r, t = self.transient("CDAMP2,3,2.4,1,1,2,1", steps="TSTEP,5,2000,.001,20",
                              load="TLOAD2,9,10,,,.25,1.5,.5,20.,-.8,1.\nDAREA,10,1,1,2.5")
        def force(x):
            s = x - .25
            inside = 0 <= s <= 1.25
            return 2.5 * s * np.exp(-.8 * s) * np.cos(np.pi * s + np.radians(20)) if inside else 0.0
        u = np.zeros(2)
        found = [u]
        for a, b in zip(t[:-1], t[1:]):
            u = solve_ivp(lambda x, y: [y[1], (force(min(max(x, a), b) + (1e-12 if x <= a else 0)) - C * y[1] - K * y[0]) / M],
                          (a, b), u, rtol=1e-10, atol=1e-14).y[:, -1]
            found.append(u)
        self.near(r["displacement"][1, 1], np.array(found)[:, 0], 2e-5)

    def test_start(self):
        r, t = self.transient("CDAMP2,3,2.4,1,1,2,1\nTIC,8,1,1,.1,-.2", "IC = 8", "TLOAD2,9,10,,,50.,90.\nDAREA,10,1,1,1.")
        z, w = C / 2 / np.sqrt(K * M), 3.0
        wd = w * np.sqrt(1 - z * z)
        u = np.exp(-z * w * t) * (.1 * np.cos(wd * t) + (-.2 + z * w * .1) / wd * np.sin(wd * t))
        self.near(r["displacement"][1, 1], u, 1e-11)

    def test_base_motion(self):
        """One motion of the base given three ways; against solve_ivp."""
        damper = "CDAMP2,3,2.4,1,1,2,1\n"
        a = lambda t: .3 * np.minimum(t, 1)   # acceleration, lines between the steps
        v = lambda t: .15 * np.minimum(t, 1)**2 + .3 * np.maximum(t - 1, 0)
        d = lambda t: .05 * np.minimum(t, 1)**3 + .15 * np.maximum(t - 1, 0) + .15 * np.maximum(t - 1, 0)**2
        r, t = self.transient(damper + "TABLED1,3\n,0.,0.,1.,1.,9.,1.,ENDT", load="TLOAD1,9,10,,ACCE,3\nSPCD,10,2,1,.3")
        self.near(r["acceleration"][2, 1], a(t), 1e-11)
        self.near(r["velocity"][2, 1], v(t), 1e-11)
        self.near(r["displacement"][2, 1], d(t), 1e-11)
        exact, rate = solve_ivp(lambda x, y: [y[1], (K * (d(x) - y[0]) + C * (v(x) - y[1])) / M], (0, 4), [0, 0],
                                t_eval=t, rtol=1e-12, atol=1e-14, max_step=.01).y
        self.near(r["displacement"][1, 1], exact, 1e-8)
        self.near(r["spc_force"][2, 1], M * r["acceleration"][1, 1], 1e-9)
        table = lambda y: "TABLED1,3\n" + "".join(f",{x!r},{y(x)!r}\n" for x in np.arange(401) * .01) + ",ENDT"
        for kind, y in [("VELO", v), ("DISP", d)]:
            r, t = self.transient(damper + table(y).replace("np.float64(", "").replace(")", ""),
                                  load=f"TLOAD1,9,10,,{kind},3\nSPCD,10,2,1,1.")
            self.near(r["displacement"][1, 1], exact, 2e-5)
            self.near(r["displacement"][2, 1], d(t), 2e-5)
            self.near(r["velocity"][1, 1], rate, 2e-5)
            self.near(r["acceleration"][1, 1], (K * (d(t) - exact) + C * (v(t) - rate)) / M, 3e-3)

    def test_broken_line(self):
        """A base displacement that is a ramp: exact."""
        r, t = self.transient("", load="TLOAD1,9,10,,DISP,3\nSPCD,10,2,1,.3\nTABLED1,3\n,0.,0.,1.,1.,2.,1.,ENDT")
        w = 3.0
        ramp = lambda t: np.where(t > 0, t - np.sin(w * t) / w, 0)
        self.near(r["displacement"][1, 1], .3 * (ramp(t) - ramp(t - 1)), 1e-11)
        step = self.transient("", load="TLOAD2,9,10,,DISP,0.,9.\nSPCD,10,2,1,.3")[0]
        self.near(step["displacement"][1, 1], .3 * (1 - np.cos(w * t)), 1e-11)

    def test_w3(self):
        r, t = self.transient("PARAM,G,.2\nPARAM,W3,3.", load="TLOAD2,9,10,,,0.,9.\nDAREA,10,1,1,2.5")
        self.near(r["modes"]["damping_ratio"], .1)
        self.write("d.bdf", ONE.format(sol=112, case="DLOAD = 9\nTSTEP = 5",
                                       bulk="PARAM,G,.2\nTLOAD2,9,10,,,0.,9.\nDAREA,10,1,1,2.5\nTSTEP,5,4,.1"))
        self.assertIn("[modal.no-w3]", self.bough("transient", "d.bdf").stderr)


class Chain(DeckResponse):
    M = np.diag([1.0, 2, 3])
    K = np.array([[100.0, -100, 0], [-100, 300, -200], [0, -200, 500]])
    S = .05 * np.array([[100.0, -100, 0], [-100, 100, 0], [0, 0, 0]])
    B = np.array([[1.5, -1.5, 0], [-1.5, 1.5, 0], [0, 0, .4]])
    LOAD = "DAREA,10,1,1,2.\nDAREA,10,3,1,-1."

    def test_coupled(self):
        deck = CHAIN.format(sol=111, modes=3, case="DLOAD = 9\nFREQUENCY = 5", bulk="RLOAD1,9,10,,,1.\nFREQ1,5,0.,.05,80\n" + self.LOAD)
        r = self.solve("frequency", deck)[1]
        for i, f in enumerate(r["x"]):
            w = 2 * np.pi * f
            u = np.linalg.solve(self.K + 1j * self.S + 1j * w * self.B - w * w * self.M, [2, 0, -1])
            self.near([r["displacement"][g, 1][i] for g in (1, 2, 3)], u, 1e-11)
            self.near(r["spc_force"][4, 1][i], -(300 + .4j * w) * u[2], 1e-11)

    def test_residual_vectors(self):
        """One mode: the response to constant loads is static, exactly; with 0 modes more than it would be without."""
        deck = CHAIN.format(sol=111, modes=1, case="DLOAD = 9\nFREQUENCY = 5", bulk="RLOAD1,9,10,,,1.\nFREQ,5,0.,.5\n" + self.LOAD)
        deck = deck.replace(",0.05\n", "\n")
        r = self.solve("frequency", deck)[1]
        u = np.linalg.solve(self.K, [2, 0, -1])
        self.near([r["displacement"][g, 1][0] for g in (1, 2, 3)], u, 1e-11)
        self.assertEqual(r["modes"]["is_residual"].tolist()[0], 0)
        self.assertGreater(sum(r["modes"]["is_residual"]), 0)
        bare = self.solve("frequency", deck, "--no-residuals")[1]
        self.assertGreater(abs(bare["displacement"][1, 1][0] / u[0] - 1), 1e-3)
        self.assertEqual(len(bare["modes"]["is_residual"]), 1)
        asked = self.solve("frequency", deck.replace("METHOD = 1", "METHOD = 1\nRESVEC = NO"))[1]
        self.near(asked["displacement"][1, 1], bare["displacement"][1, 1], 1e-14)

    def test_base(self):
        """An accelerated base against the equations in absolute coordinates; grid 4 is the base."""
        deck = CHAIN.format(sol=111, modes=3, case="DLOAD = 9\nFREQUENCY = 5", bulk="RLOAD1,9,10,,,1.,,ACCE\nFREQ1,5,.2,.1,40\nSPCD,10,4,1,9.81")
        r = self.solve("frequency", deck)[1]
        for i, f in enumerate(r["x"]):
            w = 2 * np.pi * f
            base = -9.81 / w**2
            u = np.linalg.solve(self.K + 1j * self.S + 1j * w * self.B - w * w * self.M, [0, 0, (300 + .4j * w) * base])
            self.near([r["displacement"][g, 1][i] for g in (1, 2, 3)], u, 1e-10)
            self.near(r["spc_force"][4, 1][i], -w * w * np.diag(self.M) @ u, 1e-9)

    def test_transient(self):
        """Coupled damping, loads at two points delayed against each other, two sizes of steps."""
        bulk = ("TLOAD1,9,10,21,,3\nDELAY,21,3,1,.25\nTABLED1,3\n,-9.,0.,0.,0.,.5,1.,1.,-1.\n,1.5,0.,9.,0.,ENDT\n"
                "TSTEP,5,100,.01,2\n,,100,.03\n" + self.LOAD)
        deck = CHAIN.format(sol=112, modes=3, case="DLOAD = 9\nTSTEP = 5", bulk=bulk)
        r = self.solve("transient", deck.replace(",0.05\n", "\n"))[1]
        t = r["x"]
        self.assertEqual(len(t), 151)
        f = lambda x: np.interp(x, [0, .5, 1, 1.5], [0, 1, -1, 0])
        A = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(self.M, self.K), -np.linalg.solve(self.M, self.B)]])
        rate = lambda x, y: A @ y + np.concatenate([np.zeros(3), np.linalg.solve(self.M, [2 * f(x), 0, -f(x - .25)])])
        exact = solve_ivp(rate, (0, t[-1]), np.zeros(6), t_eval=t, rtol=1e-11, atol=1e-13, max_step=.01).y
        for i, g in enumerate((1, 2, 3)):
            self.near(r["displacement"][g, 1], exact[i], 2e-3 if t[-1] > 3 else 1e-8)
        first = t < 1 - 1e-9  # where the corners of the table lie on steps
        for i, g in enumerate((1, 2, 3)):
            self.near(r["displacement"][g, 1][first], exact[i][first], 1e-8)

    def test_transient_w4(self):
        deck = CHAIN.format(sol=112, modes=3, case="DLOAD = 9\nTSTEP = 5",
                            bulk="PARAM,W4,12.\nTLOAD2,9,10,,,0.,9.\nTSTEP,5,200,.01\n" + self.LOAD)
        r = self.solve("transient", deck)[1]
        A = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.linalg.solve(self.M, self.K), -np.linalg.solve(self.M, self.B + self.S / 12)]])
        force = np.concatenate([np.zeros(3), np.linalg.solve(self.M, [2, 0, -1])])
        exact = solve_ivp(lambda x, y: A @ y + force, (0, 2), np.zeros(6), t_eval=r["x"], rtol=1e-11, atol=1e-13).y
        for i, g in enumerate((1, 2, 3)):
            self.near(r["displacement"][g, 1], exact[i], 1e-8)


class NoMass(DeckResponse):
    """A mass, a spring, a point without mass, a damper and a spring beside it to ground; a load on the point."""
    DECK = ("SOL {sol}\nCEND\nSPC = 1\nMETHOD = 1\nDLOAD = 9\n{case}\nDISPLACEMENT = ALL\nBEGIN BULK\nEIGRL,1,,,1\n"
            "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCONM2,1,1,,4.0\nCELAS2,2,36.0,1,1,2,1\nCELAS2,3,20.0,2,1\n"
            "SPC1,1,23456,1,2\nDAREA,10,2,1,2.5\n{bulk}\nENDDATA\n")

    def test_frequency(self):
        r = self.solve("frequency", self.DECK.format(sol=111, case="FREQUENCY = 5",
                                                     bulk="CDAMP2,4,3.,2,1\nRLOAD1,9,10,,,1.\nFREQ1,5,0.,.1,20\nPARAM,G,.1"))[1]
        for i, f in enumerate(r["x"]):
            w = 2 * np.pi * f
            Z = np.array([[36 * (1 + .1j) - 4 * w**2, -36 * (1 + .1j)], [-36 * (1 + .1j), 56 * (1 + .1j) + 3j * w]])
            u = np.linalg.solve(Z, [0, 2.5])
            self.near([r["displacement"][g, 1][i] for g in (1, 2)], u, 1e-11)

    def test_transient(self):
        bulk = "TLOAD2,9,10,,,0.,9.\nTSTEP,5,200,.02\n"
        r = self.solve("transient", self.DECK.format(sol=112, case="TSTEP = 5", bulk=bulk))[1]
        k = 36 * 20 / 56
        u1 = 2.5 * 36 / 56 / k * (1 - np.cos(np.sqrt(k / 4) * r["x"]))
        self.near(r["displacement"][1, 1], u1, 1e-11)
        self.near(r["displacement"][2, 1], (2.5 + 36 * u1) / 56, 1e-11)
        self.write("d.bdf", self.DECK.format(sol=112, case="TSTEP = 5", bulk=bulk + "CDAMP2,4,3.,2,1"))
        self.assertIn("[modal.massless-damper]", self.bough("transient", "d.bdf").stderr)


class Structures(DeckResponse):
    def direct(self, deck, hz, load, g):
        """SciPy on K, M, B of the deck, all in basic; structural damping from a second deck without GE."""
        def matrices(text):
            self.write("m.bdf", text)
            self.bough("matrices", "m.bdf", "-o", "m.h5")
            with h5py.File(self.path("m.h5")) as f:
                get = lambda name: csr_matrix((f[name]["data"][()], f[name]["indices"][()], f[name]["indptr"][()]),
                                              shape=f[name]["shape"][()]).toarray()
                return get("K"), get("M"), get("B"), f["dof_map"][()]
        K, M, B, dofs = matrices(deck)
        # MAT1 1 alone has GE: its bars' share of K by a deck in which they are twice as stiff.
        K_ge = matrices(deck.replace("MAT1,1,7.+10", "MAT1,1,14.+10"))[0] - K
        free = dofs[:, 0] != 1
        u = []
        for f in hz:
            w = 2 * np.pi * f
            Z = K * (1 + 1j * g) + .05j * K_ge + 1j * w * B - w * w * M
            x = np.zeros(len(dofs), complex)
            x[free] = np.linalg.solve(Z[np.ix_(free, free)], load(f, w)[free])
            u.append((x, Z @ x - load(f, w)))
        return dofs, u

    def load(self, dofs):
        F = np.zeros(len(dofs), complex)
        def put(g, c, f):
            F[(dofs[:, 0] == g) & (dofs[:, 1] == c)] += f
        put(4, 3, 2.5)
        put(2, 2, -1.0)
        put(5, 1, 3.0)
        put(5, 3, 3.0)
        return F

    def test_frame(self):
        """All modes against SciPy; then few modes with residual vectors; a grid in axes of its own."""
        r = self.solve("frequency", FRAME.format(modes=30, cd="", v="0.,0.,1."))[1]
        with_cd = self.solve("frequency", FRAME.format(modes=30, cd="7", v="2.,2.,1."))[1]
        self.write("m.bdf", FRAME.format(modes=30, cd="", v="0.,0.,1."))
        self.bough("matrices", "m.bdf", "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            dofs = f["dof_map"][()]
        F = self.load(dofs)
        def load(f, w):
            amplitude = 1 + f / 100 if f < 100 else 2.0
            return F * amplitude * np.exp(1j * (np.radians(10 + 20 * min(f, 200) / 100 + 30) - w * .01))
        dofs, exact = self.direct(FRAME.format(modes=30, cd="", v="0.,0.,1."), r["x"], load, .02)
        for i, (u, reaction) in enumerate(exact):
            found = np.array([r["displacement"][tuple(dof)][i] for dof in dofs])
            self.near(found, u, 1e-8)
            held = [row for row, dof in enumerate(dofs) if dof[0] == 1]
            self.near([r["spc_force"][tuple(dofs[row])][i] for row in held], reaction[held], 1e-8)
        R = np.column_stack([np.array([1, 2, 2]) / 3, np.cross([2, -2, 1], [1, 2, 2]) / 9 * -1, np.array([2, -2, 1]) / 3])
        R[:, 1] = np.cross(R[:, 2], R[:, 0])
        for half in (1, 4):
            cd = np.array([with_cd["displacement"][3, half + c] for c in range(3)])
            basic = np.array([r["displacement"][3, half + c] for c in range(3)])
            self.near(R @ cd, basic, 1e-8)
        few = self.solve("frequency", FRAME.format(modes=6, cd="", v="0.,0.,1."))[1]
        low = r["x"] < few["modes"]["frequency_hz"][4] / 2
        self.near(few["displacement"][5, 1][low], r["displacement"][5, 1][low], 1e-3)

    def test_cantilever(self):
        """Euler-Bernoulli: w(L) = F (sin b cosh b - cos b sinh b) / (EI β³ (1 + cos b cosh b)), b = βL."""
        n, L, E, A, inertia, rho = 40, 2.0, 7e10, 1e-4, 1e-8, 2700.0
        grids = "".join(f"GRID,{i + 1},,{L * i / n},0.,0.\n" for i in range(n + 1))
        bars = "".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0.\n" for i in range(n))
        deck = ("SOL 111\nCEND\nSPC = 1\nMETHOD = 1\nDLOAD = 9\nFREQUENCY = 5\nSET 3 = 41\nDISPLACEMENT = 3\nBEGIN BULK\n"
                "PARAM,COUPMASS,1\nEIGRL,1,,,5\nFREQ,5,1.,5.,20.,60.,90.\nRLOAD1,9,10,,,1.\nDAREA,10,41,2,3.\n"
                f"MAT1,1,{E},,.3,{rho}\nPBAR,1,1,{A},{inertia},{inertia},{inertia}\n"
                f"SPC1,1,123456,1\nSPC1,1,1345,2,THRU,41\n{grids}{bars}ENDDATA\n").replace("1e-08", "1.-8").replace(
                    "0.0001", "1.-4").replace("70000000000.0", "7.+10")
        r = self.solve("frequency", deck)[1]
        w = 2 * np.pi * r["x"]
        beta = (rho * A * w**2 / (E * inertia))**.25
        b = beta * L
        exact = 3 * (np.sin(b) * np.cosh(b) - np.cos(b) * np.sinh(b)) / (E * inertia * beta**3 * (1 + np.cos(b) * np.cosh(b)))
        for found, one in zip(r["displacement"][41, 2], exact):
            self.assertLess(abs(found / one - 1), 2e-5)

    def test_free_body(self):
        """A free beam moves as a rigid body at low frequency, and its inertia and strain agree with all modes."""
        deck = ("SOL 111\nCEND\nMETHOD = 1\nDLOAD = 9\nFREQUENCY = 5\nDISPLACEMENT = ALL\nACCELERATION = ALL\nBEGIN BULK\n"
                "EIGRL,1,,,{modes}\nPARAM,G,.02\nFREQ,5,.01,2.,9.\nRLOAD1,9,10,,,1.\nDAREA,10,3,2,3.\nMAT1,1,7.+10,,.3,2700.\n"
                "PARAM,COUPMASS,1\nPBAR,1,1,1.-4,1.-8,2.-8,1.-8\n"
                + "".join(f"GRID,{i + 1},,{.5 * i},0.,{.1 * i}\n" for i in range(5))
                + "".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0.\n" for i in range(4)) + "ENDDATA\n")
        few = self.solve("frequency", deck.format(modes=8))[1]
        everything = self.solve("frequency", deck.format(modes=30))[1]
        self.near(few["displacement"][5, 2], everything["displacement"][5, 2], 1e-6)
        mass = 2700e-4 * 4 * np.hypot(.5, .1)
        self.near(few["acceleration"][3, 2][:1], 3 / mass, 1e-4)
        cut = self.solve("frequency", deck.format(modes=8).replace("EIGRL,1,,,8", "EIGRL,1,.5,,2"))[1]
        self.assertGreater(cut["modes"]["frequency_hz"].min(), .5)

    def test_static_limit(self):
        """At 0 Hz the response with one mode is that of SOL 101."""
        deck = FRAME.format(modes=1, cd="7", v="2.,2.,1.").replace("FREQ1,5,3.,17.3,9", "FREQ,5,0.").replace("PARAM,G,.02\n", "").replace(
            "2700.,,,.05", "2700.").replace("RLOAD2,9,10,.01,30.,3,4", "RLOAD1,9,11,,,1.").replace("DAREA,10", "DAREA,11").replace(
            "FORCE,10", "FORCE,11")
        r = self.solve("frequency", deck)[1]
        with open(self.path("s.bdf"), "w") as f:
            f.write(deck.replace("SOL 111", "SOL 101").replace("DLOAD = 9", "LOAD = 11").replace(
                "DAREA,11,4,3,2.5", "FORCE,11,4,0,2.5,0.,0.,1.").replace("DAREA,11,2,2,-1.", "FORCE,11,2,0,-1.,0.,1.,0."))
        static = json.loads(self.bough("static", "s.bdf", "--cd", "--json", "--full").stdout)["subcases"][0]
        u = np.array(static["displacement"])
        found = np.array([r["displacement"][tuple(dof)][0] for dof in static["dof_map"]])
        self.near(found, u, 1e-10)


# A chain of eight masses of 0.01 on a large one, which a force drives: the classical way to give a base its motion.
LARGE_MASS = """SOL 111
CEND
SPC = 9
METHOD = 3
DLOAD = 1
FREQUENCY = 1
ACCELERATION = ALL
BEGIN BULK
SPOINT,1,THRU,9
{chain}CMASS2,60,{mass},1,0
DAREA,5,1,0,{force}
RLOAD1,1,5,,,7
TABLED1,7
,0.,1.,1000.,1.,ENDT
EIGRL,3,,,{modes}
FREQ1,1,5.,1.,25
GRID,99,,0.,0.,0.
SPC1,9,123456,99
ENDDATA
"""


class LargeMass(DeckResponse):
    def test_base_by_a_large_mass(self):
        """Against the dense equations: K, C, M of nine dofs, with and without residual vectors."""
        n, k, c, m = 9, 1000.0, .01, .01
        chain = "".join(f"CELAS2,{i},{k},{i},0,{i + 1},0\nCDAMP2,{i + 40},{c},{i},0,{i + 1},0\nCMASS2,{i + 20},{m},{i + 1},0\n"
                        for i in range(1, n))
        for mass in [1e4, 1e6, 1e8, 1e10]:
            K = np.zeros((n, n))
            for i in range(n - 1):
                K[i:i + 2, i:i + 2] += k * np.array([[1, -1], [-1, 1]])
            M = np.diag([mass] + [m] * (n - 1))
            for modes, tolerance in [(4, 2e-3), (9, 1e-6)]:
                with self.subTest(mass=mass, modes=modes):
                    deck = LARGE_MASS.format(chain=chain, mass=mass, force=3 * mass, modes=modes)
                    r = self.solve("frequency", deck)[1]
                    for i, hz in enumerate(r["x"]):
                        w = 2 * np.pi * hz
                        u = np.linalg.solve(K + 1j * w * K * c / k - w * w * M, np.eye(n)[0] * 3 * mass)
                        found = np.array([r["acceleration"][p, 0][i] for p in range(1, n + 1)])
                        self.near(found, -w * w * u, tolerance)


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
