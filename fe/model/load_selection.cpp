#include "fe/model/load_selection.hpp"

#include <algorithm>

namespace bough::fe {

bool has_enforced(const records::Deck& deck, int set) {
  const auto& spcd = deck.load_cards.spcd;
  return std::any_of(spcd.begin(), spcd.end(), [set](const auto& s) { return s.sid == set; });
}

bool has_loading_cards(const records::Deck& deck, int set) {
  const auto in = [set](const auto& cards) {
    return std::any_of(cards.begin(), cards.end(), [set](const auto& card) { return card.sid == set; });
  };
  const auto& c = deck.load_cards;
  return in(deck.point_loads) || in(deck.gravity) || in(c.directed) || in(c.beams) || in(c.grid_pressures) ||
         std::any_of(deck.super.seload.begin(), deck.super.seload.end(),
                     [set](const auto& s) { return s.set == set; }) ||
         in(deck.special.accelerations) || in(c.pressures) || in(c.rotations) || in(c.scalar);
}

bool has_load_cards(const records::Deck& deck, int set) {
  return has_loading_cards(deck, set) || has_enforced(deck, set);
}

const records::LoadCombination* find_combination(const records::Deck& deck, int set) {
  const auto found = std::find_if(deck.loads.begin(), deck.loads.end(), [set](const auto& l) { return l.sid == set; });
  return found == deck.loads.end() ? nullptr : &*found;
}

namespace {

/// `open`: the LOAD cards that lead to `card`; none of them is entered again.
void add_plain_sets(const records::Deck& deck, const records::LoadCombination& card, double factor,
                    std::vector<int>& open, std::vector<PlainLoadSet>& sets) {
  open.push_back(card.sid);
  for (const auto& [scale, sid] : card.terms) {
    const auto* nested = has_load_cards(deck, sid) ? nullptr : find_combination(deck, sid);
    const bool is_circle = nested && std::find(open.begin(), open.end(), sid) != open.end();
    if (nested && !is_circle)
      add_plain_sets(deck, *nested, factor * card.s * scale, open, sets);
    else
      sets.push_back({sid, factor * card.s * scale, card.at, false, is_circle});
  }
  open.pop_back();
}

}  // namespace

std::vector<PlainLoadSet> list_plain_sets(const records::Deck& deck, int set) {
  const auto* card = find_combination(deck, set);
  if (!card) return {{set, 1.0, {}, false, false}};
  std::vector<PlainLoadSet> sets;
  // SPCD cards have the id that the case control selects, next to the LOAD card (Quick Reference Guide, LOAD).
  if (has_enforced(deck, set)) sets.push_back({set, 1.0, card->at, true, false});
  std::vector<int> open;
  add_plain_sets(deck, *card, 1, open, sets);
  return sets;
}

std::vector<std::pair<int, const records::Spcd*>> list_spcd_dofs(const NodeTable& nodes, const records::Deck& deck,
                                                                 int set) {
  std::vector<std::pair<int, const records::Spcd*>> dofs;
  if (set == 0 || deck.load_cards.spcd.empty()) return dofs;
  for (const auto& plain : list_plain_sets(deck, set)) {
    for (const auto& card : deck.load_cards.spcd) {
      const int index = card.sid == plain.sid ? nodes.find_node(card.g) : -1;
      if (index < 0) continue;
      const Node& where = nodes.node(index);
      for (int c = 0; c < where.num_dofs; ++c)
        if (where.num_dofs == 1 || (card.c >> c & 1u)) dofs.emplace_back(where.first_gdof + c, &card);
    }
  }
  return dofs;
}

}  // namespace bough::fe
