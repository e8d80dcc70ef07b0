#pragma once
/// \file Stresses and strains of an element at its recovery points.
#include <vector>

#include <Eigen/Dense>

#include "fe/sections/stress.hpp"

namespace bough::fe {

using Eigen::MatrixXd;

/// Stresses and strains, linear in the internal forces of the StressState: forces is s x m, a column per load. The rows
/// of a result are all components of the first point, then those of the next.
class StressRecovery {
 public:
  /// Points and components of the stresses (fe/sections/stress.hpp).
  virtual std::vector<StressPoint> stress_points() const = 0;
  /// Stresses at the points, in the order of stress_points().
  virtual MatrixXd calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const = 0;
  /// Stresses at the corners of internal forces: components of stress_points() x corners; empty if the element gives
  /// none there.
  virtual MatrixXd calc_corner_stresses(const Eigen::Ref<const Eigen::VectorXd>& /*force*/) const { return {}; }
  /// Points of the strains: stress_points(), and for shells the reference surface ("mid").
  virtual std::vector<StressPoint> strain_points() const { return stress_points(); }
  /// Mechanical strains, without the free expansion of the material, so that σ = C ε.
  virtual MatrixXd calc_strains(const Eigen::Ref<const MatrixXd>& forces) const = 0;

 protected:
  ~StressRecovery() = default;
};

}  // namespace bough::fe
