#include "cli/init/schema_line.hpp"

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "base/platform.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

/// The installed schemas: next to the program in share/bough, else under XDG_DATA_DIRS. Empty: not installed. Sources
/// and build folders do not count: they move and vanish, and the line would stay.
fs::path find_schemas() {
  std::error_code failed;
  const auto program = platform::find_executable(failed).parent_path();
  std::vector<fs::path> places{program / "../share"};
  const char* const given = std::getenv("XDG_DATA_DIRS");
  std::istringstream list(given != nullptr && *given != '\0' ? given : "/usr/local/share:/usr/share");
  for (std::string place; std::getline(list, place, ':');)
    if (fs::path(place).is_absolute()) places.emplace_back(place);
  for (const auto& place : places) {
    const auto found = (place / "bough/schema").lexically_normal();
    if (fs::is_directory(found, failed)) return found;
  }
  return {};
}

/// The URI of a path: letters, digits and what needs no escape.
std::string make_uri(const std::string& path) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : path) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalnum(code) != 0 || std::string_view("/-._~").find(c) != std::string_view::npos)
      uri += c;
    else
      uri += {'%', kDigits[code >> 4], kDigits[code & 15]};
  }
  return uri;
}

}  // namespace

void add_schema_line(analysis::StartFile& file) {
  if (!file.name.ends_with(".toml")) return;
  const auto folder = find_schemas();
  if (folder.empty()) return;
  const auto has = [&](const std::string& table) {
    return file.text.starts_with(table) || file.text.find("\n" + table) != std::string::npos;
  };
  const std::string kind = has("[campaign]") ? "campaign" : has("[body]") ? "body" : "system";
  file.text = "#:schema " + make_uri((folder / (kind + ".schema.json")).string()) + "\n" + file.text;
}

}  // namespace bough::cli
