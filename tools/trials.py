"""Ends verbs at random moments, in their n-th write, on disks that fail, and looks at what is left.

    /usr/bin/python3 tools/trials.py build/bin/bough [--times 20] [--seed 1] [--verbs modes,run] [--keep FOLDER]

For each verb an unbroken call is the reference. A call that is ended must leave its output as it was, or whole, with
the same numbers; results of `run` may be a beginning of them, and `--resume` must reach the same end: bit for bit at
fixed step, to tolerance otherwise. Signals that can be caught and failing disks leave no temporary file and exit code 3;
those that SIGKILL leaves go with the next call. Prints one row a verb and kind; exit 1 when something was found.
"""
import argparse
import collections
import glob
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

# Counts what goes to regular files; in the n-th the process dies, or from it on the disk fails.
PRELOAD = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
static long count = 0;
/* Files of the disk, not those that live in memory. */
static int is_file(int fd) {
  struct stat s;
  char link[40], name[16];
  if (fstat(fd, &s) != 0 || !S_ISREG(s.st_mode)) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, name, sizeof name);
  return !(n >= 7 && !strncmp(name, "/memfd:", 7));
}
/* 1: fail; 2: write half, then die */
static int check(void) {
  const char* at = getenv("TRIAL_AT");
  const char* log = getenv("TRIAL_LOG");
  const long n = at ? atol(at) : 0;
  ++count;
  if (log) { FILE* f = fopen(log, "w"); if (f) { fprintf(f, "%ld", count); fflush(NULL); } }
  if (n == 0 || count < n) return 0;
  const char* error = getenv("TRIAL_ERROR");
  if (error) { errno = atoi(error); return 1; }
  return count == n ? 2 : 0;
}
#define NEXT(name) static __typeof__(name)* next; if (!next) next = dlsym(RTLD_NEXT, #name)
#define DIE(signal) do { kill(getpid(), SIGKILL); pause(); } while (0)
static int in_log = 0;
static int judge(int fd) {
  if (in_log || !is_file(fd)) return 0;
  in_log = 1;
  const int j = check();
  in_log = 0;
  return j;
}
ssize_t write(int fd, const void* b, size_t n) {
  NEXT(write);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) { next(fd, b, n / 2); DIE(); }
  return next(fd, b, n);
}
ssize_t pwrite(int fd, const void* b, size_t n, off_t o) {
  NEXT(pwrite);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) { next(fd, b, n / 2, o); DIE(); }
  return next(fd, b, n, o);
}
ssize_t pwrite64(int fd, const void* b, size_t n, off64_t o) {
  NEXT(pwrite64);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) { next(fd, b, n / 2, o); DIE(); }
  return next(fd, b, n, o);
}
ssize_t writev(int fd, const struct iovec* v, int n) {
  NEXT(writev);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) DIE();
  return next(fd, v, n);
}
int fsync(int fd) {
  NEXT(fsync);
  const int j = judge(fd);
  if (j == 1) return -1;
  if (j == 2) DIE();
  return next(fd);
}
int rename(const char* a, const char* b) {
  NEXT(rename);
  const int j = in_log ? 0 : check();
  if (j == 1) return -1;
  if (j == 2) DIE();
  return next(a, b);
}
"""

SYSTEM = """[[body]]
name = "plate"
file = "plate.h5"
[[body]]
name = "arm"
mass = 1.0
cg = [0.3, 0.0, 0.0]
inertia = [0.01, 0.1, 0.1]
nodes = [{{id = 1, position = [0.6, 0.0, 0.0]}}]
[[hinge]]
name = "root"
type = "revolute"
parent = "ground"
child = "arm"
axis = [0.0, 0.0, 1.0]
rate = 1.0
stiffness = 3.0
[[hinge]]
name = "tip"
type = "revolute"
parent = "arm"
parent_node = 1
child = "plate"
axis = [0.0, 1.0, 0.0]
rate = 0.3
[[sensor]]
name = "edge"
type = "deflection"
body = "plate"
node = {node}
[[actuator]]
name = "motor"
type = "hinge"
hinge = "root"
input = "push"
[[function]]
name = "push"
type = "sine"
amplitude = 0.1
frequency_hz = 1.3
[simulation]
duration = {duration}
output_step = 0.01
integrator = "{integrator}"
{more}
"""


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


class Trials:
    def __init__(self, options):
        self.program = os.path.abspath(options.program)
        self.times, self.random = options.times, random.Random(options.seed)
        self.folder = tempfile.mkdtemp(prefix="trials-")
        self.keep = options.keep
        self.rows = collections.OrderedDict()
        self.found = 0
        self.preload = os.path.join(self.folder, "preload.so")
        source = os.path.join(self.folder, "preload.c")
        with open(source, "w", encoding="ascii") as out:
            out.write(PRELOAD)
        subprocess.run(["cc", "-O1", "-w", "-shared", "-fPIC", "-o", self.preload, source, "-ldl"], check=True)
        self.write("plate.bdf", make_plate(12))
        self.write("plate.toml", '[body]\nname = "plate"\ndeck = "plate.bdf"\n[body.modes]\nnumber = 6\n'
                   '[body.output]\nnodes = [1, 13, 169]\n')
        self.call("reduce", "plate.toml", "-o", "plate.h5")
        self.write("fixed.toml", SYSTEM.format(node=169, duration=4.0, integrator="rk4", more="step = 0.0005"))
        self.write("free.toml", SYSTEM.format(node=169, duration=40.0, integrator="rk", more=""))
        self.write("campaign.toml", '[campaign]\nverb = "modes"\ninput = "plate.bdf"\n')

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as out:
            out.write(text)

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, *arguments, **more):
        environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
        for key, value in more.items():
            environment[key] = str(value)
        if more:
            environment["LD_PRELOAD"] = self.preload
        return subprocess.Popen([self.program, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, env=environment)

    def call(self, *arguments, **more):
        process = self.start(*arguments, **more)
        said = process.communicate(timeout=600)[1]
        if process.returncode:
            sys.exit(f"bough {' '.join(arguments)}: {said}")

    def note(self, verb, kind, outcome):
        self.rows.setdefault((verb, kind), collections.Counter())[outcome] += 1

    def accuse(self, verb, kind, what, said):
        self.found += 1
        self.note(verb, kind, "FOUND")
        print(f"{verb}: {kind}: {what}\n    {said.strip()[-400:]}", flush=True)
        if self.keep:
            place = os.path.join(self.keep, f"{verb}-{self.found}")
            shutil.copytree(self.folder, place, dirs_exist_ok=True)

    def get_parts(self):
        return glob.glob(self.path("*bough-part*")) + glob.glob(self.path("*/*bough-part*"))

    def try_verb(self, verb, arguments, output):
        """`arguments` write `output`; each way of ending it, `times` times."""
        begin = time.monotonic()
        self.call(*arguments, "-o", "whole.h5" if output.endswith(".h5") else "whole")
        took = time.monotonic() - begin
        whole = self.path("whole.h5" if output.endswith(".h5") else "whole")
        reference = read_all(whole) if output.endswith(".h5") else open(whole, "rb").read()
        self.call(*arguments, "-o", output, TRIAL_LOG=self.path("count"))
        with open(self.path("count"), encoding="ascii") as f:
            writes = int(f.read())
        for kind in ("KILL", "TERM", "INT", "n-th write", "disk full", "disk error"):
            for _ in range(self.times):
                self.try_once(verb, kind, arguments, output, reference, took, writes)

    def try_once(self, verb, kind, arguments, output, reference, took, writes):
        path = self.path(output)
        for old in self.get_parts() + [path]:
            if os.path.exists(old):
                os.remove(old)
        was_there = verb != "run" and self.random.random() < 0.5
        if was_there:
            shutil.copyfile(self.path("old"), path)
        said = ""
        if kind in ("KILL", "TERM", "INT"):
            process = self.start(*arguments, "-o", output)
            try:
                said = process.communicate(timeout=self.random.uniform(0, 1.1 * took))[1]
            except subprocess.TimeoutExpired:
                process.send_signal(getattr(signal, "SIG" + kind))
                said = process.communicate(timeout=120)[1]
        else:
            error = {"disk full": {"TRIAL_ERROR": 28}, "disk error": {"TRIAL_ERROR": 5}}.get(kind, {})
            process = self.start(*arguments, "-o", output, TRIAL_AT=self.random.randint(1, writes), **error)
            said = process.communicate(timeout=120)[1]
        code = process.returncode
        died = kind in ("KILL", "n-th write")
        allowed = (0, -9) if died else (0, 3) + ((-getattr(signal, "SIG" + kind),) if kind in ("TERM", "INT") else ())
        if code not in allowed:
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
        if verb == "run" and state == "beginning":
            state = self.resume(arguments, output, reference)
            if state.startswith("!"):
                return self.accuse(verb, kind, state[1:], said)
        return self.note(verb, kind, state)

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
            return "as before" if verb == "run" and self.is_refused(output) else "not readable"
        if now.keys() == reference.keys() and all(is_equal(now[k], reference[k]) for k in reference):
            return "whole"
        if verb != "run":
            return "half"
        n = len(now.get("time", ()))
        same = all(is_equal(now[k][:n], reference[k][:n]) for k in ("time", "sensors/edge") if k in now)
        return "beginning" if same else "not a beginning of the unbroken run"

    def is_refused(self, output):
        """Whether the program itself says that the file is none."""
        return subprocess.run([self.program, "info", output], cwd=self.folder, capture_output=True).returncode == 1

    def resume(self, arguments, output, reference):
        process = self.start(*arguments, "-o", output, "--resume")
        said = process.communicate(timeout=600)[1]
        if process.returncode == 1 and "checkpoint" in said:
            return "no checkpoint, told"
        if process.returncode:
            return f"!resume: exit {process.returncode}: {said[-300:]}"
        if self.get_parts():
            return f"!after resume: {self.get_parts()}"
        now = read_all(self.path(output))
        if len(now["time"]) != len(reference["time"]):
            return f"!resume: {len(now['time'])} samples, unbroken {len(reference['time'])}"
        worst = np.abs(now["sensors/edge"] - reference["sensors/edge"]).max() / np.abs(reference["sensors/edge"]).max()
        if "fixed.toml" in arguments and worst != 0:
            return f"!resume: differs by {worst:.1e} at fixed step"
        return f"!resume: differs by {worst:.1e}" if worst > 1e-3 else "resumed"

    def run(self, verbs):
        self.call("modes", "plate.bdf", "-n", "2", "-o", "old")
        calls = {
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
        for verb in verbs or calls:
            if calls.get(verb):
                self.try_verb(verb.split()[0], *calls[verb])
        print(f"{'verb':10} {'ended by':11} what was left")
        for (verb, kind), outcomes in self.rows.items():
            print(f"{verb:10} {kind:11} " + ", ".join(f"{n} {what}" for what, n in outcomes.most_common()))
        shutil.rmtree(self.folder)
        return 1 if self.found else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--verbs", type=lambda text: text.split(","), default=[])
    parser.add_argument("--keep")
    options = parser.parse_args()
    sys.exit(Trials(options).run(options.verbs))


if __name__ == "__main__":
    main()
