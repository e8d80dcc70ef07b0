#include "formats/toml/detail/source_text.hpp"

#include <algorithm>
#include <cctype>

#include "formats/toml/key_editor.hpp"

namespace bough::toml_files {

namespace {

bool is_number(const std::string& s) {
  return !s.empty() && s.size() < 7 && std::all_of(s.begin(), s.end(), [](unsigned char c) { return std::isdigit(c); });
}

}  // namespace

std::vector<std::string> split_unquoted(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  bool quoted = false;
  for (const char c : text) {
    if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

// "a.\"b.c\".2" -> a, b.c, 2
std::vector<std::string> split_path(const std::string& path) { return split_unquoted(path, '.'); }

std::string quote_key(const std::string& key) {
  const bool is_bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-';
  });
  return is_bare ? key : quote_text(key);
}

std::size_t find_byte(const std::string& text, const toml::source_position& at) {
  std::size_t byte = 0;
  for (toml::source_index line = 1; line < at.line; ++line) byte = text.find('\n', byte) + 1;
  for (toml::source_index column = 1; column < at.column && byte < text.size(); ++column) {
    ++byte;
    while (byte < text.size() && (static_cast<unsigned char>(text[byte]) & 0xC0) == 0x80) ++byte;
  }
  return byte;
}

toml::node* find_item(toml::array& list, const std::string& part) {
  if (is_number(part)) {
    const auto i = static_cast<std::size_t>(std::stoul(part));
    return i >= 1 && i <= list.size() ? list.get(i - 1) : nullptr;
  }
  for (auto& item : list)
    if (auto* table = item.as_table())
      if (const auto name = (*table)["name"].value<std::string>(); name && *name == part) return &item;
  return nullptr;
}

}  // namespace bough::toml_files
