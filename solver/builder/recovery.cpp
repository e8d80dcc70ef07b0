#include <algorithm>
#include <numeric>

#include "formats/records/mode_subset.hpp"
#include "solver/builder/build.hpp"

namespace bough::solver {
namespace {

std::string list_names(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Loads on the body whose values recovery does not know.
std::vector<std::string> list_unknown_loads(const records::SystemSpec& spec, const System& system, int b,
                                            const std::string& name) {
  std::vector<std::string> names;
  for (const auto& r : spec.actuators)
    if (r.body == name) names.push_back(r.name);
  for (const auto& r : spec.force_elements) {
    const bool is_field = r.type == records::ElementType::CentralGravity;  // known: a part of A_I
    if (!is_field && (r.from.body == name || r.to.body == name)) names.push_back(r.name);
  }
  for (const auto& force : system.driven)
    if (force.body == b) names.push_back(force.name);
  return names;
}

/// Reports nodes at constraints without a static shape: the flexibility of the normal modes alone is too small there,
/// so the reaction is that of a body that is too stiff.
void report_held_nodes(const records::SystemSpec& spec, const records::BodyRecord& r, const records::FlexBody& body,
                       Diagnostics& diagnostics) {
  const bool has_static =
      std::any_of(body.kind.begin(), body.kind.end(), [](auto kind) { return kind != records::ModeKind::Normal; });
  const auto& known = body.interface_nodes;
  for (const auto& c : spec.constraints)
    for (const auto& [name, node] : {std::pair(c.parent, c.parent_node), std::pair(c.child, c.child_node)}) {
      if (name != r.name || node == 0) continue;
      const bool is_interface = std::find(known.begin(), known.end(), node) != known.end();
      if (has_static && is_interface) continue;
      diagnostics.warning(
          "system.recovery-constraint", c.at,
          "constraint '" + c.name + "' holds node " + std::to_string(node) + " of body '" + r.name +
              "', which has no attachment, constraint or residual mode for a force there: where its normal modes give "
              "way too little, the reaction and the forces in elements are wrong",
          is_interface
              ? "reduce the body with residual = [\"interface\"]"
              : "reduce the body with interface = [" + std::to_string(node) + "] and residual = [\"interface\"]");
    }
}

}  // namespace

void build_recoveries(const records::SystemSpec& spec, const FlexMap& flex, System& system, Diagnostics& diagnostics) {
  system.recoveries.resize(static_cast<size_t>(system.num_bodies()));
  for (const auto& r : spec.bodies) {
    const bool is_sensed = std::any_of(spec.sensors.begin(), spec.sensors.end(), [&](const auto& s) {
      return s.type == records::SensorType::Element && s.body == r.name;
    });
    const bool is_asked = r.recover_all || !r.recover.empty();
    const int b = system.find_body(r.name);
    const auto found = flex.find(r.file);
    if (!(is_asked || is_sensed) || b < 0 || !system.is_valid(b) || found == flex.end()) continue;
    if (found->second.recovery.empty() || system.num_modes(b) == 0) {
      if (is_asked)
        diagnostics.error("system.no-recovery", r.at,
                          "body '" + r.name + "' is to recover elements, but " +
                              (system.num_modes(b) == 0 ? "it has no modes" : "its file '" + r.file + "' has none"),
                          "reduce it with [body.output] recover or --recover");
      continue;  // sensors say it themselves
    }
    std::vector<int> kept(static_cast<size_t>(system.num_modes(b)));
    std::iota(kept.begin(), kept.end(), 0);
    const bool is_cut = system.num_modes(b) < found->second.num_modes();
    const records::FlexBody cut = is_cut ? records::keep_modes(found->second, kept) : records::FlexBody{};
    const records::FlexBody& body = is_cut ? cut : found->second;
    auto recovery = std::make_unique<Recovery>(body, b, system.tree[b].body.third_order() != nullptr);
    for (const auto& element : recovery->elements())
      if (r.recover_all) recovery->record(element.id);
    for (const int id : r.recover) {
      if (recovery->find(id) == nullptr)
        diagnostics.error("system.unknown-element", r.at,
                          "body '" + r.name + "' is to recover element " + std::to_string(id) +
                              ", which is not in the /recovery of its file",
                          "reduce the body with that element in recover");
      recovery->record(id);
    }
    const auto nodes = recovery->connect(system.tree, system.loops, system.forces, body, spec.forces);
    auto others = list_unknown_loads(spec, system, b, r.name);
    for (const int id : nodes) others.push_back("what acts at node " + std::to_string(id));
    if (!others.empty())
      diagnostics.note("system.recovery-loads", r.at,
                       "the forces in elements of body '" + r.name +
                           "' follow from its modes alone where they answer to: " + list_names(others),
                       nodes.empty() ? "take modes (attachment, residual) that hold the deflection; [body] interface "
                                       "alone does not give the values of these loads"
                                     : "add the node to [body] interface, or modes (attachment, residual) that hold "
                                       "the deflection; for other loads only the modes help");
    report_held_nodes(spec, r, body, diagnostics);
    system.recoveries[static_cast<size_t>(b)] = std::move(recovery);
  }
}

}  // namespace bough::solver
