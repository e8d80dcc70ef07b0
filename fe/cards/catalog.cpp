#include "fe/cards/maker.hpp"
#include "fe/elements/element.hpp"
#include "formats/records/element_cards.hpp"

namespace bough::fe {

ElementList make_elements(const records::Deck& deck, const NodeTable& nodes, Diagnostics& diagnostics) {
  ElementList list;
  list.elements.reserve(records::count_elements(deck, records::ElementRole::Element));
  Maker maker(deck, nodes, diagnostics, list);
  make_beams(maker);
  make_rods(maker);
  make_springs(maker);
  make_line_dampers(maker);
  make_masses(maker);
  make_shells(maker);
  make_curved_shells(maker);
  make_shear_panels(maker);
  make_solids(maker);
  make_bends(maker);
  make_generals(maker);
  make_connectors(maker);
  return list;
}

}  // namespace bough::fe
