#pragma once
/// \file Connectors on shells (CFAST, CWELD) at a finite motion: the springs or the beam between two ends that go with
/// the mean of four points each, exactly (docs/theory/nonlinear-statics.md).
#include <array>

#include "fe/corotational/corotational_element.hpp"
#include "fe/corotational/mean_motion.hpp"
#include "fe/elements/connector.hpp"

namespace bough::fe {

class FittedCore {
 public:
  /// `connector`: with ends on shells; read here only.
  explicit FittedCore(const Connector& connector);

  /// Sets f, K, energy and internal of the displacements u (N, basic); max_turn where it is larger.
  void calc_finite(const Eigen::Ref<const VectorXd>& u, FiniteForces& result) const;
  /// Coefficients of ∂V/∂u along curves, as CorotationalElement::calc_forces.
  MatrixXd calc_forces(const Eigen::Ref<const MatrixXd>& u, int top) const;
  /// Internal forces along the curves u (N x 5 m): s x 5 m.
  MatrixXd calc_internal(const Eigen::Ref<const MatrixXd>& u) const;

 private:
  struct End {
    MatrixXd shares;  ///< 4 x nodes
    WeightedMean mean;
    Vector3d arm = Vector3d::Zero();
  };
  static std::vector<Node> list_ends(const Connector& connector);
  MeanMotion calc_mean(const End& end, const Eigen::Ref<const VectorXd>& u) const;
  /// Mean of an end along one curve u, N x k.
  MeanSeries calc_series(const End& end, const Eigen::Ref<const MatrixXd>& u) const;
  MatrixXd calc_core_motion(const Eigen::Ref<const MatrixXd>& u) const;

  std::array<End, 2> ends_;
  CorotationalElement core_;
};

}  // namespace bough::fe
