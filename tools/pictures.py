#!/usr/bin/env python3
"""tools/pictures.py PROGRAM [NAME...]: makes the pictures of the manuals again, docs/pictures/NAME.png, each below
150 kB by a palette. A picture comes from the commands of one page, run as printed up to the one that makes it (SHOTS):
a plot, a table of the terminal, or the report page in headless Chromium (which must be installed). Besides, the steps
of docs/studio.md, a session of `edit` and the figures of the notebooks (if the Python module is next to PROGRAM). All
have one font, DejaVu Sans. Look at the result."""
import contextlib
import dataclasses
import glob
import html
import os
import re
import shutil
import shlex
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PICTURES = os.path.join(ROOT, "docs/pictures")
LARGEST = 150_000
FONT = "DejaVu Sans"
os.environ.setdefault("BOUGH_PROGRAM", os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else "")
os.environ.setdefault("BOUGH_SOURCE_DIR", ROOT)
sys.path[:0] = [os.path.join(ROOT, "tests", folder) for folder in ("cli", "support")]
from browser import WAIT_FRAMES, Browser  # noqa: E402
from page_blocks import list_commands  # noqa: E402
from studio_browser_test import PROJECT  # noqa: E402
from studio_page import PageTest  # noqa: E402

TERMINAL = """<!DOCTYPE html><meta charset="utf-8"><style>body{margin:0;background:#1d2430}
pre{margin:0;padding:18px 22px;color:#dfe5ee;font:14px/1.35 "DejaVu Sans Mono",monospace;display:inline-block}
b{color:#8fd18f;font-weight:normal}</style><pre id="t">%s</pre>"""


