#include <limits>
#include <string>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

using records::ShellElement;

ShellElement read_corners(Card& card, int corners) {
  ShellElement e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  e.card = card.get_name();
  e.at = card.get_location();
  for (int i = 0; i < corners; ++i) e.grids.push_back(card.read_id(2 + i, "G1.."));
  return e;
}

/// THETA, a real, or MCID, an integer, in field i; ZOFFS after it.
void read_axes(Card& card, int i, ShellElement& e) {
  if (card.is_integer(i)) {
    e.mcid = card.read_int(i, "MCID");
    card.demand(*e.mcid >= 0, i, "MCID", "a coordinate system, or a real angle THETA");
  } else {
    e.theta_deg = card.read_real(i, "THETA", 0.0);
  }
  e.z_offset = card.read_real(i + 1, "ZOFFS", 0.0);
}

/// T1.. of the corners from field `first` on, TFLAG in field `flag`.
void read_thickness(Card& card, int first, int flag, ShellElement& e) {
  const int tflag = card.read_int(flag, "TFLAG", 0);
  card.demand(tflag == 0 || tflag == 1, flag, "TFLAG", "0, 1 or blank");
  e.relative_thickness = tflag == 1;
  const int corners = static_cast<int>(e.grids.size());
  if (card.is_blank(first, first + corners)) return;
  for (int i = first; i < first + corners; ++i)
    e.t.push_back(card.is_blank(i) ? std::numeric_limits<double>::quiet_NaN() : card.read_real(i, "Ti"));
}

void add_shell(Card& card, Reading& r, ShellElement&& e) {
  if (r.claim(IdSpace::Shell, e.id, card)) r.deck.shells.push_back(std::move(e));
}

/// CQUAD4, CQUADR, CTRIA3, CTRIAR: the thicknesses in fields 4.. of the second line, TFLAG in field 3.
void parse_linear(Card& card, Reading& r, int corners) {
  auto e = read_corners(card, corners);
  read_axes(card, 2 + corners, e);
  read_thickness(card, 10, 9, e);
  add_shell(card, r, std::move(e));
}
void parse_quad(Card& card, Reading& r) { parse_linear(card, r, 4); }
void parse_triangle(Card& card, Reading& r) { parse_linear(card, r, 3); }

/// Blank midsides stay as 0, so that the others keep their side.
void read_midsides(Card& card, int first, ShellElement& e) {
  bool any = false;
  for (std::size_t i = 0; i < e.grids.size(); ++i) {
    e.midsides.push_back(card.read_id(first + static_cast<int>(i), "G5..", 0));
    any = any || e.midsides.back() > 0;
  }
  if (!any) e.midsides.clear();
}

/// CQUAD8, CTRIA6: THETA in field `axes`, TFLAG in field `flag`.
void parse_quadratic(Card& card, Reading& r, int corners, int axes, int flag) {
  auto e = read_corners(card, corners);
  read_midsides(card, 2 + corners, e);
  read_axes(card, axes, e);
  read_thickness(card, 10, flag, e);
  add_shell(card, r, std::move(e));
}
/// G1..G6, G7 G8 T1..T4 THETA ZOFFS, TFLAG.
void parse_quad8(Card& card, Reading& r) { parse_quadratic(card, r, 4, 14, 16); }
/// G1..G6, THETA ZOFFS T1..T3 TFLAG.
void parse_triangle6(Card& card, Reading& r) { parse_quadratic(card, r, 3, 8, 13); }

void parse_cshear(Card& card, Reading& r) {
  records::ShearPanel e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  for (int i = 0; i < 4; ++i) e.grids[static_cast<std::size_t>(i)] = card.read_id(2 + i, "G1..");
  e.at = card.get_location();
  if (r.claim(IdSpace::Shell, e.id, card)) r.deck.shear_panels.push_back(e);
}

/// PID MID T NSM F1 F2; with integers in the place of F1 and F2 a second PID MID T NSM (NASTRAN-95).
void parse_pshear(Card& card, Reading& r) {
  const bool has_second = card.is_integer(4) && card.is_integer(5);
  for (const int first : {0, 4}) {
    if (first > 0 && !has_second) break;
    records::Pshear p;
    p.id = card.read_id(first, "PID");
    p.mid = card.read_id(first + 1, "MID");
    p.t = card.read_real(first + 2, "T");
    p.nsm = card.read_real(first + 3, "NSM", 0.0);
    p.f1 = has_second ? 0 : card.read_real(4, "F1", 0.0);
    p.f2 = has_second ? 0 : card.read_real(5, "F2", 0.0);
    p.at = card.get_location();
    if (card.is_ok()) card.demand(p.t > 0, first + 2, "T", "a positive thickness");
    card.demand(p.f1 >= 0, 4, "F1", "zero or a positive effectiveness");
    card.demand(p.f2 >= 0, 5, "F2", "zero or a positive effectiveness");
    if (r.claim(IdSpace::ShearProperty, p.id, card, first, has_second ? 4 : 8)) r.deck.pshear.push_back(p);
  }
}

