"""First findings of an analyst: masses by direction, oblique rods, and every message with its place and its cause."""
import json
import re
import unittest

import numpy as np

from support import BEAM, ProgramTest

# Two bars along x of mass 4; a mass of 6 at the middle that moves along y only.
SIDEWAYS = BEAM.replace("1.-4,1.-8", "7.4074074074074-4,1.-8").replace("ENDDATA", "CMASS2,9,6.,2,2\nENDDATA")

# Rod along (1, 1, 1) with a mass at its end; E A = 7e6, L = sqrt(3), m = 10.
ROD = """SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
EIGRL,1,,,1
SPC1,1,123456,1
GRID,1,,0.,0.,0.
GRID,2,,1.,1.,1.
CONROD,1,1,2,1,1.-4
MAT1,1,7.+10,,.3
CONM2,2,2,,10.
ENDDATA
"""


class OneInterfaceGrid(ProgramTest):
    def test_rigid_arm_is_the_offset_of_a_mass(self):
        """Free, fixed at one grid: its constraint modes are rigid motions, with the round-off of an RBE2 or without."""
        line = "".join(f"GRID,{k},,{0.37 * k - 0.2},{0.11 * k},{0.05 * k}\n" for k in range(1, 8))
        line += "".join(f"CBAR,{k},1,{k},{k + 1},0.,0.,1.\n" for k in range(1, 7))
        deck = ("SOL 103\nCEND\nBEGIN BULK\nPBAR,1,1,1.-4,1.-8,3.-8,1.-8\nMAT1,1,7.+10,,.3,2700.\n" + line)
        offset = np.array([0.13, -0.29, 0.41])
        tip = np.array([0.37 * 7 - 0.2, 0.77, 0.35])
        self.write("conm2.bdf", deck + "CONM2,90,7,,.6,{},{},{}\n+,.01,,.02,,,.03\nENDDATA\n".format(*offset))
        self.write("rbe2.bdf", deck + "GRID,99,,{},{},{}\nRBE2,91,7,123456,99\nCONM2,90,99,,.6\n+,.01,,.02,,,.03\nENDDATA\n"
                   .format(*(tip + offset)))
        import h5py
        values = {}
        for name in ("conm2", "rbe2"):
            self.write(name + ".toml", f'[body]\nname = "b"\ndeck = "{name}.bdf"\nframe = "mean"\ninterface = [1]\n'
                       '[body.modes]\nnumber = 12\nbasis = "craig-bampton"\n')
            self.bough("reduce", name + ".toml")
            with h5py.File(self.path("b.h5")) as f:
                values[name] = np.diag(f["modal/stiffness"][:])
        exact = json.loads(self.bough("modes", "conm2.bdf", "-n", "16", "--json").stdout)["modes"]
        exact = np.array([m["eigenvalue"] for m in exact])[6:]
        self.assertEqual(len(values["conm2"]), 12)
        np.testing.assert_allclose(values["rbe2"], values["conm2"], rtol=1e-8)
        self.assertTrue((np.sort(values["rbe2"])[:10] > exact[:10] * (1 - 1e-8)).all())
        np.testing.assert_allclose(np.sort(values["rbe2"])[:3], exact[:3], rtol=1e-2)


