"""Frequency and transient response of decks: closed forms, and SciPy on small systems."""
import unittest

import numpy as np
from scipy.integrate import solve_ivp

from deck_response_case import CHAIN, ONE, C, DeckResponse, K, M


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
                          (a, b), u, rtol=1e-10, atol=1e-14, method="DOP853").y[:, -1]
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
                                t_eval=t, rtol=1e-12, atol=1e-14, max_step=.01, method="DOP853").y
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
        exact = solve_ivp(rate, (0, t[-1]), np.zeros(6), t_eval=t, rtol=1e-11, atol=1e-13, max_step=.01, method="DOP853").y
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
        exact = solve_ivp(lambda x, y: A @ y + force, (0, 2), np.zeros(6), t_eval=r["x"], rtol=1e-11, atol=1e-13, method="DOP853").y
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


if __name__ == "__main__":
    unittest.main()
