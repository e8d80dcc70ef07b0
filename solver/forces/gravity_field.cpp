#include "solver/forces/gravity_field.hpp"

#include "solver/bodies/tensor.hpp"

namespace bough::solver {

Vector3d GravityField::calc_acceleration(int body, const Vector3d& p_W) const {
  Vector3d g = uniform;
  for (const CentralGravity* source : central)
    if (source->attracts(body)) g += source->calc_acceleration(p_W);
  return g;
}

Vector3d GravityField::calc_magnetic_field(const Vector3d& p_W) const {
  Vector3d B = Vector3d::Zero();
  for (const CentralGravity* source : central) B += source->calc_magnetic_field(p_W);
  return B;
}

BodyGravity GravityField::calc_on_body(const TreeData& data, int body) const {
  BodyGravity sum;
  sum.g.noalias() = data[body].state.R_WB.transpose() * uniform;
  if (!(data[body].inertia.mass > 0)) return sum;
  for (const CentralGravity* source : central) {
    if (!source->attracts(body)) continue;
    const BodyGravity own = source->calc_on_body(data, body);
    sum.g += own.g;
    sum.gradient += own.gradient;
  }
  return sum;
}

Eigen::Matrix<double, 12, 1> GravityField::calc_inertial_acceleration(const TreeData& data, int body) const {
  const BodyState& s = data[body].state;
  const BodyGravity gravity = calc_on_body(data, body);
  const Matrix3d& T = gravity.gradient;
  const Matrix3d Omega = s.w_B * s.w_B.transpose() - T + 0.5 * T.trace() * Matrix3d::Identity();
  Eigen::Matrix<double, 12, 1> A_I;
  A_I << s.a_B - gravity.g, s.alpha_B, pack_tensor(Omega);
  return A_I;
}

}  // namespace bough::solver
