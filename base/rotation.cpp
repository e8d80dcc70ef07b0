#include "base/rotation.hpp"

#include <cmath>

namespace bough {

namespace {
// a = sinθ/θ, b = (1-cosθ)/θ², c = (θ-sinθ)/θ³ with their derivatives divided by θ, by series near zero.
struct Coefficients {
  double a, b, c, db_over_theta, dc_over_theta;
};
Coefficients calc_coefficients(double theta2) {
  Coefficients k;
  if (theta2 < 1e-3) {
    const double x = theta2;
    k.a = 1 - x / 6 * (1 - x / 20 * (1 - x / 42 * (1 - x / 72)));
    k.b = 0.5 * (1 - x / 12 * (1 - x / 30 * (1 - x / 56 * (1 - x / 90))));
    k.c = 1.0 / 6 * (1 - x / 20 * (1 - x / 42 * (1 - x / 72 * (1 - x / 110))));
    k.db_over_theta = -1.0 / 12 * (1 - x / 15 * (1 - x / 37.333333333333336 * (1 - x / 67.5)));
    k.dc_over_theta = -1.0 / 60 * (1 - x / 21 * (1 - x / 48 * (1 - x / 82.5)));
    return k;
  }
  const double theta = std::sqrt(theta2);
  const double s = std::sin(theta), half = std::sin(0.5 * theta);
  const double one_minus_cos = 2 * half * half;
  k.a = s / theta;
  k.b = one_minus_cos / theta2;
  k.c = (theta - s) / (theta2 * theta);
  k.db_over_theta = (k.a - 2 * k.b) / theta2;
  k.dc_over_theta = (k.b - 3 * k.c) / theta2;
  return k;
}
}  // namespace

Matrix3d calc_rotation_exp(const Vector3d& theta) {
  const auto k = calc_coefficients(theta.squaredNorm());
  const Matrix3d s = skew(theta);
  return Matrix3d::Identity() + k.a * s + k.b * s * s;
}

Matrix3d calc_rotation_tangent(const Vector3d& theta) {
  const auto k = calc_coefficients(theta.squaredNorm());
  const Matrix3d s = skew(theta);
  return Matrix3d::Identity() + k.b * s + k.c * s * s;
}

Vector3d calc_rotation_tangent_rate(const Vector3d& theta, const Vector3d& theta_dot) {
  const auto k = calc_coefficients(theta.squaredNorm());
  const double radial = theta.dot(theta_dot);
  const Vector3d s1 = theta.cross(theta_dot);
  const Vector3d s2 = theta.cross(s1);
  // d/dt(b θ̃ + c θ̃²) θ̇ with θ̃̇ θ̇ = 0
  return k.db_over_theta * radial * s1 + k.dc_over_theta * radial * s2 + k.c * theta_dot.cross(s1);
}

Eigen::Vector4d calc_quaternion_rate(const Eigen::Quaterniond& q, const Vector3d& w) {
  Eigen::Vector4d rate;
  rate.head<3>() = 0.5 * (q.w() * w + q.vec().cross(w));
  rate[3] = -0.5 * q.vec().dot(w);
  return rate;
}

Matrix3d calc_frame_with_z(const Vector3d& axis) {
  const Vector3d z = axis.normalized();
  int smallest;
  z.cwiseAbs().minCoeff(&smallest);
  const Vector3d x = Vector3d::Unit(smallest).cross(z).normalized();
  Matrix3d r;
  r << x, z.cross(x), z;
  return r;
}

}  // namespace bough
