#include <array>
#include <cmath>
#include <set>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "formats/nastran/detail/parsers.hpp"

namespace bough::nastran::detail {
namespace {

void parse_pshell(Card& card, Reading& r) {
  records::Pshell p;
  p.id = card.read_id(0, "PID");
  p.mid1 = card.read_id(1, "MID1", 0);
  p.t = card.read_optional_real(2, "T");
  p.mid2 = card.read_int(3, "MID2", 0);
  p.bending_ratio = card.read_real(4, "12I/T**3", 1.0);
  p.mid3 = card.read_id(5, "MID3", 0);
  p.shear_ratio = card.read_real(6, "TS/T", 5.0 / 6);
  p.nsm = card.read_real(7, "NSM", 0.0);
  p.mid4 = card.read_id(10, "MID4", 0);
  p.z1 = card.read_optional_real(8, "Z1");
  p.z2 = card.read_optional_real(9, "Z2");
  p.at = card.get_location();
  card.demand(p.mid2 >= -1, 3, "MID2", "a material id, blank or -1");
  if (p.mid1 == 0 && p.mid2 <= 0)
    card.fail("deck.missing-field", 1, "MID1 and MID2 are both blank", "give one of them");
  if (r.claim(IdSpace::ShellProperty, p.id, card)) r.deck.pshell.push_back(p);
}

void set_layup(const std::string& lam, records::Pcomp& p) {
  if (lam == "SMEAR") p.layup = records::Layup::Smeared;
  if (lam == "SMCORE") p.layup = records::Layup::SmearedCore;
}

void check_core(const records::Pcomp& p, Card& card) {
  if (p.layup == records::Layup::SmearedCore && p.plies.size() == 1)
    card.fail("deck.missing-field", 8, "LAM is SMCORE, but there is one ply only",
              "give the faces first and the core as the last ply");
}

/// SB and FT. A criterion that is not supported is left out, with a message.
void read_failure(Card& card, records::Pcomp& p) {
  p.sb = card.read_real(3, "SB", 0.0);
  p.failure = card.get_upper(4);
  card.use(4);
  if (p.failure.empty() || p.failure == "HILL" || p.failure == "HOFF" || p.failure == "TSAI" || p.failure == "STRN")
    return;
  card.warn("deck.failure-theory", 4, "FT is '" + p.failure + "': no failure index of that kind is computed",
            "HILL, HOFF, TSAI and STRN are");
  p.failure.clear();
}

/// Adds a laminate: its mirrored half by LAM, Z0 (blank: half the thickness). \param advice  for one without plies.
void add_laminate(Card& card, Reading& r, records::Pcomp& p, const std::string& lam, const std::optional<double>& z0,
                  const char* advice) {
  if (p.plies.empty()) card.fail("deck.missing-field", 8, "the laminate has no ply", advice);
  check_core(p, card);
  if (lam == "SYM" || lam == "SYMMEM") p.plies.insert(p.plies.end(), p.plies.rbegin(), p.plies.rend());
  double total = 0;
  for (const auto& ply : p.plies) total += ply.t;
  p.z0 = z0.value_or(-0.5 * total);
  if (r.claim(IdSpace::ShellProperty, p.id, card)) r.deck.pcomp.push_back(p);
}

/// Fields 1..7 of PCOMP and PCOMPG, then plies; `stride` fields a ply, material first after `skip`.
void parse_laminate(Card& card, Reading& r, int skip, int stride) {
  records::Pcomp p;
  p.id = card.read_id(0, "PID");
  const auto z0 = card.read_optional_real(1, "Z0");
  p.nsm = card.read_real(2, "NSM", 0.0);
  p.tref = card.read_real(5, "TREF", 0.0);
  p.ge = card.read_real(6, "GE", 0.0);
  read_failure(card, p);
  const std::string lam = card.read_word(7, "LAM", "", {"", "ALL", "SYM", "MEM", "SYMMEM", "BEND", "SMEAR", "SMCORE"});
  p.membrane = lam != "BEND";
  p.bending = lam != "MEM" && lam != "SYMMEM";
  set_layup(lam, p);
  p.at = card.get_location();
  for (int i = 8; i < card.get_size(); i += stride) {
    if (card.is_blank(i, i + stride)) continue;
    records::Ply ply = p.plies.empty() ? records::Ply{} : p.plies.back();
    ply.mid = p.plies.empty() ? card.read_id(i + skip, "MID1") : card.read_id(i + skip, "MIDi", ply.mid);
    ply.t = p.plies.empty() ? card.read_real(i + skip + 1, "T1") : card.read_real(i + skip + 1, "Ti", ply.t);
    ply.theta_deg = card.read_real(i + skip + 2, "THETAi", 0.0);
    card.use(i + skip + 3);     // SOUT
    if (skip > 0) card.use(i);  // GPLYID
    p.plies.push_back(ply);
  }
  add_laminate(card, r, p, lam, z0, "give MID1, T1, THETA1");
}
void parse_pcomp(Card& card, Reading& r) { parse_laminate(card, r, 0, 4); }
void parse_pcompg(Card& card, Reading& r) { parse_laminate(card, r, 1, 8); }

/// PCOMP1: PID Z0 NSM SB FT MID T LAM, angles. PCOMP2: PID Z0 NSM SB FT MID blank LAM, pairs of T and angle.
void parse_equal_plies(Card& card, Reading& r) {
  const bool is_constant = card.get_name() == "PCOMP1";
  records::Pcomp p;
  p.id = card.read_id(0, "PID");
  const auto z0 = card.read_optional_real(1, "Z0");
  p.nsm = card.read_real(2, "NSM", 0.0);
  read_failure(card, p);
  records::Ply ply;
  ply.mid = card.read_id(5, "MID");
  if (is_constant) ply.t = card.read_real(6, "T");
  const std::string lam = card.read_word(7, "LAM", "", {"", "ALL", "SYM", "MEM", "SYMMEM", "BEND", "SMEAR", "SMCORE"});
  p.bending = lam != "MEM" && lam != "SYMMEM";
  p.membrane = lam != "BEND";
  set_layup(lam, p);
  p.at = card.get_location();
  const int stride = is_constant ? 1 : 2;
  for (int i = 8; i < card.get_size(); i += stride) {
    if (card.is_blank(i, i + stride) && !is_constant) continue;
    if (!is_constant) ply.t = card.read_real(i, "Ti", ply.t);
    ply.theta_deg = card.read_real(i + stride - 1, "THi", ply.theta_deg);
    p.plies.push_back(ply);
  }
  add_laminate(card, r, p, lam, z0, "give its angles");
}

/// IN and ISOP, as words or as numbers (Quick Reference Guide, PSOLID).
void read_solid_scheme(Card& card, Reading& r, records::Psolid& p) {
  const std::string in = card.get_upper(3), isop = card.get_upper(5);
  if (in == "TWO" || in == "2")
    p.points = 2;
  else if (in == "THREE" || in == "3")
    p.points = 3;
  p.is_full = isop == "FULL" || isop == "1";
  p.is_reduced = isop == "REDUCED" || isop == "0";
  const bool knows_in = p.points > 0 || in.empty() || in == "BUBBLE" || in == "GAUSS" || in == "0" || in == "1";
  if (knows_in && (p.is_full || p.is_reduced || isop.empty())) return;
  r.diagnostics.warning("deck.solid-scheme", r.deck.locate(p.at),
                        "PSOLID " + std::to_string(p.id) + " has IN = '" + in + "', ISOP = '" + isop +
                            "'; what is unknown there is taken as blank",
                        "IN is BUBBLE, TWO or THREE, ISOP is REDUCED or FULL");
}

void parse_psolid(Card& card, Reading& r) {
  records::Psolid p;
  p.id = card.read_id(0, "PID");
  p.mid = card.read_id(1, "MID");
  p.cordm = card.is_integer(2) ? card.read_int(2, "CORDM", 0) : 0;
  p.at = card.get_location();
  read_solid_scheme(card, r, p);
  const std::string fluid = card.get_upper(6);
  card.use(2, 6);  // CORDM, IN, STRESS, ISOP
  if (!r.claim(IdSpace::SolidProperty, p.id, card)) return;
  if (fluid == "PFLUID" || fluid == "FFLUID") {
    if (r.fluid_grids.empty() && r.fluid_properties.empty()) r.first_fluid = p.at;
    r.fluid_properties.insert(p.id);
  } else {
    r.deck.psolid.push_back(p);
  }
}

void parse_solid(Card& card, Reading& r, int corners, int edges) {
  records::SolidElement e;
  e.id = card.read_id(0, "EID");
  e.pid = card.read_id(1, "PID", e.id);
  e.card = card.get_name();
  for (int i = 0; i < corners; ++i) e.corners.push_back(card.read_id(2 + i, "G1.."));
  bool any = false;
  for (int i = 0; i < edges; ++i) {
    e.midsides.push_back(card.read_id(2 + corners + i, "Gi", 0));
    any = any || e.midsides.back() > 0;
  }
  if (!any) e.midsides.clear();
  e.at = card.get_location();
  if (r.claim(IdSpace::Solid, e.id, card)) r.deck.solids.push_back(std::move(e));
}
void parse_hexa(Card& card, Reading& r) { parse_solid(card, r, 8, 12); }
void parse_penta(Card& card, Reading& r) { parse_solid(card, r, 6, 9); }
void parse_tetra(Card& card, Reading& r) { parse_solid(card, r, 4, 6); }
void parse_pyram(Card& card, Reading& r) { parse_solid(card, r, 5, 8); }

void write_pshell(const records::Pshell& p, CardSink& sink) {
  CardFields card("PSHELL");
  card.add(p.id).add_id(p.mid1);
  if (p.t)
    card.add(*p.t);
  else
    card.add_blank();
  card.add_id(p.mid2).add(p.bending_ratio).add_id(p.mid3);
  // 5/6 has no end in any field; it is the default.
  if (p.shear_ratio == 5.0 / 6)
    card.add_blank();
  else
    card.add(p.shear_ratio);
  card.add(p.nsm);
  for (const auto& z : {p.z1, p.z2}) z ? card.add(*z) : card.add_blank();
  sink.put(card.add_id(p.mid4));
}

void write_pcomp(const records::Pcomp& p, CardSink& sink) {
  double total = 0;
  for (const auto& ply : p.plies) total += ply.t;
  CardFields card("PCOMP");
  card.add(p.id);
  if (p.z0 == -0.5 * total)
    card.add_blank();
  else
    card.add(p.z0);
  card.add(p.nsm);
  p.sb != 0 ? card.add(p.sb) : card.add_blank();
  p.failure.empty() ? card.add_blank() : card.add_word(p.failure);
  card.add(p.tref).add(p.ge);
  if (!p.membrane || !p.bending)
    card.add_word(p.membrane ? "MEM" : "BEND");
  else if (p.layup != records::Layup::Stacked)
    card.add_word(p.layup == records::Layup::Smeared ? "SMEAR" : "SMCORE");
  else
    card.add_blank();
  for (const auto& ply : p.plies) card.add(ply.mid).add(ply.t).add(ply.theta_deg).add_blank();
  sink.put(card);
}

/// CIHEX3 in its own order: rings of corners and thirds, the thirds of the upright edges between them.
void write_cubic(const records::SolidElement& e, CardSink& sink) {
  const auto third = [&](int edge, int k) { return e.midsides[static_cast<std::size_t>(2 * edge + k)]; };
  CardFields card("CIHEX3");
  card.add(e.id).add(e.pid);
  const auto add_ring = [&](int first_corner, int first_edge) {
    for (int i = 0; i < 4; ++i)
      card.add(e.corners[static_cast<std::size_t>(first_corner + i)])
          .add(third(first_edge + i, 0))
          .add(third(first_edge + i, 1));
  };
  add_ring(0, 0);
  for (const int k : {0, 1})
    for (int edge = 4; edge < 8; ++edge) card.add(third(edge, k));
  add_ring(4, 8);
  sink.put(card);
}

/// Properties that only cubic bricks use; they are written as PIHEX.
std::set<int> find_cubic_properties(const records::Deck& deck) {
  std::set<int> cubic;
  for (const auto& e : deck.solids)
    if (e.card == "CIHEX3") cubic.insert(e.pid);
  return cubic;
}

void write_pshells(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pshell) write_pshell(p, sink);
}

void write_pcomps(const records::Deck& deck, CardSink& sink) {
  for (const auto& p : deck.pcomp) write_pcomp(p, sink);
}

void write_psolids(const records::Deck& deck, CardSink& sink) {
  const auto cubic = find_cubic_properties(deck);
  for (const auto& p : deck.psolid) {
    if (cubic.count(p.id) > 0) {  // the reader gives no property to both kinds
      sink.put(CardFields("PIHEX").add(p.id).add(p.mid).add_id(p.cordm).add(p.points > 0 ? p.points : 4));
      continue;
    }
    CardFields card("PSOLID");
    card.add(p.id).add(p.mid).add_id(p.cordm).add_id(p.points);
    if (p.is_full || p.is_reduced) card.add_blank().add_word(p.is_full ? "FULL" : "REDUCED");
    sink.put(card);
  }
}

void write_solids(const records::Deck& deck, CardSink& sink) {
  for (const auto& e : deck.solids) {
    if (e.card == "CIHEX3") {
      write_cubic(e, sink);
      continue;
    }
    CardFields card(e.card);
    card.add(e.id).add(e.pid);
    for (const int grid : e.corners) card.add(grid);
    for (const int grid : e.midsides) card.add_id(grid);
    sink.put(card);
  }
}

/// Z0 NSM SB, then plies of `step` fields with T at `first`.
template <int first, int step>
void convert_plies(UnitConverter& u) {
  u.scale(1, "L");
  u.scale(2, "S");
  u.scale(3, "P");
  for (int ply = 8; ply < u.size(); ply += step) u.scale(ply + first, "L");
}

}  // namespace

