"""The page of the studio after a failed run, a change outside, and with files of odd names."""
import json
import os
import subprocess
import tomllib
import unittest

import h5py

from browser import WAIT_FRAMES, Browser
from studio_browser_test import PROJECT, make_plate
from studio_control_test import SYSTEM
from studio_page import PageTest
from support import PROGRAM


class Decks(PageTest):
    def show_plate(self, name="plate.bdf"):
        self.write(name, make_plate())
        self.start_studio("./" + name)
        self.browser.visit(self.address)
        self.wait("studio.view?.stage")

    def get_chosen(self):
        return self.browser.run("document.querySelector('.chosen').textContent")

    def test_find_names_a_grid_and_chooses_none(self):
        self.show_plate()
        page = self.browser
        page.click("input[type=search]")
        page.type("21\n")
        self.wait("document.querySelector('.side .picked').textContent.startsWith('grid 21 (')")
        self.assertIn("none", self.get_chosen())
        self.assertTrue(page.run("document.querySelector('.viewer .tip').textContent").startswith("grid 21:"))
        page.run("studio.view.go({ what: 'grid 23 has no stiffness', line: 0, file: '' })")
        self.wait("document.querySelector('.side .picked').textContent.startsWith('grid 23 (')")
        self.assertIn("none", self.get_chosen())
        # A button takes a grid that no click reaches, whatever clicks do.
        page.run("document.querySelector('input[type=search]').value = ''")
        page.click("input[type=search]")
        page.type("22\n")
        self.wait("document.querySelector('.side .picked').textContent.startsWith('grid 22 (')")
        self.click_text("interface", "document.querySelector('.picked')")
        self.assertEqual(self.get_chosen(), "22 ✕")
        x, y = page.run(PROJECT % 23)
        page.mouse("mouseMoved", x, y)
        page.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        page.mouse("mouseReleased", x, y, button="left", clickCount=1)
        self.wait("document.querySelector('.chosen').textContent.includes('23')")

    def test_a_slender_deck_fills_the_view(self):
        """A strip across a corner of its box: the view is fitted to its points."""
        self.write("strip.bdf", "\n".join(
            ["SOL 103", "CEND", "BEGIN BULK", "MAT1,1,7.+10,,.3,2700.", "PSHELL,1,1,.01"]
            + [f"GRID,{2 * k + j + 1},,{k - 0.5 * j},{k + 0.5 * j},{0.3 * k}" for k in range(11) for j in range(2)]
            + [f"CQUAD4,{k + 1},1,{2 * k + 1},{2 * k + 3},{2 * k + 4},{2 * k + 2}" for k in range(10)] + ["ENDDATA", ""]))
        self.open_studio("strip.bdf")
        self.wait("studio.view?.stage")
        spans = self.browser.run("""(() => { const { viewer, scene } = studio.view.stage, { xyz } = scene.drawing, spans = [];
          const places = Array.from({ length: xyz.length / 3 }, (_, k) => viewer.find_place(xyz.subarray(3 * k, 3 * k + 3)));
          const sides = [viewer.canvas.clientWidth, viewer.canvas.clientHeight];
          for (const c of [0, 1]) for (const p of places) spans.push(Math.abs(p[c] / sides[c] - 0.5));
          return Math.max(...spans); })()""")
        self.assertGreater(spans, 0.4)
        self.assertLess(spans, 0.5)

    def test_a_deck_that_changes_outside_is_read_again(self):
        self.show_plate()
        page = self.browser
        page.run("studio.view.form.take(45)")
        self.write("plate.bdf", make_plate().replace("GRID,45,,1.0000,0.5000,0.", "GRID,45,,1.2500,0.5000,0."))
        page.run("studio.look()")
        self.wait("Math.abs(studio.view.stage.scene.get_place(45)[0] - 1.25) < 1e-6")
        self.assertIn("45", self.get_chosen())

    def test_a_large_mesh_is_turned_with_fewer_pixels(self):
        """While it is dragged; at rest with all. A small mesh is drawn with all throughout."""
        size = "[document.querySelector('canvas.scene').width / document.querySelector('canvas.scene').clientWidth, studio.view.stage.viewer.yaw]"
        for count, share in ((60, 0.5), (20, 1)):
            n = count + 1
            lines = ["SOL 103", "CEND", "BEGIN BULK", "PSHELL,1,1,.01,1", "MAT1,1,7.+10,,.3,2700."]
            lines += [f"GRID,{1 + i + n * j},,{i / n:.4f},{j / n:.4f},0." for j in range(n) for i in range(n)]
            lines += [f"CQUAD4,{1 + i + n * j},1,{1 + i + n * j},{2 + i + n * j},{2 + i + n * (j + 1)},{1 + i + n * (j + 1)}"
                      for j in range(count) for i in range(count)]
            self.write("plate.bdf", "\n".join([*lines, "ENDDATA", ""]))
            self.start_studio("plate.bdf")
            page = self.browser
            page.visit(self.address)
            self.wait("studio.view?.stage")
            before = page.run(size)
            box = page.show("canvas.scene")
            x, y = box["x"] + 20, box["y"] + 20
            page.mouse("mouseMoved", x, y)
            page.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
            page.mouse("mouseMoved", x + 60, y, button="left", buttons=1)
            self.wait(f"{size}[1] !== {before[1]}")
            self.wait(f"Math.abs({size}[0] - {share}) < 0.01")
            page.mouse("mouseReleased", x + 60, y, button="left", clickCount=1)
            self.wait(f"Math.abs({size}[0] - 1) < 0.01")
            self.end_studio()

    def test_clicks_in_a_body(self):
        """A click sets an interface node, an output node or unit loads; another one takes it out."""
        self.write("plate.bdf", make_plate())
        self.write("plate.toml", '[body]\nname = "plate"\ndeck = "plate.bdf"\nframe = "free"\n\n[body.modes]\nnumber = 4\n')
        page = self.open_studio("plate.toml")
        self.wait("studio.view?.stage && document.querySelector('.text-pane').dataset.checked === '0'")

        def click(grid, target=None):
            if target:
                self.choose("a click sets", target)
            before = page.run("studio.view.pane.text")
            page.run(WAIT_FRAMES)
            self.click_at(*page.run(PROJECT % grid))
            self.wait(f"document.querySelector('.work-column .picked').textContent.startsWith('grid {grid} ')")
            if target != "nothing":
                self.wait(f"studio.view.pane.text !== {json.dumps(before)}")
            self.wait("!studio.view.pane.is_checking && studio.view.pane.waiting === studio.view.pane.text")
            return tomllib.loads(page.run("studio.view.pane.text"))["body"]

        page.show("canvas.scene")
        self.assertEqual(click(21)["interface"], [21])
        self.assertEqual(click(23, "an output node")["output"]["nodes"], [23])
        self.wait("studio.view.outputs.length === 1")
        self.assertEqual(click(25)["output"]["nodes"], [23, 25])
        self.wait("studio.view.outputs.length === 2 && studio.view.stage.viewer.marks.length >= 2")
        self.assertEqual(click(45, "a load")["load"], [{"name": "load_45", "node": 45}])
        self.wait("studio.view.loads.length === 1")
        self.assertNotIn("load", click(45))
        body = click(21, "nothing")
        self.assertEqual((body["interface"], body["output"]["nodes"]), ([21], [23, 25]))
        page.click("button.save")
        self.wait("document.querySelector('dialog pre.diff')")
        self.click_text("Save", "document.querySelector('dialog')")
        self.wait("!studio.view.is_changed()")
        self.bough("reduce", "plate.toml")
        with h5py.File(self.path("plate.h5")) as f:
            self.assertEqual(f["/nodes/interface"][:].tolist(), [21])
            self.assertEqual(sorted(f["/nodes/id"][:].tolist()), [21, 23, 25])

    def test_commands_of_a_name_that_begins_with_a_dash(self):
        self.show_plate("-dash.bdf")
        page = self.browser
        page.click("button.make-body")
        self.wait("document.querySelector('dialog pre.diff')")
        self.click_text("Save", "document.querySelector('dialog')")
        self.wait("document.querySelector('main.work').dataset.file === '-dash.toml'")
        self.assertTrue(page.run("document.activeElement.classList.contains('file-title')"))
        # The number of modes is that of the deck, as no other was chosen.
        self.assertRegex(self.read("-dash.toml"), r"number = 4 +# as EIGRL 1 of the deck")
        page.click("button.reduce")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.click_text("Copy commands")
        self.wait("document.querySelector('dialog textarea')")
        text = page.run("document.querySelector('dialog textarea').value")
        # The lines do the same in the folder: none stops, none takes an edit away.
        before = self.read("-dash.toml")
        os.remove(self.path("-dash.h5"))
        script = text.replace("bough ", PROGRAM + " ")
        subprocess.run(["sh", "-e", "-c", script], cwd=self.folder, check=True, capture_output=True)
        self.assertTrue(os.path.exists(self.path("-dash.h5")))
        self.assertEqual(self.read("-dash.toml"), before)


