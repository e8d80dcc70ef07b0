#pragma once
/// \file Labels of units, [units] of a system file: texts for axes and headings. Labels convert nothing.
#include <string>

namespace bough::records {

/// Labels of the base units; empty: not given.
struct UnitLabels {
  std::string length, mass, time, force;
  /// Returns true if no label is given.
  bool empty() const { return length.empty() && mass.empty() && time.empty() && force.empty(); }
};

/// Writes dimensions with the labels: "M L^2/T" becomes "kg m^2/s", "F L, 1/T" becomes "N m, 1/s".
///
/// \param dims       dimensions in M, L, T, F; of components that differ a list with ", ".
/// \param has_angle  "1" and "1/T^n" are an angle and its derivatives, in radians: "rad", "rad/s".
/// \return empty if a label is missing, if `dims` are no dimensions, or if a quantity without dimension is no angle.
std::string label_units(const std::string& dims, const UnitLabels& labels, bool has_angle);

/// Entry `component` of a list with one entry per component; `list` itself if all components have the same.
std::string pick_unit(const std::string& list, int component, int num_components);

}  // namespace bough::records
