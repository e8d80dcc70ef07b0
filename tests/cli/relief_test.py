"""Free bodies in balance (SUPORT, PARAM,INREL) in every command, and what subcases start from."""
import json
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support import ProgramTest  # noqa: E402

NUM, LENGTH = 10, 20.0


def write_line(case, cards, roll=True):
    """A free line of bars along x; `roll`: point masses give it an inertia about itself."""
    lines = ["SOL 103", "CEND", "METHOD = 9", *case, "BEGIN BULK", "EIGRL,9,,,9", "MAT1,1,7.+10,2.7+10,,2700.",
             "PBAR,1,1,1.-3,8.33-8,8.33-8,1.4-7"]
    lines += [f"GRID,{i + 1},,{LENGTH * i / NUM!r},0.,0." for i in range(NUM + 1)]
    lines += [f"CBAR,{i},1,{i},{i + 1},0.,1.,0." for i in range(1, NUM + 1)]
    lines += [f"CONM2,{100 + i},{i},,1.,,,,,+C{i}\n+C{i},.1,,.1,,,.1" for i in range(1, NUM + 2) if roll]
    return "\n".join(lines + cards) + "\nENDDATA\n"


def solve_line(thrust):
    """The roots of the line in one plane, Hermite bars with the axial force of its own inertia relief; zero for the
    translation."""
    EI, h = 7e10 * 8.33e-8, LENGTH / NUM
    mass = np.full(NUM + 1, 1 + 2700e-3 * h)
    mass[[0, -1]] -= 2700e-3 * h / 2
    K, M = np.zeros((2 * NUM + 2,) * 2), np.zeros(2 * NUM + 2)
    M[0::2], M[1::2] = mass, .1
    for e in range(NUM):
        N = -thrust * (1 - mass[:e + 1].sum() / mass.sum())
        k = EI / h**3 * np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                                  [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]])
        g = N / (30 * h) * np.array([[36, 3 * h, -36, 3 * h], [3 * h, 4 * h**2, -3 * h, -h**2],
                                     [-36, -3 * h, 36, -3 * h], [3 * h, -h**2, -3 * h, 4 * h**2]])
        K[2 * e:2 * e + 4, 2 * e:2 * e + 4] += k + g
    roots = np.linalg.eigvalsh(K / np.sqrt(np.outer(M, M)))
    roots[np.abs(roots) < 1e-9 * roots[-1]] = 0
    return roots


CASES = ["SUBCASE 1", "LOAD = 2", "SUBCASE 2", "STATSUB(PRELOAD) = 1"]
SUPORT = ["SUPORT,6,123456", "PARAM,INREL,-1"]


