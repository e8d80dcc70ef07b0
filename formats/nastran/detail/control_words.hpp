#pragma once
/// \file Commands of the case control. Words are upper case; Nastran reads their first four letters.
#include <string>
#include <string_view>

namespace bough::nastran::detail {

/// Titles of pages, sets, plots and requests for plain results: what they ask for is printed anyway, or means nothing
/// here.
bool is_plain_command(std::string_view word);

/// The command that Bough uses and that was meant, for a word that no Nastran knows; empty for known ones and when none
/// is near.
std::string find_nearest_command(std::string_view word);

/// Commands that act in a response and that Bough does not honour there.
struct UnsupportedCommand {
  const char *name, *card;  ///< upper case; card: of those that it selects
  const char* what;         ///< what these are
};
/// nullptr for all others.
const UnsupportedCommand* find_unsupported_command(std::string_view word);

}  // namespace bough::nastran::detail
