#pragma once
/// \file Grids that go with the weighted mean of others (RBE3) at a finite motion (docs/theory/nonlinear-statics.md).
#include <vector>

#include "fe/corotational/best_fit.hpp"
#include "fe/corotational/mean_series.hpp"

namespace bough::fe {

/// The mean of an RBE3 at a finite motion of its grids: place x̄ + R s of the end of an arm s, rotation R. MeanSeries
/// is the same along a curve. A variation has six rows per member, displacements and spins in basic.
class MeanMotion {
 public:
  /// u: displacements of the members; rotations: theirs.
  MeanMotion(const WeightedMean& mean, const Matrix3Xd& u, const std::vector<Matrix3d>& rotations);
  MeanMotion(const MeanMotion&) = delete;
  MeanMotion& operator=(const MeanMotion&) = delete;

  /// Rotation of the mean.
  const Matrix3d& R() const { return fit_.R(); }
  /// Displacement of the end of an arm from the centre.
  Vector3d calc_displacement(const Vector3d& arm) const { return centre_ + fit_.R() * arm - arm; }
  /// 6 x 6n: variation of the end of an arm, displacements and spins, by that of the members.
  MatrixXd calc_tangent(const Vector3d& arm) const;
  /// 6n x 6n: derivative by the members' variation of the forces and moments on them, calc_tangent()ᵀ (force, moment),
  /// where force and moment stay fixed in space. Unsymmetric by spins as all moments are.
  MatrixXd calc_slope(const Vector3d& arm, const Vector3d& force, const Vector3d& moment) const;

 private:
  double total_ = 0;                    ///< Σ w
  Vector3d centre_ = Vector3d::Zero();  ///< displacement of the weighted centre
  std::vector<FitGrid> grids_;
  BestFit fit_;
};

}  // namespace bough::fe
