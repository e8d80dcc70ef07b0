"""External superelements: read (extseout and se_static of the shared models, with the vendor's results), written and read
again, as bodies with recovery rows (docs/external-superelements.md), checked as delivered components, half ones refused."""
import json
import os
import re
import shutil
import sys
import unittest

import h5py
import numpy as np
import scipy.linalg
import scipy.sparse

from support import SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tests/oracle"))
import op4_reader  # noqa: E402

SHARED = os.path.join(os.environ.get("BOUGH_SHARED_DIR", ""), "models")

# A frame of bars in space: two columns on the ground (residual), a crossbeam with a mast (component) on top of them.
BARS = "PBAR,1,1,2.-3,3.-7,5.-7,4.-7\nMAT1,1,7.+10,,.3,2700.,,,.02\nPARAM,COUPMASS,1\n"
COLUMNS = ("GRID,1,,0.,0.,0.\nGRID,2,,0.,0.,.6\nGRID,3,,0.,0.,1.2\nGRID,11,,3.,0.,0.\nGRID,12,,3.,0.,.6\n"
           "CBAR,1,1,1,2,1.,0.,0.\nCBAR,2,1,2,3,1.,0.,0.\nCBAR,3,1,11,12,1.,0.,0.\nCBAR,4,1,12,13,1.,0.,0.\n"
           "SPC1,1,123456,1,11\n")
TOP = "CORD2R,9,,0.,0.,0.,1.,2.,2.\n,1.,0.,0.\n"
TOP_GRIDS = "".join(f"GRID,{20 + k},,{.5 * k},0.,1.2,{9 if k == 3 else ''}\n" for k in range(1, 6))
MAST = "".join(f"GRID,{30 + k},,1.5,{.1 * k},{1.2 + .4 * k}\n" for k in range(1, 4))
TOP_ELEMENTS = ("CBAR,21,1,3,21,0.,1.,0.\n" + "".join(f"CBAR,{21 + k},1,{20 + k},{21 + k},0.,1.,0.\n" for k in range(1, 5)) +
                "CBAR,26,1,25,13,0.,1.,0.\nCBAR,31,1,23,31,0.,1.,0.\nCBAR,32,1,31,32,0.,1.,0.\n"
                "CBAR,33,1,32,33,0.,1.,0.\nCONM2,40,33,,2.,.05,0.,0.\n,.02,0.,.03,0.,0.,.04\n")
ENDS = "GRID,3,,0.,0.,1.2\nGRID,13,,3.,0.,1.2\n"
FULL = (f"SOL 103\nCEND\nSPC=1\nMETHOD=1\nBEGIN BULK\nEIGRL,1,,,8\n{BARS}{COLUMNS}GRID,13,,3.,0.,1.2\n{TOP}{TOP_GRIDS}{MAST}"
        f"{TOP_ELEMENTS}ENDDATA\n")
COMPONENT = ("ASSIGN OUTPUT4='top.op4' UNIT=51,DELETE\nSOL 103\nCEND\nMETHOD=1\nSET 1 = 23,33,902\nDISPLACEMENT(PLOT)=1\n"
             "SET 2 = 21,33\nFORCE(PLOT)=2\nSTRESS(PLOT)=2\nEXTSEOUT(ASMBULK,EXTBULK,EXTID=50,MATOP4=51)\nBEGIN BULK\n"
             "EIGRL,1,,2000.\nSPOINT,901,THRU,960\nQSET1,0,901,THRU,960\nBSET1,123456,3,13\n"
             f"{BARS}{TOP}{ENDS}{TOP_GRIDS}{MAST}{TOP_ELEMENTS}ENDDATA\n")
ASSEMBLY = ("ASSIGN INPUTT4='top.op4',UNIT=51\nSOL 103\nCEND\nSPC=1\nMETHOD=1\nBEGIN BULK\nEIGRL,1,,,8\n"
            f"{BARS}{COLUMNS.replace('GRID,3,,0.,0.,1.2', '$')}INCLUDE 'top.asm'\nINCLUDE 'top.pch'\nENDDATA\n")
