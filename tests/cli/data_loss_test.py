"""Nothing of the user's is lost: not by two programs at once, a full disk, a signal, a link or a file of a stranger."""
import glob
import os
import itertools
import signal
import subprocess
import sys

from support import BEAM, HANG, HOLD, IN_OUTPUTS, PROGRAM, SLOWER, SOURCE, ProgramTest, get_astray, unittest

PARTS = "*.bough-part-*"


class Disks(ProgramTest):
    def test_a_disk_that_fails_at_any_write(self):
        """Every one of the last writes of a file: exit 3 with words, no signal, nothing left."""
        sys.path.insert(0, os.path.join(SOURCE, "tools"))
        from trials import PRELOAD
        self.write("preload.c", PRELOAD)
        subprocess.run(["cc", "-O1", "-w", "-shared", "-fPIC", "-o", self.path("preload.so"), self.path("preload.c"),
                        "-ldl"], check=True)
        self.write("beam.bdf", BEAM)

        def call(**more):
            environment = dict(os.environ, LD_PRELOAD=self.path("preload.so"), **more)
            return subprocess.run([PROGRAM, "reduce", "beam.bdf", "--modes", "2", "-o", "b.h5"], cwd=self.folder,
                                  env=environment, capture_output=True, text=True)

        self.assertEqual(call(TRIAL_LOG=self.path("count")).returncode, 0)
        os.remove(self.path("b.h5"))
        with open(self.path("count"), encoding="ascii") as f:
            writes = int(f.read())
        for at in range(max(1, writes - 12), writes + 1):
            result = call(TRIAL_AT=str(at), TRIAL_ERROR="5")
            self.assertEqual(result.returncode, 3, f"write {at} of {writes}: {result.stderr}")
            self.assertIn("error:", result.stderr)
            self.assertFalse(os.path.exists(self.path("b.h5")))
            self.assertEqual(glob.glob(self.path(PARTS)), [])


