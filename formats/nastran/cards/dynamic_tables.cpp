/// Tables over frequency and time, spectral densities. Source of the fields: MSC Nastran Quick Reference Guide, the
/// entries named.
#include <algorithm>

#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/field_list.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;

/// Pairs from field `first` on, up to ENDT; ascending, unchanged or reversed.
std::vector<std::pair<double, double>> read_points(Card& card, int first) {
  std::vector<std::pair<double, double>> points;
  bool has_end = false;
  for (int i = first; i < card.get_size() && card.is_ok(); i += 2) {
    card.use(i, i + 2);
    if (card.is_word(i, "ENDT") || card.is_word(i + 1, "ENDT")) {
      if (!card.is_word(i, "ENDT"))
        card.fail("deck.missing-field", i + 1, "ENDT is in place of y, expected the end after a pair x y");
      card.use(i, card.get_size());
      has_end = true;
      break;
    }
    if (card.is_blank(i, i + 2) || card.is_word(i, "SKIP") || card.is_word(i + 1, "SKIP")) continue;
    const double x = card.read_real(i, "x");
    points.emplace_back(x, card.read_real(i + 1, "y"));
  }
  if (!card.is_ok()) return points;
  if (points.empty()) card.fail("deck.missing-field", first, "no pair x y is given, expected one at least");
  if (!has_end && card.is_ok()) card.fail("deck.missing-field", first, "the table does not end with ENDT");
  if (points.size() > 1 && points.front().first > points.back().first) std::reverse(points.begin(), points.end());
  for (std::size_t i = 1; i < points.size() && card.is_ok(); ++i)
    if (points[i].first < points[i - 1].first || (i > 1 && points[i].first == points[i - 2].first))
      card.fail("deck.field-range", first, "x does not go in one direction, or stands more than twice");
  return points;
}

/// Beyond its ends a table goes on along the line of its last two points, which a jump there does not have.
void refuse_jumps_at_ends(Card& card, const std::vector<std::pair<double, double>>& points) {
  const std::size_t n = points.size();
  if (n < 2 || !card.is_ok()) return;
  if (points[0].first == points[1].first || points[n - 2].first == points[n - 1].first)
    card.fail("deck.field-range", 8,
              "the table jumps at its first or last two points, between which it goes on beyond its ends; one point "
              "more before or behind the jump says how");
}

using records::DynamicTable;

DynamicTable read_table(Card& card, int kind, void (*list)(FieldList&, DynamicTable&)) {
  DynamicTable table;
  table.kind = kind;
  read_fields(card, list, table);
  return table;
}
void add_table(Card& card, DynamicCards& r, records::DynamicTable table) {
  if (card.is_ok() && table.kind != 4 && table.points.size() < 2)
    card.fail("deck.missing-field", 10, "the table has one pair x y, expected two at least");
  add_unique(card, r.tables, std::move(table), &std::remove_reference_t<decltype(table)>::id);
}

/// Adds a table with the pairs of its card from the second line on.
void add_table_of_points(Card& card, DynamicCards& r, records::DynamicTable table) {
  table.points = read_points(card, 8);
  refuse_jumps_at_ends(card, table.points);
  add_table(card, r, std::move(table));
}

/// TID XAXIS YAXIS and how the table continues beyond its ends.
void list_axes(FieldList& f, DynamicTable& t, const char* beyond_name) {
  f.id("TID", t.id).flag("XAXIS", t.is_log_x, "LINEAR", "LOG").flag("YAXIS", t.is_log_y, "LINEAR", "LOG");
  f.field(
      beyond_name,
      [&](Card& card, int i) {
        const int beyond = card.read_int(i, beyond_name, 0);
        if (card.is_ok())
          card.demand(beyond == 0 || beyond == 1, i, beyond_name, "0 (the last line goes on) or 1 (end values)");
        t.is_flat = beyond == 1;
      },
      [&](CardFields& out) { out.add(t.is_flat ? 1 : 0); });
}
void list_tabled1(FieldList& f, DynamicTable& t) { list_axes(f, t, "EXTRAP"); }
void list_tabrnd1(FieldList& f, DynamicTable& t) { list_axes(f, t, "FLAT"); }
void list_tabled2(FieldList& f, DynamicTable& t) { f.id("TID", t.id).real("X1", t.x1, 0.0); }
void list_tabled3(FieldList& f, DynamicTable& t) { f.id("TID", t.id).real("X1", t.x1, 0.0).real("X2", t.x2); }
void list_tabled4(FieldList& f, DynamicTable& t) {
  list_tabled3(f, t);
  f.real("X3", t.x3).real("X4", t.x4);
}

