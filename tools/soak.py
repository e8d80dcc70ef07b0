"""Random systems, end to end: decks, bodies, hinges, loops, forces, events, controllers, each run two ways.

    /usr/bin/python3 tools/soak.py build/bin/bough [--minutes 5] [--seed 1] [--keep FOLDER]

Each seed has three structures of its own, reduced from their decks, beside two rods. Its system is run by an explicit
and by an implicit integrator at tight tolerances. Both must end alike (exit 0, or 1 or 3 with an error that is named),
the sensors must agree ("sensitive": rk differs as much from itself at 1e-10), the energy balance must close. A system
that fails is made smaller as long as it fails the same way, and kept with its seed. Exit 1 when there was one. --write
puts the counts into docs/verification/robustness.md.
"""
import collections
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

from robustness_page import make_parser, write_table

HINGES = {"fixed": 0, "revolute": 1, "prismatic": 1, "universal": 2, "cylindrical": 2, "planar": 3, "spherical": 3,
          "free": 6, "screw": 1, "gimbal": 3, "general": 3}
ERRORS = re.compile(r"error: .*\[([a-z]+\.[a-z0-9-]+)\]")
ROD = """SOL 103
CEND
BEGIN BULK
GRID,1,,0.,0.,0.,,{held}
GRID,2,,.25,0.,0.
GRID,3,,.5,0.,0.
GRID,4,,.75,0.,0.
GRID,5,,1.,0.,0.
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
CBAR,3,1,3,4,0.,0.,1.
CBAR,4,1,4,5,0.,0.,1.
PBAR,1,1,1.-3,2.-7,3.-7,4.-7
MAT1,1,7.+10,,.3,2700.
{lumps}
ENDDATA
"""


def make_lumps(num_grids):
    """A little mass and inertia on every grid: bars by themselves have no inertia about their line, where a hinge may
    turn, and few masses are moved by few modes as by a hinge."""
    return "\n".join(f"CONM2,{200 + k},{k},,.02\n,2.-5,,2.-5,,,2.-5" for k in range(1, num_grids + 1))


def make_deck(seed):
    """A small structure of bars, some with a plate, masses on arms, rigid links and springs, and grids to hold it by:
    text, its grids, whether it is clamped."""
    r = random.Random(f"deck {seed}")
    cards, number = [], 100
    points = [(0.0, 0.0, 0.0)]
    for k in range(r.randint(2, 5)):
        a = r.randrange(len(points))
        step = [r.uniform(-0.5, 0.5) for _ in range(3)]
        size = sum(x * x for x in step) ** 0.5
        points.append(tuple(round(p + x * r.uniform(0.2, 0.5) / size, 4) for p, x in zip(points[a], step)))
        roll = sorted(range(3), key=lambda i: abs(step[i]))[0]
        axis = ["0.", "0.", "0."]
        axis[roll] = "1."
        cards.append(f"{r.choice(['CBAR', 'CBEAM'])},{k + 1},1,{a + 1},{len(points)},{','.join(axis)}")
    beams = any(c.startswith("CBEAM") for c in cards)
    bars = any(c.startswith("CBAR") for c in cards)
    i1, i2 = round(r.uniform(1, 5), 2), round(r.uniform(1, 5), 2)
    if beams and bars:  # one property serves one kind
        cards, beams = [c.replace("CBEAM", "CBAR") for c in cards], False
    cards.append(f"PBEAM,1,1,1.-4,{i1}-8,{i2}-8,,4.-8" if beams else f"PBAR,1,1,1.-4,{i1}-8,{i2}-8,4.-8")
    if r.random() < 0.3:
        at, n = points[-1], len(points)
        points += [(at[0] + 0.2, at[1], at[2]), (at[0] + 0.2, at[1] + 0.2, at[2]), (at[0], at[1] + 0.2, at[2])]
        cards += [f"CQUAD4,80,2,{n},{n + 1},{n + 2},{n + 3}", "PSHELL,2,1,.003,1,,1"]
    if r.random() < 0.4:
        cards.append(f"CONM2,90,{r.randint(1, len(points))},,{r.uniform(0.05, 0.5):.3f},{r.uniform(-0.1, 0.1):.3f},"
                     f"{r.uniform(-0.1, 0.1):.3f},0.05\n,1.-4,,1.2-4,,,1.3-4")
    if r.random() < 0.4:
        at = points[-1]
        points.append(tuple(round(x + r.uniform(0.05, 0.2), 4) for x in at))
        cards += [f"{r.choice(['RBE2,91,%d,123456,%d', 'RBAR,91,%d,%d,123456'])}" % (len(points) - 1, len(points)),
                  f"CONM2,92,{len(points)},,0.2\n,1.-4,,1.-4,,,1.-4"]
    if r.random() < 0.2:
        number = len(points)
        cards.append(f"CELAS2,93,{r.uniform(100, 1000):.1f},{number},{r.randint(1, 3)},1,{r.randint(1, 3)}")
    clamped = r.random() < 0.5
    grids = [f"GRID,{k + 1},,{x:.4f},{y:.4f},{z:.4f},,{'123456' if clamped and k == 0 else ''}"
             for k, (x, y, z) in enumerate(points)]
    text = "\n".join(["SOL 103", "CEND", "BEGIN BULK", *grids, *cards, make_lumps(len(points)),
                      "MAT1,1,7.+10,,.3,2700.", "ENDDATA", ""])
    return text, sorted(r.sample(range(2, len(points) + 1), min(2, len(points) - 1))), clamped


