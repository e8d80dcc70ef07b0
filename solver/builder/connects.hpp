#pragma once
/// \file Wiring of signals: the names in the tables themselves, and those that [[connect]] adds.
#include <map>

#include "formats/records/system_spec.hpp"

namespace bough::solver {

/// A signal where it is used.
struct SignalUse {
  std::string text;  ///< "name", "name:component", "/path:component"
  double gain = 1;
  SourceLocation at;
};

struct ControllerUses {
  std::vector<SignalUse> inputs;
  std::vector<SignalUse> reference, rate;  ///< one or none
};

struct SignalUses {
  std::map<std::string, ControllerUses> controllers;
  std::map<std::string, SignalUse> actuators, forces;  ///< those that have one
};

/// Reports "control.bad-connect".
SignalUses collect_uses(const records::SystemSpec& spec, Diagnostics& diagnostics);

}  // namespace bough::solver
