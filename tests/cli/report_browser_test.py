"""The report page in headless Chromium: panels built, no script error, nothing loaded, zoom, picker and play by the
mouse. Pictures are kept in BOUGH_ARTEFACTS. Skipped, with a message, where chromium is not installed."""
import base64
import os
import re
import shutil
import unittest

import h5py
import numpy as np

from browser import WAIT_FRAMES, BrowserTest, find_chromium
from linear_test import PENDULUM
from report_test import write_results
from static_test import FRAME
from support import ProgramTest
from toml_text import section, table, toml

# Distinct colours in the middle of a canvas: a blank one has one.
COUNT_COLORS = """(() => { const c = document.querySelector('%s'); const s = document.createElement('canvas');
  s.width = c.width; s.height = c.height; const g = s.getContext('2d'); g.drawImage(c, 0, 0);
  const d = g.getImageData(0, 0, s.width, s.height).data; const seen = new Set();
  for (let i = 0; i < d.length; i += 4) seen.add((d[i] << 16) | (d[i + 1] << 8) | d[i + 2]); return seen.size; })()"""
COLORINGS = "[...document.querySelector('[aria-label=\"colour by\"]').options].map((o) => o.textContent)"
CHOOSE_COLORS = """(() => { const s = document.querySelector('[aria-label="colour by"]'); s.value = %d;
  s.dispatchEvent(new Event('change')); })()"""
HASH = """(() => { const d = document.querySelector('%s').toDataURL(); let h = 0;
  for (let i = 0; i < d.length; ++i) h = (h * 31 + d.charCodeAt(i)) | 0; return h; })()"""


# Two arms in space, hinge axes askew, a force that follows the lower one, a strut to ground.
ARMS = toml(
    table("body", "upper", mass=1.5, cg=[0.5, 0.0, 0.0], inertia=[0.02, 0.15, 0.15],
          nodes=[{"id": 1, "position": [1.0, 0.0, 0.0]}, {"id": 3, "position": [0.5, 0.0, 0.0]}]),
    table("body", "lower", mass=0.8, cg=[0.4, 0.0, 0.0], inertia=[1e-9, 1e-9, 1e-9],
          nodes=[{"id": 1, "position": [0.8, 0.0, 0.0]}, {"id": 2, "position": [0.4, 0.0, 0.0]}]),
    table("hinge", "shoulder", "universal", parent="ground", child="upper", parent_rotation_deg=[20.0, 30.0, 40.0],
          child_rotation_deg=[20.0, 30.0, 40.0], axis=[0.0, 0.0, 1.0], axis2=[0.0, 1.0, 0.0]),
    table("hinge", "elbow", "revolute", parent="upper", parent_node=1, parent_rotation_deg=[70.0, 10.0, 0.0],
          child="lower", child_rotation_deg=[70.0, 10.0, 0.0], axis=[0.0, 0.0, 1.0]),
    table("function", "wave", "sine", amplitude=1.0, frequency_hz=0.7, phase=0.5),
    table("force", "push", body="lower", node=1, force=[1.0, 2.0, 3.0], function="wave"),
    table("force", "twist", body="lower", node=1, moment=[0.0, 0.0, 0.1], frame="inertial"),
    table("force", "strut", "spring", body="upper", node=1, to_position=[0.5, 1.0, 1.0], stiffness=30.0,
          free_length=1.0),
    table("sensor", "upper_acceleration", "acceleration", body="upper", node=3),
    table("sensor", "lower_acceleration", "acceleration", body="lower", node=2),
    table("sensor", "upper_cg", "position", body="upper", node=3),
    table("sensor", "lower_cg", "position", body="lower", node=2),
    table("sensor", "gyro", "gyro", body="lower", node=1, rotation_deg=[0.0, 0.0, 30.0]),
    table("sensor", "bend", "hinge_angle", hinge="elbow"),
    table("sensor", "span", "distance", body="lower", node=1, target=[0.0, 0.0, 1.0]),
    table("event", "the distance to the upper fixed point passes one metre", time=0.4, action="log"),
    section("simulation", duration=2.0, output_step=0.005, gravity=[0.0, 0.0, -9.81]))


SCROLL_THROUGH = """(async () => { for (let k = 0; k * 700 < document.body.scrollHeight && k < 60; ++k) {
  scrollTo(0, 700 * k); await new Promise((r) => setTimeout(r, 100)); } scrollTo(0, 0); })()"""


