#pragma once
/// \file Units of the variables of an FMU, by their dimensions.
#include <optional>
#include <string>
#include <vector>

#include "analysis/convert/unit_system.hpp"
#include "formats/fmu/model_description.hpp"

namespace bough::analysis {

/// Represents the units in use; without a set of units only the radian.
class FmuUnits {
 public:
  /// \param text  set of units of the system file, as "mm-N-tonne"; empty: not known. Throws InputError
  /// "cli.bad-units".
  explicit FmuUnits(const std::string& text);

  /// Returns the name of the unit, "N.m" or "rad/s"; empty: none, also for pure numbers and powers that are no
  /// integers.
  ///
  /// \param dims  as "F L/T". \param is_angle  an angle, or a derivative of one by the time.
  std::string add(const std::string& dims, bool is_angle);
  /// Returns all units added, each once, in the order of their first use.
  const std::vector<fmu::Unit>& list() const { return list_; }

 private:
  std::optional<UnitNames> names_;
  nastran::UnitFactors factors_;
  std::vector<fmu::Unit> list_;
};

}  // namespace bough::analysis
