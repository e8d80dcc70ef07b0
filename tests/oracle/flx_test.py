"""Γ0..Γ4 and F_I, computed a second time with NumPy from M, Φ and the dof map, node by node as the report writes them
(NASA-CR-202063, eqs. 3-12 and 4.2.2), against `reduce`, `matrices`, `flx` and `integrals`: equal to 1e-12."""
import itertools
import json
import os
import shutil
import subprocess
import sys
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.sparse

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../cli"))
from support import PROGRAM, SOURCE, ProgramTest  # noqa: E402

sys.path.insert(0, os.path.join(SOURCE, "data/python"))
import treeflx  # noqa: E402

TOLERANCE = 1e-12


def split_nodes(dof_map, xyz, X):
    """6 x columns of X for each node, zero where the map has no such dof."""
    blocks = np.zeros((len(xyz), 6, X.shape[1]))
    for row, (node, code) in enumerate(dof_map):
        if 1 <= code <= 6:
            blocks[node - 1, code - 1] = X[row]
    return blocks


def momentum_integrals(M, Phi, dof_map, xyz):
    n = Phi.shape[1]
    A, phi = split_nodes(dof_map, xyz, M @ Phi), split_nodes(dof_map, xyz, Phi)
    g = {"gamma0": np.zeros((n, 3)), "gamma1": np.zeros((n, 3)), "gamma2": np.zeros((n, n, 3)),
         "gamma3": np.zeros((n, 3, 3)), "gamma4": np.zeros((n, n, 3, 3))}
    for p, A_k, phi_k in zip(xyz, A, phi):
        for j in range(n):
            a = A_k[:3, j]
            g["gamma0"][j] += a
            g["gamma1"][j] += A_k[3:, j] + np.cross(p, a)
            g["gamma3"][j] += (p @ a) * np.eye(3) - np.outer(a, p)
            for k in range(n):
                f = phi_k[:3, k]
                g["gamma2"][j, k] += np.cross(a, f)
                g["gamma4"][j, k] += (a @ f) * np.eye(3) - np.outer(a, f)
    return g


def rigid_modes(dof_map, xyz):
    """Columns: unit translations x y z, unit rotations about the origin; of each dof by its direction."""
    Phi_R = np.zeros((len(dof_map), 6))
    for row, (node, code) in enumerate(dof_map):
        if 1 <= code <= 3:
            Phi_R[row, code - 1] = 1
            for s in range(3):
                Phi_R[row, 3 + s] = np.cross(np.eye(3)[s], xyz[node - 1])[code - 1]
        elif 4 <= code <= 6:
            Phi_R[row, code - 1] = 1
    return Phi_R


def exact_integrals(M, Phi, dof_map, xyz):
    """By the quadratic form: e x φ in the translation rows."""
    n = Phi.shape[1]
    phi = split_nodes(dof_map, xyz, Phi)
    Phi_R = rigid_modes(dof_map, xyz)
    turned = np.zeros((3, len(dof_map), n))
    for row, (node, code) in enumerate(dof_map):
        if 1 <= code <= 3:
            for a in range(3):
                turned[a, row] = np.cross(np.eye(3)[a], phi[node - 1, :3].T)[:, code - 1]
    M_Phi = M @ Phi
    M_turned = np.array([M @ t for t in turned])
    return {"gamma0": M_Phi.T @ Phi_R[:, :3], "gamma1": M_Phi.T @ Phi_R[:, 3:],
            "gamma2": np.einsum("aij,ik->jka", turned, M_Phi),
            "gamma3": np.einsum("ia,bij->jab", Phi_R[:, 3:], M_turned),
            "gamma4": np.einsum("aik,bij->jkab", turned, M_turned)}


