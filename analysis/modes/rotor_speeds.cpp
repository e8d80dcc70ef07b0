#include "analysis/modes/rotor_speeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "analysis/linearize/sweep.hpp"
#include "solver/statespace/track.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using modal::complex_modes::ComplexModesSolver;
using modal::complex_modes::SpeedModes;
using records::RotorSpeeds;
using statespace::EigenSystem;

/// Modes in addition to the requested ones: others come down as the rotor spins up.
constexpr int kMoreModes = 4;
/// Damping of smaller magnitude is round-off.
constexpr double kDampingRoundoff = 1e-9;
constexpr double kSpeedTolerance = 1e-10;
constexpr int kMaxSteps = 30;
/// Modes of less correlation are two motions: repeated ones that split have half.
constexpr double kMinCorrelation = 0.1;

EigenSystem to_system(const SpeedModes& modes) { return {modes.lambda, modes.right, modes.left}; }

EigenSystem select(const EigenSystem& s, Index i) { return {s.value.segment(i, 1), s.right.col(i), s.left.row(i)}; }

/// One mode at the ends of an interval of speeds.
struct Bracket {
  double low, high;
  EigenSystem at_low;
  std::complex<double> lambda_low, lambda_high;
};

struct Root {
  RotorSpeeds::Point point;
  std::complex<double> lambda;
};

/// Root of f(Ω, λ(Ω)) for the mode that is followed into the bracket: regula falsi, by the Illinois rule. None if no
/// mode at the first estimate is that of the bracket.
std::optional<Root> find_root(const ComplexModesSolver& solver, const Bracket& bracket,
                              const std::function<double(double, std::complex<double>)>& f) {
  double a = bracket.low, b = bracket.high;
  double f_a = f(a, bracket.lambda_low), f_b = f(b, bracket.lambda_high);
  std::optional<Root> root;
  int side = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const double speed = (a * f_b - b * f_a) / (f_b - f_a);
    const double share = (speed - bracket.low) / (bracket.high - bracket.low);
    const auto near = bracket.lambda_low + share * (bracket.lambda_high - bracket.lambda_low);
    const auto modes = solver.solve_at(speed, 4, near);
    Eigen::VectorXd correlation;
    const auto match = statespace::follow(bracket.at_low, to_system(modes), correlation);
    if (match.front() < 0) break;
    const auto lambda = modes.lambda[match.front()];
    const double value = f(speed, lambda);
    root.emplace();
    root->point.speed = speed;
    root->point.frequency_hz = lambda.imag() / (2 * std::numbers::pi);
    root->point.whirl = modes.whirl[match.front()];
    root->lambda = lambda;
    if (std::abs(value) <= kSpeedTolerance * std::abs(lambda) || std::abs(b - a) <= kSpeedTolerance * std::abs(b))
      break;
    if ((value > 0) == (f_b > 0)) {
      b = speed, f_b = value;
      if (side == -1) f_a /= 2;
      side = -1;
    } else {
      a = speed, f_a = value;
      if (side == 1) f_b /= 2;
      side = 1;
    }
  }
  return root;
}

class Sweep {
 public:
  /// \param has_critical  critical speeds are found: not in the rotating frame, whose frequencies are others.
  Sweep(const ComplexModesSolver& solver, bool has_critical, Events& events)
      : solver_(solver), has_critical_(has_critical), events_(events) {}

  void solve(const std::vector<double>& speeds) {
    for (std::size_t k = 0; k < speeds.size(); ++k) {
      events_.show_progress(fmt::format("speed {} of {}", k + 1, speeds.size()));
      const auto modes = solver_.solve_at(speeds[k], 0);
      const int requested = static_cast<int>(modes.lambda.size());
      if (k == 0) {
        num_modes_ = requested;
        branches_.resize(static_cast<std::size_t>(requested));
        for (Index j = 0; j < requested; ++j) take(branches_[static_cast<std::size_t>(j)], modes, j, 1);
        before_ = to_system(modes);
        for (int j = 0; j < requested; ++j) alive_.push_back(j);
        continue;
      }
      advance(speeds[k - 1], speeds[k], solver_.solve_at(speeds[k], num_modes_ + kMoreModes));
    }
    events_.show_progress("");
  }

