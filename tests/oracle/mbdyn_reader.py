"""Reads a .fem file of MBDyn's modal element from the description of its record groups alone.

read(path) gives {group number: array or list}; 1 the header's numbers, 8 modes x nodes x 6, 19 {index: matrix}.
"""
import re

import numpy as np


def read(path):
    groups, number = {}, None
    with open(path) as file:
        for line in file:
            if line.startswith("**"):
                found = re.match(r"\*\* RECORD GROUP (\d+),", line)
                if found:
                    number = int(found.group(1))
                    groups[number] = []
                elif "END OF FILE" in line:
                    number = None
            elif line.strip():
                groups[number].append(line.split())
    revision, *counts = groups[1][0]
    assert revision == "REV0" and len(groups[1]) == 1
    nodes, normal, attachment, constraint, rejected = (int(v) for v in counts)
    modes = normal + attachment + constraint - rejected
    result = {1: (nodes, modes), 2: [int(v) for line in groups[2] for v in line]}
    assert len(result[2]) == nodes
    shape = {3: (1, modes), 4: (1, modes), 5: (nodes, 1), 6: (nodes, 1), 7: (nodes, 1), 8: (modes, nodes, 6),
             9: (modes, modes), 10: (modes, modes), 13: (modes, modes), 14: (3, modes), 15: (3, modes),
             16: (3, modes, 3), 17: (3, modes, modes), 18: (3, modes, modes, 3)}
    for number, size in shape.items():
        rows = np.array([[float(v) for v in line] for line in groups[number]])
        assert rows.size == np.prod(size), (number, rows.shape)
        if number > 13:
            assert rows.shape[0] == 3
        result[number] = rows.reshape(size)
    mass, cg, *tensor = groups[12]
    assert len(mass) == 1 and len(cg) == 3 and [len(row) for row in tensor] == [3, 3, 3]
    result[12] = float(mass[0]), np.array(cg, float), np.array(tensor, float)
    if 19 in groups:
        rest = list(groups[19])
        count = int(rest.pop(0)[0])
        result[19] = {}
        for _ in range(count):
            (index,) = rest.pop(0)
            result[19][int(index)] = np.array([rest.pop(0) for _ in range(modes)], float)
        assert not rest and len(result[19]) == count
    return result
