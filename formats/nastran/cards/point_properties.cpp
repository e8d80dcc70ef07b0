#include <algorithm>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

void parse_pelas(Card& card, Reading& r) {
  read_entries(card, 4, {0, 4}, [&](int first) {
    records::Pelas p;
    p.id = card.read_id(first, "PID");
    card.read_reals(first + 1, {{"K", p.k, 0.0}, {"GE", p.ge, 0.0}, {"S", p.s, 0.0}});
    p.at = card.get_location();
    if (r.claim(IdSpace::ElasProperty, p.id, card, first, 4)) r.deck.pelas.push_back(p);
  });
}

void read_six(Card& card, int first, const char* what, std::array<double, 6>& values) {
  for (int i = 0; i < 6; ++i) values[static_cast<std::size_t>(i)] = card.read_real(first + i, what, 0.0);
}

/// Lines of a flag and six values. A single GE1 stands for all six directions.
void parse_pbush(Card& card, Reading& r) {
  records::Pbush p;
  p.id = card.read_id(0, "PID");
  p.at = card.get_location();
  for (int line = 0; line < card.get_size(); line += 8) {
    if (line > 0) card.demand(card.is_blank(line), line, "the field before the flag", "a blank");
    if (card.is_blank(line + 1)) {
      if (!card.is_blank(line + 2, line + 8))
        card.fail("deck.missing-field", line + 1, "values without a flag K, B, GE, RCV or M");
      continue;
    }
    const auto flag = card.read_word(line + 1, "flag", "", {"K", "B", "GE", "RCV", "M", "T"});
    if (flag == "T") card.use(line + 2, line + 8);
    if (flag == "RCV") {
      static constexpr const char* names[] = {"SA", "ST", "EA", "ET"};
      for (int i = 0; i < 4; ++i) p.rcv[static_cast<std::size_t>(i)] = card.read_real(line + 2 + i, names[i], 1.0);
      card.use(line + 6, line + 8);
    }
    if (flag == "K") read_six(card, line + 2, "K1 to K6", p.k);
    if (flag == "B") read_six(card, line + 2, "B1 to B6", p.b);
    if (flag == "GE") {
      read_six(card, line + 2, "GE1 to GE6", p.ge);
      if (card.is_blank(line + 3, line + 8)) p.ge.fill(p.ge[0]);
    }
    if (flag == "M") p.mass = card.read_real(line + 2, "M", 0.0);
  }
  if (r.claim(IdSpace::BushProperty, p.id, card)) r.deck.pbush.push_back(p);
}

void parse_pmass(Card& card, Reading& r) {
  read_values(card, "M", [&](int id, double m, int first) {
    if (r.claim(IdSpace::MassProperty, id, card, first, 2)) r.deck.pmass.push_back({id, m, card.get_location()});
  });
}

void write_pelas(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pelas) sink.put(CardFields("PELAS").add(p.id).add(p.k).add(p.ge).add(p.s));
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
  if (p.rcv != records::Pbush{}.rcv) {
    if (card.get_size() > 1) card.end_line().add_blank();
    card.add_word("RCV");
    for (const double x : p.rcv) card.add(x);
  }
  if (p.mass != 0) {
    if (card.get_size() > 1) card.end_line().add_blank();
    card.add_word("M").add(p.mass);
  }
  sink.put(card);
}

void write_pbushes(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pbush) write_pbush(p, sink);
}

void write_pmass(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pmass) sink.put(CardFields("PMASS").add(p.id).add(p.m));
}

void convert_pelas(UnitConverter& u) {
  for (int first = 0; first < std::min(u.size(), 8); first += 4) {
    if (u.get(first).empty()) continue;
    u.scale_by(u.find_property_motion("CELAS", u.get(first)), first + 1, "K", "Q", "?");
    u.scale(first + 3, "?");
  }
}
void convert_pmass(UnitConverter& u) {
  for (int first = 0; first < std::min(u.size(), 8); first += 2)
    if (!u.get(first).empty()) u.scale_by(u.find_property_motion("CMASS", u.get(first)), first + 1, "M", "J", "ML");
}
void convert_pbush(UnitConverter& u) {
  for (int line = 0; line < u.size(); line += 8) {
    const auto flag = make_upper(u.get(line + 1));
    if (flag == "K" || flag == "B") {
      u.scale(line + 2, line + 4, flag == "K" ? "K" : "B");
      u.scale(line + 5, line + 7, flag == "K" ? "Q" : "BR");
    } else if (flag == "M") {
      u.scale(line + 2, "M");
    } else if (flag != "GE" && !flag.empty()) {
      u.scale(line + 2, line + 7, "?");
    }
  }
}

}  // namespace

void add_point_property_parsers(ParserTable& table) {
  table["PELAS"] = {parse_pelas, nullptr, "PID K GE S"};
  table["PELAS"].entry_size = 4;
  table["PBUSH"] = {parse_pbush, nullptr};
  table["PMASS"] = {parse_pmass, nullptr, "PID M"};
  table["PMASS"].entry_size = 2;
  table["PELAS"].convert = convert_pelas;
  table["PBUSH"].convert = convert_pbush;
  table["PMASS"].convert = convert_pmass;
  write_by(table, {{"PELAS", write_pelas}, {"PBUSH", write_pbushes}, {"PMASS", write_pmass}});
}

}  // namespace bough::nastran::detail
