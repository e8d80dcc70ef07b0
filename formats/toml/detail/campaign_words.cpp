#include "formats/toml/detail/campaign_words.hpp"

#include <charconv>
#include <cmath>

#include "base/platform.hpp"
#include "formats/toml/detail/source_text.hpp"

namespace bough::toml_files {

using Kind = Setting::Kind;

std::string trim(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> split_cells(const std::string& line) {
  auto cells = split_unquoted(line, ',');
  for (auto& cell : cells) cell = trim(cell);
  return cells;
}

Setting read_cell(const std::string& cell) {
  const char *first = cell.data() + (cell.size() > 1 && cell[0] == '+' ? 1 : 0), *last = cell.data() + cell.size();
  long long integer = 0;
  if (const auto r = platform::read_number(first, last, integer); r.ec == std::errc() && r.ptr == last)
    return make_setting(static_cast<double>(integer), true);
  double real = 0;
  if (const auto r = platform::read_number(first, last, real);
      r.ec == std::errc() && r.ptr == last && std::isfinite(real))
    return make_setting(real, false);
  if (cell == "true" || cell == "false") return {Kind::Boolean, cell, cell == "true" ? 1.0 : 0.0};
  return {Kind::Word, cell, 0};
}

std::vector<std::string> split_words(const std::string& text) {
  std::vector<std::string> words;
  char quote = 0;
  bool open = false;
  for (const char c : text) {
    if (quote != 0 ? c == quote : c == '\'' || c == '"') {
      quote = quote != 0 ? '\0' : c;
      if (!open) words.emplace_back();
      open = true;
    } else if (quote == 0 && (c == ' ' || c == '\t' || c == '\n')) {
      open = false;
    } else {
      if (!open) words.emplace_back();
      open = true;
      words.back() += c;
    }
  }
  return words;
}

Setting make_setting(double value, bool is_integer) {
  char buffer[40];
  if (is_integer) return {Kind::Integer, std::to_string(static_cast<long long>(std::llround(value))), value};
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return {Kind::Real, text, value};
}

}  // namespace bough::toml_files
