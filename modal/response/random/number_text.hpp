#pragma once
/// \file Numbers in messages of random responses.
#include <string>

#include "base/number_text.hpp"

namespace bough::modal::response {

/// Decimal digits.
inline std::string to_text(int value) { return std::to_string(value); }
/// Six significant digits.
inline std::string to_text(double value) { return show_number(value); }

}  // namespace bough::modal::response
