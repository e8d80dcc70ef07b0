"""Opens a results file with h5py, finished or still growing, and checks it against the layout others rely on."""
import sys

import h5py
import numpy as np

path, nt, completed, reason = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4]
with h5py.File(path, "r") as f:
    assert f.attrs["format"] == "bough-results" and f.attrs["format_version"] == "1.1"
    assert f.attrs["completed"] == completed and f.attrs["reason"] == reason, f.attrs["reason"]
    assert f["/time"].shape == (nt,), f["/time"].shape
    assert np.array_equal(f["/time"][:], 0.1 * np.arange(nt))
    assert f["/bodies/arm/position"].shape == (nt, 3) and f["/sensors/tip"].shape == (nt, 3)
    assert f["/energy/kinetic"].shape == (nt,)
    assert np.array_equal(f["/sensors/tip"][:, 1], -2.0 * np.arange(nt))
    assert f["/sensors/tip"].attrs["description"] == "tip, body axes" and f["/sensors/tip"].attrs["dims"] == "L"
    assert f["/time"].maxshape == (None,) and f["/time"].dtype == np.dtype("<f8")
    assert f["/system"].asstr()[()].startswith('name = "pendulum ü"')
    assert f["/settings"].attrs["integrator"] == "adams"
    assert f.attrs["source"][0, 0] == "system.toml"
