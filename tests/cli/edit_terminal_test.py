"""bough edit as a person has it: completion, history, prompts, Ctrl-C, at a terminal of its own."""
import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time
import unittest

from edit_test import SYSTEM
from support import HANG, PROGRAM, ProgramTest

GET_TERMINAL_NUMBER = 0x80045430  # TIOCGPTN of Linux
HAS_LIBEDIT = "libedit" in subprocess.run(["ldd", PROGRAM], text=True, capture_output=True).stdout


class Terminal:
    """The program behind a pseudo-terminal; what it says comes without control sequences."""

    def __init__(self, folder, *arguments):
        self.process, self.master = pty.fork()
        if self.process == 0:
            os.chdir(folder)
            os.execve(PROGRAM, [PROGRAM, *arguments], {**os.environ, "TERM": "xterm", "NO_COLOR": "1", "COLUMNS": "120"})
        number = struct.unpack("I", fcntl.ioctl(self.master, GET_TERMINAL_NUMBER, b"\0" * 4))[0]
        self.slave = os.open(f"/dev/pts/{number}", os.O_RDWR | os.O_NOCTTY)
        self.said = ""

    def is_waiting(self):
        """The program has taken all that was typed and sleeps."""
        try:
            left = struct.unpack("i", fcntl.ioctl(self.slave, termios.FIONREAD, b"\0" * 4))[0]
            with open(f"/proc/{self.process}/stat", encoding="ascii", errors="replace") as f:
                return left == 0 and f.read().rsplit(")", 1)[1].split()[0] == "S"
        except OSError:
            return False

    def read_until(self, end):
        """Output until a line of it ends with `end` and the program waits for more; None: until it has ended."""
        said, until = "", time.monotonic() + HANG
        while time.monotonic() < until:
            waits = self.is_waiting()  # before it is looked whether there is more to read
            if not select.select([self.master], [], [], 0)[0]:
                if end is not None and waits and re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", said).endswith(end):
                    break
                if os.waitid(os.P_PID, self.process, os.WEXITED | os.WNOWAIT | os.WNOHANG) is not None:
                    break
                select.select([self.master], [], [], .02)
                continue
            try:
                said += os.read(self.master, 65536).decode()
            except OSError:
                break
        said = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", said).replace("\r", "")
        self.said += said
        return said

    def send(self, keys, end="p.toml> "):
        os.write(self.master, keys.encode())
        return self.read_until(end)

    def end(self):
        """Exit code."""
        os.close(self.slave)
        os.close(self.master)
        return os.waitstatus_to_exitcode(os.waitpid(self.process, 0)[1])


@unittest.skipUnless(HAS_LIBEDIT, "built without libedit")
class EditAtTerminal(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("p.toml", SYSTEM)
        self.terminal = Terminal(self.folder, "edit", "p.toml")
        self.assertIn("'help' lists the commands", self.terminal.read_until("p.toml> "))

    def read(self):
        with open(self.path("p.toml")) as f:
            return f.read()

    def save(self, text):
        """Saves, finds the text in the file, and leaves."""
        self.terminal.send("save\r")
        self.assertIn(text, self.read())
        self.finish()

    def finish(self):
        os.write(self.terminal.master, b"quit\r")
        self.terminal.read_until(None)
        self.assertEqual(self.terminal.end(), 0)

    def test_completion_ends_words(self):
        """A word that is complete gets a blank behind it, a key that waits for its value none."""
        t = self.terminal
        os.write(t.master, b"add se\tmid ty\tdef\tbo\tbo\tnode=0\r")
        t.read_until("p.toml> ")
        self.assertIn("[[sensor]]", t.send("show mid\r"))
        self.assertIn('type = "deflection"', t.said)
        self.assertIn('body = "bob"', t.said)
        self.save('[[sensor]]\nname = "mid"\ntype = "deflection"\nbody = "bob"\nnode = 0\n')

    def test_history(self):
        t = self.terminal
        t.send("set bob.mass = 5.0\r")
        t.send("list\r")
        t.send("\x1b[A\x1b[A\x7f\x7f\x7f7.5\r")  # twice up, another value
        self.assertIn("7.5", t.send("show bob.mass\r"))
        t.send("undo\r")
        self.assertIn("5.0", t.send("show bob.mass\r"))
        t.send("redo\r")
        self.save("mass = 7.5")

    def test_ctrl_c_leaves_the_line_not_the_session(self):
        t = self.terminal
        t.send("set bob.mass = 5.0\r")
        t.send("delete everything\x03")
        t.send("add sensor\r", "name = ")
        said = t.send("\x03")
        self.assertIn("the command was left", said)
        t.send("delete bob\r", "(y/n)? ")
        self.assertIn("the command was left", t.send("\x03"))
        said = t.send("quit\r", "(y/n)? ")
        self.assertIn("not saved", said)
        t.send("\x03")
        self.assertIn("5.0", t.send("show bob.mass\r"))
        self.save("mass = 5.0")

    def test_add_asks_for_what_the_type_needs(self):
        t = self.terminal
        said = t.send("add sensor\r", "name = ")
        self.assertIn("name: string, required", said)
        t.send("rate\r", "type = ")
        said = t.send("hinge_rate\r", "(empty: none) = ")
        self.assertIn("hinge: string", said)
        t.send("pin\r")
        said = t.send("add sensor place type=position\r", "(empty: none) = ")
        self.assertIn("body: string", said)
        t.send("\r")  # not now
        t.send("save\r")
        self.assertIn('[[sensor]]\nname = "rate"\ntype = "hinge_rate"\nhinge = "pin"\n', self.read())
        self.assertIn('[[sensor]]\nname = "place"\ntype = "position"\n', self.read())
        self.finish()

    def test_delete_asks_and_takes_all_that_refers(self):
        t = self.terminal
        said = t.send("delete bob\r", "(y/n)? ")
        self.assertIn("'bob' is named by hinge.1.child", said)
        self.assertIn("named by", t.send("n\r"))
        t.send("delete bob\r", "(y/n)? ")
        said = t.send("y\r")
        self.assertIn("deleted: hinge pin", said)
        self.assertIn("deleted: sensor angle", said)
        said = t.send("list\r")
        self.assertNotIn("bob", said)
        self.assertNotIn("pin", said)
        t.send("undo\r")
        said = t.send("list\r")
        for name in ("bob", "pin", "angle"):
            self.assertIn(name, said)
        self.finish()


if __name__ == "__main__":
    unittest.main()
