"""Dimension scales: the rows of every history stand at /time, those of responses at their frequencies."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml


class Scales(ProgramTest):
    def find_users(self, path, scale):
        """Datasets below the scale's folder whose first dimension it is; and whether the scale knows them."""
        with h5py.File(self.path(path)) as f:
            self.assertTrue(h5py.h5ds.is_scale(f[scale].id))
            users = []

            def visit(name, item):
                if isinstance(item, h5py.Dataset) and "DIMENSION_LIST" in item.attrs:
                    self.assertEqual(len(item.dims[0]), 1, name)
                    self.assertEqual(item.dims[0][0].name, scale)
                    self.assertEqual(item.shape[0], f[scale].shape[0])
                    self.assertTrue(all(len(item.dims[k]) == 0 for k in range(1, item.ndim)))
                    users.append(item.name)
            f.visititems(visit)
            known = {f[entry[0]].name for entry in f[scale].attrs["REFERENCE_LIST"]}
            self.assertEqual(known, set(users))
        return users

    def make_run(self):
        self.write("pendulum.toml", toml(
            table("body", "bob", mass=2.0, cg=[0.0, -0.7, 0.0]),
            table("hinge", "pin", "revolute", child="bob", axis=[0.0, 0.0, 1.0], position=[0.4]),
            table("sensor", "angle", "hinge_angle", hinge="pin"),
            section("simulation", duration=0.5, output_step=0.01, gravity=[0.0, -9.81, 0.0])))
        self.bough("run", "pendulum.toml", "-o", "run.h5")

    def test_channels_that_are_too_many_have_none(self):
        self.make_run()
        with open(self.path("pendulum.toml"), "a") as file:
            for k in range(4000):
                file.write(f'[[sensor]]\nname = "a{k}"\ntype = "hinge_angle"\nhinge = "pin"\n')
        self.bough("run", "pendulum.toml", "-o", "many.h5")
        with h5py.File(self.path("many.h5")) as f:
            self.assertEqual(len(f["/sensors"]), 4001)
            self.assertNotIn("DIMENSION_LIST", f["/sensors/a3999"].attrs)
            self.assertNotIn("REFERENCE_LIST", f["/time"].attrs)
            np.testing.assert_array_equal(f["/sensors/a3999"], f["/sensors/angle"])

    def test_of_a_run_and_of_one_that_goes_on(self):
        self.make_run()
        users = self.find_users("run.h5", "/time")
        for name in ("/sensors/angle", "/hinges/pin/q", "/bodies/bob/quaternion", "/energy/kinetic"):
            self.assertIn(name, users)
        with h5py.File(self.path("run.h5")) as f:
            np.testing.assert_array_equal(f["/sensors/angle"].dims[0][0][()], f["/time"][()])
        text = open(self.path("pendulum.toml")).read()
        self.write("pendulum.toml", text.replace("duration = 0.5", "duration = 0.8"))
        self.bough("run", "pendulum.toml", "-o", "run.h5", "--resume")
        self.assertEqual(self.find_users("run.h5", "/time"), users)
        self.bough("export", "run.h5", "--to", "csv", "-o", "run.csv")

    def test_of_responses_and_sweeps(self):
        self.make_run()
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "--inputs", "pin:1", "-o", "model.h5")
        self.bough("response", "model.h5", "-o", "response.h5")
        self.assertEqual(sorted(self.find_users("response.h5", "/frequency_hz")),
                         ["/imag", "/real", "/singular_values"])
        self.bough("linearize", "pendulum.toml", "--each", "3", "-o", "sweep.h5")
        self.assertIn("/poles/real", self.find_users("sweep.h5", "/parameter/value"))

    def test_of_the_responses_of_a_deck(self):
        deck = """SOL 111
CEND
SPC = 1
METHOD = 1
DLOAD = 5
FREQ = 6
DISP = ALL
FORCE = ALL
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CROD,1,1,1,2
PROD,1,1,1.
MAT1,1,1000.,,.3,1.
SPC1,1,123456,1
SPC1,1,23456,2
EIGRL,1,,,1
RLOAD1,5,7,,,8
DAREA,7,2,1,1.
TABLED1,8
,0.,1.,100.,1.,ENDT
FREQ1,6,1.,1.,4
ENDDATA
"""
        self.write("rod.bdf", deck)
        self.bough("frequency", "rod.bdf", "-o", "frequency.h5")
        users = self.find_users("frequency.h5", "/subcases/1/frequency_hz")
        self.assertIn("/subcases/1/displacement/real", users)
        self.assertIn("/subcases/1/elements/CROD/imag", users)


if __name__ == "__main__":
    unittest.main()
