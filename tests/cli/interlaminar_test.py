"""Shear stresses between plies: closed forms, equilibrium of the plies' own stresses, other axes, failure of the bond."""
import math
import struct
import unittest

import h5py
import numpy as np

from op2_reader import Op2
from support import ProgramTest

V, WIDTH, LENGTH, ELEMENTS = 40.0, 0.5, 2.0, 8
HEAD = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nSTRESS = ALL\nBEGIN BULK\n"


class Interlaminar(ProgramTest):
    def solve(self, cards, card="CQUAD4", theta="", spare=""):
        """A strip along x, held at x = 0, with V across at its end; one element wide."""
        text, quadratic = HEAD, card == "CQUAD8"
        columns = 2 * ELEMENTS + 1 if quadratic else ELEMENTS + 1
        rows = 3 if quadratic else 2
        grid = {}
        for i in range(columns):
            for j in range(rows):
                if quadratic and i % 2 == 1 and j == 1:
                    continue
                grid[i, j] = len(grid) + 1
                text += f"GRID,{grid[i, j]},,{LENGTH * i / (columns - 1):.12g},{WIDTH * j / (rows - 1):.12g},0.\n"
        for e in range(ELEMENTS):
            if quadratic:
                i = 2 * e
                corners = [grid[i, 0], grid[i + 2, 0], grid[i + 2, 2], grid[i, 2]]
                sides = [grid[i + 1, 0], grid[i + 2, 1], grid[i + 1, 2], grid[i, 1]]
                text += f"CQUAD8,{e + 1},1," + ",".join(map(str, corners + sides[:2])) + "\n," + ",".join(map(str, sides[2:])) + f",,,,,{theta}\n"
            else:
                corners = [grid[e, 0], grid[e + 1, 0], grid[e + 1, 1], grid[e, 1]]
                text += f"{card},{e + 1},1," + ",".join(map(str, corners)) + f",{theta}\n"
        at_end = [grid[columns - 1, j] for j in range(rows)]
        shares = [1 / 6, 4 / 6, 1 / 6] if quadratic else [.5, .5]
        text += "".join(f"FORCE,2,{g},,{V * s:.12g},0.,0.,1.\n" for g, s in zip(at_end, shares))
        text += "".join(f"SPC1,1,123456,{grid[0, j]}\n" for j in range(rows)) + cards + spare + "ENDDATA\n"
        self.write("d.bdf", text)
        self.bough("static", "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06")
        with h5py.File(self.path("d.h5")) as f:
            block = f["subcases/1/stresses/" + card] if "1" in f["subcases"] else f["subcases/0/stresses/" + card]
            names = [n.decode() if isinstance(n, bytes) else n for n in block.attrs["components"]]
            values = dict(zip(names, block["stress"][:].T))
            force = f[block.parent.parent.name + "/elements/" + card]
            names = [n.decode() if isinstance(n, bytes) else n for n in force.attrs["components"]]
            table = force["force"][:]
        self.Q = {q: np.mean([table[:, i] for i, n in enumerate(names) if n.split("@")[0] == q], axis=0) for q in ("Qx", "Qy")}
        return values

    def test_one_material_is_a_parabola(self):
        """Eight plies of one material: 3 V / 2 h (1 - 4 z^2 / h^2), of which V is the force per width."""
        h, n = 0.02, 8
        for card in ("CQUAD4", "CQUAD8"):
            stress = self.solve("MAT1,1,7.+10,,0.\nPCOMP,1\n" + "".join(f",1,{h / n},{a}.,YES\n" for a in (0, 90, 30, 0, 45, 0, 90, 0)), card)
            for k in range(1, n):
                z = h * (k / n - .5)
                expected = 1.5 * V / WIDTH / h * (1 - 4 * z * z / h**2)
                np.testing.assert_allclose(stress[f"xz@bond{k}"], expected, rtol=1e-7)
                np.testing.assert_allclose(stress[f"yz@bond{k}"], 0, atol=1e-7 * expected)
            self.assertNotIn(f"xz@bond{n}", stress)

    CROSS = "MAT8,2,1.4+11,1.+10,0.,5.+9,5.+9,3.+9,1600.\n"

    def test_cross_ply(self):
        """0/90/0: V Sum E S / Sum E I on both bonds, and the plies' own stresses in equilibrium along x."""
        E1, E2, thickness = 1.4e11, 1e10, [1e-3, 2e-3, 1e-3]
        stress = self.solve(self.CROSS + "PCOMP,1\n,2,1.-3,0.,YES,2,2.-3,90.,YES\n,2,1.-3,0.,YES\n")
        EI = E1 * (.004**3 - .002**3) / 12 + E2 * .002**3 / 12
        expected = V / WIDTH * E1 * .001 * .0015 / EI
        for k in (1, 2):
            np.testing.assert_allclose(stress[f"xz@bond{k}"], expected, rtol=1e-7)
        # Neighbouring stations: d/dx of the force in the plies below is the stress above them minus that below ply 0.
        step = LENGTH / ELEMENTS
        ply = [stress["11@ply1"], stress["22@ply2"], stress["11@ply3"]]
        below = np.cumsum([s * t for s, t in zip(ply, thickness)], axis=0)
        for k in (0, 1):
            np.testing.assert_allclose(-np.diff(below[k]) / step, expected, rtol=1e-6)
        np.testing.assert_allclose(np.diff(below[2]) / step, 0, atol=1e-6 * expected)

    def test_unsymmetric(self):
        """90/0/0 bends about another place than its middle; the force across it is what hangs at its end."""
        E = np.array([1e10, 1.4e11, 1.4e11])
        z = np.array([0, 2e-3, 3e-3, 4e-3])
        middle, t = (z[1:] + z[:-1]) / 2, np.diff(z)
        neutral = (E * t * middle).sum() / (E * t).sum()
        EI = (E * ((z[1:] - neutral)**3 - (z[:-1] - neutral)**3) / 3).sum()
        ES = -np.cumsum(E * t * (middle - neutral))
        for card, z0 in (("CQUAD8", ""), ("CQUAD8", "0."), ("CQUAD4", ""), ("CQUAD4", "0."), ("CQUADR", "0.")):
            stress = self.solve(self.CROSS + f"PCOMP,1,{z0}\n,2,2.-3,90.,YES,2,1.-3,0.,YES\n,2,1.-3,0.,YES\n", card)
            np.testing.assert_allclose(self.Q["Qx"], V / WIDTH, rtol=1e-7, err_msg=card + z0)
            for k in (1, 2):
                np.testing.assert_allclose(stress[f"xz@bond{k}"], V / WIDTH * ES[k - 1] / EI, rtol=1e-7)

    def test_axes_of_the_laminate(self):
        """With THETA the two stand in the laminate's axes, whatever the plies' angles."""
        h = 0.006
        plies = "MAT1,1,7.+10,,0.\nPCOMP,1\n" + "".join(f",1,{h / 3},{a}.,YES\n" for a in (0, 50, 0))
        for degrees in (90, 30, -40):
            stress = self.solve(plies, theta=f"{degrees}.")
            a, size = math.radians(degrees), 1.5 * V / WIDTH / h * (1 - 1 / 9)
            np.testing.assert_allclose(stress["xz@bond1"], size * math.cos(a), rtol=1e-7, atol=1e-7 * size)
            np.testing.assert_allclose(stress["yz@bond1"], -size * math.sin(a), rtol=1e-7, atol=1e-7 * size)

    def test_listing_and_bond(self):
        """The shear above each ply, none above the last; the index of the bond is the larger one over SB."""
        h, limit = 0.006, 1e5
        strength = "MAT8,1,7.+10,7.+10,0.,3.5+10,3.5+10,3.5+10,2700.\n,,,,1.+12,1.+12,1.+12,1.+12,1.+12\n"
        stress = self.solve(strength + f"PCOMP,1,,,{limit},TSAI\n" + "".join(f",1,{h / 3},0.,YES\n" for _ in range(3)), theta="30.")
        size = 1.5 * V / WIDTH / h * (1 - 1 / 9)
        expected = size * math.cos(math.radians(30)) / limit
        for k in (1, 2):
            np.testing.assert_allclose(stress[f"failure@bond{k}"], expected, rtol=1e-7)
        np.testing.assert_allclose(stress["failure"], np.maximum(expected, stress["failure@ply3"]), rtol=1e-7)
        self.assertTrue((stress["failure@ply3"] < expected).all())
        ((ident, data),) = Op2(self.path("d.op2")).tables["OES1C"]
        self.assertEqual(ident[0][9], 11)
        rows = [struct.unpack_from("<2i9f", data, 44 * k) for k in range(len(data) // 44)]
        self.assertEqual([r[1] for r in rows[:3]], [1, 2, 3])
        for r in rows:
            shear = [0, 0] if r[1] == 3 else [size * math.cos(math.radians(30)), -size * math.sin(math.radians(30))]
            np.testing.assert_allclose(r[5:7], shear, rtol=1e-5, atol=1e-6 * size)
        with open(self.path("d.f06")) as f:
            lines = f.read().splitlines()
        at = next(i for i, line in enumerate(lines) if "SHEAR XZ-MAT" in line)
        printed = lines[at + 1].split()
        self.assertEqual(printed[:3], ["0", "1", "1"])
        np.testing.assert_allclose([float(v) for v in printed[6:8]], rows[0][5:7], rtol=1e-5)
        self.assertLessEqual(max(map(len, lines)), 132)

    def test_no_bending_no_bond(self):
        stress = self.solve("MAT1,1,7.+10,,0.\nPCOMP,1,,,,,,,MEM\n,1,.002,0.,YES,1,.002,0.,YES\n",
                            spare="SPC1,1,3456,1,THRU,18\n")
        self.assertFalse([name for name in stress if "bond" in name])


if __name__ == "__main__":
    unittest.main()
