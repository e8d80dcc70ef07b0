#include "analysis/select/loss.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/hankel.hpp"
#include "solver/statespace/poles.hpp"

namespace bough::analysis {

using Eigen::Index;
using statespace::StateSpace;

namespace {

/// R of m = Q R, with no more rows than columns.
Eigen::MatrixXd take_triangle(const Eigen::MatrixXd& m) {
  if (m.rows() <= m.cols()) return m;
  const Eigen::HouseholderQR<Eigen::MatrixXd> factor(m);
  return factor.matrixQR().topRows(m.cols()).triangularView<Eigen::Upper>();
}

/// A body has forces and outputs at each of its nodes, and few states: with B = Rᵀ Qᵀ and C = Q R the gains are those
/// of Rᵀ and R.
StateSpace compress(const StateSpace& s) {
  return {s.A, take_triangle(s.B.transpose()).transpose(), take_triangle(s.C)};
}

/// The part that decays: poles at 0 and what grows left out, so that gains are finite. Of the gains singular values and
/// norm are kept.
records::LinearModel make_decaying(const StateSpace& whole) {
  const StateSpace s = compress(whole);
  const auto part = statespace::split_stable(s.A, true);
  const Eigen::MatrixXd P = (part.U * part.L).real();
  records::LinearModel model;
  model.A = s.A;
  model.B = P * s.B;
  model.C = s.C * P;
  model.D = Eigen::MatrixXd::Zero(s.C.rows(), s.B.cols());
  for (Index i = 0; i < s.A.rows(); ++i) model.states.name.push_back(std::to_string(i));
  for (Index i = 0; i < s.B.cols(); ++i) model.inputs.name.push_back(std::to_string(i));
  for (Index i = 0; i < s.C.rows(); ++i) model.outputs.name.push_back(std::to_string(i));
  model.poles = statespace::calc_poles(model.A, model.states.name);
  return model;
}

double calc_norm_at_rest(const records::LinearModel& model) {
  const statespace::TransferMatrix transfer(model.A, model.B, model.C, model.D);
  // The response at 0, which is finite for the stable part; taken at a small offset from poles at 0.
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (Index i = 0; i < model.poles.size(); ++i)
    high = std::max(high, std::hypot(model.poles.real[i], model.poles.imag[i]));
  for (Index i = 0; i < model.poles.size(); ++i) {
    const double size = std::hypot(model.poles.real[i], model.poles.imag[i]);
    if (size > 1e-6 * high) low = std::min(low, size);
  }
  return transfer.calc({0, std::isfinite(low) ? 1e-3 * low : 1}).norm();
}

}  // namespace

Loss weigh_loss(const Weighing& w, const std::vector<int>& kept) {
  Loss loss;
  loss.name = w.name;
  loss.total = w.ranking.total;
  loss.other = w.ranking.other;
  loss.lost = w.calc_lost(kept);
  const auto full = make_decaying(w.full);
  const auto response = statespace::calc_frequency_response(full, {0, 0, 200, 1500});
  loss.peak = statespace::calc_peak_gain(full, response).value;
  if (kept.empty()) return loss;
  const auto reduced = w.reduce(kept);
  const auto difference = make_decaying(statespace::subtract(w.full, reduced));
  const auto peak =
      statespace::calc_peak_gain(difference, statespace::calc_frequency_response(difference, {0, 0, 200, 1500}));
  loss.error = peak.value;
  loss.error_hz = peak.frequency_hz;
  const auto hankel = statespace::calc_hankel(w.full.A, w.full.B, w.full.C);
  loss.balanced_bound =
      statespace::calc_truncation_bound(hankel.value, static_cast<int>(reduced.A.rows()) - hankel.num_left_out);
  const double size = calc_norm_at_rest(full);
  loss.steady_error = size > 0 ? calc_norm_at_rest(difference) / size : 0;
  const auto small = make_decaying(reduced);
  const statespace::TransferMatrix after(small.A, small.B, small.C, small.D),
      apart(difference.A, difference.B, difference.C, difference.D);
  const Index count = response.frequency_hz.size();
  loss.frequency_hz = response.frequency_hz;
  loss.before = response.singular_values.col(0);
  loss.after.resize(count);
  loss.difference.resize(count);
  for (Index k = 0; k < count; ++k) {
    const std::complex<double> s(0, 2 * M_PI * response.frequency_hz[k]);
    loss.after[k] = Eigen::JacobiSVD<Eigen::MatrixXcd>(after.calc(s)).singularValues()[0];
    loss.difference[k] = Eigen::JacobiSVD<Eigen::MatrixXcd>(apart.calc(s)).singularValues()[0];
  }
  return loss;
}

double calc_lost(const std::vector<Weighing>& weighings, const std::vector<int>& kept) {
  double worst = 0;
  for (const auto& w : weighings) worst = std::max(worst, w.calc_lost(kept));
  return worst;
}

}  // namespace bough::analysis
