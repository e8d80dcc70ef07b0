#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

void write_beam(const records::BeamElement& e, CardSink& sink) {
  CardFields card(e.is_cbeam ? "CBEAM" : "CBAR");
  card.add(e.id).add(e.pid).add(e.ga).add(e.gb);
  if (e.g0 != 0)
    card.add(e.g0).add_blank(2);
  else
    card.add(e.v);
  if (e.offt != "GGG")
    card.add_word(e.offt);
  else
    card.add_blank();
  card.add_components(e.pin_a).add_components(e.pin_b);
  const bool is_offset = !e.wa.isZero(0.0) || !e.wb.isZero(0.0);
  if (is_offset)
    card.add(e.wa).add(e.wb);
  else
    card.add_blank(6);
  if (e.is_cbeam) card.add_id(e.sa).add_id(e.sb);
  sink.put(card);
}

}  // namespace

void write_line_elements(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.beams) write_beam(e, sink);
  for (const auto& e : deck.crod) sink.put(CardFields("CROD").add(e.id).add(e.pid).add(e.ga).add(e.gb));
  for (const auto& e : deck.conrod)
    sink.put(CardFields("CONROD").add(e.id).add(e.ga).add(e.gb).add(e.mid).add(e.A).add(e.J).add(e.c).add(e.nsm));
  for (const auto& e : deck.ctube) sink.put(CardFields("CTUBE").add(e.id).add(e.pid).add(e.ga).add(e.gb));
  for (const auto& e : deck.plotel) sink.put(CardFields("PLOTEL").add(e.id).add(e.ga).add(e.gb));
}

}  // namespace bough::nastran::detail
