#pragma once
/// \file The deck of a structure in its deformed shape (docs/theory/preload.md).
#include "fe/statics/nonlinear.hpp"

namespace bough::fe {

/// Returns the deck with its grids at x + u and the axes of its elements, offsets and masses turned with their grids.
/// Displacement axes and directions of loads stay as they are in space. Bars and bushes turn with the mean rotation of
/// their two grids, material axes of shells with that of their corners, offsets and masses with their grid. `model`: of
/// the deck, without a separate origin. Reports fe.nonlinear-preload for each kind of card that cannot be turned.
records::Deck make_deformed_deck(const records::Deck& deck, const Model& model, const DeformedState& state,
                                 Diagnostics& diagnostics);

}  // namespace bough::fe
