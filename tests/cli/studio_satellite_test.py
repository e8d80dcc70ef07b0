"""A satellite of a hub and two panels out of two decks in the studio, as a new user makes it: bodies, hinges at marked
nodes, a function by its type, a run, poles whose shape is seen next to their chart."""
import os
import tomllib
import unittest

import h5py
import numpy as np

from studio_browser_test import PROJECT
from studio_page import PageTest


def make_panel():
    """2 m by 1 m of 10 kg, with a yoke of two bars to the hinge at grid 1001."""
    lines = ["SOL 103", "CEND", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,6", "PSHELL,1,1,.02,1,,1", "MAT1,1,7.+10,,.33,250."]
    lines += [f"GRID,{1 + i + 5 * j},,{i / 4 - 0.5:.4f},{j / 4:.4f},0." for j in range(9) for i in range(5)]
    lines += [f"CQUAD4,{1 + i + 4 * j},1,{1 + i + 5 * j},{2 + i + 5 * j},{7 + i + 5 * j},{6 + i + 5 * j}" for j in range(8) for i in range(4)]
    lines += ["GRID,1001,,0.,-.3,0.", "CBAR,101,2,1001,2,0.,0.,1.", "CBAR,102,2,1001,4,0.,0.,1.", "PBAR,2,2,3.-4,3.-8,3.-8,6.-8", "MAT1,2,7.+10,,.33,1600."]
    return "\n".join([*lines, "ENDDATA", ""])


def make_hub():
    """A box of shells, 1 m each way, with a mass inside, and a rigid element on two sides: grids 901 and 902."""
    lines = ["SOL 103", "CEND", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,6", "PSHELL,1,1,.01,1,,1", "MAT1,1,7.+10,,.33,2700."]
    lines += [f"GRID,{k + 1},,{(k & 1) - 0.5},{(k >> 1 & 1) - 0.5},{(k >> 2) - 0.5}" for k in range(8)]
    faces = [(1, 2, 4, 3), (5, 6, 8, 7), (1, 2, 6, 5), (3, 4, 8, 7), (1, 3, 7, 5), (2, 4, 8, 6)]
    lines += [f"CQUAD4,{k + 1},1,{a},{b},{c},{d}" for k, (a, b, c, d) in enumerate(faces)]
    lines += ["GRID,900,,0.,0.,0.", "CONM2,20,900,,200.", "GRID,901,,0.,.55,0.", "GRID,902,,0.,-.55,0.",
              "RBE2,21,900,123456,1,2,3,4", "RBE2,22,901,123456,3,4,7,8", "RBE2,23,902,123456,1,2,5,6"]
    # RBE2s share corners of the box: the one inside has the four at the bottom that the sides leave.
    return "\n".join(line for line in [*lines, "ENDDATA", ""]).replace("RBE2,21,900,123456,1,2,3,4", "RBE3,21,,900,123456,1.,123,1,4,6,7")


class Satellite(PageTest):
    def wait_for_check(self):
        self.wait("!studio.view.pane.is_checking && studio.view.pane.waiting === studio.view.pane.text && studio.view.text_drawn === studio.view.pane.text")

    def pick_table(self, text, field):
        """A table of the form by the mouse: the choice in the open list is the browser's own."""
        self.browser.run(f"""(() => {{ const s = document.querySelector('[aria-label="table of the form"]');
          [...s.options].find((o) => o.textContent === '{text}').selected = true; s.dispatchEvent(new Event('change')); }})()""")
        self.wait(f"document.querySelector('.add-form [name={field}]')")

    def put(self, name, text):
        """Into a field of the form, by keys."""
        self.browser.run(f"document.querySelector('.add-form input[name={name}]').select()")
        self.browser.type(text)

    def get_field(self, name):
        return self.browser.run(f"document.querySelector('.add-form [name={name}]')?.value")

    def add(self):
        before = len(self.browser.run("studio.view.pane.text"))
        self.browser.click(".add-form button.add")
        self.wait(f"studio.view.pane.text.length !== {before}")
        self.wait_for_check()

    def save(self):
        self.wait("document.querySelector('dialog pre.diff')")
        self.click_text("Save", "document.querySelector('dialog')")
        self.wait("!document.querySelector('dialog')")

    def make_body(self, name, grid=None):
        page = self.browser
        self.open(name + ".bdf")
        self.wait(f"studio.view?.stage && studio.view.file === '{name}.bdf'")
        if grid:
            page.show("canvas.scene")
            self.click_at(*page.run(PROJECT % grid))
            self.wait(f"document.querySelector('.chosen').textContent.includes('{grid}')")
        page.click("button.make-body")
        self.save()
        self.wait(f"document.querySelector('main.work').dataset.file === '{name}.toml'")
        page.click("button.reduce")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        # The modes are in view.
        self.wait("(() => { const r = document.querySelector('.result .modes').getBoundingClientRect(); return r.top < innerHeight && r.bottom > 0; })()")

    def test_two_decks(self):
        self.write("panel.bdf", make_panel())
        self.write("hub.bdf", make_hub())
        page = self.open_studio()
        # A frame that no constraint of the deck holds is rejected before a file is made.
        self.open("panel.bdf")
        self.wait("studio.view?.stage")
        self.choose("frame", "fixed")
        page.click("button.make-body")
        self.wait("document.querySelector('.toast.bad')?.textContent.includes('choose frame free or mean')")
        self.assertFalse(os.path.exists(self.path("panel.toml")))
        page.click(".toast.bad > button")
        self.open("hub.bdf")
        self.make_body("panel", 1001)
        self.assertNotIn("free-free", self.read("panel.toml"))
        self.make_body("hub")
        self.open("hub-run.toml")
        self.wait("document.querySelector('.text-pane').dataset.checked === '0'")
        self.wait("document.querySelector('.scene-host').dataset.samples")
        page.click(".add-form summary")
        self.wait("document.querySelector('.add-form [name=file]')")
        self.assertFalse(page.run("studio.view.motion.has_node_marks"))
        for side, node in (("panel", 901), ("panel1", 902)):
            self.choose_field("file", "panel.h5")
            self.assertEqual(self.get_field("name"), side)
            self.add()
            self.wait(f"document.querySelector('.add-form [name=child]')?.value === '{side}'")
            self.assertEqual((self.get_field("parent"), self.get_field("type")), ("hub", "revolute"))
            # The centre of the rigid element is marked, and taken through the faces of the hub.
            self.assertTrue(page.run("studio.view.motion.has_node_marks"))
            self.click_node(node)
            self.assertEqual((self.get_field("parent_node"), self.get_field("child_node")), (str(node), ""))
            self.put("child_node", "1001")
            self.click_text("y", "document.querySelector('.add-form .along')")
            # A further key by letters: none is taken before the wanted one is there.
            page.run("document.querySelector('[aria-label=\"another key\"]').focus()")
            page.type("stif")
            self.assertEqual(page.run("document.activeElement.value"), "stiffness")
            page.press("Enter")
            self.wait("document.activeElement.name === 'stiffness'")
            page.type("50")
            if side == "panel1":
                page.run("document.querySelector('[aria-label=\"another key\"]').focus()")
                page.type("child_rotation_")
                page.press("Enter")
                self.wait("document.activeElement.name === 'child_rotation_deg'")
                self.assertEqual(page.run("document.activeElement.placeholder"), "[x, y, z]")
                self.assertIn("Here in degrees", page.run("document.activeElement.title"))
                page.type("[0, 0, 180]")
            self.add()
            # The lines that were added are in view.
            self.assertTrue(page.run("""(() => { const { area, text } = studio.view.pane.editor, lines = text.split('\\n'), height = area.scrollHeight / lines.length;
              const k = lines.lastIndexOf('child_node = 1001') * height; return k >= area.scrollTop && k + height <= area.scrollTop + area.clientHeight; })()"""))
            self.pick_table("body", "file")
        # At the end of the text the numbers of the lines are next to them.
        offset = page.run("""new Promise((done) => { const { area, gutter } = studio.view.pane.editor; area.scrollTop = area.scrollHeight;
          requestAnimationFrame(() => requestAnimationFrame(() => done(area.scrollTop > 0 ? gutter.scrollTop - area.scrollTop : NaN))); })""")
        self.assertAlmostEqual(offset, 0, delta=1)
        # A function has the fields of its type.
        self.pick_table("function", "type")
        page.run("(() => { const s = document.querySelector('.add-form [name=type]'); s.value = 'step'; s.dispatchEvent(new Event('change')); })()")
        self.wait("document.querySelector('.add-form [name=before]')")
        self.choose_field("type", "pulse")
        self.wait("document.querySelector('.add-form [name=width]')")
        fields = "[...document.querySelectorAll('.add-form .fields [name]')].map((f) => f.name)"
        self.assertEqual(page.run(fields), ["name", "type", "at", "value", "width"])
        for name, text in (("value", "2"), ("at", "0.1"), ("width", "0.2")):
            self.put(name, text)
        self.add()
        self.pick_table("force", "moment")
        self.choose_field("body", "hub")
        self.put("node", "900")
        self.put("moment", "[1, 0, 0]")
        self.choose_field("function", "function1")
        self.add()
        self.pick_table("simulation", "duration")
        self.wait("document.querySelector('.add-form button.add').textContent === 'Change'")
        for name, text in (("duration", "0.4"), ("gravity", "[0, 0, 0]")):
            self.put(name, text)
        self.add()
        self.keep("studio-satellite")
        page.click("button.run")
        self.save()
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        with h5py.File(self.path("hub-run.h5")) as f:
            np.testing.assert_allclose(f["/momentum/angular"][-1], [0.4, 0, 0], atol=1e-6)
            np.testing.assert_allclose(f["/bodies/panel/position"][0, 1], -f["/bodies/panel1/position"][0, 1], atol=1e-12)
        # Poles: the chart is in view, and the scene that moves in the shape of one next to it.
        page.click("button.linearize")
        self.wait("document.querySelector('.result').dataset.ready === 'linearize'")
        page.show(".result .live[data-view=poles]")
        self.wait("studio.view.poles && studio.view.poles.chart.frame")
        self.assertFalse(page.run("studio.view.floating.is_floating"))
        page.show(".pole-picker")
        page.run("(() => { const s = document.querySelector('.pole-picker'); s.selectedIndex = s.length - 1; s.dispatchEvent(new Event('change')); })()")
        self.wait("document.querySelector('.scene-host').dataset.pole")
        self.wait("studio.view.floating.is_floating")
        box = page.run("(() => { const b = studio.view.viewer.canvas.getBoundingClientRect(); return [b.left, b.top, innerWidth - b.right, innerHeight - b.bottom, b.width]; })()")
        self.assertTrue(all(v > 0 for v in box), box)
        self.keep("studio-floating")
        page.show(".scene-host")
        self.wait("!studio.view.floating.is_floating")
        page.click("button.save-page")
        self.wait("studio.has('hub-run.html')")
        self.check_page(page)
        # The shell has the same numbers.
        hinges = tomllib.loads(self.read("hub-run.toml"))["hinge"]
        self.assertEqual([h.get("parent_node") for h in hinges], [None, 901, 902])
        self.bough("run", "hub-run.toml", "-o", "shell.h5")
        with h5py.File(self.path("shell.h5")) as a, h5py.File(self.path("hub-run.h5")) as b:
            np.testing.assert_array_equal(a["/hinges/base/q"][:], b["/hinges/base/q"][:])


if __name__ == "__main__":
    unittest.main()
