"""import bough: views of the records, errors with file and line, runs with controllers in Python."""
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import numpy as np

import bough

sys.path.insert(0, os.path.join(os.environ["BOUGH_SOURCE_DIR"], "tests/support"))
from toml_text import section, table, toml  # noqa: E402

EXAMPLES = os.path.join(os.environ["BOUGH_SOURCE_DIR"], "data", "examples")
PENDULUM = toml(
    table("body", "arm", mass=2.0, cg=[0.5, 0.0, 0.0], inertia=[0.001, 0.17, 0.17]),
    table("hinge", "pivot", "revolute", child="arm", axis=[0.0, 1.0, 0.0], position_deg=30.0),
    table("sensor", "angle", "hinge_angle", hinge="pivot"),
    table("sensor", "rate", "hinge_rate", hinge="pivot"),
    table("controller", "law"),
    "{law}\n",
    table("actuator", "motor", "hinge", hinge="pivot", input="law"),
    section("simulation", duration=1.0, output_step=0.01, integrator="rk", relative_tolerance=1e-10,
            gravity=[0.0, 0.0, -9.81]))
EXPRESSION = 'type = "expression"\ninputs = ["angle", "rate"]\nexpression = "-40*u1 - 3*u2"'
LIBRARY = 'type = "library"\ninputs = ["angle", "rate"]'


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.before = os.getcwd()
        self.addCleanup(os.chdir, self.before)
        os.chdir(self.folder)

    def write(self, name, text):
        with open(name, "w", encoding="utf-8") as out:
            out.write(text)
        return name


class InExample(InFolder):
    """In a copy of the example of the spin-up."""

    def setUp(self):
        super().setUp()
        for name in ("boom.bdf", "boom.toml", "spinup.toml"):
            shutil.copy(os.path.join(EXAMPLES, "ex01-spinup", name), self.folder)

    @contextlib.contextmanager
    def nothing_written(self):
        """The block must print nothing, not past Python either, and leave the files that there were."""
        before = sorted(os.listdir())
        read_end, write_end = os.pipe()
        kept = os.dup(1)
        os.dup2(write_end, 1)
        try:
            yield
        finally:
            os.dup2(kept, 1)
            os.close(kept)
            os.close(write_end)
        with os.fdopen(read_end) as printed:
            self.assertEqual(printed.read(), "")
        self.assertEqual(sorted(os.listdir()), before)


