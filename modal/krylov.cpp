#include "modal/krylov.hpp"

#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <vector>

#include "base/diagnostic.hpp"
#include "fe/linear/factor.hpp"
#include "fe/linear/low_rank_sum.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/own_rows.hpp"
#include "fe/linear/subdomains.hpp"
#include "fe/matrices/assembly.hpp"
#include "modal/block_lanczos.hpp"

namespace bough::modal::detail {

using fe::check_petsc;

namespace {

using SlepcEps = fe::PetscHandle<EPS, EPSDestroy>;

PetscErrorCode apply_factor(PC pc, Vec b, Vec x) {
  Mat factor = nullptr;
  const PetscErrorCode code = PCShellGetContext(pc, static_cast<void*>(&factor));
  if (code != 0) return code;
  if (!fe::is_own_factor(factor)) return MatSolve(factor, b, x);
  fe::scatter(fe::solve_factored(factor, fe::gather(b)).col(0), x);
  return 0;
}

/// Direct solution by a factor that is there already.
void set_known_factor(KSP ksp, Mat factor) {
  PC pc = nullptr;
  check_petsc(KSPSetType(ksp, KSPPREONLY));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCSetType(pc, PCSHELL));
  check_petsc(PCShellSetContext(pc, factor));
  check_petsc(PCShellSetApply(pc, apply_factor));
}

/// Direct solution by MUMPS' LDLᵀ.
void set_mumps(KSP ksp) {
  PC pc = nullptr;
  check_petsc(KSPSetType(ksp, KSPPREONLY));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCSetType(pc, PCCHOLESKY));
  check_petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
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

fe::PetscMat add(Mat A, double factor, Mat B) { return fe::add(A, factor, B); }

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

/// b fixed columns; the first does not depend on b, and a row not on where it is kept.
MatrixXd make_start(const KrylovProblem& problem, int b, const fe::Subdomains* domains = nullptr) {
  PetscInt n = 0;
  check_petsc(MatGetSize(problem.A, &n, nullptr));
  if (domains) n = domains->num_own();
  MatrixXd start(n, b);
  for (int c = 0; c < b; ++c)
    for (int i = 0; i < n; ++i)
      start(i, c) = calc_fixed_number(domains ? domains->get_row(i) : i, problem.start + 1000 * c);
  return start;
}

Mat get_factor(EPS eps) {
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  Mat factor = nullptr;
  check_petsc(EPSGetST(eps, &st));
  check_petsc(STGetKSP(st, &ksp));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCFactorGetMatrix(pc, &factor));
  return factor;
}

bool is_sum(const KrylovProblem& problem) { return fe::find_low_rank(problem.A) || fe::find_low_rank(problem.B); }

/// By MUMPS, any signs.
fe::SymmetricFactor make_pivoted_factor(const KrylovProblem& problem) {
  const bool is_near = problem.spectrum == Spectrum::NearShift;
  return {is_near ? fe::add(problem.A, -problem.shift, problem.B).get() : problem.B, false, fe::FactorMethod::Pivoting};
}

/// A definite factor of the matrix that is factored; empty where it is not definite, or there are several processes.
fe::PetscMat make_definite_factor(const KrylovProblem& problem) {
  if (problem.spectrum != Spectrum::NearShift) return fe::factor_definite(problem.B);
  if (problem.shift == 0) return fe::factor_definite(problem.A);
  const fe::PetscMat shifted = fe::add(problem.A, -problem.shift, problem.B);
  fe::PetscMat factor = fe::factor_definite(shifted.get());
  fe::copy_row_groups(fe::get_sparse(shifted.get()), fe::get_sparse(problem.A));  // the count takes its dissection
  return factor;
}

