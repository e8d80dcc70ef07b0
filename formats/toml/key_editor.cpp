#include "formats/toml/key_editor.hpp"

#include <algorithm>
#include <vector>

#include <toml++/toml.h>

#include "base/quoted_text.hpp"
#include "formats/toml/detail/parameters.hpp"
#include "formats/toml/detail/schema.hpp"
#include "formats/toml/detail/source_text.hpp"

namespace bough::toml_files {

namespace {

/// Inserts a new key into the text of a table, with the necessary line breaks or commas.
std::string add_key(std::string& text, const toml::table& table, bool is_root, const std::string& line) {
  if (is_root) {
    text.insert(0, line + "\n");
    return {};
  }
  auto at = find_byte(text, table.source().begin);
  if (at >= text.size()) return "the table cannot be found in the text";
  if (table.is_inline()) {
    const auto open = text.find('{', at);
    text.insert(open + 1, table.empty() ? " " + line + " " : " " + line + ",");
    return {};
  }
  if (text[at] != '[') return "its table is made by dotted keys; give the table a separate heading";
  const auto end = text.find('\n', at);
  if (end == std::string::npos)
    text += "\n" + line + "\n";
  else
    text.insert(end + 1, line + "\n");
  return {};
}

struct Place {
  std::size_t begin, end;
  std::string old;
};

void collect_files(const std::string& text, const toml::table& table, const std::string& path,
                   std::vector<Place>& places) {
  for (const auto& [key, node] : table) {
    const std::string below = path + "." + std::string(key.str());
    if (const auto* word = node.as_string(); word && (key.str() == "deck" || key.str() == "file")) {
      if (path != ".body.output")
        places.push_back({find_byte(text, node.source().begin), find_byte(text, node.source().end), word->get()});
    } else if (const auto* child = node.as_table()) {
      collect_files(text, *child, below, places);
    } else if (const auto* list = node.as_array()) {
      for (const auto& item : *list)
        if (const auto* entry = item.as_table()) collect_files(text, *entry, below, places);
    }
  }
}

}  // namespace

std::string quote_text(const std::string& text) { return quote_with('"', text); }

void check_text(const std::string& text, const std::string& file, Diagnostics& diagnostics) {
  Value root;
  if (!parse_toml(text, file, root, diagnostics)) return;
  const Value* body = root.find("body");
  const bool is_body_file = body && body->is_table();
  Diagnostics of_parameters;
  if (!is_body_file) insert_parameters(root, file, of_parameters);
  for (const auto& item : of_parameters.items())
    if (item.severity == Severity::Error) diagnostics.add(item);
  check_schema(root, is_body_file ? get_body_schema() : get_system_schema(), file, diagnostics);
}

std::string set_key(std::string& text, const std::string& path, const std::string& value) {
  const auto parts = split_path(path);
  toml::table root;
  try {
    root = toml::parse(std::string_view(text));
  } catch (const toml::parse_error& error) {
    return std::string(error.description());
  }
  toml::node* node = &root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    toml::node* next = nullptr;
    if (auto* table = node->as_table()) {
      next = table->get(parts[i]);
      if (next == nullptr) {
        std::string line;
        for (std::size_t k = i; k < parts.size(); ++k) line += (k == i ? "" : ".") + quote_key(parts[k]);
        return add_key(text, *table, node == &root, line + " = " + value);
      }
    } else if (auto* list = node->as_array()) {
      next = find_item(*list, parts[i]);
      if (next == nullptr) return "'" + parts[i] + "' is neither a number nor a name of the list before it";
    } else {
      return "'" + parts[i] + "' stands below a single value";
    }
    node = next;
  }
  if (node->is_table() || node->is_array_of_tables()) return "it is a table, not a value";
  const auto begin = find_byte(text, node->source().begin), end = find_byte(text, node->source().end);
  text.replace(begin, end - begin, value);
  return {};
}

void change_file_keys(std::string& text, const std::function<std::string(const std::string&)>& change) {
  std::vector<Place> places;
  try {
    collect_files(text, toml::parse(std::string_view(text)), {}, places);
  } catch (const toml::parse_error&) {
    return;  // reported when the file is read
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.begin > b.begin; });
  for (const auto& place : places)
    if (const auto changed = change(place.old); changed != place.old)
      text.replace(place.begin, place.end - place.begin, quote_text(changed));
}

}  // namespace bough::toml_files
