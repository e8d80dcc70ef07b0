#pragma once
/// \file Two decks compared field by field.
#include "formats/records/deck.hpp"

namespace bough::nastran {

/// EXPECTs equal records; reals within `tolerance` of their size. Not compared: where a card stood, file names, counts,
/// cards that are not used, and whether an SPC came from a list with THRU.
void expect_equal_decks(const records::Deck& a, const records::Deck& b, double tolerance);

}  // namespace bough::nastran
