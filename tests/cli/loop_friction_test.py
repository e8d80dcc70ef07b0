"""Dry friction in closed loops: joints whose rate the loop forces through zero, and joints that stick."""
import math
import re
import unittest

import h5py
import numpy as np
from scipy.optimize import fsolve

from support import ProgramTest
from toml_text import section, table, toml

TOLERANCES = {"relative_tolerance": 1e-10, "absolute_tolerance": 1e-11}


def make_slider_crank(friction, driven, phi=0.3, rate=4.0, r=0.2, rod=0.5, more=""):
    """A crank that turns at `rate` about z, and a block on the x axis with the friction."""
    beta = -math.asin(r * math.sin(phi) / rod)
    beta_dot = -r * math.cos(phi) * rate / (rod * math.cos(beta))
    start = {"motion": "turn"} if driven else {"position": phi, "rate": rate}
    return toml(
        table("body", "crank", mass=2.0, inertia=[0.01, 0.02, 0.02], nodes=[{"id": 1, "position": [r, 0.0, 0.0]}]),
        table("body", "rod", mass=0.7, cg=[rod / 2, 0.0, 0.0], inertia=[0.001, 0.015, 0.015],
              nodes=[{"id": 1, "position": [rod, 0.0, 0.0]}]),
        table("body", "block", mass=1.5, inertia=[0.01, 0.01, 0.01]),
        table("hinge", "main", "revolute", child="crank", **start),
        table("hinge", "pin", "revolute", parent="crank", parent_node=1, child="rod", position=beta - phi,
              rate=beta_dot - rate),
        table("hinge", "guide", "prismatic", child="block", axis=[1.0, 0.0, 0.0],
              position=r * math.cos(phi) + rod * math.cos(beta),
              rate=-r * math.sin(phi) * rate - rod * math.sin(beta) * beta_dot, friction=friction),
        table("constraint", "wrist", "point_on_line", parent="block", child="rod", child_node=1, axis=[0.0, 0.0, 1.0]),
        table("function", "turn", "expression", expression=f"{phi} + {rate} * t", rate=f"{rate} + 0 * t",
              acceleration="0 * t") if driven else "",
        section("simulation", duration=3.0, output_step=0.01, integrator="rk", **TOLERANCES), more)


def make_four_bar(frictions, rate, gravity, angle=1.0, duration=2.0):
    """Links 0.3, 0.9, 0.7 between the origin and a pin at (1.1, 0.05), with friction at the first three joints."""
    lengths, end = (0.3, 0.9, 0.7), np.array([1.1, 0.05])

    def calc_end(angles):
        return sum(l * np.array([np.cos(a), np.sin(a)]) for l, a in zip(lengths, angles))
    others = fsolve(lambda z: calc_end([angle, *z]) - end, [0.3, -1.2], xtol=1e-13)
    angles = np.array([angle, *others])
    J = np.array([[-l * np.sin(a), l * np.cos(a)] for l, a in zip(lengths, angles)]).T
    rates = np.array([rate, *np.linalg.solve(J[:, 1:], -J[:, 0] * rate)])
    parts = []
    for i, (l, mass, inertia) in enumerate(zip(lengths, (1.0, 3.0, 2.0), (0.0075, 0.2, 0.08))):
        parts.append(table("body", f"b{i + 1}", mass=mass, cg=[l / 2, 0.0, 0.0], inertia=[0.001, inertia, inertia],
                           nodes=[{"id": 1, "position": [l, 0.0, 0.0]}]))
        parent = {"parent": f"b{i}", "parent_node": 1} if i > 0 else {}
        friction = {"friction": frictions[i]} if frictions[i] else {}
        parts.append(table("hinge", f"h{i + 1}", "revolute", child=f"b{i + 1}", **parent, **friction,
                           position=float(angles[i] - (angles[i - 1] if i > 0 else 0)),
                           rate=float(rates[i] - (rates[i - 1] if i > 0 else 0))))
    return toml(*parts,
                table("constraint", "pin", "point_on_line", parent_position=[*map(float, end), 0.0], child="b3", child_node=1),
                section("simulation", duration=duration, output_step=0.01, integrator="rk", gravity=[0.0, -gravity, 0.0],
                        **TOLERANCES))


