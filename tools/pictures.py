#!/usr/bin/env python3
"""tools/pictures.py PROGRAM [NAME...]: makes the pictures of the manuals anew, docs/pictures/NAME.png, each below
150 kB by a palette: plots and tables of the tutorials, the report page in headless Chromium (which must be installed),
a session of `edit`, figures of the notebooks (where the Python module lies beside PROGRAM). Look at what it made."""
import glob
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

from PIL import Image

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROGRAM = os.path.abspath(sys.argv[1])
PICTURES = os.path.join(ROOT, "docs/pictures")
LARGEST = 150_000
sys.path.insert(0, os.path.join(ROOT, "tests/cli"))
from browser import Browser  # noqa: E402

TERMINAL = """<!DOCTYPE html><meta charset="utf-8"><style>body{margin:0;background:#1d2430}
pre{margin:0;padding:18px 22px;color:#dfe5ee;font:14px/1.35 "DejaVu Sans Mono",monospace;display:inline-block}
b{color:#8fd18f;font-weight:normal}</style><pre id="t">%s</pre>"""


def keep(name, source, colors=96, width=None):
    """A picture with a palette of as many colours as fit, no wider than `width`."""
    image = Image.open(source).convert("RGB")
    if width and image.width > width:
        image = image.resize((width, round(image.height * width / image.width)), Image.LANCZOS)
    target = os.path.join(PICTURES, name + ".png")
    while True:
        image.quantize(colors, dither=Image.Dither.NONE).save(target, optimize=True)
        if os.path.getsize(target) < LARGEST or colors <= 8:
            break
        colors //= 2
    print(f"{name}.png: {image.width} x {image.height}, {colors} colours, {os.path.getsize(target) // 1000} kB")


class Folder:
    """A folder of an example in which commands run."""

    def __init__(self, example):
        self.path = os.path.join(SCRATCH, example)
        if not os.path.exists(self.path):
            self.run("init", example, where=SCRATCH)

    def run(self, *words, where=None):
        ran = subprocess.run([PROGRAM, *words], cwd=where or self.path, text=True, capture_output=True)
        assert ran.returncode == 0, f"{words}\n{ran.stdout}{ran.stderr}"
        return ran.stdout

    def plot(self, name, *words):
        self.run("plot", *words, "-o", name + ".png")
        keep(name, os.path.join(self.path, name + ".png"), 192, 900)

    def page(self, name, selector, *files, width=1180, height=760, before="", wait=2.0):
        """What the window shows when `selector` stands at its top."""
        self.run("report", *files, "-o", "page.html")
        browser = Browser(width, height)
        try:
            browser.open(os.path.join(self.path, "page.html"))
            show = f"document.querySelector({selector!r}).scrollIntoView(), scrollBy(0, -64)"
            browser.run(show)
            time.sleep(wait)
            if before:
                browser.run(before)
                browser.run(show)
                time.sleep(wait)
            path = os.path.join(SCRATCH, "page.png")
            browser.screenshot(path)
            keep(name, path, 128)
        finally:
            browser.close()

    def terminal(self, name, text):
        path = os.path.join(SCRATCH, "terminal.html")
        text = re.sub(r"(?m)^(\$ |[\w.]+> )(.*)$", lambda m: f"\0{m.group(0)}\1", text)
        text = html.escape(text, quote=False).replace("\0", "<b>").replace("\1", "</b>")
        with open(path, "w", encoding="utf-8") as f:
            f.write(TERMINAL % text)
        browser = Browser(1400, 900)
        try:
            browser.open(path, ready="true")
            box = browser.show("#t")
            browser.call("Emulation.setDeviceMetricsOverride", width=round(box["width"]), height=round(box["height"]),
                         deviceScaleFactor=1, mobile=False)
            picture = os.path.join(SCRATCH, "terminal.png")
            browser.screenshot(picture)
            keep(name, picture, 16)
        finally:
            browser.close()


def make_satellite():
    satellite = Folder("satellite")
    satellite.run("reduce", "wing.toml")
    satellite.run("run", "satellite.toml", "-o", "satellite.h5")
    return satellite


def satellite_curves():
    make_satellite().plot("satellite-curves", "satellite.h5", "--sensor", "attitude:1", "--sensor",
                          "/actuators/wheel_z:2", "--sensor", "tip:x", "--subplots")


def satellite_report():
    satellite = make_satellite()
    satellite.run("reduce", "wing.toml", "--full")    # elements in the picture, not lines between the output nodes
    satellite.run("run", "satellite.toml", "-o", "satellite.h5")
    satellite.page("satellite-report", "[data-view=motion]", "satellite.h5", "wing.h5", height=860, before=SCRUB)


