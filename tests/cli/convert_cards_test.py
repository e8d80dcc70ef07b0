"""bough convert: decks of every card that carries units; frequencies, displacements, stresses and responses stay."""
import json
import unittest

import h5py
import numpy as np

from support import ProgramTest
from decks import grids

MM_TO_M = ("--units", "mm-N-tonne:m-kg-s")
MM_TO_MS = ("--units", "mm-N-tonne:mm-kg-ms")  # kN, and hertz become kilohertz

# mm, N, tonne, s; what DECK of convert_test has not: nonstructural mass in all its forms, plies of PCOMPG, PCOMP1 and
# PCOMP2, beams of stations and of several materials, bends, line dampers, two shear panels on a card, accelerations,
# temperatures, point loads along beams, given displacements.
STATIC = """SOL 103
CEND
SPC = 1
METHOD = 1
NSM = 50
SUBCASE 1
  LOAD = 10
SUBCASE 2
  LOAD = 11
SUBCASE 3
  TEMPERATURE(LOAD) = 12
SUBCASE 4
  LOAD = 13
BEGIN BULK
EIGRL,1,,,8
PARAM,COUPMASS,1
PARAM,WTMASS,1.
MAT1,1,7.+4,,.3,2.7-9,2.3-5,20.
,300.,200.,90.
MAT8,2,1.4+5,1.+4,.3,5.+3,5.+3,3.+3,1.6-9
,1.-6,3.-5,20.,1500.,1200.,50.,200.,70.
,,1.-6
MAT2,3,7.7+4,2.3+4,0.,7.7+4,0.,2.7+4,2.7-9
,2.3-5,2.3-5,0.,20.
MAT11,4,7.+4,7.+4,7.+4,.3,.3,.3,2.7+4
,2.7+4,2.7+4,2.7-9,1.-5,1.-5,1.-5,20.
GRID,1,,0.,0.,0.
GRID,2,,500.,0.,0.
GRID,3,,1000.,0.,0.
GRID,4,,1500.,0.,0.
GRID,5,,1800.,300.,0.
GRID,6,,2100.,300.,0.
CBEAM,1,1,1,2,0.,1.,0.
PBEAM,1,1,400.,2.+4,1.+4,1.+3,2.5+4,1.-6
,10.,10.,-10.,10.,5.,5.,5.,-5.
,YES,.5,380.,1.8+4,.9+4,.9+3,2.2+4,.9-6
,9.,9.,-9.,9.,4.,4.,4.,-4.
,YES,1.,300.,1.6+4,.8+4,.8+3,2.+4,.8-6
,8.,8.,-8.,8.,3.,3.,3.,-3.
,.8,.8,,,2.-5,2.-5
,1.,.5,1.,.5,.3,.2,.3,.2
CBEAM,2,2,2,3,0.,1.,0.
PBEAML,2,1,,BAR
,20.,30.,1.-6,YES,1.,15.,25.,1.-6
CBEAM,3,3,3,4,0.,1.,0.
PBCOMP,3,1,400.,2.+4,1.+4,,2.5+4,1.-6
,.8,.8,2.,1.,.5,.4,0
,10.,10.,.25,1,,,,
,-10.,10.,.25,1,,,,
,10.,-10.,.25,1,,,,
,-10.,-10.,.25,1
CBEND,4,4,4,5,0.,1.,0.,1
PBEND,4,1,400.,2.+4,1.+4,2.5+4,300.
,5.,5.,-5.,5.,5.,-5.,-5.,-5.
,.8,.8,1.-6
CBAR,5,5,5,6,0.,1.,0.
PBAR,5,1,400.,2.+4,1.+4,2.5+4,1.-6
,10.,10.,-10.,10.,,,,
,,,1.+3
GRID,11,,0.,1000.,0.
GRID,12,,500.,1000.,0.
GRID,13,,500.,1400.,0.
GRID,14,,0.,1400.,0.
GRID,15,,1000.,1000.,0.
GRID,16,,1000.,1400.,0.
GRID,17,,1500.,1000.,0.
GRID,18,,1500.,1400.,0.
GRID,19,,2000.,1000.,0.
GRID,20,,2000.,1400.,0.
CQUAD4,11,11,11,12,13,14
PCOMPG,11,-1.5,2.-10,,,20.
,1,2,1.,45.,YES
,2,2,1.,-45.,YES
,3,1,1.,0.,YES
CQUAD4,12,12,12,15,16,13,30.,1.5
PCOMP1,12,,1.-10,,,2,.5
,0.,90.,45.,45.
CQUAD4,13,13,15,17,18,16
PCOMP2,13,,1.-10,70.,TSAI,2
,1.,0.,.5,90.,1.,0.
CQUAD4,14,14,17,19,20,18
,,,3.,3.,2.5,2.5
PSHELL,14,3,3.,3,,1,,2.-9
,-1.,1.
CROD,21,21,1,11
PROD,21,1,50.,100.,3.,1.-7
CTUBE,22,22,6,20
PTUBE,22,1,20.,2.,1.-7,18.
CBUSH1D,23,23,3,15
PBUSH1D,23,200.,.1,1.-3
CSHEAR,24,24,1,2,12,11
CSHEAR,25,25,2,3,15,12
PSHEAR,24,1,1.,2.-9,25,1,1.5,3.-9
CVISC,26,26,4,17
PVISC,26,.5,30.
GRID,31,,0.,0.,500.
GRID,32,,300.,0.,500.
GRID,33,,300.,300.,500.
GRID,34,,0.,300.,500.
GRID,35,,0.,0.,700.
GRID,36,,300.,0.,700.
GRID,37,,300.,300.,700.
GRID,38,,0.,300.,700.
CHEXA,31,31,31,32,33,34,35,36
,37,38
PSOLID,31,4
CGAP,32,32,33,2,0.,1.,0.
PGAP,32,0.,,50.,10.,5.
SPC1,1,123,31,32,34
SPC1,1,456,31,THRU,38
CONM1,41,6,0,1.-3,0.,2.-3,0.,0.
,3.-3,0.,0.,0.,5.,0.,0.,0.
,0.,6.,0.,0.,0.,0.,0.,7.
NSMADD,50,51,52,53,54
NSM,51,PSHELL,14,1.-9
NSM1,52,PBAR,2.-6,5
NSML1,53,PCOMP,5.-5,12
NSML,54,PBEAM,1,1.-4
SPC1,1,123456,1,11,14
SPC1,1,345,19
LOAD,10,1.,1.,110,1.,111,1.,112
,1.,113
FORCE,110,6,,100.,0.,0.,1.
SLOAD,110,3,20.
PLOAD1,110,5,FY,LE,0.,.1,300.,.2
PLOAD1,110,1,MZ,FR,.5,500.
PLOAD1,110,2,FZ,FRPR,0.,.1,1.,.3
PLOAD2,111,.001,11,12
PLOAD4,111,31,.01,.02,.03,.01,35,37
FORCE1,112,6,50.,4,5
MOMENT1,112,6,5.+3,4,5
RFORCE,113,1,,1.5,0.,0.,1.
,.2
GRAV,11,,9810.,0.,0.,-1.
ACCEL1,11,,2000.,1.,0.,0.
,2,THRU,6
ACCEL,11,,0.,1.,0.,X
,0.,100.,2000.,900.
TEMPD,12,20.
TEMP,12,33,80.,12,70.
TEMPRB,12,5,40.,60.,.1,.1,.2,.2
TEMPP1,12,14,50.,2.
SPCD,13,19,3,2.,19,5,.01
FORCE,13,6,,1.,0.,1.,0.
ENDDATA
"""

