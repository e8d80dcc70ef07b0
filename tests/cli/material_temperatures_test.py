"""MATT1, MATT2, MATT8, MATT9 with TABLEM1 to TABLEM4: decks with tables against decks with the values, closed forms."""
import unittest

import h5py
import numpy as np

from support import ProgramTest

# Every element with a material, hung from grids that are fixed; loads at all free grids.
GRIDS = """GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
GRID,5,,0.,0.,1.
GRID,6,,1.,0.,1.
GRID,7,,1.,1.,1.
GRID,8,,0.,1.,1.
GRID,9,,2.,0.,0.
GRID,10,,2.,1.,0.
GRID,11,,3.,0.,0.
GRID,12,,3.,1.,0.
GRID,13,,1.5,0.,.4
"""
ELEMENTS = """CHEXA,1,1,1,2,3,4,5,6
,7,8
PSOLID,1,9
CQUAD4,2,2,2,9,10,3
PSHELL,2,1,.02,1,,1
CQUAD4,3,3,9,11,12,10
PCOMP,3
,8,.01,0.,,8,.01,90.
CTRIA3,4,4,2,9,13
PSHELL,4,2,.03,2
CBAR,5,5,9,11,0.,0.,1.
PBAR,5,1,1.-3,2.-7,3.-7,4.-7
CBEAM,6,6,10,12,0.,0.,1.
PBEAM,6,1,1.-3,2.-7,3.-7,,4.-7
CROD,7,7,9,12
PROD,7,1,1.-4
CONROD,8,11,10,1,1.-4
CTETRA,9,9,2,3,10,7
PSOLID,9,1
"""
LOADS = "FORCE,5,11,0,100.,.2,.3,1.\nFORCE,5,12,0,100.,.1,-.4,1.\nFORCE,5,7,0,50.,1.,1.,1.\nSPC1,1,123456,1,4,5,8\n"
# Fields that a table gives, their constant, and y of the table at 60.
MATERIALS = """MAT1,1,{E},,{nu},{rho},{a},20.,{ge}
MAT2,2,{G11},2.+10,0.,7.+10,0.,2.5+10,2700.
,{a1},2.-5,0.,20.
MAT8,8,{E1},1.+10,.3,{G12},,,1600.
,1.-6,{a2},20.
MAT9,9,{C11},3.+10,3.+10,0.,0.,0.,8.+10
,3.+10,0.,0.,0.,8.+10,0.,0.
,3.+10,0.,0.,3.+10,0.,{C66},2700.,{x1}
,1.-5,1.-5,,,,20.
"""
TABLES = """MATT1,1,31,,32,33,34,,35
MATT2,2,36
,37
MATT8,8,38,,,39
,,40
MATT9,9,41
,0
,,,,,,42,,43
TABLEM1,31
,0.,8.+10,100.,6.+10,ENDT
TABLEM2,32,10.
,0.,1.,100.,1.2,ENDT
TABLEM1,33
,0.,2700.,100.,2500.,ENDT
TABLEM3,34,0.,100.
,0.,1.,1.,1.5,ENDT
TABLEM1,35
,0.,0.,100.,.1,ENDT
TABLEM4,36,0.,100.,0.,200.
,1.,-.1,.02,ENDT
TABLEM1,37
,0.,1.-5,100.,3.-5,ENDT
TABLEM1,38
,-100.,2.+11,100.,1.+11,ENDT
TABLEM1,39
,0.,5.+9,100.,4.+9,ENDT
TABLEM1,40
,0.,1.-5,100.,2.-5,ENDT
TABLEM1,41
,0.,9.+10,100.,8.+10,ENDT
TABLEM1,42
,0.,3.+10,100.,2.+10,ENDT
TABLEM1,43
,0.,1.-5,100.,2.-5,ENDT
"""
NOMINAL = dict(E=7e10, nu=.3, rho=2700, a=2e-5, ge=.02, G11=7e10, a1=2e-5, E1=1.4e11, G12=5e9, a2=1e-5, C11=8e10, C66=2.5e10,
               x1=1e-5)


