"""select over all bodies of a system: against closed forms of beams on a hub and all combinations of modes by scipy."""
import itertools
import json
import os
import unittest

import h5py
import numpy as np
import scipy.linalg

from linear_test import LinearTest
from support import SOURCE
from toml_text import section, table, toml

# Clamped-free beam of unit length: sqrt of the frequency over sqrt(EI / rho).
BETA = np.array([1.8751040687119611, 4.694091132974174, 7.854757438237613, 10.995540734875467])
ZETA = 0.01


class Case:
    """Two cantilevers on a hub that turns about z under a PD controller; loss of every choice of their bending modes."""

    def __init__(self, inertia, kp, kd, stiffness, density, weights):
        self.inertia, self.kp, self.kd, self.stiffness, self.density = inertia, kp, kd, stiffness, density
        self.weights = weights  # of the angle and of the tips "a" and "b"
        self.modes = [(body, mode) for body in range(2) for mode in range(4)]
        self.full = self.make_model(self.modes)
        X = scipy.linalg.solve_continuous_lyapunov(self.full[0], -self.full[1] @ self.full[1].T)
        parts = np.diag(X @ self.full[2].T @ self.full[2])
        self.total = parts.sum()
        self.costs = (parts[:9] + parts[9:])[1:]

    def make_model(self, kept):
        """Mass-normalized modes: rotation couples by the integral of x phi = 2 sqrt(rho) / beta^2, tips move by 2."""
        n = 1 + len(kept)
        M, D, K, C = np.eye(n), np.zeros((n, n)), np.zeros((n, n)), np.zeros((3, 2 * n))
        M[0, 0], D[0, 0], K[0, 0] = self.inertia + sum(self.density) / 3, self.kd, self.kp
        C[0, 0] = self.weights[0]
        for i, (body, mode) in enumerate(kept, 1):
            omega = BETA[mode]**2 * np.sqrt(self.stiffness[body] / self.density[body])
            K[i, i], D[i, i] = omega**2, 2 * ZETA * omega
            M[0, i] = M[i, 0] = 2 * np.sqrt(self.density[body]) / BETA[mode]**2
            C[1 + body, i] = self.weights[1 + body] * 2 * (-1)**mode / np.sqrt(self.density[body])
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        return A, np.vstack([np.zeros((n, 1)), np.linalg.solve(M, np.eye(n)[:, :1])]), C

    def calc_lost(self, kept):
        """Mean square of the difference of the outputs, over that of the outputs."""
        small = self.make_model(sorted(kept))
        A, B = scipy.linalg.block_diag(self.full[0], small[0]), np.vstack([self.full[1], small[1]])
        C = np.hstack([self.full[2], -small[2]])
        return np.trace(C @ scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T) @ C.T) / self.total

    def find_best(self, number):
        return min((self.calc_lost(kept), kept) for kept in itertools.combinations(self.modes, number))


CASES = [Case(1.24, 39.8, 1.9, [1.45, 0.4], [2.21, 0.25], [7.66, 0.54, 0.16]),  # by cost the best throughout
         Case(0.08, 73.1, 1.7, [2.02, 0.35], [2.54, 7.72], [0.18, 5.36, 0.13])]  # by cost up to 660 times worse


