"""The page docs/verification/robustness.md: each script puts its table between its two marks."""
import argparse
import os
import re

PAGE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "docs", "verification",
                    "robustness.md")


def write_table(mark, heads, rows, notes=(), num_keys=1):
    """Rows of words and numbers between <!-- mark --> and <!-- end of mark -->, `notes` below, one a line. What stands
    there of others, by the first cells of a row and the first word of a note, stays."""
    begin, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
    with open(PAGE, encoding="utf-8") as f:
        before, found, rest = f.read().partition(begin)
    old, found, after = rest.partition(end)
    if not found:
        raise SystemExit(f"error: {PAGE} has no marks {begin} and {end}")
    new = ["| " + " | ".join(str(x) for x in row) + " |" for row in rows]

    def find_first(line):
        if line.startswith("|"):
            return tuple(line.split(" | ")[:num_keys])
        return re.match("`[^`]*`|[^ ]*", line).group(0)

    def keep(lines, others):
        return [line for line in lines if find_first(line) not in {find_first(other) for other in others}]

    kept = [line for line in old.splitlines() if line.startswith("| ") and not line.startswith(("| ---", f"| {heads[0]} "))]
    kept_notes = [line for line in old.splitlines() if line and not line.startswith("|")]
    table = ["| " + " | ".join(heads) + " |", "| " + " | ".join("---" for _ in heads) + " |", *keep(kept, new), *new]
    below = [*keep(kept_notes, notes), *notes]
    text = "\n".join([begin, *table, *(["", *below] if below else []), end])
    with open(PAGE, "w", encoding="utf-8") as f:
        f.write(before + text + after)


def make_parser(doc, written):
    """Options of a script whose docstring is `doc` and which can write `written` into the page."""
    parser = argparse.ArgumentParser(description=doc.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep")
    parser.add_argument("--write", action="store_true", help=f"{written} into docs/verification/robustness.md")
    return parser


def read_table(mark):
    """Cells of the rows between the marks, without the heads."""
    with open(PAGE, encoding="utf-8") as f:
        inside = f.read().partition(f"<!-- {mark} -->")[2].partition(f"<!-- end of {mark} -->")[0]
    rows = [line.strip("| ").split(" | ") for line in inside.splitlines() if line.startswith("| ")]
    return rows[2:]
