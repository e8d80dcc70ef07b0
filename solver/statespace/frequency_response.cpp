#include "solver/statespace/frequency_response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "base/diagnostic.hpp"
#include "solver/statespace/blocks.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Complex = std::complex<double>;

constexpr double kLargestChange = 1.0 / 3;

/// Frequencies in rad per unit of time: even on a logarithmic scale, and closer about lightly damped poles.
std::vector<double> choose_frequencies(const records::LinearModel& model, const FrequencyRange& range) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  const auto& poles = model.poles;
  const auto size_of = [&](Index i) { return std::hypot(poles.real[i], poles.imag[i]); };
  for (Index i = 0; i < poles.size(); ++i) high = std::max(high, size_of(i));
  for (Index i = 0; i < poles.size(); ++i)
    if (size_of(i) > 1e-6 * high) low = std::min(low, size_of(i));
  // Zeros near the poles have corner frequencies too; some are rounding of zeros at infinity or at 0.
  const double floor = high > 0 ? 1e-3 * low : 1e-9, ceiling = high > 0 ? 1e3 * high : 1e9;
  for (Index i = 0; i < model.zeros_real.size(); ++i) {
    const double size = std::hypot(model.zeros_real[i], model.zeros_imag[i]);
    if (size < floor || size > ceiling) continue;
    low = std::min(low, size);
    high = std::max(high, size);
  }
  if (high <= 0) low = high = 1;
  low /= 10, high *= 10;
  if (range.from_hz > 0) low = 2 * std::numbers::pi * range.from_hz;
  if (range.to_hz > 0) high = 2 * std::numbers::pi * range.to_hz;
  if (model.sample_time > 0) {
    const double nyquist = std::numbers::pi / model.sample_time;
    if (range.to_hz <= 0 || high > nyquist) high = nyquist;
    low = std::min(low, 0.1 * high);
  }
  if (high < low) std::swap(low, high);
  std::set<double> chosen;
  const double from = std::log(low), to = std::log(high);
  for (int i = 0; i <= range.points; ++i)
    chosen.insert(std::clamp(std::exp(from + (to - from) * i / std::max(1, range.points)), low, high));
  if (model.sample_time > 0) chosen.erase(std::prev(chosen.end())), chosen.insert(high);  // that one to the last bit
  const auto max_chosen = static_cast<std::size_t>(range.max_points / 2);
  for (Index i = 0; i < poles.size() && chosen.size() < max_chosen; ++i) {
    const double re = poles.real[i], im = poles.imag[i];
    if (im <= 0 || std::abs(re) > 0.2 * size_of(i)) continue;
    // Half-power points and about: the peak is as wide as twice the real part.
    const double width = std::max(std::abs(re), 1e-4 * im);
    for (const double k : {-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0})
      if (im + k * width >= low && im + k * width <= high) chosen.insert(im + k * width);
  }
  for (const double hz : range.corners_hz) chosen.insert(2 * std::numbers::pi * hz);
  return {chosen.begin(), chosen.end()};
}

bool is_far(const MatrixXcd& a, const MatrixXcd& b) {
  for (Index i = 0; i < a.size(); ++i) {
    const Complex p = a(i), q = b(i);
    const double size = std::max(std::abs(p), std::abs(q));
    if (std::isfinite(size) && std::abs(p - q) > kLargestChange * size) return true;
  }
  return false;
}

}  // namespace

Complex calc_argument(const records::LinearModel& model, double omega) {
  return model.sample_time > 0 ? std::polar(1.0, omega * model.sample_time) : Complex(0, omega);
}

