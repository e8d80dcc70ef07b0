#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/file_roles.hpp"
#include "base/input_bytes.hpp"
#include "formats/flx/detail/flx_reader.hpp"

namespace bough::flx {

std::vector<FlxFile> read_flx_bodies(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError("flx.cannot-read", {path}, "the file cannot be read", "check its path and permissions");
  note_input(path);
  std::vector<FlxFile> bodies;
  Diagnostics diagnostics;
  std::map<int, int> first_line;  // of each body id
  int number = 0;
  std::string line;
  while (std::getline(in, line)) {
    ++number;
    const auto words = detail::split_blanks(line);
    const bool is_remark = words.empty() || words[0][0] == '!';
    if (is_remark && !bodies.empty()) continue;
    if (!bodies.empty() && words[0] != "FLX")
      throw InputError("flx.bad-line", {path, number}, "the line after END begins no further body",
                       "begin it with FLX, or take it out");
    const int at = number;
    bodies.push_back(detail::FlxReader(path, in, number).read(words));
    const auto [found, is_new] = first_line.emplace(bodies.back().body_id, at);
    if (!is_new)
      diagnostics.error(
          "flx.same-body", {path, at},
          "body " + std::to_string(found->first) + " is in line " + std::to_string(found->second) + " already",
          "give each body of the file a different id");
  }
  if (bodies.empty()) detail::FlxReader(path, in, number = 1).read({});
  diagnostics.throw_if_errors();
  return bodies;
}

FlxFile read_flx(const std::string& path, int body_id) {
  auto bodies = read_flx_bodies(path);
  if (body_id == 0 && bodies.size() == 1) return std::move(bodies.front());
  std::string ids;
  for (auto& body : bodies) {
    if (body_id > 0 && body.body_id == body_id) return std::move(body);
    ids.append(" ").append(std::to_string(body.body_id));
  }
  if (body_id == 0)
    throw InputError("flx.which-body", {path}, "the file holds the bodies" + ids + ", found no choice",
                     "name one of them after a colon, as in " + std::filesystem::path(path).filename().string() + ":" +
                         ids.substr(1, ids.find(' ', 1) - 1));
  throw InputError("flx.no-body", {path}, "the file has no body " + std::to_string(body_id) + ", it holds" + ids,
                   "correct the number after the colon");
}

std::optional<FlxName> parse_flx_name(const std::string& name) {
  FlxName parsed{name, 0};
  if (const auto colon = name.rfind(':'); colon != std::string::npos) {
    const char *first = name.data() + colon + 1, *last = name.data() + name.size();
    const auto [end, error] = std::from_chars(first, last, parsed.body_id);
    if (error == std::errc{} && end == last && first != last && parsed.body_id > 0)
      parsed.path.erase(colon);
    else
      parsed.body_id = 0;
  }
  const auto head = read_input_head(parsed.path, 8);
  const auto words = detail::split_blanks(head);
  if (!words.empty() && words[0] == "FLX") return parsed;
  if (head.starts_with("\x89HDF")) return std::nullopt;
  std::string ending = parsed.path.size() > 4 ? parsed.path.substr(parsed.path.size() - 4) : "";
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending != ".flx") return std::nullopt;
  return parsed;
}

}  // namespace bough::flx
