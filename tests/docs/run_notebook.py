"""A notebook of docs/notebooks runs to its end, asserts and all, and leaves a figure that is a picture."""
import glob
import os
import subprocess
import sys
import tempfile

try:
    import h5py  # noqa: F401
    import matplotlib  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    text = open(sys.argv[1], encoding="utf-8").read()
    assert text.startswith("# %% [markdown]\n# # "), "a notebook begins with its title"
    assert "\nassert " in text, "a notebook asserts its numbers"
    subprocess.run([sys.executable, "-B", sys.argv[1]], cwd=folder, check=True)
    pictures = glob.glob(os.path.join(folder, "*.png"))
    assert pictures, "no figure"
    for picture in pictures:
        with open(picture, "rb") as f:
            assert f.read(8) == b"\x89PNG\r\n\x1a\n", picture
