#include "formats/toml/detail/value.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <toml++/toml.h>

#include "base/file_roles.hpp"

namespace bough::toml_files {

namespace {

Value convert(const toml::node& node) {
  Value v;
  v.line = static_cast<int>(node.source().begin.line);
  const auto set = [&](Value::Kind kind, auto& member, const auto& value) {
    v.kind = kind;
    member = value.get();
  };
  if (const auto* table = node.as_table()) {
    v.kind = Value::Kind::Table;
    for (const auto& [key, child] : *table) {
      v.entries.push_back({std::string(key.str()), static_cast<int>(key.source().begin.line), convert(child)});
    }
    // The parser sorts by key; messages should come in the order of the file.
    std::stable_sort(v.entries.begin(), v.entries.end(),
                     [](const Entry& a, const Entry& b) { return a.line < b.line; });
  } else if (const auto* array = node.as_array()) {
    v.kind = Value::Kind::Array;
    for (const auto& child : *array) v.items.push_back(convert(child));
  } else if (const auto* text = node.as_string()) {
    set(Value::Kind::String, v.text, *text);
  } else if (const auto* integer = node.as_integer()) {
    set(Value::Kind::Integer, v.integer, *integer);
    v.number = static_cast<double>(v.integer);
  } else if (const auto* number = node.as_floating_point()) {
    set(Value::Kind::Float, v.number, *number);
  } else if (const auto* boolean = node.as_boolean()) {
    set(Value::Kind::Boolean, v.boolean, *boolean);
  } else {
    v.kind = Value::Kind::DateTime;
  }
  return v;
}

std::string to_message(std::string_view text) {
  std::string s(text);
  if (!s.empty() && s.back() == '.') s.pop_back();
  if (s.size() > 1 && std::isupper(static_cast<unsigned char>(s[0])) &&
      std::islower(static_cast<unsigned char>(s[1]))) {
    s[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(s[0])));
  }
  return s;
}

}  // namespace

const Value* Value::find(const std::string& key) const {
  const auto it = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
  return it == entries.end() ? nullptr : &it->value;
}

const char* describe_kind(Value::Kind kind) {
  // In the order of Value::Kind.
  constexpr std::array kWords{"a string",       "an integer", "a number", "true or false",
                              "a date or time", "an array",   "a table"};
  return kWords[static_cast<std::size_t>(kind)];
}

bool read_text(const std::string& path, std::string& text, Diagnostics& diagnostics) {
  std::error_code error;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, error)) in.open(path, std::ios::binary);
  if (!in.is_open()) {
    diagnostics.error("toml.cannot-open", {path}, "the file cannot be opened", "check its path and permissions");
    return false;
  }
  note_input(path);
  std::ostringstream buffer;
  buffer << in.rdbuf();
  text = buffer.str();
  return true;
}

bool parse_toml(const std::string& text, const std::string& file, Value& root, Diagnostics& diagnostics) {
  try {
    const toml::table table = toml::parse(std::string_view(text));
    root = convert(table);
    return true;
  } catch (const toml::parse_error& e) {
    diagnostics.error("toml.syntax",
                      {file, static_cast<int>(e.source().begin.line), static_cast<int>(e.source().begin.column)},
                      "the text is not TOML here: " + to_message(e.description()), "correct the line");
    return false;
  }
}

}  // namespace bough::toml_files
