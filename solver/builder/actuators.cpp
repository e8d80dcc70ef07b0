#include "solver/builder/actuators.hpp"

#include <algorithm>

#include "solver/actuators/makers.hpp"
#include "solver/builder/build.hpp"
#include "solver/text/names.hpp"
#include "solver/tree/coordinates.hpp"

namespace bough::solver {
namespace {

enum class Where { Hinge, Force, Moment, Mode };
struct Kind {
  const char* type;
  int outputs;
  Where where;
  const char* takes;  ///< dimension of the command; empty: any, or by the hinge
  std::unique_ptr<Actuator> (*make)(const records::ActuatorRecord&, SettingsReader&, const ActuatorPlace&);
};
constexpr Kind kKinds[] = {
    {"hinge", 1, Where::Hinge, "", make_hinge_actuator},
    {"motor", 2, Where::Hinge, "", make_hinge_actuator},
    {"brake", 1, Where::Hinge, "", make_hinge_actuator},
    {"force", 1, Where::Force, "F", make_node_actuator},
    {"moment", 1, Where::Moment, "F L", make_node_actuator},
    {"jet", 2, Where::Force, "", make_node_actuator},
    {"engine", 2, Where::Force, "F", make_node_actuator},
    {"torque_rod", 4, Where::Moment, "", make_node_actuator},
    {"wheel", 3, Where::Moment, "F L", make_rotor},
    {"cmg", 3, Where::Moment, "1/T", make_rotor},
    {"double_gimbal_cmg", 6, Where::Moment, "1/T", make_rotor},
    {"modal", 1, Where::Mode, "", make_modal_actuator},
};

const Kind* find_kind(const std::string& type) {
  const auto* found = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const Kind& k) { return type == k.type; });
  return found == std::end(kKinds) ? nullptr : found;
}

bool find_row(const records::ActuatorRecord& r, const System& system, const Tree& tree, SettingsReader& keys,
              ActuatorPlace& place) {
  const int body = system.find_hinge(r.hinge);
  if (!r.body.empty()) keys.error("control.unknown-key", "takes no body", "its hinge says where it acts");
  if (r.hinge.empty()) {
    keys.error("control.missing-key", "has no hinge", "give hinge = \"NAME\"");
    return false;
  }
  if (body < 0) {
    std::vector<std::string> names;
    for (int b = 0; b < system.num_bodies(); ++b) names.push_back(system.hinge_name(b));
    keys.error("control.unknown-place", "drives the hinge '" + r.hinge + "', which does not exist",
               suggest_name(r.hinge, names, "declare it"));
    return false;
  }
  if (!system.is_valid(body)) return false;
  const int count = tree[body].num_hinge_u();
  if (r.coordinate < 1 || r.coordinate > count) {
    keys.error("control.unknown-place",
               "drives coordinate " + std::to_string(r.coordinate) + " of hinge '" + r.hinge + "', which has " +
                   std::to_string(count),
               "count from 1");
    return false;
  }
  place.row = tree[body].u_offset + r.coordinate - 1;
  place.effort = list_hinge_dims(tree[body], HingeQuantity::Force, r.coordinate - 1, 1);
  return true;
}

/// Index of the body; -1: reported, or the body has errors.
int find_own_body(const records::ActuatorRecord& r, const System& system, SettingsReader& keys) {
  if (!r.hinge.empty()) keys.error("control.unknown-key", "takes no hinge", "its body says where it acts");
  const int body = system.find_body(r.body);
  if (body < 0) {
    std::vector<std::string> names;
    for (int b = 0; b < system.num_bodies(); ++b) names.push_back(system.body_name(b));
    keys.error("control.unknown-place", "is on the body '" + r.body + "', which does not exist",
               suggest_name(r.body, names, "declare it"));
    return -1;
  }
  return system.is_valid(body) ? body : -1;
}