class Draw:
    def __init__(self, seed):
        self.r = random.Random(seed)

    def vector(self, size=1.0):
        return [round(self.r.uniform(-size, size), 4) for _ in range(3)]

    def axis(self):
        while True:
            v = self.vector()
            if sum(x * x for x in v) > 0.1:
                return v

    def chance(self, p):
        return self.r.random() < p


def make_system(seed, bodies_of):
    """A dict of lists of tables, as TOML has them."""
    d = Draw(seed)
    r = d.r
    system = {"body": [], "hinge": [], "constraint": [], "function": [], "force": [], "sensor": [], "controller": [],
              "actuator": [], "event": []}
    names = []
    for i in range(r.randint(1, 6)):
        name = f"b{i}"
        if d.chance(0.35):
            kind = r.choice(list(bodies_of))
            body = {"name": name, "file": kind, "damping": round(r.uniform(0, 0.02), 4)}
            nodes = bodies_of[kind]
        else:
            a, b, c = (r.uniform(0.1, 1) for _ in range(3))  # second moments of a body that can exist
            m = round(r.uniform(0.2, 3), 3)
            body = {"name": name, "mass": m, "cg": d.vector(0.4),
                    "inertia": [round(m * x, 5) for x in (b + c, a + c, a + b)],
                    "nodes": [{"id": 1, "position": d.vector(1)}, {"id": 2, "position": d.vector(1)}]}
            nodes = [0, 1, 2]
        system["body"].append(body)
        parent = r.choice(["ground"] + [n for n, _ in names] * 2) if names else "ground"
        at = dict(names).get(parent, [0])
        kind = r.choice(list(HINGES) if parent == "ground" else [k for k in HINGES if k != "free"] + ["revolute"] * 3)
        hinge = {"name": f"h{i}", "type": kind, "parent": parent, "child": name, "parent_node": r.choice(at),
                 "child_node": r.choice(nodes)}
        if parent == "ground":
            hinge["parent_position"] = d.vector(2)
        if d.chance(0.5):
            hinge["parent_rotation"] = d.vector(1)
        if kind in ("revolute", "prismatic", "cylindrical", "screw", "planar", "universal"):
            hinge["axis"] = d.axis()
        if kind == "universal":
            hinge["axis2"] = d.axis()
        if kind == "screw":
            hinge["pitch"] = round(r.uniform(0.05, 0.3), 3)
        if kind == "general":
            hinge["rotations"], hinge["translations"] = r.choice(["x", "z"]), r.choice(["xy", "zx"])
        num = HINGES[kind]
        if num:
            hinge["rate"] = [round(r.uniform(-1, 1), 3) for _ in range(num)]
            if kind not in ("spherical", "free"):
                hinge["position"] = [round(r.uniform(-0.5, 0.5), 3) for _ in range(num)]
                if d.chance(0.5):
                    hinge["stiffness"] = round(r.uniform(0, 20), 2)
                if d.chance(0.3):
                    hinge["damping"] = round(r.uniform(0, 0.5), 3)
                if d.chance(0.1):
                    hinge["rotor_inertia"] = round(r.uniform(0, 0.2), 3)
            if d.chance(0.1):
                hinge["locked"] = True
                hinge.pop("rate")
                system["event"].append({"name": f"release{i}", "time": round(r.uniform(0.05, 0.3), 3),
                                        "action": "release", "hinge": hinge["name"]})
            elif d.chance(0.1) and num == 1:
                system["function"].append({"name": f"move{i}", "type": "sine", "amplitude": 0.2, "omega": 3.0})
                hinge["motion"] = f"move{i}"
                hinge.pop("rate")
                hinge.pop("position", None)
        system["hinge"].append(hinge)
        names.append((name, nodes))

    def end():
        name, nodes = r.choice(names)
        return name, r.choice(nodes)

    if d.chance(0.35):
        (a, i), (b, j) = end(), end()
        system["constraint"].append({"name": "loop", "type": r.choice(["spherical", "point_on_plane", "point_on_line"]),
                                     "parent": "ground", "child": a, "child_node": i, "parent_position": d.vector(1),
                                     "axis": d.axis()})
        if system["constraint"][-1]["type"] == "spherical":
            system["constraint"][-1].pop("axis")
        if d.chance(0.3) and a != b:
            system["constraint"].append({"name": "rod", "type": "distance", "parent": a, "parent_node": i, "child": b,
                                         "child_node": j, "length": round(r.uniform(0.5, 2), 2)})
    for k in range(r.choice([0, 0, 1, 2])):
        (a, i), (b, j) = end(), end()
        if d.chance(0.5):
            force = {"name": f"f{k}", "type": "spring", "body": a, "node": i, "stiffness": round(r.uniform(1, 30), 2),
                     "free_length": round(r.uniform(0, 1), 2), "damping": round(r.uniform(0, 1), 2)}
            if a == b:
                force["to_position"] = d.vector(3)
            else:
                force.update(to_body=b, to_node=j)
        else:
            force = {"name": f"f{k}", "body": a, "node": i, "force": d.vector(2),
                     "frame": r.choice(["inertial", "body"])}
        system["force"].append(force)
    a, i = end()
    system["sensor"].append({"name": "s", "type": "position", "body": a, "node": i})
    driven = [h for h in system["hinge"] if HINGES[h["type"]] and h["type"] not in ("spherical", "free") and
              "motion" not in h and "locked" not in h]
    if driven and d.chance(0.35):
        h = r.choice(driven)["name"]
        system["sensor"].append({"name": "angle", "type": "hinge_angle", "hinge": h, "coordinate": 1})
        law = {"name": "law", "type": "pid", "inputs": "angle", "kp": round(r.uniform(0, 5), 2),
               "kd": round(r.uniform(0, 0.5), 2), "filter": 0.05, "setpoint": round(r.uniform(-0.3, 0.3), 2)}
        if d.chance(0.5):
            law["sample_time"] = 0.05
        system["controller"].append(law)
        system["actuator"].append({"name": "motor", "type": "hinge", "hinge": h, "input": "law"})
    system["simulation"] = {"duration": 0.6, "output_step": 0.02, "relative_tolerance": 1e-9,
                            "absolute_tolerance": 1e-11}
    if d.chance(0.6):
        system["simulation"]["gravity"] = d.vector(9.81)
    return system


