"""Rotors of Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines (2010), 5.9: whirl frequencies at 0 and 4000 rpm.

Decks with ROTORG and RGYRO (SOL 107, six elements as in the book), and systems:
The shaft (CBEAM) on its bearings (CELAS2, CDAMP2) is a flexible body at rest; the discs turn on revolute hinges. The
gyroscopic moments of the discs act, that of the thin shaft is left out: 0.08 % of a frequency at most.
"""
import json
import math
import os

import h5py
import numpy as np

import rotors

NUM_ELEMENTS, DENSITY, E, G = 24, 7810.0, 2.11e11, 8.12e10
LENGTH, DIAMETER, WIDTH = 1.5, 0.05, 0.07
BOOK = "Friswell et al. 2010, {}"
# Case: bearings (place, k_y, k_z, c), discs (place, outer diameter), [rad/s] printed at 0 and 4000 rpm; None: not printed.
CASES = {
    "5.9.1, equal bearings": (((0, 1e6, 1e6, 0), (1.5, 1e6, 1e6, 0)), ((0.5, 0.28), (1.0, 0.35)),
                              [86.66, None, 274.31, None, 716.78], [85.39, 87.80, 251.78, 294.71, 600.18]),
    "5.9.2, unequal bearings": (((0, 1e6, 0.8e6, 0), (1.5, 1e6, 0.8e6, 0)), ((0.5, 0.28), (1.0, 0.35)),
                                [82.65, 86.66, 254.52, 274.31, 679.49], [82.33, 86.86, 239.64, 287.25, 583.49]),
    "5.9.9, overhung": (((0, 1e7, 1e7, 0), (1.0, 1e7, 1e7, 0)), ((1.5, 0.35),),
                        [90.14, None, 630.73, None, 830.43], [76.19, 103.91, 565.99, None, 647.75, 1174.2]),
    "5.9.5, damped bearings": (((0, 1e6, 1e6, 3e3), (1.5, 1e6, 1e6, 3e3)), ((0.5, 0.28), (1.0, 0.35)),
                               [2 * math.pi * 13.89, None, 2 * math.pi * 46.54, None, 2 * math.pi * 103.22],
                               [2 * math.pi * f for f in (13.68, 14.07, 41.98, 50.65, 104.25)]),
}


def find_grid(place):
    return 1 + round(place / LENGTH * NUM_ELEMENTS)


def write_shaft(folder, bearings, discs):
    """Bending alone: axial motion and torsion are fixed at every grid."""
    area, inertia = math.pi * DIAMETER**2 / 4, math.pi * DIAMETER**4 / 64
    nu = E / (2 * G) - 1
    kappa = 6 * (1 + nu) / (7 + 6 * nu)   # Cowper 1966, circular section
    number = lambda x: f"{x:.10e}"
    lines = ["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "EIGRL,1,,,20",
             f"SPC1,1,14,1,THRU,{NUM_ELEMENTS + 1}",
             f"PBEAM,1,1,{number(area)},{number(inertia)},{number(inertia)},,{number(2 * inertia)}", ",", ",YES,1.", ",",
             f",{number(kappa)},{number(kappa)}",
             f"MAT1,1,{number(E)},{number(G)},,{number(DENSITY)}"]
    for i in range(NUM_ELEMENTS + 1):
        lines.append(f"GRID,{i + 1},,{number(i * LENGTH / NUM_ELEMENTS)},0.,0.")
        if i < NUM_ELEMENTS:
            lines.append(f"CBEAM,{i + 1},1,{i + 1},{i + 2},0.,1.,0.")
    for j, (place, k_y, k_z, c) in enumerate(bearings):
        for component, k in ((2, k_y), (3, k_z)):
            lines.append(f"CELAS2,{100 + 10 * j + component},{number(k)},{find_grid(place)},{component}")
            if c > 0:
                lines.append(f"CDAMP2,{200 + 10 * j + component},{number(c)},{find_grid(place)},{component}")
    with open(os.path.join(folder, "shaft.bdf"), "w") as f:
        f.write("\n".join(lines + ["ENDDATA", ""]))
    with open(os.path.join(folder, "shaft.toml"), "w") as f:
        f.write(f'[body]\nname = "shaft"\ndeck = "shaft.bdf"\nframe = "fixed"\ninterface = '
                f'{sorted({find_grid(place) for place, *_ in (*bearings, *discs)})}\n[body.modes]\nbasis = "craig-bampton"\nnumber = 12\n'
                '[body.output]\nfile = "shaft.h5"\n')


