#include "formats/toml/detail/constraint_table.hpp"

#include <algorithm>
#include <map>

#include "formats/toml/detail/hinge_table.hpp"

namespace bough::toml_files {

namespace {

using records::ConstraintType;

/// Keys of a type in addition to name, type and active; the first ones are required.
struct Keys {
  std::vector<std::string> needed, allowed;
};

Keys get_keys(ConstraintType type, const std::string& name) {
  std::vector<std::string> ends = {"parent",          "parent_node",         "child_node",
                                   "parent_position", "child_position",      "parent_rotation",
                                   "child_rotation",  "parent_rotation_deg", "child_rotation_deg"};
  const auto with = [&](std::initializer_list<const char*> more) {
    auto keys = ends;
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
  };
  switch (type) {
    case ConstraintType::Coupler:
      return {{"terms"}, {"offset"}};
    case ConstraintType::Distance:
      return {{"child", "length"}, ends};
    case ConstraintType::PointOnLine:
    case ConstraintType::PointOnPlane:
    case ConstraintType::KnifeEdge:
      return {{"child"}, with({"axis"})};
    case ConstraintType::Rolling:
      return {{"child"}, with({"axis", "axis2", "radius", "crown"})};
    case ConstraintType::RateCoupler:
      return {{"terms"}, {}};
    case ConstraintType::Hinge:
      break;
  }
  if (name == "universal") return {{"child"}, with({"axis", "axis2"})};
  if (name == "screw") return {{"child", "pitch"}, with({"axis"})};
  if (name == "gimbal") return {{"child"}, with({"rotations"})};
  if (name == "general") return {{"child"}, with({"rotations", "translations"})};
  if (name == "fixed" || name == "spherical") return {{"child"}, ends};
  return {{"child"}, with({"axis"})};
}

void check_keys(const Fields& table, const std::string& name, const std::string& type, const Keys& keys,
                Diagnostics& diagnostics) {
  static const std::vector<std::string> all = {"parent",
                                               "child",
                                               "parent_node",
                                               "child_node",
                                               "parent_position",
                                               "child_position",
                                               "parent_rotation",
                                               "child_rotation",
                                               "parent_rotation_deg",
                                               "child_rotation_deg",
                                               "axis",
                                               "axis2",
                                               "rotations",
                                               "translations",
                                               "pitch",
                                               "length",
                                               "terms",
                                               "offset",
                                               "radius",
                                               "crown"};
  const std::string where = "in constraint '" + name + "' of type " + type;
  for (const auto& key : keys.needed) {
    if (!table.has(key))
      diagnostics.error("toml.missing-key", table.locate(), "missing key '" + key + "' " + where, "add it");
  }
  for (const auto& key : all) {
    const auto has = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), key) != list.end();
    };
    if (table.has(key) && !has(keys.needed) && !has(keys.allowed))
      diagnostics.error("toml.conflicting-keys", table.locate(key), "'" + key + "' has no meaning " + where,
                        "remove it");
  }
}

}  // namespace

records::ConstraintRecord read_constraint(const Fields& table, Diagnostics& diagnostics) {
  static const std::map<std::string, ConstraintType> others{{"distance", ConstraintType::Distance},
                                                            {"point_on_line", ConstraintType::PointOnLine},
                                                            {"point_on_plane", ConstraintType::PointOnPlane},
                                                            {"coupler", ConstraintType::Coupler},
                                                            {"rolling", ConstraintType::Rolling},
                                                            {"knife_edge", ConstraintType::KnifeEdge},
                                                            {"rate_coupler", ConstraintType::RateCoupler}};
  // The ends and axes are written as those of a hinge are.
  const records::HingeRecord hinge = read_hinge(table, diagnostics);
  records::ConstraintRecord c;
  c.at = table.locate();
  c.name = hinge.name;
  const std::string type = table.get_string("type");
  const auto other = others.find(type);
  c.type = other == others.end() ? ConstraintType::Hinge : other->second;
  c.hinge = hinge.type;
  c.parent = hinge.parent;
  c.child = hinge.child;
  c.parent_node = hinge.parent_node;
  c.child_node = hinge.child_node;
  c.parent_position = hinge.parent_position;
  c.child_position = hinge.child_position;
  c.parent_rotation = hinge.parent_rotation;
  c.child_rotation = hinge.child_rotation;
  c.axis = hinge.axis;
  c.axis2 = hinge.axis2;
  c.rotations = hinge.rotations;
  c.translations = hinge.translations;
  c.pitch = hinge.pitch;
  c.length = table.get_number("length", 0);
  c.radius = table.get_number("radius", 0);
  c.crown = table.get_number("crown", 0);
  c.offset = table.get_number("offset", 0);
  c.active = table.get_bool("active", true);
  for (const Fields& term : table.get_tables("terms"))
    c.terms.push_back({term.get_string("hinge"), term.get_int("coordinate", 1), term.get_number("ratio", 1)});
  check_keys(table, c.name, type, get_keys(c.type, type), diagnostics);
  return c;
}

}  // namespace bough::toml_files
