"""Ends of hinges and points of functions are dragged in the studio by the mouse; keys do the same. The text gets the
numbers at once, Undo takes each step back, and the command line reads the file."""
import json
import math
import tomllib
import unittest

import h5py
import numpy as np

from studio_edits_test import ARM, Edits
from toml_text import section, table, toml

# On the screen: a place of the world, the handle of an axis at this share of its length, a point of a function.
WORLD = """((p) => { const { viewer } = studio.view, [x, y] = viewer.find_place(p), b = viewer.canvas.getBoundingClientRect(); return [b.x + x, b.y + y]; })(%s)"""
HANDLE = """((axis, share) => { const h = studio.view.hinge_places, now = h.locate(), { viewer } = studio.view, b = viewer.canvas.getBoundingClientRect();
  const [x, y] = viewer.find_place(now.at.map((v, i) => v + (axis < 0 ? 0 : share * h.get_length() * now.axes[axis][i]))); return [b.x + x, b.y + y]; })(%s, %s)"""
POINT = """((name, x, y) => { const { chart } = studio.view.diagrams.editors.get(name), b = chart.overlay.getBoundingClientRect(); return [b.x + chart.map_x(x), b.y + chart.map_y(y)]; })(%s, %s, %s)"""

NODES = toml(
    table("body", "arm", mass=2.0, cg=[0.5, 0.0, 0.0], inertia=[0.1, 1.0, 1.0],
          nodes=[{"id": 7, "position": [1.0, 0.0, 0.0]}, {"id": 8, "position": [0.6, 0.3, 0.0]}]),
    table("body", "hand", mass=1.0, inertia=[0.2, 0.2, 0.2]),
    table("body", "ball", mass=1.0, inertia=[0.1, 0.1, 0.1]),
    table("hinge", "shoulder", "revolute", child="arm", axis=[0.0, 0.0, 1.0], position=[0.6]),
    table("hinge", "wrist", "revolute", parent="arm", parent_node=7, child="hand", axis=[0.0, 0.0, 1.0]),
    table("hinge", "loose", "free", child="ball", position=[1.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.25]),
    section("simulation", duration=1.0, output_step=0.1),
    name="nodes")

CURVES = toml(
    table("body", "a", mass=2.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "first", "prismatic", child="a", axis=[1.0, 0.0, 0.0]),
    table("function", "thrust", "table", x=[0.0, 1.0, 3.0, 4.0], y=[0.0, 2.0, -1.0, 0.0]),
    table("actuator", "motor", "hinge", hinge="first", input="thrust"),
    section("simulation", duration=4.0, output_step=0.01),
    name="curves")


