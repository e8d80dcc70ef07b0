"""Commands, parameters and cards of a deck that change the answer: done, or an error that --ignore turns into a warning.
What Nastran runs is run. Numbers: closed forms of rods and masses on springs."""
import unittest

import h5py
import numpy as np

from support import ProgramTest
from decks import grids

ROD = """SOL 101
CEND
SPC = 1
{case}
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CROD,1,1,1,2
PROD,1,1,1.-4
MAT1,1,2.+11,,.3
SPC1,1,123456,1
SPC1,1,23456,2
FORCE,5,2,0,100.,1.,0.,0.
{bulk}ENDDATA
"""
PER_NEWTON = 1 / (2e11 * 1e-4)  # L / EA

PAIR = """SOL {sol}
CEND
METHOD = 1
{case}
BEGIN BULK
{method}
SPOINT,1,2
CELAS2,1,100.,1,0,2,0
CELAS2,2,100.,1,0
CMASS2,3,.01,1,0
CMASS2,4,.01,2,0
GRID,99,,0.,0.,0.
SPC1,1,123456,99
{bulk}ENDDATA
"""
# m λ = k (3 ∓ √5) / 2
PAIR_HZ = [np.sqrt(1e4 * (3 + s * np.sqrt(5)) / 2) / (2 * np.pi) for s in (-1, 1)]

BASE = """SOL {sol}
CEND
SPC = 9
METHOD = 3
DLOAD = 1
{case}
SDAMPING = 4
ACCELERATION = ALL
BEGIN BULK
{bulk}
SPOINT,1,2
CELAS2,1,39.4784176,1,0,2,0
CMASS2,3,.01,2,0
SPC1,9,0,1
SPCD,5,1,0,1.
TABDMP1,4,{type}
,0.,{damping},1000.,{damping},ENDT
EIGRL,3,,,1
GRID,99,,0.,0.,0.
SPC1,9,123456,99
ENDDATA
"""


