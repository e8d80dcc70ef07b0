"""reduce --matrices: a beam from its own matrices, in the format of every program, is the beam of its deck."""
import json
import os
import struct
import sys
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.linalg
import scipy.sparse

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tests/oracle"))
import nastran_modes_writer  # noqa: E402

NUM = 12  # grids
CASE = "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,6\nPARAM,COUPMASS,-1\n"
SKEW = "CORD2R,5,,0.,0.,0.,1.,1.,3.\n,1.,0.,.3\n"
POINTS = SKEW + "".join(f"GRID,{10 * k + 1},,{0.5 * k},{0.02 * k * k},0.,{5 if k in (3, 7) else ''}\n"
                        for k in range(NUM)) + "SPC1,1,123456,1\n"
ELEMENTS = "PBAR,1,1,1.-3,2.-7,1.-7,2.-7\nMAT1,1,7.+10,,.3,2700.\n" + "".join(
    f"CBAR,{k + 1},1,{10 * k + 1},{10 * k + 11},0.,0.,1.\n" for k in range(NUM - 1))
KEYS = ["/modes/frequency_hz", "/integrals/exact/gamma0", "/integrals/exact/gamma1", "/integrals/exact/gamma2",
        "/integrals/exact/gamma3", "/integrals/exact/gamma4", "/integrals/lumped/gamma2", "/rigid/cg",
        "/rigid/inertia", "/inertial_loads/f", "/modes/phi"]


def read_csr(group):
    return scipy.sparse.csr_matrix((group["data"][:], group["indices"][:], group["indptr"][:]), shape=tuple(group["shape"][:]))


def write_op4(path, matrices, order="<"):
    with open(path, "wb") as f:
        def record(data):
            f.write(struct.pack(order + "i", len(data)) + data + struct.pack(order + "i", len(data)))

        for name, A in matrices:
            record(struct.pack(order + "4i", A.shape[1], A.shape[0], 6, 2) + f"{name:<8}".encode())
            for j, column in enumerate(A.T):
                rows = np.flatnonzero(column)
                if len(rows) > 0:
                    values = column[rows[0]:rows[-1] + 1]
                    record(struct.pack(order + "3i", j + 1, rows[0] + 1, 2 * len(values)) +
                           values.astype(order + "f8").tobytes())
            record(struct.pack(order + "3id", A.shape[1] + 1, 1, 2, 1.0))


def write_dmig(path, matrices, dofs):
    with open(path, "w") as f:
        for name, A in matrices:
            f.write(f"DMIG    {name:<8}{0:8d}{6:8d}{2:8d}{0:8d}\n")
            for j, (node, code) in enumerate(dofs):
                rows = [i for i in range(j, len(dofs)) if A[i, j] != 0]
                if not rows:
                    continue
                f.write(f"{'DMIG*':<8}{name:<16}{node:16d}{code:16d}\n")
                for i in rows:
                    f.write(f"{'*':<8}{dofs[i][0]:16d}{dofs[i][1]:16d}{A[i, j]:16.9E}\n")


