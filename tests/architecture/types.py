"""types.py SOURCE BUILD: the scripts of the pages by TypeScript's checker (tsc --checkJs), with the types of their JSDoc.

The modules of the report page and of the studio import each other as if they lay in one folder, where the program serves
them; they are checked in such a folder. Without tsc (Debian: node-typescript): exit code 77, skipped."""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

ROOMS = ("report/web", "cli/studio/web")
OPTIONS = ["--checkJs", "--allowJs", "--noEmit", "--target", "es2022", "--module", "es2022", "--moduleResolution", "node",
           "--lib", "es2022,dom,dom.iterable", "--pretty", "false"]


def check(modules, folder):
    """Messages of tsc with the names of the sources."""
    places = {}
    for path in modules:
        shutil.copy(path, folder)
        places[os.path.basename(path)] = path
    done = subprocess.run(["tsc", *OPTIONS, *sorted(places)], cwd=folder, text=True, capture_output=True)
    lines = [re.sub(r"^([\w.]+\.js)\((\d+),(\d+)\)", lambda m: f"{places.get(m[1], m[1])}:{m[2]}:{m[3]}", line)
             for line in (done.stdout + done.stderr).splitlines()]
    if done.returncode != 0 and not lines:
        lines = [f"tsc ended with code {done.returncode}"]
    return lines


def main():
    source = sys.argv[1]
    if shutil.which("tsc") is None:
        print("there is no tsc (Debian: node-typescript); skipped")
        return 77
    modules = [path for room in ROOMS for path in glob.glob(os.path.join(source, room, "*.js"))]
    if len(modules) < 20:
        print(f"error: only {len(modules)} modules found below {source}")
        return 1
    with tempfile.TemporaryDirectory(prefix="bough-types-") as folder:
        wrong = os.path.join(folder, "wrong.js")
        with open(wrong, "w") as f:
            f.write("export const n = /** @type {number} */ (\"text\".length);\nn.no_such_member;\n")
        os.mkdir(os.path.join(folder, "sample"))
        if not check([wrong], os.path.join(folder, "sample")):
            print("error: the checker misses a member that does not exist")
            return 1
        os.mkdir(os.path.join(folder, "all"))
        lines = check(modules, os.path.join(folder, "all"))
    print("\n".join(lines))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
