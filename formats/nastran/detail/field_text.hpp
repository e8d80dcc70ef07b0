#pragma once
/// \file Changes one field of one physical line.
#include <string>
#include <string_view>

namespace bough::nastran::detail {

/// The line (no comment, no trailing blanks) with data field `index` (from 0, eight or, in large field, four a line)
/// set to `text`. Columns stay where they are; a text too long for them makes the line a free-field one. Empty when the
/// line cannot be written so.
std::string set_line_field(std::string_view line, int index, const std::string& text);

/// The first field of a line that continues `line`.
std::string make_continuation_mark(std::string_view line, bool is_large);

}  // namespace bough::nastran::detail
