/// Solids and the curved pipe of NASTRAN-95 (User's Manual, section 2.4) as CHEXA, CPENTA, CTETRA and CBEND.
#include <array>
#include <string>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

namespace bough::nastran::detail {
namespace {

void add_solid(Card& card, Reading& r, records::SolidElement&& e, const char* today, const char* property) {
  add_old_element(card, r, std::move(e), today, property, IdSpace::Solid, r.deck.solids, r.old_elements.solids);
}

/// EID MID G1...: tetrahedra that share the grids of a hexahedron or a wedge.
template <int corners>
void parse_by_material(Card& card, Reading& r) {
  records::SolidElement e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "MID");
  for (int i = 0; i < corners; ++i) e.corners.push_back(card.read_id(2 + i, "G1.."));
  add_solid(card, r, std::move(e), corners == 8 ? "CHEXA" : "CPENTA", "");
}

/// CIHEX1: EID PID G1 to G8, in the order of CHEXA.
void parse_cihex1(Card& card, Reading& r) {
  records::SolidElement e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID");
  for (int i = 0; i < 8; ++i) e.corners.push_back(card.read_id(2 + i, "G1 to G8"));
  add_solid(card, r, std::move(e), "CHEXA", "PIHEX");
}

/// EID PID, then the corners and the grids of edges at these places.
records::SolidElement read_isoparametric(Card& card, std::initializer_list<int> corners,
                                         std::initializer_list<int> midsides, const char* what) {
  records::SolidElement e;
  card.read_ids(0, {{"EID", e.id}, {"PID", e.pid}});
  for (const int i : corners) e.corners.push_back(card.read_id(1 + i, what));
  for (const int i : midsides) e.midsides.push_back(card.read_id(1 + i, what));
  return e;
}

/// CIHEX2: corners and midsides by turns round the bottom (G1 to G8), the edges between (G9 to G12), the top by turns.
void parse_cihex2(Card& card, Reading& r) {
  auto e =
      read_isoparametric(card, {1, 3, 5, 7, 13, 15, 17, 19}, {2, 4, 6, 8, 9, 10, 11, 12, 14, 16, 18, 20}, "G1 to G20");
  add_solid(card, r, std::move(e), "CHEXA", "PIHEX");
}

/// CIHEX3: round the bottom (G1 to G12, corners G1 G4 G7 G10), a third up (G13 to G16), two thirds up (G17 to G20),
/// round the top (G21 to G32), as in NASTRAN-95's ihexsd.f. Thirds by edge of CHEXA, from its first corner.
void parse_cihex3(Card& card, Reading& r) {
  auto e = read_isoparametric(
      card, {1, 4, 7, 10, 21, 24, 27, 30},
      {2, 3, 5, 6, 8, 9, 11, 12, 13, 17, 14, 18, 15, 19, 16, 20, 22, 23, 25, 26, 28, 29, 31, 32}, "G1 to G32");
  add_solid(card, r, std::move(e), "CIHEX3", "PIHEX");
}

/// PID MID CID NIP AR ALPHA BETA. NIP stays zero if it is blank: what that means is the element's.
void parse_pihex(Card& card, Reading& r) {
  records::Psolid p;
  card.read_ids(0, {{"PID", p.id}, {"MID", p.mid}});
  p.cordm = card.read_reference(2, "CID");
  p.points = card.read_int(3, "NIP", 0);
  card.demand(p.points == 0 || (p.points >= 2 && p.points <= 4), 3, "NIP", "2, 3 or 4");
  card.use(4, 7);  // limits of the shape
  p.at = card.get_location();
  if (r.claim(IdSpace::OldSolidProperty, p.id, card)) r.old_elements.solid_properties.emplace(p.id, p);
}

/// EID PID GA GB X1 X2 X3 1: the vector points to the centre.
void parse_celbow(Card& card, Reading& r) {
  records::Cbend e;
  card.read_ids(0, {{"EID", e.id}, {"PID", e.pid, &e.id}, {"GA", e.ga}, {"GB", e.gb}});
  e.v = card.read_vector(4, "X1 X2 X3");
  e.geom = 1;
  card.use(7);
  e.at = card.get_location();
  if (!r.claim(IdSpace::Bend, e.id, card)) return;
  r.old_elements.count(card, "CBEND");
  r.deck.special.cbend.push_back(e);
}

/// A factor of shear area: blank is 1, and decks of before 1992 have its reciprocal (NASTRAN-95, KELBOW).
double read_shear_factor(Card& card, int i) {
  const double k = card.read_real(i, "K1 K2", 1.0);
  return k < 1e-8 ? 1 : k > 1 ? 1 / k : k;
}
/// A flexibility factor divides the moment of inertia (NASTRAN-95, KELBOW); blank is 1.
double read_flexibility(Card& card, int i) {
  const double k = card.read_real(i, "KX KY KZ", 1.0);
  return k < 1e-8 ? 1 : k;
}

/// PID MID A I1 I2 J NSM, points of stress, K1 K2 C KX KY KZ R BETA.
void parse_pelbow(Card& card, Reading& r) {
  records::Pbend p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  p.A = card.read_real(2, "A");
  p.I1 = card.read_real(3, "I1") / read_flexibility(card, 21);
  p.I2 = card.read_real(4, "I2") / read_flexibility(card, 20);
  p.J = card.read_real(5, "J", 0.0) / read_flexibility(card, 19);
  p.nsm = card.read_real(6, "NSM", 0.0);
  p.k1 = read_shear_factor(card, 16);
  p.k2 = read_shear_factor(card, 17);
  card.use(18);     // stress intensification
  card.use(8, 16);  // points of stress
  p.rb = card.read_real(22, "R", 0.0);
  p.theta_b_deg = card.read_real(23, "BETA", 0.0);
  p.delta_n = 0.0;
  p.at = card.get_location();
  if (r.claim(IdSpace::BendProperty, p.id, card)) r.deck.special.pbend.push_back(p);
}

}  // namespace

void add_old_solid_parsers(ParserTable& table) {
  table["CHEXA1"] = table["CHEXA2"] = {parse_by_material<8>, ""};
  table["CWEDGE"] = {parse_by_material<6>, ""};
  table["CIHEX1"] = {parse_cihex1, ""};
  table["CIHEX2"] = {parse_cihex2, ""};
  table["CIHEX3"] = {parse_cihex3, ""};
  table["PIHEX"] = {parse_pihex, ""};
  table["CELBOW"] = {parse_celbow, "", "EID PID GA GB X1 X2 X3 GEOM"};
  table["PELBOW"] = {parse_pelbow, ". . A I I I N . L . L . L . L . . . . . . . L .",
                     "PID MID A I1 I2 J NSM - R1 T1 R2 T2 R3 T3 R4 T4 K1 K2 C KX KY KZ R BETA"};
  write_as(table, "CHEXA", {"CHEXA1", "CHEXA2", "CIHEX1", "CIHEX2", "CIHEX3"});
  write_as(table, "CPENTA", {"CWEDGE"});
  write_as(table, "PSOLID", {"PIHEX"});
  write_as(table, "CBEND", {"CELBOW"});
  write_as(table, "PBEND", {"PELBOW"});
}

}  // namespace bough::nastran::detail
