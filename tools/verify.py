"""Runs the verification cases through the program and writes docs/verification/README.md: our number next to the reference.

    /usr/bin/python3 tools/verify.py build/bin/bough --write     (./dev build first; without --write it only checks)

With --quick plates run on the finest mesh of each ladder only.

Exit 1 when a number is outside its tolerance.
"""
import json
import math
import os
import platform
import shutil
import sys
import tempfile

import h5py
import numpy as np
from scipy.linalg import eigh
from scipy.optimize import brentq

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../tests/support"))
import demo_report
import served
import spinup_numbers
import verify_flight
import verify_nonlinear
import verify_orbit
import verify_parts
import verify_plates
import verify_random
import verify_response
import verify_rotor
import verify_shock

ROOT = spinup_numbers.ROOT
PROGRAM = os.path.abspath(sys.argv[1])
ROWS = []


def bough(folder, *arguments):
    return served.run([PROGRAM, *map(str, arguments)], cwd=folder, check=True).stdout


def add(case, quantity, computed, reference, tolerance, source):
    """tolerance relative; None: `computed` must stay below `reference`."""
    if tolerance is None:
        passed, error, allowed = computed < reference, "", f"< {reference:g}"
    else:
        off = abs(computed - reference) / abs(reference)
        passed, error, allowed = off <= tolerance, f"{100 * off:.4f} %", f"{100 * tolerance:g} %"
    shown = f"{reference:.6g}" if tolerance is not None else "0"
    ROWS.append((case, quantity, f"{computed:.6g}", shown, error, allowed, "pass" if passed else "FAIL", source))


def modes(deck, *options):
    return json.loads(bough(os.path.join(ROOT, "data/decks"), "modes", deck, "--json", *options))


def verify_modes():
    boom = json.loads(bough(os.path.join(ROOT, "data/examples/ex01-spinup"), "modes", "boom.bdf", "--json"))
    for k, (value, exact) in enumerate(zip(boom["eigenvalue"], [2.91022, 18.2380, 51.067])):
        add("boom of ex01, 40 CBAR", f"mode {k + 1} [rad/s]", math.sqrt(value), exact, 2e-4, "closed form")
    free = modes("free-free.bdf", "-n", 12)
    add("free-free beam", "rigid-body modes", free["num_rigid_modes"], 6, 0, "six")
    square = [math.sqrt(v) for v in free["eigenvalue"][6:]]
    for k, exact in enumerate([4.7300407**2, 7.8532046**2, 10.9956078**2]):
        add("free-free beam", f"(beta L)^2, mode {k + 1}", square[2 * k], exact, 1e-4, "closed form")
    for k, value in enumerate(modes("fv2.bdf")["frequency_hz"]):
        stretches = k in (1, 2, 9, 10)
        exact = ([11.33625] + [17.70938] * 7 + [45.34498] + [57.38973] * 7)[k]
        add("NAFEMS FV2", f"mode {k + 1} [Hz]", value, exact, 6e-3 if stretches else 1e-4,
            "clamped-pinned beam; here the arms stretch too" if stretches else "pinned and clamped-pinned beams")
    for k, (value, target) in enumerate(zip(modes("fv4.bdf")["frequency_hz"], [1.723, 1.727, 7.413, 9.972, 18.155, 26.957])):
        add("NAFEMS FV4", f"mode {k + 1} [Hz]", value, target, 5e-4, "published target")
    for k, (value, exact) in enumerate(zip(modes("fv5.bdf")["frequency_hz"],
                                           [42.609, 42.609, 77.522, 125.00, 147.786, 147.786, None, 282.36, 282.36])):
        if exact is not None:
            add("NAFEMS FV5", f"mode {k + 1} [Hz]", value, exact, 1e-3, "Timoshenko theory, kappa 5/6")


def verify_buckling():
    euler = math.pi**2 * 700 / 100
    for deck, factor in [("euler-pinned.bdf", 1), ("euler-cantilever.bdf", 0.25)]:
        found = modes(deck, "--buckling")["load_factor"][0]
        add("Euler column", deck[6:-4], found, factor * euler, 1e-3, "pi^2 EI / L^2")


FLAP_0 = {1: 3.68165, 4: 5.58500, 8: 9.25684, 12: 13.17015}
FLAP_0_2 = {1: 22.18101, 4: 24.27335, 8: 29.99538, 12: 37.60311}
FLAP_1 = {1: 3.88882, 4: 7.47505, 8: 13.50739, 12: 19.72154}
CHORD_0 = {1: 3.54324, 4: 3.89772, 8: 4.65715, 12: 5.42705}


