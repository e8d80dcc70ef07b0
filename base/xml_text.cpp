#include "base/xml_text.hpp"

#include <string_view>

namespace bough {

namespace {

/// Bytes of the UTF-8 character that begins here; 0: none does.
std::size_t get_length(std::string_view text) {
  const auto at = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = at(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((at(i) & 0xC0) != 0x80) return 0;
  // Written longer than need be, halves of pairs, and past the last character; U+FFFE and U+FFFF.
  const unsigned second = at(1);
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0) || (first == 0xF0 && second < 0x90) ||
      (first == 0xF4 && second >= 0x90) || (first == 0xEF && second == 0xBF && at(2) >= 0xBE))
    return 0;
  return length;
}

}  // namespace

std::string escape_xml(const std::string& text) {
  std::string safe;
  for (std::size_t i = 0; i < text.size();) {
    const auto length = get_length(std::string_view(text).substr(i));
    const char c = text[i];
    if (length == 0)
      safe += "\xEF\xBF\xBD";
    else if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else if (length > 1 || static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n' || c == '\r')
      safe += c == '\x7F' ? "" : text.substr(i, length);
    i += length == 0 ? 1 : length;
  }
  return safe;
}

}  // namespace bough
