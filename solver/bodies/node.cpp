#include "bough/solver/bodies/node.hpp"

namespace bough::solver {

namespace {
// Column j of the 3 x n matrix [K_G2(a) x]_a.
Vector3d calc_K2_column(const Node& node, int j, const ConstVectorRef& x) {
  return {node.K2.row(3 * j).dot(x), node.K2.row(3 * j + 1).dot(x), node.K2.row(3 * j + 2).dot(x)};
}
}  // namespace

void calc_node_in_body(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_dot, NodeInBody& out) {
  out = NodeInBody();
  out.r = node.p;
  if (!node.moves) return;
  Vector3d theta_dot = Vector3d::Zero();
  for (int j = 0; j < eta.size(); ++j) {
    out.r += node.phi.col(j) * eta[j];
    out.v += node.phi.col(j) * eta_dot[j];
    out.theta += node.psi.col(j) * eta[j];
    theta_dot += node.psi.col(j) * eta_dot[j];
  }
  if (node.K2.size() > 0) {
    for (int j = 0; j < eta.size(); ++j) {
      const Vector3d k = calc_K2_column(node, j, eta);
      out.r -= 0.5 * eta[j] * k;
      out.v -= eta_dot[j] * k;
      out.gamma_t -= eta_dot[j] * calc_K2_column(node, j, eta_dot);
    }
  }
  out.R_BK = calc_rotation_exp(out.theta);
  out.T = calc_rotation_tangent(out.theta);
  out.w = out.T * theta_dot;
  out.gamma_r = calc_rotation_tangent_rate(out.theta, theta_dot);
}

void calc_node_jacobian(const Node& node, const ConstVectorRef& eta, const Matrix3d& T, Eigen::Ref<Matrix6Xd> J) {
  if (!node.moves) {
    J.setZero();
    return;
  }
  for (int j = 0; j < eta.size(); ++j) {
    Vector3d translation = node.phi.col(j);
    if (node.K2.size() > 0) translation -= calc_K2_column(node, j, eta);
    J.col(j).head<3>() = translation;
    J.col(j).tail<3>() = T * node.psi.col(j);
  }
}

void add_node_generalized_force(const Node& node, const ConstVectorRef& eta, const Matrix3d& T, const Vector3d& f,
                                const Vector3d& t, Eigen::Ref<VectorXd> generalized) {
  if (!node.moves) return;
  const Vector3d t_psi = T.transpose() * t;
  for (int j = 0; j < eta.size(); ++j) {
    double g = node.phi.col(j).dot(f) + node.psi.col(j).dot(t_psi);
    if (node.K2.size() > 0) g -= calc_K2_column(node, j, eta).dot(f);
    generalized[j] += g;
  }
}

}  // namespace bough::solver
