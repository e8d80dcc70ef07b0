#include "formats/toml/detail/signal_units.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "formats/records/dims.hpp"

namespace bough::toml_files {

std::vector<const toml::table*> list_tables(const toml::table& root, const char* kind) {
  std::vector<const toml::table*> tables;
  if (const auto* list = root[kind].as_array())
    for (const auto& entry : *list)
      if (const auto* table = entry.as_table()) tables.push_back(table);
  return tables;
}

std::string get_text(const toml::table& table, const char* key, const std::string& otherwise) {
  return table[key].value_or(otherwise);
}

namespace {

std::string cut_component(const std::string& signal) { return signal.substr(0, signal.find(':')); }

}  // namespace

SignalUnits::SignalUnits(const toml::table& root, const records::UnitChange& change, const BodyFacts& facts)
    : root_(root), c_(change), facts_(facts) {}

const toml::table* SignalUnits::find(const char* kind, const std::string& name) const {
  for (const auto* table : list_tables(root_, kind))
    if (get_text(*table, "name") == name) return table;
  return nullptr;
}

HingeCoordinates SignalUnits::get_coordinates(const std::string& hinge) const {
  const auto* table = find("hinge", hinge);
  if (table == nullptr) return list_coordinates("fixed", {}, {});
  return list_coordinates(get_text(*table, "type"), get_text(*table, "rotations"), get_text(*table, "translations"));
}

std::vector<double> SignalUnits::list_positions(const std::string& hinge) const {
  std::vector<double> units;
  for (const char kind : get_coordinates(hinge).q) units.push_back(kind == 'l' ? c_.length : 1);
  return units;
}

std::vector<double> SignalUnits::list_rates(const std::string& hinge) const {
  std::vector<double> units;
  for (const char kind : get_coordinates(hinge).u) units.push_back((kind == 'l' ? c_.length : 1) / c_.time);
  return units;
}

std::vector<double> SignalUnits::list_efforts(const std::string& hinge) const {
  std::vector<double> units;
  for (const char kind : get_coordinates(hinge).u) units.push_back(kind == 'l' ? force() : force() * c_.length);
  return units;
}

bool SignalUnits::is_angle(const std::string& hinge, bool of_positions, std::size_t i) const {
  const auto kinds = get_coordinates(hinge);
  const auto& own = of_positions ? kinds.q : kinds.u;
  return i < own.size() && own[i] == 'a';
}

double SignalUnits::get_rate_unit(const std::string& hinge, long coordinate) const {
  const auto units = list_rates(hinge);
  const auto i = static_cast<std::size_t>(std::max(1L, coordinate) - 1);
  return i < units.size() ? units[i] : 1 / c_.time;
}

double SignalUnits::get_effort_unit(const std::string& hinge, long coordinate) const {
  const auto units = list_efforts(hinge);
  const auto i = static_cast<std::size_t>(std::max(1L, coordinate) - 1);
  return i < units.size() ? units[i] : force() * c_.length;
}

std::vector<Wire> SignalUnits::list_wires(const toml::table& block, const std::string& key,
                                          const std::string& port) const {
  std::vector<Wire> wires;
  if (const auto* given = block.get(key)) {
    if (const auto* one = given->as_string()) wires.push_back({one->get(), nullptr});
    if (const auto* list = given->as_array())
      for (const auto& item : *list) wires.push_back({item.value_or(std::string()), nullptr});
  }
  const std::string name = get_text(block, "name");
  for (const auto* connect : list_tables(root_, "connect")) {
    const std::string to = get_text(*connect, "to");
    const std::string at = to.find(':') == std::string::npos ? "" : to.substr(to.find(':') + 1);
    if (cut_component(to) != name) continue;
    const bool is_plain = at.empty() || at.find_first_not_of("0123456789") == std::string::npos;
    if (is_plain ? !port.empty() : at != port) continue;
    const auto place = is_plain && !at.empty() ? std::strtoul(at.c_str(), nullptr, 10) : wires.size() + 1;
    if (place == 0 || place > 10000) continue;
    if (wires.size() < place) wires.resize(place);
    wires[place - 1] = {get_text(*connect, "from"), connect};
  }
  return wires;
}

/// Unit of dimensions as "L/T^2", "F L", "1"; 1 for words that are no dimensions.
double SignalUnits::calc_unit(const std::string& dims) const {
  const auto powers = records::parse_dims(dims).value_or(std::array<double, 3>{});
  return std::pow(c_.mass, powers[0]) * std::pow(c_.length, powers[1]) * std::pow(c_.time, powers[2]);
}

std::vector<double> SignalUnits::list_sensor_units(const toml::table& sensor) const {
  const std::string type = get_text(sensor, "type"), hinge = get_text(sensor, "hinge");
  const long coordinate = sensor["coordinate"].value_or(std::int64_t{0});
  const auto pick = [&](const std::vector<double>& all) {
    const auto i = static_cast<std::size_t>(coordinate - 1);
    return coordinate >= 1 && i < all.size() ? std::vector<double>{all[i]} : all;
  };
  const auto* kind = records::find_sensor_kind(type);
  if (kind == nullptr) return {1};
  if (type == "hinge_angle" || type == "resolver") return pick(list_positions(hinge));
  if (kind->of == records::SensorOf::Coordinate) return pick(list_rates(hinge));
  if (type == "modal_coordinate") return {c_.calc_modal()};
  if (type == "modal_rate") return {c_.calc_modal() / c_.time};
  if (kind->of != records::SensorOf::Element) return {calc_unit(kind->dims)};
  std::vector<double> units;
  if (const std::string one = get_text(sensor, "component"); !one.empty())
    return {records::calc_component_unit(one, c_)};
  for (const auto& name :
       facts_.find_components(get_text(sensor, "body"), static_cast<int>(sensor["element"].value_or(std::int64_t{0}))))
    units.push_back(records::calc_component_unit(name, c_));
  return units;
}

double SignalUnits::get_command_unit(const toml::table& actuator) const {
  const std::string type = get_text(actuator, "type");
  const double effort = get_effort_unit(get_text(actuator, "hinge"), actuator["coordinate"].value_or(std::int64_t{1}));
  const double rate = get_rate_unit(get_text(actuator, "hinge"), actuator["coordinate"].value_or(std::int64_t{1}));
  if (type == "hinge" || type == "brake") return effort;
  // Currents stay; so a voltage is a power.
  if (type == "motor") return effort * rate;
  if (type == "force" || type == "engine") return force();
  if (type == "modal") return force() * c_.length / c_.calc_modal();
  if (type == "moment" || type == "wheel") return force() * c_.length;
  if (type == "cmg" || type == "double_gimbal_cmg") return 1 / c_.time;
  if (type == "torque_rod") return force() * c_.length;  // over a field, whose numbers stay
  return 1;
}

std::vector<double> SignalUnits::list_actuator_units(const toml::table& actuator) const {
  const std::string type = get_text(actuator, "type");
  const double torque = force() * c_.length, rate = 1 / c_.time;
  if (type == "motor")
    return {get_effort_unit(get_text(actuator, "hinge"), actuator["coordinate"].value_or(std::int64_t{1})), 1};
  if (type == "jet" || type == "engine") return {force(), c_.mass};
  if (type == "torque_rod") return {torque, torque, torque, torque};
  if (type == "wheel") return {torque, torque * c_.time, rate};
  if (type == "cmg") return {rate, 1, torque};
  if (type == "double_gimbal_cmg") return {rate, rate, 1, 1, torque, torque};
  return {get_command_unit(actuator)};
}

std::optional<double> SignalUnits::find_channel_unit(const std::string& channel) const {
  const auto colon = channel.find(':');
  const long component = colon == std::string::npos ? 1 : std::strtol(channel.c_str() + colon + 1, nullptr, 10);
  const std::string path = channel.substr(0, colon);
  const auto slash = path.rfind('/');
  const std::string last = path.substr(slash + 1);
  if (path.starts_with("/hinges/") && slash > 8) {
    const std::string hinge = path.substr(8, slash - 8);
    const auto q = list_positions(hinge);
    const auto i = static_cast<std::size_t>(std::max(1L, component) - 1);
    if (last == "q") return i < q.size() ? std::optional(q[i]) : std::nullopt;
    if (last == "qdot") return get_rate_unit(hinge, component);
    if (last == "force") return get_effort_unit(hinge, component);
    if (last == "reaction_force") return force();
    if (last == "reaction_moment") return force() * c_.length;
  }
  if (path.starts_with("/bodies/")) {
    if (last == "position") return c_.length;
    if (last == "velocity") return c_.length / c_.time;
    if (last == "angular_velocity") return 1 / c_.time;
    if (last == "quaternion") return 1;
    if (last == "eta") return c_.calc_modal();
    if (last == "eta_dot") return c_.calc_modal() / c_.time;
  }
  if (path.starts_with("/tanks/")) return last == "flow" ? c_.mass / c_.time : c_.mass;
  if (path.starts_with("/energy/")) return force() * c_.length;
  if (path == "/momentum/linear") return force() * c_.time;
  if (path == "/momentum/angular") return force() * c_.length * c_.time;
  return {};
}

std::optional<double> SignalUnits::find_input_unit(const toml::table& input) const {
  const auto powers = records::parse_dims(get_text(input, "dims"));
  if (!powers) return {};
  return std::pow(c_.mass, (*powers)[0]) * std::pow(c_.length, (*powers)[1]) * std::pow(c_.time, (*powers)[2]);
}

std::vector<double> SignalUnits::list_units(const std::string& signal) {
  if (signal.starts_with("/inputs/")) return list_units(signal.substr(8));
  if (signal.starts_with("/sensors/")) return list_units(signal.substr(9));
  if (signal.starts_with("/controllers/")) return list_units(signal.substr(13));
  if (signal.starts_with("/actuators/")) return list_units(signal.substr(11));
  if (signal.starts_with("/")) {
    const auto unit = find_channel_unit(signal);
    return unit ? std::vector<double>{*unit} : std::vector<double>{};
  }
  const std::string name = cut_component(signal);
  const auto* sensor = find("sensor", name);
  const auto* actuator = find("actuator", name);
  std::vector<double> all;
  if (const auto* input = find("input", name)) {
    if (const auto unit = find_input_unit(*input)) all = {*unit};
  } else if (sensor != nullptr)
    all = list_sensor_units(*sensor);
  else if (actuator != nullptr)
    all = list_actuator_units(*actuator);
  else if (const auto* controller = find("controller", name))
    all = {get_output_unit(*controller)};
  else if (find("function", name) != nullptr)
    all = {get_function_unit(name)};
  if (all.size() < 2 || name.size() == signal.size()) return all;
  const auto i = std::strtoul(signal.c_str() + name.size() + 1, nullptr, 10);
  const bool is_letter = signal.size() == name.size() + 2 && signal.back() >= 'x' && signal.back() <= 'z';
  if (is_letter && static_cast<std::size_t>(signal.back() - 'x') < all.size())
    return {all[static_cast<std::size_t>(signal.back() - 'x')]};
  return i >= 1 && i <= all.size() ? std::vector<double>{all[i - 1]} : std::vector<double>{};
}

std::optional<double> SignalUnits::find_unit(const std::string& signal) {
  const auto units = list_units(signal);
  if (units.empty() || std::any_of(units.begin(), units.end(), [&](double u) { return u != units[0]; })) return {};
  return units[0];
}

bool SignalUnits::is_passing(const toml::table& controller) {
  const std::string type = get_text(controller, "type");
  return type == "limit" || type == "notch" || type == "switch" || type == "pwpf" ||
         (type == "sum" && !controller.contains("weights")) || (type == "lead_lag" && !controller.contains("gain"));
}

double SignalUnits::get_output_unit(const toml::table& controller) {
  const std::string name = get_text(controller, "name");
  if (const auto found = known_.find(name); found != known_.end()) return found->second;
  if (std::find(asked_.begin(), asked_.end(), name) != asked_.end()) return 1;
  asked_.push_back(name);
  std::optional<double> unit;
  if (is_passing(controller))
    for (const auto& wire : list_wires(controller, "inputs", ""))
      if (!unit && !wire.from.empty()) unit = find_unit(wire.from);
  if (!unit) unit = find_demand(name);
  asked_.pop_back();
  return known_.emplace(name, unit.value_or(1)).first->second;
}

double SignalUnits::get_function_unit(const std::string& name) {
  const std::string key = "function " + name;
  if (const auto found = known_.find(key); found != known_.end()) return found->second;
  if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) return 1;
  asked_.push_back(key);
  auto unit = find_demand(name);
  asked_.pop_back();
  return known_.emplace(key, unit.value_or(1)).first->second;
}

