#include "fe/cards/maker.hpp"
#include "fe/elements/element.hpp"

namespace bough::fe {

ElementList make_elements(const records::Deck& deck, const NodeTable& nodes, Diagnostics& diagnostics) {
  ElementList list;
  list.elements.reserve(deck.beams.size() + deck.crod.size() + deck.conrod.size() + deck.ctube.size() +
                        deck.springs.size() + deck.cbush.size() + deck.scalar_masses.size() + deck.dampers.size() +
                        deck.cvisc.size() + deck.cbush1d.size() + deck.conm1.size() + deck.conm2.size() +
                        deck.shells.size() + deck.shear_panels.size() + deck.solids.size());
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
  return list;
}

}  // namespace bough::fe
