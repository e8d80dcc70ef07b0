"""FMUs against the program: Co-Simulation and Model Exchange of FMI 2.0 and 3.0 move as `bough run` moves the system."""
import ctypes
import os
import shutil
import subprocess
import threading
import unittest
import zipfile

import h5py
import numpy as np
import scipy.io

from embed_test import ARM
from fmu_importer import ERROR, REAL, SIZE, Failed, Fmu, Instance, MeRun
from support import PROGRAM, SOURCE, ProgramTest, get_astray

# x'' = push / mass from rest; an event that ends the run.
SLIDE = """[parameters]
mass = 2.0
[[body]]
name = "bob"
mass = "$mass"
inertia = [1.0, 1.0, 1.0]
[[hinge]]
name = "slide"
type = "prismatic"
child = "bob"
axis = [1.0, 0.0, 0.0]
[[sensor]]
name = "x"
type = "position"
body = "bob"
[[input]]
name = "push"
dims = "F"
start = 1.0
[[actuator]]
name = "motor"
type = "hinge"
hinge = "slide"
input = "push"
[[event]]
name = "there"
signal = "x:x"
value = 1.0
action = "stop"
[simulation]
duration = 10.0
output_step = 0.1
integrator = "rk4"
step = 0.01
"""
# Two links with a lag of a controller and one of a sensor.
CHAIN = """[[body]]
name = "a"
mass = 2.0
cg = [0.5, 0.0, 0.0]
inertia = [0.01, 0.17, 0.17]
[[body]]
name = "b"
mass = 1.0
cg = [0.3, 0.0, 0.1]
inertia = [0.01, 0.07, 0.07]
[[hinge]]
name = "h1"
type = "revolute"
child = "a"
axis = [0.0, 0.0, 1.0]
position = [0.3]
damping = [0.1]
[[hinge]]
name = "h2"
type = "revolute"
parent = "a"
parent_position = [1.0, 0.0, 0.0]
child = "b"
axis = [0.0, 0.0, 1.0]
position = [0.4]
stiffness = [3.0]
[[input]]
name = "torque"
dims = "F L"
start = 0.7
[[input]]
name = "target"
dims = "1"
[[sensor]]
name = "upper"
type = "hinge_angle"
hinge = "h1"
[[sensor]]
name = "rate"
type = "hinge_rate"
hinge = "h2"
[[sensor]]
name = "slow"
type = "hinge_angle"
hinge = "h2"
lag = 0.05
[[sensor]]
name = "shake"
type = "accelerometer"
body = "b"
[[sensor]]
name = "tip"
type = "position"
body = "b"
[[controller]]
name = "error"
type = "sum"
inputs = ["target", "upper"]
weights = [1.0, -1.0]
[[controller]]
name = "lag"
type = "transfer_function"
inputs = ["error"]
numerator = [4.0]
denominator = [0.1, 1.0]
[[controller]]
name = "sum"
type = "sum"
inputs = ["lag", "torque"]
[[actuator]]
name = "motor"
type = "hinge"
hinge = "h1"
input = "sum"
[simulation]
duration = 1.0
output_step = 0.01
integrator = "rk4"
step = 0.002
gravity = [0.0, -9.81, 0.0]
"""
# A hull that flies and carries an arm: actuators and sensors of every kind.
DRIVEN = """[[body]]
name = "hull"
mass = 5.0
cg = [0.1, 0.0, 0.05]
inertia = [1.0, 1.2, 1.5]
[[body]]
name = "arm"
mass = 1.0
cg = [0.3, 0.02, 0.0]
inertia = [0.01, 0.07, 0.07]
nodes = [{id = 1, position = [0.6, 0.0, 0.0]}]
[[hinge]]
name = "float"
type = "free"
child = "hull"
position = [0.9, 0.1, 0.3, 0.2, 0.2, 0.1, 0.9]
[[hinge]]
name = "joint"
type = "revolute"
parent = "hull"
child = "arm"
axis = [0.0, 0.0, 1.0]
[[function]]
name = "wave"
type = "sine"
amplitude = 1.0
omega = 3.0
""" + "".join(f'[[input]]\nname = "i{k}"\nstart = {0.3 + 0.1 * k}\n' for k in range(1, 11)) + """
[[sensor]]
name = "spin"
type = "gyro"
body = "hull"
lag = 0.1
[[sensor]]
name = "turned"
type = "integrating_gyro"
body = "hull"
[[sensor]]
name = "held"
type = "gyro"
body = "arm"
sample_time = 0.1
[[sensor]]
name = "attitude"
type = "quaternion"
body = "arm"
[[sensor]]
name = "seen"
type = "position"
body = "arm"
node = 1
relative_to = "hull"
frame = "hull"
[[sensor]]
name = "drift"
type = "velocity"
body = "arm"
node = 1
relative_to = "hull"
frame = "hull"
[[sensor]]
name = "far"
type = "distance"
body = "arm"
node = 1
target = [3.0, 1.0, 0.0]
[[sensor]]
name = "felt"
type = "hinge_moment"
hinge = "joint"
[[sensor]]
name = "push"
type = "accelerometer"
body = "arm"
lag = 0.05
[[sensor]]
name = "pull"
type = "accelerometer"
body = "hull"
[[controller]]
name = "held_law"
type = "gain"
inputs = ["i1"]
gain = 2.0
sample_time = 0.1
[[controller]]
name = "late"
type = "gain"
inputs = ["pull:x"]
gain = 2.0
[[controller]]
name = "turns"
type = "relay"
inputs = ["i2"]
on = 0.9
off = 0.8
value = 1.0
[[controller]]
name = "mixed"
type = "expression"
inputs = ["i3", "spin:z"]
expression = "u1*u2 + sin(t)"
[[controller]]
name = "slow"
type = "transfer_function"
inputs = ["late"]
numerator = [1.0]
denominator = [0.2, 1.0]
[[actuator]]
name = "wheel"
type = "wheel"
body = "hull"
axis = [0.0, 1.0, 0.0]
inertia = 0.02
viscous = 0.01
momentum = 0.4
input = "i4"
[[actuator]]
name = "cmg"
type = "cmg"
body = "hull"
gimbal_axis = [1.0, 0.0, 0.0]
spin_axis = [0.0, 0.0, 1.0]
momentum = 0.7
lag = 0.2
input = "i5"
[[actuator]]
name = "motor"
type = "motor"
hinge = "joint"
torque_constant = 0.5
resistance = 2.0
lag = 0.1
input = "i6"
[[actuator]]
name = "brake"
type = "brake"
hinge = "joint"
stick_rate = 0.1
input = "i7"
[[actuator]]
name = "thruster"
type = "force"
body = "arm"
node = 1
axis = [0.0, 1.0, 0.2]
input = "mixed"
[[actuator]]
name = "jet"
type = "jet"
body = "hull"
axis = [1.0, 0.0, 0.0]
thrust = 2.0
input = "i8"
[[actuator]]
name = "valve"
type = "force"
body = "hull"
axis = [1.0, 0.5, 0.0]
input = "held_law"
[[actuator]]
name = "trim"
type = "moment"
body = "hull"
axis = [1.0, 0.5, 0.0]
input = "turns"
[[force]]
name = "tug"
body = "arm"
force = [0.0, 0.0, 1.0]
signal = "i9"
[[force]]
name = "gust"
body = "hull"
force = [0.1, 0.0, 0.0]
function = "wave"
[[event]]
name = "near"
signal = "far"
value = 1.0
[simulation]
duration = 1.0
output_step = 0.01
integrator = "rk4"
step = 0.002
gravity = [0.0, 0.0, -1.0]
"""
TIGHT = 'integrator = "rk"\nrelative_tolerance = 1e-12\nabsolute_tolerance = 1e-13\n'
COMPONENTS = {"": 0, "x": 0, "y": 1, "z": 2, "angle1": 0, "angle2": 1, "angle3": 2}


