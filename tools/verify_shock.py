"""Shock response spectrum of a half sine, and the interface acceleration of two components by Norton and Thevenin.

References are closed forms: the oscillator under a half sine, dense matrices of the coupled masses.
"""
import csv
import math
import os

import h5py
import numpy as np

from verify_random import write

AMPLITUDE, DURATION, Q = 100., .011, 10.


def calc_srs(hz, part="maximax"):
    """Largest absolute acceleration of an oscillator whose base has a half sine, from the closed form of its motion."""
    w, zeta, p = 2 * math.pi * hz, 1 / (2 * Q), math.pi / DURATION
    w_d = w * math.sqrt(1 - zeta * zeta)
    # Relative motion z'' + 2 zeta w z' + w² z = -A sin(p t) from rest.
    particular = -AMPLITUDE / (w * w - p * p + 2j * zeta * w * p)
    calc_free = lambda t, z, v: np.exp(-zeta * w * t) * (z * np.cos(w_d * t) + (v + zeta * w * z) / w_d * np.sin(w_d * t))
    calc_rate = lambda t, z, v: np.exp(-zeta * w * t) * (v * np.cos(w_d * t) - (w * w * z + zeta * w * v) / w_d * np.sin(w_d * t))
    start = -particular.imag, -(1j * p * particular).imag
    calc_forced = lambda t: ((particular * np.exp(1j * p * t)).imag + calc_free(t, *start),
                             (1j * p * particular * np.exp(1j * p * t)).imag + calc_rate(t, *start))
    t = np.linspace(0, DURATION, 20001)
    z, v = calc_forced(t)
    end = z[-1], v[-1]
    after = np.linspace(0, 2 / hz, 20001)
    z, v = np.concatenate([z, calc_free(after, *end)]), np.concatenate([v, calc_rate(after, *end)])
    absolute = -2 * zeta * w * v - w * w * z
    return abs(absolute).max() if part == "maximax" else -absolute.min()


def verify_half_sine(bough, folder, add):
    num = 440
    words = [f"{x:.7f}" for k in range(num + 1) for x in (DURATION * k / num, AMPLITUDE * math.sin(math.pi * k / num))]
    words += ["1.", "0.", "ENDT"]
    lines = ["," + ",".join(words[i:i + 8]) for i in range(0, len(words), 8)]
    write(folder, "shock.bdf", ["SOL 112", "CEND", "SPC = 1", "METHOD = 1", "DLOAD = 3", "TSTEP = 4", "ACCELERATION = ALL",
                                "BEGIN BULK", "EIGRL,1,,,1", "GRID,1,,0.,0.,0.,,23456", "GRID,2,,1.,0.,0.,,23456", "CONM2,3,2,,1.",
                                "CELAS2,4,400.,1,1,2,1", "SPC1,1,1,1", "TLOAD1,3,5,,ACCE,6", "SPCD,5,1,1,1.",
                                f"TSTEP,4,8800,{DURATION / num:.7f},1", "TABLED1,6", *lines])
    bough(folder, "transient", "shock.bdf", "-o", "shock.h5", "-q")
    for part, cases in (("maximax", (10, 20, 50, 100, 200, 500, 1000)), ("negative", (100,))):
        for hz in cases:
            bough(folder, "plot", "shock.h5", "--sensor", "acceleration:1:1", "--srs", "absolute-acceleration", "--srs-part", part,
                  "--q", f"{Q:g}", "--srs-range", f"{hz},{2 * hz},1", "--csv", "srs.csv", "-o", "srs.svg", "-q")
            with open(os.path.join(folder, "srs.csv")) as f:
                row = next(csv.DictReader(f))
            assert abs(float(row["x"]) / hz - 1) < 1e-9, row
            add("SRS, half sine 100 g, 11 ms", f"{part} at {hz} Hz, Q 10 [g]", abs(float(row["y"])), calc_srs(hz, part), 1e-4, "closed form")


MASSES, SPRINGS, DAMPER = (10., 30., 3., 2.), (45000., 25000., 10000.), 15.


def write_masses(folder, name, masses, links, load):
    """Masses on a line, joined by springs and dampers; unit force on mass `load`."""
    lines = ["SOL 108", "CEND", "FREQUENCY = 5", "DLOAD = 9", "ACCELERATION = ALL", "BEGIN BULK"]
    for k, m in enumerate(masses, 1):
        lines += [f"GRID,{k},,{k - 1}.,0.,0.,,23456", f"CONM2,{10 + k},{k},,{m:.1f}"]
    for k, spring in enumerate(links, 1):
        lines += [f"CELAS2,{20 + k},{spring:.1f},{k},1,{k + 1},1", f"CDAMP2,{30 + k},{DAMPER:.1f},{k},1,{k + 1},1"]
    write(folder, name, [*lines, "RLOAD1,9,10,,,1.", f"DAREA,10,{load},1,1.", "FREQ1,5,.02,.05,400"])


def solve_masses(bough, folder, masses, links, load, at):
    write_masses(folder, "m.bdf", masses, links, load)
    bough(folder, "frequency", "m.bdf", "-o", "m.h5", "-q")
    with h5py.File(os.path.join(folder, "m.h5")) as f:
        part = f["subcases/1/acceleration"]
        column = [tuple(d) for d in part["dofs"][:]].index((at, 1))
        return f["subcases/1/frequency_hz"][:], part["real"][:, column] + 1j * part["imag"][:, column]


def verify_force_limiting(bough, folder, add):
    """The second mass is the interface: half of it belongs to each component."""
    half = MASSES[1] / 2
    source, load = ((MASSES[0], half), SPRINGS[:1]), ((half, *MASSES[2:]), SPRINGS[1:])
    hz, free = solve_masses(bough, folder, *source, 1, 2)
    of_source = 1 / solve_masses(bough, folder, *source, 2, 2)[1]
    of_load = 1 / solve_masses(bough, folder, *load, 1, 1)[1]
    coupled = solve_masses(bough, folder, MASSES, SPRINGS, 1, 2)[1]
    joined = free * of_source / (of_source + of_load)
    K, C = np.zeros((4, 4)), np.zeros((4, 4))
    for k, spring in enumerate(SPRINGS):
        for A, value in ((K, spring), (C, DAMPER)):
            A[np.ix_((k, k + 1), (k, k + 1))] += value * np.array([[1, -1], [-1, 1]])
    w = 2 * np.pi * hz
    exact = np.array([-x * x * np.linalg.solve(K + 1j * x * C - x * x * np.diag(MASSES), [1, 0, 0, 0]) for x in w])
    largest = abs(exact[:, 1]).max()
    case, source = "force limiting, 4 masses", "dense matrices"
    add(case, "largest coupled acceleration of the interface", abs(coupled).max(), largest, 1e-8, source)
    add(case, "the same by Norton and Thevenin", abs(joined).max(), largest, 1e-8, source)
    add(case, "worst difference of both, over the largest", abs(joined - coupled).max() / largest, 1e-8, None, source)
    ratio = abs(of_source / (of_source + of_load))
    add(case, "coupled over free acceleration at 0.02 Hz", ratio[0], (MASSES[0] + half) / sum(MASSES), 1e-4, "rigid masses, 25/45")
    limit = abs(of_load * coupled)
    add(case, "largest force of the interface", limit.max(), abs(exact @ (0, half, *MASSES[2:])).max(), 1e-8, source)


def verify(bough, folder, add):
    verify_half_sine(bough, folder, add)
    verify_force_limiting(bough, folder, add)
