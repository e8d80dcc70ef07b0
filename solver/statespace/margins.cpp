// Margins of a loop, and the largest gain of a model.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <sstream>

#include "base/diagnostic.hpp"
#include "solver/statespace/blocks.hpp"
#include "solver/statespace/cost.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/poles.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Complex = std::complex<double>;

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr int kBisections = 80;
constexpr double kCertified = 1e-6;
constexpr Index kMostStates = 300;
/// Two poles at 1 are found that far from it.
constexpr double kOnCircle = 1e-7;
/// A pole with a smaller damping ratio is undamped; L is taken that far from it, relative to its frequency.
constexpr double kUndamped = 1e-12, kBesidePole = 1e-7;

/// A root of f between a and b, where its signs differ.
double bisect(const std::function<double(double)>& f, double a, double b) {
  const bool is_positive = f(a) > 0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (a + b);
    if (middle == a || middle == b) break;
    (f(middle) > 0) == is_positive ? a = middle : b = middle;
  }
  return 0.5 * (a + b);
}

/// A point of the locus L(ω).
struct LocusPoint {
  double omega = 0;
  Complex value;
  bool is_after_pole = false;  ///< an undamped pole lies between the point before and this one
};

/// The frequencies of the response; one at an undamped pole becomes two, next to it on both sides.
///
/// At the pole L has no value, and in floating point any. On both sides abs(L) tends to infinity, or, if a zero cancels
/// the pole, to the finite value there.
std::vector<LocusPoint> collect_locus(const records::LinearModel& loop, const records::FrequencyResponse& response,
                                      const std::function<Complex(double)>& L) {
  std::vector<double> undamped;
  for (Index i = 0; i < loop.poles.size(); ++i)
    if (loop.poles.imag[i] > 0 && std::abs(loop.poles.real[i]) <= kUndamped * loop.poles.imag[i])
      undamped.push_back(loop.poles.imag[i]);
  const double last = kTwoPi * response.frequency_hz[response.frequency_hz.size() - 1];
  std::vector<LocusPoint> points;
  for (Index k = 0; k < response.frequency_hz.size(); ++k) {
    const double omega = kTwoPi * response.frequency_hz[k];
    const Complex value = response.value[static_cast<std::size_t>(k)](0, 0);
    const auto is_near = [&](double pole) { return std::abs(pole - omega) <= kBesidePole * omega; };
    const auto pole = std::find_if(undamped.begin(), undamped.end(), is_near);
    const bool is_finite = std::isfinite(value.real()) && std::isfinite(value.imag());
    if (is_finite && pole == undamped.end()) {
      points.push_back({omega, value, false});
      continue;
    }
    const double at = pole == undamped.end() ? omega : *pole;
    const double below = at * (1 - 2 * kBesidePole), above = at * (1 + 2 * kBesidePole);
    // Several frequencies near one pole are one.
    if (points.empty() || points.back().omega < below) points.push_back({below, L(below), false});
    if (above <= last && points.back().omega < above) points.push_back({above, L(above), true});
  }
  return points;
}

/// The least f near x between a and b (golden section).
double minimize(const std::function<double(double)>& f, double a, double b) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double left = b - golden * (b - a), right = a + golden * (b - a), f_left = f(left), f_right = f(right);
  for (int i = 0; i < kBisections && b - a > 1e-12 * b; ++i) {
    if (f_left < f_right) {
      b = right, right = left, f_right = f_left;
      left = b - golden * (b - a), f_left = f(left);
    } else {
      a = left, left = right, f_left = f_right;
      right = a + golden * (b - a), f_right = f(right);
    }
  }
  return f_left < f_right ? left : right;
}

double calc_sigma(const MatrixXcd& value) {
  if (!value.allFinite()) return std::numeric_limits<double>::infinity();
  return value.size() == 0 ? 0 : Eigen::JacobiSVD<MatrixXcd>(value).singularValues()[0];
}

/// Whether poles that part leaves out come through from inputs to outputs: C Aᵏ (1 - U L) B beside |C| |Aᵏ B|.
bool is_seen(const records::LinearModel& model, const StablePart& part) {
  const Index n = model.A.rows();
  MatrixXd A = model.A;
  const Eigen::VectorXd scale = balance(A);
  const MatrixXd inverse = scale.cwiseInverse().asDiagonal(), C = model.C * scale.asDiagonal();
  const MatrixXd decays = inverse * (part.U * part.L).real() * scale.asDiagonal();
  MatrixXd all = inverse * model.B, rest = all - decays * all;
  for (Index k = 0; k < std::min<Index>(n, 4); ++k) {
    if ((C * rest).norm() > 1e-9 * C.norm() * all.norm()) return true;
    all = A * all;
    rest = A * rest;
  }
  return false;
}

