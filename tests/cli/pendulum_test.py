"""A pendulum of a slender beam, let go level: one flexible body against 64 rigid segments on springs, from outside."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from planar_chain import name_sensor, write_segments
from toml_text import Bare, section, table, toml

BARS, EI, RHO_A, LENGTH = 32, 0.6, 0.27, 1.0
# Damping in proportion to stiffness: 2 % in the first bending mode of the free beam.
FIRST = 22.3733 * np.sqrt(EI / RHO_A) / LENGTH**2
BETA = 2 * 0.02 / FIRST

BODY = toml(
    section("body", name="beam", deck="beam.bdf", frame="mean", interface=[1]),
    section("body.modes", number=Bare("MODES")),
    section("body.output", file="beam.h5"))

RUN = section("simulation", duration=1.2, output_step=0.01, gravity=[0.0, -9.81, 0.0], integrator="INTEGRATOR",
              relative_tolerance=1e-7, absolute_tolerance=1e-9)


class BeamPendulum(ProgramTest):
    def run_system(self, text):
        """Places of the tip (nt x 2), and of the middle off the line from the pin to the tip (nt)."""
        self.write("system.toml", text)
        self.bough("run", "system.toml", "-o", "results.h5", "--force")
        with h5py.File(self.path("results.h5")) as f:
            tip, middle = f["sensors/tip"][:, :2], f["sensors/middle"][:, :2]
        along = tip / np.linalg.norm(tip, axis=1)[:, None]
        return tip, along[:, 0] * middle[:, 1] - along[:, 1] * middle[:, 0]

    def make_flexible(self, modes, **keys):
        deck = ["SOL 103", "CEND", "METHOD = 1", "BEGIN BULK", "PARAM,COUPMASS,1", f"EIGRL,1,,,{modes}",
                "GRDSET,,,,,,,345", f"PBAR,1,1,1.-4,{EI / 7e10:.6e},{EI / 7e10:.6e},1.-10", "MAT1,1,7.+10,,.3,2700."]
        deck += [f"GRID,{i + 1},,{i * LENGTH / BARS:.6g},0.,0." for i in range(BARS + 1)]
        deck += [f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,0.,1." for i in range(BARS)]
        self.write("beam.bdf", "\n".join(deck + ["ENDDATA", ""]))
        self.bough("reduce", self.write("beam.toml", BODY.replace("MODES", str(modes))), "--force")
        with h5py.File(self.path("beam.h5")) as f:
            ratios = list(BETA / 2 * np.sqrt(f["modes/eigenvalue"][:]))
        return toml(
            table("body", "beam", file="beam.h5", damping=[float(r) for r in ratios], **keys),
            table("hinge", "pin", "revolute", child="beam", child_node=1),
            name_sensor("tip", "beam", BARS + 1), name_sensor("middle", "beam", BARS // 2 + 1),
            RUN.replace("INTEGRATOR", "auto"))

    def make_chain(self, segments):
        h = LENGTH / segments
        return toml(
            write_segments(segments, h, RHO_A * h, 1e-9, EI, BETA),
            name_sensor("tip", f"s{segments - 1}", 1), name_sensor("middle", f"s{segments // 2}", 0),
            RUN.replace("INTEGRATOR", "bdf"))

    def test_flexible_body_falls_as_its_segments_do(self):
        tip, bow = self.run_system(self.make_chain(64))
        size = np.abs(bow).max()
        self.assertAlmostEqual(size, 0.0275, delta=0.0005)
        fewer, _ = self.run_system(self.make_chain(32))
        self.assertLess(np.abs(fewer - tip).max(), 5e-5)  # what segments are off by: a quarter of it with 64
        flexible, shape = self.run_system(self.make_flexible(6))
        self.assertLess(np.abs(flexible - tip).max(), 1e-3 * LENGTH)
        self.assertLess(np.abs(shape - bow).max(), 0.025 * size)
        # Without stiffening it bows twice as far: its own weight and spin pull it straight.
        loose, shape = self.run_system(self.make_flexible(6, stiffening=False))
        self.assertGreater(np.abs(loose - tip).max(), 0.015 * LENGTH)
        self.assertGreater(np.abs(shape - bow).max(), 0.8 * size)


if __name__ == "__main__":
    unittest.main()
