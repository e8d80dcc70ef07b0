#pragma once
/// \file A system file with the bodies it names, ready to run; shared by check and run.
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace CLI {
class App;
}

namespace bough::cli {

struct LoadedSystem {
  records::SystemSpec spec;
  std::map<std::string, records::FlexBody> flex;  ///< by the file name as written in the system file
  std::map<std::string, std::string> flex_path;   ///< the same names with the path they were read from
  solver::System system;
  std::string start_from;  ///< results file with the initial state; empty: none
};

/// Every file that the run reads: the system file first, bodies, tables, the initial state.
std::vector<std::string> collect_sources(const std::string& path, const LoadedSystem& loaded);

/// Reads and builds; throws InputError with every error found, all that `run` would refuse among them. Body files are
/// relative to the system file's folder.
/// `set`: "name=value" of [parameters]. `start_from`: a results file whose last sample is the initial state
/// (start_state.hpp); empty: as the records say.
LoadedSystem load_system(const std::string& path, Diagnostics& diagnostics, const std::string& start_from = {},
                         const std::vector<std::string>& set = {});

struct LoadOptions {
  std::string start_from;
  std::vector<std::string> set;
  std::optional<std::string> text;                        ///< instead of the file's own; paths are relative to `path`
  std::map<std::string, records::FlexBody> flex;          ///< bodies that are here already, by the file they stand for
  std::function<void(records::SystemSpec&)> change_spec;  ///< called before anything is built from it
};
LoadedSystem load_system(const std::string& path, Diagnostics& diagnostics, LoadOptions options);

/// --set name=value, as often as wanted.
void add_set_option(CLI::App& verb, std::vector<std::string>& set);

/// path itself when absolute or when `from_file` is empty, else relative to the folder of from_file.
std::string resolve_beside(const std::string& from_file, const std::string& path);

}  // namespace bough::cli
