#pragma once
/// \file English for messages and tables.
#include <cstddef>
#include <string>

namespace bough {

/// "1 mode", "2 modes", "0 bodies".
std::string count(std::size_t number, const std::string& noun);

}  // namespace bough
