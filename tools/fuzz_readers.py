"""Runs libFuzzer on each reader with its corpus; what breaks a reader is kept, made smaller.

    /usr/bin/python3 tools/fuzz_readers.py build-fuzz/bin/fuzz_readers [--minutes 1] [--runs N] [--keep FOLDER] [READER ...]

Inputs that reach new code are kept in FOLDER/corpus for the next time; those of tests/fuzz/corpus are the seeds. Prints
one row a reader: executions, coverage, findings. Exit 1 when there was one.
"""
import argparse
import glob
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CORPUS = os.path.join(ROOT, "tests", "fuzz", "corpus")
# Longest input, and seconds that one may take: HDF5 files are looked through in a process of their own.
LONGEST = {"hdf5": 150000, "matrices": 16384, "mode-tables": 16384, "nastran": 12288}


def make_dictionary(reader, path):
    """Words of the format: names of cards, keys of the schemas."""
    words = set()
    if reader == "nastran":
        with open(os.path.join(ROOT, "tests", "formats", "nastran", "every_card.hpp"), encoding="utf-8") as deck:
            words.update(re.findall(r"^([A-Z][A-Z0-9]{2,7})[,* ]", deck.read(), re.M))
        words.update(["INCLUDE '", "BEGIN BULK", "ENDDATA", "SUBCASE ", "THRU", "*(1)", "=(9)", "SET 1 = "])
    elif reader in ("body", "system", "campaign"):
        with open(os.path.join(ROOT, "data", "schema", reader + ".schema.json"), encoding="utf-8") as schema:
            words.update(re.findall(r'"([a-z_0-9]{2,30})"', schema.read()))
        words.update(["[[", "]]", " = ", '"$'])
    if not words:
        return []
    with open(path, "w", encoding="ascii") as out:
        for word in sorted(words):
            out.write('"' + word.replace("\\", "\\\\").replace('"', '\\"') + '"\n')
    return ["-dict=" + path]


def fuzz(program, reader, options):
    own = os.path.join(options.keep, "corpus", reader)
    found = os.path.join(options.keep, reader + "-")
    os.makedirs(own, exist_ok=True)
    dictionary = make_dictionary(reader, os.path.join(options.keep, reader + ".dict"))
    environment = dict(os.environ, BOUGH_FUZZ_TARGET=reader,
                       BOUGH_FUZZ_FOLDER="/dev/shm" if os.access("/dev/shm", os.W_OK) else "/tmp",
                       ASAN_OPTIONS="detect_leaks=0:allocator_may_return_null=1", UBSAN_OPTIONS="print_stacktrace=1")
    limit = [f"-runs={options.runs}"] if options.runs else [f"-max_total_time={round(60 * options.minutes)}"]
    before = set(glob.glob(found + "*"))
    ran = subprocess.run([program, own, os.path.join(CORPUS, reader), f"-artifact_prefix={found}", "-timeout=25",
                          "-rss_limit_mb=3000", "-malloc_limit_mb=1500", f"-max_len={LONGEST.get(reader, 4096)}",
                          *dictionary, "-print_final_stats=1", "-reload=0", *limit], env=environment,
                         cwd=options.keep, capture_output=True, text=True, errors="replace")
    new = sorted(set(glob.glob(found + "*")) - before)
    executed = re.findall(r"number_of_executed_units: (\d+)", ran.stderr) or re.findall(r"^#(\d+)", ran.stderr, re.M)
    covered = re.findall(r"cov: (\d+)", ran.stderr)
    print(f"{reader:15} {int(executed[-1]) if executed else 0:10} {covered[-1] if covered else '-':>8}   "
          f"{'exit %d: ' % ran.returncode if ran.returncode else ''}{', '.join(new) or 'nothing'}", flush=True)
    if ran.returncode:
        report = re.search(r"(==\d+==ERROR|runtime error|terminate called|libFuzzer: ).*", ran.stderr, re.S)
        print("    " + (report.group(0) if report else ran.stderr[-1500:])[:1500].replace("\n", "\n    "), flush=True)
    return ran.returncode != 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("readers", nargs="*")
    parser.add_argument("--minutes", type=float, default=1)
    parser.add_argument("--runs", type=int, default=0, help="executions a reader instead of minutes")
    parser.add_argument("--keep", default="fuzz-found")
    options = parser.parse_intermixed_args()
    options.keep = os.path.abspath(options.keep)
    os.makedirs(options.keep, exist_ok=True)
    readers = options.readers or sorted(os.listdir(CORPUS))
    print(f"{'reader':15} {'executed':>10} {'coverage':>8}   found")
    sys.exit(1 if sum([fuzz(os.path.abspath(options.program), reader, options) for reader in readers]) else 0)


if __name__ == "__main__":
    main()
