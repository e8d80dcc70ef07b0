"""compare --test and --sensors: SEREP, Guyan, IRS, orthogonality, COMAC and effective independence by NumPy."""
import json
import re
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from support import ProgramTest
from decks import begin, bent_cantilever

N = 9  # grids of a cantilever with a bend


def make_deck(inertia="2.-6", modes=6):
    return begin(103, "SPC = 1", "METHOD = 1") + (
        f"PARAM,COUPMASS,1\nEIGRL,1,,,{modes}\nPBAR,1,1,1.-3,1.-6,{inertia},3.-6\nMAT1,1,7.+10,,.3,2700.\n"
        f"{bent_cantilever(N)}SPC1,1,123456,1\nCONM2,90,9,,0.5\nENDDATA\n")


MEASURED = [(3, "xyz"), (5, "xyz"), (7, "xz"), (8, "z"), (9, "xyz")]


def write_uff(path, nodes, shapes, hz, is_complex=False, with_nodes=True, systems=None, before=()):
    """Datasets 15 and 55; shapes: {node: 3 x n}; systems: {node: displacement system}; before: lines of datasets."""
    lines = list(before)
    if with_nodes:
        lines += ["    -1", "    15"]
        lines += ["%10d%10d%10d%10d%13.5E%13.5E%13.5E" % (node, 0, (systems or {}).get(node, 0), 1, *nodes[node])
                  for node in shapes]
        lines += ["    -1"]
    for j, f in enumerate(hz):
        lines += ["    -1", "    55", *["NONE"] * 5]
        if is_complex:
            pole = 2 * np.pi * f * complex(-0.02, np.sqrt(1 - 0.02**2))
            lines += ["%10d%10d%10d%10d%10d%10d" % (1, 3, 2, 8, 5, 3), "%10d%10d%10d%10d" % (2, 6, 1, j + 1),
                      "%13.5E%13.5E%13.5E%13.5E%13.5E%13.5E" % (pole.real, pole.imag, 0, 0, 0, 0)]
        else:
            lines += ["%10d%10d%10d%10d%10d%10d" % (1, 2, 2, 8, 2, 3), "%10d%10d%10d%10d" % (2, 4, 1, j + 1),
                      "%13.5E%13.5E%13.5E%13.5E" % (f, 1, 0.01, 0)]
        for node, values in shapes.items():
            row = values[:, j] * (np.exp(0.7j) if is_complex else 1)
            numbers = np.column_stack([row.real, row.imag]).ravel() if is_complex else row
            lines += ["%10d" % node, "".join("%13.5E" % v for v in numbers)]
        lines += ["    -1"]
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")


