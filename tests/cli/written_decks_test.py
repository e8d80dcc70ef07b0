"""export --to bdf: the written deck gives the numbers of the deck, whatever the solution: modes, complex modes, responses, rotors."""
import json
import os
import re
import shutil
import unittest

import h5py
import numpy as np

from support import SOURCE, ProgramTest

SHARED = os.environ["BOUGH_SHARED_DIR"]


def list_numbers(value, path=""):
    """(path, number) of everything in an answer of --json that is a number."""
    if isinstance(value, dict):
        return [pair for key in sorted(value) for pair in list_numbers(value[key], f"{path}/{key}")]
    if isinstance(value, list):
        return [pair for i, one in enumerate(value) for pair in list_numbers(one, f"{path}[{i}]")]
    return [(path, float(value))] if isinstance(value, (int, float)) and not isinstance(value, bool) else []


class WrittenDecks(ProgramTest):
    def export(self, deck, *more):
        """Writes the deck with free fields, which keep every bit; returns the messages."""
        return self.bough("export", deck, "--to", "bdf", "--fields", "free", "-o", "written.bdf", *more).stderr

    def compare_arrays(self, command, deck, tolerance, skip=r"^source|^program"):
        for name, output in ((deck, "first.h5"), ("written.bdf", "second.h5")):
            self.bough(command, name, "-o", output)
        found = {}
        for output in ("first.h5", "second.h5"):
            with h5py.File(self.path(output)) as f:
                arrays = {}
                f.visititems(lambda path, item: arrays.update({path: item[()]}) if isinstance(item, h5py.Dataset) else None)
                found[output] = {path: x for path, x in arrays.items() if not re.search(skip, path)}
        first, second = found.values()
        self.assertEqual(sorted(first), sorted(second))
        num_compared = 0
        for path, x in first.items():
            x, y = np.asarray(x), np.asarray(second[path])
            if x.dtype.kind not in "fc":
                continue
            self.assertEqual(x.shape, y.shape, path)
            scale = np.abs(x).max(initial=0)
            self.assertLessEqual(np.abs(x - y).max(initial=0), tolerance * scale, path)
            num_compared += x.size
        self.assertGreater(num_compared, 5)

    def compare_answers(self, command, deck, tolerance, skip):
        answers = [list_numbers(json.loads(self.bough(command, name, "--json").stdout)) for name in (deck, "written.bdf")]
        answers = [[pair for pair in answer if not re.search(skip, pair[0])] for answer in answers]
        self.assertEqual(*[[path for path, _ in answer] for answer in answers])
        self.assertGreater(len(answers[0]), 0)
        scale = {}
        for path, x in answers[0]:
            kind = re.sub(r"\[\d+\]", "", path)
            scale[kind] = max(scale.get(kind, 0), abs(x))
        for (path, x), (_, y) in zip(*answers):
            self.assertLessEqual(abs(x - y), tolerance * scale[re.sub(r"\[\d+\]", "", path)], path)

    def test_random_response(self):
        """DLOAD, RLOAD, TABLED, FREQ, RANDPS, TABRND1, RCROSS: the deck was written without its loads before."""
        self.copy_example("ex16-random")
        self.assertNotIn("deck.left-out", self.export("box.bdf"))
        self.compare_arrays("frequency", "box.bdf", 1e-9)

    def test_rotor_speeds(self):
        """ROTORG, RSPINR, RGYRO, RSPEED, EIGC, CMETHOD: Campbell diagram."""
        self.copy_example("ex14-rotor")
        self.assertNotIn("deck.left-out", self.export("speeds.bdf"))
        self.compare_answers("modes", "speeds.bdf", 1e-8, "second|time")

    def test_unbalance(self):
        """UNBALNC and INCLUDE."""
        self.copy_example("ex14-rotor")
        self.assertNotIn("deck.left-out", self.export("unbalance.bdf"))
        self.assertNotIn("INCLUDE", self.read("written.bdf").upper())
        self.compare_arrays("frequency", "unbalance.bdf", 1e-9)

    def test_component_with_its_files(self):
        """SEBULK, SECONCT, EXTRN, DTI, BEGIN SUPER and ASSIGN, from another folder."""
        self.copy_example("ex17-component")
        self.bough("export", "boom.bdf", "--to", "extseout", "-o", "boom")
        os.mkdir(self.path("other"))
        self.bough("export", "craft.bdf", "--to", "bdf", "--fields", "free", "-o", "other/craft.bdf")
        hz = [json.loads(self.bough("modes", deck, "--json").stdout)["frequency_hz"] for deck in ("craft.bdf", "other/craft.bdf")]
        np.testing.assert_allclose(hz[1], hz[0], rtol=1e-9, atol=1e-9)

    def test_own_decks(self):
        """Modes of every small deck of the project, from large fields too."""
        folder = os.path.join(SOURCE, "data/decks")
        for name in sorted(os.listdir(folder)):
            if not name.endswith(".bdf") or name == "every-card.bdf":  # its cards are in no structure
                continue
            with self.subTest(name):
                shutil.copy(os.path.join(folder, name), self.folder)
                self.export(name)
                self.compare_answers("modes", name, 1e-7, "second|time|file")

    def test_decks_of_others(self):
        """Random responses, and a component from another folder: published decks."""
        for name, command in (("random/random_test_bar_plus_tri.bdf", "frequency"), ("extseout/assemble.dat", "modes")):
            path = os.path.join(SHARED, "models", name)
            if not os.path.exists(path):
                self.skipTest(f"{path} is not there")
            with self.subTest(name):
                self.export(path)
                (self.compare_answers("modes", path, 1e-7, "second|time|file") if command == "modes"
                 else self.compare_arrays(command, path, 1e-8))

    def test_selection_that_is_not_read_is_named(self):
        """A command that no analysis here reads is in no written deck, and a note names it."""
        self.write("d.bdf", "SOL 144\nCEND\nTRIM = 1\nGUST = 3\nBEGIN BULK\nGRID,1\nENDDATA\n")
        messages = self.export("d.bdf")
        for word in ("TRIM", "GUST"):
            self.assertIn(word, messages)


if __name__ == "__main__":
    unittest.main()
