/// \file Cards of complex eigenvalues. Source of the fields: MSC Nastran Quick Reference Guide, EIGC, TF, EPOINT.
#include "formats/nastran/detail/card_sink.hpp"
#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/field_list.hpp"
#include "formats/nastran/detail/unit_converter.hpp"
#include "formats/nastran/detail/write_order.hpp"

namespace bough::nastran::detail {
namespace {

using records::ComplexMethod;
using records::DynamicCards;
using records::TransferFunction;

void list_eigc(FieldList& f, ComplexMethod& m) {
  f.id("SID", m.sid).word("METHOD", m.method, "LAN", {"LAN", "CLAN", "HESS", "INV", "DET", "ISRR"});
  f.word("NORM", m.norm, "MAX", {"MAX", "POINT"}).reference("G", m.norm_grid).component("C", m.norm_component);
  f.field(
      "E", [](Card&, int) {}, [](CardFields& out) { out.add_blank(); });
  f.integer("ND", m.num_modes, 0);
}

/// The fields of list_eigc, then lines of ALPHAA OMEGAA ALPHAB OMEGAB L NE ND; LAN has block sizes in place of the
/// second end.
void parse_eigc(Card& card, DynamicCards& r) {
  ComplexMethod m;
  read_fields(card, list_eigc, m);
  card.use_unkept(5, 6);  // E: a limit of convergence
  card.demand(m.num_modes >= 0, 6, "ND", "zero or a positive integer");
  const bool has_ends = m.method == "INV" || m.method == "DET";
  for (int i = 8; i < card.get_size(); i += 8) {
    if (card.is_blank(i, i + 8)) continue;
    ComplexMethod::Shift shift;
    shift.alpha = card.read_real(i, "ALPHAA", 0.0);
    shift.omega = card.read_real(i + 1, "OMEGAA", 0.0);
    if (has_ends) {
      // A search along a line between two points: the roots nearest to its middle.
      shift.alpha = (shift.alpha + card.read_real(i + 2, "ALPHAB", shift.alpha)) / 2;
      shift.omega = (shift.omega + card.read_real(i + 3, "OMEGAB", shift.omega)) / 2;
    }
    card.use_unkept(has_ends ? i + 4 : i + 2, i + 6);
    shift.num_modes = card.read_int(i + 6, "ND", 0);
    card.demand(shift.num_modes >= 0, i + 6, "ND", "zero or a positive integer");
    m.shifts.push_back(shift);
  }
  if (m.norm == "POINT" && m.norm_grid == 0 && card.is_ok())
    card.fail("deck.missing-field", 3, "G is blank, expected the grid of NORM = POINT");
  if (has_ends && m.shifts.empty() && card.is_ok())
    card.fail("deck.missing-field", 8, "METHOD " + m.method + " has no line with ALPHAA and OMEGAA",
              "add the line of the search region, or use METHOD LAN or HESS");
  add_unique(card, r.complex_methods, std::move(m), &ComplexMethod::sid);
}

void list_tf(FieldList& f, TransferFunction& t) {
  f.id("SID", t.sid).id("GD", t.of.g).component("CD", t.of.c);
  f.real("B0", t.of.a0, 0.0).real("B1", t.of.a1, 0.0).real("B2", t.of.a2, 0.0);
}
TransferFunction::Term read_term(Card& card, int i) {
  return {card.read_id(i, "G"), card.read_component(i + 1, "C"), card.read_real(i + 2, "A0", 0.0),
          card.read_real(i + 3, "A1", 0.0), card.read_real(i + 4, "A2", 0.0)};
}

/// The fields of list_tf, then lines of G C A0 A1 A2.
void parse_tf(Card& card, DynamicCards& r) {
  TransferFunction f;
  read_fields(card, list_tf, f);
  for (int i = 8; i < card.get_size(); i += 8)
    if (!card.is_blank(i, i + 8)) f.terms.push_back(read_term(card, i));
  if (card.is_ok()) r.transfer_functions.push_back(std::move(f));
}

void parse_epoint(Card& card, DynamicCards& r) {
  for (const int id : read_ids(card, 0, card.get_size(), "ID")) r.extra_points.insert(id);
}

/// A region between two ends is written as the shift at its middle, which it is read as.
void write_complex_methods(const DynamicCards& cards, CardSink& sink) {
  for (const auto& m : cards.complex_methods) {
    auto card = make_fields("EIGC", list_eigc, m);
    for (const auto& shift : m.shifts) {
      card.end_line().add(shift.alpha).add(shift.omega).add_blank(4);
      card.add_id(shift.num_modes);
    }
    sink.put(card);
  }
}
void write_transfer_functions(const DynamicCards& cards, CardSink& sink) {
  for (const auto& f : cards.transfer_functions) {
    auto card = make_fields("TF", list_tf, f);
    for (const auto& term : f.terms) card.end_line().add(term.g).add(term.c).add(term.a0).add(term.a1).add(term.a2);
    sink.put(card);
  }
}
void write_extra_points(const DynamicCards& cards, CardSink& sink) {
  for (const int id : cards.extra_points) sink.put(CardFields("EPOINT").add(id));
}

/// Shifts, or ends and width of regions; LAN and CLAN have block sizes there.
void convert_eigc(UnitConverter& u) {
  const bool has_ends = u.get(1) == "INV" || u.get(1) == "DET";
  for (int line = 8; line < u.size(); line += 8) u.scale(line, line + (has_ends ? 4 : 1), "Hz");
}
/// An extra point has any unit, and so have the factors of a function that connects one.
void convert_tf(UnitConverter& u) {
  u.scale(3, 5, "?");
  for (int line = 8; line < u.size(); line += 8) u.scale(line + 2, line + 4, "?");
}

}  // namespace

const DynamicParserTable& get_complex_parsers() {
  static const DynamicParserTable table = [] {
    DynamicParserTable t;
    t["EIGC"] = {parse_eigc, nullptr, convert_eigc};
    t["EIGC"].names = name_fields(list_eigc);
    t["TF"] = {parse_tf, nullptr, convert_tf};
    t["TF"].names = name_fields(list_tf);
    t["EPOINT"] = {parse_epoint, ""};
    set_writer(t, write_complex_methods, {"EIGC"});
    set_writer(t, write_transfer_functions, {"TF"});
    set_writer(t, write_extra_points, {"EPOINT"});
    return t;
  }();
  return table;
}

}  // namespace bough::nastran::detail
