"""Propellant from outside: a burn resumed and linearized, slosh against formulas, units, messages."""
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import Bare, section, table, toml

XI = 1.8411837813406593

ROCKET = toml(
    section("parameters", fill=8.0),
    table("body", "stage", mass=2.0, cg=[0.4, 0.0, 0.0], inertia=[0.5, 3.0, 3.0],
          nodes=[{"id": 1, "position": [-1.0, 0.0, 0.0]}]),
    table("tank", "main", "cylinder", body="stage", mass="$fill", axis=[1.0, 0.0, 0.0], radius=0.5, height=2.0,
          density=8.0),
    table("function", "throttle", "step", value=30.0, at=0.5),
    table("actuator", "engine", "engine", body="stage", node=1, axis=[1.0, 0.0, 0.0], exhaust_velocity=5.0,
          exit_radius=0.2, tank="main", input="throttle"),
    table("sensor", "rate", "angular_velocity", body="stage"),
    table("hinge", "flight", "free", child="stage", rate=[0.3, 0.1, -0.2, 0.0, 0.0, 0.0]),
    section("simulation", duration=1.5, output_step=0.05, integrator="rk", relative_tolerance=1e-11,
            absolute_tolerance=1e-13))

SLOSH = toml(
    section("parameters", fill=Bare("{fill}")),
    table("body", "vehicle", mass=3000.0),
    table("tank", "lox", "{type}", body="vehicle", mass="$fill", radius=1.0, density=1000.0, slosh=True),
    "{height}\n",
    "{more}\n",
    table("hinge", "lateral", "{hinge}", child="vehicle"),
    section("simulation", duration=1.0, gravity=[0.0, 0.0, -9.81]))


def burn(body, tank, hinge, engine, thrust, simulation, place=(0.0, 0.0, -1.0)):
    """One body "b" with its tank "t" on a hinge "f", and an engine at node 1 that draws from the tank."""
    return toml(table("body", "b", **body, nodes=[{"id": 1, "position": place}]),
                table("tank", "t", body="b", **tank), table("hinge", "f", child="b", **hinge),
                table("actuator", "e", "engine", body="b", node=1, axis=[0.0, 0.0, 1.0], input="thrust", **engine, tank="t"),
                table("function", "thrust", **thrust), section("simulation", **simulation, integrator="rk"))


def make_origin(aside):
    return burn({"mass": 1.0, "cg": [0.0, -aside, 0.0], "inertia": [1.0, 1.0, 1.0]},
                {"kind": "table", "masses": [0.0, 100.0], "cg": [[0.0, -aside, 0.0], [0.0, -aside, 0.0]],
                 "inertia": [[0.0, 0.0, 0.0], [100.0, 100.0, 100.0]], "mass": 99.0},
                {"kind": "free", "position": [1, 0, 0, 0, 0.0, aside, 0.0], "rate": [0.0, 0.5, 0.0, 0.0, 0.0, 0.0]},
                {"exhaust_velocity": 1000.0}, {"kind": "constant", "value": 1000.0},
                {"duration": 50.0, "output_step": 1.0, "relative_tolerance": 1e-12, "absolute_tolerance": 1e-12},
                [0.0, -aside, -2.0])


def make_empty(start):
    return burn({"mass": 10.0, "inertia": [1.0, 1.0, 1.0]},
                {"kind": "sphere", "mass": 0.11, "radius": 0.3, "density": 1000.0}, {"kind": "free"},
                {"exhaust_velocity": 20.0}, {"kind": "sine", "amplitude": 3.0, "omega": 0.9, "offset": 4.0},
                {"start": start, "duration": 3.0}, [0.0, 0.1, -1.0])