class Bodies(InExample):
    def test_reduce_is_the_verb(self):
        stages = []
        body = bough.reduce("boom.toml", progress=stages.append)
        self.assertTrue(stages)
        subprocess.run([os.environ["BOUGH_PROGRAM"], "reduce", "boom.toml", "-q", "-o", "verb.h5"], check=True)
        other = bough.read_flex_body("verb.h5")
        bough.call("flx", "verb.h5", "--digits", "17", "-o", "verb.FLX")
        self.assertTrue(np.array_equal(bough.read_flex_body("verb.FLX").modal_stiffness, other.modal_stiffness))
        self.assertEqual(body.num_modes, other.num_modes)
        np.testing.assert_array_equal(body.frequency_hz, other.frequency_hz)
        for name in ("modal_mass", "modal_stiffness", "effective_mass", "cg", "inertia"):
            np.testing.assert_array_equal(getattr(body, name), getattr(other, name), err_msg=name)
        for name in ("kg_inertial", "kg_external", "phi"):
            for mine, verbs in zip(getattr(body, name), getattr(other, name)):
                np.testing.assert_array_equal(mine, verbs, err_msg=name)
        for name in ("gamma0", "gamma1"):
            np.testing.assert_array_equal(getattr(body.integrals, name), getattr(other.integrals, name))
        self.assertEqual([l.name for l in body.locators], [l.name for l in other.locators])
        body.save("saved.h5")
        np.testing.assert_array_equal(bough.reader.read("saved.h5")["modes/frequency_hz"], body.frequency_hz)

    def test_arrays_are_views(self):
        body = bough.reduce("boom.bdf", modes=2)
        K = body.modal_stiffness
        self.assertTrue(np.shares_memory(K, body.modal_stiffness))
        self.assertTrue(np.shares_memory(body.exact.gamma4[0][1], body.exact.gamma4[0][1]))
        K[0, 0] *= 2
        self.assertEqual(body.modal_stiffness[0, 0], K[0, 0])
        self.assertNotEqual(body.copy().modal_stiffness.ctypes.data, K.ctypes.data)
        gamma0 = body.exact.gamma0
        kept = gamma0.copy()
        del body  # what is shown stays
        np.testing.assert_array_equal(gamma0, kept)

    def test_shapes(self):
        body = bough.reduce("boom.bdf", modes=3, interface=[11], full=True)
        n, p = body.num_modes, body.num_nodes
        self.assertEqual((n, len(body.phi), body.phi[0].shape), (3, p, (6, n)))
        self.assertEqual((body.node_xyz.shape, body.integrals.gamma0.shape), ((p, 3), (3, n)))
        self.assertEqual(body.full_phi.shape, (len(body.dof_map), n))
        self.assertEqual(body.inertial_loads.shape[1], 12)
        self.assertEqual(len(body.kg_inertial), 12)
        self.assertEqual([l.direction for l in body.locators if l.node == 11], [1, 2, 3, 4, 5, 6])

    def test_modes_and_static(self):
        modes = bough.modes("boom.bdf", 4)
        self.assertEqual(len(modes.frequency_hz), 4)
        self.assertLess(modes.residual.max(), 1e-6)
        self.assertAlmostEqual(modes.mass, bough.reduce("boom.bdf", modes=1).mass)

    def test_select(self):
        body = bough.reduce("boom.toml")
        smaller, ranking = bough.select(body, number=1)
        self.assertEqual(smaller.num_modes, 1)
        self.assertIn("total_cost", ranking)

    def test_a_body_that_was_never_written(self):
        body = bough.reduce("boom.toml")
        with open("spinup.toml", encoding="utf-8") as f:
            text = f.read().replace("duration = 20.0", "duration = 0.5")
        self.write("short.toml", text)
        ran = bough.System("short.toml", bodies={"boom.h5": body}).run()
        body.save("boom.h5")
        again = bough.System("short.toml").run("short.h5")
        np.testing.assert_array_equal(ran["tip_deflection"], again["tip_deflection"])
        np.testing.assert_array_equal(bough.read_results("short.h5")["tip_deflection"], ran["tip_deflection"])
        np.testing.assert_array_equal(bough.reader.read("short.h5")["tip_deflection"], ran["tip_deflection"])


