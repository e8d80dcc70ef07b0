#include "solver/hinges/spherical.hpp"

#include <cmath>
#include <limits>

namespace bough::solver {

namespace {
Eigen::Quaterniond as_quaternion(const double* q) { return {q[3], q[0], q[1], q[2]}; }

constexpr double kLargestTurn = 6.0;  // T is singular at 2π

// Rotation vector of a quaternion, on the branch of its sign: |θ| > π where w < 0.
Vector3d calc_rotation_log(const Eigen::Quaterniond& q) {
  const double s = q.vec().norm();
  const double angle = 2 * std::atan2(s, q.w());
  return s < 1e-8 ? Vector3d(2 * q.vec() / q.w()) : Vector3d(angle / s * q.vec());
}
}  // namespace

void SphericalHinge::calc_position(const double* q, HingeMotion& motion) const {
  motion.R_HpHc = as_quaternion(q).normalized().toRotationMatrix();
  motion.H.block<3, 3>(3, 0) = motion.R_HpHc;
}

void SphericalHinge::calc_q_dot(const double* q, const double* u, double* q_dot) const {
  Eigen::Map<Eigen::Vector4d>{q_dot} = calc_quaternion_rate(as_quaternion(q), {u[0], u[1], u[2]});
}

void SphericalHinge::set_neutral(double* q) const {
  Hinge::set_neutral(q);
  q[3] = 1;
}

void SphericalHinge::set_from_file(const double* file, double* q) const {
  Hinge::set_from_file(file, q);
  for (int i = 0; i < 4; ++i) q[i] = file[(i + 1) % 4];
}

void SphericalHinge::get_for_file(const double* q, double* file) const {
  Hinge::get_for_file(q, file);
  for (int i = 0; i < 4; ++i) file[(i + 1) % 4] = q[i];
}

double SphericalHinge::calc_spring(const double* q, const double* q_null, const double* k, double* force) const {
  const Vector3d theta =
      calc_rotation_log((as_quaternion(q_null).normalized().conjugate() * as_quaternion(q).normalized()).normalized());
  if (theta.norm() > kLargestTurn) return std::numeric_limits<double>::quiet_NaN();
  const Vector3d k_theta(k[0] * theta.x(), k[1] * theta.y(), k[2] * theta.z());
  Eigen::Map<Vector3d>{force} = -(calc_rotation_tangent(theta).inverse() * k_theta);
  return 0.5 * theta.dot(k_theta);
}

}  // namespace bough::solver
