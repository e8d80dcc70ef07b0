"""Forces and stresses of elements of bodies of third order against exact rods and the reactions of their hinges."""
import os
import unittest

import h5py
import numpy as np
from scipy.integrate import solve_bvp

from support import ProgramTest
from toml_text import Bare, section, table, toml

N, L, A, E, RHO = 24, 2.0, 1e-2, 7e10, 2700.0
EI = {"y": E * 9e-8, "z": E * 4e-8}  # of forces along y, z: about z, y
NAMES = ("axial", "shear_y", "shear_z", "torque", "moment_z_a", "moment_z_b", "moment_y_a", "moment_y_b")


def make_deck():
    text = f"SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nMAT1,1,7.+10,,.3,{RHO}\n"
    text += "".join(f"GRID,{i + 1},,{i * L / N},0.,0.\n" for i in range(N + 1))
    text += "".join(f"CBAR,{i + 1},7,{i + 1},{i + 2},0.,1.,0.\n" for i in range(N))
    return text + "PBAR,7,1,1.-2,9.-8,4.-8,5.-8\n,.02,.03,-.02,.03,-.02,-.03,.02,-.03\nSPC1,1,123456,1\nENDDATA\n"


def solve_rod(force, stiffness):
    """Inextensible rod clamped at 0 under a dead force across its end: angle and curvature at s, and its end."""
    def slope(s, y):
        return np.array([y[1], -force / stiffness * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])])
    s = np.linspace(0, L, 201)
    solved = solve_bvp(slope, lambda a, b: np.array([a[0], b[1], a[2], a[3]]), s,
                       np.array([force * L * s / stiffness, force * (L - s) / stiffness, s, 0 * s]), tol=1e-10)
    return solved.sol


