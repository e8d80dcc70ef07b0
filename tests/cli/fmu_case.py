"""Systems, exports and references of the tests of FMUs. Contains no tests."""
import os
import shutil

import h5py
import numpy as np

from fmu_importer import Fmu, Instance, MeRun
from support import SOURCE, ProgramTest
from toml_text import section, table, toml

# x'' = push / mass from rest; an event that ends the run.
SLIDE = toml(
    section("parameters", mass=2.0),
    table("body", "bob", mass="$mass", inertia=[1.0, 1.0, 1.0]),
    table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0]),
    table("sensor", "x", "position", body="bob"),
    table("input", "push", dims="F", start=1.0),
    table("actuator", "motor", "hinge", hinge="slide", input="push"),
    table("event", "there", signal="x:x", value=1.0, action="stop"),
    section("simulation", duration=10.0, output_step=0.1, integrator="rk4", step=0.01))
# Two links with a lag of a controller and one of a sensor.
CHAIN = toml(
    table("body", "a", mass=2.0, cg=[0.5, 0.0, 0.0], inertia=[0.01, 0.17, 0.17]),
    table("body", "b", mass=1.0, cg=[0.3, 0.0, 0.1], inertia=[0.01, 0.07, 0.07]),
    table("hinge", "h1", "revolute", child="a", axis=[0.0, 0.0, 1.0], position=[0.3], damping=[0.1]),
    table("hinge", "h2", "revolute", parent="a", parent_position=[1.0, 0.0, 0.0], child="b", axis=[0.0, 0.0, 1.0],
          position=[0.4], stiffness=[3.0]),
    table("input", "torque", dims="F L", start=0.7),
    table("input", "target", dims="1"),
    table("sensor", "upper", "hinge_angle", hinge="h1"),
    table("sensor", "rate", "hinge_rate", hinge="h2"),
    table("sensor", "slow", "hinge_angle", hinge="h2", lag=0.05),
    table("sensor", "shake", "accelerometer", body="b"),
    table("sensor", "tip", "position", body="b"),
    table("controller", "error", "sum", inputs=["target", "upper"], weights=[1.0, -1.0]),
    table("controller", "lag", "transfer_function", inputs=["error"], numerator=[4.0], denominator=[0.1, 1.0]),
    table("controller", "sum", "sum", inputs=["lag", "torque"]),
    table("actuator", "motor", "hinge", hinge="h1", input="sum"),
    section("simulation", duration=1.0, output_step=0.01, integrator="rk4", step=0.002, gravity=[0.0, -9.81, 0.0]))
