#include "solver/statespace/random_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

#include <Eigen/Eigenvalues>

#include "base/diagnostic.hpp"
#include "formats/records/random_response.hpp"
#include "solver/statespace/cost.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/quadrature.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Negative eigenvalues of S up to this share of its trace are round-off.
constexpr double kIndefinite = 1e-8;
/// Relative feedthrough up to which an output has none.
constexpr double kNoFeedthrough = 1e-9;
/// Relative round-off of a frequency.
constexpr double kRoundOff = 1e-12;
/// Multipliers that near to the unit circle do not decay.
constexpr double kOnCircle = 1e-7;

Complex interpolate(const InputSpectrum::Term& term, double hz) {
  const auto& all = term.frequency_hz;
  const Index n = all.size();
  if (n == 0) return term.density[0];
  if (hz < all[0] * (1 - kRoundOff) || hz > all[n - 1] * (1 + kRoundOff)) return 0;
  const Index after = std::clamp<Index>(std::upper_bound(all.begin(), all.end(), hz) - all.begin(), 1, n - 1);
  const double a = all[after - 1], b = all[after];
  const Complex S_a = term.density[after - 1], S_b = term.density[after];
  if (term.is_log && S_a.real() > 0 && S_b.real() > 0)
    return S_a.real() * std::pow(S_b.real() / S_a.real(), std::log(hz / a) / std::log(b / a));
  return S_a + (hz - a) / (b - a) * (S_b - S_a);
}

bool is_at_origin(const records::Poles& poles, Index i) {
  return std::hypot(poles.real[i], poles.imag[i]) <= records::calc_origin_radius(poles, i);
}

[[noreturn]] void fail(const std::string& output, const std::string& why, const std::string& advice) {
  throw ComputationError("linear.unbounded-random", {}, "output " + output + " has no stationary response: " + why,
                         advice);
}

/// Inputs with a density.
std::vector<Index> list_driven(const MatrixXcd& S) {
  std::vector<Index> driven;
  for (Index j = 0; j < S.cols(); ++j)
    if (S(j, j).real() > 0) driven.push_back(j);
  return driven;
}

/// Mean squares over all frequencies, of white inputs.
void calc_totals(const records::LinearModel& model, const MatrixXd& S, const MatrixXd& B, double max_hz,
                 records::RandomOutputs& found) {
  const Index ny = model.C.rows();
  found.total_rms.setConstant(ny, kInfinite);
  found.total_crossing_hz.setConstant(ny, kInfinite);
  const StablePart part = split_stable(model.A, true);
  const MatrixXd decays = (part.U * part.L).real();
  const MatrixXd rest = MatrixXd::Identity(model.A.rows(), model.A.rows()) - decays;
  // The intensity of white noise is half of its one-sided density.
  const MatrixXd X = solve_lyapunov(part, model.B * (0.5 * S) * model.B.transpose());
  const MatrixXd C = model.C * decays, rates = C * model.A;
  for (Index i = 0; i < ny; ++i) {
    const double peak = found.psd.col(i).maxCoeff();
    const auto calc_density = [&](const Eigen::RowVectorXd& gains) { return (gains * S * gains.transpose()).value(); };
    if (calc_density(model.D.row(i)) > std::pow(kNoFeedthrough, 2) * peak) continue;
    if (part.num_rigid > 0 && is_seen({model.A, B, model.C.row(i)}, rest)) continue;
    const double m0 = std::max(0.0, (C.row(i) * X * C.row(i).transpose()).value());
    found.total_rms[i] = std::sqrt(m0);
    found.total_crossing_hz[i] = 0;
    if (m0 == 0) continue;
    const double m2 = (rates.row(i) * X * rates.row(i).transpose()).value() / (kTwoPi * kTwoPi);
    const bool has_jumps = calc_density(C.row(i) * model.B) > std::pow(kNoFeedthrough * kTwoPi * max_hz, 2) * peak;
    found.total_crossing_hz[i] = has_jumps ? kInfinite : std::sqrt(std::max(0.0, m2) / m0);
  }
}

}  // namespace

Eigen::VectorXcd list_poles(const records::LinearModel& model) {
  const Index n = model.poles.size();
  Eigen::VectorXcd poles(model.sample_time > 0 ? 3 * n : n);
  for (Index i = 0; i < n; ++i) {
    poles[i] = {model.poles.real[i], model.poles.imag[i]};
    for (const int k : {1, -1})
      if (model.sample_time > 0) poles[(k > 0 ? 1 : 2) * n + i] = poles[i] + Complex(0, k * kTwoPi / model.sample_time);
  }
  return poles;
}

void demand_decay(const records::LinearModel& model, const MatrixXd& B) {
  const std::string advice = "give the modes damping, close the loops, or leave the output out with --outputs";
  std::ostringstream why;
  if (model.sample_time > 0) {
    for (Index i = 0; i < model.poles.size(); ++i) {
      if (model.poles.real[i] * model.sample_time < -kOnCircle || is_at_origin(model.poles, i)) continue;
      why << "the pole " << model.poles.real[i] << " ± " << std::abs(model.poles.imag[i]) << " i does not decay";
      fail(model.outputs.name.front(), why.str(), advice);
    }
    return;
  }
  const StablePart part = split_stable(model.A, true);
  if (part.is_stable()) return;
  const StablePart all = split_stable(model.A);
  const MatrixXd projector = (all.U * all.L - part.U * part.L).real();
  why << "the pole " << part.unstable.real() << " ± " << std::abs(part.unstable.imag()) << " i does not decay";
  for (Index i = 0; i < model.C.rows(); ++i)
    if (is_seen({model.A, B, model.C.row(i)}, projector))
      fail(model.outputs.name[static_cast<std::size_t>(i)], why.str(), advice);
}