class SelectBodies(LinearTest):
    def make_beams(self, case):
        """Bodies of four modes in the plane; what is normal to it is held."""
        with open(os.path.join(SOURCE, "data/decks/rotating.bdf")) as f:
            deck = f.read().replace("GRDSET,,,,,,,4", "GRDSET,,,,,,,345")
        for name, stiffness, density in zip("ab", case.stiffness, case.density):
            text = deck.replace("PBAR,1,1,1.,1.-6,1.-6,1.-6", f"PBAR,1,1,1.,{stiffness:.6f}-6,{stiffness:.6f}-6,1.-6")
            self.write(f"{name}.bdf", text.replace("MAT1,1,1.+6,,.3,1.", f"MAT1,1,1.+6,,.3,{density:.6f}"))
            self.write(f"{name}.toml", f'[body]\nname = "{name}"\ndeck = "{name}.bdf"\nframe = "fixed"\n'
                                       'interface = [1, 41]\n[body.modes]\nnumber = 4\n'
                                       f'[body.output]\nfile = "{name}.h5"\n')
            self.bough("reduce", f"{name}.toml")

    def write_system(self, name, case, order="ab", files="ab"):
        bodies = [table("body", one, file=f"{file}.h5", damping=ZETA) for one, file in zip("ab", files)]
        clamps = [table("hinge", f"clamp_{one}", "fixed", parent="hub", child=one) for one in "ab"]
        self.write(name, toml(
            table("body", "hub", mass=3.0, cg=[0.0, 0.0, 0.0], inertia=[case.inertia] * 3),
            *[bodies["ab".index(one)] for one in order],
            table("hinge", "spin", "revolute", child="hub", axis=[0.0, 0.0, 1.0], stiffness=case.kp, damping=case.kd),
            *[clamps["ab".index(one)] for one in order],
            table("function", "nothing", "constant", value=0.0),
            table("force", "torque", body="hub", moment=[0.0, 0.0, 1.0], function="nothing"),
            table("sensor", "angle", "hinge_angle", hinge="spin"),
            *[table("sensor", f"tip_{one}", "deflection", body=one, node=41) for one in order],
            section("simulation", duration=0.1)))
        return name

    def select(self, system, case, *more):
        weights = [f"angle={case.weights[0]}", f"tip_a={case.weights[1]}", f"tip_b={case.weights[2]}"]
        words = [word for weight in weights for word in ("--weight", weight)]
        return json.loads(self.bough("select", system, "--json", "--outputs", "angle,tip_a:y,tip_b:y", *words,
                                     *more).stdout)

    @staticmethod
    def list_kept(data):
        return [("ab".index(body["name"]), mode - 1) for body in data["bodies"] for mode in body["kept"]]

    def test_costs_losses_and_all_combinations(self):
        for case in CASES:
            self.make_beams(case)
            self.write_system("hub.toml", case)
            self.write_system("other.toml", case, order="ba")
            worse = 0
            for number in range(1, 8):
                data = self.select("hub.toml", case, "--number", number)
                np.testing.assert_allclose([mode["cost"] for mode in data["modes"]], case.costs,
                                           atol=2e-4 * case.total)
                self.assertAlmostEqual(data["total_cost"] / case.total, 1, delta=1e-4)
                kept = self.list_kept(data)
                self.assertEqual(len(kept), number)
                cheapest = np.argsort(-np.abs(case.costs))[:number]
                self.assertEqual(kept, sorted(case.modes[i] for i in cheapest))
                self.assertAlmostEqual(data["lost_share"], case.calc_lost(kept), delta=2e-4 * case.calc_lost(kept) + 1e-6)
                best, _ = case.find_best(number)
                worse += data["lost_share"] > 1.01 * best + 1e-6
                found = self.select("hub.toml", case, "--number", number, "--exchange")
                self.assertLessEqual(case.calc_lost(self.list_kept(found)), best * 1.001 + 1e-9)
                self.assertAlmostEqual(found["lost_share"], best, delta=2e-4 * best + 1e-6)
                # The order of the bodies in the file has no effect.
                other = self.select("other.toml", case, "--number", number, "--exchange")
                self.assertEqual(other["bodies"], found["bodies"])
                self.assertEqual(self.select("other.toml", case, "--number", number)["bodies"], data["bodies"])
            self.assertEqual(worse > 3, case is CASES[1])

    def test_written_system_has_the_loss_that_is_reported(self):
        case = CASES[1]
        self.make_beams(case)
        self.write_system("hub.toml", case)
        with open(self.path("hub.toml")) as f:
            text = f.read()
        # A value per mode is cut with the modes.
        self.write("hub.toml", text.replace("damping = 0.01", "damping = [0.01, 0.01, 0.01, 0.01]", 1))
        data = self.select("hub.toml", case, "--tolerance", 0.05, "--exchange", "--keep", "b:4", "-o", "small")
        kept = self.list_kept(data)
        self.assertIn((1, 3), kept)
        self.assertLessEqual(data["lost_share"], 0.05)
        self.assertAlmostEqual(data["lost_share"], case.calc_lost(kept), delta=1e-4)
        # No smaller choice with the mode of --keep is within the tolerance.
        others = [mode for mode in case.modes if mode != (1, 3)]
        smallest = min(case.calc_lost([*some, (1, 3)]) for some in itertools.combinations(others, len(kept) - 2))
        self.assertGreater(smallest, 0.05)
        small = self.linearize("small/hub.toml", "--outputs", "angle,tip_a:y,tip_b:y")
        self.assertEqual(sum("eta" in state for state in small["states/name"]), 2 * len(kept))
        exact = [pole for pole in np.linalg.eigvals(case.make_model(kept)[0]) if pole.imag > 0]
        found = small["poles/real"] + 1j * small["poles/imag"]
        for pole in exact:
            self.assertLess(np.abs(found - pole).min(), 1e-4 * abs(pole))
        with h5py.File(self.path("small/b.h5")) as f:
            self.assertEqual(len(f["modal/mass"]), sum(body == 1 for body, _ in kept))

    def test_bodies_of_one_file_and_bodies_without_modes(self):
        case = CASES[0]
        self.make_beams(case)
        self.write_system("twins.toml", case, files="aa")
        data = self.select("twins.toml", case, "--number", 1, "-o", "small")
        self.assertEqual([(body["file"], body["modes"]) for body in data["bodies"]], [("a.h5", 4), ("a.h5", 4)])
        self.assertEqual(sum(len(body["kept"]) for body in data["bodies"]), 1)
        poles = self.linearize("small/twins.toml", "--outputs", "angle")["poles/real"]
        self.assertEqual(len(poles), 4)  # the hub and one mode: the other body is rigid, with a damping ratio
        page = self.bough("select", "twins.toml", "--outputs", "angle,tip_a:y", "--json").stdout
        self.write("twins.json", page)
        self.assertIn("Modes by component cost", self.read_page("twins.json"))

    def test_refusals(self):
        case = CASES[0]
        self.make_beams(case)
        self.write_system("hub.toml", case)
        self.write_system("twins.toml", case, files="aa")
        self.write("rigid.toml", toml(table("body", "hub", mass=1.0, inertia=[1.0] * 3),
                                      table("hinge", "spin", "revolute", child="hub", stiffness=1.0),
                                      section("simulation", duration=0.1)))
        self.fails(1, "select", "rigid.toml", error="select.no-modes")
        self.fails(1, "select", "hub.toml", "twins.toml", error="select.other-bodies")
        self.fails(1, "select", "hub.toml", "--keep", "c:1", error="select.unknown-mode")


if __name__ == "__main__":
    unittest.main()
