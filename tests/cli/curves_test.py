"""bough plot: spectra against SciPy, phase plots, differences, windows, axes, campaigns, the terminal."""
import csv
import os
import re
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np
from scipy import signal

from support import ProgramTest
from toml_text import Bare, section, table, toml

SVG = "{http://www.w3.org/2000/svg}"
SYSTEM = toml(
    table("body", "bob", mass=2.0),
    table("hinge", "slide", "prismatic", parent="ground", child="bob", axis=[1.0, 0.0, 0.0], stiffness=[50.0],
          damping=[Bare("{damping}")], position=[0.1]),
    table("sensor", "place", "position", body="bob"),
    section("simulation", duration=20.0, output_step=Bare("{step}")),
    name="oscillator")


def read_ticks(svg):
    """Pixels and numbers of the axes' labels; the frame is the last rectangle."""
    frame = [float(svg.findall(f"{SVG}rect")[-1].get(k)) for k in ("x", "y", "width", "height")]
    x, y = [], []
    for text in svg.iter(f"{SVG}text"):
        words = (text.text or "").replace("\u2212", "-")
        if not re.fullmatch(r"-?[\d.]+(e[+-]?\d+)?", words):
            continue
        if text.get("text-anchor") == "middle":
            x.append((float(text.get("x")), float(words)))
        elif text.get("text-anchor") == "end":
            y.append((float(text.get("y")) - 4.5, float(words)))
    return frame, x, y


def read_curves(svg):
    """Points of each curve in pixels."""
    curves = []
    for path in svg.findall(f"{SVG}path"):
        if path.get("stroke-linejoin") == "round" and "h28" not in path.get("d"):
            numbers = np.array([float(v) for v in re.findall(r"-?[\d.]+", path.get("d"))])
            curves.append(numbers.reshape(-1, 2))
    return curves


def scale(pixels, ticks, is_log):
    """Numbers of pixels by the first and last tick."""
    (p0, v0), (p1, v1) = ticks[0], ticks[-1]
    if is_log:
        v0, v1 = np.log10(v0), np.log10(v1)
    values = v0 + (pixels - p0) * (v1 - v0) / (p1 - p0)
    return 10**values if is_log else values


