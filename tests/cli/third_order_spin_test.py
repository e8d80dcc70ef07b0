"""Flat bodies: the propeller moment of blades of third order, of masses written in three ways; the estimate of the next order
of strips that bend about both axes."""
import re
import unittest

import h5py
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from support import ProgramTest

GJ_OVER_L = 40.                # N m/rad
E_CHORD, E_THICK = .02, .002   # kg m^2: second moments of the mass along the chord (y) and across it (z)
OMEGA = 30.                    # rad/s about z, normal to the chord


class ThirdOrderSpin(ProgramTest):
    def make(self, masses, keys="order = 3"):
        """A stiff rod along x that twists, with a flat mass at its end on the axis of the rod."""
        lines = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "SPC1,1,123456,1", f"MAT1,1,1.+11,{GJ_OVER_L * .2 / 1e-9!r},,1.-6",
                 "PBAR,1,1,1.-3,1.-8,1.-8,1.-9", "GRID,1,,0.,0.,0.", "GRID,2,,.1,0.,0.", "GRID,3,,.2,0.,0.", "CBAR,1,1,1,2,0.,1.,0.",
                 "CBAR,2,1,2,3,0.,1.,0.", *masses]
        self.write("blade.bdf", "\n".join(lines) + "\nENDDATA\n")
        self.write("blade.toml", '[body]\nname = "blade"\ndeck = "blade.bdf"\nframe = "fixed"\ninterface = [3]\n[body.modes]\n'
                   f'number = 3\nresidual = ["interface"]\n[body.stiffening]\n{keys}\n[body.output]\nfile = "blade.h5"\n')
        self.bough("reduce", "blade.toml", "-q")

    def find_twist(self, moment, node=3, spin=OMEGA):
        self.write("spin.toml", '[[body]]\nname = "blade"\nfile = "blade.h5"\n[[hinge]]\nname = "hub"\ntype = "revolute"\n'
                   f'parent = "ground"\nchild = "blade"\naxis = [0.0, 0.0, 1.0]\nrate = [{spin}]\n[[force]]\nname = "twist"\n'
                   f'body = "blade"\nnode = {node}\nmoment = [{moment!r}, 0.0, 0.0]\n[[sensor]]\nname = "twist"\ntype = "rotation"\n'
                   f'body = "blade"\nnode = {node}\n[simulation]\nduration = 1.0\noutput_step = 0.1\n')
        return self.read_rest("spin.toml", "twist")[0]

    MASSES = {
        "inertia": ["CONM2,9,3,,.02", f",{E_CHORD + E_THICK},,{E_THICK + .01},,,{E_CHORD + .01}"],
        "arms": ["GRID,11,,.2,.5,0.", "GRID,12,,.2,-.5,0.", "GRID,13,,.2,0.,.5", "GRID,14,,.2,0.,-.5",
                 "RBE2,90,3,123456,11,12,13,14", *(f"CONM2,{k},{k},,{E_CHORD / .5}" for k in (11, 12)),
                 *(f"CONM2,{k},{k},,{E_THICK / .5}" for k in (13, 14))],
        "points": [*(f"CONM2,{20 + k},3,,{2 * E},{0.},{y},{z}" for k, (E, y, z) in enumerate(
            ((E_CHORD, .5, 0.), (E_CHORD, -.5, 0.), (E_THICK, 0., .5), (E_THICK, 0., -.5))))],
    }

    def test_propeller_moment(self):
        """GJ/L theta + Omega^2 (E_chord - E_thick) sin theta cos theta is the moment."""
        propeller = OMEGA ** 2 * (E_CHORD - E_THICK)
        for name, masses in self.MASSES.items():
            for keys, tolerances in (("order = 3", (1e-4, 1e-3, 5e-3)), ("order = 2", (1e-4, 5e-3, 3e-2))):
                self.make(masses, keys)
                for moment, tolerance in zip((1., 8., 18.), tolerances):
                    exact = brentq(lambda x, m=moment: GJ_OVER_L * x + propeller * np.sin(x) * np.cos(x) - m, 0, 1.5)
                    found = self.find_twist(moment)
                    print(f"{name}, {keys}, {moment} N m: {found:.6f} rad, exact {exact:.6f}, off by {found / exact - 1:.1e}")
                    self.assertLess(abs(found / exact - 1), tolerance)

    def test_propeller_moment_of_sections(self):
        """A blade of consistent beams: ((GJ + N I_p / A) theta')' = Omega^2 rho (I_chord - I_thick) sin theta cos theta, N the
        pull of the spin, moment at its end."""
        length, num, gj, rho, area, chord, thick, spin = .5, 12, 8., 1e4, 1e-3, 2e-6, 2e-7, 60.
        lines = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "SPC1,1,123456,1", f"MAT1,1,1.+11,8.+9,,{rho}",
                 f"PBEAM,1,1,{area},{chord},{thick},,1.-9", *(f"GRID,{k + 1},,{length * k / num:.7f},0.,0." for k in range(num + 1)),
                 *(f"CBEAM,{k},1,{k},{k + 1},0.,1.,0." for k in range(1, num + 1))]
        self.write("blade.bdf", "\n".join(lines) + "\nENDDATA\n")

        def find_torque(at_root):
            def slope(x, y):
                pull = .5 * rho * area * spin ** 2 * (length ** 2 - x ** 2)
                return [y[1] / (gj + pull * (chord + thick) / area), spin ** 2 * rho * (chord - thick) * np.sin(y[0]) * np.cos(y[0])]
            return solve_ivp(slope, (0, length), [0, at_root], rtol=1e-10, atol=1e-12).y[:, -1]

        for keys, tolerances in (("order = 3\nlarge = 3", (3e-3, 5e-3, 1e-2)), ("order = 2", (3e-3, 5e-3, 1e-2))):
            self.write("blade.toml", f'[body]\nname = "blade"\ndeck = "blade.bdf"\nframe = "fixed"\ninterface = [{num + 1}]\n[body.modes]\n'
                       f'number = 6\nresidual = ["interface"]\n[body.stiffening]\n{keys}\n[body.output]\nfile = "blade.h5"\n')
            self.bough("reduce", "blade.toml", "-q")
            for moment, tolerance in zip((1., 5., 10.), tolerances):
                exact = find_torque(brentq(lambda root, m=moment: find_torque(root)[1] - m, 0, 60))[0]
                found = self.find_twist(moment, num + 1, spin)
                print(f"sections, {keys[:9]}, {moment} N m: {found:.6f} rad, exact {exact:.6f}, off by {found / exact - 1:.1e}")
                self.assertLess(abs(found / exact - 1), tolerance)

    def test_next_order_of_strips_is_estimated(self):
        """Bodies of second order against the whole deck by static --nonlinear: thin strips with torsional mass, a beam."""
        num, rho = 16, 2700.
        for name, height, depth, forces in (("strip", .03, .003, ((1., 3.), (1., 6.), (1., 12.))),
                                            ("beam", .016, .01, ((12., 24.), (24., 48.)))):
            twist = .32 * depth ** 3 * height if name == "strip" else .2 * depth ** 3 * height
            polar = rho * height ** 3 * depth / 12 / num
            bulk = ["MAT1,1,7.+10,,.3,2700.",
                    f"PBAR,1,1,{depth * height:.6e},{depth * height ** 3 / 12:.6e},{height * depth ** 3 / 12:.6e},"
                    f"{twist:.6e}", "SPC1,1,123456,1", *(f"GRID,{k + 1},,{k / num},0.,0." for k in range(num + 1)),
                    *(f"CBAR,{k},1,{k},{k + 1},0.,0.,1." for k in range(1, num + 1)),
                    *(f"CONM2,{200 + k},{k + 1},,1.-9\n,{polar:.6e},,{polar / 100:.6e},,,{polar:.6e}" for k in range(1, num + 1))]
            self.write("blade.bdf", "\n".join(["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", *bulk]) + "\nENDDATA\n")
            self.write("blade.toml", f'[body]\nname = "blade"\ndeck = "blade.bdf"\nframe = "fixed"\ninterface = [{num + 1}]\n[body.modes]\n'
                       'number = 6\nresidual = ["interface"]\n[body.output]\nfile = "blade.h5"\n')
            self.bough("reduce", "blade.toml", "-q")
            for across, along in forces:
                self.write("whole.bdf", "\n".join(["SOL 106", "CEND", "SPC = 1", "LOAD = 1", "BEGIN BULK", "PARAM,LGDISP,1", *bulk,
                                                   f"FORCE,1,{num + 1},,1.,0.,{across},{along}"]) + "\nENDDATA\n")
                self.bough("static", "whole.bdf", "-o", "whole.h5", "-q")
                with h5py.File(self.path("whole.h5")) as f:
                    exact = f["/subcases/0/displacement"][-6:-3]
                self.write("rest.toml", '[[body]]\nname = "blade"\nfile = "blade.h5"\n[[hinge]]\nname = "foot"\ntype = "fixed"\n'
                           f'parent = "ground"\nchild = "blade"\n[[force]]\nname = "pull"\nbody = "blade"\nnode = {num + 1}\n'
                           f'force = [0.0, {across}, {along}]\n[[sensor]]\nname = "end"\ntype = "deflection"\nbody = "blade"\n'
                           f'node = {num + 1}\n[simulation]\nduration = 1.0\noutput_step = 0.1\n')
                printed = self.bough("equilibrium", "rest.toml", "-o", "rest.h5").stderr
                found = re.search(r"estimated at (\S+) % of that.*\[run.linear-limit\]", printed)
                with h5py.File(self.path("rest.h5")) as f:
                    error = np.linalg.norm(f["sensors/end"][-1] - exact) / np.linalg.norm(exact)
                estimate = float(found[1]) / 100 if found else None
                print(f"{name}, {across}, {along} N, {np.linalg.norm(exact):.3f} lengths: off by {error:.4f}, estimate {estimate}")
                self.assertTrue(estimate or error < .012)
                if estimate:
                    self.assertGreater(estimate, .3 * error)
                    self.assertLess(estimate, 6 * max(error, .004))


if __name__ == "__main__":
    unittest.main()
