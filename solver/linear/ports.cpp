#include "solver/linear/ports.hpp"
#include "solver/text/names.hpp"

#include <algorithm>

#include "formats/records/signal_name.hpp"

namespace bough::solver {
namespace {

/// Indices of the components of `name`; a command of an actuator is none.
std::vector<int> list_components(const std::string& name, const std::vector<std::string>& known) {
  std::vector<int> list;
  for (size_t i = 0; i < known.size(); ++i)
    if (known[i].starts_with(name + ":") && known[i] != name + ":command") list.push_back(static_cast<int>(i));
  return list;
}

/// Index of the component that "NAME:2" counts, for components with names; -1 without such a component.
int find_counted(const std::string& name, const std::vector<std::string>& known) {
  const auto signal = records::parse_signal_name("/" + name);
  const auto list = list_components(signal.path.substr(1), known);
  for (size_t i = 0; i < list.size(); ++i)
    if (signal.component == std::to_string(i + 1)) return list[i];
  return -1;
}

/// Index of each wanted name; a name before ":" stands for all of its components.
std::vector<int> choose(const std::vector<std::string>& requested, const std::vector<std::string>& known,
                        const std::string& noun, const char* id, const SourceLocation& at, Diagnostics& diagnostics) {
  std::vector<int> chosen;
  for (const auto& name : requested) {
    auto found = list_components(name, known);
    for (size_t i = 0; i < known.size(); ++i)
      if (known[i] == name) found.push_back(static_cast<int>(i));
    std::sort(found.begin(), found.end());
    if (const int counted = found.empty() ? find_counted(name, known) : -1; counted >= 0) found.push_back(counted);
    chosen.insert(chosen.end(), found.begin(), found.end());
    if (!found.empty()) continue;
    std::string list;
    for (const auto& word : known) list += (list.empty() ? "" : ", ") + word;
    diagnostics.error(id, at, "there is no " + noun + " '" + name + "'",
                      suggest_name(name, known, list.empty() ? "the system has none" : "choose among: " + list));
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
  std::string warned;
  for (const int i : ports.outputs) {
    const std::string law = plant.find_frozen_law(i);
    if (law.empty() || law == warned) continue;
    diagnostics.warning("linear.open-controller", at,
                        "--open: the states of controller '" + law + "' are left out, so that its output '" +
                            plant.outputs().name[static_cast<size_t>(i)] + "' is only what it does at once",
                        "leave --open out, or take outputs of sensors and commands of actuators");
    warned = law;
  }
  return ports;
}

}  // namespace bough::solver
