#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

void write_pshell(const records::Pshell& p, CardSink& sink) {
  CardFields card("PSHELL");
  card.add(p.id).add_id(p.mid1);
  if (p.t)
    card.add(*p.t);
  else
    card.add_blank();
  card.add_id(p.mid2).add(p.bending_ratio).add_id(p.mid3);
  // 5/6 has no end in any field; it is the default.
  if (p.shear_ratio == 5.0 / 6)
    card.add_blank();
  else
    card.add(p.shear_ratio);
  sink.put(card.add(p.nsm).add_blank(2).add_id(p.mid4));
}

void write_pcomp(const records::Pcomp& p, CardSink& sink) {
  double total = 0;
  for (const auto& ply : p.plies) total += ply.t;
  CardFields card("PCOMP");
  card.add(p.id);
  if (p.z0 == -0.5 * total)
    card.add_blank();
  else
    card.add(p.z0);
  card.add(p.nsm).add_blank(2).add(p.tref).add(p.ge);
  if (!p.membrane || !p.bending)
    card.add_word(p.membrane ? "MEM" : "BEND");
  else if (p.layup != records::Layup::Stacked)
    card.add_word(p.layup == records::Layup::Smeared ? "SMEAR" : "SMCORE");
  else
    card.add_blank();
  for (const auto& ply : p.plies) card.add(ply.mid).add(ply.t).add(ply.theta_deg).add_blank();
  sink.put(card);
}

}  // namespace

void write_continua(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pshell) write_pshell(p, sink);
  for (const auto& p : deck.pcomp) write_pcomp(p, sink);
  for (const auto& p : deck.psolid) {
    CardFields card("PSOLID");
    card.add(p.id).add(p.mid).add_id(p.cordm).add_id(p.points);
    if (p.is_full || p.is_reduced) card.add_blank().add_word(p.is_full ? "FULL" : "REDUCED");
    sink.put(card);
  }
  for (const auto& e : deck.solids) {
    CardFields card(e.card);
    card.add(e.id).add(e.pid);
    for (const int grid : e.corners) card.add(grid);
    for (const int grid : e.midsides) card.add_id(grid);
    sink.put(card);
  }
}

}  // namespace bough::nastran::detail
