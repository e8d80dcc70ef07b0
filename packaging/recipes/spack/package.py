"""Package of Spack: copy to packages/bough/package.py of a repository of packages, then in a checkout of Bough

    spack dev-build bough@0.3.0

Not run: the machines of the project have no Spack. Names of packages after Spack's own repository.
"""
from spack.package import *


class Bough(CMakePackage):
    """From a finite-element model to a flexible multibody simulation: Nastran decks to modes, mass integrals and
    geometric stiffness, and on to the motion of rigid and flexible bodies."""

    manual_download = True   # bough-VERSION.tar.gz of a release, next to where spack install is called

    license("BSD-3-Clause")  # linked to SuiteSparse the whole is under the GPL, version 3 or later

    version("0.3.0")

    variant("solver_only", default=False, description="the multibody solver and libbough.so alone, without PETSc")
    variant("python", default=True, when="~solver_only", description="the Python module")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("eigen@3.4")
    depends_on("sundials@6.4:+CVODE")
    depends_on("muparser@2.3:")
    depends_on("fmt@9:")
    depends_on("tomlplusplus@3.3:")
    depends_on("nlohmann-json@3.11:")

    with when("~solver_only"):
        depends_on("mpi")
        depends_on("blas")
        depends_on("lapack")
        depends_on("petsc@3.18:~complex+mpi+mumps+suite-sparse+metis+hdf5")
        depends_on("slepc@3.18:")
        depends_on("mumps+mpi+complex")
        depends_on("suite-sparse")
        depends_on("metis@5")
        depends_on("hdf5+mpi")
        depends_on("matio")
        depends_on("libzip")
        depends_on("pugixml")
        depends_on("cpp-httplib")
        depends_on("cli11@2.1:")
        depends_on("libedit")

    with when("+python"):
        extends("python")
        depends_on("py-pybind11@2.10:")
        depends_on("py-numpy", type=("build", "run"))
        depends_on("py-h5py", type="run")

    generator("ninja")

    def cmake_args(self):
        arguments = [
            self.define_from_variant("BOUGH_SOLVER_ONLY", "solver_only"),
            self.define("BOUGH_BUILD_TESTS", False),
            self.define("BOUGH_UNITY", True),
        ]
        if self.spec.satisfies("+python"):
            arguments.append(self.define("BOUGH_PYTHON_DIR", join_path(python_platlib, "bough")))
        return arguments

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def run_the_program(self):
        if self.spec.satisfies("~solver_only"):
            Executable(self.prefix.bin.bough)("--version")