class Runs(ProgramTest):
    def setUp(self):
        super().setUp()
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        with open(self.path("spinup.toml")) as f:
            self.write("long.toml", get_astray(IN_OUTPUTS, HOLD, 15.0, "tip_deflection:y") + f.read())

    def stop(self, process):
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=HANG)
        self.assertEqual(process.returncode, 3, said)
        return said

    def start_long(self, *more):
        """A run that sleeps at t = 15; one that goes on sleeps again."""
        return self.start_held("run", "long.toml", "-o", "r.h5", *more)[0]

    def read_times(self):
        import h5py
        with h5py.File(self.path("r.h5"), "r") as f:
            return f["time"][:f.attrs["num_samples"]]

    def test_two_runs_do_not_write_one_file(self):
        first = self.start_long()
        self.fails(1, "run", "spinup.toml", "-o", "r.h5", error="hdf5.busy")
        self.fails(1, "run", "long.toml", "-o", "r.h5", "--resume", error="hdf5.busy")
        self.stop(first)
        first = self.start_long("--resume")
        self.fails(1, "run", "long.toml", "-o", "r.h5", "--resume", says=["r.h5: error: another process"],
                   error="hdf5.busy")
        # Whoever only reads is not kept away.
        self.assertIn("still goes on", self.bough("export", "r.h5", "--to", "csv", "-o", "r.csv").stderr)
        self.assertGreater(len(self.read_times()), 10)
        self.stop(first)
        times = self.read_times()
        self.assertTrue((times[1:] > times[:-1]).all())

    def test_nobody_else_writes_over_a_run(self):
        first = self.start_long()
        self.fails(1, "export", "boom.h5", "--to", "sid", "-o", "r.h5", error="hdf5.busy")
        self.stop(first)
        self.assertGreater(len(self.read_times()), 10)

    def test_run_whose_file_is_gone_says_so(self):
        for replaced in (False, True):
            first = self.start_long()
            if replaced:
                os.replace(self.path(self.write("mine.h5", "mine")), self.path("r.h5"))
            else:
                os.rename(self.path("r.h5"), self.path("moved.h5"))
            self.assertIn("taken its place" if replaced else "removed or renamed", self.stop(first))
            if replaced:
                with open(self.path("r.h5")) as f:
                    self.assertEqual(f.read(), "mine")
                os.remove(self.path("r.h5"))

    def test_what_is_read_is_not_written(self):
        """However the file came to be read: included, a matrix, a table, a body, a table of cases, by a link."""
        def refuse(kept, *words):
            with open(self.path(kept), "rb") as f:
                before = f.read()
            self.fails(1, *words, error="cli.output-is-input")
            with open(self.path(kept), "rb") as f:
                self.assertEqual(f.read(), before)

        head, bulk = BEAM.split("BEGIN BULK\n")
        self.write("grids.inc", bulk.replace("ENDDATA\n", ""))
        self.write("deck.bdf", head + "BEGIN BULK\nINCLUDE 'grids.inc'\nENDDATA\n")
        os.symlink("grids.inc", self.path("link.h5"))
        refuse("grids.inc", "modes", "deck.bdf", "-o", "grids.inc")
        refuse("grids.inc", "modes", "deck.bdf", "-o", "link.h5")
        refuse("grids.inc", "modes", "deck.bdf", "--vtu", "grids.inc")
        self.write("body.toml", '[body]\nname = "b"\ndeck = "deck.bdf"\n[body.modes]\nnumber = 2\n')
        refuse("grids.inc", "reduce", "body.toml", "-o", "grids.inc")
        refuse("grids.inc", "matrices", "deck.bdf", "-o", "grids.inc")
        refuse("boom.h5", "report", "boom.h5", "-o", "boom.h5")
        refuse("boom.h5", "run", "spinup.toml", "-o", "boom.h5")
        refuse("boom.h5", "linearize", "spinup.toml", "-o", "boom.h5")
        self.write("cases.csv", "modes\n2\n3\n")
        self.write("camp.toml", '[campaign]\nname = "c"\nmethod = "list"\ntable = "cases.csv"\nsteps = ["reduce body.toml"]\n'
                   '[[parameter]]\nname = "modes"\nfile = "body.toml"\nkey = "body.modes.number"\n')
        with open(self.path("cases.csv"), "rb") as f:
            before = f.read()
        self.fails(3, "batch", "camp.toml", "-o", "cases.csv")
        with open(self.path("cases.csv"), "rb") as f:
            self.assertEqual(f.read(), before)

    def test_results_of_a_stopped_run_say_so(self):
        self.stop(self.start_long())
        for words in (["export", "r.h5", "--to", "csv", "-o", "r.csv"], ["export", "r.h5", "--to", "mat", "-o", "r.mat"],
                      ["export", "r.h5", "--to", "uff", "-o", "r.uff"],
                      ["plot", "r.h5", "--sensor", "tip_deflection:y", "-o", "r.svg"], ["report", "r.h5", "-o", "r.html"]):
            said = self.bough(*words).stderr
            self.assertIn("r.h5: warning: the run did not complete; these are its results up to t = ", said)
            self.assertIn("[cli.incomplete-run]", said)
        self.bough("run", "spinup.toml", "-o", "r.h5", "-q")
        self.assertEqual(self.bough("export", "r.h5", "--to", "csv", "-o", "r.csv").stderr, "")

    def test_sensor_with_a_colon_is_exported(self):
        with open(self.path("spinup.toml")) as f:
            self.write("colon.toml", f.read().replace('name = "tip_deflection"', 'name = "a:b"')
                       .replace("duration = 20.0", "duration = 0.1"))
        self.bough("run", "colon.toml")
        self.assertIn("sensors/a:b:y", self.bough("export", "colon.h5", "--to", "csv").stdout.split("\n")[0])
        one = self.bough("export", "colon.h5", "--to", "csv", "--channel", "a:b:y").stdout
        self.assertEqual(one.split("\n")[0], "time,sensors/a:b:y")

    def test_body_file_does_not_choose_a_file_elsewhere(self):
        os.mkdir(self.path("case"))
        self.write("precious.txt", "mine")
        for name in ("boom.bdf", "boom.toml"):
            os.rename(self.path(name), self.path("case/" + name))
        with open(self.path("case/boom.toml")) as f:
            text = f.read()
        os.mkdir(self.path("elsewhere"))
        os.symlink("../elsewhere", self.path("case/link"))
        for place in ("../precious.txt", self.path("precious.txt"), "link/x.h5"):
            self.write("case/boom.toml", text.replace('"boom.h5"', f'"{place}"'))
            self.fails(1, "reduce", "case/boom.toml", says=["case/boom.toml: error:"], error="cli.output-outside")
        with open(self.path("precious.txt")) as f:
            self.assertEqual(f.read(), "mine")
        self.bough("reduce", "case/boom.toml", "-o", "own.h5")
        self.bough("reduce", "case/boom.toml", "--force-outside")
        self.assertTrue(os.path.exists(self.path("elsewhere/x.h5")))


