"""Preload: STATSUB in modes, statics and buckling and [body.preload] against closed forms, on whole decks."""
import json
import math
import unittest

import h5py
import numpy as np
from scipy.linalg import eigh
from scipy.optimize import brentq

from support import ProgramTest

TENSION = 50.0
CHAIN = "SUBCASE 1\nLOAD = 10\nSUBCASE 2\n%s = 1\nMETHOD = 7\n" % "STATSUB(PRELOAD)"


def write_line(control, cards, num=20, length=1.0, sol="103", element="CROD,{e},1,{a},{b}", grid="GRID,{g},,{x!r},0.,0."):
    """A line of `num` elements along x from grid 1 to grid num + 1."""
    lines = [f"SOL {sol}", "CEND", control.rstrip(), "BEGIN BULK"]
    lines += [grid.format(g=i + 1, x=round(length * i / num, 12)) for i in range(num + 1)]
    lines += [element.format(e=i + 1, a=i + 1, b=i + 2) for i in range(num)]
    return "\n".join(lines) + "\n" + cards + "ENDDATA\n"


STRING = ("PROD,1,1,2.-6\nMAT1,1,7.+10,,.3,2500.\nSPC1,1,23,1\nSPC1,1,123,{n}\nFORCE,10,1,,%r,-1.,0.,0.\n" % TENSION)
BAR = "CBAR,{e},1,{a},{b},0.,1.,0."
COLUMN = ("PBAR,1,1,1.-4,2.-9,1.-9,2.-9\nMAT1,1,7.+10,,.3,2700.\nPARAM,COUPMASS,1\nEIGRL,7,,,%d\n"
          "SPC1,1,23,1\nSPC1,1,1234,21\nSPC1,1,4,1\nFORCE,10,1,,%r,1.,0.,0.\nFORCE,20,1,,1.,1.,0.,0.\n")
EI = (70.0, 140.0)
M_LINE = 2700 * 1e-4


