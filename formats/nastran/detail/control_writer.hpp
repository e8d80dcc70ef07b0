#pragma once
/// \file Executive and case control of a deck that is written.
#include <string>

#include "formats/nastran/whole_deck.hpp"

namespace bough::nastran::detail {

/// Appends NASTRAN, ASSIGN, SOL, CEND, the subcases and BEGIN BULK.
/// \param dynamics  the deck with the selections of its subcases and their combinations; null: none are written.
void write_control(const records::Deck& deck, const WholeDeck* dynamics, std::string& out);

}  // namespace bough::nastran::detail
