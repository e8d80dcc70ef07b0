"""Reads universal files in text: datasets 15, 55, 58, 82, by column, from the description of the format alone.

read(path) gives a list of dictionaries with the key "dataset".
"""
import numpy as np


def fields(line, *widths):
    """The line cut into columns; missing columns are blank."""
    cut, at = [], 0
    for width in widths:
        cut.append(line[at:at + width].strip())
        at += width
    return cut


def read_15(lines):
    rows = [fields(line, 10, 10, 10, 10, 13, 13, 13) for line in lines]
    return dict(id=[int(r[0]) for r in rows], xyz=np.array([[float(v) for v in r[4:]] for r in rows]))


def read_82(lines):
    number, count, _ = (int(v) for v in fields(lines[0], 10, 10, 10))
    nodes = [int(v) for line in lines[2:] for v in fields(line.rstrip("\n"), *[10] * 8) if v]
    assert len(nodes) == count <= 250
    return dict(number=number, title=lines[1].strip(), nodes=nodes)


def read_55(lines):
    assert all(line.strip() for line in lines[:5])
    model, analysis, character, kind, data_type, per_node = (int(v) for v in fields(lines[5], *[10] * 6))
    # Six displacements of a mode; three translations of an instant.
    assert (model, kind, data_type) == (1, 8, 2) and (character, per_node) == ((2, 3) if analysis == 4 else (3, 6))
    counts = [int(v) for v in fields(lines[6], *[10] * 8) if v]
    reals = [float(v) for v in fields(lines[7], *[13] * 6) if v]
    assert counts[0] == len(counts) - 2 and counts[1] == len(reals)
    ids = [int(fields(line, 10)[0]) for line in lines[8::2]]
    shape = np.array([[float(v) for v in fields(line, *[13] * per_node)] for line in lines[9::2]])
    return dict(model=lines[0].strip(), analysis=analysis, parameters=counts[2:], reals=reals, id=ids, shape=shape)


def read_58(lines):
    kind, number = (int(v) for v in fields(lines[5], 5, 10))
    ordinate, count, even = (int(v) for v in fields(lines[6], 10, 10, 10))
    start, step = (float(v) for v in fields(lines[6][30:], 13, 13))
    assert (kind, ordinate) in [(1, 4), (4, 6), (12, 6)]  # over time real, transfer functions and spectra complex
    node, direction = (int(v) for v in fields(lines[5][41:], 10, 4))
    abscissa, quantity = (int(fields(line, 10)[0]) for line in lines[7:9])
    assert abscissa == {1: 17, 4: 18, 12: 18}[kind] and len(fields(lines[7][25:], 1, 20, 1, 20)[1]) > 0
    parts = 2 if ordinate == 6 else 1
    widths = [20] * 4 if even else [13, 20, 20] if parts == 2 else [13, 20, 13, 20]
    values = np.array([float(v) for line in lines[11:] for v in fields(line.rstrip("\n"), *widths) if v])
    rows = values.reshape(count, parts if even else parts + 1)
    x, numbers = (start + step * np.arange(count), rows) if even else (rows[:, 0], rows[:, 1:])
    numbers = numbers[:, 0] if parts == 1 else numbers[:, 0] + 1j * numbers[:, 1]
    return dict(name=lines[0].strip(), function=kind, number=number, time=x, values=numbers, node=node, direction=direction,
                quantity=quantity)


READERS = {15: read_15, 55: read_55, 58: read_58, 82: read_82}


def read(path):
    with open(path) as file:
        lines = file.read().splitlines()
    assert all(len(line) <= 80 for line in lines), "a record has 80 columns"
    sets, at = [], 0
    while at < len(lines):
        assert lines[at] == "    -1"
        dataset = int(lines[at + 1][:6])
        end = lines.index("    -1", at + 2)
        sets.append(dict(dataset=dataset, **READERS[dataset](lines[at + 2:end])))
        at = end + 1
    return sets
