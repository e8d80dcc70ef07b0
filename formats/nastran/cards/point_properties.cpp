#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

void parse_pelas(Card& card, Reading& r) {
  for (const int first : {0, 4}) {
    if (first > 0 && card.is_blank(first, first + 4)) break;
    records::Pelas p;
    p.id = card.read_id(first, "PID");
    p.k = card.read_real(first + 1, "K", 0.0);
    p.ge = card.read_real(first + 2, "GE", 0.0);
    p.s = card.read_real(first + 3, "S", 0.0);
    p.at = card.get_location();
    if (r.claim(IdSpace::ElasProperty, p.id, card, first, 4)) r.deck.pelas.push_back(p);
  }
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
    if (flag == "RCV" || flag == "T") card.use(line + 2, line + 8);
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
  for (int first = 0; first < 8; first += 2) {
    if (first > 0 && card.is_blank(first, first + 2)) continue;
    records::Pmass p;
    p.id = card.read_id(first, "PID");
    p.m = card.read_real(first + 1, "M", 0.0);
    p.at = card.get_location();
    if (r.claim(IdSpace::MassProperty, p.id, card, first, 2)) r.deck.pmass.push_back(p);
  }
}

}  // namespace

void add_point_property_parsers(ParserTable& table) {
  table["PELAS"] = {parse_pelas, nullptr, "PID K GE S"};
  table["PELAS"].entry_size = 4;
  table["PBUSH"] = parse_pbush;
  table["PMASS"] = {parse_pmass, nullptr, "PID M"};
  table["PMASS"].entry_size = 2;
}

}  // namespace bough::nastran::detail
