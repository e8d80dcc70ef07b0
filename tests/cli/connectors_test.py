"""CFAST and CWELD: RBE3 with CBUSH or CBAR, affine fields, two coupons in tension, rigid-body modes, buckling."""
import math
import unittest

import h5py
import numpy as np

from support import ProgramTest

A, GAP = .1, .02  # size of the elements, distance of the plates
K = (3e7, 2e7, 1e7, 400.0, 300.0, 200.0)
PFAST = "PFAST,50,{d},-1,0,3.+7,2.+7,1.+7,400.,\n,300.,200.,{mass},.05\n"


def real(x):
    text = f"{x:.15g}"
    return text if "." in text or "e" in text else text + "."


def make_plate(first, pid, z, n=4, x0=0.0):
    """n x n CQUAD4 of side A in the plane z; grid of (i, j): first + j (n + 1) + i."""
    grids = [f"GRID,{first + j * (n + 1) + i},,{real(x0 + i * A)},{real(j * A)},{real(z)}" for j in range(n + 1) for i in range(n + 1)]
    shells = [f"CQUAD4,{first + j * n + i},{pid},{first + j * (n + 1) + i},{first + j * (n + 1) + i + 1},"
              f"{first + (j + 1) * (n + 1) + i + 1},{first + (j + 1) * (n + 1) + i}" for j in range(n) for i in range(n)]
    return "\n".join(grids + shells) + "\n"


# Two plates of unequal thickness, 100 and 200, one above the other.
PLATES = make_plate(100, 1, 0) + make_plate(200, 2, GAP) + "PSHELL,1,1,.004,1,,1\nPSHELL,2,1,.003,1,,1\nMAT1,1,7.+10,,.3,2700.\n"
CLAMP = "SPC1,1,123456,100,105,110,115,120\n"
LOADS = "FORCE,5,204,0,70.,1.,.3,.2\nFORCE,5,224,0,50.,.4,-.2,1.\n"
# Centre of the element of columns and row 1 to 2, and the diameter whose square has its corners.
CENTRE, DIAMETER = (1.5 * A, 1.5 * A), 2 * A / math.sqrt(math.pi)
CORNERS = [lambda first, i=i, j=j: first + j * 5 + i for i, j in ((1, 1), (2, 1), (2, 2), (1, 2))]


def make(sol, case, bulk):
    return "\n".join([f"SOL {sol}", "CEND", *case, "BEGIN BULK", PLATES + bulk, "ENDDATA", ""])


