"""The Princeton beam (Dowell & Traybar 1975): a strip of 7075 aluminium, clamped, a weight at its tip, turned about its
axis so that it bends both ways and twists. One flexible body and chains of 2, 4, 8 against a geometrically exact rod."""
import functools
import unittest

import h5py
import numpy as np

from support import ProgramTest
from toml_text import Bare, section, toml

# 20 in long, 0.4873 in high, 0.12608 in thick; J of a rectangle by its series.
LENGTH, HEIGHT, THICK, E, NU, RHO = 0.508, 12.377e-3, 3.2024e-3, 71.7e9, 0.31, 2810.0
G = E / (2 * (1 + NU))
AREA, STRONG, WEAK = HEIGHT * THICK, THICK * HEIGHT**3 / 12, HEIGHT * THICK**3 / 12
J = HEIGHT * THICK**3 / 3 * (1 - 192 / np.pi**5 * THICK / HEIGHT * sum(
    np.tanh(n * np.pi * HEIGHT / (2 * THICK)) / n**5 for n in (1, 3, 5, 7)))
LOADS = [4.448, 8.896, 13.345]  # 1, 2, 3 lbf
BARS, STEPS = 24, 60

PART = toml(
    section("body", name="part", deck="part.bdf", frame="fixed", interface=[Bare("{outer}")]),
    section("body.modes", basis="craig-bampton", number=Bare("{modes}")),
    section("body.output", file="part.h5"))


@functools.cache
def calc_rod(*force):
    """Tip of the rod x' = R (e1 + Γ), R' = R κ~, with Γ, κ linear in force and moment in the section's axes, clamped at
    0 under a dead force at its end: place (3) and rotation (3 x 3). Shooting by the moment at the root."""
    strain, bend = 1 / np.array([[E * AREA], [G * AREA], [G * AREA]]), 1 / np.array([[G * J], [E * WEAK], [E * STRONG]])
    load = np.array(force)

    def rate(y):
        R, m = y[3:12].reshape(3, 3, -1), y[12:]
        x = np.einsum("ijn,jn->in", R, [[1], [0], [0]] + strain * np.einsum("jin,j->in", R, load))
        k = bend * np.einsum("jin,jn->in", R, m)
        turn = np.stack([R[:, i - 2] * k[i - 1] - R[:, i - 1] * k[i - 2] for i in range(3)], axis=1)
        return np.concatenate([x, turn.reshape(9, -1), np.cross(load, x.T).T])

    def run(moments):
        """The ends of rods with these moments (3 x n) at their roots."""
        n = moments.shape[1]
        y, h = np.concatenate([np.zeros((3, n)), np.repeat(np.eye(3).reshape(9, 1), n, 1), moments]), LENGTH / STEPS
        for _ in range(STEPS):
            a = rate(y)
            b = rate(y + h / 2 * a)
            c = rate(y + h / 2 * b)
            y = y + h / 6 * (a + 2 * b + 2 * c + rate(y + h * c))
        return y
    size = LENGTH * np.linalg.norm(load)
    moment = np.cross([LENGTH, 0, 0], load)
    offsets = 1e-5 * size * np.hstack([np.zeros((3, 1)), np.eye(3), -np.eye(3)])
    for _ in range(30):
        y = run(moment[:, None] + offsets)
        left = y[12:, 0]
        if np.abs(left).max() < 1e-10 * size:
            break
        moment = moment - np.linalg.solve((y[12:, 1:4] - y[12:, 4:]) / (2e-5 * size), left)
    else:
        raise AssertionError("the shooting does not converge")
    return y[:3, 0], y[3:12, 0].reshape(3, 3)


def direct(load, angle):
    """Along the height (y) at 0 degrees, across the strip (z) at 90."""
    return load * np.array([0, np.cos(np.radians(angle)), np.sin(np.radians(angle))])


