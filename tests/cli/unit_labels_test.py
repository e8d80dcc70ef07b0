"""[units] of a system file: labels in results, CSV heads, plots and pages; curves of several runs in the same charts."""
import csv
import re
import unittest

import h5py
import numpy as np

from curves_test import SYSTEM
from report_test import PageReader
from support import ProgramTest
from toml_text import section, table, toml

LABELS = {"length": "mm", "mass": "tonne", "time": "s", "force": "N"}
UNITS = "[units]\n" + "".join(f'{key} = "{label}"\n' for key, label in LABELS.items())
TURN = toml(
    table("body", "wheel", mass=1.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "pin", "revolute", child="wheel", axis=[0.0, 0.0, 1.0], rate=[0.5]),
    section("simulation", duration=1.0))


def label(dims):
    """Each letter on its own: no program text is shared."""
    return re.sub("[LMTF]", lambda m: {"L": "mm", "M": "tonne", "T": "s", "F": "N"}[m.group()], dims)


class Units(ProgramTest):
    def report(self, *files):
        self.bough("report", *files, "-o", "page.html")
        with open(self.path("page.html"), encoding="utf-8") as f:
            return PageReader(f.read())

    def run_system(self, name, units, damping=0.4):
        self.write(name + ".toml", units + SYSTEM.format(damping=damping, step=0.02).replace('name = "oscillator"\n', ""))
        self.bough("run", name + ".toml", "-o", name + ".h5", "-q")

    def test_results_keep_the_labels_and_the_numbers(self):
        self.run_system("plain", "")
        self.run_system("named", UNITS)
        with h5py.File(self.path("plain.h5")) as plain, h5py.File(self.path("named.h5")) as named:
            found = {}
            plain.visititems(lambda path, item: found.update({path: item}) if isinstance(item, h5py.Dataset) else None)
            labelled = 0
            for path, item in found.items():
                if path == "system" or path.startswith("checkpoint"):
                    continue
                self.assertNotIn("units", item.attrs)
                np.testing.assert_array_equal(item[()], named[path][()])
                units = named[path].attrs.get("units", "")
                if units and "rad" not in units:
                    self.assertEqual(units, label(item.attrs["dims"]), path)
                    labelled += 1
            self.assertGreater(labelled, 10)
            self.assertEqual(named["time"].attrs["units"], "s")
            self.assertEqual(named["sensors/place"].attrs["units"], "mm")
            self.assertEqual(named["energy/kinetic"].attrs["units"], "N mm")
            self.assertEqual(named["bodies/bob/angular_velocity"].attrs["units"], "rad/s")

    def test_angles_are_radians(self):
        self.write("turn.toml", UNITS + TURN)
        self.bough("run", "turn.toml", "-o", "turn.h5", "-q")
        with h5py.File(self.path("turn.h5")) as f:
            self.assertEqual(f["hinges/pin/q"].attrs["units"], "rad")
            self.assertEqual(f["hinges/pin/qdot"].attrs["units"], "rad/s")
            self.assertNotIn("units", f["bodies/wheel/quaternion"].attrs)

    def test_heads_and_axes(self):
        self.run_system("plain", "")
        self.run_system("named", UNITS)
        heads = {}
        for name in ("plain", "named"):
            self.bough("export", name + ".h5", "--to", "csv", "--channel", "place:x", "-o", name + ".csv")
            with open(self.path(name + ".csv"), encoding="utf-8", newline="") as f:
                heads[name] = next(csv.reader(f))
            self.bough("plot", name + ".h5", "--sensor", "place:x", "-o", name + ".svg")
        self.assertEqual(heads, {"plain": ["time", "sensors/place:x"], "named": ["time [s]", "sensors/place:x [mm]"]})
        for name, words in (("plain", (">time [T]<", ">place:x [L]<")), ("named", (">time [s]<", ">place:x [mm]<"))):
            with open(self.path(name + ".svg"), encoding="utf-8") as f:
                text = f.read()
            for word in words:
                self.assertIn(word, text)
        term = self.bough("plot", "named.h5", "--sensor", "place:x", "--psd", "--segment", "256", "--term").stdout
        self.assertIn("frequency [Hz]", term)

    def test_densities_are_per_unit_of_their_axis(self):
        """The integral of a density over the numbers of its axis is the variance, here in mm^2."""
        for time_unit, axis, density in (("ms", "frequency [kHz]", "[mm^2/kHz]"), ("min", "frequency [1/min]", "[mm^2 min]"), ("s", "frequency [Hz]", "[mm^2/Hz]")):
            self.run_system("run", UNITS.replace('time = "s"', f'time = "{time_unit}"'), damping=0.01)
            self.bough("plot", "run.h5", "--sensor", "place:x", "--psd", "--segment", "256", "--csv", "run.csv", "-o", "run.svg")
            text = self.read("run.svg")
            self.assertIn(f">{axis}<", text)
            self.assertIn(density.replace("^2", "²"), text)
            curve = np.genfromtxt(self.path("run.csv"), delimiter=",", skip_header=1)[:, 1:]
            with h5py.File(self.path("run.h5")) as f:
                variance = np.var(f["sensors/place"][:, 0])
            self.assertAlmostEqual(np.sum(curve[:, 1]) * curve[1, 0], variance, delta=0.1 * variance)
            self.bough("plot", "run.h5", "--sensor", "place:x", "--srs", "relative-displacement", "-o", "run.svg")
            self.assertIn(f">natural {axis}<", self.read("run.svg"))

    def test_other_units_have_other_labels(self):
        self.write("a.toml", UNITS + TURN)
        self.bough("convert", "a.toml", "--units", "mm-N-tonne:m-kg-s", "-o", "b.toml")
        with open(self.path("b.toml"), encoding="utf-8") as f:
            text = f.read()
        for line in ('length = "m"', 'mass = "kg"', 'time = "s"', 'force = "N"'):
            self.assertIn(line, text)
        self.bough("check", "b.toml")

    def test_a_misspelt_unit_is_an_error(self):
        self.write("bad.toml", '[units]\nlength = "meter"\n' + TURN)
        self.assertIn("bad.toml:2: error", self.bough("check", "bad.toml", code=1).stderr)

    def test_two_runs_share_their_charts(self):
        self.run_system("soft", UNITS, 0.4)
        self.run_system("stiff", UNITS, 0.8)
        page = self.report("soft.h5", "stiff.h5")
        places = [a for tag, a in page.elements if a.get("data-view") == "overlay"]
        self.assertEqual(len(places), 1)
        with open(self.path("page.html"), encoding="utf-8") as f:
            text = f.read()
        first = text[text.index('data-view="overlay"'):]
        picture = first[:first.index("</figure>")]
        for word in ("soft.h5", "stiff.h5", "place [mm]", "time [s]"):
            self.assertIn(word, picture)
        self.assertEqual(picture.count('stroke-linejoin="round"'), 4)    # two curves and two entries of the legend
        # One run: nothing to compare.
        self.assertFalse([a for _, a in self.report("soft.h5").elements if a.get("data-view") == "overlay"])

    def test_noise_has_no_chart(self):
        self.run_system("run", UNITS)
        data = self.report("run.h5").get_data()[0]
        place = next(c for c in data["channels"] if c["path"] == "/sensors/place")
        self.assertEqual([c["noise"] for c in place["columns"]], [False, True, True])    # it slides along x
        self.assertEqual([c["unit"] for c in place["columns"]], ["mm"] * 3)

    def test_first_screen(self):
        """Verdict, numbers and the picture come before the file's provenance, which is folded."""
        self.run_system("run", UNITS)
        self.report("run.h5")
        with open(self.path("page.html"), encoding="utf-8") as f:
            text = f.read()
        places = [text.index(word) for word in ('class="summary"', 'class="highlights"', 'data-view="motion"', 'class="provenance"')]
        self.assertEqual(places, sorted(places))
        self.assertLess(text.index('data-view="motion"'), text.index("SHA-256"))
        with h5py.File(self.path("run.h5")) as f:
            largest = np.linalg.norm(f["hinges/slide/reaction_force"][:], axis=1).max()
            sensor = np.linalg.norm(f["sensors/place"][:], axis=1).max()
        shown = re.findall(r"<dt>([^<]*)</dt><dd>([^<]*)</dd><dd class", text)
        values = dict(shown)
        if largest > 0:
            self.assertEqual(values["largest reaction force"], f"{largest:.4g} N")
        self.assertEqual(values["largest place"], f"{sensor:.4g} mm")


