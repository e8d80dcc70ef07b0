#pragma once
/// \file Curves over frequency or time as steps of a listing (SORT1: one table for each sample and quantity).
#include "fe/model/model.hpp"
#include "formats/records/deck_response.hpp"
#include "formats/records/listing.hpp"

namespace bough::analysis {

/// Displacements, velocities, accelerations and forces of constraints at the points that were chosen, forces and
/// stresses of the chosen elements; complex over frequency, magnitude and phase (0 to 360 degrees) where the deck
/// requests for it; random responses at the points. `model`: any of the subcases'. Reports cli.unlisted-elements.
records::Listing make_response_listing(const records::DeckResponse& response, const records::Deck& deck,
                                       const fe::Model& model, Diagnostics& diagnostics);

}  // namespace bough::analysis
