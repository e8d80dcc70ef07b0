#include <algorithm>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

using records::ScalarDamper;

/// EID, PID or B.
ScalarDamper read_head(Card& card, bool by_property, int first = 0) {
  ScalarDamper e;
  e.id = card.read_id(first, "EID");
  if (by_property)
    e.pid = card.read_id(first + 1, "PID", e.id);
  else
    e.b = card.read_real(first + 1, "B", 0.0);
  e.at = card.get_location();
  return e;
}

void add_damper(Card& card, Reading& r, const ScalarDamper& e, int first = 0, int num_fields = 1 << 20) {
  if (e.g1 == 0 && e.g2 == 0 && card.is_ok())
    card.fail("deck.missing-field", first + 2, "both ends are blank, expected one at least");
  if (r.claim(IdSpace::Damper, e.id, card, first, num_fields)) r.deck.dampers.push_back(e);
}

/// G1 C1 G2 C2; a blank grid is ground.
void parse_on_grids(Card& card, Reading& r, bool by_property) {
  auto e = read_head(card, by_property);
  e.g1 = card.read_reference(2, "G1");
  e.c1 = card.read_component(3, "C1");
  e.g2 = card.read_reference(4, "G2");
  e.c2 = card.read_component(5, "C2");
  add_damper(card, r, e);
}
void parse_cdamp1(Card& card, Reading& r) { parse_on_grids(card, r, true); }
void parse_cdamp2(Card& card, Reading& r) { parse_on_grids(card, r, false); }

/// S1 S2, one or two dampers on a card: points that no SPOINT names become ones.
void parse_on_points(Card& card, Reading& r, bool by_property) {
  for (const int first : {0, 4}) {
    if (first > 0 && card.is_blank(first, first + 4)) break;
    auto e = read_head(card, by_property, first);
    e.g1 = card.read_reference(first + 2, "S1");
    e.g2 = card.read_reference(first + 3, "S2");
    e.by_scalar_points = true;
    for (const int point : {e.g1, e.g2})
      if (point > 0 && card.is_ok()) r.deck.scalar_points.push_back(point);
    add_damper(card, r, e, first, 4);
  }
}
void parse_cdamp3(Card& card, Reading& r) { parse_on_points(card, r, true); }
void parse_cdamp4(Card& card, Reading& r) { parse_on_points(card, r, false); }

void parse_pdamp(Card& card, Reading& r) {
  read_values(card, "B", [&](int id, double b, int first) {
    if (r.claim(IdSpace::DampProperty, id, card, first, 2)) r.deck.pdamp.push_back({id, b, card.get_location()});
  });
}

/// EID PID G1 G2, one or two on a card.
void parse_cvisc(Card& card, Reading& r) {
  read_entries(card, 4, {0, 4}, [&](int first) {
    records::Cvisc e;
    card.read_ids(first, {{"EID", e.id}, {"PID", e.pid, &e.id}, {"G1", e.ga}, {"G2", e.gb}});
    e.at = card.get_location();
    if (r.claim(IdSpace::Visc, e.id, card, first, 4)) r.deck.cvisc.push_back(e);
  });
}

void parse_pvisc(Card& card, Reading& r) {
  read_entries(card, 3, {0, 4}, [&](int first) {
    records::Pvisc p;
    p.id = card.read_id(first, "PID");
    card.read_reals(first + 1, {{"CE", p.ce, 0.0}, {"CR", p.cr, 0.0}});
    p.at = card.get_location();
    if (r.claim(IdSpace::ViscProperty, p.id, card, first, 3)) r.deck.pvisc.push_back(p);
  });
}

void parse_cbush1d(Card& card, Reading& r) {
  records::Cbush1d e;
  card.read_ids(0, {{"EID", e.id}, {"PID", e.pid, &e.id}, {"GA", e.ga}});
  e.gb = card.read_reference(3, "GB");
  if (!card.is_blank(4)) e.cid = card.read_reference(4, "CID");
  e.at = card.get_location();
  if (e.gb == 0 && !e.cid && card.is_ok())
    card.fail("deck.missing-field", 4, "CID is blank, expected the system of a spring to ground",
              "give CID, or the grid GB");
  if (r.claim(IdSpace::Bush1d, e.id, card)) r.deck.cbush1d.push_back(e);
}