class MassByDirection(ProgramTest):
    def test_three_masses_are_printed_and_warned_of(self):
        self.write("s.bdf", SIDEWAYS)
        result = self.bough("check", "s.bdf")
        self.assertRegex(result.stderr, r"s.bdf:15: warning: the mass is 4 along x, 10 along y, 4 along z \(CMASS2 9\).*"
                                        r"\[fe.mass-by-direction\]")
        self.assertNotRegex(result.stdout, r"(?m)^  mass 6")
        self.assertRegex(result.stdout, r"(?m)^ +x +4 .*\n +y +10 .*\n +z +4 ")
        mass = json.loads(self.bough("check", "s.bdf", "--json").stdout)["mass_properties"]
        np.testing.assert_allclose(mass["by_direction"]["mass"], [4, 10, 4], rtol=1e-12)
        np.testing.assert_allclose(mass["by_direction"]["cg"][1][0], 1, rtol=1e-12)  # both are at the middle
        self.assertIn("[fe.mass-by-direction]", self.bough("modes", "s.bdf").stderr)

    def test_one_mass_in_all_directions_is_a_body(self):
        same = "".join(f"CMASS2,{9 + c},6.,2,{c}\n" for c in (1, 2, 3))
        self.write("s.bdf", BEAM.replace("ENDDATA", same + "ENDDATA"))
        self.assertNotIn("mass-by-direction", self.bough("check", "s.bdf").stderr)
        # But not where each direction's mass is at a grid of its own.
        apart = "".join(f"CMASS2,{9 + c},6.,{c},{c}\n" for c in (1, 2, 3))
        self.write("s.bdf", BEAM.replace("ENDDATA", apart + "ENDDATA"))
        self.assertIn("[fe.mass-by-direction]", self.bough("check", "s.bdf").stderr)

    def test_shares_are_of_the_mass_of_their_direction(self):
        deck = SIDEWAYS.replace("SPC1,1,123456,1", "SPC1,1,1456,1\nSPC1,1,123456,3\nSPC1,1,456,2")
        self.write("s.bdf", deck)
        text = self.bough("modes", "s.bdf", "-n", "9").stdout
        last = text[text.index("effective mass"):].splitlines()
        rows = [line.split() for line in last if re.match(r" *\d+ ", line)]
        sums = [float(rows[-1][k]) for k in (2, 4, 6)]
        self.assertTrue(all(20 < s <= 100.005 for s in sums), sums)
        result = self.bough("reduce", "s.bdf", "--modes", "4", "-o", "s.h5")
        self.assertIn("[reduce.mass-by-direction]", result.stderr)
        shares = [[float(v) for v in line.split()[3:6]] for line in result.stdout.splitlines()
                  if re.match(r" *\d+ +\d", line)]
        self.assertTrue((np.sum(shares, axis=0) <= 100.05).all(), shares)

    def test_mean_mass_without_inertia(self):
        """Mass of one direction, by whose mean a principal moment of inertia is negative: `run` rejects the file."""
        self.write("m.bdf", "SOL 103\nCEND\nSPC=1\nBEGIN BULK\nPARAM,COUPMASS,1\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,1.\n"
                   "GRID,3,,2.,0.,1.\nCBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,1.,0.\nPBAR,1,1,4.-4,8.-9,1.2-8,1.5-8\n"
                   "MAT1,1,7.+10,,.3,270.\nCMASS2,700,.3,3,2\nSPC1,1,123456,1\nENDDATA\n")
        self.assertIn("run rejects it", self.bough("reduce", "m.bdf", "--modes", 3, "-o", "m.h5").stderr)


class ObliqueRod(ProgramTest):
    def test_the_mode_along_the_rod_is_that_of_spring_and_mass(self):
        self.write("rod.bdf", ROD)
        result = self.bough("modes", "rod.bdf", "--json")
        exact = 7e6 / (np.sqrt(3) * 10)
        np.testing.assert_allclose(json.loads(result.stdout)["eigenvalue"], [exact], rtol=1e-9)
        self.assertIn("oblique", result.stderr)
        self.assertIn("oblique direction", self.bough("check", "rod.bdf").stdout)

    def test_static_displacement_is_along_the_rod(self):
        self.write("rod.bdf", ROD.replace("SOL 103", "SOL 101").replace("METHOD = 1", "LOAD = 3")
                   .replace("ENDDATA", "FORCE,3,2,,100.,1.,1.,1.\nENDDATA"))
        out = json.loads(self.bough("static", "rod.bdf", "--json", "--full").stdout)
        u = np.array(out["subcases"][0]["displacement"]).ravel()
        along = u[np.abs(u) > 0]
        np.testing.assert_allclose(along, np.full(3, 100 * np.sqrt(3) / 7e6), rtol=1e-9)


