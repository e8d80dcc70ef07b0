"""Ends commands at random moments, in their n-th write, on disks that fail, and looks at what is left.

    /usr/bin/python3 tools/trials.py build/bin/bough [--times 20] [--disks 20] [--seed 1] [--verbs modes,run] [--jobs 2]
                                     [--keep FOLDER] [--write]

For each verb an unbroken call is the reference. A call that is ended must leave its output as it was, or whole, with
the same numbers; results of `run` may be a beginning of them, and `--resume` must reach the same end: bit for bit at
fixed step, to tolerance otherwise; `batch` again must end a campaign as if it had never been ended. Signals that can be
caught, failing disks, folders that may not be written and limits of memory leave no temporary file and exit code 3 with
words; what SIGKILL leaves goes with the next call. --times: of each signal, at a moment drawn over the time that the
unbroken call took; --disks: of each other way. --jobs verbs and ways at once. Prints one row a verb and way as soon as
it is done; exit 1 when something was found. --write puts the table into docs/verification/robustness.md.
"""
import collections
import concurrent.futures
import glob
import multiprocessing.util
import os
import random
import resource
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import traceback

import h5py
import numpy as np

from robustness_page import make_parser, write_table

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../tests/support"))
from toml_text import section, table, toml  # noqa: E402

# Counts what goes to regular files; in the n-th the process dies, or from it on the disk fails.
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "failing_disk.c"), encoding="ascii") as c_source:
    PRELOAD = c_source.read()
# Nobody in particular: who may not write where root may.
ORDINARY_USER = 65534
WAYS = ("n-th write", "disk full", "disk error", "memory", "read-only")
# What each command is called with, and what it writes.
CALLS = {
    "modes": (["modes", "plate.bdf"], "out.h5"),
    "reduce": (["reduce", "plate.toml"], "out.h5"),
    "matrices": (["matrices", "plate.bdf", "--no-kg"], "out.h5"),
    "export": (["export", "plate.h5", "--to", "sid"], "out.sid"),
    "flx": (["flx", "plate.h5"], "out.flx"),
    "select": (["select", "plate.h5", "-n", "3"], "out.h5"),
    "linearize": (["linearize", "fixed.toml"], "out.h5"),
    "run": (["run", "fixed.toml"], "out.h5"),
    "run (adaptive)": (["run", "free.toml"], "out.h5"),
}
CAMPAIGN = toml(
    section("campaign", steps=["modes small.bdf -o modes.h5"]),
    table("parameter", "E", file="small.bdf", card="MAT1", id=1, field="E", values=[6e10, 7e10, 8e10]),
    table("collect", "f", file="modes.h5", dataset="/modes/frequency_hz", take="first"))


def write_system(node, **simulation):
    """A plate on an arm that a motor turns; the keys are those of the simulation."""
    return toml(
        table("body", "plate", file="plate.h5"),
        table("body", "arm", mass=1.0, cg=[0.3, 0.0, 0.0], inertia=[0.01, 0.1, 0.1],
              nodes=[{"id": 1, "position": [0.6, 0.0, 0.0]}]),
        table("hinge", "root", "revolute", parent="ground", child="arm", axis=[0.0, 0.0, 1.0], rate=1.0, stiffness=3.0),
        table("hinge", "tip", "revolute", parent="arm", parent_node=1, child="plate", axis=[0.0, 1.0, 0.0], rate=0.3),
        table("sensor", "edge", "deflection", body="plate", node=node),
        table("actuator", "motor", "hinge", hinge="root", input="push"),
        table("function", "push", "sine", amplitude=0.1, frequency_hz=1.3),
        section("simulation", output_step=0.01, **simulation))


def make_plate(n):
    grids = [f"GRID,{1 + i + j * (n + 1)},,{i / n},{j / n},0." for j in range(n + 1) for i in range(n + 1)]
    shells = [f"CQUAD4,{1 + i + j * n},1,{(a := 1 + i + j * (n + 1))},{a + 1},{a + n + 2},{a + n + 1}"
              for j in range(n) for i in range(n)]
    held = [f"SPC1,1,123456,{1 + j * (n + 1)}" for j in range(n + 1)]
    return "\n".join(["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,6",
                      "MAT1,1,7.+10,,.3,2700.", "PSHELL,1,1,.01,1,,1", *grids, *shells, *held, "ENDDATA", ""])


