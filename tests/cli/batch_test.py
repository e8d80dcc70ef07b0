"""bough batch: cases, files of a case, resuming, shards, failures, crashes, the table against direct runs."""
import csv
import fcntl
import json
import math
import os
import re
import shutil
import signal
import subprocess

from support import BEAM, HANG, HOLD, IN_OUTPUTS, PROGRAM, SOURCE, ProgramTest, get_astray, launch_ranks, unittest
from toml_text import section, table, toml

E = table("parameter", "E", file="beam.bdf", card="MAT1", id=1, field="E")
HZ = table("collect", "hz", json="/frequency_hz")
SLIDE = toml(
    table("body", "bob", mass=2.0),
    table("hinge", "slide", "prismatic", child="bob", axis=[1.0, 0.0, 0.0], stiffness=[50.0], position=[0.1]),
    section("simulation", duration=400.0, integrator="rk4", step=1e-3, output_step=1.0))


class BatchTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("beam.bdf", BEAM)

    def campaign(self, text, head='steps = ["modes beam.bdf"]', name="study.toml"):
        return self.write(name, f"[campaign]\n{head}\n{text}")

    def table(self, folder="study"):
        with open(self.path(folder + "/outcomes.csv"), newline="") as f:
            return list(csv.DictReader(f))

    def read(self, name):
        with open(self.path(name), newline="") as f:
            return f.read()

    def cases(self, *options):
        return json.loads(self.bough("batch", "study.toml", "--dry-run", "--json", *options).stdout)


