"""First errors of a new user: names of components, angles in degrees by mistake, commands of other programs, campaigns
without their decks, files under other names, failures that leave nothing behind."""
import json
import math
import os
import re
import resource
import shlex
import subprocess
import unittest

import h5py
import numpy as np

from studio_browser_test import make_plate
from support import BEAM, PROGRAM, SOURCE, ProgramTest
from toml_text import Bare, section, table, toml

# A rigid body turns about z at 0.1 rad/s for 1 s.
YAW = toml(
    table("body", "hub", mass=1.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "z", "%s", child="hub"),
    "%s\n",
    table("sensor", "attitude", "euler", body="hub"),
    section("simulation", duration=1.0, output_step=0.5))
TURNING = YAW % ("revolute", "axis = [0.0, 0.0, 1.0]\nrate = 0.1")
LAW = toml(
    table("controller", "law", "pid", inputs=["%s"], kp=1.0),
    table("actuator", "motor", "hinge", hinge="z", input="law"))
EVENT = table("event", "turned", signal="%s", value=0.05)
# A mass on a sampled law: two poles of the loop are at z = 0 (held sample, delay).
SAMPLED = toml(
    table("body", "m", mass=1.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "z", "revolute", child="m", axis=[0.0, 0.0, 1.0], stiffness=Bare("%s")),
    table("sensor", "angle", "hinge_angle", hinge="z"),
    table("sensor", "rate", "hinge_rate", hinge="z"),
    table("controller", "law", "pid", inputs=["angle"], rate="rate", kp=1.0, kd=1.0, sample_time=0.1, delay=0.05),
    table("actuator", "motor", "hinge", hinge="z", input="law"),
    section("simulation", duration=1.0))


class Components(ProgramTest):
    def test_euler_angles_are_named_by_their_order(self):
        self.write("yaw.toml", TURNING)
        self.bough("run", "yaw.toml", "-o", "yaw.h5")
        for name in ("attitude:angle1", "attitude:1"):
            self.bough("export", "yaw.h5", "--to", "csv", "--channel", name, "-o", "a.csv")
            with open(self.path("a.csv")) as f:
                lines = [line for line in f.read().splitlines() if not line.startswith("#")]
            self.assertIn("attitude:angle1", lines[0])
            self.assertAlmostEqual(float(lines[-1].split(",")[1]), 0.1, places=9)   # of sequence 321 the first is about z
        for name in ("attitude:x", "attitude:z"):
            for call in (("plot", "yaw.h5", "--sensor", name, "--csv", "p.csv"),
                         ("export", "yaw.h5", "--to", "csv", "--channel", name, "-o", "b.csv"),
                         ("report", "yaw.h5", "--channel", name, "-o", "r.html")):
                self.fails(1, *call, says=["angle1", "angle2", "angle3"], error="cli.unknown-channel")
        self.bough("report", "yaw.h5", "-o", "r.html")
        page = self.read("r.html")
        self.assertIn("attitude:angle3", page)
        self.assertNotIn("attitude:x", page)
        self.bough("plot", "yaw.h5", "--sensor", "attitude", "-o", "p.svg")
        with open(self.path("p.svg")) as f:
            self.assertIn("angle2", f.read())

    def test_inputs_and_events_by_a_name_that_is_none_are_errors(self):
        for name, code in (("attitude:z", 1), ("attitude:x", 1), ("attitude:angle1", 0), ("attitude:1", 0)):
            self.write("law.toml", TURNING + LAW % name)
            self.write("event.toml", TURNING + EVENT % name)
            for file, error in (("law.toml", "control.unknown-signal"), ("event.toml", "run.unknown-signal")):
                result = self.bough("check", file, code=code)
                if code:
                    self.assertIn(f"[{error}]", result.stderr)
                    self.assertIn("angle1, angle2, angle3", result.stderr)

    def test_linear_models(self):
        self.write("law.toml", TURNING + LAW % "attitude:angle1")
        for name in ("attitude:angle1", "attitude:1"):
            self.bough("linearize", "law.toml", "--outputs", name, "-o", "l.h5")
            with h5py.File(self.path("l.h5")) as f:
                self.assertEqual([n.decode() for n in f["outputs/name"][:]], ["attitude:angle1"])
                self.assertAlmostEqual(f["C"][0, 0], 1, places=9)   # the hinge turns about z
        self.fails(1, "linearize", "law.toml", "--outputs", "attitude:z", error="linear.unknown-output")
        self.bough("linearize", "law.toml", "--break", "attitude:1")
        self.fails(1, "linearize", "law.toml", "--break", "attitude:z", error="linear.unknown-signal")

    def test_three_coordinates_are_no_axes(self):
        """A planar hinge has two travels and an angle, in this order: x, y, z would be the wrong names of them."""
        self.write("planar.toml", YAW % ("planar", "rate = [0.1, 0.2, 0.3]")
                   + table("sensor", "q", "hinge_angle", hinge="z"))
        self.bough("run", "planar.toml", "-o", "p.h5")
        self.bough("export", "p.h5", "--to", "csv", "--channel", "q:3", "-o", "q.csv")
        self.fails(1, "export", "p.h5", "--to", "csv", "--channel", "q:z", error="cli.unknown-channel")


