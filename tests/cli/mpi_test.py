"""Equal numbers on one process and on two."""
import json
import os
import signal
import subprocess
import sys
import unittest

import h5py
import numpy as np

from support import HANG, PROGRAM, SOURCE, ProgramTest, launch_ranks


class Ranks(ProgramTest):
    def setUp(self):
        super().setUp()
        self.copy_example("ex01-spinup")

    def test_modes(self):
        found = [json.loads(self.bough("modes", "boom.bdf", "-n", 5, "--json", launcher=launch_ranks("-n", n)).stdout) for n in (1, 2)]
        np.testing.assert_allclose(found[1]["eigenvalue"], found[0]["eigenvalue"], rtol=1e-9)
        np.testing.assert_allclose(found[1]["effective_mass"], found[0]["effective_mass"], atol=1e-8)

    def test_a_range_without_a_mode(self):
        for n in (1, 2):
            result = self.bough("modes", "boom.bdf", "--max-hz", 1e-3, "--json", "-o", "m.h5", launcher=launch_ranks("-n", n))
            self.assertEqual([], json.loads(result.stdout)["frequency_hz"])
            self.assertIn("[modal.empty-range]", result.stderr)

    def test_frequency(self):
        """A beam with a damper, residual vectors of its load and of the damper."""
        with open(self.path("boom.bdf")) as f:
            deck = f.read()
        self.write("driven.bdf", deck.replace("BEGIN BULK", "DLOAD = 901\nFREQUENCY = 902\nDISPLACEMENT = ALL\nBEGIN BULK\n"
                                              "RLOAD1,901,903,,,1.\nDAREA,903,11,2,1.\nFREQ1,902,0.,.5,10\nPARAM,G,.02\n"
                                              "CDAMP2,99001,.5,11,3"))
        found = []
        for n in (1, 2):
            self.bough("frequency", "driven.bdf", "-n", 6, "-o", f"r{n}.h5", launcher=launch_ranks("-n", n))
            with h5py.File(self.path(f"r{n}.h5")) as f:
                subcase = next(iter(f["subcases"].values()))
                found.append(subcase["displacement/real"][()] + 1j * subcase["displacement/imag"][()])
        self.assertGreater(np.abs(found[0]).max(), 0)
        np.testing.assert_allclose(found[1], found[0], atol=1e-8 * np.abs(found[0]).max())

    def test_reduce(self):
        for n in (1, 2):
            self.bough("reduce", "boom.toml", "-o", f"boom{n}.h5", launcher=launch_ranks("-n", n))
        with h5py.File(self.path("boom1.h5")) as a, h5py.File(self.path("boom2.h5")) as b:
            self.assertEqual(sorted(a), sorted(b))
            for path in ["/modes/eigenvalue", "/modes/phi", "/stiffening/kg_inertial", "/stiffening/kg_external",
                         "/integrals/exact/gamma0", "/integrals/exact/gamma4", "/rigid/inertia"]:
                scale = max(np.abs(a[path][:]).max(), 1e-300)
                np.testing.assert_allclose(b[path][:] / scale, a[path][:] / scale, atol=1e-7, err_msg=path)

    def test_the_end_that_is_asked_for_is_said_once(self):
        """The first rank is told; the launcher then ends the other one by the same signal."""
        process, ranks = self.start_held("modes", "boom.bdf", "-n", 5, call="MPI_Allreduce", count=10, processes=2,
                                         launcher=launch_ranks("-n", 2))
        for rank in ranks:
            with open(f"/proc/{rank}/environ", "rb") as f:
                if b"OMPI_COMM_WORLD_RANK=0" in f.read().split(b"\0"):
                    os.kill(rank, signal.SIGTERM)
        _, said = process.communicate(timeout=HANG)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(said.count("[cli.interrupted]"), 1, said)

    def test_plate(self):
        deck = subprocess.run([sys.executable, os.path.join(SOURCE, "bench/plate_deck.py"), "7", "--modes", "8"],
                              capture_output=True, text=True, check=True).stdout
        self.write("plate.bdf", deck)
        call = ("modes", "plate.bdf", "--json")
        found = {n: json.loads(self.bough(*call, launcher=launch_ranks("-n", n)).stdout) for n in (1, 2, 3)}
        self.assertEqual(len(found[1]["frequency_hz"]), 8)
        for n in (2, 3):
            np.testing.assert_allclose(found[n]["frequency_hz"], found[1]["frequency_hz"], rtol=1e-8)
            self.assertEqual(found[n]["inertia_count"], found[1]["inertia_count"])
        # Without mpirun a different solver factors the matrix.
        alone = json.loads(self.bough(*call).stdout)
        np.testing.assert_allclose(alone["frequency_hz"], found[2]["frequency_hz"], rtol=1e-8)

    def launch_apart(self, *arguments):
        """Rank 0 in the folder with the files, ranks 1 and 2 in an empty one: only the first may need the disk."""
        os.makedirs(self.path("empty"), exist_ok=True)
        command = launch_ranks()
        for count, folder in ((1, self.folder), (2, self.path("empty"))):
            command += [":"] * (count == 2) + ["-n", str(count), "-wdir", folder, PROGRAM, *map(str, arguments)]
        return subprocess.run(command, cwd=self.folder, text=True, capture_output=True, timeout=HANG)

    def test_one_rank_reads_the_files(self):
        with open(self.path("boom.bdf")) as f:
            head, bulk = f.read().split("BEGIN BULK", 1)
        self.write("boom.bdf", head + "BEGIN BULK\nINCLUDE 'bulk.inc'\nENDDATA\n")
        self.write("bulk.inc", bulk.split("\n", 1)[1].replace("ENDDATA", ""))
        alone = json.loads(self.bough("modes", "boom.bdf", "-n", 4, "--json").stdout)
        result = self.launch_apart("modes", "boom.bdf", "-n", 4, "--json", "-o", "modes.h5")
        self.assertEqual(result.returncode, 0, result.stderr)
        np.testing.assert_allclose(json.loads(result.stdout)["frequency_hz"], alone["frequency_hz"], rtol=1e-8)
        with h5py.File(self.path("modes.h5")) as file:
            self.assertIn("modes", file)
        self.assertEqual(os.listdir(self.path("empty")), [])
        result = self.launch_apart("reduce", "boom.toml", "-o", "boom.h5")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(os.listdir(self.path("empty")), [])

    def test_what_the_first_rank_misses_ends_all(self):
        result = self.launch_apart("modes", "nowhere.bdf")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count("[cli.no-file]"), 1)

    def test_an_error_is_said_once(self):
        self.write("bad.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nENDDATA\n")
        one = self.bough("check", "bad.bdf", code=1).stderr.count("error:")
        two = self.bough("check", "bad.bdf", code=1, launcher=launch_ranks("-n", 2)).stderr
        self.assertEqual(two.count("bad.bdf:5: error:"), self.bough("check", "bad.bdf", code=1).stderr.count("bad.bdf:5: error:"))
        self.assertGreater(one, 0)


if __name__ == "__main__":
    unittest.main()
