"""FMUs as controllers: the law of a shared library bit for bit, states that are saved, and what goes wrong, in words."""
import os
import resource
import subprocess
import sys
import unittest
import zipfile

import h5py
import numpy as np

from fmu_sources import LIBRARY, compile_library, make_fmu
from host import Model
from support import HANG, PROGRAM, SLOWER, SOURCE, ProgramTest
from four_bar import write_bars
from toml_text import Bare, section, table, toml

ON = table("function", "on", "constant", value=1.0)
LAW = table("controller", "law", inputs=["angle", "rate", "on"]) + "{law}\n"
SYSTEM = toml(
    table("body", "rotor", mass=1.0, inertia=[1.0, 1.0, 2.0]),
    table("hinge", "axis", "revolute", child="rotor", position=[0.3]),
    ON,
    table("sensor", "angle", "hinge_angle", hinge="axis"),
    table("sensor", "rate", "hinge_rate", hinge="axis"),
    LAW,
    table("actuator", "drive", "hinge", hinge="axis", input="law:1"),
    section("simulation", duration=Bare("{duration}"), output_step=0.005, integrator="rk4", step=0.005))
FIRST = SYSTEM.partition('input = "')[2].partition('"')[0]
FMU = """type = "fmu"
file = "law.fmu"
parameter_names = ["kp", "kd", "fault"]
parameters = [6.0, 4.0, {fault}]
sample_time = 0.01
{more}"""


# A four-bar linkage, its crank driven by a law.
def write_four_bar(rest, controller, duration, integrator):
    """The system: `rest` are further tables, `controller` drives the crank."""
    return toml(
        write_bars(("crank", 0.5, 0.3, [0.0001, 0.004, 0.004]), ("coupler", 0.6, 1.0, [0.0001, 0.05, 0.05]),
                   ("rocker", 0.8, 0.8, [0.0001, 0.043, 0.043])),
        table("hinge", "axis", "revolute", child="crank", position_deg=60.0, rate=1.0),
        table("hinge", "pin", "revolute", parent="crank", parent_node=1, child="coupler"),
        table("hinge", "pivot", "revolute", parent_position=[1.0, 0.0, 0.0], child="rocker", position_deg=90.0, guess=True),
        table("constraint", "closure", "revolute", parent="coupler", parent_node=1, child="rocker", child_node=1),
        table("sensor", "angle", "hinge_angle", hinge="axis"),
        table("sensor", "rate", "hinge_rate", hinge="axis"),
        table("sensor", "rocker", "hinge_angle", hinge="pivot"),
        rest,
        table("actuator", "drive", "hinge", hinge="axis", input=controller),
        section("simulation", duration=duration, output_step=0.005, integrator=integrator, step=0.005,
                gravity=[0.0, -9.81, 0.0]))


MODULE = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "python")
THREADS = """
import sys, threading
import numpy as np
import bough
def move(system, torque, rows):
    simulation = bough.Simulation(system)
    for k in range(1, 101):
        simulation.set("more", torque)
        simulation.advance_to(0.005 * k)
        rows.append(np.concatenate([simulation.outputs(["angle"]), simulation.outputs(["/controllers/law"])]))
torques = [0.0, 0.5]
for shared in (True, False):
    first = bough.System("s.toml")
    systems = [first if shared else bough.System("s.toml") for _ in torques]
    alone, together = [[], []], [[], []]
    for rows, system, torque in zip(alone, systems, torques):
        move(system, torque, rows)
    threads = [threading.Thread(target=move, args=of) for of in zip(systems, torques, together)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    np.testing.assert_array_equal(alone, together)
    assert np.abs(np.subtract(*together)).max() > 1e-3
print("alike")
"""


