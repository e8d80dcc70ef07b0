#include "solver/control/controller.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

#include "solver/control/makers.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

using Maker = std::function<std::unique_ptr<Block>(SettingsReader&, const ControllerWiring&, double)>;

const std::map<std::string, Maker>& get_makers() {
  const auto plain = [](auto make) { return [make](auto& keys, const auto& w, double) { return make(keys, w); }; };
  static const std::map<std::string, Maker> makers = {
      {"transfer_function", [](auto& keys, const auto& w, double T) { return make_transfer_function(keys, w, T > 0); }},
      {"state_space", [](auto& keys, const auto& w, double T) { return make_state_space(keys, w, T > 0); }},
      {"gain", plain(make_gain)},
      {"sum", plain(make_sum)},
      {"product", plain(make_product)},
      {"limit", plain(make_limit)},
      {"notch", make_notch},
      {"lead_lag", make_lead_lag},
      {"pid", make_pid},
      {"table", plain(make_table)},
      {"relay", plain(make_relay)},
      {"pwpf", plain(make_pwpf)},
      {"switch", plain(make_switch)},
      {"expression", plain(make_expression)},
      {"library", plain(make_library)},
      {"fmu", plain(make_fmu)},
  };
  return makers;
}

/// ": torque, speed" of the outputs that have names, which an FMU gives; the count of one that has a name that signals
/// cannot have.
std::string list_outputs(const records::ControllerRecord& r, int count) {
  const auto found = r.settings.words.find("output_names");
  if (found == r.settings.words.end() || static_cast<int>(found->second.size()) != count) return "";
  std::string list;
  for (const auto& name : found->second) {
    const bool is_name = name.find_first_not_of("0123456789") != std::string::npos &&
                         name.find(':') == std::string::npos && name.find(", ") == std::string::npos;
    const auto place = static_cast<std::size_t>(&name - found->second.data()) + 1;
    list += (list.empty() ? ": " : ", ") + (is_name ? name : std::to_string(place));
  }
  return list;
}

}  // namespace

int ControllerWiring::size() const { return std::accumulate(inputs.begin(), inputs.end(), 0) + reference + rate; }

bool ControllerWiring::are_alike() const {
  return std::adjacent_find(inputs.begin(), inputs.end(), std::not_equal_to<>()) == inputs.end();
}

int find_outputs(const records::ControllerRecord& r) {
  const auto rows = [&](const char* key) {
    const auto it = r.settings.matrices.find(key);
    return it == r.settings.matrices.end() ? 0 : static_cast<int>(it->second.rows());
  };
  if (r.settings.has("outputs")) return static_cast<int>(r.settings.get("outputs", 0));
  if (r.type == "state_space") return std::max(rows("C"), rows("D"));
  if (r.type == "gain") return rows("gain");
  if (r.type == "table") return r.settings.has("x2") ? 1 : 0;
  if (r.type != "expression") return 0;
  const auto words = r.settings.words.find("expression");
  return words == r.settings.words.end() ? 0 : static_cast<int>(words->second.size());
}

std::unique_ptr<Block> make_controller(const records::ControllerRecord& r, const ControllerWiring& wiring,
                                       Diagnostics& diagnostics) {
  const auto& makers = get_makers();
  const auto maker = makers.find(r.type);
  if (maker == makers.end()) {
    std::vector<std::string> types;
    std::string list;
    for (const auto& [type, make] : makers) {
      types.push_back(type);
      list += (list.empty() ? "" : ", ") + type;
    }
    diagnostics.error("control.unknown-type", r.at, "controller '" + r.name + "' has the unknown type '" + r.type + "'",
                      suggest_name(r.type, types, "use one of: " + list));
    return nullptr;
  }
  SettingsReader keys(r.settings, "controller '" + r.name + "' of type " + r.type, r.at, diagnostics);
  const double sample_time = keys.has("sample_time") ? keys.get_positive("sample_time") : 0;
  const double delay = keys.get_size("delay", 0);
  const double outputs = keys.get("outputs", 0);
  keys.demand(delay == 0 || sample_time > 0, "has a delay and no sample_time", "give sample_time, or a lag instead");
  if ((!r.reference.empty() || !r.rate.empty()) && r.type != "pid")
    keys.error("control.unknown-key", "takes no reference and no rate", "name them among its inputs");
  std::unique_ptr<Block> made;
  if (wiring.inputs.empty() || wiring.size() == 0)
    keys.error("control.missing-key", "has no inputs", "give inputs = [\"SIGNAL\"]");
  else
    made = maker->second(keys, wiring, sample_time);
  keys.refuse_others();
  if (keys.has_failed() || !made) return nullptr;
  made->sizes.inputs = wiring.size();
  if (outputs != 0 && outputs != made->sizes.outputs) {
    keys.error("control.bad-size",
               "has " + std::to_string(made->sizes.outputs) + " outputs, not " + std::to_string(std::lround(outputs)),
               "leave 'outputs' out");
    return nullptr;
  }
  if (sample_time > 0 && (made->sizes.event_functions > 0 || made->sizes.states > 0)) {
    keys.error("control.bad-value", "has continuous states, or switches in the step, and cannot be sampled",
               "leave out sample_time, or sample its inputs, by a gain of 1 with sample_time");
    return nullptr;
  }
  made->sizes.sample_time = sample_time;
  made->sizes.delay = delay;
  made->set_name(BlockKind::Controller, r.name);
  made->label = "controller '" + r.name + "'";
  made->description = "outputs of a controller of type " + r.type + list_outputs(r, made->sizes.outputs);
  made->dims = "by the controller";
  made->at = r.at;
  return made;
}

}  // namespace bough::solver
