"""bough studio in headless Chromium by mouse and keys: from a deck to a body, a system, a run, poles and a page; the
files written give the same numbers by the command line. Skipped, with a message, where chromium is not installed."""
import json
import os
import re
import shutil
import tomllib
import unittest

import h5py
import numpy as np

from studio_control_test import SYSTEM
from studio_page import PageTest
from support import SOURCE

SHARED = os.environ.get("BOUGH_SHARED_DIR", "")
FOREIGN = os.path.join(SHARED, "models/plate_py/plate_py.dat")
# Place of a grid of the deck on the screen.
PROJECT = """(() => { const { viewer, scene } = studio.view.stage, p = scene.get_place(%d), m = viewer.make_view();
  const [x, y, , w] = [0, 1, 2, 3].map((r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
  const b = viewer.canvas.getBoundingClientRect();
  return [b.x + b.width * (1 + x / w) / 2, b.y + b.height * (1 - y / w) / 2]; })()"""
COLORS = """(() => { const c = document.querySelector('canvas.scene'), s = document.createElement('canvas');
  s.width = c.width; s.height = c.height; const g = s.getContext('2d'); g.drawImage(c, 0, 0);
  const d = g.getImageData(0, 0, s.width, s.height).data, seen = new Set();
  for (let i = 0; i < d.length; i += 4) seen.add((d[i] << 16) | (d[i + 1] << 8) | d[i + 2]); return seen.size; })()"""


