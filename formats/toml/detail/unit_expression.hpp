#pragma once
/// \file Units from dimensions as texts.
#include <functional>
#include <string>
#include <vector>

namespace bough::toml_files {

using Units = std::vector<double>;

/// Evaluates a dimension: "effort/travel", "F/L^exponent"; "1/T, T" has a unit per entry.
/// \return empty if a name has no units.
Units calc_units(const std::string& dims, const std::function<Units(const std::string& name)>& find);

}  // namespace bough::toml_files
