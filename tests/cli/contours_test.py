"""Contours of static solutions on the report page: columns of the page against the static file, means at nodes against
NumPy, and in headless Chromium by the mouse. Those are skipped, with a message, where chromium is not installed."""
import base64
import unittest

import h5py
import numpy as np

from browser import WAIT_FRAMES, BrowserTest, find_chromium
from report_test import PageReader, unpack
from studio_page import PageTest
from support import ProgramTest

PROPERTIES = [1, 1, 6, 2]    # of the columns of the plate
# Two thicknesses and a laminate, a rod, a bar, a solid that stands apart, two subcases.
DECK = """SOL 101
CEND
SPC = 1
SUBCASE 3
LABEL = pull
LOAD = 3
SUBCASE 7
LOAD = 7
BEGIN BULK
""" + "".join(f"GRID,{1 + i + 5 * j},,{float(i)},{float(j)},0.\n" for j in range(3) for i in range(5)) + "".join(
    f"CQUAD4,{1 + i + 4 * j},{PROPERTIES[i]},{1 + i + 5 * j},{2 + i + 5 * j},{7 + i + 5 * j},{6 + i + 5 * j}\n"
    for j in range(2) for i in range(4)) + """PSHELL,1,1,.02,1,,1
PSHELL,6,1,.03,1,,1
PCOMP,2,,,5.+7,HILL
,2,.005,0.,YES,2,.005,90.,YES
MAT1,1,7.+10,,.3,2700.,,,,+
+,4.+8,3.+8
MAT8,2,1.4+11,1.+10,.3,5.+9,,,1500.,+
+,,,1.5+9,1.2+9,4.+7,2.+8,7.+7
GRID,20,,4.,3.,0.
CROD,20,3,15,20
PROD,3,1,1.-3,1.-8
CBAR,21,4,20,9,0.,0.,1.
PBAR,4,1,1.-3,1.-6,1.-6,1.-6,,,+
+,.03,.03,-.03,-.03
GRID,31,,6.,0.,0.
GRID,32,,7.,0.,0.
GRID,33,,7.,1.,0.
GRID,34,,6.,1.,0.
GRID,35,,6.,0.,1.
GRID,36,,7.,0.,1.
GRID,37,,7.,1.,1.
GRID,38,,6.,1.,1.
CHEXA,40,5,31,32,33,34,35,36,+
+,37,38
PSOLID,5,1
SPC1,1,123456,1,6,11,20
SPC1,1,123,31,32,33,34
FORCE,3,5,,1000.,1.,0.,.2
FORCE,3,15,,500.,1.,.3,0.
FORCE,7,10,,20.,0.,0.,1.
FORCE,7,37,,1.+6,1.,0.,1.
ENDDATA
"""
NAMES = {"von_mises": "von Mises stress", "failure": "failure index", "max": "largest axial stress", "von_mises@top": "von Mises stress, top",
         "major@bottom": "largest principal stress, bottom", "minor": "smallest principal stress", "failure@ply2": "failure index, ply 2",
         "xx@C_a": "stress xx, C, end a", "xx@top": "stress xx, top", "xy": "stress xy", "12@ply1": "stress 12, ply 1"}


def solve(test, *arguments):
    test.write("d.bdf", DECK)
    test.bough("static", "d.bdf", "-o", "s.h5", *arguments)
    test.bough("report", "s.h5", "-o", "s.html")


def read_columns(path, subcase, kind="stresses"):
    """{component: {element: value}} of all cards; xx of rods as "axial"."""
    columns = {}
    with h5py.File(path) as f:
        for card, group in f[f"subcases/{subcase}/{kind}"].items():
            names = [n.decode() if isinstance(n, bytes) else n for n in group.attrs["components"]]
            for k, name in enumerate(names):
                name = "axial" if name == "xx" and card == "CROD" else name
                columns.setdefault(name, {}).update(zip(group["id"][:].tolist(), group["stress" if kind == "stresses" else "strain"][:, k].tolist()))
    return columns


