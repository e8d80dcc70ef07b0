"""select against scipy's dense Lyapunov solver on random bodies, and linearize against scipy's generalized eigenvalues."""
import json
import os
import sys
import tempfile
import unittest

import h5py
import numpy as np
import scipy.linalg

PROGRAM = os.environ["BOUGH_PROGRAM"]
SOURCE = os.environ["BOUGH_SOURCE_DIR"]
sys.path.insert(0, os.path.join(SOURCE, "tests/support"))
import served  # noqa: E402


def put(file, path, value):
    """New values, same shape: description and dims stay."""
    file[path][...] = value


class RandomBodies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="bough-select-")
        cls.addClassCleanup(cls.folder.cleanup)
        deck = os.path.join(SOURCE, "data/decks/rotating.bdf")
        with open(os.path.join(cls.folder.name, "body.toml"), "w") as f:
            f.write(f'[body]\nname = "panel"\ndeck = "{deck}"\nframe = "fixed"\ninterface = [1, 21, 41]\n'
                    '[body.modes]\nnumber = 7\n[body.output]\nfile = "body.h5"\n')
        cls.bough("reduce", "body.toml")

    @classmethod
    def bough(cls, *arguments):
        result = served.run([PROGRAM, *map(str, arguments)], cwd=cls.folder.name)
        if result.returncode != 0:
            raise AssertionError(result.stdout + result.stderr)
        return result.stdout

    def make_random(self, seed):
        """Full, stable M, D, K of wide spread and shapes at random in the body's file."""
        rng = np.random.default_rng(seed)
        n = 7
        M, D = (0.1 * x @ x.T + np.eye(n) for x in rng.normal(size=(2, n, n)))
        scale = np.diag(10 ** rng.uniform(0, 2, n))
        K = scale @ (np.eye(n) + 0.1 * (lambda x: x @ x.T)(rng.normal(size=(n, n)))) @ scale
        D *= 0.05
        with h5py.File(os.path.join(self.folder.name, "body.h5"), "r+") as f:
            phi = rng.normal(size=f["/modes/phi"].shape)
            for path, value in [("/modal/mass", M), ("/modal/damping", D), ("/modal/stiffness", K), ("/modes/phi", phi)]:
                put(f, path, value)
            ids = list(f["/nodes/id"][:])
        return M, D, K, {node: phi[i] for i, node in enumerate(ids)}

    def test_component_costs(self):
        for seed in range(6):
            with self.subTest(seed=seed):
                M, D, K, phi = self.make_random(seed)
                n = len(M)
                data = json.loads(self.bough("select", "body.h5", "--json", "--inputs", "21:y,41", "--outputs", "41:z,21:rx"))
                b = np.vstack([phi[21][1:2], phi[41][:3]]).T
                c = np.vstack([phi[41][2:3], phi[21][3:4]])
                A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
                B = np.vstack([np.zeros((n, b.shape[1])), np.linalg.solve(M, b)])
                C = np.hstack([c, np.zeros((len(c), n))])
                X = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
                parts = np.diag(X @ C.T @ C)
                expected = parts[:n] + parts[n:]
                found = np.array([mode["cost"] for mode in data["modes"]])
                self.assertLess(np.abs(found - expected).max(), 1e-10 * np.abs(expected).sum())
                self.assertLess(abs(found.sum() - data["total_cost"]), 1e-12 * np.abs(found).sum())
                shares = np.array([mode["share"] for mode in data["modes"]])
                np.testing.assert_allclose(shares * data["total_cost"], found, rtol=1e-12)

    def test_poles_of_the_body_held_fast(self):
        M, D, K, _ = self.make_random(11)
        n = len(M)
        # Integrals of another body: only the clamped one is asked for, where they have no part.
        with open(os.path.join(self.folder.name, "held.toml"), "w") as f:
            f.write('[[body]]\nname = "panel"\nfile = "body.h5"\nstiffening = false\n[[hinge]]\nname = "clamp"\n'
                    'type = "fixed"\nchild = "panel"\n[simulation]\nduration = 1.0\n')
        data = json.loads(self.bough("linearize", "held.toml", "--json"))
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        np.testing.assert_allclose(data["A"], A, atol=1e-8 * np.abs(A).max())
        found = np.array(data["poles"]["real"]) + 1j * np.array(data["poles"]["imag"])
        for pole in np.linalg.eigvals(A):
            self.assertLess(np.abs(found - pole).min(), 1e-8 * abs(pole))


if __name__ == "__main__":
    unittest.main()
