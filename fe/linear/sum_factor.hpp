#pragma once
/// \file Solutions with A_0 + U W Uᵀ by a factor of A_0.
///
/// Internal to linear.
#include <Eigen/LU>

#include "fe/linear/factor_solver.hpp"
#include "fe/linear/low_rank_part.hpp"

namespace bough::linear {

/// A⁻¹ = A_0⁻¹ - Y S⁻¹ Yᵀ, Y = A_0⁻¹U, S = W⁻¹ + UᵀY (Sherman, Morrison & Woodbury; Hager, SIAM Rev. 31 (1989) 221).
/// Costs k solutions and n x k numbers, k the rank.
class SumSolver final : public FactorSolver {
 public:
  SumSolver(FactorSolverHandle sparse, const LowRankPart& part);
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const override;
  const char* name() const override { return sparse_->name(); }
  double num_entries() const override { return sparse_->num_entries(); }
  /// Negative eigenvalues of A minus those of A_0: (A_0 U; Uᵀ -W⁻¹) has the inertia of A_0 and -S together, and that of
  /// -W⁻¹ and A (Haynsworth, Linear Algebra Appl. 1 (1968) 73).
  int num_extra_negative() const { return num_extra_negative_; }

 private:
  FactorSolverHandle sparse_;
  Eigen::SparseMatrix<double> U_;
  Eigen::MatrixXd Y_;
  Eigen::VectorXd unit_;  ///< S is scaled by it from both sides
  Eigen::PartialPivLU<Eigen::MatrixXd> S_;
  int num_extra_negative_ = 0;
};

}  // namespace bough::linear
