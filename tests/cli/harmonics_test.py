"""Functions `harmonics` and `random`: forces, their derivatives as the motion of a hinge, spectral densities."""
import json
import os
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml


def make_system(wheel, cooler, duration):
    """A mass that is pushed by the function `cooler`, and a cart on a rail with the motion `wheel`."""
    return toml(
        table("body", "bob", mass=4.0), table("body", "cart", mass=1.0),
        table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0]),
        table("hinge", "rail", "prismatic", child="cart", axis=[1.0, 0.0, 0.0], motion=["wheel"]),
        table("function", "wheel", **wheel), table("function", "cooler", **cooler),
        table("force", "push", body="bob", force=[1.0, 0.0, 0.0], function="cooler"),
        *(table("sensor", name, "acceleration", body=name) for name in ("bob", "cart")),
        section("simulation", duration=duration, output_step=0.01, integrator="rk"))


SYSTEM = make_system(
    {"kind": "harmonics", "omega": 20.0, "omega_rate": 6.0, "x": [1.0, 2.5], "y": [1e-3, 4e-4], "phase_deg": -90.0},
    {"kind": "harmonics", "omega": 30.0, "power": 0, "x": [1.0, 3.0], "y": [2.0, 0.5]}, 2.0)


class Harmonics(ProgramTest):
    def test_force_and_motion(self):
        self.write("rotor.toml", SYSTEM)
        self.bough("run", "rotor.toml", "-o", "rotor.h5")
        with h5py.File(self.path("rotor.h5")) as f:
            t, q, bob, cart = (f[name][()] for name in ("time", "hinges/rail/q", "sensors/bob", "sensors/cart"))
        force = 2 * np.cos(30 * t) + 0.5 * np.cos(90 * t)
        np.testing.assert_allclose(bob[:, 0], force / 4, atol=1e-12)

        def place(t):
            speed, angle = 20 + 6 * t, 20 * t + 3 * t**2
            return speed**2 * (1e-3 * np.sin(angle) + 4e-4 * np.sin(2.5 * angle))
        np.testing.assert_allclose(np.ravel(q), place(t), atol=1e-12)
        h = 1e-4
        second = (-place(t + 2 * h) + 16 * place(t + h) - 30 * place(t) + 16 * place(t - h) - place(t - 2 * h)) / 12 / h**2
        np.testing.assert_allclose(cart[:, 0], second, atol=1e-4 * abs(second).max())

    def test_units(self):
        self.write("rotor.toml", SYSTEM)
        os.mkdir(self.path("mm"))
        self.bough("convert", "rotor.toml", "--units", "m-kg-s:mm-tonne-s", "-o", "mm/rotor.toml")
        self.bough("run", "mm/rotor.toml", "-o", "mm.h5")
        self.bough("run", "rotor.toml", "-o", "rotor.h5")
        with h5py.File(self.path("rotor.h5")) as a, h5py.File(self.path("mm.h5")) as b:
            for name in ("hinges/rail/q", "sensors/bob"):
                np.testing.assert_allclose(b[name][()], 1000 * a[name][()], atol=1e-7)

    def test_wrong_functions_are_named(self):
        for old, new, message in (("y = [2.0, 0.5]", "y = [2.0]", "2 x and 1 y"), ("power = 0", "power = 0.5", "whole number"),
                                  ("omega = 30.0\n", "", "omega")):
            self.write("rotor.toml", SYSTEM.replace(old, new))
            done = self.bough("run", "rotor.toml", code=1)
            self.assertIn(message, done.stderr)
            self.assertIn("rotor.toml:", done.stderr)


RANDOM = make_system(
    {"kind": "random", "components": 50, "x": [0.5, 9.0], "y": [1e-4, 1e-5]},
    {"kind": "random", "x": [0.5, 2.0, 6.0, 9.0], "y": [0.4, 3.0, 0.0, 1.0], "components": 24}, 400.0)


