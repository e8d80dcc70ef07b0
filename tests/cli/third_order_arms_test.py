"""Bodies of third order with rigid links and masses off their grids: the same body written another way."""
import itertools
import re
import unittest

import h5py
import numpy as np

from support import ProgramTest
from third_order_test import tighten


def list_exponents(n, degree):
    """Rows in ascending lexical order."""
    return sorted(e for e in itertools.product(range(degree + 1), repeat=n) if sum(e) == degree)


def evaluate(coefficients, degree, eta):
    """Polynomial of one degree; coefficients: monomials x columns."""
    monomials = np.array([np.prod(np.power(eta, e)) for e in list_exponents(len(eta), degree)])
    return monomials @ coefficients


def rotate(theta):
    """exp of the rotation vector."""
    angle = np.linalg.norm(theta)
    S = np.array([[0, -theta[2], theta[1]], [theta[2], 0, -theta[0]], [-theta[1], theta[0], 0]])
    return np.eye(3) + np.sinc(angle / np.pi) * S + .5 * np.sinc(angle / 2 / np.pi) ** 2 * S @ S


class Tables:
    def __init__(self, path):
        with h5py.File(path) as f:
            self.frequency = f["modes/frequency_hz"][:]
            third = f["third_order"]
            self.energy = {k: third[f"energy_{k}"][:] for k in (3, 4, 5, 6)}
            self.node = {k: third[f"node_{k}"][:] for k in (2, 3, 4)}
            self.load = {k: third[f"load_{k}"][:] for k in (2, 3, 4)}
            self.phi = f["modes/phi"][:]
            ids = list(f["nodes/id"][:])
            self.ids = ids

    def calc_energy(self, eta):
        return sum(evaluate(self.energy[k], k, eta) for k in self.energy)


