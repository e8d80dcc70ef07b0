"""Reads OUTPUT2 files strictly, from the published layout: every key, record length, table code and width is checked."""
import struct
from collections import namedtuple

Record = namedtuple("Record", "ident data")
WIDTHS = {1: 3, 2: 100, 3: 3, 10: 3, 11: 2, 12: 2, 13: 2, 14: 2, 33: 9, 34: 9, 74: 9, 102: 7, 117: 9, 126: 7}
COMPLEX_WIDTHS = {1: 5, 2: 177, 3: 5, 10: 5, 11: 3, 12: 3, 13: 3, 14: 3, 33: 17, 34: 17, 74: 17, 102: 13, 117: 17, 126: 13}


class Op2:
    """tables: name -> list of Record, ident as 50 integers and three texts, data as bytes."""

    def __init__(self, path):
        with open(path, "rb") as f:
            self.bytes = f.read()
        self.at = 0
        self.tables = {}
        self.order = []
        self.read()

    def record(self):
        (n,) = struct.unpack_from("<i", self.bytes, self.at)
        data = self.bytes[self.at + 4:self.at + 4 + n]
        assert len(data) == n, "the file ends within a record"
        (closing,) = struct.unpack_from("<i", self.bytes, self.at + 4 + n)
        assert closing == n, f"record of {n} bytes closes with {closing}"
        self.at += n + 8
        return data

    def key(self):
        data = self.record()
        assert len(data) == 4
        return struct.unpack("<i", data)[0]

    def block(self):
        n = self.key()
        assert n > 0, n
        data = self.record()
        assert len(data) == 4 * n, (len(data), n)
        return data

    def expect(self, key):
        found = self.key()
        assert found == key, f"key {found}, expected {key}"

    def read(self):
        assert len(self.block()) == 12
        assert self.block() == b"NASTRAN FORT TAPE ID CODE - "
        assert len(self.block()) == 8
        self.expect(-1)
        self.expect(0)
        while True:
            n = self.key()
            if n == 0:
                break
            assert n == 2
            self.read_table(self.record().decode().strip())
        assert self.at == len(self.bytes), "something follows the end"

    def read_table(self, name):
        assert name not in self.tables, name
        self.order.append(name)
        self.expect(-1)
        assert len(self.block()) == 28
        number, blocks = -2, []
        while True:
            self.expect(number)
            number -= 1
            assert self.block() == bytes(4)
            n = self.key()
            if n == 0:
                break
            data = self.record()
            assert len(data) == 4 * n
            blocks.append(data)
        assert len(blocks[0]) == 28 and len(blocks) % 2 == 1, [len(b) for b in blocks]
        self.tables[name] = []
        seen = set()
        for ident, data in zip(blocks[1::2], blocks[2::2]):
            assert len(ident) == 584
            words = struct.unpack("<50i", ident[:200])
            texts = [ident[200 + 128 * i:328 + 128 * i].decode("ascii").rstrip() for i in range(3)]
            # Behind column 67 of SUBTITLE stand the adaptivity index and the superelement.
            assert len(texts[1]) <= 67, texts[1]
            # A record is all of its table, element type, subcase and step: readers make room once.
            kind = words[2] if words[1] % 1000 in (4, 5, 26, 27, 28) else 0
            key = (*words[:2], kind, *words[3:5])
            assert key not in seen, f"{name} has two records of {key}"
            seen.add(key)
            self.tables[name].append(Record((words, texts), data))

    @staticmethod
    def real(ident, word):
        """Word 1, 2, ... as a real."""
        return struct.unpack("<f", struct.pack("<i", ident[0][word - 1]))[0]

    def vectors(self, name):
        """(approach, table code, subcase, word 5, eigenvalue, cycles, {point: (type, values)}) of each record."""
        found = []
        for ident, data in self.tables[name]:
            words = ident[0]
            wide = words[9]
            is_complex = words[1] // 1000 == 1
            assert wide == (14 if is_complex else 8) and words[8] in ((2, 3) if is_complex else (1,)), words[:10]
            assert len(data) % (4 * wide) == 0
            rows = {}
            for k in range(len(data) // (4 * wide)):
                row = struct.unpack_from(f"<2i{wide - 2}f", data, 4 * wide * k)
                assert row[0] % 10 == words[0] % 10, "device code"
                assert row[1] in (1, 2)
                rows[row[0] // 10] = (row[1], row[2:])
            assert list(rows) == sorted(rows)
            found.append((words[0] // 10, words[1] % 1000, words[3], words[4], self.real(ident, 6), self.real(ident, 7),
                          rows))
        return found

    def list_stresses(self, tables=("OES1", "OES1C")):
        """(table, words of its ident, data) of each record of stresses (OSTR1, OSTR1C: strains) of elements."""
        return [(table, ident[0], data) for table in tables for ident, data in self.tables.get(table, [])]

    def grid_stresses(self):
        """(table code, subcase, surface or volume) -> rows of OGS1, ids of grids in place of device words."""
        found = {}
        for ident, data in self.tables.get("OGS1", []):
            words = ident[0]
            form = {26: "<2i4s8f", 27: "<i8f", 28: "<i14f"}[words[1]]
            assert struct.calcsize(form) == 4 * words[9] and len(data) % (4 * words[9]) == 0 and words[8] == 1, words[:14]
            rows = [struct.unpack_from(form, data, at) for at in range(0, len(data), 4 * words[9])]
            assert all(row[0] % 10 == words[0] % 10 for row in rows)
            found[words[1], words[3], words[2]] = [(row[0] // 10, *row[1:]) for row in rows]
        return found

    def random_curves(self, name):
        """SORT2: {(table code, subcase, point): (type, frequencies or lags, values)} of real random results."""
        found = {}
        for ident, data in self.tables[name]:
            words = ident[0]
            assert words[1] // 1000 == 6 and words[0] // 10 == 5 and words[8:10] == (1, 8), words[:10]
            assert words[4] % 10 == words[0] % 10 and len(data) % 32 == 0
            rows = [struct.unpack_from("<fi6f", data, 32 * k) for k in range(len(data) // 32)]
            types = {row[1] for row in rows}
            assert len(types) == 1 and types <= {1, 2}
            found[words[1] % 1000, words[3], words[4] // 10] = types.pop(), [r[0] for r in rows], [r[2:] for r in rows]
        return found

    def random_values(self, name):
        """SORT1: {(table code, subcase): {point: (type, values)}} of real random results."""
        found = {}
        for ident, data in self.tables[name]:
            words = ident[0]
            assert words[1] // 1000 == 4 and words[0] // 10 == 5 and words[8:10] == (1, 8), words[:10]
            assert self.real(ident, 5) == 0 and len(data) % 32 == 0
            rows = [struct.unpack_from("<2i6f", data, 32 * k) for k in range(len(data) // 32)]
            assert all(row[0] % 10 == words[0] % 10 for row in rows)
            assert [row[0] for row in rows] == sorted(row[0] for row in rows)
            found[words[1] % 1000, words[3]] = {row[0] // 10: (row[1], row[2:]) for row in rows}
        return found

    def elements(self, name, code):
        """(approach, element type, subcase, word 5, {element: values}) of each record."""
        found = []
        for ident, data in self.tables[name]:
            words = ident[0]
            is_complex = words[1] // 1000 == 1
            assert words[1] % 1000 == code and words[8] in ((2, 3) if is_complex else (1,)), words[:10]
            wide = words[9]
            if code == 4:
                assert wide == (COMPLEX_WIDTHS if is_complex else WIDTHS)[words[2]], (words[2], wide)
            rows = {}
            beam = "i15f" if is_complex else "i8f"
            form = "<i" + (beam * 11 if words[2] == 2 and code == 4 else f"{wide - 1}f")
            assert struct.calcsize(form) == 4 * wide
            for k in range(len(data) // (4 * wide)):
                row = struct.unpack_from(form, data, 4 * wide * k)
                assert row[0] % 10 == words[0] % 10
                rows[row[0] // 10] = row[1:]
            found.append((words[0] // 10, words[2], words[3], words[4], rows))
        return found

    def roots(self):
        """(subcase, rows of mode, order, eigenvalue, radians, cycles, mass, stiffness)."""
        found = []
        for ident, data in self.tables["LAMA"]:
            assert ident[0][9] == 7 and len(data) % 28 == 0
            found.append((ident[0][3], [struct.unpack_from("<2i5f", data, 28 * k) for k in range(len(data) // 28)]))
        return found

    def weight(self):
        """Reference grid, the 78 numbers."""
        ((ident, data),) = self.tables["OGPWG"]
        assert ident[0][1] == 13 and ident[0][9] == 78 and len(data) == 312
        return ident[0][2], struct.unpack("<78f", data)
