#pragma once
/// \file [[event]] of a system file.
#include "formats/records/system_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Reports "toml.missing-key" and "toml.conflicting-keys" for keys that the action needs or does not know.
records::UserEventRecord read_event(const Fields& table, Diagnostics& diagnostics);

}  // namespace bough::toml_files
