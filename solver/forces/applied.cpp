#include "solver/forces/applied.hpp"

#include "solver/bodies/kernels.hpp"

#include <cmath>
#include <sstream>

namespace bough::solver {

namespace {

[[noreturn]] void fail_spring(const TreeBody& tb, double t) {
  std::ostringstream what;
  what << "the spring of hinge '" << tb.hinge_name << "' is turned by more than 343 degrees at t = " << t;
  throw ComputationError("solver.spring-past-turn", tb.hinge_at, what.str(),
                         "springs of spherical and free hinges act in the rotation vector, which ends at one turn: use "
                         "revolute or universal hinges where bodies turn further");
}

}  // namespace

void add_marker_wrench(const Tree& tree, int marker, const Vector3d& f, const Vector3d& t, TreeData& data) {
  const Marker& m = tree.markers[static_cast<size_t>(marker)];
  if (m.body < 0) return;
  const MarkerMotion& motion = data.markers[static_cast<size_t>(marker)];
  const int v = tree[m.body].v_offset;
  data.applied.segment<3>(v) += f;
  data.applied.segment<3>(v + 3) += motion.r.cross(f) + t;
  for (int j = 0; j < motion.J.cols(); ++j)
    data.applied[v + 6 + j] += motion.J.col(j).head<3>().dot(f) + motion.J.col(j).tail<3>().dot(t);
}

void add_wrench_in_body(const TreeBody& tb, int node_index, const Vector3d& f, const Vector3d& t, TreeData& data) {
  const int n = tb.num_modes();
  const Node& node = tb.body.nodes()[static_cast<size_t>(node_index)];
  const auto eta = data.q.segment(tb.eta_offset(), n);
  NodeInBody k;
  calc_node_in_body(node, eta, eta, k);
  data.applied.segment<3>(tb.v_offset) += f;
  data.applied.segment<3>(tb.v_offset + 3) += k.r.cross(f) + t;
  add_node_generalized_force(node, eta, k.T, f, t, data.applied.segment(tb.v_offset + 6, n));
}

void add_applied_force(const AppliedForce& force, const Tree& tree, double t, TreeData& data) {
  add_applied_load(force, tree, force.function ? data.functions[*force.function].calc(t).f : 1.0, data);
}

void add_applied_load(const AppliedForce& force, const Tree& tree, double value, TreeData& data) {
  const TreeBody& tb = tree[force.body];
  if (force.pattern.size() > 0) {
    const int n = tb.num_modes();
    const auto eta = data.q.segment(tb.eta_offset(), n);
    auto modal = data.applied.segment(tb.v_offset + 6, n);
    data.applied.segment<6>(tb.v_offset) += value * force.pattern_resultant;
    data.applied.segment<3>(tb.v_offset + 3).noalias() += value * (force.pattern_moment * eta);
    modal += value * force.pattern;
    if (force.pattern_higher.empty()) {
      modal.noalias() -= value * (force.pattern_K2 * eta);
    } else {
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, records::kMaxThirdOrderModes, 1> gradient(n);
      force.pattern_higher.calc(eta, gradient.data());
      modal += value * gradient;
    }
    return;
  }
  Vector3d load = value * force.direction;
  if (force.frame == records::VectorFrame::Inertial) {
    load = data[force.body].state.R_WB.transpose() * load;
  } else if (force.frame == records::VectorFrame::Node) {
    load = data.markers[static_cast<size_t>(force.marker)].R * load;
  }
  const bool is_force = force.kind == records::ForceKind::Force;
  add_marker_wrench(tree, force.marker, is_force ? load : Vector3d::Zero(), is_force ? Vector3d::Zero() : load, data);
}

void add_hinge_forces(const Tree& tree, TreeData& data) {
  for (const TreeBody& tb : tree.bodies) {
    double* force = data.hinge_force.data() + tb.u_offset;
    if (tb.stiffness.size() > 0 &&
        std::isnan(
            tb.hinge->calc_spring(data.q.data() + tb.q_offset, tb.null_position.data(), tb.stiffness.data(), force)))
      fail_spring(tb, data.t);
    for (int i = 0; i < tb.damping.size(); ++i) force[i] -= tb.damping[i] * data.u[tb.u_offset + i];
    if (tb.motion.empty()) continue;
    for (int i = 0; i < tb.num_hinge_u(); ++i)
      if (data.mode[static_cast<size_t>(tb.u_offset + i)] == HingeMode::Prescribed) force[i] = 0;
  }
}

}  // namespace bough::solver