LOADS = "FORCE,5,2,,300.,1.,.4,0.\nFORCE,5,3,,-200.,0.,1.,1.\n"


def list_words_below(path, heading):
    """Words of each line of a print file below the first line with the heading."""
    with open(path, encoding="latin-1") as f:
        lines = iter(f)
        for line in lines:
            if heading in line:
                break
        return [line.split() for line in lines]


def read_printed_frequencies(path):
    """The first table of real eigenvalues of a print file, Hz."""
    found = []
    for words in list_words_below(path, "R E A L   E I G E N V A L U E S"):
        if len(words) == 7 and words[0].isdigit():
            if found and int(words[0]) != len(found) + 1:
                break
            found.append(float(words[4]))
        elif found and len(words) > 2 and not words[0].isdigit() and "E" not in words[-1]:
            break
    return np.array(found)


class Written(ProgramTest):
    """A component of ours, out and in."""

    def setUp(self):
        super().setUp()
        self.write("full.bdf", FULL)
        self.write("top.bdf", COMPONENT)
        self.write("assembly.bdf", ASSEMBLY)
        self.result = self.bough("export", "top.bdf", "--to", "extseout", "-o", "top.op4")

    def test_split_refuses_superelements(self):
        self.fails(1, "split", "assembly.bdf", "--parts", 2, error="split.superelements")

    def find_modes(self, deck, *options):
        return np.array(json.loads(self.bough("modes", deck, "--json", *options).stdout)["frequency_hz"])

    def read_op4(self):
        matrices = {}
        for name, _, _, rows, columns, entries in op4_reader.read(self.path("top.op4")):
            matrices[name] = np.zeros((rows, columns))
            for (row, column), value in entries.items():
                matrices[name][row - 1, column - 1] = value.real
        return matrices

    def test_whole_and_components_agree(self):
        whole = self.find_modes("full.bdf")
        parts = self.find_modes("assembly.bdf")
        np.testing.assert_allclose(parts[:6], whole[:6], rtol=5e-6)

    def test_modes_of_msc_names(self):
        nx = self.find_modes("assembly.bdf")
        self.bough("export", "top.bdf", "--to", "extseout", "--vendor", "msc", "-o", "top")
        np.testing.assert_allclose(self.find_modes("assembly.bdf"), nx, rtol=1e-12)

    def test_statics_agree_to_roundoff(self):
        control = "SOL 101\nCEND\nSPC=1\nLOAD=5\nBEGIN BULK\n"
        for name in ("full", "assembly"):
            text = self.read(name + ".bdf")
            text = re.sub(r"SOL 103.*?BEGIN BULK\n", control, text, flags=re.S).replace("ENDDATA", "")
            before, after = (text.split("INCLUDE 'top.pch'") + [None])[:2]
            self.write("s.bdf", before + LOADS + ("INCLUDE 'top.pch'" + after if after is not None else "") + "ENDDATA\n")
            self.bough("static", "s.bdf", "-o", name + ".h5")
        with h5py.File(self.path("full.h5")) as a, h5py.File(self.path("assembly.h5")) as b:
            def displacements(f):
                group = f["subcases"][sorted(f["subcases"])[0]]
                return {tuple(map(int, dof)): u for dof, u in zip(f["dof_map"][:], group["displacement"][:])}, group
            u, _ = displacements(a)
            v, group = displacements(b)
            largest = max(map(abs, u.values()))
            for dof in [(g, c) for g in (2, 3, 12, 13) for c in range(1, 7)]:
                self.assertAlmostEqual(u[dof], v[dof], delta=1e-8 * largest)
            # The interior by the rows of MUG1: basic axes of the whole, CD axes of grid 23 here.
            table = group["elements/MUG1_50"]
            rows = {int(i): f for i, f in zip(table["id"][:], table["force"][:])}
            for i, c in ((33, 0), (33, 1), (33, 2)):
                self.assertAlmostEqual(rows[i][c], u[(i, c + 1)], delta=1e-8 * largest)

    def test_structural_damping_counts_once(self):
        """PARAM,G of the component's deck is not in its K4: that of the assembly acts on its stiffness."""
        K4 = self.read_op4()["K4XX1"]
        self.write("top.bdf", COMPONENT.replace("BEGIN BULK\n", "BEGIN BULK\nPARAM,G,.1\n"))
        result = self.bough("export", "top.bdf", "--to", "extseout", "-o", "top.op4")
        self.assertIn("export.component-damping", result.stderr)
        np.testing.assert_array_equal(self.read_op4()["K4XX1"], K4)

    def test_geometric_stiffness_that_is_not_known(self):
        text = ASSEMBLY.replace("METHOD=1\n", "SUBCASE 1\nLOAD = 5\nSUBCASE 2\nMETHOD=1\nSTATSUB = 1\n")
        self.write("p.bdf", text.replace("INCLUDE 'top.pch'", LOADS + "INCLUDE 'top.pch'"))
        self.assertIn("fe.superelement-stiffening", self.bough("modes", "p.bdf").stderr)
        self.write("a.toml", '[body]\nname = "a"\ndeck = "assembly.bdf"\n[body.modes]\nnumber = 3\n')
        self.assertIn("fe.superelement-stiffening", self.bough("reduce", "a.toml").stderr)

    def test_matrices_are_those_of_numpy(self):
        """Dense Craig-Bampton of the component's K and M."""
        deck = re.sub(r"SPOINT.*\nQSET1.*\nBSET1.*\n", "", COMPONENT)
        self.write("free.bdf", deck)
        self.bough("matrices", "free.bdf", "-o", "free.h5")
        with h5py.File(self.path("free.h5")) as f:
            dofs = [tuple(map(int, row)) for row in f["dof_map"][:]]
            K, M = (scipy.sparse.csr_matrix((f[name]["data"][:], f[name]["indices"][:], f[name]["indptr"][:]),
                                            shape=tuple(f[name]["shape"][:])).toarray() for name in ("K", "M"))
        b = [i for i, d in enumerate(dofs) if d[0] in (3, 13)]
        i = [k for k in range(len(dofs)) if k not in b]
        Psi = np.zeros((len(dofs), len(b)))
        Psi[b] = np.eye(len(b))
        Psi[i] = -np.linalg.solve(K[np.ix_(i, i)], K[np.ix_(i, b)])
        own = self.read_op4()
        nb = len(b)
        scale = np.abs(Psi.T @ K @ Psi).max()
        np.testing.assert_allclose(own["KXX"][:nb, :nb], Psi.T @ K @ Psi, atol=1e-9 * scale)
        np.testing.assert_allclose(own["MXX"][:nb, :nb], Psi.T @ M @ Psi, atol=1e-10 * np.abs(M).max())
        self.assertEqual(np.abs(own["KXX"][:nb, nb:]).max(), 0)
        theta = scipy.linalg.eigh(M[np.ix_(i, i)], K[np.ix_(i, i)], eigvals_only=True)[::-1]
        held = 1 / theta[theta > 0]
        count = np.sum(held < (2 * np.pi * 2000) ** 2)
        np.testing.assert_allclose(np.diag(own["KXX"])[nb:nb + count], held[:count], rtol=1e-8)
        # GE 0.02 of the material is K4.
        np.testing.assert_allclose(own["K4XX1"][:nb, :nb], .02 * Psi.T @ K @ Psi, atol=1e-9 * scale)

    def test_stress_rows(self):
        """STRESS: axial stress of the bars is force over area; without points C to F they have no bending stress."""
        own = self.read_op4()
        self.assertEqual((own["MES1"].shape[0], own["MEF1"].shape[0]), (18, 16))  # bars 21 and 33
        small = 1e-9 * np.abs(own["MES1"]).max()
        for bar in (0, 1):
            np.testing.assert_allclose(own["MES1"][9 * bar + 4], own["MEF1"][8 * bar + 6] / 2e-3, rtol=1e-9, atol=small)
            np.testing.assert_allclose(np.delete(own["MES1"][9 * bar:9 * bar + 9], 4, 0), 0, atol=small)

    def test_check_of_the_component(self):
        data = json.loads(self.bough("check", "assembly.bdf", "--json").stdout)
        one = data["superelements"][0]
        self.assertEqual((one["id"], one["num_grids"]), (50, 2))
        self.assertLess(max(one["rigid_energy"]), 1e-12)
        self.assertEqual(one["coupling"], 0)
        length = 6 * .5 + 3 * np.hypot(.1, .4)
        self.assertAlmostEqual(one["mass_properties"]["mass"], 2 + 2700 * 2e-3 * length, delta=1e-9)
        self.assertGreater(one["held_hz"][0], 1)
        self.assertIn("boundary held, Hz", self.bough("check", "assembly.bdf").stdout)

    def test_a_component_held_to_the_ground_is_named(self):
        self.write("top.bdf", COMPONENT.replace("ENDDATA", "CELAS2,99,1.+5,22,1\nENDDATA"))
        self.bough("export", "top.bdf", "--to", "extseout", "-o", "top")
        self.assertIn("[fe.superelement-grounded]", self.bough("check", "assembly.bdf").stderr)

    def test_body_of_a_component(self):
        """The assembly without its residual is the component as a free body, with the rows of its interior."""
        self.write("part.bdf", "ASSIGN INPUTT4='top.op4',UNIT=51\nSOL 103\nCEND\nMETHOD=1\nBEGIN BULK\nEIGRL,1,,,6\n"
                               "INCLUDE 'top.asm'\nINCLUDE 'top.pch'\nENDDATA\n")
        self.write("whole.bdf", re.sub(r"SPOINT.*\nQSET1.*\nBSET1.*\n", "", COMPONENT).replace("EIGRL,1,,2000.", "EIGRL,1,,,6"))
        self.bough("reduce", "part.bdf", "--free", "-n", 5, "--recover", "ALL", "--full", "-o", "part.h5")
        self.bough("reduce", "whole.bdf", "--free", "-n", 5, "--recover", "ALL", "-o", "whole.h5")
        with h5py.File(self.path("part.h5")) as a, h5py.File(self.path("whole.h5")) as b:
            np.testing.assert_allclose(a["modes/frequency_hz"][:], b["modes/frequency_hz"][:], rtol=5e-6)
            for name in ("mass", "cg", "inertia"):
                np.testing.assert_allclose(a["rigid/" + name][:], b["rigid/" + name][:], rtol=1e-6, atol=1e-6)
            block = a["recovery/elements/MEF1_50"]
            names = [c.decode() for c in block["component"][:]]
            found = block["matrix"][:][list(block["id"][:]).index(21), names.index("axial")]
            whole = b["recovery/elements/CBAR"]
            names = [c.decode() for c in whole["component"][:]]
            other = whole["matrix"][:][list(whole["id"][:]).index(21), names.index("axial")]
            row = {tuple(map(int, dof)): k for k, dof in enumerate(a["dof_map"][:])}
            phi = a["full/phi"][:]
        own = self.read_op4()
        points = sorted(g for g, c in row if c == 0)
        exterior = [row[(g, c)] for g in (3, 13) for c in range(1, 7)] + [row[(g, 0)] for g in points]
        axial = 6  # of M1 M2 at both ends, V1, V2, axial, torque
        np.testing.assert_allclose(found, own["MEF1"][axial] @ phi[exterior], rtol=1e-6, atol=1e-9 * np.abs(found).max())
        # The whole body has shapes that the modes below 2000 Hz hold but for a part in the higher ones.
        np.testing.assert_allclose(np.abs(found[:2]), np.abs(other[:2]), rtol=2e-3)

    def test_a_body_as_component(self):
        self.write("body.toml", '[body]\nname = "top"\ndeck = "free.bdf"\nframe = "node"\n'
                                'frame_nodes = [3]\ninterface = [3, 13]\n[body.modes]\nbasis = "craig-bampton"\n'
                                'orthogonalize = false\nnumber = 12\n')
        self.write("free.bdf", re.sub(r"SPOINT.*\nQSET1.*\nBSET1.*\n", "", COMPONENT))
        self.bough("reduce", "body.toml", "-o", "body.h5")
        direct = self.find_modes("assembly.bdf")
        self.bough("export", "body.h5", "--to", "extseout", "--id", 50, "--unit", 51, "-o", "top")
        np.testing.assert_allclose(self.find_modes("assembly.bdf")[:5], direct[:5], rtol=1e-4)

    def test_missing_halves(self):
        self.write("a.bdf", ASSEMBLY.replace("INCLUDE 'top.pch'\n", ""))
        self.fails(1, "modes", "a.bdf", error="matrices.superelement-half", says=["top.asm:", "BEGIN SUPER=50"])
        self.write("a.bdf", ASSEMBLY.replace("INCLUDE 'top.asm'\n", ""))
        self.fails(1, "modes", "a.bdf", error="matrices.superelement-half", says=["top.pch:", "no SEBULK"])
        self.write("a.bdf", ASSEMBLY.replace("ASSIGN INPUTT4='top.op4',UNIT=51\n", ""))
        self.fails(1, "modes", "a.bdf", error="matrices.superelement-half", says=["unit 51"])
        os.remove(self.path("top.op4"))
        self.fails(1, "modes", "assembly.bdf", error="matrices.superelement-half", says=["assembly.bdf:1:", "top.op4"])

    def test_matrices_of_another_boundary(self):
        text = self.read("top.pch")
        self.write("top.pch", re.sub(r"\b901\b(\s+)0", r"   \1 ", text, count=1))
        self.fails(1, "modes", "assembly.bdf", error="matrices.superelement-size", says=["top.pch:", "KXX"])
        self.write("top.pch", text)
        asm = self.read("top.asm")
        self.write("top.asm", re.sub(r"(GRID\s+13\s+0\s+)3\.", r"\g<1>4.", asm))
        self.fails(1, "modes", "assembly.bdf", error="fe.superelement-boundary", says=["grid 13", "away"])
        self.write("top.asm", re.sub(r"SPOINT\s+901.*\n", "", asm, count=1))
        self.fails(1, "modes", "assembly.bdf", error="fe.superelement-boundary", says=["901"])

    def test_what_is_not_read(self):
        asm = self.read("top.asm")
        self.write("top.asm", asm.replace("EXTOP4", "MIRROR"))
        self.fails(1, "modes", "assembly.bdf", error="matrices.superelement-type", says=["top.asm:", "MIRROR"])
        self.write("top.asm", asm)
        text = self.read("top.pch")
        self.write("top.pch", re.sub(r"(TYPE\s+ID\s+COMP\s+ROW\s*\n\+\s+1\s+3\s+)6", r"\g<1>5", text, count=1))
        self.assertNotEqual(self.read("top.pch"), text)
        self.bough("modes", "assembly.bdf")  # a gap in the rows is none of a wrong number
        self.write("top.pch", re.sub(r"(DTI\s+TUG1\s+2.*?)(\d+)(\s+ENDREC)", r"\g<1>99\3", text, count=1, flags=re.S))
        self.fails(1, "modes", "assembly.bdf", error="matrices.superelement-rows", says=["TUG1"])

    def test_signs_of_a_bad_component(self):
        """Matrices of another: coupled in K, and a mass with a negative direction."""
        own = self.read_op4()
        K, M, n = own["KXX"].copy(), own["MXX"].copy(), len(own["KXX"])
        K[0, 12] = K[12, 0] = .01 * np.sqrt(K[0, 0] * K[12, 12])
        M[0, 1] = M[1, 0] = 3 * np.sqrt(M[0, 0] * M[1, 1])
        with open(self.path("top.op4"), "w") as f:
            for name, A in (("KXX", K), ("MXX", M)):
                f.write(f"{n:8d}{n:8d}{6:8d}{2:8d}{name:8s}1P,3E23.16\n")
                for j in range(n):
                    f.write(f"{j + 1:8d}{1:8d}{n:8d}\n")
                    for first in range(0, n, 3):
                        f.write("".join(f"{v:23.16E}" for v in A[first:first + 3, j]) + "\n")
                f.write(f"{n + 1:8d}{1:8d}{1:8d}\n{1.0:23.16E}\n")
        result = self.bough("check", "assembly.bdf")
        self.assertIn("[fe.superelement-coupled]", result.stderr)
        self.assertIn("[fe.superelement-mass]", result.stderr)

    def test_too_few_points(self):
        self.write("top.bdf", COMPONENT.replace("901,THRU,960", "901,THRU,904"))
        result = self.bough("export", "top.bdf", "--to", "extseout", "-o", "top")
        self.assertIn("[export.component-points]", result.stderr)
        self.assertIn("4 generalized coordinates", result.stdout + result.stderr)

    def test_what_cannot_be_a_component(self):
        for change, error in (((r"BSET1,123456", "BSET1,123"), "export.component-boundary"),
                              ((r"BSET1.*\n", ""), "export.component-boundary"),
                              ((r"BSET1", "CSET1"), "export.component-boundary"),
                              ((r"ENDDATA", "SPC1,1,1,3\nENDDATA"), None)):
            text = re.sub(*change, COMPONENT)
            self.write("top.bdf", text.replace("METHOD=1", "METHOD=1\nSPC=1") if error is None else text)
            self.fails(1, "export", "top.bdf", "--to", "extseout", "-o", "t", error=error or "modal.held-boundary")


