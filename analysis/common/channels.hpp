#pragma once
/// \file Choosing channels of a results file by name: "/hinges/spin/q", "tip_deflection", "tip_deflection:y".
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/export/csv.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::analysis {

/// Names of the components of a channel: x y z, quaternions w x y z, else 1 2 ...; empty for a scalar.
std::vector<std::string> get_component_names(const std::string& path, int size);

/// Adds "cli.incomplete-run" (warning) when the file holds results of a run that was stopped, was killed or goes on;
/// nothing for a file of another kind.
void warn_incomplete(const std::string& file, Diagnostics& diagnostics);

/// Unit of a channel (or of /time) in the labels of [units]; without any label its dimensions, none for "1". Of
/// components that differ a list.
std::string get_unit(const hdf5::ResultsFile& results, const std::string& path);
/// Returns true if the run had [units].
bool has_unit_labels(const hdf5::ResultsFile& results);

/// Columns for `choice`: an existing path, unchanged; else a path, a folder ("/bodies/boom") or the name of a
/// sensor, with an optional ":component". Column names read "sensors/tip_deflection:y". Throws
/// InputError("cli.unknown-channel") with the nearest match.
std::vector<exports::CsvColumn> choose_columns(const hdf5::ResultsFile& results, const std::string& file,
                                               const std::string& choice);

}  // namespace bough::analysis
