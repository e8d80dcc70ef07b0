"""The studio in light and dark colours: every text has the contrast of WCAG AA, the scene follows the theme. Bodies are
compared next to their modes; the MAC is that of NumPy."""
import unittest

import h5py
import numpy as np

from browser import WAIT_FRAMES
from contrast import FIND_FAINT
from studio_browser_test import make_plate
from studio_control_test import SYSTEM
from studio_page import PageTest

BODY = '[body]\nname = "%s"\ndeck = "%s.bdf"\nframe = "fixed"\n\n[body.modes]\nnumber = 4\n'


def make_clamped(grids):
    deck = make_plate().replace("METHOD = 1", "METHOD = 1\nSPC = 1")
    return deck.replace("ENDDATA", f"SPC1,1,123456,{grids}\nFORCE,2,45,,1.,0.,0.,1.\nENDDATA")


class Looks(PageTest):
    def set_dark(self, is_dark):
        value = "dark" if is_dark else "light"
        self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": value}])
        self.browser.run(WAIT_FRAMES)

    def check_contrast(self, view):
        for is_dark in (False, True):
            self.set_dark(is_dark)
            self.keep(f"studio-{'dark' if is_dark else 'light'}-{view}")
            with self.subTest(view=view, is_dark=is_dark):
                self.assertEqual(self.browser.run(FIND_FAINT), [])

    def test_a_faint_text_is_found(self):
        page = self.open_studio()
        page.run("document.querySelector('main').append(Object.assign(document.createElement('p'), "
                 "{ textContent: 'faint', style: 'color: #999; background: #fff' }))")
        self.assertEqual(len(page.run(FIND_FAINT)), 1)

    def test_decks_and_bodies(self):
        for name, grids in (("plate", "1,10,19,28,37"), ("corner", "1,2,10")):
            self.write(name + ".bdf", make_clamped(grids))
            self.write(name + ".toml", BODY % (name, name))
            self.bough("reduce", name + ".toml")
        page = self.open_studio()
        self.check_contrast("welcome")
        self.open("plate.bdf")
        self.wait("studio.view?.stage")
        self.check_contrast("deck")
        # Colours of the mesh, of its legend and of the marks are those of the theme.
        colors = """[...studio.view.stage.viewer.things, ...studio.view.stage.viewer.marks].filter((t) => t.triangles?.length > 0).map((t) => t.color)
          .concat(getComputedStyle(document.querySelector('.group .swatch')).backgroundColor)"""
        self.set_dark(False)
        light = page.run(colors)
        self.click_text("Light / dark")
        dark = page.run(colors)
        self.assertEqual(len(light), 4)  # plate, SPC, load, swatch
        self.assertTrue(all(a != b for a, b in zip(light, dark)), (light, dark))
        self.click_text("Light / dark")
        self.assertEqual(page.run(colors), light)
        page.run("delete document.documentElement.dataset.theme")

        self.open("plate.toml")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.choose("compare with", "corner.h5")
        self.wait("document.querySelector('.comparison').dataset.file === 'plate-comparison.h5'")
        cells = page.run("[...document.querySelectorAll('.comparison [data-panel=mac] figure text')].map((t) => t.textContent)")
        shown = np.reshape([float(text) for text in cells if "." in text], (4, 4))
        with h5py.File(self.path("plate.h5")) as a, h5py.File(self.path("corner.h5")) as b:
            p, q = (f["/modes/phi"][:, :3].reshape(-1, 4) for f in (a, b))
        mac = (p.T @ q)**2 / np.outer((p**2).sum(axis=0), (q**2).sum(axis=0))
        self.assertLess(np.diag(mac).min(), 0.9)
        np.testing.assert_allclose(shown, mac, atol=0.00501)
        self.check_contrast("comparison")
        self.click_text("✕", "document.querySelector('.comparison')")
        self.assertEqual(page.run("document.querySelector('.comparison').childElementCount"), 0)
        page.run("studio.view.pane.editor.change(studio.view.pane.text.replace('number = 4', 'number = -4\\nx = 1'))")
        self.wait("document.querySelector('.gutter .wrong')")
        self.check_contrast("wrong-text")
        self.click_text("Undo")
        self.wait("!studio.view.is_changed()")
        self.open("plate.h5")
        self.wait("document.querySelector('.chapter .modes')")
        self.check_contrast("modes")
        # Bars of effective mass: widths of 560 for all of the mass, and of the inertia about the origin.
        bars = page.run("[...document.querySelectorAll('.effective-mass rect.share')].map((r) => [r.y.baseVal.value, r.width.baseVal.value, r.textContent])")
        with h5py.File(self.path("plate.h5")) as f:
            whole = np.concatenate([np.repeat(f["/rigid/mass"][:], 3), np.diag(f["/rigid/inertia"][:])])
            share = f["/effective_mass"][:] / whole
        found = np.zeros((4, 6))
        for y, width, text in bars:
            found[int(text.split()[1].rstrip(",")) - 1, round((y - 34) / 22)] = width / 560
        np.testing.assert_allclose(found, np.where(share > 1e-4, share, 0), atol=2e-5)
        self.assertGreater(np.count_nonzero(found), 5)
        self.check_page(page)

    def test_systems(self):
        page = self.open_system(SYSTEM)
        page.click(".add-form summary")
        self.wait("document.querySelector('.add-form [name=inertia]')")
        page.click("details.block-diagram summary")
        self.wait("Number(document.querySelector('.diagram-host').dataset.blocks) > 5")
        self.check_contrast("system")
        colors = "studio.view.viewer.things.filter((t) => t.triangles?.length > 0).map((t) => t.color)"
        self.set_dark(False)
        light = page.run(colors)
        self.set_dark(True)
        self.assertTrue(all(a != b for a, b in zip(light, page.run(colors))))
        page.click("button.run")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        page.show(".result [data-panel=histories]")
        self.wait("document.querySelector('.result .chart canvas')")
        self.check_contrast("run")
        page.click("button.linearize")
        self.wait("document.querySelector('.result').dataset.ready === 'linearize'")
        self.check_contrast("poles")
        page.click("button.copy")
        self.wait("document.querySelector('dialog textarea')")
        self.check_contrast("dialog")
        self.check_page(page)


if __name__ == "__main__":
    unittest.main()
