"""Functions of time are changed in their curves by the mouse and by keys: starts, ends, values, amplitudes, frequencies,
phases. Only the numbers of a handle change, the others keep their text; the command line runs what the text then has."""
import json
import tomllib
import unittest

import h5py

from studio_drags_test import CurveTest
from toml_text import section, table, toml

HANDLE = """((name, part) => { const { chart, handles } = studio.view.diagrams.editors.get(name), h = handles.find((one) => one.name === part), b = chart.overlay.getBoundingClientRect();
  return [b.x + chart.map_x(h.x), b.y + chart.map_y(h.y)]; })(%s, %s)"""
# A place of the chart, in its units.
PLACE = """((name, x, y) => { const { chart } = studio.view.diagrams.editors.get(name), b = chart.overlay.getBoundingClientRect(); return [b.x + chart.map_x(x), b.y + chart.map_y(y)]; })(%s, %s, %s)"""
# Distance of each handle from the curve, over its range.
GAPS = """Object.fromEntries([...studio.view.diagrams.editors].map(([name, { handles, curve }]) => { const { x, y } = curve, size = Math.max(...y) - Math.min(...y) || 1;
  const at = (t) => { let k = x.findIndex((v) => v > t); if (k < 0) k = x.length - 1; return y[k - 1] + ((t - x[k - 1]) / (x[k] - x[k - 1] || 1)) * (y[k] - y[k - 1]); };
  return [name, Object.fromEntries(handles.map((h) => [h.name, Math.abs(at(h.x) - h.y) / size]))]; }))"""

MASS = [table("body", "a", mass=2.0, inertia=[1.0, 1.0, 1.0]), table("hinge", "first", "prismatic", child="a", axis=[1.0, 0.0, 0.0])]
MOTOR = table("actuator", "motor", "hinge", hinge="first", input="thrust")
RUN = section("simulation", duration=4.0, output_step=0.01)


