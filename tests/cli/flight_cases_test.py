"""Published cases of spacecraft dynamics: two panels, dual spin, a spinning body with a damper, an inverted pendulum."""
import math
import unittest

import numpy as np
import scipy.integrate
import scipy.linalg

from support import ProgramTest
from spacecraft import write_panels
from toml_text import section, table, toml


def make_panels(duration, more="", **simulation):
    """write_panels() of spacecraft.py, run."""
    return toml(
        write_panels(),
        table("sensor", "attitude", "quaternion", body="hub"),
        more,
        section("simulation", duration=duration, integrator="rk", relative_tolerance=1e-12, absolute_tolerance=1e-13,
                **simulation))


SPIN, AXIAL, LATERAL = 20.0, 2.0, 50.0  # rotor: rate and inertia about its axis; inertia of the whole across it

DUAL_SPIN = toml(
    table("body", "platform", mass=100.0, inertia=[40.0, 40.0, 30.0]),
    table("body", "rotor", mass=10.0, inertia=[10.0, 10.0, AXIAL]),
    table("hinge", "flight", "free", child="platform"),
    table("hinge", "bearing", "revolute", parent="platform", child="rotor", axis=[0.0, 0.0, 1.0], rate=[SPIN]),
    section("simulation", duration=1.0))


def write_boom(axis, num, length, tip):
    """Deck of a straight boom along an axis (0: x, 1: y) from grid 1 on, with a mass at its end."""
    grids = [f"GRID,{k + 1},,{','.join(repr(k * length / num if i == axis else 0.0) for i in range(3))}" for k in range(num + 1)]
    up = "0.,1.,0." if axis == 0 else "0.,0.,1."
    return "\n".join(["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "EIGRL,1,,,12",
                      "SPC1,1,123456,1", "MAT1,1,7.+10,,0.3,1500.", "PBAR,1,1,4.-4,2.-8,5.-8,1.-8", *grids,
                      *(f"CBAR,{k + 1},1,{k + 1},{k + 2},{up}" for k in range(num)), f"CONM2,900,{num + 1},,2.0", tip, "ENDDATA\n"])


