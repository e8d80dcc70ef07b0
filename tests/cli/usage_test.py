"""Exit codes, help, versions, messages: what every command owes."""
import json
import os
import re
import subprocess
import sys
import tomllib
import unittest
import urllib.parse

import jsonschema

import h5py
import numpy as np

from support import BEAM, PROGRAM, SOURCE, VERBS, ProgramTest


class Usage(ProgramTest):
    def test_help_of_the_program_lists_the_verbs_that_exist_and_no_other(self):
        text = self.bough("--help").stdout
        for verb in VERBS:
            self.assertRegex(text, rf"(?m)^  {verb}\b")

    def test_each_verb_explains_itself_with_an_example(self):
        for verb in VERBS:
            with self.subTest(verb):
                text = self.bough(verb, "--help").stdout
                self.assertIn("Example:", text)
                self.assertIn(f"bough {verb} ", text)
                self.assertIn("--quiet", text)

    def test_page_of_options_is_what_the_program_prints(self):
        sys.path.insert(0, os.path.join(SOURCE, "tools"))
        from command_reference import PAGE, make_page
        with open(PAGE) as f:
            self.assertEqual(f.read(), make_page(PROGRAM))

    def test_unknown_verb_is_a_usage_error_with_the_nearest_match(self):
        self.fails(2, "reduse", "x.toml", says=['did you mean "reduce"'], error="cli.unknown-verb")

    def test_usage_errors(self):
        self.fails(2, error="cli.usage")
        self.fails(2, "run", error="cli.usage")
        self.fails(2, "run", "x.toml", "--nonsense", says=["--nonsense", "bough run --help"], error="cli.usage")
        self.fails(2, "export", "x.h5", "--to", "nonsense", error="cli.usage")
        self.fails(2, "modes", "x.bdf", "--number", "minus", error="cli.usage")

    def test_numbers_that_are_not_finite(self):
        for call in (("reduce", "x.bdf", "--max-hz"), ("modes", "x.bdf", "--max-hz"), ("modes", "x.bdf", "--min-hz"),
                     ("frequency", "x.bdf", "--max-hz"), ("response", "x.h5", "--from"), ("response", "x.h5", "--to"),
                     ("select", "x.h5", "--tolerance"), ("select", "x.h5", "--below"), ("select", "x.h5", "--damping"),
                     ("select", "x.h5", "--at"), ("linearize", "x.toml", "--at"), ("reduce", "x.bdf", "--damping"),
                     ("plot", "x.h5", "--y-min"), ("export", "x.h5", "--to", "gltf", "--scale"),
                     ("batch", "x.toml", "--time-limit")):
            for number in ("nan", "inf"):
                with self.subTest(call=call, number=number):
                    self.fails(2, *call, number, says=[number], error="cli.usage")
        self.fails(2, "reduce", "x.bdf", "--origin", "0", "nan", "0", says=["nan"], error="cli.usage")

    def test_options_that_a_format_does_not_have(self):
        for call in (("csv", "--ascii"), ("vtu", "--every", "2"), ("bdf", "--fmi", "2"), ("fmu", "--fields", "free"),
                     ("flat", "--digits", "9"), ("uff", "--every", "2"), ("mat", "--channel", "tip"),
                     ("gltf", "--id", "2")):
            with self.subTest(call):
                self.fails(2, "export", "x.h5", "--to", *call, "-o", "y", says=[call[1], "--to " + call[0]],
                           error="cli.usage")

    def test_numbers_out_of_their_range(self):
        for call, text in [(("export", "x.h5", "--to", "pvd", "--every", "0"), "expected a number above 0, found 0"),
                           (("flx", "x.h5", "--digits", "40"), "expected a number from 2 to 17, found 40"),
                           (("check", "x.bdf", "--gpwg", "-1"), "expected 0 or a number above it, found -1"),
                           (("studio", "--port", "http"), "expected a number from 1 to 65535, found http")]:
            with self.subTest(call):
                self.fails(2, *call, says=[call[-2] + ": " + text], error="cli.usage")

    def test_version_names_the_libraries(self):
        text = self.bough("--version").stdout
        for library in ["bough", "PETSc", "SLEPc", "HDF5", "SUNDIALS", "Eigen"]:
            self.assertRegex(text, rf"(?m)^{library} \d+\.\d+")

    def test_missing_file_is_wrong_input(self):
        for call in [["check", "no.bdf"], ["modes", "no.bdf"], ["reduce", "no.toml"], ["run", "no.toml"],
                     ["export", "no.h5", "--to", "csv"], ["plot", "no.h5", "--sensor", "x"], ["info", "no.h5"]]:
            with self.subTest(call[0]):
                self.fails(1, *call, says=[call[1]], error="cli.no-file")

    def test_data_on_stdout_and_messages_on_stderr(self):
        self.write("beam.bdf", BEAM)
        result = self.bough("modes", "beam.bdf", "--json")
        self.assertEqual(len(json.loads(result.stdout)["frequency_hz"]), 3)
        quiet = self.bough("modes", "beam.bdf", "-q")
        self.assertEqual(quiet.stdout + quiet.stderr, "")

    def test_no_color_codes_when_not_a_terminal(self):
        self.assertNotIn("\033", self.bough("run", "no.toml", code=1).stderr)

    def test_verbs_without_finite_elements_start_no_mpi(self):
        self.bough("init", "spinup", "-o", ".")
        self.bough("reduce", "boom.toml", "-o", "boom.h5")
        # Open MPI cannot start with a transport that does not exist.
        no_mpi = {"OMPI_MCA_pml": "none-such", "OMPI_MCA_btl": "none-such"}
        refused = subprocess.run([PROGRAM, "modes", "boom.bdf"], cwd=self.folder, env={**os.environ, **no_mpi},
                                 capture_output=True)
        self.assertNotEqual(refused.returncode, 0)
        for call in [["--help"], ["--version"], ["modes", "--help"], ["info", "boom.h5"], ["check", "spinup.toml"],
                     ["run", "spinup.toml", "-o", "r.h5"], ["info", "r.h5"],
                     ["export", "boom.bdf", "--to", "bdf", "-o", "copy.bdf"]]:
            with self.subTest(" ".join(call)):
                self.bough(*call, env=no_mpi)


