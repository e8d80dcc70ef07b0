#pragma once
/// \file Loads without follower stiffness.
#include "base/diagnostic.hpp"
#include "formats/records/deck.hpp"

namespace bough::fe {

/// Warns of the cards of a load selection (0: none) that keep their direction in K_G although PARAM,FOLLOWK,YES asks
/// them to follow (fe.dead-load). For callers that use K_G of the load: static solutions have none.
void report_dead_loads(const records::Deck& deck, int load_set, Diagnostics& diagnostics);

}  // namespace bough::fe
