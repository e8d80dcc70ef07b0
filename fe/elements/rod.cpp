#include "fe/elements/rod.hpp"

#include <utility>

#include "base/rotation.hpp"
#include "fe/sections/stress.hpp"

namespace bough::fe {
namespace {

/// K += [B -B; -B B] on the 3-dof blocks that start at i and j.
void add_pair(int i, int j, const Matrix3d& B, Eigen::Ref<MatrixXd> K) {
  K.block<3, 3>(i, i) += B;
  K.block<3, 3>(j, j) += B;
  K.block<3, 3>(i, j) -= B;
  K.block<3, 3>(j, i) -= B;
}

}  // namespace

Rod::Rod(int id, std::string card, std::vector<int> nodes, std::vector<int> gdofs, const RodProperty& property,
         const Vector3d& a, const Vector3d& b)
    : Element(id, std::move(card), std::move(nodes), std::move(gdofs)),
      property_(property),
      axis_((b - a).normalized()),
      length_((b - a).norm()) {
  BOUGH_DEMAND(num_dofs() == 12 && length_ > 0);
}

void Rod::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  const Matrix3d along = axis_ * axis_.transpose();
  add_pair(0, 6, scale * property_.EA / length_ * along, K);
  add_pair(3, 9, scale * property_.GJ / length_ * along, K);
}

void Rod::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  // Lumped: ∫ N_i μ, which keeps mass and its moment.
  const double a = scale * property_.mass_a * length_, b = scale * property_.mass_b * length_;
  M.block<3, 3>(0, 0) += (a / 3 + b / 6) * Matrix3d::Identity();
  M.block<3, 3>(6, 6) += (a / 6 + b / 3) * Matrix3d::Identity();
  if (kind == MassKind::Lumped) return;
  // Nastran couples along the axis only, by the mean of lumped and ∫ N_i N_j μ: 5/12 and 1/12 of a uniform rod.
  add_pair(0, 6, -(a + b) / 24 * axis_ * axis_.transpose(), M);
}

void Rod::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  force[0] = property_.EA / length_ * axis_.dot(u.segment<3>(6) - u.segment<3>(0));
  force[1] = property_.GJ / length_ * axis_.dot(u.segment<3>(9) - u.segment<3>(3));
}

std::vector<StressPoint> Rod::stress_points() const {
  StressPoint point;
  point.kind = StressKind::Rod;
  return {point};
}

MatrixXd Rod::calc_stresses(const Eigen::Ref<const MatrixXd>& forces) const {
  MatrixXd stress(2, forces.cols());
  stress.row(0) = forces.row(0) / property_.area;
  stress.row(1) = forces.row(1) * property_.torsion;
  return stress;
}

MatrixXd Rod::calc_strains(const Eigen::Ref<const MatrixXd>& forces) const {
  MatrixXd strain = calc_stresses(forces);
  for (const auto& [row, modulus] : {std::pair{0, property_.E}, std::pair{1, property_.G}})
    strain.row(row) *= modulus > 0 ? 1 / modulus : 0;
  return strain;
}

ThermalState Rod::calc_thermal(const ElementTemperature& T) const {
  const double strain = property_.alpha * T.calc_change(property_.tref).node.mean(), N = property_.EA * strain;
  ThermalState state(num_dofs(), num_internal_forces());
  state.load.segment<3>(0) -= N * axis_;
  state.load.segment<3>(6) += N * axis_;
  state.force[0] -= N;
  state.energy = 0.5 * N * strain * length_;
  state.strain = Eigen::Vector2d(strain, 0);
  return state;
}

void Rod::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                  Eigen::Ref<MatrixXd> K_G) const {
  add_pair(0, 6, scale * force[0] / length_ * (Matrix3d::Identity() - axis_ * axis_.transpose()), K_G);
  // Second-order twist about the turned axis: T [ (u_B - u_A)·(1 - e eᵀ)(θ_B - θ_A) / L + ½ e·(θ_A × θ_B) ].
  const double torque = scale * force[1];
  const Matrix3d across = torque / length_ * (Matrix3d::Identity() - axis_ * axis_.transpose());
  for (const auto& [i, sign_u] : {std::pair{0, -1.0}, std::pair{6, 1.0}}) {
    for (const auto& [j, sign_r] : {std::pair{3, -1.0}, std::pair{9, 1.0}}) {
      K_G.block<3, 3>(i, j) += sign_u * sign_r * across;
      K_G.block<3, 3>(j, i) += sign_u * sign_r * across;
    }
  }
  const Matrix3d turn = 0.5 * torque * skew(axis_);
  K_G.block<3, 3>(9, 3) += turn;
  K_G.block<3, 3>(3, 9) -= turn;
}

}  // namespace bough::fe
