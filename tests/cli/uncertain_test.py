"""`linearize --uncertain`: the linear fractional model, closed in NumPy, against `linearize --set` at the same values and
against bodies whose modes were changed in their files."""
import unittest

import h5py
import numpy as np
import scipy.io

from support import ProgramTest
from toml_text import section, table, toml

SYSTEM = toml(
    section("parameters", gain=5.0, k=100.0, c=2.0, m=1.0),
    table("body", "a", mass=2.0, inertia=[1.0, 1.0, 1.0]),
    table("body", "b", mass="$m", cg=[0.0, 0.0, 0.3], inertia=[1.0, 1.0, 1.0]),
    table("hinge", "first", "prismatic", child="a", axis=[1.0, 0.0, 0.0], stiffness=[300.0]),
    table("hinge", "second", "revolute", parent="a", child="b", axis=[0.0, 1.0, 0.0], stiffness=["$k"], damping=["$c"]),
    table("sensor", "place", "hinge_angle", hinge="first"),
    table("sensor", "felt", "accelerometer", body="b"),
    table("controller", "pid", "pid", inputs=["place"], kp="$gain", ki=1.0, kd=0.0),
    table("actuator", "motor", "hinge", hinge="first", input="pid"),
    section("simulation", duration=1.0, output_step=0.01),
    name="sliders")


def close(f, delta):
    """A, B, C, D with w = delta z."""
    A, B, C, D = (f[name][:] for name in "ABCD")
    gain = np.diag(np.concatenate([np.full(n, d) for n, d in zip(f["/uncertainty/size"][:], delta)]))
    n = len(gain)
    inner = gain @ np.linalg.inv(np.eye(n) - D[:n, :n] @ gain)
    return (A + B[:, :n] @ inner @ C[:n], B[:, n:] + B[:, :n] @ inner @ D[:n, n:],
            C[n:] + D[n:, :n] @ inner @ C[:n], D[n:, n:] + D[n:, :n] @ inner @ D[:n, n:])


