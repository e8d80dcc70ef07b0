#include "fe/shape/gauss.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "base/diagnostic.hpp"

namespace bough::fe {
namespace {

constexpr int kMaxPoints = 8;

/// Roots of the Legendre polynomial P_n by Newton from Chebyshev's guess (Abramowitz & Stegun 25.4.29).
std::array<GaussPoint, kMaxPoints> calc_rule(int n) {
  std::array<GaussPoint, kMaxPoints> rule{};
  for (int i = 0; i < n; ++i) {
    double t = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 50; ++iteration) {
      double p0 = 1, p1 = t;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * t * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (t * p1 - p0) / (t * t - 1);
      const double step = p1 / slope;
      t -= step;
      if (std::abs(step) < 1e-16) break;
    }
    rule[n - 1 - i] = {0.5 * (1 + t), 1 / ((1 - t * t) * slope * slope)};
  }
  return rule;
}

}  // namespace

std::span<const GaussPoint> get_gauss_points(int n) {
  BOUGH_DEMAND(n >= 1 && n <= kMaxPoints);
  static const auto rules = [] {
    std::array<std::array<GaussPoint, kMaxPoints>, kMaxPoints> all{};
    for (int k = 1; k <= kMaxPoints; ++k) all[k - 1] = calc_rule(k);
    return all;
  }();
  return {rules[n - 1].data(), static_cast<std::size_t>(n)};
}

}  // namespace bough::fe
