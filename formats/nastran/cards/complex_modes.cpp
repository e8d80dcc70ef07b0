/// \file Cards of complex eigenvalues. Source of the fields: MSC Nastran Quick Reference Guide, EIGC, TF, EPOINT.
#include <algorithm>

#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/detail/unit_converter.hpp"

namespace bough::nastran::detail {
namespace {

using records::ComplexMethod;
using records::DynamicCards;
using records::TransferFunction;

/// SID METHOD NORM G C E ND, then lines of ALPHAA OMEGAA ALPHAB OMEGAB L NE ND; LAN has block sizes in place of the
/// second end.
void parse_eigc(Card& card, DynamicCards& r) {
  static const std::vector<std::string> methods{"LAN", "CLAN", "HESS", "INV", "DET", "ISRR"};
  ComplexMethod m;
  m.sid = card.read_id(0, "SID");
  m.method = card.read_word(1, "METHOD", "LAN", methods);
  m.norm = card.read_word(2, "NORM", "MAX", {"MAX", "POINT"});
  m.norm_grid = card.read_reference(3, "G");
  m.norm_component = card.read_component(4, "C");
  card.use(5);  // E: the residual of every pair is printed
  m.num_modes = card.read_int(6, "ND", 0);
  m.at = card.get_location();
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
    card.use(i + 2, i + 6);
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

TransferFunction::Term read_term(Card& card, int i, const char* g, const char* c, const char* const names[3]) {
  return {card.read_id(i, g), card.read_component(i + 1, c), card.read_real(i + 2, names[0], 0.0),
          card.read_real(i + 3, names[1], 0.0), card.read_real(i + 4, names[2], 0.0)};
}

/// SID GD CD B0 B1 B2, then lines of G C A0 A1 A2.
void parse_tf(Card& card, DynamicCards& r) {
  static constexpr const char *of[] = {"B0", "B1", "B2"}, *with[] = {"A0", "A1", "A2"};
  TransferFunction f;
  f.sid = card.read_id(0, "SID");
  f.of = read_term(card, 1, "GD", "CD", of);
  f.at = card.get_location();
  for (int i = 8; i < card.get_size(); i += 8)
    if (!card.is_blank(i, i + 8)) f.terms.push_back(read_term(card, i, "G", "C", with));
  if (card.is_ok()) r.transfer_functions.push_back(std::move(f));
}

void parse_epoint(Card& card, DynamicCards& r) {
  for (const int id : read_ids(card, 0, card.get_size(), "ID")) r.extra_points.insert(id);
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
  static const DynamicParserTable table{{"EIGC", {parse_eigc, nullptr, convert_eigc}},
                                        {"TF", {parse_tf, nullptr, convert_tf}},
                                        {"EPOINT", {parse_epoint, ""}}};
  return table;
}

}  // namespace bough::nastran::detail
