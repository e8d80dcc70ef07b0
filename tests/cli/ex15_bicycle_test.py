"""ex15-bicycle: eigenvalues of the benchmark of Meijaard et al. 2007, its range of stable speeds, an LPV grid."""
import unittest

import h5py
import numpy as np
import scipy.io
from scipy.optimize import brentq

from support import ProgramTest


class Bicycle(ProgramTest):
    def setUp(self):
        super().setUp()
        self.copy_example("ex15-bicycle")

    def find_poles(self, *options):
        self.bough("linearize", "bicycle.toml", *options, "-o", "model.h5")
        real, imag = self.read_arrays("model.h5", "poles/real", "poles/imag")
        return (real + 1j * imag).ravel()

    def test_eigenvalues_at_five_meters_per_second(self):
        poles = self.find_poles("--set", "speed=5")
        for exact in (-0.775341882195845 + 4.464867713788229j, -0.322866429004087, -14.078389692798204):
            self.assertLess(abs(poles - exact).min(), 1e-7)
        self.assertEqual(np.sum(abs(poles) > 1e-5), 4)

    def test_range_of_stable_speeds(self):
        def largest(speed):
            poles = self.find_poles("--set", f"speed={speed!r}")
            return poles[abs(poles) > 1e-5].real.max()

        self.assertAlmostEqual(brentq(largest, 4.2, 4.4, xtol=1e-5), 4.292382536341114, delta=1e-4)
        self.assertAlmostEqual(brentq(largest, 5.9, 6.1, xtol=1e-5), 6.024262015388372, delta=1e-4)

    def test_a_push_dies_out(self):
        self.bough("run", "bicycle.toml", "--set", "push=0.5", "-o", "run.h5")
        q, kinetic, potential = self.read_arrays("run.h5", "hinges/place/q", "energy/kinetic", "energy/potential")
        energy = (kinetic + potential).ravel()
        self.assertLess(abs(energy - energy[0]).max(), 1e-6 * energy[0])
        lean = q[:, 1]
        self.assertGreater(abs(lean).max(), 0.05)
        self.assertLess(abs(lean[-1]), 0.1 * abs(lean).max())

    def test_a_grid_is_an_lpv_array(self):
        grid = ("--sweep", "speed=3:8:6", "--sweep", "rider=60:100:3")
        printed = self.bough("linearize", "bicycle.toml", *grid, "-o", "lpv.h5", "--mat", "lpv.mat", "--csv", "lpv.csv").stdout
        self.assertIn("18 models of speed from 3 to 8 (6 values), rider from 60 to 100 (3 values)", printed)
        A, names, points = self.read_arrays("lpv.h5", "A", "grid/name", "grid/points")
        self.assertEqual([name.decode() for name in names], ["speed", "rider"])
        mat = scipy.io.loadmat(self.path("lpv.mat"))
        self.assertEqual(mat["A"].shape, (*A.shape[1:], 6, 3))
        np.testing.assert_array_equal(np.concatenate([v[0].ravel() for v in mat["parameter_value"]]),
                                      [3, 4, 5, 6, 7, 8, 60, 80, 100])
        for k, (speed, rider) in enumerate(points):
            i, j = divmod(k, 3)
            np.testing.assert_array_equal(mat["A"][:, :, i, j], A[k])
            self.assertEqual((speed, rider), (3 + i, 60 + 20 * j))
        self.bough("linearize", "bicycle.toml", "--set", "speed=6", "--set", "rider=100", "-o", "one.h5")
        np.testing.assert_allclose(A[3 * 3 + 2], self.read_arrays("one.h5", "A")[0], rtol=1e-9, atol=1e-9)
        # Branches follow a motion over the whole grid: castering is the fastest real pole at every point.
        real, correlation = self.read_arrays("lpv.h5", "poles/real", "poles/correlation")
        branch = np.argmin(real[0])
        np.testing.assert_array_equal(np.argmin(real, axis=1), branch)
        self.assertEqual(np.sum(np.all(correlation == 1, axis=1)), 1)
        # A file that was read again gives the same arrays.
        self.bough("export", "lpv.h5", "--to", "mat", "-o", "again.mat")
        again = scipy.io.loadmat(self.path("again.mat"))
        for name in "ABCD":
            np.testing.assert_array_equal(again[name], mat[name])
        with open(self.path("lpv.csv")) as table:
            self.assertTrue(table.readline().startswith("point,speed,rider,"))

    def turn(self, text, *options):
        """Equilibrium of a system and a run from it: lean, steer, rates and heading over 20 s."""
        self.write("turn.toml", text)
        self.bough("equilibrium", "turn.toml", *options, "-o", "turn.h5")
        self.bough("run", "turn.toml", *options, "--start-from", "turn.h5", "-o", "run.h5", "-q")
        q, rate, steer, t = self.read_arrays("run.h5", "hinges/place/q", "hinges/place/qdot", "hinges/steer/q", "time")
        return q, rate, np.ravel(steer), np.ravel(t)

    def test_steady_turns_are_equilibria(self):
        """The heading follows from the wheels: with the steer locked the bicycle leans as it must, and a run
        from there goes round a circle."""
        with open(self.path("bicycle.toml")) as f:
            text = f.read().replace("duration = 5.0", "duration = 20.0\nrelative_tolerance = 1e-11\n"
                                    "absolute_tolerance = 1e-12")
        axis = "axis = [0.3090169943749474, 0.0, 0.9510565162951535]"
        for steer, guess in ((0.05, 0.0), (0.2, 0.4), (-0.2, -0.4)):
            place = f'translations = "xyz"\nguess = true\nposition = [0, {guess}, 0, 0, 0, 0]'
            start = text.replace('translations = "xyz"', place)
            q, rate, angle, t = self.turn(start.replace(axis, axis + f"\nposition = {steer}\nlocked = true"))
            with self.subTest(steer=steer):
                lean, heading = q[:, 1], rate[:, 0]
                self.assertGreater(abs(lean[0]), 0.02)
                self.assertGreater(lean[0] * heading[0], 0)  # inwards
                np.testing.assert_allclose(angle, steer, atol=1e-12)
                first = t <= 2.0  # the turn may be unstable: deviations grow by e in a third of a second
                np.testing.assert_allclose(lean[first], lean[0], rtol=0, atol=1e-7)
                np.testing.assert_allclose(heading[first], heading[0], rtol=1e-6)
                # A circle: the velocity turns at the rate of the heading.
                turned = np.unwrap(np.arctan2(rate[:, 4], rate[:, 3]))
                np.testing.assert_allclose((turned - turned[0])[first], (heading[0] * (t - t[0]))[first], atol=1e-6)

    def test_a_parameter_twice_is_an_error(self):
        self.fails(2, "linearize", "bicycle.toml", "--sweep", "speed=1:2:2", "--sweep", "speed=1:2:2", error="cli.bad-sweep")
        self.fails(2, "linearize", "bicycle.toml", "--sweep", "speed=1:2:200", "--sweep", "rider=1:2:200", error="cli.bad-sweep")


if __name__ == "__main__":
    unittest.main()
