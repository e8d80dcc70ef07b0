"""Columns under end loads from outside: Beck's, whose load follows its tip, and Euler's, through reduce and linearize."""
import unittest

import h5py
import numpy as np
import scipy.optimize

from support import ProgramTest
from toml_text import section, table, toml

BARS, EI, LENGTH = 20, 7.0, 1.0

BODY = toml(
    section("body", name="column", deck="column.bdf", frame="fixed", interface=[21]),
    section("body.modes", number=8),
    section("body.output", file="column.h5"))

SYSTEM = toml(
    section("parameters", load=1.0),
    table("body", "column", file="column.h5", damping=0.0),
    table("hinge", "clamp", "fixed", child="column"),
    table("force", "push", body="column", node=21, force=["$load", 0.0, 0.0], frame="FRAME"),
    section("simulation", duration=1.0))


class Follower(ProgramTest):
    def setUp(self):
        super().setUp()
        deck = ["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "EIGRL,1,,,8", "GRDSET,,,,,,,345",
                "SPC1,1,123456,1", "PBAR,1,1,1.-4,1.-10,1.-10,1.-10", "MAT1,1,7.+10,,.3,2700."]
        deck += [f"GRID,{i + 1},,{i * LENGTH / BARS:.6g},0.,0." for i in range(BARS + 1)]
        deck += [f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,0.,1." for i in range(BARS)]
        self.write("column.bdf", "\n".join(deck + ["ENDDATA", ""]))
        self.bough("reduce", self.write("column.toml", BODY))

    def calc_poles(self, frame, load):
        """Poles about the state of rest under a push of load EI/L^2 along the column."""
        self.write("system.toml", SYSTEM.replace("FRAME", frame))
        self.bough("linearize", "system.toml", "--equilibrium", "--set", f"load={-load * EI / LENGTH**2!r}", "-o",
                   "model.h5", "--force")
        with h5py.File(self.path("model.h5")) as f:
            return np.linalg.eigvals(f["A"][:])

    def find_limit(self, frame, low, high):
        """The load at which a pole first leaves the imaginary axis."""
        return scipy.optimize.bisect(lambda load: self.calc_poles(frame, load).real.max() - 1e-2, low, high, xtol=2e-3)

    def test_beck_flutters_at_20_05(self):
        # Beck, ZAMP 3 (1952) 225: 20.0509 EI/L^2, where the first two pairs meet at 11.0156 sqrt(EI/(rho A L^4)).
        load = self.find_limit("node", 19.5, 20.5)
        self.assertAlmostEqual(load, 20.0509, delta=0.02)
        unstable = max(self.calc_poles("node", load + 0.05), key=lambda pole: pole.real)
        self.assertAlmostEqual(abs(unstable.imag) / np.sqrt(EI / 0.27), 11.0156, delta=0.02)

    def test_a_load_that_keeps_its_direction_buckles_at_eulers(self):
        load = self.find_limit("body", 2.4, 2.55)
        self.assertAlmostEqual(load, np.pi**2 / 4, delta=4e-3)
        # No oscillation is left: the pole that goes is real.
        unstable = max(self.calc_poles("body", 2.6), key=lambda pole: pole.real)
        self.assertLess(abs(unstable.imag), 1e-6)


if __name__ == "__main__":
    unittest.main()