def select():
    satellite = Folder("satellite")
    satellite.run("reduce", "wing.toml")
    words = ["select", "wing.h5", "pointing.toml", "--outputs", "tip", "--number", "3", "-o", "small.h5"]
    satellite.terminal("select", "$ bough " + " ".join(words) + "\n" + satellite.run(*words))


def separation():
    stages = Folder("stage-separation")
    stages.run("reduce", "stage.toml")
    stages.run("run", "separation.toml", "-o", "separation.h5")
    stages.plot("separation", "separation.h5", "--sensor", "gap", "--sensor", "tip_off:2", "--sensor", "tip_off:3",
                "--subplots")


def campbell():
    blade = Folder("rotor-blade")
    blade.run("reduce", "blade.toml")
    blade.run("linearize", "rotor.toml", "--at", "4", "--sweep", "rate=0:36:19", "-o", "campbell.h5")
    blade.plot("campbell", "campbell.h5", "--kind", "campbell", "--y-min", "0", "--y-max", "40")


def blade_tip():
    blade = Folder("rotor-blade")
    blade.run("reduce", "blade.toml")
    blade.run("run", "rotor.toml", "-o", "rotor.h5")
    blade.plot("blade-tip", "rotor.h5", "--sensor", "tip:z", "--sensor", "tip:y", "--subplots")


def modes():
    plate = Folder("plate")
    plate.run("reduce", "plate.toml")
    plate.page("modes", "[data-view=modes]", "plate.h5", before=MODE)


def modes_energy():
    plate = Folder("plate")
    plate.run("modes", "plate.bdf", "-n", "6", "--ese", "-o", "modes.h5")
    plate.page("modes-energy", "[data-view=modes]", "modes.h5", before=MODE + ENERGY)


def spinup_report():
    boom = Folder("spinup")
    boom.run("reduce", "boom.toml")
    boom.run("run", "spinup.toml", "-o", "spinup.h5")
    # At 6.77 s, where the boom is bent most, seen along the axis of rotation.
    boom.page("spinup-report", "[data-view=motion]", "spinup.h5", "boom.h5", width=1000, height=1180,
              before=SCRUB.replace("200", "338") + "; [...document.querySelectorAll('.motion button')]"
                     ".find(b => b.textContent === 'z').click()")


def edit():
    boom = Folder("spinup")
    boom.run("reduce", "boom.toml")
    with open(os.path.join(ROOT, "docs/edit.md"), encoding="utf-8") as f:
        session = re.findall(r"(?m)^    spinup\.toml> (.*)$", f.read())
    # Each command by itself, so that its answer stands behind it.
    shutil.copy(os.path.join(boom.path, "spinup.toml"), os.path.join(boom.path, "kept.toml"))
    text, before = "$ bough edit spinup.toml\n", ""
    for k, command in enumerate(session):
        shutil.copy(os.path.join(boom.path, "kept.toml"), os.path.join(boom.path, "spinup.toml"))
        said = subprocess.run([PROGRAM, "edit", "spinup.toml"], cwd=boom.path, text=True, capture_output=True,
                              input="\n".join(session[:k + 1]) + "\n").stdout
        assert said.startswith(before), said
        text += f"spinup.toml> {command}\n{said[len(before):]}"
        before = said
    boom.terminal("edit", text)


def notebooks():
    module = os.path.join(os.path.dirname(os.path.dirname(PROGRAM)), "python")
    for name in ("monte_carlo", "kg_by_hand"):
        folder = os.path.join(SCRATCH, name)
        os.makedirs(folder)
        subprocess.run(["/usr/bin/python3", "-B", os.path.join(ROOT, f"docs/notebooks/{name}.py")], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL, env={**os.environ, "PYTHONPATH": module, "MPLBACKEND": "Agg"})
        for picture in glob.glob(os.path.join(folder, "*.png")):
            keep("notebook-" + name.replace("_", "-"), picture, 64, 640)


MODE = "[...document.querySelectorAll('[data-view=modes] button')].find(b => b.textContent === '▶').click()"
ENERGY = """; (() => { const s = document.querySelector('[aria-label="colour by"]'); s.value = 2;
  s.dispatchEvent(new Event('change')); })()"""
SCRUB = """(() => { const s = document.querySelector('.scrub'); s.value = 200;
  s.dispatchEvent(new Event('input', { bubbles: true })); })()"""
MAKERS = [satellite_curves, satellite_report, select, separation, campbell, blade_tip, modes,
          modes_energy, spinup_report, edit, notebooks]
with tempfile.TemporaryDirectory(prefix="bough-pictures-") as SCRATCH:
    os.makedirs(PICTURES, exist_ok=True)
    for maker in MAKERS:
        if len(sys.argv) == 2 or maker.__name__ in sys.argv[2:]:
            maker()