def inertial_loads(M, dof_map, xyz):
    """fimake5: ndof x 12. With momentum P of the rigid motions and cross products at each node (report eqs. 7-10)."""
    P = M @ rigid_modes(dof_map, xyz)
    nodes = split_nodes(dof_map, xyz, P)
    F = np.zeros((len(dof_map), 12))
    F[:, :6] = -P
    pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
    for row, (node, code) in enumerate(dof_map):
        if not 1 <= code <= 6:
            continue
        half, axis = slice(0, 3) if code <= 3 else slice(3, 6), (code - 1) % 3
        y = [nodes[node - 1, half, 3 + s] for s in range(3)]
        for column, (r, s) in enumerate(pairs):
            turned = np.cross(np.eye(3)[r], y[s])
            if r != s:
                turned = turned + np.cross(np.eye(3)[s], y[r])
            F[row, 6 + column] = -turned[axis]
    return F


class OracleTest(ProgramTest):
    def assert_equal(self, found, expected, what):
        found, expected = np.asarray(found, float), np.asarray(expected, float)
        self.assertEqual(found.shape, expected.shape, what)
        scale = max(np.abs(expected).max(initial=0), 1e-30)
        self.assertLess(np.abs(found - expected).max(initial=0) / scale, TOLERANCE, what)

    def read_flx(self, name):
        return json.loads(self.bough("flx", "--read", name, "--json").stdout)


