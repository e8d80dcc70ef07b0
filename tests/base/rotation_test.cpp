#include "base/rotation.hpp"

#include <gtest/gtest.h>

namespace bough {
namespace {

// From tiny (series branch) through both sides of its limit to a half turn.
const double kAngles[] = {0.0, 1e-9, 1e-4, 0.03, 0.0316, 0.0317, 0.4, 1.7, 3.1};
const Vector3d kAxis = Vector3d(0.3, -0.5, 0.8).normalized();

TEST(Rotation, ExpIsTheAngleAxisRotation) {
  for (double angle : kAngles) {
    const Matrix3d expected = Eigen::AngleAxisd(angle, kAxis).toRotationMatrix();
    EXPECT_LT((calc_rotation_exp(angle * kAxis) - expected).norm(), 1e-15) << angle;
  }
}

TEST(Rotation, TangentAndItsRateAreDerivativesOfExp) {
  const Vector3d rate(0.7, 0.2, -0.4);
  const double h = 1e-5;
  for (double angle : kAngles) {
    const Vector3d theta = angle * kAxis;
    // 4th-order central difference of exp along theta + t rate
    auto r = [&](double t) { return calc_rotation_exp(theta + t * rate); };
    const Matrix3d derivative = (8 * (r(h) - r(-h)) - (r(2 * h) - r(-2 * h))) / (12 * h);
    const Matrix3d w = derivative * r(0).transpose();
    EXPECT_LT((skew(calc_rotation_tangent(theta) * rate) - w).norm(), 1e-10) << angle;
    auto tr = [&](double t) -> Vector3d { return calc_rotation_tangent(theta + t * rate) * rate; };
    const Vector3d expected = (8 * (tr(h) - tr(-h)) - (tr(2 * h) - tr(-2 * h))) / (12 * h);
    EXPECT_LT((calc_rotation_tangent_rate(theta, rate) - expected).norm(), 1e-9) << angle;
  }
}

TEST(Rotation, QuaternionRateTurnsWithTheAngularVelocity) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(0.8, kAxis));
  const Vector3d w(0.1, -2, 0.5);
  const Eigen::Vector4d rate = calc_quaternion_rate(q, w);
  const double h = 1e-6;
  const Eigen::Quaterniond later = q * Eigen::Quaterniond(Eigen::AngleAxisd(h * w.norm(), w.normalized()));
  EXPECT_LT(((later.coeffs() - q.coeffs()) / h - rate).norm(), 2e-6);
  EXPECT_NEAR(q.coeffs().dot(rate), 0, 1e-15);
}

TEST(Rotation, FrameWithZIsAProperRotation) {
  for (const Vector3d& axis : {Vector3d(0, 0, 2), Vector3d(1, 0, 0), Vector3d(-1, 2, 3)}) {
    const Matrix3d r = calc_frame_with_z(axis);
    EXPECT_LT((r.col(2) - axis.normalized()).norm(), 1e-15);
    EXPECT_LT((r * r.transpose() - Matrix3d::Identity()).norm(), 1e-15);
    EXPECT_NEAR(r.determinant(), 1, 1e-15);
  }
}

}  // namespace
}  // namespace bough
