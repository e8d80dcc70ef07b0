"""Shadow that bodies cast on panels and faces: areas by hand, and by half-planes in SciPy."""
import os
import unittest

import numpy as np
from scipy.optimize import linprog
from scipy.spatial import ConvexHull, HalfspaceIntersection

from mesh_faces_test import LX, LY, NX, NY, SUN, grid, make_body, make_deck
from support import ProgramTest
from toml_text import section, table, toml

PRESSURE = 4.5e-6
BOX = [[x, y, z] for x in (-0.6, 0.6) for y in (-0.3, 0.3) for z in (-0.25, 0.25)]


def rotate(angles_deg):
    """Turns about x, then the new y, then the new z."""
    R = np.eye(3)
    for axis, angle in enumerate(np.radians(angles_deg)):
        a, b = [(1, 2), (2, 0), (0, 1)][axis]
        turn = np.eye(3)
        turn[a, a] = turn[b, b] = np.cos(angle)
        turn[a, b], turn[b, a] = -np.sin(angle), np.sin(angle)
        R = R @ turn
    return R


def fix(name, position, angles_deg=(0.0, 0.0, 0.0), hull=BOX):
    """A rigid body fixed in space."""
    return toml(table("body", name, mass=1.0, inertia=[1.0, 1.0, 1.0], hull=hull),
                table("hinge", name + "_place", "fixed", child=name, parent_position=list(map(float, position)),
                      parent_rotation_deg=list(map(float, angles_deg))))


def calc_shade(corners, sun):
    """Area of the plate (z = 0) from which a ray to the sun meets the hull of the corners in front of it.

    On the ray p + t s the half-spaces of the hull bound t from below (and 0 does) and from above; each pair of bounds is
    a half-plane of p. Their intersection with the plate is a polygon.
    """
    planes = ConvexHull(corners).equations  # n·x + d <= 0
    along = planes[:, :3] @ sun
    bounds = [(-planes[i, :2] / along[i], -planes[i, 3] / along[i]) for i in range(len(planes))]  # t at z = 0: g·p + c
    low = [(np.zeros(2), 0.0)] + [b for b, s in zip(bounds, along) if s < 0]
    half_planes = [[*(g - h), c - d] for g, c in low for (h, d), s in zip(bounds, along) if s > 0]
    half_planes += [[-1, 0, 0], [1, 0, -LX], [0, -1, -LY / 2], [0, 1, -LY / 2]]
    half_planes = np.array([h for h in half_planes if np.linalg.norm(h[:2]) > 1e-12])
    norms = np.linalg.norm(half_planes[:, :2], axis=1)
    inner = linprog([0, 0, -1], A_ub=np.column_stack([half_planes[:, :2], norms]), b_ub=-half_planes[:, 2], bounds=[(None, None)] * 2 + [(0, None)])
    return ConvexHull(HalfspaceIntersection(half_planes, inner.x[:2]).intersections).volume


