"""Bodies of third order, from deck to time history: docs/theory/third-order.md."""
import os
import re
import sys
import unittest

import h5py
import numpy as np

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tests/oracle/third_order"))
from inextensible import Cantilever, spin_up  # noqa: E402

LENGTH, EI, MASS = 8., 6.895e10 * 8.2181e-9, 1.6154


def tighten(system):
    """The system with an integrator whose error is below 1e-12 of the energy (adams by the tolerances of the examples:
    1e-11)."""
    for key, value in (("integrator", '"rk"'), ("relative_tolerance", "1e-13"), ("absolute_tolerance", "1e-15")):
        system = re.sub(f"(?m)^{key} = .*$", f"{key} = {value}", system)
    return system


class ThirdOrder(ProgramTest):
    def write_l_frame(self):
        """The example of the free flyer with an L-frame of 2 m as its body."""
        self.copy_example("ex04-free-flyer")
        deck = ["SOL 103", "CEND", "BEGIN BULK", "MAT1,1,7.+10,2.6+10,,2700.", "PBAR,1,1,1.-4,8.-10,2.-9,1.5-9"]
        deck += [f"GRID,{i + 1},,{i / 8},0.,0." for i in range(9)] + [f"GRID,{i + 9},,1.,{i / 8},{i / 40}" for i in range(1, 9)]
        deck += [f"CBAR,{i},1,{i},{i + 1}," + ("0.,1.,0." if i < 9 else "1.,0.,0.") for i in range(1, 17)]
        self.write("flyer.bdf", "\n".join(deck) + "\nENDDATA\n")

    def reduce(self, keys="order = 3", replace=(), name="boom.h5", code=0, **more):
        self.copy_example("ex01-spinup")
        text = self.read("boom.toml") + f"\n[body.stiffening]\n{keys}\n"
        for old, new in replace:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("boom.toml", text)
        call = self.bough if code == 0 else lambda *a: self.fails(code, *a, **more)
        return call("reduce", "boom.toml", "-o", name, "-q")

    def spin(self, rate, file, duration=7.2):
        text = self.read("spinup.toml").replace("rate = 4.0", f"rate = {rate}")
        self.write("run.toml", text.replace("duration = 20.0", f"duration = {duration}"))
        self.bough("run", "run.toml", "-o", file, "-q")
        with h5py.File(self.path(file)) as f:
            self.assertLess(f["energy"].attrs["energy_error"], 1e-8)
            return f["time"][:], f["sensors/tip_deflection"][:]

    def make_fixed(self):
        """The system with the boom clamped to the ground."""
        text = self.read("spinup.toml").replace('type = "revolute"', 'type = "fixed"')
        for line in ("axis = ", "motion = "):
            text = re.sub(f"(?m)^{line}.*\n", "", text)
        return re.sub(r'(?s)\[\[sensor\]\]\nname = "angle".*?\n\n', "", text)

    def test_spin_up_is_that_of_exact_beams(self):
        """Peaks of the same three modes of an inextensible beam: -0.53384 and -0.75089 m; three geometrically exact beams with
        shear: -0.5338 and -0.7508. Second order: -0.5360, -0.7566."""
        self.reduce()
        for rate, tolerance in ((4., 1e-4), (6., 3e-4)):
            exact = Cantilever(LENGTH, EI, MASS, 3, cells=24)
            s = exact.integrate(7.0, spin_up(rate), rtol=1e-7)
            expected = (exact.tip @ s.sol(np.linspace(6.3, 7.0, 701))[:3]).min()
            t, tip = self.spin(rate, "spin.h5")
            print(f"{rate} rad/s: {tip[:, 1].min():.6f}, exact {expected:.6f}, off by {tip[:, 1].min() / expected - 1:.1e}")
            self.assertAlmostEqual(tip[:, 1].min() / expected, 1, delta=tolerance)

    def test_free_swing_keeps_energy_and_the_backbone_of_exact_beams(self):
        """Period of the first mode at a tip amplitude of 0.2 lengths."""
        self.reduce()
        with h5py.File(self.path("boom.h5")) as f:
            node = list(f["nodes/id"][:]).index(41)
            phi, omega = f["modes/phi"][node, 1], f["modes/frequency_hz"][:] * 2 * np.pi
        exact = Cantilever(LENGTH, EI, MASS, 3, cells=16)
        amplitude = .2 * LENGTH
        # The exact motion that starts with these amplitudes and rests; φ of the file has its own size and sign.
        start = np.array([amplitude / exact.tip[0], 0, 0])
        t = np.linspace(0, 6, 1201)
        q = exact.integrate(6., start=np.r_[start, 0, 0, 0], rtol=1e-9).sol(t)[:3]
        system = self.make_fixed().replace("stiffening = true", f"stiffening = true\neta = [{float(amplitude / phi[0])!r}, 0.0, 0.0]")
        system = system.replace("duration = 20.0", "duration = 6.0").replace("output_step = 0.01", "output_step = 0.005")
        self.write("swing.toml", tighten(system))
        self.bough("run", "swing.toml", "-o", "swing.h5", "-q")
        with h5py.File(self.path("swing.h5")) as f:
            tip = f["sensors/tip_deflection"][:, 1]
            total = sum(f["energy"][name][:].ravel() for name in ("kinetic", "strain", "potential"))
        off = np.abs(tip - exact.tip @ q).max() / amplitude
        print(f"swing of 0.2 lengths over {6 * omega[0] / 2 / np.pi:.1f} periods: off by {off:.1e}; energy {np.ptp(total) / total[0]:.1e}")
        self.assertLess(off, 2e-3)
        self.assertLess(np.ptp(total), 1e-12 * total[0])

    def test_free_flight_in_space_keeps_energy_and_momentum(self):
        """Six large modes of an L-frame of 2 m: 126 coefficients of degree 4."""
        self.write_l_frame()
        self.write("flyer.toml", self.read("flyer.toml") + "\n[body.stiffening]\norder = 3\n")
        self.bough("reduce", "flyer.toml", "-q")
        with h5py.File(self.path("flyer.h5")) as f:
            self.assertEqual([f[f"third_order/energy_{k}"].shape[0] for k in (3, 4, 5, 6)], [56, 126, 252, 462])
        system = re.sub("(?m)^eta = .*$", "eta = [0.05, -0.03, 0.01, 0.002, 0.0, 0.0]", self.read("free-flyer.toml"))
        system = system.replace("duration = 5.0", "duration = 1.0").replace("node = 21", "node = 17")
        self.write("free-flyer.toml", tighten(system))
        self.bough("run", "free-flyer.toml", "-o", "run.h5", "-q")
        with h5py.File(self.path("run.h5")) as f:
            kinetic, strain = f["energy/kinetic"][:].ravel(), f["energy/strain"][:].ravel()
            linear, angular = f["momentum/linear"][:], f["momentum/angular"][:]
            tip = f["sensors/tip_deflection"][:]
        print(f"tip {np.linalg.norm(tip, axis=1).max():.2f} of 2 m; energy {np.ptp(kinetic + strain) / kinetic.max():.1e}")
        self.assertGreater(np.linalg.norm(tip, axis=1).max(), .1)
        self.assertLess(np.ptp(kinetic + strain), 1e-12 * kinetic.max())
        self.assertLess(np.abs(linear - linear[0]).max(), 1e-12 * np.abs(linear).max())
        self.assertLess(np.abs(angular - angular[0]).max(), 1e-12 * np.abs(angular).max())

    def test_frames_see_the_same_motion(self):
        """A free L-frame at rest that a force at its end bends: the path of the end in space, by frames of the body."""
        self.write_l_frame()
        system = re.sub("(?m)^(eta|rate) = .*$", "", self.read("free-flyer.toml")).replace("node = 21", "node = 17")
        system = system.replace("duration = 5.0", "duration = 0.6").replace('type = "deflection"', 'type = "position"')
        system = system.replace('frame = "body"', 'frame = "inertial"', 1)
        system += '[[force]]\nname = "pull"\nbody = "flyer"\nnode = 17\nforce = [1.0, 0.5, 1.5]\nframe = "inertial"\n'
        self.write("free-flyer.toml", system)
        path, body = {}, self.read("flyer.toml")
        for order in (2, 3):
            for frame in ('"free"', '"node"\nframe_nodes = [1]', '"3-2-1"\nframe_nodes = [1, 9, 17]', '"mass-centre"',
                          '"mass-centre"\nframe_nodes = [9]', '"mass-centre"\nframe_nodes = [1, 9, 17]'):
                keys = re.sub('(?m)^frame = "free".*$', "frame = " + frame, body).replace("number = 6", "number = 8")
                self.write("moved.toml", keys.replace("[body.modes]", "interface = [17]\n[body.modes]", 1)
                           + f"\n[body.stiffening]\norder = {order}\n")
                self.bough("reduce", "moved.toml", "-o", "flyer.h5", "-q")
                self.bough("run", "free-flyer.toml", "-o", "run.h5", "-q")
                with h5py.File(self.path("run.h5")) as f:
                    path[order, frame] = f["sensors/tip_deflection"][:]
        off = {order: [np.abs(path[o, frame] - path[3, '"free"']).max() for o, frame in path if o == order] for order in (2, 3)}
        way = np.ptp(path[3, '"free"'], 0).max()
        for order in (2, 3):
            print(f"order {order}: paths of {way:.2f} m differ from that of the free frame by", [f"{x:.1e}" for x in off[order]])
        self.assertLess(max(off[3]), 1e-5 * way)
        self.assertLess(10 * max(off[3]), min(off[2]))

    def test_second_order_of_the_file_is_what_it_was(self):
        self.reduce()
        self.reduce("order = 2", name="two.h5")
        with h5py.File(self.path("boom.h5")) as three, h5py.File(self.path("two.h5")) as two:
            self.assertEqual((three.attrs["format_version"], two.attrs["format_version"]), ("1.3", "1.1"))
            self.assertNotIn("third_order", two)
            for name in ("stiffening/kg_inertial", "stiffening/kg_external", "modal/stiffness"):
                self.assertTrue((three[name][:] == two[name][:]).all())
            # Degree 2 is K_G2 but for the stress of the modes on the stretch by the load ((7) of the theory): (radius of
            # gyration times wave number)², 1e-4 of the third mode.
            K = two["stiffening/kg_external"][0]
            pairs = three["third_order/node_2"][0][:, 0]
        order = [(0, 0, 2), (0, 1, 1), (0, 2, 0), (1, 0, 1), (1, 1, 0), (2, 0, 0)]
        full = np.zeros((3, 3))
        for c, x in zip(pairs, order):
            i, j = [k for k in range(3) for _ in range(x[k])]
            full[i, j] = full[j, i] = c * (2 if i == j else 1)
        np.testing.assert_allclose(full, -K, rtol=0, atol=3e-4 * np.abs(K).max())

    def test_compare_reports_different_orders(self):
        self.reduce()
        self.reduce("order = 2", name="two.h5")
        self.reduce("order = 3\nlarge = 2", name="three.h5")
        for other, words in (("two.h5", "B second order"), ("three.h5", "B third order (large modes 1, 2)")):
            printed = self.bough("compare", "boom.h5", other).stdout
            self.assertIn(f"A has third order (large modes 1, 2, 3), {words}", printed)
            self.assertNotIn("degree 4", printed)
        self.assertNotIn("third order", self.bough("compare", "two.h5", "two.h5").stdout)

    def test_fewer_modes_have_second_order(self):
        self.reduce()
        printed = self.bough("select", "boom.h5", "-n", 2, "--inputs", "41", "--outputs", "41", "-o", "two.h5").stderr
        self.assertIn("[select.third-order]", printed)
        with h5py.File(self.path("two.h5")) as f:
            self.assertNotIn("third_order", f)

    def test_formats_without_third_order(self):
        """SID, MBDyn and .FLX are written of second order, with a warning; the flat file has it all."""
        self.reduce()
        for words in (["export", "boom.h5", "--to", "sid", "-o", "b.SID_FEM"], ["export", "boom.h5", "--to", "mbdyn", "-o", "b.fem"],
                      ["flx", "boom.h5", "-o", "b.FLX"]):
            self.assertIn("[export.third-order]", self.bough(*words).stderr, words)
        self.assertNotIn("third-order", self.bough("export", "boom.h5", "--to", "flat", "-o", "b.flat").stderr)
        self.reduce("order = 2", name="two.h5")
        self.assertNotIn("third-order", self.bough("flx", "two.h5", "-o", "b.FLX").stderr)

    def test_flat_bodies_and_units(self):
        self.reduce()
        _, tip = self.spin(6., "spin.h5", 3.)
        self.bough("export", "boom.h5", "--to", "flat", "-o", "boom.flat", "-q")
        self.write("spinup.toml", self.read("spinup.toml").replace("boom.h5", "boom.flat"))
        _, flat = self.spin(6., "flat.h5", 3.)
        self.assertTrue((flat == tip).all())
        self.bough("convert", "boom.h5", "--units", "m-kg-s:mm-t-s", "-o", "mm.h5", "-q")
        self.write("spinup.toml", self.read("spinup.toml").replace("boom.flat", "mm.h5"))
        _, mm = self.spin(6., "mm-run.h5", 3.)
        np.testing.assert_allclose(mm, 1e3 * tip, rtol=0, atol=1e-3 * np.abs(tip).max())

    def test_statics_and_linear_models_about_a_deflected_state(self):
        """A force at the tip bends it by a fifth of its length: rest, and the frequency about it by small swings."""
        self.reduce()
        text = self.make_fixed().replace("duration = 20.0", "duration = 1.0")
        text += '[[force]]\nname = "pull"\nbody = "boom"\nnode = 41\nforce = [0.0, 6.0, 0.0]\n'
        self.write("rest.toml", text)
        self.bough("equilibrium", "rest.toml", "-o", "rest.h5", "-q")
        self.bough("linearize", "rest.toml", "--equilibrium", "-o", "rest-linear.h5", "-q")
        with h5py.File(self.path("rest-linear.h5")) as f:
            A = f["A"][:]
            q = f["operating_point/q"][:]
        self.assertGreater(np.abs(q).max(), 0)
        values = np.linalg.eigvals(A)
        self.assertTrue((np.abs(values.real) < 1e-6 * np.abs(values)).all())

    def test_what_third_order_cannot_have(self):
        for keys, says in (("order = 3\nlarge = 9", ["large = 9", "3 modes"]), ("order = 3\nlarge = [1, 7]", ["mode 7"]),
                           ("order = 3\nlarge = [1, 1]", ["twice"])):
            self.reduce(keys, code=1, says=says, error="reduce.bad-order")
            line = 1 + self.read("boom.toml").split("\n").index(keys.split("\n")[1])
            self.reduce(keys, code=1, says=[f"boom.toml:{line}: error"], error="reduce.bad-order")
        self.reduce(replace=[("[body.modes]", '[body.modes]\nbasis = "craig-bampton"')], code=1, says=["static shapes"],
                    error="reduce.bad-order")
        self.reduce("order = 3\nlarge = 4", replace=[("[body.modes]", '[body.modes]\nresidual = ["interface"]')], code=1,
                    says=["mode 4", "residual vector"], error="reduce.bad-order")
        self.reduce("large = 2", code=1, says=["order = 3"], error="toml.conflicting-keys")
        self.copy_example("ex01-spinup")
        deck = self.read("boom.bdf")
        for cards, says in (("CELAS2,900,10.,41,2", ["CELAS2 900"]), ("CELAS2,904,10.,41,2,40,2", ["CELAS2 904"])):
            self.write("other.bdf", deck.replace("ENDDATA", cards + "\nENDDATA"))
            self.reduce(replace=[('"boom.bdf"', '"other.bdf"')], code=1, says=says, error="reduce.bad-order")
        self.reduce()
        self.write("spinup.toml", self.read("spinup.toml").replace("stiffening = true", "stiffening = true\nmodes = 2"))
        self.fails(1, "run", "spinup.toml", "-o", "x.h5", says=["2 of the 3 modes"], error="system.third-order-modes")


if __name__ == "__main__":
    unittest.main()
