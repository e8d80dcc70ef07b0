#pragma once
/// \file Decks with what drives them: as reader.hpp, and the cards and commands of responses too.
#include <string>
#include <string_view>

#include "formats/nastran/reader.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran {

records::DynamicDeck read_dynamic_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);
records::DynamicDeck read_dynamic_deck_text(std::string_view text, const std::string& name, const ReadOptions& options,
                                            Diagnostics& diagnostics);
/// Of what pack_deck() gave.
records::DynamicDeck read_packed_dynamic_deck(std::string bytes, const ReadOptions& options, Diagnostics& diagnostics);

/// What the subcases of a deck ask for, by their ids (0: without SUBCASE). No card is read, nothing is reported.
std::map<int, records::DynamicSelection> read_requests(const std::string& path);
/// Of what pack_deck() gave.
std::map<int, records::DynamicSelection> read_packed_requests(std::string bytes);

}  // namespace bough::nastran
