#include <array>

#include "formats/nastran/detail/card_sink.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicLoad;
using Kind = records::DynamicLoad::Kind;

void add_set_or_number(CardFields& card, int set, double value) {
  if (set != 0)
    card.add(set);
  else
    card.add(value);
}

void write_load(const DynamicLoad& load, CardSink& sink) {
  static constexpr std::array names{"RLOAD1", "RLOAD2", "TLOAD1", "TLOAD2"};
  CardFields card(names[static_cast<std::size_t>(load.kind)]);
  card.add(load.sid).add(load.excite);
  add_set_or_number(card, load.delay_set, load.delay);
  if (load.kind == Kind::Rload1 || load.kind == Kind::Rload2) {
    add_set_or_number(card, load.phase_set, load.phase_deg);
    add_set_or_number(card, load.table_a, load.a);
    add_set_or_number(card, load.table_b, load.b);
  }
  card.add(static_cast<int>(load.excitation));
  if (load.kind == Kind::Tload1) add_set_or_number(card, load.table_a, load.a);
  if (load.kind == Kind::Tload2)
    card.add(load.t1).add(load.t2).add(load.frequency_hz).add(load.phase_deg).add(load.growth).add(load.power);
  sink.put(card);
}

void write_values(const char* name, const std::vector<records::DofValue>& values, CardSink& sink) {
  for (const auto& v : values) sink.put(CardFields(name).add(v.sid).add(v.g).add(v.c).add(v.value));
}

void add_points(CardFields& card, const std::vector<std::pair<double, double>>& points) {
  card.end_line();
  for (const auto& [x, y] : points) card.add(x).add(y);
  card.add_word("ENDT");
}

void write_table(const records::DynamicTable& t, CardSink& sink) {
  CardFields card("TABLED" + std::to_string(t.kind));
  card.add(t.id);
  if (t.kind == 1) card.add_word(t.is_log_x ? "LOG" : "LINEAR").add_word(t.is_log_y ? "LOG" : "LINEAR");
  if (t.kind > 1) card.add(t.x1);
  if (t.kind > 2) card.add(t.x2);
  if (t.kind == 4) {
    card.add(t.x3).add(t.x4).end_line();
    for (const double a : t.coefficients) card.add(a);
    card.add_word("ENDT");
  } else {
    add_points(card, t.points);
  }
  sink.put(card);
}

void write_frequencies(const records::FrequencyList& list, CardSink& sink) {
  CardFields card("FREQ" + (list.kind == 0 ? std::string() : std::to_string(list.kind)));
  card.add(list.sid);
  if (list.kind > 0) card.add(list.f1).add(list.f2);
  if (list.kind == 1 || list.kind == 2) card.add(list.count);
  if (list.kind == 3) card.add_word(list.is_log ? "LOG" : "LINEAR").add(list.count).add(list.spread);
  if (list.kind == 4) card.add(list.spread).add(list.count);
  for (const double value : list.values) card.add(value);
  sink.put(card);
}

}  // namespace

void write_dynamics(const records::Deck& deck, CardSink& sink) {
  const auto& d = deck.dynamics;
  for (const auto& load : d.loads) write_load(load, sink);
  for (const auto& sum : d.sums) {
    CardFields card("DLOAD");
    card.add(sum.sid).add(sum.s);
    for (const auto& [scale, set] : sum.terms) card.add(scale).add(set);
    sink.put(card);
  }
  write_values("DAREA", d.areas, sink);
  write_values("DELAY", d.delays, sink);
  write_values("DPHASE", d.phases, sink);
  for (const auto& s : d.lseq)
    sink.put(CardFields("LSEQ").add(s.sid).add(s.excite).add_id(s.load).add_id(s.temperature));
  for (const auto& m : d.initial) sink.put(CardFields("TIC").add(m.sid).add(m.g).add(m.c).add(m.u0).add(m.v0));
  for (const auto& t : d.tables) write_table(t, sink);
  for (const auto& t : d.damping) {
    CardFields card("TABDMP1");
    card.add(t.id).add_word(t.type);
    add_points(card, t.points);
    sink.put(card);
  }
  for (const auto& list : d.frequencies) write_frequencies(list, sink);
  for (const auto& steps : d.steps) {
    CardFields card("TSTEP");
    card.add(steps.sid);
    for (std::size_t i = 0; i < steps.parts.size(); ++i) {
      if (i > 0) card.end_line().add_blank();
      card.add(steps.parts[i].count).add(steps.parts[i].step).add(steps.parts[i].every);
    }
    sink.put(card);
  }
}

}  // namespace bough::nastran::detail
