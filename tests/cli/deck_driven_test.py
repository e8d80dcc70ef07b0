"""Cards that act in a response and are no load: direct matrices, Rayleigh damping, rejected cards. Motions of supports
against closed forms; loads between steps; starts without loads."""
import unittest

import h5py
import numpy as np

import deck_response_refusals_test as refusals
import deck_response_test as base
from deck_response_case import CHAIN, ONE, DeckResponse

DRIVEN = "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nDAREA,10,3,1,-1.\n"
CASE = "DLOAD = 9\nFREQUENCY = 5\n"


def dmig(name, *terms):
    return f"DMIG,{name},0,6,1,0\n" + "".join(f"DMIG,{name},{i},1,,{j},1,{value!r}\n" for i, j, value in terms)


class DirectInput(DeckResponse):
    M, K, S, B = base.Chain.M, base.Chain.K, base.Chain.S, base.Chain.B

    def frequency(self, case, bulk, *options, modes=3):
        deck = CHAIN.format(sol=111, modes=modes, case=CASE + case, bulk=DRIVEN + "FREQ1,5,.2,.31,12\n" + bulk)
        return self.solve("frequency", deck, *options)[1]

    def check(self, r, K, B, M, relative=1e-10):
        for i, f in enumerate(r["x"]):
            w = 2 * np.pi * f
            u = np.linalg.solve(K + 1j * w * B - w * w * M, [2, 0, -1])
            self.near([r["displacement"][g, 1][i] for g in (1, 2, 3)], u, relative)
            self.near(r["spc_force"][4, 1][i], -(300 + .4j * w + self.ground) * u[2], relative)
    ground = 0

    def test_stiffness(self):
        """K2PP adds to K, PARAM,G does not act on it; 1 mode and residual vectors give the static part."""
        k2 = np.array([[40.0, -15, 0], [-15, 0, 0], [0, 0, 0]])
        cards = dmig("KX", (1, 1, 20.0), (2, 1, -7.5))
        K = self.K + 1j * self.S
        self.check(self.frequency("K2PP = 2.*KX", cards), K + k2, self.B, np.diag(self.M) * np.eye(3))
        self.ground = .06j * 300
        self.check(self.frequency("K2PP = 2.*KX", cards + "PARAM,G,.06\n"), K + .06j * self.K + k2, self.B, self.M)
        self.check(self.frequency("SET 8 = 2.*KX\nK2PP = 8", cards + "PARAM,G,.06\n"), K + .06j * self.K + k2, self.B, self.M)
        # K2GG has PARAM,G.
        self.check(self.frequency("K2GG = KX\nK2PP = KX", cards + "PARAM,G,.06\n"), K + .06j * (self.K + k2 / 2) + k2, self.B, self.M)

    def test_damping_and_mass(self):
        b2 = np.array([[.7, 0, -.2], [0, 0, 0], [-.2, 0, 0]])
        cards = dmig("BX", (1, 1, .7), (3, 1, -.2)) + dmig("MX", (2, 2, 1.5))
        m2 = np.diag([0, 1.5, 0])
        r = self.frequency("B2PP = BX\nM2PP = MX", cards + "PARAM,WTMASS,1.\n")
        self.check(r, self.K + 1j * self.S, self.B + b2, self.M + m2)

    def test_rayleigh(self):
        C = self.B + .3 * self.M + .004 * self.K
        for modes in (3, 1):
            r = self.frequency("", "PARAM,ALPHA1,.3\nPARAM,ALPHA2,.004\n", modes=modes)
            first = r["x"] < 1
            for i, f in enumerate(r["x"]):
                w = 2 * np.pi * f
                u = np.linalg.solve(self.K + 1j * self.S + 1j * w * C - w * w * self.M, [2, 0, -1])
                if modes == 3 or first[i]:
                    self.near([r["displacement"][g, 1][i] for g in (1, 2, 3)], u, 1e-10 if modes == 3 else .02)
                if modes == 3:
                    self.near(r["spc_force"][4, 1][i], -(300 + 1j * w * (.4 + .004 * 300)) * u[2], 1e-10)

    def test_local_structural_damping(self):
        """GE .3 of one of three springs: with one mode and residual vectors the response at low frequency is right."""
        deck = CHAIN.format(sol=111, modes=1, case=CASE, bulk="RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,.01,.1\n")
        deck = deck.replace("3,1,4,1\nCDAMP", "3,1,4,1,.3\nCDAMP").replace("1,1,2,1,0.05", "1,1,2,1")
        deck = "\n".join(line for line in deck.split("\n") if not line.startswith("CDAMP2"))
        r = self.solve("frequency", deck)[1]
        S = np.diag([0, 0, .3 * 300])
        for i, f in enumerate(r["x"]):
            w = 2 * np.pi * f
            u = np.linalg.solve(self.K + 1j * S - w * w * self.M, [2, 0, 0])
            self.near([r["displacement"][g, 1][i] for g in (1, 2, 3)], u, 1e-6)

    def test_refused(self):
        deck = lambda case, bulk: CHAIN.format(sol=111, modes=3, case=CASE + case, bulk=DRIVEN + "FREQ,5,1.\n" + bulk)
        kx = dmig("KX", (1, 1, 20.0))
        for case, bulk, error, says, ignore in [
                ("TFL = 4", "TF,4,3,1,500.,0.,0.\n", "deck.unsupported-command", "TFL is not supported", "TFL"),
                ("TFL = 4", "TF,4,3,1,500.,0.,0.\n", "deck.unsupported-command", "--ignore TFL", "TF"),
                ("K42GG = KX", kx, "deck.unsupported-command", "structural damping", "K42GG"),
                ("NONLINEAR = 4", "NOLIN1,4,1,1,1.,1,1,3\n", "deck.unsupported-command", "depend on the motion", "NOLIN1"),
                ("", "EPOINT,77\n", "deck.unsupported-card", "EPOINT", "EPOINT")]:
            for verb in ("frequency", "transient"):
                self.write("d.bdf", deck(case, bulk))
                self.fails(1, verb, "d.bdf", error=error, says=[says, "d.bdf:"])
            self.assertIn("subcase", self.bough("frequency", "d.bdf", "--ignore", ignore).stdout)
            self.bough("modes", "d.bdf")  # nothing of it acts there
        for case, bulk, says in [("K2PP = KX", kx + "PARAM,CK2,2.\n", "PARAM,CK2"),
                                 ("M2PP = KX", kx + "PARAM,ALPHA1,2.\n", "PARAM,ALPHA1"),
                                 ("M2PP = KX", kx + "GRAV,10,,9.81,1.,0.,0.\n", "GRAV")]:
            self.write("d.bdf", deck(case, bulk))
            self.fails(1, "frequency", "d.bdf", error="modal.direct-input", says=[says, "d.bdf:"])
        self.write("d.bdf", deck("K2PP = KX", kx.replace("KX,0,6", "KX,0,1") + "DMIG,KX,1,1,,2,1,3.\n"))
        self.fails(1, "frequency", "d.bdf", error="fe.direct-not-symmetric", says=["K2PP needs it"])
        self.write("d.bdf", deck("K2PP = KY", kx))
        self.fails(1, "frequency", "d.bdf", error="fe.missing-direct", says=["K2PP selects KY"])
        self.write("d.bdf", deck("", "TF,4,3,1,500.,0.,0.\n"))  # without TFL it does nothing
        self.assertIn("it acts where TFL selects it", self.bough("frequency", "d.bdf").stderr)


