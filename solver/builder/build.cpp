#include "solver/builder/build.hpp"

#include <algorithm>

#include "solver/builder/levels.hpp"
#include "solver/builder/signals.hpp"
#include "solver/builder/special_node.hpp"
#include "solver/motion/stiffening_terms.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {

std::string quote(const std::string& name) { return "'" + name + "'"; }

namespace {

/// A function without mesh times.
class UnmarkedFunction final : public TimeFunction {
 public:
  explicit UnmarkedFunction(std::unique_ptr<const TimeFunction> own) : own_(std::move(own)) {}
  Value calc(double t) const override { return own_->calc(t); }
  std::vector<double> jump_times() const override { return own_->jump_times(); }
  std::vector<double> force_jump_times() const override { return own_->force_jump_times(); }
  bool has_derivatives() const override { return own_->has_derivatives(); }
  std::unique_ptr<const TimeFunction> clone() const override { return own_->clone(); }

 private:
  std::unique_ptr<const TimeFunction> own_;
};

/// Each after those that it is made of. Reports "function.loop".
class FunctionBuilder {
 public:
  FunctionBuilder(const records::SystemSpec& spec, System& system, Diagnostics& diagnostics)
      : spec_(spec), system_(system), diagnostics_(diagnostics) {
    for (const auto& record : spec.functions) records_.emplace(record.name, &record);
  }
  FunctionMap build() {
    for (const auto& record : spec_.functions) add(record);
    return std::move(made_);
  }

 private:
  void add(const records::FunctionRecord& record) {
    if (made_.count(record.name)) return;
    path_.push_back(record.name);
    for (const auto& name : record.of) {
      const auto found = records_.find(name);
      if (found == records_.end()) continue;
      if (const auto seen = std::find(path_.begin(), path_.end(), name); seen != path_.end()) {
        std::string loop;
        for (auto it = seen; it != path_.end(); ++it) loop += *it + " of ";
        diagnostics_.error("function.loop", record.at, "functions depend on themselves: " + loop + name,
                           "remove one of them from the other");
        made_.emplace(name, nullptr);
      } else {
        add(*found->second);
      }
    }
    path_.pop_back();
    const auto& run = spec_.simulation;
    system_.functions.push_back(make_time_function(record, diagnostics_, {run.start, run.start + run.duration}, made_));
    // Mesh times of a formula are found by intervals of the whole run; fixed steps must not depend on its duration.
    const bool is_fixed = run.integrator == "rk4" || run.integrator == "implicit";
    if (is_fixed && !record.expression.empty() && system_.functions.back())
      system_.functions.back() = std::make_unique<UnmarkedFunction>(std::move(system_.functions.back()));
    if (system_.functions.back()) system_.tree.functions.push_back(system_.functions.back().get());
    made_.emplace(record.name, system_.functions.back().get());
  }

