"""Strain energies and forces on grids in listings (ESE, GPFORCE): work of the load, balance, turned axes, modes."""
import json
import re
import unittest

import h5py
import numpy as np

from support import ProgramTest

BULK = """MAT1,1,7.+10,,.3,2700.
PBAR,1,1,2.-4,3.-8,2.-8,1.-8
PROD,2,1,1.-4
CORD2R,5,,0.,0.,0.,1.,0.,1.
,1.,1.,0.
GRID,1,,0.,0.,0.
GRID,7,,1.,0.,0.,5
GRID,3,,2.,0.,.5,5
GRID,4,,1.,2.,0.
CBAR,12,1,1,7,0.,0.,1.
CBAR,11,1,7,3,0.,1.,0.
CROD,13,2,7,4
RBE2,20,3,123456,6
GRID,6,,2.,0.,1.
SPC1,1,123456,1,4
FORCE,2,6,,300.,1.,-2.,.5
FORCE,2,7,,100.,0.,0.,1.
EIGRL,3,,,2
ENDDATA
"""


class EnergyListing(ProgramTest):
    def read(self, head, verb, *extra):
        self.write("d.bdf", head + "BEGIN BULK\n" + BULK)
        self.said = self.bough(verb, "d.bdf", "-o", "d.h5", "--f06", "d.f06", *extra)
        with open(self.path("d.f06")) as f:
            self.pages = re.split(r"^1 ", f.read(), flags=re.M)[1:]
        for line in "\n".join(self.pages).splitlines():
            self.assertLessEqual(len(line), 132)

    def read_energies(self):
        """A dictionary a table: {type: ({element: (energy, %)}, subtotal, total)}."""
        tables = []
        for page in self.pages:
            if "E L E M E N T   S T R A I N   E N E R G I E S" not in page:
                continue
            kind, total = re.search(r"ELEMENT-TYPE = (\w+) +\* TOTAL .* = +(\S+)", page).groups()
            rows = {int(e): (float(v), float(p)) for e, v, p in re.findall(r"^ +(\d+) +(\S+) +(\S+)$", page, re.M)}
            subtotal = re.search(rf"TYPE = {kind} +SUBTOTAL +(\S+) +(\S+)", page).groups()
            if not tables or kind in tables[-1]:
                tables.append({})
            tables[-1][kind] = rows, tuple(map(float, subtotal)), float(total)
        return tables

    def test_static(self):
        self.read("SOL 101\nCEND\nSPC = 1\nLOAD = 2\nESE = ALL\nGPFORCE = ALL\n", "static")
        with h5py.File(self.path("d.h5")) as f:
            u, dofs = f["subcases/0/displacement"][:], f["dof_map"][:]
        at = {(int(n), int(c)): u[i] for i, (n, c) in enumerate(dofs)}
        unit = 300 * np.array([1, -2, .5])
        work = .5 * (sum(unit[c] * at[6, c + 1] for c in range(3)) + 100 * at[7, 3])
        (table,) = self.read_energies()
        self.assertEqual({kind: sorted(rows) for kind, (rows, _, _) in table.items()}, {"BAR": [11, 12], "ROD": [13]})
        self.assertEqual(list(table["BAR"][0]), [11, 12])
        np.testing.assert_allclose(sum(v for rows, _, _ in table.values() for v, _ in rows.values()), work, rtol=2e-6)
        for rows, (energy, percent), total in table.values():
            np.testing.assert_allclose(total, work, rtol=2e-6)
            np.testing.assert_allclose(energy, sum(v for v, _ in rows.values()), rtol=2e-6)
            np.testing.assert_allclose(percent, 100 * energy / work, atol=1e-4)
            for v, p in rows.values():
                np.testing.assert_allclose(p, 100 * v / work, atol=1e-4)

    def test_grid_forces(self):
        """Against --grid-forces in the grids' own axes; what is not asked for stays out of the other outputs."""
        asked = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nSET 4 = 1, 3 THRU 7\nGPFORCE = 4\n"
        self.read(asked, "static", "--json", "--grid-forces", "3")
        three = json.loads(self.said.stdout)["subcases"][0]["grid_forces"]
        self.assertEqual({f["grid"] for f in three}, {3})
        self.read(asked, "static", "--json", "--grid-forces", "all")
        expected = json.loads(self.said.stdout)["subcases"][0]["grid_forces"]
        z = np.array([1, 0, 1]) / np.sqrt(2)
        y = np.cross(z, [1, 1, 0])
        y /= np.linalg.norm(y)
        turn = np.array([np.cross(y, z), y, z])
        found, totals = {}, {}
        for page in self.pages:
            if "F O R C E   B A L A N C E" in page:
                for grid, element, source, numbers in re.findall(
                        r"^ +(\d+) {4} {0,10}(\d*) +(\S+) ((?: +\S+){6}) *$", page, re.M):
                    values = np.array(numbers.split(), float)
                    if source == "*TOTALS*":
                        totals[int(grid)] = values
                    else:
                        found[int(grid), source, int(element or 0)] = values
        names = {"LOAD": "APP-LOAD", "SPC": "F-OF-SPC", "MPC": "F-OF-MPC", "CBAR": "BAR", "CROD": "ROD"}
        self.assertEqual(set(found), {(f["grid"], names[f["source"]], f["element"]) for f in expected})
        for f in expected:
            force = np.array(f["force"])
            if f["grid"] in (3, 7):
                force = np.concatenate([turn @ force[:3], turn @ force[3:]])
            np.testing.assert_allclose(found[f["grid"], names[f["source"]], f["element"]], force,
                                       rtol=2e-6, atol=2e-7 * np.abs(force).max())
        self.assertEqual(list(totals), [1, 3, 4, 6, 7])
        for total in totals.values():
            self.assertLess(np.abs(total).max(), 1e-6)
        self.read(asked, "static", "--json")
        self.assertFalse(json.loads(self.said.stdout)["subcases"][0].get("grid_forces"))

    def test_modes(self):
        self.read("SOL 103\nCEND\nSPC = 1\nMETHOD = 3\nSET 9 = 11, 13\nESE = 9\n", "modes")
        tables = self.read_energies()
        with h5py.File(self.path("d.h5")) as f:
            half = .5 * (2 * np.pi * f["modes/frequency_hz"][:])**2
        self.assertEqual(len(tables), 2)
        for table, expected in zip(tables, half):
            self.assertEqual([list(rows) for rows, _, _ in table.values()], [[11], [13]])
            for _, _, total in table.values():
                np.testing.assert_allclose(total, expected, rtol=2e-6)  # mass 1
        self.read("SOL 103\nCEND\nSPC = 1\nMETHOD = 3\nESE = ALL\n", "modes")
        for table in self.read_energies():
            np.testing.assert_allclose(sum(p for _, (_, p), _ in table.values()), 100, atol=3e-4)

    def test_who_gives_it(self):
        self.write("d.bdf", "SOL 103\nCEND\nSPC = 1\nLOAD = 2\nMETHOD = 3\nESE = ALL\nGPFORCE = ALL\nBEGIN BULK\n" + BULK)
        said = self.bough("modes", "d.bdf").stderr
        self.assertIn("--f06 FILE, or --ese", said)
        self.assertNotIn("cli.request-by-option", self.bough("modes", "d.bdf", "--ese").stderr)
        said = self.bough("static", "d.bdf").stderr
        self.assertIn("--f06 FILE, or --grid-forces all", said)
        self.assertIn("--f06 FILE, or -o FILE.h5", said)
        self.assertNotIn("cli.request-by-option", self.bough("static", "d.bdf", "--f06", "x.f06").stderr)


if __name__ == "__main__":
    unittest.main()
