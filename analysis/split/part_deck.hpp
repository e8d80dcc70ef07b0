#pragma once
/// \file The deck of one part.
#include "analysis/split/assembly.hpp"

namespace bough::analysis::splitting {

/// Grids, elements, masses, rigid elements, constraints, loads and temperatures of the part, with all properties,
/// materials and coordinate systems; new grids and RBE2 of its joints. A grid of several parts is in each of their
/// decks, its point masses and loads in the deck of the first. Accelerations (GRAV, RFORCE, ACCEL) are in every deck.
///
/// Constraints are those of the deck for part 0 if the deck holds it. The others keep the components that every grid
/// of the deck holds; `clamp` of the assembly is held in all components.
/// \throws InputError split.matrix-across-cut, split.load-across-cut, split.dependent-cut
records::Deck make_part_deck(const Structure& structure, const Partition& partition, const Assembly& assembly,
                             int part);

}  // namespace bough::analysis::splitting
