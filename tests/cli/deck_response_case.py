"""Decks and reader of the tests of responses. Contains no tests."""
import h5py
import numpy as np

from support import ProgramTest
from decks import OSCILLATOR, THREE_MASSES

# The oscillator with c = 2.4.
ONE = """SOL {sol}
CEND
SPC = 1
METHOD = 1
{case}
SET 1 = 1, 2
DISPLACEMENT = 1
VELOCITY = 1
ACCELERATION = 1
SPCFORCES = 1
FORCE = ALL
BEGIN BULK
EIGRL,1,,,1
""" + OSCILLATOR + """{bulk}
ENDDATA
"""
M, K, C = 4.0, 36.0, 2.4

CHAIN = """SOL {sol}
CEND
SPC = 1
METHOD = 1
{case}
DISPLACEMENT = ALL
ACCELERATION = ALL
SPCFORCES = ALL
BEGIN BULK
EIGRL,1,,,{modes}
""" + THREE_MASSES + """{bulk}
ENDDATA
"""

# A bent frame of consistent mass, one grid in axes of its own (in which v of CBAR 3 is (0, 0, 1)), a bush that damps.
FRAME = """SOL 111
CEND
SPC = 1
METHOD = 1
FREQUENCY = 5
DLOAD = 9
DISPLACEMENT = ALL
SPCFORCES = ALL
BEGIN BULK
PARAM,COUPMASS,1
PARAM,G,.02
EIGRL,1,,,{modes}
FREQ1,5,3.,17.3,9
CORD2R,7,,0.,0.,0.,2.,-2.,1.
,1.,2.,2.
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.,{cd}
GRID,4,,2.,1.,0.
GRID,5,,2.,2.,.5
MAT1,1,7.+10,,.3,2700.,,,.05
MAT1,2,7.+10,,.3,2700.
PBAR,1,1,1.-4,2.-8,1.-8,1.5-8
PBAR,2,2,1.-4,1.-8,3.-8,1.5-8
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
CBAR,3,2,3,4,{v}
CBAR,4,2,4,5,0.,0.,1.
CONM2,9,5,,.3
PBUSH,8,K,2.+3,,,,,
,,B,40.,20.
CBUSH,26,8,5,,,,,0
SPC1,1,123456,1
RLOAD2,9,10,.01,30.,3,4
DAREA,10,4,3,2.5
DAREA,10,2,2,-1.
FORCE,10,5,0,3.,1.,0.,1.
TABLED1,3
,0.,1.,100.,2.,300.,2.,ENDT
TABLED4,4,0.,100.,0.,200.
,10.,20.,ENDT
ENDDATA
"""


def read(path):
    """Subcase (1 where the deck numbers none) -> quantity -> (grid, component) -> samples, complex over frequency; x under "x"."""
    found = {}
    with h5py.File(path) as f:
        for name, group in f["subcases"].items():
            one = found[int(name) or 1] = {"x": (group["frequency_hz"] if "frequency_hz" in group else group["time"])[()]}
            for quantity in ["displacement", "velocity", "acceleration", "spc_force"]:
                if quantity not in group:
                    continue
                part = group[quantity]
                values = part["value"][()] if "value" in part else part["real"][()] + 1j * part["imag"][()]
                one[quantity] = {tuple(dof): values[:, i] for i, dof in enumerate(part["dofs"][()])}
            if "elements" in group:
                one["elements"] = {}
                for card, part in group["elements"].items():
                    values = part["value"][()] if "value" in part else part["real"][()] + 1j * part["imag"][()]
                    one["elements"][card] = (list(part["id"][()]), values)
            one["modes"] = {key: value[()] for key, value in group.get("modes", {}).items()}
    return found


class DeckResponse(ProgramTest):
    def solve(self, verb, deck, *options):
        self.write("d.bdf", deck)
        self.bough(verb, "d.bdf", "-o", "d.h5", *options)
        return read(self.path("d.h5"))

    def near(self, found, expected, relative=1e-10):
        expected = np.asarray(expected) * np.ones(np.shape(found))
        self.assertLess(np.abs(found - expected).max(), relative * np.abs(expected).max())
