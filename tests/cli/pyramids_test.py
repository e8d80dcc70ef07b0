"""CPYRAM of 5 and 13 grids: dense matrices by NumPy, patch tests, bending, pressure, temperature, files."""
import itertools
import json
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh

from support import ProgramTest

BASE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]
E, NU, RHO = 7e10, .3, 2700.0


def real(x):
    text = f"{x:.12g}"
    return text if "." in text or "e" in text else text + "."


def write_element(card, eid, pid, grids):
    fields = [str(g) for g in (eid, pid, *grids)]
    return card + "," + "\n,".join(",".join(fields[k:k + 8]) for k in range(0, len(fields), 8)) + "\n"


def write_grids(places, first=1):
    return "".join(f"GRID,{first + k},,{','.join(map(real, p))}\n" for k, p in enumerate(places))


def add_midsides(x):
    return np.vstack([x, [(x[a] + x[b]) / 2 for a, b in EDGES]])


def calc_shape(n, xi, eta, zeta):
    """Bedrosian 1992, by the closed formulas of the paper; gradients by complex steps."""
    rest = 1 - zeta
    N = []
    if n == 5:
        for a, b in BASE:
            N.append(((1 + a * xi) * (1 + b * eta) - zeta + a * b * xi * eta * zeta / rest) / 4)
        return [*N, zeta]
    for a, b in BASE:
        N.append((a * xi + b * eta - 1) * ((1 + a * xi) * (1 + b * eta) - zeta + a * b * xi * eta * zeta / rest) / 4)
    N.append(zeta * (2 * zeta - 1))
    N += [(1 + xi - zeta) * (1 - xi - zeta) * (1 - eta - zeta) / (2 * rest),
          (1 + eta - zeta) * (1 - eta - zeta) * (1 + xi - zeta) / (2 * rest),
          (1 + xi - zeta) * (1 - xi - zeta) * (1 + eta - zeta) / (2 * rest),
          (1 + eta - zeta) * (1 - eta - zeta) * (1 - xi - zeta) / (2 * rest)]
    N += [zeta * (1 + a * xi - zeta) * (1 + b * eta - zeta) / rest for a, b in BASE]
    return N


def calc_matrices(x):
    """Stiffness and consistent mass by 8 x 8 x 8 Gauss points."""
    n = len(x)
    lam, mu = E * NU / (1 + NU) / (1 - 2 * NU), E / 2 / (1 + NU)
    C = np.diag([2 * mu] * 3 + [mu] * 3)
    C[:3, :3] += lam
    K, M = np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 3 * n))
    points, weights = np.polynomial.legendre.leggauss(8)
    for (r, wr), (s, ws), (t, wt) in itertools.product(*[list(zip(points, weights))] * 3):
        zeta = (1 + t) / 2
        at = np.array([(1 - zeta) * r, (1 - zeta) * s, zeta])
        N = np.array(calc_shape(n, *at))
        h = 1e-30
        dN = np.array([np.imag(calc_shape(n, *(at + 1j * h * e))) / h for e in np.eye(3)])
        J = dN @ x
        g = np.linalg.solve(J, dN)
        w = wr * ws * wt / 2 * (1 - zeta)**2 * np.linalg.det(J)
        B = np.zeros((6, 3 * n))
        for i in range(n):
            gx, gy, gz = g[:, i]
            B[:, 3 * i:3 * i + 3] = [[gx, 0, 0], [0, gy, 0], [0, 0, gz], [gy, gx, 0], [0, gz, gy], [gz, 0, gx]]
        K += w * B.T @ C @ B
        M += w * RHO * np.kron(np.outer(N, N), np.eye(3))
    return K, M


PROPERTY = f"PSOLID,1,1\nMAT1,1,{real(E)},,{NU},{real(RHO)},1.-5\n"
ONE = np.array([[0, 0, 0], [1.2, .1, 0], [1.1, 1.0, 0], [-.1, .9, 0], [.4, .6, 1.1]])
STRAIGHT = np.array([[0, 0, 0], [1.2, .1, 0], [1.5, 1.1, 0], [.3, 1.0, 0], [.4, .6, 1.1]])


