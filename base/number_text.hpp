#pragma once
/// \file Numbers in messages.
#include <string>

namespace bough {

/// The number with that many significant digits, as %g writes it; -0 is 0.
std::string show_number(double value, int digits = 6);

}  // namespace bough