def write_system(folder, discs, rate):
    text = ('[[body]]\nname = "shaft"\nfile = "shaft.h5"\n[[hinge]]\nname = "frame"\ntype = "fixed"\nchild = "shaft"\n'
            f'[[function]]\nname = "angle"\ntype = "ramp"\nvalue = {rate!r}\nfrom = 0\nto = 1\n'
            '[simulation]\nduration = 0.5\noutput_step = 0.001\n')
    for number, (place, outer) in enumerate(discs):
        mass = DENSITY * math.pi * (outer**2 - DIAMETER**2) / 4 * WIDTH
        polar = mass * (outer**2 + DIAMETER**2) / 8
        across = polar / 2 + mass * WIDTH**2 / 12
        text += (f'[[body]]\nname = "disc{number}"\nmass = {mass!r}\ncg = [0, 0, 0]\n'
                 f'inertia = [{polar!r}, {across!r}, {across!r}]\n[[hinge]]\nname = "spin{number}"\ntype = "revolute"\n'
                 f'parent = "shaft"\nparent_node = {find_grid(place)}\nchild = "disc{number}"\naxis = [1, 0, 0]\nmotion = "angle"\n')
    with open(os.path.join(folder, "rotor.toml"), "w") as f:
        f.write(text)


def verify(bough, folder, add):
    verify_decks(bough, folder, add)
    verify_unsymmetric(bough, folder, add)
    for case, (bearings, discs, *printed) in CASES.items():
        write_shaft(folder, bearings, discs)
        bough(folder, "reduce", "shaft.toml")
        for rpm, targets in zip((0, 4000), printed):
            write_system(folder, discs, rpm * math.pi / 30)
            bough(folder, "linearize", "rotor.toml", "--at", 0.1, "-o", "rotor.h5")
            with h5py.File(os.path.join(folder, "rotor.h5")) as f:
                imaginary = f["/poles/imag"][:]
            found = np.sort(imaginary[imaginary > 1])
            for k, target in enumerate(targets):
                if target:
                    # A mesh of six elements gives the book's 648.55 rad/s at 0 rpm with damped bearings, 24 give 649.47.
                    add(f"rotor, {case}", f"whirl {k + 1} at {rpm} rpm [rad/s]", found[k], target,
                        3e-3 if "damped" in case else 1e-3, BOOK.format(case.split(",")[0]))


# Code_Aster V2.02.125 (SDLL125): places of grids [m], sections (outer and inner radius [m]) of the elements between them.
ASTER_PLACES = (0, 0.0175, 0.035, 0.045, 0.07, 0.1025, 0.135, 0.1675, 0.2, 0.225, 0.25, 0.275, 0.3)
ASTER_SECTIONS = ((0.02, 0), (0.035, 0.005), (0.02, 0.005))
ASTER_OF_ELEMENT = (1, 1, 2, 3, 3, 3, 3, 3, 3, 3, 2, 2)
# Bearings: grid, K and C in y and z; discs: grid, mass, polar and diametral inertia.
ASTER_BEARINGS = ((5, ((1e8, -6e7), (-1e7, 8e7)), ((1.2e4, -3e3), (-3e3, 8e3))),
                  (9, ((7e7, -4e7), (-2e6, 5e7)), ((8e3, -1.5e3), (-1.5e3, 6e3))))
ASTER_DISCS = ((1, 3.5, 7e-3, 3.5e-3), (13, 3.0, 6e-3, 3e-3))
ASTER_HZ = {0: (216.212, 263.539, 383.210, 439.642), 60000: (185.365, 296.078, 324.718, 472.541)}
ASTER_RATIO = {0: 0.0476544, 60000: -0.0517463}