class Correlation(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.bdf", make_deck())
        self.bough("modes", "a.bdf", "-o", "a.h5")
        self.bough("matrices", "a.bdf", "-o", "k.h5")
        self.write("t.bdf", make_deck("2.3-6", 5))
        self.bough("modes", "t.bdf", "-o", "t.h5")
        with h5py.File(self.path("k.h5")) as f:
            K, M = (csr_matrix((f[f"/{m}/data"], f[f"/{m}/indices"], f[f"/{m}/indptr"]), shape=f[f"/{m}/shape"]).toarray()
                    for m in "KM")
        self.K, self.M = K[6:, 6:], M[6:, 6:]  # grid 1 is fixed
        # Torsion has no mass: the largest eigenvalues of (M, K).
        values, vectors = (a[..., ::-1][..., :6] for a in eigh(self.M, self.K))
        self.hz, self.modes = 1 / np.sqrt(values) / 2 / np.pi, vectors / np.sqrt(values)
        self.rows = [6 * (node - 2) + "xyz".index(c) for node, axes in MEASURED for c in axes]
        with h5py.File(self.path("t.h5")) as f:
            ids, phi, self.test_hz = f["nodes/id"][:], f["modes/phi"][:], f["modes/frequency_hz"][:]
            places = f["nodes/xyz"][:]
        noise = np.random.default_rng(5)
        scale = np.abs(phi).max(axis=(0, 1))
        self.nodes = {int(i): places[k] for k, i in enumerate(ids)}
        self.shapes = {}
        for node, axes in MEASURED:
            values = phi[list(ids).index(node)][:3] + 0.02 * scale * noise.standard_normal((3, 5))
            self.shapes[node] = values * np.array([[c in axes] for c in "xyz"])
        write_uff(self.path("t.unv"), self.nodes, self.shapes, self.test_hz)
        # With the digits of the file.
        self.psi = np.array([[float("%.5E" % v) for v in self.shapes[node]["xyz".index(c)]]
                             for node, axes in MEASURED for c in axes])

    def compare(self, *arguments):
        return json.loads(self.bough("compare", "a.h5", "--test", "t.unv", "--json", *arguments).stdout)

    def calc_tam(self, kind):
        a = self.rows
        o = [i for i in range(len(self.K)) if i not in a]
        if kind == "serep":
            P = np.linalg.pinv(self.modes[a])
            return P.T @ P, None
        T = np.zeros((len(self.K), len(a)))
        T[a] = np.eye(len(a))
        T[o] = -np.linalg.solve(self.K[np.ix_(o, o)], self.K[np.ix_(o, a)])
        if kind == "irs":
            Ma, Ka = T.T @ self.M @ T, T.T @ self.K @ T
            S = np.zeros_like(self.K)
            S[np.ix_(o, o)] = np.linalg.inv(self.K[np.ix_(o, o)])
            T = T + S @ self.M @ T @ np.linalg.solve(Ma, Ka)
        M, K = T.T @ self.M @ T, T.T @ self.K @ T
        return M, np.sqrt(eigh(K, M, eigvals_only=True)) / 2 / np.pi

    def test_models_and_orthogonality(self):
        for kind in ("serep", "guyan", "irs"):
            found = self.compare("--tam", kind, *([] if kind == "serep" else ["--deck", "a.bdf"]), "-o", "c.h5")
            M, hz = self.calc_tam(kind)
            with h5py.File(self.path("c.h5")) as f:
                mass = f["mass"][:]
                np.testing.assert_array_equal(f["dofs"][:], [[node, 1 + "xyz".index(c)] for node, axes in MEASURED for c in axes])
                np.testing.assert_allclose(f["test/frequency_hz"][:], self.test_hz, rtol=1e-5)
            # SEREP inverts shapes: the digits of the modes are lost by its condition.
            np.testing.assert_allclose(mass, M, atol=(1e-6 if kind == "serep" else 1e-9) * np.abs(M).max())
            if hz is not None:
                np.testing.assert_allclose(found["model_hz"], hz, rtol=1e-8)
            def scale(X):
                return X / np.sqrt(np.einsum("ij,ik,kj->j", X, M, X))
            cross = scale(self.modes[self.rows]).T @ M @ scale(self.psi)
            np.testing.assert_allclose(np.abs(found["cross_orthogonality"]), np.abs(cross), atol=1e-6)
            self_orthogonality = scale(self.psi).T @ M @ scale(self.psi)
            np.testing.assert_allclose(np.abs(found["self_orthogonality"]), np.abs(self_orthogonality), atol=1e-6)
        # The reduced models: Guyan above the modes, IRS nearer than it.
        guyan, irs = (np.array(self.calc_tam(kind)[1][:4]) / self.hz[:4] - 1 for kind in ("guyan", "irs"))
        self.assertTrue(np.all(guyan > 0) and np.all(np.abs(irs) < guyan))

    def test_mac_comac_and_pairs(self):
        found = self.compare()
        X, Y = self.modes[self.rows], self.psi
        moves = [k for k, row in enumerate(self.rows) if row % 6 < 3]
        self.assertEqual(len(moves), len(self.rows))
        mac = (X.T @ Y)**2 / np.outer((X**2).sum(axis=0), (Y**2).sum(axis=0))
        np.testing.assert_allclose(found["mac"], mac, atol=1e-8)
        self.assertEqual([(p["a"], p["test"]) for p in found["pairs"]], [(k, k) for k in range(1, 6)])
        M = self.calc_tam("serep")[0]
        A, B = (Z / np.sqrt(np.einsum("ij,ik,kj->j", Z, M, Z)) for Z in (X[:, :5], Y))
        comac = np.abs(A * B).sum(axis=1)**2 / ((A**2).sum(axis=1) * (B**2).sum(axis=1))
        np.testing.assert_allclose([d["comac"] for d in found["dofs"]], comac, atol=1e-7)
        text = self.bough("compare", "a.h5", "--test", "t.unv").stdout
        self.assertRegex(text, r"A +Hz +test +Hz +difference % +MAC +cross-orth\. +largest other +MPC")
        self.assertIn(found["dofs"][int(np.argmin(comac))]["name"], text)

    def test_complex_shapes_and_files_without_nodes(self):
        real = self.compare()
        write_uff(self.path("t.unv"), self.nodes, self.shapes, self.test_hz, is_complex=True, with_nodes=False)
        turned = self.compare("-o", "c.h5")
        np.testing.assert_allclose(turned["mac"], real["mac"], atol=1e-4)
        np.testing.assert_allclose([p["phase_collinearity"] for p in turned["pairs"]], 1, atol=1e-4)
        with h5py.File(self.path("c.h5")) as f:
            np.testing.assert_allclose(f["test/damping"][:], 0.02, rtol=1e-4)
            np.testing.assert_allclose(f["test/frequency_hz"][:], self.test_hz, rtol=1e-5)

    def test_displacement_systems(self):
        """Components along local axes (datasets 2420 and 18, three kinds of systems) give the numbers of the basic axes."""
        rng = np.random.default_rng(3)
        nodes, shapes = self.nodes, {k: rng.standard_normal((3, 5)) + self.shapes[k] for k in (3, 5, 7, 8, 9)}
        write_uff(self.path("t.unv"), nodes, shapes, self.test_hz)
        plain = self.compare()
        origin, z = np.array([.3, -.7, .2]), np.array([1., 2., 2.]) / 3
        x = np.cross([0., 0., 1.], z) / np.linalg.norm(np.cross([0., 0., 1.], z))
        R = np.column_stack([x, np.cross(z, x), z])  # columns: the axes

        def axes(node, kind):
            p = R.T @ (np.array([float("%.5E" % v) for v in nodes[node]]) - origin)
            r, rho = np.hypot(*p[:2]), np.linalg.norm(p)
            radial, around = np.array([p[0], p[1], 0]) / r, np.array([-p[1], p[0], 0]) / r
            if kind == 0:
                return R
            if kind == 1:
                return R @ np.column_stack([radial, around, [0, 0, 1]])
            down = np.array([p[0] * p[2] / r, p[1] * p[2] / r, -r]) / rho
            return R @ np.column_stack([p / rho, down, around])

        lines = ["    -1", "  2420", "%10d" % 1, "part"]
        for label, kind in ((11, 0), (12, 1), (13, 2)):
            lines += ["%10d%10d%10d" % (label, kind, 8), "system"]
            lines += ["%25.16E%25.16E%25.16E" % tuple(row) for row in (*R.T, origin)]
        points = np.concatenate([origin, origin + 2 * R[:, 0], origin + R[:, 2] + .5 * R[:, 0]])
        lines += ["    -1", "    -1", "    18", "%10d%10d%10d%10d%10d" % (21, 1, 0, 8, 1), "cylinder",
                  "".join("%13.5E" % v for v in points[:6]), "".join("%13.5E" % v for v in points[6:]), "    -1"]
        systems = {3: 11, 5: 12, 7: 13, 8: 21, 9: 0}
        kinds = {11: 0, 12: 1, 13: 2, 21: 1}
        local = {k: axes(k, kinds[systems[k]]).T @ v if systems[k] else v for k, v in shapes.items()}
        write_uff(self.path("t.unv"), nodes, local, self.test_hz, systems=systems, before=lines)
        turned = self.compare()
        np.testing.assert_allclose(turned["mac"], plain["mac"], atol=2e-5)
        np.testing.assert_allclose(turned["cross_orthogonality"], plain["cross_orthogonality"], atol=2e-4)
        write_uff(self.path("t.unv"), nodes, local, self.test_hz, before=lines)  # axes ignored: other numbers
        self.assertGreater(np.abs(np.array(self.compare()["mac"]) - plain["mac"]).max(), 1e-2)
        # A system of which the file has nothing; a component that was not measured.
        write_uff(self.path("t.unv"), nodes, local, self.test_hz, systems=systems)
        self.fails(1, "compare", "a.h5", "--test", "t.unv", error="matrices.uff", says=["node 3", "coordinate system 11"])
        local[3][1] = 0
        write_uff(self.path("t.unv"), nodes, local, self.test_hz, systems=systems, before=lines)
        self.fails(1, "compare", "a.h5", "--test", "t.unv", error="matrices.uff", says=["component 2 of node 3"])

    def test_a_file_of_ours_is_read(self):
        """Six components a node: the model against itself."""
        self.bough("export", "a.h5", "--to", "uff", "-o", "t.unv")
        found = self.compare()
        np.testing.assert_allclose(np.diag(found["mac"]), 1, atol=1e-8)
        np.testing.assert_allclose(np.abs(found["cross_orthogonality"]), np.eye(6), atol=1e-3)

    def test_effective_independence(self):
        for number in (6, 9):
            found = json.loads(self.bough("compare", "a.h5", "--sensors", number, "--json").stdout)
            candidates = [(node, c) for node in range(2, N + 1) for c in range(3)]
            Phi = np.array([self.modes[6 * (node - 2) + c] for node, c in candidates])
            rows = list(range(len(Phi)))
            while len(rows) > number:
                Q, _ = np.linalg.qr(Phi[rows])
                del rows[int(np.argmin((Q**2).sum(axis=1)))]
            self.assertEqual([(s["node"], s["component"] - 1) for s in found["sensors"]], [candidates[k] for k in rows])
            Q, _ = np.linalg.qr(Phi[rows])
            np.testing.assert_allclose([s["independence"] for s in found["sensors"]], (Q**2).sum(axis=1), atol=1e-7)
        self.fails(1, "compare", "a.h5", "--sensors", "5", error="cli.few-sensors", says=["6"])
        self.assertIn("largest MAC", self.bough("compare", "a.h5", "--sensors", "8").stdout)

    def test_wrong_input_is_named(self):
        self.fails(2, "compare", "a.h5", "--test", "t.unv", "--tam", "irs", says=["--deck"])
        self.fails(1, "compare", "a.h5", "--test", "none.unv", error="cli.no-file")
        text = self.read("t.unv")
        self.write("t.unv", "    -1\n    15\n    -1\n")
        self.fails(1, "compare", "a.h5", "--test", "t.unv", error="matrices.uff", says=["no mode shape"])
        at = text.splitlines().index("    55") + 1
        lines = text.splitlines()
        lines[at + 9] = lines[at + 9][:13] + "        0.1x2" + lines[at + 9][26:]
        self.write("t.unv", "\n".join(lines))
        self.fails(1, "compare", "a.h5", "--test", "t.unv", error="matrices.bad-number", says=[f"t.unv:{at + 10}"])
        self.write("t.unv", re.sub(r"(?m)^         3$", "        77", text))
        printed = self.bough("compare", "a.h5", "--test", "t.unv", code=1).stderr
        self.assertIn("node 77 of a shape has no coordinates", printed)

    def test_dofs_without_use_are_named(self):
        nodes, shapes = self.nodes, self.shapes
        write_uff(self.path("z.unv"), nodes, {k: 0 * v for k, v in shapes.items()}, self.test_hz)
        self.fails(1, "compare", "a.h5", "--test", "z.unv", error="cli.test-unmeasured")
        write_uff(self.path("z.unv"), nodes, {k: shapes[k] * np.array([[0], [0], [1]]) for k in (3, 5)}, self.test_hz)
        self.fails(1, "compare", "a.h5", "--test", "z.unv", error="cli.test-rank", says=["2 measured dofs"])
        # Grid 1 is fixed in the deck: SEREP takes it, Guyan leaves it out.
        write_uff(self.path("z.unv"), nodes, {1: 1e-3 * shapes[3], **shapes}, self.test_hz)
        printed = self.bough("compare", "a.h5", "--test", "z.unv", "--tam", "guyan", "--deck", "a.bdf").stderr
        self.assertIn("[cli.test-dofs]", printed)
        self.assertIn("component 1 of grid 1", printed)
        write_uff(self.path("z.unv"), {**nodes, 50: (9, 9, 9)}, {**shapes, 50: shapes[3]}, self.test_hz)
        self.assertIn("1 of 6 nodes", self.bough("compare", "a.h5", "--test", "z.unv").stderr)

    def test_decks_of_other_models(self):
        tam = ["--test", "t.unv", "--tam", "guyan", "--deck", "o.bdf"]
        deck = "\n".join(line for line in make_deck().split("\n") if not line.startswith(("GRID,9", "CBAR,8", "CONM2")))
        self.write("o.bdf", deck)
        self.fails(1, "compare", "a.h5", *tam, error="cli.test-deck", says=["grid 9"])
        self.write("o.bdf", make_deck().replace("GRID,5,,4.0,0.0,0.\n", "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.6,0.8,0.\nGRID,5,,4.0,0.0,0.,7\n"))
        self.fails(1, "compare", "a.h5", *tam, error="cli.test-axes", says=["grid 5"])
        self.write("o.bdf", make_deck().replace("PARAM,COUPMASS,1", "PARAM,COUPMASS,0"))
        self.bough("export", "a.h5", "--to", "uff", "-o", "t.unv")
        self.fails(3, "compare", "a.h5", *tam, error="modal.test-mass")


if __name__ == "__main__":
    unittest.main()
