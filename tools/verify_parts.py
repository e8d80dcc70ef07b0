"""Bodies that `bough split` makes of one deck, far bent: the bend of 45 degrees, a cantilever that rolls to a circle, the free
flight of a flexible beam.

Bathe & Bolourchi, IJNME 14 (1979) 961, as in verify_nonlinear. Simo & Vu-Quoc, J. Appl. Mech. 53 (1986) 855: 10 m, EA = GA =
1e4, EI = 500, rho A = 1, rho I = 10, from (6, 0) to (0, 8), at the lower end a force of 8 along x and a moment of 80 for 2.5 s.
Its reference here is a beam of two-node elements with exact rotations, extrapolated from 40 and 80 of them.
"""
import math
import os
import re

import h5py
import numpy as np
import verify_nonlinear

PARTS = 16
LENGTH, EA, EI, RHO_A, RHO_I, PUSH, TORQUE, PUSH_TIME = 10., 1e4, 500., 1., 10., 8., 80., 2.5
LOWER, UPPER = np.array([6., 0.]), np.array([0., 8.])


def replace_line(text, key, value):
    return re.sub(f"(?m)^{key} = .*", f"{key} = {value}", text)


def read(folder, name):
    with open(os.path.join(folder, name)) as f:
        return f.read()


def write(folder, name, text):
    with open(os.path.join(folder, name), "w") as f:
        f.write(text)


def split(bough, folder, deck, loaded):
    """Splits a deck into 16 bodies; `loaded`: grid by number of a part where loads act."""
    write(folder, "parts.bdf", deck)
    bough(folder, "split", "parts.bdf", "--parts", PARTS, "--no-check")
    for part in range(1, PARTS + 1):
        name = f"parts-{part}.toml"
        if part in loaded:
            text = re.sub("(?m)^# interface = .*", f"interface = [{loaded[part]}]", read(folder, name))
            write(folder, name, text.replace("[body.modes]\n", '[body.modes]\nbasis = "craig-bampton"\n'))
        bough(folder, "reduce", name, "-q")


def write_force(part, node, kind, vector, more=""):
    return (f'\n[[force]]\nname = "{kind}"\nbody = "parts-{part}"\nnode = {node}\n{kind} = {list(map(float, vector))}\n'
            f'frame = "inertial"\n{more}')


def write_place(name, part, node):
    return f'\n[[sensor]]\nname = "{name}"\ntype = "position"\nbody = "parts-{part}"\nnode = {node}\n'


def find_rest(bough, folder, tip, kind, vector, shares):
    """Places of the tip at rest under shares of a dead load there, each from the rest before."""
    places, eta = [], {}
    for share in shares:
        system = replace_line(read(folder, "parts-run.toml"), "gravity", "[0.0, 0.0, 0.0]")
        for part, amplitudes in eta.items():
            line = f'file = "parts-{part}.h5"\n'
            system = system.replace(line, f"{line}eta = {list(map(float, amplitudes))}\n")
        system += write_force(PARTS, tip, kind, share * np.array(vector)) + write_place("tip", PARTS, tip)
        write(folder, "rest.toml", system)
        bough(folder, "equilibrium", "rest.toml", "-o", "rest.h5", "-q")
        with h5py.File(os.path.join(folder, "rest.h5")) as f:
            places.append(f["sensors/tip"][0])
            eta = {part: f[f"bodies/parts-{part}/eta"][0] for part in range(1, PARTS + 1)}
    return places


def write_bars(points, section, more=""):
    E, G, area, inertia, polar, rho = section
    text = f"SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nPARAM,COUPMASS,1\nSPC1,1,123456,1\nMAT1,1,{E:.6e},{G:.6e},,{rho}\n"
    text += f"PBAR,1,1,{area},{inertia:.8e},{inertia:.8e},{polar:.8e}\n{more}"
    for k, x in enumerate(points):
        text += f"GRID*   {k + 1:<16d}{'':16s}{x[0]:<16.9e}{x[1]:<16.9e}\n*       {x[2]:<16.9e}\n"
    return text + "".join(f"CBAR,{k},1,{k},{k + 1},0.,0.,1.\n" for k in range(1, len(points)))


def write_flyer(number):
    points = np.zeros((number + 1, 3))
    points[:, :2] = LOWER + (UPPER - LOWER) * np.linspace(0, 1, number + 1)[:, None]
    text = write_bars(points, (EA, EA, 1., EI / EA, 2 * EI / EA, RHO_A), ",\n,1.,1.\nGRDSET,,,,,,,345\n")
    text = text.replace("SPC = 1\n", "").replace("SPC1,1,123456,1\n", "")
    for k in range(number + 1):
        inertia = RHO_I * LENGTH / number * (0.5 if k in (0, number) else 1)
        text += f"CONM2,{1000 + k},{k + 1},,0.\n,1.-9,,1.-9,,,{inertia:.9g}\n"
    return text + "ENDDATA\n"


