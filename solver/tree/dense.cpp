// The second route: Jacobians of every body with respect to u, M = Σ JᵀM(η)J, no elimination.
#include "solver/tree/data.hpp"

namespace bough::solver {

namespace {

struct DenseBody {
  MatrixXd J;     // (6+n) x num_u
  VectorXd bias;  // [A'; η̈] at u̇ = 0 where free and as given where not
};

// All the hinge's columns at Bo, in B, free or not.
Matrix6Xd calc_columns(const Tree& tree, const TreeData& data, int b) {
  const TreeBody& tb = tree[b];
  const Matrix3d R_BHp = data[b].R_PB.transpose() * data.markers[static_cast<size_t>(tb.parent_marker)].R;
  const Vector3d r = data.markers[static_cast<size_t>(tb.child_marker)].r;
  Matrix6Xd H(6, tb.num_hinge_u());
  for (int i = 0; i < H.cols(); ++i) {
    const Vector3d angular = R_BHp * data[b].hinge.H.col(i).tail<3>();
    H.col(i) << R_BHp * data[b].hinge.H.col(i).head<3>() + r.cross(angular), angular;
  }
  return H;
}

}  // namespace

void calc_dense_equations(const Tree& tree, const TreeData& data, MatrixXd& mass, VectorXd& force) {
  data.demand(Stage::Velocity);
  std::vector<DenseBody> dense(static_cast<size_t>(tree.size()));
  mass = MatrixXd::Zero(tree.num_u, tree.num_u);
  force = VectorXd::Zero(tree.num_u);
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const BodyData& d = data[b];
    auto& [J, bias] = dense[static_cast<size_t>(b)];
    const int n = tb.num_modes(), nh = tb.num_hinge_u();
    Matrix6d X6;
    X6 << d.R_PB.transpose(), -d.R_PB.transpose() * skew(d.r_PoBo), Matrix3d::Zero(), d.R_PB.transpose();
    J = MatrixXd::Zero(6 + n, tree.num_u);
    bias = VectorXd::Zero(6 + n);
    if (tb.parent < 0) {
      Vector6d ground;
      ground << -data.gravity, Vector3d::Zero();
      bias.head<6>() = X6 * ground;
    } else {
      const DenseBody& P = dense[static_cast<size_t>(tb.parent)];
      MatrixXd X = MatrixXd::Zero(6, P.J.rows());
      X.leftCols<6>() = X6;
      if (tb.on_parent.moves) X.rightCols(X.cols() - 6) = d.X.rightCols(X.cols() - 6);
      J.topRows<6>() = X * P.J;
      bias.head<6>() = X * P.bias;
    }
    bias.head<6>() += data.motion.b.col(b);
    J.block(0, tb.u_offset, 6, nh) += calc_columns(tree, data, b);
    if (tb.on_child.moves) J.block(0, tb.eta_dot_offset(), 6, n) -= d.Jc;
    J.block(6, tb.eta_dot_offset(), n, n).setIdentity();
    const MatrixXd M = n == 0 ? MatrixXd(d.inertia.M6) : d.inertia.make_M();
    mass += J.transpose() * M * J;
    force += J.transpose() * (data.applied.segment(tb.v_offset, 6 + n) - data.h.segment(tb.v_offset, 6 + n) - M * bias);
    mass.diagonal().segment(tb.u_offset, nh) += data.added.segment(tb.u_offset, nh);
    if (data.added_K != 0)
      mass.block(tb.eta_dot_offset(), tb.eta_dot_offset(), n, n) +=
          data.added_K * tb.body.K() + data.added_D * tb.body.D();
    force.segment(tb.u_offset, nh) += data.hinge_force.segment(tb.u_offset, nh);
  }
}

void calc_dense_accelerations(const Tree& tree, const TreeData& data, Eigen::Ref<VectorXd> u_dot) {
  MatrixXd mass;
  VectorXd force;
  calc_dense_equations(tree, data, mass, force);
  std::vector<int> free;
  for (int row = 0; row < tree.num_u; ++row) {
    if (data.mode[static_cast<size_t>(row)] == HingeMode::Free) free.push_back(row);
  }
  u_dot = data.given_udot;
  const MatrixXd reduced = mass(free, free);
  const VectorXd solution = reduced.ldlt().solve(VectorXd(force(free)));
  for (size_t i = 0; i < free.size(); ++i) u_dot[free[i]] = solution[static_cast<Eigen::Index>(i)];
}

}  // namespace bough::solver