class OfADeck(OracleTest):
    """reduce --full and matrices of our own deck, lumped and consistent mass."""
    DECK = "rotating.bdf"

    def setUp(self):
        super().setUp()
        self.deck = os.path.join(SOURCE, "data/decks", self.DECK)

    def read(self, mass):
        self.bough("matrices", self.deck, "--no-kg", "--mass", mass, "-o", "m.h5")
        self.bough("reduce", self.deck, "--modes", "4", "--full", "--mass", mass, "-o", "body.h5")
        with h5py.File(self.path("m.h5")) as f:
            M = scipy.sparse.csr_matrix((f["M/data"][:], f["M/indices"][:], f["M/indptr"][:]), shape=f["M/shape"][:])
            dof_map = f["dof_map"][:]
            ids, xyz = f["grids/id"][:], f["grids/xyz"][:]
        place = {grid: k + 1 for k, grid in enumerate(ids)}
        numbered = np.array([(place[node], code) for node, code in dof_map])
        return M, numbered, xyz, h5py.File(self.path("body.h5"))

    def test_integrals_and_inertial_loads_of_reduce(self):
        for mass in ["lumped", "consistent"]:
            M, dof_map, xyz, body = self.read(mass)
            with body:
                Phi = body["full/phi"][:]
                momentum = momentum_integrals(M, Phi, dof_map, xyz)
                exact = exact_integrals(M, Phi, dof_map, xyz)
                # Of a consistent M the grids do not know where the mass between them is: there the second order is that of
                # the lines (docs/theory/carried-bodies.md, tests/modal), and the nodal formulas have the first.
                for name in momentum:
                    self.assert_equal(body[f"integrals/{mass}/{name}"][:], momentum[name], f"{mass} {name}")
                    if mass == "lumped" or name in ("gamma0", "gamma1"):
                        self.assert_equal(body[f"integrals/exact/{name}"][:], exact[name], f"{mass} exact {name}")
                columns = slice(0, 12 if mass == "lumped" else 6)
                F = inertial_loads(M, dof_map, xyz)
                self.assert_equal(body["inertial_loads/f"][:][:, columns], F[:, columns], mass)

    def test_lumped_inertial_loads_are_those_of_particles(self):
        M, dof_map, xyz, body = self.read("lumped")
        body.close()
        F = inertial_loads(M, dof_map, xyz)
        rng = np.random.default_rng(2)
        a, alpha, w = rng.normal(size=(3, 3))
        A_I = np.concatenate([a, alpha, w * w, [w[0] * w[1], w[0] * w[2], w[1] * w[2]]])
        f = split_nodes(dof_map, xyz, (F @ A_I)[:, None])[:, :, 0]
        m = split_nodes(dof_map, xyz, M.diagonal()[:, None])[:, 0, 0]
        for p, f_k, m_k in zip(xyz, f, m):
            expected = -m_k * (a + np.cross(alpha, p) + np.cross(w, np.cross(w, p)))
            np.testing.assert_allclose(f_k[:3], expected, atol=1e-13 * np.abs(F).max())

    def test_integrals_of_the_exported_matrices_equal_those_of_reduce(self):
        M, dof_map, xyz, body = self.read("consistent")
        with body:
            Phi, ids = body["full/phi"][:], body["nodes/id"][:]
        kept = [i for i in range(len(dof_map)) if np.any(Phi[i]) or M[i].nnz]
        M = M.toarray()[np.ix_(kept, kept)]
        write_input(self, "m", M, np.eye(len(kept)), None, Phi[kept], dof_map[kept], xyz, zeta=0.01)
        self.bough("integrals", "m.inp", "m.mat", "--digits", "17", "-o", "a.FLX")
        self.bough("flx", "body.h5", "--integrals", "consistent", "--digits", "17", "-o", "b.FLX")
        a, b = self.read_flx("a.FLX"), self.read_flx("b.FLX")
        for name in ["alpha", "gamma1", "gamma2", "gamma3", "gamma4"]:
            factor = a["mass"] / b["mass"] if name == "alpha" else 1
            self.assert_equal(np.array(a[name]) * factor, b[name], name)
        self.assertEqual(len(b["gains"]), len(ids))

    def test_flx_carries_the_body(self):
        M, dof_map, xyz, body = self.read("consistent")
        self.bough("flx", "body.h5", "--special-nodes", "--body-id", "3", "--digits", "17", "-o", "b.FLX")
        flx = self.read_flx("b.FLX")
        self.assertEqual(flx["body_id"], 3)
        with body:
            method = body["integrals"].attrs["method"]
            self.assertEqual(flx["method"], method)
            for name in ["gamma1", "gamma2", "gamma3", "gamma4"]:
                np.testing.assert_array_equal(flx[name], body[f"integrals/{method}/{name}"][:])
            mass = float(np.ravel(body["rigid/mass"][()])[0])
            np.testing.assert_array_equal(flx["alpha"], body[f"integrals/{method}/gamma0"][:] / mass)
            for block in ["mass", "stiffness", "damping"]:
                np.testing.assert_array_equal(flx["generalized_" + block], body["modal/" + block][:])
            np.testing.assert_array_equal(flx["gains"], body["modes/phi"][:])
            np.testing.assert_array_equal(flx["nodes"]["xyz"], body["nodes/xyz"][:])
            ids = list(body["nodes/id"][:])
        self.assertEqual(flx["nodes"]["id"], ids)
        self.assertEqual(flx["special_nodes"]["id"], [max(ids) + 1 + s for s in range(5)])
        expected = np.zeros((5, 6, 4))
        for j in range(4):
            expected[j + 1, 0, j] = 1
        np.testing.assert_array_equal(flx["special_nodes"]["gains"], expected)

    def test_flx_starts_neither_petsc_nor_mpi(self):
        """Their start takes several times as long as the verb."""
        self.read("lumped")[3].close()
        for call in ("PetscInitialize", "MPI_Init"):
            point = {"LD_PRELOAD": os.environ["BOUGH_POINT"], "POINT_CALL": call, "POINT_ACT": "exit"}
            self.bough("modes", self.deck, code=99, env=point)
            self.bough("flx", "body.h5", "-o", "b.FLX", "-q", env=point)


def write_input(test, name, M, K, D, Phi, dof_map, xyz, offset=(0, 0, 0), body_id=1, modopt=0, mass=1.0, zeta=None,
                select=None, nodes=(), special=False):
    def row(values):
        return " ".join(repr(float(v)) for v in values)

    n = Phi.shape[1]
    lines = [f"{len(xyz)} {len(dof_map)} {n}", *(f"{node} {code}" for node, code in dof_map), row(offset),
             *(row(p) for p in xyz), str(body_id), str(modopt), repr(float(mass))]
    lines += ["1"] if zeta is None else ["2", repr(float(zeta))]
    lines += [str(n), "1"] if select is None else [str(len(select)), "2", *map(str, select)]
    lines += [str(len(nodes)), *map(str, nodes), "2" if special else "1"]
    test.write(name + ".inp", "\n".join(lines) + "\n")
    matrices = [M, K] + ([] if zeta is not None else [D]) + [Phi]
    test.write(name + ".mat", "\n".join(row(r) for m in matrices for r in m) + "\n")


