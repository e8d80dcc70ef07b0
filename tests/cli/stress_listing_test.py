"""Stress tables of listings (--f06) and OUTPUT2 files (--op2): closed forms, the published words of each table."""
import re
import struct
import unittest

import numpy as np

from op2_reader import Op2
from support import ProgramTest

HEAD = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\n{case}BEGIN BULK\nMAT1,1,7.+10,,.3,2700.\n,300.+6,200.+6,90.+6\n"
# Words of an element after its id, by type: published widths less one.
WIDTHS = {1: 5, 2: 111, 3: 5, 10: 5, 33: 17, 34: 16, 39: 109, 67: 193, 68: 151, 74: 17, 95: 11, 97: 11,
          102: 7}


def read_stresses(op2, tables=("OES1", "OES1C")):
    """(type, element) -> words after the id; of plies a list by layer, of solids {grid or 0: 20 numbers}."""
    found = {}
    for table, words, data in op2.list_stresses(tables):
        kind, wide = words[2], words[9]
        assert words[1] == 5 and words[8] == 1 and wide == WIDTHS[kind], words[:12]
        assert (words[10] % 2 == 0) == (kind in (95, 97)) and (words[10] >= 10) == table.startswith("OSTR")
        assert table.endswith("C") == (kind in (95, 97))
        assert len(data) % (4 * wide) == 0
        for at in range(0, len(data), 4 * wide):
            (device,) = struct.unpack_from("<i", data, at)
            assert device % 10 == words[0] % 10
            key = (kind, device // 10)
            if kind == 2:
                rows = [struct.unpack_from("<i9f", data, at + 4 + 40 * k) for k in range(11)]
                assert not any(any(row) for row in rows[1:10])
                found[key] = rows[0], rows[10]
            elif kind in (39, 67, 68):
                cid, word, corners = struct.unpack_from("<i4si", data, at + 4)
                assert (cid, word) == (0, b"GRID") and wide == 4 + 21 * (corners + 1)
                rows = [struct.unpack_from("<i20f", data, at + 16 + 84 * k) for k in range(corners + 1)]
                found[key] = {row[0]: np.array(row[1:]) for row in rows}
            elif kind in (95, 97):
                row = struct.unpack_from("<i9f", data, at + 4)
                found.setdefault(key, []).append(row)
            else:
                found[key] = struct.unpack_from(f"<{wide - 1}f", data, at + 4)
    return found


def is_blank(value):
    """No number: 1 as an integer."""
    return struct.pack("<f", value) == struct.pack("<i", 1)


class Stresses(ProgramTest):
    def solve(self, bulk, case="", verb="static", extra=()):
        self.write("d.bdf", HEAD.format(case=case) + bulk + "ENDDATA\n")
        self.said = self.bough(verb, "d.bdf", "-o", "d.h5", "--op2", "d.op2", "--f06", "d.f06", *extra).stderr
        with open(self.path("d.f06")) as f:
            self.f06 = f.read()
        for line in self.f06.splitlines():
            self.assertLessEqual(len(line), 132, line)
        return read_stresses(Op2(self.path("d.op2")))

    def table(self, heading):
        """Lines of the tables with this heading (blanks left out), and the numbers in each."""
        lines, inside = [], False
        for line in self.f06.splitlines():
            if "PAGE" in line:
                inside = False
            if heading in line.replace(" ", ""):
                inside = True
            elif inside:
                lines.append([float(n) for n in re.findall(r"[-+]?\d+\.\d*(?:E[-+]\d+)?", line)])
        return [line for line in lines if line]

    def test_bar(self):
        """Points C and D, E and F on the axis; margins of 300 in tension and 200 in compression."""
        P, F, G, L, A, I1, I2 = 50000., 1000., -700., 2.0, 1e-3, 4e-8, 9e-8
        found = self.solve(f"GRID,1,,0.,0.,0.\nGRID,2,,{L},0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,4.-8,9.-8,1.-8\n,.002,.003,-.002,.001\n"
                           f"SPC1,1,123456,1\nFORCE,2,2,,1.,{P},{F},{G}\n", "STRESS = ALL\n")
        row = found[34, 1]
        bend = [-y * F * L / I1 - z * G * L / I2 for y, z in ((.002, .003), (-.002, .001), (0, 0), (0, 0))]
        np.testing.assert_allclose(row[:5], [*bend, P / A], rtol=1e-6, atol=1)
        high, low = max(bend) + P / A, min(bend) + P / A
        self.assertTrue(high > 0 > low)
        np.testing.assert_allclose(row[5:8], [high, low, 300e6 / high - 1], rtol=1e-5)
        np.testing.assert_allclose(row[8:12], 0, atol=20)
        np.testing.assert_allclose(row[12:14], P / A, rtol=1e-6)
        np.testing.assert_allclose(row[14], 200e6 / -low - 1, rtol=1e-5)
        first, second = self.table("STRESSESINBARELEMENTS(CBAR)")
        np.testing.assert_allclose(first[:7], row[:7], rtol=1e-5, atol=1)
        np.testing.assert_allclose(first[7], row[7], rtol=.05)
        np.testing.assert_allclose(second[-3:-1], row[12:14], rtol=1e-5)

    def test_beam_and_rods(self):
        P, F, L, A, I1, J, T = 5000., 100., 2.0, 1e-3, 4e-8, 2e-8, 30.
        found = self.solve(f"GRID,1,,0.,0.,0.\nGRID,2,,{L},0.,0.\nCBEAM,1,1,1,2,0.,1.,0.\nPBEAM,1,1,1.-3,4.-8,9.-8,,1.-8\n,.002,0.,-.002,0.,.001,.001\n"
                           f"SPC1,1,123456,1,3\nFORCE,2,2,,1.,{P},{F},0.\nGRID,3,,0.,1.,0.\nGRID,4,,2.,1.,0.\nCROD,9,3,3,4\nPROD,3,1,1.-3,2.-8,.01\n"
                           f"CONROD,8,3,4,1,2.-3\nSPC1,1,2356,4\nFORCE,2,4,,-6000.,1.,0.,0.\nMOMENT,2,4,,{T},1.,0.,0.\n", "STRESS = ALL\n")
        end_a, end_b = found[2, 1]
        self.assertEqual((end_a[0], end_a[1], end_b[0], end_b[1]), (1, 0, 2, 1))
        xx = [P / A - y * F * L / I1 for y in (.002, -.002, .001, 0)]
        np.testing.assert_allclose(end_a[2:6], xx, rtol=1e-5, atol=2)
        np.testing.assert_allclose(end_a[6:8], [max(xx), min(xx)], rtol=1e-5)
        np.testing.assert_allclose(end_a[8:], [300e6 / max(xx) - 1, 200e6 / -min(xx) - 1], rtol=1e-5)
        np.testing.assert_allclose(end_b[2:8], P / A, rtol=1e-5)
        self.assertTrue(is_blank(end_b[9]))  # nothing is compressed there
        # Rods share 6000 as 1 to 2; CROD alone takes the torque.
        np.testing.assert_allclose(found[1, 9], [-2e6, 99, T * .01 / J, 90e6 / (T * .01 / J) - 1], rtol=1e-5)
        np.testing.assert_allclose(found[10, 8][:2], [-2e6, 99], rtol=1e-5)
        self.assertTrue(is_blank(found[10, 8][3]))
        np.testing.assert_allclose(self.table("STRESSESINRODELEMENTS(CROD)")[0], found[1, 9], rtol=.05)

    def test_plates(self):
        """The strip of listing_test in tension 6 and bending 2 with Z1 and Z2 of its own, its first axes turned."""
        grids = [(0, 0), (1, 0), (2, 0), (0, 1), (1.5, 1), (2, 1)]
        bulk = "MAT1,2,7.+10,,0.,2700.\nPSHELL,1,2,.01,2,,2\n,-.004,.005\n"
        bulk += "".join(f"GRID,{k + 1},,{x:.1f},{y:.1f},0.\n" for k, (x, y) in enumerate(grids))
        bulk += "CQUAD4,1,1,1,2,5,4\nCQUAD4,2,1,2,3,6,5\nSPC1,1,12345,1,4\nSPC1,1,6,1,2,3,4,5,6\n"
        bulk += "".join(f"FORCE,2,{g},,3.,1.,0.,0.\nMOMENT,2,{g},,1.,0.,1.,0.\n" for g in (3, 6))
        found = self.solve(bulk, "STRESS = ALL\n")
        for element, corners in [(1, (0, 1, 4, 3)), (2, (1, 2, 5, 4))]:
            a, b, c, d = (np.array(grids[k], float) for k in corners)
            axis = (c - a) / np.linalg.norm(c - a) + (b - d) / np.linalg.norm(b - d)
            angle = np.arctan2(axis[1], axis[0])
            shape = np.array([np.cos(angle)**2, np.sin(angle)**2, -np.cos(angle) * np.sin(angle)])
            for half, z in ((0, -.004), (8, .005)):
                s = 6 / .01 + z * 2 / (.01**3 / 12)
                row = found[33, element][half:half + 8]
                np.testing.assert_allclose(row[:4], [z, *(s * shape)], rtol=1e-4, atol=abs(s) * 1e-6)
                np.testing.assert_allclose(row[5:], [max(s, 0), min(s, 0), abs(s)], rtol=1e-4, atol=abs(s) * 1e-6)
                # The principal axis is x of the strip: -angle from the element's, or across where s presses.
                turn = np.degrees(-angle) + (90 if s < 0 else 0)
                self.assertAlmostEqual((row[4] - turn + 90) % 180, 90, delta=1e-2)
        lines = self.table("STRESSESINQUADRILATERALELEMENTS(QUAD4)")
        np.testing.assert_allclose(lines[0][1:4], found[33, 1][1:4], rtol=1e-5, atol=1)

    def test_forces_and_stresses_of_a_trapezoid_are_means_of_one_kind(self):
        """N = t sigma of an element whose quadrature points have unlike areas: 13 % apart before."""
        found = self.solve("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,.6,0.\nGRID,4,,0.,1.,0.\nCQUAD4,10,3,1,2,3,4\n"
                           "PSHELL,3,5,.01\nMAT1,5,7.+10,,0.\nSPC1,1,3456,1,THRU,4\nSPC1,1,12,1,4\nSPC1,1,2,2\n"
                           "FORCE,2,2,,3.+5,1.,0.,0.\nFORCE,2,3,,5.+5,-.3,1.,0.\n", "STRESS = ALL\nFORCE = ALL\n")
        forces = self.table("FORCESINQUADRILATERALELEMENTS(QUAD4)")[0]
        np.testing.assert_allclose(forces[:3], .01 * np.array(found[33, 10][1:4]), rtol=1e-5)

    def test_plies(self):
        """Two plies of one material under tension: each has F / t along x, seen from its own axes."""
        bulk = ("PCOMP,1\n,1,.002,0.,YES,1,.002,90.,YES\n" + "".join(
            f"GRID,{1 + i + 2 * j},,{i}.,{j}.,0.\n" for j in range(2) for i in range(2)) +
            "CQUAD4,1,1,1,2,4,3\nSPC1,1,1345,1,3\nSPC1,1,2,1\nSPC1,1,6,1,2,3,4\nFORCE,2,2,,4.,1.,0.,0.\nFORCE,2,4,,4.,1.,0.,0.\n")
        found = self.solve(bulk, "STRESS = ALL\n")
        first, second = found[95, 1]
        self.assertEqual((first[0], second[0]), (1, 2))
        np.testing.assert_allclose(first[1:4], [2000, 0, 0], atol=.5)
        np.testing.assert_allclose(second[1:4], [0, 2000, 0], atol=.5)
        np.testing.assert_allclose([first[4:6], second[4:6]], 0, atol=.5)  # no force across
        np.testing.assert_allclose(first[7:], [2000, 0, 1000], atol=.5)
        self.assertEqual(len(self.table("LAYEREDCOMPOSITEELEMENTS(QUAD4)")), 2)

    def test_solids(self):
        """A bar of one brick in tension and bending: the corners have N/A + M z/I. A tetrahedron under pressure."""
        corners = [(0, 0, 0), (1, 0, 0), (1, .2, 0), (0, .2, 0), (0, 0, .1), (1, 0, .1), (1, .2, .1), (0, .2, .1)]
        bulk = "MAT1,2,7.+10,,0.,2700.\nPSOLID,1,2\n" + "".join(f"GRID,{k + 1},,{x},{y},{z}\n" for k, (x, y, z) in enumerate(corners))
        bulk += "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nSPC1,1,1,1,4,5,8\nSPC1,1,2,1\nSPC1,1,3,1,4\n"
        N, M = 5000., 80.
        bulk += "".join(f"FORCE,2,{g},,{N / 4 + sign * M / .1 / 2},1.,0.,0.\n" for g, sign in ((2, -1), (3, -1), (6, 1), (7, 1)))
        found = self.solve(bulk, "STRESS = ALL\n")[67, 1]
        self.assertEqual(list(found), [0, 1, 2, 3, 4, 5, 6, 7, 8])
        for grid, row in found.items():
            z = 0 if grid == 0 else corners[grid - 1][2] - .05
            s = N / .02 + M * z / (.2 * .1**3 / 12)
            np.testing.assert_allclose(row[[0, 8, 14, 1, 9, 15]], [s, 0, 0, 0, 0, 0], atol=abs(s) * 1e-4)
            np.testing.assert_allclose(row[[2, 6, 7]], [max(s, 0), -s / 3, abs(s)], rtol=1e-4, atol=1)
            np.testing.assert_allclose(np.abs(row[3:6] if s > 0 else row[17:20]), [1, 0, 0], atol=1e-3)
        lines = self.table("HEXAHEDRONSOLIDELEMENTS(HEXA)")
        self.assertEqual(len(lines), 27)
        np.testing.assert_allclose(lines[0][0], N / .02, rtol=1e-5)

    def test_modes(self):
        """Stresses of mode shapes are those of their forces."""
        bulk = ("EIGRL,3,,,1\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,4.-8,9.-8,1.-8\n,.02,.03\n"
                "CONM2,5,2,,3.\nSPC1,1,123456,1\n")
        found = self.solve(bulk, "METHOD = 3\nSTRESS = ALL\nFORCE = ALL\n", "modes")
        op2 = Op2(self.path("d.op2"))
        force = op2.elements("OEF1", 4)[0][4][1]
        np.testing.assert_allclose(found[34, 1][0], -force[0] * .02 / 4e-8 - force[1] * .03 / 9e-8, rtol=1e-4)

    def test_requests(self):
        bulk = ("GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCROD,1,1,1,2\nCROD,2,1,1,2\nPROD,1,1,1.-3\nSPC1,1,123456,1\nSPC1,1,23456,2\n"
                "FORCE,2,2,,1.,1.,0.,0.\n")
        self.assertEqual(list(self.solve(bulk, "SET 4 = 2\nSTRESS(PLOT) = 4\n")), [(1, 2)])
        self.assertNotIn("S T R E S S E S", self.f06)
        self.assertEqual(self.solve(bulk, "DISP = ALL\n"), {})
        self.assertEqual(len(self.solve(bulk)), 2)

    def test_beam_loads(self):
        """A CBEAM under a line load: shears at end B are those at A less the load."""
        bulk = ("GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBEAM,1,1,1,2,0.,1.,0.\nPBEAM,1,1,1.-3,4.-8,9.-8,,1.-8\nSPC1,1,123456,1\n"
                "PLOAD1,2,1,FY,FR,0.,50.,1.,50.\nPLOAD1,2,1,FX,FR,0.,10.,1.,10.\nFORCE,2,2,,7.,0.,1.,0.\n")
        self.solve(bulk, "FORCE = ALL\n")
        values = Op2(self.path("d.op2")).elements("OEF1", 4)[0][4][1]
        beam = np.reshape(values, (11, 9))
        # grid, x/L, M1, M2, V1, V2, axial, torque: 50 N/m over 2 m and 7 N at the tip.
        np.testing.assert_allclose(beam[0][2:8], [50 * 2 + 7 * 2, 0, 107, 0, 20, 0], rtol=1e-5, atol=1e-4)
        np.testing.assert_allclose(beam[10][2:8], [0, 0, 7, 0, 0, 0], rtol=1e-5, atol=1e-4)



class Strict(ProgramTest):
    """Faults for readers that allocate a table once and read fields by their columns."""
    DECK = HEAD + ("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,2.,0.,0.\n"
                   "GRID,6,,2.,1.,0.\nGRID,7,,3.,0.,0.\nGRID,8,,3.,1.,0.\n"
                   "CQUAD4,1,1,1,2,3,4\nCQUAD4,2,2,2,5,6,3\nCQUAD4,3,1,5,7,8,6\n"
                   "PCOMP,1\n,8,.1,0.,YES,8,.1,90.,YES\nPCOMP,2\n,8,.1,0.,YES,8,.1,90.,YES\n,8,.1,0.,YES\n"
                   "MAT8,8,1.4+11,1.+10,.3,5.+9,5.+9,5.+9\nSPC1,1,123456,1,4\nFORCE,2,7,,100.,0.,0.,1.\nENDDATA\n")

    def solve(self, case):
        self.write("d.bdf", self.DECK.format(case=case))
        self.bough("static", "d.bdf", "--op2", "d.op2", "--f06", "d.f06", "-o", "d.h5")
        return Op2(self.path("d.op2"))

    def test_laminates_of_other_numbers_of_plies(self):
        op2 = self.solve("STRESS = ALL\nFORCE = ALL\nSUBCASE 1\nSUBCASE 2\n")
        for table in ("OES1C", "OEF1"):
            self.assertEqual([ident[0][3] for ident, _ in op2.tables[table]], [1, 2])
        data = op2.tables["OES1C"][0].data
        rows = [struct.unpack_from("<2i9f", data, at) for at in range(0, len(data), 44)]
        self.assertEqual([row[:2] for row in rows], [(11, 1), (11, 2), (21, 1), (21, 2), (21, 3), (31, 1), (31, 2)])
        # Each element as in a deck with laminates of one kind.
        alone = self.DECK.format(case="STRESS = ALL\n").replace("CQUAD4,2,2,2,5,6,3\n", "")
        self.write("a.bdf", alone.replace("2,7,,100.", "2,2,,100.").replace("SPC1,1,123456,1,4", "SPC1,1,123456,1,4,5,6,7\nSPC1,1,123456,8"))
        self.bough("static", "a.bdf", "--op2", "a.op2")
        one = read_stresses(Op2(self.path("a.op2")))
        self.assertEqual([len(one[95, 1]), len(one[95, 3])], [2, 2])

    def test_texts_end_at_their_fields(self):
        long = "x" * 61 + " twelve words of a title that goes on and on beyond the field that is made for it, and further"
        op2 = self.solve(f"TITLE = {long}\nSUBTITLE = {long}\nLABEL = {long}\nDISP = ALL\n")
        (record,) = op2.tables["OUGV1"]
        self.assertEqual(record.ident[1], [long[:128].rstrip(), long[:67].rstrip(), long[:128].rstrip()])

    def test_ids_beyond_the_words(self):
        """10 id + 1 in 32 bits."""
        for grid, code in [(214748364, 0), (214748365, 1), (500000000, 1)]:
            self.write("d.bdf", self.DECK.format(case="DISP = ALL\n").replace("GRID,7,", f"GRID,{grid},").replace(
                ",5,7,8,6", f",5,{grid},8,6").replace("2,7,,", f"2,{grid},,"))
            result = self.bough("static", "d.bdf", "--op2", "d.op2", code=code)
            if code:
                self.assertIn("[export.large-id]", result.stderr)
                self.assertIn("214748364", result.stderr)
            else:
                (record,) = Op2(self.path("d.op2")).tables["OUGV1"]
                self.assertIn(grid, [struct.unpack_from("<i", record.data, at)[0] // 10 for at in range(0, len(record.data), 32)])


if __name__ == "__main__":
    unittest.main()
