#pragma once
#include <string>

namespace bough::cli {

/// Writes beside and renames: the file appears whole or not at all. Throws ComputationError("cli.write").
void write_text_file(const std::string& path, const std::string& text);

}  // namespace bough::cli
