"""Loops that are cut at a sampled signal: response, margins and sweeps, of one sample rate and of several."""
import json
import math
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.optimize
import scipy.signal

from linear_test import LinearTest
from response_test import AXIS
from toml_text import section, table, toml


def make_pointing(kp, kd, ki, spring, sampled=""):
    """A hub that a motor turns, and a dish on a spring."""
    return toml(
        table("body", "hub", mass=1.0, inertia=[2.0, 2.0, 3.0]), table("body", "dish", mass=0.5, inertia=[0.1, 0.1, 0.2]),
        table("hinge", "gimbal", "revolute", child="hub"),
        table("hinge", "mount", "revolute", parent="hub", child="dish", stiffness=spring, damping=0.05),
        table("sensor", "angle", "hinge_angle", hinge="gimbal", coordinate=1),
        table("sensor", "rate", "hinge_rate", hinge="gimbal", coordinate=1),
        table("controller", "pid", "pid", inputs=["angle"], rate="rate", kp=kp, kd=kd, ki=ki), sampled,
        table("actuator", "motor", "hinge", hinge="gimbal", input="pid"), section("simulation", duration=1.0))


class SampledLoop(LinearTest):
    """L(z) of a double integrator under a sampled law, z = exp(iωT): zero-order hold by scipy, delays by hand."""
    T, J, kp, kd = 0.1, 2.0, 8.0, 4.0

    def write_axis(self, delay=0.0, more="", **numbers):
        law = f'kd = "$kd"\nsample_time = {self.T}\n' + (f"delay = {delay}\n" if delay else "") + more
        text = AXIS.replace('kd = "$kd"\n', law).replace("kp = 8.0", f"kp = {numbers.get('kp', self.kp)!r}")
        self.write("axis.toml", text.replace("kd = 1.6", f"kd = {numbers.get('kd', self.kd)!r}"))

    def calc(self, delay, omega):
        """An addition from t_m = m T + (delay mod T) on comes back with the sample of the instant before t_m."""
        late, rest = divmod(delay, self.T)

        def hold(h):
            if h == 0:
                return np.eye(2), np.zeros((2, 1))
            system = (np.array([[0, 1], [0, 0.0]]), np.array([[0], [1 / self.J]]), np.eye(2), np.zeros((2, 1)))
            return scipy.signal.cont2discrete(system, h)[:2]
        (whole, gain), (early, gain_early) = hold(self.T), hold(self.T - rest)
        K = np.array([[self.kp, self.kd]])
        z = np.exp(1j * omega * self.T)
        L = K @ (early @ np.linalg.solve(z * np.eye(2) - whole, gain) + gain_early)
        return L[0, 0] * z**-(1 + round(late))

    def test_is_scipys_with_hold_and_delay(self):
        for delay in (0.0, 0.04, 0.25):
            self.write_axis(delay)
            for cut in ("drive", "law"):
                said = self.bough("linearize", "axis.toml", "--break", cut, "-o", "loop.h5", "--mat", "loop.mat").stderr
                self.assertNotIn("linear.sampled", said)
                self.bough("response", "loop.h5", "-o", "r.h5")
                with h5py.File(self.path("r.h5")) as f:
                    omega, L = 2 * math.pi * f["frequency_hz"][:], (f["real"][:] + 1j * f["imag"][:]).ravel()
                self.assertAlmostEqual(omega[-1] * self.T, math.pi, places=12)
                exact = np.array([self.calc(delay, w) for w in omega])
                self.assertLess(np.abs(L / exact - 1).max(), 1e-8, (delay, cut))
            self.assertEqual(scipy.io.loadmat(self.path("loop.mat"))["sample_time"], self.T)
            with h5py.File(self.path("loop.h5")) as f:
                self.assertEqual(float(np.squeeze(f["sample_time"][()])), self.T)

    def test_a_difference_of_samples_has_begun(self):
        """At t = 0 too: a law that takes the difference of its own samples has had one before."""
        text = AXIS.replace('kd = "$kd"\n', 'kd = 6.0\nfilter = 0.05\nsample_time = 0.02\ndelay = 0.02\n')
        self.write("axis.toml", text.replace("kp = 8.0", "kp = 40.0").replace('rate = "rate"\n', ""))
        for more in ([], ["--at", "0.1"]):
            self.bough("linearize", "axis.toml", "--break", "drive", *more, "-o", "loop.h5")
            self.bough("response", "loop.h5", "-o", "r.h5", "--from", "0.1", "--to", "20")
            with h5py.File(self.path("r.h5")) as f:
                z = np.exp(2j * math.pi * f["frequency_hz"][:] * 0.02)
                L = (f["real"][:] + 1j * f["imag"][:]).ravel()
            law = 40 + 6 * (1 - 1 / z) / (0.05 + 0.02 - 0.05 / z)
            plant = 0.02**2 / (2 * self.J) * (z + 1) / (z - 1)**2
            self.assertLess(np.abs(L * z / (law * plant) - 1).max(), 1e-8, more)

    def test_an_integrator_has_no_largest_gain(self):
        """Rounding where the loop is cut does not hide that the pole at 0 comes through."""
        for lag in (0.005, 0.01, 0.05):
            self.write("axis.toml", toml(
                table("body", "arm", mass=1.0, inertia=[1.0, 0.7, 1.0]),
                table("hinge", "pivot", "revolute", child="arm", axis=[0.0, 1.0, 0.0], damping=0.3, stiffness=1.0),
                table("sensor", "angle", "hinge_angle", hinge="pivot"),
                table("controller", "law", "pid", inputs=["angle"], kp=40.0, ki=15.0, kd=6.0, filter=0.01),
                table("actuator", "motor", "hinge", hinge="pivot", input="law", lag=lag), section("simulation", duration=1.0)))
            self.bough("linearize", "axis.toml", "--break", "motor", "-o", "loop.h5")
            self.assertIn("largest gain: infinite", self.bough("response", "loop.h5").stdout)
        self.assertIn("[linear.open-controller]",
                      self.bough("linearize", "axis.toml", "--open", "--inputs", "motor", "--outputs", "law").stderr)
        self.assertNotIn("[linear.open-controller]", self.bough("linearize", "axis.toml", "--open").stderr)

    def test_margins_are_where_the_closed_loop_turns(self):
        delay = 0.04
        self.write_axis(delay)
        self.bough("linearize", "axis.toml", "--break", "drive", "-o", "loop.h5")
        m = json.loads(self.bough("response", "loop.h5", "--json").stdout)["margins"]
        self.assertTrue(m["stable"])
        turn = scipy.optimize.brentq(lambda w: abs(self.calc(delay, w)) - 1, 0.5, 25)
        (crossing,) = m["phase"]
        self.assertAlmostEqual(crossing["frequency_hz"], turn / 2 / math.pi, places=8)
        self.assertAlmostEqual(crossing["degrees"], math.degrees(np.angle(self.calc(delay, turn)) + math.pi), places=6)
        # With that much more gain a multiplier of the closed loop, calculated elsewhere, lies on the unit circle.
        gain = min((c for c in m["gain"] if c["factor"] > 1), key=lambda c: c["factor"])
        for factor, sign in ((1.0, 0), (0.98, -1), (1.02, 1)):
            self.write_axis(delay, kp=self.kp * gain["factor"] * factor, kd=self.kd * gain["factor"] * factor)
            self.bough("linearize", "axis.toml", "-o", "closed.h5")
            with h5py.File(self.path("closed.h5")) as f:
                z = f["multipliers/real"][:].ravel() + 1j * f["multipliers/imag"][:].ravel()
            most = np.abs(z[np.abs(z - 1) > 1e-9]).max()  # the integral of the law, with ki = 0, stays at 1
            if sign == 0:
                self.assertAlmostEqual(most, 1, places=6)
            else:
                self.assertGreater(sign * (most - 1), 1e-4)

    def test_two_rates(self):
        """A sensor that is read twice as often."""
        self.write_axis(0.04)
        with open(self.path("axis.toml")) as f:
            text = f.read()
        text = text.replace('hinge = "axis"\n[[sensor]]',
                            'hinge = "axis"\nsample_time = 0.05\n[[sensor]]', 1)
        self.write("axis.toml", text)
        self.bough("linearize", "axis.toml", "--break", "law", "-o", "loop.h5")
        self.bough("response", "loop.h5", "-o", "r.h5")
        with h5py.File(self.path("r.h5")) as f:
            omega, L = 2 * math.pi * f["frequency_hz"][:], (f["real"][:] + 1j * f["imag"][:]).ravel()
        exact = np.array([self.calc(0.04, w) for w in omega])  # at the instants of the law it is the same angle
        self.assertLess(np.abs(L / exact - 1).max(), 1e-8)

    def test_a_cut_that_moves_between_samples_is_told(self):
        self.write_axis()
        said = self.bough("linearize", "axis.toml", "--break", "angle", "-o", "loop.h5").stderr
        self.assertIn("linear.sampled", said)


