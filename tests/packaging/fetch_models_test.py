"""tools/fetch_models.py against a local server and a folder: hashes are checked, partial files never stay."""
import csv
import hashlib
import http.server
import os
import subprocess
import sys
import tempfile
import threading
import unittest

SOURCE = os.environ["BOUGH_SOURCE_DIR"]
SCRIPT = os.path.join(SOURCE, "tools", "fetch_models.py")
DECK = b"SOL 103\nCEND\nBEGIN BULK\nENDDATA\n"
COLUMNS = ["destination", "bytes", "sha256", "repository", "commit", "path", "licence"]


class Server(http.server.BaseHTTPRequestHandler):
    """Gives `files`; a path below /cut promises twice the bytes that come."""

    files = {}

    def do_GET(self):
        content = self.files.get(self.path)
        if content is None:
            self.send_error(404)
            return
        self.send_response(200)
        self.send_header("Content-Length", str(len(content) * (2 if "/cut/" in self.path else 1)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_):
        pass


class FetchModels(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Server)
        thread = threading.Thread(target=self.server.serve_forever, daemon=True)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(self.server.server_close)
        self.addCleanup(self.server.shutdown)
        self.base = f"http://127.0.0.1:{self.server.server_port}"

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write_table(self, *rows):
        with open(self.path("table.csv"), "w", newline="", encoding="utf-8") as f:
            out = csv.writer(f)
            out.writerow(COLUMNS)
            out.writerows(rows)

    def row(self, name, content=DECK, folder="models"):
        return [name, len(content), hashlib.sha256(content).hexdigest(), "owner/decks", "c0ffee", f"{folder}/{name}", "MIT"]

    def fetch(self, *words, base=None):
        env = {key: value for key, value in os.environ.items() if "proxy" not in key.lower()}
        return subprocess.run([sys.executable, "-B", SCRIPT, "--to", self.path("shared"), "--base", base or self.base,
                               "--table", self.path("table.csv"), *words], text=True, capture_output=True, env=env)

    def list_files(self):
        return sorted(os.path.relpath(os.path.join(folder, name), self.path("shared"))
                      for folder, _, names in os.walk(self.path("shared")) for name in names)

    def test_files_are_fetched_once(self):
        self.write_table(self.row("a/one.bdf"), self.row("b/two.bdf"))
        Server.files = {f"/owner/decks/c0ffee/models/{name}": DECK for name in ("a/one.bdf", "b/two.bdf")}
        found = self.fetch("a/")
        self.assertEqual((found.returncode, found.stderr, self.list_files()), (0, "", ["models/a/one.bdf"]))
        found = self.fetch()
        self.assertEqual((found.returncode, found.stdout.count("fetched")), (0, 1), found.stderr)
        self.assertEqual(self.list_files(), ["models/a/one.bdf", "models/b/two.bdf"])
        with open(self.path("shared/models/a/one.bdf"), "rb") as f:
            self.assertEqual(f.read(), DECK)
        Server.files = {}
        found = self.fetch()
        self.assertEqual((found.returncode, "2 of 2 files are in" in found.stdout), (0, True))

    def test_a_folder_is_a_base_too(self):
        self.write_table(self.row("one.bdf"))
        os.makedirs(self.path("mirror/owner/decks/c0ffee/models"))
        with open(self.path("mirror/owner/decks/c0ffee/models/one.bdf"), "wb") as f:
            f.write(DECK)
        found = self.fetch(base="file://" + self.path("mirror"))
        self.assertEqual((found.returncode, self.list_files()), (0, ["models/one.bdf"]), found.stderr)

    def test_another_content_is_named_and_not_kept(self):
        other = DECK.replace(b"103", b"105")
        for content, message in ((other, f"expected SHA-256 {hashlib.sha256(DECK).hexdigest()}, "
                                         f"found {hashlib.sha256(other).hexdigest()}"),
                                 (DECK[:-4], f"expected {len(DECK)} bytes, found {len(DECK) - 4}"),
                                 (DECK + b"$", f"expected {len(DECK)} bytes, found more")):
            self.write_table(self.row("bad.bdf"), self.row("good.bdf"))
            Server.files = {"/owner/decks/c0ffee/models/bad.bdf": content, "/owner/decks/c0ffee/models/good.bdf": DECK}
            found = self.fetch()
            self.assertEqual(found.returncode, 1)
            self.assertIn(f"bad.bdf: error: {self.base}/owner/decks/c0ffee/models/bad.bdf: {message}; nothing is written",
                          found.stderr)
            self.assertEqual(self.list_files(), ["models/good.bdf"])

    def test_a_download_that_is_cut_leaves_nothing(self):
        self.write_table(self.row("one.bdf", folder="cut"), self.row("two.bdf", DECK * 2, "cut"), self.row("three.bdf"))
        Server.files = {"/owner/decks/c0ffee/cut/two.bdf": DECK}
        found = self.fetch()
        self.assertEqual((found.returncode, self.list_files()), (1, []))
        self.assertIn("one.bdf: error:", found.stderr)
        self.assertIn("404", found.stderr)
        self.assertIn(f"two.bdf: error: {self.base}/owner/decks/c0ffee/cut/two.bdf: ", found.stderr)

    def test_a_file_of_the_user_is_not_replaced(self):
        self.write_table(self.row("one.bdf"))
        Server.files = {"/owner/decks/c0ffee/models/one.bdf": DECK}
        os.makedirs(self.path("shared/models"))
        with open(self.path("shared/models/one.bdf"), "wb") as f:
            f.write(b"mine")
        for words in ((), ("--check",)):
            found = self.fetch(*words)
            self.assertEqual(found.returncode, 1)
            self.assertIn("one.bdf has another content", found.stderr)
        with open(self.path("shared/models/one.bdf"), "rb") as f:
            self.assertEqual(f.read(), b"mine")

    def test_check_downloads_nothing(self):
        self.write_table(self.row("one.bdf"))
        Server.files = {"/owner/decks/c0ffee/models/one.bdf": DECK}
        found = self.fetch("--check")
        self.assertEqual((found.returncode, self.list_files()), (1, []))
        self.assertIn("one.bdf is absent; run tools/fetch_models.py", found.stderr)

    def test_the_table_of_the_project(self):
        found = subprocess.run([sys.executable, "-B", SCRIPT, "--list"], text=True, capture_output=True)
        self.assertEqual((found.returncode, found.stderr), (0, ""))
        with open(os.path.join(SOURCE, "tools/models/public.csv"), encoding="utf-8", newline="") as f:
            rows = list(csv.DictReader(f))
        self.assertGreater(len(rows), 20)
        self.assertEqual(len({row["destination"] for row in rows}), len(rows))
        for row in rows:
            self.assertRegex(row["sha256"], "^[0-9a-f]{64}$")
            self.assertRegex(row["commit"], "^[0-9a-f]{40}$")
            self.assertIn(row["licence"], ("BSD-3-Clause", "MIT"))
            self.assertIn(f"{row['destination']}: {row['repository']} {row['path']}", found.stdout)
            self.assertFalse(os.path.isabs(row["destination"]) or ".." in row["destination"])

    def test_files_of_this_machine_have_the_hashes_of_the_table(self):
        shared = os.environ.get("BOUGH_SHARED_DIR", "")
        if not os.path.exists(os.path.join(shared, "models")):
            self.skipTest("no folder of shared models")
        found = subprocess.run([sys.executable, "-B", SCRIPT, "--check", "--to", shared], text=True, capture_output=True)
        self.assertNotIn("has another content", found.stderr)


if __name__ == "__main__":
    unittest.main()
