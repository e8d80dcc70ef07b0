#include <algorithm>

#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

using Recovery = std::array<Eigen::Vector2d, 4>;

void add_optional(CardFields& card, const std::optional<double>& value) {
  if (value)
    card.add(*value);
  else
    card.add_blank();
}

bool is_zero(const Recovery& points) {
  return std::all_of(points.begin(), points.end(), [](const auto& p) { return p.isZero(0.0); });
}

void add_recovery(CardFields& card, const Recovery& points) {
  for (const auto& p : points) card.add(p[0]).add(p[1]);
}

void add_section(CardFields& card, const records::PbeamStation& s) {
  card.add(s.A).add(s.I1).add(s.I2).add(s.I12).add(s.J).add(s.nsm);
}

/// A section of every station, so that nothing is left to the rules for blanks.
void write_pbeam(const records::Pbeam& p, CardSink& sink) {
  CardFields card("PBEAM");
  const auto& a = p.stations.front();
  card.add(p.id).add(p.mid);
  add_section(card, a);
  if (!is_zero(a.recovery)) add_recovery(card, a.recovery);
  for (std::size_t i = 1; i < p.stations.size(); ++i) {
    const auto& s = p.stations[i];
    const bool has_none = is_zero(s.recovery), is_as_a = s.recovery == a.recovery;
    card.add_word(has_none ? "NO" : is_as_a ? "YESA" : "YES").add(s.x_over_L);
    add_section(card, s);
    if (!has_none && !is_as_a) add_recovery(card, s.recovery);
  }
  add_optional(card, p.k1);
  add_optional(card, p.k2);
  const std::array<double, 14> rest{p.s1,   p.s2,   p.nsi_a, p.nsi_b, p.cw_a, p.cw_b, p.m1_a,
                                    p.m2_a, p.m1_b, p.m2_b,  p.n1_a,  p.n2_a, p.n1_b, p.n2_b};
  if (std::any_of(rest.begin(), rest.end(), [](double x) { return x != 0; }))
    for (const double x : rest) card.add(x);
  sink.put(card);
}

void write_beams(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pbar) {
    CardFields card("PBAR");
    card.add(p.id).add(p.mid).add(p.A).add(p.I1).add(p.I2).add(p.J).add(p.nsm).end_line();
    const bool more = p.k1 || p.k2 || p.I12 != 0;
    if (more || !is_zero(p.recovery)) add_recovery(card, p.recovery);
    if (more) {
      add_optional(card, p.k1);
      add_optional(card, p.k2);
      card.add(p.I12);
    }
    sink.put(card);
  }
  for (const auto& p : deck.pbarl) {
    CardFields card("PBARL");
    card.add(p.id).add(p.mid).add_blank().add_word(p.shape).end_line();
    for (const double dim : p.dims) card.add(dim);
    sink.put(card.add(p.nsm));
  }
  for (const auto& p : deck.pbeam) write_pbeam(p, sink);
  for (const auto& p : deck.pbeaml) {
    CardFields card("PBEAML");
    card.add(p.id).add(p.mid).add_blank().add_word(p.shape).end_line();
    for (std::size_t i = 0; i < p.stations.size(); ++i) {
      const auto& s = p.stations[i];
      if (i > 0) card.add_word("YES").add(s.x_over_L);
      for (const double dim : s.dims) card.add(dim);
      card.add(s.nsm);
    }
    sink.put(card);
  }
}

void write_pbush(const records::Pbush& p, CardSink& sink) {
  CardFields card("PBUSH");
  card.add(p.id);
  const auto add_six = [&](const char* flag, const std::array<double, 6>& values) {
    if (std::all_of(values.begin(), values.end(), [](double x) { return x == 0; })) return;
    // The first line begins with the id, the others with a blank.
    if (card.get_size() > 1) card.end_line().add_blank();
    card.add_word(flag);
    for (const double x : values) card.add(x);
  };
  add_six("K", p.k);
  add_six("B", p.b);
  add_six("GE", p.ge);
  if (p.mass != 0) {
    if (card.get_size() > 1) card.end_line().add_blank();
    card.add_word("M").add(p.mass);
  }
  sink.put(card);
}

}  // namespace

void write_properties(const records::Deck& deck, CardSink& sink) {
  write_beams(deck, sink);
  for (const auto& p : deck.prod)
    sink.put(CardFields("PROD").add(p.id).add(p.mid).add(p.A).add(p.J).add(p.c).add(p.nsm));
  for (const auto& p : deck.ptube) {
    CardFields card("PTUBE");
    card.add(p.id).add(p.mid).add(p.od).add(p.t).add(p.nsm);
    add_optional(card, p.od2);
    sink.put(card);
  }
  for (const auto& p : deck.pelas) sink.put(CardFields("PELAS").add(p.id).add(p.k).add(p.ge).add(p.s));
  for (const auto& p : deck.pbush) write_pbush(p, sink);
  for (const auto& p : deck.pmass) sink.put(CardFields("PMASS").add(p.id).add(p.m));
}

}  // namespace bough::nastran::detail
