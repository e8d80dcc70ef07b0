"""A slider-crank whose rod bends, as a flexible body and as a chain of rigid segments on springs, from outside."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from planar_chain import name_sensor, write_segments
from toml_text import section, table, toml

BARS, EI, RHO_A, LENGTH, CRANK = 20, 7.0, 0.27, 1.0, 0.2
SEGMENTS = 16
# Damping in proportion to stiffness: 5 % in the first mode.
BETA = 0.1 / (np.pi**2 * np.sqrt(EI / RHO_A))

BODY = toml(
    section("body", name="rod", deck="rod.bdf", frame="fixed", interface=[1, 21]),
    section("body.modes", number=3),
    section("body.output", file="rod.h5"))

FRAME = toml(
    table("body", "crank", mass=1.0, cg=[0.1, 0.0, 0.0], inertia=[0.01, 0.01, 0.01],
          nodes=[{"id": 1, "position": [0.2, 0.0, 0.0]}]),
    table("body", "piston", mass=0.5, inertia=[0.01, 0.01, 0.01]),
    table("hinge", "shaft", "revolute", child="crank", motion="angle"),
    table("hinge", "slide", "prismatic", child="piston", axis=[1.0, 0.0, 0.0], position=[1.2]),
    table("function", "angle", "spinup", rate=10.0, duration=0.5),
    section("simulation", duration=0.9, output_step=0.01, integrator="INTEGRATOR", relative_tolerance=1e-7,
            absolute_tolerance=1e-9))


class SliderCrank(ProgramTest):
    def calc_deflections(self, text):
        """Deflection of the middle of the rod from the line between its pins, and the force of the piston's guide along it."""
        self.write("system.toml", text)
        self.bough("run", "system.toml", "-o", "results.h5", "--force")
        with h5py.File(self.path("results.h5")) as f:
            a, middle, b = (f[f"sensors/{name}"][:] for name in ("first", "middle", "last"))
        chord = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
        off = middle - a
        return chord[:, 0] * off[:, 1] - chord[:, 1] * off[:, 0]

    def make_flexible(self):
        deck = ["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "EIGRL,1,,,3",
                "GRDSET,,,,,,,345", "SPC1,1,12,1", "SPC1,1,2,21", "PBAR,1,1,1.-4,1.-10,1.-10,1.-10",
                "MAT1,1,7.+10,,.3,2700."]
        deck += [f"GRID,{i + 1},,{i * LENGTH / BARS:.6g},0.,0." for i in range(BARS + 1)]
        deck += [f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,0.,1." for i in range(BARS)]
        self.write("rod.bdf", "\n".join(deck + ["ENDDATA", ""]))
        self.bough("reduce", self.write("rod.toml", BODY))
        ratios = [BETA / 2 * (j * np.pi)**2 * np.sqrt(EI / RHO_A) for j in (1, 2, 3)]
        return toml(
            FRAME.replace("INTEGRATOR", "rk"),
            table("body", "rod", file="rod.h5", damping=ratios), "STIFFENING\n",
            table("hinge", "pin", "revolute", parent="crank", parent_node=1, child="rod", child_node=1),
            table("constraint", "wrist", "spherical", parent="rod", parent_node=21, child="piston"),
            name_sensor("first", "rod", 1), name_sensor("middle", "rod", 11), name_sensor("last", "rod", 21))

    def make_chain(self):
        h = LENGTH / SEGMENTS
        return toml(
            FRAME.replace("INTEGRATOR", "bdf"), write_segments(SEGMENTS, h, RHO_A * h, 1e-6, EI, BETA, "crank"),
            table("constraint", "wrist", "spherical", parent=f"s{SEGMENTS - 1}", parent_node=1, child="piston"),
            name_sensor("first", "s0", 0), name_sensor("middle", f"s{SEGMENTS // 2}", 0),
            name_sensor("last", f"s{SEGMENTS - 1}", 1))

    def test_flexible_rod_bends_as_its_segments_do(self):
        flexible = self.make_flexible()
        bent = self.calc_deflections(flexible.replace("STIFFENING", ""))
        chain = self.calc_deflections(self.make_chain())
        size = np.abs(chain).max()
        self.assertGreater(size, 0.004)
        self.assertLess(np.abs(bent - chain).max(), 0.01 * size)
        # Without stiffening it bends otherwise: the piston's inertia presses and pulls the rod.
        loose = self.calc_deflections(flexible.replace("STIFFENING", "stiffening = false"))
        self.assertGreater(np.abs(loose - chain).max(), 0.05 * size)


if __name__ == "__main__":
    unittest.main()
