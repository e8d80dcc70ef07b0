"""Runs libFuzzer on each reader with its corpus; what breaks a reader is kept, made smaller.

    /usr/bin/python3 tools/fuzz_readers.py build-fuzz/bin/fuzz_readers [--minutes 1] [--runs N] [--keep FOLDER] [--write]
                                           [READER ...]

Inputs that reach new code are kept in FOLDER/corpus for the next time; those of tests/fuzz/corpus are the seeds. Prints
one row a reader: executions, their rate, coverage, findings; FOLDER/executed.json adds them up over all calls, to what
docs/verification/robustness.md tells, and --write puts those sums there. Exit 1 when something was found.
"""
import argparse
import glob
import json
import os
import re
import resource
import subprocess
import sys

from robustness_page import read_table, write_table

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CORPUS = os.path.join(ROOT, "tests", "fuzz", "corpus")
# Little freed memory is kept, so that the process, which is forked for each HDF5 file, stays small. Stacks of
# allocations cost more than the reader itself: run again without these options to analyse a failure. The same holds for
# names in the stacks of HDF5, which often fails in the process that checks a file.
SANITIZER = ("detect_leaks=0:allocator_may_return_null=1:malloc_context_size=1:quarantine_size_mb=1:"
             "thread_local_quarantine_size_kb=16:detect_stack_use_after_return=0")
# Longest input, and seconds that one may take: HDF5 files are looked through in a process of their own.
LONGEST = {"hdf5": 30000, "flat": 20000, "matrices": 600, "mode-tables": 16384, "nastran": 600, "packed-deck": 400,
           "deck-editor": 1500}


WORDS = {"matrices": ["%%MatrixMarket matrix ", "coordinate ", "array ", "real ", "complex ", "symmetric", "hermitian",
                      "skew-symmetric", "pattern", "DMIG,", "DMIG*", "MATLAB 5.0 MAT-file", "1 1 ", "D+00"],
         "op4-text": ["1P,5E16.9", "1P,3D23.16", "65537", "-1", "(1P,3E23.16)"],
         "mode-tables": ["$TITLE", "$EIGENVALUE = ", "$MODE = ", "$REAL OUTPUT", "$EIGENVECTOR", "-CONT-", "OUGV1", "LAMA"],
         "sid": ["part", "new modal", "end modal", "frame", "new frame = ", "end frame", "refmod", "mass ", "nelastq",
                 "ielastq", "origin", "phi", "psi", "AP", "mdCM", "J", "Ct", "Cr", "Me", "Gr", "Ge", "Oe", "ksigma", "Ke",
                 "De", "order ", "nrow ", "ncol ", "nq ", "nqn ", "structure ", "m0(", "m1("],
         "layout": ["E16.8", "I5", "%.9g", "for j", "end", "text ", "block ", "record=none", "order=k,a", "label=", "{mode:I5}",
                    "gamma4", "gains", "nodes=output"], "table": ["time", "nan", "inf", '"'],
         "model-matrices": ["2*", "1.D0", "/", "!", ",,"], "model-input": ["2*", "1.D0", "/", "!", ",,"],
         "flat": ["/modes/eigenvalue ", "float64 ", "float32 ", "int32 ", "text ", "/length ", "1 0", "2 0 0"],
         "flx": ["GMASS", "GSTIF", "GDAMP", "ALPHA", "GAMMA1", "GAMMA4", "NODE", "GAIN", "SPECIAL", "!"]}


def make_dictionary(reader, path):
    """Words of the format: names of cards, keys of the schemas."""
    words = set()
    if reader in ("nastran", "packed-deck", "deck-editor"):
        with open(os.path.join(ROOT, "tests", "formats", "nastran", "every_card.hpp"), encoding="utf-8") as deck:
            words.update(re.findall(r"^([A-Z][A-Z0-9]{2,7})[,* ]", deck.read(), re.M))
        words.update(["INCLUDE '", "BEGIN BULK", "ENDDATA", "SUBCASE ", "THRU", "*(1)", "=(9)", "SET 1 = "])
    elif reader in ("body", "system", "campaign", "key-editor"):
        for kind in ("body", "system") if reader == "key-editor" else (reader,):
            with open(os.path.join(ROOT, "data", "schema", kind + ".schema.json"), encoding="utf-8") as schema:
                words.update(re.findall(r'"([a-z_0-9]{2,30})"', schema.read()))
        words.update(["[[", "]]", " = ", '"$'])
    words.update(WORDS.get(reader, ()))
    if not words:
        return []
    with open(path, "w", encoding="ascii") as out:
        for word in sorted(words):
            out.write('"' + word.replace("\\", "\\\\").replace('"', '\\"') + '"\n')
    return ["-dict=" + path]


def cut_seeds(folder, longest):
    """Decks longer than an input may be, in pieces: each execution is as fast as its input is short."""
    for path in glob.glob(os.path.join(CORPUS, "nastran", "*")):
        with open(path, "rb") as f:
            lines = f.read().splitlines(keepends=True)
        piece, number = b"", 0
        for line in [*lines, b""]:
            if line and len(piece) + len(line) < longest * 3 // 4:
                piece += line
                continue
            if piece and not os.path.exists(seed := os.path.join(folder, f"{os.path.basename(path)}-{number}")):
                with open(seed, "wb") as out:
                    out.write(piece)
            piece, number = line, number + 1


