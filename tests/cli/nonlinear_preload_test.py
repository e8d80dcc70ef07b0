"""Bodies that start from the deformed shape of a preload: [body.preload] nonlinear = true."""
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh
from support import ProgramTest

E, RHO = 7e10, 2700.


def write_card(name, *fields):
    return ",".join([name] + [str(f) if isinstance(f, (int, str)) else repr(float(f)) for f in fields]) + "\n"


def write_bars(places):
    """GRIDs 1, 2, ... at the places, and CBARs of property 1 from each to the next."""
    grids = [write_card("GRID", i, "", *place) for i, place in enumerate(places, 1)]
    return "".join(grids + [write_card("CBAR", i, 1, i, i + 1, 0., 1., 0.) for i in range(1, len(grids))])


class NonlinearPreload(ProgramTest):
    def reduce(self, deck, tip, modes=6, preload="load_set = 5\nnonlinear = true", more="", name="deck"):
        self.write(f"{name}.bdf", deck)
        self.write(f"{name}.toml", f'[body]\nname = "b"\ndeck = "{name}.bdf"\nframe = "fixed"\ninterface = [{tip}]\n'
                   f'[body.modes]\nnumber = {modes}\nresidual = ["interface"]\n' + more
                   + (f"[body.preload]\n{preload}\n" if preload else ""))
        self.bough("reduce", f"{name}.toml", "-o", f"{name}.h5", "-q")
        with h5py.File(self.path(f"{name}.h5")) as f:
            at = list(f["nodes/id"][:]).index(tip)
            return {"hz": f["modes/frequency_hz"][:], "phi": f["modes/phi"][at], "K": f["modal/stiffness"][:],
                    "x": f["nodes/xyz"][at]}

    def solve_static(self, deck, tip):
        self.write("static.bdf", deck)
        self.bough("static", "static.bdf", "--nonlinear", "-o", "static.h5", "-q")
        with h5py.File(self.path("static.h5")) as f:
            rows = [i for i, (node, c) in enumerate(f["dof_map"][:]) if node == tip and c <= 3]
            return f["subcases/1/displacement" if "1" in f["subcases"] else "subcases/0/displacement"][:][rows]

    def make_frame(self, num, force, more=""):
        """An L-frame in space of bars with offsets; at its end a rigid arm, a bush, a mean of grids and masses."""
        corners = np.array([(0, 0, 0), (1, 0, 0), (1, .7, .2)])
        X = np.array([corners[0]] + [a + (b - a) * i / num for a, b in zip(corners[:-1], corners[1:])
                                     for i in range(1, num + 1)])
        text = "SOL 106\nCEND\nSPC = 1\nLOAD = 5\nBEGIN BULK\nPARAM,LGDISP,1\nSPC1,1,123456,1\n"
        text += f"MAT1,1,{E!r},2.6+10,,{RHO!r}\nPBAR,1,1,1.-4,8.-10,2.-9,1.5-9\n"
        for i, x in enumerate(X):
            text += write_card("GRID", i + 1, "", *x)
        for i in range(len(X) - 1):
            v = (.1, 1., .2) if i < num else (1., 0., .3)
            text += write_card("CBAR", i + 1, 1, i + 1, i + 2, *v) + ",,,0.,.004,.006,0.,.004,.006\n"
        end = len(X)
        text += "GRID,901,,1.1,.8,.3\nGRID,902,,1.05,.85,.1\nGRID,903,,1.2,.8,.2\nGRID,904,,1.2,.8,.2\n"
        text += f"RBE2,910,{end},123456,901\nRBE3,911,,902,123456,1.,123456,{end},{end - num // 4}\n"
        text += "PBUSH,2,K,4.+4,5.+4,6.+4,300.,200.,250.\nCBUSH,912,2,903,904,,,,0\nRBE2,913,901,123456,903\n"
        text += "CONM2,920,902,,.05\nCONM2,921,904,,.1,.02,.03,-.01\n,1.-4,,2.-4,,,3.-4\n"
        return text + write_card("FORCE", 5, 904, 0, 1., *force) + more + "ENDDATA\n", 904

    def test_flexibility_is_the_slope_of_the_nonlinear_displacements(self):
        """Differences of `static --nonlinear` by the load; the mesh leaves h²."""
        force, off, step = np.array([3., -2., 6.]), [], 1e-3
        for num in (8, 16):
            deck, tip = self.make_frame(num, force)
            way = np.linalg.norm(self.solve_static(deck, tip))
            slope = np.array([(self.solve_static(self.make_frame(num, force + step * e)[0], tip)
                               - self.solve_static(self.make_frame(num, force - step * e)[0], tip)) / (2 * step)
                              for e in np.eye(3)]).T
            body = self.reduce(deck, tip)
            phi = body["phi"][:3]
            flexibility = phi @ np.linalg.solve(body["K"], phi.T)
            plain = self.reduce(deck, tip, preload="")
            undeformed = plain["phi"][:3] @ np.linalg.solve(plain["K"], plain["phi"][:3].T)
            off.append(np.abs(flexibility - slope).max() / np.abs(slope).max())
            print(f"way {way:.3f} m, {2 * num} bars: flexibility off by {off[-1]:.1e}, "
                  f"undeformed by {np.abs(undeformed - slope).max() / np.abs(slope).max():.2f}")
        self.assertGreater(way, .15)
        self.assertGreater(np.abs(undeformed - slope).max() / np.abs(slope).max(), .1)
        self.assertLess(off[1], 2e-4)
        self.assertGreater(off[0] / off[1], 3)

    def find_chain(self, num, length, EI, mass, force):
        """Frequencies in its plane of a cantilever of rigid links with springs, bent by a dead force at its end."""
        h = length / num
        k = np.full(num, EI / h)
        k[0] *= 2                                  # the clamp is half a link from its spring
        theta = np.zeros(num)

        def springs(t):
            d = np.diff(np.concatenate([[0], t]))
            return k * d

        for share in np.linspace(0, 1, 11)[1:]:
            for _ in range(30):
                m = springs(theta)
                g = m - np.append(m[1:], 0) - share * h * (-force[0] * np.sin(theta) + force[1] * np.cos(theta))
                K = np.diag(k + np.append(k[1:], 0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
                K += np.diag(share * h * (force[0] * np.cos(theta) + force[1] * np.sin(theta)))
                step = np.linalg.solve(K, g)
                theta = theta - step
                if np.abs(step).max() < 1e-13:
                    break
        # Half the mass of a link at either end of it.
        J = np.zeros((num, 2, num))
        for i in range(num):
            J[i:, 0, i] = -h * np.sin(theta[i])
            J[i:, 1, i] = h * np.cos(theta[i])
        m = np.full(num, mass * h)
        m[-1] /= 2
        M = np.einsum("n,nai,naj->ij", m, J, J)
        value = eigh(K, M, eigvals_only=True, subset_by_index=[0, 3])
        tip = np.array([h * np.cos(theta).sum() - length, h * np.sin(theta).sum()])
        return np.sqrt(value) / (2 * np.pi), tip

    def test_cantilever_bent_by_half_its_length(self):
        """Modes in its plane, against a chain of rigid links with springs."""
        length, A, I = 2., 1e-2, 8e-10           # thin: a chain has no strain along it
        force = np.array([-6., 30.])
        f, tips = zip(*(self.find_chain(n, length, E * I, RHO * A, force) for n in (200, 400)))
        exact = (4 * f[1] - f[0]) / 3
        tip = (4 * tips[1] - tips[0]) / 3
        off = []
        for num in (20, 40):
            text = "SOL 101\nCEND\nSPC = 1\nBEGIN BULK\nGRDSET,,,,,,,345\nSPC1,1,123456,1\n"
            text += f"MAT1,1,{E!r},,.3,{RHO!r}\nPBAR,1,1,{A!r},{I!r},2.-9,1.-9\nPARAM,COUPMASS,1\n"
            text += write_bars([(length * i / num, 0., 0.) for i in range(num + 1)])
            text += write_card("FORCE", 5, num + 1, 0, 1., force[0], force[1], 0.) + "ENDDATA\n"
            body = self.reduce(text, num + 1, modes=4)
            off.append(np.abs(body["hz"][:4] / exact - 1).max())
            np.testing.assert_allclose(body["x"] - (length, 0, 0), [*tip, 0], atol=1e-4)
        plain = self.reduce(text, num + 1, modes=4, preload="")
        print(f"end {tip[1] / length:.2f} lengths: frequencies off by {off[0]:.1e}, {off[1]:.1e}; "
              f"undeformed {np.abs(plain['hz'][:4] / exact - 1).max():.2f}")
        self.assertGreater(tip[1] / length, .4)
        self.assertLess(off[1], 1e-3)
        self.assertGreater(off[0] / off[1], 3)

    def test_sag_of_a_cable(self):
        """A heavy cable between supports: modes in and out of its plane by Irvine (Cable Structures, 1981)."""
        num, span, mass, EA, g = 60, 100., 2., 5e7, 9.81
        area = 1e-3
        Ec, rho = EA / area, mass / area
        text = "SOL 106\nCEND\nSPC = 1\nLOAD = 5\nBEGIN BULK\nPARAM,LGDISP,1\nPARAM,COUPMASS,1\n"
        text += f"MAT1,1,{Ec!r},,.3,{rho!r}\nPBAR,1,1,{area!r},1.-9,1.-9,1.-9\nGRAV,5,0,{g!r},0.,0.,-1.\n"
        text += f"SPC1,1,1234,1,{num + 1}\n"
        # It starts slack, on a parabola of its length at the sag sought minus the stretch of its tension.
        sag = 2.
        H = mass * g * span**2 / (8 * sag)
        x = np.linspace(0, span, num + 1)
        free = sag * np.sqrt(1 - 3 / 8 * span**2 / sag**2 * H / EA)
        text += write_bars([(s, 0., -4 * free * s * (span - s) / span**2) for s in x])
        body = self.reduce(text + "ENDDATA\n", num // 2 + 1, modes=8)
        found = np.sqrt(mass) * body["hz"][:8] * 2 * span
        depth = -body["x"][2]
        tension = mass * g * span**2 / (8 * depth)
        ratio = found / np.sqrt(tension)
        length = span * (1 + 8 * (depth / span)**2)
        squared = (mass * g * span / tension)**2 * span / (tension * length / EA)
        # Symmetric modes in the plane: tan(w/2) = w/2 - 4/λ² (w/2)³, w in units of π here.
        z = np.linspace(.01, 4.5 * np.pi, 400001) / 2
        r = np.sin(z) - np.cos(z) * (z - 4 / squared * z**3)
        roots = 2 * z[:-1][np.sign(r[1:]) != np.sign(r[:-1])] / np.pi
        exact = np.sort(np.concatenate([[1, 2, 3, 4], [2, 4], roots[roots < 4.5]]))[:6]
        print(f"sag {depth / span:.4f}, lambda² {squared:.2f}: {np.round(ratio[:6], 4)} exact {np.round(exact, 4)}")
        np.testing.assert_allclose(np.sort(ratio)[:6], exact, rtol=4e-3)

    def write_column(self, load, held):
        """Cantilever of 1.7 m under `load` times its buckling load, and its body file with the preload in line 6."""
        A, I, length, num = 4e-4, 6e-9, 1.7, 12
        force = load * np.pi**2 * E * I / (4 * length**2)
        text = "SOL 106\nCEND\nSPC = 1\nLOAD = 5\nBEGIN BULK\nPARAM,LGDISP,1\n"
        text += f"MAT1,1,{E!r},,.3,{RHO!r}\nPBAR,1,1,{A!r},{I!r},3.-8,5.-9\nSPC1,1,{held},1\n"
        text += write_bars([(length * i / num, 0., 0.) for i in range(num + 1)])
        self.write("deck.bdf", text + write_card("FORCE", 5, num + 1, 0, 1., -force, 0., 0.) + "ENDDATA\n")
        self.write("b.toml", '[body]\nname = "b"\ndeck = "deck.bdf"\n[body.modes]\nnumber = 4\n[body.preload]\n'
                   "load_set = 5\nnonlinear = true\n")

    def test_load_above_the_buckling_load(self):
        """The advice is that of a body file, at the line of its preload; Euler's load is the share that is reached."""
        for load in (1.01, 1.3):
            self.write_column(load, 123456)
            output = self.fails(3, "reduce", "b.toml", "-o", "x.h5", error="fe.no-equilibrium",
                              says=["b.toml:6: error: no stable static equilibrium", "lower the load of the preload"]).stderr
            for option in ("--arc-length", "--increments"):
                self.assertNotIn(option, output)
            self.assertAlmostEqual(float(output.split("beyond ")[1].split()[0]) * load, 100, delta=.5)
        self.assertIn("--arc-length", self.fails(3, "static", "deck.bdf", error="fe.no-equilibrium").stderr)

    def test_mechanism(self):
        """The message of a mechanism is that of statics."""
        self.write_column(.5, 123)
        output = []
        for arguments in (("static", "deck.bdf"), ("reduce", "b.toml", "-o", "x.h5")):
            text = self.fails(1, *arguments, error="fe.mechanism", says=["mechanism 1 of 3"]).stderr
            output.append([line.split("error: ")[1] for line in text.splitlines() if "error: " in line])
        self.assertEqual(output[0], output[1])

    def test_tension_holds_a_mechanism(self):
        """A pinned boom that the preload pulls swings as a rod: ω² = 3 F/(ρ A L²), bending left out."""
        self.write_column(-.05, 1234)
        self.bough("reduce", "b.toml", "-o", "x.h5", "-q")
        with h5py.File(self.path("x.h5")) as f:
            hz = f["modes/frequency_hz"][:2]
        force = .05 * np.pi**2 * E * 6e-9 / (4 * 1.7**2)
        np.testing.assert_allclose(hz, np.sqrt(3 * force / (RHO * 4e-4 * 1.7**2)) / (2 * np.pi), rtol=.01)

    def test_what_it_cannot_do_is_named(self):
        deck, tip = self.make_frame(8, (1., 0., 0.))
        for preload, frame, says in (("spin = [0.0, 0.0, 1.0]\nnonlinear = true", "fixed", "spin"),
                                     ("load_set = 5\nnonlinear = true", "free", "nothing holds the free body")):
            self.write("deck.bdf", deck)
            self.write("b.toml", f'[body]\nname = "b"\ndeck = "deck.bdf"\nframe = "{frame}"\ninterface = [{tip}]\n'
                       f"[body.modes]\nnumber = 4\n[body.preload]\n{preload}\n")
            self.fails(1, "reduce", "b.toml", "-o", "x.h5", says=[says], error="reduce.bad-preload")
        self.write("b.toml", f'[body]\nname = "b"\ndeck = "deck.bdf"\nframe = "fixed"\ninterface = [{tip}]\n'
                   "[body.modes]\nnumber = 4\n[body.preload]\nload_set = 5\nnonlinear = true\n")
        ranks = self.bough("reduce", "b.toml", "-o", "x.h5", code=1,
                           launcher=["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"])
        self.assertIn("found several ranks; leave mpirun out [reduce.bad-preload]", ranks.stderr)
        bend = "PBEND,3,1,4.-4,3.-8,5.-8,6.-8,2,1.5\nCBEND,105,3,3,10,0.,1.,0.,1\n"
        self.write("deck.bdf", deck.replace("ENDDATA", bend + "ENDDATA"))
        self.write("b.toml", f'[body]\nname = "b"\ndeck = "deck.bdf"\nframe = "fixed"\ninterface = [{tip}]\n'
                   "[body.modes]\nnumber = 4\n[body.preload]\nload_set = 5\nnonlinear = true\n")
        self.fails(1, "reduce", "b.toml", "-o", "x.h5", says=["CBEND", "deck.bdf:"], error="fe.nonlinear-preload")


if __name__ == "__main__":
    unittest.main()
