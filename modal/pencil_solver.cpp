#include "modal/pencil_solver.hpp"

#include <algorithm>
#include <cmath>

#include "fe/linear/inertia.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/linear/residual.hpp"
#include "modal/canonical.hpp"
#include "modal/eps_types.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::detail {

PencilSolver::PencilSolver(const PencilProblem& problem, int request) : problem_(problem) {
  const auto k = static_cast<int>(problem.rigid.cols());
  num_available_ = std::max(0, static_cast<int>((problem.M_diagonal.array() > 0).count()) - k);
  C_ = factor_low_rank(problem.M, problem.M_diagonal, std::min(3 * request + 100 + k, 4000));
  if (C_) num_available_ = std::max(0, static_cast<int>(C_->cols()) - k);
}

/// If fewer eigenvalues than requested were found, some may be round-off copies of a repeated eigenvalue, which a
/// Krylov space contains once; those with a large residual are computed again, with the others as known vectors.
void PencilSolver::drop_rough(Extraction& result) const {
  const VectorXd K_diagonal = linear::get_diagonal(problem_.K).cwiseAbs(),
                 M_diagonal = linear::get_diagonal(problem_.M);
  const VectorXd residual = linear::calc_pair_residuals(K_diagonal, M_diagonal, result.values, result.vectors,
                                                        linear::multiply(problem_.K, result.vectors),
                                                        linear::multiply(problem_.M, result.vectors), problem_.kinds);
  std::vector<int> kept;
  for (int j = 0; j < residual.size(); ++j)
    if (residual(j) <= linear::kResidualWarning) kept.push_back(j);
  if (kept.empty() || static_cast<Eigen::Index>(kept.size()) == residual.size()) return;
  result.values = result.values(kept).eval();
  result.vectors = result.vectors(Eigen::all, kept).eval();
}

bool PencilSolver::solve(double shift, int number, int num_guard, bool definite_only, Roots& roots) {
  const int left = num_available_ - roots.size();
  if (left <= 0) return true;
  const bool by_rank = C_ && (problem_.solver.empty() || problem_.solver == kLowRank);
  EigenProblem problem;
  problem.A = problem_.supported ? problem_.supported : problem_.K;
  problem.B = problem_.M;
  problem.shift = -shift;
  problem.max_subspace = left;
  problem.num_wanted = std::min(number, left);
  problem.num_guard = number <= left ? num_guard : 0;
  problem.deflate = by_rank ? problem_.rigid : join(problem_.rigid, roots.X);
  problem.tolerance = problem_.tolerance;
  problem.definite_only = definite_only;
  problem.solver = problem_.solver;
  if (shift == 0 && !problem_.supported && problem_.factor && problem_.factor->is_definite())
    problem.factor = problem_.factor;
  problem.progress = problem_.progress;
  if (by_rank) {
    problem.low_rank = &*C_;
    problem.stiffness = problem_.K;
    problem.projects_deflate = static_cast<bool>(problem_.supported);
    problem.max_subspace = num_available_;
    problem.num_wanted += roots.size();
    if (problem_.rigid.cols() == 0 && !problem_.is_complete) {
      problem.min_energy = shift == 0 ? linear::kMechanismEnergy : kShiftedMechanismEnergy;
      problem.kinds = problem_.kinds;
    }
  } else {
    problem.start = round_++;
    if (problem.start > 0 && number <= kMaxMissingColumns)
      problem.block = std::max(4, number);  // what the first round missed
    problem.release = problem_.release;
    problem.restore = problem_.restore;
  }
  if (shift != last_shift_) {
    factored_.reset();
    num_at_shift_ = 0;
  }
  last_shift_ = shift;
  // A factor that is kept is in memory while roots are counted: only where a first search missed some.
  if (num_at_shift_++ > 0 && !problem.release) problem.kept = &factored_;
  auto result = [&] {
    try {
      return extract(problem);
    } catch (...) {
      if (problem.restore) problem.restore();  // another way may be tried
      throw;
    }
  }();
  if (problem.restore) problem.restore();
  if (result.is_singular) return false;
  add_use(result.by, uses_);
  if (by_rank) {
    roots = {VectorXd(0), MatrixXd(problem_.M_diagonal.size(), 0)};
    roots.add(result.values, std::move(result.vectors));
    return true;
  }
  if (problem_.supported) project_out(problem_.M, problem_.rigid, result.vectors);
  if (problem.start == 0 && !problem_.supported && result.values.size() < problem.num_wanted) drop_rough(result);
  roots.add(result.values, std::move(result.vectors));
  return true;
}

int count_roots_below(const linear::SymmetricMatrix& K, const linear::SymmetricMatrix& M, double mu) {
  for (int attempt = 0; attempt < 4; ++attempt, mu *= 1 + kMoveOfPivot) {
    if (const auto count = linear::count_eigenvalues_below(K, M, mu)) return *count;
  }
  return -1;
}

}  // namespace bough::modal::detail