/// Adds THETA or MCID, blank if zero: mesh readers read every number after PID as a grid.
void add_axes(const ShellElement& e, CardFields& card) {
  if (e.mcid)
    card.add(*e.mcid);
  else if (e.theta_deg != 0)
    card.add(e.theta_deg);
  else
    card.add_blank();
  if (e.z_offset != 0)
    card.add(e.z_offset);
  else
    card.add_blank();
}

void add_thickness(const ShellElement& e, CardFields& card) {
  for (const double t : e.t) std::isnan(t) ? card.add_blank() : card.add(t);
  if (e.t.empty()) card.add_blank(static_cast<int>(e.grids.size()));
}

void write_shell(const ShellElement& e, CardSink& sink) {
  CardFields card(e.card);
  card.add(e.id).add(e.pid);
  for (const int grid : e.grids) card.add(grid);
  const bool is_quadratic = e.card == "CQUAD8" || e.card == "CTRIA6";
  if (!is_quadratic) {
    add_axes(e, card);
    if (e.relative_thickness || !e.t.empty()) {
      card.end_line().add_blank().add(e.relative_thickness ? 1 : 0);
      add_thickness(e, card);
    }
    sink.put(card);
    return;
  }
  for (const int grid : e.midsides) card.add_id(grid);
  if (e.midsides.empty()) card.add_blank(static_cast<int>(e.grids.size()));
  if (e.grids.size() == 3) add_axes(e, card);
  add_thickness(e, card);
  if (e.grids.size() == 4) add_axes(e, card);
  sink.put(card.add_id(e.relative_thickness ? 1 : 0));
}

void write_shells(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.shells) write_shell(e, sink);
}

void write_pshear(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pshear)
    sink.put(CardFields("PSHEAR").add(p.id).add(p.mid).add(p.t).add(p.nsm).add(p.f1).add(p.f2));
}

void write_shear_panels(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.shear_panels) {
    CardFields card("CSHEAR");
    card.add(e.id).add(e.pid);
    for (const int grid : e.grids) card.add(grid);
    sink.put(card);
  }
}

/// Thicknesses are shares of the property's with TFLAG = 1.
void convert_linear(UnitConverter& u) { u.get(9) == "1" ? u.scale_words(10) : u.scale_words(); }
void convert_quad8(UnitConverter& u) {
  if (u.get(16) != "1") return u.scale_words();
  u.scale_words(10);
  u.scale(15, "L");
}
void convert_triangle6(UnitConverter& u) { u.get(13) == "1" ? u.scale_words(10) : u.scale_words(); }

}  // namespace

void add_shell_parsers(ParserTable& table) {
  table["CQUAD4"] = table["CQUADR"] = {parse_quad, ". . . . . . . L . . L L L L",
                                       "EID PID G1 G2 G3 G4 THETA ZOFFS - TFLAG T1 T2 T3 T4"};
  table["CTRIA3"] = table["CTRIAR"] = {parse_triangle, ". . . . . . L . . . L L L",
                                       "EID PID G1 G2 G3 THETA ZOFFS - - TFLAG T1 T2 T3"};
  table["CQUAD8"] = {parse_quad8, ". . . . . . . . . . L L L L . L ."};
  table["CTRIA6"] = {parse_triangle6, ". . . . . . . . . L L L L ."};
  table["CSHEAR"] = {parse_cshear, ""};
  table["PSHEAR"] = {parse_pshear, ". . L S . . L S", "PID MID T NSM F1 F2"};
  for (const char* name : {"CQUAD4", "CQUADR", "CTRIA3", "CTRIAR"}) table[name].convert = convert_linear;
  table["CQUAD8"].convert = convert_quad8;
  table["CTRIA6"].convert = convert_triangle6;
  write_by(table, write_shells, {"CQUAD4", "CQUADR", "CTRIA3", "CTRIAR", "CQUAD8", "CTRIA6"});
  write_by(table, write_pshear, {"PSHEAR"});
  write_by(table, write_shear_panels, {"CSHEAR"});
}

}  // namespace bough::nastran::detail
