"""compare --test with measured functions (dataset 58): FRAC against NumPy, forms of the data, what does not fit."""
import json
import unittest

import h5py
import numpy as np

from notching_test import DECK, HZ, LEVEL, G, calc_transmissibility
from support import ProgramTest

FINE = np.arange(2.1, 30, .13)


def write_function(name, node, direction, hz, value, quantity=12, reference=(1, 1), form="even single", kind=4):
    """One dataset 58 as text."""
    even, double = form.startswith("even"), form.endswith("double")
    lines = ["    -1", "    58", name, "NONE", "NONE", "NONE", "NONE",
             f"{kind:5d}{1:10d}{1:5d}{0:10d} {'NONE':10s}{node:10d}{direction:4d} {'NONE':10s}{reference[0]:10d}{reference[1]:4d}",
             f"{6 if double else 5:10d}{len(hz):10d}{int(even):10d}{hz[0] if even else 0:13.5E}"
             f"{hz[1] - hz[0] if even else 0:13.5E}{0:13.5E}"]
    for number in (18, quantity, 9, 0):
        lines.append(f"{number:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {'NONE':20s}")
    if even and not double:
        flat = np.array([value.real, value.imag]).T.ravel()
        lines += ["".join(f"{x:13.5E}" for x in flat[i:i + 6]) for i in range(0, len(flat), 6)]
    elif not double:
        flat = np.array([hz, value.real, value.imag]).T.ravel()
        lines += ["".join(f"{x:13.5E}" for x in flat[i:i + 6]) for i in range(0, len(flat), 6)]
    elif even:
        flat = np.array([value.real, value.imag]).T.ravel()
        lines += ["".join(f"{x:20.12E}" for x in flat[i:i + 4]) for i in range(0, len(flat), 4)]
    else:
        lines += [f"{f:13.5E}{v.real:20.12E}{v.imag:20.12E}" for f, v in zip(hz, value)]
    return "\n".join(lines + ["    -1", ""])


class TestFunctions(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("d.bdf", DECK.format(random="", bulk=""))
        self.bough("frequency", "d.bdf", "-o", "f.h5")

    def compare(self, *options):
        return json.loads(self.bough("compare", "f.h5", "--test", "t.unv", "--json", *options).stdout)

    def test_frac_of_noisy_functions(self):
        full = LEVEL * G * calc_transmissibility()
        random = np.random.default_rng(3)
        text, expected = "", []
        for number, form in enumerate(("even single", "uneven single", "even double", "uneven double")):
            hz = FINE if form.startswith("even") else FINE + .01 * random.random(FINE.size)
            hz = np.array([float(f"{f:.4E}") for f in hz])
            exact = np.interp(hz, HZ, full.real) + 1j * np.interp(hz, HZ, full.imag)
            measured = 2 * exact * np.exp(.3j) + random.normal(size=hz.size) + 1j * random.normal(size=hz.size)
            sign = -1 if number == 1 else 1
            text += write_function(f"point {number}", 2, sign, hz, sign * measured, form=form)
            inside = (hz >= HZ[0]) & (hz <= HZ[-1])
            a, b = exact[inside], measured[inside]
            expected.append((abs(np.vdot(a, b))**2 / (np.vdot(a, a).real * np.vdot(b, b).real),
                             10 * np.log10(np.vdot(a, a).real / np.vdot(b, b).real), inside.sum(), hz[inside][np.argmax(abs(a))]))
        self.write("t.unv", text + write_function("time", 2, 1, FINE, 1 + 0j * FINE, kind=1))
        data = self.compare("-o", "c.h5")
        self.assertEqual(len(data["functions"]), 4)
        for one, (frac, level, count, peak) in zip(data["functions"], expected):
            self.assertEqual(one["curve"], "acceleration:2:1")
            self.assertAlmostEqual(one["frac"], frac, delta=1e-5)
            self.assertAlmostEqual(one["level_db"], level, delta=1e-3)
            self.assertEqual(one["num_points"], count)
            self.assertAlmostEqual(one["peak_hz"], peak, delta=1e-9)
        self.assertLess(expected[0][0], .999)
        self.assertIn("FRAC of all functions", self.bough("compare", "f.h5", "--test", "t.unv").stdout)
        with h5py.File(self.path("c.h5")) as f:
            np.testing.assert_allclose(f["functions/values"][:, 0], [e[0] for e in expected], atol=1e-5)

    def test_own_functions(self):
        self.bough("export", "f.h5", "--to", "uff", "-o", "t.unv")
        data = json.loads(self.bough("compare", "f.h5", "--test", "t.unv", "--json").stdout)
        self.assertAlmostEqual(data["frac"], 1, delta=1e-10)
        for one in data["functions"]:
            self.assertAlmostEqual(one["level_db"], 0, delta=1e-9)

    def test_what_does_not_fit(self):
        value = np.ones(FINE.size) + 0j
        good = write_function("a", 2, 1, FINE, value)
        self.write("t.unv", good + write_function("b", 7, 1, FINE, value))
        result = self.bough("compare", "f.h5", "--test", "t.unv")
        self.assertIn("[cli.test-functions]", result.stderr)
        self.assertIn("node 7", result.stderr)
        for text, error, says in (
                (write_function("b", 7, 1, FINE, value), "cli.no-test-functions", "node 7"),
                ("    -1\n    15\n    -1\n", "cli.no-test-functions", "dataset 58"),
                (good + write_function("c", 2, 1, FINE, value, reference=(5, 2)), "cli.test-reference", "2 reference points"),
                (good.replace("58", "58b", 1), "matrices.uff", "58b"),
                (good.replace(" 1.00000E+00", " 1.0000xE+00", 1), "matrices.bad-number", "t.unv:"),
                (write_function("d", 2, 1, FINE[::-1], value, form="uneven double"), "matrices.uff", "do not ascend"),
                (good.rsplit("\n", 5)[0] + "\n", "matrices.truncated", "t.unv")):
            self.write("t.unv", text)
            self.fails(1, "compare", "f.h5", "--test", "t.unv", error=error, says=[says])


if __name__ == "__main__":
    unittest.main()
