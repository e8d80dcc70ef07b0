"""linearize, equilibrium and select from outside, against closed forms, scipy and the program's own run."""
import json
import math
import os
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.linalg
import scipy.optimize

from support import SOURCE, ProgramTest
from toml_text import Bare, section, table, toml

PENDULUM = toml(
    table("body", "bob", mass=2.0, cg=[0.0, -0.7, 0.0], nodes=[{"id": 1, "position": [0.0, -0.7, 0.0]}]),
    table("hinge", "pin", "revolute", child="bob", axis=[0.0, 0.0, 1.0], damping=0.05, position=[Bare("POSITION")]),
    table("function", "push", "constant", value=0.0),
    table("force", "push", body="bob", node=1, force=[1.0, 0.0, 0.0], function="push"),
    table("sensor", "angle", "hinge_angle", hinge="pin"),
    table("sensor", "place", "position", body="bob", node=1),
    section("simulation", duration=1.0, gravity=[0.0, -9.81, 0.0]))

HUB = toml(
    table("body", "hub", mass=3.0, cg=[0.0, 0.0, 0.0], inertia=[Bare("INERTIA"), Bare("INERTIA"), Bare("INERTIA")]),
    table("body", "boom", file="boom.h5"),
    "ETA\n",
    table("hinge", "spin", "revolute", child="hub", axis=[0.0, 0.0, 1.0]),
    "MOTION\n",
    table("hinge", "clamp", "fixed", parent="hub", child="boom"),
    table("function", "angle", "ramp", value=Bare("RATE"), from_=0.0, to=1.0),
    table("function", "nothing", "constant", value=0.0),
    table("force", "torque", body="hub", moment=[0.0, 0.0, 1.0], function="nothing"),
    table("sensor", "angle", "hinge_angle", hinge="spin"),
    table("sensor", "tip", "deflection", body="boom", node=41),
    section("simulation", duration=0.5, integrator="rk", relative_tolerance=1e-11, absolute_tolerance=1e-18))


def calc_hub_beam(mu):
    """Frequencies of a beam (L = EI = rho A = 1) clamped to a hub of inertia mu that turns freely."""
    def determinant(beta):
        c, s, ch, sh = math.cos(beta), math.sin(beta), math.cosh(beta), math.sinh(beta)
        return np.linalg.det(np.array([[2, -mu * beta**3, -mu * beta**3], [-c - ch, -s, sh], [s - sh, -c, ch]])) / ch
    grid = np.linspace(0.5, 9, 400)
    values = [determinant(b) for b in grid]
    return [scipy.optimize.brentq(determinant, a, b, xtol=1e-14)**2
            for a, b, x, y in zip(grid, grid[1:], values, values[1:]) if x * y < 0]


