"""export --to mat, op4, uff: read back by SciPy and by the readers of tests/oracle, against the HDF5 they come from."""
import os
import re
import sys
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.linalg
import scipy.sparse

from support import BEAM, SOURCE, ProgramTest

sys.path.insert(0, os.path.join(SOURCE, "tests/oracle"))
import op4_reader  # noqa: E402
import uff_reader  # noqa: E402

BODY = """[body]
name = "beam"
deck = "beam.bdf"
interface = [3]
[body.modes]
number = %d
[body.output]
nodes = [1, 3]
"""


def read_op4(path):
    """{name: (form, dense array)}; the oracle's numbers."""
    found = {}
    for name, form, kind, rows, columns, entries in op4_reader.read(path):
        assert kind == 2
        array = np.zeros((rows, columns))
        for (row, column), value in entries.items():
            array[row - 1, column - 1] = value.real
        found[name] = form, array
    return found


def load(path):
    return scipy.io.loadmat(path, squeeze_me=False)


def csr(group):
    return scipy.sparse.csr_matrix((group["data"][:], group["indices"][:], group["indptr"][:]), shape=group["shape"][:])


class Export(ProgramTest):
    def reduce(self, modes=2):
        self.write("beam.bdf", BEAM.replace("EIGRL,1", "CONM2,9,3,,0.1,,,,,+\n+,0.01,,0.01,,,0.01\nPARAM,COUPMASS,1\nEIGRL,1"))
        self.write("beam.toml", BODY % modes)
        self.bough("reduce", "beam.toml", "--full", "-o", "body.h5", "-q")

    def compare(self, variable, item, name):
        """An array of the file against the dataset; vectors are columns in MATLAB."""
        expected = item[()]
        if expected.dtype.kind == "O":
            self.assertEqual([v[0] for v in variable.ravel()], [v.decode() for v in expected], name)
            return
        if expected.ndim <= 1:
            expected = expected.reshape(-1, 1)
        np.testing.assert_array_equal(variable, expected, name)

    def test_body_to_mat(self):
        self.reduce()
        self.bough("export", "body.h5", "--to", "mat", "-o", "body.mat")
        m = load(self.path("body.mat"))
        self.assertNotIn("P", m)
        seen = 0
        with h5py.File(self.path("body.h5")) as f:
            for group in ["rigid", "nodes", "modes", "modal", "inertial_loads", "full", "grids", "stiffening"]:
                for name in f[group]:
                    if name == "locator":
                        continue
                    self.compare(m[group][0, 0][name], f[group][name], f"{group}/{name}")
                    seen += 1
            for name in ["name", "node", "direction"]:
                self.compare(m["stiffening"][0, 0]["locator"][0, 0][name], f["stiffening/locator"][name], name)
            self.assertEqual(m["integrals"][0, 0]["method"][0], f["integrals"].attrs["method"])
            for method in f["integrals"]:
                for name in f["integrals"][method]:
                    self.compare(m["integrals"][0, 0][method][0, 0][name], f["integrals"][method][name], name)
                    seen += 1
            self.compare(m["effective_mass"], f["effective_mass"], "effective_mass")
            self.compare(m["dof_map"], f["dof_map"], "dof_map")
        self.assertGreater(seen, 25)

    def test_kinds_of_modes(self):
        self.write("beam.bdf", BEAM)
        self.write("body.toml", (BODY % 2).replace("[body.output]", 'residual = ["interface"]\n[body.output]'))
        self.bough("reduce", "body.toml", "-o", "body.h5")
        self.bough("export", "body.h5", "--to", "mat", "-o", "body.mat")
        with h5py.File(self.path("body.h5")) as f:
            self.assertIn(b"residual", list(f["modes/kind"]))
            self.compare(load(self.path("body.mat"))["modes"][0, 0]["kind"], f["modes/kind"], "modes/kind")

    def test_body_to_op4(self):
        self.reduce()
        self.bough("export", "body.h5", "--to", "op4", "-o", "body.op4")
        o = read_op4(self.path("body.op4"))
        with h5py.File(self.path("body.h5")) as f:
            n = len(f["modes/eigenvalue"])
            initial = f["integrals"].attrs["method"][0].upper()
            integrals = f["integrals"][f["integrals"].attrs["method"]]
            stack = lambda a: a.reshape(-1, a.shape[-1])
            expected = dict(
                MASS=f["rigid/mass"][:].reshape(1, 1), CG=f["rigid/cg"][:][:, None], INERTIA=f["rigid/inertia"][:],
                NODES=np.column_stack([f["nodes/id"][:], f["nodes/xyz"][:]]), FREQ=f["modes/frequency_hz"][:][:, None],
                LAMBDA=f["modes/eigenvalue"][:][:, None], PHI=stack(f["modes/phi"][:]), MHH=f["modal/mass"][:],
                KHH=f["modal/stiffness"][:], BHH=f["modal/damping"][:], FI=f["inertial_loads/f"][:],
                EFFMASS=f["effective_mass"][:], DOFMAP=f["dof_map"][:], FULLPHI=f["full/phi"][:],
                FEXT=f["stiffening/external_load"][:], LOADRES=f["stiffening/load_resultant"][:],
                LOADMOM=stack(f["stiffening/load_moment"][:]),
                **{"GAMMA0" + initial: integrals["gamma0"][:].T, "GAMMA1" + initial: integrals["gamma1"][:].T,
                   "GAMMA2" + initial: stack(integrals["gamma2"][:].transpose(0, 2, 1)),
                   "GAMMA3" + initial: stack(integrals["gamma3"][:]),
                   "GAMMA4" + initial: integrals["gamma4"][:].transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)})
            for i, is_computed in enumerate(f["stiffening/computed"][:]):
                if is_computed:
                    expected[f"KGI{i + 1:02d}"] = f["stiffening/kg_inertial"][i]
            for e, K in enumerate(f["stiffening/kg_external"][:]):
                expected[f"KGE{e + 1:04d}"] = K
        for name, array in expected.items():
            np.testing.assert_array_equal(o[name][1], array, name)
        self.assertEqual(o["KHH"][0], 6)
        self.assertEqual(o["PHI"][0], 2)

    def test_symmetric_matrices_in_oblique_axes(self):
        """K and M of oblique displacement axes are symmetric but for round-off: form 6, by both commands; a random one is square."""
        skew = BEAM.replace("BEGIN BULK", "BEGIN BULK\nCORD2R,5,,.1,.2,.3,.7,-.4,1.1\n,1.9,.4,.2")
        skew = re.sub(r"(?m)^(GRID,[23],[^,]*,[^,]*,[^,]*,[^,\n]*).*$", r"\1,5", skew)
        self.assertEqual(len(re.findall(r"(?m)^GRID,.*,5$", skew)), 2)
        self.write("skew.bdf", skew)
        self.bough("matrices", "skew.bdf", "-o", "m.h5")
        self.bough("export", "m.h5", "--to", "op4", "-o", "m.op4")
        o = read_op4(self.path("m.op4"))
        stiffness = o[next(name for name in o if name.startswith("K"))]
        self.assertFalse((stiffness[1] == stiffness[1].T).all())
        for name, (form, array) in o.items():
            if array.shape[0] == array.shape[1]:
                self.assertEqual(form, 6, name)

    def test_frames_of_a_body_with_constraint_modes(self):
        self.reduce(11)
        # Six of the modes that move the tip one to one are as good as constraint modes: coordinates of its frame.
        with h5py.File(self.path("body.h5"), "r+") as f:
            tip = f["modes/phi"][1]
            chosen = scipy.linalg.qr(tip, pivoting=True)[2][:6]
            tip = tip[:, chosen]
            f["modes/kind"][:] = ["constraint" if j in chosen else "normal" for j in range(11)]
            mass, cg, inertia = f["rigid/mass"][0], f["rigid/cg"][:], f["rigid/inertia"][:]
        self.assertEqual(np.linalg.matrix_rank(tip), 6)
        self.bough("export", "body.h5", "--to", "mat", "-o", "body.mat")
        self.bough("export", "body.h5", "--to", "op4", "-o", "body.op4")
        m, o = load(self.path("body.mat")), read_op4(self.path("body.op4"))
        np.testing.assert_array_equal(m["P"], [[0, 0, 0], [2, 0, 0]])
        np.testing.assert_array_equal(m["frame_node"], [[0], [3]])
        self.assertEqual(m["K"].shape, (17, 17))
        for name in "PKM":
            np.testing.assert_array_equal(o[name + "IF"][1], m[name])
        # Rigid motion of the frames: no stiffness, the mass of the body.
        skew = lambda a: np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
        R = np.vstack([np.block([[np.eye(3), -skew(p)], [np.zeros((3, 3)), np.eye(3)]]) for p in m["P"]])
        rigid = np.block([[mass * np.eye(3), -mass * skew(cg)], [mass * skew(cg), inertia]])
        R = np.vstack([R, np.zeros((5, 6))])
        self.assertLess(np.abs(m["K"] @ R).max(), 1e-9 * np.abs(m["K"]).max())
        np.testing.assert_allclose(R.T @ m["M"] @ R, rigid, atol=1e-9 * np.abs(rigid).max())
        with h5py.File(self.path("body.h5"), "r+") as f:
            f["modes/kind"][int(chosen[0])] = "normal"
        result = self.bough("export", "body.h5", "--to", "mat", "-o", "body.mat")
        self.assertIn("export.no-frames", result.stderr)
        self.assertNotIn("P", load(self.path("body.mat")))

    def test_frames_of_a_craig_bampton_body(self):
        self.reduce()
        for raw in ("true", "false"):
            self.write("cb.toml", (BODY % 3).replace(
                "number = 3", f'number = 3\nbasis = "craig-bampton"\northogonalize = {raw}'))
            self.bough("reduce", "cb.toml", "-o", "cb.h5", "-q")
            self.bough("export", "cb.h5", "--to", "mat", "-o", "cb.mat")
            m = load(self.path("cb.mat"))
            with h5py.File(self.path("cb.h5")) as f:
                own = scipy.linalg.eigh(f["modal/stiffness"][:], f["modal/mass"][:], eigvals_only=True)
                mass, cg, inertia = f["rigid/mass"][0], f["rigid/cg"][:], f["rigid/inertia"][:]
            self.assertEqual((m["K"].shape, len(own)), ((15, 15), 9))
            tip = m["P"][1]
            arm = np.array([[0, -tip[2], tip[1]], [tip[2], 0, -tip[0]], [-tip[1], tip[0], 0]])
            moment = mass * np.array([[0, -cg[2], cg[1]], [cg[2], 0, -cg[0]], [-cg[1], cg[0], 0]])
            R = np.vstack([np.eye(6), np.block([[np.eye(3), -arm], [np.zeros((3, 3)), np.eye(3)]]), np.zeros((3, 6))])
            rigid = np.block([[mass * np.eye(3), -moment], [moment, inertia]])
            self.assertLess(np.abs(m["K"] @ R).max(), 1e-9 * np.abs(m["K"]).max())
            np.testing.assert_allclose(R.T @ m["M"] @ R, rigid, atol=1e-9 * np.abs(rigid).max())
            # The root held: the body's own shapes and frequencies.
            held = scipy.linalg.eigh(m["K"][6:, 6:], m["M"][6:, 6:], eigvals_only=True)
            np.testing.assert_allclose(held, own, rtol=1e-8)

    def test_table_of_modes(self):
        self.write("beam.bdf", BEAM)
        self.bough("modes", "beam.bdf", "-o", "m.h5", "-q")
        self.bough("reduce", "beam.bdf", "--modes", "3", "-o", "b.h5", "-q")
        for name in ("m.h5", "b.h5"):
            lines = self.bough("export", name, "--to", "csv", "--channel", "modes").stdout.splitlines()
            self.assertEqual(lines[0], "mode,frequency_hz,eigenvalue,modal_mass," + ",".join(
                f"effective_mass_{d}" for d in ("x", "y", "z", "rx", "ry", "rz")))
            table = np.array([[float(v) for v in line.split(",")] for line in lines[1:]])
            with h5py.File(self.path(name)) as f:
                np.testing.assert_array_equal(table[:, 1], f["modes/frequency_hz"][:])
                np.testing.assert_array_equal(table[:, 4:], f["effective_mass"][:] + 0.0)
            np.testing.assert_array_equal(table[:, 0], [1, 2, 3])
            np.testing.assert_allclose(table[:, 3], 1, rtol=1e-9)
            self.fails(1, "export", name, "--to", "csv", "--channel", "tip", error="cli.unknown-channel")

    def test_modes(self):
        self.write("beam.bdf", BEAM)
        self.bough("modes", "beam.bdf", "-o", "m.h5", "-q")
        for to in ["mat", "op4", "uff"]:
            self.bough("export", "m.h5", "--to", to, "-o", "m." + to)
        m, o, u = load(self.path("m.mat")), read_op4(self.path("m.op4")), uff_reader.read(self.path("m.uff"))
        with h5py.File(self.path("m.h5")) as f:
            phi = f["modes/phi"][:]
            np.testing.assert_array_equal(m["modes"][0, 0]["phi"], phi)
            np.testing.assert_array_equal(o["PHI"][1], phi.reshape(-1, phi.shape[2]))
            np.testing.assert_array_equal(m["rigid"][0, 0]["mass_matrix"], f["rigid/mass_matrix"][:])
            shapes = [s for s in u if s["dataset"] == 55]
            self.assertEqual(len(shapes), phi.shape[2])
            for j, s in enumerate(shapes):
                np.testing.assert_allclose(s["shape"], phi[:, :, j], rtol=1e-5, atol=0)
                np.testing.assert_allclose(s["reals"][0], f["modes/frequency_hz"][j], rtol=1e-5)
        self.assertEqual([s["dataset"] for s in u[:2]], [15, 82])

    def test_matrices(self):
        self.write("beam.bdf", re.sub("METHOD = 1", "LOAD = 4", BEAM).replace("SOL 103", "SOL 101")
                   .replace("ENDDATA", "FORCE,4,3,,1.,1.,0.,0.\nENDDATA"))
        self.bough("matrices", "beam.bdf", "-o", "k.h5", "-q")
        for to in ["mat", "op4"]:
            self.bough("export", "k.h5", "--to", to, "-o", "k." + to)
        m, o = load(self.path("k.mat")), read_op4(self.path("k.op4"))
        with h5py.File(self.path("k.h5")) as f:
            for name in "KM":
                self.assertEqual(abs(m[name] - csr(f[name])).max(), 0)
                np.testing.assert_array_equal(o[name][1], csr(f[name]).toarray())
                self.assertEqual(o[name][0], 6)
            self.assertEqual(abs(m["KG"][0, 0]["LOAD_4"] - csr(f["KG/LOAD_4"])).max(), 0)
            np.testing.assert_array_equal(o["KG4"][1], csr(f["KG/LOAD_4"]).toarray())
            np.testing.assert_array_equal(m["dof_map"], f["dof_map"][:])
        self.fails(1, "export", "k.h5", "--to", "uff", error="cli.no-export")

    def test_results(self):
        self.copy_example("ex01-spinup")
        self.bough("reduce", "boom.toml", "-q")
        with open(self.path("spinup.toml")) as f:
            text = re.sub(r"(?m)^duration = [\d.]+( *#.*)?$(?!\n.*rad)", "duration = 0.5", f.read())
        self.write("short.toml", text)
        self.bough("run", "short.toml", "-o", "r.h5", "-q")
        self.bough("export", "r.h5", "--to", "mat", "-o", "r.mat")
        self.bough("export", "r.h5", "--to", "uff", "--channel", "tip_deflection", "-o", "r.uff")
        self.fails(1, "export", "r.h5", "--to", "csv", "--channel", "events", "--channel", "time", says=["alone"],
                   error="cli.unknown-channel")
        m, u = load(self.path("r.mat")), uff_reader.read(self.path("r.uff"))
        with h5py.File(self.path("r.h5")) as f:
            np.testing.assert_array_equal(m["time"].ravel(), f["time"][:])
            np.testing.assert_array_equal(m["bodies"][0, 0]["boom"][0, 0]["eta"], f["bodies/boom/eta"][:])
            self.assertEqual([s["name"] for s in u], ["sensors/tip_deflection:" + c for c in "xyz"])
            for j, s in enumerate(u):
                np.testing.assert_allclose(s["values"], f["sensors/tip_deflection"][:, j], rtol=1e-12, atol=0)
                np.testing.assert_allclose(s["time"], f["time"][:], rtol=1e-5)

    def test_responses_of_decks(self):
        """CSV as --csv writes it, functions as in the HDF5 file, and a page, of even and uneven samples."""
        for verb, sol, case, cards, abscissa, even in [
                ("frequency", 111, "FREQUENCY = 5", "FREQ1,5,1.,.5,20\nRLOAD1,9,10,,,3\nTABLED1,3,,,,,,,,+\n"
                 "+,0.,1.,100.,1.,ENDT", "frequency_hz", True),
                ("frequency", 111, "FREQUENCY = 5", "FREQ2,5,.5,20.,12\nRLOAD1,9,10,,,3\nTABLED1,3,,,,,,,,+\n"
                 "+,0.,1.,100.,1.,ENDT", "frequency_hz", False),
                ("transient", 112, "TSTEP = 5", "TSTEP,5,100,.01\nTLOAD1,9,10,,,3\nTABLED1,3,,,,,,,,+\n"
                 "+,0.,1.,100.,1.,ENDT", "time", True)]:
            with self.subTest(verb + cards):
                self.write("r.bdf", BEAM.replace("SOL 103", f"SOL {sol}").replace(
                    "METHOD = 1", f"METHOD = 1\n{case}\nDLOAD = 9\nSDAMPING = 6\nDISPLACEMENT = ALL").replace(
                    "ENDDATA", f"TABDMP1,6,CRIT,,,,,,,+\n+,0.,.02,1000.,.02,ENDT\nDAREA,10,3,3,1.\n{cards}\nENDDATA"))
                self.bough(verb, "r.bdf", "-o", "r.h5", "--csv", "r.csv", "-q")
                with open(self.path("r.csv")) as f:
                    self.assertEqual(self.bough("export", "r.h5", "--to", "csv").stdout, f.read())
                self.bough("export", "r.h5", "--to", "uff", "-o", "r.uff")
                functions = {f["name"]: f for f in uff_reader.read(self.path("r.uff"))}
                with h5py.File(self.path("r.h5")) as f:
                    (group,) = f["subcases"].values()
                    part = group["displacement"]
                    values = part["value"][:] if verb == "transient" else part["real"][:] + 1j * part["imag"][:]
                    for (grid, component), column in zip(part["dofs"][:], values.T):
                        found = functions[f"displacement:{grid}:{component}"]
                        np.testing.assert_allclose(found["values"], column, rtol=1e-12, atol=1e-300)
                        np.testing.assert_allclose(found["time"], group[abscissa][:], rtol=1e-12 if even else 1e-5)
                    largest = np.abs(values).max()
                self.assertGreater(largest, 0)
                self.bough("report", "r.h5", "-o", "r.html", "-q")
                with open(self.path("r.html")) as f:
                    page = f.read()
                self.assertIn(f"{verb} response", page)
                self.assertIn("displacement:3:3", page)
                self.assertIn(f"{largest:.6g}", page)

    def test_what_cannot_be_exported(self):
        self.write("beam.bdf", re.sub("METHOD = 1", "LOAD = 4", BEAM).replace("SOL 103", "SOL 101")
                   .replace("ENDDATA", "FORCE,4,3,,1.,1.,0.,0.\nENDDATA"))
        self.bough("static", "beam.bdf", "-o", "s.h5", "-q")
        for to in ["mat", "op4"]:
            self.fails(1, "export", "s.h5", "--to", to, "-o", "x", error="cli.no-export")
            self.assertFalse(os.path.exists(self.path("x")))
        self.fails(2, "export", "s.h5", "--to", "mat", error="cli.usage")
        self.fails(1, "export", "beam.bdf", "--to", "mat", "-o", "x", error="hdf5.not-hdf5")


if __name__ == "__main__":
    unittest.main()
