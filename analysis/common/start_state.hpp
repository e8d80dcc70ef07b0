#pragma once
/// \file --start-from: the initial state out of a results file.
#include <optional>
#include <string>

#include "formats/records/results.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace bough::analysis {

/// Puts the last sample of a results file (of run or equilibrium) into the records: position and rate of every hinge
/// that moves freely, eta and eta_dot of every flexible body, mass of tanks, momentum of wheels and gimbal angles.
/// Reports "cli.start-mismatch" for what the file lacks or has in another size, "cli.start-earlier" (warning) where the
/// run went on after its last sample.
void set_start_state(records::SystemSpec& spec, const std::string& path, Diagnostics& diagnostics);

/// Initial control state for simulate (SimulateOptions::resume) from a file of `equilibrium`: the states of controllers
/// and actuators and the values held by samples; the motion has been set before. None for the file of a run or an empty
/// path; none and a note if the file has other controllers.
std::optional<records::Checkpoint> find_start_control(const std::string& path, const solver::System& system,
                                                      double time, Diagnostics& diagnostics);

}  // namespace bough::analysis