class Columns(ProgramTest):
    def read_fields(self):
        """{name: ([{element: value} of each shape], field)} of the page, and the JSON of its elements."""
        (data,) = PageReader(self.read("s.html")).get_data()
        elements = data["drawing"]["elements"]
        ids = np.frombuffer(base64.b64decode(elements["id"]), "<u4")
        lists = [np.frombuffer(base64.b64decode(one), "<u4") for one in elements["fields"]["lists"]]
        fields = {}
        for field in elements["fields"]["list"]:
            of = ids[lists[field["of"]]].tolist()
            self.assertEqual(len(of), field["count"])
            fields[field["name"]] = ([dict(zip(of, unpack(column, field["count"]))) for column in field["values"]], field)
        return fields, elements

    def test_columns_are_those_of_the_file(self):
        solve(self)
        fields, _ = self.read_fields()
        for k, subcase in enumerate((3, 7)):
            columns = read_columns(self.path("s.h5"), subcase)
            for component, name in NAMES.items():
                found, expected = fields[name][0][k], columns[component]
                self.assertEqual(found.keys(), expected.keys(), name)
                size = np.ptp(list(expected.values())) + 1e-300
                for element, value in expected.items():
                    self.assertLessEqual(abs(found[element] - value), 1e-7 * size + 1e-12 * abs(value), (name, element))
        # The whole list: each column of the file once, derived ones first, and margins of the bar and the rod.
        self.assertEqual(list(fields)[:2], ["von Mises stress", "failure index"])
        margins = {"margin of safety, tension", "margin of safety, compression"}
        self.assertLessEqual(margins, set(fields))
        self.assertEqual(len(fields), len(columns) + len(margins))
        self.assertEqual({name: fields[name][1]["unit"] for name in ("stress xx", "failure index, ply 1", "margin of safety, tension")},
                         {"stress xx": "F/L^2", "failure index, ply 1": "", "margin of safety, tension": ""})
        self.assertEqual(set(fields["axial stress"][0][0]), {20})    # solids have xx too
        self.assertEqual(set(fields["stress xx"][0][0]), {40})
        # Components in element axes have no mean over neighbours.
        self.assertEqual([fields[name][1]["average"] for name in ("von Mises stress", "largest principal stress, top", "stress xx", "stress xx, top")],
                         [True, True, True, False])

    def test_strains_and_the_limit_of_the_page(self):
        solve(self, "--strains")
        fields, _ = self.read_fields()
        columns = read_columns(self.path("s.h5"), 3, "strains")
        for component, name in [("von_mises@top", "von Mises strain, top"), ("kappa_xx@mid", "curvature xx, mid"), ("xx@mid", "strain xx, mid")]:
            for element, value in columns[component].items():
                self.assertAlmostEqual(fields[name][0][0][element], value, delta=1e-7 * np.ptp(list(columns[component].values())))
        self.assertEqual([fields[name][1]["unit"] for name in ("strain xx, mid", "curvature xx, mid")], ["", "1/L"])
        # 60 x 60 quadrilaterals and 40 subcases: 144,000 numbers a column; six fit, which is on the page.
        n, cases = 60, 40
        self.write("d.bdf", "SOL 101\nCEND\nSPC=1\n" + "".join(f"SUBCASE {k}\nLOAD={k}\n" for k in range(1, cases + 1)) + "BEGIN BULK\n"
                   + "".join(f"GRID,{1 + i + (n + 1) * j},,{i / n:.6f},{j / n:.6f},0.\n" for j in range(n + 1) for i in range(n + 1))
                   + "".join(f"CQUAD4,{1 + i + n * j},1,{1 + i + (n + 1) * j},{2 + i + (n + 1) * j},{n + 3 + i + (n + 1) * j},{n + 2 + i + (n + 1) * j}\n"
                             for j in range(n) for i in range(n))
                   + "PSHELL,1,1,.02,1,,1\nMAT1,1,7.+10,,.3,2700.\nSPC1,1,123456,1,THRU," + str(n + 1) + "\n"
                   + "".join(f"FORCE,{k},{(n + 1)**2},,{k}.,0.,1.,1.\n" for k in range(1, cases + 1)) + "ENDDATA\n")
        self.bough("static", "d.bdf", "-o", "s.h5", "-q")
        self.bough("report", "s.h5", "-o", "s.html")
        fields, _ = self.read_fields()
        shapes = len(next(iter(fields.values()))[0])
        self.assertEqual(len(fields), 900000 // (n * n * shapes))
        self.assertIn(f"it has the colours of {len(fields)} of 13 columns", self.read("s.html"))


@unittest.skipUnless(find_chromium(), "chromium is not installed (apt install chromium); the page is not tried in a browser")
class Page(BrowserTest):
    VIEW = "document.querySelector('[data-view=modes]').view"

    def setUp(self):
        super().setUp()
        self.browser.renew(1100, 900)

    def open(self, name):
        self.browser.open(self.path(name))
        self.browser.settle()
        self.browser.show(".modes")
        self.browser.run(WAIT_FRAMES)

    def choose(self, text):
        """An option of "colour by"."""
        found = self.browser.run(f"""(() => {{ const s = document.querySelector('[aria-label="colour by"]');
          const o = [...s.options].find((o) => o.textContent === '{text}'); s.value = o.value; s.dispatchEvent(new Event('change'));
          return o.parentElement.label ?? ''; }})()""")
        self.browser.run(WAIT_FRAMES)
        return found

    def click_in_scene(self, place):
        """Clicks a point of space."""
        x, y = self.browser.run(f"""(() => {{ const {{ viewer }} = {self.VIEW}, [x, y] = viewer.find_place({list(place)});
          const b = viewer.canvas.getBoundingClientRect(); return [b.x + x, b.y + y]; }})()""")
        self.browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.browser.mouse("mouseReleased", x, y, button="left", clickCount=1)
        return self.browser.run("document.querySelector('.viewer .tip').hidden ? '' : document.querySelector('.viewer .tip').textContent")

    def get_thing(self, name):
        return self.browser.run(f"Array.from({self.VIEW}.viewer.things.find((t) => t.levels).{name} ?? [])")

    def test_colours_and_picks(self):
        solve(self)
        self.open("s.html")
        b = self.browser
        b.run(f"(() => {{ const s = document.querySelector('[aria-label=amplitude]'); s.value = 0; s.dispatchEvent(new Event('input')); }})()")
        columns = read_columns(self.path("s.h5"), 3)
        stress = columns["von_mises"]
        self.assertEqual(self.choose("von Mises stress"), "stress")
        bar = b.run("document.querySelector('.color-bar').innerText")
        self.assertIn("von Mises stress [F/L²]", bar)
        low, high = min(stress.values()), max(stress.values())
        numbers = [float(word.replace("−", "-")) for word in bar.replace("von Mises stress [F/L²]", "").split()]
        np.testing.assert_allclose(numbers, [low, (low + high) / 2, high], rtol=1e-3)
        # Each element over the range; the bar and the laminate have no von Mises stress and are grey.
        ids = b.run(f"Array.from({self.VIEW}.drawing.elements.id)")
        levels = dict(zip(ids, self.get_thing("levels")))
        for element, value in stress.items():
            self.assertAlmostEqual(levels[element], (value - low) / (high - low), places=5)
        self.assertEqual({e for e in ids if levels[e] < 0}, {21, 4, 8})
        ends = b.run("document.querySelector('.modes > .note').textContent")
        for element in (min(stress, key=stress.get), max(stress, key=stress.get)):
            self.assertIn(f"(element {element})", ends)
        # A click tells the element and its number: the middle of element 6; the rod, which is a line.
        text = self.click_in_scene((1.5, 1.5, 0))
        self.assertRegex(text, r"^element 6, property 1: von Mises stress \S+ F/L²")
        self.assertAlmostEqual(float(text.split()[-2]), stress[6], delta=1e-3 * stress[6])
        # The middle of the rod as it is drawn.
        middle = b.run(f"""(() => {{ const t = {self.VIEW}.viewer.things.find((t) => t.levels), ids = Array.from(t.ids);
          return [0, 1, 2].map((c) => (t.points[3 * ids.indexOf(15) + c] + t.points[3 * ids.indexOf(20) + c]) / 2); }})()""")
        text = self.click_in_scene(middle)
        self.assertRegex(text, r"^element 20, property 3: ")
        self.assertAlmostEqual(float(text.split()[-2]), stress[20], delta=1e-3 * stress[20])
        # Near a node, the node too.
        self.assertRegex(self.click_in_scene((1.02, 1.01, 0)), r"^element 6, .*\nnode 7: \(1, 1, 0\), displacement")
        # Neighbours differ on the screen: colours in the middles of elements 1 and 4.
        colors = b.run(f"""(() => {{ const {{ viewer }} = {self.VIEW}, c = viewer.canvas, s = document.createElement('canvas');
          viewer.draw(); s.width = c.width; s.height = c.height; const g = s.getContext('2d'); g.drawImage(c, 0, 0);
          return [[0.6, 0.4, 0], [2.6, 0.4, 0]].map((p) => viewer.find_place(p)).map(([x, y]) => Array.from(g.getImageData(x, y, 1, 1).data)); }})()""")
        self.assertNotEqual(*colors)

        # Means at nodes: over the shells at the node with the same property.
        self.assertEqual(self.get_thing("corner_levels"), [])
        b.run("[...document.querySelectorAll('.modes label')].find((l) => l.textContent.includes('averaged')).click()")
        with h5py.File(self.path("s.h5")) as f:
            mesh = f["mesh/elements"]
            cells = {int(e): [int(f["mesh/grid_id"][k]) for k in nodes] for group in mesh.values() for e, nodes in zip(group["id"][:], group["connectivity"][:])}
            quads = {int(e) for group in mesh.values() if group["connectivity"].shape[1] == 4 for e in group["id"][:]}
        found = np.array(self.get_thing("corner_levels")).reshape(-1, 3)
        triangles = np.array(b.run(f"Array.from({self.VIEW}.drawing.triangles, (p) => {self.VIEW}.drawing.ids[p])")).reshape(-1, 3)
        of = [ids[k] for k in b.run(f"Array.from({self.VIEW}.drawing.elements.of_triangle)")]
        for element, corners, level in zip(of, triangles, found):
            for grid, got in zip(corners, level):
                if element not in stress:
                    self.assertLess(got, 0)
                    continue
                near = [e for e in cells if grid in cells[e] and (e == element or {e, element} <= quads and PROPERTIES[(e - 1) % 4] == PROPERTIES[(element - 1) % 4])]
                mean = np.mean([stress[e] for e in near])
                self.assertAlmostEqual(got, (mean - low) / (high - low), places=5)
        # Another subcase has its own range; components of shells are not averaged.
        b.click(".modes .tools button[title='Next mode']")
        high = max(read_columns(self.path("s.h5"), 7)["von_mises"].values())
        self.assertAlmostEqual(float(b.run("document.querySelector('.color-bar .ends').lastChild.textContent")) / high, 1, delta=1e-3)
        self.choose("stress xx, top")
        self.assertEqual(self.get_thing("corner_levels"), [])
        self.assertTrue(b.run("[...document.querySelectorAll('.modes label')].find((l) => l.textContent.includes('averaged')).hidden"))
        self.choose("failure index")
        self.assertNotIn("[", b.run("document.querySelector('.color-bar').innerText"))
        self.assertEqual(b.list_errors(), [])

    def test_hidden_nodes_are_not_picked(self):
        """A cube of eight solids: a click on the place of a node at the back finds no such node."""
        self.write("d.bdf", "SOL 101\nCEND\nSPC=1\nLOAD=2\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPSOLID,1,1\n"
                   + "".join(f"GRID,{1 + i + 3 * j + 9 * k},,{float(i)},{float(j)},{float(k)}\n" for k in range(3) for j in range(3) for i in range(3))
                   + "".join("CHEXA,{},1,{},{},{},{},{},{},+\n+,{},{}\n".format(1 + i + 2 * j + 4 * k, *(1 + i + di + 3 * (j + dj) + 9 * (k + dk)
                             for dk in (0, 1) for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)))) for k in range(2) for j in range(2) for i in range(2))
                   + "SPC1,1,123,1,THRU,9\nFORCE,2,27,,1.,1.,0.,0.\nENDDATA\n")
        self.bough("static", "d.bdf", "-o", "s.h5")
        self.bough("report", "s.h5", "-o", "s.html")
        self.open("s.html")
        b = self.browser
        b.run(f"(() => {{ const s = document.querySelector('[aria-label=amplitude]'); s.value = 0; s.dispatchEvent(new Event('input')); }})()")
        names = {}
        with h5py.File(self.path("s.h5")) as f:
            places = dict(zip(f["mesh/grid_id"][:].tolist(), f["mesh/grid_xyz"][:].tolist()))
        for grid, place in places.items():
            words = self.click_in_scene(place).split()
            names[grid] = int(words[1].rstrip(":")) if words else 0
        # The eye looks from where x and z are large and y small.
        seen = {grid for grid, (x, y, z) in places.items() if x == 2 or y == 0 or z == 2}
        self.assertEqual({grid for grid, name in names.items() if name == grid}, seen)
        self.assertLessEqual(set(names.values()), seen | {0})


class Studio(PageTest):
    def test_static_solution_of_a_deck(self):
        self.write("d.bdf", DECK)
        b = self.open_studio("d.bdf")
        self.wait("studio.view?.stage")
        self.click_text("Static")
        self.wait("document.querySelector('main.work').dataset.file === 'd-static.h5'")
        self.wait("document.querySelector('[data-view=modes] .scene')")
        names = b.run("[...document.querySelectorAll('[aria-label=\"colour by\"] option')].map((o) => o.textContent)")
        self.assertLessEqual({"von Mises stress", "failure index", "largest principal stress, top", "margin of safety, tension"}, set(names))
        self.assertEqual(b.list_errors(), [])


if __name__ == "__main__":
    unittest.main()
