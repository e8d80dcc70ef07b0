"""Bough's HDF5 files with h5py alone, on machines without the program: copy this one file, or import bough.reader.

    import reader
    results = reader.read("spinup.h5")
    results["sensors/tip_deflection"]           # an array; also results["tip_deflection"]
    results.time, results.format, results.attributes
"""
import h5py

SCALES = ("CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST")  # what h5py's `dims` shows


class File:
    """Everything in a file, by path. `format` says which kind it is: bough-results, bough-flexbody, ..."""

    def __init__(self, path, data=None):
        """data: an open file with the bytes, instead of the file at the path."""
        self.path = path
        self.arrays, self.descriptions, self.attributes = {}, {}, {}
        with h5py.File(path if data is None else data, "r") as f:
            self.attributes[""] = dict(f.attrs)
            self._take_all(f, "")
        self.format = self._get_text("format")
        self.format_version = self._get_text("format_version")
        if not self.format.startswith("bough-"):
            raise ValueError(f"{path} is no file of Bough: it has no attribute format")

    def _get_text(self, name):
        value = self.attributes[""].get(name, "")
        return value.decode() if isinstance(value, bytes) else str(value)

    def _take_all(self, group, path):
        """Takes arrays by every name: one linked twice appears twice, which h5py's visititems shows once."""
        for name, item in group.items():
            self._take(path + name, item)
            if isinstance(item, h5py.Group):
                self._take_all(item, path + name + "/")

    def _take(self, name, item):
        self.attributes[name] = {key: value for key, value in item.attrs.items() if key not in SCALES}
        if isinstance(item, h5py.Dataset):
            value = item[()]
            if h5py.check_string_dtype(item.dtype):
                value = item.asstr()[()]
            self.arrays[name] = value
            description = item.attrs.get("description", "")
            self.descriptions[name] = description.decode() if isinstance(description, bytes) else description

    def _find(self, name):
        name = name.strip("/")
        for path in (name, *(f"{group}/{name}" for group in ("sensors", "signals", "controllers", "actuators"))):
            if path in self.arrays:
                return path
        raise KeyError(f"{name} is not in {self.path}; it has {', '.join(sorted(self.arrays)[:20])}, ...")

    def __getitem__(self, name):
        return self.arrays[self._find(name)]

    def __contains__(self, name):
        try:
            return bool(self._find(name))
        except KeyError:
            return False

    def __iter__(self):
        return iter(self.arrays)

    def __len__(self):
        return len(self.arrays)

    def keys(self):
        return self.arrays.keys()

    def describe(self, name):
        """Description of an array, with its frame."""
        return self.descriptions[self._find(name)]

    @property
    def time(self):
        """Times of the samples of a results file."""
        return self["time"]

    def __repr__(self):
        return f"<{self.format} {self.path}: {len(self.arrays)} arrays>"


def read(path):
    """The whole file in memory."""
    return File(path)