@unittest.skipUnless(os.path.isdir(os.path.join(SHARED, "extseout")), f"no models at {SHARED}")
class Vendor(ProgramTest):
    """Two stages of a spacecraft, NX 9: whole, as external superelements, and as components of ours."""

    def setUp(self):
        super().setUp()
        for name in os.listdir(os.path.join(SHARED, "extseout")):
            shutil.copy(os.path.join(SHARED, "extseout", name), self.folder)
            os.chmod(self.path(name), 0o644)

    def find_modes(self, deck):
        self.bough("modes", deck, "-o", "m.h5")
        with h5py.File(self.path("m.h5")) as f:
            hz = f["modes/frequency_hz"][:]
        return hz[hz > .01]

    def test_assembled(self):
        printed = read_printed_frequencies(self.path("assemble.out"))
        self.assertEqual(len(printed), 54)
        found = self.find_modes("assemble.dat")
        np.testing.assert_allclose(found[:48], printed[6:], rtol=5e-6)

    def test_own_components(self):
        for name in ("inboard", "outboard"):
            result = self.bough("export", name + ".dat", "--to", "extseout", "-o", name)
        self.assertIn("[export.component-tie]", result.stderr)
        # Grid 70 of the residual structure is in the system 10 that the vendor's .asm files have.
        self.write("assemble.dat", self.read("assemble.dat").replace(
            "grid,70", "CORD2R,10,0,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\ngrid,70"))
        printed = read_printed_frequencies(self.path("assemble.out"))[6:]
        found = self.find_modes("assemble.dat")
        whole = self.find_modes("full.dat")
        count = np.sum(printed < 50)
        np.testing.assert_allclose(found[:count], printed[:count], rtol=5e-6)
        printed = read_printed_frequencies(self.path("full.out"))[6:]
        np.testing.assert_allclose(whole[:count], printed[:count], rtol=5e-6)

    def test_loads_of_the_component(self):
        """SELOAD of load 1101, two forces inside the inboard stage, against the forces on the whole model."""
        control = "SOL 101\nCEND\nSPC=1\nLOAD=5\nBEGIN BULK\nPARAM,AUTOSPC,YES\nSPC1,1,123456,3\n"
        bulk = self.read("full.dat").split("BEGIN BULK")[1]
        forces = "FORCE,5,13,0,1.,1.5,-1.5,2.\nFORCE,5,21,0,1.,-1.5,10.,-2.\n"
        self.write("whole.dat", control + forces + bulk)
        parts = ("ASSIGN INPUTT4='outboard.op4',UNIT=101\nASSIGN INPUTT4='inboard.op4',UNIT=102\n" + control +
                 "SELOAD,5,102,1101\nINCLUDE 'outboard.asm'\nINCLUDE 'inboard.asm'\nINCLUDE 'outboard.pch'\n"
                 "INCLUDE 'inboard.pch'\nENDDATA\n")
        self.write("parts.dat", parts)
        found = []
        for name in ("whole", "parts"):
            self.bough("static", name + ".dat", "-o", name + ".h5")
            with h5py.File(self.path(name + ".h5")) as f:
                group = f["subcases"][sorted(f["subcases"])[0]]
                found.append({tuple(map(int, dof)): u for dof, u in zip(f["dof_map"][:], group["displacement"][:])})
        largest = max(abs(found[0][(g, c)]) for g in (11, 19, 27) for c in (1, 2, 3))
        for g in (11, 19, 27):
            for c in range(1, 7):
                self.assertAlmostEqual(found[0][(g, c)], found[1][(g, c)], delta=1e-6 * largest)
        self.write("parts.dat", parts.replace("102,1101", "102,7"))
        self.fails(1, "static", "parts.dat", error="fe.superelement-load", says=["load 7"])

    def test_check(self):
        data = json.loads(self.bough("check", "assemble.dat", "--json").stdout)
        held = {one["id"]: one["held_hz"] for one in data["superelements"]}
        np.testing.assert_allclose(held[101][:6], [1.650001, 1.650249, 1.674265, 1.674687, 7.025350, 7.025411], rtol=1e-6)
        np.testing.assert_allclose(held[102][:3], [6.129345, 6.130134, 23.63188], rtol=1e-6)


