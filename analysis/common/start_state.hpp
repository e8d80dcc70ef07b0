#pragma once
/// \file --start-from: the initial state out of a results file.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/start_modes.hpp"
#include "formats/records/results.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace bough::analysis {

/// Start out of a results file, as far as it is no matter of records.
struct StartPoint {
  double time = 0;                               ///< of the last sample
  std::map<std::string, std::vector<double>> q;  ///< by hinge with a prescribed coordinate: all coordinates there
  std::vector<ClosedConstraint> closed;
};

/// Puts the last sample of a results file (of run or equilibrium) into the records: position and rate of every hinge
/// coordinate that is not prescribed, eta and eta_dot of every flexible body, mass of tanks, momentum of wheels and
/// gimbal angles, and the modes that events left (start_modes.hpp).
/// Reports "cli.start-mismatch" for data missing in the file or of another size, "cli.start-earlier" (warning) where
/// the run went on after its last sample.
StartPoint set_start_state(records::SystemSpec& spec, const std::string& path, Diagnostics& diagnostics);

/// Closes the constraints of the start. Warns "cli.start-motion" of each prescribed coordinate that does not start
/// where the file has it, "cli.start-modes" of a constraint that the start of another system does not close.
void finish_start(const StartPoint& start, const std::string& path, solver::System& system, Diagnostics& diagnostics);

/// Initial control state for simulate (SimulateOptions::resume) from a file of `equilibrium`: the states of controllers
/// and actuators and the values held by samples; the motion has been set before. None for the file of a run or an empty
/// path; none and a note if the file has other controllers.
std::optional<records::Checkpoint> find_start_control(const std::string& path, const solver::System& system,
                                                      double time, Diagnostics& diagnostics);

}  // namespace bough::analysis