class LinearTest(ProgramTest):
    def make_boom(self, modes=12, more=""):
        with open(os.path.join(SOURCE, "data/decks/rotating.bdf")) as f:
            deck = self.write("boom.bdf", f.read().replace("ENDDATA", more + "ENDDATA"))
        self.write("boom.toml", f'[body]\nname = "boom"\ndeck = "{deck}"\nframe = "fixed"\ninterface = [1, 41]\n'
                                f'[body.modes]\nnumber = {modes}\n[body.output]\nfile = "boom.h5"\n')
        self.bough("reduce", "boom.toml")

    def write_hub(self, name, inertia=1.0, motion="", rate=0.0, eta=""):
        text = HUB.replace("INERTIA", str(inertia)).replace("MOTION", motion).replace("RATE", str(rate))
        return self.write(name, text.replace("ETA", eta))

    def linearize(self, *arguments):
        self.bough("linearize", *arguments, "-o", "model.h5")
        with h5py.File(self.path("model.h5")) as f:
            self.assertEqual(f.attrs["format"].decode() if isinstance(f.attrs["format"], bytes) else f.attrs["format"],
                             "bough-linear")
            out = {}
            f.visititems(lambda name, item: out.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        for key in [k for k in out if k.endswith("name") or k.endswith("mode") or k.endswith("dims")]:
            out[key] = [word.decode() for word in out[key]]
        return out


class Linearize(LinearTest):
    def test_pendulum_file_mat_and_json(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        model = self.linearize("pendulum.toml", "--outputs", "angle", "--mat", "model.mat")
        inertia = 2 * 0.7**2
        np.testing.assert_allclose(model["A"], [[0, 1], [-9.81 / 0.7, -0.05 / inertia]], atol=1e-9)
        np.testing.assert_allclose(model["B"], [[0], [0.7 / inertia]], atol=1e-12)
        np.testing.assert_allclose(model["C"], [[1, 0]], atol=1e-12)
        np.testing.assert_array_equal(model["D"], [[0]])
        self.assertEqual(model["states/name"], ["pin:1", "pin:1_dot"])
        self.assertEqual(model["inputs/name"], ["push"])
        self.assertEqual(model["outputs/name"], ["angle"])
        self.assertEqual(model["poles/mode"], ["pin:1", "pin:1"])
        np.testing.assert_allclose(model["poles/frequency_hz"], math.sqrt(9.81 / 0.7) / 2 / math.pi, rtol=1e-10)
        self.assertEqual(model["zeros/real"].shape, (0,))
        self.assertEqual(float(np.squeeze(model["operating_point/residual"])), 0)
        mat = scipy.io.loadmat(self.path("model.mat"))
        self.assertEqual(sorted(k for k in mat if k[0] != "_"),
                         ["A", "B", "C", "D", "input_name", "output_name", "state_name"])
        self.bough("export", "model.h5", "--to", "mat", "-o", "second.mat")
        mat = scipy.io.loadmat(self.path("second.mat"))
        for key, exact in (("mass", inertia), ("damping", 0.05), ("stiffness", 2 * 9.81 * 0.7), ("input_force", 0.7)):
            np.testing.assert_allclose(mat[key], [[exact]], rtol=1e-9)
        np.testing.assert_array_equal(mat["A"], model["A"])
        data = json.loads(self.bough("linearize", "pendulum.toml", "--json").stdout)
        self.assertEqual(data["outputs"], ["angle", "place:x", "place:y", "place:z"])
        np.testing.assert_allclose(data["C"], [[1, 0], [0.7, 0], [0, 0], [0, 0]], atol=1e-10)
        self.assertNotIn("zeros", data)
        text = self.bough("linearize", "pendulum.toml").stdout
        self.assertIn("0.595", text)

    def test_a_corner_in_the_state_itself_is_told(self):
        """A spring of two slopes: beside the corner either one, at it neither; central differences see no error."""
        law = "spring_table = \"law\"\n\n[[function]]\nname = \"law\"\ntype = \"table\"\nx = [-1.0, 0.2, 1.0]\ny = Y\n"
        for y, position, is_told in (("[0.0, 0.0, 40.0]", "0.2", True), ("[0.0, 0.0, 40.0]", "0.1", False),
                                     ("[-60.0, 0.0, 40.0]", "0.2", False)):
            text = PENDULUM.replace("POSITION", position).replace("damping = 0.05\n", "", 1)
            self.write("corner.toml", text.replace(f"position = [{position}]\n", f"position = [{position}]\n" + law, 1)
                       .replace("y = Y", "y = " + y))
            said = self.bough("linearize", "corner.toml").stderr
            self.assertEqual("[linear.inaccurate]" in said, is_told, (y, position, said))

    def test_each_counts_the_samples_of_the_run(self):
        """Without output_step a run has 1,000 samples and its start."""
        for step in ("", "output_step = 0.001\n", "output_step = 0.0015\n"):
            self.write("each.toml", PENDULUM.replace("POSITION", "0.1").replace("duration = 1.0\n",
                                                                               "duration = 1.0\n" + step))
            self.bough("linearize", "each.toml", "--each", "500", "-o", "each.h5")
            with h5py.File(self.path("each.h5")) as f:
                np.testing.assert_allclose(f["parameter/value"][()], [0, 0.75] if "15" in step else [0, 0.5, 1.0])

    def test_soft_poles_beside_stiff_ones_are_doubted(self):
        """Two masses on rails, a stiff strut between them, a soft spring to the wall: l^2 - 2 (1 + K) l + 2 K = 0."""
        body = table("body", "{0}", mass=1.0, cg=[0.0, 0.0, 0.0], inertia=[1.0, 1.0, 1.0])
        hinge = table("hinge", "r{0}", "prismatic", child="{0}", axis=[1.0, 0.0, 0.0],
                      parent_position=[Bare("{1}"), 0.0, 0.0], stiffness=Bare("{2}"))
        for stiff, warned in ((1e3, False), (1e12, True), (1e16, None)):
            self.write("rails.toml", body.format("a") + body.format("b") + hinge.format("a", 0.0, 2.0) +
                       hinge.format("b", 1.0, 0.0) + '[[force]]\nname = "strut"\ntype = "spring"\nbody = "a"\n'
                       f'to_body = "b"\nstiffness = {stiff}\nfree_length = 1.0\n[simulation]\nduration = 1.0\n')
            result = self.bough("linearize", "rails.toml", "--json")
            self.assertEqual("[linear.uncertain-poles]" in result.stderr, warned is True, result.stderr)
            if warned is None:
                self.assertRegex(self.bough("linearize", "rails.toml").stdout, "zero within what A is known to .*: poles? 1")
            else:
                poles = json.loads(result.stdout)["poles"]
                size, error = np.hypot(poles["real"], poles["imag"]), np.array(poles["error"])
                large = 1 + stiff + np.sqrt(1 + stiff ** 2)
                for k, exact in ((0, np.sqrt(2 * stiff / large)), (2, np.sqrt(large))):
                    self.assertLessEqual(abs(size[k] - exact), 1.01 * error[k])

    def test_at_a_time_it_is_the_state_of_the_run(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.9"))
        self.bough("run", "pendulum.toml", "-o", "run.h5")
        with h5py.File(self.path("run.h5")) as f:
            angle = np.squeeze(f["/hinges/pin/q"][-1])
        result = self.bough("linearize", "pendulum.toml", "--at", "1.0", "--outputs", "angle", "-o", "late.h5")
        self.assertIn("linear.not-steady", result.stderr)
        with h5py.File(self.path("late.h5")) as f:
            self.assertAlmostEqual(float(f["/A"][1, 0]), -9.81 / 0.7 * math.cos(angle), places=6)
            self.assertEqual(float(np.squeeze(f["/operating_point/time"][()])), 1.0)
        self.fails(1, "linearize", "pendulum.toml", "--at", "-1", error="linear.bad-time")

    def test_names(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.fails(1, "linearize", "pendulum.toml", "--inputs", "pussh", "--outputs", "place:w",
                   says=["did you mean 'push'", "linear.unknown-output"], error="linear.unknown-input")

    def test_hub_and_cantilever(self):
        self.make_boom()
        clamped = [3.5160153, 22.0344916]
        for mu in [0.1, 1.0, 10.0]:
            with self.subTest(mu=mu):
                self.write_hub("hub.toml", inertia=mu)
                model = self.linearize("hub.toml", "--outputs", "angle")
                found = np.unique(np.round(2 * math.pi * model["poles/frequency_hz"], 9))
                for omega in calc_hub_beam(mu)[:2]:
                    self.assertLess(np.abs(found / omega - 1).min(), 2e-3)
                self.assertEqual(np.count_nonzero(model["poles/frequency_hz"] == 0), 2)
                # Torque and angle at one place: the zeros are the poles with the hub held.
                zeros = model["zeros/imag"][model["zeros/imag"] > 0]
                for omega in clamped:
                    self.assertLess(np.abs(zeros / omega - 1).min(), 1e-4)
                self.assertLess(np.abs(model["zeros/real"]).max(), 1e-3)

    def test_spinning_beam(self):
        # Wright, Smith, Thresher & Wang, J. Appl. Mech. 49 (1982) 197.
        self.make_boom(20)
        for rate, flap, chord in [(2, 4.13732, 3.62180), (6, 7.36037, 4.26323)]:
            self.write_hub("spin.toml", motion='motion = "angle"', rate=rate)
            model = self.linearize("spin.toml")
            omega = np.sort(2 * math.pi * model["poles/frequency_hz"])[::2]
            self.assertLess(abs(omega[0] / chord - 1), 1e-3)
            self.assertLess(abs(omega[1] / flap - 1), 1e-3)

    def test_a_floating_beam(self):
        self.make_boom(20, "CONM2,9001,21,,1.-9\n,1.-5,,1.-5,,,1.-5\n")  # a line has no inertia about itself
        text = toml(table("body", "boom", file="boom.h5"), section("simulation", duration=1.0))
        self.write("float.toml", text)
        model = self.linearize("float.toml")
        omega = np.sort(2 * math.pi * model["poles/frequency_hz"])
        self.assertEqual(np.count_nonzero(omega == 0), 12)
        self.assertLess(abs(omega[12] / 22.3733 - 1), 5e-3)

    def test_small_motions_of_a_run_follow_the_exponential_of_A(self):
        self.make_boom(6)
        start = [1e-7, -2e-7, 0.5e-7, 1e-7, 0.3e-7, -1e-7]
        self.write_hub("hub.toml", eta=f"eta = {start}")
        self.bough("run", "hub.toml", "-o", "run.h5")
        self.write_hub("rest.toml")
        model = self.linearize("rest.toml")
        x = np.zeros(14)
        x[1:7] = start
        x = scipy.linalg.expm(model["A"] * 0.5) @ x
        with h5py.File(self.path("run.h5")) as f:
            found = np.concatenate([np.ravel(f[p][-1]) for p in ["/hinges/spin/q", "/bodies/boom/eta",
                                                                 "/hinges/spin/qdot", "/bodies/boom/eta_dot"]])
        for half in [slice(0, 7), slice(7, 14)]:
            self.assertLess(np.abs(found - x)[half].max(), 1e-6 * np.abs(x[half]).max())


class SecondOrder(LinearTest):
    """M d'' + D d' + K d = F u against A, B and the kinetic energy that a run writes."""

    def check_form(self, model):
        M, D, K, F = (model[f"second_order/{name}"] for name in "MDKF")
        n = len(M)
        np.testing.assert_allclose(M, M.T, atol=1e-12 * np.abs(M).max())
        self.assertGreater(np.linalg.eigvalsh(M).min(), 0)
        # d' = T d + v: B acts on v' alone, and A is the same in d and v as the pencil in d and d'.
        largest = max(1, np.abs(model["B"]).max(initial=0))
        np.testing.assert_allclose(np.linalg.solve(M, F), model["B"][n:], atol=1e-10 * largest)
        first = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        change = np.eye(2 * n)
        change[n:, :n] = model["A"][:n, :n]
        np.testing.assert_allclose(first @ change, change @ model["A"], atol=1e-11 * np.abs(first).max())
        return M, D, K, F

    def test_a_beam_on_a_hub(self):
        self.make_boom(3)
        self.write_hub("hub.toml", inertia=0.4)
        M, D, K, F = self.check_form(self.linearize("hub.toml", "--inputs", "torque"))
        self.assertAlmostEqual(M[0, 0], 0.4 + 1 / 3, places=6)  # of the beam about its root
        np.testing.assert_allclose(K, K.T, atol=1e-8 * np.abs(K).max())
        np.testing.assert_allclose(F, np.eye(len(M))[:, :1], atol=1e-12)
        with h5py.File(self.path("boom.h5")) as f:
            np.testing.assert_allclose(M[1:, 1:], f["/modal/mass"], atol=1e-12)
            np.testing.assert_allclose(K[1:, 1:], f["/modal/stiffness"], atol=1e-8 * np.abs(K).max())

    def test_gyroscopic_terms_of_a_spin(self):
        self.make_boom(4)
        self.write_hub("spin.toml", motion='motion = "angle"', rate=6)
        M, D, K, F = self.check_form(self.linearize("spin.toml"))
        np.testing.assert_allclose(D, -D.T, atol=1e-7 * np.abs(K).max())
        np.testing.assert_allclose(K, K.T, atol=1e-7 * np.abs(K).max())

    def test_a_free_body_turns(self):
        """Axes that turn along: torque-free I w' = Iw x w."""
        self.write("top.toml", toml(
            table("body", "top", mass=2.0, cg=[0.0, 0.0, 0.0], inertia=[1.0, 2.0, 2.5]),
            table("hinge", "float", "free", child="top", rate=[0.0, 0.0, 3.0, 0.0, 0.0, 0.0]),
            section("simulation", duration=1.0)))
        M, D, K, _ = self.check_form(self.linearize("top.toml"))
        np.testing.assert_allclose(np.diag(M), [1, 2, 2.5, 2, 2, 2], rtol=1e-12)
        np.testing.assert_allclose(D[:2, :2], [[0, -(1 + 2 - 2.5) * 3], [(1 + 2 - 2.5) * 3, 0]], atol=1e-8)
        np.testing.assert_allclose(np.diag(K)[:2], [9 * (2.5 - 2), 9 * (2.5 - 1)], rtol=1e-8)

    def test_a_loop_moves_along(self):
        self.copy_example("ex07-four-bar")
        self.bough("reduce", "coupler.toml")
        with open(self.path("four-bar.toml")) as f:
            self.write("short.toml", f.read().replace("duration = 2.0", "duration = 0.002"))
        model = self.linearize("short.toml")
        M = self.check_form(model)[0]
        self.bough("run", "short.toml", "-o", "run.h5")
        with h5py.File(self.path("run.h5")) as f:
            energy = f["/energy/kinetic"][0]
        u = model["operating_point/u"]
        self.assertAlmostEqual(0.5 * u @ M @ u / energy, 1, places=10)

    def test_what_has_come_to_rest_is_at_rest(self):
        """Speeds of rounding are no motion: nothing changes along them."""
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.3").replace("damping = 0.05", "damping = 2.0"))
        result = self.bough("linearize", "pendulum.toml", "--at", "60")
        self.assertNotIn("linear.time-varying", result.stderr)
        self.assertNotIn("turns", result.stdout)
        self.assertIn("linear.time-varying", self.bough("linearize", "pendulum.toml", "--at", "0.3").stderr)

    def test_motion_that_dies_out_is_at_rest(self):
        """A damped pendulum of a period of 2 s, 3e-4 rad from its rest after 8 s: poles there are those of the motion. Before:
        'changes by 30 % while pin:1 moves by 0.7'."""
        self.write("damped.toml", '[[body]]\nname = "b"\nmass = 1.0\ncg = [0.0, -1.0, 0.0]\ninertia = [1e-3, 1e-3, 1e-3]\n[[hinge]]\n'
                   'name = "pin"\ntype = "revolute"\nchild = "b"\naxis = [0.0, 0.0, 1.0]\nposition = [1.0]\ndamping = [2.0]\n'
                   "[simulation]\nduration = 10.0\noutput_step = 0.01\ngravity = [0.0, -9.81, 0.0]\n")
        self.assertIn("linear.time-varying", self.bough("linearize", "damped.toml", "--at", "0.2").stderr)
        self.assertNotIn("linear.time-varying", self.bough("linearize", "damped.toml", "--at", "8").stderr)

    def test_states_of_controllers_drive_the_second_order(self):
        self.write("sampled.toml", PENDULUM.replace("POSITION", "0.0") +
                   toml(
                       table("controller", "lag", "transfer_function", inputs=["angle"], numerator=[1.0],
                             denominator=[1.0, 0.1]),
                       table("actuator", "motor", "hinge", hinge="pin", input="lag")))
        model = self.linearize("sampled.toml")
        M, Z, A = model["second_order/M"], model["second_order/Z"], model["A"]
        np.testing.assert_allclose(Z, M @ A[1:2, 2:], atol=1e-12 * np.abs(A).max())
        self.assertNotEqual(Z[0, 0], 0)
        self.assertNotIn("second_order/Z", self.linearize("sampled.toml", "--open"))
        self.bough("export", "model.h5", "--to", "mat", "-o", "again.mat")
        np.testing.assert_array_equal(scipy.io.loadmat(self.path("again.mat"))["A"], model["A"][:2, :2])
        self.bough("export", "model.h5", "--to", "op4", "-o", "again.op4")
        self.assertIn("MASS", open(self.path("again.op4")).read())
        self.assertIn("linear model: 2 states", self.bough("check", "model.h5").stdout)


class Equilibrium(LinearTest):
    def test_rest_and_a_run_from_there(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.9").replace("value = 0.0", "value = 5.0")
                   .replace("force = [1.0", 'frame = "inertial"\nforce = [1.0'))
        self.bough("equilibrium", "pendulum.toml", "-o", "rest.h5")
        self.assertEqual(self.bough("export", "rest.h5", "--to", "csv", "-o", "rest.csv").stderr, "")  # it is complete
        angle = math.atan2(5, 2 * 9.81)
        data = json.loads(self.bough("equilibrium", "pendulum.toml", "--json").stdout)
        self.assertAlmostEqual(data["q"][0], angle, places=10)
        self.assertLess(data["residual"], 1e-9)
        self.bough("run", "pendulum.toml", "--start-from", "rest.h5", "-o", "still.h5")
        with h5py.File(self.path("still.h5")) as f:
            self.assertLess(np.abs(np.ravel(f["/hinges/pin/q"][:]) - angle).max(), 1e-8)
        model = self.linearize("pendulum.toml", "--start-from", "rest.h5")
        self.assertAlmostEqual(model["A"][1, 0], -math.hypot(9.81, 2.5) / 0.7, places=8)
        same = self.linearize("pendulum.toml", "--equilibrium")
        np.testing.assert_allclose(same["A"], model["A"], atol=1e-8)
        self.write("other.toml", PENDULUM.replace('"pin"', '"pen"').replace("POSITION", "0.0"))
        self.fails(1, "run", "other.toml", "--start-from", "rest.h5", says=["/hinges/pen/q"], error="cli.start-mismatch")

    def test_what_the_start_was_is_said(self):
        text = PENDULUM.replace("POSITION", "0.9")
        self.write("all.toml", text)
        self.write("some.toml", text.replace("[simulation]", "[simulation]\noutput_until = 0.3"))
        for name in ("all", "some"):
            self.bough("run", f"{name}.toml")
        run = self.bough("run", "all.toml", "--start-from", "some.h5", "-o", "late.h5")
        self.assertIn("some.h5: warning: its last sample is of t = 0.3, its run came to t =", run.stderr)
        self.assertIn("[cli.start-earlier]", run.stderr)
        run = self.bough("run", "all.toml", "--start-from", "all.h5", "-o", "late.h5")
        self.assertIn("[cli.start-state]", run.stderr)
        self.assertNotIn("warning", run.stderr)
        with h5py.File(self.path("late.h5")) as f:
            self.assertIn("all.h5", str(f.attrs["source"]))
        self.fails(1, "run", "all.toml", "--start-from", "late.h5", "-o", "late.h5", error="cli.output-is-input")
        self.fails(1, "linearize", "all.toml", "--start-from", "late.h5", "-o", "late.h5", error="cli.output-is-input")
        self.fails(1, "linearize", "all.toml", "--mat", "a.h5", "-o", "a.h5", error="cli.same-output")

    def test_a_state_of_rest_goes_on(self):
        """--resume on the file of equilibrium: the energy counts from the state found."""
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.9").replace("value = 0.0", "value = 5.0")
                   .replace("force = [1.0", 'frame = "inertial"\nforce = [1.0'))
        self.bough("equilibrium", "pendulum.toml", "-o", "rest.h5")
        self.bough("run", "pendulum.toml", "--resume", "-o", "rest.h5")
        with h5py.File(self.path("rest.h5")) as f:
            self.assertGreater(len(f["/time"]), 2)
            self.assertLess(np.ptp(f["/hinges/pin/q"][:]), 1e-8)

    def test_unstable_states_are_named(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "3.1"))
        run = self.bough("equilibrium", "pendulum.toml")
        self.assertIn("unstable equilibrium", run.stdout)
        for words in ("pin:1 leaves it", "[equilibrium.unstable]"):
            self.assertIn(words, run.stderr)
        data = json.loads(self.bough("equilibrium", "pendulum.toml", "--json").stdout)
        self.assertFalse(data["stable"])
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "2.0"))
        data = json.loads(self.bough("equilibrium", "pendulum.toml", "--json").stdout)
        self.assertTrue(data["stable"])
        self.assertAlmostEqual(data["q"][0], 0, places=9)

    def test_nothing_holds_a_stone(self):
        self.write("stone.toml", toml(
            table("body", "stone", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            section("simulation", duration=1.0, gravity=[0.0, 0.0, -9.81])))
        self.fails(3, "equilibrium", "stone.toml", says=["stone:z", "9.81"], error="equilibrium.not-converged")

    def test_body_far_beyond_its_range(self):
        """The energy of a bent frame of third order falls without end under a large load: the search ends when a mode
        deflects by twice the size of the bodies."""
        corners = np.array([(0., 0., 0.), (1.1, 0., 0.), (1.5, .7, .2), (1.2, .9, .8)])
        deck = ("SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nPARAM,COUPMASS,1\nMAT1,1,7.+10,2.7+10,,2700.\n"
                "PBAR,1,1,4.-5,3.-10,9.-10,5.-10\nSPC1,1,123456,1\nGRID,1,,0.,0.,0.\n")
        for s, v in enumerate(("0.,1.,0.", "0.,0.,1.", "1.,0.,0.")):
            for k in range(1, 5):
                x, g = corners[s] + (corners[s + 1] - corners[s]) * k / 4, 4 * s + k
                deck += f"GRID,{g + 1},,{x[0]:.5f},{x[1]:.5f},{x[2]:.5f}\nCBAR,{g},1,{g},{g + 1},{v}\n"
        self.write("frame.bdf", deck + "ENDDATA\n")
        self.write("frame.toml", '[body]\nname = "b"\ndeck = "frame.bdf"\nframe = "node"\nframe_nodes = [1]\n'
                   'interface = [1, 9, 13]\n[body.modes]\nnumber = 6\nresidual = ["interface"]\n[body.stiffening]\norder = 3\nlarge = 6\n')
        self.bough("reduce", "frame.toml", "-o", "frame.h5", "-q")
        self.write("s.toml", toml(
            table("body", "b", file="frame.h5"), table("hinge", "h", "fixed", child="b", child_node=1),
            table("force", "f", body="b", node=9, force=[-1.5, 2.4, .6], frame="inertial"),
            table("force", "g", body="b", node=13, force=[.9, -1.2, 3.6], frame="inertial"),
            section("simulation", duration=1.0, gravity=[0.0, 0.0, 0.0])))
        output = self.fails(3, "equilibrium", "s.toml", says=["on the way downhill b:eta", "bough split"],
                          error="equilibrium.not-converged").stderr
        self.assertNotIn("iterations", output)

    def test_a_body_spins_about_a_mass_centre_beside_its_origin(self):
        """Its nutation is that of a free rigid body, ω √((C - A)(C - B) / (A B))."""
        self.write("sat.toml", toml(
            table("body", "sat", mass=100.0, cg=[0.1, 0.0, 0.5], inertia=[30.0, 40.0, 50.0]),
            table("hinge", "f", "free", child="sat", rate=[0.0, 0.0, 1.0, 0.0, -0.1, 0.0]),
            section("simulation", duration=10.0)))
        said = self.bough("equilibrium", "sat.toml", "-o", "spin.h5")
        self.assertNotIn("unstable", said.stdout + said.stderr)
        linear = self.bough("linearize", "sat.toml", "--equilibrium", "-o", "l.h5", "-v")
        self.assertNotIn("[linear.not-steady]", linear.stderr)
        with h5py.File(self.path("l.h5")) as f:
            poles = f["poles/real"][:].ravel() + 1j * f["poles/imag"][:].ravel()
        self.assertLess(np.abs(poles - 1j * np.sqrt(20 * 10 / (30 * 40))).min(), 1e-6)
        self.assertLess(poles.real.max(), 1e-6)


class Select(LinearTest):
    def make_plant(self, body, nodes, kept=slice(None)):
        """Forces and displacements at the nodes, by some of the modes."""
        with h5py.File(self.path(body)) as f:
            M, D, K = (f["/modal/" + name][:] for name in ["mass", "damping", "stiffness"])
            phi, ids = f["/modes/phi"][:], list(f["/nodes/id"][:])
        rows = np.vstack([phi[ids.index(node), :3] for node in nodes])[:, kept]
        M, D, K = M[kept][:, kept], D[kept][:, kept], K[kept][:, kept]
        n = len(M)
        D = np.where((np.diag(D) == 0) & np.eye(n, dtype=bool), 2 * 0.01 * np.sqrt(np.diag(K * M)), D)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        B = np.vstack([np.zeros((n, len(rows))), np.linalg.solve(M, rows.T)])
        return A, B, np.hstack([rows, np.zeros((len(rows), n))])

    def calc_cost(self, body, nodes):
        """V_i by scipy's dense Lyapunov solver."""
        A, B, C = self.make_plant(body, nodes)
        X = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        parts = np.diag(X @ C.T @ C)
        return parts[:len(A) // 2] + parts[len(A) // 2:]

    def calc_lost(self, body, nodes, kept):
        """Mean square of the difference of full and reduced, to that of the full."""
        A, B, C = self.make_plant(body, nodes)
        a, b, c = self.make_plant(body, nodes, kept)
        both = scipy.linalg.block_diag(A, a), np.vstack([B, b]), np.hstack([C, -c])
        X, Y = (scipy.linalg.solve_continuous_lyapunov(F, -G @ G.T) for F, G in ((A, B), both[:2]))
        return np.trace(both[2] @ Y @ both[2].T) / np.trace(C @ X @ C.T)

    def test_costs_and_the_smaller_body(self):
        self.make_boom(12)
        data = json.loads(self.bough("select", "boom.h5", "--json", "--number", 5, "-o", "small.h5").stdout)
        expected = self.calc_cost("boom.h5", [41])
        cost = np.array([mode["cost"] for mode in data["modes"]])
        np.testing.assert_allclose(cost, expected, atol=1e-10 * expected.sum())
        self.assertAlmostEqual(cost.sum() / data["total_cost"], 1, places=12)
        for mode in data["modes"]:
            self.assertEqual(sorted(mode), ["closed_form", "cost", "effective_mass", "frequency_hz", "hankel", "kept",
                                            "mode", "reason", "share"])
        kept = [i for i, mode in enumerate(data["modes"]) if mode["kept"]]
        self.assertEqual(len(kept), 5)
        self.assertEqual(sorted(np.argsort(cost)[-5:]), kept)
        with h5py.File(self.path("boom.h5")) as big, h5py.File(self.path("small.h5")) as small:
            np.testing.assert_array_equal(small["/modes/frequency_hz"][:], big["/modes/frequency_hz"][:][kept])
            np.testing.assert_array_equal(small["/modes/phi"][:], big["/modes/phi"][:][:, :, kept])
            np.testing.assert_array_equal(small["/modal/stiffness"][:], big["/modal/stiffness"][:][np.ix_(kept, kept)])
            np.testing.assert_array_equal(small["/stiffening/kg_inertial"][:],
                                          big["/stiffening/kg_inertial"][:][:, kept][:, :, kept])
            method = big["/integrals"].attrs["method"]
            method = method.decode() if isinstance(method, bytes) else method
            for name, cut in [("gamma0", (kept,)), ("gamma2", np.ix_(kept, kept)), ("gamma3", (kept,)),
                              ("gamma4", np.ix_(kept, kept))]:
                path = f"/integrals/{method}/{name}"
                np.testing.assert_array_equal(small[path][:], big[path][:][cut])
        self.bough("check", "small.h5")

    def test_rules(self):
        self.make_boom(12)
        def kept(*arguments):
            data = json.loads(self.bough("select", "boom.h5", "--json", *arguments).stdout)
            return [mode["frequency_hz"] for mode in data["modes"] if mode["kept"]], data
        low, data = kept("--below", 10)
        self.assertLess(max(low), 10)
        self.assertEqual(len(low), sum(mode["frequency_hz"] < 10 for mode in data["modes"]))
        all_, data = kept("--tolerance", 0)
        gone, data = kept("--tolerance", 0.05)
        self.assertLess(len(gone), len(all_))
        self.assertLessEqual(data["dropped_share"], 0.05)
        self.assertLessEqual(data["lost_share"], 0.05)
        number = [i for i, mode in enumerate(data["modes"]) if mode["kept"]]
        self.assertAlmostEqual(data["lost_share"] / self.calc_lost("boom.h5", [41], number), 1, places=8)
        self.fails(1, "select", "boom.h5", "--inputs", "99:y", error="select.unknown-node")
        self.fails(1, "select", "boom.h5", "--inputs", "41:w", error="select.unknown-direction")
        self.fails(1, "select", "boom.h5", "--inputs", "1", "--outputs", "1", "--below", 1e-3, "-o", "x.h5",
                   error="select.nothing-kept")

    def test_in_a_system(self):
        self.make_boom(12)
        self.write_hub("hub.toml")
        self.fails(3, "select", "boom.h5", "hub.toml", says=["hub.toml: error: the pole", "of boom:eta"],
                   error="select.unstable")
        self.write_hub("hub.toml", eta="damping = 0.01")
        data = json.loads(self.bough("select", "boom.h5", "hub.toml", "--json").stdout)
        cost = sum(mode["cost"] for mode in data["modes"])
        self.assertAlmostEqual((cost + data["other_cost"]) / data["total_cost"], 1, places=9)
        self.assertLessEqual(data["lost_share"], 0.01)
        self.assertGreater(data["lost_share"], 0)
        # The torque about z moves the chord only: flap costs nothing and goes.
        with h5py.File(self.path("boom.h5")) as f:
            phi, ids = f["/modes/phi"][:], list(f["/nodes/id"][:])
        tip = np.abs(phi[ids.index(41)])
        for mode, y, z in zip(data["modes"], tip[1], tip[2]):
            if z > 1e3 * y:
                self.assertFalse(mode["kept"], mode)
        with open(self.path("hub.toml"), "a") as f:
            f.write(table("sensor", "felt", "acceleration", body="boom", node=41))
        self.assertIn("select.feedthrough", self.bough("select", "boom.h5", "hub.toml").stderr)
        # A sampled rate loop: held between samples it would be ranked open.
        with open(self.path("hub.toml"), "a") as f:
            f.write(toml(
                table("sensor", "gyro", "hinge_rate", hinge="spin"),
                table("controller", "law", "gain", inputs=["gyro"], gain=-0.1, sample_time=0.01),
                table("actuator", "motor", "hinge", hinge="spin", input="law")))
        self.fails(1, "select", "boom.h5", "hub.toml", says=["(law)"], error="select.sampled")
        self.bough("select", "boom.h5", "hub.toml", "--open")
        self.write("alone.toml", toml(
            table("body", "boom", file="other.h5"),
            table("hinge", "clamp", "fixed", child="boom"),
            section("simulation", duration=1.0)))
        os.rename(self.path("boom.h5"), self.path("other.h5"))
        self.fails(1, "select", "other.h5", "alone.toml", error="select.no-signals")
        self.bough("select", "other.h5", "--number", 3, "-o", "boom.h5")
        self.fails(1, "select", "boom.h5", "alone.toml", error="select.body-not-in-system")


if __name__ == "__main__":
    unittest.main()