class TestRelief(ProgramTest):
    def test_thrust_at_the_tail_tips_a_free_body_over(self):
        for force in (50.0, -50.0, 300.0):
            self.write("t.bdf", write_line(CASES, SUPORT + [f"FORCE,2,1,,{force!r},1.,0.,0."]))
            result = self.bough("modes", "t.bdf", "--subcase", "2", "--json", "-n", "10")
            expected = solve_line(force)
            found = np.array(json.loads(result.stdout)["eigenvalue"])
            self.assertEqual((found < 0).sum(), 2 if force > 0 else 0)
            self.assertEqual((found == 0).sum(), 4)
            self.assertTrue((np.diff(found) >= -1e-6 * np.abs(found[1:])).all(), found)
            np.testing.assert_allclose(found[found != 0], np.repeat(expected[expected != 0], 2)[:6], rtol=1e-6)
            self.assertEqual("[fe.preload-tips]" in result.stderr, force > 0)
            if force > 0:
                self.assertIn("2 of its rigid-body motions have negative stiffness", result.stderr)
                self.bough("matrices", "t.bdf", "--subcase", "2", "-o", f"k{force}.h5")
        # However small the thrust is.
        self.write("t.bdf", write_line(CASES, SUPORT + ["FORCE,2,1,,1.-3,1.,0.,0."]))
        self.bough("modes", "t.bdf", "--subcase", "2")
        self.write("p.bdf", write_line(CASES, SUPORT + ["FORCE,2,11,,20000.,1.,0.,0."]))
        self.bough("modes", "p.bdf", "--subcase", "2")
        # Beyond the load that buckles the free line too it is the structure.
        self.write("b.bdf", write_line(CASES, SUPORT + ["FORCE,2,1,,5000.,1.,0.,0."]))
        self.fails(3, "modes", "b.bdf", "--subcase", "2", error="fe.preload-buckles", says=["the structure buckles"])

    def test_matrices_hold_what_suport_holds(self):
        pull = ["FORCE,2,11,,20000.,1.,0.,0."]
        self.write("p.bdf", write_line(CASES, SUPORT + pull))
        self.bough("matrices", "p.bdf", "--subcase", "1", "-o", "k.h5")
        self.bough("matrices", "p.bdf", "--subcase", "2", "-o", "k2.h5")
        def dense(f, name):
            data, indices, indptr = (f[f"{name}/{part}"][:] for part in ("data", "indices", "indptr"))
            A = np.zeros((len(indptr) - 1,) * 2)
            for row in range(len(indptr) - 1):
                A[row, indices[indptr[row]:indptr[row + 1]]] = data[indptr[row]:indptr[row + 1]]
            return A
        with h5py.File(self.path("k.h5")) as f, h5py.File(self.path("k2.h5")) as g:
            K_G = dense(f, "KG/LOAD_2")
            self.assertGreater(np.abs(K_G).max(), 0)
            self.assertLess(np.abs(dense(g, "K") - dense(f, "K") - K_G).max(), 1e-9 * np.abs(dense(f, "K")).max())

    def test_a_line_without_roll_inertia_is_balanced_where_nothing_rolls_it(self):
        self.write("s.bdf", write_line(["SUBCASE 1", "LOAD = 2"], SUPORT + ["FORCE,2,1,,100.,1.,0.,0."], roll=False))
        said = self.bough("static", "s.bdf", "-o", "s.h5").stderr
        self.assertRegex(said, r"note: a rigid-body motion of the model has no mass, that of grid 6 component 4")
        with h5py.File(self.path("s.h5")) as f:
            case = f["subcases"][list(f["subcases"])[0]]
            self.assertLess(abs(case["load"][0] + case["inertia"][0::6].sum()), 1e-9 * 100)
        self.write("r.bdf", write_line(["SUBCASE 1", "LOAD = 2"], SUPORT + ["MOMENT,2,1,,100.,1.,0.,0."], roll=False))
        self.fails(1, "static", "r.bdf", error="fe.inertia-massless", says=["r.bdf:", "that of grid 6 component 4"])

    def test_what_suport_leaves_free_is_told_as_that(self):
        self.write("o.bdf", write_line(["SUBCASE 1", "LOAD = 2"],
                                       ["SUPORT,6,12356", "PARAM,INREL,-1", "FORCE,2,1,,100.,1.,0.,0."]))
        result = self.fails(1, "static", "o.bdf", error="fe.mechanism", says=["the 5 dof(s) that SUPORT"])
        self.assertNotIn("nothing is held", result.stderr)

    def test_a_held_model_is_not_free(self):
        self.write("h.bdf", write_line(["SPC = 1", "SUBCASE 1", "LOAD = 2"],
                                       ["PARAM,INREL,-2", "SPC1,1,123456,1", "FORCE,2,11,,100.,1.,0.,0."]))
        result = self.fails(1, "static", "h.bdf", error="fe.suport-strained", says=["h.bdf:", "is for a free body", "SPC = 1"])
        self.assertNotIn("motion of SUPORT", result.stderr)

    def test_each_subcase_expands_from_its_own_temperature(self):
        deck = ("SOL 101\nCEND\nSPC = 1\nTEMPERATURE(LOAD) = 5\nSUBCASE 1\n%sSUBCASE 2\n%sSUBCASE 3\nBEGIN BULK\n"
                "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCROD,1,1,1,2\nPROD,1,1,1.\nMAT1,1,1.+6,,.3,,1.-5\n"
                "SPC1,1,123456,1,2\nTEMPD,5,100.\nTEMPD,6,20.\nTEMPD,7,60.\nENDDATA\n")
        for first, second, expected in ((7, 6, (-400, -800, -1000)), (0, 7, (-1000, -400, -1000)),
                                        (7, 0, (-400, -1000, -1000))):
            self.write("t.bdf", deck % tuple(f"TEMPERATURE(INITIAL) = {n}\n" if n else "" for n in (first, second)))
            self.bough("static", "t.bdf", "-o", "t.h5")
            with h5py.File(self.path("t.h5")) as f:
                cases = f["subcases"]
                found = [cases[name]["elements/CROD/force"][0, 0] for name in sorted(cases)]
            np.testing.assert_allclose(found, expected, rtol=1e-9)


if __name__ == "__main__":
    unittest.main()
