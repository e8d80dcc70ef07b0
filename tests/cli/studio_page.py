"""A page of `bough studio` in headless Chromium. Skipped, with a message, where chromium is not installed."""
import json
import os
import unittest

from browser import WAIT_FRAMES, BrowserTest, find_chromium
from studio_support import StudioTest


@unittest.skipUnless(find_chromium(), "chromium is not installed")
class PageTest(StudioTest, BrowserTest):
    def setUp(self):
        super().setUp()
        self.browser.renew(1300, 850)

    def open_studio(self, *arguments):
        """The browser at the page of a studio with these arguments."""
        self.start_studio(*arguments)
        self.browser.visit(self.address)
        return self.browser

    def open_system(self, text):
        """The browser at the studio of sliders.toml with this text, its scene drawn."""
        self.write("sliders.toml", text)
        page = self.open_studio("sliders.toml")
        self.wait("document.querySelector('.scene-host').dataset.samples")
        return page

    def keep(self, name):
        folder = os.environ.get("BOUGH_ARTEFACTS")
        if folder:
            os.makedirs(folder, exist_ok=True)
            self.browser.run(WAIT_FRAMES)
            self.browser.screenshot(os.path.join(folder, name + ".png"))

    def wait(self, expression):
        self.assertTrue(self.browser.wait_for(f"!!({expression})"), expression + self.browser.run("document.querySelector('.notes')?.textContent ?? 'no page'"))

    def choose(self, label, text):
        """An option of a list by keys."""
        self.browser.run(f"document.querySelector('select[aria-label={json.dumps(label)}]').focus()")
        self.browser.type(text)
        self.wait(f"document.querySelector('select[aria-label={json.dumps(label)}]').selectedOptions[0].textContent.startsWith({json.dumps(text)})")

    def click_text(self, text, within="document"):
        """Clicks the button with this text."""
        self.browser.run(f"[...{within}.querySelectorAll('button')].find((b) => b.textContent.startsWith({json.dumps(text)}))"
                         ".setAttribute('data-click', 'here')")
        self.browser.click("[data-click=here]")
        self.browser.run("document.querySelector('[data-click=here]')?.removeAttribute('data-click')")

    def open(self, name):
        self.wait(f"document.querySelector('button[data-file={json.dumps(name)}]')")
        self.browser.click(f"button[data-file={json.dumps(name)}]")
        self.wait(f"document.querySelector('main.work').dataset.file === {json.dumps(name)}")

    def click_at(self, x, y):
        self.browser.mouse("mouseMoved", x, y)
        self.browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.browser.mouse("mouseReleased", x, y, button="left", clickCount=1)

    def choose_field(self, name, text):
        """An option of a list in the form of tables, by keys."""
        field = f"document.querySelector('.add-form select[name={name}]')"
        self.browser.run(f"{field}.focus()")
        self.browser.type(text)
        self.wait(f"{field}.value === {json.dumps(text)}")

    def click_node(self, node):
        """Clicks a node of a body in the scene of a system; its number must come into the form of tables."""
        self.browser.show("canvas.scene")
        self.click_at(*self.browser.run(f"""(() => {{ const {{ viewer }} = studio.view, t = viewer.things.find((t) => t.ids?.includes({node}));
          const k = t.ids.indexOf({node}), [x, y] = viewer.find_place(t.points.subarray(3 * k, 3 * k + 3)), b = viewer.canvas.getBoundingClientRect();
          return [b.x + x, b.y + y]; }})()"""))
        self.wait(f"[...document.querySelectorAll('.add-form input')].some((i) => i.value === '{node}')")
