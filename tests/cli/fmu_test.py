"""FMUs against the program: Co-Simulation and Model Exchange of FMI 2.0 and 3.0 move as `bough run` moves the system."""
import ctypes
import os
import shutil
import subprocess
import threading
import unittest
import zipfile

import numpy as np
import scipy.io

from embed_test import ARM
from fmu_case import SLIDE, TIGHT, FmuCase, with_integrator
from fmu_importer import ERROR, REAL, SIZE, Failed, Instance, MeRun
from propellant_test import ROCKET
from support import PROGRAM, get_astray
from toml_text import table, toml

# A tank that a function drains, and one whose liquid sloshes.
MORE_TANKS = toml(
    table("function", "leak", "ramp", value=-0.6, from_=0.2, to=1.4),
    table("function", "full", "constant", value=1.5),
    table("function", "rest", "sum", of=["full", "leak"]),
    table("tank", "side", "sphere", body="stage", function="rest", position=[0.2, 0.6, 0.0], axis=[0.0, 1.0, 0.0],
          radius=0.5, density=4.0, exit_node=1, exit_radius=0.1),
    table("tank", "ballast", "cylinder", body="stage", mass=1.0, position=[0.3, -0.4, 0.0], axis=[1.0, 0.0, 0.0],
          radius=0.3, height=0.8, density=8.0, slosh=True, slosh_damping=0.02, slosh_acceleration=5.0))


class FmuTest(FmuCase):
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
        for example, body, system, duration, output_step, more in (
                ("robot-arm", "arm", "robot", 0.1, 2e-3, ""), ("satellite", "wing", "pointing", 1.0, 0.05, ""),
                ("spinup", "boom", "spinup", 1.0, 0.05, "\n[body.stiffening]\norder = 3\n")):
            with self.subTest(example=example):
                self.bough("init", example)
                folder = os.path.join(example, "")
                with open(self.path(folder + body + ".toml"), "a", encoding="utf-8") as f:
                    f.write(more)
                self.bough("reduce", folder + body + ".toml", "-o", folder + body + ".h5")
                with open(self.path(folder + system + ".toml"), encoding="utf-8") as f:
                    text = f.read()
                fixed = 'integrator = "rk4"\nstep = 2.5e-4\n'
                self.write(folder + "fixed.toml", with_integrator(text, fixed, duration, output_step))
                self.write(folder + "tight.toml", with_integrator(text, TIGHT, duration, output_step))
                for version in (2, 3):
                    self.compare_cs(folder + "fixed.toml", version)
                    self.compare_me(folder + "tight.toml", version)

    def test_tanks_that_drain_and_run_empty(self):
        """A burn of a tank that empties at an event, a second tank by a function, slosh: masses, books and parameters."""
        text = ROCKET.replace("fill = 8.0", "fill = 4.0").replace("[[function]]", MORE_TANKS + "[[function]]", 1)
        self.write("fixed.toml", with_integrator(text, 'integrator = "rk4"\nstep = 1e-3\n', 1.5, 0.05))
        self.write("tight.toml", with_integrator(text, TIGHT, 1.5, 0.05))
        channels = [word for name in ("rate", "/tanks/main/mass", "/tanks/main/flow", "/tanks/side/mass", "/actuators/engine",
                                      "/momentum/out_linear", "/momentum/out_angular", "/energy/work", "/system_mass/cg")
                    for word in ("--channel", name)]
        for version in (2, 3):
            with self.subTest(version=version):
                self.compare_cs("fixed.toml", version, options=channels)
                run = self.compare_me("tight.toml", version, options=channels)
                self.assertGreater(run.num_state_events, 0)  # the main tank is empty
        fmu = self.export("fixed.toml", 3, "--channel", "/tanks/main/mass", "--channel", "/system_mass/mass")
        instance = self.make(fmu, "cs")
        instance.set(["fill"], [6.0])
        instance.initialize()
        for k in range(10):
            instance.step(0.1 * k, 0.1)
        # 30 / 5 a second from t = 0.5 on.
        np.testing.assert_allclose(instance.get(["/tanks/main/mass"]), [6 - 6 * 0.5], rtol=1e-12)
        saved = instance.save()
        instance.step(1.0, 0.2)
        first = instance.get(["/tanks/main/mass", "/system_mass/mass"])
        instance.restore(saved)
        instance.step(1.0, 0.2)
        np.testing.assert_array_equal(instance.get(["/tanks/main/mass", "/system_mass/mass"]), first)

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

    def test_no_step_goes_past_a_stop_time(self):
        self.write("slide.toml", SLIDE.replace('action = "stop"', ""))
        for version in (2, 3):
            fmu = self.export("slide.toml", version)
            for stop in (0.75, 10.0):  # before the duration of the system file, and at it
                instance = self.make(fmu, "cs")
                instance.initialize(stop=stop)
                instance.step(0, stop - 0.5)
                with self.assertRaisesRegex(Failed, "past the stop time"):
                    instance.step(stop - 0.5, 0.6)
                terminated, reached = instance.step(stop - 0.5, 0.5 * (1 + 1e-12))
                self.assertFalse(terminated)
                self.assertAlmostEqual(reached, stop, delta=1e-11)
                np.testing.assert_allclose(instance.get(["x:x"]), [stop ** 2 / 4], rtol=1e-9)
                with self.assertRaisesRegex(Failed, "past the stop time"):
                    instance.step(stop, 0.1)
            with self.assertRaisesRegex(Failed, "not allowed in the state Instantiated of the instance"):
                self.make(fmu, "cs").step(0, 0.1)

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
