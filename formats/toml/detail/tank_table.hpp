#pragma once
/// \file [[tank]] of a system file.
#include "formats/records/tank_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Reports "toml.missing-key" and "toml.conflicting-keys" by type, "toml.wrong-length" of rows of a table.
records::TankRecord read_tank(const Fields& table, Diagnostics& diagnostics);

}  // namespace bough::toml_files