COAST = burn({"mass": 500.0, "inertia": [200.0, 220.0, 150.0]},
             {"kind": "cylinder", "mass": 300.0, "position": [0.0, 0.0, 0.3], "radius": 0.5, "slosh_damping": 0.01,
              "slosh_acceleration": 2.5, "height": 1.5, "density": 700.0, "slosh": True},
             {"kind": "free", "rate": [0.1, 0.05, 0.5, 0, 0, 0]}, {"exhaust_velocity": 3000.0},
             {"kind": "pulse", "value": 2000.0, "at": 0.0, "width": 5.0}, {"duration": 200.0}, [0.0, 0.0, -1.5])


def make_hover(more=""):
    """A body that an engine holds up, by a controller of its height."""
    return toml(
        table("body", "b", mass=100.0, inertia=[30.0, 30.0, 20.0], nodes=[{"id": 1, "position": [0.0, 0.0, -1.0]}]),
        table("tank", "t", "cylinder", body="b", mass=50.0, radius=0.3, height=1.0, density=800.0),
        table("hinge", "f", "prismatic", child="b", axis=[0, 0, 1.0]),
        table("sensor", "z", "hinge_angle", hinge="f", coordinate=1),
        table("sensor", "v", "hinge_rate", hinge="f", coordinate=1),
        table("controller", "pid", "pid", inputs=["z"], rate="v", kp=3000.0, ki=800.0, kd=2500.0),
        table("actuator", "e", "engine", body="b", node=1, axis=[0, 0, 1.0], input="pid", lag=0.1, bias=1000.0),
        more + "\n",
        section("simulation", duration=5.0, gravity=[0, 0, -9.81], integrator="rk"))


