"""Each command does its work on a small model."""
import csv
import io
import json
import math
import signal
import unittest

import h5py
import numpy as np

from support import BEAM, HANG, HOLD, IN_OUTPUTS, ProgramTest, get_astray
from toml_text import Bare, section, table, toml

# EI = 700 both ways, 40 bars of a pinned column, 10 m, compressed by 1 N: the load factor is Euler's load in N.
def make_column():
    lines = ["SOL 105", "CEND", "SPC = 1", "SUBCASE 1", "LOAD = 4", "SUBCASE 2", "METHOD = 5", "STATSUB = 1", "BEGIN BULK",
             "EIGRL,5,,,1", "GRDSET,,,,,,,345", "SPC1,1,12,1", "SPC1,1,2,41", "FORCE,4,41,,1.,-1.,0.,0.",
             "PBAR,1,1,1.-3,1.-8,1.-8,1.-8", "MAT1,1,7.+10,,.3,2700."]
    lines += [f"GRID,{i + 1},,{0.25 * i},0.,0." for i in range(41)]
    lines += [f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0." for i in range(40)]
    return "\n".join(lines + ["ENDDATA", ""])


SPRING = toml(
    table("body", "bob", mass=2.0, inertia=[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0], stiffness=[8.0], position=[0.5]),
    table("sensor", "where", "position", body="bob"),
    section("simulation", duration=Bare("DURATION"), output_step=0.01, relative_tolerance=1e-10,
            absolute_tolerance=1e-12))


# The bars alone have no inertia about their own line.
BULKY = BEAM.replace("ENDDATA", "CONM2,9,3,,0.1,,,,,+\n+,0.01,,0.01,,,0.01\nENDDATA")


class Check(ProgramTest):
    def test_deck_summary(self):
        self.write("beam.bdf", BEAM.replace("ENDDATA", "TABLED1,9\nENDDATA"))
        text = self.bough("check", "beam.bdf").stdout
        for words in ["CBAR", "TABLED1", "skipped", "mass properties", "centre of mass", "ground check", "AUTOSPC"]:
            self.assertIn(words, text)
        self.assertNotIn("FAIL", text)
        data = json.loads(self.bough("check", "beam.bdf", "--json").stdout)
        self.assertAlmostEqual(data["mass_properties"]["mass"], 2 * 1e-4 * 2700, places=12)
        self.assertAlmostEqual(data["mass_properties"]["cg"][0], 1.0, places=12)
        self.assertEqual(data["cards"]["GRID"], 3)
        self.assertLess(max(map(abs, data["ground_check"])), 1e-10)

    def test_sections_by_dimensions_are_printed(self):
        tube = "PBARL,7,1,,TUBE,,,,,+\n+,.02,.01,.3\n"
        tee = "PBEAML,8,1,,T,,,,,+\n+,.03,.04,.005,.004\n"
        self.write("beam.bdf", BEAM.replace("ENDDATA", tube + tee + "ENDDATA"))
        text = self.bough("check", "beam.bdf").stdout
        self.assertIn("PBARL 7", text)
        rows = json.loads(self.bough("check", "beam.bdf", "--json").stdout)["sections"]
        self.assertEqual([(r["card"], r["id"], r["x_over_L"]) for r in rows],
                         [("PBARL", 7, 0), ("PBEAML", 8, 0), ("PBEAML", 8, 1)])
        self.assertAlmostEqual(rows[0]["A"], math.pi * 3e-4, places=12)
        self.assertAlmostEqual(rows[0]["J"], math.pi / 2 * 15e-8, places=15)
        self.assertEqual((rows[0]["K1"], rows[0]["NSM"]), (0.5, 0.3))
        self.assertAlmostEqual(rows[1]["A"], .03 * .005 + .035 * .004, places=12)
        self.assertLess(rows[1]["N1"], 0)

    def test_all_dofs_prescribed_and_spcd_that_no_spc_holds(self):
        bulk = ("GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,1.-8,5.-9,1.-8\n"
                "MAT1,1,7.+10,,.3\nSPC1,1,123456,1\nSPC1,2,123456,1,2\nSPCD,4,2,1,.01\nFORCE,5,2,,3.,0.,1.,0.\n")
        self.write("held.bdf", "SOL 101\nCEND\nSUBCASE 1\nSPC=2\nLOAD=4\nSUBCASE 2\nSPC=1\nLOAD=4\nSUBCASE 3\nSPC=1\n"
                               "LOAD=5\nBEGIN BULK\n" + bulk + "ENDDATA\n")
        done = self.bough("static", "held.bdf", "--json", "--full")
        self.assertIn("fe.spcd-not-fixed", done.stderr)
        cases = json.loads(done.stdout)["subcases"]
        for case in cases[:2]:  # EA d / L, whether an SPC holds the dof or not
            self.assertAlmostEqual(case["displacement"][6], .01, places=15)
            self.assertAlmostEqual(case["reaction"][6] / (7e7 * .01 / 2), 1, places=12)
        # The dof of SPCD is free again for the next load.
        self.assertAlmostEqual(cases[2]["displacement"][7] / (3 * 8 / (3 * 700)), 1, places=9)
        self.assertAlmostEqual(cases[2]["resultants"]["reaction"][1], -3, places=9)

    def test_body_system_and_hdf5(self):
        self.write("beam.bdf", BEAM)
        self.write("body.toml", toml(
            section("body", name="b", deck="beam.bdf"),
            section("body.modes", number=2),
            section("body.output", file="b.h5")))
        self.assertEqual(json.loads(self.bough("check", "body.toml", "--json").stdout)["kind"], "body")
        self.bough("reduce", "body.toml")
        self.assertEqual(json.loads(self.bough("check", "b.h5", "--json").stdout)["num_modes"], 2)
        self.bough("modes", "beam.bdf", "-o", "m.h5")
        self.assertEqual(json.loads(self.bough("check", "m.h5", "--json").stdout)["kind"], "bough-modes")
        self.write("system.toml", SPRING.replace("DURATION", "0.1"))
        self.assertEqual(json.loads(self.bough("check", "system.toml", "--json").stdout)["num_speeds"], 1)
        self.bough("run", "system.toml", "-o", "r.h5")
        self.assertTrue(json.loads(self.bough("check", "r.h5", "--json").stdout)["completed"])


class Modes(ProgramTest):
    def test_table_and_file(self):
        self.write("beam.bdf", BEAM)
        text = self.bough("modes", "beam.bdf", "--mass", "consistent", "-o", "m.h5").stdout
        for words in ["eigenvalue", "modal mass", "effective mass", "residual", "rigid-body modes: 0", "none missed"]:
            self.assertIn(words, text)
        data = json.loads(self.bough("modes", "beam.bdf", "--mass", "consistent", "--json").stdout)
        for j, mode in enumerate(data["modes"]):
            self.assertEqual(mode["mode"], j + 1)
            for key in ["eigenvalue", "frequency_hz", "modal_mass", "residual", "effective_mass"]:
                self.assertEqual(mode[key], data[key][j])
        self.assertEqual(len(data["modes"]), len(data["eigenvalue"]))
        with h5py.File(self.path("m.h5")) as f:
            np.testing.assert_allclose(f["/modes/frequency_hz"][:], data["frequency_hz"], rtol=1e-12)
            self.assertEqual(f["/modes/phi"].shape, (3, 6, 3))
            self.assertEqual(f["/effective_mass"].shape, (3, 6))

    def test_number_overrules_the_deck(self):
        self.write("beam.bdf", BEAM)
        self.assertEqual(len(json.loads(self.bough("modes", "beam.bdf", "-n", 5, "--json").stdout)["eigenvalue"]), 5)

    def test_free_free_finds_six_rigid_modes(self):
        self.write("beam.bdf", BULKY)
        data = json.loads(self.bough("modes", "beam.bdf", "--free", "-n", 8, "--json", "--mass", "consistent").stdout)
        self.assertEqual(data["num_rigid_modes"], 6)

    def test_buckling_load_of_a_column(self):
        self.write("column.bdf", make_column())
        data = json.loads(self.bough("modes", "column.bdf", "--buckling", "--json").stdout)
        self.assertEqual([mode["load_factor"] for mode in data["modes"]], data["load_factor"])
        euler = math.pi**2 * 700 / 10**2
        self.assertAlmostEqual(data["load_factor"][0] / euler, 1, delta=1e-5)
        self.assertEqual([s["eps"] for s in data["solvers"]], ["krylovschur"])

    def test_eigensolver_is_named_and_chosen(self):
        self.write("beam.bdf", BEAM)
        options = ["modes", "beam.bdf", "--mass", "consistent", "-n", 3]
        plain = json.loads(self.bough(*options, "--json").stdout)
        self.assertEqual(set(plain["solvers"][0]), {"eps", "st", "factor", "solutions"})
        self.assertIn("eigensolver: SLEPc bough-low-rank, ST bough-factor, LL", self.bough(*options).stdout)
        for name, eps in [("block-lanczos", "bough-block-lanczos"), ("lanczos", "lanczos"), ("lapack", "lapack")]:
            other = json.loads(self.bough(*options, "--solver", name, "--json").stdout)
            self.assertEqual(other["solvers"][0]["eps"], eps)
            np.testing.assert_allclose(other["eigenvalue"], plain["eigenvalue"], rtol=1e-9)
        self.fails(1, *options, "--solver", "lanczoss", says=["lanczoss", "block-lanczos"], error="modal.unknown-solver")
        self.write("column.bdf", make_column())
        self.fails(3, "modes", "column.bdf", "--buckling", "--solver", "low-rank", says=["low rank"],
                   error="modal.unsuited-solver")

    def test_eigensolver_of_petsc_options(self):
        self.write("beam.bdf", BEAM)
        result = self.bough("modes", "beam.bdf", "-n", 3, "--json", env={"PETSC_OPTIONS": "-eps_type arnoldi"})
        self.assertEqual(json.loads(result.stdout)["solvers"][0]["eps"], "arnoldi")


class Reduce(ProgramTest):
    def test_a_deck_and_the_same_body_file_give_the_same_body(self):
        self.write("beam.bdf", BEAM)
        self.write("body.toml", toml(
            section("body", name="beam", deck="beam.bdf", interface=[3]),
            section("body.modes", number=2)))
        self.bough("reduce", "body.toml", "-o", "a.h5")
        self.bough("reduce", "beam.bdf", "--modes", 2, "--interface", 3, "-o", "b.h5")
        with h5py.File(self.path("a.h5")) as a, h5py.File(self.path("b.h5")) as b:
            for path in ["/modes/eigenvalue", "/modes/phi", "/stiffening/kg_inertial", "/stiffening/kg_external", "/rigid/inertia"]:
                np.testing.assert_array_equal(a[path][:], b[path][:])
            self.assertEqual(a.attrs["format"], "bough-flexbody")

    def test_eigensolver(self):
        self.write("beam.bdf", BEAM)
        for interface in [], ["--interface", 3]:
            result = self.bough("reduce", "beam.bdf", "--modes", 2, *interface, "--solver", "block-lanczos", "--json")
            self.assertEqual([s["eps"] for s in json.loads(result.stdout)["modes_check"]["solvers"]], ["bough-block-lanczos"])
        self.assertIn("eigensolver: SLEPc bough-low-rank", self.bough("reduce", "beam.bdf", "--modes", 2, "-o", "b.h5").stdout)

    def test_free_body_with_loads_and_full(self):
        self.write("beam.bdf", BULKY)
        self.bough("reduce", "beam.bdf", "--free", "--modes", 3, "--load", "tip=3:13", "--full", "--mass", "consistent",
                   "--origin", "1", "0", "0", "-o", "b.h5")
        with h5py.File(self.path("b.h5")) as f:
            self.assertEqual(f["/full/phi"].shape, (18, 3))
            self.assertEqual(f["/stiffening/kg_external"].shape[1:], (3, 3))
            # 0.54 kg of bars about x = 1, where the origin is now, and 0.1 kg at x = 2
            np.testing.assert_allclose(f["/rigid/cg"][:], [0.1 / 0.64, 0, 0], atol=1e-12)


class Run(ProgramTest):
    def test_oscillator_and_its_exports(self):
        self.write("spring.toml", SPRING.replace("DURATION", "3.0"))
        self.bough("run", "spring.toml")
        with h5py.File(self.path("spring.h5")) as f:
            t, x = f["/time"][:], f["/sensors/where"][:, 0]
            self.assertEqual(f.attrs["format"], "bough-results")
        np.testing.assert_allclose(x, 0.5 * np.cos(2 * t), atol=1e-7)
        rows = list(csv.reader(io.StringIO(self.bough("export", "spring.h5", "--to", "csv", "--channel", "where:x").stdout)))
        self.assertEqual(rows[0], ["time", "sensors/where:x"])
        np.testing.assert_array_equal(np.array(rows[1:], dtype=float)[:, 1], x)
        everything = self.bough("export", "spring.h5", "--to", "csv").stdout.splitlines()[0]
        self.assertIn("bodies/bob/quaternion:w", everything)
        self.bough("plot", "spring.h5", "--sensor", "where:x", "-o", "where.svg")
        with open(self.path("where.svg")) as f:
            self.assertIn("<svg", f.read())
        self.assertIn("/sensors/where", self.bough("info", "spring.h5").stdout)
        self.assertTrue(json.loads(self.bough("info", "spring.h5", "--json").stdout)["objects"])

    def test_a_signal_leaves_a_file_from_which_the_run_resumes_to_the_same_end(self):
        self.write("spring.toml", get_astray(IN_OUTPUTS, HOLD, 23.4, "where:x") + SPRING.replace("DURATION", "40.0"))
        quiet = {"ASTRAY": "0"}
        self.bough("run", "spring.toml", "-o", "whole.h5", env=quiet)
        process, _ = self.start_held("run", "spring.toml", "-o", "parts.h5")
        process.send_signal(signal.SIGTERM)
        _, stderr = process.communicate(timeout=HANG)
        self.assertEqual(process.returncode, 3)
        self.assertIn("cli.interrupted", stderr)
        with h5py.File(self.path("parts.h5")) as f:
            self.assertLess(f["/time"][-1], 30)
        self.assertIn("cli.incomplete-run", self.bough("check", "parts.h5").stderr)
        self.bough("run", "spring.toml", "-o", "parts.h5", "--resume", env=quiet)
        with h5py.File(self.path("parts.h5")) as a, h5py.File(self.path("whole.h5")) as b:
            self.assertEqual(a["/time"].shape, b["/time"].shape)
            np.testing.assert_allclose(a["/sensors/where"][:], b["/sensors/where"][:], atol=1e-6)
        self.assertIn("complete already", self.bough("run", "spring.toml", "-o", "parts.h5", "--resume", env=quiet).stdout)


class Info(ProgramTest):
    def test_arrays_unlike_the_layout_are_named(self):
        self.write("beam.bdf", BEAM)
        self.bough("reduce", "beam.bdf", "-n", "2", "-o", "b.h5")
        whole = self.bough("info", "b.h5").stdout
        self.assertNotIn("not as the layout", whole)
        self.assertNotIn("faults", json.loads(self.bough("info", "b.h5", "--json").stdout))
        with h5py.File(self.path("b.h5"), "r+") as f:
            del f["modal/mass"], f["modes/frequency_hz"].attrs["description"], f["modes/frequency_hz"].attrs["dims"]
            del f["modal/damping"]
            f["modal/damping"] = np.zeros((2, 3))
        faults = ["/modal/mass is missing, expected 2 x 2", "/modal/damping has the shape 2 x 3, expected 2 x 2"]
        text = self.bough("info", "b.h5").stdout
        self.assertTrue(text.endswith("not as the layout of the format:\n  " + "\n  ".join(faults) + "\n"), text)
        self.assertIn("natural frequency, cycles per unit of time [1/T]", text, "the description that the file lacks")
        self.assertEqual(json.loads(self.bough("info", "b.h5", "--json").stdout)["faults"], faults)
        self.fails(1, "check", "b.h5", says=["/modal/mass is missing", "/modal/damping has the shape 2 x 3"])


if __name__ == "__main__":
    unittest.main()