def to_toml(system, integrator):
    def value(v):
        if isinstance(v, dict):
            return "{" + ", ".join(f"{k} = {value(x)}" for k, x in v.items()) + "}"
        if isinstance(v, list):
            return "[" + ", ".join(value(x) for x in v) + "]"
        return json.dumps(v)

    lines = []
    for kind, tables in system.items():
        for table in tables if isinstance(tables, list) else [dict(tables, integrator=integrator)]:
            lines.append(f"[[{kind}]]" if isinstance(tables, list) else f"[{kind}]")
            lines += [f"{k} = {value(v)}" for k, v in table.items()] + [""]
    return "\n".join(lines)


class Soak:
    def __init__(self, options):
        self.program, self.keep = os.path.abspath(options.program), options.keep
        self.timeout, self.write_page = options.timeout, options.write
        self.folder = tempfile.mkdtemp(prefix="soak-")
        self.bodies = {}
        for name, held in (("clamped", "123456"), ("free", "")):
            self.add_body(name, ROD.format(held=held, lumps=make_lumps(5)), [1, 3, 5], [3, 5], bool(held))
        self.known, self.decks = dict(self.bodies), collections.Counter()

    def add_body(self, name, deck, held, nodes, clamped):
        with open(os.path.join(self.folder, name + ".bdf"), "w", encoding="ascii") as out:
            out.write(deck)
        with open(os.path.join(self.folder, name + ".toml"), "w", encoding="ascii") as out:
            out.write(f'[body]\nname = "{name}"\ndeck = "{name}.bdf"\ninterface = {held}\n' +
                      ("" if clamped else 'frame = "free"\n') + "[body.modes]\nnumber = 4\n"
                      f"[body.output]\nnodes = {held}\n")
        ran = subprocess.run([self.program, "reduce", name + ".toml", "-q", "-o", name + ".h5"], cwd=self.folder,
                             capture_output=True, text=True)
        if ran.returncode == 0:
            self.bodies[name + ".h5"] = [0, *nodes] if clamped else nodes
        return ran

    def renew_bodies(self, seed):
        """The two rods and three structures of their own; what is wrong with one that no body was made of."""
        self.bodies = dict(self.known)
        for k in range(3):
            deck, nodes, clamped = make_deck(3 * seed + k)
            ran = self.add_body(f"deck{k}", deck, sorted({1, *nodes}) if clamped else nodes, nodes, clamped)
            errors = ERRORS.findall(ran.stderr)
            self.decks["reduced" if ran.returncode == 0 else errors[0] if errors else "unnamed"] += 1
            if ran.returncode not in (0, 1, 3) or (ran.returncode and not errors):
                return f"deck {3 * seed + k}: reduce: exit {ran.returncode}: {ran.stderr.strip()[-300:]}"
        return None

    def run(self, system, integrator):
        path = os.path.join(self.folder, integrator + ".toml")
        with open(path, "w", encoding="utf-8") as out:
            out.write(to_toml(system, integrator))
        results = path[:-5] + "-out.h5"
        if os.path.exists(results):
            os.remove(results)
        try:
            ran = subprocess.run([self.program, "run", path, "-o", results], cwd=self.folder, capture_output=True,
                                 text=True, timeout=self.timeout)
        except subprocess.TimeoutExpired:
            return "slow", [], None, ""
        errors = ERRORS.findall(ran.stderr)
        return ran.returncode, errors, results if os.path.exists(results) else None, ran.stderr

    def judge(self, system):
        """None, or what is wrong in a few words that do not depend on the numbers."""
        ends = {}
        for integrator in ("rk", "bdf"):
            code, errors, results, said = self.run(system, integrator)
            if code == "slow":
                self.outcome = "slow"
                return None
            if code not in (0, 1, 3):
                return f"{integrator}: exit {code}"
            if code and not errors:
                return f"{integrator}: exit {code} without an error"
            self.said = said
            ends[integrator] = (code, errors, results)
        (a, a_errors, a_results), (b, b_errors, b_results) = ends["rk"], ends["bdf"]
        self.outcome = a_errors[0] if a_errors else b_errors[0] if b_errors else "equal"
        if a == 1 or b == 1:
            return None if a == b else f"rk: exit {a}, bdf: exit {b} {a_errors or b_errors}"
        if a == 3 and b == 3:
            return None
        if a != b:
            return f"rk: exit {a}, bdf: exit {b} {(a_errors or b_errors)[0]}"
        with h5py.File(a_results) as f, h5py.File(b_results) as g:
            x, y = f["sensors/s"][:], g["sensors/s"][:]
            if x.shape != y.shape:
                return "rk and bdf: other samples"
            size = max(1.0, np.abs(x).max())
            if not np.isfinite(x).all():
                return "not a number in the results"
            differ = np.abs(x - y).max() > 2e-4 * size
            for name, h in (("rk", f), ("bdf", g)):
                error = float(h["energy"].attrs.get("energy_error", 0))
                if not error < 1e-4:
                    return f"{name}: energy balance"
        if differ and self.is_sensitive(system, x):
            self.outcome = "sensitive"
            differ = False
        return "rk and bdf differ" if differ else None

    def is_sensitive(self, system, x):
        """Whether the tolerance alone moves the samples x of rk as far: no integrator can be told right from wrong."""
        closer = dict(system, simulation=dict(system["simulation"], relative_tolerance=1e-10, absolute_tolerance=1e-12))
        code, _, results, _ = self.run(closer, "rk")
        if code != 0 or not results:
            return False
        with h5py.File(results) as f:
            y = f["sensors/s"][:]
        return x.shape == y.shape and np.abs(x - y).max() > 2e-4 * max(1.0, np.abs(x).max())

    def shrink(self, system, what):
        """Leaves tables out as long as the same is wrong."""
        shrunk = True
        while shrunk:
            shrunk = False
            for kind in ("event", "actuator", "controller", "force", "constraint", "function", "hinge"):
                for k in range(len(system[kind]) - 1, -1, -1):
                    smaller = {key: list(v) if isinstance(v, list) else dict(v) for key, v in system.items()}
                    gone = smaller[kind].pop(k)
                    if kind == "hinge":
                        smaller["body"] = [b for b in smaller["body"] if b["name"] != gone["child"]]
                        if not smaller["body"]:
                            continue
                    try:
                        if self.judge(smaller) == what:
                            system, shrunk = smaller, True
                    except OSError:
                        pass
        return system

    def soak(self, minutes, seed):
        end, number, found, outcomes = time.monotonic() + 60 * minutes, 0, 0, collections.Counter()
        while time.monotonic() < end:
            wrong = self.renew_bodies(seed + number)
            if wrong:
                found += 1
                print(f"seed {seed + number}: {wrong}", flush=True)
            system = make_system(seed + number, self.bodies)
            what = self.judge(system)
            outcomes[what or self.outcome] += 1
            if what:
                found += 1
                print(f"seed {seed + number}: {what}", flush=True)
                if self.keep:
                    system = self.shrink(system, what)
                    os.makedirs(self.keep, exist_ok=True)
                    place = os.path.join(self.keep, f"seed{seed + number}")
                    os.makedirs(place, exist_ok=True)
                    for file in self.bodies:
                        for ending in (".h5", ".bdf", ".toml"):
                            shutil.copy(os.path.join(self.folder, file[:-3] + ending), place)
                    with open(os.path.join(place, "system.toml"), "w", encoding="utf-8") as out:
                        out.write(f"# {what}\n" + to_toml(system, "rk"))
            number += 1
        shutil.rmtree(self.folder)
        if self.write_page:
            write_table("soak", ["outcome", "how often"],
                        [(f"`{what}`" if "." in what else what, count) for what, count in outcomes.most_common()],
                        [f"{number} systems of the seeds {seed} to {seed + number - 1}, {found} found."])
        print(f"{number} systems, {found} found")
        for what, count in outcomes.most_common():
            print(f"  {count:5}  {what}")
        print("decks: " + ", ".join(f"{n} {what}" for what, n in self.decks.most_common()))
        return 1 if found else 0


def main():
    parser = make_parser(__doc__, "the counts")
    parser.add_argument("--minutes", type=float, default=5)
    parser.add_argument("--timeout", type=float, default=60)
    options = parser.parse_args()
    sys.exit(Soak(options).soak(options.minutes, options.seed))


if __name__ == "__main__":
    main()
