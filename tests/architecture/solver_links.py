"""The solver runs without PETSc, SLEPc, MPI or HDF5: none of them is linked into its test program."""
import re
import subprocess
import sys

libraries = subprocess.run(["ldd", sys.argv[1]], capture_output=True, text=True, check=True).stdout
found = [line.split()[0] for line in libraries.splitlines() if re.search(r"petsc|slepc|hdf5|libmpi", line)]
for name in found:
    print(f"{sys.argv[1]}: linked with {name}")
print(f"solver_links: {len(found)} findings")
sys.exit(1 if found else 0)
