"""Drag and sunlight on the faces of a flexible body's mesh, against one plate and against the deformed grids."""
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import section, table, toml

NX, NY, LX, LY = 4, 2, 4.0, 1.0
MU = 3.986004418e14


def grid(i, j):
    return 1 + i + (NX + 1) * j


def make_deck():
    """A plate in the xy plane; its first column of grids has the hinge; two triangles at its free corner."""
    cards = ["MAT1,1,7.+10,,.3,2700.", "PSHELL,1,1,0.01,1,,1"]
    cards += [f"GRID,{grid(i, j)},,{LX * i / NX},{LY * j / NY - LY / 2},0." for j in range(NY + 1) for i in range(NX + 1)]
    e = 0
    for j in range(NY):
        for i in range(NX):
            e += 1
            corners = [grid(i, j), grid(i + 1, j), grid(i + 1, j + 1), grid(i, j + 1)]
            if e < NX * NY:
                cards.append(f"CQUAD4,{e},1,{','.join(map(str, corners))}")
            else:
                cards.append(f"CTRIA3,{e},1,{corners[0]},{corners[1]},{corners[2]}")
                cards.append(f"CTRIA3,{e + 1},1,{corners[0]},{corners[2]},{corners[3]}")
    cards.append(f"RBE2,90,{grid(0, 1)},123456,{grid(0, 0)},{grid(0, 2)}")
    return "SOL 103\nCEND\nBEGIN BULK\n" + "\n".join(cards) + "\nENDDATA\n"


def make_body(nodes):
    return (f'[body]\nname = "plate"\ndeck = "plate.bdf"\nframe = "node"\nframe_nodes = [{grid(0, 1)}]\ninterface = [{grid(0, 1)}]\n'
            f'[body.modes]\nnumber = 4\nbasis = "craig-bampton"\n[body.output]\nfile = "plate.h5"\nnodes = {nodes}\n')