class Pyramids(ProgramTest):
    def solve(self, deck, *options):
        self.write("d.bdf", deck)
        self.result = self.bough("static", "d.bdf", "-o", "d.h5", *options)
        with h5py.File(self.path("d.h5")) as f:
            group = f["subcases"][list(f["subcases"])[0]]
            found = {}
            group.visititems(lambda path, item: found.update({path: item[()]}) if isinstance(item, h5py.Dataset) else None)
        self.found = found
        return found["displacement"].reshape(-1, 6)[:, :3]

    def test_frequencies_of_one(self):
        """A free pyramid over a parallelogram: all frequencies of dense matrices; six of 0 Hz, all others above it."""
        for x in (STRAIGHT, add_midsides(STRAIGHT)):
            n = len(x)
            K, M = calc_matrices(x)
            expected = np.sqrt(np.maximum(eigh(K, M, eigvals_only=True), 0)) / 2 / np.pi
            deck = "SOL 103\nCEND\nMETHOD = 1\nSPC = 1\nBEGIN BULK\nPARAM,COUPMASS,1\n" + f"EIGRL,1,,,{3 * n}\n" + write_grids(x) + \
                write_element("CPYRAM", 1, 1, range(1, n + 1)) + PROPERTY + f"SPC1,1,456,1,THRU,{n}\nENDDATA\n"
            self.write("m.bdf", deck)
            modes = json.loads(self.bough("modes", "m.bdf", "--json").stdout)["modes"]
            hz = np.array([m["frequency_hz"] if "frequency_hz" in m else m["hz"] for m in modes])
            self.assertEqual(len(hz), 3 * n)
            self.assertLess(hz[:6].max(), 1e-4 * expected[6])
            np.testing.assert_allclose(hz[6:], expected[6:], rtol=1e-8)

    def cube(self, nodes, apex):
        """Six pyramids in a cube with an apex off its centre, or of midside grids: places and elements."""
        corners = np.array(list(itertools.product((0, 1.0), repeat=3)))
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        places, index, elements = [*map(tuple, corners), apex], {}, []
        for face in faces:
            p = [*face, 8]
            x = np.array([places[i] for i in p])
            normal = np.cross(x[1] - x[0], x[3] - x[0])
            if np.dot(normal, x[4] - x[0]) < 0:
                p = [p[0], p[3], p[2], p[1], 8]
            if nodes == 13:
                for a, b in EDGES:
                    key = tuple(sorted((p[a], p[b])))
                    if key not in index:
                        index[key] = len(places)
                        places.append(tuple((np.array(places[p[a]]) + places[p[b]]) / 2))
                    p.append(index[key])
            elements.append([i + 1 for i in p])
        return np.array(places), elements

    def test_patch(self):
        """Affine motion of the outer grids moves the inner ones with it; stresses of the closed form."""
        B = np.array([[1, 2, -1, .5], [.5, -2, 3, 1], [2, 1, -1, -1.5]]) * 1e-4
        lam, mu = E * NU / (1 + NU) / (1 - 2 * NU), E / 2 / (1 + NU)
        strain = (B[:, 1:] + B[:, 1:].T) / 2
        sigma = lam * np.trace(strain) * np.eye(3) + 2 * mu * strain
        for nodes in (5, 13):
            x, elements = self.cube(nodes, (.45, .55, .4))
            inner = [i for i, p in enumerate(x) if all(0 < c < 1 for c in p)]
            deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 5\nSTRESS(CORNER) = ALL\nBEGIN BULK\n" + write_grids(x) + PROPERTY
            deck += "".join(write_element("CPYRAM", k + 1, 1, e) for k, e in enumerate(elements))
            for i, p in enumerate(x):
                u = B @ [1, *p]
                if i not in inner:
                    deck += "".join(f"SPC,1,{i + 1},{c + 1},{u[c]:.14E}\n".replace("E-0", "E-") for c in range(3))
            deck += f"SPC1,1,456,1,THRU,{len(x)}\nFORCE,5,1,0,0.,1.,0.,0.\nENDDATA\n"
            u = self.solve(deck, "--f06", "d.f06")
            np.testing.assert_allclose(u, x @ B[:, 1:].T + B[:, 0], rtol=0, atol=1e-12 * np.abs(u).max())
            name = next(n for n in self.found if "CPYRAM" in n and n.endswith("stress"))
            expected = [sigma[0, 0], sigma[1, 1], sigma[2, 2], sigma[0, 1], sigma[1, 2], sigma[2, 0]]
            np.testing.assert_allclose(self.found[name][:, :6], np.tile(expected, (6, 1)), rtol=0, atol=1e-9 * np.abs(sigma).max())
            text = self.read("d.f06")
            self.assertIn("P Y R A M I D", text)

    def test_bricks_pyramids_and_tetrahedra_join(self):
        """A brick, a pyramid on its top and tetrahedra at its side: the patch test over all of them."""
        x = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1], [.5, .45, 1.8], [1.6, .4, 1.5],
                      [.5, -.6, 1.5]], float)
        B = np.array([[0, 2, -1, .5], [0, -2, 3, 1], [0, 1, -1, -1.5]]) * 1e-4
        cards = write_element("CHEXA", 1, 1, range(1, 9)) + write_element("CPYRAM", 2, 1, (5, 6, 7, 8, 9)) + \
            write_element("CTETRA", 3, 1, (6, 7, 9, 10)) + write_element("CTETRA", 4, 1, (5, 6, 9, 11))
        deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 5\nBEGIN BULK\n" + write_grids(x) + PROPERTY + cards
        for i in (0, 1, 2, 3, 6, 7, 9, 10):
            u = B @ [1, *x[i]]
            deck += "".join(f"SPC,1,{i + 1},{c + 1},{u[c]:.14E}\n".replace("E-0", "E-").replace("E+0", "E+") for c in range(3))
        sigma_free = deck + "SPC1,1,456,1,THRU,11\nFORCE,5,1,0,0.,1.,0.,0.\n"
        # The free grids 5, 6 and 9 get the forces of the constant stress on the outer faces: from a run with all held.
        held = sigma_free
        for i in (4, 5, 8):
            u = B @ [1, *x[i]]
            held += "".join(f"SPC,1,{i + 1},{c + 1},{u[c]:.14E}\n".replace("E-0", "E-").replace("E+0", "E+") for c in range(3))
        held += "GRID,99,,9.,9.,9.\nCELAS2,99,1.,99,1\nSPC1,1,23456,99\nENDDATA\n"
        self.solve(held)
        reactions = self.found["reaction"].reshape(-1, 6)[:11, :3]
        loads = "".join(f"FORCE,5,{i + 1},0,1.,{','.join(f'{v:.13E}' for v in reactions[i])}\n".replace("E+0", "E+").replace("E-0", "E-")
                        for i in (4, 5, 8))
        u = self.solve(sigma_free + loads + "ENDDATA\n")
        np.testing.assert_allclose(u, x @ B[:, 1:].T, rtol=0, atol=1e-9 * np.abs(u).max())

    def beam(self, nodes, number):
        """A cantilever of cubes, each of six pyramids: tip deflection over that of the beam."""
        places, index, cards = [], {}, ""

        def get(p):
            key = tuple(np.round(p, 9))
            if key not in index:
                index[key] = len(places) + 1
                places.append(key)
            return index[key]

        x, elements = self.cube(nodes, (.5, .5, .5))
        size, eid = 1 / number, 0
        for i, j, k in itertools.product(range(6 * number), range(number), range(number)):
            for element in elements:
                eid += 1
                cards += write_element("CPYRAM", eid, 1, [get(size * (x[g - 1] + (i, j, k))) for g in element])
        root = [g for p, g in index.items() if p[0] == 0]
        tip = [g for p, g in index.items() if abs(p[0] - 6) < 1e-9]
        deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 5\nBEGIN BULK\n" + write_grids(places) + cards + f"PSOLID,1,1\nMAT1,1,{real(E)},,0.,2700.\n" + \
            f"SPC1,1,456,1,THRU,{len(places)}\n" + "".join(f"SPC1,1,123,{g}\n" for g in root) + \
            "".join(f"FORCE,5,{g},0,{real(1000 / len(tip))},0.,0.,1.\n" for g in tip) + "ENDDATA\n"
        u = self.solve(deck)
        return np.mean([u[g - 1, 2] for g in tip]) / (1000 * 6**3 / (3 * E / 12) + 1000 * 6 / (5 / 6 * E / 2))

    def test_bending_converges(self):
        """Straight cantilever, ν = 0: pyramids of 13 grids are within 1 %, those of 5 converge from below."""
        coarse, fine = self.beam(5, 1), self.beam(5, 2)
        self.assertLess(coarse, fine)
        self.assertLess(fine, 1)
        self.assertGreater((fine - coarse) / (1 - coarse), .5)
        self.assertLess(abs(self.beam(13, 1) - 1), .01)

    def test_pressure(self):
        """PLOAD4 on the base (G1, G3 opposite) and on a triangle (G1, G3 of its edge): the resultant is -p A n."""
        p = 1e5
        for x in (ONE, add_midsides(ONE)):
            n = len(x)
            for a, b, corners in ((1, 3, (0, 1, 2, 3)), (2, 3, (1, 2, 4)), (3, 2, (1, 2, 4))):
                deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 5\nBEGIN BULK\n" + write_grids(x) + write_element("CPYRAM", 1, 1, range(1, n + 1)) + \
                    PROPERTY + f"SPC1,1,456,1,THRU,{n}\nSPC1,1,123,1,2,4,5\nPLOAD4,5,1,{real(p)},,,,{a},{b}\nENDDATA\n"
                self.solve(deck)
                y = x[list(corners)]
                area = np.cross(y[2] - y[0], (y[3] if len(y) == 4 else y[2]) - y[1]) / 2 if len(y) == 4 else np.cross(y[1] - y[0], y[2] - y[0]) / 2
                outward = area if np.dot(area, y.mean(axis=0) - x[:5].mean(axis=0)) > 0 else -area
                np.testing.assert_allclose(-self.found["reaction"].reshape(-1, 6)[:, :3].sum(axis=0), -p * outward, rtol=0, atol=1e-7 * p)

    def test_free_expansion(self):
        for x in (ONE, add_midsides(ONE)):
            n = len(x)
            deck = "SOL 101\nCEND\nSPC = 1\nTEMP(LOAD) = 6\nSTRESS = ALL\nBEGIN BULK\n" + write_grids(x) + \
                write_element("CPYRAM", 1, 1, range(1, n + 1)) + PROPERTY + \
                f"SPC1,1,456,1,THRU,{n}\nSPC1,1,123,1\nSPC1,1,3,2,4\nSPC1,1,2,2\nTEMPD,6,40.\nENDDATA\n"
            u = self.solve(deck)
            angle = (u[1, 1] - 4e-4 * x[1, 1]) / x[1, 0]  # grid 2 is held along y
            spin = np.array([[0, -angle, 0], [angle, 0, 0], [0, 0, 0]])
            np.testing.assert_allclose(u, 4e-4 * x + x @ spin.T, rtol=0, atol=1e-6 * np.abs(u).max())
            name = next(name for name in self.found if "CPYRAM" in name and name.endswith("stress"))
            self.assertLess(np.abs(self.found[name][:, :6]).max(), 1e-9 * E * 4e-4)

    def test_files(self):
        """VTU has cells 14, the mass is that of the volume, a left-handed element is turned, a deck is written again."""
        x = ONE[[0, 3, 2, 1, 4]]
        deck = "SOL 103\nCEND\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,8\n" + write_grids(x) + write_element("CPYRAM", 1, 1, range(1, 6)) + PROPERTY + "ENDDATA\n"
        self.write("d.bdf", deck)
        found = self.bough("modes", "d.bdf", "-o", "m.h5")
        self.assertIn("fe.left-handed", found.stderr)
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "n.bdf")
        self.assertIn("CPYRAM", self.read("n.bdf"))
        self.bough("modes", "n.bdf", "-o", "n.h5")


if __name__ == "__main__":
    unittest.main()
