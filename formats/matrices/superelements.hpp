#pragma once
/// \file External superelements: the cards of a deck joined with the matrices of their files.
#include "formats/records/deck.hpp"

namespace bough::matrices {

/// Makes deck.superelements of deck.super: exterior points, matrices, recovery rows of each external superelement.
/// Reports matrices.superelement-half (no section, no SEBULK, no file), matrices.superelement-size (the matrices are of
/// another boundary), matrices.superelement-type, matrices.superelement-rows, and what is wrong with a file.
void read_superelements(records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::matrices
