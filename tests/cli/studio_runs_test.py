"""Runs in the studio, one after the other: earlier ones stay as outlines and curves, the displacement of a node that is
clicked is pinned, a second command waits for the first."""
import unittest

import h5py
import numpy as np
from scipy.spatial.transform import Rotation

from studio_control_test import SYSTEM
from studio_page import PageTest
from toml_text import section, table, toml

SPIN = toml(
    section("parameters", rate=4.0),
    table("body", "boom", file="boom.h5"),
    table("hinge", "spin", "revolute", child="boom", axis=[0.0, 0.0, 1.0], motion="angle"),
    table("function", "angle", "spinup", rate="$rate", duration=15.0),
    table("sensor", "tip", "position", body="boom", node=41),
    section("simulation", duration=1.0, output_step=0.01))
# Place of node 41 on the screen; lines of the scene in the colour of earlier runs, and their last point.
TIP = """(() => { const { viewer } = studio.view, t = viewer.things.find((t) => t.ids?.includes(41)), k = t.ids.indexOf(41);
  const [x, y] = viewer.find_place(t.points.subarray(3 * k, 3 * k + 3)), b = viewer.canvas.getBoundingClientRect(); return [b.x + x, b.y + y]; })()"""
GHOST = """(() => { const color = getComputedStyle(document.documentElement).getPropertyValue('--ghost').trim();
  const found = studio.view.viewer.things.filter((t) => t.color === color && t.points.length > 90);
  return found.map((t) => Array.from(t.points.slice(-3))); })()"""
CURVES = """(() => { const chart = studio.view.motion.run.link.charts.find((c) => c.title === 'displacement of node 41 of boom');
  return chart?.series.map((s) => ({ name: s.name, y: Array.from(s.y) })) ?? null; })()"""


class Runs(PageTest):
    def run_with(self, rate):
        page = self.browser
        page.run("document.querySelector('[aria-label=\"parameter rate\"]').select()")
        page.type(f"{rate}\n")
        page.run("delete document.querySelector('.result').dataset.ready")
        page.click("button.run")
        self.wait("document.querySelector('.result').dataset.ready === 'true' && !studio.view.is_following")
        # The scene is linear in the modes: r = p + R (x + φ η); the sensor has the foreshortening too.
        with h5py.File(self.path("boom.h5")) as f:
            at = list(f["/nodes/id"][:]).index(41)
            x, phi = f["/nodes/xyz"][at], f["/modes/phi"][list(f["/grids/id"][:]).index(41), :3]
        with h5py.File(self.path("spin.h5")) as f:
            p, q, eta, sensor = (f[path][:] for path in ("/bodies/boom/position", "/bodies/boom/quaternion", "/bodies/boom/eta", "/sensors/tip"))
        R = Rotation.from_quat(q[:, [1, 2, 3, 0]]).as_matrix()
        tip = p + np.einsum("tij,tj->ti", R, x + eta @ phi.T)
        np.testing.assert_allclose(tip, sensor, atol=0.02 * np.abs(sensor - sensor[0]).max())
        return tip

    def test_earlier_runs_stay(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        self.write("spin.toml", SPIN)
        page = self.open_studio("spin.toml")
        self.wait("document.querySelector('.scene-host').dataset.samples")
        first = self.run_with(4)
        self.assertEqual(page.run(GHOST), [])
        page.show("canvas.scene")
        self.click_at(*page.run(TIP))
        self.wait("document.querySelector('button.pin:not([hidden])')?.textContent === 'pin node 41 of boom'")
        page.click("button.pin")
        curves = page.run(CURVES)
        size = np.abs(first - first[0]).max()
        for c, curve in enumerate(curves):
            np.testing.assert_allclose(curve["y"], first[:, c] - first[0, c], atol=2e-4 * size)    # shapes of 16 bits
        # The pin stays, with the curves of both runs; the scene has both at the time of the slider.
        second = self.run_with(8)
        self.assertGreater(np.abs(second - first).max(), 0.5 * size)
        curves = page.run(CURVES)
        self.assertEqual([curve["name"] for curve in curves], [a + b for b in ("", ", run before") for a in "xyz"])
        for k, tip in enumerate((second, first)):
            np.testing.assert_allclose(np.transpose([curve["y"] for curve in curves[3 * k:3 * k + 3]]), tip - tip[0], atol=2e-4 * size)
        page.run("studio.view.motion.set_time(1)")
        # The label of the node that was clicked is that of this run.
        shown = float(page.run("document.querySelector('.viewer .tip').textContent").split("displacement ")[1].replace("−", "-"))
        self.assertGreater(shown, 0)
        (ghost,) = page.run(GHOST)
        np.testing.assert_allclose(ghost, first[-1], atol=2e-4 * size + 1e-5 * np.abs(first).max())
        self.keep("studio-ghost")
        self.click_label("run before")
        self.assertEqual(page.run(GHOST), [])
        # Curves of all runs in the same charts.
        self.run_with(6)
        self.assertIn("This run and the 2 runs before", page.run("document.querySelector('details.earlier summary').textContent"))
        page.click("details.earlier summary")
        self.wait("document.querySelector('details.earlier .chart')")
        legend = page.run("document.querySelector('details.earlier .legend').textContent")
        for name in ("this run", "run before", "2 runs before"):
            self.assertIn(name, legend)
        self.click_text("✕ unpin")
        self.assertIsNone(page.run(CURVES))
        self.check_page(page)

    def click_label(self, text):
        self.browser.run(f"[...document.querySelectorAll('.motion label')].find((l) => l.textContent.trim() === '{text}').setAttribute('data-click', 'here')")
        self.browser.click("[data-click=here]")

    def test_one_command_at_a_time(self):
        """While a run is followed its buttons are off; a run that is stopped on request shows no failure."""
        self.write("sliders.toml", SYSTEM.replace("duration = 2.0", "duration = 1e5"))
        page = self.open_studio("sliders.toml")
        self.wait("document.querySelector('.text-pane')?.dataset.checked === '0'")
        page.click("button.run")
        self.wait("document.querySelector('.progress-line').textContent.includes('%')")
        self.assertTrue(page.run("[...document.querySelectorAll('.actions button')].slice(0, 5).every((b) => b.disabled)"))
        self.click_text("Stop")
        self.wait("document.querySelector('.result').dataset.ready === 'true' && !studio.view.is_following")
        self.assertFalse(page.run("[...document.querySelectorAll('.actions button')].some((b) => b.disabled)"))
        self.assertFalse(page.run("document.querySelector('.progress details').open"))
        # The bar stays where it was, and the scene at the last sample.
        self.assertLess(page.run("document.querySelector('.progress progress').value"), 100)
        self.assertTrue(page.run("document.querySelector('.progress-line').textContent.startsWith('stopped')"))
        self.assertGreater(page.run("studio.view.motion.last"), 0)
        self.assertEqual(page.run("studio.view.motion.time"), page.run("studio.view.motion.last"))


if __name__ == "__main__":
    unittest.main()
