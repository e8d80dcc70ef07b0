#pragma once
/// \file Inputs and outputs of a linear model.
#include <vector>

#include "solver/linear/linearize.hpp"

namespace bough::solver {

struct Ports {
  std::vector<int> inputs, outputs;  ///< of plant.inputs() and plant.outputs()
};

/// Finds the ports by name; by default every actuator (or every force without actuators) and every sensor. Throws
/// InputError "linear.unknown-input", "linear.unknown-output", "linear.unknown-signal".
Ports choose_ports(const Plant& plant, const LinearizeOptions& options, const SourceLocation& at,
                   Diagnostics& diagnostics);

}  // namespace bough::solver