def calc_values(T):
    at = lambda x, y: float(np.interp(T, x, y))
    s = T / 100
    return dict(E=at([0, 100], [8e10, 6e10]), nu=.3 * (1 + .2 * (T - 10) / 100), rho=at([0, 100], [2700, 2500]),
                a=2e-5 * (1 + .5 * s), ge=.1 * s, G11=7e10 * (1 - .1 * s + .02 * s * s), a1=at([0, 100], [1e-5, 3e-5]),
                E1=at([-100, 100], [2e11, 1e11]), G12=at([0, 100], [5e9, 4e9]), a2=at([0, 100], [1e-5, 2e-5]),
                C11=at([0, 100], [9e10, 8e10]), C66=at([0, 100], [3e10, 2e10]), x1=at([0, 100], [1e-5, 2e-5]))


def write_real(value):
    text = f"{value:.17g}"
    return (text if "e" in text or "." in text else text + ".").replace("e", "")


def write_materials(values):
    return MATERIALS.format(**{name: write_real(value) for name, value in values.items()})


def make(sol, case, materials, more=""):
    return "\n".join([f"SOL {sol}", "CEND", "SPC = 1", case, "BEGIN BULK", "EIGRL,1,,,8", GRIDS + ELEMENTS + LOADS + materials + more,
                      "ENDDATA", ""])