class LoopFrictionTest(ProgramTest):
    def run_case(self, text):
        self.write("case.toml", text)
        self.bough("run", "case.toml", "-o", "case.h5", "-q")
        with h5py.File(self.path("case.h5")) as f:
            found = {}
            f.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        found["lines"] = [line.decode() for line in found.get("events/what", [])]
        return found

    def expect_smooth_limit(self, text, constant, smoothings=(1e-4, 1e-5)):
        """Smooth friction converges to the dry one, in proportion to the smoothing at least."""
        dry = self.run_case(text)
        for smoothing in smoothings:
            smooth = self.run_case(re.sub(r"friction = \{([^}]*)\}", rf"friction = {{\1, smoothing = {smoothing}}}", text))
            for path in [path for path in dry if re.fullmatch("hinges/[^/]*/q", path)]:
                error = np.abs(dry[path] - smooth[path]).max()
                self.assertLess(error, constant * smoothing + 2e-9, (path, smoothing))
        return dry

    def test_a_driven_guide_passes_its_dead_centres(self):
        """The crank turns evenly: friction of the guide does F * way, and no joint can stick."""
        force, phi, r, rod = 3.0, 0.3, 0.2, 0.5
        found = self.run_case(make_slider_crank({"coulomb": force}, True))
        self.assertFalse([line for line in found["lines"] if "sticks" in line], found["lines"])
        angle = phi + 4.0 * found["time"]
        exact = r * np.cos(angle) + np.sqrt(rod**2 - (r * np.sin(angle))**2)
        np.testing.assert_allclose(found["hinges/guide/q"].ravel(), exact, atol=1e-12)
        ends = [phi, *(np.pi * np.arange(1, int((phi + 12) / np.pi) + 1)), phi + 12]
        travel = sum(abs(np.diff(r * np.cos(np.array(pair)) + np.sqrt(rod**2 - (r * np.sin(np.array(pair)))**2))[0])
                     for pair in zip(ends[:-1], ends[1:]))
        self.assertAlmostEqual(found["energy/dissipated"].ravel()[-1], force * travel, delta=1e-8)

    def test_a_free_crank_passes_its_dead_centres(self):
        """Friction alone takes energy; the crank turns on."""
        for friction in ({"coulomb": 0.02}, {"mu": 0.3}):
            dry = self.expect_smooth_limit(make_slider_crank(friction, False), 0.1)
            self.assertFalse([line for line in dry["lines"] if "sticks" in line], dry["lines"])
            energy = sum(dry[f"energy/{name}"].ravel() for name in ("kinetic", "strain", "potential", "dissipated"))
            np.testing.assert_allclose(energy, energy[0], rtol=1e-9)
            self.assertGreater(dry["energy/dissipated"].ravel()[-1], 0.01)
            self.assertGreater(dry["hinges/main/q"].ravel()[-1], 2 * math.pi)

    def test_four_bars(self):
        """Near a reversal of the loop, a locked joint with negligible motion has undetermined reactions."""
        mu, dry = {"mu": 0.3, "pin_radius": 0.03}, {"coulomb": 0.3}
        for frictions in ((mu, mu, mu), (mu, None, dry), (None, mu, dry)):
            self.expect_smooth_limit(make_four_bar(frictions, -6.0, 9.81), 1.0)

    def test_a_loop_that_stops(self):
        """Friction stops the loop and holds it against gravity; smooth friction creeps."""
        dry = self.expect_smooth_limit(make_four_bar(({"coulomb": 5.0}, None, {"coulomb": 2.5}), 3.0, 9.81), 2.0, [1e-4])
        self.assertTrue([line for line in dry["lines"] if "sticks" in line])
        for hinge in ("h1", "h2", "h3"):
            self.assertLess(abs(dry[f"hinges/{hinge}/qdot"].ravel()[-1]), 1e-20)

    def test_joints_that_others_hold(self):
        """The rates of joints in a loop that stands are round-off, and their sign is no event."""
        mu = {"mu": 0.3, "pin_radius": 0.03}
        for frictions, angle in ((({"coulomb": 2.5}, None, {"mu": 0.3, "pin_radius": 0.05}), -0.74),
                                 ((mu, {"coulomb": 1.0}, {"mu": 0.2, "pin_radius": 0.03}), -2.10)):
            dry = self.expect_smooth_limit(make_four_bar(frictions, 3.0, 9.81, angle=angle), 10.0, [1e-4])
            self.assertEqual(len(dry["lines"]), 1, dry["lines"])
            self.assertIn("sticks", dry["lines"][0])

    def test_joints_that_hold_together(self):
        """Virtual power: the torque at h1 moves the loop from F1 + F3 abs(dq3/dq1) on, with either sign."""
        first, third = 1.0, 2.0
        text = make_four_bar(({"coulomb": first}, None, {"coulomb": third}), 0.0, 0.0, duration=4.0)
        rates = [float(x) for x in re.findall(r"rate = (.*)", make_four_bar((None, None, None), 1.0, 0.0))]
        limit = first + third * abs(rates[2] / rates[0])
        self.assertGreater(third * abs(rates[2]), 0.3)
        text += toml(table("function", "torque", "table", x=[0.0, 1.0, 4.0], y=[0.0, 0.98 * limit, -1.3 * limit],
                           interpolation="linear"),
                     table("actuator", "motor", "hinge", hinge="h1", input="torque"))
        found = self.run_case(text)
        moves = found["time"][np.abs(found["hinges/h1/qdot"].ravel()) > 1e-12]
        slip = 1 + 3 * (0.98 + 1) / (0.98 + 1.3)
        self.assertLess(abs(moves[0] - slip), 0.0101)
        slips = [t for t, line in zip(found["events/time"], found["lines"]) if "slips" in line]
        self.assertAlmostEqual(slips[-1], slip, delta=1e-8)

    def test_a_loop_that_an_event_locks(self):
        """A lock of h2 holds the loop: the friction of h1 and h3 is zero, not of the sign of round-off, until the release."""
        for first in ({"coulomb": 0.3}, {"mu": 0.3, "pin_radius": 0.03, "coulomb": 0.1}):
            text = make_four_bar((first, None, {"coulomb": 0.2}), 3.0, 9.81, duration=1.2)
            text += toml(table("event", "hold", time=0.305, action="lock", hinge="h2"),
                         table("event", "free", time=0.805, action="release", hinge="h2"))
            for integrator in ("rk", "radau"):
                found = self.run_case(text.replace('"rk"', f'"{integrator}"'))
                held = (found["time"] > 0.306) & (found["time"] < 0.804)
                for hinge in ("h1", "h3"):
                    self.assertLess(np.abs(found[f"hinges/{hinge}/qdot"].ravel()[held]).max(), 1e-13)
                    np.testing.assert_array_equal(found[f"hinges/{hinge}/force"].ravel()[held], 0, f"{hinge} {integrator}")
                    self.assertGreater(np.abs(found[f"hinges/{hinge}/force"].ravel()[-1]), 0.09)
                self.assertFalse([line for line in found["lines"] if "slips" in line], found["lines"])

    def test_a_loop_that_a_motion_holds(self):
        """A crank that rests and sets out slowly: the friction of the guide is zero at rest, and full from then on."""
        text = make_slider_crank({"coulomb": 2.0}, True, rate=0.0).replace("0.3 + 0.0 * t", "0.3 + max(t - 1, 0)^4")
        text = text.replace("0.0 + 0 * t", "4 * max(t - 1, 0)^3").replace("0 * t", "12 * max(t - 1, 0)^2")
        found = self.run_case(text)
        force, time = found["hinges/guide/force"].ravel(), found["time"]
        np.testing.assert_array_equal(force[time < 0.99], 0)
        np.testing.assert_allclose(np.abs(force[(time > 1.02) & (time < 1.8)]), 2.0)


if __name__ == "__main__":
    unittest.main()