  /// Branches that are followed to the last speed.
  void fill(const std::vector<double>& speeds, RotorSpeeds& result) const {
    auto& sweep = result.sweep;
    const auto np = static_cast<Index>(speeds.size()), nb = static_cast<Index>(alive_.size());
    sweep.parameter = "rotor speed";
    sweep.value = Eigen::Map<const Eigen::VectorXd>(speeds.data(), np);
    for (auto* m : {&sweep.real, &sweep.imag, &sweep.frequency_hz, &sweep.damping, &sweep.correlation, &sweep.whirl})
      m->resize(np, nb);
    sweep.mode.assign(speeds.size(), {});
    std::vector<int> column(branches_.size(), -1);
    for (Index b = 0; b < nb; ++b) {
      column[static_cast<std::size_t>(alive_[static_cast<std::size_t>(b)])] = static_cast<int>(b);
      const auto& branch = branches_[static_cast<std::size_t>(alive_[static_cast<std::size_t>(b)])];
      for (Index k = 0; k < np; ++k) {
        const auto& p = branch[static_cast<std::size_t>(k)];
        sweep.real(k, b) = p.lambda.real();
        sweep.imag(k, b) = p.lambda.imag();
        sweep.frequency_hz(k, b) = p.lambda.imag() / (2 * std::numbers::pi);
        sweep.damping(k, b) = -p.lambda.real() / std::abs(p.lambda);
        sweep.correlation(k, b) = p.correlation;
        sweep.whirl(k, b) = p.whirl;
        sweep.mode[static_cast<std::size_t>(k)].push_back(fmt::format("mode {}", b + 1));
      }
    }
    const auto move = [&](const std::vector<RotorSpeeds::Point>& from, std::vector<RotorSpeeds::Point>& to) {
      for (auto point : from) {
        point.branch = column[static_cast<std::size_t>(point.branch)];
        if (point.branch >= 0) to.push_back(point);
      }
      std::sort(to.begin(), to.end(), [](const auto& x, const auto& y) { return x.speed < y.speed; });
    };
    move(critical_, result.critical);
    move(thresholds_, result.thresholds);
  }
  std::size_t num_lost() const { return branches_.size() - alive_.size(); }

 private:
  struct Value {
    std::complex<double> lambda;
    double correlation = 1, whirl = 0;
  };
  using Branch = std::vector<Value>;

  static void take(Branch& branch, const SpeedModes& modes, Index j, double correlation) {
    branch.push_back({modes.lambda[j], correlation, modes.whirl[j]});
  }

  void advance(double low, double high, const SpeedModes& modes) {
    const auto here = to_system(modes);
    Eigen::VectorXd correlation;
    const auto order = statespace::follow(before_, here, correlation);
    std::vector<int> alive, columns;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (order[i] < 0 || correlation[static_cast<Index>(i)] < kMinCorrelation) continue;
      auto& branch = branches_[static_cast<std::size_t>(alive_[i])];
      take(branch, modes, order[i], correlation[static_cast<Index>(i)]);
      const auto before = branch[branch.size() - 2].lambda, lambda = branch.back().lambda;
      const Bracket bracket{low, high, select(before_, static_cast<Index>(i)), before, lambda};
      const auto find = [&](const auto& f) {
        auto root = find_root(solver_, bracket, f);
        if (root) root->point.branch = alive_[i];
        return root;
      };
      const auto excess = [](double speed, std::complex<double> l) { return l.imag() - std::abs(speed); };
      const double excess_low = excess(low, before), excess_high = excess(high, lambda);
      if (has_critical_ && ((excess_low > 0 && excess_high <= 0) || (excess_low < 0 && excess_high >= 0)))
        if (const auto root = find(excess); root && is_resonant(root->lambda)) critical_.push_back(root->point);
      const double noise = kDampingRoundoff * std::abs(lambda);
      const bool is_onset = before.real() < -noise && lambda.real() > noise,
                 is_end = before.real() > noise && lambda.real() < -noise;
      if (is_onset || is_end)
        if (auto root = find([](double, std::complex<double> l) { return l.real(); })) {
          root->point.is_onset = is_onset;
          thresholds_.push_back(root->point);
        }
      alive.push_back(alive_[i]);
      columns.push_back(order[i]);
    }
    alive_ = std::move(alive);
    before_ = {here.value(columns), here.right(Eigen::all, columns), here.left(columns, Eigen::all)};
  }

  const ComplexModesSolver& solver_;
  const bool has_critical_;
  Events& events_;
  int num_modes_ = 0;
  std::vector<Branch> branches_;
  std::vector<int> alive_;  ///< branches that have a mode at the last speed, in the order of before_
  EigenSystem before_;
  std::vector<RotorSpeeds::Point> critical_, thresholds_;
};

}  // namespace

bool is_resonant(std::complex<double> lambda) { return std::abs(lambda.real()) < std::abs(lambda.imag()); }

RotorSpeeds calc_rotor_speeds(const ComplexModesSolver& solver, const std::string& file, Events& events,
                              Diagnostics& diagnostics) {
  const auto& rotors = *solver.rotor_case();
  RotorSpeeds result;
  result.reference = rotors.reference;
  result.is_synchronous = rotors.is_synchronous;
  for (const auto& rotor : solver.rotors())
    result.rotors.push_back({rotor.id, static_cast<int>(rotor.nodes.size()), static_cast<int>(rotor.elements.size()),
                             rotor.mass, rotor.polar_inertia});
  if (rotors.is_synchronous) return result;
  Sweep sweep(solver, !rotors.is_rotating, events);
  sweep.solve(rotors.speeds);
  sweep.fill(rotors.speeds, result);
  if (sweep.num_lost() > 0)
    diagnostics.warning("modal.rotor-lost", {file},
                        fmt::format("{} of the modes at the first speed have no match at a later one: they no longer "
                                    "oscillate, or are above the modes that are solved for",
                                    sweep.num_lost()),
                        "take more modes by ND of EIGC, or smaller steps of the speed");
  warn_jumps(result.sweep, file, diagnostics);
  return result;
}

}  // namespace bough::analysis