SLOW = """[[controller]]
name = "slow"
type = "pid"
inputs = ["angle"]
kp = "$ks"
sample_time = {T!r}

[[actuator]]
name = "drive2"
type = "hinge"
hinge = "axis"
input = "slow"

[simulation]"""


class LiftedLoop(LinearTest):
    """Loops cut at a signal that is sampled N times in the period of all samples: characteristic loci."""
    J, h = 2.0, 0.05

    def margins(self, cut, name="axis.toml"):
        self.bough("linearize", name, "--break", cut, "-o", "loop.h5")
        return json.loads(self.bough("response", "loop.h5", "--json").stdout)["margins"]

    def test_a_slow_integral_has_its_margin_downwards(self):
        """Rigid: 3.2 s³ + k (3 s² + s + 1e-4) is at the edge by Routh where 3 k = 3.2e-4; a stiff mode lies far above."""
        self.write("pointing.toml", make_pointing(kp=1.0, kd=3.0, ki=1e-4, spring=4e5))
        (gain,) = self.margins("motor", "pointing.toml")["gain"]
        self.assertAlmostEqual(gain["factor"], 3.2e-4 / 3, delta=1e-8)

    def test_margins_of_a_sampled_integral_are_the_same_at_both_cuts(self):
        """The twin is the closed loop with every gain of the controller multiplied, whose multipliers are found without a cut."""
        def write(factor):
            self.write("pointing.toml", make_pointing(kp=4 * factor, kd=6 * factor, ki=factor, spring=40.0,
                                                       sampled="sample_time = 0.2\ndelay = 0.13\n"))
        write(1.0)
        at_motor, at_pid = ([c["factor"] for c in self.margins(cut, "pointing.toml")["gain"]] for cut in ("motor", "pid"))
        down, up = max(f for f in at_pid if f < 1), min(f for f in at_pid if f > 1)
        np.testing.assert_allclose([max(f for f in at_motor if f < 1), min(f for f in at_motor if f > 1)], [down, up],
                                   rtol=1e-6)
        self.assertLess(max(at_motor), 1e6)
        for margin, sign in ((up, 1), (down, -1)):
            for side in (-0.01, 0.01):
                write(margin * (1 + side))
                self.bough("linearize", "pointing.toml", "-o", "closed.h5", "-q")
                with h5py.File(self.path("closed.h5")) as f:
                    largest = max(np.hypot(f["multipliers/real"][()], f["multipliers/imag"][()]))
                self.assertEqual(largest > 1, sign * side > 0, (margin, side))

    def test_a_loop_of_one_rate_has_the_margins_of_its_own_samples(self):
        """A slower sampled controller with gain 0 makes the loop a lifted one and changes nothing else."""
        for spring in ("", "damping = 0.4\nstiffness = 120.0\n", "stiffness = 120.0\n", "stiffness = 2000.0\n"):
            text = AXIS.replace('kd = "$kd"\n', 'kd = "$kd"\nsample_time = 0.1\ndelay = 0.04\n')
            text = text.replace("kd = 1.6", "kd = 4.0\nks = 0.0").replace('type = "revolute"', spring + 'type = "revolute"')
            self.write("plain.toml", text)
            expected = self.margins("law", "plain.toml")
            for count in (2, 3, 4, 7):
                self.write("axis.toml", text.replace("[simulation]", SLOW.format(T=0.1 * count)))
                found = self.margins("law")
                with h5py.File(self.path("loop.h5")) as f:
                    self.assertEqual(f["B"].shape[1], count)
                self.assertEqual(found["stable"], expected["stable"])
                if expected["stable"]:  # else the least distance is below the frequencies of the plain loop
                    self.assertAlmostEqual(found["distance"], expected["distance"], delta=1e-9)
                for kind in ("gain", "phase"):
                    self.assertEqual(len(found[kind]), len(expected[kind]), (spring, count, found, expected))
                    for one, other in zip(found[kind], expected[kind]):
                        for key in one:
                            self.assertAlmostEqual(one[key] / other[key], 1, delta=1e-9, msg=(spring, count, kind, key))

    def write_twin(self, kd=6.0, ks=3.0, slow=3):
        text = AXIS.replace("kp = 8.0", f"ks = {ks!r}").replace("kd = 1.6", f"kd = {kd!r}")
        text = text.replace('inputs = ["angle"]\nrate = "rate"\nkp = "$kp"\nkd = "$kd"\n',
                            f'inputs = ["rate"]\nkp = "$kd"\nsample_time = {self.h}\n')
        self.write("axis.toml", text.replace("[simulation]", SLOW.format(T=self.h * slow)))

    def calc_radius(self, factor, kd=6.0, ks=3.0, slow=3):
        """Largest multiplier over the slow period with the factor, complex or not, at the fast controller."""
        h = self.h
        step = np.array([[1, h, h * h / 2 / self.J], [0, 1, h / self.J], [0, 0, 1]])  # angle, rate, torque held
        slow_map = np.eye(2)
        first, state = np.array([[-ks, 0.0]]), slow_map.astype(complex)
        for _ in range(slow):
            torque = first - factor * kd * state[1:2]
            state = (step @ np.vstack([state, torque]))[:2]
        return np.abs(np.linalg.eigvals(state)).max()

    def test_two_rates_by_own_lifting(self):
        """Inner rate loop three times as fast as the outer loop, about a double integrator."""
        self.write_twin()
        m = self.margins("law")
        self.assertTrue(m["stable"])
        self.assertLess(self.calc_radius(1), 1)
        gain = lambda k: self.calc_radius(k) - 1
        up = min(c["factor"] for c in m["gain"] if c["factor"] > 1)
        down = max(c["factor"] for c in m["gain"] if c["factor"] < 1)
        ks = np.linspace(1, 2 * up, 2001)
        k = next(i for i in range(2000) if gain(ks[i]) < 0 <= gain(ks[i + 1]))
        self.assertAlmostEqual(up, scipy.optimize.brentq(gain, ks[k], ks[k + 1], xtol=1e-14), delta=1e-8 * up)
        ks = np.linspace(1, 0.5 * down, 2001)
        k = next(i for i in range(2000) if gain(ks[i]) < 0 <= gain(ks[i + 1]))
        self.assertAlmostEqual(down, scipy.optimize.brentq(gain, ks[k + 1], ks[k], xtol=1e-14), delta=1e-8)
        # A factor exp(-i phi): the least |phi| at which a multiplier is on the unit circle.
        turn = lambda phi: self.calc_radius(np.exp(-1j * phi)) - 1
        phis = np.linspace(0, math.pi, 2001)
        k = next(i for i in range(2000) if turn(phis[i]) < 0 <= turn(phis[i + 1]))
        phi = scipy.optimize.brentq(turn, phis[k], phis[k + 1], xtol=1e-14)
        self.assertAlmostEqual(min(abs(c["degrees"]) for c in m["phase"]), math.degrees(phi), places=6)
        # The multipliers of the program, which are calculated elsewhere.
        for margin, sign in ((up, 1), (down, -1)):
            for side in (-1e-4, 1e-4):
                self.write_twin(kd=6.0 * margin * (1 + side))
                z = self.multipliers()
                self.assertEqual(np.abs(z).max() > 1, sign * side > 0, (margin, side))

    def multipliers(self, *more):
        data = json.loads(self.bough("linearize", "axis.toml", "--json", *more).stdout)["multipliers"]
        z = np.array(data["real"]) + 1j * np.array(data["imag"])
        return z[(np.abs(z) > 1e-9) & (np.abs(z - 1) > 1e-9)]  # integrals of the controllers stay at 1

    def test_sample_times_without_a_common_period(self):
        self.write_twin(slow=math.pi)
        self.fails(1, "linearize", "axis.toml", "--break", "law", says=["no period in common"], error="linear.slower-samples")
        self.write_twin(slow=101)
        self.fails(1, "linearize", "axis.toml", "--break", "law", says=["101", "100"], error="linear.slower-samples")

    def test_sweeps(self):
        """Poles of each value are those of the value alone; with the loop closed they are the multipliers."""
        def sort(z):
            return sorted(z, key=lambda v: (round(v.real, 7), round(v.imag, 7)))
        for slow in (1, 3):
            self.write_twin(slow=slow)
            said = self.bough("linearize", "axis.toml", "--break", "law", "--sweep", "ks=2:20:5", "-o", "sweep.h5", "--csv", "sweep.csv")
            self.assertIn("gone within a sample", said.stdout)
            data = json.loads(self.bough("linearize", "axis.toml", "--break", "law", "--sweep", "ks=2:20:5", "--json").stdout)
            np.testing.assert_allclose(data["sample_time"], [slow * self.h] * 5)
            table = np.genfromtxt(self.path("sweep.csv"), delimiter=",", skip_header=1)
            with h5py.File(self.path("sweep.h5")) as f:
                T, real, imag = f["sample_time"][:].ravel(), f["poles/real"][:], f["poles/imag"][:]
                A, B, C, D = (f[key][:] for key in "ABCD")
            for k, value in enumerate(np.linspace(2, 20, 5)):
                alone = json.loads(self.bough("linearize", "axis.toml", "--break", "law", "--set", f"ks={value}", "--json").stdout)
                z = np.exp((np.array(alone["poles"]["real"]) + 1j * np.array(alone["poles"]["imag"])) * T[k])
                found = np.exp((real[k] + 1j * imag[k]) * T[k])
                np.testing.assert_allclose(sort(found), sort(z), atol=1e-9)
                np.testing.assert_allclose(table[k, 1::4], real[k])
                np.testing.assert_allclose(data["poles"]["imag"][k], imag[k])
                closed = np.linalg.eigvals(A[k] - B[k] @ np.linalg.solve(np.eye(len(D[k])) + D[k], C[k]))
                closed = closed[(np.abs(closed) > 1e-7) & (np.abs(closed - 1) > 1e-9)]
                np.testing.assert_allclose(sort(closed), sort(self.multipliers("--set", f"ks={value}")), atol=1e-9)
            self.bough("plot", "sweep.h5", "--kind", "locus", "-o", "locus.svg")
            with open(self.path("locus.svg")) as f:
                self.assertIn("real part of z", f.read())
            self.bough("plot", "sweep.h5", "--kind", "campbell", "-o", "campbell.svg")
            self.bough("report", "sweep.h5", "-o", "report.html")


if __name__ == "__main__":
    unittest.main()
