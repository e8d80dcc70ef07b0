"""Every command that a page of the manuals shows is run as printed, and what a page shows as its output is what comes.

A block of four blanks is read line by line: lines that begin with bough, cd or ./dev bough are commands (what stands
three blanks behind one is a remark), the others are output. A ```toml block whose first line is "# NAME.toml" is
written under that name, a ```python block is run where the module was built. PAGES says what must lie in the folder
before, and what is left out; a page with commands that is not among them fails the last test here.
"""
import dataclasses
import functools
import glob
import os
import re
import shlex
import shutil
import subprocess
import unittest

from page_blocks import list_blocks, list_commands, split_lines
from support import HANG, PROGRAM, SOURCE, ProgramTest, served
from decks import begin, row
from toml_text import section, table, toml

HAS_PNG = shutil.which("rsvg-convert") is not None
MODULE = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "python")


@dataclasses.dataclass
class Page:
    """Files and commands for a page."""
    examples: tuple = ()     # copied to the folder first
    before: tuple = ()       # commands that make what the page takes for granted
    files: dict = dataclasses.field(default_factory=dict)      # name: text, also taken for granted
    stands_for: dict = dataclasses.field(default_factory=dict)  # what the page writes: what is meant here
    left_out: tuple = ()     # commands with these words are not run here
    output: bool = False     # every line shown must come
    python: str = ""         # run before the ```python blocks, which then are one script



def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as f:
        return f.read()


@functools.cache
def has_module():
    tries = "import bough; bough.FlexBody"  # without it, an ImportError
    return subprocess.run(["/usr/bin/python3", "-B", "-c", tries], capture_output=True,
                          env={**os.environ, "PYTHONPATH": MODULE}).returncode == 0


def plain(line):
    """A line of output without residuals, which depend on the machine, and with single blanks."""
    return " ".join(re.sub(r"\b\d\.\de-\d\d\b", "", line).split())


class Pages(ProgramTest):
    def run_command(self, command, page):
        if not HAS_PNG:
            command = command.replace(".png", ".svg").replace(".pdf", ".svg")
        words = shlex.split(command, comments=True)
        if words and words[0].endswith("dev"):
            words = words[1:]
        if words[0] == "cd":
            self.where = os.path.normpath(os.path.join(self.where, words[1]))
            return ""
        words, taken_in, given_out = words[1:], None, None
        if "<" in words:
            taken_in = os.path.join(self.where, words.pop(words.index("<") + 1))
            words.remove("<")
        if ">" in words:
            given_out = os.path.join(self.where, words.pop(words.index(">") + 1))
            words.remove(">")
        with open(taken_in or os.devnull) as stdin:
            ran = served.run([PROGRAM, *words], cwd=self.where, timeout=HANG, stdin=stdin)
        self.assertEqual(ran.returncode, 0, f"{page}: {command}\n{ran.stdout}{ran.stderr}")
        if given_out:
            with open(given_out, "w", encoding="utf-8") as f:
                f.write(ran.stdout)
        return ran.stdout + ran.stderr

    def prepare(self, page):
        self.where = self.folder
        for example in page.examples:
            self.copy_example(example)
        for name, text in page.files.items():
            self.write(name, text)
        for command in page.before:
            self.run_command("bough " + command, "before")

    def run_python(self, name, text):
        """Leaves out commands of the module where it cannot be loaded: not built, or built with sanitizers."""
        if "import bough" in text and not has_module():
            return
        ran = subprocess.run(["/usr/bin/python3", "-B", "-c", text], cwd=self.where, text=True, capture_output=True,
                             env={**os.environ, "PYTHONPATH": MODULE})
        self.assertEqual(ran.returncode, 0, f"{name}:\n{text}\n{ran.stdout}{ran.stderr}")

    def follow(self, name, page):
        self.prepare(page)
        text, printed = read(name), []
        for shown, meant in page.stands_for.items():
            text = re.sub(rf"(?<![\w./-]){re.escape(shown)}(?![\w./-])", lambda _: meant, text)
        script = page.python
        for kind, lines in list_blocks(text):
            if kind == "toml":
                named = re.match(r"# ([\w.-]+\.toml)", lines[0])
                if named:
                    with open(os.path.join(self.where, named.group(1)), "w", encoding="utf-8") as f:
                        f.write("\n".join(lines) + "\n")
            if kind == "python":
                script = (script + "\n" if page.python else "") + "\n".join(lines)
                if not page.python:
                    self.run_python(name, script)
            if kind != "lines":
                continue
            commands, others = split_lines(lines)
            for command in commands:
                for part in command.split("&&"):
                    if not any(word in part for word in page.left_out):
                        printed += self.run_command(part.strip(), name).split("\n")
            if page.output and printed:
                came = {plain(line) for line in printed}
                for line in others:
                    if line.strip() != "...":
                        self.assertIn(plain(line), came, f"{name}: is not printed")
        if page.python:
            self.run_python(name, script)