def verify_rotating(folder):
    source = "Wright, Smith, Thresher & Wang 1982, recomputed"
    bough(folder, "reduce", os.path.join(ROOT, "data/decks/rotating.bdf"), "--modes", 20, "-o", "rotating.h5")
    with h5py.File(os.path.join(folder, "rotating.h5")) as f:
        K, kg, phi = f["/modal/stiffness"][:], f["/stiffening/kg_inertial"][:], f["/modes/phi"][:]
    flap = np.abs(phi[:, 2, :]).max(axis=0) > np.abs(phi[:, 1, :]).max(axis=0)

    def calc(eta, hub, which):
        # spin about z: a_o = -eta^2 hub x, and A_I(wz^2) = eta^2; in the plane the spin softens by eta^2 M
        total = K + eta**2 * (kg[8] - hub * kg[0])
        block = total[np.ix_(which, which)] - (0 if which is flap else eta**2) * np.eye(which.sum())
        return np.sqrt(np.linalg.eigvalsh(block))

    for eta in FLAP_0:
        found = calc(eta, 0, flap)
        add("rotating cantilever, hub 0", f"flap 1 at eta {eta}", found[0], FLAP_0[eta], 1e-3, source)
        add("rotating cantilever, hub 0", f"flap 2 at eta {eta}", found[1], FLAP_0_2[eta], 5e-3, source)
        add("rotating cantilever, hub 0", f"chord 1 at eta {eta}", calc(eta, 0, ~flap)[0], CHORD_0[eta], 1e-3, source)
        add("rotating cantilever, hub 1", f"flap 1 at eta {eta}", calc(eta, 1, flap)[0], FLAP_1[eta], 1e-3, source)


def verify_spinup(folder):
    for name in os.listdir(os.path.join(ROOT, "data/examples/ex01-spinup")):
        shutil.copy(os.path.join(ROOT, "data/examples/ex01-spinup", name), folder)
    bough(folder, "reduce", "boom.toml")
    bough(folder, "reduce", "boom-order3.toml")
    for name in ["spinup", "spinup-no-kg", "spinup-order3"]:
        bough(folder, "run", name + ".toml", "-o", name + ".h5")
    path = lambda name: os.path.join(folder, name)
    for name, value, expected, _, tolerance, _ in spinup_numbers.compare(
            spinup_numbers.calc_numbers(path("spinup.h5"), path("spinup-no-kg.h5"), path("boom.h5"),
                                        path("spinup-order3.h5"))):
        if "frequencies" not in name:
            add("spin-up, ex01, 3 modes", demo_report.LABELS[name], value, expected, tolerance, "linear rotating-beam theory; exact beam")
    with open(path("spinup-order3.toml")) as f:
        text = f.read().replace("rate = 4.0", "rate = 6.0").replace("duration = 20.0", "duration = 7.2")
    with open(path("third-spin.toml"), "w") as f:
        f.write(text)
    bough(folder, "run", "third-spin.toml", "-o", "third.h5")
    with h5py.File(path("third.h5")) as f:
        minimum, _ = spinup_numbers.calc_minimum(f["/time"][:], f["/sensors/tip_deflection"][:, 1])
    add("spin-up, ex01, 3 modes, order 3", "minimum of the tip deflection, 6 rad/s [m]", minimum, -0.75089, 2e-4,
        "geometrically exact beam")
    bough(folder, "reduce", os.path.join(ROOT, "data/decks/spinup10.bdf"), "--modes", 7, "--interface", 41, "-o", "boom.h5")
    with open(path("spinup.toml")) as f:
        second = f.read().replace("rate = 4.0", "rate = 6.0")
    with open(path("second.toml"), "w") as f:
        f.write(second)
    bough(folder, "run", "second.toml", "-o", "second.h5")
    with h5py.File(path("second.h5")) as f:
        t, tip = f["/time"][:], f["/sensors/tip_deflection"][:]
    minimum, when = spinup_numbers.calc_minimum(t, tip[:, 1])
    add("second spin-up, L = 10, 7 modes", "minimum [m]", minimum, -0.5744, 5e-3, "7 modes with K_G, recomputed")
    add("second spin-up, L = 10, 7 modes", "time of it [s]", when, 6.763, 5e-3, "the same")
    add("second spin-up, L = 10, 7 modes", "foreshortening [m]", float(np.interp(when, t, tip[:, 0])), -0.0189, 3e-2,
        "geometrically exact chain")
    deck = os.path.join(ROOT, "data/decks/spinup10.bdf")
    with open(path("third.toml"), "w") as f:
        f.write(f'[body]\nname = "boom"\ndeck = "{deck}"\nframe = "fixed"\ninterface = [41]\n[body.modes]\nnumber = 5\n'
                "[body.stiffening]\norder = 3\n")
    bough(folder, "reduce", "third.toml", "-o", "boom.h5")
    bough(folder, "run", "second.toml", "-o", "second.h5")
    with h5py.File(path("second.h5")) as f:
        minimum, when = spinup_numbers.calc_minimum(f["/time"][:], f["/sensors/tip_deflection"][:, 1])
    source = "the same modes of an inextensible beam; data of Simo & Vu-Quoc 1986"
    add("second spin-up, 5 modes, order 3", "minimum [m]", minimum, -0.573758, 2e-4, source)
    add("second spin-up, 5 modes, order 3", "time of it [s]", when, 6.7617, 2e-4, source)


