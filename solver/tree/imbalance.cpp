// Inverse dynamics: base to tip the accelerations, tip to base the forces that they leave (Featherstone, Rigid Body
// Dynamics Algorithms (2008), 5.3), for flexible bodies too.
#include <cmath>

#include "solver/tree/data.hpp"

namespace bough::solver {

namespace {

// [A'; η̈] of body b, without gravity, in B.
Vector6d calc_acceleration(const Tree& tree, const TreeData& data, int b, const ConstVectorRef& u_dot,
                           const Matrix6Xd& A) {
  const TreeBody& tb = tree[b];
  const BodyData& d = data[b];
  Vector6d A_P = Vector6d::Zero();
  if (tb.parent < 0) {
    A_P.head<3>() = -data.gravity;
  } else {
    A_P = A.col(tb.parent);
  }
  Vector6d out = data.motion.b.col(b);
  if (tb.on_parent.moves) {
    const TreeBody& parent = tree[tb.parent];
    out += d.X.leftCols<6>() * A_P;
    out += d.X.rightCols(parent.num_modes()) * u_dot.segment(parent.eta_dot_offset(), parent.num_modes());
  } else {
    const Matrix3d R_BP = d.R_PB.transpose();
    const Vector3d alpha = A_P.tail<3>();
    out.head<3>() += R_BP * (A_P.head<3>() + alpha.cross(d.r_PoBo));
    out.tail<3>() += R_BP * alpha;
  }
  for (int i = 0; i < d.num_free; ++i) out += d.H.col(i) * u_dot[tb.u_offset + d.free[i]];
  if (tb.on_child.moves) out -= d.Jc * u_dot.segment(tb.eta_dot_offset(), tb.num_modes());
  return out;
}

/// Load of one body or of all, and the sum of the absolute values of its terms.
struct Load {
  VectorXd value, terms;
};

// Adds M [A'; η̈] to the load of body b, which begins at tb.v_offset.
void add_inertia(const TreeBody& tb, const BodyInertia& M, const Vector6d& A, const ConstVectorRef& eta_ddot,
                 Load& load) {
  const int n = tb.num_modes();
  load.value.segment<6>(tb.v_offset) += M.M6 * A;
  load.terms.segment<6>(tb.v_offset) += M.M6.cwiseAbs() * A.cwiseAbs();
  if (n == 0) return;
  const MatrixXd M_modal = M.M_modal.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
  load.value.segment<6>(tb.v_offset) += M.M_top * eta_ddot;
  load.terms.segment<6>(tb.v_offset) += M.M_top.cwiseAbs() * eta_ddot.cwiseAbs();
  load.value.segment(tb.v_offset + 6, n) += M.M_top.transpose() * A + M_modal * eta_ddot;
  load.terms.segment(tb.v_offset + 6, n) +=
      M.M_top.cwiseAbs().transpose() * A.cwiseAbs() + M_modal.cwiseAbs() * eta_ddot.cwiseAbs();
}

void pass_to_parent(const Tree& tree, const TreeBody& tb, const BodyData& d, Load& load) {
  const TreeBody& parent = tree[tb.parent];
  const Vector6d value = load.value.segment<6>(tb.v_offset), terms = load.terms.segment<6>(tb.v_offset);
  MatrixXd X = d.X;
  if (!tb.on_parent.moves) {
    X.resize(6, 6);
    X << d.R_PB.transpose(), -d.R_PB.transpose() * skew(d.r_PoBo), Matrix3d::Zero(), d.R_PB.transpose();
  }
  load.value.segment(parent.v_offset, X.cols()) += X.transpose() * value;
  load.terms.segment(parent.v_offset, X.cols()) += X.cwiseAbs().transpose() * terms;
}

}  // namespace

Imbalance calc_imbalance(const Tree& tree, const TreeData& data, const ConstVectorRef& u_dot) {
  BOUGH_DEMAND(u_dot.size() == tree.num_u);
  data.demand(Stage::Velocity);
  Matrix6Xd A(6, tree.size());
  Load load{data.h - data.applied, data.h.cwiseAbs() + data.applied.cwiseAbs()};
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    A.col(b) = calc_acceleration(tree, data, b, u_dot, A);
    add_inertia(tb, data[b].inertia, A.col(b), u_dot.segment(tb.eta_dot_offset(), tb.num_modes()), load);
  }
  Imbalance found{VectorXd::Zero(tree.num_u), VectorXd::Zero(tree.num_u)};
  for (int b = tree.size() - 1; b >= 0; --b) {
    const TreeBody& tb = tree[b];
    const BodyData& d = data[b];
    const int n = tb.num_modes();
    const Vector6d value = load.value.segment<6>(tb.v_offset), terms = load.terms.segment<6>(tb.v_offset);
    for (int i = 0; i < d.num_free; ++i) {
      const int row = tb.u_offset + d.free[i];
      const double own = data.hinge_force[row] - data.added[row] * u_dot[row];
      found.force[row] = own - d.H.col(i).dot(value);
      found.terms[row] = std::abs(own) + d.H.col(i).cwiseAbs().dot(terms);
    }
    found.force.segment(tb.eta_dot_offset(), n) = -load.value.segment(tb.v_offset + 6, n);
    found.terms.segment(tb.eta_dot_offset(), n) = load.terms.segment(tb.v_offset + 6, n);
    if (tb.on_child.moves) {
      found.force.segment(tb.eta_dot_offset(), n) += d.Jc.transpose() * value;
      found.terms.segment(tb.eta_dot_offset(), n) += d.Jc.cwiseAbs().transpose() * terms;
    }
    if (tb.parent >= 0) pass_to_parent(tree, tb, d, load);
  }
  return found;
}

}  // namespace bough::solver
