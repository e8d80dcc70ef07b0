"""One structure in units of length from a nanometre to a hundred thousand kilometres: every command takes it alike."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest


def write_panel(size):
    """A warped panel of CQUAD4 clamped on one side, a bar along the other, a mass on an RBE2; the load pulls, then the
    modes are those of the loaded panel."""
    L, n = size, 3
    grid = [f"GRID,{1 + i + 4 * j},,{L * i / n:.6e},{L * j / n:.6e},{.05 * L * i * j / 9:.6e}"
            for j in range(n + 1) for i in range(n + 1)]
    quads = [f"CQUAD4,{1 + i + 4 * j},1,{1 + i + 4 * j},{2 + i + 4 * j},{6 + i + 4 * j},{5 + i + 4 * j}"
             for j in range(n) for i in range(n)]
    bars = [f"CBAR,{101 + j},2,{4 + 4 * j},{8 + 4 * j},0.,0.,1." for j in range(n)]
    return "\n".join([
        "SOL 103", "CEND", "SPC = 1", "METHOD = 9", "SUBCASE 1", "LOAD = 2", "SUBCASE 2", "STATSUB(PRELOAD) = 1",
        "BEGIN BULK", "EIGRL,9,,,6", "MAT1,1,1.6+11,,.22,2300.", f"PSHELL,1,1,{.01 * L:.6e},1,,1",
        f"PBAR,2,1,{1e-4 * L**2:.6e},{1e-9 * L**4:.6e},{2e-9 * L**4:.6e},{2e-9 * L**4:.6e}", *grid, *quads, *bars,
        f"GRID,99,,{1.1 * L:.6e},{L:.6e},{.1 * L:.6e}", "RBE2,200,16,123456,99", f"CONM2,201,99,,{2.3 * L**3:.6e}",
        "SPC1,1,123456,1,5,9,13", f"FORCE,2,16,,{1e4 * L**2:.6e},1.,.2,.1", "ENDDATA"]) + "\n"


class TestUnits(ProgramTest):
    def run_all(self, size):
        """u in sizes, frequencies times the size, K_G of the load in its units, modal frequencies of a body."""
        self.write("p.bdf", write_panel(size))
        self.bough("static", "p.bdf", "-o", "s.h5", "--subcase", "1")
        with h5py.File(self.path("s.h5")) as f:
            case = f["subcases"][list(f["subcases"])[0]]
            u = case["displacement"][:].reshape(-1, 6)
        u[:, :3] /= size
        modes = json.loads(self.bough("modes", "p.bdf", "--subcase", "2", "--json").stdout)
        self.bough("matrices", "p.bdf", "--subcase", "1", "-o", "k.h5")
        self.bough("reduce", "p.bdf", "--subcase", "1", "--modes", "6", "-o", "b.h5")
        with h5py.File(self.path("b.h5")) as f:
            hz = f["modes/frequency_hz"][:]
        return [u.ravel(), size * np.sqrt(modes["eigenvalue"]), size * hz]

    def test_every_verb_takes_every_size(self):
        expected = self.run_all(1)
        for size in (1e-9, 1e-6, 1e-4, 1e4, 1e8):
            for found, right in zip(self.run_all(size), expected):
                self.assertLess(np.abs(found - right).max(), 1e-6 * np.abs(right).max(), size)

    def test_residual_vectors_at_a_rigid_interface(self):
        """Forces and moments on the independent grid of an RBE2, which has no stiffness itself."""
        found = {}
        for size in (1e-6, 1e-3, 1, 1e3, 1e6):
            deck = write_panel(size).replace("SPC1,1,123456,1,5,9,13\n", "")
            deck = "SOL 103\nCEND\n" + deck[deck.index("BEGIN BULK"):]
            self.write("p.bdf", deck.replace("RBE2,200,16,123456,99", "RBE2,200,99,123456,16,12,15"))
            self.write("b.toml", '[body]\nname = "b"\ndeck = "p.bdf"\nframe = "mean"\ninterface = [99]\n'
                       '[body.modes]\nnumber = 3\nresidual = ["interface"]\n')
            self.assertNotIn("residual-massless", self.bough("reduce", "b.toml", "-o", "b.h5").stderr)
            with h5py.File(self.path("b.h5")) as f:
                found[size] = size * f["modes/frequency_hz"][:]
        self.assertEqual(found[1].size, 9)
        for size, hz in found.items():
            np.testing.assert_allclose(hz, found[1], rtol=1e-5, err_msg=str(size))

    def test_loads_that_the_interface_holds_have_no_residual_vectors(self):
        """Interface grids on RBE3 of a line of bars: Craig-Bampton holds their loads, whatever the round-off."""
        for size in (1e-6, 1e-3, 1, 1e3):
            grids = "".join(f"GRID,{i + 1},,{.15 * i * size:.9e},0.,0.\n" for i in range(7))
            bars = "".join(f"CBAR,{i},1,{i},{i + 1},.1,.2,1.\n" for i in range(1, 7))
            self.write("p.bdf", "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nPARAM,COUPMASS,1\nMAT1,1,7.+10,,.3,2700.\nSPC1,1,123456,1\n"
                       f"PBAR,1,1,{2e-4 * size**2:.6e},{3e-9 * size**4:.6e},{5e-9 * size**4:.6e},{4e-9 * size**4:.6e}\n{grids}{bars}"
                       f"GRID,60,,{.3 * size:.6e},{.1 * size:.6e},{.05 * size:.6e}\nRBE3,501,,60,123456,1.,123456,2,3\n,4\n"
                       f"GRID,61,,{.45 * size:.6e},{.2 * size:.6e},{-.05 * size:.6e}\nRBE3,502,,61,123456,1.,123456,4,5\nENDDATA\n")
            found = []
            for residual in ("", 'residual = ["interface"]\n'):
                self.write("b.toml", '[body]\nname = "b"\ndeck = "p.bdf"\nframe = "fixed"\ninterface = [60, 61]\n'
                           f'[body.modes]\nbasis = "craig-bampton"\nnumber = 3\n{residual}')
                messages = self.bough("reduce", "b.toml", "-o", "b.h5").stderr
                self.assertNotIn("residual-massless", messages)
                self.assertIn("turning of grid 61 about (1 0 0)", messages)
                with h5py.File(self.path("b.h5")) as f:
                    found.append(size * f["modes/frequency_hz"][:])
            np.testing.assert_allclose(found[1], found[0], rtol=1e-9)

    def test_a_loose_panel_is_loose_in_every_size(self):
        for size in (1e-9, 1e-4, 1, 1e8):
            self.write("p.bdf", write_panel(size).replace("SPC1,1,123456,1,5,9,13", "SPC1,1,1346,1,5,9,13"))
            self.fails(1, "static", "p.bdf", "--subcase", "1", error="fe.mechanism", says=["component 2"])


if __name__ == "__main__":
    unittest.main()
