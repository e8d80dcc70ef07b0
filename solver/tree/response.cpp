// M⁻¹ times something: the sweeps of solve.cpp without h, gravity and bias.
#include "solver/tree/data.hpp"
#include "solver/tree/hinge_sizes.hpp"

namespace bough::solver {

Sweep& start_response(TreeData& data) {
  data.demand(Stage::Factor);
  Sweep& s = data.response;
  s.beta.setZero();
  s.b.setZero();
  s.tau.setZero();
  s.z.setZero();
  s.A.setZero();
  s.u_dot.setZero();
  s.ground.setZero();
  return s;
}

Sweep& start_response(const Tree& tree, TreeData& data, const std::vector<int>& bodies) {
  data.demand(Stage::Factor);
  Sweep& s = data.response;
  for (const int b : bodies) {
    const TreeBody& tb = tree[b];
    const int rows = tb.num_hinge_u() + tb.num_modes();
    s.beta.segment(tb.v_offset, 6 + tb.num_modes()).setZero();
    s.b.col(b).setZero();
    s.A.col(b).setZero();
    for (VectorXd* v : {&s.tau, &s.z, &s.u_dot}) v->segment(tb.u_offset, rows).setZero();
  }
  s.ground.setZero();
  return s;
}

void add_response_wrench(const Tree& tree, const TreeData& data, int marker, const Vector6d& wrench, Sweep& s) {
  const Marker& m = tree.markers[static_cast<size_t>(marker)];
  if (m.body < 0) return;
  const TreeBody& tb = tree[m.body];
  const MarkerMotion& motion = data.markers[static_cast<size_t>(marker)];
  const Vector3d f = wrench.head<3>();
  s.beta.segment<3>(tb.v_offset) -= f;
  s.beta.segment<3>(tb.v_offset + 3) -= motion.r.cross(f) + wrench.tail<3>();
  for (int j = 0; j < motion.J.cols(); ++j) s.beta[tb.v_offset + 6 + j] -= motion.J.col(j).dot(wrench);
}

void add_response_jump(const Tree& tree, const TreeData& data, const ConstVectorRef& given, Sweep& s) {
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const BodyData& d = data[b];
    const MarkerMotion& p = data.markers[static_cast<size_t>(tb.parent_marker)];
    const MarkerMotion& c = data.markers[static_cast<size_t>(tb.child_marker)];
    const Matrix3d R_BHp = d.R_PB.transpose() * p.R;
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      const int row = tb.u_offset + i;
      if (data.mode[static_cast<size_t>(row)] == HingeMode::Free) continue;
      const Vector3d angular = R_BHp * d.hinge.H.col(i).tail<3>() * given[row];
      s.b.col(b).head<3>() += R_BHp * d.hinge.H.col(i).head<3>() * given[row] + c.r.cross(angular);
      s.b.col(b).tail<3>() += angular;
      s.u_dot[row] = given[row];
    }
  }
}

void run_response(const Tree& tree, const TreeData& data, Sweep& s) {
  for (int b = tree.size() - 1; b >= 0; --b) solve_to_base(tree, b, data, s);
  for (int b = 0; b < tree.size(); ++b) solve_to_tip(tree, b, data, s);
}

void run_rates(const Tree& tree, const TreeData& data, const ConstVectorRef& u, Sweep& s) {
  data.demand(Stage::Position);
  s.ground.setZero();
  s.u_dot = u;
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const BodyData& d = data[b];
    const int n = tb.num_modes();
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      const auto row = static_cast<size_t>(tb.u_offset + i);
      if (data.mode[row] != HingeMode::Free) s.u_dot[tb.u_offset + i] = 0;
    }
    const Vector6d A_P = tb.parent < 0 ? s.ground : Vector6d(s.A.col(tb.parent));
    Vector6d A;
    if (tb.on_parent.moves) {
      A = carry_by_modes(tree, tb, d, A_P, s.u_dot);
    } else {
      const Vector3d w = A_P.tail<3>();
      A << d.R_PB.transpose() * (A_P.head<3>() + w.cross(d.r_PoBo)), d.R_PB.transpose() * w;
    }
    for (int i = 0; i < d.num_free; ++i) A += d.H.col(i) * s.u_dot[tb.u_offset + d.free[i]];
    if (n > 0 && tb.on_child.moves) A.noalias() -= d.Jc * s.u_dot.segment(tb.eta_dot_offset(), n);
    s.A.col(b) = A;
  }
}

void solve_response(const Tree& tree, TreeData& data, int marker, const Vector6d& wrench,
                    const std::vector<int>& bodies, Eigen::Ref<VectorXd> du) {
  BOUGH_DEMAND(du.size() == tree.num_u);
  Sweep& s = start_response(data);
  add_response_wrench(tree, data, marker, wrench, s);
  for (int b = tree.markers[static_cast<size_t>(marker)].body; b >= 0; b = tree[b].parent)
    solve_to_base(tree, b, data, s);
  if (bodies.empty()) {
    for (int b = 0; b < tree.size(); ++b) solve_to_tip(tree, b, data, s);
  } else {
    for (const int b : bodies) solve_to_tip(tree, b, data, s);
  }
  du = s.u_dot;
}

void solve_jump(const Tree& tree, TreeData& data, const ConstVectorRef& given, Eigen::Ref<VectorXd> du) {
  BOUGH_DEMAND(given.size() == tree.num_u && du.size() == tree.num_u);
  Sweep& s = start_response(data);
  add_response_jump(tree, data, given, s);
  run_response(tree, data, s);
  du = s.u_dot;
}

}  // namespace bough::solver