BASE = """SOL 112
CEND
SPC = 1
DLOAD = 9
TSTEP = 5
METHOD = 1
SET 7 = 1,2
DISP = 7
VELO = 7
ACCE = 7
SPCF = 7
BEGIN BULK
GRID,1
GRID,2,,0.,0.,1.
SPC1,1,23456,1,2
SPC1,1,1,2
CONM2,5,1,,{m!r}
CELAS2,3,{k!r},1,1,2,1
CDAMP2,4,{c!r},1,1,2,1
EIGRL,1,,,5
{load}
SPCD,10,2,1,1.
TSTEP,5,{n},{h!r}
ENDDATA
"""


class StiffMode(DeckResponse):
    """The base of a mass on a stiff spring moves by 30 Hz; far above it the mass goes with the base."""

    def check(self, f0, zeta, h, load, tolerance, end=.2):
        m = 1e-3
        k, c, w = m * (2 * np.pi * f0)**2, 2 * zeta * m * 2 * np.pi * f0, 2 * np.pi * 30
        r = self.solve("transient", BASE.format(m=m, k=k, c=c, h=h, n=round(end / h), load=load))[1]
        t = r["x"]
        H = (k + 1j * w * c) / (k - w * w * m + 1j * w * c)
        late = t > .1
        exact = -w * w * np.imag(H * np.exp(1j * w * t))
        for found, expected in [(r["acceleration"][1, 1], exact), (r["spc_force"][2, 1], m * exact),
                                (r["acceleration"][2, 1], -w * w * np.sin(w * t))]:
            self.assertLess(np.abs(found - expected)[late].max(), tolerance * np.abs(expected).max())
        # At the last step too.
        self.assertLess(abs(r["acceleration"][2, 1][-1] + w * w * np.sin(w * t[-1])), tolerance * w * w)
        self.near(r["displacement"][2, 1], np.sin(w * t), 1e-10)
        self.near(r["velocity"][2, 1][1:], w * np.cos(w * t[1:]), 1e-3)
        return t, w

    def test_function(self):
        load = "TLOAD2,9,10,,DISP,0.,1.,30.,-90."
        for f0, zeta in [(5000, .05), (5000, 1.5), (2000, .02), (2000, .3), (500, .05)]:
            self.check(f0, zeta, 1 / 6000, load, 3e-3)
        self.check(500, .05, 1 / 60000, load, 3e-4)

    def test_table(self):
        h, w = 1 / 6000, 2 * np.pi * 30
        points = "".join(f",{i * h!r},{float(np.sin(w * i * h))!r}\n" for i in range(1201))
        self.check(5000, .05, h, f"TLOAD1,9,10,,DISP,3\nTABLED1,3\n{points},ENDT", 3e-3)

    def test_coarse(self):
        """A table of 8 steps a line, and a function of 6 steps a period, are told."""
        h, w = 1 / 6000, 2 * np.pi * 30
        points = "".join(f",{i * h!r},{float(np.sin(w * i * h))!r}\n" for i in range(0, 1201, 8))
        make = lambda load: BASE.format(m=1e-3, k=1e6, c=1.0, h=h, n=600, load=load)
        self.write("d.bdf", make(f"TLOAD1,9,10,,DISP,3\nTABLED1,3\n{points},ENDT"))
        self.assertRegex(self.bough("transient", "d.bdf").stderr, r"modal.motion-corners.|corners, the first at t = 0.00133")
        self.write("d.bdf", make("TLOAD2,9,10,,DISP,0.,1.,1000.,-90."))
        self.assertRegex(self.bough("transient", "d.bdf").stderr, r"6 steps in a period.*modal.coarse-steps")
        self.write("d.bdf", make("TLOAD2,9,10,,DISP,0.,1.,30.,-90."))
        said = self.bough("transient", "d.bdf").stderr
        self.assertNotRegex(said, "modal.(coarse|motion|load|before)")


