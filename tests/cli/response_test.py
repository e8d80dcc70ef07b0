"""response, linearize --break, --sweep, --each and plots of linear models, against scipy and closed forms."""
import json
import math
import os
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np
import scipy.linalg
import scipy.optimize

from curves_test import SVG, read_ticks, scale
from linear_test import HUB, PENDULUM, LinearTest
from support import SOURCE
from toml_text import section, table, toml

sys.path.insert(0, os.path.join(SOURCE, "tests/oracle"))
import uff_reader  # noqa: E402

AXIS = toml(
    section("parameters", kp=8.0, kd=1.6),
    table("body", "rotor", mass=1.0, cg=[0.0, 0.0, 0.0], inertia=[1.0, 1.0, 2.0]),
    table("hinge", "axis", "revolute", child="rotor", axis=[0.0, 0.0, 1.0]),
    table("sensor", "angle", "hinge_angle", hinge="axis"),
    table("sensor", "rate", "hinge_rate", hinge="axis"),
    table("controller", "law", "pid", inputs=["angle"], rate="rate", kp="$kp", kd="$kd"),
    table("actuator", "drive", "hinge", hinge="axis", input="law"),
    section("simulation", duration=2.0, output_step=0.5))

TOP = toml(
    section("parameters", spin=3.0),
    table("body", "top", mass=1.0, cg=[0.0, 0.0, 0.0], inertia=[2.0, 2.0, 3.0]),
    table("hinge", "gimbal", "universal", child="cage", axis=[1.0, 0.0, 0.0], stiffness=[5.0, 5.0]),
    table("body", "cage", mass=1e-6, inertia=[1e-9, 1e-9, 1e-9]),
    table("hinge", "wheel", "revolute", parent="cage", child="top", axis=[0.0, 0.0, 1.0], rate=["$spin"]),
    section("simulation", duration=1.0))


