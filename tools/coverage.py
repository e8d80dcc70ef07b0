#!/usr/bin/env python3
"""Lines and functions that the tests run, room by room, in a build of the preset "coverage" (clang).

coverage.py BUILD [--rooms ROOM,...] [arguments of ctest ...]     as coverage.py build/coverage --rooms formats/nastran -L unit

Prints a Markdown table; the lines that no test ran are in BUILD/coverage.txt. Tests that fail end it with code 1.
"""
import argparse
import collections
import glob
import json
import os
import shutil
import subprocess
import sys

ROOMS = ["base", "formats", "fe", "modal", "stiffening", "solver", "embed", "cosim", "report", "analysis", "cli", "python"]


def find_tool(name):
    for tool in (name + "-14", name):
        if shutil.which(tool):
            return tool
    sys.exit(f"error: {name} is missing; apt install llvm-14")


def list_objects(build):
    """Programs and libraries of the build that were compiled with coverage."""
    found = sorted(glob.glob(os.path.join(build, "bin/*")) + glob.glob(os.path.join(build, "**/*.so*"), recursive=True))
    objects = []
    for path in found:
        if os.path.isfile(path) and not os.path.islink(path):
            with open(path, "rb") as f:
                if b"__llvm_covmap" in f.read():
                    objects.append(path)
    return objects


def run_tests(build, arguments):
    """Returns the exit code of ctest and the profiles of its processes."""
    profiles = os.path.join(build, "profiles")
    shutil.rmtree(profiles, ignore_errors=True)
    # A pool of four files a program: processes add their counts to one of them.
    environment = {**os.environ, "LLVM_PROFILE_FILE": os.path.join(profiles, "%4m.profraw")}
    code = subprocess.run(["ctest", "--test-dir", build, "--output-on-failure", "--no-tests=error", *arguments],
                          env=environment).returncode
    return code, sorted(glob.glob(os.path.join(profiles, "*.profraw")))


def sum_rooms(files, source, rooms):
    """Returns {room: {"lines" or "functions": [covered, all]}} of the product files."""
    sums = collections.defaultdict(lambda: {"lines": [0, 0], "functions": [0, 0]})
    for file in files:
        path = os.path.relpath(file["filename"], source)
        room = next((room for room in rooms if path.startswith(room + "/")), None)
        if room is None:
            continue
        for kind, sizes in sums[room].items():
            sizes[0] += file["summary"][kind]["covered"]
            sizes[1] += file["summary"][kind]["count"]
    return sums


def make_table(sums, rooms):
    rows = ["| room | lines | of them run | functions run |", "| --- | ---: | ---: | ---: |"]
    for room in rooms:
        if room in sums:
            lines, functions = sums[room]["lines"], sums[room]["functions"]
            rows.append(f"| {room} | {lines[1]} | {100 * lines[0] / lines[1]:.1f} % | "
                        f"{100 * functions[0] / functions[1]:.1f} % |")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--rooms", default=",".join(ROOMS))
    options, arguments = parser.parse_known_args()
    rooms = options.rooms.split(",")
    build = os.path.abspath(options.build)
    source = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    code, profiles = run_tests(build, arguments)
    objects = list_objects(build)
    if not profiles or not objects:
        sys.exit(f"error: no counts in {build}; build it with the preset coverage (docs/developer/coverage.md)")
    merged = os.path.join(build, "coverage.profdata")
    # A test that kills a process may leave one of the files incomplete: it is reported and left out.
    subprocess.run([find_tool("llvm-profdata"), "merge", "--sparse", "--failure-mode=all", "-o", merged, *profiles],
                   check=True)
    chosen = [f"-object={path}" for path in objects[1:]]
    counted = [find_tool("llvm-cov"), "export", "--summary-only", f"-instr-profile={merged}", objects[0], *chosen]
    summary = json.loads(subprocess.run(counted, check=True, capture_output=True, text=True).stdout)
    with open(os.path.join(build, "coverage.txt"), "w", encoding="utf-8") as f:
        subprocess.run([find_tool("llvm-cov"), "show", "--region-coverage-lt=100", f"-instr-profile={merged}", objects[0],
                        *chosen, *[os.path.join(source, room) for room in rooms]], check=True, stdout=f)
    print(make_table(sum_rooms(summary["data"][0]["files"], source, rooms), rooms))
    return 1 if code else 0


if __name__ == "__main__":
    sys.exit(main())
