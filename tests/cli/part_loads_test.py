"""BEGIN SUPER with elements: loads and gravity, forces of supports, SEBNDRY and component modes of the sections."""
import json
import re
import unittest

import h5py
import numpy as np

from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from parts_test import MASSES, PLACES, SHARED, list_bars, list_grids
from support import ProgramTest

DENSE = SHARED.format(density=",2700.")
GRAVITY = "GRAV,3,,9.81,.2,-.5,-1.\n"
HEAD = ("SOL {sol}\nCEND\nSPC = 1\nMETHOD = 1\nDISPLACEMENT = ALL\nSPCFORCES = ALL\nSUBCASE 1\nLOAD = 3\nBEGIN BULK\n"
        "PARAM,COUPMASS,1\nEIGRL,1,,,6\nSPC1,1,123456,1\n" + MASSES)
PART = "PARAM,COUPMASS,1\n" + DENSE


def make_whole(loads, sol=101, more=""):
    return HEAD.format(sol=sol) + DENSE + loads + more + list_grids(range(1, 14)) + list_bars(1, 13) + "ENDDATA\n"


def make_parts(loads, first, second, sol=101, main=(1, 5, 9, 10, 11, 12, 13)):
    """Section 1 has grids 1 to 5, section 2 has grids 5 to 9 as 1 to 5; `loads` of the main bulk data and of both."""
    return (HEAD.format(sol=sol) + DENSE + loads + list_grids(main) + list_bars(9, 13) + "BEGIN SUPER=1\n" + PART + first
            + list_grids(range(1, 6)) + list_bars(1, 5) + "BEGIN SUPER=2\n" + PART + second
            + list_grids(range(5, 10), -4) + list_bars(5, 9, -4) + "ENDDATA\n")