def fly_exactly(number, duration):
    """Places of both ends every half second, of `number` elements with one point of integration; RK4."""
    h = LENGTH / number
    q = np.zeros((number + 1, 3))
    q[:, :2] = LOWER + (UPPER - LOWER) * np.linspace(0, 1, number + 1)[:, None]
    q[:, 2] = math.atan2(*(UPPER - LOWER)[::-1])
    share = np.full(number + 1, h)
    share[[0, -1]] /= 2
    mass = np.outer(share, [RHO_A, RHO_A, RHO_I])

    def accelerate(q, is_pushed):
        slope, angle = (q[1:, :2] - q[:-1, :2]) / h, (q[1:, 2] + q[:-1, 2]) / 2
        c, s = np.cos(angle), np.sin(angle)
        axial, shear = EA * (c * slope[:, 0] + s * slope[:, 1] - 1), EA * (c * slope[:, 1] - s * slope[:, 0])
        moment = EI * (q[1:, 2] - q[:-1, 2]) / h
        force = np.column_stack([c * axial - s * shear, s * axial + c * shear])
        couple = h / 2 * (slope[:, 0] * force[:, 1] - slope[:, 1] * force[:, 0])
        f = np.zeros_like(q)
        f[:-1] += np.column_stack([force, couple + moment])
        f[1:] += np.column_stack([-force, couple - moment])
        f[0] += is_pushed * np.array([PUSH, 0, TORQUE])
        return f / mass

    every = 5 * math.ceil(0.5 * number / 0.6)
    step, v, ends = 0.5 / every, np.zeros_like(q), []
    for i in range(round(duration / step) + 1):
        if i % every == 0:
            ends.append(np.concatenate([q[0, :2], q[-1, :2]]))
        pushed = i < round(PUSH_TIME / step)
        a = [accelerate(q, pushed)]
        rates = [v]
        for share_of_step in (0.5, 0.5, 1):
            rates.append(v + share_of_step * step * a[-1])
            a.append(accelerate(q + share_of_step * step * rates[-2], pushed))
        q = q + step / 6 * (rates[0] + 2 * rates[1] + 2 * rates[2] + rates[3])
        v = v + step / 6 * (a[0] + 2 * a[1] + 2 * a[2] + a[3])
    return np.array(ends)


def fly(bough, folder, number, duration):
    split(bough, folder, write_flyer(number), {1: 1, PARTS: number + 1})
    system = replace_line(read(folder, "parts-run.toml"), "gravity", "[0.0, 0.0, 0.0]")
    for key, value in (("duration", duration), ("output_step", 0.5), ("step", 0.0025)):
        system = replace_line(system, key, value)
    function = 'function = "push"\n'
    system += (f'\n[[function]]\nname = "push"\ntype = "table"\nx = [0.0, {PUSH_TIME}, {PUSH_TIME + 1e-6}, {duration}]\n'
               "y = [1.0, 1.0, 0.0, 0.0]\n")
    system += write_force(1, 1, "force", [PUSH, 0, 0], function) + write_force(1, 1, "moment", [0, 0, TORQUE], function)
    write(folder, "fly.toml", system + write_place("lower", 1, 1) + write_place("upper", PARTS, number + 1))
    bough(folder, "run", "fly.toml", "-o", "fly.h5", "-q")
    with h5py.File(os.path.join(folder, "fly.h5")) as f:
        return np.hstack([f["sensors/lower"][:, :2], f["sensors/upper"][:, :2]])


def verify(bough, folder, add):
    case = f"bend of 45°, {PARTS} bodies"
    section = (1e7, 5e6, 1, 1 / 12, 0.1408333)
    turn = np.linspace(0, math.pi / 4, 65)
    points = 100 * np.array([np.sin(turn), 1 - np.cos(turn), 0 * turn]).T
    split(bough, folder, write_bars(points, (*section, 1e-3)) + "ENDDATA\n", {PARTS: 65})
    place = find_rest(bough, folder, 65, "force", [0, 0, 600], (0.3, 0.65, 1))[-1]
    exact = verify_nonlinear.calc_bend(100, math.pi / 4, section, 600)
    for axis in range(3):
        add(case, f"end {'xyz'[axis]}", place[axis], exact[axis], 2e-4, "rod with exact rotations")

    case = f"cantilever rolled up, {PARTS} bodies"
    line = np.outer(np.linspace(0, LENGTH, 65), [1, 0, 0])
    split(bough, folder, write_bars(line, (1e9, 5e8, 1, 1e-5, 2e-5, 1.), "GRDSET,,,,,,,345\n") + "ENDDATA\n", {PARTS: 65})
    half, whole = find_rest(bough, folder, 65, "moment", [0, 0, 2e4 * math.pi / LENGTH], (0.5, 1))
    add(case, "half a circle: end off by / L", np.hypot(half[0], half[1] - 2 * LENGTH / math.pi) / LENGTH, 5e-4, None, "closed form")
    add(case, "circle: end from clamp / L", np.hypot(whole[0], whole[1]) / LENGTH, 1e-8, None, "closed form")

    coarse, fine = fly_exactly(40, 8), fly_exactly(80, 8)
    exact, found = fine + (fine - coarse) / 3, fly(bough, folder, 32, 8)
    for time in (2.5, 5, 8):
        at = round(2 * time)
        off = max(np.hypot(*(found[at] - exact[at])[:2]), np.hypot(*(found[at] - exact[at])[2:])) / LENGTH
        add(f"free-flying beam, {PARTS} bodies", f"ends at {time:g} s, off by / L", off, 1e-3, None,
            "beam with exact rotations; data of Simo & Vu-Quoc 1986")
