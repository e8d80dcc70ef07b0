#pragma once
/// \file A system file that is not on disk, with other numbers for its parameters.
#include "formats/records/system_spec.hpp"

namespace bough::toml_files {

/// Reads this text as read_system_spec reads the file `path`; only files that it names are opened.
records::SystemSpec read_system_spec_text(std::string text, const std::string& path,
                                          const std::vector<std::pair<std::string, std::string>>& set,
                                          Diagnostics& diagnostics);

}  // namespace bough::toml_files
