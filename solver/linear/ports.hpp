#pragma once
/// \file Which inputs and outputs of a plant a linear model has.
#include <vector>

#include "solver/linear/linearize.hpp"

namespace bough::solver {

struct Ports {
  std::vector<int> inputs, outputs;  ///< of plant.inputs() and plant.outputs()
};

/// By name; by default every actuator, or every force where there is none, and every sensor. Throws InputError
/// "linear.unknown-input", "linear.unknown-output", "linear.unknown-signal".
Ports choose_ports(const Plant& plant, const LinearizeOptions& options, const SourceLocation& at,
                   Diagnostics& diagnostics);

}  // namespace bough::solver