class Uncertain(ProgramTest):
    def check(self, model, name, delta, *arguments, tolerance=1e-9):
        """The model closed at delta is that of `linearize` with these arguments."""
        self.bough("linearize", *arguments, "-o", "at.h5")
        with h5py.File(self.path(model)) as f, h5py.File(self.path("at.h5")) as at:
            A, B, C, D = close(f, delta)
            for own, letters in ((np.hstack([A, B]), "AB"), (np.hstack([C, D]), "CD")):
                expected = np.hstack([at[letter][:] for letter in letters])
                size = np.abs(expected).max(axis=1, keepdims=True)
                size[size == 0] = 1
                np.testing.assert_array_less(np.abs(own - expected) / size, tolerance, f"{name} {letters}")

    def test_parameters(self):
        """Stiffness, damping, mass and gain at once; the accelerometer feels each."""
        self.write("sliders.toml", SYSTEM)
        ranges = {"gain": (2, 9), "k": (80, 130), "c": (0, 3), "m": (0.7, 1.6)}
        flags = [word for name, (low, high) in ranges.items() for word in ("--uncertain", f"{name}={low}:{high}")]
        text = self.bough("linearize", "sliders.toml", *flags, "-o", "lft.h5", "--mat", "lft.mat").stdout
        self.assertIn("uncertain parameter", text)
        with h5py.File(self.path("lft.h5")) as f:
            # A stiffness, a damping and a gain are of rank one; the mass enters where b's centre of mass moves.
            sizes = dict(zip(f["/uncertainty/name"].asstr()[:], f["/uncertainty/size"][:]))
            self.assertEqual([sizes["gain"], sizes["k"], sizes["c"]], [1, 1, 1])
            self.assertLessEqual(sizes["m"], 2)
            self.assertEqual(list(f["/inputs/name"].asstr()[:3]), ["gain:w1", "k:w1", "c:w1"])
            mat = scipy.io.loadmat(self.path("lft.mat"))
            np.testing.assert_array_equal(mat["delta_range"], [list(r) for r in ranges.values()])
            np.testing.assert_array_equal(mat["delta_size"].ravel(), f["/uncertainty/size"][:])
        generator = np.random.default_rng(4)
        for _ in range(4):
            delta = generator.uniform(-1, 1, 4)
            values = [0.5 * (low + high) + 0.5 * d * (high - low) for d, (low, high) in zip(delta, ranges.values())]
            flags = [word for name, value in zip(ranges, values) for word in ("--set", f"{name}={value!r}")]
            self.check("lft.h5", values, delta, "sliders.toml", *flags)

    def test_modes(self):
        """Frequency and damping of two modes of a boom, against files with other modal matrices."""
        self.copy_example("ex02-hub")
        self.write("boom.toml", self.read("boom.toml") + "\n[body.damping]\nratio = 0.01\n")
        self.bough("reduce", "boom.toml", "-o", "boom.h5")
        text = self.read("hub-2.18.toml")
        body = next(line.split('"')[1] for line in text[text.index('file = "boom.h5"') - 60:].splitlines() if line.startswith("name"))
        flags = ["--uncertain", f"{body}:eta1:frequency=0.9:1.1", "--uncertain", f"{body}:eta2:damping=0.5:2"]
        self.bough("linearize", "hub-2.18.toml", *flags, "-o", "lft.h5")
        self.bough("linearize", "hub-2.18.toml", "-o", "file.h5")
        with h5py.File(self.path("lft.h5")) as f:
            np.testing.assert_array_equal(f["/uncertainty/size"][:], [1, 1])
        # delta of the file's own values, and of others
        squares, dampings = np.array([0.81, 1.21]), np.array([0.5, 2.0])
        to_delta = lambda value, ends: (2 * value - ends.sum()) / (ends[1] - ends[0])
        self.check("lft.h5", "file", [to_delta(1, squares), to_delta(1, dampings)], "hub-2.18.toml")
        with h5py.File(self.path("boom.h5"), "r+") as f:
            f["/modal/stiffness"][0, 0] *= 1.05**2
            self.assertGreater(f["/modal/damping"][1, 1], 0)
            f["/modal/damping"][1, 1] *= 1.3
        self.check("lft.h5", "changed", [to_delta(1.05**2, squares), to_delta(1.3, dampings)], "hub-2.18.toml")

    def test_round_off_of_an_output_is_not_judged(self):
        """An accelerometer across the motion, at rest to 1e-8 N, as a length with eleven digits leaves it."""
        self.write("strut.toml", toml(
            section("parameters", ks=400.0, mh=30.0),
            table("body", "hub", mass="$mh", inertia=[4.0, 3.5, 5.0], nodes=[{"id": 2, "position": [0.0, 0.0, 0.5]}]),
            table("body", "wing", mass=20.0, inertia=[20.0, 1.0, 20.0], cg=[0.0, 2.0, 0.0], nodes=[{"id": 17, "position": [0.0, 4.0, 0.0]}]),
            table("hinge", "base", "prismatic", child="hub", axis=[0.0, 0.0, 1.0]),
            table("hinge", "root", "revolute", parent="hub", child="wing", axis=[1.0, 0.0, 0.0]),
            table("force", "strut", "spring", body="hub", node=2, to_body="wing", to_node=17, stiffness="$ks", free_length=4.0311288741),
            table("sensor", "acc", "accelerometer", body="wing", node=17),
            table("actuator", "f", "force", body="wing", node=17, axis=[1.0, 2.0, 3.0]), section("simulation", duration=1.0)))
        self.bough("linearize", "strut.toml", "--uncertain", "ks=300:500", "--uncertain", "mh=20:45", "-o", "lft.h5")
        self.bough("linearize", "strut.toml", "--set", "ks=450", "--set", "mh=30", "-o", "at.h5")
        with h5py.File(self.path("lft.h5")) as f, h5py.File(self.path("at.h5")) as at:
            for own, letter in zip(close(f, [0.5, -0.2]), "ABCD"):
                np.testing.assert_allclose(own, at[letter][:], rtol=0, atol=1e-9 * max(1, np.abs(at[letter][:]).max()))

    def test_refusals(self):
        self.write("sliders.toml", SYSTEM.replace("gain = 5.0", "gain = 5.0\nrest = 1.0"))
        for bad in ["gain", "gain=4", "gain=6:4", "=1:2", "gain=a:b", "a:eta1:color=1:2", "a:eta0:stiffness=1:2",
                    "a:eta1:damping=-1:2"]:
            self.fails(2, "linearize", "sliders.toml", "--uncertain", bad, error="cli.bad-uncertain")
        self.fails(2, "linearize", "sliders.toml", "--uncertain", "gain=4:6", "--uncertain", "gain=3:6", says=["names gain twice"],
                   error="cli.bad-uncertain")
        self.fails(1, "linearize", "sliders.toml", "--uncertain", "other=1:2", error="toml.unknown-parameter")
        self.fails(1, "linearize", "sliders.toml", "--uncertain", "bb:eta1:stiffness=1:2", error="linear.no-mode")
        self.fails(1, "linearize", "sliders.toml", "--uncertain", "a:eta1:stiffness=1:2", error="linear.no-mode")
        self.fails(1, "linearize", "sliders.toml", "--uncertain", "rest=1:2", error="linear.no-effect")
        # A rate enters by its square.
        spin = SYSTEM.replace('child = "a"\n', 'child = "a"\nposition = ["$gain"]\n').replace('type = "prismatic"', 'type = "revolute"')
        spin = spin.replace("[0.0, 0.0, 0.3]", "[0.4, 0.0, 0.3]")
        self.write("spin.toml", spin.replace('position = ["$gain"]', 'rate = ["$gain"]').replace('kp = "$gain"', "kp = 1.0"))
        self.fails(1, "linearize", "spin.toml", "--uncertain", "gain=1:4", error="linear.not-affine")
        self.write("sampled.toml", SYSTEM.replace('type = "pid"\n', 'type = "pid"\nsample_time = 0.1\n'))
        self.fails(1, "linearize", "sampled.toml", "--break", "motor", "--uncertain", "k=80:120", error="linear.sampled-uncertain")

    def test_a_mass_under_gravity_is_taken_at_rest(self):
        """Where the point accelerates M A_u is no affine function of a mass; an arm that hangs is at rest with any."""
        self.write("arm.toml", toml(
            section("parameters", mp=1.0),
            table("body", "a", mass=2.0, cg=[0.5, 0.0, 0.0], inertia=[0.1, 0.2, 0.2]),
            table("body", "b", mass="$mp", cg=[0.5, 0.0, 0.0], inertia=[0.1, 0.2, 0.2]),
            table("hinge", "s", "revolute", child="a", axis=[0.0, 1.0, 0.0], position=0.3),
            table("hinge", "e", "revolute", parent="a", parent_position=[1.0, 0.0, 0.0], child="b", axis=[0.0, 1.0, 0.0],
                  position=0.6),
            section("simulation", duration=1.0, gravity=[0.0, 0.0, -9.81])))
        self.fails(1, "linearize", "arm.toml", "--uncertain", "mp=0.5:1.5", error="linear.not-affine",
                   says=["is not at rest", "give --equilibrium"])
        self.bough("linearize", "arm.toml", "--equilibrium", "--uncertain", "mp=0.5:1.5", "-o", "lft.h5")
        for delta, mass in ((-1, 0.5), (0.4, 1.2)):
            self.check("lft.h5", mass, [delta], "arm.toml", "--equilibrium", "--set", f"mp={mass}", tolerance=1e-8)


if __name__ == "__main__":
    unittest.main()
