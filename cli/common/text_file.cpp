#include "cli/common/text_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "base/diagnostic.hpp"

namespace bough::cli {

void write_text_file(const std::string& path, const std::string& text) {
  const std::string beside = path + ".part" + std::to_string(getpid());
  std::error_code failed;
  {
    errno = 0;
    std::ofstream out(beside, std::ios::binary);
    out << text;
    out.flush();
    // The stream keeps no reason; errno does, where the system gave one.
    if (!out) failed = std::error_code(errno != 0 ? errno : EIO, std::generic_category());
  }
  if (!failed) std::filesystem::rename(beside, path, failed);
  if (failed) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw ComputationError("cli.write", {path}, "the file could not be written: " + failed.message(),
                           "check the folder, its permissions and the space left");
  }
}

}  // namespace bough::cli
