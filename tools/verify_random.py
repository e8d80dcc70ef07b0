"""Random response and plates under harmonic, sudden and random loads: NAFEMS 5R, 13, 21 (R0016), SDLD23, SDLD101, Miles, GEVS.

References are closed forms: series of Timoshenko's beam and of plates, dense matrices, integrals over the band.
"""
import math
import os

import h5py
import numpy as np
from scipy.integrate import quad

import verify_response

E, NU, DENSITY, DAMPING, SIDE = 2e11, 0.3, 8000.0, 0.02, 10.0


def write(folder, name, lines):
    with open(os.path.join(folder, name), "w") as f:
        f.write("\n".join([*lines, "ENDDATA", ""]))


def read_random(folder, name, quantity, dof, number=30):
    """(psd, rms, N0, modal rms, frequencies) of one component of a grid."""
    with h5py.File(os.path.join(folder, name)) as f:
        group = f[f"random/{number}"]
        part = group[quantity]
        column = [tuple(d) for d in part["dofs"][:]].index(dof)
        modal = part["modal_rms"][column] if "modal_rms" in part else None
        return part["psd"][:, column], part["rms"][column], part["zero_crossings_hz"][column], modal, group["frequency_hz"][:]


def verify_beam(bough, folder, add):
    source = "Timoshenko series, kappa 5/6; NAFEMS R0016 prints {}"
    verify_response.write_deck(os.path.join(folder, "5r.bdf"), 111, "FREQUENCY = 4\nRANDOM = 30",
                               ["RLOAD1,3,5,,,6", "TABLED1,6", ",0.,1.,1.+6,1.,ENDT", "FREQ1,4,42.4,.001,400", "FREQ,4,0.,1000.",
                                "FREQ4,4,0.,1000.,.3,31", "RANDPS,30,1,1,1."])
    bough(folder, "frequency", "5r.bdf", "-o", "5r.h5", "-q")
    psd, _, _, modal, _ = read_random(folder, "5r.h5", "displacement", (verify_response.MIDDLE, 3))
    with h5py.File(os.path.join(folder, "5r.h5")) as f:
        part = f["random/30/stresses/CBEAM"]
        names = [name.decode() if isinstance(name, bytes) else name for name in part.attrs["components"]]
        at = (np.flatnonzero(part["id"][:] == verify_response.MIDDLE)[0], names.index("xx@C_a"))
        stress, stress_rms = part["psd"][(slice(None), *at)], part["modal_rms"][at]
    grid = np.arange(42.4, 42.8, 0.002)
    exact = np.array([verify_response.calc_harmonic(f) for f in grid]).max(axis=0)**2
    add("NAFEMS 5R, white force", "peak of the deflection [mm2/Hz]", 1e6 * psd.max(), 1e6 * exact[0], 2e-3, source.format("180.90"))
    add("NAFEMS 5R, white force", "peak of the stress [(N/mm2)2/Hz]", 1e-12 * stress.max(), 1e-12 * exact[1], 2e-3,
        source.format("58516"))
    omega, deflection, fibre = verify_response.calc_terms(40)
    hz = np.unique(np.concatenate([np.linspace(0, 1000, 20001), np.linspace(35, 50, 15001)]))
    w = 2 * np.pi * hz[:, None]
    gain = 1 / (omega**2 - w * w + 2j * DAMPING * omega * w)
    for name, found, shape, scale in (("deflection, 0 to 1000 Hz [mm]", modal, deflection, 1e3),
                                      ("stress, 0 to 1000 Hz [N/mm2]", stress_rms, fibre, 1e-6)):
        rms = math.sqrt(np.trapz(np.abs(gain @ shape)**2, hz))
        add("NAFEMS 5R, white force", "RMS " + name, scale * found, scale * rms, 3e-3, "Timoshenko series, kappa 5/6")


def calc_plate(thickness, pressure, num=61):
    """Modes of the simply supported Mindlin plate (kappa 5/6): omega and deflection at the middle per 1/omega²."""
    D, G = E * thickness**3 / 12 / (1 - NU**2), E / 2 / (1 + NU)
    terms = []
    for m in range(1, num, 2):
        for n in range(1, num, 2):
            k2 = (m * m + n * n) * (math.pi / SIDE)**2
            S, rho, inertia = 5 / 6 * G * thickness, DENSITY * thickness, DENSITY * thickness**3 / 12
            K = np.array([[S * k2, -S * math.sqrt(k2)], [-S * math.sqrt(k2), S + D * k2]])
            L = np.diag([rho**-.5, inertia**-.5])
            values, vectors = np.linalg.eigh(L @ K @ L)
            force = 16 * pressure / (math.pi**2 * m * n)
            sign = math.sin(m * math.pi / 2) * math.sin(n * math.pi / 2)
            for value, vector in zip(values, (L @ vectors).T):
                terms.append((math.sqrt(value), force * vector[0]**2 * sign))
    return np.array(terms).T


