#pragma once
/// \file A system or body file in other units: every value with a dimension is multiplied, the rest keeps every byte.
#include <functional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body_units.hpp"
#include "formats/records/unit_labels.hpp"

namespace bough::toml_files {

/// Facts from the files that a system file names.
struct BodyFacts {
  /// Unit of a locator's load: its direction, 0 for a pattern; -1 where it is not known. By body and locator.
  std::function<int(const std::string& body, const std::string& locator)> find_direction;
  /// Rows of an element that a body's file recovers; empty where that is not known.
  std::function<std::vector<std::string>(const std::string& body, int element)> find_components;
};

/// The text in other units; with `to_radians` the keys with _deg become radians. What cannot be converted is an error
/// at its line (toml.unit-parameter, -file, -signal, -use, -locator): then the text is not to be used. `num_changed`
/// counts values. [units] of a system file get `labels`, unless these are empty.
std::string change_units(const std::string& text, const std::string& file, const records::UnitChange& change,
                         bool to_radians, const BodyFacts& facts, const records::UnitLabels& labels,
                         Diagnostics& diagnostics, int& num_changed);

}  // namespace bough::toml_files
