#pragma once
/// \file A System as ẋ = A x + B u, y = C x + D u about any state (docs/theory/linear.md).
///
/// x = [δ; δu; δz], minimal coordinates: δ the displacement of each DOF (solver/linear/plant.hpp), δu of its speed,
/// δz of the states of controllers, actuators and sensors (those of controllers where the loop is closed).
#include "base/diagnostic.hpp"
#include "formats/records/linear_model.hpp"
#include "solver/linear/plant.hpp"

namespace bough::solver {

struct LinearizeOptions {
  std::vector<std::string> inputs;   ///< forces, actuators, hinges (all their free coordinates) or "hinge:1";
                                     ///< empty: all actuators, or all forces where there is none
  std::vector<std::string> outputs;  ///< sensors, controllers, actuators, "motor:command", or components "tip:x";
                                     ///< empty: all sensors
  /// Repeats A and C with other steps (LinearModel::difference), and a little later in the motion: a warning reports a
  /// model that changes ("linear.time-varying").
  bool check = true;
  std::string cut =
      {};  ///< an actuator, or a component of a sensor or controller: the loop through it is cut, the only
           ///< input is what follows the cut, the only output what comes back to it, with its sign changed
};

/// B and D of forces are exact: u̇ and y are affine in a force, so two evaluations per column. The others, A and C by
/// extrapolated central differences with an error estimate. Poles, and zeros where there are as many outputs as inputs.
/// Throws InputError "linear.unknown-input", "linear.unknown-output", "linear.unknown-signal"; notes
/// "linear.not-steady", "linear.sampled".
records::LinearModel linearize(Plant& plant, const OperatingPoint& point, const LinearizeOptions& options,
                               const SourceLocation& at, Diagnostics& diagnostics);

/// Warns "linear.latches-left-out" of dry friction and rigid stops, which linear models and equilibria leave
/// out.
void warn_of_latches(const System& system, const SourceLocation& at, Diagnostics& diagnostics);

}  // namespace bough::solver
