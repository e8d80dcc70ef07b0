#pragma once
/// \file Export of a system as an FMU (docs/fmu.md).
#include <string>
#include <vector>

namespace bough {
class Diagnostics;
}

namespace bough::analysis {

struct FmuOptions {
  int version = 3;                   ///< of FMI: 2 or 3
  std::vector<std::string> outputs;  ///< channels or components; empty: every sensor
  std::vector<std::string> set;      ///< "name=value" of [parameters]: other start values
  std::string units;                 ///< of the system file, as "mm-N-tonne"; empty: not known
};

/// Numbers of the variables of an FMU.
struct FmuSummary {
  std::size_t parameters = 0, inputs = 0, outputs = 0, states = 0, event_indicators = 0;
};

/// Writes an FMU for Co-Simulation and Model Exchange. Equal input gives equal bytes.
///
/// \param file    a system file.
/// \param output  the .fmu; its stem is the model identifier.
/// \throws InputError of the system, "fmu.cannot-pack", "fmu.output", "cli.bad-units"; ComputationError
/// "fmu.no-binary", "fmu.write".
FmuSummary export_fmu(const std::string& file, const std::string& output, const FmuOptions& options,
                      Diagnostics& diagnostics);

}  // namespace bough::analysis
