"""Closed loops from the files: a four-bar, stage separation, what is refused."""
import math
import unittest

import h5py
import numpy as np
from scipy.optimize import brentq

from support import ProgramTest
from four_bar import write_bars
from toml_text import section, table, toml

FOUR_BAR = toml(
    write_bars(("crank", 1.0, 0.4, [0.001, 0.014, 0.014]), ("coupler", 2.0, 1.1, [0.002, 0.2, 0.2]),
               ("rocker", 1.5, 0.9, [0.002, 0.1, 0.1])),
    table("hinge", "crank", "revolute", child="crank", position_deg=40.0, rate=3.0),
    table("hinge", "elbow", "revolute", parent="crank", parent_node=1, child="coupler"),
    table("hinge", "rocker", "revolute", child="rocker", parent_position=[1.0, 0.0, 0.0], position_deg=90.0,
          guess=True),
    table("constraint", "pin", "revolute", parent="coupler", parent_node=1, child="rocker", child_node=1),
    section("simulation", duration=1.0, output_step=0.01, gravity=[0.0, -9.81, 0.0], relative_tolerance=1e-10))

STAGE = toml(
    table("body", "launcher", mass=5.0, inertia=[1.0, 2.0, 3.0]),
    table("body", "stage", mass=2.0, inertia=[1.0, 1.0, 1.0]),
    table("hinge", "root", "free", child="launcher", rate=[0.1, 0.2, 0.3, 1.0, 0.0, 0.0]),
    table("hinge", "joint", "free", parent="launcher", child="stage", locked=True, stiffness=[0, 0, 0, 10, 10, 10],
          null_position=[1, 0, 0, 0, 0.5, 0, 0]),
    table("event", "separation", time=0.5, action="release", hinge="joint"),
    section("simulation", duration=1.0, relative_tolerance=1e-10))


def make_turning_disc(turn, radius, lean, spin):
    """A thin disc of radius 0.4 that rolls in a frame which turns about the vertical; its heading is that of the frame."""
    r, m = 0.4, 1.7
    return toml(
        table("body", "frame", mass=1.0, inertia=[1.0, 1.0, 1.0]),
        table("body", "disc", mass=m, inertia=[m * r * r / 2, m * r * r / 4, m * r * r / 4]),
        table("function", "turn", "ramp", value=100 * turn, **{"from": 0.0, "to": 100.0}),
        table("hinge", "axis", "revolute", child="frame", motion="turn"),
        table("hinge", "ride", "general", parent="frame", child="disc", rotations="yx", translations="xz",
              position=[-lean, 0.0, radius, r * math.cos(lean)], rate=[0.0, spin, 0.0, 0.0]),
        table("constraint", "road", "rolling", child="disc", axis=[0.0, 0.0, 1.0], axis2=[1.0, 0.0, 0.0], radius=r),
        section("simulation", duration=100.0, start=1.0, gravity=[0.0, 0.0, -9.81]))


