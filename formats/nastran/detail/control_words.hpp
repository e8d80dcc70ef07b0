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

/// The supported command that is similar to an unknown word; empty for known words and if none is similar.
std::string find_nearest_command(std::string_view word);

/// Known commands that are not used, for one note.
class IgnoredCommands {
 public:
  /// Adds a command with its line; only its first line is kept.
  void add(const std::string& word, const records::CardLocation& at);
  /// Adds deck.case-control-ignored, with the option that gives what a request asks for.
  void report(const records::Deck& deck, Diagnostics& diagnostics) const;

 private:
  std::vector<std::pair<std::string, records::CardLocation>> words_;
  std::unordered_set<std::string> seen_;
};

/// Where a command changes the answer.
enum class CommandScope {
  Model,       ///< stiffness, mass: everywhere
  StaticLoad,  ///< static solutions, stiffness from stress
  Response     ///< responses over frequency and time
};
/// Commands that change the answer and that Bough does not honour.
struct UnsupportedCommand {
  const char *name, *card;  ///< upper case; card: of those that it selects
  const char* what;         ///< what these are
  CommandScope scope = CommandScope::Response;
  std::size_t num_letters = 4;  ///< that tell it from other commands
};
/// nullptr for all others.
const UnsupportedCommand* find_unsupported_command(std::string_view word);

}  // namespace bough::nastran::detail