# A frame on a base that moves; SDAMPING by a table over hertz.
DYNAMIC = """SOL {sol}
CEND
SPC = 1
METHOD = 1
SDAMPING = 30
FREQUENCY = 40
TSTEP = 41
DISPLACEMENT = ALL
SPCFORCES = ALL
FORCE = ALL
{case}BEGIN BULK
EIGRL,1,,,6
PARAM,G,.01
PARAM,W3,200.
PARAM,LFREQ,.1
MAT1,1,7.+4,,.3,2.7-9
GRID,1,,0.,0.,0.
GRID,2,,0.,0.,400.
GRID,3,,300.,0.,400.
CBAR,1,1,1,2,1.,0.,0.
CBAR,2,1,2,3,0.,1.,0.
PBAR,1,1,100.,2.+3,1.+3,2.5+3
CONM2,3,3,,1.-3
CDAMP2,4,.01,2,1
SPC1,1,123456,1
TABDMP1,30,CRIT
,0.,.02,50.,.04,400.,.04,ENDT
FREQ,40,5.,17.
FREQ1,40,30.,10.,3
FREQ2,40,80.,200.,3
FREQ4,40,1.,300.,.1,3
TSTEP,41,40,.0005,1
,,20,.001,2
RLOAD1,1,101,.002,30.,21,22
RLOAD2,2,102,3,4,23,24
TABLED1,21
,0.,1.,100.,2.,300.,.5,ENDT
TABLED2,22,10.
,0.,.1,300.,.3,ENDT
TABLED3,23,5.,50.
,0.,1.,8.,3.,ENDT
TABLED4,24,10.,100.,0.,500.
,1.,.5,.25,ENDT
DAREA,101,3,1,10.,3,5,200.
DELAY,3,3,2,.001
DPHASE,4,3,2,45.
FORCE,102,3,,5.,0.,1.,0.
DLOAD,10,1.,1.,1,2.,2
TLOAD1,5,101,.001,,25
TABLED1,25
,0.,0.,.005,1.,.02,.3,1.,0.
,ENDT
TLOAD2,6,102,,,.002,.03,60.,20.
,-30.
DLOAD,11,1.,1.,5,1.,6
TLOAD1,7,103,,ACCE,26
TABLED1,26
,0.,0.,.004,1.,.008,-1.,.012,0.
,1.,0.,ENDT
SPCD,103,1,1,5.+3,1,2,2.+3
TLOAD1,8,104,,VELO,26
SPCD,104,1,3,40.
DLOAD,12,1.,1.,7
DLOAD,13,1.,1.,8
TIC,9,3,1,.5,20.
TIC,9,3,5,.01,2.
ENDDATA
"""


