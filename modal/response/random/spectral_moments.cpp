#include "modal/response/random/spectral_moments.hpp"

#include <cmath>
#include <numbers>

namespace bough::modal::response {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// ∫f^r S df between a and b, S = S_a (f/a)^m.
double integrate_power(double a, double b, double S_a, double S_b, int r) {
  const double ratio = std::log(b / a), exponent = std::log(S_b / S_a) / ratio + r + 1;
  const double start = S_a * std::pow(a, r + 1);
  return start * ratio * (std::abs(exponent * ratio) < 1e-8 ? 1 : std::expm1(exponent * ratio) / (exponent * ratio));
}

/// The integrals of cos and of x sin over [-1, 1], divided by 2, at u times x.
void calc_filon(double u, double& even, double& odd) {
  if (std::abs(u) < 1e-3) {
    even = 1 - u * u / 6;
    odd = u / 3 * (1 - u * u / 10);
    return;
  }
  even = std::sin(u) / u;
  odd = (std::sin(u) - u * std::cos(u)) / (u * u);
}

}  // namespace

SpectralMoments calc_moments(const VectorXd& hz, const MatrixXd& psd, bool is_loglog) {
  SpectralMoments moments{VectorXd::Zero(psd.cols()), VectorXd::Zero(psd.cols())};
  for (Index c = 0; c < psd.cols(); ++c)
    for (Index i = 1; i < hz.size(); ++i) {
      const double a = hz(i - 1), b = hz(i), S_a = psd(i - 1, c), S_b = psd(i, c);
      if (is_loglog && a > 0 && S_a > 0 && S_b > 0) {
        moments.m0(c) += integrate_power(a, b, S_a, S_b, 0);
        moments.m2(c) += integrate_power(a, b, S_a, S_b, 2);
        continue;
      }
      moments.m0(c) += (b - a) / 2 * (S_a + S_b);
      moments.m2(c) += (b - a) / 12 * (S_a * (3 * a * a + 2 * a * b + b * b) + S_b * (a * a + 2 * a * b + 3 * b * b));
    }
  return moments;
}

MatrixXd calc_autocorrelation(const VectorXd& hz, const MatrixXd& psd, const VectorXd& lags) {
  const Index n = hz.size();
  MatrixXd weights = MatrixXd::Zero(lags.size(), n);
  for (Index t = 0; t < lags.size(); ++t)
    for (Index i = 1; i < n; ++i) {
      const double half = (hz(i) - hz(i - 1)) / 2, centre = (hz(i) + hz(i - 1)) / 2;
      const double rate = 2 * std::numbers::pi * lags(t);
      double even = 0, odd = 0;
      calc_filon(rate * half, even, odd);
      // S = mean + slope x/half about the centre.
      const double mean = 2 * half * even * std::cos(rate * centre), slope = 2 * half * odd * std::sin(rate * centre);
      weights(t, i - 1) += 0.5 * (mean + slope);
      weights(t, i) += 0.5 * (mean - slope);
    }
  return weights * psd;
}

}  // namespace bough::modal::response
