"""`bough split`: a deck cut into bodies. The frequencies of the written system, whose bodies are reduced here from the
written decks, are those that `bough modes` finds for the deck."""
import json
import os
import re
import unittest

import h5py
import numpy as np

from support import ProgramTest
from decks import mesh

MATERIAL = "MAT1,1,7.+10,,.3,2700.\n"
HEAD = "SOL 103\nCEND\n{control}BEGIN BULK\nPARAM,COUPMASS,1\nPARAM,AUTOSPC,YES\n"


def make_line(points, first=1):
    """Grids through points and CBAR between them, ids from `first`."""
    text = "".join(f"GRID,{first + i},,{x:.12g},{y:.12g},{z:.12g}\n" for i, (x, y, z) in enumerate(points))
    return text + "".join(f"CBAR,{first + i},1,{first + i},{first + i + 1},.1,.2,1.\n" for i in range(len(points) - 1))


def make_deck(bulk, control="SPC = 1\n", more="SPC1,1,123456,1\n"):
    return HEAD.format(control=control) + "PBAR,1,1,1.-4,2.-8,1.-8,2.-8\n" + MATERIAL + bulk + more + "ENDDATA\n"


def make_boom(n=40, length=8., **more):
    return make_deck(make_line([(length * i / n, 0., 0.) for i in range(n + 1)]), **more)


def make_l_frame(n=12):
    points = [(3. * i / n, 0., 0.) for i in range(n)] + [(3., 2. * i / n, .5 * i / n) for i in range(n + 1)]
    return make_deck(make_line(points))


def make_plate(nx=12, ny=3, more="SPC1,1,123456,1,14,27,40\n", control="SPC = 1\n"):
    """1.2 by 0.3 of 2 mm; grid j (nx + 1) + i + 1 at station i."""
    text = "PSHELL,1,1,.002,1,,1\nPARAM,K6ROT,100.\n"
    text += mesh(nx, ny, lambda i, j: f"{.1 * i:.6g},{.1 * j:.6g},0.")
    return HEAD.format(control=control) + MATERIAL + text + more + "ENDDATA\n"


def make_box(n=9, more="SPC1,1,123456,1,THRU,4\n"):
    """A square tube of 1.2 m, 0.1 m wide, walls of 2 mm; grid 4 i + k + 1 at station i."""
    ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    text = "PSHELL,1,1,.002,1,,1\nPARAM,K6ROT,100.\n"
    text += "".join(f"GRID,{4 * i + k + 1},,{1.2 * i / n:.6g},{.05 * y},{.05 * z}\n"
                    for i in range(n + 1) for k, (y, z) in enumerate(ring))
    for i in range(n):
        for k in range(4):
            a, b = 4 * i + k + 1, 4 * i + (k + 1) % 4 + 1
            text += f"CQUAD4,{4 * i + k + 1},1,{a},{a + 4},{b + 4},{b}\n"
    return HEAD.format(control="SPC = 1\n") + MATERIAL + text + more + "ENDDATA\n"


def make_column(n=12, more="SPC1,1,123,1,2,3,4\n", control="SPC = 1\n"):
    """A column of n bricks of 0.1 m."""
    text = "PSOLID,1,1\n"
    for i in range(n + 1):
        for k, (y, z) in enumerate(((0., 0.), (.1, 0.), (.1, .1), (0., .1))):
            text += f"GRID,{4 * i + k + 1},,{.1 * i:.6g},{y},{z}\n"
    for i in range(n):
        a = 4 * i
        text += f"CHEXA,{i + 1},1,{a + 1},{a + 5},{a + 6},{a + 2},{a + 4},{a + 8},\n,{a + 7},{a + 3}\n"
    return HEAD.format(control=control) + MATERIAL + text + more + "ENDDATA\n"


def make_lap(more=""):
    """A boom, two plates of 0.6 by 0.2 that overlap from x = 1.35 to 1.6 and are joined there, and a second boom."""
    text = "".join(f"GRID,{i + 1},,{.1 * i:.6g},.1,0.\n" for i in range(10))
    for first, x, z in ((100, 1., "0."), (200, 1.35, ".01")):
        text += "".join(f"GRID,{first + 7 * j + i},,{x + .1 * i:.6g},{.1 * j:.6g},{z}\n" for j in range(3) for i in range(7))
        for j in range(2):
            for i in range(6):
                a = first + 7 * j + i
                text += f"CQUAD4,{first + 6 * j + i},{first // 100},{a},{a + 1},{a + 8},{a + 7}\n"
    text += "".join(f"GRID,{301 + i},,{2.05 + .1 * i:.6g},.1,.01\n" for i in range(10))
    line = [*range(1, 11), 107], [213, *range(301, 311)]
    text += "".join(f"CBAR,{e},9,{a},{b},0.,.3,1.\n" for first, grids in zip((1, 301), line)
                    for e, (a, b) in enumerate(zip(grids, grids[1:]), first))
    text += ("PSHELL,1,1,.004,1,,1\nPSHELL,2,1,.003,1,,1\nPBAR,9,1,1.-4,2.-8,1.-8,2.-8\nPARAM,K6ROT,100.\n"
             "PFAST,50,.02,-1,0,3.+6,2.+6,1.+6,400.,\n,300.,200.,.02\nPWELD,60,1,.01\n"
             "GRID,999,,1.45,.05,0.\nCFAST,501,50,PROP,1,2,999\n"
             "CFAST,502,50,ELEM,110,206,,,,\n,1.42,.15,0.\n"
             "CWELD,503,60,,PARTPAT,,,,,\n,1,2,,,,,,,\n,1.54,.04,0.\n"
             "CWELD,504,60,,ELPAT,,,,,\n,111,207,,,,,,,\n,1.52,.15,0.\n"
             "CWELD,505,60,,ELEMID,,,,,\n,105,201,,,,,,,\n,1.52,.05,0.\n"
             "CWELD,506,60,,ALIGN,112,208\n"
             "CWELD,507,60,,GRIDID,,,QQ,,\n,103,104,111,110,,,,,\n,200,201,208,207,,,,,\n,1.38,.05,0.\n")
    return HEAD.format(control="SPC = 1\nNSM = 5\n") + MATERIAL + text + more + "SPC1,1,123456,1\nENDDATA\n"


