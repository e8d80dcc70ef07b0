"""The shared library against the program: a system stepped from outside moves as `bough run` moves it."""
import multiprocessing
import os
import re
import shutil
import subprocess
import unittest

import h5py
import numpy as np

from host import INPUTS, OUTPUTS, Model, Simulation
from support import ProgramTest
from toml_text import section, table, toml

# Dry friction, an elastic stop, a sampled noisy sensor, a delayed sampled law, a relay, an event that only logs.
ARM = toml(
    table("body", "a", mass=2.0, cg=[0.5, 0.0, 0.0], inertia=[0.01, 0.17, 0.17]),
    table("body", "b", mass=1.0, cg=[0.3, 0.0, 0.0], inertia=[0.01, 0.07, 0.07]),
    table("hinge", "h1", "revolute", child="a", axis=[0.0, 0.0, 1.0], damping=[0.1], friction={"coulomb": 0.4}),
    table("hinge", "h2", "revolute", parent="a", parent_position=[1.0, 0.0, 0.0], child="b", axis=[0.0, 0.0, 1.0],
          position=[0.4], stops={"lower": -1.0, "upper": 1.0, "restitution": 0.4}),
    table("sensor", "angle", "hinge_angle", hinge="h1", noise_density=0.01, seed=3, sample_time=0.013),
    table("sensor", "tip", "position", body="b"),
    table("input", "torque", dims="F L"),
    table("controller", "law", "gain", inputs=["angle"], gain=3.0, sample_time=0.02, delay=0.03),
    table("controller", "relay", "relay", inputs=["tip:y"], on=0.2, off=0.1, value=0.5),
    table("controller", "sum", "sum", inputs=["law", "torque", "relay"], weights=[-1.0, 1.0, 1.0]),
    table("actuator", "motor", "hinge", hinge="h1", input="sum"),
    table("event", "low", signal="tip:y", value=-1.0),
    section("simulation", duration=2.0, output_step=0.01, integrator="rk4", step=0.002, gravity=[0.0, -9.81, 0.0]))


def go_on(path, state, times, names, queue):
    """In another process: what `times` show from a state on."""
    model = Model(path)
    simulation = Simulation(model)
    simulation.restore(state)
    rows = []
    for t in times:
        simulation.advance(t)
        rows.append(simulation.outputs())
    queue.put((model.names(OUTPUTS) == names, rows))


