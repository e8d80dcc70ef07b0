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
#include "solver/statespace/zeros.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Complex = std::complex<double>;

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr int kBisections = 80;
constexpr double kCertified = 1e-6;
constexpr Index kMaxStates = 300;
/// Lowest frequency of the loci of a lifted loop over the highest.
constexpr double kLowest = 1e-3;
/// Two poles at 1 are found that far from it.
constexpr double kOnCircle = 1e-7;
/// A pole with a smaller damping ratio is undamped: differences of A have that error. L is taken that far from it,
/// relative to its frequency.
constexpr double kUndamped = 1e-7, kBesidePole = 1e-6;
/// L is smooth where it changes by less than kRough over kBesideCorner of the frequency; a zero turns its phase by more
/// than kTurned from a decade below it to one above.
constexpr double kBesideCorner = 1e-7, kRough = 1e-3, kTurned = 0.2;
/// Lag of a crossing at -1, rad, that is round-off.
constexpr double kNoLag = 1e-9;
/// Eigenvalues of a lifted L below that share of its norm, times their condition number, are rounding.
constexpr double kRounding = 1e-12;

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

Eigen::VectorXcd calc_eigenvalues(const MatrixXcd& value) {
  return Eigen::ComplexEigenSolver<MatrixXcd>(value, false).eigenvalues();
}

/// Characteristic loci of a lifted loop: eigenvalues λ_i(ω) of L(exp(iωT)), N values at the cut in a period T.
///
/// A branch has the frequency ω + 2πm/T, -N/2 ≤ m < N/2, whose sine, taken at the N values, its eigenvector contains
/// most of; where that is negative the branch is the conjugate one at the opposite frequency.
class Loci {
 public:
  explicit Loci(const records::LinearModel& loop) : loop_(loop), num_values_(loop.B.cols()) {}
  double period() const { return loop_.sample_time; }
  double last() const { return std::numbers::pi / loop_.sample_time; }
  /// Without balancing: delays make A nearly nilpotent, which scales without bound.
  MatrixXcd calc_L(double omega) const {
    MatrixXcd M = (-loop_.A).cast<Complex>();
    M.diagonal().array() += calc_argument(loop_, omega);
    return loop_.C * M.partialPivLu().solve(loop_.B.cast<Complex>()) + loop_.D;
  }
  Eigen::VectorXcd calc(double omega) const { return calc_eigenvalues(calc_L(omega)); }

  /// Returns true if the eigenvalue nearest to `value` exceeds its rounding, kRounding norm(L) / abs(yᴴx) of its
  /// eigenvectors of length 1 (Golub & Van Loan, Matrix Computations, 7.2.2).
  bool is_significant(double omega, Complex value) const {
    const MatrixXcd L = calc_L(omega);
    const Eigen::ComplexEigenSolver<MatrixXcd> solver(L);
    const Index i = find_nearest(solver.eigenvalues(), value);
    const MatrixXcd left = solver.eigenvectors().fullPivLu().inverse();
    const double condition = left.row(i).norm() * solver.eigenvectors().col(i).norm();
    return std::abs(value) > kRounding * L.norm() * condition;
  }
  /// m of the nearest eigenvalue to `value`.
  Index find_alias(double omega, Complex value) const {
    const Eigen::ComplexEigenSolver<MatrixXcd> solver(calc_L(omega));
    return find_alias(omega, Eigen::VectorXcd(solver.eigenvectors().col(find_nearest(solver.eigenvalues(), value))));
  }
  Index find_alias(double omega, const Eigen::VectorXcd& vector) const {
    Index best = 0;
    double max_value = -1;
    for (Index i = 0; i < num_values_; ++i) {  // 0, -1, 1, -2, 2, ...: for equal shares the lowest frequency
      const Index m = i % 2 == 1 ? -(i + 1) / 2 : i / 2;
      const double step = calc_frequency(omega, m) * period() / static_cast<double>(num_values_);
      Complex share = 0;
      for (Index k = 0; k < num_values_; ++k) share += std::polar(1.0, -step * static_cast<double>(k)) * vector[k];
      if (std::abs(share) > max_value * (1 + 1e-9)) best = m, max_value = std::abs(share);
    }
    return best;
  }
  double calc_frequency(double omega, Index m) const { return omega + kTwoPi * static_cast<double>(m) / period(); }

