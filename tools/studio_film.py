#!/usr/bin/python3
"""studio_film.py BUILD/bin/bough FILM.webm: films the studio from a deck to a body, a run, poles and a page.

The film is the test cli.studio_browser (Flow.test_deck_to_page) with a picture after each event of mouse and keys, 30
seconds of WebM, with a dot where the pointer is.
Needs chromium, ffmpeg and Pillow; pictures of BOUGH_ARTEFACTS are made too where that is set."""
import base64
import io
import os
import subprocess
import sys
import unittest

from PIL import Image, ImageDraw

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SECONDS, WIDTH, HEIGHT, MAX_FRAMES, QUALITY = 30, 1000, 654, 150, 34


def draw(frame):
    """The picture in the size of the film, with a dot where the pointer is."""
    picture = Image.open(io.BytesIO(base64.b64decode(frame["data"]))).convert("RGB")
    scale = WIDTH / frame["wide"]
    dot = Image.new("L", picture.size)
    x, y, r = frame["x"], frame["y"], 7 / scale
    ImageDraw.Draw(dot).ellipse((x - r, y - r, x + r, y + r), fill=176)
    picture.paste((213, 94, 0), mask=dot)
    return picture.resize((WIDTH, HEIGHT), Image.LANCZOS)


def write_film(frames, path):
    """VP9, coded as contents of a screen: texts stay sharp where the recorder of a browser blurs them."""
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{WIDTH}x{HEIGHT}",
               "-r", f"{len(frames)}/{SECONDS}", "-i", "-", "-c:v", "libvpx-vp9", "-tune-content", "screen",
               "-crf", str(QUALITY), "-b:v", "0", "-pix_fmt", "yuv420p", path]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as coder:
        for frame in frames:
            coder.stdin.write(draw(frame).tobytes())
        coder.stdin.close()
        if coder.wait() != 0:
            sys.exit("ffmpeg did not write the film")


def main():
    program, film = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    os.environ.update(BOUGH_PROGRAM=program, BOUGH_SOURCE_DIR=SOURCE)
    sys.path[:0] = [os.path.join(SOURCE, "tests", folder) for folder in ("cli", "support")]
    import browser as driver
    from studio_browser_test import Flow

    frames = []

    class Filmed(driver.Browser):
        place = (650, 400)

        def shoot(self):
            data = self.call("Page.captureScreenshot", format="png")["data"]
            if not frames or frames[-1]["data"] != data:
                frames.append({"data": data, "x": self.place[0], "y": self.place[1], "wide": 1300})

        def mouse(self, kind, x, y, **more):
            super().mouse(kind, x, y, **more)
            self.place = (x, y)
            if kind != "mousePressed":
                self.shoot()

        def type(self, text):
            # A list forgets letters that come late.
            step = len(text) if self.run("document.activeElement?.tagName === 'SELECT'") else 6
            for at in range(0, len(text), step or 1):
                super().type(text[at:at + step])
                self.shoot()

        def wait_for(self, expression):
            found = super().wait_for(expression)
            if self.run("Boolean(document.body?.childElementCount)"):
                self.shoot()
            return found

    driver.Browser = Filmed
    done = unittest.TextTestRunner().run(unittest.TestSuite([Flow("test_deck_to_page")]))
    if not done.wasSuccessful() or not frames:
        sys.exit("the flow of the studio did not end as it should: no film")
    step = -(-len(frames) // MAX_FRAMES)
    chosen = frames[::step] + frames[-1:] * 3
    write_film(chosen, film)
    print(f"{film}: {len(chosen)} pictures, {os.path.getsize(film) / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
