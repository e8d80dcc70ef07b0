"""Random response (RANDOM, RANDPS) of `frequency`: closed forms, NumPy and SciPy on dense matrices, decks of the vendor."""
import json
import os
import unittest

import h5py
import numpy as np
from scipy.integrate import quad

from deck_response_case import ONE
from decks import THREE_MASSES
from op2_reader import Op2
from support import ProgramTest

DECKS = os.path.join(os.environ.get("BOUGH_SHARED_DIR", ""), "models/random")
M, K = 4.0, 36.0

# Three masses that move along x, loaded at 1 (subcase 1) and at 3 (subcase 2).
PAIR = """SOL {sol}
CEND
SPC = 1
METHOD = 1
FREQUENCY = 5
RANDOM = 30
DISPLACEMENT = ALL
ACCELERATION = ALL
SPCFORCES = ALL
FORCE = ALL
{above}
SUBCASE 1
DLOAD = 11
SUBCASE 2
DLOAD = 12
BEGIN BULK
EIGRL,1,,,3
""" + THREE_MASSES + """RLOAD1,11,21,,,1.
RLOAD1,12,22,.05,,1.
DAREA,21,1,1,1.
DAREA,22,3,1,2.
FREQ1,5,.2,.05,60
{bulk}
ENDDATA
"""
TERMS = """RANDPS,30,1,1,2.,,7
RANDPS,30,2,2,1.,,8
RANDPS,30,1,2,.5,-.4,8
TABRND1,7,LOG,LOG
,.1,1.,1.,4.,10.,1.,ENDT
TABRND1,8
,.1,1.,2.,3.,10.,1.,ENDT
"""


def read_random(path, number=30):
    """Quantity or card -> {dataset: array}, dofs or ids with them; frequencies under "hz"."""
    found = {}
    with h5py.File(path) as f:
        group = f[f"random/{number}"]
        found["hz"], found["attributes"] = group["frequency_hz"][()], dict(group.attrs)
        for name in ("lag", "integral_error"):
            if name in group:
                found[name] = group[name][()]
        for quantity in ("displacement", "velocity", "acceleration", "spc_force"):
            if quantity in group:
                found[quantity] = {key: value[()] for key, value in group[quantity].items()}
        for folder in ("elements", "stresses"):
            for card, part in group.get(folder, {}).items():
                found[folder, card] = {key: value[()] for key, value in part.items()}
                found[folder, card]["components"] = [str(c) if isinstance(c, str) else c.decode()
                                                     for c in np.atleast_1d(part.attrs["components"])]
    return found


def pick(part, name, dof):
    """Column of a dataset for (grid, component)."""
    return part[name][..., list(map(tuple, part["dofs"])).index(dof)]


def integrate(hz, S, power=0):
    """Straight lines of S exactly: ∫ f^power S df by Gauss on each piece."""
    x, w = np.polynomial.legendre.leggauss(6)
    total = 0
    for a, b, p, q in zip(hz[:-1], hz[1:], S[:-1], S[1:]):
        f = (a + b) / 2 + (b - a) / 2 * x
        total = total + ((b - a) / 2 * w * f**power) @ np.interp(f, [a, b], [p, q])
    return total


def chain(hz):
    """Displacements of grids 1, 2, 3 for the loads of subcases 1 and 2 (3 x 2)."""
    w = 2 * np.pi * hz
    k = np.array([[100, -100, 0], [-100, 300, -200], [0, -200, 500.0]])
    ge = .05 * np.array([[100, -100, 0], [-100, 100, 0], [0, 0, 0.0]])
    c = np.array([[1.5, -1.5, 0], [-1.5, 1.5, 0], [0, 0, .4]])
    Z = k + 1j * ge + 1j * w * c - w * w * np.diag([1.0, 2.0, 3.0])
    return np.linalg.solve(Z, np.array([[1, 0], [0, 0], [0, 2 * np.exp(-1j * w * .05)]]))


def spectrum(f):
    log = np.exp(np.interp(np.log(f), np.log([.1, 1., 10.]), np.log([1., 4., 1.])))
    line = np.interp(f, [.1, 2., 10.], [1., 3., 1.])
    return np.array([[2 * log, (.5 - .4j) * line], [(.5 + .4j) * line, line]])


