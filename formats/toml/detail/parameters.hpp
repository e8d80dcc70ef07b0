#pragma once
/// \file [parameters] of a system file: "$name" wherever a number may stand.
#include "formats/toml/detail/value.hpp"

namespace bough::toml_files {

/// Puts the numbers of [parameters] where "$name" stands. Reports "toml.unknown-parameter" and
/// the warning "toml.unused-parameter".
void insert_parameters(Value& root, const std::string& file, Diagnostics& diagnostics);

}  // namespace bough::toml_files