class LinearModels(ProgramTest):
    """Labels of the system file in linear models, sweeps and responses: frequencies in cycles per unit of time."""
    SLIDER = toml(
        section("parameters", spring=0.09),
        table("body", "mass", mass=1.0, inertia=[1.0, 1.0, 1.0]),
        table("hinge", "slide", "prismatic", child="mass", axis=[1.0, 0.0, 0.0], stiffness=["$spring"], damping=[0.01]),
        table("sensor", "place", "hinge_angle", hinge="slide"),
        table("actuator", "motor", "hinge", hinge="slide"),
        section("simulation", duration=1.0))

    def setUp(self):
        super().setUp()
        for name, units in (("plain", ""), ("quick", '[units]\nlength = "mm"\nmass = "kg"\ntime = "ms"\nforce = "kN"\n')):
            self.write(name + ".toml", units + self.SLIDER)

    def draw(self, *arguments):
        self.bough("plot", *arguments, "-o", "plot.svg")
        return self.read("plot.svg")

    def test_files_and_tables(self):
        tables = {name: self.bough("linearize", name + ".toml", "-o", name + ".h5").stdout for name in ("plain", "quick")}
        self.assertIn("frequency Hz", tables["plain"])
        self.assertIn("frequency kHz", tables["quick"])
        self.assertNotIn("Hz", tables["quick"].replace("kHz", ""))
        self.assertRegex(tables["quick"], r"coordinate +position +speed +unit")
        self.assertRegex(tables["quick"], r"slide:1 +0 +0 +mm")
        with h5py.File(self.path("plain.h5")) as plain, h5py.File(self.path("quick.h5")) as quick:
            self.assertEqual([quick.attrs[key + "_unit"] for key in ("length", "mass", "time", "force")], ["mm", "kg", "ms", "kN"])
            self.assertEqual([key for key in plain.attrs if key.endswith("_unit")], [])  # as older files
            np.testing.assert_array_equal(quick["/A"][:], plain["/A"][:])
            # 0.3 rad/ms without damping
            np.testing.assert_allclose(quick["/poles/frequency_hz"][:], 0.3 / (2 * np.pi), rtol=1e-9)
        self.assertIn("time_unit", self.bough("info", "quick.h5").stdout)
        self.assertIn(" kHz", self.bough("response", "quick.h5", "-o", "response.h5").stdout)
        with h5py.File(self.path("response.h5")) as f:
            self.assertEqual(f.attrs["time_unit"], "ms")

    def test_labels_of_no_consistent_set_are_warned_of(self):
        for mass, found in (("tonne", False), ("kg", True)):
            self.write("set.toml", f'[units]\nlength = "mm"\nmass = "{mass}"\ntime = "s"\nforce = "N"\n' + self.SLIDER)
            messages = self.bough("run", "set.toml", "-o", "set.h5").stderr
            self.assertEqual("system.inconsistent-units" in messages, found, mass)
            self.assertEqual("forces of 0.001 N" in messages, found, mass)

    def test_axes_and_pages(self):
        for name in ("plain", "quick"):
            self.bough("linearize", name + ".toml", "-o", name + ".h5")
        self.bough("linearize", "quick.toml", "--sweep", "spring=0.04:0.09:3", "-o", "sweep.h5")
        self.bough("response", "quick.h5", "--psd", "1", "-o", "random.h5")
        for kind in ("bode", "sigma"):
            self.assertIn("frequency [Hz]", self.draw("plain.h5", "--kind", kind))
            self.assertIn("frequency [kHz]", self.draw("quick.h5", "--kind", kind))
        self.assertIn("real part [1/T]", self.draw("plain.h5", "--kind", "poles"))
        self.assertIn("real part [1/ms]", self.draw("quick.h5", "--kind", "poles"))
        self.assertIn("frequency [kHz]", self.draw("sweep.h5", "--kind", "campbell"))
        self.assertIn("imaginary part [1/ms]", self.draw("sweep.h5", "--kind", "locus"))
        self.assertIn("kHz", self.bough("plot", "quick.h5", "--kind", "bode", "--term").stdout)
        self.bough("report", "quick.h5", "sweep.h5", "random.h5", "-o", "page.html")
        page = self.read("page.html")
        self.assertIn("N0 [kHz]", page)
        self.assertIn("unit²/kHz", page)
        self.assertNotIn("[Hz]", page.split("<script")[0])
        self.write("hours.toml", '[units]\ntime = "h"\n' + self.SLIDER)
        self.bough("linearize", "hours.toml", "-o", "hours.h5")
        self.assertIn("frequency [1/h]", self.draw("hours.h5", "--kind", "bode"))
        for kind in ("bode", "sigma", "poles"):
            self.fails(1, "plot", "hours.h5", "quick.h5", "--kind", kind, "-o", "both.svg", error="cli.plot-units")


if __name__ == "__main__":
    unittest.main()
