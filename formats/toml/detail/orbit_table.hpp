#pragma once
/// \file [[orbit]] of a system file.
#include "formats/records/orbit_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Reads one [[orbit]]. Reports "toml.missing-key", "toml.conflicting-keys".
records::OrbitRecord read_orbit(const Fields& table, Diagnostics& diagnostics);

}  // namespace bough::toml_files
