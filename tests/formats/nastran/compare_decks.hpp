#pragma once
/// \file Two decks compared field by field.
#include <string>
#include <vector>

#include "formats/nastran/whole_deck.hpp"
#include "formats/records/deck.hpp"

namespace bough::nastran {

/// EXPECTs equal records; reals within `tolerance` of their size. Not compared: where a card stood, file names, counts,
/// cards that are not used, and whether an SPC came from a list with THRU.
void expect_equal_decks(const records::Deck& a, const records::Deck& b, double tolerance);
/// Likewise, with the cards, selections and combinations of responses, complex modes and rotors.
void expect_equal_dynamics(const WholeDeck& a, const WholeDeck& b, double tolerance);

/// Paths of the decks of the examples, and of the models in the shared folder if it is there.
std::vector<std::string> list_decks();

}  // namespace bough::nastran
