#pragma once
/// \file Physical lines of a deck with its INCLUDE files in their place.
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

/// One line without its comment and trailing blanks; never empty. Tabs of fixed-field lines are expanded to 8-column
/// stops.
struct Line {
  std::string_view text;
  records::CardLocation at;
};

/// An INCLUDE statement: the lines it takes in `file`, and which file it names.
struct IncludeLine {
  int file = 0, first_line = 0, last_line = 0;
  int target = 0;
};

/// The text of all files and the lines in reading order, up to ENDDATA.
struct Source {
  std::vector<std::string> files;
  std::vector<std::string_view> texts;  ///< all bytes of each file
  std::vector<Line> lines;
  std::vector<IncludeLine> includes;
  std::vector<std::size_t> after_empty;  ///< positions in `lines`, ascending, of those after an empty line
  std::vector<std::shared_ptr<const std::string>> bytes;  ///< of the files, which texts and lines point into
  std::deque<std::string> storage;                        ///< other text that lines point into; never moved
};

/// Reads a file and what it includes. Adds deck.cannot-open, deck.include-missing, deck.include-cycle,
/// deck.include-syntax.
Source read_source(const std::string& path, Diagnostics& diagnostics);
/// Source from text in memory.
Source read_source_text(std::string_view text, const std::string& name, Diagnostics& diagnostics);

}  // namespace bough::nastran::detail