class Handles(CurveTest):
    def open_functions(self, name, *functions):
        return self.open_text(name, toml(*MASS, *functions, MOTOR, RUN, name="curves"))

    def open_text(self, name, text):
        page = self.show("curves.toml", text)
        self.wait_for_check()
        page.click("details.functions summary")
        self.wait(f"studio.view.diagrams.editors.get({json.dumps(name)})?.chart")
        page.show(f".curve-editor[data-function={name}] canvas.overlay")  # a chart is drawn when it is in view
        self.wait(f"studio.view.diagrams.editors.get({json.dumps(name)}).chart.frame")
        return page

    def get(self, name):
        return next(f for f in tomllib.loads(self.get_text())["function"] if f["name"] == name)

    def drag_handle(self, name, part, x, y):
        page, before = self.browser, self.get_text()
        page.show(f".curve-editor[data-function={name}] canvas.overlay")
        self.wait(f"studio.view.diagrams.editors.get('{name}').chart.frame")
        page.drag(page.run(HANDLE % (json.dumps(name), json.dumps(part))), page.run(PLACE % (json.dumps(name), x, y)), steps=8)
        self.wait(f"studio.view.pane.text !== {json.dumps(before)}")
        self.settle()
        return self.get(name)

    def get_pixels(self, name):
        return self.browser.run(f"(({{ range: r, frame: f }}) => [(r.x1 - r.x0) / f.width, (r.y1 - r.y0) / f.height])(studio.view.diagrams.editors.get('{name}').chart)")

    def test_pulse_by_mouse(self):
        """Start, value and end of a thrust; the speed after the run is the impulse over the mass."""
        page = self.open_functions("thrust", table("function", "thrust", "pulse", value=2.0, at=0.5, width=1.0))
        dx, dy = self.get_pixels("thrust")
        moved = self.drag_handle("thrust", "end", 2.5, 1.0)
        self.assertAlmostEqual(moved["width"], 2.0, delta=2 * dx)
        self.assertEqual((moved["value"], moved["at"]), (2.0, 0.5))
        end = moved["at"] + moved["width"]
        moved = self.drag_handle("thrust", "start", 1.0, 1.0)
        self.assertAlmostEqual(moved["at"], 1.0, delta=2 * dx)
        self.assertAlmostEqual(moved["at"] + moved["width"], end, delta=1e-12)
        width = moved["width"]
        moved = self.drag_handle("thrust", "value", moved["at"] + width / 2, 1.5)
        self.assertAlmostEqual(moved["value"], 1.5, delta=2 * dy)
        self.assertEqual(moved["width"], width)
        self.keep("studio-handles")
        self.save()
        self.bough("run", "curves.toml", "-o", "curves.h5")
        with h5py.File(self.path("curves.h5")) as f:
            self.assertAlmostEqual(f["/hinges/first/qdot"][-1].item(), moved["value"] * width / 2, delta=1e-6)
        # Undo takes each drag back.
        for _ in range(3):
            self.click_text("Undo")
        self.wait_for_check()
        self.assertEqual(self.get("thrust"), {"name": "thrust", "type": "pulse", "value": 2.0, "at": 0.5, "width": 1.0})
        self.check_page(page)

    def test_sine_by_mouse(self):
        """Amplitude, frequency, phase in degrees and mean value; while a handle is held the curve follows, Escape gives
        it back."""
        page = self.open_functions("thrust", table("function", "thrust", "sine", amplitude=2.0, frequency_hz=0.5, phase_deg=-45.0))
        text = self.get_text()
        self.assertIn("phase_deg = -45.0", text)
        dx, dy = self.get_pixels("thrust")
        moved = self.drag_handle("thrust", "amplitude", 0.75, 1.25)
        self.assertAlmostEqual(moved["amplitude"], 1.25, delta=2 * dy)
        self.assertEqual((moved["frequency_hz"], moved["phase_deg"], "offset" in moved), (0.5, -45.0, False))
        # The second upward crossing, at 2.25, goes to 1.5: 2π f 1.5 - π/4 = 2π.
        moved = self.drag_handle("thrust", "frequency", 1.5, 0.0)
        self.assertAlmostEqual(moved["frequency_hz"], 1.125 / 1.5, delta=1.125 / 1.5**2 * 2 * dx)
        self.assertEqual(moved["phase_deg"], -45.0)
        f = moved["frequency_hz"]
        moved = self.drag_handle("thrust", "phase and mean value", 0.5, 0.5)
        self.assertAlmostEqual(moved["phase_deg"], -360 * f * 0.5, delta=360 * f * 2 * dx)
        self.assertAlmostEqual(moved["offset"], 0.5, delta=2 * dy)
        self.assertEqual(moved["frequency_hz"], f)
        gaps = page.run(GAPS)["thrust"]
        self.assertEqual(set(gaps), {"amplitude", "frequency", "phase and mean value"})
        self.assertLess(max(gaps.values()), 2e-3)
        # Held: the curve is that of the handle, the text is not changed.
        text, before = self.get_text(), max(page.run("[...studio.view.diagrams.editors.get('thrust').curve.y]"))
        page.show(".curve-editor canvas.overlay")
        x, y = page.run(HANDLE % ('"thrust"', '"amplitude"'))
        dy = self.get_pixels("thrust")[1]
        page.mouse("mouseMoved", x, y)
        page.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        page.mouse("mouseMoved", x, y + 30, button="left", buttons=1)
        self.wait(f"Math.max(...studio.view.diagrams.editors.get('thrust').curve.y) < {before - 10 * dy}")
        self.assertEqual(self.get_text(), text)
        page.press("Escape")
        page.mouse("mouseReleased", x, y + 30, button="left", clickCount=1)
        self.assertAlmostEqual(max(page.run("[...studio.view.diagrams.editors.get('thrust').curve.y]")), before, delta=1e-12)
        self.assertEqual(self.get_text(), text)
        self.check_page(page)

    def test_each_type_by_keys(self):
        """Handles of all types are on the curves that the program draws; a number that is typed there is in the text."""
        page = self.open_functions("step", table("function", "step", "step", value=3.0, at=1.0, before=-1.0), table("function", "ramp", "ramp", value=2.0, to=2.0, **{"from": 1.0}),
                                   table("function", "doublet", "doublet", value=2.0, at=1.0, width=0.5), table("function", "saw", "sawtooth", amplitude=2.0, frequency_hz=0.5, rise=0.75, offset=1.0),
                                   table("function", "chirp", "chirp", amplitude=1.0, from_hz=1.0, to_hz=3.0, at=0.5, duration=2.0), table("function", "spin", "spinup", rate=3.0, duration=2.0),
                                   table("function", "level", "constant", value=1.5), table("function", "thrust", "sine", amplitude=1.0, omega=2.0))
        self.wait("document.querySelectorAll('.curve-editor').length === 8")
        edges = {"at", "start", "end", "width of each half", "frequency"}  # at a jump, or beyond the range
        for name, gaps in page.run(GAPS).items():
            on_curve = {part: gap for part, gap in gaps.items() if part not in edges and (name, part) not in {("saw", "amplitude"), ("chirp", "amplitude")}}
            self.assertTrue(all(gap < 5e-3 for gap in on_curve.values()), (name, gaps))
        for name, part, axis, value, expected in (
                ("step", "before", "y", 0.5, {"before": 0.5}), ("step", "at", "x", 1.5, {"at": 1.5}), ("step", "value", "y", 4, {"value": 4.0}), ("ramp", "from", "x", 0.5, {"from": 0.5}),
                ("ramp", "to", "x", 3, {"to": 3.0}), ("doublet", "end", "x", 3, {"width": 1.0}), ("doublet", "width of each half", "x", 1.25, {"width": 0.25}),
                ("saw", "amplitude", "x", 1.0, {"rise": 0.5}), ("saw", "frequency", "x", 1.6, {"frequency_hz": 0.625}), ("saw", "mean value", "y", 0, {"offset": 0.0}),
                ("chirp", "end", "x", 3.5, {"duration": 3.0}), ("chirp", "amplitude", "y", 2, {"amplitude": 2.0}), ("spin", "end", "y", 6, {"rate": 6.0}), ("spin", "end", "x", 3, {"duration": 3.0}),
                ("level", "value", "y", -1, {"value": -1.0}), ("thrust", "frequency", "x", 2, {"omega": 3.1416})):
            with self.subTest(name=name, part=part, axis=axis):
                before, text = self.get(name), self.get_text()
                page.run(f"document.querySelector('.curve-editor[data-function={name}] canvas.overlay').focus()")
                k = page.run(f"studio.view.diagrams.editors.get('{name}').handles.findIndex((h) => h.name === {json.dumps(part)})")
                self.wait(f"(({{ chosen, handles }}) => chosen === {k} || (studio.view.diagrams.editors.get('{name}').step(1), false))(studio.view.diagrams.editors.get('{name}'))")
                page.run(f"document.querySelector('[aria-label=\"{axis} of the handle of {name}\"]').select()")
                page.type(f"{value}\n")
                self.wait(f"studio.view.pane.text !== {json.dumps(text)} && studio.view.diagrams.drawn === studio.view.pane.text && studio.view.diagrams.editors.get('{name}').pending === 0")
                self.wait_for_check()
                self.assertEqual(self.get(name), {**before, **expected})
        # A limit, and what no text can say by a handle.
        page.run("(() => { const e = studio.view.diagrams.editors.get('ramp'); e.choose(e.handles.findIndex((h) => h.name === 'to')); })()")
        page.run("document.querySelector('[aria-label=\"x of the handle of ramp\"]').select()")
        page.type("0.25\n")
        self.wait("document.querySelector('.curve-editor[data-function=ramp] output').textContent.includes('x stays between 0.5 and ∞')")
        self.assertEqual(self.get("ramp")["to"], 3.0)
        self.check_page(page)

    def test_numbers_keep_their_text(self):
        """A handle leaves other numbers as they were written, and what is a parameter."""
        text = toml(*MASS, table("function", "thrust", "step", value=2.0, at=1.0), MOTOR, RUN, name="curves").replace("value = 2.0", "value = 2.00  # newton")
        page = self.open_text("thrust", text)
        at = self.drag_handle("thrust", "at", 2.0, 1.0)["at"]
        self.assertEqual(self.get_text(), text.replace("at = 1.0", f"at = {at}"))
        # The value as a parameter has no handle.
        text = text.replace("value = 2.00", 'value = "$size"') + "\n[parameters]\nsize = 2.5\n"
        page.run(f"studio.view.pane.editor.change({json.dumps(text)})")
        self.wait(f"studio.view.pane.text === {json.dumps(text)} && studio.view.diagrams.drawn === studio.view.pane.text")
        self.assertEqual(page.run("document.querySelectorAll('.curve-editor').length"), 1)
        self.assertEqual(page.run("studio.view.diagrams.editors.get('thrust').handles.map((h) => h.name)"), ["before"])


if __name__ == "__main__":
    unittest.main()
