#pragma once
/// \file Interface of what solves with a factor of a symmetric matrix.
///
/// Internal to linear; outside there is SymmetricFactor (factor.hpp).
#include <memory>

#include "fe/linear/ranks.hpp"

namespace bough::linear {

class FactorSolver {
 public:
  virtual ~FactorSolver() = default;
  /// X with A X = B; B num_rows x m, replicated on every rank, and so is X.
  virtual Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const = 0;
  /// Solves for a vector in PETSc's distribution.
  virtual void solve_vector(Vec b, Vec x) const { scatter(solve(gather(b)).col(0), x); }
  virtual const char* name() const = 0;    ///< library and method
  virtual double num_entries() const = 0;  ///< of the factor, on this rank
};
using FactorSolverHandle = std::unique_ptr<FactorSolver>;

}  // namespace bough::linear