def quantize(image, colors):
    """With a palette: half of it the most frequent colours as they are, so that grounds and legends keep theirs."""
    found, at, counts = np.unique(np.asarray(image).reshape(-1, 3), axis=0, return_inverse=True, return_counts=True)
    exact = found[np.argsort(-counts)[:colors // 2]]
    rest = image.quantize(colors - len(exact), Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).getpalette()
    palette = np.concatenate([exact, np.reshape(rest, (-1, 3))])[:colors].astype(int)
    nearest = [np.argmin(np.square(palette - color).sum(axis=1)) for color in found.astype(int)]
    small = Image.fromarray(np.array(nearest, np.uint8)[at].reshape(image.height, image.width), "P")
    small.putpalette(palette.astype(np.uint8).tobytes())
    return small


def keep(name, source, folder, width=None):
    """A picture with a palette of as many colours as fit, no wider than `width`."""
    colors = 256
    image = Image.open(source).convert("RGB")
    if width and image.width > width:
        image = image.resize((width, round(image.height * width / image.width)), Image.LANCZOS)
    target = os.path.join(folder, name + ".png")
    while True:
        quantize(image, colors).save(target, optimize=True)
        if os.path.getsize(target) < LARGEST or colors <= 8:
            break
        colors //= 2
    print(f"{name}.png: {image.width} x {image.height}, {colors} colours, {os.path.getsize(target) // 1000} kB")


SATELLITE, STAGES, BLADE, ROTOR = (
    "docs/tutorials/" + name + ".md" for name in ("satellite", "stage-separation", "rotor-blade", "rotor"))
REPORT = "docs/report.md"
MODE = "[...document.querySelectorAll('[data-view=modes] button')].find(b => b.textContent === '▶').click()"
ENERGY = """; (() => { const s = document.querySelector('[aria-label="colour by"]'); s.value = 2;
  s.dispatchEvent(new Event('change')); })()"""
SCRUB = """(() => { const s = document.querySelector('.scrub'); s.value = %d;
  s.dispatchEvent(new Event('input', { bubbles: true })); })()"""
SET_FONT = f"document.documentElement.style.setProperty('--font', '\\'{FONT}\\''); 0"
# Time histories come below the scene.
MOTION = "[data-view=motion]"
SMALL = "document.querySelector('.motion canvas.scene').style.height = '300px'; "
STRESS = """(() => { const s = document.querySelector('[aria-label="colour by"]');
  s.value = [...s.options].find((o) => o.textContent.startsWith('von Mises')).value;
  s.dispatchEvent(new Event('change'));
  [...document.querySelectorAll('[data-view=modes] button')].find((b) => b.textContent === 'z').click();
  const press = (key, times, shiftKey) => { for (let k = 0; k < times; ++k)
    document.querySelector('[data-view=modes] canvas')
      .dispatchEvent(new KeyboardEvent('keydown', { key, shiftKey })); };
  press('+', 6, false); press('ArrowLeft', 8, true); press('ArrowDown', 9, true); })()"""
SHOW_ALL = "; [...document.querySelectorAll('.motion button')].find(b => b.textContent === 'all').click()"
LOOK_ALONG_Z = "; [...document.querySelectorAll('.motion button')].find(b => b.textContent === 'z').click()"


@dataclasses.dataclass
class Shot:
    """A picture by the command of `page` that has `part` in it: the plot or page that it writes, or what it prints."""
    page: str
    part: str
    selector: str = ""      # of a report page: what is at the top of the window
    before: str = ""        # script that is run there
    width: int = 1180
    height: int = 760

    def find_command(self):
        with open(os.path.join(ROOT, self.page), encoding="utf-8") as f:
            commands = list_commands(f.read())
        found = [command for command in commands if self.part in command]
        assert len(found) == 1, f"{self.page} prints {len(found)} commands with {self.part}"
        return commands, found[0]


SHOTS = {
    "satellite-curves": Shot(SATELLITE, "-o satellite.svg"),
    "satellite-report": Shot(SATELLITE, "-o satellite.html", MOTION, SMALL + SCRUB % 200 + SHOW_ALL, height=1240),
    "select": Shot(SATELLITE, "bough select"),
    "separation": Shot(STAGES, "-o separation.svg"),
    "campbell": Shot(BLADE, "-o campbell.svg"),
    "blade-tip": Shot(BLADE, "-o tip.svg"),
    "rotor-campbell": Shot(ROTOR, "-o campbell.svg"),
    "rotor-unbalance": Shot(ROTOR, "-o unbalance.svg"),
    "modes": Shot(REPORT, "-o plate.html", "[data-view=modes]", MODE),
    "modes-energy": Shot(REPORT, "-o modes.html", "[data-view=modes]", MODE + ENERGY),
    # At 6.77 s, where the boom is bent most, seen along the axis of rotation.
    "spinup-report": Shot(REPORT, "-o spinup.html", MOTION, SMALL + SCRUB % 338 + LOOK_ALONG_Z + SHOW_ALL, 1000, 1260),
    "contours": Shot(REPORT, "-o hole.html", "[data-view=modes]", STRESS),
}


# Figures that pages show as the SVG that a command of the page writes: docs/NAME.svg.
FIGURES = {name: Shot(f"data/examples/{example}/README.md", f"-o {name}.svg") for name, example in (
    ("figure5", "ex01-spinup"), ("figure8", "ex02-hub"), ("figure10", "ex05-plate"))}


def choose_grids(page):
    """Steps 1 and 2 of docs/studio.md: two grids of the plate are clicked, the deck is checked."""
    page.wait("studio.view?.stage")
    for grid in (207, 212):
        page.click_at(*page.browser.run(PROJECT % grid))
        page.wait(f"document.querySelector('.side .picked').textContent.startsWith('grid {grid} (')")
    page.click_text("Check")
    page.wait("document.querySelector('.side .messages').textContent.includes('free DOFs')")
    page.browser.run("studio.show_jobs()")  # the check has ended


def run_system(page):
    """Steps 2 to 5: body file, its modes, a sensor at a node that is clicked, a run."""
    browser = page.browser
    browser.click("button.make-body")
    page.wait("document.querySelector('dialog pre.diff')")
    page.click_text("Save", "document.querySelector('dialog')")
    page.wait("document.querySelector('main.work').dataset.file === 'plate.toml'")
    page.wait("document.querySelector('.text-pane').dataset.checked === '0'")
    browser.click("button.reduce")
    page.wait("document.querySelector('.result').dataset.ready === 'true'")
    page.open("plate-run.toml")
    page.wait("document.querySelector('.scene-host').dataset.samples")
    browser.click(".add-form summary")
    page.wait("document.querySelector('.add-form [name=name]')")
    page.choose("table of the form", "sensor")
    page.choose_field("type", "deflection")
    page.click_node(212)
    browser.click(".add-form .main")
    page.wait("studio.view.pane.text.includes('sensor1')")
    page.wait("document.querySelector('.text-pane').dataset.checked === '0'")
    browser.click("button.run")
    page.wait("document.querySelector('dialog pre.diff')")
    page.click_text("Save", "document.querySelector('dialog')")
    page.wait("document.querySelector('.result').dataset.ready === 'true'")
    browser.run("""for (const [name, value] of [['time', 70], ['deformation ×', 2.2]]) {
      const slider = document.querySelector(`.motion input[aria-label="${name}"]`);
      slider.value = value;
      slider.dispatchEvent(new Event('input', { bubbles: true }));
    }""")


# Pictures of the studio, one after the other in one session.
STUDIO = {"studio-deck": choose_grids, "studio-run": run_system}


class Pages:
    """Pages followed in folders of their own: each command once, in the order of its page."""

    def __init__(self, program, scratch):
        self.program, self.scratch, self.pages, self.browser = program, scratch, {}, None

    def close(self):
        if self.browser:
            self.browser.close()

    def show(self, page, width, height, **more):
        """The browser, with the page in a window of this size."""
        self.browser = self.browser or Browser()
        self.browser.renew(width, height)
        self.browser.open(page, **more)
        self.browser.run(SET_FONT)
        return self.browser

    def follow(self, page, commands, last):
        """Runs the commands up to `last`: its folder and what it printed."""
        if page not in self.pages:
            folder = os.path.join(self.scratch, re.sub(r"\W+", "-", page))
            if page.startswith("data/examples"):
                shutil.copytree(os.path.join(ROOT, os.path.dirname(page)), folder)
            else:
                os.makedirs(folder)
            self.pages[page] = [folder, 0, {}]
        state = self.pages[page]
        while last not in state[2]:
            command = commands[state[1]]
            for part in command.split("&&"):
                words = shlex.split(part)
                if words[0] == "cd":
                    state[0] = os.path.join(state[0], words[1])
                    continue
                ran = subprocess.run([self.program, *words[1:]], cwd=state[0], text=True, capture_output=True)
                assert ran.returncode == 0, f"{page}: {command}\n{ran.stdout}{ran.stderr}"
            state[1] += 1
            state[2][command] = (state[0], ran.stdout if words[0] != "cd" else "")
        return state[2][last]

    def take(self, name, folder):
        """The picture NAME.png in `folder`."""
        shot = SHOTS[name]
        commands, command = shot.find_command()
        where, printed = self.follow(shot.page, commands, command)
        if shot.selector:
            self.take_page(name, os.path.join(where, shot.part.split()[-1]), shot, folder)
        elif shot.part.startswith("-o "):
            picture, plot = (os.path.join(self.scratch, "plot" + ending) for ending in (".png", ".svg"))
            with open(os.path.join(where, shot.part.split()[-1]), encoding="utf-8") as f:
                text = re.sub(r'font-family="[^"]*"', f'font-family="{FONT}"', f.read())
            with open(plot, "w", encoding="utf-8") as f:
                f.write(text)
            subprocess.run(["rsvg-convert", "--background-color=white", "--format=png", "--output=" + picture, plot],
                           check=True)
            keep(name, picture, folder, 900)
        else:
            self.take_terminal(name, f"$ {command}\n{printed}", folder)

    def draw(self, name):
        """The file of the figure NAME."""
        commands, command = FIGURES[name].find_command()
        where, _ = self.follow(FIGURES[name].page, commands, command)
        return os.path.join(where, name + ".svg")

    def take_page(self, name, page, shot, folder):
        browser = self.show(page, shot.width, shot.height)
        show = f"document.querySelector({shot.selector!r}).scrollIntoView(), scrollBy(0, -64)"
        for script in [show] + [shot.before] * bool(shot.before) + [show]:
            browser.run(script)
            browser.settle()
        picture = os.path.join(self.scratch, "page.png")
        browser.screenshot(picture)
        keep(name, picture, folder)

    def take_studio(self, folder):
        """Pictures of a session that follows docs/studio.md, in the folder that its commands make."""
        commands, last = Shot("docs/studio.md", "bough init plate").find_command()
        where, _ = self.follow("docs/studio.md", commands[commands.index(last):], last)
        self.browser = self.browser or Browser()
        page = PageTest()
        page.browser, page.folder = self.browser, os.path.join(where, last.split()[-1])
        self.browser.renew(1300, 850)
        try:
            page.open_studio("plate.bdf")
            self.browser.run(SET_FONT)
            for name, act in STUDIO.items():
                act(page)
                self.browser.run(WAIT_FRAMES)
                picture = os.path.join(self.scratch, "studio.png")
                self.browser.screenshot(picture)
                keep(name, picture, folder, 1000)
        finally:
            page.doCleanups()

    def take_terminal(self, name, text, folder):
        path = os.path.join(self.scratch, "terminal.html")
        text = re.sub(r"(?m)^(\$ |[\w.]+> )(.*)$", lambda m: f"\0{m.group(0)}\1", text)
        text = html.escape(text, quote=False).replace("\0", "<b>").replace("\1", "</b>")
        with open(path, "w", encoding="utf-8") as f:
            f.write(TERMINAL % text)
        browser = self.show(path, 1400, 900, ready="true")
        box = browser.show("#t")
        browser.call("Emulation.setDeviceMetricsOverride", width=round(box["width"]), height=round(box["height"]),
                     deviceScaleFactor=1, mobile=False)
        picture = os.path.join(self.scratch, "terminal.png")
        browser.screenshot(picture)
        keep(name, picture, folder)

    def take_edit(self, folder):
        """The session that docs/edit.md prints, in the folder of its example."""
        where = os.path.join(self.scratch, "edit")
        for words, at in ((["init", "spinup", "-o", where], self.scratch), (["reduce", "boom.toml"], where)):
            subprocess.run([self.program, *words], cwd=at, check=True, capture_output=True)
        with open(os.path.join(ROOT, "docs/edit.md"), encoding="utf-8") as f:
            session = re.findall(r"(?m)^    spinup\.toml> (.*)$", f.read())
        # Each command by itself, so that its answer stands behind it.
        shutil.copy(os.path.join(where, "spinup.toml"), os.path.join(where, "kept.toml"))
        text, before = "$ bough edit spinup.toml\n", ""
        for k, command in enumerate(session):
            shutil.copy(os.path.join(where, "kept.toml"), os.path.join(where, "spinup.toml"))
            printed = subprocess.run([self.program, "edit", "spinup.toml"], cwd=where, text=True, capture_output=True,
                                     input="\n".join(session[:k + 1]) + "\n").stdout
            assert printed.startswith(before), printed
            text += f"spinup.toml> {command}\n{printed[len(before):]}"
            before = printed
        self.take_terminal("edit", text, folder)

    def take_notebooks(self, folder):
        module = os.path.join(os.path.dirname(os.path.dirname(self.program)), "python")
        for name in ("monte_carlo", "kg_by_hand"):
            where = os.path.join(self.scratch, name)
            os.makedirs(where)
            subprocess.run(["/usr/bin/python3", "-B", os.path.join(ROOT, f"docs/notebooks/{name}.py")], cwd=where,
                           check=True, stdout=subprocess.DEVNULL,
                           env={**os.environ, "PYTHONPATH": module, "MPLBACKEND": "Agg"})
            for picture in glob.glob(os.path.join(where, "*.png")):
                keep("notebook-" + name.replace("_", "-"), picture, folder, 640)


def main(program, names):
    os.makedirs(PICTURES, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="bough-pictures-") as scratch:
        with contextlib.closing(Pages(os.path.abspath(program), scratch)) as pages:
            for name in SHOTS:
                if not names or name in names:
                    pages.take(name, PICTURES)
            for name in FIGURES:
                if not names or name in names:
                    shutil.copy(pages.draw(name), os.path.join(ROOT, "docs"))
            if not names or set(STUDIO) & set(names):
                pages.take_studio(PICTURES)
            if not names or "edit" in names:
                pages.take_edit(PICTURES)
            if not names or "notebooks" in names:
                pages.take_notebooks(PICTURES)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
