"""bough studio without a browser: what it refuses, files that change outside, and the numbers of what it runs."""
import hashlib
import http.client
import os
import re
import resource
import shlex
import signal
import subprocess
import threading
import unittest

import h5py
import numpy as np

from studio_support import StudioTest
from support import BEAM, HANG, PROGRAM, SOURCE

SCRIPT = "<img src=x onerror=alert(1)><script>alert(2)</script>"


class Refusals(StudioTest):
    def setUp(self):
        super().setUp()
        self.outside = self.path("outside")
        self.inside = self.path("inside")
        os.makedirs(self.outside)
        os.makedirs(self.inside)
        self.write("outside/secret.toml", "name = 'secret'\n")
        self.write("inside/beam.bdf", BEAM)
        os.symlink(self.path("outside/secret.toml"), self.path("inside/link.toml"))
        os.symlink(self.outside, self.path("inside/folder"))
        self.start_studio(folder=self.inside)

    def test_token(self):
        port = self.origin.rsplit(":", 1)[1]
        for path in ["", "studio.js", "api/state", "0" * 32 + "/", self.address.split("/")[3][:-1] + "/"]:
            status, _, text = self.request(path, address=f"http://127.0.0.1:{port}/")
            self.assertEqual(status, 403, path)
            self.assertNotIn(b"import", text)
        self.assertEqual(self.request("api/state", b"{}", address=f"http://127.0.0.1:{port}/{'0' * 32}/")[0], 403)
        self.assertEqual(self.request("")[0], 200)

    def test_origin_and_host(self):
        data = b'{"what": "list"}'
        self.assertEqual(self.request("api/ask", data)[0], 200)
        port = self.origin.rsplit(":", 1)[1]
        for headers in [{"Origin": "http://evil.example"}, {"Origin": "null"}, {"Origin": "https://127.0.0.1:" + port},
                        {"Origin": "http://127.0.0.1:1"}, {"Host": "evil.example:" + port}, {"Host": "127.0.0.1"},
                        {"Sec-Fetch-Site": "cross-site"}, {"Sec-Fetch-Site": "same-site"},
                        {"Content-Type": "text/plain"}]:  # sent without asking first by a form of another page
            self.assertEqual(self.request("api/ask", data, headers)[0], 403, headers)
        self.assertEqual(self.request("", headers={"Origin": "http://evil.example"})[0], 403)
        self.assertEqual(self.request("", headers={"Host": "evil.example:" + port})[0], 403)

    def test_only_loopback(self):
        """Linux lists the addresses that are listened on: 0100007F is 127.0.0.1."""
        port = int(self.origin.rsplit(":", 1)[1])
        with open("/proc/net/tcp") as f:
            listening = [line.split()[1] for line in f if line.split()[3] == "0A"]
        self.assertEqual([a for a in listening if a.endswith(f":{port:04X}")], [f"0100007F:{port:04X}"])

    def test_policy(self):
        _, headers, _ = self.request("")
        policy = headers["Content-Security-Policy"]
        for part in ["default-src 'none'", "script-src 'self'", "frame-ancestors 'none'", "connect-src 'self'", "base-uri 'none'"]:
            self.assertIn(part, policy)
        self.assertNotIn("unsafe", policy)
        self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
        self.assertEqual(headers["Referrer-Policy"], "no-referrer")
        self.assertEqual(headers["Cross-Origin-Resource-Policy"], "same-origin")
        self.assertIsNone(headers["Access-Control-Allow-Origin"])

    def test_nothing_is_compressed(self):
        """Brotli at its best takes seconds for a mesh."""
        _, headers, _ = self.request("api/ask", b'{"what": "list"}', {"Accept-Encoding": "gzip, br"})
        self.assertIsNone(headers["Content-Encoding"])
        self.assertIsNone(self.request("viewer.js", headers={"Accept-Encoding": "gzip, br"})[1]["Content-Encoding"])

    def test_paths_outside(self):
        for name in ["../outside/secret.toml", self.path("outside/secret.toml"), "link.toml", "folder/secret.toml",
                     "folder/../../outside/secret.toml", "/etc/passwd"]:
            self.refuses("cli.outside-folder", "read", file=name)
            self.refuses("cli.outside-folder", "save", file=name if name.endswith(".toml") else name + ".toml", text="", hash="")
        for name in ["../outside/new.toml", "folder/new.toml"]:
            self.refuses("cli.outside-folder", "save", file=name, text="x = 1\n", hash="")
        self.assertEqual(os.listdir(self.outside), ["secret.toml"])
        self.refuses("studio.bad-request", "read", file="beam\0.bdf")
        for path in ["../../etc/passwd", "..%2f..%2fetc%2fpasswd", "api/../secret", "%2e%2e/studio.js"]:
            self.assertIn(self.request(path)[0], (403, 404), path)
        self.assertEqual([f["name"] for f in self.ask("list")["files"]], ["beam.bdf"])

    def test_files_that_files_name(self):
        """INCLUDE of a deck, deck of a body, file of a system, and the output that a body file names."""
        self.write("outside/part.bdf", BEAM.split("BEGIN BULK\n")[1])
        self.write("inside/with.bdf", "CEND\nBEGIN BULK\nINCLUDE '../outside/part.bdf'\nENDDATA\n")
        answer = self.call("ask", what="deck", file="with.bdf")
        self.assertIn("cli.outside-folder", str(answer))
        self.write("inside/body.toml", '[body]\nname = "b"\ndeck = "../outside/part.bdf"\n[body.modes]\nnumber = 1\n')
        code, output, _ = self.run_job("reduce", ["body.toml"], ["-o", "b.h5"])
        self.assertEqual((code, "[cli.outside-folder]" in output), (1, True), output)
        self.write("inside/out.toml", '[body]\nname = "b"\ndeck = "beam.bdf"\n[body.modes]\nnumber = 1\n[body.output]\n'
                   'file = "../outside/b.h5"\n')
        code, output, _ = self.run_job("reduce", ["out.toml"])
        self.assertEqual(code, 1, output)
        self.assertEqual(sorted(os.listdir(self.outside)), ["part.bdf", "secret.toml"])

    def test_commands(self):
        for body in [{"verb": "init", "files": ["spinup"], "options": []},
                     {"verb": "studio", "files": [], "options": []},
                     {"verb": "run", "files": ["../outside/secret.toml"], "options": []},
                     {"verb": "run", "files": ["beam.bdf"], "options": [["-o", "../outside/x.h5"]]},
                     {"verb": "run", "files": ["beam.bdf"], "options": [["-o", "folder/x.h5"]]},
                     {"verb": "reduce", "files": ["beam.bdf"], "options": [["--force-outside"]]},
                     {"verb": "modes", "files": ["beam.bdf"], "options": [["-n", "3 --vtu x"]]},
                     {"verb": "modes", "files": ["beam.bdf"], "options": [["--ese", "x"]]},
                     {"verb": "modes", "files": ["beam.bdf"]},
                     {"verb": 3, "files": [], "options": []}]:
            answer = self.call("start", **body)
            self.assertNotIn("result", answer, body)
        # A name that begins as an option does is a file.
        answer = self.call("command", verb="check", files=["--json"], options=[])
        self.assertEqual(answer["result"]["line"], "bough check ./--json")
        answer = self.call("command", verb="check", files=["my wing's.bdf"], options=[])
        self.assertEqual(answer["result"]["line"], "bough check 'my wing'\\''s.bdf'")

    def test_bad_requests(self):
        for data in [b"", b"[]", b"{", b"{}", b'{"what": 3}', b'{"what": "list' + b"\xff" + b'"}', b"null"]:
            status, _, text = self.request("api/ask", data)
            self.assertEqual(status, 200)
            self.assertIn(b"studio.bad-request", text, data)
        self.assertEqual(self.request("api/start", b"{")[0], 200)
        self.assertIn(b"studio.bad-request", self.request("api/nothing", b"{}")[2])
        self.assertIn(b"studio.bad-request", self.request("api/job", b'{"job": 99}')[2])
        self.ask("list")

    def test_large_upload(self):
        """100 MB are refused, and the next request is answered."""
        try:
            status = self.request("api/ask", b" " * 100_000_000)[0]
        except OSError:  # the program closed the connection first
            status = 413
        self.assertEqual(status, 413)
        self.ask("list")

    def test_upload_in_chunks(self):
        """A body without a length is refused before it is read: 100 MB leave no trace in memory."""
        def read_peak():
            with open(f"/proc/{self.studio.pid}/status", encoding="utf-8") as f:
                return int(re.search(r"VmHWM:\s+(\d+)", f.read())[1]) / 1000
        before = read_peak()
        connection = http.client.HTTPConnection(self.origin.split("/")[2], timeout=HANG)
        self.addCleanup(connection.close)
        try:
            connection.request("POST", self.address.removeprefix(self.origin) + "api/ask", encode_chunked=True,
                               body=(b" " * 1_000_000 for _ in range(100)),
                               headers={"Origin": self.origin, "Content-Type": "application/json", "Transfer-Encoding": "chunked"})
            self.assertEqual(connection.getresponse().status, 413)
        except OSError:  # the program closed the connection first
            pass
        self.assertLess(read_peak() - before, 60)  # MB
        self.ask("list")

    def test_names_with_script(self):
        self.write("inside/" + SCRIPT.replace("/", "_") + ".bdf", BEAM)
        names = [f["name"] for f in self.ask("list")["files"]]
        self.assertIn(SCRIPT.replace("/", "_") + ".bdf", names)
        self.write("inside/modes.bdf", BEAM.replace("SOL 103", f"TITLE = {SCRIPT}\nSOL 103"))
        code, output, _ = self.run_job("modes", ["modes.bdf"], ["-o", "modes.h5"])
        self.assertEqual(code, 0, output)
        with h5py.File(self.path("inside/modes.h5"), "a") as f:
            f.attrs["name"] = SCRIPT
        chapter = self.ask("chapter", file="modes.h5")["chapter"]
        for panel in chapter["panels"]:
            self.assertNotIn("<script", panel["html"])
            self.assertNotIn("<img", panel["html"])

    def test_broken_files(self):
        """A file that is no HDF5 file is in the list, and the studio goes on."""
        self.write("inside/broken.h5", "no HDF5")
        self.assertIn("unreadable", [f["kind"] for f in self.ask("list")["files"]])
        self.refuses("hdf5.not-hdf5", "chapter", file="broken.h5")
        self.refuses("cli.no-file", "chapter", file="missing.h5")
        self.ask("list")


