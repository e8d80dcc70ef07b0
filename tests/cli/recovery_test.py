"""Forces and stresses of elements of a flexible body: its /recovery against static solutions, in motion against the
reactions of its hinge."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import Bare, section, table, toml

N, L, A, I1, I2, E, RHO = 8, 2.0, 1e-3, 4e-8, 9e-8, 7e10, 2700.0
H = L / N
MASS = RHO * A * H  # of an element; lumped, half of it at each grid


def make_deck(load="FORCE,2,9,,1.,300.,40.,-25.\n", preload=""):
    text = f"SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,7.+10,,.3,{RHO}\n"
    for i in range(N + 1):
        text += f"GRID,{i + 1},,{i * H},0.,0.\n"
    for i in range(N):
        text += f"CBAR,{i + 1},{7 if i < 4 else 8},{i + 1},{i + 2},0.,1.,0.\n"
    for pid in (7, 8):
        text += f"PBAR,{pid},1,1.-3,4.-8,9.-8,5.-8\n,.02,.03,-.02,.03,-.02,-.03,.02,-.03\n"
    return text + load + preload + "CONM2,99,9,,1.5\nSPC1,1,123456,1\nENDDATA\n"


BODY = toml(
    section("body", name="boom", deck="boom.bdf", frame="fixed", interface=[9]),
    section("body.modes", number=Bare("{modes}")),
    section("body.output", recover=Bare("{recover}"), full=True))

SYSTEM = toml(
    table("body", "boom", file="boom.h5", stiffening=False),
    "{body}\n",
    table("hinge", "root", child="boom"),
    "{hinge}\n",
    "{more}\n",
    section("simulation", duration=Bare("{duration}"), output_step=0.01, integrator="adams", relative_tolerance=1e-10,
            absolute_tolerance=1e-13))


class Recovery(ProgramTest):
    def reduce(self, modes=3, recover='"all"', deck=None, more=""):
        self.write("boom.bdf", deck or make_deck())
        self.write("boom.toml", BODY.format(modes=modes, recover=recover) + more)
        return self.bough("reduce", "boom.toml", "-o", "boom.h5")

    def read_rows(self, name="CBAR", path="boom.h5"):
        """id, components, then matrix, inertial, external, offset as e x c x k."""
        with h5py.File(self.path(path)) as f:
            g = f["recovery/elements/" + name]
            return (list(g["id"][:]), list(g["component"].asstr()[:]),
                    *(g[k][:] for k in ("matrix", "inertial", "external", "offset")))

    def read_static(self, deck):
        self.write("static.bdf", deck)
        self.bough("static", "static.bdf", "-o", "static.h5")
        with h5py.File(self.path("static.h5")) as f:
            case = f["subcases"][list(f["subcases"])[0]]
            g, s = case["elements/CBAR"], case["stresses/CBAR"]
            forces = dict(zip([str(c) for c in g.attrs["components"]], g["force"][:].T))
            for c, values in zip([str(c) for c in s.attrs["components"]], s["stress"][:].T):
                forces["stress_" + c] = values
            return forces

    def run_system(self, **parts):
        text = SYSTEM.format(**{"body": "recover = true\n", "more": "", "duration": 0.3, "hinge": 'type = "fixed"', **parts})
        self.write("s.toml", text)
        self.bough("run", "s.toml", "-o", "r.h5")
        return h5py.File(self.path("r.h5"))

    def solve_static_modes(self, load, path="boom.h5"):
        """Rows under a load at grid 9 (six numbers): by modes alone, and with what they leave out."""
        ids, names, matrix, inertial, external, offset = self.read_rows(path=path)
        with h5py.File(self.path(path)) as f:
            K, F = f["modal/stiffness"][:], f["stiffening/external_load"][:]
            self.assertEqual(list(f["stiffening/locator/node"][:6]), [9] * 6)
        eta = np.linalg.solve(K, F[:, :6] @ load)
        modal = matrix @ eta
        return names, modal, modal + external[:, :, :6] @ load

    def test_tip_load_gives_the_forces_and_stresses_of_static(self):
        static = self.read_static(make_deck())
        load = np.array([300., 40., -25., 0, 0, 0])
        errors = []
        for modes in (3, 12, 24):  # lumped: three of each of 8 free grids
            self.reduce(modes)
            names, modal, whole = self.solve_static_modes(load)
            for c, name in enumerate(names):
                np.testing.assert_allclose(whole[:, c], static[name], rtol=1e-7, atol=1e-7 * np.abs(static[name]).max() + 1e-6)
            errors.append(abs(modal[0, names.index("moment_z_a")] / static["moment_z_a"][0] - 1))
        # Recovery by the modes alone converges; all modes that carry mass are complete.
        self.assertGreater(errors[0], 1e-3)
        self.assertLess(errors[1], errors[0])
        self.assertLess(errors[2], 1e-6)

    def test_attachment_modes_make_modes_alone_exact(self):
        self.reduce(3, more="")
        text = BODY.format(modes=3, recover='"all"').replace("[body.output]", 'residual = ["interface"]\n\n[body.output]')
        self.write("boom.toml", text)
        self.bough("reduce", "boom.toml", "-o", "boom.h5")
        static = self.read_static(make_deck())
        names, modal, whole = self.solve_static_modes(np.array([300., 40., -25., 0, 0, 0]))
        for name in ("axial", "shear_y", "moment_z_a", "moment_y_b", "stress_xx@C_a"):
            c = names.index(name)
            np.testing.assert_allclose(modal[:, c], static[name], rtol=1e-6, atol=1e-6 * np.abs(static[name]).max())

    def test_stresses_are_those_of_the_section(self):
        self.reduce(4)
        ids, names, matrix, *rest = self.read_rows()
        get = {name: matrix[:, c] for c, name in enumerate(names)}
        for end in "ab":
            for point, y, z in [("C", .02, .03), ("D", -.02, .03), ("E", -.02, -.03), ("F", .02, -.03)]:
                expected = get["axial"] / A - y * get[f"moment_z_{end}"] / I1 + z * get[f"moment_y_{end}"] / I2
                np.testing.assert_allclose(get[f"stress_xx@{point}_{end}"], expected, rtol=1e-9,
                                           atol=1e-9 * np.abs(expected).max())

    def test_words_choose_elements(self):
        for recover, ids in [('[3]', [3]), ('[2, "4-6"]', [2, 4, 5, 6]), ('["property:8"]', [5, 6, 7, 8]),
                             ('["card:CBAR"]', list(range(1, 9)))]:
            self.reduce(2, recover)
            self.assertEqual(self.read_rows()[0], ids)
        self.bough("reduce", "boom.bdf", "--modes", 2, "--recover", "1,7-8", "-o", "b.h5")
        self.assertEqual(self.read_rows(path="b.h5")[0], [1, 7, 8])
        self.fails(1, "reduce", "boom.bdf", "--modes", 2, "--recover", "77", "-o", "b.h5", error="reduce.unknown-element")
        self.fails(1, "reduce", "boom.bdf", "--modes", 2, "--recover", "3-1", "-o", "b.h5", error="reduce.bad-recover")
        self.assertIn("[reduce.nothing-to-recover]",
                      self.bough("reduce", "boom.bdf", "--modes", 2, "--recover", "99", "-o", "b.h5").stderr)

    def test_accelerated_beam_against_the_reaction_of_its_hinge(self):
        # Carried along y by a prescribed motion: linear, so that the sections hold what the hinge passes on.
        self.reduce(3)
        more = toml(
            table("function", "shake", "expression", expression="0.01*(1-cos(25*t))", rate="0.25*sin(25*t)",
                  acceleration="6.25*cos(25*t)"),
            table("sensor", "root moment", "element", body="boom", element=1, component="moment_z_a"))
        with self.run_system(hinge='type = "prismatic"\naxis = [0.0, 1.0, 0.0]\nmotion = "shake"', more=more) as f:
            rows = f["bodies/boom/recovery/CBAR/1"][:]
            names = f["bodies/boom/recovery/CBAR/1"].attrs["description"]
            names = (names.decode() if isinstance(names, bytes) else names).split(", ")
            moment = rows[:, names.index("moment_z_a")]
            shear = rows[:, names.index("shear_y")]
            t = f["time"][:]
            reaction, force = f["hinges/root/reaction_moment"][:, 2], f["hinges/root/reaction_force"][:, 1]
            self.assertGreater(np.abs(reaction).max(), 1)
            np.testing.assert_allclose(moment, -reaction, atol=1e-8 * np.abs(reaction).max())
            # The grid that the hinge holds has half the mass of an element, which no section carries.
            np.testing.assert_allclose(shear, -(force - MASS / 2 * 6.25 * np.cos(25 * t)), atol=1e-8 * np.abs(force).max())
            np.testing.assert_allclose(f["sensors/root moment"][:], moment, rtol=1e-12)
            # Modes alone are off: the static answer of what they leave out counts.
            with h5py.File(self.path("boom.h5")) as b:
                matrix = b["recovery/elements/CBAR/matrix"][0]
            alone = f["bodies/boom/eta"][:] @ matrix[names.index("shear_y")]
            self.assertGreater(np.abs(alone - shear).max(), 1e-3 * np.abs(shear).max())

    def test_spinning_beam_pulls_with_the_mass_outside(self):
        # Three bending modes know nothing of the axial force.
        self.reduce(3)
        omega = 6.0
        with self.run_system(hinge='type = "revolute"\naxis = [0.0, 0.0, 1.0]\nrate = 6.0', duration=0.02) as f:
            x = np.arange(N + 1) * H
            mass = np.full(N + 1, MASS)
            mass[-1] = MASS / 2 + 1.5
            for e in range(1, N + 1):
                rows = f[f"bodies/boom/recovery/CBAR/{e}"]
                expected = omega**2 * np.sum(mass[e:] * x[e:])
                self.assertAlmostEqual(rows[0, 0] / expected, 1, delta=1e-9)
            self.assertAlmostEqual(f["hinges/root/reaction_force"][0, 0] / -expected_root(mass, x, omega), 1, delta=1e-9)

    def test_tip_force_against_the_reaction_with_modes_left_out(self):
        self.reduce(4)
        force = toml(
            table("function", "kick", "sine", amplitude=20.0, frequency_hz=4.0),
            table("force", "tip", body="boom", node=9, force=[0.0, 1.0, 0.5], function="kick"))
        for body in ("recover = [1]\n", "recover = [1]\nmodes = 2\n"):
            with self.run_system(body=body, more=force) as f:
                self.assertEqual(list(f["bodies/boom/recovery/CBAR"]), ["1"])
                rows = f["bodies/boom/recovery/CBAR/1"][:]
                names = f["bodies/boom/recovery/CBAR/1"].attrs["description"]
                names = (names.decode() if isinstance(names, bytes) else names).split(", ")
                reaction = f["hinges/root/reaction_moment"][:]
                for axis, name in [(1, "moment_y_a"), (2, "moment_z_a")]:
                    np.testing.assert_allclose(rows[:, names.index(name)], -reaction[:, axis],
                                               atol=1e-8 * np.abs(reaction).max())

    def test_floating_body_under_a_load_of_unknown_value(self):
        """A free rod pulled at its end by an actuator, whose force is not known to the recovery: its residual vector has the
        axial forces, as a [[force]] gives them. Inertial loads answered on a support had the reaction as well."""
        deck = "SOL 103\nCEND\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-3,1.-7,1.-7,2.-7\n"
        deck += "".join(f"GRID,{i + 1},,{float(i)},0.,0.\n" for i in range(11))
        deck += "".join(f"CBAR,{i},1,{i},{i + 1},0.,0.,1.\n" for i in range(1, 11)) + "CONM2,99,6,,1.-3,,,,,\n,.1,,.1,,,.1\nENDDATA\n"
        self.write("rod.bdf", deck)
        expected = .05 + .1 * np.arange(10)
        pulls = {"actuator": table("function", "one", "constant", value=1.0)
                 + table("actuator", "pull", "force", body="boom", node=11, axis=[1.0, 0.0, 0.0], input="one"),
                 "force": table("force", "pull", body="boom", node=11, force=[1.0, 0.0, 0.0])}
        for frame in ("free", "mean", "node"):
            nodes = {"frame_nodes": [1]} if frame == "node" else {}
            self.write("rod.toml", toml(
                section("body", name="boom", deck="rod.bdf", frame=frame, interface=[1, 11], **nodes),
                section("body.modes", number=6, residual=["inertial", "interface"]), section("body.output", recover="all")))
            self.bough("reduce", "rod.toml", "-o", "boom.h5", "-q")
            for kind, pull in pulls.items():
                self.write("s.toml", toml(
                    table("body", "boom", file="boom.h5", recover=True, damping=0.5), table("hinge", "h", "free", child="boom"), pull,
                    section("simulation", duration=0.5, output_step=0.05)))
                self.bough("run", "s.toml", "-o", "r.h5", "-q")
                with h5py.File(self.path("r.h5")) as f:
                    found = np.array([f[f"bodies/boom/recovery/CBAR/{e}"][-1][0] for e in range(1, 11)])
                np.testing.assert_allclose(found, expected, atol=1e-4, err_msg=f"{frame} {kind}")

    def test_select_keeps_what_the_loads_do(self):
        self.reduce(6)
        static = self.read_static(make_deck())
        self.bough("select", "boom.h5", "--number", 2, "-o", "small.h5")
        names, modal, whole = self.solve_static_modes(np.array([300., 40., -25., 0, 0, 0]), path="small.h5")
        np.testing.assert_allclose(whole[:, names.index("moment_z_a")], static["moment_z_a"], rtol=1e-7, atol=1e-6)
        # And of the inertial loads: the cut of six modes is the reduction to two.
        with h5py.File(self.path("small.h5")) as f:
            kept = f["modes/frequency_hz"][:]
        small = self.read_rows(path="small.h5")[3]
        self.reduce(2)
        with h5py.File(self.path("boom.h5")) as f:
            if np.allclose(f["modes/frequency_hz"][:], kept, rtol=1e-6):
                own = self.read_rows()[3]
                np.testing.assert_allclose(small, own, rtol=1e-6, atol=1e-6 * np.abs(own).max())

    def test_preload_is_there_at_rest(self):
        deck = make_deck(preload="FORCE,5,9,,1.,777.,0.,0.\n")
        self.reduce(3, deck=deck, more="\n[body.preload]\nload_set = 5\n")
        ids, names, matrix, inertial, external, offset = self.read_rows()
        np.testing.assert_allclose(offset[:, names.index("axial"), 0], 777, rtol=1e-9)
        np.testing.assert_allclose(offset[:, names.index("stress_xx@C_a"), 0], 777 / A, rtol=1e-9)

    def test_what_cannot_be_recovered_is_named(self):
        self.reduce(3, recover="[1]")
        base = {"more": "", "duration": 0.1, "hinge": 'type = "fixed"'}
        self.write("s.toml", SYSTEM.format(**{**base, "body": "recover = [1, 5]\n"}))
        self.fails(1, "run", "s.toml", "-o", "r.h5", error="system.unknown-element", says=["element 5"])
        sensor = table("sensor", "m", "element", body="boom", element=1, component="moment_z")
        self.write("s.toml", SYSTEM.format(**{**base, "body": "", "more": sensor}))
        self.fails(1, "run", "s.toml", "-o", "r.h5", error="sensor.unknown-element", says=["moment_z_a"])
        self.write("s.toml", SYSTEM.format(**{**base, "body": "", "more": sensor.replace("element = 1\n", "")}))
        self.fails(1, "check", "s.toml", error="toml.missing-key")
        self.bough("reduce", "boom.bdf", "--modes", 2, "-o", "boom.h5")
        self.write("s.toml", SYSTEM.format(**{**base, "body": "recover = true\n"}))
        self.fails(1, "run", "s.toml", "-o", "r.h5", error="system.no-recovery")
        # A force at a node without locators: modes alone, which is said.
        self.bough("reduce", "boom.bdf", "--modes", 2, "--recover", "1", "-o", "boom.h5")
        force = table("force", "tip", body="boom", node=5, force=[0.0, 1.0, 0.0])
        self.write("s.toml", SYSTEM.format(**{**base, "body": "recover = true\n", "more": force}))
        self.assertIn("[system.recovery-loads]", self.bough("run", "s.toml", "-o", "r.h5", "-v").stderr)
        # Loads of an actuator are not those of the interface.
        self.reduce(2, recover="[1]")
        actuator = table("actuator", "fx", "force", body="boom", node=9, axis=[0.0, 1.0, 0.0])
        self.write("s.toml", SYSTEM.format(**{**base, "body": "recover = true\n", "more": actuator}))
        said = self.bough("check", "s.toml", "-v").stderr
        self.assertIn("answer to: fx", said)
        self.assertNotIn("add the node to [body] interface", said)

    def test_rows_have_their_names(self):
        self.reduce(3)
        sensor = table("sensor", "root", "element", body="boom", element=1)
        self.run_system(more=sensor).close()
        self.bough("plot", "r.h5", "--sensor", "root:moment_y_a", "-o", "a.svg")
        self.bough("plot", "r.h5", "--sensor", "/bodies/boom/recovery/CBAR/1:axial", "-o", "a.svg")
        self.bough("plot", "r.h5", "--sensor", "root:5", "-o", "a.svg")
        self.fails(1, "plot", "r.h5", "--sensor", "root:moment", "-o", "a.svg", error="cli.unknown-channel",
                   says=["its components are axial shear_y"])
        self.bough("export", "r.h5", "--to", "csv", "--channel", "root", "-o", "a.csv")
        with open(self.path("a.csv"), encoding="utf-8") as f:
            self.assertIn("sensors/root:axial,sensors/root:shear_y,", f.readline())
        linear = self.bough("linearize", "s.toml", "-o", "l.h5").stdout
        with h5py.File(self.path("l.h5")) as f:
            found = []
            f.visititems(lambda name, item: found.extend(item.asstr()[()].ravel().tolist())
                         if isinstance(item, h5py.Dataset) and item.dtype.kind == "O" else None)
        self.assertIn("root:moment_y_a", found, linear)

    def test_pinned_tip_needs_a_residual_mode(self):
        """Clamped and pinned under its weight: with normal modes alone the pin is too stiff, which is said."""
        static = self.read_static(make_deck(load="GRAV,2,,9.81,0.,.6,-.8\nSPC1,1,123,9\n"))
        pin = (f'[[constraint]]\nname = "pin"\ntype = "spherical"\nparent = "ground"\nparent_position = [{L}, 0.0, 0.0]\n'
               'child = "boom"\nchild_node = 9\n')
        deck = make_deck()
        errors = []
        for more in ["", 'residual = ["interface"]\n']:
            self.write("boom.bdf", deck)
            self.write("boom.toml", BODY.format(modes=2, recover='"all"').replace("[body.output]", more + "[body.output]"))
            self.bough("reduce", "boom.toml", "-o", "boom.h5")
            text = SYSTEM.format(body="recover = true\n", more=pin, duration=.1, hinge='type = "fixed"')
            self.write("s.toml", text + "gravity = [0.0, 5.886, -7.848]\n")
            said = self.bough("equilibrium", "s.toml", "-o", "e.h5").stderr
            with h5py.File(self.path("e.h5")) as f:
                g = f["bodies/boom/recovery/CBAR/1"]
                names = g.attrs["description"]
                names = (names.decode() if isinstance(names, bytes) else names).split(", ")
                found = g[()].ravel()[names.index("moment_z_a")]
            errors.append(abs(found / static["moment_z_a"][0] - 1))
            for verb in ("check", "equilibrium"):
                said = self.bough(verb, "s.toml").stderr
                self.assertEqual("[system.recovery-constraint]" in said, more == "", said)
        self.assertGreater(errors[0], .05)
        self.assertLess(errors[1], 1e-6)


def expected_root(mass, x, omega):
    return omega**2 * np.sum(mass * x)


if __name__ == "__main__":
    unittest.main()