class ConvertCards(ProgramTest):
    def read_statics(self, deck):
        self.bough("static", deck, "-o", "s.h5")
        found = {}
        with h5py.File(self.path("s.h5")) as f:
            translates = f["dof_map"][:, 1] <= 3
            for case in f["subcases"].values():
                name = case.name.split("/")[-1]
                found[name] = (case["displacement"][:], case["reaction"][:],
                               {card: case["stresses"][card]["stress"][:] for card in case["stresses"]},
                               {card: case["stresses"][card].attrs["components"] for card in case["stresses"]})
        return translates, found

    def test_frequencies_displacements_reactions_and_stresses(self):
        self.write("mm.bdf", STATIC)
        self.bough("convert", "mm.bdf", *MM_TO_M, "-o", "m.bdf")
        old, new = (np.array(json.loads(self.bough("modes", d, "--json").stdout)["frequency_hz"]) for d in ("mm.bdf", "m.bdf"))
        np.testing.assert_allclose(new, old, rtol=1e-10)
        translates, old = self.read_statics("mm.bdf")
        _, new = self.read_statics("m.bdf")
        self.assertEqual(list(old), ["1", "2", "3", "4"])
        for case in old:
            for part, of_translation, of_rotation in ((0, 1e-3, 1.0), (1, 1.0, 1e-3)):
                scaled = np.where(translates, of_translation, of_rotation) * old[case][part]
                for rows in (translates, ~translates):
                    np.testing.assert_allclose(new[case][part][rows], scaled[rows], rtol=0,
                                               atol=1e-9 * np.abs(scaled[rows]).max(), err_msg=f"{case} {part}")
            self.assertGreater(np.abs(old[case][0]).max(), 0)
            for card, stress in old[case][2].items():
                names = [n.decode() if isinstance(n, bytes) else n for n in old[case][3][card]]
                factors = np.array([1 if n.startswith("failure") else 1e6 for n in names])
                expected = stress * factors
                np.testing.assert_allclose(new[case][2][card], expected, rtol=1e-7, atol=1e-8 * np.abs(expected).max(),
                                           err_msg=f"{case} {card}")

    def read_curves(self, verb, deck):
        self.bough(verb, deck, "-o", "r.h5")
        with h5py.File(self.path("r.h5")) as f:
            case = f["subcases/1"]
            x = (case["time"] if "time" in case else case["frequency_hz"])[:]
            parts = {}
            for quantity in ("displacement", "spc_force"):
                if quantity in case:
                    group = case[quantity]
                    values = group["value"][:] if "value" in group else group["real"][:] + 1j * group["imag"][:]
                    parts[quantity] = (group["dofs"][:, 1] <= 3, values)
            group = case["elements/CBAR"]
            names = [n.decode() if isinstance(n, bytes) else n for n in group.attrs["components"]]
            values = group["value"][:] if "value" in group else group["real"][:] + 1j * group["imag"][:]
            is_force = np.tile([not ("moment" in n or "torque" in n) for n in names], values.shape[1])
            parts["force"] = (is_force, values.reshape(len(values), -1))
        return x, parts

    def compare_responses(self, verb, sol, case):
        """In metres, and in milliseconds with kN."""
        self.write("mm.bdf", DYNAMIC.format(sol=sol, case=case))
        x, old = self.read_curves(verb, "mm.bdf")
        for units, length, force, time in ((MM_TO_M, 1e-3, 1, 1), (MM_TO_MS, 1, 1e-3, 1e3)):
            self.bough("convert", "mm.bdf", *units, "-o", "new.bdf")
            new_x, new = self.read_curves(verb, "new.bdf")
            np.testing.assert_allclose(new_x, x * (time if verb == "transient" else 1 / time), rtol=1e-10)
            for quantity, (first, values) in old.items():
                factors = (length, 1) if quantity == "displacement" else (force, force * length)
                expected = values * np.where(first, *factors)
                for columns in (first, ~first):
                    if not columns.any():
                        continue
                    np.testing.assert_allclose(new[quantity][1][:, columns], expected[:, columns], rtol=0,
                                               atol=1e-7 * np.abs(expected[:, columns]).max(), err_msg=f"{units} {quantity}")
        self.assertGreater(np.abs(old["displacement"][1]).max(), 0)

    def test_frequency_response(self):
        self.compare_responses("frequency", 111, "DLOAD = 10\n")

    def test_transient_response(self):
        self.compare_responses("transient", 112, "DLOAD = 11\n")

    def test_direct_transient_from_a_start(self):
        self.compare_responses("transient", 109, "DLOAD = 11\nIC = 9\n")

    def test_supports_that_move(self):
        self.compare_responses("transient", 112, "DLOAD = 12\n")
        self.compare_responses("transient", 112, "DLOAD = 13\n")

    def test_what_nothing_tells(self):
        """A power of time with another unit of time; a table of both kinds of loads; SLOAD at a scalar point."""
        deck = DYNAMIC.format(sol=112, case="DLOAD = 11\n")
        for old, new in ((",-30.\n", ",-30.,2.\n"), ("TLOAD1,5,101,.001,,25", "TLOAD1,5,101,.001,,21")):
            self.write("d.bdf", deck.replace(old, new))
            self.bough("convert", "d.bdf", *MM_TO_M, "-o", "fine.bdf")
            self.fails(1, "convert", "d.bdf", *MM_TO_MS, "-o", "no.bdf", error="deck.unit-field")
        self.write("d.bdf", deck.replace("TIC,9,3,1", "SPOINT,99\nSLOAD,77,99,3.\nTIC,9,3,1"))
        self.fails(1, "convert", "d.bdf", *MM_TO_M, "-o", "no.bdf", error="deck.unit-field")



