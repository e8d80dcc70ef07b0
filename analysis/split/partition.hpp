#pragma once
/// \file Elements, rigid elements and grids of a structure, each in its part.
#include <map>
#include <set>
#include <vector>

#include "analysis/split/split.hpp"
#include "analysis/split/structure.hpp"

namespace bough::analysis::splitting {

struct Partition {
  int num_parts = 0;
  std::vector<int> element_part, rigid_part;  ///< by index in the lists of the structure
  std::map<int, std::set<int>> grid_parts;    ///< parts whose elements and rigid elements have the grid or point
  std::vector<char> joins_pieces;  ///< by rigid element: an RBE3 that alone joins pieces, which it cannot carry
  int num_merged = 0;              ///< small pieces that joined a neighbour
  int num_pieces = 0;              ///< pieces that became parts in addition to those chosen

  /// The part that gets masses, loads and constraints of the grid: the first that has it; part 0 for a grid without
  /// elements.
  int find_owner(int grid) const {
    const auto found = grid_parts.find(grid);
    return found == grid_parts.end() || found->second.empty() ? 0 : *found->second.begin();
  }
  /// Parts that have all of the grids; part 0 has those without elements.
  std::set<int> find_common(const std::vector<int>& grids) const;
};

/// The part of each element that joins grids, by the choice; pieces that nothing connects are separate parts.
/// \throws InputError split.bad-choice, split.bad-plane, split.unknown-element, split.unknown-grid,
///     split.nothing-separated, split.element-in-two-parts, split.too-many-parts, split.loose-parts,
///     split.connector-across-cut
/// \post joins_pieces has a flag for each rigid element.
Partition assign_elements(const Structure& structure, const SplitChoice& choice);

/// Renumbers the parts: new_number[old].
void renumber(const std::vector<int>& new_number, Partition& partition);

/// The part of each rigid element, and of each element at one grid, by the parts of their grids.
/// \throws InputError split.rigid-across-cut, split.rbe3-pieces
void assign_attached(const Structure& structure, Partition& partition);

}  // namespace bough::analysis::splitting
