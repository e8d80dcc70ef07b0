"""The system view of the studio by mouse and keys: axes of hinges are turned, connections are made and deleted. What is
written is what the commands of `bough edit` write, and what the command line then reads."""
import json
import math
import tomllib
import unittest

import h5py
import numpy as np

from studio_control_test import SYSTEM
from studio_page import PageTest
from toml_text import section, table, toml

# Tip of the arrow of the chosen hinge on the screen, and the length of the arrow.
TIP = """(() => { const h = studio.view.hinge_axes, now = h.locate(), { canvas } = studio.view.viewer, b = canvas.getBoundingClientRect();
  const p = studio.view.viewer.find_place(now.at.map((v, i) => v + h.get_length() * now.axis[i])); return [b.x + p[0], b.y + p[1]]; })()"""
# Where a tip would be in this direction of the world.
AIM = """((u) => { const h = studio.view.hinge_axes, now = h.locate(), { canvas } = studio.view.viewer, b = canvas.getBoundingClientRect();
  const p = studio.view.viewer.find_place(now.at.map((v, i) => v + h.get_length() * u[i])); return [b.x + p[0], b.y + p[1]]; })(%s)"""

ARM = toml(
    table("body", "arm", mass=2.0, cg=[0.5, 0.0, 0.0], inertia=[0.1, 1.0, 1.0]),
    table("body", "hand", mass=1.0, inertia=[0.2, 0.2, 0.2]),
    table("hinge", "shoulder", "revolute", child="arm", axis=[0.0, 0.0, 1.0], position=[0.6]),
    # The hinge frame is turned in the arm, which is turned itself.
    table("hinge", "wrist", "revolute", parent="arm", parent_position=[1.0, 0.0, 0.0], child="hand",
          parent_rotation_deg=[0.0, 0.0, 90.0], axis=[0.0, 0.0, 1.0]),
    section("simulation", duration=1.0, output_step=0.1),
    name="arm")


class Edits(PageTest):
    def show(self, name, text):
        self.write(name, text)
        page = self.open_studio(name)
        self.wait("document.querySelector('.text-pane')?.dataset.checked === '0'")
        self.wait("document.querySelector('.scene-host').dataset.samples")
        return page

    def get_text(self):
        return self.browser.run("studio.view.pane.text")

    def wait_for_check(self):
        self.wait("!studio.view.pane.is_checking && studio.view.pane.waiting === studio.view.pane.text && studio.view.text_drawn === studio.view.pane.text")

    def save(self):
        self.browser.click("button.save")
        self.wait("document.querySelector('dialog pre.diff')")
        diff = self.browser.run("document.querySelector('dialog pre.diff').textContent")
        self.click_text("Save", "document.querySelector('dialog')")
        self.wait("!document.querySelector('dialog') && !studio.view.is_changed()")
        return diff