class Random(ProgramTest):
    def run_random(self, text, *names):
        self.write("random.toml", text)
        self.bough("run", "random.toml", "-o", "random.h5")
        return self.read_arrays("random.h5", *names)

    def estimate(self, t, y, bands):
        """Variance of a signal within bands, from its Fourier coefficients over the run under Hann's window."""
        n = len(t) - 1
        window = np.sin(np.pi * np.arange(n) / n)**2
        share = 2 * abs(np.fft.rfft(window * y[:n]))**2 / n / np.sum(window**2)
        f = np.fft.rfftfreq(n, t[1] - t[0])
        return np.array([share[(f >= a) & (f < b)].sum() for a, b in bands])

    def test_density_of_a_force(self):
        """Bands of an eighth of the variance have three of 24 cosines each."""
        for spacing, density in (("linear", lambda f: np.interp(f, [0.5, 2, 6, 9], [0.4, 3, 0, 1])),
                                 ("log", lambda f: np.exp(np.interp(np.log(f), np.log([0.5, 2, 6, 9]),
                                                                    np.log([0.4, 3, 0.1, 1]))))):
            text = RANDOM if spacing == "linear" else RANDOM.replace("3.0, 0.0, 1.0]", '3.0, 0.1, 1.0]\ninterpolation = "log"')
            t, bob = self.run_random(text, "time", "sensors/bob")
            f = np.linspace(0.5, 9, 200001)
            variance = np.concatenate([[0], np.cumsum((density(f[1:]) + density(f[:-1])) / 2) * (f[1] - f[0])])
            edges = np.interp(np.linspace(0, variance[-1], 9), variance, f)
            found = self.estimate(t.ravel(), 4 * bob[:, 0], zip([0.4, *edges[1:8]], [*edges[1:8], 9.1]))
            np.testing.assert_allclose(found, variance[-1] / 8, rtol=0.05, err_msg=spacing)

    def test_power_laws_to_the_minus_one(self):
        """Density 2/f: equal variances in octaves."""
        text = RANDOM.replace("x = [0.5, 2.0, 6.0, 9.0]\ny = [0.4, 3.0, 0.0, 1.0]",
                              'x = [0.5, 8.0]\ny = [4.0, 0.25]\ninterpolation = "log"')
        t, bob = self.run_random(text, "time", "sensors/bob")
        octaves = self.estimate(t.ravel(), 4 * bob[:, 0], [(0.4, 1), (1, 2), (2, 4), (4, 8.1)])
        np.testing.assert_allclose(octaves, 2 * np.log(2), rtol=0.05)

    def test_it_is_a_motion_and_follows_its_seed(self):
        text = RANDOM.replace("duration = 400.0", "duration = 2.0").replace("output_step = 0.01", "output_step = 1e-3")
        q, cart = self.run_random(text, "hinges/rail/q", "sensors/cart")
        q = q.ravel()
        second = (-q[4:] + 16 * q[3:-1] - 30 * q[2:-2] + 16 * q[1:-3] - q[:-4]) / 12e-6
        np.testing.assert_allclose(cart[2:-2, 0], second, atol=1e-5 * abs(second).max())
        again, = self.run_random(text, "hinges/rail/q")
        np.testing.assert_array_equal(again.ravel(), q)
        for more in ("seed = 2\n", "seed = 4294967297\n"):
            other, = self.run_random(text.replace("components = 50\n", "components = 50\n" + more), "hinges/rail/q")
            self.assertGreater(abs(other.ravel() - q).max(), 1e-3)

    def test_response_of_an_oscillator_has_the_rms_of_the_linear_model(self):
        text = RANDOM.replace('axis = [1.0, 0.0, 0.0]\n', 'axis = [1.0, 0.0, 0.0]\nstiffness = [900.0]\ndamping = [12.0]\n', 1)
        text = text.replace("components = 24", "components = 300")
        q, = self.run_random(text, "hinges/slide/q")
        self.bough("linearize", "random.toml", "--inputs", "push", "-o", "model.h5")
        self.write("psd.toml", '[[source]]\nname = "push"\ntype = "psd"\n'
                   'psd = [{input = "push", frequency_hz = [0.5, 2.0, 6.0, 9.0], density = [0.4, 3.0, 0.0, 1.0]}]\n')
        found = json.loads(self.bough("response", "model.h5", "--outputs", "bob:x", "--budget", "psd.toml", "--json").stdout)
        bob, = self.read_arrays("random.h5", "sensors/bob")
        self.assertAlmostEqual(bob[1000:, 0].std() / found["tables"][0]["total"][0], 1, delta=0.05)
        self.assertGreater(q.std(), 0)

    def test_wrong_functions_are_named(self):
        wrong = {
            "y = [0.4, 3.0, 0.0, 1.0]": {"y = [0.4, 3.0, -1.0, 1.0]": "a negative density",
                                         'y = [0.4, 3.0, 0.0, 1.0]\ninterpolation = "log"': "not positive",
                                         "y = [0.4, 3.0]": "y has 2 entries, expected 4"},
            "x = [0.5, 2.0, 6.0, 9.0]": {"x = [0.5, 2.0, 1.0, 9.0]": "is not sorted"},
            "components = 50": {"components = 0": "whole number 1 to 100000", "seed = -1": "seed",
                                'interpolation = "cubic"': "use linear or log"}}
        for old, messages in wrong.items():
            for new, message in messages.items():
                self.write("random.toml", RANDOM.replace(old, new))
                self.assertIn(message, self.bough("run", "random.toml", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