/// SLEPc, set up with a factor of ours or, without one, with MUMPS; empty when MUMPS finds the matrix singular or SLEPc
/// refuses (a subspace as large as the problem).
SlepcEps set_up(const KrylovProblem& problem, Mat factor, int wanted, int subspace, bool& is_singular) {
  ST st = nullptr;
  KSP ksp = nullptr;
  SlepcEps eps;
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
    const bool is_signed = problem.spectrum == Spectrum::LargestPositive;
    check_petsc(EPSSetWhichEigenpairs(eps.get(), is_signed ? EPS_LARGEST_REAL : EPS_LARGEST_MAGNITUDE));
  }
  if (is_sum(problem)) check_petsc(STSetMatMode(st, ST_MATMODE_SHELL));  // the matrix that is factored is ours
  check_petsc(STGetKSP(st, &ksp));
  if (factor)
    set_known_factor(ksp, factor);
  else
    set_mumps(ksp);

  std::vector<fe::PetscVec> known;
  std::vector<Vec> known_raw;
  for (Eigen::Index c = 0; c < problem.deflate.cols(); ++c) {
    known.push_back(make_vector(problem.A, problem.deflate.col(c)));
    known_raw.push_back(known.back().get());
  }
  if (!known_raw.empty())
    check_petsc(EPSSetDeflationSpace(eps.get(), static_cast<PetscInt>(known_raw.size()), known_raw.data()));

  fe::PetscVec first_vector = make_vector(problem.A, make_start(problem, 1));
  Vec first_raw = first_vector.get();
  check_petsc(EPSSetInitialSpace(eps.get(), 1, &first_raw));

  const PetscErrorCode code = EPSSetUp(eps.get());
  is_singular = code == PETSC_ERR_LIB;  // a zero pivot: SLEPc makes that an error
  if (code != 0) return {};
  return eps;
}

/// A product or a solution of several vectors.
using Apply = std::function<MatrixXd(const Eigen::Ref<const MatrixXd>&)>;

/// x = (λ - σ)(A - σB)⁻¹B x: removes what a semi-definite B lets into the vectors unseen (Nour-Omid et al., Math. Comp.
/// 48 (1987) 663). A solve of eight right-hand sides costs a sixth of eight solves.
void purify(const KrylovProblem& problem, const Apply& solve, const Apply& multiply_mass, KrylovResult& result) {
  const VectorXd scale = result.values.array() - problem.shift;
  constexpr Eigen::Index kBlock = 8;  // as many as a solution takes at once
  for (Eigen::Index first = 0; first < scale.size(); first += kBlock) {
    auto X = result.vectors.middleCols(first, std::min(kBlock, scale.size() - first));
    X = solve(multiply_mass(X)) * scale.segment(first, X.cols()).asDiagonal();
  }
}

Apply solve_by(Mat factor) {
  return [factor](const Eigen::Ref<const MatrixXd>& X) { return fe::solve_factored(factor, X); };
}
Apply multiply_by(Mat A) {
  return [A](const Eigen::Ref<const MatrixXd>& X) { return fe::multiply(A, X); };
}

/// Of the largest 1/(λ - shift): smaller ones have no digit, and beyond the rank of B are roundoff (1.5e-15 was seen).
constexpr double kNoDigit = 1e-14;

/// Nothing when SLEPc gives up: a subspace beyond the rank of B, where its inner product is roundoff.
std::optional<KrylovResult> solve_one_vector(const KrylovProblem& problem, Mat factor, int wanted, int room) {
  // 2.6 vectors a mode: the lowest modes of a plate are there before the first restart.
  const int subspace = std::min(std::max(13 * wanted / 5, wanted + 20), std::max(room, 1));
  KrylovResult result;
  const SlepcEps eps = set_up(problem, factor, wanted, subspace, result.is_singular);
  if (result.is_singular) return result;
  if (!eps) return std::nullopt;
  Watch watch{problem.progress, wanted};
  if (watch.progress) check_petsc(EPSMonitorSet(eps.get(), report_progress, &watch, nullptr));
  if (EPSSolve(eps.get()) != 0) return std::nullopt;

  PetscInt converged = 0, n = 0;
  check_petsc(MatGetSize(problem.A, &n, nullptr));
  check_petsc(EPSGetConverged(eps.get(), &converged));
  if (converged == 0) return std::nullopt;
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
  if (problem.spectrum != Spectrum::NearShift) return result;
  const VectorXd distance = (result.values.array() - problem.shift).abs();
  std::vector<int> kept;
  for (PetscInt i = 0; i < converged; ++i)
    if (kNoDigit * distance(i) < distance.minCoeff()) kept.push_back(i);
  if (static_cast<PetscInt>(kept.size()) < converged) {
    result.values = VectorXd(result.values(kept));
    result.vectors = MatrixXd(result.vectors(Eigen::all, kept));
  }
  purify(problem, solve_by(factor ? factor : get_factor(eps.get())), multiply_by(problem.B), result);
  return result;
}

/// Above this size a solve of one right-hand side mostly waits for the factor's entries.
constexpr int kBlockSize = 5000;
/// Of vectors that large: values are right to its square, and roundoff of K alone turns them further. Not where a shift
/// stands for supports: what is left of stiff parts in a vector counts by their stiffness over the shift.
constexpr double kBlockTolerance = 1e-10;

