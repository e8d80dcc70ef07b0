#pragma once
/// \file The line of a TOML file that names its schema for editors.
#include "analysis/init/init_deck.hpp"

namespace bough::cli {

/// Adds "#:schema file://..." to a TOML file if the schemas are installed.
void add_schema_line(analysis::StartFile& file);

}  // namespace bough::cli
