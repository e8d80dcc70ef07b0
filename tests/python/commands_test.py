"""check, compare, info, export, plot, report, flx, integrals, convert, run, batch, response and equilibrium of Python
have the numbers and texts of the commands of the same name."""
import json
import os
import subprocess
import unittest
import warnings

import numpy as np

import bough
from module_test import InExample

PROGRAM = os.environ["BOUGH_PROGRAM"]


class Commands(InExample):
    def command(self, *words, code=0):
        ran = subprocess.run([PROGRAM, *words], capture_output=True, text=True)
        self.assertEqual(ran.returncode, code, ran.stderr)
        return ran.stdout

    def make_files(self):
        bough.reduce("boom.toml").save("boom.h5")
        return bough.run("spinup.toml", "run.h5")

    def test_check(self):
        found = bough.check("boom.bdf")
        expected = json.loads(self.command("check", "boom.bdf", "--json"))
        for name in ("kind", "sol", "cards", "skipped", "num_nodes", "num_elements", "num_dofs", "num_free_dofs",
                     "errors", "warnings"):
            self.assertEqual(found[name], expected[name], name)
        self.assertEqual([str(message) for message in found["messages"]], expected["messages"])
        self.assertEqual(found["mass_properties"]["mass"], expected["mass_properties"]["mass"])
        np.testing.assert_allclose(found["ground_check"], expected["ground_check"])
        self.write("bad.bdf", "BEGIN BULK\nGRID,1,,0.,0.,x\nENDDATA\n")
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # what is found is a result here, no warning of Python
            bad = bough.check("bad.bdf")
        self.assertEqual(bad["errors"], 1)
        self.assertEqual([(m.file, m.line) for m in bad["messages"] if m.severity == "error"], [("bad.bdf", 2)])
        with self.assertRaisesRegex(bough.InputError, "none.bdf"):
            bough.check("none.bdf")

    def test_kinds_of_files(self):
        self.make_files()
        for name, kind in (("boom.toml", "body"), ("spinup.toml", "system"), ("boom.h5", "bough-flexbody"),
                           ("run.h5", "bough-results")):
            self.assertEqual(bough.check(name)["kind"], kind)
        self.assertEqual(bough.check("spinup.toml", parameters={})["bodies"][0]["num_modes"],
                         json.loads(self.command("check", "spinup.toml", "--json"))["bodies"][0]["num_modes"])

    def test_run(self):
        bough.reduce("boom.toml").save("boom.h5")
        times = []
        found = bough.run("spinup.toml", "run.h5", progress=lambda time, end: times.append((time, end)))
        self.assertTrue(found["completed"])
        expected = json.loads(self.command("run", "spinup.toml", "-o", "other.h5", "--json"))
        for name in ("completed", "time", "reason", "steps", "rejected", "evaluations", "energy_error", "resumed_from"):
            self.assertEqual(found[name], expected[name], name)
        self.assertEqual(times[-1], (found["time"], found["time"]))
        a, b = bough.read_results("run.h5"), bough.read_results("other.h5")
        np.testing.assert_array_equal(a["tip_deflection"], b["tip_deflection"])
        stopped = bough.run("spinup.toml", "short.h5", progress=lambda time, end: time < end / 4)
        self.assertFalse(stopped["completed"])
        self.assertTrue(bough.run("spinup.toml", "short.h5", resume=True)["completed"])
        np.testing.assert_allclose(bough.read_results("short.h5")["tip_deflection"][-1], a["tip_deflection"][-1],
                                   rtol=1e-6, atol=1e-12)
        with self.assertRaises(ZeroDivisionError):
            bough.run("spinup.toml", "raised.h5", progress=lambda time, end: 1 / 0)

    def test_info_and_export(self):
        self.make_files()
        found = bough.info("run.h5")
        expected = json.loads(self.command("info", "run.h5", "--json"))
        self.assertEqual(found["attributes"]["format"], "bough-results")
        self.assertEqual(len(found["objects"]), len(expected["objects"]))
        for to, name in (("csv", "run.h5"), ("bdf", "boom.bdf"), ("vtu", "boom.h5"), ("uff", "boom.h5")):
            self.assertEqual(bough.export(name, to), self.command("export", name, "--to", to), to)
        one = bough.export("run.h5", "csv", channels="tip_deflection", output="tip.csv")
        self.assertEqual(one, self.command("export", "run.h5", "--to", "csv", "--channel", "tip_deflection"))
        with open("tip.csv", encoding="utf-8") as f:
            self.assertEqual(f.read(), one)
        self.assertEqual(bough.export("boom.h5", "gltf")[:4], b"glTF")
        self.assertEqual(bough.export("boom.h5", "sid", inertia="3x3", ge_order="component", digits=9),
                         self.command("export", "boom.h5", "--to", "sid", "--inertia", "3x3", "--ge-order", "component",
                                      "--digits", "9"))
        for words in ({"inertia": "9x1"}, {"ge_order": "none"}, {"digits": 5}, {"vendor": "sc"}, {"unit": -1}):
            with self.subTest(words), self.assertRaises(ValueError):
                bough.export("boom.h5", "sid", **words)
        with self.assertRaisesRegex(ValueError, "mat needs an output"):
            bough.export("boom.h5", "mat")
        with self.assertRaisesRegex(bough.InputError, "cli.unknown-channel"):
            bough.export("run.h5", "csv", channels="tap")

    def assert_same_comparison(self, found, *words):
        """The arrays are those of the file that `bough compare` with these words writes."""
        self.command("compare", *words, "-o", "c.h5")
        expected = bough.reader.read("c.h5")
        self.assertEqual(sorted(found), sorted(expected))
        for name in found:
            if isinstance(found[name], np.ndarray):
                np.testing.assert_array_equal(np.ravel(found[name]), np.ravel(expected[name]), err_msg=name)

    def test_compare(self):
        bough.reduce("boom.toml").save("a.h5")
        bough.reduce("boom.toml", modes=4).save("b.h5")
        found = bough.compare("a.h5", "b.h5")
        self.assert_same_comparison(found, "a.h5", "b.h5")
        np.testing.assert_allclose(np.diag(found["mac"]), 1, atol=1e-9)

    def test_compare_with_a_test(self):
        self.command("modes", "boom.bdf", "-n", "4", "-o", "m.h5")
        bough.export("m.h5", "uff", "t.unv")
        found = bough.compare("m.h5", test="t.unv")
        self.assert_same_comparison(found, "m.h5", "--test", "t.unv")
        np.testing.assert_allclose(np.diag(found["mac"]), 1, atol=1e-6)
        self.assertEqual(found["test_analysis_model"], ["serep"])
        for tam in ("guyan", "irs"):
            found = bough.compare("m.h5", test="t.unv", tam=tam, deck="boom.bdf")
            self.assert_same_comparison(found, "m.h5", "--test", "t.unv", "--tam", tam, "--deck", "boom.bdf")
            self.assertEqual(found["test_analysis_model"], [tam])
        for words in ({"tam": "irs"}, {"deck": "boom.bdf"}, {"test": "t.unv", "tam": "guyan"},
                      {"test": "t.unv", "sensors": 3}):
            with self.subTest(words), self.assertRaises(ValueError):
                bough.compare("m.h5", **words)

    def test_places_of_sensors(self):
        self.command("modes", "boom.bdf", "-n", "4", "-o", "m.h5")
        found = bough.compare("m.h5", sensors=5)
        self.assert_same_comparison(found, "m.h5", "--sensors", "5")
        self.assertEqual(found["dofs"].shape, (5, 2))
        with self.assertRaisesRegex(bough.InputError, "cli.bad-range"):
            bough.compare("m.h5", sensors=-1)

    def test_plot_and_report(self):
        self.make_files()
        found = bough.plot("run.h5", "tip_deflection", title="Tip", output="tip.svg")
        self.command("plot", "run.h5", "--sensor", "tip_deflection", "--title", "Tip", "-o", "expected.svg")
        with open("expected.svg", encoding="utf-8") as f, open("tip.svg", encoding="utf-8") as own:
            self.assertEqual(own.read(), f.read())
        curve = found["plots"][0]["curves"][0]
        np.testing.assert_array_equal(curve["x"], bough.read_results("run.h5").time)
        self.assertTrue(found["csv"].startswith("curve,x,y\n"))
        for options, words in (({"window": (1, 3), "y_min": -1, "y_max": 1.5}, ["--window", "1,3", "--y-min", "-1", "--y-max", "1.5"]),
                               ({"psd": True, "segment": 64, "log_x": True}, ["--psd", "--segment", "64", "--log-x"])):
            self.command("plot", "run.h5", "--sensor", "tip_deflection", "-o", "expected.svg", *words)
            with open("expected.svg", encoding="utf-8") as f:
                self.assertEqual(bough.plot("run.h5", "tip_deflection", **options)["svg"], f.read(), options)
        for words in ({"y_min": 1}, {"window": (1,)}, {"inputs": "a"}, {"srs_part": "half"}, {"segment": 1}, {"q": 0.5}):
            with self.subTest(words), self.assertRaises(ValueError):
                bough.plot("run.h5", "tip_deflection", **words)
        page = bough.report(["run.h5", "boom.h5"], title="Spin-up")
        self.command("report", "run.h5", "boom.h5", "--title", "Spin-up", "-o", "expected.html")
        with open("expected.html", encoding="utf-8") as f:
            self.assertEqual(page, f.read())

    def test_flx_and_integrals(self):
        bough.reduce("boom.toml").save("boom.h5")
        text = bough.flx("boom.h5", "boom.FLX", digits=17)
        self.command("flx", "boom.h5", "--digits", "17", "-o", "expected.FLX")
        with open("expected.FLX", encoding="utf-8") as f:
            self.assertEqual(text, f.read())
        (body,) = bough.read_flx("boom.FLX")
        np.testing.assert_allclose(body["K"], bough.read_flex_body("boom.h5").modal_stiffness, rtol=1e-15)
        folder = os.path.join(os.environ["BOUGH_SOURCE_DIR"], "data", "integrals")
        model, matrices = os.path.join(folder, "test.inp"), os.path.join(folder, "test.mat")
        found = bough.integrals(model, matrices, inertial_loads=True)
        self.command("integrals", model, matrices, "-o", "i.FLX", "-q")
        with open("i.FLX", encoding="utf-8") as f:
            self.assertEqual(found["flx"], f.read())
        self.assertEqual(found["inertial_loads"].shape, (len(found["dof_map"]), 12))

    def test_convert(self):
        texts = bough.convert("boom.bdf", "mm.bdf", "m-kg-s:mm-N-tonne")
        self.assertFalse(os.path.exists("mm.bdf"))
        self.command("convert", "boom.bdf", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.bdf")
        with open("mm.bdf", encoding="utf-8") as f:
            self.assertEqual(texts, {"mm.bdf": f.read()})
        body = bough.reduce("boom.toml")
        body.save("boom.h5")
        scaled = bough.convert("boom.h5", "mm.h5", "m-kg-s:mm-N-tonne")
        np.testing.assert_allclose(scaled.mass, body.mass * 1e-3, rtol=1e-12)
        with self.assertRaisesRegex(bough.InputError, "cli.bad-units"):
            bough.convert("boom.bdf", "x.bdf", "m:mm")

    def test_batch(self):
        bough.reduce("boom.toml").save("boom.h5")
        self.write("study.toml", '[campaign]\nname = "study"\nmethod = "grid"\n'
                                 'steps = ["reduce boom.toml -o b.h5"]\n[[parameter]]\nname = "E"\n'
                                 'file = "boom.bdf"\ncard = "MAT1"\nid = 1\nfield = "E"\nvalues = [7e10, 8e10]\n')
        done = []
        found = bough.batch("study.toml", "python", jobs=1, progress=lambda count, open_: done.append(count))
        self.assertEqual((found["cases"], found["done"], found["failed"], found["completed"]), (2, 2, [], True))
        self.assertEqual(done, [1, 2])
        self.assertEqual(bough.batch("study.toml", "python", jobs=1)["done_before"], 2)

    def test_response_and_equilibrium(self):
        self.write("mass.toml", '[[body]]\nname = "m"\nmass = 2.0\n[[hinge]]\nname = "h"\ntype = "prismatic"\n'
                                'child = "m"\naxis = [1.0, 0.0, 0.0]\nstiffness = 8.0\ndamping = 0.4\n'
                                '[[sensor]]\nname = "x"\ntype = "hinge_angle"\nhinge = "h"\n[[input]]\nname = "f"\n'
                                'start = 0.0\n[[actuator]]\nname = "a"\ntype = "hinge"\nhinge = "h"\ninput = "f"\n'
                                "[simulation]\nduration = 1.0\noutput_step = 0.1\n")
        bough.System("mass.toml").linearize(open=True).save("l.h5")
        found = bough.response("l.h5", outputs="x", points=40)
        w = 2 * np.pi * found["frequency_hz"]
        column = list(found["inputs"]).index("a") if "a" in found["inputs"] else 0
        gain = np.array([value[0, column] for value in found["value"]])
        np.testing.assert_allclose(gain, 1 / (8 - 2 * w ** 2 + 0.4j * w), rtol=1e-6)
        rest = bough.equilibrium("mass.toml")
        np.testing.assert_allclose(rest["hinges"]["h"], [0], atol=1e-12)
        self.assertEqual(rest["unstable"], [])

    def test_nothing_is_printed_and_only_outputs_are_written(self):
        self.make_files()
        with self.nothing_written():
            bough.check("boom.bdf")
            bough.info("run.h5")
            bough.export("run.h5", "csv")
            bough.plot("run.h5", "tip_deflection")
            bough.report("run.h5")
            bough.flx("boom.h5")
            bough.convert("boom.bdf", "mm.bdf", "m-kg-s:mm-N-tonne")
            bough.compare("boom.h5")


if __name__ == "__main__":
    unittest.main()
