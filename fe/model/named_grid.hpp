#pragma once
/// \file Grids that cards name.
#include "base/diagnostic.hpp"
#include "fe/elements/element.hpp"

namespace bough::fe {

/// Returns the index of the node, or -1 with error fe.missing-grid at the card; without one if the deck's reader has
/// refused the grid already.
int find_named_grid(const NodeTable& nodes, int grid, const std::string& card, const SourceLocation& at,
                    Diagnostics& diagnostics);

/// Index of a grid with six components likewise; a scalar point is an error, too.
int find_named_six(const NodeTable& nodes, int grid, const std::string& card, const SourceLocation& at,
                   Diagnostics& diagnostics);

}  // namespace bough::fe
