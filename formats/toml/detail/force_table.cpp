#include "formats/toml/detail/force_table.hpp"

#include <algorithm>
#include <map>
#include <numbers>

namespace bough::toml_files {

namespace {

using records::ElementType;
using records::ForceElementRecord;

/// Angular radius of the sun from the earth.
constexpr double kSunSize = 0.004652;

/// Keys of a type in addition to name and type.
struct Keys {
  ElementType type;
  std::vector<std::string> needed, other;
};

const std::map<std::string, Keys>& get_types() {
  static const std::map<std::string, Keys> types{
      {"spring",
       {ElementType::Spring,
        {"body"},
        {"node", "position", "to_body", "to_node", "to_position", "stiffness", "damping", "free_length", "preload",
         "tension_only", "compression_only", "spring_table", "damper_table", "function"}}},
      {"bushing",
       {ElementType::Bushing,
        {"body", "stiffness"},
        {"node", "position", "to_body", "to_node", "to_position", "rotation", "rotation_deg", "to_rotation",
         "to_rotation_deg", "damping"}}},
      {"contact",
       {ElementType::Contact,
        {"body", "shape", "stiffness"},
        {"node", "position", "to_body", "to_node", "to_position", "radius", "to_radius", "normal", "exponent",
         "damping", "friction", "slip_velocity"}}},
      {"gravity_central",
       {ElementType::CentralGravity, {"mu"}, {"centre", "j2", "radius", "axis", "bodies", "dipole"}}},
      {"drag",
       {ElementType::Drag,
        {"body", "coefficient"},
        {"area", "node", "position", "normal", "elements", "one_sided", "wind", "planet", "density", "scale_height",
         "altitude", "density_table", "spin"}}},
      {"solar_pressure",
       {ElementType::SolarPressure,
        {"body", "pressure", "sun"},
        {"normal", "area", "elements", "node", "position", "specular", "diffuse", "planet", "sun_size", "one_sided",
         "shaded_by"}}}};
  return types;
}

/// A key of some type: others are unknown to the schema.
bool is_key_of_any(const std::string& key) {
  const auto is_in = [&](const auto& list) { return std::find(list.begin(), list.end(), key) != list.end(); };
  return std::any_of(get_types().begin(), get_types().end(),
                     [&](const auto& type) { return is_in(type.second.needed) || is_in(type.second.other); });
}

void refuse(const Fields& table, const std::string& key, const std::string& because, Diagnostics& diagnostics) {
  diagnostics.error("toml.conflicting-keys", table.locate(key), "'" + key + "' has no meaning " + because, "remove it");
}

void demand(const Fields& table, const std::string& key, const std::string& because, Diagnostics& diagnostics) {
  if (table.has(key)) return;
  diagnostics.error("toml.missing-key", table.locate(), "missing key '" + key + "' " + because, "add it");
}

/// Six numbers (the diagonal), or six rows of six.
Eigen::Matrix<double, 6, 6> read_six(const Fields& table, const std::string& key, Diagnostics& diagnostics) {
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  const Value* v = table.find(key);
  if (!v) return A;
  const std::vector<double> diagonal = table.get_numbers(key);
  bool is_valid = v->is_array() && v->items.size() == 6;
  if (is_valid && diagonal.size() == 6) {
    for (int i = 0; i < 6; ++i) A(i, i) = diagonal[static_cast<std::size_t>(i)];
    return A;
  }
  for (int i = 0; i < 6 && is_valid; ++i) {
    const auto& row = v->items[static_cast<std::size_t>(i)].items;
    is_valid = row.size() == 6;
    for (int j = 0; j < 6 && is_valid; ++j) A(i, j) = row[static_cast<std::size_t>(j)].number;
  }
  if (!is_valid) {
    diagnostics.error("toml.wrong-length", table.locate(key),
                      key + " of bushing '" + table.get_string("name") + "' is neither six numbers nor six rows of six",
                      "give [x, y, z, rx, ry, rz], or the matrix");
  }
  return A;
}

void read_element(const Fields& table, const Keys& keys, ForceElementRecord& e, Diagnostics& diagnostics) {
  e.type = keys.type;
  e.from.body = table.get_string("body");
  e.from.node = table.get_int("node", 0);
  e.from.position = table.get_vector("position", e.from.position);
  e.from.rotation = read_rotation(table, "rotation", diagnostics);
  e.to.body = table.get_string("to_body", "ground");
  e.to.node = table.get_int("to_node", 0);
  e.to.position = table.get_vector("to_position", e.to.position);
  e.to.rotation = read_rotation(table, "to_rotation", diagnostics);
  if (e.type == ElementType::Bushing) {
    e.stiffness6 = read_six(table, "stiffness", diagnostics);
    e.damping6 = read_six(table, "damping", diagnostics);
  } else {
    for (const char* key : {"stiffness", "damping"}) {
      if (const Value* v = table.find(key); v && !v->is_number()) {
        diagnostics.error("toml.wrong-type", table.locate(key),
                          std::string(key) + " of force '" + e.name + "' is a list, expected a number",
                          "lists are for bushings");
      }
    }
    e.stiffness = table.get_number("stiffness", 0);
    e.damping = table.get_number("damping", 0);
  }
  e.free_length = table.get_number("free_length", 0);
  e.preload = table.get_number("preload", 0);
  e.spring_table = table.get_string("spring_table");
  e.damper_table = table.get_string("damper_table");
  e.function = table.get_string("function");
  e.density_table = table.get_string("density_table");
  if (table.get_bool("tension_only", false)) e.sense = records::SpringSense::Tension;
  if (table.get_bool("compression_only", false)) e.sense = records::SpringSense::Compression;
  e.shape = table.get_string("shape") == "sphere" ? records::ContactShape::Sphere : records::ContactShape::Plane;
  e.radius = e.equator = table.get_number("radius", 0);
  e.exponent = table.get_number("exponent", e.exponent);
  using Element = std::decay_t<decltype(e)>;
  static constexpr std::pair<const char*, double Element::*> numbers[] = {{"to_radius", &Element::to_radius},
                                                                          {"friction", &Element::friction},
                                                                          {"slip_velocity", &Element::slip_velocity},
                                                                          {"mu", &Element::mu},
                                                                          {"j2", &Element::j2},
                                                                          {"area", &Element::area},
                                                                          {"coefficient", &Element::coefficient},
                                                                          {"density", &Element::density},
                                                                          {"scale_height", &Element::scale_height},
                                                                          {"altitude", &Element::altitude},
                                                                          {"pressure", &Element::pressure},
                                                                          {"specular", &Element::specular},
                                                                          {"diffuse", &Element::diffuse}};
  for (const auto& [key, member] : numbers) e.*member = table.get_number(key, 0);
  static constexpr std::pair<const char*, Eigen::Vector3d Element::*> vectors[] = {
      {"normal", &Element::normal}, {"centre", &Element::centre}, {"axis", &Element::axis}, {"wind", &Element::wind},
      {"spin", &Element::spin},     {"dipole", &Element::dipole}, {"sun", &Element::sun}};
  for (const auto& [key, member] : vectors) e.*member = table.get_vector(key, e.*member);
  e.bodies = table.get_strings("bodies");
  e.planet = table.get_string("planet");
  e.shaded_by = table.get_strings("shaded_by");
  e.sun_size = table.get_number("sun_size", kSunSize);
  e.has_faces = table.has("elements");
  e.faces = table.get_ints("elements");
  e.is_one_sided = table.get_bool("one_sided", false);
}

void read_typed(const Fields& table, const std::string& type, records::SystemSpec& spec, Diagnostics& diagnostics) {
  ForceElementRecord e;
  e.at = table.locate();
  e.name = table.get_string("name");
  const auto it = get_types().find(type);
  if (it == get_types().end()) return;  // reported by the schema
  const Keys& keys = it->second;
  const std::string because = "in force '" + e.name + "' of type " + type;
  for (const auto& key : keys.needed) demand(table, key, because, diagnostics);
  if (keys.type == ElementType::Spring && table.has("stiffness")) demand(table, "free_length", because, diagnostics);
  if (keys.type == ElementType::Drag && !table.has("density_table")) demand(table, "density", because, diagnostics);
  const bool has_panel = keys.type == ElementType::Drag || keys.type == ElementType::SolarPressure;
  if (table.has("elements")) {
    const std::string word = table.get_string("elements", "all");
    if (word != "all")
      diagnostics.error("toml.bad-value", table.locate("elements"), "'elements' is '" + word + "' " + because,
                        "give a list of ids, or \"all\"");
    for (const char* key : {"area", "normal", "node", "position"})
      if (table.has(key)) refuse(table, key, because + ", which acts on the faces of elements", diagnostics);
  } else if (has_panel) {
    demand(table, "area", because + ", which has no elements", diagnostics);
    if (keys.type == ElementType::SolarPressure)
      demand(table, "normal", because + ", which has no elements", diagnostics);
    else if (table.has("one_sided"))
      refuse(table, "one_sided", because + ", which has no elements", diagnostics);
  }
  if (table.has("density_table"))
    for (const char* key : {"density", "scale_height", "altitude"})
      if (table.has(key)) refuse(table, key, because + ", which has a density_table", diagnostics);
  if (keys.type == ElementType::SolarPressure && table.has("sun_size"))
    demand(table, "planet", because + ", whose sun_size is that of its shadow", diagnostics);
  if (keys.type == ElementType::CentralGravity && table.has("bodies") && table.get_strings("bodies").empty())
    diagnostics.error("toml.bad-value", table.locate("bodies"), "'bodies' is empty " + because,
                      "name the bodies that it attracts; without the key it attracts all");
  for (const auto& key : table.get_keys()) {
    const auto is_in = [&](const auto& list) { return std::find(list.begin(), list.end(), key) != list.end(); };
    const bool is_known = is_in(keys.needed) || is_in(keys.other) || key == "name" || key == "type";
    // Others that a force has none of, and two kinds at once, the schema reports.
    if (!is_known && (is_key_of_any(key) || key == "frame" || key == "signal"))
      refuse(table, key, because, diagnostics);
  }
  if (table.get_bool("tension_only", false) && table.get_bool("compression_only", false))
    refuse(table, "compression_only", because + ", which is tension_only", diagnostics);
  read_element(table, keys, e, diagnostics);
  spec.force_elements.push_back(std::move(e));
}

records::ForceRecord read_load(const Fields& table, Diagnostics& diagnostics) {
  records::ForceRecord force;
  force.at = table.locate();
  force.name = table.get_string("name");
  const std::string because = "in force '" + force.name + "'";
  demand(table, "body", because, diagnostics);
  force.kind = table.has("moment") ? records::ForceKind::Moment : records::ForceKind::Force;
  force.body = table.get_string("body");
  force.node = table.get_int("node", 0);
  force.direction = table.get_vector(table.has("moment") ? "moment" : "force", force.direction);
  const std::string frame = table.get_string("frame", "body");
  force.frame = frame == "inertial" ? records::VectorFrame::Inertial
                : frame == "node"   ? records::VectorFrame::Node
                                    : records::VectorFrame::Body;
  force.function = table.get_string("function");
  force.signal = table.get_string("signal");
  force.locator = table.get_string("locator");
  if (table.has("function") && table.has("signal"))
    refuse(table, "signal", because + ", which has a function", diagnostics);
  for (const auto& key : table.get_keys()) {
    if (key != "body" && key != "node" && key != "function" && is_key_of_any(key))
      refuse(table, key, because + ", which has no type", diagnostics);
    else if (table.has("locator") && (key == "node" || key == "frame"))
      refuse(table, key, because + ", which is a load pattern", diagnostics);
  }
  return force;
}

}  // namespace

void read_force(const Fields& table, records::SystemSpec& spec, Diagnostics& diagnostics) {
  if (table.has("type"))
    read_typed(table, table.get_string("type"), spec, diagnostics);
  else
    spec.forces.push_back(read_load(table, diagnostics));
}

}  // namespace bough::toml_files