class Files(StudioTest):
    def setUp(self):
        super().setUp()
        self.copy_example("ex01-spinup")
        self.start_studio()

    def test_second_tab(self):
        """Two tabs read a file; the second to save is refused, and nothing is lost."""
        first, second = (self.ask("read", file="spinup.toml") for _ in range(2))
        self.assertEqual(first["hash"], hashlib.sha256(self.read("spinup.toml").encode()).hexdigest())
        mine = first["text"] + "# mine\n"
        done = self.ask("save", file="spinup.toml", text=mine, hash=first["hash"])
        self.refuses("studio.changed-file", "save", file="spinup.toml", text=second["text"] + "# theirs\n", hash=second["hash"])
        self.assertEqual(self.read("spinup.toml"), mine)
        self.ask("save", file="spinup.toml", text=mine + "# more\n", hash=done["hash"])

    def test_changes_outside(self):
        read = self.ask("read", file="spinup.toml")
        self.write("spinup.toml", read["text"] + "# outside\n")
        self.refuses("studio.changed-file", "save", file="spinup.toml", text=read["text"], hash=read["hash"])
        os.remove(self.path("spinup.toml"))
        self.refuses("studio.changed-file", "save", file="spinup.toml", text=read["text"], hash=read["hash"])
        self.ask("save", file="spinup.toml", text=read["text"], hash="")
        self.refuses("cli.output-exists", "save", file="spinup.toml", text="", hash="")
        self.refuses("cli.wrong-file", "save", file="boom.bdf", text="", hash="")

    def test_edit_as_edit_does(self):
        """Commands of the page change the text as those of `bough edit` do, byte for byte."""
        commands = ["set simulation.duration=0.5", "add sensor probe type=hinge_angle hinge=spin"]
        text = self.ask("edit", file="spinup.toml", text=self.read("spinup.toml"), kind="system", commands=commands)["text"]
        script = self.path("script")
        with open(script, "w") as f:
            f.write("\n".join(commands) + "\nsave\n")
        with open(script) as f:
            subprocess.run([PROGRAM, "edit", "spinup.toml", "-o", "edited.toml"], cwd=self.folder, stdin=f, check=True,
                           capture_output=True, timeout=HANG)
        self.assertEqual(text, self.read("edited.toml"))
        self.refuses("cli.edit-command", "edit", file="spinup.toml", text=text, kind="system", commands=["save /tmp/x"])

    def test_check_while_typing(self):
        text = self.read("spinup.toml").replace('type = "revolute"', 'type = "revolut"')
        answer = self.ask("check", file="spinup.toml", text=text, kind="system")
        self.assertTrue(any(m["severity"] == "error" and m["line"] > 0 for m in answer["messages"]), answer["messages"])

    def test_numbers_of_the_command_line(self):
        """Reduced and run from the page: the arrays of the command line, bit for bit; the page of both is saved."""
        self.assertEqual(self.run_job("reduce", ["boom.toml"], ["-o", "boom.h5"])[0], 0)
        preview = self.ask("preview", file="spinup.toml", text=self.read("spinup.toml"))
        self.assertIn('"bodies"', preview["chapter"]["data"])
        code, output, line = self.run_job("run", ["spinup.toml"], ["-o", "studio.h5"])
        self.assertEqual(code, 0, output)
        self.assertEqual(line, "bough run spinup.toml -o studio.h5")
        self.bough("run", "spinup.toml", "-o", "shell.h5")
        with h5py.File(self.path("studio.h5")) as a, h5py.File(self.path("shell.h5")) as b:
            np.testing.assert_array_equal(a["/sensors/tip_deflection"][:], b["/sensors/tip_deflection"][:])
        self.assertEqual(self.run_job("report", ["studio.h5", "boom.h5"], ["-o", "page.html"])[0], 0)
        self.bough("report", "studio.h5", "boom.h5", "-o", "shell.html", "--title", "studio")
        self.assertEqual(self.read("page.html").replace("page", ""), self.read("shell.html").replace("page", ""))

    def test_difference_of_a_new_file(self):
        """Ranges of lines as diff -u has them."""
        for before, after in (("", "a\nb\n"), ("a\nb\n", ""), ("a\nb\nc\n", "a\nx\nc\n")):
            self.write("before.txt", before)
            self.write("after.txt", after)
            done = subprocess.run(["diff", "-u", "before.txt", "after.txt"], cwd=self.folder, text=True, capture_output=True)
            found = self.ask("diff", file="x.toml", before=before, after=after)["diff"]
            self.assertEqual(found.splitlines()[2:], done.stdout.splitlines()[2:])

    def test_a_deck_with_a_missing_grid(self):
        """An element that is left out of the picture is named, a spring to a scalar point is none."""
        self.write("bad.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nSPOINT,50\n"
                   "CQUAD4,7,1,1,2,3,9\nCTRIA3,8,1,1,2,3\nCELAS2,5,10.,1,1,50,0\nPSHELL,1,1,.01,1\nMAT1,1,7.+10,,.3,2700.\nENDDATA\n")
        messages = self.ask("deck", file="bad.bdf")["messages"]
        found = [(m["id"], m["line"], m["what"]) for m in messages if m["severity"] == "error"]
        self.assertEqual(found, [("fe.missing-grid", 8, "CQUAD4 7 is not drawn: it refers to grid 9, which the deck does not define")])

    def test_deck(self):
        deck = self.ask("deck", file="boom.bdf")
        self.assertEqual(sum(v for k, v in deck["cards"].items() if k == "GRID"), self.read("boom.bdf").count("\nGRID"))
        self.assertEqual(deck["num_parts"], 1)
        files = self.ask("start", file="boom.bdf")["files"]
        self.write("boom2.bdf", self.read("boom.bdf"))
        self.bough("init", "boom2.bdf")
        self.assertEqual(files[0]["text"].replace("boom", "boom2"), self.read("boom2.toml"))

    def test_stop_and_end(self):
        """A run that is stopped leaves a file that goes on; Ctrl-C ends the studio and its jobs, exit code 0."""
        self.assertEqual(self.run_job("reduce", ["boom.toml"], ["-o", "boom.h5"])[0], 0)
        text = self.read("spinup.toml").replace("duration = ", "duration = 1000")
        self.write("long.toml", text)
        job = self.call("start", verb="run", files=["long.toml"], options=[["-o", "long.h5"]])["result"]["job"]
        while not os.path.exists(self.path("long.h5")):
            self.assertTrue(self.call("job", job=job)["result"]["running"])
        self.call("stop", job=job)
        while self.call("job", job=job)["result"]["running"]:
            pass
        self.assertEqual(self.call("job", job=job)["result"]["code"], 3)
        self.assertIn("bough-results", [f["kind"] for f in self.ask("list")["files"]])
        self.call("start", verb="run", files=["long.toml"], options=[["-o", "long2.h5"]])
        self.studio.send_signal(signal.SIGINT)
        self.studio.communicate(timeout=HANG)
        self.assertEqual(self.studio.returncode, 0)

    def test_end_by_page(self):
        self.call("end")
        self.studio.communicate(timeout=HANG)
        self.assertEqual(self.studio.returncode, 0)