void add_continuum_parsers(ParserTable& table) {
  table["PSHELL"] = {parse_pshell, ". . L . . . . S L L .", "PID MID1 T MID2 12I/T**3 MID3 TS/T NSM Z1 Z2 MID4"};
  table["PCOMP"] = {parse_pcomp, nullptr,
                    "PID Z0 NSM SB FT TREF GE LAM MID1 T1 THETA1 SOUT1 MID2 T2 THETA2 SOUT2 MID3 T3 THETA3 SOUT3 "
                    "MID4 T4 THETA4 SOUT4 MID5 T5 THETA5 SOUT5 MID6 T6 THETA6 SOUT6 MID7 T7 THETA7 SOUT7 "
                    "MID8 T8 THETA8 SOUT8"};
  table["PCOMPG"] = {parse_pcompg, nullptr};
  table["PCOMP1"] = {parse_equal_plies, ". L S P . . L ."};
  table["PCOMP2"] = {parse_equal_plies, nullptr};
  table["PCOMP"].convert = convert_plies<1, 4>;
  table["PCOMPG"].convert = convert_plies<2, 8>;
  table["PCOMP2"].convert = convert_plies<0, 2>;
  table["PSOLID"] = {parse_psolid, "", "PID MID CORDM IN STRESS ISOP FCTN"};
  table["CHEXA"] = {parse_hexa, ""};
  table["CPENTA"] = {parse_penta, ""};
  table["CTETRA"] = {parse_tetra, ""};
  table["CPYRAM"] = {parse_pyram, ""};
  write_by(table, write_pshells, {"PSHELL"});
  write_by(table, write_pcomps, {"PCOMP"});
  write_as(table, "PCOMP", {"PCOMPG", "PCOMP1", "PCOMP2"});
  write_by(table, write_psolids, {"PSOLID"});
  write_by(table, write_solids, {"CHEXA", "CPENTA", "CTETRA", "CPYRAM"});
}

}  // namespace bough::nastran::detail