/// Pairs from the second line on, of a table whose axes are read.
void read_axis_points(Card& card, DynamicTable& t) {
  t.points = read_points(card, 8);
  if (!t.is_flat) refuse_jumps_at_ends(card, t.points);
  for (const auto& [x, y] : t.points)
    if (card.is_ok() && ((t.is_log_x && x <= 0) || (t.is_log_y && y <= 0)))
      card.fail("deck.field-range", 8, "a LOG axis has a value that is not above 0");
}

void parse_tabled1(Card& card, DynamicCards& r) {
  auto t = read_table(card, 1, list_tabled1);
  read_axis_points(card, t);
  add_table(card, r, std::move(t));
}
void parse_tabled2(Card& card, DynamicCards& r) { add_table_of_points(card, r, read_table(card, 2, list_tabled2)); }
void parse_tabled3(Card& card, DynamicCards& r) {
  auto t = read_table(card, 3, list_tabled3);
  if (card.is_ok()) card.demand(t.x2 != 0, 2, "X2", "another number than 0");
  add_table_of_points(card, r, std::move(t));
}
void parse_tabled4(Card& card, DynamicCards& r) {
  auto t = read_table(card, 4, list_tabled4);
  if (card.is_ok()) card.demand(t.x2 != 0, 2, "X2", "another number than 0");
  if (card.is_ok()) card.demand(t.x4 > t.x3, 4, "X4", "a number above X3");
  for (int i = 8; i < card.get_size() && card.is_ok(); ++i) {
    if (card.is_word(i, "ENDT")) {
      card.use(i, card.get_size());
      break;
    }
    t.coefficients.push_back(card.read_real(i, "Ai", 0.0));
  }
  if (card.is_ok() && t.coefficients.empty()) card.fail("deck.missing-field", 8, "no coefficient is given");
  add_table(card, r, std::move(t));
}

void list_tabdmp1(FieldList& f, records::DampingCurve& t) {
  f.id("TID", t.id).word("TYPE", t.type, "G", {"G", "CRIT", "Q"});
}
void parse_tabdmp1(Card& card, DynamicCards& r) {
  records::DampingCurve t;
  read_fields(card, list_tabdmp1, t);
  t.points = read_points(card, 8);
  refuse_jumps_at_ends(card, t.points);
  for (const auto& [hz, value] : t.points)
    if (card.is_ok() && t.type == "Q" && value <= 0) card.fail("deck.field-range", 8, "a quality Q is not above 0");
  add_unique(card, r.damping, std::move(t), &std::remove_reference_t<decltype(t)>::id);
}

void parse_tabrnd1(Card& card, DynamicCards& r) {
  auto t = read_table(card, 1, list_tabrnd1);
  read_axis_points(card, t);
  add_unique(card, r.spectra, std::move(t), &DynamicTable::id);
}

void list_tabrndg(FieldList& f, records::GustSpectrum& t) {
  f.id("TID", t.id);
  f.field(
      "TYPE",
      [&](Card& card, int i) {
        const int type = card.read_int(i, "TYPE", 1);
        if (card.is_ok()) card.demand(type == 1 || type == 2, i, "TYPE", "1 (von Karman) or 2 (Dryden)");
        t.is_dryden = type == 2;
      },
      [&](CardFields& out) { out.add(t.is_dryden ? 2 : 1); });
  f.real("L/U", t.length_over_speed).real("WG", t.rms);
}
void parse_tabrndg(Card& card, DynamicCards& r) {
  records::GustSpectrum t;
  read_fields(card, list_tabrndg, t);
  if (card.is_ok()) card.demand(t.length_over_speed > 0, 2, "L/U", "a number above 0");
  add_unique(card, r.gust_spectra, std::move(t), &std::remove_reference_t<decltype(t)>::id);
}

