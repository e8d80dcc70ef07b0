#include "formats/toml/unit_change.hpp"

#include <algorithm>
#include <cmath>

#include "formats/toml/detail/unit_walk.hpp"
#include "formats/toml/key_editor.hpp"

namespace bough::toml_files {

namespace {

using Units = std::vector<double>;

Units multiply(Units a, const Units& b, double power, double factor) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] *= std::pow(b[i], power) * factor;
  return a;
}

/// A table within a table: stops, friction.
template <class Change>
void visit_inner(const UnitTable& t, const char* key, const Change& change) {
  if (const auto* inner = t.table[key].as_table()) change(UnitTable{*inner, t.path + "." + key, t.edits, t.to_radians});
}

void change_frames(const UnitTable& t, double length) {
  for (const char* key : {"parent_position", "child_position", "position", "to_position", "pitch"})
    t.scale(key, length);
  for (const char* key : {"parent_rotation", "child_rotation", "rotation", "to_rotation"}) t.scale_angles(key);
}

void change_body(const UnitTable& t, const records::UnitChange& c) {
  t.scale("mass", c.mass);
  t.scale("cg", c.length);
  t.scale("inertia", c.mass * c.length * c.length);
  t.scale("eta", c.calc_modal());
  t.scale("eta_dot", c.calc_modal() / c.time);
  if (const auto* nodes = t.table["nodes"].as_array())
    for (const auto& node : *nodes)
      if (const auto* table = node.as_table()) t.edits.scale(table->get("position"), c.length);
}

void change_tank(const UnitTable& t, const records::UnitChange& c) {
  for (const char* key : {"mass", "masses"}) t.scale(key, c.mass);
  for (const char* key :
       {"position", "radius", "bore", "height", "exit_radius", "baffle_width", "baffle_depths", "baffle_amplitude"})
    t.scale(key, c.length);
  t.scale("slosh_viscosity", c.length * c.length / c.time);
  t.scale("density", c.mass / std::pow(c.length, 3));
  t.scale("slosh_acceleration", c.length / (c.time * c.time));
  for (const auto& [key, unit] : {std::pair{"cg", c.length}, std::pair{"inertia", c.mass * c.length * c.length}})
    if (const auto* rows = t.table[key].as_array())
      for (const auto& row : *rows) t.edits.scale(&row, unit);
}

void change_orbit(const UnitTable& t, const records::UnitChange& c) {
  for (const char* key : {"semi_major_axis", "position"}) t.scale(key, c.length);
  t.scale("velocity", c.length / c.time);
  for (const char* key : {"inclination", "ascending_node", "periapsis", "true_anomaly"}) t.scale_angles(key);
}

void change_hinge(const UnitTable& t, const SignalUnits& units) {
  const auto& c = units.change();
  const std::string name = t.text("name");
  const auto q = units.list_positions(name), rate = units.list_rates(name), effort = units.list_efforts(name);
  const auto travel = multiply(rate, rate, 0, c.time);  // of the rates' coordinates
  const auto list_angles = [&](const Units& all, bool of_positions) {
    // A quaternion's components have the unit of an angle and are none; their hinge has no key in degrees for them.
    std::vector<bool> is_angle;
    for (std::size_t i = 0; i < all.size(); ++i) is_angle.push_back(units.is_angle(name, of_positions, i));
    return is_angle;
  };
  for (const char* key : {"parent_position", "child_position", "pitch"}) t.scale(key, c.length);
  for (const char* key : {"parent_rotation", "child_rotation"}) t.scale_angles(key);
  t.scale_angles("position", q, list_angles(q, true));
  t.scale_angles("rate", rate, list_angles(rate, false));
  const auto* null = t.get("null_position") ? t.get("null_position") : t.get("null_position_deg");
  const bool as_q = null != nullptr && null->is_array() && null->as_array()->size() == q.size();
  t.scale_angles("null_position", as_q ? q : travel, list_angles(as_q ? q : travel, as_q));
  const auto stiffness = multiply(effort, travel, -1, 1);
  t.scale("stiffness", stiffness);
  t.scale("damping", multiply(effort, rate, -1, 1));
  t.scale("preload", effort);
  t.scale("rotor_inertia", multiply(stiffness, rate, 0, c.time * c.time));
  visit_inner(t, "stops", [&](const UnitTable& stops) {
    for (const char* key : {"lower", "upper"}) stops.scale_angles(key, travel, list_angles(travel, false));
    stops.scale("stiffness", stiffness);
    stops.scale("damping", multiply(Units(rate.size(), 1), rate, -1, 1));
  });
  visit_inner(t, "friction", [&](const UnitTable& friction) {
    for (const char* key : {"coulomb", "static"}) friction.scale(key, effort);
    for (const char* key : {"stribeck_velocity", "smoothing"}) friction.scale(key, rate);
    for (const char* key : {"pin_radius", "friction_arm", "bending_arm", "reaction_arm"})
      friction.scale(key, units.change().length);
  });
}

void change_constraint(const UnitTable& t, const SignalUnits& units) {
  change_frames(t, units.change().length);
  for (const char* key : {"length", "radius", "crown"}) t.scale(key, units.change().length);
  const auto* terms = t.table["terms"].as_array();
  double first = 0;
  for (std::size_t i = 0; terms != nullptr && i < terms->size(); ++i) {
    const auto* term = terms->get(i)->as_table();
    if (term == nullptr) continue;
    const auto coordinate = static_cast<long>((*term)["coordinate"].value_or(std::int64_t{1}));
    const double unit = units.get_rate_unit(get_text(*term, "hinge"), coordinate) * units.change().time;
    if (first == 0) first = unit;
    UnitTable{*term, t.path + ".terms." + std::to_string(i + 1), t.edits}.scale_or_add("ratio", first / unit);
  }
  t.scale("offset", first == 0 ? 1 : first);
}

