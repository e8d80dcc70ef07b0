"""compare: frequencies, MAC, integrals, K_G and effective mass of two models; one body's integrals by method; orders of
refined meshes. Against the series of the cantilever, NumPy and what does not change under flips, order and origin."""
import json
import os
import sys
import unittest

import h5py
import numpy as np
import scipy.sparse

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tests/oracle"))
from point_frame import DECK as FRAME, MASSES  # noqa: E402

LENGTH, MASS = 1.0, 0.27


def cantilever(elements, first_id=1, step=None, base=0.0):
    """A beam along x in the x-y plane; with ids that refined meshes share."""
    step = step or 64 // elements
    lines = ["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,4", "PARAM,COUPMASS,1",
             "GRDSET,,,,,,,345", f"SPC1,1,123456,{first_id}", "PBAR,1,1,1.-4,1.-8,1.-8,1.-8", "MAT1,1,7.+10,,.3,2700."]
    for i in range(elements + 1):
        lines.append(f"GRID,{first_id + i * step},,{base + LENGTH * i / elements!r},0.,0.")
    for i in range(elements):
        lines.append(f"CBAR,{i + 1},1,{first_id + i * step},{first_id + (i + 1) * step},0.,1.,0.")
    return "\n".join(lines + ["ENDDATA", ""])


def mac(a, b):
    """Nodes x 3 x modes."""
    a, b = a.reshape(-1, a.shape[2]), b.reshape(-1, b.shape[2])
    return (a.T @ b)**2 / np.outer((a**2).sum(0), (b**2).sum(0))


