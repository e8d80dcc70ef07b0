"""At a terminal: colours and progress; with NO_COLOR or in a pipe neither."""
import os
import pty
import subprocess
import unittest

from support import PROGRAM, ProgramTest


class Terminal(ProgramTest):
    def at_terminal(self, *arguments, **env):
        """Output of the program at a terminal."""
        kept = {k: v for k, v in os.environ.items() if k != "NO_COLOR"}
        to_read, terminal = pty.openpty()
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdin=terminal, stdout=terminal,
                                   stderr=terminal, env={**kept, "TERM": "xterm", **env})
        os.close(terminal)
        said = b""
        while True:
            try:
                more = os.read(to_read, 65536)
            except OSError:  # Linux ends a terminal that nobody holds so
                break
            if not more:
                break
            said += more
        os.close(to_read)
        return process.wait(), said.decode()

    def test_colours(self):
        self.write("bad.bdf", "SOL 103\nCEND\nBEGIN BULK\nCBAR,1,1,1,2,0.,1.,0.\nENDDATA\n")
        code, said = self.at_terminal("check", "bad.bdf")
        self.assertEqual(code, 1)
        self.assertIn("\x1b[", said)
        code, said = self.at_terminal("check", "bad.bdf", NO_COLOR="1")
        self.assertEqual(code, 1)
        self.assertIn("error:", said)
        self.assertNotIn("\x1b[", said)
        self.assertNotIn("\x1b", self.bough("check", "bad.bdf", code=1).stderr)

    def test_the_line_that_is_meant(self):
        self.write("bad.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\x1b[31m\nCBAR,1,1,1,2,0.,1.,0.\nENDDATA\n")
        said = self.at_terminal("check", "bad.bdf", NO_COLOR="1")[1].replace("\r\n", "\n")
        self.assertRegex(said, r"bad.bdf:5: error: .*\n    CBAR,1,1,1,2,0.,1.,0.\n")
        self.assertNotIn("\x1b", said.replace("\\x1b", ""))  # a file does not steer the terminal
        self.write("bad.toml", "[simulation]\nduration = 1.0\n  durration = 2.0 # " + "é" * 100 + "\n")
        said = self.at_terminal("check", "bad.toml", NO_COLOR="1")[1].replace("\r\n", "\n")
        self.assertRegex(said, r"bad.toml:3: error: .*durration.*\n      durration = 2.0 # é+ \.\.\.\n")
        self.assertNotIn("\n      durration", self.bough("check", "bad.toml", code=1).stderr)

    def test_the_mark_under_a_field(self):
        """Under the field of a card, in columns and between commas, on its own line; in no message and no pipe."""
        self.write("bad.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,zero,0.\nGRID           2              1.   x.y0      0.\n"
                   "CBAR           1       1       1       2      0.      1.     bad\n"
                   "PBEAM,1,1,1.,1.,1.,,1.,,+\n+,,,here,\nENDDATA\n")
        said = self.at_terminal("check", "bad.bdf", NO_COLOR="1")[1].replace("\r\n", "\n").splitlines()
        marked = []
        for line, below in zip(said, said[1:]):
            if below.strip() == "^" and line.startswith("    "):
                marked.append(line[below.index("^"):].split(",")[0].split()[0])
        for word in ("zero", "x.y0", "bad"):
            self.assertIn(word, marked)
        self.assertRegex("\n".join(said), r"bad.bdf:4: error: GRID")
        self.assertNotIn("^", self.bough("check", "bad.bdf", code=1).stderr)
        # With tabs the columns are others.
        self.write("tabs.bdf", "SOL 103\nCEND\nBEGIN BULK\nGRID\t1\t\t0.\tzero\t0.\nENDDATA\n")
        said = self.at_terminal("check", "tabs.bdf", NO_COLOR="1")[1]
        self.assertIn("zero", said)
        self.assertNotIn("^", said)

    def test_progress(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml")
        self.write("long.toml", self.read("spinup.toml").replace("duration = 20.0", "duration = 100.0"))
        code, said = self.at_terminal("run", "long.toml", "-o", "long.h5")
        self.assertEqual(code, 0, said)
        self.assertRegex(said, r"run: +\d+\.\d %  t \S+  step \S+  order \d+  steps \d+  rejected \d+  "
                               r"energy error \S+  \d+ s left")
        self.assertNotIn("left", self.bough("run", "long.toml", "-o", "long.h5").stderr)


if __name__ == "__main__":
    unittest.main()
