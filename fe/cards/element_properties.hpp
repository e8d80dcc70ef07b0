#pragma once
/// \file Property card of each element.
#include <unordered_map>

#include "formats/records/deck.hpp"

namespace bough::fe {

/// PID by element id; elements without a property (CELAS2, CONROD, CONM2) are not in it.
std::unordered_map<int, int> list_element_properties(const records::Deck& deck);

}  // namespace bough::fe