class Slips(ProgramTest):
    def test_degrees_where_radians_are_meant(self):
        for keys, warns in (("position = 90.0", True), ("position_deg = 90.0", False), ("position = 6.28", False),
                            ("position = -7.0", True), ("null_position = 45.0", True),
                            ("parent_rotation = [0.0, 0.0, 90.0]", True), ("stops = {upper = 90.0, stiffness = 1.0}", True),
                            ("rate = 90.0", False)):
            with self.subTest(keys):
                self.write("yaw.toml", YAW % ("revolute", "axis = [0.0, 0.0, 1.0]\n" + keys))
                said = self.bough("check", "yaw.toml").stderr
                self.assertEqual("[toml.large-angle]" in said, warns, said)
                if warns:
                    self.assertIn(f"write {re.search('(position|null_position|parent_rotation|upper)', keys).group(1)}_deg", said)
        self.write("slide.toml", YAW % ("prismatic", "axis = [0.0, 0.0, 1.0]\nposition = 90.0"))
        self.assertNotIn("toml.large-angle", self.bough("check", "slide.toml").stderr)
        self.write("tilted.toml", TURNING.replace('type = "euler"', 'type = "euler"\nrotation = [90.0, 0.0, 0.0]'))
        self.assertIn("[toml.large-angle]", self.bough("check", "tilted.toml").stderr)

    def test_an_output_step_longer_than_the_run(self):
        self.write("yaw.toml", TURNING.replace("output_step = 0.5", "output_step = 1.5"))
        for verb in ("check", "run"):
            self.fails(1, verb, "yaw.toml", says=["output_step 1.5 is longer than duration 1"], error="run.bad-simulation")
        self.write("yaw.toml", TURNING.replace("output_step = 0.5", "output_step = 1.0"))
        self.bough("check", "yaw.toml")

    def test_commands_of_treetops(self):
        for word, says in (("treeset", "bough edit"), ("TREEPLOT", "bough plot"), ("modify", "set NAME.key=value"),
                           ("PRINT", "show NAME"), ("stop", "quit"), ("CONVRT", "bough convert")):
            self.fails(2, word, "x", says=["unknown command", says], error="cli.unknown-verb")
        self.write("yaw.toml", TURNING)
        for word, says in (("MODIFY hub", "set NAME.key=value"), ("PRINT", "show NAME"), ("STOP", "quit"),
                           ("CONVRT", "bough convert"), ("treeset", "bough edit")):
            ran = subprocess.run([PROGRAM, "edit", "yaw.toml"], cwd=self.folder, text=True, capture_output=True,
                                 input=word + "\n")
            self.assertIn(says, ran.stdout + ran.stderr)
        ran = subprocess.run([PROGRAM, "edit", "yaw.toml"], cwd=self.folder, text=True, capture_output=True,
                             input="LIST\nQUIT\n")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("attitude", ran.stdout)
        self.write("problem.INT", "1 SIM CONTROL\n  1 Title    TWO BODIES\n  2 Simulation stop time   10\n")
        for verb in ("check", "reduce", "run"):
            self.fails(1, verb, "problem.INT", says=["TREETOPS", "bough edit"], error="cli.wrong-file")
        self.write("beam.int", BEAM)     # a deck under that name is a deck
        self.bough("check", "beam.int")

    def test_words_that_others_programs_take(self):
        self.assertEqual(self.bough("help").stdout, self.bough("--help").stdout)
        self.assertEqual(self.bough("help", "run").stdout, self.bough("run", "--help").stdout)
        self.assertEqual(self.bough("version").stdout, self.bough("--version").stdout)
        self.assertEqual(self.bough("init", "--list").stdout, self.bough("init").stdout)
        self.fails(2, "help", "rnu", says=['did you mean "run"'], error="cli.unknown-verb")

    def test_a_campaign_that_does_not_bring_its_decks(self):
        self.write("a.bdf", BEAM)
        self.write("b.bdf", BEAM)
        text = '[campaign]\n%ssteps = ["reduce {deck}.bdf --modes 2 -o {deck}.h5", "info {deck}.h5"]\n' \
               '[[parameter]]\nname = "deck"\nvalues = ["a", "b"]\n'
        self.write("decks.toml", text % "")
        self.fails(1, "batch", "decks.toml", says=["reads a.bdf", 'files = ["a.bdf", "b.bdf"]'], error="batch.no-file")
        self.write("decks.toml", text % 'files = ["a.bdf", "b.bdf"]\n')
        self.bough("batch", "decks.toml")


