"""Flexible bodies at several fill levels, switched by events: momentum, energy, shapes, linear models, checkpoints."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml
from uncertain_test import close

N, LENGTH = 6, 6.0
FULL, HALF = 40.0, 15.0


def make_deck(content):
    """A tank as a beam of bars, its content as masses at the middle grids, off the axis in the first of them."""
    step = LENGTH / N
    return ("SOL 103\nCEND\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-3,1.-7,2.-7,2.-7\nPARAM,COUPMASS,1\n"
            + "".join(f"GRID,{k + 1},,{step * k},0.,0.\n" for k in range(N + 1))
            + "".join(f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,1.,0.\n" for k in range(N))
            + "".join(f"CONM2,{100 + k},{k},,{content / 3},,{0.1 if k == 3 else 0.},0.\n" for k in (3, 4, 5)) + "ENDDATA\n")


def make_body(name, frame='frame = "node"\nframe_nodes = [1]\n', number=6):
    return (f'[body]\nname = "{name}"\ndeck = "{name}.bdf"\n{frame}interface = [1, {N + 1}]\n[body.modes]\nnumber = {number}\n'
            f'basis = "craig-bampton"\n[body.output]\nfile = "{name}.h5"\nnodes = [2, 3, 4, 5, 6]\n')


def make_system(events, levels=("full.h5", "half.h5"), rate=(0.0,) * 6, duration=0.2, more="", body=None, gravity=(0.0, 0.0, 0.0)):
    return toml(
        table("body", "stage", file=levels[0], **({"levels": list(levels)} if len(levels) > 1 else {}), **(body or {})),
        table("body", "payload", mass=12.0, inertia=[1.0, 2.0, 3.0], cg=[0.3, 0.1, 0.0]),
        table("hinge", "flight", "free", child="stage", child_node=1, rate=list(rate)),
        table("hinge", "top", "universal", parent="stage", parent_node=N + 1, child="payload", stiffness=400.0,
              position=[0.05, -0.02], rate=[0.1, 0.2], axis=[0.0, 1.0, 0.0], axis2=[0.0, 0.0, 1.0]),
        table("sensor", "top", "position", body="stage", node=N + 1), table("sensor", "v", "velocity", body="stage", node=N + 1),
        more, "".join(events),
        section("simulation", duration=duration, output_step=0.002, integrator="rk", relative_tolerance=1e-11,
                absolute_tolerance=1e-12, gravity=list(gravity)))


def switch(time, level, name="drain"):
    return table("event", name, time=time, action="level", body="stage", level=level)


MODES = 11
MOVING = {"rate": (0.4, 0.1, -0.3, 2.0, 1.0, -0.5), "body": {"eta": [0.003] * MODES, "eta_dot": [0.02] * MODES}}


class FillLevels(ProgramTest):
    def setUp(self):
        super().setUp()
        for name, content in (("full", FULL), ("half", HALF)):
            self.write(f"{name}.bdf", make_deck(content))
            self.write(f"{name}.toml", make_body(name))
            self.bough("reduce", f"{name}.toml", "-q")

    def run_system(self, name, text, *arguments):
        self.write(f"{name}.toml", text)
        done = self.bough("run", f"{name}.toml", "-o", f"{name}.h5", *arguments)
        with h5py.File(self.path(f"{name}.h5")) as f:
            found = {}
            f.visititems(lambda path, o: found.__setitem__(path, o[()]) if isinstance(o, h5py.Dataset) else None)
        return found, done

    def write_alone(self, found, i, level, **more):
        """The system with one level alone, in the state of sample i of a run."""
        eta, eta_dot, q, rates, top, top_rate = (found[path][i].tolist() for path in (
            "bodies/stage/eta", "bodies/stage/eta_dot", "hinges/flight/q", "hinges/flight/qdot", "hinges/top/q", "hinges/top/qdot"))
        text = make_system([], levels=(level,), rate=rates, body={"eta": eta, "eta_dot": eta_dot}, **more)
        text = text.replace("child_node = 1\n", f"child_node = 1\nposition = {q}\n", 1)
        return text.replace("position = [0.05, -0.02]", f"position = {top}").replace("rate = [0.1, 0.2]", f"rate = {top_rate}")

    def test_momentum_and_energy_are_booked_through_a_switch(self):
        found, done = self.run_system("s", make_system([switch(0.08, 2)], **MOVING))
        mass = found["system_mass/mass"].ravel()
        t = found["time"].ravel()
        self.assertAlmostEqual(mass[0] - mass[-1], FULL - HALF, places=9)
        np.testing.assert_allclose(mass[t > 0.081], mass[-1])
        for kind in ("linear", "angular"):
            total = found[f"momentum/{kind}"] + found[f"momentum/out_{kind}"]
            self.assertGreater(np.abs(found[f"momentum/out_{kind}"][-1]).max(), 1.0)
            np.testing.assert_allclose(total, np.tile(total[0], (len(total), 1)), rtol=0,
                                       atol=1e-10 * np.linalg.norm(total[0]))
        energy = sum(found[f"energy/{kind}"].ravel() for kind in ("kinetic", "strain", "potential"))
        balance = energy - found["energy/work"].ravel()
        np.testing.assert_allclose(balance, balance[0], rtol=0, atol=1e-9 * np.abs(energy).max())
        self.assertNotIn("run.energy", done.stderr)

    def test_uncertain_modes_are_those_of_the_level_in_use(self):
        """Past the switch, closed with delta, against files of all levels whose stiffness and damping are changed."""
        for name in ("full", "half"):
            self.write(f"{name}.toml", make_body(name) + "[body.damping]\nratio = 0.02\n")
            self.bough("reduce", f"{name}.toml", "-o", f"{name}.h5", "-q")
        text = make_system([switch(0.05, 2)], more=toml(
            table("function", "none", "constant", value=0.0),
            table("force", "push", body="payload", force=[0.0, 1.0, 0.0], function="none")), duration=0.1)
        self.write("s.toml", text.replace("position = [0.05, -0.02]\n", "").replace("rate = [0.1, 0.2]\n", ""))
        plain = ("linearize", "s.toml", "--at", "0.1", "--inputs", "push", "--outputs", "top", "-q")
        self.bough(*plain, "-o", "lft.h5", "--uncertain", "stage:eta7:stiffness=0.8:1.2", "--uncertain", "stage:eta8:damping=0.5:1.5")
        self.bough(*plain, "-o", "file.h5")
        for name in ("full", "half"):
            with h5py.File(self.path(f"{name}.h5"), "r+") as f:
                f["modal/stiffness"][6, 6] *= 1.1
                f["modal/damping"][7, 7] *= 1.3
        self.bough(*plain, "-o", "changed.h5")
        A = {}
        for name in ("file", "changed"):
            with h5py.File(self.path(f"{name}.h5")) as f:
                A[name] = f["A"][:]
        self.assertGreater(np.abs(A["changed"] - A["file"]).max(), 1.0)
        with h5py.File(self.path("lft.h5")) as f:
            for name, delta in (("file", (0.0, 0.0)), ("changed", (0.5, 0.6))):
                np.testing.assert_allclose(close(f, delta)[0], A[name], rtol=0, atol=1e-9 * np.abs(A[name]).max())

    def test_modes_of_levels_are_not_selected(self):
        more = table("force", "push", body="payload", force=[0.0, 1.0, 0.0])
        self.write("s.toml", make_system([switch(0.08, 2)], more=more))
        for arguments in (("s.toml", "-o", "sel"), ("full.h5", "s.toml", "-o", "f.h5"), ("half.h5", "s.toml", "-o", "h.h5")):
            found = self.bough("select", *arguments, "-n", "3", "--at", "0.1", code=1).stderr
            self.assertRegex(found, r"s\.toml:1: error: body 'stage' has fill levels.*select.levels")

    def test_the_structure_goes_on_where_it_is(self):
        """Places and velocities of nodes do not jump: those of the interface at all, inner ones by what modes leave."""
        found, _ = self.run_system("s", make_system([switch(0.08, 2)], **MOVING))
        texts = [x.decode() for x in np.ravel(found["events/what"])]
        moved = [x for x in texts if "its nodes move by" in x]
        self.assertEqual(len(moved), 1, texts)
        before = np.flatnonzero(found["time"].ravel() <= 0.08 + 1e-9)[-1]
        for name in ("top", "v"):
            x = found[f"sensors/{name}"]
            step = np.abs(np.diff(x, axis=0)).max(axis=1)
            self.assertLess(step[before], 1.5 * step[before - 3:before].max())

    def test_what_leaves_a_body_that_moves_as_rigid_has_its_momentum(self):
        """Out = m (v + ω × r) and its moment, of the content at the switch: closed form."""
        rate = (0.0, 0.0, 0.0, 2.0, 1.0, -0.5)
        found, _ = self.run_system("s", make_system([switch(0.0, 2)], rate=rate).replace("position = [0.05, -0.02]", "position = [0.0, 0.0]")
                                   .replace("rate = [0.1, 0.2]", "rate = [0.0, 0.0]"))
        v = np.array(rate[3:])
        left = (FULL - HALF) / 3
        places = np.array([[2.0, 0.1, 0.0], [3.0, 0.0, 0.0], [4.0, 0.0, 0.0]])  # grids 3, 4, 5
        np.testing.assert_allclose(found["momentum/out_linear"][-1], 3 * left * v, rtol=1e-9)
        np.testing.assert_allclose(found["momentum/out_angular"][-1], sum(np.cross(p, left * v) for p in places), rtol=1e-9)

    def test_after_the_switch_it_moves_as_the_other_body(self):
        """A run of the other level alone from the state after the switch."""
        found, _ = self.run_system("w", make_system([switch(0.0, 2)], **MOVING, duration=0.1))
        eta = found["bodies/stage/eta"]
        i = 10
        text = self.write_alone(found, i, "half.h5", duration=0.08)
        other, _ = self.run_system("o", text)
        np.testing.assert_allclose(other["sensors/top"][-1], found["sensors/top"][i + 40], rtol=0, atol=1e-8)
        np.testing.assert_allclose(other["bodies/stage/eta"][-1], eta[i + 40], rtol=0, atol=1e-8)

    def test_linear_models_have_the_level_of_their_time(self):
        """A, B and C at a time are those of the one level in the state at that time."""
        push = table("actuator", "push", type="force", body="stage", node=N + 1, axis=[0.0, 1.0, 0.0])
        found, _ = self.run_system("s", make_system([switch(0.08, 2)], **MOVING, more=push))
        models = []
        for at, level in ((0.04, "full.h5"), (0.12, "half.h5")):
            self.bough("linearize", "s.toml", "--at", at, "-o", "l.h5", "-q")
            i = int(np.argmin(np.abs(found["time"].ravel() - at)))
            self.write("one.toml", self.write_alone(found, i, level, more=push))
            self.bough("linearize", "one.toml", "-o", "one.h5", "-q")
            for path in ("/A", "/B", "/C"):
                (own,), (expected,) = self.read_arrays("l.h5", path), self.read_arrays("one.h5", path)
                scale = np.abs(expected).max(axis=1, keepdims=True) + 1e-9
                self.assertLess(np.abs((own - expected) / scale).max(initial=0), 1e-6, path)
            models.append(self.read_arrays("l.h5", "/A")[0])
        self.assertGreater(np.abs(models[0] - models[1]).max(), 1.0)

    def test_a_resumed_run_keeps_its_level(self):
        whole, _ = self.run_system("w", make_system([switch(0.06, 2), switch(0.14, 1, "fill")], **MOVING))
        self.run_system("p", make_system([switch(0.06, 2), switch(0.14, 1, "fill")], **MOVING, duration=0.1))
        self.write("p.toml", make_system([switch(0.06, 2), switch(0.14, 1, "fill")], **MOVING))
        self.bough("run", "p.toml", "-o", "p.h5", "--resume", "-q")
        for path in ("/sensors/top", "/system_mass/mass", "/momentum/out_angular"):
            (a,), (b,) = self.read_arrays("p.h5", path), self.read_arrays("w.h5", path)
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-8)
        mass = whole["system_mass/mass"].ravel()
        self.assertAlmostEqual(mass[-1], mass[0], places=9)

    def test_a_mission_in_parts_goes_on_at_the_level_of_its_end(self):
        whole, _ = self.run_system("w", make_system([switch(0.03, 2)], **MOVING, duration=0.08))
        self.run_system("first", make_system([switch(0.03, 2)], **MOVING, duration=0.04))
        second = make_system([], rate=MOVING["rate"]).replace("duration = 0.2", "start = 0.04\nduration = 0.04")
        found, done = self.run_system("second", second, "--start-from", "first.h5")
        self.assertIn("body 'stage' at level 2", done.stderr)
        self.assertAlmostEqual(found["system_mass/mass"].flat[0], whole["system_mass/mass"].flat[-1], places=9)
        np.testing.assert_allclose(found["sensors/top"][-1], whole["sensors/top"][-1], rtol=0, atol=1e-7)

    def test_what_cannot_be_is_named(self):
        self.write("few.toml", make_body("few", number=2).replace('deck = "few.bdf"', 'deck = "half.bdf"'))
        self.bough("reduce", "few.toml", "-q")
        self.write("far.bdf", make_deck(HALF).replace("GRID,4,,3.0", "GRID,4,,3.1"))
        self.write("far.toml", make_body("far"))
        self.bough("reduce", "far.toml", "-q")
        for text, error in (
                (make_system([switch(0.1, 3)]), "names level 3 of body 'stage', which has 2"),
                (make_system([switch(0.1, 2)], levels=("full.h5",)), "which has none"),
                (make_system([switch(0.1, 2).replace('"stage"', '"stag"')]), "did you mean 'stage'"),
                (make_system([switch(0.1, 2)], levels=("full.h5", "few.h5")), "system.bad-levels"),
                (make_system([switch(0.1, 2)], levels=("full.h5", "far.h5")), "node 4 is at different places"),
                (make_system([switch(0.1, 2)], levels=("full.h5", "none.h5")), "cli.no-body-file"),
                (make_system([]).replace('file = "full.h5"', 'file = "other.h5"'), "toml.bad-value"),
                (make_system([table("event", "e", time=0.1, action="level", body="stage")]), "missing key 'level'")):
            self.write("bad.toml", text)
            self.assertIn(error, self.bough("check", "bad.toml", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