def with_integrator(text, integrator, duration=None, output_step=None):
    """The system with another [simulation]; gravity and the like stay."""
    head, _, tail = text.partition("[simulation]")
    drop = ["integrator", "step", "relative_tol", "absolute_tol", "rk_order", "energy_error_limit"]
    drop += ["duration"] if duration else []
    drop += ["output_step"] if output_step else []
    lines = [line for line in tail.splitlines() if not line.startswith(tuple(drop))]
    more = (f"duration = {duration}\n" if duration else "") + (f"output_step = {output_step}\n" if output_step else "")
    return head + "[simulation]\n" + integrator + more + "energy_error_limit = 10.0\n" + "\n".join(lines) + "\n"


class FmuTest(ProgramTest):
    def export(self, system, version=3, *more, name="one.fmu"):
        self.bough("export", system, "--to", "fmu", "--fmi", version, "-o", name, *more)
        folder = self.path("unpacked-" + str(len(os.listdir(self.folder))))
        return Fmu(self.path(name), folder)

    def make(self, fmu, kind, **more):
        instance = Instance(fmu, kind, **more)
        self.addCleanup(lambda: instance.handle and instance.close())
        return instance

    def run_reference(self, system, names):
        """Times, and samples of the outputs."""
        self.bough("run", system, "-o", "reference.h5")
        with h5py.File(self.path("reference.h5")) as f:
            t, columns = f["time"][:], []
            for name in names:
                sensor, _, component = name.partition(":")
                columns.append(f["sensors/" + sensor][:].reshape(len(t), -1)[:, COMPONENTS[component]])
        return t, np.column_stack(columns)

    def compare_cs(self, system, version, tolerance=0.0, **more):
        fmu = self.export(system, version)
        outputs = fmu.list("output")
        t, expected = self.run_reference(system, outputs)
        instance = self.make(fmu, "cs", **more)
        instance.initialize(stop=t[-1])
        if more.get("event_mode"):
            instance.update_discrete()
            instance.call("EnterStepMode")
        np.testing.assert_allclose(instance.get(outputs), expected[0], rtol=tolerance, atol=tolerance)
        for k in range(1, len(t)):
            terminated, reached = instance.step(t[k - 1], t[k] - t[k - 1])
            self.assertEqual((terminated, round(reached, 9)), (False, round(t[k], 9)))
            np.testing.assert_allclose(instance.get(outputs), expected[k], rtol=tolerance, atol=tolerance, err_msg=str(t[k]))
        instance.call("Terminate")

    def compare_me(self, system, version, tolerance=1e-8):
        fmu = self.export(system, version)
        outputs = fmu.list("output")
        t, expected = self.run_reference(system, outputs)
        instance = self.make(fmu, "me")
        instance.initialize(stop=t[-1])
        run = MeRun(instance)
        for k in range(1, len(t) - 1):
            run.advance(t[k])
            np.testing.assert_allclose(instance.get(outputs), expected[k], rtol=tolerance, atol=tolerance, err_msg=str(t[k]))
        instance.call("Terminate")
        return run

    # Numbers

    def test_contacts_relays_samples_and_noise(self):
        self.write("arm.toml", ARM)
        self.write("tight.toml", with_integrator(ARM, TIGHT))
        for version in (2, 3):
            with self.subTest(version=version):
                self.compare_cs("arm.toml", version)
                run = self.compare_me("tight.toml", version)
                self.assertGreater(run.num_state_events, 3)
                self.assertGreater(run.num_time_events, 200)
        self.compare_cs("arm.toml", 3, event_mode=True)

    def test_examples_with_flexible_bodies(self):
        for example, body, system, duration, output_step in (("robot-arm", "arm", "robot", 0.3, 2e-3),
                                                             ("satellite", "wing", "pointing", 3.0, 0.05)):
            with self.subTest(example=example):
                self.bough("init", example)
                folder = os.path.join(example, "")
                self.bough("reduce", folder + body + ".toml", "-o", folder + body + ".h5")
                with open(self.path(folder + system + ".toml"), encoding="utf-8") as f:
                    text = f.read()
                fixed = 'integrator = "rk4"\nstep = 2.5e-4\n'
                self.write(folder + "fixed.toml", with_integrator(text, fixed, duration, output_step))
                self.write(folder + "tight.toml", with_integrator(text, TIGHT, duration, output_step))
                for version in (2, 3):
                    self.compare_cs(folder + "fixed.toml", version)
                self.compare_me(folder + "tight.toml", 3 if example == "robot-arm" else 2)

    def test_adaptive_methods_agree_to_their_tolerance(self):
        plain = ARM.replace("noise_density = 0.01\nseed = 3\n", "")
        self.write("arm.toml", with_integrator(plain, 'integrator = "adams"\n'))
        self.compare_cs("arm.toml", 3, tolerance=2e-5)

    # Variables

    def test_parameters_are_set_before_the_initialization(self):
        self.write("slide.toml", SLIDE)
        for version in (2, 3):
            for kind in ("cs", "me"):
                fmu = self.export("slide.toml", version)
                self.assertEqual(fmu.list("parameter"), ["mass"])
                self.assertEqual(fmu.list("input"), ["push"])
                self.assertEqual(float(fmu.variables["mass"][2]), 2.0)
                instance = self.make(fmu, kind)
                np.testing.assert_equal(instance.get(["mass", "push"]), [2, 1])
                instance.set(["mass"], [4.0])
                instance.enter_initialization()
                instance.set(["push"], [3.0])
                derivative = instance.get(["der(" + fmu.states[1] + ")"])
                np.testing.assert_allclose(derivative, [3 / 4], rtol=1e-14)
                instance.call("ExitInitializationMode")
                with self.assertRaisesRegex(Failed, "fixed parameter"):
                    instance.set(["mass"], [5.0])
                if kind == "cs":
                    instance.step(0, 1)
                else:
                    MeRun(instance).advance(1)
                np.testing.assert_allclose(instance.get(["x:x"]), [3 / 8], rtol=1e-9)
                instance.call("Reset")
                np.testing.assert_equal(instance.get(["mass", "push"]), [2, 1])

    def test_set_gives_the_start_values(self):
        self.write("slide.toml", SLIDE)
        fmu = self.export("slide.toml", 3, "--set", "mass=8")
        self.assertEqual(float(fmu.variables["mass"][2]), 8.0)
        instance = self.make(fmu, "cs")
        instance.initialize()
        instance.step(0, 2)
        np.testing.assert_allclose(instance.get(["x:x"]), [1 / 4], rtol=1e-12)

    def test_inputs_count_from_where_they_are_set(self):
        self.write("slide.toml", SLIDE)
        for version in (2, 3):
            fmu = self.export("slide.toml", version)
            for kind in ("cs", "me"):
                instance = self.make(fmu, kind)
                instance.initialize()
                if kind == "cs":
                    instance.step(0, 0.5)
                    instance.set(["push"], [-1.0])
                    instance.step(0.5, 0.5)
                else:
                    run = MeRun(instance)
                    run.advance(0.5)
                    instance.set(["push"], [-1.0])
                    run.advance(1.0)
                np.testing.assert_allclose(instance.get(["x:x"]), [0.125], rtol=1e-9)

    def test_outputs_are_chosen_by_output_too(self):
        self.write("slide.toml", SLIDE)
        fmu = self.export("slide.toml", 3, "--output", "x:x", "--output", "/hinges/slide/qdot")
        self.assertEqual(fmu.list("output"), ["x:x", "/hinges/slide/qdot"])
        self.fails(2, "export", "slide.toml", "--to", "fmu", "-o", "a.fmu", "-o", "b.fmu", error="cli.usage")

    def test_outputs_are_chosen(self):
        self.write("arm.toml", ARM)
        self.assertEqual(self.export("arm.toml").list("output"), ["angle", "tip:x", "tip:y", "tip:z"])
        chosen = self.export("arm.toml", 3, "--channel", "/hinges/h1/q:1", "--channel", "tip", "--channel", "law", "--channel", "tip:x")
        self.assertEqual(chosen.list("output"), ["/hinges/h1/q", "tip:x", "tip:y", "tip:z", "/controllers/law"])
        self.fails(1, "export", "arm.toml", "--to", "fmu", "-o", "a.fmu", "--channel", "tipp:x", says=["'tip:x'"], error="fmu.output")

    def test_names_are_unique_and_escaped(self):
        self.write("slide.toml", SLIDE.replace("[parameters]\nmass = 2.0", '[parameters]\nmass = 2.0\n"x:x" = 1.0').replace(
            '"bob"', '"<b & \'c\'>"').replace("inertia = [1.0, 1.0, 1.0]", 'inertia = ["$x:x", 1.0, 1.0]'))
        for version in (2, 3):
            fmu = self.export("slide.toml", version)
            self.assertIn("x:x (2)", fmu.list("output"))
            self.assertTrue(any("<b & 'c'>" in name for name in fmu.states), fmu.states)

    def test_units_follow_from_dimensions(self):
        free = ('[[body]]\nname = "flyer"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n[[sensor]]\nname = "attitude"\ntype = "quaternion"\n'
                'body = "flyer"\n[[sensor]]\nname = "spin"\ntype = "gyro"\nbody = "flyer"\n[simulation]')
        self.write("chain.toml", "[parameters]\nk = 3.0\n" + CHAIN.replace("[3.0]", '["$k"]').replace("[simulation]", free))
        newton, second = 0.45359237 * 9.80665, 1.0
        for version in (2, 3):
            fmu = self.export("chain.toml", version)
            q1, q2 = fmu.states[:2]
            self.assertEqual(fmu.units, {"rad": {"rad": 1}})
            self.assertEqual({name for name, unit in fmu.unit_of.items() if unit}, {q1, q2, "upper", "slow"})
            for text, length, force, time, of in [("m-kg-s", 1, 1, 1, ("m", "N", "s", "kg")),
                                                  ("mm-N-tonne", 1e-3, 1, 1, ("mm", "N", "s", "tonne")),
                                                  ("in-lbf-s", 0.0254, newton, second, ("in", "lbf", "s", "slinch")),
                                                  ("km-kg-h", 1e3, None, 3600, ("km", None, "h", "kg"))]:
                fmu = self.export("chain.toml", version, "--units", text)
                m, n, s, kg = of
                torque = f"{n}.{m}" if n else f"{kg}.{m}2/{s}2"
                work = fmu.states[-2]
                flyer = [name for name in fmu.states if "flyer" in name]
                expected = {"torque": torque, "upper": "rad", "rate": f"rad/{s}", "shake:x": f"{m}/{s}2", "tip:x": m, "k": None,
                            "target": None, "attitude:1": None, "spin:x": f"rad/{s}", q1: "rad", "der(" + q1 + ")": f"rad/{s}",
                            fmu.derivatives[fmu.states.index(flyer[-1])]: f"{m}/{s}2", flyer[0]: None, flyer[4]: m, work: torque,
                            "der(" + work + ")": f"{kg}.{m}2/{s}3"}
                self.assertEqual({name: fmu.unit_of[name] for name in expected}, expected)
                if version == 3:
                    self.assertEqual(fmu.unit_of["time"], s)
                factor = length * force if force else length ** 2 / time ** 2
                got = fmu.units[torque]
                self.assertEqual({k: v for k, v in got.items() if k != "factor"}, {"kg": 1, "m": 2, "s": -2})
                self.assertAlmostEqual(got.get("factor", 1) / factor, 1, delta=1e-12)
                self.assertEqual({k: v for k, v in fmu.units[f"rad/{s}"].items() if k != "factor"}, {"rad": 1, "s": -1})
        self.fails(1, "export", "chain.toml", "--to", "fmu", "--units", "m-kg-parsec", "-o", "a.fmu", error="cli.bad-units")

    # Dependencies and directional derivatives

    def prepare_examples(self, *prefixes):
        """The system files of all examples, with their bodies reduced."""
        root = os.path.join(SOURCE, "data/examples")
        for example in sorted(os.listdir(root)):
            if not example.startswith(prefixes or "ex"):
                continue
            shutil.copytree(os.path.join(root, example), self.path(example))
            names = sorted(n for n in os.listdir(self.path(example)) if n.endswith(".toml"))
            texts = {}
            for name in names:
                with open(self.path(os.path.join(example, name)), encoding="utf-8") as f:
                    texts[name] = f.read()
            systems = [name for name in names if "[simulation]" in texts[name]]
            for name in names if systems else []:
                if name not in systems and "[body]" in texts[name]:
                    self.bough("reduce", os.path.join(example, name), "-o", os.path.join(example, name[:-5] + ".h5"))
            yield from (os.path.join(example, name) for name in systems)

    def list_channels(self, system):
        """--channel for all that the results of a system contain."""
        with open(self.path(system), encoding="utf-8") as f:
            text = with_integrator(f.read(), 'integrator = "rk4"\nstep = 1e-5\n', 2e-5, 1e-5)
        self.bough("run", self.write(os.path.join(os.path.dirname(system), "short.toml"), text), "-o", "channels.h5")
        paths = []
        with h5py.File(self.path("channels.h5")) as f:
            f.visititems(lambda name, item: paths.append("/" + name) if isinstance(item, h5py.Dataset) else None)
        groups = ("/sensors/", "/controllers/", "/actuators/", "/hinges/", "/bodies/", "/energy/", "/momentum/", "/forces/")
        return [word for path in paths if path.startswith(groups) for word in ("--channel", path)]

    def start_me(self, fmu, seed=1):
        """An instance in continuous time at a state without symmetries, and that state."""
        instance = self.make(fmu, "me")
        instance.initialize()
        instance.update_discrete()
        x = instance.states()
        instance.call("EnterContinuousTimeMode")
        random = np.random.default_rng(seed)
        return instance, x + 0.02 * random.standard_normal(len(x)), random

    def difference(self, instance, t, x, unknowns, direction_x, inputs, direction_u, h):
        """Central difference of outputs and derivatives by the functions of the importer."""
        sides = []
        for side in (h, -h):
            instance.put(t, x + side * direction_x)
            instance.set(list(inputs), np.array(list(inputs.values())) + side * direction_u)
            sides.append(instance.get(unknowns))
        instance.put(t, x)
        instance.set(list(inputs), list(inputs.values()))
        return (sides[0] - sides[1]) / (2 * h), np.maximum(*np.abs(sides))

    def check_dependencies(self, fmu):
        """No known with an effect is missing. Returns the share of pairs that are not listed."""
        instance, x, random = self.start_me(fmu)
        unknowns = fmu.list("output") + fmu.derivatives
        inputs = {name: value for name, value in zip(fmu.list("input"), instance.get(fmu.list("input")) + random.standard_normal())}
        knowns = fmu.states + list(inputs)
        missing, total = 0, 0
        for j, known in enumerate(knowns):
            direction = np.zeros(len(knowns))
            direction[j] = 1
            h = 1e-4
            change, size = self.difference(instance, float(fmu.root.find("DefaultExperiment").get("startTime")), x, unknowns, direction[:len(x)], inputs, direction[len(x):], h)
            for unknown, value, large in zip(unknowns, change, size):
                listed = fmu.dependencies[unknown]
                total += 1
                if listed is not None and known not in listed:
                    missing += 1
                    self.assertLess(abs(value) * h, 1e-12 * max(1, large), f"d({unknown})/d({known})")
        return missing / max(1, total)

    def test_dependencies_contain_all_that_has_an_effect(self):
        self.write("arm.toml", ARM)
        self.write("slide.toml", SLIDE)
        self.write("chain.toml", CHAIN)
        self.write("driven.toml", DRIVEN)
        sparse = {}
        for system in ["arm.toml", "slide.toml", "chain.toml", "driven.toml", *self.prepare_examples()]:
            with self.subTest(system=system):
                for version in (3,) if system.startswith("ex") else (2, 3):
                    sparse[system] = self.check_dependencies(self.export(system, version, *self.list_channels(system)))
        self.assertGreater(min(sparse.values()), 0.2, sparse)

    def test_dependencies_are_sparse(self):
        self.write("slide.toml", SLIDE)
        self.write("chain.toml", CHAIN)
        for version in (2, 3):
            time = {"time"} if version == 3 else set()
            fmu = self.export("slide.toml", version, "--channel", "x:x", "--channel", "/energy/work")
            q, u, work, _ = fmu.states
            self.assertEqual(fmu.dependencies["x:x"], {q} | time)
            self.assertEqual(fmu.dependencies["/energy/work"], {work})
            self.assertEqual(fmu.dependencies["der(" + q + ")"], {q, u})
            self.assertEqual(fmu.dependencies["der(" + u + ")"], {q, u, "push"} | time)
            fmu = self.export("chain.toml", version)
            q1, q2, u1, u2 = fmu.states[:4]
            lag, slow = "sensor 'slow' (state 1)", "controller 'lag' (state 1)"
            self.assertEqual(fmu.dependencies["upper"], {q1} | time)  # the position of the first joint
            self.assertEqual(fmu.dependencies["rate"], {q2, u2} | time)
            self.assertEqual(fmu.dependencies["slow"], {lag} | time)
            self.assertEqual(fmu.dependencies["shake:x"], {q1, q2, u1, u2, slow, "torque"} | time)  # an acceleration
            self.assertEqual(fmu.dependencies["der(" + lag + ")"], {lag, q2} | time)
            self.assertEqual(fmu.dependencies["der(" + slow + ")"], {slow, q1, "target"} | time)
            self.assertEqual(fmu.dependencies["tip:x"], {q1, q2} | time)

    def test_dependencies_of_every_kind_of_block(self):
        self.write("driven.toml", DRIVEN)
        fmu = self.export("driven.toml", 3, *(word for name in (
            "spin", "held", "attitude", "seen", "far", "felt", "push", "/controllers/held_law", "/controllers/late", "/controllers/slow",
            "/controllers/turns", "/controllers/mixed", "/actuators/wheel", "/actuators/motor") for word in ("--channel", name)))
        inputs = {name: {i for i in of or () if i in fmu.list("input")} for name, of in fmu.dependencies.items()}
        loads = {"i3", "i4", "i7", "i9"}  # what accelerates at once: neither sampled, switched nor behind a lag
        rate = next(name for name in fmu.derivatives if "hinge rate" in name)
        expected = {"spin:x": set(), "held:x": set(), "attitude:1": set(), "seen:x": set(), "far": set(), "push:x": set(),
                    "/controllers/held_law": set(), "/controllers/turns": set(), "/controllers/slow": set(), "/controllers/mixed": {"i3"},
                    "/controllers/late": loads, "felt:x": loads, rate: loads, "/actuators/wheel:1": {"i4"},
                    "/actuators/motor:1": set(), "der(controller 'slow' (state 1))": loads}
        self.assertEqual({name: inputs[name] for name in expected}, expected)
        for name in fmu.list("output") + fmu.derivatives:
            self.assertFalse(inputs[name] & {"i1", "i2", "i8", "i10"}, name)  # sampled, switched, unused
        self.assertEqual({name: inputs[name] for name in fmu.indicators if inputs[name]},
                         {"controller 'turns': switch 1": {"i2"}, "controller 'turns': switch 2": {"i2"}, "actuator 'jet': switch": {"i8"},
                          **{f"actuator 'wheel': switch {i}": {"i4"} for i in (1, 2, 3)}})
        self.assertEqual(inputs["event 'near'"], set())

    def test_directional_derivatives_are_those_of_differences(self):
        self.write("arm.toml", ARM)
        self.write("chain.toml", CHAIN)
        self.write("driven.toml", DRIVEN)
        for system in ["arm.toml", "chain.toml", "driven.toml", *self.prepare_examples("ex04", "ex07", "ex08", "ex10")]:
            with self.subTest(system=system):
                fmu = self.export(system, 3 if system.startswith("ex") else 2)
                instance, x, random = self.start_me(fmu)
                unknowns = fmu.list("output") + fmu.derivatives
                names = fmu.list("input")
                inputs = dict(zip(names, random.standard_normal(len(names))))
                t = float(fmu.root.find("DefaultExperiment").get("startTime"))
                instance.put(t, x)
                instance.set(names, list(inputs.values()))
                before = instance.get(unknowns)
                for _ in range(4):
                    dx, du = random.standard_normal(len(x)), random.standard_normal(len(names))
                    # Two steps, extrapolated: the error is of order 4.
                    first, _ = self.difference(instance, t, x, unknowns, dx, inputs, du, 2e-4)
                    second, _ = self.difference(instance, t, x, unknowns, dx, inputs, du, 1e-4)
                    expected = (4 * second - first) / 3
                    found = instance.directional(unknowns, fmu.states + names, [*dx, *du])
                    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
                # Nothing has moved; constraint forces are refined from those before, to rounding.
                np.testing.assert_allclose(instance.get(unknowns), before, rtol=1e-13, atol=1e-13 * np.abs(before).max())
                np.testing.assert_array_equal(instance.states(), x)

    def test_directional_derivatives_are_those_of_the_linear_model(self):
        self.write("chain.toml", CHAIN)
        self.bough("linearize", "chain.toml", "--inputs", "torque,target", "--outputs", "upper,rate,slow,shake,tip", "-o", "linear.h5")
        with h5py.File(self.path("linear.h5")) as f:
            linear = {name: f[name][:] for name in "ABCD"}
        outputs = ["upper", "rate", "slow", "shake:x", "shake:y", "shake:z", "tip:x", "tip:y", "tip:z"]
        for version in (2, 3):
            fmu = self.export("chain.toml", version)
            n = len(fmu.states) - 2  # without work and dissipated energy
            instance = self.make(fmu, "me")
            instance.initialize()
            instance.update_discrete()
            instance.call("EnterContinuousTimeMode")
            inputs = ["torque", "target"]
            for name, unknowns, knowns in (("A", fmu.derivatives[:n], fmu.states[:n]), ("B", fmu.derivatives[:n], inputs),
                                           ("C", outputs, fmu.states[:n]), ("D", outputs, inputs)):
                found = instance.jacobian(unknowns, knowns)
                np.testing.assert_allclose(found, linear[name], rtol=1e-8, atol=1e-8 * np.abs(linear[name]).max(), err_msg=name)
            one = self.make(fmu, "cs")
            one.initialize()
            np.testing.assert_allclose(one.jacobian(outputs, inputs), linear["D"], rtol=1e-8, atol=1e-8 * np.abs(linear["D"]).max())

    def test_directional_derivatives_of_a_linear_system_are_exact(self):
        self.write("slide.toml", SLIDE.replace('axis = [1.0, 0.0, 0.0]', 'axis = [1.0, 0.0, 0.0]\nstiffness = [8.0]\ndamping = [0.5]'))
        for version in (2, 3):
            fmu = self.export("slide.toml", version)
            q, u = fmu.states[:2]
            der = ["der(" + q + ")", "der(" + u + ")"]
            instance, x, _ = self.start_me(fmu)
            instance.put(0.0, x)
            np.testing.assert_allclose(instance.jacobian([*der, "x:x"], [q, u, "push"]), [[0, 1, 0], [-4, -0.25, 0.5], [1, 0, 0]],
                                       rtol=1e-9, atol=1e-12)
            np.testing.assert_allclose(instance.directional([der[1]], [q, u, "push", q], [1, 2, 4, 1]), [-8 - 0.5 + 2], rtol=1e-9)
            with self.assertRaisesRegex(Failed, "expected inputs and states"):
                instance.directional([der[1]], ["mass"], [1])
            with self.assertRaisesRegex(Failed, "expected outputs and derivatives"):
                instance.directional([q], [u], [1])
            with self.assertRaisesRegex(Failed, "finite"):
                instance.directional([der[1]], [u], [np.nan])
            # In the initialization parameters are known, and states are not.
            early = self.make(fmu, "cs")
            with self.assertRaises(Failed):
                early.directional([der[1]], ["push"], [1.0])
            early.enter_initialization()
            early.set(["push"], [3.0])
            found = early.jacobian([der[1], q, "x:x"], ["push", "mass"])
            np.testing.assert_allclose(found, [[0.5, -3 / 4], [0, 0], [0, 0]], rtol=1e-9, atol=1e-12)
            early.call("ExitInitializationMode")
            np.testing.assert_allclose(early.get([der[1], "push", "mass"]), [1.5, 3, 2], rtol=1e-12)
            np.testing.assert_allclose(early.directional(["x:x"], ["push"], [1.0]), [0], atol=1e-12)

    def test_directional_derivatives_hold_modes(self):
        """A joint that sticks keeps its place; one that slips does not."""
        stuck = SLIDE.replace('axis = [1.0, 0.0, 0.0]', 'axis = [1.0, 0.0, 0.0]\nfriction = {coulomb = 3.0}')
        for push, expected in ((1.0, 0), (5.0, 0.5)):
            self.write("slide.toml", stuck.replace("start = 1.0", f"start = {push}"))
            fmu = self.export("slide.toml", 3)
            instance = self.make(fmu, "me")
            instance.initialize()
            instance.update_discrete()
            instance.call("EnterContinuousTimeMode")
            np.testing.assert_allclose(instance.directional([fmu.derivatives[1]], ["push"], [1.0]), [expected], atol=1e-12)

    # The end of a run, times

    def test_an_event_ends_the_run(self):
        self.write("slide.toml", SLIDE)
        for version in (2, 3):
            fmu = self.export("slide.toml", version)
            instance = self.make(fmu, "cs")
            instance.initialize(stop=3.0)
            self.assertEqual(instance.step(0, 1.5), (False, 1.5))
            terminated, reached = instance.step(1.5, 1.0)
            self.assertTrue(terminated)
            self.assertAlmostEqual(reached, 2, delta=1e-9)
            np.testing.assert_allclose(instance.get(["x:x"]), [1], rtol=1e-9)
            self.assertIn("there", instance.messages[-1][2])
            instance.call("Terminate")
            instance = self.make(fmu, "me")
            instance.initialize(stop=3.0)
            run = MeRun(instance)
            self.assertFalse(run.advance(3))
            self.assertAlmostEqual(run.t, 2, delta=1e-9)

    def test_a_run_may_be_longer_than_the_system_file_says(self):
        plain = SLIDE.replace("duration = 10.0", "duration = 1.0").replace('action = "stop"', "").replace("value = 1.0", "value = 50.0")
        self.write("slide.toml", plain)
        fmu = self.export("slide.toml")
        for stop in (None, 9.0):
            for h in (0.25, 0.7):
                instance = self.make(fmu, "cs")
                instance.initialize(stop=stop)
                t = 0.0
                while t < 8:
                    instance.step(t, h)
                    t += h
                np.testing.assert_allclose(instance.get(["x:x"]), [t * t / 4], rtol=1e-11)
            instance = self.make(fmu, "me")
            instance.initialize(stop=stop)
            self.assertTrue(MeRun(instance).advance(8))
            np.testing.assert_allclose(instance.get(["x:x"]), [16], rtol=1e-9)

    def test_a_run_starts_at_another_time(self):
        more = ('[[function]]\nname = "later"\ntype = "ramp"\nvalue = 4.0\nfrom = 5.2\nto = 5.5\n'
                '[[force]]\nname = "f"\nbody = "bob"\nforce = [1.0, 0.0, 0.0]\nfunction = "later"\n[simulation]')
        text = SLIDE.replace("[simulation]", more).replace('action = "stop"', "")
        self.write("slide.toml", text)
        fmu = self.export("slide.toml")
        self.write("later.toml", text.replace("[simulation]", "[simulation]\nstart = 5.0").replace("duration = 10.0", "duration = 2.0"))
        t, expected = self.run_reference("later.toml", ["x:x"])
        at = int(np.argmin(abs(t - 6)))
        for kind in ("cs", "me"):
            instance = self.make(fmu, kind)
            instance.initialize(start=5.0, stop=7.0)
            np.testing.assert_equal(instance.get(["time"]), [5])
            if kind == "cs":
                instance.step(5, 1)
            else:
                MeRun(instance, start=5.0).advance(6)
            np.testing.assert_allclose(instance.get(["x:x", "time"]), [expected[at][0], 6], rtol=1e-9)

    # States

    def test_states_continue_bit_for_bit(self):
        self.write("arm.toml", ARM)
        for version in (2, 3):
            fmu = self.export("arm.toml", version)
            outputs = fmu.list("output") + fmu.states + fmu.derivatives
            one = self.make(fmu, "cs")
            one.initialize(stop=2.0)
            for k in range(40):
                one.step(0.013 * k, 0.013)
            state = one.save()
            raw = one.serialize(state)

            def go_on(instance):
                rows = []
                for k in range(40, 80):
                    instance.set(["torque"], [0.3 if k > 50 else -0.2])
                    instance.step(0.013 * k, 0.013)
                    rows.append(instance.get(outputs))
                return np.array(rows)
            expected = go_on(one)
            one.restore(state)
            np.testing.assert_array_equal(go_on(one), expected)
            other = self.make(fmu, "cs")
            back = other.deserialize(raw)
            other.restore(back)  # before its initialization
            np.testing.assert_array_equal(go_on(other), expected)
            self.assertEqual(other.serialize(back), raw)
            one.free_state(state)
            with self.assertRaisesRegex(Failed, "no FMU state"):
                one.restore(ctypes.c_void_p(1234))
            for at in range(0, len(raw), max(1, len(raw) // 300)):  # cut or changed bytes are reported
                with self.assertRaises(Failed):
                    other.deserialize(raw[:at])
                with self.assertRaisesRegex(Failed, r"fmu.state"):
                    other.deserialize(raw[:at] + bytes([raw[at] ^ 0x20]) + raw[at + 1:])
            np.testing.assert_array_equal(other.get(outputs), expected[-1])

    def test_states_of_model_exchange_keep_events(self):
        self.write("arm.toml", ARM)
        fmu = self.export("arm.toml")
        instance = self.make(fmu, "me")
        instance.initialize(stop=2.0)
        run = MeRun(instance, tolerance=1e-8)
        run.advance(0.2)
        saved, state = {**run.__dict__}, instance.save()

        def go_on():
            rows = []
            for t in np.arange(0.21, 0.4, 0.01):
                run.advance(t)
                rows.append(instance.get(fmu.list("output")))
            return np.array(rows)
        expected = go_on()
        instance.restore(state)
        run.__dict__.update(saved)
        np.testing.assert_array_equal(go_on(), expected)
        other = self.make(fmu, "me")
        other.restore(other.deserialize(instance.serialize(state)))
        run.__dict__.update(saved)
        run.i = other
        instance = other
        np.testing.assert_array_equal(go_on(), expected)

    def test_a_state_carries_the_parameters(self):
        self.write("slide.toml", SLIDE)
        fmu = self.export("slide.toml")
        heavy, light = self.make(fmu, "cs"), self.make(fmu, "cs")
        heavy.set(["mass"], [8.0])
        heavy.initialize()
        light.initialize()
        heavy.step(0, 1)
        light.step(0, 0.5)
        light.restore(light.deserialize(heavy.serialize(heavy.save())))
        np.testing.assert_equal(light.get(["mass"]), [8])
        for instance in (heavy, light):
            instance.step(1, 1)
            np.testing.assert_allclose(instance.get(["x:x"]), [0.25], rtol=1e-12)

    # Several instances

    def test_instances_are_independent(self):
        self.write("arm.toml", ARM)
        fmu = self.export("arm.toml")
        outputs = fmu.list("output")

        def run(torque, rows, instance=None):
            instance = instance or self.make(fmu, "cs")
            instance.initialize(stop=2.0)
            for k in range(60):
                instance.set(["torque"], [torque])
                instance.step(0.01 * k, 0.01)
                rows.append(instance.get(outputs))
        torques = [0.0, 0.5, -0.5, 1.0]
        alone, together, threads = [[] for _ in torques], [[] for _ in torques], []
        for torque, rows in zip(torques, alone):
            run(torque, rows)
        for torque, rows in zip(torques, together):
            threads.append(threading.Thread(target=run, args=(torque, rows)))
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_array_equal(alone, together)
        pair = [self.make(fmu, "cs") for _ in range(2)]  # turn by turn
        for instance in pair:
            instance.initialize(stop=2.0)
        for k in range(60):
            for i, instance in enumerate(pair):
                instance.set(["torque"], [torques[i]])
                instance.step(0.01 * k, 0.01)
                np.testing.assert_array_equal(instance.get(outputs), alone[i][k])

    # Misuse

    def test_wrong_token_and_resources_are_reported(self):
        self.write("slide.toml", SLIDE)
        for version in (2, 3):
            fmu = self.export("slide.toml", version)
            for kind in ("cs", "me"):
                with self.assertRaisesRegex(Failed, r"expected .*fmu.token"):
                    Instance(fmu, kind, token="{1}")
                with self.assertRaisesRegex(Failed, r"fmu.resources"):
                    Instance(fmu, kind, resources=self.path("nowhere"))
                with self.assertRaises(Failed):
                    Instance(fmu, kind, resources="")
            system = os.path.join(fmu.resources, "system.toml")
            with open(system, "a", encoding="utf-8") as f:
                f.write("# changed\n")
            with self.assertRaisesRegex(Failed, r"fmu.token"):
                Instance(fmu, "cs")
            os.remove(system)
            with self.assertRaisesRegex(Failed, r"fmu.resources"):
                Instance(fmu, "cs")
            for manifest in ("", "bough-fmu 1\nversion 99\n", "bough-fmu 1\nversion 0.2.0\nfile ../../secret\n", "bough-fmu 1\nversion 0.2.0\nfile\n"):
                with open(os.path.join(fmu.resources, "manifest.txt"), "w", encoding="utf-8") as f:
                    f.write(manifest)
                with self.assertRaisesRegex(Failed, r"fmu.resources"):
                    Instance(fmu, "cs")

    def test_parameters_that_change_the_structure_are_reported(self):
        self.bough("init", "spinup")
        self.bough("reduce", "spinup/boom.toml", "-o", "spinup/boom.h5")
        with open(self.path("spinup/spinup.toml"), encoding="utf-8") as f:
            text = f.read().replace('file = "boom.h5"', 'file = "boom.h5"\nmodes = "$modes"')
        self.write("spinup/s.toml", "[parameters]\nmodes = 2\n" + text)
        fmu = self.export("spinup/s.toml")
        instance = self.make(fmu, "cs")
        instance.set(["modes"], [1.0])
        with self.assertRaisesRegex(Failed, r"outputs|states.*fmu.structure"):
            instance.initialize()
        instance.call("Reset")
        instance.enter_initialization()  # half a mode does not exist
        with self.assertRaisesRegex(Failed, r"modes.*fmu.derivative"):
            instance.directional([fmu.list("output")[0]], ["modes"], [1.0])
        instance.call("ExitInitializationMode")
        instance.step(0, 0.1)

    def test_bad_calls_are_errors_and_leave_the_instance_usable(self):
        self.write("slide.toml", SLIDE)
        for version in (2, 3):
            with self.subTest(version=version):
                fmu = self.export("slide.toml", version)
                plain = self.make(fmu, "cs")
                cs, me = self.make(fmu, "cs"), self.make(fmu, "me")

                def fails(instance, name, *arguments):
                    with self.assertRaises(Failed) as caught:
                        instance.call(name, *arguments)
                    self.assertIn(caught.exception.status, (2, ERROR))
                    self.assertGreater(len(instance.messages[-1][2]), 10)

                with self.assertRaises(Failed):
                    cs.step(0, 0.1)  # before its initialization
                for name in ("ExitInitializationMode", "Terminate", "EnterEventMode", "EnterContinuousTimeMode"):
                    fails(cs, name)
                    fails(me, name)
                with self.assertRaises(Failed):
                    cs.initialize(start=np.nan)
                with self.assertRaises(Failed):
                    cs.initialize(start=1.0, stop=0.5)
                for instance in (plain, cs, me):
                    instance.initialize()
                fails(cs, "EnterInitializationMode", *([ctypes.c_bool(0), REAL(0), REAL(0), ctypes.c_bool(0), REAL(0)] if version == 3 else []))
                for value in (np.nan, np.inf, -np.inf):
                    for instance in (cs, me):
                        with self.assertRaisesRegex(Failed, "finite"):
                            instance.set(["push"], [value])
                    with self.assertRaises(Failed):
                        cs.step(0, value)
                    with self.assertRaises(Failed):
                        cs.step(value, 0.1)
                    fails(me, "SetTime", REAL(value))
                for h in (0, -0.1):
                    with self.assertRaises(Failed):
                        cs.step(0, h)
                with self.assertRaisesRegex(Failed, "the instance is at"):
                    cs.step(0.5, 0.1)
                for reference in (0x01000001, 0x02ffffff, 0x03000001, 0x04000009, 0x06000100, 0x07000000, 0xffffffff, 1):
                    with self.assertRaisesRegex(Failed, "no variable"):
                        cs.get([reference])
                    with self.assertRaises(Failed):
                        cs.set([reference], [1.0])
                for name in ("x:x", fmu.states[0]):
                    with self.assertRaisesRegex(Failed, "cannot be set"):
                        cs.set([name], [1.0])
                fails(cs, "SetTime", REAL(0.1))
                fails(cs, "EnterEventMode")
                fails(cs, "CompletedIntegratorStep", ctypes.c_int(1), None, None)
                get, size = ("GetReal", []) if version == 2 else ("GetFloat64", [SIZE(1)])
                fails(cs, get, None, SIZE(1), None, *size)
                fails(cs, get, cs.references(["x:x"]), SIZE(1), None, *size)
                if version == 3:
                    fails(cs, get, cs.references(["x:x"]), SIZE(1), (REAL * 1)(), SIZE(2))
                kinds = ["Integer", "Boolean", "String"] if version == 2 else ["Float32", "Int8", "UInt64", "Boolean", "String"]
                for kind in kinds:
                    more = [] if version == 2 else [SIZE(1)]
                    fails(cs, "Get" + kind, cs.references(["x:x"]), SIZE(1), (REAL * 1)(), *more)
                    cs.call("Get" + kind, None, SIZE(0), None, *([] if version == 2 else [SIZE(0)]))
                for name in ["CancelStep", "SetRealInputDerivatives"] if version == 2 else [
                        "GetAdjointDerivative", "EnterConfigurationMode", "GetOutputDerivatives", "EvaluateDiscreteStates",
                        "ActivateModelPartition"]:
                    fails(cs, name, None, SIZE(0), None, SIZE(0), None, SIZE(0), None, SIZE(0))
                me.update_discrete()
                me.call("EnterContinuousTimeMode")
                with self.assertRaises(Failed):
                    me.put(0.1, np.full(len(fmu.states), np.nan))
                with self.assertRaises(Failed):
                    me.put(0.1, np.zeros(len(fmu.states) + 1))
                with self.assertRaises(Failed):
                    me.step(0, 0.1)
                me.put(0.0, np.zeros(len(fmu.states)))
                for instance in (plain, cs):
                    instance.step(0, 1)
                np.testing.assert_array_equal(cs.get(["x:x"]), plain.get(["x:x"]))
                dead = cs.handle
                cs.call("Terminate")
                with self.assertRaises(Failed):
                    cs.step(1, 0.1)
                cs.close()
                with self.assertRaises(Failed):
                    cs.step(1, 0.1)
                cs.close()
                self.assertEqual(cs.handle, dead)
                cs.handle = None

    def test_a_run_that_diverges_fails_and_is_restored(self):
        self.write("slide.toml", SLIDE.replace('action = "stop"', ""))
        fmu = self.export("slide.toml")
        instance = self.make(fmu, "cs")
        instance.initialize()
        instance.step(0, 0.5)
        state = instance.save()
        instance.set(["push"], [1e300])
        with self.assertRaisesRegex(Failed, r"run\.diverged"):
            instance.step(0.5, 9)
        with self.assertRaises(Failed):
            instance.step(0.5, 0.1)
        instance.restore(state)
        instance.set(["push"], [0.0])
        instance.step(0.5, 0.5)
        np.testing.assert_allclose(instance.get(["x:x"]), [0.0625 + 0.125], rtol=1e-12)

    # The archive

    def test_equal_input_gives_equal_bytes(self):
        self.write("arm.toml", ARM)
        for version in (2, 3):
            seen = []
            for name in ("a", "b"):
                os.makedirs(self.path(name), exist_ok=True)
                self.bough("export", "arm.toml", "--to", "fmu", "--fmi", version, "-o", name + "/arm.fmu")
                with open(self.path(name + "/arm.fmu"), "rb") as f:
                    seen.append(f.read())
            self.assertEqual(*seen)
            with zipfile.ZipFile(self.path("a/arm.fmu")) as archive:
                folder = "binaries/linux64/" if version == 2 else "binaries/x86_64-linux/"
                names = archive.namelist()
                self.assertEqual(names[0], "modelDescription.xml")
                self.assertIn(folder + "arm.so", names)
                self.assertIn("resources/system.toml", names)

    def test_the_binary_needs_no_library_of_bough(self):
        self.write("arm.toml", ARM)
        fmu = self.export("arm.toml", 3, name="two words.fmu")
        self.assertEqual(fmu.identifier, "two_words")
        environment = {k: v for k, v in os.environ.items() if k != "LD_LIBRARY_PATH"}
        said = subprocess.run(["ldd", fmu.binary], capture_output=True, text=True, check=True, env=environment).stdout
        allowed = ("linux-vdso", "libmuparser.so", "libbgmp.so", "libstdc++.so", "libm.so", "libgcc_s.so", "libc.so", "ld-linux",
                   "libclang_rt", "libasan", "libubsan", "libtsan")
        for line in said.splitlines():
            name = os.path.basename(line.split()[0])
            self.assertTrue(name.startswith(allowed), line)
            if name.startswith(("libmuparser", "libbgmp")):
                self.assertIn(os.path.dirname(fmu.binary), line)
        said = subprocess.run(["nm", "-D", "--defined-only", fmu.binary], capture_output=True, text=True, check=True).stdout
        names = {line.split()[-1] for line in said.splitlines()}
        self.assertTrue(all(name.startswith(("fmi2", "fmi3")) for name in names), sorted(names)[:5])
        self.assertEqual(len([n for n in names if n.startswith("fmi2")]), 44)
        self.assertEqual(len([n for n in names if n.startswith("fmi3")]), 75)

    def test_files_are_packed(self):
        np.savetxt(self.path("thrust.csv"), [[0, 0], [1, 0.25], [2, 1 / 3]], delimiter=",", fmt="%.17g")
        scipy.io.savemat(self.path("law.mat"), {"A": np.array([[-1.0, 0.1], [0, -2]]), "B": np.array([[1.0], [1 / 3]]),
                                                "C": np.array([[1.0, 1e-5]])})
        scipy.io.savemat(self.path("table.mat"), {"t": np.array([0.0, 1, 2]), "v": np.array([0.0, 1 / 7, 1e20]) * 1e-20})
        text = ARM.replace("[simulation]", '[[function]]\nname = "thrust"\ntype = "table"\nfile = "thrust.csv"\n'
                           '[[function]]\nname = "other"\ntype = "table"\nfile = "table.mat"\ntime_column = "t"\ncolumn = "v"\n'
                           '[[force]]\nname = "f"\nbody = "b"\nforce = [0.0, 1.0, 0.0]\nfunction = "thrust"\n'
                           '[[force]]\nname = "g"\nbody = "b"\nforce = [0.0, 0.0, 1.0]\nfunction = "other"\n'
                           '[[controller]]\nname = "space"\ntype = "state_space"\ninputs = ["tip:x"]\nfile = "law.mat"\n'
                           '[simulation]')
        self.write("arm.toml", text.replace("[simulation]", get_astray(0, 0, 100, "angle") .replace('"law"', '"own"') + "[simulation]"))
        os.makedirs(self.path("elsewhere"))
        for version in (2, 3):
            fmu = self.export("arm.toml", version)
            with open(os.path.join(fmu.resources, "system.toml"), encoding="utf-8") as f:
                packed = f.read()
            for name in ("thrust.csv", "law.mat", "table.mat", self.folder):
                self.assertNotIn(name, packed)
            self.assertTrue(os.path.exists(os.path.join(fmu.resources, os.path.basename(os.environ["BOUGH_ASTRAY"]))))
            self.compare_cs("arm.toml", version)

    def test_bodies_are_packed_under_names_of_their_own(self):
        self.bough("init", "spinup")
        self.bough("reduce", "spinup/boom.toml", "-o", "spinup/boom.h5")
        os.makedirs(self.path("two"))
        shutil.copy(self.path("spinup/boom.h5"), self.path("two"))
        with open(self.path("spinup/spinup.toml"), encoding="utf-8") as f:
            text = f.read()
        second = '[[body]]\nname = "second"\nfile = "two/boom.h5"\n[[hinge]]\nname = "h2"\ntype = "fixed"\nchild = "second"\n[simulation]'
        fixed = with_integrator(text, 'integrator = "rk4"\nstep = 1e-3\n', 0.5, 0.01)
        self.write("s.toml", fixed.replace('"boom.h5"', '"spinup/boom.h5"').replace("[simulation]", second))
        fmu = self.export("s.toml")
        self.assertTrue({"resources/boom.flat", "resources/boom-2.flat"} <= set(fmu.names), fmu.names)
        self.compare_cs("s.toml", 3)
        self.bough("flx", "spinup/boom.h5", "-o", "boom.FLX")
        self.write("s.toml", fixed.replace('"boom.h5"', '"boom.FLX"'))
        fmu = self.export("s.toml")
        self.assertTrue(any(name.startswith("resources/boom.") for name in fmu.names), fmu.names)
        self.compare_cs("s.toml", 2)

    def test_inline_tables_are_packed(self):
        np.savetxt(self.path("thrust.csv"), [[0, 0], [1, 0.25], [2, 1]], delimiter=",")
        inline = 'function = [{name = "thrust", type = "table", file = "thrust.csv"}]\n'
        self.write("slide.toml", inline + SLIDE.replace("duration = 10.0", "duration = 1.0").replace(
            "[simulation]", '[[force]]\nname = "f"\nbody = "bob"\nforce = [1.0, 0.0, 0.0]\nfunction = "thrust"\n[simulation]'))
        self.compare_cs("slide.toml", 3)

    def test_export_errors(self):
        self.write("slide.toml", SLIDE)
        self.assertIn("-o", self.fails(2, "export", "slide.toml", "--to", "fmu", error="cli.usage").stderr)
        self.fails(2, "export", "slide.toml", "--to", "fmu", "--fmi", "1", "-o", "a.fmu")
        self.fails(3, "export", "slide.toml", "--to", "fmu", "-o", "nowhere/a.fmu", error="cli.write")
        self.write("body.toml", '[body]\nname = "a"\ndeck = "a.bdf"\n')
        self.fails(1, "export", "body.toml", "--to", "fmu", "-o", "a.fmu", error="cli.wrong-file")
        self.fails(1, "export", "none.toml", "--to", "fmu", "-o", "a.fmu")
        os.makedirs(self.path("bin"))
        shutil.copy(PROGRAM, self.path("bin/bough"))
        result = subprocess.run([self.path("bin/bough"), "export", "slide.toml", "--to", "fmu", "-o", "a.fmu"], cwd=self.folder,
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 3)
        self.assertIn("[fmu.no-binary]", result.stderr)
        if os.path.exists("/dev/full"):
            os.symlink("/dev/full", self.path("full.fmu"))
            self.fails(3, "export", "slide.toml", "--to", "fmu", "-o", "full.fmu")


if __name__ == "__main__":
    unittest.main()
