"""Messages: their text, their number, and the results of the other subcases if one fails."""
import json
import os
import re
import unittest

import h5py

from support import BEAM, ProgramTest

TWO = """SOL 101
CEND
SUBCASE 1
 SPC=1
 LOAD=1
SUBCASE 7
 SPC=2
 LOAD=1
SUBCASE 9
 SPC=1
 LOAD=3
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
PBAR,1,1,1.,1.,1.,1.
MAT1,1,1.+7,,.3,1.
SPC1,1,123456,1
SPC1,2,12,1
FORCE,1,2,,1.,1.,1.,0.
FORCE,3,2,,2.,1.,1.,0.
ENDDATA
"""
SHARED = os.environ.get("BOUGH_SHARED_DIR", "")


def make_bad_bars(number):
    """Bars whose property is missing: one error each."""
    return BEAM.replace("METHOD = 1", "METHOD = 1\nLOAD = 1").replace("ENDDATA", "FORCE,1,3,,1.,0.,1.,0.\n" + "".join(f"CBAR,{10 + i},99,1,2,0.,1.,0.\n" for i in range(number)) + "ENDDATA")


class Many(ProgramTest):
    def test_ten_of_a_kind_and_a_count(self):
        self.write("bars.bdf", make_bad_bars(1234))
        for call in [["check"], ["modes"], ["reduce", "--modes", "2", "-o", "b.h5"], ["static"], ["matrices", "-o", "m.h5"]]:
            with self.subTest(call[0]):
                lines = self.bough(call[0], "bars.bdf", *call[1:], code=1).stderr.splitlines()
                of_kind = [line for line in lines if "[fe.missing-property]" in line]
                self.assertEqual(len(of_kind), 11)
                self.assertIn("CBAR 10 ", of_kind[0])
                self.assertIn("CBAR 19 ", of_kind[9])
                self.assertIn("bars.bdf: error: ... and 1,224 more of fe.missing-property; -v prints them all", of_kind[10])
        self.assertEqual(self.bough("modes", "bars.bdf", "-v", code=1).stderr.count("[fe.missing-property]"), 1234)
        report = json.loads(self.bough("check", "bars.bdf", "--json", code=1).stdout)
        self.assertEqual(report["errors"], 1234)
        self.assertEqual(len([m for m in report["messages"] if "fe.missing-property" in m]), 1234)

    def test_a_bad_mcid_is_said_once_with_its_field(self):
        grids = "".join(f"GRID,{i + 1},,{x},{y},0.\n" for i, (x, y) in enumerate(
            [(0., 0.), (2., 0.), (2., 2.), (0., 2.), (1., 0.), (2., 1.), (1., 2.), (0., 1.)]))
        self.write("q8.bdf", grids + "CQUAD8,1,1,1,2,3,4,5,6,+\n+,7,8,,,,,77\nPSHELL,1,1,.01,1,,1\nMAT1,1,7.+10,,.3\nENDDATA\n")
        text = self.bough("check", "q8.bdf", code=1).stderr
        self.assertEqual(text.count("[fe.missing-coordinates]"), 1)
        self.assertIn("q8.bdf:9: error: CQUAD8 1 has MCID 77, a coordinate system that the deck does not define", text)

    def test_few_are_all_printed(self):
        self.write("bars.bdf", make_bad_bars(10))
        text = self.bough("modes", "bars.bdf", code=1).stderr
        self.assertEqual(text.count("[fe.missing-property]"), 10)
        self.assertNotIn("more of", text)

    def test_autospc_prints_ten(self):
        loose = "".join(f"GRID,{50 + i},,{i}.,1.,0.\n" for i in range(4))
        self.write("loose.bdf", BEAM.replace("ENDDATA", loose + "ENDDATA"))
        text = self.bough("check", "loose.bdf").stdout
        table = text[text.index("AUTOSPC grid"):text.index("connected parts")]
        self.assertEqual(len(table.strip().splitlines()), 12)
        self.assertIn("... and 14 more", table.replace("dofs", "").replace("  ", " "))
        self.assertEqual(len(json.loads(self.bough("check", "loose.bdf", "--json").stdout)["autospc"]), 24)