class Preload(ProgramTest):
    def run_json(self, *arguments):
        return json.loads(self.bough(*arguments, "--json").stdout)

    def close(self, found, expected, rel):
        self.assertEqual(len(found), len(expected), found)
        for f, e in zip(found, expected):
            self.assertAlmostEqual(f / e, 1, delta=rel, msg=f"{list(found)} {list(expected)}")

    # Strings: all their transverse stiffness is preload; AUTOSPC must see it.
    def test_string(self):
        num, mu = 40, 2500 * 2e-6
        for word in ("STATSUB", "STATSUB(PRELOAD)"):
            self.write("s.bdf", write_line("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\n%s = 1\nMETHOD = 7\n" % word,
                                           "EIGRL,7,,,8\n" + STRING.format(n=num + 1), num))
            found = self.run_json("modes", "s.bdf")["frequency_hz"]
            h = 1 / num
            lumped = [math.sqrt(TENSION / mu) / h * math.sin(n * math.pi * h / 2) / math.pi for n in (1, 2, 3, 4)]
            self.close(found, np.repeat(lumped, 2), 1e-9)
            self.close(found[:2], [math.sqrt(TENSION / mu) / 2] * 2, 3e-4)
        result = self.bough("modes", "s.bdf")
        self.assertIn("[fe.preload]", result.stderr)
        self.assertIn("subcase 1 (LOAD 10)", result.stderr)

    # An arm is an arm: as an offset of the bar or as a rigid element, under preload too.
    def test_arms_of_offsets_and_links(self):
        def write(kind):
            lines = ["SOL 103", "CEND", "SPC = 1", "METHOD = 7", "SUBCASE 1", "STATSUB = 2", "SUBCASE 2", "LOAD = 10",
                     "BEGIN BULK", "EIGRL,7,,,6", "SPC1,1,123456,1", "MAT1,1,7.+10,2.7+10,,2700.",
                     "PBAR,1,1,1.-4,2.-9,1.2-9,1.5-9", "CONM2,90,7,,.5,0.,.1,.05", ",.01,,.01,,,.01",
                     "FORCE,10,7,,20.,1.,.05,-.03", "MOMENT,10,7,,4.,.1,.2,.3"]
            lines += [f"GRID,{i},,{.3 * i!r},0.,0." for i in range(1, 8)]
            arms = {3: (None, (.15, .1)), 4: ((-.1, .12), None)}
            for e in range(1, 7):
                ends = [e, e + 1]
                offsets = [(0., 0.), (0., 0.)]
                for side, arm in enumerate(arms.get(e, (None, None))):
                    if arm and kind == "offset":
                        offsets[side] = arm
                    elif arm:
                        ends[side] = 100 * (side + 1) + e
                        lines += [f"GRID,{ends[side]},,{.3 * (e + side)!r},{arm[0]!r},{arm[1]!r}",
                                  f"RBE2,{500 + ends[side]},{e + side},123456,{ends[side]}"]
                lines += [f"CBAR,{e},1,{ends[0]},{ends[1]},0.2,1.,0.3",
                          f",,,0.,{offsets[0][0]!r},{offsets[0][1]!r},0.,{offsets[1][0]!r},{offsets[1][1]!r}"]
            self.write(f"{kind}.bdf", "\n".join(lines) + "\nENDDATA\n")
            self.bough("reduce", f"{kind}.bdf", "--modes", "6", "--interface", "7", "-o", f"{kind}.h5")
            with h5py.File(self.path(f"{kind}.h5")) as f:
                self.assertGreater(np.abs(f["stiffening/kg_preload"][:]).max(), 0)
                shapes = f["modes/phi"][:][list(f["nodes/id"][:]).index(7)]
                sign = np.sign(np.einsum("cn,c->n", shapes, np.arange(1, 7)))
                return [f[name][:] * sign * sign[:, None]
                        for name in ("stiffening/kg_preload", "stiffening/kg_inertial", "stiffening/kg_external")]
        for a, b in zip(write("offset"), write("rbe2")):
            for x, y in zip(a.reshape(-1, *a.shape[-2:]), b.reshape(-1, *b.shape[-2:])):
                self.assertLess(np.abs(x - y).max(), 1e-6 * max(np.abs(x).max(), 1e-9 * np.abs(a).max()))

    def test_chain_of_static_subcases(self):
        # A force across the taut string deflects it by F L / 4 T; its reactions are half of it.
        self.write("s.bdf", write_line("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nLOAD = 20\nSTATSUB(PRELOAD) = 1\n"
                                       "SUBCASE 3\nLOAD = 20\nSTATSUB(PRELOAD) = 4\nSUBCASE 4\nLOAD = 10\n"
                                       "STATSUB(PRELOAD) = 1\n",
                                       STRING.format(n=21) + "FORCE,20,11,,3.,0.,1.,0.\n", sol="101"))
        self.bough("static", "s.bdf", "-o", "s.h5")
        with h5py.File(self.path("s.h5")) as f:
            row = [tuple(r) for r in f["dof_map"][:]].index((11, 2))
            for subcase, tension in (("2", TENSION), ("3", 2 * TENSION)):
                self.assertAlmostEqual(f["subcases"][subcase]["displacement"][row] / (3 / (4 * tension)), 1, delta=1e-9)

    def test_string_under_compression_buckles(self):
        self.write("s.bdf", write_line("SPC = 1\n" + CHAIN, "EIGRL,7,,,2\n" +
                                       STRING.format(n=21).replace("-1.,0.,0.", "1.,0.,0.")))
        result = self.fails(3, "modes", "s.bdf", says=["subcase 1 (LOAD 10)", "s.bdf:7:"], error="fe.preload-buckles")
        self.assertNotIn("[fe.autospc]", result.stderr)

    # Beams.
    def test_beam_under_tension_and_compression(self):
        euler = math.pi ** 2 * min(EI)
        for force in (-2000.0, 0.5 * euler):
            self.write("b.bdf", write_line("SPC = 1\n" + CHAIN, COLUMN % (4, force), element=BAR))
            found = self.run_json("modes", "b.bdf")["eigenvalue"]
            exact = sorted(((n * math.pi) ** 4 * ei - (n * math.pi) ** 2 * force) / M_LINE
                           for n in (1, 2, 3) for ei in EI)[:4]
            self.close(found, exact, 1e-3)
        self.write("b.bdf", write_line("SPC = 1\n" + CHAIN, COLUMN % (4, 1.01 * euler), element=BAR))
        self.fails(3, "modes", "b.bdf", error="fe.preload-buckles")
        self.fails(3, "reduce", "b.bdf", "--modes", "2", "-o", "b.h5", error="fe.preload-buckles")

    def test_buckling_counts_from_the_preload(self):
        euler = math.pi ** 2 * min(EI)
        for preload in (-100.0, 100.0):
            for own in ("", "STATSUB(PRELOAD) = 1\n"):
                self.write("b.bdf", write_line(
                    f"SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nLOAD = 20\n{own}SUBCASE 3\nSTATSUB(PRELOAD) = 1\n"
                    "STATSUB(BUCKLING) = 2\nMETHOD = 7\n", COLUMN % (1, preload), sol="105", element=BAR))
                found = self.run_json("modes", "b.bdf", "--buckling")["load_factor"]
                self.close(found, [euler - preload], 1e-4)
        # One load for both: what is left of it after the preload.
        self.write("b.bdf", write_line("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 3\nSTATSUB(PRELOAD) = 1\nSTATSUB = 1\n"
                                       "METHOD = 7\n", COLUMN % (1, 100.0), sol="105", element=BAR))
        self.close(self.run_json("modes", "b.bdf", "--buckling")["load_factor"], [euler / 100 - 1], 1e-4)

    # A mass on a rigid arm: its only stiffness is that of the arm under its weight, m g l.
    def test_pendulum(self):
        deck = ("SOL 103\nCEND\nSPC = 1\n" + CHAIN + "BEGIN BULK\nEIGRL,7,,,2\nGRID,1,,0.,0.,0.\nGRID,2,,0.,0.,%s\n"
                "RBE2,9,1,123456,2\nCONM2,5,2,,2.5\nSPC1,1,1236,1\nGRAV,10,,9.81,0.,0.,-1.\nENDDATA\n")
        self.write("p.bdf", deck % "-0.4")
        self.close(self.run_json("modes", "p.bdf")["eigenvalue"], [9.81 / 0.4] * 2, 1e-9)
        self.write("p.bdf", deck % "0.4")
        self.fails(3, "modes", "p.bdf", error="fe.preload-buckles")

    def test_membrane(self):
        """A drum of shells without bending, cooled in its rim: zeros of the Bessel functions."""
        rings, E, nu, t, alpha, cold, rho = 10, 4e9, 0.3, 1e-4, 2e-5, -30.0, 1400.0
        grids, ids = [], {}
        for r in range(rings + 1):
            for k in range(max(1, 6 * r)):
                angle = 2 * math.pi * k / max(1, 6 * r)
                ids[r, k] = len(grids) + 1
                grids.append((r / rings * math.cos(angle), r / rings * math.sin(angle)))
        cells = []
        for r in range(rings):
            inner, outer = max(1, 6 * r), 6 * (r + 1)
            for s in range(6):
                for j in range(r + 1):
                    a, b = ids[r, (s * r + j) % inner], ids[r + 1, (s * (r + 1) + j) % outer]
                    c = ids[r + 1, (s * (r + 1) + j + 1) % outer]
                    cells.append((a, b, c))
                    if j < r:
                        cells.append((a, c, ids[r, (s * r + j + 1) % inner]))
        rim = [ids[rings, k] for k in range(6 * rings)]
        deck = ["SOL 103", "CEND", "SPC = 1", "SUBCASE 1", "TEMPERATURE(LOAD) = 10", "SUBCASE 2", "STATSUB = 1", "METHOD = 7",
                "BEGIN BULK", "EIGRL,7,,,6", "PARAM,COUPMASS,1", f"TEMPD,10,{cold}",
                f"MAT1,1,{E!r},,{nu!r},{rho!r},{alpha!r}", f"PSHELL,1,1,{t!r}"]
        deck += [f"GRID,{i + 1},,{x:.9f},{y:.9f},0." for i, (x, y) in enumerate(grids)]
        deck += [f"CTRIA3,{i + 1},1,{a},{b},{c}" for i, (a, b, c) in enumerate(cells)]
        deck += [f"SPC1,1,123,{g}" for g in rim] + ["ENDDATA"]
        self.write("drum.bdf", "\n".join(deck) + "\n")
        wave = math.sqrt(-E * alpha * cold / (1 - nu) / rho)
        exact = [j * wave / (2 * math.pi) for j in (2.404826, 3.831706, 3.831706, 5.135622, 5.135622, 5.520078)]
        self.close(self.run_json("modes", "drum.bdf")["frequency_hz"], exact, 0.02)

    # Rings: a quarter, pressed from outside, by shells of unit width held along the axis.
    def write_ring(self, control, pressure, follow, sol, num=24, R=1.0, t=0.02, mass=""):
        lines = [f"SOL {sol}", "CEND", control.rstrip(), "BEGIN BULK", "CORD2C,5,,0.,0.,0.,0.,0.,1.", ",1.,0.,0.",
                 f"MAT1,1,7.+10,,0.,2700.", f"PSHELL,1,1,{t},1,,1", "EIGRL,7,,,3", mass, "SPC1,1,345,1,THRU,%d" % (2 * num + 2)]
        if follow:
            lines.append(f"PARAM,FOLLOWK,{follow}")
        for i in range(num + 1):
            for k in (0, 1):
                lines.append(f"GRID,{2 * i + k + 1},5,{R},{90.0 * i / num:.9f},{0.05 * k},5")
        for i in range(num):
            a = 2 * i + 1
            lines += [f"CQUAD4,{i + 1},1,{a},{a + 2},{a + 3},{a + 1}", f"PLOAD2,10,{-pressure!r},{i + 1}"]
        for i in (0, num):
            lines += [f"SPC1,1,26,{2 * i + 1},{2 * i + 2}"]
        lines = [line.replace("SPC1,1,345,", "SPC1,1,34,") for line in lines if line]
        # Rotations about the tangent are held with the axial motion; those about the axis bend the ring.
        lines.append("ENDDATA")
        self.write("ring.bdf", "\n".join(lines) + "\n")

    def test_ring_under_external_pressure(self):
        EI_ring = 7e10 * 0.02 ** 3 / 12
        for follow, factor in (("YES", 3), ("NO", 4), (None, 4)):
            self.write_ring("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nMETHOD = 7\n", 1.0, follow, "105")
            found = self.run_json("modes", "ring.bdf", "--buckling")["load_factor"]
            self.assertAlmostEqual(found[0] / (factor * EI_ring), 1, delta=5e-3, msg=follow)
        self.write_ring("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nMETHOD = 7\n", 1.0, "MAYBE", "105")
        self.fails(1, "modes", "ring.bdf", "--buckling", says=["FOLLOWK"], error="fe.bad-param")

    def test_pressurized_cylinder(self):
        """Ovaling of a long cylinder under internal pressure; as it follows the wall, and dead."""
        EI_ring, m, p = 7e10 * 0.02 ** 3 / 12, 2700 * 0.02, 2e5
        for follow in ("YES", "NO"):
            self.write_ring("SPC = 1\nSUBCASE 1\nLOAD = 10\nSUBCASE 2\nSTATSUB = 1\nMETHOD = 7\n", -p, follow, "103")
            found = self.run_json("modes", "ring.bdf")["eigenvalue"]
            for value, n in zip(found, (2, 4)):
                bending = EI_ring * n ** 2 * (n ** 2 - 1) ** 2
                stretch = p * (n ** 2 * (n ** 2 - 1) if follow == "YES" else (n ** 2 - 1) ** 2)
                self.assertAlmostEqual(value * m * (n ** 2 + 1) / (bending + stretch), 1, delta=1e-2, msg=(follow, n))

    # Rotors.
    def write_blade(self, control, cards="", num=30):
        # L = 1, EI = 1 and m = 1 across the plane of the disk; held in it.
        return write_line(control, "PBAR,1,1,1.+6,1000.,1.,1000.\nMAT1,1,1.,,.0,1.-6\nPARAM,COUPMASS,1\nEIGRL,7,,,2\n"
                          "SPC1,1,123456,1\nSPC1,1,1246,2,THRU,%d\nRFORCE,10,1,,%.12f,0.,0.,1.\n" %
                          (num + 1, 12 / (2 * math.pi)) + cards, num, element="CBAR,{e},1,{a},{b},0.,1.,0.").replace(
                              "SPC1,1,1246", "SPC1,1,246")

    def test_rotor(self):
        # Wright, Smith, Thresher and Wang, J. Appl. Mech. 49 (1982) 197: flapping of a uniform blade on no hub at
        # Omega^2 m L^4 / EI = 144.
        self.write("r.bdf", self.write_blade("SPC = 1\n" + CHAIN))
        found = np.sqrt(self.run_json("modes", "r.bdf")["eigenvalue"])
        self.close(found, [13.1702, 37.6031], 1e-3)

    def test_preloaded_body_against_one_that_the_solver_spins(self):
        deck = self.write_blade("SPC = 1\nMETHOD = 7\n")
        self.write("r.bdf", deck)
        body = '[body]\nname = "%s"\ndeck = "r.bdf"\ninterface = [31]\n[body.modes]\nnumber = %d\n'
        self.write("plain.toml", body % ("plain", 10))
        self.write("spun.toml", body % ("spun", 6) + "[body.preload]\nspin = [0.0, 0.0, 12.0]\n")
        self.write("case.toml", body % ("case", 6) + "[preload]\nload_set = 10\n")
        for name in ("plain", "spun", "case"):
            self.bough("reduce", name + ".toml", "-o", name + ".h5")
        with h5py.File(self.path("plain.h5")) as f:
            K = f["modal/stiffness"][:] + 144 * f["stiffening/kg_inertial"][8]
            solver = eigh(K, f["modal/mass"][:], eigvals_only=True)[:2]
            self.assertNotIn("preload", f)
        for name, says in (("spun", "spin (0, 0, 12)"), ("case", "LOAD 10")):
            with h5py.File(self.path(name + ".h5")) as f:
                self.close(f["modes/eigenvalue"][:2], solver, 2e-4)
                self.assertEqual(f["preload"].attrs["loads"], says)
                self.close(f["preload/inertial"][:][[8]], [144.0], 1e-9)
                self.assertEqual(np.count_nonzero(np.abs(f["preload/inertial"][:]) > 1e-9), 1)
                share = np.diag(f["stiffening/kg_preload"][:]) / np.diag(f["modal/stiffness"][:])
                self.assertTrue(0.5 < share[0] < 1)
                # At the spin rate of the preload the stiffness is that of the file; at rest it is that of the unloaded
                # blade.
                K0, kg = f["modal/stiffness"][:], f["stiffening/kg_inertial"][8]
                at_rest = eigh(K0 - 144 * kg, f["modal/mass"][:], eigvals_only=True)
                self.assertAlmostEqual(math.sqrt(at_rest[0]) / 3.51602, 1, delta=2e-2)

    def test_the_solver_does_not_count_a_spin_twice(self):
        self.write("r.bdf", self.write_blade("SPC = 1\nMETHOD = 7\n"))
        system = ('[simulation]\nduration = 0.5\noutput_step = 0.01\n[[body]]\nname = "blade"\n'
                  'file = "%s.h5"\n[[hinge]]\nname = "shaft"\ntype = "revolute"\nchild = "blade"\nchild_node = 1\n'
                  'axis = [0.0, 0.0, 1.0]\nrate = 12.0\n'
                  '[[force]]\nname = "push"\nbody = "blade"\nnode = 31\nforce = [0.0, 0.0, 0.1]\n'
                  '[[sensor]]\nname = "tip"\ntype = "deflection"\nbody = "blade"\nnode = 31\n')
        body = '[body]\nname = "%s"\ndeck = "r.bdf"\ninterface = [31]\n[body.modes]\nnumber = 6\n'
        tips = []
        for name, preload in (("plain", ""), ("spun", "[body.preload]\nspin = [0.0, 0.0, 12.0]\n")):
            self.write("b.toml", body % name + preload)
            self.bough("reduce", "b.toml", "-o", name + ".h5")
            self.write("s.toml", system % name)
            self.bough("run", "s.toml", "-o", name + "-run.h5")
            with h5py.File(self.path(name + "-run.h5")) as f:
                tips.append(f["sensors/tip"][:, 2])
        self.assertLess(np.abs(tips[0] - tips[1]).max(), 0.01 * np.abs(tips[0]).max())

    # Bodies.
    def test_case_control_of_the_deck_preloads_the_body(self):
        cards = COLUMN % (4, -2000.0)
        self.write("b.bdf", write_line("SPC = 1\n" + CHAIN, cards, element=BAR))
        self.write("plain.bdf", write_line("SPC = 1\nMETHOD = 7\n", cards, element=BAR))
        modes = self.run_json("modes", "b.bdf")["eigenvalue"]
        self.assertIn("subcase 1 (LOAD 10)", self.bough("reduce", "b.bdf", "--modes", "4", "-o", "b.h5").stderr)
        self.write("p.toml", '[body]\ndeck = "b.bdf"\n[body.modes]\nnumber = 4\n[preload]\nsubcase = 1\n')
        self.bough("reduce", "p.toml", "-o", "p.h5")
        for name in ("b", "p"):
            with h5py.File(self.path(name + ".h5")) as f:
                self.close(f["modes/eigenvalue"][:], modes, 1e-8)
                K = f["modal/stiffness"][:] - f["stiffening/kg_preload"][:]
                rest = self.run_json("modes", "plain.bdf")["eigenvalue"]
                # The modes of a pinned beam do not change with its tension.
                self.close(sorted(np.diag(K) / np.diag(f["modal/mass"][:]))[:2], rest[:2], 1e-4)

    def test_temperatures_are_a_load_of_the_body(self):
        """K_G2 of a temperature set: the same stress as by a force, on a beam whose ends cannot part."""
        E, A, alpha = 7e10, 1e-4, 1e-5
        deck = write_line("SPC = 1\nMETHOD = 7\n", (COLUMN % (3, 1.0)).replace("2700.", "2700.,1.-5").replace(
            "SPC1,1,23,1\n", "SPC1,1,23,1\nSPC1,1,1,1\n") + "TEMPD,30,-2.5\n", element=BAR)
        self.write("b.bdf", deck)
        self.write("free.bdf", deck.replace("SPC1,1,1,1\n", ""))
        self.write("b.toml", '[body]\ndeck = "b.bdf"\n[body.modes]\nnumber = 3\n[[body.load]]\nname = "cold"\n'
                   'temperature_set = 30\n')
        self.bough("reduce", "b.toml", "-o", "b.h5")
        self.bough("reduce", "free.bdf", "--modes", "3", "--load", "pull=set:10", "--load", "cold=temperature:30",
                   "-o", "free.h5")
        with h5py.File(self.path("b.h5")) as b, h5py.File(self.path("free.h5")) as free:
            cold, (pull, loose) = b["stiffening/kg_external"][0], free["stiffening/kg_external"][:]
            tension = E * A * alpha * 2.5
            self.close(np.diag(cold), -tension * np.diag(pull), 1e-8)
            self.assertLess(np.abs(loose).max(), 1e-8 * np.abs(cold).max())
            self.assertLess(np.abs(b["stiffening/load_resultant"][:]).max(), 1e-6 * tension)

    def test_free_body_by_temperatures_alone(self):
        cards = COLUMN % (3, -50.0)
        self.write("b.bdf", write_line("SPC = 1\n" + CHAIN, cards, element=BAR))
        self.fails(1, "reduce", "b.bdf", "--free", "--modes", "3", "-o", "b.h5", says=["preload"], error="reduce.grounded")

    def test_free_frame_with_a_hot_bar(self):
        """Three bars between rigid ends, the middle one hot: stress in balance with itself leaves rigid motions alone."""
        deck = ("SOL 103\nCEND\nBEGIN BULK\nPARAM,COUPMASS,1\nMAT1,1,7.+10,,.3,2700.,1.-5\nMAT1,2,7.+10,,.3,2700.,0.\n"
                "PBAR,1,1,1.-4,2.-10,2.-10,4.-10\nPBAR,2,2,1.-4,2.-10,2.-10,4.-10\nTEMPD,30,%r\n")
        ends = []
        for k in range(3):
            ends.append((100 * k + 1, 100 * k + 11))
            for i in range(11):
                deck += f"GRID,{100 * k + i + 1},,{0.1 * i:.1f},{0.2 * (k - 1):.1f},0.\n"
            for i in range(10):
                deck += f"CBAR,{100 * k + i + 1},{1 if k == 1 else 2},{100 * k + i + 1},{100 * k + i + 2},0.,0.,1.\n"
        deck += "".join(f"RBE2,{900 + e},{100 + (1, 11)[e]},123456,{(1, 11)[e]},{200 + (1, 11)[e]}\n" for e in (0, 1))
        deck += "ENDDATA\n"
        found = []
        for hot in (1e-9, 2.0):
            self.write("h.bdf", deck % hot)
            self.write("h.toml", '[body]\ndeck = "h.bdf"\nframe = "free"\n[body.modes]\nnumber = 4\n'
                       '[body.preload]\ntemperature_set = 30\n')
            self.bough("reduce", "h.toml", "-o", "h.h5")
            with h5py.File(self.path("h.h5")) as f:
                found.append(f["modes/frequency_hz"][:])
                self.assertEqual(f["preload"].attrs["loads"], "TEMPERATURE 30")
        # Alone between hinges the middle bar would buckle at N = pi^2 EI / L^2 = 138; here N = -2/3 EA alpha T = -93.
        self.assertTrue(np.all(found[0] > 1))
        self.assertGreater(np.abs(found[1] / found[0] - 1).max(), 0.05)
        self.write("h.bdf", deck % 400.0)
        self.fails(3, "reduce", "h.toml", "-o", "h.h5", says=["TEMPERATURE 30"], error="fe.preload-buckles")

    def test_wrong_preloads(self):
        for change, words in ((("PRELOAD) = 1", "PRELOAD) = 9"), "subcase 9"), (("LOAD = 10\n", "\n"), "no load"),
                              (("LOAD = 10\n", "LOAD = 10\nSTATSUB(PRELOAD) = 1\n"), "its own preload")):
            self.write("s.bdf", write_line("SPC = 1\n" + CHAIN.replace(*change), "EIGRL,7,,,8\n" + STRING.format(n=21)))
            for verb in (("modes",), ("check",), ("reduce", "--modes", "2", "-o", "b.h5")):
                self.fails(1, verb[0], "s.bdf", *verb[1:], says=[words, "s.bdf:"], error="fe.preload-subcase")
        self.write("r.bdf", self.write_blade("SPC = 1\nMETHOD = 7\n"))
        self.write("b.toml", '[body]\ndeck = "r.bdf"\n[body.modes]\nnumber = 3\n[body.stiffening]\ninertial = ["ax"]\n'
                   '[body.preload]\nspin = [0.0, 0.0, 1.0]\n')
        self.fails(1, "reduce", "b.toml", "-o", "b.h5", says=["b.toml:7"], error="reduce.bad-preload")
        self.write("z.toml", '[body]\ndeck = "r.bdf"\n[body.modes]\nnumber = 3\n'
                   '[body.preload]\nspin = [0.0, 0.0, 0.0]\n')
        self.fails(1, "reduce", "z.toml", "-o", "z.h5", says=["z.toml:5", "nothing"], error="reduce.bad-preload")


if __name__ == "__main__":
    unittest.main()
