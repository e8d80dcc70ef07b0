#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

void write_pbcomp(const records::Pbcomp& p, CardSink& sink) {
  CardFields card("PBCOMP");
  card.add(p.id).add(p.mid).add(p.A).add(p.I1).add(p.I2).add(p.I12).add(p.J).add(p.nsm);
  card.add(p.k1).add(p.k2).add(p.m[0]).add(p.m[1]).add(p.n[0]).add(p.n[1]).add(p.section);
  for (const auto& lump : p.lumps) card.end_line().add(lump.r[0]).add(lump.r[1]).add(lump.fraction).add(lump.mid);
  sink.put(card);
}

void add_pairs(CardFields& card, const std::vector<records::GridComponent>& pairs) {
  for (const auto& pair : pairs) card.add(pair.g).add(pair.c);
}

void write_genel(const records::Genel& e, CardSink& sink) {
  CardFields card("GENEL");
  card.add(e.id).add_blank();
  add_pairs(card, e.ui);
  if (!e.ud.empty()) {
    card.end_line().add_word("UD").add_blank();
    add_pairs(card, e.ud);
  }
  card.end_line().add_word(e.is_flexibility ? "Z" : "K");
  for (Eigen::Index column = 0; column < e.matrix.cols(); ++column)
    for (Eigen::Index row = column; row < e.matrix.rows(); ++row) card.add(e.matrix(row, column));
  if (e.s.size() > 0) {
    card.end_line().add_word("S");
    for (Eigen::Index row = 0; row < e.s.rows(); ++row)
      for (Eigen::Index column = 0; column < e.s.cols(); ++column) card.add(e.s(row, column));
  }
  sink.put(card);
}

void write_cgap(const records::Cgap& e, CardSink& sink) {
  CardFields card("CGAP");
  card.add(e.id).add(e.pid).add(e.ga).add(e.gb);
  if (e.v)
    card.add(*e.v);
  else
    card.add_id(e.g0).add_blank(2);
  if (e.cid) card.add(*e.cid);
  sink.put(card);
}

void write_cbend(const records::Cbend& e, CardSink& sink) {
  CardFields card("CBEND");
  card.add(e.id).add(e.pid).add(e.ga).add(e.gb);
  if (e.g0 != 0)
    card.add(e.g0).add_blank(2);
  else
    card.add(e.v);
  sink.put(card.add(e.geom));
}

void write_pbend(const records::Pbend& p, CardSink& sink) {
  CardFields card("PBEND");
  card.add(p.id).add(p.mid);
  if (p.is_pipe)
    card.add(p.fsi).add(p.rm).add(p.t).add(p.pressure);
  else
    card.add(p.A).add(p.I1).add(p.I2).add(p.J);
  card.add(p.rb).add(p.theta_b_deg);
  if (p.is_pipe)
    card.add_blank(2);
  else
    card.add_blank(8).add(p.k1).add(p.k2);
  card.add(p.nsm).add(p.rc).add(p.zc);
  if (p.delta_n) card.add(*p.delta_n);
  sink.put(card);
}

void write_nsm(const records::NonstructuralMass& m, CardSink& sink) {
  CardFields card(m.is_total ? "NSML1" : "NSM1");
  card.add(m.sid).add_word(m.type).add(m.value);
  if (m.is_all) card.add_word("ALL");
  // A card each: a range stands alone on its card.
  if (m.is_all) return sink.put(card);
  for (const auto& [first, last] : m.range) {
    card.add(first);
    if (last > first) card.add_word("THRU").add(last);
  }
  sink.put(card);
}

void write_acceleration(const records::GridAcceleration& a, CardSink& sink) {
  CardFields card(a.direction < 0 ? "ACCEL1" : "ACCEL");
  card.add(a.sid).add_id(a.cid);
  if (a.direction >= 0) {
    card.add(a.n).add_word(std::string(1, static_cast<char>('X' + a.direction))).end_line();
    for (const auto& [place, value] : a.table) card.add(place).add(value);
    return sink.put(card);
  }
  card.add(a.a).add(a.n).end_line();
  if (a.is_all) card.add_word("ALL");
  for (std::size_t i = 0; i < a.grids.size(); ++i) {
    std::size_t last = i;
    while (a.skip_if_missing && last + 1 < a.grids.size() && a.grids[last + 1] == a.grids[last] + 1) ++last;
    card.add(a.grids[i]);
    if (last > i) card.add_word("THRU").add(a.grids[last]);
    i = last;
  }
  sink.put(card);
}

}  // namespace

void write_special(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.special.pbcomp) write_pbcomp(p, sink);
  for (const auto& e : deck.special.genel) write_genel(e, sink);
  for (const auto& e : deck.special.cbend) write_cbend(e, sink);
  for (const auto& p : deck.special.pbend) write_pbend(p, sink);
  for (const auto& e : deck.special.cgap) write_cgap(e, sink);
  for (const auto& p : deck.special.pgap)
    sink.put(CardFields("PGAP").add(p.id).add(p.u0).add(p.f0).add(p.ka).add(p.kb).add(p.kt));
  for (const auto& m : deck.special.nsm) write_nsm(m, sink);
  for (const auto& [sid, sets] : deck.special.nsmadd) {
    CardFields card("NSMADD");
    card.add(sid);
    for (const int set : sets) card.add(set);
    sink.put(card);
  }
  for (const auto& e : deck.special.rspline) {
    CardFields card("RSPLINE");
    card.add(e.id).add(e.ratio).add(e.points.front().g);
    for (std::size_t i = 1; i < e.points.size(); ++i) card.add(e.points[i].g).add_components(e.points[i].c);
    sink.put(card);
  }
  for (const auto& a : deck.special.accelerations) write_acceleration(a, sink);
}

}  // namespace bough::nastran::detail
