#include <utility>

#include "solver/tree/data.hpp"

namespace bough::solver {

namespace {

// Acceleration of a marker at zero a, α, η̈ of its body, which turns at w.
void add_marker_bias(const MarkerMotion& m, const Vector3d& w, Vector3d& linear, Vector3d& angular) {
  linear += w.cross(w.cross(m.r)) + 2 * w.cross(m.v) + m.gamma_v;
  angular += w.cross(m.w) + m.gamma_w;
}

// H constant in B: all in B, r = p_PoBo, [v_rel; w_rel] = H u.
void calc_constant_hinge(const TreeBody& tb, const BodyState& P, TreeData& data, BodyData& d, Eigen::Ref<Vector6d> b) {
  const Matrix3d R_BP = d.R_PB.transpose();
  Vector6d V_rel = Vector6d::Zero(), A_rel = Vector6d::Zero();
  for (int i = 0; i < tb.num_hinge_u(); ++i) V_rel += tb.constant_H.col(i) * data.u[tb.u_offset + i];
  if (d.num_free < tb.num_hinge_u()) {
    for (int i = 0; i < tb.num_hinge_u(); ++i) A_rel += tb.constant_H.col(i) * data.given_udot[tb.u_offset + i];
  }
  const Vector3d v_rel = V_rel.head<3>(), w_rel = V_rel.tail<3>();
  const Vector3d w_P = R_BP * P.w_B, turning = P.w_B.cross(d.r_PoBo);
  d.state.w_B = w_P + w_rel;
  d.state.v_B = R_BP * (P.v_B + turning) + v_rel;
  b.head<3>() = R_BP * P.w_B.cross(turning) + (w_P + d.state.w_B).cross(v_rel) + A_rel.head<3>();
  b.tail<3>() = w_P.cross(w_rel) + A_rel.tail<3>();
}

// Velocities through Hp and Hc, so that each Jacobian is used once only.
void calc_general_hinge(const TreeBody& tb, const BodyState& P, TreeData& data, BodyData& d, Eigen::Ref<Vector6d> b) {
  const MarkerMotion& p = data.markers[static_cast<size_t>(tb.parent_marker)];
  const MarkerMotion& c = data.markers[static_cast<size_t>(tb.child_marker)];
  tb.hinge->calc_bias(data.u.data() + tb.u_offset, d.hinge);
  Vector6d V_rel = Vector6d::Zero(), A_rel = d.hinge.bias;
  for (int i = 0; i < tb.num_hinge_u(); ++i) V_rel += d.hinge.H.col(i) * data.u[tb.u_offset + i];
  if (d.num_free < tb.num_hinge_u()) {
    for (int i = 0; i < tb.num_hinge_u(); ++i) A_rel += d.hinge.H.col(i) * data.given_udot[tb.u_offset + i];
  }
  const Matrix3d R_BP = d.R_PB.transpose();
  const Vector3d d_P = p.R * d.hinge.p_HpHc;  // Hp to Hc
  const Vector3d& w_P = P.w_B;
  const Vector3d w_Hp = w_P + p.w, v_rel = p.R * V_rel.head<3>(), w_rel = p.R * V_rel.tail<3>();
  const Vector3d v_Hc = P.v_B + w_P.cross(p.r) + p.v + w_Hp.cross(d_P) + v_rel;
  d.state.w_B = R_BP * (w_Hp + w_rel) - c.w;
  d.state.v_B = R_BP * v_Hc - c.v - d.state.w_B.cross(c.r);

  // Bias acceleration of Hc in P, then of Bo in B.
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
  add_marker_bias(p, w_P, linear, angular);
  linear += angular.cross(d_P) + w_Hp.cross(w_Hp.cross(d_P)) + 2 * w_Hp.cross(v_rel) + p.R * A_rel.head<3>();
  angular += w_Hp.cross(w_rel) + p.R * A_rel.tail<3>();
  Vector3d linear_c = Vector3d::Zero(), angular_c = Vector3d::Zero();
  add_marker_bias(c, d.state.w_B, linear_c, angular_c);
  const Vector3d b_angular = R_BP * angular - angular_c;
  b.head<3>() = R_BP * linear - linear_c + c.r.cross(b_angular);
  b.tail<3>() = b_angular;
}

}  // namespace

void calc_body_velocity(const Tree& tree, int b, TreeData& data) {
  const TreeBody& tb = tree[b];
  BodyData& d = data[b];
  const BodyState& P = std::as_const(data)[tb.parent].state;
  if (d.num_free < tb.num_hinge_u()) {
    for (int row = tb.u_offset; row < tb.eta_dot_offset(); ++row) {
      if (data.mode[static_cast<size_t>(row)] != HingeMode::Free) data.u[row] = data.given_u[row];
    }
  }
  if (tb.constant_H.size() > 0 || (tb.num_hinge_u() == 0 && !tb.on_parent.moves && !tb.on_child.moves)) {
    calc_constant_hinge(tb, P, data, d, data.motion.b.col(b));
  } else {
    calc_general_hinge(tb, P, data, d, data.motion.b.col(b));
  }
  const int n = tb.num_modes();
  if (n > 0) {
    tb.body.calc_bias(d.state.w_B, data.q.segment(tb.eta_offset(), n), data.u.segment(tb.eta_dot_offset(), n),
                      d.inertia);
    data.h.segment(tb.v_offset, 6 + n) = d.inertia.h;
  } else {
    calc_rigid_bias(d.inertia, d.state.w_B, data.h.data() + tb.v_offset);
  }
}

}  // namespace bough::solver
