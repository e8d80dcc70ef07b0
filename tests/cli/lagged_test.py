"""stiffening = "lagged", the report's own scheme, against the consistent one on the report's models."""
import unittest

import h5py
import numpy as np

from support import ProgramTest


class Lagged(ProgramTest):
    def run_one(self, name, changes=(), code=0):
        """Runs NAME.toml with texts replaced; the results."""
        text = open(self.path(name + ".toml")).read()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("run.toml", text)
        self.bough("run", "run.toml", "-o", "run.h5", code=code)
        return h5py.File(self.path("run.h5"))

    def lag(self, step, duration):
        return [("[simulation]", f'[simulation]\nstiffening = "lagged"\nstep = {step}'),
                ('integrator = "adams"', 'integrator = "rk4"'), duration]

    def test_spinup_converges_with_the_lag(self):
        """The error of the tip is of the first order in the step; consistent stiffening has none of it."""
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        until = ("duration = 20.0", "duration = 8.0")
        with self.run_one("spinup", [until]) as f:
            consistent = f["sensors/tip_deflection"][:, 1]
        tips = {}
        for step in (0.01, 0.005, 0.0025):
            with self.run_one("spinup", self.lag(step, until)) as f:
                tips[step] = f["sensors/tip_deflection"][:, 1]
                recorded = f["stiffening/boom"][:] if "stiffening/boom" in f else f["stiffening"]
        differences = [np.abs(tips[0.01] - tips[0.005]).max(), np.abs(tips[0.005] - tips[0.0025]).max()]
        self.assertLess(abs(differences[0] / differences[1] - 2), 0.3, differences)
        # Another linear theory, not the consistent one: near, to a few per cent of half a metre.
        self.assertLess(np.abs(tips[0.0025] - consistent).max(), 0.03)
        self.assertGreater(np.abs(tips[0.0025]).max(), 0.5)
        # A_I as measured: ωz² and αz of the shaft.
        self.assertGreater(recorded[-1, 8], 1)

    def test_what_it_does_not_measure_is_told(self):
        self.copy_example("ex02-hub")
        self.bough("reduce", "boom.toml")
        text = open(self.path("hub-2.18.toml")).read()
        text = text.replace("[simulation]", '[simulation]\nstiffening = "lagged"\nstiffening_step = 0.01')
        self.write("jet.toml", text + '\n[[actuator]]\nname = "jet"\ntype = "force"\nbody = "hub"\naxis = [1.0, 0.0, 0.0]\n')
        said = self.bough("check", "jet.toml").stderr
        self.assertIn("[system.lagged-loads]", said)
        self.assertIn("not of: jet", said)

    def test_hinges_that_it_feeds_back_are_told(self):
        self.copy_example("ex03-two-link")
        self.bough("reduce", "link.toml")
        text = open(self.path("two-link.toml")).read()
        self.write("lagged.toml", text.replace("[simulation]", '[simulation]\nstiffening = "lagged"\nstiffening_step = 0.01'))
        self.assertIn("[system.lagged-hinges]", self.bough("check", "lagged.toml").stderr)


if __name__ == "__main__":
    unittest.main()
