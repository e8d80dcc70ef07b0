"""Spoils decks and reads them: `bough check` must answer with exit 0, 1 or 3, in time, and say what is wrong.

    /usr/bin/python3 tools/fuzz.py build/bin/bough [--seconds 60] [--seed 1] [--keep FOLDER] [DECK ...]

Without decks: those of data/decks and data/examples, the project's own. The same seed makes the same mutants. A mutant that
breaks the rule is kept, and its name is printed. Exit 1 when there was one.
"""
import argparse
import glob
import os
import random
import re
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(0, os.path.join(ROOT, "tests/support"))
import served  # noqa: E402

NUMBERS = ["0", "-1", "1", "0.", "1e308", "-1e308", "1e-308", "1e400", "nan", "inf", "99999999", "100000000",
           "2147483647", "2147483648", "-2147483648", "9223372036854775808", "18446744073709551616", "1.+400",
           "1.-400", "1.5", "123456", "0123456", "7", "THRU", "BY", "EXCEPT", "", "*", "=", "*(1)", "==", "=(999)",
           "+", "$", "'", '"', "\t", "\0", "\xff", "ALL", "YES", "-", ".", "E", "1.E", "..", "1-", "A" * 80]
CARDS = ["INCLUDE 'deck.bdf'", "INCLUDE 'nothing.bdf'", "INCLUDE ''", "INCLUDE", "ENDDATA", "BEGIN BULK", "CEND",
         "SOL 103", "SUBCASE 1", "SET 1 = 1 THRU", "SET 1 = ALL", "=", "==", "=,*1,==$", "=(99)", "+", "*", "+,,,,",
         "GRID", "GRID*", "GRDSET,,1,,,,1", "CORD2R,1,1,0.,0.,0.,0.,0.,1.",
         "CORD2R,1,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.", "CORD1R,5,1,1,1",
         "SPC1,1,123456,1,THRU,99999999", "SPC1,1,123456,99999999,THRU,1", "SPC,1,1,7,0.", "SPCADD,1,1",
         "MPCADD,1,1", "LOAD,1,1.,1.,1", "MPC,1,1,1,0.", "RBE2,9001,1,123456,1",
         "RBE2,9001,1,123456,2,THRU,99999999", "RBE3,9001,,1,123456,1.,123,1", "RBE3,9001,,1,123456",
         "CQUAD4,9001,1,1,1,1,1", "CBAR,9001,1,1,1,0.,0.,1.", "CBUSH,9001,1,1,1", "CELAS2,9001,1.,1,1,1,1",
         "CHEXA,9001,1,1,2,3,4,5,6\n,7,8", "PCOMP,1", "PCOMP,1,,,,,,,SYM\n,1,1.", "PSHELL,1", "PBARL,1,1,,BAR",
         "PBEAML,1,1,,NOPE\n,1.", "MAT1,1", "MAT1,1,0.,0.,.5", "MAT1,1,1.,,2.", "EIGRL,1", "EIGRL,1,,,-5",
         "EIGRL,1,9.,1.", "PARAM", "PARAM,WTMASS,0.", "PARAM,GRDPNT,-7", "PARAM,K6ROT,nan", "CONM2,9001,1,,-1.",
         "SPOINT,1,THRU,99999999", "DMIG,A,0,6,1,0", "ASET1,123456,1,THRU,5", "PLOAD4,1,1,1.,,,,1,THRU",
         "TEMP,1,1,1.", "ZZZZ,1,2,3"]


def mutate(random_, text):
    """One to four changes of the text of a deck."""
    lines = text.split("\n")
    for _ in range(random_.choice([1, 1, 1, 2, 4])):
        at = random_.randrange(len(lines))
        line, kind = lines[at], random_.randrange(13)
        if kind == 0:
            del lines[at]
        elif kind == 1:
            lines.insert(at, random_.choice(lines))
        elif kind == 2:
            lines[at] = line[:random_.randrange(len(line) + 1)]
        elif kind == 3 and line:
            k = random_.randrange(len(line))
            other = chr(random_.choice([random_.randrange(32, 127), random_.randrange(256)]))
            lines[at] = line[:k] + other + line[k + 1:]
        elif kind in (4, 5) and line:
            k = random_.randrange(len(line) // 8 + 1)
            parts = line.split(",")
            if len(parts) > 1:
                parts[random_.randrange(len(parts))] = random_.choice(NUMBERS)
                lines[at] = ",".join(parts)
            else:
                lines[at] = (line + " " * 80)[:8 * k] + f"{random_.choice(NUMBERS):<8}" + line[8 * k + 8:]
        elif kind == 6:
            del lines[at:at + random_.randrange(1, 20)]
        elif kind == 7:
            lines = lines[:at + 1]
        elif kind in (8, 9):
            lines.insert(at, random_.choice(CARDS))
        elif kind == 10:
            other = random_.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        elif kind == 11:
            numbers = list(re.finditer(r"\d+", line))
            if numbers:
                found = random_.choice(numbers)
                lines[at] = line[:found.start()] + random_.choice(NUMBERS) + line[found.end():]
        else:
            lines[at] = random_.choice([line.lower(), line.replace(" ", "\t"), line.replace(",", " "), line + "+",
                                        " " + line, line * 2])
        lines = lines or [""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("decks", nargs="*")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--number", type=int, help="so many mutants, whatever time they take")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--timeout", type=float, default=20)
    parser.add_argument("--verb", default="check")
    parser.add_argument("--keep", default="fuzz-found")
    options = parser.parse_intermixed_args()
    own = ["data/decks/*.bdf", "data/examples/*/*.bdf"]
    decks = options.decks or sorted(deck for pattern in own for deck in glob.glob(os.path.join(ROOT, pattern)))
    if not decks:
        sys.exit("error: no decks; name some, or run it in a checkout with data/decks")
    texts = {}
    for deck in decks:
        with open(deck, encoding="latin-1") as f:
            texts[deck] = f.read()
    exits, found, number, end = {}, [], 0, time.monotonic() + options.seconds
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "deck.bdf")
        while number < options.number if options.number else time.monotonic() < end:
            random_ = random.Random(options.seed * 1000003 + number)
            deck = random_.choice(decks)
            mutant = mutate(random_, texts[deck])
            with open(path, "w", encoding="latin-1") as f:
                f.write(mutant)
            arguments = ["-n", "2", "-o", os.path.join(folder, "modes.h5")] if options.verb == "modes" else []
            try:
                ran = served.run([os.path.abspath(options.program), options.verb, path, *arguments], text=False,
                                 timeout=options.timeout)
                code, said = ran.returncode, ran.stderr.strip()
            except subprocess.TimeoutExpired:
                code, said = "no answer in time", b"-"
            exits[code] = exits.get(code, 0) + 1
            if code not in (0, 1, 3) or (code != 0 and b"error" not in said):
                os.makedirs(options.keep, exist_ok=True)
                name = os.path.join(options.keep, f"seed{options.seed}-{number}.bdf")
                with open(name, "w", encoding="latin-1") as f:
                    f.write(mutant)
                found.append(name)
                print(f"{name}: mutant of {os.path.basename(deck)}: exit {code}: {said[-300:]!r}", flush=True)
            number += 1
    print(f"{number} mutants of {len(decks)} decks, exit codes {exits}, {len(found)} found")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
