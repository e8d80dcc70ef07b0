#pragma once
/// \file Normal distribution and bounds of percentiles.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace bough::analysis {

/// Φ(x).
inline double calc_normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }
/// x of Φ(x) = p, 0 < p < 1; finite at the ends. Abramowitz & Stegun 26.2.23, then Halley's method.
inline double calc_normal_quantile(double p) {
  constexpr double kMinShare = 1e-300, kMaxShare = 1 - 0x1p-53;
  p = std::clamp(p, kMinShare, kMaxShare);
  const bool is_upper = p > 0.5;
  const double tail = is_upper ? 1 - p : p;
  const double t = std::sqrt(-2 * std::log(tail));
  double x =
      (2.515517 + 0.802853 * t + 0.010328 * t * t) / (1 + 1.432788 * t + 0.189269 * t * t + 0.001308 * t * t * t) - t;
  for (int k = 0; k < 4; ++k) {
    const double step = (calc_normal_probability(x) - tail) * std::sqrt(2 * std::numbers::pi) * std::exp(x * x / 2);
    x -= step / (1 + x * step / 2);
  }
  return is_upper ? -x : x;
}

/// Order statistics between which a quantile lies with at least the confidence; none: the sample is too small.
struct QuantileBounds {
  std::optional<double> lower, upper;
};

/// Bounds without assumption on the distribution: X_(r) with P(B < r) <= (1 - confidence) / 2, X_(s) with
/// P(B >= s) <= (1 - confidence) / 2, B binomial of n and p.
/// Source: David & Nagaraja, Order Statistics, 2003, section 7.1.
/// \param sorted      n independent values, ascending.
/// \param p           0 < p < 1.
/// \param confidence  0 < confidence < 1.
inline QuantileBounds calc_quantile_bounds(const std::vector<double>& sorted, double p, double confidence) {
  QuantileBounds bounds;
  const auto n = static_cast<double>(sorted.size());
  const double miss = (1 - confidence) / 2;
  const auto calc_mass = [&](double k) {
    return std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(p) +
                    (n - k) * std::log1p(-p));
  };
  double below = 0;
  for (std::size_t r = 1; r <= sorted.size(); ++r) {
    below += calc_mass(static_cast<double>(r - 1));
    if (below > miss) break;
    bounds.lower = sorted[r - 1];
  }
  double above = 0;
  for (std::size_t s = sorted.size(); s >= 1; --s) {
    above += calc_mass(static_cast<double>(s));
    if (above > miss) break;
    bounds.upper = sorted[s - 1];
  }
  return bounds;
}

}  // namespace bough::analysis
