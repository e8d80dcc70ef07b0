"""Format of the sources and pages: columns and trailing blanks by tools/lint_docs.py, C++ by clang-format.

format.py SOURCE [BUILD]

Versions of clang-format differ in places, so only the one of Debian 12 counts; without it the C++ is not compared.
"""
import os
import re
import shutil
import subprocess
import sys

from common import ROOMS, ROOT, finish, list_files

VERSION = "14"

findings = []
lint = subprocess.run([sys.executable, "-B", os.path.join(ROOT, "tools/lint_docs.py"), ROOT], capture_output=True, text=True)
if lint.returncode != 0:
    findings += lint.stdout.splitlines()
program = shutil.which("clang-format-" + VERSION) or shutil.which("clang-format")
version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout if program else ""
found = re.search(r"version (\d+)", version)
if found and found.group(1) == VERSION:
    sources = list_files(ROOMS + ["tests", "bench", "data"], (".hpp", ".cpp"))
    run = subprocess.run([program, "--dry-run", *sources], cwd=ROOT, capture_output=True, text=True)
    findings += [line + "; ./dev format formats it" for line in run.stderr.splitlines() if ": warning: " in line]
else:
    print(f"C++ not compared: clang-format {VERSION} is not there")
finish(findings, "format")
