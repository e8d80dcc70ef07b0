"""The Ritz oracle against exact values, and the numbers in tests/plates/nafems_test.cpp against the Ritz oracle.

    /usr/bin/python3 tests/oracle/plate_ritz_test.py SOURCE_DIR
"""
import math
import os
import re
import sys

import numpy as np

import plate_ritz as ritz


def check(what, computed, expected, tolerance):
    off = np.max(np.abs(np.asarray(computed) / np.asarray(expected) - 1))
    assert off <= tolerance, f"{what}: off by {off:.2e}, allowed {tolerance:.0e}: {computed}"
    print(f"{what}: off by {off:.1e}")


def calc_simply_supported_mindlin(m, n, E, nu, rho, t, kappa=5 / 6):
    """Lowest omega^2 of a unit square, simply supported with the tangential rotation held: exact, from the 3 x 3 matrix
    of w sin sin, X cos sin, Y sin cos."""
    a, b = m * math.pi, n * math.pi
    D, S = E * t**3 / 12 / (1 - nu**2), kappa * t * E / 2 / (1 + nu)
    K = np.array([[S * (a * a + b * b), S * a, S * b],
                  [S * a, D * (a * a + (1 - nu) / 2 * b * b) + S, D * (1 + nu) / 2 * a * b],
                  [S * b, D * (1 + nu) / 2 * a * b, D * (b * b + (1 - nu) / 2 * a * a) + S]])
    scale = np.diag([1 / math.sqrt(rho * t)] + [1 / math.sqrt(rho * t**3 / 12)] * 2)
    return np.linalg.eigvalsh(scale @ K @ scale)[0]


def test_square_plates():
    cases = {
        "SSSS": (ritz.BOTH, 1, 0, [19.7392, 49.3480, 49.3480, 78.9568]),
        "CCCC": (ritz.BOTH, 2, 0, [35.9852, 73.3938, 73.3938, 108.2165, 131.5808, 132.2048]),
        "FFFF": (("", ""), 1, 3, [13.4682, 19.5961, 24.2702, 34.8009, 34.8009, 61.0932]),
        "CFFF": (("-", ""), 2, 0, [3.4711, 8.5067, 21.2850, 27.1989, 30.9563, 54.1872]),
    }
    for name, (held, order, rigid, exact) in cases.items():
        found = ritz.calc_kirchhoff(ritz.SQUARE, held, order, 14, len(exact) + rigid)[rigid:]
        check(name, np.sqrt(found), exact, 1e-5)


def test_skew_map():
    """A square cut as a parallelogram of its own: turned by 30 degrees, the frequencies stay."""
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    turned = [(c * x - s * y, s * x + c * y) for x, y in ritz.SQUARE]
    for calc in (lambda q: ritz.calc_kirchhoff(q, ("-", ""), 2, 8, 4),
                 lambda q: ritz.calc_mindlin(q, ("-", ""), 8, 4, 1.0, 0.3, 1.0, 0.1),
                 lambda q: ritz.calc_membrane(q, ("-", ""), 8, 4, 1.0, 0.3, 1.0)):
        check("turned square", calc(turned), calc(ritz.SQUARE), 1e-9)


def test_mindlin():
    """Clamped and thin it is Kirchhoff's plate; simply supported it is exact."""
    thin = ritz.calc_mindlin(ritz.SQUARE, ritz.BOTH, 14, 4, 1.0, 0.3, 1.0, 1e-3)
    check("thin Mindlin", np.sqrt(thin * 12 * (1 - 0.3**2)) / 1e-3, [35.9852, 73.3938, 73.3938, 108.2165], 1e-4)
    hard = [calc_simply_supported_mindlin(m, n, 1.0, 0.3, 1.0, 0.1) for m, n in ((1, 1), (1, 2), (2, 1), (2, 2))]
    found = ritz.calc_mindlin(ritz.SQUARE, ritz.BOTH, 12, 4, 1.0, 0.3, 1.0, 0.1, tangential_held=True)
    check("simply supported Mindlin", found, hard, 1e-8)


def test_block():
    """The block's symmetric modes, thin, are the membrane's; its antisymmetric ones Mindlin's."""
    plane = ritz.calc_membrane(ritz.SQUARE, ("", ""), 8, 8, 1.0, 0.3, 1.0)[3:]
    block = ritz.calc_block(ritz.SQUARE, ("", ""), 8, 2, 8, 1.0, 0.3, 1.0, 0.01, bending=False)[3:]
    check("thin block in its plane", block, plane, 1e-3)
    plate = ritz.calc_mindlin(ritz.SQUARE, ritz.BOTH, 12, 4, 1.0, 0.3, 1.0, 0.02)
    block = ritz.calc_block(ritz.SQUARE, ritz.BOTH, 12, 2, 4, 1.0, 0.3, 1.0, 0.02)
    check("block in bending", block, plate, 1e-2)


def test_held_numbers(source):
    with open(os.path.join(source, "tests/plates/nafems_test.cpp"), encoding="utf-8") as f:
        text = f.read()
    for name, key, num in (("FV12", "FV12", 14), ("FV15", "FV15", 16), ("FV16", "FV16", 16),
                           ("FV22", "FV22 Mindlin", 16), ("FV32", "FV32", 16)):
        body = text[text.index(f"TEST(Nafems, {name}"):]
        held = [float(v) for v in re.search(r"exact = \{([^}]*)\}", body).group(1).split(",")]
        check(f"{name}, numbers in the test", held, ritz.CASES[key](num)[:len(held)], 1e-4)


if __name__ == "__main__":
    test_square_plates()
    test_skew_map()
    test_mindlin()
    test_block()
    test_held_numbers(sys.argv[1])
