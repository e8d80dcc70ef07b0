"""Each file of a deck is opened once in a command: kind, case control, cards and hash are of the same bytes.

The kernel counts (inotify), so no reader escapes.
"""
import ctypes
import os
import struct
import unittest

from support import ProgramTest

IN_OPEN = 0x20
IN_ALL = IN_OPEN | 0x1 | 0x18  # and reading and closing: the kernel merges equal events in a row

MAIN = """SOL 103
CEND
METHOD = 1
SPC = 1
LOAD = 5
DISPLACEMENT = ALL
BEGIN BULK
INCLUDE 'sheet.bdf'
EIGRL,1,,,3
SPC1,1,123456,1
GRID,1
GRID,2,,1.
GRID,3,,2.
CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
FORCE,5,3,,1.,0.,1.,0.
ENDDATA
"""
INCLUDED = "PBAR,1,1,.01,1.-5,1.-5,1.-5\nMAT1,1,7.+10,,.3,2700.\n"


class Opens:
    """Number of times that files were opened since the beginning."""

    def __init__(self, paths):
        libc = ctypes.CDLL(None, use_errno=True)
        self.descriptor = libc.inotify_init1(os.O_NONBLOCK)
        if self.descriptor < 0:
            raise unittest.SkipTest("the system has no inotify")
        self.paths = {libc.inotify_add_watch(self.descriptor, path.encode(), IN_ALL): path for path in paths}

    def count(self):
        counts = dict.fromkeys(map(os.path.basename, self.paths.values()), 0)
        try:
            events = os.read(self.descriptor, 1 << 20)
        except BlockingIOError:
            return counts
        while events:
            watch, mask, _, size = struct.unpack_from("iIII", events)
            if mask & IN_OPEN:
                counts[os.path.basename(self.paths[watch])] += 1
            events = events[struct.calcsize("iIII") + size:]
        return counts

    def close(self):
        os.close(self.descriptor)


class OneReading(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("d.bdf", MAIN)
        self.write("sheet.bdf", INCLUDED)

    def count_opens(self, *words, code=0):
        opens = Opens([self.path("d.bdf"), self.path("sheet.bdf")])
        self.addCleanup(opens.close)
        self.bough(*words, code=code)
        return opens.count()

    def test_commands_that_read_a_deck(self):
        once = {"d.bdf": 1, "sheet.bdf": 1}
        for words in (["modes", "d.bdf", "-o", "m.h5"], ["modes", "d.bdf", "--f06", "m.f06"], ["check", "d.bdf"],
                      ["static", "d.bdf", "-o", "s.h5"], ["matrices", "d.bdf", "-o", "k.h5"],
                      ["export", "d.bdf", "--to", "bdf", "-o", "e.bdf"], ["init", "d.bdf", "-o", "made"],
                      ["split", "d.bdf", "--parts", "2", "-o", "parts"], ["convert", "d.bdf", "--units", "m-kg-s:mm-N-tonne", "-o", "c.bdf"]):
            with self.subTest(words[0]):
                self.assertEqual(self.count_opens(*words), once)

    def test_responses(self):
        self.write("d.bdf", MAIN.replace("SOL 103", "SOL 111").replace("SPC = 1", "SPC = 1\nDLOAD = 6\nFREQ = 7").replace(
            "ENDDATA", "RLOAD1,6,5,,,1.\nDAREA,5,3,2,1.\nFREQ1,7,1.,1.,5\nENDDATA"))
        self.assertEqual(self.count_opens("frequency", "d.bdf", "-o", "f.h5"), {"d.bdf": 1, "sheet.bdf": 1})

    def test_body_of_a_deck(self):
        self.write("b.toml", '[body]\nname = "b"\ndeck = "d.bdf"\nframe = "fixed"\ninterface = [1]\n\n[body.modes]\nnumber = 2\n')
        self.assertEqual(self.count_opens("reduce", "b.toml"), {"d.bdf": 1, "sheet.bdf": 1})

    def test_message_with_its_line(self):
        """A message shows the line of the deck: from the bytes that were read."""
        self.write("d.bdf", MAIN.replace("GRID,3,,2.", "GRID,3,,two"))
        self.assertEqual(self.count_opens("modes", "d.bdf", code=1), {"d.bdf": 1, "sheet.bdf": 1})


if __name__ == "__main__":
    unittest.main()
