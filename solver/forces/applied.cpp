#include "solver/forces/applied.hpp"

namespace bough::solver {

void add_wrench_in_body(const TreeBody& tb, int node_index, const VectorXd& q, const Vector3d& f, const Vector3d& t,
                        BodyData& d) {
  const int n = tb.body.num_modes();
  const Node& node = tb.body.nodes()[static_cast<size_t>(node_index)];
  const auto eta = q.segment(tb.eta_offset(), n);
  NodeInBody k;
  calc_node_in_body(node, eta, eta, k);
  d.applied.head<3>() += f;
  d.applied.segment<3>(3) += k.r.cross(f) + t;
  add_node_generalized_force(node, eta, k.T, f, t, d.applied.tail(n));
}

void add_applied_force(const AppliedForce& force, const Tree& tree, double t, TreeData& data) {
  const TreeBody& tb = tree.bodies[static_cast<size_t>(force.body)];
  BodyData& d = data.bodies[static_cast<size_t>(force.body)];
  const double value = force.function ? force.function->calc(t).f : 1.0;
  const int n = tb.body.num_modes();
  const auto eta = data.q.segment(tb.eta_offset(), n);
  if (force.pattern.size() > 0) {
    d.applied.head<6>() += value * force.pattern_resultant;
    d.applied.segment<3>(3).noalias() += value * (force.pattern_moment * eta);
    d.applied.tail(n) += value * force.pattern;
    d.applied.tail(n).noalias() -= value * (force.pattern_K2 * eta);
    return;
  }
  Vector3d load = value * force.direction;
  if (force.frame == records::VectorFrame::Inertial) {
    load = d.state.R_WB.transpose() * load;
  } else if (force.frame == records::VectorFrame::Node) {
    NodeInBody k;
    calc_node_in_body(tb.body.nodes()[static_cast<size_t>(force.node)], eta, eta, k);
    load = k.R_BK * load;
  }
  const bool is_force = force.kind == records::ForceKind::Force;
  add_wrench_in_body(tb, force.node, data.q, is_force ? load : Vector3d::Zero(), is_force ? Vector3d::Zero() : load, d);
}

void add_hinge_forces(const Tree& tree, TreeData& data) {
  for (size_t b = 0; b < tree.bodies.size(); ++b) {
    const TreeBody& tb = tree.bodies[b];
    BodyData& d = data.bodies[b];
    if (tb.stiffness.size() > 0) {
      d.spring_energy = tb.hinge->calc_spring(data.q.data() + tb.q_offset, tb.null_position.data(), tb.stiffness.data(),
                                              d.hinge_force.data());
    }
    for (int i = 0; i < tb.damping.size(); ++i) d.hinge_force[i] -= tb.damping[i] * d.hinge_rate[i];
  }
}

}  // namespace bough::solver
