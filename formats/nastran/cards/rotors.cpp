/// \file Cards of rotors. Source of the fields: MSC Nastran Quick Reference Guide, ROTORG, RSPINR, RGYRO, RSPEED,
/// DDVAL, UNBALNC; Simcenter Nastran Quick Reference Guide, ROTORD.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;
using std::numbers::pi;

/// Radians per unit of time of one unit: revolutions per minute, or per unit of time.
double read_speed_unit(Card& card, int i) {
  return card.read_word(i, "SPDUNIT", "", {"RPM", "FREQ"}) == "RPM" ? pi / 30 : 2 * pi;
}

/// ROTORID GRID1 GRID2 ... or GRID1 THRU GRID2 BY INC.
void parse_rotorg(Card& card, DynamicCards& r) {
  records::RotorLine line;
  line.id = card.read_id(0, "ROTORID");
  for (const auto& range : read_id_list(card, 1, card.get_size(), "GRID")) {
    auto from = range.first;
    for (const int id : range.except) {
      if (id > from) line.grids.push_back({from, id - 1, range.step, true});
      from = id + 1;
    }
    line.grids.push_back({from, range.last, range.step, range.is_thru});
  }
  line.at = card.get_location();
  if (card.is_ok() && line.grids.empty())
    card.fail("deck.missing-field", 1, "GRID1 is blank, expected the grids of the rotor");
  if (card.is_ok()) r.rotors.lines.push_back(std::move(line));  // several cards may list the grids of a rotor
}

/// ROTORID GRIDA GRIDB SPDUNIT SPTID, GR ALPHAR1 ALPHAR2 WR3R WR4R WRHR HYBRID.
void parse_rspinr(Card& card, DynamicCards& r) {
  records::RotorSpin spin;
  spin.rotor = card.read_id(0, "ROTORID");
  spin.grid_a = card.read_id(1, "GRIDA");
  spin.grid_b = card.read_id(2, "GRIDB");
  spin.unit = read_speed_unit(card, 3);
  if (card.is_integer(4))
    spin.table = card.read_reference(4, "SPTID");
  else
    spin.rate = card.read_real(4, "SPTID", 1.0);
  spin.gr = card.read_real(8, "GR", 0.0);
  spin.alpha1 = card.read_real(9, "ALPHAR1", 0.0);
  spin.alpha2 = card.read_real(10, "ALPHAR2", 0.0);
  // Older releases have HYBRID, an integer, in place of WR3R.
  for (const int i : {11, 13, 14})
    if (!card.is_blank(i) && (i != 11 || card.is_integer(i)))
      card.demand(false, i, i == 13 ? "WRHR" : "HYBRID", "a blank field: hybrid damping is not supported");
  if (card.is_ok()) spin.wr3 = card.read_real(11, "WR3R", 0.0);
  spin.wr4 = card.read_real(12, "WR4R", 0.0);
  spin.at = card.get_location();
  if (card.is_ok())
    card.demand(spin.grid_a != spin.grid_b, 2, "GRIDB", "another grid than GRIDA: the line is the axis");
  if (card.is_ok()) card.demand(spin.wr3 >= 0, 11, "WR3R", "zero or above");
  if (card.is_ok()) card.demand(spin.wr4 >= 0, 12, "WR4R", "zero or above");
  add_unique(card, r.rotors.spins, std::move(spin), &records::RotorSpin::rotor);
}

/// RID SYNCFLG REFROTR SPDUNIT SPDLOW SPDHIGH SPEED.
void parse_rgyro(Card& card, DynamicCards& r) {
  records::RotorAnalysis a;
  a.sid = card.read_id(0, "RID");
  a.is_synchronous = card.read_word(1, "SYNCFLG", "", {"SYNC", "ASYNC"}) == "SYNC";
  a.reference = card.read_id(2, "REFROTR");
  a.unit = read_speed_unit(card, 3);
  a.low = card.read_real(4, "SPDLOW", 0.0);
  a.high = card.read_real(5, "SPDHIGH", 99999.0);
  if (card.is_integer(6) && !card.is_blank(6))
    a.speeds = card.read_reference(6, "SPEED");
  else
    a.speed = card.read_real(6, "SPEED", 0.0);
  card.use(7, 16);  // superelement of the rotor, damping of others: of transients
  a.at = card.get_location();
  if (card.is_ok()) card.demand(a.low >= 0, 4, "SPDLOW", "zero or above");
  if (card.is_ok()) card.demand(a.high > a.low, 5, "SPDHIGH", "a speed above SPDLOW");
  add_unique(card, r.rotors.analyses, std::move(a), &records::RotorAnalysis::sid);
}