# A hull that flies and carries an arm: actuators and sensors of every kind.
DRIVEN = toml(
    table("body", "hull", mass=5.0, cg=[0.1, 0.0, 0.05], inertia=[1.0, 1.2, 1.5]),
    table("body", "arm", mass=1.0, cg=[0.3, 0.02, 0.0], inertia=[0.01, 0.07, 0.07],
          nodes=[{"id": 1, "position": [0.6, 0.0, 0.0]}]),
    table("hinge", "float", "free", child="hull", position=[0.9, 0.1, 0.3, 0.2, 0.2, 0.1, 0.9]),
    table("hinge", "joint", "revolute", parent="hull", child="arm", axis=[0.0, 0.0, 1.0]),
    table("function", "wave", "sine", amplitude=1.0, omega=3.0),
    *(table("input", f"i{k}", start=0.3 + 0.1 * k) for k in range(1, 11)),
    table("sensor", "spin", "gyro", body="hull", lag=0.1),
    table("sensor", "turned", "integrating_gyro", body="hull"),
    table("sensor", "held", "gyro", body="arm", sample_time=0.1),
    table("sensor", "attitude", "quaternion", body="arm"),
    table("sensor", "seen", "position", body="arm", node=1, relative_to="hull", frame="hull"),
    table("sensor", "drift", "velocity", body="arm", node=1, relative_to="hull", frame="hull"),
    table("sensor", "far", "distance", body="arm", node=1, target=[3.0, 1.0, 0.0]),
    table("sensor", "felt", "hinge_moment", hinge="joint"),
    table("sensor", "push", "accelerometer", body="arm", lag=0.05),
    table("sensor", "pull", "accelerometer", body="hull"),
    table("controller", "held_law", "gain", inputs=["i1"], gain=2.0, sample_time=0.1),
    table("controller", "late", "gain", inputs=["pull:x"], gain=2.0),
    table("controller", "turns", "relay", inputs=["i2"], on=0.9, off=0.8, value=1.0),
    table("controller", "mixed", "expression", inputs=["i3", "spin:z"], expression="u1*u2 + sin(t)"),
    table("controller", "slow", "transfer_function", inputs=["late"], numerator=[1.0], denominator=[0.2, 1.0]),
    table("actuator", "wheel", "wheel", body="hull", axis=[0.0, 1.0, 0.0], inertia=0.02, viscous=0.01, momentum=0.4,
          input="i4"),
    table("actuator", "cmg", "cmg", body="hull", gimbal_axis=[1.0, 0.0, 0.0], spin_axis=[0.0, 0.0, 1.0], momentum=0.7,
          lag=0.2, input="i5"),
    table("actuator", "motor", "motor", hinge="joint", torque_constant=0.5, resistance=2.0, lag=0.1, input="i6"),
    table("actuator", "brake", "brake", hinge="joint", stick_rate=0.1, input="i7"),
    table("actuator", "thruster", "force", body="arm", node=1, axis=[0.0, 1.0, 0.2], input="mixed"),
    table("actuator", "jet", "jet", body="hull", axis=[1.0, 0.0, 0.0], thrust=2.0, input="i8"),
    table("actuator", "valve", "force", body="hull", axis=[1.0, 0.5, 0.0], input="held_law"),
    table("actuator", "trim", "moment", body="hull", axis=[1.0, 0.5, 0.0], input="turns"),
    table("force", "tug", body="arm", force=[0.0, 0.0, 1.0], signal="i9"),
    table("force", "gust", body="hull", force=[0.1, 0.0, 0.0], function="wave"),
    table("event", "near", signal="far", value=1.0),
    section("simulation", duration=1.0, output_step=0.01, integrator="rk4", step=0.002, gravity=[0.0, 0.0, -1.0]))
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


class FmuCase(ProgramTest):
    """Exports FMUs and compares them with `bough run`."""

    def setUp(self):
        super().setUp()
        self.runs = {}    # folder and text of a system: its results file

    def export(self, system, version=3, *more, name="one.fmu"):
        self.bough("export", system, "--to", "fmu", "--fmi", version, "-o", name, *more)
        folder = self.path("unpacked-" + str(len(os.listdir(self.folder))))
        return Fmu(self.path(name), folder)

    def make(self, fmu, kind, **more):
        instance = Instance(fmu, kind, **more)
        self.addCleanup(lambda: instance.handle and instance.close())
        return instance

    def run_reference(self, system, names):
        """Times, and samples of the outputs; a system that was run before is not run again."""
        with open(self.path(system), encoding="utf-8") as f:
            key = (os.path.dirname(system), f.read())
        if key not in self.runs:
            self.runs[key] = f"reference-{len(self.runs)}.h5"
            self.bough("run", system, "-o", self.runs[key])
        with h5py.File(self.path(self.runs[key])) as f:
            t, columns = f["time"][:], []
            for name in names:
                channel, _, component = name.partition(":")
                values = f[channel if channel.startswith("/") else "sensors/" + channel][:].reshape(len(t), -1)
                columns.append(values[:, int(component) - 1 if component.isdecimal() else COMPONENTS[component]])
        return t, np.column_stack(columns)

    def compare_cs(self, system, version, tolerance=0.0, options=(), **more):
        fmu = self.export(system, version, *options)
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

    def compare_me(self, system, version, tolerance=1e-8, options=()):
        fmu = self.export(system, version, *options)
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