class Unused(ProgramTest):
    def test_params_and_case_control(self):
        deck = BEAM.replace("SPC = 1\n", "SPC = 1\nAUTOSPC(NOPRINT) = YES\nMODTRAK = 4\nMPCC = 7\n").replace(
            "EIGRL", "PARAM,WTMAS,.00259\nPARAM,K6R0T,1.\nPARAM,RESVEC,NO\nPARAM,GRDPNT,0\nPARAM,OWNDMAPX,1\nPARAM,G,.01\nEIGRL")
        self.write("beam.bdf", deck)
        text = self.bough("modes", "beam.bdf").stderr
        self.assertRegex(text, r"beam.bdf:9: warning: PARAM,WTMAS is no .*did you mean WTMASS \[deck.unknown-param\]")
        self.assertRegex(text, r"beam.bdf:10: warning: PARAM,K6R0T is no .*did you mean K6ROT \[deck.unknown-param\]")
        self.assertRegex(text, r"beam.bdf:13: warning: PARAM,OWNDMAPX is no .*\[deck.unknown-param\]")
        self.assertRegex(text, r"beam.bdf:11: note: PARAM not used: RESVEC \(line 11\), GRDPNT \(line 12, .*\[deck.unused-params\]")
        self.assertRegex(text, r"beam.bdf:5: note: case control not used: MODTRAK \(line 5\); .*ignored\]")
        self.assertRegex(text, r"beam.bdf:6: warning: MPCC is no command .*did you mean MPC \[deck.unknown-case-control\]")

    def test_clean_deck_says_nothing(self):
        self.write("beam.bdf", BEAM)
        self.assertEqual(self.bough("modes", "beam.bdf", "--number", "2").stderr, "")

    def test_one_reader_of_numbers(self):
        shell = "CQUAD4,9,9,1,2,3,4\nPSHELL,9,1,.01,1,,1\nGRID,4,,1.,1.,0.\n"
        self.write("bad.bdf", BEAM.replace("ENDDATA", shell + "PARAM,K6ROT,many\nPARAM,SNORM,x\nENDDATA"))
        text = self.bough("modes", "bad.bdf", code=1).stderr
        self.assertIn('PARAM,K6ROT is "MANY", expected a number', text)
        self.assertIn('PARAM,SNORM is "X", expected a number', text)
        # 4.-2 is 0.04.
        beam = BEAM.replace("ENDDATA", "PARAM,G,{}\nENDDATA")
        found = []
        for i, value in enumerate(["4.-2", "0.04"]):
            self.write(f"g{i}.bdf", beam.format(value))
            self.write(f"g{i}.toml", f'[body]\nname = "g"\ndeck = "g{i}.bdf"\n\n[body.modes]\nnumber = 2\n\n'
                       "[body.damping]\nmaterial = true\n")
            self.bough("reduce", f"g{i}.toml", "-o", f"g{i}.h5")
            with h5py.File(self.path(f"g{i}.h5")) as f:
                found.append(f["/modal/damping"][:])
        self.assertTrue((found[0] == found[1]).all())
        self.assertGreater(found[0][0, 0], 0)


class Solutions(ProgramTest):
    def test_other_solutions_are_noted_once(self):
        for sol in ["106", "129", "144", "145", "200", "400", "13", "4", "NLSTATIC"]:
            self.write("beam.bdf", BEAM.replace("SOL 103", "SOL " + sol))
            for call in [["check", "beam.bdf"], ["modes", "beam.bdf"], ["reduce", "beam.bdf", "--modes", "2", "-o", "b.h5"]]:
                text = self.bough(*call).stderr
                self.assertEqual(text.count("[cli.other-solution]"), 1, sol)
                self.assertIn("this is the linear solution of the unchanged cards", text)
        for sol in ["101", "103", "105", "108", "111", "24", "SESTATIC"]:
            self.write("beam.bdf", BEAM.replace("SOL 103", "SOL " + sol))
            self.assertNotIn("other-solution", self.bough("check", "beam.bdf").stderr)

    def test_static_of_nonlinear_decks_asks(self):
        for sol, asks in [("106", True), ("4", True), ("129", True), ("400", True), ("600", True), ("144", False), ("200", False)]:
            self.write("two.bdf", TWO.replace("SOL 101", "SOL " + sol).replace("SPC=2", "SPC=1"))
            if asks:
                self.fails(1, "static", "two.bdf", says=["--linear", "SOL " + sol], error="cli.nonlinear-static")
            result = self.bough("static", "two.bdf", *(["--linear"] if asks else []))
            self.assertIn("[cli.other-solution]", result.stderr)
            self.assertIn("subcase 9", result.stdout)