/// Frequencies at which a singular value of G is gamma: eigenvalues of the Hamiltonian matrix on the imaginary axis.
std::vector<double> find_level(const StateSpace& s, const MatrixXd& D, double gamma) {
  const Index n = s.A.rows(), nu = s.B.cols();
  const MatrixXd R = gamma * gamma * MatrixXd::Identity(nu, nu) - D.transpose() * D;
  const Eigen::LDLT<MatrixXd> factor(R);
  const MatrixXd F = s.A + s.B * factor.solve(D.transpose() * s.C);
  MatrixXd H(2 * n, 2 * n);
  H << F, gamma * s.B * factor.solve(s.B.transpose()),
      -s.C.transpose() * (s.C + D * factor.solve(D.transpose() * s.C)) / gamma, -F.transpose();
  balance(H);
  const auto values = MatrixXd(H).eigenvalues();
  std::vector<double> omegas;
  const double tiny = 1e-8 * std::max(values.cwiseAbs().maxCoeff() * 1e-6, 1e-300);
  for (const Complex& v : values)
    if (v.imag() > 0 && std::abs(v.real()) <= 1e-8 * std::abs(v) + tiny) omegas.push_back(v.imag());
  std::sort(omegas.begin(), omegas.end());
  return omegas;
}

}  // namespace

FrequencyRange widen_for_loop(const records::LinearModel& loop, const FrequencyRange& range) {
  constexpr int kDecades = 8;
  FrequencyRange wide = range;
  const auto ends = calc_frequency_response(loop, {range.from_hz, range.to_hz, 1, 2}).frequency_hz;
  const TransferMatrix transfer(loop.A, loop.B, loop.C, loop.D);
  const auto gain = [&](double hz) { return std::abs(transfer.calc(calc_argument(loop, kTwoPi * hz))(0, 0)); };
  double low = ends[0], high = ends[ends.size() - 1];
  for (int i = 0; range.to_hz == 0 && loop.sample_time == 0 && i < kDecades && gain(high) > 1; ++i)
    wide.to_hz = high *= 10;
  const bool has_rigid = loop.poles.size() > 0 && loop.poles.frequency_hz.minCoeff() <= 1e-6 * low;
  for (int i = 0; range.from_hz == 0 && has_rigid && i < kDecades && gain(low) < 1; ++i) wide.from_hz = low /= 10;
  return wide;
}

records::Margins calc_margins(const records::LinearModel& loop, const records::FrequencyResponse& response) {
  BOUGH_DEMAND(loop.B.cols() == 1 && loop.C.rows() == 1);
  records::Margins m;
  const TransferMatrix transfer(loop.A, loop.B, loop.C, loop.D);
  const auto L = [&](double omega) { return transfer.calc(calc_argument(loop, omega))(0, 0); };
  if (response.value.empty()) return m;
  const std::vector<LocusPoint> locus = collect_locus(loop, response, L);
  const auto count = static_cast<Index>(locus.size());
  const auto get = [&](Index k) { return locus[static_cast<std::size_t>(k)].value; };
  const auto get_omega = [&](Index k) { return locus[static_cast<std::size_t>(k)].omega; };
  Index nearest = 0;
  for (Index k = 0; k < count; ++k) {
    if (std::abs(1.0 + get(k)) < std::abs(1.0 + get(nearest))) nearest = k;
    if (k + 1 == count) break;
    if (locus[static_cast<std::size_t>(k) + 1].is_after_pole) continue;
    const double a = get_omega(k), b = get_omega(k + 1);
    const Complex here = get(k), next = get(k + 1);
    if ((std::abs(here) > 1) != (std::abs(next) > 1)) {
      const double omega = bisect([&](double w) { return std::abs(L(w)) - 1; }, a, b);
      double lag = std::arg(L(omega)) + std::numbers::pi;  // in (0, 2π]
      m.phase.push_back({omega / kTwoPi, lag > std::numbers::pi ? lag - kTwoPi : lag, lag / omega});
    }
    if (k + 2 == count && loop.sample_time > 0 && b * loop.sample_time > std::numbers::pi * (1 - 1e-9)) {
      const double there = L(std::numbers::pi / loop.sample_time).real();  // real, whatever rounding says
      if (there < 0) m.gain.push_back({0.5 / loop.sample_time, -1 / there, 0});
      if ((here.imag() > 0) == (next.imag() > 0) || std::abs(next.imag()) < 1e-9 * std::abs(next)) continue;
    }
    if ((here.imag() > 0) != (next.imag() > 0) && (here.real() < 0 || next.real() < 0)) {
      const double omega = bisect([&](double w) { return L(w).imag(); }, a, b);
      const Complex there = L(omega);
      // A jump through infinity changes the sign too.
      if (there.real() < 0 && std::abs(there.imag()) < 1e-6 * std::abs(there))
        m.gain.push_back({omega / kTwoPi, -1 / there.real(), 0});
    }
  }
  if (count > 0) {
    const Index before = std::max<Index>(0, nearest - 1), after = std::min(count - 1, nearest + 1);
    const double omega = minimize([&](double w) { return std::abs(1.0 + L(w)); }, get_omega(before), get_omega(after));
    m.distance = std::min(std::abs(1.0 + L(omega)), std::abs(1.0 + get(nearest)));
    m.distance_hz = omega / kTwoPi;
  }
  const double back = 1 + loop.D(0, 0);
  if (back == 0) return m;
  const auto poles = calc_poles(loop.A - loop.B * loop.C / back, loop.states.name);
  if (loop.sample_time > 0) {
    double most = 0;
    for (Index i = 0; i < poles.size(); ++i) most = std::max(most, std::hypot(poles.real[i], poles.imag[i]));
    m.largest_real = std::log(std::max(most, 1e-16)) / loop.sample_time;
    m.is_stable = most <= 1 + kOnCircle;
    return m;
  }
  double size = 0;
  for (Index i = 0; i < poles.size(); ++i) size = std::max(size, std::hypot(poles.real[i], poles.imag[i]));
  m.largest_real = poles.size() > 0 ? poles.real.maxCoeff() : 0;
  m.is_stable = m.largest_real <= 1e-9 * size;
  return m;
}

