#pragma once
/// \file TOML texts of C++ tests, a table on a line.
#include <string>

namespace bough::test {

/// Text of TOML in which "; " stands for the end of a line.
inline std::string toml_lines(std::string text) {
  for (auto at = text.find("; "); at != std::string::npos; at = text.find("; ", at)) text.replace(at, 2, "\n");
  return text;
}

}  // namespace bough::test
