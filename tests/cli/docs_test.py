"""The commands of the tutorial, of "your own deck" and of the examples, as printed, with the numbers they print."""
import csv
import importlib.util
import os
import re
import shlex
import shutil
import unittest

import h5py

from page_blocks import list_commands
from support import PROGRAM, SOURCE, ProgramTest, served


def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as f:
        return f.read()


def find_toml(text, after):
    """The first ```toml block behind a text."""
    return re.search(r"```toml\n(.*?)```", text[text.index(after):], re.S).group(1)


class Pages(ProgramTest):
    def do(self, text, skip=()):
        """Runs every line that begins with four blanks and bough or cd, in order; gives what all of them printed."""
        folder, printed = self.folder, ""
        for line in list_commands(text):
            for command in line.split("&&"):
                words = shlex.split(command)
                if words[0] == "cd":
                    folder = os.path.join(folder, words[1])
                    continue
                if any(word in command for word in skip):
                    continue
                ran = served.run([PROGRAM, *words[1:]], cwd=folder)
                self.assertEqual(ran.returncode, 0, f"{command}\n{ran.stdout}{ran.stderr}")
                printed += ran.stdout
        self.where = folder
        return printed

    def demand_printed(self, text, printed, heading):
        """The block of output under `heading` in the page stands in what was printed, but for the residuals."""
        block = text[text.index(heading):]
        lines = re.findall(r"(?m)^    (?!bough )(\S.*)$|^    ( +\S.*)$", block.split("\n## ")[0])
        shown = {re.sub(r" +\S+e[-+]\d\d$", "", line.strip()) for line in printed.splitlines()}
        for line in (a or b for a, b in lines):
            if line.strip() not in ("...", ""):
                self.assertIn(re.sub(r" +\S+e[-+]\d\d$", "", line.strip()), shown)

    def test_tutorial(self):
        text = read("docs/tutorial.md")
        printed = self.do(text.split("## Next")[0], skip=["tip.pdf", "tip.png"])
        self.demand_printed(text, printed, "## 2. Look")
        self.demand_printed(text, printed, "## 3. Modes")
        with h5py.File(os.path.join(self.where, "spinup.h5")) as f:
            t, tip = f["/time"][:], f["/sensors/tip_deflection"][:]
        minimum = float(re.search(r"min\(\)\) +# (\S+)", text).group(1))
        inwards = float(re.search(r"argmin\(\), 0\]\) +# (\S+):", text).group(1))
        self.assertAlmostEqual(tip[:, 1].min(), minimum, places=5)
        self.assertAlmostEqual(tip[abs(t - 6.77).argmin(), 0], inwards, places=4)
        for name in ["tip.svg", "tip.csv", "both.svg", "spinup-no-kg.h5"]:
            self.assertTrue(os.path.exists(os.path.join(self.where, name)), name)

    def test_your_own_deck(self):
        text = read("docs/your-deck.md")
        self.write("tap.toml", find_toml(text, "`tap.toml`"))
        before, after = text.split("## 4. A simulation")
        printed = self.do(before)
        self.assertRegex(printed, r"load factors of LOAD 10\n(.*\n)+ +1 +0\.16735")
        shutil.move(self.path("tap.toml"), self.where)
        self.folder = self.where
        if not shutil.which("rsvg-convert"):
            after = after.replace("tap.png", "tap.svg")
        self.do(after)
        with open(os.path.join(self.where, "tap.csv")) as f:
            rows = list(csv.reader(f))
        self.assertEqual(rows[0][:2], ["time", "sensors/deflection:x"])
        self.assertGreater(max(abs(float(row[3])) for row in rows[1:]), 1e-6)

    def test_campaign_of_runs(self):
        self.copy_example("ex01-spinup")
        text = find_toml(read("docs/formats/campaign-toml.md"), "Peak deflections").replace("samples = 20", "samples = 3")
        self.write("peaks.toml", text)
        self.bough("batch", "peaks.toml")
        with open(self.path("peaks/outcomes.csv")) as f:
            rows = list(csv.DictReader(f))
        self.assertEqual(len(rows), 3)
        for row in rows:
            self.assertLess(float(row["tip_min"]), -0.1)
        for name in ["tip.csv", "tip.svg"]:
            self.assertTrue(os.path.exists(self.path("peaks/case-0001/" + name)))

    def test_readmes_of_the_examples_that_are_short(self):
        for example in ["ex01-spinup", "ex04-free-flyer", "ex05-plate", "ex06-campaign"]:
            with self.subTest(example):
                self.copy_example(example)
                self.do(read(f"data/examples/{example}/README.md"))


@unittest.skipUnless(shutil.which("dpkg-query"), "no Debian packages here")
class Licences(unittest.TestCase):
    def test_every_library_is_in_the_list(self):
        spec = importlib.util.spec_from_file_location("list_licences", os.path.join(SOURCE, "tools/list_licences.py"))
        tool = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(tool)
        listed = set(re.findall(r"(?m)^PackageName: (\S+)$", read("packaging/licences.spdx")))
        found = tool.find_packages(PROGRAM)
        self.assertGreater(len(found), 20)
        self.assertEqual([name for name in found if name not in listed], [])


if __name__ == "__main__":
    unittest.main()
