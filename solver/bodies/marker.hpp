#pragma once
/// \file A frame M fixed in a node K of a body B, for hinges, forces and sensors.
///
///     r = r_K + R_BK p_KM, R_BM = R_BK R_KM;   [v; w] = J η̇,   [a; α] = J η̈ + [gamma_v; gamma_w]
/// all against the frame of B, in B (docs/theory/multibody.md, "Nodes"). J holds -K_G2 η of forces and moments, so that
/// Jᵀ [f; t] stiffens the body by the load at its present value.
#include "solver/bodies/body.hpp"

namespace bough::solver {

struct Marker {
  int body = -1;  ///< tree index, -1: ground
  int node = 0;   ///< index into Body::nodes()
  Vector3d p_KM = Vector3d::Zero();
  Matrix3d R_KM = Matrix3d::Identity();
  bool moves = false;  ///< the node deforms

  /// Returns true if both are one frame of one node, by exact comparison.
  bool is_same(const Marker& m) const { return body == m.body && node == m.node && p_KM == m.p_KM && R_KM == m.R_KM; }
};

struct MarkerMotion {
  // Position
  Vector3d r = Vector3d::Zero();      ///< p_BoM
  Matrix3d R = Matrix3d::Identity();  ///< R_BM
  Vector3d o = Vector3d::Zero();      ///< p_KM in B
  Matrix3d T = Matrix3d::Identity();  ///< left tangent of R_BK
  Vector3d theta = Vector3d::Zero();  ///< rotation vector of R_BK
  Matrix6Xd J;                        ///< 6 x n; no columns where the marker does not move
  // Velocity
  Vector3d v = Vector3d::Zero(), w = Vector3d::Zero();
  Vector3d gamma_v = Vector3d::Zero(), gamma_w = Vector3d::Zero();
};

/// The motion at η = 0, with J sized; all there is to a marker that does not move.
MarkerMotion make_marker_motion(const Body& body, const Marker& marker);
/// Pose and J of a moving marker; 6n² with locators of forces, 12n² with those of moments too. No allocation.
void calc_marker_position(const Body& body, const Marker& marker, const ConstVectorRef& eta, MarkerMotion& out);
/// Velocity and bias, after calc_marker_position. The same cost.
void calc_marker_velocity(const Body& body, const Marker& marker, const ConstVectorRef& eta,
                          const ConstVectorRef& eta_dot, MarkerMotion& out);

}  // namespace bough::solver
