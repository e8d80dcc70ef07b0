#include "modal/eps_types.hpp"

#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <utility>

#include "base/diagnostic.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/ranks.hpp"
#include "modal/block_lanczos.hpp"
#include "modal/low_rank.hpp"

namespace bough::modal::detail {
namespace {

using Eigen::VectorXd;
using linear::check_petsc;

/// Data of both types in eps->data.
class OwnSolver {
 public:
  virtual ~OwnSolver() = default;
  /// Computes values (λ) and vectors; returns the number that converged. `is_done`: all requested or all existing ones.
  virtual int run(EPS eps, const FactoredOperator& op, bool& is_done) = 0;

  VectorXd values;
  MatrixXd vectors;
  std::exception_ptr failure;
};

OwnSolver& get(EPS eps) { return *static_cast<OwnSolver*>(eps->data); }

/// EPS' arrays by eigenvalue, for at least `number` of them.
void allocate_values(EPS eps, PetscInt number) {
  if (eps->eigr && number <= eps->ncv) return;
  if (eps->eigr) check_petsc(PetscFree4(eps->eigr, eps->eigi, eps->errest, eps->perm));
  eps->ncv = number;
  check_petsc(PetscMalloc4(number, &eps->eigr, number, &eps->eigi, number, &eps->errest, number, &eps->perm));
  std::fill_n(eps->eigr, number, 0.0);
  std::fill_n(eps->eigi, number, 0.0);
  std::fill_n(eps->errest, number, 0.0);
  for (PetscInt i = 0; i < number; ++i) eps->perm[i] = i;
}

class BlockLanczosSolver final : public OwnSolver {
 public:
  int run(EPS eps, const FactoredOperator& op, bool& is_done) override {
    BlockLanczosProblem problem;
    problem.solve = op.solve;
    problem.multiply_mass = op.multiply_mass;
    problem.multiply_operator = op.multiply_operator;
    problem.start = std::move(settings.start);
    problem.deflate = std::move(settings.deflation);
    problem.num_wanted = static_cast<int>(eps->nev);
    problem.num_guard = std::min(settings.num_guard, problem.num_wanted - 1);
    problem.max_subspace = settings.max_subspace;
    problem.max_restarts = static_cast<int>(eps->max_it);
    problem.tolerance = eps->tol;
    problem.positive_only = settings.positive_only;
    problem.monitor = [eps](int converged, const VectorXd& theta, const VectorXd& error) {
      const auto number = std::min<Eigen::Index>(theta.size(), eps->ncv);
      std::copy_n(theta.data(), number, eps->eigr);
      std::copy_n(error.data(), number, eps->errest);
      eps->nconv = converged;
      check_petsc(EPSMonitor(eps, ++eps->its, converged, eps->eigr, eps->eigi, eps->errest, number));
    };
    if (settings.release) settings.release();
    BlockLanczosResult found = solve_block_lanczos(std::move(problem));
    is_done = found.is_done;
    values = std::move(found.theta);
    vectors = std::move(found.X);
    VectorXd zero = VectorXd::Zero(values.size());
    check_petsc(STBackTransform(eps->st, static_cast<PetscInt>(values.size()), values.data(), zero.data()));
    return found.is_done ? static_cast<int>(values.size()) : found.num_converged;
  }

  BlockLanczosSettings settings;
};

class LowRankSolver final : public OwnSolver {
 public:
  int run(EPS eps, const FactoredOperator& op, bool& is_done) override {
    LowRankProblem problem;
    problem.K = settings.K;
    problem.M = settings.B;
    problem.C = settings.C;
    problem.solve = op.solve;
    problem.shift = eps->target;
    problem.known = std::move(settings.deflation);
    problem.projects_known = settings.projects_deflation;
    problem.num_wanted = static_cast<int>(eps->nev);
    Roots roots = solve_low_rank(problem);
    is_done = true;  // fewer are all that have digits
    values = std::move(roots.value);
    vectors = std::move(roots.X);
    return static_cast<int>(values.size());
  }

