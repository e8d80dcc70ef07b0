#include "fe/cards/element_properties.hpp"

#include "formats/records/element_cards.hpp"

namespace bough::fe {

std::unordered_map<int, int> list_element_properties(const records::Deck& deck) {
  std::unordered_map<int, int> properties;
  for (const auto& kind : records::list_element_kinds())
    kind.visit_properties(deck, [&](int id, int property) {
      if (property > 0) properties[id] = property;
    });
  return properties;
}

}  // namespace bough::fe
