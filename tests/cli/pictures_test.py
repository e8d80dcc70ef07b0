"""Pictures of the manuals: each is named by tools/pictures.py with the command of a page that makes it, and what the
command makes today looks like the stored picture. Compared in patches of 6 x 6 pixels: fonts differ between machines."""
import glob
import importlib.util
import os
import re
import shutil
import sys
import tempfile
import unittest

from browser import find_chromium
from support import PROGRAM, SOURCE, ProgramTest

HAS_PILLOW = importlib.util.find_spec("PIL") is not None
if HAS_PILLOW:
    import numpy as np
    from PIL import Image
    sys.path.insert(0, os.path.join(SOURCE, "tools"))
    import pictures

NOTEBOOKS = ["notebook-monte-carlo", "notebook-kg-by-hand"]
MODULE = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "python/bough")
HAS_NOTEBOOKS = os.path.isdir(MODULE) and importlib.util.find_spec("matplotlib") is not None
PATCH, MAX_DIFFERENCE = 6, 4.0    # of 255, mean over the picture


def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as f:
        return f.read()


@unittest.skipUnless(HAS_PILLOW, "Pillow is not installed (apt install python3-pil): pictures are not compared")
class Pictures(ProgramTest):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.mkdtemp(prefix="bough-test-")
        cls.addClassCleanup(shutil.rmtree, scratch)
        cls.pages = pictures.Pages(PROGRAM, scratch)
        cls.addClassCleanup(cls.pages.close)

    def load(self, path):
        image = Image.open(path).convert("L")
        return np.asarray(image.resize((max(1, image.width // PATCH), max(1, image.height // PATCH)), Image.BOX), float)

    def take(self, names):
        for name in names:
            self.pages.take(name, self.folder)
        self.compare(names)

    def compare(self, names):
        for name in names:
            stored = os.path.join(SOURCE, "docs/pictures", name + ".png")
            a, b = Image.open(self.path(name + ".png")), Image.open(stored)
            # The height of a terminal and of a page depends on the font.
            self.assertLess(abs(a.height / b.height - 1), 0.1, name)
            a, b = self.load(self.path(name + ".png")), self.load(stored)
            rows, columns = min(len(a), len(b)), min(len(a[0]), len(b[0]))
            self.assertLess(np.abs(a[:rows, :columns] - b[:rows, :columns]).mean(), MAX_DIFFERENCE, name)

    def test_every_picture_has_a_printed_command(self):
        known = {"edit", *NOTEBOOKS, *pictures.STUDIO}
        for name, shot in pictures.SHOTS.items():
            _, command = shot.find_command()
            self.assertTrue(command.startswith("bough "))
            self.assertIn(f"pictures/{name}.png", read(shot.page))
            known.add(name)
        stored = {os.path.basename(path)[:-4] for path in glob.glob(os.path.join(SOURCE, "docs/pictures/*.png"))}
        self.assertEqual(stored, known)

    @unittest.skipUnless(shutil.which("rsvg-convert"), "rsvg-convert is not installed: plots are not compared")
    def test_plots(self):
        self.take([name for name, shot in pictures.SHOTS.items() if shot.part.endswith(".svg")])

    def test_figures(self):
        """The curves of the stored figure, point by point in pixels."""
        for name in pictures.FIGURES:
            with open(self.pages.draw(name), encoding="utf-8") as f:
                made = self.list_curves(f.read())
            stored = self.list_curves(read(f"docs/{name}.svg"))
            self.assertEqual(len(made), len(stored))
            for a, b in zip(made, stored):
                self.assertEqual(a.shape, b.shape)
                self.assertLess(np.abs(a - b).max(), 1.0)

    def list_curves(self, svg):
        paths = re.findall(r'<path d="([^"]*)" fill="none" stroke="#[0-9A-F]{6}"', svg)
        return [np.array(re.findall(r"-?\d+\.?\d*", path), float) for path in paths]

    @unittest.skipUnless(find_chromium(), "chromium is not installed: pictures of pages are not compared")
    def test_pages_and_terminals(self):
        self.take([name for name, shot in pictures.SHOTS.items() if not shot.part.endswith(".svg")])


    @unittest.skipUnless(find_chromium(), "chromium is not installed: pictures of pages are not compared")
    def test_studio_and_edit(self):
        """A session that follows docs/studio.md, and the one that docs/edit.md prints."""
        self.pages.take_studio(self.folder)
        self.pages.take_edit(self.folder)
        self.compare([*pictures.STUDIO, "edit"])

    @unittest.skipUnless(HAS_NOTEBOOKS, "no Python module or matplotlib here: figures of notebooks are not compared")
    def test_notebooks(self):
        self.pages.take_notebooks(self.folder)
        self.compare(NOTEBOOKS)

    def test_every_svg_is_made_by_a_command(self):
        stored = {os.path.basename(path)[:-4] for path in glob.glob(os.path.join(SOURCE, "docs/*.svg"))}
        self.assertEqual(stored, set(pictures.FIGURES))
        for name, shot in pictures.FIGURES.items():
            self.assertIn(f"docs/{name}.svg", read(shot.page))


if __name__ == "__main__":
    unittest.main()
