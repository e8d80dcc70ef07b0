"""bough convert of system, body and flexible-body files: the same motion in other units."""
import os
import re
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import read_toml, table


TO_MM_KG = ("--units", "m-kg-s:mm-kg-s")  # another unit of force too
SI_TO_MM = ("--units", "m-kg-s:mm-N-tonne")
ALL = read_toml("whole_system.toml")


def calc_factor(dims, mass, length, time):
    """Factor of "M L^2/T^2": a separate oracle, from the dimensions in the results."""
    factor, sign = 1.0, 1
    units = {"M": mass, "L": length, "T": time, "F": mass * length / time**2, "E": mass**0.5 * length, "1": 1.0}
    for word in re.findall(r"[A-Z1](?:\^-?[0-9.]+)?|/|\(|\)", dims):
        if word == "/":
            sign = -1
        elif word not in "()":
            name, _, power = word.partition("^")
            factor *= units[name] ** (sign * float(power or 1))
    return factor


def split(dims, columns):
    parts = dims.split(", ")
    return parts * columns if len(parts) == 1 else parts


class ConvertUnits(ProgramTest):
    def read_channels(self, name):
        channels = {}

        def visit(path, item):
            is_filled = isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and item.size and item.shape
            if is_filled and "dims" in item.attrs:
                channels[path] = (item[:].reshape(item.shape[0], -1), item.attrs["dims"])
        with h5py.File(self.path(name)) as f:
            f.visititems(visit)
        return channels

    def compare(self, old, new, mass, length, time, least=10, tolerance=1e-10, without=()):
        """Every channel whose dimensions are known agrees, to `tolerance` of its largest value or of 1."""
        a, b, seen = self.read_channels(old), self.read_channels(new), 0
        self.assertEqual(set(a), set(b))
        for path, (values, dims) in a.items():
            parts = split(str(dims), values.shape[1])
            if path.startswith(("checkpoint", "recovery/elements")) or path in without or len(parts) != values.shape[1]:
                continue
            if any(re.search(r"[a-z]", part) for part in parts):
                continue
            factors = np.array([calc_factor(part, mass, length, time) for part in parts])
            # Zeros are sums that cancel: rounding of numbers of the size of 1 in the old units.
            np.testing.assert_allclose(b[path][0] / factors, values, rtol=0, err_msg=path,
                                       atol=tolerance * max(np.abs(values).max(), 1.0))
            seen += 1
        self.assertGreaterEqual(seen, least)

    def run_both(self, system, bodies=(), units=SI_TO_MM, more=()):
        os.makedirs(self.path("new"), exist_ok=True)
        for body in bodies:
            self.bough("convert", body, *units, "-o", "new/" + body)
        self.bough("convert", system, *units, *more, "-o", "new/" + system)
        self.bough("run", system, "-o", "old.h5", "-q")
        self.bough("run", "new/" + system, "-o", "new.h5", "-q")

    def make_all(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-q")
        self.write("all.toml", ALL)

    def test_a_system_of_everything_moves_alike(self):
        self.make_all()
        self.run_both("all.toml", ["boom.h5"])
        # Outputs of a controller have the unit of their user: here forces.
        self.compare("old.h5", "new.h5", 1e-3, 1e3, 1.0, least=25)
        with h5py.File(self.path("old.h5")) as a, h5py.File(self.path("new.h5")) as b:
            np.testing.assert_allclose(b["controllers/law"][:], a["controllers/law"][:], rtol=1e-9, atol=1e-9)
            self.assertEqual(len(a["events/time"]), len(b["events/time"]))

    def test_another_unit_of_time_and_radians(self):
        self.make_all()
        self.run_both("all.toml", ["boom.h5"], ("--units", "m-kg-s:mm-g-ms"), ("--radians",))
        self.compare("old.h5", "new.h5", 1e3, 1e3, 1e3, least=25)
        with open(self.path("new/all.toml")) as f:
            text = f.read()
        self.assertNotIn("_deg", text)
        self.assertIn("# degrees, m", text)
        self.assertIn("# the whole set", text)

    def test_another_unit_of_force(self):
        self.make_all()
        self.run_both("all.toml", ["boom.h5"], TO_MM_KG)
        self.compare("old.h5", "new.h5", 1.0, 1e3, 1.0, least=25)

    def test_radians_alone_change_nothing_else(self):
        self.make_all()
        self.bough("convert", "all.toml", "--radians", "-o", "rad.toml")
        with open(self.path("rad.toml")) as f:
            new = f.read().split("\n")
        differ = [(a, b) for a, b in zip(ALL.split("\n"), new) if a != b]
        self.assertEqual([b.split(" ")[0] for _, b in differ], ["position", "amplitude"])
        self.assertEqual(differ[0][1], "position = [0.174532925199433, 0.2]   # degrees, m")

    def test_a_flexible_body_by_its_own_dims_and_back(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "--recover", "all", "--full", "-q", "-o", "boom.h5")
        self.bough("convert", "boom.h5", *SI_TO_MM, "-o", "mm.h5")
        self.compare("boom.h5", "mm.h5", 1e-3, 1e3, 1.0, least=15, tolerance=1e-13,
                     without=("effective_mass", "modes/phi", "full/phi"))
        self.bough("convert", "mm.h5", "--units", "mm-N-tonne:m-kg-s", "-o", "back.h5")
        a, b = self.read_channels("boom.h5"), self.read_channels("back.h5")
        for path in a:
            np.testing.assert_allclose(b[path][0], a[path][0], rtol=1e-12, err_msg=path)
        # The deck in the same units, reduced: the same body, mode shapes up to their sign.
        self.bough("convert", "boom.bdf", *SI_TO_MM, "-o", "mm.bdf")
        with open(self.path("boom.toml")) as f:
            text = f.read()
        self.write("again.toml", text.replace("boom.bdf", "mm.bdf").replace('file = "boom.h5"', 'file = "again.h5"'))
        self.bough("reduce", "again.toml", "--recover", "all", "--full", "-q", "-o", "again.h5")
        a, b = self.read_channels("mm.h5"), self.read_channels("again.h5")
        for path in a:
            if path in ("modes/eigenvalue", "modal/mass", "modal/stiffness", "rigid/inertia", "inertial_loads/f",
                        "recovery/elements/CBAR/matrix", "stiffening/load_resultant", "effective_mass"):
                np.testing.assert_allclose(np.abs(b[path][0]), np.abs(a[path][0]), rtol=0, err_msg=path,
                                           atol=1e-7 * np.abs(a[path][0]).max())

    def test_body_file(self):
        self.copy_example("ex01-spinup")
        with open(self.path("boom.toml")) as f:
            text = f.read()
        text = text.replace("number = 3", "max_frequency = 20.0").replace(
            "[body.output]", "[body.damping]\nrayleigh = [0.1, 0.002]  # alpha, beta\n[body.output]")
        self.write("boom.toml", text)
        os.mkdir(self.path("ms"))
        units = ("--units", "m-kg-s:mm-kg-ms")
        for name in ("boom.toml", "boom.bdf"):
            self.bough("convert", name, *units, "-o", "ms/" + name)
        self.bough("reduce", "boom.toml", "-q")
        self.bough("reduce", "ms/boom.toml", "-q")
        with h5py.File(self.path("boom.h5")) as a, h5py.File(self.path("ms/boom.h5")) as b:
            np.testing.assert_allclose(b["modes/frequency_hz"][:], 1e-3 * a["modes/frequency_hz"][:], rtol=1e-9)
            np.testing.assert_allclose(b["modal/damping"][:].diagonal(), 1e-3 * a["modal/damping"][:].diagonal(),
                                       rtol=1e-9)
        with open(self.path("ms/boom.toml")) as f:
            self.assertIn("[0.0001, 2.0]  # alpha, beta", f.read())

    def test_what_cannot_be_converted_is_named_and_nothing_is_written(self):
        self.make_all()
        law = table("controller", "own", "library", file="law.so", inputs=["travel"], outputs=1)
        for old, new, error in [
                ("mass = 1.5", 'mass = "$drop"', "toml.unit-parameter"),
                ("[[event]]", law + "[[event]]", "toml.unit-file"),
                ('inputs = ["travel"]\nreference', 'inputs = ["hub_turn"]\nreference', "toml.unit-signal"),
                ('"node41_y"\nfunction = "tug"', '"node41_y"\nfunction = "swing"', "toml.unit-use"),
                ("boom.h5", "gone.h5", "toml.unit-locator")]:
            with self.subTest(error):
                self.write("bad.toml", ALL.replace(old, new))
                self.fails(1, "convert", "bad.toml", *TO_MM_KG, "-o", "no.toml", says=["bad.toml:"], error=error)
                self.assertFalse(os.path.exists(self.path("no.toml")))
        self.write("tolerance.toml", ALL.replace("[simulation]", "[simulation]\nabsolute_tolerance = 1e-9"))
        said = self.bough("convert", "tolerance.toml", *TO_MM_KG, "-o", "t.toml").stderr
        self.assertIn("[toml.unit-tolerance]", said)

    def test_examples(self):
        for example, system, bodies in [("ex03-two-link", "two-link.toml", ["link"]),
                                        ("ex07-four-bar", "four-bar.toml", ["coupler"]),
                                        ("ex10-robot-arm", "robot.toml", ["arm"]),
                                        ("ex08-satellite", "pointing.toml", ["wing"])]:
            with self.subTest(example):
                self.copy_example(example)
                for body in bodies:
                    self.bough("reduce", body + ".toml", "-q")
                with open(self.path(system)) as f:
                    text = f.read()
                text = re.sub(r"duration = [0-9.]+", "duration = 0.05", text[text.index("[simulation]"):])
                text = re.sub(r'integrator = "\w+"', 'integrator = "rk4"\nstep = 2e-5', text)
                with open(self.path(system)) as f:
                    head = f.read().split("[simulation]")[0]
                self.write(system, head + text)
                self.run_both(system, [b + ".h5" for b in bodies])
                self.compare("old.h5", "new.h5", 1e-3, 1e3, 1.0, least=8)


if __name__ == "__main__":
    unittest.main()