  const records::SystemSpec& spec_;
  System& system_;
  Diagnostics& diagnostics_;
  std::map<std::string, const records::FunctionRecord*> records_;
  std::vector<std::string> path_;
  FunctionMap made_;
};

records::HingeRecord make_free_hinge(const records::SystemSpec& spec, const records::BodyRecord& body,
                                     Diagnostics& diagnostics) {
  records::HingeRecord hinge;
  hinge.name = body.name;
  const auto is_taken = [&](const records::HingeRecord& h) { return h.name == hinge.name; };
  while (std::any_of(spec.hinges.begin(), spec.hinges.end(), is_taken)) hinge.name += "_free";
  hinge.type = records::HingeType::Free;
  hinge.child = body.name;
  hinge.at = body.at;
  diagnostics.note("system.free-body", body.at, "body " + quote(body.name) + " has no hinge: it moves freely");
  return hinge;
}

VectorXd make_modal_state(const std::vector<double>& values, int n) {
  if (values.empty()) return VectorXd::Zero(n);
  return Eigen::Map<const VectorXd>(values.data(), n);
}

Marker build_attachment(const std::string& body_name, const Body& body, int node_id, const Vector3d& p,
                        const Matrix3d& R, const records::HingeRecord& hinge, Diagnostics& diagnostics) {
  Marker a;
  a.p_KM = p;
  a.R_KM = R;
  // A ball joint at the node itself passes on no moment, and a free hinge nothing.
  const bool is_ball =
      hinge.type == records::HingeType::Spherical && p.isZero(0) && hinge.stiffness.empty() && hinge.damping.empty();
  const bool is_free = hinge.type == records::HingeType::Free;
  const bool is_frame = is_free && node_id == 0 && hinge.stiffness.empty() && hinge.damping.empty();
  const std::string user = "hinge " + quote(hinge.name);
  a.node = find_loaded_node(body_name, body, node_id, {!is_frame, !is_ball && !is_free}, hinge.at, user, diagnostics);
  a.node = std::max(0, reject_special_node(body_name, body, a.node, hinge.at, user, diagnostics));
  a.moves = body.nodes()[static_cast<size_t>(a.node)].moves;
  return a;
}

bool check_rotations(const records::HingeRecord& h, Diagnostics& diagnostics) {
  bool good = true;
  for (const Matrix3d* R : {&h.parent_rotation, &h.child_rotation}) {
    if ((*R * R->transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 && R->determinant() > 0) continue;
    diagnostics.error("system.bad-rotation", h.at,
                      "hinge " + quote(h.name) + ": the rotation of its frame on the " +
                          (R == &h.parent_rotation ? "parent" : "child") + " is not a proper rotation matrix");
    good = false;
  }
  return good;
}

// A free hinge coordinate that moves no mass at all.
void check_masses(const Tree& tree, const records::SystemSpec& spec, const TreeOrder& order, Diagnostics& diagnostics) {
  std::vector<double> carried(tree.bodies.size());
  for (size_t b = tree.bodies.size(); b-- > 0;) {
    const TreeBody& tb = tree.bodies[b];
    carried[b] += tb.body.mass() + tb.body.M6().bottomRightCorner<3, 3>().trace();
    for (const int i : tb.tanks) carried[b] += tree.tanks[static_cast<size_t>(i)].initial;
    if (tb.parent >= 0) carried[static_cast<size_t>(tb.parent)] += carried[b];
    if (tb.count(HingeMode::Free) > 0 && carried[b] <= 0) {
      diagnostics.error("system.massless", spec.bodies[static_cast<size_t>(order.body[b])].at,
                        "body " + quote(tb.name) + " and what it carries have no mass, yet its hinge " +
                            quote(tb.hinge_name) + " is free to move",
                        "give it mass and inertia, or fix or prescribe the hinge");
    }
  }
}

void add_force_marker(AppliedForce& force, Tree& tree) {
  if (force.pattern.size() > 0) return;
  Marker at;
  at.body = force.body;
  at.node = force.node;
  at.moves = tree[force.body].body.nodes()[static_cast<size_t>(force.node)].moves;
  force.marker = tree.add_marker(at);
}

void collect_jump_times(System& system) {
  const auto add = [](std::vector<double>& to, const std::vector<double>& times) {
    to.insert(to.end(), times.begin(), times.end());
  };
  const auto add_motion = [&](const TimeFunction* f) {
    if (f == nullptr) return;
    add(system.jump_times, f->jump_times());
    add(system.mesh_times, f->mesh_times());
  };
  for (const TreeBody& tb : system.tree.bodies) std::for_each(tb.motion.begin(), tb.motion.end(), add_motion);
  const auto add_force = [&](const TimeFunction* f) {
    if (f == nullptr) return;
    add(system.jump_times, f->force_jump_times());
    add(system.mesh_times, f->mesh_times());
  };
  for (const AppliedForce& force : system.forces) add_force(force.function);
  for (const auto& element : system.elements) add_force(element->function());
  for (const Tank& tank : system.tree.tanks) add_force(tank.function);
  for (auto* times : {&system.jump_times, &system.mesh_times}) {
    std::sort(times->begin(), times->end());
    times->erase(std::unique(times->begin(), times->end()), times->end());
  }
}

/// Replaces a hinge that could not be made, so that the bodies attached to it are checked.
std::unique_ptr<const Hinge> make_placeholder(records::HingeRecord record) {
  Diagnostics ignored;
  record.type = records::HingeType::Fixed;
  return make_hinge(record, ignored);
}

}  // namespace

System build_system(const records::SystemSpec& spec, const FlexMap& flex, Diagnostics& diagnostics) {
  System system = draft_system(spec, flex, diagnostics);
  diagnostics.throw_if_errors();
  return system;
}

namespace {
void collect_left_out(const records::SystemSpec& spec, const FlexMap& flex, System& system) {
  system.left_out.resize(static_cast<size_t>(system.num_bodies()));
  for (const auto& r : spec.bodies) {
    const int b = system.find_body(r.name);
    const auto found = flex.find(r.file);
    if (r.stiffening || b < 0 || found == flex.end() || !system.is_valid(b) || system.num_modes(b) == 0) continue;
    system.left_out[static_cast<size_t>(b)] = std::make_shared<const StiffeningTerms>(
        StiffeningTerms::collect(spec, system.tree, system.loops, system.forces, found->second, b, true));
  }
}
}  // namespace

namespace {
System draft_one(const records::SystemSpec& spec, const FlexMap& flex, Diagnostics& diagnostics);
}  // namespace

System draft_system(const records::SystemSpec& spec, const FlexMap& flex, Diagnostics& diagnostics) {
  System system = draft_one(spec, flex, diagnostics);
  const auto has_levels = [](const records::BodyRecord& r) { return !r.levels.empty(); };
  if (diagnostics.num_errors() == 0 && std::any_of(spec.bodies.begin(), spec.bodies.end(), has_levels))
    build_variants(spec, flex, system, diagnostics);
  return system;
}

namespace {
System draft_one(const records::SystemSpec& spec, const FlexMap& flex, Diagnostics& diagnostics) {
  System system;
  Tree& tree = system.tree;
  system.gravity.uniform = spec.simulation.gravity;
  system.start = spec.simulation.start;
  system.is_lagged = spec.simulation.stiffening == "lagged";
  const SignalUses uses = collect_uses(spec, diagnostics);
  const FunctionMap functions = FunctionBuilder(spec, system, diagnostics).build();
  const TreeOrder order = order_tree(spec, diagnostics);
  for (const auto& record : spec.bodies) {
    if (!order.tree_index.count(record.name)) build_body(record, flex, diagnostics);  // for its own errors
  }
  for (size_t b = 0; b < order.body.size(); ++b) {
    const auto& record = spec.bodies[static_cast<size_t>(order.body[b])];
    const records::HingeRecord hinge = order.hinge[b] < 0 ? make_free_hinge(spec, record, diagnostics)
                                                          : spec.hinges[static_cast<size_t>(order.hinge[b])];
    TreeBody tb;
    tb.name = record.name;
    tb.hinge_name = hinge.name;
    tb.hinge_at = hinge.at;
    tb.parent = hinge.parent == "ground" ? -1 : order.tree_index.at(hinge.parent);
    tb.hinge = make_hinge(hinge, diagnostics);
    auto body = build_body(record, flex, diagnostics, system.is_lagged);
    const bool rotations_good = check_rotations(hinge, diagnostics);
    if (tb.hinge) build_hinge_coordinates(hinge, functions, tb, diagnostics);
    check_motion(hinge, spec.simulation, tb, diagnostics);
    const bool is_valid = body && tb.hinge && rotations_good;
    system.body_is_valid.push_back(is_valid);
    if (!is_valid) {
      if (!tb.hinge) tb.hinge = make_placeholder(hinge);
      body = Body::make_rigid(1, Vector3d::Zero(), Matrix3d::Identity());
    } else {
      const int n = body->num_modes();
      tb.initial_eta = make_modal_state(record.eta, n);
      tb.initial_eta_dot = make_modal_state(record.eta_dot, n);
      tb.on_child = build_attachment(tb.name, *body, hinge.child_node, hinge.child_position, hinge.child_rotation,
                                     hinge, diagnostics);
    }
    const bool is_flexible = body->num_modes() > 0;
    tb.body = std::move(*body);
    if (is_flexible) check_flexible_body(tb, flex.at(record.file), record, diagnostics);
    // A parent whose record failed has no nodes to look up.
    if (tb.parent < 0) {
      tb.on_parent.p_KM = hinge.parent_position;
      tb.on_parent.R_KM = hinge.parent_rotation;
      if (hinge.parent_node != 0) {
        diagnostics.error("system.unknown-node", hinge.at,
                          "hinge " + quote(hinge.name) + " names node " + std::to_string(hinge.parent_node) +
                              " of ground, which has only node 0",
                          "give parent_position instead");
      }
    } else if (system.body_is_valid[static_cast<size_t>(tb.parent)]) {
      const TreeBody& parent = tree.bodies[static_cast<size_t>(tb.parent)];
      tb.on_parent = build_attachment(parent.name, parent.body, hinge.parent_node, hinge.parent_position,
                                      hinge.parent_rotation, hinge, diagnostics);
    }
    tree.bodies.push_back(std::move(tb));
  }
  build_tanks(spec, order, functions, system, diagnostics);
  std::vector<std::string> body_names;
  for (const auto& record : spec.bodies) body_names.push_back(record.name);
  for (const auto& record : spec.forces) {
    const auto found = order.tree_index.find(record.body);
    if (found == order.tree_index.end()) {
      if (std::find(body_names.begin(), body_names.end(), record.body) != body_names.end()) continue;  // in a loop
      diagnostics.error("system.unknown-body", record.at,
                        "force " + quote(record.name) + " names body " + quote(record.body) + ", which does not exist",
                        suggest_name(record.body, body_names, "declare it"));
      continue;
    }
    if (!system.body_is_valid[static_cast<size_t>(found->second)]) continue;
    const auto& file = spec.bodies[static_cast<size_t>(order.body[static_cast<size_t>(found->second)])].file;
    const auto flex_record = flex.find(file);
    auto force = build_force(record, tree, found->second, flex_record == flex.end() ? nullptr : &flex_record->second,
                             functions, diagnostics);
    if (force) (uses.forces.count(record.name) ? system.driven : system.forces).push_back(std::move(*force));
  }
  if (!system.gravity.uniform.allFinite()) {
    diagnostics.error("system.bad-gravity", spec.simulation.at, "gravity is not three finite numbers");
  }
  const bool is_complete =
      std::find(system.body_is_valid.begin(), system.body_is_valid.end(), false) == system.body_is_valid.end();
  if (is_complete) check_masses(tree, spec, order, diagnostics);
  tree.finish();
  for (auto* forces : {&system.forces, &system.driven})
    for (AppliedForce& force : *forces) add_force_marker(force, tree);
  build_constraints(spec, order, system, diagnostics);
  const ElementContext context{spec, order, flex, functions, system.body_is_valid};
  for (const auto& record : spec.force_elements) {
    auto element = build_element(record, context, tree, diagnostics);
    if (!element) continue;
    if (const auto* source = dynamic_cast<const CentralGravity*>(element.get()))
      system.gravity.central.push_back(source);
    system.elements.push_back(std::move(element));
  }
  for (size_t b = 0; b < tree.bodies.size(); ++b) {
    if (order.hinge[b] < 0 || !system.body_is_valid[b]) continue;
    build_hinge_laws(spec.hinges[static_cast<size_t>(order.hinge[b])], context, tree.bodies[b], system.elements,
                     system.joint_contacts, system.load_frictions, diagnostics);
    for (LoadFriction& f : system.load_frictions)
      if (f.body < 0) f.body = static_cast<int>(b);
  }
  build_recoveries(spec, flex, system, diagnostics);
  collect_left_out(spec, flex, system);
  build_signals(spec, flex, functions, uses, system, diagnostics);
  collect_jump_times(system);
  if (diagnostics.num_errors() == 0 && system.loops.size() > 0) assemble(spec, order, system, diagnostics);
  if (diagnostics.num_errors() == 0) check_stops(system, diagnostics);
  if (diagnostics.num_errors() == 0) check_shapes(spec, system, flex, diagnostics);
  return system;
}
}  // namespace

}  // namespace bough::solver
