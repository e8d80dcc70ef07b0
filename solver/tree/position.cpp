#include <algorithm>
#include <utility>

#include "solver/tree/data.hpp"

namespace bough::solver {

namespace {

// Prescribed coordinates come from their functions, whatever q holds.
void set_given(const TreeBody& tb, TreeData& data) {
  for (size_t i = 0; i < tb.motion.size(); ++i) {
    const int row = tb.u_offset + static_cast<int>(i);
    if (data.mode[static_cast<size_t>(row)] != HingeMode::Prescribed) continue;
    const auto value = data.functions[*tb.motion[i]].calc(data.t);
    data.q[tb.q_offset + static_cast<int>(i)] = value.f;
    data.given_u[row] = value.f_dot;
    data.given_udot[row] = value.f_ddot;
  }
}

// Mass properties of the body without propellant, and of the propellant of now.
void add_content(const TreeBody& tb, TreeData& data, BodyInertia& x) {
  x.mass = tb.body.mass();
  x.S = tb.body.first_moment();
  Matrix3d J = tb.body.M6().bottomRightCorner<3, 3>();
  for (const int i : tb.tanks) {
    TankData& tank = data.tanks[static_cast<size_t>(i)];
    x.mass += tank.content.mass;
    x.S += tank.content.S;
    J += tank.content.J;
  }
  x.M6 << x.mass * Matrix3d::Identity(), -skew(x.S), skew(x.S), J;
}

}  // namespace

void calc_body_position(const Tree& tree, int b, TreeData& data) {
  const TreeBody& tb = tree[b];
  BodyData& d = data[b];
  const BodyState& parent = std::as_const(data)[tb.parent].state;
  const MarkerMotion& p = data.markers[static_cast<size_t>(tb.parent_marker)];
  const MarkerMotion& c = data.markers[static_cast<size_t>(tb.child_marker)];
  set_given(tb, data);
  tb.hinge->calc_position(data.q.data() + tb.q_offset, d.hinge);

  d.R_PB = p.R * d.hinge.R_HpHc * c.R.transpose();
  d.r_PoBo = p.r + p.R * d.hinge.p_HpHc - d.R_PB * c.r;
  d.state.R_WB = parent.R_WB * d.R_PB;
  const Vector3d r_W = parent.R_WB * d.r_PoBo;
  d.state.p_WBo = parent.p_WBo + r_W;
  d.state.root = tb.parent < 0 ? b : parent.root;
  d.state.p_RBo = tb.parent < 0 ? Vector3d::Zero() : Vector3d(parent.p_RBo + r_W);

  if (tb.constant_H.size() == 0 && d.num_free > 0) {
    const Matrix3d R_BHp = d.R_PB.transpose() * p.R;
    for (int i = 0; i < d.num_free; ++i) {
      const Vector3d angular = R_BHp * d.hinge.H.col(d.free[i]).tail<3>();
      d.H.col(i).head<3>() = R_BHp * d.hinge.H.col(d.free[i]).head<3>() + c.r.cross(angular);
      d.H.col(i).tail<3>() = angular;
    }
  }
  for (int j = 0; j < d.Jc.cols(); ++j) {  // S(r_c)⁻¹ J
    d.Jc.col(j) = c.J.col(j);
    d.Jc.col(j).head<3>() += c.r.cross(Vector3d(c.J.col(j).tail<3>()));
  }
  if (tb.on_parent.moves) {
    const Matrix3d R_BP = d.R_PB.transpose();
    const Vector3d e = d.r_PoBo - p.r;
    d.X.topLeftCorner<3, 3>() = R_BP;
    d.X.block<3, 3>(0, 3) = -R_BP * skew(d.r_PoBo);
    d.X.block<3, 3>(3, 3) = R_BP;
    for (int j = 0; j < p.J.cols(); ++j) {
      const Vector3d angular = p.J.col(j).tail<3>();
      d.X.col(6 + j).head<3>() = R_BP * (p.J.col(j).head<3>() - e.cross(angular));
      d.X.col(6 + j).tail<3>() = R_BP * angular;
    }
  }
  if (tb.is_flexible()) {
    tb.body.calc_mass(data.q.segment(tb.eta_offset(), tb.num_modes()), d.inertia);
    d.P6 = d.inertia.M6;  // children add to it
    if (tb.carries_on_modes) {
      d.P_top = d.inertia.M_top;
      d.P_modal = d.inertia.M_modal.topLeftCorner(tb.num_modes(), tb.num_modes());
    }
    d.modal_size = d.inertia.M_modal.diagonal().head(tb.num_modes());
  } else {
    if (!tb.tanks.empty()) add_content(tb, data, d.inertia);
    d.P6 = d.inertia.M6;
  }
  d.second_moment = 0.5 * d.P6.diagonal().tail<3>().sum();
  d.mass_carried = d.inertia.mass;
}

namespace {

void start_position(const Tree& tree, double t, const ConstVectorRef& q, TreeData& data) {
  BOUGH_DEMAND(q.size() == tree.num_q);
  data.q = q;
  data.t = t;
  data.gravity.setZero();
  data.done = static_cast<unsigned>(Stage::Position);
  for (size_t i = 0; i < tree.tanks.size(); ++i)
    data.tanks[i].content = tree.tanks[i].shape->calc(std::max(tree.tanks[i].reserve, data.tanks[i].mass));
  for (const int m : tree.moving) {
    const Marker& marker = tree.markers[static_cast<size_t>(m)];
    const TreeBody& tb = tree[marker.body];
    calc_marker_position(tb.body, marker, data.q.segment(tb.eta_offset(), tb.num_modes()),
                         data.markers[static_cast<size_t>(m)]);
  }
}

void start_velocity(const Tree& tree, const ConstVectorRef& u, TreeData& data) {
  BOUGH_DEMAND(u.size() == tree.num_u);
  data.demand(Stage::Position);
  data.u = u;
  data.applied.setZero();
  data.momentum_out.setZero();
  for (TankData& tank : data.tanks) tank.flow = 0;
  data.hinge_force.setZero();
  data.load_friction.setZero();
  data.transmitted.setZero();
  data.done &= static_cast<unsigned>(Stage::Position) | static_cast<unsigned>(Stage::Factor);
  data.done |= static_cast<unsigned>(Stage::Velocity);
  for (const int m : tree.moving) {
    const Marker& marker = tree.markers[static_cast<size_t>(m)];
    const TreeBody& tb = tree[marker.body];
    calc_marker_velocity(tb.body, marker, data.q.segment(tb.eta_offset(), tb.num_modes()),
                         data.u.segment(tb.eta_dot_offset(), tb.num_modes()), data.markers[static_cast<size_t>(m)]);
  }
}

}  // namespace

void calc_position(const Tree& tree, double t, const ConstVectorRef& q, TreeData& data) {
  start_position(tree, t, q, data);
  for (int b = 0; b < tree.size(); ++b) calc_body_position(tree, b, data);
}

void calc_velocity(const Tree& tree, const ConstVectorRef& u, TreeData& data) {
  start_velocity(tree, u, data);
  for (int b = 0; b < tree.size(); ++b) calc_body_velocity(tree, b, data);
}

void calc_kinematics(const Tree& tree, double t, const ConstVectorRef& q, const ConstVectorRef& u, TreeData& data) {
  start_position(tree, t, q, data);
  start_velocity(tree, u, data);
  for (int b = 0; b < tree.size(); ++b) {
    calc_body_position(tree, b, data);
    calc_body_velocity(tree, b, data);
  }
}

}  // namespace bough::solver
