/// \file The yardstick of `bough modes`: SLEPc's Krylov-Schur with a direct solver of PETSc on matrices from a file,
/// with nothing around it.
///
///   raw_modes write DECK PREFIX            K_ff and M_ff of a deck to PREFIX.K and PREFIX.M (PETSc binary)
///   raw_modes solve PREFIX cholmod|mumps   the 20 lowest modes; PETSc and SLEPc options may follow (-eps_ncv
///   ...)
#include <slepceps.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>

#include "fe/matrices/assembly.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace {

using bough::linear::check_petsc;

/// Of this process: what others do on the machine counts little.
double get_processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void write(Mat A, const std::string& path) {
  PetscViewer viewer = nullptr;
  check_petsc(PetscViewerBinaryOpen(PETSC_COMM_WORLD, path.c_str(), FILE_MODE_WRITE, &viewer));
  check_petsc(MatView(A, viewer));
  check_petsc(PetscViewerDestroy(&viewer));
}

bough::linear::PetscMat read(const std::string& path) {
  PetscViewer viewer = nullptr;
  check_petsc(PetscViewerBinaryOpen(PETSC_COMM_WORLD, path.c_str(), FILE_MODE_READ, &viewer));
  bough::linear::PetscMat A;
  check_petsc(MatCreate(PETSC_COMM_WORLD, A.out()));
  check_petsc(MatSetType(A.get(), MATAIJ));
  check_petsc(MatLoad(A.get(), viewer));
  check_petsc(PetscViewerDestroy(&viewer));
  check_petsc(MatSetOption(A.get(), MAT_SYMMETRIC, PETSC_TRUE));
  return A;
}

int write_matrices(const std::string& deck_path, const std::string& prefix) {
  bough::Diagnostics diagnostics;
  const auto deck = bough::nastran::read_deck(deck_path, {}, diagnostics);
  const auto model = bough::fe::build_model(deck, {}, diagnostics);
  write(bough::fe::assemble_stiffness(model, bough::fe::DofSet::Free).sparse(), prefix + ".K");
  write(bough::fe::assemble_mass(model, bough::fe::DofSet::Free, model.mass_kind()).sparse(), prefix + ".M");
  return 0;
}

int solve(const std::string& prefix, const std::string& solver) {
  constexpr PetscInt kModes = 20;
  const double start = get_processor_seconds();
  const auto K = read(prefix + ".K"), M = read(prefix + ".M");
  const double reading = get_processor_seconds() - start;
  EPS eps = nullptr;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  check_petsc(EPSCreate(PETSC_COMM_WORLD, &eps));
  check_petsc(EPSSetOperators(eps, K.get(), M.get()));
  check_petsc(EPSSetProblemType(eps, EPS_GHEP));
  check_petsc(EPSSetDimensions(eps, kModes, PETSC_DEFAULT, PETSC_DEFAULT));
  check_petsc(EPSSetTolerances(eps, 1e-10, 300));
  check_petsc(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
  check_petsc(EPSSetTarget(eps, 0));
  check_petsc(EPSGetST(eps, &st));
  check_petsc(STSetType(st, STSINVERT));
  check_petsc(STGetKSP(st, &ksp));
  check_petsc(KSPSetType(ksp, KSPPREONLY));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCSetType(pc, PCCHOLESKY));
  check_petsc(PCFactorSetMatSolverType(pc, solver == "mumps" ? MATSOLVERMUMPS : MATSOLVERCHOLMOD));
  check_petsc(EPSSetFromOptions(eps));
  const double before_factor = get_processor_seconds();
  check_petsc(EPSSetUp(eps));
  const double factoring = get_processor_seconds() - before_factor;
  const double before_krylov = get_processor_seconds();
  check_petsc(EPSSolve(eps));
  const double krylov = get_processor_seconds() - before_krylov;
  PetscInt converged = 0, n = 0, solves = 0;
  PetscScalar last = 0;
  check_petsc(EPSGetConverged(eps, &converged));
  check_petsc(KSPGetTotalIterations(ksp, &solves));
  if (converged > 0) check_petsc(EPSGetEigenvalue(eps, std::min(kModes, converged) - 1, &last, nullptr));
  check_petsc(MatGetSize(K.get(), &n, nullptr));
  check_petsc(EPSDestroy(&eps));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%d dofs: read %.2f s, factor %.2f s, Krylov %.2f s (%d solves), all %.2f s, %.0f MB; %d modes to %.9e\n",
              static_cast<int>(n), reading, factoring, krylov, static_cast<int>(solves),
              get_processor_seconds() - start, static_cast<double>(usage.ru_maxrss) / 1024, static_cast<int>(converged),
              last);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: raw_modes write DECK PREFIX | solve PREFIX cholmod|mumps [PETSc options]\n", stderr);
    return 2;
  }
  bough::linear::initialize_petsc();
  int no_argc = 0;
  char** no_argv = nullptr;
  check_petsc(SlepcInitialize(&no_argc, &no_argv, nullptr, nullptr));
  for (int i = 4; i < argc; ++i) {
    const char* value = i + 1 < argc && argv[i + 1][0] != '-' ? argv[i + 1] : nullptr;
    check_petsc(PetscOptionsSetValue(nullptr, argv[i], value));
    if (value) ++i;
  }
  try {
    return std::strcmp(argv[1], "write") == 0 ? write_matrices(argv[2], argv[3]) : solve(argv[2], argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