  static Index find_nearest(const Eigen::VectorXcd& values, Complex value) {
    Index best = 0;
    (values.array() - value).abs().minCoeff(&best);
    return best;
  }

 private:
  const records::LinearModel& loop_;
  Index num_values_;
};

/// `next` in the order of `before`: pairs from the nearest up. `is_clear`: each moves less than a third of its size, or
/// of its distance from all others.
Eigen::VectorXcd follow_values(const Eigen::VectorXcd& before, const Eigen::VectorXcd& next, bool& is_clear) {
  const Index n = before.size();
  struct Pair {
    double distance;
    Index from, to;
  };
  std::vector<Pair> pairs;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) pairs.push_back({std::abs(before[i] - next[j]), i, j});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  Eigen::VectorXcd ordered(n);
  Eigen::VectorXd moved = Eigen::VectorXd::Constant(n, -1), second = moved;
  std::vector<bool> is_taken(static_cast<std::size_t>(n), false);
  for (const auto& pair : pairs) {
    if (moved[pair.from] >= 0) {
      if (second[pair.from] < 0) second[pair.from] = pair.distance;
      continue;
    }
    if (is_taken[static_cast<std::size_t>(pair.to)]) continue;
    ordered[pair.from] = next[pair.to];
    moved[pair.from] = pair.distance;
    is_taken[static_cast<std::size_t>(pair.to)] = true;
  }
  const double floor = 1e-6;  // of a factor at -1: nothing that small matters
  is_clear = true;
  for (Index i = 0; i < n; ++i) {
    const double size = std::max(std::abs(before[i]), std::abs(ordered[i]));
    const bool is_apart = n == 1 || second[i] < 0 || moved[i] <= second[i] / 3;
    if (size > floor && (moved[i] > size / 3 || !is_apart)) is_clear = false;
  }
  return ordered;
}

double calc_sigma(const MatrixXcd& value) {
  if (!value.allFinite()) return std::numeric_limits<double>::infinity();
  return value.size() == 0 ? 0 : Eigen::JacobiSVD<MatrixXcd>(value).singularValues()[0];
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

/// Phase lag of a value of size 1 after -1, in [0, 2π): zero at -1 itself, whatever the sign of its round-off.
double calc_lag(Complex value) {
  const double lag = std::arg(value) + std::numbers::pi;
  return kTwoPi - lag < kNoLag ? 0 : lag;
}

/// A crossing of a branch, at the value it has there.
void add_crossing(const Loci& loci, double omega, Complex value, bool is_phase, records::Margins& m) {
  double at = loci.calc_frequency(omega, loci.find_alias(omega, value));
  if (at < 0) at = -at, value = std::conj(value);
  auto& list = is_phase ? m.phase : m.gain;
  records::Crossing crossing{at / kTwoPi, -1 / value.real(), 0};
  if (is_phase) {
    const double lag = calc_lag(value);
    crossing = {at / kTwoPi, lag > std::numbers::pi ? lag - kTwoPi : lag, lag / at};
  }
  const auto is_same = [&](const records::Crossing& c) {
    return std::abs(c.frequency_hz - crossing.frequency_hz) <= 1e-8 * crossing.frequency_hz &&
           std::abs(c.margin - crossing.margin) <= 1e-8 * std::abs(crossing.margin);
  };
  if (std::none_of(list.begin(), list.end(), is_same)) list.push_back(crossing);
}

/// Crossings of all branches between a and b, by halves until no branch is mistaken for another.
void find_crossings(const Loci& loci, double a, const Eigen::VectorXcd& here, double b, const Eigen::VectorXcd& next,
                    records::Margins& m) {
  bool is_clear = true;
  const Eigen::VectorXcd there = follow_values(here, next, is_clear);
  if (!is_clear && b - a > 1e-7 * loci.last()) {
    const double middle = 0.5 * (a + b);
    const Eigen::VectorXcd between = loci.calc(middle);
    find_crossings(loci, a, here, middle, between, m);
    find_crossings(loci, middle, between, b, next, m);
    return;
  }
  const double rounding = kRounding * std::max(here.cwiseAbs().maxCoeff(), there.cwiseAbs().maxCoeff());
  const auto locate = [&](Index i, const std::function<double(Complex)>& f, bool is_phase) {
    double from = a, to = b;
    Complex left = here[i], right = there[i];
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (from + to);
      if (middle == from || middle == to) break;
      const auto values = loci.calc(middle);
      const Complex value = values[Loci::find_nearest(values, 0.5 * (left + right))];
      (f(value) > 0) == (f(left) > 0) ? (from = middle, left = value) : (to = middle, right = value);
    }
    const Complex value = 0.5 * (left + right);
    if (is_phase || (value.real() < 0 && std::abs(value.imag()) < 1e-6 * std::abs(value) &&
                     loci.is_significant(0.5 * (from + to), value)))
      add_crossing(loci, 0.5 * (from + to), value, is_phase, m);
  };
  for (Index i = 0; i < here.size(); ++i) {
    if ((std::abs(here[i]) > 1) != (std::abs(there[i]) > 1))
      locate(
          i, [](Complex v) { return std::abs(v) - 1; }, true);
    const double imag = std::max(std::abs(here[i].imag()), std::abs(there[i].imag()));
    const bool ends_real = b >= loci.last() * (1 - 1e-9) && std::abs(there[i].imag()) < 1e-9 * std::abs(there[i]);
    if ((here[i].imag() > 0) != (there[i].imag() > 0) && (here[i].real() < 0 || there[i].real() < 0) &&
        imag > rounding && !ends_real)
      locate(
          i, [](Complex v) { return v.imag(); }, false);
  }
}

