"""Flight and wheels: published cases of spacecraft, tops, slosh and rolling, each against a closed form or printed digits."""
import math
import os
import sys

import h5py
import numpy as np
import scipy.integrate
import scipy.linalg
from scipy.optimize import brentq

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../tests/support"))
from spacecraft import write_panels
from toml_text import section, table, toml

ACCURATE = dict(integrator="rk", relative_tolerance=1e-11, absolute_tolerance=1e-12)


def write(folder, name, text):
    with open(os.path.join(folder, name), "w") as f:
        f.write(text)
    return name


class Bench:
    def __init__(self, bough, folder, add):
        self.bough, self.folder, self.add = bough, folder, add

    def read(self, name, *paths):
        with h5py.File(os.path.join(self.folder, name)) as f:
            return [f[path][()] for path in paths]

    def linearize(self, text, *options):
        self.bough(self.folder, "linearize", write(self.folder, "case.toml", text), "-o", "case.h5", *options)
        real, imag = self.read("case.h5", "poles/real", "poles/imag")
        return (real + 1j * imag).ravel()

    def run(self, text, *paths):
        self.bough(self.folder, "run", write(self.folder, "case.toml", text), "-o", "case.h5")
        return self.read("case.h5", *paths)

    def nearest(self, poles, exact):
        return poles[np.argmin(abs(poles - exact))]


def verify_satellites(b):
    # Cylinder of the NESC check cases in an orbit turned into the parent's frame; long axis along the vertical.
    mu, radius = 3.986004418e14, 6.878e6
    rate = math.sqrt(mu / radius**3)
    poles = b.linearize(toml(
        table("body", "lvlh", mass=1.0, inertia=[1.0, 1.0, 1.0]),
        table("body", "cylinder", mass=1000.0, inertia=[500.0, 12250.0, 12250.0]),
        table("function", "orbit", "ramp", value=1e4 * rate, **{"from": 0.0, "to": 1e4}),
        table("hinge", "turn", "revolute", child="lvlh", motion="orbit"),
        table("hinge", "flight", "free", parent="lvlh", child="cylinder", position=[1.0, 0.0, 0.0, 0.0, radius, 0.0, 0.0]),
        table("force", "earth", "gravity_central", mu=mu, bodies="cylinder"),
        section("simulation", duration=1000.0, start=10.0)))
    for what, exact in (("in the plane", math.sqrt(3 * 11750 / 12250)), ("across", math.sqrt((4 * 11750 + 500) / 12250))):
        b.add("NESC cylinder in orbit", f"libration {what} / orbital rate", b.nearest(poles, 1j * exact * rate).imag / rate,
              exact, 1e-6, "gravity gradient; NASA/TM-2015-218675")

    spin, axial, lateral = 20.0, 2.0, 50.0
    poles = b.linearize(toml(
        table("body", "platform", mass=100.0, inertia=[40.0, 40.0, 30.0]),
        table("body", "rotor", mass=10.0, inertia=[10.0, 10.0, axial]),
        table("hinge", "flight", "free", child="platform"),
        table("hinge", "bearing", "revolute", parent="platform", child="rotor", axis=[0.0, 0.0, 1.0], rate=[spin]),
        section("simulation", duration=1.0)))
    b.add("dual spin, despun platform", "nutation [rad/s]", poles.imag.max(), axial * spin / lateral, 1e-9,
          "Hughes 1986, ch. 6: h / I")

    m, arm, k, c, rate = 2.0, 0.7, 30.0, 1.5, 3.0
    for about, lateral, axial in (("major", 8.0, 12.0), ("minor", 12.0, 8.0)):
        poles = b.linearize(toml(
            table("body", "disk", mass=50.0, inertia=[lateral, lateral, axial]), table("body", "damper", mass=m),
            table("hinge", "pivot", "spherical", child="disk", rate=[0.0, 0.0, rate]),
            table("hinge", "slide", "prismatic", parent="disk", child="damper", parent_position=[arm, 0.0, 0.0],
                  axis=[0.0, 0.0, 1.0], stiffness=[k], damping=[c]),
            section("simulation", duration=1.0)))
        Ix, Iy, H = lateral, lateral + m * arm**2, (axial + m * arm**2) * rate
        M = np.array([[Ix, 0, 0, 0], [0, Iy, 0, -m * arm], [0, 0, 1, 0], [0, -m * arm, 0, m]])
        F = np.array([[0, -H + rate * Iy, 0, 0], [H - rate * Ix, 0, m * arm * rate**2, 0], [0, 0, 0, 1],
                      [-m * arm * rate, 0, -k, -c]])
        exact = max(np.linalg.eigvals(np.linalg.solve(M, F)), key=lambda pole: (pole.real, pole.imag))
        b.add(f"spinning satellite with a damper, {about} axis", "largest real part [1/s]", b.nearest(poles, exact).real,
              exact.real, 1e-6, "linear equations; Likins 1966")

    # Modified Rodrigues parameters after 2.5 s, printed to 16 digits.
    q, = b.run(toml(
        write_panels(),
        section("simulation", duration=2.5, output_step=0.5, **ACCURATE)), "bodies/hub/quaternion")
    for i, exact in enumerate((0.06170318243240492, -0.07089090074412899, 0.06409500412692531)):
        b.add("hub with two panels, 2.5 s", f"Rodrigues parameter {i + 1}", q[-1, i + 1] / (1 + q[-1, 0]), exact, 1e-8,
              "Basilisk, test_hingedRigidBodyStateEffector.py")


