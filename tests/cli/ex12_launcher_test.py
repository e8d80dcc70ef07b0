"""ex12-launcher: impulse and mass of a burn, slosh in a closed loop against a planar vehicle with two pendulums."""
import math
import unittest

import numpy as np

from support import ProgramTest

XI, THRUST, SPEED, DRY, BAFFLES = 1.8411837813406593, 240e3, 2800.0, 1400.0, 0.02
TANKS = [(4200.0, 1.5, 800.0, 75e3), (9600.0, 5.5, 1140.0, 165e3)]  # mass, bottom, density, thrust
RADIUS, KP, KD, LAG = 0.9, 120e3, 80e3, 0.05


def calc_poles(time, upper):
    """Poles of the pitch plane: x and θ of the nozzle, two pendulums, the lag of the side force."""
    M, K, C = np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((4, 4))

    def add_body(mass, z, inertia):
        M[:2, :2] += [[mass, mass * z], [mass * z, mass * z * z + inertia]]
    add_body(DRY, 4.5, 16000.0)
    add_body(*upper)
    for k, (full, bottom, density, thrust) in enumerate(TANKS, 2):
        depth = full / density / math.pi / RADIUS**2
        x = XI * depth / RADIUS
        # NASA SP-106, of the mass at the start.
        mass, length = full * 2 * math.tanh(x) / x / (XI**2 - 1), RADIUS / XI / math.tanh(x)
        pivot = bottom + depth - RADIUS / XI * (math.cosh(x) - 2) / math.sinh(x)
        left = full - thrust / SPEED * time
        h = left / density / math.pi / RADIUS**2
        add_body(left, bottom + h / 2, left * (RADIUS**2 / 4 + h * h / 12))
        M[k, k] = mass * length**2
        M[0, k] = M[k, 0] = -mass * length
        M[1, k] = M[k, 1] = -mass * length * (pivot - length)
        K[k, k] = K[1, k] = K[k, 1] = mass * length
        C[k, k] = 2 * BAFFLES * mass * length**2 * math.sqrt(14 / length)
    a = THRUST / M[0, 0]
    K *= a
    K[1, 1] = -a * M[0, 1]
    K[0, 1] -= THRUST  # the thrust turns with the vehicle
    # Lag of the side force, -x at the nozzle: LAG f' = -f - kp θ - kd θ'.
    A = np.zeros((9, 9))
    A[:4, 4:8] = np.eye(4)
    A[4:8, :4], A[4:8, 4:8] = -np.linalg.solve(M, K), -np.linalg.solve(M, C)
    A[4:8, 8] = np.linalg.solve(M, [-1.0, 0, 0, 0])
    A[8, 1], A[8, 5], A[8, 8] = -KP / LAG, -KD / LAG, -1 / LAG
    return np.linalg.eigvals(A)


class Launcher(ProgramTest):
    EXAMPLE = "ex12-launcher", "upper.toml"

    def test_impulse_mass_and_slosh_of_the_ascent(self):
        self.bough("run", "ascent.toml", "-o", "ascent.h5")
        t, fuel, oxygen, linear, out, side, angle = self.read_arrays(
            "ascent.h5", "time", "tanks/fuel/mass", "tanks/oxygen/mass", "momentum/linear", "momentum/out_linear",
            "actuators/side_x", "sensors/attitude")
        upper = self.read_arrays("upper.h5", "rigid/mass")[0].item()
        t, side, mass = t.ravel(), side.ravel(), fuel.ravel() + oxygen.ravel()
        np.testing.assert_allclose(mass, 13800 - THRUST / SPEED * t, rtol=1e-9)
        # Gravity and side force in the pitch plane up to the gust; the mass is linear in time.
        turned = side[:, None] * np.column_stack([-np.cos(angle[:, 1]), 0 * t, np.sin(angle[:, 1])])
        force = turned + np.column_stack([0 * t, 0 * t, -9.81 * (mass + DRY + upper)])
        impulse = np.vstack([np.zeros(3), np.cumsum((force[1:] + force[:-1]) / 2 * 0.1, axis=0)])
        momentum = linear + out - linear[0]
        calm = t < 65
        np.testing.assert_allclose(momentum[calm], impulse[calm], atol=1e-7 * abs(momentum).max())
        np.testing.assert_allclose(momentum[t < 10], impulse[t < 10], atol=1e-12 * abs(momentum).max())
        self.assertLess(abs(angle[-1, 1] - 0.35), 0.01)
        self.bough("run", "ascent.toml", "--set", "baffles=0.0005", "-o", "smooth.h5")
        late = (t > 77) & (t < 79)
        with_baffles, smooth = (abs(self.read_arrays(name, "sensors/slosh")[0][late, 1]).max()
                                for name in ("ascent.h5", "smooth.h5"))
        self.assertGreater(smooth / with_baffles, 2)

    def test_slosh_in_the_closed_loop(self):
        mass, cg, inertia = self.read_arrays("upper.h5", "rigid/mass", "rigid/cg", "rigid/inertia")
        mass, z = mass.item(), cg.ravel()[2]
        upper = (mass, 11 + z, inertia[1, 1] - mass * z * z)
        for time in (0, 60, 110):
            messages = self.bough("linearize", "ascent.toml", "--at", time, "-o", "model.h5").stderr
            # A thrust of 240 kN along modes that it does not excite: columns of round-off, and no kink.
            self.assertNotIn("linear.inaccurate", messages)
            real, imag = self.read_arrays("model.h5", "poles/real", "poles/imag")
            found = real + 1j * imag
            exact = calc_poles(time, upper)
            slosh = exact[(exact.imag > 4) & (exact.imag < 12)]
            self.assertEqual(len(slosh), 2)
            for pole in slosh:
                near = found[abs(found - pole).argmin()]
                self.assertAlmostEqual(near.imag / pole.imag, 1, delta=0.01, msg=(time, pole, near))
                self.assertAlmostEqual(near.real / pole.real, 1, delta=0.05, msg=(time, pole, near))


if __name__ == "__main__":
    unittest.main()
