#include "solver/statespace/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/diagnostic.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;

// Abramowitz & Stegun, Handbook of Mathematical Functions, table 25.4, n = 8.
constexpr std::array<double, 4> kPoints{0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                        0.960289856497536232};
constexpr std::array<double, 4> kWeights{0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                         0.101228536290376259};
/// An interval next to a pole without damping ends here.
constexpr int kMaxHalvings = 48;

struct Interval {
  double a = 0, b = 0;
  int depth = 0;
};

double calc_distance(double a, double b, std::complex<double> pole) {
  const double at = pole.imag() / (2 * std::numbers::pi), height = pole.real() / (2 * std::numbers::pi);
  return std::hypot(std::max({0.0, a - at, at - b}), height);
}

}  // namespace

Quadrature make_quadrature(const Eigen::VectorXcd& poles, const std::vector<double>& corners, bool has_powers) {
  BOUGH_DEMAND(corners.size() >= 2);
  std::vector<Interval> pending, accepted;
  for (std::size_t k = corners.size() - 1; k-- > 0;)
    if (corners[k + 1] > corners[k]) pending.push_back({corners[k], corners[k + 1], 0});
  while (!pending.empty()) {
    const Interval i = pending.back();
    pending.pop_back();
    const double length = i.b - i.a, middle = 0.5 * (i.a + i.b);
    const bool is_long = (has_powers && length > i.a) ||
                         std::any_of(poles.begin(), poles.end(),
                                     [&](std::complex<double> pole) { return calc_distance(i.a, i.b, pole) < length; });
    if (is_long && i.depth < kMaxHalvings && middle > i.a && middle < i.b) {
      pending.push_back({middle, i.b, i.depth + 1});
      pending.push_back({i.a, middle, i.depth + 1});
    } else {
      accepted.push_back(i);
    }
  }
  static_assert(kQuadraturePoints == 2 * kPoints.size());
  const auto size = kQuadraturePoints * static_cast<Index>(accepted.size());
  Quadrature rule{Eigen::VectorXd(size), Eigen::VectorXd(size)};
  Index at = 0;
  for (const auto& i : accepted) {
    const double middle = 0.5 * (i.a + i.b), half = 0.5 * (i.b - i.a);
    for (std::size_t p = 0; p < kPoints.size(); ++p)
      for (const double sign : {-1.0, 1.0}) {
        rule.frequency_hz[at] = middle + sign * half * kPoints[p];
        rule.weight[at++] = half * kWeights[p];
      }
  }
  return rule;
}

}  // namespace bough::statespace
