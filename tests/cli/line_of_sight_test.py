"""Sensor `line_of_sight`: optical nodes of several bodies against NumPy and SciPy, in runs and linear models."""
import os
import unittest

import numpy as np
from scipy.spatial.transform import Rotation

from linear_test import LinearTest
from toml_text import section, table, toml

L_TIP = [[0.0, 0.41, 0.2], [0.3, 0.0, -0.1]]
Q_TIP = [[-1.7, 0.0, 0.3], [0.0, 1.6, 0.5]]
Q_MIRROR = [[2.0, 0.0, 0.1], [0.0, 2.0, -0.4]]
L_MIRROR = [[0.05, -0.02, 0.0], [0.0, 0.07, 0.01]]
TERMS = [{"body": "boom", "node": 41, "displacement": L_TIP, "rotation": Q_TIP},
         {"body": "mirror", "displacement": L_MIRROR, "rotation": Q_MIRROR}]


def locate(name, body, node, **more):
    """Sensors of place and attitude of a node."""
    return (table("sensor", f"{name}_p", "position", body=body, node=node, **more) +
            table("sensor", f"{name}_R", "dcm", body=body, node=node, **{k: v for k, v in more.items() if k != "frame"}))


SYSTEM = toml(
    table("body", "hub", mass=3.0, inertia=[1.0, 1.0, 1.0]),
    table("body", "boom", file="boom.h5"),
    table("body", "mirror", mass=0.2, inertia=[2e-3, 3e-3, 4e-3], cg=[0.01, 0.0, 0.02]),
    table("hinge", "spin", "revolute", child="hub", axis=[0.0, 0.0, 1.0], position=[0.4], stiffness=[9.0]),
    table("hinge", "clamp", "fixed", parent="hub", child="boom"),
    table("hinge", "pivot", "universal", parent="boom", parent_node=41, child="mirror", axis=[1.0, 0.0, 0.0],
          axis2=[0.0, 1.0, 0.0], position=[0.0, 0.1], rate=[0.3, -0.2], stiffness=[4.0, 5.0]),
    table("function", "push", "sine", amplitude=0.02, omega=30.0),
    table("force", "torque", body="hub", moment=[0.3, 0.2, 1.0], function="push"),
    table("force", "side", body="boom", node=41, force=[0.0, 0.01, 0.02], function="push"),
    table("sensor", "sight", "line_of_sight", relative_to="hub", terms=TERMS),
    table("sensor", "sight_w", "line_of_sight", terms=[*TERMS, {"body": "hub", "rotation": [[0, 0, 1.0], [0, 0, 2.0]]}]),
    locate("tip", "boom", 41, relative_to="hub", frame="hub"), locate("mirror", "mirror", 0, relative_to="hub", frame="hub"),
    locate("tip_w", "boom", 41), locate("mirror_w", "mirror", 0), locate("hub_w", "hub", 0),
    section("simulation", duration=0.4, output_step=0.01))