class Systems(PageTest):
    def show_system(self, text=SYSTEM):
        self.write("sliders.toml", text)
        self.start_studio("sliders.toml")
        self.browser.visit(self.address)
        self.wait("document.querySelector('.text-pane')?.dataset.checked === '0'")

    def command(self, text):
        self.browser.click("input.command")
        self.browser.type(text + "\n")
        self.wait("document.querySelector('input.command').value === ''")

    def save(self):
        self.wait("document.querySelector('dialog pre.diff')")
        self.click_text("Save", "document.querySelector('dialog')")

    def test_a_failed_run_says_whose_results_are_shown(self):
        self.show_system()
        page = self.browser
        page.click("button.run")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.assertFalse(page.run("document.querySelector('.result .banner') !== null"))
        self.command("set simulation.output_step=5")
        page.click("button.run")
        self.save()
        self.wait("document.querySelector('.result').dataset.ready === 'old'")
        self.assertIn("wrote no results", page.run("document.querySelector('.result .banner').textContent"))

    def test_the_value_of_a_parameter_that_is_gone(self):
        self.show_system()
        page = self.browser
        page.run("""(() => { const field = document.querySelector('[aria-label="parameter gain"]');
          field.value = "7"; field.dispatchEvent(new Event("change")); })()""")
        self.assertEqual(page.run("studio.view.list_set()"), ["gain=7"])
        # The message of a failure goes when a later action succeeds.
        page.click("input.command")
        page.type("set nothing.x=1\n")
        self.wait("document.querySelector('.toast.bad')")
        page.run("document.querySelector('input.command').value = ''")
        self.command("set pid.kp=5.0")
        self.wait("!document.querySelector('.toast.bad')")
        self.command("unset parameters.gain")
        self.wait("studio.view.set.size === 0")

    def test_a_run_is_found_by_a_page_that_did_not_start_it(self):
        """After a reload and in a second tab a run has its progress, its curves and Stop; the text of the file is open."""
        self.show_system(SYSTEM.replace("duration = 2.0", "duration = 1e5"))
        page = self.browser
        page.click("button.run")
        self.wait("document.querySelector('.progress-line').textContent.includes('%')")
        page.visit(self.address)  # without the hash: the page of a second tab
        self.wait("document.querySelector('.jobs button')?.textContent.startsWith('run sliders.toml')")
        page.reload()
        self.assertEqual(page.run("studio.name"), "sliders.toml")
        self.wait("document.querySelector('.progress-line').textContent.includes('%')")
        self.wait("document.querySelector('.result .chart canvas')")
        self.keep("studio-found-run")
        self.assertFalse(page.run("document.querySelector('.progress button').hidden"))
        self.click_text("Stop")
        self.wait("document.querySelector('.progress-line').textContent.startsWith('stopped: bough run sliders.toml')")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.wait("document.querySelector('.jobs').childElementCount === 0")
        self.assertEqual(self.call("jobs")["result"]["jobs"], [])
        self.check_page(page)

    def test_a_killed_browser(self):
        """The run goes on, the file is as it was saved, and another browser finds both."""
        text = SYSTEM.replace("duration = 2.0", "duration = 1e5")
        self.write("sliders.toml", text)
        self.start_studio("sliders.toml")
        other = Browser(1000, 700)
        self.addCleanup(other.close)
        other.visit(self.address)
        run = "document.querySelector('.progress-line')?.textContent.includes('%')"
        self.assertTrue(other.wait_for("document.querySelector('.text-pane')?.dataset.checked === '0'"))
        other.click("button.run")
        self.assertTrue(other.wait_for(run))
        other.click("textarea.code")
        other.type("# not saved\n")
        other.process.kill()
        other.process.wait()
        self.assertEqual(self.read("sliders.toml"), text)
        self.assertEqual([j["request"]["files"] for j in self.call("jobs")["result"]["jobs"]], [["sliders.toml"]])
        self.browser.visit(self.address)
        self.wait(run)
        self.click_text("Stop")
        self.wait("document.querySelector('.progress-line').textContent.startsWith('stopped: ')")
        self.ask("chapter", file="sliders.h5")

    def test_a_reload_opens_the_file_that_was_open(self):
        self.write("plate.bdf", make_plate())
        self.show_system()
        page = self.browser
        self.open("plate.bdf")
        page.reload()
        self.assertEqual(page.run("document.querySelector('main.work').dataset.file"), "plate.bdf")

    def test_results_have_another_name_than_the_file_of_that_name(self):
        self.write("sliders.toml", SYSTEM)
        self.bough("linearize", "sliders.toml", "-o", "sliders.h5")
        before = self.read_bytes("sliders.h5")
        self.show_system()
        page = self.browser
        page.run("new Promise((done) => setTimeout(done, 500))")
        self.assertEqual(page.run("document.querySelector('.notes').textContent"), "")
        page.click("button.run")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.assertTrue(os.path.exists(self.path("sliders-run.h5")))
        self.assertEqual(self.read_bytes("sliders.h5"), before)

    def read_bytes(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()


if __name__ == "__main__":
    unittest.main()
