"""Runs the built program and reads what it wrote."""
import json
import os
import re
import subprocess
import sys

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../support"))
import served  # noqa: E402


class Ran:
    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err

    def ids(self):
        """Identifiers of the errors."""
        return re.findall(r"error: .*\[([\w.-]+)\]", self.err)

    def warnings(self):
        """Identifiers of the warnings."""
        return re.findall(r"warning: .*\[([\w.-]+)\]", self.err)

    def first_error(self):
        found = re.search(r"error: .*", self.err)
        return found.group(0)[:200] if found else self.err[-200:]

    def broken_rule(self):
        """What no input may lead to: a signal, a hang, an exit code of no meaning, an error without words."""
        if self.code is None:
            return "no answer in time"
        if self.code not in (0, 1, 3):
            return f"exit {self.code}: {self.err[:200]!r}"
        if self.code != 0 and not self.ids():
            return f"exit {self.code} without an error that has an id: {self.err[-300:]}"
        if re.search(r"PETSc|SLEPc|MUMPS|LAPACK|[Bb]ad alloc|std::", self.err):
            return f"a message of a library: {self.first_error()}"
        return None


class Program:
    def __init__(self, path, folder, timeout=600):
        self.path, self.folder, self.timeout = os.path.abspath(path), folder, timeout
        self.env = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

    def run(self, *arguments):
        try:
            ran = served.run([self.path, *map(str, arguments)], cwd=self.folder, env=self.env, timeout=self.timeout,
                             text=False)
        except subprocess.TimeoutExpired:
            return Ran(None, "", "")
        return Ran(ran.returncode, ran.stdout.decode("utf-8", "replace"), ran.stderr.decode("utf-8", "replace"))

    def matrices(self, deck):
        """The run and, where it went well, dense K and M on the g-set and the map of its dofs."""
        ran = self.run("matrices", deck, "--no-kg", "-o", "matrices.h5")
        if ran.code != 0:
            return ran, None
        with h5py.File(os.path.join(self.folder, "matrices.h5")) as f:
            return ran, (*(read_dense(f[name]) for name in "KM"), f["dof_map"][:])

    def autospc(self, deck):
        """(grid, component, [(component, factor), ...]) of what `check` says is held, or follows those components of its
        grid; None where it does not answer."""
        ran = self.run("check", deck, "--json")
        if ran.code != 0:
            return None
        return [(e["grid"], e["component"], [tuple(f) for f in e["follows"]]) for e in json.loads(ran.out)["autospc"]]

    def modes(self, deck):
        """The run, its JSON and the shapes at the grids (ids, p × 6 × n)."""
        ran = self.run("modes", deck, "--json", "-o", "modes.h5")
        if ran.code != 0:
            return ran, None
        found = json.loads(ran.out)
        with h5py.File(os.path.join(self.folder, "modes.h5")) as f:
            found["ids"] = f["nodes/id"][:] if "nodes/id" in f else np.zeros(0, int)
            found["phi"] = f["modes/phi"][:] if "modes/phi" in f else np.zeros((0, 6, 0))
        return ran, found


def read_dense(group):
    shape, pointers = group["shape"][:], group["indptr"][:]
    A = np.zeros(shape)
    data, columns = group["data"][:], group["indices"][:]
    for row in range(shape[0]):
        A[row, columns[pointers[row]:pointers[row + 1]]] = data[pointers[row]:pointers[row + 1]]
    return A