@unittest.skipUnless(os.path.isdir(os.path.join(SHARED, "se_static")), f"no models at {SHARED}")
class Static(ProgramTest):
    def test_ten_cases(self):
        """External work of each case, MSC 2017; gravity does not act on the external superelement."""
        folder = os.path.join(SHARED, "se_static")
        deck = os.path.join(folder, "se_test_n11_static_10_cases.bdf")
        printed = {}
        for words in list_words_below(deck.replace(".bdf", ".f06"), "LOAD SEQ. NO."):
            if len(words) != 3 or not words[0].isdigit():
                break
            printed[int(words[0])] = float(words[2])
        self.assertEqual(len(printed), 10)
        result = self.bough("static", deck, "--json", "-o", "s.h5")
        self.assertIn("[fe.superelement-gravity]", result.stderr)
        with h5py.File(self.path("s.h5")) as f:
            subcases = sorted(f["subcases"], key=lambda n: int(re.sub(r"\D", "", n)))
            self.assertEqual(len(subcases), 10)
            for k, name in enumerate(subcases, 1):
                group = f["subcases"][name]
                work = .5 * float(np.sum(group["displacement"][:] * group["load"][:])) if "load" in group else None
                self.assertIsNotNone(work, list(group))
                self.assertAlmostEqual(work, printed[k], delta=2e-7 * max(printed.values()))


if __name__ == "__main__":
    unittest.main()
