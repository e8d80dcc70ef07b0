#pragma once
/// \file Grids that go with the weighted mean of others (RBE3) along a curve (docs/theory/third-order.md, "Means").
#include <vector>

#include "fe/corotational/series.hpp"
#include "fe/elements/element.hpp"

namespace bough::fe {

/// A grid of the mean of an RBE3.
struct MeanMember {
  int node = 0;                                   ///< index of the grid
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< X: from the weighted centre, basic
  double weight = 0;                              ///< w: of its translations
  double turn_weight = 0;                         ///< w_r: of its rotations, times the square of the mean arm
};

/// The mean of an RBE3 that joins whole grids: place x̄ = Σ w x_k / Σ w, and the rotation R of best fit,
/// RᵀΣ (w x_k X_kᵀ + ½ w_r R_k) symmetric (docs/theory/links.md).
struct WeightedMean {
  int reference = 0;     ///< index of the reference grid
  bool rotates = false;  ///< its rotations follow, else its translations alone
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  std::vector<MeanMember> members;
};

/// The mean of an RBE3 along a curve: x̄ = Σ w x_k / Σ w, and its rotation R of best fit.
class MeanSeries {
 public:
  /// u: of each member 6 x k, orders 1 to k, at most 5, of its translations and rotation vector.
  MeanSeries(const WeightedMean& mean, const std::vector<MatrixXd>& u);

  /// Translations u of the end of an arm from the centre, and its rotation vector: 6 x 5.
  MatrixXd calc_motion(const Eigen::Vector3d& arm) const;
  /// Forces on the members, of each 6 x 5, of the work of forces and moments (6 x k, conjugate to the rotation vector)
  /// on the motion of the end of an arm.
  std::vector<MatrixXd> calc_forces(const Eigen::Vector3d& arm, const Eigen::Ref<const MatrixXd>& forces) const;

 private:
  const WeightedMean& mean_;
  double total_ = 0;  ///< Σ w
  Eigen::Matrix3d inverse_;
  SeriesVector centre_, theta_;  ///< displacement of the mean; rotation vector of R
  SeriesMatrix R_, H_;
  std::vector<SeriesVector> rotation_;  ///< rotation vectors of the members
  std::vector<SeriesMatrix> turned_;    ///< RᵀR_k
};

}  // namespace bough::fe
