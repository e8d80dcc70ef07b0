#!/usr/bin/env python3
"""Writes the seeds of the corpora: one small file of each kind, most of them by the program itself.

usage: make_seeds.py PROGRAM [CORPUS]

What fuzzing found is kept beside them under the hash that libFuzzer gave it.
"""
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(ROOT, "tests/support"))
from toml_text import section, table, toml  # noqa: E402

DECK = """SOL 103
CEND
METHOD = 1
BEGIN BULK
EIGRL,1,,,2
GRID,1,,0.,0.,0.,,123456
GRID,2,,1.,0.,0.
CBAR,1,1,1,2,0.,0.,1.
PBAR,1,1,1.,2.,3.,4.
MAT1,1,1.+4,,.3,1.
ENDDATA
"""
STATIC = DECK.replace("SOL 103", "SOL 101").replace("METHOD = 1", "LOAD = 7").replace("EIGRL,1,,,2", "FORCE,7,2,,1.,0.,1.,0.")
SINES = DECK.replace("SOL 103", "SOL 111").replace("METHOD = 1", "METHOD = 1\nDLOAD = 5\nFREQ = 6\nDISP(PHASE) = ALL").replace(
    "EIGRL,1,,,2", "EIGRL,1,,,2\nFREQ1,6,1.,1.,2\nRLOAD1,5,7,,,8\nTABLED1,8,,,,,,,,+\n+,0.,1.,9.,1.,ENDT\nDAREA,7,2,2,1.")
BODY = toml(
    section("body", name="rod", deck="rod.bdf"),
    section("body.modes", number=2),
    section("body.output", nodes=[2]))
SYSTEM = toml(
    table("body", "rod", file="rod.h5"),
    table("body", "ball", mass=1.0, inertia=[1.0, 1.0, 1.0], nodes=[{"id": 1, "position": [1.0, 0.0, 0.0]}]),
    table("hinge", "root", "revolute", parent="ground", child="rod", axis=[0.0, 0.0, 1.0], rate=[0.1]),
    table("hinge", "free", "free", parent="ground", child="ball"),
    table("sensor", "tip", "position", body="rod", node=2),
    section("simulation", duration=0.02, output_step=0.01))
PUSH = toml(
    table("function", "push", "constant", value=0.0),
    table("force", "push", body="ball", node=1, force=[0.0, 1.0, 0.0], function="push"))


def shrink(path):
    """Copies the file with chunks no larger than their contents."""
    import h5py

    def copy(source, target):
        for key, value in source.attrs.items():
            target.attrs[key] = value
        for name, item in source.items():
            if isinstance(item, h5py.Group):
                copy(item, target.create_group(name))
            else:
                extendible = item.maxshape and None in item.maxshape and item.size
                made = target.create_dataset(name, data=item[()], dtype=item.dtype,
                                             **({"maxshape": item.maxshape, "chunks": item.shape} if extendible else {}))
                for key, value in item.attrs.items():
                    made.attrs[key] = value

    with h5py.File(path) as source, h5py.File(path + ".small", "w") as target:
        copy(source, target)
    os.replace(path + ".small", path)


def make_op4():
    """A 2 x 2 matrix of OUTPUT4 as Fortran writes it: a header, a column a record, one after the last."""
    records = [struct.pack("=4i8s", 2, 2, 6, 2, b"K       "), struct.pack("=3i2d", 1, 1, 4, 2.5, -1.0),
               struct.pack("=3i2d", 2, 1, 4, -1.0, 3.0), struct.pack("=3id", 3, 1, 2, 1.0)]
    return b"".join(struct.pack("=i", len(r)) + r + struct.pack("=i", len(r)) for r in records)