class MaterialTemperatures(ProgramTest):
    def static(self, deck, name="d"):
        self.write(f"{name}.bdf", deck)
        self.result = self.bough("static", f"{name}.bdf", "-o", f"{name}.h5")
        with h5py.File(self.path(f"{name}.h5")) as f:
            group = f["subcases"][list(f["subcases"])[0]]
            found = []
            group.visititems(lambda path, item: found.append((path, item[()])) if isinstance(item, h5py.Dataset)
                             and item.dtype.kind == "f" else None)
            return dict(found)

    def modes(self, deck):
        self.write("m.bdf", deck)
        self.result = self.bough("modes", "m.bdf", "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            return f["frequency_hz"][()] if "frequency_hz" in f else f["modes/frequency_hz"][()]

    def same(self, a, b, relative=1e-12):
        self.assertEqual(sorted(a), sorted(b))
        for name in (n for n in a if not n.endswith(("epsilon", "resultants"))):  # round-off of internal forces
            size = np.abs(b[name]).max(initial=0)
            np.testing.assert_allclose(a[name], b[name], rtol=0, atol=relative * size + 1e-300, err_msg=name)

    def test_every_element(self):
        """Tables at 60 degrees, and the values at 60 degrees: displacements, forces, stresses, frequencies alike."""
        constant, tables = write_materials(calc_values(60)), write_materials(NOMINAL) + TABLES
        for case, more in [("LOAD = 5\nTEMPERATURE(MATERIAL) = 6", "TEMPD,6,60.\n"),
                           ("LOAD = 5\nTEMPERATURE = 6", "TEMPD,6,60.\n"),
                           ("LOAD = 5\nTEMPERATURE(INITIAL) = 6\nTEMPERATURE(LOAD) = 7", "TEMPD,6,60.\nTEMPD,7,90.\n")]:
            with self.subTest(case):
                found = self.static(make(101, case, tables, more))
                expected = self.static(make(101, case, constant, more), "e")
                self.same(found, expected)
                changed = self.static(make(101, case, write_materials(NOMINAL), more), "e")
                name = next(n for n in found if "displacement" in n)
                self.assertGreater(np.abs(found[name] - changed[name]).max(), 1e-3 * np.abs(changed[name]).max())
        case = "METHOD = 1\nTEMPERATURE(MATERIAL) = 6"
        np.testing.assert_allclose(self.modes(make(103, case, tables, "TEMPD,6,60.\n")),
                                   self.modes(make(103, case, constant, "TEMPD,6,60.\n")), rtol=1e-12)

    def test_gradient_along_a_rod(self):
        """Rods of a line, temperatures linear along it: each has the modulus at its mean, u = Σ F L / (A E(T_k))."""
        number, F, A = 5, 1000.0, 1e-4
        deck = "\n".join(["SOL 101", "CEND", "SPC = 1", "LOAD = 5", "TEMPERATURE(MATERIAL) = 6", "BEGIN BULK",
                          *[f"GRID,{k + 1},,{.2 * k},0.,0." for k in range(number + 1)],
                          *[f"CROD,{k},7,{k},{k + 1}" for k in range(1, number + 1)], "PROD,7,1,1.-4", "MAT1,1,7.+10,,.3",
                          "MATT1,1,31", "TABLEM1,31", ",0.,8.+10,100.,6.+10,ENDT", f"FORCE,5,{number + 1},0,{F},1.,0.,0.",
                          *[f"TEMP,6,{k + 1},{20. * k}" for k in range(number + 1)], "SPC1,1,123456,1",
                          "SPC1,1,23456,1,THRU,6", "ENDDATA", ""])
        found = self.static(deck)
        name = next(n for n in found if "displacement" in n)
        moduli = [8e10 - 2e8 * (20 * k + 10) for k in range(number)]
        expected = sum(F * .2 / (A * E) for E in moduli)
        self.assertAlmostEqual(found[name].reshape(number + 1, -1)[-1, 0] / expected, 1, places=12)

    def test_temperatures_of_elements(self):
        """TEMPRB and TEMPP1 give the temperature at which the element is, in place of its grids."""
        constant, tables = write_materials(calc_values(60)), write_materials(NOMINAL) + TABLES
        cards = "TEMPD,6,10.\n" + "".join(f"TEMPRB,6,{e},50.,70.\n" for e in (5, 6, 7, 8)) + \
            "".join(f"TEMPP1,6,{e},60.\n" for e in (2, 3, 4)) + "TEMP,6,1,60.,2,60.,3,60.\nTEMP,6,4,60.,5,60.,6,60.\n" \
            "TEMP,6,7,60.,8,60.,10,60.\n"
        case = "LOAD = 5\nTEMPERATURE(MATERIAL) = 6"
        self.same(self.static(make(101, case, tables, cards)), self.static(make(101, case, constant, cards), "e"))

    def test_subcases_of_several_temperatures(self):
        """Each subcase has the materials of the set that it selects."""
        case = "LOAD = 5\nSUBCASE 1\nTEMPERATURE(MATERIAL) = 6\nSUBCASE 2\nTEMPERATURE(MATERIAL) = 7"
        self.write("d.bdf", make(101, case, write_materials(NOMINAL) + TABLES, "TEMPD,6,60.\nTEMPD,7,90.\n"))
        self.bough("static", "d.bdf", "-o", "d.h5")
        for T, number in ((60, 0), (90, 1)):
            expected = self.static(make(101, "LOAD = 5", write_materials(calc_values(T))), "e")
            name = next(n for n in expected if "displacement" in n)
            with h5py.File(self.path("d.h5")) as f:
                found = f["subcases"][sorted(f["subcases"])[number]][name][()]
            np.testing.assert_allclose(found, expected[name], rtol=0, atol=1e-12 * np.abs(expected[name]).max())

    def test_written_and_converted(self):
        """A deck that export writes, and one in mm, N and tonnes, have the same answer."""
        case = "LOAD = 5\nTEMPERATURE(MATERIAL) = 6"
        deck = make(101, case, write_materials(NOMINAL) + TABLES, "TEMPD,6,60.\n")
        before = self.static(deck)
        name = next(n for n in before if "displacement" in n)
        self.bough("convert", "d.bdf", "--units", "m-kg-s:mm-N-tonne", "-o", "mm.bdf")
        after = self.static(self.read("mm.bdf"), "e")
        u, v = before[name].reshape(13, 6), after[name].reshape(13, 6)
        np.testing.assert_allclose(v[:, :3], 1e3 * u[:, :3], rtol=0, atol=1e-9 * np.abs(v).max())

    def test_sections_of_superelements(self):
        """A cantilever in a section: F L³ / (3 E(T) I) by the set of the section, in all cases or by its subcase."""
        F, L, inertia = 90.0, 2.0, 3e-7
        deck = "\n".join(["SOL 101", "CEND", "SPC = 1", "LOAD = 5", "{case}", "BEGIN BULK", "GRID,1,,0.,0.,0.", "GRID,3,,2.,0.,0.",
                          "SPC1,1,123456,1", f"FORCE,5,3,0,{F},0.,1.,0.", "{main}BEGIN SUPER = 1", "GRID,1,,0.,0.,0.",
                          "GRID,2,,1.,0.,0.", "GRID,3,,2.,0.,0.", "CBAR,1,5,1,2,0.,1.,0.", "CBAR,2,5,2,3,0.,1.,0.",
                          "PBAR,5,1,1.-3,3.-7,2.-7,4.-7", "MAT1,1,7.+10,,.3", "{section}ENDDATA", ""])
        tables = "MATT1,1,31\nTABLEM1,31\n,0.,8.+10,100.,6.+10,ENDT\n"
        for case, section, modulus in [
                ("TEMPERATURE(MATERIAL) = 6", tables + "TEMPD,6,90.\n", 6.2e10),
                ("TEMPERATURE(INITIAL) = 6", tables + "TEMPD,6,90.\n", 6.2e10),
                ("TEMPERATURE(MATERIAL) = 6", tables + "TEMP,6,1,80.,2,80.\nTEMP,6,3,80.\n", 6.4e10),
                ("TEMPERATURE(MATERIAL) = 6", "TEMPD,6,90.\n", 7e10)]:
            found = self.static(deck.format(case=case, main="", section=section))
            name = next(n for n in found if "displacement" in n)
            v = found[name].reshape(-1, 6)[-1, 1]
            self.assertAlmostEqual(v / (F * L**3 / (3 * modulus * inertia)), 1, places=9)
        self.write("d.bdf", deck.format(case="TEMPERATURE(MATERIAL) = 6", main="TEMPD,6,90.\n", section=tables))
        self.fails(1, "static", "d.bdf", error="fe.part-temperature", says=["superelement 1", "temperature set 6", "its section"])
        self.write("d.bdf", deck.format(case="TITLE = none", main="", section=tables))
        self.assertIn("fe.material-tables-unused", self.bough("static", "d.bdf").stderr)

    def test_tables_over_frequency_in_sections(self):
        """A section is condensed once: a spring with a table in it is an error of responses, and no matter of statics."""
        deck = "\n".join(["SOL 108", "CEND", "SPC = 1", "LOAD = 5", "DLOAD = 4", "FREQ = 5", "BEGIN BULK", "GRID,1,,0.,0.,0.,,23456",
                          "GRID,2,,1.,0.,0.,,23456", "SPC1,1,1,1", "CONM2,9,2,,1.", "DAREA,3,2,1,1.", "RLOAD1,4,3,,,1.", "FREQ,5,2.",
                          "FORCE,5,2,0,1.,1.,0.,0.", "BEGIN SUPER = 1", "GRID,1,,0.,0.,0.,,23456", "GRID,2,,1.,0.,0.,,23456",
                          "CELAS1,1,1,1,1,2,1", "PELAS,1,1.+4", "PELAST,1,7", "TABLED1,7", ",0.,9.+3,9.,2.+4,ENDT", "ENDDATA", ""])
        self.write("d.bdf", deck)
        self.fails(1, "frequency", "d.bdf", error="modal.part-tables", says=["PELAST of superelement 1", "main bulk data"])
        found = self.static(deck.replace("SOL 108", "SOL 101").replace("DLOAD = 4\nFREQ = 5\n", ""))
        name = next(n for n in found if "displacement" in n)
        self.assertAlmostEqual(found[name].reshape(-1, 6)[1, 0], 1e-4, places=12)

    def test_welds_on_shells(self):
        """The material of a weld is at the mean of the grids of its two shells, wherever its place is given."""
        grids = "".join(f"GRID,{100 * k + 10 * j + i},,{.1 * i:.1f},{.1 * j:.1f},{.02 * (k - 1):.2f}\n"
                        for k in (1, 2) for j in range(4) for i in range(4))
        shells = "".join(f"CQUAD4,{100 * k + 10 * j + i},{k},{100 * k + 10 * j + i},{100 * k + 10 * j + i + 1},"
                         f"{100 * k + 10 * j + i + 11},{100 * k + 10 * j + i + 10}\n" for k in (1, 2) for j in range(3) for i in range(3))
        temperatures = "".join(f"TEMP,6,{100 * k + 10 * j + i},{3.0 * i + 5 * j + 20 * k}\n" for k in (1, 2) for j in range(4)
                               for i in range(4))
        # Shells 112 and 212: grids of columns 2 and 3, rows 1 and 2.
        T = np.mean([3.0 * i + 5 * j + 20 * k for k in (1, 2) for j in (1, 2) for i in (2, 3)])
        head = "SOL 101\nCEND\nSPC = 1\nLOAD = 5\nTEMPERATURE(MATERIAL) = 6\nBEGIN BULK\nSPC1,1,123456,100,110,120,130\n" \
            "FORCE,5,233,0,70.,1.,.3,.2\nPSHELL,1,1,.004,1,,1\nPSHELL,2,1,.003,1,,1\nMAT1,1,7.+10,,.3,2700.\nPWELD,50,9,.02\n"
        place = "GRID,900,,.24,.17,.5\n"
        for form in ("CWELD,50,50,,PARTPAT\n,1,2\n,.24,.17,.3\n", place + "CWELD,50,50,900,PARTPAT\n,1,2\n",
                     place + "CWELD,50,50,900,ELPAT\n,112,212\n", "CWELD,50,50,,ELEMID\n,112,212\n,.24,.17,.3\n",
                     "CWELD,50,50,,GRIDID,,,QQ\n,112,113,123,122\n,212,213,223,222\n,.24,.17,.3\n"):
            found = self.static(head + grids + shells + temperatures + form + "MAT1,9,2.+8,,.3\nMATT1,9,31\nTABLEM1,31\n"
                                ",0.,4.+8,100.,2.+8,ENDT\nENDDATA\n")
            expected = self.static(head + grids + shells + temperatures + form + f"MAT1,9,{write_real(4e8 - 2e6 * T)},,.3\nENDDATA\n",
                                   "e")
            with self.subTest(form):
                self.same(found, expected, 1e-10)

    def test_materials_are_named_by_their_ids(self):
        """Messages of a material at a temperature name the card of the deck, and not the copy."""
        tables = write_materials(NOMINAL) + TABLES.replace(",0.,8.+10,100.,6.+10,ENDT", ",0.,8.+10,50.,-6.+10,ENDT")
        self.write("d.bdf", make(101, "LOAD = 5\nTEMPERATURE(MATERIAL) = 6", tables, "TEMPD,6,60.\n"))
        self.fails(1, "static", "d.bdf", error="fe.bad-material", says=["MAT1 1 at temperature 60 has E = "])

    def test_rejected_input(self):
        tables = write_materials(NOMINAL) + TABLES
        case = "LOAD = 5\nTEMPERATURE(MATERIAL) = 6"
        for cards, error, says in [(tables.replace("TABLEM1,31", "TABLEM1,99"), "fe.missing-material-table", ["MATT1 1", "31"]),
                                   (tables, "fe.missing-load", ["temperature set 6"])]:
            more = "TEMPD,6,60.\n" if error == "fe.missing-material-table" else ""
            self.write("d.bdf", make(101, case, cards, more))
            self.fails(1, "static", "d.bdf", error=error, says=says)
        for old, new, says in [("MATT8,8,", "MATT8,1,", ["MATT8 1 refers to MAT8 1, but material 1 is a MAT1", "write MATT1"]),
                               ("MATT9,9,", "MATT9,8,", ["MATT9 8", "is a MAT8"]),
                               ("MATT2,2,", "MATT2,9,", ["MATT2 9", "is a MAT9"])]:
            self.write("d.bdf", make(101, case, tables.replace(old, new), "TEMPD,6,60.\n"))
            self.fails(1, "static", "d.bdf", error="fe.missing-material", says=[*says, "d.bdf:"])
        # No element has a material that is not there.
        self.write("d.bdf", make(101, case, tables.replace("MATT1,1,", "MATT1,77,"), "TEMPD,6,60.\n"))
        self.assertRegex(self.bough("static", "d.bdf").stderr,
                         r"d\.bdf:\d+: warning: MATT1 77 refers to MAT1 77, which the deck does not define")
        self.write("d.bdf", make(101, case, tables, "TEMP,6,1,60.\n"))
        self.fails(1, "static", "d.bdf", error="fe.missing-temperature", says=["at which its material is evaluated"])
        self.write("d.bdf", make(101, "LOAD = 5", tables, "TEMPD,6,60.\n"))
        self.assertIn("fe.material-tables-unused", self.bough("static", "d.bdf").stderr)


if __name__ == "__main__":
    unittest.main()
