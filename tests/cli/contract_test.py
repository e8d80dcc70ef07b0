"""Interfaces to the outside: options of every command, layouts of files, outputs when calls fail."""
import json
import os
import resource
import shutil
import signal
import subprocess
import unittest

import h5py
import numpy as np

from support import BEAM, PROGRAM, SOURCE, VERBS, ProgramTest
from decks import grids
from toml_text import section, table, toml

# A strip of four plates on a clamped bar, with an MPC, a rigid element and a scalar point: every kind of row of the
# g-set.
PANEL = """SOL 103
CEND
SPC = 1
MPC = 2
LOAD = 3
METHOD = 4
BEGIN BULK
EIGRL,4,,,3
SPC1,1,123456,1,2
MPC,2,8,3,1.,7,3,-1.
RBE2,30,6,123456,9
FORCE,3,5,,1.,0.,0.,1.
MAT1,1,7.+10,,.3,2700.
PSHELL,1,1,.01,1,,1
""" + grids((0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (2, 0, 0), (2, 1, 0), (3, 0, 0), (3, 1, 0), (2, 1.5, 0)) + """CQUAD4,1,1,1,3,4,2
CQUAD4,2,1,3,5,6,4
CQUAD4,3,1,5,7,8,6
CONM2,4,9,,5.,,,,,+
+,0.1,,0.1,,,0.1
SPOINT,20
CELAS4,5,100.,20
CMASS4,6,1.,20
ENDDATA
"""

PENDULUM = toml(
    table("body", "arm", file="panel.h5"),
    table("hinge", "pivot", "revolute", child="arm", axis=[0.0, 1.0, 0.0]),
    table("sensor", "tip", "deflection", body="arm", node=7),
    section("simulation", duration=0.05, output_step=0.01, gravity=[0.0, 0.0, -9.81]))


def cap_files(size):
    """For the child: no file may grow beyond `size` bytes, as on a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


class Options(ProgramTest):
    def test_every_verb_takes_the_common_options(self):
        for verb in VERBS:
            with self.subTest(verb):
                text = self.bough(verb, "--help").stdout
                for option in [*([] if verb == "studio" else ["-o,--output"]), "-q,--quiet", "-v,--verbose"]:
                    self.assertIn(option, text)
        for verb in ["check", "modes", "static", "matrices", "reduce", "integrals", "flx", "compare", "run", "info", "batch"]:
            self.assertIn("--json", self.bough(verb, "--help").stdout, verb)

    def test_check_and_info_write_their_report_to_a_file(self):
        self.write("panel.bdf", PANEL)
        printed = self.bough("check", "panel.bdf").stdout
        self.bough("check", "panel.bdf", "-o", "report.txt")
        with open(self.path("report.txt")) as f:
            self.assertIn(f.read().strip(), printed)
        self.bough("modes", "panel.bdf", "-o", "m.h5")
        self.bough("info", "m.h5", "--json", "-o", "info.json")
        with open(self.path("info.json")) as f:
            self.assertEqual(json.load(f), json.loads(self.bough("info", "m.h5", "--json").stdout))

    def test_a_wrong_option_is_answered_with_the_nearest(self):
        self.fails(2, "modes", "x.bdf", "--numbr", "3", says=["unknown option --numbr; did you mean --number"], error="cli.usage")
        self.fails(2, "modes", "x.bdf", "y.bdf", says=["unexpected argument y.bdf"], error="cli.usage")
        self.fails(2, "modes", "x.bdf", "--number", "-3", says=["found -3, expected a number above 0"], error="cli.usage")
        self.fails(2, "reduce", "x.bdf", "--damping", "-1", says=["found -1, expected 0 or"], error="cli.usage")

    def test_a_file_of_another_kind_is_named(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        for verb in ["modes", "static", "check"]:
            self.write("body.h5x", "")
            shutil.copy(self.path("boom.h5"), self.path("body.h5x"))
            self.fails(1, verb, "body.h5x", says=["is HDF5, expected a Nastran deck"], error="cli.wrong-file")
        self.fails(1, "modes", "boom.toml", says=["is TOML"], error="cli.wrong-file")
        self.fails(1, "run", "boom.toml", says=["is a body file", "bough reduce"], error="cli.wrong-file")
        for verb in ("run", "equilibrium", "linearize"):
            self.fails(1, verb, "boom.bdf", says=["is a Nastran deck", "bough init boom.bdf"], error="cli.wrong-file")
        self.fails(1, "reduce", "spinup.toml", says=["is a system file", "bough run"], error="cli.wrong-file")
        shutil.copy(os.path.join(SOURCE, "data/examples/ex06-campaign/campaign.toml"), self.folder)
        self.fails(1, "check", "campaign.toml", says=["bough batch", "--dry-run"], error="cli.wrong-file")

    def test_a_wrong_channel_is_answered_with_the_sensors(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        self.bough("run", "spinup.toml", "-o", "r.h5")
        self.fails(1, "plot", "r.h5", "--sensor", "speed", says=["the sensors are ", "tip_deflection"], error="cli.unknown-channel")
        self.fails(1, "plot", "r.h5", "--sensor", "tip", says=['did you mean "tip_deflection"'], error="cli.unknown-channel")


class Decks(ProgramTest):
    def test_a_method_without_its_card_is_a_warning(self):
        self.write("beam.bdf", BEAM.replace("METHOD = 1", "METHOD = 7"))
        result = self.bough("modes", "beam.bdf", "-n", 2)
        self.assertIn("METHOD = 7 names no EIGRL", result.stderr)
        self.assertIn("[cli.no-method]", result.stderr)

    def test_a_number_of_the_deck_bounds_the_range_and_says_so(self):
        self.write("beam.bdf", BEAM.replace("EIGRL,1,,,3", "EIGRL,1,0.,1.,2"))
        result = self.bough("modes", "beam.bdf", "--max-hz", 1e9, "--json")
        self.assertEqual(2, len(json.loads(result.stdout)["frequency_hz"]))
        self.assertRegex(result.stderr, r"beam.bdf:\d+: note: EIGRL 1: ND = 2 bounds the range .*cli.method-number")
        self.assertNotIn("method-number", self.bough("modes", "beam.bdf", "--max-hz", 1e9, "-n", 6).stderr)
        self.assertNotIn("method-number", self.bough("modes", "beam.bdf", "--max-hz", 1e-3).stderr)

    def test_a_range_without_an_inside_is_an_error(self):
        self.write("beam.bdf", BEAM)
        self.fails(1, "modes", "beam.bdf", "--min-hz", 20, "--max-hz", 10, says=["from 20 to 10"], error="cli.bad-range")
        # --max-hz overrides the single mode of an EIGRL without ND and V2, but not a given ND.
        for card, number in (("EIGRL,1", 6), ("EIGRL,1,,,1", 1), ("EIGRL,1,,1.", 6)):
            self.write("ranged.bdf", BEAM.replace("EIGRL,1,,,3", card))
            found = json.loads(self.bough("modes", "ranged.bdf", "--max-hz", 1e9, "--json").stdout)["frequency_hz"]
            self.assertGreaterEqual(len(found), number, card) if number > 1 else self.assertEqual(len(found), 1, card)
        self.write("ranged.bdf", BEAM.replace("EIGRL,1,,,3", "EIGRL,1"))
        self.assertEqual(len(json.loads(self.bough("modes", "ranged.bdf", "--json").stdout)["frequency_hz"]), 1)
        result = self.bough("modes", "beam.bdf", "--min-hz", 1e-6, "--max-hz", 2e-6)
        self.assertIn("[modal.empty-range]", result.stderr)
        self.assertNotIn("none missed", result.stdout)

    def test_messages_of_the_computation_name_the_deck(self):
        self.write("beam.bdf", BEAM)
        for call in [["modes", "beam.bdf", "-n", 300], ["reduce", "beam.bdf", "--modes", 300]]:
            self.assertRegex(self.bough(*call).stderr, r"(?m)^beam\.bdf: warning: .*\[modal\.fewer-modes\]$")
        self.write("beam.bdf", BEAM.replace(",2700.", ""))
        self.assertRegex(self.fails(1, "modes", "beam.bdf").stderr, r"(?m)^beam\.bdf: error: .*\[modal\.no-mass\]$")

    def test_a_model_without_mass_is_wrong_input(self):
        self.write("beam.bdf", BEAM.replace(",2700.", ""))
        self.assertIn("[cli.no-mass]", self.bough("check", "beam.bdf").stderr)
        self.fails(1, "modes", "beam.bdf", error="modal.no-mass")

    def test_a_body_that_nothing_holds_is_told_of_free(self):
        self.write("beam.bdf", BEAM.replace("SPC = 1\n", "").replace("SPC1,1,123456,1\n", ""))
        self.fails(1, "reduce", "beam.bdf", "--modes", 2, says=["--free"], error="reduce.mechanism")


class Tables(ProgramTest):
    def test_tables_fit_eighty_columns(self):
        self.write("panel.bdf", PANEL)
        for call in [["modes", "panel.bdf"], ["static", "panel.bdf"], ["reduce", "panel.bdf", "--modes", 3]]:
            with self.subTest(call[0]):
                lines = self.bough(*call).stdout.splitlines()
                self.assertLessEqual(max(map(len, lines)), 80, max(lines, key=len))

    def test_help_fits_eighty_columns(self):
        for call in [[], *[[verb] for verb in VERBS]]:
            lines = self.bough(*call, "--help").stdout.splitlines()
            for line in lines:    # examples and the values that an option takes are not broken
                if not line.startswith(("  bough", "  mpirun", "  -")):
                    self.assertLessEqual(len(line), 80, line)

    def test_buckling_says_which_load_it_multiplies(self):
        self.write("beam.bdf", BEAM.replace("METHOD = 1", "SUBCASE 1\nLOAD = 9\nSUBCASE 2\nMETHOD = 1")
                   .replace("ENDDATA", "FORCE,9,3,,1.,-1.,0.,0.\nENDDATA"))
        self.assertIn("load factors of LOAD 9 (subcase 1)", self.bough("modes", "beam.bdf", "--buckling").stdout)


class Layout(ProgramTest):
    """Paths, shapes and attributes that other programs read."""

    def demand(self, file, shapes):
        with h5py.File(self.path(file)) as f:
            for path, shape in shapes.items():
                self.assertIn(path, f)
                self.assertEqual(f[path].shape, shape, path)
            return self.demand_attributes(f)

    def demand_attributes(self, f):
        """description and dims on every array, little-endian doubles; gives the root attributes."""
        def look(name, item):
            if isinstance(item, h5py.Dataset):
                self.assertIn("description", item.attrs, name)
                self.assertIn("dims", item.attrs, name)
                if item.dtype.kind == "f":
                    self.assertEqual(item.dtype, np.dtype("<f8"), name)
        f.visititems(look)
        for name in ["format", "format_version", "bough_version", "source"]:
            self.assertIn(name, f.attrs)
        source = f.attrs["source"]
        self.assertEqual(source.shape[1], 2)
        self.assertEqual({len(row[1]) for row in source}, {64})
        return dict(f.attrs)

    def test_flexible_body(self):
        self.write("panel.bdf", PANEL)
        self.bough("reduce", "panel.bdf", "--modes", 3, "--interface", "5,7", "--full", "-o", "b.h5")
        n, p, ndof, g, ne = 3, 9, 55, 9, 12
        gamma = {"gamma0": (n, 3), "gamma1": (n, 3), "gamma2": (n, n, 3), "gamma3": (n, 3, 3), "gamma4": (n, n, 3, 3)}
        shapes = {"/rigid/mass": (1,), "/rigid/cg": (3,), "/rigid/inertia": (3, 3), "/nodes/id": (p,), "/nodes/xyz": (p, 3),
                  "/modes/frequency_hz": (n,), "/modes/eigenvalue": (n,), "/modes/kind": (n,), "/modes/phi": (p, 6, n),
                  "/modal/mass": (n, n), "/modal/stiffness": (n, n), "/modal/damping": (n, n),
                  "/inertial_loads/f": (ndof, 12), "/dof_map": (ndof, 2), "/full/phi": (ndof, n),
                  "/stiffening/kg_inertial": (12, n, n), "/stiffening/kg_external": (ne, n, n),
                  "/stiffening/locator/name": (ne,), "/stiffening/locator/node": (ne,),
                  "/stiffening/locator/direction": (ne,), "/effective_mass": (n, 6), "/grids/id": (g,), "/grids/xyz": (g, 3),
                  "/mesh/elements/quad4/connectivity": (3, 4)}
        for method in ["lumped", "consistent", "exact"]:
            shapes |= {f"/integrals/{method}/{name}": shape for name, shape in gamma.items()}
        root = self.demand("b.h5", shapes)
        self.assertEqual(root["format"], "bough-flexbody")
        with h5py.File(self.path("b.h5")) as f:
            self.assertIn(f["/integrals"].attrs["method"], ["lumped", "consistent", "exact"])
            self.assertEqual(list(f["/stiffening/kg_inertial"].attrs["computed"]), [1] * 12)
            dof, full, phi = f["/dof_map"][:], f["/full/phi"][:], f["/modes/phi"][:]
            # Every dof of the g-set: grids by id with six rows each, then the scalar point.
            self.assertEqual(dof.tolist(), [[grid, code] for grid in range(1, 10) for code in range(1, 7)] + [[20, 0]])
            np.testing.assert_allclose(full[:54].reshape(9, 6, n), phi, atol=1e-12 * np.abs(phi).max())
            self.assertEqual(np.abs(full[:12]).max(), 0)               # held by the SPC
            np.testing.assert_allclose(phi[7, 2], phi[6, 2], rtol=1e-9)    # the MPC's dependent row
            arm = phi[5, :3] + np.cross(phi[5, 3:], [0, 0.5, 0], axis=0)   # grid 9 hangs on grid 6
            np.testing.assert_allclose(phi[8, :3], arm, atol=1e-9 * np.abs(phi).max())

    def test_modes_and_matrices(self):
        self.write("panel.bdf", PANEL)
        self.bough("modes", "panel.bdf", "-o", "m.h5", "--vtu", "m.vtu")
        root = self.demand("m.h5", {"/rigid/mass": (1,), "/rigid/cg": (3,), "/rigid/inertia": (3, 3), "/nodes/id": (9,),
                                    "/modes/frequency_hz": (3,), "/modes/eigenvalue": (3,), "/modes/kind": (3,),
                                    "/modes/phi": (9, 6, 3), "/effective_mass": (3, 6)})
        self.assertEqual(root["format"], "bough-modes")
        self.bough("modes", "panel.bdf", "--buckling", "-o", "k.h5")
        with h5py.File(self.path("k.h5")) as f:
            self.assertEqual(f["/buckling/load_factor"].shape, (3,))
        self.bough("matrices", "panel.bdf", "-o", "k.h5")
        root = self.demand("k.h5", {"/dof_map": (55, 2), "/grids/id": (9,), "/grids/xyz": (9, 3)})
        self.assertEqual(root["format"], "bough-matrices")
        with h5py.File(self.path("k.h5")) as f:
            for name in ["K", "M", "KG/LOAD_3"]:
                self.assertEqual(sorted(f[name]), ["data", "indices", "indptr", "shape"])
                self.assertEqual(f[name]["shape"][:].tolist(), [55, 55])

    def test_results(self):
        self.write("panel.bdf", PANEL)
        self.write("pendulum.toml", PENDULUM)
        self.bough("reduce", "panel.bdf", "--modes", 3, "--interface", "7")
        self.bough("run", "pendulum.toml")
        nt = 6
        shapes = {"/time": (nt,), "/hinges/pivot/q": (nt,), "/hinges/pivot/qdot": (nt,), "/sensors/tip": (nt, 3),
                  "/energy/kinetic": (nt,), "/energy/strain": (nt,), "/energy/potential": (nt,), "/energy/work": (nt,),
                  "/momentum/linear": (nt, 3), "/momentum/angular": (nt, 3), "/system": ()}
        shapes |= {f"/bodies/arm/{name}": (nt, size) for name, size in
                   [("position", 3), ("quaternion", 4), ("velocity", 3), ("angular_velocity", 3), ("eta", 3), ("eta_dot", 3)]}
        root = self.demand("pendulum.h5", shapes)
        self.assertEqual(root["format"], "bough-results")
        with h5py.File(self.path("pendulum.h5")) as f:
            for path in ["/hinges/pivot/force", "/events", "/checkpoint"]:
                self.assertIn(path, f)
            self.assertEqual(f["/system"].asstr()[()], PENDULUM)
            np.testing.assert_allclose(f["/bodies/arm/quaternion"][0], [1, 0, 0, 0], atol=1e-12)    # w x y z
            self.assertIsNone(f["/time"].maxshape[0])

    def test_flx_prints_every_block(self):
        self.write("panel.bdf", PANEL)
        self.bough("reduce", "panel.bdf", "--modes", 3)
        self.assertIn("written: panel.FLX", self.bough("flx", "panel.h5", "--special-nodes").stdout)
        blocks = json.loads(self.bough("flx", "--read", "panel.FLX", "--json").stdout)
        for name in ["body_id", "name", "modopt", "method", "mass", "modes", "generalized_mass", "generalized_stiffness",
                     "generalized_damping", "alpha", "gamma0", "gamma1", "gamma2", "gamma3", "gamma4", "nodes", "gains",
                     "special_nodes"]:
            self.assertIn(name, blocks)
        self.assertEqual(len(blocks["special_nodes"]["id"]), 3 + 1)


class PanelTest(ProgramTest):
    def swing_panel(self):
        """The panel, its reduction and a run of it as a pendulum."""
        self.write("panel.bdf", PANEL)
        self.write("pendulum.toml", PENDULUM)
        self.bough("reduce", "panel.bdf", "--modes", 3)
        self.bough("run", "pendulum.toml")


class Outputs(PanelTest):
    def make_files(self):
        self.swing_panel()
        self.bough("flx", "panel.h5")

    def read_all(self):
        texts = {}
        for name in os.listdir(self.folder):
            with open(self.path(name), "rb") as f:
                texts[name] = f.read()
        return texts

    def calls(self):
        """Verbs that write, without their -o."""
        return [["modes", "panel.bdf"], ["static", "panel.bdf"], ["matrices", "panel.bdf"],
                ["matrices", "panel.bdf", "--to", "op4"], ["reduce", "panel.bdf", "--modes", 3], ["flx", "panel.h5"],
                ["flx", "--read", "panel.FLX"], ["compare", "panel.h5"], ["run", "pendulum.toml"],
                ["plot", "pendulum.h5", "--sensor", "tip"], ["export", "pendulum.h5", "--to", "csv"], ["report", "pendulum.h5"],
                ["export", "panel.bdf", "--to", "bdf"]] + \
               [["export", "panel.h5", "--to", kind] for kind in ["csv", "vtu", "mat", "op4", "uff", "sid", "mbdyn", "flat"]]

    def test_an_input_is_never_overwritten(self):
        self.make_files()
        before = self.read_all()
        for call in self.calls():
            source = next(word for word in map(str, call) if "." in word)
            if call[0] == "plot":
                continue    # its ending is refused before
            with self.subTest(" ".join(map(str, call))):
                self.fails(1, *call, "-o", os.path.join(".", source), error="cli.output-is-input")
        self.assertEqual(before, self.read_all())

    def test_a_folder_that_is_missing_is_told_before_the_work(self):
        self.make_files()
        for call in self.calls():
            with self.subTest(" ".join(map(str, call))):
                result = self.fails(3, *call, "-o", "none/x.svg", says=["none"], error="cli.write")
                self.assertEqual(result.stdout, "")
        self.fails(3, "modes", "panel.bdf", "-o", ".", says=["is a folder"], error="cli.write")
        self.fails(3, "export", "panel.h5", "--to", "csv", "-o", "/dev/null", says=["no regular file"], error="cli.write")

    def test_a_full_disk_is_an_error_and_leaves_nothing_behind(self):
        self.make_files()
        before = sorted(os.listdir(self.folder))
        for call in self.calls():
            with self.subTest(" ".join(map(str, call))):
                result = subprocess.run([PROGRAM, *map(str, call), "-o", "out.svg"], cwd=self.folder, capture_output=True,
                                        text=True, preexec_fn=cap_files(600))
                self.assertEqual(result.returncode, 3, result.stderr)
                self.assertRegex(result.stderr, r"out\.svg: error: .*; check .*(space|permissions)")
                if call[0] != "run":    # a results file is kept as far as it went
                    self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_what_is_written_is_named(self):
        self.make_files()
        for call in self.calls():
            with self.subTest(" ".join(map(str, call))):
                self.assertIn("written: out.svg", self.bough(*call, "-o", "out.svg").stdout)


class Pictures(PanelTest):
    def test_png_and_pdf(self):
        self.swing_panel()
        plot = ["plot", "pendulum.h5", "--sensor", "tip"]
        self.fails(1, *plot, "-o", "tip.jpg", says=[".png"], error="cli.picture-format")
        # Without the converter: a clear message, no file.
        result = self.bough(*plot, "-o", "tip.png", code=3, env={"PATH": self.folder})
        self.assertIn("[cli.no-converter]", result.stderr)
        self.assertEqual([name for name in os.listdir(self.folder) if "tip" in name], [])
        if not shutil.which("rsvg-convert"):
            self.skipTest("rsvg-convert (librsvg2-bin) is not installed")
        for ending, head in [("png", b"\x89PNG"), ("pdf", b"%PDF")]:
            self.bough(*plot, "-o", f"tip.{ending}")
            with open(self.path(f"tip.{ending}"), "rb") as f:
                self.assertEqual(f.read(4), head)


class Demo(ProgramTest):
    def test_the_demo_leaves_its_results(self):
        os.mkdir(self.path("bin"))
        os.symlink(PROGRAM, self.path("bin/bough"))
        ran = subprocess.run([os.path.join(SOURCE, "tools/demo"), self.folder], capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        for name in ["spinup.h5", "spinup-no-kg.h5"]:
            with h5py.File(self.path("demo/" + name)) as f:
                self.assertEqual(f["/sensors/tip_deflection"].shape, (f["/time"].shape[0], 3))
        self.assertTrue(os.path.exists(self.path("demo/report.md")))


if __name__ == "__main__":
    unittest.main()
