"""Writes a generated page, or compares it with the stored one."""
import sys


def write_or_check(path, page, mismatch, is_check):
    """Writes the page. Check: writes nothing and prints `mismatch`, what is different and what to run, if it is stale.

    Returns the exit code: 1 if the stored page is another one.
    """
    if not is_check:
        with open(path, "w") as f:
            f.write(page)
        return 0
    with open(path) as f:
        if f.read() == page:
            return 0
    print(f"{path} {mismatch}", file=sys.stderr)
    return 1
