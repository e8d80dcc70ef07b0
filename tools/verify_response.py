"""NAFEMS 5H and 5T: the deep beam of FV5 under a uniform load that is harmonic, or begins suddenly (R0016).

The reference is the series of Timoshenko's beam; the printed targets differ from it by up to 1 %.
"""
import math
import os

import h5py
import numpy as np
from scipy.linalg import eigh

E, NU, DENSITY, LENGTH, AREA, INERTIA, KAPPA = 2e11, 0.3, 8000.0, 10.0, 4.0, 4 / 3, 5 / 6
LOAD, DAMPING, NUM_ELEMENTS = 1e6, 0.02, 40
MIDDLE = NUM_ELEMENTS // 2 + 1


def calc_terms(num_terms=400):
    """Modes of the simply supported beam, w = W sin(kx), phi = P cos(kx), of unit modal mass per half length:
    [omega, deflection per modal load at the middle, stress there], with the modal load of the uniform one."""
    terms = []
    G = E / (2 * (1 + NU))
    for n in range(1, num_terms, 2):
        k, sign = n * math.pi / LENGTH, math.sin(n * math.pi / 2)
        shear = KAPPA * G * AREA
        stiffness = [[shear * k * k, -shear * k], [-shear * k, shear + E * INERTIA * k * k]]
        values, shapes = eigh(stiffness, np.diag([DENSITY * AREA, DENSITY * INERTIA]))
        for omega_2, (W, P) in zip(values, shapes.T):
            force = W * 4 * LOAD / (n * math.pi)
            terms.append((math.sqrt(omega_2), force * W * sign, force * E * P * k * sign))   # the outer fibre is 1 away
    return np.array(terms).T


def calc_harmonic(hz):
    """Amplitudes of deflection and stress at the middle."""
    omega, deflection, stress = calc_terms()
    w = 2 * math.pi * hz
    gain = 1 / (omega**2 - w * w + 2j * DAMPING * omega * w)
    return abs(gain @ deflection), abs(gain @ stress)


def calc_step(t):
    """Deflection and stress at the middle after the load has begun."""
    omega, deflection, stress = calc_terms()
    damped = omega * math.sqrt(1 - DAMPING**2)
    rest = np.exp(-DAMPING * np.outer(t, omega)) * (np.cos(np.outer(t, damped)) +
                                                    DAMPING * omega / damped * np.sin(np.outer(t, damped)))
    gain = (1 - rest) / omega**2
    return gain @ deflection, gain @ stress


def write_deck(path, solution, request, cards):
    """In the plane xz; the load is consistent: forces at the grids, moments at the ends."""
    step = LENGTH / NUM_ELEMENTS
    points = ",1.,1.,-1.,1.,1.,-1.,-1.,-1."
    lines = [f"SOL {solution}", "CEND", "SPC = 1", "METHOD = 1", "SDAMPING = 9", "DLOAD = 3", request, "DISPLACEMENT = ALL",
             "STRESS = ALL", "BEGIN BULK", "PARAM,COUPMASS,1", "EIGRL,1,,,16", "TABDMP1,9,CRIT", f",0.,{DAMPING},1.+6,{DAMPING},ENDT",
             f"SPC1,1,1246,1,THRU,{NUM_ELEMENTS + 1}", "SPC1,1,13,1", f"SPC1,1,3,{NUM_ELEMENTS + 1}",
             f"PBEAM,1,1,{AREA},1.33333333,1.33333333,,2.25", points, ",YES,1.", points, f",{KAPPA:.8f},{KAPPA:.8f}",
             f"MAT1,1,2.+11,,{NU},{DENSITY}"]
    for i in range(NUM_ELEMENTS + 1):
        lines.append(f"GRID,{i + 1},,{i * step!r},0.,0.")
        if i < NUM_ELEMENTS:
            lines.append(f"CBEAM,{i + 1},1,{i + 1},{i + 2},0.,1.,0.")
        if 0 < i < NUM_ELEMENTS:
            lines.append(f"DAREA,5,{i + 1},3,{LOAD * step!r}")
    moment = LOAD * step**2 / 12
    lines += [f"DAREA,5,1,5,{-moment:.6f}", f"DAREA,5,{NUM_ELEMENTS + 1},5,{moment:.6f}", *cards, "ENDDATA", ""]
    with open(path, "w") as f:
        f.write("\n".join(lines))


