#include "solver/linear/ports.hpp"

namespace bough::solver {
namespace {

/// Index of each wanted name; a name before ":" stands for all of its components.
std::vector<int> choose(const std::vector<std::string>& wanted, const std::vector<std::string>& known,
                        const std::string& noun, const char* id, const SourceLocation& at, Diagnostics& diagnostics) {
  std::vector<int> chosen;
  for (const auto& name : wanted) {
    const auto size = chosen.size();
    for (size_t i = 0; i < known.size(); ++i) {
      const bool is_component = known[i].starts_with(name + ":") && known[i] != name + ":command";
      if (known[i] == name || is_component) chosen.push_back(static_cast<int>(i));
    }
    if (chosen.size() > size) continue;
    const std::string near = find_nearest(name, known);
    std::string list;
    for (const auto& word : known) list += (list.empty() ? "" : ", ") + word;
    diagnostics.error(id, at, "there is no " + noun + " '" + name + "'",
                      !near.empty()  ? "did you mean '" + near + "'?"
                      : list.empty() ? "the system has none"
                                     : "choose among: " + list);
  }
  return chosen;
}

Ports choose_cut(const Plant& plant, const std::string& name, const SourceLocation& at, Diagnostics& diagnostics) {
  const auto cuts = plant.list_cuts();
  const auto found = choose({name}, cuts, "signal", "linear.unknown-signal", at, diagnostics);
  if (found.size() > 1)
    diagnostics.error("linear.unknown-signal", at, "'" + name + "' has several components, and one loop is cut",
                      "write one of them, as " + cuts[static_cast<size_t>(found.front())]);
  diagnostics.throw_if_errors();
  const Plant::Cut cut = plant.find_cut(cuts[static_cast<size_t>(found.front())]);
  return {{cut.input}, {cut.output}};
}

}  // namespace

Ports choose_ports(const Plant& plant, const LinearizeOptions& options, const SourceLocation& at,
                   Diagnostics& diagnostics) {
  if (!options.cut.empty()) return choose_cut(plant, options.cut, at, diagnostics);
  Ports ports;
  if (options.inputs.empty()) {
    const bool has_actuators = plant.num_actuators() > 0;
    for (int i = 0; i < (has_actuators ? plant.num_actuators() : plant.num_forces()); ++i)
      ports.inputs.push_back(has_actuators ? plant.num_forces() + i : i);
  } else {
    std::vector<std::string> names;
    for (const auto& input : plant.inputs()) names.push_back(input.name);
    ports.inputs = choose(options.inputs, names, "input", "linear.unknown-input", at, diagnostics);
  }
  if (options.outputs.empty())
    for (int i = 0; i < plant.num_sensor_outputs(); ++i) ports.outputs.push_back(i);
  else
    ports.outputs = choose(options.outputs, plant.outputs().name, "output", "linear.unknown-output", at, diagnostics);
  diagnostics.throw_if_errors();
  std::string said;
  for (const int i : ports.outputs) {
    const std::string law = plant.find_frozen_law(i);
    if (law.empty() || law == said) continue;
    diagnostics.warning("linear.open-controller", at,
                        "--open: the states of controller '" + law + "' are left out, so that its output '" +
                            plant.outputs().name[static_cast<size_t>(i)] + "' is only what it does at once",
                        "leave --open out, or take outputs of sensors and commands of actuators");
    said = law;
  }
  return ports;
}

}  // namespace bough::solver
