#include "bough/modal/krylov.hpp"

#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "bough/base/diagnostic.hpp"
#include "bough/fe/assembly.hpp"
#include "bough/fe/factor.hpp"

namespace bough::modal::detail {

using fe::check_petsc;

namespace {

using SlepcEps = fe::PetscHandle<EPS, EPSDestroy>;

/// Direct solution by CHOLMOD's LLᵀ or MUMPS' LDLᵀ.
void set_direct_solver(KSP ksp, MatSolverType solver) {
  PC pc = nullptr;
  check_petsc(KSPSetType(ksp, KSPPREONLY));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCSetType(pc, PCCHOLESKY));
  check_petsc(PCFactorSetMatSolverType(pc, solver));
}

PetscErrorCode apply_factor(PC pc, Vec b, Vec x) {
  Mat factor = nullptr;
  const PetscErrorCode code = PCShellGetContext(pc, static_cast<void*>(&factor));
  return code != 0 ? code : MatSolve(factor, b, x);
}

/// Direct solution by a factor that somebody else made.
void set_known_factor(KSP ksp, Mat factor) {
  PC pc = nullptr;
  check_petsc(KSPSetType(ksp, KSPPREONLY));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCSetType(pc, PCSHELL));
  check_petsc(PCShellSetContext(pc, factor));
  check_petsc(PCShellSetApply(pc, apply_factor));
}

fe::PetscVec make_vector(Mat A, const Eigen::Ref<const VectorXd>& values) {
  fe::PetscVec v;
  check_petsc(MatCreateVecs(A, v.out(), nullptr));
  fe::scatter(values, v.get());
  return v;
}

struct Watch {
  std::function<void(int, int)> progress;
  int wanted = 0;
};

PetscErrorCode report_progress(EPS, PetscInt, PetscInt converged, PetscScalar*, PetscScalar*, PetscReal*, PetscInt,
                               void* context) {
  const auto* watch = static_cast<const Watch*>(context);
  watch->progress(std::min(static_cast<int>(converged), watch->wanted), watch->wanted);
  return 0;
}

}  // namespace

void initialize_slepc() {
  fe::initialize_petsc();
  PetscBool initialized = PETSC_FALSE;
  SlepcInitialized(&initialized);
  if (initialized) return;
  int argc = 0;
  char** argv = nullptr;
  check_petsc(SlepcInitialize(&argc, &argv, nullptr, nullptr));
  // MUMPS estimates its workspace for a definite matrix; an indefinite one needs more for delayed pivots.
  check_petsc(PetscOptionsInsertString(nullptr, "-st_mat_mumps_icntl_14 60"));
  // Without this CHOLMOD gives a small matrix an LDLᵀ that takes negative pivots as they come.
  check_petsc(PetscOptionsInsertString(nullptr, "-st_mat_cholmod_final_ll true -st_mat_cholmod_print 0"));
  std::atexit([] {
    PetscBool finalized = PETSC_FALSE;
    PetscFinalized(&finalized);
    if (!finalized) SlepcFinalize();
  });
}

double calc_fixed_number(int index, int start) {
  // splitmix64, a public-domain mixer by S. Vigna.
  std::uint64_t z = (static_cast<std::uint64_t>(index) + 1) * 0x9E3779B97F4A7C15ULL +
                    static_cast<std::uint64_t>(start) * 0xD1B54A32D192ED03ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return 2.0 * (static_cast<double>(z >> 11) * 0x1p-53) - 1.0;
}

namespace {

/// Sets up SLEPc for the problem with one solver; false when that solver cannot factor the matrix.
bool set_up(const KrylovProblem& problem, MatSolverType solver, int wanted, int subspace, SlepcEps& eps) {
  ST st = nullptr;
  KSP ksp = nullptr;
  eps = SlepcEps();
  check_petsc(EPSCreate(PETSC_COMM_WORLD, eps.out()));
  check_petsc(EPSSetOperators(eps.get(), problem.A, problem.B));
  check_petsc(EPSSetProblemType(eps.get(), EPS_GHEP));
  check_petsc(EPSSetType(eps.get(), EPSKRYLOVSCHUR));
  check_petsc(EPSSetDimensions(eps.get(), wanted, subspace, PETSC_DEFAULT));
  check_petsc(EPSSetTolerances(eps.get(), problem.tolerance, 300));
  check_petsc(EPSGetST(eps.get(), &st));
  if (problem.spectrum == Spectrum::NearShift) {
    check_petsc(STSetType(st, STSINVERT));
    check_petsc(EPSSetWhichEigenpairs(eps.get(), EPS_TARGET_MAGNITUDE));
    check_petsc(EPSSetTarget(eps.get(), problem.shift));
    check_petsc(EPSSetPurify(eps.get(), PETSC_FALSE));  // done for all vectors at once
  } else {
    check_petsc(STSetType(st, STSHIFT));
    check_petsc(EPSSetWhichEigenpairs(eps.get(), EPS_LARGEST_MAGNITUDE));
  }
  check_petsc(STGetKSP(st, &ksp));
  if (problem.factor)
    set_known_factor(ksp, problem.factor);
  else
    set_direct_solver(ksp, solver);

  std::vector<fe::PetscVec> known;
  std::vector<Vec> known_raw;
  for (Eigen::Index c = 0; c < problem.deflate.cols(); ++c) {
    known.push_back(make_vector(problem.A, problem.deflate.col(c)));
    known_raw.push_back(known.back().get());
  }
  if (!known_raw.empty())
    check_petsc(EPSSetDeflationSpace(eps.get(), static_cast<PetscInt>(known_raw.size()), known_raw.data()));

  PetscInt n = 0;
  check_petsc(MatGetSize(problem.A, &n, nullptr));
  VectorXd first(n);
  for (int i = 0; i < n; ++i) first(i) = calc_fixed_number(i, problem.start);
  fe::PetscVec first_vector = make_vector(problem.A, first);
  Vec first_raw = first_vector.get();
  check_petsc(EPSSetInitialSpace(eps.get(), 1, &first_raw));

  const PetscErrorCode code = EPSSetUp(eps.get());
  // CHOLMOD met a pivot that is not positive, MUMPS one that is zero: SLEPc makes that an error.
  if (code != 0 && (code == PETSC_ERR_LIB || std::strcmp(solver, MATSOLVERCHOLMOD) == 0)) return false;
  check_petsc(code);
  return true;
}

/// x = (λ - σ)(A - σB)⁻¹B x: removes what a semi-definite B lets into the vectors unseen (Nour-Omid et al., Math. Comp.
/// 48 (1987) 663). A solve of eight right-hand sides costs a third of eight solves.
void purify(const KrylovProblem& problem, EPS eps, KrylovResult& result) {
  if (result.values.size() == 0) return;
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  Mat factor = problem.factor;
  if (!factor) {
    check_petsc(EPSGetST(eps, &st));
    check_petsc(STGetKSP(st, &ksp));
    check_petsc(KSPGetPC(ksp, &pc));
    check_petsc(PCFactorGetMatrix(pc, &factor));
  }
  const VectorXd scale = result.values.array() - problem.shift;
  constexpr Eigen::Index kBlock = 8;  // enough for the speed, few for the memory
  for (Eigen::Index first = 0; first < scale.size(); first += kBlock) {
    auto X = result.vectors.middleCols(first, std::min(kBlock, scale.size() - first));
    X = fe::solve_factored(factor, fe::multiply(problem.B, X)) * scale.segment(first, X.cols()).asDiagonal();
  }
}

}  // namespace