class Response(LinearTest):
    def read(self, name):
        with h5py.File(self.path(name)) as f:
            return {key: f[key][()] for key in ["frequency_hz", "real", "imag", "singular_values"]}

    def test_margins_next_to_a_pole_on_the_axis(self):
        """A pole of damping 1e-8, of either sign, is one of a damping of rounding: no gain margin of -150 dB in its
        resonance, the phase margins of an undamped plant, and the pole is named."""
        self.write("axis.toml", AXIS.replace("[[sensor]]", "stiffness = [50.0]\n\n[[sensor]]", 1))
        self.bough("linearize", "axis.toml", "--break", "drive", "-o", "loop.h5")
        exact = json.loads(self.bough("response", "loop.h5", "--json").stdout)["margins"]
        # L = (kp + kd s) / (2 s² + 50): |L| = 1 at ω⁴ 4 - (200 + kd²) ω² + 2500 - kp² = 0.
        omega = np.sqrt(np.roots([4, -(200 + 1.6**2), 2500 - 64]).real)
        np.testing.assert_allclose(sorted(c["frequency_hz"] for c in exact["phase"]), sorted(omega / (2 * np.pi)), rtol=1e-6)
        with h5py.File(self.path("loop.h5")) as f:
            A, real = f["A"][:], f["poles/real"][:]
        np.testing.assert_allclose(np.abs(np.linalg.eigvals(A)), 5, rtol=1e-6)
        for shift in (7e-8, -2e-7):
            with h5py.File(self.path("loop.h5"), "r+") as f:
                f["A"][:] = A + shift * np.eye(2)
                f["poles/real"][:] = real + shift
            margins = json.loads(self.bough("response", "loop.h5", "--json").stdout)["margins"]
            self.assertEqual(margins["gain"], [])
            self.assertTrue(margins["stable"])
            np.testing.assert_allclose([[c["frequency_hz"], c["degrees"]] for c in margins["phase"]],
                                       [[c["frequency_hz"], c["degrees"]] for c in exact["phase"]], rtol=1e-5)
            if shift > 0:
                self.assertIn("the poles ± 5 i are on the imaginary axis", self.bough("response", "loop.h5").stdout)
            self.bough("report", "loop.h5", "-o", "page.html")
            with open(self.path("page.html"), encoding="utf-8") as f:
                page = f.read()
            self.assertIn("poles on the imaginary axis, damping below 1e-7", page)
            self.assertRegex(page, r"poles in the right half plane</td><td[^>]*>0<")

    def test_bode_in_the_terminal(self):
        """Both diagrams have the name of their axis, the phase has labels at multiples of 45 degrees."""
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "-o", "linear.h5")
        text = self.bough("plot", "linear.h5", "--kind", "bode", "--term", env={"COLUMNS": "80"}).stdout
        magnitude, phase = text.split("phase [degrees]\n")
        self.assertIn("magnitude [dB]", magnitude.splitlines()[0])
        labels = [float(m) for m in re.findall(r"(?m)^ *(-?[\d.]+)\u2524", phase)]
        self.assertGreater(len(labels), 3)
        self.assertTrue(all(v % 45 == 0 for v in labels), labels)
        self.assertEqual(len(set(np.diff(labels))), 1, labels)

    def test_of_a_flexible_hub_is_scipys(self):
        self.make_boom(6)
        self.write_hub("hub.toml", eta="damping = 0.01")
        model = self.linearize("hub.toml")
        self.bough("response", "model.h5", "-o", "r.h5", "--csv", "r.csv")
        self.bough("export", "r.h5", "--to", "csv", "-o", "again.csv")
        self.assertEqual(open(self.path("again.csv")).read(), open(self.path("r.csv")).read())
        r = self.read("r.h5")
        w = 2 * math.pi * r["frequency_hz"]
        H = r["real"] + 1j * r["imag"]
        self.bough("export", "r.h5", "--to", "uff", "-o", "r.unv")
        functions = [part for part in uff_reader.read(self.path("r.unv")) if part["dataset"] == 58]
        self.assertEqual(len(functions), H.shape[1] * H.shape[2])
        for k, part in enumerate(functions):
            np.testing.assert_allclose(part["values"], H[:, k // H.shape[2], k % H.shape[2]], rtol=1e-11, atol=1e-300)
            self.assertEqual(part["function"], 4)
        A, B, C, D = (model[k] for k in "ABCD")
        eye = np.eye(len(A))
        for k in range(0, len(w), 17):
            exact = C @ np.linalg.solve(1j * w[k] * eye - A, B) + D
            self.assertLess(np.abs(H[k] - exact).max(), 1e-9 * max(np.abs(exact).max(), 1e-12))
            np.testing.assert_allclose(r["singular_values"][k], np.linalg.svd(exact, compute_uv=False), rtol=1e-8,
                                       atol=1e-12)
        # Every lightly damped pole that is seen has frequencies within its half-power width.
        for re, im in zip(model["poles/real"], model["poles/imag"]):
            if im > 0:
                self.assertLess(np.abs(w - im).min(), 0.6 * abs(re))
        table = np.genfromtxt(self.path("r.csv"), delimiter=",", skip_header=1)
        np.testing.assert_allclose(table[:, 0], r["frequency_hz"], rtol=1e-15)
        np.testing.assert_allclose(table[:, 1], r["real"][:, 0, 0], rtol=1e-15)
        self.assertIn("infinite", self.bough("response", "model.h5").stdout)  # the hub turns freely

    def test_margins_of_a_loop_and_its_closed_form(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--break", "drive", "-o", "loop.h5")
        data = json.loads(self.bough("response", "loop.h5", "--json").stdout)
        kp, kd, J = 8.0, 1.6, 2.0
        # |kp + kd s| = J w²
        w = math.sqrt((kd**2 + math.sqrt(kd**4 + 4 * J**2 * kp**2)) / (2 * J**2))
        phase = math.atan2(kd * w, kp)
        (crossing,) = data["margins"]["phase"]
        self.assertAlmostEqual(crossing["frequency_hz"], w / 2 / math.pi, places=10)
        self.assertAlmostEqual(crossing["degrees"], math.degrees(phase), places=8)
        self.assertAlmostEqual(crossing["delay"], phase / w, places=9)
        self.assertEqual(data["margins"]["gain"], [])
        self.assertTrue(data["margins"]["stable"])
        text = self.bough("response", "loop.h5").stdout
        self.assertIn("stable when closed", text)
        self.assertIn("deg", text)
        self.fails(1, "linearize", "axis.toml", "--break", "drove", says=["did you mean 'drive'"],
                   error="linear.unknown-signal")
        self.bough("linearize", "axis.toml", "-o", "closed.h5")
        self.fails(1, "response", "closed.h5", "--loop", error="linear.no-loop")
        self.fails(1, "response", "closed.h5", "--outputs", "angel", says=["'angle'"], error="linear.unknown-output")
        self.bough("linearize", "axis.toml", "--outputs", "rate", "-o", "one.h5")
        self.bough("response", "one.h5", "--loop", "--from", 0.01, "--to", 10)
        self.fails(1, "response", "one.h5", "--from", 1, "--to", 0.1, error="cli.bad-range")
        self.write("bob.toml", PENDULUM.replace("POSITION", "0.0").split("[[sensor]]")[0] + "[simulation]\nduration = 1.0\n")
        self.bough("linearize", "bob.toml", "-o", "bob.h5")
        self.fails(1, "response", "bob.h5", error="linear.no-channels")

    def test_a_crossing_far_from_poles_and_zeros_is_found(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--set", "kd=1600", "--break", "law", "-o", "loop.h5")
        data = json.loads(self.bough("response", "loop.h5", "--json").stdout)
        kp, kd, J = 8.0, 1600.0, 2.0
        w = math.sqrt((kd**2 + math.sqrt(kd**4 + 4 * J**2 * kp**2)) / (2 * J**2))
        (crossing,) = data["margins"]["phase"]
        self.assertAlmostEqual(crossing["frequency_hz"] / (w / 2 / math.pi), 1, places=10)
        self.bough("report", "loop.h5", "-o", "page.html")
        with open(self.path("page.html")) as f:
            text = f.read()
        self.assertIn("with the loop closed", text)
        self.assertIn("Singular values", text)

    def test_the_norm_is_the_peak(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--outputs", "angle", "-o", "closed.h5")
        data = json.loads(self.bough("response", "closed.h5", "--json").stdout)
        zeta = 1.6 / (2 * math.sqrt(8 * 2))
        # The integral of the law, with ki = 0, is a pole at 0 that no one sees.
        self.assertTrue(data["peak"]["finite"])
        self.assertAlmostEqual(data["peak"]["value"], 1 / 8 / (2 * zeta * math.sqrt(1 - zeta**2)), places=7)
        self.assertTrue(data["peak"]["certified"])

    def test_pictures(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "-o", "closed.h5")
        for kind in ["bode", "nichols", "sigma", "poles"]:
            self.bough("plot", "closed.h5", "--kind", kind, "-o", f"{kind}.svg")
            with open(self.path(f"{kind}.svg")) as f:
                text = f.read()
            self.assertIn("</svg>", text)
            self.assertNotIn("nan", text)
        with open(self.path("bode.svg")) as f:
            text = f.read()
        self.assertIn("angle / drive", text)
        self.assertEqual(text.count("<svg"), 3)  # magnitude above phase
        self.bough("plot", "closed.h5", "--kind", "bode", "--outputs", "rate")
        self.assertTrue(os.path.exists(self.path("closed-bode.svg")))
        self.fails(1, "plot", "closed.h5", "--kind", "campbell", error="cli.plot-kind")
        self.fails(1, "plot", "closed.h5", error="cli.nothing-to-plot")

    def test_labels_of_pictures(self):
        """No text of a Nichols diagram or of poles covers another or a mark; -1 is marked next to the curve, whose phase may be
        beyond a turn; contours close."""
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--outputs", "angle", "-o", "closed.h5")
        for sign, expected in ((1, -180), (-1, 180)):
            with h5py.File(self.path("closed.h5"), "r+") as f:
                f["C"][:] = sign * np.abs(f["C"][:])
            self.bough("plot", "closed.h5", "--kind", "nichols", "-o", "nichols.svg")
            svg = ElementTree.parse(self.path("nichols.svg")).getroot()
            frame, x_ticks, y_ticks = read_ticks(svg)
            marks = [path.get("d") for path in svg.findall(f"{SVG}path") if "m0 -9l-9 9" in path.get("d")]
            places = [[float(v) + 4.5 for v in re.findall(r"[\d.]+", mark)[:2]] for mark in marks]
            inside = [(x, y) for x, y in places if y > frame[1]]      # the legend contains one too
            self.assertIn(expected, [round(float(scale(x, x_ticks, False))) for x, _ in inside])
            for _, y in inside:
                self.assertAlmostEqual(float(scale(y, y_ticks, False)), 0, delta=0.2)
            self.check_texts(svg, frame, inside)
            labels = {t.text for t in svg.iter(f"{SVG}text") if (t.text or "").endswith(" dB")}
            self.assertLessEqual({"3 dB", "1 dB", "\u22121 dB", "\u221220 dB"}, labels)
        self.bough("plot", "closed.h5", "--kind", "poles", "-o", "poles.svg")
        svg = ElementTree.parse(self.path("poles.svg")).getroot()
        self.check_texts(svg, read_ticks(svg)[0], [])

    def check_texts(self, svg, frame, marks):
        """Texts inside the frame, by the mean width of a letter: apart from each other, from marks, and not cut."""
        boxes = [(x - 4.5, y - 4.5, x + 4.5, y + 4.5) for x, y in marks]
        for text in svg.iter(f"{SVG}text"):
            if text.get("x") is None or text.get("font-size") not in ("11", "13"):
                continue
            x, y, size = float(text.get("x")), float(text.get("y")), float(text.get("font-size"))
            width = 0.5 * size * len(text.text)
            left = x - width if text.get("text-anchor") == "end" else x
            if frame[0] < left < frame[0] + frame[2] and frame[1] < y < frame[1] + frame[3]:
                self.assertLess(left + width, frame[0] + frame[2])
                boxes.append((left, y - 0.7 * size, left + width, y))
        for i, a in enumerate(boxes):
            for b in boxes[:i]:
                self.assertFalse(a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3], (a, b))

    def test_many_pairs_and_a_peak_without_end(self):
        """The pairs with the largest peaks are drawn of many; next to a pole without damping nothing is lost."""
        blocks = [section("simulation", duration=1.0)]
        for k in range(4):
            blocks += [table("body", f"b{k}", mass=1.0, inertia=[1.0, 1.0, 1.0]),
                       table("hinge", f"h{k}", "prismatic", child=f"b{k}", axis=[1.0, 0.0, 0.0], stiffness=[1.0 + k]),
                       table("actuator", f"a{k}", "hinge", hinge=f"h{k}"), table("sensor", f"s{k}", "hinge_angle", hinge=f"h{k}")]
        self.write("four.toml", toml(*blocks))
        self.bough("linearize", "four.toml", "-o", "four.h5")
        self.bough("plot", "four.h5", "--kind", "bode", "-o", "four.svg")
        with open(self.path("four.svg")) as f:
            text = f.read()
        self.assertIn("Bode diagram: four, 8 of 16 pairs", text)
        self.assertEqual({f"s{k} / a{k}" for k in range(4)} - set(re.findall(r">(s\d / a\d)<", text)), set())
        self.bough("plot", "four.h5", "--kind", "bode", "--inputs", "a0,a1", "--outputs", "s0,s1,s2,s3", "-o", "two.svg")
        with open(self.path("two.svg")) as f:
            self.assertNotIn(" pairs", f.read())
        self.bough("plot", "four.h5", "--kind", "sigma", "--csv", "sigma.csv")
        with open(self.path("sigma.csv")) as f:
            rows = [line.strip().split(",") for line in f][1:]
        x, y = np.array([[float(v) for v in row[1:]] for row in rows if row[0] == "σ1"]).T
        # 1 / |k - ω²| of the largest, over the whole axis, though it is 1e12 and more at ω = 1.
        exact = np.max([1 / np.abs(1 + k - (2 * np.pi * x)**2) for k in range(4)], axis=0)
        far = np.abs(y) < 100
        np.testing.assert_allclose(y[far], 20 * np.log10(exact[far]), atol=1e-3)
        self.bough("response", "four.h5", "-o", "response.h5")
        self.assertAlmostEqual(x[-1], self.read("response.h5")["frequency_hz"][-1], delta=1e-6 * x[-1])


class Sweep(LinearTest):
    def read(self, name="sweep.h5"):
        with h5py.File(self.path(name)) as f:
            return {key: f[key][()] for key in ["parameter/value", "poles/real", "poles/imag", "poles/frequency_hz",
                                                "poles/correlation", "A"]}

    def test_root_locus_over_a_gain(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--sweep", "kd=0.5:12:23", "-o", "sweep.h5", "--csv", "locus.csv")
        s = self.read()
        for kd, real, imag in zip(s["parameter/value"], s["poles/real"], s["poles/imag"]):
            exact = np.roots([2, kd, 8])
            found = real + 1j * imag
            self.assertLess(np.abs(np.sort_complex(found) - np.sort_complex(exact)).max(), 1e-8)
        self.bough("plot", "sweep.h5", "--kind", "locus", "-o", "locus.svg")
        table = np.genfromtxt(self.path("locus.csv"), delimiter=",", skip_header=1)
        np.testing.assert_allclose(table[:, 0], s["parameter/value"])
        text = self.bough("export", "sweep.h5", "--to", "csv").stdout
        self.assertTrue(text.startswith("kd,"))
        log = json.loads(self.bough("linearize", "axis.toml", "--sweep", "kd=1:100:3:log", "--json").stdout)
        np.testing.assert_allclose(log["value"], [1, 10, 100])
        for bad in ["kd", "kd=1:2", "kd=1:2:1", "kd=0:2:3:log", "kd=a:2:3"]:
            self.fails(2, "linearize", "axis.toml", "--sweep", bad, error="cli.bad-sweep")
        self.fails(2, "linearize", "axis.toml", "--sweep", "kd=1:2:3", "--each", 2, error="cli.usage")

    def test_campbell_diagram_of_a_spinning_beam(self):
        # Wright, Smith, Thresher & Wang, J. Appl. Mech. 49 (1982) 197: first flap and chord, hub radius 0.
        self.make_boom(12)
        text = HUB.replace("INERTIA", "1.0").replace("MOTION", 'motion = "angle"').replace("ETA", "")
        self.write("spin.toml", "[parameters]\nrate = 1.0\n" + text.replace("RATE", '"$rate"'))
        self.bough("linearize", "spin.toml", "--sweep", "rate=0:6:7", "-o", "sweep.h5")
        s = self.read()
        omega = 2 * math.pi * s["poles/frequency_hz"]
        wright = {2: (4.13732, 3.62180), 6: (7.36037, 4.26323)}
        for rate, (flap, chord) in wright.items():
            row = omega[int(rate)]
            for exact in (flap, chord):
                self.assertLess(np.abs(row / exact - 1).min(), 1e-3)
        # Each column is one motion: flap rises by sqrt(chord² + rate²) all along, without a jump to another.
        k = np.argmin(np.abs(omega[6] - 7.36037))
        chord = np.argmin(np.abs(omega[6] - 4.26323))
        for rate in range(1, 7):
            self.assertAlmostEqual(omega[rate, k]**2, omega[rate, chord]**2 + rate**2, delta=2e-3 * omega[rate, k]**2)
        self.bough("plot", "sweep.h5", "--kind", "campbell", "-o", "campbell.svg")
        with open(self.path("campbell.svg")) as f:
            whole = f.read()
        # The motion of the hinge is given: no speed of the system tells that the parameter is a rate.
        self.assertNotIn("/rev", whole)
        self.bough("plot", "sweep.h5", "--kind", "campbell", "--per-rev", 3, "--y-min", 0, "--y-max", 1.3, "-o", "near.svg")
        with open(self.path("near.svg")) as f:
            near = f.read()
        self.assertEqual(re.findall(r">(\d)/rev<", near), ["1", "2", "3"])
        # The legend names what is in view: first flap and chord are below 1.3 cycles per unit of time, nothing else.
        names = re.findall(r">(boom:eta\d+[^<]*)<", whole)
        self.assertEqual(len(names), 12)
        self.assertEqual([n for n in names if f">{n}<" in near], ["boom:eta1 -&gt; boom:eta2", "boom:eta2 -&gt; boom:eta1"])
        self.fails(1, "plot", "sweep.h5", "--kind", "locus", "--per-rev", 3, error="cli.plot-option")

    def test_nutation(self):
        # A wheel in a light gimbal on springs: J_t² q'' ± Ω J_a cross terms.
        self.write("top.toml", TOP)
        said = self.bough("linearize", "top.toml", "--sweep", "spin=0:10:21", "-o", "sweep.h5").stderr
        self.assertNotIn("sweep-jump", said)  # at rest the two are one: no motion is lost there
        s = self.read()
        Jt, Ja, k = 2.0, 3.0, 5.0
        for spin, freq in zip(s["parameter/value"], s["poles/frequency_hz"]):
            root = np.roots([Jt**2, 0, -(2 * Jt * k + (Ja * spin)**2), 0, k**2])
            exact = np.sort(np.unique(np.round(np.abs(root.real), 12)))
            found = np.sort(2 * math.pi * freq)
            found = found[found > 1e-3]
            for w in exact:
                self.assertLess(np.abs(found / w - 1).min(), 2e-5, spin)
        # Followed: one branch falls (precession), one rises (nutation) monotonously.
        f = s["poles/frequency_hz"]
        moving = [b for b in range(f.shape[1]) if f[0, b] > 1e-6]
        self.assertEqual(len(moving), 4)
        for b in moving:
            steps = np.diff(f[:, b])
            self.assertTrue((steps > 0).all() or (steps < 0).all())

    def test_what_a_sweep_cannot_follow(self):
        self.make_boom(4)
        self.write("count.toml", toml(
            section("parameters", n=2),
            table("body", "boom", file="boom.h5", modes="$n"),
            table("hinge", "clamp", "fixed", child="boom"),
            section("simulation", duration=1.0)))
        self.fails(3, "linearize", "count.toml", "--sweep", "n=2:4:3", error="linear.sweep-states")
        # Two rotors on springs, one spring as stiff as the other is soft: far apart values turn their motions around.
        self.write("two.toml", "\n".join(
            ['[parameters]\nk = 1.0'] +
            [f'[[body]]\nname = "{name}"\nmass = 1.0\ncg = [0.0, 0.0, 0.0]\ninertia = [1.0, 1.0, {inertia}]'
             for name, inertia in [("one", 1.0), ("two", 1.0)]] +
            ['[[hinge]]\nname = "root"\ntype = "revolute"\nchild = "one"\naxis = [0.0, 0.0, 1.0]\nstiffness = ["$k"]',
             toml(
                 table("hinge", "joint", "revolute", parent="one", child="two", axis=[0.0, 0.0, 1.0], stiffness=[1.0]),
                 section("simulation", duration=1.0))]))
        result = self.bough("linearize", "two.toml", "--sweep", "k=0.001:1000:2")
        self.assertIn("[linear.sweep-jump]", result.stderr)
        result = self.bough("linearize", "two.toml", "--sweep", "k=0.1:10:40:log")
        self.assertNotIn("sweep-jump", result.stderr)

    def test_each_sample_of_a_run(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.9").replace("duration = 1.0",
                                                                             "duration = 1.0\noutput_step = 0.125"))
        self.bough("linearize", "pendulum.toml", "--each", 2, "--outputs", "angle", "-o", "sweep.h5")
        self.bough("run", "pendulum.toml", "-o", "run.h5")
        with h5py.File(self.path("run.h5")) as f:
            angle = np.ravel(f["/hinges/pin/q"][:])[::2]
            time = f["/time"][:][::2]
        s = self.read()
        np.testing.assert_allclose(s["parameter/value"], time, atol=1e-12)
        np.testing.assert_allclose(s["A"][:, 1, 0], -9.81 / 0.7 * np.cos(angle), rtol=1e-5)


class Zeros(LinearTest):
    def test_of_a_beam_from_its_root_to_its_tip(self):
        # Torque at the root, place of the tip: at a zero the tip stands still without force or moment on it, so that
        # sinh b + sin b = 0 over the length: b = c (1 + i), tan c = -tanh c, s = +-2 c² (L = EI = rho A = 1). Real:
        # the tip starts the wrong way. The inertia of the hub has no part in it.
        self.make_boom(20)
        c = scipy.optimize.brentq(lambda c: math.tan(c) + math.tanh(c), math.pi / 2 + 1e-6, math.pi)
        for inertia in (0.1, 10.0):
            name = self.write_hub("hub.toml", inertia=inertia)
            with open(self.path(name), "a") as f:
                f.write(table("sensor", "place", "position", body="boom", node=41))
            model = self.linearize("hub.toml", "--outputs", "place:y")
            zeros = model["zeros/real"] + 1j * model["zeros/imag"]
            for exact in (2 * c * c, -2 * c * c):
                self.assertLess(np.abs(zeros / exact - 1).min(), 5e-3, zeros)
            # Torque to angle, at one place: zeros and poles take turns on the imaginary axis.
            model = self.linearize("hub.toml", "--outputs", "angle")
            both = sorted([(w, 1) for w in model["zeros/imag"] if w > 1e-6] +
                          [(w, -1) for w in model["poles/imag"] if w > 1e-6])
            seen, last = [], 0
            for w, sign in both:  # flap, which the torque does not reach, has a pole on a zero
                seen = seen[:-1] + [seen[-1] + sign] if seen and w < last * (1 + 1e-6) else seen + [sign]
                last = w
            seen = ["zero" if sign > 0 else "pole" for sign in seen if sign != 0]
            self.assertEqual(seen, ["zero", "pole"] * (len(seen) // 2))
            self.assertGreaterEqual(len(seen), 8)


class Tables(LinearTest):
    def test_csv_and_operating_point(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        model = self.linearize("pendulum.toml", "--outputs", "angle", "--csv", "model.csv")
        with open(self.path("model.csv")) as f:
            rows = [line.strip().split(",") for line in f]
        self.assertEqual(rows[0], ["row", "pin:1", "pin:1_dot", "push"])
        self.assertEqual([row[0] for row in rows[1:]], ["d/dt pin:1", "d/dt pin:1_dot", "angle"])
        found = np.array([[float(v) for v in row[1:]] for row in rows[1:]])
        np.testing.assert_array_equal(found, np.block([[model["A"], model["B"]], [model["C"], model["D"]]]))
        self.assertEqual(self.bough("export", "model.h5", "--to", "csv").stdout.split("\n")[0], "row,pin:1,pin:1_dot,push")
        self.assertEqual(model["operating_point/positions/name"], ["pin:1"])
        self.assertEqual([w.decode() for w in model["operating_point/periodic"]], ["pin:1"])
        self.assertEqual([w.decode() for w in model["poles/hinge"]], ["pin:1", "pin:1"])
        text = self.bough("linearize", "pendulum.toml").stdout
        self.assertIn("periodic", text)
        self.assertIn("Hankel singular values", text)

    def test_hankel_values_are_scipys(self):
        self.make_boom(5)
        self.write_hub("hub.toml", eta="damping = 0.01", motion="stiffness = [3.0]\ndamping = [0.1]")
        model = self.linearize("hub.toml")
        A, B, C = model["A"], model["B"], model["C"]
        P = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        Q = scipy.linalg.solve_continuous_lyapunov(A.T, -C.T @ C)
        np.testing.assert_allclose(model["hankel/controllability"], P, atol=1e-9 * np.abs(P).max())
        np.testing.assert_allclose(model["hankel/observability"], Q, atol=1e-9 * np.abs(Q).max())

    def test_body_mode_and_hinge_of_a_pole(self):
        self.make_boom(6)
        self.write_hub("hub.toml")
        model = self.linearize("hub.toml")
        for mode, hinge, frequency in zip(model["poles/body_mode"], model["poles/hinge"], model["poles/frequency_hz"]):
            if frequency > 0:
                self.assertTrue(mode.startswith("boom:eta"))
            if frequency == 0:
                self.assertEqual(hinge.decode(), "spin:1")

    @unittest.skipUnless(shutil.which("octave"), "Octave is not installed")
    def test_mat_in_octave(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "--mat", "m.mat")
        self.write("t.m", "load m.mat; assert(size(A), [2 2]); assert(strcmp(state_name{1}, 'pin:1'));\n")
        subprocess.run(["octave", "--no-gui", "--quiet", "t.m"], cwd=self.folder, check=True)
        # Its control package, where it is installed: poles and response of a continuous and of a sampled model.
        self.write("axis.toml", AXIS.replace('kd = "$kd"\n', 'kd = "$kd"\nsample_time = 0.1\ndelay = 0.04\n'))
        self.bough("linearize", "axis.toml", "--break", "drive", "-o", "loop.h5", "--mat", "loop.mat")
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "-o", "m.h5")
        self.write("c.m", "if isempty(pkg('list', 'control')), fclose(fopen('absent', 'w')); exit, end\npkg load control\n"
                          "function w = read(name), w = dlmread(name, ',', 1, 0); end\n"
                          "load m.mat; s = ss(A, B, C, D); r = read('m.csv');\n"
                          "H = squeeze(freqresp(s, 2 * pi * r(:, 1)))(:);\n"
                          "assert(H, r(:, 2) + 1i * r(:, 3), 1e-9 * max(abs(H)));\n"
                          "p = read('poles.csv'); assert(cplxpair(pole(s)), cplxpair(p(:, 1) + 1i * p(:, 2)), 1e-9);\n"
                          "load loop.mat; s = ss(A, B, C, D, sample_time); r = read('loop.csv');\n"
                          "H = squeeze(freqresp(s, 2 * pi * r(:, 1)))(:);\n"
                          "assert(H, r(:, 2) + 1i * r(:, 3), 1e-6 * abs(H));\n"
                          "fclose(fopen('done', 'w'));\n")
        for name in ("m", "loop"):
            self.bough("response", name + ".h5", "--csv", name + ".csv")
        with h5py.File(self.path("m.h5")) as f:
            np.savetxt(self.path("poles.csv"), np.column_stack([np.ravel(f["poles/" + k]) for k in ("real", "imag")]),
                       delimiter=",", header="real,imag", fmt="%.17g")
        subprocess.run(["octave", "--no-gui", "--quiet", "c.m"], cwd=self.folder, check=True)
        if os.path.exists(self.path("absent")):
            self.skipTest("the control package of Octave is not installed")
        self.assertTrue(os.path.exists(self.path("done")))


if __name__ == "__main__":
    unittest.main()
