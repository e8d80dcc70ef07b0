"""Headless Chromium by its debugging pipe: no other package is needed. Absent: find_chromium() is None."""
import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

from support import HANG, ProgramTest

# A view is drawn a frame after it was made.
WAIT_FRAMES = "new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))"


def find_chromium():
    return os.environ.get("BOUGH_CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")


class Browser:
    def __init__(self, width=1300, height=900):
        self.folder = tempfile.mkdtemp(prefix="bough-browser-")
        to_read, self.to = os.pipe()
        self.back, to_write = os.pipe()
        # The browser reads at 3 and writes at 4.
        words = [find_chromium(), "--headless=new", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader",
                 "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--no-first-run", "--remote-debugging-pipe",
                 f"--user-data-dir={self.folder}", f"--window-size={width},{height}", "about:blank"]
        self.process = subprocess.Popen(["bash", "-c", f'exec "$@" 3<&{to_read} 4>&{to_write}', "bash", *words],
                                        pass_fds=(to_read, to_write), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                        env={**os.environ, "HOME": self.folder})
        os.close(to_read)
        os.close(to_write)
        self.left, self.number, self.session, self.context = b"", 0, None, None
        self.renew(width, height)

    def renew(self, width=1300, height=900):
        """An empty page that shares nothing with those before it: a start of the browser takes seconds."""
        self.session, self.events = None, []
        if self.context:
            self.call("Target.disposeBrowserContext", browserContextId=self.context)
        self.context = self.call("Target.createBrowserContext")["browserContextId"]
        target = self.call("Target.createTarget", url="about:blank", browserContextId=self.context)["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self.call(domain + ".enable")
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def close(self):
        try:
            self.session = None
            self.call("Browser.close")
            self.process.wait(HANG)
        except (OSError, RuntimeError, subprocess.TimeoutExpired):
            self.process.kill()
        self.process.wait()
        os.close(self.to)
        os.close(self.back)
        shutil.rmtree(self.folder, ignore_errors=True)

    def receive(self):
        while b"\0" not in self.left:
            if not select.select([self.back], [], [], HANG)[0]:
                raise RuntimeError("the browser does not answer")
            more = os.read(self.back, 1 << 20)
            if not more:
                raise RuntimeError("the browser is gone")
            self.left += more
        message, self.left = self.left.split(b"\0", 1)
        return json.loads(message)

    def call(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.to, data):]
        while True:
            answer = self.receive()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def run(self, expression):
        """The value of a JavaScript expression; a promise is waited for."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(json.dumps(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def wait_for(self, expression):
        end = time.monotonic() + HANG
        while time.monotonic() < end:
            if self.run(expression):
                return True
            time.sleep(0.05)
        return False

    def settle(self):
        """Views of a report page that are on the screen are built, and what they show is drawn."""
        shown = ("[...document.querySelectorAll('.live')].filter((one) => { const b = one.getBoundingClientRect();"
                 " return b.bottom > 0 && b.top < innerHeight; })")
        if not self.wait_for(f"{shown}.every((one) => one.classList.contains('built'))"):
            raise RuntimeError("a view is not built: " + "; ".join(self.list_errors()))
        self.run(WAIT_FRAMES)

    def open(self, path, **more):
        self.visit("file://" + os.path.abspath(path), **more)

    def visit(self, address, ready="document.documentElement.dataset.ready === 'true'"):
        self.events = []
        self.call("Page.navigate", url=address)
        if not self.wait_for(f"document.readyState === 'complete' && ({ready})"):
            raise RuntimeError("the page does not get ready: " + "; ".join(self.list_errors()))

    def reload(self):
        """The page again from its start: its objects are new."""
        self.run("globalThis.is_before = true")
        self.call("Page.reload")
        end = time.monotonic() + HANG
        while time.monotonic() < end:
            try:
                if self.run("!globalThis.is_before && document.documentElement.dataset.ready === 'true'"):
                    return
            except RuntimeError:  # between two pages
                pass
            time.sleep(0.05)
        raise RuntimeError("the page does not get ready: " + "; ".join(self.list_errors()))

    def type(self, text):
        """Into the element with the focus, by key events. Their times are those of a fast typist on any machine: a list
        forgets letters that come more than a second apart."""
        begin = time.time()
        for i, letter in enumerate(text):
            key = "Enter" if letter == "\n" else letter
            code = {"windowsVirtualKeyCode": 13} if letter == "\n" else {}
            self.call("Input.dispatchKeyEvent", type="keyDown", key=key, text="\r" if letter == "\n" else letter,
                      timestamp=begin + 1e-3 * i, **code)
            self.call("Input.dispatchKeyEvent", type="keyUp", key=key, timestamp=begin + 1e-3 * i, **code)

    def press(self, key, modifiers=0):
        more = {"windowsVirtualKeyCode": 8} if key == "Backspace" else {}  # with it the browser edits a text
        self.call("Input.dispatchKeyEvent", type="rawKeyDown", key=key, code=key, modifiers=modifiers, **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, code=key, modifiers=modifiers, **more)

    def list_errors(self):
        """Exceptions of the script, and errors of the console and the log (breaches of the policy among them)."""
        self.run("1")
        errors = []
        for event in self.events:
            method, p = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                errors.append(p["exceptionDetails"].get("exception", {}).get("description") or p["exceptionDetails"]["text"])
            elif method == "Runtime.consoleAPICalled" and p["type"] in ("error", "assert"):
                errors.append(str(p["args"]))
            elif method == "Log.entryAdded" and p["entry"]["level"] == "error":
                errors.append(p["entry"]["text"])
        return errors

    def list_requests(self):
        return [e["params"]["request"]["url"] for e in self.events if e.get("method") == "Network.requestWillBeSent"]

    def show(self, selector):
        """Brings an element into view and gives its box: x, y, width, height."""
        box = self.run(f"""(() => {{ const e = document.querySelector({json.dumps(selector)}); if (!e) return null;
            e.scrollIntoView({{ block: "center" }}); const b = e.getBoundingClientRect();
            return {{ x: b.x, y: b.y, width: b.width, height: b.height }}; }})()""")
        if box is None:
            raise RuntimeError("no element " + selector)
        return box

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, selector):
        self.show(selector)
        box = self.show(selector)
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.mouse("mouseMoved", x, y)
        self.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.mouse("mouseReleased", x, y, button="left", clickCount=1)

    def drag(self, start, end, steps=6, button="left"):
        buttons = 1 if button == "left" else 2
        self.mouse("mouseMoved", *start)
        self.mouse("mousePressed", *start, button=button, buttons=buttons, clickCount=1)
        for k in range(1, steps + 1):
            self.mouse("mouseMoved", *(a + (b - a) * k / steps for a, b in zip(start, end)), button=button, buttons=buttons)
        self.mouse("mouseReleased", *end, button=button, clickCount=1)

    def screenshot(self, path, whole=False):
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"]
        with open(path, "wb") as f:
            f.write(base64.b64decode(data))


class BrowserTest(ProgramTest):
    """One browser for the tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