DIRECT = """SOL 101
CEND
SPC = 1
METHOD = 1
LOAD = 5
P2G = PL
NSM = 50
K2GG = 2.*KX
M2GG = MX
BEGIN BULK
EIGRL,1,,,6
MAT1,1,7.+4,,.3,2.7-9
""" + grids((0, 0, 0), (500, 0, 0), (1000, 0, 0)) + grids((1250, 0, 0), first=6) + grids(
    (1500, 0, 0), (1500, 200, 0), first=4) + grids((1500, 200, 100), (1600, 0, 0), first=7) + """CBAR,1,1,1,2,0.,1.,0.
CBAR,2,1,2,3,0.,1.,0.
CBAR,3,1,3,4,0.,1.,0.
PBAR,1,1,400.,2.+4,1.+4,1.+4
RSPLINE,50,.1,3,6,123456,4
RBAR1,60,4,5,123456,1.-5
RTRPLT1,61,4,7,8,123456,123456,1.-5
CONM2,9,6,,1.-4
CONM2,10,7,,1.-4
SPC1,1,123456,1
FORCE,5,4,,10.,0.,1.,1.
DMIG,KX,0,6,2,0
DMIG,KX,5,2,,5,2,3.5,,
,5,6,120.
DMIG,KX,5,6,,5,6,9.+4
DMIG,MX,0,6,2,0
DMIG,MX,5,1,,5,1,2.-4,,
,5,6,1.-3
DMIG,MX,5,6,,5,6,.5
DMIG,PL,0,9,2,0,,,1
DMIG,PL,1,,,5,1,40.,,
,5,6,900.
GENEL,70,,2,2,2,6,,,+
+,K,10.,100.,5000.
GENEL,71,,4,1,4,2,4,6,+
+,UD,,3,1,3,2,3,3,+
+,3,4,3,5,3,6,,,+
+,Z,1.-3,2.-4,1.-7,2.-3,3.-7,1.-6
NSM1,40,PBAR,1.-7,1
NSM1,41,PBAR,2.-7,1
NSMADD,50,40,41
ENDDATA
"""


