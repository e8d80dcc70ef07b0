"""Flat files as bodies of all commands: numbers equal to those of their HDF5 file or .FLX; damaged files."""
import json
import os
import struct
import unittest

import h5py
import numpy as np

from support import ProgramTest


def read_flat(path):
    """The page docs/formats/flat.md as a reader: {name: array, or bytes of a text}."""
    with open(path, "rb") as f:
        data = f.read()
    kinds = {"float64": "<f8", "float32": "<f4", "int32": "<i4", "text": "S1"}
    head, at = data.split(b"\n", 1)[0], data.index(b"\n") + 1
    assert head == b"bough-flat 1", head
    checksum = 0xcbf29ce484222325
    for byte in data[:-21]:
        checksum = (checksum ^ byte) * 0x100000001b3 % 2 ** 64
    assert data[-21:] == b"end %016x\n" % checksum
    arrays = {}
    while at < len(data) - 21:
        end = data.index(b"\n", at)
        name, kind, rank, *shape = data[at:end].decode().split(" ")
        shape = [int(n) for n in shape]
        assert len(shape) == int(rank)
        kind = np.dtype(kinds[kind])
        size = kind.itemsize * int(np.prod(shape, dtype=int))
        block = data[end + 1:end + 1 + size]
        arrays[name] = block if kind.kind == "S" else np.frombuffer(block, kind).reshape(shape)
        at = end + 1 + size
    return arrays