def add_page(name, page):
    def test(self):
        self.follow(name, page)
    setattr(Pages, "test_" + re.sub(r"\W+", "_", name), test)


def example(name, **more):
    return Page((name,), **more)


# Files for the pages about formats: a body of the boom, its modes, a second of its spin-up.
BOOM = ("reduce boom.toml -q", "modes boom.bdf -o modes.h5 -q", "run short.toml -o run.h5 -q")
SHORT = {"short.toml": read("data/examples/ex01-spinup/spinup.toml").replace("duration = 20.0", "duration = 1.0")}
TIP = {"short.toml": SHORT["short.toml"].replace('"tip_deflection"', '"tip"').replace("duration = 1.0", "duration = 12.0")}
DENSITY = toml(
    section("campaign", steps=["reduce boom.toml", "run short.toml -o run.h5"]),
    table("parameter", "density", file="boom.bdf", card="MAT1", id=1, field="RHO", values=[2700.0, 2800.0]),
    table("collect", "tip_max", file="run.h5", dataset="/sensors/tip", column=2, take="absmax"))
RESPONSE = begin(111, "SPC = 1", "METHOD = 1", "DLOAD = 5", "FREQ = 6", "DISPLACEMENT = ALL") + """EIGRL,1,,,4
SPC1,1,123456,1
PBAR,1,1,1.-4,1.-8,1.-8,1.-8
MAT1,1,7.+10,,.3,2700.
""" + row(2) + """CBAR,1,1,1,2,0.,1.,0.
PARAM,G,0.02
FREQ1,6,1.,1.,5
RLOAD1,5,7,,,8
DAREA,7,2,2,1.
TABLED1,8
,0.,1.,100.,1.,ENDT
ENDDATA
"""
ARM = toml(
    table("body", "rotor", mass=1.0, inertia=[1.0, 1.0, 2.0]),
    table("hinge", "axis", "revolute", child="rotor", position=0.1),
    table("sensor", "angle", "hinge_angle", hinge="axis"),
    table("sensor", "rate", "hinge_rate", hinge="axis"),
    table("controller", "law", "expression", inputs=["angle", "rate"], expression="-8*u1 - 1.6*u2"),
    table("actuator", "drive", "hinge", hinge="axis", input="law"),
    table("input", "torque"),
    table("actuator", "motor", "hinge", hinge="axis", input="torque"),
    section("simulation", duration=1.0))
FLYER = toml(
    section("parameters", gain=1.0, mass=800.0, seed=1),
    table("body", "hub", mass="$mass", inertia=[100.0, 100.0, 200.0]),
    table("hinge", "axis", "revolute", child="hub", position=0.1),
    table("sensor", "angle", "hinge_angle", hinge="axis", sample_time=0.1, noise_density=1e-4, seed="$seed"),
    table("controller", "p", "gain", inputs=["angle"], gain="$gain"),
    table("actuator", "drive", "hinge", hinge="axis", input="p", scale=-1.0),
    section("simulation", duration=1.0))
