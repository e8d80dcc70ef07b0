#pragma once
/// \file Tables of text for a reader.
#include <cstddef>
#include <string>
#include <vector>

namespace bough {

/// Columns that UTF-8 text takes on a screen: its number of characters.
std::size_t calc_display_width(const std::string& text);

/// A table of text cells with right-aligned columns; the first row of each column is its heading.
struct TextTable {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
  /// Formats headings and rows as lines with two blanks between columns, whose widths count characters on the screen.
  std::string to_text() const;
};

}  // namespace bough
