"""Bodies of third order under a torque about an axis whose twist moves no mass, against a rod with exact rotations."""
import os
import sys
import unittest

import numpy as np
from scipy.optimize import fsolve

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tests/oracle/third_order"))
from rods import Chain  # noqa: E402

E, NU, RHO = 7.1e10, .31, 2690.
A, I1, I2, J = 1e-4, 8e-10, 9e-10, 1.3e-9
LENGTH, NUM = .8, 16
TIP = NUM + 1


def find_tip(force, moment):
    """Displacement of the tip under a dead force and a dead moment, by shooting."""
    rods = Chain([(LENGTH, np.eye(3))], E * A, (E / (2 + 2 * NU) * J, E * I2, E * I1))
    foot = fsolve(lambda m: rods.run(np.r_[force, m], [force])[3] - moment, moment + np.cross([LENGTH, 0, 0], force), xtol=1e-12)
    return rods.run(np.r_[force, foot], [force])[0][-1] - np.array([LENGTH, 0, 0])


class ThirdOrderTwist(ProgramTest):
    def reduce(self, modes, order):
        lines = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "SPC1,1,123456,1", f"MAT1,1,{E!r},,{NU!r},{RHO!r}",
                 f"PBAR,1,1,{A!r},{I1!r},{I2!r},{J!r}"]
        lines += [f"GRID,{i + 1},,{LENGTH * i / NUM},0.,0." for i in range(NUM + 1)]
        lines += [f"CBAR,{i},1,{i},{i + 1},0.,1.,0." for i in range(1, NUM + 1)]
        self.write("rod.bdf", "\n".join(lines) + "\nENDDATA\n")
        self.write("rod.toml", f'[body]\nname = "rod"\ndeck = "rod.bdf"\nframe = "fixed"\ninterface = [{TIP}]\n[body.modes]\n'
                   f'number = {modes}\nresidual = ["interface"]\n[body.stiffening]\norder = {order}\n')
        self.assertIn("[reduce.residual-massless]", self.bough("reduce", "rod.toml", "-o", "rod.h5").stderr)

    def find_rest(self, force, moment):
        self.write("system.toml", '[[body]]\nname = "rod"\nfile = "rod.h5"\n[[hinge]]\nname = "foot"\ntype = "fixed"\nparent = "ground"\n'
                   f'child = "rod"\n[[force]]\nname = "pull"\nbody = "rod"\nnode = {TIP}\nforce = {list(force)}\n[[force]]\n'
                   f'name = "turn"\nbody = "rod"\nnode = {TIP}\nmoment = {list(moment)}\n[[sensor]]\nname = "tip"\n'
                   f'type = "deflection"\nbody = "rod"\nnode = {TIP}\nframe = "body"\n[simulation]\nduration = 1.0\n')
        return self.read_rest("system.toml", "tip")

    def test_torque_that_is_lost(self):
        for force, moment in (((0., 3., 5.), (4., 0., 0.)), ((0., -4., 3.), (-6., .5, 0.))):
            exact = find_tip(np.array(force), np.array(moment))
            off = {}
            for modes in (4, 6, 10, 14):
                self.reduce(modes, 3)
                off[modes] = np.linalg.norm(self.find_rest(force, moment) - exact) / np.linalg.norm(exact)
            self.reduce(14, 2)
            second = np.linalg.norm(self.find_rest(force, moment) - exact) / np.linalg.norm(exact)
            print(f"{force} N, {moment} N m, way {np.linalg.norm(exact) / LENGTH:.3f} lengths: "
                  f"{ {n: f'{100 * e:.3f} %' for n, e in off.items()} }, order 2 {100 * second:.3f} %")
            self.assertLess(max(off.values()), 3e-3)


if __name__ == "__main__":
    unittest.main()