class Embed(ProgramTest):
    def run_reference(self, path):
        """Time, and samples of every output by its name."""
        self.bough("run", path, "-o", "ref.h5")
        with h5py.File(self.path("ref.h5")) as f:
            return f["time"][:], {name: self.read(f, name) for name in Model(self.path(path)).names(OUTPUTS)}

    def read(self, f, name):
        path, _, component = name.partition(":")
        data = f[path if path.startswith("/") else "/sensors/" + path][:]
        if not component:
            return data.reshape(len(data))
        if component.isdigit():
            return data[:, int(component) - 1]
        names = {"x": 0, "y": 1, "z": 2, "w": 0, "angle1": 0, "angle2": 1, "angle3": 2}
        offset = 1 if data.shape[1] == 4 and component in "xyz" else 0
        return data[:, names[component] + offset]

    def compare(self, path, times, tolerance=0.0, saves=False, integrator=""):
        t, expected = self.run_reference(path)
        model = Model(self.path(path))
        names, simulation, seen = model.names(OUTPUTS), Simulation(model, integrator), 0
        for until in times:
            simulation.advance(until)
            if saves:
                state = simulation.save()
                simulation.close()
                simulation = Simulation(model)
                simulation.restore(state)
            k = int(np.argmin(abs(t - until)))
            if abs(t[k] - until) > 1e-9:
                continue
            seen += 1
            values = simulation.outputs()
            for name, value in zip(names, values):
                wanted = expected[name][k]
                if tolerance == 0:
                    self.assertEqual(value, wanted, (name, until))
                else:
                    self.assertAlmostEqual(value, wanted, delta=tolerance * max(1, abs(wanted)), msg=(name, until))
        self.assertGreater(seen, 50)
        simulation.close()
        model.close()

    def test_slices_change_nothing(self):
        self.write("arm.toml", ARM)
        for step in (0.01, 0.002, 0.03):
            self.compare("arm.toml", [step * k for k in range(1, round(2 / step) + 1)] + [2.0])

    def test_states_go_on_at_every_sample(self):
        self.write("arm.toml", ARM)
        self.compare("arm.toml", [0.01 * k for k in range(1, 201)], saves=True)
        self.write("implicit.toml", ARM.replace('"rk4"', '"implicit"'))
        self.compare("implicit.toml", [0.01 * k for k in range(1, 201)], saves=True)

    def test_a_state_goes_on_in_another_process(self):
        self.write("arm.toml", ARM)
        model = Model(self.path("arm.toml"))
        simulation = Simulation(model)
        simulation.advance(0.7531)
        times = [0.76 + 0.01 * k for k in range(50)]
        queue = multiprocessing.get_context("spawn").Queue()
        process = multiprocessing.get_context("spawn").Process(
            target=go_on, args=(self.path("arm.toml"), simulation.save(), times, model.names(OUTPUTS), queue))
        process.start()
        same, rows = queue.get()
        process.join()
        self.assertTrue(same)
        for t, row in zip(times, rows):
            simulation.advance(t)
            np.testing.assert_array_equal(simulation.outputs(), row)

    def test_adaptive_methods_agree_to_their_tolerance(self):
        for name in ("adams", "rk"):
            plain = ARM.replace('"rk4"', f'"{name}"').replace("step = 0.002\n", "").replace("noise_density = 0.01", "")
            self.write("arm.toml", plain.replace("seed = 3\n", ""))
            self.compare("arm.toml", [0.01 * k for k in range(1, 201)], tolerance=2e-5)

    def test_examples_with_flexible_bodies(self):
        for example, body, system, order in (("spinup", "boom", "spinup", 2), ("spinup", "boom", "spinup", 3),
                                             ("satellite", "wing", "pointing", 2), ("robot-arm", "arm", "robot", 2),
                                             ("four-bar", "coupler", "four-bar", 2)):
            with self.subTest(example=example, order=order):
                self.bough("init", example, "--force")
                folder = os.path.join(example, "")
                if order == 3:
                    with open(self.path(folder + body + ".toml"), "a", encoding="utf-8") as f:
                        f.write("\n[body.stiffening]\norder = 3\n")
                self.bough("reduce", folder + body + ".toml", "-o", folder + body + ".h5")
                self.bough("export", folder + body + ".h5", "--to", "flat", "-o", folder + body + ".flat")
                with open(self.path(folder + system + ".toml"), encoding="utf-8") as f:
                    text = f.read().replace(body + ".h5", body + ".flat")
                head, _, tail = text.partition("[simulation]")
                lines = [line for line in tail.splitlines()
                         if not line.startswith(("integrator", "step", "relative_tol", "absolute_tol", "duration",
                                                 "output_step", "rk_order", "energy_error_limit"))]
                self.write(folder + "s.toml", head + section(
                    "simulation", duration=0.3, output_step=2e-3, integrator="rk4", step=2e-4,
                    energy_error_limit=10.0) + "\n".join(lines) + "\n")
                self.compare(folder + "s.toml", [2e-3 * k for k in range(1, 151)])

    def test_bodies_and_matrices_in_other_formats_are_refused(self):
        self.bough("init", "spinup")
        self.bough("reduce", "spinup/boom.toml", "-o", "spinup/boom.h5")
        path = self.path("spinup/spinup.toml")
        with self.assertRaisesRegex(RuntimeError, r"(?s)--to flat -o \S+boom.flat, and name that .*embed.hdf5") as refused:
            Model(path)
        with self.subTest("the advice is what helps"):
            command = re.search(r"bough (export .*?), and", str(refused.exception)).group(1).split()
            self.bough(*command)
            with open(path, encoding="utf-8") as f:
                self.write("spinup/flat.toml", f.read().replace("boom.h5", "boom.flat"))
            Model(self.path("spinup/flat.toml")).close()
        with open(path, encoding="utf-8") as f:
            text = f.read()
        self.write("spinup/deck.toml", text.replace("boom.h5", "boom.bdf"))
        with self.assertRaisesRegex(RuntimeError, "embed.body-format"):
            Model(self.path("spinup/deck.toml"))
        self.write("arm.toml", ARM.replace("gain = 3.0", 'file = "law.mat"'))
        with self.assertRaisesRegex(RuntimeError, "embed.matrix-file"):
            Model(self.path("arm.toml"))

    def test_states_of_another_body_are_refused(self):
        self.bough("init", "spinup")
        states = []
        for folder, modulus in (("one", "6.895+10"), ("two", "2.0+10")):
            shutil.copytree(self.path("spinup"), self.path(folder))
            with open(self.path(folder + "/boom.bdf"), encoding="utf-8") as f:
                deck = f.read()
            self.assertIn("MAT1,1,6.895+10", deck)
            self.write(folder + "/boom.bdf", deck.replace("MAT1,1,6.895+10", "MAT1,1," + modulus))
            self.bough("reduce", folder + "/boom.toml", "-o", folder + "/boom.h5")
            self.bough("export", folder + "/boom.h5", "--to", "flat", "-o", folder + "/boom.flat")
            with open(self.path(folder + "/spinup.toml"), encoding="utf-8") as f:
                self.write(folder + "/s.toml", f.read().replace("boom.h5", "boom.flat"))
            simulation = Simulation(Model(self.path(folder + "/s.toml")))
            for state in states:
                with self.assertRaisesRegex(RuntimeError, "embed.bad-state"):
                    simulation.restore(state)
            states.append(simulation.save())

    def test_inputs_are_known_everywhere(self):
        self.write("arm.toml", ARM.replace('dims = "F L"', 'dims = "F L"\nstart = 0.5'))
        self.assertIn("1 input", self.bough("check", "arm.toml", "--diagram", "arm.dot").stdout)
        with open(self.path("arm.dot"), encoding="utf-8") as f:
            self.assertIn('"input torque" -> "controller sum"', f.read())
        self.bough("convert", "arm.toml", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.toml")
        with open(self.path("mm.toml"), encoding="utf-8") as f:
            self.assertIn("start = 500", f.read())
        self.write("plain.toml", ARM.replace("friction = {coulomb = 0.4}\n", "").replace("restitution = 0.4", "stiffness = 1.0"))
        self.bough("linearize", "plain.toml", "--inputs", "torque,motor", "--outputs", "tip", "-o", "l.h5")
        with h5py.File(self.path("l.h5")) as f:
            np.testing.assert_allclose(f["B"][:, 0], f["B"][:, 1], atol=1e-12)  # the sum passes it on to the motor

    def test_it_links_nothing_but_the_system(self):
        said = subprocess.run(["ldd", os.environ["BOUGH_LIBRARY"]], capture_output=True, text=True, check=True).stdout
        for name in ("hdf5", "petsc", "slepc", "mpi", "blas", "lapack", "mumps"):
            self.assertNotIn(name, said)
        said = subprocess.run(["nm", "-D", "--defined-only", os.environ["BOUGH_LIBRARY"]], capture_output=True, text=True,
                              check=True).stdout
        names = {line.split()[-1] for line in said.splitlines()}
        self.assertTrue(all(name.startswith("bough_") for name in names), sorted(names)[:5])

    def test_ten_thousand_simulations_leave_nothing(self):
        self.write("arm.toml", ARM)

        def get_memory():
            with open("/proc/self/statm", encoding="ascii") as f:
                return int(f.read().split()[1])

        before = 0
        for k in range(1200):
            model = Model(self.path("arm.toml"))
            simulation = Simulation(model)
            simulation.set_inputs(0, 1.0)
            simulation.advance(0.01)
            simulation.close()
            model.close()
            if k == 200:
                before = get_memory()
        self.assertLess(get_memory() - before, 200)  # pages
        self.assertEqual(Model(self.path("arm.toml")).names(INPUTS), ["torque"])


if __name__ == "__main__":
    unittest.main()
