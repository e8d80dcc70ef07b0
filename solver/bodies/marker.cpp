#include "solver/bodies/marker.hpp"

namespace bough::solver {

MarkerMotion make_marker_motion(const Body& body, const Marker& marker) {
  MarkerMotion m;
  m.o = marker.p_KM;
  m.r = body.nodes()[static_cast<size_t>(marker.node)].p + marker.p_KM;
  m.R = marker.R_KM;
  m.J = Matrix6Xd::Zero(6, marker.moves ? body.num_modes() : 0);
  return m;
}

void calc_marker_position(const Body& body, const Marker& marker, const ConstVectorRef& eta, MarkerMotion& m) {
  const Node& node = body.nodes()[static_cast<size_t>(marker.node)];
  Matrix3d R_BK;
  calc_node_position(node, eta, m.r, m.theta, m.J);
  R_BK = calc_rotation_exp(m.theta);
  m.T = calc_rotation_tangent(m.theta);
  m.R = R_BK * marker.R_KM;
  m.o = R_BK * marker.p_KM;
  m.r += m.o;
  for (int j = 0; j < m.J.cols(); ++j) {
    const Vector3d angular = m.T * m.J.col(j).tail<3>();
    m.J.col(j).tail<3>() = angular;
    m.J.col(j).head<3>() += angular.cross(m.o);
  }
}

void calc_marker_velocity(const Body& body, const Marker& marker, const ConstVectorRef& eta,
                          const ConstVectorRef& eta_dot, MarkerMotion& m) {
  const Node& node = body.nodes()[static_cast<size_t>(marker.node)];
  Vector6d V = Vector6d::Zero();
  for (int j = 0; j < m.J.cols(); ++j) V += m.J.col(j) * eta_dot[j];
  m.v = V.head<3>();
  m.w = V.tail<3>();
  Vector3d theta_ddot;  // at η̈ = 0
  calc_node_bias(node, eta, eta_dot, m.gamma_v, theta_ddot);
  const Vector3d theta_dot = m.T.inverse() * m.w;
  m.gamma_w = calc_rotation_tangent_rate(m.theta, theta_dot) + m.T * theta_ddot;
  m.gamma_v += m.gamma_w.cross(m.o) + m.w.cross(m.w.cross(m.o));
}

}  // namespace bough::solver
