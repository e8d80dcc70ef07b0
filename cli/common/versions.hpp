#pragma once
#include <string>

namespace bough::cli {

/// One line per library, as --version prints it.
std::string describe_versions();

}  // namespace bough::cli