class Places(Edits):
    def get_hinge(self, name):
        return next(h for h in tomllib.loads(self.get_text())["hinge"] if h["name"] == name)

    def get_place(self, body):
        return self.browser.run(f"(() => {{ const m = studio.view.motion; return m.get_places()[m.bodies.find((b) => b.name === {body!r}).index].p; }})()")

    def choose_by_letter(self, label, text):
        """An option by its first letter, which no other one has: a list forgets letters that come slowly."""
        self.browser.run(f"document.querySelector('select[aria-label={json.dumps(label)}]').focus()")
        self.browser.type(text[0])
        self.wait(f"document.querySelector('select[aria-label={json.dumps(label)}]').selectedOptions[0].textContent === {json.dumps(text)}")

    def drag(self, start, end, **more):
        before = self.get_text()
        self.browser.drag(start, end, steps=8, **more)
        self.wait(f"studio.view.pane.text !== {json.dumps(before)}")
        self.wait_for_check()

    def test_along_an_axis(self):
        """The wrist goes along x of the arm, which is turned by 0.6: one number changes, and the hand goes with it."""
        page = self.show("arm.toml", ARM)
        self.choose_by_letter("move", "hand at wrist")
        page.show("canvas.scene")
        start, end = page.run(HANDLE % (0, 0.7)), page.run(WORLD % [math.cos(0.6) * (0.7 + 0), math.sin(0.6) * 0.7, 0.0])
        # The handle is taken at 0.7 of its length: the wrist goes to where the pointer ends less this.
        length = page.run("studio.view.hinge_places.get_length()")
        self.drag(start, end)
        position = self.get_hinge("wrist")["parent_position"]
        pixel = page.run("studio.view.viewer.extent") / 200
        self.assertAlmostEqual(position[0], 0.7 - 0.7 * length, delta=2 * pixel)
        self.assertEqual(position[1:], [0.0, 0.0])
        np.testing.assert_allclose(self.get_place("hand"), [position[0] * math.cos(0.6), position[0] * math.sin(0.6), 0], atol=1e-6)
        self.keep("studio-place")
        self.click_text("Undo")
        self.wait("studio.view.pane.text === studio.view.pane.saved")
        self.wait_for_check()
        np.testing.assert_allclose(self.get_place("hand"), [math.cos(0.6), math.sin(0.6), 0], atol=1e-6)
        # Only this key of the file changes.
        self.click_text("Redo")
        self.wait_for_check()
        self.save()
        self.assertEqual(self.read("arm.toml"), ARM.replace("parent_position = [1.0, 0.0, 0.0]", f"parent_position = [{position[0]}, 0.0, 0.0]"))
        self.bough("run", "arm.toml", "-o", "arm.h5")
        with h5py.File(self.path("arm.h5")) as f:
            np.testing.assert_allclose(f["/bodies/hand/position"][0], [position[0] * math.cos(0.6), position[0] * math.sin(0.6), 0], atol=1e-12)
        self.check_page(page)

    def test_in_the_plane_of_the_screen(self):
        """Seen from above a free body follows the pointer in x and y; with shift a tenth of the way."""
        page = self.show("nodes.toml", NODES)
        self.choose_by_letter("move", "ball at loose")
        box = page.show("canvas.scene")
        page.run("studio.view.viewer.yaw = -Math.PI / 2, studio.view.viewer.pitch = 1.55, studio.view.motion.draw()")
        start = page.run(HANDLE % (-1, 0))
        goal = page.run(WORLD % [0.1, 0.7, 0.25])
        self.drag(start, goal)
        position = self.get_hinge("loose")["position"]
        pixel = page.run("studio.view.viewer.extent") / 200
        self.assertEqual(position[:4], [1.0, 0.0, 0.0, 0.0])
        np.testing.assert_allclose(position[4:], [0.1, 0.7, 0.25], atol=3 * pixel)
        np.testing.assert_allclose(self.get_place("ball"), position[4:], atol=1e-6)
        # Shift: fine. The view does not turn.
        before, start = self.get_text(), page.run(HANDLE % (-1, 0))
        page.mouse("mouseMoved", *start)
        page.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1)
        for k in range(1, 7):
            page.mouse("mouseMoved", start[0] + 10 * k, start[1], button="left", buttons=1, modifiers=8)
        page.mouse("mouseReleased", start[0] + 60, start[1], button="left", clickCount=1, modifiers=8)
        self.wait(f"studio.view.pane.text !== {json.dumps(before)}")
        self.wait_for_check()
        fine = self.get_hinge("loose")["position"]
        way = page.run(f"(() => {{ const p = {WORLD % position[4:]}, q = {WORLD % fine[4:]}; return q[0] - p[0]; }})()")
        self.assertAlmostEqual(way, 6, delta=1)
        self.assertGreater(box["width"], 100)
        # Escape gives all back.
        text = self.get_text()
        start = page.run(HANDLE % (-1, 0))
        page.mouse("mouseMoved", *start)
        page.mouse("mousePressed", *start, button="left", buttons=1, clickCount=1)
        page.mouse("mouseMoved", start[0] + 40, start[1], button="left", buttons=1)
        self.assertGreater(abs(self.get_place("ball")[0] - fine[4]), 0.01)
        page.press("Escape")
        page.mouse("mouseReleased", start[0] + 40, start[1], button="left", clickCount=1)
        self.assertEqual(self.get_text(), text)
        np.testing.assert_allclose(self.get_place("ball"), fine[4:], atol=1e-6)
        self.check_page(page)

    def test_to_a_node_and_by_keys(self):
        """The end of the wrist goes to the node of the arm where it is let go; its node and numbers by keys too."""
        page = self.show("nodes.toml", NODES)
        self.choose_by_letter("move", "hand at wrist")
        page.show("canvas.scene")
        turn = lambda p: [math.cos(0.6) * p[0] - math.sin(0.6) * p[1], math.sin(0.6) * p[0] + math.cos(0.6) * p[1], p[2]]
        x, y = page.run(WORLD % turn([0.6, 0.3, 0.0]))
        self.drag(page.run(HANDLE % (-1, 0)), (x + 4, y - 3))
        hinge = self.get_hinge("wrist")
        self.assertEqual((hinge["parent_node"], hinge["parent_position"]), (8, [0.0, 0.0, 0.0]))
        np.testing.assert_allclose(self.get_place("hand"), turn([0.6, 0.3, 0.0]), atol=1e-6)
        # Keys: a node, then numbers from it.
        page.run("document.querySelector('[aria-label=\"place node\"]').select()")
        page.type("7\n")
        self.wait("studio.view.pane.text.includes('parent_node = 7')")
        self.wait_for_check()
        page.run("document.querySelector('[aria-label=\"place z\"]').select()")
        page.type("0.125\n")
        self.wait("studio.view.pane.text.includes('parent_position = [0.0, 0.0, 0.125]')")
        self.wait_for_check()
        np.testing.assert_allclose(self.get_place("hand"), turn([1.0, 0.0, 0.125]), atol=1e-6)
        # The other end: the hinge stays, the hand goes.
        self.choose_by_letter("end", "child")
        page.run("document.querySelector('[aria-label=\"place x\"]').select()")
        page.type("0.2\n")
        self.wait("studio.view.pane.text.includes('child_position = [0.2, 0.0, 0.0]')")
        self.wait_for_check()
        np.testing.assert_allclose(self.get_place("hand"), turn([0.8, 0.0, 0.125]), atol=1e-6)
        for _ in range(4):
            self.click_text("Undo")
        self.assertEqual(self.get_text(), NODES)
        self.check_page(page)

    def test_parameters_stay(self):
        """A place that is made of parameters is left alone, with a message."""
        text = ARM.replace('name = "arm"\n', 'name = "arm"\n[parameters]\nlength = 1.0\n', 1).replace("parent_position = [1.0, 0.0, 0.0]", 'parent_position = ["$length", 0.0, 0.0]')
        page = self.show("arm.toml", text)
        self.choose_by_letter("move", "hand at wrist")
        page.show("canvas.scene")
        start = page.run(HANDLE % (0, 0.7))
        page.drag(start, (start[0] + 60, start[1] + 10))
        self.wait("document.querySelector('.hinge-places output').textContent.includes('parent_position is made of parameters')")
        self.assertEqual(self.get_text(), text)
        np.testing.assert_allclose(self.get_place("hand"), [math.cos(0.6), math.sin(0.6), 0], atol=1e-6)


