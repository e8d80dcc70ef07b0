"""response --psd: Lyapunov's equation, band-limited Gramians and quadrature by SciPy, long simulated histories."""
import csv
import json
import math
import os
import unittest

import h5py
import numpy as np
import scipy.integrate
import scipy.linalg
import scipy.signal
import scipy.stats

from linear_test import LinearTest
from support import SOURCE
from toml_text import Bare, section, table, toml

# Two carts in a row on springs and dampers, a force on each.
CARTS = toml(
    table("body", "one", mass=2.0, inertia=[1.0, 1.0, 1.0], nodes=[{"id": 1, "position": [0.0, 0.0, 0.0]}]),
    table("body", "two", mass=1.0, inertia=[1.0, 1.0, 1.0], nodes=[{"id": 1, "position": [0.0, 0.0, 0.0]}]),
    table("hinge", "first", "prismatic", child="one", axis=[1.0, 0.0, 0.0], stiffness=[Bare("STIFFNESS")],
          damping=[Bare("DAMPING")]),
    table("hinge", "second", "prismatic", parent="one", child="two", axis=[1.0, 0.0, 0.0], stiffness=[300.0],
          damping=[0.5]),
    table("function", "nothing", "constant", value=0.0),
    table("force", "f1", body="one", node=1, force=[1.0, 0.0, 0.0], function="nothing"),
    table("force", "f2", body="two", node=1, force=[1.0, 0.0, 0.0], function="nothing"),
    table("sensor", "place", "position", body="two", node=1),
    table("sensor", "speed", "velocity", body="one", node=1),
    table("sensor", "shock", "acceleration", body="two", node=1),
    section("simulation", duration=1.0))
OUTPUTS = ["place:x", "speed:x", "shock:x"]
TABLES = toml(
    table("psd", input="f1", frequency_hz=[1.0, 2.5, 8.0], density=[0.5, 4.0, 1.0], interpolation="log"),
    table("psd", input="f2", frequency_hz=[0.5, 3.0, 6.0], density=[2.0, 1.0, 3.0]),
    table("psd", input="f1", with_="f2", frequency_hz=[1.0, 4.0, 6.0], density=[0.3, -0.2, 0.1],
          imaginary=[0.1, 0.4, 0.0]))


def calc_response(A, B, C, D, f):
    return C @ np.linalg.solve(2j * math.pi * f * np.eye(len(A)) - A, B) + D


def calc_tables(f):
    """S of TABLES."""
    def line(x, y):
        return np.interp(f, x, y, left=0, right=0)
    S = np.zeros((2, 2), complex)
    if 1 <= f <= 8:
        S[0, 0] = math.exp(np.interp(math.log(f), np.log([1, 2.5, 8]), np.log([0.5, 4, 1])))
    S[1, 1] = line([0.5, 3, 6], [2, 1, 3])
    S[0, 1] = line([1, 4, 6], [.3, -.2, .1]) + 1j * line([1, 4, 6], [.1, .4, 0])
    S[1, 0] = S[0, 1].conjugate()
    return S


