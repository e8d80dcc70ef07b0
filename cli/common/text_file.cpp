#include "cli/common/text_file.hpp"

#include "base/diagnostic.hpp"
#include "base/part_file.hpp"

namespace bough::cli {

void write_text_file(const std::string& path, const std::string& text) {
  PartFile part(path);
  if (part.write(text.data(), text.size()) && part.commit(false)) return;
  throw ComputationError("cli.write", {path}, "the file could not be written: " + part.error().message(),
                         "check the folder, its permissions and the space left");
}

}  // namespace bough::cli