std::optional<double> SignalUnits::find_taken(const std::string& name, const toml::table& taker,
                                              const std::string& kind) {
  const auto comes_in = [&](const char* key, const std::string& port) {
    const auto wires = list_wires(taker, key, port);
    return std::any_of(wires.begin(), wires.end(), [&](const Wire& w) { return cut_component(w.from) == name; });
  };
  if (kind == "actuator") return comes_in("input", "") ? std::optional(get_command_unit(taker)) : std::nullopt;
  const std::string type = get_text(taker, "type");
  if (type == "pid" && (comes_in("reference", "reference") || comes_in("rate", "rate"))) {
    const auto inputs = list_wires(taker, "inputs", "");
    if (inputs.empty() || cut_component(inputs[0].from) == name) return {};
    const auto unit = find_unit(inputs[0].from);
    return unit && !comes_in("reference", "reference") ? *unit / c_.time : unit;
  }
  if (!comes_in("inputs", "") || !is_passing(taker)) return {};
  return get_output_unit(taker);
}

double SignalUnits::get_multiplier_unit(const toml::table& force) const {
  if (get_text(force, "type") == "spring") return c_.calc_force();
  const std::string locator = get_text(force, "locator");
  return locator.empty() ? 1 : records::calc_locator_unit(facts_.find_direction(get_text(force, "body"), locator), c_);
}