class Subcases(ProgramTest):
    def test_one_bad_subcase_leaves_the_others(self):
        self.write("two.bdf", TWO)
        result = self.bough("static", "two.bdf", "-o", "s.h5", code=1)
        for subcase in (1, 9):
            self.assertIn(f"subcase {subcase}: LOAD", result.stdout)
        self.assertNotIn("subcase 7: LOAD", result.stdout)
        for line in result.stderr.splitlines():
            if "[fe.mechanism]" in line:
                self.assertIn("error: subcase 7: the stiffness matrix is singular", line)
        self.assertIn("[fe.mechanism]", result.stderr)
        with h5py.File(self.path("s.h5")) as f:
            self.assertEqual(sorted(f["/subcases"]), ["1", "9"])
        data = json.loads(self.bough("static", "two.bdf", "--json", code=1).stdout)
        self.assertEqual([s["id"] for s in data["subcases"]], [1, 9])
        self.assertEqual([s["id"] for s in data["failed"]], [7])

    def test_missing_load_of_one_and_faults_of_the_deck(self):
        self.write("two.bdf", TWO.replace("SPC=2\n LOAD=1", "SPC=1\n LOAD=44"))
        result = self.bough("static", "two.bdf", code=1)
        self.assertIn("subcase 9: LOAD", result.stdout)
        self.assertRegex(result.stderr, r"error: subcase 7: load set 44 .*\[fe.missing-load\]")
        # Errors of all subcases are reported once, without their names.
        self.write("bad.bdf", TWO.replace("SPC=2", "SPC=1").replace("PBAR,1,1", "PBAR,2,1"))
        text = self.bough("static", "bad.bdf", code=1).stderr
        self.assertEqual(text.count("[fe.missing-property]"), 1)
        self.assertNotIn("subcase 1", text)
        # All bad in one way: one line for each motion, with all names.
        self.write("loose.bdf", TWO.replace("SPC=1", "SPC=2"))
        text = self.fails(1, "static", "loose.bdf", error="fe.mechanism").stderr
        self.assertIn("subcases 1, 7, 9: the stiffness matrix is singular: mechanism 1", text)
        self.assertEqual(text.count("mechanism 1 of"), 1)

    def test_modes(self):
        deck = BEAM.replace("SPC = 1\nMETHOD = 1\n", "METHOD = 1\nSUBCASE 1\nSPC = 1\nSUBCASE 2\nSPC = 77\nSUBCASE 3\nSPC = 2\n")
        self.write("beam.bdf", deck.replace("ENDDATA", "SPC1,2,123456,3\nSPC1,77,123456,99\nENDDATA"))
        result = self.bough("modes", "beam.bdf", "-o", "m.h5", code=1)
        self.assertIn("subcase 1", result.stdout)
        self.assertIn("subcase 3", result.stdout)
        self.assertRegex(result.stderr, r"error: subcase 2: SPC set 77 names grid 99, which the deck does not define")
        self.assertTrue(os.path.exists(self.path("m.h5")) and os.path.exists(self.path("m-subcase-3.h5")))
        data = json.loads(self.bough("modes", "beam.bdf", "--json", code=1).stdout)
        self.assertEqual([s["id"] for s in data["failed"]], [2])
        self.assertEqual([s["subcase"] for s in data["subcases"]], [1, 3])

    def test_number_and_modes_are_one_option(self):
        self.write("beam.bdf", BEAM)
        for word in ["-n", "--number", "--modes"]:
            self.assertEqual(len(json.loads(self.bough("modes", "beam.bdf", word, "2", "--json").stdout)["frequency_hz"]), 2)
            self.bough("reduce", "beam.bdf", word, "2", "-o", "b.h5")
            with h5py.File(self.path("b.h5")) as f:
                self.assertEqual(len(f["/modes/frequency_hz"]), 2)


