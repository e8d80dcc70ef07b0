#pragma once
/// \file Commands of the case control. Words are upper case; Nastran reads their first four letters.
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::nastran::detail {

/// Titles of pages, sets, plots and requests for plain results: what they ask for is printed anyway, or means nothing
/// here.
bool is_plain_command(std::string_view word);

/// The command that Bough uses and that was meant, for a word that no Nastran knows; empty for known ones and when none
/// is near.
std::string find_nearest_command(std::string_view word);

/// Known commands that are not used, for one note.
class IgnoredCommands {
 public:
  void add(const std::string& word, const records::CardLocation& at);
  /// Adds deck.case-control-ignored, with the option that gives what a request asks for.
  void report(const records::Deck& deck, Diagnostics& diagnostics) const;

 private:
  std::vector<std::pair<std::string, records::CardLocation>> words_;
  std::unordered_set<std::string> seen_;
};

/// Commands that act in a response and that Bough does not honour there.
struct UnsupportedCommand {
  const char *name, *card;  ///< upper case; card: of those that it selects
  const char* what;         ///< what these are
};
/// nullptr for all others.
const UnsupportedCommand* find_unsupported_command(std::string_view word);

}  // namespace bough::nastran::detail
