"""Small decks that once gave a wrong answer in silence or a false refusal: the right number, or the right words."""
import json
import math
import os
import unittest

import h5py

from support import ProgramTest

CASES = os.path.join(os.environ.get("BOUGH_SHARED_DIR", ""), "cases")


@unittest.skipUnless(os.path.isdir(os.path.join(CASES, "decks")), f"no cases at {CASES}")
class SharedCases(ProgramTest):
    def deck(self, name, folder="decks"):
        return os.path.join(CASES, folder, name + ".bdf")

    def modes(self, name, expected, rel=1e-4, folder="decks", options=()):
        result = self.bough("modes", self.deck(name, folder), "--json", *options)
        found = json.loads(result.stdout)["frequency_hz"]
        self.assertEqual(len(found), len(expected), found)
        for f, e in zip(found, expected):
            self.assertAlmostEqual(f, e, delta=rel * abs(e) if e else 1e-3, msg=f"{name}: {found}")
        return result

    def static(self, name, folder="decks", options=()):
        """{(grid, component): displacement} of the first subcase, and the finished process."""
        result = self.bough("static", self.deck(name, folder), "-o", "s.h5", *options)
        with h5py.File(self.path("s.h5")) as f:
            u = f["subcases"][sorted(f["subcases"])[0]]["displacement"][:]
            return {(int(i), int(c)): x for (i, c), x in zip(f["dof_map"][:], u)}, result

    # Wrong answers of old.
    def test_masses_on_rigid_links_of_massless_structure(self):
        self.modes("b01_massless_rbe2", [1.0199, 2.0621, 6.6559])
        # Its RBE3 fits the rotations of the legs' ends too, weighted by the mean arm squared: dense NumPy of K and M.
        self.modes("b01_massless_rbe3", [1.4514162, 1.4514162, 5.42676292], 1e-7)
        self.modes("b01_massless_mpc", [0.7212118, 1.01986341, 3.69315449], 1e-7)
        with open(self.deck("b01_massless_rbe3")) as f:
            text = f.read().replace("RBE3,5001,,999,123456,1.,123456,6\n,106", "RBE2,5001,999,123456,6,106")
        self.write("rbe2.bdf", text)
        found = json.loads(self.bough("modes", "rbe2.bdf", "--json").stdout)["frequency_hz"]
        for f, e in zip(found, [2.9152, 2.9152, 9.4128]):
            self.assertAlmostEqual(f, e, delta=1e-4 * e)

    def test_loose_masses_without_autospc_are_at_rest(self):
        result = self.bough("modes", self.deck("b02_autospc_no_loose_mass"), "--json")
        found = json.loads(result.stdout)
        self.assertEqual(found["num_rigid"] if "num_rigid" in found else sum(f == 0 for f in found["frequency_hz"]), 6)
        # The bars alone: mass lumped at the grids.
        for f, e in zip(found["frequency_hz"][6:], [8.969121354, 8.969121354, 55.58305168, 55.58305168]):
            self.assertAlmostEqual(f, e, delta=1e-7 * e)

    def test_scalar_points_alone(self):
        self.modes("b03_scalar_only_segv", [math.sqrt(100 * (3 - 5 ** .5) / 2) / (2 * math.pi)], 1e-9)
        self.assertNotIn("no mass", self.bough("check", self.deck("b03_scalar_only_segv")).stderr)

    def test_preload(self):
        # A clamped strip of two bending stiffnesses pulled at its end: the characteristic equation of the taut beam.
        EI, m, pull = 70.0, 0.27, 1000.0
        def equation(omega):
            root = math.sqrt((pull / EI) ** 2 / 4 + m * omega ** 2 / EI)
            a, b = math.sqrt(root + pull / EI / 2), math.sqrt(root - pull / EI / 2)
            return (2 * a * a * b * b + (a ** 4 + b ** 4) * math.cosh(a) * math.cos(b) +
                    (a * a - b * b) * a * b * math.sinh(a) * math.sin(b))
        exact, omega = [], 1.0
        while len(exact) < 2:
            if equation(omega) * equation(omega + 1) <= 0:
                low, high = omega, omega + 1
                for _ in range(60):
                    middle = (low + high) / 2
                    low, high = (middle, high) if equation(low) * equation(middle) > 0 else (low, middle)
                exact.append(low / (2 * math.pi))
            omega += 1
        found = json.loads(self.bough("modes", self.deck("b04_statsub_sol103"), "--json").stdout)["frequency_hz"]
        for f, e in zip(found, [exact[0]] * 2 + [exact[1]] * 2):
            self.assertAlmostEqual(f / e, 1, delta=2e-3, msg=f"{found} {exact}")
        found = json.loads(self.bough("modes", self.deck("b04_statsub_preload_sol105"), "--buckling", "--json").stdout)
        self.assertAlmostEqual(found["load_factor"][0] / (math.pi ** 2 * EI / 4 + 100), 1, delta=1e-4)

    def test_blank_p2_is_zero(self):
        u, _ = self.static("b05_pload1_p2")
        self.assertAlmostEqual(u[2, 3], 3.6458e-08, delta=1e-12)

    def test_second_entities_of_a_card(self):
        u, _ = self.static("b06_second_crod_dropped")
        # Force 1 at grid 2 between two rods of EA/L = 1e7, one to ground, the other loose; the spring acts on y.
        self.assertAlmostEqual(u[2, 1], 1e-7, delta=1e-15)
        self.assertAlmostEqual(u[3, 1], 1e-7, delta=1e-15)
        u, _ = self.static("b06_second_celas4_dropped")
        self.assertAlmostEqual(u[2, 0] - u[1, 0], 1e-2, delta=1e-12)
        result = self.bough("static", self.deck("b06_junk_fields"), code=1)
        for words in ("'junk' is not used", "CROD 99 refers to property 98"):
            self.assertIn(words, result.stderr)

    def test_rods_couple_along_their_axis_alone(self):
        f = math.sqrt(1e7 / 2 ** .5 / ((5 / 12 + .5) * 2 ** .5)) / (2 * math.pi)
        self.modes("d01_rod_coupmass", [f, f], 1e-9)

    def test_shear_factors_of_the_vendor(self):
        sections = json.loads(self.bough("check", self.deck("d03_pbarl_box"), "--json").stdout)["sections"]
        self.assertAlmostEqual(sections[0]["K1"], .90876, delta=5e-6)
        self.assertAlmostEqual(sections[0]["K2"], .087591, delta=5e-7)

    def test_full_integration_as_asked(self):
        u, _ = self.static("d05_psolid_full")
        self.assertAlmostEqual(u[5, 1], -5.043286e-06, delta=1e-12)

    # Messages.
    def test_params_that_are_not_used_are_listed(self):
        result = self.bough("modes", self.deck("m_param_typo"))
        for words in ("WTMAS is no parameter", "did you mean WTMASS", "did you mean K6ROT"):
            self.assertIn(words, result.stderr)

    def test_norm_max(self):
        self.bough("modes", self.deck("m_norm_max"), "-o", "m.h5", "-q")
        with h5py.File(self.path("m.h5")) as f:
            phi = f["modes/phi"][:]
        for j in range(phi.shape[2]):
            self.assertAlmostEqual(abs(phi[:, :, j]).max(), 1.0, delta=1e-12)

    def test_an_empty_range_promises_nothing(self):
        result = self.bough("modes", self.deck("m_empty_range"))
        self.assertNotIn("none missed", result.stdout)

    def test_a_bad_subcase_leaves_the_others(self):
        result = self.bough("static", self.deck("m_two_subcases"), code=1)
        self.assertIn("subcase 7: the stiffness matrix is singular", result.stderr)
        self.assertIn("subcase 1", result.stdout)

    # Refused of old.
    def test_lines_as_nastran_takes_them(self):
        long_line = self.static("r03_long_line")[0]
        for name in ("r01_tag_case", "r03_blanks", "r03_name_then_commas"):
            for dof, x in self.static(name)[0].items():
                self.assertAlmostEqual(x, long_line[dof], delta=1e-12 * max(map(abs, long_line.values())), msg=name)
        self.static("r01_tag_plus")
        self.assertIn("DEQATN is not read", self.static("r02_deqatn")[1].stderr)

    def test_elements_as_nastran_takes_them(self):
        self.static("r04_mcid_normal")
        self.assertIn("left-handed", self.static("r05_left_handed")[1].stderr)

    def test_includes_by_symbol(self):
        result = self.bough("static", self.deck("r06_include_symbol"), code=1)
        self.assertIn("set the environment variable MYDIR", result.stderr)

    def test_loads_as_nastran_takes_them(self):
        one = self.static("r07_load_missing")
        self.assertAlmostEqual(one[0][2, 1], 1e-3, delta=1e-12)
        self.assertIn("load set 21", one[1].stderr)
        two = self.static("r07_load_nested")
        self.assertAlmostEqual(two[0][2, 1], 2e-3, delta=1e-12)
        moved = self.static("r08_spcd_not_fixed")
        self.assertAlmostEqual(moved[0][2, 1], -.01, delta=1e-12)
        self.assertIn("which no SPC of the subcase fixes", moved[1].stderr)

    # Cases of the design notes.
    def test_counts_of_stiff_arms(self):
        found = json.loads(self.bough("modes", self.deck("stiff_arm_count", "fe"), "--json").stdout)["frequency_hz"]
        self.assertEqual(len(found), 6)

    def test_loads_that_only_stabilize(self):
        result = self.bough("modes", self.deck("tens", "fe"), "--buckling")
        self.assertNotIn("PETSc", result.stderr)

    def test_suport_that_nothing_carries(self):
        self.bough("static", self.deck("s2", "fe"), code=1)

    def test_solutions_that_are_not_linear(self):
        self.fails(1, "static", self.deck("nl", "fe"), error="cli.nonlinear-static")


if __name__ == "__main__":
    unittest.main()