class Static(ProgramTest):
    def solve(self, case, bulk="", *options):
        self.write("d.bdf", ROD.format(case=case, bulk=bulk))
        said = self.bough("static", "d.bdf", "-o", "d.h5", *options).stderr
        with h5py.File(self.path("d.h5")) as f:
            names = list(f["subcases"])
            ids = list(f["nodes/id"]) if "nodes/id" in f else [1, 2]
            u = {n: f[f"subcases/{n}/displacement"][()].reshape(len(ids), -1)[1, 0] for n in names}
        return u, said

    PL = "DMIG,PL,0,9,1,0,,,1\nDMIG,PL,1,,,2,1,1000.\n"

    def test_direct_loads(self):
        """P2G: sets, factors, PARAM,CP1 and CP2, a column for each subcase."""
        two = "DMIG,PL,0,9,1,0,,,2\nDMIG,PL,1,,,2,1,1000.\nDMIG,PL,2,,,2,1,-300.\n"
        for case, bulk, loads in [
                ("LOAD = 5\nP2G = PL", self.PL, [1100]),
                ("P2G = PL", self.PL, [1000]),
                ("LOAD = 5\nP2G = 2.*PL, .5*PX", self.PL + "DMIG,PX,0,9,1,0,,,1\nDMIG,PX,1,,,2,1,8.\n", [2104]),
                ("SET 3 = 2.*PL\nLOAD = 5\nP2G = 3", self.PL, [2100]),
                ("LOAD = 5\nP2G = PL", self.PL + "PARAM,CP1,3.\nPARAM,CP2,.1\n", [400]),
                ("P2G = PL\nSUBCASE 1\nLOAD = 5\nSUBCASE 2\nLABEL = X", two, [1100, -300]),
                ("SUBCASE 1\nLOAD = 5\nSUBCASE 2\nP2G = PL", self.PL, [100, 1000])]:
            u, said = self.solve(case, bulk)
            np.testing.assert_allclose(list(u.values()), np.array(loads) * PER_NEWTON, rtol=1e-12, err_msg=case)
            self.assertIn("[deck.load-columns]", said)
        (u,) = self.solve("LOAD = 5", "PARAM,CP1,3.\n")[0].values()
        self.assertAlmostEqual(u, 300 * PER_NEWTON, delta=1e-18)
        u, said = self.solve("P2G = PL\nSUBCASE 1\nLOAD = 5\nSUBCASE 2\nLOAD = 5", self.PL)
        np.testing.assert_allclose(list(u.values()), [1100 * PER_NEWTON, 100 * PER_NEWTON], rtol=1e-12)
        self.assertIn("[deck.load-matrix]", said)

    def test_name_of_direct_loads(self):
        """The set that P2G makes is in no deck: messages name the command."""
        deck = ("SOL 105\nCEND\nSPC = 1\nSUBCASE 1\n{load}SUBCASE 2\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,1\nGRID,1,,0.,0.,0.\n"
                "GRID,2,,.5,0.,0.\nGRID,3,,1.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,1.,0.\nPBAR,1,1,1.-4,1.-9,2.-9,2.-9\n"
                "MAT1,1,2.+11,,.3\nSPC1,1,123456,1\nFORCE,5,3,,1.,-1.,0.,0.\n" + self.PL.replace(",2,1,1000.", ",3,1,-1000.") + "ENDDATA\n")
        for load, name in (("P2G = PL\n", "P2G"), ("LOAD = 5\nP2G = PL\n", "LOAD and P2G"),
                           ("LOAD = 5\n", "LOAD 5")):
            self.write("b.bdf", deck.format(load=load))
            self.assertIn(f"load factors of {name} (subcase 1)", self.bough("modes", "b.bdf", "--buckling").stdout)

    def test_direct_loads_in_displacement_axes(self):
        """The component 2 of a grid whose CD is turned by 90 degrees is the axis of the rod."""
        turned = self.PL.replace("2,1,1000.", "2,2,-1000.") + "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\n"
        self.write("d.bdf", ROD.format(case="P2G = PL", bulk=turned).replace("GRID,2,,1.,0.,0.", "GRID,2,,1.,0.,0.,7")
                   .replace("SPC1,1,23456,2", "SPC1,1,13456,2"))
        self.assertIn(f"{1000 * PER_NEWTON:.6e}", self.bough("static", "d.bdf", "--full").stdout)

    def test_direct_loads_refused(self):
        for bulk, error in [(self.PL.replace(",9,", ",6,"), "deck.load-matrix"), ("", "deck.load-matrix"),
                            (self.PL.replace("2,1,1000.", "7,1,1000."), "fe.missing-grid"),
                            (self.PL.replace("0,9,1,0", "0,9,3,0").replace("1000.", "1.,1."), "deck.load-matrix")]:
            self.write("d.bdf", ROD.format(case="P2G = PL", bulk=bulk))
            self.fails(1, "static", "d.bdf", error=error)

    def test_written_again(self):
        self.write("d.bdf", ROD.format(case="LOAD = 5\nP2G = 2.*PL", bulk=self.PL))
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "n.bdf")
        one, two = (self.bough("static", n, "--json").stdout for n in ("d.bdf", "n.bdf"))
        self.assertEqual(one, two)

    def test_loads_that_are_not_read(self):
        for command in ("TRIM", "BOLTLD", "DEFORM", "CLOAD"):
            self.write("d.bdf", ROD.format(case=f"LOAD = 5\n{command} = 4", bulk=""))
            self.fails(1, "static", "d.bdf", error="fe.unread-load", says=[command])
            self.bough("modes", "d.bdf", "-n", "1", code=1)  # no mass: but no word of loads
            u, said = self.solve(f"LOAD = 5\n{command} = 4", "", "--ignore", command)
            self.assertAlmostEqual(list(u.values())[0], 100 * PER_NEWTON, delta=1e-18)
            self.assertIn("ignored as asked", said)

    def test_materials_by_temperature(self):
        cards = "MATT1,1,7\nTABLEM1,7\n,0.,2.+11,100.,1.+11,ENDT\nTEMPD,6,50.\n"
        for command in ("TEMP(MATERIAL)", "TEMP", "TEMP(BOTH)"):
            self.write("d.bdf", ROD.format(case=f"LOAD = 5\n{command} = 6", bulk=cards))
            self.bough("static", "d.bdf")
            self.bough("static", "d.bdf", "--ignore", "MATT1")
        self.write("d.bdf", ROD.format(case="LOAD = 5\nTEMP = 6", bulk=cards.replace("MATT1,", "MATT11,")))
        self.fails(1, "static", "d.bdf", error="deck.unsupported-card", says=["MATT11"])
        for case, bulk in [("LOAD = 5\nTEMP(LOAD) = 6", cards), ("LOAD = 5", cards),
                           ("LOAD = 5\nTEMP = 6", cards.replace("MATT1,1", "MATT1,9"))]:
            self.solve(case, bulk)

    def test_mass_and_stiffness_that_are_not_read(self):
        for case, bulk, error in [("MFLUID = 4", "", "deck.unsupported-command"),
                                  ("MASSSET = 4", "", "deck.unsupported-command"),
                                  ("", "PARAM,CK3,2.\n", "deck.unsupported-param")]:
            self.write("d.bdf", ROD.format(case="LOAD = 5\n" + case, bulk=bulk))
            self.fails(1, "static", "d.bdf", error=error, says=["--ignore"])
            name = case.split(" ")[0] or "CK3"
            self.bough("static", "d.bdf", "--ignore", name)

    def test_sets_without_cards(self):
        """SPC and SPCADD as LOAD and MPC: a warning."""
        for spc in ("SPCADD,1,3,4\nSPC1,3,123456,1\nSPC1,3,23456,2\n", ""):
            text = ROD.format(case="LOAD = 5", bulk=spc)
            if spc:
                text = text.replace("SPC1,1,123456,1\nSPC1,1,23456,2\n", "")
            else:
                text = text.replace("SPC1,1", "SPC1,3").replace("GRID,1,,0.,0.,0.", "GRID,1,,0.,0.,0.,,123456").replace(
                    "GRID,2,,1.,0.,0.", "GRID,2,,1.,0.,0.,,23456")
            self.write("d.bdf", text)
            result = self.bough("static", "d.bdf", "--full")
            self.assertIn("[fe.missing-set]", result.stderr)
            self.assertIn("5.000000e-06", result.stdout)