class Bodies(Edits):
    """A rigid body is added to a boom: the boom moves from the ground to it."""

    def get_field(self, name):
        return self.browser.run(f"document.querySelector('.add-form [name={name}]')?.value")

    def put(self, **values):
        for name, value in values.items():
            self.browser.run(f"document.querySelector('.add-form [name={name}]').value = {json.dumps(value)}")

    def pick_table(self, text):
        self.browser.run(f"""(() => {{ const s = document.querySelector('[aria-label="table of the form"]');
          [...s.options].find((o) => o.textContent === '{text}').selected = true; s.dispatchEvent(new Event('change')); }})()""")

    def test_a_new_body_and_its_hinge(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        with h5py.File(self.path("boom.h5")) as f:
            node = int(f["nodes/id"][-1])
        page = self.show("sat.toml", toml(table("body", "boom", file="boom.h5"), table("hinge", "base", "revolute", child="boom", axis=[0.0, 0.0, 1.0]),
                                          section("simulation", duration=0.1, output_step=0.01)))
        page.click(".add-form summary")
        self.wait("document.querySelector('.add-form [name=inertia]')")
        self.assertIn("Ixx", page.run("document.querySelector('.add-form [name=inertia]').placeholder"))
        self.put(name="bus", mass="200.0", inertia="[30.0, 30.0, 30.0]")
        self.click_text("Add")
        # The hinge of the new body is next.
        self.wait("document.querySelector('.add-form [name=child]')?.value === 'bus'")
        self.assertEqual((self.get_field("parent"), self.get_field("type")), ("boom", "revolute"))
        self.wait_for_check()
        self.pick_table("hinge base")
        self.wait("document.querySelector('.add-form .main').textContent === 'Change' && document.querySelector('.add-form [name=name]').value === 'base'")
        self.put(child="bus")
        self.click_text("Change")
        self.wait("/child = .bus/.test(studio.view.pane.text)")
        # Not drawn: the boom alone has no inertia about its axis.
        self.wait("!studio.view.pane.is_checking && studio.view.pane.waiting === studio.view.pane.text")
        # Now the boom has none, and the click on its node is no other end.
        self.pick_table("hinge")
        self.wait("document.querySelector('.add-form [name=child]')?.value === 'boom' && document.querySelector('.add-form .main').textContent === 'Add'")
        self.assertEqual(self.get_field("parent"), "bus")
        self.click_node(node)
        self.assertEqual([self.get_field(name) for name in ("parent", "parent_node", "child", "child_node")], ["bus", "", "boom", str(node)])
        self.put(name="root", type="fixed")
        self.click_text("Add")
        self.wait("studio.view.pane.text.includes('root')")
        self.assertEqual(tomllib.loads(self.get_text())["hinge"], [{"name": "base", "type": "revolute", "child": "bus", "axis": [0.0, 0.0, 1.0]},
                         {"name": "root", "type": "fixed", "parent": "bus", "child": "boom", "child_node": node}])
        self.assertEqual(page.list_errors(), [])


class Axes(Edits):
    def get_axis(self, text, name):
        return next(h for h in tomllib.loads(text)["hinge"] if h["name"] == name)["axis"]

    def test_drag_of_the_tip(self):
        page = self.show("arm.toml", ARM)
        self.choose("turn the axis of", "wrist")
        page.show("canvas.scene")
        # In the world, in the arm (turned by 0.6 about z), in the hinge frame (turned by 90 degrees about z in the arm).
        angle = 0.6 + math.pi / 2
        direction = (0.48, 0.36, 0.8)
        page.drag(page.run(TIP), page.run(AIM % list(direction)), steps=12)
        self.wait("studio.view.pane.text !== studio.view.pane.saved")
        x, y, z = direction
        expected = (math.cos(angle) * x + math.sin(angle) * y, -math.sin(angle) * x + math.cos(angle) * y, z)
        axis = self.get_axis(self.get_text(), "wrist")
        self.assertGreater(sum(a * b for a, b in zip(axis, expected)), math.cos(math.radians(2)))  # a pixel or two
        self.assertAlmostEqual(math.hypot(*axis), 1, delta=2e-4)
        self.assertEqual(self.get_axis(self.get_text(), "shoulder"), [0.0, 0.0, 1.0])
        self.wait_for_check()
        self.keep("studio-axis")
        # Near an axis of the hinge frame it is that axis.
        near = (-math.cos(angle + 0.03), -math.sin(angle + 0.03), 0.03)
        page.drag(page.run(TIP), page.run(AIM % list(near)), steps=12)
        self.wait("studio.view.pane.text.includes('axis = [-1.0, 0.0, 0.0]')")
        self.assertEqual(self.get_axis(self.get_text(), "wrist"), [-1.0, 0.0, 0.0])
        self.wait_for_check()
        # Undo gives the axis before, then the file.
        self.click_text("Undo")
        self.assertEqual(self.get_axis(self.get_text(), "wrist"), axis)
        self.click_text("Undo")
        self.assertEqual(self.get_text(), ARM)
        self.click_text("Redo")
        self.wait_for_check()
        diff = self.save()
        self.assertEqual(len([line for line in diff.splitlines() if line[:1] in ("+", "-") and "arm.toml" not in line]), 2)
        self.assertEqual(self.read("arm.toml"), ARM.replace(
            "parent_rotation_deg = [0.0, 0.0, 90.0]\naxis = [0.0, 0.0, 1.0]",
            f"parent_rotation_deg = [0.0, 0.0, 90.0]\naxis = [{', '.join(str(v) for v in axis)}]"))
        self.check_page(page)
        # A drag away from the tip turns the view.
        yaw = page.run("studio.view.viewer.yaw")
        box = page.show("canvas.scene")
        page.drag((box["x"] + 20, box["y"] + 20), (box["x"] + 80, box["y"] + 20))
        self.assertNotEqual(page.run("studio.view.viewer.yaw"), yaw)

    def test_numbers_by_keys(self):
        page = self.show("arm.toml", ARM)
        self.choose("turn the axis of", "shoulder")
        page.run("document.querySelector('[aria-label=\"axis y\"]').select()")
        page.type("2\n")
        self.wait("studio.view.pane.text.includes('axis = [0.0, 2.0, 1.0]')")
        self.wait_for_check()
        # An axis without length is not taken.
        for name in "yz":
            page.run(f"document.querySelector('[aria-label=\"axis {name}\"]').select()")
            page.type("0\n")
        self.wait("studio.view.pane.text.includes('axis = [0.0, 0.0, 1.0]') || studio.view.pane.text.includes('axis = [0.0, 2.0, 0.0]')")
        self.assertGreater(math.hypot(*self.get_axis(self.get_text(), "shoulder")), 0.5)
        self.click_text("x", "document.querySelector('.axis-numbers')")
        self.wait("studio.view.pane.text.includes('axis = [1.0, 0.0, 0.0]')")
        self.wait_for_check()
        self.click_text("± reverse")
        self.wait("studio.view.pane.text.includes('axis = [-1.0, 0.0, 0.0]')")
        self.check_page(page)


class Texts(Edits):
    def test_commands_wait_for_each_other(self):
        """The answer to the first command comes last: neither change is lost."""
        page = self.show("arm.toml", ARM)
        page.run("""(async () => { const send = fetch; let count = 0;
          window.fetch = (u, o) => (o.body.includes('"what":"edit"') && count++ === 0 ? new Promise((r) => setTimeout(r, 1000)).then(() => send(u, o)) : send(u, o));
          await Promise.all([studio.view.pane.edit(["set hand.mass=1.5"]), studio.view.pane.edit(["set arm.mass=2.5"])]); window.fetch = send; })()""")
        self.assertEqual([b["mass"] for b in tomllib.loads(self.get_text())["body"]], [2.5, 1.5])


class Forms(Edits):
    def select_table(self, text):
        self.choose("table of the form", text)
        self.wait(f"document.querySelector('.add-form [name=name]').value === {text.split()[-1]!r}")

    def fill(self, name, value):
        self.browser.run(f"document.querySelector('.add-form [name={name}]').select()")
        self.browser.type(value)

    def apply(self):
        before = self.get_text()
        self.browser.click(".add-form .main")
        self.wait(f"studio.view.pane.text !== {json.dumps(before)}")
        self.wait_for_check()
        return tomllib.loads(self.get_text())

    def test_tables(self):
        """Tables are changed, renamed, added and deleted; what is not changed keeps its text."""
        text = ARM.replace("mass = 1.0", "mass = 1.0  # with its load")
        page = self.show("arm.toml", text)
        page.click(".add-form summary")
        self.wait("document.querySelector('.add-form [name=mass]')")
        self.select_table("body hand")
        self.assertEqual(page.run("document.querySelector('.add-form [name=mass]').value"), "1.0")
        self.fill("mass", "1.5")
        self.apply()
        self.assertEqual(self.get_text(), text.replace("mass = 1.0  #", "mass = 1.5  #"))
        # A name is changed where it is used, an empty value has no key.
        self.fill("name", "tool")
        self.assertEqual(self.apply()["hinge"][1]["child"], "tool")
        self.select_table("hinge wrist")
        self.assertTrue(page.run("document.querySelector('.ends [value=parent]').checked"))
        self.assertEqual(page.run("document.querySelector('.add-form [name=parent_rotation_deg]').value"), "[0.0, 0.0, 90.0]")
        page.run("document.querySelector('.add-form [name=parent_rotation_deg]').select()")
        page.press("Backspace")
        self.choose_field("type", "prismatic")
        page.click(".along button:nth-child(2)")
        hinge = self.apply()["hinge"][1]
        self.assertEqual((hinge["type"], hinge["axis"], hinge["parent"]), ("prismatic", [0.0, 1.0, 0.0], "arm"))
        self.assertNotIn("parent_rotation_deg", hinge)
        self.keep("studio-form")
        self.click_text("Delete", "document.querySelector('.add-form')")
        self.wait("!studio.view.pane.text.includes('wrist')")
        # A new one in its place has a name that is free; both bodies are chosen by keys.
        self.wait("document.querySelector('.add-form .main').textContent === 'Add'")
        self.choose("table of the form", "hinge")
        self.wait("document.querySelector('.add-form [name=name]').value === 'hinge1'")
        self.choose_field("parent", "arm")
        self.choose_field("child", "tool")
        added = self.apply()["hinge"][1]
        self.assertEqual(added, {"name": "hinge1", "type": "revolute", "parent": "arm", "child": "tool"})
        self.wait("document.querySelector('.add-form [name=name]').value === 'hinge2'")
        self.save()
        self.bough("check", "arm.toml")
        for _ in range(5):
            self.click_text("Undo")
        self.assertEqual(self.get_text(), text)
        self.check_page(page)


class Connections(Edits):
    def show_diagram(self):
        page = self.show("sliders.toml", SYSTEM)
        page.click("details.block-diagram summary")
        self.wait("document.querySelector('svg.diagram [data-edge]')")
        return page

    def find(self, selector):
        """The middle of an element on the screen; of a connection the middle of its line."""
        return self.browser.run(f"""(() => {{ const e = document.querySelector({selector!r}), wire = e.querySelector(".wire");
          e.scrollIntoView({{ block: "center", inline: "center" }}); const b = e.getBoundingClientRect();
          if (!wire) return [b.x + b.width / 2, b.y + b.height / 2];
          const p = wire.getPointAtLength(wire.getTotalLength() / 2).matrixTransform(wire.getScreenCTM()); return [p.x, p.y]; }})()""")

    def click_at(self, place):
        page = self.browser
        page.mouse("mouseMoved", *place)
        page.mouse("mousePressed", *place, button="left", buttons=1, clickCount=1)
        page.mouse("mouseReleased", *place, button="left", clickCount=1)

    def calc_poles(self, name):
        self.bough("linearize", name, "-o", name + ".h5", "--force")
        with h5py.File(self.path(name + ".h5")) as f:
            return f["/poles/imag"][:]

    def test_by_mouse(self):
        """A connection is deleted and drawn again: the command line finds the same poles."""
        page = self.show_diagram()
        before = self.calc_poles("sliders.toml")
        wire = '[aria-label^="connection sensor place → controller pid"]'
        self.click_at(self.find(wire))
        self.wait(f"document.querySelector('{wire}').classList.contains('chosen')")
        self.click_text("Delete connection")
        self.wait("!studio.view.pane.text.includes('inputs = ')")
        # The text is not valid without it, and is drawn.
        self.wait(f"!document.querySelector('{wire}') && Number(document.querySelector('.text-pane').dataset.checked) > 0")
        page.drag(self.find('[data-node="sensor place"]'), self.find('[data-node="controller pid"]'))
        self.wait("document.querySelector('dialog .connect-form')")
        self.keep("studio-connect")
        self.click_text("Connect", "document.querySelector('dialog')")
        self.wait(f"document.querySelector('{wire}')")
        self.assertIn({"from": "place", "to": "pid"}, tomllib.loads(self.get_text())["connect"])
        self.wait("document.querySelector('.text-pane').dataset.checked === '0'")
        self.save()
        np.testing.assert_allclose(self.calc_poles("sliders.toml"), before, rtol=1e-12)
        # The new connection is a table, deleted as a whole.
        self.click_at(self.find(wire))
        page.press("Delete")
        self.wait("!studio.view.pane.text.includes('[[connect]]')")
        self.click_text("Undo")
        self.click_text("Undo")
        self.click_text("Undo")
        self.assertEqual(self.get_text(), SYSTEM)
        self.check_page(page)

    def test_by_keys(self):
        """From the sensor to the motor past the controller, with a gain: the spring that this is has its poles."""
        page = self.show_diagram()
        page.run("document.querySelector('[data-node=\"sensor place\"]').focus()")
        page.type("c")
        self.wait("document.querySelector('.block.source')")
        page.run("document.querySelector('[data-node=\"body a\"]').focus()")
        page.press("Enter")
        self.wait("document.querySelector('.block-diagram output').textContent.includes('takes no signal')")
        page.run("document.querySelector('[data-node=\"sensor place\"]').focus()")
        page.type("c")
        page.run("document.querySelector('[data-node=\"actuator motor\"]').focus()")
        page.press("Enter")
        self.wait("document.querySelector('dialog [aria-label=gain]')")
        self.assertIn("In place of pid", page.run("document.querySelector('dialog').textContent"))
        page.run("document.querySelector('dialog [aria-label=gain]').select()")
        page.type("-7")
        page.run("document.querySelector('dialog button.main').focus()")
        page.type("\n")
        self.wait("studio.view.pane.text.includes('[[connect]]')")
        text = tomllib.loads(self.get_text())
        self.assertEqual(text["connect"], [{"from": "place", "to": "motor", "gain": -7}])
        self.assertNotIn("input", text["actuator"][0])
        self.wait("document.querySelector('.text-pane').dataset.checked === '0'")
        self.save()
        # u: rates of a against the ground, of b against a
        M, K = np.array([[3.0, 1.0], [1.0, 1.0]]), np.diag([307.0, 100.0])
        omega = np.sort(np.sqrt(np.linalg.eigvals(np.linalg.solve(M, K)).real))
        poles = self.calc_poles("sliders.toml")
        np.testing.assert_allclose(np.sort(poles[poles > 1e-6]), omega, rtol=1e-9)
        self.check_page(page)


if __name__ == "__main__":
    unittest.main()
