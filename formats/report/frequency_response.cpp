#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include <Eigen/Eigenvalues>

#include "formats/report/linear_chapter.hpp"

namespace bough::report {

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

/// Frequencies in rad per unit of time: even on a logarithmic scale, and closer about lightly damped poles.
std::vector<double> choose_frequencies(const records::LinearModel& model) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (Index i = 0; i < model.poles.real.size(); ++i) {
    const double size = std::hypot(model.poles.real[i], model.poles.imag[i]);
    high = std::max(high, size);
  }
  for (Index i = 0; i < model.poles.real.size(); ++i) {
    const double size = std::hypot(model.poles.real[i], model.poles.imag[i]);
    if (size > 1e-6 * high) low = std::min(low, size);
  }
  if (high <= 0) low = high = 1;
  std::set<double> chosen;
  const double from = std::log(low / 10), to = std::log(high * 10);
  for (int i = 0; i <= 300; ++i) chosen.insert(std::exp(from + (to - from) * i / 300));
  for (Index i = 0; i < model.poles.real.size() && chosen.size() < 900; ++i) {
    const double re = model.poles.real[i], im = model.poles.imag[i], size = std::hypot(re, im);
    if (im <= 0 || std::abs(re) > 0.2 * size) continue;
    // Half-power points and about: the peak is as wide as twice the real part.
    const double width = std::max(std::abs(re), 1e-4 * im);
    for (const double k : {-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0})
      if (im + k * width > 0) chosen.insert(im + k * width);
  }
  return {chosen.begin(), chosen.end()};
}

/// X of (s - H) X = B, H upper Hessenberg, by elimination with row exchange: O(n²) a column.
MatrixXcd solve_hessenberg(const MatrixXd& H, std::complex<double> s, const MatrixXd& B) {
  const Index n = H.rows();
  MatrixXcd M = (-H).cast<std::complex<double>>();
  M.diagonal().array() += s;
  MatrixXcd X = B.cast<std::complex<double>>();
  for (Index k = 0; k + 1 < n; ++k) {
    if (std::abs(M(k + 1, k)) > std::abs(M(k, k))) {
      M.row(k).tail(n - k).swap(M.row(k + 1).tail(n - k));
      X.row(k).swap(X.row(k + 1));
    }
    if (M(k, k) == 0.0) continue;
    const std::complex<double> factor = M(k + 1, k) / M(k, k);
    M.row(k + 1).tail(n - k) -= factor * M.row(k).tail(n - k);
    X.row(k + 1) -= factor * X.row(k);
  }
  return M.triangularView<Eigen::Upper>().solve(X);
}

}  // namespace

FrequencyResponse calc_frequency_response(const records::LinearModel& model, int most_pairs) {
  FrequencyResponse response;
  const Index nu = model.B.cols(), ny = model.C.rows();
  if (nu == 0 || ny == 0) return response;
  const auto omegas = choose_frequencies(model);
  const auto count = static_cast<Index>(omegas.size());
  response.frequency = Eigen::Map<const Eigen::VectorXd>(omegas.data(), count) / (2 * std::numbers::pi);
  for (int j = 0; j < nu; ++j)
    for (int i = 0; i < ny && static_cast<int>(response.pairs.size()) < most_pairs; ++i)
      response.pairs.push_back({i, j, Eigen::VectorXd(count), Eigen::VectorXd(count)});
  MatrixXd H = model.A, B = model.B, C = model.C;
  if (H.rows() > 2) {
    const Eigen::HessenbergDecomposition<MatrixXd> form(model.A);
    const MatrixXd Q = form.matrixQ();
    H = form.matrixH();
    B = Q.transpose() * model.B;
    C = model.C * Q;
  }
  for (Index k = 0; k < count; ++k) {
    MatrixXcd values = model.D.cast<std::complex<double>>();
    if (H.rows() > 0)
      values += C.cast<std::complex<double>>() * solve_hessenberg(H, {0, omegas[static_cast<std::size_t>(k)]}, B);
    for (auto& pair : response.pairs) {
      const std::complex<double> h = values(pair.output, pair.input);
      pair.decibel[k] = h == 0.0 ? std::nan("") : 20 * std::log10(std::abs(h));
      double phase = h == 0.0 ? std::nan("") : std::arg(h) * 180 / std::numbers::pi;
      if (k > 0 && std::isfinite(pair.degrees[k - 1])) phase -= 360 * std::round((phase - pair.degrees[k - 1]) / 360);
      pair.degrees[k] = phase;
    }
  }
  return response;
}

}  // namespace bough::report