class Files(ProgramTest):
    def test_a_flx_is_told_by_its_content(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        self.bough("flx", "boom.h5", "--stiffening", "--digits", 17, "-o", "boom.FLX")
        os.rename(self.path("boom.FLX"), self.path("problem.FLN"))
        os.rename(self.path("boom.h5"), self.path("body.FLX"))     # HDF5 under the other name
        with open(self.path("spinup.toml")) as f:
            text = f.read().replace("duration = 20.0", "duration = 1.0")
        self.bough("check", "problem.FLN")
        histories = []
        for name in ("problem.FLN", "body.FLX"):
            self.bough("info", name)
            self.write("short.toml", text.replace('"boom.h5"', f'"{name}"'))
            self.bough("run", "short.toml", "-o", "short.h5")
            with h5py.File(self.path("short.h5")) as f:
                histories.append(f["/sensors/tip_deflection"][:])
        np.testing.assert_allclose(histories[0], histories[1], atol=1e-9 * np.abs(histories[1]).max())

    def test_display_shapes_of_all_grids(self):
        """The wing of the satellite has 4 output nodes of 42 grids: every grid moves in pictures as --full has it."""
        self.copy_example("ex08-satellite")
        self.bough("reduce", "wing.toml")
        size = os.path.getsize(self.path("wing.h5"))
        self.bough("reduce", "wing.toml", "--full", "-o", "full.h5")
        with h5py.File(self.path("wing.h5")) as f, h5py.File(self.path("full.h5")) as whole:
            phi, grids = f["/mesh/phi"], whole["/grids/id"][:]
            self.assertEqual(phi.dtype, np.dtype("<f4"))
            self.assertEqual(phi.shape, (42, 3, 6))
            self.assertNotIn("/mesh/phi", whole)
            rows = whole["/dof_map"][:]
            exact = np.zeros(phi.shape)
            for (grid, code), row in zip(rows, whole["/full/phi"][:]):
                if 1 <= code <= 3:
                    exact[np.flatnonzero(grids == grid)[0], code - 1] = row
            np.testing.assert_allclose(phi[:], exact, rtol=1e-6, atol=1e-6 * np.abs(exact).max())
            self.assertLess(phi.nbytes, 0.1 * size)
        self.bough("export", "wing.h5", "--to", "vtu", "-o", "wing.vtu")
        with open(self.path("wing.vtu"), "rb") as f:
            self.assertIn(b'NumberOfPoints="42"', f.read())
        # Fewer modes, other units: the shapes follow.
        self.bough("select", "wing.h5", "pointing.toml", "--outputs", "tip", "--number", "3", "-o", "small.h5")
        with h5py.File(self.path("small.h5")) as f:
            self.assertEqual(f["/mesh/phi"].shape, (42, 3, 3))
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        with h5py.File(self.path("boom.h5")) as f:
            self.assertNotIn("/mesh/phi", f)    # every grid is an output node: nothing twice

    def test_nothing_is_left_when_the_disk_is_full(self):
        def call(*words):
            limit = (lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)))
            # Python ignores SIGXFSZ, and the program inherits that: writes fail as on a full disk.
            return subprocess.run([PROGRAM, *words], cwd=self.folder, text=True, capture_output=True, preexec_fn=limit,
                                  restore_signals=False)

        ran = call("init", "spinup", "-o", "a/b")
        self.assertEqual(ran.returncode, 3, ran.stderr)
        self.assertEqual(os.listdir(self.folder), [])
        self.write("yaw.toml", TURNING.replace("rate = 0.1", "stiffness = 1.0"))
        ran = call("equilibrium", "yaw.toml", "-o", "rest.h5")
        self.assertEqual(ran.returncode, 3, ran.stdout + ran.stderr)
        self.assertIn("rest.h5: ", ran.stderr)
        self.assertNotIn("part", ran.stderr)
        self.assertEqual(os.listdir(self.folder), ["yaw.toml"])
        self.bough("equilibrium", "yaw.toml", "-o", "rest.h5")
        with open(self.path("rest.h5"), "rb") as f:
            before = f.read()
        self.assertEqual(call("equilibrium", "yaw.toml", "-o", "rest.h5").returncode, 3)
        with open(self.path("rest.h5"), "rb") as f:
            self.assertEqual(f.read(), before)

    def test_a_pipe_is_no_missing_file(self):
        os.mkfifo(self.path("deck.bdf"))
        for verb in ("check", "modes"):
            result = self.fails(1, verb, "deck.bdf", says=["pipe"], error="cli.no-file")
            self.assertNotIn("no such file", result.stderr)

    def test_decks_with_odd_names(self):
        """Quotes, backslashes, dollars, dashes and lines in names: the files of init are read, reduced and run."""
        for stem in ('quote\'d "x"', "a\\b", "$HOME `id`", "-dash", "two\nlines", "it's # x"):
            with self.subTest(stem):
                self.write(stem + ".bdf", make_plate())
                self.bough("init", "./" + stem + ".bdf", "-o", ".")
                self.bough("reduce", "./" + stem + ".toml")
                ran = self.bough("run", "./" + stem + "-run.toml", "-o", "run.h5")
                self.assertNotIn("error", ran.stderr)
                # The commands in the first comments, as a shell takes them.
                words = [shlex.split(re.search("# bough (.*)", self.read(stem + end)).group(1)) for end in (".toml", "-run.toml")]
                if "\n" not in stem:
                    self.assertEqual([w[1].removeprefix("./") for w in words], [stem + ".toml", stem + "-run.toml"])


