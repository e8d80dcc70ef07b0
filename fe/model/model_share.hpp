#pragma once
/// \file What one rank has of a model that is made by parts (docs/adr/0024-model-by-parts.md).
#include <vector>

#include "fe/elements/element.hpp"
#include "fe/model/constraints.hpp"

namespace bough::fe {

/// Every rank has all nodes and the whole T; of the elements those that reach f-dofs of its own, and those that it
/// owns.
struct ModelShare {
  std::vector<int> home;              ///< rank of every node and of its f-dofs, which are numbered by rank
  int first_fdof = 0, last_fdof = 0;  ///< this rank's: [first, last)
  int rank = 0;
  std::vector<int> owned;   ///< of Model::elements(), ascending: each element of the deck is one rank's
  std::vector<int> number;  ///< of each of Model::elements(): its place among those of all ranks

  bool is_at_home(int node) const { return home[static_cast<std::size_t>(node)] == rank; }
  /// The first node of an element says whose it is.
  bool is_owned(const Element& element) const;
  /// Owned, or with one of the rank's f-dofs among those that move it.
  bool keeps(const Element& element, const SparseRows& T) const;
};

/// The rank of every node, by METIS from what the cards of elements and `equations` (resolved) join, each node weighing
/// as its dofs that are neither fixed nor dependent. Alike on every rank, nothing is sent. Empty: no such cut.
std::vector<int> cut_nodes(const records::Deck& deck, const NodeTable& nodes, int num_nodes,
                           const std::vector<ConstraintEquation>& equations, const std::vector<char>& is_fixed,
                           int num_ranks);

/// Numbers the f-dofs by the rank of their node, in each rank as before; the share of `rank` of them.
ModelShare order_by_home(const std::vector<Node>& nodes, std::vector<int> home, int rank, Elimination& elimination);

}  // namespace bough::fe
