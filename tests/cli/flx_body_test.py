""".FLX files as bodies of all commands: equal to their HDF5 file; several bodies in one file; missing data."""
import json
import os
import re
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

ARM = """SOL 103
CEND
SPC = 1
BEGIN BULK
PARAM,COUPMASS,1
SPC1,1,123456,1
PBAR,1,1,1.-4,2.-8,1.-8,3.-8
MAT1,1,7.+10,,.3,2700.
{grids}
{bars}
CONM2,99,5,,0.3,0.,0.05,0.02,,+
+,.001,0.,.002,0.,0.,.002
ENDDATA
"""
SYSTEM = toml(
    table("body", "arm", file="{file}"),
    "{more}\n",
    table("hinge", "root", "revolute", parent="ground", child="arm", axis=[0.0, 0.0, 1.0], rate=3.0, stiffness=40.0),
    table("force", "push", body="arm", node=5, force=[0.0, 0.5, 0.2]),
    table("sensor", "tip", "deflection", body="arm", node=5),
    section("simulation", duration=0.5, output_step=0.05, relative_tolerance=1e-9, absolute_tolerance=1e-12))


def make_arm(length):
    grids = "\n".join(f"GRID,{i + 1},,{i * length / 4},0.,0." for i in range(5))
    bars = "\n".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,0.,1." for i in range(4))
    return ARM.format(grids=grids, bars=bars)


