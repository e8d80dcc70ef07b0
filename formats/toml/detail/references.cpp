#include "formats/toml/detail/references.hpp"

#include <algorithm>
#include <map>

namespace bough::toml_files {

namespace {

template <class Record>
std::vector<std::string> collect_names(const std::vector<Record>& records, const std::string& kind,
                                       Diagnostics& diagnostics) {
  std::vector<std::string> names;
  std::map<std::string, int> lines;
  for (const auto& record : records) {
    if (record.name.empty()) continue;  // reported by the schema
    const auto [it, is_new] = lines.emplace(record.name, record.at.line);
    if (is_new) {
      names.push_back(record.name);
    } else {
      diagnostics.error("toml.duplicate-name", record.at,
                        kind + " '" + record.name + "' was already given in line " + std::to_string(it->second),
                        "rename one of them");
    }
  }
  return names;
}

struct NamedForce {
  std::string name;
  SourceLocation at;
};

class ReferenceChecker {
 public:
  explicit ReferenceChecker(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  /// Empty is "not given" and passes.
  void check(const std::string& name, const std::vector<std::string>& declared, const std::string& role,
             const std::string& kind, const SourceLocation& at) {
    if (name.empty() || std::find(declared.begin(), declared.end(), name) != declared.end()) return;
    const std::string nearest = find_nearest(name, declared);
    diagnostics_.error("toml.unknown-name", at,
                       role + " refers to the " + kind + " '" + name + "', which is not declared",
                       nearest.empty() ? "declare it" : "did you mean '" + nearest + "'?");
  }

 private:
  Diagnostics& diagnostics_;
};

}  // namespace

void check_names(const records::SystemSpec& spec, Diagnostics& diagnostics) {
  const auto bodies = collect_names(spec.bodies, "body", diagnostics);
  const auto hinges = collect_names(spec.hinges, "hinge", diagnostics);
  const auto constraints = collect_names(spec.constraints, "constraint", diagnostics);
  const auto functions = collect_names(spec.functions, "function", diagnostics);
  // Loads and elements share one set of names, in the order of the file.
  std::vector<NamedForce> forces;
  for (const auto& force : spec.forces) forces.push_back({force.name, force.at});
  for (const auto& force : spec.force_elements) forces.push_back({force.name, force.at});
  std::stable_sort(forces.begin(), forces.end(), [](const auto& a, const auto& b) { return a.at.line < b.at.line; });
  collect_names(forces, "force", diagnostics);
  const auto tanks = collect_names(spec.tanks, "tank", diagnostics);
  collect_names(spec.sensors, "sensor", diagnostics);
  collect_names(spec.inputs, "input", diagnostics);
  collect_names(spec.events, "event", diagnostics);
  const auto controllers = collect_names(spec.controllers, "controller", diagnostics);
  collect_names(spec.actuators, "actuator", diagnostics);

  std::vector<std::string> signals = controllers;
  for (const auto& sensor : spec.sensors) signals.push_back(sensor.name);
  for (const auto& input : spec.inputs) signals.push_back(input.name);
  for (const auto& actuator : spec.actuators) signals.push_back(actuator.name);

  for (const auto& body : spec.bodies) {
    if (body.name == "ground" || body.name == "inertial" || body.name == "body") {
      diagnostics.error("toml.reserved-name", body.at, "a body is called '" + body.name + "', a name with a meaning",
                        "rename it");
    }
  }
  auto with = [&](std::initializer_list<const char*> more) {
    auto names = bodies;
    names.insert(names.end(), more.begin(), more.end());
    return names;
  };
  ReferenceChecker checker(diagnostics);
  for (const auto& hinge : spec.hinges) {
    const std::string role = "hinge '" + hinge.name + "'";
    checker.check(hinge.parent, with({"ground"}), role, "body", hinge.at);
    checker.check(hinge.child, bodies, role, "body", hinge.at);
    for (const auto& name : hinge.motion) {
      const bool is_signal = std::find(functions.begin(), functions.end(), name) == functions.end() &&
                             std::find(signals.begin(), signals.end(), name.substr(0, name.find(':'))) != signals.end();
      if (is_signal)
        diagnostics.error("toml.motion-of-signal", hinge.at,
                          role + " has the signal '" + name +
                              "' for its motion, and a signal has no known rate and "
                              "acceleration",
                          "drive the hinge by an actuator, or prescribe a function");
      else
        checker.check(name, functions, role, "function", hinge.at);
    }
    for (const auto* names : {&hinge.law.spring_table, &hinge.law.damper_table})
      for (const auto& name : *names) checker.check(name, functions, role, "function", hinge.at);
  }
  for (const auto& tank : spec.tanks) {
    const std::string role = "tank '" + tank.name + "'";
    checker.check(tank.body, bodies, role, "body", tank.at);
    checker.check(tank.function, functions, role, "function", tank.at);
  }
  for (const auto& actuator : spec.actuators) {
    const auto named = actuator.settings.words.find("tank");
    if (named != actuator.settings.words.end() && !named->second.empty())
      checker.check(named->second.front(), tanks, "actuator '" + actuator.name + "'", "tank", actuator.at);
  }
  for (const auto& function : spec.functions)
    for (const auto& name : function.of)
      checker.check(name, functions, "function '" + function.name + "'", "function", function.at);
  for (const auto& constraint : spec.constraints) {
    const std::string role = "constraint '" + constraint.name + "'";
    checker.check(constraint.parent, with({"ground"}), role, "body", constraint.at);
    checker.check(constraint.child, with({"ground"}), role, "body", constraint.at);
    for (const auto& term : constraint.terms) checker.check(term.hinge, hinges, role, "hinge", constraint.at);
  }
  for (const auto& event : spec.events) {
    using records::EventAction;
    const bool of_hinge = event.action == EventAction::Lock || event.action == EventAction::Release;
    const bool of_constraint = event.action == EventAction::Break || event.action == EventAction::Close;
    const bool of_level = event.action == EventAction::Level;
    checker.check(event.target,
                  of_hinge        ? hinges
                  : of_constraint ? constraints
                  : of_level      ? bodies
                                  : controllers,
                  "event '" + event.name + "'",
                  of_hinge        ? "hinge"
                  : of_constraint ? "constraint"
                  : of_level      ? "body"
                                  : "controller",
                  event.at);
  }
  for (const auto& force : spec.forces) {
    const std::string role = "force '" + force.name + "'";
    checker.check(force.body, bodies, role, "body", force.at);
    checker.check(force.function, functions, role, "function", force.at);
  }
  for (const auto& force : spec.force_elements) {
    const std::string role = "force '" + force.name + "'";
    checker.check(force.from.body, with({"ground"}), role, "body", force.at);
    checker.check(force.to.body, with({"ground"}), role, "body", force.at);
    for (const auto& name : force.bodies) checker.check(name, bodies, role, "body", force.at);
    for (const auto* name : {&force.spring_table, &force.damper_table, &force.function, &force.density_table})
      checker.check(*name, functions, role, "function", force.at);
  }
  for (const auto& sensor : spec.sensors) {
    const std::string role = "sensor '" + sensor.name + "'";
    checker.check(sensor.body, bodies, role, "body", sensor.at);
    checker.check(sensor.frame, with({"inertial", "body", "ground"}), role, "frame", sensor.at);
    if (sensor.is_orbital && std::find(bodies.begin(), bodies.end(), sensor.relative_to) == bodies.end())
      diagnostics.error("toml.unknown-name", sensor.at,
                        role + " is relative to 'lvlh:" + sensor.relative_to + "', and there is no such body",
                        "name a body after lvlh:");
    else
      checker.check(sensor.relative_to, with({"ground"}), role, "body", sensor.at);
    checker.check(sensor.hinge, hinges, role, "hinge", sensor.at);
    checker.check(sensor.to_body, with({"ground"}), role, "body", sensor.at);
    for (const auto& term : sensor.terms) checker.check(term.body, bodies, role, "body", term.at);
  }
}

}  // namespace bough::toml_files