class BetweenSteps(base.OneMass):
    """m = 4, k = 36, undamped: after a pulse J of force u = J/(m w) sin w(t - t0)."""

    def test_pulses(self):
        w, m, k = 3.0, 4.0, 36.0
        r, t = self.transient("", load="TLOAD2,9,10,,,.1013,.1017\nDAREA,10,1,1,500.")
        step = lambda t: np.where(t > 0, 500 / k * (1 - np.cos(w * t)), 0)
        self.near(r["displacement"][1, 1], step(t - .1013) - step(t - .1017), 1e-7)
        self.assertEqual(len(t), 401)
        self.near(t, np.arange(401) * .01, 1e-12)
        spike = "TLOAD1,9,10,.2,,3\nDAREA,10,1,1,2.\nTABLED1,3\n,0.,0.,.113,0.,.114,1000.,.115,0.\n,9.,0.,ENDT"
        r, t = self.transient("", load=spike)
        ramp = lambda t: np.where(t > 0, 2e6 / k * (t - np.sin(w * t) / w), 0)
        self.near(r["displacement"][1, 1], ramp(t - .313) - 2 * ramp(t - .314) + ramp(t - .315), 1e-6)
        half = "TLOAD2,9,10,,,.1013,.1063,100.,-90.\nDAREA,10,1,1,500."  # half a sine between two steps
        r, t = self.transient("", load=half)
        p = 200 * np.pi
        J = 500 * 2 / p
        late = t > .11
        self.near(r["displacement"][1, 1][late], J / (m * w) * np.sin(w * (t[late] - .1038)), 2e-3)

    def test_before_table(self):
        load = "TLOAD1,9,10,.1,,3\nDAREA,10,1,1,2.\nTABLED1,3{flat}\n,0.,0.,.2,1.,ENDT"
        self.write("d.bdf", ONE.format(sol=112, case="DLOAD = 9\nTSTEP = 5", bulk=load.format(flat="") + "\nTSTEP,5,19,.01"))
        text = self.bough("transient", "d.bdf").stderr
        self.assertIn("[modal.before-table]", text)
        self.assertIn("until t = 0.1 table 3 has no points; on the line of its first two it begins with -0.5", text)
        r, t = self.transient("", load=load.format(flat=",,,1"))
        ramp = lambda t: np.where(t > 0, 10 / 36 * (t - np.sin(3 * t) / 3), 0)
        self.near(r["displacement"][1, 1], ramp(t - .1) - ramp(t - .3), 1e-9)
        self.write("d.bdf", ONE.format(sol=112, case="DLOAD = 9\nTSTEP = 5", bulk=load.format(flat=",,,2") + "\nTSTEP,5,9,.01"))
        self.fails(1, "transient", "d.bdf", says=["EXTRAP"])

    def test_many_corners(self):
        """More corners than become steps: those that matter most, and a word."""
        zigzag = "".join(f",{i * .00097 + .0003!r},{float(i % 2)!r}\n" for i in range(3000))
        self.write("d.bdf", ONE.format(sol=112, case="DLOAD = 9\nTSTEP = 5", bulk="TLOAD1,9,10,,,3\nDAREA,10,1,1,2.\n"
                                       f"TABLED1,3\n{zigzag},3.,0.,9.,0.,ENDT\nTSTEP,5,400,.01"))
        self.assertRegex(self.bough("transient", "d.bdf").stderr, "more than 2000 corners.*modal.load-between-steps")

    def test_start_alone(self):
        """Free decay without any load."""
        self.write("d.bdf", "")
        deck = ONE.format(sol=112, case="IC = 8\nTSTEP = 5", bulk="TIC,8,1,1,.1,-.2\nTSTEP,5,400,.01")
        r = self.solve("transient", deck)[1]
        t = r["x"]
        self.near(r["displacement"][1, 1], .1 * np.cos(3 * t) - .2 / 3 * np.sin(3 * t), 1e-10)


