"""ex17-component: hub and delivered boom have the modes of the elements of both; the checks of the component."""
import json
import unittest

import numpy as np

from support import ProgramTest


class ComponentExample(ProgramTest):
    def test_numbers(self):
        self.copy_example("ex17-component")
        self.bough("export", "boom.bdf", "--to", "extseout", "-o", "boom")
        found = {deck: [m["frequency_hz"] for m in json.loads(self.bough("modes", deck, "--json").stdout)["modes"]]
                 for deck in ("craft.bdf", "whole.bdf")}
        np.testing.assert_allclose(found["craft.bdf"][:6], found["whole.bdf"][:6], rtol=1e-6)
        np.testing.assert_allclose(found["whole.bdf"][:6], [2.43223, 3.56098, 11.1339, 11.1929, 13.8775, 15.2939], rtol=5e-6)
        check = self.bough("check", "craft.bdf")
        self.assertIn("mass 3.66, centre of mass (2.40984, 0, 0)", check.stdout)
        self.assertIn("boundary held, Hz: 2.56929, 4.06241, 23.5377", check.stdout)
        # One boundary grid is a statically determinate support: its stiffness is round-off, and holds nothing.
        self.assertNotIn("fe.superelement-grounded", check.stderr + check.stdout)


if __name__ == "__main__":
    unittest.main()
