"""Writes real eigenvectors as Nastran does, from the description of the formats (docs/formats/nastran-modes.md).

nastran_modes_writer.py KIND FILE: KIND is punch, or op2 with any of -big, -wide (words of 8 bytes), -post2 (no label of
the file), -basic (table BOUGV1), -complex, -sort2, -nolama. The modes are those of `make_modes`.
"""
import struct
import sys

import numpy as np

NODES = [(11, 1), (12, 1), (40, 1), (77, 2)]  # id, 1 grid or 2 scalar point


def make_modes():
    """[(eigenvalue, generalized mass, p x 6)]: sixteenths, exact in single precision and in seven digits."""
    modes = []
    for j in range(3):
        shape = np.array([[(7 * k + 3 * c + 5 * j + 1) % 13 - 6 for c in range(6)] for k in range(4)]) / 16
        shape[3, 1:] = 0
        modes.append((float(4 ** j * 100), float(j + 1), shape))
    return modes


def write_punch(path):
    lines = []

    def put(text):
        lines.append(f"{text:<72}{len(lines) + 1:8d}")

    for subcase in (1, 2):
        for j, (eigenvalue, _, shape) in enumerate(make_modes()):
            for title in ("$TITLE   = OURS", "$SUBTITLE=", "$LABEL   =", "$EIGENVECTOR", "$REAL OUTPUT"):
                put(title)
            put(f"$SUBCASE ID ={subcase:12d}")
            put(f"$EIGENVALUE = {subcase * eigenvalue:14.7E}  MODE ={j + 1:6d}")
            for (node, kind), row in zip(NODES, shape):
                put(f"{node:10d}       {'GS'[kind - 1]}" + "".join(f"{v:18.6E}" for v in row[:3]))
                put("-CONT-            " + "".join(f"{v:18.6E}" for v in row[3:]))
    open(path, "w").write("\n".join(lines) + "\n")


class Op2:
    def __init__(self, path, big, wide):
        self.file, self.order, self.wide = open(path, "wb"), ">" if big else "<", wide

    def record(self, data):
        marker = struct.pack(self.order + "i", len(data))
        self.file.write(marker + data + marker)

    def integers(self, *values):
        return struct.pack(self.order + ("q" if self.wide else "i") * len(values), *values)

    def reals(self, *values):
        return struct.pack(self.order + ("d" if self.wide else "f") * len(values), *values)

    def key(self, value):
        self.record(self.integers(value))

    def data(self, data):
        self.key(len(data) // (8 if self.wide else 4))
        self.record(data)

    def name(self, text):
        return (text.ljust(8) + (" " * 8 if self.wide else "")).encode()

    def begin(self, name):
        self.data(self.name(name))
        self.key(-1)
        self.data(self.integers(101, 0, 0, 0, 0, 0, 0))
        self.key(-2)
        self.data(self.integers(0))
        self.data(self.name(name) + self.integers(1, 2, 3))
        self.number = -2

    def logical(self, *blocks):
        self.number -= 1
        self.key(self.number)
        self.data(self.integers(0))
        for block in blocks:
            self.data(block)

    def end(self):
        self.number -= 1
        self.key(self.number)
        self.data(self.integers(0))
        self.key(0)


def write_op2(path, options):
    out = Op2(path, "-big" in options, "-wide" in options)
    if "-post2" not in options:
        out.data(out.integers(11, 21, 26))
        out.data(out.name("NASTRAN ") * 3 + out.integers(0))
        out.data(out.name("OURS"))
        out.key(-1)
        out.key(0)
    out.begin("GEOM1")  # a table of no interest
    out.logical(out.integers(*range(200)))
    out.end()
    modes = make_modes()
    if "-nolama" not in options:
        out.begin("LAMA")
        out.logical(out.integers(21, 6, 0, 1) + out.integers(*[0] * 142))
        data = b""
        for j, (eigenvalue, mass, _) in enumerate(modes):
            omega = eigenvalue ** 0.5
            data += out.integers(j + 1, j + 1) + out.reals(eigenvalue, omega, omega / (2 * np.pi), mass, mass * eigenvalue)
        out.logical(data)
        out.end()
    out.begin("BOUGV1" if "-basic" in options else "OUGV1")
    for j, (eigenvalue, _, shape) in enumerate(modes):
        code = 2007 if "-sort2" in options else 7
        form, wide = (2, 14) if "-complex" in options else (1, 8)
        out.logical(out.integers(21, code, 0, 1, j + 1) + out.reals(eigenvalue, 0) + out.integers(0, form, wide) +
                    out.integers(*[0] * 136))
        rows = [out.integers(node * 10 + 1, kind) + out.reals(*row) for (node, kind), row in zip(NODES, shape)]
        # Two data blocks make one logical record.
        out.logical(b"".join(rows[:2]), b"".join(rows[2:]))
    out.end()
    out.key(0)


if __name__ == "__main__":
    kind, path = sys.argv[1:3]
    if kind == "punch":
        write_punch(path)
    else:
        write_op2(path, sys.argv[3:])