/// Branches that are real at the ends: at ω = π/T, and at ω = 0 if their own frequency is another one there.
void find_real_ends(const Loci& loci, records::Margins& m) {
  const auto values = loci.calc(loci.last());
  for (const Complex& value : values)
    if (value.real() < 0 && std::abs(value.imag()) < 1e-9 * std::abs(value) && loci.is_significant(loci.last(), value))
      add_crossing(loci, loci.last(), value.real(), false, m);
  // At ω = 0 an integrator is infinite: the even real part and the odd imaginary part are extrapolated.
  const double h = kLowest * loci.last();
  bool is_clear = true;
  const auto first = loci.calc(h);
  const auto second = follow_values(first, loci.calc(2 * h), is_clear);
  for (Index i = 0; i < first.size(); ++i) {
    const double size = std::abs(first[i]), real = (4 * first[i].real() - second[i].real()) / 3;
    const bool is_real = std::abs(2 * first[i].imag() - second[i].imag()) <= 1e-5 * size;
    if (!(real < 0) || !is_real || size < 1e-9 || loci.find_alias(h, first[i]) == 0) continue;
    const Index alias = std::abs(loci.find_alias(h, first[i]));
    const double at = loci.calc_frequency(0, alias);
    m.gain.push_back({at / kTwoPi, -1 / real, 0});
    if (1 + real < m.distance) m.distance = std::abs(1 + real), m.distance_hz = at / kTwoPi;
  }
}

/// Least singular value of 1 + L, from the nearest of the points on.
void find_distance(const Loci& loci, const std::vector<LocusPoint>& locus, records::Margins& m) {
  const Index n = loci.calc_L(loci.last()).rows();
  const auto calc = [&](double omega) {
    const MatrixXcd sum = MatrixXcd::Identity(n, n) + loci.calc_L(omega);
    if (!sum.allFinite()) return std::numeric_limits<double>::infinity();
    return Eigen::JacobiSVD<MatrixXcd>(sum).singularValues()[n - 1];
  };
  std::vector<double> values;
  for (const auto& point : locus) values.push_back(calc(point.omega));
  double at = locus.front().omega, min_value = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < locus.size(); ++k) {  // about each local minimum
    const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(locus.size() - 1, k + 1);
    if (values[k] > values[before] || values[k] > values[after] || values[k] > 1.5 * min_value) continue;
    const double omega = minimize(calc, locus[before].omega, locus[after].omega), value = calc(omega);
    if (value < min_value) at = omega, min_value = value;
    if (values[k] < min_value) at = locus[k].omega, min_value = values[k];
  }
  m.distance = calc(at);
  const MatrixXcd sum = MatrixXcd::Identity(n, n) + loci.calc_L(at);
  const Eigen::JacobiSVD<MatrixXcd> svd(sum, Eigen::ComputeFullV);
  m.distance_hz =
      std::abs(loci.calc_frequency(at, loci.find_alias(at, Eigen::VectorXcd(svd.matrixV().col(n - 1))))) / kTwoPi;
}

