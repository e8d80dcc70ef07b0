#pragma once
/// \file Discrete state of --start-from: what the events of an earlier run locked, released, closed or broke.
#include <map>
#include <string>
#include <vector>

#include "formats/hdf5/files.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/state/state.hpp"

namespace bough::analysis {

/// A constraint that an event closed, with the position error that it keeps.
struct ClosedConstraint {
  std::string name;
  solver::ConstraintState state;  ///< without q
};

struct StartModes {
  std::string text;  ///< what was set, in words; empty if nothing was
  std::vector<ClosedConstraint> closed;
  /// Rates after the events at the time of the last sample, which shows those before them: of hinges, and of modes by
  /// body. Empty without such events.
  std::map<std::string, std::vector<double>> hinge_rates, eta_dot;
};

/// Sets the modes that the events of an earlier run left: `locked` and `motion` of hinges, `active` of constraints. A
/// mode that no event changed remains that of `spec`; contacts (friction, rigid stops) follow from the motion. Warns
/// "cli.start-modes" of each mode that `spec` has no place for, and of modes that are not known at the last sample.
/// \param before  the spec that the results file was made of.
/// \return constraints to close when the system is built; they are not active in `spec`, which would close them without
/// a position error.
StartModes set_start_modes(records::SystemSpec& spec, const records::SystemSpec& before,
                           const hdf5::ResultsFile& results, const std::string& path, Diagnostics& diagnostics);

}  // namespace bough::analysis
