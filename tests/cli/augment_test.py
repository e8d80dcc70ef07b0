"""[[body.augment]] and reduce --loads-deck, against the deck with the payload, the mass matrix and a second reduction."""
import re
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.linalg
import scipy.sparse

from support import ProgramTest
from toml_text import section, toml

CARDS = """PARAM,COUPMASS,1
SPC1,1,123456,1
PBAR,1,1,1.-3,4.-7,2.-7,3.-7
MAT1,1,7.+10,,.3,2700.
{grids}
{bars}
"""
DECK = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n{cards}{more}ENDDATA\n"
N = 9  # grids of the beam, 2 m long
PAYLOAD = (12.0, np.array([0.1, 0.05, -0.04]), np.diag([0.5, 0.9, 0.8]) + 0.1 * (np.eye(3, k=1) + np.eye(3, k=-1)))


def make_cards(held=""):
    grids = "\n".join(f"GRID,{i + 1},,{2.0 * i / (N - 1)},0.,0.{held}" for i in range(N))
    bars = "\n".join(f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,0.,1." for i in range(N - 1))
    return CARDS.format(grids=grids, bars=bars)


def payload_matrix():
    """6 x 6 of the payload about its grid."""
    m, s, J = PAYLOAD
    c = np.array([[0, -s[2], s[1]], [s[2], 0, -s[0]], [-s[1], s[0], 0]])
    return np.block([[m * np.eye(3), -m * c], [m * c, J - m * c @ c]])


def conm2():
    m, s, J = PAYLOAD
    return (f"CONM2,900,{N},,{m},{s[0]},{s[1]},{s[2]},,+\n"
            f"+,{J[0, 0]},{-J[1, 0]},{J[1, 1]},{-J[2, 0]},{-J[2, 1]},{J[2, 2]}\n")


AUGMENT = f"""[[body.augment]]
node = {N}
mass = {PAYLOAD[0]}
cg = {PAYLOAD[1].tolist()}
inertia = {PAYLOAD[2].tolist()}
"""
SYSTEM = f"""[[body]]
name = "beam"
file = "beam.h5"
[[body]]
name = "payload"
mass = {PAYLOAD[0]}
cg = {PAYLOAD[1].tolist()}
inertia = {PAYLOAD[2].tolist()}
[[hinge]]
name = "root"
type = "fixed"
child = "beam"
[[hinge]]
name = "tip"
type = "fixed"
parent = "beam"
parent_node = {N}
child = "payload"
[simulation]
duration = 1.0
"""


class Augment(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("beam.bdf", DECK.format(cards=make_cards(), more="PARAM,WTMASS,0.5\n"))

    def reduce(self, modes, augment=True, body="", deck="beam.bdf"):
        self.write("beam.toml", f'[body]\nname = "beam"\ndeck = "{deck}"\ninterface = [{N}]\n{body}\n[body.modes]\n'
                                + modes + "\n" + (AUGMENT if augment else ""))
        self.bough("reduce", "beam.toml", "-o", "beam.h5")
        with h5py.File(self.path("beam.h5")) as f:
            return {name: f[path][:] for name, path in
                    (("hz", "/modes/frequency_hz"), ("M", "/modal/mass"), ("K", "/modal/stiffness"),
                     ("phi", "/modes/phi"), ("id", "/nodes/id"), ("gamma0", "/integrals/exact/gamma0"),
                     ("gamma1", "/integrals/exact/gamma1"))}

    def poles(self):
        self.write("system.toml", SYSTEM)
        self.bough("linearize", "system.toml", "-o", "lin.h5")
        with h5py.File(self.path("lin.h5")) as f:
            return np.sort(np.abs(f["/poles/imag"][:]))[::2] / (2 * np.pi)

    def test_body_and_payload_have_the_frequencies_of_the_whole_deck(self):
        """WTMASS counts for the deck; the masses of body and system files are those after it."""
        whole = conm2().replace(f",{PAYLOAD[0]},", f",{2 * PAYLOAD[0]},")
        J = 2 * PAYLOAD[2]
        whole = whole.split("+,")[0] + f"+,{J[0, 0]},{-J[1, 0]},{J[1, 1]},{-J[2, 0]},{-J[2, 1]},{J[2, 2]}\n"
        self.write("whole.bdf", DECK.format(cards=make_cards(), more="PARAM,WTMASS,0.5\n" + whole))
        self.bough("modes", "whole.bdf", "-n", 6, "-o", "whole.h5")
        with h5py.File(self.path("whole.h5")) as f:
            expected = f["/modes/frequency_hz"][:]
        self.reduce("number = 6", augment=False)
        plain = np.abs(self.poles() / expected - 1)
        self.assertGreater(plain[:3].max(), 1e-3)
        for choice in ("", "\northogonalize = false"):
            self.reduce("number = 6" + choice)
            self.assertLess(np.abs(self.poles() / expected - 1).max(), 1e-7, choice)

    def test_the_mass_is_taken_off_the_mass_matrix(self):
        """Unit generalized mass with the payload: M = 1 - phi' M_a phi at its node."""
        body = self.reduce("number = 5\northogonalize = false")
        phi = body["phi"][list(body["id"]).index(N)]
        expected = np.eye(5) - phi.T @ payload_matrix() @ phi
        self.assertLess(np.abs(body["M"] - expected).max(), 1e-9)
        self.assertGreater(np.abs(body["M"] - np.diag(np.diag(body["M"]))).max(), 0.01)
        again = self.reduce("number = 5")
        self.assertLess(np.abs(again["M"] - np.eye(5)).max(), 1e-9)
        ritz = np.sqrt(scipy.linalg.eigvalsh(body["K"], body["M"])) / (2 * np.pi)
        self.assertLess(np.abs(again["hz"] / ritz - 1).max(), 1e-9)

    def test_ritz_values_stand_above_the_frequencies_and_meet_them_in_the_whole_space(self):
        for body in ("", "[body.preload]\nspin = [0.0, 0.0, 6.0]"):
            few, alone = self.reduce("number = 4", body=body), self.reduce("number = 48", augment=False, body=body)
            self.assertTrue(np.all(few["hz"] >= alone["hz"][:4] * (1 - 1e-9)))
            self.assertGreater(few["hz"][0] / alone["hz"][0], 1 + 1e-6)
            every = self.reduce("number = 48", body=body)
            n = len(every["hz"])
            self.assertEqual(n, len(alone["hz"]))
            self.assertLess(np.abs(every["hz"] / alone["hz"] - 1).max(), 1e-7)

    def test_a_free_body_keeps_its_own_mean_axes(self):
        for frame in ("free", "mean"):
            body = self.reduce("number = 4", body=f'frame = "{frame}"')
            self.assertLess(np.abs(body["gamma0"]).max(), 1e-8)
            self.assertLess(np.abs(body["gamma1"]).max(), 1e-8)
        held = self.reduce("number = 4", body=f'frame = "node"\nframe_nodes = [{N}]')
        self.assertLess(np.abs(held["phi"][list(held["id"]).index(N)]).max(), 1e-12)

    def test_faults(self):
        self.write("beam.toml", toml(section("body", deck="beam.bdf"), section("body.modes", number=2)) + AUGMENT.replace(
            f"node = {N}", "node = 77"))
        self.fails(1, "reduce", "beam.toml", says=["augment names node 77"], error="reduce.unknown-node")
        self.write("beam.toml", toml(section("body", deck="beam.bdf"), section("body.modes", number=2)) + AUGMENT.replace(
            "mass = 12.0", "mass = -1.0"))
        self.fails(1, "reduce", "beam.toml", error="toml.out-of-range")
        self.bough("matrices", "beam.bdf", "-o", "beam-matrices.h5", "--no-kg")
        self.bough("modes", "beam.bdf", "-n", 3, "-o", "beam-modes.h5")
        with h5py.File(self.path("beam-modes.h5")) as modes:
            phi = modes["/modes/phi"][:]
        scipy.io.savemat(self.path("phi.mat"), {"PHI": phi.reshape(-1, phi.shape[2])})
        self.write("given.toml", toml(
            section("body", deck="beam.bdf"),
            section("body.modes", number=3),
            section("body.matrices", file="beam-matrices.h5", modes="phi.mat:PHI")) + AUGMENT)
        self.fails(1, "reduce", "given.toml", error="reduce.bad-augment")


class LoadsDeck(ProgramTest):
    def test_the_cards_give_the_same_geometric_stiffness(self):
        """Masses at the grids: K_G of the cards as load sets, and phi' K_G phi of `matrices`, are K_G1."""
        masses = "".join(f"CONM2,{100 + i},{i},,{0.3 + 0.1 * i}\n" for i in range(1, N + 1))
        cards = make_cards().replace(",,.3,2700.", ",,.3")
        # A bent beam, so that every load has a stress of its own.
        for i in range(1, N + 1):
            cards = cards.replace(f"GRID,{i},,{2.0 * (i - 1) / (N - 1)},0.,0.",
                                  f"GRID,{i},,{2.0 * (i - 1) / (N - 1)},{0.02 * i * i},{0.1 * (i % 3)}")
        body = toml(
            section("body", name="beam", deck="{}", origin=[0.3, -0.2, 0.1]),
            section("body.modes", number=5),
            section("body.output", full=True))
        self.write("beam.bdf", DECK.format(cards=cards, more=masses))
        self.write("beam.toml", body.format("beam.bdf"))
        self.bough("reduce", "beam.toml", "--loads-deck", "loads.bdf", "--loads-set", 201, "-o", "beam.h5")
        self.write("again.bdf", DECK.format(cards=cards, more=masses + "INCLUDE 'loads.bdf'\n"))
        self.write("again.toml", body.format("again.bdf") + "".join(
            f'[[body.load]]\nname = "F{l + 1}"\nload_set = {201 + l}\n' for l in range(12)))
        self.bough("reduce", "again.toml", "-o", "again.h5")
        subcases = "".join(f"SUBCASE {l + 1}\nLOAD = {201 + l}\n" for l in range(12))
        self.write("kg.bdf", DECK.format(cards=cards, more=masses + "INCLUDE 'loads.bdf'\n").replace(
            "SPC = 1\n", "SPC = 1\n" + subcases).replace("SOL 103", "SOL 101"))
        self.bough("matrices", "kg.bdf", "-o", "kg.h5")
        with h5py.File(self.path("beam.h5")) as f:
            expected, F_I, phi = f["/stiffening/kg_inertial"][:], f["/inertial_loads/f"][:], f["/full/phi"][:]
            dof_map, mass = f["/dof_map"][:], f["/rigid/mass"][()]
        with h5py.File(self.path("again.h5")) as f:
            found, load = f["/stiffening/kg_external"][:], f["/stiffening/external_load"][:]
        self.assertEqual(found.shape, (12, 5, 5))
        with h5py.File(self.path("kg.h5")) as f:
            for l in range(12):
                scale = np.abs(expected[l]).max()
                self.assertGreater(scale, 1e-6)
                self.assertLess(np.abs(found[l] - expected[l]).max() / scale, 1e-9, l + 1)
                g = f[f"/KG/LOAD_{201 + l}"]
                K = scipy.sparse.csr_matrix((g["data"][:], g["indices"][:], g["indptr"][:]), shape=tuple(g["shape"][:]))
                self.assertLess(np.abs(phi.T @ (K @ phi) - expected[l]).max() / scale, 1e-8, l + 1)
        self.assertLess(np.abs(load - phi.T @ F_I).max() / np.abs(load).max(), 1e-9)
        # The cards by themselves, read by columns.
        with open(self.path("loads.bdf")) as f:
            lines = f.read().splitlines()
        total = np.zeros((12, 3))
        for first, second in zip(lines, lines[1:] + [""]):
            if first.startswith("FORCE*"):
                field = [first[8 + 16 * i:24 + 16 * i] for i in range(4)] + [second[8 + 16 * i:24 + 16 * i] for i in range(4)]
            elif first.startswith("FORCE"):
                field = [first[8 + 8 * i:16 + 8 * i] for i in range(8)]
            else:
                continue
            number = [float(re.sub(r"(?<=[\d.])([+-]\d+)$", r"e\1", w.strip())) if w.strip() else 0.0 for w in field]
            total[int(number[0]) - 201] += number[3] * np.array(number[4:7])
        self.assertLess(np.abs(total[:3] + mass * np.eye(3)).max(), 1e-9)
        self.assertTrue(all(len(line) <= 72 or line.startswith("$") for line in lines))
        self.assertTrue(set(dof_map[:, 1]) <= set(range(1, 7)))


if __name__ == "__main__":
    unittest.main()
