"""Bodies right to third order (docs/theory/third-order.md): each term of the static manifold of corotational elements
against exact models: circle, rods with exact rotations by shooting, inextensible beam."""
import os
import sys
import unittest

try:
    import numpy as np
    from scipy.linalg import eigh
    from scipy.optimize import brentq
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from beams import axes_along, make_beams  # noqa: E402
from corotational import Elements  # noqa: E402
from inextensible import Cantilever, spin_up  # noqa: E402
from motion import Points  # noqa: E402
from rods import Chain  # noqa: E402
from series import multiply, rotate, rotation_vector  # noqa: E402
from structure import Manifold, Polynomial, Structure, Table  # noqa: E402


def chain(corners, y, num, EA, C, held=range(6), links=(), extra=(), **options):
    """Beams along straight legs, `num` each; extra: places of nodes after them. Structure, and the exact rods."""
    corners = np.array(corners, float)
    X, nodes = [corners[0]], []
    for a, b in zip(corners[:-1], corners[1:]):
        for i in range(1, num + 1):
            nodes.append((len(X) - 1, len(X)))
            X.append(a + (b - a) * i / num)
    X, nodes = np.array(X + list(extra)), np.array(nodes)
    axes = np.concatenate([axes_along(X, nodes[k * num:k * num + num], np.array(v, float)) for k, v in enumerate(y)])
    beams = make_beams(X, nodes, axes, EA, C[0], C[1], C[2], 0.)
    legs = [(np.linalg.norm(b - a), axes[k * num]) for k, (a, b) in enumerate(zip(corners[:-1], corners[1:]))]
    return Structure(X, [Elements(**beams, **options)], links, held), Chain(legs, EA, C)


def planar(structure_nodes):
    return list(range(6)) + [6 * i + k for i in range(structure_nodes) for k in (2, 3, 4)]


def solve_static(s, f):
    u = np.zeros(s.num_dofs)
    u[s.free] = np.linalg.solve(s.K[np.ix_(s.free, s.free)], f[s.free])
    return u


def unit(s, dof):
    f = np.zeros(s.num_dofs)
    f[dof] = 1
    return f


def find_rest(V, L, load, eta):
    """Minimum of V - load L."""
    pv, pl = Polynomial(V), Polynomial(L)
    for _ in range(50):
        _, g, h = pv.all(eta)
        _, gl, hl = pl.all(eta)
        step = np.linalg.solve(h[..., 0] - load * hl[..., 0], (g - load * gl)[:, 0])
        eta = eta - step
        if np.abs(step).max() < 1e-13 * np.abs(eta).max():
            break
    return eta


class TestElement(unittest.TestCase):
    def setUp(self):
        self.rng = np.random.default_rng(1)
        self.X = np.array([[0, 0, 0], [1, .5, .2]])
        self.nodes = np.array([[0, 1]])
        self.beam = make_beams(self.X, self.nodes, axes_along(self.X, self.nodes, np.array([0, 1., 0])), 5., .7, 1.1, 1.9, .3)

    def test_rotations_are_inverse_of_their_vectors(self):
        theta = np.zeros((5, 4, 3))
        theta[1:3] = self.rng.normal(size=(2, 4, 3))
        R = rotate(theta)
        np.testing.assert_allclose(rotation_vector(R), theta, atol=1e-13)
        np.testing.assert_allclose(multiply("...ij,...kj->...ik", R, R)[1:], 0, atol=1e-13)

    def test_forces_are_the_gradient(self):
        element = Elements(**self.beam)
        u, v = np.zeros((5, 1, 2, 6)), self.rng.normal(size=(1, 2, 6))
        u[1:3] = self.rng.normal(size=(2, 1, 2, 6))
        plus, minus = u.copy(), u.copy()
        plus[1] += 1e-5 * v
        minus[1] -= 1e-5 * v
        found = element.forces(u).reshape(5, -1) @ v.ravel()
        np.testing.assert_allclose(found[:4], ((element.energy(plus) - element.energy(minus)) / 2e-5)[1:], rtol=1e-7)

    def test_finite_rigid_motion_has_no_energy(self):
        element = Elements(**self.beam)
        theta = np.zeros((5, 1, 1, 3))
        theta[1:3] = self.rng.normal(size=(2, 1, 1, 3))
        R = rotate(theta)
        R[0] -= np.eye(3)
        u = np.zeros((5, 1, 2, 6))
        u[..., :3] = np.einsum("k...ij,nj->k...ni", R[..., 0, :, :], self.X)
        u[..., 3:] = theta
        np.testing.assert_allclose(element.forces(u), 0, atol=1e-13)

    def test_third_derivative_is_geometric_stiffness_of_three(self):
        """V‴(a, b, c) = K_G(a)(b, c) + K_G(b)(a, c) + K_G(c)(a, b), whatever the frame."""
        a, b, c = self.rng.normal(size=(3, 12))
        F, P = self.beam["F"][0], self.beam["P"][0]
        K_G = lambda a, b, c: np.einsum("s,sij,i,j", F @ a, P, b, c)                # noqa: E731
        for weight in (1e-3, 0.1, 10):
            s = Structure(self.X, [Elements(**self.beam, weight=weight)])
            self.assertAlmostEqual(s.third(a, b, c), K_G(a, b, c) + K_G(b, a, c) + K_G(c, a, b), delta=1e-11)


