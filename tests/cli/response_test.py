"""response, linearize --break, --sweep, --each, plots of linear models and the tables of select, against scipy and
closed forms."""
import json
import math
import os
import shutil
import subprocess
import unittest

import h5py
import numpy as np
import scipy.integrate
import scipy.io
import scipy.linalg
import scipy.optimize
import scipy.signal

from linear_test import HUB, PENDULUM, LinearTest

AXIS = """[parameters]
kp = 8.0
kd = 1.6

[[body]]
name = "rotor"
mass = 1.0
cg = [0.0, 0.0, 0.0]
inertia = [1.0, 1.0, 2.0]

[[hinge]]
name = "axis"
type = "revolute"
child = "rotor"
axis = [0.0, 0.0, 1.0]

[[sensor]]
name = "angle"
type = "hinge_angle"
hinge = "axis"

[[sensor]]
name = "rate"
type = "hinge_rate"
hinge = "axis"

[[controller]]
name = "law"
type = "pid"
inputs = ["angle"]
rate = "rate"
kp = "$kp"
kd = "$kd"

[[actuator]]
name = "drive"
type = "hinge"
hinge = "axis"
input = "law"

[simulation]
duration = 2.0
output_step = 0.5
"""

TOP = """[parameters]
spin = 3.0

[[body]]
name = "top"
mass = 1.0
cg = [0.0, 0.0, 0.0]
inertia = [2.0, 2.0, 3.0]

[[hinge]]
name = "gimbal"
type = "universal"
child = "cage"
axis = [1.0, 0.0, 0.0]
stiffness = [5.0, 5.0]

[[body]]
name = "cage"
mass = 1e-6
inertia = [1e-9, 1e-9, 1e-9]

[[hinge]]
name = "wheel"
type = "revolute"
parent = "cage"
child = "top"
axis = [0.0, 0.0, 1.0]
rate = ["$spin"]

[simulation]
duration = 1.0
"""


