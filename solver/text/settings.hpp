#pragma once
/// \file Reads the keys of a controller or an actuator by name and reports what is missing, unknown or of a wrong size.
#include <initializer_list>
#include <set>
#include <string>

#include "formats/records/control_spec.hpp"

namespace bough::solver {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Word of a controller's settings that a loader adds: the name under which it lends functions. No key of system files.
inline constexpr const char* kLentKey = "lent";

class SettingsReader {
 public:
  /// what: "controller 'pid' of type pid".
  SettingsReader(const records::Settings& settings, std::string what, const SourceLocation& at,
                 Diagnostics& diagnostics)
      : settings_(settings), what_(std::move(what)), at_(at), diagnostics_(diagnostics) {}

  /// Returns true if the table has the key, whatever its type.
  bool has(const std::string& key) const { return settings_.has(key); }
  /// Returns true if the key has a number or a list of numbers.
  bool has_number(const std::string& key) const { return settings_.numbers.count(key) > 0; }
  /// Returns true if the key has a list of rows.
  bool has_matrix(const std::string& key) const { return settings_.matrices.count(key) > 0; }
  /// "control.missing-key" without it.
  double get(const std::string& key);
  /// Number of a key; `otherwise` if it is absent.
  double get(const std::string& key, double otherwise);
  /// Number above 0. Reports "control.missing-key" or "control.bad-value".
  double get_positive(const std::string& key);
  /// Not negative.
  double get_size(const std::string& key, double otherwise);
  /// Any length; "control.missing-key" when absent.
  std::vector<double> get_list(const std::string& key);
  /// One number stands for all; "control.bad-size".
  VectorXd get_vector(const std::string& key, int size, double otherwise);
  /// Vector of a required key; reports "control.missing-key" without it.
  VectorXd get_vector(const std::string& key, int size);
  /// -1: any count. A list is a row where `rows` is 1, or open and `columns` not 1; else a column. Absent: 0 x 0.
  MatrixXd get_matrix(const std::string& key, int rows, int columns);
  /// First text of a key; `otherwise` if it is absent.
  std::string get_word(const std::string& key, const std::string& otherwise);
  /// Texts of a key; empty if it is absent.
  std::vector<std::string> get_words(const std::string& key);
  /// Keys that belong to the loader of the system file.
  void accept(std::initializer_list<const char*> keys) { known_.insert(keys.begin(), keys.end()); }
  /// Name under which the loader lends functions; no key of the system file. Empty: none.
  std::string get_lent() const;
  /// Reports "control.bad-value" unless the condition holds.
  void demand(bool condition, const std::string& what, const std::string& advice);
  /// Reports an error of the owner; `what` follows its name.
  void error(const char* id, const std::string& what, const std::string& advice);
  /// "control.unknown-key" for keys that were not read.
  void refuse_others();
  /// Returns true after an error.
  bool has_failed() const { return has_failed_; }
  /// The owner, "controller 'pid' of type pid".
  const std::string& get_owner() const { return what_; }
  /// Location of its table.
  const SourceLocation& get_place() const { return at_; }

 private:
  const records::Settings& settings_;
  std::string what_;
  SourceLocation at_;
  Diagnostics& diagnostics_;
  std::set<std::string> known_;
  bool has_failed_ = false;
};

}  // namespace bough::solver