class FlatBody(ProgramTest):
    def setUp(self):
        super().setUp()
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-o", "boom.h5", "-q")
        with open(self.path("spinup.toml")) as f:
            system = f.read().split("[simulation]")[0]
        self.system = system + '[simulation]\nintegrator = "rk4"\nduration = 0.5\nstep = 1e-3\noutput_step = 0.05\n'
        self.bough("export", "boom.h5", "--to", "flat", "-o", "boom.flat")

    def run_with(self, body):
        self.assertIn('file = "boom.h5"', self.system)
        self.write("s.toml", self.system.replace('file = "boom.h5"', f'file = "{body}"'))
        self.bough("run", "s.toml", "-o", "r.h5", "-q")
        found = {}
        with h5py.File(self.path("r.h5")) as f:
            f.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset)
                         and item.dtype.kind == "f" else None)
        return found

    def expect_equal(self, a, b):
        self.assertGreater(len(a), 5)
        self.assertEqual(a.keys(), b.keys())
        for name in a:
            np.testing.assert_array_equal(a[name], b[name], name)

    def test_a_run_is_equal_bit_for_bit(self):
        expected = self.run_with("boom.h5")
        self.expect_equal(self.run_with("boom.flat"), expected)
        # Contents identify the file: any name will do.
        os.rename(self.path("boom.flat"), self.path("boom.body"))
        self.expect_equal(self.run_with("boom.body"), expected)

    def test_arrays_are_those_of_the_hdf5_file(self):
        arrays = read_flat(self.path("boom.flat"))
        seen = 0
        with h5py.File(self.path("boom.h5")) as f:
            def look(name, item):
                nonlocal seen
                if isinstance(item, h5py.Dataset) and item.dtype.kind in "fi" and "/" + name in arrays:
                    # Numbers of modes count from 0 there (docs/formats/flat.md).
                    base = 1 if name in ("next_order/modes", "third_order/large") else 0
                    np.testing.assert_array_equal(arrays["/" + name].ravel() + base, item[()].ravel(), name)
                    seen += 1
            f.visititems(look)
            for i, load in enumerate(f["stiffening/kg_inertial"].attrs["loads"]):
                np.testing.assert_array_equal(arrays["/stiffening/kg_inertial/" + load], f["stiffening/kg_inertial"][i])
            for name in ("/modes/phi", "/integrals/exact/gamma2", "/integrals/exact/gamma4", "/rigid/inertia"):
                self.assertEqual(arrays[name].shape, f[name].shape)
            self.assertEqual(arrays["/name"].decode(), f.attrs["name"])
        self.assertGreater(seen, 25)

    def test_other_verbs_take_it(self):
        self.assertIn('flexible body "boom"', self.bough("check", "boom.flat").stdout)
        self.assertEqual(self.bough("check", "boom.flat").stdout, self.bough("check", "boom.h5").stdout)
        self.assertEqual(json.loads(self.bough("check", "boom.flat", "--json").stdout)["kind"], "bough-flexbody")
        info = json.loads(self.bough("info", "boom.flat", "--json").stdout)
        self.assertEqual(info["attributes"]["format"], "bough-flat")
        objects = {o["path"]: o for o in info["objects"]}
        n = objects["/modes/eigenvalue"]["shape"]
        self.assertEqual(objects["/modal/mass"]["shape"], f"{n} x {n}")
        self.assertEqual(objects["/rigid/mass"]["shape"], "scalar")
        self.assertIn("/modal/mass", self.bough("info", "boom.flat").stdout)
        for pair in json.loads(self.bough("compare", "boom.h5", "boom.flat", "--json").stdout)["pairs"]:
            self.assertEqual(pair["difference"], 0)
        self.bough("flx", "boom.h5", "--digits", 17, "--stiffening", "-o", "a.FLX")
        self.bough("flx", "boom.flat", "--digits", 17, "--stiffening", "-o", "b.FLX")
        with open(self.path("a.FLX"), "rb") as a, open(self.path("b.FLX"), "rb") as b:
            self.assertEqual(a.read(), b.read())
        self.bough("report", "boom.flat", "-o", "page.html")
        for to in ("csv", "mat", "op4", "uff", "sid", "mbdyn", "vtu", "flat"):
            self.bough("export", "boom.h5", "--to", to, "-o", "a." + to)
            self.bough("export", "boom.flat", "--to", to, "-o", "b." + to)
            with open(self.path("a." + to), "rb") as a, open(self.path("b." + to), "rb") as b:
                if to not in ("mat", "mbdyn"):    # which have a time or the name of the file in them
                    self.assertEqual(a.read(), b.read(), to)
        self.bough("convert", "boom.flat", "--units", "m-kg-s:mm-kg-s", "-o", "mm.flat")
        self.bough("convert", "boom.h5", "--units", "m-kg-s:mm-kg-s", "-o", "mm.h5")
        self.bough("export", "mm.h5", "--to", "flat", "-o", "mm2.flat")
        with open(self.path("mm.flat"), "rb") as a, open(self.path("mm2.flat"), "rb") as b:
            self.assertEqual(a.read(), b.read())

    def test_of_an_flx(self):
        self.bough("flx", "boom.h5", "--digits", 17, "--stiffening", "-o", "boom.FLX")
        self.bough("export", "boom.FLX", "--to", "flat", "-o", "other.flat")
        self.expect_equal(self.run_with("other.flat"), self.run_with("boom.FLX"))

    def test_files_that_are_none(self):
        with open(self.path("boom.flat"), "rb") as f:
            data = f.read()
        with open(self.path("cut.flat"), "wb") as f:
            f.write(data[:len(data) // 2])
        with open(self.path("new.flat"), "wb") as f:
            f.write(data.replace(b"bough-flat 1", b"bough-flat 9", 1))
        at = data.index(b"/rigid/mass float64 0\n") + 22
        with open(self.path("wrong.flat"), "wb") as f:
            f.write(data[:at] + struct.pack("<d", -1.0) + data[at + 8:])
        self.fails(1, "check", "cut.flat", error="flat.damaged")
        self.fails(1, "check", "wrong.flat", error="flat.damaged")
        self.fails(1, "check", "new.flat", error="flat.version")
        self.write("s.toml", self.system.replace("boom.h5", "cut.flat"))
        self.fails(1, "run", "s.toml", "-o", "r.h5", error="flat.damaged")
        self.fails(1, "info", "cut.flat", error="flat.damaged")
        self.write("s.toml", self.system.replace("boom.h5", "none.flat"))
        result = self.fails(1, "run", "s.toml", "-o", "r.h5", error="cli.no-body-file")
        self.assertIn("bough export BODY.h5 --to flat -o none.flat", result.stderr)
        self.fails(1, "export", "boom.flat", "--to", "flat", "-o", "./boom.flat", error="cli.output-is-input")


if __name__ == "__main__":
    unittest.main()