def read_middle(path, axis):
    """The axis of the subcase, deflection and stress of the outer fibre at the middle, complex over frequency."""
    with h5py.File(path) as f:
        case = f["/subcases/1"]
        get = lambda group: group["real"][:] + 1j * group["imag"][:] if "imag" in group else group["value"][:]
        dofs = case["displacement/dofs"][:]
        column = np.flatnonzero((dofs[:, 0] == MIDDLE) & (dofs[:, 1] == 3))[0]
        group = case["stresses/CBEAM"]
        row = np.flatnonzero(group["id"][:] == MIDDLE)[0]
        names = [name.decode() if isinstance(name, bytes) else name for name in group.attrs["components"]]
        return case[axis][:], get(case["displacement"])[:, column], get(group)[:, row, names.index("xx@C_a")]


def verify(bough, folder, add):
    source = "Timoshenko series, kappa 5/6; NAFEMS R0016 prints {}"
    write_deck(os.path.join(folder, "5h.bdf"), 111, "FREQUENCY = 4",
               ["RLOAD1,3,5,,,6", "TABLED1,6", ",0.,1.,1.+6,1.,ENDT", "FREQ1,4,42.4,.001,400", "FREQ,4,0."])
    bough(folder, "frequency", "5h.bdf", "-o", "5h.h5", "-q")
    hz, deflection, stress = read_middle(os.path.join(folder, "5h.h5"), "frequency_hz")
    peak = abs(deflection).argmax()
    grid = np.arange(42.4, 42.8, 0.001)
    exact = np.array([calc_harmonic(f) for f in grid])
    at = exact[:, 0].argmax()
    add("NAFEMS 5H, harmonic", "frequency of the peak [Hz]", hz[peak], grid[at], 1e-3, source.format("42.65"))
    add("NAFEMS 5H, harmonic", "deflection at the middle [mm]", 1e3 * abs(deflection[peak]), 1e3 * exact[at, 0], 2e-3,
        source.format("13.45"))
    add("NAFEMS 5H, harmonic", "stress at the middle [N/mm2]", 1e-6 * abs(stress).max(), 1e-6 * exact[:, 1].max(), 2e-3,
        source.format("241.9"))
    add("NAFEMS 5T, step", "static deflection [mm]", 1e3 * abs(deflection[hz == 0][0]), 1e3 * calc_harmonic(0)[0], 2e-3,
        source.format("0.538"))
    write_deck(os.path.join(folder, "5t.bdf"), 112, "TSTEP = 4",
               ["TLOAD1,3,5,,0,6", "TABLED1,6", ",-1.,1.,1.+6,1.,ENDT", "TSTEP,4,1000,.00002,1"])
    bough(folder, "transient", "5t.bdf", "-o", "5t.h5", "-q")
    t, deflection, stress = read_middle(os.path.join(folder, "5t.h5"), "time")
    exact, exact_stress = calc_step(np.linspace(0, 0.02, 2001))
    add("NAFEMS 5T, step", "largest deflection at the middle [mm]", 1e3 * abs(deflection).max(), 1e3 * exact.max(), 2e-3,
        source.format("1.043"))
    add("NAFEMS 5T, step", "time of it [s]", t[abs(deflection).argmax()], 1e-5 * exact.argmax(), 1e-2, source.format("0.0117"))
    add("NAFEMS 5T, step", "largest stress at the middle [N/mm2]", 1e-6 * abs(stress).max(), 1e-6 * exact_stress.max(), 5e-3,
        source.format("18.76"))