def reduce_beam(b, name, length, held, properties):
    """Body NAME of a beam of 40 CBARs along x, fixed at grid 1, of eight modes. held: components that 2 to 41 lack."""
    deck = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "SPC1,1,123456,1", f"SPC1,1,{held},2,THRU,41",
            *properties, *(f"GRID,{i + 1},,{i * length / 40!r},0.,0." for i in range(41)),
            *(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0." for i in range(40)), "ENDDATA", ""]
    write(b.folder, name + ".bdf", "\n".join(deck))
    write(b.folder, name + ".toml", toml(section("body", name=name, deck=name + ".bdf", frame="fixed", interface=[1]),
                                         section("body.modes", number=8), section("body.output", file=name + ".h5")))
    b.bough(b.folder, "reduce", name + ".toml")


def verify_wings(b):
    """Hub and two clamped wings: modes constrained (hub fixed) and unconstrained (hub turns), Hughes 1980."""
    length, density, bending, inertia = 4.0, 1.5, 60.0, 5.0
    reduce_beam(b, "wing", length, 1345, [f"MAT1,1,1.,1.,,{density!r}", f"PBAR,1,1,1.,{bending!r},{bending!r},1."])

    def system(**hub):
        return toml(table("body", "hub", mass=1.0, inertia=[inertia] * 3), table("body", "a", file="wing.h5"),
                    table("body", "b", file="wing.h5"),
                    table("hinge", "axis", "revolute", child="hub", axis=[0.0, 0.0, 1.0], **hub),
                    table("hinge", "root_a", "fixed", parent="hub", child="a", child_node=1),
                    table("hinge", "root_b", "fixed", parent="hub", child="b", child_node=1,
                          parent_rotation=[0.0, 0.0, math.pi]), section("simulation", duration=1.0))

    cosh, cos, sinh, sin = math.cosh, math.cos, math.sinh, math.sin
    unit = math.sqrt(bending / density) / length**2
    constrained = [brentq(lambda x: cos(x) * cosh(x) + 1, low, low + 1.5) for low in (1.2, 4.0, 7.2)]
    # Moment of both roots turns the hub: 2 EI w''(0) = -J ω² w'(0), free tip.
    ratio = inertia / (2 * density * length**3)

    def determinant(x):
        # w = A (cos - cosh) + B sin + C sinh, w' (0) = (B + C) x / L, w''(0) = -2 A x² / L²
        rows = [[2, ratio * x**3 * -1, ratio * x**3 * -1], [-cos(x) - cosh(x), -sin(x), sinh(x)],
                [sin(x) - sinh(x), -cos(x), cosh(x)]]
        return np.linalg.det(rows) / cosh(x)

    grid = np.linspace(0.5, 9.5, 400)
    free = [brentq(determinant, p, q) for p, q in zip(grid, grid[1:]) if determinant(p) * determinant(q) < 0]
    for what, hub, exact in (("constrained", {"locked": True}, constrained), ("unconstrained", {}, free)):
        omega = np.sort(b.linearize(system(**hub)).imag)
        for k in range(3):
            value = omega[np.argmin(abs(omega - exact[k]**2 * unit))]
            b.add("hub with two wings", f"{what} mode {k + 1} [rad/s]", value, exact[k]**2 * unit, 2e-5,
                  "clamped beams on a hub; Hughes 1980")


def verify_classics(b):
    # Heavy top of Exudyn's heavyTop.py.
    q, = b.run(toml(
        table("body", "top", mass=15.0, cg=[0.0, 1.0, 0.0], inertia=[0.234375, 0.46875, 0.234375]),
        table("hinge", "tip", "spherical", child="top", rate=[0.0, 150.0, -4.61538]),
        section("simulation", duration=0.2, output_step=0.1, gravity=[0.0, 0.0, -9.81], **ACCURATE)), "bodies/top/quaternion")
    for i, exact in enumerate((-0.70827915, 0.43878109, 0.5457284, 0.08939975)):
        b.add("heavy top, 0.2 s", f"Euler parameter {i}", q[-1, i], exact, 1e-6, "Exudyn heavyTop.py (5 digits), by scipy")
    # Share of the pendulum by the frequency of the tank free to slide, ω² (M + m) / (M + m - m1); length at 2 g.
    for height, exact, share, length in ((2.0, 4.247253, 0.226967, 0.543817), (0.5, 3.621633, 0.660108, 0.747929)):
        stage, liquid, case = 100.0, 1000 * math.pi * height, f"slosh, upright cylinder, h/R {height:g}"

        def find_frequency(hinge, g):
            return b.linearize(toml(
                table("body", "stage", mass=stage, inertia=[10.0, 10.0, 10.0]),
                table("tank", "tank", "cylinder", body="stage", mass=liquid, radius=1.0, height=2.5, density=1000.0, slosh=True),
                table("hinge", "stand", child="stage", **hinge),
                section("simulation", duration=1.0, gravity=[0.0, 0.0, -g]))).imag.max()

        clamped = find_frequency({"type": "fixed"}, 9.81)
        sliding = find_frequency({"type": "prismatic", "axis": [1.0, 0.0, 0.0]}, 9.81)
        b.add(case, "first mode [rad/s]", clamped, exact, 1e-6, "NASA SP-106")
        b.add(case, "sloshing share of the mass", (stage + liquid) / liquid * (1 - (clamped / sliding)**2), share, 2e-6,
              "NASA SP-106")
        b.add(case, "pendulum [m]", 2 * 9.81 / find_frequency({"type": "fixed"}, 2 * 9.81)**2, length, 2e-6, "NASA SP-106")
    # Furuta pendulum of Cazzolato & Prime with a rigid arm: gains by Riccati's equation of both models.
    J, m, L, l, J2, g, b1, b2 = 0.02, 0.1, 0.3, 0.2, 1.5e-3, 9.81, 2e-3, 1e-3
    b.linearize(toml(
        table("body", "arm", mass=0.5, cg=[0.1, 0.0, 0.0], inertia=[1e-3, J - 0.5 * 0.01, J - 0.5 * 0.01]),
        table("body", "rod", mass=m, cg=[0.0, 0.0, -l], inertia=[J2, J2, 0.0]),
        table("hinge", "base", "revolute", child="arm", axis=[0.0, 0.0, 1.0], damping=[b1]),
        table("hinge", "joint", "revolute", parent="arm", child="rod", parent_position=[L, 0.0, 0.0], axis=[1.0, 0.0, 0.0],
              position=[math.pi], damping=[b2]),
        section("simulation", duration=1.0, gravity=[0.0, 0.0, -g])), "--inputs", "base:1")
    A, B = b.read("case.h5", "A", "B")
    inverse = np.linalg.inv([[J + m * L * L, -m * L * l], [-m * L * l, J2 + m * l * l]])
    exact_A = np.zeros((4, 4))
    exact_A[:2, 2:] = np.eye(2)
    exact_A[2:, :2] = inverse @ [[0, 0], [0, g * m * l]]
    exact_A[2:, 2:] = -inverse @ np.diag([b1, b2])
    exact_B = np.vstack([np.zeros((2, 1)), inverse[:, :1]])

    def calc_gain(A, B):
        return (B.T @ scipy.linalg.solve_continuous_are(A, B, np.diag([1.0, 1.0, 0.1, 0.1]), [[10.0]]) / 10).ravel()

    for i, (value, exact) in enumerate(zip(calc_gain(A, B), calc_gain(exact_A, exact_B))):
        b.add("Furuta pendulum upright", f"LQR gain {i + 1}", value, exact, 1e-7, "Cazzolato & Prime 2011")


def verify_exposures(b):
    """Share of the variance of a sine about the mean of an exposure."""
    b.linearize(toml(
        table("body", "mirror", mass=1.0), table("hinge", "slide", "prismatic", child="mirror", axis=[1.0, 0.0, 0.0],
                                                 stiffness=[400.0], damping=[2.0]),
        table("sensor", "sight", "position", body="mirror"), section("simulation", duration=1.0)), "--inputs", "slide:1",
        "--outputs", "sight:x")
    windows = {0.1: 0.032469, 0.25: 0.189431, 0.5: 0.594715, 1.0: 1.0, 1.5: 0.954968}
    write(b.folder, "jitter.toml", toml(
        f"exposure = {list(windows)}\n",
        '[[source]]\nname = "tone"\ntype = "tones"\nfrequency_hz = 1.0\n'
        'harmonic = [{number = 1, input = "slide:1", amplitude = 1.0}]\n'))
    b.bough(b.folder, "response", "case.h5", "--budget", "jitter.toml", "-o", "budget.h5")
    with h5py.File(os.path.join(b.folder, "budget.h5")) as f:
        kinds, times, rms = list(f["/tables/weighting"].asstr()), f["/tables/exposure"][:], f["/tables/total"][:, 0]
    whole = rms[kinds.index("total")]
    for k, kind in enumerate(kinds):
        if kind == "jitter":
            exact = windows[round(float(times[k]), 6)]
            b.add("jitter of a sine in a window T", f"share of the variance, fT = {times[k]:g}", (rms[k] / whole)**2, exact, 2e-5,
                  "Lucke, Sirlin & San Martin 1992")


def make_bicycle(speed):
    """Meijaard et al. 2007: x forwards, y to the right, z down."""
    tilt = math.pi / 10
    return toml(
        table("body", "frame", mass=85.0, cg=[0.3, 0.0, -0.9], inertia=[9.2, 11.0, 2.8, 0.0, 2.4, 0.0]),
        table("body", "rear", mass=2.0, inertia=[0.0603, 0.12, 0.0603]),
        table("body", "fork", mass=4.0, cg=[0.9, 0.0, -0.7], inertia=[0.05892, 0.06, 0.00708, 0.0, -0.00756, 0.0]),
        table("body", "front", mass=3.0, inertia=[0.1405, 0.28, 0.1405]),
        table("hinge", "base", "general", child="frame", rotations="zxy", translations="xyz",
              rate=[0.0, 0.0, 0.0, speed, 0.0, 0.0]),
        table("hinge", "rear_axle", "revolute", parent="frame", child="rear", parent_position=[0.0, 0.0, -0.3],
              axis=[0.0, 1.0, 0.0]),
        table("hinge", "steer", "revolute", parent="frame", child="fork", parent_position=[1.1, 0.0, 0.0],
              child_position=[1.1, 0.0, 0.0], axis=[math.sin(tilt), 0.0, math.cos(tilt)]),
        table("hinge", "front_axle", "revolute", parent="fork", child="front", parent_position=[1.02, 0.0, -0.35],
              axis=[0.0, 1.0, 0.0]),
        *(table("constraint", name + "_contact", "rolling", child=name, axis=[0.0, 0.0, -1.0], axis2=[0.0, 1.0, 0.0],
                radius=radius) for name, radius in (("rear", 0.3), ("front", 0.35))),
        section("simulation", duration=1.0, gravity=[0.0, 0.0, 9.81]))


def verify_rolling(b):
    source = "Meijaard, Papadopoulos, Ruina & Schwab 2007, table 2"
    for speed, weave, capsize, castering in ((5.0, -0.775341882195845 + 4.464867713788229j, -0.322866429004087, -14.078389692798204),):
        poles = b.linearize(make_bicycle(speed))
        found = b.nearest(poles, weave)
        case = f"Whipple bicycle at {speed:g} m/s"
        b.add(case, "weave, real part [1/s]", found.real, weave.real, 1e-7, source)
        b.add(case, "weave, imaginary part [rad/s]", found.imag, weave.imag, 1e-7, source)
        b.add(case, "capsize [1/s]", b.nearest(poles, capsize).real, capsize, 1e-7, source)
        b.add(case, "castering [1/s]", b.nearest(poles, castering).real, castering, 1e-7, source)
    m, r, g = 1.7, 0.4, 9.81
    speed = 1.5
    poles = b.linearize(toml(
        table("body", "disc", mass=m, inertia=[m * r * r / 4, m * r * r / 2, m * r * r / 4]),
        table("hinge", "place", "general", child="disc", rotations="zxy", translations="xyz",
              position=[0.0, 0.0, 0.0, 0.0, 0.0, r], rate=[0.0, 0.0, speed / r, speed, 0.0, 0.0]),
        table("constraint", "road", "rolling", child="disc", axis=[0.0, 0.0, 1.0], axis2=[0.0, 1.0, 0.0], radius=r),
        section("simulation", duration=1.0, gravity=[0.0, 0.0, -g])))
    b.add("rolling disc, upright", "wobble at 1.5 m/s [rad/s]", poles.imag.max(), math.sqrt((3 * speed**2 / r - g) / (1.25 * r)), 1e-8,
          "upright above v^2 = g r / 3")
    ball, rate, t = 0.2, 3.1, 3.0
    p, v = b.run(toml(
        table("body", "table", mass=1.0, inertia=[1.0, 1.0, 1.0]),
        table("body", "ball", mass=0.9, inertia=[0.4 * 0.9 * ball**2] * 3),
        table("function", "turn", "ramp", value=100 * rate, **{"from": 0.0, "to": 100.0}),
        table("hinge", "axis", "revolute", child="table", motion="turn"),
        table("hinge", "flight", "free", child="ball", position=[1.0, 0.0, 0.0, 0.0, 0.5, 0.0, ball]),
        table("constraint", "contact", "rolling", parent="table", child="ball", crown=ball),
        section("simulation", duration=t, output_step=0.01, gravity=[0.0, 0.0, -g], **ACCURATE)),
        "bodies/ball/position", "bodies/ball/velocity")
    turned = np.unwrap(np.arctan2(v[:, 1], v[:, 0]))
    b.add("ball on a turntable", "rate of its circle / rate of the table", (turned[-1] - turned[0]) / t / rate, 2 / 7, 1e-7,
          "Routh 1905")


def verify_friction(b):
    """Pendulum on a pin: friction by the reaction, which depends on the acceleration; events of the rate by scipy."""
    m, l, J, mu, r, g = 1.3, 0.4, 0.05, 0.35, 0.06, 9.81
    I = J + m * l * l

    def accelerate(theta, omega, side):
        def residual(alpha):
            force = m * math.hypot(l * omega**2 + g * math.cos(theta), l * alpha + g * math.sin(theta))
            return I * alpha + m * g * l * math.sin(theta) + side * mu * r * force

        return brentq(residual, -1e3, 1e3, xtol=1e-14, rtol=1e-14)

    t, theta, omega, side = 0.0, 1.2, 0.0, -1.0
    while t < 2.0:
        def stop(_, x, side=side):
            return side * x[1]

        stop.terminal, stop.direction = True, -1
        found = scipy.integrate.solve_ivp(lambda _, x: [x[1], accelerate(x[0], x[1], side)], (t, 2.0), [theta, omega],
                                          rtol=1e-11, atol=1e-13, events=stop, first_step=1e-6)
        t, (theta, omega) = found.t[-1], found.y[:, -1]
        side = -side
        omega = 0.0 if t < 2.0 else omega
    q, = b.run(toml(
        table("body", "rod", mass=m, inertia=[J, J, J]),
        table("hinge", "pin", "revolute", child="rod", axis=[0.0, 1.0, 0.0], child_position=[0.0, 0.0, l], position=[1.2],
              friction={"mu": mu, "pin_radius": r}),
        section("simulation", duration=2.0, output_step=0.1, gravity=[0.0, 0.0, -g], **ACCURATE)), "hinges/pin/q")
    b.add("pendulum on a pin with friction", "angle after 2 s [rad]", q[-1].item(), theta, 1e-6, "mu r |reaction|, by scipy")


def verify_gyroscope(b):
    """Reaction of a control moment gyroscope on a base that turns about x: -δ' g x h - ω x h, in the axes of the base."""
    rate, h, t = 0.3, 1.5, 2.5
    moment, q, gyro = b.run(toml(
        table("body", "ship", mass=10.0, inertia=[3.0, 4.0, 5.0]),
        table("function", "spin", "ramp", value=10 * rate, **{"from": 0.0, "to": 10.0}),
        table("function", "gimbal", "sine", amplitude=0.4, omega=2.0),
        table("hinge", "axis", "revolute", child="ship", axis=[1.0, 0.0, 0.0], motion="spin"),
        table("actuator", "gyro", "cmg", body="ship", input="gimbal", gimbal_axis=[0.0, 0.0, 1.0],
              spin_axis=[0.0, 1.0, 0.0], momentum=h, angle=0.2),
        section("simulation", duration=2.0, start=0.5, output_step=0.1, **ACCURATE)),
        "hinges/axis/reaction_moment", "hinges/axis/q", "actuators/gyro")
    turn = q[-1].item()
    _, y, z = moment[-1]  # in the axes of the ground
    along = math.cos(turn) * z - math.sin(turn) * y
    across = math.cos(turn) * y + math.sin(turn) * z
    delta, command = 0.2 + 0.2 * (math.cos(1.0) - math.cos(2 * t)), 0.4 * math.sin(2 * t)
    source = "momentum of the rotor: d/dt h"
    b.add("gyroscope on a base that turns", "moment about x [N m]", moment[-1, 0],
          -command * h * math.cos(delta), 1e-9, source)
    b.add("gyroscope on a base that turns", "moment about y [N m]", across, -command * h * math.sin(delta), 1e-9, source)
    b.add("gyroscope on a base that turns", "torque of the gimbal's drive [N m]", along, rate * h * math.cos(delta), 1e-9,
          "g . (omega x h)")
    b.add("gyroscope on a base that turns", "output of the gimbal's motor [N m]", gyro[-1, 2], rate * h * math.cos(delta),
          1e-9, "g . (omega x h)")


def verify(bough, folder, add):
    bench = Bench(bough, folder, add)
    for case in (verify_satellites, verify_wings, verify_classics, verify_exposures, verify_rolling, verify_friction,
                 verify_gyroscope):
        case(bench)