class OfMatrices(OracleTest):
    """`integrals` on matrices of no particular structure, dofs missing, in any order, with generalized ones."""

    def setUp(self):
        super().setUp()
        rng = np.random.default_rng(11)
        self.xyz = rng.normal(size=(6, 3))
        every = [(node, code) for node in range(1, 7) for code in range(1, 7)]
        kept = [every[i] for i in rng.permutation(36)[:27]]
        self.dof_map = np.array(kept[:10] + [(0, 7)] + kept[10:] + [(3, 7)])
        size = len(self.dof_map)

        def symmetric():
            m = rng.normal(size=(size, size))
            return m @ m.T
        self.M, self.K, self.D = symmetric(), symmetric(), symmetric()
        self.Phi = rng.normal(size=(size, 5))
        self.Phi /= np.sqrt(np.einsum("ij,ik,kj->j", self.Phi, self.M, self.Phi))

    def test_every_option(self):
        offsets, selections = [(0, 0, 0), (0.5, -0.25, 2.0)], [None, (2, 3, 5)]
        for modopt, zeta, select, offset in itertools.product([0, 1, 2], [None, 0.015], selections, offsets):
            special = modopt == 1
            with self.subTest(modopt=modopt, zeta=zeta, select=select, offset=offset):
                write_input(self, "t", self.M, self.K, self.D, self.Phi, self.dof_map, self.xyz, offset, 4, modopt, 2.5,
                            zeta, select, (2, 5, 6), special)
                self.bough("integrals", "t.inp", "t.mat", "--digits", "17", "--fi", "t.fi", "-o", "t.FLX")
                self.check(self.read_flx("t.FLX"), modopt, zeta, select, np.array(offset), special)

    def check(self, flx, modopt, zeta, select, offset, special):
        chosen = list(range(1, 6)) if select is None else list(select)
        Phi = self.Phi[:, np.array(chosen) - 1]
        p = self.xyz - offset
        g = momentum_integrals(self.M, Phi, self.dof_map, p)
        self.assertEqual((flx["body_id"], flx["modopt"], flx["mass"]), (4, modopt, 2.5))
        self.assertEqual(flx["modes"], chosen)
        self.assert_equal(flx["generalized_mass"], Phi.T @ self.M @ Phi, "mass")
        self.assert_equal(flx["generalized_stiffness"], Phi.T @ self.K @ Phi, "stiffness")
        modal = np.diag(Phi.T @ self.M @ Phi), np.diag(Phi.T @ self.K @ Phi)
        D = Phi.T @ self.D @ Phi if zeta is None else np.diag(2 * zeta * np.sqrt(modal[1] / modal[0]))
        self.assert_equal(flx["generalized_damping"], D, "damping")
        self.assert_equal(flx["alpha"], g["gamma0"] / 2.5, "alpha")
        for name, least in [("gamma0", 2), ("gamma1", 2), ("gamma2", 1), ("gamma3", 1), ("gamma4", 0)]:
            if modopt <= least:
                self.assert_equal(flx[name], g[name], name)
            else:
                self.assertNotIn(name, flx)
        nodes = split_nodes(self.dof_map, self.xyz, Phi)
        self.assertEqual(flx["nodes"]["id"], [2, 5, 6])
        np.testing.assert_array_equal(flx["nodes"]["xyz"], p[[1, 4, 5]])
        np.testing.assert_array_equal(flx["gains"], nodes[[1, 4, 5]])
        self.assertEqual(flx["special_nodes"]["id"], [7 + s for s in range(len(chosen) + 1)] if special else [])
        table = np.loadtxt(self.path("t.fi"))
        np.testing.assert_array_equal(table[:, :2], self.dof_map)
        self.assert_equal(table[:, 2:], inertial_loads(self.M, self.dof_map, p), "F_I")
        # The functions for scripts say the same as the program.
        self.assert_equal(treeflx.fimake5(self.M, self.dof_map, self.xyz, offset), table[:, 2:], "fimake5")
        own = treeflx.modall(self.M, self.K, Phi, self.dof_map, self.xyz, 2.5, offset,
                             self.D if zeta is None else None, zeta)
        for name in ["mass", "stiffness", "damping"]:
            self.assert_equal(own[name], flx["generalized_" + name], "modall " + name)
        for name in ["alpha", "gamma0", "gamma1", "gamma2", "gamma3", "gamma4"]:
            if name in flx:
                self.assert_equal(own[name], flx[name], "modall " + name)

    @unittest.skipUnless(shutil.which("octave"), "Octave is not installed")
    def test_functions_for_octave(self):
        write_input(self, "t", self.M, self.K, self.D, self.Phi, self.dof_map, self.xyz, (0.5, -0.25, 2.0), mass=2.5)
        self.bough("integrals", "t.inp", "t.mat", "--digits", "17", "--fi", "t.fi", "-o", "t.FLX")
        scipy.io.savemat(self.path("in.mat"), {"M": self.M, "K": self.K, "Phi": self.Phi, "xyz": self.xyz,
                                               "dof_map": self.dof_map.astype(float)})
        folder = os.path.join(SOURCE, "data/matlab")
        self.write("main.m", f"addpath('{folder}'); load in.mat; R = [0.5 -0.25 2];\n"
                            "F = fimake5(M, dof_map, xyz, R); out = modall(M, K, Phi, dof_map, xyz, 2.5, R);\n"
                            "save -v7 out.mat F out\n")
        subprocess.run(["octave", "--no-gui", "--quiet", "main.m"], cwd=self.folder, check=True)
        found, flx = scipy.io.loadmat(self.path("out.mat")), self.read_flx("t.FLX")
        self.assert_equal(found["F"], np.loadtxt(self.path("t.fi"))[:, 2:], "fimake5")
        for name in ["alpha", "gamma0", "gamma1", "gamma2", "gamma3", "gamma4"]:
            self.assert_equal(found["out"][name][0, 0], flx[name], name)

    @unittest.skipUnless(shutil.which("octave"), "Octave is not installed")
    def test_the_call_of_the_report(self):
        """fimake5(idof_tab, nnode, phir, mass) and modall of the same arguments: node numbers with a gap; the numbers by
        the other form, nodes renumbered."""
        write_input(self, "t", self.M, self.K, self.D, self.Phi, self.dof_map, self.xyz)
        numbers = np.array([3, 205, 17, 40, 8, 90])      # of the nodes 1 to 6
        idof = self.dof_map.astype(float)
        nodal = (idof[:, 1] >= 1) & (idof[:, 1] <= 6)
        idof[nodal, 0] = numbers[self.dof_map[nodal, 0].astype(int) - 1]
        lone = [k for k in range(1, 7) if np.sum((self.dof_map[:, 0] == k) & (self.dof_map[:, 1] <= 3)) == 1]
        self.assertTrue(lone)
        kept = np.flatnonzero(~np.isin(self.dof_map[:, 0], lone))
        scipy.io.savemat(self.path("in.mat"), {
            "M": self.M, "K": self.K, "Phi": self.Phi, "xyz": self.xyz, "idof_tab": idof, "kept": kept + 1.0,
            "dof_map": self.dof_map.astype(float),
            "phir": treeflx.rigid_modes(self.dof_map, self.xyz, (0.5, -0.25, 2.0))})
        folder = os.path.join(SOURCE, "data/matlab")
        self.write("main.m", f"addpath('{folder}'); load in.mat; fi = fimake5(idof_tab, 205, phir, M);\n"
                             "F = fimake5(M, dof_map, xyz, [0.5 -0.25 2]);\n"
                             "try, modall(idof_tab, 205, phir, M, K, Phi, 2.5); what = ''; catch e, what = e.message; end\n"
                             "idof_tab = idof_tab(kept, :); dof_map = dof_map(kept, :); phir = phir(kept, :);\n"
                             "M = M(kept, kept); K = K(kept, kept); Phi = Phi(kept, :);\n"
                             "a = modall(idof_tab, 205, phir, M, K, Phi, 2.5);\n"
                             "b = modall(M, K, Phi, dof_map, xyz, 2.5, [0.5 -0.25 2]);\n"
                             "save -v7 out.mat fi F a b what\n")
        subprocess.run(["octave", "--no-gui", "--quiet", "main.m"], cwd=self.folder, check=True)
        found = scipy.io.loadmat(self.path("out.mat"))
        self.assert_equal(found["fi"], found["F"], "fimake5")
        self.assertIn(f"node {min(numbers[np.array(lone) - 1])} has one translation", str(found["what"]))
        for name in ["mass", "stiffness", "alpha", "gamma0", "gamma1", "gamma2", "gamma3", "gamma4"]:
            self.assert_equal(found["a"][name][0, 0], found["b"][name][0, 0], name)
        n = self.Phi.shape[1]
        special = np.zeros((6, n, n + 1))
        special[0, range(n), range(1, n + 1)] = 1
        np.testing.assert_array_equal(found["a"]["special"][0, 0], special)

    def test_the_shipped_integrals_are_read_by_plain_read_statements(self):
        """READ(unit, *) of the report: each line begins with a value, and what stands behind the values is passed over."""
        for name in ("test.inp", "test.mat"):
            with open(os.path.join(SOURCE, "data/integrals", name)) as f:
                for line in f:
                    self.assertRegex(line, r"^\s*(\d+\*)?[-+]?\d+(\.\d*)?([DE][-+]?\d+)?[\s,]")

    def test_exact_set(self):
        write_input(self, "t", self.M, self.K, self.D, self.Phi, self.dof_map, self.xyz, nodes=(1,))
        self.bough("integrals", "t.inp", "t.mat", "--integrals", "exact", "--digits", "17", "-o", "t.FLX")
        flx, expected = self.read_flx("t.FLX"), exact_integrals(self.M, self.Phi, self.dof_map, self.xyz)
        self.assertEqual(flx["method"], "exact")
        for name in expected:
            self.assert_equal(flx[name], expected[name], name)

    def test_generalized_dofs_have_no_spin_loads(self):
        write_input(self, "t", self.M, self.K, self.D, self.Phi, self.dof_map, self.xyz)
        result = self.bough("integrals", "t.inp", "t.mat", "--fi", "t.fi", "-o", "t.FLX")
        self.assertIn("[flx.generalized-dofs]", result.stderr)
        partial = sum(1 <= np.sum((self.dof_map[:, 0] == k) & (self.dof_map[:, 1] <= 3)) <= 2 for k in range(1, 7))
        self.assertGreater(partial, 0)
        self.assertIn(f"warning: {partial} nodes lack", result.stderr)
        self.assertIn("[flx.missing-dofs]", result.stderr)


