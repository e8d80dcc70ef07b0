#pragma once
/// \file A system file that is not on disk, with other numbers for its parameters.
#include "formats/records/system_spec.hpp"

namespace bough::toml_files {

/// As read_system_spec of a file `path` with this text; only files that it names are opened.
records::SystemSpec read_system_spec_text(std::string text, const std::string& path,
                                          const std::vector<std::pair<std::string, std::string>>& set,
                                          Diagnostics& diagnostics);

}  // namespace bough::toml_files
