"""edit of Python changes a text as the script of the same lines on the command line does."""
import os
import shutil
import subprocess
import unittest

import bough
from module_test import EXPRESSION, PENDULUM, InFolder

PROGRAM = os.environ["BOUGH_PROGRAM"]
SYSTEM = PENDULUM.format(law=EXPRESSION)


class Edit(InFolder):
    def setUp(self):
        super().setUp()
        self.write("arm.toml", SYSTEM)

    def read(self, name="arm.toml"):
        with open(name, encoding="utf-8", newline="") as f:
            return f.read()

    def test_lines_change_the_text_and_nothing_else(self):
        found = bough.edit("arm.toml", ["set pivot.damping = 0.5", "# a comment", "set arm.mass=3.0"])
        self.assertEqual(found["text"], SYSTEM.replace("mass = 2.0", "mass = 3.0").replace(
            "position_deg = 30.0\n", "position_deg = 30.0\ndamping = 0.5\n"))
        self.assertEqual((found["changed"], found["printed"], self.read()), (True, "", SYSTEM))
        self.assertEqual(sorted(os.listdir()), ["arm.toml"])
        bough.System.from_text(found["text"])
        self.assertFalse(bough.edit("arm.toml", "set arm.mass=3.0\nundo")["changed"])

    def test_it_prints_what_the_command_prints(self):
        script = "list hinge\nshow pivot\nset arm.mass=3.0\ndiff\nhelp hinge.damping\ncheck\n"
        ran = subprocess.run([PROGRAM, "edit", "arm.toml", "-q"], input=script, capture_output=True, text=True,
                             check=True)
        self.assertEqual(bough.edit("arm.toml", script)["printed"], ran.stdout)
        self.assertIn("pivot", ran.stdout)

    def test_output_and_save(self):
        found = bough.edit("arm.toml", ["rename arm boom"], "new.toml")
        self.assertEqual((self.read("new.toml"), self.read()), (found["text"], SYSTEM))
        self.assertIn('child = "boom"', found["text"])
        shutil.copy("arm.toml", "twin.toml")
        subprocess.run([PROGRAM, "edit", "twin.toml", "-q"], input="rename arm boom\nsave\n", text=True, check=True)
        self.assertEqual(self.read("twin.toml"), found["text"])
        bough.edit("arm.toml", ["set arm.mass=3.0"], "arm.toml")
        self.assertIn("mass = 3.0", self.read())
        bough.edit("arm.toml", ["set arm.mass=4.0", "save"])
        self.assertIn("mass = 4.0", self.read())
        made = bough.edit("grown.toml", ["add body rod mass=1.0 inertia=[0.1, 0.1, 0.1]",
                                         "add hinge root type=revolute child=rod axis=[0, 0, 1]"])["text"]
        self.assertIn('name = "rod"', made)

    def test_the_first_wrong_line_raises(self):
        for line, error in (("sett arm.mass=1", "cli.edit-command"), ("set am.mass=1", "cli.edit-name"),
                            ("set pivot.type=revolut", "toml.bad-value"), ("delete arm", "cli.edit-referenced"),
                            ("run", "cli.edit-command"), ("plot x.h5", "cli.edit-command")):
            with self.subTest(line), self.assertRaises(bough.InputError) as caught:
                bough.edit("arm.toml", ["# a comment", line], "new.toml")
            (message,) = caught.exception.messages
            self.assertEqual((message.id, message.file, message.line), (error, "<commands>", 2))
            self.assertFalse(os.path.exists("new.toml"))
        with self.assertRaisesRegex(bough.InputError, "cli.wrong-file"):
            bough.edit("arm.bdf", [])


if __name__ == "__main__":
    unittest.main()