class LineOfSight(LinearTest):
    def setUp(self):
        super().setUp()
        self.make_boom(6)
        self.write("sight.toml", SYSTEM)

    def calc(self, tail, more=()):
        """Σ L u + Q θ of the motion that the sensors of place and attitude recorded, against their first samples."""
        sight = 0
        for name, L, Q in (("tip", L_TIP, Q_TIP), ("mirror", L_MIRROR, Q_MIRROR), *more):
            p, R = self.read_arrays("sight.h5", f"sensors/{name}{tail}_p", f"sensors/{name}{tail}_R")
            R = R.reshape(-1, 3, 3)
            turn = Rotation.from_matrix(R @ R[0].T).as_rotvec()
            sight = sight + (p - p[0]) @ np.transpose(L) + turn @ np.transpose(Q)
        return sight

    def test_motion_of_a_run(self):
        self.bough("run", "sight.toml", "-o", "sight.h5")
        sight, sight_w = self.read_arrays("sight.h5", "sensors/sight", "sensors/sight_w")
        self.assertEqual(sight.shape, (41, 2))
        self.assertGreater(abs(sight).max(), 0.05)
        np.testing.assert_allclose(sight, self.calc(""), atol=1e-12)
        hub = ("hub", np.zeros((2, 3)), [[0, 0, 1], [0, 0, 2]])
        np.testing.assert_allclose(sight_w, self.calc("_w", [hub]), atol=1e-12)

    def test_rows_of_a_linear_model(self):
        """At the reference dR = [θ]× R0: θ from the rows of the direction cosines."""
        model = self.linearize("sight.toml", "--outputs", "sight,tip_p,tip_R,mirror_p,mirror_R")
        rows = {name: model["C"][[k for k, one in enumerate(model["outputs/name"]) if one.split(":")[0] == name]]
                for name in ("sight", "tip_p", "tip_R", "mirror_p", "mirror_R")}
        self.bough("run", "sight.toml", "-o", "sight.h5")
        expected = 0
        for name, L, Q in (("tip", L_TIP, Q_TIP), ("mirror", L_MIRROR, Q_MIRROR)):
            R0 = self.read_arrays("sight.h5", f"sensors/{name}_R")[0][0].reshape(3, 3)
            dR = rows[f"{name}_R"].reshape(3, 3, -1)
            W = np.einsum("ijn,kj->ikn", dR, R0)
            theta = np.array([W[2, 1] - W[1, 2], W[0, 2] - W[2, 0], W[1, 0] - W[0, 1]]) / 2
            expected = expected + np.array(L) @ rows[f"{name}_p"] + np.array(Q) @ theta
        self.assertEqual(expected.shape, (2, len(model["A"])))
        np.testing.assert_allclose(rows["sight"], expected, atol=1e-7 * abs(expected).max())

    def test_units(self):
        self.bough("run", "sight.toml", "-o", "sight.h5")
        os.mkdir(self.path("mm"))
        self.bough("convert", "boom.h5", "--units", "m-kg-s:mm-tonne-s", "-o", "mm/boom.h5")
        self.bough("convert", "sight.toml", "--units", "m-kg-s:mm-tonne-s", "-o", "mm/sight.toml")
        self.bough("run", "mm/sight.toml", "-o", "mm.h5")
        np.testing.assert_allclose(*(self.read_arrays(name, "sensors/sight")[0] for name in ("mm.h5", "sight.h5")), atol=2e-5)

    def test_diagram_and_page(self):
        self.bough("check", "sight.toml", "--diagram", "sight.dot")
        self.assertRegex(self.read("sight.dot"), '"body mirror" -> "sensor sight"')
        self.bough("run", "sight.toml", "-o", "sight.h5")
        self.bough("report", "sight.h5", "-o", "sight.html")

    def test_wrong_terms_are_named(self):
        for old, new, message in (
                ("node = 41, displacement", "node = 4711, displacement", "which body 'boom' does not have"),
                ('body = "mirror", displacement', 'body = "miror", displacement', "miror"),
                (str(Q_TIP), "[[1.0, 0.0, 0.0]]", "has 1 rows, expected 2"),
                (str(Q_TIP), "[[1.0, 0.0], [0.0, 1.0]]", "rotation"),
                (str(Q_TIP), "[[nan, 0.0, 0.0], [0.0, 1.0, 0.0]]", "rotation"),
                (f", displacement = {L_MIRROR}, rotation = {Q_MIRROR}", "", "has no weights"),
                ('relative_to = "hub"\nterms', 'relative_to = "huub"\nterms', "huub"),
                ('relative_to = "hub"\nterms', 'body = "hub"\nterms', "'body'"),
                ('type = "line_of_sight"', 'type = "position"', "'terms'")):
            self.assertIn(old, SYSTEM)
            self.write("sight.toml", SYSTEM.replace(old, new, 1))
            done = self.bough("check", "sight.toml", code=1)
            self.assertIn(message, done.stderr)
            self.assertIn("sight.toml:", done.stderr)


if __name__ == "__main__":
    unittest.main()
