#pragma once
/// \file Files that the studio serves, compiled in (web/web_files.cmake).
#include <string>
#include <string_view>
#include <vector>

namespace bough::cli {

struct WebFile {
  std::string_view name, text;
};
const std::vector<WebFile>& get_web_files();

}  // namespace bough::cli
