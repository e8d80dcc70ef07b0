#pragma once
/// \file CFAST and CWELD of a deck that is cut: each is in the part of its shells.
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/split/structure.hpp"

namespace bough::analysis::splitting {

/// Returns true for elements that join two grids or more and whose part depends on their place alone.
inline bool is_placed(const DeckItem& item) { return is_structural(item) && item.shells.empty(); }

/// Mean of the coordinates of the grids of an element; empty if none has one.
std::optional<double> calc_mean_coordinate(const DeckItem& element, const std::map<int, double>& coordinate);

/// Lowest and highest mean coordinate of the shells of each connector: a cut between these separates its ends.
std::vector<std::pair<double, double>> list_joined_ranges(const Structure& structure,
                                                          const std::map<int, double>& coordinate);

/// Gives each connector the key of its shells.
/// \param keys  by element; -1: none. Connectors with a key were named in this part.
/// \throws InputError split.connector-across-cut
void assign_connectors(const Structure& structure, std::vector<int>& keys);

}  // namespace bough::analysis::splitting
