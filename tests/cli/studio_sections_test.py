"""Bars, beams, rods and tubes of a deck with their sections, by corners that are known: PBARL and PBEAML by hand, the
plain shapes that stand for PBAR, PBEAM and PROD by their A, I1 and I2. Groups are hidden and shown by the mouse."""
import math
import unittest

import numpy as np

from studio_page import PageTest

# Points of the solid of an element, in threes.
SOLID = "Array.from(((s) => s.sections.make_solids([s.elements.id.indexOf(%d)]).points)(studio.view.stage.scene))"
# Where a place in space is on the screen.
PLACE = """(() => { const { viewer } = studio.view.stage, p = viewer.find_place(%s), b = viewer.canvas.getBoundingClientRect();
  return [b.x + p[0], b.y + p[1]]; })()"""
SOLIDS = "studio.view.stage.viewer.things.filter((t) => t.is_detail).length"

DECK = """SOL 103
CEND
BEGIN BULK
MAT1,1,7.+10,,.3,2700.
GRID,1,,0.,0.,0.
GRID,2,,2.,0.,0.
GRID,3,,0.,3.,0.
GRID,4,,2.,3.,0.
GRID,5,,0.,6.,0.
GRID,6,,2.,6.,0.
GRID,7,,0.,6.,5.
$ Width .2 and height .4, height along z; both ends .5 above the grids
PBARL,11,1,,BAR
,.2,.4
CBAR,1,11,1,2,0.,0.,1.
,456,,0.,0.,.5,0.,0.,.5
$ A tee whose G0 is below: it is upside down, and half as large at B
PBEAML,12,1,,T
,.3,.4,.04,.02,,YES,1.,.15
,.2,.02,.01
CBEAM,2,12,3,4,99
GRID,99,,0.,3.,-8.
$ The rectangle .3 x .1 by its A, I1 and I2, height along y; offset in element axes
PBAR,13,1,.03,2.25-4,2.5-5,8.-5
CBAR,3,13,5,6,0.,1.,0.,GOO
,,,0.,.2,0.,0.,.2,0.
$ pi .1^2
PROD,14,1,.0314159
CROD,4,14,5,7
PTUBE,15,1,.2,.05
CTUBE,5,15,6,7
ENDDATA
"""


def sort(points):
    """Rows without repetition, in one order."""
    return np.unique(np.round(points, 5), axis=0)


