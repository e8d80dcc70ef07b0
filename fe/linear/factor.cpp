#include "fe/linear/factor.hpp"

#include <utility>

#include "base/diagnostic.hpp"
#include "fe/linear/cholmod_factor.hpp"
#include "fe/linear/mumps.hpp"
#include "fe/linear/sum_factor.hpp"
#include "fe/linear/supernodal_factor.hpp"

namespace bough::linear {
namespace {

/// LLᵀ; null where A is not positive definite, or on several processes.
FactorSolverHandle factor_definite(const SymmetricMatrix& A) {
  if (initialize_petsc().size > 1) return nullptr;
  if (const LowRankPart* part = A.low_rank()) {
    FactorSolverHandle sparse = factor_definite(A.sparse_part());
    if (!sparse) return nullptr;
    auto sum = std::make_unique<SumSolver>(std::move(sparse), *part);
    return sum->num_extra_negative() == 0 ? FactorSolverHandle(std::move(sum)) : nullptr;
  }
  if (SupernodalFactor own = make_supernodal_factor(A); own.solver || !own.is_definite) return std::move(own.solver);
  return factor_by_cholmod(A);
}

}  // namespace

SymmetricFactor::SymmetricFactor(const SymmetricMatrix& A, bool find_null_pivots, FactorMethod method) {
  if (method == FactorMethod::Fastest) solver_ = factor_definite(A);
  is_definite_ = solver_ != nullptr;
  if (is_definite_) return;
  MumpsFactor factor = factor_by_mumps(A.sparse(), {.finds_null_pivots = find_null_pivots});
  if (factor.state == FactorState::NeedsWorkspace)
    throw ComputationError("fe.factorization", {},
                           "the stiffness matrix cannot be factored: pivoting needs more than ten times the workspace",
                           "look for negative springs, and for very soft and very stiff parts side by side");
  is_singular_ = factor.state == FactorState::Singular;
  num_null_pivots_ = factor.num_null_pivots;
  solver_ = std::move(factor.solver);
  if (const LowRankPart* part = A.low_rank(); part && solver_)
    solver_ = std::make_unique<SumSolver>(std::move(solver_), *part);
}

std::optional<SymmetricFactor> SymmetricFactor::try_definite(const SymmetricMatrix& A) {
  SymmetricFactor result;
  result.solver_ = factor_definite(A);
  if (!result.solver_) return std::nullopt;
  result.is_definite_ = true;
  return result;
}

}  // namespace bough::linear
