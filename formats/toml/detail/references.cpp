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
  const auto functions = collect_names(spec.functions, "function", diagnostics);
  collect_names(spec.forces, "force", diagnostics);
  collect_names(spec.sensors, "sensor", diagnostics);
  collect_names(spec.events, "event", diagnostics);
  collect_names(spec.controllers, "controller", diagnostics);
  collect_names(spec.actuators, "actuator", diagnostics);

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
    for (const auto& name : hinge.motion) checker.check(name, functions, role, "function", hinge.at);
  }
  for (const auto& force : spec.forces) {
    const std::string role = "force '" + force.name + "'";
    checker.check(force.body, bodies, role, "body", force.at);
    checker.check(force.function, functions, role, "function", force.at);
  }
  for (const auto& sensor : spec.sensors) {
    const std::string role = "sensor '" + sensor.name + "'";
    checker.check(sensor.body, bodies, role, "body", sensor.at);
    checker.check(sensor.frame, with({"inertial", "body", "ground"}), role, "frame", sensor.at);
    checker.check(sensor.relative_to, with({"ground"}), role, "body", sensor.at);
    checker.check(sensor.hinge, hinges, role, "hinge", sensor.at);
    checker.check(sensor.to_body, with({"ground"}), role, "body", sensor.at);
  }
}

}  // namespace bough::toml_files
