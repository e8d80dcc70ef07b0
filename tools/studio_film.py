#!/usr/bin/python3
"""studio_film.py BUILD/bin/bough FILM.webm: films the studio from a deck to a body, a run, poles and a page.

The film is the test cli.studio_browser (Flow.test_deck_to_page) with a picture after each event of mouse and keys; the
recorder of the browser (MediaRecorder) makes WebM of them, 30 seconds of at most 1,200 kbit/s, with a dot where the
pointer is.
Needs chromium; pictures of BOUGH_ARTEFACTS are made too where that is set."""
import base64
import json
import os
import sys
import unittest

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SECONDS, WIDTH, HEIGHT, MAX_FRAMES, BITS = 30, 1000, 654, 150, 1200000

# Draws the pictures one by one for equal times; the recorder takes what the canvas shows.
RECORD = """(async () => {
  const canvas = document.createElement("canvas"), frames = globalThis.film;
  [canvas.width, canvas.height] = [%d, %d];
  document.body.append(canvas);
  const pen = canvas.getContext("2d"), parts = [];
  const type = ["video/webm;codecs=vp9", "video/webm"].find((t) => MediaRecorder.isTypeSupported(t));
  const recorder = new MediaRecorder(canvas.captureStream(10), { mimeType: type, videoBitsPerSecond: %d });
  recorder.ondataavailable = (event) => parts.push(event.data);
  const end = new Promise((done) => (recorder.onstop = done));
  const pictures = [];
  for (const { data } of frames) {
    const picture = new Image();
    picture.src = "data:image/jpeg;base64," + data;
    await picture.decode();
    pictures.push(picture);
  }
  recorder.start();
  const from = performance.now(), each = (1000 * %d) / frames.length;
  for (let k = 0; k < frames.length; ++k) {
    pen.drawImage(pictures[k], 0, 0, canvas.width, canvas.height);
    const { x, y, wide } = frames[k], s = canvas.width / wide;
    pen.beginPath();
    pen.arc(s * x, s * y, 7, 0, 7);
    pen.fillStyle = "#d55e00b0";
    pen.fill();
    await new Promise((done) => setTimeout(done, Math.max(0, from + (k + 1) * each - performance.now())));
  }
  recorder.stop();
  await end;
  const bytes = new Uint8Array(await new Blob(parts).arrayBuffer());
  let text = "";
  for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
  return btoa(text);
})()"""


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
            data = self.call("Page.captureScreenshot", format="jpeg", quality=80)["data"]
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
    recorder = driver.Browser(WIDTH + 40, HEIGHT + 40)
    try:
        for k, frame in enumerate(chosen):
            recorder.run(f"(globalThis.film ??= [])[{k}] = {json.dumps(frame)}; 0")
        data = base64.b64decode(recorder.run(RECORD % (WIDTH, HEIGHT, BITS, SECONDS)))
    finally:
        recorder.close()
    with open(film, "wb") as f:
        f.write(data)
    print(f"{film}: {len(chosen)} pictures, {len(data) / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
