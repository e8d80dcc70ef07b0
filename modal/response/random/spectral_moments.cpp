#include "modal/response/random/spectral_moments.hpp"

#include <cmath>
#include <numbers>

#include "formats/records/random_response.hpp"

namespace bough::modal::response {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

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
      moments.m0(c) += records::integrate_density(a, b, S_a, S_b, 0, is_loglog);
      moments.m2(c) += records::integrate_density(a, b, S_a, S_b, 2, is_loglog);
    }
  return moments;
}

namespace {

/// Weights of the values of S, lags x frequencies: ∫S cos 2πfτ df, or with sin, for straight lines.
MatrixXd calc_fourier_weights(const VectorXd& hz, const VectorXd& lags, bool is_sine) {
  const Index n = hz.size();
  MatrixXd weights = MatrixXd::Zero(lags.size(), n);
  for (Index t = 0; t < lags.size(); ++t)
    for (Index i = 1; i < n; ++i) {
      const double half = (hz(i) - hz(i - 1)) / 2, centre = (hz(i) + hz(i - 1)) / 2;
      const double rate = 2 * std::numbers::pi * lags(t);
      double even = 0, odd = 0;
      calc_filon(rate * half, even, odd);
      // S = mean + slope x/half about the centre.
      const double c = std::cos(rate * centre), s = std::sin(rate * centre);
      const double mean = 2 * half * even * (is_sine ? s : c), slope = 2 * half * odd * (is_sine ? -c : s);
      weights(t, i - 1) += 0.5 * (mean + slope);
      weights(t, i) += 0.5 * (mean - slope);
    }
  return weights;
}

}  // namespace

MatrixXd calc_autocorrelation(const VectorXd& hz, const MatrixXd& psd, const VectorXd& lags) {
  return calc_fourier_weights(hz, lags, false) * psd;
}

VectorXd calc_correlation(const VectorXd& hz, const Eigen::VectorXcd& psd, const VectorXd& lags) {
  return calc_fourier_weights(hz, lags, false) * psd.real() - calc_fourier_weights(hz, lags, true) * psd.imag();
}

}  // namespace bough::modal::response
