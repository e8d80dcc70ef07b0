/// Plates and membranes of NASTRAN-95 (User's Manual, section 2.4) as CQUAD4, CTRIA3, CQUAD8, CTRIA6 of the same grids.
#include <cmath>
#include <string>

#include "formats/nastran/detail/parsers.hpp"
#include "formats/nastran/detail/shared_fields.hpp"

namespace bough::nastran::detail {
namespace {

using records::Pshell;
using records::ShellElement;

void add_shell(Card& card, Reading& r, ShellElement&& e, const char* today, const char* property) {
  add_old_element(card, r, std::move(e), today, property, IdSpace::Shell, r.deck.shells, r.old_elements.shells);
}

ShellElement read_head(Card& card) {
  ShellElement e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  return e;
}

/// "PQUAD2" of CQUAD2.
std::string get_property(const Card& card) { return "P" + card.get_name().substr(1); }

/// EID PID G1 G2 G3 (G4) TH.
template <int corners>
void parse_linear(Card& card, Reading& r) {
  auto e = read_head(card);
  for (int i = 0; i < corners; ++i) e.grids.push_back(card.read_id(2 + i, "G1.."));
  e.theta_deg = card.read_real(2 + corners, "TH", 0.0);
  add_shell(card, r, std::move(e), corners == 4 ? "CQUAD4" : "CTRIA3", get_property(card).c_str());
}

/// EID PID G1 to G6 TH: corners and midsides by turns round the triangle.
void parse_six_grids(Card& card, Reading& r) {
  auto e = read_head(card);
  for (int i = 0; i < 3; ++i) {
    e.grids.push_back(card.read_id(2 + 2 * i, "G1 G3 G5"));
    e.midsides.push_back(card.read_id(3 + 2 * i, "G2 G4 G6"));
  }
  e.theta_deg = card.read_real(8, "TH", 0.0);
  add_shell(card, r, std::move(e), "CTRIA6", get_property(card).c_str());
}

/// EID PID G1 to G8 (corners, then midsides) ID1 TH.
void parse_is2d8(Card& card, Reading& r) {
  auto e = read_head(card);
  for (int i = 0; i < 4; ++i) e.grids.push_back(card.read_id(2 + i, "G1 to G4"));
  for (int i = 0; i < 4; ++i) e.midsides.push_back(card.read_id(6 + i, "G5 to G8"));
  card.use(10);  // number of integration points
  e.theta_deg = card.read_real(11, "TH", 0.0);
  add_shell(card, r, std::move(e), "CQUAD8", get_property(card).c_str());
}

void add_property(Card& card, Reading& r, Pshell p, const std::vector<double>& corner_t = {}) {
  p.at = card.get_location();
  if (!card.is_ok()) return;
  const auto key = std::pair(card.get_name(), p.id);
  const auto [known, is_new] = r.old_elements.shell_properties.emplace(key, p);
  if (!is_new) {
    const auto at = r.deck.locate(known->second.at);
    card.fail("deck.duplicate-id", 0,
              "id " + std::to_string(p.id) + " is used twice, first at " + at.file + ":" + std::to_string(at.line),
              "give one of them another id");
  }
  if (!corner_t.empty()) r.old_elements.corner_t[key] = corner_t;
}

/// The parts of a plate as PSHELL has them: t and its bending ratio 12 I/t^3, shear ratio T3/t. A plate without a
/// membrane gets the t of I. Without MID3 or T3 there is no transverse shear flexibility.
Pshell make_plate(int id, int mid1, double t1, int mid2, double inertia, int mid3, double t3) {
  Pshell p;
  p.id = id;
  if (mid1 > 0 && t1 > 0) p.mid1 = mid1;
  if (mid2 > 0 && inertia > 0) p.mid2 = mid2;
  const double t = p.mid1 > 0 ? t1 : std::cbrt(12 * inertia);
  p.t = t;
  if (p.mid2 > 0) p.bending_ratio = 12 * inertia / (t * t * t);
  if (p.mid2 > 0 && mid3 > 0 && t3 > 0) {
    p.mid3 = mid3;
    p.shear_ratio = t3 / t;
  }
  return p;
}

/// PID MID T NSM, twice: a membrane, or (PQUAD2, PTRIA2) a homogeneous plate, whose shear thickness is T.
template <bool is_plate>
void parse_thickness(Card& card, Reading& r) {
  for (const int first : {0, 4}) {
    if (first > 0 && card.is_blank(first, first + 4)) break;
    const int id = card.read_id(first, "PID"), mid = card.read_id(first + 1, "MID");
    const double t = card.read_real(first + 2, "T");
    if (card.is_ok()) card.demand(t > 0, first + 2, "T", "a positive thickness");
    auto p = make_plate(id, mid, t, is_plate ? mid : 0, t * t * t / 12, mid, t);
    p.nsm = card.read_real(first + 3, "NSM", 0.0);
    add_property(card, r, p);
  }
}

/// PID MID1 T1 MID2 I MID3 T3 NSM, Z1 Z2.
void parse_three_materials(Card& card, Reading& r) {
  const int id = card.read_id(0, "PID"), mid1 = card.read_reference(1, "MID1");
  const double t1 = card.read_real(2, "T1", 0.0);
  const int mid2 = card.read_reference(3, "MID2");
  const double inertia = card.read_real(4, "I", 0.0);
  const int mid3 = card.read_reference(5, "MID3");
  auto p = make_plate(id, mid1, t1, mid2, inertia, mid3, card.read_real(6, "T3", 0.0));
  p.nsm = card.read_real(7, "NSM", 0.0);
  card.use(8, 10);  // Z1, Z2
  if (card.is_ok() && p.mid1 == 0 && p.mid2 == 0)
    card.fail("deck.missing-field", 1, "MID1 with T1 and MID2 with I are both blank", "give one of them");
  add_property(card, r, p);
}

/// PID MID1 I MID2 T NSM Z1 Z2: bending only.
void parse_bending(Card& card, Reading& r) {
  const int id = card.read_id(0, "PID"), mid = card.read_id(1, "MID1");
  const double inertia = card.read_real(2, "I");
  if (card.is_ok()) card.demand(inertia > 0, 2, "I", "a positive moment of inertia");
  const int mid2 = card.read_reference(3, "MID2");
  auto p = make_plate(id, 0, 0, mid, inertia, mid2, card.read_real(4, "T", 0.0));
  p.nsm = card.read_real(5, "NSM", 0.0);
  card.use(6, 8);  // Z1, Z2
  add_property(card, r, p);
}

/// Values at G1, G3, G5; those that are blank or zero are the first.
std::vector<double> read_three(Card& card, int first, const char* what) {
  std::vector<double> values{card.read_real(first, what, 0.0)};
  for (int i = 1; i < 3; ++i) {
    const double value = card.read_real(first + i, what, 0.0);
    values.push_back(value == 0 ? values.front() : value);
  }
  return values;
}
bool is_constant(const std::vector<double>& v) { return v[1] == v[0] && v[2] == v[0]; }

void add_triangle(Card& card, Reading& r, const Pshell& p, const std::vector<double>& t) {
  add_property(card, r, p, is_constant(t) ? std::vector<double>{} : t);
}

/// PTRIM6: PID MID T1 T3 T5 NSM.
void parse_ptrim6(Card& card, Reading& r) {
  const int id = card.read_id(0, "PID"), mid = card.read_id(1, "MID");
  const auto t = read_three(card, 2, "T1 T3 T5");
  if (card.is_ok()) card.demand(t[0] > 0, 2, "T1", "a positive thickness");
  auto p = make_plate(id, mid, t[0], 0, 0, 0, 0);
  p.nsm = card.read_real(5, "NSM", 0.0);
  add_triangle(card, r, p, t);
}

/// PTRPLT1: PID MID1 I1 I3 I5 MID2 TS1 TS3, TS5 NSM Z.
void parse_ptrplt1(Card& card, Reading& r) {
  const int id = card.read_id(0, "PID"), mid = card.read_id(1, "MID1");
  const auto inertia = read_three(card, 2, "I1 I3 I5");
  if (card.is_ok()) card.demand(inertia[0] > 0, 2, "I1", "a positive moment of inertia");
  const int mid2 = card.read_reference(5, "MID2");
  const auto shear = read_three(card, 6, "TS1 TS3 TS5");
  auto p = make_plate(id, 0, 0, mid, inertia[0], mid2, shear[0]);
  p.nsm = card.read_real(9, "NSM", 0.0);
  card.use(10, card.get_size());  // fibres
  add_triangle(card, r, p, {std::cbrt(12 * inertia[0]), std::cbrt(12 * inertia[1]), std::cbrt(12 * inertia[2])});
}

/// PTRSHL: PID MID1 T1 T3 T5 MID2 I1 I3, I5 MID3 TS1 TS3 TS5 NSM Z. The ratios of the first corner hold for all.
void parse_ptrshl(Card& card, Reading& r) {
  const int id = card.read_id(0, "PID"), mid1 = card.read_reference(1, "MID1");
  const auto t = read_three(card, 2, "T1 T3 T5");
  const int mid2 = card.read_reference(5, "MID2");
  const auto inertia = read_three(card, 6, "I1 I3 I5");
  const int mid3 = card.read_reference(9, "MID3");
  const auto shear = read_three(card, 10, "TS1 TS3 TS5");
  auto p = make_plate(id, mid1, t[0], mid2, inertia[0], mid3, shear[0]);
  p.nsm = card.read_real(13, "NSM", 0.0);
  card.use(14, card.get_size());  // fibres
  if (card.is_ok() && p.mid1 == 0 && p.mid2 == 0)
    card.fail("deck.missing-field", 1, "MID1 with T1 and MID2 with I1 are both blank", "give one of them");
  for (std::size_t i = 1; i < 3 && p.mid1 > 0 && p.mid2 > 0 && card.is_ok(); ++i)
    if (std::abs(12 * inertia[i] / std::pow(t[i], 3) - p.bending_ratio) > 0.01 * p.bending_ratio) {
      card.warn("deck.old-property", 6, "the ratio of I to T1^3 differs from corner to corner",
                "that of the first corner holds for all");
      break;
    }
  add_triangle(card, r, p,
               p.mid1 > 0 ? t
                          : std::vector<double>{std::cbrt(12 * inertia[0]), std::cbrt(12 * inertia[1]),
                                                std::cbrt(12 * inertia[2])});
}

/// PIS2D8: PID MID T.
void parse_pis2d8(Card& card, Reading& r) {
  const int id = card.read_id(0, "PID"), mid = card.read_id(1, "MID");
  const double t = card.read_real(2, "T");
  if (card.is_ok()) card.demand(t > 0, 2, "T", "a positive thickness");
  add_property(card, r, make_plate(id, mid, t, 0, 0, 0, 0));
}

}  // namespace

void add_old_shell_parsers(ParserTable& table) {
  constexpr const char* plate = ". . L S . . L S";
  for (const char* name : {"CQUAD1", "CQUAD2", "CQDMEM", "CQDMEM1", "CQDMEM2", "CQDPLT"})
    table[name] = {parse_linear<4>, ""};
  for (const char* name : {"CTRIA1", "CTRIA2", "CTRMEM", "CTRPLT", "CTRBSC"}) table[name] = {parse_linear<3>, ""};
  for (const char* name : {"CTRSHL", "CTRIM6", "CTRPLT1"}) table[name] = {parse_six_grids, ""};
  for (const char* name : {"PQDMEM", "PQDMEM1", "PQDMEM2", "PTRMEM"}) table[name] = {parse_thickness<false>, plate};
  table["PQUAD2"] = table["PTRIA2"] = {parse_thickness<true>, plate};
  table["PQUAD1"] = table["PTRIA1"] = {parse_three_materials, ". . L . L3 . L S L L"};
  table["PQDPLT"] = table["PTRPLT"] = table["PTRBSC"] = {parse_bending, ". . L3 . L S L L"};
  table["PTRIM6"] = {parse_ptrim6, ". . L L L S"};
  table["PTRPLT1"] = {parse_ptrplt1, ". . L3 L3 L3 . L L L S L L L L L L"};
  table["PTRSHL"] = {parse_ptrshl, ". . L L L . L3 L3 L3 . L L L S L L L L L L"};
  table["CIS2D8"] = {parse_is2d8, ""};
  table["PIS2D8"] = {parse_pis2d8, ". . L"};
  write_as(table, "CQUAD4", {"CQUAD1", "CQUAD2", "CQDMEM", "CQDMEM1", "CQDMEM2", "CQDPLT"});
  write_as(table, "CTRIA3", {"CTRIA1", "CTRIA2", "CTRMEM", "CTRPLT", "CTRBSC"});
  write_as(table, "CTRIA6", {"CTRSHL", "CTRIM6", "CTRPLT1"});
  write_as(table, "CQUAD8", {"CIS2D8"});
  write_as(table, "PSHELL",
           {"PQDMEM", "PQDMEM1", "PQDMEM2", "PTRMEM", "PQUAD1", "PTRIA1", "PQUAD2", "PTRIA2", "PQDPLT", "PTRPLT",
            "PTRBSC", "PTRIM6", "PTRPLT1", "PTRSHL", "PIS2D8"});
}

}  // namespace bough::nastran::detail