class Princeton(ProgramTest):
    def make_chain(self, parts):
        bars = BARS // parts    # a chain bends by the shapes of its nodes: more modes of its parts cost time
        length = LENGTH / parts
        deck = ["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "PARAM,COUPMASS,1", "EIGRL,1,,,6",
                "SPC1,1,123456,1", f"MAT1,1,{E:.6g},,{NU},{RHO}",
                f"PBEAM,1,1,{AREA:.6e},{STRONG:.6e},{WEAK:.6e},,{J:.6e}"]
        deck += [f"GRID,{i + 1},,{i * length / bars:.10g},0.,0." for i in range(bars + 1)]
        deck += [f"CBEAM,{i + 1},1,{i + 1},{i + 2},0.,1.,0." for i in range(bars)]
        self.write("part.bdf", "\n".join(deck + ["ENDDATA", ""]))
        self.bough("reduce", self.write("part.toml", PART.format(outer=bars + 1, modes=6 if parts == 1 else 3)), "--force")
        text = "[parameters]\nfy = 0.0\nfz = 0.0\n"
        for i in range(parts):
            text += f'[[body]]\nname = "p{i}"\nfile = "part.h5"\nSTIFFENING\n[[hinge]]\nname = "j{i}"\ntype = "fixed"\nchild = "p{i}"\n'
            if i > 0:
                text += f'parent = "p{i - 1}"\nparent_node = {bars + 1}\n'
        last = f'body = "p{parts - 1}"\nnode = {bars + 1}\n'
        text += f'[[force]]\nname = "weight"\n{last}force = [0.0, "$fy", "$fz"]\nframe = "inertial"\n'
        text += f'[[sensor]]\nname = "tip"\ntype = "position"\n{last}'
        text += f'[[sensor]]\nname = "turn"\ntype = "dcm"\n{last}'
        return text + "[simulation]\nduration = 1.0\n"

    def calc_tip(self, text, force):
        """Place and rotation of the tip at rest under the force."""
        self.write("chain.toml", text)
        self.bough("equilibrium", "chain.toml", "--set", f"fy={float(force[1])!r}", "--set", f"fz={float(force[2])!r}",
                   "-o", "rest.h5", "--force")
        with h5py.File(self.path("rest.h5")) as f:
            return f["sensors/tip"][-1], f["sensors/turn"][-1].reshape(3, 3)

    def calc_error(self, text, load, angle):
        """Errors of the tip's position relative to its displacement, and of its rotation."""
        place, rotation = calc_rod(*direct(load, angle))
        tip, turn = self.calc_tip(text.replace("STIFFENING", ""), direct(load, angle))
        way = np.linalg.norm(place - [LENGTH, 0, 0])
        return np.linalg.norm(tip - place) / way, np.linalg.norm(turn - rotation), way / LENGTH

    def test_one_body_is_good_to_a_tenth_of_its_length(self):
        # Its second order is the bow of the linear shapes: the error grows as the square of the way.
        text = self.make_chain(1)
        error, _, way = self.calc_error(text, 2.8, 90)
        self.assertAlmostEqual(way, 0.1, delta=0.003)
        self.assertLess(error, 0.0105)
        for load, low, high in ((LOADS[0], 0.02, 0.03), (LOADS[2], 0.15, 0.25)):
            error, _, _ = self.calc_error(text, load, 90)
            self.assertTrue(low < error < high, f"{load} N: {error}")
        # Along the height the same load is far inside the range; without stiffening nothing is.
        self.assertLess(self.calc_error(text, LOADS[2], 0)[0], 1.2e-3)
        loose = text.replace("STIFFENING", "stiffening = false")
        self.assertGreater(self.calc_error(loose, 2.8, 90)[0], 0.03)
        self.assertGreater(self.calc_error(loose, LOADS[2], 0)[0], 0.015)

    def test_chains_tend_to_the_rod(self):
        # At the largest load, 40 % of the length: off by less than a fifth with each halving.
        last = 0.1
        for parts, allowed in ((2, 0.022), (4, 3e-3), (8, 5e-4)):
            text = self.make_chain(parts)
            error, turn, _ = self.calc_error(text, LOADS[2], 60)
            self.assertLess(error, min(allowed, last / 5), f"{parts} bodies")
            self.assertLess(turn, 0.6 * allowed, f"{parts} bodies")
            last = error
        for angle in (30, 90):
            error, turn, _ = self.calc_error(text, LOADS[2], angle)
            self.assertLess(error, 5e-4, f"{angle} degrees")
            self.assertLess(turn, 1e-3, f"{angle} degrees")


if __name__ == "__main__":
    unittest.main()
