"""Random structures through the built program against dense linear algebra of their exported matrices.

    /usr/bin/python3 tests/oracle/random_decks build/bin/bough [--seeds 100] [--first 0] [--spoiled] [--shrink]

Each seed is a structure of all kinds of elements, masses, rigid elements and supports, written in all formats.
`matrices` gives K and M before constraints; those of rods, springs and point masses are compared with the cards.
Constraints, AUTOSPC and eigenvalues are computed here, of the generator's own record and not of the deck's text.
`modes` must give every eigenvalue asked for to 1e-6 of its frequency, with shapes that obey the equation and the
constraints, or a refusal with the right cause; `static` and `reduce` likewise. --spoiled puts one fault into each
deck. What breaks a rule is kept, cut down to few cards with --shrink. Exit 1 when there was one.
"""
import argparse
import collections
import multiprocessing
import os
import sys
import tempfile
import traceback
import warnings

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")

from decks import examine_deck, list_decks    # noqa: E402
from examine import Examination, Report  # noqa: E402
from program import Program      # noqa: E402
from shrink import shrink        # noqa: E402


def examine(job):
    options, seed, spoiled = job
    warnings.simplefilter("error", RuntimeWarning)
    with tempfile.TemporaryDirectory(prefix="bough-oracle-") as folder:
        program = Program(options.program, folder, options.timeout)
        examination = Examination(program, seed, spoiled, options.verbs.split(","))
        try:
            report = examination.run()
            if report.kind == "wrong" and options.shrink:
                report = shrink(examination, report)
        except Exception:  # the oracle's own fault is one too
            report = Report("wrong", {"the oracle itself": traceback.format_exc()})
    return seed, examination.fault.what if examination.fault else "", report


def examine_others(options):
    """Decks that were not made by the generator."""
    decks, num_wrong = list_decks(options.decks), 0
    for deck in decks:
        with tempfile.TemporaryDirectory(prefix="bough-oracle-") as folder:
            program = Program(options.program, folder, options.timeout)
            wrong = examine_deck(program, deck, options.verbs.split(","))
        num_wrong += bool(wrong)
        for verb, what in wrong.items():
            print(f"{deck}: {verb}: {what}", flush=True)
    print(f"{len(decks)} decks: {num_wrong} wrong")
    sys.exit(1 if num_wrong else 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--spoiled", action="store_true", help="each seed with one fault too")
    parser.add_argument("--verbs", default="check,modes,static,reduce")
    parser.add_argument("--shrink", action="store_true", help="cut down the decks that break a rule")
    parser.add_argument("--decks", nargs="+", help="these decks, and those in these folders, by the rules alone")
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--list-unclear", action="store_true", help="say why a deck has no certain answer, or is refused")
    parser.add_argument("--keep", default="oracle-found")
    parser.add_argument("-j", "--jobs", type=int, default=1)
    options = parser.parse_args()
    if not os.path.exists(options.program):
        sys.exit(f"error: {options.program} is not there; build it")
    if options.decks:
        examine_others(options)
    jobs = [(options, seed, spoiled) for seed in range(options.first, options.first + options.seeds)
            for spoiled in ([False, True] if options.spoiled else [False])]
    kinds = collections.Counter()
    with multiprocessing.Pool(options.jobs) as pool:
        for seed, fault, report in pool.imap(examine, jobs):
            kinds[report.kind] += 1
            if report.kind in ("unclear", "refused") and options.list_unclear:
                print(f"seed {seed}: {report.kind}: {report.what}", flush=True)
            if report.kind != "wrong":
                continue
            os.makedirs(options.keep, exist_ok=True)
            name = os.path.join(options.keep, f"seed{seed}{'-spoiled' if fault else ''}.bdf")
            with open(name, "w", encoding="ascii") as f:
                f.write(report.deck)
            for verb, what in report.what.items():
                print(f"{name}: {fault}{': ' if fault else ''}{verb}: {what}", flush=True)
    print(f"{len(jobs)} decks: " + ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())))
    sys.exit(1 if kinds["wrong"] else 0)


if __name__ == "__main__":
    main()
