#include "solver/motion/motion.hpp"

namespace bough::solver {

namespace {
NodeInBody calc_node(const TreeBody& tb, const TreeData& data, int node_index) {
  const int n = tb.body.num_modes();
  NodeInBody k;
  calc_node_in_body(tb.body.nodes()[static_cast<size_t>(node_index)], data.q.segment(tb.eta_offset(), n),
                    data.u.segment(tb.eta_dot_offset(), n), k);
  return k;
}
}  // namespace

NodeMotion calc_node_motion(const Motion& motion, int body, int node_index) {
  const TreeBody& tb = motion.tree[body];
  const TreeData& data = motion.data;
  const Node& node = tb.body.nodes()[static_cast<size_t>(node_index)];
  const BodyState& s = data[body].state;
  const NodeInBody k = calc_node(tb, data, node_index);
  Vector3d a_rel = k.gamma_t, alpha_rel = k.gamma_r;  // + J η̈
  if (node.moves) {
    add_node_acceleration(node, data.q.segment(tb.eta_offset(), tb.body.num_modes()),
                          data.motion.u_dot.segment(tb.eta_dot_offset(), tb.num_modes()), k.T, a_rel, alpha_rel);
  }
  NodeMotion m;
  const Matrix3d& R = s.R_WB;
  const Place place = s.calc_place(k.r);
  m.p_WK = place.p_W;
  m.p_RK = place.p_R;
  m.root = place.root;
  m.R_WK = R * k.R_BK;
  m.v_WK = R * (s.v_B + s.w_B.cross(k.r) + k.v);
  m.w_WK = R * (s.w_B + k.w);
  m.a_WK = R * (s.a_B + s.alpha_B.cross(k.r) + s.w_B.cross(s.w_B.cross(k.r)) + 2 * s.w_B.cross(k.v) + a_rel);
  m.alpha_WK = R * (s.alpha_B + s.w_B.cross(k.w) + alpha_rel);
  return m;
}

void calc_node_deflection(const Motion& motion, int body, int node_index, Vector3d& deflection_B,
                          Vector3d& rotation_B) {
  const TreeBody& tb = motion.tree[body];
  const NodeInBody k = calc_node(tb, motion.data, node_index);
  deflection_B = k.r - tb.body.nodes()[static_cast<size_t>(node_index)].p;
  rotation_B = k.theta;
}

void get_hinge(const Motion& motion, int body, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> q_dot,
               Eigen::Ref<VectorXd> force) {
  const TreeBody& tb = motion.tree[body];
  const int nu = tb.num_hinge_u();
  BOUGH_DEMAND(q.size() == tb.num_hinge_q() && q_dot.size() == nu && force.size() == nu);
  tb.hinge->get_for_file(motion.data.q.data() + tb.q_offset, q.data());
  q_dot = motion.data.u.segment(tb.u_offset, nu);
  for (int i = 0; i < nu; ++i) force[i] = motion.data.get_hinge_force(tb.u_offset + i);
}

ConstraintReaction get_constraint_reaction(const Motion& motion, int constraint) {
  const Vector6d wrench = calc_constraint_wrench(motion.loops, motion.loop_data, constraint);
  const ConstraintData& d = motion.loop_data[constraint];
  const bool couples = !motion.loops[constraint].closure && d.state.is_closed;
  return {wrench.head<3>(), wrench.tail<3>(), couples ? d.lambda[0] : 0};
}

}  // namespace bough::solver
