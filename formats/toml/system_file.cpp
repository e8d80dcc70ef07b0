#include <algorithm>
#include <charconv>
#include <numbers>
#include <set>
#include <sstream>

#include <Eigen/Eigenvalues>

#include "formats/records/orbit.hpp"
#include "formats/records/slosh.hpp"
#include "formats/toml/detail/constraint_table.hpp"
#include "formats/toml/detail/control_tables.hpp"
#include "formats/toml/detail/event_table.hpp"
#include "formats/toml/detail/fields.hpp"
#include "formats/toml/detail/force_table.hpp"
#include "formats/toml/detail/function_table.hpp"
#include "formats/toml/detail/hinge_table.hpp"
#include "formats/toml/detail/inertia.hpp"
#include "formats/toml/detail/orbit_table.hpp"
#include "formats/toml/detail/parameters.hpp"
#include "formats/toml/detail/references.hpp"
#include "formats/toml/detail/schema.hpp"
#include "formats/toml/detail/tank_table.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/specs.hpp"
#include "formats/toml/system_text.hpp"

namespace bough::toml_files {

namespace {

records::BodyRecord read_body(const Fields& table, const std::string& path, Diagnostics& diagnostics) {
  records::BodyRecord body;
  body.at = table.locate();
  body.name = table.get_string("name");
  body.file = resolve_path(path, table.get_string("file"));
  body.mass = table.get_number("mass", 0);
  body.cg = table.get_vector("cg", body.cg);
  body.inertia = read_inertia(table, diagnostics);
  std::set<int> ids;
  for (const Fields& node : table.get_tables("nodes")) {
    body.nodes.push_back({node.get_int("id", 0), node.get_vector("position", Eigen::Vector3d::Zero())});
    if (!ids.insert(body.nodes.back().id).second) {
      diagnostics.error("toml.duplicate-name", node.locate("id"),
                        "node " + std::to_string(body.nodes.back().id) + " of body '" + body.name + "' is given twice",
                        "renumber one of them");
    }
  }
  body.hull = table.get_vectors("hull");
  body.stiffening = table.get_bool("stiffening", true);
  body.eta = table.get_numbers("eta");
  body.eta_dot = table.get_numbers("eta_dot");
  body.damping_ratios = table.get_numbers("damping");
  body.num_modes = table.get_int("modes", -1);
  body.recover_all = table.get_bool("recover", false);
  body.recover = table.get_ints("recover");
  for (const auto& level : table.get_strings("levels")) body.levels.push_back(resolve_path(path, level));
  if (!body.levels.empty() && table.has("file") && std::count(body.levels.begin(), body.levels.end(), body.file) != 1)
    diagnostics.error("toml.bad-value", table.locate("levels"),
                      "'levels' of body '" + body.name + "' does not contain its file once",
                      "list the files of all levels, that of the start among them");
  if (table.has("file")) {
    // A .FLX, under any name, may leave them to the system, as TREETOPS has it. The content decides when it is read.
    if (body.file.ends_with(".h5") || body.file.ends_with(".hdf5"))
      refuse_keys(table, {"cg", "inertia"}, "in body '" + body.name + "', which comes from a file", diagnostics);
    refuse_keys(table, {"nodes"}, "in body '" + body.name + "', which comes from a file", diagnostics);
  } else {
    refuse_keys(table, {"levels", "stiffening", "eta", "eta_dot", "damping", "modes", "recover"},
                "in body '" + body.name + "', which is rigid", diagnostics);
  }
  return body;
}

records::SensorRecord read_sensor(const Fields& table, const std::string& path, Diagnostics& diagnostics) {
  using records::SensorOf;
  using records::SensorType;
  records::SensorRecord sensor;
  sensor.at = table.locate();
  sensor.name = table.get_string("name");
  sensor.body = table.get_string("body");
  sensor.node = table.get_int("node", 0);
  sensor.relative_to = table.get_string("relative_to");
  constexpr std::string_view kOrbit = "lvlh:";
  sensor.is_orbital = sensor.relative_to.starts_with(kOrbit);
  if (sensor.is_orbital) sensor.relative_to.erase(0, kOrbit.size());
  sensor.hinge = table.get_string("hinge");
  sensor.coordinate = table.get_int("coordinate", 0);
  const auto* kind = records::find_sensor_kind(table.get_string("type"));
  if (kind == nullptr) return sensor;  // reported by the schema
  sensor.type = kind->type;
  const bool is_elastic = kind->of == SensorOf::Elastic;
  sensor.frame = table.get_string("frame", is_elastic ? "body" : sensor.is_orbital ? "" : "inertial");

  read_sensor_keys(table, path, kind->word, sensor, diagnostics);
  const bool is_hinge_load = kind->of == SensorOf::HingeLoad;
  const bool is_hinge_sensor = kind->of == SensorOf::Coordinate || is_hinge_load;
  const bool is_modal = kind->of == SensorOf::Modes;
  const bool is_attitude = kind->of == SensorOf::Attitude;
  const bool is_vector = kind->of == SensorOf::Point || is_elastic;
  const std::string because = "in sensor '" + sensor.name + "' of type " + kind->word;
  const bool is_optical = kind->of == SensorOf::Optics;
  if (is_optical) sensor.terms = read_optical_terms(table, sensor.name, diagnostics);
  const char* needed = is_hinge_sensor ? "hinge" : is_optical ? "terms" : "body";
  if (!table.has(needed)) {
    diagnostics.error("toml.missing-key", sensor.at, "missing key '" + std::string(needed) + "' " + because, "add it");
  }
  if (is_optical) {
    refuse_keys(table, {"body", "node", "frame", "observer", "hinge", "coordinate"}, because, diagnostics);
    if (sensor.is_orbital) refuse_keys(table, {"relative_to"}, because + ": the LVLH frame turns", diagnostics);
  } else if (is_hinge_sensor) {
    refuse_keys(table, {"body", "node", "frame", "relative_to", "observer"}, because, diagnostics);
    if (is_hinge_load) refuse_keys(table, {"coordinate"}, because, diagnostics);
  } else {
    refuse_keys(table, {"hinge"}, because, diagnostics);
    if (!is_modal) refuse_keys(table, {"coordinate"}, because, diagnostics);
    if (!is_vector) refuse_keys(table, {"frame", "observer"}, because, diagnostics);
    if (!is_vector && !is_attitude) refuse_keys(table, {"relative_to"}, because, diagnostics);
    const bool is_element = kind->of == SensorOf::Element;
    if (is_element && !table.has("element"))
      diagnostics.error("toml.missing-key", sensor.at, "missing key 'element' " + because, "add it");
    if (is_modal || is_element || kind->of == SensorOf::Energy) refuse_keys(table, {"node"}, because, diagnostics);
    if (is_elastic) refuse_keys(table, {"relative_to", "observer"}, because, diagnostics);
    if (sensor.is_orbital &&
        (sensor.type == SensorType::Acceleration || sensor.type == SensorType::AngularAcceleration))
      refuse_keys(table, {"relative_to"}, because + ": an LVLH frame gives no accelerations", diagnostics);
    if (is_vector && !is_elastic && !table.has("relative_to"))
      refuse_keys(table, {"observer"}, because + ", which has no relative_to", diagnostics);
  }
  sensor.from_turning = table.get_string("observer", "turning") != "fixed";
  return sensor;
}

records::SimulationRecord read_simulation(const Fields& table, Diagnostics& diagnostics) {
  records::SimulationRecord simulation;
  simulation.at = table.locate();
  simulation.start = table.get_number("start", simulation.start);
  simulation.duration = table.get_number("duration", simulation.duration);
  simulation.output_step = table.get_number("output_step", simulation.output_step);
  simulation.output_from = table.get_number("output_from", simulation.output_from);
  simulation.output_until = table.get_number("output_until", simulation.output_until);
  simulation.output_every = table.get_int("output_every", simulation.output_every);
  simulation.record = table.get_strings("record");
  simulation.integrator = table.get_string("integrator", simulation.integrator);
  simulation.stiffening = table.get_string("stiffening", simulation.stiffening);
  simulation.stiffening_step = table.get_number("stiffening_step", 0);
  simulation.rk_order = table.get_int("rk_order", simulation.rk_order);
  simulation.step = table.get_number("step", simulation.step);
  simulation.relative_tolerance = table.get_number("relative_tolerance", simulation.relative_tolerance);
  simulation.absolute_tolerance = table.get_number("absolute_tolerance", simulation.absolute_tolerance);
  simulation.absolute_tolerance_modes = table.get_number("absolute_tolerance_modes", 0);
  simulation.energy_error_limit = table.get_number("energy_error_limit", simulation.energy_error_limit);
  simulation.gravity = table.get_vector("gravity", simulation.gravity);
  simulation.divergence_limit = table.get_number("divergence_limit", simulation.divergence_limit);
  if (simulation.stiffening != "lagged")
    refuse_keys(table, {"stiffening_step"}, "in simulation, whose stiffening is not lagged", diagnostics);
  else if (!table.has("stiffening_step") && !table.has("step"))
    diagnostics.error("toml.missing-key", table.locate("stiffening"),
                      "missing key 'stiffening_step' in simulation, whose stiffening is lagged",
                      "give it, or the step of a fixed-step integrator");
  const bool is_fixed = simulation.integrator == "rk4" || simulation.integrator == "implicit";
  if (is_fixed && !table.has("step")) {
    diagnostics.error("toml.missing-key", table.locate("integrator"),
                      "missing key 'step' in simulation: the integrator " + simulation.integrator + " has a fixed step",
                      "add it");
  }
  return simulation;
}

/// [parameters] of the text with other numbers. Reports "toml.unknown-parameter".
void set_parameters(std::string& text, const std::string& path,
                    const std::vector<std::pair<std::string, std::string>>& set, Diagnostics& diagnostics) {
  Value root;
  if (set.empty() || !parse_toml(text, path, root, diagnostics)) return;
  const Value* parameters = root.find("parameters");
  std::vector<std::string> known;
  if (parameters)
    for (const auto& entry : parameters->entries) known.push_back(entry.key);
  for (const auto& [name, value] : set) {
    std::string why = "it has no such parameter";
    if (std::find(known.begin(), known.end(), name) != known.end()) why = set_key(text, "parameters." + name, value);
    if (why.empty()) continue;
    const std::string near = find_nearest(name, known);
    diagnostics.error("toml.unknown-parameter", {path}, "parameter '" + name + "' cannot be set: " + why,
                      near.empty() || near == name ? "add it to [parameters]" : "did you mean '" + near + "'?");
  }
}

/// BODY:NODE into its parts, unless a body has this name.
void split_node(const records::SystemSpec& spec, std::string& name, int& node) {
  const auto is_it = [&](const auto& body) { return body.name == name; };
  const auto colon = name.rfind(':');
  if (colon == std::string::npos || colon == 0 || std::any_of(spec.bodies.begin(), spec.bodies.end(), is_it)) return;
  const char* const end = name.data() + name.size();
  int id = 0;
  const auto [last, failed] = std::from_chars(name.data() + colon + 1, end, id);
  if (failed != std::errc() || last != end || id < 0) return;
  node = id;
  name.erase(colon);
}

}  // namespace

records::SystemSpec read_system_spec(const std::string& path, Diagnostics& diagnostics,
                                     const std::vector<std::pair<std::string, std::string>>& set) {
  records::SystemSpec spec;
  spec.file = path;
  if (!read_text(path, spec.text, diagnostics)) return spec;
  return read_system_spec_text(std::move(spec.text), path, set, diagnostics);
}

records::SystemSpec read_system_spec_text(std::string text, const std::string& path,
                                          const std::vector<std::pair<std::string, std::string>>& set,
                                          Diagnostics& diagnostics) {
  set_parameters(text, path, set, diagnostics);
  return read_system_spec_text(text, path, diagnostics);
}

records::SystemSpec read_system_spec_text(const std::string& text, const std::string& path, Diagnostics& diagnostics) {
  records::SystemSpec spec;
  spec.file = path;
  spec.text = text;
  Value root;
  if (!parse_toml(spec.text, path, root, diagnostics)) return spec;
  const int num_errors = diagnostics.num_errors();
  insert_parameters(root, path, diagnostics);
  if (diagnostics.num_errors() > num_errors) return spec;  // without their numbers the rest cannot be checked
  check_schema(root, get_system_schema(), path, diagnostics);

  const Fields fields(root, path);
  spec.name = fields.get_string("name", get_stem(path));
  const Fields units = fields.get_table("units");
  spec.units = {units.get_string("length"), units.get_string("mass"), units.get_string("time"),
                units.get_string("force")};
  if (const Value* parameters = fields.find("parameters"))
    for (const auto& entry : parameters->entries)
      if (entry.value.is_number()) spec.parameters.emplace_back(entry.key, entry.value.number);
  for (const Fields& table : fields.get_tables("body")) spec.bodies.push_back(read_body(table, path, diagnostics));
  for (const Fields& table : fields.get_tables("tank")) spec.tanks.push_back(read_tank(table, diagnostics));
  for (const Fields& table : fields.get_tables("orbit")) spec.orbits.push_back(read_orbit(table, diagnostics));
  for (const Fields& table : fields.get_tables("hinge")) spec.hinges.push_back(read_hinge(table, diagnostics));
  for (const Fields& table : fields.get_tables("constraint"))
    spec.constraints.push_back(read_constraint(table, diagnostics));
  if (const Value* functions = fields.find("function")) {
    for (const Value& table : functions->items) {
      if (table.is_table()) spec.functions.push_back(read_function(Fields(table, path), path, diagnostics));
    }
  }
  for (const Fields& table : fields.get_tables("force")) read_force(table, spec, diagnostics);
  for (const Fields& table : fields.get_tables("sensor")) spec.sensors.push_back(read_sensor(table, path, diagnostics));
  for (const Fields& table : fields.get_tables("input")) spec.inputs.push_back(read_input(table));
  for (const Fields& table : fields.get_tables("controller"))
    spec.controllers.push_back(read_controller(table, path, diagnostics));
  for (const Fields& table : fields.get_tables("actuator"))
    spec.actuators.push_back(read_actuator(table, path, diagnostics));
  for (const Fields& table : fields.get_tables("connect")) spec.connects.push_back(read_connect(table));
  for (const Fields& table : fields.get_tables("event")) spec.events.push_back(read_event(table, diagnostics));
  spec.simulation = read_simulation(fields.get_table("simulation"), diagnostics);
  if (!spec.tanks.empty()) records::add_slosh(spec, diagnostics);
  records::add_orbits(spec, diagnostics);
  for (auto& sensor : spec.sensors) {
    if (!sensor.is_orbital) split_node(spec, sensor.relative_to, sensor.relative_node);
    split_node(spec, sensor.frame, sensor.frame_node);
  }
  check_names(spec, diagnostics);
  return spec;
}

}  // namespace bough::toml_files
