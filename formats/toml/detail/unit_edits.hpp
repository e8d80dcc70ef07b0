#pragma once
/// \file Numbers of a TOML text multiplied in place.
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "base/diagnostic.hpp"

namespace bough::toml_files {

/// Digits that read back as the number, as short as rounding of one unit in the last place allows.
std::string write_decimal(double value);

/// `factor` * formula, with time t and inputs u1, u2, ... in the old units: u_k stands for units[k - 1] of the new.
std::string rewrite_formula(const std::string& formula, double factor, double time, const std::vector<double>& units);

class UnitEdits {
 public:
  /// Starts without edits; `file` is the name in messages, and all arguments must outlive this.
  UnitEdits(const std::string& text, const std::string& file, Diagnostics& diagnostics);

  /// Multiplies a number, "$parameter" or every number of a list, rows too. A null node is nothing.
  void scale(const toml::node* node, double factor);
  /// A number or a list with an entry for each factor; one number that stands for all becomes a list where they differ.
  void scale(const toml::node* node, const std::vector<double>& factors);
  /// Replaces the text of a value.
  void replace(const toml::node& node, const std::string& value);
  /// Replaces the name of a key.
  void rename_key(const toml::key& key, const std::string& name);
  /// A key that the text does not have yet.
  void add(const std::string& path, const std::string& value);
  /// Reports an error at the line of the node.
  void error(const char* id, const toml::node& node, const std::string& what, const std::string& fix);

  /// The text with all of it. Parameters used with two factors: "toml.unit-parameter".
  std::string apply(const toml::table& root);
  /// Number of edits so far.
  int count() const { return static_cast<int>(edits_.size() + added_.size()); }

 private:
  struct Edit {
    std::size_t begin, end;
    std::string text;
  };
  void put(const toml::source_region& place, const std::string& text);

  const std::string& text_;
  const std::string& file_;
  Diagnostics& diagnostics_;
  std::vector<Edit> edits_;
  std::vector<std::pair<std::string, std::string>> added_;
  std::map<std::string, std::pair<double, int>> parameters_;  ///< factor and line of the first use
  std::set<std::string> in_two_;
};

}  // namespace bough::toml_files
