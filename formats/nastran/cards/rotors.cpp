/// \file Cards of rotors. Source of the fields: MSC Nastran Quick Reference Guide, ROTORG, RSPINR, RGYRO, RSPEED,
/// DDVAL, UNBALNC; Simcenter Nastran Quick Reference Guide, ROTORD.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/field_list.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;
using std::numbers::pi;

/// SPDUNIT: radians per unit of time of one unit: revolutions per minute, or per unit of time.
FieldList& list_speed_unit(FieldList& f, double& unit) {
  return f.field(
      "SPDUNIT",
      [&](Card& card, int i) {
        unit = card.read_word(i, "SPDUNIT", "", {"RPM", "FREQ"}) == "RPM" ? pi / 30 : 2 * pi;
      },
      [&](CardFields& out) { out.add_word(unit < 1 ? "RPM" : "FREQ"); });
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

void list_rspinr(FieldList& f, records::RotorSpin& spin) {
  f.id("ROTORID", spin.rotor).id("GRIDA", spin.grid_a).id("GRIDB", spin.grid_b);
  list_speed_unit(f, spin.unit).set_or_real("SPTID", spin.table, spin.rate, 1.0).blank(3);
  f.real("GR", spin.gr, 0.0).real("ALPHAR1", spin.alpha1, 0.0).real("ALPHAR2", spin.alpha2, 0.0);
  f.field(
      "WR3R",
      [&](Card& card, int i) {
        // Older releases have HYBRID, an integer, in place of WR3R.
        for (const int k : {i, i + 2, i + 3})
          if (!card.is_blank(k) && (k != i || card.is_integer(k)))
            card.demand(false, k, k == i + 2 ? "WRHR" : "HYBRID", "a blank field: hybrid damping is not supported");
        if (card.is_ok()) spin.wr3 = card.read_real(i, "WR3R", 0.0);
      },
      [&](CardFields& out) { out.add(spin.wr3); });
  f.real("WR4R", spin.wr4, 0.0);
}
void parse_rspinr(Card& card, DynamicCards& r) {
  records::RotorSpin spin;
  read_fields(card, list_rspinr, spin);
  if (card.is_ok())
    card.demand(spin.grid_a != spin.grid_b, 2, "GRIDB", "another grid than GRIDA: the line is the axis");
  if (card.is_ok()) card.demand(spin.wr3 >= 0, 11, "WR3R", "zero or above");
  if (card.is_ok()) card.demand(spin.wr4 >= 0, 12, "WR4R", "zero or above");
  add_unique(card, r.rotors.spins, std::move(spin), &records::RotorSpin::rotor);
}

void list_rgyro(FieldList& f, records::RotorAnalysis& a) {
  f.id("RID", a.sid);
  f.field(
      "SYNCFLG",
      [&](Card& card, int i) {
        a.is_synchronous = card.read_word(i, "SYNCFLG", "", {"SYNC", "ASYNC"}) == "SYNC";
      },
      [&](CardFields& out) { out.add_word(a.is_synchronous ? "SYNC" : "ASYNC"); });
  list_speed_unit(f.id("REFROTR", a.reference), a.unit).real("SPDLOW", a.low, 0.0).real("SPDHIGH", a.high, 99999.0);
  f.set_or_real("SPEED", a.speeds, a.speed);
}
void parse_rgyro(Card& card, DynamicCards& r) {
  records::RotorAnalysis a;
  read_fields(card, list_rgyro, a);
  card.use_unkept(7, 16);  // superelement of the rotor, damping of others: of transients
  if (card.is_ok()) card.demand(a.low >= 0, 4, "SPDLOW", "zero or above");
  if (card.is_ok()) card.demand(a.high > a.low, 5, "SPDHIGH", "a speed above SPDLOW");
  add_unique(card, r.rotors.analyses, std::move(a), &records::RotorAnalysis::sid);
}

void list_rspeed(FieldList& f, records::SpeedList& list) {
  f.id("SID", list.sid).real("S1", list.first).real("DS", list.step).id("NDS", list.count, 1);
}
/// The second line has MDTRAK CORU CORL PRTCOR: modes are followed by their vectors whatever is in it.
void parse_rspeed(Card& card, DynamicCards& r) {
  records::SpeedList list;
  read_fields(card, list_rspeed, list);
  card.use_unkept(8, 16);
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

using records::RotorSweepCard;

/// A line for each rotor follows. Speeds are written in radians per unit of time, as they are kept.
void list_rotord(FieldList& f, RotorSweepCard& s, bool& is_fixed, double& unit) {
  f.id("SID", s.sid).real("RSTART", s.first).real("RSTEP", s.step).id("NUMSTEP", s.count);
  f.flag("REFSYS", is_fixed, "ROT", "FIX").real("CMOUT", s.shapes_at, 0.0);
  f.field(
      "RUNIT",
      [&](Card& card, int i) {
        const auto word = card.read_word(i, "RUNIT", "RPM", {"RPM", "CPS", "HZ", "RAD"});
        unit = word == "RPM" ? pi / 30 : word == "RAD" ? 1 : 2 * pi;
      },
      [](CardFields& out) { out.add_word("RAD"); });
}

/// The fields of list_rotord and further ones, then a line a rotor: RID RSET RSPEED RCORD W3 W4 RFORCE.
void parse_rotord(Card& card, DynamicCards& r) {
  RotorSweepCard s;
  bool is_fixed = false;
  double factor = 1;
  FieldList fields(card);
  list_rotord(fields, s, is_fixed, factor);
  const bool is_rotating = !is_fixed;
  card.use_unkept(7, 16);  // units and amount of what is printed; options of responses
  s.at = card.get_location();
  for (int i = 16; i < card.get_size(); i += 8) {
    if (card.is_blank(i, i + 8)) continue;
    RotorSweepCard::Rotor rotor;
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
  add_unique(card, r.rotors.sweeps, std::move(s), &RotorSweepCard::sid);
}

void list_unbalnc(FieldList& f, records::Unbalance& u) {
  f.id("SID", u.sid).set_or_real("MASS", u.mass_table, u.mass).id("GRID", u.grid);
  f.real("X1", u.x[0], 0.0).real("X2", u.x[1], 0.0).real("X3", u.x[2], 0.0).blank(2);
  f.set_or_real("ROFFSET", u.radius_table, u.radius, 1.0).real("THETA", u.angle_deg, 0.0);
  f.set_or_real("ZOFFSET", u.offset_table, u.offset).real("FON", u.from_hz, 0.0).real("FOFF", u.to_hz, 1e30);
}
void parse_unbalnc(Card& card, DynamicCards& r) {
  records::Unbalance u;
  card.demand(!card.is_blank(1), 1, "MASS", "a mass or a table");
  read_fields(card, list_unbalnc, u);
  card.use_unkept(13, 24);  // corrections of transients
  if (card.is_ok()) card.demand(u.x[0] != 0 || u.x[1] != 0 || u.x[2] != 0, 3, "X1 X2 X3", "a vector that is not zero");
  if (card.is_ok()) card.demand(u.to_hz > u.from_hz, 12, "FOFF", "a frequency above FON");
  if (card.is_ok()) r.rotors.unbalances.push_back(u);
}

void write_rotor_lines(const DynamicCards& cards, CardSink& sink) {
  for (const auto& line : cards.rotors.lines) {
    CardFields card("ROTORG");
    card.add(line.id);
    for (const auto& range : line.grids) {
      card.add(range.first);
      if (!range.is_thru) continue;
      card.add_word("THRU").add(range.last);
      if (range.step > 1) card.add_word("BY").add(range.step);
    }
    sink.put(card);
  }
}
void write_rotor_speeds(const DynamicCards& cards, CardSink& sink) {
  const auto& rotors = cards.rotors;
  for (const auto& spin : rotors.spins) sink.put(make_fields("RSPINR", list_rspinr, spin));
  for (const auto& analysis : rotors.analyses) sink.put(make_fields("RGYRO", list_rgyro, analysis));
  for (const auto& list : rotors.speeds) sink.put(make_fields("RSPEED", list_rspeed, list));
  for (const auto& list : rotors.values) {
    CardFields card("DDVAL");
    card.add(list.id);
    for (const double value : list.values) card.add(value);
    sink.put(card);
  }
}
void write_rotor_sweeps(const DynamicCards& cards, CardSink& sink) {
  for (auto sweep : cards.rotors.sweeps) {
    CardFields card("ROTORD");
    FieldList fields(card);
    bool is_fixed = !sweep.rotors.front().is_rotating;
    double unit = 1;
    list_rotord(fields, sweep, is_fixed, unit);
    card.end_line().add_blank(8);
    for (const auto& rotor : sweep.rotors) {
      card.end_line().add(rotor.id).add(rotor.line).add(rotor.speed).add_id(rotor.cid).add(rotor.w3).add(rotor.w4);
      card.add_id(rotor.has_stress ? 1 : 0);  // the record does not keep the set
    }
    sink.put(card);
  }
}
void write_unbalances(const DynamicCards& cards, CardSink& sink) {
  for (const auto& u : cards.rotors.unbalances) sink.put(make_fields("UNBALNC", list_unbalnc, u));
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
  for (const auto& [field, word] : {std::pair(1, "M"), std::pair(8, "L"), std::pair(10, "L")})
    if (parse_int(u.get(field))) {
      notes.table_axes[u.get(field)].insert("Hz");
      notes.table_values[u.get(field)].insert(word);
    }
}

}  // namespace

const DynamicParserTable& get_rotor_parsers() {
  static const DynamicParserTable table = [] {
    DynamicParserTable t;
    t["ROTORG"] = {parse_rotorg, ""};
    t["RSPINR"] = {parse_rspinr, nullptr, convert_rspinr};
    t["RSPINR"].names = name_fields(list_rspinr);
    t["RGYRO"] = {parse_rgyro, nullptr, convert_rgyro};
    t["RGYRO"].names = name_fields(list_rgyro);
    t["RSPEED"] = {parse_rspeed, nullptr, convert_speeds};
    t["RSPEED"].names = name_fields(list_rspeed);
    t["DDVAL"] = {parse_ddval, nullptr, convert_speeds};
    t["ROTORD"] = {parse_rotord, nullptr, convert_rotord};
    t["ROTORD"].names = "SID RSTART RSTEP NUMSTEP REFSYS CMOUT RUNIT";
    t["UNBALNC"] = {parse_unbalnc, nullptr, convert_unbalnc, note_unbalnc};
    t["UNBALNC"].names = name_fields(list_unbalnc);
    set_writer(t, write_rotor_lines, {"ROTORG"});
    set_writer(t, write_rotor_speeds, {"RSPINR", "RGYRO", "RSPEED", "DDVAL"});
    set_writer(t, write_rotor_sweeps, {"ROTORD"});
    set_writer(t, write_unbalances, {"UNBALNC"});
    return t;
  }();
  return table;
}

}  // namespace bough::nastran::detail