class MatrixBodies(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("deck.bdf", CASE + POINTS + ELEMENTS + "ENDDATA\n")
        self.write("points.bdf", CASE + POINTS + "ENDDATA\n")  # no element at all
        self.bough("matrices", "deck.bdf", "-o", "own.h5")
        self.bough("reduce", "deck.bdf", "-n", 5, "--full", "-o", "deck.h5")
        with h5py.File(self.path("own.h5")) as f:
            self.K, self.M = read_csr(f["K"]).toarray(), read_csr(f["M"]).toarray()
            self.dofs = [tuple(map(int, row)) for row in f["dof_map"][:]]
        # Axes of Nastran's output: the displacement systems of grids 31 and 71.
        k = np.array([1, 1, 3]) / np.sqrt(11)
        y = np.cross(k, [1, 0, .3])
        y /= np.linalg.norm(y)
        R = np.eye(6 * NUM)
        for node in (3, 7):
            for first in (6 * node, 6 * node + 3):
                R[first:first + 3, first:first + 3] = np.column_stack([np.cross(y, k), y, k])
        self.R = R
        self.K_cd, self.M_cd = R.T @ self.K @ R, R.T @ self.M @ R
        self.free = [i for i, dof in enumerate(self.dofs) if dof[0] != 1]

    def same(self, found, tolerance=1e-10, keys=KEYS):
        with h5py.File(self.path(found)) as a, h5py.File(self.path("deck.h5")) as b:
            for key in keys:
                scale = np.abs(b[key][:]).max()
                self.assertLessEqual(np.abs(a[key][:] - b[key][:]).max(), tolerance * max(scale, 1e-300), key)

    def reduce(self, *matrices, deck="points.bdf", code=0):
        options = [word for matrix in matrices for word in ("--matrices", matrix)]
        return self.bough("reduce", deck, *options, "-n", 5, "-o", "body.h5", code=code)

    def solve(self, K, M):
        """Hertz and shapes of the five lowest modes; M has no inertia of twist: the largest of M x = theta K x."""
        K, M = (A[np.ix_(self.free, self.free)] for A in (K, M))
        theta, vectors = scipy.linalg.eigh(M, K)
        theta, vectors = theta[::-1][:5], vectors[:, ::-1][:, :5]
        return 1 / np.sqrt(theta) / (2 * np.pi), vectors / np.sqrt(theta)

    def has_frequencies_of_punch(self, body):
        """Frequencies of K and M with the ten digits of a punch file."""
        cut = np.vectorize(lambda v: float(f"{v:.9E}"))
        K, M = (cut(np.tril(A)) for A in (self.K_cd, self.M_cd))
        K, M = (A + np.tril(A, -1).T for A in (K, M))
        with h5py.File(self.path(body)) as f:
            np.testing.assert_allclose(f["modes/frequency_hz"][:], self.solve(K, M)[0], rtol=1e-8)

    def test_formats_of_bough(self):
        """Basic axes by the file: attribute of HDF5, list of dofs beside OUTPUT4 and Matrix Market."""
        self.reduce("own.h5")
        self.same("body.h5")
        self.bough("matrices", "deck.bdf", "--to", "op4", "-o", "m.op4")
        self.reduce("m.op4")
        self.same("body.h5")
        self.bough("matrices", "deck.bdf", "--to", "mtx", "-o", "m.mtx")
        self.reduce("K=m.K.mtx", "M=m.M.mtx")
        self.same("body.h5")

    def test_usual_names(self):
        """A file that is not told which matrix to take: those of EXTSEOUT among the names."""
        for k, m in (("KXX", "MXX"), ("KAA", "MAA"), ("KAAX", "MAAX")):
            write_dmig(self.path("m.pch"), [("B2X", self.M_cd), (k, self.K_cd), (m, self.M_cd)], self.dofs)
            self.reduce("m.pch")
            self.has_frequencies_of_punch("body.h5")

    def test_without_a_deck(self):
        with h5py.File(self.path("own.h5")) as f:
            ids, xyz = f["grids/id"][:], f["grids/xyz"][:]
        self.bough("reduce", "--matrices", "own.h5", "--matrices", "clamped=1", "-n", 5, "-o", "body.h5")
        self.same("body.h5")
        self.write("grids.csv", "id,x,y,z\n" + "".join(f"{i},{x!r},{y!r},{z!r}\n" for i, (x, y, z) in
                                                       zip(ids.tolist(), xyz.tolist())))
        for A, name in ((self.K, "K"), (self.M, "M")):
            scipy.io.mmwrite(self.path(f"plain.{name}.mtx"), scipy.sparse.coo_matrix(A), precision=17)
        self.write("map.csv", "node;component\n" + "".join(f"{n};{c}\n" for n, c in self.dofs))
        self.bough("reduce", *(word for m in ("K=plain.K.mtx", "M=plain.M.mtx", "grids=grids.csv", "dofs=map.csv",
                                              "clamped=1") for word in ("--matrices", m)), "-n", 5, "-o", "body.h5")
        self.same("body.h5")

    def test_nastran(self):
        for order in "<>":
            write_op4(self.path("n.op4"), [("KGG", self.K_cd), ("MGG", self.M_cd)], order)
            said = self.reduce("n.op4").stderr
            self.same("body.h5")
        self.assertNotIn("not-rigid-mass", said)
        # Equal numbers in basic axes are another structure.
        self.reduce("n.op4", "axes=basic")
        with self.assertRaises(AssertionError):
            self.same("body.h5", 1e-6)
        # Large fields hold ten digits; the bending of the beam is what is left of its far stiffer tension: held against
        # NumPy on the same digits.
        write_dmig(self.path("n.pch"), [("KAAX", self.K_cd), ("MAAX", self.M_cd)], self.dofs)
        self.reduce("n.pch")
        self.has_frequencies_of_punch("body.h5")

    def test_calculix_and_abaqus(self):
        """No rows for what is clamped; grids in basic axes."""
        def write_lines(name, A, line):
            self.write(name, "".join(line(i, j, float(A[i, j])) for i in range(len(A)) for j in range(i, len(A))
                                     if A[i, j] != 0))

        dofs = [self.dofs[i] for i in self.free]
        K, M = (A[np.ix_(self.free, self.free)] for A in (self.K, self.M))
        for name, A in (("c.sti", K), ("c.mas", M)):
            write_lines(name, A, lambda i, j, v: f"{i + 1} {j + 1} {v!r}\n")
        self.write("c.dof", "".join(f"{n}.{c}\n" for n, c in dofs))
        self.reduce("K=c.sti", "M=c.mas", "axes=basic")
        keys = ["/modes/frequency_hz", "/modes/phi"]
        self.same("body.h5", keys=keys)
        for name, A in (("a_STIF1.mtx", K), ("a_MASS1.mtx", M)):
            write_lines(name, A, lambda i, j, v: f"{dofs[i][0]},{dofs[i][1]}, {dofs[j][0]},{dofs[j][1]}, {v!r}\n")
        self.reduce("K=a_STIF1.mtx", "M=a_MASS1.mtx", "axes=basic")
        self.same("body.h5", keys=keys)

    def test_matlab_and_scipy(self):
        scipy.io.savemat(self.path("m.mat"), {"K": scipy.sparse.csc_matrix(self.K), "M": self.M})
        self.reduce("m.mat", "axes=basic")
        self.same("body.h5")
        with h5py.File(self.path("s.h5"), "w") as f:
            for name, A in (("stiff", self.K), ("mass", self.M)):
                csr = scipy.sparse.csr_matrix(A)
                for part in ("data", "indices", "indptr"):
                    f[f"{name}/{part}"] = getattr(csr, part)
                f[f"{name}/shape"] = csr.shape
        self.reduce("K=s.h5:stiff", "M=s.h5:mass", "axes=basic")
        self.same("body.h5")

    def test_numpy_agrees(self):
        self.reduce("own.h5")
        hertz, vectors = self.solve(self.K, self.M)
        Phi = np.zeros((6 * NUM, 5))
        Phi[self.free] = vectors
        with h5py.File(self.path("body.h5")) as f:
            np.testing.assert_allclose(f["modes/frequency_hz"][:], hertz, rtol=1e-9)
            momentum = (self.M @ Phi).reshape(NUM, 6, 5)[:, :3].sum(axis=0).T
            np.testing.assert_allclose(np.abs(f["integrals/exact/gamma0"][:]), np.abs(momentum), atol=1e-8)

    def test_body_file_with_geometric_stiffness(self):
        """K_G of a pull on the tip, by `matrices`, in a body file: as the deck's own locator."""
        self.write("deck.bdf", CASE.replace("SPC = 1\n", "SPC = 1\nLOAD = 9\n") + POINTS + ELEMENTS +
                   "FORCE,9,111,,1.,1.,0.,0.\nENDDATA\n")
        self.bough("matrices", "deck.bdf", "-o", "own.h5")
        self.bough("reduce", "deck.bdf", "-n", 5, "--load", "pull=set:9", "-o", "deck.h5")
        self.write("body.toml", '[body]\ndeck = "deck.bdf"\n[body.modes]\nnumber = 5\n[body.matrices]\n'
                   'file = "own.h5"\nstiffness = ":K"\nmass = "own.h5:M"\n[[body.matrices.geometric]]\n'
                   'name = "pull"\nmatrix = ":KG/LOAD_9"\nload_set = 9\n[body.output]\nfile = "body.h5"\n')
        said = self.bough("reduce", "body.toml").stderr
        self.assertIn("[reduce.no-stiffening]", said)
        self.same("body.h5", keys=KEYS[:9] + ["/stiffening/kg_external"])
        with h5py.File(self.path("body.h5")) as f:
            self.assertFalse(f["/stiffening/computed"][:].any() if "/stiffening/computed" in f else False)

    def test_modes_of_nastran(self):
        """OP2 and punch: taken as the modes, and compared with ours."""
        with h5py.File(self.path("deck.h5")) as f:
            ids = f["nodes/id"][:].tolist()
            eigenvalue, phi = f["modes/eigenvalue"][:], f["modes/phi"][:]  # p x 6 x n
        turned = (self.R.T @ phi.reshape(6 * NUM, 5)).reshape(NUM, 6, 5)
        saved = nastran_modes_writer.NODES, nastran_modes_writer.make_modes
        self.addCleanup(lambda: [setattr(nastran_modes_writer, *pair)
                                 for pair in zip(("NODES", "make_modes"), saved)])
        nastran_modes_writer.NODES = [(i, 1) for i in ids]
        nastran_modes_writer.make_modes = lambda: [(float(eigenvalue[j]), 1.0, turned[:, :, j]) for j in range(5)]
        nastran_modes_writer.write_op2(self.path("m.op2"), [])
        nastran_modes_writer.write_punch(self.path("m.pch"))
        self.fails(1, "reduce", "points.bdf", "--matrices", "own.h5", "--matrices", "check=m.pch", "-n", 5,
                   error="cli.which-subcase")
        for check in ("m.op2:1", "m.pch:1"):
            out = self.bough("reduce", "points.bdf", "--matrices", "own.h5", "--matrices", f"check={check}", "-n", 5,
                             "--json", "-o", "body.h5").stdout
            found = json.loads(out)["check"]
            np.testing.assert_allclose(np.diag(found["mac"]), 1, atol=1e-5)
            np.testing.assert_allclose(found["frequency_hz"], np.sqrt(eigenvalue) / (2 * np.pi), rtol=1e-6)
        out = self.bough("reduce", "points.bdf", "--matrices", "own.h5", "--matrices", "check=m.op2:1", "-n", 5).stdout
        self.assertIn("MAC", out)
        said = self.bough("reduce", "points.bdf", "--matrices", "own.h5", "--matrices", "phi=m.op2:1", "-o", "body.h5")
        self.assertNotIn("modes-differ", said.stderr)
        self.same("body.h5", 1e-4, ["/modes/frequency_hz", "/modes/phi", "/integrals/exact/gamma0"])

    def test_cards_that_bough_lacks_do_not_matter_here(self):
        self.write("points.bdf", CASE + POINTS + "CBUSH2D,900,900,1,2,,XY\nENDDATA\n")
        self.reduce("own.h5")
        self.same("body.h5")

    def test_errors(self):
        write_op4(self.path("n.op4"), [("KGG", self.K[:-6, :-6]), ("MGG", self.M)])
        self.fails(1, "reduce", "points.bdf", "--matrices", "n.op4", "-n", 3, error="reduce.matrix-size")
        self.fails(1, "reduce", "--matrices", "n.op4", "-n", 3, error="cli.no-grids")
        self.fails(1, "reduce", "points.bdf", "--matrices", "none.op4", "-n", 3, error="cli.no-file")
        self.fails(1, "reduce", "points.bdf", "--matrices", "K=own.h5:K", "-n", 3, error="cli.no-matrix")
        self.fails(1, "reduce", "points.bdf", "--matrices", "own.h5", error="cli.no-modes")
        self.fails(1, "reduce", "points.bdf", "--matrices", "own.h5", "--matrices", "grids=own.h5", "-n", 3,
                   error="cli.grids-twice")
        self.fails(1, "reduce", "points.bdf", "--matrices", "own.h5", "--matrices", "Q=own.h5", "-n", 3,
                   error="cli.bad-matrices")
        for third in ["1,two", "1,2.5", "1e300,1"]:
            self.write("map.csv", f"node,component\n1,1\n{third}\n")
            self.fails(1, "reduce", "points.bdf", "--matrices", "own.h5", "--matrices", "dofs=map.csv", "-n", 3,
                       says=["map.csv:3"], error="cli.bad-table")
        write_op4(self.path("n.op4"), [("KGG", self.K_cd), ("MGG", self.M_cd)])
        said = self.bough("reduce", "points.bdf", "--matrices", "n.op4", "-n", 3, "-v").stderr
        self.assertIn("[reduce.matrix-axes]", said)
        self.bough("reduce", "-n", 3, code=2)

    def test_the_file_of_the_matrix_is_blamed(self):
        """Not the one of the points, which is sound."""
        K = self.K.copy()
        i, j = self.dofs.index((61, 3)), self.dofs.index((91, 3))
        K[i] = K[j]
        K[:, i] = K[:, j]
        for A, name in ((K, "K"), (self.M, "M")):
            scipy.io.mmwrite(self.path(f"m.{name}.mtx"), scipy.sparse.coo_matrix(A), precision=17)
        self.write("m.dofs.csv", "node,component\n" + "".join(f"{n},{c}\n" for n, c in self.dofs))
        run = self.bough("reduce", "points.bdf", "--matrices", "K=m.K.mtx", "--matrices", "M=m.M.mtx", "-n", 3, code=1)
        self.assertIn("m.K.mtx", run.stderr)


if __name__ == "__main__":
    unittest.main()