class Refused(refusals.Refusals):
    def test_loads(self):
        good = "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,1.\n"
        self.refuse("modal.wrong-load", self.deck(good + "DLOAD,9,2.,1.,9"), says=["RLOAD1 9", "d.bdf:"])
        self.refuse("modal.wrong-load", self.deck(good.replace("10,,,1.", "10,44,,1.") + "DELAY,44,1,1,.3\nDELAY,44,1,1,.1"),
                    says=["two values"])
        self.refuse("fe.bad-component", self.deck(good + "SPOINT,7\nCELAS4,70,9.,7\nCMASS4,71,1.,7\nDAREA,10,7,2,1."),
                    says=["scalar point 7", "0 or 1"])
        time = "SPCD,10,2,1,1.\nTSTEP,5,9,.1\n"
        for card in ["TLOAD2,9,10,,DISP,0.,9.,1.,0.\n,,,.5", "TLOAD1,9,10,,ACCE,1.,,-2."]:
            self.refuse("deck.unsupported-start", self.deck(card + "\n" + time, "DLOAD = 9\nTSTEP = 5"), "transient",
                        says=["S0 is not supported"])

    def test_subcase_number(self):
        good = "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,1.\n"
        self.write("d.bdf", self.deck(good).replace("SOL 111", "SOL DIRECT FREQUENCY RESPONSE"))
        said = self.bough("frequency", "d.bdf", "-o", "d.h5")
        self.assertIn("; direct", said.stdout)
        self.assertIn("subcase 1:", said.stdout)
        with h5py.File(self.path("d.h5")) as f:
            self.assertEqual(list(f["subcases"]), ["1"])


# Only what is written here.
for case in (BetweenSteps, Refused):
    for name in dir(case):
        if name.startswith("test_") and name not in vars(case):
            setattr(case, name, None)


if __name__ == "__main__":
    unittest.main()
