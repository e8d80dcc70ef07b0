#include "modal/response/sampled_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bough::modal::response {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Ratio by which a second difference exceeds its neighbours at a corner.
constexpr double kCornerRatio = 8;
/// Where two steps at the end differ by more, the end is a parabola.
constexpr double kMaxUneven = 3;

/// Second derivatives at the nodes of a spline, from its chords' slopes s and their changes; not a knot at the ends.
VectorXd solve_spline(const VectorXd& h, const VectorXd& change) {
  const Index n = h.size() + 1;
  VectorXd M = VectorXd::Zero(n);
  if (n == 2) return M;
  if (n == 3) return VectorXd::Constant(n, 2 * change(0) / (h(0) + h(1)));
  const Index m = n - 2;  // unknowns: the inner nodes
  VectorXd lower(m), diagonal(m), upper(m), x(m);
  for (Index i = 0; i < m; ++i) {
    lower(i) = h(i);
    diagonal(i) = 2 * (h(i) + h(i + 1));
    upper(i) = h(i + 1);
    x(i) = 6 * change(i);
  }
  // M at an end: on the line of the two next to it, M0 = M1 + share (M1 - M2).
  const auto calc_share = [](double end, double next) { return end > kMaxUneven * next ? 0 : end / next; };
  const double first = calc_share(h(0), h(1)), last = calc_share(h(n - 2), h(n - 3));
  diagonal(0) += h(0) * (1 + first);
  upper(0) -= h(0) * first;
  diagonal(m - 1) += h(n - 2) * (1 + last);
  lower(m - 1) -= h(n - 2) * last;
  for (Index i = 1; i < m; ++i) {
    const double factor = lower(i) / diagonal(i - 1);
    diagonal(i) -= factor * upper(i - 1);
    x(i) -= factor * x(i - 1);
  }
  x(m - 1) /= diagonal(m - 1);
  for (Index i = m - 1; i-- > 0;) x(i) = (x(i) - upper(i) * x(i + 1)) / diagonal(i);
  M.segment(1, m) = x;
  M(0) = M(1) + first * (M(1) - M(2));
  M(n - 1) = M(n - 2) + last * (M(n - 2) - M(n - 3));
  return M;
}

}  // namespace

SampledCurve make_curve(const VectorXd& t, const VectorXd& before, const VectorXd& after) {
  const Index n = t.size();
  SampledCurve c;
  for (auto* v : {&c.slope_before, &c.slope_after, &c.curvature_before, &c.curvature_after}) v->setZero(n);
  if (n < 2) return c;
  const VectorXd h = t.tail(n - 1) - t.head(n - 1);
  const VectorXd s = (before.tail(n - 1) - after.head(n - 1)).cwiseQuotient(h);
  const double size = std::max(before.cwiseAbs().maxCoeff(), after.cwiseAbs().maxCoeff());
  const double epsilon = std::numeric_limits<double>::epsilon();
  // Changes of slope at the inner nodes, zero if round-off; none at jumps.
  VectorXd change = VectorXd::Zero(n), second = VectorXd::Zero(n);
  std::vector<bool> is_end(static_cast<std::size_t>(n), false);
  is_end.front() = is_end.back() = true;
  for (Index i = 1; i + 1 < n; ++i) {
    is_end[static_cast<std::size_t>(i)] = std::abs(after(i) - before(i)) > 16 * epsilon * size;
    change(i) = s(i) - s(i - 1);
    if (std::abs(change(i)) < 16 * epsilon * size / std::min(h(i), h(i - 1))) change(i) = 0;
    second(i) = std::abs(change(i)) / (h(i) + h(i - 1));
  }
  const auto is_jump = is_end;
  for (Index i = 1; i + 1 < n; ++i) {
    if (is_end[static_cast<std::size_t>(i)] || change(i) == 0) continue;
    double beside = -1;
    for (const Index j : {i - 1, i + 1})
      if (!is_jump[static_cast<std::size_t>(j)]) beside = std::max(beside, second(j));
    if (beside < 0 || second(i) <= kCornerRatio * beside) continue;
    is_end[static_cast<std::size_t>(i)] = true;
    if (c.num_corners++ == 0) c.first_corner = static_cast<int>(i);
  }
  for (Index first = 0, last = 1; last < n; ++last) {
    if (!is_end[static_cast<std::size_t>(last)]) continue;
    const Index m = last - first;  // steps of the piece
    const VectorXd M = solve_spline(h.segment(first, m), change.segment(first + 1, m - 1));
    for (Index k = 0; k < m; ++k) {
      const Index i = first + k;
      c.slope_after(i) = s(i) - h(i) * (2 * M(k) + M(k + 1)) / 6;
      c.slope_before(i + 1) = s(i) + h(i) * (M(k) + 2 * M(k + 1)) / 6;
      c.curvature_after(i) = M(k);
      c.curvature_before(i + 1) = M(k + 1);
      // Within a piece both sides are one.
      if (k > 0) c.slope_after(i) = c.slope_before(i);
    }
    first = last;
  }
  c.slope_after(n - 1) = c.slope_before(n - 1);
  c.curvature_after(n - 1) = c.curvature_before(n - 1);
  return c;
}

}  // namespace bough::modal::response