def make_plate():
    """A free plate of 0.5 by 1, for machines without the foreign deck."""
    lines = ["SOL 103", "CEND", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,10", "PSHELL,1,1,.01,1", "MAT1,1,7.+10,,.3,2700."]
    lines += [f"GRID,{1 + i + 9 * j},,{i / 8:.4f},{j / 8:.4f},0." for j in range(5) for i in range(9)]
    lines += [f"CQUAD4,{1 + i + 8 * j},1,{1 + i + 9 * j},{2 + i + 9 * j},{11 + i + 9 * j},{10 + i + 9 * j}"
              for j in range(4) for i in range(8)]
    return "\n".join([*lines, "ENDDATA", ""])


class Flow(PageTest):
    def test_deck_to_page(self):
        name = "plate_py.dat"
        if os.path.exists(FOREIGN):
            shutil.copy(FOREIGN, self.folder)
        else:
            self.write(name, make_plate())
        stem = name.rsplit(".", 1)[0]
        page = self.open_studio(name)
        self.wait("studio.view?.stage")
        self.assertGreater(page.run(COLORS), 10)

        grid = page.run("studio.view.stage.scene.drawing.ids[0]")
        x, y = page.run(PROJECT % grid)
        self.click_at(x, y)
        self.wait(f"document.querySelector('.side .picked').textContent.startsWith('grid {grid} (')")
        self.assertIn(str(grid), page.run("document.querySelector('.chosen').textContent"))
        self.click_text("Check")
        self.wait("![...document.querySelectorAll('h3 button')].some((b) => b.disabled)")
        self.keep("studio-deck")

        self.choose("frame", "free")
        page.run("document.querySelector('[aria-label=\"number of modes\"]').select()")
        page.type("6")
        page.click("button.make-body")
        self.wait("document.querySelector('dialog pre.diff')")
        shown = page.run("document.querySelector('dialog pre.diff').textContent")
        self.assertIn("+[body]", shown)
        self.assertIn("@@ -0,0 +1,", shown)
        # The list that was chosen replaces the one to be filled in; the number of modes is no longer that of the deck.
        self.assertEqual(len(re.findall("interface = ", shown)), 1)
        self.assertNotRegex(shown, "number = 6 +#")
        self.assertEqual(page.run("(() => { const d = document.querySelector('dialog'); return d.scrollHeight - d.clientHeight; })()"), 0)
        self.assertFalse(os.path.exists(self.path(stem + ".toml")))
        self.keep("studio-save")
        self.click_text("Save", "document.querySelector('dialog')")
        self.wait(f"document.querySelector('main.work').dataset.file === '{stem}.toml'")
        self.assertIn(f"interface = [{grid}]", self.read(stem + ".toml"))
        self.wait("document.querySelector('.text-pane').dataset.checked === '0'")

        page.click("button.reduce")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.wait("document.querySelector('.result .modes')")
        self.keep("studio-body")

        self.open(stem + "-run.toml")
        self.wait("document.querySelector('.text-pane').dataset.checked === '0'")
        self.wait("document.querySelector('.scene-host').dataset.samples")
        # The free body is put on a hinge along its edge, at the node that is clicked; another node gets a sensor.
        end = page.run("Math.max(...studio.view.viewer.things.find((t) => t.ids).ids)")
        page.click(".add-form summary")
        self.wait("document.querySelector('.add-form [name=name]')")
        self.choose("table of the form", "hinge base")
        self.wait("document.querySelector('.add-form .main').textContent === 'Change' && document.querySelector('.add-form [name=type]').value === 'free'")
        self.choose_field("type", "revolute")
        self.click_node(grid)
        self.click_text("x", "document.querySelector('.add-form .along')")
        self.keep("studio-hinge")
        self.click_text("Change")
        self.wait("studio.view.pane.text.includes('revolute')")
        self.assertEqual({"name": "base", "type": "revolute", "parent": "ground", "child": stem, "child_node": grid, "axis": [1.0, 0.0, 0.0]},
                         tomllib.loads(page.run("studio.view.pane.text"))["hinge"][0])
        self.wait("document.querySelector('.text-pane').dataset.checked === '0'")
        self.choose("table of the form", "sensor")
        self.choose_field("type", "position")
        self.click_node(end)
        self.click_text("Add")
        self.wait("studio.view.pane.text.includes('sensor1')")
        # A value by keys: the text has the change, the file has it after the difference was shown.
        self.choose("table of the form", "simulation")
        self.wait("document.querySelector('.add-form [name=duration]')")
        page.run("document.querySelector('.add-form [name=duration]').select()")
        page.type("0.2")
        self.click_text("Change")
        self.wait("studio.view.pane.text.includes('duration = 0.2')")
        self.wait("document.querySelector('.text-pane').dataset.checked === '0'")
        page.click("button.run")
        self.wait("document.querySelector('dialog pre.diff')")
        self.click_text("Save", "document.querySelector('dialog')")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.assertIn("duration = 0.2", self.read(stem + "-run.toml"))
        self.assertGreater(page.run(COLORS), 10)
        page.show(".result [data-panel=histories]")
        self.wait("document.querySelector('.result .chart canvas')")
        widths = page.run("[...document.querySelectorAll('.result .history .stage, .result [data-panel=histories]')].map((e) => e.clientWidth)")
        self.assertGreater(min(widths), 0.85 * max(widths))  # of the panel
        self.keep("studio-curves")
        page.show(".scene-host canvas")
        self.keep("studio-run")

        page.click("button.save-page")
        self.wait(f"studio.has('{stem}-run.html')")
        self.assertIn("Content-Security-Policy", self.read(stem + "-run.html"))
        page.click("button.linearize")
        self.wait("document.querySelector('.result').dataset.ready === 'linearize'")
        page.show(".result .live[data-view=poles]")
        self.wait("studio.view.poles && studio.view.poles.chart.frame")
        self.keep("studio-poles")
        poles = page.run("[studio.view.poles.poles.real, studio.view.poles.poles.imag]")
        # The page has what is on the screen: the run and the poles.
        before = page.run(f"studio.find('{stem}-run.html').time")
        page.click("button.save-page")
        self.wait(f"studio.find('{stem}-run.html').time !== {json.dumps(before)}")
        self.assertIn('data-view="poles"', self.read(stem + "-run.html"))
        self.assertIn('data-view="motion"', self.read(stem + "-run.html"))
        self.check_page(page)
        self.assertTrue(all(url.startswith((self.address, "blob:", "data:")) or url.endswith("favicon.ico") for url in page.list_requests()))

        # The lines that the page shows, in another folder of the shell.
        page.click("button.copy")
        self.wait("document.querySelector('dialog textarea')")
        lines = page.run("document.querySelector('dialog textarea').value").splitlines()
        self.assertIn(f"bough run {stem}-run.toml -o {stem}-run.h5", lines)
        self.bough("reduce", stem + ".toml", "-o", "shell.h5")
        self.bough("run", stem + "-run.toml", "-o", "shell-run.h5")
        with h5py.File(self.path("shell.h5")) as a, h5py.File(self.path(stem + ".h5")) as b:
            np.testing.assert_array_equal(a["/modes/frequency_hz"][:], b["/modes/frequency_hz"][:])
        with h5py.File(self.path("shell-run.h5")) as a, h5py.File(self.path(stem + "-run.h5")) as b:
            for path in ("/hinges/base/q", "/sensors/sensor1"):
                np.testing.assert_array_equal(a[path][:], b[path][:])
                self.assertGreater(np.ptp(a[path][:], axis=0).max(), 1e-3)
        self.bough("linearize", stem + "-run.toml", "-o", "shell-linear.h5")
        with h5py.File(self.path("shell-linear.h5")) as f:
            found = np.array([f["/poles/real"][:], f["/poles/imag"][:]])
        np.testing.assert_allclose(poles, found, rtol=1e-12, atol=1e-11 * np.abs(found).max())

    def test_poles_and_blocks(self):
        """A pole that is clicked moves the system, poles follow a gain that is dragged, a block leads to its line."""
        page = self.open_system(SYSTEM)
        page.click("button.linearize")
        self.wait("document.querySelector('.result').dataset.ready === 'linearize'")
        page.show(".result .live[data-view=poles]")
        self.wait("studio.view.poles && studio.view.poles.chart.frame")
        x, y = page.run("""(() => { const { chart, poles } = studio.view.poles, b = chart.overlay.getBoundingClientRect();
          return [b.x + chart.map_x(poles.x[0]), b.y + chart.map_y(poles.y[0])]; })()""")
        self.click_at(x, y)
        self.wait("document.querySelector('.scene-host').dataset.pole === '0'")
        self.assertTrue(page.run("studio.view.motion.is_playing"))
        self.assertIn("Hz", page.run("document.querySelector('.work-column .picked').textContent"))
        chosen = "document.querySelector('.pole-picker').selectedOptions[0].textContent"
        self.assertEqual(page.run(chosen), page.run("document.querySelector('.work-column .picked').textContent").replace("shape of the pole ", ""))
        # "no pole" ends the motion: the system at its start.
        self.choose("move in the shape of", "no pole")
        self.wait("document.querySelector('.scene-host').dataset.pole === undefined && !studio.view.motion.is_playing")
        self.click_at(x, y)
        self.wait("document.querySelector('.scene-host').dataset.pole === '0'")
        # It goes round and does not end.
        self.wait("(() => { const m = studio.view.motion; m.set_time(m.last); return m.is_playing; })()")
        self.choose("move in the shape of", "1.27")
        # The gain by its slider, from the middle to the right: the poles follow.
        box = page.show('[aria-label="gain by dragging"]')
        start = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        page.drag(start, (start[0] + 30, start[1]))
        self.wait("Number(studio.view.poles.chart.element.dataset.followed) >= 4")
        self.wait("!studio.view.poles.is_asking")
        gain = float(page.run("document.querySelector('[aria-label=\"parameter gain\"]').value"))
        self.assertGreater(gain, 5)
        self.bough("linearize", "sliders.toml", "--set", f"gain={gain}", "-o", "shell.h5")
        with h5py.File(self.path("shell.h5")) as f:
            np.testing.assert_allclose(page.run("studio.view.poles.poles.imag"), f["/poles/imag"][:], rtol=1e-12)
            shown = page.run("[...studio.view.poles.picker.list.options].slice(1).map((o) => parseFloat(o.textContent))")
            np.testing.assert_allclose(shown, f["/poles/frequency_hz"][:][f["/poles/imag"][:] >= 0], rtol=1e-4)
        # Above the table: its poles are those of the file. A click on a pole of now takes it, though one of then is below.
        self.assertIn(f"not with gain={gain:g}".rstrip("0"), page.run("document.querySelector('[data-panel=poles] .stale').textContent"))
        page.run("studio.view.poles.chart.element.scrollIntoView({ block: 'center' })")
        for k in range(4):
            at = page.run(f"""(() => {{ const {{ chart, poles }} = studio.view.poles, b = chart.overlay.getBoundingClientRect();
              return [b.x + chart.map_x(poles.x[{k}]), b.y + chart.map_y(poles.y[{k}])]; }})()""")
            self.click_at(*at)
            index = page.run(f"studio.view.poles.poles.index[{k}]")
            self.wait(f"document.querySelector('.scene-host').dataset.pole === '{index}'")
            tip = page.run("document.querySelector('[data-view=poles] .tip').textContent")
            self.assertTrue(tip.startswith(page.run(f"studio.view.poles.poles.frequency[{k}].toPrecision(5).replace(/0+$/, '')")), tip)
        # The last of two requests wins, though the answer to the first comes later.
        page.run("""(async () => { const send = fetch; let count = 0;
          window.fetch = (u, o) => (o.body.includes("pole-motion") && count++ === 0 ? new Promise((r) => setTimeout(r, 3000)).then(() => send(u, o)) : send(u, o));
          await Promise.all([studio.view.poles.show(0), studio.view.poles.show(2)]); window.fetch = send; })()""")
        self.assertEqual(page.run("document.querySelector('.scene-host').dataset.pole"), "2")
        page.show(".result .live[data-view=poles]")
        self.keep("studio-locus")

        page.click("details.block-diagram summary")
        self.wait("Number(document.querySelector('.diagram-host').dataset.blocks) > 5")
        page.show("svg.diagram")
        self.keep("studio-diagram")
        page.run("document.querySelector('svg.diagram [aria-label=\"controller pid\"]').focus()")
        page.press("Enter")
        line = SYSTEM[:SYSTEM.index("[[controller]]")].count("\n")
        self.assertEqual(page.run("studio.view.pane.editor.area.value.slice(0, studio.view.pane.editor.area.selectionStart).split('\\n').length"), line + 1)
        page.click("details.functions summary")
        self.wait("document.querySelector('.function-curves').dataset.count === '3'")
        page.show(".function-curves")
        self.wait("document.querySelector('.function-curves canvas.curves').width > 50")
        self.keep("studio-functions")
        self.check_page(page)

    def test_large_deck(self):
        """A large mesh turns with fewer faces of the same shape, which the view names; at rest it has all."""
        n = 81  # grids along an edge of a square of side 1
        lines = ["SOL 103", "CEND", "BEGIN BULK", "PSHELL,1,1,.01,1", "MAT1,1,7.+10,,.3,2700."]
        lines += [f"GRID,{1 + i + n * j},,{i / (n - 1):.5f},{j / (n - 1):.5f},0." for j in range(n) for i in range(n)]
        lines += [f"CQUAD4,{1 + i + n * j},1,{1 + i + n * j},{2 + i + n * j},{2 + i + n * (j + 1)},{1 + i + n * (j + 1)}"
                  for j in range(n - 1) for i in range(n - 1)]
        self.write("large.bdf", "\n".join([*lines, "ENDDATA", ""]))
        page = self.open_studio("large.bdf")
        self.wait("studio.view?.stage")
        whole = page.run(COLORS)
        box = page.show("canvas.scene")
        x, y = box["x"] + 100, box["y"] + 100
        page.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        page.mouse("mouseMoved", x + 40, y + 10, button="left", buttons=1)
        self.wait("!document.querySelector('.thinned').hidden")
        kept, every = (int(word) for word in re.findall(r"\d+", page.run("document.querySelector('.thinned').textContent")))
        self.assertEqual(every, 2 * (n - 1)**2)
        self.assertLess(kept, 5100)
        self.assertGreater(page.run(COLORS), 3)
        page.mouse("mouseReleased", x + 40, y + 10, button="left", clickCount=1)
        self.wait("document.querySelector('.thinned').hidden")
        self.assertGreater(page.run(COLORS), whole / 3)
        # Faces, of which faces each is, and areas: flat and of a bent plate, whose area is that of its arc.
        flat, bent = page.run("""(async () => { const { make_coarse_mesh } = await import("./coarse_mesh.js");
          const { xyz, triangles } = studio.view.stage.scene.drawing, arc = xyz.slice();
          for (let k = 0; k < xyz.length; k += 3) [arc[k], arc[k + 2]] = [Math.sin(3 * xyz[k]) / 3, Math.cos(3 * xyz[k]) / 3];
          return [xyz, arc].map((p) => { const coarse = make_coarse_mesh(p, triangles, 3000);
            return { points: Array.from(p), triangles: Array.from(coarse.triangles), sources: Array.from(coarse.sources) }; }); })()""")
        for mesh, tolerance in ((flat, 1e-6), (bent, 0.01)):
            p, t = np.reshape(mesh["points"], (-1, 3)), np.reshape(mesh["triangles"], (-1, 3))
            self.assertLess(len(t), 3001)
            self.assertGreater(len(t), 1000)
            self.assertEqual(len(mesh["sources"]), len(t))
            area = np.linalg.norm(np.cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]]), axis=1).sum() / 2
            self.assertAlmostEqual(area, 1, delta=tolerance)
            np.testing.assert_allclose(p[np.unique(t)].max(axis=0), p.max(axis=0), atol=2e-2)
            np.testing.assert_allclose(p[np.unique(t)].min(axis=0), p.min(axis=0), atol=2e-2)
        self.check_page(page)

    def test_changed_outside(self):
        """An editor outside and a text that is not saved: both are kept until the user chooses."""
        self.copy_example("ex01-spinup")
        page = self.open_studio("spinup.toml")
        self.wait("document.querySelector('.text-pane').dataset.checked")
        page.click("input.command")
        page.type("set simulation.duration=3\n")
        self.wait("studio.view.pane.text.includes('duration = 3')")
        outside = self.read("spinup.toml") + "# outside\n"
        self.write("spinup.toml", outside)
        page.click("button.save")
        self.wait("document.querySelector('dialog pre.diff')")
        self.click_text("Save", "document.querySelector('dialog')")
        self.wait("document.querySelector('dialog')?.textContent.includes('has changed since it was read')")
        self.assertEqual(self.read("spinup.toml"), outside)
        self.click_text("Cancel", "document.querySelector('dialog')")
        self.wait("!document.querySelector('dialog')")
        self.assertEqual(self.read("spinup.toml"), outside)
        self.assertIn("duration = 3", page.run("studio.view.pane.text"))

    def test_script_in_names(self):
        """A deck whose name and title are HTML is shown as text."""
        script = "<img src=x onerror=document.title=1>.bdf"
        shutil.copy(os.path.join(SOURCE, "data/examples/ex05-plate/plate.bdf"), self.path(script))
        page = self.open_studio()
        self.open(script)
        self.assertEqual(page.run("document.querySelectorAll('img').length"), 0)
        self.assertIn("<img", page.run("document.querySelector('.file-title').textContent"))
        self.assertNotEqual(page.run("document.title"), "1")


if __name__ == "__main__":
    unittest.main()
