#pragma once
/// \file Reading typed fields from a table. Types were checked against the schema before, and reported there: a field
/// that is absent or of another type gives the default here, without a second message.
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "formats/toml/detail/value.hpp"

namespace bough::toml_files {

/// A table with the file it came from.
class Fields {
 public:
  Fields(const Value& table, const std::string& file) : table_(table), file_(file) {}

  /// Returns true if the table has the key, whatever its type.
  bool has(const std::string& key) const { return table_.find(key) != nullptr; }
  /// Returns the value of a key; nullptr if it is absent.
  const Value* find(const std::string& key) const { return table_.find(key); }
  /// In the order of the file.
  std::vector<std::string> get_keys() const {
    std::vector<std::string> keys;
    for (const auto& entry : table_.entries) keys.push_back(entry.key);
    return keys;
  }
  /// All keys and values, in the order of the file.
  const std::vector<Entry>& entries() const { return table_.entries; }
  /// Location of the head of the table.
  SourceLocation locate() const { return {file_, table_.line}; }
  /// Location of the key; of the table if the key is absent.
  SourceLocation locate(const std::string& key) const;

  /// Text of a key.
  std::string get_string(const std::string& key, const std::string& otherwise = {}) const;
  /// Integer of a key.
  int get_int(const std::string& key, int otherwise) const;
  /// Number of a key, integer or real.
  double get_number(const std::string& key, double otherwise) const;
  /// Number of a key; none if it is absent.
  std::optional<double> get_number(const std::string& key) const;
  /// Boolean of a key.
  bool get_bool(const std::string& key, bool otherwise) const;
  /// List of three numbers; `otherwise` for a list of another length.
  Eigen::Vector3d get_vector(const std::string& key, const Eigen::Vector3d& otherwise) const;
  /// Returns the rows of three numbers of a list of lists; the schema reports others.
  std::vector<Eigen::Vector3d> get_vectors(const std::string& key) const;
  /// One number or a list of them; empty when absent.
  std::vector<double> get_numbers(const std::string& key) const;
  std::vector<int> get_ints(const std::string& key) const;
  /// One string or a list of them; empty when absent.
  std::vector<std::string> get_strings(const std::string& key) const;
  /// The tables of an array of tables.
  std::vector<Fields> get_tables(const std::string& key) const;
  /// A sub-table; an empty one when absent.
  Fields get_table(const std::string& key) const;

 private:
  const Value& table_;
  const std::string& file_;
};

/// Warns "toml.large-angle" of an angle in radians above one turn: a number meant in degrees.
void check_radians(const Fields& table, const std::string& key, const std::vector<double>& angles,
                   Diagnostics& diagnostics);

/// R = Rx(a) Ry(b) Rz(c) of `key` (rad) or key_deg; the identity without both.
Eigen::Matrix3d read_rotation(const Fields& table, const std::string& key, Diagnostics& diagnostics);

/// Reports "toml.conflicting-keys" for each key of the list that stands where it has no meaning.
void refuse_keys(const Fields& table, std::initializer_list<const char*> keys, const std::string& because,
                 Diagnostics& diagnostics);

/// `path` of a file named in `file`, absolute and normalised: names in a file are relative to its folder.
std::string resolve_path(const std::string& file, const std::string& path);

/// File name without folder and extension.
std::string get_stem(const std::string& file);

}  // namespace bough::toml_files
