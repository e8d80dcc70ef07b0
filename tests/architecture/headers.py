"""Every header compiles alone.

A source that includes its own header first proves it by being compiled; the other headers are compiled here, syntax
only, with the include paths of the build.
"""
import json
import os
import re
import shlex
import subprocess
import sys
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


def read_include_flags():
    with open(os.path.join(BUILD, "compile_commands.json")) as f:
        commands = json.load(f)
    flags = []
    for command in commands:
        words = shlex.split(command["command"])
        for i, word in enumerate(words):
            if word == "-isystem":
                flag = ("-isystem", words[i + 1])
            elif word.startswith("-I"):
                flag = (word,)
            else:
                continue
            if flag not in flags:
                flags.append(flag)
    return [word for flag in flags for word in flag]


FLAGS = read_include_flags()


def compile_alone(header):
    result = subprocess.run(
        ["c++", "-std=c++20", "-O0", "-fsyntax-only", *FLAGS, "-x", "c++", "-include", header, os.devnull],
        capture_output=True, text=True)
    if result.returncode == 0:
        return None
    first = next((line for line in result.stderr.splitlines() if "error" in line), result.stderr[:200])
    return f"{header}: does not compile alone: {first}"


headers = [h for h in list_files(LIBRARY_ROOMS, (".hpp",)) if not is_first_include_of_its_source(h)]
findings = [f"{h}: has no #pragma once" for h in list_files(LIBRARY_ROOMS, (".hpp",)) if "#pragma once" not in read(h)]
with ThreadPoolExecutor(os.cpu_count()) as pool:
    findings += [f for f in pool.map(compile_alone, headers) if f]
print(f"{len(headers)} headers compiled alone")
finish(findings, "headers")