class FlxBody(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, length in (("a", 1.0), ("b", 1.3)):
            self.write(name + ".bdf", make_arm(length))
            self.bough("reduce", name + ".bdf", "--modes", 4, "--interface", 5, "--damping", 0.01, "-o", name + ".h5")

    def system(self, file, more="", name="s.toml"):
        return self.write(name, SYSTEM.format(file=file, more=more))

    def tip(self, file, more=""):
        self.bough("run", self.system(file, more), "-o", "r.h5")
        with h5py.File(self.path("r.h5")) as f:
            return f["/sensors/tip"][:]

    def notes(self, result):
        return result.stderr.count("[flx.not-carried]")

    def strip(self, name, to, head="FLX 1.0"):
        """The lines for a reader of version 1.0: none that begins with "!"."""
        with open(self.path(name)) as f:
            lines = [line for line in f if not line.startswith("!")]
        self.write(to, "".join(lines).replace("FLX 1.1", head))

    def test_a_run_equals_that_from_hdf5(self):
        expected = self.tip("a.h5")
        self.assertGreater(np.abs(expected).max(), 1e-3)
        self.bough("flx", "a.h5", "--stiffening", "--digits", 17, "-o", "a.FLX")
        self.assertTrue(np.array_equal(self.tip("a.FLX"), expected))
        self.bough("flx", "a.h5", "--stiffening", "-o", "nine.FLX")
        error = np.abs(self.tip("nine.FLX") - expected).max() / np.abs(expected).max()
        self.assertGreater(error, 0)
        self.assertLess(error, 1e-7)

    def read(self, name):
        with h5py.File(self.path(name)) as f:
            return f["/sensors/tip_deflection"][:]

    def test_the_spin_up_of_the_report(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        with open(self.path("spinup.toml")) as f:
            text = f.read().replace("duration = 20.0\n", "duration = 8.0\n")
        self.write("h5.toml", text)
        self.bough("run", "h5.toml", "-o", "h5.h5")
        tips = [self.read("h5.h5")]
        for digits in (17, 9):
            self.bough("flx", "boom.h5", "--stiffening", "--digits", digits, "-o", "boom.FLX")
            self.write("flx.toml", text.replace("boom.h5", "boom.FLX"))
            result = self.bough("run", "flx.toml", "-o", "flx.h5")
            self.assertEqual(self.notes(result), 1)
            tips.append(self.read("flx.h5"))
        self.assertAlmostEqual(tips[0][:, 1].min(), -0.5346, delta=0.002)
        self.assertTrue(np.array_equal(tips[1], tips[0]))
        self.assertLess(np.abs(tips[2] - tips[0]).max(), 1e-7 * np.abs(tips[0]).max())

    def test_without_geometric_stiffness_it_does_not_stiffen(self):
        self.bough("flx", "a.h5", "--digits", 17, "-o", "a.FLX")
        result = self.fails(1, "run", self.system("a.FLX"), error="system.missing-locators")
        self.assertIn("[system.no-stiffening]", result.stderr)
        self.assertIn("does not hold geometric stiffness", result.stderr)
        off = "stiffening = false"
        self.assertTrue(np.array_equal(self.tip("a.FLX", off), self.tip("a.h5", off)))

    def test_several_bodies_in_one_file(self):
        expected = [self.tip("a.h5"), self.tip("b.h5")]
        self.fails(2, "flx", "a.h5", "b.h5", says=["-o"])
        self.bough("flx", "a.h5", "b.h5", "--stiffening", "--digits", 17, "-o", "both.FLX")
        self.assertTrue(np.array_equal(self.tip("both.FLX:1"), expected[0]))
        self.assertTrue(np.array_equal(self.tip("both.FLX:2"), expected[1]))
        self.fails(1, "run", self.system("both.FLX"), says=["both.FLX:1"], error="flx.which-body")
        self.fails(1, "run", self.system("both.FLX:3"), says=["1 2"], error="flx.no-body")
        self.bough("flx", "a.h5", "b.h5", "--body-id", "7,3", "-o", "both.FLX")
        bodies = json.loads(self.bough("flx", "--read", "both.FLX", "--json").stdout)["bodies"]
        self.assertEqual([body["body_id"] for body in bodies], [7, 3])
        one = json.loads(self.bough("flx", "--read", "both.FLX:3", "--json").stdout)
        self.assertEqual(one["name"], "b")
        self.fails(1, "flx", "a.h5", "b.h5", "--body-id", "7,3,1", "-o", "c.FLX", error="cli.body-ids")
        self.fails(1, "flx", "a.h5", "b.h5", "--body-id", "7,7", "-o", "c.FLX", error="cli.body-ids")
        # Both bodies in one system, the file hashed once.
        self.bough("flx", "a.h5", "b.h5", "--stiffening", "--digits", 17, "-o", "both.FLX")
        text = SYSTEM.format(file="both.FLX:1", more="").replace("[simulation]", toml(
            table("body", "other", file="both.FLX:2"),
            table("hinge", "other root", "revolute", parent="ground", child="other", rate=3.0, stiffness=40.0),
            table("force", "other push", body="other", node=5, force=[0.0, 0.5, 0.2]),
            table("sensor", "other tip", "deflection", body="other", node=5), "[simulation]"))
        self.write("two.toml", text)
        self.bough("run", "two.toml", "-o", "two.h5")
        with h5py.File(self.path("two.h5")) as f:
            for name, tip in (("tip", expected[0]), ("other tip", expected[1])):
                self.assertLess(np.abs(f["/sensors/" + name][:] - tip).max(), 1e-6 * np.abs(tip).max())

    def test_mass_centre_and_inertia_from_the_system(self):
        """A rigid part from the .INT of TREETOPS equals that in the body's file."""
        expected = self.tip("a.h5", "stiffening = false")
        self.bough("flx", "a.h5", "--digits", 17, "-o", "new.FLX")
        self.strip("new.FLX", "old.FLX")
        self.fails(1, "run", self.system("old.FLX"), says=["cg and inertia"], error="flx.no-inertia")
        with h5py.File(self.path("a.h5")) as f:
            m, c, J = f["/rigid/mass"][()], f["/rigid/cg"][:], f["/rigid/inertia"][:]
        J = J - m * (c @ c * np.eye(3) - np.outer(c, c))
        given = f"stiffening = false\ncg = {c.tolist()}\ninertia = {J.tolist()}"
        self.assertLess(np.abs(self.tip("old.FLX", given) - expected).max(), 1e-9 * np.abs(expected).max())
        self.fails(1, "run", self.system("new.FLX", given), error="flx.two-inertias")
        twice = SYSTEM.format(file="old.FLX", more=given).replace("[[hinge]]", toml(
            table("body", "twin", file="old.FLX", cg=[1.0, 0.0, 0.0], inertia=[1.0, 1.0, 1.0]),
            table("hinge", "t", "free", child="twin"), "[[hinge]]"), 1)
        self.fails(1, "run", self.write("twice.toml", twice), says=["another inertia"], error="flx.two-inertias")
        self.fails(1, "run", self.system("a.h5", "cg = [1.0, 0.0, 0.0]"), error="toml.conflicting-keys")

    def test_linearize_and_select(self):
        self.bough("flx", "a.h5", "--stiffening", "--digits", 17, "-o", "a.FLX")
        for name in ("a.h5", "a.FLX"):
            self.system(name, name=name + ".toml")
            self.bough("linearize", name + ".toml", "-o", name + ".lin.h5")
        with h5py.File(self.path("a.h5.lin.h5")) as a, h5py.File(self.path("a.FLX.lin.h5")) as b:
            for block in "ABCD":
                self.assertTrue(np.array_equal(a[block][:], b[block][:]), block)
        for more in ([], ["{}.toml"]):
            tables = []
            for name in ("a.h5", "a.FLX"):
                result = self.bough("select", name, *[m.format(name) for m in more], "-n", 2, "--json", "-o", "small.h5")
                self.assertEqual(self.notes(result), name.endswith("FLX"))
                tables.append(json.loads(result.stdout))
            for a, b in zip(tables[0]["modes"], tables[1]["modes"]):
                self.assertEqual((a["mode"], a["kept"]), (b["mode"], b["kept"]))
                self.assertAlmostEqual(a["cost"], b["cost"], delta=1e-9 * tables[0]["total_cost"])
        with h5py.File(self.path("small.h5")) as f:
            self.assertEqual(f["/modal/mass"].shape, (2, 2))
        # The system names the body by its id, the call does not, and the other way round.
        self.system("a.FLX:1", name="id.toml")
        self.bough("select", "a.FLX", "id.toml", "-n", 2)
        self.bough("select", "a.FLX:1", "a.FLX.toml", "-n", 2)

    def test_other_verbs(self):
        self.bough("flx", "a.h5", "b.h5", "--stiffening", "-o", "both.FLX")
        result = self.bough("check", "both.FLX", "--json")
        bodies = json.loads(result.stdout)["bodies"]
        self.assertEqual([body["body_id"] for body in bodies], [1, 2])
        self.assertEqual([body["num_modes"] for body in bodies], [4, 4])
        self.assertLess(bodies[0]["kg_asymmetry"], 1e-7)
        self.fails(1, "check", "both.FLX:9", error="flx.no-body")
        names = [o["path"] for o in json.loads(self.bough("info", "both.FLX:2", "--json").stdout)["objects"]]
        self.assertIn("/2/kg_inertial", names)
        self.assertNotIn("/1/kg_inertial", names)
        pairs = json.loads(self.bough("compare", "a.h5", "both.FLX:1", "--json").stdout)["pairs"]
        for pair in pairs:
            self.assertAlmostEqual(pair["mac"], 1, delta=1e-9)
            self.assertLess(abs(pair["difference"]), 1e-7)
        self.assertEqual(self.notes(self.bough("report", "both.FLX:1", "-o", "body.html")), 1)
        self.bough("run", self.system("both.FLX:1"), "-o", "r.h5")
        page = self.bough("report", "r.h5", "-o", "run.html")
        with open(self.path("run.html")) as f:
            self.assertNotIn("is not here", f.read())
        self.assertEqual(self.notes(page), 0)
        for to in ("csv", "mat", "op4", "uff", "sid", "mbdyn", "flat"):
            self.bough("export", "both.FLX:2", "--to", to, "-o", "out." + to)
            self.assertGreater(os.path.getsize(self.path("out." + to)), 1000, to)
        self.fails(1, "check", self.write("cut.FLX", "FLX 1.1\nBODY 1\n"), error="flx.missing-block")

    def test_integrals_that_modopt_leaves_out(self):
        """At rest the linear model does not depend on integrals of first and second order."""
        self.bough("flx", "a.h5", "--modopt", 2, "--digits", 17, "-o", "a.FLX")
        poles = []
        for name in ("a.h5", "a.FLX"):
            text = SYSTEM.format(file=name, more="stiffening = false").replace("rate = 3.0\n", "")
            self.write("s.toml", re.sub(r"\[\[force\]\].*?\[\[sensor", "[[sensor", text, flags=re.S))
            result = self.bough("linearize", "s.toml", "-o", "lin.h5")
            with h5py.File(self.path("lin.h5")) as f:
                poles.append(np.sort(f["/poles/frequency_hz"][:]))
        self.assertIn("first and second order", result.stderr)
        self.assertLess(np.abs(poles[0] / poles[1] - 1).max(), 1e-9)

    def test_the_list_for_treetops(self):
        self.bough("flx", "a.h5", "b.h5", "--special-nodes", "--stiffening", "--int", "both.int.txt", "--int-first", 5,
                   "-o", "both.FLX")
        with open(self.path("both.int.txt")) as f:
            lines = f.read().splitlines()
        flx = json.loads(self.bough("flx", "--read", "both.FLX", "--json").stdout)["bodies"]
        for body in flx:
            for node in body["special_nodes"]["id"]:
                jets = [line for line in lines if line.startswith("ACTUATOR") and
                        f"BODY {body['body_id']} NODE {node} " in line]
                self.assertEqual(len(jets), 1)
        numbers = [int(line.split()[1]) for line in lines if line.startswith("SENSOR")]
        self.assertEqual(numbers, list(range(5, 5 + 18)))
        # Every jet and sensor is wired once.
        for kind, word in (("ACTUATOR", "TO ACTUATOR {}"), ("SENSOR", "CONNECT SENSOR {} ")):
            for line in lines:
                if line.startswith(kind):
                    wire = word.format(line.split()[1])
                    self.assertEqual(sum(other.startswith("CONNECT") and (wire in other + " ") for other in lines) > 0,
                                     True, wire)
        self.fails(1, "flx", "a.h5", "--int", "x.txt", "-o", "x.FLX", error="flx.no-special-nodes")


if __name__ == "__main__":
    unittest.main()