def fuzz(program, reader, options):
    own = os.path.join(options.keep, "corpus", reader)
    found = os.path.join(options.keep, reader + "-")
    os.makedirs(own, exist_ok=True)
    if reader in ("nastran", "packed-deck", "deck-editor"):
        cut_seeds(own, LONGEST[reader])
    dictionary = make_dictionary(reader, os.path.join(options.keep, reader + ".dict"))
    environment = dict(os.environ, BOUGH_FUZZ_TARGET=reader,
                       BOUGH_FUZZ_FOLDER="/dev/shm" if os.access("/dev/shm", os.W_OK) else "/tmp",
                       ASAN_OPTIONS=SANITIZER + (":symbolize=0" if reader == "hdf5" else ""),
                       UBSAN_OPTIONS="print_stacktrace=1")
    limit = [f"-runs={options.runs}"] if options.runs else [f"-max_total_time={round(60 * options.minutes)}"]
    before = set(glob.glob(found + "*"))
    begin = get_seconds()
    # matio asks for what the names of a struct claim before it reads them, up to 2^32; that is not ours to mend.
    # Entropic weights of inputs cost more than most of the readers.
    ran = subprocess.run([program, own, os.path.join(CORPUS, reader), f"-artifact_prefix={found}", "-timeout=100",
                          "-report_slow_units=1000", f"-rss_limit_mb={9000 if reader == 'matrices' else 3000}",
                          f"-malloc_limit_mb={65536 if reader == 'matrices' else 1500}", f"-max_len={LONGEST.get(reader, 4096)}",
                          *dictionary, "-print_final_stats=1", "-reload=0", "-entropic=0", *limit], env=environment,
                         cwd=options.keep, capture_output=True, text=True, errors="replace")
    new = [path for path in sorted(set(glob.glob(found + "*")) - before) if repeats(program, path, environment, options.keep)]
    executed = re.findall(r"number_of_executed_units: (\d+)", ran.stderr) or re.findall(r"^#(\d+)", ran.stderr, re.M)
    covered = re.findall(r"cov: (\d+)", ran.stderr)
    number, took = int(executed[-1]) if executed else 0, get_seconds() - begin
    count(options.keep, reader, number, took, int(covered[-1]) if covered else 0, len(new))
    print(f"{reader:15} {number:10} {number / max(took, 0.01):8.0f} {covered[-1] if covered else '-':>8}   "
          f"{'exit %d: ' % ran.returncode if ran.returncode else ''}{', '.join(new) or 'nothing'}", flush=True)
    if ran.returncode:
        report = re.search(r"(==\d+==ERROR|runtime error|terminate called|libFuzzer: ).*", ran.stderr, re.S)
        print("    " + (report.group(0) if report else ran.stderr[-1500:])[:1500].replace("\n", "\n    "), flush=True)
    return ran.returncode != 0 and (bool(new) or not executed)


def repeats(program, path, environment, folder):
    """Whether a new process breaks too: libraries that a damaged file has broken break later in other places."""
    for _ in range(3):
        if subprocess.run([program, path], env=environment, cwd=folder, capture_output=True, check=False).returncode:
            return True
    print(f"    {path}: three new processes read it without a fault", flush=True)
    return False


def get_seconds():
    """Of computing, by all that ran: the machine may have other work."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def count(folder, reader, number, seconds, coverage, found):
    """Adds to what FOLDER/executed.json has, which begins with what the page tells; returns all of it."""
    path = os.path.join(folder, "executed.json")
    known = {name.strip("`"): [int(runs.replace(",", "")), int(runs.replace(",", "")) / max(1.0, float(rate)), int(edges), 0]
             for name, runs, rate, edges in read_table("fuzz")}
    if os.path.exists(path):
        with open(path, encoding="ascii") as f:
            known = json.load(f)
    if number:
        before = known.get(reader, [0, 0.0, 0, 0])
        known[reader] = [before[0] + number, before[1] + seconds, coverage, before[3] + found]
        with open(path, "w", encoding="ascii") as out:
            json.dump(known, out)
    return known


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("readers", nargs="*")
    parser.add_argument("--minutes", type=float, default=1)
    parser.add_argument("--runs", type=int, default=0, help="executions a reader instead of minutes")
    parser.add_argument("--keep", default="fuzz-found")
    parser.add_argument("--write", action="store_true", help="the sums into docs/verification/robustness.md")
    options = parser.parse_intermixed_args()
    options.keep = os.path.abspath(options.keep)
    os.makedirs(options.keep, exist_ok=True)
    readers = options.readers or sorted(os.listdir(CORPUS))
    print(f"{'reader':15} {'executed':>10} {'a second':>8} {'coverage':>8}   found")
    found = sum([fuzz(os.path.abspath(options.program), reader, options) for reader in readers])
    if options.write:
        known = count(options.keep, "", 0, 0, 0, 0)
        write_table("fuzz", ["reader", "executions", "a second of computing", "coverage"],
                    [(f"`{reader}`", f"{n:,}", f"{n / max(t, 0.01):.0f}", edges) for reader, (n, t, edges, _) in sorted(known.items())])
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
