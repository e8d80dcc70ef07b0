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

void parse_celas1(Card& card, Reading& r) {
  records::ScalarSpring e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  read_ends(card, 2, e);
  e.at = card.get_location();
  if (r.claim(IdSpace::Spring, e.id, card)) r.deck.springs.push_back(e);
}

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

void parse_cmass1(Card& card, Reading& r) {
  records::ScalarMass e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  read_ends(card, 2, e);
  e.at = card.get_location();
  if (r.claim(IdSpace::ScalarMass, e.id, card)) r.deck.scalar_masses.push_back(e);
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

void parse_spoint(Card& card, Reading& r) {
  const auto ids = read_ids(card, 0, card.get_size(), "ID");
  if (ids.empty() && card.is_ok()) card.fail("deck.missing-field", 0, "ID is blank, expected a scalar point at least");
  if (card.is_ok()) r.deck.scalar_points.insert(r.deck.scalar_points.end(), ids.begin(), ids.end());
}

void parse_cbush(Card& card, Reading& r) {
  records::Cbush e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  e.ga = card.read_id(2, "GA");
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
  table["SPOINT"] = {parse_spoint, ""};
  table["CBUSH"] = parse_cbush;
  table["CONM1"] = {parse_conm1, ". . . M M M M M M ML ML ML J ML ML ML J J ML ML ML J J J"};
  table["CONM2"] = {parse_conm2, nullptr, "EID G CID M X1 X2 X3 - I11 I21 I22 I31 I32 I33"};
}

}  // namespace bough::nastran::detail