def read_all(path):
    """Every number and word of an HDF5 file, by path."""
    found = {}
    with h5py.File(path, "r") as f:
        f.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def is_equal(a, b):
    if not hasattr(a, "dtype"):
        return a == b
    return a.dtype == b.dtype and a.shape == b.shape and (
        np.array_equal(a, b, equal_nan=True) if a.dtype.kind == "f" else np.array_equal(a, b))


def calc_difference(a, b):
    """The largest, relative to the largest value."""
    if is_equal(a, b):
        return 0.0
    return float(np.abs(a - b).max() / (np.abs(a).max() or 1.0)) if a.shape == b.shape else np.inf


class Trials:
    def __init__(self, program, keep, seed):
        self.program = os.path.abspath(program)
        self.keep, self.random = keep, random.Random(seed)
        self.folder = tempfile.mkdtemp(prefix="trials-")
        self.outcomes = collections.Counter()  # of the command and way that are tried now
        self.unbroken = {}                     # by command: see measure, measure_batch
        self.preload = os.path.join(self.folder, "preload.so")
        source = os.path.join(self.folder, "preload.c")
        with open(source, "w", encoding="ascii") as out:
            out.write(PRELOAD)
        subprocess.run(["cc", "-O1", "-w", "-shared", "-fPIC", "-o", self.preload, source, "-ldl"], check=True)
        self.write("plate.bdf", make_plate(12))
        self.write("plate.toml", toml(
            section("body", name="plate", deck="plate.bdf"),
            section("body.modes", number=6),
            section("body.output", nodes=[1, 13, 169])))
        self.call("reduce", "plate.toml", "-o", "plate.h5")
        self.write("fixed.toml", write_system(169, duration=4.0, integrator="rk4", step=0.0005))
        self.write("free.toml", write_system(169, duration=6.0, integrator="rk"))
        self.write("small.bdf", make_plate(2))
        self.write("campaign.toml", CAMPAIGN)
        self.worst = None  # of runs that were resumed: largest difference, relative to the largest value
        self.call("modes", "plate.bdf", "-n", "2", "-o", "old")
        self.startup = self.time("--version")  # libraries are loaded until then

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as out:
            out.write(text)

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, *arguments, user=None, memory=None, **more):
        environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
        for key, value in more.items():
            environment[key] = str(value)
        if more:
            environment["LD_PRELOAD"] = self.preload

        def prepare():
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # a shell ignores it for what runs behind it
            if memory is not None:
                resource.setrlimit(resource.RLIMIT_AS, (memory, memory))

        ids = {} if user is None else {"user": user, "group": user, "extra_groups": []}
        return subprocess.Popen([self.program, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, env=environment, preexec_fn=prepare, **ids)

    def call(self, *arguments, **more):
        process = self.start(*arguments, **more)
        said = process.communicate(timeout=600)[1]
        if process.returncode:
            sys.exit(f"bough {' '.join(arguments)}: {said}")

    def time(self, *arguments, **more):
        """Seconds of a call: the middle of three."""
        seconds = []
        for _ in range(3):
            begin = time.monotonic()
            self.call(*arguments, **more)
            seconds.append(time.monotonic() - begin)
        return statistics.median(seconds)

    def note(self, outcome):
        self.outcomes[outcome] += 1

    def accuse(self, verb, kind, what, said):
        self.note("FOUND")
        print(f"{verb}: {kind}: {what}\n    {said.strip()[-400:]}", flush=True)
        if self.keep:
            place = os.path.join(self.keep, f"{verb}-{kind}-{os.getpid()}-{self.outcomes['FOUND']}".replace(" ", "-"))
            shutil.copytree(self.folder, place, dirs_exist_ok=True)

    def get_parts(self):
        return glob.glob(self.path("*bough-part*")) + glob.glob(self.path("*/*bough-part*"))

    def measure(self, verb):
        """The unbroken call: its output, its seconds, its writes."""
        if verb not in self.unbroken:
            arguments, output = CALLS[verb]
            whole = "whole" + os.path.splitext(output)[1]
            took = self.time(*arguments, "-o", whole)
            if output.endswith(".h5"):
                reference = read_all(self.path(whole))
            else:
                with open(self.path(whole), "rb") as f:
                    reference = f.read()
            self.call(*arguments, "-o", output, TRIAL_LOG=self.path("count"))
            with open(self.path("count"), encoding="ascii") as f:
                self.unbroken[verb] = reference, took, int(f.read())
        return self.unbroken[verb]

    def try_verb(self, verb, kind, times):
        """One way of ending it, `times` times."""
        reference, took, writes = self.measure(verb)
        for _ in range(times):
            self.try_once(verb, kind, *CALLS[verb], reference, took, writes)

    def end(self, kind, call, took, writes):
        """The call, ended in one way: its process and what it said."""
        if kind in ("KILL", "TERM", "INT"):
            process = self.start(*call)
            try:
                return process, process.communicate(timeout=self.random.uniform(min(self.startup, took) / 2, took))[1]
            except subprocess.TimeoutExpired:
                process.send_signal(getattr(signal, "SIG" + kind))
        elif kind == "memory":
            process = self.start(*call, memory=self.random.randint(150, 500) << 20)
        elif kind == "read-only":
            process = self.start(*call, user=ORDINARY_USER if os.getuid() == 0 else None)
        else:
            error = {"disk full": {"TRIAL_ERROR": 28}, "disk error": {"TRIAL_ERROR": 5}}.get(kind, {})
            process = self.start(*call, TRIAL_AT=self.random.randint(1, writes), **error)
        return process, process.communicate(timeout=120)[1]

    def try_once(self, verb, kind, arguments, output, reference, took, writes):
        path = self.path(output)
        for old in self.get_parts() + [path]:
            if os.path.exists(old):
                os.remove(old)
        was_there = not verb.startswith("run") and self.random.random() < 0.5
        if was_there:
            shutil.copyfile(self.path("old"), path)
        os.chmod(self.folder, 0o555 if kind == "read-only" else 0o755)
        process, said = self.end(kind, [*arguments, "-o", output], took, writes)
        os.chmod(self.folder, 0o755)
        code = process.returncode
        if kind == "memory" and code == 127:
            return self.note("before it began")  # its libraries find no room
        died = kind in ("KILL", "n-th write")
        allowed = (0, -9) if died else (0, 3) + ((-getattr(signal, "SIG" + kind),) if kind in ("TERM", "INT") else ())
        if code not in allowed or (kind == "read-only" and code == 0):
            return self.accuse(verb, kind, f"exit {code}", said)
        if code == 3 and not said.strip():
            return self.accuse(verb, kind, "exit 3 without a word", said)
        if not died and self.get_parts():
            return self.accuse(verb, kind, f"exit {code} leaves {self.get_parts()}", said)
        state = self.look(verb, output, reference, was_there)
        if state not in ("as before", "whole", "beginning"):
            return self.accuse(verb, kind, f"exit {code}: the output is {state}", said)
        if code == 0 and state != "whole":
            return self.accuse(verb, kind, f"exit 0, and the output is {state}", said)
        if code < 0 and kind in ("TERM", "INT"):
            state = "before it began"
        if verb.startswith("run") and state == "beginning":
            state = self.resume(verb, arguments, output, reference)
            if state.startswith("!"):
                return self.accuse(verb, kind, state[1:], said)
        return self.note(state)

    def read_campaign(self, folder):
        """What a campaign found, but for the time that it took."""
        found = read_all(self.path(folder + "/outcomes.h5"))
        with open(self.path(folder + "/outcomes.csv"), encoding="utf-8") as f:
            heads, *rows = [line.rstrip("\n").split(",") for line in f if not line.startswith("#")]
        timed = [k for k, head in enumerate(heads) if "seconds" in head]
        table = [[x for k, x in enumerate(row) if k not in timed] for row in rows]
        return {k: v for k, v in found.items() if "seconds" not in k}, table

    def measure_batch(self):
        if "batch" not in self.unbroken:
            took = self.time("batch", "campaign.toml", "-j", "1", "--restart", "-o", "whole-campaign")
            shutil.rmtree(self.path("campaign"), ignore_errors=True)
            self.call("batch", "campaign.toml", "-j", "1", "-o", "campaign", TRIAL_LOG=self.path("count"))
            with open(self.path("count"), encoding="ascii") as f:
                self.unbroken["batch"] = self.read_campaign("whole-campaign"), took, int(f.read())
        return self.unbroken["batch"]

    def try_batch(self, kind, times):
        """A campaign that is ended and called again is one that was never ended. Its workers fail as it does."""
        (numbers, table), took, writes = self.measure_batch()
        call = ["batch", "campaign.toml", "-j", "1", "-o", "campaign"]
        for _ in range(times):
            shutil.rmtree(self.path("campaign"), ignore_errors=True)
            os.chmod(self.folder, 0o555 if kind == "read-only" else 0o755)
            process, said = self.end(kind, call, took, writes)
            os.chmod(self.folder, 0o755)
            code = process.returncode
            if kind == "memory" and code == 127:
                self.note("before it began")  # its libraries find no room
                continue
            allowed = (0, 3, -9) if kind in ("KILL", "n-th write") else (0, 3)
            allowed += (-getattr(signal, "SIG" + kind),) if kind in ("TERM", "INT") else ()
            if code not in allowed or (kind == "read-only" and code == 0):
                self.accuse("batch", kind, f"exit {code}", said)
                continue
            if code == 3 and not said.strip():
                self.accuse("batch", kind, "exit 3 without a word", said)
                continue
            # What a failing disk does to a case is that case's failure, told, and done again when asked for.
            process = self.start(*call, *([] if kind in ("KILL", "TERM", "INT") else ["--retry"]))
            said = process.communicate(timeout=600)[1]
            if process.returncode:
                self.accuse("batch", kind, f"again: exit {process.returncode}", said)
                continue
            now, rows = self.read_campaign("campaign")
            parts = glob.glob(self.path("campaign/**/*bough-part*"), recursive=True)
            if rows != table or now.keys() != numbers.keys() or parts or not all(
                    is_equal(now[k], numbers[k]) for k in numbers):
                self.accuse("batch", kind, f"again: another outcome {parts}", said)
                continue
            self.note("whole" if code == 0 else "ended, called again")

    def look(self, verb, output, reference, was_there):
        path = self.path(output)
        if not os.path.exists(path):
            return "gone" if was_there else "as before"
        with open(path, "rb") as f, open(self.path("old"), "rb") as old:
            content = f.read()
            if was_there and content == old.read():
                return "as before"
        if not output.endswith(".h5"):
            return "whole" if content == reference else "half"
        try:
            now = read_all(path)
        except (OSError, RuntimeError):
            return "as before" if verb.startswith("run") and self.is_refused(output) else "not readable"
        if now.keys() == reference.keys() and all(is_equal(now[k], reference[k]) for k in reference):
            return "whole"
        if not verb.startswith("run"):
            return "half"
        with h5py.File(path, "r") as f:  # datasets grow one by one; this number is the last to change
            if f.attrs.get("completed", 0):
                return "half, and says that it is whole"
            n = int(f.attrs.get("num_samples", 0))  # none yet where the disk failed as the file was begun
        same = all(is_equal(now[k][:n], reference[k][:n]) for k in ("time", "sensors/edge") if k in now)
        return "beginning" if same else "not a beginning of the unbroken run"

    def is_refused(self, output):
        """Whether the program itself says that the file is none."""
        return subprocess.run([self.program, "info", output], cwd=self.folder, capture_output=True).returncode == 1

    def resume(self, verb, arguments, output, reference):
        process = self.start(*arguments, "-o", output, "--resume")
        said = process.communicate(timeout=600)[1]
        if process.returncode == 1 and "checkpoint" in said:
            return "no checkpoint, reported"
        if process.returncode:
            return f"!resume: exit {process.returncode}: {said[-300:]}"
        if self.get_parts():
            return f"!after resume: {self.get_parts()}"
        now = read_all(self.path(output))
        n = len(reference["time"])
        if len(now["time"]) != n:
            return f"!resume: {len(now['time'])} samples, unbroken {n}"
        # What is the same in each sample; the counters of the integrator begin anew.
        names = [k for k, v in reference.items() if getattr(v, "shape", ())[:1] == (n,) and v.dtype.kind == "f" and
                 k.split("/")[0] in ("time", "sensors", "bodies", "hinges", "energy", "signals")]
        differences = {name: calc_difference(reference[name], now[name]) for name in names}
        worst = max((difference, name) for name, difference in differences.items())
        self.worst = max(self.worst or worst, worst)
        if "fixed.toml" in arguments:
            return f"!resume: {worst[1]} differs by {worst[0]:.1e} at fixed step" if worst[0] else "resumed"
        # As near to the unbroken run as that is to one of tolerances a hundred times narrower.
        narrow = read_all(self.get_narrow(arguments))
        for name, difference in differences.items():
            allowed = 1e-7 + 5 * calc_difference(reference[name], narrow[name])
            if difference > allowed:
                return f"!resume: {name} differs by {difference:.1e}, allowed {allowed:.1e}"
        return "resumed"

    def get_narrow(self, arguments):
        path = self.path("narrow.h5")
        if not os.path.exists(path):
            with open(self.path(arguments[1]), encoding="utf-8") as f:
                self.write("narrow.toml", f.read() + "relative_tolerance = 1e-10\nabsolute_tolerance = 1e-14\n")
            self.call("run", "narrow.toml", "-o", "narrow.h5")
        return path


def try_task(program, keep, seed, verb, kind, times):
    """In a process of its own, whose folder and unbroken calls serve each task that it gets."""
    trials = try_task.__dict__.get("trials")
    if trials is None:
        trials = try_task.trials = Trials(program, keep, 0)
        # Ends without a word when the pool does: the folder goes as well.
        multiprocessing.util.Finalize(None, shutil.rmtree, args=(trials.folder, True), exitpriority=1)
    trials.random.seed(f"{seed} {verb} {kind}")
    trials.outcomes, trials.worst = collections.Counter(), None
    begin = time.monotonic()
    if verb == "batch":
        trials.try_batch(kind, times)
    else:
        trials.try_verb(verb, kind, times)
    return trials.outcomes, trials.worst, time.monotonic() - begin


def describe(outcomes):
    return ", ".join(f"{n} {what}" for what, n in outcomes.most_common())


def write_rows(rows, worst):
    differ = [f"`{verb}`, resumed and unbroken, differ by {difference:.1e} of the largest value at most."
              for verb, (difference, _) in worst.items()]
    write_table("trials", ["verb", "ended by", "how often", "what was left"],
                [(f"`{verb}`", kind, sum(outcomes.values()), describe(outcomes))
                 for (verb, kind), outcomes in rows.items()], differ, num_keys=2)


def run(options):
    tasks = [(verb, kind, times) for verb in options.verbs or [*CALLS, "batch"]
             for kinds, times in ((options.signals, options.times), (WAYS, options.disks)) for kind in kinds]
    rows, worst, found = {}, {}, 0
    print(f"{'verb':14} {'ended by':11} {'seconds':>7} what was left", flush=True)
    with concurrent.futures.ProcessPoolExecutor(max_workers=options.jobs) as pool:
        waiting = {}
        for verb, kind, times in tasks:
            times = min(times, 3) if kind == "read-only" else times
            if times:
                waiting[pool.submit(try_task, options.program, options.keep, options.seed, verb, kind, times)] = verb, kind
        for done in concurrent.futures.as_completed(waiting):
            verb, kind = waiting[done]
            try:
                outcomes, differ, seconds = done.result()
            except Exception:  # pylint: disable=broad-exception-caught  # the others go on
                traceback.print_exc()
                outcomes, differ, seconds = collections.Counter({"FOUND": 1}), None, 0
            rows[verb, kind] = outcomes
            found += outcomes["FOUND"]
            if differ:
                worst[verb] = max(worst.get(verb, differ), differ)
            print(f"{verb:14} {kind:11} {seconds:7.0f} {describe(outcomes)}", flush=True)
            if options.write:
                order = {task[:2]: k for k, task in enumerate(tasks)}
                write_rows(dict(sorted(rows.items(), key=lambda row: order[row[0]])), worst)
    for verb, (difference, name) in worst.items():
        print(f"{verb}: resumed and unbroken differ by {difference:.1e} at most ({name})")
    return 1 if found else 0


def main():
    parser = make_parser(__doc__, "the table")
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--disks", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--signals", type=lambda text: text.split(","), default=["KILL", "TERM", "INT"])
    parser.add_argument("--verbs", type=lambda text: text.split(","), default=[])
    sys.exit(run(parser.parse_args()))


if __name__ == "__main__":
    main()
