"""Forces and stresses of elements over frequency and time in listings (--f06) and OUTPUT2 files (--op2)."""
import re
import struct
import unittest

import h5py
import numpy as np

from op2_reader import Op2
from support import ProgramTest
from decks import grids

# Every element that has tables, each held by itself, all loaded by set 2.
ELEMENTS = """MAT1,1,7.+10,,.3
GRID,1,,0.,0.,0.
GRID,2,,2.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
PBAR,1,1,1.-3,4.-8,9.-8,1.-8
,.002,.003,-.002,.001
FORCE,2,2,,1.,500.,10.,-7.
MOMENT,2,2,,3.,1.,0.,0.
GRID,11,,0.,1.,0.
GRID,12,,2.,1.,0.
CBEAM,11,11,11,12,0.,1.,0.
PBEAM,11,1,1.-3,4.-8,9.-8,,1.-8
,.002,0.,-.002,0.,.001,.001
FORCE,2,12,,1.,50.,10.,20.
GRID,21,,0.,2.,0.
GRID,22,,2.,2.,0.
CROD,21,21,21,22
PROD,21,1,1.-3,2.-8,.01
FORCE,2,22,,7.,1.,0.,0.
MOMENT,2,22,,2.,1.,0.,0.
SPC1,1,2356,22
GRID,31,,0.,3.,0.
GRID,32,,1.,3.,0.
CELAS2,31,1000.,31,1,32,1
CBUSH,32,32,31,32,,,,0
PBUSH,32,K,100.,100.,100.,10.,10.,10.
FORCE,2,32,,4.,1.,.5,.25
""" + grids((0, 4, 0), (1, 4, 0), (1.2, 5, 0), (0, 5, 0), first=41) + """CQUAD4,41,41,41,42,43,44
PSHELL,41,1,.01,1,,1
FORCE,2,42,,30.,1.,.2,.3
FORCE,2,43,,20.,.1,1.,-.4
GRID,51,,0.,6.,0.
GRID,52,,1.,6.,0.
GRID,53,,0.,7.,0.
CTRIA3,51,41,51,52,53
FORCE,2,52,,30.,1.,.2,.3
""" + grids((0, 8, 0), (1, 8, 0), (1, 9, 0), (0, 9, 0), first=61) + """CQUAD4,61,61,61,62,63,64
PCOMP,61
,1,.002,0.,YES,1,.003,30.,YES
,1,.002,90.,YES
FORCE,2,62,,30.,1.,.2,.3
FORCE,2,63,,20.,.1,1.,-.4
""" + grids(
    (0, 0, 9), (1, 0, 9), (1, 1, 9), (0, 1, 9), (0, 0, 10), (1, 0, 10), (1, 1, 10), (0, 1, 10), first=71) + """CHEXA,71,71,71,72,73,74,75,76
,77,78
PSOLID,71,1
FORCE,2,77,,300.,1.,.2,.3
FORCE,2,75,,200.,.1,1.,-.4
SPC1,1,123456,1,11,21,31,41,44
SPC1,1,123456,51,53,61,64
SPC1,1,123,71,72,73,74
SPC1,1,456,71,THRU,78
"""
KINDS = {1: 34, 11: 2, 21: 1, 31: 12, 32: 102, 41: 33, 51: 74, 61: 95, 71: 67}


def read_stresses(op2):
    """(type, element) -> list of words after the id (and ply, corner) of each record."""
    found = {}
    for _, words, data in op2.list_stresses():
        kind, wide = words[2], words[9]
        assert words[1] == 1005 and words[8] in (2, 3) and words[0] // 10 == 5
        for at in range(0, len(data), 4 * wide):
            element = struct.unpack_from("<i", data, at)[0] // 10
            if kind == 2:
                assert wide == 111
                rows = [struct.unpack_from("<i9f", data, at + 4 + 40 * k) for k in (0, 10)]
                assert [r[0] for r in rows] == [11, 12] and [r[1] for r in rows] == [0, 1]
                row = [np.array(r[2:6]) + 1j * np.array(r[6:]) for r in rows]
            elif kind in (39, 67, 68):
                corners = struct.unpack_from("<i4si", data, at + 4)[2]
                assert wide == 4 + 13 * (corners + 1)
                rows = [struct.unpack_from("<i12f", data, at + 16 + 52 * k) for k in range(corners + 1)]
                row = {r[0]: np.array(r[1:7]) + 1j * np.array(r[7:]) for r in rows}
            elif kind in (95, 97):
                assert wide == 12
                r = struct.unpack_from("<i10f", data, at + 4)
                found.setdefault((kind, element), []).append(np.array(r[1:6]) + 1j * np.array(r[6:]))
                continue
            else:
                row = np.array(struct.unpack_from(f"<{wide - 1}f", data, at + 4))
            found[kind, element] = row
    return found


