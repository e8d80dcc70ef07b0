"""Free modes in frames that nodes carry, clamped at such a node."""
import unittest

from support import ProgramTest
from toml_text import section, table, toml

RUN = section("simulation", duration=1.0)


class FrameNodeTest(ProgramTest):
    def test_free_modes_clamped_at_the_node_of_their_frame(self):
        """A beam of free-free modes, clamped: the warning depends on the modes, not on the frame that describes them."""
        n = 8
        self.write("beam.bdf", "SOL 103\nCEND\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPBAR,1,1,1.-4,1.-8,1.-8,1.-8\n"
                   "PARAM,COUPMASS,1\n" + "".join(f"GRID,{k + 1},,{k / n},0.,0.\n" for k in range(n + 1)) +
                   "".join(f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,1.,0.\n" for k in range(n)) + "ENDDATA\n")
        shares = {}
        for frame, basis in (("free", "normal"), ("node", "normal"), ("mass-centre", "normal"), ("node", "craig-bampton")):
            nodes = "" if frame == "free" else "frame_nodes = [1]\n"
            self.write("beam.toml", f'[body]\nname = "beam"\ndeck = "beam.bdf"\nframe = "{frame}"\n{nodes}interface = [1, {n + 1}]\n'
                       f'[body.modes]\nnumber = 6\nbasis = "{basis}"\n[body.output]\nfile = "beam.h5"\n')
            self.bough("reduce", "beam.toml", "-q")
            self.write("held.toml", toml(table("body", "beam", file="beam.h5"),
                                         table("hinge", "root", "fixed", child="beam", child_node=1), RUN))
            messages = self.bough("check", "held.toml").stderr
            shares[frame, basis] = messages.split("gives ")[1].split(" %")[0] if "system.stiff-shapes" in messages else ""
        self.assertGreater(int(shares["free", "normal"]), 10)
        for frame in ("node", "mass-centre"):
            self.assertEqual(shares[frame, "normal"], shares["free", "normal"], shares)
        self.assertEqual(shares["node", "craig-bampton"], "")


if __name__ == "__main__":
    unittest.main()
