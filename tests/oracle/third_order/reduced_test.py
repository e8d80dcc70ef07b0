"""`reduce` with [body.stiffening] order = 3 against the manifold of the oracle: energies, displacements, work of loads
of an L-frame in space, held at its foot or free in its mean frame."""
import os
import sys
import unittest

import h5py
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../../cli"))
sys.path.insert(0, HERE)
from beams import axes_along, make_beams  # noqa: E402
from corotational import Elements  # noqa: E402
from structure import Manifold, Structure, Table, exponents  # noqa: E402
from support import ProgramTest  # noqa: E402

E, G, RHO = 7e10, 2.6e10, 2700.
A, I1, I2, J = 1e-4, 8e-10, 2e-9, 1.5e-9
NUM = 4                                            # beams a leg
CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, .7, .2)], float)
MODES = 3


class TestReduced(ProgramTest):
    def make(self, body, modes=MODES):
        X = [CORNERS[0]]
        for a, b in zip(CORNERS[:-1], CORNERS[1:]):
            X += [a + (b - a) * i / NUM for i in range(1, NUM + 1)]
        self.X = np.array(X)
        self.tip = len(X)
        v = [(0., 1., 0.)] * NUM + [(1., 0., 0.)] * NUM
        lines = ["SOL 103", "CEND", "SPC = 1", "BEGIN BULK", "SPC1,1,123456,1", f"MAT1,1,{E!r},{G!r},,{RHO!r}",
                 f"PBAR,1,1,{A!r},{I1!r},{I2!r},{J!r}", "FORCE,20,5,,3.,0.,1.,2.", f"FORCE,20,{self.tip},,1.,1.,0.,-1."]
        lines += [f"GRID,{i + 1},,{x},{y},{z}" for i, (x, y, z) in enumerate(self.X.tolist())]
        lines += [f"CBAR,{i + 1},1,{i + 1},{i + 2},{a},{b},{c}" for i, (a, b, c) in enumerate(v)]
        self.write("frame.bdf", "\n".join(lines) + "\nENDDATA\n")
        self.write("frame.toml", f'[body]\nname = "frame"\ndeck = "frame.bdf"\ninterface = [{self.tip}]\n{body}\n'
                   f'[body.modes]\nnumber = {modes}\n[body.output]\nfull = true\n'
                   '[[body.load]]\nname = "two forces"\nload_set = 20\n')
        self.bough("reduce", "frame.toml", "-o", "frame.h5", "-q")
        nodes = np.array([(i, i + 1) for i in range(2 * NUM)])
        axes = np.concatenate([axes_along(self.X, nodes[i:i + 1], np.array(v[i])) for i in range(2 * NUM)])
        return nodes, axes

    def calc_mass(self, nodes):
        """Lumped mass of each grid."""
        mass = np.zeros(len(self.X))
        for a, b in nodes:
            mass[[a, b]] += RHO * A * np.linalg.norm(self.X[b] - self.X[a]) / 2
        return mass

    def calc_mode_loads(self, structure, phi, nodes):
        """W = M Φ Λ as the program has it: K Φ multiplies the error of the eigensolver by the stiffness of stiff shapes."""
        M_phi = np.zeros_like(phi)
        for k in range(3):
            M_phi[k::6] = self.calc_mass(nodes)[:, None] * phi[k::6]
        return M_phi * (np.diag(phi.T @ structure.K @ phi) / np.diag(phi.T @ M_phi))

    def read_tables(self):
        with h5py.File(self.path("frame.h5")) as f:
            self.assertEqual(f.attrs["format_version"], "1.3")
            phi = f["full/phi"][:]
            third = {name: f["third_order"][name][:] for name in f["third_order"] if name != "integrals"}
            names = [n.decode() if isinstance(n, bytes) else n for n in f["stiffening/locator/name"][:]]
            K = f["modal/stiffness"][:]
        return phi, third, names, K

    def check_tables(self, structure, phi, third, names, nodes, C=None):
        n = phi.shape[1]
        m = Manifold(structure, phi, order=4, W=self.calc_mode_loads(structure, phi, nodes), C=C)
        s = np.diag(phi.T @ structure.K @ phi)**-.5        # size of amplitudes
        for k, table in zip((3, 4, 5, 6), m.energy((3, 4, 5, 6))):
            scale = np.prod(s**exponents(n, k), 1)
            found, exact = third[f"energy_{k}"] * scale, table.c.ravel() * scale
            np.testing.assert_allclose(found, exact, rtol=1e-6, atol=1e-7 * max(1., np.abs(exact).max()), err_msg=f"energy {k}")
        f = np.zeros((len(self.X), 6))
        f[4, :3] = 3 * np.array([0., 1., 2.])
        f[-1, :3] += (1., 0., -1.)
        pattern = names.index("two forces")
        for k in (2, 3, 4):
            scale = np.prod(s**exponents(n, k), 1)
            u = m.u[k].c * scale[:, None]
            found = third[f"node_{k}"][0] * scale[:, None]
            np.testing.assert_allclose(found, u[:, -6:], rtol=0, atol=1e-6 * np.abs(u).max(), err_msg=f"node {k}")
            work = third[f"load_{k}"][:, pattern] * scale
            np.testing.assert_allclose(work, u @ f.ravel(), rtol=0, atol=1e-6 * np.abs(u).max(), err_msg=f"load {k}")

    def test_clamped_frame(self):
        nodes, axes = self.make('frame = "fixed"\n[body.stiffening]\norder = 3')
        beams = make_beams(self.X, nodes, axes, E * A, G * J, E * I2, E * I1, (I1 + I2) / A)
        structure = Structure(self.X, [Elements(**beams)], held=range(6))
        phi, third, names, K = self.read_tables()
        np.testing.assert_allclose(np.diag(phi.T @ structure.K @ phi), np.diag(K), rtol=1e-7)
        self.assertEqual(third["large"].tolist(), [1, 2, 3])
        self.check_tables(structure, phi, third, names, nodes)

    def test_free_frame_in_its_mean_axes(self):
        nodes, axes = self.make('frame = "free"\n[body.stiffening]\norder = 3')
        beams = make_beams(self.X, nodes, axes, E * A, G * J, E * I2, E * I1, (I1 + I2) / A)
        structure = Structure(self.X, [Elements(**beams)])
        phi, third, names, K = self.read_tables()
        mass = self.calc_mass(nodes)
        C = np.zeros((6 * len(self.X), 6))
        for k in range(3):
            C[k::6, k] = mass
            C.reshape(-1, 6, 6)[:, :3, 3 + k] = mass[:, None] * np.cross(np.eye(3)[k], self.X)
        np.testing.assert_allclose(C.T @ phi, 0, atol=1e-9)
        self.check_tables(structure, phi, third, names, nodes, C)

    def test_grid_at_the_mean_of_others(self):
        """RBE3 of three grids of the frame, with the rotations of one; from its reference grid a bar to a mass."""
        self.make('frame = "fixed"')
        reference, tip = self.tip + 1, self.tip + 2
        self.X = np.vstack([self.X, [(.8, .5, -.3), (1.2, .9, .1)]])
        members = [(2, 1., 0.), (4, 2., 1), (8, .7, 0.)]       # index, weight, with its rotations
        with open(self.path("frame.bdf")) as f:
            deck = f.read().replace(
                "ENDDATA", f"GRID,{reference},,.8,.5,-.3\nGRID,{tip},,1.2,.9,.1\nMAT1,2,{E!r},{G!r},,0.\n"
                f"PBAR,2,2,{A!r},{I1!r},{I2!r},{J!r}\nCBAR,20,2,{reference},{tip},.3,.2,1.\nCONM2,21,{tip},,.2\n"
                f"RBE3,30,,{reference},123456,1.,123,3,2.\n,123456,5,.7,123,9\nENDDATA")
        self.write("frame.bdf", deck.replace(f"FORCE,20,{self.tip},", f"FORCE,20,{tip},"))
        with open(self.path("frame.toml")) as f:
            body = f.read().replace(f"interface = [{self.tip}]", f"interface = [{tip}, {reference}]")
        self.write("frame.toml", body + "[body.stiffening]\norder = 3\nlarge = [1, 2, 3]\n")
        self.bough("reduce", "frame.toml", "-o", "frame.h5", "-q")
        nodes = np.array([(i, i + 1) for i in range(2 * NUM)] + [(reference - 1, tip - 1)])
        v = np.array([(0., 1., 0.)] * NUM + [(1., 0., 0.)] * NUM + [(.3, .2, 1.)])
        axes = np.concatenate([axes_along(self.X, nodes[i:i + 1], v[i]) for i in range(len(nodes))])
        beams = make_beams(self.X, nodes, axes, E * A, G * J, E * I2, E * I1, (I1 + I2) / A)
        arm = np.mean([np.linalg.norm(self.X[i] - self.X[reference - 1]) for i, _, _ in members])
        structure = Structure(self.X, [Elements(**beams)], held=range(6),
                              means=[(reference - 1, [(i, w, w * r * arm**2) for i, w, r in members])])
        self.calc_mass = lambda nodes: TestReduced.calc_mass(self, nodes[:-1]) + .2 * (np.arange(len(self.X)) == tip - 1)
        phi, third, names, K = self.read_tables()
        np.testing.assert_allclose(np.diag(phi.T @ structure.K @ phi), np.diag(K), rtol=1e-7)
        self.check_tables(structure, phi, third, names, nodes)
        # The reference grid moves with the mean.
        manifold = Manifold(structure, phi, order=4, W=self.calc_mode_loads(structure, phi, nodes))
        for k in (2, 3, 4):
            eta = Table.points(MODES, k)
            u = Table(MODES, k, structure.complete(manifold.curve(eta, k + 1))[k][:, reference - 1]).c
            np.testing.assert_allclose(third[f"node_{k}"][1], u, rtol=0, atol=1e-6 * np.abs(u).max(), err_msg=f"node {k}")

    def test_small_modes(self):
        """Two large modes of four: the manifold of these alone, and u₂ of other pairs that cancels their cubic energy."""
        nodes, axes = self.make('frame = "fixed"\n[body.stiffening]\norder = 3\nlarge = [1, 3]', modes=4)
        beams = make_beams(self.X, nodes, axes, E * A, G * J, E * I2, E * I1, (I1 + I2) / A)
        structure = Structure(self.X, [Elements(**beams)], held=range(6))
        phi, third, _, _ = self.read_tables()
        s = np.diag(phi.T @ structure.K @ phi)**-.5
        self.assertEqual(third["large"].tolist(), [1, 3])
        W = self.calc_mode_loads(structure, phi, nodes) * s
        all_modes = Manifold(structure, phi * s, order=2, W=W)
        two = Manifold(structure, phi[:, [0, 2]] * s[[0, 2]], order=4, W=W[:, [0, 2]])
        pairs, u = exponents(4, 2), all_modes.u[2].c.copy()
        force = all_modes.residual[2].c @ (phi * s)
        grids = (phi * s).reshape(-1, 2, 3, 4)  # translations, rotations of each
        size = .1 * np.linalg.norm(np.ptp(self.X, axis=0))
        compliance = (grids[:, 0]**2 + (size * grids[:, 1])**2).sum(1).max(0)
        self.assertGreater(abs(compliance[1] - compliance[3]), 1e-3 * compliance[1])
        for i, e in enumerate(pairs):
            if e[1] + e[3] == 0:
                u[i] = two.u[2].c[[tuple(x) for x in exponents(2, 2)].index(tuple(e[[0, 2]]))]
                continue
            for t in (1, 3):  # the least compliant one of a term follows
                if all(compliance[s_] >= compliance[t] for s_ in (1, 3) if e[s_] > 0):
                    u[i] -= (phi * s)[:, t] * force[i, t] / (1 + e[t])
        scale = np.prod(s**pairs, 1)[:, None]
        np.testing.assert_allclose(third["node_2"][0] * scale, u[:, -6:], rtol=0, atol=1e-6 * np.abs(u).max())
        eta = np.random.default_rng(4).normal(size=(6, 4))
        for k, x in enumerate(eta):
            x[[1, 3] if k == 0 else []] = 0
            curve = np.zeros((4, structure.num_dofs))
            curve[1], curve[2] = phi @ (s * x), np.prod(x**pairs, 1) @ u
            self.assertAlmostEqual(structure.energy(curve)[3], two.energy((3,))[0](x[[0, 2]])[()], delta=1e-9)
        for k, table in zip((3, 4, 5, 6), two.energy((3, 4, 5, 6))):
            size = np.prod(s[[0, 2]]**exponents(2, k), 1)
            c = table.c.ravel()
            np.testing.assert_allclose(third[f"energy_{k}"] * size, c, rtol=1e-6, atol=1e-7 * max(1., np.abs(c).max()))
        for k in (3, 4):
            size = np.prod(s[[0, 2]]**exponents(2, k), 1)[:, None]
            np.testing.assert_allclose(third[f"node_{k}"][0] * size, two.u[k].c[:, -6:],
                                       rtol=0, atol=1e-6 * np.abs(two.u[k].c).max())


if __name__ == "__main__":
    unittest.main()