MatrixXcd InputSpectrum::calc(double hz) const {
  MatrixXcd S = MatrixXcd::Zero(num_inputs_, num_inputs_);
  for (const auto& term : terms_) {
    const Complex value = interpolate(term, hz);
    S(term.a, term.b) += value;
    if (term.a != term.b) S(term.b, term.a) += std::conj(value);
  }
  return S;
}

void InputSpectrum::append(const InputSpectrum& other) {
  BOUGH_DEMAND(other.num_inputs_ == num_inputs_);
  terms_.insert(terms_.end(), other.terms_.begin(), other.terms_.end());
}

std::vector<Index> InputSpectrum::list_inputs() const {
  std::vector<Index> inputs;
  for (const auto& term : terms_) inputs.insert(inputs.end(), {term.a, term.b});
  std::sort(inputs.begin(), inputs.end());
  inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
  return inputs;
}

bool InputSpectrum::is_white() const {
  return std::all_of(terms_.begin(), terms_.end(),
                     [](const Term& term) { return term.frequency_hz.size() == 0 && term.density[0].imag() == 0; });
}

bool InputSpectrum::has_powers() const {
  return std::any_of(terms_.begin(), terms_.end(), [](const Term& term) { return term.is_log; });
}

std::vector<double> InputSpectrum::list_corners() const {
  std::vector<double> corners;
  for (const auto& term : terms_) corners.insert(corners.end(), term.frequency_hz.begin(), term.frequency_hz.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

std::optional<std::pair<double, double>> InputSpectrum::get_range() const {
  if (std::any_of(terms_.begin(), terms_.end(), [](const Term& term) { return term.frequency_hz.size() == 0; }))
    return {};
  const auto corners = list_corners();
  if (corners.empty()) return {};
  return std::pair(corners.front(), corners.back());
}

std::optional<double> InputSpectrum::find_indefinite(const std::vector<double>& hz) const {
  for (const double f : hz) {
    const MatrixXcd S = calc(f);
    const Eigen::SelfAdjointEigenSolver<MatrixXcd> solver(S, Eigen::EigenvaluesOnly);
    if (solver.eigenvalues()[0] < -kIndefinite * S.diagonal().real().sum()) return f;
  }
  return {};
}

records::RandomOutputs calc_random_outputs(const records::LinearModel& model, const InputSpectrum& input,
                                           const records::FrequencyResponse& response) {
  BOUGH_DEMAND(input.num_inputs() == model.B.cols() && response.frequency_hz.size() >= 2);
  const Index ny = model.C.rows(), nf = response.frequency_hz.size();
  const auto& hz = response.frequency_hz;
  const double min_hz = hz[0], max_hz = hz[nf - 1];
  std::vector<double> corners{min_hz};
  for (const double f : input.list_corners())
    if (f > min_hz && f < max_hz) corners.push_back(f);
  corners.push_back(max_hz);
  MatrixXcd sum = MatrixXcd::Zero(input.num_inputs(), input.num_inputs());
  for (const double f : corners) sum += input.calc(f);
  const MatrixXd B = model.B(Eigen::all, list_driven(sum));
  demand_decay(model, B);

  records::RandomOutputs found;
  found.outputs = model.outputs;
  found.frequency_hz = hz;
  const auto calc_density = [&](const MatrixXcd& G, double f) {
    return VectorXd((G * input.calc(f)).cwiseProduct(G.conjugate()).rowwise().sum().real().cwiseMax(0));
  };
  found.psd.resize(nf, ny);
  for (Index k = 0; k < nf; ++k)
    found.psd.row(k) = calc_density(response.value[static_cast<std::size_t>(k)], hz[k]).transpose();
  for (Index i = 0; i < ny; ++i)
    if (!found.psd.col(i).allFinite())
      fail(model.outputs.name[static_cast<std::size_t>(i)], "a pole is at a frequency of the band",
           "give --from and --to");

  const auto calc_crossings = [](const VectorXd& m0, const VectorXd& m2) {
    return VectorXd((m0.array() > 0).select((m2.array() / m0.array()).sqrt(), 0));
  };
  VectorXd m0 = VectorXd::Zero(ny), m2 = m0;
  found.cumulative_rms.setZero(nf, ny);
  for (Index k = 1; k < nf; ++k) {
    for (Index i = 0; i < ny; ++i) {
      const double S_a = found.psd(k - 1, i), S_b = found.psd(k, i);
      m0[i] += records::integrate_density(hz[k - 1], hz[k], S_a, S_b, 0, false);
      m2[i] += records::integrate_density(hz[k - 1], hz[k], S_a, S_b, 2, false);
    }
    found.cumulative_rms.row(k) = m0.cwiseSqrt().transpose();
  }
  found.rms = m0.cwiseSqrt();
  found.crossing_hz = calc_crossings(m0, m2);

  const auto rule = make_quadrature(list_poles(model), corners, input.has_powers());
  const TransferMatrix transfer(model.A, model.B, model.C, model.D);
  m0.setZero();
  m2.setZero();
  for (Index k = 0; k < rule.weight.size(); ++k) {
    const double f = rule.frequency_hz[k];
    const VectorXd density = rule.weight[k] * calc_density(transfer.calc(calc_argument(model, kTwoPi * f)), f);
    m0 += density;
    m2 += f * f * density;
  }
  found.band_rms = m0.cwiseSqrt();
  found.band_crossing_hz = calc_crossings(m0, m2);

  if (model.sample_time > 0)
    found.no_total = "the model is from sample to sample";
  else if (!input.is_white())
    found.no_total = "an input is not white";
  else
    calc_totals(model, input.calc(0).real(), B, max_hz, found);
  return found;
}

}  // namespace bough::statespace
