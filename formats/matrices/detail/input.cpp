#include "formats/matrices/detail/input.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/file_roles.hpp"
#include "base/platform.hpp"

namespace bough::matrices::detail {

std::string read_bytes(const std::string& path, std::size_t max_bytes) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file)
    throw InputError("matrices.cannot-open", {path}, "the file cannot be opened", "check its path and permissions");
  note_input(path);
  std::string bytes(std::min<std::uintmax_t>(size, max_bytes), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<long> parse_integer(std::string_view text) {
  text = trim(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  long value = 0;
  const auto result = platform::read_number(text.data(), text.data() + text.size(), value);
  if (text.empty() || result.ec != std::errc{} || result.ptr != text.data() + text.size()) return {};
  return value;
}

std::optional<double> parse_real(std::string_view text) {
  text = trim(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  if (text.empty() || text.size() > 60) return {};
  std::string plain(text);
  const auto letter = plain.find_first_of("dDqQ");
  if (letter != std::string::npos) {
    plain[letter] = 'e';
  } else if (plain.find_first_of("eE") == std::string::npos) {
    const auto sign = plain.find_first_of("+-", 1);
    if (sign != std::string::npos) plain.insert(sign, 1, 'e');
  }
  double value = 0;
  const auto result = platform::read_number(plain.data(), plain.data() + plain.size(), value);
  const bool is_small = result.ec == std::errc::result_out_of_range && plain.find("e-") != std::string::npos;
  if (is_small && result.ptr == plain.data() + plain.size()) return 0.0;
  if (result.ec != std::errc{} || result.ptr != plain.data() + plain.size() || !std::isfinite(value)) return {};
  return value;
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> words;
  const auto is_gap = [separator](char c) { return c == ' ' || c == '\t' || c == '\r' || c == separator; };
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && is_gap(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !is_gap(line[i])) ++i;
    if (i > begin) words.push_back(line.substr(begin, i - begin));
  }
  return words;
}

bool equals_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (lower(a[i]) != lower(b[i])) return false;
  return true;
}

std::optional<NumberFormat> parse_number_format(std::string_view whole) {
  std::string text;
  for (const char c : whole)
    if (c != ' ' && c != '(' && c != ')' && c != ',') text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  if (const auto scale = text.find('P'); scale != std::string::npos) text.erase(0, scale + 1);
  const auto letter = text.find_first_of("EDGFI");
  if (letter == std::string::npos) return {};
  const auto end = std::min(text.find('.'), text.size());
  const auto per_line = letter == 0 ? std::optional<long>(1) : parse_integer(text.substr(0, letter));
  const auto width = end > letter ? parse_integer(text.substr(letter + 1, end - letter - 1)) : std::nullopt;
  if (!per_line || !width || *per_line < 1 || *per_line > 1000 || *width < 1 || *width > 60) return {};
  return NumberFormat{static_cast<std::size_t>(*per_line), static_cast<std::size_t>(*width)};
}

std::string quote(std::string_view text) {
  text = trim(text);
  std::string shown = "'";
  for (const char c : text.substr(0, 40)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (text.size() > 40 ? "...'" : "'");
}

bool TextInput::next_line() {
  if (is_unread_) {
    is_unread_ = false;
    return true;
  }
  if (next_ >= bytes_.size()) return false;
  const auto end = std::min(bytes_.find('\n', next_), bytes_.size());
  line_ = std::string_view(bytes_).substr(next_, end - next_);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  next_ = end + 1;
  ++number_;
  return true;
}

void TextInput::demand_line(const char* expected) {
  if (!next_line())
    fail("matrices.truncated", std::string("the file ends here, expected ") + expected, "copy or write the file again");
}

void TextInput::fail(const char* id, const std::string& what, const std::string& advice) const {
  throw InputError(id, {path_, number_}, what, advice);
}

void TextInput::fail_line(const std::string& expected) const {
  fail("matrices.bad-number", "found " + quote(line_) + ", expected " + expected, "write the file again");
}

}  // namespace bough::matrices::detail
