#pragma once
/// \file From a system file and the files that it names to a System that is ready to move: the one road for the
/// program, the Python module and hosts.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/control/hosted.hpp"
#include "solver/system/system.hpp"

namespace bough::embed {

struct LoadedSystem {
  records::SystemSpec spec;
  std::map<std::string, records::FlexBody> flex;  ///< by the file name as written in the system file
  std::map<std::string, std::string> flex_path;   ///< the same names with the path they were read from
  solver::System system;
  std::vector<std::unique_ptr<solver::HostedController>> lent;  ///< of controllers of type "fmu"
  std::string start_from;                                       ///< results file with the initial state; empty: none
};

/// Mass centre and inertia, which a .FLX without the extension of version 1.1 leaves to the system.
struct RigidPart {
  records::Vector3d cg;       ///< in B
  records::Matrix3d inertia;  ///< about the centre of mass, in B
};

/// Gives a body of a file the rigid part that the file lacks. Throws InputError "flx.no-inertia" where neither the file
/// nor `given` has it, "flx.two-inertias" where both have.
void give_rigid_part(records::FlexBody& body, bool has_rigid, const std::optional<RigidPart>& given,
                     const std::string& path);

/// Readers of files whose formats not every program is linked with.
struct FileReaders {
  /// A body that moves; `name` may end in the id of a body of a .FLX.
  std::function<records::FlexBody(const std::string& name, Diagnostics& diagnostics,
                                  const std::optional<RigidPart>& given)>
      body;
  /// Matrices of controllers and points of tables out of the files that they name.
  std::function<void(records::SystemSpec& spec, Diagnostics& diagnostics)> matrices;
  /// Advice of the message about a body file that is missing.
  std::function<std::string(const std::string& path)> advise_body;
  /// A controller of type "fmu"; may complete the record.
  std::function<solver::ControllerFunctions(records::ControllerRecord& record)> fmu;
};

struct LoadOptions {
  std::vector<std::string> set;                           ///< "name=value" of [parameters]
  std::optional<std::string> text;                        ///< instead of the file's own; paths are relative to `path`
  std::map<std::string, records::FlexBody> flex;          ///< bodies that are here already, by the file they stand for
  std::function<void(records::SystemSpec&)> change_spec;  ///< called before anything is built from it
  /// Called when all files are read; may change initial values.
  std::function<void(records::SystemSpec&, Diagnostics&)> set_start;
};

/// Reads and builds; throws InputError with every error found, all that a run would refuse among them. Body files are
/// relative to the folder of `path`.
LoadedSystem load_system(const std::string& path, const FileReaders& readers, LoadOptions options,
                         Diagnostics& diagnostics);

/// The file alone, without the id of a body of a .FLX.
std::string get_body_path(const std::string& name);
/// path itself when absolute or when `from_file` is empty, else relative to the folder of from_file.
std::string resolve_beside(const std::string& from_file, const std::string& path);
/// Path relative to the working directory, unless that leads out of it.
std::string shorten_path(const std::string& path);

}  // namespace bough::embed
