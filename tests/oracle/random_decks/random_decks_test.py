"""A few seeds of the random structures, sound and spoiled; and planted errors, each of which the judges must see."""
import copy
import os
import sys
import tempfile
import unittest
import warnings

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy as np  # noqa: E402

import judge_modes                                                       # noqa: E402
import judge_static                                                      # noqa: E402
import pencil                                                            # noqa: E402
import simple                                                            # noqa: E402
from examine import Examination                                          # noqa: E402
from program import Program                                              # noqa: E402
from truth import Truth, Wrong, accept_autospc, follow_directions                                                  # noqa: E402

PROGRAM = os.environ["BOUGH_PROGRAM"]


class Case(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("error", RuntimeWarning)
        folder = tempfile.TemporaryDirectory(prefix="bough-oracle-")
        self.addCleanup(folder.cleanup)
        self.program = Program(PROGRAM, folder.name)


class Seeds(Case):
    SOUND = (*range(20), 473)  # 473: shapes whose mass the constraints' large factors blur
    SPOILED = range(8)

    def test_every_answer_is_that_of_the_dense_equations(self):
        kinds = {}
        for spoiled, seeds in ((False, self.SOUND), (True, self.SPOILED)):
            for seed in seeds:
                report = Examination(self.program, seed, spoiled, ["modes"]).run()
                kinds[report.kind] = kinds.get(report.kind, 0) + 1
                with self.subTest(seed=seed, spoiled=spoiled):
                    self.assertNotEqual(report.kind, "wrong", f"{report.what}\n{report.deck}")
        self.assertGreater(kinds["ok"], len(self.SOUND) // 2, "most decks must be solved and compared")


class PlantedErrors(Case):
    """Without these the oracle could be content with everything."""

    SEED, MASSLESS_SEED = 21, 3

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="bough-oracle-")
        cls.addClassCleanup(folder.cleanup)
        program = Program(PROGRAM, folder.name)
        examination = Examination(program, cls.SEED, False, [])
        eigrl = [5, None, None, 10]
        examination.write(eigrl)
        _, matrices = program.matrices("deck.bdf")
        truth = Truth(examination.model, *matrices)
        spectrum = pencil.solve(truth.K, truth.M, truth.K_size, truth.M_size)
        cls.sound = (examination, eigrl, truth, spectrum, *program.modes("deck.bdf"))

    def setUp(self):
        super().setUp()
        self.examination, self.eigrl, self.truth, self.spectrum, self.ran, self.found = copy.deepcopy(self.sound)

    def judge(self):
        return judge_modes.judge(self.ran, self.found, self.truth, self.spectrum, self.eigrl)

    def elastic(self):
        return int(np.argmax(np.array(self.found["eigenvalue"]) > 0))

    def test_the_answer_itself_is_right(self):
        self.assertIsNone(self.judge())

    def test_an_eigenvalue_off_by_five_millionths(self):
        self.found["eigenvalue"][self.elastic()] *= 1 + 5e-6
        self.assertIn("expected", self.judge())

    def test_a_mode_left_out(self):
        at = self.elastic()
        for key in ("eigenvalue", "residual"):
            del self.found[key][at]
        self.found["phi"] = np.delete(self.found["phi"], at, axis=2)
        self.assertIn("modes, expected", self.judge())

    def test_a_rigid_mode_with_a_frequency(self):
        self.found["eigenvalue"][0] = 1.0
        self.assertIn("expected", self.judge())

    def test_a_shape_that_is_no_mode(self):
        at = self.elastic()
        self.found["phi"][:, :, at] += 1e-3 * self.found["phi"][:, :, at + 1]
        self.assertIn("residual", self.judge())

    def test_a_shape_that_breaks_a_constraint(self):
        dof = sorted(self.examination.model.dependent)[0]
        row = list(self.found["ids"]).index(dof[0])
        self.found["phi"][row, dof[1] - 1, self.elastic()] += 1e-5 * np.abs(self.found["phi"]).max()
        self.assertIn("constraints", self.judge())

    def test_a_residual_above_the_limit(self):
        self.found["residual"][0] = 2e-5
        self.assertIn("residual", self.judge())

    def test_a_refusal_of_a_sound_structure(self):
        self.ran.code, self.ran.err = 3, "deck.bdf: error: the stiffness is singular; hold it [fe.mechanism]"
        self.assertIn("refused", self.judge())

    def test_a_signal_and_a_silent_failure(self):
        for code, err in ((-11, ""), (1, "something went wrong"), (None, ""), (3, "error: PETSc failed [fe.petsc]")):
            self.ran.code, self.ran.err = code, err
            self.assertIsNotNone(self.judge())

    def test_an_error_in_a_coefficient_of_a_rigid_element(self):
        row = self.examination.model.rows[0]
        dof = max(sorted(d for d in row if d not in self.examination.model.dependent), key=lambda d: abs(row[d]))
        row[dof] *= 1.001
        self.truth = Truth(self.examination.model, self.truth.K_g, self.truth.M_g, sorted(
            self.truth.index, key=self.truth.index.get))
        self.spectrum = pencil.solve(self.truth.K, self.truth.M, self.truth.K_size, self.truth.M_size)
        self.assertIsNotNone(self.judge())

    def test_a_matrix_that_is_not_that_of_the_cards(self):
        examination = Examination(self.program, self.MASSLESS_SEED, False, [])
        examination.write(self.eigrl)
        _, matrices = self.program.matrices("deck.bdf")
        truth = Truth(examination.model, *matrices)
        self.assertTrue(simple.Simple(examination.model, truth.index).has_M)
        self.assertIsNone(simple.judge(examination.model, truth))
        at = int(truth.M_g.diagonal().argmax())
        truth.M_g[at, at] *= 1 + 1e-6
        self.assertIn("the cards give", simple.judge(examination.model, truth))

    def test_a_choice_of_autospc_that_is_none(self):
        index = {(7, c): c - 1 for c in range(1, 7)}
        K = np.diag([4.0, 2.0, 0.0, 1.0, 1.0, 1.0])
        for held, word in (([], "have none"), ([2], "what is left"), ([2, 3], "have stiffness")):
            with self.assertRaisesRegex(Wrong, word):
                accept_autospc(K, np.abs(K), range(6), index, [(7, c) for c in held])
        self.assertEqual(accept_autospc(K, np.abs(K), range(6), index, [(7, 3)]), [2])
        K[1:3, 1:3] = [[1, 1e-2], [1e-2, 1e-4]]      # a rod: to hold its own direction leaves next to nothing
        with self.assertRaisesRegex(Wrong, "what is left"):
            accept_autospc(K, np.abs(K), range(6), index, [(7, 2)])
        with self.assertRaisesRegex(Wrong, "round-off"):
            accept_autospc(1e-17 * K, np.abs(K), range(6), index, [(7, 3)])

    def test_a_direction_of_autospc_that_has_stiffness(self):
        index, n = {(7, c): c - 1 for c in range(1, 4)}, np.ones(3) / np.sqrt(3)
        K = np.outer(n, n)                           # a rod along (1, 1, 1)
        T = follow_directions(K, np.eye(3), range(3), index, [(7, 2, [(1, 1.0)]), (7, 3, [(1, 1.0)])])
        self.assertEqual(list(T[:, 0]), [1, 1, 1])
        with self.assertRaisesRegex(Wrong, "has stiffness"):
            follow_directions(K, np.eye(3), range(3), index, [(7, 2, [(1, 1.1)]), (7, 3, [(1, 1.0)])])

    def test_roots_over_many_orders_keep_their_digits(self):
        K, rng = np.diag([1e-2, 1.0, 1e8, 2e8, 1e15, 1e17]), np.random.default_rng(3)
        found = pencil.solve(K, np.eye(6), K, np.eye(6))
        self.assertLess(np.abs(found.lam / K.diagonal() - 1).max(), 1e-9)
        L = np.tril(rng.uniform(-1, 1, (6, 6)), -1) * np.sqrt(K.diagonal()) * 1e-3 / np.sqrt(K.diagonal())[:, None]
        C = np.eye(6) + L
        turned = pencil.solve(C.T @ K @ C, C.T @ C, np.abs(C.T) @ K @ np.abs(C), np.abs(C.T) @ np.abs(C))
        self.assertLess(np.abs(turned.lam / K.diagonal() - 1)[2:].max(), 1e-6)

    def test_static_displacements_and_forces_that_are_off(self):
        truth, rng = self.truth, np.random.default_rng(1)
        u = truth.T @ rng.uniform(-1, 1, truth.T.shape[1])
        force = truth.K_g @ u
        self.assertIsNone(judge_static.judge_balance(truth, u, force, 0 * u))
        u[truth.free[0]] *= 1.001
        self.assertIn("balanced", judge_static.judge_balance(truth, u, force, 0 * u))


if __name__ == "__main__":
    unittest.main()
