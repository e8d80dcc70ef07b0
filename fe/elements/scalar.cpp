#include "fe/elements/scalar.hpp"

#include "fe/elements/carried.hpp"

namespace bough::fe {

void ScalarSpring::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  K.noalias() += scale * k_ * b_ * b_.transpose();
}

void ScalarDamper::add_damping(double scale, Eigen::Ref<MatrixXd> B) const {
  B.noalias() += scale * coefficient_ * b_ * b_.transpose();
}

void ScalarMass::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const {
  M.noalias() += scale * m_ * b_ * b_.transpose();
}

const OffsetMass* ScalarMass::offset_mass(MassKind) const { return turns_ ? this : nullptr; }

bool ScalarMass::add_carried(MassKind, const Eigen::Ref<const Matrix3Xd>& x, CarriedMass& carried) const {
  if (nodes().size() != 1 || b_.size() != 6 || !b_.head<3>().isZero(0)) return false;
  const Vector3d axis = b_.tail<3>();
  const Matrix3d E = m_ * (0.5 * axis.squaredNorm() * Matrix3d::Identity() - axis * axis.transpose());
  carried.add_grid_body(x.col(0), 0, Vector3d::Zero(), E, 0);
  return true;
}

}  // namespace bough::fe