class Errors(InFolder):
    def test_messages_have_file_and_line(self):
        self.write("bad.bdf", "SOL 103\nBEGIN BULK\nGRID,1,,0.,0.,x\nENDDATA\n")
        with self.assertRaises(bough.InputError) as raised:
            bough.reduce("bad.bdf", modes=2)
        first = raised.exception.messages[0]
        self.assertEqual((first.severity, first.file, first.line), ("error", "bad.bdf", 3))
        self.assertTrue(first.what and first.id)
        self.assertEqual(first.column, 15)  # of the x
        self.assertIn("bad.bdf:3: error:", str(raised.exception))
        self.assertIsInstance(raised.exception, bough.Failure)
        # Calls of Python fail as those of the shell do.
        for call in (lambda: bough.modes("bad.bdf", 2), lambda: bough.static("bad.bdf")):
            with self.assertRaises(bough.InputError) as raised:
                call()
            self.assertEqual([str(m) for m in raised.exception.messages], [str(first)])
            self.assertEqual((raised.exception.messages[0].line, raised.exception.exit_code), (3, 1))
            self.assertIn("bad.bdf:3: error:", str(raised.exception))
        with self.assertRaises(bough.InputError) as raised:
            bough.select("nothing.h5")
        self.assertEqual(raised.exception.messages[0].id, "cli.no-file")

    def test_numbers_of_modes(self):
        self.write("fine.bdf", "SOL 103\nBEGIN BULK\nENDDATA\n")
        with self.assertRaisesRegex(ValueError, "modes is a number of modes, 0 or more, not -1"):
            bough.reduce("fine.bdf", modes=-1)
        with self.assertRaisesRegex(ValueError, "max_hz is a frequency above 0"):
            bough.reduce("fine.bdf", max_hz=-5.0)

    def test_names_that_are_slips(self):
        with self.assertRaises(bough.InputError):
            bough.System("nothing.toml")
        results = bough.System.from_text(PENDULUM.format(law=EXPRESSION)).run()
        with self.assertRaisesRegex(KeyError, "angel.*did you mean"):
            results["/sensors/angel"]
        with self.assertRaisesRegex(bough.InputError, 'there is no controller "lwa".*control.unknown-controller'):
            bough.System.from_text(PENDULUM.format(law=LIBRARY), controllers={"lwa": lambda t, u: 0})
        with self.assertRaises(bough.InputError):
            bough.modes("nothing.bdf")

    def test_computations_that_fail(self):
        text = PENDULUM.format(law=EXPRESSION).replace("-40*u1", "4e9*u1").replace("3*u2", "9e9*u2")
        text = text.replace('integrator = "rk"', 'integrator = "rk4"\nstep = 0.01')
        with self.assertRaises(bough.ComputationError) as raised:
            bough.System.from_text(text).run()
        self.assertEqual(raised.exception.exit_code, 3)


class Law:
    """A first-order filter of the rate, and a sum that samples count."""
    num_states = 1

    def __init__(self, gain):
        self.gain = gain

    def outputs(self, t, u, z, d):
        return [-40 * u[0] - self.gain * (u[1] - z[0])]

    def derivatives(self, t, u, z, d):
        return (u[1] - z[0]) / 0.5

    def start(self):
        return [0.25], []


class Sampled:
    num_memory = 2
    closed = 0

    def outputs(self, t, u, z, d):
        return -40 * u[0] - d[1]

    def update(self, t, u, z, d):
        return [d[0] + 1, 0.9 * d[1] + 0.1 * u[1]]

    def close(self):
        Sampled.closed += 1


class Controllers(InFolder):
    def run_with(self, law, more=""):
        return bough.System.from_text(PENDULUM.format(law=LIBRARY + more), controllers={"law": law}).run()

    def test_a_function_is_the_expression(self):
        expected = bough.System.from_text(PENDULUM.format(law=EXPRESSION)).run()
        given = self.run_with(lambda t, u: -40 * u[0] - 3 * u[1])
        np.testing.assert_allclose(given["angle"], expected["angle"], rtol=0, atol=1e-12)
        self.assertLess(given.energy_error, 1e-8)

    def test_states(self):
        matrices = ('type = "state_space"\ninputs = ["angle", "rate"]\nA = [[-2.0]]\nB = [[0.0, 2.0]]\n'
                    "C = [[3.0]]\nD = [[-40.0, -3.0]]\ninitial = [0.25]")
        expected = bough.System.from_text(PENDULUM.format(law=matrices)).run()
        np.testing.assert_allclose(self.run_with(Law(3))["angle"], expected["angle"], rtol=0, atol=1e-9)

    def test_samples(self):
        before = Sampled.closed
        given = self.run_with(Sampled(), "\nsample_time = 0.1")
        law = given["/controllers/law"]
        self.assertLessEqual(len(np.unique(law)), 11)
        self.assertEqual(Sampled.closed, before + 1)

    def test_what_it_raises_ends_the_run_by_name(self):
        def law(t, u):
            if t > 0.5:
                raise ValueError("no such thing")
            return 0

        with self.assertRaisesRegex(bough.ComputationError, "law.*t = 0.5.*no such thing"):
            self.run_with(law)
        with self.assertRaisesRegex(bough.ComputationError, "2 numbers, expected 1"):
            self.run_with(lambda t, u: u)
        with self.assertRaisesRegex(bough.InputError, "Python law .*neither be called"):
            self.run_with(3)

    def test_words_are_of_python(self):
        def law(t, u):
            raise ValueError("sorry")

        with self.assertRaises(bough.ComputationError) as raised:
            self.run_with(law)
        message = raised.exception.messages[0]
        self.assertIn("outputs of its Python law at t = 0 raised ValueError: sorry", message.what)
        self.assertEqual(message.advice, "correct the Python law")
        with self.assertRaisesRegex(bough.ComputationError, "gave None, expected 1 number; is a return missing"):
            self.run_with(lambda t, u: None)

    def test_not_a_number_is_named(self):
        with self.assertRaisesRegex(bough.ComputationError, "law"):
            self.run_with(lambda t, u: float("nan") if t > 0.2 else 0)


