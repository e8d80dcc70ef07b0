#include "solver/statespace/exposure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bough::statespace {
namespace {

/// Below it j_n are summed by powers: 1 - j₀² - 3 j₁² is of order x⁴.
constexpr double kMaxPowers = 1.5;
constexpr int kNumOrders = 12;

/// j_n(x) = xⁿ / (2n+1)!! Σ (-x²/2)ᵏ / (k! (2n+3) ... (2n+2k+1)) (Abramowitz & Stegun, 10.1.2).
std::array<double, kNumOrders> calc_bessel_powers(double x) {
  std::array<double, kNumOrders> j{};
  double lead = 1;
  for (int n = 0; n < kNumOrders; ++n) {
    if (n > 0) lead *= x / (2 * n + 1);
    double term = 1, sum = 1;
    for (int k = 1; k < 20; ++k) {
      term *= -x * x / 2 / (k * (2.0 * n + 2 * k + 1));
      sum += term;
    }
    j[static_cast<std::size_t>(n)] = lead * sum;
  }
  return j;
}

struct Shares {
  double mean = 1, smear = 0, residual = 0;
};

/// Σ (2n+1) j_n² = 1 (Abramowitz & Stegun, 10.1.50): no difference of near numbers for small x.
Shares calc_shares(double x, bool is_averaged) {
  if (is_averaged) {
    const double mean = 0.5 / (x * x), smear = 3 * (0.5 / std::pow(x, 4) + 0.5 / (x * x));
    return {mean, smear, 1 - mean - smear};
  }
  if (x < kMaxPowers) {
    const auto j = calc_bessel_powers(x);
    Shares shares{j[0] * j[0], 3 * j[1] * j[1], 0};
    for (int n = kNumOrders - 1; n >= 2; --n)
      shares.residual += (2 * n + 1) * j[static_cast<std::size_t>(n)] * j[static_cast<std::size_t>(n)];
    return shares;
  }
  const double j0 = std::sin(x) / x, j1 = (j0 - std::cos(x)) / x;
  return {j0 * j0, 3 * j1 * j1, std::max(0.0, 1 - j0 * j0 - 3 * j1 * j1)};
}

}  // namespace

std::string_view get_word(ExposurePart part) {
  constexpr std::array<std::string_view, 6> words{"total", "mean", "jitter", "smear", "residual", "drift"};
  return words[static_cast<std::size_t>(part)];
}

double calc_exposure_weight(ExposurePart part, double hz, double exposure, double interval, bool is_averaged) {
  if (part == ExposurePart::Total) return 1;
  const Shares shares = calc_shares(std::numbers::pi * hz * exposure, is_averaged);
  switch (part) {
    case ExposurePart::Mean:
      return shares.mean;
    case ExposurePart::Smear:
      return shares.smear;
    case ExposurePart::Residual:
      return shares.residual;
    case ExposurePart::Drift: {
      const double sine = std::sin(std::numbers::pi * hz * interval);
      return 4 * (is_averaged ? 0.5 : sine * sine) * shares.mean;
    }
    default:
      return shares.smear + shares.residual;
  }
}

}  // namespace bough::statespace
