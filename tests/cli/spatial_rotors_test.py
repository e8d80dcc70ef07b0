"""Rotors of solids, shells, bars and masses around their axis (ROTORG, ROTORD), in the fixed and in the rotating frame:
rigid bodies in closed form, membranes of Lamb & Southwell, shafts of beams, the same modes in both frames."""
import json
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest
from rotors import DENSITY, RPM, Rotor, make_friswell_deck, number, solve, springs

AXIS = "CORD2R,4,,0.,0.,0.,0.,0.,1.\n,1.,0.,0."


def rotord(first, step, count, frame, w4="", rforce=""):
    """Speeds in rad per second of rotor set 1 about z of basic."""
    return [f"ROTORD,9,{first!r},{step!r},{count},{frame},-1.,RAD,RAD", ",NO", f",1,1,1.,4,,{w4},{rforce}", AXIS]


class Mesh:
    """Grids by place, elements; a line of the deck each."""
    def __init__(self):
        self.lines, self.ids = [], {}
        self.element = 0

    def grid(self, *x):
        key = tuple(round(c, 9) + 0.0 for c in x)
        if key not in self.ids:
            self.ids[key] = len(self.ids) + 1
            self.lines.append(f"GRID,{self.ids[key]},,{number(key[0])},{number(key[1])},{number(key[2])}")
        return self.ids[key]

    def add(self, card, prop, grids):
        self.element += 1
        fields = [card, str(self.element), str(prop), *map(str, grids)]
        self.lines.append(",".join(fields[:9]) + "".join("\n," + ",".join(fields[k:k + 8]) for k in range(9, len(fields), 8)))
        return self.element


def place(r, angle, z):
    return r * math.cos(angle), r * math.sin(angle), z


def add_disc(mesh, radii, sectors, z=0.0):
    """Shells between radii; the first radius 0: triangles about the centre."""
    turn = 2 * math.pi / sectors
    for a, b in zip(radii, radii[1:]):
        for k in range(sectors):
            inner = [mesh.grid(*place(a, t * turn, z)) for t in (k, k + 1)]
            outer = [mesh.grid(*place(b, t * turn, z)) for t in (k, k + 1)]
            if a == 0:
                mesh.add("CTRIA3", 1, [inner[0], outer[0], outer[1]])
            else:
                mesh.add("CQUAD4", 1, [inner[0], outer[0], outer[1], inner[1]])


def add_ring(mesh, r_in, r_out, sectors, heights):
    """Bricks of 20 nodes, midside nodes on the circles; wedges of 15 nodes about the axis for r_in = 0."""
    turn = 2 * math.pi / sectors
    for low, high in zip(heights, heights[1:]):
        mid = (low + high) / 2
        for k in range(sectors):
            t = [k * turn, (k + 0.5) * turn, (k + 1) * turn]
            g = lambda r, i, z: mesh.grid(*place(r, t[i], z))
            half = (r_in + r_out) / 2
            if r_in == 0:
                corners = lambda z: [g(0, 0, z), g(r_out, 0, z), g(r_out, 2, z)]
                sides = lambda z: [g(half, 0, z), g(r_out, 1, z), g(half, 2, z)]
                mesh.add("CPENTA", 2, [*corners(low), *corners(high), *sides(low), *corners(mid), *sides(high)])
            else:
                corners = lambda z: [g(r_in, 0, z), g(r_out, 0, z), g(r_out, 2, z), g(r_in, 2, z)]
                sides = lambda z: [g(half, 0, z), g(r_out, 1, z), g(half, 2, z), g(r_in, 1, z)]
                mesh.add("CHEXA", 2, [*corners(low), *corners(high), *sides(low), *corners(mid), *sides(high)])


def make_deck(mesh, case, bulk, modes=6, coupled=True):
    return "\n".join(["SOL 107", "CEND", "SPC = 1", "METHOD = 1", "CMETHOD = 2", *case, "BEGIN BULK", *(["PARAM,COUPMASS,1"] if coupled else []),
                      "EIGRL,1,,,20", f"EIGC,2,LAN,,,,,{modes}", *mesh.lines, f"ROTORG,1,1,THRU,{max(mesh.ids.values())}", *bulk, "ENDDATA", ""])


