#pragma once
/// \file Text between quotation marks.
#include <string>

namespace bough {

/// The text between two quotation marks; marks and backslashes of the text have a backslash before them.
inline std::string quote_with(char mark, const std::string& text) {
  std::string quoted(1, mark);
  for (const char c : text) {
    if (c == mark || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + mark;
}

}  // namespace bough
