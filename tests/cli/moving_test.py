"""The moving system and modes for ParaView (.pvd, read by meshio) and as glTF (read by a reader of its own), against
positions that NumPy makes of the results and the body file."""
import json
import os
import struct
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import meshio
import numpy as np

from support import BEAM, SOURCE, ProgramTest
from toml_text import section, table, toml

sys.path.insert(0, os.path.join(SOURCE, "tests", "oracle"))
import uff_reader  # noqa: E402

SYSTEM = toml(
    table("body", "hub", mass=2.0, inertia=[[0.3, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.4]],
          nodes=[{"id": 1, "position": [0.5, 0.0, 0.0]}]),
    table("body", "beam", file="beam.h5"),
    table("hinge", "spin", "spherical", parent="ground", parent_position=[1.0, 2.0, 3.0], child="hub",
          rate=[0.2, 0.5, 1.0]),
    table("hinge", "clamp", "fixed", parent="hub", parent_node=1, child="beam"),
    section("simulation", duration=1.0, output_step=0.05, gravity=[0.0, 0.0, -9.81]),
    name="swing")
COMPONENTS = {5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def to_rotation(q):
    w, x, y, z = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


class Glb:
    """A .glb taken apart by the words of the specification (glTF 2.0, sections 3.6, 3.11, 4.4); asserts what it asks."""

    def __init__(self, path):
        with open(path, "rb") as f:
            data = f.read()
        magic, version, length = struct.unpack_from("<III", data)
        assert (magic, version, length) == (0x46546C67, 2, len(data))
        size, kind = struct.unpack_from("<II", data, 12)
        assert kind == 0x4E4F534A and size % 4 == 0
        self.json = json.loads(data[20:20 + size])
        at = 20 + size
        size, kind = struct.unpack_from("<II", data, at)
        assert kind == 0x004E4942 and size % 4 == 0 and at + 8 + size == len(data)
        self.bin = data[at + 8:]
        assert self.json["buffers"] == [{"byteLength": len(self.bin)}]
        self.check()

    def get(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width, number = WIDTHS[accessor["type"]], COMPONENTS[accessor["componentType"]]
        assert view["byteOffset"] % 4 == 0 and view["byteOffset"] + view["byteLength"] <= len(self.bin)
        assert view["byteLength"] == accessor["count"] * width * 4 > 0
        values = np.frombuffer(self.bin, number, accessor["count"] * width, view["byteOffset"]).reshape(-1, width)
        if "min" in accessor:
            np.testing.assert_array_equal(values.min(0), np.float32(accessor["min"]))
            np.testing.assert_array_equal(values.max(0), np.float32(accessor["max"]))
        return values

    def check(self):
        for index in range(len(self.json["accessors"])):
            assert np.isfinite(self.get(index)).all()
        for mesh in self.json["meshes"]:
            for primitive in mesh["primitives"]:
                position = primitive["attributes"]["POSITION"]
                assert "min" in self.json["accessors"][position]
                count = self.json["accessors"][position]["count"]
                for target in primitive.get("targets", []):
                    assert self.json["accessors"][target["POSITION"]]["count"] == count
                assert len(primitive.get("targets", [])) == len(mesh.get("weights", []))
                if "indices" in primitive:
                    indices = self.get(primitive["indices"])
                    assert indices.max() < count and len(indices) % {4: 3, 1: 2}[primitive["mode"]] == 0
        for animation in self.json["animations"]:
            for channel in animation["channels"]:
                sampler = animation["samplers"][channel["sampler"]]
                times = self.get(sampler["input"]).ravel()
                assert "min" in self.json["accessors"][sampler["input"]]
                assert times[0] == 0 and (np.diff(times) > 0).all()
                node = self.json["nodes"][channel["target"]["node"]]
                each = {"translation": 1, "rotation": 1,
                        "weights": len(self.json["meshes"][node["mesh"]].get("weights", []))}
                path = channel["target"]["path"]
                output = self.json["accessors"][sampler["output"]]
                assert output["count"] == len(times) * each[path]
                assert output["type"] == {"translation": "VEC3", "rotation": "VEC4", "weights": "SCALAR"}[path]
                if path == "rotation":
                    np.testing.assert_allclose(np.linalg.norm(self.get(sampler["output"]), axis=1), 1, atol=1e-6)

    def place(self, node, frame, animation=0):
        """Positions of a node's vertices in a frame of the animation."""
        mesh = self.json["meshes"][self.json["nodes"][node]["mesh"]]
        primitive = mesh["primitives"][0]
        xyz = self.get(primitive["attributes"]["POSITION"]).astype(float)
        moved = {"translation": np.zeros(3), "rotation": np.array([0, 0, 0, 1.0])}
        for channel in self.json["animations"][animation]["channels"]:
            if channel["target"]["node"] != node:
                continue
            output = self.get(self.json["animations"][animation]["samplers"][channel["sampler"]]["output"])
            moved[channel["target"]["path"]] = output
        if "weights" in moved:
            weights = moved["weights"].reshape(-1, len(mesh["weights"]))[frame]
            for weight, target in zip(weights, primitive["targets"]):
                xyz = xyz + weight * self.get(target["POSITION"])
        q, t = np.atleast_2d(moved["rotation"]), np.atleast_2d(moved["translation"])
        q, t = q[min(frame, len(q) - 1)], t[min(frame, len(t) - 1)]
        return xyz @ to_rotation(q[[3, 0, 1, 2]].astype(float)).T + t


class Moving(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("beam.bdf", BEAM)
        self.bough("reduce", "beam.bdf", "--modes", "3", "-o", "beam.h5", "-q")
        self.write("swing.toml", SYSTEM)
        self.bough("run", "swing.toml", "-o", "swing.h5", "-q")
        with h5py.File(self.path("swing.h5")) as f:
            self.time = f["time"][:]
            self.run_of = {name: {key: value[:] for key, value in f["bodies"][name].items()} for name in f["bodies"]}
        with h5py.File(self.path("beam.h5")) as f:
            self.grid = dict(zip(f["nodes/id"][:], f["nodes/xyz"][:]))
            self.phi = dict(zip(f["nodes/id"][:], f["modes/phi"][:]))
            self.stiffness = f["modal/stiffness"][:]

    def expect(self, ids, sample, scale=1.0):
        """Places, deflections (inertial) and velocities of grids of the beam."""
        run = {key: value[sample] for key, value in self.run_of["beam"].items() if value.ndim == 2}
        R = to_rotation(run["quaternion"])
        p = np.array([self.grid[i] for i in ids])
        u = np.array([self.phi[i][:3] @ run["eta"] for i in ids])
        rate = np.array([self.phi[i][:3] @ run["eta_dot"] for i in ids])
        v = run["velocity"] + (np.cross(run["angular_velocity"], p + u) + rate) @ R.T
        return run["position"] + (p + scale * u) @ R.T, u @ R.T, v

    def read_frames(self, name):
        root = ElementTree.parse(self.path(name)).getroot()
        self.assertEqual((root.tag, root.get("type")), ("VTKFile", "Collection"))
        sets = root.findall("Collection/DataSet")
        return [float(s.get("timestep")) for s in sets], [meshio.read(self.path(s.get("file"))) for s in sets]

    def test_pvd(self):
        self.bough("export", "swing.h5", "--to", "pvd", "-o", "all.pvd")
        times, meshes = self.read_frames("all.pvd")
        np.testing.assert_array_equal(times, self.time)
        self.assertGreater(np.ptp(self.run_of["beam"]["eta"][:, 0]), 1e-4)
        for sample, mesh in enumerate(meshes):
            of_beam = mesh.point_data["body"].ravel() == 2
            ids = mesh.point_data["grid_id"].ravel()[of_beam]
            self.assertEqual(sorted(ids), [1, 2, 3])
            x, u, v = self.expect(ids, sample)
            for found, wanted in [(mesh.points, x), (mesh.point_data["displacement"], u),
                                  (mesh.point_data["velocity"], v)]:
                np.testing.assert_allclose(found[of_beam], wanted, rtol=1e-12, atol=1e-12)
            np.testing.assert_allclose(mesh.point_data["displacement_magnitude"].ravel()[of_beam],
                                       np.linalg.norm(u, axis=1), rtol=1e-12, atol=1e-14)
            eta = self.run_of["beam"]["eta"][sample]
            np.testing.assert_allclose(mesh.point_data["strain_energy"].ravel()[of_beam],
                                       0.5 * eta @ self.stiffness @ eta, rtol=1e-12, atol=1e-15)
        # The hub: a box of its inertia about its origin, which moves as one; 1/12 m (b² + c²) = J.
        hub = meshes[7].point_data["body"].ravel() == 1
        R, r = to_rotation(self.run_of["hub"]["quaternion"][7]), self.run_of["hub"]["position"][7]
        own = (meshes[7].points[hub] - r) @ R
        corners = own[np.linalg.norm(own - [0.5, 0, 0], axis=1) > 1e-9]
        side = np.ptp(corners, axis=0)
        inertia = 2.0 / 12 * (side @ side - side**2)
        np.testing.assert_allclose(inertia, [0.3, 0.2, 0.4], rtol=1e-9)
        self.assertIn("triangle", meshes[7].cells_dict)

    def test_pvd_choices(self):
        self.bough("export", "swing.h5", "--to", "pvd", "--every", "3", "--window", "0.2,0.8", "--scale", "50",
                   "--follow", "beam", "--ascii", "-o", "some.pvd")
        times, meshes = self.read_frames("some.pvd")
        inside = [i for i, t in enumerate(self.time) if 0.2 <= t <= 0.8][::3]
        np.testing.assert_array_equal(times, self.time[inside])
        for sample, mesh in zip(inside, meshes):
            of_beam = mesh.point_data["body"].ravel() == 2
            x, u, _ = self.expect(mesh.point_data["grid_id"].ravel()[of_beam], sample, 50)
            np.testing.assert_allclose(mesh.points[of_beam], x - self.run_of["beam"]["position"][sample], rtol=0,
                                       atol=1e-12)
            np.testing.assert_allclose(mesh.point_data["displacement"][of_beam], u, rtol=1e-12, atol=1e-14)

    def test_uff_of_a_run(self):
        """The first place and, at each sample, where every point has gone from there."""
        self.bough("export", "swing.h5", "--to", "uff", "--moving", "--every", "5", "--scale", "3", "-o", "swing.uff")
        sets = uff_reader.read(self.path("swing.uff"))
        nodes, times = sets[0], [s for s in sets if s["dataset"] == 55]
        samples = np.arange(0, len(self.time), 5)
        np.testing.assert_allclose([s["reals"][0] for s in times], self.time[samples], atol=1e-5)
        self.assertEqual([s["parameters"] for s in times], [[1, k + 1] for k in range(len(samples))])
        self.assertEqual({s["analysis"] for s in times}, {4})
        # The hub has 8 corners, its mass centre and a node or two; the grids of the beam keep their ids.
        points = len(nodes["id"]) - 3
        self.assertEqual(nodes["id"], [100 + k for k in range(1, points + 1)] + [201, 202, 203])
        beam = [points, points + 1, points + 2]
        start = self.expect([1, 2, 3], 0, 3)[0]
        np.testing.assert_allclose(nodes["xyz"][beam], start, atol=1e-5)
        for sample, found in zip(samples, times):
            self.assertEqual(found["id"], nodes["id"])
            np.testing.assert_allclose(found["shape"][beam], self.expect([1, 2, 3], sample, 3)[0] - start, atol=2e-5)
        traced = {abs(k) for s in sets if s["dataset"] == 82 for k in s["nodes"] if k}
        self.assertLessEqual(traced, set(nodes["id"]))
        self.assertTrue({nodes["id"][k] for k in beam} <= traced)
        self.fails(1, "export", "beam.h5", "--to", "uff", "--moving", "-o", "x.uff", error="hdf5.wrong-format")

    def test_gltf_of_a_run(self):
        self.bough("export", "swing.h5", "--to", "gltf", "--scale", "2", "-o", "swing.glb")
        glb = Glb(self.path("swing.glb"))
        self.assertEqual([node["name"] for node in glb.json["nodes"]], ["hub", "beam"])
        for sample in [0, 7, 20]:
            # The drawing's points come in the order of the elements.
            np.testing.assert_allclose(glb.place(1, sample), self.expect([1, 2, 3], sample, 2)[0], atol=2e-6)
            run = {key: value[sample] for key, value in self.run_of["hub"].items() if value.ndim == 2}
            xyz = glb.get(glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"])
            np.testing.assert_allclose(glb.place(0, sample), run["position"] + xyz @ to_rotation(run["quaternion"]).T,
                                       atol=2e-6)
        times = glb.get(glb.json["animations"][0]["samplers"][0]["input"]).ravel()
        np.testing.assert_allclose(times, self.time, atol=1e-7)

    def test_gltf_of_modes(self):
        self.bough("modes", "beam.bdf", "-o", "modes.h5", "-q")
        for name in ["modes.h5", "beam.h5"]:
            self.bough("export", name, "--to", "gltf", "-o", "modes.glb")
            glb = Glb(self.path("modes.glb"))
            self.assertEqual(len(glb.json["animations"]), 3)
            with h5py.File(self.path(name)) as f:
                phi, xyz, hertz = f["modes/phi"][:], f["nodes/xyz"][:], f["modes/frequency_hz"][:]
            for j, animation in enumerate(glb.json["animations"]):
                self.assertIn(f"{hertz[j]:.4g} Hz", animation["name"])
                shape = phi[:, :3, j] * 0.2 / np.linalg.norm(phi[:, :3, j], axis=1).max()  # a tenth of two metres
                for frame in [0, 5, 12, 36]:
                    sine = np.sin(2 * np.pi * frame / 48)
                    np.testing.assert_allclose(glb.place(0, frame, j), xyz + sine * shape, atol=2e-6)

    def test_what_cannot_be_drawn(self):
        self.fails(2, "export", "swing.h5", "--to", "pvd", error="cli.usage")
        self.fails(1, "export", "beam.h5", "--to", "pvd", "-o", "x.pvd", error="hdf5.wrong-format")
        self.fails(1, "export", "swing.h5", "--to", "pvd", "--window", "3,4", "-o", "x.pvd", error="cli.bad-range")
        self.fails(1, "export", "swing.h5", "--to", "gltf", "--follow", "arm", says=["hub, beam"],
                   error="cli.unknown-body")
        os.rename(self.path("beam.h5"), self.path("moved.h5"))
        said = self.bough("export", "swing.h5", "--to", "gltf", "-o", "x.glb").stderr
        self.assertIn("[export.no-body]", said)
        self.assertEqual(len(Glb(self.path("x.glb")).json["nodes"]), 1)
        self.assertEqual(self.bough("export", "swing.h5", "--to", "gltf", "--body", "moved.h5", "-o", "y.glb").stderr, "")
        self.assertEqual(len(Glb(self.path("y.glb")).json["nodes"]), 2)
        self.write("bare.toml", SYSTEM.replace("[simulation]", '[simulation]\nrecord = ["energy"]').replace("beam.h5", "moved.h5"))
        self.bough("run", "bare.toml", "-o", "bare.h5", "-q")
        self.fails(1, "export", "bare.h5", "--to", "pvd", "-o", "x.pvd", error="cli.no-motion")


if __name__ == "__main__":
    unittest.main()