def solve_all(M, B, K):
    n = len(M)
    return np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, B)]]))


class SpatialRotors(ProgramTest):
    def run_deck(self, deck):
        self.write("d.bdf", deck)
        result = self.bough("modes", "d.bdf", "--json")
        self.messages = result.stderr
        return json.loads(result.stdout)

    def frequencies(self, deck):
        """Im λ > 0, ascending, at the last speed."""
        self.result = self.run_deck(deck)
        return np.array([m["eigenvalue"]["imag"] for m in self.result["modes"] if m["eigenvalue"]["imag"] > 0])

    def check_tilt(self, mesh, bulk, polar, across, coupled, relative, hub, elastic=1e-4):
        """A rigid body on a spring about its centre at the grid `hub`, kept in place: both frames and the closed form."""
        k, speed = 4e5, 300.0
        support = [f"SPC1,1,1236,{hub}", f"CELAS2,9001,{number(k)},{hub},4", f"CELAS2,9002,{number(k)},{hub},5"]
        root = math.sqrt((polar * speed)**2 + 4 * across * k)
        fixed = [(root - polar * speed) / 2 / across, (root + polar * speed) / 2 / across]
        for frame, expected in (("FIX", fixed), ("ROT", sorted(abs(w + s * speed) for w, s in zip(fixed, (1, -1))))):
            with self.subTest(frame, coupled=coupled):
                found = self.frequencies(make_deck(mesh, ["RMETHOD = 9"], [*bulk, *support, *rotord(speed, 1.0, 1, frame)], coupled=coupled))
                self.assertNotIn("asymmetric", self.messages)
                np.testing.assert_allclose(found[:2], expected, rtol=elastic)
                rotor = self.result["rotors"]["rotors"][0]
                self.assertAlmostEqual(rotor["polar_inertia"], polar, delta=relative * polar)

    def make_ring(self, between=(0.1, 0.15)):
        """A stiff ring of shells about grid 5000: mesh, bulk data, polar and diametral inertia of the polygons."""
        n, inner, R, t, rho = 16, 0.05, 0.2, 0.02, 7800.0
        mesh = Mesh()
        add_disc(mesh, [inner, *between, R], n)
        hub = [mesh.grid(*place(inner, 2 * math.pi * k / n, 0)) for k in range(n)]
        mesh.lines.append("GRID,5000,,0.,0.,0.\nRBE2,5001,5000,123456," + ",".join(map(str, hub[:5])) + "\n," +
                          ",".join(map(str, hub[5:13])) + "\n," + ",".join(map(str, hub[13:])))
        a = 2 * math.pi / n
        area = lambda r: n / 2 * r**2 * math.sin(a)
        second = lambda r: area(r) * r**2 / 12 * (2 + math.cos(a))          # ∫x² dA of a regular polygon
        S, A = second(R) - second(inner), area(R) - area(inner)
        bulk = [f"PSHELL,1,1,{t},1,,1", f"MAT1,1,1.+15,,.3,{rho}"]
        return mesh, bulk, 2 * rho * t * S, rho * t * S + rho * A * t**3 / 12

    def test_rigid_shells(self):
        mesh, bulk, polar, across = self.make_ring()
        self.check_tilt(mesh, bulk, polar, across, True, 1e-6, 5000)

    def test_synchronous_and_driven(self):
        """RGYRO: the backward tilt at its critical speed, ω² (I_d + I_p) = k; a moment over frequency at a speed."""
        mesh, bulk, polar, across = self.make_ring()
        k = 4e5
        bulk = [*bulk, "SPC1,1,1236,5000", f"CELAS2,9001,{number(k)},5000,4", f"CELAS2,9002,{number(k)},5000,5", "GRID,5002,,0.,0.,1.",
                "SPC1,1,123456,5002", "ROTORG,1,5000,5002", "RSPINR,1,5000,5002,FREQ,1."]
        result = self.run_deck(make_deck(mesh, ["RGYRO = 5"], [*bulk, "RGYRO,5,SYNC,1,RPM,0.,100000."]))
        critical = [p["speed"] for p in result["rotors"]["critical_speeds"]]
        self.assertAlmostEqual(critical[0], math.sqrt(k / (across + polar)), delta=1e-4 * critical[0])
        speed, hz = 2 * math.pi * 40.0, np.array([50.0, 150.0, 400.0])
        deck = make_deck(mesh, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4", "DISPLACEMENT = ALL"],
                         [*bulk, "RGYRO,5,ASYNC,1,FREQ,,,40.", "FREQ,4,50.,150.,400.", "RLOAD1,3,6,,,1.", "DAREA,6,5000,4,1000."])
        for sol in (108, 111):
            self.write("d.bdf", deck.replace("SOL 107", f"SOL {sol}"))
            self.bough("frequency", "d.bdf", "-o", "d.h5")
            with h5py.File(self.path("d.h5")) as f:
                group = f["subcases/1/displacement"]
                found = group["real"][:, group["dofs"][:].tolist().index([5000, 4])]
            omega = 2 * math.pi * hz
            direct = k - across * omega**2
            np.testing.assert_allclose(found, 1000 * direct / (direct**2 - (omega * speed * polar)**2), rtol=2e-4)

    def test_rigid_solids(self):
        """A stiff drum of bricks and wedges: the cylinder."""
        R, h, rho = 0.2, 0.1, 7800.0
        mesh = Mesh()
        for a, b in ((0, 0.05), (0.05, 0.12), (0.12, R)):
            add_ring(mesh, a, b, 16, [-h / 2, 0, h / 2])
        # The grid in the middle is of solids: a frame of grids around it carries the springs.
        inner = [mesh.grid(*place(0.05, k * math.pi / 8, 0)) for k in range(0, 16, 4)]
        mesh.lines.append(f"GRID,5000,,0.,0.,0.\nRBE2,5001,5000,123," + ",".join(map(str, inner)))
        mass = rho * math.pi * R**2 * h
        self.check_tilt(mesh, ["PSOLID,2,2", f"MAT1,2,1.+15,,.3,{rho}"], mass * R**2 / 2, mass * (3 * R**2 + h**2) / 12, True, 2e-4, 5000, 3e-4)

    def test_rigid_wheel(self):
        """A stiff rim of beams with spokes, lumped: inertia of the masses at the grids; CONM2 with offsets on the rim."""
        n, R, rho, area, offset, m = 12, 0.3, 7800.0, 4e-4, 0.05, 0.8
        mesh = Mesh()
        centre = mesh.grid(0, 0, 0)
        rim = [mesh.grid(*place(R, 2 * math.pi * k / n, 0)) for k in range(n)]
        for k in range(n):
            element = mesh.add("CBAR", 3, [rim[k], rim[(k + 1) % n]])
            mesh.lines[-1] += ",0.,0.,1."
            mesh.add("CBAR", 3, [centre, rim[k]])
            mesh.lines[-1] += ",0.,0.,1."
            s = place(offset, 2 * math.pi * k / n, 0.0)
            mesh.add("CONM2", rim[k], ["", number(m), number(s[0]), number(s[1]), number(s[2])])
        bulk = [f"PBAR,3,3,{area},1.-6,1.-6,2.-6", f"MAT1,3,1.+14,,.3,{rho}"]
        chord = 2 * R * math.sin(math.pi / n)
        at_rim = rho * area * (chord + R / 2)                  # lumped at each grid
        polar = n * (at_rim * R**2 + m * (R + offset)**2)
        self.check_tilt(mesh, bulk, polar, polar / 2, False, 1e-9, centre)

    def test_membrane(self):
        """A thin free disc, Lamb & Southwell 1921: ω² = Ω² [(n + 2s)(n + 2s + 2)(3 + ν) - n² (1 + 3ν)]/8 in the rotating
        frame, n waves around; ω ± nΩ in the fixed one."""
        n, R, nu, speed = 32, 0.5, 0.3, 100.0
        mesh = Mesh()
        add_disc(mesh, list(np.linspace(0, R, 11)), n)
        centre = mesh.grid(0, 0, 0)
        bulk = ["PSHELL,1,1,1.-4,1,,1", f"MAT1,1,2.+11,,{nu},7800.", f"SPC1,1,1236,{centre}", f"SPC1,1,6,1,THRU,{max(mesh.ids.values())}",
                f"CELAS2,9001,1.-3,{centre},4", f"CELAS2,9002,1.-3,{centre},5"]
        southwell = lambda k, s: speed * math.sqrt(((k + 2 * s) * (k + 2 * s + 2) * (3 + nu) - k**2 * (1 + 3 * nu)) / 8)
        rotating = self.frequencies(make_deck(mesh, ["RMETHOD = 9"], [*bulk, *rotord(speed, 1.0, 1, "ROT")], modes=10))
        for waves in (1, 2, 3):
            gap = np.abs(rotating / southwell(waves, 0) - 1)
            self.assertLess(gap.min(), 0.005 * waves, (waves, rotating, southwell(waves, 0)))
        for waves, sign in ((1, 1), (2, 1), (2, -1), (3, 1)):
            expected = abs(southwell(waves, 0) + sign * waves * speed)
            deck = make_deck(mesh, ["RMETHOD = 9"], [*bulk, *rotord(speed, 1.0, 1, "FIX")], modes=6)
            deck = deck.replace("EIGC,2,LAN,,,,,6", f"EIGC,2,LAN\n,0.,{number(expected)},,,,,6")
            gap = np.abs(self.frequencies(deck) - expected)
            self.assertLess(gap.min(), 0.005 * waves * southwell(waves, 0), (waves, sign, expected))

    def test_solid_shaft(self):
        """A stout shaft of bricks and wedges in springs, against CBEAMs: whirl pairs at rest and at speed, both frames."""
        R, L, rho, E, k = 0.06, 0.8, 7800.0, 2e11, 2e8
        speed = 2500.0
        mesh = Mesh()
        heights = list(np.linspace(0, L, 17))
        add_ring(mesh, 0, R, 8, heights)
        support = []
        for j, z in enumerate((0.0, L)):
            on_face = sorted(i for p, i in mesh.ids.items() if abs(p[2] - z) < 1e-9)
            centre = mesh.grid(0, 0, z)
            on_face.remove(centre)
            mesh.lines += [f"GRID,{5000 + j},,0.,0.,{number(z)}", f"RBE3,{5100 + j},,{5000 + j},123456,1.,123," +
                           ",".join(map(str, on_face[:2])) + "\n," + "\n,".join(",".join(map(str, on_face[c:c + 8])) for c in range(2, len(on_face), 8))]
            support += [f"CELAS2,{9000 + 2 * j + c},{number(k)},{5000 + j},{c}" for c in (1, 2)]
        support += [f"CELAS2,{9010 + c},1.+12,5000,{c}" for c in (3, 6)]
        bulk = ["PSOLID,2,2", f"MAT1,2,{E},,.3,{rho}", *support]
        area, I, kappa = math.pi * R**2, math.pi * R**4 / 4, 6 * 1.3 / (7 + 6 * 0.3)
        beam = Rotor(np.linspace(0, L, 17), E * I, kappa * E / 2.6 * area, rho * area, rho * I)
        for z in (0, L):
            beam.add_bearing(z, k * np.eye(2))
        still, turning = solve(*beam.matrices(0)).imag[:4], solve(*beam.matrices(speed)).imag[:4]
        found = {}
        for frame in ("FIX", "ROT"):
            for s in (0.0, speed):
                values = self.frequencies(make_deck(mesh, ["RMETHOD = 9"], [*bulk, *rotord(s, 1.0, 1, frame)], modes=8))
                found[frame, s] = values
        np.testing.assert_allclose(found["FIX", 0.0][:4], still, rtol=3e-3)
        # Splits by the gyroscopic terms: of the beam within 2 %.
        split = found["FIX", speed][:4] - found["FIX", 0.0][:4]
        np.testing.assert_allclose(split, turning - still, rtol=0.02, atol=1e-4 * still[0])
        for j, w in enumerate(found["FIX", speed][:4]):
            shifted = abs(w + (speed if j % 2 == 0 else -speed))
            self.assertLess(np.abs(found["ROT", speed] - shifted).min(), 1e-4 * w)

    def test_line_in_both_frames(self):
        """Friswell's rotors in the rotating frame: every eigenvalue of the fixed frame moved by ±iΩ, damping inside and
        outside."""
        for c, inside in ((0.0, False), (3e3, True)):
            deck = make_friswell_deck(6, [(0, *springs(1e6, c=c)), (1.5, *springs(1e6, c=c))], ((0.5, 0.28), (1.0, 0.35)), ["RMETHOD = 9"], ["{card}"], modes=24)
            deck = deck.replace("RSPINR,1,1,7,RPM,1.", "CORD2R,4,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.").replace(number(DENSITY), number(DENSITY) + ",,,.02")
            speed = 4000 * RPM
            card = lambda frame: f"ROTORD,9,{speed!r},1.,1,{frame},-1.,RAD,RAD\n,NO\n,1,1,1.,4,,{1000. if inside else ''}"
            poles = {}
            for frame in ("FIX", "ROT"):
                result = self.run_deck(deck.replace("{card}", card(frame)))
                poles[frame] = np.array([complex(m["eigenvalue"]["real"], m["eigenvalue"]["imag"]) for m in result["modes"]])
            fixed = np.concatenate([poles["FIX"], poles["FIX"].conj()])
            moved = np.concatenate([fixed + 1j * speed, fixed - 1j * speed])
            for value in poles["ROT"][:12]:
                self.assertLess(np.abs(moved - value).min(), 1e-7 * abs(value), (c, value))

    def test_unequal_shaft(self):
        """A mass on a shaft of unequal stiffness, in the rotating frame: (λ² - Ω² + a²)(λ² - Ω² + b²) + 4 Ω² λ² = 0, unstable
        for a < Ω < b, damped by a dashpot to ground: c (λ + Ω ẽ)."""
        E, span, m = 2e11, 1.2, 3.0
        I = (2e-8, 3e-8)
        a, b = sorted(math.sqrt(48 * E * i / span**3 / m) for i in I)
        for speed, c in ((0.5 * (a + b), 0.0), (0.5 * a, 30.0), (0.5 * (a + b), 30.0)):
            grids = [f"GRID,{i + 1},,0.,0.,{number(i * span / 4)}" for i in range(5)] + [
                f"CBAR,{i},1,{i},{i + 1},1.,0.,0." for i in range(1, 5)]
            deck = "\n".join(["SOL 107", "CEND", "SPC = 1", "METHOD = 1", "CMETHOD = 2", "RMETHOD = 9", "BEGIN BULK", "EIGRL,1,,,4",
                              "EIGC,2,HESS,,,,,8", *grids, f"PBAR,1,1,1.-3,{I[0]},{I[1]},4.-8", f"MAT1,1,{E},,.3", f"CONM2,9,3,,{m}",
                              "SPC1,1,123,1,5", "SPC1,1,36,1,THRU,5", "ROTORG,1,1,THRU,5",
                              *([f"CDAMP2,{20 + k},{c},3,{k}" for k in (1, 2)] if c else []), *rotord(speed, 1.0, 1, "ROT"), "ENDDATA", ""])
            result = self.run_deck(deck)
            found = np.array([complex(p["eigenvalue"]["real"], p["eigenvalue"]["imag"]) for p in result["modes"]])
            M, W = np.eye(2), np.array([[0.0, -1.0], [1.0, 0.0]])
            K = np.diag([a**2, b**2]) - speed**2 * M + speed * c / m * W
            expected = solve_all(M, c / m * M + 2 * speed * W, K)
            for value in expected[expected.imag >= 0]:
                self.assertLess(np.abs(found - value).min(), 1e-7 * abs(value), (speed, c, found, expected))
            self.assertEqual(max(found.real) > 1e-3, a < speed < b and c < 100)

    def test_wrong_input(self):
        """Errors of a body around its axis in the fixed and in the rotating frame; warnings of unequal directions."""
        mesh, bulk, *_ = self.make_ring()
        bulk = [*bulk, "SPC1,1,1236,5000", "CELAS2,9001,4.+5,5000,4", "CELAS2,9002,4.+5,5000,5"]
        make = lambda frame, more=(), case=(), w4="", rforce="": make_deck(
            mesh, ["RMETHOD = 9", *case], [*bulk, *more, *rotord(300.0, 1.0, 1, frame, w4, rforce)])
        rod = ["CROD,7001,7,1,3", "PROD,7,1,1.-4"]
        dmig = ["DMIG,BB,0,1,1,0", "DMIG,BB,5000,4,,5000,4,1."]
        damped = lambda deck: deck.replace("7800.0", "7800.0,,,.01")
        for deck, error, *says in (
                (make("FIX", rod), "modal.rotor-element", "CROD 7001", "in the fixed frame", "REFSYS = ROT"),
                (damped(make("FIX", w4="500.")), "modal.rotor-unsupported", "damping inside rotor 1", "REFSYS = ROT"),
                (make("ROT", dmig, ["B2PP = BB"]), "modal.rotor-unsupported", "B2PP", "REFSYS = FIX")):
            with self.subTest(error, says=says):
                self.write("d.bdf", deck)
                result = self.fails(1, "modes", "d.bdf", error=error, says=says)
                self.assertRegex(result.stderr, r"d\.bdf:\d+: error: ")
        driven = make_deck(mesh, ["RGYRO = 5", "DLOAD = 3", "FREQUENCY = 4"],
                           [*bulk, "GRID,5002,,0.,0.,1.", "SPC1,1,123456,5002", "ROTORG,1,5000,5002", "RSPINR,1,5000,5002,FREQ,1.",
                            "RGYRO,5,ASYNC,1,FREQ,,,40.", "FREQ,4,50.", "RLOAD1,3,6,,,1.", "DAREA,6,5000,4,1000."])
        self.write("d.bdf", damped(driven).replace("SOL 107", "SOL 108"))
        self.fails(1, "frequency", "d.bdf", error="modal.rotor-unsupported", says=["structural damping inside rotor 1", "GE"])
        # Without W4, GE does not act on complex eigenvalues, as in Nastran.
        for deck in (make("ROT", rod), damped(make("ROT", w4="500.")), damped(make("FIX"))):
            self.frequencies(deck)
        self.frequencies(make("ROT", ["CELAS2,9003,4.+5,5000,4"]))
        self.assertRegex(self.messages, "the stiffness of the supports of rotor 1 differs .*modal.rotor-asymmetric")
        heavy = f"CONM2,8000,{mesh.grid(*place(0.2, 0.0, 0.0))},,.5"
        self.frequencies(make("FIX", [heavy]))
        self.assertRegex(self.messages, "the mass of rotor 1 differs .*modal.rotor-asymmetric")

    def test_preload(self):
        """STATSUB with RFORCE: in place of it the stress at each speed, if ROTORD names it; else it would count twice."""
        mesh, bulk, *_ = self.make_ring(between=())
        bulk = [*bulk, "SPC1,1,1236,5000", "CELAS2,9001,4.+5,5000,4", "CELAS2,9002,4.+5,5000,5", "RFORCE,21,5000,,50.,0.,0.,1."]
        plain = self.frequencies(make_deck(mesh, ["RMETHOD = 9"], [*bulk, *rotord(300.0, 1.0, 1, "ROT")]))
        make = lambda rforce: make_deck(mesh, ["SUBCASE 1", "LOAD = 21", "SUBCASE 2", "STATSUB = 1", "RMETHOD = 9"],
                                        [*bulk, *rotord(300.0, 1.0, 1, "ROT", rforce=rforce)]).replace("METHOD = 1\nCMETHOD = 2\n", "", 1).replace(
                                            "STATSUB = 1", "STATSUB = 1\nCMETHOD = 2")
        self.write("d.bdf", make("21"))
        result = json.loads(self.bough("modes", "d.bdf", "--json").stdout)
        found = [m["eigenvalue"]["imag"] for m in result["modes"] if m["eigenvalue"]["imag"] > 0]
        np.testing.assert_allclose(found[:2], plain[:2], rtol=1e-9)
        self.write("d.bdf", make(""))
        self.fails(1, "modes", "d.bdf", error="modal.rotor-unsupported", says=["RFORCE", "STATSUB"])


if __name__ == "__main__":
    unittest.main()
