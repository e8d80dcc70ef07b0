"""Responses of decks solved directly (SOL 108 and 109): the closed forms and SciPy solutions of the modal tests, the
solution by modes with all of them, and the order of the steps over time."""
import unittest

import h5py
import numpy as np
from scipy.integrate import solve_ivp

import deck_response_refusals_test as refusals
import deck_response_structures_test as structures
import deck_response_test as modal
from deck_response_case import CHAIN, FRAME, ONE, C, DeckResponse, K, M, read


class Direct(DeckResponse):
    """Every deck as SOL 108 or 109; over time what the steps leave is below 1e-8."""
    def solve(self, verb, deck, *options):
        deck = deck.replace("SOL 111", "SOL 108").replace("SOL 112", "SOL 109")
        found = super().solve(verb, deck, *options)
        with h5py.File(self.path("d.h5")) as f:
            self.assertTrue(all(group.attrs["method"] == "direct" for group in f["subcases"].values()))
        return found

    def near(self, found, expected, relative=1e-10):
        super().near(found, expected, max(relative, 1e-8) if self.is_over_time else relative)

    is_over_time = False

    def time(self):
        self.is_over_time = True


def take(cls, *names):
    """The tests of these names alone, from the modal class."""
    def wrap(own):
        for name in dir(cls):
            if name.startswith("test_") and name not in names and name not in vars(own):
                setattr(own, name, None)
        return own
    return wrap


@take(modal.OneMass, "test_structural", "test_loads", "test_tables", "test_transmissibility")
class OverFrequency(Direct, modal.OneMass):
    def test_viscous(self):
        r, w = self.frequency("CDAMP2,3,2.4,1,1,2,1")
        u = 2.5 / (K - M * w**2 + 1j * C * w)
        self.near(r["displacement"][1, 1], u, 1e-12)
        self.near(r["acceleration"][1, 1], -w**2 * u, 1e-12)
        self.near(r["spc_force"][2, 1], -(K + 1j * C * w) * u, 1e-12)

    def test_rayleigh(self):
        r, w = self.frequency("PARAM,ALPHA1,.2\nPARAM,ALPHA2,.03")
        self.near(r["displacement"][1, 1], 2.5 / (K - M * w**2 + 1j * w * (.2 * M + .03 * K)), 1e-12)

    def test_undamped(self):
        """A real matrix, on both sides of the resonance."""
        r, w = self.frequency("")
        self.near(r["displacement"][1, 1], 2.5 / (K - M * w**2), 1e-12)

    def test_direct_stiffness(self):
        """K2PP and B2PP join the matrices; PARAM,G does not act on K2PP."""
        dmig = "DMIG,{0},0,6,1,0\nDMIG,{0},1,1,,1,1,{1}\n"
        r, w = self.frequency("PARAM,G,.1\n" + dmig.format("EXTRA", 14.) + dmig.format("DRAG", .7),
                              "K2PP = EXTRA\nB2PP = DRAG")
        self.near(r["displacement"][1, 1], 2.5 / (K * (1 + .1j) + 14 - M * w**2 + .7j * w), 1e-12)


@take(modal.OneMass, "test_step_and_ramp", "test_start", "test_base_motion", "test_broken_line")
class OverTime(Direct, modal.OneMass):
    is_over_time = True

    def test_order(self):
        """A smooth load: the error falls with the fifth power of the step, down to 10 steps in a period."""
        errors, p, w = [], 2 * np.pi, 3.0
        for n in [40, 80, 160]:
            r, t = self.transient("", load="TLOAD2,9,10,,,0.,9.,1.,-90.\nDAREA,10,1,1,2.5",
                                  steps=f"TSTEP,5,{n},{4 / n},{n // 40}")
            exact = 2.5 / (K - M * p**2) * (np.sin(p * t) - p / w * np.sin(w * t))
            errors.append(np.abs(r["displacement"][1, 1] - exact).max() / np.abs(exact).max())
        self.assertLess(errors[0], 2e-5)
        for coarse, fine in zip(errors, errors[1:]):
            self.assertAlmostEqual(np.log2(coarse / fine), 5, delta=.3)

    def test_equation_of_motion(self):
        """Velocity, acceleration and reaction are those of the displacement: the equation of motion holds."""
        r, t = self.transient("CDAMP2,3,2.4,1,1,2,1", load="TLOAD2,9,10,,,0.,9.,1.,-90.\nDAREA,10,1,1,2.5")
        u, v, a = (r[name][1, 1] for name in ("displacement", "velocity", "acceleration"))
        super(Direct, self).near(M * a + C * v + K * u, 2.5 * np.sin(2 * np.pi * t), 1e-11)
        super(Direct, self).near(r["spc_force"][2, 1], -C * v - K * u, 1e-11)

    def test_w3(self):
        r, t = self.transient("PARAM,G,.2\nPARAM,W3,3.", load="TLOAD2,9,10,,,0.,9.\nDAREA,10,1,1,2.5")
        z, w = .1, 3.0
        wd = w * np.sqrt(1 - z * z)
        u = 2.5 / K * (1 - np.exp(-z * w * t) * (np.cos(wd * t) + z / np.sqrt(1 - z * z) * np.sin(wd * t)))
        self.near(r["displacement"][1, 1], u)


