"""Runs the built program in a folder of its own."""
import os
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ["BOUGH_PROGRAM"]
SOURCE = os.environ["BOUGH_SOURCE_DIR"]
# Factor of time of a program under the sanitizers; these need address space without end.
SLOWER = int(os.environ.get("BOUGH_SLOWER", "1"))
# Guards against hangs only: no command takes a tenth of it, alone or on a busy machine.
HANG = 600 * SLOWER
sys.path.insert(0, os.path.join(SOURCE, "tests/support"))
# Under nohup programs are started with SIGHUP ignored, and some tests send it.
signal.signal(signal.SIGHUP, signal.SIG_DFL)
import served  # noqa: E402
from decks import begin, row  # noqa: E402


def list_verbs():
    """Names of the commands in the order of --help; docs/commands.md, which a test compares, keeps any from loss."""
    page = subprocess.run([PROGRAM, "--help"], text=True, capture_output=True, check=True).stdout
    return re.findall(r"^  ([a-z]+) ", page.split("Decks:\n")[1].split("\nbough COMMAND")[0], re.MULTILINE)


def __getattr__(name):
    """VERBS, for the tests that take it only: it costs a call of the program."""
    if name == "VERBS":
        return list_verbs()
    raise AttributeError(name)


def launch_ranks(*arguments):
    """The words of mpirun with these arguments; a rank that waits sleeps, so a busy machine serves it (patient.c)."""
    return ["env", f"LD_PRELOAD={os.environ['BOUGH_PATIENT']}", "OMPI_MCA_mpi_yield_when_idle=1", "mpirun",
            "--allow-run-as-root", "--oversubscribe", *map(str, arguments)]


class ProgramTest(unittest.TestCase):
    EXAMPLE = None  # (example, body): setUp copies this example and reduces a body of it

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="bough-test-")
        self.addCleanup(shutil.rmtree, self.folder)
        if self.EXAMPLE:
            self.reduce_example(*self.EXAMPLE)

    def path(self, name):
        return os.path.join(self.folder, name)

    def read_rest(self, system, sensor):
        """A sensor of a system file in its state of rest or steady motion."""
        import h5py  # a tenth of a second that most tests do without
        self.bough("equilibrium", system, "-o", "rest.h5", "-q")
        with h5py.File(self.path("rest.h5")) as f:
            return f["sensors"][sensor][-1]

    def read_page(self, *files):
        """Text of the page of these files."""
        self.bough("report", *files, "-o", "page.html")
        return self.read("page.html")

    def read(self, name):
        with open(self.path(name)) as f:
            return f.read()

    def write(self, name, text):
        with open(self.path(name), "w") as f:
            f.write(text)
        return name

    def read_arrays(self, name, *paths):
        """Arrays of an HDF5 file."""
        import h5py
        with h5py.File(self.path(name)) as f:
            return [f[path][()] for path in paths]

    def copy_example(self, example):
        source = os.path.join(SOURCE, "data/examples", example)
        for name in os.listdir(source):
            shutil.copy(os.path.join(source, name), self.folder)

    def reduce_example(self, example, body):
        """Copies the example and makes one of its bodies."""
        self.copy_example(example)
        self.bough("reduce", body)

    def bough(self, *arguments, code=0, launcher=(), env=None):
        """Runs and checks the exit code; returns the finished process with stdout and stderr as text."""
        run = served.start if launcher else served.run
        result = run([*launcher, PROGRAM, *map(str, arguments)], cwd=self.folder, timeout=HANG, env={**os.environ, **(env or {})})
        self.assertEqual(result.returncode, code,
                         f"bough {' '.join(map(str, arguments))}\n--- stdout\n{result.stdout}\n--- stderr\n{result.stderr}")
        return result

    def start_held(self, *arguments, call=None, path="", count=1, launcher=(), processes=1, env=None, **more):
        """Starts the program, which stops itself at a point and sleeps there until it has handled a signal.

        The point is the `count`-th call of that function of the C library, PETSc or MPI (tests/support/point.c), whose
        path contains `path`; without `call` it is where a controller of get_astray holds. Returns the process and the
        ids of those that sleep, when `processes` of them do.
        """
        point = {"ASTRAY_PIPE": self.path("hold.pipe"), **(env or {})}
        if call:
            point.update(POINT_CALL=call, POINT_ACT="hold", POINT_PIPE=self.path("hold.pipe"), POINT_COUNT=str(count),
                         LD_PRELOAD=f'{os.environ["BOUGH_POINT"]}:{os.environ["BOUGH_PATIENT"]}', **({"POINT_PATH": path} if path else {}))
        words = [*launcher]
        if launcher:  # the ranks are to sleep, not the launcher
            words += [word for name, value in point.items() for word in ("-x", f"{name}={value}")]
        else:
            more["env"] = {**os.environ, **point}
        if not hasattr(self, "held"):
            os.mkfifo(self.path("hold.pipe"))
            self.held = os.open(self.path("hold.pipe"), os.O_RDWR)  # open to the end: who holds waits for no reader
            self.addCleanup(os.close, self.held)
        process = subprocess.Popen([*words, PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                                   **{"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, **more})
        self.addCleanup(lambda: (process.poll() is None and process.kill(), process.communicate()))
        return process, self.wait_held(process, processes)

    def wait_held(self, process, processes=1):
        """Ids of so many processes, as soon as they sleep."""
        sleeping = b""
        while sleeping.count(b"\n") < processes:
            if select.select([self.held], [], [], 1)[0]:
                sleeping += os.read(self.held, 4096)
            elif process.poll() is not None:
                self.fail(f"ended before the point, exit code {process.returncode}: {process.communicate()}")
        return [int(line) for line in sleeping.split()]

    def interrupt_twice(self, process, message):
        """Interrupts a held process (start_held) and, while it is held again, a second time; it ends with this message."""
        process.send_signal(signal.SIGINT)
        self.wait_held(process)
        process.send_signal(signal.SIGINT)
        _, text = process.communicate(timeout=HANG)
        self.assertEqual(process.returncode, 3)
        self.assertRegex(text, message)

    def fails(self, code, *arguments, says=(), error=None):
        """The call must fail with the code, say every word of `says` and name the error id; nothing on stdout."""
        result = self.bough(*arguments, code=code)
        for words in says:
            self.assertIn(words, result.stderr)
        if error:
            self.assertIn(f"[{error}]", result.stderr)
        self.assertIn("error:", result.stderr)
        return result


# Where the user library tests/support/astray.c fails, and what it does there.
IN_OPEN, IN_START, IN_OUTPUTS, IN_CLOSE, IN_SIZES = range(1, 6)
EXIT, EXIT_AT_ONCE, QUICK_EXIT, ABORT, WRITE_NOWHERE, DIVIDE, OVERFLOW, HOLD, LOOP, FORK = range(1, 11)


def get_astray(place, act, since, signal_name, more=""):
    """A [[controller]] that does `act` at `place` from time `since` on; ASTRAY=0 in the environment keeps it quiet."""
    return (f'[[controller]]\nname = "law"\ntype = "library"\nfile = "{os.environ["BOUGH_ASTRAY"]}"\n'
            f'inputs = ["{signal_name}"]\nparameters = [{place}, {act}, {since}]\n{more}')


BEAM = begin(103, "SPC = 1", "METHOD = 1") + """EIGRL,1,,,3
SPC1,1,123456,1
PBAR,1,1,1.-4,1.-8,1.-8,1.-8
MAT1,1,7.+10,,.3,2700.
""" + row(3) + """CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
ENDDATA
"""
