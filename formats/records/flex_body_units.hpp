#pragma once
/// \file A flexible body in other units.
#include <string>

#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Factors from old to new units: values in new units per old unit.
struct UnitChange {
  double mass = 1, length = 1, time = 1;
  /// Factor of forces, M L/T².
  double calc_force() const;
  /// Factor of the modal coordinates, M^1/2 L: modes normalized by mass stay so.
  double calc_modal() const;
  /// Returns true if nothing changes.
  bool is_none() const { return mass == 1 && length == 1 && time == 1; }
};

/// Unit of a load of this locator: a force, a moment, or 1: a load pattern holds its own forces.
double calc_locator_unit(int direction, const UnitChange& change);

/// Unit of a component of recovered elements by its name: "axial", "moment_z_a", "stress_xx@top".
double calc_component_unit(const std::string& component, const UnitChange& change);

/// Every quantity of the body; ids, names and sources stay.
void change_units(FlexBody& body, const UnitChange& change);

}  // namespace bough::records
