#include "fe/model/model_share.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "fe/linear/graph.hpp"
#include "fe/model/element_transform.hpp"

namespace bough::fe {

bool ModelShare::is_owned(const Element& element) const {
  return (element.nodes().empty() ? 0 : home[static_cast<std::size_t>(element.nodes().front())]) == rank;
}

bool ModelShare::keeps(const Element& element, const SparseRows& T) const {
  if (is_owned(element)) return true;
  for (const int g : element.gdofs())
    for (SparseRows::InnerIterator it(T, g); it; ++it)
      if (it.col() >= first_fdof && it.col() < last_fdof) return true;
  return false;
}

namespace {

/// More nodes than that are left out of what a rigid element joins: the cut may cross it, and costs rows between.
constexpr std::size_t kMostJoined = 40;

/// What joins nodes, each a list of them: METIS' mesh.
class Joins {
 public:
  Joins(const NodeTable& nodes, int num_nodes, const std::vector<ConstraintEquation>& equations,
        const std::vector<char>& is_fixed)
      : nodes_(nodes), moved_by_(static_cast<std::size_t>(num_nodes)), weight_(static_cast<std::size_t>(num_nodes), 0) {
    std::vector<int> node_of;
    for (int k = 0; k < num_nodes; ++k)
      node_of.insert(node_of.end(), static_cast<std::size_t>(nodes.node(k).num_dofs), k);
    std::vector<char> is_held = is_fixed;
    for (const auto& equation : equations) {
      is_held[static_cast<std::size_t>(equation.dependent)] = 1;
      auto& movers = moved_by_[static_cast<std::size_t>(node_of[static_cast<std::size_t>(equation.dependent)])];
      for (const auto& [ldof, factor] : equation.terms)
        if (is_fixed[static_cast<std::size_t>(ldof)] == 0) movers.push_back(node_of[static_cast<std::size_t>(ldof)]);
      std::sort(movers.begin(), movers.end());
      movers.erase(std::unique(movers.begin(), movers.end()), movers.end());
    }
    for (std::size_t l = 0; l < is_held.size(); ++l)
      if (is_held[l] == 0) ++weight_[static_cast<std::size_t>(node_of[l])];
  }

  /// The grids of a card; those that are not there, or 0, join nothing.
  void add(std::initializer_list<int> grids) { add(grids.begin(), grids.end()); }
  template <class Grid>
  void add(Grid first, Grid last) {
    joined_.clear();
    for (; first != last; ++first)
      if (const int k = *first == 0 ? -1 : nodes_.find_node(*first); k >= 0) {
        joined_.push_back(k);
        const auto& movers = moved_by_[static_cast<std::size_t>(k)];
        if (movers.size() <= kMostJoined) joined_.insert(joined_.end(), movers.begin(), movers.end());
      }
    std::sort(joined_.begin(), joined_.end());
    joined_.erase(std::unique(joined_.begin(), joined_.end()), joined_.end());
    if (joined_.size() < 2) return;
    nodes_of_.insert(nodes_of_.end(), joined_.begin(), joined_.end());
    start_.push_back(static_cast<idx_t>(nodes_of_.size()));
  }

  std::vector<int> cut(int num_parts);

 private:
  const NodeTable& nodes_;
  std::vector<std::vector<int>> moved_by_;  ///< of each node that equations move: the nodes that do
  std::vector<idx_t> weight_, start_{0}, nodes_of_;
  std::vector<idx_t> joined_;
};

std::vector<int> Joins::cut(int num_parts) {
  auto num_nodes = static_cast<idx_t>(weight_.size()), num_joins = static_cast<idx_t>(start_.size()) - 1;
  if (std::all_of(weight_.begin(), weight_.end(), [](idx_t w) { return w == 0; })) return {};
  idx_t base = 0, *start = nullptr, *neighbours = nullptr;
  if (num_joins == 0 || num_nodes < num_parts ||
      METIS_MeshToNodal(&num_joins, &num_nodes, start_.data(), nodes_of_.data(), &base, &start, &neighbours) !=
          METIS_OK)
    return {};
  Graph graph;
  graph.start.assign(start, start + num_nodes + 1);
  graph.neighbours.assign(neighbours, neighbours + start[num_nodes]);
  graph.weight = weight_;
  METIS_Free(start);
  METIS_Free(neighbours);
  const std::vector<idx_t> part = cut_into_parts(graph, num_parts);
  return {part.begin(), part.end()};
}

}  // namespace

std::vector<int> cut_nodes(const records::Deck& deck, const NodeTable& nodes, int num_nodes,
                           const std::vector<ConstraintEquation>& equations, const std::vector<char>& is_fixed,
                           int num_ranks) {
  Joins joins(nodes, num_nodes, equations, is_fixed);
  std::vector<int> grids;
  const auto add_both = [&](const auto& corners, const auto& midsides) {
    grids.assign(corners.begin(), corners.end());
    grids.insert(grids.end(), midsides.begin(), midsides.end());
    joins.add(grids.begin(), grids.end());
  };
  for (const auto& card : deck.shells) add_both(card.grids, card.midsides);
  for (const auto& card : deck.solids) add_both(card.corners, card.midsides);
  for (const auto& card : deck.shear_panels) joins.add(card.grids.begin(), card.grids.end());
  const auto add_lines = [&](const auto& cards) {
    for (const auto& card : cards) joins.add({card.ga, card.gb});
  };
  add_lines(deck.beams), add_lines(deck.crod), add_lines(deck.conrod), add_lines(deck.ctube);
  add_lines(deck.cbush), add_lines(deck.cbush1d), add_lines(deck.cvisc);
  const auto add_scalars = [&](const auto& cards) {
    for (const auto& card : cards) joins.add({card.g1, card.g2});
  };
  add_scalars(deck.springs), add_scalars(deck.scalar_masses), add_scalars(deck.dampers);
  return joins.cut(num_ranks);
}

ModelShare order_by_home(const std::vector<Node>& nodes, std::vector<int> home, int rank, Elimination& elimination) {
  ModelShare share;
  share.home = std::move(home);
  share.rank = rank;
  std::vector<int> home_of_ldof;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    home_of_ldof.insert(home_of_ldof.end(), static_cast<std::size_t>(nodes[k].num_dofs), share.home[k]);
  const auto home_of = [&](int f) {
    return home_of_ldof[static_cast<std::size_t>(elimination.fdof_ldof[static_cast<std::size_t>(f)])];
  };
  std::vector<int> order(elimination.fdof_ldof.size()), place(order.size()), ldofs(order.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return home_of(a) < home_of(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto f = static_cast<std::size_t>(order[i]);
    place[f] = static_cast<int>(i);
    ldofs[i] = elimination.fdof_ldof[f];
    if (home_of(order[i]) < rank) ++share.first_fdof;
    if (home_of(order[i]) <= rank) ++share.last_fdof;
  }
  elimination.fdof_ldof = std::move(ldofs);
  SparseRows& C = elimination.C;
  std::vector<std::pair<int, double>> row;
  for (int l = 0; l < C.outerSize(); ++l) {
    const int begin = C.outerIndexPtr()[l], end = C.outerIndexPtr()[l + 1];
    row.clear();
    for (int i = begin; i < end; ++i)
      row.emplace_back(place[static_cast<std::size_t>(C.innerIndexPtr()[i])], C.valuePtr()[i]);
    std::sort(row.begin(), row.end());
    for (int i = begin; i < end; ++i)
      std::tie(C.innerIndexPtr()[i], C.valuePtr()[i]) = row[static_cast<std::size_t>(i - begin)];
  }
  return share;
}

}  // namespace bough::fe