class Compare(ProgramTest):
    def body(self, name, elements=16, modes=4, options=(), **more):
        self.write(name + ".bdf", cantilever(elements, **more))
        last = more.get("first_id", 1) + elements * (more.get("step") or 64 // elements)
        self.bough("reduce", name + ".bdf", "--modes", modes, "--interface", last, *options, "-o", name + ".h5", "-q")
        return self.path(name + ".h5")

    def json(self, *arguments):
        return json.loads(self.bough("compare", *arguments, "--json").stdout)

    def test_integrals_of_the_cantilever(self):
        """Series of the clamped beam: effective masses, integrals of the shapes."""
        self.body("b", 32)
        r = self.json("b.h5")
        captured = np.array(r["integrals"]["exact"]["captured"], float)
        share = np.diff(np.vstack([np.zeros(6), captured]), axis=0)
        np.testing.assert_allclose(share[:, 1], [0.613076, 0.188300, 0.064732, 0.033087], atol=2e-5)
        np.testing.assert_allclose(share[:, 5], [0.970688, 0.024716, 0.003152, 0.000821], atol=2e-5)
        norm = np.array(r["integrals"]["exact"]["norm"])
        root = np.sqrt(MASS)
        np.testing.assert_allclose(norm[:3, 0], root * np.array([.782992, .433936, .254425]), rtol=1e-5)
        np.testing.assert_allclose(norm[:3, 1], root * LENGTH * np.array([.568826, .090767, .032416]), rtol=2e-5)
        consistent = np.array(r["integrals"]["consistent"]["difference"], float)
        self.assertLess(np.nanmax(consistent[:, :2]), 1e-12)
        self.assertGreater(consistent[0, 3], 1e-6)
        with h5py.File(self.path("b.h5")) as f:
            for method in ["lumped", "consistent", "exact"]:
                g = f["integrals"][method]
                expected = [np.linalg.norm(g[f"gamma{k}"][:].reshape(4, -1), axis=1) for k in range(5)]
                np.testing.assert_allclose(np.array(r["integrals"][method]["norm"]).T, expected, rtol=1e-13, atol=1e-15)
            e, c = f["integrals/exact/gamma3"][:], f["integrals/consistent/gamma3"][:]
            for j in range(4):
                size = max(np.linalg.norm(e[j]), np.linalg.norm(c[j]))
                self.assertAlmostEqual(consistent[j, 3], np.linalg.norm(e[j] - c[j]) / size, delta=1e-14)

    def test_a_complete_clamped_basis_captures_the_body(self):
        """Σ Γ0 Γ0ᵀ = m 1, Σ Γ1 Γ1ᵀ = J, Σ Γ1 Γ0ᵀ = m c~: all nine modes of three masses, nothing at the clamp."""
        self.write("frame.bdf", FRAME)
        self.bough("reduce", "frame.bdf", "--modes", 9, "-o", "frame.h5", "-q")
        r = self.json("frame.h5")
        self.assertEqual(len(r["frequency_hz"]), 9)
        rigid = np.array(r["rigid"])
        self.assertAlmostEqual(rigid[0, 0], sum(MASSES.values()))
        for method in ["lumped", "consistent", "exact"]:
            total = np.array(r["integrals"][method]["captured_total"])
            np.testing.assert_allclose(total, rigid, atol=1e-9 * rigid.max())
            np.testing.assert_allclose(r["integrals"][method]["captured"][-1], np.ones(6), atol=1e-9)

    def test_refinement(self):
        names = [os.path.basename(self.body(f"b{n}", n)) for n in (8, 16, 32)]
        r = self.json("--refinement", *names)
        np.testing.assert_allclose(r["element_size"], [1 / 8, 1 / 16, 1 / 32])
        rows = {(row["mode"], row["quantity"]): row for row in r["rows"]}
        beta = np.array([1.8751040687, 4.6940911330, 7.8547574382])
        analytic = beta**2 * np.sqrt(7e10 * 1e-8 / (2700 * 1e-4)) / (2 * np.pi)
        for mode in (1, 2, 3):
            self.assertAlmostEqual(rows[mode, "Hz"]["order"], 4, delta=0.1)
            self.assertAlmostEqual(rows[mode, "Hz"]["extrapolated"] / analytic[mode - 1], 1, delta=2e-6)
            self.assertAlmostEqual(rows[mode, "lumped Γ0"]["order"], 2, delta=0.02)
            self.assertAlmostEqual(rows[mode, "lumped Γ1"]["order"], 2, delta=0.02)
            # The momentum formulas of a consistent M miss O(h²) in Γ3.
            self.assertAlmostEqual(rows[mode, "consistent Γ3"]["order"], 2, delta=0.05)
            # All methods go to one value.
            gamma0 = np.sqrt(MASS) * [.782992, .433936, .254425][mode - 1]
            self.assertAlmostEqual(rows[mode, "lumped Γ0"]["extrapolated"] / gamma0, 1, delta=2e-5)
            exact = rows[mode, "exact Γ3"]["value"][-1]  # of the lines between the grids: nothing left to extrapolate
            self.assertAlmostEqual(rows[mode, "consistent Γ3"]["extrapolated"] / exact, 1, delta=1e-3)
        text = self.bough("compare", "--refinement", *names).stdout
        self.assertIn("consistent Γ3", text)
        self.assertLessEqual(max(map(len, text.splitlines())), 100)
        self.fails(1, "compare", "--refinement", names[0], names[2], names[1], error="cli.not-refined")

    def test_mac_is_numpys(self):
        self.body("a", 8)
        self.body("b", 16)
        r = self.json("a.h5", "b.h5")
        self.assertEqual((r["nodes"]["matched"], r["nodes"]["by_id"], r["nodes"]["offset"]), (9, 9, [0, 0, 0]))
        with h5py.File(self.path("a.h5")) as a, h5py.File(self.path("b.h5")) as b:
            expected = mac(a["modes/phi"][:][:, :3], b["modes/phi"][:][::2, :3])
            np.testing.assert_allclose(r["mac"], expected, atol=1e-12)
            for p in r["pairs"]:
                self.assertEqual(p["a"], p["b"])
                np.testing.assert_allclose(p["effective_mass_a"], a["effective_mass"][:][p["a"] - 1])
                hz = b["modes/frequency_hz"][p["b"] - 1] / a["modes/frequency_hz"][p["a"] - 1] - 1
                self.assertAlmostEqual(p["difference"], hz, delta=1e-14)
                self.assertGreater(p["in_span"], 0.9999)

    def test_flips_and_order_change_nothing(self):
        self.body("a")
        self.write("b.toml", '[body]\nname = "b"\ndeck = "a.bdf"\ninterface = [65]\n'
                   "[body.modes]\nnumber = 4\nselect = [3, 1, 4, 2]\n")
        self.bough("reduce", "b.toml", "-o", "b.h5", "-q")
        with h5py.File(self.path("b.h5"), "r+") as f:
            s = np.array([1, -1, 1, -1.])
            f["modes/phi"][:] *= s
            for path in ["modal/damping", "stiffening/kg_inertial", "stiffening/kg_external"]:
                f[path][...] = f[path][:] * np.outer(s, s)
            for method in f["integrals"]:
                g = f["integrals"][method]
                for k, shape in [(0, (4, 1)), (1, (4, 1)), (3, (4, 1, 1))]:
                    g[f"gamma{k}"][...] = g[f"gamma{k}"][:] * s.reshape(shape)
                g["gamma2"][...] = g["gamma2"][:] * np.outer(s, s)[:, :, None]
                g["gamma4"][...] = g["gamma4"][:] * np.outer(s, s)[:, :, None, None]
        r = self.json("a.h5", "b.h5")
        self.assertEqual([(p["a"], p["b"]) for p in r["pairs"]], [(1, 2), (2, 4), (3, 1), (4, 3)])
        for p in r["pairs"]:
            self.assertAlmostEqual(p["mac"], 1, delta=1e-12)
        for method in ["lumped", "consistent", "exact"]:
            self.assertLess(np.nanmax(np.array(r["integrals"][method]["difference"], float)), 1e-9)
        self.assertEqual(len(r["stiffness"]), 18)  # twelve accelerations, three forces and three moments at 65
        for d in r["stiffness"]:
            if d["difference"] is not None:
                self.assertLess(d["difference"], 1e-8)
        self.assertGreater([d["norm_a"] for d in r["stiffness"] if d["load"] == "wz2"][0], 1)

    def test_another_origin(self):
        self.body("a")
        self.write("same.bdf", cantilever(16))
        self.bough("reduce", "same.bdf", "--modes", 4, "--origin", ".3", "-.2", ".1", "-o", "b.h5", "-q")
        r = self.json("a.h5", "b.h5")
        np.testing.assert_allclose(r["nodes"]["offset"], [-0.3, 0.2, -0.1], atol=1e-12)
        self.assertEqual(r["nodes"]["by_id"], 17)
        for method in ["lumped", "consistent", "exact"]:
            difference = np.array(r["integrals"][method]["difference"], float)
            self.assertLess(np.nanmax(difference), 1e-9)
            # Γ2 of modes in one plane vanishes; the exact Γ3 cannot be moved from one origin to another.
            np.testing.assert_array_equal(np.isnan(difference), [[False, False, True, method == "exact", False]] * 4)
        # K_G of rotations about another point are other matrices and left out.
        self.assertEqual([d["load"] for d in r["stiffness"]][:3], ["ax", "ay", "az"])
        self.assertNotIn("wz2", [d["load"] for d in r["stiffness"]])

    def test_nodes_by_place_and_a_modes_file(self):
        self.body("a", 16)
        self.write("b.bdf", cantilever(16, first_id=1001, step=1))
        self.bough("modes", "b.bdf", "-o", "b.h5", "-q")
        r = self.json("a.h5", "b.h5")
        self.assertEqual((r["nodes"]["by_id"], r["nodes"]["by_place"]), (0, 17))
        for p in r["pairs"]:
            self.assertAlmostEqual(p["mac"], 1, delta=1e-12)
        self.assertNotIn("integrals", r)
        self.write("far.bdf", cantilever(16, first_id=2001, step=1, base=5.03))
        self.bough("modes", "far.bdf", "-o", "far.h5", "-q")
        self.fails(1, "compare", "a.h5", "far.h5", error="cli.no-common-nodes")

    def test_mass_weighted(self):
        self.body("a", 8)
        self.body("b", 16)
        self.bough("matrices", "a.bdf", "--no-kg", "-o", "k.h5", "-q")
        r = self.json("a.h5", "b.h5", "--mass", "k.h5")
        with h5py.File(self.path("k.h5")) as f:
            M = scipy.sparse.csr_matrix((f["M/data"][:], f["M/indices"][:], f["M/indptr"][:]), shape=f["M/shape"][:])
        with h5py.File(self.path("a.h5")) as a, h5py.File(self.path("b.h5")) as b:
            x, y = (phi.reshape(-1, 4) for phi in (a["modes/phi"][:], b["modes/phi"][:][::2]))
        expected = (x.T @ M @ y)**2 / np.outer(np.diag(x.T @ M @ x), np.diag(y.T @ M @ y))
        np.testing.assert_allclose(r["mass_mac"], expected, atol=1e-12)
        self.assertIn("MAC by mass", self.bough("compare", "a.h5", "b.h5", "--mass", "k.h5").stdout)
        # The other deck's matrices have rows at grids that A does not have.
        self.bough("matrices", "b.bdf", "--no-kg", "-o", "kb.h5", "-q")
        self.fails(1, "compare", "a.h5", "b.h5", "--mass", "kb.h5", error="cli.mass-without-shape")
        self.fails(1, "compare", "a.h5", "b.h5", "--mass", "a.h5", error="cli.no-mass-matrix")

    def test_torsion_is_seen_by_its_rotations(self):
        deck = cantilever(8).replace("GRDSET,,,,,,,345\n", "").replace("EIGRL,1,,,4", "EIGRL,1,,,12")
        inertia = "".join(f"CONM2,{100 + i},{1 + 8 * i},,0.,,,,,+\n+,1.-4\n" for i in range(1, 9))
        self.write("t.bdf", deck.replace("PBAR,1,1,1.-4,1.-8,1.-8,1.-8", "PBAR,1,1,1.-4,1.-8,4.-8,1.-10")
                   .replace("ENDDATA", inertia + "ENDDATA"))
        self.bough("modes", "t.bdf", "-o", "t.h5", "-q")
        with h5py.File(self.path("t.h5")) as f:
            phi = f["modes/phi"][:]
        turning = np.flatnonzero(np.abs(phi[:, :3]).max(axis=(0, 1)) < 1e-6 * np.abs(phi[:, 3]).max(axis=0))
        self.assertGreater(len(turning), 1)
        r = self.json("t.h5", "t.h5")
        for j in turning:
            self.assertAlmostEqual(r["mac"][j][j], 1)
            self.assertLess(max(v for k, v in enumerate(r["mac"][j]) if k not in turning), 1e-9)

    def test_files_and_tables(self):
        self.body("a", 8)
        self.body("b", 16)
        for arguments in [("a.h5",), ("a.h5", "b.h5")]:
            text = self.bough("compare", *arguments, "-o", "c.h5").stdout
            self.assertLessEqual(max(map(len, text.splitlines())), 100)
            r = self.json(*arguments)
            with h5py.File(self.path("c.h5")) as f:
                self.assertEqual(f.attrs["format"], "bough-comparison")
                for method in ["lumped", "consistent", "exact"]:
                    np.testing.assert_array_equal(f[f"integrals/{method}/difference"][:],
                                                  np.array(r["integrals"][method]["difference"], float))
                if len(arguments) == 2:
                    np.testing.assert_array_equal(f["mac"][:], r["mac"])
                    np.testing.assert_array_equal(f["pairs"][:, 4], [p["mac"] for p in r["pairs"]])
                    self.assertEqual([w.decode() for w in f["stiffness/load"][:]], [d["load"] for d in r["stiffness"]])
                    np.testing.assert_array_equal(f["nodes"][:, 0], f["nodes"][:, 1])
        self.body("d", 32)
        self.bough("compare", "--refinement", "a.h5", "b.h5", "d.h5", "-o", "r.h5", "-q")
        with h5py.File(self.path("r.h5")) as f:
            self.assertEqual(f["refinement/values"].shape[1], 6)

    def test_the_report_of_reduce_is_that_of_compare(self):
        self.body("a", 8)
        text = self.bough("reduce", "a.bdf", "--modes", 4, "--integrals-report", "-o", "again.h5").stdout
        report = self.bough("compare", "again.h5").stdout
        self.assertIn("consistent diff", report)
        self.assertTrue(text.endswith("\n" + report))
        # --json gives the table of modes alone.
        json.loads(self.bough("reduce", "a.bdf", "--modes", 4, "--integrals-report", "--json", "-o", "b.h5").stdout)

    def test_reduce_tells_how_its_modes_were_checked(self):
        self.body("a", 8)
        text = self.bough("reduce", "a.bdf", "--modes", 4, "-o", "b.h5").stdout
        count = "Sturm count: 4 eigenvalues up to the highest"
        self.assertIn(count + ", 4 found: none missed\n", text)
        residual = float(text.split("largest residual of a mode:")[1].split()[0])
        self.assertTrue(0 < residual < 1e-8, residual)
        # With its end held the beam is another one, whose modes are counted.
        self.write("c.toml", '[body]\nname = "c"\ndeck = "a.bdf"\ninterface = [65]\n[body.modes]\nnumber = 3\n'
                   'basis = "craig-bampton"\n')
        held = ["reduce", "c.toml", "-o", "c.h5"]
        self.assertIn("Sturm count: 3 eigenvalues up to the highest with the interface held, 3 found",
                      self.bough(*held).stdout)
        check = json.loads(self.bough(*held, "--json").stdout)["modes_check"]
        self.assertEqual((check["found"], check["inertia_count"]), (3, 3))
        self.assertLess(check["residual"], 1e-8)

    def test_what_cannot_be_compared(self):
        self.body("a", 8)
        self.bough("modes", "a.bdf", "-o", "m.h5", "-q")
        self.bough("matrices", "a.bdf", "--no-kg", "-o", "k.h5", "-q")
        self.fails(1, "compare", "a.h5", "k.h5", error="cli.not-comparable")
        self.fails(1, "compare", "m.h5", error="cli.not-a-body")
        self.fails(1, "compare", "a.h5", "nothing.h5", error="cli.no-file")
        self.fails(2, "compare", "a.h5", "a.h5", "a.h5", error="cli.usage")
        self.fails(2, "compare", "--refinement", "a.h5", "a.h5", error="cli.usage")
        with h5py.File(self.path("a.h5"), "r+") as f:
            del f["integrals/exact"]
            f["integrals"].attrs["method"] = "consistent"
        self.fails(1, "compare", "a.h5", error="cli.no-exact-integrals")

    def test_shapes_as_csv(self):
        self.body("a", 8)
        self.bough("modes", "a.bdf", "-o", "m.h5", "-q")
        for name in ["a", "m"]:
            self.bough("export", name + ".h5", "--to", "csv", "-o", name + ".csv")
            table = np.genfromtxt(self.path(name + ".csv"), delimiter=",", names=True)
            with h5py.File(self.path(name + ".h5")) as f:
                np.testing.assert_array_equal(table["id"], f["nodes/id"][:])
                np.testing.assert_array_equal(table["x"], f["nodes/xyz"][:][:, 0])
                phi = f["modes/phi"][:]
                self.assertEqual(len(table.dtype.names), 4 + 6 * phi.shape[2])
                for j in range(phi.shape[2]):
                    for d, direction in enumerate(["x", "y", "z", "rx", "ry", "rz"]):
                        np.testing.assert_array_equal(table[f"mode_{j + 1:03}_{direction}"], phi[:, d, j])


if __name__ == "__main__":
    unittest.main()
