"""matrices, frequency, transient, split, init and response(psd=) of Python have the numbers of the commands."""
import json
import os
import shutil
import subprocess
import unittest

import numpy as np
import scipy.sparse

import bough
from module_test import EXAMPLES, EXPRESSION, PENDULUM, InFolder

PROGRAM = os.environ["BOUGH_PROGRAM"]
DRIVEN = """RLOAD1,5,6,,,7
DAREA,6,11,2,1.0
TABLED1,7
,0.0,1.0,1000.0,1.0,ENDT
FREQ1,8,1.0,1.0,20
TABDMP1,9,CRIT
,0.0,0.02,1000.0,0.02,ENDT
EIGRL,10,,,4
TLOAD2,15,6,,,0.0,1.0,3.0
TSTEP,16,50,0.01,1
ENDDATA"""


class Decks(InFolder):
    def setUp(self):
        super().setUp()
        shutil.copy(os.path.join(EXAMPLES, "ex01-spinup", "boom.bdf"), self.folder)
        with open("boom.bdf", encoding="utf-8") as f:
            self.bulk = f.read()
        self.bulk = self.bulk[self.bulk.index("BEGIN BULK"):]

    def run_command(self, *words):
        subprocess.run([PROGRAM, *words, "-q"], check=True)

    def assert_same_file(self, found, path):
        expected = bough.reader.read(path)
        self.assertEqual((found.format, sorted(found)), (expected.format, sorted(expected)))
        for name in found:
            np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
            self.assertEqual(found.describe(name), expected.describe(name))
        self.assertEqual(str(found.attributes), str(expected.attributes))

    def test_matrices(self):
        stages = []
        found = bough.matrices("boom.bdf", progress=stages.append)
        self.run_command("matrices", "boom.bdf", "-o", "m.h5")
        self.assert_same_file(found, "m.h5")
        K = scipy.sparse.csr_matrix((found["K/data"], found["K/indices"], found["K/indptr"]))
        self.assertLess(abs(K - K.T).max(), 1e-9 * abs(K).max())
        self.assertEqual(K.shape[0], len(found["dof_map"]))
        with self.assertRaisesRegex(ValueError, "no_kg leaves out"):
            bough.matrices("boom.bdf", loads=7, no_kg=True)

    def write_driven(self, name, control):
        """The boom with dynamic loads, and modal damping for the control that selects them."""
        self.write(name, control + "SDAMPING = 9\nMETHOD = 10\nDISP = ALL\n" + self.bulk.replace("ENDDATA", DRIVEN))

    def assert_same_as_command(self, found, *command):
        """The command line writes what Python returned."""
        self.run_command(*command, "-o", "c.h5")
        self.assert_same_file(found, "c.h5")

    def test_frequency_and_transient(self):
        self.write_driven("shaken.bdf", "SOL 111\nCEND\nSPC = 1\nDLOAD = 5\nFREQ = 8\n")
        found = bough.frequency("shaken.bdf", grids=11)
        self.assert_same_as_command(found, "frequency", "shaken.bdf", "--grid", "11")
        self.assertEqual(found["subcases/1/displacement/real"].shape[0], 21)
        bough.frequency("shaken.bdf", grids=11, f06="p.f06", op2="p.op2")
        self.run_command("frequency", "shaken.bdf", "--grid", "11", "--f06", "c.f06", "--op2", "c.op2")
        for suffix in ("f06", "op2"):
            with open(f"p.{suffix}", "rb") as own, open(f"c.{suffix}", "rb") as expected:
                self.assertEqual(own.read(), expected.read(), suffix)
        direct = bough.frequency("shaken.bdf", direct=True)
        self.assertEqual(direct.attributes["subcases/1"]["method"], "direct")
        with self.assertRaisesRegex(ValueError, "leave out modal"):
            bough.frequency("shaken.bdf", direct=True, number=3)
        with self.assertRaises(TypeError):
            bough.frequency("shaken.bdf", nmber=3)

        self.write_driven("struck.bdf", "SOL 112\nCEND\nSPC = 1\nDLOAD = 15\nTSTEP = 16\n")
        found = bough.transient("struck.bdf", number=3)
        self.assert_same_as_command(found, "transient", "struck.bdf", "-n", "3")
        self.assertEqual(found["subcases/1/displacement/value"].shape[0], 51)
        bough.transient("struck.bdf", number=3, csv="p.csv", punch="p.pch")
        self.run_command("transient", "struck.bdf", "-n", "3", "--csv", "c.csv", "--punch", "c.pch")
        for suffix in ("csv", "pch"):
            with open(f"p.{suffix}", encoding="utf-8") as own, open(f"c.{suffix}", encoding="utf-8") as expected:
                self.assertEqual(own.read(), expected.read(), suffix)

    def test_nonlinear_transient_is_solved_linearly_on_request(self):
        self.write_driven("bent.bdf", "SOL 129\nCEND\nSPC = 1\nDLOAD = 15\nTSTEPNL = 17\n")
        with open("bent.bdf", encoding="utf-8") as f:
            text = f.read()
        self.write("bent.bdf", text.replace("ENDDATA", "PARAM,LGDISP,1\nTSTEPNL,17,50,.01,1\nENDDATA"))
        with self.assertRaises(bough.InputError):
            bough.transient("bent.bdf", number=3)
        found = bough.transient("bent.bdf", number=3, linear=True)
        self.assert_same_as_command(found, "transient", "bent.bdf", "-n", "3", "--linear")
        with self.assertRaisesRegex(TypeError, "transient\\(\\) has"):
            bough.frequency("bent.bdf", linear=True)

    def test_split(self):
        found = bough.split("boom.bdf", parts=2, name="mast", modes=3)
        self.run_command("split", "boom.bdf", "--parts", "2", "--name", "mast", "--modes", "3", "-o", "parts")
        self.assertEqual(set(os.listdir("parts")), {*found["files"], "mast-1.h5", "mast-2.h5"})
        for name, text in found["files"].items():
            with open(os.path.join("parts", name), encoding="utf-8") as f:
                self.assertEqual(f.read(), text)
        for part in found["parts"]:
            written = bough.read_flex_body(f"parts/{part['name']}.h5")
            np.testing.assert_array_equal(part["body"].modal_stiffness, written.modal_stiffness)
        self.assertAlmostEqual(sum(part["mass"] for part in found["parts"]), found["mass"])
        for whole, parts in found["frequencies"]:
            self.assertLess(abs(parts / whole - 1), 1e-4)
        self.assertIsNone(bough.split("boom.bdf", grids=[6], check=False)["parts"][0]["body"])
        with self.assertRaisesRegex(bough.InputError, 'along is "w"; give one of path, long, x, y, z'):
            bough.split("boom.bdf", parts=2, along="w")
        with self.assertRaises(bough.InputError):
            bough.split("boom.bdf")

    def test_init(self):
        texts = bough.init("boom.bdf", "new", hinge=1)
        self.run_command("init", "boom.bdf", "--hinge", "1", "-o", "new")
        self.assertEqual(len(texts), 2)
        for name, text in texts.items():
            with open(os.path.join("new", name), encoding="utf-8") as f:
                lines = f.read().splitlines()
            self.assertEqual([line for line in lines if not line.startswith("#:schema")], text.splitlines())
        with self.assertRaisesRegex(bough.InputError, "node 999"):
            bough.init("boom.bdf", hinge=999)

    def test_random_response(self):
        text = PENDULUM.format(law=EXPRESSION).replace("gravity = [0.0, 0.0, -9.81]", "")
        model = bough.System.from_text(text).linearize()
        model.save("loop.h5")
        name = model.inputs[0]
        found = bough.response("loop.h5", inputs=name, psd=[f"{name}=0.5"], from_hz=0.01, to_hz=100)
        printed = json.loads(subprocess.run(
            [PROGRAM, "response", "loop.h5", "--inputs", name, "--psd", f"{name}=0.5", "--from", "0.01", "--to", "100",
             "--json", "-q"], check=True, capture_output=True, text=True).stdout)
        random = found["random"]
        self.assertEqual(random["outputs"], model.outputs)
        self.assertEqual(random["psd"].shape, (len(random["frequency_hz"]), len(model.outputs)))
        for i, one in enumerate(printed["random"]["outputs"]):
            self.assertEqual(one["rms"], random["rms"][i])
        # White noise into an oscillator: E[x²] = S/4/(c k), S one-sided in unit²/Hz.
        angle = model.outputs.index(next(o for o in model.outputs if o.startswith("angle")))
        self.assertAlmostEqual(random["total_rms"][angle]**2, 0.5 / (4 * 3 * 40), places=12)
        self.assertNotIn("random", bough.response("loop.h5"))
        with self.assertRaisesRegex(bough.InputError, "wheel"):
            bough.response("loop.h5", psd="wheel=1")

    def test_pointing_budget(self):
        text = PENDULUM.format(law=EXPRESSION).replace("gravity = [0.0, 0.0, -9.81]", "")
        model = bough.System.from_text(text).linearize()
        model.save("loop.h5")
        name = model.inputs[0]
        with open("jitter.toml", "w", encoding="utf-8") as f:
            f.write(f'exposure = 0.3\n[[source]]\nname = "cooler"\ntype = "tones"\nfrequency_hz = 2.0\n'
                    f'harmonic = [{{number = 1, input = "{name}", amplitude = 0.5}}]\n'
                    f'[[source]]\nname = "noise"\ntype = "psd"\npsd = [{{input = "{name}", density = 1e-3}}]\n')
        found = bough.response("loop.h5", budget="jitter.toml", from_hz=0.01, to_hz=100)
        printed = json.loads(subprocess.run(
            [PROGRAM, "response", "loop.h5", "--budget", "jitter.toml", "--from", "0.01", "--to", "100", "--json", "-q"],
            check=True, capture_output=True, text=True).stdout)
        self.assertEqual(found["outputs"], model.outputs)
        self.assertEqual(found["sources"], ["cooler", "noise"])
        self.assertEqual([table["weighting"] for table in found["tables"]], ["total", "jitter", "smear", "residual", "mean"])
        for table, one in zip(found["tables"], printed["tables"], strict=True):
            self.assertEqual(table["rms"].tolist(), [row["rms"] for row in one["rows"]])
            self.assertEqual(table["total"].tolist(), one["total"])
        self.assertEqual(found["curves"][0]["frequency_hz"][0, 0], 2.0)
        self.assertEqual(found["curves"][0]["rms"][0].tolist(), found["tables"][0]["rms"][0].tolist())
        with self.assertRaisesRegex(TypeError, "takes no inputs"):
            bough.response("loop.h5", budget="jitter.toml", psd=[1e-3])


if __name__ == "__main__":
    unittest.main()
