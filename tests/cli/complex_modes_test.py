"""Complex modes (SOL 107 and 110): closed forms, dense SciPy solutions of the same matrices, 107 against 110."""
import json
import unittest

import h5py
import numpy as np
import scipy.linalg

from support import ProgramTest
from decks import OSCILLATOR, begin

ONE = begin("{sol}", "SPC = 1", "METHOD = 1", "CMETHOD = 9", "{case}") + """EIGRL,1,,,{modes}
EIGC,9,{eigc}
""" + OSCILLATOR + """{bulk}
ENDDATA
"""
# Six masses in a row that move along x, springs between neighbours and to ground at both ends.
N = 6
MASS = np.array([1.0, 2.0, 1.5, 0.7, 3.0, 1.2])
SPRING = np.array([800.0, 500.0, 900.0, 300.0, 700.0, 400.0, 600.0])


# Millimetres and tonnes: a plate with a lumped mass (75 modes) and a mast on a bush, GE of two materials, a damper at a corner.
PLATE = begin("{sol}", "SPC = 1", "METHOD = 1", "{case}") + """EIGRL,1,,,{modes}
{bulk}
PARAM,G,.01
PSHELL,1,1,1.6,1,,1
MAT1,1,70000.,,.33,2.7-9,,,.02
PBAR,2,2,30.,80.,90.,120.
MAT1,2,210000.,,.3,7.85-9,,,.05
GRID,100,,75.,50.,40.
GRID,101,,75.,80.,40.
CBAR,200,2,15,100,1.,0.,0.
CBUSH,300,5,100,101,,,,0
PBUSH,5,K,3.,4.,5.,600.
,,B,.002,.003,.001
CDAMP2,301,.01,25,3
SPC1,1,123456,101,1,2,3,4
"""
PLATE += "\n".join(f"GRID,{1 + 4 * i + j},,{25. * i},{25. * j},{2 * np.sin(i):.3f}" for i in range(7) for j in range(4)) + "\n"
PLATE += "\n".join(f"CQUAD4,{1 + 3 * i + j},1,{1 + 4 * i + j},{5 + 4 * i + j},{6 + 4 * i + j},{2 + 4 * i + j}"
                   for i in range(6) for j in range(3)) + "\nENDDATA\n"


def make_chain(sol, bulk="", case="", eigc="LAN,,,,,6", modes=N, springs=SPRING, ge=0.0):
    lines = [f"SOL {sol}", "CEND", "SPC = 1", "METHOD = 1", "CMETHOD = 9", case, "BEGIN BULK", f"EIGRL,1,,,{modes}",
             f"EIGC,9,{eigc}"]
    for i in range(N + 2):
        lines.append(f"GRID,{i + 1},,{float(i)},0.,0.")
    for i in range(N):
        lines.append(f"CONM2,{100 + i},{i + 2},,{MASS[i]}")
    for i, k in enumerate(springs):
        lines.append(f"CELAS2,{200 + i},{k},{i + 1},1,{i + 2},1,{ge if i == 2 else 0.0}")
    lines += [f"SPC1,1,123456,1,{N + 2}", f"SPC1,1,23456,2,THRU,{N + 1}", bulk, "ENDDATA", ""]
    return "\n".join(lines)


def make_stiffness(springs=SPRING):
    K = np.zeros((N, N))
    for i, k in enumerate(springs):
        for a in (i - 1, i):
            for b in (i - 1, i):
                if 0 <= a < N and 0 <= b < N:
                    K[a, b] += k if a == b else -k
    return K


def make_dampers(seed):
    """Dampers between random masses and their matrix."""
    random = np.random.default_rng(seed)
    B, cards = np.zeros((N, N)), []
    for e in range(5):
        a, b = random.choice(N, 2, replace=False)
        c = round(float(random.uniform(0.5, 6)), 3)
        B[[a, b], [a, b]] += c
        B[a, b] -= c
        B[b, a] -= c
        cards.append(f"CDAMP2,{300 + e},{c},{a + 2},1,{b + 2},1")
    return B, "\n".join(cards)