class FmuControllers(ProgramTest):
    def make(self, fault=0, more="", duration=1.0, law=None, name="s.toml"):
        return self.write(name, SYSTEM.format(law=law or FMU.format(fault=fault, more=more), duration=duration))

    def make_fmu(self, *args, **options):
        make_fmu(self.path("law.fmu"), *args, **options)

    def read(self, name):
        with h5py.File(self.path(name)) as f:
            return f["sensors/angle"][:], f["controllers/law"][:]

    def read_text(self, name="s.toml"):
        with open(self.path(name), encoding="utf-8") as f:
            return f.read()

    def test_library_and_both_versions_are_the_same(self):
        compile_library(self.path("law.so"), LIBRARY, "-I" + os.path.join(SOURCE, "solver/control"))
        self.make(law='type = "library"\nfile = "law.so"\nparameters = [6.0, 4.0]\nsample_time = 0.01', name="library.toml")
        self.bough("run", "library.toml")
        angle, law = self.read("library.h5")
        self.assertLess(abs(angle[-1]), 0.1)
        self.assertEqual(law[-1, 1], 100)
        for version in (2, 3):
            for saves in (True, False):
                self.make_fmu(version, saves)
                self.make(name="fmu.toml")
                self.bough("run", "fmu.toml")
                for left, right in zip(self.read("fmu.h5"), (angle, law)):
                    np.testing.assert_array_equal(left, right, f"FMI {version}, saves {saves}")

    def test_recommended_step_and_chosen_names(self):
        self.make_fmu(2)
        law = FMU.format(fault=0, more='input_names = ["angle", "rate", "enable"]\noutput_names = ["torque"]')
        self.make(law=law.replace("sample_time = 0.01\n", ""))
        self.bough("run", "s.toml")
        self.assertEqual(self.read("s.h5")[1].ndim, 1)
        self.make_fmu(3)  # recommends none
        self.make(law=FMU.format(fault=0, more="").replace("sample_time = 0.01\n", ""))
        self.fails(1, "run", "s.toml", error="fmu.no-step", says=["controller 'law'", "give sample_time"])

    def test_elements_aliases_and_start_values(self):
        self.make_fmu(3)
        self.make()
        self.bough("run", "s.toml")
        expected = self.read("s.h5")

        def run(change=lambda x: x, more="", swap=False):
            self.make_fmu(3, change=change)
            self.make(more=more)
            if swap:
                with open(self.path("s.toml")) as f:
                    text = f.read()
                self.write("s.toml", text.replace('inputs = ["angle", "rate", "on"]', 'inputs = ["rate", "angle", "on"]'))
            self.bough("run", "s.toml")
            return self.read("s.h5")

        alias = lambda x: x.replace('causality="output"/>', 'causality="output"><Alias name="moment"/></Float64>', 1)
        for change, more, swap in [(lambda x: x, 'input_names = ["angle[1]", "angle[2]", "enable"]', False),
                                   (lambda x: x, 'input_names = ["angle[2]", "angle[1]", "enable"]', True),
                                   (alias, 'output_names = ["moment", "count"]', False)]:
            for left, right in zip(run(change, more, swap), expected):
                np.testing.assert_array_equal(left, right, more)
        # Outputs are signals by their names, as they are by their counts, in the system file and in the results.
        array = lambda x: x.replace('"output"/>', '"output"><Dimension start="2"/><Alias name="moment"/></Float64>', 1)
        for change, more, name in [
                (lambda x: x, "", "torque"), (alias, 'output_names = ["moment", "count"]', "moment"), (array, "", "torque[1]"),
                (array, 'output_names = ["moment[1]", "count"]', "moment[1]"), (array, 'output_names = ["moment", "count"]', "moment[1]"),
                (lambda x: x.replace('"torque"', '"a:b"'), "", "1"), (lambda x: x, 'output_names = ["torque"]', "torque")]:
            self.make_fmu(3, change=change)
            self.make(more=more)
            text = self.read_text().replace(FIRST, FIRST.replace("1", name))
            channel = "/controllers/" + FIRST.replace("1", name)
            self.write("s.toml", text + f'[[event]]\nname = "low"\nsignal = "{channel}"\nvalue = -1.0\naction = "log"\n')
            self.bough("run", "s.toml")
            angle, outputs = self.read("s.h5")
            np.testing.assert_array_equal(angle, expected[0], name)
            self.bough("plot", "s.h5", "--sensor", channel, "-o", "plot.svg")
            self.bough("export", "s.h5", "--to", "csv", "-o", "s.csv")
            self.assertIn((channel if outputs.ndim > 1 else channel.partition(":")[0])[1:], self.read_text("s.csv").partition("\n")[0])
        self.make_fmu(3)
        self.make()
        self.write("s.toml", self.read_text().replace(FIRST, FIRST.replace("1", "torques")))
        self.fails(1, "check", "s.toml", error="control.unknown-signal", says=["'torques'", "its components are torque, count"])
        # The rate keeps its start value, which the derivative gain makes a constant torque.
        start = lambda x: x.replace('start="0 0"', 'start="0 0.25"')
        self.make_fmu(3, change=start)
        text = SYSTEM.format(law=FMU.format(fault=0, more='input_names = ["angle[1]", "enable"]'), duration=1.0)
        self.write("s.toml", text.replace('"angle", "rate", "on"', '"angle", "on"').replace("[6.0, 4.0", "[0.0, 4.0"))
        self.bough("run", "s.toml")
        torque = self.read("s.h5")[1][:, 0]
        np.testing.assert_array_equal(torque[2:], -1.0)  # from the first step of 0.01 on

        self.make_fmu(3)
        for names, says in [('["angle", "angle[2]"]', "'input_names' names 'angle' twice"),
                            ('["enable", "angle", "enable"]', "'input_names' names 'enable' twice")]:
            self.make(more="input_names = " + names)
            self.fails(1, "check", "s.toml", error="fmu.bad-variable", says=[says])
        for name in ("angle[3]", "angle[0]", "angle[1,1]", "angle[1", "enable[1]"):
            self.make(more=f'input_names = ["{name}"]')
            self.fails(1, "check", "s.toml", error="fmu.unknown-variable", says=[f"has no input '{name}'"])

    def test_string_parameters(self):
        for version in (2, 3):
            self.make_fmu(version)
            self.make(more='string_parameters = ["title=a = b"]')
            self.bough("run", "s.toml")
            self.make(more='string_parameters = ["title=other"]')
            self.fails(1, "check", "s.toml", error="control.bad-library",
                       says=[f"fmi{version}SetString returned 3 (error)"])
            for text, error, says in [("title", "fmu.bad-variable", "expected NAME=VALUE"),
                                      ("kp=2", "fmu.bad-variable", "'kp' of its FMU is no single string"),
                                      ("name=x", "fmu.unknown-variable", "has no parameter 'name'")]:
                self.make(more=f'string_parameters = ["{text}"]')
                self.fails(1, "check", "s.toml", error=error, says=[says])

    def test_state_is_saved(self):
        for version in (2, 3):
            self.make_fmu(version)
            self.make()
            self.bough("run", "s.toml", "-o", "whole.h5")
            self.make(duration=0.375)
            self.bough("run", "s.toml", "-o", "parts.h5")
            self.make()
            self.bough("run", "s.toml", "-o", "parts.h5", "--resume")
            for left, right in zip(self.read("parts.h5"), self.read("whole.h5")):
                np.testing.assert_array_equal(left, right)
            self.make_fmu(version, saves=False)
            self.make(duration=0.375)
            self.bough("run", "s.toml", "-o", "parts.h5")
            self.make()
            before = self.read("parts.h5")
            self.fails(1, "run", "s.toml", "-o", "parts.h5", "--resume", error="control.cannot-resume",
                       says=["controller 'law'"])
            with h5py.File(self.path("parts.h5")) as f:
                self.assertEqual(f.attrs["completed"], 1)
            for left, right in zip(self.read("parts.h5"), before):
                np.testing.assert_array_equal(left, right)

    def test_two_of_one_file(self):
        self.make_fmu(3)
        text = SYSTEM.format(law=FMU.format(fault=0, more=""), duration=0.5)
        second = text[text.index("[[controller]]"):text.index("[[actuator]]")].replace('"law"', '"other"').replace("6.0", "9.0")
        self.write("s.toml", text.replace("[[actuator]]", second + "[[actuator]]", 1))
        self.bough("run", "s.toml")
        with h5py.File(self.path("s.h5")) as f:
            law, other = f["controllers/law"][:], f["controllers/other"][:]
        np.testing.assert_array_equal(law[:, 1], other[:, 1])
        self.assertGreater(np.abs(other[2:20, 0] - law[2:20, 0]).max(), 0.1)

    def test_faults_have_names(self):
        for version in (2, 3):
            self.make_fmu(version)
            for fault, says in [(1, [f"fmi{version}DoStep returned 3 (error): tank 7 is empty"]),
                                (2, [f"fmi{version}DoStep returned 2 (discard)"]), (3, ["the end of the simulation"]),
                                (4, ["its output 'torque' is"]), (7, ["returned 4 (fatal)"]), (6, ["SIGSEGV"])]:
                self.make(fault=fault)
                self.fails(3, "run", "s.toml", says=["controller 'law'", f"at t = 0.0{2 if fault == 4 else 3}", *says])
                with h5py.File(self.path("s.h5")) as f:
                    self.assertFalse(f.attrs["completed"])
        os.mkdir(self.path("tmp"))
        for fault, code in ((0, 0), (1, 3)):
            self.make(fault=fault)
            self.bough("run", "s.toml", code=code, env={"TMPDIR": self.path("tmp")})
            self.assertEqual(os.listdir(self.path("tmp")), [])

    def test_a_second_interrupt_ends_one_that_does_not_return(self):
        self.make_fmu(3)
        self.make(fault=9)
        process, _ = self.start_held("run", "s.toml")
        self.interrupt_twice(process, "(interrupted a second time|told to end 5 s ago and still) in controller '.*': "
                                      "update of its FMU .* at t = 0.03")

    def test_refused_files(self):
        def refuse(error, *says, code=1, **more):
            self.make(**more)
            self.fails(code, "check", "s.toml", error=error, says=says)

        refuse("fmu.no-file", "there is no FMU", "s.toml")
        self.write("law.fmu", "no zip")
        refuse("fmu.bad-archive")
        with zipfile.ZipFile(self.path("law.fmu"), "w") as archive:
            archive.writestr("a.txt", "a")
        refuse("fmu.bad-archive", "no modelDescription.xml")
        with open(self.path("law.fmu"), "rb") as f:
            whole = f.read()
        self.make_fmu(3, files=[("../outside.txt", "bad")])
        refuse("fmu.bad-archive", "'../outside.txt' leads out of the folder")
        self.make_fmu(3)
        with open(self.path("law.fmu"), "rb") as f:
            whole = f.read()
        with open(self.path("law.fmu"), "wb") as f:
            f.write(whole[:-200])
        refuse("fmu.bad-archive")
        for change, error, says in [
                (lambda x: x[:200], "fmu.bad-description", "is no XML"),
                (lambda x: x.replace("fmiModelDescription", "model"), "fmu.bad-description", "fmiModelDescription"),
                (lambda x: x.replace('"3.0"', '"1.0"'), "fmu.version", "'1.0'"),
                (lambda x: x.replace("CoSimulation", "ModelExchange"), "fmu.no-cosimulation", "no Co-Simulation"),
                (lambda x: x.replace('modelIdentifier="law"', 'modelIdentifier="../law"'), "fmu.bad-description", "../law"),
                (lambda x: x.replace('name="kd"', 'name="kp"'), "fmu.bad-description", "two variables named 'kp'"),
                (lambda x: x.replace('name="kd"', 'name="kds"'), "fmu.unknown-variable", "has no parameter 'kd'"),
                (lambda x: x.replace("UInt8", "String"), "fmu.bad-variable", "'fault' of its FMU is a string"),
                (lambda x: x.replace('<Dimension start="2"/>', '<Dimension valueReference="9"/>'), "fmu.bad-variable", "size of 'angle'"),
                (lambda x: x.replace("{token}", "{other}"), "control.bad-library", "the token is wrong")]:
            self.make_fmu(3, change=change)
            refuse(error, says)
        self.make_fmu(3, platform="x86_64-windows")
        refuse("fmu.no-platform", "binaries/x86_64-linux/law.so", "it has x86_64-windows")
        self.make_fmu(3)
        refuse("control.bad-library", "it has 2 inputs, and 3 signals are wired to it", more='input_names = ["angle"]')
        refuse("fmu.bad-variable", "3 parameters for 1", law=FMU.format(fault=0, more="").replace('["kp", "kd", "fault"]', '["kp"]'))
        self.make()
        self.bough("check", "s.toml")

    def test_what_they_cannot_do(self):
        self.make_fmu(3)
        self.make()
        said = self.bough("linearize", "s.toml").stderr  # samples are held there
        self.assertIn("[linear.fmu-held]", said)
        self.fails(1, "linearize", "s.toml", "--break", "law:1", error="linear.fmu", says=["controller 'law' is an FMU"])
        self.fails(1, "export", "s.toml", "--to", "fmu", "-o", "out.fmu", says=['its type is "fmu"'])
        with self.assertRaisesRegex(RuntimeError, r"\[control.no-fmu\]") as caught:
            Model(self.path("s.toml"))
        self.assertNotIn("unknown-key", str(caught.exception))
        result = self.bough("check", "s.toml", code=3, env={"TMPDIR": "/nowhere"})
        self.assertIn("[cli.no-temporary-folder]", result.stderr)
        # No file may grow beyond 100 bytes, as on a full disk.
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
        result = subprocess.run([PROGRAM, "check", "s.toml"], cwd=self.folder, text=True, capture_output=True,
                                preexec_fn=limit, restore_signals=False)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertIn("[fmu.unpack]", result.stderr)

    def test_a_system_of_bough_is_one(self):
        """A mass on a spring beside the rotor, as FMU that measures the angle: another program's plant in this one."""
        self.write("mass.toml", toml(
            table("input", "angle"),
            table("body", "bob", mass=2.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0], stiffness=[8.0]),
            table("actuator", "push", "hinge", hinge="slide", input="angle"),
            table("sensor", "x", "position", body="bob"),
            section("simulation", duration=1.0, integrator="rk4", step=0.01)))
        for version in (2, 3):
            self.bough("export", "mass.toml", "--to", "fmu", "--fmi", version, "-o", "law.fmu")
            text = SYSTEM.format(law='type = "fmu"\nfile = "law.fmu"\nsample_time = 0.01\noutput_names = ["x:x"]',
                                 duration=1.0).replace('["angle", "rate", "on"]', '["angle"]')
            self.write("s.toml", text.replace('input = "law:1"', 'input = "rate"'))
            self.bough("run", "s.toml")
            with h5py.File(self.path("s.h5")) as f:
                t, u, y = f["time"][:], f["sensors/angle"][:], f["controllers/law"][:]
            at = np.isclose(t / 0.01, np.round(t / 0.01), atol=1e-6)
            x, v = 0.0, 0.0  # the mass exactly, its input held for a step
            for k, (angle, seen) in enumerate(zip(u[at], y[at])):
                self.assertAlmostEqual(x, seen, delta=1e-9)
                c, s, rest = np.cos(0.02), np.sin(0.02), angle / 8
                x, v = rest + (x - rest) * c + v / 2 * s, -2 * (x - rest) * s + v * c

    def test_messages_of_its_controller(self):
        self.make_fmu(3)
        self.make(more="kp = 3.0")
        keys = self.fails(1, "check", "s.toml", error="control.unknown-key", says=["input_names", "sample_time"]).stderr
        self.assertNotIn("lent", keys)
        self.make(law=FMU.format(fault=0, more="").replace('file = "law.fmu"\n', ""))
        self.fails(1, "check", "s.toml", error="fmu.no-file", says=["controller 'law' has no 'file'"])
        self.make_fmu(3, platform="x86_64-linux/old")
        self.make()
        self.fails(1, "check", "s.toml", error="fmu.no-platform", says=["it has x86_64-linux/old/law.so"])
        self.fails(1, "convert", "s.toml", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.toml", error="toml.unit-file",
                   says=["what a shared library or an FMU computes is not known"])

    def test_integers_out_of_range_are_named(self):
        self.make_fmu(3)  # fault is a UInt8
        for fault in (256, -1, 1e300):
            self.make(fault=fault)
            self.fails(1, "check", "s.toml", error="control.bad-library",
                       says=["its variable 'fault' takes integers from 0 to 255"])
        self.make(fault=-0.4)  # rounded
        self.bough("check", "s.toml")

    def test_a_binary_without_the_status_of_a_step(self):
        """fmi2GetBooleanStatus is of use after a discarded step only."""
        for fault, code in ((0, 0), (2, 3)):
            self.make_fmu(2, without="fmi2GetBooleanStatus")
            self.make(fault=fault)
            result = self.bough("run", "s.toml", code=code)
            self.assertEqual("fmi2DoStep returned 2 (discard)" in result.stderr, fault == 2)

    def test_states_before_the_step_are_announced(self):
        """noSetFMUStatePriorToCurrentPoint promises that no state of the past is set: it may be for those that save."""
        for version in (2, 3):
            for saves, code in ((True, 0), (False, 3)):
                self.make_fmu(version, saves)
                self.make(fault=8)  # fails if the promise is given
                self.bough("run", "s.toml", code=code)

    def test_beside_a_closed_loop(self):
        compile_library(self.path("law.so"), LIBRARY, "-I" + os.path.join(SOURCE, "solver/control"))
        library = 'type = "library"\nfile = "law.so"\nparameters = [6.0, 4.0]\nsample_time = 0.01'

        def write(name, law, integrator, duration=0.75):
            self.write(name, write_four_bar(ON + LAW.format(law=law), "law:1", duration, integrator))

        for integrator in ("rk4", "implicit"):
            write("library.toml", library, integrator)
            self.bough("run", "library.toml")
            expected = self.read("library.h5")
            self.assertGreater(np.ptp(expected[0]), 0.3)
            for version in (2, 3):
                self.make_fmu(version)
                law = FMU.format(fault=0, more="")
                write("whole.toml", law, integrator)
                self.bough("run", "whole.toml")
                write("s.toml", law, integrator, 0.375)
                self.bough("run", "s.toml", "-o", "parts.h5")
                write("s.toml", law, integrator)
                self.bough("run", "s.toml", "-o", "parts.h5", "--resume")
                for name in ("whole.h5", "parts.h5"):
                    for left, right in zip(self.read(name), expected):
                        np.testing.assert_array_equal(left, right, f"FMI {version}, {integrator}, {name}")

    def test_a_closed_loop_is_one(self):
        """A four-bar linkage as FMU that a constant drives: it moves as in a run of its own."""
        given = '[[input]]\nname = "push"\nstart = 1.0\n'
        self.write("four.toml", write_four_bar(given, "push", 1.0, "rk4"))
        self.bough("run", "four.toml")
        with h5py.File(self.path("four.h5")) as f:
            expected = np.column_stack([f["sensors/angle"][:], f["sensors/rate"][:], f["sensors/rocker"][:]])
        for version in (2, 3):
            self.bough("export", "four.toml", "--to", "fmu", "--fmi", version, "-o", "law.fmu")
            law = 'type = "fmu"\nfile = "law.fmu"\nsample_time = 0.005'
            text = SYSTEM.format(law=law, duration=1.0).replace('["angle", "rate", "on"]', '["on"]')
            self.write("s.toml", text)
            self.bough("run", "s.toml")
            np.testing.assert_array_equal(self.read("s.h5")[1], expected)

    @unittest.skipUnless(os.path.isdir(MODULE) and SLOWER == 1, "no Python module")
    def test_threads_of_python(self):
        text = SYSTEM.format(law=FMU.format(fault=0, more=""), duration=1.0).replace('"law:1"', '"sum"')
        more = '[[input]]\nname = "more"\n[[controller]]\nname = "sum"\ntype = "sum"\ninputs = ["law:1", "more"]\n[simulation]'
        self.write("s.toml", text.replace("[simulation]", more))
        for version in (2, 3):
            self.make_fmu(version)
            done = subprocess.run([sys.executable, "-c", THREADS], cwd=self.folder, capture_output=True, text=True, check=False,
                                  timeout=HANG, env={**os.environ, "PYTHONPATH": MODULE})
            self.assertEqual((done.returncode, done.stdout), (0, "alike\n"), done.stderr)


if __name__ == "__main__":
    unittest.main()