class TestStatics(unittest.TestCase):
    def test_end_moment_bends_a_circle(self):
        """η is the turn of the tip: V = ½η² EI/L, tip at sin η/η and (1 - cos η)/η; error of degree 4 as h⁴."""
        last = None
        for num in (4, 8):
            s, _ = chain([(0, 0, 0), (1, 0, 0)], [(0, 1, 0)], num, 1e5, (1., 1., 1.), planar(num + 1))
            tip = 6 * num
            m = Manifold(s, solve_static(s, unit(s, tip + 5))[:, None], order=4)
            np.testing.assert_allclose([t.c[0] for t in m.energy()], [.5, 0, 0], atol=1e-10)
            along = [t.c[0] for t in m.load(unit(s, tip))]
            np.testing.assert_allclose(along, [m.u[k].c[0, tip] for k in m.u], atol=1e-12)   # reciprocity
            self.assertAlmostEqual(along[1], -1 / 6, delta=1e-10)
            self.assertAlmostEqual(m.u[1].c[0, tip + 1], 1 / 2, delta=1e-10)
            self.assertAlmostEqual(m.u[3].c[0, tip + 1], -1 / 24, delta=1e-10)
            error = abs(along[3] - 1 / 120)
            if last:
                self.assertAlmostEqual(np.log2(last / error), 4, delta=0.1)
            last = error

    def test_without_strains_of_second_order_inside_h2_remains(self):
        """Linear elements in frames alone: foreshortening by chords, 1.6 % off with four elements."""
        s, _ = chain([(0, 0, 0), (1, 0, 0)], [(0, 1, 0)], 4, 1e5, (1., 1., 1.), planar(5), local=False)
        m = Manifold(s, solve_static(s, unit(s, 29))[:, None])
        self.assertAlmostEqual(m.u[2].c[0, 24] * -6, 1 - 1 / 64, delta=1e-8)

    def test_inextensible_beam_has_known_quartic_energy(self):
        """One mode shape: V4 = ½ EI ∫ v'² v''²."""
        num = 24
        s, _ = chain([(0, 0, 0), (1, 0, 0)], [(0, 1, 0)], num, 1e6, (1., 1., 1.), planar(num + 1))
        exact = Cantilever(1., 1., 1., 2, cells=80)
        phi = np.zeros((s.num_dofs, 2))
        b = np.array([1.8751040687, 4.6940911330])
        x = s.X[:, 0]
        for j in range(2):
            a = (np.cosh(b[j]) + np.cos(b[j])) / (np.sinh(b[j]) + np.sin(b[j]))
            v = (np.cosh(b[j] * x) - np.cos(b[j] * x) - a * (np.sinh(b[j] * x) - np.sin(b[j] * x))) / 2
            r = b[j] / 2 * (np.sinh(b[j] * x) + np.sin(b[j] * x) - a * (np.cosh(b[j] * x) - np.cos(b[j] * x)))
            phi[1::6, j], phi[5::6, j] = v, r
        V4 = Manifold(s, phi).energy((4,))[0]
        for eta in ((1., 0), (0, 1.), (.7, .4)):
            slope, bend = exact.D @ eta, exact.C @ eta
            expected = 0.5 * exact.w @ (slope**2 * bend**2)
            self.assertAlmostEqual(V4(np.array(eta))[()] / expected, 1, delta=2e-3)

    def test_frames_err_by_the_fourth_power_of_the_load(self):
        cases = [([(0, 0, 0), (1, 0, 0), (1, .7, 0)], [(0, 1, 0), (1, 0, 0)], (1., 1.3, 1.), [.5, 1., 0]),
                 ([(0, 0, 0), (1, 0, 0), (1, .7, 0), (1, .7, .5)], [(0, 1, 0), (1, 0, 0), (1, 0, 0)], (.6, 1., 2.5),
                  [.5, 1., .8])]
        for corners, y, C, f in cases:
            s, rods = chain(corners, y, 12, 1e5, C)
            F = np.zeros(s.num_dofs)
            F[-6:-3] = f
            m = Manifold(s, solve_static(s, F)[:, None])
            V, tip = m.energy(), [m.load(unit(s, s.num_dofs - 6 + a)) for a in range(3)]
            L = [Table(1, k, coefficients=np.tensordot(f, [t[k - 1].c for t in tip], 1)) for k in (1, 2, 3, 4)]
            guess, error = None, []
            for load in (.1, .2):
                x, guess = rods.solve([np.zeros(3)] * (len(y) - 1) + [load * np.array(f)], guess)
                moved = x[-1] - corners[-1]
                error.append([])
                # linear; u2 without V3; second order; third order
                for top, energy in ((1, 2), (2, 2), (2, 3), (4, 4)):
                    eta = find_rest(V[:energy - 1], L[:top], load, np.zeros(1))
                    at = [Polynomial(t[:top]).value(eta)[0] for t in tip]
                    error[-1].append(np.linalg.norm(at - moved) / np.linalg.norm(moved))
            order = np.log2(np.array(error[1]) / error[0] * 2)
            print("frame: errors of the tip, of its way", np.array(error[1]), "orders", order)
            self.assertLess(order[1], 2.3)
            self.assertGreater(order[2], 2.6)
            self.assertGreater(order[3], 3.6)
            self.assertLess(error[0][3], 2e-4)
            self.assertLess(error[0][3], error[0][2] / 10)

    def test_shallow_arch_has_cubic_energy(self):
        """Clamped, load at its crown, sixteen straight pieces: each degree of V lowers the error."""
        num, half, thick = 16, .3, .02
        angle = np.linspace(-half, half, num + 1)
        X = np.stack([np.sin(angle), np.cos(angle), 0 * angle], 1) / (2 * np.sin(half))
        X -= X[0]
        EA = 12 / thick**2
        held = set(planar(num + 1)) | {6 * num + k for k in range(6)}
        s, rods = chain(X, [(0, 1, 0)] * num, 1, EA, (1., 1., 1.), held)
        crown = 6 * (num // 2) + 1
        u = solve_static(s, -unit(s, crown))
        V = [float(t.c[0]) for t in Manifold(s, u[:, None]).energy()]
        load, reaction = 4., -s.K[:6] @ u
        forces = [np.zeros(3)] * num
        forces[num // 2 - 1] = np.array([0, -load, 0])
        x, _ = rods.solve_clamped(forces, X[-1], load * reaction)
        exact = X[num // 2, 1] - x[num // 2 - 1, 1]
        error = []
        for top in (2, 3, 4):
            slope = lambda e: sum(k * V[k - 2] * e**(k - 1) for k in range(2, top + 1)) - load * -u[crown]   # noqa: E731
            error.append(brentq(slope, 0, 2 * load) * -u[crown] / exact - 1)
        print("arch: errors of V to degree 2, 3, 4", error)
        self.assertLess(error[0], -.1)
        self.assertLess(abs(error[1]), .01)
        self.assertLess(abs(error[2]), 2e-4)

    def test_strip_buckles_sideways_after_it_bent(self):
        """K_G alone does not know how far the strip bends before; V3 and V4 do."""
        num, EIz, GJ = 16, 20., .8
        s, rods = chain([(0, 0, 0), (1, 0, 0)], [(0, 1, 0)], num, 1e5, (GJ, 1., EIz))
        F = unit(s, 6 * num + 1)
        u = solve_static(s, F)
        g, = s.groups
        K_G = np.zeros_like(s.K)
        for e, rows in enumerate(g.gdofs()):
            K_G[np.ix_(rows, rows)] += np.einsum("s,sij->ij", g.F[e] @ u[rows], g.P[e])
        free = np.ix_(s.free, s.free)
        value, shape = eigh(-K_G[free], s.K[free])
        side = np.zeros(s.num_dofs)
        side[s.free] = shape[:, -1]
        side /= np.abs(side[2::6]).max()
        V = Manifold(s, np.stack([u, side], 1)).energy()
        L = [Table(2, 1, (Table.points(2, 1) @ [u @ F, 0])[:, None])]

        def stiffness(load):
            return Polynomial(V).all(find_rest(V, L, load, np.array([load, 0])))[2][1, 1, 0]
        found = brentq(stiffness, 1 / value[-1], 2 / value[-1])

        def determinant(load):
            n, h = np.array([0, load, 0.]), 1e-4
            m = rods.solve([n])[1]
            return np.linalg.det([(rods.run(np.r_[n, m + h * d], [n])[3] - rods.run(np.r_[n, m - h * d], [n])[3])[:2]
                                  for d in np.eye(3)[:2]])
        exact = brentq(determinant, 1.02 / value[-1], 1.1 / value[-1], xtol=1e-6)
        print("strip: K_G", 1 / value[-1] / exact, "third order", found / exact)
        self.assertAlmostEqual(1 / value[-1] / exact, 1 / 1.0561, delta=1e-3)
        self.assertAlmostEqual(found / exact, 1, delta=5e-3)


class TestLinks(unittest.TestCase):
    def test_load_on_an_arm_works_to_all_degrees(self):
        """One node on springs of a beam, an arm s: x = R(θ) s. Degree 2 is -½ θᵀK_arm θ, (3) of carried-bodies.md."""
        s, _ = chain([(0, 0, 0), (1, 0, 0)], [(0, 1, 0)], 1, 1e3, (1., 1.3, 1.7), range(6), [(2, 1)], [(1.2, .5, -.3)])
        arm, f = s.X[2] - s.X[1], np.array([.3, -.7, .4])
        rng = np.random.default_rng(2)
        u = np.zeros((5, s.num_dofs))
        u[1, 9:12] = theta = rng.normal(size=3)
        work = s.complete(u)[:, 2, :3] @ f
        K_arm = f @ arm * np.eye(3) - (np.outer(f, arm) + np.outer(arm, f)) / 2
        self.assertAlmostEqual(work[2], -theta @ K_arm @ theta / 2, delta=1e-13)
        turn = np.cross(theta, arm)
        self.assertAlmostEqual(work[3], np.cross(theta, np.cross(theta, turn)) @ f / 6, delta=1e-13)
        self.assertAlmostEqual(work[4], np.cross(theta, np.cross(theta, np.cross(theta, turn))) @ f / 24, delta=1e-13)

    def test_twelve_inertial_loads_of_a_mass_on_an_arm(self):
        """Work on the manifold by reciprocity is that of the fields themselves, to degree 4."""
        s, _ = chain([(0, 0, 0), (1, 0, 0), (1, .7, 0)], [(0, 1, 0), (1, 0, 0)], 4, 1e3, (1., 1.3, 1.7), range(6),
                     [(9, 8)], [(1.2, .9, -.3)])
        mass = np.full(10, .2)
        mass[9] = 3
        shapes = np.stack([solve_static(s, unit(s, 6 * 8 + k)) for k in (1, 2)], 1)
        m = Manifold(s, shapes, order=4)
        axes = np.eye(3)
        fields = [np.tile(a, (10, 1)) for a in axes] + [np.cross(a, s.X) for a in axes]
        fields += [np.cross(a, np.cross(a, s.X)) for a in axes]
        fields += [np.cross(a, np.cross(b, s.X)) + np.cross(b, np.cross(a, s.X))
                   for a, b in ((axes[0], axes[1]), (axes[0], axes[2]), (axes[1], axes[2]))]
        for X in fields:
            f = np.zeros((10, 6))
            f[:, :3] = mass[:, None] * X
            for k, table in enumerate(m.load(f.ravel()), 1):
                eta = Table.points(2, k)
                moved = s.complete(m.curve(eta, 5))[k].reshape(len(eta), -1)
                np.testing.assert_allclose(table(eta), moved @ f.ravel(), atol=1e-12)


class TestSmallModes(unittest.TestCase):
    """A mast with a mass on a rigid arm: four bending modes large, twist modes small."""

    def setUp(self):
        length, num, arm = 2., 12, np.array([.1, .25, -.15])
        self.s, self.rods = chain([(0, 0, 0), (length, 0, 0)], [(0, 1, 0)], num, 7e6, (39., 140., 56.),
                                  links=[(num + 1, num)], extra=[arm + (length, 0, 0)])
        masses = np.zeros((num + 2, 6))
        masses[:num + 1, :3], masses[num + 1, :3] = .54 / num, .5
        masses[:num + 1, 3] = .54 / num * 2.8e-5
        independent, free = self.s.independent, self.s.free
        M = np.zeros_like(self.s.K)
        M[np.ix_(independent, independent)] = self.s.T.T @ np.diag(masses.ravel()) @ self.s.T
        K = self.s.K[np.ix_(free, free)]
        values, vectors = eigh(M[np.ix_(free, free)], K)     # massless rotations: infinite eigenvalues of the other order
        self.Phi = np.zeros((self.s.num_dofs, 6))
        self.Phi[free] = vectors[:, :-7:-1]                  # unit strain energy

    def test_quartic_energy_without_what_small_modes_follow(self):
        """V₄ with W of all modes is that of the large ones and ½ cᵀKc, c the static amplitudes of the small ones."""
        large, small = self.Phi[:, :4], self.Phi[:, 4:]
        alone, held = Manifold(self.s, large), Manifold(self.s, large, W=self.s.K @ self.Phi)
        eta = np.random.default_rng(5).normal(size=(4, 4))
        c = held.residual[2](eta) @ small
        V = [m.energy((3, 4)) for m in (alone, held)]
        np.testing.assert_allclose(V[0][0](eta), V[1][0](eta), atol=1e-9)
        np.testing.assert_allclose(V[0][1](eta) + .5 * (c**2).sum(1), V[1][1](eta), rtol=1e-8)
        print("V4 of the large modes alone, and with the small ones held:", V[0][1](eta), V[1][1](eta))
        np.testing.assert_allclose(alone.u[2](eta) @ self.s.K @ small, -c, atol=1e-9)


class TestInvariance(unittest.TestCase):
    corners = [(0, 0, 0), (1, 0, 0), (1, .7, 0), (1, .7, .5)]

    def make(self, R=np.eye(3), shift=(0, 0, 0), size=1., held=range(6)):
        y = [R @ v for v in ((0, 1, 0), (1, 0, 0), (1, 0, 0))]
        return chain(np.array(self.corners) @ R.T * size + shift, y, 4, 1e4,
                     (.6 * size**2, size**2, 2.5 * size**2), held)[0]

    def test_axes_origin_and_units(self):
        """Tables in two static shapes: turned, moved, and in lengths of 1/1000."""
        R = rotate(np.array([np.zeros(3), [.4, -.8, .3]]))[0] @ np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
        R *= np.sign(np.linalg.det(R))
        tables = []
        for Q, shift, size in ((np.eye(3), (0, 0, 0), 1.), (R, (3., -20., 7.), 1.), (np.eye(3), (0, 0, 0), 1000.)):
            s = self.make(Q, shift, size)
            shapes = []
            for f in ((1, 0, 1), (.3, 1, .2)):
                F = np.zeros(s.num_dofs)
                F[-6:-3] = Q @ f
                shapes.append(solve_static(s, F) * 2)
            scale = size                                # unit load in N, EA in N, lengths in mm: u in mm
            m = Manifold(s, np.stack(shapes, 1))
            F = np.zeros(s.num_dofs)
            F[-6:-3] = Q @ (.2, .5, -1)
            tables.append([t.c / scale for t in m.energy()] + [t.c / scale for t in m.load(F)])
        for other in tables[1:]:
            for a, b in zip(tables[0], other):
                np.testing.assert_allclose(b, a, atol=1e-9 * np.abs(tables[0][2]).max())

    def test_frame_held_at_nodes_or_mean(self):
        """Static shape of a spring between the ends: how far they near, in the mean frame and in frames held at nodes.
        Fields differ from degree 2 on, the answer from the third power of the load on."""
        s = self.make(held=())
        n, a, b = s.num_dofs, 0, len(s.X) - 1
        mass = np.tile([1., 1, 1, 1e-3, 1e-3, 1e-3], len(s.X))
        rigid = np.zeros((n, 6))
        for k in range(3):
            rigid[k::6, k] = rigid[3 + k::6, 3 + k] = 1
            rigid.reshape(-1, 6, 6)[:, :3, 3 + k] = np.cross(np.eye(3)[k], s.X)
        chord = s.X[b] - s.X[a]
        f = np.zeros(n)
        f[6 * a:6 * a + 3] = chord / np.linalg.norm(chord)
        f[6 * b:6 * b + 3] = -f[6 * a:6 * a + 3]
        shape = solve_static(self.make(), f)
        C = mass[:, None] * rigid

        def respond(structure, phi, conditions, loads):
            m = Manifold(structure, phi[:, None], C=conditions)
            V = Polynomial(m.energy())
            d = Polynomial([Table(1, k, coefficients=m.u[k].c[:, 6 * b:6 * b + 3] - m.u[k].c[:, 6 * a:6 * a + 3])
                            for k in (1, 2, 3)])
            out = []
            for load in loads:
                def slope(e):
                    D = chord + d.value([e])
                    return V.all([e])[1][0, 0] + load * d.all([e])[1][0] @ D / np.linalg.norm(D)
                e = brentq(slope, 0, 2 * load)
                out.append(np.linalg.norm(chord + d.value([e])) - np.linalg.norm(chord))
            return np.array(out)
        loads = np.array([.02, .04])
        mean = respond(s, shape - rigid @ np.linalg.solve(C.T @ rigid, C.T @ shape), C, loads)
        for node in (0, 4, 10):
            rows = slice(6 * node, 6 * node + 6)
            phi = shape - rigid @ np.linalg.solve(rigid[rows], shape[rows])
            phi[rows] = 0
            difference = respond(self.make(held=range(6 * node, 6 * node + 6)), phi, None, loads) - mean
            print("frame at node", node, difference / mean, "order", np.log2(difference[1] / difference[0]))
            self.assertLess(np.abs(difference / mean).max(), 2e-3)
            self.assertGreater(np.log2(difference[1] / difference[0]), 2.8)


class TestMotion(unittest.TestCase):
    """The beam of the spin-up: 8 m, three modes; exact: inextensible, the same three modes."""
    length, EI, mass = 8., 6.895e10 * 8.2181e-9, 1.6154

    @classmethod
    def setUpClass(cls):
        num = cls.num = 16
        s, _ = chain([(0, 0, 0), (cls.length, 0, 0)], [(0, 1, 0)], num, 6.895e10 * 7.3e-5, (cls.EI,) * 3, planar(num + 1))
        simpson = np.full(num + 1, 2.)
        simpson[1::2], simpson[[0, -1]] = 4, 1
        cls.masses = cls.mass / num * simpson / 3
        M = np.zeros(s.num_dofs)
        M[0::6] = M[1::6] = cls.masses
        root = np.sqrt(M[s.free])
        flexibility = np.linalg.inv(s.K[np.ix_(s.free, s.free)])
        values, shapes = np.linalg.eigh(root[:, None] * flexibility * root)
        phi = np.zeros((s.num_dofs, 3))
        phi[s.free] = flexibility @ (root[:, None] * shapes[:, :-4:-1])
        cls.Phi = phi / phi[6 * num + 1]
        cls.omega = values[:-4:-1]**-.5
        cls.X, m = s.X, Manifold(s, cls.Phi, order=4)
        cls.V = m.energy((2, 3, 4, 5, 6))
        cls.fields = [Table(3, k, coefficients=t.c.reshape(len(t.c), -1, 6)[..., :3]) for k, t in m.u.items()]

    def make(self, degree, energy, fields=None):
        return Points(self.X, (fields or self.fields)[:degree], self.masses, self.V[:energy - 1])

    def find_peak(self, points, fields, rate):
        tip = Polynomial([Table(3, t.degree, coefficients=t.c[:, self.num, 1:2]) for t in fields])
        s = points.integrate(7.0, spin_up(rate), rtol=1e-6)
        return min(tip.value(y)[0] for y in s.sol(np.linspace(6.3, 7.0, 701))[:3].T)

    def project(self, extra):
        """u2..u4 on the affine fields without their part along the modes, and on `extra` fields of what u2 leaves."""
        root = np.sqrt(self.masses)[:, None]
        flat = lambda c: (c * root).reshape(len(c), -1)                            # noqa: E731
        modes = flat(self.fields[0].c).T
        modes = modes / np.linalg.norm(modes, axis=0)
        affine = np.array([np.outer(g, a) for g in (np.ones(len(self.X)), self.X[:, 0]) for a in np.eye(3)])
        affine = flat(affine).T
        basis = np.linalg.qr(affine - modes @ (modes.T @ affine))[0]
        rest = flat(self.fields[1].c).T
        rest = rest - basis @ (basis.T @ rest)
        weight = [np.prod((self.omega[0] / self.omega)**(2 * e)) for e in self.fields[1].e]
        basis = np.concatenate([basis, np.linalg.svd(rest * weight)[0][:, :extra]], 1)
        return self.fields[:1] + [Table(3, t.degree, coefficients=(flat(t.c) @ basis @ basis.T).reshape(t.c.shape) / root)
                                  for t in self.fields[1:]]

    def test_spin_up(self):
        """Peaks at 4 and 6 rad/s: of three geometrically exact beams (shear, stretch) -0.5338 and -0.7508."""
        exact = Cantilever(self.length, self.EI, self.mass, 3, cells=24)
        peaks = []
        for rate in (4., 6.):
            s = exact.integrate(7.0, spin_up(rate), rtol=1e-6)
            peaks.append((exact.tip @ s.sol(np.linspace(6.3, 7.0, 701))[:3]).min())
        np.testing.assert_allclose(peaks, [-0.53384, -0.75089], atol=1e-5)
        for name, degree, energy, fields, expected in (
                ("u2, V2", 2, 2, self.fields, (-0.53647, -0.75885)), ("u2, V4", 2, 4, self.fields, (-0.53441, -0.75377)),
                ("u4, V4", 4, 4, self.fields, (-0.53385, -0.75098)), ("u4, V6", 4, 6, self.fields, peaks),
                ("affine, V6", 4, 6, self.project(0), peaks), ("affine and one, V6", 4, 6, self.project(1), peaks)):
            tolerances = (1e-4, 3e-4) if energy == 6 else (5e-5, 5e-5)
            for k, rate in enumerate((4., 6.)):
                if k == 0 and energy < 6:
                    continue
                peak = self.find_peak(self.make(degree, energy, fields), fields[:degree], rate)
                print(f"spin-up: {name}, {rate} rad/s: {peak:.5f}, off {peak / peaks[k] - 1:.1e}")
                self.assertAlmostEqual(peak / expected[k], 1, delta=tolerances[k])

    def test_backbone(self):
        """Frequency of the first free motion at a tip amplitude of 0.2 lengths over that of small ones."""
        amplitude = self.length * np.array([.2])
        exact = Cantilever(self.length, self.EI, self.mass, 3, cells=16).find_backbone(amplitude)
        exact /= 3.5160152685 * np.sqrt(self.EI * self.length / self.mass) / self.length**2
        self.assertAlmostEqual(exact[0], 1.000787, delta=3e-6)
        tip = Polynomial([Table(3, t.degree, coefficients=t.c[:, self.num, 1:2]) for t in self.fields])
        error = {}
        for degree, energy in ((2, 2), (2, 4), (4, 4), (4, 6)):
            found = self.make(degree, energy).find_backbone(tip, amplitude, self.omega[0]) / self.omega[0]
            error[degree, energy] = (found - exact)[0]
            print(f"backbone: fields to {degree}, energy to {energy}: off {error[degree, energy]:.1e}")
        self.assertLess(error[2, 2], -.01)
        self.assertLess(error[4, 4], -4e-4)                 # u2·u4 of T without V6
        self.assertLess(abs(error[2, 4]), 2e-4)
        self.assertLess(abs(error[4, 6]), 2e-5)


if __name__ == "__main__":
    unittest.main()