class Files(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("beam.bdf", BEAM)

    def test_what_is_printed_goes_out_or_is_a_failure(self):
        self.bough("modes", "beam.bdf", "-o", "m.h5", "-q")
        for words in (["export", "m.h5", "--to", "csv"], ["modes", "beam.bdf", "--json"], ["modes", "beam.bdf"],
                      ["info", "m.h5"], ["--help"], ["--version"], ["check", "beam.bdf"]):
            for closed in (False, True):
                with open("/dev/full", "w") as full:
                    result = subprocess.run([PROGRAM, *words], cwd=self.folder, text=True, stderr=subprocess.PIPE,
                                            stdout=None if closed else full,
                                            preexec_fn=(lambda: os.close(1)) if closed else None)
                self.assertEqual(result.returncode, 3, words)
                self.assertIn("[cli.write]", result.stderr, words)

    def test_closed_stdout_is_not_the_next_file(self):
        result = subprocess.run([PROGRAM, "modes", "beam.bdf", "-o", "m.h5"], cwd=self.folder,
                                preexec_fn=lambda: os.close(1), stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, 3)
        self.bough("export", "m.h5", "--to", "csv")

    def test_two_outputs_are_two_files(self):
        os.symlink("a", self.path("b"))
        for second in ("a", "./a", "b"):
            self.fails(2 - 1, "modes", "beam.bdf", "-o", "a", "--vtu", second, error="cli.same-output")
        self.fails(1, "static", "beam.bdf", "-o", "a", "--vtu", "a", error="cli.same-output")
        self.assertFalse(os.path.exists(self.path("a")))

    def test_links_are_written_through(self):
        self.write("old.h5", "old")
        os.chmod(self.path("old.h5"), 0o640)
        os.mkdir(self.path("far"))
        for link, target in (("l.h5", "old.h5"), ("l.csv", "far/new.csv")):
            os.symlink(target, self.path(link))
        self.bough("modes", "beam.bdf", "-o", "l.h5")
        self.bough("export", "l.h5", "--to", "csv", "-o", "l.csv")
        for link, target in (("l.h5", "old.h5"), ("l.csv", "far/new.csv")):
            self.assertEqual(os.readlink(self.path(link)), target)
            self.assertGreater(os.path.getsize(self.path(target)), 1000 if link == "l.h5" else 10)
        self.assertEqual(os.stat(self.path("old.h5")).st_mode & 0o777, 0o640)
        os.symlink("round.h5", self.path("round.h5"))
        self.fails(3, "modes", "beam.bdf", "-o", "round.h5", error="cli.write")

    def test_signal_ends_with_exit_3_and_no_parts(self):
        """In the middle of the computation, and with the output file half written."""
        points = ({"call": "MPI_Allreduce", "count": 5}, {"call": "open", "path": "x.h5.bough-part-"})
        for at in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for words, point in itertools.product((["modes", "beam.bdf", "-n", "3", "-o", "x.h5"],
                                                   ["reduce", "beam.bdf", "-n", "3", "-o", "x.h5"]), points):
                process, _ = self.start_held(*words, **point)
                if "path" in point:
                    self.assertEqual(len(glob.glob(self.path(PARTS))), 1)
                process.send_signal(at)
                _, said = process.communicate(timeout=HANG)
                self.assertEqual(process.returncode, 3, (at, words, said))
                self.assertIn("[cli.interrupted]", said)
                self.assertEqual(glob.glob(self.path(PARTS)), [])
        self.assertFalse(os.path.exists(self.path("x.h5")))

    def test_parts_of_the_dead_are_removed_and_nothing_else(self):
        gone = self.write("m.h5.bough-part-999999", "cut")
        for name in ("m.h5.part-1", "m.h5.bough-part-mine", "n.h5.bough-part-999999"):
            self.write(name, "mine")
        os.symlink("beam.bdf", self.path("m.h5.bough-part-4"))
        self.bough("modes", "beam.bdf", "-o", "m.h5")
        self.assertFalse(os.path.exists(self.path(gone)))
        self.assertEqual(sorted(os.listdir(self.folder)), ["beam.bdf", "m.h5", "m.h5.bough-part-4",
                                                           "m.h5.bough-part-mine", "m.h5.part-1",
                                                           "n.h5.bough-part-999999"])
        with open(self.path("beam.bdf")) as f:
            self.assertEqual(f.read(), BEAM)

    @unittest.skipIf(SLOWER > 1, "the sanitizers need more address space")
    def test_limit_of_memory_is_told(self):
        told = 0
        for limit in range(170, 620, 30):  # in MB; below some 160 the libraries are not loaded
            result = subprocess.run(["bash", "-c", f"ulimit -v {limit}000; exec {PROGRAM} modes beam.bdf -n 3"],
                                    cwd=self.folder, text=True, capture_output=True, timeout=HANG,
                                    env={k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"})
            told += "[cli.no-memory]" in result.stderr
            if result.returncode != 127:
                self.assertIn(result.returncode, (0, 3), result.stderr)
                self.assertTrue(result.returncode == 0 or result.stderr)
        self.assertGreater(told, 0)


class Campaigns(ProgramTest):
    STUDY = ('[campaign]\nsteps = ["modes beam.bdf -n 1 -o m.h5"]\n'
             '[[parameter]]\nname = "E"\nfile = "beam.bdf"\ncard = "MAT1"\nid = 1\nfield = "E"\nvalues = [6e10, 7e10]\n')

    def setUp(self):
        super().setUp()
        self.write("beam.bdf", BEAM)
        self.write("study.toml", self.STUDY)

    def mine(self, *folders):
        for folder in folders:
            os.makedirs(self.path(folder))
            self.write(folder + "/t", "mine")

    def is_mine(self, folder):
        with open(self.path(folder + "/t")) as f:
            return f.read() == "mine"

    def test_folders_of_others_are_left_alone(self):
        self.mine("case-0001", "case-study")
        for more in ([], ["--restart"]):
            said = self.fails(1, "batch", "study.toml", "-o", ".", *more, error="batch.foreign-folder")
            self.assertIn("case-0001: error:", said.stderr)
        self.assertTrue(self.is_mine("case-0001") and self.is_mine("case-study"))
        os.rename(self.path("case-0001"), self.path("kept"))
        os.makedirs(self.path("case-0002"))  # empty: nothing to lose
        self.bough("batch", "study.toml", "-o", ".")
        self.mine("case-0009")
        self.bough("batch", "study.toml", "-o", ".", "--restart")
        self.assertTrue(self.is_mine("kept") and self.is_mine("case-study") and self.is_mine("case-0009"))
        self.assertTrue(os.path.exists(self.path("case-0001/m.h5")))

    def test_files_of_others_are_left_alone(self):
        for name, text in (("campaign.json", '{"name": "mine"}'), ("outcomes.csv", "a,b\n"), ("case-0002", "mine")):
            self.write(name, text)
            self.fails(1, "batch", "study.toml", "-o", ".", "--restart", says=[name], error="batch.foreign-folder")
            with open(self.path(name)) as f:
                self.assertEqual(f.read(), text)
            os.remove(self.path(name))
        os.symlink("beam.bdf", self.path("case-0001"))
        self.fails(1, "batch", "study.toml", "-o", ".", error="batch.foreign-folder")

    def test_steps_write_in_the_folder_of_their_case(self):
        self.write("precious.h5", "mine")
        for place in ("../../precious.h5", self.path("precious.h5")):
            self.write("study.toml", self.STUDY.replace("m.h5", place))
            self.fails(1, "batch", "study.toml", says=["study.toml:2: error:"], error="cli.output-outside")
        # A conflict by a value is found when the case is done.
        self.write("study.toml", self.STUDY.replace("m.h5", "{to}") +
                   '[[parameter]]\nname = "to"\nvalues = ["../../precious.h5"]\n')
        self.bough("batch", "study.toml", "-o", "s", code=3)
        with open(self.path("s/outcomes.csv")) as f:
            self.assertEqual(f.read().count("[cli.output-outside]"), 2)
        # A conflict by a link to an input.
        self.write("study.toml", self.STUDY.replace('steps', 'files = ["precious.h5"]\nsteps').replace("m.h5", "precious.h5"))
        self.bough("batch", "study.toml", "-o", "l", code=3)
        with open(self.path("precious.h5")) as f:
            self.assertEqual(f.read(), "mine")
        self.write("study.toml", self.STUDY.replace("m.h5", "../../free.h5"))
        self.bough("batch", "study.toml", "-o", "f", "-j", 1, "--force-outside")
        self.assertTrue(os.path.exists(self.path("free.h5")))

    def test_name_of_a_campaign_is_no_path(self):
        for name in ("..", ".", "a/b", "a\\u0000b", ""):
            self.write("study.toml", self.STUDY.replace("steps", f'name = "{name}"\nsteps'))
            self.fails(1, "batch", "study.toml", error="toml.bad-name")

    def test_cells_are_no_formulas(self):
        self.write("study.toml", '[campaign]\nsteps = ["modes beam.bdf -n 1"]\n[[parameter]]\nname = "=1+1"\n'
                   'values = ["=HYPERLINK(1)", "@SUM(1)", "-5", "-x", "plain"]\n')
        self.bough("batch", "study.toml", "-o", "s")
        with open(self.path("s/outcomes.csv")) as f:
            lines = f.read().split("\n")
        self.assertTrue(lines[0].startswith("case,'=1+1,"), lines[0])
        self.assertEqual([line.split(",")[1] for line in lines[1:6]],
                         ["'=HYPERLINK(1)", "'@SUM(1)", "-5", "'-x", "plain"])


if __name__ == "__main__":
    unittest.main()
