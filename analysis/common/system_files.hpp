#pragma once
/// \file A system file with the bodies it names, ready to run; shared by check and run.
#include <string>
#include <vector>

#include "embed/load.hpp"

namespace bough::analysis {

using embed::LoadedSystem;

/// Every file that the run reads: the system file first, bodies, tables, the initial state.
std::vector<std::string> collect_sources(const std::string& path, const LoadedSystem& loaded);

/// Reads and builds; throws InputError with every error found, all that `run` would refuse among them. Body files are
/// relative to the system file's folder.
/// `set`: "name=value" of [parameters]. `start_from`: a results file whose last sample is the initial state
/// (start_state.hpp); empty: as the records say.
LoadedSystem load_system(const std::string& path, Diagnostics& diagnostics, const std::string& start_from = {},
                         const std::vector<std::string>& set = {});

struct LoadOptions : embed::LoadOptions {
  std::string start_from;
};
/// Loads a system file or `options.text`, its bodies, tables, controllers and FMUs; the initial state is that of
/// `start_from`, unless it is empty. Throws InputError with the errors of all files.
LoadedSystem load_system(const std::string& path, Diagnostics& diagnostics, LoadOptions options);

/// path itself when absolute or when `from_file` is empty, else relative to the folder of from_file.
std::string resolve_beside(const std::string& from_file, const std::string& path);

}  // namespace bough::analysis
