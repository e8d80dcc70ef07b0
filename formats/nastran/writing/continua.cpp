#include <set>

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
  card.add(p.nsm);
  for (const auto& z : {p.z1, p.z2}) z ? card.add(*z) : card.add_blank();
  sink.put(card.add_id(p.mid4));
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
  card.add(p.nsm);
  p.sb != 0 ? card.add(p.sb) : card.add_blank();
  p.failure.empty() ? card.add_blank() : card.add_word(p.failure);
  card.add(p.tref).add(p.ge);
  if (!p.membrane || !p.bending)
    card.add_word(p.membrane ? "MEM" : "BEND");
  else if (p.layup != records::Layup::Stacked)
    card.add_word(p.layup == records::Layup::Smeared ? "SMEAR" : "SMCORE");
  else
    card.add_blank();
  for (const auto& ply : p.plies) card.add(ply.mid).add(ply.t).add(ply.theta_deg).add_blank();
  sink.put(card);
}

/// CIHEX3 in its own order: rings of corners and thirds, the thirds of the upright edges between them.
void write_cubic(const records::SolidElement& e, CardSink& sink) {
  const auto third = [&](int edge, int k) { return e.midsides[static_cast<std::size_t>(2 * edge + k)]; };
  CardFields card("CIHEX3");
  card.add(e.id).add(e.pid);
  const auto add_ring = [&](int first_corner, int first_edge) {
    for (int i = 0; i < 4; ++i)
      card.add(e.corners[static_cast<std::size_t>(first_corner + i)])
          .add(third(first_edge + i, 0))
          .add(third(first_edge + i, 1));
  };
  add_ring(0, 0);
  for (const int k : {0, 1})
    for (int edge = 4; edge < 8; ++edge) card.add(third(edge, k));
  add_ring(4, 8);
  sink.put(card);
}

/// Properties that cubic bricks alone have stand as PIHEX, which those want.
std::set<int> find_cubic_properties(const records::Deck& deck) {
  std::set<int> cubic;
  for (const auto& e : deck.solids)
    if (e.card == "CIHEX3") cubic.insert(e.pid);
  return cubic;
}

}  // namespace

void write_continua(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pshell) write_pshell(p, sink);
  for (const auto& p : deck.pcomp) write_pcomp(p, sink);
  const auto cubic = find_cubic_properties(deck);
  for (const auto& p : deck.psolid) {
    if (cubic.count(p.id) > 0) {  // the reader gives no property to both kinds
      sink.put(CardFields("PIHEX").add(p.id).add(p.mid).add_id(p.cordm).add(p.points > 0 ? p.points : 4));
      continue;
    }
    CardFields card("PSOLID");
    card.add(p.id).add(p.mid).add_id(p.cordm).add_id(p.points);
    if (p.is_full || p.is_reduced) card.add_blank().add_word(p.is_full ? "FULL" : "REDUCED");
    sink.put(card);
  }
  for (const auto& e : deck.solids) {
    if (e.card == "CIHEX3") {
      write_cubic(e, sink);
      continue;
    }
    CardFields card(e.card);
    card.add(e.id).add(e.pid);
    for (const int grid : e.corners) card.add(grid);
    for (const int grid : e.midsides) card.add_id(grid);
    sink.put(card);
  }
}

}  // namespace bough::nastran::detail
