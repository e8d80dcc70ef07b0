#include "solver/builder/sources.hpp"
#include "solver/text/names.hpp"

#include <algorithm>

namespace bough::solver {

bool Sources::find(const SignalUse& use, const std::string& user, Wire& wire, Diagnostics& diagnostics) const {
  const auto colon = use.text.rfind(':');
  std::string name = use.text, component;
  const auto matches = [&](const Source& s) { return s.name == name || s.path == name; };
  if (std::none_of(list.begin(), list.end(), matches) && colon != std::string::npos) {
    name = use.text.substr(0, colon);
    component = use.text.substr(colon + 1);
  }
  const auto first = std::find_if(list.begin(), list.end(), matches);
  if (first == list.end()) {
    std::vector<std::string> known;
    for (const auto& s : list) known.push_back(s.name);
    diagnostics.error(
        "control.unknown-signal", use.at, user + " names the signal '" + use.text + "', which does not exist",
        suggest_name(name, known, "name a sensor, input, controller, actuator or function, as pid or tip:x"));
    return false;
  }
  if (const auto second = std::find_if(first + 1, list.end(), matches); second != list.end()) {
    diagnostics.error(
        "control.unknown-signal", use.at,
        user + " names the signal '" + use.text + "', which may be " + first->path + " or " + second->path,
        "write the one you mean");
    return false;
  }
  wire.source = static_cast<size_t>(first - list.begin());
  wire.text = component;
  wire.component = component.empty() ? -1 : 0;
  wire.gain = use.gain;
  wire.at = use.at;
  return true;
}

Source& Sources::at_path(const std::string& path) {
  return *std::find_if(list.begin(), list.end(), [&](const Source& s) { return s.path == path; });
}

}  // namespace bough::solver
