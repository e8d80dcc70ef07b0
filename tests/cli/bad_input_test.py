"""Bad input: a clear error with its place, exit code 1, and every error of the file at once."""
import json
import os
import unittest

from support import BEAM, ProgramTest
from toml_text import section, table, toml

SYSTEM = toml(
    table("body", "a", mass=1.0, inertia=[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    table("body", "b", mass=1.0, inertia=[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    table("hinge", "ha", "revolute", parent="ground", child="a", axis=[0.0, 0.0, 1.0]),
    table("hinge", "hb", "revolute", parent="a", child="b", axis=[0.0, 0.0, 1.0]),
    section("simulation", duration=0.1, output_step=0.01))


class BadDeck(ProgramTest):
    def fails_with(self, text, *says):
        self.write("deck.bdf", text)
        for call in [["check", "deck.bdf"], ["modes", "deck.bdf"], ["reduce", "deck.bdf", "--modes", "2", "-o", "b.h5"]]:
            with self.subTest(call[0]):
                result = self.fails(1, *call, says=says)
                self.assertRegex(result.stderr, r"(?m)^deck.bdf:\d+: error: ")
        return result

    def test_missing_grid(self):
        self.fails_with(BEAM.replace("CBAR,2,1,2,3", "CBAR,2,1,2,99"), "99")

    def test_undefined_property(self):
        self.fails_with(BEAM.replace("CBAR,2,1,2,3", "CBAR,2,77,2,3"), "77")

    def test_undefined_material(self):
        self.fails_with(BEAM.replace("PBAR,1,1,", "PBAR,1,88,"), "88")

    def test_zero_length_beam(self):
        self.fails_with(BEAM.replace("GRID,3,,2.,0.,0.", "GRID,3,,1.,0.,0."), "length")

    def test_cyclic_coordinate_systems(self):
        self.fails_with(BEAM.replace("GRID,3,,2.", "CORD2R,5,6,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\n"
                                     "CORD2R,6,5,0.,0.,0.,0.,0.,1.,+\n+,1.,0.,0.\nGRID,3,5,2."), "cycl")

    def test_cyclic_include(self):
        self.write("part.bdf", "INCLUDE 'deck.bdf'\n")
        self.write("deck.bdf", BEAM.replace("ENDDATA", "INCLUDE 'part.bdf'\nENDDATA"))
        result = self.fails(1, "check", "deck.bdf", says=["INCLUDE"])
        self.assertRegex(result.stderr, r"(deck|part)\.bdf:\d+: error: ")

    def test_all_errors_at_once(self):
        result = self.fails_with(BEAM.replace("CBAR,2,1,2,3", "CBAR,2,77,2,99").replace("CBAR,1,1,1,2", "CBAR,1,66,1,2"),
                                 "66", "77", "99")
        self.assertGreaterEqual(result.stderr.count("error:"), 3)

    def test_errors_of_reading_and_of_the_model_at_once(self):
        text = BEAM.replace("CBAR,2,1,2,3", "CBAR,2,77,2,3").replace("ENDDATA", "GRID,9,,abc,0.,0.\nENDDATA")
        result = self.fails_with(text, "77", "abc")
        self.assertNotIn("fe.missing-grid", result.stderr)

    def test_a_mechanism_names_its_dofs(self):
        # Held at grid 1 in translation only: three rotations about it are free.
        self.write("deck.bdf", BEAM.replace("SPC1,1,123456,1", "SPC1,1,123,1"))
        result = self.fails(1, "reduce", "deck.bdf", "--modes", "2", "-o", "b.h5", says=["grid", "component"],
                            error="fe.mechanism")
        self.assertRegex(result.stderr, r"(?m)^deck.bdf: error: the stiffness matrix is singular")
        self.assertFalse(os.path.exists(self.path("b.h5")))

    def test_options_of_reduce(self):
        self.write("deck.bdf", BEAM)
        self.fails(1, "reduce", "deck.bdf", error="cli.no-modes")
        self.fails(1, "reduce", "deck.bdf", "--modes", "2", "--load", "3", error="cli.bad-load")
        self.fails(1, "modes", "deck.bdf", "--buckling", error="cli.no-static-load")
        self.write("body.toml", toml(
            section("body", name="b", deck="deck.bdf", interface=[99]),
            section("body.modes", number=2)))
        self.fails(1, "check", "body.toml", says=["99"], error="cli.unknown-interface")


class BadSystem(ProgramTest):
    def fails_with(self, text, *says):
        self.write("system.toml", text)
        for call in [["check", "system.toml"], ["run", "system.toml", "-o", "out.h5"]]:
            with self.subTest(call[0]):
                result = self.fails(1, *call, says=says)
        self.assertFalse(os.path.exists(self.path("out.h5")))
        return result

    def test_the_system_itself_is_good(self):
        self.write("system.toml", SYSTEM)
        self.bough("check", "system.toml")
        self.bough("run", "system.toml", "-o", "out.h5")

    def test_each_error_is_told_once(self):
        sensor = table("sensor", "s", "position", body="a", node=7)
        self.write("bad.toml", SYSTEM.replace("[simulation]", sensor + "[simulation]"))
        result = self.fails(1, "run", "bad.toml", "-o", "bad.h5", says=["sensor.unknown-node"])
        self.assertEqual(result.stderr.count("sensor.unknown-node"), 1)

    def test_hinge_on_an_unknown_node(self):
        result = self.fails_with(SYSTEM.replace('parent = "a"', 'parent = "a"\nparent_node = 17'), "17", "hb")
        self.assertRegex(result.stderr, r"(?m)^system.toml:\d+(:\d+)?: error: ")

    def test_loop_in_the_tree(self):
        self.fails_with(SYSTEM.replace('parent = "ground"', 'parent = "b"'), "loop")

    def test_nan_in_a_table(self):
        table = '[[function]]\nname = "f"\ntype = "table"\nx = [0.0, 1.0]\ny = [0.0, nan]\n[simulation]'
        self.fails_with(SYSTEM.replace("[simulation]", table), "nan")

    def test_unknown_key_with_the_nearest_match(self):
        self.fails_with(SYSTEM.replace("duration =", "durration ="), "durration", "duration")

    def test_unknown_body(self):
        self.fails_with(SYSTEM.replace('child = "b"', 'child = "bb"'), "bb")

    def test_missing_body_file(self):
        text = SYSTEM.replace('mass = 1.0\n', 'file = "none.h5"\n', 1)
        result = self.fails_with(text, "[cli.no-body-file]", "bough reduce BODY.toml -o none.h5")
        self.assertRegex(result.stderr, r'(?m)^system.toml:1(:\d+)?: error: body "a": there is no file none.h5;')
        self.write("none.toml", "[body]\n")
        self.fails_with(text, "bough reduce none.toml -o none.h5")

    def test_truncated_body_file(self):
        self.write("deck.bdf", BEAM)
        self.bough("reduce", "deck.bdf", "--modes", "2", "-o", "whole.h5")
        with open(self.path("whole.h5"), "rb") as f:
            whole = f.read()
        with open(self.path("cut.h5"), "wb") as f:
            f.write(whole[:len(whole) // 2])
        self.write("system.toml", toml(
            table("body", "a", file="cut.h5"),
            table("hinge", "h", "fixed", child="a"),
            section("simulation", duration=0.1)))
        for call in [["check", "cut.h5"], ["check", "system.toml"], ["run", "system.toml"], ["info", "cut.h5"]]:
            with self.subTest(" ".join(call)):
                self.fails(1, *call, says=["cut.h5"])

    def test_wrong_kind_of_hdf5_file(self):
        self.write("system.toml", SYSTEM)
        self.bough("run", "system.toml", "-o", "out.h5")
        self.write("other.toml", toml(
            table("body", "a", file="out.h5"),
            table("hinge", "h", "fixed", child="a"),
            section("simulation", duration=0.1)))
        self.fails(1, "run", "other.toml", says=["out.h5"])

    def test_results_over_the_input(self):
        self.write("system.toml", SYSTEM)
        self.fails(1, "run", "system.toml", "-o", "system.toml", error="cli.output-is-input")

    def test_channels(self):
        self.write("system.toml", SYSTEM)
        self.bough("run", "system.toml", "-o", "out.h5")
        self.fails(1, "plot", "out.h5", "--sensor", "nothing", error="cli.unknown-channel")
        self.fails(1, "export", "out.h5", "--to", "csv", "--channel", "/hinges/ha/q:x", error="cli.unknown-channel")
        self.write("points.csv", "1;2\n")
        self.fails(1, "plot", "out.h5", "--sensor", "/hinges/ha/q", "--points", "points.csv", error="cli.bad-points")
        self.fails(1, "plot", "out.h5", "--sensor", "/hinges/ha/q", "--y-min", 1, "--y-max", 0, error="cli.bad-range")
        said = self.bough("plot", "out.h5", "--sensor", "/hinges/ha/q", "--label", "a", "--label", "b").stderr
        self.assertIn("there are 2 labels and 1 curve", said)
        self.assertIn("[cli.labels-left]", said)


class Json(ProgramTest):
    def test_check_tells_its_errors_as_json_too(self):
        self.write("system.toml", SYSTEM.replace('child = "b"', 'child = "bb"'))
        data = json.loads(self.bough("check", "system.toml", "--json", code=1).stdout)
        self.assertGreater(data["errors"], 0)
        self.assertIn("bb", " ".join(data["messages"]))
        self.write("deck.bdf", BEAM.replace("CBAR,2,1,2,3", "CBAR,2,77,2,99"))
        data = json.loads(self.bough("check", "deck.bdf", "--json", code=1).stdout)
        self.assertEqual(data["errors"], len([m for m in data["messages"] if ": error: " in m]))


class BadHdf5(ProgramTest):
    def test_foreign_and_damaged_files(self):
        import h5py
        import numpy as np
        with h5py.File(self.path("foreign.h5"), "w") as f:
            f["/x"] = np.arange(3.0)
        self.fails(1, "check", "foreign.h5", error="cli.unknown-format")
        self.write("deck.bdf", BEAM)
        self.bough("reduce", "deck.bdf", "--modes", "2", "-o", "body.h5")
        with h5py.File(self.path("body.h5"), "a") as f:
            size = np.abs(f["/stiffening/kg_inertial"][0]).max()
            f["/stiffening/kg_inertial"][0, 0, 1] += 1e-5 * size
        self.fails(1, "check", "body.h5", error="cli.bad-body")
        with h5py.File(self.path("body.h5"), "a") as f:
            f["/stiffening/kg_inertial"][0, 0, 1] = 1e9
        self.fails(1, "check", "body.h5", says=["/stiffening/kg_inertial is not symmetric"], error="hdf5.value")
        self.write("system.toml", SYSTEM)
        self.bough("run", "system.toml", "-o", "out.h5")
        with h5py.File(self.path("out.h5"), "a") as f:
            f["/hinges/ha/q"][3] = np.nan
        self.fails(1, "check", "out.h5", error="cli.not-finite")


    def test_a_mass_of_negative_energy_is_named(self):
        """Before the modes fail by it, and with them."""
        self.write("mass.bdf", "SOL 103\nCEND\nMETHOD=1\nSPC=1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\n"
                               "CBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,1.-6,1.-6,2.-6\nMAT1,1,7.+10,,.3,2700.\n"
                               "CONM1,8,2,,2.\n,,,3.\nSPC1,1,123456,1\nEIGRL,1,,,3\nENDDATA\n")
        self.assertIn("mass.bdf:11: warning: CONM1 8 has negative energy", self.bough("check", "mass.bdf").stderr)
        self.assertIn("[fe.indefinite-mass]", self.bough("modes", "mass.bdf", code=3).stderr)


if __name__ == "__main__":
    unittest.main()
