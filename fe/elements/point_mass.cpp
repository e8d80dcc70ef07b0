#include "fe/elements/point_mass.hpp"

#include "base/rotation.hpp"

namespace bough::fe {

void PointMass::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const { M += scale * M_; }

const OffsetMass* PointMass::offset_mass(MassKind) const {
  return !is_rigid_ || !moments_.S.isZero(0) || !moments_.E.isZero(0) ? this : nullptr;
}

bool PointMass::add_carried(MassKind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  if (is_rigid_) carried.add_grid_body(x.col(0), moments_.m, moments_.S, moments_.E, 0);
  return is_rigid_;
}

Eigen::Matrix<double, 6, 6> calc_rigid_mass(double m, const Vector3d& s, const Matrix3d& I) {
  const Matrix3d S = skew(s);
  Eigen::Matrix<double, 6, 6> M;
  M.topLeftCorner<3, 3>() = m * Matrix3d::Identity();
  M.topRightCorner<3, 3>() = -m * S;
  M.bottomLeftCorner<3, 3>() = m * S;
  M.bottomRightCorner<3, 3>() = I - m * S * S;
  return M;
}

}  // namespace bough::fe