PLATE = """SOL 101
CEND
SPC = 1
LOAD = 5
BEGIN BULK
""" + grids((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)) + grids((.5, .5, 1), first=9) + """CQUAD4,1,1,1,2,3,4{angle}
{property}
MAT1,1,2.+11,,.3
MAT8,8,1.4+11,1.+10,.3,5.+9,5.+9,5.+9
RBE3,20,,9,{refc},1.,123,1,2
,3,4
SPC1,1,123456,1,2
FORCE,5,9,0,100.,0.,1.,0.
ENDDATA
"""


class Written(ProgramTest):
    """Cards that other programs read, against the same structure written out."""

    def displacements(self, text, warning=None):
        self.write("d.bdf", text)
        said = self.bough("static", "d.bdf", "-o", "d.h5").stderr
        if warning:
            self.assertIn(warning, said)
        with h5py.File(self.path("d.h5")) as f:
            (case,) = f["subcases"]
            return f[f"subcases/{case}/displacement"][()]

    def test_blank_components_of_rbe3(self):
        plate = dict(angle="", property="PSHELL,1,1,.1,1,,1")
        u = self.displacements(PLATE.format(refc="", **plate))
        np.testing.assert_array_equal(u, self.displacements(PLATE.format(refc="123456", **plate)))
        self.assertAlmostEqual(u.reshape(-1, 6)[4, 1], 1.877844e-6, delta=1e-12)

    def test_material_axes_normal_to_a_laminate(self):
        """System 7 has x along the normal and y along the side 1-4: the same as an angle of 90 degrees."""
        laminate = "PCOMP,1\n,8,.1,0.,YES,8,.1,30.,YES\nCORD2R,7,,0.,0.,0.,1.,0.,0.\n,0.,0.,1."
        u = self.displacements(PLATE.format(refc="123456", angle=",7", property=laminate), "[fe.bad-material-axes]")
        expected = self.displacements(PLATE.format(refc="123456", angle=",-90.", property=laminate))
        np.testing.assert_allclose(u, expected, atol=1e-9 * np.abs(expected).max())

    COSMIC = """ID CRIGD,IDS
APP DISP
SOL 1,0
CEND
SPC=1
LOAD=5
BEGIN BULK
GRID    1               0.      0.      0.
GRID    2               1.      0.      0.
GRID    3               2.      0.      0.
GRID    4               1.      1.      0.
CBAR    1       1       1       2       0.      1.      0.      1
CBAR    2       1       1       4       0.      0.      1.      1
PBAR    1       1       1.-3    1.-6    1.-6    1.-6
MAT1    1       2.+11           .3
CRIGD1  7       2       3
CRIGD2  {}       3       4       123
SPC1    1       123456  1
FORCE   5       3       0       10.     0.      1.      0.
ENDDATA
"""

    def test_ids_of_old_rigid_elements(self):
        """In NASTRAN-95 they are unique for each name; the deck that is written has ids for today."""
        u = self.displacements(self.COSMIC.format(7))
        self.bough("export", "d.bdf", "--to", "bdf", "-o", "n.bdf")
        with open(self.path("n.bdf")) as f:
            written = f.read()
        np.testing.assert_array_equal(u, self.displacements(self.COSMIC.format(8)))
        np.testing.assert_array_equal(u, self.displacements(written))
        self.write("d.bdf", self.COSMIC.format(7).replace("CRIGD2", "CRIGD1").replace("4       123", "4"))
        self.fails(1, "static", "d.bdf", error="deck.duplicate-id")

    def test_bar_of_three_components(self):
        """RBAR with CNA = 123 alone: an RBE2 of 123."""
        deck = PLATE.format(refc="123456", angle="", property="PSHELL,1,1,.1,1,,1\nGRID,10,,.5,.5,2.").replace(
            "FORCE,5,9", "SPC1,1,456,10\nFORCE,5,10")
        u = self.displacements(deck.replace("SPC1,1,456", "RBAR,30,9,10,123\nSPC1,1,456"), "[fe.rbar-completed]")
        np.testing.assert_allclose(u, self.displacements(deck.replace("SPC1,1,456", "RBE2,30,9,123,10\nSPC1,1,456")),
                                   rtol=0, atol=1e-16)


