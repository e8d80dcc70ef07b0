"""`bough report`: structure, policy, numbers against h5py and SciPy, size."""
import base64
import hashlib
import json
import os
import re
import unittest
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser

import h5py
import numpy as np
import scipy.linalg

from support import BEAM, SOURCE, ProgramTest
from curves_test import read_curves, read_ticks, scale
from linear_test import PENDULUM
from response_test import AXIS

MISSING = 0xFFFFFF


class PageReader(HTMLParser):
    """Elements with their attributes; scripts, styles and table cells as text."""
    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.elements, self.scripts, self.styles, self.tables, self.open = [], [], [], [], None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag in ("script", "style"):
            self.open = (self.scripts if tag == "script" else self.styles)
            self.open.append([dict(attributes), ""])
        elif tag == "table":
            self.tables.append({"caption": "", "rows": []})
        elif tag == "tr" and self.tables:
            self.tables[-1]["rows"].append([])
        elif tag in ("td", "th") and self.tables:
            self.tables[-1]["rows"][-1].append("")
            self.open = "cell"
        elif tag == "caption":
            self.open = "caption"

    def handle_endtag(self, tag):
        if tag in ("script", "style", "td", "th", "caption"):
            self.open = None

    def handle_data(self, data):
        if isinstance(self.open, list):
            self.open[-1][1] += data
        elif self.open == "cell":
            self.tables[-1]["rows"][-1][-1] += data
        elif self.open == "caption":
            self.tables[-1]["caption"] += data

    def get_data(self):
        return [json.loads(text) for attributes, text in self.scripts if attributes.get("class") == "data"]

    def get_table(self, caption):
        return next(t["rows"] for t in self.tables if t["caption"].startswith(caption))


def unpack(column, count):
    """A column as report/pack.hpp packs it."""
    if not column["data"]:
        return np.full(count, column["low"])
    b = np.frombuffer(base64.b64decode(column["data"]), np.uint8).reshape(-1, 3).astype(np.int64)
    codes = b[:, 0] << 16 | b[:, 1] << 8 | b[:, 2]
    return np.where(codes == MISSING, np.nan, 2 * (column["low"] / 2 + codes * (column["step"] / 2)))


def unpack_extremes(extremes):
    """Index and value of each sample that a thinned column keeps: differences in base 64 (report/pack.hpp)."""
    digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
    codes = np.array([digits.index(c) for c in extremes["at"]]).reshape(-1, extremes["digits"])
    at = np.cumsum(codes @ 64**np.arange(extremes["digits"])[::-1])
    return at, unpack(extremes, len(at))


def write_results(path, samples, names, values=None, completed=1, extra=()):
    """A results file as docs/formats/results.md has it."""
    generator = np.random.default_rng(3)
    with h5py.File(path, "w") as f:
        f.attrs.update({"format": "bough-results", "format_version": "1.0", "bough_version": "0.1.0", "completed": completed,
                        "reason": "", "num_samples": samples})
        f.attrs.create("source", [["a.toml", "0" * 64]], dtype=h5py.string_dtype())
        t = np.linspace(0, 100, samples)
        f["time"] = t
        for k, name in enumerate(names):
            f["sensors/" + name] = np.sin(t * (k + 1)) + 0.1 * generator.standard_normal(samples) if values is None else values
            f["sensors/" + name].attrs["description"] = "made up"
            f["sensors/" + name].attrs["dims"] = "L"
        for name, value in extra:
            f[name] = value


