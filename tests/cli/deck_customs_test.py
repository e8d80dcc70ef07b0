"""Decks as analysts write them for Nastran: nothing that changes the answer passes without a message."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest

# A cantilever along x of 8 bars; grid 5 is where parts meet.
BARS = "PBAR,1,1,1.-3,1.-6,2.-6,3.-6\nMAT1,1,7.+10,,.3,2700.\n"


def grids(ids):
    return "".join(f"GRID,{k},,{k * .5},0.,0.\n" for k in ids)


def bars(first, last):
    return "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(first, last))


def rod(case="", bulk="", sol="103"):
    """A rod of stiffness 1e4 along x with a mass of 100 at its end: 10 rad/s."""
    return (f"SOL {sol}\nCEND\nSPC = 1\nMETHOD = 1\n{case}BEGIN BULK\nEIGRL,1,,,1\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n"
            f"CONROD,1,1,2,1,1.\nMAT1,1,1.+4,,.3\nCONM2,9,2,,100.\nSPC1,1,123456,1\nSPC1,1,23456,2\n{bulk}ENDDATA\n")


class Decks(ProgramTest):
    def list_hz(self, deck, *options):
        self.write("m.bdf", deck)
        result = self.bough("modes", "m.bdf", "--json", *options)
        return np.array([mode["frequency_hz"] for mode in json.loads(result.stdout)["modes"]]), result.stderr


class ComponentPoints(Decks):
    def make_parts(self, points=True, number=6, cases="", above="METHOD = 1\n"):
        """Grids 1 to 5 in the main bulk data, 5 to 9 in part 1 with `number` component modes."""
        ids = range(101, 101 + number)
        listed = ",".join(map(str, ids))
        joined = "SPOINT," + listed + "\nSECONCT,1,0,,NO\n,5,5," + ",".join(f"{k},{k}" for k in ids[:2]) + "\n"
        if number > 2:
            joined += "," + ",".join(f"{k},{k}" for k in ids[2:6]) + "\n"
        return (f"SOL 103\nCEND\nSPC = 1\n{above}{cases}BEGIN BULK\nEIGRL,1,,,5\nSPC1,1,123456,1\n{BARS}{grids(range(1, 6))}"
                f"{bars(1, 5)}SEBULK,1,PRIMARY,,MANUAL\n{joined if points else 'SECONCT,1,0,,NO' + chr(10) + ',5,5' + chr(10)}"
                f"BEGIN SUPER=1\n{BARS}{grids(range(5, 10))}{bars(5, 9)}SPOINT,{listed}\nQSET1,0,{listed}\nEIGRL,10,,,{number}\n"
                "ENDDATA\n")

    CASES = "SUBCASE 1\nSUPER = 1\nMETHOD = 10\nSUBCASE 2\nMETHOD = 1\n"

    def test_q_set_points_join_scalar_points_of_the_residual(self):
        whole, _ = self.list_hz(f"SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,5\nSPC1,1,123456,1\n{BARS}"
                                f"{grids(range(1, 10))}{bars(1, 9)}ENDDATA\n")
        joined, messages = self.list_hz(self.make_parts(cases=self.CASES))
        made, _ = self.list_hz(self.make_parts(points=False, cases=self.CASES))
        np.testing.assert_allclose(joined, made, rtol=1e-10)
        np.testing.assert_allclose(joined, whole, rtol=2e-3)
        self.assertTrue((joined > whole * (1 - 1e-9)).all())  # Ritz
        self.assertIn("6 boundary degrees of freedom and 6 component modes", messages)

    def test_fewer_modes_than_points_leave_points_without_stiffness(self):
        deck = self.make_parts(cases=self.CASES).replace("EIGRL,10,,,6", "EIGRL,10,,,4")
        four, _ = self.list_hz(deck)
        made, _ = self.list_hz(self.make_parts(points=False, cases=self.CASES).replace("EIGRL,10,,,6", "EIGRL,10,,,4"))
        np.testing.assert_allclose(four, made, rtol=1e-10)

    def test_method_of_the_subcase_of_the_part_counts(self):
        """METHOD = 10 of SUPER = 1 is of the part; a SET of SUPER names it too."""
        plain, _ = self.list_hz(self.make_parts(cases=self.CASES))
        by_set, _ = self.list_hz(self.make_parts(cases="SET 7 = 1\nSUBCASE 1\nSUPER = 7\nMETHOD = 10\nSUBCASE 2\nSET 8 = 0\n"
                                                       "SUPER = 8\nMETHOD = 1\n"))
        np.testing.assert_allclose(by_set, plain, rtol=1e-12)
        self.write("m.bdf", self.make_parts(above="METHOD = 1\n"))
        self.fails(1, "modes", "m.bdf", error="fe.part-modes", says=["a subcase of SUPER = 1"])

    def test_loads_of_a_subcase_of_the_part_alone_are_reported(self):
        deck = self.make_parts(cases="SUBCASE 1\nSUPER = 1\nMETHOD = 10\nLOAD = 4\nSUBCASE 2\nMETHOD = 1\n")
        _, messages = self.list_hz(deck)
        self.assertRegex(messages, r"m.bdf:6: warning: LOAD = 4 of subcase 1 .*\[deck.superelement-case\]")

    def test_a_missing_point_is_an_error(self):
        self.write("m.bdf", self.make_parts(cases=self.CASES).replace(",5,5,101,101", ",5,5,77,101"))
        self.fails(1, "modes", "m.bdf", error="fe.part-boundary", says=["point 77, which superelement 1 does not have"])

    def test_scalar_points_with_stiffness_are_a_boundary(self):
        """A spring and a mass in series with a beam, cut at a scalar point: the answer of the whole, exactly."""
        head = "SOL 101\nCEND\nSPC = 1\nLOAD = 3\nSUBCASE 1\nBEGIN BULK\nSPC1,1,123456,1\n"
        tail = "CELAS2,52,3.+4,60,0\nSLOAD,3,60,5.\nFORCE,3,9,,1.,0.,1.,0.\n"
        part = "CELAS2,51,2.+4,7,2,50,0\n"
        self.write("w.bdf", f"{head}{BARS}{grids(range(1, 10))}{bars(1, 9)}SPOINT,60\n{part.replace('50', '60')}{tail}ENDDATA\n")
        self.write("p.bdf", f"{head}{BARS}{grids([1, 2, 3, 4, 5, 9])}{bars(1, 5)}SPOINT,60\n{tail}SEBULK,1,PRIMARY,,MANUAL\n"
                            f"SECONCT,1,0,,NO\n,5,5,9,9,50,60\nBEGIN SUPER=1\n{BARS}{grids(range(5, 10))}{bars(5, 9)}SPOINT,50\n"
                            f"{part}ENDDATA\n")
        found = []
        for name in ("w", "p"):
            self.bough("static", name + ".bdf", "-o", name + ".h5")
            with h5py.File(self.path(name + ".h5")) as f:
                rows = zip(map(tuple, f["dof_map"][:]), f["subcases/1/displacement"][:])
                found.append({dof: u for dof, u in rows if dof[0] in (5, 9, 60)})
        self.assertEqual(sorted(found[0]), sorted(found[1]))
        scale = max(map(abs, found[0].values()))
        for dof, u in found[0].items():
            self.assertAlmostEqual(u, found[1][dof], delta=1e-9 * scale, msg=dof)


class CaseControl(Decks):
    def test_param_takes_blanks_tabs_and_equals_signs(self):
        for text in ("PARAM,WTMASS,.25", "PARAM WTMASS .25", "PARAM\tWTMASS\t.25", "PARAM, WTMASS .25", "PARAM WTMASS = .25"):
            hz, _ = self.list_hz(rod(text + "\n"))
            np.testing.assert_allclose(hz * 2 * np.pi, [20.], rtol=1e-9, err_msg=text)

    def test_param_without_a_value_is_an_error(self):
        self.write("m.bdf", rod("PARAM WTMASS\n"))
        self.fails(1, "modes", "m.bdf", error="deck.case-control-value", says=["m.bdf:5:", "write PARAM, NAME, VALUE"])

    def test_param_that_differs_between_subcases_is_reported(self):
        self.write("m.bdf", rod("SUBCASE 1\nPARAM,WTMASS,.25\nSUBCASE 2\nPARAM,WTMASS,1.\n"))
        messages = self.bough("modes", "m.bdf").stderr
        self.assertRegex(messages, r"m.bdf:8: warning: PARAM,WTMASS is 1. in subcase 2 and .25 in one before.*deck.subcase-param")

    def test_commands_between_skipon_and_skipoff_do_not_count(self):
        hz, _ = self.list_hz(rod("SKIPON\nPARAM,WTMASS,.25\nSKIPOFF\n"))
        np.testing.assert_allclose(hz * 2 * np.pi, [10.], rtol=1e-9)

    def test_selections_among_plots_are_errors(self):
        self.write("m.bdf", rod("OUTPUT(PLOT)\nLOAD = 4\n"))
        self.fails(1, "modes", "m.bdf", error="deck.case-control-value", says=["LOAD is in the section of plots"])

    def test_a_line_without_a_command_is_reported(self):
        self.write("m.bdf", rod("= 4\n"))
        self.assertRegex(self.bough("modes", "m.bdf").stderr, r"m.bdf:5: warning: '= 4' .*deck.unknown-case-control")

    def test_heat_is_named(self):
        self.write("m.bdf", rod("SUBCASE 1\nANALYSIS = HEAT\n"))
        self.fails(1, "modes", "m.bdf", error="deck.unsupported-command", says=["heat transfer"])
        self.write("m.bdf", rod(bulk="PARAM,HEATSTAT,YES\n", sol="101"))
        self.fails(1, "static", "m.bdf", error="deck.unsupported-param", says=["heat transfer"])

    def test_modeselect_of_complex_modes_is_an_error(self):
        deck = rod("CMETHOD = 2\nMODESELECT(LMODENM = 4) = 4\n", "EIGC,2,CLAN,,,,,1\n", sol="110")
        self.write("m.bdf", deck)
        self.fails(1, "modes", "m.bdf", error="deck.unsupported-command", says=["MODESELECT", "--ignore MODESELECT"])
        self.bough("modes", "m.bdf", "--ignore", "MODESELECT")

    def test_dmap_and_restarts_are_reported(self):
        self.write("m.bdf", rod().replace("CEND", "COMPILE SEMODES\nALTER 'READ'\nENDALTER\nCEND"))
        messages = self.bough("modes", "m.bdf").stderr
        self.assertRegex(messages, r"m.bdf:2: warning: COMPILE .*DMAP.*\[deck.unused-executive\]")
        self.assertEqual(messages.count("deck.unused-executive"), 1)


class NonlinearTransient(Decks):
    STEP = "TLOAD2,6,7,,,0.,100.,0.,90.\nSPC1,1,23456,2\nDAREA,7,2,1,50.\nFORCE,7,2,,1.,0.,0.,0.\n"

    def make_deck(self, sol=129, card="TSTEPNL,5,400,.0025,4", bulk="", case=""):
        command = "TSTEPNL" if card.startswith("TSTEPNL") else "TSTEP"
        load = "TLOAD2,6,7,,,0.,100.,0.,0.\nDAREA,7,2,1,5000.\n"
        return rod(f"DISP = ALL\nDLOAD = 6\n{command} = 5\n{case}", load + card + "\n" + bulk, sol=str(sol))

    def solve(self, deck, *options):
        self.write("t.bdf", deck)
        messages = self.bough("transient", "t.bdf", "--csv", "t.csv", *options).stderr
        rows = [line.split(",") for line in self.read("t.csv").strip().splitlines()]
        column = rows[0].index("displacement:2:1")
        return np.array([[float(row[0]), float(row[column])] for row in rows[1:]]), messages

    def test_sol_129_is_the_direct_transient_whatever_the_modes(self):
        """A step of 5000 on K = 1e4, 10 rad/s: 0.5 (1 - cos 10 t), of all modes and not of one."""
        for sol in ("129", "99", "NLTRAN"):
            found, messages = self.solve(self.make_deck(sol))
            np.testing.assert_allclose(found[:, 0], np.arange(0, 1.0001, .01), atol=1e-12)
            np.testing.assert_allclose(found[:, 1], .5 * (1 - np.cos(10 * found[:, 0])), atol=3e-3)
            self.assertIn("cli.other-solution", messages)
            self.assertNotIn("cli.by-modes", messages)
        direct, _ = self.solve(self.make_deck(109, "TSTEP,5,400,.0025,4"))
        np.testing.assert_allclose(found, direct, rtol=1e-12, atol=1e-14)

    def test_check_reads_what_transient_reads(self):
        self.write("t.bdf", self.make_deck())
        result = self.bough("check", "t.bdf")
        self.assertNotIn("TSTEPNL", result.stderr)
        self.assertRegex(result.stdout, r"responses over time\n.*\n.*401")
        self.write("t.bdf", self.make_deck().replace("TSTEPNL = 5", "TSTEPNL = 8"))
        for command in ("check", "transient"):
            self.fails(1, command, "t.bdf", error="modal.no-time-steps", says=["TSTEPNL = 8 names no TSTEPNL card"])

    def test_nonlinear_cards_are_errors_unless_linear(self):
        for bulk, name in (("MATS1,1,,PLASTIC,0.,1,1,1.+2\n", "MATS1"), ("PARAM,LGDISP,1\n", "PARAM,LGDISP")):
            self.write("t.bdf", self.make_deck(bulk=bulk))
            for command in ("check", "transient"):
                self.fails(1, command, "t.bdf", error="cli.nonlinear-transient", says=[name, "--linear"])
            linear, _ = self.solve(self.make_deck(bulk=bulk), "--linear")
            plain, _ = self.solve(self.make_deck())
            np.testing.assert_allclose(linear, plain, rtol=1e-12, atol=1e-14)

    def test_subcases_that_continue_one_another_are_an_error(self):
        self.write("t.bdf", self.make_deck(case="SUBCASE 1\nSUBCASE 2\n"))
        self.fails(1, "transient", "t.bdf", error="cli.nonlinear-transient", says=["2 subcases", "--subcase n"])
        self.bough("transient", "t.bdf", "--subcase", "2")

    def test_steps_of_both_cards_have_separate_ids(self):
        both = "TSTEP,5,100,.01,1\n"
        found, _ = self.solve(self.make_deck(bulk=both))
        alone, _ = self.solve(self.make_deck())
        np.testing.assert_array_equal(found, alone)


class Equations(Decks):
    def make_deck(self, relation, more=""):
        """The area of a rod of K = 1e4 A is 1 on its card."""
        return rod("DESOBJ = 1\nANALYSIS = MODES\n", f"{relation}{more}DESVAR,1,A,2.\nDESVAR,2,B,3.\nDTABLE,C,4.,D,5.\n", "200") \
            .replace("CONROD,1,1,2,1,1.", "CROD,1,1,1,2\nPROD,1,1,1.")

    AREA = "DVPREL2,1,PROD,1,A,,,7\n,DESVAR,1,2\n,DTABLE,C\n"

    def find_area(self, deck):
        hz, messages = self.list_hz(deck)
        self.assertNotIn("DEQATN", messages)
        return (2 * np.pi * hz[0]) ** 2 / 100

    def test_values_of_equations(self):
        """Fixed and free fields, assignments one after the other, arithmetic of FORTRAN."""
        for text, expected in [
                ("DEQATN  7       F(A,B,C) = A + B*C\n", 14.),
                ("DEQATN  7       F(A,B,C) = (A +\n        B) * C ;\n        G = F - 2.*A ; H = G/2.\n", 8.),
                ("DEQATN         7QUAD(a,b,c)=a*b**2+c\n", 22.),
                ("DEQATN,7,F(A,B,C)=MAX(A,B,C)**2-SQRT(C)\n", 14.),
                ("DEQATN  7       F(A,B,C)=A**B**2/C\n", 128.),
                ("DEQATN  7       F(A,B,C)=-A**2+PI(1)*0.+MIN(A,B)*C+1/2\n", 4.),
                ("DEQATN  7       F(A,B,C)=A*1.5D0+B*.2E+1+ABS(-1.)\n", 10.),
                ("DEQATN  7       F(A,B,C)=SSQ(A,B)+AVG(A,C)+SUM(A,B,C)\n", 25.)]:
            self.assertAlmostEqual(self.find_area(self.make_deck(self.AREA, text)), expected, delta=1e-7, msg=text)

    def test_materials_take_equations_too(self):
        deck = self.make_deck("DVMREL2,1,MAT1,1,E,,,7\n,DESVAR,2\n", "DEQATN  7       F(B)=1.+4*B\n")
        self.assertRegex(self.list_hz(deck)[1], "deck.design-values")

    def test_end_b_of_a_beam_takes_values(self):
        """A cantilever whose I1 is 2 at its root and 4 at its tip, by equations, is that of its card."""
        def make(a, b, more=""):
            return ("SOL 200\nCEND\nSPC = 1\nMETHOD = 1\nANALYSIS = MODES\nBEGIN BULK\nEIGRL,1,,,2\nSPC1,1,123456,1\n"
                    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nCBEAM,1,1,1,2,0.,1.,0.\nCBEAM,2,1,2,3,0.,1.,0.\n"
                    f"MAT1,1,7.+4,,.3,1.\nPBEAM,1,1,1.,{a},3.,,5.,\n,1.,1.\n,YES,.5,1.,3.,3.,,5.,\n,1.,1.\n,NO,1.,1.,{b},3.,,5.\n"
                    f"{more}ENDDATA\n")
        relations = ("DESVAR,1,X,2.\nDEQATN  7       F(X)=X\nDEQATN  8       F(X)=X**2\nDVPREL2,1,PBEAM,1,I1(A),,,7\n,DESVAR,1\n"
                     "DVPREL2,2,PBEAM,1,I1(B),,,8\n,DESVAR,1\n")
        by_card, _ = self.list_hz(make("2.", "4."))
        by_equations, messages = self.list_hz(make("9.", "9.", relations))
        np.testing.assert_allclose(by_equations, by_card, rtol=1e-12)
        self.assertNotIn("warning", messages)

    def test_what_has_no_value_is_an_error(self):
        for text, words in [("", "the deck has no DEQATN 7"), ("DEQATN  7       F(A,B)=A+B\n", "it has 2 arguments"),
                            ("DEQATN  7       F(A,B,C)=A+Q\n", "Q is neither"), ("DEQATN  7       F(A,B,C)=A/(C-4.)\n", "by zero"),
                            ("DEQATN  7       F(A,B,C)=A+(B\n", "not closed"), ("DEQATN  7       F(A,B,C)=FOO(A)\n", "FOO"),
                            ("DEQATN  7       F(A,B,C)=SQRT(-A)\n", "no finite number")]:
            self.write("m.bdf", self.make_deck(self.AREA, text))
            self.fails(1, "modes", "m.bdf", error="deck.design-equation", says=[words, "--ignore DVPREL2"])
            self.bough("modes", "m.bdf", "--ignore", "DVPREL2")


class OtherCards(Decks):
    def test_buckling_has_a_listing(self):
        """Euler's column, pinned: the factors of the table, shapes, and forces of the shapes."""
        column = "".join(f"GRID,{k},,{k - 1.},0.,0.\n" for k in range(1, 6)) + \
            "".join(f"CBAR,{k},1,{k},{k + 1},0.,1.,0.\n" for k in range(1, 5))
        self.write("b.bdf", "SOL 105\nCEND\nSPC = 1\nDISP = ALL\nFORCE = ALL\nSUBCASE 1\nLOAD = 3\nSUBCASE 2\nLABEL = COLUMN\n"
                            f"METHOD = 1\nBEGIN BULK\nEIGRL,1,,,2\n{BARS}{column}SPC1,1,1234,1\nSPC1,1,23,5\nFORCE,3,5,,1.,-1.,0.,0.\n"
                            "ENDDATA\n")
        result = json.loads(self.bough("modes", "b.bdf", "--buckling", "--f06", "b.f06", "--json").stdout)
        factors = [mode["load_factor"] for mode in result["modes"]]
        self.assertAlmostEqual(factors[0], np.pi ** 2 * 7e10 * 1e-6 / 16, delta=2e-3 * factors[0])
        text = self.read("b.f06")
        self.assertIn("R E A L   E I G E N V A L U E S", text)
        self.assertIn("COLUMN", text)
        listed = [line.split() for line in text.splitlines() if line.split()[:2] in (["1", "1"], ["2", "2"])]
        np.testing.assert_allclose([float(row[2]) for row in listed[:2]], factors, rtol=1e-5)
        np.testing.assert_allclose([float(row[6]) / float(row[5]) for row in listed[:2]], factors, rtol=1e-5)
        self.assertEqual(text.count("R E A L   E I G E N V E C T O R"), 2)
        self.assertIn("F O R C E S   I N   B A R   E L E M E N T S", text)

    def test_blank_values_of_constraints_are_converted(self):
        deck = rod().replace("SPC1,1,123456,1\n", "SPC,1,1,123456\nSPC,1,2,3456,,2,2,0.\n").replace("SPC1,1,23456,2\n", "")
        self.write("m.bdf", deck)
        self.bough("convert", "m.bdf", "-o", "m2.bdf", "--units", "m-kg-s:mm-N-tonne")
        hz, _ = self.list_hz(deck)
        result = json.loads(self.bough("modes", "m2.bdf", "--json").stdout)
        self.assertAlmostEqual(result["modes"][0]["frequency_hz"], hz[0], delta=1e-9)

    def test_pload1_on_a_bend_is_named(self):
        self.write("m.bdf", "SOL 101\nCEND\nSPC = 1\nLOAD = 3\nBEGIN BULK\nGRID,1,,1.,0.,0.\nGRID,2,,0.,1.,0.\nSPC1,1,123456,1\n"
                            "CBEND,5,1,1,2,-1.,0.,0.,1\nPBEND,1,1,1.-3,1.-6,1.-6,2.-6,1.\nMAT1,1,7.+10,,.3\n"
                            "PLOAD1,3,5,FZ,FR,0.,1.,1.,1.\nENDDATA\n")
        self.fails(1, "static", "m.bdf", error="fe.missing-element", says=["element 5, a CBEND: PLOAD1 is supported on CBAR"])

    def test_damping_of_shells_without_shells_changes_nothing(self):
        deck = NonlinearTransient.make_deck(self, 109, "TSTEP,5,40,.025,4", "PARAM,SHLDAMP,DIFF\n")
        self.write("t.bdf", deck)
        self.bough("transient", "t.bdf")

    def test_names_of_msgmesh_are_known(self):
        self.write("m.bdf", rod(bulk="PLOTE\nEGRID,1,,0.,0.,0.\n"))
        messages = self.bough("modes", "m.bdf").stderr
        self.assertNotIn("did you mean", messages)
        self.assertRegex(messages, "EGRID is not read .*MSGMESH is not executed")

    def test_requests_without_a_table_are_noted(self):
        self.write("m.bdf", rod("DISP(PUNCH) = ALL\nSPCF(PUNCH,PRINT) = ALL\nSTRAIN = ALL\nSTRESS = ALL\n",
                                "PBUSH,8,K,1.,1.,1.\nCBUSH,8,8,2,,,,,0\nFORCE,3,2,,1.,1.,0.,0.\n", sol="101").replace("METHOD = 1", "LOAD = 3"))
        for command in ("static", "modes"):
            for options in ((), ("--f06", "m.f06")):
                messages = self.bough(command, "m.bdf", *options, *(("-n", "1") if command == "modes" else ())).stderr
                self.assertRegex(messages, r"DISPLACEMENT\(PUNCH\), SPCFORCES\(PUNCH\), .*\[cli.request-by-option\]")
                self.assertEqual(messages.count("(PUNCH)"), 2)
            self.assertNotIn("[cli.unlisted-elements]", messages)  # strains, and stresses of CBUSH, are listed


if __name__ == "__main__":
    unittest.main()
