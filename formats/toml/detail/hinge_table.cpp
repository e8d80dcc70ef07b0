#include "formats/toml/detail/hinge_table.hpp"

#include <algorithm>
#include <map>
#include <numbers>

namespace bough::toml_files {

namespace {

using records::HingeType;
using Coordinates = HingeCoordinates;
constexpr double kRadPerDegree = std::numbers::pi / 180;

const Coordinates& get_coordinates(const std::string& type) {
  static const std::map<std::string, Coordinates> all{{"fixed", {HingeType::Fixed, "", ""}},
                                                      {"revolute", {HingeType::Revolute, "a", "a"}},
                                                      {"prismatic", {HingeType::Prismatic, "l", "l"}},
                                                      {"universal", {HingeType::Universal, "aa", "aa"}},
                                                      {"cylindrical", {HingeType::Cylindrical, "al", "al"}},
                                                      {"planar", {HingeType::Planar, "lla", "lla"}},
                                                      {"spherical", {HingeType::Spherical, "qqqq", "aaa"}},
                                                      {"free", {HingeType::Free, "qqqqlll", "aaalll"}},
                                                      {"screw", {HingeType::Screw, "a", "a"}}};
  const auto it = all.find(type);
  return it == all.end() ? all.at("fixed") : it->second;
}

}  // namespace

HingeCoordinates list_coordinates(const std::string& type, const std::string& given, const std::string& translations) {
  if (type != "gimbal" && type != "general") return get_coordinates(type);
  HingeCoordinates c{HingeType::General, "", ""};
  const std::string rotations = given.empty() && type == "gimbal" ? "xyz" : given;
  c.q = rotations == "q" ? "qqqq" : std::string(rotations.size(), 'a');
  c.u = rotations == "q" ? "aaa" : c.q;
  const std::string travels(translations.size(), 'l');
  c.q += travels;
  c.u += travels;
  return c;
}

namespace {

Coordinates read_coordinates(const Fields& table, const std::string& type) {
  return list_coordinates(type, table.get_string("rotations"), table.get_string("translations"));
}

class HingeReader {
 public:
  HingeReader(const Fields& table, Diagnostics& diagnostics)
      : table_(table),
        type_(table.get_string("type")),
        coordinates_(read_coordinates(table, type_)),
        // With an unknown type (reported by the schema) nothing is known of the lengths.
        is_known_(type_ == "fixed" || coordinates_.type != HingeType::Fixed),
        diagnostics_(diagnostics) {}

  HingeType get_type() const { return coordinates_.type; }

  std::vector<double> read_list(const std::string& key, bool of_positions, bool one_for_all) {
    return read_list(table_, key, of_positions, one_for_all);
  }

  /// From a table within that of the hinge.
  std::vector<double> read_list(const Fields& from, const std::string& key, bool of_positions, bool one_for_all) {
    const std::string& kinds = of_positions ? coordinates_.q : coordinates_.u;
    const std::string degrees_key = key + "_deg";
    const bool in_degrees = !from.has(key) && from.has(degrees_key);
    const std::string& used = in_degrees ? degrees_key : key;
    std::vector<double> list = from.get_numbers(used);
    if (!from.has(used) || !is_known_) return list;
    if (in_degrees && kinds.find('a') == std::string::npos) {
      diagnostics_.error("toml.no-angle", from.locate(used),
                         "hinge '" + table_.get_string("name") + "' of type " + type_ + " has no angle in " + key,
                         "write " + key + " instead of " + degrees_key);
      return {};
    }
    // Entries of another type were reported; they count.
    const Value& given = *from.find(used);
    if (one_for_all && given.is_number())
      list.assign(kinds.size(), list[0]);
    else
      check_length(from, used, given.is_array() ? given.items.size() : list.size(), kinds.size());
    std::vector<double> angles;
    for (std::size_t i = 0; i < std::min(list.size(), kinds.size()); ++i) {
      if (kinds[i] != 'a') continue;
      if (in_degrees) list[i] *= kRadPerDegree;
      angles.push_back(list[i]);
    }
    if (of_positions && !in_degrees) check_radians(from, key, angles, diagnostics_);
    return list;
  }

  std::vector<bool> read_locked() {
    const Value* v = table_.find("locked");
    if (!v) return {};
    if (!v->is_array()) return std::vector<bool>(coordinates_.u.size(), table_.get_bool("locked", false));
    std::vector<bool> locked;
    for (const Value& item : v->items) locked.push_back(item.boolean);
    if (is_known_) check_length(table_, "locked", locked.size(), coordinates_.u.size());
    return locked;
  }

  std::vector<std::string> read_names(const std::string& key) {
    const std::vector<std::string> names = table_.get_strings(key);
    // A hinge that cannot be prescribed is told so, not how many functions that would take.
    const bool is_plain = coordinates_.q.find('q') == std::string::npos;
    if (table_.has(key) && is_known_ && is_plain) {
      const Value& given = *table_.find(key);
      check_length(table_, key, given.is_array() ? given.items.size() : names.size(), coordinates_.u.size());
    }
    return names;
  }

