#pragma once
/// \file Files that the studio serves, compiled in (web/web_files.cmake).
#include <string>
#include <string_view>
#include <vector>

namespace bough::cli {

struct WebFile {
  std::string_view name, text;
};
/// Returns all files that the studio serves.
const std::vector<WebFile>& get_web_files();

}  // namespace bough::cli