/// SID S1 DS NDS, MDTRAK CORU CORL PRTCOR: modes are followed by their vectors whatever is in the second line.
void parse_rspeed(Card& card, DynamicCards& r) {
  records::SpeedList list;
  list.sid = card.read_id(0, "SID");
  card.read_reals(1, {{"S1", list.first, {}}, {"DS", list.step, {}}});
  list.count = card.read_id(3, "NDS", 1);
  card.use(8, 16);
  list.at = card.get_location();
  if (card.is_ok()) card.demand(list.first >= 0, 1, "S1", "zero or above");
  if (card.is_ok()) card.demand(list.step > 0, 2, "DS", "a step above 0");
  if (card.is_ok()) card.demand(list.count <= 100'000, 3, "NDS", "1 to 100000");
  add_unique(card, r.rotors.speeds, std::move(list), &records::SpeedList::sid);
}

/// ID DVAL1 DVAL2 ..., or DVAL1 THRU DVAL2 BY INC.
void parse_ddval(Card& card, DynamicCards& r) {
  records::ValueList list;
  list.id = card.read_id(0, "ID");
  list.at = card.get_location();
  for (int i = 1; i < card.get_size() && card.is_ok(); ++i) {
    if (card.is_blank(i)) continue;
    if (!card.is_word(i, "THRU")) {
      list.values.push_back(card.read_real(i, "DVAL"));
      continue;
    }
    card.use(i);
    card.demand(!list.values.empty() && card.is_word(i + 2, "BY"), i, "THRU", "DVAL1 THRU DVAL2 BY INC");
    if (!card.is_ok()) break;
    card.use(i + 2);
    const double first = list.values.back(), last = card.read_real(i + 1, "DVAL2"), step = card.read_real(i + 3, "INC");
    card.demand(step > 0 && last > first && (last - first) / step < 1e6, i + 3, "INC", "an increment above 0");
    if (!card.is_ok()) break;
    for (int k = 1; first + k * step < last - 1e-9 * step; ++k) list.values.push_back(first + k * step);
    list.values.push_back(last);
    i += 3;
  }
  if (card.is_ok() && list.values.empty()) card.fail("deck.missing-field", 1, "DVAL1 is blank, expected a value");
  add_unique(card, r.rotors.values, std::move(list), &records::ValueList::id);
}

/// SID RSTART RSTEP NUMSTEP REFSYS CMOUT RUNIT FUNIT, ZSTEIN ORBEPS ROTPRT SYNC ETYPE EORDER, then a line a rotor: RID
/// RSET RSPEED RCORD W3 W4 RFORCE.
void parse_rotord(Card& card, DynamicCards& r) {
  records::RotorSweepCard s;
  s.sid = card.read_id(0, "SID");
  card.read_reals(1, {{"RSTART", s.first, {}}, {"RSTEP", s.step, {}}});
  s.count = card.read_id(3, "NUMSTEP");
  const bool is_rotating = card.read_word(4, "REFSYS", "ROT", {"FIX", "ROT"}) == "ROT";
  s.shapes_at = card.read_real(5, "CMOUT", 0.0);
  const auto unit = card.read_word(6, "RUNIT", "RPM", {"RPM", "CPS", "HZ", "RAD"});
  const double factor = unit == "RPM" ? pi / 30 : unit == "RAD" ? 1 : 2 * pi;
  card.use(7, 16);  // units and amount of what is printed; options of responses
  s.at = card.get_location();
  for (int i = 16; i < card.get_size(); i += 8) {
    if (card.is_blank(i, i + 8)) continue;
    records::RotorSweepCard::Rotor rotor;
    rotor.id = card.read_id(i, "RID", 1 + static_cast<int>(s.rotors.size()));
    rotor.line = card.read_id(i + 1, "RSET");
    rotor.speed = card.read_real(i + 2, "RSPEED", 1.0);
    rotor.cid = card.read_reference(i + 3, "RCORD");
    rotor.w3 = card.read_real(i + 4, "W3", 0.0);
    rotor.w4 = card.read_real(i + 5, "W4", 0.0);
    rotor.is_rotating = is_rotating;
    rotor.has_stress = card.read_reference(i + 6, "RFORCE") != 0;
    rotor.at = card.get_location();
    s.rotors.push_back(rotor);
  }
  if (card.is_ok() && s.rotors.empty())
    card.fail("deck.missing-field", 16, "no line with RSET follows, expected one for each rotor");
  if (card.is_ok())
    card.demand(!is_rotating || s.rotors.size() == 1, 4, "REFSYS",
                "FIX for several rotors: one frame turns with one of them");
  if (card.is_ok()) card.demand(s.first >= 0, 1, "RSTART", "zero or above");
  if (card.is_ok()) card.demand(s.step > 0 || s.count == 1, 2, "RSTEP", "a step above 0");
  if (card.is_ok()) card.demand(s.count <= 100'000, 3, "NUMSTEP", "1 to 100000");
  s.first *= factor;
  s.step *= factor;
  if (s.shapes_at > 0) s.shapes_at *= factor;
  add_unique(card, r.rotors.sweeps, std::move(s), &records::RotorSweepCard::sid);
}

void read_number_or_table(Card& card, int i, const char* what, double fallback, double& value, int& table) {
  if (card.is_integer(i) && !card.is_blank(i))
    table = card.read_reference(i, what);
  else
    value = card.read_real(i, what, fallback);
}

/// SID MASS GRID X1 X2 X3, ROFFSET THETA ZOFFSET FON FOFF.
void parse_unbalnc(Card& card, DynamicCards& r) {
  records::Unbalance u;
  u.sid = card.read_id(0, "SID");
  card.demand(!card.is_blank(1), 1, "MASS", "a mass or a table");
  read_number_or_table(card, 1, "MASS", 0, u.mass, u.mass_table);
  u.grid = card.read_id(2, "GRID");
  const auto x = card.read_vector(3, "X1 X2 X3");
  std::copy(x.begin(), x.end(), u.x);
  read_number_or_table(card, 8, "ROFFSET", 1, u.radius, u.radius_table);
  u.angle_deg = card.read_real(9, "THETA", 0.0);
  read_number_or_table(card, 10, "ZOFFSET", 0, u.offset, u.offset_table);
  u.from_hz = card.read_real(11, "FON", 0.0);
  u.to_hz = card.read_real(12, "FOFF", 1e30);
  card.use(13, 24);  // corrections of transients
  u.at = card.get_location();
  if (card.is_ok()) card.demand(!x.isZero(0), 3, "X1 X2 X3", "a vector that is not zero");
  if (card.is_ok()) card.demand(u.to_hz > u.from_hz, 12, "FOFF", "a frequency above FON");
  if (card.is_ok()) r.rotors.unbalances.push_back(u);
}

/// Speeds per minute remain where the unit of time does; else none are known to be right.
void scale_speeds(UnitConverter& u, bool is_rpm, int first, int last) {
  u.scale(first, last, is_rpm && u.keeps_time() ? "." : is_rpm ? "?" : "Hz");
}
bool is_rpm(const UnitConverter& u, int field) { return make_upper(u.get(field)) != "FREQ"; }
void convert_rspinr(UnitConverter& u) {
  if (!parse_int(u.get(4)) && !u.get(4).empty()) scale_speeds(u, is_rpm(u, 3), 4, 4);
  u.scale(9, "Hz");
  u.scale(10, "T");
  u.scale(11, 12, "Hz");
}
void convert_rgyro(UnitConverter& u) {
  scale_speeds(u, is_rpm(u, 3), 4, 5);
  if (!parse_int(u.get(6)) && !u.get(6).empty()) scale_speeds(u, is_rpm(u, 3), 6, 6);
}
/// In the unit of the card that names it.
void convert_speeds(UnitConverter& u) {
  if (!u.keeps_time()) u.scale(1, u.get_name() == "RSPEED" ? 2 : std::max(u.size() - 1, 1), "?");
}
void convert_rotord(UnitConverter& u) {
  const auto unit = make_upper(u.get(6));
  const bool rpm = unit.empty() || unit == "RPM";
  scale_speeds(u, rpm, 1, 2);
  if (parse_real(u.get(5)).value_or(-1) > 0) scale_speeds(u, rpm, 5, 5);
  for (int line = 16; line < u.size(); line += 8) u.scale(line + 4, line + 5, "Hz");
}
void convert_unbalnc(UnitConverter& u) {
  for (const auto& [field, word] : {std::pair(1, "M"), std::pair(8, "L"), std::pair(10, "L")})
    if (!parse_int(u.get(field)) && !u.get(field).empty()) u.scale(field, word);
  u.scale(11, 12, "Hz");
}
void note_unbalnc(const UnitConverter& u, UnitNotes& notes) {
  for (const int field : {1, 8, 10})
    if (parse_int(u.get(field))) notes.table_axes[u.get(field)].insert("Hz");
}

}  // namespace

const DynamicParserTable& get_rotor_parsers() {
  static const DynamicParserTable table{{"ROTORG", {parse_rotorg, ""}},
                                        {"RSPINR", {parse_rspinr, nullptr, convert_rspinr}},
                                        {"RGYRO", {parse_rgyro, nullptr, convert_rgyro}},
                                        {"RSPEED", {parse_rspeed, nullptr, convert_speeds}},
                                        {"DDVAL", {parse_ddval, nullptr, convert_speeds}},
                                        {"ROTORD", {parse_rotord, nullptr, convert_rotord}},
                                        {"UNBALNC", {parse_unbalnc, nullptr, convert_unbalnc, note_unbalnc}}};
  return table;
}

}  // namespace bough::nastran::detail
