#include "fe/elements/bush1d.hpp"

namespace bough::fe {

Bush1d::Bush1d(int id, std::vector<int> nodes, std::vector<int> gdofs, const Bush1dData& data)
    : Element(id, "CBUSH1D", std::move(nodes), std::move(gdofs)), data_(data) {
  BOUGH_DEMAND(num_dofs() == 3 || num_dofs() == 6);
  BOUGH_DEMAND(num_dofs() == 6 || !data_.length);
}

void Bush1d::add_between_ends(const Matrix3d& block, Eigen::Ref<MatrixXd> A) const {
  A.block<3, 3>(0, 0) += block;
  if (num_dofs() == 3) return;
  A.block<3, 3>(3, 3) += block;
  A.block<3, 3>(0, 3) -= block;
  A.block<3, 3>(3, 0) -= block;
}

void Bush1d::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  add_between_ends(scale * data_.k * data_.axis * data_.axis.transpose(), K);
}

void Bush1d::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const {
  for (int i = 0; i < num_dofs(); ++i) M(i, i) += 0.5 * scale * data_.mass;
}

void Bush1d::add_damping(double scale, Eigen::Ref<MatrixXd> B) const {
  add_between_ends(scale * data_.c * data_.axis * data_.axis.transpose(), B);
}

void Bush1d::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  const Vector3d far = num_dofs() == 6 ? Vector3d(u.tail<3>()) : Vector3d::Zero();
  force[0] = data_.k * data_.axis.dot(far - u.head<3>());
}

void Bush1d::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                     Eigen::Ref<MatrixXd> K_G) const {
  if (!data_.length) return;
  const Matrix3d across = Matrix3d::Identity() - data_.axis * data_.axis.transpose();
  add_between_ends(scale * force[0] / *data_.length * across, K_G);
}

}  // namespace bough::fe
