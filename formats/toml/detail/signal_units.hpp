#pragma once
/// \file Units of the signals of a system file: of sensors and actuators by their type, of functions and controllers by
/// the blocks that use them.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "formats/toml/detail/hinge_table.hpp"
#include "formats/toml/unit_change.hpp"

namespace bough::toml_files {

/// A connection: the signal of an input, and its [[connect]] table.
struct Wire {
  std::string from;
  const toml::node* node = nullptr;
};

class SignalUnits {
 public:
  /// All arguments must outlive this; `facts` are those of the files of the bodies.
  SignalUnits(const toml::table& root, const records::UnitChange& change, const BodyFacts& facts);

  /// Units of a hinge's coordinates as they are in lists of positions and of rates, and of the efforts along them.
  std::vector<double> list_positions(const std::string& hinge) const;
  std::vector<double> list_rates(const std::string& hinge) const;
  std::vector<double> list_efforts(const std::string& hinge) const;
  /// Returns true if coordinate i of a hinge, of its positions or of its rates, is an angle.
  bool is_angle(const std::string& hinge, bool of_positions, std::size_t i) const;
  /// Unit of the rate of one coordinate, counted from 1.
  double get_rate_unit(const std::string& hinge, long coordinate) const;
  /// Unit of the effort along one coordinate, counted from 1.
  double get_effort_unit(const std::string& hinge, long coordinate) const;

  /// Wires to "law", "law:reference" or "law:rate", from its own keys and from [[connect]].
  std::vector<Wire> list_wires(const toml::table& block, const std::string& key, const std::string& port) const;
  /// Units of a signal's components; empty where they cannot be told.
  std::vector<double> list_units(const std::string& signal);
  /// Unit of an input by its dims; none if they are not known.
  std::optional<double> find_input_unit(const toml::table& input) const;
  /// The unit of one component or of all alike; nothing where it cannot be told.
  std::optional<double> find_unit(const std::string& signal);
  /// The unit of what a controller gives out; of a function's values.
  double get_output_unit(const toml::table& controller);
  double get_function_unit(const std::string& name);
  /// Units that each hinge, force and actuator expects of this function; for a controller, those of each force.
  std::vector<double> list_demands(const std::string& name) const;
  /// Unit of the factor of a force.
  double get_multiplier_unit(const toml::table& force) const;
  /// Unit of the command of an actuator.
  double get_command_unit(const toml::table& actuator) const;

  /// Returns the table of a kind, as "hinge", with this name; nullptr if it is absent.
  const toml::table* find(const char* kind, const std::string& name) const;
  /// Factors from old to new units.
  const records::UnitChange& change() const { return c_; }
  /// Returns the whole system file.
  const toml::table& root() const { return root_; }
  /// Factor of forces.
  double force() const { return c_.calc_force(); }

  /// Returns true if the output of a controller has the unit of its first input.
  static bool is_passing(const toml::table& controller);

 private:
  HingeCoordinates get_coordinates(const std::string& hinge) const;
  double calc_unit(const std::string& dims) const;
  std::vector<double> list_sensor_units(const toml::table& sensor) const;
  std::vector<double> list_actuator_units(const toml::table& actuator) const;
  std::optional<double> find_channel_unit(const std::string& channel) const;
  /// Unit that the users of this function or controller expect.
  std::optional<double> find_demand(const std::string& name);
  std::optional<double> find_taken(const std::string& name, const toml::table& taker, const std::string& kind);

  const toml::table& root_;
  const records::UnitChange& c_;
  const BodyFacts& facts_;
  std::map<std::string, double> known_;
  std::vector<std::string> asked_;
};

/// The entries of a list of tables.
std::vector<const toml::table*> list_tables(const toml::table& root, const char* kind);
std::string get_text(const toml::table& table, const char* key, const std::string& otherwise = {});

}  // namespace bough::toml_files