class Shading(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("plate.bdf", make_deck())
        self.write("plate.toml", make_body([grid(NX, 0), grid(NX, 2)]))
        self.bough("reduce", "plate.toml", "-q")

    def write_system(self, others, shaded_by, force=None, duration=1e-3, step=None, tolerance=1e-10):
        force = force or {"elements": "all"}
        self.write("s.toml", toml(
            table("body", "plate", file="plate.h5"), table("hinge", "held", "fixed", child="plate", child_node=grid(0, 1)),
            *others, table("force", "light", "solar_pressure", body="plate", pressure=PRESSURE, shaded_by=shaded_by,
                           **{"sun": [0.0, 0.0, 1.0], **force}),
            section("simulation", duration=duration, output_step=step or duration, integrator="rk", relative_tolerance=tolerance)))

    def read_light(self, *arguments, **keys):
        self.write_system(*arguments, **keys)
        self.bough("run", "s.toml", "-o", "s.h5", "-q")
        return self.read_arrays("s.h5", "/forces/light/force")[0]

    def read_area(self, *arguments, **keys):
        self.read_light(*arguments, **keys)
        return self.read_arrays("s.h5", "/forces/light/area")[0].flat[0]

    def test_boxes_over_the_plate(self):
        """Rectangles by hand: one, two that overlap, one beyond an edge, one under the plate, one cut in half by it."""
        whole = LX * LY
        for places, shade in (([(2, 0, 1)], 1.2 * 0.6), ([(2, 0, 1), (2.3, 0.1, 2)], 2 * 1.2 * 0.6 - 0.9 * 0.5),
                              ([(4, 0, 1)], 0.6 * 0.6), ([(2, 0, -1)], 0), ([(2, 0, 0.1)], 1.2 * 0.6),
                              ([(2, 0, 1), (2, 0, 1)], 1.2 * 0.6)):
            names = [f"box{i}" for i in range(len(places))]
            area = self.read_area([fix(name, place) for name, place in zip(names, places)], names)
            self.assertAlmostEqual(area, whole - shade, delta=1e-12)

    def test_slanted_light_past_turned_boxes(self):
        """Half-planes in SciPy; the second box goes through the plane of the plate, the third shades its back."""
        for place, angles, sun in (((2.5, 0.2, 1.0), (20, -35, 50), (0.5, -0.2, 0.8)), ((1.5, 0.1, 0.1), (70, 20, 10), (-0.6, 0.4, 0.5)),
                                   ((2.0, -0.1, -0.8), (5, 60, -20), (0.2, 0.1, -0.9))):
            sun = np.array(sun) / np.linalg.norm(sun)
            shade = calc_shade(np.array(BOX) @ rotate(angles).T + place, sun)
            self.assertGreater(shade, 0.1)
            area = self.read_area([fix("box", place, angles)], ["box"], {"elements": "all", "sun": sun.tolist()})
            self.assertAlmostEqual(area, (LX * LY - shade) * abs(sun[2]), delta=1e-11)

    def test_each_face_has_its_own_light(self):
        """A plate of 0.5 x 0.5 over the middle of one face: that face alone loses a quarter of its area (0.5 of 2)."""
        flat = [[-0.25, -0.1, 0.0], [0.25, -0.1, 0.0], [0.25, 0.1, 0.0], [-0.25, 0.1, 0.0]]
        self.assertEqual(LX / NX * LY / NY, 0.5)
        for element, area in ((1, 0.5), (2, 0.4), (3, 0.5)):
            shaded = self.read_area([fix("flag", (1.5, -0.25, 0.3), hull=flat)], ["flag"], {"elements": [element]})
            self.assertAlmostEqual(shaded, area, delta=1e-12)

    def test_a_panel_of_given_area_is_a_disc(self):
        """Half a disc in shadow; nodes of a rigid body are its hull."""
        edge = [{"id": i + 1, "position": p} for i, p in enumerate([[0.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [0.0, 9.0, 0.0]])]
        blind = toml(table("body", "blind", mass=1.0, inertia=[1.0, 1.0, 1.0], nodes=edge),
                     table("hinge", "place", "fixed", child="blind", parent_position=[2.0, 0.0, 5.0]))
        panel = {"area": 3.0, "normal": [0.0, 0.0, 1.0], "node": grid(0, 1), "position": [2.0, 0.0, 0.0]}
        light = self.read_light([blind], ["blind"], panel)
        np.testing.assert_allclose(light[0], [0, 0, -PRESSURE * 1.5], rtol=1e-9, atol=1e-18)
        self.assertAlmostEqual(self.read_arrays("s.h5", "/forces/light/sunlight")[0].flat[0], 0.5, delta=1e-9)

    def test_shadow_moves_with_its_body(self):
        """A box on a hinge that turns at 1 rad/s in the time 0.7 shades as one that is placed there."""
        turning = toml(table("function", "turn", "expression", expression="t", rate="1", acceleration="0"),
                       table("body", "box", mass=1.0, inertia=[1.0, 1.0, 1.0], hull=BOX),
                       table("hinge", "turn", "revolute", child="box", parent_position=[2.0, 0.0, 1.0], axis=[0.0, 0.0, 1.0], motion=["turn"]))
        self.read_light([turning], ["box"], duration=0.7)
        moved = self.read_arrays("s.h5", "/forces/light/area")[0].ravel()
        self.assertAlmostEqual(moved[0], LX * LY - 1.2 * 0.6, delta=1e-12)
        placed = self.read_area([fix("box", (2, 0, 1), (0, 0, np.degrees(0.7)))], ["box"])
        self.assertAlmostEqual(moved[-1], placed, delta=1e-5)  # the plate bends by its light

    def test_units(self):
        self.write_system([fix("box", (2.5, 0.2, 1.0), (20, -35, 50))], ["box"], {"elements": "all", "sun": [0.5, -0.2, 0.8]})
        self.bough("run", "s.toml", "-o", "m.h5", "-q")
        os.mkdir(self.path("mm"))
        for name in ("s.toml", "plate.h5"):
            self.bough("convert", name, "-o", "mm/" + name, "--units", "m-kg-s:mm-kg-s")
        self.bough("run", "mm/s.toml", "-o", "mm.h5", "-q")
        m, mm = (self.read_arrays(name, "/forces/light/area")[0].flat[0] for name in ("m.h5", "mm.h5"))
        self.assertLess(m, LX * LY * 0.8)
        self.assertAlmostEqual(mm / m / 1e6, 1, delta=1e-12)

    def test_what_casts_no_shadow_is_named(self):
        box = fix("box", (2, 0, 1))
        line = fix("box", (2, 0, 1), hull=[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
        bare = "".join(line for line in box.splitlines(True) if not line.startswith("hull"))
        for other, names, error in ((box, ["plate"], "shaded_by its own body 'plate'"), (box, ["ground"], "shaded_by ground"),
                                    (box, ["bocks"], "system.unknown-body"), (line, ["box"], "whose hull has no area"),
                                    (bare, ["box"], "whose nodes have no area")):
            self.write_system([other], names)
            with self.subTest(error):
                found = self.bough("check", "s.toml", code=1).stderr
                self.assertIn(error, found)
                self.assertRegex(found, r"s\.toml:\d+: error")
        self.write_system([box], [])
        self.assertRegex(self.bough("check", "s.toml", code=1).stderr, r"s\.toml:\d+: error: .*shaded_by")
        self.write_system([box], ["box"])
        with open(self.path("s.toml")) as f:
            text = f.read()
        self.write("s.toml", text.replace("solar_pressure", "drag").replace("pressure =", "coefficient ="))
        self.assertIn("'shaded_by' has no meaning", self.bough("check", "s.toml", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
