#include "analysis/common/text_file.hpp"

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "base/diagnostic.hpp"
#include "base/part_file.hpp"

namespace bough::analysis {

void write_text_file(const std::string& path, const std::string& text) {
  PartFile part(path);
  if (part.write(text.data(), text.size()) && part.commit()) return;
  throw ComputationError("cli.write", {path}, "the file could not be written: " + part.error().message(),
                         "check the folder, its permissions and the space left");
}

void write_whole(const std::string& path, const std::function<void(const std::string& part)>& write) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const auto target = find_target(path, failed);
  const auto part = target + ".bough-part-" + std::to_string(::getpid());
  try {
    write(part);
    if (const auto old = fs::status(target, failed); fs::is_regular_file(old))
      fs::permissions(part, old.permissions(), failed);
    fs::rename(part, target, failed);
    if (failed)
      throw ComputationError("cli.write", {path}, "the file could not be written: " + failed.message(),
                             "check the folder, its permissions and the space left");
  } catch (const ComputationError& failure) {
    fs::remove(part, failed);
    auto items = failure.items();
    for (auto& item : items)
      if (item.where.file == part) item.where.file = path;
    throw ComputationError(items);
  } catch (...) {
    fs::remove(part, failed);
    throw;
  }
}

}  // namespace bough::analysis