class Modes(ProgramTest):
    def hz(self, sol, case, bulk, *options):
        self.write("d.bdf", PAIR.format(sol=sol, case=case, bulk=bulk, method="EIGRL,1,,,2"))
        self.bough("modes", "d.bdf", "-o", "d.h5", *options)
        with h5py.File(self.path("d.h5")) as f:
            return f["modes/frequency_hz"][:2]

    def test_complex_eigenvalues(self):
        for sol in ("107", "110", "SEDCEIG", "29"):
            self.write("d.bdf", PAIR.format(sol=sol, case="CMETHOD = 3", bulk="", method="EIGRL,1,,,2"))
            self.fails(1, "modes", "d.bdf", error="modal.missing-complex-method", says=["EIGC,3,LAN"])
            np.testing.assert_allclose(self.hz(sol, "CMETHOD = 3", "", "--ignore", "CMETHOD"), PAIR_HZ, rtol=1e-10)
            self.bough("check", "d.bdf", "--ignore", "CMETHOD")
            self.fails(1, "check", "d.bdf", error="modal.missing-complex-method")

    def test_extra_points_and_direct_input(self):
        """Normal modes have no extra points and no K2PP, with residual vectors too."""
        bulk = ("EPOINT,1000\nPARAM,RESVEC,YES\nDMIG,STIF,0,6,1,0\nDMIG,STIF,1000,0,,1000,0,1.\n"
                "DMIG,STIF,1,0,,1,0,500.\nRLOAD1,5,6,,,7\nDAREA,6,1000,0,1.\nTABLED1,7\n,0.,1.,100.,1.,ENDT\n")
        for more in ("", "RANDOM = 8\n", "TFL = 3\n"):
            case = more + "K2PP = STIF\nSUBCASE 1\nDLOAD = 5\n"
            np.testing.assert_allclose(self.hz(146, case, bulk), PAIR_HZ, rtol=1e-10)
        self.fails(1, "frequency", "d.bdf", error="deck.unsupported-card", says=["EPOINT"])

    def test_a_bearing_is_an_element(self):
        self.write("d.bdf", PAIR.format(sol=103, case="", bulk="CBEAR,77,7,1,2\n", method="EIGRL,1,,,2"))
        self.fails(1, "modes", "d.bdf", error="deck.unsupported-card", says=["CBEAR", "stiffness"])


