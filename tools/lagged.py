#!/usr/bin/env python3
"""tools/lagged.py PROGRAM: the examples of NASA-CR-202063, 4.1.4.1 to 4.1.4.3, and the two links of ex03 by lagged and by
consistent stiffening, both with fixed steps (rk4), against the consistent run with adaptive steps. Prints the tables of
docs/verification/lagged.md."""
import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


class Example:
    def __init__(self, program, name, body, folder):
        self.program, self.folder = program, os.path.join(folder, name)
        shutil.copytree(os.path.join(ROOT, "data/examples", name), self.folder)
        self.call("reduce", body)

    def call(self, *words):
        return subprocess.run([self.program, *words], cwd=self.folder, capture_output=True, text=True).returncode

    def run(self, name, kind, step, changes=()):
        """Results of NAME.toml with texts changed: "lagged", or "consistent" with a step or without (as it stands)."""
        with open(os.path.join(self.folder, name + ".toml")) as f:
            text = f.read()
        if step:
            keys = f'[simulation]\nstep = {step}\nenergy_error_limit = 1e6\n'
            keys += 'stiffening = "lagged"\n' if kind == "lagged" else ""
            changes = [*changes, ("[simulation]\n", keys), ('integrator = "adams"', 'integrator = "rk4"')]
        for old, new in changes:
            if old not in text:
                raise SystemExit(f"{name}.toml lacks {old!r}")
            text = text.replace(old, new)
        with open(os.path.join(self.folder, "run.toml"), "w") as f:
            f.write(text)
        code = self.call("run", "run.toml", "-o", "run.h5")
        out = {"code": code}
        with h5py.File(os.path.join(self.folder, "run.h5")) as f:
            f.visititems(lambda key, item: out.update({key: item[()]}) if isinstance(item, h5py.Dataset) else None)
        total = sum(out["energy/" + k].ravel() for k in ("kinetic", "strain", "potential")) - out["energy/work"].ravel()
        put_in = np.abs(out["energy/work"]).max() + np.abs(out["energy/kinetic"]).max()
        out["drift"] = np.abs(total - total[0]).max() / put_in
        return out


def compare(example, name, steps, channel, component, changes=()):
    """Rows: step, largest departure of the channel by both schemes, energy drift by both."""
    reference = example.run(name, "consistent", None, changes)[channel][:, component]
    rows = []
    for step in steps:
        row = [f"{step:g}"]
        for kind in ("consistent", "lagged"):
            out = example.run(name, kind, step, changes)
            found = out[channel][:, component]
            count = min(len(reference), len(found))
            off = np.abs(found[:count] - reference[:count]).max()
            off = off if count == len(reference) and np.isfinite(off) else np.inf
            row += [f"{off:.2g}", f"{out['drift']:.1g}"]
        rows.append(row)
    return rows


def print_table(headings, rows):
    print("| " + " | ".join(headings) + " |\n|" + " --- |" * len(headings))
    for row in rows:
        print("| " + " | ".join(map(str, row)) + " |")
    print(flush=True)


def main():
    program = os.path.abspath(sys.argv[1])
    folder = tempfile.mkdtemp(prefix="bough-lagged-")
    headings = ["step", "consistent: off by", "energy", "lagged: off by", "energy"]
    try:
        boom = Example(program, "ex01-spinup", "boom.toml", folder)
        print("4.1.4.1, ex01: tip across the boom in m over 20 s\n")
        print_table(headings, compare(boom, "spinup", (0.02, 0.01, 0.005, 0.0025), "sensors/tip_deflection", 1))
        rows = []
        for kind, step in (("consistent", None), ("lagged", 0.01), ("lagged", 0.0025)):
            out = boom.run("spinup", kind, step)
            t, tip = out["time"].ravel(), out["sensors/tip_deflection"][:, 1]
            late = tip[t > 15]
            rows.append([kind + (f", step {step:g}" if step else ""), f"{tip.min():.4f}", f"{t[tip.argmin()]:.2f}",
                         f"{1000 * (late.max() - late.min()) / 2:.2f}", f"{1000 * out['sensors/tip_deflection'][:, 0].min():.1f}"])
        print_table(["", "least y, m", "at, s", "amplitude after 15 s, mm", "least x, mm"], rows)

        hub = Example(program, "ex02-hub", "boom.toml", folder)
        print("4.1.4.2, ex02: tip in m\n")
        rows = []
        for kind, step in (("consistent", None), ("lagged", 0.01), ("lagged", 0.005), ("lagged", 0.0025)):
            tips = [np.abs(hub.run("hub-" + rate, kind, step)["sensors/tip_deflection"][:, 1]) for rate in ("2.18", "2.19")]
            rows.append([kind + (f", step {step:g}" if step else ""), f"{tips[0].max():.2g}", f"{tips[1].max():.2g}"])
        print_table(["", "2.18 rad/s: most in 60 s", "2.19 rad/s"], rows)

        plate = Example(program, "ex05-plate", "plate.toml", folder)
        print("4.1.4.3, ex05: deflection in inches\n")
        rows = []
        for kind, step in (("consistent", None), ("lagged", 0.02), ("lagged", 0.005)):
            row = [kind + (f", step {step:g}" if step else "")]
            low = plate.run("plate-0.165", kind, step)["sensors/deflection"][:, 2]
            high = plate.run("plate-0.170", kind, step)
            t, w = high["time"].ravel(), np.abs(high["sensors/quarter"][:, 2])
            rate = np.polyfit(t[(t > 4) & (t < 8)], np.log(w[(t > 4) & (t < 8)]), 1)[0]
            rows.append(row + [f"{np.abs(low).max():.4g}", f"{rate:.4f}"])
        print_table(["", "0.165 lb/in: most in 40 s", "0.170 lb/in: growth, 1/s"], rows)

        links = Example(program, "ex03-two-link", "link.toml", folder)
        for modes in (2, 4):
            print(f"ex03, {modes} modes a link: place of the tip in m over 1 s; FCONI is fed back\n")
            changes = [("duration = 3.0", "duration = 1.0"), ('file = "link.h5"', f'file = "link.h5"\nmodes = {modes}')]
            print_table(headings, compare(links, "two-link", (0.001, 0.0005, 0.00025), "sensors/tip_position", slice(0, 2), changes))
    finally:
        shutil.rmtree(folder)


main()
