"""tests/architecture/test_names.py NAME PROGRAM: the list of a test program is to be read: no line over 120 columns, as
gtest prints it and as ctest will, and no parameter as bytes (give it a PrintTo, the suite names of its own)."""
import re
import subprocess
import sys

MOST = 120


def main():
    name, program = sys.argv[1:]
    listed = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    faults, suite = [], ""
    for line in listed.splitlines():
        if line.startswith("Running main"):
            continue
        bare = re.sub(r" +#.*", "", line)
        if not line.startswith(" "):
            suite, bare = bare, ""
        shown = f"  Test #9999: {name}.{suite}{bare.strip()}"
        if len(line) > MOST or len(shown) > MOST:
            faults.append(f"{max(len(line), len(shown))} columns: {line}")
        if "-byte object" in line:
            faults.append("bytes: " + line)
    print("\n".join(faults) or f"{len(listed.splitlines())} lines")
    return 1 if faults else 0


sys.exit(main())
