#pragma once
/// \file Cross-product matrices, the exponential map and its tangent, quaternion kinematics.
///
/// Frames: R_AB takes components in B to components in A. Quaternions are Eigen::Quaterniond (q_WB <-> R_WB); files
/// store them as w, x, y, z.
#include <Eigen/Dense>
#include <Eigen/Geometry>

namespace bough {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// ã with ã b = a × b.
inline Matrix3d skew(const Vector3d& a) {
  Matrix3d s;
  s << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return s;
}

/// exp(θ̃): the rotation by the rotation vector θ (Rodrigues).
Matrix3d calc_rotation_exp(const Vector3d& theta);

/// Left tangent T(θ): d/dt exp(θ̃) = skew(T(θ) θ̇) exp(θ̃); the angular velocity is in the fixed frame.
/// T = 1 + (1-cosθ)/θ² θ̃ + (θ-sinθ)/θ³ θ̃²  (Shuster, "A survey of attitude representations", 1993, eq. 278 with the
/// sign of the passive/active convention changed).
Matrix3d calc_rotation_tangent(const Vector3d& theta);

/// Ṫ(θ, θ̇) θ̇: the velocity-dependent part of the angular acceleration of exp(θ̃).
Vector3d calc_rotation_tangent_rate(const Vector3d& theta, const Vector3d& theta_dot);

/// q̇ = ½ q ⊗ (0, w) for q_AB and w_AB expressed in B; coefficients in Eigen's order x, y, z, w.
Eigen::Vector4d calc_quaternion_rate(const Eigen::Quaterniond& q_AB, const Vector3d& w_AB_B);

/// A rotation whose third column is the unit vector along `axis`.
Matrix3d calc_frame_with_z(const Vector3d& axis);

}  // namespace bough