/// K C M of the linear part. Lines of SHOCKA, SPRING, DAMPER, GENER hold tables and equations of nonlinear motion.
void parse_pbush1d(Card& card, Reading& r) {
  records::Pbush1d p;
  p.id = card.read_id(0, "PID");
  card.read_reals(1, {{"K", p.k, 0.0}, {"C", p.c, 0.0}, {"M", p.m, 0.0}});
  card.use(4, 6);                // SA, SE
  card.use(8, card.get_size());  // the lines below
  p.at = card.get_location();
  for (int line = 8; line < card.get_size(); line += 8) {
    if (card.is_blank(line)) continue;  // further fields of SHOCKA
    const auto part = card.read_word(line, "the part", "", {"SHOCKA", "SPRING", "DAMPER", "GENER"});
    if (!part.empty())
      card.warn("deck.nonlinear-part", line, part + " of PBUSH1D " + std::to_string(p.id) + " is not used",
                "the element has K, C and M of the first line alone");
  }
  if (r.claim(IdSpace::Bush1dProperty, p.id, card)) r.deck.pbush1d.push_back(p);
}

void write_pdamp(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pdamp) sink.put(CardFields("PDAMP").add(p.id).add(p.b));
}

void write_pvisc(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pvisc) sink.put(CardFields("PVISC").add(p.id).add(p.ce).add(p.cr));
}

void write_pbush1d(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pbush1d) sink.put(CardFields("PBUSH1D").add(p.id).add(p.k).add(p.c).add(p.m));
}

void write_dampers(const records::Deck& deck, CardSink& sink) {
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
}

void write_cvisc(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.cvisc) sink.put(CardFields("CVISC").add(e.id).add(e.pid).add(e.ga).add(e.gb));
}

void write_cbush1d(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.cbush1d) {
    CardFields card("CBUSH1D");
    card.add(e.id).add(e.pid).add(e.ga).add_id(e.gb);
    if (e.cid) card.add(*e.cid);
    sink.put(card);
  }
}

void convert_cdamp2(UnitConverter& u) { u.scale_by(u.find_scalar_motion(), 1, "B", "BR", "BL"); }
void convert_pdamp(UnitConverter& u) {
  for (int first = 0; first < std::min(u.size(), 8); first += 2)
    if (!u.get(first).empty()) u.scale_by(u.find_property_motion("CDAMP", u.get(first)), first + 1, "B", "BR", "BL");
}
/// Fields after those of the linear spring are its nonlinear parts.
void convert_pbush1d(UnitConverter& u) {
  u.scale_words();
  u.scale(8, u.size() - 1, "?");
}

}  // namespace

void add_damper_parsers(ParserTable& table) {
  table["CDAMP1"] = {parse_cdamp1, "", "EID PID G1 C1 G2 C2"};
  table["CDAMP2"] = {parse_cdamp2, nullptr, "EID B G1 C1 G2 C2"};
  table["CDAMP3"] = {parse_cdamp3, ""};
  table["CDAMP4"] = {parse_cdamp4, ". ? . . . ? . ."};
  table["PDAMP"] = {parse_pdamp, nullptr, "PID B"};
  table["PDAMP"].entry_size = 2;
  table["CVISC"] = {parse_cvisc, "", "EID PID G1 G2"};
  table["PVISC"] = {parse_pvisc, ". B BR . . B BR .", "PID CE CR"};
  table["PVISC"].entry_size = 4;
  table["CBUSH1D"] = {parse_cbush1d, "", "EID PID GA GB CID"};
  table["PBUSH1D"] = {parse_pbush1d, ". K B M . . . .", "PID K C M"};
  table["CDAMP1"].note = note_scalar_element;
  table["CDAMP3"].note = note_scalar_points;
  table["CDAMP2"].convert = convert_cdamp2;
  table["PDAMP"].convert = convert_pdamp;
  table["PBUSH1D"].convert = convert_pbush1d;
  write_by(table, {{"PDAMP", write_pdamp}, {"PVISC", write_pvisc}, {"PBUSH1D", write_pbush1d}});
  write_by(table, write_dampers, {"CDAMP1", "CDAMP2", "CDAMP3", "CDAMP4"});
  write_by(table, write_cvisc, {"CVISC"});
  write_by(table, write_cbush1d, {"CBUSH1D"});
}

}  // namespace bough::nastran::detail