class CurveTest(Edits):
    def settle(self):
        """The curve is that of the text."""
        self.wait("studio.view.diagrams.drawn === studio.view.pane.text && [...studio.view.diagrams.editors.values()].every((e) => e.pending === 0 && e.chart.frame)")
        self.wait_for_check()
        self.browser.show(".curve-editor canvas.overlay")
        # The answer of the check may have made the charts again, which are drawn when they are in view.
        self.wait("[...studio.view.diagrams.editors.values()].every((e) => e.chart.frame)")


class Curves(CurveTest):
    def open_curves(self, text=CURVES):
        page = self.show("curves.toml", text)
        self.wait_for_check()  # the page moves when the messages come
        page.click("details.functions summary")
        self.wait("studio.view.diagrams.editors.get('thrust')?.chart")
        page.show(".curve-editor canvas.overlay")  # a chart is drawn when it is in view
        self.wait("studio.view.diagrams.editors.get('thrust').chart.frame")
        return page

    def get_points(self):
        function = tomllib.loads(self.get_text())["function"][0]
        return list(zip(function["x"], function["y"]))

    def get_pixel(self):
        return self.browser.run("(({ range: r, frame: f }) => [(r.x1 - r.x0) / f.width, (r.y1 - r.y0) / f.height])(studio.view.diagrams.editors.get('thrust').chart)")

    def double_click(self, x, y):
        for count in (1, 2):
            self.browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=count)
            self.browser.mouse("mouseReleased", x, y, button="left", clickCount=count)

    def test_points_by_mouse(self):
        page = self.open_curves()
        dx, dy = self.get_pixel()
        page.drag(page.run(POINT % ("'thrust'", 1, 2)), page.run(POINT % ("'thrust'", 1.5, 1.0)))
        self.wait("studio.view.pane.text !== studio.view.pane.saved")
        points = self.get_points()
        np.testing.assert_allclose(points[1], (1.5, 1.0), atol=(1.5 * max(dx, dy)))
        self.assertEqual([points[k] for k in (0, 2, 3)], [(0.0, 0.0), (3.0, -1.0), (4.0, 0.0)])
        self.settle()
        # A point does not pass its neighbour; straight up its x stays.
        page.drag(page.run(POINT % ("'thrust'", 3, -1)), page.run(POINT % ("'thrust'", 3, 1)))
        self.wait("!studio.view.pane.text.includes('-1.0')")
        self.assertEqual(self.get_points()[2][0], 3.0)
        self.settle()
        self.keep("studio-curve")
        # A double click adds, Delete removes.
        self.double_click(*page.run(POINT % ("'thrust'", 2.25, 0.25)))
        self.wait("document.querySelector('.curve-editor').dataset.points === '5'")
        self.settle()
        added = self.get_points()
        self.assertEqual(len(added), 5)
        np.testing.assert_allclose(added[2], (2.25, 0.25), atol=2 * max(self.get_pixel()))
        page.show(".curve-editor canvas.overlay")
        self.click_at(*page.run(POINT % ("'thrust'", added[2][0], added[2][1])))
        self.wait("document.querySelector('.curve-editor').dataset.chosen === '2'")
        page.press("Delete")
        self.wait("document.querySelector('.curve-editor').dataset.points === '4'")
        self.settle()
        self.assertEqual(self.get_points(), added[:2] + added[3:])
        # The motor of the run has this thrust: speed is impulse over mass.
        self.save()
        self.bough("run", "curves.toml", "-o", "curves.h5")
        x, y = np.transpose(self.get_points())
        with h5py.File(self.path("curves.h5")) as f:
            self.assertAlmostEqual(f["/hinges/first/qdot"][-1].item(), np.sum((y[1:] + y[:-1]) / 2 * np.diff(x)) / 2, delta=1e-6)
        for _ in range(4):
            self.click_text("Undo")
        self.assertEqual(self.get_text(), CURVES)
        self.settle()
        self.assertEqual(page.run("document.querySelector('.curve-editor').dataset.points"), "4")
        self.check_page(page)

    def test_points_by_keys(self):
        """Keys that come faster than the program answers: no step is lost."""
        page = self.open_curves()
        page.run("document.querySelector('.curve-editor canvas.overlay').focus()")
        page.type("nn")
        self.wait("document.querySelector('.curve-editor').dataset.chosen === '1'")
        step = 0.01 * page.run("(({ y1, y0 }) => y1 - y0)(studio.view.diagrams.editors.get('thrust').chart.range)")
        for _ in range(3):
            page.press("ArrowDown")
        self.settle()
        self.assertAlmostEqual(self.get_points()[1][1], 2 - 3 * step, delta=step)
        self.assertLess(self.get_points()[1][1], 2 - 2 * step)
        self.assertTrue(page.run("document.activeElement.matches('.curve-editor canvas.overlay')"))
        # The numbers of the chosen point, and limits of x.
        page.run("document.querySelector('[aria-label=\"x of the point of thrust\"]').select()")
        page.type("0.75\n")
        self.settle()
        self.assertEqual(self.get_points()[1][0], 0.75)
        page.run("document.querySelector('[aria-label=\"x of the point of thrust\"]').select()")
        page.type("3.5\n")
        self.wait("document.querySelector('.curve-editor output').textContent.includes('x stays between 0 and 3')")
        self.assertEqual(self.get_points()[1][0], 0.75)
        self.check_page(page)

    def test_tables_of_parameters_are_not_dragged(self):
        page = self.show("curves.toml", CURVES.replace('name = "curves"\n', 'name = "curves"\n[parameters]\npeak = 2.0\n').replace("y = [0.0, 2.0", 'y = [0.0, "$peak"'))
        page.click("details.functions summary")
        self.wait("document.querySelector('.function-curves').dataset.count === '1'")
        self.assertEqual(page.run("document.querySelectorAll('.curve-editor').length"), 0)


if __name__ == "__main__":
    unittest.main()
