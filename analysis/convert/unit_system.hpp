#pragma once
/// \file Sets of units by their names: "mm-N-tonne", "m-kg-s".
#include <string>
#include <utility>

#include "formats/nastran/unit_conversion.hpp"
#include "formats/records/unit_labels.hpp"

namespace bough::analysis {

/// The units of mass, length and time in SI units. Three of a length, a mass, a force and a time fix the fourth by
/// force = mass length / time^2; without a time and one of mass and force, the time is the second. Throws InputError
/// "cli.bad-units".
nastran::UnitFactors parse_units(const std::string& text);

/// Names of the units of a set: those in its text, others by their size; empty if none has that size.
struct UnitNames {
  std::string mass, length, time, force;
};
/// Throws InputError "cli.bad-units".
UnitNames name_units(const std::string& text);

/// Force of a consistent set in the unit of the label, F = M L / T^2: 0.001 of mm, kg, s and N.
/// \return 1 also if a label is empty or of no known unit.
double calc_unit_force(const records::UnitLabels& labels);

/// Name of the set of the labels of a system file, "m-kg-s"; empty if one is missing or of no known unit, or if the
/// force is not that of the others.
std::string name_labelled_set(const records::UnitLabels& labels);

/// Throws InputError "cli.bad-units" where a label of the file at `at` is a unit of another size than that of the set.
void demand_labels(const std::string& text, const records::UnitLabels& labels, const SourceLocation& at);

/// "mm-N-tonne:m-kg-s" -> its two halves.
std::pair<std::string, std::string> split_units(const std::string& text);

}  // namespace bough::analysis