class SampledPoles(ProgramTest):
    def model(self, stiffness):
        self.write("s.toml", SAMPLED % stiffness)
        said = self.bough("linearize", "s.toml", "--break", "motor", "-o", "loop.h5").stdout
        return said, h5py.File(self.path("loop.h5"))

    def test_poles_at_zero_are_no_poles(self):
        said, f = self.model("0.0")
        with f:
            self.assertEqual(f["/A"].attrs["description"], "x+ = A x + B u: state, state")
            z = np.linalg.eigvals(f["/A"][:])
        gone = int(np.sum(np.abs(z) < 1e-9))
        self.assertGreater(gone, 0)
        self.assertIn(f"and {gone} poles at z = 0: gone within a sample", said)
        self.assertNotIn("-368", said)
        self.bough("plot", "loop.h5", "--kind", "poles", "-o", "p.svg")
        svg = self.read("p.svg")
        self.assertIn("real part of z", svg)
        self.assertIn("at 0: gone within a sample", svg)
        self.assertIn("2 at 1", svg)
        page = self.read_page("loop.h5")
        self.assertNotIn("-368", page)
        self.assertIn("gone within a sample", page)

    def test_modes_above_nyquist_are_named(self):
        """ω = 50 rad/s is 7.96 Hz; samples at 10 Hz show it at 2.04 Hz."""
        said, f = self.model("2500.0")
        with f:
            self.assertEqual([n.decode() for n in f["/aliased/mode"][:]], ["z:1"])
            np.testing.assert_allclose(f["/aliased/frequency_hz"][:], 50 / (2 * math.pi), rtol=1e-9)
            np.testing.assert_allclose(f["/aliased/appears_at_hz"][:], 10 - 50 / (2 * math.pi), rtol=1e-9)
            # The pole itself, from the eigenvalues of A.
            angle = np.abs(np.angle(np.linalg.eigvals(f["/A"][:]))) / (2 * math.pi * 0.1)
            self.assertLess(np.abs(angle - (10 - 50 / (2 * math.pi))).min(), 1e-6)
        self.assertRegex(said, r"aliased, above the Nyquist frequency 5 Hz\n.*\n *z:1 +7\.95775 +2\.04225")
        found = json.loads(self.bough("linearize", "s.toml", "--break", "motor", "--json").stdout)
        self.assertEqual(found["aliased"][0]["mode"], "z:1")