class Propellant(ProgramTest):
    def test_a_burn_in_two_parts_is_the_burn(self):
        self.write("rocket.toml", ROCKET)
        self.bough("run", "rocket.toml", "-o", "whole.h5", "-q")
        self.write("short.toml", ROCKET.replace("duration = 1.5", "duration = 0.8"))
        self.bough("run", "short.toml", "-o", "parts.h5", "-q")
        self.bough("run", "rocket.toml", "-o", "parts.h5", "--resume", "-q")
        paths = ("/bodies/stage/angular_velocity", "/tanks/main/mass", "/momentum/out_angular", "/momentum/angular")
        for path, whole, parts in zip(paths, self.read_arrays("whole.h5", *paths), self.read_arrays("parts.h5", *paths)):
            np.testing.assert_allclose(parts, whole, atol=1e-9, err_msg=path)
        mass, angular, out = self.read_arrays("whole.h5", "/system_mass/mass", "/momentum/angular", "/momentum/out_angular")
        self.assertAlmostEqual(mass[-1], 10 - 6, places=9)
        total = angular + out
        self.assertLess(np.abs(total - total[0]).max(), 1e-10 * np.linalg.norm(total[0]))

    def test_a_mission_in_parts_goes_on_with_what_is_left(self):
        self.write("rocket.toml", ROCKET)
        self.bough("run", "rocket.toml", "-o", "whole.h5", "-q")
        self.write("first.toml", ROCKET.replace("duration = 1.5", "duration = 0.8"))
        self.bough("run", "first.toml", "-o", "first.h5", "-q")
        self.write("second.toml", ROCKET.replace("duration = 1.5", "start = 0.8\nduration = 0.7"))
        self.bough("run", "second.toml", "--start-from", "first.h5", "-o", "second.h5", "-q")
        paths = ("/bodies/stage/angular_velocity", "/tanks/main/mass", "/bodies/stage/position")
        for path, whole, second in zip(paths, self.read_arrays("whole.h5", *paths), self.read_arrays("second.h5", *paths)):
            np.testing.assert_allclose(second[-1], whole[-1], atol=1e-8, err_msg=path)

    def test_linear_models_have_the_mass_of_their_time(self):
        """A of a wobble about the spin axis while the engine burns: w' = -(J' flow + flow l²...) w of the formulas."""
        self.write("rocket.toml", ROCKET.replace("rate = [0.3, 0.1, -0.2", "rate = [0.0, 0.0, 0.0"))
        for fill in (8.0, 4.0):
            self.bough("linearize", "rocket.toml", "--set", f"fill={fill}", "--at", "1.0", "-o", "l.h5")
            with h5py.File(self.path("l.h5")) as f:
                A, names = f["/A"][()], [s.decode() for s in f["/states/name"][()]]
            content, flow = fill - 3.0, 6.0
            height = content / (8 * math.pi * 0.25)
            total, first = 2 + content, 2 * 0.4 + content * height / 2
            cg = first / total
            about_bo = 3 + 2 * 0.16 + content * (0.25 * 0.25 + height**2 / 3)
            inertia = about_bo - total * cg**2
            # Moment about the centre of mass: that about Bo, minus the arm times the Coriolis force.
            moment_bo = flow * (1.0 + 0.25 * 0.04 - (0.25 * 0.25 + height**2))
            force = 2 * flow * (-1.0 - height)  # along, times the rate
            expected = -(moment_bo - cg * force) / inertia
            row = [i for i, name in enumerate(names) if "flight:ry" in name][-1]
            self.assertAlmostEqual(A[row, row], expected, delta=1e-6 * abs(expected))

    def test_damping_is_the_same_whatever_the_origin_is(self):
        """ω0 (m/m0)^(l²/k² - 1): k 1, l 2, and a body frame that is 0, 1 and 3 aside of the line from tank to nozzle."""
        for aside in (0.0, 1.0, -3.0):
            self.write("origin.toml", make_origin(aside))
            self.bough("run", "origin.toml", "-o", "o.h5", "-q")
            rate, mass, linear, out = self.read_arrays("o.h5", "/bodies/b/angular_velocity", "/system_mass/mass",
                                                   "/momentum/angular", "/momentum/out_angular")
            np.testing.assert_allclose(rate[:, 1], 0.5 * (mass / 100) ** 3, atol=1e-9, err_msg=str(aside))
            self.assertLess(np.abs(rate[:, [0, 2]]).max(), 1e-9)
            total = linear + out
            self.assertLess(np.abs(total - total[0]).max(), 1e-9 * np.abs(linear).max())
            self.bough("linearize", "origin.toml", "-o", "l.h5", "-q")
            with h5py.File(self.path("l.h5")) as f:
                A, names = f["/A"][()], [s.decode() for s in f["/states/name"][()]]
            row = [i for i, name in enumerate(names) if "f:ry" in name][-1]
            # of ω = ω0 (m/m0)³ with a flow of 1 from 100
            self.assertAlmostEqual(A[row, row], -0.03, delta=1e-8, msg=str(aside))

    def test_control_starts_from_an_equilibrium_beside_a_tank(self):
        """The integral of the controller carries the weight: the start is at rest and stays there."""
        self.write("hover.toml", make_hover())
        self.bough("equilibrium", "hover.toml", "-o", "e.h5", "-q")
        self.bough("run", "hover.toml", "--start-from", "e.h5", "-o", "r.h5", "-q")
        height, thrust = self.read_arrays("r.h5", "/hinges/f/q", "/actuators/e")
        self.assertLess(np.abs(height).max(), 1e-9)
        np.testing.assert_allclose(thrust[:, 0], 150 * 9.81, rtol=1e-9)

    def test_a_tank_that_ran_empty_is_a_start(self):
        self.write("first.toml", make_empty(0.0))
        self.bough("run", "first.toml", "-o", "first.h5", "-q")
        mass, velocity = self.read_arrays("first.h5", "/tanks/t/mass", "/bodies/b/velocity")
        self.assertEqual(mass[-1, 0] if mass.ndim > 1 else mass[-1], 0)
        self.write("second.toml", make_empty(3.0))
        self.bough("run", "second.toml", "--start-from", "first.h5", "-o", "second.h5", "-q")
        mass, thrust, after = self.read_arrays("second.h5", "/tanks/t/mass", "/actuators/e", "/bodies/b/velocity")
        self.assertEqual(np.abs(mass).max(), 0)
        self.assertEqual(np.abs(thrust[:, 0]).max(), 0)
        np.testing.assert_allclose(after[-1], velocity[-1], atol=1e-9)
        self.bough("linearize", "second.toml", "--start-from", "first.h5", "-o", "l.h5", "-q")

    def test_equilibrium_holds_what_a_burning_engine_has_used(self):
        """Thrust is the weight, of a pid; a spring takes the rest of a constant one; with and without tank."""
        for more in ("exhaust_velocity = 2000.0", 'exhaust_velocity = 2000.0\ntank = "t"'):
            self.write("hover.toml", make_hover(more))
            self.bough("equilibrium", "hover.toml", "-o", "e.h5", "-q")
            thrust, height = self.read_arrays("e.h5", "/actuators/e", "/hinges/f/q")
            self.assertAlmostEqual(thrust[-1, 0], 150 * 9.81, delta=1e-6)
            self.assertAlmostEqual(height.flat[-1], 0, delta=1e-9)
            self.bough("linearize", "hover.toml", "--equilibrium", "-o", "l.h5", "-q")
            stand = make_hover(more)
            stand = stand[:stand.index("[[controller]]")] + stand[stand.index("[[actuator]]"):]
            self.write("stand.toml", stand.replace('input = "pid"\n', "").replace("bias = 1000.0", "bias = 1500.0")
                       .replace('child = "b"\n', 'child = "b"\nstiffness = 1e4\ndamping = 100.0\n'))
            self.bough("equilibrium", "stand.toml", "-o", "e.h5", "-q")
            height, = self.read_arrays("e.h5", "/hinges/f/q")
            self.assertAlmostEqual(height.flat[-1], (1500 - 150 * 9.81) / 1e4, delta=1e-9)

    def find_frequency(self, *arguments):
        self.bough("linearize", "slosh.toml", *arguments, "-o", "l.h5", "-q")
        with h5py.File(self.path("l.h5")) as f:
            poles = np.linalg.eigvals(f["/A"][()])
        return max(poles, key=lambda p: p.imag)

    def test_slosh_has_the_frequency_and_mass_of_the_formulas(self):
        """Cylinder of SP-106: R 1, g 9.81, h 2 and 0.5; on a still vehicle, and on one that floats sideways."""
        for depth, omega, share, length in ((2.0, 4.247253, 0.226967, 0.543817), (0.5, 3.621633, 0.660108, 0.747929)):
            mass = 1000 * math.pi * depth
            self.write("slosh.toml", SLOSH.format(fill=mass, type="cylinder", height="height = 3.0", hinge="fixed",
                                                  more="slosh_damping = 0.01"))
            pole = self.find_frequency()
            self.assertAlmostEqual(abs(pole), omega, delta=1e-6)
            self.assertAlmostEqual(-pole.real / abs(pole), 0.01, delta=1e-9)
            self.assertAlmostEqual(abs(self.find_frequency("--set", f"fill={mass / 2}")),
                                   math.sqrt(9.81 * XI * math.tanh(XI * depth / 2)), delta=1e-6)
            self.write("slosh.toml", SLOSH.format(fill=mass, type="cylinder", height="height = 3.0", more="",
                                                  hinge='prismatic"\naxis = [1.0, 0.0, 0.0]\nparent = "ground'))
            pendulum = share * mass
            expected = omega * math.sqrt((3000 + mass) / (3000 + mass - pendulum))
            self.assertAlmostEqual(abs(self.find_frequency()), expected, delta=2e-5)
            self.assertAlmostEqual(9.81 / omega**2, length, delta=1e-6)

    def test_a_sphere_sloshes_as_the_tables_say(self):
        """ω² R/g of McIver (1989): depth over radius 0.2, 1, 1.6; the hinge is the centre."""
        for depth, value in ((0.2, 1.0723), (1.0, 1.5602), (1.6, 2.6864)):
            mass = 1000 * math.pi * depth**2 * (3 - depth) / 3
            self.write("slosh.toml", SLOSH.format(fill=mass, type="sphere", height="", hinge="fixed", more=""))
            self.assertAlmostEqual(abs(self.find_frequency())**2 / 9.81, value, delta=2e-4)

    def test_a_tank_that_drains_to_its_pendulum_is_named(self):
        engine = ROCKET[ROCKET.index("[[function]]"):ROCKET.index("[[sensor]]")].replace('"stage"', '"vehicle"').replace(
            '"main"', '"lox"').replace("value = 30.0", "value = 4000.0")
        system = SLOSH.format(fill=1000., type="cylinder", height="height = 3.0", hinge="fixed", more="")
        self.write("drain.toml", system.replace("mass = 3000.0", "mass = 3000.0\nnodes = [{id = 1, position = [0.0, 0.0, -1.0]}]")
                   + engine)
        self.assertIn("[run.slosh-drained]", self.bough("run", "drain.toml", "-o", "d.h5").stderr)

    def test_slosh_without_acceleration_names_its_tank(self):
        """After cutoff nothing pulls the pendulum back: it turns until the axes of its hinge meet."""
        self.write("coast.toml", COAST)
        error = self.bough("run", "coast.toml", "-o", "c.h5", code=3).stderr
        self.assertIn("[run.stalled]", error)
        self.assertRegex(error, r"the slosh of tank 't' has an amplitude of \d\d+ deg")

    def test_units_are_converted_and_the_motion_stays(self):
        self.write("rocket.toml", ROCKET)
        self.bough("convert", "rocket.toml", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.toml")
        for name in ("rocket", "mm"):
            self.bough("run", f"{name}.toml", "-o", f"{name}.h5", "-q")
        (w, m), (w_mm, m_mm) = (self.read_arrays(f"{n}.h5", "/bodies/stage/angular_velocity", "/tanks/main/mass")
                                for n in ("rocket", "mm"))
        np.testing.assert_allclose(w_mm, w, atol=1e-9)
        np.testing.assert_allclose(1e3 * m_mm, m, rtol=1e-9)

    def test_a_function_that_no_tank_follows_is_named(self):
        """Emptier than empty at the start, fuller than full, without a rate: three messages, not one for all."""
        parts = (ROCKET[:ROCKET.index("[[function]]")], ROCKET[ROCKET.index("[[hinge]]"):])
        tank = parts[0].replace('mass = "$fill"', 'function = "left"')
        for function, message in (
                ({"type": "constant", "value": -5.0}, "is emptier than empty at the start: its mass is -5;"),
                ({"type": "constant", "value": 80.0}, "a mass of 80 at the start, and holds 12.5664;"),
                ({"type": "expression", "expression": "8 - t"}, "of which the rate, the flow, is not known;")):
            self.write("bad.toml", tank + table("function", "left", **function) + parts[1])
            self.assertIn(message, self.bough("check", "bad.toml", code=1).stderr)

    def test_what_cannot_be_is_named_with_its_line(self):
        for old, new, error in (
                ("fill = 8.0", "fill = 80.0", "system.bad-tank"),
                ('tank = "main"', 'tank = "mian"', "did you mean 'main'"),
                ("radius = 0.5\nheight", "radius = 0.5\nbore = 0.1\nheight", "toml.conflicting-keys"),
                ("density = 8.0", "", "toml.missing-key"),
                ('type = "cylinder"', 'type = "cube"', "toml.")):
            self.write("bad.toml", ROCKET.replace(old, new))
            errors = self.bough("check", "bad.toml", code=1).stderr
            self.assertIn(error, errors)
            self.assertRegex(errors, r"bad\.toml:\d+")


if __name__ == "__main__":
    unittest.main()
