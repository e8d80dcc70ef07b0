// Motion of nodes as sensors see it.
#include "solver/system/system.hpp"

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

NodeMotion calc_node_motion(const System& system, const SystemData& data, int body, int node_index) {
  const TreeBody& tb = system.tree.bodies[static_cast<size_t>(body)];
  const BodyData& d = data.tree.bodies[static_cast<size_t>(body)];
  const Node& node = tb.body.nodes()[static_cast<size_t>(node_index)];
  const BodyState& s = d.state;
  const NodeInBody k = calc_node(tb, data.tree, node_index);
  Vector3d a_rel = k.gamma_t, alpha_rel = k.gamma_r;  // + J η̈
  if (node.moves) {
    add_node_acceleration(node, data.tree.q.segment(tb.eta_offset(), tb.body.num_modes()),
                          data.tree.motion.u_dot.segment(tb.eta_dot_offset(), tb.num_modes()), k.T, a_rel, alpha_rel);
  }
  NodeMotion m;
  const Matrix3d& R = s.R_WB;
  m.p_WK = s.p_WBo + R * k.r;
  m.R_WK = R * k.R_BK;
  m.v_WK = R * (s.v_B + s.w_B.cross(k.r) + k.v);
  m.w_WK = R * (s.w_B + k.w);
  m.a_WK = R * (s.a_B + s.alpha_B.cross(k.r) + s.w_B.cross(s.w_B.cross(k.r)) + 2 * s.w_B.cross(k.v) + a_rel);
  m.alpha_WK = R * (s.alpha_B + s.w_B.cross(k.w) + alpha_rel);
  return m;
}

void calc_node_deflection(const System& system, const SystemData& data, int body, int node_index,
                          Vector3d& deflection_B, Vector3d& rotation_B) {
  const TreeBody& tb = system.tree.bodies[static_cast<size_t>(body)];
  const NodeInBody k = calc_node(tb, data.tree, node_index);
  deflection_B = k.r - tb.body.nodes()[static_cast<size_t>(node_index)].p;
  rotation_B = k.theta;
}

}  // namespace bough::solver
