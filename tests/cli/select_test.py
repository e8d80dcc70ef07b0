"""select: rates, weights, several plants and spectra, against Gramians of scipy."""
import json
import math
import unittest

import h5py
import numpy as np
import scipy.integrate
import scipy.linalg

from linear_test import HUB, LinearTest


class Select(LinearTest):
    def body(self, name="boom.h5"):
        with h5py.File(self.path(name)) as f:
            ids = list(f["/nodes/id"][:])
            return (*(f["/modal/" + key][:] for key in ["mass", "damping", "stiffness"]), f["/modes/phi"][:], ids)

    def plant(self, rows_in, rows_out, rates=False):
        M, D, K, _, _ = self.body()
        n = len(M)
        D = np.where((np.diag(D) == 0) & np.eye(n, dtype=bool), 2 * 0.01 * np.sqrt(np.diag(K * M)), D)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        B = np.vstack([np.zeros((n, len(rows_in))), np.linalg.solve(M, rows_in.T)])
        zero = np.zeros_like(rows_out)
        return A, B, np.hstack([zero, rows_out] if rates else [rows_out, zero])

    def costs(self, A, B, C):
        X = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        parts = np.diag(X @ C.T @ C)
        return parts[:len(A) // 2] + parts[len(A) // 2:]

    def test_rates_weights_and_pinned_modes(self):
        self.make_boom(8)
        _, _, _, phi, ids = self.body()
        tip = phi[ids.index(41)]
        data = json.loads(self.bough("select", "boom.h5", "--json", "--outputs", "41:vy,41:z", "--inputs", "41:y,41:z",
                                     "--weight", "41:z=3", "--keep", "8", "--number", 3).stdout)
        # The weight counts for the input 41:z and for the output.
        rows_in = np.vstack([tip[1], 3 * tip[2]])
        A, B, C = self.plant(rows_in, tip[2:3] * 3)
        C = np.vstack([self.plant(rows_in, tip[1:2], rates=True)[2], C])
        expected = self.costs(A, B, C)
        cost = np.array([mode["cost"] for mode in data["modes"]])
        np.testing.assert_allclose(cost, expected, atol=1e-10 * expected.sum())
        self.assertAlmostEqual(cost.sum() / data["total_cost"], 1, places=12)
        self.assertEqual(data["modes"][7]["reason"], "pinned")
        self.assertEqual(sum(mode["kept"] for mode in data["modes"]), 3)
        for mode in data["modes"]:
            self.assertLess(abs(mode["closed_form"] - mode["cost"]), 0.02 * abs(mode["cost"]) + 1e-4 * data["total_cost"])
        self.fails(1, "select", "boom.h5", "--keep", "9", error="select.unknown-mode")
        self.fails(1, "select", "boom.h5", "--weight", "41:z", error="select.bad-weight")
        self.fails(1, "select", "boom.h5", "--weight", "nothing=2", error="select.bad-weight")

    def test_what_it_costs(self):
        self.make_boom(8)
        data = json.loads(self.bough("select", "boom.h5", "--json", "--outputs", "41:y", "--inputs", "41:y",
                                     "--number", 2, "--response", "loss.csv").stdout)
        _, _, _, phi, ids = self.body()
        row = phi[ids.index(41)][1:2]
        A, B, C = self.plant(row, row)
        kept = [i for i, mode in enumerate(data["modes"]) if mode["kept"]]
        n = len(A) // 2
        both = kept + [n + i for i in kept]
        a, b, c = A[np.ix_(both, both)], B[both], C[:, both]
        def gain(w):
            full = C @ np.linalg.solve(1j * w * np.eye(len(A)) - A, B)
            return abs((full - c @ np.linalg.solve(1j * w * np.eye(len(a)) - a, b))[0, 0]), abs(full[0, 0])
        (loss,) = data["configurations"]
        poles = np.linalg.eigvals(A)
        grid = np.concatenate([abs(p.imag) + abs(p.real) * np.linspace(-2, 2, 401) for p in poles])
        peak = max(gain(w)[0] for w in grid)
        self.assertAlmostEqual(loss["peak_error"] / peak, 1, delta=1e-4)
        self.assertAlmostEqual(loss["peak_gain"] / max(gain(w)[1] for w in grid), 1, delta=1e-4)
        self.assertAlmostEqual(loss["steady_error"], gain(1e-3 * np.abs(poles).min())[0] /
                               gain(1e-3 * np.abs(poles).min())[1], delta=1e-6)
        P = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        Q = scipy.linalg.solve_continuous_lyapunov(A.T, -C.T @ C)
        values = np.sort(np.sqrt(np.abs(np.linalg.eigvals(P @ Q))))[::-1]
        self.assertAlmostEqual(loss["balanced_bound"] / (2 * values[len(both):].sum()), 1, delta=1e-3)
        table = np.genfromtxt(self.path("loss.csv"), delimiter=",", names=True)
        for k in range(0, len(table), 50):
            error, full = gain(2 * math.pi * table["frequency_hz"][k])
            self.assertAlmostEqual(table["before"][k] / full, 1, places=6)
            self.assertAlmostEqual(table["difference"][k], error, delta=1e-6 * full)
        self.bough("select", "boom.h5", "--number", 4, "--response", "loss.svg", "--stiffening", 7)
        with open(self.path("loss.svg")) as f:
            self.assertIn("</svg>", f.read())

    def test_spectra(self):
        self.make_boom(4)
        arguments = ["select", "boom.h5", "--json", "--outputs", "41:y", "--inputs", "41:y"]
        white = json.loads(self.bough(*arguments).stdout)
        self.write("white.csv", "frequency_hz,density\n0,2\n1e5,2\n")
        same = json.loads(self.bough(*arguments, "--spectrum", "white.csv").stdout)
        for a, b in zip(white["modes"], same["modes"]):
            self.assertAlmostEqual(a["cost"], b["cost"], delta=1e-6 * white["total_cost"])
        # A band about the second bending pair only: by quadrature of |G|².
        _, _, _, phi, ids = self.body()
        row = phi[ids.index(41)][1:2]
        A, B, C = self.plant(row, row)
        self.write("band.csv", "frequency_hz,41:y\n3,0\n3.2,5\n4,1\n")
        data = json.loads(self.bough(*arguments, "--spectrum", "band.csv").stdout)
        poles = np.sort(np.abs(np.linalg.eigvals(A).imag)) / 2 / math.pi
        def density(f):
            return np.interp(f, [3, 3.2, 4], [0, 5, 1])
        def square(f):
            return density(f) * abs((C @ np.linalg.solve(2j * math.pi * f * np.eye(len(A)) - A, B))[0, 0])**2
        points = sorted({3.2, *(p for p in poles if 3 < p < 4)})
        exact = scipy.integrate.quad(square, 3, 4, points=points, limit=400, epsabs=0, epsrel=1e-10)[0]
        self.assertAlmostEqual(data["total_cost"] / exact, 1, delta=1e-7)
        for text in ["frequency_hz,41:q\n1,2\n2,3\n", "1,2\n1,2\n", "1,2\n", "1,a\n2,3\n", "1,-2\n2,3\n"]:
            self.write("bad.csv", text)
            result = self.bough(*arguments, "--spectrum", "bad.csv", code=0 if "41:q" in text else 1)
            if "41:q" not in text:
                self.assertIn("[select.bad-spectrum]", result.stderr)

    def test_what_is_no_model_of_the_body_is_told(self):
        self.make_boom(8)
        said = self.bough("select", "boom.h5", "--number", "1", "--keep", "7,8").stderr
        self.assertIn("[select.always-kept]", said)
        self.assertIn("[select.most-is-lost]", said)
        said = self.bough("select", "boom.h5", "--number", "4").stderr
        self.assertNotIn("[select.", said)

    def test_modes_of_one_frequency_go_together(self):
        # Outputs and inputs at 45 degrees to the two planes of bending: how the pair is turned does not matter.
        self.make_boom(8)
        with h5py.File(self.path("boom.h5"), "r+") as f:
            phi, angle = f["/modes/phi"][:], 0.4
            turn = np.eye(8)
            for i in range(0, 8, 2):
                self.assertAlmostEqual(f["/modes/frequency_hz"][i + 1] / f["/modes/frequency_hz"][i], 1, places=6)
                turn[i:i + 2, i:i + 2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
            f["/modes/phi"][...] = phi @ turn
        data = json.loads(self.bough("select", "boom.h5", "--json", "--outputs", "41:y", "--inputs", "41:y",
                                     "--tolerance", 0.02).stdout)
        kept = [mode["kept"] for mode in data["modes"]]
        self.assertEqual(kept[0::2], kept[1::2])
        self.assertIn(False, kept)
        self.assertLessEqual(data["lost_share"], 0.02)

    def test_closed_loop_and_several_configurations(self):
        self.make_boom(8)
        hub = HUB.replace("INERTIA", "1.0").replace("MOTION", "").replace("RATE", "0.0").replace("ETA", "damping = 0.01")
        law = ('[[sensor]]\nname = "speed"\ntype = "hinge_rate"\nhinge = "spin"\n'
               '[[controller]]\nname = "law"\ntype = "pid"\ninputs = ["/sensors/angle"]\nrate = "speed"\nkp = KP\nkd = KD\n'
               '[[actuator]]\nname = "motor"\ntype = "hinge"\nhinge = "spin"\ninput = "law"\n')
        for name, kp, kd in [("soft.toml", 0.5, 1.0), ("stiff.toml", 200.0, 25.0)]:
            self.write(name, hub + law.replace("KP", str(kp)).replace("KD", str(kd)))
        one = {}
        for name in ["soft.toml", "stiff.toml"]:
            one[name] = json.loads(self.bough("select", "boom.h5", name, "--json", "--outputs", "angle,tip:y").stdout)
            model = self.linearize(name, "--outputs", "angle,tip:y")
            A, B, C = model["A"], model["B"], model["C"]
            keep = [i for i, s in enumerate(model["states/name"]) if "controller" not in s]  # its integral: ki = 0
            A, B, C = A[np.ix_(keep, keep)], B[keep], C[:, keep]
            X = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
            parts = np.diag(X @ C.T @ C)
            names = [model["states/name"][i] for i in keep]
            for mode in one[name]["modes"]:
                own = sum(p for p, s in zip(parts, names) if s.split("_dot")[0] == f"boom:eta{mode['mode']}")
                self.assertAlmostEqual(mode["cost"], own, delta=1e-8 * parts.sum())
            self.assertAlmostEqual(one[name]["total_cost"] / parts.sum(), 1, places=8)
        both = json.loads(self.bough("select", "boom.h5", "soft.toml", "stiff.toml", "--json", "--outputs", "angle,tip:y",
                                     "--tolerance", 0.01).stdout)
        self.assertEqual([c["name"] for c in both["configurations"]], ["soft.toml", "stiff.toml"])
        for k, mode in enumerate(both["modes"]):
            shares = [one[name]["modes"][k]["share"] for name in one]
            self.assertAlmostEqual(abs(mode["share"]), max(map(abs, shares)), places=9)
        for loss in both["configurations"]:
            self.assertLessEqual(loss["lost_share"], 0.01)
        # Without the law the hub turns freely: nothing of it decays, and the tip is weighed without it.
        free = json.loads(self.bough("select", "boom.h5", "soft.toml", "--open", "--json", "--outputs", "tip:y").stdout)
        self.assertNotAlmostEqual(free["total_cost"] / one["soft.toml"]["total_cost"], 1, places=3)


if __name__ == "__main__":
    unittest.main()