def main():
    program = os.path.abspath(sys.argv[1])
    corpus = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else os.path.join(HERE, "corpus")
    folder = tempfile.mkdtemp()

    def put(target, name, source):
        os.makedirs(os.path.join(corpus, target), exist_ok=True)
        shutil.copyfile(source, os.path.join(corpus, target, name))

    def write(name, text):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as out:
            out.write(text)
        return os.path.join(folder, name)

    def run(*args):
        subprocess.run([program, *args, "-q"], cwd=folder, check=True)

    def data(*parts):
        return os.path.join(ROOT, "data", *parts)

    put("nastran", "rod", write("rod.bdf", DECK))
    with open(os.path.join(ROOT, "tests", "formats", "nastran", "every_card.hpp"), encoding="utf-8") as header:
        cards = re.search(r'R"\((.*?)\)"', header.read(), re.S).group(1)
    put("nastran", "every-card", write("every-card.bdf", cards))
    put("nastran", "small-field", data("decks", "rotating.bdf"))
    for reader in ("packed-deck", "deck-editor"):
        put(reader, "rod", os.path.join(folder, "rod.bdf"))
    put("deck-editor", "small-field", data("decks", "rotating.bdf"))
    put("body", "rod", write("rod.toml", BODY))
    put("key-editor", "rod", os.path.join(folder, "rod.toml"))
    put("key-editor", "system", write("system.toml", SYSTEM))
    put("table", "columns", write("columns.csv", 'time,"x y";force # N\n0.0,1.0;2.0\n0.5,1.5;-2.0e1\n1.0\t2.0 0.0\n'))
    put("table", "pairs", write("pairs", "0 1\n1 2.5\n# end\n2 -1e3\n"))
    put("body", "boom", data("examples", "ex01-spinup", "boom.toml"))
    put("system", "rod", write("system.toml", SYSTEM))
    put("system", "four-bar", data("examples", "ex07-four-bar", "four-bar.toml"))
    put("campaign", "booms", data("examples", "ex06-campaign", "campaign.toml"))

    run("reduce", "rod.toml", "-o", "rod.h5")
    run("modes", "rod.bdf", "-o", "modes.h5")
    run("matrices", "rod.bdf", "-o", "matrices.h5")
    run("run", "system.toml", "-o", "results.h5")
    run("linearize", "system.toml", "-o", "linear.h5")
    run("compare", "rod.h5", "rod.h5", "-o", "comparison.h5")
    write("load.bdf", STATIC)
    write("sines.bdf", SINES)
    run("static", "load.bdf", "-o", "static.h5")
    run("frequency", "sines.bdf", "-o", "frequency.h5")
    write("push.toml", SYSTEM.replace("[simulation]", PUSH + "[simulation]"))
    run("linearize", "push.toml", "-o", "push.h5")
    run("response", "push.h5", "--from", "1", "--to", "2", "--points", "4", "-o", "response.h5")
    write("sweep.toml", "[parameters]\nspin = 0.1\n" + SYSTEM.replace("rate = [0.1]", 'rate = ["$spin"]'))
    run("linearize", "sweep.toml", "--sweep", "spin=0:1:2", "-o", "sweep.h5")
    shrink(os.path.join(folder, "results.h5"))
    for name in ("rod", "modes", "matrices", "results", "linear", "comparison", "static", "frequency", "response", "sweep"):
        put("hdf5", name, os.path.join(folder, name + ".h5"))

    run("matrices", "rod.bdf", "--to", "op4", "-o", "matrices.op4")
    run("matrices", "rod.bdf", "--to", "mtx", "-o", "matrices.mtx")
    for name in sorted(os.listdir(folder)):
        if name.endswith(".op4"):
            put("op4-text", name, os.path.join(folder, name))
        if name.endswith(".mtx"):
            put("matrices", name, os.path.join(folder, name))
    with open(os.path.join(folder, "binary.op4"), "wb") as out:
        out.write(make_op4())
    put("op4-binary", "two", os.path.join(folder, "binary.op4"))
    run("export", "rod.h5", "--to", "mat", "-o", "rod.mat")
    put("matrices", "mat", os.path.join(folder, "rod.mat"))
    put("matrices", "dmig", write("dmig", "DMIG,K,0,6,2,0\nDMIG,K,1,1,,1,1,2.5D0\n,1,2,-1.\nDMIG,K,1,2,,1,2,3.\n"))
    put("matrices", "triplets", write("triplets", "1 1 2.5\n2 1 -1.\n2 2 3.\n"))
    put("matrices", "labels", write("labels", "1,1,1,1,2.5\n1,2,1,1,-1.\n1,2,1,2,3.\n"))
    modes = os.path.join(ROOT, "tests", "oracle", "nastran_modes_writer.py")
    for kind, options in (("op2", []), ("op2", ["-big"]), ("op2", ["-wide"]), ("punch", [])):
        path = os.path.join(folder, "table")
        subprocess.run([sys.executable, modes, kind, path, *options], check=True)
        put("mode-tables", kind + "".join(options), path)

    run("flx", "rod.h5", "-o", "rod.flx")
    put("flx", "rod", os.path.join(folder, "rod.flx"))
    run("export", "rod.h5", "--to", "flat", "-o", "rod.flat")
    put("flat", "rod", os.path.join(folder, "rod.flat"))
    put("layout", "columns", data("integrals", "columns.layout"))
    put("layout", "diagonals", data("integrals", "diagonals.layout"))
    run("export", "rod.h5", "--to", "sid", "-o", "rod.sid")
    put("sid", "rod", os.path.join(folder, "rod.sid"))
    put("model-input", "test", data("integrals", "test.inp"))
    put("model-matrices", "two-dofs", write("two.mat", "1. 0.\n0. 1.\n2. -1.\n-1. 2.\n.1 0.\n0. .1\n.7\n.7\n"))
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
