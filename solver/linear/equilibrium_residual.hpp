#pragma once
/// \file Residual of an equilibrium: forces that are not in balance, ż and the changes at samples, as functions of the
/// dofs that may be displaced, of the states of controllers and actuators and of the memory of sampled blocks; with its
/// Jacobian.
#include "base/diagnostic.hpp"
#include "solver/linear/plant.hpp"

namespace bough::solver {

/// The state of a search, at a point of the plant. Hinges that spin keep their angle; modal rates are zero.
/// Displacements are counted in steps of the plant, so that columns of the Jacobian are alike.
class EquilibriumResidual {
 public:
  EquilibriumResidual(Plant& plant, const OperatingPoint& start);

  /// The plant whose equilibrium is sought.
  const Plant& plant() const { return *plant_; }
  /// The present point of the search.
  const OperatingPoint& point() const { return point_; }
  /// Rows: the dofs, then the states, then the steady rows of the memory.
  int size() const {
    return plant_->num_dofs() + plant_->num_signal_states() + static_cast<int>(plant_->steady_rows().size());
  }
  /// Name of a row, for messages.
  std::string name(int row) const;
  /// Rows that may be displaced; m of n.
  const std::vector<int>& free() const { return free_; }
  /// Forces that are not in balance in a steady spin (Plant::calc_imbalance), ż, change of the memory per sample time;
  /// n.
  const VectorXd& residual() const { return residual_; }
  /// Rates of change: u̇ in place of M u̇, else as the residual; n.
  const VectorXd& rates() const { return rates_; }
  /// Round-off of the residual; n.
  VectorXd calc_rounding() const;
  /// Derivatives of residual and rates by steps, n x m, of the last linearize.
  const MatrixXd& jacobian() const { return jacobian_; }
  const MatrixXd& rate_jacobian() const { return rate_jacobian_; }
  /// Step of the displacement j, of m: that of the plant for dofs, 1 for states and memory.
  double step(int j) const {
    const int i = free_[static_cast<size_t>(j)];
    return i < plant_->num_dofs() ? plant_->step(i) : 1;
  }

  /// Computes both Jacobians at the present point, column by column by differences (Plant::differentiate).
  void linearize();
  /// Rows c (k x m) with c · travel = const on every motion, to first order: of what no displacement and no state
  /// changes the rate of, as the integral of a rate, or two integrals of one error. At the last linearize.
  MatrixXd calc_conserved() const;
  /// The point displaced by `steps` (m); may throw ComputationError.
  EquilibriumResidual move(const VectorXd& steps) const;
  /// All moves from the start, m, in steps.
  const VectorXd& travel() const { return travel_; }

 private:
  void evaluate();

  Plant* plant_;
  OperatingPoint point_;
  std::vector<int> free_;
  std::vector<int> used_up_;  ///< states whose rate is set to zero: they are constant, like time
  VectorXd residual_, rates_, travel_;
  MatrixXd jacobian_, rate_jacobian_;
};

}  // namespace bough::solver
