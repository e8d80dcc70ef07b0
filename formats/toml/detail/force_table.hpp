#pragma once
/// \file [[force]] of a system file: loads at nodes, and elements between bodies by type.
#include "formats/records/system_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Puts one table into spec.forces, or with a type into spec.force_elements. Reports "toml.missing-key" and
/// "toml.conflicting-keys" for keys that the type needs or does not have.
void read_force(const Fields& table, records::SystemSpec& spec, Diagnostics& diagnostics);

}  // namespace bough::toml_files