/// What the vectors of Lanczos meet: replicated ones, or the rows that `domains` gives to each rank.
struct Operators {
  Apply solve, multiply_mass, multiply_operator;
  const fe::Subdomains* domains = nullptr;
};

/// Nothing when the blocks did not converge.
std::optional<KrylovResult> solve_blocks(const KrylovProblem& problem, const Operators& by, int wanted) {
  const bool is_near = problem.spectrum == Spectrum::NearShift;
  fe::release_freed_memory();
  BlockLanczosProblem blocks;
  blocks.solve = by.solve;
  blocks.multiply_mass = by.multiply_mass;
  if (!is_near) blocks.multiply_operator = by.multiply_operator;
  if (by.domains) blocks.sum = fe::sum_alike;
  blocks.positive_only = problem.spectrum == Spectrum::LargestPositive;
  blocks.start = make_start(problem,
                            problem.block > 0 ? std::min(problem.block, wanted)
                            : wanted > 100    ? 8
                                              : 4,
                            by.domains);
  blocks.deflate = by.domains ? by.domains->from_rows(problem.deflate) : problem.deflate;
  blocks.num_wanted = wanted;
  blocks.num_guard = std::min(problem.num_guard, wanted - 1);
  // The vectors are the most of the memory beside the factor: for few modes a restart costs next to nothing.
  blocks.max_subspace = 11 * wanted / 5 + std::clamp(wanted, 24, 60);
  // Of all ranks together: they must agree.
  PetscInt size = 0;
  check_petsc(MatGetSize(problem.A, &size, nullptr));
  const bool is_large = is_near && problem.shift == 0 && size >= kBlockSize;
  blocks.tolerance = is_large ? std::max(problem.tolerance, kBlockTolerance) : problem.tolerance;
  blocks.progress = problem.progress;
  const bool positive_only = blocks.positive_only;
  BlockLanczosResult found = solve_block_lanczos(std::move(blocks));
  if (!found.is_done) return std::nullopt;
  KrylovResult result;
  const double largest = found.theta.size() > 0 ? found.theta.cwiseAbs().maxCoeff() : 0;
  std::vector<int> kept;
  for (int i = 0; i < found.theta.size(); ++i)
    if (std::abs(found.theta(i)) > kNoDigit * largest && (!positive_only || found.theta(i) > 0)) kept.push_back(i);
  const VectorXd theta = found.theta(kept);
  result.values = is_near ? VectorXd(theta.cwiseInverse().array() + problem.shift) : theta;
  result.vectors = kept.size() == static_cast<std::size_t>(found.theta.size()) ? std::move(found.X)
                                                                               : MatrixXd(found.X(Eigen::all, kept));
  found.X.resize(0, 0);
  fe::release_freed_memory();  // of the vectors that are left out
  if (is_near) purify(problem, by.solve, by.multiply_mass, result);
  if (by.domains) result.vectors = by.domains->to_rows(result.vectors);
  return result;
}

std::optional<KrylovResult> solve_blocks(const KrylovProblem& problem, Mat factor, int wanted) {
  const Operators by{solve_by(factor), multiply_by(problem.B), multiply_by(problem.A)};
  if (!problem.release || problem.spectrum != Spectrum::NearShift) return solve_blocks(problem, by, wanted);
  problem.release();
  auto result = solve_blocks(problem, by, wanted);
  if (!result) problem.restore();
  return result;
}

/// Whether LLᵀ of A went through although A is singular, for roundoff that is positive: then the solution of a load on
/// all rows is a motion that strains next to nothing, and Lanczos would see little else. As find_first() judges it.
bool is_soft(const KrylovProblem& problem, const fe::SubdomainFactor& factor, const fe::Subdomains& domains) {
  const VectorXd diagonal = fe::get_diagonal(problem.A);
  MatrixXd load = make_start(problem, 1, &domains);
  VectorXd own(load.rows());
  for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = diagonal[domains.get_row(static_cast<PetscInt>(i))];
  load = own.asDiagonal() * load;
  const MatrixXd x = factor.solve(load);
  MatrixXd sums(1, 2);
  sums << x.col(0).dot(load.col(0)), x.col(0).dot(own.cwiseProduct(x.col(0)));
  fe::sum_alike(sums);
  return !std::isfinite(sums(0, 1)) || !(std::abs(sums(0, 0)) > 1e-13 * sums(0, 1));
}

