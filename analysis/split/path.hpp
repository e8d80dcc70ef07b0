#pragma once
/// \file A coordinate along a structure.
#include <map>
#include <string>

#include "analysis/split/structure.hpp"

namespace bough::analysis::splitting {

/// [L] of each grid of an element. "path": shortest way over elements and rigid elements from the grids that the deck
/// holds (the group of connected ones with the lowest id), or from one end of a free structure (the grid farthest from
/// the first); "long": along the principal axis of the grids; "x", "y", "z": in basic.
/// \throws InputError split.loose-parts if "path" does not reach every grid
std::map<int, double> calc_coordinate(const Structure& structure, const std::string& along);

}  // namespace bough::analysis::splitting
