#include "solver/forces/flow.hpp"

namespace bough::solver {

void add_outflow(const Tree& tree, int tank, const Outflow& out, TreeData& data) {
  data.demand(Stage::Velocity);
  const Tank& of = tree.tanks[static_cast<size_t>(tank)];
  TankData& own = data.tanks[static_cast<size_t>(tank)];
  own.flow += out.flow;
  const BodyState& s = data[of.body].state;
  const Vector3d &w = s.w_B, &e = out.exit;
  // Momentum of the flow in the body, and its angular momentum about Bo.
  const Vector3d relative = out.flow * (e - own.content.S_m);
  const Vector3d turning_flow = w.cross(own.content.S_m.cross(relative));
  // Angular momentum per mass at the exit about Bo, of the turning alone: E ω, and that of the nozzle's disc.
  const Vector3d of_disc = 0.25 * out.radius * out.radius * (w + out.axis * out.axis.dot(w));
  const Vector3d of_exit = e.cross(w.cross(e)) + of_disc;
  const int v = tree[of.body].v_offset;
  data.applied.segment<3>(v) -= 2 * w.cross(relative);
  data.applied.segment<3>(v + 3) -= out.flow * (of_exit - own.content.J_m * w) + turning_flow;

  const Matrix3d& R = s.R_WB;
  const Vector3d leaving = R * (out.flow * (s.v_B + w.cross(e)) - out.thrust);
  const Vector3d turning = R * w.cross(relative);
  data.momentum_out.head<3>() += leaving + turning;
  data.momentum_out.tail<3>() += (s.p_WBo + R * e).cross(leaving) + s.p_WBo.cross(turning) +
                                 R * (s.v_B.cross(relative) + out.flow * of_disc + turning_flow);
}

void add_prescribed_flow(const Tree& tree, int tank, TreeData& data) {
  const Tank& of = tree.tanks[static_cast<size_t>(tank)];
  if (!of.function) return;
  const double flow = -data.functions[*of.function].calc(data.t).f_dot;
  if (flow == 0) return;
  add_outflow(tree, tank, {flow, of.exit, of.exit_radius, of.exit_axis, Vector3d::Zero()}, data);
}

}  // namespace bough::solver
