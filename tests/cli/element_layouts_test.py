"""Elements of one card with other points: groups CARD, CARD-2, CARD-3 with one order in every file; CARD alone in tables."""
import csv
import unittest

import h5py
import numpy as np

from support import ProgramTest


# Three properties: PSHELL; two PCOMP whose numbers of components are equal, by plies with a membrane, and by fewer plies.
CASES = {
    "frequency": ("SOL 108", ["DLOAD = 11", "FREQUENCY = 5"], ["FREQ,5,1.-3", "RLOAD1,11,21,,,1."],
                  ["PCOMP,2,,,,,,,MEM", ",1,.004,0.,,1,.003,45.", "PCOMP,3", ",1,.004,0."]),
    "transient": ("SOL 109", ["DLOAD = 11", "TSTEP = 5"],
                  ["TSTEP,5,4,.1", "TLOAD1,11,21,,,9", "TABLED1,9", ",0.,0.,1.,1.,5.,1.,ENDT"],
                  ["PCOMP,2", ",1,.002,0.,,1,.002,45.", ",1,.002,45.,,1,.002,0.",
                   "PCOMP,3", ",1,.004,0.,,1,.003,45.,,1,.003,45."])}


def make_deck(sol, case, bulk, layups):
    return "\n".join([sol, "CEND", "SPC = 1", *case, "STRESS(PUNCH,PRINT) = ALL", "BEGIN BULK", *bulk,
                      "FORCE,21,8,0,10.,1.,0.,0.2", "FORCE,21,4,0,10.,.5,0.3,0.2",
                      *[f"GRID,{1 + i + 4 * j},,{i}.,{j}.,0." for j in (0, 1) for i in range(4)],
                      "CQUAD4,1,3,1,2,6,5", "CQUAD4,2,1,2,3,7,6", "CQUAD4,3,2,3,4,8,7", "PSHELL,1,1,.01,1,,1",
                      "MAT1,1,7.+10,,.33,2700.", *layups, "SPC1,1,123456,1,5", "SPC1,1,345,4,8", "ENDDATA", ""])


class Layouts(ProgramTest):
    def groups(self, file, folder):
        with h5py.File(self.path(file)) as f:
            group = next(iter(f["subcases"].values()))[folder]
            return {name: (list(part["id"][()]), part.attrs["components"]) for name, part in group.items()}

    def test_response(self):
        """The groups of `static`; at 1e-3 Hz its stresses too."""
        for command, (sol, case, bulk, layups) in CASES.items():
            with self.subTest(command):
                self.write("s.bdf", make_deck("SOL 101", ["LOAD = 21"], [], layups))
                self.bough("static", "s.bdf", "-o", "s.h5")
                self.write("d.bdf", make_deck(sol, case, bulk, layups))
                self.bough(command, "d.bdf", "-o", "d.h5", "--csv", "d.csv", "--punch", "d.pch")
                expected, found = self.groups("s.h5", "stresses"), self.groups("d.h5", "stresses")
                self.assertEqual(sorted(found), ["CQUAD4", "CQUAD4-2", "CQUAD4-3"])
                self.assertEqual({name: ids for name, (ids, _) in found.items()},
                                 {name: ids for name, (ids, _) in expected.items()})
                with open(self.path("d.csv")) as f:
                    names = next(csv.reader(f))
                for element in (1, 2, 3):
                    self.assertTrue(any(name.startswith(f"CQUAD4:stress:{element}:") for name in names), names)
                self.assertNotIn("CQUAD4-", " ".join(names))
                punch = self.read("d.pch")
                self.assertIn("$ELEMENT STRESSES OF CQUAD4 ", punch)
                self.assertNotIn("CQUAD4-", punch)
                if command == "transient":
                    continue
                with h5py.File(self.path("s.h5")) as s, h5py.File(self.path("d.h5")) as d:
                    for group in found:
                        there, here = s["subcases/0/stresses/" + group], d["subcases/1/stresses/" + group]
                        columns = list(there.attrs["components"])
                        at = [columns.index(name) for name in here.attrs["components"]]
                        np.testing.assert_allclose(here["real"][0], there["stress"][:, at], rtol=1e-6,
                                                   atol=1e-6 * np.abs(there["stress"][:, at]).max())

    def test_plot(self):
        """A curve by the name of the card."""
        sol, case, bulk, layups = CASES["transient"]
        self.write("d.bdf", make_deck(sol, case, bulk, layups))
        self.bough("transient", "d.bdf", "-o", "d.h5", "--csv", "d.csv")
        with open(self.path("d.csv")) as f:
            name = next(name for name in next(csv.reader(f)) if name.startswith("CQUAD4:stress:3:"))
        self.bough("plot", "d.h5", "--sensor", name, "-o", "d.svg")


if __name__ == "__main__":
    unittest.main()
