"""reduce, modes, static and select of Python have the numbers and the options of the commands of the same name."""
import json
import os
import shutil
import subprocess
import sys
import unittest

import numpy as np

import bough
from module_test import InExample

PROGRAM = os.environ["BOUGH_PROGRAM"]


class Analyses(InExample):
    def test_modes_are_those_of_the_command(self):
        stages = []
        for options, words in (({"max_hz": 20.0}, ["--max-hz", "20"]), ({"free": True, "number": 8}, ["--free", "-n8"]),
                               ({"mass": "lumped", "no_check": True}, ["--mass", "lumped", "--no-check"])):
            subprocess.run([PROGRAM, "modes", "boom.bdf", "-q", "-o", "m.h5", *words], check=True)
            modes, expected = bough.modes("boom.bdf", progress=stages.append, **options), bough.read_modes("m.h5")
            np.testing.assert_array_equal(modes.frequency_hz, expected.frequency_hz)
            np.testing.assert_array_equal(modes.phi[-1], expected.phi[-1])
        self.assertTrue(all(isinstance(stage, str) for stage in stages))
        with self.assertRaisesRegex(ValueError, "mass is deck, lumped or consistent, not heavy"):
            bough.modes("boom.bdf", mass="heavy")
        with self.assertRaises(TypeError):
            bough.modes("boom.bdf", nmber=3)

    def test_static_is_the_file_of_the_command(self):
        with open("boom.bdf", encoding="utf-8") as f:
            text = f.read()
        begin = text.index("BEGIN BULK")
        control = "SOL 101\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 7\nSUBCASE 2\nLOAD = 8\n"
        self.write("loaded.bdf", control + text[begin:].replace(
            "ENDDATA", "FORCE,7,11,,1.,0.,1.,0.\nMOMENT,8,11,,1.,0.,0.,1.\nENDDATA"))
        words = ["--extremes", "--strains", "--grid-forces", "all"]
        subprocess.run([PROGRAM, "static", "loaded.bdf", "-q", "-o", "s.h5", *words], check=True)
        found = bough.static("loaded.bdf", extremes=True, strains=True, grid_forces="all")
        expected = bough.reader.read("s.h5")
        self.assertEqual((found.format, found.path), ("bough-static", "loaded.bdf"))
        self.assertEqual(sorted(found), sorted(expected))
        for name in found:
            np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
            self.assertEqual(found.describe(name), expected.describe(name))
        self.assertEqual(str(found.attributes), str(expected.attributes))
        one = bough.static("loaded.bdf", subcase=2)
        self.assertNotIn("subcases/1/displacement", one)
        np.testing.assert_array_equal(one["subcases/2/displacement"], found["subcases/2/displacement"])

    def assert_same_listings(self, deck, write, *words):
        """f06 and op2 of a function are the files of the command, but for the time of day."""
        write(f06="p.f06", op2="p.op2")
        subprocess.run([PROGRAM, *words, deck, "--f06", "c.f06", "--op2", "c.op2", "-q"], check=True)
        for suffix in ("f06", "op2"):
            with open(f"p.{suffix}", "rb") as found, open(f"c.{suffix}", "rb") as expected:
                self.assertEqual(found.read(), expected.read(), suffix)
        with self.assertRaises(bough.InputError) as caught:
            write(f06="same", op2="same")
        self.assertEqual([message.id for message in caught.exception.messages], ["cli.same-output"])
        with self.assertRaises(bough.InputError) as caught:
            write(f06=deck)
        self.assertEqual([message.id for message in caught.exception.messages], ["cli.output-is-input"])

    def test_listings_are_those_of_the_command(self):
        with open("boom.bdf", encoding="utf-8") as f:
            text = f.read()
        bulk = text[text.index("BEGIN BULK"):].replace("ENDDATA", "FORCE,7,11,,1.,0.,1.,0.\nENDDATA")
        self.write("s.bdf", "SOL 101\nCEND\nSPC = 1\nLOAD = 7\nDISP = ALL\nFORCE = ALL\n" + bulk)
        self.assert_same_listings("s.bdf", lambda **files: bough.static("s.bdf", **files), "static")
        self.write("m.bdf", "SOL 103\nCEND\nSPC = 1\nMETHOD = 10\nDISP = ALL\n" +
                   bulk.replace("ENDDATA", "EIGRL,10,,,4\nENDDATA"))
        self.assert_same_listings("m.bdf", lambda **files: bough.modes("m.bdf", **files), "modes")
        with self.assertRaisesRegex(ValueError, "not load factors"):
            bough.modes("m.bdf", buckling=True, f06="b.f06")

    def test_every_choice_of_reduce(self):
        options = {"interface": [11], "loads": ["tip=6:2", "9:13"], "recover": "17-25", "strain_energy": True,
                   "full": True, "name": "rod", "damping": 0.02, "origin": [0.5, 0.0, 0.0], "solver": "lapack"}
        words = ["--interface", "11", "--load", "tip=6:2", "--load", "9:13", "--recover", "17-25", "--strain-energy",
                 "--full", "--name", "rod", "--damping", "0.02", "--origin", "0.5", "0", "0", "--solver", "lapack"]
        subprocess.run([PROGRAM, "reduce", "boom.bdf", "-n3", "-q", "-o", "c.h5", *words], check=True)
        bough.reduce("boom.bdf", modes=3, **options).save("p.h5")
        found, expected = bough.reader.read("p.h5"), bough.reader.read("c.h5")
        self.assertEqual(sorted(found), sorted(name for name in expected if not name.startswith("accuracy/")))
        for name in found:
            np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
        with self.assertRaisesRegex(bough.InputError, "cannot read --load"):
            bough.reduce("boom.bdf", modes=3, loads="here")

    def test_outputs_of_reduce(self):
        subprocess.run([PROGRAM, "reduce", "boom.bdf", "-n3", "-q", "-o", "c.h5", "--loads-deck", "c.bdf", "--loads-set",
                        "201"], check=True)
        body = bough.reduce("boom.bdf", modes=3, loads_deck="p.bdf", loads_set=201)
        with open("p.bdf", encoding="utf-8") as found, open("c.bdf", encoding="utf-8") as expected:
            self.assertEqual(found.read(), expected.read())
        subprocess.run([PROGRAM, "compare", "c.h5", "-q", "-o", "report.h5"], check=True)
        found, expected = bough.compare(body), bough.reader.read("report.h5")
        self.assertEqual(sorted(found), sorted(expected))
        for name in found:
            np.testing.assert_array_equal(np.ravel(found[name]), np.ravel(expected[name]), err_msg=name)
        with self.assertRaisesRegex(ValueError, "loads_set is the first of twelve load sets, 1 to 99999988, not 0"):
            bough.reduce("boom.bdf", modes=3, loads_deck="p.bdf", loads_set=0)
        with self.assertRaisesRegex(ValueError, "a FlexBody is compared with no other file"):
            bough.compare(body, sensors=3)
        with self.assertRaises(bough.InputError) as caught:
            bough.reduce("boom.bdf", modes=3, loads_deck="boom.bdf")
        self.assertEqual(caught.exception.messages[0].id, "cli.output-is-input")

    def test_matrices_of_another_program(self):
        bough.call("matrices", "boom.bdf", "-o", "k.h5", "-q")
        expected = bough.reduce("boom.bdf", modes=3).frequency_hz
        np.testing.assert_allclose(bough.reduce("boom.bdf", matrices="k.h5", modes=3).frequency_hz, expected, rtol=1e-9)
        self.assertTrue(bough.reduce(matrices=["k.h5"], modes=3, free=True).is_free_free)
        with self.assertRaisesRegex(ValueError, "only matrices do without"):
            bough.reduce(modes=3)

    def test_nothing_is_written_or_redirected(self):
        with self.nothing_written():
            bough.select(bough.reduce("boom.bdf", modes=3), number=1)
            bough.modes("boom.bdf", 2)

    def test_ranking_is_that_of_the_command(self):
        body = bough.reduce("boom.toml")
        body.save("boom.h5")
        words = ["select", "boom.h5", "--keep", "2", "-n1", "--json"]
        ran = subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True)
        self.assertEqual(bough.select("boom.h5", keep=2, number=1)[1], json.loads(ran.stdout))
        with self.assertRaisesRegex(ValueError, "selected by its file"):
            bough.select(body, "spinup.toml")

    def test_version(self):
        ran = subprocess.run([PROGRAM, "--version"], check=True, capture_output=True, text=True)
        self.assertIn(bough.__version__, ran.stdout.split("\n")[0])

    def test_without_the_compiled_module(self):
        shutil.copytree(os.path.join(os.path.dirname(bough.__file__)), "bare/bough",
                        ignore=shutil.ignore_patterns("*.so"))
        for text in ("import bough; bough.modes('boom.bdf')", "from bough import FlexBody",
                     "import bough; bough.__version__"):
            ran = subprocess.run([sys.executable, "-B", "-c", text], text=True, capture_output=True,
                                 env={**os.environ, "PYTHONPATH": "bare"})
            self.assertRegex(ran.stderr, r"ImportError: bough\.\w+ needs the compiled module bough\._bough.*\./dev demo")
        subprocess.run([sys.executable, "-B", "-c", "import bough; bough.reader.read"], check=True,
                       env={**os.environ, "PYTHONPATH": "bare"})


if __name__ == "__main__":
    unittest.main()
