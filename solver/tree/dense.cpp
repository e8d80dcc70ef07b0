// The second route: Jacobians of every body with respect to u, M = Σ JᵀM(η)J, no elimination.
#include "solver/tree/tree.hpp"

namespace bough::solver {

void calc_dense_equations(const Tree& tree, const TreeData& data, MatrixXd& mass, VectorXd& force) {
  const int num = static_cast<int>(tree.bodies.size());
  std::vector<MatrixXd> J(static_cast<size_t>(num));     // (6+n) x num_u
  std::vector<VectorXd> bias(static_cast<size_t>(num));  // [A'; η̈] at u̇ = 0
  mass = MatrixXd::Zero(tree.num_u, tree.num_u);
  force = VectorXd::Zero(tree.num_u);
  for (int b = 0; b < num; ++b) {
    const auto i = static_cast<size_t>(b);
    const TreeBody& tb = tree.bodies[i];
    const BodyData& d = data.bodies[i];
    const int n = tb.body.num_modes(), nh = tb.num_hinge_u;
    Matrix6d X6;
    X6 << d.R_PB.transpose(), -d.R_PB.transpose() * skew(d.r_PoBo), Matrix3d::Zero(), d.R_PB.transpose();
    J[i] = MatrixXd::Zero(6 + n, tree.num_u);
    bias[i] = VectorXd::Zero(6 + n);
    if (tb.parent < 0) {
      Vector6d ground;
      ground << -data.gravity, Vector3d::Zero();
      bias[i].head<6>() = X6 * ground;
    } else {
      const auto p = static_cast<size_t>(tb.parent);
      MatrixXd X = MatrixXd::Zero(6, J[p].rows());
      X.leftCols<6>() = X6;
      if (tb.on_parent.moves) X.rightCols(X.cols() - 6) = d.X.rightCols(X.cols() - 6);
      J[i].topRows<6>() = X * J[p];
      bias[i].head<6>() = X * bias[p];
    }
    bias[i].head<6>() += d.b;
    J[i].block(0, tb.u_offset, 6, nh) += d.H.leftCols(nh);
    if (tb.on_child.moves) J[i].block(0, tb.eta_dot_offset(), 6, n) -= d.Jc;
    J[i].block(6, tb.eta_dot_offset(), n, n).setIdentity();
    const MatrixXd M = n == 0 ? MatrixXd(tb.body.M6()) : d.inertia.M;
    mass += J[i].transpose() * M * J[i];
    force += J[i].transpose() * (d.applied - d.inertia.h - M * bias[i]);
    force.segment(tb.u_offset, nh) += d.hinge_force.head(nh);
  }
}

void calc_dense_accelerations(const Tree& tree, const TreeData& data, Eigen::Ref<VectorXd> u_dot) {
  MatrixXd mass;
  VectorXd force;
  calc_dense_equations(tree, data, mass, force);
  u_dot = mass.ldlt().solve(force);
}

}  // namespace bough::solver
