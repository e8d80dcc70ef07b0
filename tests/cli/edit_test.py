"""bough edit: scripts of commands over a system file."""
import os
import subprocess
import unittest

from support import HANG, PROGRAM, SOURCE, ProgramTest, served
from toml_text import read_toml

SYSTEM = read_toml("pendulum.toml")


class Edit(ProgramTest):
    def edit(self, *commands, code=0, file="p.toml"):
        result = served.run([PROGRAM, "edit", file], cwd=self.folder, timeout=HANG, input="\n".join(commands) + "\n")
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def read(self, name="p.toml"):
        with open(self.path(name), newline="") as f:
            return f.read()

    def setUp(self):
        super().setUp()
        self.write("p.toml", SYSTEM)

    def test_a_script_changes_what_it_says_and_no_other_byte(self):
        self.edit("set pin.damping = 0.5", "set bob.mass=3.0", "save")
        self.assertEqual(self.read(), SYSTEM.replace("mass = 2.0", "mass = 3.0").replace(
            "position_deg = 30.0\n", "position_deg = 30.0\ndamping = 0.5\n"))
        self.bough("check", "p.toml")

    def test_nothing_is_written_without_save(self):
        said = self.edit("set bob.mass=3.0")
        self.assertEqual(self.read(), SYSTEM)
        self.assertIn("[cli.edit-unsaved]", said.stderr)

    def test_the_first_wrong_line_ends_the_script(self):
        said = self.edit("# a comment", "", "set bob.mas=3.0", "save", code=1)
        self.assertIn("stdin:3: error: ", said.stderr)
        self.assertIn("did you mean 'mass'", said.stderr)
        self.assertEqual(self.read(), SYSTEM)
        for command, error in [("sett bob.mass=1", "cli.edit-command"), ("set bob.mass", "cli.edit-command"),
                               ("set bib.mass=1", "cli.edit-name"), ("set pin.axis=[1, 0", "cli.edit-command"),
                               ("set pin.type=revolut", "toml.bad-value"), ("set bob.mass=-1", "toml.out-of-range"),
                               ("add gear x", "cli.edit-name"), ("add hinge x type=fixed", "toml.missing-key"),
                               ("add body bob mass=1", "cli.edit-name"), ("undo", "cli.edit-command"),
                               ("rename bob pin2 x", "cli.edit-name"), ("copy bob bob", "cli.edit-name"),
                               ("delete bob", "cli.edit-referenced"), ("help nothing", "cli.edit-name")]:
            with self.subTest(command):
                said = self.edit(command, code=1)
                self.assertIn("stdin:1: error: ", said.stderr)
                self.assertIn(f"[{error}]", said.stderr)

    def test_a_system_grows_from_nothing_and_runs(self):
        self.edit("add body rod mass=1.0 inertia=[0.1, 0.1, 0.1]",
                  "add hinge root type=revolute child=rod axis=[0, 0, 1] rate=2",
                  "add sensor turn type=hinge_angle hinge=root", "add simulation duration=0.5",
                  "check", "save", "run -o new.h5", "plot new.h5 --sensor turn -o new.svg", file="new.toml")
        self.assertTrue(os.path.exists(self.path("new.svg")))
        self.bough("check", "new.toml")

    def test_lists_of_names_and_unknown_keys(self):
        self.edit("add controller c type=sum inputs=[one, \"two\", three:x]", "save")
        self.assertIn('inputs = ["one", "two", "three:x"]', self.read())
        self.edit("add sensor s type=accelerometer scale=[1, 2,3]", "save")
        self.assertIn("scale = [1, 2,3]", self.read())
        wrong = self.edit("add function f type=step tme=2", code=1)
        self.assertIn("unknown key 'tme' in a function", wrong.stderr)
        # Angles of a function in degrees; no key is made of the ending alone.
        self.edit("add function wave type=sine amplitude=1 frequency_hz=1 phase_deg=30", "set function.wave.phase_deg=45", "save")
        self.assertIn("phase_deg = 45", self.read())
        self.assertIn("unknown key 'tme_deg' in a function", self.edit("add function f type=step tme_deg=2", code=1).stderr)

    def test_rename_follows_references_and_delete_asks_for_them(self):
        self.edit("rename pin root", "rename bob weight", "save")
        self.assertEqual(self.read(), SYSTEM.replace('"pin"', '"root"').replace('"bob"', '"weight"'))
        said = self.edit("delete weight", code=1)
        self.assertIn("hinge.1.child", said.stderr)
        said = self.edit("add body other mass=1", "delete weight --with-references", "list", "save")
        self.assertIn("deleted: sensor angle", said.stdout)
        self.assertNotIn("weight", self.read())
        self.assertIn("other", said.stdout)

    def test_undo_and_redo(self):
        said = self.edit("set bob.mass=3.0", "copy bob second", "undo", "undo", "diff", "redo", "show bob.mass", "diff")
        self.assertIn("3.0\n", said.stdout)
        self.assertEqual(said.stdout.count("@@ -1,7 +1,7 @@"), 1)
        self.assertIn("-mass = 2.0\n+mass = 3.0\n", said.stdout)

    def test_save_does_not_run_over_what_another_wrote(self):
        self.edit("set bob.mass=3.0", "save q.toml")
        self.assertEqual(self.read(), SYSTEM)
        self.assertIn("mass = 3.0", self.read("q.toml"))
        said = self.edit("set bob.mass=4.0", "save q.toml", code=1)
        self.assertIn("[cli.output-exists]", said.stderr)
        process = subprocess.Popen([PROGRAM, "edit", "p.toml"], cwd=self.folder, text=True, stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        process.stdin.write("set bob.mass=5.0\nshow bob.mass\n")
        process.stdin.flush()
        self.assertEqual(process.stdout.readline(), "5.0\n")  # the file is read by now
        self.write("p.toml", SYSTEM + "# by another\n")
        _, said = process.communicate("save\n", timeout=HANG)
        self.assertEqual(process.returncode, 1)
        self.assertIn("[cli.edit-changed]", said)
        self.assertTrue(self.read().endswith("# by another\n"))

    def test_output_leaves_the_file_alone(self):
        self.bough("edit", "p.toml", "-o", "q.toml")
        self.assertFalse(os.path.exists(self.path("q.toml")))
        subprocess.run([PROGRAM, "edit", "p.toml", "-o", "q.toml"], cwd=self.folder, text=True, check=True,
                       input="set bob.mass=3.0\nsave\nset bob.mass=4.0\nsave\nrun -o q.h5\n", capture_output=True)
        self.assertEqual(self.read(), SYSTEM)
        self.assertIn("mass = 4.0", self.read("q.toml"))
        self.assertTrue(os.path.exists(self.path("q.h5")))
        self.fails(1, "edit", "p.toml", "-o", "q.toml", "--no-clobber", error="cli.output-exists")

    def test_run_reads_the_saved_file(self):
        self.assertIn("[cli.edit-unsaved]", self.edit("set bob.mass=3.0", "run", code=1).stderr)

    def test_parameters_and_tables_of_their_own(self):
        self.edit("set parameters.m = 4.0", "set bob.mass = $m", "rename parameters.m weight",
                  "set simulation.output_step = 0.1", "check", "save")
        self.assertIn('mass = "$weight"', self.read())
        self.assertIn("[parameters]\nweight = 4.0\n", self.read())
        self.assertIn("[cli.edit-referenced]", self.edit("delete parameters.weight", code=1).stderr)

    def test_body_files(self):
        self.copy_example("ex01-spinup")
        self.edit("set body.modes.number = 3", "add body.load tip node=11", "save", "list", file="boom.toml")
        self.assertIn('[[body.load]]\nname = "tip"\nnode = 11\n', self.read("boom.toml"))
        self.bough("check", "boom.toml")

    def test_completion_and_help(self):
        def offers(text):
            return self.edit("complete " + text).stdout.split()

        self.assertEqual(sorted(offers("un")), ["undo", "unset"])
        self.assertIn("add", offers("a"))
        self.assertIn("hinge", offers("add h"))
        self.assertIn("stiffness=", offers("add hinge x st"))
        self.assertIn("type=revolute", offers("add hinge x type=re"))
        self.assertIn("child=bob", offers("add hinge x child="))
        self.assertIn("pin.damping=", offers("set pin.da"))
        self.assertEqual(offers("delete b"), ["bob"])
        said = self.edit("help", "help hinge", "help stiffness", "help set").stdout
        self.assertIn("one of fixed, revolute", said)
        self.assertIn("rename NAME NEW", said)

    def test_completion_of_nodes(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-q")
        said = self.edit("complete add sensor s type=position body=boom node=4", "complete set tip_deflection.node=39",
                         "complete add sensor s body=nobody node=", file="spinup.toml").stdout.split()
        self.assertEqual(said, ["node=4", "node=40", "node=41", "tip_deflection.node=39"])
        self.write("p.toml", SYSTEM.replace("mass = 2.0", "mass = 2.0\nnodes = [{id = 7, position = [0, 0, -1]}]"))
        self.assertEqual(self.edit("complete add hinge h parent=bob parent_node=").stdout.split(),
                         ["parent_node=0", "parent_node=7"])

    def test_each_example_is_kept_byte_for_byte(self):
        for folder in sorted(os.listdir(os.path.join(SOURCE, "data/examples"))):
            path = os.path.join(SOURCE, "data/examples", folder)
            for name in sorted(os.listdir(path)):
                if not name.endswith(".toml") or name in ("campaign.toml", "jitter.toml"):
                    continue
                with self.subTest(name), open(os.path.join(path, name), newline="") as f:
                    text = f.read()
                    self.write("e.toml", text)
                    self.edit("show", "list", "save", file="e.toml")
                    self.assertEqual(self.read("e.toml"), text)

    def test_what_is_no_system_file_is_refused(self):
        self.write("beam.bdf", "ENDDATA\n")
        self.fails(1, "edit", "beam.bdf", error="cli.wrong-file")


if __name__ == "__main__":
    unittest.main()
