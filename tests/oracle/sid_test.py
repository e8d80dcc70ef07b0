"""export --to sid, read by the oracle's own reader: every block of three point masses by sums; at random states the
equations of motion by virtual work over the points; the spin-up of example ex01 integrated from the blocks alone."""
import os
import re
import sys
import unittest

import h5py
import numpy as np
import scipy.integrate

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../cli"))
import sid_oracle  # noqa: E402
from point_frame import DECK, PointFrame  # noqa: E402
from sid_oracle import skew  # noqa: E402
from support import ProgramTest  # noqa: E402

PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
# Place of those products in A_I's order wx2 wy2 wz2 wxwy wxwz wywz.
KG = [6, 7, 8, 9, 11, 10]


class SidFile(ProgramTest):
    def export(self, *options):
        self.write("frame.bdf", DECK)
        self.bough("reduce", "frame.bdf", "--modes", 5, "--interface", 4, "-o", "frame.h5", "-q")
        self.bough("export", "frame.h5", "--to", "sid", *options, "-o", "frame.SID_FEM")
        return sid_oracle.read(self.path("frame.SID_FEM")), PointFrame(self.path("frame.h5"))

    def same(self, a, b, tolerance=1e-12):
        self.assertLess(np.abs(np.asarray(a) - b).max(), tolerance * max(1.0, np.abs(b).max()))

    def test_blocks_of_three_masses(self):
        s, f = self.export()
        b, n = s.blocks, f.n
        self.same(s.mass, f.m.sum())
        self.same(b["mdCM"].m0[:, 0], f.sum(lambda p, phi: p))
        self.same(b["mdCM"].m1[:, :, 0], f.sum(lambda p, phi: phi))
        inertia = lambda p, u: -skew(p) @ skew(u) - skew(u) @ skew(p)  # noqa: E731
        J = b["J"]
        self.assertEqual(J.m0.shape, (6, 1))
        self.same(sid_oracle.inertia(J.m0), f.sum(lambda p, phi: -skew(p) @ skew(p)))
        for k in range(n):
            self.same(sid_oracle.inertia(J.m1[:, k, :]), f.sum(lambda p, phi: inertia(p, phi[:, k])))
            self.same(b["Gr"].m0[:, 3 * k:3 * k + 3], f.sum(lambda p, phi: -2 * skew(p) @ skew(phi[:, k])))
            self.same(b["Ge"].m0[:, 3 * k:3 * k + 3], f.sum(lambda p, phi: -2 * phi.T @ skew(phi[:, k])))
        self.same(b["Ct"].m0, f.sum(lambda p, phi: phi.T))
        self.same(b["Cr"].m0, f.sum(lambda p, phi: np.cross(p, phi.T)))
        self.same(b["Me"].m0, f.sum(lambda p, phi: phi.T @ phi))
        self.assertEqual(b["Me"].structure, 4)
        self.same(b["Ke"].m0, np.diag(f.eigenvalue))
        for a in range(3):
            self.same(b["Ct"].m1[:, :, a], f.kg[a])
            # d/dq_k of sum m (r x phi_j) is sum m phi_k x phi_j.
            cross = f.sum(lambda p, phi: np.cross(phi.T[None, :, :], phi.T[:, None, :]))[:, :, a]
            self.same(b["Cr"].m1[:, :, a], cross + f.kg[3 + a])
        for c, (x, y) in enumerate(PAIRS):
            product = np.zeros((3, 3))
            product[x, y] += 0.5
            product[y, x] += 0.5
            # w x (w x r) = (w w' - w'w 1) r, linear in the products of w.
            D = product - np.trace(product) * np.eye(3)
            D = D * (1 if x == y else 2)
            self.same(b["Oe"].m0[:, c], f.sum(lambda p, phi: phi.T @ D @ p))
            self.same(b["Oe"].m1[:, :, c], f.sum(lambda p, phi: phi.T @ D @ phi) + f.kg[KG[c]])
        self.assertFalse(b["ksigma"].m0.any())
        self.assertFalse(b["De"].m0.any())

    def test_nodes(self):
        s, f = self.export()
        self.assertEqual(list(s.nodes), f.ids)
        for k, node in enumerate(s.nodes.values()):
            self.same(node["origin"].m0[:, 0], f.xyz[k])
            self.same(node["origin"].m1[:, :, 0], f.all_phi[k, :3])
            self.same(node["phi"].m0, f.all_phi[k, :3])
            self.same(node["psi"].m0, f.all_phi[k, 3:])
            self.same(node["AP"].m0, np.eye(3))
            for q in range(f.n):
                self.same(node["AP"].m1[:, q, :], skew(f.all_phi[k, 3:, q]))
        for (node, direction), K in zip(f.locators, f.kg_external):
            self.assertEqual(node, 4)
            moved = "phi" if direction <= 3 else "psi"
            self.same(s.nodes[4][moved].m1[(direction - 1) % 3], -K)
        self.assertEqual([direction for _, direction in f.locators], [1, 2, 3, 4, 5, 6])
        self.assertEqual(s.nodes[2]["phi"].order, 0)

    def test_layouts(self):
        s, f = self.export()
        full, _ = self.export("--inertia", "3x3", "--ge-order", "component")
        n = f.n
        self.same(full.blocks["J"].m0, sid_oracle.inertia(s.blocks["J"].m0), 0.5e-16)
        by_component = full.blocks["Ge"].m0.reshape(n, 3, n).transpose(0, 2, 1).reshape(n, 3 * n)
        np.testing.assert_array_equal(by_component, s.blocks["Ge"].m0)
        short, _ = self.export("--digits", 12)
        self.same(short.blocks["Ke"].m0, s.blocks["Ke"].m0, 1e-11)

    def test_motion_of_the_points(self):
        """D'Alembert over the three masses: sum m (dr/du)' (acceleration) at a random state, without K_G."""
        s, f = self.export()
        for a in range(3):
            s.blocks["Ct"].m1[:, :, a] -= f.kg[a]
            s.blocks["Cr"].m1[:, :, a] -= f.kg[3 + a]
        for c in range(6):
            s.blocks["Oe"].m1[:, :, c] -= f.kg[KG[c]]
        rng = np.random.default_rng(4)
        for _ in range(5):
            q, qd, qdd = rng.normal(size=(3, f.n))
            w, wd, a = rng.normal(size=(3, 3))
            exact = np.zeros(6 + f.n)
            for m, p, phi in zip(f.m, f.p, f.phi):
                r = p + phi @ q
                acceleration = (a + np.cross(wd, r) + np.cross(w, np.cross(w, r)) + 2 * np.cross(w, phi @ qd)
                                + phi @ qdd)
                exact += m * np.concatenate([acceleration, np.cross(r, acceleration), phi.T @ acceleration])
            exact[6:] += f.eigenvalue * q
            M, h = sid_oracle.motion(s, q, qd, w)
            got = M @ np.concatenate([a, wd, qdd]) + h
            # Forces and rows of the modes are complete; the moment ends at first order.
            self.same(got[:3], exact[:3], 1e-11)
            self.same(got[6:], exact[6:], 1e-11)

    def spin(self, times, calc_rate, start):
        """The modes of ex01's boom by the equations of the SID file, hinged to what turns by calc_rate: rate, its rate."""
        s = sid_oracle.read(self.path("boom.SID_FEM"))

        def derivative(t, x):
            rate, acceleration = calc_rate(t)
            M, h = sid_oracle.motion(s, x[:3], x[3:], np.array([0, 0, rate]))
            return np.concatenate([x[3:], -np.linalg.solve(M[6:, 6:], M[6:, 5] * acceleration + h[6:])])

        solution = scipy.integrate.solve_ivp(derivative, (0, times[-1]), np.concatenate([start, np.zeros(3)]),
                                             method="DOP853", t_eval=times, rtol=1e-9, atol=1e-12)
        return s, solution.y[:3]

    def export_boom(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-q")
        self.bough("export", "boom.h5", "--to", "sid", "-o", "boom.SID_FEM")
        with open(self.path("spinup.toml")) as file:
            return file.read()

    def test_spin_up(self):
        """Ge, Oe with K_G and Cr: the peak that other programs of the same order give with three modes."""
        self.export_boom()
        rate, ramp = 4.0, 15.0
        s, q = self.spin(np.linspace(0, 8, 801), lambda t: (
            rate / ramp * (t - ramp / (2 * np.pi) * np.sin(2 * np.pi * t / ramp)),
            rate / ramp * (1 - np.cos(2 * np.pi * t / ramp))), np.zeros(3))
        self.assertAlmostEqual((s.nodes[41]["phi"].m0[1] @ q).min(), -0.534664, delta=2e-5)

    def test_small_swings_at_speed(self):
        """Against `bough run` where what the format leaves out, of third order, is small: 0.1 mm at 4 rad/s."""
        text = self.export_boom()
        text = text.replace("duration = 20.0", "duration = 8.0")
        text = re.sub(r'type = "spinup"[^\[]*', 'type = "ramp"\nvalue = 400.0\nfrom = 0.0\nto = 100.0\n\n', text)
        text = text.replace('file = "boom.h5"', 'file = "boom.h5"\neta = [1e-4, -2e-5, 1e-5]')
        self.write("swing.toml", text)
        self.bough("run", "swing.toml", "-o", "swing.h5", "-q")
        with h5py.File(self.path("swing.h5")) as f:
            time, eta = f["time"][:], f["bodies/boom/eta"][:]
        self.assertGreater(np.abs(eta).max(), 1e-4 - 1e-12)
        _, q = self.spin(time, lambda t: (4.0, 0.0), eta[0])
        self.assertLess(np.abs(q.T - eta).max(), 1e-9)

    def test_what_is_no_body(self):
        self.write("frame.bdf", DECK)
        self.bough("modes", "frame.bdf", "-o", "m.h5", "-q")
        for to in ["sid", "mbdyn"]:
            self.fails(1, "export", "m.h5", "--to", to, "-o", "x", error="cli.no-export")
        self.assertFalse(os.path.exists(self.path("x")))


if __name__ == "__main__":
    unittest.main()
