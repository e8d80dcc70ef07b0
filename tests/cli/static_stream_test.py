"""static of more subcases than are solved together: each goes to the file, the tables and the extremes as it comes."""
import json
import os
import unittest

import h5py
import numpy as np

from support import ProgramTest

GRIDS = 24  # along an edge: 32 subcases have enough numbers for a thread of their own
CASES = 70


def make_plate():
    """A plate clamped at an edge; a force each on the grids of the opposite one, SUBCOM of two behind them."""
    number = lambda i, j: 1 + i + GRIDS * j
    cases = "".join(f"SUBCASE {k}\n  LOAD = {k}\n" for k in range(1, CASES + 1))
    lines = ["SOL 101\nCEND\nSPC = 1\n" + cases + "BEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPSHELL,1,1,.01,1,,1\n"]
    for j in range(GRIDS):
        for i in range(GRIDS):
            lines.append(f"GRID,{number(i, j)},,{i * .05:.3f},{j * .05:.3f},0.\n")
    for j in range(GRIDS - 1):
        for i in range(GRIDS - 1):
            corners = (number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1))
            lines.append(f"CQUAD4,{number(i, j)},1," + ",".join(map(str, corners)) + "\n")
    lines.append("".join(f"SPC1,1,123456,{number(0, j)}\n" for j in range(GRIDS)))
    for k in range(1, CASES + 1):
        lines.append(f"FORCE,{k},{number(GRIDS - 1, k % GRIDS)},,{k}.,.1,.2,1.\n")
    return "".join(lines) + "ENDDATA\n"


class Stream(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("plate.bdf", make_plate())

    def read(self, name):
        with h5py.File(self.path(name)) as f:
            values = {}
            f.visititems(lambda path, item: values.update({path: item[()]}) if isinstance(item, h5py.Dataset) else None)
        return values

    def test_threads_and_groups_change_no_number(self):
        one = self.bough("static", "plate.bdf", "-o", "one.h5", "--extremes", env={"OMP_NUM_THREADS": "1"}).stdout
        two = self.bough("static", "plate.bdf", "-o", "two.h5", "--extremes", env={"OMP_NUM_THREADS": "2"}).stdout
        self.assertEqual(one.replace("one.h5", "two.h5"), two)
        self.assertEqual([line.split()[1].rstrip(":") for line in two.splitlines() if line.startswith("subcase ")],
                         [str(k) for k in range(1, CASES + 1)])
        first, second = self.read("one.h5"), self.read("two.h5")
        self.assertEqual(first.keys(), second.keys())
        for path, values in first.items():
            np.testing.assert_array_equal(values, second[path], err_msg=path)
        self.bough("static", "plate.bdf", "-o", "alone.h5", "--subcase", 67)
        alone = self.read("alone.h5")
        # An energy is uᵀKu of a motion that is nearly rigid: it loses digits that the displacement has.
        for path, digits in (("displacement", 1e-12), ("reaction", 1e-9), ("stresses/CQUAD4/stress", 1e-9),
                             ("elements/CQUAD4/strain_energy", 1e-9)):
            values = alone[f"subcases/67/{path}"]
            np.testing.assert_allclose(second[f"subcases/67/{path}"], values, rtol=0, atol=digits * np.abs(values).max(),
                                       err_msg=path)
        largest = max(second[f"subcases/{k}/displacement"][2::6].max() for k in range(1, CASES + 1))
        self.assertEqual(second["extremes/displacement/max"][:, 2].max(), largest)

    def test_sums_see_subcases_of_every_group(self):
        deck = make_plate().replace("BEGIN BULK", "SUBCOM 100\n  SUBSEQ = " + ",".join(["1."] + ["0."] * (CASES - 2) + ["2."])
                                    + "\nBEGIN BULK", 1)
        self.write("sum.bdf", deck)
        self.bough("static", "sum.bdf", "-o", "sum.h5", "--vtu", "sum.vtu")
        values = self.read("sum.h5")
        np.testing.assert_allclose(
            values["subcases/100/displacement"],
            values["subcases/1/displacement"] + 2 * values[f"subcases/{CASES}/displacement"], rtol=1e-12, atol=1e-18)
        with open(self.path("sum.vtu")) as f:
            text = f.read()
        for k in (1, 40, CASES, 100):
            self.assertIn(f"subcase_{k:03d}_displacement", text)

    def test_json_has_all_in_their_order(self):
        data = json.loads(self.bough("static", "plate.bdf", "--json", "--cd", "--extremes").stdout)
        self.assertEqual([s["id"] for s in data["subcases"]], list(range(1, CASES + 1)))
        self.assertIn("max", data["extremes"]["displacement"]["z"])

    def test_a_full_disk_ends_the_work_and_leaves_no_file(self):
        limit = 2_000_000  # of the 9 MB: the second group at the latest does not fit
        result = self.bough("static", "plate.bdf", "-o", "s.h5", code=3,
                            launcher=("/bin/sh", "-c", f'ulimit -f {limit // 512}; trap "" XFSZ; exec "$@"', "sh"))
        self.assertIn("[hdf5.write]", result.stderr)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("s.h5")], [])


if __name__ == "__main__":
    unittest.main()
