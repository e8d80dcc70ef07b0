"""Sensors relative to a node of another flexible body, against absolute sensors and finite differences."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

N = 6
DECK = ("SOL 103\nCEND\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-4,1.-9,2.-9,2.-9\nPARAM,COUPMASS,1\n" +
        "".join(f"GRID,{k + 1},,{k / N},0.,0.\n" for k in range(N + 1)) +
        "".join(f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,1.,0.\n" for k in range(N)) + "ENDDATA\n")
BEAM = toml(section("body", name="beam", deck="beam.bdf", frame="node", frame_nodes=[1], interface=[1, N + 1]),
            section("body.modes", number=4, basis="craig-bampton"), section("body.output", file="beam.h5", nodes=[4]))
KINDS = ("position", "velocity", "acceleration", "angular_velocity", "angular_acceleration", "dcm")
A, K = ("left", N + 1), ("right", 4)


def make_sensors(extra=""):
    tables = [extra]
    for name, (body, node) in (("a", A), ("k", K)):
        tables += [table("sensor", f"{name}_{kind}", kind, body=body, node=node) for kind in KINDS]
    to = f"{A[0]}:{A[1]}"
    for kind in KINDS:
        keys = {} if kind == "dcm" else {"frame": to}
        tables.append(table("sensor", f"seen_{kind}", kind, body=K[0], node=K[1], relative_to=to, **keys))
        if kind != "dcm":
            tables.append(table("sensor", f"gap_{kind}", kind, body=K[0], node=K[1], relative_to=to, observer="fixed"))
    return "".join(tables)


def make_system(sensors, rate=0.0, eta=0.0, duration=0.02, step=1e-4):
    deform = {"eta": [eta] * 9, "eta_dot": [3 * eta] * 9} if eta else {}
    return toml(
        table("body", "hub", mass=3.0, inertia=[0.2, 0.3, 0.4]),
        *(table("body", name, file="beam.h5", **deform) for name in ("left", "right")),
        table("hinge", "flight", "free", child="hub", rate=[rate, -2 * rate, 3 * rate, 0.1, 0.2, 0.3]),
        table("hinge", "hl", "revolute", parent="hub", child="left", child_node=1, axis=[0.0, 0.0, 1.0], position=0.4,
              rate=rate, parent_position=[0.1, 0.0, 0.0]),
        table("hinge", "hr", "universal", parent="hub", child="right", child_node=1, axis=[0.0, 0.0, 1.0],
              axis2=[0.0, 1.0, 0.0], position=[2.4, 0.2], rate=[-rate, 2 * rate], parent_position=[-0.1, 0.0, 0.0]),
        sensors,
        section("simulation", duration=duration, output_step=step, integrator="rk", relative_tolerance=1e-12,
                absolute_tolerance=1e-13))


def vee(M):
    return np.stack([M[:, 2, 1] - M[:, 1, 2], M[:, 0, 2] - M[:, 2, 0], M[:, 1, 0] - M[:, 0, 1]], axis=1) / 2


class NodeObserver(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("beam.bdf", DECK)
        self.write("beam.toml", BEAM)
        self.bough("reduce", "beam.toml", "-q")

    def read_sensors(self, system):
        self.write("s.toml", system)
        self.bough("run", "s.toml", "-o", "s.h5", "-q")
        with h5py.File(self.path("s.h5")) as f:
            found = {name: f["sensors"][name][()] for name in f["sensors"]}
            found["time"] = f["time"][()]
        for name in found:
            if name.endswith("_dcm"):
                found[name] = found[name].reshape(-1, 3, 3)
        return found

    def test_a_node_sees_what_absolute_sensors_give(self):
        """p, v, a, ω, α and attitude in the frame of a node that deforms, from those of both nodes in the inertial one."""
        s = self.read_sensors(make_system(make_sensors(), rate=0.7, eta=2e-3))
        d = {kind: s[f"k_{kind}"] - s[f"a_{kind}"] for kind in KINDS}
        R, w, alpha = s["a_dcm"], s["a_angular_velocity"], s["a_angular_acceleration"]
        velocity = d["velocity"] - np.cross(w, d["position"])
        expected = {
            "position": d["position"], "velocity": velocity, "angular_velocity": d["angular_velocity"],
            "angular_acceleration": d["angular_acceleration"] - np.cross(w, d["angular_velocity"]),
            "acceleration": d["acceleration"] - np.cross(alpha, d["position"])
            - np.cross(w, np.cross(w, d["position"])) - 2 * np.cross(w, velocity)}
        self.assertGreater(np.abs(s["a_dcm"] - s["a_dcm"][0]).max(), 1e-2)
        for kind, value in expected.items():
            with self.subTest(kind):
                scale = np.abs(value).max()
                np.testing.assert_allclose(s[f"seen_{kind}"], np.einsum("tji,tj->ti", R, value), rtol=0, atol=1e-12 * scale)
                np.testing.assert_allclose(s[f"gap_{kind}"], d[kind], rtol=0, atol=1e-12 * np.abs(d[kind]).max())
        np.testing.assert_allclose(s["seen_dcm"], np.einsum("tji,tjk->tik", R, s["k_dcm"]), rtol=0, atol=1e-12)

    def test_rates_are_the_derivatives_of_places(self):
        s = self.read_sensors(make_system(make_sensors(), rate=0.7, eta=2e-3, duration=4e-4, step=1e-6))
        step = s["time"][1] - s["time"][0]

        def differentiate(x):
            """Central differences of fourth order."""
            return (8 * (x[3:-1] - x[1:-3]) - (x[4:] - x[:-4])) / (12 * step)

        for place, rate in (("position", "velocity"), ("velocity", "acceleration"), ("angular_velocity", "angular_acceleration")):
            value = s[f"seen_{rate}"][2:-2]
            # ω' as the observer sees it is the derivative of its components in the frame of the observer.
            np.testing.assert_allclose(differentiate(s[f"seen_{place}"]), value, rtol=0, atol=1e-6 * np.abs(value).max())
        spin = np.einsum("tij,tkj->tik", differentiate(s["seen_dcm"]), s["seen_dcm"][2:-2])
        w = s["seen_angular_velocity"][2:-2]
        np.testing.assert_allclose(vee(spin), w, rtol=0, atol=1e-6 * np.abs(w).max())

    def test_linear_models_have_the_relative_rows(self):
        """C of a relative sensor: the difference of both absolute ones, and the slope of the nonlinear one."""
        to = f"{A[0]}:{A[1]}"
        more = table("sensor", "seen_euler", "euler", body=K[0], node=K[1], relative_to=to)
        self.write("l.toml", make_system(make_sensors(more)))
        self.bough("linearize", "l.toml", "-o", "l.h5", "-q")
        with h5py.File(self.path("l.h5")) as f:
            C, A_ = f["C"][()], f["A"][()]
            outputs = [n.decode() for n in f["outputs/name"][()]]
        rows = {}
        for i, name in enumerate(outputs):
            rows.setdefault(name.rsplit(":", 1)[0], []).append(i)
        for kind in ("position", "velocity", "angular_velocity"):
            gap = C[rows[f"k_{kind}"]] - C[rows[f"a_{kind}"]]
            self.assertGreater(np.abs(gap).max(), 0.1)
            np.testing.assert_allclose(C[rows[f"gap_{kind}"]], gap, rtol=0, atol=1e-7 * np.abs(gap).max())
        # At rest d/dt of the relative place is the relative velocity: C_p A = C_v on the rates.
        slope = C[rows["seen_position"]] @ A_
        np.testing.assert_allclose(slope, C[rows["seen_velocity"]], rtol=0, atol=2e-6 * np.abs(slope).max())

    def test_a_line_of_sight_from_a_node(self):
        """u of the optical node in the axes of the reference node: the change of the relative position."""
        terms = [{"body": K[0], "node": K[1], "displacement": [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]}]
        more = table("sensor", "sight", "line_of_sight", relative_to=f"{A[0]}:{A[1]}", terms=terms)
        s = self.read_sensors(make_system(make_sensors(more), rate=0.3))
        gap = s["seen_position"] - s["seen_position"][0]
        self.assertGreater(np.abs(gap).max(), 1e-3)
        np.testing.assert_allclose(s["sight"], gap, rtol=0, atol=1e-9)

    def test_nodes_that_are_not_there_are_named(self):
        for key, error in (('relative_to = "left:99"', "sensor.unknown-node"), ('relative_to = "lft:7"', "did you mean 'left'"),
                           ('frame = "left:99"', "sensor.unknown-node"), ('frame = "left:x"', "toml.unknown-name")):
            self.write("bad.toml", make_system(table("sensor", "s", "position", body="right", node=4) + key + "\n"))
            self.assertIn(error, self.bough("check", "bad.toml", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