class Cases(BatchTest):
    def test_grid_varies_the_last_parameter_fastest(self):
        self.campaign(E + "range = [6e10, 8e10]\nnumber = 3\n" + table("parameter", "n", values=[1, 2]),
                      'steps = ["modes beam.bdf -n {n}"]')
        found = self.cases()
        self.assertEqual([(c["parameters"]["E"], c["parameters"]["n"]) for c in found],
                         [(6e10, 1), (6e10, 2), (7e10, 1), (7e10, 2), (8e10, 1), (8e10, 2)])
        self.assertEqual(found[1]["steps"], ["modes beam.bdf -n 2"])
        self.assertFalse(os.path.exists(self.path("study")))

    def test_logarithmic_grid(self):
        self.campaign(E + "range = [1e9, 1e11]\nnumber = 3\nspacing = \"log\"\n")
        for found, expected in zip(self.cases(), (1e9, 1e10, 1e11)):
            self.assertAlmostEqual(found["parameters"]["E"] / expected, 1, 12)

    def test_list_takes_values_together_and_from_a_table(self):
        self.campaign(E + "values = [6e10, 8e10]\n" + table("parameter", "n", values=[1, 2]),
                      'method = "list"\nsteps = ["modes beam.bdf -n {n}"]')
        self.assertEqual([tuple(c["parameters"].values()) for c in self.cases()], [(6e10, 1), (8e10, 2)])
        self.write("cases.csv", "# two beams\nE, n\n6.5e10, 2\n7.5e10, 3\n")
        self.campaign(E, 'method = "list"\ntable = "cases.csv"\nsteps = ["modes beam.bdf -n {n}"]')
        self.assertEqual([tuple(c["parameters"].values()) for c in self.cases()], [(6.5e10, 2), (7.5e10, 3)])

    def test_latin_hypercube_hits_every_bin_once(self):
        text = (E + "range = [1e10, 2e10]\n" + table("parameter", "f", range=[1.0, 1000.0], spacing="log")
                + table("parameter", "k", range=[1, 20], integer=True) + table("parameter", "w", values=["a", "b"]))
        head = 'method = "latin-hypercube"\nsamples = 40\nseed = {}\nsteps = ["modes beam.bdf"]'
        self.campaign(text, head.format(3))
        found = self.cases()
        rows = [c["parameters"] for c in found]
        self.assertEqual(sorted(int((r["E"] - 1e10) / 1e10 * 40) for r in rows), list(range(40)))
        self.assertEqual(sorted(int(math.log10(r["f"]) / 3 * 40) for r in rows), list(range(40)))
        self.assertEqual(sorted(r["k"] for r in rows), sorted(list(range(1, 21)) * 2))
        self.assertEqual(sorted(r["w"] for r in rows), ["a"] * 20 + ["b"] * 20)
        self.assertEqual(found, self.cases())
        self.campaign(text, head.format(4))
        self.assertNotEqual(found, self.cases())

    def test_every_bad_campaign_says_where(self):
        line = 3  # of [[parameter]]
        for text, error, words in (
                (E.replace("MAT1", "MATI") + "values = [1.0]\n", "batch.unknown-card", "did you mean MAT1"),
                (E.replace("id = 1", "id = 2") + "values = [1.0]\n", "batch.unknown-card", "it has 1"),
                (E.replace('"E"\n', '"EE"\n') + "values = [1.0]\n", "batch.unknown-field", "its fields are"),
                (E.replace("MAT1", "GRID").replace("id = 1\n", "") + "values = [1.0]\n", "batch.ambiguous-card", "give id"),
                (E, "batch.bad-parameter", "has no values"),
                (E + "range = [1.0, 2.0]\n", "batch.bad-parameter", "without number"),
                (E + "values = [1.0]\nnumber = 5\n", "batch.bad-parameter", "number without range"),
                (E + 'values = [1.0]\nspacing = "log"\n', "batch.bad-parameter", "spacing without range"),
                (E.replace("beam.bdf", "bean.bdf") + "values = [1.0]\n", "batch.no-file", "is no file"),
                (toml(table("parameter", "x", values=[1]), table("parameter", "x", values=[1])),
                 "toml.duplicate-name", "already given"),
                (E + "values = [1.0]\nvalue = 2\n", "toml.unknown-key", "did you mean 'values'")):
            with self.subTest(error=error, words=words):
                self.campaign(text)
                result = self.fails(1, "batch", "study.toml", "--dry-run", says=[words], error=error)
                found = re.search(r"study\.toml:(\d+): error", result.stderr)
                self.assertGreaterEqual(int(found.group(1)), line)

    def test_what_no_case_uses_is_told(self):
        for method in ("monte-carlo", "latin-hypercube"):
            self.campaign(E + "range = [1.0, 2.0]\nnumber = 5\n", f'method = "{method}"\nsamples = 3\nsteps = ["modes beam.bdf"]')
            self.fails(1, "batch", "study.toml", says=["study.toml:12", f'number with method = "{method}"', "samples"],
                       error="batch.bad-parameter")
        self.campaign(toml(table("parameter", "n", values=[2, 3]), table("parameter", "q", values=[1.0])),
                      'steps = ["modes beam.bdf -n {n}"]')
        messages = self.bough("batch", "study.toml").stderr
        self.assertRegex(messages, r"study\.toml:\d+: warning: parameter 'q' .*\[batch.unused-parameter\]")
        self.assertNotIn("'n'", messages)
        # A column of a table may say what a case is.
        self.write("cases.csv", "n,label\n2,soft\n3,stiff\n")
        self.campaign("", 'method = "list"\ntable = "cases.csv"\nsteps = ["modes beam.bdf -n {n}"]', "list.toml")
        self.assertNotIn("unused-parameter", self.bough("batch", "list.toml").stderr)

    def test_bad_steps_keys_and_tables(self):
        self.campaign(E + "values = [1.0]\n", 'steps = ["mode beam.bdf"]')
        self.fails(1, "batch", "study.toml", says=["study.toml:2", "did you mean modes"], error="batch.bad-step")
        self.campaign(E + "values = [1.0]\n", 'steps = ["modes beam.bdf -n {F}"]')
        self.fails(1, "batch", "study.toml", says=["study.toml:2", "{F} is no parameter"], error="batch.bad-step")
        self.write("beam.toml", toml(section("body", deck="beam.bdf"), section("body.modes", number=2)))
        key = table("parameter", "n", file="beam.toml", key="{}", values=[{}])
        for path, value, error in (("body.modes.numbr", "2", "batch.unknown-key"),
                                   ("body.deck.name", "2", "batch.unknown-key"),
                                   ("body.modes.number", "-2", "batch.bad-value")):
            self.campaign(key.format(path, value), 'steps = ["reduce beam.toml"]')
            self.fails(1, "batch", "study.toml", says=["study.toml:3"], error=error)
        self.write("cases.csv", "E,n\n1e10\n")
        self.campaign(E, 'method = "list"\ntable = "cases.csv"\nsteps = ["modes beam.bdf"]')
        self.fails(1, "batch", "study.toml", says=["cases.csv:2"], error="batch.bad-table")
        self.campaign(E + "range = [1.0, 2.0]\nnumber = 2000000\n")
        self.fails(1, "batch", "study.toml", error="batch.too-many-cases")
        self.campaign(E + "values = [1.0]\n")
        self.fails(1, "batch", "study.toml", "--shard", "3/2", error="batch.bad-shard")