class InitFromDeck(ProgramTest):
    def start(self, *options):
        self.bough("init", "boom.bdf", "--force", *options)
        self.bough("reduce", "boom.toml", "-o", "boom.h5")
        result = self.bough("run", "boom-run.toml", "-o", "r.h5")
        with open(self.path("boom.toml")) as f:
            return f.read(), result.stdout + result.stderr

    def test_constraints_hold_the_frame_and_a_hinge_takes_mean_axes(self):
        self.bough("init", "spinup", "-o", ".")
        body, said = self.start()
        self.assertIn('frame = "fixed"', body)
        body, said = self.start("--hinge", "1")
        self.assertIn('frame = "mean"', body)
        self.assertIn("interface = [1]", body)
        self.assertNotIn("system.spanned-hinge", said)
        # The other choice is noted, with the way out.
        self.write("boom.toml", body.replace('frame = "mean"', 'frame = "fixed"').replace("interface = [1]", "")
                   .replace('residual = ["interface"]', ""))
        self.bough("reduce", "boom.toml", "-o", "boom.h5")
        said = self.bough("check", "boom-run.toml")
        self.assertIn("system.spanned-hinge", said.stdout + said.stderr)
        self.assertIn('frame = "mean"', said.stdout + said.stderr)
        self.fails(1, "init", "boom.bdf", "--hinge", "99", "--force", error="cli.unknown-interface")

    def test_a_plate_turns_about_an_axis_in_its_plane(self):
        """About its normal a hinge would turn the grid alone, which has no mass there: solver.indefinite-mass."""
        grids = "".join(f"GRID,{5 * j + i + 1},,{0.2 * i:.1f},{0.2 * j:.1f},0.\n" for j in range(5) for i in range(5))
        quads = "".join(f"CQUAD4,{4 * j + i + 1},1,{5 * j + i + 1},{5 * j + i + 2},{5 * j + i + 7},{5 * j + i + 6}\n"
                        for j in range(4) for i in range(4))
        self.write("plate.bdf", "SOL 103\nCEND\nMETHOD = 1\nBEGIN BULK\nEIGRL,1,,,10\nMAT1,1,7.+10,,.3,2700.\n"
                   f"PSHELL,1,1,.02,1,,1\n{grids}{quads}ENDDATA\n")
        os.makedirs(self.path("own"))
        self.folder = self.path("own")
        self.bough("init", "../plate.bdf", "--hinge", "1")
        self.assertIn("axis = [0.0, 1.0, 0.0]", self.read("plate-run.toml"))
        self.bough("reduce", "plate.toml")
        self.write("plate-run.toml", self.read("plate-run.toml").replace("duration = 1.0", "duration = 0.01"))
        self.bough("run", "plate-run.toml", "-o", "r.h5")

    def test_a_revolute_hinge_clamps_the_other_directions(self):
        self.copy_example("ex10-robot-arm")
        os.makedirs(self.path("own"))
        self.folder = self.path("own")
        self.bough("init", "../arm.bdf", "--hinge", "1")
        self.bough("reduce", "arm.toml")
        linear = json.loads(self.bough("linearize", "arm-run.toml", "--json").stdout)
        found = sorted({round(hz, 6) for hz in linear["poles"]["frequency_hz"] if hz > 1})
        held = json.loads(self.bough("modes", "../arm.bdf", "--json").stdout)["frequency_hz"][0]
        # Out of the plane the arm is clamped (ten free-free modes alone: 19 % off); in it, pinned and free:
        # (3.92660 / 1.87510)² of that.
        self.assertLess(abs(found[0] / held - 1), 1e-2, found[:2])
        self.assertLess(abs(found[1] / held / (3.9266023 / 1.8751041)**2 - 1), 2e-3, found[:2])

    def test_more_modes_are_never_worse(self):
        """The arm clamped by its residual vectors comes down to its frequency: the moment about the bars, which the
        support of that motion without mass holds, has no vector (it was round-off, and 0.4 % off with ten modes)."""
        self.copy_example("ex10-robot-arm")
        os.makedirs(self.path("own"))
        self.folder = self.path("own")
        self.bough("init", "../arm.bdf", "--hinge", "1")
        held = json.loads(self.bough("modes", "../arm.bdf", "--json").stdout)["frequency_hz"][0]
        with open(self.path("arm.toml")) as f:
            text = f.read().replace("residual_ratio = 1.0 ", "residual_ratio = 0.005 ")
        before = held * 1.001
        for number in (7, 9, 10, 11, 13):
            self.write("arm.toml", re.sub(r"\nnumber = \d+", f"\nnumber = {number}", text))
            self.bough("reduce", "arm.toml")
            linear = json.loads(self.bough("linearize", "arm-run.toml", "--json").stdout)
            found = min(hz for hz in linear["poles"]["frequency_hz"] if hz > 1)
            self.assertGreater(found, held * (1 - 1e-7), number)
            self.assertLess(found, before * (1 + 1e-7), number)
            before = found
        self.assertLess(before, held * (1 + 2e-5))

    def test_roots_by_transformation_have_no_range(self):
        """EIGR by GIV and its kin counts; F1 and F2, which may be anything, became a body without modes."""
        self.write("boom.bdf", BEAM.replace("EIGRL,1,,,3", "EIGR,1,MGIV,0.,.1,,2"))
        body, _ = self.start()
        self.assertIn("number = 2 ", body)
        self.assertNotIn("max_frequency", body)
        self.write("boom.bdf", BEAM.replace("EIGRL,1,,,3", "EIGR,1,LAN,0.,500.,,2"))
        body, _ = self.start()
        self.assertIn("max_frequency = 500 ", body)

    def test_a_body_without_modes_is_rigid(self):
        self.write("boom.bdf", BEAM)
        self.write("boom.toml", '[body]\nname = "boom"\ndeck = "boom.bdf"\n[body.modes]\nnumber = 2\nmax_frequency = 1e-3\n')
        self.assertIn("[reduce.rigid]", self.bough("reduce", "boom.toml", "-o", "boom.h5").stderr)
        self.write("run.toml", '[[body]]\nname = "boom"\nfile = "boom.h5"\n[[hinge]]\nname = "pin"\ntype = "revolute"\n'
                   'child = "boom"\naxis = [0.0, 1.0, 0.0]\n[[sensor]]\nname = "q"\ntype = "hinge_angle"\nhinge = "pin"\n'
                   '[simulation]\nduration = 0.1\ngravity = [0.0, 0.0, -9.81]\n')
        self.bough("run", "run.toml", "-o", "r.h5")
        # A slender rod let go level: alpha = 3 g / 2 L (lumped at three points: m L/4 (0, 1, 2)).
        with h5py.File(self.path("r.h5")) as f:
            time, q = f["time"][:], f["sensors/q"][:].ravel()
        mass, arm, inertia = 2 * 2700e-4, 1.0, 2700e-4 * (1 * 1 + .5 * 4)
        alpha = mass * arm * 9.81 / inertia
        np.testing.assert_allclose(q[-1], .5 * alpha * time[-1]**2, rtol=1e-3)

    def test_modes_and_interface_come_from_the_deck(self):
        self.write("boom.bdf", BEAM.replace("EIGRL,1,,,3", "EIGRL,1,,1.+6,4").replace(
            "ENDDATA", "GRID,4,,2.,.1,0.\nGRID,5,,2.,-.1,0.\nRBE2,7,3,123456,4,5\n"
            "CONM2,8,4,,1.,,,,,1.,,1.,,,1.\nENDDATA"))
        body, _ = self.start()
        self.assertIn("number = 4 ", body)
        self.assertIn("max_frequency = 1000000 ", body)
        self.assertIn("EIGRL 1 of the deck", body)
        self.assertIn("\ninterface = [3] ", body)
        for file in ["boom.toml", "boom-run.toml"]:
            self.bough("check", file)
        # Free: the deck's number holds six rigid modes.
        with open(self.path("boom.bdf")) as f:
            self.write("boom.bdf", f.read().replace("SPC = 1\n", "").replace("SPC1,1,123456,1\n", "").replace(
                "1.+6,4", ",9"))
        body, _ = self.start()
        self.assertIn('frame = "free"', body)
        self.assertIn("number = 3 ", body)

    def test_editors_find_the_schema(self):
        """The first line of each TOML file leads to the installed schema of its kind, which the rest of it keeps; without
        an installed one there is no such line, and none that leads to sources or a build folder."""
        os.makedirs(self.path("share/bough"))
        os.symlink(os.path.join(SOURCE, "data/schema"), self.path("share/bough/schema"))
        nowhere, installed = {"XDG_DATA_DIRS": self.path("nowhere")}, {"XDG_DATA_DIRS": self.path("share")}
        self.bough("init", "spinup", "-o", ".", env=nowhere)
        with open(self.path("spinup.toml")) as f:
            self.assertNotIn("#:schema", f.read())
        self.bough("init", "spinup", "-o", ".", "--force", env=installed)
        self.bough("init", "boom.bdf", "--force", env=installed)
        self.bough("init", "campaign", "-o", "many", env=installed)
        seen = set()
        for name in ["spinup.toml", "boom.toml", "boom-run.toml", "many/campaign.toml", "many/boom.toml"]:
            with open(self.path(name)) as f:
                line = f.readline()
            uri = re.fullmatch(r"#:schema file://(/.*\.schema\.json)\n", line).group(1)
            self.assertTrue(urllib.parse.unquote(uri).startswith(self.path("share/bough/schema/")))
            with open(urllib.parse.unquote(uri)) as f:
                schema = json.load(f)
            with open(self.path(name), "rb") as f:
                jsonschema.validate(tomllib.load(f), schema)
            seen.add(os.path.basename(uri))
        self.assertEqual(seen, {"body.schema.json", "campaign.schema.json", "system.schema.json"})

    def test_without_a_name_the_templates_are_listed(self):
        said = self.bough("init").stdout
        for name in sorted(os.listdir(os.path.join(SOURCE, "data/examples"))):
            if name.startswith("ex"):
                self.assertRegex(said, rf"(?m)^{name[5:]} +[a-z]")
        self.assertRegex(said, "spinup +spin-up of a boom")


