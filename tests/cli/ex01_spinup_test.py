"""ex01-spinup, its run lines as its README gives them, against data/reference/spinup.json."""
import json
import os
import sys
import unittest

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


if __name__ == "__main__":
    unittest.main()