class Split(ProgramTest):
    def split(self, deck, *arguments, name="deck.bdf", number=10):
        self.write(name, deck)
        result = self.bough("split", name, *arguments, "--modes", number, "--json")
        return json.loads(result.stdout), result.stderr

    def modes(self, name, number):
        return json.loads(self.bough("modes", name, "-n", number, "--json").stdout)

    def list_hz(self, name, number):
        """Elastic frequencies by `bough modes`."""
        self.bough("modes", name, "-n", number + 6, "-o", self.path("whole.h5"), "-q")
        with h5py.File(self.path("whole.h5")) as f:
            hz = f["modes/frequency_hz"][:]
        return hz[hz > 1e-6 * hz.max()][:number]

    def list_system_hz(self, system="deck-run.toml", number=10, shift=1.):
        """Elastic frequencies of the system of the written files, every body reduced again, without gravity."""
        for name in sorted(os.listdir(self.folder)):
            if name.startswith("deck-") and name.endswith(".toml") and not name.endswith("-run.toml"):
                os.remove(self.path(name.replace(".toml", ".h5")))
                self.bough("reduce", name, "-q")
        self.write(system, self.read(system).replace("[0.0, 0.0, -9.81]", "[0.0, 0.0, 0.0]"))
        self.bough("linearize", system, "-o", self.path("linear.h5"), "-q")
        with h5py.File(self.path("linear.h5")) as f:
            poles = f["poles/real"][:] + 1j * f["poles/imag"][:]
        hz = np.sort(poles.imag[poles.imag > 0]) / (2 * np.pi)
        return hz[hz > shift][:number]

    def compare(self, answer, number=10, tolerance=1e-4, shift=None, name="deck.bdf"):
        """The system and the program's own table, with the modes of the deck."""
        expected = self.list_hz(name, number)
        table = np.array([[f["deck_hz"], f["parts_hz"]] for f in answer["frequencies"]])
        np.testing.assert_allclose(table[:, 0], expected, rtol=1e-9)
        np.testing.assert_allclose(table[:, 1], expected, rtol=tolerance)
        system = self.list_system_hz(number=number, shift=.1 * expected[0] if shift is None else shift)
        np.testing.assert_allclose(system, table[:, 1], rtol=3e-5)
        self.assertAlmostEqual(answer["parts_mass"] / answer["mass"], 1, delta=1e-12)
        self.assertAlmostEqual(sum(part["mass"] for part in answer["parts"]) / answer["mass"], 1, delta=1e-12)

    def test_boom_in_two_four_and_eight_parts(self):
        """First frequencies by the closed form of a clamped beam, too."""
        for parts in (2, 4, 8):
            answer, messages = self.split(make_boom(), "--parts", parts)
            self.assertEqual(len(answer["parts"]), parts)
            self.assertEqual([p["elements"] for p in answer["parts"]], parts * [40 // parts])
            self.assertNotIn("warning", messages)
            self.compare(answer)
            mass = 2700e-4
            exact = 1.875104069 ** 2 / (2 * np.pi) * np.sqrt(7e10 * 1e-8 / (mass * 8. ** 4))
            self.assertAlmostEqual(answer["frequencies"][0]["parts_hz"] / exact, 1, delta=1e-4)
            self.assertAlmostEqual(answer["mass"] / (8 * mass), 1, delta=1e-12)
            step = float(re.search(r"(?m)^step = (\S+)", self.read("deck-run.toml"))[1])
            self.assertAlmostEqual(step * 500 * exact, 1, delta=.3)  # rounded to one digit
            for name in os.listdir(self.folder):
                os.remove(self.path(name))

    def compare_at_rest(self, deck, part, tip, gravity):
        """The end under a small weight, at rest, of the parts that are split already and of the whole deck."""
        system = self.read("deck-run.toml").replace("[0.0, 0.0, -9.81]", str(list(gravity)))
        system += f'\n[[sensor]]\nname = "tip"\ntype = "position"\nbody = "{part}"\nnode = {tip}\n'
        self.write("rest.toml", system)
        self.bough("equilibrium", "rest.toml", "-o", "rest.h5", "-q")
        card = "GRAV,9,,1.," + ",".join(map(repr, gravity)) + "\nENDDATA\n"
        self.write("whole.bdf", deck.replace("SOL 103", "SOL 101").replace("SPC = 1\n", "SPC = 1\nLOAD = 9\n")
                   .replace("ENDDATA\n", card))
        self.bough("static", "whole.bdf", "-o", "whole.h5", "-q")
        with h5py.File(self.path("rest.h5")) as f, h5py.File(self.path("whole.h5")) as g:
            at = (g["dof_map"][:, 0] == tip) & (g["dof_map"][:, 1] <= 3)
            u, place = g["subcases/0/displacement"][:][at], f["sensors/tip"][0]
        x = next(line.split(",")[3:6] for line in deck.splitlines() if line.startswith(f"GRID,{tip},"))
        off = np.linalg.norm(place - np.array(x, float) - u) / np.linalg.norm(u)
        print(f"way {np.linalg.norm(u):.1e} m, of parts off by {off:.1e}")
        self.assertLess(off, 1e-4)

    def test_static_deflection(self):
        """The equilibrium of the system, and the program's own table, against `static`."""
        for deck, tip in ((make_boom(), 41), (make_l_frame(), 25)):
            answer, _ = self.split(deck, "--parts", 4)
            self.assertEqual([d["load"] for d in answer["deflections"]], [f"unit acceleration along {c}" for c in "xyz"])
            self.assertLess(max(d["error"] for d in answer["deflections"]), 1e-4)
            self.compare_at_rest(deck, "deck-4", tip, (0., -6e-3, -8e-3))
            self.write("unit.bdf", deck.replace("SOL 103", "SOL 101").replace("SPC = 1\n", "SPC = 1\nLOAD = 9\n")
                       .replace("ENDDATA\n", "GRAV,9,,1.,0.,0.,1.\nENDDATA\n"))
            self.bough("static", "unit.bdf", "-o", "unit.h5", "-q")
            with h5py.File(self.path("unit.h5")) as g:
                u = g["subcases/0/displacement"][:]
                moved = [np.linalg.norm(u[(g["dof_map"][:, 0] == i) & (g["dof_map"][:, 1] <= 3)]) for i in range(1, tip + 1)]
            self.assertAlmostEqual(answer["deflections"][2]["deflection"] / max(moved), 1, delta=1e-6)
            for name in os.listdir(self.folder):
                os.remove(self.path(name))

    def test_static_deflection_by_rigid_cuts_and_loads_of_the_deck(self):
        """A cut that changes the structure, a load of the deck, a free one under unit forces."""
        answer, messages = self.split(make_plate(), "--parts", 3, number=3)
        self.assertNotIn("[split.deflection]", messages)  # split.inaccurate has the cause
        self.assertGreater(answer["deflections"][2]["error"], 1e-3)
        answer, messages = self.split(make_box(), "--parts", 2, "--interface", "grids", number=3)
        self.assertIn("[split.deflection]", messages)
        self.assertLess(max(f["error"] for f in answer["frequencies"]), 1e-4)
        deck = make_boom(control="SPC = 1\nLOAD = 7\n", more="SPC1,1,123456,1\nFORCE,7,21,,10.,0.,0.,1.\n")
        answer, messages = self.split(deck, "--parts", 4)
        self.assertEqual(answer["deflections"][3]["load"], "LOAD 7")
        # A beam clamped at one end under a force at its middle: F a² (3L - a)/(6EI) at the end, about both oblique axes.
        compliance = np.linalg.norm(np.array([1 / 2e-8, .2 / 1e-8]) / np.sqrt(1.04)) / 7e10
        self.assertAlmostEqual(answer["deflections"][3]["deflection"] / (10 * 16 * (24 - 4) / 6 * compliance), 1, delta=1e-3)
        self.assertLess(answer["deflections"][3]["error"], 1e-4)
        ends = "CONM2,201,1,,.5,.0,.1,.3\nCONM2,202,41,,.5,.0,.3,-.1\n"
        answer, _ = self.split(make_boom(control="", more=ends), "--parts", 3, number=6)
        self.assertEqual([d["load"] for d in answer["deflections"]],
                         [f"unit force along {c} at grid 14" for c in "xyz"])
        self.assertLess(max(d["error"] for d in answer["deflections"]), 1e-4)

    def test_l_frame_twists_through_its_cuts(self):
        """Path over the corner; the twist of the first leg has mass only through the second."""
        answer, messages = self.split(make_l_frame(), "--parts", 4)
        self.assertNotIn("warning", messages)
        self.assertEqual([p["parent"] for p in answer["parts"]], ["ground", "deck-1", "deck-2", "deck-3"])
        self.compare(answer)

    def test_branches_become_parts_and_loops_are_closed(self):
        """A portal frame with a cantilevered branch, cut at grids: two feet at the ground, a joint of three parts."""
        n = 6
        left = [(0., 0., 3. * i / n) for i in range(n + 1)]
        beam = [(4. * i / n, 0., 3.) for i in range(n + 1)]
        right = [(4., 0., 3. - 3. * i / n) for i in range(n + 1)]
        text, ids = "", {}
        for x, y, z in left + beam[1:] + right[1:] + [(0., .5, 3.), (0., 1., 3.), (0., 1.5, 3.)]:
            ids[(x, y, z)] = len(ids) + 1
            text += f"GRID,{len(ids)},,{x:.12g},{y:.12g},{z:.12g}\n"
        chains = [left, beam, right, [(0., 0., 3.), (0., .5, 3.), (0., 1., 3.), (0., 1.5, 3.)]]
        element = 0
        for chain in chains:
            for a, b in zip(chain, chain[1:]):
                element += 1
                text += f"CBAR,{element},1,{ids[a]},{ids[b]},.3,.5,.2\n"
        feet = ids[left[0]], ids[right[-1]]
        corner, other = ids[(0., 0., 3.)], ids[(4., 0., 3.)]
        deck = make_deck(text, more="".join(f"SPC1,1,123456,{g}\n" for g in feet))
        answer, messages = self.split(deck, "--grids", f"{corner},{other}")
        self.assertEqual(len(answer["parts"]), 4)
        self.assertIn(f'name = "ground-{feet[1]}"', self.read("deck-run.toml"))
        np.testing.assert_allclose([f["parts_hz"] for f in answer["frequencies"]], self.list_hz("deck.bdf", 10), rtol=1e-4)
        # The system of the parts falls as one body with many modes does.
        sensor = '\n[[sensor]]\nname = "middle"\ntype = "position"\nbody = "{}"\nnode = 10\n'
        text = self.read("deck-run.toml").replace("duration = 2\n", "duration = 1\n")
        self.write("parts.toml", text + sensor.format("deck-2"))
        self.write("whole.toml", '[body]\ndeck = "deck.bdf"\n[body.modes]\nnumber = 60\n')
        self.bough("reduce", "whole.toml", "-o", "whole.h5", "-q")
        self.write("one.toml", '[[body]]\nname = "whole"\nfile = "whole.h5"\n[[hinge]]\nname = "base"\ntype = "fixed"\n'
                   'child = "whole"\n\n' + text[text.index("[simulation]"):] + sensor.format("whole"))
        histories = []
        for name in ("parts", "one"):
            self.bough("run", f"{name}.toml", "-o", f"{name}.h5", "-q")
            with h5py.File(self.path(f"{name}.h5")) as f:
                histories.append(f["sensors/middle"][:])
        way = np.ptp(histories[1], axis=0)
        self.assertGreater(way[2], .005)
        np.testing.assert_allclose(histories[0], histories[1], atol=.03 * way.max())

    def test_portal_whose_cuts_twist(self):
        """Both feet held, three parts: modes of the cuts in pure twist disturb neither the search of redundant
        constraints nor the independent coordinates of `linearize`."""
        places = [(0., 0., 3. * i / 8) for i in range(9)] + [(.5 * i, 0., 3.) for i in range(1, 9)]
        places += [(4., 0., 3. - 3. * i / 8) for i in range(1, 9)]
        line = make_line(places).replace(",.1,.2,1.\n", ",0.,1.,0.\n")
        masses = "".join(f"CONM2,{300 + i},{i},,.2,,,\n,1.-3,,1.-3,,,1.-3\n" for i in range(2, 25))
        deck = make_deck(line, more=f"SPC1,1,123456,1,25\n{masses}")
        answer, _ = self.split(deck, "--parts", 3, number=8)
        self.assertNotIn("redundant-constraint", self.bough("check", "deck-run.toml").stderr)
        self.compare(answer, number=8, tolerance=3e-4)

    def test_modes_that_span_all_masses(self):
        """Parts of few lumped masses: all their modes with the cut held leave its rotations no mass, and the moment
        there would be lost (0.7 % of the third frequency)."""
        places = [(0., 0., 3. * i / 8) for i in range(9)] + [(.5 * i, 0., 3.) for i in range(1, 9)]
        places += [(4., 0., 3. - 3. * i / 8) for i in range(1, 9)]
        deck = make_deck(make_line(places).replace(",.1,.2,1.\n", ",0.,1.,0.\n"), more="SPC1,1,123456,1,25\n")
        answer, messages = self.split(deck.replace("PARAM,COUPMASS,1\n", ""), "--parts", 4, number=8)
        table = np.array([[f["deck_hz"], f["parts_hz"]] for f in answer["frequencies"]])
        np.testing.assert_allclose(table[:, 1], table[:, 0], rtol=2e-4)
        self.assertNotIn("massless", messages)

    def test_bars_along_the_cut_join_nothing(self):
        """A ladder of CBARs cut through a rung, and at its two grids, by hand too: joints each, not one rigid plane."""
        text = "".join(f"GRID,{1 + 2 * i + j},,{.8 * j},0.,{.5 * i}\n" for i in range(6) for j in range(2))
        lines = [(1 + 2 * i + j, 3 + 2 * i + j) for i in range(5) for j in range(2)]
        lines += [(1 + 2 * i, 2 + 2 * i) for i in range(1, 6)]
        text += "".join(f"CBAR,{100 + k},1,{a},{b},0.,1.,0.\n" for k, (a, b) in enumerate(lines))
        deck = make_deck(text, more="SPC1,1,123456,1,2\n")
        for choice in (["--plane", "z=1."], ["--grids", "5,6"], ["--elements", f"{100 + 10 + 1}"]):
            answer, messages = self.split(deck, *choice, number=6)
            table = np.array([[f["deck_hz"], f["parts_hz"]] for f in answer["frequencies"]])
            np.testing.assert_allclose(table[:, 1], table[:, 0], rtol=1e-4, err_msg=str(choice))
            self.assertNotIn("warning", messages)

    def test_heavy_mass_on_a_held_grid(self):
        """A foundation of 1e4 kg at a foot that is held adds nothing to the twist of the cuts."""
        places = [(0., 0., .5 * i) for i in range(7)] + [(.5 * i, 0., 3.) for i in range(1, 9)]
        places += [(4., 0., 3. - .5 * i) for i in range(1, 7)]
        line = make_line(places).replace(",.1,.2,1.\n", ",0.,1.,0.\n")
        deck = make_deck(line, more="SPC1,1,123456,1,21\nCONM2,900,21,,1.+4\n")
        answer, _ = self.split(deck, "--parts", 3, number=6)
        table = np.array([[f["deck_hz"], f["parts_hz"]] for f in answer["frequencies"]])
        np.testing.assert_allclose(table[:, 1], table[:, 0], rtol=2e-4)

    def test_damping_comes_along_or_is_told(self):
        deck = make_boom(12).replace("PARAM,COUPMASS,1\n", "PARAM,COUPMASS,1\nPARAM,ALPHA2,1.-4\n")
        _, messages = self.split(deck, "--parts", 2, number=4)
        self.assertNotIn("split.damping", messages)
        hz = self.list_system_hz(number=4, shift=.1)
        with h5py.File(self.path("linear.h5")) as f:
            poles = f["poles/real"][:] + 1j * f["poles/imag"][:]
        poles = poles[poles.imag > 0]
        poles = poles[np.argsort(poles.imag)][:4]
        omega = np.abs(poles)
        self.assertEqual(len(hz), 4)
        np.testing.assert_allclose(-poles.real / omega, .5e-4 * omega, rtol=1e-4)
        for card in ("PARAM,ALPHA1,.1", "PARAM,G,.02"):
            _, messages = self.split(deck.replace("PARAM,ALPHA2,1.-4", card), "--parts", 2, number=4)
            self.assertIn("[split.damping]", messages)
        self.assertIn("material = true", self.read("deck-1.toml"))

    def test_pinned_beams_at_a_cut(self):
        deck = make_boom(12).replace("CBAR,7,1,7,8,.1,.2,1.\n", "CBAR,7,1,7,8,.1,.2,1.,,+\n+,56\n")
        self.write("deck.bdf", deck)
        self.fails(1, "split", "deck.bdf", "--grids", "7", error="split.weak-cut")

    def test_free_beam_and_planar_deck(self):
        """Free in space; and free in a plane of which every grid holds 345: the hinge leaves the plane's motions."""
        ends = "CONM2,201,1,,.5,.0,.1,.3\nCONM2,202,41,,.5,.0,.3,-.1\n"  # without them nothing has inertia in twist
        answer, _ = self.split(make_boom(control="", more=ends), "--parts", 3, number=6)
        self.assertIn('type = "free"', self.read("deck-run.toml"))
        self.compare(answer, number=6)
        for name in os.listdir(self.folder):
            os.remove(self.path(name))
        deck = make_boom(control="", more="").replace("PARAM,AUTOSPC,YES", "PARAM,AUTOSPC,YES\nGRDSET,,,,,,,345")
        answer, _ = self.split(deck, "--parts", 3, number=6)
        self.compare(answer, number=6)

    def test_simply_supported_beam(self):
        """A pin at one end, a roller at the other: no part is held by itself."""
        deck = make_boom(more="SPC1,1,1234,1\nSPC1,1,23,41\n")
        answer, _ = self.split(deck, "--parts", 4)
        self.assertIn('type = "general"', self.read("deck-run.toml"))
        self.compare(answer)
        exact = np.pi / 2 * np.sqrt(7e10 * 1e-8 / (2700e-4 * 8. ** 4))
        self.assertAlmostEqual(answer["frequencies"][0]["parts_hz"] / exact, 1, delta=1e-4)

    def test_plate_by_rigid_interfaces(self):
        """The frequencies of the parts are those of the whole deck with RBE2 along the cuts; their error is reported."""
        answer, messages = self.split(make_plate(), "--parts", 3, number=5)
        self.assertEqual(len(answer["parts"]), 3)
        self.assertIn("[split.inaccurate]", messages)
        self.assertIn("by a rigid element (RBE2); cut where the section is stiff, or try --interface grids or average", messages)
        rigid = make_plate(more="SPC1,1,123456,1,14,27,40\n" + "".join(
            f"GRID,{100 + c},,{.1 * c:.6g},.15,0.\nRBE2,{900 + c},{100 + c},123456,{c + 1},{c + 14},{c + 27},{c + 40}\n"
            for c in (4, 8)))
        self.write("rigid.bdf", rigid)
        expected = self.list_hz("rigid.bdf", 5)
        np.testing.assert_allclose([f["parts_hz"] for f in answer["frequencies"]], expected, rtol=5e-4)
        self.assertEqual(self.read("deck-2.bdf").count("RBE2"), 2)
        system = self.list_system_hz(number=5)
        np.testing.assert_allclose(system, [f["parts_hz"] for f in answer["frequencies"]], rtol=1e-6)

    def test_plate_by_averages(self):
        """RBE3 leave the sections free to bend: the parts are softer than the deck."""
        answer, messages = self.split(make_plate(), "--parts", 3, "--interface", "average", number=5)
        self.assertIn("[split.inaccurate]", messages)
        self.assertIn("by their mean motion (RBE3); cut where the section is stiff, or try --interface grids or rigid", messages)
        self.assertEqual(self.read("deck-2.bdf").count("RBE3"), 2)
        hz = np.array([[f["deck_hz"], f["parts_hz"]] for f in answer["frequencies"]])
        self.assertTrue((hz[:, 1] < hz[:, 0]).all(), hz)
        np.testing.assert_allclose(hz[:, 1], hz[:, 0], rtol=.04)
        np.testing.assert_allclose(self.list_system_hz(number=5, shift=.1), hz[:, 1], rtol=3e-5)

    def test_solids_by_rigid_interfaces(self):
        """A column of bricks; the section is stiff: the cuts cost less than 2 %."""
        answer, _ = self.split(make_column(), "--parts", 2, number=4)
        hz = np.array([[f["deck_hz"], f["parts_hz"]] for f in answer["frequencies"]])
        np.testing.assert_allclose(hz[:, 1], hz[:, 0], rtol=.02)
        np.testing.assert_allclose(self.list_system_hz(number=4), hz[:, 1], rtol=1e-6)

    def split_by_grids(self, deck, *choice, number=6, system=True):
        """Joins all grids of the cuts: the modes and the static deflections are those of the deck."""
        answer, messages = self.split(deck, *choice, "--interface", "grids", number=number)
        print([f"{f['parts_hz'] / f['deck_hz'] - 1:.1e}" for f in answer["frequencies"]],
              [(d["load"], f"{d['error']:.1e}") for d in answer["deflections"]])
        self.assertNotIn("warning", messages)
        self.assertNotIn("redundant-constraint", self.bough("check", "deck-run.toml").stderr)
        self.assertLess(max(d["error"] for d in answer["deflections"]), 1e-4)
        if system:
            self.compare(answer, number=number)
        return answer, messages

    def test_plate_joined_by_its_grids(self):
        """Where a rigid cut is 1 to 16 % off; the drilling rotation of a plate is joined where it has stiffness."""
        plate = make_plate(ny=2, more="SPC1,1,123456,1,14,27\n")
        for k6rot in ("100.", "0."):
            answer, messages = self.split_by_grids(plate.replace("K6ROT,100.", "K6ROT," + k6rot), "--parts", 3, number=4,
                                                   system=k6rot != "0.")
            self.assertEqual([p["joined_grids"] for p in answer["parts"]], [0, 3, 3])
            self.assertEqual([p["parent"] for p in answer["parts"]], ["ground", "deck-1", "deck-2"])
            text = self.read("deck-run.toml")
            self.assertEqual("[split.released]" in messages, k6rot == "0.")
            self.assertEqual("note: part deck-1: AUTOSPC holds" in messages, k6rot == "0.")
            self.assertEqual("6 of grid 5, 6 of grid 18, " in messages, k6rot == "0.")
            self.assertEqual(text.count("[[constraint]]"), 6)
            self.assertEqual(text.count('rotations = "z"'), 0 if k6rot == "100." else 6)
            for name in os.listdir(self.folder):
                os.remove(self.path(name))

    def test_box_and_column_joined_by_their_grids(self):
        # Corners pass all moments, and are 1e5 times as stiff as the box.
        self.split_by_grids(make_box(6), "--parts", 2, number=5, system=False)
        self.compare_at_rest(make_box(6), "deck-2", 26, (0., -6e-3, -8e-3))
        for name in os.listdir(self.folder):
            os.remove(self.path(name))
        self.split_by_grids(make_column(), "--parts", 2, number=4)
        text = self.read("deck-run.toml")
        self.assertEqual(text.count('type = "spherical"'), 4)  # a solid has no rotation at a grid
        self.assertIn("interface_moments = false", self.read("deck-2.toml"))

    def test_linear_models_of_joined_grids_have_all_digits(self):
        """A box in metres and in millimetres: the same coordinates are independent, and the poles are those of the
        assembled parts. Differences through loops took round-off of stiff corners for a slope: 18 % off."""
        kept = []
        for unit in (1., 1000.):
            deck = make_box()
            if unit != 1:  # tonnes and newtons
                deck = deck.replace("7.+10,,.3,2700.", "7.+4,,.3,2.7-9").replace("PSHELL,1,1,.002", "PSHELL,1,1,2.")
                deck = re.sub(r"(?m)^(GRID,\d+,),([^,]+),([^,]+),([^,\n]+)", lambda m: m[1] + "," + ",".join(
                    f"{unit * float(x):.6f}" for x in m.group(2, 3, 4)), deck)
            answer, _ = self.split(deck, "--parts", 2, "--interface", "grids", number=5)
            table = [f["parts_hz"] for f in answer["frequencies"]]
            found = self.list_system_hz(number=5, shift=.1 * table[0])
            print(f"unit {1 / unit} m: off by", [f"{a / b - 1:.1e}" for a, b in zip(found, table)])
            np.testing.assert_allclose(found, table, rtol=1e-7)
            self.assertNotIn("[linear.", self.bough("linearize", "deck-run.toml", "-o", "linear.h5").stderr)
            with h5py.File(self.path("linear.h5")) as f:
                kept.append([name.decode() for name in f["states/name"][:]])
            for name in os.listdir(self.folder):
                os.remove(self.path(name))
        self.assertEqual(kept[0], kept[1])

    def test_masses_loads_and_rigid_elements_come_once(self):
        more = ("SPC1,1,123456,1\nCONM2,101,21,,3.,.1,0.,.2\nCONM2,102,31,,2.\nCMASS2,103,1.5,41,1\nCMASS2,106,1.5,41,2\n"
                "CMASS2,107,1.5,41,3\n"
                "GRID,50,,4.,.3,0.\nRBE2,104,21,123456,50\nCONM2,105,50,,.7\nFORCE,7,21,,10.,0.,0.,1.\n"
                "FORCE,7,31,,5.,0.,1.,0.\nFORCE,7,41,,1.,1.,0.,0.\n")
        deck = make_boom(control="SPC = 1\nLOAD = 7\n", more=more)
        answer, messages = self.split(deck, "--parts", 4)
        texts = [self.read(f"deck-{i}.bdf") for i in range(1, 5)]
        counts = {card: [text.count(f"\n{card} ") for text in texts] for card in ("FORCE", "CMASS2", "RBE2")}
        self.assertEqual(counts, {"FORCE": [0, 1, 1, 1], "CMASS2": [0, 0, 0, 3], "RBE2": [0, 1, 0, 0]})
        self.assertAlmostEqual(answer["parts_mass"], 8 * .27 + 3 + 2 + .7 + 1.5, delta=1e-9)
        self.compare(answer)

    def test_planes_properties_and_elements(self):
        """Two cuts by planes, by lists and by properties give equal parts."""
        by_plane, _ = self.split(make_boom(), "--plane", "x=2", "--plane", "2,0,0=10")
        elements = [p["elements"] for p in by_plane["parts"]]
        self.assertEqual(elements, [10, 15, 15])
        by_list, _ = self.split(make_boom(), "--elements", "1-10", "--elements", "11-20,21-25")
        self.assertEqual([p["elements"] for p in by_list["parts"]], elements)
        np.testing.assert_allclose([f["parts_hz"] for f in by_list["frequencies"]],
                                   [f["parts_hz"] for f in by_plane["frequencies"]], rtol=1e-9)
        two = make_boom().replace("PBAR,1,1", "PBAR,2,1,1.-4,2.-8,1.-8,2.-8\nPBAR,1,1")
        for i in range(26, 41):
            two = two.replace(f"\nCBAR,{i},1,", f"\nCBAR,{i},2,")
        by_property, messages = self.split(two, "--elements", "property:1")
        self.assertNotIn("split.pieces", messages)
        _, messages = self.split(make_boom(), "--elements", "11-20")  # two pieces are left
        self.assertIn("[split.pieces]", messages)
        self.assertEqual([p["elements"] for p in by_property["parts"]], [25, 15])

    def test_spring_between_grids_apart(self):
        """A CELAS2 between grids that lie apart holds the rotation of a part that moves: it is named as the cause."""
        deck = make_boom(16, 3.2).replace("ENDDATA", "CELAS2,801,50000.,6,2,9,2\nENDDATA")
        _, messages = self.split(deck, "--grids", 3)
        self.assertIn("[split.inaccurate]", messages)
        self.assertIn("CELAS2 801 between grids 6 and 9 strains in rigid-body motion", messages)
        self.assertNotIn("max_frequency", messages)

    def test_bad_cuts_are_named(self):
        self.write("deck.bdf", make_boom(n=8))
        bad = [(("--grids", "9"), "split.nothing-separated", "deck.bdf:"), (("--grids", "77"), "split.unknown-grid", "77"),
               (("--grids", "3,3"), "split.bad-choice", "twice"), ((), "split.bad-choice", "--parts"),
               (("--parts", "2", "--grids", "3"), "split.bad-choice", "two ways"),
               (("--plane", "x=99"), "split.nothing-separated", "x=99"), (("--plane", "w=1"), "split.bad-plane", "w=1"),
               (("--name", "a/b"), "split.bad-name", "a/b"),
               (("--plane", "0,0,0=1"), "split.bad-plane", "0,0,0=1"),
               (("--elements", "1-8"), "split.nothing-separated", "one part"),
               (("--elements", "1-3", "--elements", "3-5"), "split.element-in-two-parts", "deck.bdf:"),
               (("--elements", "90"), "split.unknown-element", "90"), (("--elements", "a"), "split.bad-choice", "--elements"),
               (("--parts", "1"), "split.bad-choice", "cuts nothing"),
               (("--parts", "9"), "split.too-many-parts", "--parts 8")]
        for arguments, error, words in bad:
            self.fails(1, "split", "deck.bdf", *arguments, error=error, says=[words])
        self.assertEqual(os.listdir(self.folder), ["deck.bdf"])

    def make_tripod(self, more):
        """Three legs of six bars from the ground; RBE3 90 joins their ends 7, 17, 27 to grid 80."""
        ends = np.array([[(0., 0., 0.), (.4, .1, 1.)], [(1., 0., 0.), (.6, .1, 1.)], [(.5, .8, 0.), (.5, .3, 1.)]])
        legs = "".join(make_line([a + (b - a) * i / 6 for i in range(7)], 10 * leg + 1) for leg, (a, b) in enumerate(ends))
        return make_deck(legs + "GRID,80,,.5,.2,1.1\nCONM2,81,80,,.3\n" + more + "RBE3,90,,80,123456,1.,123,7,17,\n,27\n",
                         more="SPC1,1,123456,1,11,21\n")

    def test_pieces_that_an_rbe3_alone_joins(self):
        """A mean motion carries one piece: legs cut from the ground are loose under it, a mast on it is not."""
        deck = self.make_tripod("")
        self.write("deck.bdf", deck)
        for arguments in (("--parts", 3), ("--grids", "4,14,24"), ("--grids", 4)):
            output = self.fails(1, "split", "deck.bdf", *arguments, error="split.rbe3-pieces",
                              says=["deck.bdf:", "RBE3 90 alone joins the pieces", "at grids 7, 17, 27"]).stderr
            self.assertNotIn("mechanism", output)
        # Legs at the ground are one piece: the part holds its RBE3. So are two pieces with the reference grid at one.
        mast = make_line([(.5, .2, 1.1 + .2 * i) for i in range(6)], 80).replace("GRID,80,,0.5,0.2,1.1\n", "")
        answer, _ = self.split(self.make_tripod(mast.replace("CBAR,81,", "CBAR,181,")), "--grids", 82, number=6)
        self.assertEqual([p["elements"] for p in answer["parts"]], [20 + 1, 3])
        self.compare(answer, 6)

    def test_part_within_its_cut(self):
        """A stiffener along the edge of a skin: each of its grids is in the cut, which a rigid element joins."""
        bars = "PBAR,2,1,1.-4,2.-8,1.-8,2.-8\n" + "".join(f"CBAR,{900 + i},2,{i},{i + 1},0.,0.,1.\n" for i in range(1, 13))
        self.write("deck.bdf", make_plate(more="SPC1,1,123456,14,27,40\n" + bars))
        output = self.fails(1, "split", "deck.bdf", "--elements", "property:2", error="split.part-on-cut",
                          says=["deck.bdf:", "CBAR 901 and 11 more elements", "13 grids"]).stderr
        self.assertEqual(output.count("error:"), 1)

    def test_connectors(self):
        """CFAST and CWELD by properties, shells and grids are in the part of their shells."""
        deck = make_lap("NSM1,5,ELEMENT,.5,1\nNSM1,5,PSHELL,2.,2\n")
        answer, messages = self.split(deck, "--grids", "6,303")
        self.assertNotIn("warning", messages)
        self.assertEqual([p["elements"] for p in answer["parts"]], [5, 39, 7])
        for part, count in ((1, 0), (2, 1), (3, 0)):
            text = self.read(f"deck-{part}.bdf")
            for card in [f"CFAST   {i:8}" for i in (501, 502)] + [f"CWELD   {i:8}" for i in range(503, 508)]:
                self.assertEqual(text.count(card), count, card)
        self.assertIn("GRID         999", self.read("deck-2.bdf"))  # locates CFAST 501
        self.compare(answer)

    def test_cuts_leave_connectors_whole(self):
        """Stations between the shells of a connector are no cuts; a choice of elements that separates them is an error."""
        answer, _ = self.split(make_lap("NSM1,5,PSHELL,2.,2\n"), "--parts", "2")
        texts = [self.read(f"deck-{part}.bdf") for part in (1, 2)]
        self.assertEqual(sum(len(re.findall("^(?:CFAST|CWELD)", text, re.MULTILINE)) for text in texts), 7)
        self.assertIn(5, [sum(f"{card}   {i:8}" in text for card in ("CFAST", "CWELD") for i in range(501, 506)) for text in texts])
        self.assertAlmostEqual(answer["parts_mass"] / answer["mass"], 1, delta=1e-12)
        line = self.read("deck.bdf").split("CWELD,504")[0].count("\n") + 1
        result = self.fails(1, "split", "deck.bdf", "--elements", "1-10,property:1", error="split.connector-across-cut",
                            says=[f"deck.bdf:{line}:", "CWELD 504 joins the shells 111 and 207", "CFAST 501", "both sides"])
        self.assertEqual(result.stderr.count("error:"), 5)
        self.fails(1, "split", "deck.bdf", "--elements", "1-5,502", error="split.connector-across-cut",
                   says=["CFAST 502 is in another part of --elements than its shell 110"])
        self.fails(1, "split", "deck.bdf", "--plane", "z=.005", error="split.connector-across-cut")

    def test_pressure_on_grids(self):
        """PLOAD of grids that no part has together is an error; of the grids of one part it is there once."""
        plate = make_plate(control="SPC = 1\nLOAD = 7\n", more="SPC1,1,123456,1,14,27,40\nPLOAD,7,100.,{}\n")
        self.write("deck.bdf", plate.format("6,8,21,19"))
        self.fails(1, "split", "deck.bdf", "--plane", "x=.6", error="split.load-across-cut", says=["deck.bdf:", "6, 8, 21, 19"])
        _, messages = self.split(plate.format("7,8,21,20\nPLOTEL,950,6,8\nPLOTEL,951,6,7"), "--plane", "x=.6")
        self.assertIn("note: PLOTEL 950 joins grids of several parts, and is in none", messages)
        self.assertIn("[split.drawn-line]", messages)
        self.assertEqual([self.read(f"deck-{i}.bdf").count("PLOTEL") for i in (1, 2)], [1, 0])
        self.assertEqual([self.read(f"deck-{i}.bdf").count("PLOAD ") for i in (1, 2)], [0, 1])

    def test_bad_decks_are_named(self):
        boom = make_boom(n=8)
        bad = [("RBE2,90,4,123456,6\n", ("--plane", "x=4"), "split.rigid-across-cut", "RBE2 90"),
               ("CELAS2,91,1.+3,9,3\n", ("--parts", "2"), "split.grounded", "CELAS2 91"),
               ("ASET1,12356,9\n", ("--parts", "2"), "split.omitted-dofs", "ASET"),
               ("GRID,70,,0.,9.,0.\nGRID,71,,0.,9.,1.\nCBAR,92,1,70,71,1.,0.,0.\n", ("--parts", "2"),
                "split.loose-parts", "deck.bdf:"),
               ("GRID,70,,0.,9.,0.\nGRID,71,,0.,9.,1.\nCBAR,92,1,70,71,1.,0.,0.\n", ("--plane", "x=4"),
                "split.loose-parts", "CBAR 92"),
               ("SPOINT,80\nCELAS2,93,1.+3,3,3,80\nCELAS2,94,1.+3,7,3,80\n", ("--plane", "x=4"), "split.scalar-cut", "80"),
               ("DMIG,KK,0,6,1\nDMIG,KK,4,3,,6,3,1.+2\n", ("--plane", "x=4"), "split.matrix-across-cut", "DMIG KK")]
        for more, arguments, error, words in bad:
            text = boom.replace("ENDDATA", more + "ENDDATA")
            self.write("deck.bdf", text.replace("SPC = 1", "SPC = 1\nK2GG = KK") if "DMIG" in more else text)
            self.fails(1, "split", "deck.bdf", *arguments, error=error, says=[words])
        self.write("deck.bdf", make_plate(more="SPC1,1,123456,1,14,27,40\nGRID,80,,.6,.15,0.\nRBE2,95,80,123456,7,20,33\n"))
        self.fails(1, "split", "deck.bdf", "--parts", "2", error="split.dependent-cut", says=["RBE2 95"])
        self.write("deck.bdf", make_plate(ny=15, more="SPC1,1,123456," + ",".join(str(13 * k + 1) for k in range(6)) + "\n" + "SPC1,1,123456," +
                   ",".join(str(13 * k + 1) for k in range(6, 12)) + "\n" + "SPC1,1,3,13,26,39,52,65,78\n,91,104,117,130,143,156,169\n"))
        self.fails(1, "split", "deck.bdf", "--plane", "x=.6", error="split.held-grids", says=["13 grids"])
        self.write("deck.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID,1\nCONM2,1,1,,3.\nENDDATA\n")
        self.fails(1, "split", "deck.bdf", "--parts", "2", error="split.no-elements")
        self.write("deck.bdf", boom.replace("SPC = 1", "SPC = 1\nNSM = 5").replace("ENDDATA", "NSML,5,PBAR,1,3.\nENDDATA"))
        self.fails(1, "split", "deck.bdf", "--parts", "2", error="split.spread-mass", says=["deck.bdf:"])
        self.write("deck.bdf", boom.replace("SPC = 1\n", "SPC = 1\nSUBCASE 1\nLOAD = 7\nSUBCASE 2\nSTATSUB(PRELOAD) = 1\n")
                   .replace("ENDDATA", "FORCE,7,9,,1.,1.,0.,0.\nENDDATA"))
        self.fails(1, "split", "deck.bdf", "--parts", "2", "--subcase", "2", error="split.preload")
        light = boom.replace("MAT1,1,", "MAT1,2,7.+10,,.3\nMAT1,1,").replace("PBAR,1,1", "PBAR,2,2,1.-4,2.-8,1.-8,2.-8\nPBAR,1,1")
        for i in range(5, 9):
            light = light.replace(f"\nCBAR,{i},1,", f"\nCBAR,{i},2,")
        self.write("deck.bdf", light)
        self.fails(1, "split", "deck.bdf", "--parts", "2", error="split.no-mass", says=["deck.bdf:", "part 2"])
        rods = boom.replace("PBAR,1,1,1.-4,2.-8,1.-8,2.-8", "PROD,1,1,1.-4")
        for i in range(1, 9):
            rods = rods.replace(f"CBAR,{i},1,{i},{i + 1},.1,.2,1.", f"CROD,{i},1,{i},{i + 1}")
        self.write("deck.bdf", rods)
        self.fails(1, "split", "deck.bdf", "--parts", "2", error="split.weak-cut", says=["deck.bdf:", "grid 5"])



if __name__ == "__main__":
    unittest.main()