def write_unsymmetric(path, rpm):
    """Rotor in two bearings with full, unsymmetric tables (K2PP, B2PP)."""
    nu, number = 0.3, lambda x: f"{x:.12e}"
    lines = ["SOL 107", "CEND", "SPC = 1", "METHOD = 1", "CMETHOD = 2", "RGYRO = 5", "K2PP = KBRG", "B2PP = BBRG", "BEGIN BULK",
             "PARAM,COUPMASS,1", "EIGRL,1,,,20", "EIGC,2,LAN,,,,,8", f"MAT1,1,2.+11,,{nu},7800.", "SPC1,1,14,1,THRU,13"]
    for k, (outer, inner) in enumerate(ASTER_SECTIONS):
        area, inertia, m = math.pi * (outer**2 - inner**2), math.pi * (outer**4 - inner**4) / 4, inner / outer
        kappa = 6 * (1 + nu) * (1 + m * m)**2 / ((7 + 6 * nu) * (1 + m * m)**2 + (20 + 12 * nu) * m * m)  # Cowper 1966
        lines += [f"PBEAM,{k + 1},1,{number(area)},{number(inertia)},{number(inertia)},,{number(2 * inertia)}", ",", ",YES,1.", ",",
                  f",{number(kappa)},{number(kappa)}"]
    lines += [f"GRID,{i + 1},,{x!r},0.,0." for i, x in enumerate(ASTER_PLACES)]
    lines += [f"CBEAM,{i + 1},{p},{i + 1},{i + 2},0.,1.,0." for i, p in enumerate(ASTER_OF_ELEMENT)]
    for grid, mass, polar, across in ASTER_DISCS:
        lines += [f"CONM2,{100 + grid},{grid},,{mass!r}", f",{polar!r},,{across!r},,,{across!r}"]
    for j, name in ((1, "KBRG"), (2, "BBRG")):
        lines.append(f"DMIG,{name},0,1,1,0")
        for bearing in ASTER_BEARINGS:
            for column in (0, 1):
                for row in (0, 1):
                    lines.append(f"DMIG,{name},{bearing[0]},{2 + column},,{bearing[0]},{2 + row},{number(bearing[j][row][column])}")
    lines += ["ROTORG,1,1,THRU,13", "RSPINR,1,1,13,RPM,1.", f"RGYRO,5,ASYNC,1,RPM,,,{rpm}.", "ENDDATA", ""]
    with open(path, "w") as f:
        f.write("\n".join(lines))


def verify_unsymmetric(bough, folder, add):
    """Natural frequencies and the damping ratio of the first mode, which is unstable at speed; 0.1 and 0.12 % are the limits of
    the source for its own program, whose shear coefficients are others."""
    for rpm, targets in ASTER_HZ.items():
        write_unsymmetric(os.path.join(folder, "unsymmetric.bdf"), rpm)
        found = [complex(m["eigenvalue"]["real"], m["eigenvalue"]["imag"])
                 for m in json.loads(bough(folder, "modes", "unsymmetric.bdf", "--json"))["modes"]]
        found = [value for value in found if value.imag > 0]
        source = "Code_Aster V2.02.125, by ROTORINSA"
        for k, target in enumerate(targets):
            add("rotor, unsymmetric bearings", f"frequency {k + 1} at {rpm} rpm [Hz]", found[k].imag / 2 / math.pi,
                target, 1.2e-3 if k == 3 else 1e-3, source)
        add("rotor, unsymmetric bearings", f"damping ratio 1 at {rpm} rpm", -found[0].real / abs(found[0]), ASTER_RATIO[rpm],
            3e-3, source)


def verify_decks(bough, folder, add):
    """The rotors as decks; 5.9.4, whose bearings couple both planes, is printed in Hz at rest."""
    cases = {case: ([(place, [[k_y, 0], [0, k_z]], [[c, 0], [0, c]]) for place, k_y, k_z, c in bearings], discs, *printed)
             for case, (bearings, discs, *printed) in CASES.items()}
    coupled = [(place, [[1e6, 5e5], [5e5, 1e6]], [[0, 0], [0, 0]]) for place in (0, 1.5)]
    cases["5.9.4, coupled bearings"] = (coupled, CASES["5.9.1, equal bearings"][1],
                                        [2 * math.pi * f for f in (11.66, 14.80, 33.97, 49.19, 97.97, 126.61)], [])
    for case, (bearings, discs, *printed) in cases.items():
        for rpm, targets in zip((0, 4000), printed):
            deck = rotors.make_friswell_deck(6, bearings, discs, ["RGYRO = 5", "K2PP = KBRG"] if "coupled" in case else ["RGYRO = 5"],
                                             [f"RGYRO,5,ASYNC,1,RPM,,,{rpm}."])
            with open(os.path.join(folder, "rotor.bdf"), "w") as f:
                f.write(deck)
            found = [m["eigenvalue"]["imag"] for m in json.loads(bough(folder, "modes", "rotor.bdf", "--json"))["modes"]]
            found = [value for value in found if value > 0]
            for k, target in enumerate(targets):
                if target:
                    add(f"rotor deck, {case}", f"whirl {k + 1} at {rpm} rpm [rad/s]", found[k], target,
                        5e-4 if "damped" in case or "coupled" in case else 1.5e-4, BOOK.format(case.split(",")[0]))
