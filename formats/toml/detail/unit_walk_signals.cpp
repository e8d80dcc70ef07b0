#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/toml/detail/key_units.hpp"
#include "formats/toml/key_editor.hpp"

namespace bough::toml_files {

void UnitTable::scale_angles(const std::string& key, std::vector<double> factors,
                             const std::vector<bool>& is_angle) const {
  scale(key.c_str(), factors);
  const std::string degrees = key + "_deg";
  const auto at = table.find(degrees);
  if (at == table.end()) return;
  for (std::size_t i = 0; to_radians && i < factors.size(); ++i)
    if (is_angle[i]) factors[i] *= std::numbers::pi / 180;
  scale(degrees.c_str(), factors);
  if (to_radians) edits.rename_key(at->first, key);
}

void UnitTable::scale_or_add(const char* key, double factor) const {
  if (table.contains(key))
    scale(key, factor);
  else if (std::abs(factor - 1) > 1e-14)
    edits.add(path + "." + key, write_decimal(factor));
}

void UnitTable::error(const char* id, const char* key, const std::string& what, const std::string& fix) const {
  const auto* node = table.get(key);
  edits.error(id, node != nullptr ? *node : table, "'" + text("name") + "': " + what, fix);
}

namespace {

bool is_near(double a, double b) { return std::abs(a - b) <= 1e-13 * std::abs(b); }

/// Units of what arrives, a number for each component as far as they differ.
std::vector<double> list_inputs(const UnitTable& t, SignalUnits& units, const char* key, const char* port) {
  std::vector<double> all;
  for (const auto& wire : units.list_wires(t.table, key, port)) {
    const auto own = wire.from.empty() ? std::vector<double>{1} : units.list_units(wire.from);
    if (own.empty())
      t.error("toml.unit-signal", key, "the unit of " + wire.from + " is not known", "convert this table by hand");
    // A sensor of three components counts once here; that matters only where its units differ.
    const bool is_one = std::all_of(own.begin(), own.end(), [&](double u) { return is_near(u, own[0]); });
    if (is_one && !own.empty())
      all.push_back(own[0]);
    else
      all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

}  // namespace

void scale_columns(const UnitTable& t, const char* key, double factor, const Units& inputs) {
  const auto* node = t.get(key);
  if (node == nullptr) return;
  const bool is_alike = std::all_of(inputs.begin(), inputs.end(), [&](double u) { return is_near(u, inputs[0]); });
  if (inputs.empty() || is_alike) return t.scale(key, inputs.empty() ? factor : factor / inputs[0]);
  std::vector<double> factors;
  for (const double input : inputs) factors.push_back(factor / input);
  const auto* list = node->as_array();
  const auto fits = [&](const toml::array* row) { return row != nullptr && row->size() == factors.size(); };
  if (list != nullptr && !list->empty() && list->get(0)->is_array()) {
    for (const auto& row : *list) {
      if (!fits(row.as_array()))
        return t.error("toml.unit-signal", key, "components of several units", "convert it by hand");
      t.edits.scale(&row, factors);
    }
  } else if (fits(list)) {
    t.edits.scale(node, factors);
  } else {
    t.error("toml.unit-signal", key, "components of several units", "convert it by hand");
  }
}

void scale_polynomial(const UnitTable& t, const char* key, double factor, double time) {
  const auto* node = t.get(key);
  const auto* list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr) return t.scale(key, factor);
  for (std::size_t i = 0; i < list->size(); ++i)
    t.edits.scale(list->get(i), factor * std::pow(time, static_cast<double>(list->size() - 1 - i)));
}

void rewrite_formulas(const UnitTable& t, const char* key, double factor, double time, const Units& inputs) {
  const auto one = [&](const toml::node& node) {
    const auto* formula = node.as_string();
    if (formula == nullptr) return;
    const auto changed = rewrite_formula(formula->get(), factor, time, inputs);
    if (changed != formula->get()) t.edits.replace(node, quote_text(changed));
  };
  const auto* node = t.get(key);
  if (node == nullptr) return;
  if (const auto* list = node->as_array())
    for (const auto& item : *list) one(item);
  else
    one(*node);
}

void change_controller(const UnitTable& t, SignalUnits& units) {
  const std::string type = t.text("type");
  const bool is_sampled = t.table.contains("sample_time");
  const double time = units.change().time, out = units.get_output_unit(t.table);
  const auto inputs = list_inputs(t, units, "inputs", "");
  const double in = inputs.empty() ? 1 : inputs[0];
  const bool is_alike = std::all_of(inputs.begin(), inputs.end(), [&](double u) { return is_near(u, in); });
  const bool takes_many = type == "gain" || type == "state_space" || type == "sum" || type == "product" ||
                          type == "expression" || type == "table" || type == "switch" || type == "library" ||
                          type == "fmu";
  if (!is_alike && !takes_many)
    return t.error("toml.unit-signal", "inputs", "its inputs have several units", "make a controller of each");
  if ((type == "library" || type == "fmu") && !units.change().is_none())
    return t.error("toml.unit-file", "type", "what a shared library or an FMU computes is not known",
                   "convert it by hand");
  if (t.table.contains("file") && !(units.change().is_none()))
    return t.error("toml.unit-file", "file", "the numbers are in another file",
                   "convert them by hand, or write them here");
  if (type == "pid") {
    for (const auto& [port, unit] : {std::pair{"reference", in}, std::pair{"rate", in / time}})
      for (const double got : list_inputs(t, units, port, port))
        if (!is_near(got, unit))
          t.error("toml.unit-signal", port, std::string("the ") + port + " has another unit than the input",
                  "put a gain on the way");
  } else if (type == "switch" && inputs.size() > 1 && !is_near(inputs[1], in)) {
    t.error("toml.unit-signal", "inputs", "it switches between different quantities", "put a gain on the way");
  }
  double product = 1;
  for (const double input : inputs) product *= input;
  const auto find = [&](const std::string& word, const std::string&, const UnitTable&) -> Units {
    if (word == "out") return {out};
    if (word == "in") return {in};
    if (word == "in2") return {inputs.size() > 1 ? inputs[1] : in};
    if (word == "last") return {inputs.empty() ? 1 : inputs.back()};
    if (word == "inputs") return {product};
    if (word == "step") return {is_sampled ? 1 : time};
    return {};
  };
  KeyContext context{find};
  context.inputs = inputs;
  scale_keys(t, "controller", units.change(), context);
}

void change_actuator(const UnitTable& t, SignalUnits& units) {
  const auto& c = units.change();
  const std::string type = t.text("type"), hinge = t.text("hinge");
  const long coordinate = static_cast<long>(t.table["coordinate"].value_or(std::int64_t{1}));
  const bool has_hinge = !hinge.empty();
  const double command = units.get_command_unit(t.table), torque = units.force() * c.length;
  const double effort = has_hinge ? units.get_effort_unit(hinge, coordinate) : torque;
  const double rate = has_hinge ? units.get_rate_unit(hinge, coordinate) : 1 / c.time;
  const auto inputs = list_inputs(t, units, "input", "");
  for (const double input : inputs)
    if (!is_near(input, inputs[0])) t.error("toml.unit-signal", "input", "commands of two units", "make them alike");
  const auto find = [&](const std::string& word, const std::string&, const UnitTable&) -> Units {
    if (word == "command") return {command};
    if (word == "in") return {inputs.empty() ? command : inputs[0]};
    return word == "effort" ? Units{effort} : word == "rate" ? Units{rate} : Units{};
  };
  scale_keys(t, "actuator", c, {find});
}

void change_sensor(const UnitTable& t, SignalUnits& units) {
  const auto& c = units.change();
  auto own = units.list_units(t.text("name"));
  if (own.empty()) {
    const bool has_numbers = t.get("bias") || t.get("initial") || t.get("range") || t.get("quantization") ||
                             t.get("noise_density") || t.get("random_walk");
    if (has_numbers && !c.is_none())
      t.error("toml.unit-signal", "element", "the rows of the element are not known",
              "reduce the body first, or give a component");
    own = {1};
  }
  const auto find = [&](const std::string& word, const std::string&, const UnitTable&) {
    return word == "signal" ? own : Units{};
  };
  scale_keys(t, "sensor", c, {find});
}

namespace {

/// Where a function is not of time: over a deflection or a rate, an effort.
struct Characteristic {
  double x, y;
};

std::vector<Characteristic> list_characteristics(const std::string& name, const toml::table& root, SignalUnits& units) {
  std::vector<Characteristic> found;
  const auto& c = units.change();
  for (const auto* hinge : list_tables(root, "hinge")) {
    const auto rates = units.list_rates(get_text(*hinge, "name")),
               efforts = units.list_efforts(get_text(*hinge, "name"));
    for (const char* key : {"spring_table", "damper_table"}) {
      const double time = key[0] == 's' ? c.time : 1;
      const auto* list = (*hinge)[key].as_array();
      for (std::size_t i = 0; i < rates.size(); ++i) {
        const bool is_it = list == nullptr ? get_text(*hinge, key) == name
                                           : i < list->size() && list->get(i)->value_or(std::string()) == name;
        if (is_it) found.push_back({rates[i] * time, efforts[i]});
      }
    }
  }
  for (const auto* force : list_tables(root, "force")) {
    if (get_text(*force, "spring_table") == name) found.push_back({c.length, units.force()});
    if (get_text(*force, "damper_table") == name) found.push_back({c.length / c.time, units.force()});
    if (get_text(*force, "density_table") == name) found.push_back({c.length, c.mass / std::pow(c.length, 3)});
  }
  return found;
}

}  // namespace

void change_function(const UnitTable& t, SignalUnits& units) {
  const std::string name = t.text("name"), type = t.text("type");
  const double time = units.change().time;
  double value = units.get_function_unit(name), x = time;
  const auto over = list_characteristics(name, units.root(), units);
  if (!over.empty()) {
    x = over[0].x;
    value = over[0].y;
    for (const auto& other : over)
      if (!is_near(other.x, x) || !is_near(other.y, value))
        return t.error("toml.unit-use", "name", "it is used for different quantities", "make a function of each");
  }
  for (const double taken : units.list_demands(name))
    if (!is_near(taken, value))
      return t.error("toml.unit-use", "name", "it is used for different quantities", "make a function of each");
  if (t.get("file") && !(is_near(value, 1) && is_near(x, 1)))
    return t.error("toml.unit-file", "file", "the table is in another file", "convert the columns by hand");
  const auto find = [&](const std::string& word, const std::string&, const UnitTable& at) -> Units {
    if (word == "value") return {value};
    if (word == "x") return {x};
    return word == "power" ? Units{at.table["power"].value_or(2.0)} : Units{};
  };
  scale_keys(t, "function", units.change(), {find});
  if (type == "sum" || type == "product") {
    std::vector<std::string> members;
    if (const auto* list = t.table["of"].as_array())
      for (const auto& item : *list) members.push_back(item.value_or(std::string()));
    else
      members.push_back(t.text("of"));
    for (const auto& member : members)
      if (!is_near(units.get_function_unit(member), type == "sum" ? value : 1))
        t.error("toml.unit-use", "of", member + " stands for another quantity elsewhere", "make a function of each");
  }
}

}  // namespace bough::toml_files