TransferMatrix::TransferMatrix(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C, const MatrixXd& D)
    : H_(A), B_(B), C_(C), D_(D), back_(MatrixXd::Identity(A.rows(), A.rows())) {
  BOUGH_DEMAND(A.rows() == A.cols() && B.rows() == A.rows() && C.cols() == A.rows());
  if (A.rows() == 0) return;
  const Eigen::VectorXd scale = balance(H_);
  back_ = scale.asDiagonal();
  if (H_.rows() > 2) {
    const Eigen::HessenbergDecomposition<MatrixXd> form(H_);
    back_ = back_ * MatrixXd(form.matrixQ());
    H_ = form.matrixH();
    B_ = MatrixXd(form.matrixQ()).transpose() * scale.cwiseInverse().asDiagonal() * B;
  } else {
    B_ = scale.cwiseInverse().asDiagonal() * B;
  }
  C_ = C * back_;
}

MatrixXcd TransferMatrix::solve(Complex s) const {
  const Index n = H_.rows();
  MatrixXcd M = (-H_).cast<Complex>(), X = B_.cast<Complex>();
  M.diagonal().array() += s;
  for (Index k = 0; k + 1 < n; ++k) {
    if (std::abs(M(k + 1, k)) > std::abs(M(k, k))) {
      M.row(k).tail(n - k).swap(M.row(k + 1).tail(n - k));
      X.row(k).swap(X.row(k + 1));
    }
    if (M(k, k) == 0.0) continue;
    const Complex factor = M(k + 1, k) / M(k, k);
    M.row(k + 1).tail(n - k) -= factor * M.row(k).tail(n - k);
    X.row(k + 1) -= factor * X.row(k);
  }
  return M.triangularView<Eigen::Upper>().solve(X);
}

MatrixXcd TransferMatrix::calc(Complex s) const {
  if (H_.rows() == 0) return D_.cast<Complex>();
  return D_.cast<Complex>() + C_.cast<Complex>() * solve(s);
}

MatrixXcd TransferMatrix::calc_states(Complex s) const { return back_.cast<Complex>() * solve(s); }

records::FrequencyResponse calc_frequency_response(const records::LinearModel& model, const FrequencyRange& range) {
  records::FrequencyResponse response;
  response.inputs = model.inputs;
  response.outputs = model.outputs;
  response.units = model.units;
  const TransferMatrix transfer(model.A, model.B, model.C, model.D);
  std::vector<double> omegas = choose_frequencies(model, range);
  std::vector<MatrixXcd> values;
  for (const double omega : omegas) values.push_back(transfer.calc(calc_argument(model, omega)));
  for (bool is_new = true; is_new && static_cast<int>(omegas.size()) < range.max_points;) {
    std::vector<double> finer;
    std::vector<MatrixXcd> with;
    for (std::size_t k = 0; k < omegas.size(); ++k) {
      finer.push_back(omegas[k]);
      with.push_back(values[k]);
      const bool has_room = static_cast<int>(omegas.size() + finer.size() - k) < range.max_points;
      if (k + 1 == omegas.size() || !has_room || !is_far(values[k], values[k + 1])) continue;
      const double between = std::sqrt(omegas[k] * omegas[k + 1]);
      if (!(between > omegas[k] * (1 + 1e-9) && between < omegas[k + 1])) continue;
      finer.push_back(between);
      with.push_back(transfer.calc(calc_argument(model, between)));
    }
    is_new = finer.size() > omegas.size();
    omegas = std::move(finer);
    values = std::move(with);
  }
  const auto count = static_cast<Index>(omegas.size());
  response.frequency_hz = Eigen::Map<const Eigen::VectorXd>(omegas.data(), count) / (2 * std::numbers::pi);
  const Index ny = model.C.rows(), nu = model.B.cols(), num_values = std::min(ny, nu);
  response.singular_values.setZero(count, num_values);
  for (Index k = 0; k < count && num_values > 0; ++k) {
    const MatrixXcd& value = values[static_cast<std::size_t>(k)];
    if (value.allFinite())
      response.singular_values.row(k) = Eigen::JacobiSVD<MatrixXcd>(value).singularValues().transpose();
    else
      response.singular_values.row(k).setConstant(std::numeric_limits<double>::infinity());
  }
  response.value = std::move(values);
  return response;
}

}  // namespace bough::statespace