class Connectors(ProgramTest):
    def static(self, bulk, name="d", case=("SPC = 1", "LOAD = 5", "FORCE = ALL")):
        self.write(f"{name}.bdf", make(101, case, bulk))
        self.result = self.bough("static", f"{name}.bdf", "-o", f"{name}.h5")
        with h5py.File(self.path(f"{name}.h5")) as f:
            group = f["subcases"][list(f["subcases"])[0]]
            found = {}
            group.visititems(lambda path, item: found.update({path: item[()]}) if isinstance(item, h5py.Dataset) else None)
        return found

    def displacements(self, found):
        name = next(n for n in found if n.endswith("displacement"))
        return found[name].reshape(-1, 6)

    def forces(self, found, card):
        name = next(n for n in found if card in n and n.endswith("force"))
        return np.atleast_2d(found[name])

    def make_joint(self, core):
        """RBE3 of the corners of the element on both sides, and `core` between their reference grids."""
        x, y = CENTRE
        text = f"GRID,901,,{real(x)},{real(y)},0.\nGRID,902,,{real(x)},{real(y)},{real(GAP)}\n"
        for ref, first in ((901, 100), (902, 200)):
            text += f"RBE3,{ref},,{ref},123456,1.,123," + ",".join(str(c(first)) for c in CORNERS[:2]) + "\n," + \
                ",".join(str(c(first)) for c in CORNERS[2:]) + "\n"
        return text + core

    def test_fastener_is_a_bush_between_rbe3(self):
        bush = self.make_joint("CBUSH,50,50,901,902,0.,1.,0.\nPBUSH,50,K,3.+7,2.+7,1.+7,400.,300.,200.\n")
        expected = self.static(CLAMP + LOADS + bush, "e")
        u = self.displacements(expected)[:50]
        force = self.forces(expected, "CBUSH")
        place = f"GRID,900,,{real(CENTRE[0])},{real(CENTRE[1])},.5\n"
        # x along the gap; y of the element: d = x is the first of the smallest components, z = e1 × d = y, y = z × e1 = x.
        pfast = PFAST.format(d=real(DIAMETER), mass="")
        turned = pfast.replace("2.+7,1.+7", "1.+7,2.+7").replace("300.,200.", "200.,300.")
        for form in ("PROP,1,2,900", "ELEM,105,205,900", "PROP,1,2,,901,902", "PROP,1,2,,,,\n," + ",".join(map(real, (*CENTRE, 0.0)))):
            grids = self.make_joint("").split("RBE3")[0] if "901" in form else place if "900" in form else ""
            found = self.static(CLAMP + LOADS + grids + f"CFAST,50,50,{form}\n" + turned)
            with self.subTest(form):
                np.testing.assert_allclose(self.displacements(found)[:50], u, rtol=0, atol=1e-9 * np.abs(u).max())
                f = self.forces(found, "CFAST")[0]
                swapped = f[[0, 2, 1, 3, 5, 4]]
                np.testing.assert_allclose(np.abs(swapped), np.abs(force[0]), rtol=0, atol=1e-8 * np.abs(force).max())

    def test_webs_are_no_part_of_the_patch(self):
        """ELEM takes the named shell and those that continue it, although a web is nearer to GS."""
        web = "GRID,407,,.2,.1,.1\nGRID,412,,.2,.2,.1\nCQUAD4,401,1,107,112,412,407\nSPC1,1,123456,900\n"
        pfast = PFAST.format(d=".03", mass="")
        found = [self.displacements(self.static(CLAMP + LOADS + web + pfast + text)) for text in (
            "GRID,900,,.185,.17,.05\nCFAST,50,50,ELEM,105,205,900\n", "GRID,900,,.1,.1,.1\nCFAST,50,50,ELEM,105,205\n,.185,.17,0.\n")]
        np.testing.assert_allclose(found[0], found[1], rtol=0, atol=1e-9 * np.abs(found[1]).max())

    def test_listing(self):
        """The f06 and the OP2 have the forces of the fastener, as those of the file."""
        fast = f"CFAST,50,50,PROP,1,2\n,{real(CENTRE[0])},{real(CENTRE[1])},0.\n" + PFAST.format(d=".03", mass="")
        self.write("d.bdf", make(101, ("SPC = 1", "LOAD = 5", "FORCE = ALL"), CLAMP + LOADS + fast))
        self.bough("static", "d.bdf", "-o", "d.h5", "--f06", "d.f06", "--op2", "d.op2")
        with h5py.File(self.path("d.h5")) as f:
            forces = f["subcases"][list(f["subcases"])[0]]["elements/CFAST/force"][()][0]
        lines = self.read("d.f06").split("( C F A S T )")[1].splitlines()
        row = next(line.split() for line in lines if line.split()[:2][-1:] == ["50"] or line.split()[:1] == ["50"])
        np.testing.assert_allclose([float(word) for word in row[-6:]], forces, rtol=1e-5, atol=1e-6 * np.abs(forces).max())

    def test_axes_of_the_card(self):
        """MCID with MFLAG = 0 gives all axes, with MFLAG = 1 the one across the shaft."""
        bush = self.make_joint("CBUSH,50,50,901,902,,,,7\nPBUSH,50,K,3.+7,2.+7,1.+7,400.,300.,200.\n"
                               "CORD2R,7,,0.,0.,0.,0.,1.,1.\n,1.,0.,0.\n")
        u = self.displacements(self.static(CLAMP + LOADS + bush, "e"))[:50]
        fast = f"GRID,900,,{real(CENTRE[0])},{real(CENTRE[1])},.5\nCFAST,50,50,PROP,1,2,900\nCORD2R,7,,0.,0.,0.,0.,1.,1.\n,1.,0.,0.\n"
        found = self.static(CLAMP + LOADS + fast + PFAST.format(d=real(DIAMETER), mass="").replace(",-1,0,", ",7,0,"))
        np.testing.assert_allclose(self.displacements(found)[:50], u, rtol=0, atol=1e-9 * np.abs(u).max())
        along = "CORD2R,8,,0.,0.,0.,1.,0.,0.\n,0.,0.,1.\n"  # x up, y = z × x = -y of basic
        bush = bush.replace(",,,,7\n", ",,,,8\n") + along
        u = self.displacements(self.static(CLAMP + LOADS + bush, "e"))[:50]
        found = self.static(CLAMP + LOADS + fast + along + PFAST.format(d=real(DIAMETER), mass="").replace(",-1,0,", ",8,1,"))
        np.testing.assert_allclose(self.displacements(found)[:50], u, rtol=0, atol=1e-9 * np.abs(u).max())

    def test_weld_is_a_bar_between_rbe3(self):
        """The length is within LDMIN and LDMAX, and below LDMIN, where the moduli are smaller by L over LDMIN D."""
        d = DIAMETER
        area, inertia = math.pi * d**2 / 4, math.pi * d**4 / 64
        for low, factor in ((.1, 1.0), (.5, GAP / (.5 * d))):
            bar = self.make_joint(f"CBAR,50,50,901,902,0.,1.,0.\nPBAR,50,9,{real(area)},{real(inertia)},{real(inertia)},"
                                  f"{real(2 * inertia)}\n,\n,.9,.9\nMAT1,9,{real(2e9 * factor)},,.3\n")
            expected = self.static(CLAMP + LOADS + bar, "e")
            u = self.displacements(expected)[:50]
            place = f"GRID,900,,{real(CENTRE[0])},{real(CENTRE[1])},.5\n"
            for form in ("900,PARTPAT\n,1,2", "900,ELPAT\n,105,205"):
                weld = f"CWELD,50,50,{form}\nPWELD,50,9,{real(d)}\n,{low},5.\nMAT1,9,2.+9,,.3\n"
                found = self.static(CLAMP + LOADS + place + weld)
                with self.subTest(form, low=low):
                    np.testing.assert_allclose(self.displacements(found)[:50], u, rtol=0, atol=1e-9 * np.abs(u).max())

    def test_weld_of_one_element_is_a_bar_on_mpcs(self):
        """ELEMID and GRIDID: the ends follow the bilinear surface, rotations by its gradients."""
        d, (x, y) = .03, (1.3 * A, 1.6 * A)
        area, inertia = math.pi * d**2 / 4, math.pi * d**4 / 64
        xi, eta = 2 * (x / A - 1) - 1, 2 * (y / A - 1) - 1
        N = [(1 - xi) * (1 - eta) / 4, (1 + xi) * (1 - eta) / 4, (1 + xi) * (1 + eta) / 4, (1 - xi) * (1 + eta) / 4]
        Nx = [-(1 - eta) / 2 / A, (1 - eta) / 2 / A, (1 + eta) / 2 / A, -(1 + eta) / 2 / A]
        Ny = [-(1 - xi) / 2 / A, -(1 + xi) / 2 / A, (1 + xi) / 2 / A, (1 - xi) / 2 / A]
        text = f"GRID,901,,{real(x)},{real(y)},0.\nGRID,902,,{real(x)},{real(y)},{real(GAP)}\n"
        for ref, first in ((901, 100), (902, 200)):
            g = [c(first) for c in CORNERS]
            rows = {1: [(1, N)], 2: [(2, N)], 3: [(3, N)], 4: [(3, Ny)], 5: [(3, [-v for v in Nx])],
                    6: [(2, [v / 2 for v in Nx]), (1, [-v / 2 for v in Ny])]}
            for c, terms in rows.items():
                pairs = [(ref, c, -1.0)] + [(g[i], comp, values[i]) for comp, values in terms for i in range(4)]
                lines = [",".join(f"{a},{b},{real(v)}" for a, b, v in pairs[k:k + 2]) for k in range(0, len(pairs), 2)]
                text += "MPC,4," + "\n,,".join(lines) + "\n"
        bar = text + f"CBAR,50,50,901,902,0.,1.,0.\nPBAR,50,9,{real(area)},{real(inertia)},{real(inertia)},{real(2 * inertia)}\n,\n,.9,.9\n" \
            "MAT1,9,2.+9,,.3\n"
        u = self.displacements(self.static(CLAMP + LOADS + bar, "e", ("SPC = 1", "LOAD = 5", "MPC = 4", "FORCE = ALL")))[:50]
        corners = [",".join(str(c(first)) for c in CORNERS) for first in (100, 200)]
        for form in ("900,ELEMID\n,105,205", f"900,GRIDID,,,QQ\n,{corners[0]}\n,{corners[1]}"):
            weld = f"GRID,900,,{real(x)},{real(y)},.3\nCWELD,50,50,{form}\nPWELD,50,9,{real(d)}\nMAT1,9,2.+9,,.3\n"
            found = self.static(CLAMP + LOADS + weld)
            with self.subTest(form):
                np.testing.assert_allclose(self.displacements(found)[:50], u, rtol=0, atol=1e-9 * np.abs(u).max())

    def test_aligned_weld(self):
        """ALIGN: a bar between two grids of the plates."""
        d = .03
        area, inertia = math.pi * d**2 / 4, math.pi * d**4 / 64
        bar = f"CBAR,50,50,112,212,0.,1.,0.\nPBAR,50,9,{real(area)},{real(inertia)},{real(inertia)},{real(2 * inertia)}\n,\n,.9,.9\n"
        mat = "MAT1,9,2.+9,,.3\n"
        u = self.displacements(self.static(CLAMP + LOADS + bar + mat, "e"))
        found = self.static(CLAMP + LOADS + f"CWELD,50,50,,ALIGN,112,212\nPWELD,50,9,{real(d)}\n" + mat)
        np.testing.assert_allclose(self.displacements(found), u, rtol=0, atol=1e-9 * np.abs(u).max())

    def test_affine_field_across_elements(self):
        """Plates in affine motion: the ends follow it anywhere, with squares over several elements; forces by hand."""
        field = {100: np.array([[1, 2, -1], [.5, -2, 3], [2, 1, -1]]) * 1e-3, 200: np.array([[-1, 1, 2], [3, 1, -2], [1, -2, 2]]) * 1e-3}
        place = np.array([1.9 * A, 2.05 * A])
        enforced, moved = "", {}
        for first, B in field.items():
            for j in range(5):
                for i in range(5):
                    u = B @ [1, i * A, j * A]
                    theta = [B[2, 2], -B[2, 1], (B[1, 1] - B[0, 2]) / 2]
                    for c, value in enumerate([*u, *theta], 1):
                        enforced += f"SPC,1,{first + j * 5 + i},{c},{value:.14E}\n".replace("E-0", "E-").replace("E+0", "E+")
            moved[first] = np.array([*(B @ [1, *place]), B[2, 2], -B[2, 1], (B[1, 1] - B[0, 2]) / 2])
        fast = f"GRID,900,,{real(place[0])},{real(place[1])},.5\nCFAST,50,50,PROP,1,2,900\n" + PFAST.format(d=".12", mass="") + \
            "SPC1,1,123456,900\nGRID,999,,9.,9.,9.\nCELAS2,9,5.,999,1\nSPC1,1,23456,999\nFORCE,5,999,0,1.,1.,0.,0.\n"
        found = self.static(enforced + fast)
        force = self.forces(found, "CFAST")[0]
        a, b = moved[100], moved[200]
        arm = np.array([0, 0, GAP / 2])  # to the spring, at the middle
        stretch = np.r_[b[:3] - np.cross(b[3:], arm) - a[:3] - np.cross(a[3:], arm), b[3:] - a[3:]]
        R = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])  # rows: element axes along z, x, y
        expected = np.array(K) * np.r_[R @ stretch[:3], R @ stretch[3:]]
        np.testing.assert_allclose(force, expected, rtol=0, atol=1e-9 * np.abs(expected).max())

    def test_coupons_in_tension(self):
        """Two coupons on one plane, one fastener in an element: F / KT2, F / KT3 in shear, F / KT1 along its axis."""
        plane = PLATES.replace(f",{real(GAP)}\n", ",0.\n")
        for load, expected in [((1, 0, 0), 900 / K[1]), ((0, 1, 0), 900 / K[2]), ((0, 0, 1), 900 / K[0])]:
            loads = "".join(f"FORCE,5,{c(200)},0,225.,{','.join(map(real, load))}\n" for c in CORNERS)
            fast = f"CFAST,50,50,PROP,1,2\n,{real(CENTRE[0])},{real(CENTRE[1])},0.\n" + PFAST.format(d=".03", mass="")
            self.write("d.bdf", "\n".join(["SOL 101", "CEND", "SPC = 1", "LOAD = 5", "BEGIN BULK", plane + loads + fast,
                                           "SPC1,1,123456,100,THRU,124", "ENDDATA", ""]))
            self.bough("static", "d.bdf", "-o", "d.h5")
            with h5py.File(self.path("d.h5")) as f:
                u = f["subcases"][list(f["subcases"])[0]]["displacement"][()].reshape(-1, 6)
            self.assertLess(abs(u[25:50, :3] @ load - expected).max(), 1e-7 * expected, load)

    def test_rigid_body_modes_and_mass(self):
        """Free plates: six modes of 0 Hz, the mass of the fasteners is in the mass of the body."""
        fast = "GRID,900,,.15,.17,.5\nGRID,902,,.31,.12,.5\nGRID,903,,.25,.33,.5\nSPC1,1,123456,900,902,903\n" \
            "CFAST,50,50,PROP,1,2,900\nCFAST,51,50,ELEM,106,206,902\nCWELD,52,52,903,PARTPAT\n,1,2\nPWELD,52,9,.02\nMAT1,9,2.+9,,.3\n"
        masses = []
        for mass in ("", ".75"):
            self.write("d.bdf", make(103, ("SPC = 1", "METHOD = 1"), "EIGRL,1,,,8\n" + fast + PFAST.format(d=".03", mass=mass)))
            self.bough("modes", "d.bdf", "-o", "m.h5")
            hz, m = self.read_arrays("m.h5", "/modes/frequency_hz", "/rigid/mass")
            self.assertLess(max(hz[:6]), 1e-3 * hz[6])
            masses.append(float(np.ravel(m)[0]))
        self.assertAlmostEqual(masses[1] - masses[0], 1.5, places=9)

    def test_other_units_and_written_deck(self):
        fast = f"CFAST,50,50,PROP,1,2\n,{real(CENTRE[0])},{real(CENTRE[1])},0.\n" + PFAST.format(d=".03", mass="") + \
            f"CWELD,52,52,,PARTPAT\n,1,2\n,.33,.31,0.\nPWELD,52,9,.02\nMAT1,9,2.+9,,.3\nGRID,902,,.21,.12,.5\n" \
            "CFAST,53,50,ELEM,106,206,902\nCWELD,54,52,902,ELPAT\n,106,206\nCWELD,55,52,,ALIGN,112,212\nSPC1,1,123456,902\n"
        u = self.displacements(self.static(CLAMP + LOADS + fast))
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.bdf")
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "n.bdf")
        for name, factor in (("mm", 1e3), ("n", 1)):
            self.assertNotIn("deck.", self.bough("static", f"{name}.bdf", "-o", f"{name}.h5").stderr)
            with h5py.File(self.path(f"{name}.h5")) as f:
                group = f["subcases"][list(f["subcases"])[0]]
                v = group["displacement"][()].reshape(-1, 6)
            np.testing.assert_allclose(v[:, :3], factor * u[:, :3], rtol=0, atol=1e-7 * np.abs(v[:, :3]).max())

    def buckle(self, bulk):
        """Lowest load factor of a rigid plate on one connector."""
        grids = [100 + k for k in range(25)], [200 + k for k in range(25)]
        x, y = CENTRE
        rigid = f"GRID,800,,{real(x)},{real(y)},{real(GAP)}\nRBE2,801,800,123456," + ",".join(map(str, grids[1][:5])) + "\n"
        for k in range(5, 25, 8):
            rigid += "," + ",".join(map(str, grids[1][k:k + 8])) + "\n"
        case = ("SPC = 1", "SUBCASE 1", "LOAD = 5", "SUBCASE 2", "METHOD = 1")
        self.write("d.bdf", make(105, case, "EIGRL,1,,,2\nSPC1,1,123456,100,THRU,124\n" + rigid + bulk))
        self.bough("modes", "d.bdf", "--buckling", "-o", "d.h5")
        with h5py.File(self.path("d.h5")) as f:
            return f["buckling/load_factor"][()]

    def test_rigid_plate_on_a_fastener_buckles(self):
        """A couple of forces M on a plate whose hinge has k_x and k_z: ½ k θ² + ½ M θ_x θ_z, M = 2 √(k_x k_z)."""
        loads = "FORCE,5,200,0,1.,0.,0.,1.+5\nFORCE,5,204,0,1.,0.,0.,-1.+5\n"  # 4e4 about y
        fast = f"GRID,900,,{real(CENTRE[0])},{real(CENTRE[1])},.5\nSPC1,1,123456,900\nCFAST,50,50,PROP,1,2,900\n" \
            "PFAST,50,.03,0,0,1.+9,1.+9,2.+9,1.+5\n,1.+9,4.+5\n"
        factors = self.buckle(fast + loads)
        self.assertAlmostEqual(min(abs(factors)), 2 * math.sqrt(1e5 * 4e5) / 4e4, delta=1e-6)

    def test_buckling_as_between_grids(self):
        """CFAST as CBUSH, CWELD as CBAR between a fixed grid and the grid of the rigid plate, under any loads."""
        x, y, d = *CENTRE, .004
        place = f"GRID,900,,{real(x)},{real(y)},.5\nSPC1,1,123456,900\n"
        ground = f"GRID,802,,{real(x)},{real(y)},0.\nSPC1,1,123456,802\nCORD2R,7,,0.,0.,0.,1.,0.,0.\n,0.,0.,1.\n"
        area, inertia = math.pi * d**2 / 4, math.pi * d**4 / 64
        bar = f"CBAR,50,50,802,800,1.,0.,0.\nPBAR,50,9,{real(area)},{real(inertia)},{real(inertia)},{real(2 * inertia)}\n,\n,.9,.9\n"
        bush = "CBUSH,50,50,802,800,,,,7\nPBUSH,50,K,1.+7,2.+7,1.+7,4.+3,3.+3,2.+3\n"
        fast = place + "CFAST,50,50,PROP,1,2,900\nPFAST,50,.03,7,0,1.+7,2.+7,1.+7,4.+3\n,3.+3,2.+3\n"
        weld = f"PWELD,50,9,{real(d)}\n,.1,50.\n"
        cases = [(bush, [fast + "CORD2R,7,,0.,0.,0.,1.,0.,0.\n,0.,0.,1.\n"]),
                 (bar, [place + "CWELD,50,50,900,PARTPAT\n,1,2\n" + weld, place + "CWELD,50,50,900,ELEMID\n,105,205\n" + weld])]
        for load in ((1, 0, 0), (.3, -.2, -1), (0, 0, -1)):
            loads = f"MAT1,9,7.+10,,.3\nFORCE,5,200,0,300.,{','.join(map(real, load))}\nFORCE,5,218,0,200.,-.2,.3,.1\n"
            for grids, connectors in cases:
                expected = self.buckle(ground + grids + loads)
                for connector in connectors:
                    with self.subTest(connector, load=load):
                        np.testing.assert_allclose(self.buckle(connector + loads), expected, rtol=1e-8)

    def test_large_displacements(self):
        """A soft fastener whose plates turn against each other, as CBUSH between RBE3, which follow finite means."""
        loads = "FORCE,5,204,0,60.,1.,.3,.2\nFORCE,5,224,0,50.,.4,-.2,1.\n"
        bush = self.make_joint("CBUSH,50,50,901,902,,,,0\nPBUSH,50,K,3.+5,2.+5,1.+5,40.,30.,20.\n")
        fast = f"GRID,900,,{real(CENTRE[0])},{real(CENTRE[1])},.5\nSPC1,1,123456,900\nCFAST,50,50,PROP,1,2,900\n" \
            f"PFAST,50,{real(DIAMETER)},0,0,3.+5,2.+5,1.+5,40.\n,30.,20.\n"
        u = []
        for cards in (bush, fast):
            self.write("d.bdf", make(101, ("SPC = 1", "LOAD = 5"), CLAMP + loads + cards))
            self.bough("static", "d.bdf", "--nonlinear", "-o", "d.h5")
            with h5py.File(self.path("d.h5")) as f:
                u.append(f["subcases"][list(f["subcases"])[0]]["displacement"][()].reshape(-1, 6)[:50])
        turn = np.linalg.norm(u[0][25:, 3:], axis=1).mean() - np.linalg.norm(u[0][:25, 3:], axis=1).mean()
        self.assertGreater(turn, .3)
        np.testing.assert_allclose(u[1], u[0], rtol=0, atol=1e-8 * np.abs(u[0]).max())

    def test_length_of_spot_welds(self):
        """Half the thickness of both shells: of plies, and of T1 to T4, as LDMIN = LDMAX gives it."""
        d, place = .03, f"GRID,900,,{real(CENTRE[0])},{real(CENTRE[1])},.5\nMAT1,9,2.+9,,.3\n"
        forms = ("900,PARTPAT\n,1,2\n", "900,ELPAT\n,105,205\n", "900,ELEMID\n,105,205\n")
        plies = PLATES.replace("PSHELL,1,1,.004,1,,1\n", "PCOMP,1,,,,,,,SYM\n,1,.001,,,1,.0015,\n")
        lines = []
        for line in PLATES.splitlines():
            fields = line.split(",")
            lines.append(line + ",,\n,,,.002,.004,.006,.006" if fields[0] == "CQUAD4" and fields[2] == "1" else line)
        for plates, thickness in ((PLATES, .004), (plies, .005), ("\n".join(lines) + "\n", .0045)):
            length = .5 * (thickness + .003)
            for form in forms:
                u = []
                for end in (",,,,SPOT\n", f"\n,{real(length / d)},{real(length / d)}\n"):
                    weld = place + f"CWELD,50,50,{form}PWELD,50,9,{real(d)},{end}" if "SPOT" in end else \
                        place + f"CWELD,50,50,{form}PWELD,50,9,{real(d)}{end}"
                    self.write("d.bdf", make(101, ("SPC = 1", "LOAD = 5"), CLAMP + LOADS + weld).replace(PLATES, plates))
                    self.bough("static", "d.bdf", "-o", "d.h5")
                    with h5py.File(self.path("d.h5")) as f:
                        u.append(f["subcases"][list(f["subcases"])[0]]["displacement"][()])
                with self.subTest(form, thickness=thickness):
                    np.testing.assert_allclose(u[0], u[1], rtol=0, atol=1e-9 * np.abs(u[1]).max())

    def test_doubtful_cards(self):
        """A fastener without stiffness, and a place that is given twice."""
        place = "GRID,900,,.15,.17,.5\nSPC1,1,123456,900\n"
        fast = "CFAST,50,50,PROP,1,2,900\n"
        for cards, words in [(place + fast + "PFAST,50,.03\n", ["fe.connector-stiffness", "PFAST 50", "KT1 to KR3"]),
                             (place + fast + ",.1,.1,0.\n" + PFAST.format(d=".03", mass=""), ["deck.unused-field", "GS gives the place"]),
                             (place + "CWELD,50,50,900,PARTPAT\n,1,2\n,.1,.1,0.\nPWELD,50,9,.02\nMAT1,9,2.+9,,.3\n",
                              ["deck.unused-field", "GS gives the place"])]:
            support = "SPC1,1,123456,200,205,210,215,220\n"
            self.static(CLAMP + LOADS + support + cards)
            for word in words:
                self.assertIn(word, self.result.stderr)

    def test_rejected_input(self):
        pfast, place = PFAST.format(d=".03", mass=""), "GRID,900,,.15,.17,.5\n"
        weld = "PWELD,50,9,.02\nMAT1,9,2.+9,,.3\n"
        for cards, error, says in [
                (place + "CFAST,50,50,PROP,1,7,900\n" + pfast, "fe.connector-shell", ["CFAST 50", "property 7"]),
                (place + "CFAST,50,50,ELEM,105,777,900\n" + pfast, "fe.connector-shell", ["shell 777"]),
                ("GRID,900,,.9,.17,.5\nCFAST,50,50,PROP,1,2,900\n" + pfast, "fe.connector-projection", ["property 1"]),
                ("GRID,900,,.0,.17,.5\nCFAST,50,50,PROP,1,2,900\n" + pfast, "fe.connector-projection", ["is on the rim", "0.001875"]),
                (place + "CFAST,50,50,PROP,1,1,900\n" + pfast, "fe.connector-sides", ["property 1 on both sides"]),
                (place + "CWELD,50,50,900,ELEMID\n,105,105\n" + weld, "fe.connector-sides", ["shell 105 on both sides"]),
                (place + "CWELD,50,50,900,ELEMID\n,105\n" + weld, "fe.connector-form", ["point to a patch"]),
                (place + "CFAST,50,50,PROP,1,2\n" + pfast, "deck.missing-field", ["GS, GA and XS"]),
                (place + "CFAST,50,51,PROP,1,2,900\n" + pfast, "fe.missing-property", ["PFAST"]),
                (place + "CFAST,50,50,PROP,1,2,900\n" + pfast.replace(",.03,", ",-.03,"), "deck.field-range", ["positive diameter"]),
                ("CWELD,50,50,,ALIGN,112\n" + weld, "deck.missing-field", ["GA or GB"])]:
            self.write("d.bdf", make(101, ("SPC = 1", "LOAD = 5"), CLAMP + LOADS + cards))
            self.fails(1, "static", "d.bdf", error=error, says=says)
        steep = make_plate(300, 3, 0) + "PSHELL,3,1,.004,1,,1\n"
        lines = []
        for line in steep.splitlines():
            parts = line.split(",")
            if parts[0] == "GRID":
                parts[5] = real(.05 + .6 * float(parts[3]))
            lines.append(",".join(parts))
        self.write("d.bdf", make(101, ("SPC = 1", "LOAD = 5"), CLAMP + LOADS + "SPC1,1,123456,300,305,310,315,320\n" + "\n".join(lines) +
                                 "\n" + place + "CFAST,50,50,PROP,1,3,900\nCFAST,51,50,PROP,2,3,900\n" + pfast))
        self.assertIn("fe.connector-angle", self.bough("static", "d.bdf").stderr)

    def test_shells_by_property_and_by_id(self):
        """Connectors by property equal those by shells: plates of 400 shells, five sides of a shell apart."""
        n = 20
        bulk = make_plate(1000, 1, 0, n) + make_plate(2000, 2, 5 * A, n, .03)
        bulk += "PSHELL,1,1,.004,1,,1\nPSHELL,2,1,.003,1,,1\nMAT1,1,7.+10,,.3,2700.\nSPC1,1,123456,1000,THRU,1020\n"
        bulk += "FORCE,5,2440,0,70.,1.,.3,.2\n" + PFAST.format(d=real(.03), mass="0.") + "PWELD,60,1,.03\n"
        random = np.random.default_rng(5)
        decks = ["", ""]
        for k, (x, y) in enumerate(np.round(random.uniform(.05, 1.95, (30, 2)), 4)):
            a, b = (first + int(y / A) * n + int((x - x0) / A) for first, x0 in ((1000, 0), (2000, .03)))
            place = f"{real(x)},{real(y)},{real(float(random.choice((-3., 0., .25, 2.))))}"
            if k % 2:
                forms = f"PROP,1,2,,,,\n,{place}", f"ELEM,{a},{b},,,,\n,{place}"
                decks = [deck + f"CFAST,{9001 + k},50,{form}\n" for deck, form in zip(decks, forms)]
            else:
                forms = f"PARTPAT,,,,,\n,1,2,,,,,,,\n,{place}", f"ELPAT,,,,,\n,{a},{b},,,,,,,\n,{place}"
                decks = [deck + f"CWELD,{9001 + k},60,,{form}\n" for deck, form in zip(decks, forms)]
        case = ["SPC = 1", "LOAD = 5"]
        found = []
        for deck in decks:
            self.write("d.bdf", "\n".join(["SOL 101", "CEND", *case, "BEGIN BULK", bulk + deck, "ENDDATA", ""]))
            self.bough("static", "d.bdf", "-o", "d.h5", "-q")
            with h5py.File(self.path("d.h5")) as f:
                group = f["subcases"][list(f["subcases"])[0]]
                arrays = {}
                group.visititems(lambda path, item: arrays.update({path: item[()]}) if isinstance(item, h5py.Dataset) else None)
            found.append(self.displacements(arrays))
        self.assertGreater(np.abs(found[0]).max(), 0)
        np.testing.assert_allclose(found[0], found[1], rtol=0, atol=1e-9 * np.abs(found[1]).max())


if __name__ == "__main__":
    unittest.main()