def make_dmig(name, A, ids):
    lines = [f"DMIG,{name},0,1,1,0"]
    for j in range(len(ids)):
        for i in range(len(ids)):
            if A[i, j] != 0:
                lines.append(f"DMIG,{name},{ids[j][0]},{ids[j][1]},,{ids[i][0]},{ids[i][1]},{float(A[i, j])!r}")
    return "\n".join(lines)


def solve_dense(M, B, K):
    """Eigenvalues with Im >= 0 in the order of the tables, by the QZ algorithm on the linearization."""
    n = len(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K, -B]])
    E = np.block([[np.eye(n), np.zeros((n, n))], [np.zeros((n, n)), M]])
    values = scipy.linalg.eig(A, E, right=False)
    values = values[np.isfinite(values) & (np.abs(values) < 1e7)]
    values = np.where(np.abs(values.imag) < 1e-7 * np.abs(values), values.real, values)
    values = values[values.imag >= 0]
    return values[np.lexsort((-values.real, np.round(values.imag, 7)))]


class ComplexModes(ProgramTest):
    def solve(self, deck, *options, residual=1e-10):
        self.write("d.bdf", deck)
        result = self.bough("modes", "d.bdf", "--json", "-o", "d.h5", *options)
        self.result = json.loads(result.stdout)
        modes = self.result["modes"]
        self.assertLess(max(m["residual"] for m in modes), residual)
        return np.array([complex(m["eigenvalue"]["real"], m["eigenvalue"]["imag"]) for m in modes])

    def near(self, found, expected, relative=1e-9):
        self.assertEqual(len(found), len(expected), (found, expected))
        for a, b in zip(found, expected):
            self.assertLess(abs(a - b), relative * abs(b), (found, expected))

    def check_shapes(self, M, B, K, ids):
        """Rows of the grids' x translation and of the points satisfy the equation; left vectors that of the transpose."""
        with h5py.File(self.path("d.h5")) as f:
            nodes, points = list(f["nodes/id"][:]), list(f["points/id"][:]) if "points" in f else []
            values = f["modes/eigenvalue_real"][:] + 1j * f["modes/eigenvalue_imag"][:]
            for name, matrices in (("phi", (M, B, K)), ("left", (M.T, B.T, K.T))):
                if f"modes/{name}_real" not in f:
                    continue
                shapes = f[f"modes/{name}_real"][:] + 1j * f[f"modes/{name}_imag"][:]
                if points:
                    at_points = f[f"points/{name}_real"][:] + 1j * f[f"points/{name}_imag"][:]
                x = np.array([shapes[nodes.index(g), 0] if g in nodes else at_points[points.index(g)] for g in ids])
                for j, p in enumerate(values):
                    terms = [p**2 * matrices[0] @ x[:, j], p * matrices[1] @ x[:, j], matrices[2] @ x[:, j]]
                    self.assertLess(np.linalg.norm(sum(terms)), 1e-8 * sum(map(np.linalg.norm, terms)), (name, j))
                    self.assertAlmostEqual(np.abs(x[:, j]).max(), 1, places=9)

    def test_files(self):
        """f06 (summary, shapes in CD axes), table and shapes as CSV, VTU, page of an unsymmetric chain; y of grid 4 is -x."""
        extra = ("CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n" + "\n".join(f"CDAMP2,{400 + i},{9.0 if i == 1 else .1},{i + 1},1" for i in range(1, 4)))
        deck = make_chain("107", extra, "K2PP = KX\nDISPLACEMENT(PHASE) = ALL", "HESS").replace("GRID,4,,3.0,0.,0.", "GRID,4,,3.0,0.,0.,7")
        deck = deck.replace("CEND", "CEND\nTITLE = CHAIN", 1).replace("ENDDATA", "DMIG,KX,0,1,1,0\nDMIG,KX,2,1,,3,1,40.\nENDDATA")
        deck = deck.replace("SPC1,1,23456,2,THRU,7", "SPC1,1,23456,2,3,5,6,7\nSPC1,1,13456,4")
        deck = deck.replace(",3,1,4,1,", ",3,1,4,2,").replace(",4,1,5,1,", ",4,2,5,1,").replace("CDAMP2,403,0.1,4,1", "CDAMP2,403,0.1,4,2")
        found = self.solve(deck, "--f06", "d.f06")
        f06 = self.read("d.f06")
        summary = f06.split("C O M P L E X   E I G E N V A L U E   S U M M A R Y")[1].splitlines()[3:3 + len(found)]
        table = np.array([line.split() for line in summary], float)
        np.testing.assert_allclose(table[:, 2] + 1j * table[:, 3], found, rtol=2e-6, atol=1e-6)
        np.testing.assert_allclose(table[:, 4], found.imag / 2 / np.pi, rtol=2e-6, atol=1e-9)
        with h5py.File(self.path("d.h5")) as f:
            ids, phi = list(f["nodes/id"][:]), f["modes/phi_real"][:] + 1j * f["modes/phi_imag"][:]
            damping = f["modes/damping"][:]
        np.testing.assert_allclose(table[:, 5], damping, rtol=2e-6, atol=1e-12)
        pages = f06.split("C O M P L E X   E I G E N V E C T O R   N O .")
        self.assertEqual(len(pages), len(found) + 1)
        last = pages[-1].splitlines()
        at = next(i for i, line in enumerate(last) if line.split()[:2] == ["4", "G"])
        magnitude = float(last[at].split()[3])  # T2
        self.assertAlmostEqual(magnitude, abs(phi[ids.index(4), 0, -1]), delta=2e-6)
        phase = np.angle(-phi[ids.index(4), 0, -1], deg=True) % 360
        self.assertAlmostEqual(float(last[at + 1].split()[1]), phase, delta=1e-3)
        self.bough("export", "d.h5", "--to", "csv", "--channel", "modes", "-o", "m.csv")
        rows = np.array([line.split(",") for line in self.read("m.csv").splitlines()[1:]], float)
        np.testing.assert_allclose(rows[:, 1] + 1j * rows[:, 2], found, rtol=1e-15)
        self.bough("export", "d.h5", "--to", "csv", "-o", "s.csv")
        head, *lines = self.read("s.csv").splitlines()
        column = head.split(",").index("mode_002_x_imag")
        np.testing.assert_allclose([float(line.split(",")[column]) for line in lines], phi[:, 0, 1].imag, rtol=1e-15, atol=1e-300)
        self.bough("export", "d.h5", "--to", "vtu", "-o", "d.vtu")
        self.bough("modes", "d.bdf", "--vtu", "e.vtu")
        self.assertEqual(self.read("d.vtu"), self.read("e.vtu"))
        self.bough("report", "d.h5", "-o", "d.html")
        page = self.read("d.html")
        for text in ("complex modes", "Poles", "damping ratio %", "real part", '"complex":true'):
            self.assertIn(text, page)

    def test_units(self):
        """Shifts of EIGC follow the unit of time; block sizes of LAN have none."""
        for eigc in ("INV\n,-1.,30.,-2.,40.,1.,,2", "LAN\n,-1.,30.,7.,2.,,,2"):
            deck = make_chain("107", make_dampers(3)[1], "", eigc)
            found = self.solve(deck)
            self.bough("convert", "d.bdf", "--units", "m-kg-s:m-kg-ms", "-o", "e.bdf")
            with open(self.path("e.bdf")) as f:
                lines = f.read().splitlines()
            fields = [float(x or 0) for x in lines[[k for k, line in enumerate(lines) if line.startswith("EIGC")][0] + 1].split(",")[1:6]]
            ends = [-.002, .04, .001] if "INV" in eigc else [7, 2, 0]
            np.testing.assert_allclose(fields, [-.001, .03, *ends], rtol=1e-12)
            self.near(self.solve("\n".join(lines)), found / 1000, 1e-9)

    def test_residual_vectors_of_lumped_masses(self):
        """The more modes of a lumped mass, the less mass have the residual vectors of dampers and of GE: 110 and 107 agree, and
        so do responses by modes and direct ones."""
        self.write("d.bdf", PLATE.format(sol=107, case="CMETHOD = 9", bulk="EIGC,9,LAN,,,,,4", modes=10))
        exact = self.solve(self.read("d.bdf"), residual=1e-8)
        load = "RLOAD1,9,10,,,1.\nDAREA,10,100,1,1.\nFREQ1,5,20.,20.,15"
        case = "DLOAD = 9\nFREQUENCY = 5\nDISPLACEMENT = ALL"

        def respond(sol, modes):
            self.write("r.bdf", PLATE.format(sol=sol, case=case, bulk=load, modes=modes))
            self.bough("frequency", "r.bdf", "-o", "r.h5")
            with h5py.File(self.path("r.h5")) as f:
                part = f["subcases/1/displacement"]
                return part["real"][()] + 1j * part["imag"][()]

        H = respond(108, 10)
        for modes, limit in ((10, 1e-3), (20, 1e-5), (30, 1e-6), (45, 1e-6), (60, 1e-6)):
            found = self.solve(PLATE.format(sol=110, case="CMETHOD = 9", bulk="EIGC,9,LAN,,,,,4", modes=modes), residual=1e-8)
            for value in exact[exact.imag > 0]:
                self.assertLess(np.abs(found - value).min(), limit * abs(value), (modes, found, exact))
            self.assertLess(np.abs(respond(111, modes) - H).max(), limit * np.abs(H).max(), modes)

    def test_selected_matrices(self):
        """A DMIG that K2PP selects is not reported as unused."""
        deck = make_chain("107", "DMIG,KX,0,1,1,0\nDMIG,KX,2,1,,3,1,4.", "K2PP = KX")
        self.write("d.bdf", deck)
        self.assertNotIn("fe.direct-unused", self.bough("modes", "d.bdf").stderr)

    def test_one_dof(self):
        """λ = -c/2m ± i sqrt(k/m - (c/2m)²): g, ζ and Hz."""
        for sol, eigc in (("107", "LAN,,,,,1"), ("110", "HESS"), ("28", "CLAN,MAX,,,,1"), ("29", "ISRR,,,,,1"),
                          ("SEDCEIG", "HESS"), ("SEMCEIG", "LAN,,,,,1"), ("107", "INV\n,0.,1.,0.,5.,1.,1,1")):
            found = self.solve(ONE.format(sol=sol, case="", modes=1, eigc=eigc, bulk="CDAMP2,3,2.4,1,1,2,1"))
            self.near(found, [-0.3 + 1j * np.sqrt(9 - 0.09)], 1e-12)
            mode = self.result["modes"][0]
            self.assertAlmostEqual(mode["damping_ratio"], 0.1, places=12)
            self.assertAlmostEqual(mode["damping"], 0.6 / np.sqrt(8.91), places=12)
            self.assertAlmostEqual(mode["frequency_hz"], np.sqrt(8.91) / (2 * np.pi), places=12)

    def test_subcases(self):
        """Every subcase with CMETHOD has its modes; a static one, whose load preloads another, has none."""
        two = "SUBCASE 1\nCMETHOD = 9\nSUBCASE 2\nCMETHOD = 8"
        self.write("d.bdf", make_chain("107", "EIGC,8,LAN,,,,,3", two).replace("CMETHOD = 9\n", "", 1))
        result = json.loads(self.bough("modes", "d.bdf", "--json").stdout)
        self.assertEqual([s["subcase"] for s in result["subcases"]], [1, 2])
        expected = solve_dense(np.diag(MASS), np.zeros((N, N)), make_stiffness())
        for one, number in zip(result["subcases"], (6, 3)):
            found = [complex(m["eigenvalue"]["real"], m["eigenvalue"]["imag"]) for m in one["modes"]]
            self.near(found, expected[:number])
        static = "SUBCASE 1\nLOAD = 5\nSUBCASE 2\nSTATSUB = 1"
        self.near(self.solve(make_chain("107", "FORCE,5,2,,1.,1.,0.,0.", static)), expected)
        self.bough("check", "d.bdf")

    def test_selected_modes(self):
        """MODSEL of SOL 110: modes 1 and 3 of the chain alone; a set without a mode is an error."""
        expected = solve_dense(np.diag(MASS), np.zeros((N, N)), make_stiffness())
        case = "RESVEC = NO\nSET 4 = 1, 3\nMODSEL = 4"
        found = self.solve(make_chain("110", "", case, "LAN,,,,,2"))
        np.testing.assert_allclose(found, [expected[0], expected[2]], rtol=1e-8)
        for wrong, error in ((case.replace("1, 3", "77"), "modal.empty-selection"), ("MODSEL = 6", "modal.missing-set")):
            self.write("d.bdf", make_chain("110", "", wrong))
            self.fails(1, "modes", "d.bdf", error=error, says=["MODSEL"])
        self.near(self.solve(make_chain("107", "", case)), expected)
        self.assertIn("warning: MODSEL selects real modes", self.bough("modes", "d.bdf").stderr)

    def test_overdamped(self):
        """Two real eigenvalues, g = 0."""
        for sol in ("107", "110"):
            found = self.solve(ONE.format(sol=sol, case="", modes=1, eigc="HESS", bulk="CDAMP2,3,40.0,1,1,2,1"))
            self.near(found, [-1.0, -9.0], 1e-11)
            self.assertEqual([m["damping"] for m in self.result["modes"]], [0, 0])

    def test_structural_damping(self):
        """λ² = -k/m (1 + i g): PARAM,G and GE of the spring alike."""
        expected = [1j * 3 * np.sqrt(1 + 0.04j)]
        for sol in ("107", "110"):
            deck = ONE.format(sol=sol, case="", modes=1, eigc="LAN,,,,,1", bulk="PARAM,G,.04")
            self.near(self.solve(deck), expected, 1e-12)
            self.near(self.solve(deck.replace("PARAM,G,.04", "").replace("36.0,1,1,2,1", "36.0,1,1,2,1,.04")), expected,
                      1e-12)

    def test_table_damping(self):
        """SDAMPING acts on modes (110): 2 ζ ω."""
        deck = ONE.format(sol="110", case="SDAMPING = 5", modes=1, eigc="LAN,,,,,1",
                          bulk="TABDMP1,5,CRIT\n,0.,.03,100.,.03,ENDT")
        self.near(self.solve(deck), [3 * (-0.03 + 1j * np.sqrt(1 - 0.03**2))], 1e-12)

    def test_dampers(self):
        for seed in range(2):
            B, cards = make_dampers(seed)
            for sol, eigc in (("107", "LAN,,,,,6"), ("107", "HESS"), ("110", "HESS")):
                self.near(self.solve(make_chain(sol, cards, eigc=eigc)), solve_dense(np.diag(MASS), B, make_stiffness()))
            self.assertLess(self.result["biorthogonality"], 1e-9)
            self.check_shapes(np.diag(MASS), B, make_stiffness(), range(2, N + 2))

    def test_structural_damping_of_one_spring(self):
        B, cards = make_dampers(8)
        K4 = make_stiffness(np.where(np.arange(N + 1) == 2, SPRING, 0)) * 0.2
        K = make_stiffness() * (1 + 0.03j) + 1j * K4
        for sol in ("107", "110"):
            found = self.solve(make_chain(sol, cards + "\nPARAM,G,.03", ge=0.2))
            self.near(found, solve_dense(np.diag(MASS), B, K))
            self.check_shapes(np.diag(MASS), B, K, range(2, N + 2))

    def test_unsymmetric_input(self):
        """K2PP, B2PP, M2PP without symmetry; PARAM,G does not act on K2PP."""
        random = np.random.default_rng(3)
        B, cards = make_dampers(5)
        ids = [(i + 2, 1) for i in range(N)]
        K2, B2, M2 = (np.round(random.uniform(-s, s, (N, N)), 4) for s in (60, 2, .1))
        bulk = "\n".join([cards, make_dmig("KU", K2, ids), make_dmig("BU", B2, ids), make_dmig("MU", M2, ids),
                          "PARAM,G,.02"])
        M, B, K = np.diag(MASS) + M2, B + B2, make_stiffness() * (1 + .02j) + K2
        for sol in ("107", "110"):
            for eigc in ("LAN,,,,,6", "HESS"):
                found = self.solve(make_chain(sol, bulk, "K2PP = KU\nB2PP = BU\nM2PP = MU", eigc))
                self.near(found, solve_dense(M, B, K))
                self.assertFalse(self.result["symmetric"])
                self.assertLess(self.result["biorthogonality"], 1e-8)
                self.check_shapes(M, B, K, range(2, N + 2))

    def test_extra_point(self):
        """A controller on an extra point: e'' + 3 e' + 50 e = 4 u3', which pulls mass 5."""
        bulk = ("EPOINT,900\nTF,7,900,0,50.,3.,1.\n,3,1,0.,-4.,0.\n"
                "DMIG,PULL,0,1,1,0\nDMIG,PULL,900,0,,5,1,25.")
        n = N + 1
        M, B, K = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
        M[:N, :N], K[:N, :N] = np.diag(MASS), make_stiffness()
        M[N, N], B[N, N], K[N, N], B[N, 1], K[3, N] = 1, 3, 50, -4, 25
        for sol in ("107", "110"):
            found = self.solve(make_chain(sol, bulk, "K2PP = PULL\nTFL = 7", "HESS"))
            self.near(found, solve_dense(M, B, K))
            self.check_shapes(M, B, K, [*range(2, N + 2), 900])

    def test_free_body(self):
        """Rigid-body modes are 0, the others those of the dense solution."""
        springs = SPRING.copy()
        springs[[0, N]] = 1e-30
        B, cards = make_dampers(2)
        deck = make_chain("107", cards, eigc="LAN,,,,,5").replace("CELAS2,200,800.0", "$").replace("CELAS2,206,600.0", "$")
        springs[[0, N]] = 0
        found = self.solve(deck)
        expected = solve_dense(np.diag(MASS), B, make_stiffness(springs))
        self.near(found[np.abs(found) > 1e-3], expected[np.abs(expected) > 1e-3])
        self.assertTrue(np.all(found[np.abs(found) < 1e-3] == 0))

    def test_shift(self):
        """Eigenvalues nearest to the shifts of two lines, each with its ND."""
        B, cards = make_dampers(1)
        all_values = solve_dense(np.diag(MASS), B, make_stiffness())
        oscillating = all_values[all_values.imag > 0]
        shifts = [oscillating[1] + 0.3j, oscillating[4] - 0.2j]
        eigc = "LAN" + "".join(f"\n,{s.real:.5f},{s.imag:.5f},,,,,1" for s in shifts)
        found = self.solve(make_chain("107", cards, eigc=eigc))
        found = found[found.imag > 0]
        self.near(found, oscillating[[1, 4]])

    def test_krylov(self):
        """A beam of more unknowns than the dense solver takes: 107 against 110 with all modes near them."""
        n = 120
        bulk = ["MAT1,1,7.+10,,.3,2700.,,,.01", "PBAR,1,1,1.-3,2.-7,4.-7,3.-7"]
        bulk += [f"GRID,{i + 1},,{.02 * i},0.,0." for i in range(n + 1)]
        bulk += [f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0." for i in range(n)]
        bulk += ["SPC1,1,123456,1", f"CDAMP2,900,80.,{n + 1},2,{n // 2},3", f"CDAMP2,901,40.,{n // 3},3",
                 "DMIG,KU,0,1,1,0", f"DMIG,KU,{n + 1},2,,{n + 1},3,300.", f"DMIG,KU,{n + 1},3,,{n + 1},2,-200."]
        head = "SOL {}\nCEND\nSPC = 1\nMETHOD = 1\nCMETHOD = 9\n{}BEGIN BULK\nEIGRL,1,,,60\nEIGC,9,LAN,,,,,12\n"
        for case in ("", "K2PP = KU\n"):
            direct = self.solve(head.format(107, case) + "\n".join(bulk) + "\nENDDATA\n", residual=1e-6)
            self.assertFalse(self.result["complete"])
            self.assertLess(self.result["biorthogonality"], 1e-8)
            modal = self.solve(head.format(110, case) + "\n".join(bulk) + "\nENDDATA\n", residual=1e-6)
            self.assertEqual(np.sum(direct.imag > 0), 12)
            self.near(direct, modal, 2e-7)

    def test_options(self):
        deck = ONE.format(sol="107", case="", modes=1, eigc="LAN,,,,,1", bulk="CDAMP2,3,2.4,1,1,2,1")
        self.solve(deck, "--vtu", "d.vtu")
        with open(self.path("d.vtu"), encoding="utf-8") as f:
            text = f.read()
        self.assertIn("_real", text)
        self.assertIn("_imag", text)
        table = self.bough("modes", "d.bdf").stdout
        for word in ("damping g", "bi-orthogonality", "largest residual"):
            self.assertIn(word, table)
        real = json.loads(self.bough("modes", "d.bdf", "--ignore", "CMETHOD", "--json").stdout)
        self.assertAlmostEqual(real["modes"][0]["eigenvalue"], 9, places=10)
        self.fails(1, "modes", "d.bdf", "--op2", "d.op2", error="cli.complex-option")

    def test_wrong_input(self):
        def fails(code, deck, error, *says):
            self.write("d.bdf", deck)
            self.fails(code, "modes", "d.bdf", error=error, says=says)
        deck = make_chain("107")
        fails(1, deck.replace("EIGC,9,LAN,,,,,6", "$"), "modal.missing-complex-method", "d.bdf:5:", "CMETHOD = 9")
        fails(1, deck.replace("CMETHOD = 9", "$"), "modal.no-complex-method", "CMETHOD")
        self.near(self.solve(deck.replace("CMETHOD = 9", "$"), "-n", "6"),
                  solve_dense(np.diag(MASS), np.zeros((N, N)), make_stiffness()))
        fails(1, deck.replace("LAN,,,,,6", "FEER,,,,,6"), "deck.bad-word", "d.bdf:9:", "METHOD")
        fails(1, deck.replace("LAN,,,,,6", "INV,,,,,6"), "deck.missing-field", "ALPHAA")
        fails(1, deck.replace("LAN,,,,,6", "LAN,POINT,,,,6"), "deck.missing-field", "POINT")
        fails(1, make_chain("107", case="K2PP = NONE"), "fe.missing-direct", "NONE")
        fails(1, make_chain("107", "DMIG,KU,0,9,1,0,,,2\nDMIG,KU,1,0,,2,1,4.", "K2PP = KU"), "modal.direct-shape", "IFO 9")
        fails(1, make_chain("107", case="TFL = 4"), "modal.missing-transfer", "TFL = 4")
        fails(1, make_chain("107", "EPOINT,900\nTF,7,900,3,1.,1.,1.", "TFL = 7"), "fe.bad-component", "extra point 900")
        # An extra point with a column and no row: the matrices are singular at every λ.
        fails(3, make_chain("107", "EPOINT,900\nDMIG,KU,0,1,1,0\nDMIG,KU,900,0,,2,1,4.", "K2PP = KU"),
              "modal.singular-pencil", "extra point 900")
        self.write("d.bdf", make_chain("107", eigc="LAN,,,,,9"))
        self.assertIn("modal.fewer-complex-modes", self.bough("modes", "d.bdf").stderr)
        self.write("d.bdf", make_chain("107", "EPOINT,900"))
        self.assertIn("modal.extra-point-unused", self.bough("modes", "d.bdf").stderr)

if __name__ == "__main__":
    unittest.main()