class RandomOutputs(LinearTest):
    def make_carts(self, stiffness=800.0, damping=3.0):
        self.write("carts.toml", CARTS.replace("STIFFNESS", str(stiffness)).replace("DAMPING", str(damping)))
        model = self.linearize("carts.toml")
        rows = [model["outputs/name"].index(name) for name in OUTPUTS]
        return model["A"], model["B"], model["C"][rows], model["D"][rows]

    def respond(self, *arguments):
        text = self.bough("response", "model.h5", "--outputs", ",".join(OUTPUTS), "--json", *arguments).stdout
        random = json.loads(text)["random"]
        self.assertEqual([one["name"] for one in random["outputs"]], OUTPUTS)
        return random

    def get(self, random, key):
        return np.array([one[key] for one in random["outputs"]], float)

    def test_white_inputs_are_lyapunovs(self):
        A, B, C, D = self.make_carts()
        W = np.diag([4.0, 1.0])
        random = self.respond("--psd", "f1=4", "--psd", "f2=1", "-o", "r.h5")
        X = scipy.linalg.solve_continuous_lyapunov(A, -B @ (W / 2) @ B.T)
        rms = np.sqrt(np.diag(C @ X @ C.T))
        np.testing.assert_allclose(self.get(random, "total_rms")[:2], rms[:2], rtol=1e-10)
        rates = np.sqrt(np.diag(C @ A @ X @ A.T @ C.T)) / rms / 2 / math.pi
        self.assertAlmostEqual(self.get(random, "total_zero_crossings_hz")[0] / rates[0], 1, delta=1e-10)
        # The rate of a speed and an acceleration are white: no bound.
        self.assertIsNone(random["outputs"][1]["total_zero_crossings_hz"])
        self.assertIsNone(random["outputs"][2]["total_rms"])
        # From 0 to a decade above the poles: nearly everything.
        self.assertEqual(random["from_hz"], 0)
        self.assertAlmostEqual(self.get(random, "band_rms")[0] / rms[0], 1, delta=1e-4)
        self.assertAlmostEqual(self.get(random, "rms")[0] / rms[0], 1, delta=0.01)
        with h5py.File(self.path("r.h5")) as file:
            f, psd = file["frequency_hz"][:], file["random/psd"][:]
            for k in range(0, len(f), 23):
                H = calc_response(A, B, C, D, f[k])
                exact = np.diag(H @ W @ H.conj().T).real
                np.testing.assert_allclose(psd[k], exact, rtol=1e-9, atol=1e-18)  # at 0 Hz a speed is round-off
            trapezoids = np.sqrt(scipy.integrate.cumulative_trapezoid(psd, f, axis=0, initial=0))
            np.testing.assert_allclose(file["random/cumulative_rms"][:], trapezoids, rtol=1e-10, atol=1e-15)
            np.testing.assert_allclose(file["random/rms"][:], trapezoids[-1], rtol=1e-10)
            np.testing.assert_array_equal(file["random/total_rms"][:] < 0, [False, False, True])

    def test_a_band_is_the_band_limited_gramian(self):
        """(jω - A)⁻¹ Q (jω - A)⁻ᴴ = R X + X Rᴴ with A X + X Aᵀ + Q = 0, and ∫R dω = -j ln(jω - A)."""
        A, B, C, D = self.make_carts()
        W = np.diag([4.0, 1.0])
        X = scipy.linalg.solve_continuous_lyapunov(A, -B @ W @ B.T)
        low, high = (2j * math.pi * f * np.eye(len(A)) - A for f in (1.7, 3.6))
        R = -1j * (scipy.linalg.logm(high) - scipy.linalg.logm(low))
        exact = np.sqrt(np.diag(C @ (R @ X + X @ R.conj().T) @ C.T).real / 2 / math.pi)
        random = self.respond("--psd", "f1=4", "--psd", "f2=1", "--from", "1.7", "--to", "3.6")
        np.testing.assert_allclose(self.get(random, "band_rms")[:2], exact[:2], rtol=1e-9)

    def test_tables_and_cross_terms_are_quadrature(self):
        A, B, C, D = self.make_carts()
        self.write("wind.toml", TABLES)
        random = self.respond("--psd", "wind.toml")
        np.testing.assert_allclose((random["from_hz"], random["to_hz"]), (0.5, 8), rtol=1e-14)
        self.assertIn("white", random["no_total"])
        poles = np.abs(np.linalg.eigvals(A).imag) / 2 / math.pi
        ends = sorted({0.5, 1, 2.5, 3, 4, 6, 8, *poles})
        for i in range(3):
            def density(f, power=0):
                row = calc_response(A, B, C, D, f)[i]
                return f**power * (row @ calc_tables(f) @ row.conj()).real
            m0, m2 = (sum(scipy.integrate.quad(density, a + 1e-13, b - 1e-13, (power,), epsrel=1e-11, limit=200)[0]
                          for a, b in zip(ends, ends[1:])) for power in (0, 2))
            self.assertAlmostEqual(self.get(random, "band_rms")[i] / math.sqrt(m0), 1, delta=1e-8)
            self.assertAlmostEqual(self.get(random, "band_zero_crossings_hz")[i] / math.sqrt(m2 / m0), 1, delta=1e-8)

    def test_tables_of_csv_and_toml_are_one(self):
        self.make_carts()
        self.write("all.csv", "frequency_hz,f1,f2\n1,2,1\n5,3,2\n")
        self.write("one.csv", "1,2\n5,3\n")
        self.write("all.toml", toml(
            table("psd", input="f1", file="one.csv"),
            table("psd", input="f2", frequency_hz=[1, 5], density=[1, 2])))
        a, b = self.respond("--psd", "all.csv"), self.respond("--psd", "all.toml")
        self.assertEqual(a, b)
        # One number for all inputs is a number for each.
        self.assertEqual(self.respond("--psd", "2"), self.respond("--psd", "f1=2", "--psd", "f2=2"))

    def test_the_file_of_the_page(self):
        """The [[psd]] of docs/random-response.md, with the inputs of the carts."""
        self.make_carts()
        with open(os.path.join(SOURCE, "docs/random-response.md"), encoding="utf-8") as page:
            block = page.read().split("```toml\n")[1].split("```")[0]
        self.write("wheel.csv", "1,1e-3\n100,1e-3\n")
        self.write("noise.toml", block.replace('"thruster"', '"f1"').replace('"wheel"', '"f2"'))
        for arguments in (["--psd", "1e-6"], ["--psd", "f2=1e-6", "--psd", "f1=2"], ["--psd", "noise.toml"]):
            random = self.respond(*arguments, "-o", "random.h5", "--csv", "random.csv")
            self.assertTrue(all(one["band_rms"] > 0 for one in random["outputs"]))
        self.assertAlmostEqual(random["to_hz"], 100, delta=1e-9)

    def test_a_long_history_lies_within_chi_square_bounds(self):
        A, B, C, D = self.make_carts()
        W = np.diag([4.0, 1.0])
        random = self.respond("--psd", "f1=4", "--psd", "f2=1", "-o", "r.h5")
        step, steps, n = 0.01, 1 << 20, len(A)
        # Van Loan's discrete covariance of the white noise of a step.
        block = scipy.linalg.expm(step * np.block([[-A, B @ (W / 2) @ B.T], [np.zeros((n, n)), A.T]]))
        Ad = block[n:, n:].T
        root = np.linalg.cholesky(Ad @ block[:n, n:] + 1e-18 * np.eye(n))
        noise = root @ np.random.default_rng(3).standard_normal((n, steps))
        values, vectors = np.linalg.eig(Ad)
        y = np.zeros(steps, complex)
        for value, drive, gain in zip(values, np.linalg.solve(vectors, noise), (C @ vectors)[0]):
            y += gain * scipy.signal.lfilter([1], [1, -value], drive)
        y = y.real[20000:]
        with h5py.File(self.path("r.h5")) as file:
            f, psd = file["frequency_hz"][:], file["random/psd"][:, 0]
        # var(σ̂²) = ∫S² df / T: as many degrees of freedom as a chi-square distribution of that variance has.
        m0 = self.get(random, "band_rms")[0] ** 2
        freedom = 2 * len(y) * step * m0**2 / np.trapezoid(psd**2, f) if hasattr(np, "trapezoid") else \
            2 * len(y) * step * m0**2 / np.trapz(psd**2, f)
        low, high = scipy.stats.chi2.interval(0.999, freedom)
        self.assertGreater(freedom, 1000)
        self.assertTrue(low < freedom * np.var(y) / m0 < high, (np.var(y) / m0, freedom))
        # The periodogram averaged over segments, at frequencies across both resonances.
        at, estimate = scipy.signal.welch(y, 1 / step, "boxcar", 8192, 0, detrend=False)
        segments = len(y) // 8192
        low, high = scipy.stats.chi2.interval(1 - 1e-4, 2 * segments)
        chosen = np.flatnonzero((at > 0.5) & (at < 6))[::9]
        exact = np.array([abs(calc_response(A, B, C, D, x)[0]) ** 2 @ np.diag(W) for x in at[chosen]])
        ratio = 2 * segments * estimate[chosen] / exact
        self.assertTrue(np.all((ratio > low) & (ratio < high)), ratio / 2 / segments)

    def test_integrals_that_differ_are_reported(self):
        self.make_carts()
        few = self.bough("response", "model.h5", "--outputs", "place:x", "--psd", "1", "--points", "1", "--from", "1",
                         "--to", "2.9")
        self.assertIn("[linear.random-band]", few.stderr)
        self.write("spike.toml", table("psd", input="f1", frequency_hz=[1.0, 2.0, 2.001, 2.002],
                                       density=[0.0, 0.0, 100.0, 0.0]))
        self.assertNotIn("random-sampling", self.bough("response", "model.h5", "--psd", "spike.toml").stderr)
        # The table of one input ends where that of another goes on: a line across the jump.
        self.write("jump.toml", toml(
            table("psd", input="f1", frequency_hz=[1.0, 2.0], density=[100.0, 100.0]),
            table("psd", input="f2", frequency_hz=[1.0, 5.0], density=[1e-6, 1e-6])))
        self.assertIn("[linear.random-sampling]", self.bough("response", "model.h5", "--psd", "jump.toml", "--points",
                                                             "1").stderr)

    def test_outputs_that_do_not_settle(self):
        self.make_carts(stiffness=0.0, damping=0.0)
        # Both carts drift away: no bound from 0 to infinity, but one in a band.
        random = self.respond("--psd", "f1=1")
        self.assertGreater(random["from_hz"], 0)
        self.assertIsNone(random["outputs"][0]["total_rms"])
        self.write("carts.toml", self.read("carts.toml").replace("damping = [0.5]", "damping = [-0.5]"))
        self.linearize("carts.toml")
        self.fails(3, "response", "model.h5", "--psd", "1", error="linear.unbounded-random", says=["does not decay"])

    def test_csv_and_table(self):
        self.make_carts()
        text = self.bough("response", "model.h5", "--psd", "1", "--csv", "r.csv").stdout
        self.assertRegex(text, r"random response, 0 to [\d.]+ Hz\n *output +RMS +N0 Hz +band RMS +band N0 Hz +white RMS")
        table = np.genfromtxt(self.path("r.csv"), delimiter=",", names=True, deletechars="")
        self.assertEqual(table.dtype.names[:3], ("frequency_hz", "place:x:psd", "place:x:cumulative_rms"))
        found = json.loads(self.bough("response", "model.h5", "--psd", "1", "--json").stdout)["random"]
        self.assertAlmostEqual(table["place:x:cumulative_rms"][-1] / found["outputs"][0]["rms"], 1, delta=1e-10)

    def test_pictures_and_page(self):
        """The curves of --psd are the columns of the file; the page has every RMS."""
        self.make_carts()
        random = self.respond("--psd", "f1=4", "--psd", "f2=1", "-o", "r.h5")
        self.bough("plot", "r.h5", "--sensor", "place", "--sensor", "speed:x", "--psd", "-o", "p.svg", "--csv", "p.csv")
        with open(self.path("p.csv"), encoding="utf-8") as f:
            rows = [(name, float(x), float(y)) for name, x, y in list(csv.reader(f))[1:]]
        names = {row[0] for row in rows}
        with h5py.File(self.path("r.h5")) as f:
            for i, name in enumerate(OUTPUTS[:2]):
                label = next(n for n in names if name in n)
                self.assertIn(f"RMS {random['outputs'][i]['rms']:.4g}", label)
                curve = np.array([(x, y) for which, x, y in rows if which == label])
                np.testing.assert_allclose(curve[:, 0], f["frequency_hz"], rtol=1e-15)
                np.testing.assert_allclose(curve[:, 1], f["random/psd"][:, i], rtol=1e-15)
        self.bough("report", "r.h5", "-o", "r.html")
        with open(self.path("r.html"), encoding="utf-8") as f:
            page = f.read()
        for one in random["outputs"][:2]:
            self.assertIn(f"{one['rms']:.6g}", page)
        self.assertIn("no bound", page)  # an acceleration under white noise
        self.fails(1, "plot", "r.h5", "--sensor", "speed:x", error="cli.nothing-to-plot", says=["--psd"])
        self.fails(1, "plot", "r.h5", "--sensor", "sped:x", "--psd", error="cli.unknown-channel", says=["speed:x"])
        self.bough("response", "model.h5", "-o", "plain.h5")
        self.fails(1, "plot", "plain.h5", "--sensor", "speed:x", "--psd", error="cli.no-random", says=["--psd INPUT"])

    def test_bad_densities_are_named_with_file_and_line(self):
        self.make_carts()
        for item, says in (("f1=-2", "-2"), ("f1=nan", "nan")):
            self.fails(1, "response", "model.h5", "--psd", item, error="linear.bad-psd", says=[says])
        for items in (["f1=1", "f1=2"], ["2", "f2=1"], ["f1=1", "all.csv"]):
            self.write("all.csv", "frequency_hz,f1,f2\n1,2,0\n3,2,0\n")
            arguments = [word for item in items for word in ("--psd", item)]
            self.fails(1, "response", "model.h5", *arguments, error="linear.bad-psd",
                       says=["given twice", "--psd " + items[0]])
        self.bough("response", "model.h5", "--psd", "f2=1", "--psd", "all.csv")  # its column of f2 is zero
        self.fails(1, "response", "model.h5", "--psd", "f3=1", error="linear.unknown-input")
        self.fails(1, "response", "model.h5", "--psd", "none.toml", error="cli.no-file")
        self.write("bad.csv", "frequency_hz,f1\n1,2\n2,-1\n")
        self.fails(1, "response", "model.h5", "--psd", "bad.csv", error="linear.bad-psd", says=["bad.csv:3"])
        start = '[[psd]]\ninput = "f1"\n'
        for text, line, says in (
                (start + "density = -1.0\n", 3, "negative"),
                (start + "density = 1.0\nimaginary = 0.5\n", 4, "not Hermitian"),
                (start + "frequency_hz = [1, 1]\ndensity = [1, 1]\n", 3, "do not rise"),
                (start + "frequency_hz = [1, 2]\ndensity = [1, 1, 1]\n", 4, "3 numbers, expected 2"),
                (start + 'frequency_hz = [0, 2]\ndensity = [1, 1]\ninterpolation = "log"\n', 5, "above 0"),
                (start + "density = 1\n" + table("psd", input="f1", with_="f2", density=0.1, imaginary=0.2)
                 + table("psd", input="f2", with_="f1", density=0.1, imaginary=0.2), 9, "not the conjugate")):
            self.write("bad.toml", text)
            self.fails(1, "response", "model.h5", "--psd", "bad.toml", error="linear.bad-psd",
                       says=[f"bad.toml:{line}", says])
        self.write("bad.toml", toml(
            table("psd", input="f1", density=1),
            table("psd", input="f2", density=1),
            table("psd", input="f1", with_="f2", density=1.2)))
        self.fails(1, "response", "model.h5", "--psd", "bad.toml", error="linear.bad-psd", says=["semi-definite"])
        self.write("bad.toml", start + 'file = "none.csv"\n')
        self.fails(1, "response", "model.h5", "--psd", "bad.toml", error="toml.table-file", says=["bad.toml:3"])


del LinearTest

if __name__ == "__main__":
    unittest.main()
