"""static --vtu, and what check says of the files of static and matrices."""
import json
import unittest

import h5py
import meshio
import numpy as np

from support import BEAM, ProgramTest

LOADED = BEAM.replace("SPC = 1\nMETHOD = 1\n", "SPC = 1\nSUBCASE 1\nLOAD = 3\nSUBCASE 12\nLOAD = 4\n").replace(
    "ENDDATA", "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.6,0.8,0.\nFORCE,3,3,0,1.,0.,1.,0.\nMOMENT,4,2,0,2.,1.,0.,1.\nENDDATA").replace(
    "GRID,3,,2.,0.,0.", "GRID,3,,2.,0.,0.,7")


class SolutionFiles(ProgramTest):
    def test_vtu_of_static_holds_the_displacements_of_every_subcase(self):
        self.write("b.bdf", LOADED)
        self.bough("static", "b.bdf", "-o", "b.h5", "--vtu", "b.vtu")
        mesh = meshio.read(self.path("b.vtu"))
        self.assertEqual([(c.type, len(c.data)) for c in mesh.cells], [("line", 2)])
        with h5py.File(self.path("b.h5")) as f:
            for subcase in ["1", "12"]:
                u = f[f"/subcases/{subcase}/displacement"][:].reshape(3, 6)   # basic axes, as the picture
                name = f"subcase_{int(subcase):03d}_displacement"
                self.assertGreater(np.abs(u).max(), 0)
                self.assertTrue(np.array_equal(mesh.point_data[name], u[:, :3]))
                self.assertTrue(np.array_equal(mesh.point_data[name + "_rotation"], u[:, 3:]))
        self.fails(1, "static", "b.bdf", "--vtu", "b.vtu", "--no-clobber", error="cli.output-exists")

    def test_check_tells_what_the_files_hold(self):
        self.write("b.bdf", LOADED)
        self.bough("static", "b.bdf", "-o", "b.h5")
        text = self.bough("check", "b.h5").stdout
        self.assertIn("static solutions: 2 subcases on 18 dofs", text)
        self.assertIn("subcase 12: load set 4, forces of CBAR", text)
        found = json.loads(self.bough("check", "b.h5", "--json").stdout)
        self.assertEqual(found["kind"], "bough-static")
        self.assertEqual([s["id"] for s in found["subcases"]], [1, 12])
        self.bough("matrices", "b.bdf", "-o", "m.h5")
        self.assertIn("matrices K M KG/LOAD_3 KG/LOAD_4 on 18 dofs", self.bough("check", "m.h5").stdout)
        self.assertEqual(json.loads(self.bough("check", "m.h5", "--json").stdout)["kind"], "bough-matrices")

    def test_check_names_what_is_missing(self):
        self.write("b.bdf", LOADED)
        self.bough("static", "b.bdf", "-o", "b.h5")
        self.bough("matrices", "b.bdf", "-o", "m.h5")
        for name, gone in [("b.h5", "/subcases/12/reaction"), ("m.h5", "/M/indices")]:
            with h5py.File(self.path(name), "a") as f:
                del f[gone]
            self.assertIn(gone + " is missing", self.bough("check", name, code=1).stderr)


if __name__ == "__main__":
    unittest.main()
