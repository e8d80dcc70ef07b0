"""stiffening = "lagged", the report's own scheme, against the consistent one on the report's models."""
import unittest

import h5py
import numpy as np
from scipy.spatial.transform import Rotation

from support import ProgramTest
from toml_text import section, table, toml


class Lagged(ProgramTest):
    def run_one(self, name, changes=(), code=0):
        """Runs NAME.toml with texts replaced; the results."""
        text = open(self.path(name + ".toml")).read()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("run.toml", text)
        self.bough("run", "run.toml", "-o", "run.h5", code=code)
        return h5py.File(self.path("run.h5"))

    def read_sensor(self, name, changes, sensor, column):
        """A component of a sensor in run_one()."""
        with self.run_one(name, changes) as f:
            return f[f"sensors/{sensor}"][:, column]

    def lag(self, step, duration):
        return [("[simulation]", f'[simulation]\nstiffening = "lagged"\nstep = {step}'),
                ('integrator = "adams"', 'integrator = "rk4"'), duration]

    def test_spinup_converges_with_the_lag(self):
        """The error of the tip is of the first order in the step; consistent stiffening has none of it."""
        self.reduce_example("ex01-spinup", "boom.toml")
        until = ("duration = 20.0", "duration = 8.0")
        consistent = self.read_sensor("spinup", [until], "tip_deflection", 1)
        tips = {}
        for step in (0.01, 0.005, 0.0025):
            with self.run_one("spinup", self.lag(step, until)) as f:
                tips[step] = f["sensors/tip_deflection"][:, 1]
                recorded = f["stiffening/boom"][:] if "stiffening/boom" in f else f["stiffening"]
        differences = [np.abs(tips[0.01] - tips[0.005]).max(), np.abs(tips[0.005] - tips[0.0025]).max()]
        self.assertLess(abs(differences[0] / differences[1] - 2), 0.3, differences)
        # Another linear theory, not the consistent one: near, to a few per cent of half a metre.
        self.assertLess(np.abs(tips[0.0025] - consistent).max(), 0.03)
        self.assertGreater(np.abs(tips[0.0025]).max(), 0.5)
        # A_I as measured: ωz² and αz of the shaft.
        self.assertGreater(recorded[-1, 8], 1)

    def test_what_it_does_not_measure_is_told(self):
        self.reduce_example("ex02-hub", "boom.toml")
        text = open(self.path("hub-2.18.toml")).read()
        text = text.replace("[simulation]", '[simulation]\nstiffening = "lagged"\nstiffening_step = 0.01')
        self.write("jet.toml", text + table("actuator", "jet", "force", body="hub", axis=[1.0, 0.0, 0.0]))
        said = self.bough("check", "jet.toml").stderr
        self.assertIn("[system.lagged-loads]", said)
        self.assertIn("not of: jet", said)

    def test_pattern_is_fed_back(self):
        """Section 4.1.4.3: the plate's swing under 0.165 lb/in; without K_G2 of the load it would be 13 times as stiff."""
        self.reduce_example("ex05-plate", "plate.toml")
        until = ("duration = 40.0", "duration = 6.0")
        consistent = self.read_sensor("plate-0.165", [until], "deflection", 2)
        with self.run_one("plate-0.165", self.lag(0.01, until)) as f:
            lagged = f["sensors/deflection"][:, 2]
            self.assertAlmostEqual(f["stiffening/plate"][-1, 18], 0.165, places=12)
        # The load is steady: nothing of the lag but the half second of its ramp, before the tap.
        self.assertLess(np.abs(lagged - consistent).max(), 2e-3 * np.abs(consistent).max())

    def test_loads_of_a_hinge_are_its_reaction(self):
        """FCONI of the upper link equals the hinge force of the lower one, to the order of the lag."""
        self.reduce_example("ex03-two-link", "link.toml")
        off = []
        for step in (0.001, 0.0005, 0.00025):
            changes = [*self.lag(step, ("duration = 3.0", "duration = 0.5")), ('file = "link.h5"', 'file = "link.h5"\nmodes = 2')]
            with self.run_one("two-link", changes) as f:
                fconi, reaction = f["stiffening/upper"][:, 12:15], f["hinges/elbow/reaction_force"][:]
            sizes = np.linalg.norm(fconi[20:], axis=1), np.linalg.norm(reaction[20:], axis=1)
            off.append(np.abs(sizes[0] - sizes[1]).max() / sizes[1].max())
        self.assertLess(off[-1], 1e-3)
        for coarse, fine in zip(off, off[1:]):
            self.assertLess(abs(coarse / fine - 2), 0.1, off)

    def test_force_and_moment_are_newtons_and_eulers(self):
        """Load of a rigid body on a turned and shifted clamp at the tip: m (a - g) and J α + ω × J ω + r × m (a - g), about
        the node and in the link's frame."""
        self.reduce_example("ex03-two-link", "link.toml")
        sensors = ""
        for body, node, types in (("load", 0, ("acceleration", "angular_velocity", "angular_acceleration", "position")),
                                  ("upper", 11, ("position",))):
            for kind in types:
                sensors += table("sensor", f"{body}_{kind}", kind, body=body, node=node)
        off = []
        for step in (0.0005, 0.00025):
            self.write("run.toml", toml(
                table("body", "upper", file="link.h5", modes=2),
                table("body", "load", mass=0.5, inertia=[0.002, 0.003, 0.004, 0.0003, -0.0002, 0.0001]),
                table("hinge", "shoulder", "revolute", child="upper", position=0.3),
                table("hinge", "clamp", "fixed", parent="upper", parent_node=11, parent_position=[0.03, 0.02, 0.01],
                      parent_rotation_deg=[20.0, 35.0, -50.0], child="load"),
                sensors,
                section("simulation", duration=0.4, output_step=0.01, gravity=[0.0, -9.81, 0.0], integrator="rk4", step=step,
                        stiffening="lagged")))
            self.bough("run", "run.toml", "-o", "run.h5")
            with h5py.File(self.path("run.h5")) as f:
                fconi = f["stiffening/upper"][5:, 12:]
                a, w, alpha, p = (f["sensors/load_" + kind][5:] for kind in (
                    "acceleration", "angular_velocity", "angular_acceleration", "position"))
                arm = p - f["sensors/upper_position"][5:]
                frames = {}
                for body in ("upper", "load"):
                    q = f[f"bodies/{body}/quaternion"][5:]
                    frames[body] = np.array([Rotation.from_quat([*x[1:], x[0]]).as_matrix() for x in q])
            J = np.array([[2, 0.3, -0.2], [0.3, 3, 0.1], [-0.2, 0.1, 4]]) * 1e-3
            expected = []
            for k in range(len(a)):
                J_W = frames["load"][k] @ J @ frames["load"][k].T
                force = 0.5 * (a[k] - [0, -9.81, 0])
                moment = J_W @ alpha[k] + np.cross(w[k], J_W @ w[k]) + np.cross(arm[k], force)
                expected.append(-np.concatenate([frames["upper"][k].T @ force, frames["upper"][k].T @ moment]))
            expected = np.array(expected)
            off.append([np.abs(fconi - expected)[:, part].max() / np.abs(expected[:, part]).max()
                        for part in (slice(0, 3), slice(3, 6))])
        self.assertLess(max(off[1]), 5e-3, off)
        for coarse, fine in zip(*off):
            self.assertLess(abs(coarse / fine - 2), 0.2, off)

    def test_hinges_that_it_feeds_back_are_told(self):
        self.reduce_example("ex03-two-link", "link.toml")
        text = open(self.path("two-link.toml")).read()
        self.write("lagged.toml", text.replace("[simulation]", '[simulation]\nstiffening = "lagged"\nstiffening_step = 0.01'))
        self.assertIn("[system.lagged-hinges]", self.bough("check", "lagged.toml").stderr)


if __name__ == "__main__":
    unittest.main()
