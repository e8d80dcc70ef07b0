#pragma once
/// \file Curves over frequency or time as steps of a listing (SORT1: one table for each sample and quantity).
#include "formats/records/deck_response.hpp"
#include "formats/records/listing.hpp"

namespace bough::cli {

/// Displacements, velocities, accelerations and forces of constraints at the points that were chosen; complex over
/// frequency, magnitude and phase (0 to 360 degrees) where the deck asks for it. No elements.
records::Listing make_response_listing(const records::DeckResponse& response);

}  // namespace bough::cli