class Direct(ProgramTest):
    """Direct matrices, general elements, rigid elements whose reals are ratios."""

    def solve(self, name):
        self.bough("modes", name, "-o", "m.h5")
        self.bough("static", name, "-o", "s.h5")
        with h5py.File(self.path("m.h5")) as m, h5py.File(self.path("s.h5")) as s:
            (case,) = s["subcases"]
            return m["modes/frequency_hz"][()], s[f"subcases/{case}/displacement"][()].reshape(-1, 6)

    def test_other_units(self):
        self.write("d.bdf", DIRECT.replace("RJOINT,62,4,8,\n", "").replace("RTRPLT1,61,4,7,8,123456,123456,1.-5", "RTRPLT1,61,4,7,8,123456,123456,1.-5"))
        hz, u = self.solve("d.bdf")
        for units, length, time in [(MM_TO_M, 1e-3, 1), (MM_TO_MS, 1, 1e3)]:
            self.bough("convert", "d.bdf", *units, "-o", "n.bdf")
            new_hz, new_u = self.solve("n.bdf")
            np.testing.assert_allclose(new_hz * time, hz, rtol=1e-8)
            scale = np.abs(u).max(axis=0)
            np.testing.assert_allclose(new_u / scale, u * ([length] * 3 + [1] * 3) / scale, atol=1e-8)

    def test_what_nothing_tells(self):
        """A matrix that no command selects, or two of other kinds; springs of scalar points."""
        for old, new in [("K2GG = 2.*KX\n", ""), ("M2GG = MX", "M2GG = MX, KX"),
                         ("NSM1,40", "CELAS4,80,1.,91,92\nNSM1,40")]:
            self.write("d.bdf", DIRECT.replace(old, new))
            self.fails(1, "convert", "d.bdf", *MM_TO_M, "-o", "no.bdf", error="deck.unit-field")
        self.write("d.bdf", DIRECT.replace("NSM1,40", "CELAS3,80,1,91,92\nCMASS3,81,1,91,92\nCDAMP3,82,1,91,92\nNSM1,40"))
        self.bough("convert", "d.bdf", *MM_TO_M, "-o", "fine.bdf")


if __name__ == "__main__":
    unittest.main()
