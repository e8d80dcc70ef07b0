"""Messages of constraints that are rejected, and of events that name them."""
import unittest

from support import ProgramTest
from toml_text import section, table, toml

RUN = section("simulation", duration=1.0)


class RefusedPartsTest(ProgramTest):
    def test_ratios_that_cancel(self):
        for kind, ratios, is_refused in (("rate_coupler", (1.0, -1.0), True), ("coupler", (2.0, -2.0), True),
                                         ("rate_coupler", (1.0, -0.5), False)):
            terms = [{"hinge": "h", "ratio": ratio} for ratio in ratios]
            self.write("case.toml", toml(
                table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]), table("hinge", "h", "revolute", child="b"),
                table("constraint", "gear", kind, terms=terms), RUN))
            if is_refused:
                self.fails(1, "check", "case.toml", error="system.bad-constraint", says=["the ratios of its terms cancel"])
            else:
                self.bough("check", "case.toml")

    def test_an_event_of_a_refused_constraint(self):
        """The event names a constraint of the file: only the constraint has an error."""
        self.write("case.toml", toml(
            table("body", "b", mass=1.0, inertia=[1.0, 1.0, 1.0]), table("hinge", "h", "revolute", child="b"),
            table("constraint", "tie", "distance", child="b", child_node=77, length=1.0),
            table("event", "cut", time=0.5, action="break", constraint="tie"), RUN))
        result = self.fails(1, "check", "case.toml", error="system.unknown-node")
        self.assertNotIn("which does not exist", result.stderr)


if __name__ == "__main__":
    unittest.main()
