#pragma once
/// \file A flexible body with some of its modes.
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Every array of the body cut to these modes (0-based, ascending, at least one): a Rayleigh-Ritz basis with fewer
/// shapes.
FlexBody keep_modes(const FlexBody& body, const std::vector<int>& kept);

}  // namespace bough::records