@take(modal.Chain, "test_coupled", "test_base", "test_transient", "test_transient_w4")
class Chain(Direct, modal.Chain):
    is_over_time = True

    def test_all_modes(self):
        """The solution by all modes, over frequency."""
        deck = CHAIN.format(sol=111, modes=3, case="DLOAD = 9\nFREQUENCY = 5",
                            bulk="RLOAD1,9,10,,,1.\nFREQ1,5,0.,.05,80\n" + self.LOAD)
        direct = self.solve("frequency", deck)[1]
        self.write("m.bdf", deck)
        self.bough("frequency", "m.bdf", "-o", "m.h5")
        by_modes = read(self.path("m.h5"))[1]
        for quantity in ["displacement", "acceleration", "spc_force"]:
            for dof, values in by_modes[quantity].items():
                if np.abs(values).max() > 0:
                    super(Direct, self).near(direct[quantity][dof], values, 1e-11)


class NoMass(Direct, modal.NoMass):
    def test_transient(self):
        """A massless point follows at once; a damper on it too, which modes cannot do."""
        bulk = "TLOAD2,9,10,,,0.,9.\nTSTEP,5,200,.02\n"
        deck = self.DECK.format(sol=112, case="TSTEP = 5", bulk=bulk)
        r = self.solve("transient", deck)[1]
        k = 36 * 20 / 56
        u1 = 2.5 * 36 / 56 / k * (1 - np.cos(np.sqrt(k / 4) * r["x"]))
        self.time()
        self.near(r["displacement"][1, 1], u1)
        self.near(r["displacement"][2, 1], (2.5 + 36 * u1) / 56)
        r = self.solve("transient", deck.replace("ENDDATA", "CDAMP2,4,3.,2,1\nENDDATA"))[1]
        rate = lambda t, y: [y[2], (2.5 - 56 * y[1] + 36 * y[0]) / 3, 36 * (y[1] - y[0]) / 4]
        exact = solve_ivp(rate, (0, 4), [0, 0, 0], t_eval=r["x"], rtol=1e-12, atol=1e-14, method="DOP853").y
        super(Direct, self).near(r["displacement"][1, 1], exact[0], 1e-6)
        super(Direct, self).near(r["displacement"][2, 1], exact[1], 1e-5)