def write_plate(folder, name, solution, control, thickness, pressure, cards, num=24):
    h = SIDE / num
    lines = [f"SOL {solution}", "CEND", "SPC = 1", "METHOD = 1", "SDAMPING = 9", "DLOAD = 3", *control, "DISPLACEMENT = 1",
             f"SET 1 = {(num // 2) * (num + 1) + num // 2 + 1}", "BEGIN BULK", "PARAM,COUPMASS,1", "EIGRL,1,,,30",
             "TABDMP1,9,CRIT", f",0.,{DAMPING},1.+6,{DAMPING},ENDT", f"PSHELL,1,1,{thickness},1,,1", f"MAT1,1,2.+11,,{NU},{DENSITY}",
             "RLOAD1,3,5,,,6" if solution == 111 else "TLOAD1,3,5,,0,6", "TABLED1,6",
             ",0.,1.,1.+6,1.,ENDT" if solution == 111 else ",-1.,1.,1.+6,1.,ENDT"]
    for j in range(num + 1):
        for i in range(num + 1):
            grid = j * (num + 1) + i + 1
            held = "126" + ("3" if i in (0, num) or j in (0, num) else "") + ("4" if i in (0, num) else "") + (
                "5" if j in (0, num) else "")
            lines.append(f"GRID,{grid},,{i * h!r},{j * h!r},0.,,{''.join(sorted(held))}")
            if i < num and j < num:
                lines.append(f"CQUAD4,{grid},1,{grid},{grid + 1},{grid + num + 2},{grid + num + 1}")
            if 0 < i < num and 0 < j < num:
                lines.append(f"DAREA,5,{grid},3,{pressure * h * h!r}")
    write(folder, name, lines + cards)
    return int(lines[lines.index("DISPLACEMENT = 1") + 1].split()[-1])


def verify_plates(bough, folder, add):
    for case, thickness, pressure, around, printed in (("NAFEMS 13", .05, 100., 2.376, ("45.42", "2063.20")),
                                                       ("NAFEMS 21", 1., 1e6, 45.894, ("58.33", "3401.81"))):
        source = "Mindlin series, kappa 5/6; NAFEMS R0016 prints {}"
        grid = write_plate(folder, "h.bdf", 111, ["FREQUENCY = 4", "RANDOM = 30"], thickness, pressure,
                           [f"FREQ1,4,{.98 * around:.6f},{.0001 * around:.8f},400", "RANDPS,30,1,1,1."])
        bough(folder, "frequency", "h.bdf", "-o", "h.h5", "-q")
        psd, _, _, _, hz = read_random(folder, "h.h5", "displacement", (grid, 3))
        omega, shape = calc_plate(thickness, pressure)
        w = 2 * np.pi * np.linspace(.98 * around, 1.02 * around, 401)[:, None]
        exact = np.abs((1 / (omega**2 - w * w + 2j * DAMPING * omega * w)) @ shape)
        at = exact.argmax()
        add(case + "H, harmonic", "frequency of the peak [Hz]", hz[psd.argmax()], w[at, 0] / 2 / np.pi, 1e-2, source.format(around))
        add(case + "H, harmonic", "deflection at the middle [mm]", 1e3 * math.sqrt(psd.max()), 1e3 * exact[at], 1e-2,
            source.format(printed[0]))
        add(case + "R, white pressure", "peak of the deflection [mm2/Hz]", 1e6 * psd.max(), 1e6 * exact[at]**2, 2e-2,
            source.format(printed[1]))
    grid = write_plate(folder, "t.bdf", 112, ["TSTEP = 4"], .05, 100., ["TSTEP,4,1200,.0002,1"])
    bough(folder, "transient", "t.bdf", "-o", "t.h5", "-q")
    with h5py.File(os.path.join(folder, "t.h5")) as f:
        part = f["subcases/1/displacement"]
        value = part["value"][:, [tuple(d) for d in part["dofs"][:]].index((grid, 3))]
    omega, shape = calc_plate(.05, 100.)
    t = np.linspace(.15, .24, 901)[:, None]
    damped = omega * math.sqrt(1 - DAMPING**2)
    rest = np.exp(-DAMPING * omega * t) * (np.cos(damped * t) + DAMPING * omega / damped * np.sin(damped * t))
    add("NAFEMS 13T, step", "largest deflection at the middle [mm]", 1e3 * abs(value).max(), 1e3 * ((1 - rest) @ (shape / omega**2)).max(),
        1e-2, "Mindlin series; NAFEMS R0016 prints 3.523 of the first mode alone")