class PartLoads(ProgramTest):
    def solve(self, deck, name="d"):
        self.write(name + ".bdf", deck)
        result = self.bough("static", name + ".bdf", "-o", name + ".h5")
        with h5py.File(self.path(name + ".h5")) as f:
            group = f["subcases/1"]
            u = {(int(g), int(c)): x for (g, c), x in zip(f["dof_map"][:], group["displacement"][:])}
            tables = {name: {int(i): part["force"][k] for k, i in enumerate(part["id"][:])}
                      for name, part in group.get("elements", {}).items() if name.startswith("M")}
        return u, tables, result.stderr

    def compare(self, whole, parts):
        exact, _, _ = self.solve(whole, "w")
        found, tables, text = self.solve(parts)
        scale = max(map(abs, exact.values()))
        for (grid, c), x in found.items():
            if grid in PLACES:
                self.assertLess(abs(x - exact[grid, c]), 1e-8 * scale, (grid, c))
        for name, shift in (("MUG1_1", 0), ("MUG1_2", 4)):
            for grid, values in tables[name].items():
                for c in range(6):
                    self.assertLess(abs(values[c] - exact[grid + shift, c + 1]), 1e-8 * scale, (name, grid, c))
        return tables, text

    def test_gravity_and_forces_in_sections(self):
        """Statics of the whole deck at all grids: GRAV, FORCE, PLOAD1 and LOAD in the sections."""
        _, text = self.compare(make_whole(GRAVITY), make_parts(GRAVITY, GRAVITY, GRAVITY))
        self.assertNotIn("superelement-gravity", text)
        whole = GRAVITY + "FORCE,3,3,0,7.,1.,2.,3.\nMOMENT,3,8,0,4.,1.,0.,2.\nPLOAD1,3,6,FY,FR,0.,5.,1.,9.\n"
        first = "LOAD,3,2.,.5,21,1.,22\nGRAV,21,,9.81,.2,-.5,-1.\nFORCE,22,3,0,3.5,1.,2.,3.\n"
        second = GRAVITY + "MOMENT,3,4,0,4.,1.,0.,2.\nPLOAD1,3,6,FY,FR,0.,5.,1.,9.\n"
        self.compare(make_whole(whole), make_parts(GRAVITY, first, second))

    def test_accelerations_in_sections(self):
        card = "ACCEL,3,,1.,2.,-3.,X\n,0.,1.,3.,2.5\n"
        self.compare(make_whole(card), make_parts(card, card, card))

    def test_loads_of_sections_alone(self):
        self.compare(make_whole("FORCE,3,3,0,7.,1.,2.,3.\n"), make_parts("", "FORCE,3,3,0,7.,1.,2.,3.\n", ""))

    def test_gravity_of_the_main_bulk_data_does_not_reach_sections(self):
        for card in (GRAVITY, "ACCEL,3,,1.,2.,-3.,Z\n,0.,1.,9.,1.\n"):
            _, _, text = self.solve(make_parts(card, card, ""))
            self.assertIn("[fe.superelement-gravity]", text)
            self.assertIn("superelement(s) 2", text)
        massless = make_parts("ACCEL,3,,1.,2.,-3.,Z\n,0.,1.,9.,1.\n", "FORCE,3,3,0,0.,1.,0.,0.\n", "FORCE,3,3,0,0.,1.,0.,0.\n")
        light = massless.split("BEGIN SUPER", 1)
        light = light[0] + "BEGIN SUPER" + light[1].replace(",2700.", "")
        heavy, without = self.solve(massless)[0], self.solve(light)[0]
        for key, x in heavy.items():
            self.assertAlmostEqual(x, without[key], delta=1e-12 * max(map(abs, heavy.values())))

    def test_forces_of_supports_in_sections(self):
        """MQG1 against the forces of the whole deck's constraints, with a load at the support."""
        loads = GRAVITY + "FORCE,3,3,0,7.,1.,2.,3.\n"
        support = "SPC1,1,23,3\nSPC1,1,2,8\n"
        self.write("w.bdf", make_whole(loads, more=support))
        self.bough("static", "w.bdf", "-o", "w.h5")
        tables, text = self.compare(make_whole(loads, more=support),
                                    make_parts(GRAVITY, loads + "SPC1,1,23,3\n", GRAVITY + "SPC1,1,2,4\n"))
        length = sum(np.linalg.norm(np.subtract(PLACES[k + 1], PLACES[k])) for k in range(1, 5))
        self.assertIn("[fe.part-mass]", text)
        seen, mass = map(float, re.search(r"superelement 1 is supported inside.*count (\S+) of its mass (\S+);", text).groups())
        self.assertAlmostEqual(mass, 2.7 * length, delta=1e-4)
        self.assertLess(seen, .9 * mass)
        with h5py.File(self.path("w.h5")) as f:
            reactions = {(int(g), int(c)): x for (g, c), x in zip(f["dof_map"][:], f["subcases/1/reaction"][:])}
        scale = max(map(abs, reactions.values()))
        self.assertGreater(abs(reactions[3, 2]), 1e-3 * scale)
        self.assertEqual((sorted(tables["MQG1_1"]), sorted(tables["MQG1_2"])), ([3], [4]))
        for name, grid, of in (("MQG1_1", 3, 3), ("MQG1_2", 4, 8)):
            for c in range(6):
                self.assertAlmostEqual(tables[name][grid][c], reactions[of, c + 1], delta=1e-8 * scale)

    def test_gravity_of_external_superelements(self):
        """PARAM,CMSALOAD,YES: -M Φ_r a of the component's matrix moves the boundary as its elements do."""
        self.write("c.bdf", "SOL 103\nCEND\nEXTSEOUT(ASMBULK,EXTBULK,EXTID=50,MATOP4=51)\nBEGIN BULK\n" + PART
                   + "BSET1,123456,5,9\n" + list_grids(range(5, 10)) + list_bars(5, 9) + "ENDDATA\n")
        self.assertNotIn("EXTSEOUT", self.bough("export", "c.bdf", "--to", "extseout", "-o", "c").stderr)
        self.assertIn("case control not used: EXTSEOUT (line 3)", self.bough("modes", "c.bdf", "-n", 1).stderr)
        for card in (GRAVITY, "ACCEL,3,,1.,2.,-3.,Z\n,0.,1.,9.,1.\n"):
            exact, _, _ = self.solve(make_whole(card), "w")
            deck = ("ASSIGN INPUTT4='c.op4',UNIT=51\n" + HEAD.format(sol=101) + "PARAM,CMSALOAD,YES\n" + DENSE + card
                    + list_grids([1, 2, 3, 4, 10, 11, 12, 13]) + list_bars(1, 5) + list_bars(9, 13)
                    + "INCLUDE 'c.asm'\nINCLUDE 'c.pch'\nENDDATA\n")
            found, _, text = self.solve(deck)
            self.assertNotIn("superelement-gravity", text)
            scale = max(map(abs, exact.values()))
            for (grid, c), x in found.items():
                self.assertLess(abs(x - exact[grid, c]), 1e-8 * scale, (card, grid, c))
            without, _, text = self.solve(deck.replace("PARAM,CMSALOAD,YES\n", ""))
            self.assertIn("[fe.superelement-gravity]", text)
            self.assertGreater(abs(without[13, 3] - exact[13, 3]), 1e-2 * scale)
        # A component on a support: its mass matrix is not that of a free body.
        self.write("c.bdf", self.read("c.bdf").replace("BSET1", "SPC1,1,123456,7\nBSET1").replace("EXTSEOUT", "SPC = 1\nEXTSEOUT"))
        self.bough("export", "c.bdf", "--to", "extseout", "-o", "c")
        self.write("d.bdf", deck)
        self.fails(1, "static", "d.bdf", error="fe.superelement-gravity", says=["superelement 50", "CMSALOAD"])

    def condense(self, path, *names, with_modes=False):
        """Matrices of the whole deck by Guyan's T: the interior grids of both sections follow statically. With modes: by
        all modes of the interior with mass (bars have no torsional inertia) too."""
        with h5py.File(self.path(path)) as f:
            K, M, *others = (csr_matrix((f[f"/{m}/data"], f[f"/{m}/indices"], f[f"/{m}/indptr"]), shape=f[f"/{m}/shape"]).toarray()
                             for m in ("K", "M", *names))
        inside = [6 * (k - 1) + c for k in (2, 3, 4, 6, 7, 8) for c in range(6)]
        kept = [i for i in range(6, 78) if i not in inside]
        T = np.zeros((78, len(kept)))
        T[kept] = np.eye(len(kept))
        T[inside] = -np.linalg.solve(K[np.ix_(inside, inside)], K[np.ix_(inside, kept)])
        if with_modes:
            theta, shapes = eigh(M[np.ix_(inside, inside)], K[np.ix_(inside, inside)])
            Phi = np.zeros((78, np.sum(theta > 1e-12 * theta[-1])))
            Phi[inside] = shapes[:, theta > 1e-12 * theta[-1]]
            T = np.hstack([T, Phi])
        return [T.T @ A @ T for A in (K, M, *others)]

    def test_stiffness_of_stress_of_loads_in_sections(self):
        """Buckling: K_G of the whole deck's stress, loads inside of sections among them, condensed by T."""
        control = ("SOL 105\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 3\nSUBCASE 2\nMETHOD = 1\nBEGIN BULK\nPARAM,COUPMASS,1\n"
                   "EIGRL,1,,,3\nSPC1,1,123456,1\n" + MASSES)
        gravity = "GRAV,3,,9810.,.2,-.5,-1.\n"
        whole = gravity + "FORCE,3,3,0,9000.,-1.,.2,3.\nMOMENT,3,8,0,4000.,1.,0.,2.\nPLOAD1,3,6,FY,FR,0.,5000.,1.,9000.\n"
        first = gravity + "FORCE,3,3,0,9000.,-1.,.2,3.\n"
        second = gravity + "MOMENT,3,4,0,4000.,1.,0.,2.\nPLOAD1,3,6,FY,FR,0.,5000.,1.,9000.\n"
        modes = "EIGRL,1,,,{0}\nSPOINT,901,THRU,960\nQSET1,0,901,THRU,960\n"

        def solve(text):
            self.write("d.bdf", control + text.split(MASSES, 1)[1])
            result = self.bough("modes", "d.bdf", "--buckling", "--json")
            self.assertNotIn("superelement-stiffening", result.stderr)
            return np.array(json.loads(result.stdout)["load_factor"])

        self.write("w.bdf", control + make_whole(whole).split(MASSES, 1)[1])
        self.bough("matrices", "w.bdf", "--load", 3, "-o", "k.h5")
        K, _, K_G = self.condense("k.h5", "KG/LOAD_3")
        exact = -1 / eigh(K_G, K, eigvals_only=True)
        exact = exact[np.argsort(abs(exact))][:3]
        np.testing.assert_allclose(solve(make_parts(gravity, first, second)), exact, rtol=1e-8)
        # Without the interior's share: another answer.
        without = solve(make_parts(gravity, "FORCE,3,3,0,0.,1.,0.,0.\n", "FORCE,3,3,0,0.,1.,0.,0.\n"))
        self.assertGreater(abs(without[0] / exact[0] - 1), 1e-3)
        # With component modes the interior buckles too: five dofs of three grids have mass, at the bend of section 2 six.
        K, _, K_G = self.condense("k.h5", "KG/LOAD_3", with_modes=True)
        many = -1 / eigh(K_G, K, eigvals_only=True)
        many = many[np.argsort(abs(many))][:3]
        self.assertGreater(abs(many[0] / exact[0] - 1), 1e-3)
        found = solve(make_parts(gravity, first + modes.format(15), second + modes.format(16)))
        np.testing.assert_allclose(found, many, rtol=1e-7)

    def test_preload_of_loads_in_sections(self):
        """Modes with STATSUB: stiffness of the sections' stress, dense."""
        loads = "GRAV,3,,98.,.2,-.5,-1.\nFORCE,3,3,0,900.,-1.,.2,3.\n"
        light = "GRAV,3,,98.,.2,-.5,-1.\n"
        control = HEAD.format(sol=103).replace("METHOD = 1\n", "").replace(
            "LOAD = 3\n", "LOAD = 3\nSUBCASE 2\nMETHOD = 1\nSTATSUB = 1\n")

        def solve(text):
            self.write("d.bdf", control + text.split(MASSES, 1)[1])
            modes = json.loads(self.bough("modes", "d.bdf", "--json").stdout)
            return modes.get("subcases", [modes])[-1]["eigenvalue"]

        self.write("w.bdf", HEAD.format(sol=101) + make_whole(loads).split(MASSES, 1)[1])
        self.bough("matrices", "w.bdf", "--load", 3, "-o", "k.h5")
        K, M, K_G = self.condense("k.h5", "KG/LOAD_3")
        exact = 1 / eigh(M, K + K_G, eigvals_only=True)[::-1][:6]
        np.testing.assert_allclose(solve(make_parts(light, loads, light)), exact, rtol=1e-8)
        self.assertGreater(abs(1 / eigh(M, K, eigvals_only=True)[-1] / exact[0] - 1), 1e-5)

    def test_forces_and_stresses_in_sections(self):
        """Recovered element forces and stresses are those of the whole deck, loads along a beam among them."""
        whole = GRAVITY + "FORCE,3,3,0,7.,1.,2.,3.\nPLOAD1,3,6,FY,FR,0.,5.,1.,9.\n"
        first, second = GRAVITY + "FORCE,3,3,0,7.,1.,2.,3.\n", GRAVITY + "PLOAD1,3,6,FY,FR,0.,5.,1.,9.\n"
        recovery = DENSE.replace("3.-6\n", "3.-6\n,.01,.02,-.01,.03,.0,-.02,.02,.0\n")
        self.solve(make_whole(whole).replace(DENSE, recovery), "w")
        self.solve(make_parts(GRAVITY, first, second).replace(DENSE, recovery))

        def read(name, kind, values, table):
            with h5py.File(self.path(name + ".h5")) as f:
                part = f["subcases/1"][kind][table]
                return list(part.attrs["components"]), dict(zip(map(int, part["id"][:]), part[values][:]))

        names, force = read("w", "elements", "force", "CBAR")
        axial, vy, vz, torque, my_a, mz_a, my_b, mz_b = (
            np.array([force[k][names.index(c)] for k in range(1, 9)])
            for c in ("axial", "shear_y", "shear_z", "torque", "moment_y_a", "moment_z_a", "moment_y_b", "moment_z_b"))
        exact = np.array([mz_a, -my_a, mz_b, -my_b, vy, vz, axial, torque]).T
        names, stress = read("w", "stresses", "stress", "CBAR")
        total = np.array([[stress[k][names.index(f"xx@{point}")] for point in
                           ("C_a", "D_a", "E_a", "F_a", "C_b", "D_b", "E_b", "F_b")] for k in range(1, 9)])
        bending = total - axial[:, None] / 1e-3
        for section, bars in ((1, range(1, 5)), (2, range(5, 9))):
            names, found = read("d", "elements", "force", f"MEF1_{section}")
            self.assertEqual(names, ["moment1_a", "moment2_a", "moment1_b", "moment2_b", "shear1", "shear2", "axial", "torque"])
            self.assertEqual(sorted(found), list(bars))
            for k in bars:
                np.testing.assert_allclose(found[k], exact[k - 1], atol=1e-8 * np.abs(exact).max())
            names, found = read("d", "elements", "force", f"MES1_{section}")
            for k in bars:
                np.testing.assert_allclose(np.delete(found[k], 4), bending[k - 1], atol=1e-7 * np.abs(total).max())
                self.assertAlmostEqual(found[k][4], axial[k - 1] / 1e-3, delta=1e-7 * np.abs(total).max())

    def test_too_many_elements_to_recover(self):
        grids = "".join(f"GRID,{k},,{.1 * k:.1f},0.,0.\n" for k in range(1, 71))
        springs = "".join(f"CELAS2,{100 + k},1.+5,{1 + k % 69},{1 + k % 6},{2 + k % 69},{1 + k % 6}\n" for k in range(2400))
        shared = SHARED.format(density="")
        self.write("d.bdf", HEAD.format(sol=101).replace(MASSES, "") + "FORCE,3,70,0,1.,1.,2.,3.\n" + shared + grids
                   + "CELAS2,91,1.+5,1,1,70,1\nBEGIN SUPER=1\n" + shared + grids + "GRID,99,,0.,1.,0.\nCBAR,99,1,99,1,1.,0.,0.\n"
                   + springs + "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 70)) + "ENDDATA\n")
        result = self.bough("static", "d.bdf", "-o", "d.h5")
        self.assertIn("[fe.part-recovery]", result.stderr)
        with h5py.File(self.path("d.h5")) as f:
            self.assertIn("MUG1_1", f["subcases/1/elements"])
            self.assertNotIn("MEF1_1", f["subcases/1/elements"])

    def find_eigenvalues(self, deck, *options):
        self.write("d.bdf", deck)
        return np.array(json.loads(self.bough("modes", "d.bdf", "--json", *options).stdout)["eigenvalue"])

    def test_component_modes(self):
        """All fixed-interface modes kept: the section is as good as its elements."""
        whole = self.find_eigenvalues(make_whole("", 103))
        modes = "EIGRL,1,,,{0}\nSPOINT,901,THRU,960\nQSET1,0,901,THRU,960\nASET1,0,901,THRU,960\n"
        guyan = self.find_eigenvalues(make_parts("", "", "", 103))
        # Bars have no torsional inertia: 5 of 6 dofs of 3 interior grids move mass.
        full = self.find_eigenvalues(make_parts("", modes.format(15), modes.format(15), 103))
        np.testing.assert_allclose(full, whole, rtol=1e-8)
        few = self.find_eigenvalues(make_parts("", modes.format(4), modes.format(4), 103))
        self.assertTrue(np.all(guyan > few) and np.all(few > whole * (1 - 1e-10)))
        self.assertLess(np.max(few / whole - 1), .02 * np.max(guyan / whole - 1))
        # Statics do not change, whatever the number of modes.
        loads = GRAVITY + "FORCE,3,3,0,7.,1.,2.,3.\n"
        self.compare(make_whole(loads), make_parts(GRAVITY, loads + modes.format(3), GRAVITY + modes.format(2)))

    def test_frequency_response_with_component_modes(self):
        """SOL 108 with structural damping: all modes kept, the response of the whole deck."""
        modes = "EIGRL,1,,,15\nSPOINT,901,THRU,960\nQSET1,0,901,THRU,960\n"
        found = []
        for deck in (make_whole("", 108), make_parts("", modes, modes, 108)):
            deck = deck.replace(",2700.", ",2700.,,,.02").replace("LOAD = 3\n", "DLOAD = 9\nFREQUENCY = 5\n").replace(
                "EIGRL,1,,,6\n", "RLOAD1,9,10,,,1.\nDAREA,10,13,3,1.\nDAREA,10,5,2,2.\nFREQ1,5,3.,11.,12\n", 1)
            self.write("d.bdf", deck)
            self.bough("frequency", "d.bdf", "-o", "d.h5")
            with h5py.File(self.path("d.h5")) as f:
                part = f["subcases/1/displacement"]
                dofs = [tuple(d) for d in part["dofs"][:]]
                columns = [dofs.index((g, c)) for g in (5, 9, 13) for c in (1, 2, 3, 5, 6)]
                found.append(part["real"][:, columns] + 1j * part["imag"][:, columns])
        self.assertGreater(np.abs(found[0].imag).max(), 0)
        np.testing.assert_allclose(found[1], found[0], atol=1e-7 * np.abs(found[0]).max())

    def test_fewer_points_than_modes(self):
        deck = make_parts("", "EIGRL,1,,,9\nSPOINT,901,902\nQSET1,0,901,902\n", "", 103)
        self.write("d.bdf", deck)
        text = self.bough("modes", "d.bdf").stderr
        self.assertIn("12 boundary degrees of freedom and 2 component modes", text)
        self.write("d.bdf", deck.replace("EIGRL,1,,,9\nSPOINT", "SPOINT"))
        self.fails(1, "modes", "d.bdf", error="fe.part-modes", says=["superelement 1", "METHOD"])

    def test_searched_boundary(self):
        """A main grid at the place of an interior grid joins it unless SEBNDRY leaves it out."""
        spring = "GRID,203,,1.,0.,.3\nCELAS2,77,1.+5,203,2\n"
        self.compare(make_whole(GRAVITY, more=spring),
                     make_parts(GRAVITY + spring + "SEBNDRY,1,ALL,1,5\n", GRAVITY, GRAVITY))
        for card, says in (("SENQSET,1,5\n", "QSET1 and SPOINT"), ("SEEXCLD,1,0,3\n", "SEBNDRY")):
            self.assertIn(says, self.solve(make_parts(GRAVITY + card, GRAVITY, GRAVITY))[2])
        self.write("d.bdf", make_parts(GRAVITY + "SEBNDRY,1,ALL,1,55\n", GRAVITY, GRAVITY))
        self.fails(1, "static", "d.bdf", error="fe.part-boundary", says=["grid 55", "superelement 1"])


if __name__ == "__main__":
    unittest.main()
