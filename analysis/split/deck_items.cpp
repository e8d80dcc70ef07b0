#include "analysis/split/deck_items.hpp"

#include <algorithm>

#include "formats/records/element_cards.hpp"

namespace bough::analysis::splitting {

namespace {

using records::ElementRole;

const std::vector<ElementRole>& get_roles(bool is_rigid) {
  static const std::vector<ElementRole> elements{ElementRole::Element, ElementRole::Drawn}, rigid{ElementRole::Rigid};
  return is_rigid ? rigid : elements;
}

DeckItem make_item(const records::ElementView& view) {
  DeckItem item{view.id, view.property,    view.card, view.grids,  view.is_grounded,
                false,   view.has_moments, view.at,   view.centre, {}};
  std::sort(item.grids.begin(), item.grids.end());
  item.grids.erase(std::unique(item.grids.begin(), item.grids.end()), item.grids.end());
  std::erase(item.grids, 0);
  return item;
}

std::vector<DeckItem> list_items(const records::Deck& deck, ElementRole role) {
  std::vector<DeckItem> items;
  items.reserve(records::count_elements(deck, role));
  records::visit_elements(deck, {role}, [&](const auto& view) { items.push_back(make_item(view)); });
  return items;
}

}  // namespace

std::vector<DeckItem> list_elements(const records::Deck& deck) {
  auto items = list_items(deck, ElementRole::Element);
  for (auto& item : list_items(deck, ElementRole::Drawn)) {
    item.is_drawn = true;
    items.push_back(std::move(item));
  }
  return items;
}

std::vector<DeckItem> list_rigid(const records::Deck& deck) { return list_items(deck, ElementRole::Rigid); }

void keep_elements(records::Deck& deck, const std::vector<char>& is_kept) {
  records::keep_elements(deck, get_roles(false), is_kept);
}
void keep_rigid(records::Deck& deck, const std::vector<char>& is_kept) {
  records::keep_elements(deck, get_roles(true), is_kept);
}

std::vector<int> list_reference_grids(const records::Deck& deck) {
  std::vector<int> grids;
  records::visit_elements(deck, {ElementRole::Element}, [&](const auto& view) { grids.push_back(view.orientation); });
  for (const auto& card : deck.special.cfast) grids.insert(grids.end(), {card.gs, card.ga, card.gb});
  for (const auto& card : deck.special.cweld) grids.insert(grids.end(), {card.gs, card.ga, card.gb});
  for (const auto& system : deck.coord_systems)
    if (system.by_grids) grids.insert(grids.end(), system.grids.begin(), system.grids.end());
  for (const auto& load : deck.load_cards.directed) grids.insert(grids.end(), load.grids.begin(), load.grids.end());
  for (const auto& load : deck.load_cards.rotations) grids.push_back(load.g);
  return grids;
}

std::vector<std::pair<int, unsigned>> list_dependent(const records::Deck& deck) {
  std::vector<std::pair<int, unsigned>> dependent;
  records::visit_elements(deck, get_roles(true), [&](const auto& view) {
    dependent.insert(dependent.end(), view.dependent.begin(), view.dependent.end());
  });
  std::erase_if(dependent, [](const auto& entry) { return entry.second == 0; });
  return dependent;
}

std::string name_item(const DeckItem& item) { return item.card + " " + std::to_string(item.id); }

}  // namespace bough::analysis::splitting