class Runs(InFolder):
    def test_progress_and_stop(self):
        system = bough.System.from_text(PENDULUM.format(law=EXPRESSION))
        seen = []
        system.run(progress=lambda t, end: seen.append((t, end)))
        self.assertGreaterEqual(len(seen), 100)
        self.assertEqual(seen[-1][1], 1.0)
        stopped = system.run(progress=lambda t, end: t < 0.3)
        self.assertFalse(stopped.completed)
        self.assertLess(stopped.time[-1], 0.5)
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            system.run(progress=lambda t, end: 1 / 0)

    def test_other_threads_go_on(self):
        """The run ends only because another thread has counted meanwhile."""
        system = bough.System.from_text(PENDULUM.format(law=EXPRESSION).replace("duration = 1.0", "duration = 2e5"))
        counts = [0]
        done = threading.Event()

        def count():
            while not done.is_set():
                counts[0] += 1
                done.wait(0.0005)

        thread = threading.Thread(target=count)
        thread.start()
        results = system.run(progress=lambda t, end: counts[0] <= 3)
        done.set()
        thread.join()
        self.assertFalse(results.completed)
        self.assertGreater(counts[0], 3)

    def test_two_systems_at_once(self):
        expected = bough.System.from_text(PENDULUM.format(law=EXPRESSION)).run()["angle"]
        found = [None, None]

        def run(k):
            found[k] = bough.System.from_text(PENDULUM.format(law=LIBRARY), controllers={
                "law": lambda t, u: -40 * u[0] - 3 * u[1]}).run()["angle"]

        threads = [threading.Thread(target=run, args=(k,)) for k in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for angle in found:
            np.testing.assert_allclose(angle, expected, rtol=0, atol=1e-12)

    def test_parameters(self):
        text = "[parameters]\nkp = 40.0\n" + PENDULUM.format(
            law='type = "pid"\ninputs = "angle"\nkp = "$kp"\nkd = 3.0\nrate = "rate"')
        self.write("p.toml", text)
        stiff = bough.System("p.toml", parameters={"kp": 400.0}).run()
        soft = bough.System("p.toml").run()
        self.assertLess(np.abs(stiff["angle"][-1]), np.abs(soft["angle"][-1]))

    def test_a_text_takes_what_a_file_takes(self):
        text = "[parameters]\nkp = 40.0\n" + PENDULUM.format(
            law='type = "pid"\ninputs = "angle"\nkp = "$kp"\nkd = 3.0\nrate = "rate"')
        self.write("p.toml", text)
        of_file = bough.System("p.toml", parameters={"kp": np.float64(400.0)}).run("whole.h5")
        of_text = bough.System.from_text(text, parameters={"kp": 400}).run()
        np.testing.assert_array_equal(of_file["angle"], of_text["angle"])
        again = bough.System.from_text(text, parameters={"kp": 400.0}, start_from="whole.h5").run()
        self.assertAlmostEqual(again["angle"][0], of_file["angle"][-1], delta=1e-12)
        with self.assertRaisesRegex(bough.InputError, "kq"):
            bough.System.from_text(text, parameters={"kq": 1.0})

    def test_states_of_controllers_out_of_an_equilibrium(self):
        law = 'type = "pid"\ninputs = "angle"\nkp = 40.0\nki = 10.0\nkd = 3.0\nfilter = 0.02\nsetpoint = 0.2'
        self.write("p.toml", PENDULUM.format(law=law))
        bough.call("equilibrium", "p.toml", "-o", "rest.h5")
        system = bough.System("p.toml", start_from="rest.h5")
        rest = bough.read_results("rest.h5")["angle"][0]
        np.testing.assert_allclose(system.run()["angle"], rest, rtol=0, atol=1e-7)
        simulation = bough.Simulation(system)
        for t in (0.1, 0.3):
            simulation.advance_to(t)
            self.assertAlmostEqual(simulation.output("angle"), rest, delta=1e-7)

    def test_what_an_event_locked_is_a_start(self):
        text = PENDULUM.format(law=EXPRESSION) + '\n[[event]]\nname = "latch"\ntime = 0.2\naction = "lock"\nhinge = "pivot"\n'
        bough.System.from_text(text).run("first.h5")
        rest = bough.read_results("first.h5")["angle"][-1]
        system = bough.System.from_text(text.replace("time = 0.2", "time = 1e6"), start_from="first.h5")
        np.testing.assert_allclose(system.run()["angle"], rest, rtol=0, atol=1e-12)
        self.assertEqual(system.linearize(open=True).A.shape, (0, 0))
        simulation = bough.Simulation(system)
        simulation.advance_to(0.3)
        self.assertAlmostEqual(simulation.output("angle"), rest, delta=1e-12)

    def test_messages_name_the_text(self):
        text = PENDULUM.format(law=EXPRESSION).replace("mass = 2.0", 'mass = "heavy"')
        for given, file in (({}, "<text>"), ({"name": "arm"}, "arm"), ({"folder": "models"}, "models/<text>")):
            with self.assertRaises(bough.InputError) as raised:
                bough.System.from_text(text, **given)
            self.assertEqual((raised.exception.messages[0].file, raised.exception.messages[0].line), (file, 3))

    def test_results_are_arrays_by_name(self):
        results = bough.System.from_text(PENDULUM.format(law=EXPRESSION)).run()
        self.assertEqual(results["angle"].shape, (101,))
        self.assertEqual(results.time.shape, (101,))
        self.assertIn("/energy/kinetic", results)
        self.assertNotIn("nothing", results)
        self.assertIn("/sensors/angle", list(results))
        self.assertTrue(results.completed)
        self.assertIsInstance(results.describe("angle"), str)


class Threads(InFolder):
    """MPI, PETSc and HDF5 in many threads at once, each with separate files."""
    COUNT = 8

    def setUp(self):
        super().setUp()
        for name in ("boom.bdf", "boom.toml", "spinup.toml"):
            shutil.copy(os.path.join(EXAMPLES, "ex01-spinup", name), self.folder)

    def run_all(self, work):
        """The values of work(k) of COUNT threads that start together."""
        start = threading.Barrier(self.COUNT)
        found = [None] * self.COUNT

        def act(k):
            start.wait()
            found[k] = work(k)

        threads = [threading.Thread(target=act, args=(k,)) for k in range(self.COUNT)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        return found

    def test_the_first_calls_of_many(self):
        """In a process that has started neither MPI nor HDF5."""
        self.write("first.py", "import threading, bough\n"
                   "def work(k):\n"
                   "    start.wait()\n"
                   "    found.append(len(bough.modes('boom.bdf', 3).frequency_hz))\n"
                   f"found, start = [], threading.Barrier({self.COUNT})\n"
                   f"threads = [threading.Thread(target=work, args=(k,)) for k in range({self.COUNT})]\n"
                   "[t.start() for t in threads]; [t.join() for t in threads]\n"
                   "print(found)\n")
        ran = subprocess.run([sys.executable, "-B", "first.py"], text=True, capture_output=True)
        self.assertEqual((ran.returncode, ran.stdout), (0, f"{[3] * self.COUNT}\n"), ran.stderr)

    def test_everything_at_once(self):
        text = PENDULUM.format(law=EXPRESSION)
        body = bough.reduce("boom.bdf", modes=3)
        body.save("boom.h5")
        hz, stiffness = bough.modes("boom.bdf", 3).frequency_hz.copy(), body.modal_stiffness.copy()
        angle = bough.System.from_text(text).run()["angle"]
        poles = bough.System.from_text(text).linearize(at=0.1).poles

        def work(k):
            found = []
            for _ in range(2):
                found.append(np.array_equal(bough.read_flex_body("boom.h5").modal_stiffness, stiffness))
                found.append(np.array_equal(bough.System.from_text(text).run(f"r{k}.h5")["angle"], angle))
                found.append(np.array_equal(bough.read_results(f"r{k}.h5")["angle"], angle))
                found.append(np.array_equal(bough.System.from_text(text).run()["angle"], angle))
                found.append(np.allclose(bough.System.from_text(text).linearize(at=0.1).poles, poles))
                found.append(np.allclose(bough.modes("boom.bdf", 3).frequency_hz, hz))
                bough.reduce("boom.bdf", modes=3).save(f"b{k}.h5")
                found.append(np.allclose(bough.read_flex_body(f"b{k}.h5").modal_stiffness, stiffness))
            return all(found)

        self.assertEqual(self.run_all(work), [True] * self.COUNT)

    def test_errors_are_those_of_each(self):
        def work(k):
            self.write(f"bad{k}.bdf", f"SOL 103\nCEND\nBEGIN BULK\nGRID,{k + 1},,x,0.,0.\nENDDATA\n")
            try:
                bough.modes(f"bad{k}.bdf", 3)
            except bough.InputError as error:
                return [message.file for message in error.messages if message.line == 4]
            return None

        for k, files in enumerate(self.run_all(work)):
            self.assertEqual(files, [f"bad{k}.bdf"])

    def test_runs_go_on_in_parallel(self):
        """Each run waits in its controller until all runs have reached it, runs that write a file too."""
        for name in (None, "r{}.h5"):
            together = threading.Barrier(self.COUNT, timeout=600)

            def work(k):
                waits = [True]

                def law(t, u):
                    if waits and t > 0.1:
                        waits.pop()
                        together.wait()
                    return -40 * u[0] - 3 * u[1]

                system = bough.System.from_text(PENDULUM.format(law=LIBRARY), controllers={"law": law})
                return system.run(name.format(k) if name else None).completed

            self.assertEqual(self.run_all(work), [True] * self.COUNT)

    def test_a_callback_may_call_again(self):
        bough.reduce("boom.bdf", modes=2).save("boom.h5")

        def work(k):
            sizes = []
            bough.reduce("boom.bdf", modes=2, progress=lambda stage: sizes.append(bough.read_flex_body("boom.h5").num_modes))
            return set(sizes)

        self.assertEqual(self.run_all(work), [{2}] * self.COUNT)


class Verbs(InFolder):
    def test_call_is_the_shell(self):
        self.assertIn("reduce", bough.verbs())
        self.assertEqual(bough.call("modes", "nothing.bdf"), 1)
        self.assertEqual(bough.call("modes"), 2)


class Reader(unittest.TestCase):
    def test_does_without_the_module(self):
        code = ("import sys, importlib.util as u; s = u.spec_from_file_location('reader', sys.argv[1]); "
                "m = u.module_from_spec(s); s.loader.exec_module(m); print(m.File)")
        path = os.path.join(os.path.dirname(bough.__file__), "reader.py")
        self.assertIn("File", subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True,
                                             check=True).stdout)

    def test_every_name_of_a_file(self):
        """Datasets that the file links twice have both names; strings, numbers and attributes are h5py's."""
        import h5py
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "body.h5")
            bough.reduce(os.path.join(EXAMPLES, "ex01-spinup", "boom.bdf"), modes=2, full=True).save(path)
            names = []

            def walk(group, before):
                for name, item in group.items():
                    if isinstance(item, h5py.Group):
                        walk(item, before + name + "/")
                    else:
                        names.append(before + name)

            read = bough.reader.read(path)
            with h5py.File(path) as f:
                walk(f, "")
                self.assertEqual(sorted(read), sorted(names))
                for name in names:
                    if not h5py.check_string_dtype(f[name].dtype):
                        np.testing.assert_array_equal(read[name], f[name][()])
            np.testing.assert_array_equal(read["mesh/grid_id"], read["grids/id"])

    def test_every_public_name_is_said(self):
        for name in bough.__all__:
            with self.subTest(name), warnings.catch_warnings():
                self.assertTrue(getattr(bough, name).__doc__)


