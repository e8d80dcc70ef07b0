#pragma once
/// \file Lines of the executive and the case control: commands, and where the sections begin.
#include <cstddef>
#include <string>
#include <string_view>

#include "formats/nastran/detail/lines.hpp"
#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

/// Exact word, or an abbreviation of at least `shortest` letters.
bool is_command(std::string_view word, std::string_view command, std::size_t shortest);

struct Command {
  std::string word;        ///< upper case
  std::string options;     ///< text in parentheses, upper case
  std::string_view value;  ///< after "=" or, without one, after the word
};

/// Splits a line of the case control; the value is a view of `text`.
Command split_command(std::string_view text);

/// Lines of CEND and BEGIN BULK.
struct Sections {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::size_t cend = none, begin_bulk = none;
};
/// Finds CEND and the first BEGIN BULK; a bare BEGIN of a DMAP sequence before CEND does not count.
Sections find_sections(const Source& source);

/// SOL, out of the lines before `last`. Adds deck.unused-executive for DMAP and restarts.
void read_executive(const Source& source, std::size_t last, records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::nastran::detail
