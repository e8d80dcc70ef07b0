/// Tables over frequency and time, spectral densities. Source of the fields: MSC Nastran Quick Reference Guide, the
/// entries named.
#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/table_points.hpp"
#include "formats/nastran/detail/text.hpp"
#include "formats/nastran/detail/unit_converter.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {
namespace {

using records::DynamicCards;

using records::DynamicTable;

template <int kind>
void list_table(FieldList& f, DynamicTable& t) {
  t.kind = kind;
  list_function_table(f, t);
}
template <int kind>
void parse_table(Card& card, DynamicCards& r) {
  add_unique(card, r.tables, read_function_table(card, kind), &DynamicTable::id);
}

void list_tabrnd1(FieldList& f, DynamicTable& t) { list_axes(f, t, "FLAT"); }

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
  DynamicTable t;
  t.kind = 1;
  read_fields(card, list_tabrnd1, t);
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

void write_dynamic_tables(const DynamicCards& cards, CardSink& sink) {
  for (const auto& t : cards.tables) put_function_table("TABLED" + std::to_string(t.kind), t, sink);
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
  const auto axis = find_table_axis(u), value = find_table_value(u);
  for (int i = 8; i < u.size(); i += 2) {
    u.scale(i, axis);
    u.scale(i + 1, value);
  }
}
void convert_tabled2(UnitConverter& u) {
  u.scale(1, find_table_axis(u));
  convert_tabled1(u);
}
void scale_table_values(UnitConverter& u, int first, int step) {
  const auto value = find_table_value(u);
  for (int i = first; i < u.size(); i += step) u.scale(i, value);
}
/// Scales X1 and X2; the table is one of (x - X1) / X2.
void convert_tabled3(UnitConverter& u) {
  u.scale(1, 2, find_table_axis(u));
  scale_table_values(u, 9, 2);
}
void convert_tabled4(UnitConverter& u) {
  u.scale(1, 4, find_table_axis(u));
  scale_table_values(u, 8, 1);
}

}  // namespace

void add_dynamic_tables(DynamicParserTable& table) {
  table["TABLED1"] = {parse_table<1>, nullptr, convert_tabled1};
  table["TABLED1"].names = name_fields(list_table<1>);
  table["TABLED2"] = {parse_table<2>, nullptr, convert_tabled2};
  table["TABLED2"].names = name_fields(list_table<2>);
  table["TABLED3"] = {parse_table<3>, nullptr, convert_tabled3};
  table["TABLED3"].names = name_fields(list_table<3>);
  table["TABLED4"] = {parse_table<4>, nullptr, convert_tabled4};
  table["TABLED4"].names = name_fields(list_table<4>);
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
