#pragma once
/// \file External superelements: the cards of a deck joined with the matrices of their files.
#include "formats/records/deck.hpp"

namespace bough::matrices {

/// Adds to deck.superelements from deck.super: exterior points, matrices, recovery rows of each external superelement.
/// Sections that deck.superelements has already are left alone.
/// Reports matrices.superelement-half (no section, no SEBULK, no file), matrices.superelement-size (the matrices are of
/// another boundary), matrices.superelement-type, matrices.superelement-rows, and what is wrong with a file.
void read_superelements(records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::matrices
