#include "formats/nastran/detail/table_points.hpp"

#include <algorithm>

namespace bough::nastran::detail {

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

void refuse_jumps_at_ends(Card& card, const std::vector<std::pair<double, double>>& points) {
  const std::size_t n = points.size();
  if (n < 2 || !card.is_ok()) return;
  if (points[0].first == points[1].first || points[n - 2].first == points[n - 1].first)
    card.fail("deck.field-range", 8,
              "the table jumps at its first or last two points, between which it goes on beyond its ends; one point "
              "more before or behind the jump says how");
}

void list_axes(FieldList& f, records::FunctionTable& t, const char* beyond_name) {
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

void list_function_table(FieldList& f, records::FunctionTable& t) {
  if (t.kind == 1) return list_axes(f, t, "EXTRAP");
  f.id("TID", t.id).real("X1", t.x1, 0.0);
  if (t.kind > 2) f.real("X2", t.x2);
  if (t.kind > 3) f.real("X3", t.x3).real("X4", t.x4);
}

void read_axis_points(Card& card, records::FunctionTable& t) {
  t.points = read_points(card, 8);
  if (!t.is_flat) refuse_jumps_at_ends(card, t.points);
  for (const auto& [x, y] : t.points)
    if (card.is_ok() && ((t.is_log_x && x <= 0) || (t.is_log_y && y <= 0)))
      card.fail("deck.field-range", 8, "a LOG axis has a value that is not above 0");
}

records::FunctionTable read_function_table(Card& card, int kind) {
  records::FunctionTable t;
  t.kind = kind;
  read_fields(card, list_function_table, t);
  if (kind > 2 && card.is_ok()) card.demand(t.x2 != 0, 2, "X2", "another number than 0");
  if (kind == 1) {
    read_axis_points(card, t);
  } else if (kind < 4) {
    t.points = read_points(card, 8);
    refuse_jumps_at_ends(card, t.points);
  } else {
    if (card.is_ok()) card.demand(t.x4 > t.x3, 4, "X4", "a number above X3");
    for (int i = 8; i < card.get_size() && card.is_ok(); ++i) {
      if (card.is_word(i, "ENDT")) {
        card.use(i, card.get_size());
        break;
      }
      t.coefficients.push_back(card.read_real(i, "Ai", 0.0));
    }
    if (card.is_ok() && t.coefficients.empty()) card.fail("deck.missing-field", 8, "no coefficient is given");
  }
  if (card.is_ok() && kind != 4 && t.points.size() < 2)
    card.fail("deck.missing-field", 10, "the table has one pair x y, expected two at least");
  return t;
}

void put_points(CardFields card, const std::vector<std::pair<double, double>>& points, CardSink& sink) {
  card.end_line();
  for (const auto& [x, y] : points) card.add(x).add(y);
  sink.put(card.add_word("ENDT"));
}

void put_function_table(const std::string& name, const records::FunctionTable& t, CardSink& sink) {
  auto card = make_fields(name.c_str(), list_function_table, t);
  if (t.kind != 4) return put_points(std::move(card), t.points, sink);
  card.end_line();
  for (const double a : t.coefficients) card.add(a);
  sink.put(card.add_word("ENDT"));
}

}  // namespace bough::nastran::detail