LAUNCHER = toml(
    section("parameters", speed=100.0, fill=0.5),
    table("body", "stage", mass="$fill", inertia=[1.0, 1.0, 2.0]),
    table("hinge", "pitch", "revolute", child="stage", stiffness=["$speed"]),
    table("sensor", "angle", "hinge_angle", hinge="pitch"),
    section("simulation", duration=1.0))
SAME = {name: "boom.h5" for name in ("A.h5", "B.h5", "C.h5", "BODY.h5")}


def boom(files=None, before=(), **more):
    return Page(("ex01-spinup",), (*BOOM, *before), {**SHORT, **(files or {})}, **more)


READER = os.path.join(SOURCE, "python/bough")   # the reader alone, as the page has it
PAGES = {
    "README.md": Page(files={"your.bdf": read("data/decks/free-free.bdf")}),
    "docs/guide.md": Page(output=True),
    "docs/install.md": Page(),
    "docs/coming-from-adams.md": Page(),
    "docs/coming-from-mbdyn.md": Page(),
    "docs/tutorials/satellite.md": Page(output=True),
    "docs/tutorials/stage-separation.md": Page(output=True),
    "docs/tutorials/flx-batch.md": Page(output=True),
    "docs/tutorials/rotor-blade.md": Page(output=True),
    "docs/tutorials/mast-in-parts.md": Page(output=True),
    "docs/tutorials/rotor.md": Page(output=True),
    "docs/python.md": boom({"arm.toml": ARM}, python=f"import sys\nsys.path.insert(0, {READER!r})",
                           stands_for={"spinup.toml": "short.toml", "spinup.h5": "run.h5"}),
    "docs/report.md": Page(),
    "docs/developer/tour.md": Page(),
    "docs/command-line.md": boom({**TIP, "density.toml": DENSITY}, ("batch density.toml -q",),
                                 left_out=("COMMAND", "--srs"), stands_for={  # curves_test.py
        "a.h5": "run.h5", "b.h5": "run.h5", "outcomes.h5": "density/outcomes.h5"}),
    "docs/other-fe-codes.md": boom(
        {"wing.bdf": read("data/examples/ex08-satellite/wing.bdf")},
        ("matrices wing.bdf --to op4 -o wing.op4 -q", "modes wing.bdf -n 8 -o wing.h5 --op2 wing.op2 -q"),
        left_out=(".pch", ".mtx")),   # punch and Abaqus files: matrix_bodies_test.py
    "docs/fmu.md": boom(),
    "docs/formats/flx.md": boom(
        {name: read("data/integrals/" + name) for name in ("test.inp", "test.mat")},
        stands_for={"left.h5": "boom.h5", "right.h5": "boom.h5"}),
    "docs/formats/uff.md": boom({"tip.bdf": RESPONSE}, ("frequency tip.bdf -o bracket.h5 -q",),
                                stands_for={"results.h5": "run.h5"}),
    "docs/formats/pvd.md": boom(stands_for={"hub": "boom"}),
    "docs/formats/gltf.md": boom(),
    "docs/formats/system-units.md": boom(stands_for={
        "mm/boom.h5": "mm-boom.h5", "mm/spinup.toml": "mm-spinup.toml"}),   # a folder that the reader makes
    "docs/formats/vtu.md": Page(("ex05-plate",), stands_for={"DECK": "plate.bdf"}),
    "docs/formats/mat.md": boom(stands_for={"FILE.h5": "run.h5"}),
    "docs/formats/sid.md": boom(stands_for=SAME),
    "docs/formats/mbdyn.md": boom(stands_for=SAME),
    "docs/formats/flat.md": boom(stands_for=SAME),
    "docs/formats/campaign-toml.md": Page(
        ("ex08-satellite", "ex01-spinup"), ("reduce wing.toml -q",), {"study.toml": DENSITY, "flyer.toml": FLYER, **TIP},
        stands_for={"samples = 20": "samples = 2", "samples = 1000": "samples = 2", "[1, 1000]": "[1, 2]", "number = 1000": "number = 2"}),
    "docs/formats/linear.md": Page(files={"launcher.toml": LAUNCHER}),
    "docs/formats/comparison.md": boom(
        before=("matrices boom.bdf -o MATRICES.h5 -q",), stands_for={**SAME, "DECK": "boom.bdf", "N": "3"},
        left_out=("--refinement", "--test", "--sensors")),  # compare_test.py: three meshes; correlation_test.py
    **{f"data/examples/{name}/README.md": example(name) for name in (
        "ex02-hub", "ex03-two-link", "ex07-four-bar", "ex08-satellite", "ex09-stage-separation", "ex10-robot-arm",
        "ex11-rotor-blade", "ex12-launcher", "ex13-observatory", "ex14-rotor", "ex15-bicycle", "ex16-random", "ex17-component")},
}
for page_name, page_needs in PAGES.items():
    add_page(page_name, page_needs)