/// Pairs from the second line on, and ENDT.
void put_points(CardFields card, const std::vector<std::pair<double, double>>& points, CardSink& sink) {
  card.end_line();
  for (const auto& [x, y] : points) card.add(x).add(y);
  sink.put(card.add_word("ENDT"));
}

void write_dynamic_tables(const DynamicCards& cards, CardSink& sink) {
  for (const auto& t : cards.tables) {
    if (t.kind == 1) put_points(make_fields("TABLED1", list_tabled1, t), t.points, sink);
    if (t.kind == 2) put_points(make_fields("TABLED2", list_tabled2, t), t.points, sink);
    if (t.kind == 3) put_points(make_fields("TABLED3", list_tabled3, t), t.points, sink);
    if (t.kind != 4) continue;
    auto card = make_fields("TABLED4", list_tabled4, t);
    card.end_line();
    for (const double a : t.coefficients) card.add(a);
    sink.put(card.add_word("ENDT"));
  }
}
void write_damping_tables(const DynamicCards& cards, CardSink& sink) {
  for (const auto& t : cards.damping) put_points(make_fields("TABDMP1", list_tabdmp1, t), t.points, sink);
}
void write_spectra(const DynamicCards& cards, CardSink& sink) {
  for (const auto& t : cards.spectra) put_points(make_fields("TABRND1", list_tabrnd1, t), t.points, sink);
  for (const auto& t : cards.gust_spectra) sink.put(make_fields("TABRNDG", list_tabrndg, t));
}

void convert_tabrnd1(UnitConverter& u) {
  for (int i = 8; i < u.size(); i += 2) {
    u.scale(i, "Hz");
    u.scale(i + 1, "T");
  }
}
void convert_tabdmp1(UnitConverter& u) {
  for (int i = 8; i < u.size(); i += 2) u.scale(i, "Hz");
}

/// Dimension of the argument of a table by the loads that name it.
std::string find_table_axis(const UnitConverter& u) {
  const auto& axes = u.get_notes().table_axes;
  const auto found = axes.find(u.get(0));
  if (found != axes.end() && found->second.size() == 1) return *found->second.begin();
  return u.keeps_time() ? "." : "?";
}
void convert_tabled1(UnitConverter& u) {
  const auto axis = find_table_axis(u);
  for (int i = 8; i < u.size(); i += 2) u.scale(i, axis);
}
void convert_tabled2(UnitConverter& u) {
  u.scale(1, find_table_axis(u));
  convert_tabled1(u);
}
/// Scales X1 and X2; the table is one of (x - X1) / X2.
void convert_tabled3(UnitConverter& u) { u.scale(1, 2, find_table_axis(u)); }
void convert_tabled4(UnitConverter& u) { u.scale(1, 4, find_table_axis(u)); }

}  // namespace

void add_dynamic_tables(DynamicParserTable& table) {
  table["TABLED1"] = {parse_tabled1, nullptr, convert_tabled1};
  table["TABLED1"].names = name_fields(list_tabled1);
  table["TABLED2"] = {parse_tabled2, nullptr, convert_tabled2};
  table["TABLED2"].names = name_fields(list_tabled2);
  table["TABLED3"] = {parse_tabled3, nullptr, convert_tabled3};
  table["TABLED3"].names = name_fields(list_tabled3);
  table["TABLED4"] = {parse_tabled4, nullptr, convert_tabled4};
  table["TABLED4"].names = name_fields(list_tabled4);
  table["TABDMP1"] = {parse_tabdmp1, nullptr, convert_tabdmp1};
  table["TABDMP1"].names = name_fields(list_tabdmp1);
  table["TABRND1"] = {parse_tabrnd1, nullptr, convert_tabrnd1};
  table["TABRND1"].names = name_fields(list_tabrnd1);
  table["TABRNDG"] = {parse_tabrndg, ". . T ?"};
  table["TABRNDG"].names = name_fields(list_tabrndg);
  set_writer(table, write_dynamic_tables, {"TABLED1", "TABLED2", "TABLED3", "TABLED4"});
  set_writer(table, write_damping_tables, {"TABDMP1"});
  set_writer(table, write_spectra, {"TABRND1", "TABRNDG"});
}

}  // namespace bough::nastran::detail
