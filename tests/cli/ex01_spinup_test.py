"""ex01-spinup, its run lines as its README gives them, against data/reference/spinup.json."""
import json
import os
import sys
import unittest

import h5py

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tools"))
import spinup_numbers  # noqa: E402


class Spinup(ProgramTest):
    def test_deck_to_time_history(self):
        self.copy_example("ex01-spinup")
        data = json.loads(self.bough("check", "boom.bdf", "--json").stdout)
        self.assertAlmostEqual(data["mass_properties"]["mass"], 1.6154, delta=1e-4)
        self.bough("reduce", "boom.toml")
        self.bough("run", "spinup.toml", "-o", "spinup.h5")
        warned = self.bough("run", "spinup-no-kg.toml", "-o", "spinup-no-kg.h5")
        self.assertIn("run.linear-limit", warned.stderr)
        numbers = spinup_numbers.calc_numbers(*map(self.path, ["spinup.h5", "spinup-no-kg.h5", "boom.h5"]))
        for name, value, expected, error, tolerance, passed in spinup_numbers.compare(numbers):
            with self.subTest(name):
                self.assertTrue(passed, f"{name}: computed {value}, reference {expected}, off by {error:.2%} > {tolerance:.2%}")
        self.bough("plot", "spinup.h5", "spinup-no-kg.h5", "--sensor", "tip_deflection:y", "--y-min", "-1.2", "--y-max", "0.2",
                   "-o", "tip.svg")


    def test_eq_18_by_actuators_on_modal_coordinates(self):
        """The report's own stiffening, -Σ A_I K_G1 η as modal forces: the linear theory of rotating beams, -0.5346 m at
        6.77 s. The rate alone counts for the bending of a straight boom."""
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-q")
        with h5py.File(self.path("boom.h5")) as f:
            K = f["stiffening/kg_inertial"][8]
        n = len(K)
        law = ", ".join('"-u1^2*(' + " + ".join(f"{K[j, k]:.15g}*u{k + 2}" for k in range(n)) + ')"' for j in range(n))
        with open(self.path("spinup.toml")) as f:
            text = f.read().replace("stiffening = true", "stiffening = false").replace("duration = 20.0", "duration = 8.0")
        text += ('\n[[sensor]]\nname = "gyro"\ntype = "gyro"\nbody = "boom"\n[[sensor]]\nname = "eta"\n'
                 'type = "modal_coordinate"\nbody = "boom"\n[[controller]]\nname = "stiffen"\ntype = "expression"\n'
                 'inputs = ["gyro:z", ' + ", ".join(f'"eta:{k + 1}"' for k in range(n)) + f"]\nexpression = [{law}]\n")
        for j in range(n):
            text += (f'[[actuator]]\nname = "jet{j + 1}"\ntype = "modal"\nbody = "boom"\ncoordinate = {j + 1}\n'
                     f'input = "stiffen:{j + 1}"\n')
        self.write("literal.toml", text)
        self.bough("run", "literal.toml", "-o", "literal.h5", "-q")
        with h5py.File(self.path("literal.h5")) as f:
            y, t = f["sensors/tip_deflection"][:, 1], f["time"][:]
            self.assertEqual(f["actuators/jet1"].attrs["dims"], "by normalisation")
        self.assertAlmostEqual(y.min(), -0.5346, delta=2e-4)
        self.assertAlmostEqual(t[y.argmin()], 6.77, delta=0.03)
        self.write("bad.toml", text.replace("coordinate = 2", "coordinate = 9"))
        self.fails(1, "check", "bad.toml", says=["mode 9", "which has 3"], error="control.unknown-place")


if __name__ == "__main__":
    unittest.main()
