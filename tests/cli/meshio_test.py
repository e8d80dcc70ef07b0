"""meshio, which shares no line with Bough, reads the .vtu files and the decks that Bough writes."""
import glob
import os
import unittest

import h5py
import meshio
import numpy as np

from support import BEAM, HANG, PROGRAM, SOURCE, ProgramTest, served
from toml_text import section, toml

SHARED = os.environ.get("BOUGH_SHARED_DIR", "")
TYPES = {"vertex": "vertex", "line2": "line", "tri3": "triangle", "quad4": "quad", "tetra4": "tetra", "penta6": "wedge",
         "hexa8": "hexahedron"}
COUNTED = {"CBAR": "line", "CBEAM": "line", "CBUSH": "line", "CROD": "line", "CTRIA3": "triangle", "CQUAD4": "quad",
           "CTETRA": "tetra", "CPENTA": "wedge", "CHEXA": "hexahedron"}

# Two bars with a lumped mass; a pin-ended rod across.
MIXED = BEAM.replace("ENDDATA", "CONM2,9,3,,0.1,,,,,+\n+,0.01,,0.01,,,0.01\nPROD,4,1,1.-4,1.-8\nCROD,7,4,1,3\nENDDATA")
SHAPES = """SOL 103
CEND
SPC = 1
BEGIN BULK
SPC1,1,123456,1,2,3,4
MAT1,1,7.+10,,.3,2700.
PBAR,1,1,1.-4,1.-8,1.-8,1.-8
PSHELL,2,1,.01,1,,1
PSOLID,3,1
GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,1.,1.,0.
GRID,4,,0.,1.,0.
GRID,5,,0.,0.,1.
GRID,6,,1.,0.,1.
GRID,7,,1.,1.,1.
GRID,8,,0.,1.,1.
GRID,9,,2.,0.,0.
GRID,10,,2.,0.,1.
GRID,11,,0.,0.,2.
GRID,12,,.5,0.,1.
GRID,13,,.5,.5,1.
GRID,14,,0.,.5,1.
GRID,15,,0.,0.,1.5
GRID,16,,.5,0.,1.5
GRID,17,,0.,.5,1.5
CBAR,1,1,11,5,1.,0.,0.
CQUAD4,2,2,5,6,7,8
CTRIA3,3,2,2,9,10
CHEXA,4,3,1,2,3,4,5,6,+
+,7,8
CPENTA,5,3,2,9,3,6,10,7
CTETRA,6,3,5,6,8,11,12,13,+
+,14,15,16,17
ENDDATA
"""
BODY = toml(
    section("body", name="beam", deck="beam.bdf"),
    section("body.modes", number=2),
    section("body.output", nodes=[1, 3]))


def count_cells(mesh):
    counts = {}
    for block in mesh.cells:
        counts[block.type] = counts.get(block.type, 0) + len(block.data)
    return counts


