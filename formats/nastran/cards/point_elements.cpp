#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

/// G1 C1 G2 C2 of springs and masses from field i on; a blank grid is ground.
template <class Element>
void read_ends(Card& card, int i, Element& e) {
  e.g1 = card.read_reference(i, "G1");
  e.c1 = card.read_component(i + 1, "C1");
  e.g2 = card.read_reference(i + 2, "G2");
  e.c2 = card.read_component(i + 3, "C2");
  if (e.g1 == 0 && e.g2 == 0 && card.is_ok())
    card.fail("deck.missing-field", i, "G1 and G2 are both blank, expected one at least");
}

/// EID PID G1 C1 G2 C2.
template <class Element>
void parse_by_property(Card& card, Reading& r, IdSpace space, std::vector<Element>& elements) {
  Element e;
  card.read_ids(0, {{"EID", e.id}, {"PID", e.pid, &e.id}});
  read_ends(card, 2, e);
  e.at = card.get_location();
  if (r.claim(space, e.id, card)) elements.push_back(e);
}
void parse_celas1(Card& card, Reading& r) { parse_by_property(card, r, IdSpace::Spring, r.deck.springs); }
void parse_cmass1(Card& card, Reading& r) { parse_by_property(card, r, IdSpace::ScalarMass, r.deck.scalar_masses); }

void parse_celas2(Card& card, Reading& r) {
  records::ScalarSpring e;
  e.id = card.read_id(0, "EID");
  e.k = card.read_real(1, "K", 0.0);
  read_ends(card, 2, e);
  e.ge = card.read_real(6, "GE", 0.0);
  e.s = card.read_real(7, "S", 0.0);
  e.at = card.get_location();
  if (r.claim(IdSpace::Spring, e.id, card)) r.deck.springs.push_back(e);
}

void parse_cmass2(Card& card, Reading& r) {
  records::ScalarMass e;
  e.id = card.read_id(0, "EID");
  e.m = card.read_real(1, "M", 0.0);
  read_ends(card, 2, e);
  e.at = card.get_location();
  if (r.claim(IdSpace::ScalarMass, e.id, card)) r.deck.scalar_masses.push_back(e);
}

/// EID, PID or value, S1 S2 of CELAS3/4 and CMASS3/4, one or two on a card: a point that no SPOINT names becomes one.
template <class Element>
void parse_scalar_pairs(Card& card, Reading& r, bool by_property, double Element::*value, IdSpace space,
                        std::vector<Element>& elements) {
  for (const int first : {0, 4}) {
    if (first > 0 && card.is_blank(first, first + 4)) break;
    Element e;
    e.id = card.read_id(first, "EID");
    if (by_property)
      e.pid = card.read_id(first + 1, "PID", e.id);
    else
      e.*value = card.read_real(first + 1, "K or M", 0.0);
    e.g1 = card.read_reference(first + 2, "S1");
    e.g2 = card.read_reference(first + 3, "S2");
    e.by_scalar_points = true;
    if (e.g1 == 0 && e.g2 == 0 && card.is_ok())
      card.fail("deck.missing-field", first + 2, "S1 and S2 are both blank, expected one at least");
    e.at = card.get_location();
    for (const int point : {e.g1, e.g2})
      if (point > 0 && card.is_ok()) r.deck.scalar_points.push_back(point);
    if (r.claim(space, e.id, card, first, 4)) elements.push_back(e);
  }
}

void parse_celas3(Card& card, Reading& r) {
  parse_scalar_pairs(card, r, true, &records::ScalarSpring::k, IdSpace::Spring, r.deck.springs);
}
void parse_celas4(Card& card, Reading& r) {
  parse_scalar_pairs(card, r, false, &records::ScalarSpring::k, IdSpace::Spring, r.deck.springs);
}
void parse_cmass3(Card& card, Reading& r) {
  parse_scalar_pairs(card, r, true, &records::ScalarMass::m, IdSpace::ScalarMass, r.deck.scalar_masses);
}
void parse_cmass4(Card& card, Reading& r) {
  parse_scalar_pairs(card, r, false, &records::ScalarMass::m, IdSpace::ScalarMass, r.deck.scalar_masses);
}

void parse_cbush(Card& card, Reading& r) {
  records::Cbush e;
  card.read_ids(0, {{"EID", e.id}, {"PID", e.pid, &e.id}, {"GA", e.ga}});
  e.gb = card.read_reference(3, "GB");
  if (!card.is_blank(4, 7)) {
    if (card.is_integer(4) && card.is_blank(5, 7))
      e.g0 = card.read_id(4, "G0");
    else
      e.v = card.read_vector(4, "X1 X2 X3");
  }
  if (!card.is_blank(7)) e.cid = card.read_reference(7, "CID");
  e.s = card.read_real(8, "S", 0.5);
  card.demand(e.s >= 0 && e.s <= 1, 8, "S", "a value from 0 to 1");
  e.ocid = card.read_int(9, "OCID", -1);
  card.demand(e.ocid >= -1, 9, "OCID", "-1, zero or a coordinate system");
  e.s_offset = card.read_vector(10, "S1 S2 S3");
  e.at = card.get_location();
  if (r.claim(IdSpace::Bush, e.id, card)) r.deck.cbush.push_back(std::move(e));
}