class ThirdOrderRecovery(ProgramTest):
    def reduce(self, order, modes=6, large=None):
        self.write("boom.bdf", make_deck())
        stiffening = {"order": order} if large is None else {"order": order, "large": large}
        self.write("boom.toml", toml(
            section("body", name="boom", deck="boom.bdf", frame="fixed", interface=[N + 1]),
            section("body.modes", number=modes, residual=["interface"]),
            section("body.stiffening", **stiffening),
            section("body.output", recover="all")))
        return self.bough("reduce", "boom.toml", "-o", "boom.h5")

    def read_rows(self, f):
        """Forces of all elements at the first sample: name to N values; and the components."""
        folder = f["bodies/boom/recovery/CBAR"]
        names = folder["1"].attrs["description"].split(", ")
        rows = np.array([folder[str(e + 1)][0] for e in range(N)])
        return dict(zip(names, rows.T)), names

    def bend(self, force):
        """The boom clamped to ground, at rest under a force at its end."""
        self.write("s.toml", toml(
            table("body", "boom", file="boom.h5", recover=True),
            table("hinge", "root", type="fixed", child="boom"),
            table("force", "tip", body="boom", node=N + 1, force=force, frame="inertial"),
            section("simulation", duration=1e-4, output_step=1e-4)))
        self.bough("equilibrium", "s.toml", "-o", "rest.h5", "-q")
        self.bough("run", "s.toml", "--start-from", "rest.h5", "-o", "r.h5", "-q")
        return h5py.File(self.path("r.h5"))

    def test_bent_boom_has_the_forces_of_an_exact_rod(self):
        """A dead force across the end bends it by 4 to 17 % of its length, in either plane."""
        errors = {}
        for order in (2, 3):
            self.reduce(order)
            for axis, moment in (("y", "moment_z_a"), ("z", "moment_y_a")):
                for part in (.12, .5):
                    force = part * EI[axis] / L**2
                    rod = solve_rod(force, EI[axis])
                    with self.bend([0., force, 0.] if axis == "y" else [0., 0., force]) as f:
                        rows, _ = self.read_rows(f)
                    ends, middles = L / N * np.arange(N), L / N * (np.arange(N) + .5)
                    way = rod(L)[3] / L
                    expected = EI[axis] * rod(ends)[1]
                    off = np.abs(np.abs(rows[moment]) - expected).max() / expected[0]
                    pull = np.abs(rows["axial"] - force * np.sin(rod(middles)[0])).max() / force
                    print(f"order {order}, {axis}: way {way:.3f} L, moment off by {off:.1e}, axial force by {pull:.1e} of the force")
                    errors[order, axis, part] = off, pull
        for axis in "yz":
            self.assertLess(max(errors[3, axis, .12]), 1e-4)
            self.assertLess(max(errors[3, axis, .5]), 2e-3)
            self.assertGreater(errors[2, axis, .5][0], 1e-2)
            self.assertGreater(errors[2, axis, .5][1], .1)

    def compare_with_statics(self, bulk, corner, force, card, **modes):
        """Rows of a clamped body of order 2 and 3 under a dead force at a grid against SOL 106 of the whole deck: the largest
        difference of each kind of row, per largest value of the kind."""
        self.write("boom.bdf", "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n" + bulk + "ENDDATA\n")
        self.write("whole.bdf", "SOL 106\nCEND\nSPC = 1\nLOAD = 1\nBEGIN BULK\n" + bulk
                   + "PARAM,LGDISP,1\nFORCE,1,%d,,1.,%r,%r,%r\nENDDATA\n" % (corner, *force))
        self.bough("static", "whole.bdf", "-o", "whole.h5", "-q")
        exact = {}
        with h5py.File(self.path("whole.h5")) as f:
            case = f["subcases/0"]
            for folder, field, prefix in (("elements", "force", ""), ("stresses", "stress", "stress_")):
                names = [str(c) for c in case[f"{folder}/{card}"].attrs["components"]]
                exact |= {prefix + c: v for c, v in zip(names, case[f"{folder}/{card}/{field}"][:].T)}
        off = {}
        for order in (2, 3):
            self.write("boom.toml", toml(
                section("body", name="boom", deck="boom.bdf", frame="fixed", interface=[corner]),
                section("body.modes", **modes), section("body.stiffening", order=order),
                section("body.output", recover="all")))
            self.bough("reduce", "boom.toml", "-o", "boom.h5", "-q")
            self.write("s.toml", toml(
                table("body", "boom", file="boom.h5", recover=True), table("hinge", "root", type="fixed", child="boom"),
                table("force", "end", body="boom", node=corner, force=list(force), frame="inertial"),
                section("simulation", duration=1e-4, output_step=1e-4)))
            self.bough("equilibrium", "s.toml", "-o", "rest.h5", "-q")
            self.bough("run", "s.toml", "--start-from", "rest.h5", "-o", "r.h5", "-q")
            with h5py.File(self.path("r.h5")) as f:
                folder = f[f"bodies/boom/recovery/{card}"]
                ids = sorted(int(i) for i in folder)
                names = folder[str(ids[0])].attrs["description"].split(", ")
                rows = np.array([folder[str(i)][0] for i in ids]).T
            kinds = {}
            for name, values in zip(names, rows):
                kind = name.split("@")[0].rstrip("ab").rstrip("_")
                kinds.setdefault(kind, []).append((np.abs(values - exact[name]).max(), np.abs(exact[name]).max()))
            off[order] = {kind: max(d for d, _ in v) / max(s for _, s in v) for kind, v in kinds.items()}
        print(f"{card}, order 2 and 3 off by:", ", ".join(f"{k} {off[2][k]:.1e} {off[3][k]:.1e}" for k in off[3]))
        return off

    def test_frame_in_space_has_the_forces_of_nonlinear_statics(self):
        """Twelve normal modes, and six with residual vectors; the axial forces of the legs, 1e-3 of their stress, want the
        latter."""
        bulk = f"MAT1,1,7.+10,2.6+10,,{RHO}\nPBAR,7,1,1.-3,9.-8,4.-8,5.-8\n,.02,.03,-.02,.03,-.02,-.03,.02,-.03\nSPC1,1,123456,1\n"
        places = [(i / 8, 0., 0.) for i in range(9)] + [(1., .73 * i / 8, 0.) for i in range(1, 9)]
        bulk += "".join(f"GRID,{i + 1},,{x},{y},{z}\n" for i, (x, y, z) in enumerate(places))
        bulk += "".join(f"CBAR,{i},7,{i},{i + 1}," + ("0.,1.,0.\n" if i < 9 else "1.,0.,0.\n") for i in range(1, 17))
        for modes in ({"number": 12}, {"number": 6, "residual": ["interface"]}):
            off = self.compare_with_statics(bulk, 17, (150., -100., 250.), "CBAR", **modes)
            for kind in ("torque", "moment_z", "moment_y", "stress_xx"):
                self.assertLess(off[3][kind], 3e-3)
                self.assertLess(off[3][kind], .3 * off[2][kind])
        self.assertLess(off[3]["axial"], .3 * off[2]["axial"])
        self.assertLess(off[3]["axial"], 3e-3)

    def test_plate_has_the_membrane_stress_of_nonlinear_statics(self):
        nx, ny, corner = 9, 3, 37
        bulk = "SPC1,1,123456,1,THRU,4\nMAT1,1,7.+10,,.3,2700.\nPSHELL,1,1,.003,1,,1\n"
        bulk += "".join(f"GRID,{1 + i * (ny + 1) + j},,{.6 * i / nx:.7f},{.2 * j / ny:.7f},0.\n" for i in range(nx + 1) for j in range(ny + 1))
        for i in range(nx):
            for j in range(ny):
                first = 1 + i * (ny + 1) + j
                bulk += f"CQUAD4,{1 + i * ny + j},1,{first},{first + ny + 1},{first + ny + 2},{first + 1}\n"
        off = self.compare_with_statics(bulk, corner, (0., 3., 10.), "CQUAD4", number=6, residual=["interface"])
        for kind, error in off[3].items():
            self.assertLess(error, 4e-3, kind)
        for kind in ("Nx", "Ny", "Nxy"):  # the membrane has no force in the modes
            self.assertGreater(off[2][kind], .5)

    def test_units_change_all_degrees(self):
        self.reduce(3, large=[1, 2])
        force = .3 * EI["y"] / L**2
        with self.bend([0., force, 0.]) as f:
            before, _ = self.read_rows(f)
        self.bough("convert", "boom.h5", "-o", "mm.h5", "--units", "m-kg-s:mm-N-tonne")
        os.replace(self.path("mm.h5"), self.path("boom.h5"))
        with self.bend([0., force, 0.]) as f:
            after, _ = self.read_rows(f)
        self.bough("export", "boom.h5", "--to", "flat", "-o", "boom.flat")
        self.write("flat.toml", self.read("s.toml").replace("boom.h5", "boom.flat"))
        self.bough("run", "flat.toml", "--start-from", "rest.h5", "-o", "flat.h5", "-q")
        with h5py.File(self.path("flat.h5")) as f:
            flat, _ = self.read_rows(f)
        for name, values in before.items():
            np.testing.assert_array_equal(flat[name], after[name])
            unit = 1e-6 if name.startswith("stress") else 1e3 if name.startswith(("moment", "torque")) else 1
            np.testing.assert_allclose(after[name], unit * values, rtol=1e-7, atol=1e-7 * unit * np.abs(values).max())


if __name__ == "__main__":
    unittest.main()
