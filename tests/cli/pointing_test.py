"""response --budget: wheels, coolers, spectral densities and exposures against NumPy, term by term."""
import csv
import json
import math
import os
import re
import unittest

import h5py
import numpy as np
import scipy.integrate

from linear_test import LinearTest
from support import SOURCE
from toml_text import section, table, toml

# A bench on springs: a planar sled with forces, a universal joint with moments.
BENCH = toml(
    table("body", "sled", mass=40.0, inertia=[3.0, 4.0, 5.0]), table("body", "head", mass=1.0, inertia=[2.0, 3.0, 4.0]),
    table("hinge", "plane", "planar", child="sled", axis=[0.0, 0.0, 1.0], stiffness=[3e6, 5e6, 4e5],
          damping=[200.0, 300.0, 20.0]),
    table("hinge", "joint", "universal", child="head", axis=[1.0, 0.0, 0.0], axis2=[0.0, 1.0, 0.0],
          stiffness=[2e5, 4e5], damping=[12.0, 9.0]),
    table("function", "nothing", "constant", value=0.0),
    *(table("force", name, body=body, **{quantity: axis}, function="nothing")
      for name, body, quantity, axis in (("fx", "sled", "force", [1.0, 0.0, 0.0]), ("fy", "sled", "force", [0.0, 1.0, 0.0]),
                                         ("mx", "head", "moment", [1.0, 0.0, 0.0]),
                                         ("my", "head", "moment", [0.0, 1.0, 0.0]))),
    *(table("sensor", name, "hinge_angle", hinge=name) for name in ("plane", "joint")),
    table("controller", "sight", "gain", inputs=["plane", "joint"],
          gain=[[0.3, 0.0, 0.5, 0.0, 2.0], [0.0, -0.2, 0.0, 1.5, 0.1]]),
    section("simulation", duration=1.0))
OUTPUTS = ["sight:1", "sight:2"]
LEGENDRE = np.polynomial.legendre.leggauss(60)
WHEEL = """[[source]]
name = "wheel"
type = "wheel"
SPEEDS
force = ["fx", "fy"]
moment = ["mx", "my"]
radial = {frequency_hz = 110.0, damping = 0.02}
rocking = {frequency_hz = 60.0, damping = 0.01}
inertia_ratio = 1.7
harmonic = [
  {number = 1.0, radial_force = 4e-6, radial_moment = 3e-7, phase_deg = 40.0},
  {number = -2.82, radial_moment = 6e-8},
]
"""
COOLER = """[[source]]
name = "cooler"
type = "tones"
frequency_hz = 40.0
harmonic = [
  {number = 1, input = ["fx", "my"], amplitude = [0.2, 0.01], phase_deg = [0.0, 75.0]},
  {number = 3, input = "fy", amplitude = 0.05},
]
"""
NOISE = """[[source]]
name = "noise"
type = "psd"
psd = [
  {input = "fx", frequency_hz = [2.0, 30.0, 90.0], density = [1e-4, 4e-4, 1e-5]},
  {input = "mx", frequency_hz = [1.0, 90.0], density = [2e-7, 1e-7], interpolation = "log"},
]
"""


def calc_shares(f, T):
    """Shares of mean and line in a window, by Legendre polynomials over the window."""
    x, w = LEGENDRE
    wave = np.exp(1j * math.pi * f * T * x)
    return abs(np.sum(w * wave) / 2)**2, abs(np.sum(w * wave * math.sqrt(3) * x) / 2)**2