class Check(ProgramTest):
    def test_loads_of_the_subcases(self):
        deck = TWO.replace("SPC=2", "SPC=1").replace("ENDDATA", "SPC1,3,123456,1\nSPC1,3,1,2\nSPCD,1,2,1,.1\nTEMPD,5,10.\nENDDATA")
        deck = deck.replace("SUBCASE 7\n SPC=1", "SUBCASE 7\n SPC=3").replace("SUBCASE 9", "SUBCASE 9\n TEMP(LOAD)=5")
        deck = deck.replace(",.3,1.\n", ",.3,1.,1.-5\n")
        deck = deck.replace("SUBCASE 1\n SPC=1\n LOAD=1\n", "SUBCASE 1\n SPC=1\n LOAD=3\n")
        self.write("two.bdf", deck)
        data = json.loads(self.bough("check", "two.bdf", "--json").stdout)["subcases"]
        self.assertEqual([s["id"] for s in data], [1, 7, 9])
        self.assertEqual([s["num_enforced"] for s in data], [0, 1, 0])
        self.assertEqual([s["num_heated"] for s in data], [0, 0, 1])
        for got, force in zip(data, [2, 1, 2]):
            for value, want in zip(got["resultant"], [force, force, 0, 0, 0, force]):
                self.assertAlmostEqual(value, want)
        self.assertIn("loads of the subcases", self.bough("check", "two.bdf").stdout)

    def test_missing_and_empty_sets(self):
        deck = TWO.replace("SPC=2\n LOAD=1", "SPC=1\n LOAD=44\n TEMP(LOAD)=45").replace("FORCE,3,2,,2.", "FORCE,3,2,,0.")
        self.write("two.bdf", deck)
        result = self.bough("check", "two.bdf", code=1)
        self.assertRegex(result.stderr, r"error: subcase 7: load set 44 .*\[fe.missing-load\]")
        self.assertRegex(result.stderr, r"error: subcase 7: temperature set 45 .*\[fe.missing-load\]")
        self.assertRegex(result.stderr, r"warning: subcase 9: its loads and temperatures apply nothing.*\[cli.empty-load\]")
        self.assertIn("?", result.stdout)
        # Modes run without the loads.
        self.write("two.bdf", deck.replace("SOL 101", "SOL 103"))
        self.assertRegex(self.bough("check", "two.bdf").stderr, r"warning: subcase 7: load set 44")

    def test_weights(self):
        # A mass of 3 at (1, 2, 0) and one of 5 that moves along z only, about grid 2 at (1, 0, 0).
        deck = ("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,2.,0.\nCELAS2,9,1.,3,1\nCONM2,1,3,,3.\nCMASS2,2,5.,1,3\n"
                "PARAM,WTMASS,.1\nPARAM,GRDPNT,{}\nENDDATA\n")
        self.write("w.bdf", deck.format(2))
        w = json.loads(self.bough("check", "w.bdf", "--json").stdout)["weight"]
        self.assertEqual(w["grid"], 2)
        self.assertEqual([round(m, 9) for m in w["mass"]], [3, 3, 8])
        self.assertEqual(w["S"], [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
        cg = [[0, 2, 0], [0, 0, 0], [-5 / 8, 6 / 8, 0]]
        for row, want in zip(w["cg"], cg):
            for a, b in zip(row, want):
                self.assertAlmostEqual(a, b)
        # About the centres: z moves 3 at (0, 2) and 5 at (-1, 0).
        self.assertAlmostEqual(w["I_S"][0][0], 3 * 4 - 8 * .75 ** 2)
        self.assertAlmostEqual(w["I_S"][1][1], 5 - 8 * .625 ** 2)
        self.assertAlmostEqual(w["I_S"][0][1], 8 * .625 * .75)
        self.assertAlmostEqual(sum(w["I_Q"]), sum(w["I_S"][i][i] for i in range(3)))
        text = self.bough("check", "w.bdf", "--gpwg", "0").stdout
        for words in ["grid point weights about the origin", "MO", "X-C.G.", "I(S)", "I(Q)"]:
            self.assertIn(words, text)
        self.write("w.bdf", deck.format(77))
        self.assertIn("[cli.no-weight-grid]", self.bough("check", "w.bdf").stderr)
        self.write("w.bdf", deck.format(-1))
        self.assertNotIn("grid point weights", self.bough("check", "w.bdf").stdout)
        self.fails(1, "check", "w.bdf", "--gpwg", "99", error="fe.missing-grid")

    def test_weights_of_printed_decks(self):
        models = os.path.join(SHARED, "models")
        if not os.path.isdir(models):
            self.skipTest("no shared decks here: " + models)
        for deck, printed in [("truss72/modes.dat", "truss72/modes.f06"), ("svanberg_beam/modes.dat", "svanberg_beam/modes.f06"),
                              ("three_element_types/noReduction-000.dat", "three_element_types/noreduction-000.f06"),
                              ("beam_modes/beam_modes.dat", "beam_modes/beam_modes.f06")]:
            with self.subTest(deck):
                with open(os.path.join(models, printed), errors="replace") as f:
                    text = f.read()
                text = text[text.index("W E I G H T   G E N E R A T O R"):][:6000]
                rows = [[float(x) for x in re.findall(r"[-+]?\d\.\d+E[-+]\d+", line)] for line in text.splitlines()]
                rows = [row for row in rows if row][:6 + 3 + 3 + 3 + 3]
                w = json.loads(self.bough("check", os.path.join(models, deck), "--gpwg", "0", "--json").stdout)["weight"]
                got = w["MO"] + w["S"] + [[m] + c for m, c in zip(w["mass"], w["cg"])] + w["I_S"] + [[i] for i in w["I_Q"]]
                self.assertEqual(len(rows), len(got))
                for block in [(0, 6), (6, 9), (9, 12), (12, 15), (15, 18)]:
                    size = max(abs(x) for row in rows[slice(*block)] for x in row)
                    for a, b in zip(got[slice(*block)], rows[slice(*block)]):
                        for x, y in zip(a, b):
                            self.assertAlmostEqual(x / size, y / size, delta=2e-6)


if __name__ == "__main__":
    unittest.main()
