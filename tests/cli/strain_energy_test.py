"""Strain energy of the elements of a flexible body: its sum, each against `modes --ese`, of fewer modes, in other units,
and as colours of the moving system (ParaView's cells, the report page)."""
import glob
import unittest

import h5py
import meshio
import numpy as np

from support import ProgramTest, launch_ranks
from toml_text import section, table, toml

SYSTEM = toml(
    table("body", "plate", file="plate.h5"),
    table("body", "other", file="plate.h5"),
    table("hinge", "base", "revolute", child="plate", axis=[1.0, 0.0, 0.0], rate=[2.0]),
    table("hinge", "far", "revolute", parent_position=[0.0, 3.0, 0.0], child="other", axis=[0.0, 1.0, 0.0],
          rate=[-4.0]),
    section("simulation", duration=0.05, output_step=0.01, gravity=[0.0, 0.0, -9.81]))


def expand(packed):
    """e x n x n of an upper triangle row by row."""
    n = int((np.sqrt(8 * packed.shape[1] + 1) - 1) / 2)
    full = np.zeros((len(packed), n, n))
    i, j = np.triu_indices(n)
    full[:, i, j] = full[:, j, i] = packed
    return full


class StrainEnergy(ProgramTest):
    def reduce(self, modes=4, *more):
        self.copy_example("ex05-plate")
        self.bough("reduce", "plate.bdf", "--modes", modes, "--strain-energy", *more, "-o", "plate.h5")
        return self.read("plate.h5")

    def read(self, name):
        with h5py.File(self.path(name)) as f:
            return (f["/strain_energy/id"][()], expand(f["/strain_energy/matrix"][()]), f["/modal/stiffness"][()],
                    {name: f[name][()] for name in ("/modal/frequency_hz",) if name in f})

    def test_elements_sum_to_the_stiffness(self):
        ids, k, K, _ = self.reduce()
        np.testing.assert_allclose(k.sum(axis=0), K, atol=1e-10 * np.abs(K).max())
        self.assertGreaterEqual(np.linalg.eigvalsh(k).min(), -1e-10 * np.abs(K).max())
        self.bough("modes", "plate.bdf", "-n", "4", "--ese", "-o", "modes.h5")
        with h5py.File(self.path("modes.h5")) as f:
            share = f["energies/strain"][()] / f["energies/total_strain"][()]
            np.testing.assert_array_equal(f["energies/id"], ids)
        np.testing.assert_allclose(np.einsum("eii->ei", k) / np.diag(K), share, atol=1e-9)

    def test_a_preload_is_not_among_it(self):
        self.copy_example("ex05-plate")
        self.write("body.toml", toml(
            section("body", name="plate", deck="plate.bdf"),
            section("body.preload", spin=[0.0, 0.0, 5.0]),
            section("body.modes", number=3),
            section("body.output", file="spun.h5", strain_energy=True)))
        self.bough("reduce", "body.toml")
        _, k, K, _ = self.read("spun.h5")
        with h5py.File(self.path("spun.h5")) as f:
            K_G = f["stiffening/kg_preload"][()]
        self.assertGreater(np.abs(K_G).max(), 1e-6 * np.abs(K).max())
        np.testing.assert_allclose(k.sum(axis=0), K - K_G, atol=1e-9 * np.abs(K).max())

    def test_cells_of_the_modes_of_a_body(self):
        ids, k, _, _ = self.reduce()
        self.bough("export", "plate.h5", "--to", "vtu", "-o", "plate.vtu")
        mesh = meshio.read(self.path("plate.vtu"))
        name = next(key for key in mesh.cell_data if key.startswith("mode_002") and key.endswith("_strain_energy"))
        share = dict(zip(ids, k[:, 1, 1] / k[:, 1, 1].sum()))
        for element, value in zip(np.concatenate(mesh.cell_data["element_id"]), np.concatenate(mesh.cell_data[name])):
            self.assertAlmostEqual(value, share.get(element, 0), places=12)

    def test_of_two_ranks_is_the_same(self):
        _, k, _, _ = self.reduce()
        self.bough("reduce", "plate.bdf", "--modes", "4", "--strain-energy", "-o", "two.h5",
                   launcher=launch_ranks("-n", 2))
        two = self.read("two.h5")[1]
        np.testing.assert_allclose(np.einsum("eii->ei", two), np.einsum("eii->ei", k), atol=1e-7 * np.abs(k).max())

    def test_of_fewer_modes_and_in_other_units(self):
        ids, k, K, _ = self.reduce()
        self.bough("select", "plate.h5", "--keep", "2,4", "-n", "2", "-o", "fewer.h5")
        kept, few, _, _ = self.read("fewer.h5")
        np.testing.assert_array_equal(kept, ids)
        np.testing.assert_array_equal(few, k[:, [[1], [3]], [1, 3]])
        self.bough("convert", "plate.h5", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.h5")
        _, mm, K_mm, _ = self.read("mm.h5")
        np.testing.assert_allclose(mm.sum(axis=0), K_mm, atol=1e-10 * np.abs(K_mm).max())
        np.testing.assert_allclose(mm * K[0, 0] / K_mm[0, 0], k, atol=1e-12 * np.abs(k).max())

    def test_cells_of_the_moving_system(self):
        ids, k, K, _ = self.reduce()
        self.write("two.toml", SYSTEM)
        self.bough("run", "two.toml", "-o", "run.h5")
        self.bough("export", "run.h5", "--to", "pvd", "-o", "run.pvd")
        with h5py.File(self.path("run.h5")) as f:
            eta = {body: f[f"bodies/{body}/eta"][()] for body in ("plate", "other")}
        frames = sorted(glob.glob(self.path("run-frames/*.vtu")))
        self.assertEqual(len(frames), len(eta["plate"]))
        for sample in (1, len(frames) - 1):
            mesh = meshio.read(frames[sample])
            cells = mesh.cell_data["element_strain_energy"]
            names = np.concatenate(mesh.cell_data["element_id"])
            found = np.concatenate(cells)
            half = len(names) // 2
            for body, part in (("plate", slice(0, half)), ("other", slice(half, None))):
                expected = dict(zip(ids, 0.5 * np.einsum("i,eij,j->e", eta[body][sample], k, eta[body][sample])))
                np.testing.assert_allclose(found[part], [expected.get(name, 0) for name in names[part]],
                                           atol=1e-12 * max(expected.values()))
            of_bodies = mesh.point_data["strain_energy"].ravel()
            self.assertAlmostEqual(found[:half].sum() / of_bodies[0], 1, places=9)
            self.assertAlmostEqual(found[half:].sum() / of_bodies[-1], 1, places=9)
        self.assertGreater(np.abs(found[:half] - found[half:]).max(), 1e-3 * found.max())

    def test_the_key_of_the_body_file(self):
        self.copy_example("ex05-plate")
        self.write("body.toml", toml(
            section("body", name="plate", deck="plate.bdf"),
            section("body.modes", number=2),
            section("body.output", file="keyed.h5", strain_energy=True)))
        self.bough("reduce", "body.toml")
        _, k, K, _ = self.read("keyed.h5")
        np.testing.assert_allclose(k.sum(axis=0), K, atol=1e-10 * np.abs(K).max())
        self.bough("reduce", "plate.bdf", "--modes", "2", "-o", "plain.h5")
        with h5py.File(self.path("plain.h5")) as f:
            self.assertNotIn("strain_energy", f)


if __name__ == "__main__":
    unittest.main()