class Vtu(ProgramTest):
    def compare(self, mesh, file, phi, names):
        """Points, cells and shapes of the mesh against the HDF5 file they come from, bit for bit."""
        np.testing.assert_array_equal(mesh.points, file["mesh/grid_xyz"][:])
        np.testing.assert_array_equal(mesh.point_data["grid_id"].ravel(), file["mesh/grid_id"][:])
        cells = {}
        for block, ids in zip(mesh.cells, mesh.cell_data["element_id"]):
            for nodes, number in zip(block.data, np.ravel(ids)):
                cells.setdefault(block.type, []).append((int(number), tuple(nodes)))
        expected = {}
        for group in file["mesh/elements"].values():
            name = group.attrs["type"]
            kind = TYPES[name.decode() if isinstance(name, bytes) else name]
            for number, nodes in zip(group["id"][:], group["connectivity"][:]):
                expected.setdefault(kind, []).append((int(number), tuple(nodes)))
        self.assertEqual({k: sorted(v) for k, v in cells.items()}, {k: sorted(v) for k, v in expected.items()})
        self.assertGreater(sum(map(len, cells.values())), 0)
        shapes = [name for name in mesh.point_data if name != "grid_id"]
        self.assertEqual(shapes, [name + suffix for name in names for suffix in ("", "_rotation")])
        for j, name in enumerate(names):
            np.testing.assert_array_equal(mesh.point_data[name], phi[:, 0:3, j])
            np.testing.assert_array_equal(mesh.point_data[name + "_rotation"], phi[:, 3:6, j])

    def test_modes(self):
        self.write("beam.bdf", MIXED)
        self.bough("modes", "beam.bdf", "-o", "m.h5", "--vtu", "m.vtu", "-q")
        self.bough("export", "m.h5", "--to", "vtu", "-o", "again.vtu")
        self.bough("export", "m.h5", "--to", "vtu", "--ascii", "-o", "ascii.vtu")
        with h5py.File(self.path("m.h5")) as file:
            frequency = file["modes/frequency_hz"][:]
            names = [f"mode_{j + 1:03d}_{f:.4g}Hz" for j, f in enumerate(frequency)]
            np.testing.assert_array_equal(file["nodes/id"][:], file["mesh/grid_id"][:])
            for name in ["m.vtu", "again.vtu", "ascii.vtu"]:
                with self.subTest(name):
                    self.compare(meshio.read(self.path(name)), file, file["modes/phi"][:], names)
        with open(self.path("m.vtu")) as one, open(self.path("again.vtu")) as other:
            self.assertEqual(one.read(), other.read())

    def test_to_stdout(self):
        self.write("beam.bdf", MIXED)
        self.bough("modes", "beam.bdf", "-o", "m.h5", "-q")
        self.assertIn('<VTKFile type="UnstructuredGrid"', self.bough("export", "m.h5", "--to", "vtu").stdout)

    def test_flexible_body(self):
        self.write("beam.bdf", MIXED)
        self.bough("reduce", "beam.bdf", "--modes", "2", "-o", "b.h5", "-q")
        self.bough("export", "b.h5", "--to", "vtu", "-o", "b.vtu")
        with h5py.File(self.path("b.h5")) as file:
            names = [f"mode_{j + 1:03d}_{f:.4g}Hz" for j, f in enumerate(file["modes/frequency_hz"][:])]
            self.compare(meshio.read(self.path("b.vtu")), file, file["modes/phi"][:], names)

    def test_body_with_few_output_nodes(self):
        self.write("beam.bdf", MIXED)
        self.write("body.toml", BODY)
        self.bough("reduce", "body.toml", "-o", "few.h5", "-q")
        # Display shapes of all grids, in single precision.
        self.assertEqual(self.bough("export", "few.h5", "--to", "vtu", "-o", "drawn.vtu").stderr, "")
        drawn = meshio.read(self.path("drawn.vtu"))
        # Files of older versions have shapes of the output nodes only.
        with h5py.File(self.path("few.h5"), "r+") as file:
            del file["mesh/phi"]
        said = self.bough("export", "few.h5", "--to", "vtu", "-o", "few.vtu").stderr
        self.assertIn("2 of 3 grids", said)
        self.assertIn("[export.partial-shapes]", said)
        mesh = meshio.read(self.path("few.vtu"))
        self.assertEqual(list(mesh.point_data["grid_id"].ravel()), [1, 3])
        # The bars end at the grid in the middle; the rod and the mass are whole.
        self.assertEqual(count_cells(mesh), {"line": 1, "vertex": 1})
        with h5py.File(self.path("few.h5")) as file:
            name = [n for n in mesh.point_data if n.startswith("mode_002") and not n.endswith("rotation")]
            np.testing.assert_array_equal(mesh.point_data[name[0]], file["modes/phi"][:, 0:3, 1])
        # With all dofs in the file every grid is drawn, with the values that the output nodes have.
        self.bough("reduce", "body.toml", "--full", "-o", "full.h5", "-q")
        self.assertEqual(self.bough("export", "full.h5", "--to", "vtu", "-o", "full.vtu").stderr, "")
        full = meshio.read(self.path("full.vtu"))
        self.assertEqual(len(full.points), 3)
        np.testing.assert_allclose(full.point_data[name[0]][[0, 2]], mesh.point_data[name[0]], rtol=1e-12, atol=1e-14)
        self.assertGreater(np.abs(full.point_data[name[0]][1]).max(), 0)
        np.testing.assert_allclose(drawn.point_data[name[0]], full.point_data[name[0]], rtol=1e-6, atol=1e-6)

    def test_buckling(self):
        lines = ["SOL 105", "CEND", "SPC = 1", "SUBCASE 1", "LOAD = 4", "SUBCASE 2", "METHOD = 5", "BEGIN BULK",
                 "EIGRL,5,,,2", "SPC1,1,123456,1", "FORCE,4,9,,1.,-1.,0.,0.", "PBAR,1,1,1.-3,1.-8,2.-8,1.-8",
                 "MAT1,1,7.+10,,.3,2700."]
        lines += [f"GRID,{i + 1},,{0.25 * i},0.,0." for i in range(9)]
        lines += [f"CBAR,{i + 1},1,{i + 1},{i + 2},0.,1.,0." for i in range(8)]
        self.write("column.bdf", "\n".join(lines + ["ENDDATA", ""]))
        self.bough("modes", "column.bdf", "--buckling", "-o", "c.h5", "--vtu", "c.vtu", "-q")
        self.bough("export", "c.h5", "--to", "vtu", "-o", "again.vtu")
        with h5py.File(self.path("c.h5")) as file:
            names = [f"buckling_{j + 1:03d}_factor_{f:.4g}" for j, f in enumerate(file["buckling/load_factor"][:])]
            self.assertEqual(len(names), 2)
            for name in ["c.vtu", "again.vtu"]:
                self.compare(meshio.read(self.path(name)), file, file["modes/phi"][:], names)

    def test_a_file_without_shapes(self):
        with h5py.File(self.path("other.h5"), "w") as file:
            file.attrs["format"] = "bough-results"
        self.fails(1, "export", "other.h5", "--to", "vtu", says=["bough-results"], error="cli.no-shapes")


