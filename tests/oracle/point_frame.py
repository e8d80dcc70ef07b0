"""Three point masses on massless bars, bent in space, and the sums that their modes give."""
import h5py
import numpy as np

MASSES = {2: 2.0, 3: 1.5, 4: 0.75}
DECK = """SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
EIGRL,1,,,9
SPC1,1,123456,1
PBAR,1,1,1.-4,1.-8,2.-8,3.-8
MAT1,1,7.+10,,.3
GRID,1,,0.,0.,0.
GRID,2,,1.,.2,0.
GRID,3,,1.5,1.,.3
GRID,4,,1.,2.,1.
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
CBAR,3,1,3,4,0.,0.,1.
CONM2,12,2,,2.
CONM2,13,3,,1.5
CONM2,14,4,,.75
ENDDATA
"""


class PointFrame:
    """What the HDF5 file says of nodes and modes; nothing else is taken from it."""

    def __init__(self, path):
        with h5py.File(path) as f:
            ids = list(f["nodes/id"][:])
            rows = [ids.index(i) for i in MASSES]
            self.m = np.array(list(MASSES.values()))
            self.p = f["nodes/xyz"][:][rows]
            self.phi = f["modes/phi"][:][rows][:, :3, :]  # mass, component, mode
            self.ids, self.xyz, self.all_phi = ids, f["nodes/xyz"][:], f["modes/phi"][:]
            self.eigenvalue = f["modes/eigenvalue"][:]
            self.kg = f["stiffening/kg_inertial"][:]
            self.kg_external = f["stiffening/kg_external"][:]
            locator = f["stiffening/locator"]
            self.locators = [(int(n), int(d)) for n, d in zip(locator["node"][:], locator["direction"][:])]
        self.n = self.phi.shape[2]

    def sum(self, function):
        """Sum of m function(p, phi) over the masses, phi 3 x n."""
        return sum(m * function(p, phi) for m, p, phi in zip(self.m, self.p, self.phi))