 private:
  void check_length(const Fields& table, const std::string& key, std::size_t found, std::size_t expected) {
    if (found == expected) return;
    diagnostics_.error("toml.wrong-length", table.locate(key),
                       "hinge '" + table_.get_string("name") + "': " + key + " has " + std::to_string(found) +
                           " entries, expected " + std::to_string(expected) + " for a " + type_ + " hinge",
                       "give one entry per coordinate");
  }

  const Fields& table_;
  std::string type_;
  Coordinates coordinates_;
  bool is_known_;
  Diagnostics& diagnostics_;
};

/// Reads the force laws along the coordinates, in addition to springs and dampers.
void read_law(const Fields& table, HingeReader& reader, records::HingeLawRecord& law, Diagnostics& diagnostics) {
  law.preload = reader.read_list("preload", false, true);
  law.spring_table = reader.read_names("spring_table");
  law.damper_table = reader.read_names("damper_table");
  law.rotor_inertia = reader.read_list("rotor_inertia", false, true);
  law.gear_ratio = reader.read_list("gear_ratio", false, true);
  law.has_stops = table.has("stops");
  law.has_friction = table.has("friction");
  const Fields stops = table.get_table("stops"), friction = table.get_table("friction");
  if (law.has_stops && !stops.has("stiffness") && !stops.has("restitution"))
    diagnostics.error("toml.missing-key", table.locate("stops"),
                      "missing key 'stiffness' in the stops of hinge '" + table.get_string("name") + "'",
                      "add it, or restitution for rigid stops");
  if (law.has_friction && !friction.has("coulomb") && !friction.has("mu"))
    diagnostics.error("toml.missing-key", table.locate("friction"),
                      "missing key 'coulomb' in the friction of hinge '" + table.get_string("name") + "'",
                      "add it, or mu for friction by the load of the joint");
  law.stop_lower = reader.read_list(stops, "lower", true, true);
  law.stop_upper = reader.read_list(stops, "upper", true, true);
  law.stop_stiffness = reader.read_list(stops, "stiffness", false, true);
  law.stop_damping = reader.read_list(stops, "damping", false, true);
  law.stop_restitution = reader.read_list(stops, "restitution", false, true);
  law.coulomb = reader.read_list(friction, "coulomb", false, true);
  law.static_friction = reader.read_list(friction, "static", false, true);
  law.stribeck_velocity = reader.read_list(friction, "stribeck_velocity", false, true);
  law.smoothing = reader.read_list(friction, "smoothing", false, true);
  law.mu = reader.read_list(friction, "mu", false, true);
  law.mu_static = reader.read_list(friction, "mu_static", false, true);
  law.pin_radius = reader.read_list(friction, "pin_radius", false, true);
  law.friction_arm = reader.read_list(friction, "friction_arm", false, true);
  law.bending_arm = reader.read_list(friction, "bending_arm", false, true);
  law.reaction_arm = reader.read_list(friction, "reaction_arm", false, true);
}

}  // namespace

records::HingeRecord read_hinge(const Fields& table, Diagnostics& diagnostics) {
  records::HingeRecord hinge;
  HingeReader reader(table, diagnostics);
  hinge.at = table.locate();
  hinge.name = table.get_string("name");
  hinge.type = reader.get_type();
  hinge.parent = table.get_string("parent", "ground");
  hinge.child = table.get_string("child");
  hinge.parent_node = table.get_int("parent_node", 0);
  hinge.child_node = table.get_int("child_node", 0);
  hinge.parent_position = table.get_vector("parent_position", hinge.parent_position);
  hinge.child_position = table.get_vector("child_position", hinge.child_position);
  hinge.parent_rotation = read_rotation(table, "parent_rotation", diagnostics);
  hinge.child_rotation = read_rotation(table, "child_rotation", diagnostics);
  hinge.axis = table.get_vector("axis", hinge.axis);
  hinge.axis2 = table.get_vector("axis2", hinge.axis2);
  const std::string type = table.get_string("type"), because = "in hinge '" + hinge.name + "' of type " + type;
  if (type != "screw") refuse_keys(table, {"pitch"}, because, diagnostics);
  if (type != "general" && type != "gimbal") refuse_keys(table, {"rotations"}, because, diagnostics);
  if (type != "general") refuse_keys(table, {"translations"}, because, diagnostics);
  if (type == "screw" && !table.has("pitch"))
    diagnostics.error("toml.missing-key", table.locate(), "missing key 'pitch' " + because,
                      "give the travel along the axis per radian");
  hinge.pitch = table.get_number("pitch", 0);
  hinge.rotations = table.get_string("rotations", table.get_string("type") == "gimbal" ? "xyz" : "");
  hinge.translations = table.get_string("translations");
  hinge.stiffness = reader.read_list("stiffness", false, true);
  hinge.damping = reader.read_list("damping", false, true);
  hinge.null_position = reader.read_list("null_position", true, false);
  hinge.position = reader.read_list("position", true, false);
  hinge.rate = reader.read_list("rate", false, false);
  hinge.motion = reader.read_names("motion");
  hinge.locked = reader.read_locked();
  hinge.is_guess = table.get_bool("guess", false);
  read_law(table, reader, hinge.law, diagnostics);
  return hinge;
}

}  // namespace bough::toml_files