def make_system(force, kind, eta=(), rate=(0.0,) * 6, duration=1e-3, more="", position=None):
    place = position or [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    return toml(
        table("body", "plate", file="plate.h5", **({"eta": list(eta)} if len(eta) else {})),
        table("hinge", "flight", "free", child="plate", child_node=grid(0, 1), rate=list(rate), position=place), more,
        table("force", "f", kind, body="plate", **force),
        section("simulation", duration=duration, output_step=duration, integrator="rk", relative_tolerance=1e-10))


SUN = {"pressure": 4.5e-6, "sun": [0.3, -0.2, 0.9], "specular": 0.3, "diffuse": 0.2}
AIR = {"coefficient": 2.2, "density": 1e-9}
WIND = (0.0, 0.0, 0.0, 3000.0, 1000.0, -6000.0)


class MeshFaces(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("plate.bdf", make_deck())
        self.write("plate.toml", make_body([grid(NX, 0), grid(NX, 2)]))
        self.bough("reduce", "plate.toml", "-q")

    def run_system(self, *arguments, **keys):
        self.write("s.toml", make_system(*arguments, **keys))
        self.bough("run", "s.toml", "-o", "s.h5", "-q")
        with h5py.File(self.path("s.h5")) as f:
            found = {}
            f.visititems(lambda path, o: found.__setitem__(path, o[()]) if isinstance(o, h5py.Dataset) else None)
        return found

    def read_mesh(self):
        with h5py.File(self.path("plate.h5")) as f:
            xyz, phi = f["mesh/grid_xyz"][()], f["mesh/phi"][()]
            faces = [row for kind in f["mesh/elements"] if kind.startswith(("tri", "quad"))
                     for row in f[f"mesh/elements/{kind}/connectivity"][()]]
        return xyz, phi, faces

    def test_a_flat_plate_is_one_panel_of_its_area(self):
        """The area is that of the mesh; the force and its moment (acceleration of the free body) are those of the panel."""
        flat = {"area": LX * LY, "normal": [0.0, 0.0, 1.0], "position": [LX / 2, 0.0, 0.0], "node": grid(0, 1)}
        for kind, law in (("solar_pressure", SUN), ("drag", AIR)):
            keys = {"rate": WIND}
            one = self.run_system({**law, **flat}, kind, **keys)
            all_ = self.run_system({**law, "elements": "all"}, kind, **keys)
            np.testing.assert_allclose(all_["forces/f/force"][0], one["forces/f/force"][0], rtol=1e-9)
            direction = np.array(SUN["sun"] if kind == "solar_pressure" else WIND[3:])
            self.assertAlmostEqual(all_["forces/f/area"].flat[0] / (LX * LY * abs(direction[2]) / np.linalg.norm(direction)), 1, delta=1e-9)
        half = self.run_system({**SUN, "elements": list(range(1, NX + 1))}, "solar_pressure")
        np.testing.assert_allclose(2 * half["forces/f/force"][0], self.run_system({**SUN, "elements": "all"}, "solar_pressure")
                                   ["forces/f/force"][0], rtol=1e-9)

    def test_deformed_faces_are_those_of_the_grids(self):
        """Sum over faces at p + φ η by NumPy."""
        with h5py.File(self.path("plate.h5")) as f:
            n = f["mesh/phi"].shape[2]
        eta = 0.3 * np.cos(np.arange(1, n + 1.0))
        xyz, phi, faces = self.read_mesh()
        r = xyz + phi @ eta
        self.assertGreater(np.abs(phi @ eta).max(), 0.02)
        sun = np.array(SUN["sun"]) / np.linalg.norm(SUN["sun"])
        force, area = np.zeros(3), 0.0
        for face in faces:
            c = r[face]
            a = 0.5 * (np.cross(c[1] - c[0], c[2] - c[0]) if len(face) == 3 else np.cross(c[2] - c[0], c[3] - c[1]))
            size = np.linalg.norm(a)
            normal = a / size * np.sign(a @ sun)
            cosine = normal @ sun
            area += size * cosine
            force -= SUN["pressure"] * size * cosine * (0.7 * sun + 2 * (0.3 * cosine + 0.2 / 3) * normal)
        found = self.run_system({**SUN, "elements": "all"}, "solar_pressure", eta=eta)
        np.testing.assert_allclose(found["forces/f/force"][0], force, rtol=1e-6)
        self.assertAlmostEqual(found["forces/f/area"].flat[0] / area, 1, delta=1e-6)

    def test_power_of_the_faces_is_the_work_of_the_run(self):
        """Shares on corners and modes: the work of a short time is Σ f·v of the faces by NumPy, deformation moving."""
        xyz, phi, faces = self.read_mesh()
        n = phi.shape[2]
        eta, eta_dot = 0.05 * np.cos(np.arange(1, n + 1.0)), 3.0 * np.sin(np.arange(1, n + 1.0))
        rate = np.array([0.2, 1.0, -0.5, 30.0, 10.0, -60.0])
        step = 1e-6
        text = make_system({"coefficient": 2.2, "density": 1.0, "elements": "all"}, "drag", eta=eta, rate=rate.tolist(), duration=step)
        self.write("s.toml", text.replace("eta = ", f"eta_dot = {eta_dot.tolist()}\neta = "))
        self.bough("run", "s.toml", "-o", "s.h5", "-q")
        r = xyz + phi @ eta
        v = rate[3:] + np.cross(rate[:3], r) + phi @ eta_dot
        power = 0.0
        for face in faces:
            c, u = r[face], v[face].mean(axis=0)
            a = 0.5 * (np.cross(c[1] - c[0], c[2] - c[0]) if len(face) == 3 else np.cross(c[2] - c[0], c[3] - c[1]))
            power -= 0.5 * 2.2 * abs(a @ u) * (u @ u)
        work, = self.read_arrays("s.h5", "/energy/work")
        self.assertAlmostEqual((work.flat[-1] - work.flat[0]) / step / power, 1, delta=2e-3)

    def test_one_sided_faces_have_a_dark_side(self):
        front = self.run_system({**SUN, "elements": "all", "one_sided": True}, "solar_pressure")
        self.assertGreater(front["forces/f/area"].flat[0], 1.0)
        back = self.run_system({**SUN, "sun": [0.3, -0.2, -0.9], "elements": "all", "one_sided": True}, "solar_pressure")
        self.assertEqual(np.abs(back["forces/f/force"]).max(), 0.0)
        wake = self.run_system({**AIR, "elements": "all", "one_sided": True}, "drag", rate=WIND)
        self.assertEqual(np.abs(wake["forces/f/force"]).max(), 0.0)

    def test_the_shadow_of_the_planet_falls_on_the_faces(self):
        earth = table("force", "earth", "gravity_central", mu=MU, radius=6.378e6)
        for x, light in ((7e6, 1.0), (-7e6, 0.0)):
            found = self.run_system({**SUN, "sun": [1.0, 0.0, 0.1], "elements": "all", "planet": "earth"}, "solar_pressure", more=earth,
                                    position=[1.0, 0.0, 0.0, 0.0, x, 0.0, 0.0], rate=(0, 0, 0, 0, math.sqrt(MU / 7e6), 0.0))
            self.assertEqual(found["forces/f/sunlight"].flat[0], light)
            self.assertEqual(np.abs(found["forces/f/force"][0]).max() > 0, light > 0)

    def test_what_has_no_faces_is_named(self):
        for force, error in (({**SUN, "elements": [99]}, "has element 99, which is no shell"),
                             ({**SUN, "elements": "every"}, "toml.bad-value"),
                             ({**SUN, "elements": "all", "area": 2.0}, "toml.conflicting-keys"),
                             (SUN, "missing key 'area'")):
            self.write("bad.toml", make_system(force, "solar_pressure"))
            self.assertIn(error, self.bough("check", "bad.toml", code=1).stderr)
        rigid = make_system({**SUN, "elements": "all"}, "solar_pressure").replace('file = "plate.h5"', "mass = 1.0").replace(
            f"child_node = {grid(0, 1)}\n", "")
        self.write("bad.toml", rigid)
        self.assertIn("is rigid", self.bough("check", "bad.toml", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
