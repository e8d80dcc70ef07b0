#pragma once
/// \file Places of a parsed TOML document in the bytes of its text.
#include <string>
#include <vector>

#include <toml++/toml.h>

namespace bough::toml_files {

/// Parts between separators outside of quotes, which are left out.
std::vector<std::string> split_unquoted(const std::string& text, char separator);
/// "a.\"b.c\".2" -> a, b.c, 2
std::vector<std::string> split_path(const std::string& path);
/// A key as TOML writes it: bare, or in quotes.
std::string quote_key(const std::string& key);
/// Byte of a place; the parser counts characters, not bytes, in a line.
std::size_t find_byte(const std::string& text, const toml::source_position& at);
/// The entry of a list by its number from 1, or by its `name`; nullptr when there is none.
toml::node* find_item(toml::array& list, const std::string& part);

}  // namespace bough::toml_files
