"""The example program of fe/linear on matrices that SciPy writes, against SciPy's eigenvalues."""
import os
import re
import subprocess
import sys
import tempfile

import numpy as np
import scipy.io
import scipy.linalg
import scipy.sparse as sp


def main(program):
    n = 240
    generator = np.random.default_rng(7)
    L = sp.diags([generator.uniform(1, 2, n), generator.uniform(-1, 1, n - 1), generator.uniform(-1, 1, n - 9)],
                 [0, -1, -9])
    K, M = (L @ L.T).tocoo(), sp.diags(generator.uniform(0.5, 2, n)).tocoo()
    values = scipy.linalg.eigh(K.toarray(), M.toarray(), eigvals_only=True)
    mu = 0.5 * (values[99] + values[100])
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, name) for name in ("K.mtx", "M.mtx")]
        for path, A in zip(paths, (K, M)):
            scipy.io.mmwrite(path, A, symmetry="symmetric")
        done = subprocess.run([program, *paths, repr(mu)], capture_output=True, text=True)
        print(done.stdout, done.stderr)
        assert done.returncode == 0
        assert float(re.search(r"error (\S+)", done.stdout)[1]) < 1e-12
        assert "\n100 eigenvalues below" in done.stdout
        assert subprocess.run([program, __file__], capture_output=True).returncode == 1


main(sys.argv[1])