/// The lower triangle by rows, M11 M21 M22 ... M66, without gaps over the lines.
void parse_conm1(Card& card, Reading& r) {
  records::Conm1 e;
  e.id = card.read_id(0, "EID");
  e.g = card.read_id(1, "G");
  e.cid = card.read_reference(2, "CID");
  int i = 3;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column)
      e.m(row, column) = e.m(column, row) = card.read_real(i++, "M11 to M66", 0.0);
  e.at = card.get_location();
  if (r.claim(IdSpace::ConcentratedMass, e.id, card)) r.deck.conm1.push_back(e);
}

void parse_conm2(Card& card, Reading& r) {
  records::Conm2 e;
  e.id = card.read_id(0, "EID");
  e.g = card.read_id(1, "G");
  e.cid = card.read_int(2, "CID", 0);
  card.demand(e.cid >= -1, 2, "CID", "-1, zero or a coordinate system");
  e.m = card.read_real(3, "M", 0.0);
  e.x = card.read_vector(4, "X1 X2 X3");
  for (int i = 0; i < 6; ++i) e.inertia[static_cast<std::size_t>(i)] = card.read_real(8 + i, "I11 to I33", 0.0);
  e.at = card.get_location();
  if (r.claim(IdSpace::ConcentratedMass, e.id, card)) r.deck.conm2.push_back(e);
}

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

void write_springs(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.springs) {
    auto card = make_scalar_card("CELAS", e, e.k);
    if (e.pid == 0 && !e.by_scalar_points && (e.ge != 0 || e.s != 0)) card.add(e.ge).add(e.s);
    sink.put(card);
  }
}

void write_bushes(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.cbush) write_cbush(e, sink);
}

void write_scalar_masses(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.scalar_masses) sink.put(make_scalar_card("CMASS", e, e.m));
}

void write_conm1(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.conm1) {
    CardFields card("CONM1");
    card.add(e.id).add(e.g).add_id(e.cid);
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column <= row; ++column) card.add(e.m(row, column));
    sink.put(card);
  }
}

void write_conm2(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.conm2) {
    CardFields card("CONM2");
    card.add(e.id).add(e.g).add_id(e.cid).add(e.m).add(e.x).end_line();
    for (const double value : e.inertia) card.add(value);
    sink.put(card);
  }
}

void convert_celas2(UnitConverter& u) {
  u.scale_by(u.find_scalar_motion(), 1, "K", "Q", "?");
  u.scale(7, "?");
}
void convert_cmass2(UnitConverter& u) { u.scale_by(u.find_scalar_motion(), 1, "M", "J", "?"); }
void convert_cbush(UnitConverter& u) {
  if (u.get_int(9) >= 0) u.scale_lengths(10, u.get_int(9));
}
void convert_conm2(UnitConverter& u) {
  u.scale(3, "M");
  if (u.get_int(2) == -1)
    u.scale(4, 6, "L");
  else
    u.scale_lengths(4, u.get_int(2));
  u.scale(8, 13, "J");
}

}  // namespace

void add_point_element_parsers(ParserTable& table) {
  table["CELAS1"] = {parse_celas1, "", "EID PID G1 C1 G2 C2"};
  table["CELAS2"] = {parse_celas2, nullptr, "EID K G1 C1 G2 C2 GE S"};
  table["CMASS1"] = {parse_cmass1, "", "EID PID G1 C1 G2 C2"};
  table["CMASS2"] = {parse_cmass2, nullptr, "EID M G1 C1 G2 C2"};
  table["CELAS3"] = {parse_celas3, ""};
  table["CELAS4"] = {parse_celas4, ". ? . . . ? . ."};
  table["CMASS3"] = {parse_cmass3, ""};
  table["CMASS4"] = {parse_cmass4, ". ? . . . ? . ."};
  table["CBUSH"] = {parse_cbush, nullptr};
  table["CONM1"] = {parse_conm1, ". . . M M M M M M ML ML ML J ML ML ML J J ML ML ML J J J"};
  table["CONM2"] = {parse_conm2, nullptr, "EID G CID M X1 X2 X3 - I11 I21 I22 I31 I32 I33"};
  table["CELAS1"].note = table["CMASS1"].note = note_scalar_element;
  table["CELAS3"].note = table["CMASS3"].note = note_scalar_points;
  table["CELAS2"].convert = convert_celas2;
  table["CMASS2"].convert = convert_cmass2;
  table["CBUSH"].convert = convert_cbush;
  table["CONM2"].convert = convert_conm2;
  write_by(table, write_springs, {"CELAS1", "CELAS2", "CELAS3", "CELAS4"});
  write_by(table, write_bushes, {"CBUSH"});
  write_by(table, write_scalar_masses, {"CMASS1", "CMASS2", "CMASS3", "CMASS4"});
  write_by(table, write_conm1, {"CONM1"});
  write_by(table, write_conm2, {"CONM2"});
}

}  // namespace bough::nastran::detail
