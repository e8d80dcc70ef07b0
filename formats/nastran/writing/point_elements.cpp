#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

/// "CELAS" or "CMASS" with its number: 1 and 2 name grid and component, 3 and 4 scalar points; odd ones a property.
template <class Element>
CardFields make_scalar_card(const char* stem, const Element& e, double value) {
  const int number = (e.by_scalar_points ? 3 : 1) + (e.pid > 0 ? 0 : 1);
  CardFields card(stem + std::to_string(number));
  card.add(e.id);
  if (e.pid > 0)
    card.add(e.pid);
  else
    card.add(value);
  if (e.by_scalar_points)
    card.add_id(e.g1).add_id(e.g2);
  else
    card.add_id(e.g1).add_id(e.c1).add_id(e.g2).add_id(e.c2);
  return card;
}

void write_cbush(const records::Cbush& e, CardSink& sink) {
  CardFields card("CBUSH");
  card.add(e.id).add(e.pid).add(e.ga).add_id(e.gb);
  if (e.g0 != 0)
    card.add(e.g0).add_blank(2);
  else if (e.v)
    card.add(*e.v);
  else
    card.add_blank(3);
  if (e.cid)
    card.add(*e.cid);
  else
    card.add_blank();
  if (e.s != 0.5 || e.ocid != -1 || !e.s_offset.isZero(0.0)) card.add(e.s).add(e.ocid).add(e.s_offset);
  sink.put(card);
}

}  // namespace

void write_point_elements(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.springs) {
    auto card = make_scalar_card("CELAS", e, e.k);
    if (e.pid == 0 && !e.by_scalar_points && (e.ge != 0 || e.s != 0)) card.add(e.ge).add(e.s);
    sink.put(card);
  }
  for (const auto& e : deck.cbush) write_cbush(e, sink);
  for (const auto& e : deck.scalar_masses) sink.put(make_scalar_card("CMASS", e, e.m));
  for (const auto& e : deck.conm1) {
    CardFields card("CONM1");
    card.add(e.id).add(e.g).add_id(e.cid);
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column <= row; ++column) card.add(e.m(row, column));
    sink.put(card);
  }
  for (const auto& e : deck.conm2) {
    CardFields card("CONM2");
    card.add(e.id).add(e.g).add_id(e.cid).add(e.m).add(e.x).end_line();
    for (const double value : e.inertia) card.add(value);
    sink.put(card);
  }
}

}  // namespace bough::nastran::detail