class Runs(BatchTest):
    def test_table_equals_direct_runs(self):
        self.campaign(E + "values = [6.5e10, 7.1234567890123e10]\n" + HZ)
        self.bough("batch", "study.toml", "-j", 2)
        rows = self.table()
        self.assertEqual([r["exit_code"] for r in rows], ["0", "0"])
        for row, value in zip(rows, ("6.5+10", "71234567890.123")):
            deck = BEAM.replace("7.+10", value)
            self.assertEqual(self.read(f"study/case-000{row['case']}/beam.bdf"), deck)
            self.write("direct.bdf", deck)
            direct = json.loads(self.bough("modes", "direct.bdf", "--json").stdout)["frequency_hz"]
            for k, hz in enumerate(direct):
                self.assertAlmostEqual(float(row[f"hz.{k + 1}"]) / hz, 1, 12)
        info = self.bough("info", "study/outcomes.h5").stdout
        for path in ("/case", "/parameters/E", "/exit_code", "/seconds", "/error", "/outputs/hz"):
            self.assertIn(path, info)

    def test_chain_of_steps_over_deck_body_and_system(self):
        self.copy_example("ex01-spinup")
        self.write("study.toml", toml(
            section("campaign", steps=["reduce boom.toml", "flx boom.h5 -o boom.FLX", "run spinup.toml -o spinup.h5"]),
            table("parameter", "A", file="boom.bdf", card="PBAR", id=1, field=4, values=[7.2986e-5, 1e-4]),
            table("parameter", "modes", file="boom.toml", key="body.modes.number", values=[2]),
            table("parameter", "rate", file="spinup.toml", key="function.angle.rate", values=[2.0]),
            table("parameter", "end", file="spinup.toml", key="simulation.duration", values=[2.0]),
            table("collect", "mass", step=1, json="/mass"),
            table("collect", "tip", file="spinup.h5", dataset="/sensors/tip_deflection", column=2, take="min")))
        # A body of the same name beside the campaign must not get in the way of the cases' own.
        self.bough("reduce", "boom.toml")
        self.bough("batch", "study.toml", "-j", 2)
        rows = self.table()
        masses = [float(r["mass"]) for r in rows]
        self.assertAlmostEqual(masses[0], 2766.67 * 7.2986e-5 * 8, 9)
        self.assertAlmostEqual(masses[1], 2766.67 * 1e-4 * 8, 9)
        self.assertTrue(os.path.getsize(self.path("study/case-0001/boom.FLX")) > 0)
        # Steps by hand in a separate folder.
        for name, old, new in (("boom.bdf", "7.2986-5", "1.-4"), ("boom.toml", "number = 3", "number = 2"),
                               ("spinup.toml", "rate = 4.0", "rate = 2.0"), ("spinup.toml", "duration = 20.0", "duration = 2.0")):
            text = self.read(name)
            self.assertIn(old, text)
            self.write(name, text.replace(old, new))
        self.bough("reduce", "boom.toml")
        self.bough("run", "spinup.toml", "-o", "direct.h5")
        self.bough("export", "direct.h5", "--to", "csv", "--channel", "tip_deflection:y", "-o", "direct.csv")
        lines = [line for line in self.read("direct.csv").splitlines() if line and line[0] in "0123456789-"]
        direct = min(float(line.split(",")[1]) for line in lines)
        self.assertAlmostEqual(float(rows[1]["tip"]) / direct, 1, 9)

    def test_failed_case_does_not_stop_the_others(self):
        self.campaign(E + "values = [7e10, -1.0, 8e10]\n" + HZ)
        result = self.bough("batch", "study.toml", "-j", 1, code=3)
        self.assertIn("[batch.failed-cases]", result.stderr)
        self.assertIn("case-0002: modes: beam.bdf:9: error:", result.stdout)
        rows = self.table()
        self.assertEqual([r["exit_code"] for r in rows], ["0", "1", "0"])
        self.assertIn("deck.field-range", rows[1]["error"])
        self.assertEqual(rows[1]["hz.1"], "")
        # It is not done again unless asked.
        stamp = os.stat(self.path("study/case-0002/outcome.json")).st_mtime_ns
        self.bough("batch", "study.toml", code=3)
        self.assertEqual(os.stat(self.path("study/case-0002/outcome.json")).st_mtime_ns, stamp)
        self.bough("batch", "study.toml", "--retry", code=3)
        self.assertNotEqual(os.stat(self.path("study/case-0002/outcome.json")).st_mtime_ns, stamp)

    def test_output_that_is_not_there_fails_the_case(self):
        self.campaign(E + "values = [7e10]\n" + table("collect", "x", json="/mass_properties/masses") + HZ)
        self.bough("batch", "study.toml", code=3)
        row = self.table()[0]
        self.assertIn("[batch.collect]", row["error"])
        self.assertIn("it prints /mass_properties/", row["error"])
        self.assertGreater(float(row["hz.1"]), 0)  # the other is collected all the same

    def test_crashed_worker_fails_its_case_only(self):
        self.campaign(E + "range = [6e10, 7e10]\nnumber = 6\n" + HZ)
        self.bough("batch", "study.toml", "-j", 2, code=3, env={"BOUGH_TEST_ABORT_CASE": "3"})
        rows = self.table()
        self.assertEqual([r["exit_code"] for r in rows], ["0", "0", "3", "0", "0", "0"])
        self.assertIn("signal 6", rows[2]["error"])
        self.assertIn("[batch.worker-crashed]", rows[2]["error"])
        self.bough("batch", "study.toml", "--retry")
        self.assertEqual([r["exit_code"] for r in self.table()], ["0"] * 6)

    def test_time_limit(self):
        self.copy_example("ex01-spinup")
        self.write("study.toml", toml(
            section("campaign", steps=["run spinup.toml -o spinup.h5"]),
            table("parameter", "end", file="spinup.toml", key="simulation.duration", values=[1e5, 0.1])))
        self.bough("reduce", "boom.toml")
        self.bough("batch", "study.toml", "-j", 1, "--time-limit", "2", code=3)
        rows = self.table()
        self.assertEqual([r["exit_code"] for r in rows], ["3", "0"])
        self.assertIn("[batch.time-limit]", rows[0]["error"])

    def test_shards_together_are_the_whole(self):
        self.campaign(E + "range = [6e10, 7e10]\nnumber = 7\n" + HZ)
        self.bough("batch", "study.toml", "-o", "whole")
        for i in (1, 2, 3):
            self.assertEqual(len(self.cases("--shard", f"{i}/3")), (3, 2, 2)[i - 1])
            self.bough("batch", "study.toml", "-o", "parts", "--shard", f"{i}/3")
            self.assertEqual(len(self.table("parts")), (3, 5, 7)[i - 1])
        without_time = [[{k: v for k, v in row.items() if k != "seconds"} for row in self.table(f)]
                        for f in ("whole", "parts")]
        self.assertEqual(*without_time)

    def without_time(self, folder):
        return [{k: v for k, v in row.items() if k != "seconds"} for row in self.table(folder)]

    def test_folders_of_shards_become_one_table(self):
        self.campaign(E + "range = [6e10, 7e10]\nnumber = 7\n" + HZ)
        self.bough("batch", "study.toml", "-o", "whole")
        for i in (1, 3):
            self.bough("batch", "study.toml", "-o", f"part-{i}", "--shard", f"{i}/3")
        parts = ["part-1", "part-2", "part-3"]
        merge = ("batch", "study.toml", "-o", "merged", "--merge")
        # A shard that never began, one that ended early, all of them.
        self.fails(1, *merge, *parts, says=["part-2"], error="batch.missing-shard")
        self.fails(3, *merge, "part-1", "part-3", says=["2 of 7 cases are not done: 2, 5", "shard 2/3 (all of it)"],
                   error="batch.missing-shard")
        self.assertEqual([r["case"] for r in self.table("merged")], ["1", "3", "4", "6", "7"])
        self.bough("batch", "study.toml", "-o", "part-2", "--shard", "2/3")
        os.rename(self.path("part-2/case-0005/outcome.json"), self.path("kept.json"))
        self.fails(3, *merge, *parts, says=["cases are not done: 5", "shard 2/3 (1 of 2)"], error="batch.missing-shard")
        os.rename(self.path("kept.json"), self.path("part-2/case-0005/outcome.json"))
        self.bough(*merge, *parts)
        self.assertEqual(self.without_time("merged"), self.without_time("whole"))
        self.assertEqual(self.read("merged/statistics.csv"), self.read("whole/statistics.csv"))
        self.bough("batch", "study.toml", "-o", "whole", "--merge")
        # A shard again where more was merged: its own table is smaller, and that is told.
        self.bough("batch", "study.toml", "-o", "part-1", "--merge", *parts)
        said = self.bough("batch", "study.toml", "-o", "part-1", "--shard", "1/3").stderr
        self.assertIn("[batch.smaller-table]", said)
        self.assertIn("it had 7 cases and has 3 now", said)
        said = self.bough("batch", "study.toml", "-o", "part-1", "--shard", "1/3").stderr
        self.assertNotIn("[batch.smaller-table]", said)
        self.write("beam.bdf", BEAM.replace("2700.", "2800."))
        self.fails(1, *merge, *parts, error="batch.changed-campaign")

    def test_shards_that_end_together_leave_the_whole_table(self):
        self.campaign(E + "range = [6e10, 7e10]\nnumber = 8\n" + HZ)
        shards = [subprocess.Popen([PROGRAM, "batch", "study.toml", "-j", "1", "-q", "--shard", f"{i}/4"],
                                   cwd=self.folder) for i in (1, 2, 3, 4)]
        self.assertEqual([s.wait() for s in shards], [0] * 4)
        self.assertEqual([int(r["case"]) for r in self.table()], list(range(1, 9)))

    def test_a_shard_between_rename_and_close_hinders_no_other(self):
        self.campaign(E + "range = [6e10, 7e10]\nnumber = 4\n" + HZ)
        process, (sleeping,) = self.start_held("batch", "study.toml", "-j", "1", "--shard", "1/2", call="rename",
                                               path="campaign.json", stderr=subprocess.DEVNULL)
        self.assertTrue(os.path.exists(self.path("study/campaign.json")))
        self.bough("batch", "study.toml", "-j", "1", "--shard", "2/2")
        os.kill(sleeping, signal.SIGTERM)
        process.wait(timeout=HANG)

    @unittest.skipUnless(shutil.which("mpirun"), "no mpirun")
    def test_ranks_divide_the_cases(self):
        self.campaign(E + "values = [6e10, 6.5e10, 7e10, -1.0, 8e10]\n" + HZ)
        self.bough("batch", "study.toml", "-o", "whole", code=3)
        launch = launch_ranks("-n", 2, PROGRAM, "batch", "study.toml")
        first = subprocess.run([*launch, "--json"], cwd=self.folder, text=True, capture_output=True)
        self.assertEqual(first.returncode, 3, first.stderr)
        summary = json.loads(first.stdout[:first.stdout.rindex("}") + 1])
        self.assertEqual((summary["done"], summary["done_before"], len(summary["failed"])), (5, 0, 1))
        self.assertEqual(first.stderr.count("[batch.failed-cases]"), 1)
        self.assertEqual(self.without_time("study"), self.without_time("whole"))
        again = subprocess.run([*launch, "--retry", "--json"], cwd=self.folder, text=True, capture_output=True)
        summary = json.loads(again.stdout[:again.stdout.rindex("}") + 1])
        self.assertEqual((summary["done"], summary["done_before"]), (1, 4))
        self.assertEqual(subprocess.run([*launch, "--restart", "-q"], cwd=self.folder, capture_output=True).returncode, 3)
        self.assertEqual(self.without_time("study"), self.without_time("whole"))

    def test_resumes_after_a_kill(self):
        self.campaign(E + "range = [6e10, 7e10]\nnumber = 40\n" + HZ)
        process, _ = self.start_held("batch", "study.toml", "-j", "2", call="rename", path="case-0010/outcome.json")
        process.send_signal(signal.SIGKILL)
        process.wait()
        done = {c: os.stat(p).st_mtime_ns for c in range(1, 41)
                if os.path.exists(p := self.path(f"study/case-{c:04d}/outcome.json"))}
        self.assertIn(10, done)  # and as many as the other worker has got done
        summary = json.loads(self.bough("batch", "study.toml", "--json").stdout)
        self.assertEqual((summary["done_before"], summary["done"]), (len(done), 40 - len(done)))
        for case, stamp in done.items():
            self.assertEqual(os.stat(self.path(f"study/case-{case:04d}/outcome.json")).st_mtime_ns, stamp)
        rows = self.table()
        self.assertEqual([int(r["case"]) for r in rows], list(range(1, 41)))
        # Frequencies go with the root of E: no case was lost or exchanged.
        for row in rows:
            self.assertAlmostEqual(float(row["hz.1"]) / float(rows[0]["hz.1"]) / math.sqrt(float(row["E"]) / 6e10), 1, 8)

    def test_a_worker_that_is_stopped_fails_its_case_alone(self):
        self.write("slide.toml", get_astray(IN_OUTPUTS, HOLD, 5.0, "x:x") +
                   table("sensor", "x", "position", body="bob") + SLIDE)
        # Only the second lives until its controller holds.
        self.campaign(table("parameter", "end", file="slide.toml", key="simulation.duration",
                            values=[2.0, 8.0, 3.0, 4.0]),
                      'steps = ["run slide.toml -o out.h5"]')
        process, workers = self.start_held("batch", "study.toml", "-j", "1", stderr=subprocess.DEVNULL)
        os.kill(workers[0], signal.SIGTERM)
        process.wait(timeout=HANG)
        rows = self.table()
        self.assertEqual([r["exit_code"] for r in rows], ["0", "3", "0", "0"])
        self.assertIn("stopped on request", rows[1]["error"])

    def test_interrupt_ends_cleanly(self):
        self.campaign(E + "range = [6e10, 7e10]\nnumber = 20\n" + HZ)
        process, _ = self.start_held("batch", "study.toml", "-j", "1", call="rename", path="case-0005/outcome.json")
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate(timeout=HANG)
        self.assertEqual(process.returncode, 3)
        self.assertIn("[cli.interrupted]", messages)
        self.assertEqual(len(self.table()), 5)
        self.bough("batch", "study.toml")
        self.assertEqual(len(self.table()), 20)

    def test_changed_inputs_are_noticed(self):
        self.campaign(E + "values = [7e10]\n" + HZ)
        self.bough("batch", "study.toml")
        self.write("beam.bdf", BEAM.replace("2700.", "2800."))
        self.fails(1, "batch", "study.toml", says=["changed: beam.bdf", "--restart"], error="batch.changed-campaign")
        before = self.table()[0]["hz.1"]
        self.bough("batch", "study.toml", "--restart")
        self.assertLess(float(self.table()[0]["hz.1"]), float(before))

    def test_a_second_call_for_the_same_cases_waits_its_turn(self):
        self.campaign(E + "values = [7e10]\n")
        self.bough("batch", "study.toml")
        with open(self.path("study/.lock-1-of-1")) as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.fails(1, "batch", "study.toml", error="batch.busy")
        self.bough("batch", "study.toml")

    def test_no_room_for_a_worker(self):
        self.campaign(E + "values = [7e10]\n")
        self.bough("batch", "study.toml", "--dry-run")
        limit = ["prlimit", "--nofile=5:5"]
        result = subprocess.run([*limit, PROGRAM, "batch", "study.toml", "-j", "1"], cwd=self.folder, text=True,
                                capture_output=True)
        self.assertEqual(result.returncode, 3)
        self.assertIn("[batch.no-worker]", result.stderr)


class Example(ProgramTest):
    def test_ex06_campaign(self):
        self.copy_example("ex06-campaign")
        self.bough("batch", "campaign.toml", "-o", "booms")
        with open(self.path("booms/outcomes.csv"), newline="") as f:
            rows = list(csv.DictReader(f))
        self.assertEqual(len(rows), 12)
        for row in rows:
            young, area = float(row["E"]), float(row["A"])
            self.assertAlmostEqual(float(row["mass"]), 2766.67 * area * 8, 8)
            hz = 1.8751040687 ** 2 / (2 * math.pi * 64) * math.sqrt(young * 8.2181e-9 / (2766.67 * area))
            self.assertAlmostEqual(float(row["hz.1"]) / hz, 1, 6)
            folder = self.path(f"booms/case-{int(row['case']):04d}")
            self.assertTrue(os.path.exists(f"{folder}/boom-{row['case']}.FLX"))
        self.assertEqual([bool(r["hz.3"]) for r in rows], [False, True] * 6)


if __name__ == "__main__":
    unittest.main()