std::vector<double> SignalUnits::list_demands(const std::string& name) const {
  std::vector<double> found;
  for (const auto* hinge : list_tables(root_, "hinge")) {
    const auto positions = list_positions(get_text(*hinge, "name"));
    const auto* list = (*hinge)["motion"].as_array();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const bool is_it = list == nullptr ? get_text(*hinge, "motion") == name
                                         : i < list->size() && list->get(i)->value_or(std::string()) == name;
      if (is_it) found.push_back(positions[i]);
    }
  }
  for (const auto* tank : list_tables(root_, "tank"))
    if (get_text(*tank, "function") == name) found.push_back(c_.mass);
  for (const auto* taker : list_tables(root_, "force")) {
    const auto wires = list_wires(*taker, "signal", "");
    const bool is_followed =
        std::any_of(wires.begin(), wires.end(), [&](const Wire& w) { return cut_component(w.from) == name; });
    if (get_text(*taker, "function") != name && !is_followed) continue;
    found.push_back(get_multiplier_unit(*taker));
  }
  return found;
}

std::optional<double> SignalUnits::find_demand(const std::string& name) {
  if (const auto sinks = list_demands(name); !sinks.empty()) return sinks[0];
  for (const auto* taker : list_tables(root_, "actuator"))
    if (const auto unit = find_taken(name, *taker, "actuator")) return unit;
  for (const auto* taker : list_tables(root_, "controller"))
    if (const auto unit = find_taken(name, *taker, "controller")) return unit;
  for (const auto* sum : list_tables(root_, "function")) {
    const auto* of = sum->get("of");
    const auto* list = of == nullptr ? nullptr : of->as_array();
    bool is_one = of != nullptr && of->value_or(std::string()) == name;
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
      is_one = is_one || list->get(i)->value_or(std::string()) == name;
    if (is_one && get_text(*sum, "type") == "sum") return get_function_unit(get_text(*sum, "name"));
  }
  return {};
}

}  // namespace bough::toml_files