bool find_mode(const records::ActuatorRecord& r, const System& system, const Tree& tree, SettingsReader& keys,
               ActuatorPlace& place) {
  const int body = find_own_body(r, system, keys);
  if (body < 0) return false;
  const int count = tree[body].num_modes();
  if (r.coordinate < 1 || r.coordinate > count) {
    keys.error(
        "control.unknown-place",
        "drives mode " + std::to_string(r.coordinate) + " of body '" + r.body + "', which has " + std::to_string(count),
        count == 0 ? "name a flexible body" : "count from 1");
    return false;
  }
  place.row = tree[body].v_offset + 6 + r.coordinate - 1;
  return true;
}

bool find_marker(const records::ActuatorRecord& r, const System& system, Tree& tree, Where where, SettingsReader& keys,
                 Diagnostics& diagnostics, ActuatorPlace& place) {
  const int body = find_own_body(r, system, keys);
  if (body < 0) return false;
  Marker at;
  at.body = body;
  at.node = find_loaded_node(r.body, tree[body].body, r.node, {where == Where::Force, where == Where::Moment}, r.at,
                             "actuator '" + r.name + "'", diagnostics);
  if (at.node < 0) return false;
  at.moves = tree[body].body.nodes()[static_cast<size_t>(at.node)].moves;
  place.marker = tree.add_marker(at);
  return true;
}

/// The tank that a thruster uses; false: reported.
bool find_tank(const records::ActuatorRecord& r, const Tree& tree, SettingsReader& keys, ActuatorPlace& place) {
  const std::string name = keys.get_word("tank", "");
  if (name.empty()) return true;
  std::vector<std::string> names;
  for (const Tank& tank : tree.tanks) names.push_back(tank.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    keys.error("control.unknown-place", "uses the tank '" + name + "', which does not exist",
               suggest_name(name, names, "declare it"));
    return false;
  }
  const Tank& tank = tree.tanks[static_cast<size_t>(found - names.begin())];
  if (tank.function || tree[tank.body].name != r.body) {
    keys.error(
        "control.unknown-place",
        "uses the tank '" + name + "', " +
            (tank.function ? "whose mass is a function of time" : "which is on body '" + tree[tank.body].name + "'"),
        tank.function ? "give the tank a mass in place of its function" : "mount the thruster on the body of its tank");
    return false;
  }
  place.tank = static_cast<int>(found - names.begin());
  place.is_tank_empty = tank.initial <= tank.reserve;
  return true;
}

}  // namespace

int find_actuator_outputs(const std::string& type) {
  const Kind* kind = find_kind(type);
  return kind ? kind->outputs : 0;
}

std::unique_ptr<Block> make_actuator(const records::ActuatorRecord& r, const System& system, Tree& tree,
                                     Diagnostics& diagnostics) {
  SettingsReader keys(r.settings, "actuator '" + r.name + "' of type " + r.type, r.at, diagnostics);
  const Kind* kind = find_kind(r.type);
  if (kind == nullptr) {
    std::vector<std::string> types;
    std::string list;
    for (const Kind& k : kKinds) {
      types.emplace_back(k.type);
      list += (list.empty() ? "" : ", ") + types.back();
    }
    diagnostics.error("control.unknown-type", r.at, "actuator '" + r.name + "' has the unknown type '" + r.type + "'",
                      suggest_name(r.type, types, "use one of: " + list));
    return nullptr;
  }
  ActuatorPlace place;
  const bool is_placed = kind->where == Where::Hinge ? find_row(r, system, tree, keys, place)
                         : kind->where == Where::Mode
                             ? find_mode(r, system, tree, keys, place)
                             : find_marker(r, system, tree, kind->where, keys, diagnostics, place);
  const bool is_thruster = r.type == "jet" || r.type == "engine";
  if (is_thruster && !find_tank(r, tree, keys, place)) return nullptr;
  auto made = kind->make(r, keys, place);
  keys.refuse_others();
  if (!is_placed || keys.has_failed() || !made) return nullptr;
  made->set_name(BlockKind::Actuator, r.name);
  made->label = "actuator '" + r.name + "'";
  made->at = r.at;
  const bool takes_effort = r.type == "hinge" || r.type == "brake";
  if (r.settings.get("scale", 1) == 1) made->input_dims = takes_effort ? place.effort : kind->takes;
  made->sizes.outputs = kind->outputs;
  made->tank = place.tank;
  return made;
}

}  // namespace bough::solver
