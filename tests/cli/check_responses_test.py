"""`check` of a deck for responses or complex modes names what the command of its solution refuses before it solves."""
import json
import re
import unittest

from support import PROGRAM, HANG, ProgramTest, served

CASE = """SOL {sol}
CEND
METHOD = 1
SPC = 1
SUBCASE 1
{case}
BEGIN BULK
"""
MODEL = """GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CBAR,1,1,1,2,0.,1.,0.
PBAR,1,1,1.,1.,1.,1.
MAT1,1,1.+3,,.3,1.
SPC1,1,123456,1
EIGRL,1,,,3
FREQ1,2,1.,1.,10
FREQ4,12,1.,100.,.1,3
RLOAD1,3,5,,,6
TLOAD1,13,5,,,6
DAREA,5,2,3,1.
TABLED1,6,,,,,,,,+
+,0.,1.,100.,1.,ENDT
TABDMP1,4,CRIT,,,,,,,+
+,0.,.01,100.,.01,ENDT
TSTEP,7,100,.01,1
EIGC,8,LAN,,,,,2
TABRND1,31,,,,,,,,+
+,0.,1.,100.,1.,ENDT
RANDPS,32,1,1,1.,0.,31
ENDDATA
"""
FREQUENCY = "FREQ = 2\nDLOAD = 3\nSDAMPING = 4\nDISP = ALL"
TRANSIENT = "TSTEP = 7\nDLOAD = 13\nSDAMPING = 4"


class CheckResponses(ProgramTest):
    def deck(self, sol, case, cards=()):
        model = MODEL.replace("ENDDATA", "\n".join([*cards, "ENDDATA"]))
        return self.write("deck.bdf", CASE.format(sol=sol, case=case) + model)

    def ask(self, *call):
        return served.run([PROGRAM, *call], cwd=self.folder, timeout=HANG)

    def test_what_the_solution_selects_is_read_and_counted(self):
        for sol, case, row in [
                (111, FREQUENCY, {"num_frequencies": 11, "range": [1.0, 11.0]}),
                (111, FREQUENCY.replace("FREQ = 2", "FREQ = 12"), {}),
                (108, FREQUENCY, {"num_frequencies": 11, "range": [1.0, 11.0]}),
                (112, TRANSIENT, {"num_times": 101, "range": [0.0, 1.0]}),
                ("SEDTRAN", TRANSIENT, {"num_times": 101, "range": [0.0, 1.0]})]:
            with self.subTest(sol=sol, case=case):
                found = self.bough("check", self.deck(sol, case), "--json")
                answer = json.loads(found.stdout)
                self.assertEqual(answer["responses"], [{"id": 1, "num_loads": 1, "num_motions": 0, **row}])
                selected = set(row) and {"FREQ1" if "num_frequencies" in row else "TSTEP", "DAREA", "TABDMP1"}
                self.assertFalse(set(selected) & set(answer["skipped"]))
                self.assertNotIn("deck.case-control-ignored", found.stderr)

    def test_a_deck_of_complex_modes_reads_its_method(self):
        found = self.bough("check", self.deck(110, "CMETHOD = 8\nSDAMPING = 4"), "--json")
        self.assertFalse({"EIGC", "TABDMP1"} & set(json.loads(found.stdout)["skipped"]))

    def test_other_decks_have_no_responses(self):
        found = self.bough("check", self.deck(103, FREQUENCY), "--json")
        self.assertNotIn("responses", json.loads(found.stdout))

    def test_a_deck_without_loads_is_one_for_its_modes(self):
        found = self.bough("check", self.deck(111, FREQUENCY.replace("DLOAD = 3\n", "")))
        self.assertRegex(found.stderr, r"warning: .*\[modal.no-dynamic-load\]")

    def test_what_the_command_refuses(self):
        for sol, verb, case, error in [
                (111, "frequency", FREQUENCY.replace("FREQ = 2", "FREQ = 99"), "modal.no-frequencies"),
                (111, "frequency", FREQUENCY.replace("FREQ = 2\n", ""), "modal.no-frequencies"),
                (111, "frequency", FREQUENCY.replace("DLOAD = 3", "DLOAD = 99"), "modal.no-dynamic-load"),
                (111, "frequency", FREQUENCY.replace("SDAMPING = 4", "SDAMPING = 99"), "modal.missing-table"),
                (111, "frequency", FREQUENCY + "\nRANDOM = 99", "modal.missing-random"),
                (112, "transient", TRANSIENT.replace("TSTEP = 7", "TSTEP = 99"), "modal.no-time-steps"),
                (112, "transient", TRANSIENT.replace("DLOAD = 13", "DLOAD = 3"), "modal.wrong-load"),
                (110, "modes", "CMETHOD = 99", "modal.missing-complex-method"),
                (107, "modes", "", "modal.no-complex-method")]:
            with self.subTest(sol=sol, case=case):
                file = self.deck(sol, case)
                ids = [re.findall(r"error: .*\[([a-z]+\.[a-z0-9-]+)\]", run.stderr)
                       for run in (self.ask(verb, file, "-o", "out.h5"), self.ask("check", file))]
                self.assertIn(error, ids[0])
                self.assertEqual(ids[0], ids[1])
                self.bough("check", file, code=1)

    def test_rotors_and_direct_input(self):
        """Direct input, transfer functions and rotors that the deck does not have are the errors of the solution."""
        line, spin, speed = "ROTORG,7,1,2", "RSPINR,7,1,2,RPM,1.", "RGYRO,9,ASYNC,7,RPM,,,8"
        rotors = [([], "modal.missing-rotor"), ([speed, "RSPEED,8,0.,10.,2"], "modal.missing-rotor"),
                  (["ROTORG,7,1,2,55", spin, speed, "RSPEED,8,0.,10.,2"], "modal.rotor-line"),
                  ([line, spin, speed], "modal.missing-rotor"),
                  (["ROTORG,7,2,3", "GRID,3,,2.,0.,0.", "RSPINR,7,2,3,RPM,1.", "CBAR,2,1,2,3,0.,1.,0.", "RGYRO,9,ASYNC,7,RPM,,,50.",
                    "PLOTEL,9,1,2"], "modal.rotor-element")]
        cases = [(107, "CMETHOD = 8\nK2PP = NIX", [], "fe.missing-direct"), (107, "CMETHOD = 8\nTFL = 9", [], "modal.missing-transfer"),
                 (110, "CMETHOD = 8\nSDAMPING = 99", [], "modal.missing-table"),
                 *[(107, "CMETHOD = 8\nRGYRO = 9", *rotor) for rotor in rotors],
                 *[(sol, FREQUENCY.replace("SDAMPING = 4\n", "") + "\nRGYRO = 9", *rotor) for rotor in rotors for sol in (108, 111)],
                 (112, TRANSIENT + "\nRGYRO = 9", [line, spin, "RGYRO,9,ASYNC,7,RPM,,,50."], "modal.rotor-unsupported")]
        for sol, case, cards, error in cases:
            with self.subTest(sol=sol, case=case, cards=cards):
                verb = {107: "modes", 110: "modes", 112: "transient"}.get(sol, "frequency")
                file = self.deck(sol, case, cards)
                ids = [re.findall(r"error: .*\[([a-z]+\.[a-z0-9-]+)\]", run.stderr)
                       for run in (self.ask(verb, file, "-o", "out.h5"), self.ask("check", file))]
                self.assertIn(error, ids[0])
                self.assertEqual(ids[0], ids[1])
                self.bough("check", file, code=1)


if __name__ == "__main__":
    unittest.main()
