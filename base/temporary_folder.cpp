#include "base/temporary_folder.hpp"

#include <cstdlib>

#include <filesystem>

#include "base/diagnostic.hpp"

namespace bough {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& name, const std::string& purpose) {
  std::error_code failed;
  std::string path = (fs::temp_directory_path(failed) / (name + "-XXXXXX")).string();
  if (failed || ::mkdtemp(path.data()) == nullptr)
    throw ComputationError("cli.no-temporary-folder", {}, "no folder for " + purpose + " can be made in TMPDIR",
                           "choose a folder by TMPDIR that can be written");
  path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace bough
