"""[[orbit]]: the LVLH frame of a reference orbit as parent, against the same satellite with an inertial parent."""
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

MU = 3.986004418e14
ELEMENTS = {"semi_major_axis": 8.0e6, "eccentricity": 0.1, "inclination": 0.9, "ascending_node": 0.4, "periapsis": -1.1,
            "true_anomaly": 0.7}
INERTIA = [500.0, 1200.0, 1400.0]


def calc_state(semi_major_axis, eccentricity, inclination, ascending_node, periapsis, true_anomaly):
    """Position and velocity of elements, from the conic equation."""
    def rotate(angle, axis):
        c, s = math.cos(angle), math.sin(angle)
        return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]] if axis == 3 else [[1.0, 0, 0], [0, c, -s], [0, s, c]])
    R = rotate(ascending_node, 3) @ rotate(inclination, 1) @ rotate(periapsis, 3)
    p = semi_major_axis * (1 - eccentricity**2)
    c, s = math.cos(true_anomaly), math.sin(true_anomaly)
    return (R @ np.array([c, s, 0]) * p / (1 + eccentricity * c),
            R @ np.array([-s, eccentricity + c, 0]) * math.sqrt(MU / p))


def calc_axes(p, v):
    """R_WL and the rate of LVLH."""
    z, h = -p / np.linalg.norm(p), np.cross(p, v)
    y = -h / np.linalg.norm(h)
    return np.stack([np.cross(y, z), y, z], axis=1), h / (p @ p)


def make_quaternion(R):
    w = math.sqrt(1 + np.trace(R)) / 2
    return [w, *(np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (4 * w))]


def make_system(hinge, orbit="", sensors="", duration=7000.0, earth=None, start=0.0):
    return toml(
        table("body", "sat", mass=1000.0, inertia=INERTIA),
        table("body", "wing", mass=30.0, inertia=[5.0, 9.0, 6.0], cg=[0.0, 1.0, 0.0]),
        orbit, table("hinge", "flight", "free", child="sat", **hinge),
        table("hinge", "root", "revolute", parent="sat", child="wing", axis=[1.0, 0.0, 0.0], stiffness=0.03, position=0.2),
        table("force", "earth", "gravity_central", mu=MU, **(earth or {})), sensors,
        section("simulation", start=start, duration=duration, output_step=duration / 100, integrator="rk",
                relative_tolerance=1e-11, absolute_tolerance=1e-10))


