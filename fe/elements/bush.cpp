#include "fe/elements/bush.hpp"

#include <algorithm>

#include "base/rotation.hpp"
#include "fe/elements/carried.hpp"

namespace bough::fe {

Bush::Bush(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const BushData& data)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)), data_(data) {
  BOUGH_DEMAND(num_dofs() == 6 || num_dofs() == 12);
}

Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 12> Bush::calc_stretch() const {
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 12> B(6, num_dofs());
  const Matrix3d R = data_.R_basic_element.transpose();
  B.setZero();
  B.block<3, 3>(0, 0) = B.block<3, 3>(3, 3) = -R;
  B.block<3, 3>(0, 3) = R * skew(data_.arm_a);
  if (num_dofs() == 12) {
    B.block<3, 3>(0, 6) = B.block<3, 3>(3, 9) = R;
    B.block<3, 3>(0, 9) = -R * skew(data_.arm_b);
  }
  return B;
}

void Bush::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  const auto B = calc_stretch();
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> k(data_.k.data());
  K += scale * (B.transpose() * (k.asDiagonal() * B));
}

const Damping* Bush::damping() const {
  return std::any_of(data_.b.begin(), data_.b.end(), [](double b) { return b != 0; }) ? this : nullptr;
}

void Bush::add_damping(double scale, Eigen::Ref<MatrixXd> B) const {
  const auto stretch = calc_stretch();
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> b(data_.b.data());
  B += scale * (stretch.transpose() * (b.asDiagonal() * stretch));
}

void Bush::add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const {
  const auto stretch = calc_stretch();
  const Eigen::Map<const Eigen::Array<double, 6, 1>> k(data_.k.data()), ge(data_.ge.data());
  K += stretch.transpose() * ((g + ge) * k).matrix().asDiagonal() * stretch;
}

void Bush::add_mass(MassKind, double scale, Eigen::Ref<MatrixXd> M) const {
  for (int first = 0; first < num_dofs(); first += 6)
    M.block<3, 3>(first, first) += 0.5 * scale * data_.mass * Matrix3d::Identity();
}

Eigen::Matrix<double, 6, 1> Bush::calc_spring_forces(const Eigen::Ref<const VectorXd>& u) const {
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> k(data_.k.data());
  return k.asDiagonal() * (calc_stretch() * u);
}

void Bush::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                   Eigen::Ref<MatrixXd> K_G) const {
  const Matrix3d& R = data_.R_basic_element;
  const Vector3d f = R * force.head<3>(), m = R * force.tail<3>();
  K_G.block<3, 3>(3, 3) += scale * calc_arm_stiffness(f, data_.arm_a);
  if (num_dofs() == 6) return;
  K_G.block<3, 3>(9, 9) -= scale * calc_arm_stiffness(f, data_.arm_b);
  // Seen from axes that turn by θ the stretch lacks θ×(u_b - u_a), the relative rotation ½ θ_a×θ_b.
  Eigen::Matrix<double, 3, 12> gap = Eigen::Matrix<double, 3, 12>::Zero(), turn = gap;
  gap.block<3, 3>(0, 0) = -Matrix3d::Identity();
  gap.block<3, 3>(0, 3) = skew(data_.arm_a);
  gap.block<3, 3>(0, 6) = Matrix3d::Identity();
  gap.block<3, 3>(0, 9) = -skew(data_.arm_b);
  turn.block<3, 3>(0, 3) = turn.block<3, 3>(0, 9) = 0.5 * Matrix3d::Identity();
  const Eigen::Matrix<double, 12, 12> half = turn.transpose() * (skew(f) * gap);
  K_G += scale * (half + half.transpose());
  K_G.block<3, 3>(3, 9) += scale * 0.5 * skew(m);
  K_G.block<3, 3>(9, 3) -= scale * 0.5 * skew(m);
}

}  // namespace bough::fe
