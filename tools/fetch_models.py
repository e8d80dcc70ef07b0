"""Fetches the public decks and listings that some tests read, and checks their SHA-256.

    /usr/bin/python3 tools/fetch_models.py [--to FOLDER] [--base URL] [--check] [--list] [NAME ...]

FOLDER    folder whose `models` receives the files; default: BOUGH_SHARED_DIR, else `../shared` next to the checkout,
          where the tests look (docs/developer/models.md)
--base    where the repositories are; default https://raw.githubusercontent.com; a mirror may be a file:// folder with
          OWNER/NAME/COMMIT/PATH
--check   downloads nothing; exit 1 if a file is absent or has another hash
--list    prints each file with its source and licence, and the files that this table cannot give
NAME      only files whose destination begins so, as truss72

A file appears under its name only when it is whole and its hash is that of the table tools/models/public.csv. A file that
is there with its hash is left alone; one with another hash is an error and stays.
"""
import argparse
import csv
import hashlib
import os
import sys
import tempfile
import urllib.error
import urllib.request

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TABLE = os.path.join(ROOT, "tools", "models", "public.csv")
OTHERS = os.path.join(ROOT, "tools", "models", "others.csv")
BASE = "https://raw.githubusercontent.com"
SECONDS = 60  # without a byte


def read_table(path):
    with open(path, encoding="utf-8", newline="") as f:
        return list(csv.DictReader(f))


def calc_hash(path):
    found = hashlib.sha256()
    with open(path, "rb") as f:
        while block := f.read(1 << 20):
            found.update(block)
    return found.hexdigest()


def fetch(url, path, row):
    """Downloads to a temporary file next to `path` and renames it if size and hash fit; raises OSError."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    size, found = 0, hashlib.sha256()
    part = tempfile.NamedTemporaryFile(dir=os.path.dirname(path), prefix=".part-", delete=False)
    try:
        with part, urllib.request.urlopen(url, timeout=SECONDS) as source:
            while block := source.read(1 << 16):
                size += len(block)
                if size > int(row["bytes"]):
                    break
                found.update(block)
                part.write(block)
        if size != int(row["bytes"]):
            raise OSError(f"expected {row['bytes']} bytes, found {'more' if size > int(row['bytes']) else size}")
        if found.hexdigest() != row["sha256"]:
            raise OSError(f"expected SHA-256 {row['sha256']}, found {found.hexdigest()}")
        os.chmod(part.name, 0o644)
        os.replace(part.name, path)
    finally:
        if os.path.exists(part.name):
            os.unlink(part.name)


def print_list(rows):
    for row in rows:
        print(f"{row['destination']}: {row['repository']} {row['path']} at {row['commit'][:10]}, {row['licence']}")
    print("\nnot in the table:")
    for row in read_table(OTHERS):
        print(f"{row['destination']}: {row['reason']}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--to", default=os.environ.get("BOUGH_SHARED_DIR") or os.path.join(ROOT, "..", "shared"))
    parser.add_argument("--base", default=BASE)
    parser.add_argument("--table", default=TABLE, help="another table of the same columns")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--list", action="store_true")
    o = parser.parse_args()
    rows = [row for row in read_table(o.table)
            if not o.names or any(row["destination"].startswith(name) for name in o.names)]
    if not rows:
        print(f"no file begins with {' or '.join(o.names)}; --list prints all", file=sys.stderr)
        return 2
    if o.list:
        print_list(rows)
        return 0
    num_failed = 0
    for row in rows:
        name, path = row["destination"], os.path.join(os.path.normpath(o.to), "models", row["destination"])
        url = "/".join([o.base.rstrip("/"), row["repository"], row["commit"], row["path"]])
        error = ""
        if os.path.exists(path):
            found = calc_hash(path)
            if found != row["sha256"]:
                error = f"{path} has another content, expected SHA-256 {row['sha256']}, found {found}; move it away"
        elif o.check:
            error = f"{path} is absent; run tools/fetch_models.py"
        else:
            try:
                fetch(url, path, row)
                print(f"{name}: fetched")
            except (OSError, urllib.error.URLError) as failure:
                error = f"{url}: {failure}; nothing is written"
        if error:
            num_failed += 1
            print(f"{name}: error: {error}", file=sys.stderr)
    print(f"{len(rows) - num_failed} of {len(rows)} files are in {os.path.join(os.path.normpath(o.to), 'models')}")
    return 1 if num_failed else 0


if __name__ == "__main__":
    sys.exit(main())
