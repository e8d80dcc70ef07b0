"""Bodies and systems that `check` passes can be reduced and run: it tries small reductions and the first step."""
import re
import unittest

from support import BEAM, HANG, PROGRAM, ProgramTest, served
from toml_text import Bare, section, table, toml

BODY = toml(
    section("body", name="rod", deck="rod.bdf"),
    "{more}\n",
    section("body.modes", number=Bare("{modes}")))
SYSTEM = toml(
    table("body", "rod", mass=1.0, cg=[0.5, 0.0, 0.0], inertia=[Bare("{spin}"), 0.1, 0.1]),
    table("hinge", "pin", "{hinge}", parent="ground", child="rod"),
    "{position}\n",
    section("simulation", duration=0.1, output_step=0.05),
    "{more}\n")


class CheckRefuses(ProgramTest):
    def both(self, verb, file, error):
        """The command fails with `error`, and check says so too."""
        ids = [re.findall(r"error: .*\[([a-z]+\.[a-z0-9-]+)\]", run.stderr)
               for run in (self.run_any(verb, file, "-o", "out.h5"), self.run_any("check", file))]
        self.assertIn(error, ids[0])
        self.assertLessEqual(set(ids[0]), set(ids[1]))
        self.bough("check", file, code=1)

    def run_any(self, *call):
        return served.run([PROGRAM, *call], cwd=self.folder, timeout=HANG)

    def body(self, deck=BEAM, more="", modes=2, after=""):
        self.write("rod.bdf", deck)
        return self.write("rod.toml", BODY.format(more=more, modes=modes) + after)

    def test_bodies_that_cannot_be_reduced(self):
        pinned = BEAM.replace("CBAR,2,1,2,3,0.,1.,0.", "CBAR,2,1,2,3,0.,1.,0.\n,456")
        for name, error, file in [
                ("an arm that folds", "reduce.mechanism", {"deck": pinned}),
                ("an element that is not there", "reduce.unknown-element",
                 {"after": "[body.output]\nrecover = [\"99\"]\n"}),
                ("a node that is not there", "reduce.unknown-node", {"after": "[body.output]\nnodes = [99]\n"}),
                ("no mass", "reduce.no-mass", {"deck": BEAM.replace("2700.", "0.")}),
                ("a spring to ground", "reduce.grounded",
                 {"deck": BEAM.replace("ENDDATA", "CELAS2,9,100.,3,1\nENDDATA"), "more": 'frame = "free"'})]:
            with self.subTest(name):
                self.both("reduce", self.body(**file), error)
        self.bough("check", self.body())

    def test_a_large_body_is_not_reduced_and_that_is_said(self):
        grids = "".join(f"GRID,{k},,{0.01 * k:.2f},0.,0.\nCBAR,{k},1,{k - 1},{k},0.,1.,0.\n" for k in range(4, 1020))
        said = self.bough("check", self.body(BEAM.replace("ENDDATA", grids + "ENDDATA"))).stderr
        self.assertIn("[cli.not-reduced]", said)

    def test_systems_that_cannot_begin(self):
        for name, error, values in [
                ("a rod that turns about its line", "solver.indefinite-mass", {"hinge": "spherical"}),
                ("gimbal lock", "solver.gimbal-lock",
                 {"hinge": "gimbal", "spin": 0.1, "position": "position = [0.0, 1.5707963267948966, 0.0]"}),
                ("a rate past all bounds", "run.diverged",
                 {"hinge": "gimbal", "spin": 0.1, "position": "rate = [0.0, 1e200, 0.0]"}),
                ("a force that is no number", "run.diverged", {
                    "hinge": "gimbal", "spin": 0.1, "more": toml(
                        table("function", "f", "expression", expression="sqrt(-1-t)"),
                        table("force", "push", body="rod", force=[1, 0, 0], function="f"))}),
                ("a tolerance that nothing meets", "run.stalled", {
                    "hinge": "gimbal", "spin": 0.1, "position": "rate = [0.1, 1.0, 0.0]",
                    "more": "relative_tolerance = 1e-300\nabsolute_tolerance = 1e-300"})]:
            with self.subTest(name):
                text = SYSTEM.format(**{"spin": 0.0, "position": "", "more": "", **values})
                self.both("run", self.write("rod.toml", text), error)
        self.write("rod.toml", SYSTEM.format(hinge="gimbal", spin=0.1, position="", more=""))
        self.bough("check", "rod.toml")

    def test_a_motor_that_pushes_at_what_a_loop_holds(self):
        """Nothing moves: the rounding of the motor's work is no error of the energy."""
        self.write("held.toml", toml(
            table("body", "b0", mass=0.582, cg=[-0.1029, -0.3049, -0.2477], inertia=[0.91918, 0.96942, 1.04554]),
            table("hinge", "h0", "screw", parent="ground", child="b0", parent_position=[0.3224, -1.475, 0.3501],
                  parent_rotation=[0.0317, -0.0679, 0.0949], axis=[-0.8425, 0.7196, -0.9203], pitch=0.083, rate=[-0.4],
                  position=[0.393]),
            table("constraint", "loop", "point_on_plane", parent="ground", child="b0",
                  parent_position=[-0.3988, 0.5532, 0.2047], axis=[-0.7736, 0.0496, 0.1502]),
            table("sensor", "angle", "hinge_angle", hinge="h0", coordinate=1),
            table("controller", "law", "pid", inputs="angle", kp=1.63, kd=0.24, filter=0.05, setpoint=0.09),
            table("actuator", "motor", "hinge", hinge="h0", input="law"),
            section("simulation", duration=0.6, output_step=0.02, relative_tolerance=1e-9, absolute_tolerance=1e-11,
                    integrator="rk")))
        self.bough("run", "held.toml", "-o", "held.h5")


if __name__ == "__main__":
    unittest.main()
