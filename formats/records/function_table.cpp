#include "formats/records/function_table.hpp"

#include <algorithm>
#include <cmath>

namespace bough::records {
namespace {

using Point = std::pair<double, double>;

/// On the line through a and b, on logarithmic axes where asked.
double interpolate(const Point& a, const Point& b, double x, bool is_log_x, bool is_log_y) {
  const auto at = [&](double v) { return is_log_x ? std::log(v) : v; };
  const double share = (at(x) - at(a.first)) / (at(b.first) - at(a.first));
  if (is_log_y) return std::exp(std::log(a.second) + share * (std::log(b.second) - std::log(a.second)));
  return a.second + share * (b.second - a.second);
}

double evaluate_points(const FunctionTable& table, double x, Side side, double reach) {
  const auto& p = table.points;
  if (p.size() == 1) return p.front().second;
  if (table.is_flat && x < p.front().first - reach) return p.front().second;
  if (table.is_flat && x > p.back().first + reach) return p.back().second;
  const auto is_jump = [&](std::size_t i) { return i + 1 < p.size() && p[i].first == p[i + 1].first; };
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (std::abs(p[i].first - x) > reach) continue;
    if (!is_jump(i)) return p[i].second;
    return side == Side::Before  ? p[i].second
           : side == Side::After ? p[i + 1].second
                                 : 0.5 * (p[i].second + p[i + 1].second);
  }
  if (table.is_log_x && x <= 0) return p.front().second;
  // The piece around x, or the last one on its side that is no jump.
  std::size_t i = 1;
  while (i + 1 < p.size() && x > p[i].first) ++i;
  while (i > 1 && x > p[i].first && p[i].first == p[i - 1].first) --i;
  while (i + 1 < p.size() && p[i].first == p[i - 1].first) ++i;
  if (p[i].first == p[i - 1].first) return x < p[i].first ? p[i - 1].second : p[i].second;
  return interpolate(p[i - 1], p[i], x, table.is_log_x, table.is_log_y);
}

}  // namespace

double evaluate(const FunctionTable& table, double x, Side side, double reach) {
  switch (table.kind) {
    case 2:
      return evaluate_points(table, x - table.x1, side, reach);
    case 3:
      return evaluate_points(table, (x - table.x1) / table.x2, side, reach / std::abs(table.x2));
    case 4: {
      const double s = (std::clamp(x, table.x3, table.x4) - table.x1) / table.x2;
      double y = 0;
      for (auto a = table.coefficients.rbegin(); a != table.coefficients.rend(); ++a) y = y * s + *a;
      return y;
    }
    default:
      return evaluate_points(table, x, side, reach);
  }
}

}  // namespace bough::records
