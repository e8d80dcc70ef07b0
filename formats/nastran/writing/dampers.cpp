#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {

void write_dampers(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pdamp) sink.put(CardFields("PDAMP").add(p.id).add(p.b));
  for (const auto& p : deck.pvisc) sink.put(CardFields("PVISC").add(p.id).add(p.ce).add(p.cr));
  for (const auto& p : deck.pbush1d) sink.put(CardFields("PBUSH1D").add(p.id).add(p.k).add(p.c).add(p.m));
  for (const auto& e : deck.dampers) {
    CardFields card("CDAMP" + std::to_string((e.by_scalar_points ? 3 : 1) + (e.pid > 0 ? 0 : 1)));
    card.add(e.id);
    if (e.pid > 0)
      card.add(e.pid);
    else
      card.add(e.b);
    if (e.by_scalar_points)
      card.add_id(e.g1).add_id(e.g2);
    else
      card.add_id(e.g1).add_id(e.c1).add_id(e.g2).add_id(e.c2);
    sink.put(card);
  }
  for (const auto& e : deck.cvisc) sink.put(CardFields("CVISC").add(e.id).add(e.pid).add(e.ga).add(e.gb));
  for (const auto& e : deck.cbush1d) {
    CardFields card("CBUSH1D");
    card.add(e.id).add(e.pid).add(e.ga).add_id(e.gb);
    if (e.cid) card.add(*e.cid);
    sink.put(card);
  }
}

}  // namespace bough::nastran::detail
