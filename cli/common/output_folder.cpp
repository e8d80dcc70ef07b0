#include "cli/common/output_folder.hpp"

#include <filesystem>

#include "base/diagnostic.hpp"

namespace bough::cli {

void make_output_folder(const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw ComputationError("cli.write", {folder}, "the folder could not be made: " + failed.message(),
                           "choose another with -o");
}

}  // namespace bough::cli
