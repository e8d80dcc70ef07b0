"""ex02-hub: bounded below the critical rate of 2.1866 rad/s, unbounded above, after a tap at 2 s."""
import unittest

import h5py
import numpy as np

from support import ProgramTest


class Hub(ProgramTest):
    def test_bounded_below_and_unbounded_above(self):
        self.copy_example("ex02-hub")
        self.bough("reduce", "boom.toml")
        tip = {}
        for rate in ["2.18", "2.19"]:
            self.bough("run", f"hub-{rate}.toml", "-o", f"hub-{rate}.h5")
            with h5py.File(self.path(f"hub-{rate}.h5")) as f:
                t, tip[rate] = f["/time"][:], np.abs(f["/sensors/tip_deflection"][:, 1])
            self.assertLess(tip[rate][t < 2].max(), 1e-9)      # straight until the tap
            self.assertGreater(tip[rate][(t > 2) & (t < 5)].max(), 1e-4)
        self.assertLess(tip["2.18"].max(), 0.1)
        self.assertGreater(tip["2.19"][-1], 1.0)
        # Above the critical rate the tip leaves exponentially: rate sqrt(c (2.19^2 - 2.1866^2)), about 0.16 per second.
        late = t > 40
        growth = np.polyfit(t[late], np.log(tip["2.19"][late]), 1)[0]
        self.assertGreater(growth, 0.1)
        self.assertLess(growth, 0.25)


if __name__ == "__main__":
    unittest.main()