class ReferenceOrbit(ProgramTest):
    def run_system(self, name, *arguments, **keys):
        self.write(f"{name}.toml", make_system(*arguments, **keys))
        self.bough("run", f"{name}.toml", "-o", f"{name}.h5", "-q")
        with h5py.File(self.path(f"{name}.h5")) as f:
            found = {}
            f.visititems(lambda path, o: found.__setitem__(path, o[()]) if isinstance(o, h5py.Dataset) else None)
        return found

    def make_hinges(self, offset, drift, attitude, spin):
        """One start in both parents: offset and drift in LVLH, attitude R_LB, spin against inertial space in B."""
        p, v = calc_state(**ELEMENTS)
        R, w = calc_axes(p, v)
        R_WB = R @ attitude
        inertial = {"position": [*make_quaternion(R_WB), *(p + R @ offset)],
                    "rate": [*spin, *(v + R @ drift + np.cross(w, R @ offset))]}
        relative = {"position": [*make_quaternion(attitude), *offset], "rate": [*(spin - R_WB.T @ w), *drift],
                    "parent": "lvlh:ref"}
        return inertial, relative

    def test_lvlh_as_parent_gives_the_inertial_motion(self):
        c, s = math.cos(0.3), math.sin(0.3)
        attitude = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        inertial, relative = self.make_hinges(np.array([120.0, -40.0, 300.0]), np.array([0.2, 0.1, -0.3]), attitude,
                                              np.array([1e-3, -2e-3, 5e-4]))
        expected = self.run_system("inertial", inertial)
        size = ELEMENTS["semi_major_axis"]
        state = calc_state(**ELEMENTS)
        for name, orbit in (("elements", ELEMENTS), ("state", {"position": list(state[0]), "velocity": list(state[1])})):
            found = self.run_system(name, relative, table("orbit", "ref", planet="earth", **orbit))
            for body in ("sat", "wing"):
                np.testing.assert_allclose(found[f"bodies/{body}/position"], expected[f"bodies/{body}/position"], rtol=0,
                                           atol=1e-8 * size)
                np.testing.assert_allclose(found[f"bodies/{body}/velocity"], expected[f"bodies/{body}/velocity"], rtol=0,
                                           atol=1e-8 * 7e3)
                np.testing.assert_allclose(found[f"bodies/{body}/quaternion"], expected[f"bodies/{body}/quaternion"],
                                           rtol=0, atol=1e-8)
            np.testing.assert_allclose(found["hinges/root/q"], expected["hinges/root/q"], rtol=0, atol=1e-8)

    def test_the_frame_is_that_of_a_body_on_the_orbit(self):
        """A ball on the orbit stays at the origin of the frame; the osculating LVLH frame of a sensor is the same one."""
        p, v = calc_state(**ELEMENTS)
        more = table("body", "ball", mass=1.0, inertia=[0.4, 0.4, 0.4]) + table(
            "hinge", "ball", "free", child="ball", position=[1.0, 0.0, 0.0, 0.0, *p], rate=[0.0, 0.0, 0.0, *v])
        sensors = "".join(table("sensor", name, kind, body="sat", relative_to=to) for name, kind, to in (
            ("p_ref", "position", "lvlh:ref"), ("p_ball", "position", "lvlh:ball"), ("v_ref", "velocity", "lvlh:ref"),
            ("v_ball", "velocity", "lvlh:ball"), ("e_ref", "euler", "lvlh:ref"), ("e_ball", "euler", "lvlh:ball")))
        _, relative = self.make_hinges(np.array([10.0, 20.0, 30.0]), np.zeros(3), np.eye(3), np.zeros(3))
        found = self.run_system("frame", relative, table("orbit", "ref", planet="earth", body="ball") + more, sensors,
                                start=50.0)
        np.testing.assert_allclose(found["bodies/ref/position"], found["bodies/ball/position"], rtol=0, atol=1e-3)
        for kind, limit in (("p", 1e-3), ("v", 1e-6), ("e", 1e-9)):
            np.testing.assert_allclose(found[f"sensors/{kind}_ref"], found[f"sensors/{kind}_ball"], rtol=0, atol=limit)
        R, w = calc_axes(found["bodies/ref/position"][37], found["bodies/ref/velocity"][37])
        q = found["bodies/ref/quaternion"][37]
        np.testing.assert_allclose(np.abs(q), np.abs(make_quaternion(R)), atol=1e-9)
        np.testing.assert_allclose(found["bodies/ref/angular_velocity"][37], R.T @ w, atol=1e-12)

    def test_linear_models_about_a_circle_are_those_of_clohessy_and_wiltshire(self):
        """Poles ±in twice, 0 twice, of the relative motion of a point: x'' = 2n z', y'' = -n² y, z'' = 3n² z - 2n x'."""
        n = math.sqrt(MU / 7e6**3)
        self.write("cw.toml", toml(
            table("body", "point", mass=10.0), table("orbit", "ref", planet="earth", semi_major_axis=7e6, inclination_deg=50.0),
            table("hinge", "gap", "general", parent="lvlh:ref", child="point", translations="xyz"),
            table("force", "earth", "gravity_central", mu=MU), section("simulation", duration=1.0)))
        self.bough("linearize", "cw.toml", "-o", "cw.h5", "-q")
        A, = self.read_arrays("cw.h5", "/A")
        expected = np.zeros((6, 6))
        expected[:3, 3:] = np.eye(3)
        expected[3, 5], expected[5, 3] = 2 * n, -2 * n
        expected[4, 1], expected[5, 2] = -n * n, 3 * n * n
        np.testing.assert_allclose(A[:3], expected[:3], atol=1e-12)
        np.testing.assert_allclose(A[3:, 3:] / n, expected[3:, 3:] / n, atol=1e-8)
        np.testing.assert_allclose(A[3:, :3] / n**2, expected[3:, :3] / n**2, atol=1e-6)

    def test_distances_on_the_frame_keep_their_digits(self):
        """An arm and a strut on a hub in orbit: relative positions, the stiffness and its uncertainty are as on ground,
        where differences of inertial positions left eight digits, and the strut was without effect."""
        earth = table("force", "earth", "gravity_central", mu=MU)
        orbit = table("orbit", "o", planet="earth", semi_major_axis=7.0e6, inclination_deg=63.0)
        found = {}
        for name, parent, more in (("ground", "ground", ""), ("orbit", "lvlh:o", earth + orbit)):
            self.write(f"{name}.toml", toml(
                section("parameters", ks=400.0),
                table("body", "hub", mass=30.0, inertia=[4.0, 3.5, 5.0], nodes=[{"id": 2, "position": [0.3, -0.6, -0.4]}]),
                table("body", "arm", mass=2.0, inertia=[1.0, 0.2, 1.1], cg=[0.0, 1.0, 0.0], nodes=[{"id": 1, "position": [0.0, 2.0, 0.0]}]),
                more, table("hinge", "base", "fixed", parent=parent, child="hub"),
                table("hinge", "root", "revolute", parent="hub", child="arm", axis=[1.0, 0.0, 0.0]),
                table("force", "strut", "spring", body="hub", node=2, to_body="arm", to_node=1, stiffness="$ks",
                      free_length=math.hypot(0.3, 2.6, 0.4)),
                table("sensor", "rel", "position", body="arm", node=1, relative_to="hub:2", frame="hub"),
                table("sensor", "gap", "distance", body="arm", node=1, to_body="hub", to_node=2),
                section("simulation", duration=1.0)))
            self.bough("linearize", f"{name}.toml", "-o", f"{name}.h5", "-q", "--uncertain", "ks=300:500")
            with h5py.File(self.path(f"{name}.h5")) as f:
                found[name] = {key: f[key][()] for key in ("A", "C")}
                self.assertEqual(list(f["uncertainty/size"][()]), [1])
        np.testing.assert_allclose(found["orbit"]["C"][-4:], found["ground"]["C"][-4:], rtol=0, atol=1e-11)
        self.assertAlmostEqual(found["orbit"]["C"][-2, 0], 2.0, delta=1e-11)
        rate = MU / 7.0e6**3  # gravity gradient and the turning frame
        np.testing.assert_allclose(found["orbit"]["A"], found["ground"]["A"], rtol=0, atol=10 * rate)

    def test_units_are_converted_and_the_motion_stays(self):
        _, relative = self.make_hinges(np.array([10.0, 20.0, 30.0]), np.zeros(3), np.eye(3), np.zeros(3))
        degrees = {**{k: v for k, v in ELEMENTS.items() if k != "inclination"}, "inclination_deg": math.degrees(0.9)}
        found = self.run_system("m", relative, table("orbit", "ref", planet="earth", **degrees), duration=100.0)
        self.bough("convert", "m.toml", "--units", "m-kg-s:mm-N-tonne", "--radians", "-o", "mm.toml")
        self.bough("run", "mm.toml", "-o", "mm.h5", "-q")
        converted, = self.read_arrays("mm.h5", "/bodies/sat/position")
        np.testing.assert_allclose(converted / 1e3, found["bodies/sat/position"], rtol=1e-9)

    def test_what_is_no_orbit_is_named(self):
        hinge = {"parent": "lvlh:ref"}
        p, v = calc_state(**ELEMENTS)
        for orbit, error in (
                ({"planet": "erth", **ELEMENTS}, "which is no gravity_central"),
                ({"planet": "earth", "position": list(p), "velocity": list(3 * v)}, "is no ellipse"),
                ({"planet": "earth", "position": list(p), "velocity": [0.0, 0.0, 0.0]}, "is no ellipse"),
                ({"planet": "earth", "position": list(p)}, "missing key 'velocity'"),
                ({"planet": "earth"}, "missing key 'semi_major_axis'"),
                ({"planet": "earth", "body": "sat"}, "which is not at a free hinge of ground"),
                ({"planet": "earth", "position": list(p), "velocity": list(v), "eccentricity": 0.1}, "toml.conflicting-keys"),
                ({"planet": "earth", **ELEMENTS, "inclination_deg": 3.0}, "toml.")):
            self.write("bad.toml", make_system(hinge, table("orbit", "ref", **orbit)))
            self.assertIn(error, self.bough("check", "bad.toml", code=1).stderr)
        self.write("bad.toml", make_system({"parent": "lvlh:rf"}, table("orbit", "ref", planet="earth", **ELEMENTS)))
        self.fails(1, "check", "bad.toml", says=["'lvlh:rf'"], error="system.bad-orbit")


if __name__ == "__main__":
    unittest.main()