class Words(ProgramTest):
    def test_what_the_reader_said_stands_before_the_error(self):
        deck = BEAM.replace("SOL 103", "SOL 101").replace("SPC = 1", "SPCC = 1").replace("METHOD = 1\n", "LOADS = 3\n")
        self.write("slip.bdf", deck)
        text = self.fails(1, "static", "slip.bdf", error="cli.no-static-load").stderr
        self.assertIn("did you mean SPC", text)
        self.assertIn("did you mean LOAD", text)

    def test_case_control_is_named_with_its_line(self):
        def said(deck, *call, code=1):
            self.write("d.bdf", deck)
            return self.bough(*call, code=code).stderr

        static = BEAM.replace("SOL 103", "SOL 101").replace("METHOD = 1", "LOAD = 3")
        self.assertRegex(said(static, "static", "d.bdf"), r"d.bdf:4: error: load set 3 .*\[fe.missing-load\]")
        self.assertRegex(said(BEAM.replace("SPC = 1", "SPC = 8"), "modes", "d.bdf", code=0),
                         r"d.bdf:3: warning: SPC set 8 .*\[fe.missing-set\]")
        self.assertRegex(said(BEAM.replace("METHOD = 1", "METHOD = 8"), "modes", "d.bdf", code=0),
                         r"d.bdf:4: warning: METHOD = 8 .*\[cli.no-method\]")
        self.assertRegex(said(BEAM.replace("SPC = 1", "MPC = 8"), "modes", "d.bdf", code=0),
                         r"d.bdf:3: warning: MPC set 8 .*\[fe.empty-mpc-set\]")

    def test_statsub_of_a_subcase_that_is_not_there(self):
        deck = BEAM.replace("SOL 103", "SOL 105").replace(
            "METHOD = 1", "SUBCASE 1\nLOAD = 3\nSUBCASE 2\nMETHOD = 1\nSTATSUB = 7")
        self.write("d.bdf", deck.replace("ENDDATA", "FORCE,3,3,,-1.,1.,0.,0.\nENDDATA"))
        text = self.fails(1, "modes", "d.bdf", "--buckling", error="cli.no-static-load").stderr
        self.assertRegex(text, r"d.bdf:8: error: STATSUB of subcase 2 names subcase 7, which the deck does not have")

    def test_a_refused_card_is_not_said_to_be_missing(self):
        self.write("d.bdf", BEAM.replace("MAT1,1,7.+10,", "MAT1,1,7.+1O,"))
        text = self.fails(1, "modes", "d.bdf", error="deck.bad-real").stderr
        self.assertNotIn("missing", text)
        self.write("d.bdf", BEAM.replace("PBAR,1,1,1.-4,1.-8,1.-8,1.-8", "PBARL,1,1,,BAR\n,.1,w"))
        self.assertNotIn("missing", self.fails(1, "modes", "d.bdf", error="deck.bad-real").stderr)
        self.write("d.bdf", BEAM.replace("GRID,2,,1.,0.", "GRID,2,,1.,o"))
        self.assertNotIn("missing", self.fails(1, "modes", "d.bdf", error="deck.bad-real").stderr)
        self.write("d.bdf", BEAM.replace("GRID,2,,1.", "CORD2R,4,,0.,0.,0.,0.,0.,l.\n,1.,0.,0.\nGRID,2,4,1."))
        self.assertNotIn("missing", self.fails(1, "modes", "d.bdf", error="deck.bad-real").stderr)

    def test_point_of_the_norm_is_looked_for(self):
        eigr = BEAM.replace("EIGRL,1,,,3", "EIGR,1,LAN,,,,3\n,POINT,{},{}")
        self.write("d.bdf", eigr.format(99, 2))
        self.assertRegex(self.fails(1, "modes", "d.bdf", error="fe.missing-grid").stderr, r"d.bdf:6: error: EIGR 1")
        self.write("d.bdf", eigr.format(3, ""))
        self.fails(1, "modes", "d.bdf", error="fe.bad-component")
        self.write("d.bdf", eigr.format(3, 2))
        self.bough("modes", "d.bdf")

    def test_a_mechanism_without_spc_says_so(self):
        deck = BEAM.replace("SOL 103", "SOL 101").replace("SPC = 1\nMETHOD = 1", "SUBCASE 4\nLOAD = 3")
        self.write("d.bdf", deck.replace("ENDDATA", "FORCE,3,3,,1.,0.,1.,0.\nENDDATA"))
        text = self.fails(1, "static", "d.bdf", error="fe.mechanism").stderr
        self.assertIn("subcase 4 selects no SPC set", text)


if __name__ == "__main__":
    unittest.main()