  LowRankSettings settings;
};

PetscErrorCode set_up(EPS eps) {
  PetscFunctionBegin;
  EPSCheckHermitianDefinite(eps);
  EPSCheckUnsupported(eps, EPS_FEATURE_ARBITRARY | EPS_FEATURE_REGION | EPS_FEATURE_EXTRACTION |
                               EPS_FEATURE_CONVERGENCE | EPS_FEATURE_STOPPING | EPS_FEATURE_TWOSIDED);
  if (eps->max_it == PETSC_DEFAULT) eps->max_it = 100;
  if (!eps->which) eps->which = EPS_TARGET_MAGNITUDE;
  // The vectors are in a separate matrix: the basis of EPS is allocated only if it is requested.
  const PetscErrorCode code = run_guarded(get(eps).failure, [&] {
    if (eps->ncv < eps->nev) eps->ncv = eps->nev;
    if (!eps->eigr) allocate_values(eps, eps->ncv);
  });
  PetscCall(code);
  PetscFunctionReturn(0);
}

PetscErrorCode set_up_sort(EPS eps) {
  PetscFunctionBegin;
  eps->sc->comparison = eps->which == EPS_LARGEST_REAL        ? SlepcCompareLargestReal
                        : eps->which == EPS_LARGEST_MAGNITUDE ? SlepcCompareLargestMagnitude
                                                              : SlepcCompareTargetMagnitude;
  eps->sc->comparisonctx = &eps->target;
  eps->sc->map = nullptr;
  eps->sc->mapobj = nullptr;
  PetscFunctionReturn(0);
}

/// A basis of the given number of columns without storage, which a type would give it (compute_vectors): EPSSolve sets
/// its active columns.
void set_basis_size(EPS eps, PetscInt number) {
  Mat B = nullptr;
  linear::PetscVec like;
  check_petsc(STGetMatrix(eps->st, 1, &B));
  check_petsc(MatCreateVecs(B, like.out(), nullptr));
  check_petsc(BVDestroy(&eps->V));
  check_petsc(BVCreate(PetscObjectComm(reinterpret_cast<PetscObject>(eps)), &eps->V));
  check_petsc(BVSetSizesFromVec(eps->V, like.get(), number));
  if (eps->nwork > 0) return;
  constexpr PetscInt kWorkVectors = 5;  // of EPSComputeError, which would take them from the basis
  check_petsc(VecDuplicateVecs(like.get(), kWorkVectors, &eps->work));
  eps->nwork = kWorkVectors;
}

PetscErrorCode solve(EPS eps) {
  PetscFunctionBegin;
  OwnSolver& own = get(eps);
  const FactoredOperator* op = find_operator(eps->st);
  PetscCheck(op, PetscObjectComm(reinterpret_cast<PetscObject>(eps)), PETSC_ERR_SUP, "The solver '%s' requires ST %s",
             reinterpret_cast<PetscObject>(eps)->type_name, kFactorTransform);
  const PetscErrorCode code = run_guarded(own.failure, [&] {
    bool is_done = false;
    const int converged = own.run(eps, *op, is_done);
    const auto size = static_cast<PetscInt>(own.values.size());
    allocate_values(eps, std::max<PetscInt>(size, 1));
    set_basis_size(eps, std::max<PetscInt>(size, 1));
    std::copy_n(own.values.data(), size, eps->eigr);
    eps->nconv = converged;
    eps->reason = is_done ? EPS_CONVERGED_TOL : EPS_DIVERGED_ITS;
  });
  PetscCall(code);
  PetscFunctionReturn(0);
}

/// The basis of EPS from our matrix, for EPSGetEigenvector and the viewers.
PetscErrorCode compute_vectors(EPS eps) {
  PetscFunctionBegin;
  const MatrixXd& X = get(eps).vectors;
  Mat B = nullptr;
  Vec column = nullptr;
  PetscCall(STGetMatrix(eps->st, 1, &B));
  PetscCall(MatCreateVecs(B, &column, nullptr));
  PetscCall(BVSetType(eps->V, BVVECS));
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    const PetscErrorCode code = run_guarded(get(eps).failure, [&] { linear::scatter(X.col(j), column); });
    PetscCall(code);
    PetscCall(BVInsertVec(eps->V, static_cast<PetscInt>(j), column));
  }
  PetscCall(VecDestroy(&column));
  PetscFunctionReturn(0);
}

/// The values are those of the problem already.
PetscErrorCode transform_back(EPS) { return 0; }

PetscErrorCode destroy(EPS eps) {
  PetscFunctionBegin;
  delete &get(eps);
  eps->data = nullptr;
  PetscFunctionReturn(0);
}

template <class Solver>
PetscErrorCode create(EPS eps) {
  PetscFunctionBegin;
  eps->data = static_cast<OwnSolver*>(new Solver);
  eps->categ = EPS_CATEGORY_OTHER;
  eps->useds = PETSC_FALSE;
  eps->ops->setup = set_up;
  eps->ops->setupsort = set_up_sort;
  eps->ops->solve = solve;
  eps->ops->backtransform = transform_back;
  eps->ops->computevectors = compute_vectors;
  eps->ops->destroy = destroy;
  PetscFunctionReturn(0);
}

template <class Solver, class Settings>
void set(EPS eps, Settings&& settings) {
  auto* solver = dynamic_cast<Solver*>(&get(eps));
  BOUGH_DEMAND(solver);
  solver->settings = std::forward<Settings>(settings);
}

}  // namespace

void register_eps_types() {
  check_petsc(EPSRegister(kBlockLanczos, create<BlockLanczosSolver>));
  check_petsc(EPSRegister(kLowRank, create<LowRankSolver>));
}

bool is_own_type(EPS eps) {
  PetscBool is = PETSC_FALSE;
  check_petsc(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(eps), &is, kBlockLanczos, kLowRank, ""));
  return is;
}

void set_settings(EPS eps, BlockLanczosSettings settings) { set<BlockLanczosSolver>(eps, std::move(settings)); }

void set_settings(EPS eps, LowRankSettings settings) { set<LowRankSolver>(eps, std::move(settings)); }

MatrixXd take_vectors(EPS eps, VectorXd& values) {
  values = get(eps).values;
  return std::move(get(eps).vectors);
}

std::exception_ptr get_failure(EPS eps) {
  if (is_own_type(eps) && get(eps).failure) return get(eps).failure;
  ST st = nullptr;
  check_petsc(EPSGetST(eps, &st));
  return get_failure(st);
}

}  // namespace bough::modal::detail
