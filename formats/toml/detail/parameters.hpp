#pragma once
/// \file [parameters] of a system file: "$name" wherever a number may stand.
#include "formats/toml/detail/value.hpp"

namespace bough::toml_files {

/// Replaces each "$name" by its number of [parameters]. Reports "toml.unknown-parameter" and the warning
/// "toml.unused-parameter".
void insert_parameters(Value& root, const std::string& file, Diagnostics& diagnostics);

}  // namespace bough::toml_files
