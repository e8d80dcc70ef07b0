#pragma once
/// \file Truncated Taylor series along a motion: matrices, rotations and poses with two derivatives with respect to
/// time.
#include <cmath>

#include "solver/bodies/spatial.hpp"

namespace bough::solver::testing::dense_route {

/// A matrix with its first and second derivative with respect to time.
template <int R, int C>
struct Series {
  using Matrix = Eigen::Matrix<double, R, C>;
  Matrix at = make_zero(), d1 = make_zero(), d2 = make_zero();
  static Matrix make_zero() { return Matrix::Zero(R < 0 ? 0 : R, C); }
  Series<C, R> transpose() const { return {at.transpose(), d1.transpose(), d2.transpose()}; }
};
using Vec = Series<3, 1>;
using Mat = Series<3, 3>;
using Num = Series<1, 1>;

template <int R, int C>
Series<R, C> operator+(const Series<R, C>& a, const Series<R, C>& b) {
  return {a.at + b.at, a.d1 + b.d1, a.d2 + b.d2};
}
template <int R, int C>
Series<R, C> operator-(const Series<R, C>& a, const Series<R, C>& b) {
  return {a.at - b.at, a.d1 - b.d1, a.d2 - b.d2};
}
template <int R, int K, int C>
Series<R, C> operator*(const Series<R, K>& a, const Series<K, C>& b) {
  return {a.at * b.at, a.d1 * b.at + a.at * b.d1, a.d2 * b.at + 2 * a.d1 * b.d1 + a.at * b.d2};
}
template <int R, int C>
Series<R, C> scale(const Num& s, const Series<R, C>& a) {
  const double x = s.at(0), y = s.d1(0), z = s.d2(0);
  return {x * a.at, y * a.at + x * a.d1, z * a.at + 2 * y * a.d1 + x * a.d2};
}
inline Num make_num(double at, double d1, double d2) {
  Num s;
  s.at(0) = at, s.d1(0) = d1, s.d2(0) = d2;
  return s;
}
template <int R, int C>
Series<R, C> make_constant(const Eigen::Matrix<double, R, C>& a) {
  Series<R, C> s;
  s.at = a;
  return s;
}
inline Mat make_cross(const Vec& v) { return {skew(v.at), skew(v.d1), skew(v.d2)}; }
inline Vector3d get_axial(const Matrix3d& S) {
  return 0.5 * Vector3d(S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1));
}

/// Σ (-x)^k/(2k+first)!, which is sin√x/√x for first = 1 and (1 - cos√x)/x for 2.
inline Num calc_power_series(const Num& x, int first) {
  double f[3] = {0, 0, 0}, factorial = 1;
  for (int k = 2; k <= first; ++k) factorial *= k;
  for (int k = 0; k < 26; ++k) {
    if (k > 0) factorial *= (2.0 * k + first) * (2.0 * k + first - 1);
    const double a = (k % 2 ? -1 : 1) / factorial;
    f[0] += a * std::pow(x.at(0), k);
    if (k > 0) f[1] += a * k * std::pow(x.at(0), k - 1);
    if (k > 1) f[2] += a * k * (k - 1) * std::pow(x.at(0), k - 2);
  }
  return make_num(f[0], f[1] * x.d1(0), f[2] * x.d1(0) * x.d1(0) + f[1] * x.d2(0));
}
inline Mat calc_rotation(const Vec& theta) {
  const Num x = theta.transpose() * theta;
  const Mat K = make_cross(theta);
  return make_constant<3, 3>(Matrix3d::Identity()) + scale(calc_power_series(x, 1), K) +
         scale(calc_power_series(x, 2), K * K);
}
/// About a constant unit axis.
inline Mat calc_turn(const Vector3d& axis, const Num& angle) {
  return calc_rotation(scale(angle, make_constant<3, 1>(axis)));
}

inline Eigen::Vector4d multiply_quaternions(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {  // x y z w
  const Vector3d x = a.head<3>(), y = b.head<3>();
  Eigen::Vector4d c;
  c << a[3] * y + b[3] * x + x.cross(y), a[3] * b[3] - x.dot(y);
  return c;
}
inline Eigen::Vector4d calc_quaternion_rate(const Eigen::Vector4d& q, const Vector3d& w) {
  Eigen::Vector4d pure;
  pure << w, 0;
  return 0.5 * multiply_quaternions(q, pure);
}
inline Mat calc_quaternion_rotation(const Eigen::Vector4d& q, const Vector3d& w, const Vector3d& w_dot) {
  const Eigen::Vector4d d1 = calc_quaternion_rate(q, w);
  const Eigen::Vector4d d2 = calc_quaternion_rate(d1, w) + calc_quaternion_rate(q, w_dot);
  const Vec v{q.head<3>(), d1.head<3>(), d2.head<3>()};
  const Num s = make_num(q[3], d1[3], d2[3]);
  const Mat K = make_cross(v);
  const Num two = make_num(2, 0, 0);
  return scale(s * s + v.transpose() * v, make_constant<3, 3>(Matrix3d::Identity())) + scale(two * s, K) +
         scale(two, K * K);
}

struct Pose {
  Vec p;
  Mat R;
};
inline Pose operator*(const Pose& a, const Pose& b) { return {a.p + a.R * b.p, a.R * b.R}; }

}  // namespace bough::solver::testing::dense_route