class Example(OracleTest):
    """data/integrals: the numbers of docs/formats/flx.md, worked out by hand."""

    def setUp(self):
        super().setUp()
        self.data = os.path.join(SOURCE, "data/integrals")

    def run_example(self, *options):
        return self.bough("integrals", os.path.join(self.data, "test.inp"), os.path.join(self.data, "test.mat"), *options)

    def test_the_shipped_flx_is_what_is_written(self):
        self.run_example("-o", "test.FLX")
        with open(self.path("test.FLX")) as written, open(os.path.join(self.data, "test.flx")) as shipped:
            self.assertEqual(written.read(), shipped.read())

    def test_by_hand(self):
        result = self.run_example("-o", "test.FLX")
        self.assertEqual(result.stderr, "")
        flx = self.read_flx("test.FLX")
        zero = np.zeros((3, 3))
        self.assertEqual((flx["body_id"], flx["modopt"], flx["mass"]), (7, 0, 4))
        np.testing.assert_array_equal(flx["generalized_mass"], np.diag([6.5, 3]))
        np.testing.assert_array_equal(flx["generalized_stiffness"], np.diag([16, 6]))
        np.testing.assert_allclose(flx["generalized_damping"], np.diag([1.6, 0.6]), rtol=1e-8)
        np.testing.assert_array_equal(flx["alpha"], [[0, 1, 0], [0.75, 0, 0]])
        np.testing.assert_array_equal(flx["gamma1"], [[0, 0, 6.5], [0, 0, 0]])
        np.testing.assert_array_equal(flx["gamma2"], [[[0, 0, 0], [0, 0, -4]], [[0, 0, 4], [0, 0, 0]]])
        first = zero.copy()
        first[1, 0] = -6
        np.testing.assert_array_equal(flx["gamma3"], [first, np.diag([0, 4, 4])])
        yx, xy = zero.copy(), zero.copy()
        yx[1, 0] = xy[0, 1] = -4
        np.testing.assert_array_equal(flx["gamma4"], [[np.diag([6, 0, 6]), yx], [xy, np.diag([0, 3, 3])]])
        self.assertEqual(flx["nodes"], {"id": [1, 2], "xyz": [[1, 0, 0], [2, 0, 0]]})
        self.assertEqual(np.array(flx["gains"])[1, :, 0].tolist(), [0, 2, 0, 0, 0, 1])
        self.assertEqual(flx["special_nodes"]["id"], [3, 4, 5])
        self.assertEqual(np.array(flx["special_nodes"]["gains"])[:, 0].tolist(), [[0, 0], [1, 0], [0, 1]])

    def test_write_read_write(self):
        for digits in [[], ["--digits", "17"], ["--digits", "3"]]:
            self.run_example("-o", "a.FLX", *digits)
            self.bough("flx", "--read", "a.FLX", "-o", "b.FLX")
            with open(self.path("a.FLX")) as a, open(self.path("b.FLX")) as b:
                self.assertEqual(a.read(), b.read())

    def test_text_names_every_block(self):
        self.run_example("-o", "a.FLX")
        text = self.bough("flx", "--read", "a.FLX").stdout
        for words in ["body id: 7", "generalized mass", "generalized stiffness", "generalized damping", "alpha", "gamma1",
                      "gamma2", "gamma3", "gamma4", "output nodes", "gains", "special nodes"]:
            self.assertIn(words, text)

    def test_layouts_in_fixed_columns(self):
        self.run_example("--layout", os.path.join(self.data, "columns.layout"), "-o", "t.FLX")
        with open(self.path("t.FLX")) as f:
            lines = f.read().splitlines()
        self.assertEqual(lines[0], "    7    0    2    2    3  0.40000000E+01")
        self.assertEqual(lines[1], "  0.65000000E+01  0.00000000E+00")
        self.assertEqual(lines[7], " MODE     1")
        self.assertEqual(lines[9], "  0.00000000E+00  0.00000000E+00  0.65000000E+01")
        # Read as a Fortran program with 5E16.8 would: sixteen columns a number.
        values = [float(line[i:i + 16]) for line in lines[1:7] for i in range(0, len(line), 16)]
        self.assertEqual(values, [6.5, 0, 0, 3, 16, 0, 0, 6, 1.6, 0, 0, 0.6])

    def test_faults_from_outside(self):
        self.fails(1, "integrals", "no.inp", "no.mat", says=["no.inp"], error="cli.no-file")
        self.fails(2, "flx", error="cli.usage")
        self.write("bad.inp", "2 5 2\n1 1\n")
        self.write("bad.mat", "1\n")
        result = self.fails(1, "integrals", "bad.inp", "bad.mat", "-o", "x.FLX", error="flx.short-file")
        self.assertIn("bad.inp:2: error: item 2 of 15: degree-of-freedom map, entry 2 of 5", result.stderr)
        self.assertFalse(os.path.exists(self.path("x.FLX")))
        self.write("site.layout", "block nonsense\n")
        self.run_fails(["--layout", "site.layout"], "flx.layout-name")
        self.write("site.layout", "block mass number=F3.2\n")
        self.run_fails(["--layout", "site.layout", "-o", "y.FLX"], "flx.number-too-wide")
        self.assertFalse(os.path.exists(self.path("y.FLX")))

    def run_fails(self, options, error):
        self.fails(1, "integrals", os.path.join(self.data, "test.inp"), os.path.join(self.data, "test.mat"), *options,
                   error=error)


if __name__ == "__main__":
    unittest.main()