/// Six numbers or six rows of six: forces and moments over travels and turns.
void change_bushing(const UnitTable& t, const char* key, double force, double length) {
  const auto unit = [&](std::size_t i, std::size_t j) { return force * (i < 3 ? 1 : length) / (j < 3 ? length : 1); };
  const auto* list = t.table[key].as_array();
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const auto* row = list->get(i)->as_array();
    if (row == nullptr) t.edits.scale(list->get(i), unit(i, i));
    for (std::size_t j = 0; row != nullptr && j < row->size(); ++j) t.edits.scale(row->get(j), unit(i, j));
  }
}

void change_force(const UnitTable& t, SignalUnits& units, const BodyFacts& facts) {
  const auto& c = units.change();
  const double force = units.force(), length = c.length;
  const std::string type = t.text("type");
  t.scale("force", force);
  t.scale("moment", force * length);
  change_frames(t, length);
  if (const std::string locator = t.text("locator");
      !locator.empty() && !c.is_none() && facts.find_direction(t.text("body"), locator) < 0)
    t.error("toml.unit-locator", "locator", "the file of the body that holds this load is not there",
            "reduce the body first");
  const double own = units.get_multiplier_unit(t.table);
  for (const auto& wire : units.list_wires(t.table, "signal", ""))
    if (const auto unit = units.find_unit(wire.from); !unit || std::abs(*unit / own - 1) > 1e-13)
      t.error("toml.unit-signal", "signal", wire.from + " is a quantity with a unit, where a factor stands",
              "put a gain on the way");
  if (type == "bushing") {
    change_bushing(t, "stiffness", force, length);
    change_bushing(t, "damping", force * c.time, length);
  } else if (type == "contact") {
    t.scale("stiffness", force / std::pow(length, t.table["exponent"].value_or(1.5)));
    t.scale("damping", c.time / length);
  } else {
    t.scale("stiffness", force / length);
    t.scale("damping", force * c.time / length);
  }
  for (const char* key : {"free_length", "radius", "to_radius", "centre", "scale_height", "altitude"})
    t.scale(key, length);
  t.scale("preload", force);
  for (const char* key : {"slip_velocity", "wind"}) t.scale(key, length / c.time);
  t.scale("mu", std::pow(length, 3) / (c.time * c.time));
  t.scale("area", length * length);
  t.scale("pressure", force / (length * length));
  t.scale("spin", 1 / c.time);
  t.scale("dipole", std::pow(length, 3));
  t.scale("density", c.mass / std::pow(length, 3));
}

void change_event(const UnitTable& t, SignalUnits& units) {
  for (const char* key : {"time", "tolerance"}) t.scale(key, units.change().time);
  if (!t.get("value")) return;
  if (const auto unit = units.find_unit(t.text("signal")))
    t.scale("value", *unit);
  else if (t.table["value"].value_or(0.0) != 0 && !units.change().is_none())
    t.error("toml.unit-signal", "value", "the unit of " + t.text("signal") + " is not known", "convert it by hand");
}

void change_input(const UnitTable& t, SignalUnits& units) {
  if (const auto unit = units.find_input_unit(t.table))
    t.scale("start", *unit);
  else if (!units.change().is_none())
    t.error("toml.unit-signal", t.table.contains("dims") ? "dims" : "name",
            t.table.contains("dims") ? "its dims cannot be read" : "its dimension is not known",
            "give its dims by powers of M, L, T and F, as dims = \"F L\"");
}

void change_simulation(const UnitTable& t, const records::UnitChange& c, const std::string& file,
                       Diagnostics& diagnostics) {
  for (const char* key : {"start", "duration", "output_step", "output_from", "output_until", "step", "stiffening_step"})
    t.scale(key, c.time);
  t.scale("gravity", c.length / (c.time * c.time));
  t.scale("absolute_tolerance_modes", c.calc_modal());
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
  visit("body", [&](const UnitTable& t) { change_body(t, c); });
  visit("tank", [&](const UnitTable& t) { change_tank(t, c); });
  visit("orbit", [&](const UnitTable& t) { change_orbit(t, c); });
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

void change_body_file(const toml::table& body, UnitEdits& edits, const records::UnitChange& c) {
  if (body.contains("matrices") && !c.is_none())
    edits.error("toml.unit-file", *body.get("matrices"), "the matrices are in other files",
                "reduce the body first and convert its HDF5 file");
  if (const auto* origin = body["origin"].as_array()) edits.scale(origin, c.length);
  edits.scale(body["modes"]["max_frequency"].node(), 1 / c.time);
  edits.scale(body["preload"]["spin"].node(), 1 / c.time);
  if (const auto* rayleigh = body["damping"]["rayleigh"].as_array()) edits.scale(rayleigh, Units{1 / c.time, c.time});
  if (const auto* table = body["damping"]["table"].as_array())
    for (const auto& pair : *table) edits.scale(&pair, Units{1 / c.time, 1});
  for (const auto* mass : list_tables(body, "augment")) {
    edits.scale(mass->get("mass"), c.mass);
    edits.scale(mass->get("cg"), c.length);
    edits.scale(mass->get("inertia"), c.mass * c.length * c.length);
  }
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
  if (const auto* body = root["body"].as_table()) {
    change_body_file(*body, edits, change);
    edits.scale(root["preload"]["spin"].node(), 1 / change.time);
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
