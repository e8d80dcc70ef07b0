#pragma once
/// \file The state to linearize about: the start, a later time of the run, or an equilibrium.
#include <memory>
#include <optional>

#include "analysis/common/system_files.hpp"
#include "formats/records/results.hpp"
#include "solver/linear/plant.hpp"

namespace bough::analysis {

/// `is_open`: without the controllers.
std::unique_ptr<solver::Plant> make_plant(const LoadedSystem& loaded, bool is_open = false);

/// The initial state; with --start-from a file of equilibrium the states of controllers and actuators are its own.
solver::OperatingPoint make_start(const LoadedSystem& loaded, solver::Plant& plant, Diagnostics& diagnostics);

/// Computes the state at time t by the integrator of the run; the plant gets the present modes (free, locked, closed)
/// of hinges and constraints, and is replaced by that of the present fill levels. `last`: state from which to continue,
/// replaced by the one at t. InputError("linear.bad-time") before the start; "linear.changed-system" with `last` if an
/// event has changed the system before t.
solver::OperatingPoint run_to(const LoadedSystem& loaded, std::unique_ptr<solver::Plant>& plant, double t,
                              Diagnostics& diagnostics, std::optional<records::Checkpoint>* last = nullptr);

/// Rest or steady spin near `start`, by the hinge rates of the system file whatever those at `start` are.
solver::OperatingPoint find_rest(solver::Plant& plant, solver::OperatingPoint start, const std::string& file);

}  // namespace bough::analysis
