#include "fe/cards/element_properties.hpp"

namespace bough::fe {

std::unordered_map<int, int> list_element_properties(const records::Deck& deck) {
  std::unordered_map<int, int> properties;
  const auto add = [&](const auto& cards) {
    for (const auto& card : cards)
      if (card.pid > 0) properties[card.id] = card.pid;
  };
  add(deck.beams);
  add(deck.crod);
  add(deck.ctube);
  add(deck.springs);
  add(deck.cbush);
  add(deck.cbush1d);
  add(deck.dampers);
  add(deck.cvisc);
  add(deck.scalar_masses);
  add(deck.shells);
  add(deck.shear_panels);
  add(deck.solids);
  add(deck.special.cbend);
  add(deck.special.cgap);
  return properties;
}

}  // namespace bough::fe
