#pragma once
/// \file Names of a system file: unique, and every reference to a declared one.
#include "formats/records/system_spec.hpp"

namespace bough::toml_files {

/// Reports "toml.duplicate-name", "toml.reserved-name" (a body called ground) and "toml.unknown-name" with the nearest.
void check_names(const records::SystemSpec& spec, Diagnostics& diagnostics);

}  // namespace bough::toml_files
