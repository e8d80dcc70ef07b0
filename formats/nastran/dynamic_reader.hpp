#pragma once
/// \file Decks with what drives them: as reader.hpp, and the cards and commands of responses too.
#include <string>
#include <string_view>

#include "formats/nastran/reader.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran {

/// Reads a deck with its dynamic loads, tables and output requests. Throws and reports as read_deck().
records::DynamicDeck read_dynamic_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);
/// Reads a deck from text; `name` takes the place of the path in messages.
records::DynamicDeck read_dynamic_deck_text(std::string_view text, const std::string& name, const ReadOptions& options,
                                            Diagnostics& diagnostics);
/// Dynamic deck from the bytes of pack_deck().
records::DynamicDeck read_packed_dynamic_deck(std::string bytes, const ReadOptions& options, Diagnostics& diagnostics);

/// read_deck and read_packed_deck for who makes the combinations of the case control (SUBCOM, SYMCOM, REPCASE): they
/// are not among what is not used.
records::Deck read_combined_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);
records::Deck read_packed_combined_deck(std::string bytes, const ReadOptions& options, Diagnostics& diagnostics);

/// Results requested by the subcases of a deck, and their combinations by SUBCOM, SYMCOM and REPCASE. Reads no card;
/// reports errors of the combinations only (deck.combination).
records::CaseRequests read_requests(const std::string& path, Diagnostics& diagnostics);
/// Requests from the bytes of pack_deck().
records::CaseRequests read_packed_requests(std::string bytes, Diagnostics& diagnostics);

}  // namespace bough::nastran
