#include "modal/extraction.hpp"

#include <slepc/private/epsimpl.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/fixed_number.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/ranks.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "modal/eps_types.hpp"
#include "modal/factored_transform.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::detail {

using linear::check_petsc;

namespace {

using SlepcEps = linear::PetscHandle<EPS, EPSDestroy>;

/// Above this size a solve of one right-hand side mostly waits for the factor's entries.
constexpr PetscInt kBlockRows = 5000;

}  // namespace

void initialize_slepc() {
  linear::initialize_petsc();
  PetscBool initialized = PETSC_FALSE;
  SlepcInitialized(&initialized);
  if (initialized) return;
  int argc = 0;
  char** argv = nullptr;
  check_petsc(SlepcInitialize(&argc, &argv, nullptr, nullptr));
  check_petsc(EPSInitializePackage());
  register_factored_transform();
  register_eps_types();
  std::atexit([] {
    PetscBool finalized = PETSC_FALSE;
    PetscFinalized(&finalized);
    if (!finalized) SlepcFinalize();
  });
}

std::string choose_solver(const SolverFacts& facts) {
  if (facts.has_low_rank) return kLowRank;
  const bool is_worth_blocks = facts.num_rows >= kBlockRows || facts.has_many_copies;
  if (facts.is_near_shift && facts.is_definite && is_worth_blocks && 4 * facts.num_wanted < facts.room)
    return kBlockLanczos;
  return EPSKRYLOVSCHUR;
}

/// The factored matrix and the objects that apply its factor. Members point at each other: not movable.
struct Factored {
  FactoredOperator op;
  bool is_definite = false, is_singular = false;
  std::optional<linear::SymmetricFactor> own;
};

namespace {

bool is_near(const EigenProblem& problem) { return problem.spectrum == Spectrum::NearShift; }

PetscInt get_size(const EigenProblem& problem) { return problem.A.num_rows(); }

/// b fixed columns; the first does not depend on b.
MatrixXd make_start(const EigenProblem& problem, int b) {
  const PetscInt n = get_size(problem);
  MatrixXd start(n, b);
  for (int c = 0; c < b; ++c)
    for (int i = 0; i < n; ++i) start(i, c) = linear::calc_fixed_number(i, problem.start + 1000 * c);
  return start;
}

BlockApply multiply_by(const linear::SymmetricMatrix& A) {
  return [A](const Eigen::Ref<const MatrixXd>& X) { return linear::multiply(A, X); };
}

/// The caller's factor, else LLᵀ by CHOLMOD on one process, else LDLᵀ by MUMPS.
FactoredHandle factor(const EigenProblem& problem) {
  auto made = std::make_shared<Factored>();
  const bool is_alone = linear::initialize_petsc().size == 1;
  linear::SymmetricMatrix shifted;
  if (is_near(problem) && problem.shift != 0) shifted = linear::add(problem.A, -problem.shift, problem.B);
  const linear::SymmetricMatrix F = !is_near(problem) ? problem.B : shifted ? shifted : problem.A;
  const linear::SymmetricFactor* factor = problem.factor;
  if (!factor && is_alone) {
    made->own = linear::SymmetricFactor::try_definite(F);
    if (shifted) linear::copy_row_order(shifted, problem.A);  // the count takes its dissection
    if (!made->own && problem.definite_only) {
      made->is_singular = true;
      return made;
    }
  }
  if (!factor && !made->own) made->own.emplace(F, false, linear::FactorMethod::Pivoting);
  if (!factor) factor = &*made->own;
  made->is_definite = factor->is_definite();
  made->is_singular =
      factor->is_singular() ||
      (problem.min_energy > 0 && linear::calc_softest_energy(F, problem.kinds, *factor) < problem.min_energy);
  if (made->is_singular) return made;
  made->op.factor = factor;
  made->op.solve = [factor](const Eigen::Ref<const MatrixXd>& X) { return factor->solve(X); };
  made->op.multiply_mass = multiply_by(problem.B);
  if (!is_near(problem)) made->op.multiply_operator = multiply_by(problem.A);
  made->op.factor_name = factor->name();
  return made;
}

linear::PetscVec make_vector(const linear::SymmetricMatrix& A, const Eigen::Ref<const VectorXd>& values) {
  linear::PetscVec v;
  check_petsc(MatCreateVecs(A.sparse(), v.out(), nullptr));
  linear::scatter(values, v.get());
  return v;
}

struct Watch {
  std::function<void(int, int)> progress;
  int num_modes = 0;
};

PetscErrorCode report_progress(EPS, PetscInt, PetscInt converged, PetscScalar*, PetscScalar*, PetscReal*, PetscInt,
                               void* context) {
  const auto* watch = static_cast<const Watch*>(context);
  watch->progress(std::min(static_cast<int>(converged), watch->num_modes), watch->num_modes);
  return 0;
}

PetscErrorCode apply_preconditioner(PC pc, Vec b, Vec x) {
  void* context = nullptr;
  if (const PetscErrorCode code = PCShellGetContext(pc, &context); code != 0) return code;
  std::exception_ptr failure;
  return run_guarded(failure, [&] {
    linear::scatter(static_cast<const FactoredOperator*>(context)->solve(MatrixXd(linear::gather(b))).col(0), x);
  });
}

/// x = (λ - σ)(A - σB)⁻¹B x: removes what a semi-definite B lets into the vectors unseen (Nour-Omid et al., Math. Comp.
/// 48 (1987) 663). A solve of eight right-hand sides costs a sixth of eight solves.
void purify(const EigenProblem& problem, const FactoredOperator& op, Extraction& result) {
  const VectorXd scale = result.values.array() - problem.shift;
  constexpr Eigen::Index kBlock = 8;  // as many as a solution takes at once
  for (Eigen::Index first = 0; first < scale.size(); first += kBlock) {
    auto X = result.vectors.middleCols(first, std::min(kBlock, scale.size() - first));
    X = op.solve(op.multiply_mass(X)) * scale.segment(first, X.cols()).asDiagonal();
  }
}

/// Removes eigenpairs that are round-off or have the wrong sign.
void drop_roundoff(const EigenProblem& problem, Extraction& result) {
  const VectorXd theta = is_near(problem) ? VectorXd((result.values.array() - problem.shift).inverse()) : result.values;
  const double largest = theta.size() > 0 ? theta.cwiseAbs().maxCoeff() : 0;
  const bool positive_only = problem.spectrum == Spectrum::LargestPositive;
  std::vector<int> kept;
  for (int i = 0; i < theta.size(); ++i)
    if (std::abs(theta(i)) > kNoDigit * largest && (!positive_only || theta(i) > 0)) kept.push_back(i);
  if (static_cast<Eigen::Index>(kept.size()) == theta.size()) return;
  result.values = VectorXd(result.values(kept));
  result.vectors = MatrixXd(result.vectors(Eigen::all, kept));
}

/// One solution by SLEPc.
class EpsRun {
 public:
  EpsRun(const EigenProblem& problem, FactoredOperator& op, const std::string& type, int num_modes, int room)
      : problem_(problem), op_(op), wanted_(num_modes), room_(room) {
    check_petsc(EPSCreate(PETSC_COMM_WORLD, eps_.out()));
    check_petsc(EPSSetOperators(eps(), A_.get(), B_.get()));
    check_petsc(EPSSetProblemType(eps(), EPS_GHEP));
    check_petsc(EPSSetType(eps(), type.c_str()));
    is_preconditioned_ = eps()->categ == EPS_CATEGORY_PRECOND;
    deflation_ = problem.deflate;
    set_spectrum();
    set_transform();
    set_dimensions(type);
    if (watch_.progress) check_petsc(EPSMonitorSet(eps(), report_progress, &watch_, nullptr));
    check_petsc(EPSSetFromOptions(eps()));
  }