class ThirdOrderArms(ProgramTest):
    def make(self, name, cards="", replace=(), interface="[41]", modes=3, more=""):
        """Reduces the boom of ex01, free in space where it is held in its plane, with cards added."""
        self.copy_example("ex01-spinup")
        deck = self.read("boom.bdf").replace("GRDSET,,,,,,,345\n", "")
        for old, new in replace:
            self.assertIn(old, deck)
            deck = deck.replace(old, new)
        self.write(f"{name}.bdf", deck.replace("ENDDATA", cards + "\nENDDATA"))
        text = self.read("boom.toml").replace('"boom.bdf"', f'"{name}.bdf"').replace("[41]", interface)
        text = text.replace("number = 3", f"number = {modes}").replace('"boom.h5"', f'"{name}.h5"')
        self.write(f"{name}.toml", text + "\n[body.stiffening]\norder = 3\n" + more)
        self.bough("reduce", f"{name}.toml", "-q")
        return Tables(self.path(f"{name}.h5"))

    def swing(self, name, eta, duration=4., node=41):
        """Displacements of a node after the body is let go."""
        system = self.read("spinup.toml").replace('type = "revolute"', 'type = "fixed"').replace("boom.h5", f"{name}.h5")
        for line in ("axis = ", "motion = "):
            system = re.sub(f"(?m)^{line}.*\n", "", system)
        system = re.sub(r'(?s)\[\[sensor\]\]\nname = "angle".*?\n\n', "", system)
        system = system.replace("stiffening = true", f"stiffening = true\neta = {[float(x) for x in eta]}")
        system = system.replace("duration = 20.0", f"duration = {duration}").replace("node = 41", f"node = {node}")
        self.write("swing.toml", system)
        self.bough("run", "swing.toml", "-o", "swing.h5", "-q")
        with h5py.File(self.path("swing.h5")) as f:
            total = sum(f["energy"][part][:].ravel() for part in ("kinetic", "strain", "potential"))
            self.assertLess(np.ptp(total), 1e-8 * total.max())
            return f["sensors/tip_deflection"][:]

    def assert_close(self, a, b, tolerance):
        scale = max(np.abs(a).max(), 1e-300)
        self.assertLess(np.abs(np.abs(a) - np.abs(b)).max() / scale, tolerance)

    def fly(self, cards, left_out=0):
        """Lets a free L-frame with cards added, and a bar left out, vibrate in space: energy and momentum are kept."""
        self.copy_example("ex04-free-flyer")
        deck = ["SOL 103", "CEND", "BEGIN BULK", "MAT1,1,7.+10,2.6+10,,2700.", "PBAR,1,1,1.-4,8.-10,2.-9,1.5-9"]
        deck += [f"GRID,{i + 1},,{i / 8},0.,0." for i in range(9)] + [f"GRID,{i + 9},,1.,{i / 8},{i / 40}" for i in range(1, 9)]
        deck += [f"CBAR,{i},1,{i},{i + 1}," + ("0.,1.,0." if i < 9 else "1.,0.,0.") for i in range(1, 17) if i != left_out]
        self.write("flyer.bdf", "\n".join(deck + cards) + "\nENDDATA\n")
        self.write("flyer.toml", self.read("flyer.toml") + "\n[body.stiffening]\norder = 3\n")
        self.bough("reduce", "flyer.toml", "-q")
        system = re.sub("(?m)^eta = .*$", "eta = [0.05, -0.03, 0.01, 0.002, 0.0, 0.0]", self.read("free-flyer.toml"))
        system = system.replace("duration = 5.0", "duration = 1.0").replace("node = 21", "node = 17")
        self.write("free-flyer.toml", tighten(system))
        self.bough("run", "free-flyer.toml", "-o", "run.h5", "-q")
        with h5py.File(self.path("run.h5")) as f:
            total = f["energy/kinetic"][:].ravel() + f["energy/strain"][:].ravel()
            linear, angular = f["momentum/linear"][:], f["momentum/angular"][:]
            tip = np.linalg.norm(f["sensors/tip_deflection"][:], axis=1).max()
        print(f"tip {tip:.2f} of 2 m; energy {np.ptp(total) / total.max():.1e}")
        self.assertGreater(tip, .05)
        self.assertLess(np.ptp(total), 1e-12 * total.max())
        self.assertLess(np.abs(linear - linear[0]).max(), 1e-12 * np.abs(linear).max())
        self.assertLess(np.abs(angular - angular[0]).max(), 1e-12 * np.abs(angular).max())

    # Different bending stiffnesses: the modes are of one plane each, their signs by the largest entry.
    UNEQUAL = [("PBAR,1,1,7.2986-5,8.2181-9,8.2181-9,1.6436-8", "PBAR,1,1,7.2986-5,8.2181-9,3.-8,1.6436-8")]

    def test_rigid_link_without_length_changes_nothing(self):
        plain = self.make("plain", replace=self.UNEQUAL)
        for word, cards in (("RBE2", "RBE2,901,21,123456,921"), ("RBAR", "RBAR,901,21,921,123456,,,123456")):
            with self.subTest(word):
                linked = self.make("linked", "GRID,921,,4.0,0.,0.\n" + cards,
                                   self.UNEQUAL + [("CBAR,21,1,21,22", "CBAR,21,1,921,22")])
                for k in plain.energy:
                    self.assert_close(plain.energy[k], linked.energy[k], 1e-9)
                printed = self.bough("compare", "plain.h5", "linked.h5").stdout
                rows = re.findall(r"(?m)^ *degree (\d) +(\S+) +(\S+) +(\S+)$", printed)
                self.assertEqual([int(row[0]) for row in rows], [3, 4, 5, 6])
                self.assertTrue(all(abs(float(row[1]) - float(row[2])) < 1e-5 for row in rows), rows)
                for k in plain.node:
                    self.assert_close(plain.node[k], linked.node[k], 1e-9)
                    self.assert_close(plain.load[k], linked.load[k], 1e-9)

    def test_end_of_an_arm_moves_as_a_rigid_body(self):
        """The series of the end and the finite rotation of its foot differ in the fifth power of the amplitudes."""
        arm = np.array([.3, .8, -.4])
        tables = self.make("armed", f"GRID,941,,{8 + arm[0]},{arm[1]},{arm[2]}\nRBE2,901,41,123456,941\nCONM2,902,941,,.5",
                           interface="[41, 941]")
        foot, end = tables.ids.index(41), tables.ids.index(941)
        off = []
        for size in (.4, .2):
            eta = size * np.array([1., -.6, .3]) / np.abs(tables.phi[foot, :3]).max()
            u = [tables.phi[k] @ eta + sum(evaluate(tables.node[d][i], d, eta) for d in (2, 3, 4))
                 for i, k in enumerate((foot, end))]
            expected = u[0][:3] + (rotate(u[0][3:]) - np.eye(3)) @ arm
            np.testing.assert_allclose(u[1][3:], u[0][3:], atol=1e-12)
            off.append(np.abs(u[1][:3] - expected).max())
        print(f"end of the arm off by {off[0]:.1e} and {off[1]:.1e} at half the amplitude: order {np.log2(off[0] / off[1]):.2f}")
        self.assertGreater(off[0], 1e-9)
        self.assertAlmostEqual(np.log2(off[0] / off[1]), 5, delta=.5)

    def test_rigid_arm_is_a_stiff_bar(self):
        """A mass on an arm of 0.8 m at the tip: an RBE2, and a bar 10,000 times as stiff without mass."""
        mass = "GRID,941,,8.,.8,0.\nCONM2,902,941,,.4\n"
        stiff = "PBAR,9,9,7.2986-5,8.2181-9,8.2181-9,1.6436-8\nMAT1,9,6.895+14,,0.33,0.\nCBAR,901,9,41,941,0.,0.,1."
        rigid = self.make("rigid", mass + "RBE2,901,41,123456,941", self.UNEQUAL)
        bar = self.make("bar", mass + stiff, self.UNEQUAL)
        np.testing.assert_allclose(bar.frequency, rigid.frequency, rtol=1e-5)
        for k in rigid.energy:
            self.assert_close(rigid.energy[k], bar.energy[k], 1e-4)
        for k in rigid.node:
            self.assert_close(rigid.node[k], bar.node[k], 1e-4)
        eta = [1.2 / np.abs(rigid.phi[rigid.ids.index(41)]).max(), 0, 0]
        a, b = self.swing("rigid", eta), self.swing("bar", eta)
        print(f"swing of {np.ptp(a[:, 1]) + np.ptp(a[:, 2]):.2f} m: off by {np.abs(np.abs(a) - np.abs(b)).max():.1e}")
        self.assertLess(np.abs(np.abs(a) - np.abs(b)).max(), 1e-5)

    def test_mass_off_its_grid_is_one_on_a_rigid_arm(self):
        """CONM2 with an offset and products of inertia, and points on rigid arms that have the same."""
        arm, inertia = np.array([.2, .5, 0.]), np.diag([.03, .05, .04])
        offset = self.make("offset", f"CONM2,902,41,,.4,{arm[0]},{arm[1]},{arm[2]}\n,.03,,.05,,,.04", self.UNEQUAL)
        # Two points on each axis of the body: m a² of each gives ½ tr J - J.
        cards, second = "", .5 * np.trace(inertia) - np.diag(inertia)
        own = .4 / 6
        for axis in range(3):
            for sign in (1, -1):
                place = np.array([8., 0., 0.]) + arm
                place[axis] += sign * np.sqrt(second[axis] / 2 / own)
                node = 950 + 2 * axis + (sign > 0)
                cards += f"GRID,{node},,{place[0]:.12f},{place[1]:.12f},{place[2]:.12f}\nCONM2,{node},{node},,{own:.14f}\n"
        points = self.make("points", cards + "RBE2,901,41,123456,950,THRU,955", self.UNEQUAL)
        np.testing.assert_allclose(points.frequency, offset.frequency, rtol=1e-9)
        for k in points.energy:
            self.assert_close(points.energy[k], offset.energy[k], 1e-7)
        for k in points.node:
            self.assert_close(points.node[k], offset.node[k], 1e-7)
        eta = [.6 / np.abs(points.phi[points.ids.index(41)]).max(), 0, 0]
        a, b = self.swing("offset", eta), self.swing("points", eta)
        print(f"swing of {np.ptp(a[:, 1]) + np.ptp(a[:, 2]):.2f} m: off by {np.abs(np.abs(a) - np.abs(b)).max():.1e}")
        # The fields of T do not see what the mass alone moves: 1e-4 of the way at 0.08 lengths.
        self.assertLess(np.abs(np.abs(a) - np.abs(b)).max(), 1e-4 * np.ptp(b[:, 1:]))

    def test_free_flight_keeps_energy_and_momentum(self):
        """An L-frame with a rigid block in one leg, a mass on an arm at the corner, an offset body at the end."""
        self.fly(["GRID,105,,.5,.05,.1", "RBE2,901,5,123456,105", "CBAR,5,1,105,6,0.,1.,0.", "GRID,109,,1.2,-.1,.1",
                  "RBE2,902,9,123456,109", "CONM2,903,109,,.15", "CONM2,904,17,,.1,.05,.02,.03", ",1.-3,,2.-3,,,1.5-3"],
                 left_out=5)

    def test_two_ranks_make_the_same_tables(self):
        """Elements, carried masses and arms are shared out among ranks and summed."""
        arm = "GRID,941,,8.,.8,.1\nRBE2,901,41,123456,941\nCONM2,902,941,,.4\nCONM2,903,21,,.3,.1,.2,0.\n,.03,,.05,,,.04"
        one = self.make("one", arm, self.UNEQUAL, modes=4)
        self.bough("reduce", "one.toml", "-o", "two.h5", "-q",
                   launcher=["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"])
        two = Tables(self.path("two.h5"))
        for k in one.energy:
            self.assert_close(one.energy[k], two.energy[k], 1e-8)
        for k in one.node:
            self.assert_close(one.node[k], two.node[k], 1e-8)
            self.assert_close(one.load[k], two.load[k], 1e-8)

    def test_offset_bars_are_bars_on_rigid_arms(self):
        """Lumped masses of bars off their grids: the same bars between grids on RBE2."""
        w, num = (0., .15, .1), 8
        head = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "MAT1,1,7.+10,2.6+10,,2700.", "SPC1,1,123456,1",
                "PBAR,1,1,1.-4,4.-10,9.-9,1.5-9"] + [f"GRID,{i},,{(i - 1) / num},0.,0." for i in range(1, num + 2)]
        offsets = [f"CBAR,{i},1,{i},{i + 1},0.,1.,0.\n,,,{','.join(map(str, w + w))}" for i in range(1, num + 1)]
        arms = [f"GRID,{100 + i},,{(i - 1) / num},{w[1]},{w[2]}\nRBE2,{200 + i},{i},123456,{100 + i}" for i in range(1, num + 2)]
        arms += [f"CBAR,{i},1,{100 + i},{101 + i},0.,1.,0." for i in range(1, num + 1)]
        tables = []
        for cards in (offsets, arms):
            self.write("bars.bdf", "\n".join(head + cards) + "\nENDDATA\n")
            self.write("bars.toml", f'[body]\nname = "bars"\ndeck = "bars.bdf"\nframe = "fixed"\ninterface = [{num + 1}]\n'
                       "[body.modes]\nnumber = 4\n[body.stiffening]\norder = 3\nlarge = 2\n")
            self.bough("reduce", "bars.toml", "-o", "bars.h5", "-q")
            tables.append(Tables(self.path("bars.h5")))
        offset, rigid = tables
        np.testing.assert_allclose(offset.frequency, rigid.frequency, rtol=1e-9)
        self.assert_close(rigid.energy[4], offset.energy[4], 1e-8)
        self.assert_close(rigid.node[2], offset.node[2], 1e-8)
        self.assert_close(rigid.node[3], offset.node[3], 2e-3)      # h²
        self.assert_close(rigid.node[4], offset.node[4], 5e-2)

    def test_other_equations_are_refused_by_grid(self):
        self.copy_example("ex01-spinup")
        deck = self.read("boom.bdf").replace("GRDSET,,,,,,,345\n", "").replace("SPC = 1", "SPC = 1\nMPC = 5")
        self.write("other.bdf", deck.replace("ENDDATA", "MPC,5,41,2,1.,21,2,-1.\nENDDATA"))
        self.write("other.toml", self.read("boom.toml").replace('"boom.bdf"', '"other.bdf"') + "\n[body.stiffening]\norder = 3\n")
        self.fails(1, "reduce", "other.toml", "-o", "x.h5", says=["41", "MPC 5"], error="reduce.bad-order")


if __name__ == "__main__":
    unittest.main()
