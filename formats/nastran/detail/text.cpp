#include "formats/nastran/detail/text.hpp"

#include <cctype>
#include <charconv>

namespace bough::nastran::detail {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
char get_upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

}  // namespace

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string make_upper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = get_upper(c);
  return upper;
}

bool is_word(std::string_view text, std::string_view upper_case_word) {
  if (text.size() != upper_case_word.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (get_upper(text[i]) != upper_case_word[i]) return false;
  return true;
}

std::string_view find_first_word(std::string_view text) {
  text = trim(text);
  std::size_t n = 0;
  while (n < text.size() && std::isalnum(static_cast<unsigned char>(text[n]))) ++n;
  return text.substr(0, n);
}

std::optional<int> parse_int(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (text.empty() || !is_digit(text.front())) return std::nullopt;
  }
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::optional<unsigned> parse_components(std::string_view text) {
  if (text.empty()) return std::nullopt;
  unsigned mask = 0;
  for (const char c : text) {
    if (c < '0' || c > '6') return std::nullopt;
    if (c == '0' && text.size() > 1) return std::nullopt;
    if (c != '0') mask |= 1u << (c - '1');
  }
  return mask;
}

}  // namespace bough::nastran::detail
