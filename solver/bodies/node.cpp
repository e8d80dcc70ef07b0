#include "solver/bodies/node.hpp"

namespace bough::solver {

namespace {
// Column j of the 3 x n matrix [K_a x]_a, zero without locators.
Vector3d calc_K2_column(const RowMatrixXd& K2, int j, const ConstVectorRef& x) {
  if (K2.size() == 0) return Vector3d::Zero();
  return {K2.row(3 * j).dot(x), K2.row(3 * j + 1).dot(x), K2.row(3 * j + 2).dot(x)};
}

// The polynomials of a node at η: eight rows each, six of them used.
struct HigherMotion {
  Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, records::kMaxThirdOrderModes> J;
  Vector6d value = Vector6d::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8 * Polynomials::kMaxScratchRows, 1> tensors;

  HigherMotion(const Node& node, const ConstVectorRef& eta) : J(8, eta.size()), tensors(node.higher.scratch_size()) {
    node.higher.calc(eta, J.data(), value.data(), tensors.data());
  }
  Vector6d calc_bias(const Node& node, const ConstVectorRef& eta_dot) const {
    Eigen::Matrix<double, 8, 1> bias;
    node.higher.calc_bias(eta_dot, tensors.data(), bias.data());
    return bias.head<6>();
  }
};

// [r̈; θ̈] at η̈ = 0.
Vector6d calc_second_rates(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_dot) {
  Vector6d rates = Vector6d::Zero();
  if (!node.higher.empty()) return HigherMotion(node, eta).calc_bias(node, eta_dot);
  for (int j = 0; j < eta_dot.size(); ++j) {
    if (node.K2.size() > 0) rates.head<3>() -= calc_K2_column(node.K2, j, eta_dot) * eta_dot[j];
    if (node.K2_theta.size() > 0) rates.tail<3>() -= calc_K2_column(node.K2_theta, j, eta_dot) * eta_dot[j];
  }
  return rates;
}
}  // namespace

bool Node::has_no_rotation() const {
  return moves && !has_moments && psi.size() > 0 && psi.cwiseAbs().maxCoeff() <= 1e-14 * phi.cwiseAbs().maxCoeff();
}

void calc_node_in_body(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_dot, NodeInBody& out) {
  out = NodeInBody();
  out.r = node.p;
  if (!node.moves) return;
  Vector3d theta_dot = Vector3d::Zero(), theta_ddot = Vector3d::Zero();  // the latter at η̈ = 0
  if (!node.higher.empty()) {
    const HigherMotion motion(node, eta);
    out.r += node.phi * eta + motion.value.head<3>();
    out.theta = node.psi * eta + motion.value.tail<3>();
    for (int j = 0; j < eta.size(); ++j) {
      out.v += (node.phi.col(j) + motion.J.col(j).head<3>()) * eta_dot[j];
      theta_dot += (node.psi.col(j) + motion.J.col(j).segment<3>(3)) * eta_dot[j];
    }
    const Vector6d bias = motion.calc_bias(node, eta_dot);
    out.gamma_t = bias.head<3>();
    theta_ddot = bias.tail<3>();
  } else {
    for (int j = 0; j < eta.size(); ++j) {
      const Vector3d k = calc_K2_column(node.K2, j, eta), k_theta = calc_K2_column(node.K2_theta, j, eta);
      out.r += (node.phi.col(j) - 0.5 * k) * eta[j];
      out.v += (node.phi.col(j) - k) * eta_dot[j];
      out.gamma_t -= calc_K2_column(node.K2, j, eta_dot) * eta_dot[j];
      out.theta += (node.psi.col(j) - 0.5 * k_theta) * eta[j];
      theta_dot += (node.psi.col(j) - k_theta) * eta_dot[j];
      theta_ddot -= calc_K2_column(node.K2_theta, j, eta_dot) * eta_dot[j];
    }
  }
  out.R_BK = calc_rotation_exp(out.theta);
  out.T = calc_rotation_tangent(out.theta);
  out.w = out.T * theta_dot;
  out.gamma_r = calc_rotation_tangent_rate(out.theta, theta_dot) + out.T * theta_ddot;
}

void calc_node_position(const Node& node, const ConstVectorRef& eta, Vector3d& r, Vector3d& theta,
                        Eigen::Ref<Matrix6Xd> J) {
  r = node.p;
  theta.setZero();
  if (!node.higher.empty()) {
    const HigherMotion motion(node, eta);
    r += motion.value.head<3>();
    theta += motion.value.tail<3>();
    for (int j = 0; j < eta.size(); ++j) {
      r += node.phi.col(j) * eta[j];
      theta += node.psi.col(j) * eta[j];
      J.col(j) = motion.J.col(j).head<6>();
      J.col(j).head<3>() += node.phi.col(j);
      J.col(j).tail<3>() += node.psi.col(j);
    }
    return;
  }
  for (int j = 0; j < eta.size(); ++j) {
    const Vector3d k = calc_K2_column(node.K2, j, eta), k_theta = calc_K2_column(node.K2_theta, j, eta);
    r += (node.phi.col(j) - 0.5 * k) * eta[j];
    theta += (node.psi.col(j) - 0.5 * k_theta) * eta[j];
    J.col(j).head<3>() = node.phi.col(j) - k;
    J.col(j).tail<3>() = node.psi.col(j) - k_theta;
  }
}

void calc_node_bias(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_dot, Vector3d& r_ddot,
                    Vector3d& theta_ddot) {
  const Vector6d rates = calc_second_rates(node, eta, eta_dot);
  r_ddot = rates.head<3>();
  theta_ddot = rates.tail<3>();
}

void add_node_acceleration(const Node& node, const ConstVectorRef& eta, const ConstVectorRef& eta_ddot,
                           const Matrix3d& T, Vector3d& a, Vector3d& alpha) {
  if (!node.moves) return;
  Vector3d theta_ddot = Vector3d::Zero();
  if (!node.higher.empty()) {
    const HigherMotion motion(node, eta);
    for (int j = 0; j < eta.size(); ++j) {
      a += (node.phi.col(j) + motion.J.col(j).head<3>()) * eta_ddot[j];
      theta_ddot += (node.psi.col(j) + motion.J.col(j).segment<3>(3)) * eta_ddot[j];
    }
  }
  for (int j = 0; j < eta.size() && node.higher.empty(); ++j) {
    a += (node.phi.col(j) - calc_K2_column(node.K2, j, eta)) * eta_ddot[j];
    theta_ddot += (node.psi.col(j) - calc_K2_column(node.K2_theta, j, eta)) * eta_ddot[j];
  }
  alpha += T * theta_ddot;
}

void add_node_generalized_force(const Node& node, const ConstVectorRef& eta, const Matrix3d& T, const Vector3d& f,
                                const Vector3d& t, Eigen::Ref<VectorXd> generalized) {
  if (!node.moves) return;
  const Vector3d t_theta = T.transpose() * t;
  const bool forced = !f.isZero(0), twisted = !t.isZero(0);
  if (!node.higher.empty()) {
    const HigherMotion motion(node, eta);
    for (int j = 0; j < eta.size(); ++j)
      generalized[j] += (node.phi.col(j) + motion.J.col(j).head<3>()).dot(f) +
                        (node.psi.col(j) + motion.J.col(j).segment<3>(3)).dot(t_theta);
    return;
  }
  for (int j = 0; j < eta.size(); ++j) {
    if (forced) generalized[j] += (node.phi.col(j) - calc_K2_column(node.K2, j, eta)).dot(f);
    if (twisted) generalized[j] += (node.psi.col(j) - calc_K2_column(node.K2_theta, j, eta)).dot(t_theta);
  }
}

}  // namespace bough::solver