def verify_chain(bough, folder, add):
    """SDLD23: eight masses between nine springs with dampers, a random force at the fourth."""
    lines = ["SOL 108", "CEND", "SPC = 1", "DLOAD = 9", "FREQUENCY = 4", "RANDOM = 30", "DISPLACEMENT = ALL", "BEGIN BULK"]
    for i in range(10):
        lines.append(f"GRID,{i + 1},,{float(i)},0.,0.,,{'123456' if i in (0, 9) else '23456'}")
        if i < 9:
            lines += [f"CELAS2,{i + 1},1.+5,{i + 1},1,{i + 2},1", f"CDAMP2,{i + 21},50.,{i + 1},1,{i + 2},1"]
        if 0 < i < 9:
            lines.append(f"CONM2,{i + 41},{i + 1},,10.")
    lines += ["RLOAD1,9,10,,,1.", "DAREA,10,5,1,1.", "RANDPS,30,1,1,1.", "FREQ1,4,3.,.005,2000", "SPC1,1,1,1"]
    write(folder, "chain.bdf", lines)
    bough(folder, "frequency", "chain.bdf", "-o", "chain.h5", "-q")
    _, rms, crossings, _, _ = read_random(folder, "chain.h5", "displacement", (5, 1))
    T = 2 * np.eye(8) - np.eye(8, k=1) - np.eye(8, k=-1)
    unit = np.eye(8)[3]
    density = lambda f: abs(np.linalg.solve((1e5 + 100j * math.pi * f) * T - 10 * (2 * math.pi * f)**2 * np.eye(8), unit)[3])**2
    m0, m2 = (quad(lambda f: f**r * density(f), 3, 13, points=[5.527, 10.887], limit=400, epsrel=1e-10)[0] for r in (0, 2))
    add("SDLD23, 8 masses", "RMS of P4, 3 to 13 Hz [m]", rms, math.sqrt(m0), 1e-4, "dense matrices; Code_Aster V2.01.023")
    add("SDLD23, 8 masses", "N0 of P4 [Hz]", crossings, math.sqrt(m2 / m0), 1e-4, "dense matrices")


def verify_base(bough, folder, add):
    """An oscillator on a shaken base: SDLD101, Miles against the integral, and the levels of GEVS at the base itself."""
    def solve(name, hz, damping, table, cards):
        stiffness = (2 * math.pi * hz)**2
        write(folder, name + ".bdf",
              ["SOL 111", "CEND", "SPC = 1", "METHOD = 1", "DLOAD = 9", "FREQUENCY = 5", "RANDOM = 30",
               "ACCELERATION = ALL", "BEGIN BULK", "EIGRL,1,,,1", "GRID,1,,0.,0.,0.,,23456", "GRID,2,,1.,0.,0.,,23456",
               "CONM2,3,2,,1.", f"CELAS2,4,{stiffness:.10g},1,1,2,1".replace("e+0", "+"), "SPC1,1,1,1", "RLOAD1,9,10,,,1.,,ACCE",
               "SPCD,10,1,1,1.", f"CDAMP2,5,{4 * math.pi * damping * hz:.10g},1,1,2,1", "RANDPS,30,1,1,1.,,7", *table, *cards])
        bough(folder, "frequency", name + ".bdf", "-o", name + ".h5", "-q")
        return read_random(folder, name + ".h5", "acceleration", (2, 1)), read_random(folder, name + ".h5", "acceleration", (1, 1))

    white = ["TABRND1,7", ",1.,.04,3000.,.04,ENDT"]
    zeta, w0 = .05, 100.
    mass, base = solve("sdld101", w0 / 2 / math.pi, zeta, white, ["FREQ1,5,5.,.5,60"])
    for k in (10, 22, 50):
        w = 2 * math.pi * mass[4][k]
        exact = (w0**4 + 4 * zeta**2 * w0**2 * w**2) / ((w0**2 - w**2)**2 + 4 * zeta**2 * w0**2 * w**2)
        add("SDLD101, oscillator on a base", f"G_rr/G_ee at {mass[4][k]:g} Hz", mass[0][k] / base[0][k], exact, 1e-6,
            "closed form; Code_Aster V2.01.101")
    mass, _ = solve("miles", 100., .05, white, ["FREQ1,5,20.,20.,99", "FREQ4,5,20.,2000.,.5,201"])
    r = lambda f: (1 + (f / 1000)**2) / ((1 - (f / 100)**2)**2 + (f / 1000)**2)
    exact = math.sqrt(.04 * quad(r, 20, 2000, points=[100], limit=400)[0])
    add("Miles, 100 Hz, Q 10", "RMS, 20 to 2000 Hz, integral over the band [g]", mass[3], exact, 1e-6, "quadrature; Miles 7.9267")
    add("Miles, 100 Hz, Q 10", "RMS, 20 to 2000 Hz, output frequencies [g]", mass[1], exact, 1e-3, "quadrature; Miles 7.9267")
    _, base = solve("gevs", 100., .05, ["TABRND1,7,LOG,LOG", ",20.,.026,50.,.16,800.,.16,2000.,.026", ",ENDT"],
                    ["PARAM,RMSINT,LOGLOG", "FREQ,5,20.,50.,800.,2000."])
    power = math.log(.16 / .026) / math.log(50 / 20), math.log(.026 / .16) / math.log(2000 / 800)
    part = lambda a, b, S, p: S * a / (p + 1) * ((b / a)**(p + 1) - 1)
    exact = math.sqrt(part(20, 50, .026, power[0]) + .16 * 750 + part(800, 2000, .16, power[1]))
    add("GEVS levels", "RMS, 20 to 2000 Hz [g]", base[1], exact, 1e-6, "closed form; GSFC-STD-7000 prints 14.1")


def verify(bough, folder, add):
    for part in (verify_beam, verify_plates, verify_chain, verify_base):
        part(bough, folder, add)