@take(structures.Structures, "test_static_limit", "test_cantilever")
class Structures(Direct, structures.Structures):
    def test_scipy(self):
        """A frame with consistent mass, GE in some bars, PARAM,G, a bush that damps; every dof and reaction."""
        deck = FRAME.format(modes=30, cd="", v="0.,0.,1.")
        r = self.solve("frequency", deck)[1]
        self.bough("matrices", "d.bdf", "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            F = self.load(f["dof_map"][()])
        load = lambda f, w: F * (1 + f / 100 if f < 100 else 2.0) * np.exp(
            1j * (np.radians(10 + 20 * min(f, 200) / 100 + 30) - w * .01))
        dofs, exact = self.direct(deck, r["x"], load, .02)
        for i, (u, reaction) in enumerate(exact):
            self.near(np.array([r["displacement"][tuple(dof)][i] for dof in dofs]), u, 1e-8)
            held = [row for row, dof in enumerate(dofs) if dof[0] == 1]
            self.near([r["spc_force"][tuple(dofs[row])][i] for row in held], reaction[held], 1e-8)

    def test_free_body(self):
        """A free beam over frequency, and over time against SciPy: the rotations of lumped mass have none."""
        deck = ("SOL 111\nCEND\nSPC = 1\nDLOAD = 9\n{case}\nDISPLACEMENT = ALL\nVELOCITY = ALL\nBEGIN BULK\n"
                "MAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-4,1.-8,2.-8,1.-8\nDAREA,10,3,2,3.\nSPC1,1,4,1\n{bulk}"
                + "".join(f"GRID,{i + 1},,{.5 * i},0.,{.1 * i}\n" for i in range(5))
                + "".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0.\n" for i in range(4)) + "ENDDATA\n")
        r = self.solve("frequency", deck.format(case="FREQUENCY = 5", bulk="PARAM,G,.02\nFREQ,5,.01,2.,9.\nRLOAD1,9,10,,,1.\n"))[1]
        mass = 2700e-4 * 4 * np.hypot(.5, .1)
        w = 2 * np.pi * .01
        self.assertLess(abs(-w**2 * r["displacement"][3, 2][0] / (3 / mass) - 1), 1e-3)
        text = deck.format(case="TSTEP = 5", bulk="TLOAD2,9,10,,,0.,9.\nTSTEP,5,100,.0005\n").replace("SOL 111", "SOL 112")
        r = self.solve("transient", text)[1]
        self.bough("matrices", "d.bdf", "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            get = lambda name: structures.csr_matrix((f[name]["data"][()], f[name]["indices"][()], f[name]["indptr"][()]),
                                                shape=f[name]["shape"][()]).toarray()
            stiff, mass, dofs = get("K"), get("M"), f["dof_map"][()]
        heavy = np.diag(mass) > 0
        self.assertEqual(heavy.sum(), 15)
        light = ~heavy & ~((dofs[:, 0] == 1) & (dofs[:, 1] == 4))
        follow = np.linalg.solve(stiff[np.ix_(light, light)], stiff[np.ix_(light, heavy)])  # what turns without mass
        reduced = stiff[np.ix_(heavy, heavy)] - stiff[np.ix_(heavy, light)] @ follow
        lam, phi = np.linalg.eigh(reduced / np.sqrt(np.outer(np.diag(mass)[heavy], np.diag(mass)[heavy])))
        phi = phi / np.sqrt(np.diag(mass)[heavy])[:, None]
        force = np.array([3.0 * (g == 3 and c == 2) for g, c in dofs[heavy]])
        t = r["x"]
        w = np.sqrt(np.maximum(lam, 0))
        q = np.array([p / lam_j * (1 - np.cos(w_j * t)) if w_j > 1 else p * t * t / 2 for p, lam_j, w_j in zip(phi.T @ force, lam, w)])
        exact = phi @ q
        found = np.array([r["displacement"][tuple(dof)] for dof in dofs[heavy]])
        super(Direct, self).near(found, exact, 2e-4)

    def test_wide_constraint(self):
        """An RBE3 over more grids than a row of the matrices may have entries: its part of low rank, against all modes."""
        n = 320
        deck = ("SOL 111\nCEND\nSPC = 1\nMETHOD = 1\nDLOAD = 9\nFREQUENCY = 5\nDISPLACEMENT = ALL\nBEGIN BULK\nEIGRL,1,,,400\n"
                "PARAM,G,.03\nFREQ,5,.3,.6\nRLOAD1,9,10,,,1.\nDAREA,10,999,1,3.\nGRID,999,,0.,0.,0.,,23456\nCONM2,998,999,,.5\n"
                "CELAS2,997,40.,999,1\nCDAMP2,996,2.,999,1\n"
                + "RBE3,7,,999,1,1.,1" + "".join((",\n" if i % 8 == 2 else "") + f",{i}" for i in range(1, n + 1)) + "\n"
                + "".join(f"GRID,{i},,{i / 10},0.,0.,,23456\nCONM2,{1000 + i},{i},,{1 + i % 7}.\nCELAS2,{2000 + i},{20 + i % 11}.,{i},1\n"
                          for i in range(1, n + 1)) + "SPC1,1,2,1\nENDDATA\n")
        direct = self.solve("frequency", deck)[1]
        i = np.arange(1, n + 1)
        m, k = 1.0 + i % 7, 20.0 + i % 11
        for row, f in enumerate(direct["x"]):
            w = 2 * np.pi * f
            t = np.full(n, 1 / n)
            Z = np.diag(k * (1 + .03j) - w * w * m) + np.outer(t, t) * (40 * (1 + .03j) - w * w * .5 + 2j * w)
            u = np.linalg.solve(Z, 3 * t)
            self.near([direct["displacement"][g, 1][row] for g in i], u, 1e-9)


class Stresses(DeckResponse):
    """A strip of two shells and a bar beside it, pulled and bent: stresses are those of the forces."""
    DECK = ("SOL {sol}\nCEND\nSPC = 1\nDLOAD = 9\n{case}\nFORCE = ALL\nSET 4 = 1, 3\nSTRESS(PUNCH) = 4\nBEGIN BULK\nPARAM,G,.05\n"
            "PARAM,W3,50.\nMAT1,1,7.+4,,.3,2.7-3\nPSHELL,1,1,.5,1,,1\nPBAR,2,1,.3,.04,.02,.05\n,.2,.1\n"
            + "".join(f"GRID,{1 + i + 3 * j},,{i}.,{j}.,0.\n" for j in range(2) for i in range(3))
            + "CQUAD4,1,1,1,2,5,4\nCQUAD4,2,1,2,3,6,5\nCBAR,3,2,2,3,0.,0.,1.\nSPC1,1,123456,1,4\n"
            "DAREA,10,3,1,50.\nDAREA,10,6,3,2.\n{bulk}ENDDATA\n")

    def stresses(self):
        with h5py.File(self.path("d.h5")) as f:
            group = f["subcases/1"]
            get = lambda g: g["value"][()] if "value" in g else g["real"][()] + 1j * g["imag"][()]
            return {f"{kind}/{card}": (g["id"][()].tolist(), list(g.attrs["components"]), get(g))
                    for kind in ("elements", "stresses") for card, g in group[kind].items()}

    def check(self, verb, sol, case, bulk, *options):
        self.write("d.bdf", self.DECK.format(sol=sol, case=case, bulk=bulk))
        said = self.bough(verb, "d.bdf", "-o", "d.h5", "--csv", "d.csv", "--punch", "d.pch", *options).stdout
        found = self.stresses()
        force = dict(zip(found["elements/CQUAD4"][1], found["elements/CQUAD4"][2][:, 0].T))
        ids, names, values = found["stresses/CQUAD4"]
        self.assertEqual(ids, [1])
        stress = dict(zip(names, values[:, 0].T))
        mean = lambda name: np.mean([force[key] for key in force if key.split("@")[0] == name], axis=0)
        for c in ("x", "y", "xy"):
            name = c if len(c) > 1 else 2 * c
            for side, sign in (("top", 1), ("bottom", -1)):
                self.near(stress[f"{name}@{side}"], mean("N" + c) / .5 + sign * mean("M" + c) * .25 / (.5**3 / 12), 1e-9)
        ids, names, values = found["stresses/CBAR"]
        bar = dict(zip(found["elements/CBAR"][1], found["elements/CBAR"][2][:, 0].T))
        at_c = bar["axial"] / .3 - bar["moment_z_a"] * .2 / .04 + bar["moment_y_a"] * .1 / .02
        self.near(dict(zip(names, values[:, 0].T))["xx@C_a"], at_c, 1e-9)
        self.assertIn("CQUAD4:stress", said)
        with open(self.path("d.pch")) as f:
            text = f.read()
        self.assertIn("$ELEMENT STRESSES OF CQUAD4", text)
        self.assertNotIn("$ELEMENT FORCES", text)
        return stress

    def test_over_frequency(self):
        case, bulk = "FREQUENCY = 5", "RLOAD1,9,10,,,1.\nFREQ,5,0.,20.,150.\n"
        direct = self.check("frequency", 108, case, bulk)
        by_modes = self.check("frequency", 108, case, bulk, "--modes", "60")
        for name, values in by_modes.items():
            self.near(direct[name], values, 1e-8)

    def test_over_time(self):
        for sol in (109, 112):
            s = self.check("transient", sol, "TSTEP = 5", "TLOAD2,9,10,,,0.,9.,20.\nTSTEP,5,20,.002\n")
            x, y, xy = (s[f"{c}@top"] for c in ("xx", "yy", "xy"))
            self.near(s["von_mises@top"], np.sqrt(x * x - x * y + y * y + 3 * xy * xy), 1e-12)


class Choices(refusals.Refusals):
    def test_which_solution(self):
        good, residuals = "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,1.,1.1,1.2,1.7,2.9\n", []
        for sol, options, is_direct in [(108, (), True), (111, (), False), (111, ("--direct",), True),
                                        (108, ("--modal",), False), (108, ("--modes", "1"), False), (101, (), False)]:
            self.write("d.bdf", self.deck(good, sol=sol))
            said = self.bough("frequency", "d.bdf", *options)
            self.assertEqual("; direct" in said.stdout, is_direct, f"SOL {sol} {options}")
            residuals.append(float(said.stdout.split("residual of the response ")[1].split()[0]))
            self.assertEqual("[cli.by-modes]" in said.stderr, sol == 108 and not is_direct)
        self.assertTrue(0 < max(residuals) < 1e-12, residuals)
        self.bough("frequency", "d.bdf", "--direct", "--modes", "3", code=2)

    def test_modal_requests(self):
        good = "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nTABDMP1,6,CRIT\n,.01,.02,9.,.02,ENDT\n"
        self.refuse("modal.no-modes", self.deck(good + "FREQ4,5,.1,1.,.1,1", sol=108), says=["FREQ4", "--modal"])
        self.write("d.bdf", self.deck(good + "FREQ,5,1.", "DLOAD = 9\nFREQUENCY = 5\nSDAMPING = 6", sol=108))
        self.assertRegex(self.bough("frequency", "d.bdf").stderr, r"SDAMPING.*\[modal.no-modes\]")

    def test_unbounded(self):
        free = "SOL 108\nCEND\nDLOAD = 9\nFREQUENCY = 5\nBEGIN BULK\nGRID,1,,,,,,23456\nGRID,2,,1.,,,,23456\nCONM2,1,1,,2.\nCONM2,2,2,,2.\n" \
               "CELAS2,3,9.,1,1,2,1\nRLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,{}\nENDDATA\n"
        self.refuse("modal.unbounded-response", free.format("0."), code=3, says=["moves freely"])
        self.refuse("modal.unbounded-response", free.format(repr(3 / 2 / np.pi)), code=3)
        self.write("d.bdf", free.format("1."))
        self.bough("frequency", "d.bdf")
        # The frequencies beside that of the mode are kept: x1 = F (k - ω² m) / ((k - ω² m)² - k²) of two masses.
        pole = 3 / 2 / np.pi
        for way in ("--direct", "--modal"):
            self.write("d.bdf", free.format(f".1,.2,{pole!r},.7"))
            text = self.bough("frequency", "d.bdf", way, "-o", "r.h5").stderr
            self.assertRegex(text, r"warning: the response at 0.4774648\d* Hz is unbounded.*left out")
            with h5py.File(self.path("r.h5")) as f:
                group = f["subcases"][list(f["subcases"])[0]]
                hz = group["frequency_hz"][:]
                found = group["displacement"]
                np.testing.assert_allclose(hz, [.1, .2, .7])
                column = found["dofs"][:].tolist().index([1, 1])
                s = 9 - 2 * (2 * np.pi * hz) ** 2
                np.testing.assert_allclose(found["real"][:, column], 2 * s / (s * s - 81), rtol=1e-9)
        # A bar of lumped mass turns about its own axis without any.
        self.refuse("modal.unbounded-response", ONE.format(
            sol=109, case="DLOAD = 9\nTSTEP = 5", bulk="TLOAD2,9,10,,,0.,9.\nDAREA,10,1,1,1.\nTSTEP,5,9,.1\nGRID,3,,2.,0.,0.\nGRID,4,,3.,0.,0.\n"
            "MAT1,1,7.,,.3,2.\nPBAR,1,1,1.,1.,1.,1.\nCBAR,9,1,3,4,0.,1.,0."), "transient", code=3, says=["neither mass nor"])


for name in dir(refusals.Refusals):
    if name.startswith("test_") and name not in vars(Choices):
        setattr(Choices, name, None)
del name

if __name__ == "__main__":
    unittest.main()