class Plot(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, damping, step in [("a", 0.4, 0.02), ("b", 0.8, 0.02), ("c", 0.8, 0.03)]:
            self.write(f"{name}.toml", SYSTEM.format(damping=damping, step=step))
            self.bough("run", f"{name}.toml", "-o", f"{name}.h5", "-q")
        self.results = {}
        for name in "abc":
            with h5py.File(self.path(f"{name}.h5")) as f:
                self.results[name] = {"time": f["time"][:], "x": f["sensors/place"][:, 0], "q": f["hinges/slide/q"][:],
                                      "qdot": f["hinges/slide/qdot"][:]}

    def draw(self, *arguments):
        """The picture, as a list of plots."""
        self.said = self.bough("plot", *arguments, "-o", "p.svg").stderr
        root = ElementTree.parse(self.path("p.svg")).getroot()
        return root.findall(f"{SVG}svg") or [root]

    def get_points(self, *arguments):
        self.bough("plot", *arguments, "--csv", "p.csv")
        with open(self.path("p.csv"), newline="") as f:
            rows = list(csv.reader(f))[1:]
        self.curves = list(dict.fromkeys(row[0] for row in rows))
        return np.array([row[1:] for row in rows], float)

    def read(self, svg, log_x=False, log_y=False):
        frame, x, y = read_ticks(svg)
        return [np.column_stack((scale(c[:, 0], x, log_x), scale(c[:, 1], y, log_y))) for c in read_curves(svg)], frame

    def check(self, found, x, y):
        """Points of the picture lie on the curve, within a pixel of 800 by 400."""
        at = np.interp(found[:, 0], x, y)
        np.testing.assert_allclose(found[:, 1], at, atol=0.012 * np.ptp(y))
        self.assertAlmostEqual(found[:, 0].min(), np.min(x), delta=0.003 * np.ptp(x))
        self.assertAlmostEqual(found[:, 0].max(), np.max(x), delta=0.003 * np.ptp(x))

    def test_window_and_subplots(self):
        a = self.results["a"]
        plots = self.draw("a.h5", "--sensor", "place:x", "--channel", "/hinges/slide/qdot", "--window", "2,5",
                          "--subplots")
        self.assertEqual(len(plots), 2)
        inside = (a["time"] >= 2) & (a["time"] <= 5)
        for svg, key in zip(plots, ["x", "qdot"]):
            (curve,), _ = self.read(svg)
            self.check(curve, a["time"][inside], a[key][inside])

    def test_subplots_are_named_after_their_channels(self):
        plots = self.draw("a.h5", "--sensor", "place:x", "--sensor", "/hinges/slide/qdot", "--subplots")
        texts = [[text.text for text in svg.iter(f"{SVG}text")] for svg in plots]
        self.assertIn("a", texts[0])
        self.assertEqual([[t for t in own if t and "[" in t and "time" not in t] for own in texts],
                         [["place:x [L]"], ["hinges/slide/qdot [L/T]"]])

    def test_powers_of_units_are_raised(self):
        (svg,) = self.draw("a.h5", "--sensor", "place:x", "--psd", "--y-label", "density [m^2/Hz]")
        self.assertIn("density [m²/Hz]", [text.text for text in svg.iter(f"{SVG}text")])

    def test_curves_have_their_names(self):
        self.get_points("a.h5", "b.h5", "--sensor", "place:x", "--sensor", "/hinges/slide/q")
        self.assertEqual(self.curves, ["a place:x", "a hinges/slide/q", "b place:x", "b hinges/slide/q"])

    def test_a_segment_longer_than_the_samples_is_told(self):
        for segment, is_told in [("5000", True), ("500", False)]:
            self.draw("a.h5", "--sensor", "place:x", "--psd", "--segment", segment)
            self.assertEqual("[cli.short-segment]" in self.said, is_told, self.said)
        self.draw("a.h5", "--sensor", "place:x", "--psd", "--segment", "5000")
        self.assertIn("which has 1001", self.said)

    def test_phase_plot(self):
        a = self.results["a"]
        n = np.searchsorted(a["time"], 1.5, side="right")
        options = ["a.h5", "--sensor", "/hinges/slide/qdot", "--x", "/hinges/slide/q", "--window", "0,1.5"]
        np.testing.assert_array_equal(self.get_points(*options), np.column_stack((a["q"], a["qdot"]))[:n])
        (svg,) = self.draw(*options)
        (curve,), _ = self.read(svg)
        curve = curve[np.r_[True, np.abs(np.diff(curve, axis=0)).max(1) > 0]]  # a stroke may begin anew where one ends
        self.assertEqual(len(curve), n)
        np.testing.assert_allclose(curve, np.column_stack((a["q"], a["qdot"]))[:n], atol=3e-3)

    def test_time_by_its_path(self):
        """--x /time is the time, as without it."""
        options = ["a.h5", "--sensor", "/hinges/slide/qdot"]
        plain = self.get_points(*options)
        for name in ("/time", "time"):
            np.testing.assert_array_equal(self.get_points(*options, "--x", name), plain)

    def test_psd(self):
        a = self.results["a"]
        (svg,) = self.draw("a.h5", "--sensor", "place:x", "--psd", "--segment", "200")
        (curve,), _ = self.read(svg, log_y=True)
        for segment in [200, 255, 5000]:
            f, wanted = signal.welch(a["x"], 50, nperseg=min(segment, len(a["x"])))
            found = self.get_points("a.h5", "--sensor", "place:x", "--psd", "--segment", segment)
            np.testing.assert_allclose(found[:, 0], f, rtol=1e-10)
            np.testing.assert_allclose(found[:, 1], wanted, rtol=1e-10, atol=1e-10 * wanted.max())
        f, wanted = signal.welch(a["x"], 50, nperseg=200)
        self.assertEqual(len(curve), len(f))
        np.testing.assert_allclose(curve[:, 0], f, atol=0.05)
        np.testing.assert_allclose(np.log10(curve[:, 1]), np.log10(wanted), atol=0.03)

    # Half sine of 100 for 11 ms, 10 us apart, as the acceleration of a base; the mass on it is soft.
    SHOCK = ("SOL 109\nCEND\nSPC = 1\nDLOAD = 9\nTSTEP = 3\nACCELERATION = ALL\nDISPLACEMENT = ALL\nBEGIN BULK\nGRID,1,,0.,0.,0.,,23456\nGRID,2,,0.,0.,0.,,23456\n"
             "CONM2,1,2,,1.\nCELAS2,1,1.,1,1,2,1\nSPC1,1,1,1\nTLOAD1,9,10,,ACCE,7\nSPCD,10,1,1,1.\nTSTEP,3,1110,1.-5\nTABLED1,7\n{table},ENDT\nENDDATA\n")

    def test_shock_spectrum(self):
        """Half sine of 100 g and 11 ms, Q 10: closed form of the absolute acceleration; the five kinds by a fine integration."""
        times = np.arange(0, 1101) * 1e-5
        pairs = [f"{t:.6f},{100 * np.sin(np.pi * t / .011) if i < 1100 else 0.:.9e}" for i, t in enumerate(times)] + ["1.,0."]
        self.write("s.bdf", self.SHOCK.format(table="\n".join("," + ",".join(pairs[i:i + 4]) for i in range(0, len(pairs), 4))))
        self.bough("transient", "s.bdf", "-o", "s.h5")
        exact = {10: 40.518, 20: 78.311, 50: 152.629, 100: 159.140, 200: 113.961, 500: 104.702, 1000: 100.756}
        for hz, value in exact.items():
            found = self.get_points("s.h5", "--sensor", "acceleration:1:1", "--srs", "absolute-acceleration", "--srs-range", f"{hz},{2 * hz},1")
            self.assertAlmostEqual(found[0, 1] / value, 1, delta=2e-5)
        peak = self.get_points("s.h5", "--sensor", "acceleration:1:1", "--srs", "absolute-acceleration", "--srs-range", "70,80,2000")
        self.assertAlmostEqual(peak[:, 1].max(), 165.163, delta=2e-3)
        self.assertAlmostEqual(peak[peak[:, 1].argmax(), 0], 74.85, delta=.1)
        options = ["--srs-part", "negative", "--srs-range", "100,200,1"]
        found = self.get_points("s.h5", "--sensor", "acceleration:1:1", "--srs", "absolute-acceleration", *options)
        self.assertAlmostEqual(found[0, 1], 87.337, delta=2e-3)
        # Exact steps of the matrix exponential over the pulse and two periods after it; the samples end at 11.1 ms.
        w, z, h = 2 * np.pi * 100, .025, 2e-6
        A = np.array([[0, 1, 0, 0], [-w * w, -2 * z * w, -1, 0], [0, 0, 0, 1], [0, 0, -(np.pi / .011)**2, 0]])
        from scipy.linalg import expm
        x, states = np.array([0, 0, 0, 100 * np.pi / .011]), []
        step, free = expm(A * h), expm(np.block([[A[:2, :2], np.zeros((2, 2))], [np.zeros((2, 4))]]) * h)
        for k in range(5500 + 10000):
            x = (step if k < 5500 else free) @ x
            states.append([*x[:2], x[2] if k < 5500 else 0])
        u, v, a = np.array(states).T
        kinds = {"absolute-acceleration": -w * w * u - 2 * z * w * v, "static-acceleration": -w * w * u, "pseudo-velocity": w * u,
                 "relative-velocity": v, "relative-displacement": u}
        for kind, y in kinds.items():
            for part, value in (("maximax", np.abs(y).max()), ("positive", y.max()), ("negative", -y.min()),
                                ("primary", np.abs(y[:5550]).max()), ("residual", np.abs(y[5549:]).max())):
                found = self.get_points("s.h5", "--sensor", "acceleration:1:1", "--srs", kind, "--srs-part", part, "--q", "20",
                                        "--srs-range", "100,200,1")
                self.assertAlmostEqual(found[0, 1] / value, 1, delta=1e-4, msg=(kind, part))
        self.assertIn("cli.coarse-shock", self.bough("plot", "s.h5", "--sensor", "acceleration:1:1", "--srs", "pseudo-velocity",
                                                     "--srs-range", "100,30000", "-o", "s.svg").stderr)
        self.fails(1, "plot", "s.h5", "--sensor", "acceleration:1:1", "--srs", "pseudo-velocity", "--srs-range", "100,50", error="cli.bad-range")
        # A curve that is no acceleration: a warning, for a response and for a run.
        plot = lambda file, name: self.bough("plot", file, "--sensor", name, "--srs", "pseudo-velocity", "-o", "s.svg").stderr
        self.assertNotIn("cli.shock-input", plot("s.h5", "acceleration:1:1"))
        self.assertIn("displacement:2:1 is a displacement, found no acceleration", plot("s.h5", "displacement:2:1"))
        self.write("run.toml", SYSTEM.replace("{damping}", "0.5").replace("{step}", "0.01").replace(
            "[simulation]", '[[sensor]]\nname = "shake"\ntype = "acceleration"\nbody = "bob"\n[simulation]'))
        self.bough("run", "run.toml", "-o", "run.h5")
        self.assertIn("sensors/place:x is of dimensions L, found no acceleration", plot("run.h5", "place:x"))
        self.assertNotIn("cli.shock-input", plot("run.h5", "shake:x"))

    def test_spectrum(self):
        a = self.results["a"]
        (svg,) = self.draw("a.h5", "--sensor", "place:x", "--spectrum", "--log-y")
        (curve,), _ = self.read(svg, log_y=True)
        f, wanted = signal.periodogram(a["x"], 50, window="hann", detrend="linear", scaling="spectrum")
        wanted = np.sqrt(wanted * 2)
        wanted[0] /= np.sqrt(2)
        found = self.get_points("a.h5", "--sensor", "place:x", "--spectrum")
        np.testing.assert_allclose(found[:, 0], f, rtol=1e-10)
        np.testing.assert_allclose(found[:, 1], wanted, rtol=1e-9, atol=1e-10 * wanted.max())
        np.testing.assert_allclose(np.log10(curve[1:, 1]), np.log10(wanted[1:]), atol=0.05)
        peak = curve[np.argmax(curve[:, 1]), 0]
        self.assertAlmostEqual(peak, 5 / (2 * np.pi), delta=0.06)

    def test_log_axes(self):
        (svg,) = self.draw("a.h5", "--sensor", "/energy/kinetic", "--log-x", "--log-y")
        (curve,), frame = self.read(svg, True, True)
        a = self.results["a"]
        self.assertTrue((curve > 0).all())
        self.assertLess(curve[0, 0], 0.021)
        points = self.get_points("a.h5", "--sensor", "/energy/kinetic", "--log-x", "--log-y")
        np.testing.assert_allclose(points[:, 1], a["qdot"]**2, rtol=1e-9, atol=1e-15)  # m = 2
        points = points[(points[:, 0] > 0) & (points[:, 0] < 0.5)]  # later its zeros come within a pixel
        drawn = np.interp(np.log(points[:, 0]), np.log(curve[:, 0]), np.log10(curve[:, 1]))
        np.testing.assert_allclose(drawn, np.log10(points[:, 1]), atol=0.02)

    def test_difference(self):
        a, b, c = (self.results[k] for k in "abc")
        (svg,) = self.draw("a.h5", "b.h5", "--sensor", "place:x", "--difference")
        (curve,), _ = self.read(svg)
        self.check(curve, a["time"], b["x"] - a["x"])
        self.assertEqual(self.said, "")
        self.bough("plot", "a.h5", "c.h5", "--sensor", "place:x", "--difference", "-v", "-o", "p.svg")
        (svg,) = self.draw("a.h5", "c.h5", "--sensor", "place:x", "--difference")
        self.assertIn("[cli.interpolated]", self.said)
        (curve,), _ = self.read(svg)
        common = a["time"] <= c["time"][-1]
        self.check(curve, a["time"][common], np.interp(a["time"][common], c["time"], c["x"]) - a["x"][common])

    def test_terminal(self):
        for width in [60, 100]:
            text = self.bough("plot", "a.h5", "--sensor", "place:x", "--term", env={"COLUMNS": str(width)}).stdout
            lines = text.splitlines()
            self.assertLessEqual(max(map(len, lines)), width)
            self.assertGreaterEqual(max(map(len, lines)), width - 1)
            rows = [re.split("[\u2502\u2524]", line)[1] for line in lines if re.search("[\u2502\u2524]", line)]
            self.assertEqual(len(rows), 16)
            # The highest dot of each column of characters holds the largest value of its part of the time.
            a = self.results["a"]
            columns = max(map(len, lines)) - lines[-2].index("\u2514") - 1
            part = np.floor(a["time"] / a["time"][-1] * (2 * columns - 1) + 0.5).astype(int) // 2  # two dots a character
            for column in range(columns):
                marks = [r for r, row in enumerate(rows) if column < len(row) and row[column] != " "]
                # A line from the neighbours may rise in this column.
                own, near = a["x"][part == column].max(), a["x"][np.abs(part - column) <= 1].max()
                lowest, highest = ((a["x"].max() - v) / np.ptp(a["x"]) * 63 / 4 for v in (own, near))
                self.assertLessEqual(min(marks), lowest + 0.2)
                self.assertGreaterEqual(min(marks), highest - 1)
            self.assertFalse(os.path.exists(self.path("place_x.svg")))

    def test_campaign(self):
        with h5py.File(self.path("outcomes.h5"), "w") as f:
            f.attrs["format"] = "bough-outcomes"
            f.attrs["format_version"] = "1.0"
            f.attrs["campaign"] = "many"
            f.attrs["fingerprint"] = "0" * 64
            f["case"] = np.arange(1, 6, dtype=np.int32)
            f["parameters/mass"] = [1.0, 2.0, 3.0, 4.0, 5.0]
            f["outputs/top"] = [3.0, 1.0, 2.0, 5.0, np.nan]
        (svg,) = self.draw("outcomes.h5", "--sensor", "top", "--x", "mass")
        frame, x, y = read_ticks(svg)
        marks = [(float(c.get("cx")), float(c.get("cy"))) for c in svg.findall(f"{SVG}circle")]
        places = [(scale(u, x, False), scale(v, y, False)) for u, v in marks if v > frame[1]]
        np.testing.assert_allclose(places, [(1, 3), (2, 1), (3, 2), (4, 5)], atol=0.03)
        (svg,) = self.draw("outcomes.h5", "--sensor", "top")
        (curve,), _ = self.read(svg)
        np.testing.assert_allclose(curve, [(0, 1), (100 / 3, 2), (200 / 3, 3), (100, 5)], atol=0.3)
        self.fails(1, "plot", "outcomes.h5", "--sensor", "tip", error="cli.unknown-channel")
        # A case that failed takes no part in the axes, and is told.
        with h5py.File(self.path("outcomes.h5"), "r+") as f:
            f["parameters/mass"][4] = -1e5
        for options in [["--x", "mass"], []]:
            self.draw("outcomes.h5", "--sensor", "top", *options)
            self.assertIn("1 of 5 cases have no value of top", self.said)
            self.assertIn("[cli.cases-left-out]", self.said)
        (svg,) = self.draw("outcomes.h5", "--sensor", "top", "--x", "mass")
        _, x, _ = read_ticks(svg)
        self.assertGreaterEqual(min(v for _, v in x), 0)
        for option in ["--psd", "--spectrum", ["--window", "0,1"]]:
            self.fails(1, "plot", "outcomes.h5", "--sensor", "top", *(option if isinstance(option, list) else [option]),
                       error="cli.plot-option")

    def test_what_cannot_be_drawn(self):
        self.fails(1, "plot", "a.h5", "--sensor", "place:x", "--difference", error="cli.nothing-to-plot")
        self.fails(1, "plot", "a.h5", "--sensor", "place:x", "--window", "30,40", error="cli.bad-range")
        self.fails(1, "plot", "a.h5", "--sensor", "place:x", "--window", "3,2", error="cli.bad-range")
        self.fails(1, "plot", "a.h5", "--sensor", "place:x", "--x", "place", says=["3 curves"], error="cli.one-channel")
        with h5py.File(self.path("a.h5"), "r+") as f:
            f["time"][5] += 0.004
        self.fails(1, "plot", "a.h5", "--sensor", "place:x", "--psd", error="cli.uneven-samples")
        self.fails(2, "plot", "a.h5", "--sensor", "place:x", "--psd", "--spectrum", error="cli.usage")


if __name__ == "__main__":
    unittest.main()
