#pragma once
/// \file Numbers in messages of random responses.
#include <cstdio>
#include <string>

namespace bough::modal::response {

/// Decimal digits.
inline std::string to_text(int value) { return std::to_string(value); }
/// Six significant digits.
inline std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace bough::modal::response