@unittest.skipUnless(find_chromium(), "chromium is not installed (apt install chromium); the page is not tried in a browser")
class Page(BrowserTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.boom = ProgramTest()
        cls.boom.setUp()
        cls.addClassCleanup(cls.boom.doCleanups)
        cls.boom.copy_example("ex01-spinup")
        cls.boom.bough("reduce", "boom.toml")
        cls.boom.bough("run", "spinup.toml", "-o", "spinup.h5")

    def setUp(self):
        super().setUp()
        self.browser.renew()
        self.artefacts = os.environ.get("BOUGH_ARTEFACTS") or self.folder
        os.makedirs(self.artefacts, exist_ok=True)

    def test_narrow_windows(self):
        """Long names do not make the page wider than the window; at 1,000 x 700 light and dark have the same layout."""
        words = "_of_a_system_with_names_of_more_than_sixty_letters_each_from_another_program"
        self.write("long.toml", toml(
            table("body", "body" + words, mass=2.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "hinge" + words, "prismatic", child="body" + words, axis=[1.0, 0.0, 0.0], stiffness=[300.0], rate=[1.0]),
            table("sensor", "position" + words, "hinge_angle", hinge="hinge" + words),
            table("actuator", "motor" + words, "hinge", hinge="hinge" + words),
            section("simulation", duration=1.0, output_step=0.01), name="long" + words))
        self.bough("run", "long.toml", "-o", "long.h5", "-q")
        self.bough("linearize", "long.toml", "-o", "linear.h5", "-q")
        files = ["long.h5", "linear.h5", self.boom.path("spinup.h5"), self.boom.path("boom.h5")]
        self.bough("report", *files, "-o", "page.html")
        for width in (500, 360):
            self.browser.renew(width, 800)
            self.browser.open(self.path("page.html"))
            self.browser.run(SCROLL_THROUGH)
            self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), width)
            self.assertEqual(self.browser.list_errors(), [])
        self.browser.screenshot(os.path.join(self.artefacts, "narrow.png"))
        self.browser.renew(1000, 700)
        self.browser.open(self.path("page.html"))
        heights = []
        for theme in ("light", "dark"):
            if theme == "dark":
                self.browser.click("header button")
                self.assertEqual(self.browser.run("document.documentElement.dataset.theme"), "dark")
            self.browser.run(SCROLL_THROUGH)  # parts are laid out when they come into view
            self.browser.run(WAIT_FRAMES)
            heights.append(self.browser.run("document.documentElement.scrollHeight"))
            self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 1000)
            self.browser.screenshot(os.path.join(self.artefacts, f"page-1000-{theme}.png"))
        self.assertEqual(*heights)

    def open(self, *files):
        self.bough("report", *files, "-o", "page.html")
        self.browser.open(self.path("page.html"))

    def build_all(self):
        """Scrolls through the page so that every view is built."""
        count = self.browser.run("document.querySelectorAll('.live').length")
        for k in range(count):
            self.browser.run(f"document.querySelectorAll('.live')[{k}].scrollIntoView(), {WAIT_FRAMES}")
            self.assertTrue(self.browser.wait_for(f"document.querySelectorAll('.live')[{k}].classList.contains('built')"),
                            self.browser.run("document.documentElement.dataset.failures"))
        self.browser.run(WAIT_FRAMES)    # charts draw a frame after they were made
        return count

    def open_built(self, *files):
        """The browser at the page of these files, every view built."""
        self.open(*files)
        self.build_all()
        return self.browser

    def check_sound(self):
        self.assertEqual(self.browser.run("document.documentElement.dataset.failures || ''"), "")
        self.assertEqual(self.browser.list_errors(), [])
        self.assertEqual([u for u in self.browser.list_requests() if not u.startswith(("file:", "blob:", "data:"))], [])

    def picture(self, name, whole=False):
        self.browser.screenshot(os.path.join(self.artefacts, name + ".png"), whole)

    def copy_boom(self):
        """The boom of the spin-up, reduced, and its run."""
        shutil.copytree(self.boom.folder, self.folder, dirs_exist_ok=True)

    def test_run(self):
        self.copy_boom()
        self.open("spinup.h5", "boom.h5")
        self.picture("run-top")
        self.assertGreaterEqual(self.build_all(), 6)
        self.check_sound()
        b = self.browser
        overlay = ".plots .chart .overlay"
        box = b.show(overlay)
        self.assertGreater(b.run(COUNT_COLORS % ".plots .chart .curves"), 5)
        # A zoom by dragging: every chart of the run takes the window.
        before = b.run(HASH % "[data-view=energy] .curves")
        b.drag((box["x"] + 300, box["y"] + 100), (box["x"] + 500, box["y"] + 104))
        b.run(WAIT_FRAMES)
        caption = b.run("document.querySelector('.statistics caption').textContent")
        self.assertNotIn("whole", caption)
        b.show("[data-view=energy]")    # off the screen it waits
        self.assertTrue(b.wait_for(f"({HASH % '[data-view=energy] .curves'}) !== {before}"))
        b.show(overlay)
        # Nothing of the box is left.
        self.assertEqual(b.run("document.querySelector('.plots .overlay').getContext('2d').getImageData(400, 60, 1, 1).data[3]"), 0)
        self.picture("run-zoomed")
        # The linked cursor shows values in other charts.
        b.mouse("mouseMoved", box["x"] + 400, box["y"] + 90)
        self.assertRegex(b.run("document.querySelector('.plots .chart .value').textContent"), r"\d")
        b.show("[data-view=energy]")
        self.assertRegex(b.run("document.querySelector('[data-view=energy] .value').textContent"), r"\d")
        # Double click: whole time.
        box = b.show(overlay)
        for count in (1, 2):
            b.mouse("mousePressed", box["x"] + 200, box["y"] + 80, button="left", buttons=1, clickCount=count)
            b.mouse("mouseReleased", box["x"] + 200, box["y"] + 80, button="left", clickCount=count)
        self.assertIn("whole", b.run("document.querySelector('.statistics caption').textContent"))
        # The channel tree finds, chooses, and makes a chart.
        charts = b.run("document.querySelectorAll('.plots .chart').length")
        b.click(".picker input[type=search]")
        b.call("Input.insertText", text="reaction_mom")
        shown = b.run("[...document.querySelectorAll('.channel')].filter(c => c.offsetParent).map(c => c.dataset.path)")
        self.assertTrue(shown and all("reaction_moment" in path for path in shown), shown)
        b.click(".channel[data-path$=reaction_moment] input")
        self.assertEqual(b.run("document.querySelectorAll('.plots .chart').length"), charts + 1)
        # A spectrum.
        b.click(".plots .tools label:nth-child(2) input")
        self.assertEqual(b.run("document.querySelectorAll('.plots .chart').length"), 2 * (charts + 1))
        b.show(".plots .chart:nth-child(2)")
        self.picture("run-spectrum")
        self.check_sound()

    def test_motion(self):
        self.copy_example("ex03-two-link")
        self.bough("reduce", "link.toml")
        self.bough("run", "two-link.toml", "-o", "run.h5")
        b = self.open_built("run.h5")
        b.show(".scene")
        self.assertGreater(b.run(COUNT_COLORS % ".scene"), 20)
        clock = b.run("document.querySelector('.clock').textContent")
        view = b.run(HASH % ".scene")
        b.click(".motion .play")
        self.assertTrue(b.wait_for(f"document.querySelector('.clock').textContent !== '{clock}'"))
        self.assertTrue(b.wait_for(f"({HASH % '.scene'}) !== {view}"))
        b.click(".motion .play")
        b.show(".motion")
        self.picture("motion")
        # The camera goes with the body that it follows.
        with h5py.File(self.path("run.h5")) as f:
            time, place = f["time"][:], f["bodies/lower/position"][:]
        self.assertGreater(np.ptp(place, axis=0).max(), 0.1)
        follow = """(() => { const s = document.querySelector('[aria-label=follow]');
          s.value = [...s.options].findIndex((o) => o.textContent === '%s'); s.dispatchEvent(new Event('change')); })()"""
        b.run(follow % "lower")
        moving = "document.querySelector('[data-view=motion]').view"
        b.run(f"{moving}.set_time({time[0]})")
        before = np.array(b.run(f"{moving}.viewer.target"))
        for k in (len(time) // 3, len(time) - 1):
            b.run(f"{moving}.set_time({time[k]})")
            np.testing.assert_allclose(np.array(b.run(f"{moving}.viewer.target")) - before, place[k] - place[0], atol=1e-5)
        b.run(follow % "nothing")
        # Turning by the mouse changes the view.
        view, box = b.run(HASH % ".scene"), b.show(".scene")
        b.drag((box["x"] + 400, box["y"] + 200), (box["x"] + 480, box["y"] + 160))
        self.assertNotEqual(b.run(HASH % ".scene"), view)
        # A click in a chart takes the view to its time.
        clock = b.run("document.querySelector('.clock').textContent")
        box = b.show(".plots .chart .overlay")
        b.mouse("mousePressed", box["x"] + 150, box["y"] + 80, button="left", buttons=1, clickCount=1)
        b.mouse("mouseReleased", box["x"] + 150, box["y"] + 80, button="left", clickCount=1)
        self.assertNotEqual(b.run("document.querySelector('.clock').textContent"), clock)
        # A film of the whole run: what is saved is kept here and looked at. EBML's mark begins a WebM file (RFC 8794).
        b.run("""(() => { window.films = []; const make = URL.createObjectURL.bind(URL);
          URL.createObjectURL = (blob) => { films.push(blob); return make(blob); };
          const slider = document.querySelector('.motion .slider input'); slider.value = 0.5;
          slider.dispatchEvent(new Event('input'));
          [...document.querySelectorAll('.motion button')].find((one) => one.textContent === 'WebM').click(); })()""")
        self.assertTrue(b.wait_for("films.length === 1"))
        self.assertEqual(b.run("films[0].type"), "video/webm")
        self.assertGreater(b.run("films[0].size"), 5000)
        head = b.run("films[0].slice(0, 4).arrayBuffer().then((b) => [...new Uint8Array(b)].join(' '))")
        self.assertEqual(head, "26 69 223 163")
        self.assertEqual(b.run("Number(document.querySelector('.motion .scrub').value)"), 1000)
        self.check_sound()

    def test_arrows(self):
        """Forces drawn on each body move it: Σ forces = m (a - g), Σ moments about the centre of mass = 0."""
        self.write("arms.toml", ARMS)
        self.bough("run", "arms.toml", "-o", "run.h5")
        b = self.open_built("run.h5")
        self.check_sound()
        b.show(".motion")
        with h5py.File(self.path("run.h5")) as f:
            time, a = f["time"][:], {body: f[f"sensors/{body}_acceleration"][:] for body in ("upper", "lower")}
            cg = {body: f[f"sensors/{body}_cg"][:] for body in ("upper", "lower")}
            gravity = np.array([0, 0, -9.81])
            for k in (0, 150, 400):
                b.run(f"document.querySelector('[data-view=motion]').view.set_time({time[k]})")
                arrows = b.run("document.querySelector('[data-view=motion]').view.marks.arrows")
                found = {(one["name"], one["moment"]): (np.array(one["vector"]), np.array(one["at"])) for one in arrows}
                self.assertEqual(len(arrows), 8)    # push, twist, strut at both ends; two hinges
                ends = [np.array(one["at"]) for one in arrows if one["name"] == "strut"]
                pull = next(np.array(one["vector"]) for one in arrows if one["name"] == "strut")
                np.testing.assert_allclose(pull, np.linalg.norm(pull) * (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0]),
                                           atol=1e-5)
                elbow, push = found["elbow", False], found["push", False]
                np.testing.assert_allclose(elbow[0] + push[0], 0.8 * (a["lower"][k] - gravity), atol=1e-4)
                # The body is thin: its moment of momentum about the mass centre is told by its inertia alone, 1e-9.
                turning = (found["elbow", True][0] + found["twist", True][0] + np.cross(elbow[1] - cg["lower"][k], elbow[0])
                           + np.cross(push[1] - cg["lower"][k], push[0]))
                np.testing.assert_allclose(turning, 0, atol=1e-4)
                shoulder = found["shoulder", False]
                np.testing.assert_allclose(shoulder[0] - elbow[0] + pull, 1.5 * (a["upper"][k] - gravity), atol=1e-4)
                # The picture of the whole has the heads of the arrows, and the ends of the axes.
                tips = b.run("""(() => { const v = document.querySelector('[data-view=motion]').view, { viewer } = v, tips = v.marks.list_tips(v.get_places(), v.time, viewer.extent);
                  return [...tips, 0, 0, v.viewer.extent / 10].reduce((rows, x, i) => (i % 3 ? rows[rows.length - 1].push(x) : rows.push([x]), rows), [])
                    .map((p) => viewer.find_place(p)).map(([x, y]) => [x / viewer.canvas.clientWidth, y / viewer.canvas.clientHeight]); })()""")
                self.assertTrue(np.all((np.array(tips) > 0) & (np.array(tips) < 1)), tips)
        # Labels of events are above the curves, none is cut.
        labels = b.run("""(() => { const { charts } = document.querySelector('.live[data-view=history]').view, chart = charts[0], g = chart.canvas.getContext('2d');
          return [chart.frame.top, chart.place_mark_labels(g).map(([text, x]) => [text, x + g.measureText(text).width <= chart.frame.left + chart.frame.width])]; })()""")
        with h5py.File(self.path("run.h5")) as f:
            self.assertGreater(len(f["events/time"]), 0)
        self.assertGreaterEqual(labels[0], 23)
        self.assertTrue(labels[1] and all(fits for _, fits in labels[1]), labels)
        b.show(".plots .chart")
        self.picture("event-labels")
        b.show(".motion")
        legend = b.run("document.querySelector('.motion').textContent")
        for word in ("an arrow of length 1 [L] is", "Moment (two heads)", "shoulder", "sensors: "):
            self.assertIn(word, legend)
        self.picture("motion-arrows")
        # Toggles and the scale.
        whole = b.run(HASH % ".scene")
        meaning = "document.querySelector('[data-view=motion]').view.marks"
        text = b.run(meaning + ".meaning.textContent")
        for name, left in (("reactions", 4), ("applied", 0), ("sensors", 0)):
            before = b.run(HASH % ".scene")
            b.run(f"[...document.querySelectorAll('.motion label')].find(l => l.textContent.trim() === '{name}').click()")
            self.assertEqual(b.run(meaning + ".arrows.length"), left)
            self.assertNotEqual(b.run(HASH % ".scene"), before)
        for name in ("reactions", "applied", "sensors"):
            b.run(f"[...document.querySelectorAll('.motion label')].find(l => l.textContent.trim() === '{name}').click()")
        self.assertEqual(b.run(HASH % ".scene"), whole)
        b.run("""(() => { const s = document.querySelector('.motion input[aria-label="arrows ×"]'); s.value = 1;
          s.dispatchEvent(new Event('input')); })()""")
        self.assertNotEqual(b.run(HASH % ".scene"), whole)
        self.assertNotEqual(b.run(meaning + ".meaning.textContent"), text)
        self.check_sound()

    def test_modes(self):
        self.copy_example("ex05-plate")
        self.bough("reduce", "plate.toml")
        b = self.open_built("plate.h5")
        b.show(".modes")
        self.assertGreater(b.run(COUNT_COLORS % ".scene"), 50)
        first = b.run(HASH % ".scene")
        self.picture("modes")
        b.click(".modes .tools button[title='Next mode']")
        self.assertEqual(b.run("document.querySelector('.mode-picker').value"), "1")
        second = b.run(HASH % ".scene")
        self.assertNotEqual(second, first)
        b.click(".modes .play")
        self.assertTrue(b.wait_for(f"({HASH % '.scene'}) !== {second}"))
        b.click(".modes .play")
        b.run(WAIT_FRAMES)
        # A body file has no energies of its elements; a modes file may.
        self.assertEqual(b.run(COLORINGS), ["displacement", "nothing"])
        coloured = b.run(HASH % ".scene")
        b.run(CHOOSE_COLORS % 1)
        self.assertNotEqual(b.run(HASH % ".scene"), coloured)
        b.run(CHOOSE_COLORS % 0)
        self.assertEqual(b.run(HASH % ".scene"), coloured)
        # Dark colours.
        b.click("header button")
        b.run(WAIT_FRAMES)
        b.show(".modes")
        self.picture("modes-dark")
        self.picture("modes-dark-page", whole=True)
        self.check_sound()

    def slide(self, name, value):
        self.browser.run(f"""(() => {{ const s = document.querySelector('input[aria-label="{name}"]'); s.value = {value};
          s.dispatchEvent(new Event('input')); }})()""")

    def catch_files(self):
        """Keeps files that the page saves from now on in `saved`."""
        self.browser.run("""(() => { window.saved = []; const make = URL.createObjectURL.bind(URL);
          URL.createObjectURL = (blob) => { saved.push(blob); return make(blob); }; })()""")

    def check_picture(self, button):
        """PNG's eight bytes, and as many pixels as the canvas."""
        b = self.browser
        count = b.run("saved.length")
        b.run(f"[...document.querySelectorAll('{button}')].find((one) => one.textContent === 'PNG').click()")
        self.assertTrue(b.wait_for(f"saved.length === {count + 1}"))
        head = b.run(f"saved[{count}].slice(0, 24).arrayBuffer().then((a) => [...new Uint8Array(a)])")
        self.assertEqual(bytes(head[:8]), b"\x89PNG\r\n\x1a\n")
        return int.from_bytes(bytes(head[16:20]), "big"), int.from_bytes(bytes(head[20:24]), "big")

    def test_controls_of_the_views(self):
        """Amplitude, speed, undeformed overlay of modes; scrub, frames, deformation of a run; PNG of both."""
        self.copy_boom()
        b = self.open_built("spinup.h5", "boom.h5")
        self.catch_files()
        view = "document.querySelector('[data-view=modes]').view"
        b.show(".modes")
        deflect = f"Math.max(...{view}.drawing.size)"
        size = b.run(f"{view}.box.get_diagonal()")
        for share in (0.1, 0.3):
            self.slide("amplitude", share)
            self.assertAlmostEqual(b.run(deflect), share * size, delta=1e-4 * size)   # at the end of its swing
        with_overlay = b.run(HASH % ".modes .scene")
        b.click(".modes input[type=checkbox]")
        self.assertNotEqual(b.run(HASH % ".modes .scene"), with_overlay)
        # At one swing a second the phase goes on by 2 pi in a second of frames.
        self.slide("speed", 1)
        self.assertEqual(b.run(f"{view}.turns"), 1)
        self.assertEqual(self.check_picture(".modes button"), tuple(b.run("(({width, height}) => [width, height])(document.querySelector('.modes .scene'))")))
        view = "document.querySelector('[data-view=motion]').view"
        b.show(".motion")
        with h5py.File(self.path("spinup.h5")) as f:
            time, eta = f["time"][:], f["bodies/boom/eta"][:]
        # A real mouse on the scrubber's middle: half of the time.
        box = b.show(".motion .scrub")
        at = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        b.mouse("mousePressed", *at, button="left", buttons=1, clickCount=1)
        b.mouse("mouseReleased", *at, button="left", clickCount=1)
        self.assertAlmostEqual(b.run(f"{view}.time"), time[-1] / 2, delta=0.02 * time[-1])
        self.assertRegex(b.run("document.querySelector('.clock').textContent"), r"t = \d")
        b.run(f"{view}.set_time({time[700]})")
        largest = f"Math.max(...{view}.bodies[0].drawing.size)"
        once = b.run(largest)
        self.assertGreater(np.abs(eta[700]).max(), 0)
        self.slide("deformation ×", 1)    # decades
        self.assertAlmostEqual(b.run(largest), 10 * once, delta=1e-3 * once)
        framed = b.run(HASH % ".motion .scene")
        b.run("[...document.querySelectorAll('.motion label')].find(l => l.textContent.trim() === 'frames').click()")
        self.assertNotEqual(b.run(HASH % ".motion .scene"), framed)
        self.assertEqual(self.check_picture(".motion button"), tuple(b.run("(({width, height}) => [width, height])(document.querySelector('.motion .scene'))")))
        self.check_sound()

    def test_strain_energy(self):
        """The colour of a plate is that of its energy: five stops of viridis, brightest where the most is."""
        self.copy_example("ex05-plate")
        self.bough("modes", "plate.bdf", "-n", "3", "--ese", "-o", "modes.h5")
        b = self.open_built("modes.h5")
        b.show(".modes")
        self.assertEqual(b.run(COLORINGS), ["displacement", "nothing", "strain energy", "strain energy density"])
        shown = set()
        for way in range(4):
            b.run(CHOOSE_COLORS % way)
            shown.add(b.run(HASH % ".scene"))
            self.assertEqual(b.run("!document.querySelector('.modes .color-bar').hidden"), way != 1)
        self.assertGreaterEqual(len(shown), 3)  # of equal elements both energies look the same
        self.picture("modes-energy")
        with h5py.File(self.path("modes.h5")) as f:
            energy = f["energies/strain"][:, 0] / f["energies/total_strain"][0]
        self.assertIn(f"{100 * energy.max():.4g}", b.run(f"({CHOOSE_COLORS % 2}, document.querySelector('.modes .color-bar').textContent)"))
        levels = np.array(b.run("[...document.querySelector('[data-view=modes]').view.energy.levels]"))
        np.testing.assert_allclose(np.sort(levels), np.sort(energy / energy.max()), atol=1e-4)
        self.check_sound()

    def test_strain_energy_of_a_moving_system(self):
        """Colours of a run are those of the body file's energies at its modal coordinates, over the largest of the run."""
        self.copy_example("ex05-plate")
        self.bough("reduce", "plate.bdf", "--modes", "4", "--strain-energy", "-o", "plate.h5")
        self.write("swing.toml", toml(
            table("body", "plate", file="plate.h5"),
            table("hinge", "pin", "revolute", child="plate", axis=[0.0, 1.0, 0.0], rate=2.0),
            section("simulation", duration=0.2, output_step=0.005, gravity=[0.0, 0.0, -9.81])))
        self.bough("run", "swing.toml", "-o", "run.h5")
        b = self.open_built("run.h5")
        b.show(".motion")
        self.assertEqual(b.run(COLORINGS), ["body", "displacement", "strain energy", "strain energy density"])
        with h5py.File(self.path("run.h5")) as f:
            eta, time = f["bodies/plate/eta"][()], f["time"][()]
        with h5py.File(self.path("plate.h5")) as f:
            packed = f["strain_energy/matrix"][()]
        i, j = np.triu_indices(eta.shape[1])
        energies = (eta[:, i] * eta[:, j] * np.where(i == j, 0.5, 1)) @ packed.T
        shown = set()
        for way in range(4):
            b.run(CHOOSE_COLORS % way)
            b.run(f"document.querySelector('[data-view=motion]').view.set_time({time[20]})")
            shown.add(b.run(HASH % ".scene"))
            self.assertEqual(b.run("!document.querySelector('.motion .color-bar').hidden"), way > 0)
        self.assertGreaterEqual(len(shown), 3)
        b.run(CHOOSE_COLORS % 2)
        view = "document.querySelector('[data-view=motion]').view"
        most = b.run(f"{view}.most[0]")
        self.assertAlmostEqual(most / energies.max(), 1, delta=0.05)  # of a hundred instants
        for k in (3, 20, 40):
            found = np.array(b.run(f"[...{view}.get_levels({view}.bodies[0].drawing, {eta[k].tolist()})]")) * most
            np.testing.assert_allclose(np.sort(found), np.sort(energies[k]), atol=1e-3 * energies[k].max())
        self.picture("motion-energy")
        self.check_sound()

    def test_static_solutions(self):
        self.write("frame.bdf", FRAME)
        self.bough("static", "frame.bdf", "-o", "frame.h5")
        b = self.open_built("frame.h5")
        b.show(".modes")
        self.assertGreater(b.run(COUNT_COLORS % ".scene"), 5)
        first = b.run(HASH % ".scene")
        self.assertIn("Subcase 1: TIP FORCE", b.run("document.querySelector('.modes .note').textContent"))
        b.click(".modes .tools button[title='Next mode']")
        self.assertNotEqual(b.run(HASH % ".scene"), first)
        self.check_sound()
        self.picture("static", whole=True)

    def test_linear_and_tables(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "-o", "linear.h5")
        self.copy_boom()
        self.bough("reduce", "boom.bdf", "--modes", "2", "-o", "small.h5")
        self.bough("compare", "boom.h5", "small.h5", "-o", "comparison.h5")
        self.open("linear.h5", "comparison.h5")
        self.assertEqual(self.build_all(), 2)
        self.browser.show("[data-view=bode]")
        self.assertGreater(self.browser.run(COUNT_COLORS % "[data-view=bode] .curves"), 5)
        self.check_sound()
        self.picture("linear", whole=True)

    def test_zoom_of_a_long_run(self):
        """20,000 samples of 10 channels: each zoom is drawn with its statistics; how long it took is printed only."""
        write_results(self.path("long.h5"), 20000, [f"s{k}" for k in range(10)])
        b = self.open_built("long.h5")
        # All 10, each in a chart of its own, then at once in one chart.
        b.run("(() => { for (const box of document.querySelectorAll('.channel input')) if (!box.checked) box.click(); })()")
        for by_dims, charts in [(0, 10), (1, 1)]:
            b.run("(() => { const s = document.querySelector('.plots select');"
                  f" s.value = {by_dims}; s.dispatchEvent(new Event('change')); }})()")
            b.run(WAIT_FRAMES)
            self.assertEqual(b.run("document.querySelectorAll('.plots .chart').length"), charts)
            self.assertEqual(b.run("document.querySelectorAll('.plots .chart .legend button[aria-pressed]').length"), 10)
            box = b.show(".plots .chart .overlay")
            times, windows = [], set()
            for _ in range(3):
                b.drag((box["x"] + 200, box["y"] + 100), (box["x"] + 600, box["y"] + 102))
                times.append(float(b.run("document.documentElement.dataset.zoomMs")))
                windows.add(b.run("document.querySelector('.statistics caption').textContent"))
            print(f"ms of a zoom, 10 curves of 20,000 samples in {charts} charts:", times)
            self.assertEqual(len(windows), 3, windows)
            self.assertGreater(min(times), 0)
            b.click(".plots .tools button[title^='Reset']")
        self.picture("long")
        self.check_sound()

    def test_a_thinned_run(self):
        """Samples that are left out: peaks stay in the curves, the table is of all samples, no spectrum is drawn from the
        others, and the CSV has samples of the file at their times."""
        write_results(self.path("long.h5"), 120000, [f"s{k}" for k in range(10)])
        with h5py.File(self.path("long.h5"), "r+") as f:
            f["sensors/s0"][77777] = 9.0
            t, y = f["time"][:], f["sensors/s0"][:]
        b = self.open_built("long.h5")
        drawn = b.run("Array.from(document.querySelector('.live[data-view=history]').view.charts[0].series[0].y)")
        self.assertAlmostEqual(max(drawn), 9, places=5)
        cells = b.run("[...document.querySelectorAll('.statistics tbody tr')][0].textContent && "
                      "[...document.querySelector('.statistics tbody tr').cells].map((c) => c.textContent.replace('\u2212', '-'))")
        np.testing.assert_allclose([float(c) for c in cells[2:]], [y.min(), y.max(), np.ptp(y), y.mean(), np.sqrt((y**2).mean()), len(y)],
                                   rtol=1e-5, atol=1e-6)
        self.assertIn("from all samples", b.run("document.querySelector('.statistics caption').textContent"))
        b.click(".plots .tools label:nth-child(2) input")
        notes = b.run("[...document.querySelectorAll('.no-spectrum')].map((p) => p.textContent)")
        self.assertEqual(len(notes), 10)
        self.assertIn("--sensor s0 --spectrum", notes[0])
        self.assertFalse(b.run("[...document.querySelectorAll('.plots h4')].some((h) => h.textContent.startsWith('spectrum'))"))
        b.run("document.querySelector('.no-spectrum').scrollIntoView({ block: 'center' })")
        self.picture("thinned")
        b.run("(() => { window.saved = []; const make = URL.createObjectURL.bind(URL);"
              " URL.createObjectURL = (blob) => { saved.push(blob); return make(blob); }; })()")
        b.click(".plots .tools button[title^='Save the samples']")
        lines = b.run("saved[0].text()").splitlines()
        self.assertEqual(lines[0].split(",")[:2], ["time", "s0 [L]"] if "[" in lines[0] else ["time", "s0"])
        rows = [line.split(",") for line in lines[1:]]
        times, values = np.array([[float(r[0]), float(r[1])] for r in rows if r[1]]).T
        at = np.rint(times / t[1]).astype(int)
        np.testing.assert_allclose(times, t[at], rtol=1e-12)
        np.testing.assert_allclose(values, y[at], atol=1e-6)
        self.assertIn(77777, at)
        # A window: extremes of its samples, no means.
        box = b.show(".plots .chart .overlay")
        b.drag((box["x"] + 200, box["y"] + 100), (box["x"] + 600, box["y"] + 102))
        self.assertIn("need samples that the page does not have", b.run("document.querySelector('.statistics caption').textContent"))
        self.check_sound()

    def test_a_batch_of_changes_counts_by_its_last(self):
        """A chart left the screen and came back in one batch of its observer: it is on the screen, and a zoom draws it."""
        self.browser.call("Page.addScriptToEvaluateOnNewDocument", source="""(() => { const Real = window.IntersectionObserver;
            const leave = (e) => e.target.className === "stage" && e.isIntersecting
              ? [{ target: e.target, isIntersecting: false }, e] : [e];
            window.IntersectionObserver = class extends Real {
              constructor(act, options) { super((entries, self) => act(entries.flatMap(leave), self), options); } }; })()""")
        write_results(self.path("run.h5"), 200, ["s0"])
        b = self.open_built("run.h5")
        box = b.show(".plots .chart .overlay")
        b.run(WAIT_FRAMES)
        before = b.run(HASH % ".plots .chart .curves")
        b.drag((box["x"] + 200, box["y"] + 100), (box["x"] + 600, box["y"] + 102))
        b.run(WAIT_FRAMES)
        self.assertNotEqual(b.run(HASH % ".plots .chart .curves"), before)
        self.check_sound()

    def test_print(self):
        """On paper every view is there, light, and charts are as wide as a sheet; after it all is as it was."""
        self.copy_boom()
        self.open("spinup.h5", "boom.h5")
        b = self.browser
        b.click("header button")
        width = "document.querySelector('.plots .curves').clientWidth"
        b.show(".plots .chart")
        # A canvas is 300 wide until it is drawn, a frame after it was made.
        self.assertTrue(b.wait_for(f"(document.querySelector('.plots .curves') ? {width} : 0) > 700"))
        before = b.run(width)
        b.run("dispatchEvent(new Event('beforeprint'))")
        self.assertEqual(b.run("document.querySelectorAll('.live.built').length"), b.run("document.querySelectorAll('.live').length"))
        self.assertEqual((b.run(width), b.run("document.documentElement.dataset.theme")), (680, "light"))
        b.run("dispatchEvent(new Event('afterprint'))")
        self.assertTrue(b.wait_for(f"{width} !== 680"))
        self.assertEqual((b.run(width), b.run("document.documentElement.dataset.theme")), (before, "dark"))
        pdf = base64.b64decode(b.call("Page.printToPDF")["data"])
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertGreater(len(pdf), 20000)
        # The moving picture is on the first page, below the numbers; on a page without them there were eight pages.
        self.assertLess(len(re.findall(rb"/Type\s*/Page\b(?!s)", pdf)), 8)
        with open(os.path.join(self.artefacts, "print.pdf"), "wb") as out:
            out.write(pdf)
        self.check_sound()

    def test_without_script(self):
        """The page without scripts: pictures and tables are there."""
        self.copy_boom()
        self.browser.call("Emulation.setScriptExecutionDisabled", value=True)
        self.bough("report", "spinup.h5", "boom.h5", "-o", "page.html")
        self.browser.call("Page.navigate", url="file://" + self.path("page.html"))
        self.assertTrue(self.browser.wait_for("document.querySelectorAll('svg').length >= 8 && document.readyState === 'complete'"))
        self.assertFalse(self.browser.run("Boolean(document.documentElement.dataset.ready)"))
        self.assertGreater(self.browser.run("document.querySelector('.live svg').getBoundingClientRect().height"), 100)
        self.picture("without-script", whole=True)


if __name__ == "__main__":
    unittest.main()