  EpsRun(const EpsRun&) = delete;
  EpsRun& operator=(const EpsRun&) = delete;
  ~EpsRun() { op_.deflation = nullptr; }  // is of this run

  /// Nothing where SLEPc gives up; why it does then in `reason`.
  std::optional<Extraction> run(std::string& reason) {
    const PetscErrorCode code = EPSSolve(eps());
    if (const auto failure = get_failure(eps())) std::rethrow_exception(failure);
    EPSConvergedReason end = EPS_CONVERGED_ITERATING;
    PetscInt converged = 0;
    if (code == 0) {
      check_petsc(EPSGetConvergedReason(eps(), &end));
      check_petsc(EPSGetConverged(eps(), &converged));
    }
    const bool is_own = is_own_type(eps());
    reason = code != 0 ? linear::get_petsc_message(code) : "it did not converge";
    if (code != 0 || (is_own ? end < 0 : converged == 0)) return std::nullopt;
    Extraction result;
    if (is_own) {
      result.vectors = take_vectors(eps(), result.values);
      linear::release_freed_memory();  // of the vectors that are left out
    } else {
      copy_pairs(converged, result);
    }
    PetscBool is_low_rank = PETSC_FALSE;
    check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(eps()), kLowRank, &is_low_rank));
    if (!is_low_rank) {  // of low rank, each vector is in the range of (A - σB)⁻¹B already
      drop_roundoff(problem_, result);
      if (is_near(problem_)) purify(problem_, op_, result);
    }
    result.by = describe();
    return result;
  }

 private:
  EPS eps() const { return eps_.get(); }

  void set_spectrum() {
    check_petsc(EPSSetTarget(eps(), problem_.shift));
    if (is_near(problem_)) {
      check_petsc(EPSSetWhichEigenpairs(eps(), is_preconditioned_ ? EPS_SMALLEST_REAL : EPS_TARGET_MAGNITUDE));
      check_petsc(EPSSetPurify(eps(), PETSC_FALSE));  // done for all vectors at once
    } else {
      const bool is_signed = problem_.spectrum == Spectrum::LargestPositive;
      check_petsc(
          EPSSetWhichEigenpairs(eps(), is_signed || is_preconditioned_ ? EPS_LARGEST_REAL : EPS_LARGEST_MAGNITUDE));
    }
  }

  void set_transform() {
    ST st = nullptr;
    check_petsc(EPSGetST(eps(), &st));
    check_petsc(STSetShift(st, problem_.shift));  // the EPS' target alone is a shift to SLEPc's own types
    if (!is_preconditioned_) return set_operator(st, op_);
    KSP ksp = nullptr;
    PC pc = nullptr;
    check_petsc(STSetType(st, STPRECOND));
    check_petsc(STGetKSP(st, &ksp));
    check_petsc(KSPSetType(ksp, KSPPREONLY));
    check_petsc(KSPGetPC(ksp, &pc));
    check_petsc(PCSetType(pc, PCSHELL));
    check_petsc(PCShellSetContext(pc, &op_));
    check_petsc(PCShellSetApply(pc, apply_preconditioner));
  }

  void set_dimensions(const std::string& type) {
    constexpr PetscInt kMaxRestarts = 300, kMaxBlockRestarts = 100;
    if (type == kBlockLanczos) {
      const bool is_large = is_near(problem_) && problem_.shift == 0 && get_size(problem_) >= kBlockRows;
      check_petsc(EPSSetDimensions(eps(), wanted_, PETSC_DEFAULT, PETSC_DEFAULT));
      check_petsc(EPSSetTolerances(eps(), is_large ? std::max(problem_.tolerance, kBlockTolerance) : problem_.tolerance,
                                   kMaxBlockRestarts));
      linear::release_freed_memory();
      BlockLanczosSettings settings;
      settings.start = make_start(problem_, problem_.block > 0 ? std::min(problem_.block, wanted_)
                                            : wanted_ > 100    ? 8
                                                               : 4);
      settings.deflation = std::move(deflation_);
      settings.num_guard = problem_.num_guard;
      // The vectors are the most of the memory next to the factor: for few modes a restart has negligible cost.
      settings.max_subspace = 11 * wanted_ / 5 + std::clamp(wanted_, 24, 60);
      settings.positive_only = problem_.spectrum == Spectrum::LargestPositive;
      if (is_near(problem_)) settings.release = problem_.release;
      set_settings(eps(), std::move(settings));
      return;
    }
    if (type == kLowRank) {
      check_petsc(EPSSetDimensions(eps(), wanted_, PETSC_DEFAULT, PETSC_DEFAULT));
      check_petsc(EPSSetTolerances(eps(), problem_.tolerance, PETSC_DEFAULT));
      set_settings(eps(), LowRankSettings{problem_.stiffness, problem_.B, problem_.low_rank, std::move(deflation_),
                                          problem_.projects_deflate});
      return;
    }
    const bool is_dense = type == EPSLAPACK;
    // 2.6 vectors a mode: the lowest modes of a plate are there before the first restart.
    const int subspace = std::min(std::max(13 * wanted_ / 5, wanted_ + 20), std::max(room_, 1));
    const bool has_subspace = type == EPSKRYLOVSCHUR || type == EPSLANCZOS || type == EPSARNOLDI;
    check_petsc(EPSSetDimensions(eps(), wanted_, has_subspace ? subspace : PETSC_DEFAULT, PETSC_DEFAULT));
    check_petsc(EPSSetTolerances(
        eps(), is_preconditioned_ ? std::max(problem_.tolerance, kPreconditionedTolerance) : problem_.tolerance,
        has_subspace ? kMaxRestarts : PETSC_DEFAULT));
    if (is_dense) {  // needs no deflation space: the operator projects it out
      op_.deflation = &deflation_;
      return;
    }
    std::vector<linear::PetscVec> known;
    std::vector<Vec> known_raw;
    for (Eigen::Index c = 0; c < deflation_.cols(); ++c) {
      known.push_back(make_vector(problem_.A, deflation_.col(c)));
      known_raw.push_back(known.back().get());
    }
    if (!known_raw.empty())
      check_petsc(EPSSetDeflationSpace(eps(), static_cast<PetscInt>(known_raw.size()), known_raw.data()));
    if (type == EPSLANCZOS) check_petsc(EPSLanczosSetReorthog(eps(), EPS_LANCZOS_REORTHOG_FULL));
    MatrixXd start = make_start(problem_, 1);
    if (type == EPSLOBPCG) {
      // Start vectors for all columns of the blocks, in the range of F⁻¹B, which the iteration does not leave: B may be
      // singular.
      const int block = std::min(16, wanted_);
      start = op_.solve(op_.multiply_mass(make_start(problem_, ((wanted_ - 1) / block + 2) * block)));
    }
    std::vector<linear::PetscVec> first;
    std::vector<Vec> first_raw;
    for (Eigen::Index c = 0; c < start.cols(); ++c) {
      first.push_back(make_vector(problem_.A, start.col(c)));
      first_raw.push_back(first.back().get());
    }
    check_petsc(EPSSetInitialSpace(eps(), static_cast<PetscInt>(first_raw.size()), first_raw.data()));
  }

  /// In the EPS' order; no more than are wanted of a solver that finds every one.
  void copy_pairs(PetscInt converged, Extraction& result) const {
    const PetscInt n = get_size(problem_);
    const PetscInt number = converged == n ? std::min<PetscInt>(converged, wanted_) : converged;
    result.values.resize(number);
    result.vectors.resize(n, number);
    linear::PetscVec x;
    check_petsc(MatCreateVecs(problem_.A.sparse(), x.out(), nullptr));
    for (PetscInt i = 0; i < number; ++i) {
      PetscScalar value = 0;
      check_petsc(EPSGetEigenpair(eps(), i, &value, nullptr, x.get(), nullptr));
      if (const auto failure = get_failure(eps())) std::rethrow_exception(failure);
      result.values(i) = value;
      result.vectors.col(i) = linear::gather(x.get());
    }
  }

  SolverUse describe() const {
    const char *eps_type = nullptr, *st_type = nullptr;
    ST st = nullptr;
    check_petsc(EPSGetType(eps(), &eps_type));
    check_petsc(EPSGetST(eps(), &st));
    check_petsc(STGetType(st, &st_type));
    return {eps_type, st_type, op_.factor_name, 1};
  }

  const EigenProblem& problem_;
  FactoredOperator& op_;
  const linear::PetscMat A_ = make_operator(problem_.A), B_ = make_operator(problem_.B);
  int wanted_, room_;
  bool is_preconditioned_ = false;
  MatrixXd deflation_;
  Watch watch_{problem_.progress, wanted_};
  SlepcEps eps_;
};

