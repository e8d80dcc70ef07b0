#pragma once
/// \file --start-from: the initial state out of a results file.
#include <string>

#include "formats/records/system_spec.hpp"

namespace bough::cli {

/// Puts the last sample of a results file (of run or equilibrium) into the records: position and rate of every hinge
/// that moves freely, eta and eta_dot of every flexible body. Reports "cli.start-mismatch" for what the file lacks or
/// has in another size, "cli.start-earlier" (warning) where the run went on after its last sample.
void set_start_state(records::SystemSpec& spec, const std::string& path, Diagnostics& diagnostics);

}  // namespace bough::cli