class LoopsTest(ProgramTest):
    def test_a_steady_turn_is_at_rest_in_a_turning_frame(self):
        """Lean of a disc in a steady turn (docs/theory/rolling.md, closed forms), from a lean and a spin that are off."""
        r, turn, radius = 0.4, 1.0, 2.1
        lean = brentq(lambda a: turn**2 * (1.5 * r * radius + r * r / 4 * math.sin(a)) - 9.81 * r * math.tan(a), 0.0, 1.0)
        for start in (0.25, lean + 0.08):
            self.write("disc.toml", make_turning_disc(turn, radius, start, -5.0))
            self.bough("equilibrium", "disc.toml", "-o", "disc.h5")
            found, = self.read_arrays("disc.h5", "/hinges/ride/q")
            self.assertAlmostEqual(-found[-1, 0], lean, delta=1e-9)
            self.assertAlmostEqual(found[-1, 2], radius, delta=1e-12)

    def test_a_conical_pendulum_is_at_rest_on_a_shaft(self):
        turn, length = 6.0, 0.5
        self.write("cone.toml", toml(
            table("body", "shaft", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("body", "bob", mass=2.0, cg=[0.0, 0.0, -length]),
            table("hinge", "turn", "revolute", child="shaft", rate=turn),
            table("hinge", "swing", "revolute", parent="shaft", child="bob", axis=[0.0, 1.0, 0.0], position=0.5),
            section("simulation", duration=1.0, gravity=[0.0, 0.0, -9.81])))
        self.bough("equilibrium", "cone.toml", "-o", "cone.h5")
        found, = self.read_arrays("cone.h5", "/hinges/swing/q")
        self.assertAlmostEqual(found.flat[-1], math.acos(9.81 / turn**2 / length), delta=1e-9)

    def test_four_bar(self):
        self.write("bar.toml", FOUR_BAR)
        done = self.bough("run", "bar.toml", "-o", "bar.h5")
        for words in ("3 of its 5 directions twice", "to close the loops the start was moved", "integrator rk is taken"):
            self.assertIn(words, done.stdout + done.stderr)
        with h5py.File(self.path("bar.h5")) as f:
            crank, elbow = np.ravel(f["hinges/crank/q"]), np.ravel(f["hinges/elbow/q"])
            rocker = np.ravel(f["hinges/rocker/q"])
            force = f["constraints/pin/reaction_force"][:]
        end = 0.4 * np.exp(1j * crank) + 1.1 * np.exp(1j * (crank + elbow))
        self.assertLess(np.abs(end - 1 - 0.9 * np.exp(1j * rocker)).max(), 1e-12)
        self.assertAlmostEqual(crank[0], np.radians(40), places=14)
        self.assertGreater(np.abs(force).max(), 1)

    def test_stage_separation(self):
        self.write("stage.toml", STAGE)
        self.bough("run", "stage.toml", "-o", "stage.h5")
        with h5py.File(self.path("stage.h5")) as f:
            momentum, rates, time = f["momentum/angular"][:], f["hinges/joint/qdot"][:], f["time"][:]
        self.assertLess(np.abs(momentum - momentum[0]).max(), 1e-8)
        self.assertEqual(np.abs(rates[time <= 0.5]).max(), 0)
        self.assertGreater(np.abs(rates[-1]).max(), 0.1)

    def test_bounces_sticks_and_says_what_was_so_already(self):
        self.write("ball.toml", toml(
            table("body", "ball", mass=2.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "fall", "prismatic", child="ball", position=[0.5], stops={"lower": 0.0, "restitution": 0.5}),
            table("body", "block", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "slide", "prismatic", child="block", axis=[1.0, 0.0, 0.0], rate=[1.0],
                  friction={"coulomb": 2.0}),
            table("event", "again", time=0.1, action="release", hinge="fall"),
            section("simulation", duration=2.0, gravity=[0.0, 0.0, -10.0])))
        self.bough("run", "ball.toml", "-o", "ball.h5")
        with h5py.File(self.path("ball.h5")) as f:
            fall, slide = np.ravel(f["hinges/fall/q"]), np.ravel(f["hinges/slide/q"])
            held = np.ravel(f["hinges/fall/force"])[-1]
            events = "\n".join(line.decode() for line in f["events/what"][:])
        self.assertLess(abs(fall[-1]), 1e-8)
        self.assertAlmostEqual(held, 20.0, places=6)
        self.assertAlmostEqual(slide[-1], 0.25, places=7)
        for words in ("meets its stop", "comes to rest at its stop", "coordinate 1 of hinge 'slide' sticks",
                      "hinge 'fall' is released: it was so already"):
            self.assertIn(words, events)

    def test_a_loop_where_nothing_moves(self):
        """Found by ./dev soak, seed 5046: no coordinates, and a constraint."""
        text = ('[[body]]\nname = "b"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\nnodes = [{{id = 2, position = [1.0, 0.0, 0.0]}}]\n'
                '[[hinge]]\nname = "h"\ntype = "fixed"\nparent = "ground"\nchild = "b"\n'
                '[[constraint]]\nname = "loop"\ntype = "{0}"\nparent = "ground"\nchild = "b"\nchild_node = 2\n'
                'parent_position = [{1}, 0.0, 0.0]\n{2}[simulation]\nduration = 0.1\n')
        for kind, more in (("spherical", ""), ("point_on_line", "axis = [0.0, 0.0, 1.0]\n")):
            self.write("open.toml", text.format(kind, 0.5, more))
            for verb in ("check", "run", "linearize", "equilibrium"):
                self.fails(1, verb, "open.toml", says=["'loop'"])
            self.write("closed.toml", text.format(kind, 1.0, more))
            for verb in ("check", "equilibrium", "linearize"):
                self.bough(verb, "closed.toml")
            for integrator in ("adams", "bdf", "rk", "radau", "rk4"):
                step = 'step = 0.01\n' if integrator == "rk4" else ""
                self.write("moves.toml", text.format(kind, 1.0, more) + f'integrator = "{integrator}"\n{step}')
                self.bough("run", "moves.toml")

    def test_shapes_that_cannot_meet_a_constraint_are_named(self):
        """A cantilever whose end is clamped too: λ² = 22.3733 of a beam clamped at both ends (Blevins). Normal modes of
        the cantilever converge slowly to it; static shapes hold it at once. A pin at the end does no harm."""
        n, EI, mass = 20, 7e10 * 1e-8, 2700 * 1e-4
        deck = ("SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-4,1.-8,1.-8,1.-8\n"
                "PARAM,COUPMASS,1\nSPC1,1,123456,1\n" + f"SPC1,1,1345,2,THRU,{n + 1}\n"
                + "".join(f"GRID,{k + 1},,{k / n},0.,0.\n" for k in range(n + 1))
                + "".join(f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,1.,0.\n" for k in range(n)) + "ENDDATA\n")
        self.write("beam.bdf", deck)
        found = {}
        for basis, number in (("normal", 4), ("normal", 8), ("craig-bampton", 4)):
            self.write("beam.toml", f'[body]\nname = "beam"\ndeck = "beam.bdf"\nframe = "fixed"\ninterface = [{n + 1}]\n'
                       f'[body.modes]\nnumber = {number}\nbasis = "{basis}"\n[body.output]\nfile = "beam.h5"\n')
            self.bough("reduce", "beam.toml", "-q")
            for end, exact in (("fixed", 22.3733), ("revolute", 15.4182)):
                self.write("held.toml", '[[body]]\nname = "beam"\nfile = "beam.h5"\n[[hinge]]\nname = "root"\ntype = "fixed"\n'
                           'child = "beam"\nchild_node = 1\nparent_position = [0.0, 0.0, 0.0]\n'
                           f'[[constraint]]\nname = "end"\ntype = "{end}"\nparent = "ground"\nparent_position = [1.0, 0.0, 0.0]\n'
                           f'child = "beam"\nchild_node = {n + 1}\n[simulation]\nduration = 0.001\n')
                said = [self.bough(*call).stderr for call in (("check", "held.toml"), ("run", "held.toml"),
                                                              ("linearize", "held.toml", "-o", "l.h5"))]
                with h5py.File(self.path("l.h5")) as f:
                    least = np.hypot(f["poles/real"][:], f["poles/imag"][:]).min()
                error = least / (exact * np.sqrt(EI / mass)) - 1
                found[basis, number, end] = error
                is_said = ["[system.stiff-shapes]" in text for text in said]
                self.assertEqual(is_said, [error > 0.02] * 3, (basis, number, end, error, said[0]))
        self.assertGreater(found["normal", 4, "fixed"], 0.1)
        self.assertLess(found["craig-bampton", 4, "fixed"], 1e-3)
        self.assertLess(found["normal", 4, "revolute"], 0.01)

    def test_what_is_refused(self):
        def refused(name, text, *words):
            self.write(name, text)
            self.fails(1, "check", name, says=list(words))
        refused("a.toml", FOUR_BAR.replace('type = "revolute"\nparent = "coupler"', 'type = "free"\nparent = "coupler"'),
                "a.toml:", "type")
        refused("b.toml", FOUR_BAR.replace('name = "pin"', 'name = "pin"\nlength = 2.0'), "'length' has no meaning")
        refused("c.toml", FOUR_BAR.replace("[1.0, 0.0, 0.0]\nposition_deg", "[9.0, 0.0, 0.0]\nposition_deg"),
                "the loops cannot be closed: the positions of constraint 'pin' stay off by")
        refused("d.toml", STAGE.replace('hinge = "joint"\n[sim', 'hinge = "jont"\n[sim'), "did you mean 'joint'?")
        refused("e.toml", STAGE.replace('action = "release"', 'action = "break"'), "missing key 'constraint'")
        refused("h.toml", FOUR_BAR.replace('name = "crank"\ntype = "revolute"', 'name = "crank"\ntype = "screw"'),
                "h.toml:", "missing key 'pitch'")
        refused("i.toml", FOUR_BAR.replace('name = "crank"\ntype = "revolute"',
                                           'name = "crank"\nstops = {lower = 0.0}\ntype = "revolute"'),
                "missing key 'stiffness'")
        self.write("f.toml", FOUR_BAR)
        self.bough("linearize", "f.toml", "-o", "f.h5")
        with h5py.File(self.path("f.h5")) as f:
            self.assertEqual(f["A"].shape, (2, 2))
        self.write("g.toml", STAGE)
        self.fails(1, "linearize", "g.toml", "--each", 50, error="linear.changed-system")

    def get_poles(self, *arguments):
        self.bough("linearize", *arguments, "-o", "l.h5")
        with h5py.File(self.path("l.h5")) as f:
            return np.sort_complex(np.linalg.eigvals(f["A"][:]))

    def test_models_behind_events_are_of_the_system_as_it_is_then(self):
        pair = toml(
            table("body", "a", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("body", "b", mass=2.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "ha", "prismatic", child="a", axis=[1.0, 0.0, 0.0], stiffness=[10.0], position=[0.1]),
            table("hinge", "hb", "prismatic", parent="a", child="b", axis=[1.0, 0.0, 0.0], stiffness=[6.0]),
            "LOCKED\n",
            section("simulation", duration=3.0),
            table("event", "go", time=1.0, action="ACTION", hinge="hb"))
        for action, locked in (("release", True), ("lock", False)):
            text = pair.replace("ACTION", action)
            self.write("s.toml", text.replace("LOCKED", "locked = true" if locked else ""))
            self.write("then.toml", text.split("[[event]]")[0].replace("LOCKED", "" if locked else "locked = true"))
            before, behind = self.get_poles("s.toml", "--at", 0.5), self.get_poles("s.toml", "--at", 2.0)
            self.assertEqual((len(before), len(behind)), (2, 4) if locked else (4, 2))
            np.testing.assert_allclose(behind, self.get_poles("then.toml"), atol=1e-6)

    def test_models_behind_a_constraint_that_broke_or_closed(self):
        end = FOUR_BAR.split("[simulation]")[0]
        for action, active in (("break", True), ("close", False)):
            own = end if active else end.replace('name = "pin"', 'name = "pin"\nactive = false')
            self.write("s.toml", own + "[simulation]\nduration = 0.5\noutput_step = 0.001\nintegrator = \"rk\"\n"
                       f"gravity = [0.0, -9.81, 0.0]\n[[event]]\nname = \"go\"\ntime = 0.1\naction = \"{action}\"\nconstraint = \"pin\"\n")
            poles = self.get_poles("s.toml", "--at", 0.3)
            self.bough("run", "s.toml", "-o", "s.h5")
            self.assertEqual(len(poles), 6 if active else 2)
            if not active:
                continue
            # The open chain from where it is then.
            with h5py.File(self.path("s.h5")) as f:
                k = int(np.argmin(abs(f["time"][:] - 0.3)))
                state = {h: (float(f[f"hinges/{h}/q"][k]), float(f[f"hinges/{h}/qdot"][k]))
                         for h in ("crank", "elbow", "rocker")}
            text = end.split("[[constraint]]")[0]
            lines, name, table = [], "", ""
            for line in text.splitlines():
                table = line if line.startswith("[[") else table
                if line.startswith(("position", "rate", "guess")) and name in state:
                    continue
                lines.append(line)
                if line.startswith("name = "):
                    name = line.split('"')[1]
                    if name in state and table == "[[hinge]]":
                        lines += [f"position = [{state[name][0]!r}]", f"rate = [{state[name][1]!r}]"]
            self.write("open.toml", "\n".join(lines) + "\n[simulation]\nduration = 1.0\n" +
                       FOUR_BAR.split("[simulation]")[1].replace("duration", "#"))
            np.testing.assert_allclose(poles, self.get_poles("open.toml"), atol=2e-5)


if __name__ == "__main__":
    unittest.main()
