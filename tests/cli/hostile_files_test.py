"""HDF5 files that were damaged or made to do harm: refused with a message, soon, and nothing outside them is read."""
import os
import random
import resource
import shutil
import struct

import h5py
import numpy
import scipy.io
import scipy.sparse

from support import HANG, PROGRAM, SLOWER, ProgramTest, served, unittest


class HostileFiles(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.maker = ProgramTest()
        cls.maker.setUp()
        cls.maker.copy_example("ex01-spinup")
        cls.maker.bough("reduce", "boom.toml")
        with open(cls.maker.path("spinup.toml")) as f:
            text = f.read().replace("duration = 20.0", "duration = 2.0")
        cls.maker.write("short.toml", text)
        cls.maker.bough("run", "short.toml", "-o", "r.h5")
        cls.maker.write("spinup.toml", text.replace("duration = 2.0", "duration = 3.0"))

    @classmethod
    def tearDownClass(cls):
        cls.maker.doCleanups()

    def setUp(self):
        super().setUp()
        for name in ("boom.h5", "r.h5", "spinup.toml"):
            shutil.copy(self.maker.path(name), self.folder)

    READ_RESULTS = [["info", "r.h5"], ["check", "r.h5"], ["export", "r.h5", "--to", "csv", "-o", "x.csv"],
                    ["plot", "r.h5", "--sensor", "tip_deflection:y", "-o", "x.svg"],
                    ["report", "r.h5", "-o", "x.html"],
                    ["run", "spinup.toml", "-o", "r.h5", "--resume"]]
    READ_BODY = [["info", "boom.h5"], ["check", "boom.h5"], ["flx", "boom.h5", "-o", "x.FLX"], ["compare", "boom.h5"],
                 ["report", "boom.h5", "-o", "x.html"],
                 ["run", "spinup.toml", "-o", "new.h5"]]

    def get_bytes(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()

    def read(self, words):
        """In little memory, without a crash."""
        limit = None if SLOWER > 1 else (resource.RLIMIT_DATA, 3 << 30)
        result = served.run([PROGRAM, *words], cwd=self.folder, timeout=HANG, errors="replace", limit=limit)
        self.assertIn(result.returncode, (0, 1, 3), (words, result.stderr[-500:]))
        return result

    def refused(self, commands, error, says=()):
        for words in commands:
            result = self.read(words)
            self.assertEqual(result.returncode, 1, (words, result.stderr))
            self.assertIn(f"[{error}]", result.stderr, words)
            for word in says:
                self.assertIn(word, result.stderr, words)

    def test_system_text_is_one_text(self):
        for count in (2, 100, 5000):
            with h5py.File(self.path("r.h5"), "a") as f:
                del f["system"]
                f["system"] = ["a = 1"] * count
            self.refused(self.READ_RESULTS[1:], "hdf5.shape", [f"/system has the shape {count}"])

    def test_checksum_is_one_number(self):
        with h5py.File(self.path("r.h5"), "a") as f:
            for state in ("checkpoint/state", "checkpoint/previous/state"):
                if state in f:
                    f[state].attrs["checksum"] = numpy.arange(8000)
        self.refused(self.READ_RESULTS[-1:], "hdf5.damaged")

    def test_dataset_of_itself(self):
        layout = h5py.VirtualLayout(shape=(100,), dtype="f8")
        layout[:] = h5py.VirtualSource(".", "energy/self", shape=(100,))
        with h5py.File(self.path("r.h5"), "a") as f:
            f.create_virtual_dataset("energy/self", layout)
        self.refused(self.READ_RESULTS, "hdf5.outside", ["/energy/self is a virtual dataset"])

    def test_other_files_are_not_read(self):
        self.write("secret.bin", "12345678" * 100)
        with h5py.File(self.path("other.h5"), "w") as f:
            f["secret"] = numpy.arange(3.0)
        whole = self.path("whole.h5")
        shutil.copy(self.path("boom.h5"), whole)
        with h5py.File(self.path("boom.h5"), "a") as f:
            del f["rigid/mass"]
            f.create_dataset("rigid/mass", shape=(1,), dtype="f8", external=[("secret.bin", 0, 8)])
        self.refused(self.READ_BODY, "hdf5.outside", ["/rigid/mass is stored in another file"])
        shutil.copy(whole, self.path("boom.h5"))
        with h5py.File(self.path("boom.h5"), "a") as f:
            del f["rigid/mass"]
            f["rigid/mass"] = h5py.ExternalLink("other.h5", "secret")
        self.refused(self.READ_BODY, "hdf5.outside", ["/rigid/mass is a link to another file"])
        before = self.get_bytes("other.h5")
        with h5py.File(self.path("r.h5"), "a") as f:
            f.move("checkpoint", "old")
            f["checkpoint"] = h5py.ExternalLink("other.h5", "/")
        self.refused(self.READ_RESULTS, "hdf5.outside")
        self.assertEqual(self.get_bytes("other.h5"), before)

    def test_pipe_is_no_file(self):
        os.mkfifo(self.path("pipe.h5"))
        for words in (["info", "pipe.h5"], ["export", "pipe.h5", "--to", "csv"], ["check", "pipe.h5"],
                      ["run", "spinup.toml", "-o", "pipe.h5"], ["run", "spinup.toml", "-o", "pipe.h5", "--resume"]):
            self.assertNotEqual(self.read(words).returncode, 0)
        os.remove(self.path("boom.h5"))
        os.rename(self.path("pipe.h5"), self.path("boom.h5"))
        self.assertNotEqual(self.read(["run", "spinup.toml", "-o", "x.h5"]).returncode, 0)

    def test_groups_that_hold_themselves(self):
        with h5py.File(self.path("r.h5"), "a") as f:
            for k in range(8):
                f[f"energy/hard{k}"] = f["/"]
                f[f"energy/soft{k}"] = h5py.SoftLink("/")
        for words in self.READ_RESULTS[:5]:
            self.assertEqual(self.read(words).returncode, 0, words)
        with h5py.File(self.path("r.h5"), "a") as f:
            f.create_group("/".join("d" * 200))
        self.refused(self.READ_RESULTS, "hdf5.damaged", ["nested deeper than"])

    def test_claims_of_size(self):
        whole = self.path("whole.h5")
        shutil.copy(self.path("r.h5"), whole)

        def spoil(path, shape, **more):
            shutil.copy(whole, self.path("r.h5"))
            with h5py.File(self.path("r.h5"), "a") as f:
                if path in f:
                    del f[path]
                f.create_dataset(path, shape=shape, **more)

        for path, shape, more in (("events/time", (10**9,), {"dtype": "f8"}),
                                  ("energy/more", (2001, 600000), {"dtype": "f8", "chunks": (16, 1000)}),
                                  ("energy/more", (10**9,), {"dtype": "f8", "chunks": (10**8,)}),
                                  ("events/what", (10**9,), {"dtype": h5py.string_dtype(), "chunks": (1000,)})):
            spoil(path, shape, **more)
            self.refused(self.READ_RESULTS, "hdf5.damaged", ["claims"])
        # Many that claim little each.
        shutil.copy(whole, self.path("r.h5"))
        with h5py.File(self.path("r.h5"), "a") as f:
            for k in range(40):
                f.create_dataset(f"energy/more{k}", shape=(500000,), dtype="f8", chunks=(1000,))
        self.refused(self.READ_RESULTS, "hdf5.damaged", ["claims"])
        with h5py.File(self.path("boom.h5"), "a") as f:
            del f["nodes/id"]
            f.create_dataset("nodes/id", shape=(4 * 10**8,), dtype="i4")
        self.refused(self.READ_BODY, "hdf5.damaged", ["/nodes/id claims"])
        # Zeros that are compressed are no claim.
        with h5py.File(self.path("r.h5"), "w") as f, h5py.File(whole) as old:
            for name in old:
                old.copy(name, f)
            f.attrs.update(old.attrs)
            f.create_dataset("energy/zeros", data=numpy.zeros((201, 20000)), compression="gzip", chunks=True)
        self.assertEqual(self.read(self.READ_RESULTS[2]).returncode, 0)

    def test_bits_that_fell_over(self):
        draw = random.Random(7)
        for name, commands in (("r.h5", self.READ_RESULTS), ("boom.h5", self.READ_BODY)):
            whole = bytearray(self.get_bytes(name))
            # Heads, attributes and heaps lie between the data: the bytes that are not part of a long run of numbers.
            for k in range(25):
                bytes_ = bytearray(whole)
                for _ in range(draw.choice((1, 1, 3, 20))):
                    at = draw.randrange(min(len(bytes_), 60000))
                    bytes_[at] = draw.choice((0, 255, bytes_[at] ^ (1 << draw.randrange(8)), draw.randrange(256)))
                with open(self.path(name), "wb") as f:
                    f.write(bytes_)
                self.read(commands[k % len(commands)])

    def test_references_of_texts_lead_to_texts(self):
        """A number, a length or a place in the heap of texts that is wrong: the library itself copies what is there."""
        whole = self.get_bytes("boom.h5")
        heap = whole.rindex(b"GCOL")  # the last one has room left
        objects, at = {}, heap + 16
        while (head := struct.unpack_from("<HHIQ", whole, at))[0]:
            objects[head[0]] = (at, head[3])
            at += 16 + (head[3] + 7) // 8 * 8
        number = max(objects, key=lambda n: objects[n][1])
        place, length = objects[number]
        reference = whole.index(struct.pack("<IQI", length, heap, number))
        changes = {"number": (reference + 12, "<I", 60000), "length": (reference, "<I", length - 1),
                   "heap": (reference + 4, "<Q", heap + 8), "far heap": (reference + 4, "<Q", 1 << 40),
                   "size": (place + 8, "<Q", len(whole)), "size beyond the heap": (place + 8, "<Q", 1 << 62),
                   "end of the heap": (at + 8, "<Q", 1 << 20), "size of the heap": (heap + 8, "<Q", len(whole))}
        for what, (where, kind, value) in changes.items():
            with self.subTest(what):
                bytes_ = bytearray(whole)
                struct.pack_into(kind, bytes_, where, value)
                with open(self.path("boom.h5"), "wb") as f:
                    f.write(bytes_)
                self.refused(self.READ_BODY[:2], "hdf5.damaged")

    def test_matlab_files(self):
        shutil.copy(self.maker.path("boom.bdf"), self.folder)
        self.bough("matrices", "boom.bdf", "--no-kg", "-o", "k.h5")
        self.write("given.toml", '[body]\ndeck = "boom.bdf"\n[body.modes]\nnumber = 3\n[body.matrices]\n'
                   'file = "k.h5"\nmodes = "phi.mat:PHI"\n')
        # Version 7.3 is HDF5 behind 512 bytes: nothing outside it is read either.
        self.write("secret.bin", "12345678" * 100)
        with h5py.File(self.path("phi.mat"), "w", userblock_size=512) as f:
            phi = f.create_dataset("PHI", shape=(2, 3), dtype="f8", external=[("secret.bin", 0, 48)])
            phi.attrs["MATLAB_class"] = numpy.bytes_("double")
        with open(self.path("phi.mat"), "r+b") as f:
            f.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM")
        self.refused([["reduce", "given.toml", "-o", "x.h5"]], "hdf5.outside", ["/PHI is stored in another file"])
        # The library asks for the names of a struct as they claim to be long, and breaks on some.
        scipy.io.savemat(self.path("phi.mat"), {"model": {"PHI": numpy.eye(3), "K": numpy.eye(2)},
                                                "S": scipy.sparse.eye(4).tocsc()})
        whole = self.get_bytes("phi.mat")
        draw = random.Random(3)
        for _ in range(40):
            bytes_ = bytearray(whole)
            for _ in range(draw.choice((1, 2, 4))):
                bytes_[128 + draw.randrange(len(bytes_) - 128)] = draw.choice((0, 1, 127, 255, draw.randrange(256)))
            with open(self.path("phi.mat"), "wb") as f:
                f.write(bytes_)
            result = self.read(["reduce", "given.toml", "-o", "x.h5"])
            self.assertEqual(result.returncode, 1)
            self.assertIn("phi.mat", result.stderr)

    def test_files_that_crash_the_library(self):
        folder = os.path.join(os.environ.get("BOUGH_SHARED_DIR", ""), "cases/robust")
        names = [n for n in ("vds-self/X.h5", "h5-attr-flip/X.h5", "h5-results-check-33/X.h5", "cycle/X.h5",
                             "h5-results-check-52/X.h5", "sec-system-array-100.h5", "sec-checksum-array-1000.h5",
                             "mem-results-bomb.h5", "mem-body-grids.h5", "interface-flood/X.h5")
                 if os.path.exists(os.path.join(folder, n))]
        if not names:
            self.skipTest("the folder of shared cases is not there")
        for name in names:
            for verb in (["info"], ["check"], ["export", "--to", "csv", "-o", "x.csv"]):
                result = self.read([verb[0], os.path.join(folder, name), *verb[1:]])
                self.assertLess(len(result.stderr), 20000)


if __name__ == "__main__":
    unittest.main()