/// The EPS type that the caller or PETSC_OPTIONS ask for; empty: none.
std::string find_requested(const EigenProblem& problem) {
  char type[256] = "";
  PetscBool is_set = PETSC_FALSE;
  check_petsc(PetscOptionsGetString(nullptr, nullptr, "-eps_type", type, sizeof type, &is_set));
  return is_set ? find_eps_type(type) : problem.solver;
}

[[noreturn]] void throw_unsuited(const std::string& type, const std::string& why) {
  throw ComputationError("modal.unsuited-solver", {}, "SLEPc's eigensolver " + type + " found no modes: " + why,
                         "choose another, or leave --solver out: then Bough chooses one for the model");
}

}  // namespace

Extraction extract(const EigenProblem& problem) {
  initialize_slepc();
  const PetscInt size = get_size(problem);
  const int room = problem.max_subspace > 0 ? std::min<int>(problem.max_subspace, size) : static_cast<int>(size);
  const int num_modes = std::clamp(problem.num_wanted, 1, std::max(1, room));
  const std::string requested = find_requested(problem);
  if (requested == kLowRank && !problem.low_rank)
    throw_unsuited(requested, "the mass matrix has no low rank, or the problem is not one of normal modes");

  SolverFacts facts;
  facts.has_low_rank = problem.low_rank;
  facts.is_near_shift = is_near(problem);
  facts.num_rows = size;
  facts.num_wanted = num_modes;
  facts.room = room;
  facts.has_many_copies = problem.block > 0;
  const auto choose = [&] { return requested.empty() ? choose_solver(facts) : requested; };
  FactoredHandle factored = problem.kept ? *problem.kept : nullptr;
  if (!factored) factored = factor(problem);
  if (factored->is_singular) {
    Extraction singular;
    singular.is_singular = true;
    return singular;
  }
  facts.is_definite = factored->is_definite;
  if (problem.kept) *problem.kept = factored;

  std::string type = choose(), reason;
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (auto result = EpsRun(problem, factored->op, type, num_modes, room).run(reason)) return std::move(*result);
    if (!requested.empty()) throw_unsuited(requested, reason);
    if (problem.restore) problem.restore();
    type = type == EPSKRYLOVSCHUR ? kBlockLanczos : EPSKRYLOVSCHUR;
  }
  throw ComputationError(
      "modal.no-convergence", {},
      "the eigenvalue solver found no " + std::to_string(num_modes) + " modes: it did not converge",
      "ask for fewer modes; look for parts that nothing holds, and for very soft parts next to very stiff "
      "ones");
}

}  // namespace bough::modal::detail
