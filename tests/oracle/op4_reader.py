"""Reads Nastran OUTPUT4 files of every flavour, written from the description of the format alone (docs/formats/op4.md).

op4_reader.py FILE prints, matrix by matrix: a line "NAME form type rows columns", then "row column real imaginary" for
every entry that is not zero, 1-based, and "end".
"""
import re
import sys

import numpy as np
from scipy.io import FortranFile

BIG = 65536


def put(entries, column, row, values):
    for i, value in enumerate(values):
        if value != 0:
            entries[(row + i, column)] = value


def pair(numbers, is_complex):
    return [complex(a, b) for a, b in zip(numbers[0::2], numbers[1::2])] if is_complex else [complex(a) for a in numbers]


def read_binary(path):
    with open(path, "rb") as file:
        head = file.read(4)
    order = "<" if int.from_bytes(head, "little") in (24, 48) else ">"
    wide = int.from_bytes(head, "little" if order == "<" else "big") == 48
    integer = np.dtype(order + ("i8" if wide else "i4"))
    # FortranFile checks that both length markers of a record agree.
    with FortranFile(path, "r", header_dtype=np.dtype(order + "u4")) as file:
        while True:
            try:
                record = file.read_record("u1").tobytes()
            except Exception as error:
                if type(error).__name__ == "FortranEOFError":
                    return
                raise
            columns, rows, form, kind = np.frombuffer(record, integer, 4)
            name = record[4 * integer.itemsize:].decode().strip()
            real = np.dtype(order + ("f8" if wide or kind % 2 == 0 else "f4"))
            big = rows < 0 or rows >= BIG
            entries = {}
            while True:
                record = file.read_record("u1").tobytes()
                column, first, words = (int(i) for i in np.frombuffer(record, integer, 3))
                data = record[3 * integer.itemsize:]
                assert len(data) == words * integer.itemsize, (len(data), words)
                if column > columns:
                    break
                if first > 0:
                    put(entries, column, first, pair(np.frombuffer(data, real).astype(float), kind > 2))
                    continue
                while data:
                    if big:
                        length, row = (int(i) for i in np.frombuffer(data, integer, 2))
                        length -= 1
                        data = data[2 * integer.itemsize:]
                    else:
                        length, row = divmod(int(np.frombuffer(data, integer, 1)[0]), 65536)
                        length -= 1
                        data = data[integer.itemsize:]
                    size = length * integer.itemsize
                    assert 0 < size <= len(data)
                    put(entries, column, row, pair(np.frombuffer(data[:size], real).astype(float), kind > 2))
                    data = data[size:]
            yield name, int(form), int(kind), abs(int(rows)), int(columns), entries


def read_text(path):
    with open(path) as file:
        lines = iter(file.read().splitlines())
    for header in lines:
        columns, rows, form, kind = (int(header[i:i + 8]) for i in (0, 8, 16, 24))
        name = header[32:40].strip()
        found = re.search(r"(\d+)\s*[EDG]\s*(\d+)\.", header[40:])
        per_line, width = (int(found[1]), int(found[2])) if found else (5, 16)
        big = rows < 0 or rows >= BIG

        def numbers(count):
            text = ""
            for _ in range(-(-count // per_line)):
                text += next(lines).ljust(per_line * width)[:per_line * width]
            return [float(text[i * width:(i + 1) * width].replace("D", "E")) for i in range(count)]

        entries = {}
        while True:
            line = next(lines)
            column, first, words = (int(line[i:i + 8]) for i in (0, 8, 16))
            if column > columns:
                next(lines)
                break
            if first > 0:
                put(entries, column, first, pair(numbers(words), kind > 2))
                continue
            while words > 0:
                line = next(lines)
                if big:
                    length, row = int(line[:8]) - 1, int(line[8:16])
                    words -= length + 2
                else:
                    length, row = divmod(int(line), 65536)
                    length -= 1
                    words -= length + 1
                put(entries, column, row, pair(numbers(length // (1 if kind % 2 else 2)), kind > 2))
            assert words == 0
        yield name, form, kind, abs(rows), columns, entries


def read(path):
    with open(path, "rb") as file:
        is_binary = b"\0" in file.read(16)
    return list(read_binary(path) if is_binary else read_text(path))


if __name__ == "__main__":
    for name, form, kind, rows, columns, entries in read(sys.argv[1]):
        print(name, form, kind, rows, columns)
        for (row, column), value in sorted(entries.items()):
            print(row, column, repr(float(value.real)), repr(float(value.imag)))
        print("end")
