"""Every header compiles alone.

A source that includes its own header first proves it by being compiled; the other headers are compiled here, syntax
only, with the compiler and the include paths of the build. Eigen is parsed once for all that include it: includes come
before anything else, so a header sees no more than it would alone.
"""
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

from common import ROOT, finish, list_files, read

BUILD = sys.argv[2]
LIBRARY_ROOMS = ["base", "formats", "fe", "modal", "stiffening", "solver"]


def is_first_include_of_its_source(header):
    source = header[:-4] + ".cpp"
    if not os.path.exists(os.path.join(ROOT, source)):
        return False
    first = re.search(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', read(source), re.M)
    return first is not None and first.group(1) == header


def read_compiler():
    """The compiler of the build, and its include paths."""
    with open(os.path.join(BUILD, "compile_commands.json")) as f:
        commands = [shlex.split(command["command"]) for command in json.load(f)]
    flags = []
    for words in commands:
        for i, word in enumerate(words):
            if word == "-isystem":
                flag = ("-isystem", words[i + 1])
            elif word.startswith("-I"):
                flag = (word,)
            else:
                continue
            if flag not in flags:
                flags.append(flag)
    compilers = [word for words in commands for word in words[:2] if word.endswith("++")]
    return compilers[0] if compilers else "c++", [word for flag in flags for word in flag]


COMPILER, FLAGS = read_compiler()
FLAGS = ["-std=c++20", "-O0", *FLAGS]


def includes_eigen(header, known):
    if header not in known:
        known[header] = False
        for found in re.findall(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', read(header), re.M):
            if found == "Eigen/Dense" or (os.path.exists(os.path.join(ROOT, found)) and includes_eigen(found, known)):
                known[header] = True
                break
    return known[header]


def precompile_eigen(folder):
    """File to include for it; both compilers take the file next to it."""
    path = os.path.join(folder, "eigen.hpp")
    with open(path, "w") as f:
        f.write("#include <Eigen/Dense>\n")
    made = path + (".pch" if "clang" in COMPILER else ".gch")
    subprocess.run([COMPILER, *FLAGS, "-x", "c++-header", path, "-o", made], check=True)
    return path


def compile_alone(header, before):
    result = subprocess.run([COMPILER, *FLAGS, "-fsyntax-only", "-x", "c++", *before, "-include", header, os.devnull],
                            capture_output=True, text=True)
    if result.returncode == 0:
        return None
    first = next((line for line in result.stderr.splitlines() if "error" in line), result.stderr[:200])
    return f"{header}: does not compile alone: {first}"


headers = [h for h in list_files(LIBRARY_ROOMS, (".hpp",)) if not is_first_include_of_its_source(h)]
findings = [f"{h}: has no #pragma once" for h in list_files(LIBRARY_ROOMS, (".hpp",)) if "#pragma once" not in read(h)]
with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(os.cpu_count()) as pool:
    eigen, known = ["-include", precompile_eigen(folder)], {}
    before = [eigen if includes_eigen(header, known) else [] for header in headers]
    findings += [f for f in pool.map(compile_alone, headers, before) if f]
print(f"{len(headers)} headers compiled alone")
finish(findings, "headers")
