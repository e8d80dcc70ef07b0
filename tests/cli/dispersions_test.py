"""batch: distributions of parameters and percentiles with bounds, against SciPy."""
import csv
import json
import math
import unittest

import numpy as np
import scipy.stats

from support import ProgramTest
from toml_text import section, table, toml

SLIDE = toml(
    table("body", "bob", mass=2.0),
    table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0], stiffness=[50.0], position=[0.1]),
    section("simulation", duration=0.01, output_step=0.01))
HEAD = """[campaign]
method = "METHOD"
samples = SAMPLES
seed = 5
steps = ["run slide.toml -o slide.h5"]
"""
TRUNCATED = """
[[parameter]]
name = "cut"
mean = 1.0
deviation = 0.5
range = [0.8, 2.5]
"""
NORMAL = """
[[parameter]]
name = "NAME"
mean = 3.0
deviation = 0.25
"""
DISCRETE = """
[[parameter]]
name = "word"
values = ["a", "b", "c"]
probabilities = [1.0, 0.0, 3.0]
"""
UNIFORM = """
[[parameter]]
name = "even"
range = [2.0, 4.0]
"""


def tie(a, b, value):
    return f'\n[[correlation]]\nparameters = ["{a}", "{b}"]\nvalue = {value}\n'


class Dispersions(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("slide.toml", SLIDE)

    def sample(self, text, method="monte-carlo", samples=2000):
        self.write("mc.toml", HEAD.replace("METHOD", method).replace("SAMPLES", str(samples)) + text)
        cases = json.loads(self.bough("batch", "mc.toml", "--dry-run", "--json").stdout)
        return {name: np.array([case["parameters"][name] for case in cases]) for name in cases[0]["parameters"]}

    def test_distributions_of_independent_cases(self):
        found = self.sample(NORMAL.replace("NAME", "n") + TRUNCATED + DISCRETE + UNIFORM)
        cut = scipy.stats.truncnorm((0.8 - 1) / 0.5, (2.5 - 1) / 0.5, 1, 0.5)
        for name, law in (("n", scipy.stats.norm(3, 0.25)), ("cut", cut), ("even", scipy.stats.uniform(2, 2))):
            self.assertGreater(scipy.stats.kstest(found[name], law.cdf).pvalue, 0.01, name)
        self.assertTrue(np.all((found["cut"] >= 0.8) & (found["cut"] <= 2.5)))
        self.assertEqual(set(found["word"]), {"a", "c"})
        self.assertGreater(scipy.stats.binomtest(int(np.sum(found["word"] == "a")), 2000, 0.25).pvalue, 0.01)
        self.assertGreater(scipy.stats.pearsonr(found["n"], found["even"])[1], 0.01)

    def test_tails_and_whole_numbers(self):
        far = NORMAL.replace("NAME", "far") + "range = [6.0, 7.0]\n"
        whole = NORMAL.replace("NAME", "whole").replace("0.25", "2") + "range = [1.6, 4.5]\ninteger = true\n"
        found = self.sample(far + far.replace("far", "low").replace("6.0, 7.0", "-1.0, 0.0") + whole)
        for name, x in (("far", found["far"]), ("low", 6 - found["low"])):
            tail = scipy.stats.truncnorm(12, 16, 3, 0.25)
            self.assertGreater(scipy.stats.kstest(x, tail.cdf).pvalue, 0.01, name)
        self.assertEqual(set(found["whole"]), {2, 3, 4})

    def test_a_hypercube_has_one_case_in_each_bin(self):
        found = self.sample(NORMAL.replace("NAME", "n") + TRUNCATED + DISCRETE, "latin-hypercube", 40)
        cut = scipy.stats.truncnorm((0.8 - 1) / 0.5, (2.5 - 1) / 0.5, 1, 0.5)
        for name, law in (("n", scipy.stats.norm(3, 0.25)), ("cut", cut)):
            self.assertEqual(sorted(int(u * 40) for u in law.cdf(found[name])), list(range(40)))
        self.assertEqual(sorted(found["word"]), ["a"] * 10 + ["c"] * 30)

    def test_correlations(self):
        pair = NORMAL.replace("NAME", "a") + NORMAL.replace("NAME", "b") + UNIFORM
        for method in ("monte-carlo", "latin-hypercube"):
            found = self.sample(pair + tie("a", "b", 0.7) + tie("even", "a", -0.5), method)
            self.assertAlmostEqual(np.corrcoef(found["a"], found["b"])[0, 1], 0.7, delta=0.04)
            # Rank correlation of the copula of a uniform and a normal parameter.
            rank = 6 / math.pi * math.asin(-0.25)
            self.assertAlmostEqual(scipy.stats.spearmanr(found["even"], found["a"])[0], rank, delta=0.06)
            self.assertAlmostEqual(np.corrcoef(found["even"], found["b"])[0, 1], 0, delta=0.06)
        self.assertEqual(sorted(int(u * 2000) for u in scipy.stats.norm(3, 0.25).cdf(found["a"])), list(range(2000)))

    def test_percentiles_with_bounds(self):
        text = HEAD.replace("METHOD", "monte-carlo").replace("SAMPLES", "60\npercentiles = [50, 90.0, 97.0]\nconfidence = 80")
        self.write("mc.toml", text + '\n[[parameter]]\nname = "x"\nfile = "slide.toml"\nkey = "hinge.slide.position.1"\n'
                   'mean = 0.1\ndeviation = 0.02\n\n[[collect]]\nname = "start"\nfile = "slide.h5"\n'
                   'dataset = "/hinges/slide/q"\ntake = "first"\n')
        done = json.loads(self.bough("batch", "mc.toml", "-j", "1", "-o", "mc", "--json").stdout)
        with open(self.path("mc/outcomes.csv")) as f:
            x = np.sort([float(row["start"]) for row in csv.DictReader(f)])
        self.assertEqual(len(set(x)), 60)
        with open(self.path("mc/percentiles.csv")) as f:
            rows = list(csv.DictReader(f))
        for row, shown, p in zip(rows, done["statistics"]["start"]["percentiles"], (0.5, 0.9, 0.97), strict=True):
            law = scipy.stats.binom(60, p)
            r = max(r for r in range(1, 61) if law.cdf(r - 1) <= 0.1)
            above = [s for s in range(1, 61) if law.sf(s - 1) <= 0.1]
            self.assertEqual(float(row["percent"]), 100 * p)
            self.assertAlmostEqual(shown["value"], np.percentile(x, 100 * p), delta=1e-14)
            self.assertEqual((shown["lower"], float(row["lower"])), (x[r - 1], x[r - 1]))
            if above:
                self.assertEqual((shown["upper"], float(row["upper"])), (x[min(above) - 1], x[min(above) - 1]))
            else:
                self.assertEqual((shown["upper"], row["upper"]), (None, ""))
        self.assertIsNone(done["statistics"]["start"]["percentiles"][2]["upper"])
        self.assertIn("too few cases", self.bough("batch", "mc.toml", "-j", "1", "-o", "mc").stdout)

    def test_wrong_distributions_are_named(self):
        pair = NORMAL.replace("NAME", "a") + NORMAL.replace("NAME", "b") + NORMAL.replace("NAME", "c")
        head = HEAD.replace("METHOD", "monte-carlo").replace("SAMPLES", "10")
        for text, message in (
                (head + NORMAL.replace("deviation = 0.25\n", ""), "mean without deviation"),
                (head + DISCRETE.replace(", 3.0]", "]"), "3 values and 2 probabilities"),
                (head + pair + tie("a", "b", 0.9) + tie("b", "c", 0.9) + tie("a", "c", -0.9), "not positive definite"),
                (head + pair + tie("a", "b", 1.2), "a correlation is 1.2"),
                (head + TRUNCATED.replace("0.8, 2.5", "40, 41"), "37 deviations"),
                (head + NORMAL.replace("3.0", "inf"), "mean is not a finite number"),
                (head + DISCRETE.replace("3.0]", "inf]"), "not a finite number"),
                (head + pair + tie("a", "d", 0.2), "unknown parameter 'd'"),
                (head + pair + tie("a", "b", 0.2) + tie("b", "a", 0.1), "given before"),
                (head.replace("seed", "percentiles = [100.0]\nseed") + pair, "a percentile is 100"),
                (head.replace("seed", "confidence = 95\nseed") + pair, "without percentiles"),
                (head.replace("monte-carlo", "grid").replace("samples = 10\n", "") + pair, "the cases are not random")):
            self.write("mc.toml", text)
            done = self.bough("batch", "mc.toml", "--dry-run", code=1)
            self.assertIn(message, done.stderr)
            self.assertIn("mc.toml:", done.stderr)


if __name__ == "__main__":
    unittest.main()