class Pointing(LinearTest):
    def setUp(self):
        super().setUp()
        self.write("bench.toml", BENCH)
        model = self.linearize("bench.toml", "--outputs", "plane,joint,sight")
        rows = [model["outputs/name"].index(name) for name in OUTPUTS]
        self.A, self.B, self.C, self.D = model["A"], model["B"], model["C"][rows], model["D"][rows]
        self.inputs = model["inputs/name"]

    def gain(self, f, name):
        b = self.inputs.index(name)
        s = 2j * math.pi * f
        return self.C @ np.linalg.solve(s * np.eye(len(self.A)) - self.A, self.B[:, b]) + self.D[:, b]

    def budget(self, text, *arguments):
        self.write("budget.toml", text)
        return json.loads(self.bough("response", "model.h5", "--outputs", ",".join(OUTPUTS), "--budget", "budget.toml",
                                     "--json", *arguments).stdout)

    def calc_wheel(self, rpm):
        """Mean squares from real equations of the rotor; vectors over cos and sin."""
        spin = rpm * 2 * math.pi / 60
        total = np.zeros(2)
        for number, force, moment, phase in ((1, 4e-6, 3e-7, math.radians(40)), (-2.82, 0, 6e-8, 0)):
            omega = abs(number * spin)
            turn = math.copysign(1, number)
            # cos ωt + i sin ωt of the real amplitudes: real part of X exp(i|ω|t).
            F = force * spin**2 * np.array([1, -1j * turn])
            M = moment * spin**2 * np.exp(1j * phase * turn) * np.array([1, -1j * turn])
            w, z = 2 * math.pi * 110, 0.02
            F = F * (w * w + 2j * z * w * omega) / (w * w - omega**2 + 2j * z * w * omega)
            w, z, h = 2 * math.pi * 60, 0.01, 1.7 * spin
            s = 1j * omega
            K = np.array([[s * s + 2 * z * w * s + w * w, h * s], [-h * s, s * s + 2 * z * w * s + w * w]])
            M = (w * w + 2 * z * w * s) * np.linalg.solve(K, M)
            f = omega / 2 / math.pi
            y = sum(self.gain(f, name) * u for name, u in zip(("fx", "fy", "mx", "my"), (*F, *M)))
            total += abs(y)**2 / 2
        return total

    def test_wheel_over_its_speeds(self):
        text = WHEEL.replace("SPEEDS", "range_rpm = [600.0, 6000.0]\npoints = 28")
        found = self.budget(text, "--csv", "budget.csv")
        row = found["tables"][0]["rows"][0]
        rms = np.sqrt([self.calc_wheel(rpm) for rpm in np.linspace(600, 6000, 28)])
        np.testing.assert_allclose(row["rpm"], np.linspace(600, 6000, 28), rtol=1e-12)
        np.testing.assert_allclose(np.transpose(row["over_speed"]), rms, rtol=1e-8)
        np.testing.assert_allclose(row["rms"], rms.max(axis=0), rtol=1e-8)
        np.testing.assert_allclose(row["worst_rpm"], np.linspace(600, 6000, 28)[rms.argmax(axis=0)], rtol=1e-12)
        with open(self.path("budget.csv")) as f:
            lines = list(csv.reader(f))
        self.assertEqual(lines[0], ["weighting", "exposure", "source", "speed", *OUTPUTS])
        self.assertEqual(len(lines), 1 + 28 + 2)
        np.testing.assert_allclose([[float(x) for x in line[4:]] for line in lines[1:29]], rms, rtol=1e-8)
        self.assertEqual([line[2:4] for line in lines[29:]], [["wheel", "worst"], ["total", ""]])

    def test_rocking_modes_split_with_the_speed(self):
        """The forward mode of a rotor is at ρΩ/2 + √(ρ²Ω²/4 + ω₀²), the backward one below."""
        speed = 3000 * 2 * math.pi / 60
        for sign in (1, -1):
            mode = abs(sign * 1.7 * speed / 2 + math.sqrt((1.7 * speed / 2)**2 + (2 * math.pi * 60)**2))
            numbers = np.linspace(0.97, 1.03, 61) * mode / speed
            peaks = []
            for number in numbers:
                rows = WHEEL[:WHEEL.index("harmonic")].replace("SPEEDS", "speed_rpm = 3000.0").replace("0.01", "1e-5")
                peaks.append(rows + f"harmonic = [{{number = {sign * number}, radial_moment = 1e-7}}]\n")
            text = "".join(one.replace('"wheel"\ntype', f'"w{k}"\ntype') for k, one in enumerate(peaks))
            rms = np.array([one["rms"][0] for one in self.budget(text)["tables"][0]["rows"]])
            self.assertEqual(rms.argmax(), 30)

    def test_sources_exposures_and_their_sum(self):
        T, interval = 0.11, 0.7
        found = self.budget(f"exposure = {T}\ninterval = {interval}\n"
                            + NOISE + COOLER + WHEEL.replace("SPEEDS", "speed_rpm = [1900.0]"))
        tables = {table["weighting"]: table for table in found["tables"]}
        self.assertEqual(list(tables), ["total", "jitter", "smear", "residual", "mean", "drift"])

        def weigh(f):
            mean, smear = calc_shares(f, T)
            drift = 4 * math.sin(math.pi * f * interval)**2 * mean
            return {"total": 1, "jitter": 1 - mean, "smear": smear, "residual": 1 - mean - smear, "mean": mean,
                    "drift": drift}
        cooler = {}
        for f, parts in ((40, {"fx": 0.2, "my": 0.01 * np.exp(1j * math.radians(75))}), (120, {"fy": 0.05})):
            square = abs(sum(self.gain(f, name) * u for name, u in parts.items()))**2 / 2
            for name, weight in weigh(f).items():
                cooler[name] = cooler.get(name, 0) + weight * square
        grid = np.linspace(1, 90, 8001)
        shares = [weigh(f) for f in grid]
        wave = {name: np.array([share[name] for share in shares]) for name in tables}
        fx = np.interp(grid, [2, 30, 90], [1e-4, 4e-4, 1e-5], left=0)
        mx = np.exp(np.interp(np.log(grid), np.log([1, 90]), np.log([2e-7, 1e-7])))
        S = np.array([fx[k] * abs(self.gain(f, "fx"))**2 + mx[k] * abs(self.gain(f, "mx"))**2
                      for k, f in enumerate(grid)])
        for name, table in tables.items():
            rows = {row["source"]: np.array(row["rms"]) for row in table["rows"]}
            np.testing.assert_allclose(rows["cooler"], np.sqrt(cooler[name]), rtol=1e-8)
            noise = scipy.integrate.simpson(wave[name][:, None] * S, x=grid, axis=0)
            np.testing.assert_allclose(rows["noise"], np.sqrt(noise), rtol=2e-4, err_msg=name)
            np.testing.assert_allclose(table["total"], np.sqrt(sum(rows[k]**2 for k in rows)), rtol=1e-12)
        jitter = np.array(tables["jitter"]["rows"][0]["rms"])**2
        mean = np.array(tables["mean"]["rows"][0]["rms"])**2
        np.testing.assert_allclose(jitter + mean, np.array(tables["total"]["rows"][0]["rms"])**2, rtol=1e-9)
        self.assertEqual((found["from_hz"], found["to_hz"]), (1, 90))

    def test_share_of_a_sine_in_an_exposure(self):
        """Lucke, Sirlin & San Martin 1992: row 30 of the targets."""
        for fT, share in ((0.1, 0.032469), (0.25, 0.189431), (0.5, 0.594715), (1, 1), (1.5, 0.954968)):
            text = f"exposure = {fT / 40}\n" + COOLER[:COOLER.index("  {number = 3")] + "]\n"
            total, jitter = (table["rows"][0]["rms"][0] for table in self.budget(text)["tables"][:2])
            self.assertAlmostEqual((jitter / total)**2, share, delta=6e-7)

    def test_residual_of_short_exposures_keeps_its_digits(self):
        text = "exposure = 1e-5\n" + COOLER[:COOLER.index("  {number = 3")] + "]\n"
        tables = {table["weighting"]: table["rows"][0]["rms"][0] for table in self.budget(text)["tables"]}
        x = math.pi * 40 * 1e-5
        self.assertAlmostEqual(tables["residual"] / tables["total"] / (x**2 / math.sqrt(45)), 1, delta=1e-5)
        self.assertAlmostEqual(tables["smear"] / tables["total"] / (x / math.sqrt(3)), 1, delta=1e-5)

    def test_long_exposures_of_a_wide_band(self):
        """Beyond 256 lobes the weights are averaged: jitter of a long exposure is the total minus the mean's share."""
        found = self.budget("exposure = 40.0\n" + NOISE)
        tables = {table["weighting"]: np.array(table["total"])**2 for table in found["tables"]}
        grid = np.linspace(1, 90, 400001)
        fx = np.interp(grid, [2, 30, 90], [1e-4, 4e-4, 1e-5], left=0)
        mx = np.exp(np.interp(np.log(grid), np.log([1, 90]), np.log([2e-7, 1e-7])))
        w = 2 * math.pi * grid
        poles, V = np.linalg.eig(self.A)
        left = np.linalg.solve(V, self.B)
        mean = np.sinc(grid * 40)**2
        for output in range(2):
            square = 0
            for name, S in (("fx", fx), ("mx", mx)):
                r = (self.C[output] @ V) * left[:, self.inputs.index(name)]
                square = square + S * abs((r / (1j * w[:, None] - poles)).sum(axis=1))**2
            self.assertAlmostEqual(tables["mean"][output] / np.trapz(mean * square, grid), 1, delta=1e-3)
        np.testing.assert_allclose(tables["jitter"] + tables["mean"], tables["total"], rtol=1e-9)

    def test_run_has_the_rms_of_the_budget(self):
        """Wheel at a constant speed and cooler as forces over time, once the start has decayed."""
        spin = 40 * math.pi
        waves = {"fx": f"4e-6*{spin}^2*cos({spin}*t)", "fy": f"4e-6*{spin}^2*sin({spin}*t)",
                 "mx": f"3e-7*{spin}^2*cos({spin}*t + pi/4)", "my": f"3e-7*{spin}^2*sin({spin}*t + pi/4)"}
        text = BENCH.replace("duration = 1.0", 'duration = 16.0\noutput_step = 1e-3\noutput_from = 15.0\n'
                             'integrator = "rk"\nrelative_tolerance = 1e-10\nabsolute_tolerance = 1e-15')
        for name, wave in waves.items():
            start = text.index(f'[[force]]\nname = "{name}"')
            text = text[:start] + text[start:].replace('"nothing"', f'"wave_{name}"', 1)
            text += (f'\n[[function]]\nname = "wave_{name}"\ntype = "expression"\nexpression = "{wave}"\n')
        self.write("run.toml", text)
        self.bough("run", "run.toml", "-o", "run.h5")
        with h5py.File(self.path("run.h5")) as f:
            y = f["controllers/sight"][()][:1000]
        rows = WHEEL[:WHEEL.index("radial =")].replace("SPEEDS", "speed_rpm = 1200.0")
        found = self.budget(rows + "harmonic = [{number = 1.0, radial_force = 4e-6, radial_moment = 3e-7, phase_deg = 45.0}]\n")
        np.testing.assert_allclose(found["tables"][0]["total"], y.std(axis=0), rtol=1e-4)

    def test_the_budget_of_the_page(self):
        """jitter.toml of docs/pointing.md, with the inputs of the bench."""
        with open(os.path.join(SOURCE, "docs/pointing.md"), encoding="utf-8") as page:
            text = next(block for block in page.read().split("```toml\n") if block.startswith("# jitter.toml")).split("```")[0]
        for name, own in (("w1_fx", "fx"), ("w1_fy", "fy"), ("w1_fz", "mx"), ("w1_mx", "mx"), ("w1_my", "my"),
                          ("cooler_z", "fx"), ("cooler_my", "my"), ("gyro_noise", "fy")):
            text = text.replace(f'"{name}"', f'"{own}"')
        found = json.dumps(self.budget(text))
        for name in ("wheel 1", "cooler", "gyro noise"):
            self.assertIn(name, found)

    def test_file_and_page_have_the_budget(self):
        text = "exposure = 0.1\n" + NOISE + COOLER + WHEEL.replace("SPEEDS", "range_rpm = [600.0, 6000.0]\npoints = 12")
        found = self.budget(text, "-o", "budget.h5")
        with h5py.File(self.path("budget.h5")) as f:
            self.assertEqual(f.attrs["format"], "bough-budget")
            self.assertEqual([name.decode() for name in f["sources/name"]], ["noise", "cooler", "wheel"])
            self.assertEqual([name.decode() for name in f["outputs/name"]], OUTPUTS)
            for k, table in enumerate(found["tables"]):
                self.assertEqual(f["tables/weighting"][k].decode(), table["weighting"])
                np.testing.assert_array_equal(f["tables/rms"][k], [row["rms"] for row in table["rows"]])
                np.testing.assert_array_equal(f["tables/total"][k], table["total"])
                np.testing.assert_array_equal(f["wheels/3/rms"][k].T, table["rows"][2]["over_speed"])
                self.assertTrue(np.isnan(f["tables/speed"][k, :2]).all())
                np.testing.assert_allclose(f["tables/speed"][k, 2] * 30 / math.pi, table["rows"][2]["worst_rpm"], rtol=1e-12)
            np.testing.assert_allclose(f["wheels/3/speed"][()] * 30 / math.pi, np.linspace(600, 6000, 12), rtol=1e-12)
            rms = f["tables/rms"][0]
            for k, tolerance in ((1, 1e-2), (2, 1e-12), (3, 1e-12)):
                np.testing.assert_allclose(f[f"curves/{k}/rms"][-1], rms[k - 1], rtol=tolerance)
            np.testing.assert_allclose(f["curves/2/frequency_hz"][()], [[40, 40], [120, 120]], rtol=1e-14)
            first = abs(0.2 * self.gain(40, "fx") + 0.01 * np.exp(1j * math.radians(75)) * self.gain(40, "my"))
            np.testing.assert_allclose(f["curves/2/rms"][0], first / math.sqrt(2), rtol=1e-9)
            worst = f["tables/speed"][0, 2] / 2 / math.pi
            np.testing.assert_allclose(f["curves/3/frequency_hz"][()], [worst, 2.82 * worst], rtol=1e-12)
            # The noise up to a frequency, by NumPy.
            hz, running = f["curves/1/frequency_hz"][:, 0], f["curves/1/rms"][:, 0]
            grid = np.linspace(hz[0], 30, 6001)
            fx = np.interp(grid, [2, 30, 90], [1e-4, 4e-4, 1e-5], left=0)
            mx = np.exp(np.interp(np.log(grid), np.log([1, 90]), np.log([2e-7, 1e-7])))
            S = [fx[k] * abs(self.gain(x, "fx")[0])**2 + mx[k] * abs(self.gain(x, "mx")[0])**2 for k, x in enumerate(grid)]
            self.assertAlmostEqual(np.interp(30, hz, running**2) / np.trapz(S, grid), 1, delta=2e-2)
        self.bough("report", "budget.h5", "-o", "budget.html")
        page = self.read("budget.html")
        for words in ("pointing budget", "sight:1, RMS up to each frequency", "jitter RMS, exposure 0.1",
                      "wheel, jitter RMS over its speed", "root of the sum of squares"):
            self.assertIn(words, page)

    def test_waterfall_over_sources(self):
        """Bars of the page against the mean squares of the table: widths, positions, numbers."""
        found = self.budget("exposure = [0.2]\n" + COOLER + NOISE + WHEEL.replace("SPEEDS", "speed_rpm = [900.0, 1500.0]"),
                            "-o", "budget.h5")
        page = self.read_page("budget.h5")
        tables = found["tables"]
        names = [row["source"] for row in tables[0]["rows"]]
        squares = np.array([[row["rms"] for row in table["rows"]] for table in tables])**2
        shares = squares / squares.sum(axis=1, keepdims=True)
        rect = re.compile(r'<rect class="part" x="([\d.]+)" y="[\d.]+" width="([\d.]+)".*?<title>(.*?): RMS (.*?), ')
        for output in range(2):
            figures = [re.findall(f'<figure class="budget-{kind}">(.*?)</figure>', page, re.DOTALL)[output]
                       for kind in ("waterfall", "shares")]
            bars = [(float(x) - 190, float(width), name, float(rms)) for x, width, name, rms in rect.findall(figures[0])]
            order = [i for i in np.argsort(-shares[0, :, output]) if shares[0, i, output] > 1e-4]
            self.assertEqual([bar[2] for bar in bars], 2 * [names[i] for i in order])  # each alone, then all
            start = 0
            for i, (x, width, _, rms) in zip(order, bars):
                self.assertAlmostEqual(x, start, delta=0.1)
                self.assertAlmostEqual(width, 430 * shares[0, i, output], delta=0.02)
                self.assertAlmostEqual(rms / math.sqrt(squares[0, i, output]), 1, delta=1e-4)
                start += width
            self.assertAlmostEqual(start, 430, delta=0.2)
            for row, bars in enumerate(figures[1].split("text-anchor=\"end\"")[1:]):
                for _, width, name, _ in rect.findall(bars):
                    self.assertAlmostEqual(float(width), 430 * shares[row, names.index(name), output], delta=0.02)
            self.assertEqual(figures[1].count("RMS "), len(tables) + len(rect.findall(figures[1])))

    def test_text_names_the_worst_speed(self):
        self.write("budget.toml", WHEEL.replace("SPEEDS", "speed_rpm = [1000.0, 2000.0]"))
        text = self.bough("response", "model.h5", "--outputs", "sight:1", "--budget", "budget.toml").stdout
        self.assertIn("wheel, at rpm", text)
        self.assertIn("root of the sum of squares", text)

    def test_wrong_budgets_are_named(self):
        wheel = WHEEL.replace("SPEEDS", "speed_rpm = [1000.0]")
        for text, message in (
                (wheel.replace('"fx"', '"fz"'), "there is no input 'fz'"),
                (wheel.replace("speed_rpm = [1000.0]\n", ""), "has no speed"),
                (wheel.replace('moment = ["mx", "my"]\n', ""), "no input for it"),
                (wheel.replace("speed_rpm = [1000.0]\n", ""), "linear.bad-budget"),
                (wheel.replace("damping = 0.02", "damping = 0.0"), "damping"),
                (wheel + COOLER.replace('"cooler"', '"wheel"'), "two sources have the name 'wheel'"),
                (COOLER.replace("amplitude = [0.2, 0.01]", "amplitude = [0.2, 0.01, 1.0]"), "3 amplitudes"),
                (COOLER.replace("frequency_hz = 40.0\n", ""), "missing key 'frequency_hz'"),
                (NOISE.replace("1e-5]", "-1e-5]"), "negative"),
                ("interval = 3.0\n" + NOISE, "interval"),
                (NOISE.replace('type = "psd"', 'type = "wheel"'), "'psd'")):
            self.write("budget.toml", text)
            done = self.bough("response", "model.h5", "--budget", "budget.toml", code=1)
            self.assertIn(message, done.stderr)
            self.assertIn("budget.toml:", done.stderr)


if __name__ == "__main__":
    unittest.main()