def read_static_stresses(op2):
    """The linear columns of `static`, in the same shape."""
    found = {}
    for table in ("OES1", "OES1C"):
        for ident, data in op2.tables[table]:
            kind, wide = ident[0][2], ident[0][9]
            for at in range(0, len(data), 4 * wide):
                key = (kind, struct.unpack_from("<i", data, at)[0] // 10)
                if kind == 2:
                    found[key] = [np.array(struct.unpack_from("<i9f", data, at + 4 + 40 * k)[2:6]) for k in (0, 10)]
                elif kind == 67:
                    found[key] = {}
                    for k in range(9):
                        r = struct.unpack_from("<i20f", data, at + 16 + 84 * k)
                        found[key][r[0]] = np.array(r[1:])[[0, 8, 14, 1, 9, 15]]
                elif kind in (95, 97):
                    found.setdefault(key, []).append(np.array(struct.unpack_from("<i9f", data, at + 4)[1:6]))
                else:
                    found[key] = np.array(struct.unpack_from(f"<{wide - 1}f", data, at + 4))
    return found


class ResponseListing(ProgramTest):
    def compare(self, found, expected):
        size = np.abs(expected).max()
        np.testing.assert_allclose(found, expected, rtol=2e-6, atol=1e-6 * size)

    def solve_static(self):
        self.write("s.bdf", "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nDISP = ALL\nFORCE = ALL\nSTRESS = ALL\nBEGIN BULK\n" + ELEMENTS +
                   "ENDDATA\n")
        self.bough("static", "s.bdf", "--op2", "s.op2")
        return Op2(self.path("s.op2"))

    def solve_frequency(self, phase=""):
        """The static load with a phase of 30 degrees, on a structure without mass but for some of its points."""
        self.write("d.bdf", f"SOL 108\nCEND\nSPC = 1\nDLOAD = 5\nFREQ = 6\nDISP{phase} = ALL\nFORCE{phase} = ALL\n"
                   f"STRESS{phase} = ALL\nBEGIN BULK\n" + ELEMENTS + "CONM2,901,2,,1.\nRLOAD1,5,2,,30.,8\nTABLED1,8\n,0.,1.,10.,1.,ENDT\n"
                   "FREQ,6,1.-6\nENDDATA\n")
        said = self.bough("frequency", "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06").stderr
        self.assertEqual(said.count("cli.unlisted-elements"), 1)  # forces of CHEXA: there is no such table
        self.assertIn("forces of CHEXA", said)
        with open(self.path("d.f06")) as f:
            self.f06 = f.read()
        for line in self.f06.splitlines():
            self.assertLessEqual(len(line), 132, line)
        return Op2(self.path("d.op2"))

    def test_forces_turn_with_their_load(self):
        """Next to 0 Hz every force is that of `static` (tried by closed forms in listing_test) times exp(i 30 deg)."""
        static = {(kind, e): np.array(v) for _, kind, _, _, rows in self.solve_static().elements("OEF1", 4)
                  for e, v in rows.items()}
        turn = np.exp(1j * np.radians(30))
        op2 = self.solve_frequency()
        self.assertEqual([r.ident[0][8] for r in op2.tables["OEF1"]], [2] * len(op2.tables["OEF1"]))
        found = {(kind, e): np.array(v) for approach, kind, _, _, rows in op2.elements("OEF1", 4) for e, v in rows.items()
                 if approach == 5}
        self.assertEqual(set(found), set(static))
        self.assertEqual({e: k for k, e in found}, {e: 33 if e == 61 else k for e, k in KINDS.items() if e != 71})
        for (kind, element), values in static.items():
            row = found[kind, element]
            if kind == 2:
                row, values = np.reshape(row, (11, 16)), np.reshape(values, (11, 9))
                np.testing.assert_array_equal(row[[0, 10], :2], [[11, 0], [12, 1]])
                self.assertFalse(row[1:10].any())
                row, values = row[[0, 10], 2:9] + 1j * row[[0, 10], 9:], values[[0, 10], 2:]
            else:
                half = len(row) // 2
                row = row[:half] + 1j * row[half:]
            self.compare(row, turn * values)

    def test_stresses_turn_with_their_load(self):
        static, turn = read_static_stresses(self.solve_static()), np.exp(1j * np.radians(30))
        found = read_stresses(self.solve_frequency())
        self.assertEqual(set(found), {(k, e) for e, k in KINDS.items() if e not in (31, 32)})
        bar, expected = found[34, 1], static[34, 1]
        self.compare(np.r_[bar[:5] + 1j * bar[5:10], bar[10:14] + 1j * bar[14:]], turn * expected[[0, 1, 2, 3, 4, 8, 9, 10, 11]])
        for end in (0, 1):
            self.compare(found[2, 11][end], turn * static[2, 11][end])
        rod = found[1, 21]
        self.compare(rod[::2] + 1j * rod[1::2], turn * static[1, 21][[0, 2]])
        for key in [(33, 41), (74, 51)]:
            row, expected = found[key], static[key]
            np.testing.assert_allclose(row[[0, 7]], [-.005, .005], rtol=1e-6)
            stress = np.delete(row, [0, 7])
            self.compare(stress[::2] + 1j * stress[1::2], turn * expected[[1, 2, 3, 9, 10, 11]])
        for ply in range(3):
            self.compare(found[95, 61][ply], turn * static[95, 61][ply])
        self.assertEqual(set(found[67, 71]), {0, *range(71, 79)})
        for grid, row in found[67, 71].items():
            self.compare(row, turn * static[67, 71][grid])

    def test_magnitude_and_phase(self):
        plain, polar = self.solve_frequency(), None
        text = self.f06
        polar = self.solve_frequency("(PHASE)")
        for (_, kind, _, _, first), (_, other, _, _, second) in zip(plain.elements("OEF1", 4), polar.elements("OEF1", 4)):
            self.assertEqual(kind, other)
            if kind == 2:
                continue
            for element, row in first.items():
                half = len(row) // 2
                size, angle = np.array(second[element][:half]), np.radians(second[element][half:])
                self.assertTrue(((angle >= 0) & (angle < 2 * np.pi)).all())
                z = np.array(row[:half]) + 1j * np.array(row[half:])
                np.testing.assert_allclose(size * np.exp(1j * angle), z, atol=1e-6 * np.abs(z).max())
        row = read_stresses(polar)[33, 41]
        np.testing.assert_allclose(row[[0, 7]], [-.005, .005], rtol=1e-6)  # distances stay
        self.assertIn("(MAGNITUDE/PHASE)", self.f06)
        self.assertNotIn("(MAGNITUDE/PHASE)", text)

    def test_same_in_f06(self):
        op2 = self.solve_frequency()
        lines = self.f06.splitlines()
        flat = [line.replace(" ", "") for line in lines]
        at = flat.index("COMPLEXFORCESINBARELEMENTS(CBAR)")
        self.assertEqual(flat[at + 1], "(REAL/IMAGINARY)")
        numbers = [[float(n) for n in re.findall(r"[-+]?\d+\.\d*(?:E[-+]\d+)?", line)] for line in lines[at + 4:at + 6]]
        ((bar,),) = [[rows[1]] for _, kind, _, _, rows in op2.elements("OEF1", 4) if kind == 34]
        np.testing.assert_allclose(np.ravel(numbers), bar, rtol=1e-5, atol=1e-6)
        for table in ("FORCESINBEAMELEMENTS(CBEAM)", "FORCESINRODELEMENTS(CROD)", "FORCESINSCALARSPRINGS(CELAS2)",
                      "FORCESINBUSHELEMENTS(CBUSH)", "FORCESINQUADRILATERALELEMENTS(QUAD4)",
                      "FORCESINTRIANGULARELEMENTS(TRIA3)", "STRESSESINBARELEMENTS(CBAR)",
                      "STRESSESINBEAMELEMENTS(CBEAM)", "STRESSESINRODELEMENTS(CROD)",
                      "STRESSESINQUADRILATERALELEMENTS(QUAD4)", "STRESSESINLAYEREDCOMPOSITEELEMENTS(QUAD4)",
                      "STRESSESINHEXAHEDRONSOLIDELEMENTS(HEXA)"):
            self.assertIn("COMPLEX" + table, flat)
        # The ply table: 5 real numbers above 5 imaginary ones.
        at = flat.index("COMPLEXSTRESSESINLAYEREDCOMPOSITEELEMENTS(QUAD4)")
        plies = read_stresses(op2)[95, 61]
        for ply in range(3):
            parts = [[float(n) for n in re.findall(r"[-+]?\d+\.\d*(?:E[-+]\d+)?", line)]
                     for line in lines[at + 4 + 2 * ply:at + 6 + 2 * ply]]
            self.compare(np.array(parts[0]) + 1j * np.array(parts[1]), plies[ply])

    def test_over_time(self):
        """Forces and stresses of a bar from the motion of its tip, by its stiffness; margins as `static` has them."""
        self.write("t.bdf", "SOL 112\nCEND\nTITLE = shaken\nSPC = 1\nMETHOD = 3\nDLOAD = 5\nTSTEP = 6\nDISP = ALL\nFORCE = ALL\n"
                   "STRESS = ALL\nBEGIN BULK\nEIGRL,3,,,3\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\n"
                   "PBAR,1,1,1.-3,4.-8,9.-8,1.-8\n,.002,.003,-.002,.001\nMAT1,1,7.+10,,.3\n,300.+6,200.+6\nCONM2,9,2,,1.\n"
                   "SPC1,1,123456,1\nFORCE,2,2,,1.,500.,10.,-7.\nTLOAD1,5,2,,,8\nTABLED1,8\n,0.,1.,10.,1.,ENDT\n"
                   "TSTEP,6,20,.005\nENDDATA\n")
        self.bough("transient", "t.bdf", "-o", "t.h5", "--op2", "t.op2", "--f06", "t.f06")
        with h5py.File(self.path("t.h5")) as f:
            d = f["subcases/1/displacement"]
            u = d["value"][:][:, [i for i, g in enumerate(d["dofs"][:, 0]) if g == 2]]
            time = f["subcases/1/time"][:]
        op2, E, A, I1, I2, L = Op2(self.path("t.op2")), 7e10, 1e-3, 4e-8, 9e-8, 2.0
        records = op2.elements("OEF1", 4)
        self.assertEqual(len(records), len(time))
        stresses = [struct.unpack("<15f", data[4:64]) for ident, data in op2.tables["OES1"]]
        for k, (approach, kind, subcase, _, rows) in enumerate(records):
            self.assertEqual((approach, kind, subcase), (6, 34, 1))
            np.testing.assert_allclose(op2.real(op2.tables["OEF1"][k].ident, 5), time[k], rtol=1e-6)
            # No moment at the tip (its inertia is none): a cantilever with forces at its end, V = 3 E I u / L^3.
            N, V1, V2 = E * A / L * u[k, 0], 3 * E * I1 / L**3 * u[k, 1], 3 * E * I2 / L**3 * u[k, 2]
            expected = np.array([V1 * L, V2 * L, 0, 0, V1, V2, N, 0])
            np.testing.assert_allclose(rows[1], expected, rtol=1e-5, atol=2e-6 * max(1, abs(expected).max()))
            bend = np.array([-y * V1 * L / I1 - z * V2 * L / I2 for y, z in ((.002, .003), (-.002, .001), (0, 0), (0, 0))])
            np.testing.assert_allclose(stresses[k][:5], [*bend, N / A], rtol=1e-5, atol=1e-5 * max(1, abs(bend).max()))
            high = max(bend.max(), 0) + N / A
            if high > 1e3:
                np.testing.assert_allclose(stresses[k][7], 300e6 / high - 1, rtol=1e-4)
        with open(self.path("t.f06")) as f:
            text = f.read()
        self.assertEqual(text.count("F O R C E S   I N   B A R   E L E M E N T S"), len(time))
        self.assertNotIn("C O M P L E X", text)

    def test_print_and_plot(self):
        text = ("SOL 108\nCEND\nSPC = 1\nDLOAD = 5\nFREQ = 6\nDISP(PLOT) = ALL\nSET 3 = 1, 21\nFORCE = 3\nSTRESS(PUNCH) = 3\nBEGIN BULK\n" +
                ELEMENTS + "CONM2,901,2,,1.\nRLOAD1,5,2,,,8\nTABLED1,8\n,0.,1.,10.,1.,ENDT\nFREQ,6,1.-6\nENDDATA\n")
        self.write("d.bdf", text)
        self.bough("frequency", "d.bdf", "--op2", "d.op2", "--f06", "d.f06")
        with open(self.path("d.f06")) as f:
            f06 = f.read()
        self.assertNotIn("D I S P L A C E M E N T", f06)
        self.assertNotIn("S T R E S S E S", f06)
        self.assertIn("F O R C E S   I N   B A R", f06)
        op2 = Op2(self.path("d.op2"))
        self.assertEqual({e for *_, rows in op2.elements("OEF1", 4) for e in rows}, {1, 21})
        self.assertEqual(set(read_stresses(op2)), {(34, 1), (1, 21)})


if __name__ == "__main__":
    unittest.main()
