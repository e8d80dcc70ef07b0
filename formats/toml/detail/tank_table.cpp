#include "formats/toml/detail/tank_table.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace bough::toml_files {
namespace {

using records::TankType;

struct Keys {
  TankType type;
  std::vector<std::string> needed, other;
};

const std::map<std::string, Keys>& get_types() {
  static const std::map<std::string, Keys> types{
      {"cylinder", {TankType::Cylinder, {"radius", "height", "density"}, {"position", "axis"}}},
      {"sphere", {TankType::Sphere, {"radius", "density"}, {"position", "axis"}}},
      {"grain", {TankType::Grain, {"radius", "height", "density"}, {"position", "axis", "bore"}}},
      {"table", {TankType::Table, {"masses", "cg"}, {"inertia", "of_body"}}}};
  return types;
}

/// The numbers of each row of a list of lists; rows of `few` or `many` numbers, as many as masses.
std::vector<std::vector<double>> read_rows(const Fields& table, const std::string& key, std::size_t count,
                                           std::size_t few, std::size_t many, Diagnostics& diagnostics) {
  std::vector<std::vector<double>> rows;
  const Value* list = table.find(key);
  if (!list || !list->is_array()) return rows;
  bool is_even = list->items.size() == count;
  for (const Value& item : list->items) {
    std::vector<double> row;
    for (const Value& number : item.items) row.push_back(number.number);
    is_even = is_even && (row.size() == few || row.size() == many);
    rows.push_back(std::move(row));
  }
  if (is_even) return rows;
  const std::string numbers = few == many ? std::to_string(few) : std::to_string(few) + " or " + std::to_string(many);
  diagnostics.error("toml.wrong-length", table.locate(key),
                    key + " of tank '" + table.get_string("name") + "' is not a list of " + std::to_string(count) +
                        " rows of " + numbers + " numbers",
                    "give one row for each of masses");
  return {};
}

}  // namespace

records::TankRecord read_tank(const Fields& table, Diagnostics& diagnostics) {
  records::TankRecord tank;
  tank.at = table.locate();
  tank.name = table.get_string("name");
  tank.body = table.get_string("body");
  const std::string type = table.get_string("type");
  const auto it = get_types().find(type);
  if (it == get_types().end()) return tank;  // reported by the schema
  tank.type = it->second.type;
  const std::string because = "in tank '" + tank.name + "' of type " + type;
  for (const auto& key : it->second.needed) {
    if (table.has(key)) continue;
    diagnostics.error("toml.missing-key", table.locate(), "'" + key + "' is missing " + because, "add it");
  }
  std::set<std::string> others;
  for (const auto& [other, keys] : get_types())
    for (const auto* list : {&keys.needed, &keys.other}) others.insert(list->begin(), list->end());
  for (const auto* list : {&it->second.needed, &it->second.other})
    for (const auto& key : *list) others.erase(key);
  for (const auto& key : others) refuse_keys(table, {key.c_str()}, because, diagnostics);
  tank.mass = table.get_number("mass", 0);
  tank.function = table.get_string("function");
  if (tank.function.empty()) {
    if (!table.has("mass"))
      diagnostics.error("toml.missing-key", table.locate(), "'mass' is missing " + because,
                        "give the propellant at the start, or function, its mass over time");
    refuse_keys(table, {"exit_node", "exit_radius", "exit_axis"}, because + ", which actuators use", diagnostics);
  } else {
    refuse_keys(table, {"mass"}, because + ", whose mass is a function", diagnostics);
  }
  tank.position = table.get_vector("position", tank.position);
  tank.axis = table.get_vector("axis", tank.axis);
  tank.radius = table.get_number("radius", 0);
  tank.bore = table.get_number("bore", 0);
  tank.height = table.get_number("height", 0);
  tank.density = table.get_number("density", 0);
  tank.is_of_body = table.get_bool("of_body", false);
  tank.masses = table.get_numbers("masses");
  const std::size_t count = tank.masses.size();
  for (const auto& c : read_rows(table, "cg", count, 3, 3, diagnostics)) tank.cg.emplace_back(c[0], c[1], c[2]);
  for (const auto& c : read_rows(table, "inertia", count, 3, 6, diagnostics)) {
    Eigen::Matrix3d J = Eigen::Vector3d(c[0], c[1], c[2]).asDiagonal();
    if (c.size() == 6) J << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
    tank.inertia.push_back(J);
  }
  if (tank.inertia.empty()) tank.inertia.assign(count, Eigen::Matrix3d::Zero());
  tank.sloshes = table.get_bool("slosh", false);
  tank.slosh_damping = table.get_number("slosh_damping", 0);
  tank.slosh_acceleration = table.get_number("slosh_acceleration", 0);
  if (table.get_string("slosh_model") == "spring") tank.slosh_model = records::SloshModel::Spring;
  tank.slosh_viscosity = table.get_number("slosh_viscosity", 0);
  tank.baffle_width = table.get_number("baffle_width", 0);
  tank.baffle_depths = table.get_numbers("baffle_depths");
  tank.baffle_amplitude = table.get_number("baffle_amplitude", 0);
  if (!tank.sloshes)
    refuse_keys(table,
                {"slosh_damping", "slosh_acceleration", "slosh_model", "slosh_viscosity", "baffle_width",
                 "baffle_depths", "baffle_amplitude"},
                because + ", which does not slosh", diagnostics);
  constexpr const char* kBaffle[] = {"baffle_width", "baffle_depths", "baffle_amplitude"};
  const auto has = [&](const char* key) { return table.has(key); };
  if (tank.sloshes && std::any_of(std::begin(kBaffle), std::end(kBaffle), has))
    for (const char* key : kBaffle)
      if (!has(key))
        diagnostics.error("toml.missing-key", table.locate(), "'" + std::string(key) + "' is missing " + because,
                          "baffles have a width, depths below the free surface, and the amplitude of the wave");
  tank.exit_node = table.get_int("exit_node", 0);
  tank.exit_radius = table.get_number("exit_radius", 0);
  tank.exit_axis = table.get_vector("exit_axis", tank.exit_axis);
  return tank;
}

}  // namespace bough::toml_files
