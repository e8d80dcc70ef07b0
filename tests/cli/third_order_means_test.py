"""Bodies of third order with RBE3: the mean of grids on stiff bars and a rigid link; free flight."""
import unittest

import numpy as np
import third_order_arms_test as arms
from support import ProgramTest


class ThirdOrderMeans(ProgramTest):
    make, swing, fly = arms.ThirdOrderArms.make, arms.ThirdOrderArms.swing, arms.ThirdOrderArms.fly
    assert_close = arms.ThirdOrderArms.assert_close

    def test_mean_of_grids_on_stiff_bars_is_a_rigid_link(self):
        """A body, and a mass on an arm, at the reference grid of an RBE3. Bars without mass, 1,000 times as stiff as the
        boom, join its grids to the tip, one by a rigid arm more. Against RBE2 from the tip."""
        places = {951: (8.1, .4, .1), 952: (8., -.2, .5), 953: (8.3, -.3, -.3)}
        cards = "".join(f"GRID,{i},,{x},{y},{z}\n" for i, (x, y, z) in places.items())
        cards += "GRID,963,,8.4,-.5,-.2\nGRID,961,,8.3,.3,-.1\nGRID,941,,8.6,.5,.2\nCONM2,902,941,,.2\n"
        cards += "CONM2,903,961,,.3,.1,.2,-.1\n,.03,,.05,,,.04\n"
        rigid = self.make("rigid", cards + "RBE2,901,41,123456,951,952,953,963,961\n,941", arms.ThirdOrderArms.UNEQUAL,
                          interface="[41, 961]")
        bars = "PBAR,9,9,7.2986-5,8.2181-9,8.2181-9,1.6436-8\nMAT1,9,6.895+13,,0.33,0.\n"
        bars += "".join(f"CBAR,{i},9,41,{i},1.,.2,.3\n" for i in places)
        mean = self.make("mean", cards + bars + "RBE2,904,953,123456,963\nRBE2,905,961,123456,941\n"
                         "RBE3,906,,961,123456,1.,123456,951,2.\n,123,952,.7,123,963", arms.ThirdOrderArms.UNEQUAL,
                         interface="[41, 961]")
        np.testing.assert_allclose(mean.frequency, rigid.frequency, rtol=1e-5)
        for k in rigid.energy:
            self.assert_close(rigid.energy[k], mean.energy[k], 5e-5)
        for k in rigid.node:
            self.assert_close(rigid.node[k], mean.node[k], 5e-5)
            self.assert_close(rigid.load[k], mean.load[k], 5e-5)
        eta = [1.2 / np.abs(rigid.phi[rigid.ids.index(41)]).max(), 0, 0]
        a, b = self.swing("rigid", eta), self.swing("mean", eta)
        print(f"swing of {np.ptp(a[:, 1]) + np.ptp(a[:, 2]):.2f} m: off by {np.abs(np.abs(a) - np.abs(b)).max():.1e}")
        self.assertLess(np.abs(np.abs(a) - np.abs(b)).max(), 2e-5)

    def test_free_flight_keeps_energy_and_momentum(self):
        """An L-frame with a mass at the mean of three of its grids and another on an arm there."""
        self.fly(["GRID,105,,.8,.3,.1", "RBE3,901,,105,123456,1.,123456,5,2.", ",123,9,1.,123,14", "GRID,109,,.6,.5,.3",
                  "RBE2,902,105,123456,109", "CONM2,903,109,,.15", "CONM2,904,105,,.1,.05,.02,.03", ",1.-3,,2.-3,,,1.5-3"])

    def test_two_ranks_make_the_same_tables(self):
        cards = ("GRID,951,,8.1,.4,.1\nCBAR,951,1,41,951,1.,.2,.3\nGRID,961,,8.3,.3,-.1\nGRID,941,,8.6,.5,.2\n"
                 "RBE3,906,,961,123456,1.,123456,951,2.\n,123456,40,.7,123,41\nRBE2,905,961,123456,941\n"
                 "CONM2,902,941,,.2\nCONM2,903,961,,.3,.1,.2,-.1\n,.03,,.05,,,.04")
        one = self.make("one", cards, arms.ThirdOrderArms.UNEQUAL, modes=4)
        self.bough("reduce", "one.toml", "-o", "two.h5", "-q",
                   launcher=["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"])
        two = arms.Tables(self.path("two.h5"))
        for k in one.energy:
            self.assert_close(one.energy[k], two.energy[k], 1e-8)
        for k in one.node:
            self.assert_close(one.node[k], two.node[k], 1e-8)
            self.assert_close(one.load[k], two.load[k], 1e-8)

    def test_what_is_no_mean_is_named(self):
        """Single components of a grid, UM and other components of the reference grid."""
        cards = "GRID,961,,8.3,.3,-.1\nGRID,951,,8.,.4,0.\nCBAR,951,1,41,951,0.,0.,1.\n"
        for rbe3 in ("RBE3,906,,961,123456,1.,123456,41,2.\n,12,951", "RBE3,906,,961,12345,1.,123456,41,951",
                     "RBE3,906,,961,123456,1.,123456,41,951\n,UM,951,123,41,456"):
            with self.subTest(rbe3):
                self.copy_example("ex01-spinup")
                deck = self.read("boom.bdf").replace("GRDSET,,,,,,,345\n", "").replace("ENDDATA", cards + rbe3 + "\nENDDATA")
                self.write("boom.bdf", deck)
                self.write("boom.toml", self.read("boom.toml") + "\n[body.stiffening]\norder = 3\n")
                line = deck[:deck.index("RBE3")].count("\n") + 1
                stderr = self.bough("reduce", "boom.toml", "-q", code=1).stderr
                self.assertIn(f"boom.bdf:{line}: error: ", stderr)
                self.assertIn("reduce.bad-order", stderr)
                self.assertIn("RBE3 906 joins", stderr)


if __name__ == "__main__":
    unittest.main()
