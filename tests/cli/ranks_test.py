"""Modes on several ranks are those of one process: frequencies, shapes, effective masses, files, messages, errors."""
import os
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np

from support import HANG, PROGRAM, ProgramTest, launch_ranks


def launch(ranks):
    return launch_ranks("-n", ranks) if ranks > 1 else []


HEAD = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nPARAM,COUPMASS,1\nMAT1,1,2.+11,,.3,8000.\n"


def make_grid_ids(nx, ny):
    return np.arange(1, (nx + 1) * (ny + 1) + 1).reshape(ny + 1, nx + 1)


def write_plate(nx=36, ny=26, more="", held=True):
    """A plate of 6 m x 4 m, clamped on its left edge."""
    ids = make_grid_ids(nx, ny)
    lines = [HEAD if held else HEAD.replace("SPC = 1\n", ""), "PSHELL,1,1,.05,1,,1\n"]
    for (j, i), grid in np.ndenumerate(ids):
        lines.append(f"GRID,{grid},,{6 * i / nx:.6f},{4 * j / ny:.6f},0.\n")
    for j in range(ny):
        for i in range(nx):
            a, b, c, d = ids[j, i], ids[j, i + 1], ids[j + 1, i + 1], ids[j + 1, i]
            lines.append(f"CQUAD4,{j * nx + i + 1},1,{a},{b},{c},{d}\n")
    if held:
        lines += [f"SPC1,1,123456,{grid}\n" for grid in ids[:, 0]]
    return "".join(lines) + more + "ENDDATA\n"


def write_linked():
    """Rigid elements, an RBE3 and an MPC from corner to corner."""
    ids = make_grid_ids(36, 26)
    # The mass of the RBE3 hangs on the middle; a rigid beam joins two opposite edges.
    return write_plate(more="GRID,90001,,3.,2.,.5\nCONM2,90001,90001,,500.\n"
                       f"RBE3,90002,,90001,123456,1.,123,{ids[5, 5]},\n,{ids[5, 31]},{ids[21, 5]},{ids[21, 31]}\n"
                       f"RBE2,90003,{ids[0, 18]},123456,{ids[26, 18]}\n"
                       f"MPC,1,{ids[10, 36]},3,1.,{ids[13, 2]},3,-1.\n").replace("SPC = 1\n", "SPC = 1\nMPC = 1\n")


def write_door(nx, ny):
    """A clamped plate and another that hangs on its edge and swings: one motion without strain behind supports."""
    ids = make_grid_ids(nx, ny)
    lines = []
    for (j, i), grid in np.ndenumerate(ids):
        lines.append(f"GRID,{5000 + grid},,{6 + 5 * i / nx:.6f},{4 * j / ny:.6f},0.\n")
    for j in range(ny):
        for i in range(nx):
            a, b, c, d = (5000 + g for g in (ids[j, i], ids[j, i + 1], ids[j + 1, i + 1], ids[j + 1, i]))
            lines.append(f"CQUAD4,{5000 + j * nx + i},1,{a},{b},{c},{d}\n")
    lines += [f"RBE2,{90000 + j},{ids[j, nx]},12346,{5000 + ids[j, 0]}\n" for j in range(ny + 1)]
    return write_plate(nx, ny, "".join(lines))


def write_grillage(n):
    ids = make_grid_ids(n, n)
    lines = [HEAD, "PBAR,1,1,1.-3,2.-6,3.-6,1.-6\n"]
    for (j, i), grid in np.ndenumerate(ids):
        lines.append(f"GRID,{grid},,{i / n * 10:.6f},{j / n * 8:.6f},0.\n")
    pairs = [(ids[j, i], ids[j, i + 1]) for j in range(n + 1) for i in range(n)]
    pairs += [(ids[j, i], ids[j + 1, i]) for j in range(n) for i in range(n + 1)]
    lines += [f"CBAR,{e},1,{a},{b},0.,0.,1.\n" for e, (a, b) in enumerate(pairs, 1)]
    lines += [f"SPC1,1,123456,{grid}\n" for grid in ids[0]]
    return "".join(lines) + "ENDDATA\n"


