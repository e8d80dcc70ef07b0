"""The manual is built without a warning, and every link inside it leads somewhere; a broken one is found."""
import os
import shutil
import subprocess
import sys
import tempfile

try:
    import myst_parser  # noqa: F401
except ImportError:
    print("skipped: no python3-myst-parser here")
    sys.exit(77)
if not shutil.which("git") or not os.path.exists(os.path.join(sys.argv[1], ".git")):
    print("skipped: not a checkout")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    output = os.path.join(folder, "html")
    tool = os.path.join(sys.argv[1], "tools/build_docs.py")
    subprocess.run([sys.executable, "-B", tool, output, "--no-cpp"], check=True)
    for name in ("index.html", "searchindex.js", "docs/tutorial.html", "docs/python-reference.html"):
        assert os.path.exists(os.path.join(output, name)), name
    sys.path.insert(0, os.path.dirname(tool))
    sys.argv = [tool, output]
    import build_docs
    assert build_docs.check_links()[0] == []
    with open(os.path.join(output, "docs/tutorial.html"), "a") as f:
        f.write('<a href="nowhere.html">x</a> <a href="notation.html#nothing">y</a>')
    assert len(build_docs.check_links()[0]) == 2
    # The site offers its versions, the newest first, and leads to it.
    build_docs.SITE = os.path.join(folder, "site")
    for version in ("0.9.0", "0.10.0"):
        os.makedirs(os.path.join(build_docs.SITE, version))
        shutil.copy(os.path.join(output, "README.html"), os.path.join(build_docs.SITE, version))
    build_docs.finish_site()
    with open(os.path.join(build_docs.SITE, "versions.js"), encoding="utf-8") as f:
        assert '["0.10.0", "0.9.0"]' in f.read()
    with open(os.path.join(build_docs.SITE, "index.html"), encoding="utf-8") as f:
        assert "url=0.10.0/README.html" in f.read()
