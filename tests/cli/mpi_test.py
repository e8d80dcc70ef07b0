"""The same numbers on one process and on two."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest


def launch(ranks):
    return ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)]


class Ranks(ProgramTest):
    def setUp(self):
        super().setUp()
        self.copy_example("ex01-spinup")

    def test_modes(self):
        found = [json.loads(self.bough("modes", "boom.bdf", "-n", 5, "--json", launcher=launch(n)).stdout) for n in (1, 2)]
        np.testing.assert_allclose(found[1]["eigenvalue"], found[0]["eigenvalue"], rtol=1e-9)
        np.testing.assert_allclose(found[1]["effective_mass"], found[0]["effective_mass"], atol=1e-8)

    def test_reduce(self):
        for n in (1, 2):
            self.bough("reduce", "boom.toml", "-o", f"boom{n}.h5", launcher=launch(n))
        with h5py.File(self.path("boom1.h5")) as a, h5py.File(self.path("boom2.h5")) as b:
            self.assertEqual(sorted(a), sorted(b))
            for path in ["/modes/eigenvalue", "/modes/phi", "/stiffening/kg_inertial", "/stiffening/kg_external",
                         "/integrals/exact/gamma0", "/integrals/exact/gamma4", "/rigid/inertia"]:
                scale = max(np.abs(a[path][:]).max(), 1e-300)
                np.testing.assert_allclose(b[path][:] / scale, a[path][:] / scale, atol=1e-7, err_msg=path)

    def test_an_error_is_said_once(self):
        self.write("bad.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nENDDATA\n")
        one = self.bough("check", "bad.bdf", code=1).stderr.count("error:")
        two = self.bough("check", "bad.bdf", code=1, launcher=launch(2)).stderr
        self.assertEqual(two.count("bad.bdf:5: error:"), self.bough("check", "bad.bdf", code=1).stderr.count("bad.bdf:5: error:"))
        self.assertGreater(one, 0)


if __name__ == "__main__":
    unittest.main()