def verify_hub(folder):
    for name in os.listdir(os.path.join(ROOT, "data/examples/ex02-hub")):
        shutil.copy(os.path.join(ROOT, "data/examples/ex02-hub", name), folder)
    bough(folder, "reduce", "boom.toml")
    with h5py.File(os.path.join(folder, "boom.h5")) as f:
        K, kg = f["/modal/stiffness"][:], f["/stiffening/kg_inertial"][:]
    # The root is at 10 m and x points inwards: a_o = +10 W^2 x.
    lowest = lambda W: np.linalg.eigvalsh(K + W**2 * (kg[8] + 10 * kg[0]) - W**2 * np.eye(len(K)))[0]
    add("boom inside a hub, ex02", "critical rate [rad/s]", brentq(lowest, 1.5, 3), 2.186, 1e-3,
        "NASA-CR-202063 4.1.4.2; its rim of 10 m is inferred")
    for rate in ["2.18", "2.19"]:
        bough(folder, "run", f"hub-{rate}.toml", "-o", f"{rate}.h5")
        with h5py.File(os.path.join(folder, f"{rate}.h5")) as f:
            tip = np.abs(f["/sensors/tip_deflection"][:, 1])
        if rate == "2.18":
            add("boom inside a hub, ex02", "largest tip deflection at 2.18 rad/s [m]", tip.max(), 0.1, None, "bounded")
        else:
            add("boom inside a hub, ex02", "1 / last tip deflection at 2.19 rad/s [1/m]", 1 / tip[-1], 1.0, None, "unbounded")


def verify_two_link(folder):
    sys.path.insert(0, os.path.join(ROOT, "tests/cli"))
    import chain
    for name in os.listdir(os.path.join(ROOT, "data/examples/ex03-two-link")):
        shutil.copy(os.path.join(ROOT, "data/examples/ex03-two-link", name), folder)
    bough(folder, "reduce", "link.toml")
    bough(folder, "run", "two-link.toml", "-o", "two-link.h5")
    with h5py.File(os.path.join(folder, "two-link.h5")) as f:
        t, tip, kinetic = f["/time"][:], f["/sensors/tip_position"][:], f["/energy/kinetic"][:].ravel()
        total = kinetic + f["/energy/strain"][:].ravel() + f["/energy/potential"][:].ravel()
    first = t <= 1.0
    path = chain.simulate(16, 1.0, 0.216, 7.0e10 * 1.06667e-10, 9.81, t[first])[:, 1]
    add("two links, ex03", "energy drift / largest kinetic energy", np.abs(total - total[0]).max() / kinetic.max(), 1e-9, None,
        "conservation")
    add("two links, ex03", "tip path off the chain of rigid pieces, first second [m]",
        np.linalg.norm(tip[first, :2] - path, axis=1).max(), 1e-3, None, "tests/cli/chain.py")


def verify_free_flyer(folder):
    for name in os.listdir(os.path.join(ROOT, "data/examples/ex04-free-flyer")):
        shutil.copy(os.path.join(ROOT, "data/examples/ex04-free-flyer", name), folder)
    bough(folder, "reduce", "flyer.toml")
    bough(folder, "run", "free-flyer.toml", "-o", "free-flyer.h5")
    with h5py.File(os.path.join(folder, "free-flyer.h5")) as f:
        energy = f["/energy/kinetic"][:].ravel() + f["/energy/strain"][:].ravel()
        momenta = [f["/momentum/linear"][:], f["/momentum/angular"][:]]
    add("free flyer, ex04", "energy drift in 5 s", np.abs(energy / energy[0] - 1).max(), 1e-9, None, "conservation")
    for name, m in zip(["linear", "angular"], momenta):
        add("free flyer, ex04", f"{name} momentum drift in 5 s",
            np.linalg.norm(m - m[0], axis=1).max() / np.linalg.norm(m[0]), 1e-9, None, "conservation")


def verify_plate(folder):
    for name in os.listdir(os.path.join(ROOT, "data/examples/ex05-plate")):
        shutil.copy(os.path.join(ROOT, "data/examples/ex05-plate", name), folder)
    bough(folder, "reduce", "plate.toml")
    with h5py.File(os.path.join(folder, "plate.h5")) as f:
        at = list(f["/stiffening/locator/name"].asstr()).index("running")
        critical = -1 / eigh(f["/stiffening/kg_external"][at], f["/modal/stiffness"][:], eigvals_only=True)[0]
    add("plate of ex05, 24 x 16", "critical running load, 10 modes [lb/in]", critical, 0.16753, 0.01, "k pi^2 D / b^2; NASTRAN in NASA-CR-202063: 0.167")