class Response(LinearTest):
    def read(self, name):
        with h5py.File(self.path(name)) as f:
            return {key: f[key][()] for key in ["frequency_hz", "real", "imag", "singular_values"]}

    def test_of_a_flexible_hub_is_scipys(self):
        self.make_boom(6)
        self.write_hub("hub.toml", eta="damping = 0.01")
        model = self.linearize("hub.toml")
        self.bough("response", "model.h5", "-o", "r.h5", "--csv", "r.csv")
        self.bough("export", "r.h5", "--to", "csv", "-o", "again.csv")
        self.assertEqual(open(self.path("again.csv")).read(), open(self.path("r.csv")).read())
        r = self.read("r.h5")
        w = 2 * math.pi * r["frequency_hz"]
        H = r["real"] + 1j * r["imag"]
        A, B, C, D = (model[k] for k in "ABCD")
        eye = np.eye(len(A))
        for k in range(0, len(w), 17):
            exact = C @ np.linalg.solve(1j * w[k] * eye - A, B) + D
            self.assertLess(np.abs(H[k] - exact).max(), 1e-9 * max(np.abs(exact).max(), 1e-12))
            np.testing.assert_allclose(r["singular_values"][k], np.linalg.svd(exact, compute_uv=False), rtol=1e-8,
                                       atol=1e-12)
        # Every lightly damped pole that is seen has frequencies within its half-power width.
        for re, im in zip(model["poles/real"], model["poles/imag"]):
            if im > 0:
                self.assertLess(np.abs(w - im).min(), 0.6 * abs(re))
        table = np.genfromtxt(self.path("r.csv"), delimiter=",", skip_header=1)
        np.testing.assert_allclose(table[:, 0], r["frequency_hz"], rtol=1e-15)
        np.testing.assert_allclose(table[:, 1], r["real"][:, 0, 0], rtol=1e-15)
        self.assertIn("infinite", self.bough("response", "model.h5").stdout)  # the hub turns freely

    def test_margins_of_a_loop_and_its_closed_form(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--break", "drive", "-o", "loop.h5")
        data = json.loads(self.bough("response", "loop.h5", "--json").stdout)
        kp, kd, J = 8.0, 1.6, 2.0
        # |kp + kd s| = J w²
        w = math.sqrt((kd**2 + math.sqrt(kd**4 + 4 * J**2 * kp**2)) / (2 * J**2))
        phase = math.atan2(kd * w, kp)
        (crossing,) = data["margins"]["phase"]
        self.assertAlmostEqual(crossing["frequency_hz"], w / 2 / math.pi, places=10)
        self.assertAlmostEqual(crossing["degrees"], math.degrees(phase), places=8)
        self.assertAlmostEqual(crossing["delay"], phase / w, places=9)
        self.assertEqual(data["margins"]["gain"], [])
        self.assertTrue(data["margins"]["stable"])
        text = self.bough("response", "loop.h5").stdout
        self.assertIn("stable when closed", text)
        self.assertIn("deg", text)
        self.fails(1, "linearize", "axis.toml", "--break", "drove", says=["did you mean 'drive'"],
                   error="linear.unknown-signal")
        self.bough("linearize", "axis.toml", "-o", "closed.h5")
        self.fails(1, "response", "closed.h5", "--loop", error="linear.no-loop")
        self.fails(1, "response", "closed.h5", "--outputs", "angel", says=["'angle'"], error="linear.unknown-output")
        self.bough("linearize", "axis.toml", "--outputs", "rate", "-o", "one.h5")
        self.bough("response", "one.h5", "--loop", "--from", 0.01, "--to", 10)
        self.fails(1, "response", "one.h5", "--from", 1, "--to", 0.1, error="cli.bad-range")
        self.write("bob.toml", PENDULUM.replace("POSITION", "0.0").split("[[sensor]]")[0] + "[simulation]\nduration = 1.0\n")
        self.bough("linearize", "bob.toml", "-o", "bob.h5")
        self.fails(1, "response", "bob.h5", error="linear.no-channels")

    def test_a_crossing_far_from_poles_and_zeros_is_found(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--set", "kd=1600", "--break", "law", "-o", "loop.h5")
        data = json.loads(self.bough("response", "loop.h5", "--json").stdout)
        kp, kd, J = 8.0, 1600.0, 2.0
        w = math.sqrt((kd**2 + math.sqrt(kd**4 + 4 * J**2 * kp**2)) / (2 * J**2))
        (crossing,) = data["margins"]["phase"]
        self.assertAlmostEqual(crossing["frequency_hz"] / (w / 2 / math.pi), 1, places=10)
        self.bough("report", "loop.h5", "-o", "page.html")
        with open(self.path("page.html")) as f:
            text = f.read()
        self.assertIn("with the loop closed", text)
        self.assertIn("Singular values", text)

    def test_the_norm_is_the_peak(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--outputs", "angle", "-o", "closed.h5")
        data = json.loads(self.bough("response", "closed.h5", "--json").stdout)
        zeta = 1.6 / (2 * math.sqrt(8 * 2))
        # The integral of the law, with ki = 0, is a pole at 0 that no one sees.
        self.assertTrue(data["peak"]["finite"])
        self.assertAlmostEqual(data["peak"]["value"], 1 / 8 / (2 * zeta * math.sqrt(1 - zeta**2)), places=7)
        self.assertTrue(data["peak"]["certified"])

    def test_pictures(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "-o", "closed.h5")
        for kind in ["bode", "nichols", "sigma", "poles"]:
            self.bough("plot", "closed.h5", "--kind", kind, "-o", f"{kind}.svg")
            with open(self.path(f"{kind}.svg")) as f:
                text = f.read()
            self.assertIn("</svg>", text)
            self.assertNotIn("nan", text)
        with open(self.path("bode.svg")) as f:
            text = f.read()
        self.assertIn("angle / drive", text)
        self.assertEqual(text.count("<svg"), 3)  # magnitude above phase
        self.bough("plot", "closed.h5", "--kind", "bode", "--outputs", "rate")
        self.assertTrue(os.path.exists(self.path("closed-bode.svg")))
        self.fails(1, "plot", "closed.h5", "--kind", "campbell", error="cli.plot-kind")
        self.fails(1, "plot", "closed.h5", error="cli.nothing-to-plot")


class Sweep(LinearTest):
    def read(self, name="sweep.h5"):
        with h5py.File(self.path(name)) as f:
            return {key: f[key][()] for key in ["parameter/value", "poles/real", "poles/imag", "poles/frequency_hz",
                                                "poles/correlation", "A"]}

    def test_root_locus_over_a_gain(self):
        self.write("axis.toml", AXIS)
        self.bough("linearize", "axis.toml", "--sweep", "kd=0.5:12:23", "-o", "sweep.h5", "--csv", "locus.csv")
        s = self.read()
        for kd, real, imag in zip(s["parameter/value"], s["poles/real"], s["poles/imag"]):
            exact = np.roots([2, kd, 8])
            found = real + 1j * imag
            self.assertLess(np.abs(np.sort_complex(found) - np.sort_complex(exact)).max(), 1e-8)
        self.bough("plot", "sweep.h5", "--kind", "locus", "-o", "locus.svg")
        table = np.genfromtxt(self.path("locus.csv"), delimiter=",", skip_header=1)
        np.testing.assert_allclose(table[:, 0], s["parameter/value"])
        text = self.bough("export", "sweep.h5", "--to", "csv").stdout
        self.assertTrue(text.startswith("kd,"))
        log = json.loads(self.bough("linearize", "axis.toml", "--sweep", "kd=1:100:3:log", "--json").stdout)
        np.testing.assert_allclose(log["value"], [1, 10, 100])
        for bad in ["kd", "kd=1:2", "kd=1:2:1", "kd=0:2:3:log", "kd=a:2:3"]:
            self.fails(2, "linearize", "axis.toml", "--sweep", bad, error="cli.bad-sweep")
        self.fails(2, "linearize", "axis.toml", "--sweep", "kd=1:2:3", "--each", 2, error="cli.usage")

    def test_campbell_diagram_of_a_spinning_beam(self):
        # Wright, Smith, Thresher & Wang, J. Appl. Mech. 49 (1982) 197: first flap and chord, hub radius 0.
        self.make_boom(12)
        text = HUB.replace("INERTIA", "1.0").replace("MOTION", 'motion = "angle"').replace("ETA", "")
        self.write("spin.toml", "[parameters]\nrate = 1.0\n" + text.replace("RATE", '"$rate"'))
        self.bough("linearize", "spin.toml", "--sweep", "rate=0:6:7", "-o", "sweep.h5")
        s = self.read()
        omega = 2 * math.pi * s["poles/frequency_hz"]
        wright = {2: (4.13732, 3.62180), 6: (7.36037, 4.26323)}
        for rate, (flap, chord) in wright.items():
            row = omega[int(rate)]
            for exact in (flap, chord):
                self.assertLess(np.abs(row / exact - 1).min(), 1e-3)
        # Each column is one motion: flap rises by sqrt(chord² + rate²) all along, without a jump to another.
        k = np.argmin(np.abs(omega[6] - 7.36037))
        chord = np.argmin(np.abs(omega[6] - 4.26323))
        for rate in range(1, 7):
            self.assertAlmostEqual(omega[rate, k]**2, omega[rate, chord]**2 + rate**2, delta=2e-3 * omega[rate, k]**2)
        self.bough("plot", "sweep.h5", "--kind", "campbell", "-o", "campbell.svg")

    def test_nutation(self):
        # A wheel in a light gimbal on springs: J_t² q'' ± Ω J_a cross terms.
        self.write("top.toml", TOP)
        said = self.bough("linearize", "top.toml", "--sweep", "spin=0:10:21", "-o", "sweep.h5").stderr
        self.assertNotIn("sweep-jump", said)  # at rest the two are one: no motion is lost there
        s = self.read()
        Jt, Ja, k = 2.0, 3.0, 5.0
        for spin, freq in zip(s["parameter/value"], s["poles/frequency_hz"]):
            root = np.roots([Jt**2, 0, -(2 * Jt * k + (Ja * spin)**2), 0, k**2])
            exact = np.sort(np.unique(np.round(np.abs(root.real), 12)))
            found = np.sort(2 * math.pi * freq)
            found = found[found > 1e-3]
            for w in exact:
                self.assertLess(np.abs(found / w - 1).min(), 2e-5, spin)
        # Followed: one branch falls (precession), one rises (nutation) monotonously.
        f = s["poles/frequency_hz"]
        moving = [b for b in range(f.shape[1]) if f[0, b] > 1e-6]
        self.assertEqual(len(moving), 4)
        for b in moving:
            steps = np.diff(f[:, b])
            self.assertTrue((steps > 0).all() or (steps < 0).all())

    def test_what_a_sweep_cannot_follow(self):
        self.make_boom(4)
        self.write("count.toml", '[parameters]\nn = 2\n[[body]]\nname = "boom"\nfile = "boom.h5"\nmodes = "$n"\n'
                   '[[hinge]]\nname = "clamp"\ntype = "fixed"\nchild = "boom"\n[simulation]\nduration = 1.0\n')
        self.fails(3, "linearize", "count.toml", "--sweep", "n=2:4:3", error="linear.sweep-states")
        # Two rotors on springs, one spring as stiff as the other is soft: far apart values turn their motions around.
        self.write("two.toml", "\n".join(
            ['[parameters]\nk = 1.0'] +
            [f'[[body]]\nname = "{name}"\nmass = 1.0\ncg = [0.0, 0.0, 0.0]\ninertia = [1.0, 1.0, {inertia}]'
             for name, inertia in [("one", 1.0), ("two", 1.0)]] +
            ['[[hinge]]\nname = "root"\ntype = "revolute"\nchild = "one"\naxis = [0.0, 0.0, 1.0]\nstiffness = ["$k"]',
             '[[hinge]]\nname = "joint"\ntype = "revolute"\nparent = "one"\nchild = "two"\naxis = [0.0, 0.0, 1.0]\n'
             'stiffness = [1.0]\n[simulation]\nduration = 1.0\n']))
        result = self.bough("linearize", "two.toml", "--sweep", "k=0.001:1000:2")
        self.assertIn("[linear.sweep-jump]", result.stderr)
        result = self.bough("linearize", "two.toml", "--sweep", "k=0.1:10:40:log")
        self.assertNotIn("sweep-jump", result.stderr)

    def test_each_sample_of_a_run(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.9").replace("duration = 1.0",
                                                                             "duration = 1.0\noutput_step = 0.125"))
        self.bough("linearize", "pendulum.toml", "--each", 2, "--outputs", "angle", "-o", "sweep.h5")
        self.bough("run", "pendulum.toml", "-o", "run.h5")
        with h5py.File(self.path("run.h5")) as f:
            angle = np.ravel(f["/hinges/pin/q"][:])[::2]
            time = f["/time"][:][::2]
        s = self.read()
        np.testing.assert_allclose(s["parameter/value"], time, atol=1e-12)
        np.testing.assert_allclose(s["A"][:, 1, 0], -9.81 / 0.7 * np.cos(angle), rtol=1e-5)


class Zeros(LinearTest):
    def test_of_a_beam_from_its_root_to_its_tip(self):
        # Torque at the root, place of the tip: at a zero the tip stands still without force or moment on it, so that
        # sinh b + sin b = 0 over the length: b = c (1 + i), tan c = -tanh c, s = +-2 c² (L = EI = rho A = 1). Real:
        # the tip starts the wrong way. The inertia of the hub has no part in it.
        self.make_boom(20)
        c = scipy.optimize.brentq(lambda c: math.tan(c) + math.tanh(c), math.pi / 2 + 1e-6, math.pi)
        for inertia in (0.1, 10.0):
            name = self.write_hub("hub.toml", inertia=inertia)
            with open(self.path(name), "a") as f:
                f.write('[[sensor]]\nname = "place"\ntype = "position"\nbody = "boom"\nnode = 41\n')
            model = self.linearize("hub.toml", "--outputs", "place:y")
            zeros = model["zeros/real"] + 1j * model["zeros/imag"]
            for exact in (2 * c * c, -2 * c * c):
                self.assertLess(np.abs(zeros / exact - 1).min(), 5e-3, zeros)
            # Torque to angle, at one place: zeros and poles take turns on the imaginary axis.
            model = self.linearize("hub.toml", "--outputs", "angle")
            both = sorted([(w, 1) for w in model["zeros/imag"] if w > 1e-6] +
                          [(w, -1) for w in model["poles/imag"] if w > 1e-6])
            seen, last = [], 0
            for w, sign in both:  # flap, which the torque does not reach, has a pole on a zero
                seen = seen[:-1] + [seen[-1] + sign] if seen and w < last * (1 + 1e-6) else seen + [sign]
                last = w
            seen = ["zero" if sign > 0 else "pole" for sign in seen if sign != 0]
            self.assertEqual(seen, ["zero", "pole"] * (len(seen) // 2))
            self.assertGreaterEqual(len(seen), 8)


class Tables(LinearTest):
    def test_csv_and_operating_point(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        model = self.linearize("pendulum.toml", "--outputs", "angle", "--csv", "model.csv")
        with open(self.path("model.csv")) as f:
            rows = [line.strip().split(",") for line in f]
        self.assertEqual(rows[0], ["row", "pin:1", "pin:1_dot", "push"])
        self.assertEqual([row[0] for row in rows[1:]], ["d/dt pin:1", "d/dt pin:1_dot", "angle"])
        found = np.array([[float(v) for v in row[1:]] for row in rows[1:]])
        np.testing.assert_array_equal(found, np.block([[model["A"], model["B"]], [model["C"], model["D"]]]))
        self.assertEqual(self.bough("export", "model.h5", "--to", "csv").stdout.split("\n")[0], "row,pin:1,pin:1_dot,push")
        self.assertEqual(model["operating_point/positions/name"], ["pin:1"])
        self.assertEqual([w.decode() for w in model["operating_point/periodic"]], ["pin:1"])
        self.assertEqual([w.decode() for w in model["poles/hinge"]], ["pin:1", "pin:1"])
        text = self.bough("linearize", "pendulum.toml").stdout
        self.assertIn("periodic", text)
        self.assertIn("Hankel singular values", text)

    def test_hankel_values_are_scipys(self):
        self.make_boom(5)
        self.write_hub("hub.toml", eta="damping = 0.01", motion="stiffness = [3.0]\ndamping = [0.1]")
        model = self.linearize("hub.toml")
        A, B, C = model["A"], model["B"], model["C"]
        P = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        Q = scipy.linalg.solve_continuous_lyapunov(A.T, -C.T @ C)
        np.testing.assert_allclose(model["hankel/controllability"], P, atol=1e-9 * np.abs(P).max())
        np.testing.assert_allclose(model["hankel/observability"], Q, atol=1e-9 * np.abs(Q).max())

    def test_body_mode_and_hinge_of_a_pole(self):
        self.make_boom(6)
        self.write_hub("hub.toml")
        model = self.linearize("hub.toml")
        for mode, hinge, frequency in zip(model["poles/body_mode"], model["poles/hinge"], model["poles/frequency_hz"]):
            if frequency > 0:
                self.assertTrue(mode.startswith("boom:eta"))
            if frequency == 0:
                self.assertEqual(hinge.decode(), "spin:1")

    @unittest.skipUnless(shutil.which("octave"), "Octave is not installed")
    def test_mat_in_octave(self):
        self.write("pendulum.toml", PENDULUM.replace("POSITION", "0.0"))
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "--mat", "m.mat")
        self.write("t.m", "load m.mat; assert(size(A), [2 2]); assert(strcmp(state_name{1}, 'pin:1'));\n")
        subprocess.run(["octave", "--no-gui", "--quiet", "t.m"], cwd=self.folder, check=True)
        # Its control package, where it is installed: poles and response of a continuous and of a sampled model.
        self.write("axis.toml", AXIS.replace('kd = "$kd"\n', 'kd = "$kd"\nsample_time = 0.1\ndelay = 0.04\n'))
        self.bough("linearize", "axis.toml", "--break", "drive", "-o", "loop.h5", "--mat", "loop.mat")
        self.bough("linearize", "pendulum.toml", "--outputs", "angle", "-o", "m.h5")
        self.write("c.m", "if isempty(pkg('list', 'control')), fclose(fopen('absent', 'w')); exit, end\npkg load control\n"
                          "function w = read(name), w = dlmread(name, ',', 1, 0); end\n"
                          "load m.mat; s = ss(A, B, C, D); r = read('m.csv');\n"
                          "H = squeeze(freqresp(s, 2 * pi * r(:, 1)))(:);\n"
                          "assert(H, r(:, 2) + 1i * r(:, 3), 1e-9 * max(abs(H)));\n"
                          "p = read('poles.csv'); assert(cplxpair(pole(s)), cplxpair(p(:, 1) + 1i * p(:, 2)), 1e-9);\n"
                          "load loop.mat; s = ss(A, B, C, D, sample_time); r = read('loop.csv');\n"
                          "H = squeeze(freqresp(s, 2 * pi * r(:, 1)))(:);\n"
                          "assert(H, r(:, 2) + 1i * r(:, 3), 1e-6 * abs(H));\n"
                          "fclose(fopen('done', 'w'));\n")
        for name in ("m", "loop"):
            self.bough("response", name + ".h5", "--csv", name + ".csv")
        with h5py.File(self.path("m.h5")) as f:
            np.savetxt(self.path("poles.csv"), np.column_stack([np.ravel(f["poles/" + k]) for k in ("real", "imag")]),
                       delimiter=",", header="real,imag", fmt="%.17g")
        subprocess.run(["octave", "--no-gui", "--quiet", "c.m"], cwd=self.folder, check=True)
        if os.path.exists(self.path("absent")):
            self.skipTest("the control package of Octave is not installed")
        self.assertTrue(os.path.exists(self.path("done")))


class SampledLoop(LinearTest):
    """L(z) of a double integrator under a sampled law, z = exp(iωT): zero-order hold by scipy, delays by hand."""
    T, J, kp, kd = 0.1, 2.0, 8.0, 4.0

    def write_axis(self, delay=0.0, more="", **numbers):
        law = f'kd = "$kd"\nsample_time = {self.T}\n' + (f"delay = {delay}\n" if delay else "") + more
        text = AXIS.replace('kd = "$kd"\n', law).replace("kp = 8.0", f"kp = {numbers.get('kp', self.kp)!r}")
        self.write("axis.toml", text.replace("kd = 1.6", f"kd = {numbers.get('kd', self.kd)!r}"))

    def calc(self, delay, omega):
        """What is added from t_m = m T + (delay mod T) on comes back with the sample of the instant before t_m."""
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
            self.write("axis.toml", '[[body]]\nname = "arm"\nmass = 1.0\ninertia = [1.0, 0.7, 1.0]\n[[hinge]]\nname = "pivot"\n'
                       'type = "revolute"\nchild = "arm"\naxis = [0.0, 1.0, 0.0]\ndamping = 0.3\nstiffness = 1.0\n'
                       '[[sensor]]\nname = "angle"\ntype = "hinge_angle"\nhinge = "pivot"\n[[controller]]\nname = "law"\n'
                       'type = "pid"\ninputs = ["angle"]\nkp = 40.0\nki = 15.0\nkd = 6.0\nfilter = 0.01\n[[actuator]]\n'
                       f'name = "motor"\ntype = "hinge"\nhinge = "pivot"\ninput = "law"\nlag = {lag}\n[simulation]\nduration = 1.0\n')
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
        text = text.replace('hinge = "axis"\n\n[[sensor]]',
                            'hinge = "axis"\nsample_time = 0.05\n\n[[sensor]]', 1)
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


class SelectMore(LinearTest):
    def body(self, name="boom.h5"):
        with h5py.File(self.path(name)) as f:
            ids = list(f["/nodes/id"][:])
            return (*(f["/modal/" + key][:] for key in ["mass", "damping", "stiffness"]), f["/modes/phi"][:], ids)

    def plant(self, rows_in, rows_out, rates=False):
        M, D, K, _, _ = self.body()
        n = len(M)
        D = np.where((np.diag(D) == 0) & np.eye(n, dtype=bool), 2 * 0.01 * np.sqrt(np.diag(K * M)), D)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        B = np.vstack([np.zeros((n, len(rows_in))), np.linalg.solve(M, rows_in.T)])
        zero = np.zeros_like(rows_out)
        return A, B, np.hstack([zero, rows_out] if rates else [rows_out, zero])

    def costs(self, A, B, C):
        X = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        parts = np.diag(X @ C.T @ C)
        return parts[:len(A) // 2] + parts[len(A) // 2:]

    def test_rates_weights_and_pinned_modes(self):
        self.make_boom(8)
        _, _, _, phi, ids = self.body()
        tip = phi[ids.index(41)]
        data = json.loads(self.bough("select", "boom.h5", "--json", "--outputs", "41:vy,41:z", "--inputs", "41:y,41:z",
                                     "--weight", "41:z=3", "--keep", "8", "--number", 3).stdout)
        # The weight counts for the input 41:z and for the output.
        rows_in = np.vstack([tip[1], 3 * tip[2]])
        A, B, C = self.plant(rows_in, tip[2:3] * 3)
        C = np.vstack([self.plant(rows_in, tip[1:2], rates=True)[2], C])
        expected = self.costs(A, B, C)
        cost = np.array([mode["cost"] for mode in data["modes"]])
        np.testing.assert_allclose(cost, expected, atol=1e-10 * expected.sum())
        self.assertAlmostEqual(cost.sum() / data["total_cost"], 1, places=12)
        self.assertEqual(data["modes"][7]["reason"], "pinned")
        self.assertEqual(sum(mode["kept"] for mode in data["modes"]), 3)
        for mode in data["modes"]:
            self.assertLess(abs(mode["closed_form"] - mode["cost"]), 0.02 * abs(mode["cost"]) + 1e-4 * data["total_cost"])
        self.fails(1, "select", "boom.h5", "--keep", "9", error="select.unknown-mode")
        self.fails(1, "select", "boom.h5", "--weight", "41:z", error="select.bad-weight")
        self.fails(1, "select", "boom.h5", "--weight", "nothing=2", error="select.bad-weight")

    def test_what_it_costs(self):
        self.make_boom(8)
        data = json.loads(self.bough("select", "boom.h5", "--json", "--outputs", "41:y", "--inputs", "41:y",
                                     "--number", 2, "--response", "loss.csv").stdout)
        _, _, _, phi, ids = self.body()
        row = phi[ids.index(41)][1:2]
        A, B, C = self.plant(row, row)
        kept = [i for i, mode in enumerate(data["modes"]) if mode["kept"]]
        n = len(A) // 2
        both = kept + [n + i for i in kept]
        a, b, c = A[np.ix_(both, both)], B[both], C[:, both]
        def gain(w):
            full = C @ np.linalg.solve(1j * w * np.eye(len(A)) - A, B)
            return abs((full - c @ np.linalg.solve(1j * w * np.eye(len(a)) - a, b))[0, 0]), abs(full[0, 0])
        (loss,) = data["configurations"]
        poles = np.linalg.eigvals(A)
        grid = np.concatenate([abs(p.imag) + abs(p.real) * np.linspace(-2, 2, 401) for p in poles])
        peak = max(gain(w)[0] for w in grid)
        self.assertAlmostEqual(loss["peak_error"] / peak, 1, delta=1e-4)
        self.assertAlmostEqual(loss["peak_gain"] / max(gain(w)[1] for w in grid), 1, delta=1e-4)
        self.assertAlmostEqual(loss["steady_error"], gain(1e-3 * np.abs(poles).min())[0] /
                               gain(1e-3 * np.abs(poles).min())[1], delta=1e-6)
        P = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        Q = scipy.linalg.solve_continuous_lyapunov(A.T, -C.T @ C)
        values = np.sort(np.sqrt(np.abs(np.linalg.eigvals(P @ Q))))[::-1]
        self.assertAlmostEqual(loss["balanced_bound"] / (2 * values[len(both):].sum()), 1, delta=1e-3)
        table = np.genfromtxt(self.path("loss.csv"), delimiter=",", names=True)
        for k in range(0, len(table), 50):
            error, full = gain(2 * math.pi * table["frequency_hz"][k])
            self.assertAlmostEqual(table["before"][k] / full, 1, places=6)
            self.assertAlmostEqual(table["difference"][k], error, delta=1e-6 * full)
        self.bough("select", "boom.h5", "--number", 4, "--response", "loss.svg", "--stiffening", 7)
        with open(self.path("loss.svg")) as f:
            self.assertIn("</svg>", f.read())

    def test_spectra(self):
        self.make_boom(4)
        arguments = ["select", "boom.h5", "--json", "--outputs", "41:y", "--inputs", "41:y"]
        white = json.loads(self.bough(*arguments).stdout)
        self.write("white.csv", "frequency_hz,density\n0,2\n1e5,2\n")
        same = json.loads(self.bough(*arguments, "--spectrum", "white.csv").stdout)
        for a, b in zip(white["modes"], same["modes"]):
            self.assertAlmostEqual(a["cost"], b["cost"], delta=1e-6 * white["total_cost"])
        # A band about the second bending pair only: by quadrature of |G|².
        _, _, _, phi, ids = self.body()
        row = phi[ids.index(41)][1:2]
        A, B, C = self.plant(row, row)
        self.write("band.csv", "frequency_hz,41:y\n3,0\n3.2,5\n4,1\n")
        data = json.loads(self.bough(*arguments, "--spectrum", "band.csv").stdout)
        poles = np.sort(np.abs(np.linalg.eigvals(A).imag)) / 2 / math.pi
        def density(f):
            return np.interp(f, [3, 3.2, 4], [0, 5, 1])
        def square(f):
            return density(f) * abs((C @ np.linalg.solve(2j * math.pi * f * np.eye(len(A)) - A, B))[0, 0])**2
        points = sorted({3.2, *(p for p in poles if 3 < p < 4)})
        exact = scipy.integrate.quad(square, 3, 4, points=points, limit=400, epsabs=0, epsrel=1e-10)[0]
        self.assertAlmostEqual(data["total_cost"] / exact, 1, delta=1e-7)
        for text in ["frequency_hz,41:q\n1,2\n2,3\n", "1,2\n1,2\n", "1,2\n", "1,a\n2,3\n", "1,-2\n2,3\n"]:
            self.write("bad.csv", text)
            result = self.bough(*arguments, "--spectrum", "bad.csv", code=0 if "41:q" in text else 1)
            if "41:q" not in text:
                self.assertIn("[select.bad-spectrum]", result.stderr)

    def test_what_is_no_model_of_the_body_is_told(self):
        self.make_boom(8)
        said = self.bough("select", "boom.h5", "--number", "1", "--keep", "7,8").stderr
        self.assertIn("[select.always-kept]", said)
        self.assertIn("[select.most-is-lost]", said)
        said = self.bough("select", "boom.h5", "--number", "4").stderr
        self.assertNotIn("[select.", said)

    def test_modes_of_one_frequency_go_together(self):
        # Outputs and inputs at 45 degrees to the two planes of bending: how the pair is turned does not matter.
        self.make_boom(8)
        with h5py.File(self.path("boom.h5"), "r+") as f:
            phi, angle = f["/modes/phi"][:], 0.4
            turn = np.eye(8)
            for i in range(0, 8, 2):
                self.assertAlmostEqual(f["/modes/frequency_hz"][i + 1] / f["/modes/frequency_hz"][i], 1, places=6)
                turn[i:i + 2, i:i + 2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
            f["/modes/phi"][...] = phi @ turn
        data = json.loads(self.bough("select", "boom.h5", "--json", "--outputs", "41:y", "--inputs", "41:y",
                                     "--tolerance", 0.02).stdout)
        kept = [mode["kept"] for mode in data["modes"]]
        self.assertEqual(kept[0::2], kept[1::2])
        self.assertIn(False, kept)
        self.assertLessEqual(data["lost_share"], 0.02)

    def test_closed_loop_and_several_configurations(self):
        self.make_boom(8)
        hub = HUB.replace("INERTIA", "1.0").replace("MOTION", "").replace("RATE", "0.0").replace("ETA", "damping = 0.01")
        law = ('[[sensor]]\nname = "speed"\ntype = "hinge_rate"\nhinge = "spin"\n'
               '[[controller]]\nname = "law"\ntype = "pid"\ninputs = ["/sensors/angle"]\nrate = "speed"\nkp = KP\nkd = KD\n'
               '[[actuator]]\nname = "motor"\ntype = "hinge"\nhinge = "spin"\ninput = "law"\n')
        for name, kp, kd in [("soft.toml", 0.5, 1.0), ("stiff.toml", 200.0, 25.0)]:
            self.write(name, hub + law.replace("KP", str(kp)).replace("KD", str(kd)))
        one = {}
        for name in ["soft.toml", "stiff.toml"]:
            one[name] = json.loads(self.bough("select", "boom.h5", name, "--json", "--outputs", "angle,tip:y").stdout)
            model = self.linearize(name, "--outputs", "angle,tip:y")
            A, B, C = model["A"], model["B"], model["C"]
            keep = [i for i, s in enumerate(model["states/name"]) if "controller" not in s]  # its integral: ki = 0
            A, B, C = A[np.ix_(keep, keep)], B[keep], C[:, keep]
            X = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
            parts = np.diag(X @ C.T @ C)
            names = [model["states/name"][i] for i in keep]
            for mode in one[name]["modes"]:
                own = sum(p for p, s in zip(parts, names) if s.split("_dot")[0] == f"boom:eta{mode['mode']}")
                self.assertAlmostEqual(mode["cost"], own, delta=1e-8 * parts.sum())
            self.assertAlmostEqual(one[name]["total_cost"] / parts.sum(), 1, places=8)
        both = json.loads(self.bough("select", "boom.h5", "soft.toml", "stiff.toml", "--json", "--outputs", "angle,tip:y",
                                     "--tolerance", 0.01).stdout)
        self.assertEqual([c["name"] for c in both["configurations"]], ["soft.toml", "stiff.toml"])
        for k, mode in enumerate(both["modes"]):
            shares = [one[name]["modes"][k]["share"] for name in one]
            self.assertAlmostEqual(abs(mode["share"]), max(map(abs, shares)), places=9)
        for loss in both["configurations"]:
            self.assertLessEqual(loss["lost_share"], 0.01)
        # Without the law the hub turns freely: nothing of it decays, and the tip is weighed without it.
        free = json.loads(self.bough("select", "boom.h5", "soft.toml", "--open", "--json", "--outputs", "tip:y").stdout)
        self.assertNotAlmostEqual(free["total_cost"] / one["soft.toml"]["total_cost"], 1, places=3)


if __name__ == "__main__":
    unittest.main()