class Deck(ProgramTest):
    def read_original(self, path):
        """None when meshio cannot: INCLUDE, replication, no BEGIN BULK, blank coordinates, a theta behind the grids."""
        try:
            return meshio.read(path, file_format="nastran")
        except BaseException:  # it calls sys.exit for some files
            return None

    def check(self, path):
        """Ours and meshio's count of the deck written again; returns whether meshio could read the original too."""
        ignore, first = [], self.run_export(path, "large.bdf")
        if first.returncode != 0:  # cards of a kind that Bough does not read
            if "[deck.unsupported-section]" in first.stderr or "[deck.include-missing]" in first.stderr:
                return False  # superelements in sections of their own; a part of another deck
            if "error: SEBULK cannot be written" in first.stderr:
                return False  # an external superelement, whose matrices are in other files
            cards = sorted({line.split(": error: ")[1].split(" ")[0] for line in first.stderr.splitlines()
                            if "[deck.unsupported-card]" in line})
            self.assertTrue(cards, first.stderr)
            ignore = [word for card in cards for word in ("--ignore", card)]
            self.assertEqual(self.run_export(path, "large.bdf", *ignore).returncode, 0)
        self.assertEqual(self.run_export(path, "free.bdf", "--fields", "free", *ignore).returncode, 0)
        large, free = (meshio.read(self.path(name), file_format="nastran") for name in ("large.bdf", "free.bdf"))
        counts = self.count_cards(self.path("free.bdf"))
        self.assertEqual(self.count_cards(self.path("large.bdf")), counts)
        self.assertEqual(len(free.points), counts["GRID"])
        self.assertEqual(self.count_known_cells(free), self.expect_cells(counts))
        # GRID* is the only card in 16 columns that meshio supports.
        narrow = self.count_cards(self.path("large.bdf"), large=False)
        self.assertEqual(self.count_known_cells(large), self.expect_cells(narrow))
        np.testing.assert_array_equal(large.points_id, free.points_id)
        np.testing.assert_allclose(large.points, free.points, rtol=1e-10, atol=0)
        with open(path, errors="replace") as f:
            is_whole = "INCLUDE" not in f.read().upper()
        original = self.read_original(path) if is_whole and not ignore else None
        if original is None:
            return False
        np.testing.assert_array_equal(original.points_id, free.points_id)
        np.testing.assert_array_equal(original.points, free.points)
        self.assertEqual(self.count_known_cells(original), self.count_known_cells(large))
        return True

    def run_export(self, path, name, *options):
        return served.run([PROGRAM, "export", path, "--to", "bdf", "-o", name, *options], cwd=self.folder, timeout=HANG)

    def count_known_cells(self, mesh):
        return {kind: n for kind, n in count_cells(mesh).items() if kind != "vertex"}  # CELAS1

    def expect_cells(self, counts):
        cells = {}
        for card, kind in COUNTED.items():
            if counts.get(card, 0):
                cells[kind] = cells.get(kind, 0) + counts[card]
        return cells

    def count_cards(self, path, large=True):
        counts = {}
        with open(path) as f:
            for line in f.read().split("BEGIN BULK\n")[1].splitlines():
                name = line[:8].split(",")[0].rstrip(" *")
                if name and name[0].isalpha() and (large or "*" not in line[:8]):
                    counts[name] = counts.get(name, 0) + 1
        return counts

    def test_own_decks(self):
        decks = sorted(glob.glob(os.path.join(SOURCE, "data/examples/*/*.bdf")))
        self.assertGreaterEqual(len(decks), 4)
        for path in decks:
            with self.subTest(path):
                self.check(path)

    def test_coordinates_are_ours(self):
        self.write("beam.bdf", MIXED.replace("GRID,2,,1.,0.,0.", "GRID,2,,1.0123456789012,.333333333333333,1.-13"))
        self.bough("export", "beam.bdf", "--to", "bdf", "-o", "new.bdf")
        self.bough("modes", "beam.bdf", "-n", "1", "--vtu", "m.vtu", "-q")
        deck, ours = meshio.read(self.path("new.bdf"), file_format="nastran"), meshio.read(self.path("m.vtu"))
        np.testing.assert_array_equal(deck.points_id, ours.point_data["grid_id"].ravel())
        np.testing.assert_allclose(deck.points, ours.points, rtol=1e-11, atol=0)
        self.assertEqual(count_cells(deck), {"line": 3})

    def test_every_shape_of_element(self):
        """One bar, shell and solid of each kind: the picture and the deck agree, nodes in their order."""
        self.write("solids.bdf", SHAPES)
        self.bough("export", "solids.bdf", "--to", "bdf", "-o", "new.bdf")
        self.bough("modes", "solids.bdf", "-n", "2", "--vtu", "m.vtu", "-q")
        deck, ours = meshio.read(self.path("new.bdf"), file_format="nastran"), meshio.read(self.path("m.vtu"))
        np.testing.assert_array_equal(deck.points, ours.points)
        cells, drawn = ({block.type: block.data.tolist() for block in mesh.cells} for mesh in (deck, ours))
        self.assertEqual(sorted(cells), ["hexahedron", "line", "quad", "tetra10", "triangle", "wedge"])
        cells["tetra"] = [cells.pop("tetra10")[0][:4]]  # a picture shows the corners
        self.assertEqual(cells, drawn)

    def test_strain_energy_density(self):
        """Energies of /energies over lengths, areas and volumes known by hand."""
        extent = {1: 1.0, 2: 1.0, 3: 0.5, 4: 1.0, 5: 0.5, 6: 1 / 6}
        self.write("solids.bdf", SHAPES)
        self.bough("modes", "solids.bdf", "-n", "2", "--ese", "-o", "m.h5", "--vtu", "m.vtu", "-q")
        mesh = meshio.read(self.path("m.vtu"))
        with h5py.File(self.path("m.h5")) as f:
            ids, strain, hertz = f["energies/id"][:], f["energies/strain"][:], f["modes/frequency_hz"][:]
        for j in range(2):
            wanted = {i: strain[e, j] / extent[i] for e, i in enumerate(ids)}
            self.assertGreater(max(wanted.values()), 0)
            name = f"mode_{j + 1:03d}_{hertz[j]:.4g}Hz_strain_energy_density"
            found = {i: v for block, numbers in zip(mesh.cell_data[name], mesh.cell_data["element_id"])
                     for i, v in zip(np.ravel(numbers), np.ravel(block))}
            self.assertEqual(sorted(found), sorted(extent))
            for i in extent:
                self.assertAlmostEqual(found[i], wanted[i], delta=1e-12 * max(wanted.values()))

    def test_fields(self):
        self.write("beam.bdf", MIXED.replace("GRID,2,,1.,0.,0.", "GRID,2,,1.01234567890123456,.1,.2"))
        expected = {"small": 1.012346, "large": 1.01234567890123, "free": 1.0123456789012346}
        for fields, x in expected.items():
            self.bough("export", "beam.bdf", "--to", "bdf", "--fields", fields, "-o", "new.bdf")
            deck = meshio.read(self.path("new.bdf"), file_format="nastran")
            self.assertEqual(deck.points[1, 0], x)
        self.fails(2, "export", "beam.bdf", "--to", "bdf", "--fields", "wide", error="cli.usage")

    def test_what_is_left_out_is_said(self):
        self.write("beam.bdf", MIXED.replace("ENDDATA", "TABLED1,70\nENDDATA"))
        said = self.bough("export", "beam.bdf", "--to", "bdf", "-o", "new.bdf").stderr
        for words in ("TABLED1", "[deck.left-out]"):
            self.assertIn(words, said)

    def test_shared_models(self):
        if not os.path.isdir(os.path.join(SHARED, "models")):
            self.skipTest("no real decks")
        read_twice = 0
        # The decks themselves; what they include has no control section.
        for path in sorted(glob.glob(os.path.join(SHARED, "models/*/*.*"))):
            with open(path, errors="replace") as f:
                if not path.endswith((".bdf", ".dat")) or "CEND" not in f.read():
                    continue
            with self.subTest(path):
                read_twice += self.check(path)
        self.assertGreaterEqual(read_twice, 3)


if __name__ == "__main__":
    unittest.main()
