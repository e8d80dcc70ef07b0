#pragma once
/// \file The state to linearize about: the start, a later time of the run, or an equilibrium.
#include "cli/common/system_files.hpp"
#include "solver/linear/plant.hpp"

namespace bough::cli {

/// `is_open`: without the controllers.
solver::Plant make_plant(const LoadedSystem& loaded, bool is_open = false);

/// The state at time t, by the run's own integrator. InputError("linear.bad-time") before the start.
solver::OperatingPoint run_to(const LoadedSystem& loaded, const solver::Plant& plant, double t,
                              Diagnostics& diagnostics);

/// Rest or steady spin near `start`, by the hinge rates of the system file whatever those at `start` are.
solver::OperatingPoint find_rest(solver::Plant& plant, solver::OperatingPoint start, const std::string& file);

}  // namespace bough::cli
