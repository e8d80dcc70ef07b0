#pragma once
/// \file What equilibrium solves: u̇ as a function of the freedoms that may be displaced, with its Jacobian.
#include "base/diagnostic.hpp"
#include "solver/linear/plant.hpp"

namespace bough::solver {

/// The state of a search, at a point of the plant. Hinges that spin keep their angle; modal rates are zero.
/// Displacements are counted in steps of the plant, so that columns of the Jacobian are alike.
class Balance {
 public:
  Balance(Plant& plant, const OperatingPoint& start);

  const Plant& plant() const { return *plant_; }
  const OperatingPoint& point() const { return point_; }
  /// Freedoms that may be displaced; m of n.
  const std::vector<int>& free() const { return free_; }
  const VectorXd& residual() const { return residual_; }  ///< u̇ of all freedoms, n
  const MatrixXd& jacobian() const { return jacobian_; }  ///< ∂u̇ by steps, n x m, of the last linearize
  double step(int j) const { return plant_->step(free_[static_cast<size_t>(j)]); }

  void linearize();
  /// The point displaced by `steps` (m); may throw ComputationError.
  Balance move(const VectorXd& steps) const;
  /// All moves from the start, m, in steps.
  const VectorXd& travel() const { return travel_; }

 private:
  VectorXd calc_residual() const { return plant_->evaluate(point_).head(plant_->num_freedoms()); }

  Plant* plant_;
  OperatingPoint point_;
  std::vector<int> free_;
  VectorXd residual_, travel_;
  MatrixXd jacobian_;
};

}  // namespace bough::solver
