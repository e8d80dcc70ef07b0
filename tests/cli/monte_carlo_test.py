"""A campaign over the seeds of a controlled system: statistics from seeds, resumed, memory flat."""
import csv
import json
import os
import signal
import unittest

import h5py
import numpy as np

from support import SLOWER, ProgramTest
from toml_text import Bare, section, table, toml

SYSTEM = toml(
    section("parameters", seed=1, kp=4.0),
    table("body", "rotor", mass=1.0, inertia=[1.0, 1.0, 2.0]),
    table("hinge", "axis", "revolute", child="rotor", position=0.1),
    table("sensor", "angle", "hinge_angle", hinge="axis", sample_time=0.1, noise_density=3e-3, seed="$seed"),
    table("controller", "law", "pid", inputs=["angle"], kp="$kp", kd=4.0, sample_time=0.1),
    table("actuator", "drive", "hinge", hinge="axis", input="law"),
    section("simulation", duration=2.0, output_step=0.1, integrator="rk4", step=0.05))

CAMPAIGN = toml(
    section("campaign", steps=["run axis.toml -o axis.h5 --set seed={seed}"]),
    table("parameter", "seed", range=[1, Bare("COUNT")], number=Bare("COUNT"), integer=True),
    table("collect", "angle", file="axis.h5", dataset="/hinges/axis/q", take="last"),
    table("collect", "noise", file="axis.h5", dataset="/sensors/angle", take="last"))


class MonteCarlo(ProgramTest):
    def test_statistics_over_seeds(self):
        count = 80
        self.write("axis.toml", SYSTEM)
        self.write("mc.toml", CAMPAIGN.replace("COUNT", str(count)))
        # Part of it, then the rest: the table is the same as of one go.
        self.bough("batch", "mc.toml", "-j", "1", "-o", "mc", "--shard", "1/2")
        said = json.loads(self.bough("batch", "mc.toml", "-j", "1", "-o", "mc", "--json").stdout)
        self.assertEqual((said["done_before"], said["done"]), (count // 2, count // 2))
        self.bough("batch", "mc.toml", "-j", "2", "-o", "again")
        with h5py.File(self.path("mc/outcomes.h5")) as a, h5py.File(self.path("again/outcomes.h5")) as b:
            angles = a["outputs/angle"][:].ravel()
            np.testing.assert_array_equal(angles, b["outputs/angle"][:].ravel())
            np.testing.assert_array_equal(a["parameters/seed"][:].ravel(), np.arange(1, count + 1))
        self.assertEqual(len(set(angles)), count)
        with open(self.path("mc/statistics.csv")) as file:
            rows = {row["output"]: {k: float(v) for k, v in row.items() if k != "output"} for row in csv.DictReader(file)}
        expected = {"count": count, "mean": angles.mean(), "deviation": angles.std(ddof=1), "min": angles.min(),
                    "p5": np.percentile(angles, 5), "median": np.median(angles), "p95": np.percentile(angles, 95),
                    "max": angles.max()}
        for key, value in expected.items():
            self.assertAlmostEqual(rows["angle"][key], value, delta=1e-12 * max(1, abs(value)), msg=key)
            self.assertAlmostEqual(said["statistics"]["angle"][key], value, delta=1e-12 * max(1, abs(value)))
        # One of them by itself is the case of that seed.
        self.bough("run", "axis.toml", "-o", "seven.h5", "--set", "seed=7")
        with h5py.File(self.path("seven.h5")) as one:
            self.assertEqual(np.ravel(one["hinges/axis/q"])[-1], angles[6])
        # The memory of the one worker after the first tenth of the cases is that after the last.
        memory = [json.load(open(self.path(f"mc/case-{i:04d}/outcome.json")))["memory_kb"] for i in range(1, count, 2)]
        if SLOWER == 1:  # the sanitizers keep what was freed
            self.assertLess(memory[-1], memory[6] + 4000, memory)

    def test_killed_and_called_again(self):
        """A campaign that was killed has, called again, the statistics of one that was not, byte by byte; the memory of
        `batch` itself does not grow with its cases."""
        count = 60
        self.write("axis.toml", SYSTEM)
        self.write("mc.toml", CAMPAIGN.replace("COUNT", str(count)))
        self.bough("batch", "mc.toml", "-j", "1", "-o", "whole")

        words, point = ["batch", "mc.toml", "-j", "1", "-o", "parts", "-q"], {"LD_PRELOAD": os.environ["BOUGH_POINT"],
                                                                           "POINT_CALL": "rename"}
        self.bough(*words, code=-signal.SIGKILL, env={**point, "POINT_PATH": f"case-{count // 3:04d}/outcome.json",
                                                      "POINT_ACT": "kill"})
        self.assertFalse(os.path.exists(self.path("parts/statistics.csv")))
        self.bough(*words, env={**point, "POINT_PATH": "outcome.json", "POINT_ACT": "log",
                                "POINT_PIPE": self.path("memory")})
        with open(self.path("memory")) as f:  # of the program after each case
            memory = [int(line.split()[2]) for line in f]
        self.assertEqual(len(memory), count - count // 3)
        with open(self.path("whole/statistics.csv"), "rb") as a, open(self.path("parts/statistics.csv"), "rb") as b:
            self.assertEqual(a.read(), b.read())
        early = max(memory[:len(memory) // 4])  # the tables at the end are not among them
        if SLOWER == 1:
            self.assertLess(max(memory), early + 1000)

    def test_deviation_follows_the_noise(self):
        """Lyapunov's equation of the sampled loop gives the variance of the angle."""
        self.write("axis.toml", SYSTEM.replace("position = 0.1", "position = 0.0").replace("duration = 2.0", "duration = 12.0"))
        self.write("mc.toml", CAMPAIGN.replace("COUNT", "200"))
        said = json.loads(self.bough("batch", "mc.toml", "-j", "2", "-o", "mc", "--json").stdout)
        T, J, kp, kd, sigma = 0.1, 2.0, 4.0, 4.0, 3e-3 / np.sqrt(0.1)
        # x = [angle, rate, the sample before]: torque -kp y - kd (y - y₋) / T, y = angle + noise.
        b = np.array([T * T / 2, T]) / J
        A = np.array([[1, T, 0], [0, 1, 0], [0, 0, 0]], dtype=float)
        A[:2, 0] -= (kp + kd / T) * b
        A[:2, 2] += kd / T * b
        A[2, 0] = 1
        N = np.array([*(-(kp + kd / T) * b), 1]) * sigma
        P = np.outer(N, N)
        for _ in range(5000):
            P = A @ P @ A.T + np.outer(N, N)
        deviation = np.sqrt(P[0, 0])
        # The deviation of 200 cases is known to 5 % (one sigma); four times that.
        self.assertLess(abs(said["statistics"]["angle"]["deviation"] / deviation - 1), 0.2)
        self.assertLess(abs(said["statistics"]["angle"]["mean"]), 4 * deviation / np.sqrt(200))


if __name__ == "__main__":
    unittest.main()
