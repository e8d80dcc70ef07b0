"""ex05-plate: bounded at 0.165 lb/in, unbounded at 0.170 after a tap at 1 s; the critical load from the body file."""
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh

from support import ProgramTest


class Plate(ProgramTest):
    def test_bounded_below_and_unbounded_above_the_critical_load(self):
        self.copy_example("ex05-plate")
        self.bough("reduce", "plate.toml")
        with h5py.File(self.path("plate.h5")) as f:
            at = list(f["/stiffening/locator/name"].asstr()).index("running")
            K, K_G2 = f["/modal/stiffness"][:], f["/stiffening/kg_external"][at]
            resultant = f["/stiffening/load_resultant"][:, at]
        critical = -1 / eigh(K_G2, K, eigvals_only=True)[0]
        self.assertLess(abs(critical / 0.1675 - 1), 0.01)
        self.assertLess(np.abs(resultant).max(), 1e-10)
        deflection = {}
        for p in ["0.165", "0.170"]:
            self.bough("run", f"plate-{p}.toml", "-o", f"plate-{p}.h5")
            t, found = self.read_arrays(f"plate-{p}.h5", "time", "sensors/deflection")
            deflection[p] = np.abs(found[:, 2])
            self.assertLess(deflection[p][t < 1].max(), 1e-8)  # flat until the tap
        self.assertLess(deflection["0.165"].max(), 0.01)
        self.assertGreater(deflection["0.170"][-1], 1.0)
        # Without stiffening it stays flat: said before the run, not half a second into it.
        for name, share in (("0.165", "0.985"), ("0.170", "1.01"), ("0.060", None)):
            with open(self.path("plate-0.170.toml")) as f:
                text = f.read().replace('file = "plate.h5"', 'file = "plate.h5"\nstiffening = false')
            self.write("flat.toml", text.replace("value = 0.170", f"value = {name}").replace("duration = 15.0", "duration = 0.6"))
            for verb in ("check", "run"):
                said = self.bough(verb, "flat.toml").stderr
                self.assertEqual("[run.unstiffened-load]" in said, share is not None, said)
                self.assertIn(f"are {share}" if share else "", said)
        self.assertNotIn("[run.unstiffened-load]", self.bough("check", "plate-0.170.toml").stderr)
        self.bough("plot", "plate-0.165.h5", "plate-0.170.h5", "--sensor", "deflection:z", "--y-min", "-0.01",
                   "--y-max", "0.04", "-o", "plate.svg")
        with open(self.path("plate.svg")) as f:
            self.assertIn("<svg", f.read(200))


if __name__ == "__main__":
    unittest.main()
