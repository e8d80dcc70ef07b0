#include "solver/motion/node_load.hpp"

namespace bough::solver {

std::vector<NodeSource> list_node_sources(const Tree& tree, const Loops& loops, const std::vector<AppliedForce>& forces,
                                          int body) {
  std::vector<NodeSource> all;
  for (int c = 0; c < tree.size(); ++c) {
    const TreeBody& tb = tree[c];
    if (tb.parent == body) all.push_back({tb.on_parent.node, c, -1, true, nullptr});
    if (c == body) all.push_back({tb.on_child.node, c, -1, false, nullptr});
  }
  for (int c = 0; c < loops.size(); ++c) {
    if (!loops[c].closure) continue;
    for (const bool is_parent : {true, false}) {
      const int marker = is_parent ? loops[c].parent_marker : loops[c].child_marker;
      const Marker& m = tree.markers[static_cast<size_t>(marker)];
      if (m.body == body) all.push_back({m.node, -1, c, is_parent, nullptr});
    }
  }
  for (const AppliedForce& force : forces)
    if (force.body == body && force.pattern.size() == 0) all.push_back({force.node, -1, -1, false, &force});
  return all;
}

namespace {

/// A wrench on the child at `at` (in W), in axes R_WH, as one on the node of `body`.
Vector6d bring_to_node(const NodeSource& source, int body, const Motion& motion, const Matrix3d& R_WH, const Place& at,
                       const Vector3d& force_H, const Vector3d& moment_H) {
  const Matrix3d& R_WB = motion.get_state(body).R_WB;
  const Matrix3d R_BH = R_WB.transpose() * R_WH;
  const double sign = source.is_parent ? -1 : 1;
  const Vector3d force = sign * (R_BH * force_H);
  const NodeMotion node = calc_node_motion(motion, body, source.node);
  const Vector3d arm = R_WB.transpose() * (at - node.place());
  Vector6d load;
  load << force, sign * (R_BH * moment_H) + arm.cross(force);
  return load;
}

}  // namespace

Vector6d calc_node_load(const NodeSource& source, int body, const Motion& motion) {
  const Tree& tree = motion.tree;
  const TreeData& data = motion.data;
  if (source.force != nullptr) {
    const AppliedForce& f = *source.force;
    Vector3d v = (f.function ? data.functions[*f.function].calc(data.t).f : 1.0) * f.direction;
    if (f.frame == records::VectorFrame::Inertial) v = motion.get_state(body).R_WB.transpose() * v;
    if (f.frame == records::VectorFrame::Node) v = data.markers[static_cast<size_t>(f.marker)].R * v;
    Vector6d load = Vector6d::Zero();
    load.segment<3>(f.kind == records::ForceKind::Force ? 0 : 3) = v;
    return load;
  }
  const auto get_axes = [&](int b, int marker, const Matrix3d& on_ground) -> Matrix3d {
    if (b < 0) return on_ground;
    return data[b].state.R_WB * data.markers[static_cast<size_t>(marker)].R;
  };
  const auto get_place = [&](int b, int marker, const Vector3d& on_ground) -> Place {
    if (b < 0) return {on_ground, on_ground};
    return data[b].state.calc_place(data.markers[static_cast<size_t>(marker)].r);
  };
  if (source.hinge >= 0) {
    // On the child at Hc's origin, in Hp.
    const HingeReaction r = calc_hinge_reaction(tree, data, source.hinge);
    const TreeBody& tb = tree[source.hinge];
    return bring_to_node(source, body, motion, get_axes(tb.parent, tb.parent_marker, tb.on_parent.R_KM),
                         get_place(source.hinge, tb.child_marker, Vector3d::Zero()), r.force, r.moment);
  }
  const Constraint& c = motion.loops[source.constraint];
  const ConstraintReaction r = get_constraint_reaction(motion, source.constraint);
  const Marker& parent = tree.markers[static_cast<size_t>(c.parent_marker)];
  const Marker& child = tree.markers[static_cast<size_t>(c.child_marker)];
  return bring_to_node(source, body, motion, get_axes(parent.body, c.parent_marker, parent.R_KM),
                       get_place(child.body, c.child_marker, child.p_KM), r.force, r.moment);
}

}  // namespace bough::solver
