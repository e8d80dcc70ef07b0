#include "formats/toml/unit_change.hpp"

#include <cmath>

#include "formats/toml/detail/key_units.hpp"
#include "formats/toml/key_editor.hpp"

namespace bough::toml_files {

namespace {

void change_hinge(const UnitTable& t, const SignalUnits& units) {
  const auto& c = units.change();
  const std::string name = t.text("name");
  const auto q = units.list_positions(name), rate = units.list_rates(name), effort = units.list_efforts(name);
  Units travel = rate;  // of the rates' coordinates
  for (double& unit : travel) unit *= c.time;
  const auto* null = t.get("null_position") ? t.get("null_position") : t.get("null_position_deg");
  const bool as_q = null != nullptr && null->is_array() && null->as_array()->size() == q.size();
  KeyContext context;
  context.find = [&](const std::string& word, const std::string& key, const UnitTable&) -> Units {
    if (word == "travel") return key == "null_position" && as_q ? q : travel;
    return word == "q" ? q : word == "rate" ? rate : word == "effort" ? effort : Units{};
  };
  // A quaternion's components have the unit of an angle and are none; their hinge has no key in degrees for them.
  context.list_angles = [&](const std::string& key, std::size_t count) {
    const bool of_positions = key == "position" || (key == "null_position" && as_q);
    const bool is_coordinate =
        of_positions || key == "rate" || key == "null_position" || key == "lower" || key == "upper";
    std::vector<bool> is_angle;
    for (std::size_t i = 0; i < count; ++i) is_angle.push_back(!is_coordinate || units.is_angle(name, of_positions, i));
    return is_angle;
  };
  scale_keys(t, "hinge", c, context);
}

void change_constraint(const UnitTable& t, const SignalUnits& units) {
  const auto& c = units.change();
  const auto calc_travel = [&](const toml::table& term) {
    const auto coordinate = static_cast<long>(term["coordinate"].value_or(std::int64_t{1}));
    return units.get_rate_unit(get_text(term, "hinge"), coordinate) * c.time;
  };
  const auto* terms = t.table["terms"].as_array();
  const auto* one = terms == nullptr || terms->empty() ? nullptr : terms->get(0)->as_table();
  const double first = one == nullptr ? 1 : calc_travel(*one);
  const auto find = [&](const std::string& word, const std::string&, const UnitTable& at) -> Units {
    return word == "first" ? Units{first} : word == "travel" ? Units{calc_travel(at.table)} : Units{};
  };
  scale_keys(t, "constraint", c, {find});
}

void change_force(const UnitTable& t, SignalUnits& units, const BodyFacts& facts) {
  const auto& c = units.change();
  if (const std::string locator = t.text("locator");
      !locator.empty() && !c.is_none() && facts.find_direction(t.text("body"), locator) < 0)
    t.error("toml.unit-locator", "locator", "the file of the body that holds this load is not there",
            "reduce the body first");
  const double own = units.get_multiplier_unit(t.table);
  for (const auto& wire : units.list_wires(t.table, "signal", ""))
    if (const auto unit = units.find_unit(wire.from); !unit || std::abs(*unit / own - 1) > 1e-13)
      t.error("toml.unit-signal", "signal", wire.from + " is a quantity with a unit, where a factor stands",
              "put a gain on the way");
  const auto find = [&](const std::string& word, const std::string&, const UnitTable& at) -> Units {
    return word == "exponent" ? Units{at.table["exponent"].value_or(1.5)} : Units{};
  };
  scale_keys(t, "force", c, {find});
}

void change_event(const UnitTable& t, SignalUnits& units) {
  const auto unit = t.get("value") ? units.find_unit(t.text("signal")) : std::nullopt;
  if (!unit && t.table["value"].value_or(0.0) != 0 && !units.change().is_none())
    t.error("toml.unit-signal", "value", "the unit of " + t.text("signal") + " is not known", "convert it by hand");
  const auto find = [&](const std::string&, const std::string&, const UnitTable&) {
    return unit ? Units{*unit} : Units{};
  };
  scale_keys(t, "event", units.change(), {find});
}

void change_input(const UnitTable& t, SignalUnits& units) {
  const auto unit = units.find_input_unit(t.table);
  if (!unit && !units.change().is_none())
    t.error("toml.unit-signal", t.table.contains("dims") ? "dims" : "name",
            t.table.contains("dims") ? "its dims cannot be read" : "its dimension is not known",
            "give its dims by powers of M, L, T and F, as dims = \"F L\"");
  const auto find = [&](const std::string&, const std::string&, const UnitTable&) {
    return unit ? Units{*unit} : Units{};
  };
  scale_keys(t, "input", units.change(), {find});
}

void change_simulation(const UnitTable& t, const records::UnitChange& c, const std::string& file,
                       Diagnostics& diagnostics) {
  scale_keys(t, "simulation", c, {});
  if (const auto* node = t.get("absolute_tolerance"); node != nullptr && !c.is_none())
    diagnostics.warning("toml.unit-tolerance", {file, static_cast<int>(node->source().begin.line)},
                        "absolute_tolerance is one number for quantities of several units and stays as it is",
                        "look whether it suits the new numbers");
}

void change_system(const toml::table& root, UnitEdits& edits, const records::UnitChange& c, bool to_radians,
                   const BodyFacts& facts, const std::string& file, Diagnostics& diagnostics) {
  SignalUnits units(root, c, facts);
  const auto visit = [&](const char* kind, const auto& change) {
    int number = 0;
    for (const auto* table : list_tables(root, kind))
      change(UnitTable{*table, std::string(kind) + "." + std::to_string(++number), edits, to_radians});
  };
  visit("body", [&](const UnitTable& t) { scale_keys(t, "body", c, {}); });
  visit("tank", [&](const UnitTable& t) { scale_keys(t, "tank", c, {}); });
  visit("orbit", [&](const UnitTable& t) { scale_keys(t, "orbit", c, {}); });
  visit("hinge", [&](const UnitTable& t) { change_hinge(t, units); });
  visit("constraint", [&](const UnitTable& t) { change_constraint(t, units); });
  visit("function", [&](const UnitTable& t) { change_function(t, units); });
  visit("force", [&](const UnitTable& t) { change_force(t, units, facts); });
  visit("sensor", [&](const UnitTable& t) { change_sensor(t, units); });
  visit("input", [&](const UnitTable& t) { change_input(t, units); });
  visit("controller", [&](const UnitTable& t) { change_controller(t, units); });
  visit("actuator", [&](const UnitTable& t) { change_actuator(t, units); });
  visit("event", [&](const UnitTable& t) { change_event(t, units); });
  if (const auto* run = root["simulation"].as_table())
    change_simulation({*run, "simulation", edits, to_radians}, c, file, diagnostics);
}

void change_body_file(const toml::table& root, UnitEdits& edits, const records::UnitChange& c) {
  if (const auto* matrices = root["body"]["matrices"].node(); matrices != nullptr && !c.is_none())
    edits.error("toml.unit-file", *matrices, "the matrices are in other files",
                "reduce the body first and convert its HDF5 file");
  scale_body_keys(UnitTable{root, "", edits}, c);
}

}  // namespace

std::string change_units(const std::string& text, const std::string& file, const records::UnitChange& change,
                         bool to_radians, const BodyFacts& facts, const records::UnitLabels& labels,
                         Diagnostics& diagnostics, int& num_changed) {
  toml::table root;
  try {
    root = toml::parse(std::string_view(text));
  } catch (const toml::parse_error& error) {
    diagnostics.error("toml.syntax", {file, static_cast<int>(error.source().begin.line)},
                      std::string(error.description()), "correct the file");
    return text;
  }
  UnitEdits edits(text, file, diagnostics);
  if (root["body"].is_table()) {
    change_body_file(root, edits, change);
  } else {
    change_system(root, edits, change, to_radians, facts, file, diagnostics);
  }
  std::string changed = edits.apply(root);
  for (const auto& [key, label] : {std::pair("length", &labels.length), std::pair("mass", &labels.mass),
                                   std::pair("time", &labels.time), std::pair("force", &labels.force)})
    if (!labels.empty() && root["units"][key].is_string())
      set_key(changed, std::string("units.") + key, quote_text(*label));
  num_changed = edits.count();
  return changed;
}

}  // namespace bough::toml_files
