"""Opens a flexible-body file with h5py and checks it against the layout that other programs rely on."""
import sys

import h5py
import numpy as np

path, n, p = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
ndof, ne, g = 6 * p + 1, 3, p
expected = {
    "/rigid/mass": (1,), "/rigid/cg": (3,), "/rigid/inertia": (3, 3),
    "/nodes/id": (p,), "/nodes/xyz": (p, 3),
    "/modes/frequency_hz": (n,), "/modes/eigenvalue": (n,), "/modes/kind": (n,), "/modes/phi": (p, 6, n),
    "/modal/mass": (n, n), "/modal/stiffness": (n, n), "/modal/damping": (n, n),
    "/inertial_loads/f": (ndof, 12), "/dof_map": (ndof, 2), "/full/phi": (ndof, n),
    "/stiffening/kg_inertial": (12, n, n), "/stiffening/computed": (12,), "/stiffening/kg_external": (ne, n, n),
    "/stiffening/locator/name": (ne,), "/stiffening/locator/node": (ne,), "/stiffening/locator/direction": (ne,),
    "/stiffening/external_load": (n, ne), "/stiffening/load_resultant": (6, ne), "/stiffening/load_moment": (ne, 3, n),
    "/stiffening/kg_preload": (n, n), "/preload/inertial": (12,),
    "/effective_mass": (n, 6), "/grids/id": (g,), "/grids/xyz": (g, 3),
}
for method in ("lumped", "consistent", "exact"):
    for name, shape in zip(("gamma0", "gamma1", "gamma2", "gamma3", "gamma4"),
                           ((n, 3), (n, 3), (n, n, 3), (n, 3, 3), (n, n, 3, 3))):
        expected[f"/integrals/{method}/{name}"] = shape

with h5py.File(path, "r") as f:
    assert f.attrs["format"] == "bough-flexbody", f.attrs["format"]
    assert f.attrs["format_version"] == "1.1" and f.attrs["bough_version"]
    assert f.attrs["source"].shape == (2, 2) and f.attrs["source"][1, 0] == "größe.toml"
    assert f["/integrals"].attrs["method"] == "exact"
    for name, shape in expected.items():
        assert f[name].shape == shape, (name, f[name].shape, shape)
    arrays = []
    f.visititems(lambda name, item: arrays.append(item) if isinstance(item, h5py.Dataset) else None)
    for item in arrays:
        assert item.attrs["description"] and item.attrs["dims"], item.name
        if item.dtype.kind == "f":
            # Display shapes of the mesh are the only single-precision array.
            assert item.dtype == np.dtype("<f4" if item.name == "/mesh/phi" else "<f8"), (item.name, item.dtype)
    assert [k.decode() for k in f["/modes/kind"][:3]] == ["normal", "constraint", "attachment"]
    assert f["/stiffening/locator/name"].asstr()[0] == "tip x"
    assert list(f["/stiffening/kg_inertial"].attrs["computed"]) == [1, 0] * 6
    assert list(f["/stiffening/kg_inertial"].attrs["loads"][:3]) == ["ax", "ay", "az"]
    assert not np.any(f["/stiffening/kg_inertial"][1])
    assert f["/mesh/elements/line2/connectivity"].shape == (g, 2)