# Followed by a test of their own.
ELSEWHERE = {
    "docs/tutorial.md": "docs_test.py",
    "docs/your-deck.md": "docs_test.py",
    "docs/external-superelements.md": "superelements_test.py",
    "docs/random-response.md": "random_outputs_test.py",
    "docs/pointing.md": "pointing_test.py",
    "docs/studio.md": "studio_test.py",
    **{f"data/examples/{name}/README.md": "docs_test.py" for name in (
        "ex01-spinup", "ex04-free-flyer", "ex05-plate", "ex06-campaign")},
}


class Others(ProgramTest):
    def test_every_page_with_commands_is_run(self):
        paths = glob.glob(os.path.join(SOURCE, "docs/**/*.md"), recursive=True)
        paths += glob.glob(os.path.join(SOURCE, "data/examples/*/README.md")) + [os.path.join(SOURCE, "README.md")]
        names = [os.path.relpath(path, SOURCE) for path in sorted(paths)]
        missing = [name for name in names if list_commands(read(name)) and name not in {**PAGES, **ELSEWHERE}]
        self.assertEqual(missing, [], "pages with commands that no test runs: add them to PAGES")
        for name, test in ELSEWHERE.items():
            self.assertIn(name.split("/")[-2 if "examples" in name else -1], read("tests/cli/" + test))

    def test_pictures_are_small_and_shown(self):
        pages = "".join(read(os.path.relpath(path, SOURCE)) for path in
                        glob.glob(os.path.join(SOURCE, "docs/**/*.md"), recursive=True) + [os.path.join(SOURCE, "README.md")])
        pictures = glob.glob(os.path.join(SOURCE, "docs/**/*.png"), recursive=True)
        self.assertTrue(pictures)
        for path in pictures:
            self.assertLess(os.path.getsize(path), 150_000, path)
            self.assertIn(os.path.basename(path), pages)

    def test_commands_are_told_from_output(self):
        text = "x\n\n    bough a -o b.h5 \\\n      --c   a remark\n    out 1\n\ny\n\n    ./dev bough d    (so)\n\n```toml\n    bough e\n```\n"
        self.assertEqual(list_commands(text), ["bough a -o b.h5 --c", "./dev bough d"])

    def test_the_editing_session(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        session = re.findall(r"(?m)^    spinup\.toml> (.*)$", read("docs/edit.md"))
        self.assertIn("save", session)
        ran = served.run([PROGRAM, "edit", "spinup.toml"], cwd=self.folder, input="\n".join(session) + "\n")
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        with open(self.path("spinup.toml")) as f:
            text = f.read()
        self.assertIn("duration = 5\n", text.replace(" #", "\n#"))
        self.bough("check", "spinup.toml")


if __name__ == "__main__":
    unittest.main()
