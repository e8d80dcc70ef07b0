#include "report/spectrum.hpp"

#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::report {

namespace {

Eigen::VectorXd make_hann(Eigen::Index n) {
  if (n == 1) return Eigen::VectorXd::Ones(1);
  return (0.5 - 0.5 * (Eigen::VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1)).array() * 2 * std::numbers::pi /
                       static_cast<double>(n))
                          .cos())
      .matrix();
}

/// Squares of the transform at zero up to half the rate.
Eigen::VectorXd calc_squares(const Eigen::VectorXd& y) {
  Eigen::FFT<double> fft;
  std::vector<double> real(y.begin(), y.end());
  std::vector<std::complex<double>> transform;
  fft.fwd(transform, real);
  Eigen::VectorXd squares(y.size() / 2 + 1);
  for (Eigen::Index k = 0; k < squares.size(); ++k) squares[k] = std::norm(transform[static_cast<std::size_t>(k)]);
  return squares;
}

/// Returns true if a frequency represents itself and its negative.
bool is_twice(Eigen::Index k, Eigen::Index n) { return k > 0 && 2 * k != n; }

Eigen::VectorXd list_frequencies(Eigen::Index n, double step) {
  return Eigen::VectorXd::LinSpaced(n / 2 + 1, 0, static_cast<double>(n / 2)) / (static_cast<double>(n) * step);
}

}  // namespace

Spectrum calc_psd(const Eigen::VectorXd& y, double step, Eigen::Index segment) {
  BOUGH_DEMAND(y.size() > 1 && step > 0 && segment > 1);
  const Eigen::Index n = std::min(segment, y.size()), hop = n - n / 2;
  const Eigen::VectorXd window = make_hann(n);
  Spectrum spectrum{list_frequencies(n, step), Eigen::VectorXd::Zero(n / 2 + 1)};
  int segments = 0;
  for (Eigen::Index first = 0; first + n <= y.size(); first += hop, ++segments) {
    const Eigen::VectorXd part = y.segment(first, n);
    spectrum.value += calc_squares((part.array() - part.mean()).matrix().cwiseProduct(window));
  }
  spectrum.value *= step / (window.squaredNorm() * segments);
  for (Eigen::Index k = 0; k < spectrum.value.size(); ++k)
    if (is_twice(k, n)) spectrum.value[k] *= 2;
  return spectrum;
}

Spectrum calc_amplitudes(const Eigen::VectorXd& y, double step) {
  BOUGH_DEMAND(y.size() > 1 && step > 0);
  const Eigen::Index n = y.size();
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(n, -1, 1);
  const Eigen::VectorXd flat = (y.array() - y.mean()).matrix() - t * (t.dot(y) / t.squaredNorm());
  const Eigen::VectorXd window = make_hann(n);
  Spectrum spectrum{list_frequencies(n, step), calc_squares(flat.cwiseProduct(window)).cwiseSqrt() / window.sum()};
  for (Eigen::Index k = 0; k < spectrum.value.size(); ++k)
    if (is_twice(k, n)) spectrum.value[k] *= 2;
  return spectrum;
}

}  // namespace bough::report