def write_block(n):
    ids = np.arange(1, np.prod([k + 1 for k in n]) + 1).reshape([k + 1 for k in n])
    lines = [HEAD, "PSOLID,1,1\n"]
    for (i, j, k), grid in np.ndenumerate(ids):
        lines.append(f"GRID,{grid},,{i / 6:.6f},{j / 7:.6f},{k / 8:.6f}\n")
    element = 0
    for i, j, k in np.ndindex(*n):
        element += 1
        a = [ids[i + x, j + y, k + z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines.append(f"CHEXA,{element},1,{a[0]},{a[1]},{a[2]},{a[3]},{a[4]},{a[5]},\n,{a[6]},{a[7]}\n")
    lines += [f"SPC1,1,123,{grid}\n" for grid in ids[0].ravel()]
    return "".join(lines) + "ENDDATA\n"


class RanksOfModes(ProgramTest):
    def solve(self, ranks, *options, threads=1):
        """Eigenvalues, effective masses, shapes as rows."""
        options = options if "-n" in options else ("-n", 8, *options)
        self.bough("modes", "deck.bdf", "-o", f"r{ranks}.h5", *options, launcher=launch(ranks),
                   env={"OMP_NUM_THREADS": str(threads)})
        with h5py.File(self.path(f"r{ranks}.h5")) as file:
            phi = file["modes/phi"][()]
            return file["modes/eigenvalue"][()], file["effective_mass"][()], phi.reshape(-1, phi.shape[-1]).T

    def compare(self, text, ranks=(2, 3), *options):
        self.write("deck.bdf", text)
        eigenvalue, mass, shape = self.solve(1, *options)
        self.assertEqual(len(eigenvalue), options[options.index("-n") + 1] if "-n" in options else 8)
        for n in ranks:
            found, mass_there, there = self.solve(n, *options, threads=2 if n == 1 else 1)
            np.testing.assert_allclose(found, eigenvalue, rtol=2e-10, atol=1e-10 * np.abs(eigenvalue).max())
            np.testing.assert_allclose(mass_there, mass, rtol=0, atol=1e-6 * np.abs(mass).max())
            mac = np.sum(shape * there, 1) ** 2 / np.sum(shape**2, 1) / np.sum(there**2, 1)
            np.testing.assert_allclose(mac, 1, atol=1e-8, err_msg=f"{n} ranks")

    def test_held_plate(self):
        self.compare(write_plate(26, 19))

    def test_free_plate(self):
        self.compare(write_plate(26, 19, held=False), (2,))

    def test_links(self):
        self.compare(write_linked(), (3,))

    def test_a_door(self):
        self.compare(write_door(22, 22), (2,))

    def test_beams(self):
        self.compare(write_grillage(24), (2,))

    def test_solids(self):
        self.compare(write_block((16, 8, 7)), (3,))

    def test_a_cube(self):
        """A twentieth of the rows lies between the two halves of the threads."""
        self.compare(write_block((20, 20, 19)), (1,))

    def test_fewer_rows_than_a_block(self):
        self.compare(write_plate(8, 6), (3,))

    def test_two_bodies(self):
        """Parts that nothing joins; the other is shorter, so that no root of one is of the other."""
        one = write_plate(40, 13)
        grids = 41 * 14
        other = []
        for line in one.splitlines():
            words = line.split(",")
            if words[0] == "GRID":
                x = f"{0.9 * float(words[3]):.6f}"
                other.append(",".join(["GRID", str(int(words[1]) + grids), "", x, words[4], "9."]))
            elif words[0] == "CQUAD4":
                corners = [str(int(word) + grids) for word in words[3:]]
                other.append(",".join(["CQUAD4", str(int(words[1]) + 5000), "1", *corners]))
            elif words[0] == "SPC1":
                other.append(f"SPC1,1,123456,{int(words[3]) + grids}")
        self.compare(one.replace("ENDDATA\n", "") + "\n".join(other) + "\nENDDATA\n", (2,))

    def test_an_unstable_plate(self):
        """A negative spring: no LLᵀ, whatever the number of ranks."""
        self.compare(write_plate(more="CELAS2,90001,-2.+7,500,3\n"), (2,))

    def test_massless_mechanism(self):
        """Two bars without mass on a ball joint at the corner: K + sM is singular until their motions are held."""
        corner = make_grid_ids(36, 26)[26, 36]
        self.compare(write_plate(more="GRID,90001,,7.,4.5,.3\nGRID,90002,,8.,5.1,.9\nPBAR,9,9,1.-4,1.-8,1.-8,1.-8\n"
                                      f"MAT1,9,2.+11,,.3,0.\nCBAR,90001,9,{corner},90001,0.,0.,1.\n,456\n"
                                      "CBAR,90002,9,90001,90002,0.,0.,1.\n"), (2,))

    def test_errors_are_those_of_one(self):
        """No mass at all: K + sM has no modes, the same words and the same code, and no rank waits for another."""
        self.write("deck.bdf", write_plate().replace(",.3,8000.", ",.3,0."))
        found = [subprocess.run([*launch(n), PROGRAM, "modes", "deck.bdf", "-n", "8"], cwd=self.folder, text=True,
                                capture_output=True, timeout=HANG) for n in (1, 2)]
        self.assertEqual([one.returncode for one in found], [1, 1])
        said = [[line for line in one.stderr.splitlines() if "error:" in line] for one in found]
        self.assertIn("[modal.no-mass]", said[0][0])
        self.assertEqual(said[1], said[0])

    def say(self, ranks, *options, text):
        """Exit code, messages and tables of one call."""
        self.write("deck.bdf", text)
        done = subprocess.run([*launch(ranks), PROGRAM, "modes", "deck.bdf", "-n", "8", *options], cwd=self.folder,
                              text=True, capture_output=True, timeout=HANG)
        messages = [line for line in done.stderr.splitlines() if "error:" in line or "warning:" in line or "note:" in line]
        return done.returncode, messages, done.stdout

    def test_messages_are_those_of_one(self):
        """Once, the same words in the same order, the same code."""
        ids = make_grid_ids(12, 8)
        corner, other = ids[8, 12], ids[0, 1]
        for more, code in ((f"CBAR,90001,9,{corner},{other},0.,0.,1.\n", 1),
                           (f"CQUAD4,90001,1,{corner},{corner},{other},{other}\nCROD,90002,8,{corner},{other}\n", 1),
                           (f"GRID,90001,,7.,5.,1.\nRBE2,90002,{corner},123456,90001,88888\nCONM2,90003,77777,,1.\n", 1),
                           # a rod that hangs on the corner and grids that nothing holds: AUTOSPC
                           (f"GRID,90001,,7.,5.,1.\nCONROD,90002,{corner},90001,1,.01\nGRID,90003,,8.,8.,8.\n", 0),
                           (f"CMASS2,90001,500.,{corner},3\nCMASS2,90002,50.,{other},1\n", 0),
                           (f"CELAS2,90001,-2.+5,{corner},3\n", 0)):
            found = [self.say(n, text=write_plate(12, 8, more)) for n in (1, 2)]
            self.assertEqual(found[0][0], code, found[0])
            self.assertTrue(found[0][1])
            for one in found[1:]:
                self.assertEqual(one[:2], found[0][:2])

    def test_an_mpc_between_rigid_parts(self):
        """RBE2 spiders at both ends whose middles an MPC joins."""
        ids = make_grid_ids(36, 26)
        left, right = ",".join(map(str, ids[10:14, 3])), ",".join(map(str, ids[10:14, 33]))
        more = (f"GRID,90001,,.5,2.,.3\nGRID,90002,,5.5,2.,.3\nCONM2,90003,90002,,300.\n"
                f"RBE2,90004,90001,123456,{left}\nRBE2,90005,90002,123456,{right}\nMPC,1,90001,3,1.,90002,3,-.5\n")
        self.compare(write_plate(more=more).replace("SPC = 1\n", "SPC = 1\nMPC = 1\n"), (2,))

    def test_files_and_lengths_are_those_of_one(self):
        """Pictures, ids and lengths by NORM = MAX, component by component."""
        text = write_linked().replace("BEGIN BULK\n", "METHOD = 7\nBEGIN BULK\nEIGRL,7,,,8,,,,MAX\nPLOTEL,95001,1,500\n")
        self.write("deck.bdf", text)
        files = []
        for n in (1, 3):
            self.bough("modes", "deck.bdf", "-o", f"f{n}.h5", "--meffmass", "90001", launcher=launch(n))
            found = {}
            with h5py.File(self.path(f"f{n}.h5")) as file:
                file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
            files.append(found)
        for found in files[1:]:
            self.assertEqual(sorted(found), sorted(files[0]))
            for name, values in files[0].items():
                if np.issubdtype(np.asarray(values).dtype, np.floating):
                    if "residual" in name:
                        self.assertLess(np.max(found[name]), 1e-8)
                        continue
                    scale = max(np.abs(values).max(), 1e-300)
                    np.testing.assert_allclose(found[name] / scale, values / scale, atol=2e-6, err_msg=name)
                else:
                    np.testing.assert_array_equal(found[name], values, err_msg=name)

    def is_alive(self, process):
        """Not so: a dead one that nobody has asked for its exit code."""
        try:
            with open(f"/proc/{process}/stat") as f:
                return f.read().rsplit(")", 1)[1].split()[0] != "Z"
        except OSError:
            return False

    def end(self, act):
        """The exit code when `act(launcher, ranks)` comes in the middle of the modes; no rank is left behind."""
        self.write("deck.bdf", write_plate())
        launcher, ranks = self.start_held("modes", "deck.bdf", "-n", "8", call="MPI_Allreduce", count=10, processes=2,
                                          launcher=launch(2))
        self.assertEqual(len(set(ranks)), 2)
        act(launcher, ranks)
        launcher.communicate(timeout=HANG)
        for rank in ranks:
            until = time.monotonic() + HANG
            while self.is_alive(rank):
                self.assertLess(time.monotonic(), until, "a rank is left behind")
                time.sleep(0.05)
        return launcher.returncode

    def test_a_rank_that_dies_ends_all(self):
        self.assertNotEqual(self.end(lambda launcher, ranks: os.kill(ranks[1], signal.SIGKILL)), 0)

    def test_an_interrupt_ends_all(self):
        self.assertNotEqual(self.end(lambda launcher, ranks: launcher.send_signal(signal.SIGINT)), 0)


if __name__ == "__main__":
    unittest.main()