class Limits(StudioTest):
    """Limits of the system and a killed process give a message; the studio goes on."""

    def setUp(self):
        super().setUp()
        self.write("beam.bdf", BEAM)
        self.start_studio()

    def test_text_too_large(self):
        self.write("large.toml", "# " + "x" * (5 << 20) + "\n")
        self.refuses("studio.too-large", "read", file="large.toml")

    def test_killed_answer(self):
        grids = "".join(f"GRID,{i},,{i}.,0.,0.\n" for i in range(1, 400000))
        self.write("many.bdf", "CEND\nBEGIN BULK\n" + grids + "ENDDATA\n")
        answers = []
        thread = threading.Thread(target=lambda: answers.append(self.call("ask", what="deck", file="many.bdf")))
        thread.start()
        children = []
        while not children and thread.is_alive():
            for task in os.listdir(f"/proc/{self.studio.pid}/task"):
                with open(f"/proc/{self.studio.pid}/task/{task}/children") as f:
                    children += f.read().split()
        os.kill(int(children[0]), signal.SIGKILL)
        thread.join(HANG)
        self.assertEqual(answers[0]["messages"][0]["id"], "studio.no-answer")
        self.assertEqual(len(self.ask("list")["files"]), 2)

    def test_no_descriptors(self):
        before = resource.prlimit(self.studio.pid, resource.RLIMIT_NOFILE)
        count = len(os.listdir(f"/proc/{self.studio.pid}/fd"))
        resource.prlimit(self.studio.pid, resource.RLIMIT_NOFILE, (count + 1, before[1]))
        answer = self.call("ask", what="list")
        resource.prlimit(self.studio.pid, resource.RLIMIT_NOFILE, before)
        self.assertEqual(answer["messages"][0]["id"], "studio.no-process")
        self.ask("list")

    def test_ranks(self):
        result = self.bough("studio", "--no-open", code=1, env={"OMPI_COMM_WORLD_SIZE": "2"})
        self.assertIn("studio.ranks", result.stderr)

    def test_full_disk(self):
        """A text that cannot be written whole leaves the file as it was."""
        self.write("body.toml", '[body]\nname = "b"\ndeck = "beam.bdf"\n[body.modes]\nnumber = 1\n')
        read = self.ask("read", file="body.toml")
        before = resource.prlimit(self.studio.pid, resource.RLIMIT_FSIZE)
        resource.prlimit(self.studio.pid, resource.RLIMIT_FSIZE, (1000, before[1]))
        self.refuses("cli.write", "save", file="body.toml", text=read["text"] + "# more\n" * 1000, hash=read["hash"])
        resource.prlimit(self.studio.pid, resource.RLIMIT_FSIZE, before)
        self.assertEqual(self.read("body.toml"), read["text"])
        self.assertEqual(sorted(os.listdir(self.folder)), ["beam.bdf", "body.toml"])


