#pragma once
/// \file Folder of a command that writes several files.
#include <string>

namespace bough::cli {

/// Makes the folder if it is missing. Throws ComputationError "cli.write".
void make_output_folder(const std::string& folder);

}  // namespace bough::cli
