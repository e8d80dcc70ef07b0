"""Input without end or measure is told in a moment: names, includes, repeats, numbers, signs."""
import json
import os
import unittest
import xml.dom.minidom

from support import BEAM, ProgramTest


class Limits(ProgramTest):
    def test_long_names(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        with open(self.path("spinup.toml")) as f:
            text = f.read()
        for length in (1001, 40000, 2000000):
            self.write("long.toml", text.replace('name = "tip_deflection"', f'name = "{"x" * length}"'))
            for verb in ("check", "run"):
                said = self.fails(1, verb, "long.toml", says=[f"has {length} letters"], error="toml.bad-name").stderr
                self.assertLess(len(said), 1000)
        self.write("long.toml", text.replace('name = "tip_deflection"', f'name = "{"x" * 1000}"'))
        self.bough("check", "long.toml")

    def test_includes_over_many_levels(self):
        for k in range(300):
            self.write(f"d{k}.bdf", f"INCLUDE 'd{k + 1}.bdf'\n")
        self.write("d300.bdf", "GRID,9,,3.,0.,0.\n")
        deck = BEAM.replace("BEGIN BULK\n", "BEGIN BULK\nINCLUDE 'd{}.bdf'\n")
        self.write("deep.bdf", deck.replace("{}", "0"))
        self.fails(1, "check", "deep.bdf", says=["over more than 100 levels", "d"], error="deck.include-many")
        self.write("deep.bdf", deck.replace("{}", "220"))
        self.bough("check", "deep.bdf")

    def test_includes_that_double(self):
        for k in range(30):
            self.write(f"d{k}.bdf", f"INCLUDE 'd{k + 1}.bdf'\n" * 2)
        self.write("d30.bdf", "$ the end\n")
        self.write("twice.bdf", BEAM.replace("BEGIN BULK\n", "BEGIN BULK\nINCLUDE 'd0.bdf'\n"))
        self.fails(1, "check", "twice.bdf", says=["more than 20000 files"], error="deck.include-many")
        self.write("big.bdf", "$" + "x" * 70_000_000 + "\n")
        self.write("twice.bdf", BEAM.replace("BEGIN BULK\n", "BEGIN BULK\n" + "INCLUDE 'big.bdf'\n" * 40))
        self.fails(1, "check", "twice.bdf", says=["a gigabyte"], error="deck.include-many")

    def test_repeats(self):
        lines = "GRID,{0},,5.,0.,0.\n=,*1,==\n={1},\n"
        self.write("repeat.bdf", BEAM.replace("GRID,3", lines.format(10, 1000000000) + "GRID,3"))
        self.fails(1, "check", "repeat.bdf", says=["1000000000, expected 1 to 1000000"], error="deck.bad-replication")
        many = "".join(lines.format(k * 1000000, 700000) for k in (1, 2, 3))
        self.write("repeat.bdf", BEAM.replace("GRID,3", many + "GRID,3"))
        self.fails(1, "check", "repeat.bdf", says=["more than 2000000 cards"], error="deck.bad-replication")
        # A wrong card stays wrong a million times.
        self.write("wrong.bdf", "BEGIN BULK\nGRID,1,,x,0.,0.\n=,*1,==\n=999999\nENDDATA\n")
        self.fails(1, "modes", "wrong.bdf", says=["1000 errors of its copies; the other"],
                   error="deck.bad-replication")

    def read_many(self, code, name, says):
        said = self.bough("check", name, code=code).stderr
        self.assertIn(says, said)
        self.assertLess(len(said), 20000)

    def test_words_without_end(self):
        def make_word(k):
            return "Q" + "".join(chr(65 + k // 26**i % 26) for i in range(5))

        words = [make_word(k) for k in range(60000)]
        self.write("cards.bdf", BEAM.replace("ENDDATA", "\n".join(w + ",1,2" for w in words) + "\nENDDATA"))
        self.read_many(1, "cards.bdf", "[deck.unknown-card]")
        self.write("params.bdf", BEAM.replace("ENDDATA", "\n".join(f"PARAM,{w},2" for w in words[:20000]) + "\nENDDATA"))
        self.read_many(0, "params.bdf", "[deck.unknown-param]")
        self.write("control.bdf", BEAM.replace("BEGIN BULK", "\n".join(words) + "\nBEGIN BULK"))
        self.read_many(0, "control.bdf", "more")
        self.write("subcases.bdf", BEAM.replace("BEGIN BULK", "SUBCASE 7\n" * 20000 + "BEGIN BULK"))
        self.read_many(1, "subcases.bdf", "subcase 7 is defined twice")

    def test_includes_that_are_missing(self):
        lines = [f"GRID,{k + 100},,{k}.,0.,0.\nINCLUDE 'n{k}.bdf'" for k in range(30000)]
        self.write("missing.bdf", BEAM.replace("ENDDATA", "\n".join(lines) + "\nENDDATA"))
        self.read_many(1, "missing.bdf", "more than 20000 files")

    def test_continuations_that_all_look_for_one_line(self):
        n = 60000
        lines = ["GRID,7,,1.,0.,0.,,,,+C"] + ["+A,,,,,,,,,+B"] * n + ["+B,,,,,,,,,+A"] * n
        self.write("tags.bdf", BEAM.replace("ENDDATA", "\n".join(lines) + "\nENDDATA"))
        self.bough("check", "tags.bdf", code=1)

    def test_pipes_and_devices_are_no_tables(self):
        """A pipe is waited for, a device has no end: what a file of a stranger names is a file or nothing."""
        os.mkfifo(self.path("pipe"))
        self.write("beam.bdf", BEAM)
        for place in ("pipe", "/dev/zero"):
            self.write("top.toml", '[[body]]\nname = "top"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n'
                       '[[hinge]]\nname = "h"\ntype = "revolute"\nchild = "top"\nmotion = "f"\n'
                       f'[[function]]\nname = "f"\ntype = "table"\nfile = "{place}"\n'
                       '[simulation]\nduration = 1.0\noutput_step = 0.1\n')
            self.fails(1, "check", "top.toml", says=["cannot be opened"], error="toml.table-file")
            self.write("study.toml", f'[campaign]\nmethod = "list"\ntable = "{place}"\nsteps = ["check beam.bdf"]\n'
                       '[[parameter]]\nname = "E"\nfile = "beam.bdf"\ncard = "MAT1"\nid = 1\nfield = "E"\n')
            self.fails(1, "batch", "study.toml", says=["cannot be opened"], error="batch.bad-table")
            for verb in ("check", "modes", "reduce", "run", "flx", "info", "batch"):
                self.fails(1, verb, place)

    def test_check_sees_what_reduce_refuses(self):
        body = '[body]\nname = "b"\ndeck = "b.bdf"\n{}[body.modes]\nnumber = 2\n'
        for spc, spring, frame, error in (("SPC1", "", "", None), ("$SPC1", "", "", "reduce.mechanism"),
                                          ("SPC1", "", 'frame = "free"\n', None),
                                          ("SPC1", "CELAS2,9,100.,3,1\n", 'frame = "free"\n', "reduce.grounded"),
                                          ("SPC1", "CELAS2,9,100.,3,2,2,2\n", 'frame = "free"\n', "reduce.grounded"),
                                          ("SPC1", "CELAS2,9,100.,3,1,2,1\n", 'frame = "free"\n', None)):
            self.write("b.bdf", BEAM.replace("SPC1,1,", spc + ",1,").replace("SPC = 1\n", "SPC = 1\n" * (spc == "SPC1"))
                       .replace("ENDDATA", spring + "ENDDATA"))
            self.write("b.toml", body.format(frame))
            for verb, more in (("check", []), ("reduce", ["-o", "b.h5"])):
                if error:
                    self.fails(1, verb, "b.toml", *more, error=error, says=["CELASi between grids that lie apart"] if spring else [])
                else:
                    self.bough(verb, "b.toml", *more)

    def test_negative_spring_is_named(self):
        self.write("y.bdf", "SOL 103\nCEND\nSPC=1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,0.,0.,0.\n"
                   "CELAS2,7,-1.,1,1,2,1\nCONM2,5,2,,1.\nSPC1,1,123456,1\nSPC1,1,23456,2\nENDDATA\n")
        result = self.bough("modes", "y.bdf", "--json")
        self.assertIn("1 mode has negative stiffness", result.stderr)
        self.assertIn("CELAS2 7 has negative stiffness", result.stderr)
        self.assertIn("[modal.unstable]", result.stderr)
        self.assertAlmostEqual(json.loads(result.stdout)["modes"][0]["eigenvalue"], -1, delta=1e-12)

    def test_negative_net_stiffness_is_no_mechanism(self):
        """1 - 3 against ground: AUTOSPC holds what has no stiffness, not what has less than none."""
        deck = ("SOL {}\nCEND\nSPC=1\nLOAD=9\nDISP=ALL\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCELAS2,6,1.,1,1,2,1\n"
                "CELAS2,7,-3.,2,1\nCELAS2,8,5.,2,2\nCONM2,5,2,,2.\nCONM2,4,1,,2.\nSPC1,1,123456,1\nFORCE,9,2,,4.,1.,1.,0.\nENDDATA\n")
        self.write("z.bdf", deck.format(103))
        result = self.bough("modes", "z.bdf", "--json")
        self.assertIn("[modal.unstable]", result.stderr)
        values = [mode["eigenvalue"] for mode in json.loads(result.stdout)["modes"]]
        for value, wanted in zip(values, (-1, 2.5)):
            self.assertAlmostEqual(value, wanted, delta=1e-12)
        self.write("zs.bdf", deck.format(101))
        self.bough("static", "zs.bdf", "-o", "zs.h5")
        import h5py
        with h5py.File(self.path("zs.h5")) as f:
            found = []
            f.visititems(lambda name, item: found.append(item[:]) if name.endswith("displacement") else None)
        self.assertAlmostEqual(found[0].reshape(-1, 6)[1, 0], -2, delta=1e-12)
        self.assertAlmostEqual(found[0].reshape(-1, 6)[1, 1], 0.8, delta=1e-12)

    def test_sets_that_contain_themselves(self):
        self.write("c.bdf", BEAM.replace("SPC = 1", "SPC = 7").replace("ENDDATA", "SPCADD,7,8,1\nSPCADD,8,7\nENDDATA"))
        result = self.bough("modes", "c.bdf")
        self.assertRegex(result.stderr, r"c.bdf:\d+: warning: SPC set 7 contains itself.*\[fe.circular-set\]")
        self.write("c.bdf", BEAM.replace("SPC = 1", "SPC = 7").replace("ENDDATA", "SPCADD,7,8,9\nSPCADD,8,1\nSPCADD,9,1\nENDDATA"))
        self.assertNotIn("circular", self.bough("modes", "c.bdf").stderr)

    def test_names_of_outputs_are_names(self):
        self.write("b.bdf", BEAM)
        self.assertIn("the name is empty", self.fails(2, "modes", "b.bdf", "-o", "").stderr)

    def test_elements_at_scalar_points_are_not_drawn(self):
        self.write("s.bdf", BEAM.replace("ENDDATA", "SPOINT,90\nCELAS2,91,4.,90\nCMASS2,92,1.,90\nCELAS2,93,1.,90,,3,2\nENDDATA"))
        self.bough("reduce", "s.bdf", "--modes", "3", "-o", "s.h5")
        self.bough("info", "s.h5")
        self.bough("report", "s.h5", "-o", "s.html")

    def test_more_modes_than_dofs(self):
        grids = [f"GRID,{k},,{k}.,0.,0." for k in range(4, 300)]
        bars = [f"CBAR,{k},1,{k},{k + 1},0.,1.,0." for k in range(3, 299)]
        self.write("line.bdf", BEAM.replace("ENDDATA", "\n".join(grids + bars + ["ENDDATA"])))
        self.fails(1, "modes", "line.bdf", "-n", 2147483647, says=["the model has 1788 free dofs"],
                   error="modal.more-than-dofs")
        self.bough("modes", "line.bdf", "-n", 3)

    def test_impossible_inertia(self):
        self.write("top.toml", '[[body]]\nname = "top"\nmass = 1.0\ninertia = [0.1, 0.1, 5.0, 0.0, 0.0, 0.0]\n'
                   '[[hinge]]\nname = "h"\ntype = "free"\nparent = "ground"\nchild = "top"\n'
                   '[simulation]\nduration = 1.0\noutput_step = 0.1\n')
        self.fails(1, "check", "-q", "top.toml", says=["top.toml:4: error: no body has the inertia"],
                   error="toml.bad-value")

    def test_energy_without_end(self):
        self.write("wheel.toml", '[[body]]\nname = "wheel"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n'
                   '[[hinge]]\nname = "h"\ntype = "revolute"\nchild = "wheel"\nrate = 1e200\n'
                   '[simulation]\nduration = 1.0\n')
        self.fails(3, "run", "wheel.toml", says=["(hinge rate 1) reached 1e+200", "the energy is no finite number"],
                   error="run.diverged")

    def test_names_that_no_message_can_hold(self):
        self.write("nul.toml", '[[body]]\nname = "a\\u0000b\\u001b"\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n'
                   '[simulation]\nduration = 1.0\n')
        self.fails(1, "check", "nul.toml", says=["a\\x00b\\x1b", "rename it"], error="toml.bad-name")

    def test_pictures_are_xml_whatever_the_title(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        with open(self.path("spinup.toml")) as f:
            self.write("short.toml", f.read().replace("duration = 20.0", "duration = 0.2"))
        self.bough("run", "short.toml")
        self.bough("plot", "short.h5", "--sensor", "tip_deflection:y", "--title", "a\x01b <&\udcff", "-o", "p.svg")
        title = xml.dom.minidom.parse(self.path("p.svg")).toxml()
        self.assertIn("ab &lt;&amp;\ufffd", title)


if __name__ == "__main__":
    unittest.main()
