"""The numbers of the beam spin-up, computed from result files against data/reference/spinup.json."""
import json
import os

import h5py
import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def calc_minimum(t, y):
    """Least value and its time, by the parabola through the three samples around the least one."""
    i = int(np.argmin(y))
    a, b, _ = np.polyfit(t[i - 1:i + 2] - t[i], y[i - 1:i + 2] - y[i], 2)
    return y[i] - b * b / (4 * a), t[i] - b / (2 * a)


def calc_numbers(spinup_file, no_kg_file, body_file, third_order_file):
    """{name: number} of two results files, the flexible-body file they ran with, and the results of third order."""
    with h5py.File(spinup_file) as f:
        t, d = f["/time"][:], f["/sensors/tip_deflection"][:]
    with h5py.File(no_kg_file) as f:
        t0, d0 = f["/time"][:], f["/sensors/tip_deflection"][:]
    with h5py.File(body_file) as f:
        omega = np.sqrt(f["/modes/eigenvalue"][:3])
    with h5py.File(third_order_file) as f:
        minimum_order_3, _ = calc_minimum(f["/time"][:], f["/sensors/tip_deflection"][:, 1])
    minimum, when = calc_minimum(t, d[:, 1])
    after = d[t > 15.0, 1]
    return {
        "frequencies_rad_s": omega.tolist(),
        "minimum": minimum,
        "minimum_order_3": minimum_order_3,
        "time_of_minimum": when,
        "at_7_5": float(np.interp(7.5, t, d[:, 1])),
        "residual_amplitude": 0.5 * (after.max() - after.min()),
        "foreshortening": float(np.interp(when, t, d[:, 0])),
        "no_kg_at_7_5": float(np.interp(7.5, t0, d0[:, 1])),
        "no_kg_at_10": float(np.interp(10.0, t0, d0[:, 1])),
    }


def compare(numbers):
    """Rows (name, computed, reference, relative error, tolerance, passed), one per scalar."""
    with open(os.path.join(ROOT, "data/reference/spinup.json")) as f:
        reference = json.load(f)
    rows = []
    for name, entry in reference.items():
        values, found = np.atleast_1d(entry["value"]), np.atleast_1d(numbers[name])
        for k, (expected, value) in enumerate(zip(values, found)):
            error = abs(value - expected) / abs(expected)
            label = name if len(values) == 1 else f"{name}[{k + 1}]"
            rows.append((label, float(value), float(expected), error, entry["tolerance"], bool(error <= entry["tolerance"])))
    return rows
