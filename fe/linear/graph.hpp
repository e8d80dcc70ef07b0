#pragma once
/// \file Graphs of grids or rows, and how METIS cuts them (Karypis & Kumar, SIAM J. Sci. Comput. 20 (1998) 359).
#include <vector>

#include <metis.h>

namespace bough::linear {

/// Neighbours of each vertex, not itself, and its weight.
struct Graph {
  std::vector<idx_t> start{0}, neighbours, weight;
  /// Number of vertices.
  idx_t size() const { return static_cast<idx_t>(weight.size()); }
};

/// The vertices `which` and what couples them.
Graph take_vertices(const Graph& graph, const std::vector<idx_t>& which);

/// Nested dissection: the vertices in the order of their elimination; as they are where nothing couples them, empty
/// where METIS fails.
std::vector<idx_t> find_dissection(Graph& graph);

/// Two parts of about the same weight and few vertices between, the part (0, 1) or 2 of each. METIS cuts by vertices:
/// ends of the edges that a cut by edges has are 33 % more on a plate. Empty if it fails.
std::vector<idx_t> find_separator(Graph& graph);

}  // namespace bough::linear
