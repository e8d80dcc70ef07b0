#pragma once
/// \file Plain load sets that a load selection of the case control stands for. Constraints need them for SPCD.
#include <utility>
#include <vector>

#include "fe/elements/element.hpp"

namespace bough::fe {

/// A plain set among the terms of a LOAD card.
struct PlainLoadSet {
  int sid = 0;
  double scale = 1;
  records::CardLocation at;    ///< of the LOAD card that names it; empty: the case control selects the set itself
  bool enforced_only = false;  ///< use only its SPCD cards, whose id is that of a LOAD card
  bool is_circle = false;      ///< a LOAD card that names itself through its terms
};

/// Plain sets of `set`: itself, or the terms of its LOAD card. A term with cards is a plain set; a term that is a LOAD
/// card only stands for the terms of that card.
std::vector<PlainLoadSet> list_plain_sets(const records::Deck& deck, int set);

/// Calls visit(set, scale, card) for each plain set with loads.
template <class Visit>
void for_each_plain_set(const records::Deck& deck, int set, const Visit& visit) {
  for (const auto& plain : list_plain_sets(deck, set))
    if (!plain.enforced_only) visit(plain.sid, plain.scale, plain.at);
}

/// Returns true if the set has cards that load, other than LOAD.
bool has_loading_cards(const records::Deck& deck, int set);
/// Returns true if the set has load cards other than LOAD, SPCD among them.
bool has_load_cards(const records::Deck& deck, int set);
bool has_enforced(const records::Deck& deck, int set);  ///< SPCD cards
/// LOAD card with this id; nullptr: none.
const records::LoadCombination* find_combination(const records::Deck& deck, int set);

/// DOFs that the SPCD cards of load set `set` move (rows of the l-set), each with its card. Grids that do not exist are
/// reported by calc_enforced().
std::vector<std::pair<int, const records::Spcd*>> list_spcd_dofs(const NodeTable& nodes, const records::Deck& deck,
                                                                 int set);

}  // namespace bough::fe