class Random(ProgramTest):
    def solve(self, deck, *options, number=30):
        self.write("d.bdf", deck)
        result = self.bough("frequency", "d.bdf", "-o", "d.h5", *options)
        return read_random(self.path("d.h5"), number), result

    def one(self, frequencies, zeta, more="", case=""):
        """m = 4, k = 36 (0.4775 Hz) under a white force of 1/Hz."""
        deck = ONE.format(sol=111, case=f"DLOAD = 9\nFREQUENCY = 5\nSDAMPING = 6\nRANDOM = 30\n{case}",
                          bulk=f"RLOAD1,9,10,,,1.\nDAREA,10,1,1,1.\nRANDPS,30,1,1,1.\nTABDMP1,6,CRIT\n,0.,{zeta},100.,{zeta},ENDT\n"
                               f"{frequencies}\n{more}")
        return self.solve(deck)

    def test_white_noise(self):
        """RMS² = S/(8 ζ ω³ m²) of the displacement, N0 = f0: over a band far wider than the mode, whatever the frequencies."""
        f0, w0 = np.sqrt(K / M) / 2 / np.pi, np.sqrt(K / M)
        for zeta in (.002, .05):
            found, result = self.one("FREQ1,5,1.-4,.5,200", zeta)
            self.assertIn("modal.random-sampling", result.stderr)
            rms = pick(found["displacement"], "modal_rms", (1, 1))
            self.assertAlmostEqual(rms**2 / (1 / (8 * zeta * w0**3 * M**2)), 1, delta=2e-3)
            self.assertAlmostEqual(pick(found["displacement"], "modal_zero_crossings_hz", (1, 1)) / f0, 1, delta=1e-2)
            # Against an adaptive integral over the same band.
            H2 = lambda f: 1 / np.abs(K - M * (2 * np.pi * f)**2 + 2j * zeta * w0 * M * 2 * np.pi * f)**2
            ends = [1e-4, *(f0 * (1 + s * zeta) for s in (-30, -5, -1, 0, 1, 5, 30)), 1., 10., 100.0001]
            ends = sorted(e for e in ends if 1e-4 <= e)
            for quantity, power in (("displacement", 0), ("velocity", 2), ("acceleration", 4)):
                m0, m2 = (sum(quad(lambda f: (2 * np.pi * f)**p * H2(f), a, b, epsrel=1e-11, epsabs=0)[0]
                              for a, b in zip(ends, ends[1:])) for p in (power, power + 2))
                self.assertAlmostEqual(pick(found[quantity], "modal_rms", (1, 1)) / np.sqrt(m0), 1, delta=1e-7)
                self.assertAlmostEqual(pick(found[quantity], "modal_zero_crossings_hz", (1, 1)) * 2 * np.pi / np.sqrt(m2 / m0),
                                       1, delta=1e-7)
            # The spring carries what the support gives back: the sum of spring and damper.
            self.assertGreater(pick(found["spc_force"], "modal_rms", (2, 1)), 0)
        # Frequencies around the mode: RMS and modal RMS agree without a warning.
        found, result = self.one("FREQ3,5,1.-4,100.,,200,3.\nFREQ4,5,0.,1.,.9,401", .05)
        self.assertNotIn("modal.random-sampling", result.stderr)
        part = found["displacement"]
        self.assertAlmostEqual(pick(part, "rms", (1, 1)) / pick(part, "modal_rms", (1, 1)), 1, delta=2e-3)

    def test_miles(self):
        """Base shaken in g²/Hz: √(π/2 f0 Q S), which leaves out the factor √(1 + 4 ζ²) of the dashpot to the base."""
        S, zeta, f0 = .04, .05, 100.0
        k = (2 * np.pi * f0)**2
        deck = (f"SOL 111\nCEND\nSPC = 1\nMETHOD = 1\nDLOAD = 9\nFREQUENCY = 5\nRANDOM = 30\nACCELERATION = ALL\nBEGIN BULK\n"
                f"EIGRL,1,,,1\nGRID,1,,0.,0.,0.,,23456\nGRID,2,,0.,0.,0.,,23456\nCONM2,1,2,,1.\nCELAS2,1,{k:.12e},1,1,2,1\n"
                f"CDAMP2,2,{2 * zeta * np.sqrt(k):.12e},1,1,2,1\nSPC1,1,1,1\nRLOAD1,9,10,,,1.,,ACCE\nSPCD,10,1,1,1.\n"
                f"FREQ1,5,1.,1.,19999\nRANDPS,30,1,1,{S},,7\nTABRND1,7\n,0.,1.,30000.,1.,ENDT\nENDDATA\n")
        deck = deck.replace(f"{k:.12e}", f"{k:.7g}").replace(f"{2 * zeta * np.sqrt(k):.12e}", f"{2 * zeta * np.sqrt(k):.8g}")
        found, _ = self.solve(deck)
        rms = pick(found["acceleration"], "modal_rms", (2, 1))
        miles = np.sqrt(np.pi / 2 * f0 / (2 * zeta) * S)
        self.assertAlmostEqual(miles, 7.9267, delta=1e-4)
        # The band begins at 1 Hz, where the mass follows its base, and ends at 20 kHz, where the dashpot alone moves it.
        outside = S * (1 + (2 * zeta * f0)**2 / 20000)
        self.assertAlmostEqual(np.sqrt(rms**2 + outside) / (miles * np.sqrt(1 + 4 * zeta**2)), 1, delta=1e-6)
        np.testing.assert_allclose(pick(found["acceleration"], "psd", (1, 1)), S, rtol=1e-9)

    def check_pair(self, found, has_modal):
        hz = found["hz"]
        S = np.array([spectrum(f) for f in hz])
        H = np.array([chain(f) for f in hz])
        w = 2 * np.pi * hz
        outputs = {("displacement", (g + 1, 1)): H[:, g] for g in range(3)}
        outputs |= {("acceleration", (g + 1, 1)): -w[:, None]**2 * H[:, g] for g in range(3)}
        outputs["spc_force", (4, 1)] = -(300 + .4j * w[:, None]) * H[:, 2]
        for (quantity, dof), h in outputs.items():
            psd = np.einsum("fj,fjk,fk->f", h, S, h.conj()).real
            part = found[quantity]
            np.testing.assert_allclose(pick(part, "psd", dof), psd, rtol=1e-8)
            m0, m2 = integrate(hz, psd), integrate(hz, psd, 2)
            self.assertAlmostEqual(pick(part, "rms", dof) / np.sqrt(m0), 1, delta=1e-8)
            self.assertAlmostEqual(pick(part, "zero_crossings_hz", dof) / np.sqrt(m2 / m0), 1, delta=1e-8)
            running = [np.sqrt(integrate(hz[:i + 1], psd[:i + 1])) if i else 0 for i in range(len(hz))]
            np.testing.assert_allclose(pick(part, "cumulative_rms", dof), running, rtol=1e-8)
            if not has_modal:
                self.assertNotIn("modal_rms", part)
                continue
            def density(f, power):
                x = chain(f)[dof[0] - 1] if quantity != "spc_force" else -(300 + .8j * np.pi * f) * chain(f)[2]
                x = x * (-(2 * np.pi * f)**2 if quantity == "acceleration" else 1)
                return (x @ spectrum(f) @ x.conj()).real * f**power
            ends = [hz[0], *np.arange(.4, hz[-1], .2), hz[-1]]
            m0, m2 = (sum(quad(density, a, b, args=(p,), epsrel=1e-11, epsabs=0)[0] for a, b in zip(ends, ends[1:])) for p in (0, 2))
            self.assertAlmostEqual(pick(part, "modal_rms", dof) / np.sqrt(m0), 1, delta=1e-6)
            self.assertAlmostEqual(pick(part, "modal_zero_crossings_hz", dof) / np.sqrt(m2 / m0), 1, delta=1e-6)

    def test_cross_terms(self):
        """Two coupled loads with a delay, dampers that couple the modes: NumPy on 3 x 3 matrices, by modes and directly."""
        found, result = self.solve(PAIR.format(sol=111, above="", bulk=TERMS))
        self.check_pair(found, True)
        self.assertLess(found["integral_error"][()], 1e-6)
        self.assertIn("random 30: subcases 1, 2", result.stdout)
        found, _ = self.solve(PAIR.format(sol=108, above="", bulk=TERMS))
        self.check_pair(found, False)

    def test_uncorrelated(self):
        """Mean squares add, and forces of the springs follow: element force of CELAS2 22 = 200 (u2 - u3)."""
        auto = "\n".join(line for line in TERMS.splitlines() if not line.startswith("RANDPS,30,1,2")) + "\n"
        both, _ = self.solve(PAIR.format(sol=111, above="", bulk=auto))
        alone = [self.solve(PAIR.format(sol=111, above="", bulk=auto.replace(drop, "$")))[0]
                 for drop in ("RANDPS,30,1,1,", "RANDPS,30,2,2,")]
        for name in ("rms", "modal_rms"):
            total = np.sqrt(sum(one["displacement"][name]**2 for one in alone))
            np.testing.assert_allclose(both["displacement"][name], total, rtol=1e-7, atol=1e-20)
        hz, part = both["hz"], both["elements", "CELAS2"]
        S = np.array([np.diag(np.diag(spectrum(f))) for f in hz])
        h = np.array([200 * (1) * (chain(f)[1] - chain(f)[2]) for f in hz])
        psd = np.einsum("fj,fjk,fk->f", h, S, h.conj()).real
        np.testing.assert_allclose(part["psd"][:, list(part["id"]).index(22), 0], psd, rtol=1e-8)

    def test_autocorrelation(self):
        """RANDT1: R(0) = RMS², R(τ) = ∫S cos 2πfτ of straight lines by fine quadrature; CSV and JSON hold the same."""
        found, _ = self.solve(PAIR.format(sol=111, above="", bulk=TERMS + "RANDT1,30,4,0.,2.\n"), "--csv", "d.csv")
        np.testing.assert_allclose(found["lag"], [0, .5, 1, 1.5, 2], rtol=1e-12)
        part, hz = found["displacement"], found["hz"]
        psd, R = pick(part, "psd", (1, 1)), pick(part, "autocorrelation", (1, 1))
        self.assertAlmostEqual(R[0] / pick(part, "rms", (1, 1))**2, 1, delta=1e-10)
        x, w = np.polynomial.legendre.leggauss(12)
        for lag, value in zip(found["lag"], R):
            exact = sum(((b - a) / 2 * w * np.cos(2 * np.pi * lag * ((a + b) / 2 + (b - a) / 2 * x))) @ np.interp((a + b) / 2 + (b - a) / 2 * x, [a, b], [p, q])
                        for a, b, p, q in zip(hz, hz[1:], psd, psd[1:]))
            self.assertAlmostEqual(value, exact, delta=1e-9 * R[0])
        tables = self.read("d.csv").split("\n\n")
        names = tables[2].split("\n")[0].split(",")
        rows = np.array([line.split(",") for line in tables[2].split("\n")[1:] if line], float)
        np.testing.assert_allclose(rows[:, names.index("psd:displacement:1:1")], psd, rtol=1e-12)
        self.assertTrue(tables[3].startswith("random,lag,autocorrelation:displacement:1:1"), tables[3][:80])
        out = json.loads(self.bough("frequency", "d.bdf", "--json").stdout)["random"][0]
        self.assertEqual((out["set"], out["subcases"]), (30, [1, 2]))
        one = next(o for o in out["outputs"] if o["name"] == "displacement:1:1")
        self.assertAlmostEqual(one["rms"], pick(part, "rms", (1, 1)), delta=1e-12)
        self.bough("export", "d.h5", "--to", "csv", "-o", "e.csv")
        self.assertEqual(self.read("e.csv"), self.read("d.csv"))

    def test_cross_spectral_densities(self):
        """RCROSS: S_ab = H_a S H_bᴴ of dense matrices; E[a(t + τ) b(t)] by fine quadrature of its straight lines."""
        cards = "RCROSS,40,DISP,1,1,,3\nRCROSS,40,ACCE,2,1,DISP,3,,7\nRCROSS,41,DISP,1,1,,2\n"
        bulk = TERMS + cards + "RANDT1,30,4,0.,2.\n"
        found, _ = self.solve(PAIR.format(sol=111, above="RCROSS = 40", bulk=bulk), "--csv", "d.csv", "--punch", "d.pch")
        with h5py.File(self.path("d.h5")) as f:
            crosses = [{key: value[()] for key, value in f[f"random/30/cross/{k}"].items()} for k in (1, 2)]
            self.assertNotIn("3", f["random/30/cross"])
            self.assertEqual([str(w) if isinstance(w, str) else w.decode() for w in f["random/30/cross/2"].attrs["quantities"]],
                             ["acceleration", "displacement"])
        hz, lags = found["hz"], found["lag"]
        x, w = np.polynomial.legendre.leggauss(12)
        for cross, dofs, (a, b), curve in zip(crosses, ([[1, 1], [3, 1]], [[2, 1], [3, 1]]), ((0, 2), (1, 2)), (0, 7)):
            np.testing.assert_array_equal(cross["dofs"], dofs)
            self.assertEqual(cross["curve"][0], curve)
            exact, coherence = [], []
            for f in hz:
                h = chain(f) * np.array([1, -(2 * np.pi * f)**2 if curve else 1, 1])[:, None]
                S = h @ spectrum(f) @ h.conj().T
                exact.append(S[a, b])
                coherence.append(abs(S[a, b])**2 / (S[a, a] * S[b, b]).real)
            S = cross["real"] + 1j * cross["imag"]
            np.testing.assert_allclose(S, exact, rtol=1e-8, atol=1e-12 * np.abs(exact).max())
            np.testing.assert_allclose(cross["coherence"], coherence, rtol=1e-7)
            self.assertAlmostEqual(float(np.squeeze(cross["covariance"])), np.trapz(S.real, hz), delta=1e-12 * np.abs(S).max())
            for lag, value in zip(lags, cross["correlation"]):
                total = 0
                for p, q, u, v in zip(hz, hz[1:], S, S[1:]):
                    f = (p + q) / 2 + (q - p) / 2 * x
                    total += ((q - p) / 2 * w) @ ((u + (f - p) / (q - p) * (v - u)) * np.exp(2j * np.pi * f * lag)).real
                self.assertAlmostEqual(value, total, delta=1e-9 * np.trapz(np.abs(S), hz))
        self.assertIn("cross_psd:acceleration:2:1|displacement:3:1:real", self.read("d.csv"))
        self.assertIn("cross_correlation:displacement:1:1|displacement:3:1", self.read("d.csv"))
        self.bough("export", "d.h5", "--to", "csv", "-o", "e.csv")
        self.assertEqual(self.read("e.csv"), self.read("d.csv"))

    def test_cross_spectral_densities_of_elements(self):
        """Item codes of FORCE and STRESS: V = (M_A - M_B)/L of both planes of a bar, F = A sigma of a rod in line."""
        deck = """SOL 111
CEND
SPC = 1
METHOD = 1
FREQUENCY = 5
RANDOM = 30
RCROSS = 40
FORCE = ALL
STRESS = ALL
DISPLACEMENT = ALL
DLOAD = 9
BEGIN BULK
EIGRL,1,,,9
PARAM,G,.04
MAT1,1,7.+10,,.3
PBAR,1,1,2.-3,3.-6,5.-6,4.-6
PROD,2,1,3.-3
GRID,1,,0.,0.,0.
GRID,2,,2.,0.,0.
GRID,3,,3.,0.,0.
CBAR,11,1,1,2,0.,1.,0.
CROD,12,2,2,3
CONM2,21,2,,30.,.1,.2,.3
SPC1,1,123456,1
SPC1,1,23456,3
CONM2,22,3,,5.
RLOAD1,9,10,,,1.
DAREA,10,2,2,3.
DAREA,10,2,3,-2.
DAREA,10,3,1,5.
RANDPS,30,1,1,1.
FREQ1,5,1.,7.,60
""" + "".join(f"RCROSS,40,FORCE,{i},{a},FORCE,{j},{b}\n" for i, a, j, b in (
            (11, 2, 11, 2), (11, 4, 11, 2), (11, 6, 11, 2), (11, 3, 11, 3), (11, 5, 11, 3), (11, 7, 11, 3), (11, 2, 11, 3),
            (12, 2, 12, 2), (11, 8, 12, 2))) + """RCROSS,40,STRESS,12,2,FORCE,12,2
RCROSS,40,DISP,2,2,FORCE,11,6
ENDDATA
"""
        self.write("d.bdf", deck)
        self.bough("frequency", "d.bdf", "-o", "d.h5")
        with h5py.File(self.path("d.h5")) as f:
            S = [f[f"random/30/cross/{k}/real"][:] + 1j * f[f"random/30/cross/{k}/imag"][:] for k in range(1, 12)]
            u = f["subcases/1/displacement/real"][:] + 1j * f["subcases/1/displacement/imag"][:]
        m1, m2 = np.abs(S[0]).max(), np.abs(S[3]).max()
        np.testing.assert_allclose(S[2], (S[0] - S[1]) / 2, atol=1e-9 * m1)
        np.testing.assert_allclose(S[5], (S[3] - S[4]) / 2, atol=1e-9 * m2)
        self.assertGreater(np.abs(S[6]).max(), 1e-3 * np.sqrt(m1 * m2))
        np.testing.assert_allclose(S[9], S[7] / 3e-3, rtol=1e-10)
        self.assertGreater(np.abs(S[8]).max(), 0)
        self.assertGreater(np.abs(S[10]).max(), 0)
        self.assertEqual(u.shape[0], 60 + 1)

    def test_bad_cross_requests(self):
        deck = PAIR.format(sol=111, above="RCROSS = 40", bulk=TERMS + "RCROSS,40,DISP,1,1,,{}\n")
        self.write("d.bdf", PAIR.format(sol=111, above="RCROSS = 40", bulk=TERMS))
        self.fails(1, "frequency", "d.bdf", error="modal.missing-random", says=["RCROSS = 40", "d.bdf:11"])
        self.write("d.bdf", deck.format(3).replace("RANDOM = 30\n", ""))
        self.fails(1, "frequency", "d.bdf", error="modal.missing-random", says=["RCROSS without RANDOM"])
        # RCROSS asks of the random response alone: other commands solve the deck.
        self.write("d.bdf", deck.format(3))
        for verb in ("check", "modes"):
            self.bough(verb, "d.bdf")
        self.write("d.bdf", deck.format(99))
        printed = self.bough("frequency", "d.bdf").stderr
        self.assertIn("[modal.random-cross]", printed)
        self.assertIn("DISP of 99, component 1", printed)
        self.write("d.bdf", deck.format(3).replace("RCROSS,40,DISP,1,1", "RCROSS,40,,1,1"))
        self.fails(1, "frequency", "d.bdf", says=["RTYPE1"])

    def test_op2_and_punch(self):
        """Tables of the vendor's names: SORT2 of densities, running RMS, autocorrelation; SORT1 of RMS and N0."""
        found, _ = self.solve(PAIR.format(sol=111, above="VELOCITY = ALL", bulk=TERMS + "RANDT1,30,4,0.,2.\n"),
                              "--op2", "d.op2", "--punch", "d.pch")
        op2 = Op2(self.path("d.op2"))
        for letters, code, quantity in (("OUG", 1, "displacement"), ("OVG", 10, "velocity"), ("OAG", 11, "acceleration"),
                                        ("OQG", 3, "spc_force")):
            part = found[quantity]
            dofs = list(map(tuple, part["dofs"]))
            for suffix, name, at in (("PSD2", "psd", "hz"), ("CRM2", "cumulative_rms", "hz"), ("ATO2", "autocorrelation", "lag")):
                curves = op2.random_curves(letters + suffix)
                self.assertEqual(sorted(curves), [(code, 1, grid) for grid in sorted({grid for grid, _ in dofs})])
                for (_, _, grid), (kind, x, values) in curves.items():
                    self.assertEqual(kind, 1)
                    np.testing.assert_allclose(x, found[at], rtol=1e-6)
                    for c in range(6):
                        column = part[name][:, dofs.index((grid, c + 1))] if (grid, c + 1) in dofs else 0 * found[at]
                        np.testing.assert_allclose(np.array(values)[:, c], column, rtol=1e-6, atol=1e-30)
            for suffix, name in (("RMS1", "rms"), ("NO1", "zero_crossings_hz")):
                ((key, rows),) = op2.random_values(letters + suffix).items()
                self.assertEqual(key, (code, 1))
                for grid, (kind, values) in rows.items():
                    for c, value in enumerate(values):
                        exact = part[name][dofs.index((grid, c + 1))] if (grid, c + 1) in dofs else 0
                        self.assertAlmostEqual(value, exact, delta=1e-6 * abs(exact))
        lines = [line[:72].rstrip() for line in self.read("d.pch").splitlines()]
        at = lines.index("$ACCELERATION - RMS")
        row = next(line for line in lines[at:] if line.split()[:2] == ["1", "G"])
        self.assertAlmostEqual(float(row.split()[2]) / pick(found["acceleration"], "rms", (1, 1)), 1, delta=1e-6)
        at = lines.index("$DISPLACEMENTS - PSDF")
        self.assertEqual(lines[at + 3].split(), ["$POINT", "ID", "=", "1", "IDENTIFIED", "BY", "FREQUENCY"])
        self.assertAlmostEqual(float(lines[at + 4].split()[2]) / pick(found["displacement"], "psd", (1, 1))[0], 1, delta=1e-6)

    def test_rms_in_csv(self):
        """The last table of --csv has RMS and N0, of both integrals by modes."""
        for sol in (111, 108):
            found, _ = self.solve(PAIR.format(sol=sol, above="", bulk=TERMS), "--csv", "d.csv")
            table = self.read("d.csv").split("\n\n")[-1].splitlines()
            names = ["rms", "zero_crossings_hz"] + (["modal_rms", "modal_zero_crossings_hz"] if sol == 111 else [])
            self.assertEqual(table[0], ",".join(["random", "output", *names]))
            rows = {line.split(",")[1]: list(map(float, line.split(",")[2:])) for line in table[1:]}
            for quantity, dof in (("displacement", (2, 1)), ("acceleration", (3, 1)), ("spc_force", (4, 1))):
                np.testing.assert_allclose(rows[f"{quantity}:{dof[0]}:{dof[1]}"], [pick(found[quantity], n, dof) for n in names], rtol=1e-15)
            part = found["elements", "CELAS2"]
            np.testing.assert_allclose(rows[f"CELAS2:22:{part['components'][0]}"],
                                       [part[n][list(part["id"]).index(22), 0] for n in names], rtol=1e-15)

    def test_pictures(self):
        """`plot --psd` draws spectral densities with their RMS, `report` has them with tables; others have none."""
        found, _ = self.solve(PAIR.format(sol=111, above="", bulk=TERMS))
        self.bough("plot", "d.h5", "--sensor", "displacement:1", "--psd", "--csv", "p.csv", "-o", "p.svg")
        lines = [line for line in self.read("p.csv").splitlines() if line.startswith('"displacement:1:1, RMS ')]
        values = np.array([line.rsplit(",", 2)[1:] for line in lines], float)
        np.testing.assert_allclose(values[:, 1], pick(found["displacement"], "psd", (1, 1)), rtol=1e-12)
        self.assertIn("RMS {:.4g}".format(pick(found["displacement"], "rms", (1, 1))), self.read("p.svg"))
        self.bough("report", "d.h5", "-o", "d.html")
        page = self.read("d.html")
        for text in ("random 30: displacement", "cumulative RMS", "modal RMS", "RMS against the integral over the band"):
            self.assertIn(text, page)
        self.fails(1, "plot", "d.h5", "--sensor", "displacement:9:1", "--psd", error="cli.unknown-channel", says=["displacement:9:1"])
        self.write("n.bdf", ONE.format(sol=111, case="DLOAD = 9\nFREQUENCY = 5", bulk="RLOAD1,9,10,,,1.\nDAREA,10,1,1,1.\nFREQ1,5,1.,1.,4\nPARAM,G,.1"))
        self.bough("frequency", "n.bdf", "-o", "n.h5")
        self.fails(1, "plot", "n.h5", "--sensor", "displacement:1:1", "--psd", error="cli.no-random", says=["RANDPS"])

    def test_loglog(self):
        """PARAM,RMSINT,LOGLOG: straight lines of log S over log f; the levels of GEVS have 14.136 g RMS."""
        deck = (f"SOL 111\nCEND\nSPC = 1\nMETHOD = 1\nDLOAD = 9\nFREQUENCY = 5\nRANDOM = 30\nACCELERATION = ALL\nBEGIN BULK\n"
                f"EIGRL,1,,,1\nPARAM,RMSINT,LOGLOG\nPARAM,G,.1\nGRID,1,,0.,0.,0.,,23456\nGRID,2,,0.,0.,0.,,23456\nCONM2,1,2,,1.\n"
                f"CELAS2,1,1000.,1,1,2,1\nSPC1,1,1,1\nRLOAD1,9,10,,,1.,,ACCE\nSPCD,10,1,1,1.\n"
                f"FREQ,5,20.,50.,800.,2000.\nRANDPS,30,1,1,1.,,7\nTABRND1,7,LOG,LOG\n"
                f",20.,.026,50.,.16,800.,.16,2000.,.026\n,ENDT\nENDDATA\n")
        found, _ = self.solve(deck)
        self.assertAlmostEqual(pick(found["acceleration"], "rms", (1, 1)), 14.136, delta=1e-3)
        self.assertAlmostEqual(pick(found["acceleration"], "modal_rms", (1, 1)), 14.136, delta=1e-3)
        # The running RMS ends at the RMS, by the same lines.
        np.testing.assert_allclose(found["acceleration"]["cumulative_rms"][-1], found["acceleration"]["rms"], rtol=1e-12)
        found, _ = self.solve(deck.replace("PARAM,RMSINT,LOGLOG\n", ""))
        S = np.array([.026, .16, .16, .026])
        self.assertAlmostEqual(pick(found["acceleration"], "rms", (1, 1)), np.sqrt(integrate([20, 50, 800, 2000], S)), delta=1e-6)

    def test_gust(self):
        """TABRNDG of Dryden integrates to WG²."""
        case = self.one("FREQ1,5,1.-4,.02,50000", .05, "TABRNDG,8,2,.2,6.\n")[0]
        self.assertTrue(case)
        deck = self.read("d.bdf").replace("RANDPS,30,1,1,1.", "RANDPS,30,1,1,1.,,8").replace("RLOAD1,9,10,,,1.", "RLOAD1,9,10,,,1.,,ACCE").replace("DAREA,10,1,1,1.", "SPCD,10,2,1,1.")
        found, _ = self.solve(deck)
        self.assertAlmostEqual(pick(found["acceleration"], "rms", (2, 1)), 6, delta=6e-3)

    def test_von_mises(self):
        """The mean square of the von Mises stress is the trace of A times the covariance of the components."""
        deck = (f"SOL 111\nCEND\nSPC = 1\nMETHOD = 1\nFREQUENCY = 5\nRANDOM = 30\nSTRESS = ALL\nDISPLACEMENT = ALL\nSUBCASE 1\nDLOAD = 11\n"
                f"SUBCASE 2\nDLOAD = 12\nBEGIN BULK\nEIGRL,1,,,4\nPARAM,G,.1\n"
                f"GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\n"
                f"GRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nMAT1,1,1.+5,,.3,1.\n"
                f"CQUAD4,2,2,5,6,7,8\nPSHELL,2,1,.05,1\nCROD,3,3,1,7\nPROD,3,1,.1,.02,.5\nSPC1,1,123456,1,2,3,4\nSPC1,1,456,5,6,7,8\n"
                f"RLOAD1,11,21,,,1.\nRLOAD1,12,22,,30.,1.\nDAREA,21,7,1,10.\nDAREA,22,5,3,7.,5,2,-3.\nFREQ1,5,1.,4.,40\n"
                f"RANDPS,30,1,1,2.\nRANDPS,30,2,2,1.\nRANDPS,30,1,2,.3,.6\nENDDATA\n")
        found, _ = self.solve(deck)
        S = np.array([[2, .3 + .6j], [.3 - .6j, 1]])
        A = {3: np.array([[1, -.5, 0], [-.5, 1, 0], [0, 0, 3]]), 2: np.diag([1, 3.0]),
             6: np.block([[1.5 * np.eye(3) - .5, np.zeros((3, 3))], [np.zeros((3, 3)), 3 * np.eye(3)]])}
        with h5py.File(self.path("d.h5")) as f:
            num = 0
            for card in f["subcases/1/stresses"]:
                parts = [f[f"subcases/{j}/stresses/{card}"] for j in (1, 2)]
                y = np.array([part["real"][()] + 1j * part["imag"][()] for part in parts])[:, :, 0]  # subcase, frequency, component
                names = [str(n) if isinstance(n, str) else n.decode() for n in parts[0].attrs["components"]]
                result = found["stresses", card]
                hz = found["hz"]
                for point in dict.fromkeys(n.partition("@")[2] for n in names):
                    columns = [i for i, n in enumerate(names) if n.partition("@")[2] == point]
                    s = y[:, :, columns]
                    # Covariance by straight lines between the frequencies.
                    density = np.einsum("jfa,jk,kfb->fab", s, S, s.conj()).real
                    covariance = sum(
                        (b - a) / 2 * (p + q) for a, b, p, q in zip(hz, hz[1:], density, density[1:]))
                    name = "von_mises" + ("@" + point if point else "")
                    rms = result["rms"][0, result["components"].index(name)]
                    self.assertAlmostEqual(rms / np.sqrt(np.trace(A[len(columns)] @ covariance)), 1, delta=1e-9)
                    modal = result["modal_rms"][0, result["components"].index(name)]
                    self.assertAlmostEqual(modal / rms, 1, delta=.3)
                    num += 1
            self.assertGreaterEqual(num, 3)

    def test_rejected_input(self):
        good = PAIR.format(sol=111, above="", bulk=TERMS)
        def refuse(old, new, error, says, code=1):
            self.assertIn(old, good)
            self.write("d.bdf", good.replace(old, new))
            self.fails(code, "frequency", "d.bdf", error=error, says=says)
        refuse("RANDPS,30", "RANDPS,31", "modal.missing-random", ["RANDOM = 30", "d.bdf:6"])
        refuse("RANDPS,30,2,2,1.,,8", "RANDPS,30,2,2,1.,,9", "modal.missing-table", ["table 9", "d.bdf:38"])
        refuse("RANDPS,30,2,2,1.,,8", "RANDPS,30,2,4,.1,,8", "modal.random-subcase", ["subcase 4", "d.bdf:38"])
        refuse("DLOAD = 12", "$", "modal.random-subcase", ["selects no DLOAD"])
        refuse(",.1,1.,2.,3.", ",.1,1.,2.,-3.", "modal.bad-spectrum", ["negative", "d.bdf:38"])
        refuse("RANDPS,30,1,2,.5,-.4", "RANDPS,30,1,2,5.,-.4", "modal.bad-spectrum", ["positive semi-definite", "coherence", "d.bdf:39"])
        refuse("RANDPS,30,1,2,.5,-.4", "RANDPS,30,2,1,.5,-.4", "deck.field-range", ["conjugate", "d.bdf:39"])
        refuse("RANDPS,30,1,1,2.,", "RANDPS,30,1,1,2.,1.", "deck.field-range", ["auto-spectral density is real"])
        refuse("RANDPS,30,1,1,2.,", "RANDPS,30,1,1,-2.,", "deck.field-range", ["not negative"])
        refuse("DLOAD = 12", "DLOAD = 12\nFREQUENCY = 6", "modal.no-frequencies", [])
        self.write("d.bdf", good.replace("DLOAD = 12", "DLOAD = 12\nFREQUENCY = 6").replace("{bulk}", "").replace("RANDPS,30,1,1", "FREQ1,6,.1,.05,60\nRANDPS,30,1,1"))
        self.fails(1, "frequency", "d.bdf", error="modal.random-frequencies", says=["subcases 1 and 2"])
        refuse("FREQ1,5,.2,.05,60", "FREQ,5,1.", "modal.random-frequencies", ["one frequency, 1 Hz", "integrals"])
        # A line that falls below 0 beyond the table.
        refuse("10.,1.,ENDT\n", "2.5,1.,ENDT\n", "modal.bad-spectrum", ["is -"])

    def test_warnings(self):
        good = PAIR.format(sol=111, above="", bulk=TERMS)
        self.write("d.bdf", good.replace("FREQ1,5,.2,.05,60", "FREQ1,5,.05,.05,60"))
        self.assertIn("modal.random-range", self.bough("frequency", "d.bdf").stderr)
        self.write("d.bdf", good)
        self.assertIn("modal.random-subcase", self.bough("frequency", "d.bdf", "--subcase", "1").stderr)
        self.assertIn("ignored as asked", self.bough("frequency", "d.bdf", "--ignore", "RANDOM").stderr)
        # Elsewhere the command has no effect: it is named.
        self.assertIn("RANDOM (line 6)", self.bough("modes", "d.bdf").stderr)
        self.write("d.bdf", good.replace("DLOAD = 12", "DLOAD = 12\nACCELERATION = NONE"))
        self.assertIn("modal.random-output", self.bough("frequency", "d.bdf").stderr)
        self.write("t.bdf", ONE.format(sol=112, case="DLOAD = 9\nTSTEP = 3\nRANDOM = 30",
                                       bulk="TLOAD2,9,10,,,0.,1.\nDAREA,10,1,1,2.\nTSTEP,3,5,.1"))
        self.assertIn("modal.random-transient", self.bough("transient", "t.bdf").stderr)
        undamped = ONE.format(sol=111, case="DLOAD = 9\nFREQUENCY = 5\nRANDOM = 30",
                              bulk="RLOAD1,9,10,,,1.\nDAREA,10,1,1,1.\nRANDPS,30,1,1,1.\nFREQ1,5,.1,.1,20\n")
        self.assertIn("modal.random-unbounded", self.solve(undamped)[1].stderr)

    def test_units(self):
        """Seconds to milliseconds: spectral densities per hertz are multiplied by the unit of time."""
        self.write("d.bdf", PAIR.format(sol=111, above="", bulk=TERMS))
        self.bough("frequency", "d.bdf", "-o", "a.h5")
        self.bough("convert", "d.bdf", "--units", "m-kg-s:m-kg-ms", "-o", "e.bdf")
        self.bough("frequency", "e.bdf", "-o", "b.h5")
        a, b = read_random(self.path("a.h5")), read_random(self.path("b.h5"))
        np.testing.assert_allclose(pick(b["displacement"], "rms", (1, 1)), pick(a["displacement"], "rms", (1, 1)), rtol=1e-6)


@unittest.skipUnless(os.path.isdir(DECKS), f"no decks at {DECKS}")
class Vendor(ProgramTest):
    def test_bar_and_shells(self):
        """Values of the vendor's OP2. Grid 5 follows modes of shells between coarse frequencies: 0.2 % in the RMS."""
        self.bough("frequency", os.path.join(DECKS, "random_test_bar_plus_tri.bdf"), "-o", "v.h5")
        found = read_random(self.path("v.h5"), 200)
        self.assertAlmostEqual(pick(found["acceleration"], "rms", (1, 1)) / 5432.918, 1, delta=2e-5)
        self.assertAlmostEqual(pick(found["acceleration"], "zero_crossings_hz", (1, 1)) / 1160.516, 1, delta=2e-6)
        self.assertAlmostEqual(pick(found["displacement"], "rms", (5, 1)) / 5.482573e-2, 1, delta=2.5e-3)


if __name__ == "__main__":
    unittest.main()
