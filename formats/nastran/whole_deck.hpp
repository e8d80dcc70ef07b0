#pragma once
/// \file Decks that are written again: all that any analysis reads, and more of the case control.
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/nastran/reader.hpp"
#include "formats/nastran/writer.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran {

/// The cards and commands of responses, complex modes and rotors, and the combinations of subcases.
struct WholeDeck : records::DynamicDeck {
  std::vector<records::CaseCombination> combinations;
  /// Options of output requests in brackets, in upper case, by file and line of OutputRequest::at.
  std::map<std::pair<int, int>, std::string> request_options;
  records::CaseRequests post;  ///< of it the sets, surfaces and volumes of OUTPUT(POST)
};

/// Reads a deck that is written again. No card or command is an error because an analysis lacks it.
/// ReadOptions::is_response and is_complex are not used. Throws and reports as read_deck().
WholeDeck read_whole_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);
/// Reads such a deck from text; `name` takes the place of the path in messages.
WholeDeck read_whole_deck_text(std::string_view text, const std::string& name, const ReadOptions& options,
                               Diagnostics& diagnostics);

/// Writes a deck as write_deck of a records::Deck does, and its cards and commands of responses, complex modes and
/// rotors. "deck.left-out" names cards with a field that no record keeps, too.
std::string write_deck(const WholeDeck& deck, const WriteOptions& options, Diagnostics& diagnostics);

}  // namespace bough::nastran