class Report(ProgramTest):
    def report(self, *arguments):
        self.bough("report", *arguments, "-o", "page.html")
        with open(self.path("page.html"), encoding="utf-8") as f:
            text = f.read()
        page = PageReader(text)
        self.check_alone(text, page)
        return page

    def check_alone(self, text, page):
        """Nothing is loaded, and the policy allows the page's own script and style alone."""
        policy = next(a["content"] for tag, a in page.elements if a.get("http-equiv") == "Content-Security-Policy")
        self.assertIn("default-src 'none'", policy)
        self.assertNotIn("unsafe", policy)
        self.assertNotIn("http", policy)
        for tag, attributes in page.elements:
            for name, value in attributes.items():
                self.assertFalse(name.startswith("on"), (tag, name))
                self.assertNotEqual(name, "style", tag)
                if name in ("src", "href", "action", "data", "poster", "xlink:href"):
                    self.assertTrue(value.startswith("#"), value)
        self.assertNotIn("@import", text)
        scripts = [t for a, t in page.scripts if a.get("type") != "application/json"]
        self.assertEqual((len(scripts), len(page.styles)), (1, 1))
        for kind, inline in [("script", scripts[0]), ("style", page.styles[0][1])]:
            hash_ = base64.b64encode(hashlib.sha256(inline.encode()).digest()).decode()
            self.assertIn(f"{kind}-src 'sha256-{hash_}'", policy)

    def make_boom(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")

    def test_results(self):
        self.make_boom()
        self.bough("run", "spinup.toml", "-o", "spinup.h5")
        page = self.report("spinup.h5")
        (data,) = page.get_data()
        with h5py.File(self.path("spinup.h5")) as f:
            count = len(f["time"])
            self.assertAlmostEqual(data["time"]["first"] + data["time"]["step"] * (count - 1), f["time"][-1], 12)
            self.assertGreater(len(data["channels"]), 20)
            for channel in data["channels"]:
                if channel["path"] == "/energy/balance":
                    whole = sum(s * f["energy/" + k][:] for k, s in [("kinetic", 1), ("strain", 1), ("potential", 1), ("work", -1)])
                    whole = (whole - whole[0]).reshape(count, 1)
                    self.assertLess(np.abs(whole).max(), 1e-9 * f["energy/kinetic"][:].max())
                else:
                    whole = np.asarray(f[channel["path"]]).reshape(count, -1)[::channel["stride"]]
                    self.assertEqual(channel["unit"] or "1", f[channel["path"]].attrs.get("units") or f[channel["path"]].attrs["dims"])
                for k, column in enumerate(channel["columns"]):
                    error = np.abs(unpack(column, len(whole)) - whole[:, k]).max()
                    self.assertLessEqual(error, 0.51 * column["step"] + 1e-15 * np.abs(whole[:, k]).max(), channel["path"])
                    self.assertLessEqual(column["step"], 1.2e-7 * np.ptp(whole[:, k]) + 1e-300)
            rows = {r[0]: r for r in page.get_table("Every column")[1:]}
            y = f["sensors/tip_deflection"][:, 1]
            row = rows["tip_deflection:y"]
            for cell, value in zip(row[2:10], [y.min(), f["time"][y.argmin()], y.max(), f["time"][y.argmax()], y.mean(),
                                               np.sqrt((y**2).mean()), y[0], y[-1]]):
                self.assertAlmostEqual(float(cell), value, delta=1e-5 * abs(value) + 1e-12)
            moment = f["hinges/spin/reaction_moment"][:]
            largest = np.linalg.norm(moment, axis=1)
            row = next(r for r in page.get_table("Largest values") if r[0] == "hinges/spin" and "moment" in r[1])
            self.assertAlmostEqual(float(row[2]), largest.max(), delta=1e-5 * largest.max())
            self.assertAlmostEqual(float(row[3]), f["time"][largest.argmax()], delta=1e-4)
        health = {r[1]: r for r in page.get_table("Health")}
        self.assertEqual(health["run completed"][0], "ok")
        with h5py.File(self.path("spinup.h5")) as f:
            self.assertGreater(f.attrs["wall_time"], 0)
            self.assertLess(f.attrs["wall_time"], 60)
        self.assertEqual(health["worst relative error of the energy balance"][0], "ok")
        # The body was found beside the results, by its SHA-256.
        self.assertEqual(len(data["bodies"][0]["drawing"]["shapes"]), 3)
        self.assertEqual(health["deflection of body boom to its size"][0], "ok")
        # Without a script: one picture of each sensor, energies, and nothing empty.
        self.assertGreaterEqual(sum(tag == "svg" for tag, _ in page.elements), 5)

    def test_largest_deflection_is_that_of_all_samples(self):
        """One sample of 2,001 is the largest: the headline and the health have it, with its time."""
        self.make_boom()
        self.bough("run", "spinup.toml", "-o", "spinup.h5")
        with h5py.File(self.path("boom.h5")) as f:
            phi = f["modes/phi"][:, :3]
        for sample in (803, 1998):
            with h5py.File(self.path("spinup.h5"), "r+") as f:
                self.assertEqual(len(f["time"]), 2001)
                eta = f["bodies/boom/eta"]
                eta[sample] = 3 * np.abs(eta[:]).max(axis=0) * [1, -1, 1]
                sizes = np.linalg.norm(np.einsum("nim,tm->tni", phi, eta[:]), axis=2).max(axis=1)
                self.assertEqual(sizes.argmax(), sample)
                time = f["time"][sample]
            health = {r[1]: r for r in self.report("spinup.h5").get_table("Health")}
            note = health["deflection of body boom to its size"][3]
            with open(self.path("page.html"), encoding="utf-8") as f:
                headline = re.search(r"<dt>largest deflection</dt><dd>([\d.]+) .*?at t = ([\d.]+)", f.read())
            for found, at in (re.match(r"([\d.]+) of .* at t = ([\d.]+)", note).groups(), headline.groups()):
                self.assertAlmostEqual(float(found), sizes.max(), delta=1e-3 * sizes.max())
                self.assertAlmostEqual(float(at), time, delta=1e-3 * time)

    def test_another_body_file_is_not_drawn(self):
        self.make_boom()
        self.bough("run", "spinup.toml", "-o", "spinup.h5")
        self.bough("reduce", "boom.bdf", "--modes", "2", "-o", "boom.h5")
        page = self.report("spinup.h5")
        self.assertEqual(page.get_data()[0]["bodies"][0]["drawing"]["shapes"], [])
        self.assertTrue(any("is not the file that the run was started with" in " ".join(r) for r in page.get_table("Health")))

    def test_motion_without_stiffening_is_told(self):
        self.make_boom()
        self.bough("run", "spinup-no-kg.toml", "-o", "no-kg.h5")
        health = {r[1]: r for r in self.report("no-kg.h5").get_table("Health")}
        self.assertEqual(health["deflection of body boom to its size"][0], "look")

    def test_rates_of_divergence(self):
        """A shaft of two bending stiffnesses is unstable between its two bending frequencies, and only there."""
        self.write("shaft.bdf", BEAM.replace("1.-8,1.-8,1.-8", "1.-8,2.-8,3.-8"))
        self.bough("reduce", "shaft.bdf", "--modes", "4", "-o", "shaft.h5")
        self.bough("report", "shaft.h5", "-o", "page.html")
        with h5py.File(self.path("shaft.h5")) as f:
            rates = 2 * np.pi * f["modes/frequency_hz"][:2]
        with open(self.path("page.html"), encoding="utf-8") as f:
            found = re.findall(r"About x the body buckles or flutters at rates from ([\d.]+) to ([\d.]+) ", f.read())
        self.assertEqual(len(found), 1)
        np.testing.assert_allclose(np.array(found[0], float), rates, rtol=1e-4)

    def test_body(self):
        self.make_boom()
        page = self.report("boom.h5")
        with h5py.File(self.path("boom.h5")) as f:
            rows = page.get_table("Effective mass")[1:]
            whole = np.r_[np.full(3, f["rigid/mass"][0]), np.diag(f["rigid/inertia"])]
            share = 100 * f["effective_mass"][:] / np.where(whole > 0, whole, np.nan)
            for j, row in enumerate(rows):
                self.assertAlmostEqual(float(row[1]), f["modes/frequency_hz"][j], delta=1e-6 * f["modes/frequency_hz"][j])
                cells = np.array([float("nan") if c == "–" else float(c) for c in row[-12:]])
                np.testing.assert_allclose(cells[0::2], share[j], atol=0.0051)
                np.testing.assert_allclose(cells[1::2], share[:j + 1].sum(axis=0), atol=0.0051)
            norms = page.get_table("exact")[1:]
            self.assertAlmostEqual(float(norms[0][1]), np.linalg.norm(f["integrals/exact/gamma0"][0]), delta=1e-4)
            # Frequencies in the spinning frame, by the quadratic pencil on arrays of the file.
            M, K = f["modal/mass"][:], f["modal/stiffness"][:]
            gamma2, gamma4 = f["integrals/exact/gamma2"][:], f["integrals/exact/gamma4"][:]
            for axis, name in enumerate("xyz"):
                for row in page.get_table(f"Frequencies [Hz], spin about {name}")[1:]:
                    rate = float(row[0])
                    G = gamma2[:, :, axis].T
                    S = gamma4[:, :, axis, axis]
                    stiff = K + rate**2 * (f["stiffening/kg_inertial"][6 + axis] - (S + S.T) / 2)
                    n = len(M)
                    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, stiff), -2 * rate * np.linalg.solve(M, G)]])
                    expected = np.sort(np.abs(scipy.linalg.eigvals(A).imag))[::2] / (2 * np.pi)
                    np.testing.assert_allclose([float(c) for c in row[1:]], expected, rtol=2e-6, atol=2e-6)

    def test_spin_frequencies_of_a_beam(self):
        """Southwell: a clamped uniform beam spun about its root stiffens across the plane by 1.193 Ω², in it by 0.193 Ω²."""
        with open(os.path.join(SOURCE, "data/decks/rotating.bdf")) as f:
            self.write("beam.bdf", f.read())
        self.bough("reduce", "beam.bdf", "--modes", "12", "-o", "beam.h5")
        page = self.report("beam.h5")
        with h5py.File(self.path("beam.h5")) as f:
            xyz, phi = f["nodes/xyz"][:], f["modes/phi"][:]
            along = int(np.argmax(np.ptp(xyz, axis=0)))
            first = f["modes/frequency_hz"][0]
        axis = int(np.argmax(np.abs(phi[-1, :3, 0])))  # bending along this axis ...
        other = ({0, 1, 2} - {along, axis}).pop()      # ... and spin about either of the two across the beam
        for spin, factor in [(axis, 1.193336), (other, 0.193336)]:
            rows = page.get_table(f"Frequencies [Hz], spin about {'xyz'[spin]}")[1:]
            rate = float(rows[1][0])
            expected = np.sqrt(first**2 + factor * (rate / (2 * np.pi))**2)
            self.assertTrue(any(abs(float(c) - expected) < 2e-4 * expected for c in rows[1][1:]), (spin, expected, rows[1]))

    def test_modes_and_buckling(self):
        self.write("beam.bdf", BEAM)
        self.bough("modes", "beam.bdf", "-o", "modes.h5")
        page = self.report("modes.h5")
        with h5py.File(self.path("modes.h5")) as f:
            rows = page.get_table("Effective mass")[1:]
            self.assertEqual([float(r[1]) for r in rows], [float(f"{x:.7g}") for x in f["modes/frequency_hz"]])
            shapes = page.get_data()[0]["drawing"]["shapes"]
            raw = np.frombuffer(base64.b64decode(shapes[0]["data"]), "<i2").reshape(-1, 3) * shapes[0]["largest"] / 32767
            np.testing.assert_allclose(raw, f["modes/phi"][:, :3, 0], atol=1e-4 * shapes[0]["largest"])

    def read_energies(self, drawing):
        """Shares of the elements of a drawing: a row an element, a column a shape."""
        get = lambda name, kind: np.frombuffer(base64.b64decode(drawing["elements"][name]), kind)
        shares = [np.frombuffer(base64.b64decode(e["data"]), "<i2") * e["largest"] / 32767 for e in drawing["elements"]["energy"]]
        return np.array(shares).T, get("kind", "<u4"), get("measure", "<f4"), get("of_triangle", "<u4"), get("of_edge", "<u4")

    def test_strain_energy_of_elements(self):
        """A cantilever of two plates and a bar: what the page colours is what the file has, triangle by triangle."""
        self.write("mixed.bdf", "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,3\nSPC1,1,123456,1,4\n"
                   + "".join(f"GRID,{k + 1},,{x},{y},0.\n" for k, (x, y) in enumerate([(0., 0.), (1., 0.), (3., 0.), (0., 1.), (1., 1.), (3., 1.), (4., 1.)]))
                   + "CQUAD4,10,1,1,2,5,4\nCQUAD4,20,1,2,3,6,5\nCBAR,30,2,6,7,0.,0.,1.\nPSHELL,1,1,.01,1,,1\nPBAR,2,1,1.-4,1.-9,1.-9,2.-9\n"
                   "MAT1,1,7.+10,,.3,2700.\nENDDATA\n")
        self.bough("modes", "mixed.bdf", "-o", "plain.h5")
        page = self.report("plain.h5")
        self.assertNotIn("elements", page.get_data()[0]["drawing"])
        self.bough("modes", "mixed.bdf", "--ese", "-o", "modes.h5")
        drawing = self.report("modes.h5").get_data()[0]["drawing"]
        shares, kind, measure, of_triangle, of_edge = self.read_energies(drawing)
        with h5py.File(self.path("modes.h5")) as f:
            ids = f["energies/id"][:].tolist()
            expected = f["energies/strain"][:] / f["energies/total_strain"][:]
        np.testing.assert_allclose(expected.sum(axis=0), 1, rtol=1e-9)
        # kind (0 line, 1 surface) and size tell which is which.
        at = {(1, 1.0): 10, (1, 2.0): 20, (0, 1.0): 30}
        found = [at[int(k), round(float(m), 6)] for k, m in zip(kind, measure)]
        self.assertEqual(sorted(found), [10, 20, 30])
        np.testing.assert_allclose(shares, expected[[ids.index(e) for e in found]], atol=1e-4)
        # Two triangles a plate, whose corners are its grids; the bar is an edge, the others are outlines.
        self.assertEqual(len(of_triangle), 4)
        xyz = np.frombuffer(base64.b64decode(drawing["xyz"]), "<f4").reshape(-1, 3)
        corners = np.frombuffer(base64.b64decode(drawing["triangles"]), "<u4").reshape(-1, 3)
        for element, three in zip(of_triangle, xyz[corners]):
            self.assertEqual(measure[element], 1 if three[:, 0].max() <= 1 else 2)
        edges = np.frombuffer(base64.b64decode(drawing["edges"]), "<u4").reshape(-1, 2)
        bars = xyz[edges[of_edge != 0xFFFFFFFF]]
        np.testing.assert_allclose(np.sort(bars[:, :, 0]), [[3, 4]])
        # A static solution by hand: a bar of two elements that carries 500 along and a moment.
        self.write("rod.bdf", "SOL 101\nCEND\nSPC=1\nLOAD=7\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,3.,0.,0.\n"
                   "CBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,1.,0.\nPBAR,1,1,1.-3,2.-8,3.-8,4.-8\nMAT1,1,7.+10,,.3,2700.\n"
                   "SPC1,1,123456,1\nFORCE,7,3,,500.,1.,0.,0.\nENDDATA\n")
        self.bough("static", "rod.bdf", "-o", "rod.h5")
        shares, kind, measure, _, _ = self.read_energies(self.report("rod.h5").get_data()[0]["drawing"])
        np.testing.assert_allclose(shares[:, 0], [1 / 3, 2 / 3], atol=1e-4)  # N² L / 2 E A
        np.testing.assert_allclose(measure, [1, 2])

    def test_drawing_of_solids(self):
        """Two bricks: ten faces outside, none of the one between; all edges once; the modes of every corner."""
        grids = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)]
        lines = [f"GRID,{k + 1},,{x:.1f},{y:.1f},{z:.1f}" for k, (x, y, z) in enumerate(grids)]
        at = {g: k + 1 for k, g in enumerate(grids)}
        for e, x in enumerate((0, 1)):
            n = [at[c] for c in [(x, 0, 0), (x + 1, 0, 0), (x + 1, 1, 0), (x, 1, 0), (x, 0, 1), (x + 1, 0, 1), (x + 1, 1, 1), (x, 1, 1)]]
            lines.append(f"CHEXA,{e + 1},1," + ",".join(map(str, n[:6])) + "\n,"  + ",".join(map(str, n[6:])))
        self.write("bricks.bdf", "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,4\nSPC1,1,123,1,4,7,10\nPSOLID,1,1\n"
                                 "MAT1,1,7.+10,,.3,2700.\n" + "\n".join(lines) + "\nENDDATA\n")
        self.bough("modes", "bricks.bdf", "-o", "bricks.h5")
        drawing = self.report("bricks.h5").get_data()[0]["drawing"]
        get = lambda key, kind: np.frombuffer(base64.b64decode(drawing[key]), kind)
        triangles, edges = get("triangles", "<u4").reshape(-1, 3), get("edges", "<u4").reshape(-1, 2)
        xyz = get("xyz", "<f4").reshape(-1, 3)
        self.assertEqual((len(xyz), len(triangles), len(edges), len(drawing["shapes"])), (12, 20, 20, 4))
        area = np.linalg.norm(np.cross(xyz[triangles[:, 1]] - xyz[triangles[:, 0]], xyz[triangles[:, 2]] - xyz[triangles[:, 0]]), axis=1) / 2
        self.assertAlmostEqual(area.sum(), 10)
        self.assertEqual({tuple(sorted(e)) for e in edges.tolist()}.__len__(), 20)
        # Display shapes move all of a body with two output nodes. A file of an older version has shapes of these only:
        # the rest is there, undeformed; with --full all of it moves.
        self.write("bricks.toml", '[body]\nname = "bricks"\ndeck = "bricks.bdf"\nframe = "fixed"\ninterface = [3]\n'
                                  '[body.modes]\nnumber = 2\n[body.output]\nfile = "body.h5"\nnodes = [3, 6]\n')
        self.bough("reduce", "bricks.toml")
        drawing = self.report("body.h5").get_data()[0]["drawing"]
        self.assertEqual((get("triangles", "<u4").size, get("ghosts", "<u4").size, get("edges", "<u4").size), (60, 0, 40))
        with h5py.File(self.path("body.h5"), "r+") as file:
            del file["mesh/phi"]
        drawing = self.report("body.h5").get_data()[0]["drawing"]
        self.assertEqual((get("triangles", "<u4").size, get("ghosts", "<u4").size > 0, get("edges", "<u4").size), (0, True, 2))
        self.bough("reduce", "bricks.toml", "--full")
        drawing = self.report("body.h5").get_data()[0]["drawing"]
        self.assertEqual((get("triangles", "<u4").size, get("ghosts", "<u4").size), (60, 0))

    def test_rigid_box(self):
        """A uniform box of 2 x 3 x 4 is drawn as that box; modes of no body are needed."""
        mass, size = 6.0, np.array([2.0, 3.0, 4.0])
        inertia = mass / 12 * (np.sum(size**2) - size**2)
        text = PENDULUM.replace("POSITION", "0.0").replace(
            "mass = 2.0\ncg = [0.0, -0.7, 0.0]", f"mass = {mass}\ncg = [1.0, 2.0, 3.0]\ninertia = {inertia.tolist()}")
        self.write("box.toml", text)
        self.bough("run", "box.toml", "-o", "box.h5")
        (data,) = self.report("box.h5").get_data()
        xyz = np.frombuffer(base64.b64decode(data["bodies"][0]["drawing"]["xyz"]), "<f4").reshape(-1, 3)[:8]
        np.testing.assert_allclose(np.ptp(xyz, axis=0), size, rtol=1e-6)
        np.testing.assert_allclose(xyz.mean(axis=0), [1, 2, 3], rtol=1e-6)
        self.assertEqual([(h["name"], h["type"], h["axis"]) for h in data["hinges"]], [("pin", "revolute", [0, 0, 1])])

    def test_linear_model(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "-o", "linear.h5")
        page = self.report("linear.h5")
        (data,) = page.get_data()
        w = 2 * np.pi * np.frombuffer(base64.b64decode(data["frequency"]), "<f8")
        with h5py.File(self.path("linear.h5")) as f:
            A, B, C, D = (f[k][:] for k in "ABCD")
            names = [n.decode() for n in f["outputs/name"]]
            for pair in data["pairs"]:
                i = names.index(pair["output"])
                H = np.array([(C @ np.linalg.solve(1j * x * np.eye(len(A)) - A, B) + D)[i, 0] for x in w])
                decibel = np.frombuffer(base64.b64decode(pair["decibel"]), "<f8")
                drawn = np.isfinite(decibel)    # above the floor, 1e-12 of the largest entry
                np.testing.assert_allclose(10**(decibel[drawn] / 20), np.abs(H[drawn]), rtol=1e-8)
                degrees = np.frombuffer(base64.b64decode(pair["degrees"]), "<f8")
                np.testing.assert_allclose(np.exp(1j * np.radians(degrees[drawn])), H[drawn] / np.abs(H[drawn]), atol=1e-7)
            self.assertEqual(len(page.get_table("Poles")) - 1, len(A))
            poles = np.linalg.eigvals(A)
        with open(self.path("page.html"), encoding="utf-8") as f:
            text = f.read()
        headlines = dict(re.findall(r"<dt>([^<]*)</dt><dd>([^<]*)</dd>", text))
        self.assertIn("largest gain", headlines)
        frequency = re.search(r"<dt>smallest damping ratio</dt><dd>[^<]*</dd><dd class=.note.>at ([\d.]+) Hz", text)[1]
        self.assertAlmostEqual(float(frequency), np.abs(poles).min() / (2 * np.pi), delta=1e-4)
        damping = 100 * (-poles.real / np.abs(poles)).min()
        self.assertAlmostEqual(float(headlines["smallest damping ratio"].split()[0]), damping, delta=1e-2)
        # Lines of constant frequency have numbers.
        self.assertRegex(text, "\u03c9 [\\d.]+</text>")

    def test_comparison_selection_campaign(self):
        self.make_boom()
        self.bough("reduce", "boom.bdf", "--modes", "2", "-o", "small.h5")
        self.bough("compare", "boom.h5", "small.h5", "-o", "comparison.h5")
        printed = self.bough("select", "boom.h5", "--number", "2", "--json").stdout
        self.write("select.json", printed)
        self.bough("init", "campaign")
        page = self.report("comparison.h5", "select.json")
        pairs = page.get_table("mode of A, of B")
        self.assertEqual(len(pairs) - 1, 2)
        self.assertEqual(float(pairs[1][4]), 0)  # the same frequency
        with open(self.path("page.html"), encoding="utf-8") as f:
            self.assertIn("A is boom.h5, B is small.h5.", f.read())
        modes = json.loads(printed)["modes"]
        rows = page.get_table("Modes by component cost")[1:]
        self.assertEqual([r[4] for r in rows], ["yes" if m["kept"] else "no" for m in modes])

    def test_campaign(self):
        with h5py.File(self.path("outcomes.h5"), "w") as f:
            f.attrs.update({"format": "bough-outcomes", "format_version": "1.0", "campaign": "c", "fingerprint": "0" * 64})
            f["case"] = np.arange(1, 6, dtype=np.int32)
            f["parameters/E"] = np.linspace(1, 5, 5)
            f["outputs/tip"] = np.array([1.0, 4.0, 9.0, np.nan, 25.0])
            f["exit_code"] = np.array([0.0, 0, 0, 3, 0])
            f["error"] = np.array(["", "", "", "x<y", ""], dtype=h5py.string_dtype())
        page = self.report("outcomes.h5")
        row = next(r for r in page.get_table("Over the cases") if r[0] == "tip")
        self.assertEqual([float(c) for c in row[1:7]], [4, 1, 1.45, 6.5, 22.6, 25])
        self.assertEqual(page.get_table("Health")[0][2], "1 of 5")
        columns = page.get_data()[0]["columns"]
        self.assertEqual([(c["name"], c["output"]) for c in columns], [("case", False), ("E", False), ("tip", True), ("exit_code", False)])
        self.assertIsNone(columns[2]["numbers"][3])

    def test_size(self):
        """20,000 samples of 50 channels: all of them under 5 MB."""
        write_results(self.path("long.h5"), 20000, [f"s{k}" for k in range(50)])
        page = self.report("long.h5")
        self.assertLess(os.path.getsize(self.path("page.html")), 5e6)
        self.assertEqual({c["stride"] for c in page.get_data()[0]["channels"]}, {1})

    def test_larger_runs_are_thinned_and_told(self):
        write_results(self.path("long.h5"), 60000, [f"s{k}" for k in range(50)])
        page = self.report("long.h5")
        self.assertLess(os.path.getsize(self.path("page.html")), 5e6)
        stride = page.get_data()[0]["channels"][0]["stride"]
        self.assertGreater(stride, 1)
        with open(self.path("page.html")) as f:
            self.assertIn(f"the curves hold the smallest and the largest of each {2 * stride} samples of sensors", f.read())
        # Each is a sample of the file at its time; none of these samples is beyond them.
        with h5py.File(self.path("long.h5")) as f:
            for channel in page.get_data()[0]["channels"][:5]:
                whole, extremes = f[channel["path"]][:], channel["columns"][0]["extremes"]
                at, values = unpack_extremes(extremes)
                self.assertEqual((at[0], at[-1]), (0, len(whole) - 1))
                self.assertTrue(np.all(np.diff(at) > 0))
                np.testing.assert_allclose(values, whole[at], atol=0.51 * extremes["step"])
                for begin in range(0, len(whole), 2 * stride):
                    own = values[(at >= begin) & (at < begin + 2 * stride)]
                    part = whole[begin:begin + 2 * stride]
                    self.assertAlmostEqual(own.min(), part.min(), delta=0.51 * extremes["step"])
                    self.assertAlmostEqual(own.max(), part.max(), delta=0.51 * extremes["step"])
                self.assertAlmostEqual(extremes["mean"], whole.mean(), delta=1e-12)
                self.assertAlmostEqual(extremes["rms"], np.sqrt((whole**2).mean()), delta=1e-12)
        one = self.report("long.h5", "--channel", "s7")
        self.assertEqual([(c["path"], c["stride"]) for c in one.get_data()[0]["channels"]], [("/sensors/s7", 1)])
        self.fails(1, "report", "long.h5", "--channel", "s77", error="cli.unknown-channel")

    def test_bad_numbers_and_names(self):
        """Values that are not finite are a gap and reported; names cannot become elements."""
        evil = "</script><img src=x onerror=alert(1)>&\"'"
        values = np.linspace(0, 1, 30)
        values[7] = np.nan
        values[9] = np.inf
        write_results(self.path("r.h5"), 30, [evil.replace("/", "|"), "b"], values=values, completed=0,
                      extra=[("sensors/huge", 1.7e308 * np.linspace(-1, 1, 30)), ("sensors/flat", np.zeros(30))])
        page = self.report("r.h5")
        self.assertFalse(any(tag == "img" for tag, _ in page.elements))
        columns = {c["path"]: unpack(c["columns"][0], 30) for c in page.get_data()[0]["channels"]}
        np.testing.assert_array_equal(np.isnan(columns["/sensors/b"]), ~np.isfinite(values))
        np.testing.assert_allclose(columns["/sensors/huge"] / 1.7e308, np.linspace(-1, 1, 30), atol=1e-7)
        health = {r[1]: r[0] for r in page.get_table("Health")}
        self.assertEqual((health["run completed"], health["all samples are numbers"]), ("bad", "bad"))

    def test_uneven_time_and_no_samples(self):
        write_results(self.path("r.h5"), 0, ["a"])
        self.report("r.h5")
        write_results(self.path("r.h5"), 1, ["a"])
        self.report("r.h5")
        write_results(self.path("r.h5"), 40, ["a"])
        t = np.sort(np.random.default_rng(1).random(40))
        with h5py.File(self.path("r.h5"), "r+") as f:
            f["time"][:] = t
        packed = self.report("r.h5").get_data()[0]["time"]["data"]
        np.testing.assert_array_equal(np.frombuffer(base64.b64decode(packed), "<f8"), t)

    def test_static_solution(self):
        """A cantilever with two loads: closed forms, sums, the ends of its forces."""
        grids = "".join(f"GRID,{k + 1},,{0.25 * k},0.,0.\n" for k in range(5))
        bars = "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 5))
        self.write("tip.bdf", "SOL 101\nCEND\nSPC=1\nSUBCASE 3\nLABEL=sideways\nLOAD=3\nSUBCASE 7\nLOAD=7\nBEGIN BULK\n"
                   + grids + bars + "PBAR,1,1,1.-3,2.-8,3.-8,4.-8,,,+\n+,.01,.02,-.01,.02\nMAT1,1,7.+10,,.3,2700.,,,,+\n+,1.+6,2.+6\n"
                   "SPC1,1,123456,1\nFORCE,3,5,,2.,0.,0.,1.\nFORCE,7,5,,500.,1.,0.,0.\nENDDATA\n")
        self.bough("static", "tip.bdf", "-o", "tip.h5")
        page = self.report("tip.h5")
        subcases = next(t["rows"] for t in page.tables if t["rows"][0][0] == "subcase")
        self.assertEqual([r[0] for r in subcases[1:]], ["3", "7"])
        self.assertEqual(subcases[1][1], "sideways")
        self.assertAlmostEqual(float(subcases[1][2]), 2 / (3 * 7e10 * 3e-8), delta=2e-6 * float(subcases[1][2]))
        self.assertAlmostEqual(float(subcases[2][2]), 500 / (7e10 * 1e-3), delta=1e-5 * float(subcases[2][2]))
        self.assertEqual([r[3] for r in subcases[1:]], ["5", "5"])
        sums = [t["rows"] for t in page.tables if t["caption"].startswith("Sums")]
        self.assertEqual([float(v) for v in sums[0][1][1:]], [0, 0, 2, 0, -2, 0])
        np.testing.assert_allclose([float(v) for v in sums[0][2][1:]], [0, 0, -2, 0, 2, 0], atol=1e-9)
        reactions = [t["rows"] for t in page.tables if t["caption"].startswith("Forces of single")]
        self.assertEqual([r[0] for r in reactions[1][1:]], ["1"])
        self.assertAlmostEqual(float(reactions[1][1][1]), -500, delta=1e-3)
        forces = [t["rows"] for t in page.tables if t["caption"] == "Forces of elements"]
        axial = next(r for r in forces[1] if r[1].startswith("axial"))
        self.assertAlmostEqual(float(axial[4]), 500, delta=1e-3)
        margins = [t["rows"] for t in page.tables if t["caption"].startswith("Least margins")]
        self.assertAlmostEqual(float(margins[1][1][2]), 1e6 / (500 / 1e-3) - 1, delta=1e-4)
        (data,) = page.get_data()
        self.assertEqual(data["names"], ["subcase 3: sideways", "subcase 7"])
        self.assertEqual(len(data["drawing"]["shapes"]), 2)

    def test_sweep_and_response(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "-o", "linear.h5")
        self.bough("response", "linear.h5", "-o", "response.h5")
        page = self.report("response.h5")
        (data,) = page.get_data()
        with h5py.File(self.path("response.h5")) as f:
            H = f["real"][:] + 1j * f["imag"][:]
            outputs, inputs = ([n.decode() for n in f[k + "/name"]] for k in ("outputs", "inputs"))
        self.assertEqual(len(data["pairs"]), H.shape[1] * H.shape[2])
        for pair in data["pairs"]:
            h = H[:, outputs.index(pair["output"]), inputs.index(pair["input"])]
            decibel = np.frombuffer(base64.b64decode(pair["decibel"]), "<f8")
            drawn = np.abs(h) > 1e-12 * np.abs(H).max()
            np.testing.assert_array_equal(np.isfinite(decibel), drawn)
            np.testing.assert_allclose(10**(decibel[drawn] / 20), np.abs(h[drawn]), rtol=1e-10)
        # 2 s² + kd s + 8: unstable for negative kd, real poles from 8 on, of 12 at -5.236 and -0.764.
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--sweep", "kd=-3:12:16", "-o", "sweep.h5")
        page = self.report("sweep.h5")
        unstable = next(r for r in page.get_table("Health") if r[1].startswith("values with poles"))
        self.assertEqual(unstable[2], "3")
        self.assertIn("kd = -3 to -1", " ".join(unstable))
        rows = page.get_table("Of each motion")
        np.testing.assert_allclose([float(v) for v in rows[1][2:4]], [2 / (2 * np.pi), 0.764 / (2 * np.pi)], rtol=1e-3)
        self.assertAlmostEqual(float(rows[1][4]), -100 * 3 / 8, places=3)
        self.bough("plot", "sweep.h5", "--kind", "locus", "-o", "locus.svg")
        with open(self.path("locus.svg"), encoding="utf-8") as f:
            text = f.read()
        strokes = re.findall(r'<path d="M[^h"]*" fill="none" stroke="([^"]+)" stroke-width="1.8" stroke-linejoin', text)
        self.assertEqual(len(strokes), 2)
        self.assertEqual(strokes[0], strokes[1])  # of a pair
        # Crosses at the two poles of the first value, one in the legend; lines of damping and of frequency below them.
        self.assertEqual(text.count('l9 9m0 -9l-9 9'), 3)
        self.assertIn("\u03b6 ", text)

    def test_pictures_of_crowded_samples(self):
        """Most samples crowd about a resonance, as those of `response` do: the picture keeps the others all the same."""
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "-o", "linear.h5")
        self.bough("response", "linear.h5", "-o", "response.h5")
        f = np.unique(np.concatenate([np.geomspace(1e-3, 100, 300), np.linspace(0.99, 1.01, 4000)]))
        H = 1 / (1 - f**2 + 0.02j * f)
        with h5py.File(self.path("response.h5"), "r+") as out:
            for name, values in [("frequency_hz", f), ("real", H.real[:, None, None]), ("imag", H.imag[:, None, None]),
                                 ("singular_values", np.abs(H)[:, None])]:
                attributes = dict(out[name].attrs)
                del out[name]
                out[name] = values
                out[name].attrs.update(attributes)
        self.report("response.h5")
        with open(self.path("page.html"), encoding="utf-8") as page:
            svg = next(s for s in re.findall(r"<svg.*?</svg>", page.read(), re.S) if "Singular values" in s)
        svg = ElementTree.fromstring(svg)
        _, x, y = read_ticks(svg)
        (curve,) = read_curves(svg)
        decibel = np.interp(np.log10(f), np.log10(scale(curve[:, 0], x, True)), scale(curve[:, 1], y, False))
        np.testing.assert_allclose(decibel, 20 * np.log10(np.abs(H)), atol=1.0)
        self.assertLess(len(curve), 700)

    def test_refusals(self):
        self.write("beam.bdf", BEAM)
        self.bough("matrices", "beam.bdf", "-o", "matrices.h5")
        self.fails(1, "report", "matrices.h5", error="cli.no-report")
        self.write("x.json", "[1, 2]")
        self.fails(1, "report", "x.json", error="cli.no-report")
        self.write("y.json", '{"modes": [{"mode": 1}], "total_cost": 1}')
        self.fails(1, "report", "y.json", error="cli.no-report")
        self.fails(1, "report", "absent.h5", error="cli.no-file")
        write_results(self.path("r.h5"), 5, ["a"])
        self.fails(1, "report", "r.h5", "-o", "r.h5", error="cli.output-is-input")


if __name__ == "__main__":
    unittest.main()
