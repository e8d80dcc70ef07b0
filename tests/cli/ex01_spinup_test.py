"""ex01-spinup, its run lines as its README gives them, against data/reference/spinup.json."""
import json
import os
import sys
import unittest

import h5py
import numpy as np

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tools"))
import spinup_numbers  # noqa: E402


class Spinup(ProgramTest):
    def test_deck_to_time_history(self):
        self.copy_example("ex01-spinup")
        data = json.loads(self.bough("check", "boom.bdf", "--json").stdout)
        self.assertAlmostEqual(data["mass_properties"]["mass"], 1.6154, delta=1e-4)
        self.bough("reduce", "boom.toml")
        self.bough("run", "spinup.toml", "-o", "spinup.h5")
        warned = self.bough("run", "spinup-no-kg.toml", "-o", "spinup-no-kg.h5")
        self.assertIn("run.linear-limit", warned.stderr)
        self.bough("reduce", "boom-order3.toml")
        self.bough("run", "spinup-order3.toml", "-o", "spinup-order3.h5")
        numbers = spinup_numbers.calc_numbers(*map(self.path, ["spinup.h5", "spinup-no-kg.h5", "boom.h5", "spinup-order3.h5"]))
        for name, value, expected, error, tolerance, passed in spinup_numbers.compare(numbers):
            with self.subTest(name):
                self.assertTrue(passed, f"{name}: computed {value}, reference {expected}, off by {error:.2%} > {tolerance:.2%}")
        self.bough("plot", "spinup.h5", "spinup-no-kg.h5", "--sensor", "tip_deflection:y", "--y-min", "-1.2", "--y-max", "0.2",
                   "-o", "tip.svg")


    def test_eq_18_by_actuators_on_modal_coordinates(self):
        """The report's own stiffening, -Σ A_I K_G1 η as modal forces: the linear theory of rotating beams, -0.5346 m at
        6.77 s. The rate alone counts for the bending of a straight boom."""
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-q")
        with h5py.File(self.path("boom.h5")) as f:
            K = f["stiffening/kg_inertial"][8]
        n = len(K)
        law = ", ".join('"-u1^2*(' + " + ".join(f"{K[j, k]:.15g}*u{k + 2}" for k in range(n)) + ')"' for j in range(n))
        with open(self.path("spinup.toml")) as f:
            text = f.read().replace("stiffening = true", "stiffening = false").replace("duration = 20.0", "duration = 8.0")
        text += ('\n[[sensor]]\nname = "gyro"\ntype = "gyro"\nbody = "boom"\n[[sensor]]\nname = "eta"\n'
                 'type = "modal_coordinate"\nbody = "boom"\n[[controller]]\nname = "stiffen"\ntype = "expression"\n'
                 'inputs = ["gyro:z", ' + ", ".join(f'"eta:{k + 1}"' for k in range(n)) + f"]\nexpression = [{law}]\n")
        for j in range(n):
            text += (f'[[actuator]]\nname = "jet{j + 1}"\ntype = "modal"\nbody = "boom"\ncoordinate = {j + 1}\n'
                     f'input = "stiffen:{j + 1}"\n')
        self.write("literal.toml", text)
        self.bough("run", "literal.toml", "-o", "literal.h5", "-q")
        with h5py.File(self.path("literal.h5")) as f:
            y, t = f["sensors/tip_deflection"][:, 1], f["time"][:]
            self.assertEqual(f["actuators/jet1"].attrs["dims"], "by normalisation")
        self.assertAlmostEqual(y.min(), -0.5346, delta=2e-4)
        self.assertAlmostEqual(t[y.argmin()], 6.77, delta=0.03)
        self.write("bad.toml", text.replace("coordinate = 2", "coordinate = 9"))
        self.fails(1, "check", "bad.toml", says=["mode 9", "which has 3"], error="control.unknown-place")

    def test_eq_18_by_jets_at_special_nodes_of_a_flx(self):
        """A jet along x at each special node, as in the report, the first with minus their sum; modal
        coordinates are displacements of special nodes."""
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-q")
        self.bough("flx", "boom.h5", "--special-nodes", "--digits", "17", "-o", "boom.FLX", "-q")
        nodes = json.loads(self.bough("flx", "--read", "boom.FLX", "--json").stdout)["special_nodes"]["id"]
        with h5py.File(self.path("boom.h5")) as f:
            K = f["stiffening/kg_inertial"][8]
        n = len(K)
        self.assertEqual(len(nodes), n + 1)
        formulas = ["-u1^2*(" + " + ".join(f"{K[j, k]:.15g}*u{k + 2}" for k in range(n)) + ")" for j in range(n)]
        formulas.insert(0, " - ".join(["0", *formulas]))
        with open(self.path("spinup.toml")) as f:
            text = f.read().replace("stiffening = true", "stiffening = false").replace("duration = 20.0", "duration = 8.0")
        text = text.replace("boom.h5", "boom.FLX")
        text += '\n[[sensor]]\nname = "gyro"\ntype = "gyro"\nbody = "boom"\nnode = %d\n' % nodes[0]
        for j, node in enumerate(nodes[1:]):
            text += f'[[sensor]]\nname = "eta{j + 1}"\ntype = "deflection"\nbody = "boom"\nnode = {node}\n'
        text += '[[sensor]]\nname = "eta"\ntype = "modal_coordinate"\nbody = "boom"\n'
        text += ('[[controller]]\nname = "stiffen"\ntype = "expression"\ninputs = ["gyro:z", '
                 + ", ".join(f'"eta{k + 1}:1"' for k in range(n)) + "]\nexpression = ["
                 + ", ".join(f'"{formula}"' for formula in formulas) + "]\n")
        for j, node in enumerate(nodes):
            text += (f'[[actuator]]\nname = "jet{j}"\ntype = "force"\nbody = "boom"\nnode = {node}\n'
                     f'axis = [1.0, 0.0, 0.0]\ninput = "stiffen:{j + 1}"\n')
        self.write("literal.toml", text)
        done = self.bough("run", "literal.toml", "-o", "literal.h5")
        self.assertIn("its special nodes take forces, actuators and sensors", done.stderr)
        with h5py.File(self.path("literal.h5")) as f:
            y, t, eta = f["sensors/tip_deflection"][:, 1], f["time"][:], f["sensors/eta"][:]
            for j in range(n):
                np.testing.assert_allclose(f[f"sensors/eta{j + 1}"][:, 0], eta[:, j], rtol=0, atol=1e-12)
        self.assertAlmostEqual(y.min(), -0.5346, delta=2e-4)
        self.assertAlmostEqual(t[y.argmin()], 6.77, delta=0.03)
        # A flat copy has them too; bodies do not attach to them, and there are no others.
        self.bough("export", "boom.FLX", "--to", "flat", "-o", "boom.flat", "-q")
        self.write("flat.toml", text.replace("boom.FLX", "boom.flat"))
        self.bough("run", "flat.toml", "-o", "flat.h5", "-q")
        with h5py.File(self.path("flat.h5")) as f:
            np.testing.assert_array_equal(f["sensors/tip_deflection"][:, 1], y)
        self.write("held.toml", text + f"""
[[constraint]]
name = "held"
type = "point_on_plane"
child = "boom"
child_node = {nodes[1]}
""")
        self.fails(1, "check", "held.toml", says=[f"node {nodes[1]} of body 'boom'", "a special node of its .FLX"],
                   error="system.special-node")
        self.write("other.toml", text.replace(f"node = {nodes[-1]}\naxis", f"node = {nodes[-1] + 1}\naxis"))
        self.fails(1, "check", "other.toml", error="system.unknown-node")


if __name__ == "__main__":
    unittest.main()
