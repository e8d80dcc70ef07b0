#include "base/text_table.hpp"

#include <algorithm>

namespace bough {

std::size_t calc_display_width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string TextTable::to_text() const {
  std::vector<std::size_t> width(headings.size());
  for (std::size_t c = 0; c < headings.size(); ++c) {
    width[c] = calc_display_width(headings[c]);
    for (const auto& row : rows)
      if (c < row.size()) width[c] = std::max(width[c], calc_display_width(row[c]));
  }
  std::string text;
  auto add_row = [&](const std::vector<std::string>& row) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += std::string(width[c] - calc_display_width(row[c]) + (c == 0 ? 0 : 2), ' ') + row[c];
    }
    text += '\n';
  };
  add_row(headings);
  for (const auto& row : rows) add_row(row);
  return text;
}

}  // namespace bough