def verify_blade(folder):
    """Ω L² √(m/EI) is 12 in flap and 2 in lag, √(EI/m)/L² is 3 and 18 rad/s."""
    for name in os.listdir(os.path.join(ROOT, "data/examples/ex11-rotor-blade")):
        shutil.copy(os.path.join(ROOT, "data/examples/ex11-rotor-blade", name), folder)
    bough(folder, "reduce", "blade.toml")
    bough(folder, "linearize", "rotor.toml", "--at", 4, "-o", "at-speed.h5")
    with h5py.File(os.path.join(folder, "at-speed.h5")) as f:
        omega = 2 * math.pi * np.sort(f["/poles/frequency_hz"][:])[::2]
    for k, (mode, exact) in enumerate([("flap 1", 3 * 13.17015), ("lag 1", 18 * 3.62180), ("flap 2", 3 * 37.60311)]):
        add("rotor blade, ex11", f"{mode} at 36 rad/s [rad/s]", omega[k], exact, 1e-3,
            "Wright, Smith, Thresher & Wang 1982, recomputed")
    bough(folder, "run", "rotor.toml", "-o", "rotor.h5")
    with h5py.File(os.path.join(folder, "rotor.h5")) as f:
        tip = f["/sensors/tip"][:, 2][f["/time"][:] > 7].mean()
    add("rotor blade, ex11", "tip under 300 N/m at 36 rad/s [m]", tip, 0.034528, 0.01, "EI w'''' - (T w')' = p, by scipy")


def describe_program():
    lines = bough(".", "--version").strip().split("\n")
    return ", ".join(line for line in lines if line.split()[0] in ("bough", "PETSc", "SLEPc", "SUNDIALS"))


def describe_machine():
    with open("/proc/cpuinfo") as f:
        names = [line.split(":")[1].strip() for line in f if line.startswith("model name")]
    system = platform.freedesktop_os_release()["PRETTY_NAME"].split(" (")[0]
    return f"{system}, {names[0] if names else platform.machine()}"


HEAD = """# Verification: our number next to the reference

Written by `./dev docs` (`tools/verify.py`) from runs of the program on data/decks, data/examples and decks that
`tools/verify_*.py` write. The test cli.verification runs them all; what is allowed is in these scripts, before a run.
A row passes when the error is within what is allowed; a reference of 0 with a bound says that the number must stay
below it.

Version of this table: {versions}.
Machine: {machine}.

Deviations known and left: FV2 modes 2, 3, 10 and 11 are a little below the clamped-pinned beam, since the arms also
stretch there. FV4's targets have the rotary inertia of the section, as CBEAM has. FV5 takes the polar moment of area as
torsion constant, as its target does; a square section has less. The printed targets of FV12, FV15, FV16 and FV22 are up
to 2.2 % off converged theory (tests/oracle/plate_ritz.py). The rotors' printed numbers are those of six elements, with
the gyroscopic moment of the shaft, which the decks have and the systems leave out. References are exact theory where it
exists, not printed targets; nothing is tuned.

![Spin-up of ex01: three modes, the same without geometric stiffness, theory](../figure5.svg)

![Tip of the boom inside a hub, ex02, below and above the critical rate](../figure8.svg)

![Deflection of the plate of ex05 after a tap, below and above the critical load](../figure10.svg)

![Flap and lag of the blade of ex11 over the speed](../pictures/campbell.png)

| case | quantity | computed | reference | error | allowed | | source |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""

verify_modes()
verify_buckling()
for verify in [verify_rotating, verify_spinup, verify_hub, verify_two_link, verify_free_flyer, verify_plate, verify_blade]:
    with tempfile.TemporaryDirectory() as scratch:
        verify(scratch)
for cases in [verify_response, verify_random, verify_shock, verify_rotor, verify_nonlinear, verify_parts, verify_flight, verify_orbit]:
    with tempfile.TemporaryDirectory() as scratch:
        cases.verify(bough, scratch, add)
with tempfile.TemporaryDirectory() as scratch:
    verify_plates.verify(PROGRAM, scratch, add, "--quick" in sys.argv[2:])
if "--write" in sys.argv[2:]:
    with open(os.path.join(ROOT, "docs/verification/README.md"), "w") as page:
        page.write(HEAD.format(versions=describe_program(), machine=describe_machine()) + "".join("| " + " | ".join(row) + " |\n" for row in ROWS))
failed = [row for row in ROWS if row[6] != "pass"]
print(f"{len(ROWS)} rows, {len(failed)} failed")
for row in failed:
    print(row)
sys.exit(1 if failed else 0)