STEPPED = PENDULUM.format(law='type = "sum"\ninputs = ["torque", "angle"]\nweights = [1.0, -5.0]').replace(
    'integrator = "rk"\nrelative_tolerance = 1e-10', 'integrator = "rk4"\nstep = 1e-3') + table(
        "input", "torque", dims="F L")
STOP = table("event", "through", signal="angle", value=0.8, action="stop")


class Simulations(InFolder):
    def make(self, text=STEPPED, **options):
        return bough.Simulation(bough.System.from_text(text, **options))

    def test_slices_are_a_run(self):
        system = bough.System.from_text(STEPPED)
        results = system.run()
        for slices in (1, 7):
            simulation = bough.Simulation(system)
            self.assertEqual(simulation.outputs(["angle"])[0], results["angle"][0])
            for k, t in enumerate(results.time[1:], 1):
                for i in range(1, slices):
                    simulation.advance_to(results.time[k - 1] + (t - results.time[k - 1]) * i / slices)
                self.assertEqual(simulation.advance_to(t), t < results.time[-1])
                for name in ("angle", "rate", "/controllers/law", "/bodies/arm/quaternion"):
                    np.testing.assert_array_equal(simulation.outputs([name]), results[name][k], name)
        self.assertEqual(simulation.reason.split(" at ")[0], "the run has reached its end")
        self.assertFalse(simulation.advance_to(1.5))

    def test_names(self):
        simulation = self.make()
        self.assertEqual(simulation.inputs, ["torque"])
        self.assertEqual(simulation.output_names[:2], ["angle", "rate"])
        values = simulation.outputs()
        self.assertEqual(values.shape, (len(simulation.output_names),))
        self.assertEqual(simulation.output("angle"), values[0])
        self.assertEqual(simulation.output(1), values[1])
        self.assertEqual(simulation.outputs(["/bodies/arm/quaternion"]).shape, (4,))
        np.testing.assert_array_equal(simulation.outputs("angle"), [values[0]])
        self.assertEqual(simulation.messages, [])
        for call in (lambda: simulation.set("torqe", 1), lambda: simulation.output("angel"),
                     lambda: simulation.outputs(["angel"])):
            with self.assertRaisesRegex(KeyError, "did you mean"):
                call()
        with self.assertRaises(IndexError):
            simulation.set(1, 0.0)
        with self.assertRaises(ValueError):
            simulation.set(0, float("nan"))

    def test_an_input_acts_from_when_it_is_set(self):
        simulation = self.make(STEPPED.replace("-5.0", "0.0").replace("gravity = [0.0, 0.0, -9.81]", ""))
        simulation.advance_to(0.5)
        start = simulation.output("angle")
        simulation.set("torque", 2.0)
        simulation.advance_to(1.0)
        inertia = 0.17 + 2.0 * 0.5 ** 2
        self.assertAlmostEqual(simulation.output("angle") - start, 2.0 / inertia * 0.5 ** 2 / 2, places=12)

    def test_states_are_saved_and_restored(self):
        one, other = self.make(), self.make()
        one.advance_to(0.1237)
        state = one.save()
        self.assertIsInstance(state, bytes)
        other.advance_to(0.9)
        other.restore(state)
        self.assertEqual(other.time, one.time)
        for simulation in (one, other):
            simulation.set(0, 1.5)
            simulation.advance_to(0.8)
        np.testing.assert_array_equal(one.outputs(), other.outputs())
        with self.assertRaisesRegex(ValueError, "restore"):
            one.advance_to(0.2)
        with self.assertRaises(bough.InputError) as caught:
            one.restore(state[:50])
        self.assertEqual(caught.exception.messages[0].id, "embed.bad-state")
        self.assertRaisesRegex(bough.InputError, "the state", one.restore, state[:-1])
        self.assertRaisesRegex(TypeError, "pass bough.System", bough.Simulation, "arm.toml")
        with self.assertRaises(bough.InputError):
            bough.Simulation(bough.System.from_text(STEPPED), step=5e-4).restore(state)

    def test_an_event_ends_it(self):
        simulation = self.make(STEPPED + STOP)
        self.assertEqual(simulation.reason, "")
        state = simulation.save()
        self.assertFalse(simulation.advance_to(1.0))
        self.assertLess(simulation.time, 1.0)
        self.assertAlmostEqual(simulation.output("angle"), 0.8, places=6)
        self.assertIn("through", simulation.reason)
        simulation.restore(state)
        self.assertEqual(simulation.reason, "")
        self.assertTrue(simulation.advance_to(1e-3))

    def test_options_and_failures(self):
        with self.assertRaises(bough.InputError):
            bough.Simulation(bough.System.from_text(STEPPED), integrator="euler")
        for option in ("step", "duration", "relative_tolerance", "absolute_tolerance"):
            for value in (-1.0, float("nan"), float("inf")):
                with self.assertRaisesRegex(ValueError, f"the option {option} is .*give a positive number"):
                    bough.Simulation(bough.System.from_text(STEPPED), **{option: value})
        longer = bough.Simulation(bough.System.from_text(STEPPED), duration=3.0)
        self.assertTrue(longer.advance_to(2.5))
        simulation = self.make()
        state = simulation.save()
        simulation.set("torque", 1e300)
        for _ in range(2):
            with self.assertRaises(bough.ComputationError):
                simulation.advance_to(1.0)
        simulation.restore(state)
        simulation.set("torque", 0.0)
        self.assertTrue(simulation.advance_to(0.5))

    def test_controllers_in_python(self):
        text = PENDULUM.format(law=LIBRARY).replace('integrator = "rk"\nrelative_tolerance = 1e-10',
                                                    'integrator = "rk4"\nstep = 1e-3')
        system = bough.System.from_text(text, controllers={"law": lambda t, u: -40 * u[0] - 3 * u[1]})
        results, simulation = system.run(), bough.Simulation(system)
        del system  # the simulation holds it
        for k, t in enumerate(results.time):
            simulation.advance_to(t)
            self.assertEqual(simulation.output("angle"), results["angle"][k])

        def law(t, u):
            if t > 0.5:
                raise RuntimeError("no more")
            return 0.0

        failing = bough.Simulation(bough.System.from_text(text, controllers={"law": law}))
        with self.assertRaisesRegex(bough.ComputationError, "no more"):
            failing.advance_to(1.0)

    def test_one_call_at_a_time(self):
        seen = []

        def law(t, u):
            try:
                simulation.output("angle")
            except RuntimeError as error:
                seen.append(str(error))
            return 0.0

        text = PENDULUM.format(law=LIBRARY)
        system = bough.System.from_text(text, controllers={"law": lambda t, u: law(t, u) if simulation else 0.0})
        simulation = None
        simulation = bough.Simulation(system)
        simulation.advance_to(0.01)
        self.assertTrue(seen and "in use" in seen[0])

    def test_threads(self):
        system, ends = bough.System.from_text(STEPPED), [None] * 4

        def move(i):
            simulation = bough.Simulation(system)
            for k in range(1, 201):
                simulation.set("torque", 1.0 if k % 2 else -0.5)
                simulation.advance_to(0.005 * k)
            ends[i] = simulation.output("angle")

        threads = [threading.Thread(target=move, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(ends)), 1, ends)


if __name__ == "__main__":
    unittest.main()
