#include "solver/integrate/locate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bough::solver {

double locate_crossing(const std::function<double(double)>& g, double a, double ga, double b, double gb,
                       double tolerance) {
  const double finest = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
  const double width = std::max(tolerance, finest);
  double left = a, right = b, g_left = ga, g_right = gb, last_width = b - a;
  int last_side = 0;
  while (right - left > width) {
    double t = (left * g_right - right * g_left) / (g_right - g_left);
    // A step inwards from the ends: a root next to one is bracketed from both sides.
    t = std::clamp(t, left + 0.5 * width, right - 0.5 * width);
    if (!std::isfinite(t)) t = 0.5 * (left + right);
    const double value = g(t);
    const bool is_right = gb > 0 ? value > 0 : value < 0;
    if (is_right) {
      right = t;
      g_right = value;
      if (last_side == 1) g_left *= 0.5;
      last_side = 1;
    } else {
      left = t;
      g_left = value;
      if (last_side == -1) g_right *= 0.5;
      last_side = -1;
    }
    if (right - left > width && right - left > 0.5 * last_width) {
      const double middle = 0.5 * (left + right), at_middle = g(middle);
      if (gb > 0 ? at_middle > 0 : at_middle < 0) {
        right = middle;
        g_right = at_middle;
      } else {
        left = middle;
        g_left = at_middle;
      }
      last_side = 0;
    }
    last_width = right - left;
  }
  return right;
}

}  // namespace bough::solver