class Response(ProgramTest):
    """A base moved by an acceleration of 1, a mass on a spring of 10 Hz with G = 0.1 or 2 ζ of the mode."""

    def peak(self, bulk, damping=.1, kind="G"):
        self.write("d.bdf", BASE.format(sol=111, case="FREQ = 1", damping=damping, type=kind,
                                        bulk=bulk + "RLOAD1,1,5,,,7,,ACCE\nTABLED1,7\n,0.,1.,1000.,1.,ENDT\nFREQ,1,5.,10.,15."))
        result = self.bough("frequency", "d.bdf", "-o", "d.h5")
        with h5py.File(self.path("d.h5")) as f:
            part = f["subcases/1/acceleration"]
            column = [tuple(d) for d in part["dofs"][()]].index((2, 0))
            modes = f["subcases/1/modes"].attrs["damped_motion"]
            return part["real"][:, column] + 1j * part["imag"][:, column], modes, result

    def test_damping_of_base_motion(self):
        """ABS: the modal damper stands on the ground, (k - ω²m + iωc) u = k d. REL: on the base."""
        w0, w = 2 * np.pi * 10, 2 * np.pi * np.array([5.0, 10.0, 15.0])
        for kdamp in ("", "PARAM,KDAMP,-1\n"):
            c = .1j * w0 * w if not kdamp else .1j * w0**2
            absolute = w0**2 / (w0**2 - w**2 + c)
            relative = (w0**2 + c) / (w0**2 - w**2 + c)
            for params, expected, motion in [("", absolute, "absolute"), ("PARAM,ENFMOTN,ABS\n", absolute, "absolute"),
                                             ("PARAM,ENFMOTN,REL\n", relative, "relative"),
                                             ("PARAM,ENFMETH,REL\n", relative, "relative")]:
                a, said, result = self.peak(kdamp + params)
                np.testing.assert_allclose(a, expected, rtol=1e-7)
                self.assertEqual(said, motion)
                self.assertIn(motion, result.stdout)

    def test_over_time(self):
        """A steady base motion, long after the start: the harmonic solution."""
        f, g = 8.0, .3
        for param, is_relative in [("", False), ("PARAM,ENFMOTN,REL\n", True)]:
            bulk = param + f"TLOAD2,1,5,,ACCE,0.,1.+3,{f},-90.\nTSTEP,1,16000,.00025"
            self.write("d.bdf", BASE.format(sol=112, case="TSTEP = 1", damping=g, type="G", bulk=bulk))
            self.bough("transient", "d.bdf", "-o", "d.h5")
            with h5py.File(self.path("d.h5")) as h:
                part = h["subcases/1/acceleration"]
                column = [tuple(d) for d in part["dofs"][()]].index((2, 0))
                t, a = h["subcases/1/time"][-2000:], part["value"][-2000:, column]
            w0, w = 2 * np.pi * 10, 2 * np.pi * f
            c = 1j * g * w0 * w
            H = (w0**2 + (c if is_relative else 0)) / (w0**2 - w**2 + c)
            # The velocity and displacement that the start leaves in the base drive an absolute damper steadily.
            fit = np.linalg.lstsq(np.c_[np.cos(w * t), np.sin(w * t), np.ones_like(t), t], a, rcond=None)[0]
            self.assertAlmostEqual(fit[0] - 1j * fit[1], H * np.exp(-.5j * np.pi), delta=2e-4)

    DRIVEN = "RLOAD1,1,6,,,1.\nDAREA,6,1,0,1.\n"

    def test_commands_that_are_not_done(self):
        for command in ("RMETHOD", "GUST", "MODESELECT", "IC(STATSUB)"):
            self.write("d.bdf", PAIR.format(sol=111, case=f"DLOAD = 1\nFREQ = 2\n{command} = 4", method="EIGRL,1,,,2",
                                            bulk=self.DRIVEN + "FREQ,2,1.\n"))
            self.fails(1, "frequency", "d.bdf", error="deck.unsupported-command", says=["--ignore"])
            self.bough("frequency", "d.bdf", "--ignore", command.split("(")[0])
            said = self.bough("modes", "d.bdf").stderr  # nothing of it acts there
            if not command.startswith("IC"):
                self.assertIn("would change a response", said)

    def test_unselected_cards(self):
        """Cards that no command selects are not checked: frequencies with blanks, damping that a direct solution has not."""
        for sol, case, bulk in [(111, "", "FREQ1,3,,1.,3\n"), (108, "SDAMPING = 44\n", ""), (111, "", "TABDMP1,9,G\n,1.,ENDT\n"),
                                (111, "", "PELAST,3,7\n"), (111, "", "PELAS,3,1.\nPELAST,3,7\n"),
                                (111, "", "PDAMP,3,1.\nPDAMPT,3,7\n"), (111, "", "PBUSH,3,K,1.\nPBUSHT,3,K,7\n"), (111, "", "PBUSHT,3,K,7\n"), (111, "", "PDAMPT,3,7\n")]:
            self.write("d.bdf", PAIR.format(sol=sol, case=f"DLOAD = 1\nFREQ = 2\n{case}", method="EIGRL,1,,,2",
                                            bulk=self.DRIVEN + "FREQ,2,1.\n" + bulk))
            self.bough("frequency", "d.bdf")
        self.write("d.bdf", PAIR.format(sol=111, case="DLOAD = 1\nFREQ = 3", method="EIGRL,1,,,2",
                                        bulk=self.DRIVEN + "FREQ1,3,,1.,3\n"))
        self.fails(1, "frequency", "d.bdf", error="deck.missing-field")


if __name__ == "__main__":
    unittest.main()
