"""Where linearize, equilibrium and run start: steady lags, samples, switches, released motions, against closed forms."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml


def make_body(**keys):
    """A body of unit inertia on a revolute hinge, which starts at 0.7 rad with 0.6 rad/s."""
    return (table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]) +
            table("hinge", "h", "revolute", child="b", **{"position": 0.7, "rate": 0.6, **keys}))


ANGLE = table("sensor", "a", "hinge_angle", hinge="h")
RELAY = table("controller", "rl", "relay", inputs="a", on=0.5, off=0.2, value=1.0, low=0.0)
END = section("simulation", duration=1.0)

LAG = toml(
    make_body(damping=1.0, stiffness=3.0),
    table("sensor", "a", "hinge_angle", hinge="h", lag=0.1, initial="steady"),
    table("controller", "s", "table", inputs="a", x=[-1.0, 0.5, 1.0], y=[1.0, -0.5, -3.0]),
    table("actuator", "m", "hinge", hinge="h", input="s"), END)

SWITCHED = toml(
    make_body(), ANGLE, RELAY,
    table("controller", "gain", "expression", inputs=["rl", "a"], expression="-u1*3*u2"),
    table("actuator", "m", "hinge", hinge="h", input="gain"), END)

SAMPLED = toml(
    make_body(),
    table("sensor", "rs", "hinge_rate", hinge="h", sample_time=0.1), ANGLE,
    table("controller", "pr", "expression", inputs=["rs", "a"], expression="-u1*u2"),
    table("actuator", "m", "hinge", hinge="h", input="pr"),
    table("actuator", "n", "hinge", hinge="h", input="a", scale=-1.0, lag=0.1, initial="steady", rate_limit=3.0), END)

SATURATED = toml(
    make_body(),
    table("sensor", "r", "hinge_rate", hinge="h", lag=0.02, initial="steady"),
    table("controller", "lim", "limit", inputs="r", upper=0.5, lower=-0.5),
    table("actuator", "m", "hinge", hinge="h", input="lim", scale=-1.0), END)


def make_relay(value, duration=20.0):
    """A spring of 4 N m/rad at rest at 1 rad, and a relay that adds a moment above 0.5 rad, none below 0.2 rad."""
    relay = table("controller", "rl", "relay", inputs="a", on=0.5, off=0.2, value=value, low=0.0)
    return toml(make_body(rate=0.0, stiffness=4.0, damping=2.0, preload=4.0), ANGLE, relay,
                table("actuator", "m", "hinge", hinge="h", input="rl"), section("simulation", duration=duration))


PI = toml(
    table("body", "b", mass=1.0, cg=[0.5, 0.0, 0.0], inertia=[0.1, 0.1, 0.1]),
    table("hinge", "h", "revolute", child="b", axis=[0.0, 1.0, 0.0], damping=0.5),
    ANGLE,
    table("controller", "pd", "pid", inputs="a", kp=20.0, ki=10.0, kd=1.0, filter=0.02, setpoint=0.2),
    table("actuator", "m", "hinge", hinge="h", input="pd", lag=0.05),
    section("simulation", duration=1.0, gravity=[0.0, 0.0, -9.81]))

INPUT = toml(
    section("parameters", t0=0.0), table("input", "torque", start="$t0"),
    make_body(position=0.0, rate=0.0, stiffness=4.0),
    table("actuator", "m", "hinge", hinge="h", input="torque"), END)

RAMP = table("function", "f", "expression", expression="0.6*t", rate="0.6", acceleration="0")


class Starts(ProgramTest):
    def linearize(self, text, *arguments):
        self.write("case.toml", text)
        self.bough("linearize", "case.toml", *arguments, "-o", "case.h5")
        return self.read_arrays("case.h5", "A")[0]

    def test_a_steady_lag_starts_at_the_slope_of_its_operating_point(self):
        slope = -(3.0 - 0.5) / (1.0 - 0.5)  # of the table at 0.7 rad
        expected = np.array([[0, 1, 0], [-3, -1, slope], [10, 0, -10]])
        for more in ((), ("--at", 0), ("--at", 1e-9)):
            np.testing.assert_allclose(self.linearize(LAG, *more), expected, atol=1e-6)
        self.bough("linearize", "case.toml", "--each", 500, "-o", "many.h5")
        with h5py.File(self.path("many.h5")) as f:
            poles = f["poles/real"][0] + 1j * f["poles/imag"][0]
        np.testing.assert_allclose(np.sort_complex(poles), np.sort_complex(np.linalg.eigvals(expected)), atol=1e-6)
        self.bough("run", "case.toml", "-o", "run.h5")
        with h5py.File(self.path("run.h5")) as f:
            end = f["hinges/h/q"][()].ravel()[-1]
        slope = -1 if end < 0.5 else slope
        expected[1, 2] = slope
        np.testing.assert_allclose(self.linearize(LAG, "--start-from", "run.h5"), expected, atol=1e-6)

    def test_a_relay_is_switched_at_the_start(self):
        np.testing.assert_allclose(self.linearize(SWITCHED), [[0, 1], [-3, 0]], atol=1e-9)

    def test_samples_of_the_start_are_taken(self):
        A = self.linearize(SAMPLED)
        np.testing.assert_allclose(A, [[0, 1, 0], [-0.6, 0, 1], [-10, 0, -10]] if A[1, 2] > 0 else
                                   [[0, 1, 0], [-0.6, 0, -1], [10, 0, -10]], atol=1e-6)
        np.testing.assert_allclose(A, self.linearize(SAMPLED, "--at", 1e-6), atol=1e-6)

    def test_a_limit_is_saturated_at_the_start(self):
        A = self.linearize(SATURATED)
        np.testing.assert_allclose(A, [[0, 1, 0], [0, 0, 0], [0, 50, -50]], atol=1e-9)

    def test_a_sweep_starts_as_a_run(self):
        text = section("parameters", p=0.7) + SWITCHED.replace("position = 0.7", 'position = "$p"')
        self.write("case.toml", text)
        self.bough("linearize", "case.toml", "--sweep", "p=0.4:0.8:3", "-o", "many.h5")
        with h5py.File(self.path("many.h5")) as f:
            np.testing.assert_allclose(f["poles/imag"][()].max(axis=1), [0, 3**0.5, 3**0.5], atol=1e-6)

    def test_equilibrium_settles_relays(self):
        self.write("case.toml", make_relay(1.0))
        self.bough("equilibrium", "case.toml", "-o", "rest.h5")
        self.bough("run", "case.toml", "--start-from", "rest.h5", "-o", "run.h5")
        for name in ("rest.h5", "run.h5"):
            np.testing.assert_allclose(self.read_arrays(name, "hinges/h/q")[0], (4 + 1) / 4, atol=1e-9)

    def test_equilibrium_switches_what_its_state_switches(self):
        # From 0 rad the relay is off, and at the rest without it, 1 rad, it is on.
        self.write("case.toml", make_relay(1.0).replace("position = 0.7", "position = 0.0"))
        self.bough("equilibrium", "case.toml", "-o", "rest.h5")
        np.testing.assert_allclose(self.read_arrays("rest.h5", "hinges/h/q")[0], 1.25, atol=1e-9)

    def test_a_limit_cycle_has_no_equilibrium(self):
        self.write("case.toml", make_relay(-4.0))  # at rest at 0 rad while on, at 1 rad while off
        message = self.bough("equilibrium", "case.toml", "-o", "rest.h5", code=3).stderr
        self.assertIn("equilibrium.switching", message)
        self.assertIn("'rl'", message)

    def test_an_input_starts_as_the_system_file_says(self):
        self.write("case.toml", INPUT)
        self.bough("equilibrium", "case.toml", "-o", "rest.h5")
        messages = self.bough("run", "case.toml", "--start-from", "rest.h5", "--set", "t0=1", "-o", "run.h5")
        self.assertNotIn("resumed", messages.stdout + messages.stderr)
        t, q = self.read_arrays("run.h5", "time", "hinges/h/q")
        np.testing.assert_allclose(q.ravel(), (1 - np.cos(2 * t)) / 4, atol=1e-6)

    def test_states_of_controllers_out_of_an_equilibrium(self):
        self.write("case.toml", PI)
        self.bough("equilibrium", "case.toml", "-o", "rest.h5")
        self.bough("run", "case.toml", "--start-from", "rest.h5", "-o", "run.h5")
        np.testing.assert_allclose(self.read_arrays("run.h5", "sensors/a")[0], 0.2, atol=1e-7)

    def test_no_warning_of_events_after_the_operating_point(self):
        self.write("case.toml", toml(make_body(), table("event", "late", time=0.8, action="lock", hinge="h"), END))
        self.assertNotIn("run.event-never", self.bough("linearize", "case.toml", "--at", 0.5, "-o", "case.h5").stderr)

    def test_names_of_travels_follow_their_axes(self):
        self.write("case.toml", toml(
            table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "h", "general", child="b", rotations="q", translations="zx"), END))
        self.bough("linearize", "case.toml", "-o", "case.h5")
        with h5py.File(self.path("case.h5")) as f:
            names = [name.decode() if isinstance(name, bytes) else name for name in f["states/name"][()]]
        self.assertEqual(names[:5], ["h:rx", "h:ry", "h:rz", "h:z", "h:x"])


CYLINDER = toml(
    table("body", "b", mass=2.0, inertia=[0.1, 0.1, 0.1]),
    table("hinge", "h", "cylindrical", child="b", motion=["f", ""], rate=[1.0, 3.0], damping=[0.0, 1.0]),
    table("function", "f", "expression", expression="t", rate="1", acceleration="0"))
ARM = (table("body", "arm", mass=2.0, cg=[0.5, 0.0, 0.0], inertia=[0.1, 0.2, 0.2]) +
       table("hinge", "h", "revolute", child="arm", axis=[0.0, 1.0, 0.0]))
DOWN = {"gravity": [0.0, 0.0, -9.81]}
RISE = table("function", "f", "expression", expression="0.5*t^2", rate="t", acceleration="1")


class Missions(ProgramTest):
    """A mission in two parts is that of one run: --start-from takes over what events have changed."""
    def fly(self, text, first=1.0, second=1.0, start=None, other=None, name="b", **more):
        """Runs `text` to `first`, then `other` (`text`) from there; and `text` in one run, as a reference."""
        def write(name, text, **times):
            self.write(name, toml(text, section("simulation", integrator="rk", relative_tolerance=1e-11,
                                                absolute_tolerance=1e-12, output_step=0.1, **{**more, **times})))
        write("a.toml", text, duration=first)
        write("b.toml", text if other is None else other, start=first if start is None else start, duration=second)
        write("whole.toml", text, duration=first + second)
        self.bough("run", "a.toml", "-o", "a.h5")
        self.bough("run", "whole.toml", "-o", "whole.h5")
        return self.bough("run", "b.toml", "--start-from", "a.h5", "-o", "b.h5").stderr

    def compare(self, *channels, atol=1e-9):
        for channel in channels:
            part, whole = (self.read_arrays(name, channel)[0] for name in ("b.h5", "whole.h5"))
            np.testing.assert_allclose(part, whole[-len(part):], atol=atol, err_msg=channel)

    def test_free_coordinates_of_a_hinge_prescribed_in_part(self):
        self.fly(CYLINDER)
        self.compare("hinges/h/q", "hinges/h/qdot")
        s = 1 - np.exp(-0.5)  # m q'' = -q'
        np.testing.assert_allclose(self.read_arrays("b.h5", "hinges/h/q")[0][0], [1.0, 6 * s], atol=1e-8)
        self.bough("linearize", "b.toml", "--start-from", "a.h5", "-o", "l.h5")
        np.testing.assert_allclose(self.read_arrays("l.h5", "operating_point/q")[0], [1.0, 6 * s], atol=1e-8)

    def test_a_latch_stays_locked(self):
        latch = table("event", "latch", signal="/hinges/h/q", value=1.0, action="lock", hinge="h")
        messages = self.fly(ARM + latch, 2.0, 2.0, **DOWN)
        self.assertIn("hinge 'h' locked", messages)
        np.testing.assert_allclose(self.read_arrays("b.h5", "hinges/h/q")[0], 1.0, atol=1e-9)
        for arguments in (("whole.toml", "--at", 2.0), ("b.toml", "--start-from", "a.h5")):
            self.bough("linearize", *arguments, "-o", "l.h5")
            self.assertEqual(self.read_arrays("l.h5", "A")[0].shape, (0, 0), arguments)

    def test_a_third_part_starts_from_the_second(self):
        latch = table("event", "latch", signal="/hinges/h/q", value=1.0, action="lock", hinge="h")
        self.fly(ARM + latch, 2.0, 2.0, **DOWN)
        self.write("c.toml", self.read("b.toml").replace("start = 2.0", "start = 4.0"))
        self.bough("run", "c.toml", "--start-from", "b.h5", "-o", "c.h5")
        np.testing.assert_allclose(self.read_arrays("c.h5", "hinges/h/q")[0], 1.0, atol=1e-9)

    def test_docked_bodies_stay_docked(self):
        text = (table("body", "chaser", mass=2.0, inertia=[0.1, 0.2, 0.2]) +
                table("body", "target", mass=5.0, inertia=[0.1, 0.2, 0.2]) +
                table("hinge", "hc", "free", child="chaser", rate=[0.0, 0.0, 0.2, 0.1, 0.0, 0.0]) +
                table("hinge", "ht", "free", child="target", position=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]))
        for constraint in (dict(type="fixed"), dict(type="distance", length=0.5), dict(type="universal", axis=[1.0, 0.0, 0.0],
                           axis2=[0.0, 1.0, 0.0]), dict(type="point_on_line", axis=[0.0, 1.0, 0.0])):
            kind = constraint.pop("type")
            dock = table("constraint", "dock", kind, parent="target", child="chaser", active=False, **constraint)
            messages = self.fly(text + dock + table("event", "d", time=0.5, action="close", constraint="dock"))
            self.assertIn("constraint 'dock' closed", messages)
            self.compare("hinges/hc/q", "hinges/ht/q", "constraints/dock/reaction_force", atol=1e-8)

    def test_what_was_released_and_broken_stays_so(self):
        text = (table("body", "stage", mass=20.0, inertia=[1.0, 1.0, 1.0]) +
                table("body", "pay", mass=2.0, inertia=[0.1, 0.1, 0.1]) +
                table("body", "other", mass=1.0, inertia=[0.1, 0.1, 0.1]) +
                table("hinge", "hs", "free", child="stage", rate=[0.0, 0.0, 0.3, 1.0, 0.0, 0.0]) +
                table("hinge", "sep", "free", parent="stage", child="pay", parent_position=[1.0, 0.0, 0.0], locked=True) +
                table("hinge", "ho", "free", child="other", position=[1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0],
                      rate=[0.0, 0.0, 0.3, 0.4, 0.0, 0.0]))
        clamp = table("constraint", "clamp", "fixed", parent="stage", child="other", parent_position=[0.0, 2.0, 0.0])
        push = table("force", "push", "spring", body="stage", to_body="pay", position=[0.9, 0.0, 0.0],
                     to_position=[0.1, 0.0, 0.0], stiffness=100.0, free_length=0.4)
        events = (table("event", "e1", time=0.5, action="release", hinge="sep") +
                  table("event", "e2", time=0.7, action="break", constraint="clamp"))
        messages = self.fly(text + clamp + push + events)
        for words in ("hinge 'sep' released", "constraint 'clamp' open"):
            self.assertIn(words, messages)
        self.compare("hinges/hs/q", "hinges/sep/q", "hinges/ho/q", "hinges/ho/qdot")
        # Without the constraint there is no place for the mode.
        messages = self.fly(text + clamp + push + events, other=text + push)
        self.assertIn("cli.start-modes", messages)
        self.assertIn("constraint 'clamp' open, but this system has no such constraint", messages)
        self.compare("hinges/ho/q", "hinges/sep/q")

    def test_a_motion_that_was_released_does_not_take_over_again(self):
        driven = ARM.replace('child = "arm"', 'child = "arm"\nmotion = "f"') + RISE
        event = table("event", "r", time=0.5, action="release", hinge="h")
        self.fly(driven + event, **DOWN)
        self.compare("hinges/h/q", "hinges/h/qdot")

    def test_a_prescribed_motion_from_another_time_is_warned_of(self):
        driven = ARM.replace('child = "arm"', 'child = "arm"\nmotion = "f"') + RISE
        messages = self.fly(driven, start=0.0, **DOWN)
        self.assertIn("cli.start-motion", messages)
        self.assertIn("set start = 1", messages)
        self.assertNotIn("cli.start-motion", self.fly(driven, **DOWN))

    def test_contacts_stick_and_slip_as_in_one_run(self):
        """A block that friction stops in the first part, and that a growing force moves in the second."""
        block = (table("body", "b", mass=1.0) +
                 table("hinge", "h", "prismatic", child="b", axis=[1.0, 0.0, 0.0], rate=1.0,
                       friction={"coulomb": 2.0, "static": 3.0}, stops={"lower": -1.0, "upper": 0.2, "restitution": 0.0}) +
                 table("function", "g", "expression", expression="-4*(t-0.5)") +
                 table("force", "F", body="b", force=[1.0, 0.0, 0.0], function="g"))
        messages = self.fly(block)
        self.assertNotIn("locked", messages)
        self.compare("hinges/h/q", "hinges/h/qdot", atol=1e-8)
        self.assertLess(self.read_arrays("b.h5", "hinges/h/q")[0].ravel()[-1], 0.15)

    def test_a_contact_that_sticks_is_not_taken_for_a_lock(self):
        block = (table("body", "b", mass=1.0) +
                 table("hinge", "h", "prismatic", child="b", axis=[1.0, 0.0, 0.0], locked=True,
                       friction={"coulomb": 2.0, "static": 3.0}) +
                 table("function", "g", "expression", expression="2*t") +
                 table("force", "F", body="b", force=[1.0, 0.0, 0.0], function="g") +
                 table("event", "r", time=0.5, action="release", hinge="h"))
        messages = self.fly(block, 1.0, 2.0)
        self.assertIn("hinge 'h' released", messages)
        self.compare("hinges/h/q", atol=1e-8)
        self.assertGreater(self.read_arrays("b.h5", "hinges/h/q")[0].ravel()[-1], 0.05)

    def test_an_event_at_the_end_of_the_first_part(self):
        two = ARM + (table("body", "tip", mass=1.0, cg=[0.3, 0.0, 0.0], inertia=[0.1, 0.1, 0.1]) +
                     table("hinge", "k", "revolute", parent="arm", child="tip", axis=[0.0, 1.0, 0.0],
                           parent_position=[1.0, 0.0, 0.0]))
        for action in ("lock", "release"):
            text = two.replace('name = "k"', 'name = "k"\nlocked = true') if action == "release" else two
            self.fly(text + table("event", "e", time=1.0, action=action, hinge="k"), **DOWN)
            for channel in ("hinges/h/q", "hinges/k/q"):
                part, whole = (self.read_arrays(name, channel)[0] for name in ("b.h5", "whole.h5"))
                np.testing.assert_allclose(part[1:], whole[-len(part) + 1:], atol=1e-9, err_msg=action)

    def test_modes_that_came_after_the_last_sample(self):
        messages = self.fly(ARM + table("event", "stop", time=0.5, action="lock", hinge="h"), start=0.4, output_until=0.4,
                            **DOWN)
        self.assertIn("cli.start-earlier", messages)
        self.assertIn("not known at its last sample, t = 0.4: event stop came at t = 0.5", messages)


class Closing(ProgramTest):
    def test_a_joint_of_two_angles_closes_at_the_nearest_ones(self):
        """The offset from the joint at that moment stays; the axes are those of the joint, as the page has it."""
        from scipy.optimize import least_squares
        from scipy.spatial.transform import Rotation
        turn = lambda q: Rotation.from_euler("XY", q)
        for joint in ({"type": "universal", "axis": [1.0, 0.0, 0.0], "axis2": [0.0, 1.0, 0.0]},
                      {"type": "general", "rotations": "xy"}):
            kind = joint.pop("type")
            self.write("u.toml", toml(
                table("body", "a", mass=2.0, inertia=[0.2, 0.3, 0.4]), table("body", "b", mass=1.0, inertia=[0.2, 0.3, 0.25]),
                table("hinge", "ha", "free", child="a"),
                table("hinge", "hb", "free", child="b", position=[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                      rate=[0.6, 0.3, 0.8, 0.0, 0.0, 0.0]),
                table("constraint", "k", kind, parent="a", child="b", active=False, **joint),
                table("event", "e", time=1.0, action="close", constraint="k"),
                section("simulation", duration=2.0, output_step=0.01, integrator="rk", relative_tolerance=1e-11,
                        absolute_tolerance=1e-12)))
            self.bough("run", "u.toml", "-o", "u.h5")
            a, b = (Rotation.from_quat(q[:, [1, 2, 3, 0]])
                    for q in self.read_arrays("u.h5", "bodies/a/quaternion", "bodies/b/quaternion"))
            relative = a.inv() * b
            nearest = least_squares(lambda q: (turn(q).inv() * relative[100]).as_rotvec(), [0.5, 0.3], xtol=1e-15, ftol=1e-15).x
            offset = turn(nearest).inv() * relative[100]
            self.assertGreater(offset.magnitude(), 0.1)
            axes = (relative[101:] * offset.inv()).as_matrix()
            np.testing.assert_allclose(axes[:, 0, 1], 0, atol=1e-7, err_msg=kind)


class PrescribedMotions(ProgramTest):
    """Forces along a coordinate before and after a motion that prescribes it ends."""
    def run_case(self, text):
        self.write("case.toml", text)
        messages = self.bough("run", "case.toml", "-o", "case.h5").stderr
        with h5py.File(self.path("case.h5")) as f:
            error = float(f["energy"].attrs["energy_error"])
            return {name: f[name][()] for name in ("time", "hinges/h/q", "hinges/h/qdot", "energy/strain")}, error, messages

    def test_spring_and_damper_act_after_the_release(self):
        for integrator in ("adams", "implicit", "bdf"):
            case, error, messages = self.run_case(toml(
                table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]),
                table("hinge", "h", "cylindrical", child="b", stiffness=[3.0, 30.0], damping=[0.1, 0.2], motion=["", "f"]),
                RAMP, table("event", "r", time=0.2, action="release", hinge="h", coordinates=[2]),
                section("simulation", duration=1.0, integrator=integrator,
                        **({"step": 1e-4} if integrator == "implicit" else {}))))
            s = case["time"] - 0.2
            w = np.sqrt(30 - 0.1**2)
            q = np.exp(-0.1 * s) * (0.12 * np.cos(w * s) + (0.6 + 0.1 * 0.12) / w * np.sin(w * s))
            np.testing.assert_allclose(case["hinges/h/q"][:, 1], np.where(s < 0, 0.6 * case["time"], q), atol=2e-5)
            self.assertLess(error, 1e-5, integrator)

    def test_the_energy_balance_holds_across_lock_and_release(self):
        curve = table("function", "tab", "table", x=[-3.0, 0.0, 3.0], y=[-60.0, 0.0, 90.0])
        for law in ({"preload": 5.0}, {"spring_table": ["tab"]}, {"stiffness": 30.0, "null_position": 0.5}):
            for action in ("lock", "release"):
                case, error, messages = self.run_case(toml(
                    table("body", "b", mass=1.0),
                    table("hinge", "h", "prismatic", child="b", axis=[1.0, 0.0, 0.0], motion=["f"], **law),
                    RAMP, curve, table("event", "r", time=0.2, action=action, hinge="h"),
                    section("simulation", duration=0.6, output_step=0.02)))
                self.assertLess(error, 1e-6, (law, action))
                q, rate = case["hinges/h/q"].ravel()[-1], case["hinges/h/qdot"].ravel()[-1]
                self.assertIn("up to a release", messages)
                if action == "lock":
                    np.testing.assert_allclose([q, rate], [0.12, 0], atol=1e-9)
                elif "preload" in law:
                    np.testing.assert_allclose(rate, 0.6 + 5 * 0.4, atol=1e-6)
                    np.testing.assert_allclose(case["energy/strain"].ravel(), -5 * case["hinges/h/q"].ravel(), atol=1e-9)

    def test_a_motor_inertia_acts_and_is_not_warned_of(self):
        _, _, messages = self.run_case(toml(
            table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]),
            table("hinge", "h", "revolute", child="b", motion=["f"], rotor_inertia=0.5), RAMP, END))
        self.assertNotIn("system.ignored-spring", messages)


class FixedSteps(ProgramTest):
    def test_a_longer_run_begins_as_the_shorter_one(self):
        for integrator in ("rk4", "implicit"):
            found = []
            for duration in (0.7, 1.0):
                self.write("case.toml", toml(
                    table("body", "b", mass=1.0, cg=[0.5, 0.0, 0.0], inertia=[0.1, 0.1, 0.1]),
                    table("hinge", "h", "revolute", child="b", axis=[0.0, 1.0, 0.0], position=0.5),
                    table("function", "f", "expression", expression="sin(5*t)"),
                    table("force", "F", body="b", moment=[0.0, 1.0, 0.0], function="f"),
                    section("simulation", duration=duration, output_step=0.1, integrator=integrator, step=0.02,
                            gravity=[0.0, 0.0, -9.81], energy_error_limit=1.0)))
                self.bough("run", "case.toml", "-o", "case.h5")
                found.append(self.read_arrays("case.h5", "hinges/h/q")[0][:7])
            np.testing.assert_array_equal(*found)


class OrbitalFrame(ProgramTest):
    def test_rates_follow_the_orbit_plane_that_j2_turns(self):
        h = 1.0
        self.write("case.toml", toml(
            table("body", "s", mass=10.0, inertia=[3.0, 4.0, 5.0]),
            table("hinge", "f", "free", child="s", position=[1.0, 0.0, 0.0, 0.0, 6.0e6, 2.5e6, 2.0e6],
                  rate=[0.0, 0.0, 0.0, -2500.0, 4300.0, 5335.0]),
            table("force", "earth", "gravity_central", mu=3.986004418e14, j2=1.08263e-3, radius=6378137.0),
            table("sensor", "w", "angular_velocity", body="s", relative_to="lvlh:s"),
            table("sensor", "q", "dcm", body="s", relative_to="lvlh:s"),
            section("simulation", duration=300.0, output_step=h, integrator="rk", relative_tolerance=1e-12)))
        self.bough("run", "case.toml", "-o", "case.h5")
        w, R = self.read_arrays("case.h5", "sensors/w", "sensors/q")
        R = R.reshape(-1, 3, 3)
        c = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / h
        rate = sum(c[i] * R[i:len(R) - 8 + i] for i in range(9))
        W = np.einsum("nij,nkj->nik", rate, R[4:-4])
        from_attitude = np.stack([W[:, 2, 1], W[:, 0, 2], W[:, 1, 0]], 1)
        np.testing.assert_allclose(w[4:-4], from_attitude, atol=1e-11)


if __name__ == "__main__":
    unittest.main()
