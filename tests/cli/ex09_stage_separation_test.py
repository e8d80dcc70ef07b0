"""ex09-stage-separation: momentum is kept when springs push two flexible stages apart."""
import unittest

import numpy as np

from support import ProgramTest


class StageSeparation(ProgramTest):
    def test_momentum_and_speed(self):
        self.copy_example("ex09-stage-separation")
        self.bough("reduce", "stage.toml")
        self.bough("run", "separation.toml", "-o", "separation.h5")
        linear, angular, turn = self.read_arrays("separation.h5", "momentum/linear", "momentum/angular", "sensors/tip_off")
        time, gap, kinetic, strain, work = map(np.ravel, self.read_arrays(
            "separation.h5", "time", "sensors/gap", "energy/kinetic", "energy/strain", "energy/work"))
        total = kinetic + strain - work
        # p = m v of either stage is about 500, L about 950.
        self.assertLess(np.abs(linear - linear[0]).max(), 1e-10 * 500)
        self.assertLess(np.abs(angular - angular[0]).max(), 1e-10 * np.abs(angular[0]).max())
        self.assertLess(np.abs(total - total[0]).max(), 1e-9 * kinetic.max())
        self.assertLess(gap[time < 0.5].max(), 1e-12)
        # Springs: k δ² / 2 each, over the reduced mass; some goes into axial vibration and into turning.
        m = 284.8205
        speed = np.sqrt(2 * (0.5 * 8.1e4 * 0.15**2) / (m / 2))
        late = time > 1.0
        measured = np.polyfit(time[late], gap[late], 1)[0]
        self.assertLess(abs(measured / speed - 1), 0.01)
        self.assertGreater(np.abs(turn[-1, 1:]).max(), 5e-3)  # the stiffer spring


if __name__ == "__main__":
    unittest.main()