/// Margins of a lifted loop, from the characteristic loci. `locus`: frequencies, and undamped poles between them.
void find_lifted_margins(const Loci& loci, std::vector<LocusPoint> locus, records::Margins& m) {
  // Faster branches have crossings near ω = 0 too.
  const double low = kLowest * loci.last(), first = locus.front().omega;
  constexpr int kMore = 40;
  std::vector<LocusPoint> more;
  for (int i = 0; i < kMore && first > low; ++i) more.push_back({low + (first - low) * i / kMore, {}, false});
  locus.insert(locus.begin(), more.begin(), more.end());
  find_distance(loci, locus, m);
  Eigen::VectorXcd here = loci.calc(locus.front().omega);
  for (std::size_t k = 1; k < locus.size(); ++k) {
    Eigen::VectorXcd next = loci.calc(locus[k].omega);
    if (!locus[k].is_after_pole) find_crossings(loci, locus[k - 1].omega, here, locus[k].omega, next, m);
    here = std::move(next);
  }
  find_real_ends(loci, m);
  const auto is_before = [](const records::Crossing& a, const records::Crossing& b) {
    return a.frequency_hz < b.frequency_hz;
  };
  std::stable_sort(m.gain.begin(), m.gain.end(), is_before);
  std::stable_sort(m.phase.begin(), m.phase.end(), is_before);
}

/// Crossings and distance of one L(ω).
void find_margins(const records::LinearModel& loop, const std::vector<LocusPoint>& locus,
                  const std::function<Complex(double)>& L, records::Margins& m) {
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
      const double lag = calc_lag(L(omega));
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
}

/// Poles with the loop closed: those of A - B (1 + D)⁻¹ C.
void find_stability(const records::LinearModel& loop, records::Margins& m) {
  const bool is_lifted = loop.B.cols() > 1;
  const double back = 1 + loop.D(0, 0);
  if (!is_lifted && back == 0) return;
  const MatrixXd sum = MatrixXd::Identity(loop.D.rows(), loop.D.cols()) + loop.D;
  const MatrixXd A = is_lifted ? MatrixXd(loop.A - loop.B * sum.partialPivLu().solve(loop.C))
                               : MatrixXd(loop.A - loop.B * loop.C / back);
  const auto poles = calc_poles(A, loop.states.name);
  if (loop.sample_time > 0) {
    double max_value = 0;
    for (Index i = 0; i < poles.size(); ++i) max_value = std::max(max_value, std::hypot(poles.real[i], poles.imag[i]));
    m.largest_real = std::log(std::max(max_value, 1e-16)) / loop.sample_time;
    m.is_stable = max_value <= 1 + kOnCircle;
    return;
  }
  double size = 0;
  for (Index i = 0; i < poles.size(); ++i) size = std::max(size, std::hypot(poles.real[i], poles.imag[i]));
  m.largest_real = poles.size() > 0 ? poles.real.maxCoeff() : 0;
  m.is_stable = m.largest_real <= 1e-9 * size;
}

}  // namespace