class PoleMarks(ProgramTest):
    def test_poles_are_crosses_and_zeros_hollow_rings(self):
        self.write("s.toml", SAMPLED.replace("sample_time = 0.1\ndelay = 0.05\n", "") % "2.0")
        self.bough("linearize", "s.toml", "--inputs", "motor", "--outputs", "rate", "-o", "l.h5")
        with h5py.File(self.path("l.h5")) as f:
            poles, zeros = f["/poles/real"].shape[0], f["/zeros/real"].shape[0]
        self.assertGreater(zeros, 0)
        self.bough("plot", "l.h5", "--kind", "poles", "-o", "p.svg")
        svg = self.read("p.svg")
        # One more of each in the legend.
        self.assertEqual(len(re.findall(r"l9 9m0 -9l-9 9", svg)), poles + 1)
        self.assertEqual(len(re.findall(r'<circle [^>]*fill="none"', svg)), zeros + 1)
        self.assertNotRegex(svg, r'<circle [^>]*fill="#ffffff"')
        self.assertRegex(svg, r">\u03b6 0\.\d+</text>")      # a ray of constant damping with its label
        said = self.bough("plot", "l.h5", "--kind", "poles", "--term").stdout
        self.assertRegex(said, "×|⊗")
        self.assertRegex(said, "×  poles")
        self.assertRegex(said, "o  zeros")

    def test_poles_at_zero_are_counted(self):
        self.write("free.toml", toml(
            table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "f", "free", child="b"),
            table("force", "push", body="b", force=[1.0, 0.0, 0.0]),
            section("simulation", duration=1.0)))
        self.bough("linearize", "free.toml", "-o", "l.h5")
        self.bough("plot", "l.h5", "--kind", "poles", "-o", "p.svg")
        with open(self.path("p.svg")) as f:
            self.assertIn(">12 at 0<", f.read())
        self.assertIn("12 at 0", self.bough("plot", "l.h5", "--kind", "poles", "--term").stdout)


if __name__ == "__main__":
    unittest.main()
