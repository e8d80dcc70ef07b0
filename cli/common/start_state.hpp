#pragma once
/// \file --start-from: the initial state out of a results file.
#include <optional>
#include <string>

#include "formats/records/results.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace bough::cli {

/// Puts the last sample of a results file (of run or equilibrium) into the records: position and rate of every hinge
/// that moves freely, eta and eta_dot of every flexible body. Reports "cli.start-mismatch" for what the file lacks or
/// has in another size, "cli.start-earlier" (warning) where the run went on after its last sample.
void set_start_state(records::SystemSpec& spec, const std::string& path, Diagnostics& diagnostics);

/// What simulate starts from (SimulateOptions::resume) where `path` is a file of equilibrium: the state that the system
/// has been given, with the states of controllers and actuators, and what samples hold, of the file. Nothing of a run's
/// file or an empty path; nothing and a note where the file has other controllers.
std::optional<records::Checkpoint> find_start_control(const std::string& path, const solver::System& system,
                                                      double time, Diagnostics& diagnostics);

}  // namespace bough::cli
