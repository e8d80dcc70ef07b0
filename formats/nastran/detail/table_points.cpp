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

void read_axes(Card& card, records::FunctionTable& t, const char* beyond_name) {
  t.is_log_x = card.read_word(1, "XAXIS", "LINEAR", {"LINEAR", "LOG"}) == "LOG";
  t.is_log_y = card.read_word(2, "YAXIS", "LINEAR", {"LINEAR", "LOG"}) == "LOG";
  const int beyond = card.read_int(3, beyond_name, 0);
  if (card.is_ok())
    card.demand(beyond == 0 || beyond == 1, 3, beyond_name, "0 (the last line goes on) or 1 (end values)");
  t.is_flat = beyond == 1;
  t.points = read_points(card, 8);
  if (!t.is_flat) refuse_jumps_at_ends(card, t.points);
  for (const auto& [x, y] : t.points)
    if (card.is_ok() && ((t.is_log_x && x <= 0) || (t.is_log_y && y <= 0)))
      card.fail("deck.field-range", 8, "a LOG axis has a value that is not above 0");
}

records::FunctionTable read_function_table(Card& card, int kind) {
  records::FunctionTable t;
  t.id = card.read_id(0, "TID");
  t.kind = kind;
  t.at = card.get_location();
  if (kind == 1) {
    read_axes(card, t, "EXTRAP");
  } else if (kind < 4) {
    t.x1 = card.read_real(1, "X1", 0.0);
    if (kind == 3) t.x2 = card.read_real(2, "X2");
    if (card.is_ok()) card.demand(t.x2 != 0, 2, "X2", "another number than 0");
    t.points = read_points(card, 8);
    refuse_jumps_at_ends(card, t.points);
  } else {
    card.read_reals(1, {{"X1", t.x1, 0.0}, {"X2", t.x2}, {"X3", t.x3}, {"X4", t.x4}});
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
  }
  if (card.is_ok() && kind != 4 && t.points.size() < 2)
    card.fail("deck.missing-field", 10, "the table has one pair x y, expected two at least");
  return t;
}

}  // namespace bough::nastran::detail