namespace {

/// Zeros as frequencies in Hz, |s| / 2π; of a sampled loop s = ln z / T.
std::vector<double> find_zero_corners(const records::LinearModel& loop) {
  const bool is_sampled = loop.sample_time > 0;
  Eigen::VectorXcd zeros(loop.zeros_real.size());
  zeros.real() = loop.zeros_real, zeros.imag() = loop.zeros_imag;
  if (is_sampled || !loop.has_zeros) zeros = calc_zeros(loop.A, loop.B, loop.C, loop.D);
  std::vector<double> corners;
  for (const Complex& zero : zeros) {
    const double size = is_sampled ? std::abs(std::log(zero)) / loop.sample_time : std::abs(zero);
    if (std::isfinite(size) && size > 0) corners.push_back(size / kTwoPi);
  }
  return corners;
}

/// Widens the open ends to a decade beyond the zeros at which the phase of L turns. One that is at 0 or at infinity but
/// for rounding turns nothing; where L itself is rounding it is not smooth.
void widen_for_zeros(const records::LinearModel& loop, const FrequencyRange& range, double low, double high,
                     FrequencyRange& wide) {
  const TransferMatrix transfer(loop.A, loop.B, loop.C, loop.D);
  const auto calc_largest = [&](double hz) -> Complex {
    const MatrixXcd value = transfer.calc(calc_argument(loop, kTwoPi * hz));
    if (value.size() == 1 || !value.allFinite()) return value(0, 0);
    const Eigen::VectorXcd values = calc_eigenvalues(value);
    Index at = 0;
    values.cwiseAbs().maxCoeff(&at);
    return values[at];
  };
  const auto is_smooth = [&](double hz) {
    const Complex here = calc_largest(hz), beside = calc_largest(hz * (1 + kBesideCorner));
    return std::isfinite(std::abs(here)) && std::abs(here - beside) < kRough * std::abs(here);
  };
  const double nyquist = loop.sample_time > 0 ? 0.5 / loop.sample_time : std::numeric_limits<double>::infinity();
  for (const double corner : find_zero_corners(loop)) {
    const double below = 0.1 * corner, above = 10 * corner;
    const bool is_slow = below < low && range.from_hz == 0,
               is_fast = above > high && range.to_hz == 0 && nyquist > high;
    if ((!is_slow && !is_fast) || !is_smooth(below) || !is_smooth(std::min(above, nyquist))) continue;
    if (std::abs(std::arg(calc_largest(std::min(above, nyquist)) / calc_largest(below))) < kTurned) continue;
    if (is_slow) wide.from_hz = low = below;
    if (is_fast) wide.to_hz = high = above;
  }
}

}  // namespace

FrequencyRange widen_for_loop(const records::LinearModel& loop, const FrequencyRange& range) {
  constexpr int kDecades = 8;
  FrequencyRange wide = range;
  const auto ends = calc_frequency_response(loop, {range.from_hz, range.to_hz, 1, 2}).frequency_hz;
  const TransferMatrix transfer(loop.A, loop.B, loop.C, loop.D);
  const auto gain = [&](double hz) { return transfer.calc(calc_argument(loop, kTwoPi * hz)).cwiseAbs().maxCoeff(); };
  double low = ends[0], high = ends[ends.size() - 1];
  for (int i = 0; range.to_hz == 0 && loop.sample_time == 0 && i < kDecades && gain(high) > 1; ++i)
    wide.to_hz = high *= 10;
  const bool has_rigid = loop.poles.size() > 0 && loop.poles.frequency_hz.minCoeff() <= 1e-6 * low;
  for (int i = 0; range.from_hz == 0 && has_rigid && i < kDecades && gain(low) < 1; ++i) wide.from_hz = low /= 10;
  widen_for_zeros(loop, range, low, high, wide);
  return wide;
}

records::Margins calc_margins(const records::LinearModel& loop, const records::FrequencyResponse& response) {
  BOUGH_DEMAND(loop.B.cols() > 0 && loop.B.cols() == loop.C.rows());
  records::Margins m;
  const TransferMatrix transfer(loop.A, loop.B, loop.C, loop.D);
  const auto L = [&](double omega) { return transfer.calc(calc_argument(loop, omega))(0, 0); };
  if (response.value.empty()) return m;
  const std::vector<LocusPoint> locus = collect_locus(loop, response, L);
  if (loop.B.cols() > 1)
    find_lifted_margins(Loci(loop), locus, m);
  else
    find_margins(loop, locus, L, m);
  find_stability(loop, m);
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
    const double real = part.unstable.real(), imag = std::abs(part.unstable.imag());
    if (imag > 0 && std::abs(real) <= kUndamped * imag)
      why << "the poles ± " << imag << " i are on the imaginary axis within rounding (real part " << real << ")";
    else
      why << "the pole " << real << " ± " << imag << " i does not decay";
    peak.why = why.str();
  } else if (part.num_rigid > 0 &&
             is_seen({model.A, model.B, model.C},
                     MatrixXd::Identity(model.A.rows(), model.A.rows()) - (part.U * part.L).real())) {
    peak.why = "poles at 0 come through to the outputs";
  }
  if (!peak.why.empty()) {
    peak.is_finite = false;
    peak.value = std::numeric_limits<double>::infinity();
    return peak;
  }
  // The stable part: z = L x has complex coordinates; their real span is used.
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
  for (int i = 0; i < 30 && kept <= kMaxStates && peak.value > 0; ++i) {
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
