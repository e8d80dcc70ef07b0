"""Every header compiles alone.

A source that includes its own header first proves it by being compiled; the other headers are compiled here, syntax
only, with the compiler and the include paths of the build. What many of them include is parsed once and kept as
precompiled headers: Eigen, and Eigen with a record that many use. A header is compiled after one only if it includes
all of it, and includes come before anything else, so it sees no more than it would alone; what it includes is compiled
alone itself, here or by its source.
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
# Each is made after the first; a header is compiled after the last that it includes.
PRECOMPILED = ["Eigen/Dense", "formats/records/flex_body.hpp", "formats/records/deck.hpp",
               "formats/records/system_spec.hpp", "solver/bodies/body.hpp"]


def find_includes(path):
    return re.findall(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', read(path), re.M)


def is_first_include_of_its_source(header):
    source = header[:-4] + ".cpp"
    return os.path.exists(os.path.join(ROOT, source)) and find_includes(source)[:1] == [header]


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


def get_closure(header, known):
    """Everything that the header includes, and what that includes; of other projects only the names."""
    if header not in known:
        known[header] = set()
        for found in find_includes(header):
            known[header].add(found)
            if os.path.exists(os.path.join(ROOT, found)):
                known[header] |= get_closure(found, known)
    return known[header]


def precompile(folder, name, before=()):
    """File to include for the header of that name; both compilers take the file next to it."""
    path = os.path.join(folder, name.replace("/", "_"))
    with open(path, "w") as f:
        f.write(f"#include <{name}>\n")
    clang = "clang" in COMPILER
    subprocess.run([COMPILER, *FLAGS, *(["-fpch-instantiate-templates"] if clang else []), "-x", "c++-header", *before,
                    path, "-o", path + (".pch" if clang else ".gch")], check=True)
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
    eigen = ["-include", precompile(folder, PRECOMPILED[0])]
    made = [eigen[1], *pool.map(lambda name: precompile(folder, name, eigen), PRECOMPILED[1:])]
    before, known = [], {}
    for header in headers:
        includes = get_closure(header, known)
        fits = [path for path, name in zip(made, PRECOMPILED) if {PRECOMPILED[0], name} <= includes]
        before.append(["-include", fits[-1]] if fits else [])
    findings += [f for f in pool.map(compile_alone, headers, before) if f]
print(f"{len(headers)} headers compiled alone")
finish(findings, "headers")