class Start(StudioTest):
    def test_commands_of_the_page(self):
        """Runs the commands of docs/studio.md in an empty folder."""
        with open(os.path.join(SOURCE, "docs/studio.md"), encoding="utf-8") as f:
            lines = re.findall(r"(?m)^    (.*)$", f.read())
        self.assertEqual(lines[0], lines[-1])
        self.assertEqual(lines[2], "cd plate")
        self.bough(*shlex.split(lines[1])[1:])
        words = shlex.split(lines[3])
        self.assertEqual(words[:2], ["bough", "studio"])
        self.start_studio(*words[2:], folder=self.path("plate"))
        self.assertGreater(len(self.ask("deck", file=words[2])["cards"]), 3)

    def test_files(self):
        self.write("beam.bdf", BEAM)
        self.start_studio("beam.bdf")
        self.assertEqual(self.call("state")["result"]["files"], ["beam.bdf"])
        port = self.origin.rsplit(":", 1)[1]
        self.fails(1, "studio", "--no-open", "--port", port, says=["not free"], error="studio.no-port")
        self.fails(1, "studio", "--no-open", "missing.bdf", error="cli.no-file")
        self.fails(1, "studio", "--no-open", "/etc/passwd", error="cli.outside-folder")


if __name__ == "__main__":
    unittest.main()
