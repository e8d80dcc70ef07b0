#pragma once
/// \file Cards as runs of physical lines: which continuation belongs to which card.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "formats/nastran/detail/lines.hpp"

namespace bough::nastran::detail {

/// Consecutive lines of one card. Continuations that stand elsewhere in the deck are chained by `next`.
struct CardImage {
  int first_line = 0;
  int num_lines = 0;
  int next = -1;  ///< image that continues this one, or -1
};

struct CardImages {
  std::vector<CardImage> images;
  std::vector<int> cards;  ///< images that start a card, in the order of the deck
};

/// Groups the lines from `first_line` on. A continuation follows its parent, or is found by its tag (columns 2-8
/// against 74-80 of the parent, whatever their case and their marks). Adds deck.orphan-continuation.
CardImages make_card_images(const Source& source, std::size_t first_line, Diagnostics& diagnostics);

/// The fields of one line: name or continuation mark, data, continuation tag.
struct SplitLine {
  std::string_view name;               ///< field 1 without "*" and blanks
  std::vector<std::string_view> data;  ///< 8 (small, free) or 4 (large) fields per line, trimmed
  std::string_view tag;                ///< field 10
  bool is_large = false;
  int num_excess = 0;                    ///< fields of a free-field line that are neither data nor a tag
  bool has_number_tag = false;           ///< free field: field 10 contains a number
  std::vector<std::string_view> tokens;  ///< storage of split_line
};

/// Splits a line in place; `line` is reused to keep its storage.
void split_line(std::string_view text, SplitLine& line);
/// Field 1 of a line, trimmed, as written.
std::string_view get_first_field(std::string_view text);
/// Returns true if a comma is among the first columns of the line, as in free field format.
bool is_free_field(std::string_view text);
/// True if `next_line` is the continuation that names `tag`.
bool is_continued_by(std::string_view tag, std::string_view next_line);

}  // namespace bough::nastran::detail
