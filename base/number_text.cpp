#include "base/number_text.hpp"

#include <cstdio>

namespace bough {

std::string show_number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value + 0.0);
  return text;
}

}  // namespace bough