KrylovResult solve_krylov_schur(const KrylovProblem& problem) {
  initialize_slepc();
  PetscInt n = 0;
  check_petsc(MatGetSize(problem.A, &n, nullptr));
  const int room = (problem.max_subspace > 0 ? std::min<int>(problem.max_subspace, n) : static_cast<int>(n));
  const int wanted = std::clamp(problem.num_wanted, 1, std::max(1, room));
  // 2.6 vectors a mode: the lowest modes of a plate are there before the first restart.
  const int subspace = std::min(std::max(13 * wanted / 5, wanted + 20), std::max(room, 1));

  SlepcEps eps;
  KrylovResult result;
  const bool is_alone = fe::initialize_petsc().size == 1;
  if (!(is_alone && set_up(problem, MATSOLVERCHOLMOD, wanted, subspace, eps)) &&
      ((is_alone && problem.definite_only) || !set_up(problem, MATSOLVERMUMPS, wanted, subspace, eps))) {
    result.is_singular = true;
    return result;
  }
  Watch watch{problem.progress, wanted};
  if (watch.progress) check_petsc(EPSMonitorSet(eps.get(), report_progress, &watch, nullptr));
  check_petsc(EPSSolve(eps.get()));

  PetscInt converged = 0;
  check_petsc(EPSGetConverged(eps.get(), &converged));
  result.values.resize(converged);
  result.vectors.resize(n, converged);
  fe::PetscVec x;
  check_petsc(MatCreateVecs(problem.A, x.out(), nullptr));
  for (PetscInt i = 0; i < converged; ++i) {
    PetscScalar value = 0;
    check_petsc(EPSGetEigenpair(eps.get(), i, &value, nullptr, x.get(), nullptr));
    result.values(i) = value;
    result.vectors.col(i) = fe::gather(x.get());
  }
  if (problem.spectrum == Spectrum::NearShift) purify(problem, eps.get(), result);
  return result;
}

int count_negative(Mat A, double factor, Mat B) {
  initialize_slepc();
  fe::PetscMat C;
  check_petsc(MatDuplicate(A, MAT_COPY_VALUES, C.out()));
  check_petsc(MatAXPY(C.get(), factor, B, DIFFERENT_NONZERO_PATTERN));
  check_petsc(MatSetOption(C.get(), MAT_SYMMETRIC, PETSC_TRUE));
  fe::PetscKsp ksp;
  PC pc = nullptr;
  Mat F = nullptr;
  check_petsc(KSPCreate(PETSC_COMM_WORLD, ksp.out()));
  check_petsc(KSPSetOperators(ksp.get(), C.get(), C.get()));
  set_direct_solver(ksp.get(), MATSOLVERMUMPS);
  check_petsc(KSPGetPC(ksp.get(), &pc));
  check_petsc(PCFactorSetUpMatSolverType(pc));
  check_petsc(PCFactorGetMatrix(pc, &F));
  // The inertia leaves out the root front when ScaLAPACK factors it: keep it sequential.
  check_petsc(MatMumpsSetIcntl(F, 13, 1));
  check_petsc(MatMumpsSetIcntl(F, 14, 60));
  check_petsc(MatMumpsSetIcntl(F, 7, 2));   // approximate minimum fill: half the time of MUMPS' own choice on plates
  check_petsc(MatMumpsSetIcntl(F, 31, 1));  // only the signs of the pivots are wanted: the factor is not kept
  check_petsc(KSPSetUp(ksp.get()));
  PCFailedReason failed = PC_NOERROR;
  check_petsc(PCGetFailedReason(pc, &failed));
  if (failed != PC_NOERROR) return -1;
  PetscInt negative = 0;
  check_petsc(MatGetInertia(F, &negative, nullptr, nullptr));
  return static_cast<int>(negative);
}

}  // namespace bough::modal::detail