/// Every rank on its part of the rows, with the factor in substructures. Nothing where there are no parts or the blocks
/// did not converge; where A - shift B is not definite, nothing or, with `definite_only`, a singular result.
std::optional<KrylovResult> solve_in_parts(const KrylovProblem& problem, int wanted) {
  const auto domains = fe::find_subdomains(problem.A, problem.B);
  if (!domains) return std::nullopt;
  const fe::PetscMat shifted = problem.shift == 0 ? fe::PetscMat() : fe::add(problem.A, -problem.shift, problem.B);
  const fe::SubdomainFactor factor(shifted ? shifted.get() : problem.A, *domains);
  if (!factor.is_definite() || (problem.definite_only && problem.shift == 0 && is_soft(problem, factor, *domains))) {
    if (!problem.definite_only) return std::nullopt;
    KrylovResult result;
    result.is_singular = true;
    return result;
  }
  const fe::SubdomainMatrix B(problem.B, *domains);
  const Operators by{[&](const Eigen::Ref<const MatrixXd>& X) { return factor.solve(X); },
                     [&](const Eigen::Ref<const MatrixXd>& X) { return B.multiply(X); },
                     {},
                     &*domains};
  return solve_blocks(problem, by, wanted);
}

/// How many roots are asked for, of how many there may be, and whether blocks are for them.
struct Request {
  int room = 0, wanted = 0;
  bool by_blocks = false;
};

Request find_request(const KrylovProblem& problem) {
  PetscInt n = 0;
  check_petsc(MatGetSize(problem.A, &n, nullptr));
  Request request;
  request.room = problem.max_subspace > 0 ? std::min<int>(problem.max_subspace, n) : static_cast<int>(n);
  request.wanted = std::clamp(problem.num_wanted, 1, std::max(1, request.room));
  request.by_blocks = problem.method == KrylovMethod::Blocks ||
                      (problem.method == KrylovMethod::Fastest && (n >= kBlockSize || problem.block > 0) &&
                       4 * request.wanted < request.room);
  return request;
}

/// With whole vectors.
KrylovResult solve_whole(const KrylovProblem& problem) {
  const auto [room, wanted, by_blocks] = find_request(problem);
  const bool is_alone = fe::initialize_petsc().size == 1;
  fe::PetscMat own_factor;
  if (!problem.factor && is_alone) own_factor = make_definite_factor(problem);
  Mat factor = problem.factor ? problem.factor : own_factor.get();
  const auto make_singular = [] {
    KrylovResult result;
    result.is_singular = true;
    return result;
  };
  if (!factor && is_alone && problem.definite_only) return make_singular();
  std::optional<fe::SymmetricFactor> pivoted;  // not definite, or on several processes
  const auto is_singular = [&] {
    if (!factor) factor = pivoted.emplace(make_pivoted_factor(problem)).get();
    return pivoted && pivoted->is_singular();
  };
  if (!factor && is_sum(problem) && is_singular()) return make_singular();  // SLEPc factors sparse matrices alone
  const bool prefers_blocks = by_blocks && factor && !pivoted && is_alone && problem.spectrum == Spectrum::NearShift;
  if (prefers_blocks)
    if (auto result = solve_blocks(problem, factor, wanted)) return std::move(*result);
  if (problem.method != KrylovMethod::Blocks || prefers_blocks)
    if (auto result = solve_one_vector(problem, factor, wanted, room)) return std::move(*result);
  if (!prefers_blocks) {
    if (is_singular()) return make_singular();
    if (auto result = solve_blocks(problem, factor, wanted)) return std::move(*result);
  }
  throw ComputationError("modal.no-convergence", {},
                         "the eigenvalue solver found no " + std::to_string(wanted) + " modes: it did not converge",
                         "ask for fewer modes; look for parts that nothing holds, and for very soft beside very stiff "
                         "ones");
}

}  // namespace

KrylovResult solve_krylov(const KrylovProblem& problem) {
  initialize_slepc();
  if (fe::initialize_petsc().size == 1) return solve_whole(problem);
  const Request request = find_request(problem);
  if (request.by_blocks && !problem.factor && problem.spectrum == Spectrum::NearShift)
    if (auto result = solve_in_parts(problem, request.wanted)) return std::move(*result);
  const fe::OwnRows rows = fe::find_own_rows(problem.A);
  if (!rows.is_cut) return solve_whole(problem);
  KrylovProblem whole = problem;
  whole.deflate = rows.replicate(problem.deflate);
  KrylovResult result = solve_whole(whole);
  if (result.vectors.rows() == rows.size) result.vectors = rows.take(result.vectors);
  return result;
}

}  // namespace bough::modal::detail
