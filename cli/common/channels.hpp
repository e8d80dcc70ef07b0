#pragma once
/// \file Choosing channels of a results file by name: "/hinges/spin/q", "tip_deflection", "tip_deflection:y".
#include <string>
#include <vector>

#include "formats/export/csv.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::cli {

/// Columns for `choice`: a path, a folder ("/bodies/boom") or the name of a sensor, with an optional ":component".
/// Column names read "sensors/tip_deflection:y". Throws InputError("cli.unknown-channel") with the nearest match.
std::vector<exports::CsvColumn> choose_columns(const hdf5::ResultsFile& results, const std::string& file,
                                               const std::string& choice);

}  // namespace bough::cli
