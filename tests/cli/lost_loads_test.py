"""Loads on what has no stiffness: named, and an error where a body is asked for them."""
import unittest

from support import ProgramTest

HEAD = "SOL 101\nCEND\nSPC = 1\nLOAD = 3\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\n"


def write_solid():
    """Two CHEXA in a row along x, held at x = 0; grid 20 at the far end."""
    lines = ["PSOLID,1,1", "SPC1,1,123,1,2,3,4"]
    for i in range(3):
        for k, (y, z) in enumerate([(0., 0.), (1., 0.), (1., 1.), (0., 1.)]):
            number = 20 if (i, k) == (2, 0) else 4 * i + k + 1
            lines.append(f"GRID,{number},,{float(i)},{y},{z}")
    for i in range(2):
        a = [4 * i + k + 1 for k in range(4)]
        b = [20 if (i, k) == (1, 0) else 4 * i + k + 5 for k in range(4)]
        lines.append(f"CHEXA,{i + 1},1,{','.join(map(str, a + b[:2]))}\n,{b[2]},{b[3]}")
    return "\n".join(lines) + "\n"


class LostLoads(ProgramTest):
    def test_moment_on_a_grid_of_solids(self):
        self.write("s.bdf", HEAD + write_solid() + "MOMENT,3,20,0,5.,0.,0.,1.\nFORCE,3,20,0,1.,0.,0.,1.\nENDDATA\n")
        result = self.bough("static", "s.bdf")
        self.assertIn("[fe.load-autospc]", result.stderr)
        self.assertIn("component 6 of grid 20 (5)", result.stderr)
        body = '[body]\nname = "s"\ndeck = "s.bdf"\n[body.modes]\nnumber = 3\n'
        self.write("a.toml", body + '[[body.load]]\nname = "q"\nload_set = 3\n')
        self.fails(1, "reduce", "a.toml", "-o", "a.h5", says=["load 'q'", "RBE2"], error="reduce.load-on-nothing")
        self.write("b.toml", body + '[[body.load]]\nname = "t"\nnode = 20\ndirection = ["rz"]\n')
        self.fails(1, "reduce", "b.toml", "-o", "b.h5", says=["load 't'"], error="reduce.load-on-nothing")
        self.write("c.toml", body + '[[body.load]]\nname = "t"\nnode = 20\ndirection = ["z"]\n')
        self.bough("reduce", "c.toml", "-o", "c.h5")

    def test_a_bar_without_one_of_its_stiffnesses(self):
        bar = "".join(f"GRID,{i + 1},,{float(i)},0.,0.\n" for i in range(4)) + "".join(
            f"CBAR,{i},1,{i},{i + 1},0.,1.,0.\n" for i in range(1, 4))
        self.write("b.bdf", HEAD + bar + "PBAR,1,1,1.-4,2.-9,1.-9\nSPC1,1,123456,1\nFORCE,3,4,0,1.,0.,0.,1.\nENDDATA\n")
        self.assertNotIn("fe.load-autospc", self.bough("static", "b.bdf").stderr)
        self.write("b.toml", '[body]\nname = "b"\ndeck = "b.bdf"\ninterface = [4]\n[body.modes]\nnumber = 3\n')
        result = self.bough("reduce", "b.toml", "-o", "b.h5")
        self.assertIn("[reduce.partial-rotation]", result.stderr)
        self.assertIn("interface grid 4 has no stiffness in component(s) 4", result.stderr)

    def test_twist_without_mass_in_a_skew_beam(self):
        bar = "".join(f"GRID,{i + 1},,{i / 3!r},{2 * i / 3!r},{2 * i / 3!r}\n" for i in range(7)) + "".join(
            f"CBAR,{i},1,{i},{i + 1},2.,1.,-2.\n" for i in range(1, 7))
        self.write("b.bdf", HEAD.replace("LOAD = 3\n", "") + bar
                   + "PBAR,1,1,1.-4,2.-9,1.-9,2.-9\nSPC1,1,123456,1,7\nENDDATA\n")
        self.write("b.toml", '[body]\nname = "b"\ndeck = "b.bdf"\ninterface = [4]\n[body.modes]\nnumber = 4\n'
                   'basis = "craig-bampton"\n')
        result = self.bough("reduce", "b.toml", "-o", "b.h5")
        self.assertIn("[modal.massless-interface]", result.stderr)
        self.assertIn("turning of grid 4 about (0.333 0.667 0.667)", result.stderr)

    ROD = ("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCROD,1,1,1,2\nPROD,1,1,1.\nMAT1,1,1.,,.3,1.,1.-5\nSPC1,1,123456,1\n"
           "SPC1,1,23456,2\nFORCE,5,2,,1.,1.,0.,0.\nTEMPD,6,1.\nPLOADX1,7,1,1.,1.,1,2\nLOAD,8,1.,1.,5,1.,7\n"
           "TEMPP3,6,1,0.,1.,1.,2.\nDEFORM,4,1,.1\n")

    def test_loads_that_are_not_read(self):
        """An error where the case selects them, a warning elsewhere; --ignore computes without them."""
        for case, card in [("TEMP(LOAD) = 6", "TEMPP3"), ("LOAD = 8", "PLOADX1"), ("LOAD = 5\nDEFORM = 4", "DEFORM"),
                           ("DEFORM = 4", "DEFORM")]:
            self.write("r.bdf", f"SOL 101\nCEND\nSPC = 1\n{case}\nBEGIN BULK\n{self.ROD}ENDDATA\n")
            self.fails(1, "static", "r.bdf", says=[card], error="fe.unread-load")
            self.bough("modes", "r.bdf", "-n", "1")
            if case != "DEFORM = 4":
                self.bough("static", "r.bdf", "--ignore", card)
        self.write("r.bdf", f"SOL 101\nCEND\nSPC = 1\nLOAD = 5\nBEGIN BULK\n{self.ROD}ENDDATA\n")
        self.assertNotIn("unread-load", self.bough("static", "r.bdf").stderr)

    def test_the_end_misspelt_and_requests(self):
        head = f"SOL 101\nCEND\nSPC = 1\nLOAD = 5\nESE = ALL\nGPFORCE = ALL\nBEGIN BULK\n{self.ROD}"
        for end in ("ENDATA", "ENDDAT", "END DATA"):
            self.write("r.bdf", head + end + "\n")
            self.fails(1, "static", "r.bdf", says=["ENDDATA", "r.bdf:21"])
        self.write("r.bdf", head + "ENDDATA\n")
        text = self.bough("static", "r.bdf").stderr
        self.assertIn("the deck requests ESE", text)
        self.assertIn("--grid-forces all", text)
        self.assertNotIn("nothing to do", text)


if __name__ == "__main__":
    unittest.main()
