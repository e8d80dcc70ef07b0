#pragma once
/// \file The tables of a system file, each key with its dimension.
#include "formats/toml/detail/signal_units.hpp"
#include "formats/toml/detail/unit_edits.hpp"

namespace bough::toml_files {

/// One entry of a list of tables, its place "hinge.2" and what is changed in it.
struct UnitTable {
  const toml::table& table;
  std::string path;
  UnitEdits& edits;
  bool to_radians = false;

  /// Returns the node of a key; null if it is absent.
  const toml::node* get(const char* key) const { return table.get(key); }
  /// Returns the text of a key; empty if it is absent.
  std::string text(const char* key) const { return get_text(table, key); }
  /// Multiplies the numbers at a key; an absent key is no error.
  void scale(const char* key, double factor) const { edits.scale(table.get(key), factor); }
  /// Multiplies each number of a list by a separate factor.
  void scale(const char* key, const std::vector<double>& factors) const { edits.scale(table.get(key), factors); }
  /// `key` and key_deg, whose angles may become radians: `is_angle` of each number.
  void scale_angles(const std::string& key, std::vector<double> factors, const std::vector<bool>& is_angle) const;
  /// Scales keys whose numbers are all angles.
  void scale_angles(const std::string& key, double factor = 1) const { scale_angles(key, {factor}, {true}); }
  /// Multiplies the key, which is 1 where it is absent.
  void scale_or_add(const char* key, double factor) const;
  /// "toml.unit-signal" or another id at a key, or at the table.
  void error(const char* id, const char* key, const std::string& what, const std::string& fix) const;
};

/// Converts the keys of a controller by its type. Reports toml.unit-signal and toml.unit-file.
void change_controller(const UnitTable& t, SignalUnits& units);
/// Converts limits, lags and physical properties of an actuator. Reports toml.unit-signal for commands of two units.
void change_actuator(const UnitTable& t, SignalUnits& units);
/// Converts bias, noise and dynamics of a sensor by the units of its components. Reports toml.unit-signal.
void change_sensor(const UnitTable& t, SignalUnits& units);
/// Converts a function by the units of its users. Reports toml.unit-use if they differ, toml.unit-file for a table
/// file.
void change_function(const UnitTable& t, SignalUnits& units);

}  // namespace bough::toml_files
