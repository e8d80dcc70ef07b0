"""Errors and warnings of `frequency` and `transient`: each with its id, its line, its words."""
import unittest

from deck_response_case import CHAIN, ONE
from support import ProgramTest


class Refusals(ProgramTest):
    def refuse(self, error, deck, verb="frequency", says=(), code=1):
        self.write("d.bdf", deck)
        self.fails(code, verb, "d.bdf", error=error, says=says)

    def deck(self, bulk, case="DLOAD = 9\nFREQUENCY = 5", sol=111):
        return ONE.format(sol=sol, case=case, bulk=bulk)

    def test_what_is_missing(self):
        good = "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,1.\n"
        self.refuse("modal.no-dynamic-load", self.deck(good, "FREQUENCY = 5"))
        self.refuse("modal.no-dynamic-load", self.deck(good, "DLOAD = 8\nFREQUENCY = 5"), says=["d.bdf:5"])
        self.refuse("modal.no-frequencies", self.deck(good, "DLOAD = 9"))
        self.refuse("modal.no-frequencies", self.deck(good, "DLOAD = 9\nFREQUENCY = 6"))
        self.refuse("modal.no-frequencies", self.deck(good.replace("FREQ,5,1.", "FREQ4,5,7.,8."), "DLOAD = 9\nFREQUENCY = 5"))
        self.refuse("modal.missing-load", self.deck(good.replace("DAREA,10", "DAREA,11")), says=["EXCITEID 10"])
        self.refuse("modal.missing-load", self.deck(good.replace("DAREA,10,1,1,2.", "SPCD,10,2,1,1.")), says=["TYPE DISP"])
        self.refuse("modal.missing-load", self.deck(good + "DLOAD,19,1.,1.,77", "DLOAD = 19\nFREQUENCY = 5"))
        self.refuse("modal.missing-load", self.deck(good.replace("10,,,1.", "10,77,,1.")), says=["DELAY 77"])
        self.refuse("modal.missing-table", self.deck(good.replace("1.\nDAREA", "3\nDAREA")), says=["table 3"])
        self.refuse("modal.missing-table", self.deck(good, "DLOAD = 9\nFREQUENCY = 5\nSDAMPING = 4"))
        self.refuse("modal.wrong-load", self.deck(good.replace("RLOAD1,9,10,,,1.", "TLOAD2,9,10,,,0.,1.")))
        self.refuse("modal.unsupported-load", self.deck(good + "LSEQ,40,10,,3", "DLOAD = 9\nFREQUENCY = 5\nLOADSET = 40"))
        self.refuse("fe.spcd-not-fixed", self.deck("RLOAD1,9,10,,,1.,,ACCE\nSPCD,10,1,1,2.\nFREQ,5,1."))
        self.refuse("fe.missing-grid", self.deck(good.replace("DAREA,10,1,", "DAREA,10,5,")))
        self.refuse("fe.bad-component", self.deck(good.replace("10,1,1,2.", "10,1,,2.")))
        time = "TLOAD2,9,10,,,0.,1.\nDAREA,10,1,1,2.\n"
        self.refuse("modal.no-time-steps", self.deck(time, "DLOAD = 9"), "transient")
        self.refuse("modal.no-time-steps", self.deck(time, "DLOAD = 9\nTSTEP = 3"), "transient")
        self.refuse("modal.missing-initial", self.deck(time + "TSTEP,3,5,.1", "DLOAD = 9\nTSTEP = 3\nIC = 4"), "transient")
        self.refuse("modal.initial-held", self.deck(time + "TSTEP,3,5,.1\nTIC,4,2,1,1.", "DLOAD = 9\nTSTEP = 3\nIC = 4"), "transient")

    def test_fields(self):
        good = "RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,1.\n"
        for card, says in [("TABLED1,3\n,0.,1.,2.,1.", "ENDT"), ("TABLED1,3\n,0.,1.,2.,1.,1.,1.,ENDT", "one direction"),
                           ("TABLED1,3\n,0.,1.,1.,1.,1.,0.,ENDT", "jumps at its first or last"),
                           ("TABLED2,3,1.\n,0.,0.,0.,1.,1.,1.,ENDT", "jumps at its first or last"),
                           ("TABLED1,3\n,0.,1.,ENDT", "expected two"), ("TABLED2,3,1.\n,0.,1.,ENDT", "expected two"),
                           ("TABLED1,3,LOG\n,0.,1.,2.,1.,ENDT", "LOG axis"), ("TABLED3,3,0.,0.\n,0.,1.,2.,1.,ENDT", "X2"),
                           ("TLOAD2,3,10,,,1.,1.", "T2"), ("RLOAD1,3,10", "TC and TD"), ("RLOAD2,3,10", "TB"),
                           ("FREQ1,5,1.", "DF"), ("FREQ2,5,0.,1.", "F1"), ("FREQ3,5,1.,2.,,1", "NEF"), ("FREQ4,5,1.,2.,2.", "FSPD"),
                           ("RLOAD1,3,10,,,1.,,FORCE", "TYPE"), ("DLOAD,3,1.", "S1")]:
            self.write("d.bdf", self.deck(good + card))
            self.fails(1, "frequency", "d.bdf", says=[says, "d.bdf:2"])
        # Sets that no subcase selects are warned of; selected ones are errors.
        time = "TLOAD2,9,10,,,0.,1.\nDAREA,10,1,1,2.\n"
        for verb, card, case, says in [
                ("frequency", good + "TABDMP1,3,Q\n,0.,1.,2.,0.,ENDT", "DLOAD = 9\nFREQUENCY = 5\nSDAMPING = 3", "quality"),
                ("transient", time + "TSTEP,3,10", "DLOAD = 9\nTSTEP = 3", "DT")]:
            self.write("d.bdf", self.deck(card, case))
            self.fails(1, verb, "d.bdf", says=[says, "d.bdf:2"])
        for card, says in [("TABDMP1,3,Q\n,0.,1.,2.,0.,ENDT", "quality"), ("TSTEP,3,10", "DT"), ("FREQ1,3,1.", "DF")]:
            self.write("d.bdf", self.deck(good + card))
            said = self.bough("frequency", "d.bdf").stderr
            self.assertRegex(said, f"warning: .*{says}.*no subcase selects the set")

    def test_a_load_on_a_support(self):
        """DAREA at a component that an SPC holds moves nothing: a warning of every solution, and of `check`."""
        load = "DAREA,10,1,1,2.\nDAREA,10,2,3,5.\n"
        for verb, sol, case, bulk in (("frequency", 108, "FREQUENCY = 5", "RLOAD1,9,10,,,1.\nFREQ,5,1."),
                                      ("frequency", 111, "FREQUENCY = 5", "RLOAD1,9,10,,,1.\nFREQ,5,1."),
                                      ("transient", 112, "TSTEP = 5", "TLOAD2,9,10,,,0.,1.\nTSTEP,5,4,.1")):
            self.write("d.bdf", self.deck(load + bulk, f"DLOAD = 9\n{case}", sol))
            for command in (verb, "check"):
                stderr = self.bough(command, "d.bdf").stderr
                self.assertEqual(stderr.count("[modal.load-on-spc]"), 1, stderr)
                self.assertIn("component 3 of grid 2", stderr)

    def test_unbounded(self):
        self.refuse("modal.unbounded-response", self.deck(f"RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ4,5,.1,1.,.1,1"), code=3,
                    says=["is not damped"])
        self.refuse("modal.unbounded-response", self.deck("RLOAD1,9,10,,,1.,,ACCE\nSPCD,10,2,1,2.\nFREQ,5,0."), code=3)
        self.write("d.bdf", self.deck("RLOAD1,9,10,,,1.,,ACCE\nSPCD,10,2,1,2.\nFREQ,5,0.,1."))
        self.assertRegex(self.bough("frequency", "d.bdf").stderr, r"warning: the response at 0 Hz .*left out.*unbounded-response")

    def test_warnings(self):
        self.write("d.bdf", CHAIN.format(sol=108, modes=1, case="DLOAD = 9\nFREQUENCY = 5\nSDAMPING = 6",
                                         bulk="RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,.1,50.\nTABDMP1,6,CRIT\n,.01,.02,.02,.01,ENDT"))
        text = self.bough("frequency", "d.bdf", "--modal").stderr
        for said in ["cli.by-modes", "modal.response-range", "modal.negative-damping"]:
            self.assertIn(f"[{said}]", text)
        self.write("d.bdf", self.deck("RLOAD1,9,10,,,1.\nDAREA,10,1,1,2.\nFREQ,5,.1"))
        self.assertRegex(self.bough("modes", "d.bdf").stderr, "RLOAD1 is not read")


if __name__ == "__main__":
    unittest.main()