class FlightCases(ProgramTest):
    def test_damping_ratios_are_those_of_the_free_motions_in_every_frame(self):
        """The poles of a free body do not depend on the frame: each has the ratio of [[body]] damping."""
        self.write("boom.bdf", write_boom(1, 6, 4.0, ",0.02,,0.03,,,0.04"))
        system = toml(table("body", "boom", file="boom.h5", damping="RATIOS"),
                      table("hinge", "flight", "free", child="boom", child_node=1), section("simulation", duration=1.0))
        free = None
        for frame in ({"frame": "mean"}, {"frame": "free"}, {"frame": "node", "frame_nodes": [1]},
                      {"frame": "mass-centre", "frame_nodes": [4]}, {"frame": "mass-centre"}):
            self.write("boom.toml", toml(section("body", name="boom", deck="boom.bdf", interface=[1, 7], **frame),
                                         section("body.modes", number=4), section("body.output", file="boom.h5")))
            self.bough("reduce", "boom.toml")
            for ratios in ([0.05] * 4, [0.01, 0.02, 0.03, 0.04]):
                self.write("free.toml", system.replace('"RATIOS"', repr(ratios)))
                self.bough("linearize", "free.toml", "-o", "free.h5")
                real, imag = self.read_arrays("free.h5", "poles/real", "poles/imag")
                poles = (real + 1j * imag).ravel()
                poles = sorted(poles[poles.imag > 1], key=abs)
                free = [abs(pole) for pole in poles] if free is None else free
                np.testing.assert_allclose([abs(pole) for pole in poles], free, rtol=1e-6, err_msg=repr(frame))
                np.testing.assert_allclose([-pole.real / abs(pole) for pole in poles], ratios, rtol=1e-6, err_msg=repr(frame))

    def test_a_wrong_body_has_its_own_error_alone(self):
        """An LVLH frame of a body with too few eta: no gravity_central is missing."""
        self.write("boom.bdf", write_boom(1, 6, 4.0, ",0.02,,0.03,,,0.04"))
        self.bough("reduce", "boom.bdf", "-n", 4, "--interface", "1,7", "-o", "boom.h5")
        self.write("orbit.toml", toml(
            table("body", "hub", mass=100.0, inertia=[20.0, 25.0, 30.0]),
            table("body", "boom", file="boom.h5", eta=[0.2, 0.1]),
            table("hinge", "flight", "free", child="hub", position=[1.0, 0.0, 0.0, 0.0, 7e6, 0.0, 0.0]),
            table("hinge", "root", "fixed", parent="hub", child="boom", child_node=1),
            table("force", "earth", "gravity_central", mu=3.986e14),
            table("sensor", "v", "velocity", body="hub", relative_to="lvlh:boom"), section("simulation", duration=1.0)))
        self.assertNotIn("no-orbit", self.fails(1, "check", "orbit.toml", error="system.bad-count").stderr)

    def test_stiff_modes_do_not_lead_a_steady_spin_astray(self):
        """A floating hub with two booms turns without tilt, whatever axial modes the booms keep."""
        self.write("boom.bdf", write_boom(0, 10, 6.0, ",0.,,0.,,,0."))
        self.write("boom.toml", toml(section("body", name="boom", deck="boom.bdf", frame="fixed", interface=[1, 11]),
                                     section("body.modes", number=40), section("body.output", file="boom.h5")))
        self.bough("reduce", "boom.toml")
        # First motion in the plane of spin: at 0.8 of a separate finite-element model with geometric stiffness.
        for rate, exact, numbers in ((0.8, 2.707370, (12, 24, 40)), (0.2, 2.66265, (12, 24))):
            for modes in numbers:
                roots = [table("hinge", name, "fixed", parent="hub", parent_node=node, child=name, child_node=1,
                               parent_rotation=[0.0, 0.0, turn]) for name, node, turn in (("a", 1, 0.0), ("b", 2, math.pi))]
                self.write("spin.toml", toml(
                    table("body", "hub", mass=200.0, inertia=[40.0, 55.0, 70.0],
                          nodes=[{"id": 1, "position": [0.7, 0.0, 0.0]}, {"id": 2, "position": [-0.7, 0.0, 0.0]}]),
                    table("body", "a", file="boom.h5", modes=modes), table("body", "b", file="boom.h5", modes=modes),
                    table("hinge", "flight", "free", child="hub", rate=[0.0, 0.0, rate, 0.0, 0.0, 0.0]), *roots,
                    section("simulation", duration=1.0)))
                self.bough("linearize", "spin.toml", "--equilibrium", "-o", "spin.h5")
                imag, residual = self.read_arrays("spin.h5", "poles/imag", "operating_point/residual")
                self.assertLess(np.max(residual), 1e-3, (rate, modes))
                self.assertLess(abs(imag - exact).min(), 2e-5, (rate, modes))

    def test_wheels_and_gimbals_go_on_from_a_run(self):
        """A mission in two parts: momentum of the system, stored momentum included, is that of the run in one."""
        mission = toml(
            table("body", "ship", mass=10.0, inertia=[1.0, 1.5, 2.0]), table("hinge", "flight", "free", child="ship"),
            table("function", "torque", "constant", value=0.1), table("function", "rate", "constant", value=0.05),
            table("actuator", "wheel", "wheel", body="ship", axis=[0.0, 0.0, 1.0], inertia=0.01, input="torque"),
            table("actuator", "full", "wheel", body="ship", axis=[0.0, 1.0, 0.0], inertia=0.01, momentum_limit=0.2, input="torque"),
            table("actuator", "gyro", "cmg", body="ship", gimbal_axis=[1.0, 0.0, 0.0], spin_axis=[0.0, 1.0, 0.0], momentum=2.0,
                  input="rate"),
            table("actuator", "double", "double_gimbal_cmg", body="ship", gimbal_axis=[0.0, 0.0, 1.0],
                  inner_axis=[1.0, 0.0, 0.0], spin_axis=[0.0, 1.0, 0.0], momentum=1.0, angle=[0.1, -0.2], input="rates"),
            table("controller", "rates", "expression", inputs=["rate"], expression=["u1", "0.2 - u1"]),
            section("simulation", duration="DURATION", output_step=1.0, integrator="rk", relative_tolerance=1e-11,
                    absolute_tolerance=1e-12))
        for name, times in (("whole", "8.0"), ("first", "5.0"), ("second", "3.0\nstart = 5.0")):
            self.write(name + ".toml", mission.replace('"DURATION"', times))
            self.bough("run", name + ".toml", "-o", name + ".h5", *(["--start-from", "first.h5"] if name == "second" else []))
        paths = ["momentum/angular", "bodies/ship/angular_velocity", *(f"actuators/{a}" for a in ("wheel", "full", "gyro", "double"))]
        for path, whole, second in zip(paths, self.read_arrays("whole.h5", *paths), self.read_arrays("second.h5", *paths)):
            # The first sample is before the event of the wheel that starts at its limit.
            np.testing.assert_allclose(second[1:], whole[6:], atol=1e-8, err_msg=path)

    def test_two_panels_of_basilisk(self):
        self.write("panels.toml", make_panels(2.5, output_step=0.5))
        self.bough("run", "panels.toml", "-o", "panels.h5")
        q, linear, angular, kinetic = self.read_arrays("panels.h5", "sensors/attitude", "momentum/linear", "momentum/angular",
                                                       "energy/kinetic")
        # Modified Rodrigues parameters after 2.5 s, printed there to 16 digits and compared to 1e-10.
        np.testing.assert_allclose(q[-1, 1:] / (1 + q[-1, 0]), [0.06170318243240492, -0.07089090074412899, 0.06409500412692531],
                                   rtol=1e-9)
        self.assertLess(abs(angular - angular[0]).max(), 1e-10 * abs(angular[0]).max())
        self.assertLess(abs(linear - linear[0]).max(), 1e-10 * 950)
        self.assertEqual(kinetic.size, 6)

    def test_nutation_of_dual_spin(self):
        """A despun platform: h/I across the axis (Hughes, Spacecraft Attitude Dynamics, 1986, ch. 6)."""
        self.write("spin.toml", DUAL_SPIN)
        self.bough("linearize", "spin.toml", "-o", "spin.h5")
        real, imag = self.read_arrays("spin.h5", "poles/real", "poles/imag")
        nutation = AXIAL * SPIN / LATERAL
        self.assertAlmostEqual(imag.max(), nutation, delta=1e-9)
        self.assertLess(abs(real).max(), 1e-7)

    def test_spin_with_a_damper(self):
        """A spinning body with a mass on a spring along the axis: stable about the major axis, not about the minor one."""
        m, b, k, c, rate = 2.0, 0.7, 30.0, 1.5, 3.0
        for lateral, axial, is_stable in ((8.0, 12.0, True), (12.0, 8.0, False)):
            self.write("spin.toml", toml(
                table("body", "disk", mass=50.0, inertia=[lateral, lateral, axial]),
                table("body", "damper", mass=m),
                table("hinge", "pivot", "spherical", child="disk", rate=[0.0, 0.0, rate]),
                table("hinge", "slide", "prismatic", parent="disk", child="damper", parent_position=[b, 0.0, 0.0],
                      axis=[0.0, 0.0, 1.0], stiffness=[k], damping=[c]),
                section("simulation", duration=1.0)))
            self.bough("linearize", "spin.toml", "-o", "spin.h5")
            real, imag = self.read_arrays("spin.h5", "poles/real", "poles/imag")
            # Rates across the axis, place and speed of the damper; momentum about the pivot.
            Ix, Iy, H = lateral, lateral + m * b * b, (axial + m * b * b) * rate
            M = np.array([[Ix, 0, 0, 0], [0, Iy, 0, -m * b], [0, 0, 1, 0], [0, -m * b, 0, m]])
            F = np.array([[0, -H + rate * Iy, 0, 0], [H - rate * Ix, 0, m * b * rate**2, 0], [0, 0, 0, 1],
                          [-m * b * rate, 0, -k, -c]])
            exact = np.linalg.eigvals(np.linalg.solve(M, F))
            self.assertEqual(bool(exact.real.max() < 0), is_stable)
            for pole in exact:
                self.assertLess(abs(real + 1j * imag - pole).min(), 1e-7, (lateral, exact, real + 1j * imag))

    def test_lqr_of_the_furuta_pendulum(self):
        """Equations of Cazzolato & Prime, J. Control Sci. Eng. 2011, 528341, with a rigid arm; a gain by Riccati's equation."""
        J, m, L, l, J2, g, b1, b2 = 0.02, 0.1, 0.3, 0.2, 1.5e-3, 9.81, 2e-3, 1e-3
        J0, Jh, c12 = J + m * L * L, J2 + m * l * l, m * L * l

        def calc_rates(x, torque):
            s, c = math.sin(x[1]), math.cos(x[1])
            M = [[J0 + Jh * s * s, c12 * c], [c12 * c, Jh]]
            f = [torque - b1 * x[2] - 2 * Jh * s * c * x[2] * x[3] + c12 * s * x[3]**2,
                 -b2 * x[3] + Jh * s * c * x[2]**2 - g * m * l * s]
            return [x[2], x[3], *np.linalg.solve(M, f)]

        def write(position, gains):
            return self.write("furuta.toml", toml(
                table("body", "arm", mass=0.5, cg=[0.1, 0.0, 0.0], inertia=[1e-3, J - 0.5 * 0.01, J - 0.5 * 0.01]),
                table("body", "rod", mass=m, cg=[0.0, 0.0, -l], inertia=[J2, J2, 0.0]),
                table("hinge", "base", "revolute", child="arm", axis=[0.0, 0.0, 1.0], damping=[b1]),
                table("hinge", "joint", "revolute", parent="arm", child="rod", parent_position=[L, 0.0, 0.0],
                      axis=[1.0, 0.0, 0.0], position=[position], damping=[b2]),
                table("sensor", "angle", "hinge_angle", hinge="base"),
                table("sensor", "tilt", "hinge_angle", hinge="joint", bias=-math.pi),
                table("sensor", "rate", "hinge_rate", hinge="base"),
                table("sensor", "tilt_rate", "hinge_rate", hinge="joint"),
                table("controller", "feedback", "gain", inputs=["angle", "tilt", "rate", "tilt_rate"], gain=[gains]),
                table("actuator", "motor", "hinge", hinge="base", input="feedback"),
                section("simulation", duration=3.0, output_step=0.05, gravity=[0.0, 0.0, -g], integrator="rk",
                        relative_tolerance=1e-12, absolute_tolerance=1e-13)))

        self.bough("linearize", write(math.pi, [0.0] * 4), "--inputs", "motor", "--open", "-o", "plant.h5")
        A, B = self.read_arrays("plant.h5", "A", "B")
        M = np.linalg.inv([[J0, -c12], [-c12, Jh]])
        exact = np.zeros((4, 4))
        exact[:2, 2:] = np.eye(2)
        exact[2:, :2] = M @ [[0, 0], [0, g * m * l]]
        exact[2:, 2:] = -M @ np.diag([b1, b2])
        np.testing.assert_allclose(A, exact, atol=1e-7)
        np.testing.assert_allclose(B.ravel(), [0, 0, *M[:, 0]], atol=1e-8)
        P = scipy.linalg.solve_continuous_are(A, B, np.diag([1.0, 1.0, 0.1, 0.1]), [[10.0]])
        gain = (B.T @ P / 10).ravel()
        self.bough("run", write(math.pi + 0.2, [float(-x) for x in gain]), "-o", "furuta.h5")
        t, angle, tilt = self.read_arrays("furuta.h5", "time", "sensors/angle", "sensors/tilt")
        goal = np.array([0, math.pi, 0, 0])
        found = scipy.integrate.solve_ivp(lambda _, x: calc_rates(x, -gain @ (x - goal)), (0, 3), [0, math.pi + 0.2, 0, 0],
                                          method="DOP853", t_eval=t.ravel(), rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(angle.ravel(), found.y[0], atol=1e-9)
        np.testing.assert_allclose(tilt.ravel(), found.y[1] - math.pi, atol=1e-9)
        self.assertLess(abs(tilt[-1]).max(), 0.02)

    def test_spin_of_a_hub_with_stiff_modes(self):
        """A floating hub, its centre of mass off its origin, and a boom of 12 or 40 modes up to 4e6 times as stiff as the first:
        the spin that `equilibrium` finds goes on in a run, the deflection as it was."""
        n, length = 20, 10.0
        deck = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPBAR,7,1,3.-4,4.-9,9.-9,5.-9\nSPC1,1,123456,1\n"
        deck += "".join(f"GRID,{i + 1},,{i * length / n},0.,0.\n" for i in range(n + 1))
        deck += "".join(f"CBAR,{i + 1},7,{i + 1},{i + 2},0.,1.,0.\n" for i in range(n))
        self.write("boom.bdf", deck + "ENDDATA\n")
        for modes in (12, 40):
            self.bough("reduce", "boom.bdf", "--modes", modes, "--interface", n + 1, "-o", "boom.h5", "-q")
            for rate in (0.2, 0.8, 2.5):
                self.write("spin.toml", toml(
                    table("body", "hub", mass=100.0, cg=[0.13, -0.07, 0.0], inertia=[20.0, 30.0, 40.0]),
                    table("body", "boom", file="boom.h5"),
                    table("hinge", "base", "free", child="hub", rate=[0.0, 0.0, rate, 0.0, 0.0, 0.0]),
                    table("hinge", "root", "fixed", parent="hub", child="boom", parent_position=[0.5, 0.3, 0.0],
                          parent_rotation_deg=[0.0, 0.0, 20.0]),
                    table("sensor", "tip", "deflection", body="boom", node=n + 1),
                    section("simulation", duration=2 * math.pi / rate / 8, output_step=2 * math.pi / rate / 80,
                            relative_tolerance=1e-10, absolute_tolerance=1e-13)))
                printed = self.bough("equilibrium", "spin.toml", "-o", "rest.h5").stdout
                self.assertLessEqual(int(printed.split(" iterations")[0].split()[-1]), 6, printed)
                self.bough("run", "spin.toml", "--start-from", "rest.h5", "-o", "spin.h5", "-q")
                tip, = self.read_arrays("spin.h5", "sensors/tip")
                off = np.abs(tip - tip[0]).max() / np.abs(tip[0]).max()
                print(f"{modes} modes, {rate} rad/s: {np.linalg.norm(tip[0]):.3e} m, changes by {off:.1e}")
                self.assertLess(off, 1e-6)


if __name__ == "__main__":
    unittest.main()
