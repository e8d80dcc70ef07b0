#pragma once
/// \file A parsed TOML document as a plain tree that remembers lines, so that only value.cpp sees the parser.
#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::toml_files {

struct Entry;

struct Value {
  enum class Kind { String, Integer, Float, Boolean, DateTime, Array, Table };
  Kind kind = Kind::Table;
  std::string text;            ///< String
  std::int64_t integer = 0;    ///< Integer
  double number = 0;           ///< Integer and Float
  bool boolean = false;        ///< Boolean
  std::vector<Value> items;    ///< Array
  std::vector<Entry> entries;  ///< Table, in the order of the file
  int line = 0;

  /// Returns true for an integer or a real.
  bool is_number() const { return kind == Kind::Integer || kind == Kind::Float; }
  /// Returns true for a text.
  bool is_string() const { return kind == Kind::String; }
  /// Returns true for a list, of tables too.
  bool is_array() const { return kind == Kind::Array; }
  /// Returns true for a table.
  bool is_table() const { return kind == Kind::Table; }
  /// The value at a key of a table; nullptr when absent or when this is no table.
  const Value* find(const std::string& key) const;
};

struct Entry {
  std::string key;
  int line = 0;  ///< of the key
  Value value;
};

/// "a string", "an integer", ...: for messages.
const char* describe_kind(Value::Kind kind);

/// A file's bytes. Reports "toml.cannot-open" and returns false when it cannot be read.
bool read_text(const std::string& path, std::string& text, Diagnostics& diagnostics);

/// Parses TOML 1.0 text. Reports "toml.syntax" with line and column and returns false; `file` only names the source.
bool parse_toml(const std::string& text, const std::string& file, Value& root, Diagnostics& diagnostics);

}  // namespace bough::toml_files