class Sections(PageTest):
    def show(self, deck=DECK):
        self.write("frame.bdf", deck)
        page = self.open_studio("frame.bdf")
        self.wait("studio.view?.stage")
        return page

    def get_points(self, element):
        return np.reshape(self.browser.run(SOLID % element), (-1, 3))

    def check_points(self, element, expected):
        np.testing.assert_allclose(sort(self.get_points(element)), sort(np.array(expected)), atol=2e-5)

    def test_corners(self):
        page = self.show()
        self.check_points(1, [(x, y, 0.5 + z) for x in (0, 2) for y in (-0.1, 0.1) for z in (-0.2, 0.2)])
        # The axis of a beam is at the shear centre: of a tee where the middle lines of web and flange meet.
        tee = []
        for x, scale in ((0, 1), (2, 0.5)):
            top, bottom, web, flange = 0.02 * scale, -0.38 * scale, 0.01 * scale, 0.15 * scale
            tee += [(x, 3 + y, -z) for y in (-flange, flange) for z in (-top, top)]
            tee += [(x, 3 + y, -z) for y in (-web, web) for z in (-top, bottom)]
        self.check_points(2, tee)
        self.check_points(3, [(x, 6.2 + y, z) for x in (0, 2) for y in (-0.15, 0.15) for z in (-0.05, 0.05)])
        rod = self.get_points(4)
        self.assertEqual(sorted(set(np.round(rod[:, 2], 6))), [0, 5])
        np.testing.assert_allclose(np.hypot(rod[:, 0], rod[:, 1] - 6), 0.1, atol=1e-6)
        along = np.array([-2, 0, 5]) / math.sqrt(29)
        tube = self.get_points(5) - [2, 6, 0]
        radius = np.linalg.norm(tube - np.outer(tube @ along, along), axis=1)
        self.assertEqual(sorted(set(np.round(radius, 5))), [0.05, 0.1])
        # All of them are drawn, one thing a group.
        self.assertEqual(page.run(SOLIDS), 5)
        self.assertEqual(page.run("studio.view.stage.scene.sections.pins.map((p) => [p.element, p.place[0], p.place[2]])"), [[1, 0.2, 0.5]])
        text = page.run("document.querySelector('.side .groups').textContent")
        self.assertIn("PBAR A 0.03, I1 0.000225, I2 2.5e-05, J 8e-05, drawn as rectangle 0.3 x 0.1, radii of gyration of A, I1, I2", text)
        self.assertIn("drawn as circle of diameter 0.2, of A", text)
        self.keep("studio-sections")
        # Lines only.
        page.run("[...document.querySelectorAll('.side label')].find((l) => l.textContent.includes('bar sections')).setAttribute('data-click', 'bars')")
        page.click("[data-click=bars]")
        self.wait(f"{SOLIDS} === 0")
        self.keep("studio-lines")
        self.check_page(page)

    def test_outside_and_inside(self):
        """Normals of the triangles point out: the volume of the closed surface is area times length."""
        page = self.show()
        for element, volume in ((1, 0.2 * 0.4 * 2), (3, 0.3 * 0.1 * 2), (4, 8 * math.sin(math.pi / 8) * 0.01 * 5)):
            found = page.run(f"""(() => {{ const s = studio.view.stage.scene, {{ points: p, triangles: t }} = s.sections.make_solids([s.elements.id.indexOf({element})]);
              let sum = 0;
              for (let i = 0; i < t.length; i += 3) {{
                const [a, b, c] = [0, 1, 2].map((k) => Array.from(p.subarray(3 * t[i + k], 3 * t[i + k] + 3)));
                sum += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
              }}
              return sum; }})()""")
            self.assertAlmostEqual(found, volume, delta=1e-4 * volume)

    def test_many_are_thinned(self):
        """1,199 tubes of 128 faces: every other one has its section, which the page names."""
        lines = ["SOL 103", "CEND", "BEGIN BULK", "MAT1,1,7.+10,,.3,2700.", "PTUBE,1,1,.02,.002"]
        lines += [f"GRID,{k},,{k % 40:.1f},{k // 40:.1f},0." for k in range(1201)]
        lines += [f"CTUBE,{k},1,{k - 1},{k}" for k in range(2, 1201)]
        page = self.show("\n".join([*lines, "ENDDATA", ""]))
        every, count = page.run("[studio.view.stage.scene.sections.every, studio.view.stage.viewer.things.find((t) => t.is_detail).triangles.length / 3]")
        self.assertEqual((every, count), (2, 600 * 128))
        self.assertIn(f"sections: one of {every} elements has its section", page.run("document.querySelector('.side').textContent"))

    def count_hidden(self):
        return self.browser.run("studio.view.stage.scene.hidden.size")

    def test_hide_and_show(self):
        """A click names the element in its section; its group is hidden by key and menu, from the list and back."""
        page = self.show()
        page.run("studio.view.stage.viewer.yaw = -1.57, studio.view.stage.viewer.pitch = 0.6, studio.view.stage.draw()")
        box = page.show("canvas.scene")
        self.assertGreater(box["width"], 100)
        place = page.run(PLACE % [1.0, 0.0, 0.7])
        self.click_at(*place)
        self.wait("document.querySelector('.side .picked').textContent.startsWith('CBAR 1 ')")
        self.assertIn("CBAR 1, property 11, PBARL 11: BAR 0.2 0.4", page.run("document.querySelector('.viewer .tip').textContent"))
        page.run("document.querySelector('canvas.scene').focus()")
        page.type("h")
        self.wait("studio.view.stage.scene.hidden.has('CBAR of property 11')")
        self.assertEqual((self.count_hidden(), page.run(SOLIDS)), (1, 4))
        self.assertFalse(page.run("document.querySelector('.groups .group input').checked"))
        page.type("a")
        self.wait("studio.view.stage.scene.hidden.size === 0")
        # The menu of a right click; the element there is the tee.
        place = page.run(PLACE % [1.0, 3.0, 0.15])
        page.mouse("mouseMoved", *place)
        page.mouse("mousePressed", *place, button="right", buttons=2, clickCount=1)
        page.mouse("mouseReleased", *place, button="right", clickCount=1)
        self.wait("document.querySelector('.menu') && !document.querySelector('.menu').hidden")
        self.assertIn("CBEAM 2, property 12, PBEAML 12: T 0.3 0.4 0.04 0.02", page.run("document.querySelector('.menu').textContent"))
        self.keep("studio-menu")
        self.click_text("Show CBEAM of property 12 only", "document.querySelector('.menu')")
        self.wait("studio.view.stage.scene.hidden.size === 4")
        self.assertTrue(page.run("document.querySelector('.menu').hidden"))
        # Keys of the menu: the last entry shows all.
        page.press("ContextMenu")
        self.wait("!document.querySelector('.menu').hidden")
        page.press("ArrowUp")
        page.type("\n")
        self.wait("studio.view.stage.scene.hidden.size === 0")
        page.press("ContextMenu")
        self.wait("!document.querySelector('.menu').hidden")
        page.press("Escape")
        self.wait("document.querySelector('.menu').hidden && document.activeElement.matches('canvas.scene')")
        # The list of groups.
        self.click_text("only", "document.querySelector('.groups')")
        self.wait("studio.view.stage.scene.hidden.size === 4")
        page.click(".groups .group:nth-child(2) input")
        self.wait("studio.view.stage.scene.hidden.size === 3")
        self.check_page(page)


if __name__ == "__main__":
    unittest.main()