class Output(ProgramTest):
    def test_output_is_overwritten_unless_told_otherwise(self):
        self.write("beam.bdf", BEAM)
        self.bough("modes", "beam.bdf", "-o", "m.h5")
        self.bough("modes", "beam.bdf", "-o", "m.h5")
        self.fails(1, "modes", "beam.bdf", "-o", "m.h5", "--no-clobber", error="cli.output-exists")
        self.bough("modes", "beam.bdf", "-o", "m.h5", "--force")

    def test_a_range_upside_down_is_refused(self):
        self.write("beam.bdf", BEAM)
        self.fails(1, "modes", "beam.bdf", "--min-hz", "20", "--max-hz", "10", error="cli.bad-range")
        self.fails(1, "modes", "beam.bdf", "--min-hz", "20", "--max-hz", "20", error="cli.bad-range")

    def test_a_failed_verb_leaves_no_output_file(self):
        self.write("beam.bdf", BEAM.replace("CBAR,2,1,2,3", "CBAR,2,1,2,99"))
        self.bough("reduce", "beam.bdf", "--modes", "2", "-o", "b.h5", code=1)
        self.assertEqual(os.listdir(self.folder), ["beam.bdf"])

    def test_a_folder_that_cannot_be_written_is_reported(self):
        self.bough("init", "spinup")
        self.fails(3, "init", "hub", "-o", "spinup/README.md/x", error="cli.write")

    def test_init_copies_each_template_and_refuses_to_overwrite(self):
        for name in ["spinup", "hub", "two-link", "free-flyer", "plate"]:
            self.bough("init", name)
            self.assertIn("README.md", os.listdir(self.path(name)))
        self.fails(1, "init", "spinup", error="cli.output-exists")
        self.bough("init", "spinup", "--force")
        self.fails(1, "init", "no.bdf", error="cli.no-file")
        self.fails(1, "init", "spinnup", says=['did you mean "spinup"'], error="cli.unknown-template")


if __name__ == "__main__":
    unittest.main()