records::PeakGain calc_peak_gain(const records::LinearModel& model, const records::FrequencyResponse& response) {
  records::PeakGain peak;
  if (model.B.cols() == 0 || model.C.rows() == 0) return peak;
  if (model.sample_time > 0) {
    for (Index k = 0; k < response.frequency_hz.size(); ++k)
      if (response.singular_values(k, 0) > peak.value)
        peak.value = response.singular_values(k, 0), peak.frequency_hz = response.frequency_hz[k];
    peak.is_finite = model.poles.size() == 0 || model.poles.real.maxCoeff() * model.sample_time < -kOnCircle;
    if (!peak.is_finite) peak.why = "poles do not decay";
    return peak;
  }
  const StablePart part = split_stable(model.A);
  if (!part.is_stable()) {
    std::ostringstream why;
    why << "the pole " << part.unstable.real() << " ± " << std::abs(part.unstable.imag()) << " i does not decay";
    peak.why = why.str();
  } else if (part.num_rigid > 0 && is_seen(model, part)) {
    peak.why = "poles at 0 come through to the outputs";
  }
  if (!peak.why.empty()) {
    peak.is_finite = false;
    peak.value = std::numeric_limits<double>::infinity();
    return peak;
  }
  // What decays: z = L x has complex coordinates; their real span will do.
  const Index kept = part.T.rows();
  StateSpace s{MatrixXd(0, 0), MatrixXd(0, model.B.cols()), MatrixXd(model.C.rows(), 0)};
  if (kept > 0) {
    const MatrixXd P = (part.U * part.L).real();
    const Eigen::JacobiSVD<MatrixXd> svd(P, Eigen::ComputeThinU);
    const MatrixXd V = svd.matrixU().leftCols(kept);
    if (part.num_rigid == 0)
      s = {model.A, model.B, model.C};
    else
      s = {V.transpose() * model.A * V, V.transpose() * P * model.B, model.C * V};
  }
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(kept);
  MatrixXd balanced = s.A;
  if (kept > 0) scale = balance(balanced);
  s = {balanced, scale.cwiseInverse().asDiagonal() * s.B, s.C * scale.asDiagonal()};
  const TransferMatrix transfer(s.A, s.B, s.C, model.D);
  const auto sigma = [&](double omega) { return calc_sigma(transfer.calc({0, omega})); };
  double at = 0;
  peak.value = sigma(0);
  if (const double far = calc_sigma(model.D.cast<Complex>()); far > peak.value)
    peak.value = far, at = std::numeric_limits<double>::infinity();
  const auto climb = [&](double from, double to) {
    const double omega = minimize([&](double w) { return -sigma(w); }, from, to), value = sigma(omega);
    if (value > peak.value) peak.value = value, at = omega;
  };
  Index best = 0;
  for (Index k = 0; k < response.frequency_hz.size(); ++k)
    if (response.singular_values(k, 0) > response.singular_values(best, 0)) best = k;
  if (response.frequency_hz.size() > 0) {
    const Index before = std::max<Index>(0, best - 1), after = std::min(response.frequency_hz.size() - 1, best + 1);
    climb(kTwoPi * response.frequency_hz[before], kTwoPi * response.frequency_hz[after]);
  }
  for (int i = 0; i < 30 && kept <= kMostStates && peak.value > 0; ++i) {
    const auto omegas = find_level(s, model.D, peak.value * (1 + kCertified));
    if (omegas.empty()) {
      peak.is_certified = true;
      break;
    }
    const double before = peak.value;
    for (std::size_t k = 0; k + 1 < omegas.size(); ++k) climb(omegas[k], omegas[k + 1]);
    if (omegas.size() == 1) climb(0.5 * omegas[0], omegas[0]);
    if (peak.value <= before * (1 + kCertified)) {
      // Eigenvalues that touch the axis at the peak itself: nothing above it.
      peak.is_certified = true;
      break;
    }
  }
  peak.frequency_hz = at / kTwoPi;
  return peak;
}

}  // namespace bough::statespace
